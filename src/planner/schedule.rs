//! Rounds of planning and committing.
//!
//! All irregular elements are planned for in parallel on copies of the same state; the proposals
//! are sorted by gain, cost and id and committed in that order, as long as the places they change
//! have not been changed in this round; the rest is planned again. The result therefore does not
//! depend on the number of threads.

use super::contact::Contact;
use super::edit::Edit;
use super::gate::{Failure, shape_of};
use super::worker::{
    Context, FORGIVING, MOST_LOSS, Outcome, Proposal, RefillKey, Size, Stage, Task, Worker,
};
use crate::mesh::Point;
use crate::sqrtcc::{Changes, QuadMesh, Vertex};
use crate::watch::{Phase, Watch};
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// An edit that was made.
#[derive(Debug, Clone, Serialize)]
pub struct EditRecord {
    /// The round in which it was made, from 1.
    pub round: u32,
    /// Irregular elements fewer; negative where a T-junction was worth more.
    pub gain: i32,
    /// Cost of the path; of a refill, that of its irregular faces.
    pub cost: f64,
    /// Growth of Σ |angle − ideal| around it, degrees.
    pub angle_growth_deg: f64,
    /// Where it was made.
    pub place: [f64; 3],
    /// What was done, in numbers that are valid after the edits before it.
    #[serde(flatten)]
    pub edit: Edit,
}

/// What a round did.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct RoundRecord {
    /// Degrees of corner angle that an element less could cost.
    pub lambda: f64,
    /// Elements that edits were looked for.
    pub seeds: usize,
    /// Edits proposed.
    pub proposed: usize,
    /// Edits made.
    pub made: usize,
    /// Edits that the gate turned down, by reason.
    pub turned_down: BTreeMap<Failure, usize>,
    /// Irregularity after the round, boundaries and features included.
    pub irregularity: u64,
}

/// A seed for which nothing was found.
#[derive(Debug, Clone)]
struct Failed {
    round: u32,
    season: u32,
    /// Without a change here it will be the same again …
    scope: Vec<Vertex>,
    /// … until the exchange rate comes near this,
    needs: f64,
    /// or patches may have more faces than this.
    faces: usize,
}

/// Where more than half of the proposals meet others, seeds are taken this many steps farther apart,
const WIDER: u32 = 2;
/// as long as so many are made in a round: enough for all threads.
const MANY: usize = 16;
/// What failed for another reason than its price may pass in the next season.
const AT_ANY_RATE: (f64, usize) = (f64::NEG_INFINITY, usize::MAX);

/// What all edits together may still use up.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Slack {
    /// Growth of Σ squared distance of the probes, in squared units of the file.
    pub distance: f64,
    /// Growth of Σ |angle − ideal| over all corners, degrees.
    pub angles: f64,
}

/// The state of planning over all rounds.
#[derive(Debug)]
pub struct Schedule {
    workers: Vec<Mutex<Worker>>,
    /// What each round since the last rest has written.
    changes: Vec<Changes>,
    /// The round in which the connectivity around a vertex last changed.
    changed: Vec<u32>,
    /// Seeds for which nothing was found, by what was looked for.
    failed: BTreeMap<(Stage, Vertex), Failed>,
    round: u32,
    /// How often the rules have changed.
    season: u32,
    /// Refills that failed, and the exchange rate at which they might have passed.
    hopeless: FxHashMap<RefillKey, f64>,
    spacing: Spacing,
    /// Steps beside [`PlanOptions::spacing`](super::PlanOptions::spacing) that seeds are apart.
    spread: u32,
    slack: Slack,
    size: Size,
    /// The edits made so far.
    pub edits: Vec<EditRecord>,
    /// The rounds so far.
    pub rounds: Vec<RoundRecord>,
}

impl Schedule {
    /// Nothing done yet to a mesh of this size; one worker for each thread of the pool that it is
    /// called in.
    #[must_use]
    pub fn new(size: Size) -> Self {
        let workers = (0..rayon::current_num_threads()).map(|_| Mutex::default()).collect();
        Self {
            workers,
            changes: Vec::new(),
            changed: Vec::new(),
            failed: BTreeMap::new(),
            round: 0,
            season: 0,
            hopeless: FxHashMap::default(),
            spacing: Spacing::default(),
            spread: 0,
            slack: Slack::default(),
            size,
            edits: Vec::new(),
            rounds: Vec::new(),
        }
    }

    /// The rules have changed, or the mesh has: what failed may be tried again. From now on edits
    /// may use up `slack`.
    pub fn restart(&mut self, slack: Slack) {
        self.season += 1;
        self.spread = 0;
        self.slack = slack;
    }

