//! Distances from points to many line segments, by a tree of bounding boxes.
//!
//! *Invariant:* a node's box holds its segments; the left child of inner node i is node i + 1.

use crate::mesh::{Point, Vector};
use rayon::prelude::*;

/// Segments in a leaf.
const LEAF: usize = 4;

/// Segments with exact nearest-distance queries.
#[derive(Debug)]
pub(super) struct SegmentTree {
    segments: Vec<[Point; 2]>,
    nodes: Vec<Node>,
}

#[derive(Debug)]
struct Node {
    lo: Point,
    hi: Point,
    /// Segments of the node.
    range: std::ops::Range<u32>,
    /// The other child of an inner node, 0 in a leaf.
    right: u32,
}

impl SegmentTree {
    /// Builds the tree by median splits. O(n log n).
    pub(super) fn new(segments: Vec<[Point; 2]>) -> Self {
        let mut tree = Self { nodes: Vec::with_capacity(segments.len()), segments };
        if !tree.segments.is_empty() {
            tree.build(0..tree.segments.len());
        }
        tree
    }

    fn build(&mut self, range: std::ops::Range<usize>) -> u32 {
        let part = &mut self.segments[range.clone()];
        let ends = || part.iter().flatten();
        let lo = ends().fold(part[0][0], |lo, p| lo.inf(p));
        let hi = ends().fold(part[0][0], |hi, p| hi.sup(p));
        let id = self.nodes.len();
        let (leaf, axis) = (range.len() <= LEAF, (hi - lo).imax());
        self.nodes.push(Node { lo, hi, range: range.start as u32..range.end as u32, right: 0 });
        if !leaf {
            let middle = range.len() / 2;
            let twice_middle = |s: &[Point; 2]| s[0][axis] + s[1][axis];
            part.select_nth_unstable_by(middle, |a, b| twice_middle(a).total_cmp(&twice_middle(b)));
            self.build(range.start..range.start + middle);
            self.nodes[id].right = self.build(range.start + middle..range.end);
        }
        id as u32
    }

    /// Distance to the nearest segment; infinite without segments. O(log n) expected.
    pub(super) fn distance(&self, point: &Point) -> f64 {
        let mut best = f64::INFINITY;
        let mut stack = vec![(0.0, 0)];
        while let Some((bound, id)) = stack.pop() {
            let Some(node) = self.nodes.get(id as usize).filter(|_| bound < best) else { continue };
            if node.right == 0 {
                let part = &self.segments[node.range.start as usize..node.range.end as usize];
                best = part.iter().map(|s| squared_to_segment(point, s)).fold(best, f64::min);
                continue;
            }
            let child = |id: u32| (squared_to_box(point, &self.nodes[id as usize]), id);
            let (left, right) = (child(id + 1), child(node.right));
            // The nearer one goes on top.
            stack.extend(if left.0 < right.0 { [right, left] } else { [left, right] });
        }
        best.sqrt()
    }

    /// Distances of many points, in their order, in parallel.
    pub(super) fn distances(&self, points: &[Point]) -> Vec<f64> {
        points.par_iter().with_min_len(64).map(|p| self.distance(p)).collect()
    }
}

fn squared_to_segment(p: &Point, [a, b]: &[Point; 2]) -> f64 {
    let along = b - a;
    let length = along.norm_squared().max(f64::MIN_POSITIVE);
    let t = ((p - a).dot(&along) / length).clamp(0.0, 1.0);
    (p - a - along * t).norm_squared()
}

fn squared_to_box(p: &Point, node: &Node) -> f64 {
    let outside = (node.lo - p).sup(&(p - node.hi)).sup(&Vector::zeros());
    outside.norm_squared()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tree_finds_what_brute_force_finds() {
        let place = |i: u32| Point::from([0.7, 1.3, 2.9].map(|k| (f64::from(i) * k).sin()));
        let segments: Vec<[Point; 2]> =
            (0..200).map(|i| [place(i), place(i + 1) + (place(i) - place(i + 1)) * 0.8]).collect();
        let tree = SegmentTree::new(segments.clone());
        for i in 0..100 {
            let p = place(1000 + i) * 1.5;
            let all = segments.iter().map(|s| squared_to_segment(&p, s));
            let brute = all.fold(f64::INFINITY, f64::min).sqrt();
            assert!((tree.distance(&p) - brute).abs() < 1e-14);
        }
    }

    #[test]
    fn points_and_nothing_are_segments_too() {
        let origin = Point::origin();
        let p = Point::new(3.0, 4.0, 0.0);
        assert!((SegmentTree::new(vec![[origin, origin]; 9]).distance(&p) - 5.0).abs() < 1e-14);
        assert!(SegmentTree::new(Vec::new()).distance(&p).is_infinite());
    }
}
