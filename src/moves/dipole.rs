//! The dislocation: an adjacent v3–v5 pair of Q, and the six steps by which it moves.
//!
//! The pair *is* a half-edge x → y from the vertex with one edge too few to the one with one too
//! many. If x is a p-vertex it is a T-junction (v3–f5), otherwise a dual T-junction (f3–v5).
//!
//! ```text
//!        u               ClimbLeft    COLLAPSE(h)          (u+g)/2   swaps type
//!   CR   |   CL          ClimbRight   COLLAPSE(next t)     (u−g)/2   swaps type
//!     \  |  /            SinkLeft     SPLIT(t, ccw² t)    −(u+g)/2   swaps type
//! GL --- x-y --- GR      SinkRight    SPLIT(cw² t, t)     −(u−g)/2   swaps type
//!     /  |  \            GlideLeft    FLIP(ccw t, ccw)    −g         keeps type
//!   SL   |   SR          GlideRight   FLIP(cw t, cw)      +g         keeps type
//!       −u
//! ```
//! t is the twin of h. Each step is one operation with ΔE = 0 in regular surroundings; climbing
//! and sinking to the same side, and gliding left and right, are inverse to one another.
//! Source: Peng & Wonka 2013, section 3.4 (Propositions 3.4 and 3.6), in steps of one operation.

use super::Displacement;
use crate::ops::{Collapse, Flip, Op, Refusal, Split, Turn};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use serde::{Deserialize, Serialize};

/// A place where a dislocation stands: the half-edge from its v3 to its v5.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Dipole(pub HalfEdge);

/// One step of a dislocation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Step {
    /// Removes a quad, (u+g)/2.
    ClimbLeft,
    /// Removes a quad, (u−g)/2.
    ClimbRight,
    /// Adds a quad, −(u+g)/2.
    SinkLeft,
    /// Adds a quad, −(u−g)/2.
    SinkRight,
    /// Turns an edge, −g.
    GlideLeft,
    /// Turns an edge, +g.
    GlideRight,
}

/// All steps, in the order in which ties are broken.
pub const STEPS: [Step; 6] = [
    Step::GlideLeft,
    Step::GlideRight,
    Step::ClimbLeft,
    Step::ClimbRight,
    Step::SinkLeft,
    Step::SinkRight,
];

impl Step {
    /// How far the step moves the dislocation.
    #[must_use]
    pub const fn displacement(self) -> Displacement {
        match self {
            Self::ClimbLeft => Displacement::new(1, 1),
            Self::ClimbRight => Displacement::new(1, -1),
            Self::SinkLeft => Displacement::new(-1, -1),
            Self::SinkRight => Displacement::new(-1, 1),
            Self::GlideLeft => Displacement::new(0, -2),
            Self::GlideRight => Displacement::new(0, 2),
        }
    }

    /// Quads that the step adds (edges of the polygon mesh).
    #[must_use]
    pub const fn quads_added(self) -> i32 {
        match self {
            Self::ClimbLeft | Self::ClimbRight => -1,
            Self::SinkLeft | Self::SinkRight => 1,
            Self::GlideLeft | Self::GlideRight => 0,
        }
    }

    /// The step that takes this one back.
    #[must_use]
    pub const fn inverse(self) -> Self {
        match self {
            Self::ClimbLeft => Self::SinkLeft,
            Self::ClimbRight => Self::SinkRight,
            Self::SinkLeft => Self::ClimbLeft,
            Self::SinkRight => Self::ClimbRight,
            Self::GlideLeft => Self::GlideRight,
            Self::GlideRight => Self::GlideLeft,
        }
    }
}

/// What a step did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stepped {
    /// The operation that was applied.
    pub op: Op,
    /// The change of E: 0 in regular surroundings.
    pub delta: i32,
    /// Where the dislocation stands now, if it still stands somewhere.
    pub dipole: Option<Dipole>,
}

/// What a step carries where.
#[derive(Debug, Clone, Copy)]
pub(super) struct Carried {
    pub(super) op: Op,
    pub(super) delta: i32,
    /// Where the edge too few is now, and the one too many.
    pub(super) ends: [Vertex; 2],
}

impl Dipole {
    /// Whether a dislocation stands here: an edge too few at the origin, one too many at the
    /// target (either may have more of it), counted in the sectors that the half-edge lies in.
    #[must_use]
    pub fn stands(self, mesh: &QuadMesh) -> bool {
        let (h, t) = (self.0, mesh.twin(self.0));
        let real = !mesh.is_ghost(mesh.origin(h)) && !mesh.is_ghost(mesh.origin(t));
        real && mesh.excess(h) <= -1 && mesh.excess(t) >= 1
    }

