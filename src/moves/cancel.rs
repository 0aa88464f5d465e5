//! Cancellation: a dislocation walks into another one, or into a lone element.
//!
//! ```text
//!  Figure 6: two T-junctions and the turn between their stems
//!
//!     │     │            │                 │
//!   ──┴── ──┬──        ──┴── ├──         ──┴── ──┴──
//!           │
//!   half a turn:       a quarter, either way:     none:
//!   both vanish        v3 and v5 (or f3 and f5)   v3 and v5 two edges of Q
//!                      across a quad of Q remain  apart remain
//! ```
//! The Burgers vectors of two dislocations, carried along the path between them, add up. If they
//! are opposite nothing is left; if not, one pair is, and since each of the two contributes one
//! edge of Q to its separation, both its elements have the same type. In other words: a disk with
//! four corners around the two can be regular exactly if opposite sides are equally long.
//! Source: Peng & Wonka 2013, Proposition 3.7, Figure 6.

use super::element::{Element, Kind};
use super::path::Offset;
use super::walk::{Blocked, Compass, Walk, on_some_path};
use super::{Dipole, MoveRefusal, Path, Route};
use crate::ops::Op;
use crate::sqrtcc::{QuadMesh, Vertex};
use serde::{Deserialize, Serialize};

/// What is left of two dislocations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// Nothing: all four elements vanish.
    Complete,
    /// A pair of one type whose elements lie across a quad of Q from one another: the stems of
    /// the T-junctions are at right angles.
    Diagonal,
    /// A pair of one type, two edges of Q apart: the stems of the T-junctions are parallel.
    Straight,
}

/// Which pair may be left where one must be.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum Remainder {
    /// Either, whichever is nearer.
    #[default]
    Any,
    /// v3 and v5.
    Vertices,
    /// f3 and f5.
    Faces,
}

/// A cancellation that was made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cancelled {
    /// What was predicted, and came true.
    pub outcome: Outcome,
    /// The pair that is left: the element with an edge too few, and the one with an edge too many.
    pub left: Option<[Vertex; 2]>,
    /// The operations that were made.
    pub ops: Vec<Op>,
}

/// Which end of a dislocation goes ahead, and meets the other end of another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ahead {
    /// The edge too few, to meet one too many.
    Three,
    /// The edge too many, to meet one too few.
    Five,
}

impl Ahead {
    fn of(self, mesh: &QuadMesh, dipole: Dipole) -> Vertex {
        match self {
            Self::Three => mesh.origin(dipole.0),
            Self::Five => mesh.target(dipole.0),
        }
    }

    const fn other(self) -> Self {
        match self {
            Self::Three => Self::Five,
            Self::Five => Self::Three,
        }
    }
}

/// What will be left of two dislocations if they meet along `route`. Touches nothing.
///
/// The condition of Proposition 3.7: complete if their Burgers vectors, carried along the path, are
/// opposite. Refused if either does not stand or no regular path joins them. O(path).
pub fn predict(mesh: &QuadMesh, pair: [Dipole; 2], route: Route) -> Result<Outcome, MoveRefusal> {
    standing(mesh, pair)?;
    let [from, to] = [Ahead::Three.of(mesh, pair[0]), Ahead::Five.of(mesh, pair[1])];
    let path = Path::find(mesh, from, to, route, &[])?;
    outcome(mesh, pair, &path).ok_or(MoveRefusal::InTheWay)
}

/// Refuses what does not stand, and two that share an element.
fn standing(mesh: &QuadMesh, pair: [Dipole; 2]) -> Result<(), MoveRefusal> {
    for dipole in pair {
        stands(mesh, dipole)?;
    }
    let [a, b] = pair.map(|d| [mesh.origin(d.0), mesh.target(d.0)]);
    if a.iter().any(|v| b.contains(v)) {
        return Err(MoveRefusal::SameElement);
    }
    Ok(())
}

fn stands(mesh: &QuadMesh, dipole: Dipole) -> Result<(), MoveRefusal> {
    let quad = QuadMesh::quad(dipole.0);
    let known = quad < mesh.quad_ids() && mesh.is_quad_alive(quad);
    if !known || !dipole.stands(mesh) {
        return Err(MoveRefusal::NotADislocation);
    }
    let held = [mesh.origin(dipole.0), mesh.target(dipole.0)];
    held.into_iter().find(|&v| mesh.is_on_line(v)).map_or(Ok(()), |v| Err(MoveRefusal::Held(v)))
}

