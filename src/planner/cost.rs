//! What a movement step costs: a weighted sum of terms, topological and geometric.
//!
//! A new term is one entry of [`TERMS`] and one knob.

use crate::knobs::knobs;
use crate::moves::{Dipole, Step};
use crate::sqrtcc::QuadMesh;

knobs! {
    /// Weights of the cost terms of a movement step, and what an absorption costs beside it.
    pub struct CostOptions in "cost" {
        /// Each step, wherever it leads.
        step: f64 = 1.0, in 0.001..=100.0, "per step";
        /// A quad added or removed: keeps the number of faces.
        quads: f64 = 0.2, in 0.0..=100.0, "per quad";
        /// A T-junction turned into a dual T-junction or back.
        type_change: f64 = 0.1, in 0.0..=100.0, "per change";
        /// Passing a vertex that a boundary or feature holds.
        near_feature: f64 = 0.5, in 0.0..=100.0, "per held vertex";
        /// Removing edges longer than their neighbours or adding to shorter ones.
        edge_length: f64 = 0.5, in 0.0..=100.0, "per factor e in length";
        /// Crossing a bend of the surface.
        curvature: f64 = 0.0, in 0.0..=100.0, "per radian of turning normal";
        /// A triple cancellation (three elements become one), beside its last step.
        triple: f64 = 2.0, in 0.0..=100.0, "per absorption";
        /// A T-junction pair cancellation (two T-junctions vanish), beside its last step.
        t_junction_pair: f64 = 0.0, in 0.0..=100.0, "per absorption";
        /// Any other quadruple cancellation (two opposite pairs vanish), beside its last step.
        quadruple: f64 = 0.0, in 0.0..=100.0, "per absorption";
        /// What an irregular face costs more than an irregular vertex where a refill leaves the choice;
        /// if negative, less.
        face: f64 = 0.0, in -100_000.0..=100_000.0, "degree-corners";
    }
}

/// A step about to be made.
#[derive(Debug, Clone, Copy)]
pub struct StepContext<'a> {
    /// The mesh before the step.
    pub mesh: &'a QuadMesh,
    /// The dislocation that moves.
    pub dipole: Dipole,
    /// How it moves.
    pub step: Step,
}

/// One term of the cost.
#[derive(Clone, Copy)]
pub struct Term {
    /// Its name, which is its key in the section `cost`.
    pub name: &'static str,
    /// Its weight.
    pub weight: fn(&CostOptions) -> f64,
    /// Its value for a step; never negative.
    pub value: fn(&StepContext) -> f64,
}

/// All terms, in the order in which they are reported.
pub const TERMS: &[Term] = &[
    Term { name: "step", weight: |c| c.step, value: |_| 1.0 },
    Term { name: "quads", weight: |c| c.quads, value: |s| f64::from(s.step.quads_added().abs()) },
    Term {
        name: "type_change",
        weight: |c| c.type_change,
        value: |s| f64::from(u8::from(s.step.displacement().swaps_type())),
    },
    Term { name: "near_feature", weight: |c| c.near_feature, value: near_feature },
    Term { name: "edge_length", weight: |c| c.edge_length, value: edge_length },
    Term { name: "curvature", weight: |c| c.curvature, value: curvature },
];

/// The cost of a step: Σ weight × value; terms of weight 0 are not evaluated.
#[must_use]
pub fn step_cost(options: &CostOptions, context: &StepContext) -> f64 {
    let used = TERMS.iter().map(|t| (t, (t.weight)(options))).filter(|&(_, w)| w > 0.0);
    used.map(|(term, weight)| weight * (term.value)(context)).sum()
}

/// Held vertices among the corners of the quads on both sides of the dislocation.
fn near_feature(s: &StepContext) -> f64 {
    let corners = [s.dipole.0, s.mesh.twin(s.dipole.0)].into_iter().flat_map(|h| {
        [h, QuadMesh::prev(h), QuadMesh::opposite(h), QuadMesh::next(h)].map(|e| s.mesh.origin(e))
    });
    corners.filter(|&v| s.mesh.is_held(v)).count() as f64 / 2.0
}

/// How wrong it is, by length, to remove the edge of this quad (climb) or to add another (sink):
/// |ln(length / mean length around)| on the wrong side, else 0.
fn edge_length(s: &StepContext) -> f64 {
    let sign = f64::from(s.step.quads_added());
    if sign == 0.0 {
        return 0.0;
    }
    let (x, y) = (s.mesh.origin(s.dipole.0), s.mesh.target(s.dipole.0));
    let p = if s.mesh.is_face(x) { y } else { x };
    let lengths = s.mesh.diagonals(p).map(|v| (s.mesh.position(v) - s.mesh.position(p)).norm());
    let (mut sum, mut count, mut shortest) = (0.0, 0.0, f64::INFINITY);
    for length in lengths {
        (sum, count, shortest) = (sum + length, count + 1.0, shortest.min(length));
    }
    if count == 0.0 || sum <= 0.0 || shortest <= 0.0 {
        return 0.0;
    }
    // Crowded (shortest ≪ mean): removing is right. Even: both cost a little the same.
    let crowding = (sum / count / shortest).ln();
    (0.5 + sign * crowding).max(0.0)
}

/// Turning of the normal across the dislocation, radians: between the quads of both sides.
fn curvature(s: &StepContext) -> f64 {
    let normal = |h: u32| {
        let at = |e: u32| s.mesh.location(s.mesh.origin(e));
        let (d1, d2) =
            (at(QuadMesh::opposite(h)) - at(h), at(QuadMesh::prev(h)) - at(QuadMesh::next(h)));
        d1.cross(&d2)
    };
    let turn = normal(s.dipole.0).angle(&normal(s.mesh.twin(s.dipole.0)));
    if turn.is_finite() { turn } else { 0.0 }
}
