//! Faces for themselves: repeated corners, spurs, degenerate and duplicate faces.

use super::{Draft, Log, MendError, MendKind, Rows};
use crate::mesh::NONE;
use crate::mesh::check::{duplicates, repeated};

impl Draft {
    /// Takes repeated corners and spurs off, then drops faces that are still not simple.
    pub(super) fn simplify_faces(&mut self, log: &mut Log) -> Result<(), MendError> {
        let mut rows = Rows::new();
        let mut seen = vec![NONE; self.mesh.vertex_count()];
        let mut face = Vec::new();
        for (f, corners) in (0_u32..).zip(self.mesh.faces()) {
            let source = self.faces[f as usize];
            let (repeats, spurs) = reduce(corners, &mut face);
            if face.len() < 3 || repeated(&face, f, &mut seen).is_some() {
                log.note(MendKind::DegenerateFace, source)?;
                continue;
            }
            (0..repeats).try_for_each(|_| log.note(MendKind::RepeatedCorner, source))?;
            (0..spurs).try_for_each(|_| log.note(MendKind::Spur, source))?;
            rows.push(&face, source);
        }
        if rows.corners.len() == self.mesh.corner_count() && rows.sources == self.faces {
            return Ok(());
        }
        self.set_faces(rows)
    }

    /// Drops faces that have the vertices of an earlier one.
    pub(super) fn drop_duplicates(&mut self, log: &mut Log) -> Result<(), MendError> {
        let pairs = duplicates(&self.mesh);
        if pairs.is_empty() {
            return Ok(());
        }
        let mut doubled = vec![false; self.mesh.face_count()];
        for &(_, later) in &pairs {
            doubled[later as usize] = true;
            log.note(MendKind::DuplicateFace, self.faces[later as usize])?;
        }
        let mut rows = Rows::new();
        for (f, face) in self.mesh.faces().enumerate().filter(|(f, _)| !doubled[*f]) {
            rows.push(face, self.faces[f]);
        }
        self.set_faces(rows)
    }
}

/// Writes the cycle `corners` to `face` without repeated corners (`u u`) and spurs (`u v u`, of
/// which `u` stays); how many there were of each. Linear in the number of corners.
pub(super) fn reduce(corners: &[u32], face: &mut Vec<u32>) -> (usize, usize) {
    let (mut repeats, mut spurs) = (0, 0);
    face.clear();
    for &v in corners {
        let n = face.len();
        if n >= 1 && face[n - 1] == v {
            repeats += 1;
        } else if n >= 2 && face[n - 2] == v {
            face.pop();
            spurs += 1;
        } else {
            face.push(v);
        }
    }
    let (more_repeats, more_spurs) = reduce_seam(face);
    (repeats + more_repeats, spurs + more_spurs)
}

/// Does the same where the cycle closes, from its last corner to its first.
fn reduce_seam(face: &mut Vec<u32>) -> (usize, usize) {
    let (mut repeats, mut spurs) = (0, 0);
    // So many corners have gone at the front.
    let mut start = 0;
    loop {
        match face[start..] {
            [first, .., last] if first == last => {
                face.pop();
                repeats += 1;
            }
            [first, .., before, _] if first == before => {
                face.truncate(face.len() - 2);
                spurs += 1;
            }
            [_, second, .., last] if second == last => {
                face.pop();
                start += 1;
                spurs += 1;
            }
            _ => break,
        }
    }
    face.drain(..start);
    (repeats, spurs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reduced(corners: &[u32]) -> (Vec<u32>, usize, usize) {
        let mut face = vec![99];
        let (repeats, spurs) = reduce(corners, &mut face);
        (face, repeats, spurs)
    }

    #[test]
    fn cycles_are_reduced_wherever_they_start() {
        assert_eq!(reduced(&[0, 1, 2, 3]), (vec![0, 1, 2, 3], 0, 0));
        assert_eq!(reduced(&[0, 0, 1, 2, 2, 0]), (vec![0, 1, 2], 3, 0));
        let spurred = [0, 1, 2, 5, 6, 5, 2, 3];
        for turn in 0..spurred.len() {
            let mut corners = spurred;
            corners.rotate_left(turn);
            let (mut face, repeats, spurs) = reduced(&corners);
            let start = face.iter().position(|&v| v == 0).unwrap();
            face.rotate_left(start);
            assert_eq!(face, [0, 1, 2, 3], "turned by {turn}");
            // Every way to take two edges off is as good: a spur of two, or a spur and a repeat.
            assert_eq!(repeats + 2 * spurs, 4, "turned by {turn}: {repeats}, {spurs}");
        }
    }

    #[test]
    fn what_has_no_area_vanishes() {
        for corners in [&[][..], &[7], &[7, 7], &[1, 2], &[1, 2, 1, 2], &[1, 2, 3, 2]] {
            assert!(reduced(corners).0.len() < 3, "{corners:?}");
        }
    }
}
