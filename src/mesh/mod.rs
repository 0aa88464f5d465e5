//! Polygon meshes as the outside world knows them: points and faces of any degree.
//!
//! [`PolyMesh`] is plain storage and may hold any soup; [`Topology`] is the connectivity of that
//! soup cut at its non-manifold places.

mod check;
mod mend;
mod polygon;
pub mod shapes;
mod topology;

pub use check::{Flaw, check};
pub use mend::{Mend, MendError, MendKind, MendPolicy, MendReport, mend};
pub use polygon::{MeshError, Point, PolyMesh, Vector};
pub use topology::{DisjointSets, NONE, Topology};
