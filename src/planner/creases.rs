//! Edges of the mesh are drawn to the creases of the reference.
//!
//! Edits and smoothing move edges away from creases that are too short or too blunt to be held as
//! features: a fold between leg and body, the rim of a nostril. At the end, vertices near creases are
//! moved until edges lie on them again, as far as the corners around are worth it.

use super::gate::Shape;
use super::lines::{Rails, faces_at};
use crate::mesh::{Point, Vector};
use crate::sqrtcc::{QuadMesh, Vertex};
use crate::surface::{Crease, Reference, Segments};
use rayon::prelude::*;
use rustc_hash::FxHashSet;
use smallvec::SmallVec;
use std::collections::BTreeMap;

/// Probes on as much of the creases as the mean edge of the mesh is long.
const PROBES_PER_EDGE: f64 = 4.0;
/// What is farther from all edges of a mesh than that, in mean edges, is no crease of it.
const REACH: f64 = 2.0;
/// Most sweeps over the vertices near creases.
const SWEEPS: usize = 8;
/// Probes, the farthest ones, that a vertex tries to come to.
const AIMS: usize = 20;
/// Shares of the way to where an edge would lie on a probe that are tried.
const STRIDES: [f64; 4] = [1.0, 0.5, 0.25, 0.1];
/// Nearer to this end of an edge than that share of it, a probe is left to the other one.
const LEVER: f64 = 0.3;
/// A move brings creases nearer by this at least: length times distance, in squared mean edges.
const PROGRESS: f64 = 0.003;

/// The creases of a reference, for a mesh.
#[derive(Debug, Clone)]
pub(super) struct Creases {
    probes: Vec<Point>,
    /// Length that each probe stands for, in units of the file.
    step: f64,
    /// Mean edge of the mesh, in units of the file.
    edge: f64,
}

impl Creases {
    /// The creases of `reference` of at least that angle, if it has any, for a mesh of so many faces
    /// and such a mean edge. O(n).
    pub(super) fn new(
        reference: &Reference,
        angle_deg: f64,
        faces: usize,
        edge: f64,
    ) -> Option<Self> {
        let ends = |c: &Crease| [c.a, c.b].map(|v| reference.points()[v as usize]);
        let sharp = || reference.creases().iter().filter(|c| c.angle_deg >= angle_deg).map(ends);
        let total: f64 = sharp().map(|[a, b]| (b - a).norm()).sum();
        // A mesh cannot follow more than there is of its edges.
        let most = PROBES_PER_EDGE * (2 * faces.max(1)) as f64;
        let step = (edge / PROBES_PER_EDGE).max(total / most);
        let mut probes = Vec::new();
        // Length since the last probe: each stands for as much, however finely creases are divided.
        let mut since = step / 2.0;
        for [a, b] in sharp().filter(|[a, b]| (b - a).norm() > 0.0) {
            let length = (b - a).norm();
            let count = ((since + length) / step).floor();
            let at = |i: u32| a + (b - a) * ((f64::from(i) * step - since) / length);
            probes.extend((1..=count as u32).map(at));
            since += length - count * step;
        }
        (!probes.is_empty()).then_some(Self { probes, step, edge })
    }

    /// Moves free vertices to where edges are nearer to the creases, as long as an edge that is nearer
    /// along its length by its length is worth the `worth_deg` degrees by which corners around deviate
    /// more, and no quad becomes poor; whether any has moved. O(n log n), parallel; independent of the
    /// number of threads.
    pub(super) fn draw_near(&self, mesh: &mut QuadMesh, rails: Rails, worth_deg: f64) -> bool {
        let mut active: Vec<(Vertex, Vec<Point>)> = self.served(mesh).into_iter().collect();
        let mut any = false;
        for _ in 0..SWEEPS {
            let still = &*mesh;
            let better = |(v, probes): &(Vertex, Vec<Point>)| {
                Site::new(self, still, *v, probes).better(rails, worth_deg)
            };
            let better: Vec<Option<Point>> = active.par_iter().map(better).collect();
            let mut moved: FxHashSet<Vertex> = FxHashSet::default();
            let is_near = |moved: &FxHashSet<Vertex>, v| {
                corners_around(still, [v]).iter().any(|w| moved.contains(w))
            };
            let mut moves = Vec::new();
            for (&(v, _), place) in active.iter().zip(better) {
                // What was found beside a move is looked for again.
                if let Some(place) = place.filter(|_| !is_near(&moved, v)) {
                    moved.insert(v);
                    moves.push((v, place));
                }
            }
            if moved.is_empty() {
                break;
            }
            active.retain(|&(v, _)| is_near(&moved, v));
            for (v, place) in moves {
                mesh.set_position(v, place);
            }
            any = true;
        }
        any
    }

