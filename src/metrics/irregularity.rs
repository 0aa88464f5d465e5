//! Irregular elements: interior vertices of valence n ≠ 4 and faces of degree d ≠ 4
//! (Peng & Wonka 2013, §2.1). Each counts by how far it is off: E = Σ |4 − n| + Σ |4 − d|.
//!
//! Boundary vertices have an index of their own, 1 − e, and are listed apart.

use super::components::signed;
use super::stats::share;
use crate::mesh::{NONE, PolyMesh, Topology};
use serde::Serialize;
use std::collections::BTreeMap;

/// How many elements have each valence, index or degree.
pub type Histogram = BTreeMap<i64, usize>;

/// The count E of irregular elements of a mesh. O(fans + faces), no memory.
#[must_use]
pub fn irregular_elements(mesh: &PolyMesh, topology: &Topology) -> usize {
    let faces: usize = mesh.faces().map(|face| face.len().abs_diff(4)).sum();
    faces + interior_valences(topology).map(|n| n.abs_diff(4)).sum::<usize>()
}

/// Histograms of valence and degree, and the irregular elements they add up to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Irregularity {
    /// Interior vertices by valence.
    pub valence_interior: Histogram,
    /// Boundary vertices by index 1 − e.
    pub boundary_index: Histogram,
    /// Faces without boundary edge by degree.
    pub degree_interior_faces: Histogram,
    /// Faces with a boundary edge by degree.
    pub degree_boundary_faces: Histogram,
    /// All faces by degree.
    pub degree: Histogram,
    /// The counts.
    pub irregular: Irregular,
    /// Whether all faces are quads.
    pub pure_quad: bool,
    /// Share of quads, 0 to 1.
    pub quad_share: f64,
}

/// Counts of irregular elements.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Irregular {
    /// E = `vertex_part` + `face_part`.
    pub elements: usize,
    /// Σ |4 − n| over interior vertices.
    pub vertex_part: usize,
    /// Σ |4 − d| over faces.
    pub face_part: usize,
    /// Σ |1 − e| over boundary vertices.
    pub boundary_part: usize,
    /// Interior vertices with n ≠ 4.
    pub irregular_vertices: usize,
    /// Faces with d ≠ 4.
    pub irregular_faces: usize,
    /// Percentage of interior vertices with n ≠ 4.
    pub pct_irregular_interior_vertices: f64,
    /// Percentage of all vertices that are irregular, boundary corners included.
    pub pct_irregular_vertices_incl_boundary: f64,
    /// Percentage of faces with d ≠ 4.
    pub pct_irregular_faces: f64,
    /// E for each 1000 faces.
    pub per_1000_faces: f64,
}

impl Irregularity {
    /// Counts. O(n) for n corners.
    pub(super) fn new(mesh: &PolyMesh, topology: &Topology) -> Self {
        let on_boundary = faces_on_boundary(mesh.face_count(), topology);
        let degrees = |wanted: bool| {
            let of = |(f, face): (usize, &[u32])| {
                (on_boundary[f] == wanted).then_some(signed(face.len()))
            };
            histogram(mesh.faces().enumerate().filter_map(of))
        };
        let (inner, outer) = (degrees(false), degrees(true));
        let degree = histogram(mesh.faces().map(|face| signed(face.len())));
        let quads = degree.get(&4).copied().unwrap_or(0);
        Self {
            valence_interior: histogram(interior_valences(topology).map(signed)),
            boundary_index: histogram(boundary_corners(topology).map(|n| 2 - signed(n))),
            degree_interior_faces: inner,
            degree_boundary_faces: outer,
            degree,
            irregular: Irregular::new(mesh, topology),
            pure_quad: quads == mesh.face_count(),
            quad_share: share(quads, mesh.face_count()),
        }
    }
}

impl Irregular {
    fn new(mesh: &PolyMesh, topology: &Topology) -> Self {
        let vertex_part = interior_valences(topology).map(|n| n.abs_diff(4)).sum();
        let face_part = mesh.faces().map(|face| face.len().abs_diff(4)).sum();
        let elements = vertex_part + face_part;
        let interior = interior_valences(topology).count();
        let irregular_vertices = interior_valences(topology).filter(|&n| n != 4).count();
        let irregular_corners = boundary_corners(topology).filter(|&n| n != 2).count();
        let irregular_faces = mesh.faces().filter(|face| face.len() != 4).count();
        let irregular_all = irregular_vertices + irregular_corners;
        Self {
            elements,
            vertex_part,
            face_part,
            boundary_part: boundary_corners(topology).map(|n| n.abs_diff(2)).sum(),
            irregular_vertices,
            irregular_faces,
            pct_irregular_interior_vertices: 100.0 * share(irregular_vertices, interior),
            pct_irregular_vertices_incl_boundary: 100.0
                * share(irregular_all, topology.fan_count()),
            pct_irregular_faces: 100.0 * share(irregular_faces, mesh.face_count()),
            per_1000_faces: 1000.0 * share(elements, mesh.face_count()),
        }
    }
}

fn interior_valences(topology: &Topology) -> impl Iterator<Item = usize> + '_ {
    corners_where(topology, false)
}

fn boundary_corners(topology: &Topology) -> impl Iterator<Item = usize> + '_ {
    corners_where(topology, true)
}

fn corners_where(topology: &Topology, boundary: bool) -> impl Iterator<Item = usize> + '_ {
    let fans = topology.fan_corners.iter().zip(&topology.fan_on_boundary);
    fans.filter(move |&(_, &b)| b == boundary).map(|(&n, _)| n as usize)
}

fn faces_on_boundary(faces: usize, topology: &Topology) -> Vec<bool> {
    let mut on_boundary = vec![false; faces];
    for (h, _) in topology.twin.iter().enumerate().filter(|&(_, &t)| t == NONE) {
        on_boundary[topology.face[h] as usize] = true;
    }
    on_boundary
}

fn histogram(values: impl Iterator<Item = i64>) -> Histogram {
    let mut counts = Histogram::new();
    for value in values {
        *counts.entry(value).or_default() += 1;
    }
    counts
}
