//! A bounding-volume tree over triangles that answers "which point is closest?" exactly.
//!
//! Median splits in the manner of Ericson, *Real-Time Collision Detection* (2005), §6.2, two of
//! them a node, so that a node has four children whose boxes are tested together in single
//! precision (Dammertz, Hanika and Keller, *Shallow Bounding Volume Hierarchies*, 2008).
//!
//! The `bvh` crate does not fit: its nearest query is recursive, takes no starting bound and
//! breaks ties by traversal order. As a builder for this same search, with its splits by surface
//! area, it saved −1 to 4 % of the instructions of a query near the answer and 1 to 8 % from
//! nothing (on three meshes), and took a fifth more to build: too little for a dependency.
//!
//! *Invariant:* the answer is the smallest pair (computed distance, triangle number), whatever
//! the traversal order and the starting bound. Boxes are widened by far more than the rounding
//! of the distance computation, so pruning never cuts the winner.

use super::Hit;
use crate::mesh::{NONE, Point};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// Children of a node.
const WIDTH: usize = 4;
/// No distance is enough: the search is for the closest.
pub(super) const CLOSEST: f64 = -1.0;
/// Marks a child that is a triangle.
const LEAF_BIT: u32 = 1 << 31;
/// Every level has a fourth of the triangles of the one above and leaves at most all children
/// but one on the stack.
const STACK: usize = (WIDTH - 1) * 16 + 1;
/// What a box is widened by, relative to the whole: far more than single precision rounds.
const MARGIN: f32 = 1e-6;
/// What squared distances are widened by, for the same reason.
const SLACK: f64 = 1.0 + 2e-6;

/// The boxes of the children, axis by axis, and where the children are.
#[derive(Debug, Clone, Copy)]
struct Node {
    lo: [[f32; WIDTH]; 3],
    hi: [[f32; WIDTH]; 3],
    child: [u32; WIDTH],
}

impl Node {
    /// No child: no query is near any of the boxes.
    const EMPTY: Self =
        Self { lo: [[f32::MAX; WIDTH]; 3], hi: [[f32::MAX; WIDTH]; 3], child: [0; WIDTH] };

    fn set(&mut self, side: usize, bounds: &Bounds, child: u32) {
        for k in 0..3 {
            (self.lo[k][side], self.hi[k][side]) = (bounds.lo[k], bounds.hi[k]);
        }
        self.child[side] = child;
    }

    /// Squared distances of the boxes, all four at a time.
    // Inlined, or with iterators in place of the indices, it is not vectorised.
    #[allow(clippy::needless_range_loop)]
    #[inline(never)]
    fn distances(&self, query: &[f32; 3]) -> [f32; WIDTH] {
        let mut sum = [0.0; WIDTH];
        for k in 0..3 {
            for side in 0..WIDTH {
                let (below, above) = (self.lo[k][side] - query[k], query[k] - self.hi[k][side]);
                // Unlike `f32::max` this is one instruction: nothing here is NaN.
                let far = if below > above { below } else { above };
                let far = if far > 0.0 { far } else { 0.0 };
                sum[side] += far * far;
            }
        }
        sum
    }
}

/// The tree; triangle `i` is the `i`-th of the order that [`Tree::build`] returns.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// In the order in which the triangles use them, then the others: what a search looks up lies
    /// close together.
    points: Vec<Point>,
    /// Where each point is that the tree was given.
    place: Vec<u32>,
    /// The corners of each triangle, as numbers of points: the places themselves, side by side,
    /// would be as large as all the rest.
    triangles: Vec<[u32; 3]>,
    frame: Frame,
}

impl Tree {
    /// Builds the tree over `count` triangles, at least one, with the corners that `corners` gives
    /// as numbers of `points`, in O(n log n), parallel; also returns the order in which it stores
    /// them, which is spatially coherent.
    pub(super) fn build(
        points: &[Point],
        count: usize,
        corners: impl Fn(u32) -> [u32; 3] + Sync,
    ) -> (Self, Vec<u32>) {
        let numbers = || (0..count as u32).into_par_iter();
        let at = |t: u32| corners(t).map(|v| points[v as usize]);
        let frame = Frame::new(count, at);
        let item = |t: u32| Item { centre: frame.bounds(&at(t)).doubled_centre(), triangle: t };
        let mut items: Vec<Item> = numbers().map(item).collect();
        sort(&mut items);
        let order: Vec<u32> = items.into_iter().map(|item| item.triangle).collect();
        let mut triangles: Vec<[u32; 3]> = order.par_iter().map(|&t| corners(t)).collect();
        let (points, place) = in_order_of_use(points, triangles.as_flattened_mut());
        let mut tree = Self { nodes: Vec::new(), points, place, triangles, frame };
        tree.fill();
        (tree, order)
    }

