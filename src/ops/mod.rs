//! The three operations on Q from which every edit is made: FLIP, COLLAPSE, SPLIT.
//!
//! With a colour they are the paper's five basic operations (Peng & Wonka 2013, section 3.2):
//!
//! | operation | on p-vertices | on d-vertices | inverse |
//! |---|---|---|---|
//! | FLIP | edge shift | edge shift | FLIP the other way |
//! | COLLAPSE | edge collapse | edge deletion | SPLIT |
//! | SPLIT | vertex split | edge insertion | COLLAPSE |
//!
//! *Invariant:* an operation is applied only as [`Legal`], which only `check` makes.

mod around;
mod collapse;
mod flip;
mod resample;
mod split;

pub use around::around;
pub use collapse::Collapse;
pub use flip::{Flip, Turn};
pub use resample::{Resample, within_line};
pub use split::Split;

use crate::mesh::NONE;
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Smallest valence that an operation may leave.
pub const MIN_VALENCE: u32 = 3;
/// Largest valence that an operation may make.
pub const MAX_VALENCE: u32 = 8;

/// Why an operation is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Error, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Refusal {
    /// The half-edge is no longer part of the mesh, or the two are not at one vertex.
    #[error("the place no longer exists")]
    Gone,
    /// The edge lies on a boundary or feature.
    #[error("the edge lies on a boundary or feature")]
    Frozen,
    /// A ghost would change valence.
    #[error("the mesh ends here")]
    Ghost,
    /// A valence would leave 3…8.
    #[error("a vertex or face would have fewer than three or more than eight edges")]
    Valence,
    /// Two vertices would be joined twice, or a face would meet itself or another twice.
    #[error("two elements would meet along two different edges")]
    DoubleEdge,
    /// Both vertices are held in place, or a pin would have no place left.
    #[error("what is held in place would have to move")]
    Held,
    /// E would grow by more than the caller wants.
    #[error("there would be more irregular elements than are wanted")]
    Costly,
    /// Corners that must differ are the same.
    #[error("the neighbourhood is too small")]
    TooSmall,
}

/// An operation that was checked against the mesh as it is now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[must_use]
pub struct Legal<T> {
    op: T,
    delta: i32,
}

impl<T> Legal<T> {
    /// The predicted change of the total irregularity E.
    #[must_use]
    pub fn delta(&self) -> i32 {
        self.delta
    }
}

/// One operation at one place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(tag = "op", rename_all = "kebab-case")]
pub enum Op {
    /// Edge shift.
    Flip(Flip),
    /// Edge collapse or edge deletion.
    Collapse(Collapse),
    /// Vertex split or edge insertion.
    Split(Split),
}

impl Op {
    /// Whether the operation may be applied, and what it would do to E.
    pub fn check(self, mesh: &QuadMesh) -> Result<Legal<Self>, Refusal> {
        self.check_up_to(i32::MAX, mesh)
    }

    /// [`Self::check`], which also refuses what would add more than `most` to E: that is known
    /// before the neighbourhood has been searched.
    pub fn check_up_to(self, most: i32, mesh: &QuadMesh) -> Result<Legal<Self>, Refusal> {
        let delta = match self {
            Self::Flip(op) => op.check_up_to(most, mesh)?.delta,
            Self::Collapse(op) => op.check_up_to(most, mesh)?.delta,
            Self::Split(op) => op.check_up_to(most, mesh)?.delta,
        };
        Ok(Legal { op: self, delta })
    }

    /// Applies the checked operation.
    pub fn apply(mesh: &mut QuadMesh, legal: Legal<Self>) {
        let delta = legal.delta;
        match legal.op {
            Self::Flip(op) => Flip::apply(mesh, Legal { op, delta }),
            Self::Collapse(op) => {
                Collapse::apply(mesh, Legal { op, delta });
            }
            Self::Split(op) => {
                Split::apply(mesh, Legal { op, delta });
            }
        }
    }

    /// Checks and applies; the change of E.
    pub fn run(self, mesh: &mut QuadMesh) -> Result<i32, Refusal> {
        let legal = self.check(mesh)?;
        let delta = legal.delta;
        Self::apply(mesh, legal);
        Ok(delta)
    }

    /// The same operation with the ids from `from` on moved to `to` on: replays an edit that was
    /// planned on a snapshot with fewer elements.
    #[must_use]
    pub fn rebased(self, from: u32, to: u32) -> Self {
        let shift = |h| rebased(h, from, to);
        match self {
            Self::Flip(op) => Self::Flip(Flip { edge: shift(op.edge), ..op }),
            Self::Collapse(op) => Self::Collapse(Collapse { edge: shift(op.edge) }),
            Self::Split(op) => Self::Split(Split { first: shift(op.first), last: shift(op.last) }),
        }
    }
}

/// `id`, with those from `from` on moved to `to` on.
pub(crate) fn rebased(id: u32, from: u32, to: u32) -> u32 {
    if id >= from { id - from + to } else { id }
}

fn alive(mesh: &QuadMesh, h: HalfEdge) -> Result<(), Refusal> {
    let known = h >> 2 < mesh.quad_ids() && mesh.origin(h) != NONE;
    known.then_some(()).ok_or(Refusal::Gone)
}

/// Refuses a change of E above `most`.
fn within(most: i32, delta: i32) -> Result<(), Refusal> {
    (delta <= most).then_some(()).ok_or(Refusal::Costly)
}

/// Whether `v` may lose one edge.
fn may_lose(mesh: &QuadMesh, v: Vertex) -> Result<(), Refusal> {
    if mesh.is_ghost(v) {
        return Err(Refusal::Ghost);
    }
    (mesh.valence(v) > MIN_VALENCE).then_some(()).ok_or(Refusal::Valence)
}

/// Whether `v` may gain one edge.
fn may_gain(mesh: &QuadMesh, v: Vertex) -> Result<(), Refusal> {
    if mesh.is_ghost(v) {
        return Err(Refusal::Ghost);
    }
    (mesh.valence(v) < MAX_VALENCE).then_some(()).ok_or(Refusal::Valence)
}

/// Whether `a` and `b` lie across a quad from one another.
fn are_diagonal(mesh: &QuadMesh, a: Vertex, b: Vertex) -> bool {
    let (a, b) = if mesh.valence(a) <= mesh.valence(b) { (a, b) } else { (b, a) };
    mesh.diagonals(a).any(|v| v == b)
}

fn are_joined(mesh: &QuadMesh, a: Vertex, b: Vertex) -> bool {
    let (a, b) = if mesh.valence(a) <= mesh.valence(b) { (a, b) } else { (b, a) };
    mesh.neighbours(a).any(|v| v == b)
}

/// Change of |excess| when the sector of `h` gains `by` edges.
fn change(mesh: &QuadMesh, h: HalfEdge, by: i32) -> i32 {
    let excess = mesh.excess(h);
    (excess + by).abs() - excess.abs()
}

/// Debug builds check every vertex that an operation touched.
fn debug_check(mesh: &QuadMesh, vertices: &[Vertex]) {
    if cfg!(debug_assertions) {
        for &v in vertices {
            if let Err(violation) = mesh.check_vertex(v) {
                unreachable!("{violation}");
            }
        }
    }
}