    /// Whether it is a T-junction (v3–f5) rather than a dual one (f3–v5).
    #[must_use]
    pub fn is_t_junction(self) -> bool {
        self.0 & 1 == 0
    }

    /// All dislocations of the mesh, in order of half-edge.
    pub fn all(mesh: &QuadMesh) -> impl Iterator<Item = Self> + '_ {
        mesh.quads()
            .filter(|&q| mesh.kind(q) != crate::sqrtcc::QuadKind::Boundary)
            .flat_map(|q| (4 * q..4 * q + 4).map(Self))
            .filter(|d| d.stands(mesh))
    }

    /// The operation that makes `step`.
    #[must_use]
    pub fn op(self, mesh: &QuadMesh, step: Step) -> Op {
        let (h, t) = (self.0, mesh.twin(self.0));
        match step {
            Step::ClimbLeft => Op::Collapse(Collapse { edge: h }),
            Step::ClimbRight => Op::Collapse(Collapse { edge: QuadMesh::next(t) }),
            Step::SinkLeft => Op::Split(Split { first: t, last: mesh.ccw(mesh.ccw(t)) }),
            Step::SinkRight => Op::Split(Split { first: mesh.cw(mesh.cw(t)), last: t }),
            Step::GlideLeft => Op::Flip(Flip { edge: mesh.ccw(t), turn: Turn::Ccw }),
            Step::GlideRight => Op::Flip(Flip { edge: mesh.cw(t), turn: Turn::Cw }),
        }
    }

    /// Makes one step. The mesh is unchanged if it is refused.
    pub fn step(self, mesh: &mut QuadMesh, step: Step) -> Result<Stepped, Refusal> {
        let Carried { op, delta, ends } = self.carry(mesh, step)?;
        Ok(Stepped { op, delta, dipole: Self::between(mesh, ends) })
    }

    /// The dislocation with these ends, v3 first, if one stands there.
    pub(super) fn between(mesh: &QuadMesh, [x, y]: [Vertex; 2]) -> Option<Self> {
        let handle = mesh.is_alive(x).then(|| mesh.find(x, y)).flatten().map(Self);
        handle.filter(|d| d.stands(mesh))
    }

    /// Makes the operation of `step`, whether or not a dislocation stands here or there: its
    /// effect on valences is the same everywhere.
    pub(super) fn carry(self, mesh: &mut QuadMesh, step: Step) -> Result<Carried, Refusal> {
        let quad = QuadMesh::quad(self.0);
        if quad >= mesh.quad_ids() || !mesh.is_quad_alive(quad) {
            return Err(Refusal::Gone);
        }
        let op = self.op(mesh, step);
        let legal = op.check(mesh)?;
        let delta = legal.delta();
        let (x, y) = self.ahead(mesh, step);
        Op::apply(mesh, legal);
        let x = match step {
            Step::SinkLeft | Step::SinkRight => mesh.vertex_ids() - 1,
            _ => x,
        };
        Ok(Carried { op, delta, ends: [x, y] })
    }

    /// The v3 and v5 after the step, read before it; the v3 of a sinking one is yet to be made.
    fn ahead(self, mesh: &QuadMesh, step: Step) -> (Vertex, Vertex) {
        let (h, t) = (self.0, mesh.twin(self.0));
        let merged = |edge: HalfEdge| {
            let across = mesh.origin(QuadMesh::opposite(edge));
            if mesh.is_held(across) { across } else { mesh.origin(edge) }
        };
        match step {
            Step::ClimbLeft => (mesh.origin(QuadMesh::prev(h)), merged(h)),
            Step::ClimbRight => (mesh.origin(QuadMesh::opposite(t)), merged(QuadMesh::next(t))),
            Step::SinkLeft => (mesh.origin(t), mesh.target(mesh.ccw(mesh.ccw(t)))),
            Step::SinkRight => (mesh.origin(t), mesh.target(mesh.cw(mesh.cw(t)))),
            Step::GlideLeft => {
                let e = mesh.ccw(t);
                (mesh.target(e), mesh.origin(QuadMesh::opposite(e)))
            }
            Step::GlideRight => {
                let e = mesh.cw(t);
                (mesh.target(e), mesh.origin(QuadMesh::prev(mesh.twin(e))))
            }
        }
    }
}
