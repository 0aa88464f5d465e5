//! Finding the best edit for one irregular element, on a copy of the mesh that is left as it was.

use super::clusters::{Clusters, Limits};
use super::contact::Contact;
use super::cost::CostOptions;
use super::crossings::{Bounds, Crossings};
use super::edit::{Edit, walk_terms};
use super::gate::{Failure, Gate, Passed, Price, Rejected, Setting, Shape};
use super::global::Group;
use super::movement::MovementGraph;
use super::{PlanOptions, local};
use crate::mesh::Point;
use crate::moves::Dipole;
use crate::ops::Op;
use crate::patch::embed::OldPatch;
use crate::patch::{Refill, Region, fillings};
use crate::sqrtcc::{Changes, QuadMesh, Vertex};
use crate::surface::SharpLines;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// An edit that passed the gate, not yet made.
#[derive(Debug, Clone)]
pub struct Proposal {
    /// The edit.
    pub edit: Edit,
    /// The irregular element that it began with.
    pub seed: Vertex,
    /// Irregular elements fewer.
    pub gain: u32,
    /// Cost of the path; of a refill, that of its irregular faces.
    pub cost: f64,
    /// Growth of Σ |angle − ideal|, degrees.
    pub angle_growth: f64,
    /// How well shaped its surroundings are.
    pub shape: Shape,
    /// By how much less its quads lack to a fair scaled Jacobian, in all.
    pub mended: f64,
    /// Growth of Σ squared distance of the probes, in squared units of the file.
    pub distance_growth: f64,
    /// Change of the number of faces.
    pub faces_added: i64,
    /// Vertices whose connectivity it changes: sorted.
    pub touched: Vec<Vertex>,
    /// Those and their neighbours: sorted.
    pub core: Vec<Vertex>,
    /// Where vertices go, and a triangle of the reference there.
    pub moved: Vec<(Vertex, Point, u32)>,
}

impl Proposal {
    /// Where vertices go, on a mesh where new vertices get numbers from `first_new` on instead of
    /// from `planned` on.
    pub fn moved_to(
        &self,
        planned: u32,
        first_new: u32,
    ) -> impl Iterator<Item = (Vertex, Point, u32)> + '_ {
        let number = move |v| if v >= planned { v - planned + first_new } else { v };
        self.moved.iter().map(move |&(v, point, triangle)| (number(v), point, triangle))
    }
}

/// Pairs of a face with five corners or more, among `vertices`, and an interior vertex of three
/// edges at it, whether either is irregular in its place or not.
pub(super) fn t_junctions(mesh: &QuadMesh, vertices: &[Vertex]) -> usize {
    let exists = |&&v: &&Vertex| v < mesh.vertex_ids() && mesh.is_alive(v);
    let large = |&&f: &&Vertex| mesh.is_face(f) && !mesh.is_ghost(f) && mesh.valence(f) > 4;
    let hanging =
        |v: &Vertex| mesh.valence(*v) == 3 && mesh.neighbours(*v).all(|f| !mesh.is_ghost(f));
    let faces = vertices.iter().filter(exists).filter(large);
    faces.map(|&f| mesh.neighbours(f).filter(hanging).count()).sum()
}

/// What came of looking for an edit.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The best edit that passed.
    pub proposal: Option<Proposal>,
    /// Edits that the gate turned down.
    pub failures: Vec<Failure>,
    /// The lowest exchange rate at which one of them might have passed.
    pub needs: f64,
    /// Whether larger patches may have more to offer.
    pub limited: bool,
    /// Refills among them: what is refilled how, and at which exchange rate it might have passed.
    pub hopeless: Vec<(RefillKey, f64)>,
    /// Vertices on which the outcome depends: without a change there it will be the same.
    pub scope: Vec<Vertex>,
}

