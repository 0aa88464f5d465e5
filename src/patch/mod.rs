//! Patches: disks of faces, refilled with the fewest irregular elements their rim allows.
//!
//! A patch is cut along edges of the polygon mesh, so it can stand against features and
//! boundaries. How many faces each rim vertex wants inside makes it a corner (1) or part of a
//! side (2); the corners and the side lengths decide the [`template`]. Source: Peng & Wonka 2013,
//! Figure 11 (2a to 2b); the templates are the classical mid-point subdivisions in a lattice that
//! has vertices at integer and faces at half-integer points.

pub mod crossing;
pub mod embed;
pub mod refill;
pub mod region;
mod replay;
pub mod template;

pub use crossing::Crossing;
pub use refill::Refill;
pub use region::{Grower, Outline, Region};
pub use replay::Misfit;
pub use template::{Filling, fillings};
