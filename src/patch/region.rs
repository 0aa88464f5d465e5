//! Disk regions of the polygon mesh, grown until their rim is convex.
//!
//! A rim vertex with `o` faces outside wants `ideal − o` inside: one makes it a corner, two a
//! point of a side, three or more a dent, which is filled by taking in the faces around it. At a
//! vertex held by a boundary or feature only its sector counts, and the rim follows the frozen
//! line, so a region can stand against it but not cross.

use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use rustc_hash::FxBuildHasher;
use std::hash::BuildHasher;

/// A disk of faces with a convex rim, ready to be refilled.
#[derive(Debug, Clone, Default)]
pub struct Region {
    /// The faces (d-vertices), sorted.
    pub faces: Vec<Vertex>,
    /// One half-edge face → vertex for each rim edge, counter-clockwise; the edge goes from the
    /// target of the half-edge to the target of the next one.
    pub rim: Vec<HalfEdge>,
    /// Positions in `rim` of the corners.
    pub corners: Vec<usize>,
    /// Vertices all of whose faces are inside.
    pub interior: Vec<Vertex>,
    /// Irregularity of faces, interior and rim vertices as they are.
    pub irregularity: u32,
    /// Irregularity of the rim vertices once each has as many faces inside as its corner says.
    pub rim_irregularity_after: u32,
}

impl Region {
    /// A number for the set of faces: equal for equal sets, and hardly ever otherwise.
    #[must_use]
    pub fn key(&self) -> u64 {
        FxBuildHasher.hash_one(&self.faces)
    }
}

/// A disk of faces that has been grown, before it is written out as a [`Region`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Outline {
    /// Number of faces.
    pub faces: usize,
    /// Number of rim edges.
    pub rim: usize,
    /// Number of corners.
    pub corners: usize,
    /// As in [`Region`].
    pub irregularity: u32,
    /// As in [`Region`].
    pub rim_irregularity_after: u32,
}

/// Grows regions; keeps its arrays from one to the next.
#[derive(Debug, Clone, Default)]
pub struct Grower {
    /// The region that a face was last taken into, or that a vertex was last met in.
    stamp: Vec<u32>,
    /// How many faces at a vertex of the region are inside; no more than this type holds.
    inside: Vec<u16>,
    epoch: u32,
    faces: Vec<Vertex>,
    tally: Tally,
    /// Half-edges to faces, from vertices where the rim was dented when that face was taken in.
    dents: Vec<HalfEdge>,
    /// The walk along a rim that last met a vertex.
    met: Vec<u32>,
    walk: u32,
    /// Where that led, and how many faces are inside at the target of each half-edge.
    rim: Vec<(HalfEdge, i32)>,
    /// Positions of the corners on it.
    corners: Vec<usize>,
}

/// What the faces of a region add up to.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    /// Edges on the rim.
    rim: usize,
    /// Corners of all faces.
    corners: usize,
    /// Vertices of the faces,
    vertices: usize,
    /// and how many of them a boundary or feature holds.
    held: usize,
    /// Irregularity of faces, and of vertices that are not held.
    irregularity: u32,
}

/// Why a region cannot be refilled as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// It would hold more faces than allowed.
    TooLarge,
    /// It is no disk, or its rim touches itself.
    NotADisk,
    /// It is empty.
    Empty,
    /// A vertex inside is held by a boundary or feature.
    Held,
}

impl Grower {
    /// Begins a new region.
    pub fn start(&mut self, mesh: &QuadMesh) {
        self.stamp.resize(mesh.vertex_ids() as usize, 0);
        self.inside.resize(mesh.vertex_ids() as usize, 0);
        self.met.resize(mesh.vertex_ids() as usize, 0);
        self.epoch += 1;
        self.faces.clear();
        self.dents.clear();
        self.tally = Tally::default();
    }

    /// Number of faces taken in.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Whether a face, or a vertex of a face, has been taken in.
    fn holds(&self, v: Vertex) -> bool {
        self.stamp[v as usize] == self.epoch
    }

    /// Takes in a face; ghosts stay outside.
    pub fn add_face(&mut self, mesh: &QuadMesh, face: Vertex) {
        if mesh.is_ghost(face) || self.holds(face) {
            return;
        }
        self.stamp[face as usize] = self.epoch;
        self.faces.push(face);
        self.tally.irregularity += mesh.irregularity(face);
        for h in mesh.outgoing(face) {
            self.tally.corners += 1;
            if self.is_rim(mesh, h) {
                self.tally.rim += 1;
            } else if mesh.origin(QuadMesh::opposite(h)) != face {
                self.tally.rim -= 1;
            }
            let v = mesh.target(h);
            let is_new = !self.holds(v);
            self.stamp[v as usize] = self.epoch;
            let count = &mut self.inside[v as usize];
            *count = if is_new { 1 } else { count.saturating_add(1) };
            if mesh.is_held(v) || u32::from(*count) + 1 == mesh.valence(v) {
                self.dents.push(mesh.twin(h));
            }
            if is_new {
                self.tally.vertices += 1;
                if mesh.is_on_line(v) {
                    self.tally.held += 1;
                } else {
                    self.tally.irregularity += mesh.irregularity(v);
                }
            }
        }
    }

