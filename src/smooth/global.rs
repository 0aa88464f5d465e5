//! Smoothing a whole mesh within a budget of distance.

use fixedbitset::FixedBitSet;

use super::anchors::{Watched, pull};
use super::guard::{Budget, Finding, Guard, Limits, Mending, Trace};
use super::kernel::Setting;
use super::region::{Orientation, Region, vote};
use super::untangle::untangle;
use super::{RelaxOptions, SmoothOptions};
use crate::mesh::{NONE, Point, PolyMesh, Topology};
use crate::surface::{Deviation, Reference};
use crate::watch::{Phase, Watch};

/// Room for a budget that is met exactly: none at all and smoothing could only stand still.
const HARDLY_MORE: f64 = 1.002;

/// How smoothing a mesh went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SmoothReport {
    /// Iterations done.
    pub iterations: u32,
    /// Energy of the last one (see [`super::RelaxReport::energy`]).
    pub energy: f64,
    /// Root mean square move of the vertices in the last one, in edges.
    pub motion: f64,
    /// Distance to the reference before, in units of the file.
    pub before: Deviation,
    /// Distance to the reference after, in units of the file.
    pub after: Deviation,
    /// Least scaled Jacobian of the quads before.
    pub least_jacobian_before: f64,
    /// Least scaled Jacobian of the quads after.
    pub least_jacobian_after: f64,
    /// Vertices that were taken back, in part or altogether, to keep the limits.
    pub mended: usize,
}

/// Which vertices must stay: those on boundaries and cuts, and the ends of feature half-edges. O(n).
#[must_use]
pub fn held_vertices(mesh: &PolyMesh, topology: &Topology, features: &FixedBitSet) -> Vec<bool> {
    let mut held = vec![false; mesh.vertex_count()];
    for (h, &v) in mesh.corners().iter().enumerate() {
        if topology.twin[h] == NONE || features.contains(h) {
            held[v as usize] = true;
            held[mesh.corners()[topology.next[h] as usize] as usize] = true;
        }
    }
    held
}

/// Moves the vertices of `mesh` that are not `held` for good face shapes; the new points.
///
/// The result is within `budget` of the reference, or hardly farther than the start where that is
/// beyond it; without one, within [`SmoothOptions::budget`] times the distance of the start. If no limit can be kept anywhere,
/// the points are those of the start. If `watch` cancels, it ends after
/// [`SmoothOptions::hurried`] iterations or as soon as it can, checked alike.
/// O(iterations · n), parallel; independent of the number of threads.
///
/// # Panics
/// If there is not one entry of `held` for each vertex: that is a bug of the caller.
#[must_use]
pub fn smooth(
    mesh: &PolyMesh,
    held: &[bool],
    reference: &Reference,
    (options, relax): (&SmoothOptions, &RelaxOptions),
    budget: Option<Budget>,
    watch: &dyn Watch,
) -> (Vec<Point>, SmoothReport) {
    assert_eq!(held.len(), mesh.vertex_count(), "one entry for each vertex");
    let mut work = Work::new(mesh, held, reference, (options, relax), budget);
    let start = |work: &Work| (mesh.points().to_vec(), work.start.clone());
    let ((points, found), mended) = if work.iterate(watch) {
        work.land();
        let (result, mended) = work.mend(start(&work));
        (if result.1.is_folded() { work.unfold(result) } else { result }, mended)
    } else {
        (start(&work), 0)
    };
    let kernel = &work.region.kernel;
    let report = SmoothReport {
        iterations: kernel.iterations,
        energy: kernel.energy,
        motion: kernel.motion,
        before: work.start.deviation,
        after: found.deviation,
        least_jacobian_before: work.start.least_jacobian,
        least_jacobian_after: found.least_jacobian,
        mended,
    };
    (points, report)
}

/// Takes back moves of vertices of `mesh` to `moved`, in part or altogether, where they break the
/// limits that [`smooth`] has: the new points. O(n log n), parallel; independent of the number of
/// threads.
///
/// # Panics
/// If there is not one entry of `held`, and of `moved`, for each vertex: that is a bug of the caller.
#[must_use]
pub fn take_back(
    mesh: &PolyMesh,
    held: &[bool],
    moved: Vec<Point>,
    reference: &Reference,
    (options, relax): (&SmoothOptions, &RelaxOptions),
    budget: Option<Budget>,
) -> Vec<Point> {
    assert_eq!((held.len(), moved.len()), (mesh.vertex_count(), mesh.vertex_count()));
    let mut work = Work::new(mesh, held, reference, (options, relax), budget);
    work.mesh.set_points(moved);
    let start = (mesh.points().to_vec(), work.start.clone());
    let ((points, _), _) = work.mend(start);
    points
}

