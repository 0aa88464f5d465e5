//! What sectors at features and boundaries want: as many faces as their angle has right ones.
//!
//! Source: Peng & Wonka 2013, section 2.1, extended to features.

use super::quad_mesh::{HalfEdge, QuadMesh};
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

/// The ideal number of faces of a sector.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ideal {
    /// The half-edge out of the vertex along the frozen quad at the clockwise end of the sector.
    pub first: HalfEdge,
    /// The number of faces.
    pub faces: u8,
}

/// Most faces that a sector may want.
const MOST: u8 = 8;

impl QuadMesh {
    /// The ideals of sectors whose angles, as they are now, want others than what is noted: features
    /// are resampled and slide. O(V + corners at features).
    #[must_use]
    pub fn measured_ideals(&self) -> Vec<Ideal> {
        let mut measured = Vec::new();
        let holds = |&v: &u32| self.is_alive(v) && !self.is_face(v) && self.is_held(v);
        for v in (0..self.vertex_ids()).filter(holds).filter(|&v| !self.is_ghost(v)) {
            let starts: SmallVec<[u32; 8]> =
                self.outgoing(v).filter(|&h| self.is_frozen(Self::quad(self.twin(h)))).collect();
            let angles: SmallVec<[f64; 8]> =
                starts.iter().map(|&first| self.sector_angle(first).to_degrees()).collect();
            let is_inside = self.neighbours(v).all(|f| !self.is_ghost(f));
            let firsts = starts.iter().map(|&start| Self::next(self.twin(start)));
            let wanted = firsts.zip(ideals(&angles, is_inside));
            let other = wanted.filter(|&(first, faces)| self.ideal_at(first) != faces);
            measured.extend(other.map(|(first, faces)| Ideal { first, faces }));
        }
        measured
    }

    /// Notes what sectors want; false, and only some may be noted, if there is no such sector.
    #[must_use]
    pub fn note_ideals(&mut self, ideals: &[Ideal]) -> bool {
        ideals.iter().all(|&Ideal { first, faces }| {
            let quad = Self::quad(first);
            let exists = quad < self.quad_ids() && self.is_quad_alive(quad) && self.is_frozen(quad);
            let is_sector = exists && !self.is_face(self.origin(first));
            let fits = is_sector && (1..=MOST).contains(&faces);
            if fits {
                self.set_ideal(first, faces);
            }
            fits
        })
    }

    /// Sum of the corner angles at the origin of `first` up to the next frozen quad, radians.
    fn sector_angle(&self, first: u32) -> f64 {
        let v = self.origin(first);
        let arm = |p: u32| self.position(p) - self.position(v);
        let (mut h, mut angle) = (first, 0.0);
        loop {
            // The corner of face target(h) at v lies between the edges of the two quads at h.
            let before = self.origin(Self::opposite(Self::next(self.twin(h))));
            let after = self.origin(Self::opposite(h));
            let turn = arm(before).angle(&arm(after));
            angle += if turn.is_finite() { turn } else { 0.0 };
            if self.is_frozen(Self::quad(h)) {
                return angle;
            }
            h = self.ccw(h);
            if h == first {
                return angle;
            }
        }
    }
}

/// How many degrees farther from its right angles a sector may be for its vertex to be regular.
const REGULAR_IS_WORTH_DEG: f64 = 45.0;

/// The number of faces whose corners come nearest to right angles, for each sector of a vertex. One
/// more or less in one of them makes a vertex inside the surface regular where that hardly matters:
/// the corner of an octagonal hole, 225°, may have two faces as well as three, and two are regular.
fn ideals(angles: &[f64], is_inside: bool) -> SmallVec<[u8; 8]> {
    let off = |angle: f64, faces: u8| (90.0 * f64::from(faces) - angle).abs();
    let mut ideals: SmallVec<[u8; 8]> = angles
        .iter()
        .map(|angle| (angle / 90.0).round().clamp(1.0, f64::from(MOST)) as u8)
        .collect();
    let all: i32 = ideals.iter().map(|&faces| i32::from(faces)).sum();
    if is_inside && (all - 4).abs() == 1 {
        let other = |faces: u8| if all > 4 { faces - 1 } else { faces + 1 };
        let costs = angles.iter().zip(&ideals).map(|(&angle, &faces)| {
            if other(faces) == 0 {
                f64::INFINITY
            } else {
                off(angle, other(faces)) - off(angle, faces)
            }
        });
        let cheapest = costs.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, _)) = cheapest.filter(|&(_, cost)| cost <= REGULAR_IS_WORTH_DEG) {
            ideals[i] = other(ideals[i]);
        }
    }
    ideals
}

#[cfg(test)]
mod tests {
    use super::ideals;

    #[test]
    fn corners_come_near_to_right_angles() {
        assert_eq!(ideals(&[181.0, 178.0], true)[..], [2, 2]);
        assert_eq!(ideals(&[268.0, 91.0, 90.0], true)[..], [3, 1, 1]);
        assert_eq!(ideals(&[92.0, 88.0, 90.0], true)[..], [1, 1, 1]);
        assert_eq!(ideals(&[20.0, 340.0], true)[..], [1, 4]);
    }

    #[test]
    fn a_vertex_is_regular_where_that_hardly_matters() {
        assert_eq!(ideals(&[225.0, 90.0, 90.0], true)[..], [2, 1, 1]);
        assert_eq!(ideals(&[88.0, 240.0, 91.0], true)[..], [1, 2, 1]);
        assert_eq!(ideals(&[130.0, 90.0, 90.0], true)[..], [2, 1, 1]);
        assert_eq!(ideals(&[250.0, 90.0, 90.0], true)[..], [3, 1, 1]);
    }

    #[test]
    fn on_a_boundary_nothing_is_gained_by_that() {
        assert_eq!(ideals(&[226.0], false)[..], [3]);
        assert_eq!(ideals(&[130.0, 91.0], false)[..], [1, 1]);
    }
}
