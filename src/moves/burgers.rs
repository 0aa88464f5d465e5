//! Burgers vectors and displacements of dislocations, in the lattice of Q.
//!
//! A dislocation (an adjacent v3–v5 pair of Q) carries a conserved vector; in a regular region it
//! can be anywhere, and where it is relative to where it began is a [`Displacement`].

use std::ops::Add;

/// A displacement of a dislocation in half-units: `climb` along u (v5 → v3 is the way a T-junction
/// eats its stem), `glide` along g, each half a primal edge. Steps change both by ±1 or glide by
/// ±2, so the sum is always even; an odd `climb` means that the type has changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Displacement {
    /// Along u, in halves.
    pub climb: i16,
    /// Along g, in halves.
    pub glide: i16,
}

impl Displacement {
    /// A displacement of `climb` and `glide` halves.
    #[must_use]
    pub const fn new(climb: i16, glide: i16) -> Self {
        Self { climb, glide }
    }

    /// Whether a dislocation moved by this has changed type (T-junction ↔ dual T-junction).
    #[must_use]
    pub fn swaps_type(self) -> bool {
        self.climb % 2 != 0
    }
}

impl Add for Displacement {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.climb + other.climb, self.glide + other.glide)
    }
}