    /// Takes in a face, or the faces around a vertex that no boundary or feature holds.
    pub fn add(&mut self, mesh: &QuadMesh, v: Vertex) {
        if mesh.is_face(v) {
            self.add_face(mesh, v);
        } else if !mesh.is_on_line(v) {
            mesh.neighbours(v).for_each(|f| self.add_face(mesh, f));
        }
    }

    /// Takes in the faces around the origin of `h`, within the sector of `h`.
    pub fn add_sector(&mut self, mesh: &QuadMesh, h: HalfEdge) {
        mesh.sector(h).for_each(|h| self.add_face(mesh, mesh.target(h)));
    }

    /// Takes in every face across a rim edge that is not frozen.
    pub fn add_ring(&mut self, mesh: &QuadMesh) {
        for i in 0..self.faces.len() {
            for h in mesh.outgoing(self.faces[i]) {
                if !mesh.is_frozen(QuadMesh::quad(h)) {
                    self.add_face(mesh, mesh.origin(QuadMesh::opposite(h)));
                }
            }
        }
    }

    /// Fills dents until the rim is convex; what comes of it, if it is a disk of at most `most`
    /// faces.
    ///
    /// What is taken in after that is added to what there is: the convex disk around two sets is
    /// that around the second and the convex disk around the first. O(faces).
    pub fn convex(&mut self, mesh: &QuadMesh, most: usize) -> Result<Outline, Stop> {
        while self.faces.len() <= most {
            let Some(out) = self.dents.pop() else { return self.disk(mesh) };
            if self.is_dent(mesh, out) {
                self.add_sector(mesh, out);
            }
        }
        Err(Stop::TooLarge)
    }

    /// Whether the rim is dented at the origin of `out`, a half-edge to a face that is inside: that
    /// wants `ideal − outside` faces inside, so three or more if the ideal is four and one is outside.
    fn is_dent(&self, mesh: &QuadMesh, out: HalfEdge) -> bool {
        let v = mesh.origin(out);
        if !mesh.is_held(v) {
            return u32::from(self.inside[v as usize]) + 1 == mesh.valence(v);
        }
        // Only the sector of the region counts.
        let (mut all, mut outside) = (0, 0);
        for h in mesh.sector(out) {
            all += 1;
            outside += i32::from(!self.holds(mesh.target(h)));
        }
        outside > 0 && all - mesh.excess(out) - outside > 2
    }

    /// What comes of just the faces taken in, if they are a disk; its rim may have dents. O(rim).
    pub fn disk(&mut self, mesh: &QuadMesh) -> Result<Outline, Stop> {
        self.walk_rim(mesh)?;
        let (mut irregularity, mut rim_irregularity_after, mut held) =
            (self.tally.irregularity, 0, 0);
        self.corners.clear();
        for (i, &(h, inside)) in self.rim.iter().enumerate() {
            let (v, excess) = (mesh.target(h), mesh.excess(mesh.twin(h)));
            let wanted = inside - excess;
            if wanted <= 1 {
                self.corners.push(i);
            }
            rim_irregularity_after += (wanted.clamp(1, 2) - wanted).unsigned_abs();
            if mesh.is_on_line(v) {
                held += 1;
                irregularity += excess.unsigned_abs();
            }
        }
        if held < self.tally.held {
            return Err(Stop::Held);
        }
        let (faces, rim, corners) = (self.faces.len(), self.rim.len(), self.corners.len());
        let edges = self.tally.corners.midpoint(rim);
        if self.tally.vertices + faces == edges + 1 {
            Ok(Outline { faces, rim, corners, irregularity, rim_irregularity_after })
        } else {
            Err(Stop::NotADisk)
        }
    }

    /// Writes out the disk that [`Self::convex`] or [`Self::disk`] has just found.
    #[must_use]
    pub fn region(&mut self, mesh: &QuadMesh, outline: Outline) -> Region {
        let mut faces = self.faces.clone();
        faces.sort_unstable();
        Region {
            faces,
            rim: self.rim.iter().map(|at| at.0).collect(),
            corners: self.corners.clone(),
            interior: self.interior(mesh),
            irregularity: outline.irregularity,
            rim_irregularity_after: outline.rim_irregularity_after,
        }
    }

    fn is_rim(&self, mesh: &QuadMesh, h: HalfEdge) -> bool {
        mesh.is_frozen(QuadMesh::quad(h)) || !self.holds(mesh.origin(QuadMesh::opposite(h)))
    }