    /// Lets the triangles, which keep their order, have other corners. The tree is then as right as
    /// one that is built anew, and as fast as long as neighbours stay neighbours. O(n), parallel.
    pub(super) fn follow(&mut self, points: &[Point], corners: impl Fn(u32) -> [u32; 3] + Sync) {
        let Self { points: own, place, triangles, .. } = self;
        for (&to, point) in place.iter().zip(points) {
            own[to as usize] = *point;
        }
        let placed = |t: usize| corners(t as u32).map(|v| place[v as usize]);
        triangles.par_iter_mut().enumerate().for_each(|(t, own)| *own = placed(t));
        self.frame = Frame::new(self.triangles.len(), |t| self.corners(t));
        self.fill();
    }

    /// Fills the nodes from the triangles.
    fn fill(&mut self) {
        let Self { nodes, points, triangles, frame, .. } = self;
        let mut counts = NodeCounts::default();
        // A single triangle has a node as well.
        nodes.resize(count_nodes(triangles.len(), &mut counts).max(1), Node::EMPTY);
        Part { nodes, number: 0, triangles, start: 0 }.fill(&Scene { frame, points, counts });
    }

    /// All points: first those that triangles use.
    pub(super) fn points(&self) -> &[Point] {
        &self.points
    }

    /// The number here of each point that the tree was given.
    pub(super) fn places(&self) -> &[u32] {
        &self.place
    }

    /// The corners of all triangles, as numbers of points.
    pub(super) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of triangle `t`.
    // Written out: a closure is not always inlined.
    #[inline]
    pub(super) fn corners(&self, t: u32) -> [Point; 3] {
        let [a, b, c] = self.triangles[t as usize];
        [self.points[a as usize], self.points[b as usize], self.points[c as usize]]
    }

    /// Squared distance and closest point of triangle `t`.
    pub(super) fn at(&self, t: u32, query: &Point) -> (f64, Point) {
        let on = closest_on_triangle(query, &self.corners(t));
        ((on - query).norm_squared(), on)
    }

    /// The best of `best` and all triangles that `accept` takes, or the first one found that is at
    /// most √`enough` away; O(log n) expected.
    // In one piece: with the stack in functions of its own it takes a fifth more instructions.
    pub(super) fn search(
        &self,
        query: &Point,
        mut best: Best,
        accept: impl Fn(u32) -> bool,
        enough: f64,
    ) -> Best {
        let place = self.frame.place(query);
        let known = best.triangle;
        let mut bound = self.frame.bound(best.squared);
        let mut stack = [(0u32, 0.0f32); STACK];
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let (code, near) = stack[top];
            if near > bound {
                continue;
            }
            if code & LEAF_BIT != 0 {
                let t = code & !LEAF_BIT;
                if t == known {
                    continue;
                }
                let (squared, point) = self.at(t, query);
                if (squared, t) < (best.squared, best.triangle) && accept(t) {
                    best = Best { squared, triangle: t, point };
                    if squared <= enough {
                        return best;
                    }
                    bound = self.frame.bound(squared);
                }
                continue;
            }
            let node = &self.nodes[code as usize];
            let base = top;
            for (near, child) in node.distances(&place).into_iter().zip(node.child) {
                if near <= bound {
                    // Nearer ones go above farther ones and are looked at first.
                    let mut at = top;
                    while at > base && stack[at - 1].1 < near {
                        stack[at] = stack[at - 1];
                        at -= 1;
                    }
                    stack[at] = (child, near);
                    top += 1;
                }
            }
        }
        best
    }
}

impl Tree {
    /// The closest point, if it is at most `radius` away. O(log n) expected.
    pub(super) fn closest(&self, query: &Point, radius: f64) -> Option<Hit> {
        self.search(query, Best::within(radius), |_| true, CLOSEST).hit()
    }

    /// Whether some triangle is at most `radius` away. O(log n) expected.
    pub(super) fn is_within(&self, query: &Point, radius: f64) -> bool {
        self.near(query, radius).is_some()
    }

