//! The journal: every write to Q as (array, index, old value), so that an edit is applied whole
//! or undone whole, bit for bit. New ids are only appended; undo pops them.

use super::{Quad, QuadMesh, Vertex};
use crate::mesh::Point;
use fixedbitset::FixedBitSet;

/// Entries for which memory is kept when they are forgotten.
const KEPT: usize = 1 << 16;

/// Which array a journal entry is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Slot {
    Origin,
    Twin,
    Out,
    Valence,
    Ideal,
    Position,
    NewVertex,
    NewQuad,
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    slot: Slot,
    index: u32,
    old: u32,
}

/// The log of writes since it was last cleared.
#[derive(Debug, Clone, Default)]
pub(super) struct Journal {
    entries: Vec<Entry>,
    points: Vec<Point>,
}

/// A moment in the journal that [`QuadMesh::undo_to`] can return to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[must_use]
pub struct Mark(usize);

/// What was written, vertex by vertex and quad by quad: with it a copy follows its original.
#[derive(Debug, Clone, Default)]
pub struct Changes {
    vertices: Vec<Vertex>,
    quads: Vec<Quad>,
}

impl Journal {
    #[inline]
    pub(super) fn record(&mut self, slot: Slot, index: u32, old: u32) {
        self.entries.push(Entry { slot, index, old });
    }

    #[inline]
    pub(super) fn record_point(&mut self, index: u32, old: Point) {
        self.record(Slot::Position, index, 0);
        self.points.push(old);
    }
}

impl QuadMesh {
    /// Remembers this moment. O(1).
    pub fn mark(&self) -> Mark {
        Mark(self.journal.entries.len())
    }

    /// Undoes every write since `mark`, newest first; the mesh is bit-identical to what it was.
    pub fn undo_to(&mut self, mark: Mark) {
        while self.journal.entries.len() > mark.0 {
            let Some(Entry { slot, index, old }) = self.journal.entries.pop() else { return };
            let i = index as usize;
            match slot {
                Slot::Origin => self.origin[i] = old,
                Slot::Twin => self.twin[i] = old,
                Slot::Out => self.out[i] = old,
                Slot::Valence => self.valence[i] = old,
                Slot::Ideal => self.ideal[i] = old as u8,
                Slot::Position => {
                    if let Some(point) = self.journal.points.pop() {
                        self.position[i] = point;
                    }
                }
                Slot::NewVertex => self.pop_vertex(),
                Slot::NewQuad => self.pop_quad(),
            }
        }
    }

    /// Forgets how to undo: what was done so far stays.
    pub fn commit(&mut self) {
        self.journal.entries.clear();
        self.journal.points.clear();
        // Lifting and smoothing write to all of the mesh, edits only to a little of it.
        self.journal.entries.shrink_to(KEPT);
        self.journal.points.shrink_to(KEPT);
    }

    /// What was written since the journal was last cleared.
    #[must_use]
    pub fn changes(&self) -> Changes {
        let mut vertices = FixedBitSet::with_capacity(self.out.len());
        let mut quads = FixedBitSet::with_capacity(self.kind.len());
        for entry in &self.journal.entries {
            let i = entry.index as usize;
            match entry.slot {
                Slot::Origin | Slot::Twin => quads.insert(i / 4),
                Slot::Ideal => quads.insert(i / 2),
                Slot::Out | Slot::Valence | Slot::Position => vertices.insert(i),
                Slot::NewVertex | Slot::NewQuad => (),
            }
        }
        let listed = |set: FixedBitSet| set.ones().map(|i| i as u32).collect();
        Changes { vertices: listed(vertices), quads: listed(quads) }
    }

