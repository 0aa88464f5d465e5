//! Executable invariants of Q: structure, manifoldness, colouring, and Gauss-Bonnet.

use super::{HalfEdge, QuadMesh, Vertex};
use crate::mesh::NONE;
use thiserror::Error;

/// An invariant that does not hold: always a bug of this program.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Violation {
    /// `twin` is no involution, or the ends of twins do not agree.
    #[error("half-edge {0} and its twin do not fit")]
    Twin(HalfEdge),
    /// A corner has the wrong colour.
    #[error("half-edge {0} starts at a vertex of the wrong colour")]
    Colour(HalfEdge),
    /// The walk around a vertex does not agree with its valence.
    #[error("the walk around vertex {0} does not return after its valence")]
    Fan(Vertex),
    /// Two edges of the polygon mesh join the same vertices, or a vertex is twice in a face.
    #[error("vertex {0} is joined twice to the same neighbour")]
    DoubleEdge(Vertex),
}

impl QuadMesh {
    /// Checks the whole of Q. O(size).
    pub fn check(&self) -> Result<(), Violation> {
        for h in (0..self.origin.len() as u32).filter(|&h| self.origin(h) != NONE) {
            self.check_half_edge(h)?;
        }
        let mut corners = vec![0u32; self.out.len()];
        for &v in self.origin.iter().filter(|&&v| v != NONE) {
            corners[v as usize] += 1;
        }
        for v in 0..self.vertex_ids() {
            if self.valence(v) != corners[v as usize] {
                return Err(Violation::Fan(v));
            }
            if self.is_alive(v) {
                self.check_vertex(v)?;
            }
        }
        Ok(())
    }

    /// Checks what an edit can have broken around `v`. O(valence²).
    pub fn check_vertex(&self, v: Vertex) -> Result<(), Violation> {
        let walked = self.outgoing(v).take(self.valence(v) as usize + 1).count();
        if walked != self.valence(v) as usize {
            return Err(Violation::Fan(v));
        }
        for h in self.outgoing(v) {
            if self.origin(h) != v {
                return Err(Violation::Fan(v));
            }
            self.check_half_edge(h)?;
        }
        if !self.is_ghost(v) && (has_repeat(self.neighbours(v)) || self.has_double_edge(v)) {
            return Err(Violation::DoubleEdge(v));
        }
        Ok(())
    }

    /// Whether two edges of the polygon mesh join `v` to the same vertex. For a face, two common
    /// edges with a neighbour are allowed: remeshers write them and they are manifold.
    fn has_double_edge(&self, v: Vertex) -> bool {
        !self.is_face(v) && has_repeat(self.diagonals(v))
    }

    fn check_half_edge(&self, h: HalfEdge) -> Result<(), Violation> {
        let t = self.twin(h);
        if t == NONE || self.twin(t) != h || self.origin(t) != self.target(h) {
            return Err(Violation::Twin(h));
        }
        if self.is_face(self.origin(h)) != (h & 1 == 1) {
            return Err(Violation::Colour(h));
        }
        Ok(())
    }

    /// Σ (4 − valence) over Q, ghosts included: 4χ of the closed surface (equation 1).
    #[must_use]
    pub fn index_sum(&self) -> i64 {
        (0..self.vertex_ids())
            .filter(|&v| self.is_alive(v))
            .map(|v| 4 - i64::from(self.valence(v)))
            .sum()
    }

    /// χ of the closed surface: vertices − quads of Q, since each quad has two edges of its own.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        let vertices = (0..self.vertex_ids()).filter(|&v| self.is_alive(v)).count() as i64;
        vertices - (0..self.quad_ids()).filter(|&q| self.is_quad_alive(q)).count() as i64
    }
}

fn has_repeat(values: impl Iterator<Item = Vertex>) -> bool {
    let mut seen: smallvec::SmallVec<[Vertex; 16]> = values.collect();
    seen.sort_unstable();
    seen.windows(2).any(|w| w[0] == w[1])
}
