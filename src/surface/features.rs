//! Sharp features: where the reference is creased for long enough to mean it, and which mesh
//! edges stand on such lines.
//!
//! Dihedral angles alone keep the noise creases of scans. So edges above the crease angle only
//! *seed* lines, edges above a part of it may *extend* them (hysteresis), and lines that are short
//! in units of the edges of the mesh to be cleaned are dropped (persistence).
//!
//! *Invariant:* borders are never features here; who wants them held asks the topology.

use fixedbitset::FixedBitSet;
use rayon::prelude::*;

use super::reference::Reference;
use super::segments::Segments;
use crate::knobs::knobs;
use crate::mesh::{DisjointSets, NONE, Point, PolyMesh, Topology, Vector};

/// Creases below this angle are not even stored: no useful setting asks for them.
const LEAST_CREASE_DEG: f64 = 5.0;

knobs! {
    /// Which creases of the reference are features, and which mesh edges stand on them.
    pub struct FeatureOptions in "features" {
        /// Dihedral angle from which a crease of the reference starts a feature line.
        crease_deg: f64 = 35.0, in 1.0..=180.0, "degrees";
        /// Creases above this share of `crease_deg` extend feature lines.
        extend: f64 = 0.6, in 0.05..=1.0, "share";
        /// A feature line ends where it turns by more than this.
        turn_deg: f64 = 60.0, in 0.0..=180.0, "degrees";
        /// Feature lines shorter than this are noise.
        min_chain_edges: f64 = 8.0, in 0.0..=1000.0, "mean edges of the mesh";
        /// Dihedral angle from which a mesh edge may stand on a feature line.
        mesh_crease_deg: f64 = 15.0, in 0.0..=180.0, "degrees";
        /// How near both ends and the middle of a mesh edge must be to the line.
        tolerance_edges: f64 = 0.25, in 0.0..=10.0, "mean edges of the mesh";
        /// Vertices this near to a crease of the reference, long or short, are held: they were put
        /// there on purpose.
        hold_edges: f64 = 0.02, in 0.0..=10.0, "mean edges of the mesh";
        /// Connected mesh features shorter than this are dropped.
        min_mesh_chain_edges: f64 = 5.0, in 0.0..=1000.0, "mean edges of the mesh";
    }
}

/// An edge where two polygons meet at an angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crease {
    /// One end.
    pub a: u32,
    /// The other end.
    pub b: u32,
    /// Angle between the normals of the two polygons: 0 is flat.
    pub angle_deg: f64,
}

/// All edges between two faces of `mesh` with an angle worth storing, ordered by half-edge. O(n),
/// parallel.
pub(super) fn creases(mesh: &PolyMesh, topology: &Topology) -> Vec<Crease> {
    let areas = area_vectors(mesh);
    let edges = topology.edges.par_iter().filter(|&&h| topology.twin[h as usize] != NONE);
    let crease = |&h: &u32| {
        let [a, b] = ends(mesh, topology, h);
        Crease { a, b, angle_deg: dihedral_deg(&areas, topology, h) }
    };
    edges.map(crease).filter(|c| c.angle_deg >= LEAST_CREASE_DEG).collect()
}

/// [`PolyMesh::area_vector`] of each face. Parallel.
pub(crate) fn area_vectors(mesh: &PolyMesh) -> Vec<Vector> {
    (0..mesh.face_count()).into_par_iter().map(|f| mesh.area_vector(f)).collect()
}

fn ends(mesh: &PolyMesh, topology: &Topology, h: u32) -> [u32; 2] {
    let corners = mesh.corners();
    [corners[h as usize], corners[topology.next[h as usize] as usize]]
}

/// Angle between the two faces at `h`, or 0 where one has no area.
fn dihedral_deg(areas: &[Vector], topology: &Topology, h: u32) -> f64 {
    let at = |h: u32| areas[topology.face[h as usize] as usize];
    let (m, n) = (at(h), at(topology.twin[h as usize]));
    let n = if topology.same_direction[h as usize] { -n } else { n };
    if m.norm_squared() > 0.0 && n.norm_squared() > 0.0 { m.angle(&n).to_degrees() } else { 0.0 }
}

/// The feature lines of a reference surface.
#[derive(Debug, Clone)]
pub struct SharpLines {
    segments: Vec<[Point; 2]>,
    chain: Vec<u32>,
    lengths: Vec<f64>,
    tree: Segments,
}

impl SharpLines {
    /// Finds the lines of `reference` that are long for a mesh of mean edge `edge` (in units of
    /// the file). O(n log n) for n creases.
    #[must_use]
    pub fn new(reference: &Reference, options: &FeatureOptions, edge: f64) -> Self {
        let weak = options.extend * options.crease_deg;
        let edges: Vec<Crease> =
            reference.creases().iter().filter(|c| c.angle_deg >= weak).copied().collect();
        let chains = Chains::new(&edges, reference.points(), options);
        let kept = chains.keep(&edges, options.min_chain_edges * edge);
        let (mut segments, mut chain, mut lengths) = (Vec::new(), Vec::new(), Vec::new());
        let mut number = vec![NONE; edges.len()];
        for (e, crease) in edges.iter().enumerate().filter(|&(e, _)| kept[chains.of[e] as usize]) {
            let of = chains.of[e] as usize;
            if number[of] == NONE {
                number[of] = lengths.len() as u32;
                lengths.push(chains.length[of]);
            }
            chain.push(number[of]);
            segments.push([crease.a, crease.b].map(|v| reference.points()[v as usize]));
        }
        let (tree, order) = Segments::new(&segments);
        Self {
            segments: order.iter().map(|&s| segments[s as usize]).collect(),
            chain: order.iter().map(|&s| chain[s as usize]).collect(),
            lengths,
            tree,
        }
    }

