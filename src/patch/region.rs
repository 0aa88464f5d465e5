//! Disk regions of the polygon mesh, grown until their rim is convex.
//!
//! A rim vertex with `o` faces outside wants `ideal − o` inside: one makes it a corner, two a
//! point of a side, three or more a dent, which is filled by taking in the faces around it. At a
//! vertex held by a boundary or feature only its sector counts, and the rim follows the frozen
//! line, so a region can stand against it but not cross.

use crate::mesh::NONE;
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

/// Grows regions; keeps its arrays from one to the next.
#[derive(Debug, Clone, Default)]
pub struct Grower {
    stamp: Vec<u32>,
    epoch: u32,
    faces: Vec<Vertex>,
    /// The walk along a rim that last met a vertex.
    met: Vec<u32>,
    walk: u32,
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
        self.met.resize(mesh.vertex_ids() as usize, 0);
        self.epoch += 1;
        self.faces.clear();
    }

    /// Number of faces taken in.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    fn holds(&self, face: Vertex) -> bool {
        self.stamp[face as usize] == self.epoch
    }

    /// Takes in a face; ghosts stay outside.
    pub fn add_face(&mut self, mesh: &QuadMesh, face: Vertex) {
        if !mesh.is_ghost(face) && !self.holds(face) {
            self.stamp[face as usize] = self.epoch;
            self.faces.push(face);
        }
    }

    /// Takes in a face, or the faces around a vertex that no boundary or feature holds.
    pub fn add(&mut self, mesh: &QuadMesh, v: Vertex) {
        if mesh.is_face(v) {
            self.add_face(mesh, v);
        } else if !mesh.is_held(v) || mesh.is_pin(v) {
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

    /// Fills dents until the rim is convex; the region, if it is a disk of at most `most` faces.
    pub fn convex(&mut self, mesh: &QuadMesh, most: usize) -> Result<Region, Stop> {
        let (mut rim, mut within) = (Vec::new(), 0);
        loop {
            let before = self.faces.len();
            if before > most {
                return Err(Stop::TooLarge);
            }
            rim = self.rim(mesh, (&rim, within))?;
            within = before;
            for i in 0..rim.len() {
                let sector = self.sector_inside(mesh, rim[(i + rim.len() - 1) % rim.len()], rim[i]);
                if sector.wanted > 2 && sector.outside > 0 {
                    self.add_sector(mesh, mesh.twin(rim[i]));
                }
            }
            if self.faces.len() == before {
                return self.region(mesh, rim);
            }
        }
    }

    /// The region of just the faces taken in, if they are a disk; its rim may have dents.
    pub fn disk(&mut self, mesh: &QuadMesh) -> Result<Region, Stop> {
        let rim = self.rim(mesh, (&[], 0))?;
        self.region(mesh, rim)
    }

    fn is_rim(&self, mesh: &QuadMesh, h: HalfEdge) -> bool {
        mesh.is_frozen(QuadMesh::quad(h)) || !self.holds(mesh.origin(QuadMesh::opposite(h)))
    }

    /// The rim as one closed walk that meets no vertex twice; `earlier` is that of the first
    /// `within` faces.
    fn rim(
        &mut self,
        mesh: &QuadMesh,
        (earlier, within): (&[HalfEdge], usize),
    ) -> Result<Vec<HalfEdge>, Stop> {
        let later = self.faces[within..].iter().flat_map(|&f| mesh.outgoing(f));
        let all = earlier.iter().copied().chain(later).filter(|&h| self.is_rim(mesh, h));
        let (mut first, mut count) = (NONE, 0);
        for h in all {
            first = first.min(h);
            count += 1;
        }
        if first == NONE {
            return Err(if self.faces.is_empty() { Stop::Empty } else { Stop::NotADisk });
        }
        self.walk += 1;
        let mut rim = Vec::with_capacity(count);
        let mut h = first;
        loop {
            let met = &mut self.met[mesh.target(h) as usize];
            if *met == self.walk || rim.len() == count {
                return Err(Stop::NotADisk);
            }
            *met = self.walk;
            rim.push(h);
            h = self.next_rim(mesh, h);
            if h == first {
                break;
            }
        }
        if rim.len() == count { Ok(rim) } else { Err(Stop::NotADisk) }
    }

    fn next_rim(&self, mesh: &QuadMesh, h: HalfEdge) -> HalfEdge {
        let mut h = mesh.ccw(h);
        while !self.is_rim(mesh, h) {
            h = mesh.twin(QuadMesh::next(h));
        }
        h
    }

    /// Counts the faces at the rim vertex between two consecutive rim edges.
    fn sector_inside(&self, mesh: &QuadMesh, before: HalfEdge, after: HalfEdge) -> RimVertex {
        let (mut h, mut inside) = (mesh.ccw(before), 1);
        while h != after {
            h = mesh.twin(QuadMesh::next(h));
            inside += 1;
        }
        let out = mesh.twin(after);
        let v = mesh.origin(out);
        let excess = mesh.excess(out);
        // Of a held vertex only the sector of the region counts.
        let outside = if mesh.is_held(v) {
            mesh.sector(out).filter(|&h| !self.holds(mesh.target(h))).count() as i32
        } else {
            mesh.valence(v) as i32 - inside
        };
        RimVertex { wanted: inside - excess, outside, excess }
    }

    /// The region within the rim that was walked along last.
    fn region(&mut self, mesh: &QuadMesh, rim: Vec<HalfEdge>) -> Result<Region, Stop> {
        let mut region = Region { faces: self.faces.clone(), ..Region::default() };
        region.faces.sort_unstable();
        region.irregularity = self.faces.iter().map(|&f| mesh.irregularity(f)).sum();
        for i in 0..rim.len() {
            let at = self.sector_inside(mesh, rim[(i + rim.len() - 1) % rim.len()], rim[i]);
            let inside = at.wanted.clamp(1, 2);
            if inside == 1 {
                region.corners.push(i);
            }
            region.irregularity += at.excess.unsigned_abs();
            region.rim_irregularity_after += (inside - at.wanted).unsigned_abs();
        }
        region.interior = self.interior(mesh);
        if region.interior.iter().any(|&v| mesh.is_held(v) && !mesh.is_pin(v)) {
            return Err(Stop::Held);
        }
        region.irregularity += region.interior.iter().map(|&v| mesh.irregularity(v)).sum::<u32>();
        let corners: usize = self.faces.iter().map(|&f| mesh.valence(f) as usize).sum();
        let edges = corners.midpoint(rim.len());
        let euler = (region.interior.len() + rim.len() + self.faces.len()) as i64 - edges as i64;
        region.rim = rim;
        if euler == 1 { Ok(region) } else { Err(Stop::NotADisk) }
    }

    /// Vertices of the faces that are not on the rim that was walked along last, sorted.
    fn interior(&mut self, mesh: &QuadMesh) -> Vec<Vertex> {
        let mut inside = Vec::new();
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

/// A rim vertex: how many faces it wants inside, has outside, and its present excess.
#[derive(Debug, Clone, Copy)]
struct RimVertex {
    wanted: i32,
    outside: i32,
    excess: i32,
}
