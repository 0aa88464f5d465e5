//! The automation: stage after stage of moves, refills and smoothing.

use super::PlanOptions;
use super::cost::CostOptions;
use super::gate::{GateOptions, Setting};
use super::schedule::Schedule;
use super::worker::{Stage, Task};
use crate::mesh::{MeshError, NONE};
use crate::smooth::{self, Budget, Orientation, RelaxOptions, SmoothOptions};
use crate::sqrtcc::{QuadMesh, lower};
use crate::surface::Reference;
use crate::watch::Watch;

/// What the automation works with and towards.
#[derive(Debug, Clone, Copy)]
pub struct Automation<'a> {
    /// The surface to stay on.
    pub reference: &'a Reference,
    /// How the mesh is oriented against it.
    pub orientation: Orientation,
    /// How far the mesh may be from it, in units of the file.
    pub budget: Budget,
    /// How edits are searched for.
    pub plan: &'a PlanOptions,
    /// What steps cost.
    pub costs: &'a CostOptions,
    /// What edits may cost.
    pub gate: &'a GateOptions,
    /// How the surroundings of an edit relax.
    pub relax: &'a RelaxOptions,
    /// How the whole mesh is smoothed.
    pub smooth: &'a SmoothOptions,
}

impl Automation<'_> {
    /// Edits and smooths `mesh`; what was done. If cancelled, the mesh is valid and smoothed as
    /// far as it got.
    pub fn run(&self, mesh: &mut QuadMesh, watch: &dyn Watch) -> Result<Schedule, MeshError> {
        let mut schedule = Schedule::new(mesh);
        self.smooth(mesh, self.plan.smooth_between, watch)?;
        for i in 0..self.plan.stages {
            let lambda = self.plan.lambda(i);
            self.rounds(mesh, &mut schedule, (Stage::Moves, lambda), watch);
            let faces = self.plan.patch_faces(i);
            self.rounds(mesh, &mut schedule, (Stage::Refills { faces }, lambda), watch);
            if i + 1 < self.plan.stages {
                self.smooth(mesh, self.plan.smooth_between, watch)?;
            }
        }
        self.smooth(mesh, self.smooth.iterations, watch)?;
        Ok(schedule)
    }

    /// Rounds of one kind until nothing more is found.
    fn rounds(&self, mesh: &mut QuadMesh, schedule: &mut Schedule, (stage, lambda): (Stage, f64), watch: &dyn Watch) {
        schedule.forget_failures();
        for _ in 0..self.plan.rounds {
            let near = self.near(mesh);
            let gate = Setting {
                reference: self.reference,
                orientation: self.orientation,
                relax: self.relax,
                options: self.gate,
                distance: self.gate.distance * self.budget.hausdorff,
                near: &near,
            };
            let task = Task { stage, lambda, plan: self.plan, costs: self.costs, gate };
            if watch.cancelled() || schedule.round(mesh, &task, watch) == 0 {
                return;
            }
        }
    }

    /// A triangle of the reference near each p-vertex.
    fn near(&self, mesh: &QuadMesh) -> Vec<u32> {
        let vertices: Vec<u32> = mesh.vertices().filter(|&v| !mesh.is_face(v)).collect();
        let points: Vec<_> = vertices.iter().map(|&v| mesh.position(v)).collect();
        let mut near = vec![NONE; mesh.vertex_ids() as usize];
        for (&v, hit) in vertices.iter().zip(self.reference.closest_many(&points)) {
            near[v as usize] = hit.triangle;
        }
        near
    }

    fn smooth(&self, mesh: &mut QuadMesh, iterations: u32, watch: &dyn Watch) -> Result<(), MeshError> {
        let polygons = lower(mesh, &[String::new()])?;
        let options = SmoothOptions { iterations, ..self.smooth.clone() };
        let (points, _) = smooth::smooth(
            &polygons.mesh,
            &polygons.held,
            self.reference,
            (&options, self.relax),
            Some(self.budget),
            watch,
        );
        for (&v, point) in polygons.vertex_ids.iter().zip(points) {
            mesh.set_position(v, point);
        }
        mesh.commit();
        Ok(())
    }
}