impl Outcome {
    /// Nothing found yet around `seed`.
    #[must_use]
    pub fn of(seed: Vertex) -> Self {
        Self {
            proposal: None,
            failures: Vec::new(),
            needs: f64::INFINITY,
            limited: false,
            hopeless: Vec::new(),
            scope: vec![seed],
        }
    }

    fn turn_down(&mut self, rejected: Rejected) {
        self.failures.push(rejected.failure);
        self.needs = self.needs.min(rejected.needs);
    }
}

/// Names a refill: a hash of its faces, and the number of the filling.
pub type RefillKey = (u64, usize);

/// What is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Local reductions and walks.
    Moves,
    /// T-junctions turned into dual ones: a triangle is easier on the eye than a hanging vertex.
    Types,
    /// Operations at quads that are folded or nearly so, after which they are better.
    Poor,
    /// Refills of patches.
    Refills,
    /// Refills of patches, each around a group of the global plan.
    Groups,
    /// Features resampled, with refills on all their sides.
    Crossings,
    /// Refills that leave as many elements, at places that suit the surface better. The exchange
    /// rate is negative: what must be saved.
    Relocations,
}

impl Stage {
    /// Whether what failed is not looked for again just because elements far away have moved: the
    /// search takes longer than it is worth. Refills that failed are remembered one by one.
    #[must_use]
    pub fn is_remembered(self) -> bool {
        matches!(self, Self::Moves | Self::Crossings)
    }

    /// Whether vertices of features slide while an edit is judged: small edits and those that
    /// resample features need it; refills do as well against a rim that stands still.
    #[must_use]
    pub fn slides(self) -> bool {
        matches!(self, Self::Moves | Self::Crossings)
    }
}

/// All that a worker needs to know.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// What to look for.
    pub stage: Stage,
    /// Most faces of a patch, or of all patches beside a feature.
    pub faces: usize,
    /// The groups of the global plan, by the member that stands for each.
    pub groups: &'a BTreeMap<Vertex, Group>,
    /// Degrees of corner angle that an irregular element less may cost.
    pub lambda: f64,
    /// The knobs of the search.
    pub plan: &'a PlanOptions,
    /// The weights of the steps.
    pub costs: &'a CostOptions,
    /// The gate.
    pub gate: Setting<'a>,
    /// The sharp features of the reference.
    pub lines: &'a SharpLines,
}

/// How many faces the mesh may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Size {
    /// Faces at the start.
    pub start: i64,
    /// Faces now.
    pub now: i64,
    /// Largest |ln| of the number of faces over that of the start.
    pub drift: f64,
}

impl Size {
    /// Whether so many more faces keep within the limit, or at least come nearer to it.
    #[must_use]
    pub fn allows(self, added: i64) -> bool {
        let drift = |faces: i64| (faces as f64 / self.start.max(1) as f64).ln().abs();
        let after = drift(self.now + added);
        after <= self.drift || after <= drift(self.now)
    }
}

/// How many faces more there are since there were `ids` vertices of Q; all that has come or gone since
/// is among `touched`.
fn faces_added(mesh: &QuadMesh, touched: &[Vertex], ids: u32) -> i64 {
    let change = |&v: &Vertex| i64::from(mesh.is_alive(v)) - i64::from(v < ids);
    touched.iter().filter(|&&v| mesh.is_face(v)).map(change).sum()
}

/// A copy of the mesh, and the arrays that planning needs.
#[derive(Debug, Clone, Default)]
pub struct Worker {
    mesh: QuadMesh,
    /// How many of the changes it has taken over; nothing if the mesh is not a copy yet.
    taken: Option<usize>,
    gate: Gate,
    clusters: Clusters,
    crossings: Crossings,
}

