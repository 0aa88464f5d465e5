//! Pair-wise movement: the only way to move a lone irregular element is together with another.
//!
//! ```text
//!  opposite index: both translate, in any of four directions
//!
//!    v3 · · · · v5              f3 · · · · f5
//!                       →
//!     ·   ·   ·   ·   ·          ·   ·   ·   ·   ·
//!
//!  equal index: closer, apart, and around their midpoint both ways
//!
//!    v5 · · · · v5      →         f5 · · f5              closer
//!
//!                                 f5 ·
//!    v5 · · · · v5      →              · · f5            rotated right
//! ```
//! One step moves each element by one edge of Q and so changes its type (v ↔ f); two steps keep
//! it. The elements of opposite index move by the same vector in the lattice of the path between
//! them. Of equal index, one moves by δ and the other by −iδ, as the path sees it, so that their
//! separation changes by −(1 + i)δ: the four diagonals are closer, apart and the two rotations.
//! Source: Peng & Wonka 2013, Proposition 3.4, Figures 4 and 7.

use super::element::Element;
use super::path::{Heading, Offset};
use super::walk::{Blocked, Walk, on_some_path};
use super::{MoveRefusal, Path, Route};
use crate::ops::Op;
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use serde::{Deserialize, Serialize};

/// Steps in which a dislocation that has come near is absorbed by an element of equal index.
const ABSORBING_STEPS: u32 = 4;
/// Paths of so many edges are short: their ends are in one another's way.
const SHORT: usize = 6;

/// How a pair moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Direction {
    /// Opposite index: as a dislocation climbs, from the v5 beyond the v3, to the left.
    ClimbLeft,
    /// Opposite index: the same to the right.
    ClimbRight,
    /// Opposite index: back from [`Self::ClimbLeft`].
    SinkLeft,
    /// Opposite index: back from [`Self::ClimbRight`].
    SinkRight,
    /// Equal index: towards one another.
    Closer,
    /// Equal index: away from one another.
    Apart,
    /// Equal index: counter-clockwise around their midpoint.
    RotateLeft,
    /// Equal index: clockwise around their midpoint.
    RotateRight,
}

impl Direction {
    /// The four directions of a pair of opposite index.
    pub const OPPOSITE: [Self; 4] =
        [Self::ClimbLeft, Self::ClimbRight, Self::SinkLeft, Self::SinkRight];
    /// The four directions of a pair of equal index.
    pub const EQUAL: [Self; 4] = [Self::Apart, Self::RotateLeft, Self::Closer, Self::RotateRight];

    /// The direction that takes a step back.
    #[must_use]
    pub const fn inverse(self) -> Self {
        match self {
            Self::ClimbLeft => Self::SinkLeft,
            Self::ClimbRight => Self::SinkRight,
            Self::SinkLeft => Self::ClimbLeft,
            Self::SinkRight => Self::ClimbRight,
            Self::Closer => Self::Apart,
            Self::Apart => Self::Closer,
            Self::RotateLeft => Self::RotateRight,
            Self::RotateRight => Self::RotateLeft,
        }
    }

    /// Where the near element goes in the lattice of a path with this separation.
    fn heading(self, separation: Offset, opposite: bool) -> Result<Heading, MoveRefusal> {
        let number = |among: [Self; 4]| among.iter().position(|&d| d == self);
        let place = if opposite {
            // The axis points from the v3 to the v5; climbing to the left is a quarter from it.
            number(Self::OPPOSITE).map(|n| separation.nearest_axis().turned(n as i32 + 1))
        } else {
            // Apart is the diagonal of the quadrant, (1 + i) times a heading, and δ its negative.
            number(Self::EQUAL).map(|n| separation.quadrant().turned(n as i32 + 2))
        };
        place.ok_or(MoveRefusal::Direction)
    }
}

/// A pair after its move.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Moved {
    /// Where the elements are, in the order in which they were given.
    pub pair: [Vertex; 2],
    /// The operations that were made.
    pub ops: Vec<Op>,
}

