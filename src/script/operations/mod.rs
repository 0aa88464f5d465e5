//! What the steps of a script can do.
//!
//! A new operation is a type that can be read from a table (its fields are the keys of the step)
//! and implements [`Operation`], and one line of `operations!` below. Nothing else has to know.

mod basic;
mod cancel;
mod movement;
mod optimize;
mod pure;
mod raw;
mod regularize;
mod smooth;

use super::error::Trouble;
use super::run::Done;
use super::session::Session;
use crate::watch::Watch;
use std::fmt;
use toml::Table;

/// Something that a step can do.
pub(super) trait Operation: fmt::Debug + Send + Sync {
    /// Does it; the mesh need not be restored on refusal, the caller sees to that.
    fn run(&self, session: &mut Session, watch: &dyn Watch) -> Result<Done, Trouble>;
}

/// An operation that scripts know.
#[derive(Clone, Copy)]
pub struct OperationKind {
    /// Its name: `do = "…"`.
    pub name: &'static str,
    /// Its keys and what it does, in words.
    pub about: &'static str,
    pub(super) parse: fn(Table) -> Result<Box<dyn Operation>, toml::de::Error>,
}

impl fmt::Debug for OperationKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OperationKind").field("name", &self.name).finish_non_exhaustive()
    }
}

macro_rules! operations {
    ($($name:literal: $operation:ty, $about:literal;)*) => {
        /// All operations, in the order of the paper.
        pub const OPERATIONS: &[OperationKind] = &[$(OperationKind {
            name: $name,
            about: $about,
            parse: |table| Ok(Box::new(table.try_into::<$operation>()?)),
        },)*];
    };
}

operations! {
    "vertex-split": basic::VertexSplit, "at, from, to (faces): open a vertex into an edge";
    "edge-insertion": basic::EdgeInsertion, "at, from, to (vertices): cut a face in two";
    "edge-collapse": basic::EdgeCollapse, "edge: make its ends one";
    "edge-deletion": basic::EdgeDeletion, "edge: make its two faces one";
    "edge-shift": basic::EdgeShift, "fixed, from, to (vertices): end an edge elsewhere";
    "move-pair": movement::MovePair,
        "at, with, to (climb-left, …, closer, …), steps, path: Proposition 3.4";
    "change-type": movement::ChangeType, "at, with, path: v ↔ f, by an odd step";
    "convert": movement::Convert, "at, towards: f5 → v5 and f3–v5, f3 → v3 and v3–f5, …";
    "generate-pairs": movement::GeneratePairs, "at, what (mixed, t-junctions, duals)";
    "merge": movement::Merge, "at, with, path: two of one type and index −1 (Proposition 3.5)";
    "split-element": movement::SplitElement, "at, through: the reverse of merge";
    "move-t-junction": movement::MoveTJunction,
        "at, to (up, down, left, right), edges: Proposition 3.6";
    "walk": movement::Walk,
        "at (or start, a half-edge), steps (climb-left, …): a T-junction by hand";
    "cancel-t-junctions": cancel::CancelTJunctions,
        "at, with, left (any, vertices, faces), path: Proposition 3.7";
    "cancel-triple": cancel::CancelTriple, "at, with (a lone element), path";
    "cancel-quadruple": cancel::CancelQuadruple, "at, with (another pair), left, path";
    "regularize": regularize::Regularize,
        "at, or faces (a list), most (60): refill disks with fewer irregular elements (Figure 11)";
    "pure-quad": pure::PureQuad, "every irregular face that parity allows to vertices";
    "faces-from-vertices": pure::FacesFromVertices, "every irregular vertex to faces";
    "flip": raw::Raw<crate::ops::Flip>, "edge, turn: an operation on the √CC mesh";
    "collapse": raw::Raw<crate::ops::Collapse>, "edge: an operation on the √CC mesh";
    "split": raw::Raw<crate::ops::Split>, "first, last: an operation on the √CC mesh";
    "operations": raw::Operations, "ops: several operations on the √CC mesh";
    "refill": raw::Refill, "faces, interior, rim, filling, pins: a patch of the √CC mesh";
    "crossing": raw::Crossing, "shifts, refills: features resampled, patches beside them refilled";
    "ideals": raw::Ideals, "ideals: how many faces sectors at features want";
    "place": raw::Place, "points: one for each vertex, in the order of the output";
    "smooth": smooth::Smooth, "iterations: move the vertices on the reference";
    "optimize": optimize::Optimize, "goal (planar, angles): move the vertices near the reference";
}
