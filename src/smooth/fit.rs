//! Where the corners of a face would have to be for a good shape.
//!
//! Quads: the nearest rectangle of bounded aspect. Other polygons: the best regular polygon, or,
//! if a corner hangs on a side (a T-junction), the rectangle of the other four. All shapes are
//! centred on the mean of the corners and counter-clockwise about the given normal, so a face
//! that is turned over is pulled right.

use std::f64::consts::FRAC_PI_2;

use crate::mesh::Vector;

/// What is asked of shapes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shape {
    /// The largest cosine between diagonals that needs no turning.
    sin_slant: f64,
    /// Cosine and sine of half the least and half the largest angle between diagonals.
    half_least: [f64; 2],
    half_most: [f64; 2],
    /// Cosine of the angle from which a corner hangs.
    cos_hang: f64,
}

impl Shape {
    pub(crate) fn new(slant_deg: f64, hang_deg: f64) -> Self {
        let slant = slant_deg.to_radians();
        let half = |angle: f64| [(angle * 0.5).cos(), (angle * 0.5).sin()];
        Self {
            sin_slant: slant.sin(),
            half_least: half(FRAC_PI_2 - slant),
            half_most: half(FRAC_PI_2 + slant),
            cos_hang: hang_deg.to_radians().cos(),
        }
    }
}

/// The nearest rectangle to four arms from a common centre, as arms from that centre. O(1).
pub(crate) fn rectangle(arms: &[Vector; 4], normal: &Vector, shape: &Shape) -> [Vector; 4] {
    let (u, v) = half_diagonals(arms, normal, shape);
    [-u, -v, u, v]
}

/// The last two arms of that rectangle; the other two are opposite.
///
/// The diagonals are made equally long; each is turned by half of what the angle between them
/// lacks. They are turned in their own plane if that faces like `normal`, otherwise in the plane
/// of `normal`, where a quad that is turned over has a negative angle.
#[inline]
pub(super) fn half_diagonals(
    arms: &[Vector; 4],
    normal: &Vector,
    shape: &Shape,
) -> (Vector, Vector) {
    let (d1, d2) = (arms[2] - arms[0], arms[3] - arms[1]);
    let (l1, l2) = (d1.norm(), d2.norm());
    let length = (l1 + l2) * 0.25;
    if d1.cross(&d2).dot(normal) > 0.0 && l1 * l2 > 0.0 {
        let (own1, own2) = (length / l1, length / l2);
        let cos = d1.dot(&d2) / (l1 * l2);
        if cos.abs() <= shape.sin_slant {
            return (d1 * own1, d2 * own2);
        }
        if 1.0 - cos * cos > 1e-12 {
            return opened(&(d1 * own1), &(d2 * own2), cos, shape);
        }
    }
    let (u, v) = turned(&d1, &d2, &unit(normal), shape);
    (u * length, v * length)
}

/// Equally long vectors at an angle with this cosine after turning them, in their plane, to the
/// nearest fair angle.
///
/// With b and p that long along u + v and v − u, such vectors at the angle a are
/// b cos(a/2) ∓ p sin(a/2).
fn opened(u: &Vector, v: &Vector, cos: f64, shape: &Shape) -> (Vector, Vector) {
    let [c, s] = if cos > 0.0 { shape.half_least } else { shape.half_most };
    let (along, across) = (c / (2.0 + 2.0 * cos).sqrt(), s / (2.0 - 2.0 * cos).sqrt());
    let (own, other) = (along + across, along - across);
    (u * own + v * other, v * own + u * other)
}

