//! Scaled Jacobian of quads: the smallest sine of a signed corner angle (Knupp, *Achieving finite
//! element mesh quality via optimization of the Jacobian matrix norm*, 2000). 1 is a rectangle,
//! below 0 the quad is inverted or has a reflex corner.

use super::shape::Shape;
use super::stats::{mean, min, percentile, share};
use serde::Serialize;
use std::ops::Range;

/// Distribution of the scaled Jacobian over quads.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ScaledJacobian {
    /// The worst quad.
    pub min: f64,
    /// 1st percentile.
    pub p1: f64,
    /// Mean.
    pub mean: f64,
    /// Share of quads below 0.
    pub share_below_0: f64,
    /// Number of quads below 0.
    pub count_below_0: usize,
    /// Share of quads below 0.3.
    #[serde(rename = "share_below_0.3")]
    pub share_below_0_3: f64,
}

impl ScaledJacobian {
    /// Measures; `None` without quads. O(n) for n corners.
    pub(super) fn new(shape: &Shape) -> Option<Self> {
        let mut values: Vec<f64> = shape.quads().map(|quad| of_quad(shape, quad)).collect();
        let below = |limit: f64| values.iter().filter(|&&j| j < limit).count();
        let (below_0, below_0_3) = (below(0.0), below(0.3));
        Some(Self {
            min: min(&values)?,
            mean: mean(&values)?,
            share_below_0: share(below_0, values.len()),
            count_below_0: below_0,
            share_below_0_3: share(below_0_3, values.len()),
            p1: percentile(&mut values, 1.0)?,
        })
    }
}

/// The scaled Jacobian of one quad.
pub(super) fn of_quad(shape: &Shape, quad: Range<usize>) -> f64 {
    // A corner at an edge of no length is as bad as an inverted one.
    let defined = |j: f64| if j.is_nan() { -1.0 } else { j };
    shape.jacobians[quad].iter().fold(f64::INFINITY, |w, &j| w.min(defined(j)))
}
