//! How far corner angles are from what they should be, in degrees.
//!
//! `fig10` is the measure of Peng & Wonka 2013, Figure 10: for each face the mean distance of its
//! angles from their own mean, so that a regular pentagon is as good as a square.

use super::shape::Shape;
use super::stats::Spread;
use serde::Serialize;

/// Angles above this many degrees are reflex; the margin is far above the rounding of an arc
/// cosine near 180°, so that straight corners do not count.
const REFLEX_DEG: f64 = 180.0 + 1e-6;

/// Deviations of corner angles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Angles {
    /// |angle − 90°| over the corners of quads.
    pub angle_dev_from_90_quads_deg: Spread,
    /// |angle − 90°| over the corners of all faces.
    pub angle_dev_from_90_all_deg: Spread,
    /// Mean |angle − mean angle of the face| over faces.
    pub fig10_face_angle_deviation_deg: Spread,
}

impl Angles {
    /// Measures. O(n) for n corners.
    pub(super) fn new(shape: &Shape) -> Self {
        let off = |a: &f64| (a - 90.0).abs();
        let quads = shape.quads().flat_map(|quad| &shape.angles_deg[quad]);
        Self {
            angle_dev_from_90_quads_deg: Spread::of(quads.map(off)),
            angle_dev_from_90_all_deg: Spread::of(shape.angles_deg.iter().map(off)),
            fig10_face_angle_deviation_deg: Spread::of(
                shape.faces().map(|face| deviation_from_mean(&shape.angles_deg[face])),
            ),
        }
    }
}

/// Faces with a corner beyond 180°.
pub(super) fn reflex_corner_faces(shape: &Shape) -> usize {
    let reflex = |face: &std::ops::Range<usize>| {
        shape.angles_deg[face.clone()].iter().any(|&a| a > REFLEX_DEG)
    };
    shape.faces().filter(reflex).count()
}

/// Mean distance from the mean; an undefined angle counts as a right one.
pub(super) fn deviation_from_mean(angles: &[f64]) -> f64 {
    let defined = |a: &f64| if a.is_nan() { 90.0 } else { *a };
    let count = angles.len().max(1) as f64;
    let mean = angles.iter().map(defined).sum::<f64>() / count;
    angles.iter().map(|a| (defined(a) - mean).abs()).sum::<f64>() / count
}
