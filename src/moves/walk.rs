//! Walking a dislocation along a path: emitted at one element, absorbed at another.
//!
//! In the lattice of a path the four climbing and sinking steps are the four directions: a quarter
//! turn counter-clockwise leads from CL (climb left) to CR, on to SL (sink left) and to SR. That
//! holds on both sides of the dislocation, so one heading, that of CL, says it all.
//!
//! ```text
//!    edges of the v3            edges of the v5
//!      CL     CR              CL   t   CR     t leads to the v3; the others
//!        \   /                  \  |  /       are the four directions
//!         v3                     v5
//!         |                     /  \
//!         v5                  SR    SL
//! ```
//! An operation changes valences by the same amounts wherever it is made, so a step between any
//! two neighbours moves an edge too few and one too many whether they are there or not. Made
//! between an element and a regular neighbour it moves the element by one edge and leaves a
//! dislocation behind (the emission); carried along the path, this one does the same to the other
//! end. Source: Peng & Wonka 2013, Propositions 3.4 to 3.7.

use super::dipole::{Dipole, Step};
use super::element::Element;
use super::path::{Heading, quarters};
use super::{MoveRefusal, Path};
use crate::ops::Op;
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};

/// The steps by their heading, counter-clockwise.
const ROUND: [Step; 4] = [Step::ClimbLeft, Step::ClimbRight, Step::SinkLeft, Step::SinkRight];

/// Where the steps of a dislocation lead in the lattice of a path: the heading of CL.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Compass(Heading);

impl Compass {
    /// The step that leads there.
    pub(super) fn step(self, to: Heading) -> Step {
        ROUND[to.from(self.0)]
    }

    /// Quarters counter-clockwise from the steps of `other` to these.
    pub(super) fn turned_from(self, other: Self) -> usize {
        self.0.from(other.0)
    }

    /// The compass of a dislocation at one end of which `edge` begins and points to `heading`;
    /// none if the edge is that of the dislocation itself, or leads between its directions.
    pub(super) fn at(
        mesh: &QuadMesh,
        dipole: Dipole,
        edge: HalfEdge,
        heading: Heading,
    ) -> Option<Self> {
        let (h, t) = (dipole.0, mesh.twin(dipole.0));
        let count = mesh.valence(mesh.origin(edge)) as i32;
        let direction = if mesh.origin(edge) == mesh.origin(h) {
            match quarters(mesh, h, edge) {
                1 => 0,
                turn if turn + 1 == count => 1,
                _ => return None,
            }
        } else {
            match quarters(mesh, t, edge) {
                1 => 1,
                2 => 2,
                turn if turn + 2 == count => 3,
                turn if turn + 1 == count => 0,
                _ => return None,
            }
        };
        Some(Self(heading.turned(-direction)))
    }
}

/// A dislocation on its way, and what was done so far.
#[derive(Debug, Clone)]
pub(super) struct Walk {
    /// The operations so far.
    pub(super) ops: Vec<Op>,
    /// The change of E so far.
    pub(super) delta: i32,
    /// Where its edge too few is, and the one too many.
    pub(super) ends: [Vertex; 2],
    compass: Compass,
}

impl Walk {
    /// The walk of a dislocation that stands.
    pub(super) fn of(mesh: &QuadMesh, dipole: Dipole, compass: Compass) -> Self {
        let ends = [mesh.origin(dipole.0), mesh.target(dipole.0)];
        Self { ops: Vec::new(), delta: 0, ends, compass }
    }

    /// Moves `element` by one edge towards `to`, seen from its half-edge `edge` (heading 0), and
    /// leaves a dislocation beside it that can go on along `edge`; where the element is then.
    pub(super) fn emit(
        mesh: &mut QuadMesh,
        element: Element,
        edge: HalfEdge,
        to: Heading,
    ) -> Result<(Self, Vertex), MoveRefusal> {
        let too_few = element.kind.index() > 0;
        let neighbour = mesh.target(edge);
        // The edge as a dislocation, and its ClimbLeft in the lattice that begins with the edge:
        // to the left of it, which for an element with an edge too many is the other side.
        let (pair, compass) = if too_few {
            (Dipole(edge), Compass(Heading::new(1)))
        } else {
            (Dipole(mesh.twin(edge)), Compass(Heading::new(3)))
        };
        let done = pair.carry(mesh, compass.step(to))?;
        let [x, y] = done.ends;
        let (moved, ends, compass) = if too_few {
            (x, [neighbour, y], Compass(to.turned(2)))
        } else {
            // Where the neighbour was merged with another vertex, its edge too many is there.
            (y, [x, if mesh.is_alive(neighbour) { neighbour } else { y }], Compass(to))
        };
        Ok((Self { ops: vec![done.op], delta: done.delta, ends, compass }, moved))
    }

