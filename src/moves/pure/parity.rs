//! What stops a pure quad mesh: parts of the mesh between frozen edges with an odd rim.
//!
//! Counting the edges of the faces of such a part counts each inner edge twice and each frozen
//! one once for each side on it, so the number of odd faces has the parity of the rim. Edits keep
//! the rim, so they keep that parity (Peng & Wonka 2013, Proposition 3.3).

use crate::mesh::DisjointSets;
use crate::sqrtcc::{QuadMesh, Vertex};
use serde::Serialize;
use thiserror::Error;

/// A part of the mesh that cannot be all quads as long as its rim is kept.
#[derive(Debug, Clone, PartialEq, Serialize, Error)]
#[error(
    "the part of {faces} faces at ({:.6}, {:.6}, {:.6}) is enclosed by {rim} boundary and feature \
     edges; that number is odd, so one face must keep an odd number of corners as long as these \
     edges are kept",
    place[0], place[1], place[2]
)]
pub struct Obstruction {
    /// The smallest d-vertex of the part.
    pub face: Vertex,
    /// Where that is.
    pub place: [f64; 3],
    /// Number of faces.
    pub faces: usize,
    /// Frozen edges around it, those with both sides inside counted twice.
    pub rim: usize,
}

/// The parts of the mesh with an odd rim, in order of face. O(n).
#[must_use]
pub fn obstructions(mesh: &QuadMesh) -> Vec<Obstruction> {
    let mut sets = DisjointSets::new(mesh.vertex_ids() as usize);
    for q in mesh.quads().filter(|&q| !mesh.is_frozen(q)) {
        sets.join(mesh.origin(4 * q + 1) as usize, mesh.origin(4 * q + 3) as usize);
    }
    let mut parts = vec![(0usize, 0usize); mesh.vertex_ids() as usize];
    for f in mesh.vertices().filter(|&v| mesh.is_face(v)) {
        let frozen = mesh.outgoing(f).filter(|&h| mesh.is_frozen(QuadMesh::quad(h))).count();
        let part = &mut parts[sets.root(f as usize)];
        *part = (part.0 + 1, part.1 + frozen);
    }
    let odd = parts.iter().enumerate().filter(|(_, part)| part.1 % 2 == 1);
    let found = odd.map(|(face, &(faces, rim))| {
        let place = mesh.location(face as u32).coords.into();
        Obstruction { face: face as u32, place, faces, rim }
    });
    found.collect()
}