/// The outcome of two dislocations at the ends of a path.
fn outcome(mesh: &QuadMesh, [one, other]: [Dipole; 2], path: &Path) -> Option<Outcome> {
    let (first, last) = (*path.half_edges().first()?, *path.half_edges().last()?);
    let start = Compass::at(mesh, one, first, path.headings()[0])?;
    let arriving = path.headings().last()?.turned(2);
    let end = Compass::at(mesh, other, mesh.twin(last), arriving)?;
    Some(match end.turned_from(start) {
        2 => Outcome::Complete,
        0 => Outcome::Straight,
        _ => Outcome::Diagonal,
    })
}

/// Cancels two T-junctions, or any two dislocations: one walks along the path until it meets the
/// other.
///
/// ```text
///   ──┴──  ──┬──     →    ─────────     complete, E falls by 4
///   ──┴──  ──┴──     →    v3 ─ ─ v5     one pair of one type is left, E falls by 2
/// ```
/// What will be left is known before anything is touched: for the shortest path or the one that is
/// given by [`predict`], and for others, where that one is blocked, in the same way. Refused if there is no
/// path on which the move is legal and nothing else changes, or if the pair that is wanted does
/// not come out on any. Source: Peng & Wonka 2013, Proposition 3.7, Figure 6.
pub fn quadruple(
    mesh: &mut QuadMesh,
    pair: [Dipole; 2],
    left: Remainder,
    route: Route,
) -> Result<Cancelled, MoveRefusal> {
    standing(mesh, pair)?;
    let refusal = match directly(mesh, pair, left, route) {
        Err(refusal) if left != Remainder::Any => refusal,
        done => return done,
    };
    // The other pair, turned into the wanted one.
    let mark = mesh.mark();
    let turned = directly(mesh, pair, Remainder::Any, route).and_then(|mut done| {
        let moved = super::pair::change_type(mesh, done.left.ok_or(refusal)?, Route::Found)?;
        done.left = Some(moved.pair);
        done.ops.extend(moved.ops);
        Ok(done)
    });
    turned.map_err(|_| {
        mesh.undo_to(mark);
        refusal
    })
}

/// Either walks to the other, with either end ahead.
fn directly(
    mesh: &mut QuadMesh,
    pair: [Dipole; 2],
    left: Remainder,
    route: Route,
) -> Result<Cancelled, MoveRefusal> {
    let mut store = Vec::new();
    let back = route.reversed(&mut store);
    let mut refused = None;
    for (walker, target, route) in [(pair[0], pair[1], route), (pair[1], pair[0], back)] {
        for ahead in [Ahead::Three, Ahead::Five] {
            match meeting(mesh, [walker, target], ahead, left, route) {
                Ok(done) => return Ok(done),
                Err(refusal) => refused = refused.or(Some(refusal)),
            }
        }
    }
    Err(refused.unwrap_or(MoveRefusal::NoCancellation))
}

/// The first dislocation walks to the second, with one end ahead.
fn meeting(
    mesh: &mut QuadMesh,
    pair: [Dipole; 2],
    ahead: Ahead,
    left: Remainder,
    route: Route,
) -> Result<Cancelled, MoveRefusal> {
    let (from, to) = (ahead.of(mesh, pair[0]), ahead.other().of(mesh, pair[1]));
    let rest = ahead.of(mesh, pair[1]);
    let suits = match left {
        Remainder::Any => true,
        // The element that stays where it is tells the type of both.
        Remainder::Vertices => !mesh.is_face(rest),
        Remainder::Faces => mesh.is_face(rest),
    };
    on_some_path(
        mesh,
        |mesh, banned| Path::find(mesh, from, to, route, banned),
        |mesh, path| {
            let blocked = |refusal| Blocked { at: 0, refusal };
            let outcome = outcome(mesh, pair, path).ok_or(blocked(MoveRefusal::InTheWay))?;
            if outcome != Outcome::Complete && !suits {
                return Err(blocked(MoveRefusal::NoCancellation));
            }
            let walk = along(mesh, pair[0], path)?;
            if walk.delta != if outcome == Outcome::Complete { -4 } else { -2 } {
                return Err(blocked(MoveRefusal::InTheWay));
            }
            let left = match (outcome, ahead) {
                (Outcome::Complete, _) => None,
                (_, Ahead::Three) => Some([rest, walk.ends[1]]),
                (_, Ahead::Five) => Some([walk.ends[0], rest]),
            };
            let lone = |v: &Vertex| Element::at(mesh, *v).is_ok();
            if !left.iter().flatten().all(lone) {
                return Err(blocked(MoveRefusal::InTheWay));
            }
            Ok(Cancelled { outcome, left, ops: walk.ops })
        },
    )
}

