//! The planner: which edits to make.

pub mod clusters;
pub mod cost;
pub mod local;
pub mod movement;
