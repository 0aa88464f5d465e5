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

/// Probes for each face of the mesh, beside those on creases.
const PROBES_PER_FACE: usize = 3;
/// Creases below this angle get no probes of their own.
const CREASE_DEG: f64 = 25.0;

/// Where the mesh touches the reference.
#[derive(Debug, Clone, Default)]
pub struct Contact {
    /// A triangle of the reference near each vertex, by id; [`NONE`] if unknown.
    near: Vec<u32>,
    points: Vec<Point>,
    /// Distance of each probe to the mesh when it was last looked up, in units of the file.
    distance: Vec<f64>,
    /// First probe of each face, by vertex id, and the probe after each probe.
    first: Vec<u32>,
    next: Vec<u32>,
    /// The faces that probes are handed to.
    cover: Cover,
}

impl Contact {
    /// Probes of `reference` for a mesh of so many faces; not yet attached. O(n).
    #[must_use]
    pub fn new(reference: &Reference, faces: usize) -> Self {
        let mut points = reference.samples(PROBES_PER_FACE * faces);
        let sharp = reference.creases().iter().filter(|c| c.angle_deg >= CREASE_DEG);
        let mut ends: Vec<u32> = sharp.flat_map(|c| [c.a, c.b]).collect();
        ends.sort_unstable();
        ends.dedup();
        // A finely tessellated crease needs no more probes than the mesh can resolve.
        let every = ends.len().div_ceil(2 * faces.max(1)).max(1);
        points.extend(ends.iter().step_by(every).map(|&v| reference.points()[v as usize]));
        let n = points.len();
        Self { points, distance: vec![0.0; n], next: vec![NONE; n], ..Self::default() }
    }

    /// Looks everything up anew. O(n log n), parallel.
    pub fn attach(&mut self, mesh: &QuadMesh, reference: &Reference) -> Result<(), MeshError> {
        let polygons = lower(mesh, &[String::new()])?;
        self.attach_vertices(mesh, &polygons, reference);
        let Ok(surface) = Reference::plain(&polygons.mesh) else {
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

    fn attach_vertices(&mut self, mesh: &QuadMesh, polygons: &Lowered, reference: &Reference) {
        let known = |&v: &Vertex| self.near(v).unwrap_or(NONE);
        let mut near: Vec<u32> = polygons.vertex_ids.iter().map(known).collect();
        reference.closest_each(polygons.mesh.points(), &mut near, |_, _| ());
        self.near.clear();
        self.near.resize(mesh.vertex_ids() as usize, NONE);
        for (&v, near) in polygons.vertex_ids.iter().zip(near) {
            self.near[v as usize] = near;
        }
    }

    /// Number of probes.
    #[must_use]
    pub fn probe_count(&self) -> usize {
        self.points.len()
    }

    /// Σ squared distance of the probes to the mesh, in squared units of the file. O(probes).
    #[must_use]
    pub fn squared_distances(&self) -> f64 {
        self.distance.iter().map(|d| d * d).sum()
    }

    /// A triangle of the reference near `v`, if one is known.
    #[must_use]
    pub fn near(&self, v: Vertex) -> Option<u32> {
        self.near.get(v as usize).copied().filter(|&t| t != NONE)
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

    /// Hands the probes of faces that have changed or moved to the nearest of those there now.
    /// `changed` are the vertices that an edit has changed or moved.
    pub fn reassign(&mut self, mesh: &QuadMesh, changed: &[Vertex]) {
        self.first.resize(mesh.vertex_ids() as usize, NONE);
        let is_alive = |&&v: &&Vertex| mesh.is_alive(v) && !mesh.is_ghost(v);
        let moved = changed.iter().filter(is_alive).filter(|&&v| !mesh.is_face(v));
        let mut faces: Vec<Vertex> = moved.flat_map(|&v| mesh.neighbours(v)).collect();
        faces.extend(changed.iter().filter(|&&v| mesh.is_face(v)));
        faces.sort_unstable();
        faces.dedup();
        let mut loose = Vec::new();
        for &f in &faces {
            let mut probe = std::mem::replace(&mut self.first[f as usize], NONE);
            while probe != NONE {
                loose.push(probe);
                probe = self.next[probe as usize];
            }
        }
        faces.retain(|&f| mesh.is_alive(f) && !mesh.is_ghost(f));
        let corners = |&f: &Vertex| mesh.neighbours(f).map(|v| mesh.position(v));
        self.cover.fill(faces.iter().map(corners));
        for probe in loose {
            if let Some((squared, i)) =
                self.cover.nearest(&self.points[probe as usize], f64::INFINITY)
            {
                self.put(probe, faces[i], squared.sqrt());
            }
        }
    }

    fn put(&mut self, probe: u32, face: Vertex, distance: f64) {
        self.distance[probe as usize] = distance;
        self.next[probe as usize] = self.first[face as usize];
        self.first[face as usize] = probe;
    }
}
