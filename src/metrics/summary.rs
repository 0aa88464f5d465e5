//! The numbers one looks at first, under short names.

use super::{Degenerate, Quality, ReferenceMetrics, TopologyMetrics};
use serde::Serialize;

/// A digest of [`Metrics`](super::Metrics).
// Each flag answers a question of its own; there is no state machine in them.
#[allow(clippy::struct_excessive_bools)]
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Used vertices.
    #[serde(rename = "V")]
    pub vertices: usize,
    /// Edges.
    #[serde(rename = "E")]
    pub edges: usize,
    /// Faces.
    #[serde(rename = "F")]
    pub faces: usize,
    /// Euler characteristic of the cut mesh.
    pub chi: i64,
    /// Components of the cut mesh.
    pub components: usize,
    /// Handles.
    pub genus: i64,
    /// Boundary loops.
    pub boundary_loops: usize,
    /// Edges with one face.
    pub boundary_edges: usize,
    /// Whether edges and vertices are manifold.
    pub manifold: bool,
    /// Whether all faces agree in orientation.
    pub oriented: bool,
    /// Whether Σ index = 4 χ on every component.
    pub gauss_bonnet_exact: bool,
    /// Whether all faces are quads.
    pub pure_quad: bool,
    /// E = Σ |4 − n| + Σ |4 − d|.
    pub irregular_elements: usize,
    /// Percentage of interior vertices that are irregular.
    pub pct_irregular_vertices: f64,
    /// Percentage of faces that are irregular.
    pub pct_irregular_faces: f64,
    /// T-junctions by maximum matching.
    pub t_junctions: usize,
    /// T-junctions by the literal definition.
    pub t_pairs_v3_f5: usize,
    /// Fewest irregular elements with this boundary.
    pub lower_bound: i64,
    /// What no clean mesh has.
    pub degenerate: DegenerateSummary,
    /// Mean scaled Jacobian of quads.
    pub scaled_jacobian_mean: Option<f64>,
    /// Worst scaled Jacobian of quads.
    pub scaled_jacobian_min: Option<f64>,
    /// Mean |angle − 90°| over corners of quads.
    pub angle_dev_mean: Option<f64>,
    /// Mean over faces of the deviation of angles from their mean, in degrees.
    pub fig10_mean: Option<f64>,
    /// Coefficient of variation of edge length.
    pub edge_cv: Option<f64>,
    /// Larger of the two one-sided Hausdorff distances over the diagonal of the reference.
    pub hausdorff: Option<f64>,
    /// Larger of the two root-mean-square distances over the diagonal of the reference.
    pub rms: Option<f64>,
    /// Faces that look away from the reference.
    pub flipped_faces: Option<usize>,
}

/// [`Degenerate`] and the faces without area.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct DegenerateSummary {
    /// Degenerate connectivity.
    #[serde(flatten)]
    pub connectivity: Degenerate,
    /// Faces without area.
    pub zero_area_faces: usize,
}

impl Summary {
    pub(super) fn new(
        topology: &TopologyMetrics,
        quality: &Quality,
        reference: Option<&ReferenceMetrics>,
    ) -> Self {
        let connectivity = &topology.connectivity;
        let irregular = &topology.irregularity.irregular;
        Self {
            vertices: connectivity.vertices,
            edges: connectivity.edges,
            faces: connectivity.faces,
            chi: connectivity.euler_cut,
            components: connectivity.components,
            genus: connectivity.genus,
            boundary_loops: connectivity.boundary_loops,
            boundary_edges: connectivity.boundary_edges,
            manifold: connectivity.edge_manifold && connectivity.vertex_manifold,
            oriented: connectivity.consistently_oriented,
            gauss_bonnet_exact: topology.gauss_bonnet.holds_per_component,
            pure_quad: topology.irregularity.pure_quad,
            irregular_elements: irregular.elements,
            pct_irregular_vertices: irregular.pct_irregular_interior_vertices,
            pct_irregular_faces: irregular.pct_irregular_faces,
            t_junctions: quality.t_junctions.matched,
            t_pairs_v3_f5: quality.t_junctions.pairs_v3_f5,
            lower_bound: topology.lower_bounds.fixed_boundary,
            degenerate: DegenerateSummary {
                connectivity: topology.degenerate,
                zero_area_faces: quality.zero_area_faces,
            },
            scaled_jacobian_mean: quality.scaled_jacobian_quads.map(|j| j.mean),
            scaled_jacobian_min: quality.scaled_jacobian_quads.map(|j| j.min),
            angle_dev_mean: quality.angles.angle_dev_from_90_quads_deg.mean,
            fig10_mean: quality.angles.fig10_face_angle_deviation_deg.mean,
            edge_cv: quality.edge_length.cv,
            hausdorff: reference.map(|r| r.hausdorff),
            rms: reference.map(|r| r.rms),
            flipped_faces: reference.map(|r| r.orientation.flipped_faces),
        }
    }
}
