//! SPLIT: a vertex opens into a quad; the inverse of COLLAPSE.
//!
//! ```text
//!         d                    d
//!         |  h2              /   \
//!     ... v ... moved  →  .. v   w .. moved
//!         |  h1              \   /
//!         b                    b
//! ```
//! The half-edges from h1 counter-clockwise up to, excluding, h2 move from v to the new w. Of a
//! p-vertex it is a vertex split, of a d-vertex the insertion of an edge between b and d.
//! Source: Peng & Wonka 2013, section 3.2.

use super::{
    Legal, MAX_VALENCE, MIN_VALENCE, Refusal, alive, are_diagonal, change, debug_check, may_gain,
    within,
};
use crate::mesh::{Point, Vector};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use serde::{Deserialize, Serialize};

/// Splits the common origin of two half-edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Split {
    /// First half-edge that moves to the new vertex; v–b becomes double.
    pub first: HalfEdge,
    /// First half-edge that stays; v–d becomes double.
    pub last: HalfEdge,
}

impl Split {
    /// Legal if both parts keep two edges or more, b and d are not diagonal yet, and no frozen
    /// quad of a held vertex would move.
    pub fn check(self, mesh: &QuadMesh) -> Result<Legal<Self>, Refusal> {
        self.check_up_to(i32::MAX, mesh)
    }

    /// [`Self::check`], which also refuses what would add more than `most` to E.
    pub(super) fn check_up_to(self, most: i32, mesh: &QuadMesh) -> Result<Legal<Self>, Refusal> {
        alive(mesh, self.first)?;
        alive(mesh, self.last)?;
        let v = mesh.origin(self.first);
        if mesh.origin(self.last) != v || self.first == self.last {
            return Err(Refusal::Gone);
        }
        if mesh.is_ghost(v) {
            return Err(Refusal::Ghost);
        }
        let moved = self.moved(mesh)?;
        let (new, old) = (moved + 1, mesh.valence(v) - moved + 1);
        let largest = MAX_VALENCE.max(mesh.valence(v) - 1);
        if new.min(old) < MIN_VALENCE || new.max(old) > largest {
            return Err(Refusal::Valence);
        }
        let (b, d) = (mesh.target(self.first), mesh.target(self.last));
        may_gain(mesh, b)?;
        may_gain(mesh, d)?;
        let stays = change(mesh, self.last, 1 - moved as i32);
        let delta = (new as i32 - 4).abs()
            + stays
            + change(mesh, mesh.twin(self.first), 1)
            + change(mesh, mesh.twin(self.last), 1);
        within(most, delta)?;
        if b == d || are_diagonal(mesh, b, d) {
            return Err(Refusal::DoubleEdge);
        }
        Ok(Legal { op: self, delta })
    }

    /// Number of half-edges that move; refused if a frozen quad of a p-vertex would.
    fn moved(self, mesh: &QuadMesh) -> Result<u32, Refusal> {
        let held = mesh.is_held(mesh.origin(self.first));
        let (mut h, mut moved) = (self.first, 0);
        while h != self.last {
            if held && mesh.is_frozen(QuadMesh::quad(h)) {
                return Err(Refusal::Frozen);
            }
            moved += 1;
            h = mesh.ccw(h);
        }
        Ok(moved)
    }

    /// Splits; the new vertex.
    pub fn apply(mesh: &mut QuadMesh, legal: Legal<Self>) -> Vertex {
        let Self { first, last } = legal.op;
        let v = mesh.origin(first);
        let (b, d) = (mesh.target(first), mesh.target(last));
        let place = Self::place(mesh, legal.op);
        let w = mesh.add_vertex_like(v, place);
        let (mut h, mut moved) = (first, 0);
        while h != last {
            mesh.set_origin(h, w);
            moved += 1;
            h = mesh.ccw(h);
        }
        let (bv, dw) = (mesh.twin(first), mesh.twin(last));
        let base = 4 * mesh.add_quad();
        // Even corners are p: the quad starts at v if v is one, else at b.
        let shift = u32::from(mesh.is_face(v));
        let [vb, bw, wd, dv] = [0, 1, 2, 3].map(|i| base + (i + shift) % 4);
        for (e, from, twin) in [(vb, v, bv), (bw, b, first), (wd, w, dw), (dv, d, last)] {
            mesh.set_origin(e, from);
            mesh.join(e, twin);
        }
        mesh.set_out(v, vb);
        mesh.set_out(w, wd);
        mesh.set_valence(w, moved + 1);
        mesh.set_valence(v, mesh.valence(v) + 1 - moved);
        mesh.set_valence(b, mesh.valence(b) + 1);
        mesh.set_valence(d, mesh.valence(d) + 1);
        debug_check(mesh, &[v, w, b, d]);
        w
    }

    /// A quarter of the way from v to the mean of the vertices that the new one is joined to.
    fn place(mesh: &QuadMesh, op: Self) -> Point {
        let v = mesh.origin(op.first);
        if mesh.is_face(v) {
            return Point::origin();
        }
        let (mut h, mut sum, mut count) = (op.first, Vector::zeros(), 0);
        while h != op.last {
            sum += mesh.position(mesh.origin(QuadMesh::opposite(h))) - mesh.position(v);
            count += 1;
            h = mesh.ccw(h);
        }
        mesh.position(v) + sum * (0.25 / f64::from(count.max(1)))
    }
}