/// Unit directions of two diagonals in a plane after turning them to a fair angle.
#[cold]
fn turned(d1: &Vector, d2: &Vector, plane: &Vector, shape: &Shape) -> (Vector, Vector) {
    let flat = |d: &Vector| d - plane * plane.dot(d);
    let (mut u, mut v) = (unit(&flat(d1)), unit(&flat(d2)));
    // A collapsed diagonal has no direction: the other one says where it should point.
    if u == Vector::zeros() {
        u = v.cross(plane);
    } else if v == Vector::zeros() {
        v = plane.cross(&u);
    }
    let (sin, cos) = (plane.dot(&u.cross(&v)), u.dot(&v));
    if sin >= 0.0 && cos.abs() <= shape.sin_slant {
        return (u, v);
    }
    // The bisector of a negative angle is found alike; that angle is less than the least.
    let [c, s] = if sin >= 0.0 && cos < 0.0 { shape.half_most } else { shape.half_least };
    let bisector = if cos > 0.0 {
        unit(&(u + v))
    } else {
        unit(&(v - u)).cross(plane) * if sin >= 0.0 { 1.0 } else { -1.0 }
    };
    let across = plane.cross(&bisector);
    (bisector * c - across * s, bisector * c + across * s)
}

/// Replaces arms from a common centre by those of the best-fitting regular polygon. O(d).
///
/// With the arms as complex numbers z of the plane and ω = exp(2πi/d), the best similarity is
/// a = Σ z ω^−k / d, and corner k goes to a ω^k.
pub(super) fn regular_polygon(arms: &mut [Vector], normal: &Vector) {
    let plane = unit(normal);
    let (sin, cos) = (std::f64::consts::TAU / arms.len() as f64).sin_cos();
    let turn = |v: &Vector, (c, s): (f64, f64)| v * c + plane.cross(v) * s;
    let next = |(c, s): (f64, f64)| (c * cos - s * sin, s * cos + c * sin);
    let (mut power, mut first) = ((1.0, 0.0), Vector::zeros());
    for arm in arms.iter() {
        let flat = arm - plane * plane.dot(arm);
        first += turn(&flat, (power.0, -power.1));
        power = next(power);
    }
    first /= arms.len() as f64;
    power = (1.0, 0.0);
    for arm in arms.iter_mut() {
        *arm = turn(&first, power);
        power = next(power);
    }
}

/// Fits a polygon of five and more corners of which `may_hang` may be T-junctions. O(d²).
pub(crate) fn polygon(
    arms: &mut [Vector],
    may_hang: impl Fn(usize) -> bool,
    normal: &Vector,
    shape: &Shape,
) {
    let d = arms.len();
    let straight = |k: usize| {
        let (back, ahead) = (arms[(k + d - 1) % d] - arms[k], arms[(k + 1) % d] - arms[k]);
        back.dot(&ahead) <= shape.cos_hang * back.norm() * ahead.norm()
    };
    let (mut solid, mut count) = ([0; 4], 0);
    for k in (0..d).filter(|&k| !(may_hang(k) && straight(k))) {
        if count < 4 {
            solid[count] = k;
        }
        count += 1;
    }
    if count == 4 {
        hanging_rectangle(arms, solid, normal, shape);
    } else {
        regular_polygon(arms, normal);
    }
}

/// Fits a rectangle to the corners `solid`; the others go to their share of its sides.
fn hanging_rectangle(arms: &mut [Vector], solid: [usize; 4], normal: &Vector, shape: &Shape) {
    let d = arms.len();
    let four = solid.map(|k| arms[k]);
    let mean = four.iter().sum::<Vector>() * 0.25;
    let fitted = rectangle(&four.map(|a| a - mean), normal, shape).map(|a| a + mean);
    for side in 0..4 {
        let (from, to) = (solid[side], solid[(side + 1) % 4]);
        let steps = (to + d - from) % d;
        let at = |i: usize| (from + i) % d;
        let length = |arms: &[Vector], i: usize| (arms[at(i + 1)] - arms[at(i)]).norm();
        let whole: f64 = (0..steps).map(|i| length(arms, i)).sum();
        let (mut done, mut ahead) = (0.0, length(arms, 0));
        for i in 1..steps {
            done += ahead;
            // Before the corner at which this length begins is overwritten.
            ahead = length(arms, i);
            let share = if whole > 0.0 { done / whole } else { 0.5 };
            arms[at(i)] = fitted[side].lerp(&fitted[(side + 1) % 4], share);
        }
    }
    for (k, corner) in solid.into_iter().zip(fitted) {
        arms[k] = corner;
    }
}

