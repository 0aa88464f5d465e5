//! Geometry optimisation on fixed connectivity, near the reference: planar faces, or equiangular
//! ones.
//!
//! Boundaries, features and their vertices are held; the mesh stays within a budget of distance
//! to the reference, both ways, and no sound quad is spoiled. Equal angles are what the smoother
//! is for; planes are fitted by [`planar`]. Source: Peng & Wonka 2013, section 5, Figures 9 and
//! 10.

mod fairness;
pub mod planar;

pub use fairness::{Fairness, MeanMax, planarity};

use crate::knobs::knobs;
use crate::mesh::{Point, PolyMesh};
use crate::smooth::{Budget, RelaxOptions, SmoothOptions, smooth};
use crate::surface::Reference;
use crate::watch::Watch;
use serde::{Deserialize, Serialize};

knobs! {
    /// How vertices are moved for planar or equiangular faces.
    pub struct OptimizeOptions in "optimize" {
        /// Most iterations.
        iterations: u32 = 400, in 0.0..=20_000.0, "count";
        /// Hausdorff distance to the reference that is allowed, if that of the start is not more.
        hausdorff_edges: f64 = 0.3, in 0.0..=100.0, "mean edges";
        /// Root mean square distance that is allowed, if that of the start is not more.
        rms_edges: f64 = 0.1, in 0.0..=100.0, "mean edges";
        /// How much the reference pulls along its normals, relative to a face that is to be planar.
        surface: f64 = 0.05, in 0.0..=100.0, "factor";
        /// How much a good shape pulls, relative to a face that is to be planar.
        shape: f64 = 0.05, in 0.0..=100.0, "factor";
        /// How much its first place pulls a vertex, relative to a face that is to be planar.
        stay: f64 = 0.005, in 0.0..=100.0, "factor";
        /// Most rounds of holding vertices where a limit was broken.
        rounds: u32 = 12, in 0.0..=100.0, "count";
    }
}

/// What to optimise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Goal {
    /// Faces in a plane each.
    Planar,
    /// Faces with equal angles each.
    Angles,
}

/// All options that an optimisation looks at.
#[derive(Debug, Clone, Copy)]
pub struct Options<'a> {
    /// Its own.
    pub optimize: &'a OptimizeOptions,
    /// The limits of smoothing, which it keeps too.
    pub smooth: &'a SmoothOptions,
    /// How faces pull their corners.
    pub relax: &'a RelaxOptions,
}

/// Moves the vertices of `mesh` that are not `held` towards the goal; the new points. They are
/// within `allowed` of the reference, or those of the start. Deterministic; independent of the
/// number of threads. O(iterations · n), parallel.
#[must_use]
pub fn optimize(
    mesh: &PolyMesh,
    held: &[bool],
    reference: &Reference,
    (goal, options): (Goal, Options),
    allowed: Budget,
    watch: &dyn Watch,
) -> Vec<Point> {
    match goal {
        Goal::Planar => planar::flatten(mesh, held, (reference, allowed), options, watch),
        Goal::Angles => {
            let iterations = options.optimize.iterations;
            let smoothing = SmoothOptions { iterations, ..options.smooth.clone() };
            let options = (&smoothing, options.relax);
            smooth(mesh, held, reference, options, Some(allowed), watch).0
        }
    }
}
