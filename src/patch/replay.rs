//! Refills that were written down and read again: everything about them is checked against the
//! mesh, so that a wrong one is refused and can break nothing.

use super::region::Stop;
use super::{Filling, Grower, Refill, embed};
use crate::mesh::{MeshError, Point, PolyMesh, Topology};
use crate::ops::{MAX_VALENCE, MIN_VALENCE, Refusal};
use crate::sqrtcc::{LiftError, QuadMesh, Vertex, lift};
use fixedbitset::FixedBitSet;
use thiserror::Error;

/// Why a refill does not fit the mesh or itself.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Misfit {
    /// A face is not part of the mesh.
    #[error("there is no face {0} in the √CC mesh")]
    Gone(Vertex),
    /// The faces are no disk, or a boundary or feature lies inside.
    #[error("the faces are no disk, or a boundary or feature lies inside")]
    NotADisk,
    /// Rim or interior are not those of the faces.
    #[error("`rim` or `interior` are not those of the faces")]
    OtherRim,
    /// The pins are not as many as there are inside, or no vertices of the filling.
    #[error("`pins` must name another new vertex for each of the {inside} pins inside")]
    Pins {
        /// Pins inside the region.
        inside: usize,
    },
    /// The filling is no list of faces.
    #[error("`offsets` and `corners` of the filling are no list of faces of 3 to 8 corners")]
    NoFaces,
    /// The filling has no such vertex.
    #[error("filling: {0}")]
    Mesh(#[from] MeshError),
    /// The filling is no manifold.
    #[error("filling: {0}")]
    Lift(#[from] LiftError),
    /// A slide names no vertex of a feature, or no place.
    #[error("`slides` must give vertices of features finite places")]
    Slide,
    /// An operation is not legal.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The filling is no disk with just this rim.
    #[error("the filling is no disk with the rim of the region")]
    OtherDisk,
}

impl Refill {
    /// The refill as it can be made on `mesh`, if all its numbers fit; new vertices get their
    /// places anew.
    pub fn fitted(&self, mesh: &QuadMesh) -> Result<Self, Misfit> {
        let mut grower = Grower::default();
        grower.start(mesh);
        for &f in &self.faces {
            if f >= mesh.vertex_ids() || !mesh.is_alive(f) || !mesh.is_face(f) || mesh.is_ghost(f) {
                return Err(Misfit::Gone(f));
            }
            grower.add_face(mesh, f);
        }
        let outline = grower.disk(mesh).map_err(|_: Stop| Misfit::NotADisk)?;
        let region = grower.region(mesh, outline);
        let same = region.faces == self.faces
            && region.rim == self.rim
            && region.interior == self.interior
            && self.filling.rim as usize == region.rim.len();
        if !same {
            return Err(Misfit::OtherRim);
        }
        self.filling.check()?;
        let pins: Vec<Vertex> = self.interior.iter().copied().filter(|&v| mesh.is_pin(v)).collect();
        let mut named = self.pins.clone();
        named.sort_unstable();
        named.dedup();
        if named.len() != pins.len()
            || self.pins.len() != pins.len()
            || named.last().is_some_and(|&i| i >= self.filling.interior)
        {
            return Err(Misfit::Pins { inside: pins.len() });
        }
        let mut places = embed::transport(mesh, &region, &self.filling);
        for (&i, &v) in self.pins.iter().zip(&pins) {
            places[i as usize] = mesh.position(v);
        }
        Ok(Self { places, ..self.clone() })
    }
}

impl Filling {
    /// Whether it is a disk with the rim 0…n−1.
    fn check(&self) -> Result<(), Misfit> {
        let degrees = MIN_VALENCE..=MAX_VALENCE;
        let are_faces = self.offsets.first() == Some(&0)
            && self.offsets.last().is_some_and(|&end| end as usize == self.corners.len())
            && self
                .offsets
                .windows(2)
                .all(|w| w[1].checked_sub(w[0]).is_some_and(|degree| degrees.contains(&degree)));
        // Every vertex is a corner: so no number can ask for more memory than the lists take.
        let vertices = self.rim as usize + self.interior as usize;
        if !are_faces || vertices > self.corners.len() {
            return Err(Misfit::NoFaces);
        }
        let points = vec![Point::origin(); vertices];
        let mesh = PolyMesh::from_rows(points, self.offsets.clone(), self.corners.clone())?;
        // Lifting refuses everything that is no oriented manifold.
        let q = lift(&mesh, &FixedBitSet::with_capacity(mesh.corner_count()))?;
        let topology = Topology::new(&mesh);
        let next = |h: u32| self.corners[topology.next[h as usize] as usize];
        let along = |h: u32| {
            let a = self.corners[h as usize];
            a < self.rim && next(h) == (a + 1) % self.rim
        };
        let boundary: Vec<u32> = topology.boundary_half_edges().collect();
        let edges = self.corners.len().midpoint(boundary.len());
        let euler = (vertices + self.face_count()) as i64 - edges as i64;
        let inner = self.rim..vertices as u32;
        let is_disk = boundary.len() == self.rim as usize
            && boundary.into_iter().all(along)
            && euler == 1
            && inner.into_iter().all(|v| degrees.contains(&q.valence(v)));
        if is_disk { Ok(()) } else { Err(Misfit::OtherDisk) }
    }
}