    /// Walks along the rim, from its least half-edge, if it is one closed walk that meets no vertex
    /// twice.
    fn walk_rim(&mut self, mesh: &QuadMesh) -> Result<(), Stop> {
        // What was taken in last is most likely on the rim.
        let mut all = self.faces.iter().rev().flat_map(|&f| mesh.outgoing(f));
        let Some(first) = all.find(|&h| self.is_rim(mesh, h)) else {
            return Err(if self.faces.is_empty() { Stop::Empty } else { Stop::NotADisk });
        };
        self.walk += 1;
        self.rim.clear();
        let mut h = first;
        loop {
            let inside;
            (h, inside) = self.next_rim(mesh, h);
            let met = &mut self.met[mesh.target(h) as usize];
            if *met == self.walk || self.rim.len() == self.tally.rim {
                return Err(Stop::NotADisk);
            }
            *met = self.walk;
            self.rim.push((h, inside));
            if h == first {
                break;
            }
        }
        if self.rim.len() < self.tally.rim {
            return Err(Stop::NotADisk);
        }
        let least = (0..self.rim.len()).min_by_key(|&i| self.rim[i].0).unwrap_or(0);
        self.rim.rotate_left(least);
        Ok(())
    }

    /// The rim edge after `h`, and how many faces are inside where they meet.
    fn next_rim(&self, mesh: &QuadMesh, h: HalfEdge) -> (HalfEdge, i32) {
        let (mut h, mut inside) = (mesh.ccw(h), 1);
        while !self.is_rim(mesh, h) {
            h = mesh.twin(QuadMesh::next(h));
            inside += 1;
        }
        (h, inside)
    }

    /// Vertices of the faces that are not on the rim that was walked along last, sorted.
    fn interior(&mut self, mesh: &QuadMesh) -> Vec<Vertex> {
        let mut inside = Vec::with_capacity(self.tally.vertices - self.rim.len());
        for v in self.faces.iter().flat_map(|&f| mesh.neighbours(f)) {
            let met = &mut self.met[v as usize];
            if *met != self.walk {
                *met = self.walk;
                inside.push(v);
            }
        }
        inside.sort_unstable();
        inside
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{PolyMesh, shapes};
    use crate::sqrtcc::lift;
    use fixedbitset::FixedBitSet;
    use proptest::prelude::*;

    fn lifted(mesh: &PolyMesh) -> (QuadMesh, Vec<Vertex>) {
        let mesh = lift(mesh, &FixedBitSet::new()).unwrap();
        let faces = mesh.vertices().filter(|&f| mesh.is_face(f)).collect();
        (mesh, faces)
    }

    fn grown(mesh: &QuadMesh, grower: &mut Grower, faces: &[Vertex]) -> Result<Region, Stop> {
        for &f in faces {
            grower.add_face(mesh, f);
        }
        let outline = grower.convex(mesh, usize::MAX)?;
        let region = grower.region(mesh, outline);
        assert_eq!(outline.faces, region.faces.len());
        assert_eq!((outline.rim, outline.corners), (region.rim.len(), region.corners.len()));
        Ok(region)
    }

    #[test]
    fn a_ring_of_faces_is_filled() {
        let (mesh, faces) = lifted(&shapes::grid(7, 7));
        let ring = [16, 17, 18, 23, 25, 30, 31, 32].map(|i: usize| faces[i]);
        let mut grower = Grower::default();
        grower.start(&mesh);
        let region = grown(&mesh, &mut grower, &ring).unwrap();
        assert_eq!(region.faces.len(), 9);
        assert_eq!((region.rim.len(), region.corners.len(), region.interior.len()), (12, 4, 4));
        assert_eq!((region.irregularity, region.rim_irregularity_after), (0, 0));
    }

    proptest! {
        #[test]
        fn growing_on_is_the_same_as_growing_at_once(
            first in prop::collection::vec(any::<prop::sample::Index>(), 1..6),
            more in prop::collection::vec(any::<prop::sample::Index>(), 1..6),
        ) {
            for mesh in [shapes::cube(6), shapes::grid(9, 9), shapes::torus(8, 12)] {
                let (mesh, faces) = lifted(&mesh);
                let pick = |chosen: &[prop::sample::Index]| -> Vec<Vertex> {
                    chosen.iter().map(|i| *i.get(&faces)).collect()
                };
                let (first, more) = (pick(&first), pick(&more));
                let mut grower = Grower::default();
                grower.start(&mesh);
                let _ = grown(&mesh, &mut grower, &first);
                let later = grown(&mesh, &mut grower, &more).map(|r| (r.faces, r.rim, r.corners));
                grower.start(&mesh);
                let at_once = grown(&mesh, &mut grower, &[first, more].concat());
                prop_assert_eq!(later, at_once.map(|r| (r.faces, r.rim, r.corners)));
            }
        }
    }
}