/// Walks a dislocation along a path that begins at one of its ends.
fn along(mesh: &mut QuadMesh, dipole: Dipole, path: &Path) -> Result<Walk, Blocked> {
    let first = path.half_edges().first().copied();
    let compass = first.and_then(|h| Compass::at(mesh, dipole, h, path.headings()[0]));
    let compass = compass.ok_or(Blocked { at: 0, refusal: MoveRefusal::InTheWay })?;
    let mut walk = Walk::of(mesh, dipole, compass);
    walk.follow(mesh, path.headings())?;
    Ok(walk)
}

/// A lone element that has swallowed a dislocation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Absorbed {
    /// The element that is left of the three.
    pub left: Element,
    /// The operations that were made.
    pub ops: Vec<Op>,
}

/// The kind of element that [`triple`] will leave. Touches nothing.
///
/// It has the index of the lone one and the type of the end of the dislocation that stays behind
/// on the way: an even number of steps keeps it, an odd one changes it.
pub fn predict_triple(
    mesh: &QuadMesh,
    dipole: Dipole,
    lone: Vertex,
    route: Route,
) -> Result<Kind, MoveRefusal> {
    stands(mesh, dipole)?;
    let element = Element::at(mesh, lone)?;
    let ahead = towards(element);
    let path = Path::find(mesh, ahead.of(mesh, dipole), lone, route, &[])?;
    let behind = mesh.is_face(ahead.other().of(mesh, dipole));
    let is_face = behind != (path.headings().len() % 2 == 1);
    Ok(if is_face == element.kind.is_face() { element.kind } else { element.kind.other_type() })
}

/// The end of a dislocation that cancels with the element.
fn towards(element: Element) -> Ahead {
    if element.kind.index() > 0 { Ahead::Five } else { Ahead::Three }
}

/// Triple cancellation: a dislocation walks into a lone element, and one element is left of three.
///
/// ```text
///   v3–f5 ─ ─ ─ v3    →    v3     E falls by 2; where it is follows from the Burgers vector
/// ```
/// Refused if there is no path on which the move is legal and nothing else changes. Inverse:
/// [`super::conversion::convert`]. Source: Peng & Wonka 2013, section 3.4.
pub fn triple(
    mesh: &mut QuadMesh,
    dipole: Dipole,
    lone: Vertex,
    route: Route,
) -> Result<Absorbed, MoveRefusal> {
    stands(mesh, dipole)?;
    let element = Element::at(mesh, lone)?;
    let ahead = towards(element);
    let from = ahead.of(mesh, dipole);
    if [mesh.origin(dipole.0), mesh.target(dipole.0)].contains(&lone) {
        return Err(MoveRefusal::SameElement);
    }
    on_some_path(
        mesh,
        |mesh, banned| Path::find(mesh, from, lone, route, banned),
        |mesh, path| {
            let blocked = Blocked { at: 0, refusal: MoveRefusal::InTheWay };
            let walk = along(mesh, dipole, path)?;
            let end = walk.ends[usize::from(ahead == Ahead::Three)];
            let left = Element::at(mesh, end).ok().filter(|_| walk.delta == -2);
            Ok(Absorbed { left: left.ok_or(blocked)?, ops: walk.ops })
        },
    )
}

/// The offset between the elements of a pair that is left, up to a rotation.
#[must_use]
pub fn separation_left(outcome: Outcome) -> Offset {
    match outcome {
        Outcome::Complete => Offset { x: 0, y: 0 },
        Outcome::Diagonal => Offset { x: 1, y: 1 },
        Outcome::Straight => Offset { x: 2, y: 0 },
    }
}
