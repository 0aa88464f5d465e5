//! Planar faces: alternately fit a plane to each face and move each vertex to the mean of its
//! projections to the planes around it, with a pull of the reference along its normals.
//!
//! A local-global iteration (Bouaziz et al., *Shape-Up*, 2012), accelerated as in Nesterov 1983.
//! Where the result breaks a limit, vertices are pulled back to their first places the harder the
//! longer it stays broken; the last such pull holds them there, so the limits are kept.

use super::{OptimizeOptions, Options};
use crate::mesh::{Point, PolyMesh, Vector};
use crate::smooth::{Budget, Guard, Shape, Trace, limits, orientation, polygon, rectangle};
use crate::surface::{Hit, Reference};
use crate::watch::{Phase, Watch};
use rayon::prelude::*;
use smallvec::SmallVec;

/// The closest points are looked up again in every so many iterations.
const PROJECT_EVERY: u32 = 5;
/// Largest momentum.
const MOMENTUM: f64 = 0.95;
/// Faces far from planar weigh up to this many times more: the worst are to be mended first.
const STRESS: f64 = 4.0;
/// How much harder a vertex is pulled back in each round.
const PULL_BACK: f64 = 10.0;

/// Moves the vertices that are not `held` for planar faces; the new points. They are within
/// `allowed` of the reference, or those of the start. O(iterations · n), parallel.
#[must_use]
pub fn flatten(
    mesh: &PolyMesh,
    held: &[bool],
    (reference, allowed): (&Reference, Budget),
    options: Options,
    watch: &dyn Watch,
) -> Vec<Point> {
    let sign = orientation(mesh, reference).sign();
    let guard = Guard::new(reference, mesh.vertex_count(), sign);
    let mut trace = Trace::default();
    let start = guard.check(mesh, &mut trace);
    let limits = limits(&start, options.smooth, Some(allowed), reference.diagonal());
    let OptimizeOptions { iterations, rounds, .. } = *options.optimize;
    let mut solver = Solver::new(mesh, held, reference, options);
    let mut moved = mesh.clone();
    for round in 0..=rounds {
        solver.run(if round == 0 { iterations } else { iterations / 8 }, watch);
        moved.set_points(solver.points.clone());
        let broken = guard.check(&moved, &mut trace).broken(&start, &limits);
        if broken.is_empty() {
            return solver.points;
        }
        solver.pull_back(&broken, 2 * round >= rounds);
    }
    mesh.points().to_vec()
}

/// The state of the iteration.
struct Solver<'a> {
    mesh: &'a PolyMesh,
    reference: &'a Reference,
    options: &'a OptimizeOptions,
    fit: Shape,
    /// Weight of the first place of each vertex; infinite holds it.
    stay: Vec<f64>,
    /// The corners at each vertex.
    star_offsets: Vec<u32>,
    star: Vec<u32>,
    points: Vec<Point>,
    lead: Vec<Point>,
    near: Vec<Hit>,
}

/// Where a face wants one of its corners: shifted by so much, with this weight.
#[derive(Debug, Clone, Copy)]
struct Pull {
    shift: Vector,
    weight: f64,
    /// Squared distance to the plane of the face.
    off: f64,
}

impl<'a> Solver<'a> {
    fn new(
        mesh: &'a PolyMesh,
        held: &[bool],
        reference: &'a Reference,
        options: Options<'a>,
    ) -> Self {
        let mut star: Vec<u32> = (0..mesh.corner_count() as u32).collect();
        star.sort_by_key(|&c| mesh.corners()[c as usize]);
        let at = |v: u32| star.partition_point(|&c| mesh.corners()[c as usize] < v) as u32;
        let stay = |&held: &bool| if held { f64::INFINITY } else { options.optimize.stay };
        Self {
            mesh,
            reference,
            options: options.optimize,
            fit: Shape::new(options.relax.slant_deg, options.relax.hang_deg),
            stay: held.iter().map(stay).collect(),
            star_offsets: (0..=mesh.vertex_count() as u32).map(at).collect(),
            star,
            points: mesh.points().to_vec(),
            lead: mesh.points().to_vec(),
            near: reference.closest_many(mesh.points()),
        }
    }

