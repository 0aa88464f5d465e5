//! Line segments with exact closest-point queries.

use super::tree::Tree;
use crate::mesh::Point;
use rayon::prelude::*;

/// Segments in a tree: each is a triangle with a double corner. There is no tree without segments.
#[derive(Debug, Clone)]
pub(crate) struct Segments {
    tree: Option<Tree>,
}

impl Segments {
    /// Puts segments in a tree; also returns the order in which that has them, which is spatially
    /// coherent. O(n log n), parallel.
    pub(crate) fn new(segments: &[[Point; 2]]) -> (Self, Vec<u32>) {
        let count = segments.len();
        if count == 0 {
            return (Self { tree: None }, Vec::new());
        }
        let flat = |s: u32| [2 * s, 2 * s + 1, 2 * s + 1];
        let (tree, order) = Tree::build(segments.as_flattened(), count, flat);
        (Self { tree: Some(tree) }, order)
    }

    /// The closest point that is at most `radius` away. O(log n) expected.
    pub(crate) fn closest(&self, query: &Point, radius: f64) -> Option<Point> {
        self.tree.as_ref()?.closest(query, radius).map(|hit| hit.point)
    }

    /// The closest segment, by its place in the order of the tree, and its distance; `None` without
    /// segments. O(log n) expected.
    pub(crate) fn nearest(&self, query: &Point) -> Option<(u32, f64)> {
        let hit = self.tree.as_ref()?.closest(query, f64::INFINITY)?;
        Some((hit.triangle, hit.distance))
    }

    /// Whether a segment is at most `radius` away. O(log n) expected.
    pub(crate) fn is_within(&self, query: &Point, radius: f64) -> bool {
        self.tree.as_ref().is_some_and(|tree| tree.is_within(query, radius))
    }

    /// Distances of many points to the nearest segment, in their order; infinite without segments.
    /// Parallel.
    pub(crate) fn distances(&self, points: &[Point]) -> Vec<f64> {
        let distance = |p| self.nearest(p).map_or(f64::INFINITY, |(_, distance)| distance);
        points.par_iter().with_min_len(64).map(distance).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tree_finds_what_brute_force_finds() {
        let place = |i: u32| Point::from([0.7, 1.3, 2.9].map(|k| (f64::from(i) * k).sin()));
        let segments: Vec<[Point; 2]> =
            (0..200).map(|i| [place(i), place(i + 1) + (place(i) - place(i + 1)) * 0.8]).collect();
        let points: Vec<Point> = (0..100).map(|i| place(1000 + i) * 1.5).collect();
        let found = Segments::new(&segments).0.distances(&points);
        for (p, found) in points.iter().zip(found) {
            let squared = |[a, b]: &[Point; 2]| {
                let t = (p - a).dot(&(b - a)) / (b - a).norm_squared();
                (p - a - (b - a) * t.clamp(0.0, 1.0)).norm_squared()
            };
            let brute = segments.iter().map(squared).fold(f64::INFINITY, f64::min).sqrt();
            assert!((found - brute).abs() < 1e-14);
        }
    }

    #[test]
    fn points_and_nothing_are_segments_too() {
        let (origin, p) = (Point::origin(), Point::new(3.0, 4.0, 0.0));
        let distance = |segments: &[[Point; 2]]| Segments::new(segments).0.distances(&[p])[0];
        assert!((distance(&[[origin, origin]; 9]) - 5.0).abs() < 1e-14);
        assert!(distance(&[]).is_infinite());
    }
}
