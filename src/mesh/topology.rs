//! Connectivity of a polygon soup, cut at its non-manifold edges and vertices.
//!
//! A half-edge is a corner: corner `c` of a face is the half-edge from its vertex to the next one
//! of the face. Two half-edges are partners if they are the only two on their edge; an edge with
//! three or more faces is cut, and so every run of corners around a vertex (a *fan*) counts as a
//! vertex of its own. On a manifold mesh fans and vertices are the same.

use super::PolyMesh;
use super::buckets::Buckets;

/// "No such element" in arrays of ids.
pub const NONE: u32 = u32::MAX;

/// Half-edge connectivity of a [`PolyMesh`]. Built in O(n log n) for n corners, in part in parallel.
#[derive(Debug, Clone)]
pub struct Topology {
    /// Partner of each half-edge, or [`NONE`] on a boundary or a cut.
    pub twin: Vec<u32>,
    /// Whether the partner runs the same way: the two faces are inconsistently oriented.
    pub same_direction: Vec<bool>,
    /// Next half-edge of the same face.
    pub next: Vec<u32>,
    /// Previous half-edge of the same face.
    pub prev: Vec<u32>,
    /// Face of each half-edge.
    pub face: Vec<u32>,
    /// Fan of each corner.
    pub fan: Vec<u32>,
    /// Number of corners of each fan.
    pub fan_corners: Vec<u32>,
    /// Vertex of each fan.
    pub fan_vertex: Vec<u32>,
    /// Whether the fan is on the boundary of the cut mesh.
    pub fan_on_boundary: Vec<bool>,
    /// One half-edge of each edge of the soup (before cutting), ordered by end points.
    pub edges: Vec<u32>,
    /// One half-edge of each edge with three or more faces.
    pub nonmanifold_edges: Vec<u32>,
    /// Number of edges with exactly one face.
    pub boundary_edge_count: usize,
}

impl Topology {
    /// Connects the corners of `mesh`.
    #[must_use]
    pub fn new(mesh: &PolyMesh) -> Self {
        let (next, prev, face) = face_cycles(mesh);
        let corners = mesh.corners();
        let lower_end = |h: u32| {
            let (a, b) = (corners[h as usize], corners[next[h as usize] as usize]);
            (a.min(b), (a.max(b), h))
        };
        let halves = Buckets::new(corners.len(), mesh.vertex_count(), lower_end);

        let n = corners.len();
        let mut twin = vec![NONE; n];
        let mut same_direction = vec![false; n];
        let (mut edges, mut nonmanifold_edges, mut boundary_edge_count) =
            (Vec::new(), Vec::new(), 0);
        for group in halves.iter().flat_map(|at| at.chunk_by(|x, y| x.0 == y.0)) {
            edges.push(group[0].1);
            match *group {
                [_] => boundary_edge_count += 1,
                [(_, h), (_, k)] => {
                    (twin[h as usize], twin[k as usize]) = (k, h);
                    let (from, to) = (corners[h as usize], corners[next[h as usize] as usize]);
                    let same = from != to && from == corners[k as usize];
                    (same_direction[h as usize], same_direction[k as usize]) = (same, same);
                }
                _ => nonmanifold_edges.push(group[0].1),
            }
        }
        let mut topology = Self {
            twin,
            same_direction,
            next,
            prev,
            face,
            fan: Vec::new(),
            fan_corners: Vec::new(),
            fan_vertex: Vec::new(),
            fan_on_boundary: Vec::new(),
            edges,
            nonmanifold_edges,
            boundary_edge_count,
        };
        topology.find_fans(corners);
        topology
    }

    /// Joins the corners that meet across partner edges; fans are numbered by first corner.
    fn find_fans(&mut self, corners: &[u32]) {
        self.fan = vec![NONE; corners.len()];
        for (c, &vertex) in corners.iter().enumerate() {
            if self.fan[c] != NONE {
                continue;
            }
            let fan = self.fan_vertex.len() as u32;
            self.fan[c] = fan;
            let mut count = 1;
            // Around the vertex both ways: the second finds nothing unless there is a boundary.
            for leaving in [true, false] {
                let mut at = (c as u32, leaving);
                while let Some(next) = self.across(at).filter(|n| self.fan[n.0 as usize] == NONE) {
                    self.fan[next.0 as usize] = fan;
                    count += 1;
                    at = next;
                }
            }
            self.fan_vertex.push(vertex);
            self.fan_corners.push(count);
        }
        self.fan_on_boundary = vec![false; self.fan_vertex.len()];
        for (h, _) in self.twin.iter().enumerate().filter(|&(_, &t)| t == NONE) {
            self.fan_on_boundary[self.fan[h] as usize] = true;
            self.fan_on_boundary[self.fan[self.next[h] as usize] as usize] = true;
        }
    }

    /// The corner beside corner `c` across the half-edge that leaves it, or else across the one that
    /// comes to it, and whether its other edge leaves it.
    fn across(&self, (c, leaving): (u32, bool)) -> Option<(u32, bool)> {
        let edge = if leaving { c } else { self.prev[c as usize] };
        let twin = self.twin[edge as usize];
        if twin == NONE {
            return None;
        }
        let starts = leaving == self.same_direction[edge as usize];
        Some((if starts { twin } else { self.next[twin as usize] }, !starts))
    }

    /// Half-edges without a partner, in order.
    pub fn boundary_half_edges(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.twin.len() as u32).filter(|&h| self.twin[h as usize] == NONE)
    }

    /// Number of vertices of the cut mesh.
    #[must_use]
    pub fn fan_count(&self) -> usize {
        self.fan_vertex.len()
    }
}

fn face_cycles(mesh: &PolyMesh) -> (Vec<u32>, Vec<u32>, Vec<u32>) {
    let n = mesh.corner_count();
    let (mut next, mut prev, mut face) = (vec![0; n], vec![0; n], vec![0; n]);
    for f in 0..mesh.face_count() {
        let (start, end) = (mesh.offsets()[f], mesh.offsets()[f + 1]);
        for c in start..end {
            next[c as usize] = if c + 1 == end { start } else { c + 1 };
            prev[c as usize] = if c == start { end - 1 } else { c - 1 };
            face[c as usize] = f as u32;
        }
    }
    (next, prev, face)
}

/// Union-find with path halving; the smaller id is the root, so results do not depend on order.
#[derive(Debug, Clone)]
pub struct DisjointSets {
    parent: Vec<u32>,
}

impl DisjointSets {
    /// `n` sets of one element each.
    #[must_use]
    pub fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect() }
    }

    /// The representative of the set of `x`: its smallest element.
    pub fn root(&mut self, mut x: usize) -> usize {
        while self.parent[x] as usize != x {
            self.parent[x] = self.parent[self.parent[x] as usize];
            x = self.parent[x] as usize;
        }
        x
    }

    /// Joins the sets of `x` and `y`; whether they were different.
    pub fn join(&mut self, x: usize, y: usize) -> bool {
        let (x, y) = (self.root(x), self.root(y));
        self.parent[x.max(y)] = x.min(y) as u32;
        x != y
    }
}
