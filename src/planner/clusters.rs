//! Regions worth refilling: around an irregular element and the ones nearest to it.

use crate::mesh::NONE;
use crate::patch::{Grower, Region};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};

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

/// Finds regions; keeps its arrays from one seed to the next.
#[derive(Debug, Clone, Default)]
pub struct Clusters {
    grower: Grower,
    parent: Vec<Vertex>,
    visited: Vec<Vertex>,
}

impl Clusters {
    /// Convex disks around `seed`, small to large: with each of the nearest irregular elements
    /// alone, and with the first two, three, … of them together. Only regions whose irregularity
    /// can fall are given. O(faces · regions).
    pub fn around(&mut self, mesh: &QuadMesh, seed: Vertex, limits: Limits) -> Vec<Region> {
        let mut regions: Vec<Region> = Vec::new();
        if mesh.is_held(seed) && !mesh.is_pin(seed) {
            for sector in mesh.sectors(seed).filter(|&h| mesh.excess(h) != 0) {
                self.around_sector(mesh, sector, limits, &mut regions);
            }
        } else {
            self.around_sector(mesh, mesh.out(seed), limits, &mut regions);
        }
        regions.sort_by_key(|r| r.faces.len());
        regions
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
        let region = self.grower.convex(mesh, limits.faces).ok()?;
        can_gain(&region, limits.least_gain).then_some(region)
    }

    /// Adds the regions around the origin of `at` on the side of `at`.
    fn around_sector(
        &mut self,
        mesh: &QuadMesh,
        at: HalfEdge,
        limits: Limits,
        regions: &mut Vec<Region>,
    ) {
        let partners = self.nearest(mesh, at, limits);
        let keep = |region: Option<Region>, regions: &mut Vec<Region>| {
            let Some(region) = region else { return };
            let known = regions
                .iter()
                .any(|r| r.rim.len() == region.rim.len() && r.faces.len() == region.faces.len());
            if !known && can_gain(&region, limits.least_gain) {
                regions.push(region);
            }
        };
        keep(self.grow(mesh, at, &[], limits.faces), regions);
        for i in 0..partners.len() {
            keep(self.grow(mesh, at, &partners[i..=i], limits.faces), regions);
            keep(self.grow(mesh, at, &partners[..=i], limits.faces), regions);
        }
        for v in std::mem::take(&mut self.visited) {
            self.parent[v as usize] = NONE;
        }
    }

    /// The irregular elements nearest to the origin of `at` on the side of `at`, by steps in Q that do not cross frozen lines.
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
            } else if !mesh.is_held(v) || mesh.is_pin(v) {
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

    /// The convex disk around the origin of `start`, on its side, and the paths to the partners.
    fn grow(
        &mut self,
        mesh: &QuadMesh,
        start: HalfEdge,
        partners: &[Vertex],
        most: usize,
    ) -> Option<Region> {
        self.grower.start(mesh);
        let seed = mesh.origin(start);
        if mesh.is_face(seed) {
            self.grower.add_face(mesh, seed);
        } else {
            self.grower.add_sector(mesh, start);
        }
        for &partner in partners {
            let mut at = partner;
            while at != seed {
                let from = self.parent[at as usize];
                if mesh.is_face(at) {
                    self.grower.add_face(mesh, at);
                } else if let Some(h) = mesh.find(at, from) {
                    self.grower.add_sector(mesh, h);
                }
                at = from;
            }
        }
        self.grower.convex(mesh, most).ok()
    }
}

fn can_gain(region: &Region, least: u32) -> bool {
    least_after(region) + least <= region.irregularity
}

/// The least irregularity that a filling of the region can have, by its number of corners.
fn least_after(region: &Region) -> u32 {
    let inside = match region.corners.len() {
        k @ 2..=6 => k.abs_diff(4) as u32,
        _ => return u32::MAX / 2,
    };
    inside + region.rim_irregularity_after
}
