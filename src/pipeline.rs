//! The whole way: mend → lift → plan and edit → lower → measure.

pub mod optimize;
mod prepare;
pub mod pure_quad;

use crate::config::Config;
use crate::mesh::{Flaw, MendError, MendPolicy, MendReport, MeshError, PolyMesh, Topology};
use crate::metrics::{Metrics, MetricsError, measure};
use crate::moves::pure::Conversion;
use crate::planner::automation::Automation;
use crate::planner::edit::Edit;
use crate::planner::gate::GateOptions;
use crate::planner::schedule::{EditRecord, RoundRecord, Schedule};
use crate::smooth;
use crate::sqrtcc::{LiftError, QuadMesh, lift_connected, lower};
use crate::surface::{
    self, Deviation, FeatureOptions, Reference, SharpLines, SurfaceError, mean_edge, mesh_features,
    vertices_on_lines,
};
use crate::watch::{Phase, Watch};
use prepare::{Prepared, measure_clean};
use serde::Serialize;
use thiserror::Error;

/// A mesh farther than this from its reference in the mean, relative to the diagonal of the
/// reference, was not made from it.
const ELSEWHERE_REL: f64 = 0.05;

/// A mesh this near to its reference is its own.
const SAME_REL: f64 = 1e-9;

/// Samples each way for the distance that cleaning must keep.
const BUDGET_SAMPLES: usize = 50_000;

