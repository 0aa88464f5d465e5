//! The quad mesh Q with implicit quads: half-edge `h` is corner `h % 4` of quad `h / 4`.
//!
//! `next`, `prev` and `opposite` are arithmetic; only `origin` and `twin` are stored. Walking out
//! of a vertex counter-clockwise is `twin(prev h)`, clockwise `next(twin h)`.
//!
//! *Invariant:* even corners are p-vertices and odd corners d-vertices, so the 2-colouring of
//! Proposition 3.1 is a matter of parity and cannot be lost.
//! *Invariant:* Q is closed. Each boundary loop of the polygon mesh carries a ghost p-vertex and
//! a ghost face for each of its edges; ghosts never change valence.
//! *Invariant:* ids are only appended; a removed element keeps its id and is dead.

use super::journal::{Journal, Slot};
use crate::mesh::{NONE, Point};

/// A half-edge of Q.
pub type HalfEdge = u32;
/// A vertex of Q: a p-vertex (vertex of the polygon mesh) or a d-vertex (face of it).
pub type Vertex = u32;
/// A quad of Q: an edge of the polygon mesh.
pub type Quad = u32;

/// What edge of the polygon mesh a quad stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum QuadKind {
    /// An edge that edits may move, collapse or delete.
    Free = 0,
    /// A sharp feature: frozen.
    Feature = 1,
    /// An edge on the boundary: frozen.
    Boundary = 2,
    /// An edge to a ghost: frozen, not part of the polygon mesh.
    Ghost = 3,
}

pub(super) const FACE: u32 = 1;
pub(super) const GHOST: u32 = 2;
pub(super) const HELD: u32 = 4;
pub(super) const PIN: u32 = 8;

/// The √CC mesh. Every write is journaled and can be undone exactly.
#[derive(Debug, Clone, Default)]
pub struct QuadMesh {
    pub(super) origin: Vec<u32>,
    pub(super) twin: Vec<u32>,
    pub(super) kind: Vec<u32>,
    /// Ideal number of faces of the two sectors that begin (counter-clockwise) at this frozen
    /// quad, one at each p-corner: `ideal[2 * quad + corner / 2]`.
    pub(super) ideal: Vec<u8>,
    pub(super) out: Vec<u32>,
    pub(super) valence: Vec<u32>,
    pub(super) class: Vec<u32>,
    pub(super) group: Vec<u32>,
    pub(super) position: Vec<Point>,
    pub(super) journal: Journal,
}

impl QuadMesh {
    /// Next half-edge of the same quad.
    #[inline]
    #[must_use]
    pub fn next(h: HalfEdge) -> HalfEdge {
        (h & !3) | ((h + 1) & 3)
    }

    /// Previous half-edge of the same quad.
    #[inline]
    #[must_use]
    pub fn prev(h: HalfEdge) -> HalfEdge {
        (h & !3) | ((h + 3) & 3)
    }

    /// The half-edge across the quad.
    #[inline]
    #[must_use]
    pub fn opposite(h: HalfEdge) -> HalfEdge {
        h ^ 2
    }

    /// Quad of a half-edge.
    #[inline]
    #[must_use]
    pub fn quad(h: HalfEdge) -> Quad {
        h >> 2
    }

    /// Where the half-edge comes from.
    #[inline]
    #[must_use]
    pub fn origin(&self, h: HalfEdge) -> Vertex {
        self.origin[h as usize]
    }

    /// Where the half-edge goes to.
    #[inline]
    #[must_use]
    pub fn target(&self, h: HalfEdge) -> Vertex {
        self.origin[Self::next(h) as usize]
    }

    /// The same edge from the quad on its other side.
    #[inline]
    #[must_use]
    pub fn twin(&self, h: HalfEdge) -> HalfEdge {
        self.twin[h as usize]
    }

    /// Next half-edge out of the same origin, counter-clockwise.
    #[inline]
    #[must_use]
    pub fn ccw(&self, h: HalfEdge) -> HalfEdge {
        self.twin[Self::prev(h) as usize]
    }

    /// Next half-edge out of the same origin, clockwise.
    #[inline]
    #[must_use]
    pub fn cw(&self, h: HalfEdge) -> HalfEdge {
        Self::next(self.twin[h as usize])
    }

    /// A half-edge out of `v`; [`NONE`] if `v` is dead.
    #[inline]
    #[must_use]
    pub fn out(&self, v: Vertex) -> HalfEdge {
        self.out[v as usize]
    }

    /// Number of edges at `v`.
    #[inline]
    #[must_use]
    pub fn valence(&self, v: Vertex) -> u32 {
        self.valence[v as usize]
    }

    /// Ids handed out so far, dead ones included.
    #[inline]
    #[must_use]
    pub fn vertex_ids(&self) -> u32 {
        self.out.len() as u32
    }

    /// Quad ids handed out so far, dead ones included.
    #[inline]
    #[must_use]
    pub fn quad_ids(&self) -> u32 {
        self.kind.len() as u32
    }