    /// Free vertices, ascending, each with the probes whose nearest edge is beside one of its faces.
    fn served(&self, mesh: &QuadMesh) -> BTreeMap<Vertex, Vec<Point>> {
        let edges = Edges::new(mesh);
        let nearest: Vec<_> = self.probes.par_iter().map(|p| edges.nearest(p)).collect();
        let mut served: BTreeMap<Vertex, Vec<Point>> = BTreeMap::new();
        for (&probe, nearest) in self.probes.iter().zip(nearest) {
            let Some((ends, _)) = nearest.filter(|n| n.1 <= REACH * self.edge) else { continue };
            let corners = corners_around(mesh, ends);
            for v in corners.into_iter().filter(|&v| !mesh.is_held(v)) {
                served.entry(v).or_default().push(probe);
            }
        }
        served
    }
}

/// The edges of a mesh, for the nearest of them.
struct Edges {
    tree: Segments,
    /// Ends of the edges, in the order of the tree.
    ends: Vec<[Vertex; 2]>,
}

impl Edges {
    fn new(mesh: &QuadMesh) -> Self {
        let vertices = mesh.vertices().filter(|&v| !mesh.is_face(v) && !mesh.is_ghost(v));
        let from = |v| mesh.diagonals(v).filter(move |&w| w > v).map(move |w| [v, w]);
        let ends: Vec<[Vertex; 2]> = vertices.flat_map(from).collect();
        let places: Vec<_> = ends.iter().map(|e| e.map(|v| mesh.position(v))).collect();
        let (tree, order) = Segments::new(&places);
        Self { tree, ends: order.iter().map(|&e| ends[e as usize]).collect() }
    }

    /// Ends of the nearest edge, and how far it is.
    fn nearest(&self, place: &Point) -> Option<([Vertex; 2], f64)> {
        self.tree.nearest(place).map(|(edge, distance)| (self.ends[edge as usize], distance))
    }
}

/// Corners of the faces at these vertices, ascending.
fn corners_around(
    mesh: &QuadMesh,
    vertices: impl IntoIterator<Item = Vertex>,
) -> SmallVec<[Vertex; 16]> {
    let faces = vertices.into_iter().flat_map(|v| faces_at(mesh, v));
    let mut corners: SmallVec<[Vertex; 16]> = faces.flat_map(|f| mesh.neighbours(f)).collect();
    corners.sort_unstable();
    corners.dedup();
    corners
}

/// A vertex that may move for the probes around it.
struct Site<'a> {
    creases: &'a Creases,
    at: Point,
    /// Corners of its faces, each from the vertex on.
    faces: SmallVec<[SmallVec<[Point; 8]>; 8]>,
    /// The other ends of its edges.
    ends: SmallVec<[Point; 8]>,
    /// The probes, the farthest ones first, and how far each is from the edges around that do not move
    /// with the vertex.
    probes: Vec<(Point, f64)>,
}

impl<'a> Site<'a> {
    fn new(creases: &'a Creases, mesh: &QuadMesh, v: Vertex, probes: &[Point]) -> Self {
        let position = |w| mesh.position(w);
        let around = corners_around(mesh, [v]);
        let others = around.iter().filter(|&&w| w != v);
        let rest = others.flat_map(|&w| mesh.diagonals(w).filter(|&x| x != v).map(move |x| [w, x]));
        let rest: Vec<[Point; 2]> = rest.map(|ends| ends.map(position)).collect();
        let from_here = |f: Vertex| {
            let mut corners: SmallVec<[Vertex; 8]> = mesh.neighbours(f).collect();
            let first = corners.iter().position(|&w| w == v).unwrap_or(0);
            corners.rotate_left(first);
            corners.into_iter().map(position).collect()
        };
        let mut site = Self {
            creases,
            at: position(v),
            faces: faces_at(mesh, v).map(from_here).collect(),
            ends: mesh.diagonals(v).map(position).collect(),
            probes: Vec::new(),
        };
        let far = |&probe: &Point| {
            let distances = rest.iter().map(|[a, b]| along(&probe, a, b).1);
            let probe = (probe, distances.fold(f64::INFINITY, f64::min));
            (site.distance(&probe, &site.at), probe)
        };
        let mut far: Vec<_> = probes.iter().map(far).collect();
        far.sort_by(|a, b| b.0.total_cmp(&a.0));
        site.probes = far.into_iter().map(|(_, probe)| probe).collect();
        site
    }

