//! The automation: stage after stage of moves, refills, relocations and smoothing.

use super::PlanOptions;
use super::contact::Contact;
use super::cost::CostOptions;
use super::creases::Creases;
use super::gate::{GateOptions, Setting, shape_of};
use super::global::{self, Group, Link};
use super::lines::{self, Rails};
use super::schedule::{Schedule, Slack, is_poor};
use super::worker::{Size, Stage, Task, t_junctions};
use crate::mesh::{MeshError, Point};
use crate::moves;
use crate::smooth::{self, Budget, Orientation, RelaxOptions, SmoothOptions};
use crate::sqrtcc::{Lowered, QuadMesh, Vertex, lower};
use crate::surface::{Reference, SharpLines};
use crate::watch::Watch;
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// What the automation works with and towards.
#[derive(Debug, Clone, Copy)]
pub struct Automation<'a> {
    /// The surface to stay on.
    pub reference: &'a Reference,
    /// Its sharp features.
    pub lines: &'a SharpLines,
    /// What of its creases is sharp for at least an edge of the mesh.
    pub creases: &'a SharpLines,
    /// Angle from which edges of the reference are creases, in degrees.
    pub crease_deg: f64,
    /// How the mesh is oriented against it.
    pub orientation: Orientation,
    /// How far the mesh may be from it, in units of the file.
    pub budget: Budget,
    /// Number of faces of the input as it was read.
    pub faces: usize,
    /// Mean length of the edges of the input, in units of the file.
    pub mean_edge: f64,
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

/// Degrees of deviation at a corner that are allowed even where the input has less.
const FAIR: f64 = 2.0;
/// Share of the Hausdorff distance to keep within which vertices of features slide freely.
const SLIDES_WITHIN: f64 = 0.3;
/// Faces whose angles are added by one thread.
const CHUNK: usize = 4096;
/// How many times its even share of the slack in distance an element may use up.
const GREED: f64 = 16.0;

