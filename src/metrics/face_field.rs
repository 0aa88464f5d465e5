//! Quality as a field over the faces: what heat maps show and histograms count.
//!
//! The formulas are those of the metrics of the same name, face by face.

use super::registry::Better;
use super::shape::Shape;
use super::{angles, jacobian, planarity};
use crate::mesh::{Point, PolyMesh, Topology};
use crate::surface::{Hit, Reference};
use std::ops::Range;

/// A measure that every face has a value of.
#[derive(Debug, Clone, Copy)]
pub struct FaceField {
    /// Unique name.
    pub key: &'static str,
    /// Name for people.
    pub label: &'static str,
    /// Unit for people; empty for pure numbers.
    pub unit: &'static str,
    /// Which direction is an improvement.
    pub better: Better,
    of_faces: fn(&Shape, Option<&Reference>) -> Option<Vec<f64>>,
}

/// All of them, in the order in which they are offered.
pub const FACE_FIELDS: &[FaceField] = &[
    FaceField {
        key: "angle-deviation",
        label: "angle deviation",
        unit: "°",
        better: Better::Lower,
        of_faces: |shape, _| {
            Some(shape.faces().map(|f| angles::deviation_from_mean(&shape.angles_deg[f])).collect())
        },
    },
    FaceField {
        key: "scaled-jacobian",
        label: "scaled Jacobian",
        unit: "",
        better: Better::Higher,
        of_faces: |shape, _| Some(of_quads(shape, jacobian::of_quad)),
    },
    FaceField {
        key: "planarity",
        label: "planarity",
        unit: "of mean diagonal",
        better: Better::Lower,
        of_faces: |shape, _| Some(of_quads(shape, planarity::of_quad)),
    },
    FaceField {
        key: "distance",
        label: "distance to the reference",
        unit: "% of its diagonal",
        better: Better::Lower,
        of_faces: |shape, reference| reference.map(|r| distances(shape, r)),
    },
];

/// A field and its value at each face; NaN where it is undefined, such as the scaled Jacobian of a
/// triangle.
#[derive(Debug, Clone)]
pub struct FaceValues {
    /// The field.
    pub field: &'static FaceField,
    /// One value for each face.
    pub values: Vec<f64>,
}

/// The values of every field, that of the distance only with a reference. O(n log m) for n corners
/// and m triangles of the reference, in parallel.
#[must_use]
pub fn face_values(
    mesh: &PolyMesh,
    topology: &Topology,
    reference: Option<&Reference>,
) -> Vec<FaceValues> {
    let shape = Shape::new(mesh, topology);
    let of = |field: &'static FaceField| {
        (field.of_faces)(&shape, reference).map(|values| FaceValues { field, values })
    };
    FACE_FIELDS.iter().filter_map(of).collect()
}

fn of_quads(shape: &Shape, of_quad: fn(&Shape, Range<usize>) -> f64) -> Vec<f64> {
    let value = |face: Range<usize>| if face.len() == 4 { of_quad(shape, face) } else { f64::NAN };
    shape.faces().map(value).collect()
}

/// The largest distance of the corners and the centre of each face, in percent of the diagonal of
/// the reference.
fn distances(shape: &Shape, reference: &Reference) -> Vec<f64> {
    let points = shape.mesh.points();
    let mut probes: Vec<Point> = shape.centres.clone();
    probes.extend_from_slice(points);
    let hits = reference.closest_many(&probes);
    let (centres, corners): (&[Hit], &[Hit]) = hits.split_at(shape.centres.len());
    let farthest = |(face, centre): (&[u32], &Hit)| {
        face.iter().map(|&v| corners[v as usize].distance).fold(centre.distance, f64::max)
    };
    let percent = 100.0 / reference.diagonal();
    shape.mesh.faces().zip(centres).map(|pair| percent * farthest(pair)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;
    use crate::metrics::measure;

    #[test]
    fn the_mean_of_a_field_is_the_metric_of_its_name() {
        let mesh = shapes::cube(2);
        let topology = Topology::new(&mesh);
        let surface = Reference::plain(&mesh).unwrap();
        let fields = face_values(&mesh, &topology, Some(&surface));
        let keys: Vec<&str> = fields.iter().map(|f| f.field.key).collect();
        assert_eq!(keys, FACE_FIELDS.iter().map(|f| f.key).collect::<Vec<_>>());
        let mean = |i: usize| fields[i].values.iter().sum::<f64>() / mesh.face_count() as f64;
        let metrics = measure(&mesh, None).unwrap();
        assert_eq!(Some(mean(0)), metrics.summary.fig10_mean);
        assert_eq!(Some(mean(1)), metrics.summary.scaled_jacobian_mean);
        assert!(mean(2).abs() < 1e-12 && mean(3).abs() < 1e-12);
    }
}
