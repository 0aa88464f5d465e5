//! The parts of the cut mesh: faces joined through two-sided edges, and what each part counts.
//!
//! Every later statement about "each component" (Euler characteristic, genus, Gauss-Bonnet) reads
//! these tallies, so that they can not disagree about what a component is.

use crate::mesh::{DisjointSets, NONE, PolyMesh, Topology};
use rayon::prelude::*;
use serde::Serialize;

/// What one component of the cut mesh counts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Tally {
    pub(super) faces: i64,
    /// Euler characteristic: vertices − edges + faces of the cut mesh.
    pub(super) chi: i64,
    pub(super) loops: i64,
    pub(super) nonorientable: bool,
    /// Σ (1 − e) over boundary vertices, e = interior edges.
    pub(super) boundary_index: i64,
    /// Σ (4 − n) over interior vertices.
    pub(super) vertex_index: i64,
    /// Σ (4 − d) over faces.
    pub(super) face_index: i64,
    /// Interior edges that join two boundary vertices.
    pub(super) chords: i64,
}

impl Tally {
    /// Handles if orientable, crosscaps if not.
    pub(super) fn genus(&self) -> i64 {
        let twice = 2 - self.chi - self.loops;
        if self.nonorientable { twice } else { twice.div_euclid(2) }
    }

    /// What is missing to Σ index = 4 χ; 0 on every well-formed surface.
    pub(super) fn residual(&self) -> i64 {
        self.boundary_index + self.vertex_index + self.face_index - 4 * self.chi
    }
}

/// One row of the table of the largest components.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct ComponentRow {
    /// Number of faces.
    pub faces: i64,
    /// Euler characteristic.
    pub chi: i64,
    /// Boundary loops.
    pub loops: i64,
    /// Handles if orientable, crosscaps if not.
    pub genus: i64,
    /// Whether its faces can be oriented consistently.
    pub orientable: bool,
}

/// All components and boundary loops.
#[derive(Debug, Clone)]
pub(super) struct Components {
    /// In order of their first face.
    pub(super) tallies: Vec<Tally>,
    /// Number of boundary half-edges of each loop, in order of its first fan.
    pub(super) loop_lengths: Vec<usize>,
    of_face: Vec<u32>,
}

impl Components {
    /// Finds them. O(n α(n)) for n corners.
    pub(super) fn new(mesh: &PolyMesh, topology: &Topology) -> Self {
        let (of_face, count) = label_faces(mesh.face_count(), topology);
        let tallies = vec![Tally::default(); count];
        let mut parts = Self { tallies, loop_lengths: Vec::new(), of_face };
        parts.tally_faces(mesh);
        parts.tally_fans(topology);
        parts.tally_edges(topology);
        parts.tally_loops(topology);
        parts.find_nonorientable(topology);
        parts
    }

    /// The largest components first, at most `limit`.
    pub(super) fn table(&self, limit: usize) -> Vec<ComponentRow> {
        let mut order: Vec<&Tally> = self.tallies.iter().collect();
        order.sort_by_key(|t| -t.faces);
        let row = |t: &Tally| ComponentRow {
            faces: t.faces,
            chi: t.chi,
            loops: t.loops,
            genus: t.genus(),
            orientable: !t.nonorientable,
        };
        order.into_iter().take(limit).map(row).collect()
    }

    /// Sum of one number over the components.
    pub(super) fn sum(&self, of: impl Fn(&Tally) -> i64) -> i64 {
        self.tallies.iter().map(of).sum()
    }

    fn at(&mut self, half_edge: usize, topology: &Topology) -> &mut Tally {
        let face = topology.face[half_edge] as usize;
        &mut self.tallies[self.of_face[face] as usize]
    }

    fn tally_faces(&mut self, mesh: &PolyMesh) {
        for (f, face) in mesh.faces().enumerate() {
            let tally = &mut self.tallies[self.of_face[f] as usize];
            tally.faces += 1;
            tally.chi += 1;
            tally.face_index += 4 - signed(face.len());
        }
    }

