//! Ideal valences. Frozen quads (boundary, features) divide the faces around a p-vertex into
//! sectors; a sector of angle θ wants max(1, round(θ/90°)) faces, everything else wants 4.
//!
//! Source: Peng & Wonka 2013, section 2.1, extended to features.

use super::{HalfEdge, QuadMesh, Vertex};

impl QuadMesh {
    /// How many faces (or edges, for a d-vertex) there are too many around `origin(h)` in the
    /// sector that contains `h`; negative if too few. Opposite in sign to the paper's index.
    #[must_use]
    pub fn excess(&self, h: HalfEdge) -> i32 {
        let v = self.origin(h);
        if self.is_held(v) {
            let (count, ideal) = self.sector(h);
            return count as i32 - ideal as i32;
        }
        self.valence(v) as i32 - 4
    }

    /// Irregularity of `v`: |valence − 4|, summed over sectors at features and boundaries.
    #[must_use]
    pub fn irregularity(&self, v: Vertex) -> u32 {
        if self.is_ghost(v) {
            return 0;
        }
        let begins_sector = |&h: &HalfEdge| self.is_frozen(Self::quad(self.twin(h)));
        if !self.is_held(v) || !self.outgoing(v).any(|h| begins_sector(&h)) {
            return self.valence(v).abs_diff(4);
        }
        let real =
            self.outgoing(v).filter(begins_sector).filter(|&h| !self.is_ghost(self.target(h)));
        real.map(|h| self.excess(h).unsigned_abs()).sum()
    }

    /// Σ irregularity over all vertices and faces: E of the plan.
    #[must_use]
    pub fn total_irregularity(&self) -> u64 {
        self.vertices().map(|v| u64::from(self.irregularity(v))).sum()
    }

    /// Number of faces in the sector of `h` and the ideal number.
    fn sector(&self, h: HalfEdge) -> (u32, u32) {
        let mut first = h;
        while !self.is_frozen(Self::quad(self.twin(first))) {
            first = self.cw(first);
            if first == h {
                return (self.valence(self.origin(h)), 4);
            }
        }
        let (mut count, mut last) = (1, first);
        while !self.is_frozen(Self::quad(last)) {
            last = self.ccw(last);
            count += 1;
        }
        (count, u32::from(self.ideal[self.ideal_slot(first)]))
    }

    /// Where the ideal of the sector that begins with `first` is kept: at the frozen quad on its
    /// clockwise side, at the p-corner of the origin.
    pub(super) fn ideal_slot(&self, first: HalfEdge) -> usize {
        let corner = Self::next(self.twin(first));
        2 * Self::quad(corner) as usize + (corner as usize & 3) / 2
    }
}
