//! What a mesh is like, in numbers: connectivity, irregularity, quality, distance to a reference.
//!
//! Every measure works on any soup of polygons: it is cut at its non-manifold places (see
//! [`Topology`]) and degenerate faces are counted instead of refused. One file is one concept;
//! [`Metrics`] puts them together in the order in which they are written as JSON, and [`METRICS`]
//! names the single numbers that tables, limits and comparisons speak of.

mod angles;
mod components;
mod connectivity;
mod curves;
mod degenerate;
mod distance;
mod edges;
mod face_field;
mod gauss_bonnet;
mod irregularity;
mod jacobian;
mod planarity;
mod registry;
mod shape;
mod stats;
mod summary;
mod t_junctions;
mod table;
#[cfg(test)]
mod tests;

pub use angles::Angles;
pub use components::ComponentRow;
pub use connectivity::Connectivity;
pub use curves::{Boundary, CurveDistance, Features};
pub use degenerate::Degenerate;
pub use distance::{MeshToReference, OneWay, Orientation, ReferenceMetrics, Target};
pub use edges::EdgeLength;
pub use face_field::{FACE_FIELDS, FaceField, FaceValues, face_values};
pub use gauss_bonnet::{GaussBonnet, LowerBounds};
pub use irregularity::{Histogram, Irregular, Irregularity, irregular_elements};
pub use jacobian::ScaledJacobian;
pub use registry::{Better, Kind, METRICS, Metric, metric};
pub use stats::Spread;
pub use summary::{DegenerateSummary, Summary};
pub use t_junctions::{TJunction, TJunctions, matched_t_junctions, t_junctions};
pub use table::{Change, Line, lines, table};

use crate::knobs::knobs;
use crate::mesh::{PolyMesh, Topology};
use crate::surface::SurfaceError;
use components::Components;
use serde::Serialize;
use shape::Shape;
use thiserror::Error;

/// Largest components that are listed.
const LISTED_COMPONENTS: usize = 8;

knobs! {
    /// How meshes are measured against a reference.
    pub struct MeasureOptions in "measure" {
        /// Samples of each surface for distances.
        samples: u32 = 200_000, in 1_000.0..=20_000_000.0, "samples";
        /// Dihedral angle above which an edge of the reference counts as sharp in reports.
        feature_angle_deg: f64 = 40.0, in 1.0..=180.0, "degrees";
    }
}

/// Why a mesh can not be measured.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum MetricsError {
    /// There is nothing to measure.
    #[error("the mesh has no faces")]
    NoFaces,
    /// The reference is no surface.
    #[error(transparent)]
    Reference(SurfaceError),
    /// The mesh is no surface, so that no distance to it can be found.
    #[error("no distance can be measured to the mesh: none of its faces has an area")]
    Mesh(#[source] SurfaceError),
}

/// All that is measured about one mesh.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Metrics {
    /// Counts.
    pub topology: TopologyMetrics,
    /// Shape of the elements.
    pub quality: Quality,
    /// Distances to the reference, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference: Option<ReferenceMetrics>,
    /// The numbers one looks at first.
    pub summary: Summary,
}

/// What is counted about the connectivity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TopologyMetrics {
    /// Sizes and topological type.
    #[serde(flatten)]
    pub connectivity: Connectivity,
    /// The index identity.
    pub gauss_bonnet: GaussBonnet,
    /// How few irregular elements the topology allows.
    #[serde(flatten)]
    pub lower_bounds: LowerBounds,
    /// The largest components, at most 8.
    pub component_table: Vec<ComponentRow>,
    /// Valences, degrees and irregular elements.
    #[serde(flatten)]
    pub irregularity: Irregularity,
    /// What no clean mesh has.
    pub degenerate: Degenerate,
}

/// What is measured about the elements.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Quality {
    /// Bounding-box diagonal of the used vertices, in the units of the input.
    pub bbox_diagonal: f64,
    /// Area of all faces, in the square of the units of the input.
    pub area: f64,
    /// Faces with less than 1e-14 of the squared diagonal.
    pub zero_area_faces: usize,
    /// Faces with less than 1e-4 of the median face.
    pub tiny_area_faces: usize,
    /// Corner angles.
    #[serde(flatten)]
    pub angles: Angles,
    /// Scaled Jacobian; `None` without quads.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scaled_jacobian_quads: Option<ScaledJacobian>,
    /// Distance of the diagonals over their mean length; `None` without quads.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planarity_quads: Option<Spread>,
    /// Faces with a corner beyond 180°.
    pub reflex_corner_faces: usize,
    /// Edge lengths.
    pub edge_length: EdgeLength,
    /// Longest over shortest edge of a face.
    pub face_edge_ratio: Spread,
    /// Edges across which the surface turns by more than 120°.
    pub folded_edges_dihedral_gt_120: usize,
    /// T-junctions.
    pub t_junctions: TJunctions,
}

impl TopologyMetrics {
    fn new(mesh: &PolyMesh, topology: &Topology) -> Self {
        let parts = Components::new(mesh, topology);
        Self {
            connectivity: Connectivity::new(mesh, topology, &parts),
            gauss_bonnet: GaussBonnet::new(&parts),
            lower_bounds: LowerBounds::new(&parts),
            component_table: parts.table(LISTED_COMPONENTS),
            irregularity: Irregularity::new(mesh, topology),
            degenerate: Degenerate::new(mesh, topology),
        }
    }
}

impl Quality {
    fn new(shape: &Shape) -> Self {
        let median = stats::percentile(&mut shape.areas.clone(), 50.0).unwrap_or(0.0);
        let nothing = 1e-14 * shape.diagonal * shape.diagonal;
        Self {
            bbox_diagonal: shape.diagonal,
            area: shape.areas.iter().sum(),
            zero_area_faces: shape.areas.iter().filter(|&&a| a <= nothing).count(),
            tiny_area_faces: shape.areas.iter().filter(|&&a| a < 1e-4 * median).count(),
            angles: Angles::new(shape),
            scaled_jacobian_quads: ScaledJacobian::new(shape),
            planarity_quads: planarity::planarity(shape),
            reflex_corner_faces: angles::reflex_corner_faces(shape),
            edge_length: EdgeLength::new(shape),
            face_edge_ratio: edges::face_edge_ratio(shape),
            folded_edges_dihedral_gt_120: edges::folded_edges(shape),
            t_junctions: TJunctions::new(shape),
        }
    }
}

/// Measures a mesh, and its distance to `target` if there is one. O(n log n) for n corners and
/// samples, in parallel; the same for any number of threads.
pub fn measure(mesh: &PolyMesh, target: Option<&Target>) -> Result<Metrics, MetricsError> {
    if mesh.face_count() == 0 {
        return Err(MetricsError::NoFaces);
    }
    measure_connected((mesh, &Topology::new(mesh)), target)
}

/// [`measure`] of a mesh with faces, where its connectivity is known.
pub(crate) fn measure_connected(
    (mesh, topology): (&PolyMesh, &Topology),
    target: Option<&Target>,
) -> Result<Metrics, MetricsError> {
    let shape = Shape::new(mesh, topology);
    let own = || (TopologyMetrics::new(mesh, topology), Quality::new(&shape));
    let distances = || target.map(|t| ReferenceMetrics::new(&shape, t)).transpose();
    let ((counts, quality), reference) = rayon::join(own, distances);
    let reference = reference?;
    let summary = Summary::new(&counts, &quality, reference.as_ref());
    Ok(Metrics { topology: counts, quality, reference, summary })
}
