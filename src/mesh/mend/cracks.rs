//! Welds cracks: vertices that hang on the edge of a face which does not have them.
//!
//! ```text
//!   +-----b-----+        +-----b-----+
//!   |     |  f  |        |     |  f  |
//!   |  g  |     v   →    |  g  v-----+      g: a v b … instead of a b …
//!   |     |  e  |        |     |  e  |
//!   +-----a-----+        +-----a-----+
//! ```
//!
//! Meshers that refine some faces and not their neighbours leave them: from `a` to `b` there is a
//! boundary edge on the one side, and on the other a chain of boundary edges beside it. The face of
//! the edge gets the vertices of the chain, unless one of the edges would then have more than two
//! faces. So the only holes that are closed are those without width.

use super::{Draft, Log, MendError, MendKind, Rows};
use crate::mesh::{PolyMesh, Topology};

/// How far from an edge a vertex may hang, relative to the length of the edge: the height of an arc
/// of 23° over its chord.
const TOLERANCE_EDGES: f64 = 0.05;

/// A boundary edge and the chain beside it.
#[derive(Debug)]
pub(super) struct Crack {
    half_edge: u32,
    /// Vertices of the chain between the ends of the edge, in the direction of the half-edge.
    hanging: Vec<u32>,
    /// Half-edges of the chain.
    chain: Vec<u32>,
}

impl Draft {
    /// Puts the vertices that hang on boundary edges into the faces of these edges.
    pub(super) fn weld_cracks(&mut self, log: &mut Log) -> Result<(), MendError> {
        let cracks = self.cracks();
        if cracks.is_empty() {
            return Ok(());
        }
        let mut beside = vec![&[][..]; self.mesh.corner_count()];
        for crack in &cracks {
            beside[crack.half_edge as usize] = &crack.hanging;
            let sources = crack.hanging.iter().map(|&v| self.sources[v as usize]);
            sources.into_iter().try_for_each(|v| log.note(MendKind::Crack, v))?;
        }
        let mut rows = Rows::new();
        let mut face = Vec::new();
        let mut corners = self.mesh.corners().iter().zip(beside);
        for (old, &source) in self.mesh.faces().zip(&self.faces) {
            face.clear();
            for (&v, hanging) in corners.by_ref().take(old.len()) {
                face.push(v);
                face.extend_from_slice(hanging);
            }
            rows.push(&face, source);
        }
        self.set_faces(rows)
    }

    /// All cracks that can be welded. O(n log n) for n corners, if chains are short.
    pub(super) fn cracks(&self) -> Vec<Crack> {
        let rim = Rim::new(&self.mesh, self.topology());
        let found = rim.edges.iter().filter_map(|&h| rim.crack(h));
        let mut cracks: Vec<Crack> = found.collect();
        if cracks.is_empty() {
            return cracks;
        }
        let mut uses = vec![0_u8; self.mesh.corner_count()];
        for &h in cracks.iter().flat_map(|c| c.chain.iter().chain([&c.half_edge])) {
            uses[h as usize] = uses[h as usize].saturating_add(1);
        }
        cracks.retain(|c| c.chain.iter().chain([&c.half_edge]).all(|&h| uses[h as usize] == 1));
        cracks
    }
}

/// The edges that have one face.
struct Rim<'a> {
    mesh: &'a PolyMesh,
    topology: &'a Topology,
    /// One half-edge each.
    edges: Vec<u32>,
    /// From which vertex to which they lead, both ways, and their half-edges; sorted.
    ways: Vec<(u32, u32, u32)>,
}

impl<'a> Rim<'a> {
    fn new(mesh: &'a PolyMesh, topology: &'a Topology) -> Self {
        let mut rim = Self { mesh, topology, edges: Vec::new(), ways: Vec::new() };
        // Half-edges of edges with three faces have no partner, either.
        let key = |h: u32| {
            let (a, b) = rim.ends(h);
            (a.min(b), a.max(b))
        };
        let mut torn: Vec<_> = topology.nonmanifold_edges.iter().map(|&h| key(h)).collect();
        torn.sort_unstable();
        let single = |&h: &u32| torn.binary_search(&key(h)).is_err();
        let edges: Vec<u32> = topology.boundary_half_edges().filter(single).collect();
        let both_ways = |&h: &u32| {
            let (a, b) = rim.ends(h);
            [(a, b, h), (b, a, h)]
        };
        let mut ways: Vec<_> = edges.iter().flat_map(both_ways).collect();
        ways.sort_unstable();
        (rim.edges, rim.ways) = (edges, ways);
        rim
    }

    fn ends(&self, h: u32) -> (u32, u32) {
        let corners = self.mesh.corners();
        (corners[h as usize], corners[self.topology.next[h as usize] as usize])
    }

    /// The chain beside the edge of `h`, if there is one and its vertices are new to the face.
    fn crack(&self, h: u32) -> Option<Crack> {
        let (a, b) = self.ends(h);
        let face = self.mesh.face(self.topology.face[h as usize] as usize);
        let mut crack = Crack { half_edge: h, hanging: Vec::new(), chain: Vec::new() };
        let (mut at, mut along) = (a, 0.0);
        while at != b {
            let (further, next, edge) = self.step(h, at, along)?;
            crack.chain.push(edge);
            if next != b {
                if face.contains(&next) {
                    return None;
                }
                crack.hanging.push(next);
            }
            (at, along) = (next, further);
        }
        Some(crack)
    }

    /// The nearest vertex that a rim edge leads to from `at`, beside the edge of `h` and farther
    /// along it: how far, from 0 to 1, the vertex, and the rim edge.
    fn step(&self, h: u32, at: u32, along: f64) -> Option<(f64, u32, u32)> {
        let (a, b) = self.ends(h);
        let origin = self.mesh.points()[a as usize];
        let edge = self.mesh.points()[b as usize] - origin;
        let start = self.ways.partition_point(|way| way.0 < at);
        let from_here = self.ways[start..].iter().take_while(|way| way.0 == at);
        let beside = from_here.filter(|way| way.2 != h).filter_map(|&(_, to, other)| {
            if to == b && at != a {
                return Some((1.0, to, other));
            }
            let arm = self.mesh.points()[to as usize] - origin;
            let further = arm.dot(&edge) / edge.norm_squared();
            let off = (arm - edge * further).norm();
            let near = off <= TOLERANCE_EDGES * edge.norm();
            (near && further > along && further < 1.0).then_some((further, to, other))
        });
        beside.min_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)))
    }
}