/// What failed is tried again once the exchange rate comes this near to what it needed: the mesh
/// has been smoothed since.
pub(super) const FORGIVING: f64 = 1.25;
/// Irregularity that the end of a T-junction may cost where there is no other way.
pub(super) const MOST_LOSS: u32 = 2;
/// How much better poor quads must become, in scaled Jacobian, for the elements that it costs.
const WORTH_MENDING: f64 = 0.1;
/// Ways to resolve a T-junction, or to turn a quad right, that are judged.
const MOST_TYPE_CHANGES: usize = 24;

/// What is known while planning.
#[derive(Debug, Clone, Copy)]
pub struct Context<'a> {
    /// What is looked for.
    pub task: &'a Task<'a>,
    /// Where the mesh touches the reference.
    pub contact: &'a Contact,
    /// How large the mesh is and may get.
    pub size: Size,
    /// Refills that are known to fail.
    pub hopeless: &'a FxHashMap<RefillKey, f64>,
    /// Refills that were turned down in this round: seeds near one another try the same ones.
    pub turned_down: &'a Mutex<FxHashMap<RefillKey, Rejected>>,
}

/// What is locked is whole even if a thread panicked: entries are only added.
fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A candidate: elements fewer, cost, edit.
type Candidate = (u32, f64, Edit);

impl Worker {
    /// Takes over the state of the mesh: as a whole at first, later what is new in `changes`, to
    /// which each round adds what it did. O(what is new).
    pub fn sync(&mut self, mesh: &QuadMesh, changes: &[Changes]) {
        match self.taken {
            Some(taken) => changes[taken..].iter().for_each(|c| self.mesh.follow(mesh, c)),
            None => self.mesh.clone_from(mesh),
        }
        self.taken = Some(changes.len());
        self.crossings.forget();
    }

    /// The best edit that begins with `seed`.
    pub fn propose(&mut self, seed: Vertex, context: Context) -> Outcome {
        let mut outcome = Outcome::of(seed);
        match context.task.stage {
            Stage::Moves => self.propose_move(seed, context, &mut outcome),
            Stage::Types => self.propose_type_change(seed, context, &mut outcome),
            Stage::Poor => self.propose_mending(seed, context, &mut outcome),
            Stage::Refills => self.propose_refill((seed, 1), context, &mut outcome),
            Stage::Groups => self.propose_group(seed, context, &mut outcome),
            Stage::Crossings => self.propose_crossing(seed, context, &mut outcome),
            Stage::Relocations => self.propose_refill((seed, 0), context, &mut outcome),
        }
        outcome.limited = self.clusters.take_limited() | self.crossings.take_limited();
        outcome.scope.sort_unstable();
        outcome.scope.dedup();
        // Those of all seeds are kept, and most of it was said more than once.
        outcome.scope.shrink_to_fit();
        outcome
    }

