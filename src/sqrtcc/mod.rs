//! The √CC domain: a pure-quad mesh in which vertices and faces are the same kind of thing.
//!
//! Every vertex of the polygon mesh is a *p-vertex*, every face a *d-vertex*, every edge a quad
//! (p, d, p', d'). Source: Peng & Wonka 2013, section 3.1.

mod check;
mod ideal;
mod journal;
mod lift;
mod lower;
mod quad_mesh;
mod sector;

pub use check::Violation;
pub use ideal::Ideal;
pub use journal::{Changes, Mark};
pub(crate) use lift::lift_connected;
pub use lift::{LiftError, lift};
pub use lower::{Lowered, lower};
pub use quad_mesh::{HalfEdge, Quad, QuadKind, QuadMesh, Vertex};
