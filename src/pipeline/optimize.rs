//! From a mesh to one with planar or equiangular faces: mend → optimise, on fixed connectivity.

use super::prepare::Prepared;
use super::{CleanError, budget};
use crate::config::Config;
use crate::mesh::{MendPolicy, MendReport, PolyMesh, Topology, check_connected};
use crate::optimize::{self, Fairness, Goal, Options};
use crate::smooth::{Budget, held_vertices};
use crate::surface::{
    Deviation, Reference, deviation, mean_edge, mesh_features, vertices_on_lines,
};
use crate::watch::{Phase, Watch};
use serde::Serialize;

/// Samples each way for the distances of the report.
const SAMPLES: usize = 50_000;

/// What was done to a mesh.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// The goal.
    pub goal: Goal,
    /// Defects that were mended before anything else.
    pub mends: MendReport,
    /// Vertices that were held.
    pub held: usize,
    /// The mesh as it was.
    pub before: State,
    /// The mesh that is returned.
    pub after: State,
}

/// What is compared.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct State {
    /// Planarity and angles.
    #[serde(flatten)]
    pub fairness: Fairness,
    /// Two-way Hausdorff distance to the reference, relative to its diagonal.
    pub hausdorff_rel: f64,
    /// Root mean square distance, relative to the diagonal.
    pub rms_rel: f64,
}

/// An optimised mesh and how it came about.
#[derive(Debug, Clone)]
pub struct Optimized {
    /// The mesh; its connectivity is that of the mended input.
    pub mesh: PolyMesh,
    /// What was done.
    pub report: Report,
}

/// Moves the vertices of `mesh` towards the goal, near `reference` (its own surface if there is
/// none). Boundaries, features and their vertices stay where they are.
pub fn optimize(
    mesh: PolyMesh,
    reference: Option<&PolyMesh>,
    goal: Goal,
    policy: MendPolicy,
    config: &Config,
    watch: &dyn Watch,
) -> Result<Optimized, CleanError> {
    watch.progress(Phase::Reference, 0, 1, None);
    let Prepared { mut mesh, topology, mends, surface } = Prepared::new(mesh, reference, policy)?;
    let reference = &*surface;
    let allowed = allowed((&mesh, &topology), reference, config)?;
    let held = held(&mesh, &topology, reference, config);
    let before = State::of(&mesh, reference)?;
    let options =
        Options { optimize: &config.optimize, smooth: &config.smooth, relax: &config.relax };
    let points = optimize::optimize(&mesh, &held, reference, (goal, options), allowed, watch);
    mesh.set_points(points);
    check_connected(&mesh, &topology).map_err(CleanError::Flawed)?;
    let after = State::of(&mesh, reference)?;
    let held = held.into_iter().filter(|&h| h).count();
    Ok(Optimized { mesh, report: Report { goal, mends, held, before, after } })
}

/// How far from the reference vertices may go.
pub(crate) fn allowed(
    (mesh, topology): (&PolyMesh, &Topology),
    reference: &Reference,
    config: &Config,
) -> Result<Budget, CleanError> {
    let edge = mean_edge(mesh, topology);
    let start = budget(mesh, reference, (&config.gate, edge))?;
    Ok(Budget {
        hausdorff: start.hausdorff.max(config.optimize.hausdorff_edges * edge),
        rms: start.rms.max(config.optimize.rms_edges * edge),
    })
}

/// Which vertices stay: those of boundaries and features, and those on creases.
fn held(mesh: &PolyMesh, topology: &Topology, reference: &Reference, config: &Config) -> Vec<bool> {
    let features = mesh_features(mesh, topology, reference, &config.features);
    let mut held = held_vertices(mesh, topology, &features);
    for v in vertices_on_lines(mesh, topology, reference, &config.features) {
        held[v as usize] = true;
    }
    held
}

impl State {
    fn of(mesh: &PolyMesh, reference: &Reference) -> Result<Self, CleanError> {
        let Deviation { hausdorff, rms } = deviation(&Reference::plain(mesh)?, reference, SAMPLES);
        let diagonal = reference.diagonal();
        let (hausdorff_rel, rms_rel) = (hausdorff / diagonal, rms / diagonal);
        Ok(Self { fairness: Fairness::of(mesh), hausdorff_rel, rms_rel })
    }
}
