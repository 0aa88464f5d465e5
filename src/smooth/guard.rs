//! What smoothing must not do: leave the surface, or spoil a face; and undoing it where it did.
//!
//! The distance to the reference is measured both ways on fixed samples. Where a sample is
//! farther than the budget, or a face is worse than allowed, the vertices around go part of the
//! way back to where they were; after a few rounds they are back altogether.

use super::anchors::watched;
use super::kernel::Kernel;
use super::soundness::soundness;
use crate::mesh::{Point, PolyMesh, Vector};
use crate::surface::{Deviation, Hit, Reference};
use rayon::prelude::*;

/// How far the mesh may be from the reference, both ways, in units of the file.
pub type Budget = Deviation;

/// A face that was sound must stay at least as sound as this whatever the limit is.
const SOUND: f64 = 0.02;
/// What a poor face may lose for the good of those around it.
const SLIP: f64 = 0.05;
/// Samples of each surface, beside the vertices of the reference, for each vertex of the mesh: with
/// one, a ridge can be lost between them.
const SAMPLES_PER_VERTEX: usize = 3;
/// The fewest and the most samples.
const SAMPLES: (usize, usize) = (20_000, 200_000);

/// The limits, and the samples that they are checked on.
pub(crate) struct Guard<'a> {
    pub(super) reference: &'a Reference,
    places: Vec<Point>,
    samples: usize,
    /// 1 if the mesh is oriented like the reference, else −1.
    sign: f64,
}

/// The state of a mesh, face by face.
#[derive(Debug, Clone, Default)]
pub(crate) struct Finding {
    pub(crate) deviation: Deviation,
    /// Least scaled Jacobian of the quads.
    pub(crate) least_jacobian: f64,
    /// [`soundness`] of each face.
    soundness: Vec<f64>,
    /// Whether the face is turned over against the reference.
    flipped: Vec<bool>,
    /// Largest distance of a sample at the face, either way.
    far: Vec<f64>,
    /// Part of each face in the mean squares of both ways together.
    load: Vec<f64>,
}

/// What is allowed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    pub(crate) budget: Budget,
    /// Least [`soundness`] of a face that was not worse before.
    pub(crate) jacobian: f64,
}

/// A mesh in work as a surface, where it is sampled, and the triangles that were found when it was
/// last measured: they are near those that will be found next time. Empty until it follows a mesh.
#[derive(Debug, Default)]
pub(crate) struct Trace {
    /// None if no face has an area.
    pub(super) surface: Option<Reference>,
    /// Triangle of the surface that each sample of the mesh is on: what has moved and come back is
    /// measured as it was.
    sampled: Vec<u32>,
    /// Triangle of the reference at the centre of each face, and at each sample of the mesh.
    centres: Vec<u32>,
    samples: Vec<u32>,
    /// Triangle of the surface at each place of the reference.
    places: Vec<u32>,
}

impl Trace {
    /// Follows the mesh to where its points are now.
    pub(super) fn follow(&mut self, mesh: &PolyMesh) {
        self.surface = self.surface.take().and_then(|surface| surface.moved(mesh));
        if self.surface.is_none() {
            self.surface = Reference::plain(mesh).ok();
            self.sampled.clear();
        }
    }

    /// Where on the reference the centre of each face is.
    pub(super) fn at_centres(&mut self, mesh: &PolyMesh, reference: &Reference) -> Vec<Hit> {
        let centres: Vec<Point> =
            (0..mesh.face_count()).into_par_iter().map(|f| mesh.centre(f)).collect();
        let mut hits = Vec::with_capacity(centres.len());
        reference.closest_each(&centres, &mut self.centres, |_, hit| hits.push(*hit));
        hits
    }
}

impl<'a> Guard<'a> {
    /// For a mesh of so many vertices, whose side of the reference `sign` tells. O(triangles).
    pub(crate) fn new(reference: &'a Reference, vertices: usize, sign: f64) -> Self {
        let samples = (SAMPLES_PER_VERTEX * vertices).clamp(SAMPLES.0, SAMPLES.1);
        Self { reference, places: watched(reference, samples), samples, sign }
    }

    /// Measures `mesh`, which may have moved since `trace` followed it last. O(n log n), parallel.
    pub(crate) fn check(&self, mesh: &PolyMesh, trace: &mut Trace) -> Finding {
        trace.follow(mesh);
        let centres = trace.at_centres(mesh, self.reference);
        self.check_at(mesh, &centres, trace)
    }