/// Why a mesh was not cleaned.
#[derive(Debug, Error)]
pub enum CleanError {
    /// The mesh has defects that cannot be mended, or must not be.
    #[error("the mesh cannot be edited: {0}")]
    Mend(#[from] MendError),
    /// The reference has no surface.
    #[error("the reference cannot be used: {0}")]
    Reference(#[from] SurfaceError),
    /// The mesh does not lie on the reference.
    #[error(
        "the mesh is {rms_rel:.3} bounding-box diagonals from the reference in the mean; give the \
         surface that it was made from, in the same position and scale"
    )]
    Elsewhere {
        /// Root mean square distance, relative to the diagonal of the reference.
        rms_rel: f64,
    },
    /// The mesh cannot be lifted; mending should have seen to that.
    #[error(transparent)]
    Lift(#[from] LiftError),
    /// The mesh is too large.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The mesh cannot be measured.
    #[error(transparent)]
    Metrics(#[from] MetricsError),
    /// The result is not clean: a bug of this program. Nothing is returned.
    #[error("the result has a flaw ({0}); please report this with the input")]
    Flawed(Flaw),
}

/// What was done to a mesh.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Defects that were mended before anything else.
    pub mends: MendReport,
    /// Edges of the mended mesh that were held as sharp features.
    pub feature_edges: usize,
    /// The mesh as it was read.
    pub before: Metrics,
    /// The mesh that is returned.
    pub after: Metrics,
    /// The edits, in the order in which they were made.
    pub edits: Vec<EditRecord>,
    /// The rounds of planning.
    pub rounds: Vec<RoundRecord>,
    /// How faces were made quads, if the configuration asks for that (`plan.pure_quad`); the last
    /// of the edits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub conversion: Option<Conversion>,
    /// Whether the run was told to stop before it was done.
    pub stopped: bool,
}

/// A cleaned mesh and how it came about.
#[derive(Debug, Clone)]
pub struct Cleaned {
    /// The mesh: manifold, consistently oriented, without doublets.
    pub mesh: PolyMesh,
    /// What was done.
    pub report: Report,
}

/// Cleans `mesh`, which may be any soup, on the surface of `reference` (its own if there is none).
///
/// Boundaries keep their vertices, sharp features their corners and their shape; χ, components and
/// boundary loops stay as they are after mending. The result depends on the arguments only, not on threads.
pub fn clean(
    mesh: PolyMesh,
    reference: Option<&PolyMesh>,
    policy: MendPolicy,
    config: &Config,
    watch: &dyn Watch,
) -> Result<Cleaned, CleanError> {
    let (raw, faces) = (mesh.clone(), mesh.face_count());
    watch.progress(Phase::Reference, 0, 1, None);
    let mut prepared = Prepared::new(mesh, reference, policy)?;
    let target = prepared.target(reference, config);
    let mends = std::mem::take(&mut prepared.mends);
    // Editing does not keep all threads at work all the time: measuring fills the gaps.
    let measured = || {
        let raw = raw;
        measure(&raw, Some(&target))
    };
    let (before, edited) = rayon::join(measured, || edit(prepared, faces, config, watch));
    let before = before?;
    let Edited { q, group_names, feature_edges, schedule, conversion } = edited?;
    let stopped = watch.cancelled();
    let result = lower(&q, &group_names)?.mesh;
    drop(q);
    watch.progress(Phase::Measure, 0, 1, None);
    let Schedule { edits, rounds, .. } = schedule;
    let after = measure_clean(&result, &target)?;
    Ok(Cleaned {
        mesh: result,
        report: Report { mends, feature_edges, before, after, edits, rounds, conversion, stopped },
    })
}

/// The edits that [`clean`] would make.
#[derive(Debug, Clone)]
pub struct Planned {
    /// The edits, in order.
    pub edits: Vec<EditRecord>,
    /// The rounds of planning.
    pub rounds: Vec<RoundRecord>,
    /// What they and the smoothing between them make of the mesh.
    pub mesh: PolyMesh,
}

/// Plans as [`clean`] does, but measures nothing.
pub fn plan(
    mesh: PolyMesh,
    reference: Option<&PolyMesh>,
    policy: MendPolicy,
    config: &Config,
    watch: &dyn Watch,
) -> Result<Planned, CleanError> {
    let faces = mesh.face_count();
    watch.progress(Phase::Reference, 0, 1, None);
    let prepared = Prepared::new(mesh, reference, policy)?;
    let Edited { q, group_names, schedule, .. } = edit(prepared, faces, config, watch)?;
    let Schedule { edits, rounds, .. } = schedule;
    Ok(Planned { edits, rounds, mesh: lower(&q, &group_names)?.mesh })
}

/// What was made of a mesh, still lifted.
struct Edited {
    q: QuadMesh,
    group_names: Vec<String>,
    feature_edges: usize,
    schedule: Schedule,
    conversion: Option<Conversion>,
}

/// Lifts, plans, edits and smooths a mended mesh that had so many faces before.
fn edit(
    Prepared { mesh, topology, surface, .. }: Prepared,
    faces: usize,
    config: &Config,
    watch: &dyn Watch,
) -> Result<Edited, CleanError> {
    watch.progress(Phase::Reference, 0, 1, None);
    let reference = &*surface;
    let mean_edge = mean_edge(&mesh, &topology);
    // What extends lines is no crease by itself, and shorter than an edge there is none.
    let sharp = FeatureOptions { min_chain_edges: 1.0, extend: 1.0, ..config.features.clone() };
    let near = || {
        let budget = budget(&mesh, reference, (&config.gate, mean_edge))?;
        let orientation = smooth::orientation(&mesh, reference);
        let lines = SharpLines::new(reference, &config.features, mean_edge);
        let creases = SharpLines::new(reference, &sharp, mean_edge);
        Ok::<_, CleanError>((budget, orientation, lines, creases))
    };
    let lifted = || lift_held(&mesh, &topology, reference, &config.features);
    let (near, lifted) = rayon::join(near, lifted);
    let (budget, orientation, lines, creases) = near?;
    let (mut q, feature_edges) = lifted?;
    drop(topology);
    let group_names = mesh.group_names().to_vec();
    // From here on Q is the mesh.
    drop(mesh);
    let automation = Automation {
        reference,
        lines: &lines,
        creases: &creases,
        crease_deg: config.features.crease_deg,
        orientation,
        budget,
        faces,
        mean_edge,
        plan: &config.plan,
        costs: &config.cost,
        gate: &config.gate,
        relax: &config.relax,
        smooth: &config.smooth,
    };
    let mut schedule = automation.run(&mut q, watch)?;
    let mut conversion = None;
    if config.plan.pure_quad {
        let surface = (reference, automation.orientation);
        let done = pure_quad::convert_cleaned(&mut q, surface, budget, config, watch)?;
        note_conversion(&mut schedule, &q, &done);
        conversion = Some(done);
    }
    q.commit();
    Ok(Edited { q, group_names, feature_edges, schedule, conversion })
}

/// Lists a conversion with the edits, so that a log of them makes it again.
fn note_conversion(schedule: &mut Schedule, q: &QuadMesh, conversion: &Conversion) {
    if conversion.ops.is_empty() {
        return;
    }
    // It happens all over the mesh; its first vertex is as good a place as any.
    let place = q.vertices().next().map_or([0.0; 3], |v| q.location(v).into());
    let last = schedule.rounds.last();
    let (made, irregularity) = (conversion.divided + conversion.pairs, q.total_irregularity());
    schedule.rounds.push(RoundRecord {
        lambda: last.map_or(0.0, |round| round.lambda),
        seeds: made,
        proposed: made,
        made,
        irregularity,
        ..RoundRecord::default()
    });
    schedule.edits.push(EditRecord {
        round: schedule.rounds.len() as u32,
        gain: -(conversion.delta as i32),
        cost: 0.0,
        angle_growth_deg: 0.0,
        place,
        edit: Edit::TypeChange { ops: conversion.ops.clone() },
    });
}

/// Lifts a clean mesh, its sharp features frozen and the vertices on feature lines of the
/// reference held; also the number of feature edges.
pub(crate) fn lift_held(
    mesh: &PolyMesh,
    topology: &Topology,
    reference: &Reference,
    options: &FeatureOptions,
) -> Result<(QuadMesh, usize), LiftError> {
    let features = mesh_features(mesh, topology, reference, options);
    let mut q = lift_connected((mesh, topology), &features)?;
    for v in vertices_on_lines(mesh, topology, reference, options) {
        q.pin(v);
    }
    Ok((q, features.count_ones(..) / 2))
}

/// The distance to the reference that cleaning must keep: that of the mesh as it is, or, where
/// that is none because the mesh is its own reference, a part of its mean edge.
fn budget(
    mesh: &PolyMesh,
    reference: &Reference,
    (gate, edge): (&GateOptions, f64),
) -> Result<Deviation, CleanError> {
    let distance = surface::deviation(&Reference::plain(mesh)?, reference, BUDGET_SAMPLES);
    let rms_rel = distance.rms / reference.diagonal();
    if rms_rel > ELSEWHERE_REL {
        return Err(CleanError::Elsewhere { rms_rel });
    }
    if rms_rel > SAME_REL {
        return Ok(distance);
    }
    Ok(Deviation { hausdorff: gate.own_hausdorff_edges * edge, rms: gate.own_rms_edges * edge })
}