    /// Whether `v` is in use.
    #[inline]
    #[must_use]
    pub fn is_alive(&self, v: Vertex) -> bool {
        self.out[v as usize] != NONE
    }

    /// Whether the quad is in use.
    #[inline]
    #[must_use]
    pub fn is_quad_alive(&self, q: Quad) -> bool {
        self.origin[4 * q as usize] != NONE
    }

    /// Whether `v` is a d-vertex, that is a face of the polygon mesh.
    #[inline]
    #[must_use]
    pub fn is_face(&self, v: Vertex) -> bool {
        self.class[v as usize] & FACE != 0
    }

    /// Whether `v` only closes the mesh over a boundary.
    #[inline]
    #[must_use]
    pub fn is_ghost(&self, v: Vertex) -> bool {
        self.class[v as usize] & GHOST != 0
    }

    /// Whether `v` is a p-vertex on a boundary or feature, or a pin: it stays where it is.
    #[inline]
    #[must_use]
    pub fn is_held(&self, v: Vertex) -> bool {
        self.class[v as usize] & (HELD | PIN) != 0
    }

    /// Whether `v` lies on a boundary or feature, where sectors count and not the valence. A pin keeps
    /// its place alone: its valence may be moved away from it.
    #[inline]
    #[must_use]
    pub fn is_on_line(&self, v: Vertex) -> bool {
        self.class[v as usize] & HELD != 0
    }

    /// Whether `v` is held by itself alone, see [`Self::pin`].
    #[inline]
    #[must_use]
    pub fn is_pin(&self, v: Vertex) -> bool {
        self.class[v as usize] & (HELD | PIN) == PIN
    }

    /// What the quad stands for.
    #[inline]
    #[must_use]
    pub fn kind(&self, q: Quad) -> QuadKind {
        match self.kind[q as usize] {
            0 => QuadKind::Free,
            1 => QuadKind::Feature,
            2 => QuadKind::Boundary,
            _ => QuadKind::Ghost,
        }
    }

    /// Whether the edge of the polygon mesh may not be changed.
    #[inline]
    #[must_use]
    pub fn is_frozen(&self, q: Quad) -> bool {
        self.kind[q as usize] != QuadKind::Free as u32
    }

    /// Group number of the face `v`.
    #[must_use]
    pub fn group(&self, v: Vertex) -> u32 {
        self.group[v as usize]
    }

    /// Where the p-vertex `v` is; meaningless for d-vertices, see [`Self::location`].
    #[inline]
    #[must_use]
    pub fn position(&self, v: Vertex) -> Point {
        self.position[v as usize]
    }

    /// A place in space for any vertex: its position, or the mean of the corners of the face.
    #[must_use]
    pub fn location(&self, v: Vertex) -> Point {
        if !self.is_face(v) {
            return self.position(v);
        }
        let sum = self.neighbours(v).map(|p| self.position(p).coords).sum::<crate::mesh::Vector>();
        Point::from(sum / f64::from(self.valence(v).max(1)))
    }