    /// How far the creases around are from edges with the vertex there, length times distance, in
    /// squared mean edges; `None` if that is not less than `most`.
    fn apart(&self, at: &Point, most: f64) -> Option<f64> {
        let each = self.creases.step / self.creases.edge.powi(2);
        let mut sum = 0.0;
        for probe in &self.probes {
            sum += each * self.distance(probe, at);
            if sum >= most {
                return None;
            }
        }
        Some(sum)
    }

    /// How far a probe is from edges with the vertex there, in units of the file.
    fn distance(&self, (probe, rest): &(Point, f64), at: &Point) -> f64 {
        let nearest = self.ends.iter().map(|end| along(probe, at, end).1);
        nearest.fold(*rest, f64::min)
    }

    /// Where the vertex, or an edge at it, would lie on a probe.
    fn aims(&self) -> impl Iterator<Item = Point> + '_ {
        self.probes.iter().take(AIMS).flat_map(|&(place, rest)| {
            let onto = Some(place).filter(|p| (p - self.at).norm() < self.creases.edge);
            let edges = self.ends.iter().map(|end| (along(&place, &self.at, end), end));
            let nearest = edges.min_by(|a, b| a.0.1.total_cmp(&b.0.1));
            let nearest = nearest.filter(|((share, d), _)| *d < rest && 1.0 - share > LEVER);
            let across = nearest.map(|((share, _), end)| {
                let on = self.at + (end - self.at) * share;
                self.at + (place - on) / (1.0 - share)
            });
            onto.into_iter().chain(across)
        })
    }

    /// The best of a few places for the vertex, if one is better than where it is.
    fn better(mut self, rails: Rails, worth_deg: f64) -> Option<Point> {
        let before = self.apart(&self.at, f64::INFINITY)?;
        if before <= PROGRESS {
            return None;
        }
        let near = rails.reference.closest(&self.at).triangle;
        let now = self.shape_with(self.at);
        let most = self.off(rails).max(rails.tolerance);
        let (mut least, mut best) = (before - PROGRESS, None);
        let aims: Vec<Point> = self.aims().collect();
        for (aim, stride) in aims.iter().flat_map(|aim| STRIDES.map(|stride| (aim, stride))) {
            let towards = self.at + (aim - self.at) * stride;
            let place = rails.reference.closest_near(&towards, near).point;
            let Some(apart) = self.apart(&place, least) else { continue };
            let then = self.shape_with(place);
            let price = apart + (then.angles() - now.angles()) / worth_deg;
            if price < least && then.is_as_fair_as(&now) && self.off(rails) <= most {
                (least, best) = (price, Some(place));
            }
        }
        best
    }

    /// Puts the vertex there; the shape of its faces then.
    fn shape_with(&mut self, at: Point) -> Shape {
        let mut shape = Shape::default();
        for corners in &mut self.faces {
            corners[0] = at;
            shape.add(corners, &Vector::zeros());
        }
        shape
    }

    /// How far its faces are from the surface.
    fn off(&self, rails: Rails) -> f64 {
        self.faces.iter().map(|corners| rails.off(corners)).fold(0.0, f64::max)
    }
}

