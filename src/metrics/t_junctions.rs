//! T-junctions: where a row of quads ends in the middle of an edge, so that an interior vertex of
//! valence 3 stands on a face of degree 5 or more.
//!
//! The literal definition (Peng & Wonka 2013, §2.1) counts incident (v3, f5) pairs; but a face of
//! degree 6 with two hanging vertices is two T-junctions and no such pair, and a v3 between two
//! f5 is one T-junction and two pairs. So `matched` is a maximum matching of the v3 to faces of
//! degree d, each taking up to d − 4.

use super::shape::Shape;
use crate::mesh::{NONE, PolyMesh, Topology};
use serde::Serialize;
use std::ops::Range;

/// A hanging vertex is nearly straight: at least this many degrees.
const STRAIGHT_DEG: f64 = 150.0;

/// T-junctions, counted in four ways.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct TJunctions {
    /// Incident pairs of an interior valence-3 vertex and a degree-5 face.
    pub pairs_v3_f5: usize,
    /// Maximum matching of valence-3 vertices to faces with room for them.
    pub matched: usize,
    /// Corners at a valence-3 vertex in a face of degree ≥ 5 with an angle of 150° or more.
    pub geometric: usize,
    /// The same on the boundary, at vertices without interior edge.
    pub boundary: usize,
}

impl TJunctions {
    /// Counts. O(n) for n corners, and the matching of [`matched_t_junctions`].
    pub(super) fn new(shape: &Shape) -> Self {
        let (mesh, topology) = (shape.mesh, shape.topology);
        let degree = |c: usize| mesh.face(topology.face[c] as usize).len();
        let straight = |c: usize| degree(c) >= 5 && shape.angles_deg[c] >= STRAIGHT_DEG;
        let hanging = |c: &usize| {
            let fan = topology.fan[*c] as usize;
            topology.fan_on_boundary[fan] && topology.fan_corners[fan] == 1
        };
        let corners = 0..mesh.corner_count();
        let v3 = |c: &usize| is_interior_v3(topology, *c);
        Self {
            pairs_v3_f5: corners.clone().filter(|c| v3(c) && degree(*c) == 5).count(),
            matched: matched_t_junctions(mesh, topology),
            geometric: corners.clone().filter(|c| v3(c) && straight(*c)).count(),
            boundary: corners.filter(|c| hanging(c) && straight(*c)).count(),
        }
    }
}

/// Number of T-junctions: the maximum matching of interior valence-3 vertices to faces of degree
/// d ≥ 5 with room for d − 4 of them. O(k √k) for k candidates in practice.
#[must_use]
pub fn matched_t_junctions(mesh: &PolyMesh, topology: &Topology) -> usize {
    t_junctions(mesh, topology).len()
}

/// A vertex that hangs in the side of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct TJunction {
    /// The vertex, of valence 3.
    pub vertex: u32,
    /// The face, of degree 5 or more.
    pub face: u32,
}

/// The T-junctions that [`matched_t_junctions`] counts, by vertex. Where there are several maximum
/// matchings, which one it is depends on the mesh only.
#[must_use]
pub fn t_junctions(mesh: &PolyMesh, topology: &Topology) -> Vec<TJunction> {
    let matching = Matching::new(mesh, topology).maximum();
    let seated = matching.fans.iter().zip(&matching.room_of).filter(|&(_, &room)| room != NONE);
    let mut found: Vec<TJunction> = seated
        .map(|(&fan, &room)| TJunction {
            vertex: topology.fan_vertex[fan as usize],
            face: matching.face_of(room),
        })
        .collect();
    found.sort_unstable_by_key(|t| (t.vertex, t.face));
    found
}

fn is_interior_v3(topology: &Topology, corner: usize) -> bool {
    let fan = topology.fan[corner] as usize;
    !topology.fan_on_boundary[fan] && topology.fan_corners[fan] == 3
}

/// Vertices on the left, rooms of faces on the right, and who sits where.
///
/// *Invariant:* `room_of[v]` is a room of a face of `v`, and `guest[room_of[v]] == v`.
struct Matching {
    /// The fan of each vertex.
    fans: Vec<u32>,
    /// Faces of each vertex: vertex `v` has `faces[starts[v]..starts[v + 1]]`.
    starts: Vec<u32>,
    faces: Vec<u32>,
    /// First room of each face, one entry more than there are faces.
    rooms: Vec<u32>,
    /// Vertex in each room, or [`NONE`].
    guest: Vec<u32>,
    /// Room of each vertex, or [`NONE`].
    room_of: Vec<u32>,
}

