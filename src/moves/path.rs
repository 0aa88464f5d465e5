//! Paths through the regular part of Q, and the lattice along them.
//!
//! Where all vertices have four edges, a walk in Q turns by quarters, so a path carries a lattice:
//! its first edge points along +x, and the sum of its edges is the separation of its ends.
//!
//! ```text
//!   back ─── v ─── 0          the next edge, counted counter-clockwise from the way back:
//!            │                1 turns right (3 quarters), 2 goes straight on, 3 turns left
//! ```
//! *Invariant:* the vertices between the ends are regular and free, so the turns are quarters.

use super::MoveRefusal;
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::VecDeque;
use std::ops::Add;

/// Longest path that is looked for, in edges of Q.
pub const REACH: usize = 400;

/// A direction in the lattice of a path, in quarter turns from its first edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Heading(u8);

impl Heading {
    /// `quarters` counter-clockwise from the first edge.
    #[must_use]
    pub const fn new(quarters: i32) -> Self {
        Self(quarters.rem_euclid(4) as u8)
    }

    /// Quarters counter-clockwise from `from` to this, 0…3.
    #[must_use]
    pub const fn from(self, from: Self) -> usize {
        (self.0 + 4 - from.0) as usize % 4
    }

    /// Turned by so many quarters counter-clockwise.
    #[must_use]
    pub const fn turned(self, quarters: i32) -> Self {
        Self::new(self.0 as i32 + quarters)
    }

    /// Quarters counter-clockwise from the first edge, 0…3.
    #[must_use]
    pub const fn quarters(self) -> i32 {
        self.0 as i32
    }
}

/// A vector in the lattice of a path, in edges of Q.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Offset {
    /// Along the first edge.
    pub x: i32,
    /// A quarter counter-clockwise of it.
    pub y: i32,
}

impl Offset {
    /// Turned by so many quarters counter-clockwise.
    #[must_use]
    pub const fn turned(self, quarters: i32) -> Self {
        let Self { x, y } = self;
        match quarters.rem_euclid(4) {
            0 => self,
            1 => Self { x: -y, y: x },
            2 => Self { x: -x, y: -y },
            _ => Self { x: y, y: -x },
        }
    }

    /// The same vector in the one of the four rotated lattices in which it is largest, to compare
    /// what was measured along different paths.
    #[must_use]
    pub fn canonical(self) -> Self {
        (0..4).map(|q| self.turned(q)).max().unwrap_or(self)
    }

    /// The axis nearest to it, the clockwise one of two.
    pub(super) fn nearest_axis(self) -> Heading {
        let near = |&q: &i32| {
            let Self { x, y } = self.turned(-q);
            x > 0 && -x <= y && y < x
        };
        Heading::new((0..4).find(near).unwrap_or(0))
    }

    /// The quarter of the plane that it lies in: 0 from +x up to, excluding, +y.
    pub(super) fn quadrant(self) -> Heading {
        let inside = |&q: &i32| {
            let Self { x, y } = self.turned(-q);
            x > 0 && y >= 0
        };
        Heading::new((0..4).find(inside).unwrap_or(0))
    }
}

impl From<Heading> for Offset {
    fn from(heading: Heading) -> Self {
        Self { x: 1, y: 0 }.turned(i32::from(heading.0))
    }
}

impl Add for Offset {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y }
    }
}

/// How the way of a move is chosen.
#[derive(Debug, Clone, Copy, Default)]
pub enum Route<'a> {
    /// The shortest path of regular elements on which the move is legal.
    #[default]
    Found,
    /// The path that leads through these elements (numbers of Q) one after the other; where they
    /// are not neighbours, the shortest one between them.
    Through(&'a [Vertex]),
}

impl Route<'_> {
    /// The same way from the other end; `store` keeps its stops.
    pub(super) fn reversed(self, store: &mut Vec<Vertex>) -> Route<'_> {
        let Self::Through(stops) = self else { return Route::Found };
        store.clear();
        store.extend(stops.iter().rev());
        Route::Through(store)
    }

    /// The same way once a first step has been made: through the stops that are still regular.
    pub(super) fn still<'a>(self, mesh: &QuadMesh, store: &'a mut Vec<Vertex>) -> Route<'a> {
        let Self::Through(stops) = self else { return Route::Found };
        store.clear();
        store.extend(stops.iter().filter(|&&v| is_regular(mesh, v)));
        Route::Through(store)
    }
}

/// A walk along half-edges of Q between two elements.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Path {
    half_edges: Vec<HalfEdge>,
    headings: Vec<Heading>,
}