    /// Ends of the segments of all lines.
    #[must_use]
    pub fn segments(&self) -> &[[Point; 2]] {
        &self.segments
    }

    /// The line of each segment.
    #[must_use]
    pub fn chains(&self) -> &[u32] {
        &self.chain
    }

    /// Length of each line, in units of the file.
    #[must_use]
    pub fn lengths(&self) -> &[f64] {
        &self.lengths
    }

    /// The closest point of a line that is at most `radius` away. O(log n) expected.
    #[must_use]
    pub fn closest(&self, query: &Point, radius: f64) -> Option<Point> {
        self.tree.closest(query, radius)
    }

    /// Whether a line is at most `radius` away. O(log n) expected.
    #[must_use]
    pub fn is_within(&self, query: &Point, radius: f64) -> bool {
        self.tree.is_within(query, radius)
    }
}

/// Edges joined into chains.
struct Chains {
    /// The chain of each edge: the number of its first edge.
    of: Vec<u32>,
    /// Length of each chain, at the place of its first edge.
    length: Vec<f64>,
    /// Length of its edges above the crease angle.
    seeded: Vec<f64>,
}

impl Chains {
    fn new(edges: &[Crease], points: &[Point], options: &FeatureOptions) -> Self {
        let mut sets = DisjointSets::new(edges.len());
        let cos_turn = options.turn_deg.to_radians().cos();
        for (v, star) in stars(edges) {
            if let Some([e, f]) = through(edges, &star, options.crease_deg) {
                let arm = |e: u32| {
                    let c = &edges[e as usize];
                    points[(c.a ^ c.b ^ v) as usize] - points[v as usize]
                };
                let (u, w) = (arm(e), arm(f));
                if -u.dot(&w) >= cos_turn * u.norm() * w.norm() {
                    sets.join(e as usize, f as usize);
                }
            }
        }
        let of: Vec<u32> = (0..edges.len()).map(|e| sets.root(e) as u32).collect();
        let (mut length, mut seeded) = (vec![0.0; edges.len()], vec![0.0; edges.len()]);
        for (e, c) in edges.iter().enumerate() {
            let l = (points[c.a as usize] - points[c.b as usize]).norm();
            length[of[e] as usize] += l;
            seeded[of[e] as usize] += if c.angle_deg >= options.crease_deg { l } else { 0.0 };
        }
        Self { of, length, seeded }
    }

    /// Which chains (by first edge) are features: long ones with enough seeds, and sharp short
    /// ones that join two of those, like the edges of a narrow chamfer.
    fn keep(&self, edges: &[Crease], least: f64) -> Vec<bool> {
        let long = |c: usize| self.length[c] >= least && self.seeded[c] >= 0.4 * self.length[c];
        let mut kept: Vec<bool> =
            (0..edges.len()).map(|c| self.of[c] as usize == c && long(c)).collect();
        let mut touching = vec![0u8; edges.len()];
        for (_, star) in stars(edges) {
            if star.iter().any(|&e| kept[self.of[e as usize] as usize]) {
                for &e in star.iter().filter(|&&e| !kept[self.of[e as usize] as usize]) {
                    touching[self.of[e as usize] as usize] += 1;
                }
            }
        }
        for c in 0..edges.len() {
            kept[c] |= touching[c] == 2 && self.seeded[c] >= 0.9 * self.length[c];
        }
        kept
    }
}

/// The edges at each vertex, ordered by vertex and edge.
fn stars(edges: &[Crease]) -> Vec<(u32, Vec<u32>)> {
    let mut ends: Vec<(u32, u32)> =
        edges.iter().zip(0..).flat_map(|(c, e)| [(c.a, e), (c.b, e)]).collect();
    ends.sort_unstable();
    let star = |group: &[(u32, u32)]| (group[0].0, group.iter().map(|x| x.1).collect());
    ends.chunk_by(|x, y| x.0 == y.0).map(star).collect()
}

/// The two edges by which a line passes through a vertex: the only two, or the only two sharp.
fn through(edges: &[Crease], star: &[u32], crease_deg: f64) -> Option<[u32; 2]> {
    if let &[e, f] = star {
        return Some([e, f]);
    }
    let mut sharp = star.iter().copied().filter(|&e| edges[e as usize].angle_deg >= crease_deg);
    match (sharp.next(), sharp.next(), sharp.next()) {
        (Some(e), Some(f), None) => Some([e, f]),
        _ => None,
    }
}