impl Matching {
    fn new(mesh: &PolyMesh, topology: &Topology) -> Self {
        let fits = |c: &u32| {
            let degree = mesh.face(topology.face[*c as usize] as usize).len();
            degree >= 5 && is_interior_v3(topology, *c as usize)
        };
        let mut pairs: Vec<(u32, u32)> = (0..mesh.corner_count() as u32)
            .filter(fits)
            .map(|c| (topology.fan[c as usize], topology.face[c as usize]))
            .collect();
        pairs.sort_unstable();
        pairs.dedup();
        let (mut fans, mut starts) = (Vec::new(), vec![0]);
        for group in pairs.chunk_by(|a, b| a.0 == b.0) {
            fans.push(group[0].0);
            starts.push(starts[starts.len() - 1] + group.len() as u32);
        }
        let mut rooms = vec![0];
        for face in mesh.faces() {
            rooms.push(rooms[rooms.len() - 1] + face.len().saturating_sub(4) as u32);
        }
        let guest = vec![NONE; rooms[rooms.len() - 1] as usize];
        let room_of = vec![NONE; starts.len() - 1];
        let faces = pairs.into_iter().map(|p| p.1).collect();
        Self { fans, starts, faces, rooms, guest, room_of }
    }

    /// Augments until a whole pass finds nothing. A face visited in a pass is not visited again in
    /// it: it either led to no free room, or its path is taken and the next pass looks afresh.
    fn maximum(mut self) -> Self {
        let mut visited = vec![0_u32; self.rooms.len()];
        for pass in 1.. {
            let mut found = false;
            for v in 0..self.room_of.len() as u32 {
                if self.room_of[v as usize] == NONE {
                    found |= self.augment(v, &mut visited, pass);
                }
            }
            if !found {
                break;
            }
        }
        self
    }

    /// Breadth-first search for a free room, moving guests on the way; whether there was one.
    fn augment(&mut self, start: u32, visited: &mut [u32], pass: u32) -> bool {
        // Each entry: a vertex that wants a room, and the entry whose vertex wants its present one.
        let mut queue = vec![(start, NONE)];
        let mut at = 0;
        while at < queue.len() {
            let vertex = queue[at].0 as usize;
            for i in self.starts[vertex]..self.starts[vertex + 1] {
                let face = self.faces[i as usize] as usize;
                if std::mem::replace(&mut visited[face], pass) == pass {
                    continue;
                }
                if let Some(room) = self.rooms_of(face).find(|&r| self.guest[r] == NONE) {
                    self.move_along(&queue, at, room);
                    return true;
                }
                queue.extend(self.rooms_of(face).map(|r| (self.guest[r], at as u32)));
            }
            at += 1;
        }
        false
    }

    /// The face that has a room.
    fn face_of(&self, room: u32) -> u32 {
        self.rooms.partition_point(|&first| first <= room) as u32 - 1
    }

    fn rooms_of(&self, face: usize) -> Range<usize> {
        self.rooms[face] as usize..self.rooms[face + 1] as usize
    }

    /// Gives `room` to the vertex of entry `at`, its old room to the entry before, and so on.
    fn move_along(&mut self, queue: &[(u32, u32)], mut at: usize, mut room: usize) {
        loop {
            let (vertex, before) = queue[at];
            let old = std::mem::replace(&mut self.room_of[vertex as usize], room as u32);
            self.guest[room] = vertex;
            if before == NONE {
                return;
            }
            (at, room) = (before as usize, old as usize);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wishes of each vertex, and how many each face takes.
    fn matched(wishes: &[&[u32]], room: &[u32]) -> usize {
        let sums = |counts: &mut dyn Iterator<Item = u32>| {
            let mut sums = vec![0];
            sums.extend(counts.scan(0, |sum, n| {
                *sum += n;
                Some(*sum)
            }));
            sums
        };
        let starts = sums(&mut wishes.iter().map(|w| w.len() as u32));
        let rooms = sums(&mut room.iter().copied());
        let guest = vec![NONE; rooms[room.len()] as usize];
        let room_of = vec![NONE; wishes.len()];
        let fans = (0..wishes.len() as u32).collect();
        let matching = Matching { fans, starts, faces: wishes.concat(), rooms, guest, room_of };
        matching.maximum().room_of.iter().filter(|&&room| room != NONE).count()
    }

    #[test]
    fn guests_move_to_make_room() {
        assert_eq!(matched(&[&[0, 1], &[0], &[1, 2]], &[1, 1, 1]), 3);
        assert_eq!(matched(&[&[0, 1], &[0], &[0, 1]], &[1, 1]), 2);
    }

    #[test]
    fn faces_take_as_many_as_they_have_room_for() {
        assert_eq!(matched(&[&[0], &[0], &[0]], &[2]), 2);
        assert_eq!(matched(&[], &[]), 0);
    }

    #[test]
    fn a_long_chain_moves_over_at_once() {
        let wishes: Vec<Vec<u32>> = (0..5000).map(|i| vec![i, i + 1]).collect();
        let mut wishes: Vec<&[u32]> = wishes.iter().map(Vec::as_slice).collect();
        wishes.push(&[0]);
        assert_eq!(matched(&wishes, &vec![1; 5001]), 5001);
    }
}
