//! Regularising a disk: its inside is replaced by one with as few irregular elements as its rim
//! allows.
//!
//! ```text
//!   ┌─┬─┬─┬─┐        ┌─┬─┬─┬─┐     The rim stays. How many faces each of its vertices wants
//!   ├─┼┬┴┬┼─┤        ├─┼─┼─┼─┤     inside says where the corners are; corners and sides say what
//!   ├─┤└┬┘├─┤  ──►   ├─┼─┼─┼─┤     can be inside: nothing irregular, one element, or a pair.
//!   ├─┼─┴─┼─┤        ├─┼─┼─┼─┤
//!   └─┴───┴─┘        └─┴─┴─┴─┘
//! ```
//! Source: Peng & Wonka 2013, Figure 11 (2a to 2b).

use crate::ops;
use crate::patch::region::Stop;
use crate::patch::{Grower, Refill, Region, fillings};
use crate::sqrtcc::{QuadMesh, Vertex};
use thiserror::Error;

/// Fillings of one region that are tried.
const MOST_FILLINGS: usize = 8;

/// Why a region is not regularised. The mesh is unchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Refusal {
    /// An element is not part of the mesh, or only closes it over a boundary.
    #[error("element {0} is not part of the mesh")]
    Gone(Vertex),
    /// There is no face in the region.
    #[error("there is no face in the region")]
    Empty,
    /// It takes more faces than allowed until the rim has no dents.
    #[error("the region needs more faces than allowed until its rim has no dents")]
    TooLarge,
    /// The region has a hole or a handle, or touches itself.
    #[error("the region is no disk")]
    NotADisk,
    /// A boundary or feature lies inside.
    #[error("a vertex inside the region is held by a boundary or feature")]
    Held,
    /// No template fits the rim.
    #[error("no template fits a rim of {edges} edges with {corners} corners")]
    NoFilling {
        /// Edges of the rim.
        edges: usize,
        /// Corners of the rim.
        corners: usize,
    },
    /// What is inside is as regular as the rim allows.
    #[error("the inside has {before} irregular elements, and the best filling {after}")]
    AsRegularAsCanBe {
        /// Irregularity of the region as it is.
        before: u32,
        /// Irregularity that the best filling leaves.
        after: u32,
    },
    /// The best filling would join two elements twice.
    #[error("every better filling is illegal: {0}")]
    Illegal(#[from] ops::Refusal),
}

impl From<Stop> for Refusal {
    fn from(stop: Stop) -> Self {
        match stop {
            Stop::TooLarge => Self::TooLarge,
            Stop::NotADisk => Self::NotADisk,
            Stop::Empty => Self::Empty,
            Stop::Held => Self::Held,
        }
    }
}

/// What regularising did.
#[derive(Debug, Clone)]
pub struct Regularized {
    /// The refill; it can be made again on the same mesh.
    pub refill: Refill,
    /// The change of E.
    pub delta: i32,
}

/// Regularises the disk of `faces`; dents of its rim are filled with the faces there, up to `most`
/// faces. Whole or not at all; undone by [`QuadMesh::undo_to`].
pub fn faces(mesh: &mut QuadMesh, faces: &[Vertex], most: usize) -> Result<Regularized, Refusal> {
    let mut grower = Grower::default();
    grower.start(mesh);
    for &f in faces {
        if f >= mesh.vertex_ids() || !mesh.is_alive(f) || !mesh.is_face(f) || mesh.is_ghost(f) {
            return Err(Refusal::Gone(f));
        }
        grower.add_face(mesh, f);
    }
    let outline = grower.convex(mesh, most)?;
    let region = grower.region(mesh, outline);
    refill(mesh, &region)
}

/// Regularises the disk around `element` that lowers E most: as many rings as fit into `most`
/// faces are tried. The reason of the largest region is given if none does.
pub fn around(mesh: &mut QuadMesh, element: Vertex, most: usize) -> Result<Regularized, Refusal> {
    if element >= mesh.vertex_ids() || !mesh.is_alive(element) || mesh.is_ghost(element) {
        return Err(Refusal::Gone(element));
    }
    let mut grower = Grower::default();
    grower.start(mesh);
    grower.add(mesh, element);
    let (mut best, mut reason): (Option<Regularized>, _) = (None, Refusal::Held);
    let mark = mesh.mark();
    loop {
        match grower.convex(mesh, most) {
            Ok(outline) => match refill(mesh, &grower.region(mesh, outline)) {
                Ok(done) => {
                    mesh.undo_to(mark);
                    let better = best.as_ref().is_none_or(|b| done.delta < b.delta);
                    best = if better { Some(done) } else { best };
                }
                Err(refusal) => reason = refusal,
            },
            Err(stop @ (Stop::Empty | Stop::TooLarge)) => {
                if best.is_none() && stop == Stop::Empty {
                    return Err(reason);
                }
                break;
            }
            Err(stop) => reason = stop.into(),
        }
        grower.add_ring(mesh);
    }
    let best = best.ok_or(reason)?;
    best.refill.run(mesh)?;
    Ok(best)
}

/// Fills `region` with what lowers E most.
fn refill(mesh: &mut QuadMesh, region: &Region) -> Result<Regularized, Refusal> {
    let before = region.irregularity;
    let (edges, corners) = (region.rim.len(), region.corners.len());
    let all = fillings(edges, &region.corners, MOST_FILLINGS).into_iter();
    let mut all: Vec<_> =
        all.map(|f| (region.rim_irregularity_after + f.irregularity(), f)).collect();
    // Stable: of equals, the most evenly proportioned stays first.
    all.sort_by_key(|&(after, _)| after);
    let after = all.first().ok_or(Refusal::NoFilling { edges, corners })?.0;
    let mut refusal = Refusal::AsRegularAsCanBe { before, after };
    for (after, filling) in all.into_iter().filter(|&(after, _)| after < before) {
        let made = Refill::new(mesh, region, filling).and_then(|r| r.run(mesh).map(|()| r));
        match made {
            Ok(refill) => return Ok(Regularized { refill, delta: after as i32 - before as i32 }),
            Err(illegal) => refusal = illegal.into(),
        }
    }
    Err(refusal)
}
