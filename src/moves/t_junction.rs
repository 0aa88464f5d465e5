//! T-junctions: a hanging vertex (v3) in the side of a pentagon (f5), a dislocation whose v3 is a
//! p-vertex.
//!
//! Moving one by a whole edge takes two steps; the type changes twice and is the same again.
//! Source: Peng & Wonka 2013, Proposition 3.6 and Figure 5.

use super::MoveRefusal;
use super::dipole::{Dipole, Step};
use crate::ops::Op;
use crate::sqrtcc::{QuadMesh, Vertex};
use serde::{Deserialize, Serialize};

/// The direction of a whole-edge move, seen with the stem of the T pointing up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// Along the stem, which gets shorter.
    Up,
    /// Against the stem, which gets longer.
    Down,
    /// Sideways.
    Left,
    /// Sideways.
    Right,
}

impl Direction {
    /// The direction that leads back.
    #[must_use]
    pub const fn inverse(self) -> Self {
        match self {
            Self::Up => Self::Down,
            Self::Down => Self::Up,
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// The two steps of which the move is made (Proposition 3.6).
    #[must_use]
    pub const fn steps(self) -> [Step; 2] {
        match self {
            Self::Up => [Step::ClimbLeft, Step::ClimbRight],
            Self::Down => [Step::SinkLeft, Step::SinkRight],
            Self::Right => [Step::ClimbLeft, Step::SinkRight],
            Self::Left => [Step::ClimbRight, Step::SinkLeft],
        }
    }
}

/// A T-junction after its move.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shifted {
    /// Where it stands.
    pub dipole: Dipole,
    /// The operations that were made.
    pub ops: Vec<Op>,
}

/// The T-junction whose hanging vertex is `v`, in the face with the smallest number of several.
pub fn at(mesh: &QuadMesh, v: Vertex) -> Result<Dipole, MoveRefusal> {
    if v >= mesh.vertex_ids() || !mesh.is_alive(v) {
        return Err(MoveRefusal::Gone(v));
    }
    let standing = mesh.outgoing(v).map(Dipole).filter(|d| d.is_t_junction() && d.stands(mesh));
    standing.min_by_key(|d| mesh.target(d.0)).ok_or(MoveRefusal::NotATJunction)
}

/// Moves a T-junction, or a dual one, by so many whole edges, whole or not at all; E stays the
/// same.
///
/// ```text
///    │        │                    │         │
///    │   up   │                    │  right  │
///  ──┴──  →  ─┴─ (one row up)    ──┴──  →    └─┴──
/// ```
/// Refused where an operation is, or where something else would change. Inverse: the opposite
/// direction. Source: Peng & Wonka 2013, Proposition 3.6, Figure 5.
pub fn shift(
    mesh: &mut QuadMesh,
    at: Dipole,
    to: Direction,
    edges: u32,
) -> Result<Shifted, MoveRefusal> {
    let mark = mesh.mark();
    let mut done = Shifted { dipole: at, ops: Vec::new() };
    for _ in 0..edges {
        if let Err(refusal) = shift_once(mesh, &mut done, to) {
            mesh.undo_to(mark);
            return Err(refusal);
        }
    }
    Ok(done)
}

fn shift_once(mesh: &mut QuadMesh, done: &mut Shifted, to: Direction) -> Result<(), MoveRefusal> {
    let mut delta = 0;
    for step in to.steps() {
        let stepped = done.dipole.step(mesh, step)?;
        done.dipole = stepped.dipole.ok_or(MoveRefusal::InTheWay)?;
        done.ops.push(stepped.op);
        delta += stepped.delta;
    }
    if delta == 0 { Ok(()) } else { Err(MoveRefusal::InTheWay) }
}
