//! Replacing the inside of a disk region by a filling, in Q.
//!
//! The quads of the rim stay and only change their inner d-corner; everything inside is new. The
//! construction is that of lifting: each corner of a new face owns the half-edge face → vertex.

use super::embed::OldPatch;
use super::{Filling, Region};
use crate::mesh::{NONE, Point};
use crate::ops::{MAX_VALENCE, MIN_VALENCE, Refusal};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use rustc_hash::FxHashMap;
use serde::{Deserialize, Serialize};

/// A region and what to put in its place.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Refill {
    /// The faces that go.
    pub faces: Vec<Vertex>,
    /// The vertices that go with them.
    pub interior: Vec<Vertex>,
    /// The rim, as in [`Region::rim`].
    pub rim: Vec<HalfEdge>,
    /// What takes their place.
    pub filling: Filling,
    /// Where its new vertices are.
    #[serde(skip)]
    pub places: Vec<Point>,
    /// Which of its new vertices take the places of the pins inside.
    pub pins: Vec<u32>,
}

impl Refill {
    /// Puts `filling`, whose rim vertex 0 is the start of `region.rim[0]`, in place of `region`;
    /// refused if it has fewer new vertices than there are pins inside.
    pub fn new(mesh: &QuadMesh, region: &Region, filling: Filling) -> Result<Self, Refusal> {
        Self::of(mesh, (region, &OldPatch::new(mesh, region)), filling)
    }

    /// The same for a region that is embedded already.
    pub fn of(
        mesh: &QuadMesh,
        (region, embedded): (&Region, &OldPatch),
        filling: Filling,
    ) -> Result<Self, Refusal> {
        let mut places = embedded.transport(&filling);
        let pins = pins(mesh, region, &mut places)?;
        Ok(Self {
            faces: region.faces.clone(),
            interior: region.interior.clone(),
            rim: region.rim.clone(),
            filling,
            places,
            pins,
        })
    }

    /// Replaces the region, whole or not at all.
    pub fn run(&self, mesh: &mut QuadMesh) -> Result<(), Refusal> {
        self.check(mesh)?;
        let mark = mesh.mark();
        let rim: Vec<Vertex> = self.rim.iter().map(|&h| mesh.target(h)).collect();
        let group = self.faces[0];
        self.remove_inside(mesh, &rim);
        self.insert(mesh, &rim, group);
        let sound = rim.iter().all(|&v| {
            let most = if mesh.is_held(v) { u32::MAX } else { MAX_VALENCE };
            (MIN_VALENCE..=most).contains(&mesh.valence(v)) && mesh.check_vertex(v).is_ok()
        });
        if sound {
            return Ok(());
        }
        mesh.undo_to(mark);
        Err(Refusal::DoubleEdge)
    }

    /// Whether the region is still there.
    fn check(&self, mesh: &QuadMesh) -> Result<(), Refusal> {
        let alive = |v: Vertex| v < mesh.vertex_ids() && mesh.is_alive(v);
        let whole = !self.faces.is_empty()
            && self.faces.iter().chain(&self.interior).all(|&v| alive(v))
            && self.rim.iter().all(|&h| h >> 2 < mesh.quad_ids() && mesh.origin(h) != NONE);
        whole.then_some(()).ok_or(Refusal::Gone)
    }

    /// Removes faces, interior vertices and the quads between the faces; rim vertices lose the
    /// edges to the faces.
    fn remove_inside(&self, mesh: &mut QuadMesh, rim: &[Vertex]) {
        let mut on_rim: Vec<HalfEdge> = self.rim.iter().map(|&h| QuadMesh::quad(h)).collect();
        on_rim.sort_unstable();
        let mut inner: Vec<u32> = Vec::new();
        for &f in &self.faces {
            inner.extend(mesh.outgoing(f).map(QuadMesh::quad));
        }
        inner.sort_unstable();
        inner.dedup();
        inner.retain(|q| on_rim.binary_search(q).is_err());
        for i in 0..self.faces.len() {
            let corners: smallvec::SmallVec<[Vertex; 8]> = mesh.neighbours(self.faces[i]).collect();
            for v in corners {
                if self.interior.binary_search(&v).is_err() {
                    mesh.set_valence(v, mesh.valence(v) - 1);
                }
            }
        }
        for &v in self.faces.iter().chain(&self.interior) {
            mesh.kill_vertex(v);
        }
        for q in inner {
            mesh.kill_quad(q);
        }
        for (&v, &h) in rim.iter().zip(&self.rim) {
            mesh.set_out(v, QuadMesh::next(h));
        }
    }

    fn insert(&self, mesh: &mut QuadMesh, rim: &[Vertex], like: Vertex) {
        let mut ids = rim.to_vec();
        ids.extend(self.places.iter().map(|&p| mesh.add_vertex_like(rim[0], p)));
        self.pins.iter().for_each(|&i| mesh.pin(ids[rim.len() + i as usize]));
        let slots = self.slots(mesh);
        let mut c = 0;
        for face in self.filling.faces() {
            let f = mesh.add_vertex_like(like, Point::origin());
            mesh.set_out(f, slots[c]);
            mesh.set_valence(f, face.len() as u32);
            for i in 0..face.len() {
                let slot = slots[c + i];
                let v = ids[face[i] as usize];
                mesh.set_origin(slot, f);
                mesh.set_origin(QuadMesh::next(slot), v);
                mesh.set_valence(v, mesh.valence(v) + 1);
                if face[i] >= self.filling.rim {
                    mesh.set_out(v, QuadMesh::next(slot));
                }
                mesh.join(QuadMesh::prev(slot), slots[c + (i + 1) % face.len()]);
            }
            c += face.len();
        }
    }

    /// The half-edge face → vertex that each corner of the filling owns: in a quad of the rim, or
    /// in a new quad that it shares with the corner across the edge.
    fn slots(&self, mesh: &mut QuadMesh) -> Vec<HalfEdge> {
        let n = self.filling.rim;
        let mut open: FxHashMap<(u32, u32), HalfEdge> = FxHashMap::default();
        let mut slots = Vec::with_capacity(self.filling.corners.len());
        for face in self.filling.faces() {
            for (i, &a) in face.iter().enumerate() {
                let b = face[(i + 1) % face.len()];
                let slot = if a < n && b == (a + 1) % n {
                    self.rim[a as usize]
                } else if let Some(across) = open.remove(&(b, a)) {
                    across
                } else {
                    let base = 4 * mesh.add_quad();
                    open.insert((a, b), base + 1);
                    base + 3
                };
                slots.push(slot);
            }
        }
        slots
    }
}

/// For each pin inside `region` the new vertex nearest to it that no other has taken; it is put
/// exactly there. O(pins · vertices).
fn pins(mesh: &QuadMesh, region: &Region, places: &mut [Point]) -> Result<Vec<u32>, Refusal> {
    let mut taken: Vec<u32> = Vec::new();
    for at in region.interior.iter().filter(|&&v| mesh.is_pin(v)).map(|&v| mesh.position(v)) {
        let free = (0..places.len() as u32).filter(|i| !taken.contains(i));
        let nearest = free.min_by(|&i, &j| {
            let from = |i: u32| (places[i as usize] - at).norm_squared();
            from(i).total_cmp(&from(j))
        });
        let nearest = nearest.ok_or(Refusal::Held)?;
        places[nearest as usize] = at;
        taken.push(nearest);
    }
    Ok(taken)
}
