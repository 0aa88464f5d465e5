//! Contact of the mesh with its reference, kept up to date from edit to edit.
//!
//! Each p-vertex knows a triangle of the reference near it; each of a fixed set of *probes* (points
//! of the reference: spread evenly, and along its creases) knows the face of the mesh that it is
//! closest to. An edit is then checked against the part of the reference that it has to cover,
//! without a search: closest-point projection alone does not notice a corner that is cut off.

use super::cover::Cover;
use crate::mesh::{MeshError, NONE, Point};
use crate::sqrtcc::{Lowered, QuadMesh, Vertex, lower};
use crate::surface::Reference;
use rayon::prelude::*;
use rustc_hash::FxHashSet;

/// Probes for each face of the mesh, beside those on creases.
const PROBES_PER_FACE: usize = 3;
/// Creases below this angle get no probes of their own.
const CREASE_DEG: f64 = 25.0;

/// Distances of a mesh that is its own reference come from rounding and are below this share of what
/// is allowed.
const ROUNDING: f64 = 1e-6;

/// Where the mesh touches the reference.
#[derive(Debug, Clone, Default)]
pub struct Contact {
    /// A triangle of the reference near each vertex, by id; [`NONE`] if unknown.
    near: Vec<u32>,
    points: Vec<Point>,
    /// How many of the probes are spread evenly; those on creases follow.
    even: usize,
    /// Distance of each probe to the mesh when it was last looked up, in units of the file.
    distance: Vec<f64>,
    /// First probe of each face, by vertex id, and the probe after each probe.
    first: Vec<u32>,
    next: Vec<u32>,
    /// What edits have taken from their faces, and all those faces.
    loose: Vec<Loose>,
    waiting: FxHashSet<Vertex>,
}

/// Probes that are to be handed to the nearest of some faces.
#[derive(Debug, Clone)]
struct Loose {
    faces: Vec<Vertex>,
    probes: Vec<u32>,
}

impl Contact {
    /// Probes of `reference` for a mesh of so many faces; not yet attached. O(n).
    #[must_use]
    pub fn new(reference: &Reference, faces: usize) -> Self {
        let mut points = reference.samples(PROBES_PER_FACE * faces);
        let even = points.len();
        let sharp = reference.creases().iter().filter(|c| c.angle_deg >= CREASE_DEG);
        let mut ends: Vec<u32> = sharp.flat_map(|c| [c.a, c.b]).collect();
        ends.sort_unstable();
        ends.dedup();
        // A finely tessellated crease needs no more probes than the mesh can resolve.
        let every = ends.len().div_ceil(2 * faces.max(1)).max(1);
        points.extend(ends.iter().step_by(every).map(|&v| reference.points()[v as usize]));
        let n = points.len();
        Self { points, even, distance: vec![0.0; n], next: vec![NONE; n], ..Self::default() }
    }

    /// Looks everything up anew. O(n log n), parallel.
    pub fn attach(&mut self, mesh: &QuadMesh, reference: &Reference) -> Result<(), MeshError> {
        let polygons = lower(mesh, &[String::new()])?;
        let surface = Reference::plain(&polygons.mesh).ok();
        self.attach_vertices(mesh, (&polygons, surface.as_ref()), reference);
        let Some(surface) = surface else {
            self.first.clear();
            return Ok(());
        };
        let mut near = self.near_probes(mesh, &polygons, &surface);
        self.first.clear();
        self.first.resize(mesh.vertex_ids() as usize, NONE);
        let points = std::mem::take(&mut self.points);
        surface.closest_each(&points, &mut near, |i, hit| {
            let face = polygons.face_ids[surface.faces()[hit.triangle as usize] as usize];
            self.put(i as u32, face, hit.distance);
        });
        self.points = points;
        Ok(())
    }

    /// A triangle of `surface` near each probe: of the face that it was at until now.
    fn near_probes(&self, mesh: &QuadMesh, polygons: &Lowered, surface: &Reference) -> Vec<u32> {
        let mut triangle = vec![NONE; mesh.vertex_ids() as usize];
        for (t, &f) in surface.faces().iter().enumerate() {
            triangle[polygons.face_ids[f as usize] as usize] = t as u32;
        }
        let mut near = vec![NONE; self.points.len()];
        for (&first, &triangle) in self.first.iter().zip(&triangle) {
            let mut probe = first;
            while probe != NONE {
                near[probe as usize] = triangle;
                probe = self.next[probe as usize];
            }
        }
        near
    }

