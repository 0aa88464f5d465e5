//! The journal: every write to Q as (array, index, old value), so that an edit is applied whole
//! or undone whole, bit for bit. New ids are only appended; undo pops them.

use super::QuadMesh;
use crate::mesh::Point;

/// Which array a journal entry is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Slot {
    Origin,
    Twin,
    Out,
    Valence,
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
                Slot::Twin | Slot::NewVertex | Slot::NewQuad => None,
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
