//! Orients every component consistently, the way most of its faces already are.

use super::{Draft, Log, MendError, MendKind, Rows};
use crate::mesh::{NONE, Topology};

impl Draft {
    /// Turns over the faces of the minority in each component; on a tie the first face stays.
    pub(super) fn orient(&mut self, log: &mut Log) -> Result<(), MendError> {
        let topology = self.topology();
        if !topology.same_direction.contains(&true) {
            return Ok(());
        }
        let flipped = self.minority(topology)?;
        let mut rows = Rows::new();
        let mut turned = Vec::new();
        for (f, face) in self.mesh.faces().enumerate() {
            turned.clear();
            turned.extend_from_slice(face);
            if flipped[f] {
                log.note(MendKind::FlippedFace, self.faces[f])?;
                // The first corner stays first.
                turned[1..].reverse();
            }
            rows.push(&turned, self.faces[f]);
        }
        self.set_faces(rows)
    }

    /// Which faces have to be turned over.
    fn minority(&self, topology: &Topology) -> Result<Vec<bool>, MendError> {
        let n = self.mesh.face_count();
        let (mut flipped, mut reached) = (vec![false; n], vec![false; n]);
        for seed in 0..n as u32 {
            if reached[seed as usize] {
                continue;
            }
            let component = self.spread(topology, seed, &mut flipped, &mut reached)?;
            let against = component.iter().filter(|&&f| flipped[f as usize]).count();
            if 2 * against > component.len() {
                for f in component {
                    flipped[f as usize] = !flipped[f as usize];
                }
            }
        }
        Ok(flipped)
    }

    /// Breadth-first search from `seed`: the faces of its component, marked in `flipped` where
    /// they run against it.
    fn spread(
        &self,
        topology: &Topology,
        seed: u32,
        flipped: &mut [bool],
        reached: &mut [bool],
    ) -> Result<Vec<u32>, MendError> {
        let mut component = vec![seed];
        reached[seed as usize] = true;
        let mut at = 0;
        while let Some(&f) = component.get(at) {
            at += 1;
            for h in self.mesh.offsets()[f as usize]..self.mesh.offsets()[f as usize + 1] {
                let twin = topology.twin[h as usize];
                if twin == NONE {
                    continue;
                }
                let other = topology.face[twin as usize];
                let against = flipped[f as usize] != topology.same_direction[h as usize];
                if !reached[other as usize] {
                    (reached[other as usize], flipped[other as usize]) = (true, against);
                    component.push(other);
                } else if flipped[other as usize] != against {
                    return Err(MendError::NonOrientable { face: self.faces[seed as usize] });
                }
            }
        }
        Ok(component)
    }
}
