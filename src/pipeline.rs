//! The whole way: mesh → lift → plan → edit → lower → smooth.

use crate::mesh::{NONE, PolyMesh, Topology};
use crate::planner::cost::CostOptions;
use crate::planner::gate::{self, GateOptions};
use crate::planner::schedule::Schedule;
use crate::planner::worker::{Stage, Task};
use crate::planner::PlanOptions;
use crate::smooth::{self, RelaxOptions, SmoothOptions};
use crate::sqrtcc::{QuadMesh, lift, lower};
use crate::surface::{self, FeatureOptions, Reference, mesh_features};
use crate::watch::Watch;

/// x
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// x
    pub features: FeatureOptions,
    /// x
    pub plan: PlanOptions,
    /// x
    pub cost: CostOptions,
    /// x
    pub gate: GateOptions,
    /// x
    pub relax: RelaxOptions,
    /// x
    pub smooth: SmoothOptions,
}

/// x
pub fn edit(mesh: &PolyMesh, reference: &Reference, options: &Options, watch: &dyn Watch) -> (PolyMesh, Schedule) {
    let topology = Topology::new(mesh);
    let features = mesh_features(mesh, &topology, reference, &options.features);
    let orientation = smooth::orientation(mesh, reference);
    let before = surface::deviation(&Reference::new(mesh).unwrap(), reference, 20000);
    let mut q = lift(mesh, &features).unwrap();
    let mut schedule = Schedule::new(&q);
    let t0 = std::time::Instant::now();
    if std::env::var("QM_V").is_ok() { eprintln!("features {} dev {:?} E {}", features.count_ones(..)/2, before, q.total_irregularity()); }
    smooth_q(&mut q, mesh, reference, options, options.plan.smooth_between, before, watch);
    for i in 0..options.plan.stages {
        for stage in [Stage::Moves, Stage::Refills { faces: options.plan.patch_faces(i) }] {
            schedule.forget_failures();
            for _ in 0..options.plan.rounds {
                let points: Vec<_> = (0..q.vertex_ids()).map(|v| q.position(v)).collect();
                let hits = reference.closest_many(&points);
                let near: Vec<u32> = hits.iter().enumerate().map(|(v, h)| if q.is_alive(v as u32) && !q.is_face(v as u32) { h.triangle } else { NONE }).collect();
                let gate = gate::Setting { reference, orientation, relax: &options.relax, options: &options.gate, distance: options.gate.distance * before.hausdorff, near: &near };
                let task = Task { stage, lambda: options.plan.lambda(i), plan: &options.plan, costs: &options.cost, gate };
                let made = schedule.round(&mut q, &task, watch);
                if std::env::var("QM_V").is_ok() { let r = schedule.rounds.last().unwrap(); eprintln!("  {:.2}s stage {i} {stage:?} λ {:.0} seeds {} proposed {} made {} E {} down {:?} quads {}", t0.elapsed().as_secs_f64(), r.lambda, r.seeds, r.proposed, r.made, r.irregularity, r.turned_down, q.quads_alive()); }
                if made == 0 { break; }
            }
        }
        let last = i + 1 == options.plan.stages;
        smooth_q(&mut q, mesh, reference, options, if last { options.smooth.iterations } else { options.plan.smooth_between }, before, watch);
        if std::env::var("QM_V").is_ok() { eprintln!("  {:.2}s smoothed", t0.elapsed().as_secs_f64()); }
    }
    (lower(&q, mesh.group_names()).unwrap().mesh, schedule)
}

fn smooth_q(q: &mut QuadMesh, mesh: &PolyMesh, reference: &Reference, options: &Options, iterations: u32, budget: surface::Deviation, watch: &dyn Watch) {
    let lowered = lower(q, mesh.group_names()).unwrap();
    let smoothing = SmoothOptions { iterations, ..options.smooth.clone() };
    let (points, report) = smooth::smooth(&lowered.mesh, &lowered.held, reference, (&smoothing, &options.relax), Some(budget), watch);
    if std::env::var("QM_V").is_ok() { eprintln!("  smooth: {report:?}"); }
    for (&v, p) in lowered.vertex_ids.iter().zip(points) { q.set_position(v, p); }
    q.commit();
}