    /// Vertices in the order of the `surface` of the mesh, if it has one: neighbours are near each
    /// other there.
    fn attach_vertices(
        &mut self,
        mesh: &QuadMesh,
        (polygons, surface): (&Lowered, Option<&Reference>),
        reference: &Reference,
    ) {
        let count = polygons.mesh.vertex_count();
        let order = surface.map_or_else(
            || (0..count as u32).collect(),
            |surface| surface.vertices_in_order(count),
        );
        let id = |&v: &u32| polygons.vertex_ids[v as usize];
        let mut near: Vec<u32> = order.iter().map(|v| self.near(id(v)).unwrap_or(NONE)).collect();
        let points: Vec<Point> =
            order.iter().map(|&v| polygons.mesh.points()[v as usize]).collect();
        reference.closest_each(&points, &mut near, |_, _| ());
        self.near.clear();
        self.near.resize(mesh.vertex_ids() as usize, NONE);
        for (v, near) in order.iter().zip(near) {
            self.near[id(v) as usize] = near;
        }
    }

    /// What [`Self::squared_distances`] would be if the root mean square distance of the evenly spread
    /// probes were `rms`: those on creases are farther from a mesh than others, by as much as they
    /// are now. At least that of as many probes at that distance. O(probes).
    #[must_use]
    pub fn squares_at(&self, rms: f64) -> f64 {
        let even = squares(&self.distance[..self.even]) / self.even.max(1) as f64;
        let count = self.points.len() as f64;
        let is_known = even.sqrt() > ROUNDING * rms;
        rms * rms * if is_known { count.max(self.squared_distances() / even) } else { count }
    }

    /// Σ squared distance of the probes to the mesh, in squared units of the file. O(probes).
    #[must_use]
    pub fn squared_distances(&self) -> f64 {
        squares(&self.distance)
    }

    /// A triangle of the reference near `v`, if one is known.
    #[must_use]
    pub fn near(&self, v: Vertex) -> Option<u32> {
        self.near.get(v as usize).copied().filter(|&t| t != NONE)
    }

    /// A triangle of the reference near a vertex, or near a corner of a face; [`NONE`] if none is
    /// known.
    pub(super) fn near_element(&self, mesh: &QuadMesh, v: Vertex) -> u32 {
        let corner = if mesh.is_face(v) { mesh.neighbours(v).next() } else { Some(v) };
        corner.and_then(|v| self.near(v)).unwrap_or(NONE)
    }

    /// Notes a triangle near `v`.
    pub fn set_near(&mut self, v: Vertex, triangle: u32) {
        if self.near.len() <= v as usize {
            self.near.resize(v as usize + 1, NONE);
        }
        self.near[v as usize] = triangle;
    }

    /// The probes that face `f` covers, each with its distance to the mesh.
    pub fn probes(&self, f: Vertex) -> impl Iterator<Item = (Point, f64)> + '_ {
        let some = |i: u32| (i != NONE).then_some(i);
        let first = self.first.get(f as usize).copied().and_then(some);
        let chain = std::iter::successors(first, move |&i| some(self.next[i as usize]));
        chain.map(|i| (self.points[i as usize], self.distance[i as usize]))
    }

    /// Makes ready for an edit that changes or moves these vertices: probes that are still to be
    /// handed to faces there are, as they are now.
    pub fn expect(&mut self, mesh: &QuadMesh, vertices: impl Iterator<Item = Vertex>) {
        let known: Vec<Vertex> = vertices.filter(|&v| v < mesh.vertex_ids()).collect();
        if faces_at(mesh, &known).iter().any(|f| self.waiting.contains(f)) {
            self.settle(mesh);
        }
    }

    /// Takes the probes of faces that an edit has changed or moved, to be handed to the nearest of
    /// those there now: by [`Self::settle`], but as if it were at once. `changed` are the vertices
    /// that the edit has changed or moved.
    pub fn reassign(&mut self, mesh: &QuadMesh, changed: &[Vertex]) {
        self.first.resize(mesh.vertex_ids() as usize, NONE);
        let mut faces = faces_at(mesh, changed);
        debug_assert!(!faces.iter().any(|f| self.waiting.contains(f)), "the edit was expected");
        let probes = self.take(&faces);
        faces.retain(|&f| mesh.is_alive(f) && !mesh.is_ghost(f));
        self.waiting.extend(&faces);
        self.loose.push(Loose { faces, probes });
    }

    /// Hands out what [`Self::reassign`] has taken. Parallel.
    pub fn settle(&mut self, mesh: &QuadMesh) {
        let loose = std::mem::take(&mut self.loose);
        self.waiting.clear();
        let points = &self.points;
        let covered = |cover: &mut Cover, Loose { faces, probes }: Loose| {
            let corners = |&f: &Vertex| mesh.neighbours(f).map(|v| mesh.position(v));
            cover.fill(faces.iter().map(corners));
            let nearest = |probe: u32| {
                let (squared, i) = cover.nearest(&points[probe as usize], f64::INFINITY)?;
                Some((probe, faces[i], squared.sqrt()))
            };
            probes.into_iter().filter_map(nearest).collect::<Vec<_>>()
        };
        let handed: Vec<_> = loose.into_par_iter().map_init(Cover::default, covered).collect();
        for (probe, face, distance) in handed.into_iter().flatten() {
            self.put(probe, face, distance);
        }
    }

    /// Takes all probes from some faces.
    fn take(&mut self, faces: &[Vertex]) -> Vec<u32> {
        let mut loose = Vec::new();
        for &f in faces {
            let mut probe = std::mem::replace(&mut self.first[f as usize], NONE);
            while probe != NONE {
                loose.push(probe);
                probe = self.next[probe as usize];
            }
        }
        loose
    }

    fn put(&mut self, probe: u32, face: Vertex, distance: f64) {
        self.distance[probe as usize] = distance;
        self.next[probe as usize] = self.first[face as usize];
        self.first[face as usize] = probe;
    }
}

