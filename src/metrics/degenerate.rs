//! Connectivity that no clean mesh has: faces that repeat a vertex or another face, faces glued
//! to themselves or twice to a neighbour, vertices of valence 1 and 2.

use super::components::partner_pairs;
use crate::mesh::{Buckets, NONE, PolyMesh, Topology, duplicates, repeated};
use serde::Serialize;

/// Counts of degenerate elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Degenerate {
    /// Faces that visit a vertex twice.
    pub faces_repeated_vertex: usize,
    /// Faces with the vertices of an earlier one.
    pub duplicate_faces: usize,
    /// Faces with fewer than three corners.
    pub faces_degree_lt3: usize,
    /// Edges with the same face on both sides.
    pub faces_glued_to_self: usize,
    /// Pairs of faces that share two or more edges.
    pub face_pairs_sharing_2plus_edges: usize,
    /// Interior vertices of valence 2.
    pub doublets_valence2_interior: usize,
    /// Interior vertices of valence 1.
    pub valence1_interior: usize,
}

impl Degenerate {
    /// Counts. O(n log n) for n corners.
    pub(super) fn new(mesh: &PolyMesh, topology: &Topology) -> Self {
        let mut seen = vec![NONE; mesh.vertex_count()];
        let repeats = |&(f, face): &(u32, &[u32])| repeated(face, f, &mut seen).is_some();
        let (glued, twice) = shared_edges(mesh.face_count(), topology);
        Self {
            faces_repeated_vertex: (0..).zip(mesh.faces()).filter(repeats).count(),
            duplicate_faces: duplicates(mesh).len(),
            faces_degree_lt3: mesh.faces().filter(|face| face.len() < 3).count(),
            faces_glued_to_self: glued,
            face_pairs_sharing_2plus_edges: twice,
            doublets_valence2_interior: interior_of_valence(topology, 2),
            valence1_interior: interior_of_valence(topology, 1),
        }
    }

    /// Whether there is nothing of the kind.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        self.faces_repeated_vertex == 0
            && self.duplicate_faces == 0
            && self.faces_degree_lt3 == 0
            && self.faces_glued_to_self == 0
            && self.face_pairs_sharing_2plus_edges == 0
            && self.doublets_valence2_interior == 0
            && self.valence1_interior == 0
    }
}

/// Edges between a face and itself, and pairs of faces with several common edges.
fn shared_edges(face_count: usize, topology: &Topology) -> (usize, usize) {
    let faces = |(h, t): (usize, usize)| {
        let (f, g) = (topology.face[h], topology.face[t]);
        (f.min(g), f.max(g))
    };
    let pairs: Vec<(u32, u32)> = partner_pairs(topology).map(faces).collect();
    let glued = pairs.iter().filter(|(f, g)| f == g).count();
    let sorted = Buckets::new(pairs.len(), face_count, |i| pairs[i as usize]);
    let several = |(f, others): (u32, &[u32])| {
        others.chunk_by(|g, h| g == h).filter(|same| same[0] != f && same.len() > 1).count()
    };
    (glued, (0..).zip(sorted.iter()).map(several).sum())
}

fn interior_of_valence(topology: &Topology, valence: u32) -> usize {
    let fans = topology.fan_corners.iter().zip(&topology.fan_on_boundary);
    fans.filter(|&(&n, &boundary)| !boundary && n == valence).count()
}
