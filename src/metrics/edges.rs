//! Edge lengths (in the units of the input), their ratio inside a face, and folded edges.

use super::components::partner_pairs;
use super::shape::Shape;
use super::stats::{Spread, deviation, max, mean, min};
use serde::Serialize;

/// Edges whose faces meet at more than 120° have normals with a product below this.
const FOLDED_COS: f64 = -0.5;

/// Distribution of edge length over the edges of the soup.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EdgeLength {
    /// Mean, in the units of the input.
    pub mean: f64,
    /// Shortest.
    pub min: f64,
    /// Longest.
    pub max: f64,
    /// Coefficient of variation: standard deviation over mean; `None` if all have length 0.
    pub cv: Option<f64>,
    /// Longest over shortest; `None` if the shortest is 0.
    pub max_over_min: Option<f64>,
    /// Mean over the bounding-box diagonal.
    pub mean_over_diagonal: Option<f64>,
}

impl EdgeLength {
    /// Measures; all 0 without edges. O(edges).
    pub(super) fn new(shape: &Shape) -> Self {
        let edges = &shape.topology.edges;
        let lengths: Vec<f64> = edges.iter().map(|&h| shape.lengths[h as usize]).collect();
        let of = |x: Option<f64>| x.unwrap_or(0.0);
        let (mean, min, max) = (of(mean(&lengths)), of(min(&lengths)), of(max(&lengths)));
        Self {
            mean,
            min,
            max,
            cv: ratio(of(deviation(&lengths)), mean),
            max_over_min: ratio(max, min),
            mean_over_diagonal: ratio(mean, shape.diagonal),
        }
    }
}

/// Longest over shortest edge of each face.
pub(super) fn face_edge_ratio(shape: &Shape) -> Spread {
    let of_face = |face: std::ops::Range<usize>| {
        let lengths = &shape.lengths[face];
        Some(max(lengths)? / min(lengths)?)
    };
    Spread::of(shape.faces().filter_map(of_face))
}

/// Edges across which the surface turns by more than 120°.
pub(super) fn folded_edges(shape: &Shape) -> usize {
    let normal = |h: usize| &shape.normals[shape.topology.face[h] as usize];
    partner_pairs(shape.topology).filter(|&(h, t)| normal(h).dot(normal(t)) < FOLDED_COS).count()
}

fn ratio(above: f64, below: f64) -> Option<f64> {
    (below > 0.0).then(|| above / below)
}