    /// What failed for its shape or distance may be tried again too, as if nothing were known of it:
    /// early on elements stand so close together that an edit may fail for the poor faces around it,
    /// and a crowd that is left where all has failed once would stay for good.
    pub fn forgive(&mut self) {
        self.failed.retain(|_, failed| failed.needs.is_finite());
        self.hopeless.retain(|_, needs| needs.is_finite());
    }

    /// Gives back the memory of planning, which takes several times that of the mesh; after that
    /// anything may write to it.
    pub fn rest(&mut self) {
        self.changes.clear();
        for worker in &mut self.workers {
            *worker.get_mut().unwrap_or_else(PoisonError::into_inner) = Worker::default();
        }
    }

    /// Measures anew what sectors at features want.
    ///
    /// *Precondition:* no round since [`Self::rest`].
    pub fn measure(&mut self, mesh: &mut QuadMesh) {
        let ideals = mesh.measured_ideals();
        let Some(first) = ideals.first() else { return };
        let place = mesh.position(mesh.origin(first.first)).coords.into();
        let before = mesh.total_irregularity() as i32;
        let edit = Edit::Ideals { ideals };
        if edit.run(mesh).is_ok() {
            mesh.commit();
            let gain = before - mesh.total_irregularity() as i32;
            let round = self.round;
            let record = EditRecord { round, gain, cost: 0.0, angle_growth_deg: 0.0, place, edit };
            self.edits.push(record);
        }
    }

    /// Forgets what is of use to moves and refills only, and measurements after which nothing was
    /// edited.
    pub fn finish(&mut self) {
        self.failed.clear();
        self.hopeless = FxHashMap::default();
        let last = self.edits.iter().rposition(|r| !matches!(r.edit, Edit::Ideals { .. }));
        self.edits.truncate(last.map_or(0, |i| i + 1));
    }

    /// What edits may still use up.
    #[must_use]
    pub fn slack(&self) -> Slack {
        self.slack
    }

    /// One round; whether there was something left to try.
    ///
    /// *Precondition:* nothing but rounds has written to the mesh since [`Self::rest`].
    pub fn round(
        &mut self,
        (mesh, contact): (&mut QuadMesh, &mut Contact),
        task: &Task,
        watch: &dyn Watch,
    ) -> bool {
        self.round += 1;
        let seeds = self.seeds(mesh, task);
        if seeds.is_empty() {
            return false;
        }
        let outcomes = self.plan((mesh, contact), &seeds, task, watch);
        let mut record =
            RoundRecord { lambda: task.lambda, seeds: seeds.len(), ..RoundRecord::default() };
        let mut proposals = Vec::new();
        for (seed, outcome) in seeds.into_iter().zip(outcomes) {
            self.hopeless.extend(outcome.hopeless);
            for failure in outcome.failures {
                *record.turned_down.entry(failure).or_default() += 1;
            }
            if let Some(proposal) = outcome.proposal {
                proposals.push((proposal, outcome.scope));
            } else {
                let faces = if outcome.limited { task.faces } else { usize::MAX };
                self.fail((seed, outcome.scope), task, (outcome.needs, faces));
            }
        }
        record.proposed = proposals.len();
        record.made = self.commit((mesh, contact), proposals, task);
        self.spread = if record.made < MANY {
            0
        } else if record.made * 2 < record.proposed {
            self.spread + WIDER
        } else {
            self.spread
        };
        record.irregularity = mesh.total_irregularity();
        watch.edited(self.edits.len(), record.irregularity);
        self.rounds.push(record);
        true
    }

    /// Irregular elements that have not failed, or around which something has changed since, and
    /// that are some steps apart: neighbours would mostly propose the same edit.
    fn seeds(&mut self, mesh: &QuadMesh, task: &Task) -> Vec<Vertex> {
        self.changed.resize(mesh.vertex_ids() as usize, 0);
        let is_changed = |f: &Failed| f.scope.iter().any(|&s| self.changed[s as usize] >= f.round);
        let may_pass = |f: &Failed| {
            f.season < self.season
                && (!task.stage.is_remembered()
                    || f.needs <= FORGIVING * task.lambda
                    || f.faces < task.faces)
        };
        let fresh = |&v: &Vertex| {
            let known = self.failed.get(&(task.stage, v));
            known.is_none_or(|f| may_pass(f) || is_changed(f))
        };
        if task.stage == Stage::Groups {
            return task.groups.keys().copied().collect();
        }
        if task.stage == Stage::Poor {
            let is_poor = |&f: &Vertex| is_poor(mesh, f, task.gate.options.min_jacobian);
            return mesh.vertices().filter(fresh).filter(is_poor).collect();
        }
        let fresh: Vec<Vertex> = mesh.irregular().into_iter().filter(fresh).collect();
        self.spacing.start(mesh);
        let steps = task.plan.spacing + self.spread;
        fresh.into_iter().filter(|&v| self.spacing.take(mesh, v, steps)).collect()
    }

