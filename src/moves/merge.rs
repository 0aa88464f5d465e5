//! Merging two irregular elements into one of index −2, and splitting it again.
//!
//! ```text
//!    v5                       v5 ─ v5  share a face and an edge: delete the edge
//!         v5    closer →         │         →   f6
//!                             (two f5 that share an edge: collapse it → v6)
//! ```
//! Around both, directions turn by half a turn, and the one place about which they do is where the
//! merged element must be: a vertex or face only if the two have the same type and the same index.
//! Source: Peng & Wonka 2013, Proposition 3.5.

use super::element::Element;
use super::pair::{self, Direction};
use super::path::REACH;
use super::{MoveRefusal, Route, basic};
use crate::ops::{Collapse, Op, Split};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};

/// A merged element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Merged {
    /// The element of index −2.
    pub element: Vertex,
    /// The operations that were made.
    pub ops: Vec<Op>,
}

/// Moves two elements of the same type and index −1 together until they are one of six edges.
///
/// Refused, before anything is touched, for different types, for different indices, and for index
/// +1: two edges make no vertex and no face. Inverse: [`split_element`], then
/// [`pair::shift`] apart. E stays the same. Source: Peng & Wonka 2013, Proposition 3.5.
pub fn merge(
    mesh: &mut QuadMesh,
    elements: [Vertex; 2],
    route: Route,
) -> Result<Merged, MoveRefusal> {
    let [a, b] = [Element::at(mesh, elements[0])?, Element::at(mesh, elements[1])?];
    if a == b {
        return Err(MoveRefusal::SameElement);
    }
    if a.kind.index() != b.kind.index() {
        return Err(MoveRefusal::OppositeIndices(a.kind, b.kind));
    }
    if a.kind != b.kind {
        return Err(MoveRefusal::DifferentTypes(a.kind, b.kind));
    }
    if a.kind.index() > 0 {
        return Err(MoveRefusal::TooFewEdges(a.kind));
    }
    let mark = mesh.mark();
    let done = together(mesh, elements, route);
    if done.is_err() {
        mesh.undo_to(mark);
    }
    done
}

fn together(
    mesh: &mut QuadMesh,
    mut elements: [Vertex; 2],
    route: Route,
) -> Result<Merged, MoveRefusal> {
    let (mut ops, mut store) = (Vec::new(), Vec::new());
    for step in 0..=REACH {
        if let Some(quad) = across(mesh, elements) {
            let op = Collapse { edge: QuadMesh::next(quad) };
            let element = Collapse::apply(mesh, op.check(mesh)?);
            if mesh.valence(element) != 6 {
                return Err(MoveRefusal::InTheWay);
            }
            ops.push(Op::Collapse(op));
            return Ok(Merged { element, ops });
        }
        let route = if step == 0 { route } else { route.still(mesh, &mut store) };
        let moved = pair::shift(mesh, elements, Direction::Closer, 1, route)?;
        elements = moved.pair;
        ops.extend(moved.ops);
    }
    Err(MoveRefusal::NoPath(elements[0], elements[1]))
}

/// The half-edge of the first one in a quad whose opposite corner is the second.
fn across(mesh: &QuadMesh, [a, b]: [Vertex; 2]) -> Option<HalfEdge> {
    mesh.outgoing(a).find(|&h| mesh.origin(QuadMesh::opposite(h)) == b)
}

/// Splits an element of index −2 into two of index −1: the reverse of [`merge`].
///
/// ```text
///    \ | /           \  /
///     v6       →   f5 ── f5   a vertex into an edge between two pentagons,
///    / | \           /  \     a hexagon into two quads with a v5 at each end of their edge
/// ```
/// Of the three ways, the one through the neighbour `through`, or the first that is legal. Refused
/// if the element has not six edges. E stays the same. Source: Peng & Wonka 2013, Proposition 3.5.
pub fn split_element(
    mesh: &mut QuadMesh,
    v: Vertex,
    through: Option<Vertex>,
) -> Result<([Vertex; 2], basic::Made), MoveRefusal> {
    if v >= mesh.vertex_ids() || !mesh.is_alive(v) {
        return Err(MoveRefusal::Gone(v));
    }
    if mesh.valence(v) != 6 || mesh.is_on_line(v) {
        return Err(MoveRefusal::NotIrregular(v));
    }
    let mut refused = MoveRefusal::NotJoined(v, through.unwrap_or(v));
    for first in mesh.outgoing(v).collect::<Vec<_>>() {
        if through.is_some_and(|neighbour| mesh.target(first) != neighbour) {
            continue;
        }
        let last = mesh.ccw(mesh.ccw(mesh.ccw(first)));
        let pair = [mesh.target(first), mesh.target(last)];
        let op = Split { first, last };
        match op.check(mesh) {
            Ok(legal) if legal.delta() == 0 => {
                let element = Split::apply(mesh, legal);
                return Ok((pair, basic::Made { op: Op::Split(op), element }));
            }
            Ok(_) => refused = MoveRefusal::InTheWay,
            Err(refusal) => refused = refusal.into(),
        }
    }
    Err(refused)
}