    /// Takes over from `original`, of which this is a copy, what has been written there since:
    /// those changes and all that is new. O(changes).
    ///
    /// *Precondition:* nothing but what is journaled was written to vertices and quads that both
    /// have.
    pub fn follow(&mut self, original: &Self, changes: &Changes) {
        let (vertices, quads) = (self.out.len(), self.kind.len());
        for v in changes.vertices.iter().map(|&v| v as usize).take_while(|&v| v < vertices) {
            self.out[v] = original.out[v];
            self.valence[v] = original.valence[v];
            self.position[v] = original.position[v];
        }
        for q in changes.quads.iter().map(|&q| q as usize).take_while(|&q| q < quads) {
            let corners = 4 * q..4 * q + 4;
            self.origin[corners.clone()].copy_from_slice(&original.origin[corners.clone()]);
            self.twin[corners.clone()].copy_from_slice(&original.twin[corners]);
            self.ideal[2 * q..2 * q + 2].copy_from_slice(&original.ideal[2 * q..2 * q + 2]);
        }
        self.out.extend_from_slice(&original.out[vertices..]);
        self.valence.extend_from_slice(&original.valence[vertices..]);
        self.class.extend_from_slice(&original.class[vertices..]);
        self.group.extend_from_slice(&original.group[vertices..]);
        self.position.extend_from_slice(&original.position[vertices..]);
        self.origin.extend_from_slice(&original.origin[4 * quads..]);
        self.twin.extend_from_slice(&original.twin[4 * quads..]);
        self.kind.extend_from_slice(&original.kind[quads..]);
        self.ideal.extend_from_slice(&original.ideal[2 * quads..]);
    }

    /// The vertices whose connectivity or position was written since `mark`, sorted, each once;
    /// the dead and those that undo would remove are among them.
    #[must_use]
    pub fn touched_since(&self, mark: Mark) -> Vec<u32> {
        let mut touched: Vec<u32> = self.journal.entries[mark.0..]
            .iter()
            .filter_map(|e| match e.slot {
                Slot::Out | Slot::Valence | Slot::Position => Some([e.index, e.index]),
                Slot::Origin => Some([e.old, self.origin[e.index as usize]]),
                Slot::Twin | Slot::Ideal | Slot::NewVertex | Slot::NewQuad => None,
            })
            .flatten()
            .filter(|&v| v != crate::mesh::NONE)
            .collect();
        // Changes of one vertex mostly follow one another: fewer are left to sort.
        touched.dedup();
        touched.sort_unstable();
        touched.dedup();
        touched
    }

    fn pop_vertex(&mut self) {
        self.out.pop();
        self.valence.pop();
        self.class.pop();
        self.group.pop();
        self.position.pop();
    }

    fn pop_quad(&mut self) {
        self.origin.truncate(self.origin.len() - 4);
        self.twin.truncate(self.twin.len() - 4);
        self.kind.pop();
        self.ideal.truncate(self.ideal.len() - 2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;
    use crate::sqrtcc::lift;
    use fixedbitset::FixedBitSet;

    /// All that a mesh consists of.
    fn whole(mesh: &QuadMesh) -> String {
        let quads = (&mesh.origin, &mesh.twin, &mesh.kind, &mesh.ideal);
        let vertices = (&mesh.out, &mesh.valence, &mesh.class, &mesh.group, &mesh.position);
        format!("{quads:?} {vertices:?}")
    }

    #[test]
    fn a_copy_that_follows_is_like_its_original() {
        let mut mesh = lift(&shapes::sphere(3), &FixedBitSet::new()).unwrap();
        mesh.commit();
        let mut copy = mesh.clone();
        let mut rounds = Vec::new();
        for round in 0..3 {
            let (v, q) = (mesh.add_vertex_like(round, Point::new(1.0, 2.0, 3.0)), mesh.add_quad());
            mesh.pin(v);
            mesh.join(4 * q, 8 + round);
            mesh.set_origin(4 * q + 1, v);
            mesh.set_out(v, 4 * q + 1);
            mesh.kill_vertex(5 + round);
            mesh.kill_quad(round);
            mesh.set_position(9 + round, Point::origin());
            rounds.push(mesh.changes());
            mesh.commit();
        }
        assert_ne!(whole(&copy), whole(&mesh));
        for changes in &rounds {
            copy.follow(&mesh, changes);
        }
        assert_eq!(whole(&copy), whole(&mesh));
    }
}
