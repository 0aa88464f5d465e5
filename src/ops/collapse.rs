//! COLLAPSE: a quad closes along a diagonal, its two corners become one.
//!
//! ```text
//!        c                                     d               d
//!      /   \                                 /   \             |
//!     d     b      a, c merge:     d - a - b       a - c  →    a
//!      \   /                                 \   /             |
//!        a                                     b               b
//! ```
//! Merged p-vertices are an edge collapse of the polygon mesh, merged d-vertices an edge deletion.
//! Source: Peng & Wonka 2013, section 3.2.

use super::{
    Legal, MAX_VALENCE, MIN_VALENCE, Refusal, alive, change, debug_check, may_lose, within,
};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

/// Merges the origin of `edge` with the corner across its quad.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Collapse {
    /// A half-edge of the quad, out of one of the corners to merge.
    pub edge: HalfEdge,
}

impl Collapse {
    /// Legal if the quad is not frozen, the two corners have no other neighbour in common, at
    /// most one of them is held, and valences stay in range.
    pub fn check(self, mesh: &QuadMesh) -> Result<Legal<Self>, Refusal> {
        self.check_up_to(i32::MAX, mesh)
    }

    /// [`Self::check`], which also refuses what would add more than `most` to E.
    pub(super) fn check_up_to(self, most: i32, mesh: &QuadMesh) -> Result<Legal<Self>, Refusal> {
        let h = self.edge;
        alive(mesh, h)?;
        if mesh.is_frozen(QuadMesh::quad(h)) {
            return Err(Refusal::Frozen);
        }
        let [ha, hb, hc, hd] = [h, QuadMesh::next(h), QuadMesh::opposite(h), QuadMesh::prev(h)];
        let [a, b, c, d] = [ha, hb, hc, hd].map(|e| mesh.origin(e));
        if a == c || b == d {
            return Err(Refusal::TooSmall);
        }
        if mesh.is_held(a) && mesh.is_held(c) {
            return Err(Refusal::Held);
        }
        may_lose(mesh, b)?;
        may_lose(mesh, d)?;
        let merged = mesh.valence(a) + mesh.valence(c) - 2;
        if !(MIN_VALENCE..=MAX_VALENCE).contains(&merged) {
            return Err(Refusal::Valence);
        }
        let (kept, gone) = if mesh.is_held(c) { (hc, ha) } else { (ha, hc) };
        let gone_excess = mesh.excess(gone);
        // Merging adds valence(gone) − 2 = excess(gone) + 2 edges to the sector of the kept one.
        let delta = change(mesh, kept, gone_excess + 2) - gone_excess.abs()
            + change(mesh, hb, -1)
            + change(mesh, hd, -1);
        within(most, delta)?;
        if meets_twice(mesh, [a, b, c, d]) {
            return Err(Refusal::DoubleEdge);
        }
        Ok(Legal { op: self, delta })
    }

    /// Merges the corners; the vertex that is left. A held vertex survives in its place, else the
    /// origin of the half-edge does, halfway between the two.
    pub fn apply(mesh: &mut QuadMesh, legal: Legal<Self>) -> Vertex {
        let mut h = legal.op.edge;
        if mesh.is_held(mesh.origin(QuadMesh::opposite(h))) {
            h = QuadMesh::opposite(h);
        }
        close(mesh, h)
    }
}

/// Whether a and c have a neighbour other than b and d, or a diagonal neighbour, in common.
pub(super) fn meets_twice(mesh: &QuadMesh, [a, b, c, d]: [Vertex; 4]) -> bool {
    let beside: SmallVec<[Vertex; 8]> = mesh.neighbours(c).collect();
    if mesh.neighbours(a).any(|v| v != b && v != d && beside.contains(&v)) {
        return true;
    }
    let across: SmallVec<[Vertex; 8]> = mesh.diagonals(c).collect();
    mesh.diagonals(a).any(|v| v != c && across.contains(&v))
}

/// Merges the corner across the quad of `h` with its origin, which stays where it is if it is
/// held, else goes halfway; the origin.
pub(super) fn close(mesh: &mut QuadMesh, h: HalfEdge) -> Vertex {
    let quad = [h, QuadMesh::next(h), QuadMesh::opposite(h), QuadMesh::prev(h)];
    let [a, b, c, d] = quad.map(|e| mesh.origin(e));
    let [ab, bc, cd, da] = quad.map(|e| mesh.twin(e));
    let mut moved = bc;
    // Out half-edges of c, counter-clockwise from c→b around to c→d's predecessor.
    while moved != quad[2] {
        mesh.set_origin(moved, a);
        moved = mesh.ccw(moved);
    }
    mesh.join(ab, bc);
    mesh.join(cd, da);
    mesh.set_out(a, da);
    mesh.set_out(b, ab);
    mesh.set_out(d, cd);
    mesh.set_valence(a, mesh.valence(a) + mesh.valence(c) - 2);
    mesh.set_valence(b, mesh.valence(b) - 1);
    mesh.set_valence(d, mesh.valence(d) - 1);
    if !mesh.is_face(a) && !mesh.is_held(a) {
        mesh.set_position(a, nalgebra::center(&mesh.position(a), &mesh.position(c)));
    }
    mesh.kill_vertex(c);
    mesh.kill_quad(QuadMesh::quad(h));
    debug_check(mesh, &[a, b, d]);
    a
}
