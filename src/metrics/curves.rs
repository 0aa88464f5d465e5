//! Distances between curves: do sharp edges and boundaries of the reference have edges of the
//! mesh on them?
//!
//! Curves are sampled a quarter of a mesh edge apart. Here every edge of the reference above the
//! feature angle counts, noise creases too: this is a measure, not the choice of the features
//! that an edit respects.

use super::components::partner_pairs_where;
use super::shape::Shape;
use super::stats::{max, mean, percentile, share};
use crate::mesh::{NONE, Point, PolyMesh, Topology};
use crate::surface::{Segments, area_vectors};
use rayon::prelude::*;
use serde::Serialize;

/// Most samples on one edge.
const MOST_SAMPLES: f64 = 200.0;
/// What bounds are widened by: far more than they are rounded.
const MARGIN: f64 = 1.0 + 1e-9;

/// Curves of a reference: segments between two points.
#[derive(Debug)]
pub(super) struct Lines {
    sharp: Vec<[Point; 2]>,
    border: Vec<[Point; 2]>,
}

impl Lines {
    /// Edges of `mesh` where the surface turns by more than `angle_deg`, and edges of one face.
    pub(super) fn new(mesh: &PolyMesh, topology: &Topology, angle_deg: f64) -> Self {
        let areas = area_vectors(mesh);
        let area = |h: usize| &areas[topology.face[h] as usize];
        let turn_deg = |h: usize, t: usize| {
            let (m, n) = (area(h), area(t));
            let both = (m.norm() * n.norm()).max(f64::MIN_POSITIVE);
            (m.dot(n) / both).clamp(-1.0, 1.0).acos().to_degrees()
        };
        let point = |h: usize| mesh.points()[mesh.corners()[h] as usize];
        let ends = |h: usize| [point(h), point(topology.next[h] as usize)];
        let sharp = partner_pairs_where(topology, |h, t| turn_deg(h, t) > angle_deg);
        let sharp = sharp.into_iter().map(|(h, _)| ends(h)).collect();
        Self { sharp, border: single(topology, ends) }
    }
}

/// Edges with exactly one face: cuts at non-manifold edges are no border of the surface.
fn single(topology: &Topology, ends: impl Fn(usize) -> [Point; 2]) -> Vec<[Point; 2]> {
    let mut alone: Vec<bool> = topology.twin.iter().map(|&t| t == NONE).collect();
    for &edge in &topology.nonmanifold_edges {
        alone[edge as usize] = false;
    }
    let first = topology.edges.iter().map(|&h| h as usize);
    first.filter(|&h| alone[h]).map(ends).collect()
}

/// Distances from points of a curve to other curves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CurveDistance {
    /// Largest, relative to the diagonal of the reference.
    pub max: f64,
    /// Mean, relative to the diagonal of the reference.
    pub mean: f64,
    /// 95th percentile, relative to the diagonal of the reference.
    pub p95: f64,
    /// Mean, in mean edges of the mesh.
    pub mean_in_edge_lengths: f64,
    /// Share of the points nearer than a tenth of a mean edge.
    pub share_within_0_1_edge: f64,
}

impl CurveDistance {
    fn new(mut distances: Vec<f64>, edge: f64, diagonal: f64) -> Option<Self> {
        let mean = mean(&distances)?;
        let near = distances.iter().filter(|&&d| d < 0.1 * edge).count();
        Some(Self {
            max: max(&distances)? / diagonal,
            mean: mean / diagonal,
            mean_in_edge_lengths: mean / edge,
            share_within_0_1_edge: share(near, distances.len()),
            p95: percentile(&mut distances, 95.0)? / diagonal,
        })
    }
}

/// Whether the mesh has edges where the reference is sharp.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Features {
    /// Dihedral angle from which an edge of the reference is sharp, in degrees.
    pub angle_deg: f64,
    /// Sharp edges of the reference.
    pub reference_edges: usize,
    /// Their length, relative to the diagonal of the reference.
    pub reference_length_over_diagonal: f64,
    /// From sharp edges to any edge of the mesh; `None` without sharp edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to_any_mesh_edge: Option<CurveDistance>,
    /// Mesh edges sharper than half the angle; `None` without sharp edges.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh_sharp_edges: Option<usize>,
    /// From sharp edges to sharp mesh edges; `None` without either.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to_sharp_mesh_edge: Option<CurveDistance>,
}

impl Features {
    pub(super) fn new(shape: &Shape, lines: &Lines, angle_deg: f64, diagonal: f64) -> Self {
        let length: f64 = lines.sharp.iter().map(|[a, b]| (b - a).norm()).sum();
        let mut features = Self {
            angle_deg,
            reference_edges: lines.sharp.len(),
            reference_length_over_diagonal: length / diagonal,
            to_any_mesh_edge: None,
            mesh_sharp_edges: None,
            to_sharp_mesh_edge: None,
        };
        if !lines.sharp.is_empty() {
            let edge = mean_half_edge(shape);
            let points = points_along(&lines.sharp, step(edge, diagonal));
            let any = segments_near(shape, &points).distances(&points);
            features.to_any_mesh_edge = CurveDistance::new(any, edge, diagonal);
            let sharp = sharp_segments(shape, angle_deg / 2.0);
            features.mesh_sharp_edges = Some(sharp.len());
            if !sharp.is_empty() {
                let distances = Segments::new(&sharp).0.distances(&points);
                features.to_sharp_mesh_edge = CurveDistance::new(distances, edge, diagonal);
            }
        }
        features
    }
}