impl Path {
    /// The shortest path between two different elements, through regular ones that are not
    /// `banned`; of several the one found first counter-clockwise. Linear in the part of the mesh
    /// that is nearer than the goal.
    pub fn find(
        mesh: &QuadMesh,
        from: Vertex,
        to: Vertex,
        route: Route,
        banned: &[Vertex],
    ) -> Result<Self, MoveRefusal> {
        let Route::Through(stops) = route else {
            return search(mesh, from, to, banned).map(|way| Self::along(mesh, way));
        };
        let mut way = Vec::new();
        let mut at = from;
        for &stop in stops.iter().chain([&to]).filter(|&&v| v != from) {
            if stop != to && !is_regular(mesh, stop) {
                return Err(MoveRefusal::BrokenPath(stop));
            }
            way.extend(search(mesh, at, stop, banned)?);
            at = stop;
        }
        let mut met = FxHashSet::default();
        match way.iter().map(|&h| mesh.target(h)).find(|&v| v == from || !met.insert(v)) {
            Some(twice) => Err(MoveRefusal::BrokenPath(twice)),
            None => Ok(Self::along(mesh, way)),
        }
    }

    /// The shortest paths to the irregular elements that are nearest to `from` by ways through
    /// regular ones, at most `count` of them and at most `reach` edges long.
    #[must_use]
    pub fn nearest(mesh: &QuadMesh, from: Vertex, count: usize, reach: usize) -> Vec<Self> {
        let mut reached = FxHashMap::default();
        let (mut ends, mut queue) = (Vec::new(), VecDeque::from([(from, 0)]));
        while let Some((v, length)) = queue.pop_front() {
            if length == reach || ends.len() >= count {
                break;
            }
            for h in mesh.outgoing(v) {
                let next = mesh.target(h);
                if next == from || reached.contains_key(&next) || mesh.is_ghost(next) {
                    continue;
                }
                reached.insert(next, h);
                if is_regular(mesh, next) {
                    queue.push_back((next, length + 1));
                } else if !mesh.is_on_line(next) {
                    ends.push(next);
                }
            }
        }
        let way = |to| Self::along(mesh, trace(mesh, &reached, from, to));
        ends.into_iter().filter(|&v| mesh.irregularity(v) > 0).map(way).collect()
    }

    fn along(mesh: &QuadMesh, half_edges: Vec<HalfEdge>) -> Self {
        let mut headings = vec![Heading::default()];
        for pair in half_edges.windows(2) {
            let turn = quarters(mesh, mesh.twin(pair[0]), pair[1]) + 2;
            headings.push(headings[headings.len() - 1].turned(turn));
        }
        Self { half_edges, headings }
    }

    /// The half-edges from end to end.
    #[must_use]
    pub fn half_edges(&self) -> &[HalfEdge] {
        &self.half_edges
    }

    /// The direction of each half-edge.
    #[must_use]
    pub fn headings(&self) -> &[Heading] {
        &self.headings
    }

    /// Where the far end lies, seen from the near one.
    #[must_use]
    pub fn separation(&self) -> Offset {
        self.headings.iter().fold(Offset::default(), |sum, &h| sum + h.into())
    }
}

/// Steps counter-clockwise from one half-edge to another of the same origin.
pub(crate) fn quarters(mesh: &QuadMesh, from: HalfEdge, to: HalfEdge) -> i32 {
    let (mut h, mut count) = (from, 0);
    while h != to && count < mesh.valence(mesh.origin(from)) as i32 {
        h = mesh.ccw(h);
        count += 1;
    }
    count
}

/// Whether a path may lead through `v`: four edges, and nothing holds it.
fn is_regular(mesh: &QuadMesh, v: Vertex) -> bool {
    let known = v < mesh.vertex_ids() && mesh.is_alive(v);
    known && mesh.valence(v) == 4 && !mesh.is_on_line(v) && !mesh.is_ghost(v)
}

/// Breadth first from `from` to `to`.
fn search(
    mesh: &QuadMesh,
    from: Vertex,
    to: Vertex,
    banned: &[Vertex],
) -> Result<Vec<HalfEdge>, MoveRefusal> {
    let mut reached = FxHashMap::default();
    let mut queue = VecDeque::from([(from, 0)]);
    while let Some((v, length)) = queue.pop_front() {
        for h in mesh.outgoing(v).filter(|_| length < REACH) {
            let next = mesh.target(h);
            let enters = next == to || (is_regular(mesh, next) && !banned.contains(&next));
            if next == from || !enters || reached.contains_key(&next) {
                continue;
            }
            reached.insert(next, h);
            if next == to {
                return Ok(trace(mesh, &reached, from, to));
            }
            queue.push_back((next, length + 1));
        }
    }
    Err(MoveRefusal::NoPath(from, to))
}

fn trace(
    mesh: &QuadMesh,
    reached: &FxHashMap<Vertex, HalfEdge>,
    from: Vertex,
    to: Vertex,
) -> Vec<HalfEdge> {
    let mut way = Vec::new();
    let mut at = to;
    while at != from {
        let h = reached[&at];
        way.push(h);
        at = mesh.origin(h);
    }
    way.reverse();
    way
}
