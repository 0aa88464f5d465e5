//! What there is to say about single elements: which are irregular and by how much, which vertices
//! hang as T-junctions, which edges are sharp.
//!
//! The index of an interior vertex is 4 − valence, that of a face 4 − degree (Peng & Wonka 2013,
//! §2.1). *Invariant:* Σ |index| over all that is listed here is the count E of the metrics;
//! boundary vertices are judged by their sectors and are not listed.

use crate::mesh::{NONE, PolyMesh, Topology};
use crate::metrics::{FaceValues, TJunction, face_values, t_junctions};
use crate::surface::{FeatureOptions, Reference, mesh_features};
use serde::Serialize;

/// An irregular vertex or face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Irregular {
    /// Number of the vertex or face.
    pub id: u32,
    /// 4 − valence or 4 − degree; never 0.
    pub index: i32,
}

/// The elements of a mesh that stand out.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct Elements {
    /// Interior vertices of valence other than 4. One where several fans meet is listed with each.
    pub vertices: Vec<Irregular>,
    /// Faces of degree other than 4.
    pub faces: Vec<Irregular>,
    /// Vertices that hang in the side of a face.
    pub t_junctions: Vec<TJunction>,
    /// Interior edges that are held as sharp features, by their end points.
    pub sharp_edges: Vec<[u32; 2]>,
    /// Edges of a single face.
    pub boundary_edges: Vec<[u32; 2]>,
}

impl Elements {
    /// Finds them. Sharp edges need the surface that the mesh follows. O(n log n) for n corners.
    #[must_use]
    pub fn new(
        mesh: &PolyMesh,
        topology: &Topology,
        surface: Option<(&Reference, &FeatureOptions)>,
    ) -> Self {
        let ends = |h: u32| [h, topology.next[h as usize]].map(|c| mesh.corners()[c as usize]);
        let sharp = surface.map(|(reference, options)| {
            let marked = mesh_features(mesh, topology, reference, options);
            let halves = marked.ones().map(|h| h as u32);
            halves.filter(|&h| topology.twin[h as usize] > h).map(ends).collect()
        });
        Self {
            vertices: irregular_vertices(topology),
            faces: irregular(mesh.faces().map(<[u32]>::len).enumerate()),
            t_junctions: t_junctions(mesh, topology),
            sharp_edges: sharp.unwrap_or_default(),
            boundary_edges: topology.boundary_half_edges().map(ends).collect(),
        }
    }
}

/// A mesh looked at element by element: material for pictures and reports.
#[derive(Debug, Clone)]
pub struct Inspection {
    /// Its connectivity.
    pub topology: Topology,
    /// Its elements that stand out.
    pub elements: Elements,
    /// The quality of its faces.
    pub fields: Vec<FaceValues>,
}

impl Inspection {
    /// Looks at `mesh`, which may be any soup. Without a reference there are no distances, and
    /// sharp features are those of the mesh itself. O(n log n) for n corners.
    #[must_use]
    pub fn new(mesh: &PolyMesh, reference: Option<&Reference>, options: &FeatureOptions) -> Self {
        let topology = Topology::new(mesh);
        // A mesh without area has no features of its own.
        let own = if reference.is_none() { Reference::new(mesh).ok() } else { None };
        let surface = reference.or(own.as_ref()).map(|surface| (surface, options));
        let elements = Elements::new(mesh, &topology, surface);
        let fields = face_values(mesh, &topology, reference);
        Self { topology, elements, fields }
    }

    /// The values of the field called `key`, if it was measured.
    #[must_use]
    pub fn field(&self, key: &str) -> Option<&FaceValues> {
        self.fields.iter().find(|f| f.field.key == key)
    }
}

fn irregular_vertices(topology: &Topology) -> Vec<Irregular> {
    let fans = topology.fan_vertex.iter().zip(&topology.fan_corners).zip(&topology.fan_on_boundary);
    let interior = fans.filter(|&(_, &boundary)| !boundary);
    let mut found = irregular(interior.map(|((&v, &n), _)| (v as usize, n as usize)));
    found.sort_by_key(|v| v.id);
    found
}

fn irregular(sizes: impl Iterator<Item = (usize, usize)>) -> Vec<Irregular> {
    let index = |(id, size): (usize, usize)| Irregular { id: id as u32, index: 4 - size as i32 };
    sizes.map(index).filter(|e| e.index != 0).collect()
}

/// One half-edge of each edge, by number, cuts on either side included once each.
pub fn edges(topology: &Topology) -> impl Iterator<Item = u32> + '_ {
    let halves = 0..topology.twin.len() as u32;
    halves.filter(|&h| topology.twin[h as usize] == NONE || topology.twin[h as usize] > h)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;
    use crate::metrics::irregular_elements;

    #[test]
    fn what_is_listed_adds_up_to_e() {
        for mesh in [shapes::cube(3), shapes::grid(3, 2), shapes::torus(6, 4)] {
            let topology = Topology::new(&mesh);
            let elements = Elements::new(&mesh, &topology, None);
            let listed = elements.vertices.iter().chain(&elements.faces);
            let sum: u32 = listed.map(|e| e.index.unsigned_abs()).sum();
            assert_eq!(sum as usize, irregular_elements(&mesh, &topology));
        }
    }

    #[test]
    fn the_edges_of_a_cube_are_sharp() {
        let mesh = shapes::cube(10);
        let surface = Reference::new(&mesh).unwrap();
        let options = FeatureOptions::default();
        let elements = Elements::new(&mesh, &Topology::new(&mesh), Some((&surface, &options)));
        assert_eq!((elements.sharp_edges.len(), elements.boundary_edges.len()), (12 * 10, 0));
        assert_eq!(elements.vertices.len(), 8);
    }
}
