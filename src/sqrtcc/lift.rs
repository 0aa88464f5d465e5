//! Lifting a polygon mesh to Q: one quad an edge, in one pass over the corners.
//!
//! Corner c (half-edge a→b of face f) owns the half-edge f→a of the quad of its edge; the one
//! before it in that quad is b→f, whose twin f→b belongs to the next corner of f. That is the
//! whole construction; vertex v keeps its number and face f becomes vertex V + f.

use super::QuadMesh;
use super::journal::Journal;
use super::quad_mesh::{FACE, GHOST, HELD, QuadKind};
use crate::mesh::{NONE, Point, PolyMesh, Topology};
use fixedbitset::FixedBitSet;
use thiserror::Error;

/// Why a mesh cannot be lifted. [`crate::mesh`] mends all of these.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum LiftError {
    /// Three or more faces on an edge.
    #[error("an edge of face {face} has three or more faces; mend the mesh first")]
    NonManifoldEdge {
        /// One of the faces, from 0.
        face: u32,
    },
    /// Several fans on a vertex, or a vertex twice in a face.
    #[error("vertex {vertex} joins parts that share no edge; mend the mesh first")]
    NonManifoldVertex {
        /// The vertex, from 0.
        vertex: u32,
    },
    /// Neighbouring faces run the same way along their edge.
    #[error("face {face} and a neighbour are inconsistently oriented; mend the mesh first")]
    Orientation {
        /// One of the faces, from 0.
        face: u32,
    },
    /// A face with fewer than three corners.
    #[error("face {face} has fewer than three corners; mend the mesh first")]
    DegenerateFace {
        /// The face, from 0.
        face: u32,
    },
    /// A vertex of no face.
    #[error("vertex {vertex} belongs to no face; mend the mesh first")]
    Isolated {
        /// The vertex, from 0.
        vertex: u32,
    },
}

/// Lifts a clean polygon mesh to the √CC domain. `features` marks the corners whose edge is a
/// sharp feature (either side suffices). O(corners).
pub fn lift(mesh: &PolyMesh, features: &FixedBitSet) -> Result<QuadMesh, LiftError> {
    lift_connected((mesh, &Topology::new(mesh)), features)
}

/// [`lift`], where the connectivity of the mesh is known.
pub(crate) fn lift_connected(
    (mesh, topology): (&PolyMesh, &Topology),
    features: &FixedBitSet,
) -> Result<QuadMesh, LiftError> {
    refuse_unclean(mesh, topology)?;
    let closed = Closed::new(mesh, topology);
    let mut q = closed.quad_mesh(mesh, features);
    q.hold_frozen_ends();
    for ideal in q.measured_ideals() {
        q.set_ideal(ideal.first, ideal.faces);
    }
    q.commit();
    Ok(q)
}

fn refuse_unclean(mesh: &PolyMesh, topology: &Topology) -> Result<(), LiftError> {
    if let Some(face) = mesh.faces().position(|f| f.len() < 3) {
        return Err(LiftError::DegenerateFace { face: face as u32 });
    }
    if let Some(&h) = topology.nonmanifold_edges.first() {
        return Err(LiftError::NonManifoldEdge { face: topology.face[h as usize] });
    }
    if let Some(h) = topology.same_direction.iter().position(|&same| same) {
        return Err(LiftError::Orientation { face: topology.face[h] });
    }
    let mut fans = vec![0u32; mesh.vertex_count()];
    for &v in &topology.fan_vertex {
        fans[v as usize] += 1;
    }
    match fans.iter().position(|&n| n != 1) {
        Some(v) if fans[v] == 0 => Err(LiftError::Isolated { vertex: v as u32 }),
        Some(v) => Err(LiftError::NonManifoldVertex { vertex: v as u32 }),
        None => Ok(()),
    }
}

/// The mesh as closed corner arrays: a ghost triangle (b, a, apex) lies against each boundary
/// half-edge a→b, all those of one loop around the same apex.
struct Closed {
    vertex: Vec<u32>,
    next: Vec<u32>,
    twin: Vec<u32>,
    face: Vec<u32>,
    faces: u32,
    vertices: u32,
    real_corners: u32,
}

impl Closed {
    fn new(mesh: &PolyMesh, topology: &Topology) -> Self {
        let real_corners = mesh.corner_count() as u32;
        let mut closed = Self {
            vertex: mesh.corners().to_vec(),
            next: topology.next.clone(),
            twin: topology.twin.clone(),
            face: topology.face.clone(),
            faces: mesh.face_count() as u32,
            vertices: mesh.vertex_count() as u32,
            real_corners,
        };
        let mut leaving = vec![NONE; mesh.vertex_count()];
        for h in topology.boundary_half_edges() {
            leaving[mesh.corners()[h as usize] as usize] = h;
        }
        for h in 0..real_corners {
            if closed.twin[h as usize] == NONE {
                closed.close_loop(h, &leaving);
            }
        }
        closed
    }

