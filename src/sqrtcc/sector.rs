//! Ideal valences. Frozen quads (boundary, features) divide the faces around a p-vertex into
//! sectors; a sector of angle θ wants max(1, round(θ/90°)) faces, or one more or less where the vertex
//! is regular with that and θ leaves the choice; everything else wants 4.
//!
//! Source: Peng & Wonka 2013, section 2.1, extended to features.

use super::{HalfEdge, QuadMesh, Vertex};
use crate::mesh::NONE;
use rayon::prelude::*;

impl QuadMesh {
    /// How many faces (or edges, for a d-vertex) there are too many around `origin(h)` in the
    /// sector that contains `h`; negative if too few. Opposite in sign to the paper's index.
    #[inline]
    #[must_use]
    pub fn excess(&self, h: HalfEdge) -> i32 {
        let v = self.origin(h);
        if self.is_held(v) {
            let sector = self.sector(h);
            let is_bounded = self.is_frozen(Self::quad(self.twin(sector.first)));
            let ideal = if is_bounded { self.ideal[self.ideal_slot(sector.first)] } else { 4 };
            return sector.count() as i32 - i32::from(ideal);
        }
        self.valence(v) as i32 - 4
    }

    /// Irregularity of `v`: |valence − 4|, summed over sectors at features and boundaries.
    #[inline]
    #[must_use]
    pub fn irregularity(&self, v: Vertex) -> u32 {
        if self.is_ghost(v) {
            return 0;
        }
        if !self.is_on_line(v) {
            return self.valence(v).abs_diff(4);
        }
        self.sectors(v).map(|h| self.excess(h).unsigned_abs()).sum()
    }

    /// The first half-edge (clockwise end) of each sector of `v` that belongs to the polygon mesh;
    /// none if no frozen quad is at `v`. O(valence).
    pub fn sectors(&self, v: Vertex) -> impl Iterator<Item = HalfEdge> + '_ {
        let begins = |&h: &HalfEdge| self.is_frozen(Self::quad(self.twin(h)));
        self.outgoing(v).filter(begins).filter(|&h| !self.is_ghost(self.target(h)))
    }

    /// The half-edges in the sector of `h` out of its origin, counter-clockwise; all there are if
    /// no frozen quad is at the origin. O(valence).
    #[must_use]
    pub fn sector(&self, h: HalfEdge) -> Sector<'_> {
        let mut first = h;
        while !self.is_frozen(Self::quad(self.twin(first))) {
            first = self.cw(first);
            if first == h {
                break;
            }
        }
        Sector { mesh: self, first, at: first }
    }

    /// Σ irregularity over all vertices and faces: E of the plan.
    #[must_use]
    pub fn total_irregularity(&self) -> u64 {
        self.irregular().into_iter().map(|v| u64::from(self.irregularity(v))).sum()
    }

    /// The vertices with an irregularity, in order of id. O(size of Q), parallel.
    #[must_use]
    pub fn irregular(&self) -> Vec<Vertex> {
        let is_there = |&v: &Vertex| self.is_alive(v) && !self.is_ghost(v);
        let all = (0..self.vertex_ids()).into_par_iter();
        all.filter(|v| is_there(v) && self.irregularity(*v) > 0).collect()
    }

    /// Where the ideal of the sector that begins with `first` is kept: at the frozen quad on its
    /// clockwise side, at the p-corner of the origin.
    pub(super) fn ideal_slot(&self, first: HalfEdge) -> usize {
        Self::ideal_index(Self::next(self.twin(first)))
    }
}

/// Walks the half-edges of a sector, see [`QuadMesh::sector`].
#[derive(Debug, Clone)]
pub struct Sector<'a> {
    mesh: &'a QuadMesh,
    first: HalfEdge,
    at: HalfEdge,
}

impl Iterator for Sector<'_> {
    type Item = HalfEdge;

    fn next(&mut self) -> Option<HalfEdge> {
        if self.at == NONE {
            return None;
        }
        let h = self.at;
        let after = self.mesh.ccw(h);
        let ends = self.mesh.is_frozen(QuadMesh::quad(h)) || after == self.first;
        self.at = if ends { NONE } else { after };
        Some(h)
    }
}