    /// Remembers that nothing was found for a seed, and what it takes for a further try.
    fn fail(
        &mut self,
        (seed, scope): (Vertex, Vec<Vertex>),
        task: &Task,
        (needs, faces): (f64, usize),
    ) {
        let failed = Failed { round: self.round, season: self.season, scope, needs, faces };
        self.failed.insert((task.stage, seed), failed);
    }

    fn plan(
        &self,
        (mesh, contact): (&QuadMesh, &Contact),
        seeds: &[Vertex],
        task: &Task,
        watch: &dyn Watch,
    ) -> Vec<Outcome> {
        let turned_down = &Mutex::default();
        let context =
            Context { task, contact, size: self.size, hopeless: &self.hopeless, turned_down };
        // Not by the workers: what a thread gives back, glibc keeps for that thread.
        for worker in &self.workers {
            lock(worker).sync(mesh, &self.changes);
        }
        let done = std::sync::atomic::AtomicUsize::new(0);
        let left = mesh.total_irregularity() as usize;
        // Seeds that follow one another are near each other on the reference: what one has looked up
        // is still at hand for the next.
        let mut order: Vec<u32> = (0..seeds.len() as u32).collect();
        let place = |&i: &u32| contact.near_element(mesh, seeds[i as usize]);
        order.sort_by_cached_key(place);
        let mut outcomes: Vec<(u32, Outcome)> = order
            .into_par_iter()
            .with_max_len(1)
            .map(|i| {
                let seed = seeds[i as usize];
                if watch.cancelled() {
                    return (i, Outcome::of(seed));
                }
                let index = rayon::current_thread_index().unwrap_or(0);
                let mut worker = lock(&self.workers[index % self.workers.len()]);
                let outcome = worker.propose(seed, context);
                drop(worker);
                let count = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
                watch.progress(Phase::Plan, count, seeds.len(), Some(left));
                (i, outcome)
            })
            .collect();
        outcomes.sort_unstable_by_key(|&(i, _)| i);
        outcomes.into_iter().map(|(_, outcome)| outcome).collect()
    }

    /// Makes the proposals, best first, that do not meet one made before them in this round.
    fn commit(
        &mut self,
        (mesh, contact): (&mut QuadMesh, &mut Contact),
        mut proposals: Vec<(Proposal, Vec<Vertex>)>,
        task: &Task,
    ) -> usize {
        proposals.sort_by(|(a, _), (b, _)| {
            let value = |p: &Proposal| f64::from(p.gain) * task.lambda.max(1.0) - p.angle_growth;
            b.gain.cmp(&a.gain).then(value(b).total_cmp(&value(a))).then(a.seed.cmp(&b.seed))
        });
        let planned = (mesh.vertex_ids(), mesh.quad_ids());
        // Vertices that an edit of this round has moved; others leave them unless they must not.
        let mut taken = FxHashSet::default();
        let mut made = 0;
        for (mut proposal, scope) in proposals {
            let free = |&v: &Vertex| v >= planned.0 || self.changed[v as usize] < self.round;
            if !proposal.touched.iter().all(free) {
                continue;
            }
            if !self.affordable(&proposal) {
                self.fail((proposal.seed, scope), task, AT_ANY_RATE);
                continue;
            }
            let moved = proposal.moved.iter().map(|m| m.0);
            contact.expect(mesh, proposal.touched.iter().copied().chain(moved));
            let (first_new, mark) = (mesh.vertex_ids(), mesh.mark());
            let ids = (mesh.vertex_ids(), mesh.quad_ids());
            proposal.edit = proposal.edit.rebased(planned, ids);
            let Some(gain) = makes(mesh, &proposal) else {
                self.fail((proposal.seed, scope), task, AT_ANY_RATE);
                continue;
            };
            let moved = proposal.moved_to(planned.0, first_new);
            let moved: Vec<_> = moved
                .filter(|m| !(taken.contains(&m.0) && proposal.core.binary_search(&m.0).is_err()))
                .collect();
            if !places(mesh, &proposal, &moved) {
                mesh.undo_to(mark);
                self.fail((proposal.seed, scope), task, AT_ANY_RATE);
                continue;
            }
            for &(v, _, triangle) in &moved {
                contact.set_near(v, triangle);
                taken.insert(v);
            }
            contact.reassign(mesh, &mesh.touched_since(mark));
            self.record(proposal, gain, planned.0);
            made += 1;
        }
        contact.settle(mesh);
        self.changes.push(mesh.changes());
        mesh.commit();
        made
    }

