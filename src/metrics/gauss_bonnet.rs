//! The discrete Gauss-Bonnet identity (Peng & Wonka 2013, equation 1) in its exact form.
//!
//! Σ boundary (1 − e) + Σ interior (4 − n) + Σ faces (4 − d) = 4 χ for each component, where e is
//! the number of incident *interior edges*. The paper counts edges to interior *vertices*; that
//! "literal" reading is off by 2 for each chord and is reported beside the exact one.

use super::components::Components;
use serde::Serialize;

/// Both sides of the identity.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct GaussBonnet {
    /// Σ (1 − e) over boundary vertices.
    pub sum_boundary: i64,
    /// Σ (4 − n) over interior vertices.
    pub sum_interior_vertices: i64,
    /// Σ (4 − d) over faces.
    pub sum_faces: i64,
    /// Four times the Euler characteristic.
    pub four_chi: i64,
    /// Whether it is exact on every component.
    pub holds_per_component: bool,
    /// Largest violation.
    pub max_abs_residual: i64,
    /// Whether the literal reading of the paper holds on every component.
    pub literal_holds_per_component: bool,
    /// What the literal reading is off by, in all.
    pub literal_residual: i64,
    /// Whether chords explain that.
    pub literal_residual_explained_by_chords: bool,
}

impl GaussBonnet {
    /// Evaluates both sides. O(components).
    pub(super) fn new(parts: &Components) -> Self {
        let all = |test: fn(i64, i64) -> bool| {
            parts.tallies.iter().all(|t| test(t.residual(), 2 * t.chords))
        };
        Self {
            sum_boundary: parts.sum(|t| t.boundary_index),
            sum_interior_vertices: parts.sum(|t| t.vertex_index),
            sum_faces: parts.sum(|t| t.face_index),
            four_chi: 4 * parts.sum(|t| t.chi),
            holds_per_component: all(|residual, _| residual == 0),
            max_abs_residual: parts.tallies.iter().map(|t| t.residual().abs()).max().unwrap_or(0),
            literal_holds_per_component: all(|residual, chords| residual + chords == 0),
            literal_residual: parts.sum(|t| t.residual() + 2 * t.chords),
            literal_residual_explained_by_chords: all(|residual, _| residual == 0),
        }
    }
}

/// The fewest irregular elements that the identity allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct LowerBounds {
    /// With the boundary as it is.
    #[serde(rename = "lower_bound_irregular_fixed_boundary")]
    pub fixed_boundary: i64,
    /// Counting closed components only.
    #[serde(rename = "lower_bound_irregular_closed_components")]
    pub closed_components: i64,
}

impl LowerBounds {
    /// Sums |4 χ − Σ boundary| over the components.
    pub(super) fn new(parts: &Components) -> Self {
        Self {
            fixed_boundary: parts.sum(|t| (4 * t.chi - t.boundary_index).abs()),
            closed_components: parts.sum(|t| if t.loops == 0 { (4 * t.chi).abs() } else { 0 }),
        }
    }
}