    /// Measures a mesh whose faces have their centres at `centres` of the reference.
    pub(super) fn check_at(&self, mesh: &PolyMesh, centres: &[Hit], trace: &mut Trace) -> Finding {
        let n = mesh.face_count();
        let soundness: Vec<f64> =
            (0..n).into_par_iter().map(|f| soundness(mesh.points(), mesh.face(f))).collect();
        let quads = mesh.faces().zip(&soundness).filter(|(face, _)| face.len() == 4);
        let mut found = Finding {
            deviation: Deviation::default(),
            least_jacobian: quads.map(|(_, &s)| s).fold(1.0, f64::min),
            soundness,
            flipped: vec![false; n],
            far: vec![0.0; n],
            load: vec![0.0; n],
        };
        if let Some(surface) = trace.surface.take() {
            if trace.sampled.is_empty() {
                trace.sampled = surface.sampled(self.samples);
            }
            let sampled = (&trace.sampled[..], &mut trace.samples);
            let away = self.away(&surface, sampled, &mut found);
            let back = self.back(&surface, &mut trace.places, &mut found);
            self.centres(mesh, centres, &mut found);
            let hausdorff = found.far.iter().copied().fold(0.0, f64::max);
            found.deviation = Deviation { hausdorff, rms: away.max(back).sqrt() };
            trace.surface = Some(surface);
        }
        found
    }

    /// Mean square distance of samples of the mesh to the reference.
    fn away(
        &self,
        surface: &Reference,
        (sampled, near): (&[u32], &mut Vec<u32>),
        found: &mut Finding,
    ) -> f64 {
        let face = |i: usize| surface.faces()[sampled[i] as usize];
        let share = 1.0 / sampled.len().max(1) as f64;
        let mut sum = 0.0;
        self.reference.closest_each(&surface.samples_on(sampled), near, |i, hit| {
            sum += found.note(face(i), hit.distance, share);
        });
        sum
    }

    /// Mean square distance of samples of the reference to the mesh; its vertices count for
    /// the largest distance only.
    fn back(&self, surface: &Reference, near: &mut Vec<u32>, found: &mut Finding) -> f64 {
        let count = self.samples.min(self.places.len());
        let share = 1.0 / count.max(1) as f64;
        let mut sum = 0.0;
        surface.closest_each(&self.places, near, |i, hit| {
            let face = surface.faces()[hit.triangle as usize];
            sum += found.note(face, hit.distance, if i < count { share } else { 0.0 });
        });
        sum
    }

    /// Distances and sides of the centres of the faces.
    fn centres(&self, mesh: &PolyMesh, hits: &[Hit], found: &mut Finding) {
        for (f, hit) in hits.iter().enumerate() {
            found.note(f as u32, hit.distance, 0.0);
            let normal = self.reference.normal(hit.triangle) * self.sign;
            found.flipped[f] = mesh.area_vector(f).dot(&normal) < 0.0;
        }
    }
}

impl Finding {
    /// Notes the distance of a sample at a face that is such a share of all samples, or none; its
    /// part in their mean square.
    fn note(&mut self, f: u32, distance: f64, share: f64) -> f64 {
        let part = distance * distance * share;
        self.far[f as usize] = self.far[f as usize].max(distance);
        self.load[f as usize] += part;
        part
    }

    /// Whether a face is folded, or otherwise [broken](super::soundness::broken_below).
    pub(super) fn is_folded(&self) -> bool {
        self.soundness.iter().any(|&s| s < 0.0)
    }

    /// Faces that break a limit, ascending; if the mean square does, those that have added most
    /// to it since `start`.
    pub(crate) fn broken(&self, start: &Self, limits: &Limits) -> Vec<u32> {
        let floor = |f: usize| {
            let before = start.soundness[f];
            (limits.jacobian.min(before) - SLIP).max(before.min(SOUND))
        };
        let bad = |f: usize| {
            self.soundness[f] < floor(f)
                || self.flipped[f] && !start.flipped[f]
                || self.far[f] > limits.budget.hausdorff
        };
        let mut broken: Vec<u32> =
            (0..self.far.len()).filter(|&f| bad(f)).map(|f| f as u32).collect();
        if self.deviation.rms > limits.budget.rms {
            broken.extend(self.heaviest(start, limits.budget.rms));
            broken.sort_unstable();
            broken.dedup();
        }
        broken
    }