    fn propose_move(&mut self, seed: Vertex, context: Context, outcome: &mut Outcome) {
        let task = context.task;
        let mut candidates = self.reductions(seed, task.plan);
        let handles: Vec<Dipole> = self
            .mesh
            .outgoing(seed)
            .flat_map(|h| [Dipole(h), Dipole(self.mesh.twin(h))])
            .filter(|d| d.stands(&self.mesh))
            .collect();
        for dipole in handles {
            candidates.extend(self.walks(dipole, task));
        }
        candidates.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.total_cmp(&b.1)));
        for candidate in candidates.into_iter().take(task.plan.tries as usize) {
            let sweeps = task.gate.options.sweeps;
            let price = Price::of(candidate.0, task.lambda);
            if let Ok(proposal) = self.attempt(seed, candidate, (sweeps, price), context, outcome) {
                outcome.proposal = Some(proposal);
                return;
            }
        }
    }

    /// The one or two operations at a face with a T-junction after which there are fewer.
    fn propose_type_change(&mut self, seed: Vertex, context: Context, outcome: &mut Outcome) {
        if !self.mesh.is_face(seed) || t_junctions(&self.mesh, &[seed]) == 0 {
            return;
        }
        let hangs = |&v: &Vertex| self.mesh.valence(v) == 3;
        let near: Vec<Vertex> =
            std::iter::once(seed).chain(self.mesh.neighbours(seed).filter(hangs)).collect();
        let resolves = |worker: &mut Self, ops: &[Op]| worker.t_junctions_made(ops) < 0;
        self.propose_best(seed, &near, (resolves, |_| true), context, outcome);
    }

    /// The one or two operations at a poor quad after which there is a better one; such as make a
    /// T-junction only if there are no others.
    fn propose_mending(&mut self, seed: Vertex, context: Context, outcome: &mut Outcome) {
        let near: Vec<Vertex> = std::iter::once(seed).chain(self.mesh.neighbours(seed)).collect();
        for most in [0, i32::MAX] {
            let wanted = |worker: &mut Self, ops: &[Op]| worker.t_junctions_made(ops) <= most;
            let works = |p: &Proposal| p.mended > WORTH_MENDING;
            self.propose_best(seed, &near, (wanted, works), context, outcome);
            if outcome.proposal.is_some() {
                return;
            }
        }
    }

    /// The operations that cost the least angle, at the same E or else a little more, of those that
    /// are `wanted` and `work`.
    fn propose_best(
        &mut self,
        seed: Vertex,
        near: &[Vertex],
        (wanted, works): (impl Fn(&mut Self, &[Op]) -> bool, impl Fn(&Proposal) -> bool),
        context: Context,
        outcome: &mut Outcome,
    ) {
        let depths = 1..=context.task.plan.depth;
        for (most, depth) in
            [0, MOST_LOSS].into_iter().flat_map(|most| depths.clone().map(move |d| (most, d)))
        {
            let mut ways = Vec::new();
            for &v in near {
                ways.extend(local::sequences(&mut self.mesh, v, depth, most as i32));
            }
            ways.retain(|(_, ops)| wanted(self, ops));
            for (_, ops) in ways.into_iter().take(MOST_TYPE_CHANGES) {
                let edit = Edit::TypeChange { ops };
                let sweeps = context.task.gate.options.sweeps;
                let best = outcome.proposal.as_ref().map_or(f64::INFINITY, |p| p.angle_growth);
                let price = Price { most: best, ..Price::of(1, context.task.lambda) };
                let candidate = (0, 1.0, edit);
                let found = self.attempt(seed, candidate, (sweeps, price), context, outcome).ok();
                outcome.proposal =
                    found.filter(|p| works(p) && p.angle_growth < best).or(outcome.proposal.take());
            }
            if outcome.proposal.is_some() {
                return;
            }
        }
    }

    /// How many T-junctions more there are after the operations.
    fn t_junctions_made(&mut self, ops: &[Op]) -> i32 {
        let mark = self.mesh.mark();
        let done = ops.iter().try_for_each(|op| op.run(&mut self.mesh).map(drop)).is_ok();
        let around = self.with_neighbours(&self.mesh.touched_since(mark));
        let after = t_junctions(&self.mesh, &around);
        self.mesh.undo_to(mark);
        let made = after as i32 - t_junctions(&self.mesh, &around) as i32;
        if done { made } else { i32::MAX }
    }

    fn reductions(&mut self, seed: Vertex, plan: &PlanOptions) -> Vec<Candidate> {
        let found = local::reductions(&mut self.mesh, seed, plan.depth);
        let candidates = found.into_iter().take(plan.tries as usize);
        candidates
            .map(|(delta, ops)| (delta.unsigned_abs(), ops.len() as f64, Edit::Local { ops }))
            .collect()
    }

    /// The cheapest ways for a dislocation to be absorbed.
    fn walks(&mut self, start: Dipole, task: &Task) -> Vec<Candidate> {
        let graph = MovementGraph::new(&mut self.mesh, start, task.plan.reach as u16, task.costs);
        let (mut goals, mut found) = (Vec::new(), Vec::new());
        for _ in 0..task.plan.tries {
            let Some((node, cost)) = graph.search(&goals) else { break };
            goals.push(node);
            found.push((node, cost, graph.steps(node), graph.gain(node)));
        }
        let paths: Vec<_> = found
            .into_iter()
            .filter_map(|(n, c, s, g)| Some((c, s, g, graph.cancellation(n)?)))
            .collect();
        drop(graph);
        paths
            .into_iter()
            .map(|(cost, steps, gain, cancellation)| {
                let terms = walk_terms(&mut self.mesh, start, &steps, task.costs);
                (gain, cost, Edit::Walk { cancellation, start, steps, terms })
            })
            .collect()
    }

    fn propose_refill(
        &mut self,
        (seed, least_gain): (Vertex, u32),
        context: Context,
        outcome: &mut Outcome,
    ) {
        let partners = context.task.plan.partners as usize;
        let limits = Limits { faces: context.task.faces, partners, least_gain };
        let regions = self.clusters.around(&self.mesh, seed, limits);
        self.refill_first((seed, least_gain), regions, context, outcome);
    }

    /// A refill around a group of the global plan.
    fn propose_group(&mut self, seed: Vertex, context: Context, outcome: &mut Outcome) {
        let Some(group) = context.task.groups.get(&seed) else { return };
        let limits = Limits { faces: context.task.faces, partners: 0, least_gain: 1 };
        outcome.scope.extend(&group.ways);
        let region = self.clusters.joining(&self.mesh, &group.ways, limits);
        self.refill_first((seed, 1), region.into_iter().collect(), context, outcome);
    }

    /// The first crossing that passes.
    fn propose_crossing(&mut self, seed: Vertex, context: Context, outcome: &mut Outcome) {
        let (plan, faces) = (context.task.plan, context.task.faces);
        let (edges, partners) = (plan.crossings as usize, plan.partners as usize);
        let bounds = Bounds { edges, faces, partners, tries: plan.tries as usize };
        let found = self.crossings.around(&mut self.mesh, seed, context.task.lines, bounds);
        for (gain, crossing) in found {
            let faces: usize = crossing.refills.iter().map(|r| r.faces.len()).sum();
            let sweeps = context.task.gate.options.refill_sweeps + (faces as f64).sqrt() as u32;
            let candidate = (gain, 0.0, Edit::Crossing(crossing));
            let price = Price::of(gain, context.task.lambda);
            if let Ok(proposal) = self.attempt(seed, candidate, (sweeps, price), context, outcome) {
                outcome.proposal = Some(proposal);
                return;
            }
        }
    }

    /// The best refill of the first of the regions that has one.
    fn refill_first(
        &mut self,
        (seed, least_gain): (Vertex, u32),
        regions: Vec<Region>,
        context: Context,
        outcome: &mut Outcome,
    ) {
        if let Some(largest) = regions.last() {
            outcome.scope.extend(largest.faces.iter().chain(&largest.interior));
        }
        for region in regions {
            if let Some(best) = self.best_filling((seed, least_gain), &region, context, outcome) {
                outcome.proposal = Some(best);
                return;
            }
        }
    }

    /// The filling of a region that passes with the least growth of angles and cost of its types.
    fn best_filling(
        &mut self,
        (seed, least_gain): (Vertex, u32),
        region: &Region,
        context: Context,
        outcome: &mut Outcome,
    ) -> Option<Proposal> {
        let task = context.task;
        let sweeps = task.gate.options.refill_sweeps + (region.faces.len() as f64).sqrt() as u32;
        let (mut best, mut embedded): (Option<Proposal>, Option<OldPatch>) = (None, None);
        let set = region.key();
        let is_irregular = |&&f: &&Vertex| self.mesh.valence(f) != 4;
        let irregular_faces = region.faces.iter().filter(is_irregular).count();
        let all = fillings(region.rim.len(), &region.corners, task.plan.fillings as usize);
        for (number, filling) in all.into_iter().enumerate() {
            let key = (set, number);
            let after = region.rim_irregularity_after + filling.irregularity();
            let growth = (filling.face_count() as f64 / region.faces.len() as f64).ln().abs();
            let known =
                context.hopeless.get(&key).is_some_and(|&needs| needs > FORGIVING * task.lambda);
            if after + least_gain > region.irregularity || growth > task.gate.options.area || known
            {
                continue;
            }
            if let Some(rejected) = lock(context.turned_down).get(&key) {
                outcome.turn_down(*rejected);
                let rim = region.rim.iter().map(|&h| self.mesh.target(h));
                outcome.scope.extend(region.faces.iter().chain(&region.interior).copied());
                outcome.scope.extend(rim);
                continue;
            }
            let gain = region.irregularity - after;
            let turned = filling.irregular_faces() as f64 - irregular_faces as f64;
            let extra = task.costs.face * turned;
            let patch = embedded.get_or_insert_with(|| OldPatch::new(&self.mesh, region));
            let Ok(refill) = Refill::of(&self.mesh, (region, patch), filling) else { continue };
            let edit = Edit::Refill(refill);
            let least = best.as_ref().map_or(f64::INFINITY, |b| b.angle_growth + b.cost);
            let price = Price { extra, most: least - extra, ..Price::of(gain, task.lambda) };
            match self.attempt(seed, (gain, extra, edit), (sweeps, price), context, outcome) {
                Ok(p) if p.angle_growth + p.cost < least => best = Some(p),
                // There may be room for it again later.
                Ok(_) | Err(Some(Rejected { failure: Failure::Size, .. })) => (),
                Err(rejected) => {
                    let needs = rejected.map_or(f64::INFINITY, |r| r.needs);
                    outcome.hopeless.push((key, needs));
                    lock(context.turned_down).extend(rejected.map(|r| (key, r)));
                }
            }
        }
        best
    }

    /// Makes an edit, has it judged, and undoes it; or why it was turned down, if it could be made.
    fn attempt(
        &mut self,
        seed: Vertex,
        (gain, cost, edit): Candidate,
        (sweeps, price): (u32, Price),
        context: Context,
        outcome: &mut Outcome,
    ) -> Result<Proposal, Option<Rejected>> {
        let task = context.task;
        let (mark, ids) = (self.mesh.mark(), self.mesh.vertex_ids());
        edit.run(&mut self.mesh).map_err(|_| None)?;
        let touched = self.mesh.touched_since(mark);
        let core = self.with_neighbours(&touched);
        let faces_added = faces_added(&self.mesh, &touched, ids);
        let judged = if context.size.allows(faces_added) {
            let setting = (&task.gate, context.contact);
            self.gate.judge(&mut self.mesh, (mark, &touched), setting, (sweeps, price))
        } else {
            self.mesh.undo_to(mark);
            Err(Failure::Size.into())
        };
        match judged {
            Ok(Passed { angle_growth, shape, mended, distance_growth, moved }) => Ok(Proposal {
                edit,
                seed,
                gain,
                cost,
                angle_growth,
                shape,
                mended,
                distance_growth,
                faces_added,
                touched,
                core,
                moved,
            }),
            Err(rejected) => {
                outcome.turn_down(rejected);
                outcome.scope.extend(touched.iter().filter(|&&v| v < self.mesh.vertex_ids()));
                Err(Some(rejected))
            }
        }
    }

    fn with_neighbours(&self, touched: &[Vertex]) -> Vec<Vertex> {
        let alive = touched.iter().filter(|&&v| self.mesh.is_alive(v) && !self.mesh.is_ghost(v));
        let mut core: Vec<Vertex> = alive.flat_map(|&v| self.mesh.neighbours(v)).collect();
        core.extend(touched);
        core.sort_unstable();
        core.dedup();
        core
    }
}