/// Distances between the boundaries of mesh and reference, or how long each is if one has none.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Boundary {
    /// Both have a boundary; distances are relative to the diagonal of the reference.
    Distances {
        /// Largest, from the boundary of the reference.
        ref_to_mesh_max: f64,
        /// Mean, from the boundary of the reference.
        ref_to_mesh_mean: f64,
        /// Largest, from the boundary of the mesh.
        mesh_to_ref_max: f64,
        /// Mean, from the boundary of the mesh.
        mesh_to_ref_mean: f64,
    },
    /// One of them is closed.
    Counts {
        /// Boundary edges of the mesh.
        mesh_boundary_edges: usize,
        /// Boundary edges of the reference.
        ref_boundary_edges: usize,
    },
}

impl Boundary {
    pub(super) fn new(shape: &Shape, lines: &Lines, diagonal: f64) -> Self {
        let half_edges = shape.topology.boundary_half_edges();
        let own: Vec<[Point; 2]> = half_edges.map(|h| shape.segment(h as usize)).collect();
        let counts =
            Self::Counts { mesh_boundary_edges: own.len(), ref_boundary_edges: lines.border.len() };
        let step = step(mean_half_edge(shape), diagonal);
        let from = |from: &[[Point; 2]], to: &[[Point; 2]]| {
            let (tree, _) = Segments::new(to);
            let distances = tree.distances(&points_along(from, step));
            Some((max(&distances)? / diagonal, mean(&distances)? / diagonal))
        };
        if own.is_empty() || lines.border.is_empty() {
            return counts;
        }
        match (from(&lines.border, &own), from(&own, &lines.border)) {
            (
                Some((ref_to_mesh_max, ref_to_mesh_mean)),
                Some((mesh_to_ref_max, mesh_to_ref_mean)),
            ) => Self::Distances {
                ref_to_mesh_max,
                ref_to_mesh_mean,
                mesh_to_ref_max,
                mesh_to_ref_mean,
            },
            _ => counts,
        }
    }
}

/// Edges across which the mesh turns by `angle_deg` or more, or an undefined angle.
fn sharp_segments(shape: &Shape, angle_deg: f64) -> Vec<[Point; 2]> {
    let normal = |h: usize| &shape.normals[shape.topology.face[h] as usize];
    let flat = angle_deg.to_radians().cos();
    let is_flat = |h: usize, t: usize| normal(h).dot(normal(t)) > flat;
    let pairs = partner_pairs_where(shape.topology, |h, t| !is_flat(h, t));
    pairs.into_iter().map(|(h, _)| shape.segment(h)).collect()
}

/// Edges of the mesh, among them the closest to each of the points: a tree of all of them takes
/// longer than all that is asked of it. A few, taken evenly, tell how far away the closest are at most.
fn segments_near(shape: &Shape, points: &[Point]) -> Segments {
    const EVERY: usize = 16;
    let edges = &shape.topology.edges;
    let segment = |&h: &u32| shape.segment(h as usize);
    let some: Vec<_> = edges.iter().step_by(EVERY).map(segment).collect();
    let reach = max(&Segments::new(&some).0.distances(points)).unwrap_or(0.0);
    let places: Vec<_> = points.iter().map(|&p| [p, p]).collect();
    let (places, _) = Segments::new(&places);
    let is_near = |[a, b]: &[Point; 2]| {
        let radius = MARGIN * (reach + 0.5 * (b - a).norm());
        places.is_within(&nalgebra::center(a, b), radius)
    };
    let near: Vec<_> = edges.par_iter().map(segment).filter(is_near).collect();
    Segments::new(&near).0
}

/// Mean over half-edges: interior edges count twice.
fn mean_half_edge(shape: &Shape) -> f64 {
    mean(&shape.lengths).unwrap_or(0.0)
}

fn step(edge: f64, diagonal: f64) -> f64 {
    (edge / 4.0).max(1e-4 * diagonal)
}

/// Points on each segment, about `step` apart, both ends included.
fn points_along(segments: &[[Point; 2]], step: f64) -> Vec<Point> {
    let mut points = Vec::new();
    for [a, b] in segments {
        let pieces = ((b - a).norm() / step).ceil().clamp(1.0, MOST_SAMPLES - 1.0);
        // Between 1 and 199, so the cast is exact.
        #[allow(clippy::cast_sign_loss)]
        let count = pieces as usize;
        points.extend((0..=count).map(|i| a + (b - a) * (i as f64 / pieces)));
    }
    points
}