    /// The faces whose load has grown most, as many as make up for what exceeds `rms`.
    fn heaviest(&self, start: &Self, rms: f64) -> Vec<u32> {
        let grown = |f: u32| self.load[f as usize] - start.load[f as usize];
        let mut faces: Vec<u32> = (0..self.load.len() as u32).filter(|&f| grown(f) > 0.0).collect();
        faces.sort_by(|&a, &b| grown(b).total_cmp(&grown(a)).then(a.cmp(&b)));
        // Twice the excess: what is lowered goes half of the way back.
        let mut left = 2.0 * (self.deviation.rms.powi(2) - 0.98 * rms * rms);
        faces
            .into_iter()
            .take_while(|&f| {
                let more = left > 0.0;
                left -= grown(f);
                more
            })
            .collect()
    }
}

/// How much of its move each vertex keeps, lowered where limits are broken.
pub(super) struct Mending {
    start: Vec<Point>,
    smoothed: Vec<Point>,
    keep: Vec<f64>,
}

impl Mending {
    pub(super) fn new(start: Vec<Point>, smoothed: Vec<Point>) -> Self {
        Self { keep: vec![1.0; start.len()], start, smoothed }
    }

    /// Lets the corners of `broken` faces and, less, three rings around them keep less.
    pub(super) fn lower(&mut self, mesh: &PolyMesh, broken: &[u32]) {
        let mut take = vec![0.0f64; self.keep.len()];
        for &v in broken.iter().flat_map(|&f| mesh.face(f as usize)) {
            take[v as usize] = 0.5;
        }
        for _ in 0..3 {
            let before = take.clone();
            for face in mesh.faces() {
                let most = face.iter().map(|&v| before[v as usize]).fold(0.0, f64::max) * 0.6;
                for &v in face {
                    take[v as usize] = take[v as usize].max(most);
                }
            }
        }
        for (keep, take) in self.keep.iter_mut().zip(take) {
            *keep = if *keep - take < 0.05 { 0.0 } else { *keep - take };
        }
    }

    /// All as it was.
    pub(super) fn undone(self) -> Vec<Point> {
        self.start
    }

    /// How many vertices do not keep their whole move.
    pub(super) fn count(&self) -> usize {
        self.keep.iter().filter(|&&k| k < 1.0).count()
    }

    /// The blended places, projected where they are neither old nor new.
    pub(super) fn blend(&self, kernel: &Kernel, reference: &Reference, sign: f64) -> Vec<Point> {
        let place = |v: usize| {
            let keep = self.keep[v];
            let vertex = &kernel.vertices[v];
            if keep <= 0.0 || vertex.held {
                return self.start[v];
            }
            if keep >= 1.0 {
                return self.smoothed[v];
            }
            let between = Point::from(self.start[v].coords.lerp(&self.smoothed[v].coords, keep));
            let reach = (self.smoothed[v] - self.start[v]).norm();
            let normal: Vector = vertex.normal * sign;
            reference.closest_facing(&between, &normal, vertex.last, reach).point
        };
        (0..self.keep.len()).into_par_iter().map(place).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes;

    #[test]
    fn what_has_not_moved_is_measured_as_it_was() {
        let flat = shapes::grid(20, 20);
        let reference = Reference::new(&flat).unwrap();
        let mut mesh = flat.clone();
        let with = |place: &dyn Fn(&Point) -> Point| flat.points().iter().map(place).collect();
        let wave = |p: &Point| 0.2 * (p.x + 2.0 * p.y).sin();
        mesh.set_points(with(&|p| p + Vector::z() * wave(p)));
        let guard = Guard::new(&reference, mesh.vertex_count(), 1.0);
        let mut trace = Trace::default();
        let start = guard.check(&mesh, &mut trace);
        let stretch = |p: &Point| if p.y > 12.0 { p.y - 12.0 } else { 0.0 };
        mesh.set_points(with(&|p| p + Vector::z() * wave(p) + Vector::y() * stretch(p)));
        let found = guard.check(&mesh, &mut trace);
        let changed = |f: &usize| (start.far[*f] - found.far[*f]).abs() > 1e-12;
        let changed: Vec<usize> = (0..mesh.face_count()).filter(changed).collect();
        let stays = |f: usize| mesh.face(f).iter().all(|&v| flat.points()[v as usize].y < 11.0);
        assert!(changed.len() > 50, "{changed:?}");
        assert!(!changed.iter().any(|&f| stays(f)), "{changed:?}");
    }
}
