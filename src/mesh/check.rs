//! What a mesh must be before its connectivity is edited, and after.
//!
//! [`check`] names the first flaw. `mend` removes every flaw it can; the pipeline checks what it
//! is about to write.

use thiserror::Error;

use super::{Buckets, PolyMesh, Topology};

/// Why a mesh is not clean. Elements are numbered from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Flaw {
    /// Nothing to edit.
    #[error("the mesh has no faces")]
    NoFaces,
    /// A face with fewer than three corners.
    #[error("face {face} has fewer than three corners")]
    ShortFace {
        /// The face.
        face: u32,
    },
    /// A face that meets a vertex twice.
    #[error("face {face} uses vertex {vertex} more than once")]
    RepeatedVertex {
        /// The face.
        face: u32,
        /// The vertex.
        vertex: u32,
    },
    /// Two faces on the same set of vertices.
    #[error("faces {first} and {second} have the same vertices")]
    DuplicateFaces {
        /// The one with the smaller number.
        first: u32,
        /// The other.
        second: u32,
    },
    /// Three or more faces on an edge.
    #[error("the edge between vertices {a} and {b} has more than two faces")]
    NonManifoldEdge {
        /// One end.
        a: u32,
        /// The other end.
        b: u32,
    },
    /// A vertex where parts of the surface only touch.
    #[error("vertex {vertex} joins parts that share no edge there")]
    BowTie {
        /// The vertex.
        vertex: u32,
    },
    /// Neighbours that run the same way along their common edge.
    #[error("faces {first} and {second} are oriented against each other")]
    Inconsistent {
        /// The one with the smaller number.
        first: u32,
        /// The other.
        second: u32,
    },
    /// A vertex that no face uses.
    #[error("vertex {vertex} belongs to no face")]
    UnusedVertex {
        /// The vertex.
        vertex: u32,
    },
    /// A vertex inside the surface with one or two edges.
    #[error("vertex {vertex} is inside the surface and has only {valence} edges")]
    LowValence {
        /// The vertex.
        vertex: u32,
        /// How many edges it has.
        valence: u32,
    },
}

/// Passes a mesh whose every face has three or more distinct vertices and no double, which is
/// manifold and consistently oriented, with every vertex in use and no interior one of valence
/// below three. Otherwise names the first flaw. O(n log n) for n corners.
pub fn check(mesh: &PolyMesh) -> Result<(), Flaw> {
    check_connected(mesh, &Topology::new(mesh))
}

/// [`check`], where the connectivity of the mesh is known.
pub(crate) fn check_connected(mesh: &PolyMesh, topology: &Topology) -> Result<(), Flaw> {
    check_faces(mesh)?;
    check_connectivity(mesh, topology)
}

fn check_faces(mesh: &PolyMesh) -> Result<(), Flaw> {
    if mesh.face_count() == 0 {
        return Err(Flaw::NoFaces);
    }
    let mut seen = vec![super::NONE; mesh.vertex_count()];
    for (face, corners) in (0_u32..).zip(mesh.faces()) {
        if corners.len() < 3 {
            return Err(Flaw::ShortFace { face });
        }
        if let Some(vertex) = repeated(corners, face, &mut seen) {
            return Err(Flaw::RepeatedVertex { face, vertex });
        }
    }
    if let Some(vertex) = (0_u32..).zip(&seen).find(|(_, s)| **s == super::NONE).map(|(v, _)| v) {
        return Err(Flaw::UnusedVertex { vertex });
    }
    match duplicates(mesh).first() {
        Some(&(first, second)) => Err(Flaw::DuplicateFaces { first, second }),
        None => Ok(()),
    }
}

fn check_connectivity(mesh: &PolyMesh, topology: &Topology) -> Result<(), Flaw> {
    if let Some(&h) = topology.nonmanifold_edges.first() {
        let end = |h: u32| mesh.corners()[h as usize];
        return Err(Flaw::NonManifoldEdge { a: end(h), b: end(topology.next[h as usize]) });
    }
    let mut fans = vec![0_u8; mesh.vertex_count()];
    for (fan, &vertex) in topology.fan_vertex.iter().enumerate() {
        fans[vertex as usize] = fans[vertex as usize].saturating_add(1);
        if fans[vertex as usize] > 1 {
            return Err(Flaw::BowTie { vertex });
        }
        let valence = topology.fan_corners[fan];
        if valence < 3 && !topology.fan_on_boundary[fan] {
            return Err(Flaw::LowValence { vertex, valence });
        }
    }
    if let Some(h) = topology.same_direction.iter().position(|&s| s) {
        let (first, second) = (topology.face[h], topology.face[topology.twin[h] as usize]);
        return Err(Flaw::Inconsistent { first, second });
    }
    Ok(())
}

/// A vertex that comes twice in the face; `seen` remembers the last face of each vertex.
pub(crate) fn repeated(corners: &[u32], face: u32, seen: &mut [u32]) -> Option<u32> {
    corners.iter().copied().find(|&v| std::mem::replace(&mut seen[v as usize], face) == face)
}

/// Pairs of faces with the same vertices: the first such face and a later one, ordered by the
/// later. O(n log n) for n corners.
pub(crate) fn duplicates(mesh: &PolyMesh) -> Vec<(u32, u32)> {
    let key = |f: u32| {
        let face = mesh.face(f as usize);
        // A face without corners comes after all others.
        let none = (mesh.vertex_count() as u32, 0);
        let (lo, hi) = face.iter().fold(none, |(lo, hi), &v| (lo.min(v), hi.max(v)));
        (lo, (hi, face.len(), f))
    };
    let faces = Buckets::new(mesh.face_count(), mesh.vertex_count() + 1, key);
    let mut pairs = Vec::new();
    for alike in faces.iter().flat_map(|at| at.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))) {
        if alike.len() > 1 {
            pairs_among(mesh, alike, &mut pairs);
        }
    }
    pairs.sort_unstable_by_key(|&(first, later)| (later, first));
    pairs
}

fn pairs_among(mesh: &PolyMesh, faces: &[(u32, usize, u32)], pairs: &mut Vec<(u32, u32)>) {
    let sorted = |f: u32| {
        let mut corners = mesh.face(f as usize).to_vec();
        corners.sort_unstable();
        (corners, f)
    };
    let mut sets: Vec<_> = faces.iter().map(|k| sorted(k.2)).collect();
    sets.sort_unstable();
    for same in sets.chunk_by(|a, b| a.0 == b.0) {
        pairs.extend(same[1..].iter().map(|later| (same[0].1, later.1)));
    }
}
