//! T-junctions: a hanging vertex (v3) in the side of a pentagon (f5), a dislocation whose v3 is a
//! p-vertex.
//!
//! Moving one by a whole edge takes two steps; the type changes twice and is the same again.
//! Source: Peng & Wonka 2013, Proposition 3.6 and Figure 5.

use super::dipole::{Dipole, Step, Stepped};
use crate::ops::Refusal;
use crate::sqrtcc::QuadMesh;
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

/// Moves a T-junction by one edge, whole or not at all.
pub fn shift(mesh: &mut QuadMesh, at: Dipole, to: Direction) -> Result<Stepped, Refusal> {
    let mark = mesh.mark();
    let [first, second] = to.steps();
    let done = at.step(mesh, first).and_then(|half| {
        let dipole = half.dipole.ok_or(Refusal::Gone)?;
        let end = dipole.step(mesh, second)?;
        Ok(Stepped { delta: half.delta + end.delta, ..end })
    });
    if done.is_err() {
        mesh.undo_to(mark);
    }
    done
}
