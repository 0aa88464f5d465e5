//! What the mesh is as a surface: sizes, manifoldness, orientation, boundary loops, genus.
//!
//! All is counted on the mesh cut at its non-manifold edges and vertices (see
//! [`Topology`]); only `V`, `E` and `euler_raw` speak of the soup as it is.

use super::components::{Components, signed};
use crate::mesh::{DisjointSets, PolyMesh, Topology};
use serde::Serialize;

/// Longest boundary loops that are listed.
const LISTED_LOOPS: usize = 20;

/// Sizes and topological type of a mesh.
// Each flag answers a question of its own; there is no state machine in them.
#[allow(clippy::struct_excessive_bools)]
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Connectivity {
    /// Vertices that faces use.
    #[serde(rename = "V")]
    pub vertices: usize,
    /// Faces.
    #[serde(rename = "F")]
    pub faces: usize,
    /// Vertices that no face uses.
    pub unreferenced_vertices: usize,
    /// Used vertices with a coordinate that is no finite number.
    pub nan_coordinates: usize,
    /// Edges of the soup, before cutting.
    #[serde(rename = "E")]
    pub edges: usize,
    /// V − E + F of the soup.
    pub euler_raw: i64,
    /// Edges with three or more faces.
    pub nonmanifold_edges: usize,
    /// Edges whose two faces run the same way along it.
    pub inconsistent_edges: usize,
    /// Half-edges from a vertex to itself.
    pub self_loop_edges: usize,
    /// Vertices with more than one fan of faces.
    pub nonmanifold_vertices: usize,
    /// Edges with one face.
    pub boundary_edges: usize,
    /// Vertices of the cut mesh inside the surface.
    #[serde(rename = "V_interior")]
    pub interior_vertices: usize,
    /// Vertices of the cut mesh on its boundary.
    #[serde(rename = "V_boundary")]
    pub boundary_vertices: usize,
    /// Parts joined through two-sided edges.
    pub components: usize,
    /// Parts joined through shared vertices.
    pub components_by_vertices: usize,
    /// Euler characteristic of the cut mesh.
    pub euler_cut: i64,
    /// Boundary loops of the cut mesh.
    pub boundary_loops: usize,
    /// Edges of the longest loops, longest first, at most 20.
    pub boundary_loop_lengths: Vec<usize>,
    /// Whether faces can be turned so that all agree.
    pub orientable: bool,
    /// Whether all faces agree as they are.
    pub consistently_oriented: bool,
    /// Whether no edge has three faces or joins a vertex to itself.
    pub edge_manifold: bool,
    /// Whether every vertex has one fan.
    pub vertex_manifold: bool,
    /// Handles of all orientable components.
    pub genus: i64,
    /// Crosscaps of all other components.
    pub crosscaps: i64,
    /// Interior edges that join two boundary vertices.
    pub chords: i64,
}

impl Connectivity {
    /// Counts. O(n α(n)) for n corners.
    pub(super) fn new(mesh: &PolyMesh, topology: &Topology, parts: &Components) -> Self {
        let used = used_vertices(mesh);
        let vertices = used.iter().filter(|&&u| u).count();
        let unreferenced_vertices = used.len() - vertices;
        let inconsistent_edges = topology.same_direction.iter().filter(|&&s| s).count() / 2;
        let self_loop_edges = self_loops(mesh, topology);
        let nonmanifold_vertices = vertices_with_many_fans(mesh, topology);
        let boundary_vertices = topology.fan_on_boundary.iter().filter(|&&b| b).count();
        let mut lengths = parts.loop_lengths.clone();
        lengths.sort_unstable_by(|a, b| b.cmp(a));
        lengths.truncate(LISTED_LOOPS);
        Self {
            vertices,
            faces: mesh.face_count(),
            unreferenced_vertices,
            // A `PolyMesh` holds finite coordinates only.
            nan_coordinates: 0,
            edges: topology.edges.len(),
            euler_raw: signed(vertices) - signed(topology.edges.len()) + signed(mesh.face_count()),
            nonmanifold_edges: topology.nonmanifold_edges.len(),
            inconsistent_edges,
            self_loop_edges,
            nonmanifold_vertices,
            boundary_edges: topology.boundary_edge_count,
            interior_vertices: topology.fan_count() - boundary_vertices,
            boundary_vertices,
            components: parts.tallies.len(),
            components_by_vertices: vertex_parts(mesh, topology) - unreferenced_vertices,
            euler_cut: parts.sum(|t| t.chi),
            boundary_loops: parts.loop_lengths.len(),
            boundary_loop_lengths: lengths,
            orientable: parts.tallies.iter().all(|t| !t.nonorientable),
            consistently_oriented: inconsistent_edges == 0,
            edge_manifold: topology.nonmanifold_edges.is_empty() && self_loop_edges == 0,
            vertex_manifold: nonmanifold_vertices == 0,
            genus: parts.sum(|t| if t.nonorientable { 0 } else { t.genus() }),
            crosscaps: parts.sum(|t| if t.nonorientable { t.genus() } else { 0 }),
            chords: parts.sum(|t| t.chords),
        }
    }
}

/// Whether a face uses each vertex.
pub(super) fn used_vertices(mesh: &PolyMesh) -> Vec<bool> {
    let mut used = vec![false; mesh.vertex_count()];
    for &v in mesh.corners() {
        used[v as usize] = true;
    }
    used
}

fn self_loops(mesh: &PolyMesh, topology: &Topology) -> usize {
    let corners = mesh.corners();
    topology.next.iter().enumerate().filter(|&(h, &k)| corners[h] == corners[k as usize]).count()
}

fn vertices_with_many_fans(mesh: &PolyMesh, topology: &Topology) -> usize {
    let mut fans = vec![0_u32; mesh.vertex_count()];
    for &v in &topology.fan_vertex {
        fans[v as usize] += 1;
    }
    fans.into_iter().filter(|&n| n > 1).count()
}

/// Sets of vertices joined by edges, the unused ones each on their own.
fn vertex_parts(mesh: &PolyMesh, topology: &Topology) -> usize {
    let corners = mesh.corners();
    let mut sets = DisjointSets::new(mesh.vertex_count());
    let mut parts = mesh.vertex_count();
    for (h, &k) in topology.next.iter().enumerate() {
        parts -= usize::from(sets.join(corners[h] as usize, corners[k as usize] as usize));
    }
    parts
}