    /// Goes on from the points as they are.
    fn run(&mut self, iterations: u32, watch: &dyn Watch) {
        let (mut last, mut pace, mut mean) = (f64::INFINITY, 1.0, 0.0);
        for i in 0..iterations {
            if watch.cancelled() {
                break;
            }
            watch.progress(Phase::Smooth, i as usize, iterations as usize, None);
            if i % PROJECT_EVERY == 0 {
                self.near = self.reference.closest_many(&self.lead);
            }
            let faces = (0..self.mesh.face_count()).into_par_iter();
            let pulls: Vec<Pull> = faces.flat_map_iter(|f| self.pulls(f, mean)).collect();
            let energy: f64 = pulls.iter().map(|p| p.off).sum();
            mean = energy / pulls.len().max(1) as f64;
            pace = if energy > last { 1.0 } else { pace + 1.0 };
            last = energy;
            let ahead = f64::min((pace - 1.0) / (pace + 2.0), MOMENTUM);
            let vertices = (0..self.points.len()).into_par_iter();
            let moved: Vec<Point> = vertices.map(|v| self.place(v, &pulls)).collect();
            for ((lead, old), new) in self.lead.iter_mut().zip(&self.points).zip(&moved) {
                *lead = new + (new - old) * ahead;
            }
            self.points = moved;
        }
        self.lead.clone_from(&self.points);
    }

    /// What face `f` wants; `mean` is the mean square that corners were off before.
    fn pulls(&self, f: usize, mean: f64) -> SmallVec<[Pull; 4]> {
        let face = self.mesh.face(f);
        let corners = face.iter().map(|&v| self.lead[v as usize].coords);
        let centre = corners.clone().sum::<Vector>() / face.len() as f64;
        let arms: SmallVec<[Vector; 4]> = corners.map(|p| p - centre).collect();
        let next = arms.iter().cycle().skip(1);
        let area: Vector = arms.iter().zip(next).map(|(a, b)| a.cross(b)).sum();
        let normal = area.try_normalize(0.0).unwrap_or_else(Vector::zeros);
        let worst = arms.iter().map(|a| normal.dot(a).powi(2)).fold(0.0, f64::max);
        let flat = 1.0 + if mean > 0.0 { (worst / mean).min(STRESS) } else { 0.0 };
        let shape = self.options.shape;
        let pull = |(arm, fair): (&Vector, &Vector)| {
            let height = normal.dot(arm);
            let shift = normal * (-height * flat) + (fair - arm) * shape;
            Pull { shift, weight: flat + shape, off: height * height }
        };
        arms.iter().zip(&self.fair(&arms, &normal)).map(pull).collect()
    }

    /// The arms of a face from its centre if it had a good shape.
    fn fair(&self, arms: &[Vector], normal: &Vector) -> SmallVec<[Vector; 4]> {
        if let &[a, b, c, d] = arms {
            return rectangle(&[a, b, c, d], normal, &self.fit).into();
        }
        let mut fair = SmallVec::from_slice(arms);
        polygon(&mut fair, |_| true, normal, &self.fit);
        fair
    }

    /// Where the faces around vertex `v`, the reference and its first place want it.
    fn place(&self, v: usize, pulls: &[Pull]) -> Point {
        let (stay, first, lead) = (self.stay[v], self.mesh.points()[v], self.lead[v]);
        if stay.is_infinite() {
            return first;
        }
        let (near, normal) = (self.near[v].point, self.reference.normal(self.near[v].triangle));
        let surface = self.options.surface;
        let mut shift = normal * (normal.dot(&(near - lead)) * surface) + (first - lead) * stay;
        let mut weight = surface + stay;
        for &c in self.star(v) {
            shift += pulls[c as usize].shift;
            weight += pulls[c as usize].weight;
        }
        lead + shift / weight
    }

    fn star(&self, v: usize) -> &[u32] {
        &self.star[self.star_offsets[v] as usize..self.star_offsets[v + 1] as usize]
    }

    /// Pulls the corners of `broken` faces, and more around them, back to their first places;
    /// `hold` puts them there.
    fn pull_back(&mut self, broken: &[u32], hold: bool) {
        let mut near = vec![false; self.points.len()];
        for &v in broken.iter().flat_map(|&f| self.mesh.face(f as usize)) {
            near[v as usize] = true;
        }
        let inner = near.clone();
        for face in self.mesh.faces().filter(|face| face.iter().any(|&v| inner[v as usize])) {
            for &v in face {
                near[v as usize] = true;
            }
        }
        for v in (0..near.len()).filter(|&v| near[v]) {
            self.stay[v] = if hold { f64::INFINITY } else { (self.stay[v] * PULL_BACK).max(0.01) };
            if hold {
                (self.points[v], self.lead[v]) = (self.mesh.points()[v], self.mesh.points()[v]);
            }
        }
    }
}
