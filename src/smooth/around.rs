//! Relaxing the surroundings of an edit in place, for edits that nobody has to judge first.

use super::RelaxOptions;
use super::region::{Orientation, Region, relax_local};
use super::soundness::scaled_jacobian;
use crate::mesh::Vector;
use crate::sqrtcc::{QuadMesh, Vertex};
use crate::surface::Reference;
use rustc_hash::FxHashMap;
use smallvec::SmallVec;

/// The faces within some rings of edited vertices, and the vertices of those faces.
#[derive(Debug, Clone, Default)]
pub struct Surroundings {
    vertices: Vec<Vertex>,
    faces: Vec<Vertex>,
    /// The first so many vertices have all their faces in it.
    inner: usize,
    /// The first so many faces are those at the edited vertices.
    core: usize,
    number: FxHashMap<Vertex, u32>,
}

impl Surroundings {
    /// Gathers `rings` rings of faces around `touched`; ids that are dead or ghosts are passed
    /// over. O(size of the result).
    #[must_use]
    pub fn gather(mesh: &QuadMesh, touched: &[Vertex], rings: u32) -> Self {
        let mut around = Self::default();
        let there = |&&v: &&Vertex| v < mesh.vertex_ids() && mesh.is_alive(v) && !mesh.is_ghost(v);
        for &v in touched.iter().filter(there) {
            if mesh.is_face(v) {
                mesh.neighbours(v).for_each(|p| around.add(mesh, p));
            } else {
                around.add(mesh, v);
            }
        }
        for ring in 0..rings {
            let first = std::mem::replace(&mut around.inner, around.vertices.len());
            for i in first..around.inner {
                for f in mesh.neighbours(around.vertices[i]).filter(|&f| !mesh.is_ghost(f)) {
                    if around.number.insert(f, around.faces.len() as u32).is_none() {
                        around.faces.push(f);
                        mesh.neighbours(f).for_each(|p| around.add(mesh, p));
                    }
                }
            }
            if ring == 0 {
                around.core = around.faces.len();
            }
        }
        around
    }

    fn add(&mut self, mesh: &QuadMesh, v: Vertex) {
        let next = self.vertices.len() as u32;
        if !mesh.is_ghost(v) && !self.number.contains_key(&v) {
            self.number.insert(v, next);
            self.vertices.push(v);
        }
    }

    /// The vertices that may move: nothing holds them and all their faces are here.
    pub fn free<'a>(&'a self, mesh: &'a QuadMesh) -> impl Iterator<Item = Vertex> + 'a {
        self.vertices[..self.inner].iter().copied().filter(|&v| !mesh.is_held(v))
    }

    /// Moves the free vertices for good shapes of the faces, on the reference; the least scaled
    /// Jacobian of the quads at the edited vertices then. Journaled.
    pub fn relax(
        &self,
        mesh: &mut QuadMesh,
        (reference, orientation): (&Reference, Orientation),
        options: &RelaxOptions,
        iterations: u32,
    ) -> f64 {
        let mut region = Region::new();
        region.begin(orientation);
        for (i, &v) in self.vertices.iter().enumerate() {
            let held = i >= self.inner || mesh.is_held(v);
            region.add_vertex(mesh.position(v), held, None);
        }
        for &f in &self.faces {
            let corners: SmallVec<[u32; 8]> =
                mesh.neighbours(f).filter_map(|v| self.number.get(&v).copied()).collect();
            region.add_face(&corners);
        }
        relax_local(&mut region, (reference, None), options, iterations);
        for (i, &v) in self.vertices[..self.inner].iter().enumerate() {
            if !mesh.is_held(v) {
                mesh.set_position(v, region.point(i as u32));
            }
        }
        (0..self.core).map(|f| jacobian(&region, f)).fold(1.0, f64::min)
    }
}

/// Scaled Jacobian of face `f` on the side of the reference; 1 unless it is a quad.
fn jacobian(region: &Region, f: usize) -> f64 {
    let Ok(quad) = <[u32; 4]>::try_from(region.face(f)) else { return 1.0 };
    let p = quad.map(|v| region.point(v));
    let up: Vector = quad.iter().map(|&v| region.normal(v)).sum();
    let along = (p[2] - p[0]).cross(&(p[3] - p[1])).dot(&up) >= 0.0;
    if along { scaled_jacobian(&p, &[0, 1, 2, 3]) } else { -1.0 }
}
