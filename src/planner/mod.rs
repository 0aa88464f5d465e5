//! The planner: finds irregular elements, plans their cancellation, and makes the edits.
//!
//! Stage by stage the exchange rate λ (degrees of corner angle for one element less) and the size
//! of patches grow; in each stage, rounds of moves (local reductions, and walks found by shortest
//! paths in the [`movement`] graph) are followed by rounds of refills, each edit judged by the
//! [`gate`]; then everything is smoothed. Source: Peng & Wonka 2013, section 4, which leaves the
//! automation as future work.

pub mod automation;
pub mod clusters;
pub mod contact;
pub mod cost;
mod cover;
mod creases;
pub mod crossings;
pub mod edit;
pub mod gate;
pub mod global;
pub mod lines;
pub mod local;
pub mod movement;
pub mod schedule;
pub mod worker;

use crate::knobs::knobs;

knobs! {
    /// How edits are searched for.
    pub struct PlanOptions in "plan" {
        /// Stages, each with a larger exchange rate and larger patches.
        stages: u32 = 4, in 0.0..=20.0, "count";
        /// Exchange rate of the first stage.
        lambda_first: f64 = 80.0, in 0.0..=100_000.0, "degree-corners per element";
        /// Exchange rate of the last stage.
        lambda_last: f64 = 3500.0, in 0.0..=100_000.0, "degree-corners per element";
        /// What a T-junction may cost to be turned into a dual one (a triangle and a vertex of five
        /// edges) at the end.
        lambda_types: f64 = 400.0, in 0.0..=100_000.0, "degree-corners";
        /// Most rounds of moves, and most rounds of refills, in a stage.
        rounds: u32 = 30, in 0.0..=1000.0, "count";
        /// Most rounds of moving elements to where they fit better, in each stage of the second half.
        relocations: u32 = 1, in 0.0..=1000.0, "count";
        /// What moving elements to a better place must save at least.
        relocation_saves: f64 = 40.0, in 0.0..=100_000.0, "degree-corners";
        /// Most rounds of the global plan, after the last stage; 0 leaves the greedy one alone.
        global: u32 = 30, in 0.0..=1000.0, "count";
        /// Feature edges near an element at which a way across is looked for; 0 leaves all features
        /// as they are sampled.
        crossings: u32 = 8, in 0.0..=100.0, "count";
        /// Irregular elements that are planned for in the same round are this far apart.
        spacing: u32 = 2, in 0.0..=100.0, "steps in Q";
        /// Most steps that a dislocation walks.
        reach: u32 = 16, in 0.0..=100.0, "steps";
        /// Operations in a local reduction.
        depth: u32 = 2, in 0.0..=2.0, "operations";
        /// Candidates of each kind that are judged for an element.
        tries: u32 = 3, in 1.0..=50.0, "count";
        /// Nearest irregular elements that a patch around an element may take in.
        partners: u32 = 12, in 0.0..=50.0, "count";
        /// Most faces of a patch in the first stage.
        patch_faces_first: u32 = 60, in 0.0..=100_000.0, "faces";
        /// Most faces of a patch in the last stage.
        patch_faces_last: u32 = 2000, in 0.0..=100_000.0, "faces";
        /// Largest share of the faces of the input in a patch.
        patch_share: f64 = 0.25, in 0.0..=1.0, "1";
        /// Fillings of a patch that are judged.
        fillings: u32 = 3, in 1.0..=20.0, "count";
        /// Largest |ln| of the number of faces over that of the input.
        size_drift: f64 = 0.08, in 0.0..=3.0, "ln";
        /// Iterations of smoothing before the first stage and after each; 0 smooths at the end only.
        smooth_between: u32 = 40, in 0.0..=5000.0, "count";
        /// Sweeps over the vertices within features, which slide along them, after each smoothing.
        slides: u32 = 5, in 0.0..=1000.0, "count";
        /// How near to a crease vertices are put onto it at the end, after which all is smoothed
        /// once more; 0 leaves them where they are.
        settles_edges: f64 = 0.4, in 0.0..=2.0, "mean edges";
        /// How much corners may deviate in all for an edge that is drawn to a crease at the end,
        /// from as far away as it is long; 0 leaves all where they are.
        crease_worth: f64 = 80.0, in 0.0..=100_000.0, "mean deviations of the input";
        /// Make every face a quad at the end, as far as parity allows.
        pure_quad: bool = false, in 0.0..=1.0, "";
    }
}

impl PlanOptions {
    /// Exchange rate of stage `i` of [`Self::stages`], from 0: geometric between first and last.
    #[must_use]
    pub fn lambda(&self, i: u32) -> f64 {
        self.between(self.lambda_first, self.lambda_last, i)
    }

    /// Most faces of a patch in stage `i`.
    #[must_use]
    pub fn patch_faces(&self, i: u32) -> usize {
        let (first, last) = (f64::from(self.patch_faces_first), f64::from(self.patch_faces_last));
        self.between(first, last, i).round() as usize
    }

    fn between(&self, first: f64, last: f64, i: u32) -> f64 {
        let share = f64::from(i) / f64::from(self.stages.saturating_sub(1).max(1));
        if first > 0.0 { first * (last / first).powf(share) } else { last * share }
    }
}