/// Moves two irregular elements by so many edges of Q, whole or not at all; E stays the same.
///
/// Refused if either is no element of index ±1, if the direction does not suit their signs, or if
/// there is no path along which nothing else changes. O(steps · path).
pub fn shift(
    mesh: &mut QuadMesh,
    pair: [Vertex; 2],
    direction: Direction,
    steps: u32,
    route: Route,
) -> Result<Moved, MoveRefusal> {
    let mark = mesh.mark();
    let mut done = Moved { pair, ops: Vec::new() };
    let mut store = Vec::new();
    for step in 0..steps {
        let route = if step == 0 { route } else { route.still(mesh, &mut store) };
        match once(mesh, done.pair, direction, route) {
            Ok(next) => {
                done.pair = next.pair;
                done.ops.extend(next.ops);
            }
            Err(refusal) => {
                mesh.undo_to(mark);
                return Err(refusal);
            }
        }
    }
    Ok(done)
}

/// Changes the type of both elements of a pair (v ↔ f) by one step in the first of the directions
/// that is legal.
///
/// ```text
///   v3 ─ ─ v5   →   f3 ─ ─ f5         v3 ─ ─ f5  (a T-junction)   →   f3 ─ ─ v5
/// ```
/// A type cannot change alone (Proposition 3.3). Source: Peng & Wonka 2013, Proposition 3.4.
pub fn change_type(
    mesh: &mut QuadMesh,
    pair: [Vertex; 2],
    route: Route,
) -> Result<Moved, MoveRefusal> {
    let opposite = signs_differ(mesh, pair)?;
    let mut first = None;
    for direction in if opposite { Direction::OPPOSITE } else { Direction::EQUAL } {
        match once(mesh, pair, direction, route) {
            Ok(moved) => return Ok(moved),
            Err(refusal) => first = first.or(Some(refusal)),
        }
    }
    Err(first.unwrap_or(MoveRefusal::Direction))
}

/// Where `pair[1]` lies, seen from `pair[0]`, on the shortest regular path between them.
pub fn separation(mesh: &QuadMesh, pair: [Vertex; 2], route: Route) -> Result<Offset, MoveRefusal> {
    Path::find(mesh, pair[0], pair[1], route, &[]).map(|path| path.separation())
}

fn signs_differ(mesh: &QuadMesh, pair: [Vertex; 2]) -> Result<bool, MoveRefusal> {
    let [a, b] = [Element::at(mesh, pair[0])?, Element::at(mesh, pair[1])?];
    if a == b {
        return Err(MoveRefusal::SameElement);
    }
    Ok(a.kind.index() != b.kind.index())
}

/// One step of a pair. The dislocation is emitted at the first element or else at the second:
/// where the path turns, the element that moves first can come to stand in its way.
fn once(
    mesh: &mut QuadMesh,
    pair: [Vertex; 2],
    direction: Direction,
    route: Route,
) -> Result<Moved, MoveRefusal> {
    let opposite = signs_differ(mesh, pair)?;
    let swapped = [pair[1], pair[0]];
    let mut store = Vec::new();
    let back = route.reversed(&mut store);
    from_first(mesh, pair, opposite, direction, route).or_else(|refusal| {
        let moved = from_first(mesh, swapped, opposite, direction, back).map_err(|_| refusal)?;
        Ok(Moved { pair: [moved.pair[1], moved.pair[0]], ops: moved.ops })
    })
}

