//! How much a file may ask for.
//!
//! Readers take memory for what they have read, never for what a header announces, so that a small
//! file stays small. What is left are data that are small only as long as they are packed, and
//! files that are too large for the person who reads them.

use crate::knobs::knobs;

knobs! {
    /// How large a mesh file may be; a larger one is refused.
    pub struct ReadOptions in "read" {
        /// Most vertices of a mesh.
        vertices: u32 = 2_147_483_646, in 1.0..=2_147_483_646.0, "vertices";
        /// Most faces of a mesh.
        faces: u32 = 2_147_483_646, in 1.0..=2_147_483_646.0, "faces";
        /// Most corners of a face.
        degree: u32 = 10_000, in 3.0..=2_147_483_646.0, "corners";
        /// How many times its packed size a gzip file may have unpacked; the first 64 MiB are free.
        expansion: u32 = 100, in 1.0..=2_000.0, "times";
    }
}