    /// The half-edges out of `v`, counter-clockwise from [`Self::out`]. O(valence).
    #[must_use]
    pub fn outgoing(&self, v: Vertex) -> Outgoing<'_> {
        let start = self.out(v);
        Outgoing { mesh: self, start, at: start }
    }

    /// The vertices joined to `v` by an edge of Q: faces of a vertex, or vertices of a face.
    pub fn neighbours(&self, v: Vertex) -> impl Iterator<Item = Vertex> + '_ {
        self.outgoing(v).map(|h| self.target(h))
    }

    /// The vertices across the quads of `v`: joined by an edge of the polygon mesh (p), or faces
    /// that share one (d).
    pub fn diagonals(&self, v: Vertex) -> impl Iterator<Item = Vertex> + '_ {
        self.outgoing(v).map(|h| self.origin(Self::opposite(h)))
    }

    /// The half-edge from `a` to `b`, if they are joined. O(valence of `a`).
    #[must_use]
    pub fn find(&self, a: Vertex, b: Vertex) -> Option<HalfEdge> {
        self.outgoing(a).find(|&h| self.target(h) == b)
    }

    /// Living vertices that are no ghosts, in order of id.
    pub fn vertices(&self) -> impl Iterator<Item = Vertex> + '_ {
        (0..self.vertex_ids()).filter(|&v| self.is_alive(v) && !self.is_ghost(v))
    }

    /// Living quads that stand for edges of the polygon mesh, in order of id.
    pub fn quads(&self) -> impl Iterator<Item = Quad> + '_ {
        (0..self.quad_ids()).filter(|&q| self.is_quad_alive(q) && self.kind(q) != QuadKind::Ghost)
    }

    /// Pins a p-vertex: edits may join it to others, but there will always be a vertex just here.
    /// Not journaled.
    pub fn pin(&mut self, v: Vertex) {
        self.class[v as usize] |= PIN;
    }

    /// Lets a pin move again. Not journaled.
    pub fn unpin(&mut self, v: Vertex) {
        self.class[v as usize] &= !PIN;
    }

    /// Moves a p-vertex. Journaled.
    pub fn set_position(&mut self, v: Vertex, point: Point) {
        self.journal.record_point(v, self.position[v as usize]);
        self.position[v as usize] = point;
    }

    #[inline]
    pub(crate) fn set_origin(&mut self, h: HalfEdge, v: Vertex) {
        self.journal.record(Slot::Origin, h, self.origin[h as usize]);
        self.origin[h as usize] = v;
    }

    #[inline]
    fn set_twin(&mut self, h: HalfEdge, t: HalfEdge) {
        self.journal.record(Slot::Twin, h, self.twin[h as usize]);
        self.twin[h as usize] = t;
    }

    /// Makes two half-edges twins of one another.
    #[inline]
    pub(crate) fn join(&mut self, h: HalfEdge, t: HalfEdge) {
        self.set_twin(h, t);
        self.set_twin(t, h);
    }

    #[inline]
    pub(crate) fn set_out(&mut self, v: Vertex, h: HalfEdge) {
        self.journal.record(Slot::Out, v, self.out[v as usize]);
        self.out[v as usize] = h;
    }

    #[inline]
    pub(crate) fn set_valence(&mut self, v: Vertex, valence: u32) {
        self.journal.record(Slot::Valence, v, self.valence[v as usize]);
        self.valence[v as usize] = valence;
    }

    /// Takes a vertex out of use.
    pub(crate) fn kill_vertex(&mut self, v: Vertex) {
        self.set_out(v, NONE);
        self.set_valence(v, 0);
    }

    /// Takes a quad out of use.
    pub(crate) fn kill_quad(&mut self, q: Quad) {
        for h in 4 * q..4 * q + 4 {
            self.set_origin(h, NONE);
            self.set_twin(h, NONE);
        }
    }

    /// A new vertex of the colour and group of `like`, neither held nor ghost, not yet connected.
    pub(crate) fn add_vertex_like(&mut self, like: Vertex, position: Point) -> Vertex {
        self.add_vertex(self.class[like as usize] & FACE, self.group(like), position)
    }

    /// A new p-vertex of the group of `like`, held by a feature, not yet connected.
    pub(crate) fn add_held_vertex_like(&mut self, like: Vertex, position: Point) -> Vertex {
        self.add_vertex(HELD, self.group(like), position)
    }

    pub(super) fn add_vertex(&mut self, class: u32, group: u32, position: Point) -> Vertex {
        self.journal.record(Slot::NewVertex, 0, 0);
        self.out.push(NONE);
        self.valence.push(0);
        self.class.push(class);
        self.group.push(group);
        self.position.push(position);
        self.vertex_ids() - 1
    }

    /// A new free quad, with no corners yet.
    pub(crate) fn add_quad(&mut self) -> Quad {
        self.journal.record(Slot::NewQuad, 0, 0);
        self.origin.extend([NONE; 4]);
        self.twin.extend([NONE; 4]);
        self.kind.push(QuadKind::Free as u32);
        self.ideal.extend([0; 2]);
        self.quad_ids() - 1
    }

    /// A new quad of the kind of `like`, with no corners yet.
    pub(crate) fn add_quad_like(&mut self, like: Quad) -> Quad {
        let quad = self.add_quad();
        self.kind[quad as usize] = self.kind[like as usize];
        quad
    }

    /// The ideal number of faces of the sector that begins at the quad of `h`, at its origin, a
    /// p-vertex; for frozen quads only.
    pub(crate) fn ideal_at(&self, h: HalfEdge) -> u8 {
        self.ideal[Self::ideal_index(h)]
    }

    pub(crate) fn set_ideal(&mut self, h: HalfEdge, ideal: u8) {
        let index = Self::ideal_index(h);
        self.journal.record(Slot::Ideal, index as u32, u32::from(self.ideal[index]));
        self.ideal[index] = ideal;
    }

    /// Where the ideal is kept of the sector that begins at the quad of `h`, at its origin.
    pub(super) fn ideal_index(h: HalfEdge) -> usize {
        2 * Self::quad(h) as usize + (h as usize & 3) / 2
    }
}

/// Walks the half-edges out of a vertex, counter-clockwise.
#[derive(Debug, Clone)]
pub struct Outgoing<'a> {
    mesh: &'a QuadMesh,
    start: HalfEdge,
    at: HalfEdge,
}

impl Iterator for Outgoing<'_> {
    type Item = HalfEdge;

    #[inline]
    fn next(&mut self) -> Option<HalfEdge> {
        if self.at == NONE {
            return None;
        }
        let h = self.at;
        let after = self.mesh.ccw(h);
        self.at = if after == self.start { NONE } else { after };
        Some(h)
    }
}
