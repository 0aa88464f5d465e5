//! Removes doublets: interior vertices with two edges.
//!
//! ```text
//!      x                x                 x                 x
//!    / | \            /   \             / | \             / | \
//!  g   v   f   →    g       f         g   |   f         g   v---f
//!    \ | /            \   /             \ | /             \ | /
//!      y                y                 y                 y
//!                     merged          dissolved           braced
//! ```
//!
//! The two faces are merged (of two quads, one quad is left) unless they also touch elsewhere;
//! then `v` is dissolved into an edge unless there is one from `x` to `y` already; else it gets a
//! third edge, across the larger face. All three keep the Euler characteristic.

use std::collections::VecDeque;

use smallvec::SmallVec;

use super::{Draft, Log, MendError, MendKind, Rows, faces};
use crate::mesh::{PolyMesh, Topology};

impl Draft {
    /// Removes doublets until none is left. The mesh must be manifold and oriented.
    pub(super) fn remove_doublets(&mut self, log: &mut Log) -> Result<(), MendError> {
        let topology = self.topology();
        let is_doublet =
            |&fan: &usize| topology.fan_corners[fan] == 2 && !topology.fan_on_boundary[fan];
        let found = (0..topology.fan_count()).filter(is_doublet);
        let mut waiting: Vec<u32> = found.map(|fan| topology.fan_vertex[fan]).collect();
        if waiting.is_empty() {
            return Ok(());
        }
        waiting.sort_unstable();
        let mut surface = Surface::new(&self.mesh, topology);
        surface.waiting = waiting.into();
        while let Some(v) = surface.waiting.pop_front() {
            if let Some(kind) = surface.remove(v) {
                log.note(kind, self.sources[v as usize])?;
            }
        }
        let mut rows = Rows::new();
        for (face, &of) in
            surface.faces.iter().zip(&surface.piece_of).filter(|(f, _)| !f.is_empty())
        {
            rows.push(face, self.faces[of as usize]);
        }
        self.set_faces(rows)
    }
}

/// A manifold, oriented mesh that can lose and gain faces.
struct Surface {
    /// Corners of each face; empty if it is gone.
    faces: Vec<Vec<u32>>,
    /// The face of the draft that each face is or is a piece of.
    piece_of: Vec<u32>,
    /// Faces around each vertex.
    around: Vec<SmallVec<[u32; 6]>>,
    interior: Vec<bool>,
    waiting: VecDeque<u32>,
}

impl Surface {
    fn new(mesh: &PolyMesh, topology: &Topology) -> Self {
        let faces: Vec<Vec<u32>> = mesh.faces().map(<[u32]>::to_vec).collect();
        let mut around = vec![SmallVec::new(); mesh.vertex_count()];
        for (f, face) in (0_u32..).zip(&faces) {
            for &v in face {
                around[v as usize].push(f);
            }
        }
        let mut interior = vec![true; mesh.vertex_count()];
        for (fan, &v) in topology.fan_vertex.iter().enumerate() {
            interior[v as usize] &= !topology.fan_on_boundary[fan];
        }
        let piece_of = (0..faces.len() as u32).collect();
        Self { faces, piece_of, around, interior, waiting: VecDeque::new() }
    }

    /// Removes `v` if it is a doublet and tells how. Nothing is done if no way is valid.
    fn remove(&mut self, v: u32) -> Option<MendKind> {
        let [a, b] = self.around[v as usize][..] else { return None };
        if !self.interior[v as usize] {
            return None;
        }
        let (a, b) = (a.min(b), a.max(b));
        // a = v y … x, b = v x … y
        let (face_a, face_b) = (self.face_from(a, v)?, self.face_from(b, v)?);
        let (y, x) = (*face_a.get(1)?, *face_b.get(1)?);
        if face_a.last() != Some(&x) || face_b.last() != Some(&y) {
            return None;
        }
        if let Some(merged) = self.merged(a, b, &face_a, &face_b) {
            self.set(a, merged);
            self.set(b, Vec::new());
            return Some(MendKind::DoubletMerged);
        }
        if self.can_dissolve(a, b, &face_a, &face_b) {
            self.set(a, face_a[1..].to_vec());
            self.set(b, face_b[1..].to_vec());
            return Some(MendKind::DoubletDissolved);
        }
        let (larger, face) = if face_b.len() > face_a.len() { (b, face_b) } else { (a, face_a) };
        self.brace(larger, &face)
    }

