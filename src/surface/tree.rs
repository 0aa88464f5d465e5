//! A bounding-volume tree over triangles that answers "which point is closest?" exactly.
//!
//! A median-split tree in the manner of Ericson, *Real-Time Collision Detection* (2005), §6.2.
//! The `bvh` crate does not fit: its surface-area cost is 0/0 on collinear sets (feature
//! segments!), its nearest query is recursive, takes no starting bound and breaks ties by
//! traversal order.
//!
//! *Invariant:* the answer is the smallest pair (computed distance, triangle number), whatever
//! the traversal order and the starting bound. Boxes are widened by far more than the rounding
//! of the distance computation, so pruning never cuts the winner.

use super::Hit;
use crate::mesh::Point;

/// Most triangles of a leaf.
const LEAF: usize = 4;
/// Marks a child that is a leaf; three bits of length and 28 bits of start follow.
const LEAF_BIT: u32 = 1 << 31;
/// Median splits halve the count, so no path is longer than the number of bits of an id.
const STACK: usize = 64;

/// Two child boxes and where the children are.
#[derive(Debug, Clone, Copy)]
struct Node {
    lo: [[f32; 3]; 2],
    hi: [[f32; 3]; 2],
    child: [u32; 2],
}

/// The tree; triangle `i` is the `i`-th of the order that [`Tree::build`] returns.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    triangles: Vec<[Point; 3]>,
}

impl Tree {
    /// Builds the tree over at least one triangle, in O(n log n); also returns the order in
    /// which it stores the triangles, which is spatially coherent.
    pub(super) fn build(triangles: &[[Point; 3]]) -> (Self, Vec<u32>) {
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        let centres: Vec<Point> = triangles
            .iter()
            .map(|[a, b, c]| Point::from((a.coords + b.coords + c.coords) / 3.0))
            .collect();
        let scale = triangles.iter().flatten().fold(0.0, |m: f64, p| m.max(p.coords.amax()));
        let mut builder =
            Builder { triangles, centres: &centres, nodes: Vec::new(), margin: scale * 1e-6 };
        if order.len() <= LEAF {
            let (lo, hi) = builder.bounds(&order);
            let child = [leaf(0, order.len()), leaf(0, 0)];
            builder.nodes.push(Node { lo: [lo; 2], hi: [hi; 2], child });
        } else {
            builder.split(&mut order, 0);
        }
        let nodes = builder.nodes;
        let triangles = order.iter().map(|&t| triangles[t as usize]).collect();
        (Self { nodes, triangles }, order)
    }

    /// The corners of triangle `t`.
    pub(super) fn corners(&self, t: u32) -> &[Point; 3] {
        &self.triangles[t as usize]
    }

    /// Squared distance and closest point of triangle `t`.
    pub(super) fn at(&self, t: u32, query: &Point) -> (f64, Point) {
        let on = closest_on_triangle(query, self.corners(t));
        ((on - query).norm_squared(), on)
    }

    /// The best of `best` and all triangles that `accept` takes; O(log n) expected.
    pub(super) fn search(
        &self,
        query: &Point,
        mut best: Best,
        accept: impl Fn(u32) -> bool,
    ) -> Best {
        let mut stack = [(0u32, 0.0f64); STACK];
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let (code, bound) = stack[top];
            if bound > best.squared {
                continue;
            }
            if code & LEAF_BIT != 0 {
                self.scan(code, query, &mut best, &accept);
                continue;
            }
            let node = &self.nodes[code as usize];
            let near = [box_distance(node, 0, query), box_distance(node, 1, query)];
            let first = usize::from(near[1] < near[0]);
            // The farther child goes below the nearer one, which is looked at next.
            for side in [1 - first, first] {
                if near[side] <= best.squared {
                    stack[top] = (node.child[side], near[side]);
                    top += 1;
                }
            }
        }
        best
    }

    fn scan(&self, code: u32, query: &Point, best: &mut Best, accept: &impl Fn(u32) -> bool) {
        let start = code & 0x0fff_ffff;
        for t in start..start + ((code >> 28) & 7) {
            let (squared, point) = self.at(t, query);
            if (squared, t) < (best.squared, best.triangle) && accept(t) {
                *best = Best { squared, triangle: t, point };
            }
        }
    }
}

/// The best candidate of a search so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Best {
    pub(super) squared: f64,
    pub(super) triangle: u32,
    pub(super) point: Point,
}

impl Best {
    /// Nothing found yet within `radius`; triangles at exactly that distance count.
    pub(super) fn within(radius: f64) -> Self {
        Self { squared: radius * radius, triangle: u32::MAX, point: Point::origin() }
    }

    /// Whether a triangle was found.
    pub(super) fn hit(&self) -> Option<Hit> {
        (self.triangle != u32::MAX).then(|| Hit {
            triangle: self.triangle,
            point: self.point,
            distance: self.squared.sqrt(),
        })
    }
}

struct Builder<'a> {
    triangles: &'a [[Point; 3]],
    centres: &'a [Point],
    nodes: Vec<Node>,
    margin: f64,
}

impl Builder<'_> {
    /// Adds the node over `order`, whose first element is number `start` of the whole order.
    fn split(&mut self, order: &mut [u32], start: usize) -> u32 {
        if order.len() <= LEAF {
            return leaf(start, order.len());
        }
        let axis = self.widest_axis(order);
        let middle = order.len() / 2;
        let key = |t: u32| self.centres[t as usize][axis];
        order.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
        let (left, right) = order.split_at_mut(middle);
        let ((lo0, hi0), (lo1, hi1)) = (self.bounds(left), self.bounds(right));
        let at = self.nodes.len();
        self.nodes.push(Node { lo: [lo0, lo1], hi: [hi0, hi1], child: [0; 2] });
        let child = [self.split(left, start), self.split(right, start + middle)];
        self.nodes[at].child = child;
        at as u32
    }

    fn widest_axis(&self, order: &[u32]) -> usize {
        let first = self.centres[order[0] as usize];
        let (lo, hi) = order.iter().fold((first, first), |(lo, hi), &t| {
            let c = &self.centres[t as usize];
            (lo.inf(c), hi.sup(c))
        });
        (hi - lo).imax()
    }

    /// The box of some triangles, widened so that single precision and rounding do no harm.
    fn bounds(&self, order: &[u32]) -> ([f32; 3], [f32; 3]) {
        let (mut lo, mut hi) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in order.iter().flat_map(|&t| &self.triangles[t as usize]) {
            for k in 0..3 {
                (lo[k], hi[k]) = (lo[k].min(p[k]), hi[k].max(p[k]));
            }
        }
        (lo.map(|x| (x - self.margin) as f32), hi.map(|x| (x + self.margin) as f32))
    }
}

fn leaf(start: usize, len: usize) -> u32 {
    LEAF_BIT | (len as u32) << 28 | start as u32
}

fn box_distance(node: &Node, side: usize, query: &Point) -> f64 {
    let mut sum = 0.0;
    for k in 0..3 {
        let (lo, hi) = (f64::from(node.lo[side][k]), f64::from(node.hi[side][k]));
        let d = (lo - query[k]).max(query[k] - hi).max(0.0);
        sum += d * d;
    }
    sum
}

/// The closest point of a triangle, which may be degenerate (Ericson 2005, §5.1.5). O(1).
pub(super) fn closest_on_triangle(p: &Point, [a, b, c]: &[Point; 3]) -> Point {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return *a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return *b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return *c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let scale = 1.0 / (va + vb + vc);
    a + ab * (vb * scale) + ac * (vc * scale)
}
