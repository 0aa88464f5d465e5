//! An edit: what the planner proposes, commits and logs.

use super::cost::{CostOptions, StepContext, TERMS};
use super::movement::Cancellation;
use crate::moves::{Dipole, Step};
use crate::ops::{Op, Refusal};
use crate::patch::{Crossing, Refill};
use crate::sqrtcc::{Ideal, QuadMesh};
use serde::Serialize;

/// What the planner does to the mesh, beside smoothing.
#[derive(Debug, Clone, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Edit {
    /// One or two operations after which E is smaller.
    Local {
        /// The operations.
        ops: Vec<Op>,
    },
    /// A T-junction turns into a dual one, or away from the face it hangs in.
    TypeChange {
        /// The operations.
        ops: Vec<Op>,
    },
    /// A dislocation walks until it is absorbed.
    Walk {
        /// What absorbs it.
        cancellation: Cancellation,
        /// Where it starts.
        start: Dipole,
        /// How it walks.
        steps: Vec<Step>,
        /// What each term of the cost adds.
        terms: Vec<CostTerm>,
    },
    /// A patch is refilled.
    Refill(Refill),
    /// Features are resampled, and patches on all their sides refilled.
    Crossing(Crossing),
    /// No change of connectivity: what sectors at features want, measured anew after the features
    /// have moved. Which feature vertices may go later depends on it.
    Ideals {
        /// The ideals that are others now.
        ideals: Vec<Ideal>,
    },
}

/// A term of the cost of a walk, summed over its steps and weighted.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CostTerm {
    /// Name of the term.
    pub name: &'static str,
    /// Weight × value, summed over the steps.
    pub cost: f64,
}

impl Edit {
    /// The edit as it has to be made on a mesh with so many (vertex, quad) ids `now`, after it was
    /// planned on `planned` of them: its later parts name what the ones before made.
    #[must_use]
    pub fn rebased(self, planned: (u32, u32), now: (u32, u32)) -> Self {
        let rebased = |ops: Vec<Op>| {
            ops.into_iter().map(|op| op.rebased(4 * planned.1, 4 * now.1)).collect::<Vec<Op>>()
        };
        match self {
            Self::Local { ops } => Self::Local { ops: rebased(ops) },
            Self::TypeChange { ops } => Self::TypeChange { ops: rebased(ops) },
            Self::Crossing(crossing) => Self::Crossing(crossing.rebased(planned, now)),
            Self::Walk { .. } | Self::Refill(_) | Self::Ideals { .. } => self,
        }
    }

    /// Makes the edit, whole or not at all.
    pub fn run(&self, mesh: &mut QuadMesh) -> Result<(), Refusal> {
        let mark = mesh.mark();
        let done = match self {
            Self::Local { ops } | Self::TypeChange { ops } => {
                ops.iter().try_for_each(|op| op.run(mesh).map(drop))
            }
            Self::Walk { start, steps, .. } => walk(mesh, *start, steps),
            Self::Refill(refill) => refill.run(mesh),
            Self::Crossing(crossing) => crossing.run(mesh),
            Self::Ideals { ideals } => mesh.note_ideals(ideals).then_some(()).ok_or(Refusal::Gone),
        };
        if done.is_err() {
            mesh.undo_to(mark);
        }
        done
    }
}

/// Walks a dislocation; it may be absorbed at the last step only.
fn walk(mesh: &mut QuadMesh, start: Dipole, steps: &[Step]) -> Result<(), Refusal> {
    let mut at = Some(start);
    for &step in steps {
        at = at.ok_or(Refusal::Gone)?.step(mesh, step)?.dipole;
    }
    Ok(())
}

/// The cost terms of a walk. The mesh is unchanged afterwards.
#[must_use]
pub fn walk_terms(
    mesh: &mut QuadMesh,
    start: Dipole,
    steps: &[Step],
    costs: &CostOptions,
) -> Vec<CostTerm> {
    let mark = mesh.mark();
    let mut sums = vec![0.0; TERMS.len()];
    let mut at = Some(start);
    for &step in steps {
        let Some(dipole) = at else { break };
        let context = StepContext { mesh, dipole, step };
        for (sum, term) in sums.iter_mut().zip(TERMS) {
            *sum += (term.weight)(costs) * (term.value)(&context);
        }
        at = dipole.step(mesh, step).ok().and_then(|done| done.dipole);
    }
    mesh.undo_to(mark);
    let used = TERMS.iter().zip(sums).filter(|&(_, cost)| cost != 0.0);
    used.map(|(term, cost)| CostTerm { name: term.name, cost }).collect()
}
