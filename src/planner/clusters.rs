//! Regions worth refilling: around an irregular element and the ones nearest to it.

use crate::mesh::NONE;
use crate::patch::{Grower, Region};
use crate::sqrtcc::{QuadMesh, Vertex};

/// How far and how large the search for regions goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Most faces of a region.
    pub faces: usize,
    /// How many of the nearest irregular elements are joined to the seed.
    pub partners: usize,
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
        let partners = self.nearest(mesh, seed, limits);
        let mut regions: Vec<Region> = Vec::new();
        let keep = |region: Option<Region>, regions: &mut Vec<Region>| {
            let Some(region) = region else { return };
            let known = regions
                .iter()
                .any(|r| r.rim.len() == region.rim.len() && r.faces.len() == region.faces.len());
            if !known && least_after(&region) < region.irregularity {
                regions.push(region);
            }
        };
        keep(self.grow(mesh, seed, &[], limits.faces), &mut regions);
        for i in 0..partners.len() {
            keep(self.grow(mesh, seed, &partners[i..=i], limits.faces), &mut regions);
            keep(self.grow(mesh, seed, &partners[..=i], limits.faces), &mut regions);
        }
        for v in std::mem::take(&mut self.visited) {
            self.parent[v as usize] = NONE;
        }
        regions.sort_by_key(|r| r.faces.len());
        regions
    }

    /// The irregular elements nearest to `seed`, by steps in Q that do not cross frozen lines.
    fn nearest(&mut self, mesh: &QuadMesh, seed: Vertex, limits: Limits) -> Vec<Vertex> {
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
            if mesh.is_held(v) && !mesh.is_pin(v) {
                continue;
            }
            for w in mesh.neighbours(v).filter(|&w| !mesh.is_ghost(w)) {
                if self.parent[w as usize] == NONE {
                    self.parent[w as usize] = v;
                    self.visited.push(w);
                }
            }
        }
        found
    }

    /// The convex disk around the seed and the paths to the partners.
    fn grow(
        &mut self,
        mesh: &QuadMesh,
        seed: Vertex,
        partners: &[Vertex],
        most: usize,
    ) -> Option<Region> {
        self.grower.start(mesh);
        self.grower.add(mesh, seed);
        for &partner in partners {
            let mut at = partner;
            while at != seed {
                self.grower.add(mesh, at);
                at = self.parent[at as usize];
            }
        }
        self.grower.convex(mesh, most).ok()
    }
}

/// The least irregularity that a filling of the region can have, by its number of corners.
fn least_after(region: &Region) -> u32 {
    let inside = match region.corners.len() {
        k @ 2..=6 => k.abs_diff(4) as u32,
        _ => return u32::MAX,
    };
    inside + region.rim_irregularity_after
}