impl Automation<'_> {
    /// Edits and smooths `mesh`; what was done. If cancelled, no more edits are looked for, and the
    /// mesh is smoothed for as many iterations as a hurried run has.
    pub fn run(&self, mesh: &mut QuadMesh, watch: &dyn Watch) -> Result<Schedule, MeshError> {
        let faces = faces(mesh).len();
        let size =
            Size { start: self.faces as i64, now: faces as i64, drift: self.plan.size_drift };
        let mut schedule = Schedule::new(size);
        let attached = |mesh: &QuadMesh| {
            let mut contact = Contact::new(self.reference, faces);
            contact.attach(mesh, self.reference).map(|()| contact)
        };
        let mut contact = attached(mesh)?;
        let deviation = (angles(mesh) / corners(mesh)).max(FAIR);
        // Of the mean at a corner: a mesh of fewer faces may not have worse ones.
        let allowed = Slack {
            distance: contact.squares_at(self.gate.rms * self.budget.rms),
            angles: self.gate.angles * deviation,
        };
        let left = |mesh: &QuadMesh, contact: &Contact| Slack {
            distance: allowed.distance - contact.squared_distances(),
            angles: allowed.angles * corners(mesh) - angles(mesh),
        };
        self.smooth_between((mesh, &mut contact), watch)?;
        let half = self.plan.stages.div_ceil(2);
        for i in (0..self.plan.stages).take_while(|_| !watch.cancelled()) {
            watch.stage(i, self.plan.stages);
            schedule.measure(mesh);
            let (lambda, faces) = (self.plan.lambda(i), self.patch_faces(i));
            schedule.restart(left(mesh, &contact));
            if i == half {
                schedule.forgive();
            }
            let refills = (Stage::Refills, lambda);
            for step in [(Stage::Moves, lambda), refills] {
                self.rounds((mesh, &mut contact), &mut schedule, (step, faces), watch);
            }
            // Early on most elements vanish anyway: moving them first is lost work.
            if self.plan.relocations > 0 && i >= half {
                // What has moved may be near enough to others now to cancel.
                let relocations = (Stage::Relocations, -self.plan.relocation_saves);
                for step in [relocations, refills] {
                    self.rounds((mesh, &mut contact), &mut schedule, (step, faces), watch);
                }
            }
            if self.plan.crossings > 0 {
                for step in [(Stage::Crossings, lambda), refills] {
                    self.rounds((mesh, &mut contact), &mut schedule, (step, faces), watch);
                }
            }
            if i + 1 < self.plan.stages {
                schedule.rest();
                self.smooth_between((mesh, &mut contact), watch)?;
            } else {
                // After all that is greedy: so the global plan never leaves more than that alone.
                let groups = (Stage::Groups, lambda);
                self.rounds((mesh, &mut contact), &mut schedule, (groups, faces), watch);
            }
        }
        // Its memory is given back before the smoothing, which takes as much.
        let kept = |_: &QuadMesh| Ok(contact);
        self.last_rounds((mesh, kept), &mut schedule, (&[Stage::Types], left), watch)?;
        self.release_pins(mesh);
        self.smooth(mesh, self.smooth, watch)?;
        // After the pins of poor quads have been released: most of those can go back then.
        let mut settled = if watch.cancelled() { Vec::new() } else { self.settle(mesh) };
        if !settled.is_empty() {
            self.smooth(mesh, self.smooth, watch)?;
            if self.release_pins(mesh) {
                self.smooth(mesh, self.smooth, watch)?;
            }
            // Which vertex an operation keeps depends on pins, and a log does not tell these.
            settled.retain(|&v| mesh.is_pin(v));
            unpin(mesh, &settled);
        }
        // What mends a quad may make a T-junction where nothing else does.
        let rest = [Stage::Types, Stage::Poor, Stage::Types];
        if self.last_rounds((mesh, attached), &mut schedule, (&rest, left), watch)? {
            settled.retain(|&v| mesh.is_alive(v));
            for &v in &settled {
                mesh.pin(v);
            }
            self.smooth(mesh, self.smooth, watch)?;
            unpin(mesh, &settled);
        }
        if self.plan.crease_worth > 0.0 && !watch.cancelled() {
            self.draw_near(mesh, self.plan.crease_worth * deviation)?;
        }
        Ok(schedule)
    }

    /// Rounds of the kinds that come last; whether there were edits. What they do is worth its
    /// angles, whatever is left of them.
    fn last_rounds(
        &self,
        (mesh, contact): (&mut QuadMesh, impl FnOnce(&QuadMesh) -> Result<Contact, MeshError>),
        schedule: &mut Schedule,
        (stages, slack): (&[Stage], impl Fn(&QuadMesh, &Contact) -> Slack),
        watch: &dyn Watch,
    ) -> Result<bool, MeshError> {
        schedule.finish();
        // Copies are soon made again; together with the tree of the mesh they are the most there is.
        schedule.rest();
        // Looking the contact up anew takes longer than all the rest.
        if watch.cancelled() || !stages.iter().any(|&stage| self.has_seeds(mesh, stage)) {
            return Ok(false);
        }
        let before = schedule.edits.len();
        let mut contact = contact(mesh)?;
        schedule.restart(Slack { angles: f64::INFINITY, ..slack(mesh, &contact) });
        for &stage in stages {
            let step = (stage, self.plan.lambda_types);
            self.rounds((mesh, &mut contact), schedule, (step, 0), watch);
        }
        schedule.rest();
        Ok(schedule.edits.len() > before)
    }

    /// Whether there is anything to do in a stage of the kinds that come last.
    fn has_seeds(&self, mesh: &QuadMesh, stage: Stage) -> bool {
        let is_seed = |&f: &Vertex| match stage {
            Stage::Types => t_junctions(mesh, &[f]) > 0,
            _ => is_poor(mesh, f, self.gate.min_jacobian),
        };
        faces(mesh).par_iter().any(is_seed)
    }

    /// Most faces of a patch in stage `i`: no patch is most of the mesh.
    fn patch_faces(&self, i: u32) -> usize {
        let share = self.plan.patch_share * self.faces as f64;
        self.plan.patch_faces(i).min(share as usize)
    }

    /// Puts vertices that have ended up near a crease onto it, and pins them: those.
    fn settle(&self, mesh: &mut QuadMesh) -> Vec<Vertex> {
        let rails = Rails { lines: self.creases, ..self.rails() };
        rails.settle(mesh, self.plan.settles_edges * self.mean_edge)
    }

    /// Draws edges to creases, within the limits, where an edge length is worth so many degrees.
    fn draw_near(&self, mesh: &mut QuadMesh, worth_deg: f64) -> Result<(), MeshError> {
        let creases = Creases::new(self.reference, self.crease_deg, self.faces, self.mean_edge);
        let Some(creases) = creases else { return Ok(()) };
        let before = lower(mesh, &[String::new()])?;
        if creases.draw_near(mesh, self.rails(), worth_deg) {
            let moved = before.vertex_ids.iter().map(|&v| mesh.position(v)).collect();
            let options = (self.smooth, self.relax);
            let budget = Some(self.smooth_budget());
            let points = smooth::take_back(
                &before.mesh,
                &before.held,
                moved,
                self.reference,
                options,
                budget,
            );
            place(mesh, &before, points);
            mesh.commit();
        }
        Ok(())
    }

    fn rails(&self) -> Rails<'_> {
        let tolerance = SLIDES_WITHIN * self.hausdorff();
        Rails { reference: self.reference, lines: self.lines, tolerance }
    }

    /// Lets the pins of quads that are still poor move: a crease is not worth a folded quad. Whether
    /// there were any.
    fn release_pins(&self, mesh: &mut QuadMesh) -> bool {
        let is_poor = |&f: &Vertex| is_poor(mesh, f, self.gate.min_jacobian);
        let poor: Vec<Vertex> = faces(mesh).into_par_iter().filter(is_poor).collect();
        let corners = poor.iter().flat_map(|&f| mesh.neighbours(f));
        let pins: Vec<Vertex> = corners.filter(|&v| mesh.is_pin(v)).collect();
        unpin(mesh, &pins);
        !pins.is_empty()
    }

    /// Rounds of one kind until nothing more is found.
    fn rounds(
        &self,
        (mesh, contact): (&mut QuadMesh, &mut Contact),
        schedule: &mut Schedule,
        ((stage, lambda), faces): ((Stage, f64), usize),
        watch: &dyn Watch,
    ) {
        schedule.restart(schedule.slack());
        let slide = self.plan.slides > 0 && stage.slides();
        let gate = Setting {
            reference: self.reference,
            lines: self.lines,
            rails: slide.then(|| self.rails().tolerance),
            orientation: self.orientation,
            relax: self.relax,
            fit: self.smooth.fit,
            options: self.gate,
            distance: self.gate.distance * self.hausdorff(),
            growth: GREED * schedule.slack().distance.max(0.0)
                / mesh.total_irregularity().max(1) as f64,
            cover: (self.gate.cover_edges * self.mean_edge).min(self.hausdorff()),
        };
        let rounds = match stage {
            Stage::Groups => self.plan.global,
            Stage::Relocations => self.plan.relocations,
            _ => self.plan.rounds,
        };
        let mut tried = BTreeSet::new();
        for _ in 0..rounds {
            if watch.cancelled() {
                break;
            }
            let groups = match stage {
                Stage::Groups => groups(mesh, &mut tried),
                _ => BTreeMap::new(),
            };
            let task = Task {
                stage,
                lambda,
                faces,
                groups: &groups,
                plan: self.plan,
                costs: self.costs,
                gate,
                lines: self.lines,
            };
            if !schedule.round((mesh, contact), &task, watch) {
                break;
            }
        }
    }

    /// The Hausdorff distance to keep, in units of the file.
    fn hausdorff(&self) -> f64 {
        self.gate.hausdorff * self.budget.hausdorff
    }

    /// How far smoothing may take the mesh from the reference.
    fn smooth_budget(&self) -> Budget {
        Budget { hausdorff: self.hausdorff(), rms: self.smooth.budget * self.budget.rms }
    }

    /// Smooths before more edits, after which contact is looked up anew; a run that is to stop leaves
    /// that to the smoothing at its end.
    fn smooth_between(
        &self,
        (mesh, contact): (&mut QuadMesh, &mut Contact),
        watch: &dyn Watch,
    ) -> Result<(), MeshError> {
        let iterations = self.plan.smooth_between;
        // Without stages the faces are fitted to the reference at least.
        if watch.cancelled() || iterations == 0 && self.plan.stages > 0 {
            return Ok(());
        }
        let options = SmoothOptions { iterations, hurried: 0, ..self.smooth.clone() };
        self.smooth(mesh, &options, watch)?;
        // A run that is to stop makes no more edits.
        if watch.cancelled() { Ok(()) } else { contact.attach(mesh, self.reference) }
    }

    fn smooth(
        &self,
        mesh: &mut QuadMesh,
        options: &SmoothOptions,
        watch: &dyn Watch,
    ) -> Result<(), MeshError> {
        let polygons = lower(mesh, &[String::new()])?;
        let (points, _) = smooth::smooth(
            &polygons.mesh,
            &polygons.held,
            self.reference,
            (options, self.relax),
            Some(self.smooth_budget()),
            watch,
        );
        place(mesh, &polygons, points);
        lines::relax(mesh, self.rails(), self.plan.slides);
        mesh.commit();
        Ok(())
    }
}

