//! The geometry that several measures share: face normals and centres, and at each corner its
//! angle and Jacobian. Computed once, in the order of the arrays.
//!
//! *Invariant:* nothing is guarded against degenerate faces; what a face of no area or an edge of
//! no length leaves undefined is NaN, and each measure says what it makes of that.

use crate::mesh::{Point, PolyMesh, Topology, Vector};
use crate::surface::area_vectors;
use rayon::prelude::*;

/// A mesh with its derived geometry.
#[derive(Debug)]
pub(super) struct Shape<'a> {
    pub(super) mesh: &'a PolyMesh,
    pub(super) topology: &'a Topology,
    /// Length of the bounding-box diagonal of the used vertices.
    pub(super) diagonal: f64,
    /// Area of each face: length of its Newell vector.
    pub(super) areas: Vec<f64>,
    /// Unit normal of each face; NaN where there is no area.
    pub(super) normals: Vec<Vector>,
    /// Mean of the corners of each face.
    pub(super) centres: Vec<Point>,
    /// Length of each half-edge.
    pub(super) lengths: Vec<f64>,
    /// Angle at each corner in degrees, above 180 where it is reflex.
    pub(super) angles_deg: Vec<f64>,
    /// Sine of the signed angle at each corner.
    pub(super) jacobians: Vec<f64>,
}

impl<'a> Shape<'a> {
    /// Computes it. O(n) for n corners, in parallel.
    pub(super) fn new(mesh: &'a PolyMesh, topology: &'a Topology) -> Self {
        let vectors = area_vectors(mesh);
        let areas: Vec<f64> = vectors.par_iter().map(Vector::norm).collect();
        let normals: Vec<Vector> = vectors.par_iter().zip(&areas).map(|(v, a)| v / *a).collect();
        let corner = |c: usize| corner(mesh, topology, &normals, c);
        let corners: Vec<Corner> = (0..mesh.corner_count()).into_par_iter().map(corner).collect();
        Self {
            mesh,
            topology,
            diagonal: mesh.diagonal(),
            centres: (0..mesh.face_count()).into_par_iter().map(|f| mesh.centre(f)).collect(),
            lengths: corners.par_iter().map(|c| c.length).collect(),
            angles_deg: corners.par_iter().map(|c| c.angle_deg).collect(),
            jacobians: corners.par_iter().map(|c| c.jacobian).collect(),
            areas,
            normals,
        }
    }

    /// The corners of each face as a range into the corner arrays.
    pub(super) fn faces(&self) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
        self.mesh.offsets().windows(2).map(|ends| ends[0] as usize..ends[1] as usize)
    }

    /// The corners of each quad.
    pub(super) fn quads(&self) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
        self.faces().filter(|face| face.len() == 4)
    }

    /// Vertex at corner `c`.
    pub(super) fn point(&self, c: usize) -> Point {
        self.mesh.points()[self.mesh.corners()[c] as usize]
    }

    /// End points of half-edge `h`.
    pub(super) fn segment(&self, h: usize) -> [Point; 2] {
        [self.point(h), self.point(self.topology.next[h] as usize)]
    }
}

struct Corner {
    length: f64,
    angle_deg: f64,
    jacobian: f64,
}

fn corner(mesh: &PolyMesh, topology: &Topology, normals: &[Vector], c: usize) -> Corner {
    let at = |c: usize| mesh.points()[mesh.corners()[c] as usize];
    let here = at(c);
    let ahead = at(topology.next[c] as usize) - here;
    let behind = at(topology.prev[c] as usize) - here;
    let length = ahead.norm();
    let both = length * behind.norm();
    let angle = (ahead.dot(&behind) / both).clamp(-1.0, 1.0).acos().to_degrees();
    let signed = ahead.cross(&behind).dot(&normals[topology.face[c] as usize]);
    let angle_deg = if signed < 0.0 { 360.0 - angle } else { angle };
    Corner { length, angle_deg, jacobian: signed / both }
}
