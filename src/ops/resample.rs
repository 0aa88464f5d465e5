//! Resampling a sharp feature: a vertex of the line comes or goes, and both sides see it.
//!
//! ```text
//!     u ───────── w         cut          u ─── x ─── w
//!      f above, g below     ⇄            f and g have a corner more
//!                           join
//! ```
//! Nothing else moves a dislocation across a feature: every other operation leaves the number of
//! edges of the line as it is. The paper has no features; on a mesh without any, there is nothing
//! to resample.

use super::{
    Legal, MAX_VALENCE, Refusal, alive, change, collapse, debug_check, may_gain, may_lose, rebased,
};
use crate::sqrtcc::{HalfEdge, QuadKind, QuadMesh, Vertex};
use serde::{Deserialize, Serialize};

/// A vertex of a feature line comes or goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "op", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Resample {
    /// A new vertex in the middle of a feature edge.
    Cut {
        /// A half-edge of the quad, out of an end of the edge.
        edge: HalfEdge,
    },
    /// The end across the quad, which must lie within the line, joins the origin, which stays.
    Join {
        /// A half-edge of the quad, out of the end that stays.
        edge: HalfEdge,
    },
}

impl Resample {
    /// The half-edge that names the feature edge.
    #[must_use]
    pub fn edge(self) -> HalfEdge {
        match self {
            Self::Cut { edge } | Self::Join { edge } => edge,
        }
    }

    /// The same with the half-edges from `from` on moved to `to` on.
    #[must_use]
    pub fn rebased(self, from: u32, to: u32) -> Self {
        let edge = rebased(self.edge(), from, to);
        match self {
            Self::Cut { .. } => Self::Cut { edge },
            Self::Join { .. } => Self::Join { edge },
        }
    }

    /// Legal on feature edges only; faces keep three to eight corners, a vertex that goes lies
    /// within its line, and no two edges join the same vertices afterwards.
    pub fn check(self, mesh: &QuadMesh) -> Result<Legal<Self>, Refusal> {
        let h = self.edge();
        alive(mesh, h)?;
        if mesh.is_face(mesh.origin(h)) || mesh.kind(QuadMesh::quad(h)) != QuadKind::Feature {
            return Err(Refusal::Frozen);
        }
        let [at_f, at_g] = [QuadMesh::next(h), QuadMesh::prev(h)];
        let faces = [at_f, at_g].map(|e| mesh.origin(e));
        let delta = if let Self::Cut { .. } = self {
            may_gain(mesh, faces[0])?;
            may_gain(mesh, faces[1])?;
            // The new vertex lacks a face on either side.
            2 + change(mesh, at_f, 1) + change(mesh, at_g, 1)
        } else {
            may_lose(mesh, faces[0])?;
            may_lose(mesh, faces[1])?;
            let gone = QuadMesh::opposite(h);
            let (kept, other) = (mesh.origin(h), mesh.origin(gone));
            if !within_line(mesh, other) {
                return Err(Refusal::Held);
            }
            if mesh.valence(kept) + mesh.valence(other) - 2 > MAX_VALENCE {
                return Err(Refusal::Valence);
            }
            if collapse::meets_twice(mesh, [kept, faces[0], other, faces[1]]) {
                return Err(Refusal::DoubleEdge);
            }
            // The sector on each side of the edge takes over that of the vertex that goes.
            let side = |kept: HalfEdge, gone: HalfEdge| {
                let more = mesh.excess(gone);
                change(mesh, kept, more + 1) - more.abs()
            };
            side(h, mesh.ccw(gone))
                + side(mesh.ccw(h), gone)
                + change(mesh, at_f, -1)
                + change(mesh, at_g, -1)
        };
        Ok(Legal { op: self, delta })
    }

    /// Resamples; the new vertex, or the one that was joined.
    pub fn apply(mesh: &mut QuadMesh, legal: Legal<Self>) -> Vertex {
        match legal.op {
            Self::Cut { edge } => cut(mesh, edge),
            Self::Join { edge } => {
                let beyond = mesh.outgoing(mesh.origin(QuadMesh::opposite(edge))).find(|&h| {
                    QuadMesh::quad(h) != QuadMesh::quad(edge) && mesh.is_frozen(QuadMesh::quad(h))
                });
                if let Some(beyond) = beyond {
                    mesh.set_ideal(beyond, mesh.ideal_at(edge));
                }
                collapse::close(mesh, edge)
            }
        }
    }

    /// Checks and applies; the new vertex, or the one that was joined.
    pub fn run(self, mesh: &mut QuadMesh) -> Result<Vertex, Refusal> {
        let legal = self.check(mesh)?;
        Ok(Self::apply(mesh, legal))
    }
}

/// Whether `v` lies within a feature line: two feature edges, both sides flat.
#[must_use]
pub fn within_line(mesh: &QuadMesh, v: Vertex) -> bool {
    let mut edges = 0;
    for h in mesh.outgoing(v) {
        match mesh.kind(QuadMesh::quad(h)) {
            QuadKind::Free => {}
            QuadKind::Feature if mesh.ideal_at(h) == FLAT => edges += 1,
            _ => return false,
        }
    }
    edges == 2
}

/// Faces that a flat side wants.
const FLAT: u8 = 2;

fn cut(mesh: &mut QuadMesh, h: HalfEdge) -> Vertex {
    let [from_f, from_w, from_g] = [QuadMesh::next(h), QuadMesh::opposite(h), QuadMesh::prev(h)];
    let [u, f, w, g] = [h, from_f, from_w, from_g].map(|e| mesh.origin(e));
    let (into_f, into_w) = (mesh.twin(from_f), mesh.twin(from_w));
    let middle = nalgebra::center(&mesh.position(u), &mesh.position(w));
    let x = mesh.add_held_vertex_like(u, middle);
    let base = 4 * mesh.add_quad_like(QuadMesh::quad(h));
    for (i, v) in [x, f, w, g].into_iter().enumerate() {
        mesh.set_origin(base + i as u32, v);
    }
    mesh.set_origin(from_w, x);
    mesh.join(base + 1, into_f);
    mesh.join(base + 2, into_w);
    mesh.join(base, from_f);
    mesh.join(base + 3, from_w);
    mesh.set_ideal(base, FLAT);
    mesh.set_ideal(base + 2, mesh.ideal_at(from_w));
    mesh.set_ideal(from_w, FLAT);
    mesh.set_out(x, base);
    mesh.set_out(w, base + 2);
    mesh.set_valence(x, 2);
    mesh.set_valence(f, mesh.valence(f) + 1);
    mesh.set_valence(g, mesh.valence(g) + 1);
    debug_check(mesh, &[u, x, w, f, g]);
    x
}
