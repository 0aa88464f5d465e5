//! Many meshes: what became of each, what need not be done again, and a page about all of them.
//!
//! A batch leaves a [`manifest`], one line of JSON a mesh, from which it can be taken up again;
//! [`table`] makes CSV of it and [`page`] an overview with pictures. [`Memory`] keeps meshes that
//! are cleaned at the same time from needing more than there is. Running them is up to the caller,
//! who has the clock.

pub mod manifest;
mod memory;
mod page;
mod table;
mod thumbnail;

pub use manifest::{Entry, Manifest, Status};
pub use memory::{Lease, Memory, TooLarge, estimate};
pub use page::{Row, page};
pub use table::{csv, quoted};
pub use thumbnail::thumbnails;
