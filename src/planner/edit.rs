//! An edit: what the planner proposes, commits and logs.

use super::cost::{CostOptions, StepContext, TERMS};
use super::movement::Cancellation;
use crate::moves::{Dipole, Step};
use crate::ops::{Op, Refusal};
use crate::patch::Refill;
use crate::sqrtcc::QuadMesh;
use serde::Serialize;

/// A change of connectivity, planned on a mesh with so many ids.
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
    /// Makes the edit on a mesh that may have got more elements since it was planned on `planned`
    /// quad ids; whole or not at all.
    pub fn run(&self, mesh: &mut QuadMesh, planned: u32) -> Result<(), Refusal> {
        let mark = mesh.mark();
        let done = match self {
            Self::Local { ops } | Self::TypeChange { ops } => {
                let to = 4 * mesh.quad_ids();
                ops.iter().try_for_each(|op| op.rebased(4 * planned, to).run(mesh).map(|_| ()))
            }
            Self::Walk { start, steps, .. } => walk(mesh, *start, steps),
            Self::Refill(refill) => refill.run(mesh),
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