/// The half-edges of `mesh` (both sides) that stand on a feature line of `reference`.
///
/// A mesh edge is a feature if its dihedral angle is at least `mesh_crease_deg`, both ends and
/// the middle are within `tolerance_edges` of a line, and what is connected to it is long enough.
/// O(n log n).
#[must_use]
pub fn mesh_features(
    mesh: &PolyMesh,
    topology: &Topology,
    reference: &Reference,
    options: &FeatureOptions,
) -> FixedBitSet {
    let edge = mean_edge(mesh, topology);
    let lines = SharpLines::new(reference, options, edge);
    let radius = options.tolerance_edges * edge;
    let near = |p: &Point| lines.is_within(p, radius);
    let near: Vec<bool> = mesh.points().par_iter().map(near).collect();
    let areas = area_vectors(mesh);
    let on_line = |&h: &u32| {
        let [a, b] = ends(mesh, topology, h);
        let middle = nalgebra::center(&mesh.points()[a as usize], &mesh.points()[b as usize]);
        topology.twin[h as usize] != NONE
            && near[a as usize]
            && near[b as usize]
            && dihedral_deg(&areas, topology, h) >= options.mesh_crease_deg
            && lines.is_within(&middle, radius)
    };
    let candidates: Vec<u32> = topology.edges.par_iter().copied().filter(on_line).collect();
    long_components(mesh, topology, &candidates, options.min_mesh_chain_edges * edge)
}

/// The vertices of `mesh` that stand on a crease of `reference`, within `hold_edges`. Whether the
/// crease is long does not matter here: on a noise crease a vertex is hardly ever so exactly, and
/// a real one that edges cross instead of following keeps its height. O(n log n).
#[must_use]
pub fn vertices_on_lines(
    mesh: &PolyMesh,
    topology: &Topology,
    reference: &Reference,
    options: &FeatureOptions,
) -> Vec<u32> {
    let edge = mean_edge(mesh, topology);
    let every = FeatureOptions { min_chain_edges: 0.0, ..options.clone() };
    let lines = SharpLines::new(reference, &every, edge);
    let radius = options.hold_edges * edge;
    let near = |&v: &u32| lines.is_within(&mesh.points()[v as usize], radius);
    (0..mesh.vertex_count() as u32).into_par_iter().filter(near).collect()
}

/// Marks both sides of the edges whose connected component is at least `least` long.
fn long_components(
    mesh: &PolyMesh,
    topology: &Topology,
    halves: &[u32],
    least: f64,
) -> FixedBitSet {
    let mut sets = DisjointSets::new(mesh.vertex_count());
    for &h in halves {
        let [a, b] = ends(mesh, topology, h);
        sets.join(a as usize, b as usize);
    }
    let mut length = vec![0.0; mesh.vertex_count()];
    for &h in halves {
        let [a, b] = ends(mesh, topology, h).map(|v| mesh.points()[v as usize]);
        length[sets.root(ends(mesh, topology, h)[0] as usize)] += (b - a).norm();
    }
    let mut marked = FixedBitSet::with_capacity(mesh.corner_count());
    for &h in halves {
        if length[sets.root(ends(mesh, topology, h)[0] as usize)] >= least {
            marked.insert(h as usize);
            marked.insert(topology.twin[h as usize] as usize);
        }
    }
    marked
}

/// Mean length of the edges of `mesh`, in units of the file; 0 without edges. O(n).
#[must_use]
pub fn mean_edge(mesh: &PolyMesh, topology: &Topology) -> f64 {
    let length = |&h: &u32| {
        let [a, b] = ends(mesh, topology, h).map(|v| mesh.points()[v as usize]);
        (b - a).norm()
    };
    topology.edges.iter().map(length).sum::<f64>() / topology.edges.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::trial::cube;

    fn feature_edges(mesh: &PolyMesh, reference: &PolyMesh) -> (usize, SharpLines) {
        let (topology, reference) = (Topology::new(mesh), Reference::new(reference).unwrap());
        let options = FeatureOptions::default();
        let marked = mesh_features(mesh, &topology, &reference, &options);
        let lines = SharpLines::new(&reference, &options, mean_edge(mesh, &topology));
        (marked.count_ones(..) / 2, lines)
    }

    #[test]
    fn a_cube_has_twelve_lines() {
        let (marked, lines) = feature_edges(&cube(8, 0.0, 0.0), &cube(24, 0.0, 0.0));
        assert_eq!((lines.lengths().len(), lines.segments().len()), (12, 12 * 24));
        assert!(lines.lengths().iter().all(|l| (l - 2.0).abs() < 1e-12));
        assert_eq!(marked, 12 * 8);
    }

    #[test]
    fn a_noisy_ball_has_none() {
        let noisy = cube(40, 1.0, 0.015);
        let sharp =
            Reference::new(&noisy).unwrap().creases().iter().filter(|c| c.angle_deg > 35.0).count();
        assert!(sharp > 100, "the noise is sharp: {sharp} edges");
        let (marked, lines) = feature_edges(&cube(10, 1.0, 0.0), &noisy);
        assert_eq!((marked, lines.lengths().len()), (0, 0));
    }
}
