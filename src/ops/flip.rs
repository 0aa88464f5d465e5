//! FLIP: the edge between two quads turns inside their hexagon.
//!
//! ```text
//!        a3                 a3                 a3
//!     a4 / \ a2          a4/  \a2           a4/  \a2
//!      |  |  |    ccw     |  _/ |            | \_  |
//!      |  h  |   ---->    | /   |     or cw  |   \ |
//!     a5  |  a1          a5\  / a1          a5\  / a1
//!        a0                 a0                 a0
//!                        (a1 a4)            (a5 a2)
//! ```
//! The ends a0, a3 lose an edge, the new ends gain one. For the polygon mesh it is an edge shift:
//! ccw shifts the edge of one quad and leaves that of the other, cw the other way round.
//! Source: Peng & Wonka 2013, section 3.2 (edge shift).

use super::{
    Legal, Refusal, alive, are_diagonal, are_joined, change, debug_check, may_gain, may_lose,
    within,
};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use serde::{Deserialize, Serialize};

/// Which way an edge turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Turn {
    /// Counter-clockwise.
    Ccw,
    /// Clockwise.
    Cw,
}

/// Turns the edge of `edge` within the hexagon of its two quads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Flip {
    /// Either half-edge of the edge.
    pub edge: HalfEdge,
    /// The direction.
    pub turn: Turn,
}

impl Flip {
    /// The hexagon a0…a5 around the edge a0→a3, counter-clockwise.
    fn hexagon(mesh: &QuadMesh, h: HalfEdge) -> [Vertex; 6] {
        let t = mesh.twin(h);
        let (across_t, across_h) = (QuadMesh::opposite(t), QuadMesh::opposite(h));
        [h, across_t, QuadMesh::prev(t), t, across_h, QuadMesh::prev(h)].map(|e| mesh.origin(e))
    }

    /// Legal if six corners differ, no valence leaves its range, the shifted edge is not frozen
    /// and nothing would be joined twice.
    pub fn check(self, mesh: &QuadMesh) -> Result<Legal<Self>, Refusal> {
        self.check_up_to(i32::MAX, mesh)
    }

    /// [`Self::check`], which also refuses what would add more than `most` to E.
    pub(super) fn check_up_to(self, most: i32, mesh: &QuadMesh) -> Result<Legal<Self>, Refusal> {
        let h = self.edge;
        alive(mesh, h)?;
        let t = mesh.twin(h);
        let shifted = match (self.turn, h & 1 == 0) {
            (Turn::Ccw, true) | (Turn::Cw, false) => t,
            _ => h,
        };
        if mesh.is_frozen(QuadMesh::quad(shifted)) {
            return Err(Refusal::Frozen);
        }
        let hexagon = Self::hexagon(mesh, h);
        let [a0, a1, a2, a3, a4, a5] = hexagon;
        for i in 0..6 {
            if hexagon[..i].contains(&hexagon[i]) {
                return Err(Refusal::TooSmall);
            }
        }
        // The half-edges at the new ends that lie in the sector where the new edge arrives.
        let (from, to) = match self.turn {
            Turn::Ccw => (mesh.twin(QuadMesh::next(t)), mesh.twin(QuadMesh::next(h))),
            Turn::Cw => (QuadMesh::prev(t), QuadMesh::prev(h)),
        };
        may_lose(mesh, a0)?;
        may_lose(mesh, a3)?;
        may_gain(mesh, mesh.origin(from))?;
        may_gain(mesh, mesh.origin(to))?;
        let delta =
            change(mesh, h, -1) + change(mesh, t, -1) + change(mesh, from, 1) + change(mesh, to, 1);
        within(most, delta)?;
        if are_joined(mesh, mesh.origin(from), mesh.origin(to))
            || are_diagonal(mesh, a1, a5)
            || are_diagonal(mesh, a2, a4)
        {
            return Err(Refusal::DoubleEdge);
        }
        Ok(Legal { op: self, delta })
    }

    /// Turns the edge. Each quad keeps its number and all corners but one, so that the frozen one
    /// of the two, if any, keeps its ends where they are.
    pub fn apply(mesh: &mut QuadMesh, legal: Legal<Self>) {
        let h = legal.op.edge;
        let t = mesh.twin(h);
        let hexagon = Self::hexagon(mesh, h);
        let [a0, a1, a2, a3, a4, a5] = hexagon;
        let (next_h, next_t) = (QuadMesh::next(h), QuadMesh::next(t));
        let (prev_h, prev_t) = (QuadMesh::prev(h), QuadMesh::prev(t));
        match legal.op.turn {
            Turn::Ccw => {
                let (outer_h, outer_t) = (mesh.twin(next_t), mesh.twin(next_h));
                mesh.set_out(a0, h);
                mesh.set_out(a3, t);
                mesh.set_origin(next_t, a4);
                mesh.set_origin(next_h, a1);
                mesh.join(h, outer_h);
                mesh.join(t, outer_t);
                mesh.join(next_h, next_t);
                Self::shift_valences(mesh, [a0, a3], [a1, a4]);
            }
            Turn::Cw => {
                let (outer_h, outer_t) = (mesh.twin(prev_t), mesh.twin(prev_h));
                mesh.set_out(a0, next_t);
                mesh.set_out(a3, next_h);
                mesh.set_origin(h, a2);
                mesh.set_origin(t, a5);
                mesh.join(h, outer_h);
                mesh.join(t, outer_t);
                mesh.join(prev_h, prev_t);
                Self::shift_valences(mesh, [a0, a3], [a2, a5]);
            }
        }
        debug_check(mesh, &hexagon);
    }

    fn shift_valences(mesh: &mut QuadMesh, losers: [Vertex; 2], winners: [Vertex; 2]) {
        for v in losers {
            mesh.set_valence(v, mesh.valence(v) - 1);
        }
        for v in winners {
            mesh.set_valence(v, mesh.valence(v) + 1);
        }
    }
}
