//! The five basic operations in the words of the polygon mesh. Each is one operation on Q with a
//! colour; elements are named by their numbers in Q.
//!
//! Source: Peng & Wonka 2013, section 3.2, Figure 3.

use super::MoveRefusal;
use crate::ops::{Collapse, Flip, Op, Split, Turn};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};

/// A basic operation that was made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Made {
    /// The operation on Q.
    pub op: Op,
    /// The new vertex or face of a split or insertion; the one that is left of a collapse or
    /// deletion; the end that a shifted edge has now.
    pub element: Vertex,
}

/// Vertex split: opens `v` into an edge between the faces `from` and `to` around it. The new
/// vertex takes the faces from `from` counter-clockwise to `to`.
///
/// ```text
///      to                 to
///    \  |  /            \     /
///     \ | /              \   /
///   ────v────    →     ───v─w───
///     / | \              /   \
///    /  |  \            /     \
///     from               from
/// ```
/// The two faces gain an edge each. Inverse: [`edge_collapse`]. Refused if either vertex would
/// have fewer than three edges, or if an edge on a boundary or feature would move.
/// Source: Peng & Wonka 2013, section 3.2, Figure 3.
pub fn vertex_split(
    mesh: &mut QuadMesh,
    v: Vertex,
    [from, to]: [Vertex; 2],
) -> Result<Made, MoveRefusal> {
    of_type(mesh, v, false)?;
    split(mesh, v, [from, to])
}

/// Edge insertion: cuts `face` in two by an edge between its vertices `from` and `to`. The new
/// face has the vertices from `from` counter-clockwise to `to`.
///
/// ```text
///   ┌───┬───┐          ┌───to──┐
///   │       │     →    │   │new│
///   └───┴───┘          └──from─┘
/// ```
/// The two vertices gain an edge each. Inverse: [`edge_deletion`]. Refused if either face would
/// have fewer than three corners, or if the edge is there already.
/// Source: Peng & Wonka 2013, section 3.2, Figure 3.
pub fn edge_insertion(
    mesh: &mut QuadMesh,
    face: Vertex,
    [from, to]: [Vertex; 2],
) -> Result<Made, MoveRefusal> {
    of_type(mesh, face, true)?;
    split(mesh, face, [from, to])
}

fn split(mesh: &mut QuadMesh, v: Vertex, [from, to]: [Vertex; 2]) -> Result<Made, MoveRefusal> {
    let [first, last] = [corner(mesh, v, from)?, corner(mesh, v, to)?];
    let op = Split { first, last };
    let element = Split::apply(mesh, op.check(mesh)?);
    Ok(Made { op: Op::Split(op), element })
}

/// Edge collapse: the vertices `a` and `b` of an edge become one.
///
/// ```text
///    \       /            \ /
///     a─────b      →       a
///    /       \            / \
/// ```
/// The faces on both sides lose an edge each; a held vertex stays where it is. Inverse:
/// [`vertex_split`]. Refused on boundaries and features, and if it would make a triangle an edge
/// or join two vertices twice. Source: Peng & Wonka 2013, section 3.2, Figure 3.
pub fn edge_collapse(mesh: &mut QuadMesh, [a, b]: [Vertex; 2]) -> Result<Made, MoveRefusal> {
    let edge = edge_between(mesh, a, b)?;
    collapse(mesh, edge)
}

/// Edge deletion: the faces on both sides of the edge `a`–`b` become one.
///
/// ```text
///   ┌───a───┐          ┌───a───┐
///   │   │   │     →    │       │
///   └───b───┘          └───b───┘
/// ```
/// The two vertices lose an edge each. Inverse: [`edge_insertion`]. Refused on boundaries and
/// features, and where a vertex has only three edges.
/// Source: Peng & Wonka 2013, section 3.2, Figure 3.
pub fn edge_deletion(mesh: &mut QuadMesh, [a, b]: [Vertex; 2]) -> Result<Made, MoveRefusal> {
    let edge = edge_between(mesh, a, b)?;
    collapse(mesh, QuadMesh::next(edge))
}

fn collapse(mesh: &mut QuadMesh, edge: HalfEdge) -> Result<Made, MoveRefusal> {
    let op = Collapse { edge };
    let element = Collapse::apply(mesh, op.check(mesh)?);
    Ok(Made { op: Op::Collapse(op), element })
}

/// Edge shift: the edge from `fixed` to `from` ends at `to` instead, the next vertex of one of its
/// faces.
///
/// ```text
///  fixed────┐            fixed────┐
///   │       │              │ \    │
///   │       │      →       │   \  │
///  from────to            from────to
/// ```
/// `from` loses an edge and `to` gains one; so do the faces, the other way round. Inverse: a shift
/// back. Refused if the edge lies on a boundary or feature.
/// Source: Peng & Wonka 2013, section 3.2, Figure 3.
pub fn edge_shift(
    mesh: &mut QuadMesh,
    fixed: Vertex,
    [from, to]: [Vertex; 2],
) -> Result<Made, MoveRefusal> {
    let edge = edge_between(mesh, from, fixed)?;
    // The faces of the edge lie at both ends of the half-edges of `from` in its quad; the edge to
    // `to` is beside it across one of them, and that one is the edge of Q that turns.
    let (ahead, behind) = (edge, mesh.ccw(edge));
    let across = |h: HalfEdge| mesh.origin(QuadMesh::opposite(h));
    let flip = if across(mesh.cw(edge)) == to {
        Flip { edge: ahead, turn: Turn::Cw }
    } else if across(behind) == to {
        Flip { edge: behind, turn: Turn::Ccw }
    } else {
        return Err(MoveRefusal::NotJoined(from, to));
    };
    Flip::apply(mesh, flip.check(mesh)?);
    Ok(Made { op: Op::Flip(flip), element: to })
}

/// The half-edge out of `a` in the quad of the edge `a`–`b` of the polygon mesh.
pub fn edge_between(mesh: &QuadMesh, a: Vertex, b: Vertex) -> Result<HalfEdge, MoveRefusal> {
    of_type(mesh, a, false)?;
    of_type(mesh, b, false)?;
    let found = mesh.outgoing(a).find(|&h| mesh.origin(QuadMesh::opposite(h)) == b);
    found.ok_or(MoveRefusal::NotJoined(a, b))
}

/// The half-edge from a vertex to one of its faces, or from a face to one of its vertices.
fn corner(mesh: &QuadMesh, v: Vertex, other: Vertex) -> Result<HalfEdge, MoveRefusal> {
    mesh.find(v, other).ok_or(MoveRefusal::NotJoined(v, other))
}

/// Refuses what does not exist, and what is no face or else no vertex.
pub(super) fn of_type(mesh: &QuadMesh, v: Vertex, face: bool) -> Result<(), MoveRefusal> {
    if v >= mesh.vertex_ids() || !mesh.is_alive(v) || mesh.is_ghost(v) {
        return Err(MoveRefusal::Gone(v));
    }
    match (mesh.is_face(v), face) {
        (true, false) => Err(MoveRefusal::NotAVertex(v)),
        (false, true) => Err(MoveRefusal::NotAFace(v)),
        _ => Ok(()),
    }
}