    fn tally_fans(&mut self, topology: &Topology) {
        let mut seen = vec![false; topology.fan_count()];
        for h in 0..topology.fan.len() {
            let fan = topology.fan[h] as usize;
            if std::mem::replace(&mut seen[fan], true) {
                continue;
            }
            let corners = i64::from(topology.fan_corners[fan]);
            let on_boundary = topology.fan_on_boundary[fan];
            let tally = self.at(h, topology);
            tally.chi += 1;
            if on_boundary {
                tally.boundary_index += 2 - corners;
            } else {
                tally.vertex_index += 4 - corners;
            }
        }
    }

    fn tally_edges(&mut self, topology: &Topology) {
        let on_boundary = |h: usize| topology.fan_on_boundary[topology.fan[h] as usize];
        for (h, &twin) in topology.twin.iter().enumerate() {
            if twin != NONE && (twin as usize) < h {
                continue;
            }
            let chord = twin != NONE && on_boundary(h) && on_boundary(topology.next[h] as usize);
            let tally = self.at(h, topology);
            tally.chi -= 1;
            tally.chords += i64::from(chord);
        }
    }

    /// A loop is a set of boundary vertices joined by boundary edges: each has exactly two.
    fn tally_loops(&mut self, topology: &Topology) {
        let mut sets = DisjointSets::new(topology.fan_count());
        for h in topology.boundary_half_edges() {
            let next = topology.next[h as usize] as usize;
            sets.join(topology.fan[h as usize] as usize, topology.fan[next] as usize);
        }
        let mut lengths = vec![0; topology.fan_count()];
        for h in topology.boundary_half_edges() {
            let root = sets.root(topology.fan[h as usize] as usize);
            if lengths[root] == 0 {
                self.at(h as usize, topology).loops += 1;
            }
            lengths[root] += 1;
        }
        self.loop_lengths = lengths.into_iter().filter(|&l| l > 0).collect();
    }

    /// A component is orientable if its double cover falls into two sheets.
    fn find_nonorientable(&mut self, topology: &Topology) {
        let faces = self.of_face.len();
        let mut sheets = DisjointSets::new(2 * faces);
        for (h, t) in partner_pairs(topology) {
            let (f, g) = (topology.face[h] as usize, topology.face[t] as usize);
            let turned = if topology.same_direction[h] { faces } else { 0 };
            sheets.join(f, g + turned);
            sheets.join(f + faces, g + (faces - turned));
        }
        for f in 0..faces {
            if sheets.root(f) == sheets.root(f + faces) {
                self.tallies[self.of_face[f] as usize].nonorientable = true;
            }
        }
    }
}

/// Two-sided edges of the cut mesh, each as its two half-edges, the smaller first.
pub(super) fn partner_pairs(topology: &Topology) -> impl Iterator<Item = (usize, usize)> + '_ {
    (0..topology.twin.len()).filter_map(|h| pair(topology, h))
}

/// Those of [`partner_pairs`] that are `wanted`, in the same order. Parallel.
pub(super) fn partner_pairs_where(
    topology: &Topology,
    wanted: impl Fn(usize, usize) -> bool + Sync,
) -> Vec<(usize, usize)> {
    let halves = (0..topology.twin.len()).into_par_iter();
    halves.filter_map(|h| pair(topology, h).filter(|&(h, t)| wanted(h, t))).collect()
}

/// A half-edge and its partner, if that is the larger one.
fn pair(topology: &Topology, h: usize) -> Option<(usize, usize)> {
    let t = topology.twin[h];
    (t != NONE && h < t as usize).then_some((h, t as usize))
}

/// A count as a signed number; counts stay far below 2^63.
pub(super) fn signed(count: usize) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

/// Component of each face, numbered by first face, and how many there are.
fn label_faces(faces: usize, topology: &Topology) -> (Vec<u32>, usize) {
    let mut sets = DisjointSets::new(faces);
    for (h, t) in partner_pairs(topology) {
        sets.join(topology.face[h] as usize, topology.face[t] as usize);
    }
    let mut labels = vec![NONE; faces];
    let mut count = 0;
    for f in 0..faces {
        // The root of a set is its smallest face, so it has its label before the others ask.
        let root = sets.root(f);
        if root == f {
            labels[f] = count;
            count += 1;
        } else {
            labels[f] = labels[root];
        }
    }
    (labels, count as usize)
}
