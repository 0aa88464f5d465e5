//! Finding the closest of some faces, by balls around them and around groups of them.

use crate::mesh::{Point, Vector};
use crate::surface::squared_distance;

/// Faces of a group; those that follow one another should be near each other.
const GROUP: usize = 16;
/// What bounds are widened by: far more than they are rounded.
const MARGIN: f64 = 1.0 + 1e-9;

/// Faces to look for the closest one among; keeps its arrays from one set to the next.
#[derive(Debug, Clone, Default)]
pub(super) struct Cover {
    corners: Vec<Point>,
    /// Where the corners of each face end.
    ends: Vec<u32>,
    balls: Vec<Ball>,
    groups: Vec<Ball>,
    /// The face that was found last: the next query is mostly near the one before.
    last: usize,
}

#[derive(Debug, Clone, Copy)]
struct Ball {
    middle: Point,
    radius: f64,
}

impl Ball {
    /// Whether all of it is farther from `at` than `reach`.
    fn is_beyond(&self, at: &Point, reach: f64) -> bool {
        let most = self.radius + reach;
        (at - self.middle).norm_squared() > most * most
    }
}

impl Cover {
    /// Takes these faces instead of those before.
    pub(super) fn fill<F: IntoIterator<Item = Point>>(&mut self, faces: impl Iterator<Item = F>) {
        self.corners.clear();
        self.ends.clear();
        self.balls.clear();
        self.last = 0;
        for face in faces {
            let first = self.corners.len();
            self.corners.extend(face);
            self.ends.push(self.corners.len() as u32);
            let corners = &self.corners[first..];
            let middle = middle_of(corners);
            let radius = corners.iter().map(|p| (p - middle).norm()).fold(0.0, f64::max);
            self.balls.push(Ball { middle, radius: MARGIN * radius });
        }
        self.groups.clear();
        self.groups.extend(self.balls.chunks(GROUP).map(|balls| {
            let sum: Vector = balls.iter().map(|b| b.middle.coords).sum();
            let middle = Point::from(sum / balls.len() as f64);
            let far = |b: &Ball| (b.middle - middle).norm() + b.radius;
            Ball { middle, radius: MARGIN * balls.iter().map(far).fold(0.0, f64::max) }
        }));
    }

    /// The corners of face `i`.
    pub(super) fn corners(&self, i: usize) -> &[Point] {
        let first = if i == 0 { 0 } else { self.ends[i - 1] };
        &self.corners[first as usize..self.ends[i] as usize]
    }

    /// The squared distance from `at` to the closest face, and the number of the first that is so
    /// close, if that is less than `least`.
    pub(super) fn nearest(&mut self, at: &Point, least: f64) -> Option<(f64, usize)> {
        self.search(at, (least, f64::NEG_INFINITY))
    }

    /// Whether the squared distance from `at` to some face is at most `most`.
    pub(super) fn is_within(&mut self, at: &Point, most: f64) -> bool {
        self.search(at, (most.next_up(), most)).is_some()
    }

    /// The closest face if it is closer than `least`, or one that is close `enough`.
    fn search(&mut self, at: &Point, (least, enough): (f64, f64)) -> Option<(f64, usize)> {
        let (mut least, mut nearest) = (least, None);
        let guess = self.last;
        if guess < self.balls.len() {
            let squared = fan_distance(self.corners(guess), at);
            if squared < least {
                (least, nearest) = (squared, Some((squared, guess)));
            }
        }
        let mut reach = MARGIN * least.sqrt();
        for (k, group) in self.groups.iter().enumerate() {
            if least <= enough {
                break;
            }
            if group.is_beyond(at, reach) {
                continue;
            }
            for i in k * GROUP..self.balls.len().min((k + 1) * GROUP) {
                if i == guess || self.balls[i].is_beyond(at, reach) {
                    continue;
                }
                let squared = fan_distance(self.corners(i), at);
                if (squared, i) < nearest.unwrap_or((least, 0)) {
                    (least, nearest) = (squared, Some((squared, i)));
                    reach = MARGIN * squared.sqrt();
                }
            }
        }
        self.last = nearest.map_or(guess, |n| n.1);
        nearest
    }
}

/// Squared distance from `at` to a polygon, taken as triangles around its middle.
#[must_use]
pub(super) fn fan_distance(corners: &[Point], at: &Point) -> f64 {
    let n = corners.len();
    let middle = middle_of(corners);
    let triangles = (0..n).map(|i| [middle, corners[i], corners[(i + 1) % n]]);
    triangles.map(|t| squared_distance(at, &t)).fold(f64::INFINITY, f64::min)
}

/// The mean of the corners of a polygon.
#[must_use]
pub(super) fn middle_of(corners: &[Point]) -> Point {
    let sum: Vector = corners.iter().map(|p| p.coords).sum();
    Point::from(sum / corners.len().max(1) as f64)
}

/// Where a polygon is measured against a surface: its middle and those of its edges. Of a long one
/// that bends over a groove the middle alone may be on the surface.
pub(super) fn gauges(corners: &[Point]) -> impl Iterator<Item = Point> + '_ {
    let after = corners.iter().cycle().skip(1);
    let edges = corners.iter().zip(after).map(|(a, b)| nalgebra::center(a, b));
    std::iter::once(middle_of(corners)).chain(edges)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_face_is_measured_at_its_middle_and_its_edges() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let corners = corners.map(|[x, y]| Point::new(x, y, 0.0));
        let wanted = [[1.0, 1.0], [1.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]];
        let wanted: Vec<Point> = wanted.iter().map(|&[x, y]| Point::new(x, y, 0.0)).collect();
        assert_eq!(gauges(&corners).collect::<Vec<_>>(), wanted);
    }

    proptest! {
        #[test]
        fn the_nearest_is_what_looking_at_all_finds(
            faces in prop::collection::vec(
                prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 3..6), 1..60,
            ),
            at in prop::array::uniform3(-2.0..2.0f64),
            least in 0.0..4.0f64,
        ) {
            let (mut cover, at) = (Cover::default(), Point::from(at));
            cover.fill(faces.iter().map(|f| f.iter().map(|&p| Point::from(p))));
            for least in [least, f64::INFINITY] {
                let mut brute = None;
                for i in 0..faces.len() {
                    let squared = fan_distance(cover.corners(i), &at);
                    if squared < brute.map_or(least, |b: (f64, usize)| b.0) {
                        brute = Some((squared, i));
                    }
                }
                prop_assert_eq!(cover.nearest(&at, least), brute);
                prop_assert_eq!(cover.is_within(&at, least), brute.is_some());
            }
        }
    }
}
