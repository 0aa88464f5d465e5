//! Regions worth refilling: around an irregular element and the ones nearest to it.

use crate::mesh::NONE;
use crate::patch::region::Stop;
use crate::patch::{Grower, Outline, Region};
use crate::sqrtcc::{HalfEdge, QuadKind, QuadMesh, Vertex};

/// How far and how large the search for regions goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Most faces of a region.
    pub faces: usize,
    /// How many of the nearest irregular elements are joined to the seed.
    pub partners: usize,
    /// How many elements fewer a region must be able to have.
    pub least_gain: u32,
}

/// What came of growing a region.
type Grown = Result<Outline, Stop>;

/// Vertices and faces around a seed among which feature edges are looked for.
const NEARBY: usize = 200;

/// Finds regions; keeps its arrays from one seed to the next.
#[derive(Debug, Clone, Default)]
pub struct Clusters {
    grower: Grower,
    /// Grows regions around the first few partners together.
    joint: Grower,
    parent: Vec<Vertex>,
    visited: Vec<Vertex>,
    /// Whether a region was too large.
    limited: bool,
}

impl Clusters {
    /// Whether a region has been left out since this was asked last because it was too large.
    pub fn take_limited(&mut self) -> bool {
        std::mem::take(&mut self.limited)
    }

    /// Convex disks around `seed`, small to large: with each of the nearest irregular elements
    /// alone, and with the first two, three, … of them together. Only regions whose irregularity
    /// can fall are given. O(faces · regions).
    pub fn around(&mut self, mesh: &QuadMesh, seed: Vertex, limits: Limits) -> Vec<Region> {
        let mut regions: Vec<Region> = Vec::new();
        if mesh.is_on_line(seed) {
            for sector in mesh.sectors(seed).filter(|&h| mesh.excess(h) != 0) {
                self.around_sector(mesh, sector, limits, &mut regions);
            }
        } else {
            self.around_sector(mesh, mesh.out(seed), limits, &mut regions);
        }
        smallest_first(regions)
    }

    /// The convex disk around everything in `joined`, if its irregularity can fall.
    pub fn joining(
        &mut self,
        mesh: &QuadMesh,
        joined: &[Vertex],
        limits: Limits,
    ) -> Option<Region> {
        self.grower.start(mesh);
        for &v in joined {
            self.grower.add(mesh, v);
        }
        let outline = self.grower.convex(mesh, limits.faces).ok()?;
        can_gain(&outline, limits.least_gain).then(|| self.grower.region(mesh, outline))
    }

    /// Convex disks beside the origin of `at`, a vertex of a feature, on the side of `at`, small to
    /// large.
    pub fn beside(&mut self, mesh: &QuadMesh, at: HalfEdge, limits: Limits) -> Vec<Region> {
        let mut regions = Vec::new();
        self.around_sector(mesh, at, limits, &mut regions);
        smallest_first(regions)
    }

    /// The convex disk around the origins of `at`, on their sides, and `faces`.
    pub fn spanning(
        &mut self,
        mesh: &QuadMesh,
        at: &[HalfEdge],
        faces: &[Vertex],
        most: usize,
    ) -> Option<Region> {
        self.grower.start(mesh);
        for &h in at {
            self.grower.add_sector(mesh, h);
        }
        for &f in faces {
            self.grower.add_face(mesh, f);
        }
        let outline = self.grower.convex(mesh, most);
        self.limited |= is_too_large(&outline);
        Some(self.grower.region(mesh, outline.ok()?))
    }

    /// The feature edges nearest to `seed` by steps that cross none, each as the half-edge from an
    /// end to the face on the side of the seed.
    pub fn feature_edges(&mut self, mesh: &QuadMesh, seed: Vertex, most: usize) -> Vec<HalfEdge> {
        self.parent.resize(mesh.vertex_ids() as usize, NONE);
        if mesh.is_on_line(seed) {
            for sector in mesh.sectors(seed).filter(|&h| mesh.excess(h) != 0) {
                mesh.sector(sector).for_each(|h| self.visit(mesh, mesh.target(h), seed));
            }
        } else {
            self.visit(mesh, seed, seed);
        }
        let (mut next, mut found) = (0, Vec::new());
        while let Some(&v) = self.visited.get(next).filter(|_| next < NEARBY && found.len() < most)
        {
            next += 1;
            if mesh.is_face(v) {
                let lines = |&h: &HalfEdge| mesh.kind(QuadMesh::quad(h)) == QuadKind::Feature;
                found.extend(mesh.outgoing(v).filter(lines).map(QuadMesh::prev));
            }
            if !mesh.is_on_line(v) {
                mesh.neighbours(v).for_each(|w| self.visit(mesh, w, v));
            }
        }
        self.forget();
        found
    }

    fn forget(&mut self) {
        for v in std::mem::take(&mut self.visited) {
            self.parent[v as usize] = NONE;
        }
    }

