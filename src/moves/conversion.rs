//! Conversion of a single element, and generation of pairs out of nothing.
//!
//! An emission that is left where it is: the element has the other type now, and the dislocation
//! beside it pays for that.
//!
//! ```text
//!  f5   →   v5 + (f3–v5)          f3   →   v3 + (v3–f5)          and the same with v and f
//! ```
//! Source: Peng & Wonka 2013, section 3.4, Figure 8.

use super::basic::of_type;
use super::element::Element;
use super::path::Heading;
use super::walk::Walk;
use super::{Dipole, MoveRefusal};
use crate::mesh::NONE;
use crate::ops::{Flip, Op, Split, Turn};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use serde::{Deserialize, Serialize};

/// A converted element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Converted {
    /// Where the element of the other type is.
    pub element: Vertex,
    /// The pair that came into being with it.
    pub pair: Dipole,
    /// The operation that was made.
    pub op: Op,
}

/// Converts one element to the other type and leaves an adjacent pair beside it, towards the
/// neighbour `towards` or else the first one that allows it; E grows by 2.
///
/// ```text
///   ┌───┬───┐        ┌───┬───┐
///   │   f5  │    →   │   │   │    f5 → v5, f3, v5
///   └─┬───┬─┘        └─┬─v5──┘
/// ```
/// Refused if the element is not of index ±1, is held, or has irregular neighbours everywhere.
/// Inverse: triple cancellation ([`super::cancel::triple`]).
/// Source: Peng & Wonka 2013, section 3.4, Figure 8.
pub fn convert(
    mesh: &mut QuadMesh,
    v: Vertex,
    towards: Option<Vertex>,
) -> Result<Converted, MoveRefusal> {
    let element = Element::at(mesh, v)?;
    let mark = mesh.mark();
    let mut first = None;
    let edges: Vec<HalfEdge> = mesh
        .outgoing(v)
        .filter(|&h| towards.is_none_or(|neighbour| mesh.target(h) == neighbour))
        .collect();
    for edge in edges {
        for quarters in [1, 2, 3, 0] {
            let refusal = match emitted(mesh, element, edge, Heading::new(quarters)) {
                Ok(converted) => return Ok(converted),
                Err(refusal) => refusal,
            };
            mesh.undo_to(mark);
            first = first.or(Some(refusal));
        }
    }
    Err(first.unwrap_or(MoveRefusal::NotJoined(v, towards.unwrap_or(NONE))))
}

fn emitted(
    mesh: &mut QuadMesh,
    element: Element,
    edge: HalfEdge,
    to: Heading,
) -> Result<Converted, MoveRefusal> {
    let neighbour = mesh.target(edge);
    if mesh.irregularity(neighbour) != 0 || mesh.is_ghost(neighbour) {
        return Err(MoveRefusal::InTheWay);
    }
    let (walk, moved) = Walk::emit(mesh, element, edge, to)?;
    // Elements of their own, not one of index −2.
    let after = Element::at(mesh, moved).map_err(|_| MoveRefusal::InTheWay)?;
    let pair = walk.dipole(mesh).filter(|_| walk.delta == 2).ok_or(MoveRefusal::InTheWay)?;
    match walk.ops[..] {
        [op] if after.kind == element.kind.other_type() => {
            Ok(Converted { element: moved, pair, op })
        }
        _ => Err(MoveRefusal::InTheWay),
    }
}

/// What kind of pairs to make.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Generate {
    /// One edge is shifted: a T-junction (v3–f5) and a dual one (f3–v5).
    Mixed,
    /// A vertex is split: two T-junctions.
    TJunctions,
    /// An edge is inserted: two dual T-junctions (f3–v5).
    Duals,
}

/// Generates two adjacent pairs of opposite Burgers vector in regular surroundings, at `v` (a
/// vertex, or for duals a face); E grows by 4.
///
/// ```text
///    regular    →    v3–f5   f3–v5      or two of either
/// ```
/// Refused where the surroundings are not regular. Inverse: quadruple cancellation
/// ([`super::cancel::quadruple`]). Source: Peng & Wonka 2013, section 3.4.
pub fn generate_pairs(
    mesh: &mut QuadMesh,
    v: Vertex,
    what: Generate,
) -> Result<([Dipole; 2], Op), MoveRefusal> {
    of_type(mesh, v, what == Generate::Duals)?;
    let mut first = None;
    for h in mesh.outgoing(v).collect::<Vec<_>>() {
        let op = match what {
            Generate::Mixed => Op::Flip(Flip { edge: h, turn: Turn::Ccw }),
            _ => Op::Split(Split { first: h, last: mesh.ccw(mesh.ccw(h)) }),
        };
        match generated(mesh, op) {
            Ok(pairs) => return Ok((pairs, op)),
            Err(refusal) => first = first.or(Some(refusal)),
        }
    }
    Err(first.unwrap_or(MoveRefusal::Gone(v)))
}

/// Makes the operation if it leaves two dislocations that share no element.
fn generated(mesh: &mut QuadMesh, op: Op) -> Result<[Dipole; 2], MoveRefusal> {
    let legal = op.check(mesh)?;
    if legal.delta() != 4 {
        return Err(MoveRefusal::InTheWay);
    }
    let mark = mesh.mark();
    Op::apply(mesh, legal);
    let touched = mesh.touched_since(mark);
    let standing: Vec<Dipole> = touched
        .iter()
        .filter(|&&v| mesh.is_alive(v) && !mesh.is_ghost(v))
        .flat_map(|&v| mesh.outgoing(v).map(Dipole).collect::<Vec<_>>())
        .filter(|d| d.stands(mesh))
        .collect();
    let ends = |d: Dipole| [mesh.origin(d.0), mesh.target(d.0)];
    let apart = |a: Dipole, b: Dipole| ends(a).iter().all(|v| !ends(b).contains(v));
    let found = standing
        .iter()
        .enumerate()
        .find_map(|(i, &a)| standing[i + 1..].iter().find(|&&b| apart(a, b)).map(|&b| [a, b]));
    if found.is_none() {
        mesh.undo_to(mark);
    }
    found.ok_or(MoveRefusal::InTheWay)
}
