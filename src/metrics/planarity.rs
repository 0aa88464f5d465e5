//! Planarity of quads: the distance between the lines of the two diagonals, relative to their
//! mean length. 0 is planar; up to 0.01 is the usual limit for flat glass panels (Liu et al.,
//! *Geometric modeling with conical meshes and developable surfaces*, 2006).

use super::shape::Shape;
use super::stats::Spread;
use std::ops::Range;

/// Measures all quads; `None` without quads. O(n) for n corners.
pub(super) fn planarity(shape: &Shape) -> Option<Spread> {
    shape.quads().next()?;
    Some(Spread::of(shape.quads().map(|quad| of_quad(shape, quad))))
}

/// The planarity of one quad.
pub(super) fn of_quad(shape: &Shape, quad: Range<usize>) -> f64 {
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| shape.point(quad.start + i));
    let (across, along) = (c - a, d - b);
    let normal = across.cross(&along);
    let length = 0.5 * (across.norm() + along.norm());
    (b - a).dot(&normal).abs() / normal.norm() / length
}