    /// The corners of face `f`, beginning with `v`.
    fn face_from(&self, f: u32, v: u32) -> Option<Vec<u32>> {
        let mut face = self.faces[f as usize].clone();
        let start = face.iter().position(|&w| w == v)?;
        face.rotate_left(start);
        Some(face)
    }

    /// Both faces as one, if that is a simple face and no double of another.
    fn merged(&self, a: u32, b: u32, face_a: &[u32], face_b: &[u32]) -> Option<Vec<u32>> {
        let rim = [&face_a[1..], &face_b[2..face_b.len() - 1]].concat();
        let mut face = Vec::new();
        // Where the faces share more edges than two, the rim runs along them and back.
        faces::reduce(&rim, &mut face);
        let set = sorted(&face);
        let simple = set.len() >= 3 && set.windows(2).all(|w| w[0] != w[1]);
        (simple && !self.has_double(&set, a, b)).then_some(face)
    }

    fn can_dissolve(&self, a: u32, b: u32, face_a: &[u32], face_b: &[u32]) -> bool {
        let (y, x) = (face_a[1], face_b[1]);
        let joined = |&f: &u32| {
            let face = &self.faces[f as usize];
            let next = |i: usize| face[(i + 1) % face.len()];
            (0..face.len()).any(|i| (face[i], next(i)) == (x, y) || (face[i], next(i)) == (y, x))
        };
        face_a.len() >= 4
            && face_b.len() >= 4
            && !self.around[x as usize].iter().any(joined)
            && !self.has_double(&sorted(&face_a[1..]), a, b)
            && !self.has_double(&sorted(&face_b[1..]), a, b)
    }

    /// Splits the face from its first corner to the one farthest along. The new edge is the only
    /// one between the two, as the first corner has no other neighbours than those beside it.
    fn brace(&mut self, f: u32, face: &[u32]) -> Option<MendKind> {
        if face.len() < 4 {
            return None;
        }
        let middle = face.len() / 2;
        let mut rest = face[middle..].to_vec();
        rest.push(face[0]);
        self.set(f, face[..=middle].to_vec());
        let piece = self.faces.len() as u32;
        self.faces.push(Vec::new());
        self.piece_of.push(self.piece_of[f as usize]);
        self.set(piece, rest);
        Some(MendKind::DoubletBraced)
    }

    /// Whether a face other than `a` and `b` has exactly the vertices of `set`, which is sorted.
    fn has_double(&self, set: &[u32], a: u32, b: u32) -> bool {
        let Some(&v) = set.first() else { return false };
        self.around[v as usize].iter().any(|&f| {
            let face = &self.faces[f as usize];
            f != a && f != b && face.len() == set.len() && sorted(face) == set
        })
    }

    /// Replaces face `f` and queues the doublets that this makes.
    fn set(&mut self, f: u32, face: Vec<u32>) {
        let old = std::mem::replace(&mut self.faces[f as usize], face);
        for &v in &old {
            self.around[v as usize].retain(|g| *g != f);
        }
        for &v in &self.faces[f as usize] {
            self.around[v as usize].push(f);
        }
        let doublets = old.iter().filter(|&&v| self.around[v as usize].len() == 2);
        self.waiting.extend(doublets);
    }
}

fn sorted(face: &[u32]) -> Vec<u32> {
    let mut set = face.to_vec();
    set.sort_unstable();
    set
}
