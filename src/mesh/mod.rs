//! Polygon meshes as the outside world knows them: points and faces of any degree.
//!
//! [`PolyMesh`] is plain storage and may hold any soup; [`Topology`] is the connectivity of that
//! soup cut at its non-manifold places.

mod buckets;
mod check;
mod mend;
mod polygon;
pub mod shapes;
mod topology;

pub(crate) use buckets::Buckets;
pub use check::{Flaw, check};
pub(crate) use check::{check_connected, duplicates, repeated};
pub(crate) use mend::mend_connected;
pub use mend::{Mend, MendError, MendKind, MendPolicy, MendReport, mend};
pub use polygon::{MeshError, Point, PolyMesh, Vector};
pub use topology::{DisjointSets, NONE, Topology};
