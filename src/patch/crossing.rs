//! A crossing: feature lines are resampled, and the patches between and beyond them follow, so
//! that irregular elements on one side of a line can meet those on another.

use super::{Misfit, Refill};
use crate::mesh::Point;
use crate::ops::{Refusal, Resample, rebased};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;

/// A vertex that slides along its feature line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Slide {
    /// The vertex.
    pub vertex: Vertex,
    /// Where it goes.
    pub to: [f64; 3],
}

/// A vertex of a line comes or goes, and those nearby make or take its room.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shift {
    /// What comes or goes.
    pub resample: Resample,
    /// What slides.
    pub slides: Vec<Slide>,
}

/// Shifts of lines, one behind the other, and refills of patches on all their sides.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Crossing {
    /// The shifts, in this order.
    pub shifts: Vec<Shift>,
    /// The refills, of regions that share no face, after all shifts.
    pub refills: Vec<Refill>,
}

impl Shift {
    /// Resamples and slides; on refusal the caller undoes. The vertex that came or was joined.
    pub fn run(&self, mesh: &mut QuadMesh) -> Result<Vertex, Refusal> {
        let vertex = self.resample.run(mesh)?;
        self.slide(mesh);
        Ok(vertex)
    }

    /// Slides alone: what comes or goes has done so.
    pub fn slide(&self, mesh: &mut QuadMesh) {
        for slide in &self.slides {
            mesh.set_position(slide.vertex, Point::from(slide.to));
        }
    }

    /// Whether what slides is there, held by a feature, and goes to a finite place.
    fn fits(&self, mesh: &QuadMesh) -> bool {
        let comes = matches!(self.resample, Resample::Cut { .. });
        self.slides.iter().all(|&Slide { vertex, to }| {
            let fits = match vertex.cmp(&mesh.vertex_ids()) {
                Ordering::Less => {
                    mesh.is_alive(vertex) && !mesh.is_face(vertex) && mesh.is_held(vertex)
                }
                Ordering::Equal => comes,
                Ordering::Greater => false,
            };
            fits && to.iter().all(|x| x.is_finite())
        })
    }
}

impl Crossing {
    /// Makes the crossing; on refusal the caller undoes.
    pub fn run(&self, mesh: &mut QuadMesh) -> Result<(), Refusal> {
        self.shifts.iter().try_for_each(|shift| shift.run(mesh).map(drop))?;
        self.refills.iter().try_for_each(|refill| refill.run(mesh))
    }

    /// Makes a crossing that was written down, checking every number; on refusal the caller
    /// undoes. The refills as they were made.
    pub fn replay(&self, mesh: &mut QuadMesh) -> Result<Vec<Refill>, Misfit> {
        for shift in &self.shifts {
            if !shift.fits(mesh) {
                return Err(Misfit::Slide);
            }
            shift.run(mesh)?;
        }
        let mut made = Vec::new();
        for refill in &self.refills {
            let fitted = refill.fitted(mesh)?;
            fitted.run(mesh)?;
            made.push(fitted);
        }
        Ok(made)
    }

    /// The same on a mesh where new ids begin at `now` instead of `planned` (vertices, quads).
    #[must_use]
    pub fn rebased(mut self, planned: (u32, u32), now: (u32, u32)) -> Self {
        let vertex = |v: &mut Vertex| *v = rebased(*v, planned.0, now.0);
        let half_edge = |h: &mut HalfEdge| *h = rebased(*h, 4 * planned.1, 4 * now.1);
        for shift in &mut self.shifts {
            shift.resample = shift.resample.rebased(4 * planned.1, 4 * now.1);
            shift.slides.iter_mut().for_each(|slide| vertex(&mut slide.vertex));
        }
        for refill in &mut self.refills {
            refill.faces.iter_mut().for_each(vertex);
            refill.interior.iter_mut().for_each(vertex);
            refill.rim.iter_mut().for_each(half_edge);
        }
        self
    }
}