/// The limits: the budget, or, where the start is beyond it, hardly more than that; without one,
/// what follows from the start.
pub(crate) fn limits(
    start: &Finding,
    options: &SmoothOptions,
    budget: Option<Budget>,
    diagonal: f64,
) -> Limits {
    // What rounding alone does to a mesh that lies on its reference is not counted.
    let scaled = |d: f64| d * options.budget + diagonal * 1e-6;
    let Deviation { hausdorff, rms } = start.deviation;
    let limit = |budget: Option<f64>, start: f64| {
        budget.map_or(scaled(start), |budget| budget.max(HARDLY_MORE * start))
    };
    let budget = Budget {
        hausdorff: limit(budget.map(|b| b.hausdorff), hausdorff),
        rms: limit(budget.map(|b| b.rms), rms),
    };
    Limits { budget, jacobian: options.least_jacobian }
}

/// The whole mesh as a region.
fn filled(mesh: &PolyMesh, held: &[bool], side: Orientation) -> Region {
    let mut region = Region::new();
    region.begin(side);
    for (&p, &held) in mesh.points().iter().zip(held) {
        region.add_vertex(p, held, None);
    }
    mesh.faces().for_each(|f| region.add_face(f));
    region
}

/// Places of the vertices, and what the mesh is like there.
type Checked = (Vec<Point>, Finding);

/// A mesh while it is smoothed.
struct Work<'a> {
    options: &'a SmoothOptions,
    mesh: PolyMesh,
    guard: Guard<'a>,
    trace: Trace,
    limits: Limits,
    start: Finding,
    region: Region,
    setting: Setting,
}

