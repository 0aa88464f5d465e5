//! The paper's edits, made of operations: what moves, how, and what it costs.
//!
//! | edit of the paper | here |
//! |---|---|
//! | the five basic operations | [`basic`] |
//! | pair-wise movement, type change (Proposition 3.4) | [`pair`] |
//! | single conversion, pair generation (Figure 8) | [`conversion`] |
//! | merging (Proposition 3.5) | [`merge`] |
//! | movement of T-junctions (Proposition 3.6) | [`t_junction`] |
//! | cancellation of T-junctions (Proposition 3.7), of triples and quadruples | [`cancel`] |
//!
//! *Invariant:* a move is made whole or not at all; a refused one leaves the mesh bit for bit as
//! it was, and [`QuadMesh::undo_to`](crate::sqrtcc::QuadMesh::undo_to) takes any move back.

pub mod basic;
pub mod burgers;
pub mod cancel;
pub mod conversion;
pub mod dipole;
pub mod element;
pub mod merge;
pub mod pair;
pub mod path;
pub mod pure;
mod refusal;
pub mod regularize;
pub mod t_junction;
mod walk;

pub use burgers::Displacement;
pub use dipole::{Dipole, Step};
pub use element::{Element, Kind};
pub(crate) use path::quarters;
pub use path::{Offset, Path, Route};
pub use refusal::MoveRefusal;
