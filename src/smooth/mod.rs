//! Moving vertices so that faces get good shapes while the surface stays where it is.
//!
//! A shape-fitting smoother (Bouaziz et al., *Shape-Up*, 2012; accelerated as in Nesterov 1983):
//! every face says where its corners would have to be for a good shape, every vertex goes to the
//! weighted mean of what its faces say, tangentially, and is projected to the reference every few
//! iterations. [`relax_local`] does this to a small [`Region`] around an edit, single-threaded
//! and without allocation in its loop; [`smooth`] does it to a whole mesh with the same kernel,
//! pulls places back that the mesh has left and undoes locally what broke the distance budget.
//!
//! *Invariant:* held vertices keep their coordinates to the bit; the result does not depend on
//! the number of threads.

mod anchors;
mod around;
mod fit;
mod global;
mod guard;
mod kernel;
mod region;
mod soundness;
mod untangle;

use crate::knobs::knobs;

pub use around::Surroundings;
pub(crate) use fit::{Shape, polygon, rectangle};
pub(crate) use global::limits;
pub use global::{SmoothReport, held_vertices, smooth, take_back};
pub use guard::Budget;
pub(crate) use guard::{Guard, Trace};
pub use region::{Orientation, Region, RelaxReport, fit_local, orientation, relax_local};
pub(crate) use soundness::{broken_below, twice_area};

knobs! {
    /// How faces pull their corners while edits are judged.
    pub struct RelaxOptions in "relax" {
        /// How much more a face weighs the worse its shape is.
        stress: f64 = 1.0, in 0.0..=100.0, "factor";
        /// Angle by which the diagonals of a quad may differ from 90 degrees: bounds the aspect.
        slant_deg: f64 = 12.0, in 0.0..=60.0, "degrees";
        /// Exponent of the pull of face sizes to their mean; 0 keeps the grading.
        even: f64 = 0.03, in 0.0..=1.0, "exponent";
        /// Corner angle of a vertex of three edges from which it counts as a T-junction.
        hang_deg: f64 = 150.0, in 100.0..=180.0, "degrees";
        /// Longest step of a vertex in an iteration.
        step_edges: f64 = 0.5, in 0.01..=2.0, "edges";
        /// Largest momentum.
        momentum: f64 = 0.95, in 0.0..=0.99, "factor";
        /// Vertices are projected to the reference in every so many iterations.
        project_every: u32 = 12, in 1.0..=100.0, "iterations";
    }
}

knobs! {
    /// How the vertices of the whole mesh are moved, and how far.
    pub struct SmoothOptions in "smooth" {
        /// Most iterations.
        iterations: u32 = 200, in 0.0..=5000.0, "count";
        /// Iterations that are done even if the run is to stop; 0 leaves all as it was then.
        hurried: u32 = 15, in 0.0..=5000.0, "count";
        /// How much more a face weighs the worse its shape is.
        stress: f64 = 2.0, in 0.0..=100.0, "factor";
        /// Vertices are projected to the reference in every so many iterations.
        project_every: u32 = 4, in 1.0..=100.0, "iterations";
        /// Stop when vertices move less than this, in the root mean square.
        still_edges: f64 = 2e-4, in 0.0..=0.1, "edges";
        /// Places the mesh has left are looked for in every so many iterations; 0 is never.
        anchor_every: u32 = 25, in 0.0..=1000.0, "iterations";
        /// Share of the allowed Hausdorff distance from which a place is pulled back.
        anchor_share: f64 = 0.75, in 0.0..=1.0, "share";
        /// Share of the shift along the normals after which faces, not corners, lie on the
        /// reference in the mean.
        fit: f64 = 1.0, in 0.0..=1.0, "share";
        /// Allowed Hausdorff distance and root mean square, relative to those of the start.
        budget: f64 = 1.02, in 0.0..=10.0, "factor";
        /// Scaled Jacobian that smoothing aims at for every quad, and keeps where it was.
        least_jacobian: f64 = 0.45, in -1.0..=1.0, "scaled Jacobian";
        /// Most rounds of undoing moves where a limit was broken.
        mend_rounds: u32 = 12, in 0.0..=100.0, "count";
    }
}