impl<'a> Work<'a> {
    fn new(
        mesh: &'a PolyMesh,
        held: &[bool],
        reference: &'a Reference,
        (options, relax): (&'a SmoothOptions, &RelaxOptions),
        budget: Option<Budget>,
    ) -> Self {
        let mut trace = Trace::default();
        trace.follow(mesh);
        let centres = trace.at_centres(mesh, reference);
        let side = vote(mesh, reference, centres.iter().enumerate());
        let (stress, project_every) = (options.stress, options.project_every);
        let relax = RelaxOptions { stress, project_every, ..relax.clone() };
        let guard = Guard::new(reference, mesh.vertex_count(), side.sign());
        let start = guard.check_at(mesh, &centres, &mut trace);
        drop(centres);
        let limits = limits(&start, options, budget, reference.diagonal());
        let setting = Setting::new(&relax, side.sign(), true);
        let mut region = filled(mesh, held, side);
        region.kernel.prepare();
        region.kernel.find_normals(reference, &setting);
        Self { options, mesh: mesh.clone(), guard, trace, limits, start, region, setting }
    }

    /// Iterates until vertices are still, looking for lost places in between; whether there is
    /// anything to go on with.
    fn iterate(&mut self, watch: &dyn Watch) -> bool {
        let (total, hurried) = (self.options.iterations, self.options.hurried);
        let round = if self.options.anchor_every == 0 { total } else { self.options.anchor_every };
        let mut places = Watched::new(self.guard.reference, self.mesh.vertex_count());
        let stops = |done: u32| done >= hurried && watch.cancelled();
        let mut done = 0;
        while done < total && !stops(done) {
            watch.progress(Phase::Smooth, done as usize, total as usize, None);
            let count = round.min(total - done);
            let kernel = &mut self.region.kernel;
            let until = (count, self.options.still_edges);
            kernel.run((self.guard.reference, None), &self.setting, until, stops);
            done += count;
            if kernel.motion < self.options.still_edges {
                break;
            }
            if done < total && self.options.anchor_every > 0 && !stops(done) {
                let points = kernel.vertices.iter().map(|v| v.point).collect();
                self.mesh.set_points(points);
                let far = self.options.anchor_share * self.limits.budget.hausdorff;
                self.trace.follow(&self.mesh);
                if let Some(surface) = &self.trace.surface {
                    pull(kernel, (&self.mesh, surface), &mut places, far);
                }
            }
        }
        hurried > 0 || !watch.cancelled()
    }

    /// Puts the vertices where faces, not corners, lie on the reference, and unfolds quads.
    fn land(&mut self) {
        self.region.kernel.land(self.guard.reference, &self.setting);
        self.region.kernel.fit(self.guard.reference, &self.setting, self.options.fit);
        self.mesh.set_points(self.region.kernel.vertices.iter().map(|v| v.point).collect());
        self.untangle();
    }

    /// Unfolds quads where that can be done in place; whether anything has moved.
    fn untangle(&mut self) -> bool {
        let surface = (self.guard.reference, self.setting.sign);
        untangle(&mut self.mesh, &self.region.kernel, surface, self.options.least_jacobian)
    }

    /// Unfolds what is folded where moves were undone: on the way back from other places there may
    /// be room. `known` keeps the limits.
    fn unfold(&mut self, known: Checked) -> Checked {
        self.mesh.set_points(known.0.clone());
        if !self.untangle() {
            return known;
        }
        let (unfolded, _) = self.mend(known.clone());
        if unfolded.1.least_jacobian > known.1.least_jacobian { unfolded } else { known }
    }

    /// Checks the limits and undoes moves, towards `known` places that keep them, until they are
    /// kept; and how many vertices were taken back, in part or altogether.
    fn mend(&mut self, (from, known): Checked) -> (Checked, usize) {
        let kernel = &self.region.kernel;
        let moved = self.mesh.points().to_vec();
        let mut mending = Mending::new(from, moved);
        let mut found = self.guard.check(&self.mesh, &mut self.trace);
        let mut broken = found.broken(&self.start, &self.limits);
        for _ in 0..self.options.mend_rounds {
            if broken.is_empty() {
                break;
            }
            mending.lower(&self.mesh, &broken);
            let points = mending.blend(kernel, self.guard.reference, self.setting.sign);
            self.mesh.set_points(points);
            found = self.guard.check(&self.mesh, &mut self.trace);
            broken = found.broken(&self.start, &self.limits);
        }
        if broken.is_empty() {
            return ((self.mesh.points().to_vec(), found), mending.count());
        }
        let from = mending.undone();
        let count = from.len();
        ((from, known), count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;
    use crate::smooth::soundness::soundness;
    use crate::surface::trial;
    use crate::watch::Silent;

    /// A ball as a cube of quads, drawn out along x to a spindle with thin horns.
    fn spindle(n: u32) -> PolyMesh {
        let mut mesh = trial::cube(n, 1.0, 0.0);
        let horn = |p: &Point| {
            let thin = 0.08 + 0.92 * (1.0 - p.x * p.x).max(0.0);
            Point::new(p.x * 4.0, p.y * thin, p.z * thin)
        };
        let points = mesh.points().iter().map(horn).collect();
        mesh.set_points(points);
        mesh
    }

    /// Vertices moved by up to `size` in all directions.
    fn shaken(mesh: &PolyMesh, size: f64) -> PolyMesh {
        let wave = |v: usize, k: f64| (v as f64 * k).sin() * size;
        let shake = |(v, p): (usize, &Point)| {
            p + crate::mesh::Vector::new(wave(v, 12.9), wave(v, 78.2), wave(v, 37.7))
        };
        let mut shaken = mesh.clone();
        shaken.set_points(mesh.points().iter().enumerate().map(shake).collect());
        shaken
    }

    fn run(mesh: &PolyMesh, reference: &PolyMesh) -> (Vec<Point>, SmoothReport) {
        let surface = Reference::new(reference).unwrap();
        let held: Vec<bool> = (0..mesh.vertex_count()).map(|v| v % 97 == 0).collect();
        // The quads of thin horns cannot be as good as those of usual meshes.
        let options = SmoothOptions { least_jacobian: 0.25, ..SmoothOptions::default() };
        smooth(mesh, &held, &surface, (&options, &RelaxOptions::default()), None, &Silent)
    }

    #[test]
    fn horns_keep_their_tips_and_held_vertices_their_bits() {
        let (mesh, fine) = (spindle(14), spindle(60));
        let mesh = shaken(&mesh, 0.01);
        let (points, report) = run(&mesh, &fine);
        assert!(report.after.hausdorff <= report.before.hausdorff * 1.011, "{report:?}");
        assert!(report.after.rms <= report.before.rms * 1.011, "{report:?}");
        assert!(report.mended < mesh.vertex_count(), "not all was undone: {report:?}");
        for v in (0..points.len()).step_by(97) {
            assert_eq!(points[v], mesh.points()[v]);
        }
    }

    #[test]
    fn the_result_does_not_depend_on_threads() {
        let (mesh, fine) = (shaken(&spindle(10), 0.02), spindle(30));
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| run(&mesh, &fine))
        };
        let one = with(1);
        assert_eq!(one, with(2));
        assert_eq!(one, with(8));
    }

    #[test]
    fn folded_quads_are_unfolded() {
        let mut mesh = shapes::grid(6, 6);
        let reference = Reference::new(&mesh).unwrap();
        let topology = Topology::new(&mesh);
        let held =
            held_vertices(&mesh, &topology, &FixedBitSet::with_capacity(mesh.corner_count()));
        let mut points = mesh.points().to_vec();
        // The middle goes beyond its neighbour, and another into a corner.
        points[24] = Point::new(4.4, 3.1, 0.0);
        points[8] = Point::new(0.2, 0.3, 0.0);
        mesh.set_points(points);
        let options = SmoothOptions { iterations: 0, ..SmoothOptions::default() };
        let relax = RelaxOptions::default();
        let (_, report) = smooth(&mesh, &held, &reference, (&options, &relax), None, &Silent);
        assert!(report.least_jacobian_before < 0.0, "{report:?}");
        assert!(report.least_jacobian_after >= options.least_jacobian, "{report:?}");
    }

    #[test]
    fn what_undoing_has_folded_is_unfolded_from_there() {
        let mut mesh = shapes::grid(6, 6);
        let reference = Reference::new(&mesh).unwrap();
        let mut points = mesh.points().to_vec();
        points[24] = Point::new(4.4, 3.1, 0.0);
        mesh.set_points(points.clone());
        let held: Vec<bool> = (0..points.len()).map(|v| v != 24).collect();
        let (options, relax) = (SmoothOptions::default(), RelaxOptions::default());
        let mut work = Work::new(&mesh, &held, &reference, (&options, &relax), None);
        let folded = work.start.clone();
        assert!(folded.is_folded());
        let (unfolded, after) = work.unfold((points.clone(), folded));
        assert!(after.least_jacobian >= options.least_jacobian, "{after:?}");
        let moved = |v: &usize| unfolded[*v] != points[*v];
        assert_eq!((0..points.len()).filter(moved).collect::<Vec<_>>(), [24]);
    }

    #[test]
    fn a_pentagon_that_is_turned_inside_out_is_mended() {
        let grid = shapes::grid(6, 6);
        let reference = Reference::new(&grid).unwrap();
        let mut faces: Vec<Vec<u32>> = grid.faces().map(<[u32]>::to_vec).collect();
        // One quad loses its corner 24 to the next one, which becomes a pentagon.
        (faces[14], faces[15]) = (vec![16, 17, 23], vec![17, 18, 25, 24, 23]);
        let mut points = grid.points().to_vec();
        points[24] = Point::new(3.6, 2.3, 0.0);
        let mesh = PolyMesh::new(points, &faces).unwrap();
        let worst = |points: &[Point]| {
            mesh.faces().map(|f| soundness(points, f)).fold(f64::INFINITY, f64::min)
        };
        assert!(worst(mesh.points()) < 0.0, "a reflex corner");
        let topology = Topology::new(&mesh);
        let none = FixedBitSet::with_capacity(mesh.corner_count());
        let held = held_vertices(&mesh, &topology, &none);
        let options = SmoothOptions { iterations: 0, ..SmoothOptions::default() };
        let relax = RelaxOptions::default();
        let (points, _) = smooth(&mesh, &held, &reference, (&options, &relax), None, &Silent);
        assert!(worst(&points) > 0.0, "{}", worst(&points));
    }

    #[test]
    fn moves_that_break_a_limit_are_taken_back_and_others_stay() {
        let mesh = shapes::grid(12, 12);
        let reference = Reference::new(&mesh).unwrap();
        let held = vec![false; mesh.vertex_count()];
        let mut moved = mesh.points().to_vec();
        // One leaves the surface, one folds a quad, and one far from both just moves.
        moved[28] += crate::mesh::Vector::z();
        moved[36] = Point::new(11.4, 3.1, 0.0);
        moved[140] += crate::mesh::Vector::x() * 0.1;
        let options = (&SmoothOptions::default(), &RelaxOptions::default());
        let budget = Budget { hausdorff: 0.05, rms: 1.0 };
        let points = take_back(&mesh, &held, moved.clone(), &reference, options, Some(budget));
        let off = |v: usize| (points[v] - mesh.points()[v]).norm();
        assert!(off(28) <= 0.05 && off(36) < 0.6, "{} {}", off(28), off(36));
        assert_eq!(points[140], moved[140]);
    }

    #[test]
    fn a_start_beyond_its_budget_gets_hardly_worse() {
        let (mesh, fine) = (shaken(&spindle(10), 0.02), spindle(30));
        let surface = Reference::new(&fine).unwrap();
        let held = vec![false; mesh.vertex_count()];
        let options = (&SmoothOptions::default(), &RelaxOptions::default());
        let none = Budget { hausdorff: 0.0, rms: 0.0 };
        let (points, report) = smooth(&mesh, &held, &surface, options, Some(none), &Silent);
        assert!(points != mesh.points(), "there is room to move");
        assert!(report.after.hausdorff <= HARDLY_MORE * report.before.hausdorff, "{report:?}");
        assert!(report.after.rms <= HARDLY_MORE * report.before.rms, "{report:?}");
    }
}
