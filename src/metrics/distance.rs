//! How far a mesh is from its reference surface, both ways, and which faces look the wrong way.
//!
//! Hausdorff distances are taken over dense samples of both surfaces and over their vertices
//! (and face centres of the mesh), RMS and mean over the samples only. Samples are spread evenly
//! by area and are not random. All lengths are relative to the bounding-box diagonal of the
//! reference.

use super::curves::{Boundary, Features, Lines};
use super::shape::Shape;
use super::stats::{Spread, share};
use super::{MeasureOptions, MetricsError, connectivity};
use crate::mesh::{Point, PolyMesh, Topology};
use crate::surface::Reference;
use rayon::prelude::*;
use serde::Serialize;
use std::sync::Arc;

/// A reference surface made ready to measure meshes against.
#[derive(Debug)]
pub struct Target {
    options: MeasureOptions,
    surface: Arc<Reference>,
    /// Samples first, then the used vertices.
    probes: Vec<Point>,
    sample_count: usize,
    lines: Lines,
}

impl Target {
    /// Prepares `mesh` as the reference. O(n log n) for n corners.
    pub fn new(mesh: &PolyMesh, options: &MeasureOptions) -> Result<Self, MetricsError> {
        let surface = Reference::plain(mesh).map_err(MetricsError::Reference)?;
        Ok(Self::on(Arc::new(surface), mesh, options))
    }

    /// The same with the `surface` of `mesh`, which is there already. O(n) for n corners.
    #[must_use]
    pub fn on(surface: Arc<Reference>, mesh: &PolyMesh, options: &MeasureOptions) -> Self {
        let places = || {
            let mut probes = surface.samples(options.samples as usize);
            let sample_count = probes.len();
            probes.extend(used_points(mesh, &surface));
            (probes, sample_count)
        };
        let lines = || Lines::new(mesh, &Topology::new(mesh), options.feature_angle_deg);
        let ((probes, sample_count), lines) = rayon::join(places, lines);
        Self { options: options.clone(), surface, probes, sample_count, lines }
    }

    /// The surface itself.
    #[must_use]
    pub fn surface(&self) -> &Reference {
        &self.surface
    }
}

/// Everything that is measured against a reference.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReferenceMetrics {
    /// How distances are found.
    pub distance_backend: &'static str,
    /// Bounding-box diagonal of the reference, in the units of the input.
    pub reference_bbox_diagonal: f64,
    /// From the mesh to the reference.
    pub mesh_to_ref: MeshToReference,
    /// From the reference to the mesh.
    pub ref_to_mesh: OneWay,
    /// The larger of both Hausdorff distances.
    pub hausdorff: f64,
    /// The larger of both root-mean-square distances.
    pub rms: f64,
    /// How faces look compared with the nearest part of the reference.
    #[serde(flatten)]
    pub orientation: Orientation,
    /// Sharp edges of the reference.
    pub features: Features,
    /// Boundaries of both.
    pub boundary: Boundary,
}

/// Distances from one surface to another, relative to the diagonal of the reference.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct OneWay {
    /// Largest.
    pub hausdorff: f64,
    /// Root mean square.
    pub rms: f64,
    /// Mean.
    pub mean: f64,
}

/// Distances from the mesh to the reference.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MeshToReference {
    /// Over the surface.
    #[serde(flatten)]
    pub surface: OneWay,
    /// Largest over the vertices alone.
    pub vertices_max: f64,
}

/// Normals of faces against those of the nearest triangle of the reference.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Orientation {
    /// Faces that look away from all that is nearest of it, or nowhere.
    pub flipped_faces: usize,
    /// Their share.
    pub flipped_share: f64,
    /// Angle between the normals.
    pub normal_deviation_deg: Spread,
}

impl ReferenceMetrics {
    /// Measures. O((samples + n) log n) for n corners of mesh and reference, in parallel.
    pub(super) fn new(shape: &Shape, target: &Target) -> Result<Self, MetricsError> {
        let own = Reference::plain(shape.mesh).map_err(MetricsError::Mesh)?;
        let diagonal = target.surface.diagonal();
        let (mesh_to_ref, orientation) = from_mesh(shape, &own, target);
        let back = distances(&own, &target.probes);
        drop(own);
        let ref_to_mesh = OneWay::new(&back, target.sample_count, diagonal);
        let angle = target.options.feature_angle_deg;
        let (features, boundary) = rayon::join(
            || Features::new(shape, &target.lines, angle, diagonal),
            || Boundary::new(shape, &target.lines, diagonal),
        );
        Ok(Self {
            distance_backend: "exact",
            reference_bbox_diagonal: diagonal,
            hausdorff: mesh_to_ref.surface.hausdorff.max(ref_to_mesh.hausdorff),
            rms: mesh_to_ref.surface.rms.max(ref_to_mesh.rms),
            mesh_to_ref,
            ref_to_mesh,
            orientation,
            features,
            boundary,
        })
    }
}

