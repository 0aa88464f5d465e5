//! How well a face holds together, whatever its number of corners.

use crate::mesh::{Point, Vector};

/// The sine of a corner below which a face of so many corners is broken: a quad is turned over
/// there, a triangle has hardly an area, and a larger polygon, which at a T-junction has a straight
/// corner, is reflex.
pub(crate) fn broken_below(corners: usize) -> f64 {
    match corners {
        3 => 0.2,
        4 => 0.0,
        _ => -0.1,
    }
}

/// The scaled Jacobian of a quad. Of another polygon 1, or, if it is broken, by how much: less
/// than 0.
pub(super) fn soundness(points: &[Point], face: &[u32]) -> f64 {
    let least = scaled_jacobian(points, face);
    let excess = least - broken_below(face.len());
    if face.len() == 4 || excess < 0.0 { excess } else { 1.0 }
}

/// The least sine of a corner of a face, negative where it turns against the face's area vector;
/// −1 if that is zero or two corners coincide. Of a quad that is the scaled Jacobian.
pub(super) fn scaled_jacobian(points: &[Point], face: &[u32]) -> f64 {
    let unit = corners_area(points, face).try_normalize(0.0);
    unit.map_or(-1.0, |unit| least_sine(points, face, &unit))
}

/// [`twice_area`] of a face by the numbers of its corners.
pub(super) fn corners_area(points: &[Point], face: &[u32]) -> Vector {
    twice_area(face.len(), |k| points[face[k] as usize])
}

/// A normal that is as long as twice the area of a face with so many corners, which `at` gives.
#[inline]
pub(crate) fn twice_area(corners: usize, at: impl Fn(usize) -> Point) -> Vector {
    if corners == 4 {
        return (at(2) - at(0)).cross(&(at(3) - at(1)));
    }
    (2..corners).map(|k| (at(k - 1) - at(0)).cross(&(at(k) - at(0)))).sum()
}

/// The least sine of a corner of a face, as seen along the unit vector `normal`; −1 where two
/// corners coincide.
pub(super) fn least_sine(points: &[Point], face: &[u32], normal: &Vector) -> f64 {
    let n = face.len();
    let p = |k: usize| points[face[k % n] as usize];
    let sine = |k: usize| {
        let (u, v) = (p(k + 1) - p(k), p(k + n - 1) - p(k));
        let scale = u.norm() * v.norm();
        if scale > 0.0 { u.cross(&v).dot(normal) / scale } else { -1.0 }
    };
    (0..n).map(sine).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(corners: &[[f64; 2]]) -> f64 {
        let points: Vec<Point> = corners.iter().map(|&[x, y]| Point::new(x, y, 0.0)).collect();
        let face: Vec<u32> = (0..points.len() as u32).collect();
        soundness(&points, &face)
    }

    #[test]
    fn quads_have_their_scaled_jacobian_and_others_are_sound_or_broken() {
        assert!((of(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]) - 1.0).abs() < 1e-12);
        assert!(of(&[[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]]) < -0.5, "an arrow");
        assert!((of(&[[0.0, 0.0], [1.0, 0.0], [0.3, 0.4]]) - 1.0).abs() < 1e-12);
        assert!(of(&[[0.0, 0.0], [1.0, 0.0], [0.5, 0.01]]) < 0.0, "hardly an area");
        let house = |x: f64| of(&[[0.0, 0.0], [1.0, 0.0], [x, 0.5], [1.0, 1.0], [0.0, 1.0]]);
        assert!((house(1.0) - 1.0).abs() < 1e-12, "a T-junction");
        assert!(house(0.7) < 0.0, "reflex");
    }
}