/// The share of the way from `a` to `b` after which `place` is nearest, and how near.
fn along(place: &Point, a: &Point, b: &Point) -> (f64, f64) {
    let way = b - a;
    let share = (place - a).dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE);
    let share = share.clamp(0.0, 1.0);
    (share, (a + way * share - place).norm())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::PolyMesh;
    use crate::planner::gate::{FAIR, shape_of};
    use crate::sqrtcc::lift;
    use crate::surface::{FeatureOptions, SharpLines, trial};
    use fixedbitset::FixedBitSet;

    /// A square with a fold along a line, and a mesh on it, so far along x, over whose quads the line
    /// runs askew.
    fn folded(mut mesh: PolyMesh, x: f64) -> (Reference, QuadMesh) {
        let bend = |p: &Point| Point::new(p.x, p.y, (p.x - 0.35 * p.y - 2.3).abs());
        let place = |p: &Point| bend(&(p + Vector::x() * x));
        mesh.set_points(mesh.points().iter().map(place).collect());
        let crease = [0.0, 8.0].map(|y| bend(&Point::new(0.35 * y + 2.3, y, 0.0)));
        let corner = |x: f64, y: f64| bend(&Point::new(x, y, 0.0));
        let mut points =
            vec![corner(0.0, 0.0), corner(0.0, 8.0), corner(8.0, 0.0), corner(8.0, 8.0)];
        points.extend(crease);
        let sides = [[0, 4, 5, 1], [4, 2, 3, 5]].map(Vec::from);
        let reference = Reference::new(&PolyMesh::new(points, sides).unwrap()).unwrap();
        let q = lift(&mesh, &FixedBitSet::with_capacity(mesh.corner_count())).unwrap();
        (reference, q)
    }

    /// Mean distance of the crease to the edges, and deviation at corners, before and after.
    fn drawn(worth_deg: f64) -> [(f64, f64); 2] {
        let (reference, mut q) = folded(trial::grid(8), 0.0);
        let lines = SharpLines::new(&reference, &FeatureOptions::default(), 1.0);
        let rails = Rails { reference: &reference, lines: &lines, tolerance: 0.2 };
        let creases = Creases::new(&reference, 40.0, 64, 1.0).unwrap();
        let state = |q: &QuadMesh| {
            let distances = Edges::new(q).tree.distances(&creases.probes);
            let faces = q.vertices().filter(|&f| q.is_face(f) && !q.is_ghost(f));
            let shape = shape_of(q, faces);
            assert!(shape.jacobian() >= FAIR);
            (distances.iter().sum::<f64>() / distances.len() as f64, shape.angles())
        };
        let before = state(&q);
        let held: Vec<_> =
            q.vertices().filter(|&v| q.is_held(v)).map(|v| (v, q.position(v))).collect();
        assert!(!held.is_empty(), "the boundary is held");
        creases.draw_near(&mut q, rails, worth_deg);
        assert!(held.iter().all(|&(v, at)| q.position(v) == at));
        [before, state(&q)]
    }

    #[test]
    fn edges_come_to_a_crease_as_far_as_it_is_worth() {
        let [(before, _), (after, _)] = drawn(1000.0);
        assert!(after < 0.4 * before, "{before} to {after}");
        let [_, (cheaper, _)] = drawn(100.0);
        assert!(after < cheaper && cheaper < before, "{after} < {cheaper} < {before}");
    }

    #[test]
    fn a_crease_that_is_worth_nothing_costs_no_angle() {
        let [(far, before), (near, after)] = drawn(1e-3);
        assert!(near <= far && after <= before, "{far} to {near}, {before} to {after}");
    }

    #[test]
    fn a_crease_away_from_the_mesh_is_none_of_its_own() {
        let (reference, mut q) = folded(trial::grid(2), 6.0);
        let lines = SharpLines::new(&reference, &FeatureOptions::default(), 1.0);
        let rails = Rails { reference: &reference, lines: &lines, tolerance: 0.2 };
        let creases = Creases::new(&reference, 40.0, 4, 1.0).unwrap();
        assert!(!creases.probes.is_empty() && q.vertices().any(|v| !q.is_held(v)));
        assert!(!creases.draw_near(&mut q, rails, 1000.0));
    }

    #[test]
    fn probes_stand_for_as_much_of_a_crease_however_it_is_divided() {
        let count = |n: u32, faces: usize| {
            let reference = Reference::new(&trial::cube(n, 0.0, 0.0)).unwrap();
            Creases::new(&reference, 40.0, faces, 0.5).unwrap().probes.len()
        };
        // Twelve edges of a length of four mean edges each.
        assert_eq!([1, 3, 50].map(|n| count(n, 600)), [12 * 4 * 4; 3]);
        assert_eq!(count(3, 6), 12 * 4, "no more than the edges of six faces can follow");
    }
}