/// Puts the vertices of a lowered mesh there.
fn place(mesh: &mut QuadMesh, polygons: &Lowered, points: Vec<Point>) {
    for (&v, point) in polygons.vertex_ids.iter().zip(points) {
        mesh.set_position(v, point);
    }
}

/// The faces of the polygon mesh. Parallel.
fn faces(mesh: &QuadMesh) -> Vec<Vertex> {
    let all = (0..mesh.vertex_ids()).into_par_iter();
    all.filter(|&f| mesh.is_alive(f) && mesh.is_face(f) && !mesh.is_ghost(f)).collect()
}

/// Lets vertices move again.
fn unpin(mesh: &mut QuadMesh, pins: &[Vertex]) {
    for &v in pins {
        mesh.unpin(v);
    }
}

/// Number of corners of all faces.
fn corners(mesh: &QuadMesh) -> f64 {
    faces(mesh).iter().map(|&f| f64::from(mesh.valence(f))).sum()
}

/// Σ |angle − ideal| over all corners, degrees. Parallel.
fn angles(mesh: &QuadMesh) -> f64 {
    let all = faces(mesh);
    let chunks = all.par_chunks(CHUNK).map(|part| shape_of(mesh, part.iter().copied()).angles());
    // Added in order: the sum does not depend on threads.
    chunks.collect::<Vec<f64>>().into_iter().sum()
}

/// The global plan for the mesh as it is, of what has not been tried; by first member.
fn groups(mesh: &QuadMesh, tried: &mut BTreeSet<Link>) -> BTreeMap<Vertex, Group> {
    let groups = global::groups(mesh, moves::path::REACH, tried);
    tried.extend(groups.iter().map(|g| g.link));
    groups.into_iter().filter_map(|g| Some((*g.members.first()?, g))).collect()
}
