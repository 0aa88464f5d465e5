//! The paper's edits, made of operations: what moves, how, and what it costs.

pub mod burgers;
pub mod dipole;
pub mod pure;
pub mod regularize;
pub mod t_junction;

pub use burgers::Displacement;
pub use dipole::{Dipole, Step};