    /// The dislocation, if it still stands.
    pub(super) fn dipole(&self, mesh: &QuadMesh) -> Option<Dipole> {
        Dipole::between(mesh, self.ends)
    }

    /// Goes on by one edge.
    fn go(&mut self, mesh: &mut QuadMesh, to: Heading) -> Result<(), MoveRefusal> {
        let dipole = self.dipole(mesh).ok_or(MoveRefusal::InTheWay)?;
        let done = dipole.carry(mesh, self.compass.step(to))?;
        self.ops.push(done.op);
        self.delta += done.delta;
        self.ends = done.ends;
        Ok(())
    }

    /// Goes on in these directions; on refusal, says at which of them. The mesh may then be
    /// changed and must be undone.
    pub(super) fn follow(
        &mut self,
        mesh: &mut QuadMesh,
        headings: &[Heading],
    ) -> Result<(), Blocked> {
        headings.iter().enumerate().try_for_each(|(at, &heading)| {
            self.go(mesh, heading).map_err(|refusal| Blocked { at, refusal })
        })
    }
}

impl Walk {
    /// Goes the fewest steps, at most so many, after which E is what it was before the walk and
    /// `accept` likes what it sees; what that gives. O(4^steps).
    pub(super) fn end_near<T>(
        &self,
        mesh: &mut QuadMesh,
        steps: u32,
        accept: &dyn Fn(&QuadMesh, &Self) -> Option<T>,
    ) -> Option<T> {
        (0..=steps).find_map(|depth| self.ended(mesh, depth, accept))
    }

    fn ended<T>(
        &self,
        mesh: &mut QuadMesh,
        depth: u32,
        accept: &dyn Fn(&QuadMesh, &Self) -> Option<T>,
    ) -> Option<T> {
        if depth == 0 {
            return if self.delta == 0 { accept(mesh, self) } else { None };
        }
        let mark = mesh.mark();
        (0..4).find_map(|quarters| {
            let mut next = self.clone();
            let gone = next.go(mesh, Heading::new(quarters)).ok();
            let end = gone.and_then(|()| next.ended(mesh, depth - 1, accept));
            if end.is_none() {
                mesh.undo_to(mark);
            }
            end
        })
    }
}

/// A walk that could not go on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Blocked {
    /// Which direction was refused.
    pub(super) at: usize,
    /// Why.
    pub(super) refusal: MoveRefusal,
}

/// Paths that are tried before a move is refused.
const TRIES: usize = 24;

/// Tries a move on one path after the other, avoiding the places where earlier ones were blocked,
/// until one is legal. `find` looks for a path without the banned elements; `make` makes the move,
/// and what it did is undone if it is refused.
pub(super) fn on_some_path<T>(
    mesh: &mut QuadMesh,
    find: impl Fn(&QuadMesh, &[Vertex]) -> Result<Path, MoveRefusal>,
    mut make: impl FnMut(&mut QuadMesh, &Path) -> Result<T, Blocked>,
) -> Result<T, MoveRefusal> {
    let mark = mesh.mark();
    let mut banned = Vec::new();
    let mut first = None;
    for _ in 0..TRIES {
        let path = find(mesh, &banned).map_err(|none| first.unwrap_or(none))?;
        let blocked = match make(mesh, &path) {
            Ok(done) => return Ok(done),
            Err(blocked) => blocked,
        };
        mesh.undo_to(mark);
        let refusal = *first.get_or_insert(blocked.refusal);
        // Between the ends only: one edge is one edge.
        let Some(inner) = path.half_edges().len().checked_sub(2) else { return Err(refusal) };
        let place = mesh.target(path.half_edges()[blocked.at.min(inner)]);
        if banned.contains(&place) {
            return Err(refusal);
        }
        banned.push(place);
    }
    Err(first.unwrap_or(MoveRefusal::InTheWay))
}