fn squares(distances: &[f64]) -> f64 {
    distances.iter().map(|d| d * d).sum()
}

/// The faces among vertices that have changed or moved, dead ones too, and those at the others.
fn faces_at(mesh: &QuadMesh, changed: &[Vertex]) -> Vec<Vertex> {
    let is_alive = |&&v: &&Vertex| mesh.is_alive(v) && !mesh.is_ghost(v);
    let moved = changed.iter().filter(is_alive).filter(|&&v| !mesh.is_face(v));
    let mut faces: Vec<Vertex> = moved.flat_map(|&v| mesh.neighbours(v)).collect();
    faces.extend(changed.iter().filter(|&&v| mesh.is_face(v)));
    faces.sort_unstable();
    faces.dedup();
    faces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Vector, shapes};
    use crate::sqrtcc::lift;
    use crate::surface::trial;
    use fixedbitset::FixedBitSet;

    /// Moves vertices one after the other; where the probes are then. They are handed out after each
    /// move, or when they have to be.
    fn moved(vertices: &[Vertex], at_once: bool) -> Vec<Vec<(Point, f64)>> {
        let ball = shapes::sphere(8);
        let reference = Reference::new(&shapes::sphere(24)).unwrap();
        let mut mesh = lift(&ball, &FixedBitSet::new()).unwrap();
        let mut contact = Contact::new(&reference, ball.face_count());
        contact.attach(&mesh, &reference).unwrap();
        for &v in vertices {
            contact.expect(&mesh, std::iter::once(v));
            mesh.set_position(v, mesh.position(v) + Vector::new(0.02, -0.03, 0.01));
            contact.reassign(&mesh, &[v]);
            if at_once {
                contact.settle(&mesh);
            }
        }
        contact.settle(&mesh);
        (0..mesh.vertex_ids()).map(|f| contact.probes(f).collect()).collect()
    }

    #[test]
    fn what_is_allowed_counts_probes_on_creases_for_as_much_as_they_are_farther() {
        let reference = Reference::new(&trial::cube(12, 0.0, 0.0)).unwrap();
        let attached = |mesh: &crate::mesh::PolyMesh| {
            let mut contact = Contact::new(&reference, mesh.face_count());
            contact.attach(&lift(mesh, &FixedBitSet::new()).unwrap(), &reference).unwrap();
            contact
        };
        let even_rms = |c: &Contact| (squares(&c.distance[..c.even]) / c.even as f64).sqrt();
        let mut round = trial::cube(12, 0.0, 0.0);
        let towards_ball = |p: &Point| Point::from(p.coords.lerp(&p.coords.normalize(), 0.2));
        round.set_points(round.points().iter().map(towards_ball).collect());
        let contact = attached(&round);
        let (all, rms) = (contact.squared_distances(), even_rms(&contact));
        assert!(contact.even < contact.points.len(), "some are on creases");
        assert!(all > 1.1 * rms * rms * contact.points.len() as f64, "and farther");
        assert!((contact.squares_at(2.0 * rms) / (4.0 * all) - 1.0).abs() < 1e-12);
        // Where there is no distance to compare, all count alike.
        let own = attached(&trial::cube(12, 0.0, 0.0));
        assert!((own.squares_at(0.5) - 0.25 * own.points.len() as f64).abs() < 1e-9);
    }

    #[test]
    fn probes_that_wait_are_handed_out_as_if_at_once() {
        let ball = lift(&shapes::sphere(8), &FixedBitSet::new()).unwrap();
        let all: Vec<Vertex> = ball.vertices().filter(|&v| !ball.is_face(v)).collect();
        // Far from one another at first, then all that there are, side by side.
        let order: Vec<Vertex> = all.iter().step_by(40).chain(&all).copied().collect();
        let (later, at_once) = (moved(&order, false), moved(&order, true));
        assert!(later == at_once);
        let probes: usize = later.iter().map(Vec::len).sum();
        assert!(probes >= 3 * ball.vertices().filter(|&v| ball.is_face(v)).count());
    }
}