    /// Whether the mesh stays within its limits of size, distance and angles.
    fn affordable(&self, proposal: &Proposal) -> bool {
        let near = proposal.distance_growth <= self.slack.distance.max(0.0);
        let square = proposal.angle_growth <= self.slack.angles.max(0.0);
        near && square && self.size.allows(proposal.faces_added)
    }

    fn record(&mut self, proposal: Proposal, gain: i32, planned: u32) {
        self.slack.distance -= proposal.distance_growth;
        self.slack.angles -= proposal.angle_growth;
        self.size.now += proposal.faces_added;
        for &v in proposal.core.iter().filter(|&&v| v < planned) {
            self.changed[v as usize] = self.round;
        }
        let place = proposal.moved.first().map_or_else(Point::origin, |m| m.1);
        self.edits.push(EditRecord {
            round: self.round,
            gain,
            cost: proposal.cost,
            angle_growth_deg: proposal.angle_growth,
            place: place.coords.into(),
            edit: proposal.edit,
        });
    }
}

/// Whether `f` is a quad of a scaled Jacobian below `least`.
pub(super) fn is_poor(mesh: &QuadMesh, f: Vertex, least: f64) -> bool {
    let is_face = mesh.is_face(f) && !mesh.is_ghost(f);
    is_face && shape_of(mesh, std::iter::once(f)).jacobian() < least
}

/// Makes the edit if it still does what was planned; how many irregular elements fewer there are.
fn makes(mesh: &mut QuadMesh, proposal: &Proposal) -> Option<i32> {
    let (mark, around) = (mesh.mark(), &proposal.core);
    let irregularity = |mesh: &QuadMesh, vertices: &[Vertex]| -> u32 {
        let alive = vertices.iter().filter(|&&v| v < mesh.vertex_ids() && mesh.is_alive(v));
        alive.map(|&v| mesh.irregularity(v)).sum()
    };
    let before = irregularity(mesh, around);
    proposal.edit.run(mesh).ok()?;
    let mut now = mesh.touched_since(mark);
    now.extend(around);
    now.sort_unstable();
    now.dedup();
    let loss = if matches!(proposal.edit, Edit::TypeChange { .. }) { MOST_LOSS } else { 0 };
    let gain = before as i32 - irregularity(mesh, &now) as i32;
    if gain + (loss as i32) < proposal.gain as i32 {
        mesh.undo_to(mark);
        return None;
    }
    Some(gain)
}

/// Moves vertices to where they relaxed; whether the quads there are then about as good as when
/// the edit was judged by itself.
fn places(mesh: &mut QuadMesh, proposal: &Proposal, moved: &[(Vertex, Point, u32)]) -> bool {
    for &(v, point, _) in moved {
        mesh.set_position(v, point);
    }
    let around = moved.iter().flat_map(|m| mesh.neighbours(m.0));
    let mut faces: Vec<Vertex> = around.filter(|&f| !mesh.is_ghost(f)).collect();
    faces.sort_unstable();
    faces.dedup();
    shape_of(mesh, faces.into_iter()).is_about_as_good_as(&proposal.shape)
}

/// Keeps chosen vertices apart.
#[derive(Debug, Default)]
struct Spacing {
    /// 1 + the number of steps for which the surroundings of a vertex are still taken.
    taken: Vec<u32>,
    queue: Vec<(Vertex, u32)>,
}

impl Spacing {
    fn start(&mut self, mesh: &QuadMesh) {
        self.taken.clear();
        self.taken.resize(mesh.vertex_ids() as usize, 0);
    }

    /// Takes `v` and what is within `steps` of it, unless it is taken.
    fn take(&mut self, mesh: &QuadMesh, v: Vertex, steps: u32) -> bool {
        if self.taken[v as usize] > 0 {
            return false;
        }
        self.queue.clear();
        self.queue.push((v, steps + 1));
        self.taken[v as usize] = steps + 1;
        let mut next = 0;
        while let Some(&(v, left)) = self.queue.get(next) {
            next += 1;
            for w in mesh.neighbours(v).filter(|_| left > 1) {
                if self.taken[w as usize] < left - 1 && !mesh.is_ghost(w) {
                    self.taken[w as usize] = left - 1;
                    self.queue.push((w, left - 1));
                }
            }
        }
        true
    }
}

/// A worker is only ever used by one thread at a time; one that panicked is as good as new once it
/// takes over the whole mesh.
fn lock(worker: &Mutex<Worker>) -> MutexGuard<'_, Worker> {
    worker.lock().unwrap_or_else(|poisoned| {
        let mut worker = poisoned.into_inner();
        *worker = Worker::default();
        worker
    })
}