    /// Adds the regions around the origin of `at` on the side of `at`.
    fn around_sector(
        &mut self,
        mesh: &QuadMesh,
        at: HalfEdge,
        limits: Limits,
        regions: &mut Vec<Region>,
    ) {
        let most = limits.faces;
        let keep = |grower: &mut Grower, grown: Grown, regions: &mut Vec<Region>| {
            let Ok(outline) = grown else { return };
            let mut sizes = regions.iter().map(|r| (r.rim.len(), r.faces.len()));
            let known = sizes.any(|sizes| sizes == (outline.rim, outline.faces));
            if !known && can_gain(&outline, limits.least_gain) {
                regions.push(grower.region(mesh, outline));
            }
        };
        let alone = grow(&mut self.joint, mesh, (at, &self.parent), None, most);
        // A convex disk around more is no smaller: what is too large will not fit any more.
        if is_too_large(&alone) {
            self.limited = true;
            return;
        }
        keep(&mut self.joint, alone, regions);
        let partners = self.nearest(mesh, at, limits);
        let mut fits = true;
        for (i, &partner) in partners.iter().enumerate() {
            let ways = (at, &self.parent[..]);
            let single = grow(&mut self.grower, mesh, ways, Some(partner), most);
            fits &= !is_too_large(&single);
            keep(&mut self.grower, single, regions);
            // A disk that holds the next way already is the same with it; so is the first single.
            if fits && add_way(&mut self.joint, mesh, ways, partner) && i > 0 {
                let together = self.joint.convex(mesh, most);
                fits = !is_too_large(&together);
                keep(&mut self.joint, together, regions);
            }
        }
        self.limited |= !fits;
        self.forget();
    }

    /// The irregular elements nearest to the origin of `at` on the side of `at`, by steps in Q that
    /// do not cross frozen lines.
    fn nearest(&mut self, mesh: &QuadMesh, at: HalfEdge, limits: Limits) -> Vec<Vertex> {
        let seed = mesh.origin(at);
        self.parent.resize(mesh.vertex_ids() as usize, NONE);
        self.parent[seed as usize] = seed;
        self.visited.push(seed);
        let (mut next, mut found) = (0, Vec::new());
        while next < self.visited.len() && found.len() < limits.partners && next < 4 * limits.faces
        {
            let v = self.visited[next];
            next += 1;
            if v != seed && mesh.irregularity(v) > 0 {
                found.push(v);
            }
            if v == seed {
                mesh.sector(at).for_each(|h| self.visit(mesh, mesh.target(h), v));
            } else if !mesh.is_on_line(v) {
                mesh.neighbours(v).for_each(|w| self.visit(mesh, w, v));
            }
        }
        found
    }

    fn visit(&mut self, mesh: &QuadMesh, v: Vertex, from: Vertex) {
        if self.parent[v as usize] == NONE && !mesh.is_ghost(v) {
            self.parent[v as usize] = from;
            self.visited.push(v);
        }
    }
}

/// The convex disk around the origin of `start`, on its side, and the way to a partner.
fn grow(
    grower: &mut Grower,
    mesh: &QuadMesh,
    (start, parent): (HalfEdge, &[Vertex]),
    partner: Option<Vertex>,
    most: usize,
) -> Grown {
    grower.start(mesh);
    let seed = mesh.origin(start);
    if mesh.is_face(seed) {
        grower.add_face(mesh, seed);
    } else {
        grower.add_sector(mesh, start);
    }
    if let Some(partner) = partner {
        add_way(grower, mesh, (start, parent), partner);
    }
    grower.convex(mesh, most)
}

/// Takes in the faces on the way from the origin of `start` to a partner; whether there were any
/// that had not been taken in.
fn add_way(
    grower: &mut Grower,
    mesh: &QuadMesh,
    (start, parent): (HalfEdge, &[Vertex]),
    partner: Vertex,
) -> bool {
    let before = grower.face_count();
    let mut at = partner;
    while at != mesh.origin(start) {
        let from = parent[at as usize];
        if mesh.is_face(at) {
            grower.add_face(mesh, at);
        } else if let Some(h) = mesh.find(at, from) {
            grower.add_sector(mesh, h);
        }
        at = from;
    }
    grower.face_count() > before
}

fn smallest_first(mut regions: Vec<Region>) -> Vec<Region> {
    regions.sort_by_key(|region| region.faces.len());
    regions
}

fn is_too_large(grown: &Grown) -> bool {
    matches!(grown, Err(Stop::TooLarge))
}

fn can_gain(outline: &Outline, least: u32) -> bool {
    let after = least_after(outline.corners, outline.rim_irregularity_after);
    after + least <= outline.irregularity
}

/// The least irregularity that a filling of a region can have, by its number of corners and what its
/// rim will have.
pub(super) fn least_after(corners: usize, rim_irregularity_after: u32) -> u32 {
    let inside = match corners {
        k @ 2..=6 => k.abs_diff(4) as u32,
        _ => return u32::MAX / 2,
    };
    inside + rim_irregularity_after
}
