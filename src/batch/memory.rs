//! How much memory a mesh takes to be cleaned, and waiting until there is so much.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use thiserror::Error;

/// Bytes for each face of the mesh, more than was ever measured; see `docs/scale.md`.
const BYTES_PER_FACE: u64 = 4000;
/// Bytes for each face of the reference.
const BYTES_PER_REFERENCE_FACE: u64 = 800;
/// Bytes for whatever mesh.
const BASE_BYTES: u64 = 48 << 20;

/// About how many bytes it takes to clean a mesh of so many faces on a reference of so many.
#[must_use]
pub fn estimate(faces: usize, reference_faces: usize) -> u64 {
    let part = |count: usize, each: u64| (count as u64).saturating_mul(each);
    BASE_BYTES
        .saturating_add(part(faces, BYTES_PER_FACE))
        .saturating_add(part(reference_faces, BYTES_PER_REFERENCE_FACE))
}

/// A mesh does not fit even if nothing else runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "needs about {} MB of memory, and the limit is {} MB; raise --memory-limit or clean it in parts",
    needed >> 20, limit >> 20
)]
pub struct TooLarge {
    /// Bytes that it takes.
    pub needed: u64,
    /// Bytes that there are.
    pub limit: u64,
}

/// Memory that meshes share.
#[derive(Debug)]
pub struct Memory {
    limit: u64,
    taken: Mutex<u64>,
    freed: Condvar,
}

/// A part of the memory; it is given back when this is dropped.
#[derive(Debug)]
pub struct Lease<'a> {
    memory: &'a Memory,
    bytes: u64,
}

impl Memory {
    /// So many bytes for all.
    #[must_use]
    pub fn new(limit: u64) -> Self {
        Self { limit, taken: Mutex::new(0), freed: Condvar::new() }
    }

    /// Waits until so many bytes are free, and takes them.
    pub fn take(&self, bytes: u64) -> Result<Lease<'_>, TooLarge> {
        if bytes > self.limit {
            return Err(TooLarge { needed: bytes, limit: self.limit });
        }
        let mut taken = self.lock();
        while bytes > self.limit - *taken {
            taken = self.freed.wait(taken).unwrap_or_else(PoisonError::into_inner);
        }
        *taken += bytes;
        Ok(Lease { memory: self, bytes })
    }

    /// A sum is never left half done.
    fn lock(&self) -> MutexGuard<'_, u64> {
        self.taken.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Lease<'_> {
    fn drop(&mut self) {
        *self.memory.lock() -= self.bytes;
        self.memory.freed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU64, Ordering};

    #[test]
    fn never_more_than_the_limit_is_taken() {
        let (memory, now, most) = (Memory::new(100), AtomicU64::new(0), AtomicU64::new(0));
        std::thread::scope(|scope| {
            for bytes in [60, 50, 40, 30, 100, 10, 70, 20] {
                let (memory, now, most) = (&memory, &now, &most);
                scope.spawn(move || {
                    let _lease = memory.take(bytes).unwrap();
                    let taken = now.fetch_add(bytes, Ordering::SeqCst) + bytes;
                    most.fetch_max(taken, Ordering::SeqCst);
                    std::thread::yield_now();
                    now.fetch_sub(bytes, Ordering::SeqCst);
                });
            }
        });
        assert!(most.into_inner() <= 100);
        assert_eq!(*memory.lock(), 0, "all is given back");
    }

    #[test]
    fn what_can_never_fit_is_refused() {
        let refused = Memory::new(1 << 20).take(3 << 20).unwrap_err();
        assert_eq!(refused, TooLarge { needed: 3 << 20, limit: 1 << 20 });
        assert!(refused.to_string().contains("3 MB"), "{refused}");
    }
}
