//! What an operation does to the elements of one colour: the parity bookkeeping of a conversion.
//!
//! A FLIP takes one from an element and gives it to its neighbour; a COLLAPSE of the other colour
//! takes one from two elements, a SPLIT of it gives one to two; a COLLAPSE or SPLIT of the own
//! colour adds or divides. So the number of odd elements changes by 0 or 2, never by 1: it is the
//! discrete fact behind Propositions 3.3 and 3.5.

use crate::ops::{Op, Turn};
use crate::sqrtcc::{QuadMesh, Vertex};
use smallvec::SmallVec;

/// Which of the two kinds of irregular elements a conversion removes.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Irregular faces become irregular vertices: a pure quad mesh.
    #[default]
    Faces,
    /// Irregular vertices become irregular faces.
    Vertices,
}

impl Kind {
    /// Whether `v` is an element of this kind that a conversion may change.
    pub(super) fn covers(self, mesh: &QuadMesh, v: Vertex) -> bool {
        let is_free = !mesh.is_on_line(v);
        mesh.is_face(v) == (self == Self::Faces) && !mesh.is_ghost(v) && is_free
    }

    /// The irregular elements of this kind, in order of id.
    pub fn irregular(self, mesh: &QuadMesh) -> impl Iterator<Item = Vertex> + '_ {
        mesh.vertices().filter(move |&v| self.covers(mesh, v) && mesh.valence(v) != 4)
    }
}

/// The elements of one kind that an operation changes.
#[derive(Debug, Clone, Default)]
pub(super) struct Effect {
    /// Those that are irregular before it.
    pub(super) before: SmallVec<[Vertex; 4]>,
    /// Those that are irregular after it, and their valence then.
    pub(super) after: SmallVec<[(Vertex, u32); 4]>,
}

impl Effect {
    /// The effect of a legal operation; `None` if it leaves an element that is neither regular nor
    /// odd by one, or changes one that is held.
    pub(super) fn of(mesh: &QuadMesh, op: Op, kind: Kind) -> Option<Self> {
        let mut effect = Self::default();
        let mut sound = true;
        let of_kind = |v: Vertex| mesh.is_face(v) == (kind == Kind::Faces);
        let mut change = |v: Vertex, by: i32| {
            if of_kind(v) {
                sound &= kind.covers(mesh, v);
                effect.note(v, mesh.valence(v), mesh.valence(v).saturating_add_signed(by));
            }
        };
        match op {
            Op::Flip(flip) => {
                let (h, t) = (flip.edge, mesh.twin(flip.edge));
                let end = |h| match flip.turn {
                    Turn::Ccw => mesh.origin(QuadMesh::opposite(h)),
                    Turn::Cw => mesh.origin(QuadMesh::prev(h)),
                };
                change(mesh.origin(h), -1);
                change(mesh.origin(t), -1);
                change(end(h), 1);
                change(end(t), 1);
            }
            Op::Collapse(collapse) => {
                let h = collapse.edge;
                let [a, c] = [h, QuadMesh::opposite(h)].map(|h| mesh.origin(h));
                if of_kind(a) {
                    sound &= kind.covers(mesh, a) && kind.covers(mesh, c);
                    effect.note(c, mesh.valence(c), 4);
                    effect.note(a, mesh.valence(a), mesh.valence(a) + mesh.valence(c) - 2);
                } else {
                    change(mesh.origin(QuadMesh::next(h)), -1);
                    change(mesh.origin(QuadMesh::prev(h)), -1);
                }
            }
            Op::Split(split) => {
                let v = mesh.origin(split.first);
                if of_kind(v) {
                    sound &= kind.covers(mesh, v);
                    let (mut h, mut moved) = (split.first, 0);
                    while h != split.last {
                        (h, moved) = (mesh.ccw(h), moved + 1);
                    }
                    effect.note(v, mesh.valence(v), mesh.valence(v) + 1 - moved);
                    effect.note(mesh.vertex_ids(), 4, moved + 1);
                } else {
                    change(mesh.target(split.first), 1);
                    change(mesh.target(split.last), 1);
                }
            }
        }
        let fair = effect.after.iter().all(|&(_, n)| n == 3 || n == 5);
        (sound && fair).then_some(effect)
    }

    fn note(&mut self, v: Vertex, before: u32, after: u32) {
        if before != 4 {
            self.before.push(v);
        }
        if after != 4 {
            self.after.push((v, after));
        }
    }
}