/// One step of a pair that begins with its first element.
fn from_first(
    mesh: &mut QuadMesh,
    pair: [Vertex; 2],
    opposite: bool,
    direction: Direction,
    route: Route,
) -> Result<Moved, MoveRefusal> {
    let near = Element::at(mesh, pair[0])?;
    let mut make = |mesh: &mut QuadMesh, path: &Path| {
        // Directions of opposite elements are seen from the one with an edge too few. The lattice
        // is that to the left of this view, for either end: see `Walk::emit`.
        let backwards = opposite && near.kind.index() < 0;
        let separation = path.separation().turned(if backwards { 2 } else { 0 });
        let to = direction
            .heading(separation, opposite)
            .map_err(|refusal| Blocked { at: 0, refusal })?;
        along(mesh, near, opposite, path, to)
    };
    let detours = match mesh.find(pair[0], pair[1]) {
        // The dislocation needs room between two neighbours of equal index: around a quad.
        Some(edge) if !opposite => [edge, QuadMesh::next(mesh.twin(edge))].map(Some),
        _ => [None; 2],
    };
    let mut refused = MoveRefusal::InTheWay;
    for detour in detours {
        let stops = detour.map(|edge| around(mesh, edge, pair[0]));
        let route = stops.as_ref().map_or(route, |stops| Route::Through(stops));
        let find =
            |mesh: &QuadMesh, banned: &[Vertex]| Path::find(mesh, pair[0], pair[1], route, banned);
        match on_some_path(mesh, find, &mut make) {
            Ok(moved) => return Ok(moved),
            Err(refusal) => refused = refusal,
        }
        if detour.is_none() {
            break;
        }
    }
    Err(refused)
}

/// The two other corners of the quad of `edge`, the neighbour of `from` first.
fn around(mesh: &QuadMesh, edge: HalfEdge, from: Vertex) -> [Vertex; 2] {
    let corners = [edge, QuadMesh::next(edge), QuadMesh::opposite(edge), QuadMesh::prev(edge)]
        .map(|h| mesh.origin(h));
    if corners[0] == from { [corners[3], corners[2]] } else { [corners[2], corners[3]] }
}

/// Moves the near element, and carries the dislocation that this emits to the far one.
fn along(
    mesh: &mut QuadMesh,
    near: Element,
    opposite: bool,
    path: &Path,
    to: Heading,
) -> Result<Moved, Blocked> {
    let blocked = |refusal| Blocked { at: 0, refusal };
    let (mut walk, moved) = Walk::emit(mesh, near, path.half_edges()[0], to).map_err(blocked)?;
    let rest = &path.headings()[1..];
    let done = if opposite {
        walk.follow(mesh, rest)?;
        let pair = ends(mesh, &walk, moved, [near.kind.index(), -near.kind.index()]);
        pair.filter(|_| walk.delta == 0).map(|pair| Moved { pair, ops: walk.ops })
    } else {
        walk.follow(mesh, &rest[..rest.len().saturating_sub(1)])?;
        // What is left of a dislocation and a lone element has only one place to be, so the way
        // does not matter, as long as it does not come back to the near one.
        walk.end_near(mesh, ABSORBING_STEPS, &|mesh, walk| {
            let pair = ends(mesh, walk, moved, [near.kind.index(); 2])?;
            let long = path.headings().len() > SHORT;
            let good = long || is_as_predicted(mesh, pair, path, to);
            good.then(|| Moved { pair, ops: walk.ops.clone() })
        })
    };
    done.ok_or(blocked(MoveRefusal::InTheWay))
}

/// The elements after the move, if they have these indices, the near one first. One end of the
/// dislocation has cancelled with the far element, or is the far element now.
fn ends(mesh: &QuadMesh, walk: &Walk, moved: Vertex, indices: [i32; 2]) -> Option<[Vertex; 2]> {
    let sound = |v: Vertex, index: i32| {
        Element::at(mesh, v).is_ok_and(|element| element.kind.index() == index)
    };
    let far = walk.ends.into_iter().find(|&v| v != moved && sound(v, indices[1]))?;
    sound(moved, indices[0]).then_some([moved, far])
}

/// Whether the separation of a pair of equal index has changed by −(1 + i)δ: around elements that
/// are near to one another, a dislocation can come from the wrong side.
fn is_as_predicted(mesh: &QuadMesh, pair: [Vertex; 2], path: &Path, to: Heading) -> bool {
    let change = Offset::from(to.turned(2)) + to.turned(3).into();
    let predicted = path.separation() + change;
    separation(mesh, pair, Route::Found).is_ok_and(|s| s.canonical() == predicted.canonical())
}