    /// Ghosts along the boundary loop of `start`.
    fn close_loop(&mut self, start: u32, leaving: &[u32]) {
        let apex = self.vertices;
        self.vertices += 1;
        let first = self.vertex.len() as u32;
        let mut h = start;
        loop {
            let (a, b) = (self.vertex[h as usize], self.vertex[self.next[h as usize] as usize]);
            let ghost = self.vertex.len() as u32;
            self.vertex.extend([b, a, apex]);
            self.next.extend([ghost + 1, ghost + 2, ghost]);
            // a→apex meets apex→a of the ghost before; the first one is set when the loop ends.
            self.twin.extend([h, ghost.wrapping_sub(1), ghost + 4]);
            self.face.extend([self.faces; 3]);
            self.faces += 1;
            self.twin[h as usize] = ghost;
            h = leaving[b as usize];
            if h == start {
                self.twin[ghost as usize + 2] = first + 1;
                self.twin[first as usize + 1] = ghost + 2;
                return;
            }
        }
    }

    fn quad_mesh(&self, mesh: &PolyMesh, features: &FixedBitSet) -> QuadMesh {
        let (vertices, quads) = (self.vertices + self.faces, self.vertex.len() / 2);
        // Nothing of this is ever undone: it does without the journal, which would take more memory
        // than the mesh.
        let mut q = QuadMesh {
            origin: vec![NONE; 4 * quads],
            twin: vec![NONE; 4 * quads],
            kind: Vec::with_capacity(quads),
            ideal: vec![0; 2 * quads],
            out: vec![NONE; vertices as usize],
            valence: vec![0; vertices as usize],
            class: self.classes(mesh),
            group: vec![0; self.vertices as usize],
            position: mesh.points().to_vec(),
            journal: Journal::default(),
        };
        q.group.extend(mesh.groups());
        q.group.resize(vertices as usize, 0);
        q.position.resize(vertices as usize, Point::origin());
        let slots = self.add_quads(&mut q.kind, features);
        for (c, &slot) in slots.iter().enumerate() {
            let (f, v) = ((self.vertices + self.face[c]) as usize, self.vertex[c] as usize);
            let to_vertex = QuadMesh::next(slot);
            (q.origin[slot as usize], q.origin[to_vertex as usize]) = (f as u32, v as u32);
            (q.out[f], q.out[v]) = (slot, to_vertex);
            let twin = slots[self.next[c] as usize];
            (q.twin[slot as usize - 1], q.twin[twin as usize]) = (twin, slot - 1);
            q.valence[f] += 1;
            q.valence[v] += 1;
        }
        q
    }

    /// What each vertex of Q is: vertices, their ghosts, faces, theirs.
    fn classes(&self, mesh: &PolyMesh) -> Vec<u32> {
        let (vertices, faces) = (mesh.vertex_count(), mesh.face_count());
        let ghosts = self.vertices as usize - vertices;
        let ghost_faces = self.faces as usize - faces;
        let runs = [(0, vertices), (GHOST, ghosts), (FACE, faces), (FACE | GHOST, ghost_faces)];
        runs.into_iter().flat_map(|(class, count)| std::iter::repeat_n(class, count)).collect()
    }

    /// A quad for each pair of twin corners; the half-edge face→vertex that each corner owns.
    fn add_quads(&self, kinds: &mut Vec<u32>, features: &FixedBitSet) -> Vec<u32> {
        let mut slots = vec![NONE; self.vertex.len()];
        for (c, &t) in self.twin.iter().enumerate() {
            if slots[c] != NONE {
                continue;
            }
            let quad = kinds.len() as u32;
            slots[c] = 4 * quad + 3;
            slots[t as usize] = 4 * quad + 1;
            kinds.push(self.edge_kind(c as u32, t, features) as u32);
        }
        slots
    }

    fn edge_kind(&self, c: u32, t: u32, features: &FixedBitSet) -> QuadKind {
        let ghosts = u32::from(c >= self.real_corners) + u32::from(t >= self.real_corners);
        match ghosts {
            2 => QuadKind::Ghost,
            1 => QuadKind::Boundary,
            _ if features.contains(c as usize) || features.contains(t as usize) => {
                QuadKind::Feature
            }
            _ => QuadKind::Free,
        }
    }
}

impl QuadMesh {
    fn hold_frozen_ends(&mut self) {
        for quad in 0..self.quad_ids() {
            if self.is_frozen(quad) {
                for h in [4 * quad, 4 * quad + 2] {
                    self.class[self.origin[h as usize] as usize] |= HELD;
                }
            }
        }
    }
}