fn unit(v: &Vector) -> Vector {
    v.try_normalize(0.0).unwrap_or_else(Vector::zeros)
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Vector = Vector::new(0.0, 0.0, 1.0);

    fn shape() -> Shape {
        Shape::new(20.0, 150.0)
    }

    fn flat(x: f64, y: f64) -> Vector {
        Vector::new(x, y, 0.0)
    }

    #[test]
    fn a_modest_rectangle_is_left_alone() {
        let arms = [flat(-1.3, -1.0), flat(1.3, -1.0), flat(1.3, 1.0), flat(-1.3, 1.0)];
        let fitted = rectangle(&arms, &UP, &shape());
        for (a, b) in arms.iter().zip(&fitted) {
            assert!((a - b).norm() < 1e-15);
        }
    }

    #[test]
    fn a_long_rectangle_is_shortened_to_the_bound() {
        let arms = [flat(-4.0, -1.0), flat(4.0, -1.0), flat(4.0, 1.0), flat(-4.0, 1.0)];
        let [a, b, c, _] = rectangle(&arms, &UP, &shape());
        let aspect = (b - a).norm() / (c - b).norm();
        assert!((aspect - 55f64.to_radians().tan()).abs() < 1e-12, "{aspect}");
        assert!((b - a).dot(&(c - b)).abs() < 1e-12, "right angles");
    }

    #[test]
    fn a_turned_over_quad_is_pulled_right() {
        let mut arms = [flat(-1.0, -1.0), flat(-1.0, 1.0), flat(1.0, 1.0), flat(1.0, -1.0)];
        let area = |a: &[Vector; 4]| (a[2] - a[0]).cross(&(a[3] - a[1])).z;
        assert!(area(&arms) < 0.0);
        arms = rectangle(&arms, &UP, &shape());
        assert!(area(&arms) > 0.0);
    }

    #[test]
    fn a_collapsed_diagonal_is_opened() {
        let arms = [flat(-1.0, 0.0), flat(0.0, 0.0), flat(1.0, 0.0), flat(0.0, 0.0)];
        let [a, b, c, d] = rectangle(&arms, &UP, &shape());
        assert!(((c - a).norm() - 1.0).abs() < 1e-12 && (c - a).cross(&(d - b)).z > 0.3);
    }

    #[test]
    fn a_regular_polygon_is_its_own_fit_and_noise_goes_away() {
        let regular: Vec<Vector> = (0..5)
            .map(|k| (f64::from(k) * std::f64::consts::TAU / 5.0 + 0.3).sin_cos())
            .map(|(s, c)| flat(c, s))
            .collect();
        let mut arms = regular.clone();
        regular_polygon(&mut arms, &UP);
        assert!(arms.iter().zip(&regular).all(|(a, b)| (a - b).norm() < 1e-14));
        arms[1] += Vector::new(0.2, -0.1, 0.4);
        regular_polygon(&mut arms, &UP);
        let side = |k: usize| (arms[(k + 1) % 5] - arms[k]).norm();
        assert!((1..5).all(|k| (side(k) - side(0)).abs() < 1e-14));
    }

    #[test]
    fn a_hanging_corner_goes_to_its_side() {
        let mut arms =
            [flat(-1.0, -1.0), flat(1.1, -1.0), flat(1.2, 0.2), flat(1.0, 1.0), flat(-1.0, 0.9)];
        polygon(&mut arms, |k| k == 2, &UP, &shape());
        let (a, h, b) = (arms[1], arms[2], arms[3]);
        assert!((h - a).cross(&(b - h)).norm() < 1e-14, "collinear");
        let share = (h - a).norm() / (b - a).norm();
        assert!((0.5..0.7).contains(&share), "about where it was: {share}");
    }
}