    /// Some triangle that is at most `radius` away. O(log n) expected.
    pub(super) fn near(&self, query: &Point, radius: f64) -> Option<u32> {
        let best = self.search(query, Best::within(radius), |_| true, radius * radius);
        best.hit().map(|hit| hit.triangle)
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

/// Maps the triangles into the cube [−1, 1]³, where single precision is good enough for boxes.
#[derive(Debug, Clone, Copy)]
struct Frame {
    centre: Point,
    /// One over half the longest side of the bounding box.
    scale: f64,
}

impl Frame {
    fn new(count: usize, corners: impl Fn(u32) -> [Point; 3] + Sync) -> Self {
        let first = corners(0)[0];
        let wider = |(lo, hi): (Point, Point), p: &Point| (lo.inf(p), hi.sup(p));
        let (lo, hi) = (0..count as u32)
            .into_par_iter()
            .fold(|| (first, first), |all, t| corners(t).iter().fold(all, wider))
            .reduce(|| (first, first), |all, (lo, hi)| wider(wider(all, &lo), &hi));
        let centre = lo + (hi - lo) * 0.5;
        let scale = 1.0 / (hi - centre).amax();
        Self { centre, scale: if scale.is_normal() { scale } else { 1.0 } }
    }

    /// Where a query is; far ones are brought closer, so that squares of distances are finite.
    fn place(&self, query: &Point) -> [f32; 3] {
        const FAR: f64 = 1e9;
        let place = (query - self.centre) * self.scale;
        [0, 1, 2].map(|k| place[k].clamp(-FAR, FAR) as f32)
    }

    /// The largest squared distance of a box whose triangles may be within √`squared`.
    fn bound(&self, squared: f64) -> f32 {
        ((squared * self.scale * self.scale * SLACK) as f32).min(f32::MAX)
    }

    fn bounds(&self, corners: &[Point; 3]) -> Bounds {
        let mut bounds = Bounds::NONE;
        for place in corners.map(|p| self.place(&p)) {
            bounds = bounds.with(&Bounds { lo: place, hi: place });
        }
        Bounds { lo: bounds.lo.map(|x| x - MARGIN), hi: bounds.hi.map(|x| x + MARGIN) }
    }
}

/// A box in the frame.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    lo: [f32; 3],
    hi: [f32; 3],
}

impl Bounds {
    const NONE: Self = Self { lo: [f32::INFINITY; 3], hi: [f32::NEG_INFINITY; 3] };

    fn with(&self, other: &Self) -> Self {
        Self {
            lo: [0, 1, 2].map(|k| if other.lo[k] < self.lo[k] { other.lo[k] } else { self.lo[k] }),
            hi: [0, 1, 2].map(|k| if other.hi[k] > self.hi[k] { other.hi[k] } else { self.hi[k] }),
        }
    }

