//! Faces that smoothing leaves poor: their corners are moved until the worst of the faces around
//! each is as good as it can be.
//!
//! Shape fitting minimises a mean and may leave single faces folded, most of all where what is
//! held leaves little room. Here every free corner of a poor face, and of the faces around it,
//! tries places around its own on the reference and takes the one that lifts the least scaled
//! Jacobian of its faces (a compass search, as in *smart* Laplacian smoothing: Freitag 1997);
//! nothing that is good is touched.

use super::kernel::Kernel;
use super::soundness::{broken_below, corners_area, least_sine, soundness};
use crate::mesh::{Point, PolyMesh, Vector};
use crate::surface::Reference;
use rustc_hash::FxHashMap;

/// Directions that are tried around a vertex.
const DIRECTIONS: usize = 8;
/// Length of the first step, in mean distances to the corners around.
const FIRST: f64 = 0.4;
/// Steps shorter than this are not tried, in the same unit.
const LAST: f64 = 0.02;
/// Most passes over the vertices.
const PASSES: usize = 24;
/// Less than this is no progress.
const PROGRESS: f64 = 1e-4;

/// Improves the faces of `mesh` that are less sound than `least`; whether anything has moved.
/// `kernel` knows what is held, and which side is out. O(poor faces).
pub(super) fn untangle(
    mesh: &mut PolyMesh,
    kernel: &Kernel,
    (reference, sign): (&Reference, f64),
    least: f64,
) -> bool {
    let poor = mesh.faces().zip(0..);
    let poor: Vec<u32> =
        poor.filter(|(face, _)| soundness(mesh.points(), face) < least).map(|(_, f)| f).collect();
    if poor.is_empty() {
        return false;
    }
    let around = Surroundings::new(mesh, &poor);
    let mut points = mesh.points().to_vec();
    let mut moved = false;
    for pass in 0..PASSES {
        let mut better = false;
        for &(v, ref faces) in &around.vertices {
            if !kernel.vertices[v as usize].held {
                let near = kernel.vertices[v as usize].last;
                let site = Site { mesh, faces, v, reference, near, sign };
                better |= site.improve(&mut points, least, pass);
            }
        }
        moved |= better;
        if !better {
            break;
        }
    }
    mesh.set_points(points);
    moved
}

/// The corners of poor faces and of the faces around them, each with its faces.
struct Surroundings {
    vertices: Vec<(u32, Vec<u32>)>,
}

impl Surroundings {
    fn new(mesh: &PolyMesh, poor: &[u32]) -> Self {
        let corners = |faces: &[u32]| {
            let mut all: Vec<u32> =
                faces.iter().flat_map(|&f| mesh.face(f as usize)).copied().collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        let near = corners(poor);
        let touching =
            |face: &[u32], set: &[u32]| face.iter().any(|v| set.binary_search(v).is_ok());
        let faces = |set: &[u32]| -> Vec<u32> {
            let all = mesh.faces().zip(0..);
            all.filter(|(face, _)| touching(face, set)).map(|(_, f)| f).collect()
        };
        let vertices = corners(&faces(&near));
        let mut of: FxHashMap<u32, Vec<u32>> = vertices.iter().map(|&v| (v, Vec::new())).collect();
        for f in faces(&vertices) {
            for v in mesh.face(f as usize) {
                of.entry(*v).and_modify(|faces| faces.push(f));
            }
        }
        let with_faces = |v| (v, of.remove(&v).unwrap_or_default());
        Self { vertices: vertices.into_iter().map(with_faces).collect() }
    }
}

/// A vertex that may move.
struct Site<'a> {
    mesh: &'a PolyMesh,
    faces: &'a [u32],
    v: u32,
    reference: &'a Reference,
    /// A triangle of the reference near the vertex.
    near: u32,
    /// 1 if the mesh is oriented like the reference, else −1.
    sign: f64,
}

impl Site<'_> {
    /// Moves the vertex if that lifts the worst of its faces, as long as that one is below
    /// `least`. Every other pass tries the directions in between.
    fn improve(&self, points: &mut [Point], least: f64, pass: usize) -> bool {
        let at = points[self.v as usize];
        let hit = self.reference.closest_near(&at, self.near);
        let normal = self.reference.normal(hit.triangle) * self.sign;
        let before = self.worst(points, &normal);
        if before >= least {
            return false;
        }
        let Some([x, y]) = tangents(&normal) else { return false };
        let ring = self.ring(points);
        let reach = ring.iter().map(|p| (p - at).norm()).sum::<f64>() / ring.len() as f64;
        let middle: Vector = ring.iter().map(|p| p.coords).sum::<Vector>() / ring.len() as f64;
        let mut best = (before + PROGRESS, at);
        let mut attempt = |aim: &Point| {
            let place = self.reference.closest_facing(aim, &normal, hit.triangle, reach).point;
            points[self.v as usize] = place;
            let now = self.worst(points, &normal);
            if now > best.0 {
                best = (now, place);
            }
        };
        // From a fold no small step leads out.
        attempt(&Point::from(middle));
        let mut step = FIRST;
        while step > LAST {
            for i in 0..DIRECTIONS {
                let turn = (i as f64 + 0.5 * (pass % 2) as f64) / DIRECTIONS as f64;
                let (sine, cosine) = (turn * std::f64::consts::TAU).sin_cos();
                attempt(&(at + (x * cosine + y * sine) * (step * reach)));
            }
            step *= 0.5;
        }
        points[self.v as usize] = best.1;
        best.1 != at
    }

    /// The least sine of a corner among the triangles and quads at the vertex, each turned as its
    /// area is, less by two if it is turned over against `normal`; or what a larger polygon lacks to
    /// be sound.
    fn worst(&self, points: &[Point], normal: &Vector) -> f64 {
        let quality = |&f: &u32| {
            let face = self.mesh.face(f as usize);
            let area = corners_area(points, face);
            let along = if area.dot(normal) < 0.0 { -2.0 } else { 0.0 };
            let Some(unit) = area.try_normalize(0.0) else { return -2.0 };
            let sine = along + least_sine(points, face, &unit);
            match face.len() {
                ..=4 => sine,
                n if sine < broken_below(n) => sine - broken_below(n),
                _ => f64::INFINITY,
            }
        };
        self.faces.iter().map(quality).fold(f64::INFINITY, f64::min)
    }

    /// The other corners of the faces at the vertex; those across an edge twice.
    fn ring(&self, points: &[Point]) -> Vec<Point> {
        let corners = self.faces.iter().flat_map(|&f| self.mesh.face(f as usize));
        corners.filter(|&&w| w != self.v).map(|&w| points[w as usize]).collect()
    }
}

/// Two unit vectors across `normal` and each other.
fn tangents(normal: &Vector) -> Option<[Vector; 2]> {
    let away = if normal.x.abs() < 0.6 { Vector::x() } else { Vector::y() };
    let x = normal.cross(&away).try_normalize(0.0)?;
    Some([x, normal.cross(&x)])
}
