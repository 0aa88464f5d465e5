//! What can be wrong with a script, and with one of its steps on a mesh.

use crate::mesh::{MendError, MeshError};
use crate::moves::MoveRefusal;
use crate::ops::Refusal;
use crate::pipeline::CleanError;
use crate::sqrtcc::{LiftError, Vertex};
use crate::surface::SurfaceError;
use thiserror::Error;

/// Why a script was not carried out.
#[derive(Debug, Error)]
pub enum ScriptError {
    /// The text is no TOML, or has other keys than `step`.
    #[error("{file}:{line}: {message}")]
    Syntax {
        /// Name of the script.
        file: String,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        message: String,
    },
    /// There is nothing to do.
    #[error("{file}: the script has no steps; a step begins with [[step]]")]
    Empty {
        /// Name of the script.
        file: String,
    },
    /// A step that cannot be understood.
    #[error("{file}:{line}: step {number}: {message}")]
    Step {
        /// Name of the script.
        file: String,
        /// The line, from 1.
        line: usize,
        /// The step, from 1.
        number: usize,
        /// What is wrong.
        message: String,
    },
    /// A step was refused; nothing is returned.
    #[error(transparent)]
    Refused(#[from] StepError),
    /// The mesh cannot be edited.
    #[error("the mesh cannot be edited: {0}")]
    Mend(#[from] MendError),
    /// The reference has no surface.
    #[error("the reference cannot be used: {0}")]
    Reference(#[from] SurfaceError),
    /// The mesh cannot be lifted; mending should have seen to that.
    #[error(transparent)]
    Lift(#[from] LiftError),
    /// The mesh is too large.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The result is not clean: a bug of this program. Nothing is returned.
    #[error(transparent)]
    Result(#[from] CleanError),
}

/// A step that was refused on this mesh.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "step {number} ({operation}, line {line}){}: {reason}",
    element.as_ref().map(|e| format!(" at {e}")).unwrap_or_default()
)]
pub struct StepError {
    /// The step, from 1.
    pub number: usize,
    /// What it was to do.
    pub operation: &'static str,
    /// Line of the script, from 1.
    pub line: usize,
    /// The element, in words.
    pub element: Option<String>,
    /// Why.
    pub reason: String,
}

/// Why an operation was refused, and where; numbers are those of Q.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Trouble {
    /// The element that it was about, if it had got so far.
    pub at: Option<Vertex>,
    /// Why.
    pub reason: Reason,
}

/// Why an operation was refused.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Reason {
    /// The move is not legal.
    Move(MoveRefusal),
    /// The address leads nowhere, or the mesh does not suit, in words.
    Other(String),
}

impl Trouble {
    /// An address that leads nowhere.
    pub(super) fn other(words: impl Into<String>) -> Self {
        Self { at: None, reason: Reason::Other(words.into()) }
    }

    /// The same trouble, at an element.
    pub(super) fn at(self, v: Vertex) -> Self {
        Self { at: self.at.or(Some(v)), ..self }
    }
}

impl From<MoveRefusal> for Trouble {
    fn from(refusal: MoveRefusal) -> Self {
        Self { at: None, reason: Reason::Move(refusal) }
    }
}

impl From<Refusal> for Trouble {
    fn from(refusal: Refusal) -> Self {
        MoveRefusal::from(refusal).into()
    }
}