/// Triangles whose distances differ by no more than this share of the diagonal are as near.
const TIE_REL: f64 = 1e-9;

/// Samples, vertices and face centres of the mesh against the reference.
fn from_mesh(shape: &Shape, own: &Reference, target: &Target) -> (MeshToReference, Orientation) {
    let mut probes = own.samples(target.options.samples as usize);
    let samples = probes.len();
    probes.extend(used_points(shape.mesh, own));
    let mut all = distances(&target.surface, &probes);
    let diagonal = target.surface.diagonal();
    let vertices_max = farthest(&all[samples..]) / diagonal;
    let order = own.faces_in_order(shape.centres.len());
    let centres: Vec<Point> = order.iter().map(|&f| shape.centres[f as usize]).collect();
    let mut triangles = vec![0; centres.len()];
    target.surface.closest_each(&centres, &mut Vec::new(), |i, hit| {
        all.push(hit.distance);
        triangles[order[i] as usize] = hit.triangle;
    });
    let surface = OneWay::new(&all, samples, diagonal);
    let orientation = Orientation::new(shape, &target.surface, &triangles);
    (MeshToReference { surface, vertices_max }, orientation)
}

/// How far points are from a surface.
fn distances(surface: &Reference, points: &[Point]) -> Vec<f64> {
    let mut distances = Vec::with_capacity(points.len());
    surface.closest_each(points, &mut Vec::new(), |_, hit| distances.push(hit.distance));
    distances
}

impl OneWay {
    /// The first `samples` distances are those of samples; the others count for the maximum only.
    fn new(distances: &[f64], samples: usize, diagonal: f64) -> Self {
        let sampled = &distances[..samples];
        let count = samples.max(1) as f64;
        let sum: f64 = sampled.iter().sum();
        let squares: f64 = sampled.iter().map(|d| d * d).sum();
        Self {
            hausdorff: farthest(distances) / diagonal,
            rms: (squares / count).sqrt() / diagonal,
            mean: sum / count / diagonal,
        }
    }
}

impl Orientation {
    /// `at_centres` has the triangle of `surface` that is nearest to the centre of each face.
    fn new(shape: &Shape, surface: &Reference, at_centres: &[u32]) -> Self {
        let alike = |(n, &t): (&crate::mesh::Vector, &u32)| n.dot(&surface.normal(t));
        let cosines: Vec<f64> = shape.normals.par_iter().zip(at_centres).map(alike).collect();
        // At a crease several triangles are nearest, and which of them is found says nothing. The
        // normal of a face without area is NaN: such a face looks nowhere and counts as well.
        let looks_along = |&f: &usize| {
            let (centre, normal, near) = (&shape.centres[f], &shape.normals[f], at_centres[f]);
            let reach = surface.closest_near(centre, near).distance + TIE_REL * surface.diagonal();
            let facing = surface.closest_facing(centre, normal, near, reach).triangle;
            surface.normal(facing).dot(normal) >= 0.0
        };
        let faces = (0..cosines.len()).into_par_iter();
        let right = faces.filter(|f| cosines[*f] >= 0.0 || looks_along(f)).count();
        let flipped_faces = cosines.len() - right;
        let angle = |c: &f64| c.clamp(-1.0, 1.0).acos().to_degrees();
        Self {
            flipped_faces,
            flipped_share: share(flipped_faces, cosines.len()),
            normal_deviation_deg: Spread::of(cosines.iter().map(angle)),
        }
    }
}

fn farthest(distances: &[f64]) -> f64 {
    distances.iter().copied().fold(0.0, f64::max)
}

/// Points that faces of `mesh` use: first those of its `surface` in the order of that, in which
/// neighbours are near each other.
fn used_points(mesh: &PolyMesh, surface: &Reference) -> Vec<Point> {
    let used = connectivity::used_vertices(mesh);
    let mut vertices = surface.vertices_in_order(mesh.vertex_count());
    vertices.retain(|&v| used[v as usize]);
    vertices.into_iter().map(|v| mesh.points()[v as usize]).collect()
}