    fn doubled_centre(&self) -> [f32; 3] {
        [0, 1, 2].map(|k| self.lo[k] + self.hi[k])
    }
}

/// Triangles below which a part of the tree is built by one thread.
const TOGETHER: usize = 8192;

/// Does both, at the same time if they are long.
fn both<A: Send, B: Send>(
    long: bool,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    if long { rayon::join(a, b) } else { (a(), b()) }
}

/// How many of `count` triangles are in the first half of a split.
fn first_half(count: usize) -> usize {
    if count <= 1 {
        return count;
    }
    // Fours make full nodes at the bottom.
    let middle = count.div_ceil(2);
    if middle > WIDTH { middle.next_multiple_of(WIDTH).min(count) } else { middle }
}

/// How many nodes there are over so many triangles, two or more: by number of triangles. Parts of
/// one level have few different ones.
type NodeCounts = FxHashMap<usize, usize>;

/// Notes how many nodes there are over `count` triangles and over all parts of them.
fn count_nodes(count: usize, counts: &mut NodeCounts) -> usize {
    if count <= 1 {
        return 0;
    }
    if let Some(&known) = counts.get(&count) {
        return known;
    }
    let left = first_half(count);
    let quarters = [left, count - left].map(|half| {
        let first = first_half(half);
        [first, half - first]
    });
    let below: usize = quarters.as_flattened().iter().map(|&n| count_nodes(n, counts)).sum();
    counts.insert(count, 1 + below);
    1 + below
}

/// A triangle that is to be put in order. What a split compares lies side by side, so that nothing
/// has to be looked up all over the memory.
#[derive(Debug, Clone, Copy)]
struct Item {
    /// Twice the centre of its box.
    centre: [f32; 3],
    triangle: u32,
}

impl Item {
    /// Ordered as the place along an axis is (by `f32::total_cmp`), then as the triangle.
    fn key(&self, axis: usize) -> i64 {
        let bits = self.centre[axis].to_bits().cast_signed();
        let place = bits ^ ((bits >> 31).cast_unsigned() >> 1).cast_signed();
        (i64::from(place) << 32) | i64::from(self.triangle)
    }
}

/// Puts triangles in the order in which a tree stores them.
fn sort(items: &mut [Item]) {
    if items.len() > 1 {
        let many = items.len() > TOGETHER;
        let (left, right) = halve(items);
        both(many, || sort(left), || sort(right));
    }
}

/// Splits triangles in the middle of the axis along which they are spread most.
fn halve(items: &mut [Item]) -> (&mut [Item], &mut [Item]) {
    let middle = first_half(items.len());
    if middle < items.len() {
        let axis = widest_axis(items);
        items.select_nth_unstable_by_key(middle, |item| item.key(axis));
    }
    items.split_at_mut(middle)
}

fn widest_axis(items: &[Item]) -> usize {
    let centres = items.iter().map(|item| Bounds { lo: item.centre, hi: item.centre });
    let range = centres.fold(Bounds::NONE, |range, centre| range.with(&centre));
    let extent = |k: usize| range.hi[k] - range.lo[k];
    (1..3).fold(0, |best, k| if extent(k) > extent(best) { k } else { best })
}

/// The points in the order in which `corners` use them first, then the others; and where each has
/// gone, by which the corners are numbered now.
fn in_order_of_use(points: &[Point], corners: &mut [u32]) -> (Vec<Point>, Vec<u32>) {
    let mut place = vec![NONE; points.len()];
    let mut ordered = Vec::with_capacity(points.len());
    let mut take = |v: u32| {
        let at = &mut place[v as usize];
        if *at == NONE {
            *at = ordered.len() as u32;
            ordered.push(points[v as usize]);
        }
        *at
    };
    for corner in corners {
        *corner = take(*corner);
    }
    for v in 0..points.len() as u32 {
        take(v);
    }
    (ordered, place)
}

/// What boxes are made from.
struct Scene<'a> {
    frame: &'a Frame,
    points: &'a [Point],
    counts: NodeCounts,
}

/// A part of the tree whose nodes are to be filled.
struct Part<'a> {
    /// Its nodes.
    nodes: &'a mut [Node],
    /// Number of the first one.
    number: usize,
    /// Its triangles, in order.
    triangles: &'a [[u32; 3]],
    /// Number of the first one.
    start: usize,
}

impl Part<'_> {
    /// Fills the nodes; the bounds of all.
    fn fill(self, scene: &Scene) -> Bounds {
        let Part { nodes, number, triangles, start } = self;
        let many = triangles.len() > TOGETHER;
        let halves = triangles.split_at(first_half(triangles.len()));
        let [(a, b), (c, d)] =
            [halves.0, halves.1].map(|half| half.split_at(first_half(half.len())));
        let Some((node, mut nodes)) = nodes.split_first_mut() else { return Bounds::NONE };
        *node = Node::EMPTY;
        let (mut number, mut start) = (number + 1, start);
        let mut codes = [0; WIDTH];
        let parts = [a, b, c, d].map(|triangles| {
            let count = scene.counts.get(&triangles.len()).copied().unwrap_or(0);
            let (own, rest) = std::mem::take(&mut nodes).split_at_mut(count);
            nodes = rest;
            let part = Part { nodes: own, number, triangles, start };
            (number, start) = (number + count, start + triangles.len());
            part
        });
        for (code, part) in codes.iter_mut().zip(&parts) {
            let leaf = LEAF_BIT | part.start as u32;
            *code = if part.triangles.len() == 1 { leaf } else { part.number as u32 };
        }
        let sizes = [0, 1, 2, 3].map(|k| parts[k].triangles.len());
        let [a, b, c, d] = parts;
        let ((a, b), (c, d)) = both(
            many,
            || both(many, || a.bounds(scene), || b.bounds(scene)),
            || both(many, || c.bounds(scene), || d.bounds(scene)),
        );
        let mut whole = Bounds::NONE;
        for (side, bounds) in [a, b, c, d].into_iter().enumerate().filter(|&(k, _)| sizes[k] > 0) {
            node.set(side, &bounds, codes[side]);
            whole = whole.with(&bounds);
        }
        whole
    }

    /// The bounds of a part, which is filled if it is more than a triangle.
    fn bounds(self, scene: &Scene) -> Bounds {
        match self.triangles {
            [] => Bounds::NONE,
            [t] => scene.frame.bounds(&t.map(|v| scene.points[v as usize])),
            _ => self.fill(scene),
        }
    }
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
