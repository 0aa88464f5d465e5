//! The quality gate: an edit is judged by what its surroundings look like once they have relaxed.
//!
//! Accepted are edits after which, over the whole relaxed region, the least scaled Jacobian is
//! still good or as good as before, corner angles have not grown worse by more than the exchange
//! rate λ per irregular element removed, and the surface is within the budget, both ways.

use super::contact::Contact;
use super::cover::{Cover, fan_distance, gauges};
use super::lines::{beside, sagitta};
use crate::knobs::knobs;
use crate::mesh::{Point, Vector};
use crate::smooth::{
    Orientation, Region as Patch, RelaxOptions, broken_below, fit_local, relax_local, twice_area,
};
use crate::sqrtcc::{Mark, QuadMesh, Vertex};
use crate::surface::{Reference, SharpLines};
use smallvec::SmallVec;

knobs! {
    /// What an edit may cost in shape and distance.
    pub struct GateOptions in "gate" {
        /// Rings of faces around an edit that relax with it.
        rings: u32 = 3, in 1.0..=12.0, "rings";
        /// Iterations of relaxing after single operations and walks.
        sweeps: u32 = 50, in 1.0..=1000.0, "count";
        /// Iterations of relaxing after a refill, beside the square root of its number of faces.
        refill_sweeps: u32 = 30, in 1.0..=1000.0, "count";
        /// Least scaled Jacobian of a quad, unless it was less before.
        min_jacobian: f64 = 0.4, in -1.0..=1.0, "1";
        /// Distance to the reference that an edit may cause, as a multiple of what is allowed in the
        /// end: smoothing takes some of it back.
        distance: f64 = 1.1, in 0.1..=10.0, "allowed Hausdorff distances";
        /// How far a point of the reference may be from the faces that an edit makes, unless it
        /// was farther before.
        cover_edges: f64 = 1.0, in 0.0..=10.0, "mean edges";
        /// Hausdorff distance that edits and smoothing may cause, as a multiple of the input's. It is
        /// known from samples only: the part below 1 is for what falls between them.
        hausdorff: f64 = 0.92, in 0.1..=100.0, "input Hausdorff distances";
        /// Root mean square distance of the reference to the mesh that all edits together may
        /// cause, as a multiple of the input's, the larger of both ways.
        rms: f64 = 1.1, in 0.0..=100.0, "input RMS distances";
        /// Hausdorff distance allowed where the mesh is its own reference, and so at none from it.
        own_hausdorff_edges: f64 = 0.2, in 0.0..=10.0, "mean edges";
        /// Root mean square distance allowed where the mesh is its own reference.
        own_rms_edges: f64 = 0.03, in 0.0..=10.0, "mean edges";
        /// Mean deviation of corner angles that all edits together may cause, as a multiple of the
        /// input's, or of 2 degrees if that is more.
        angles: f64 = 0.75, in 0.0..=100.0, "input deviations";
        /// Largest |ln| of the number of faces after over before a refill.
        area: f64 = 0.3, in 0.0..=3.0, "ln";
    }
}

/// What the gate needs to know beside the mesh.
#[derive(Debug, Clone, Copy)]
pub struct Setting<'a> {
    /// The surface to stay on.
    pub reference: &'a Reference,
    /// Its sharp features, along which vertices of feature lines slide,
    pub lines: &'a SharpLines,
    /// if they are this near to them, in units of the file.
    pub rails: Option<f64>,
    /// How the mesh is oriented against it.
    pub orientation: Orientation,
    /// How vertices relax.
    pub relax: &'a RelaxOptions,
    /// Share of the shift after which faces, not corners, lie on the reference in the mean.
    pub fit: f64,
    /// The limits.
    pub options: &'a GateOptions,
    /// Largest distance to the reference, in units of the file.
    pub distance: f64,
    /// How far a point of the reference may be from the faces of an edit, in units of the file.
    pub cover: f64,
    /// What an edit may add to Σ squared distance of the probes for each element it removes, in
    /// squared units of the file.
    pub growth: f64,
}

/// An edit that passed.
#[derive(Debug, Clone, PartialEq)]
pub struct Passed {
    /// Growth of Σ |angle − ideal| over all corners of the region against what as many had in the
    /// mean before, degrees.
    pub angle_growth: f64,
    /// How well shaped the region is.
    pub shape: Shape,
    /// By how much less the quads of the region lack to a fair scaled Jacobian, in all.
    pub mended: f64,
    /// Growth of Σ squared distance of the probes of the region; may be negative.
    pub distance_growth: f64,
    /// Where the free vertices of the region are now, and a triangle of the reference there.
    pub moved: Vec<(Vertex, Point, u32)>,
}

/// Why an edit was turned down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Failure {
    /// A quad would be too bad.
    Jacobian,
    /// Angles would grow worse than the elements removed are worth.
    Angles,
    /// The mesh would leave the reference.
    Distance,
    /// The mesh would get too many or too few edges.
    Size,
}

/// The shape of some faces of the mesh, each quad against its own normal.
#[must_use]
pub fn shape_of(mesh: &QuadMesh, faces: impl Iterator<Item = Vertex>) -> Shape {
    let mut shape = Shape::default();
    let mut points: SmallVec<[Point; 8]> = SmallVec::new();
    for f in faces {
        points.clear();
        points.extend(mesh.neighbours(f).map(|v| mesh.position(v)));
        shape.add(&points, &Vector::zeros());
    }
    shape
}

/// What an edit may cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Price {
    /// How many elements it is worth,
    pub worth: u32,
    /// at so many degrees of corner angle each,
    pub lambda: f64,
    /// less what it costs otherwise;
    pub extra: f64,
    /// what a better one costs, degrees: dearer ones need not be looked at to the end.
    pub most: f64,
}

impl Price {
    /// Of an edit that costs nothing but angles, whatever others cost.
    #[must_use]
    pub fn of(worth: u32, lambda: f64) -> Self {
        Self { worth: worth.max(1), lambda, extra: 0.0, most: f64::INFINITY }
    }
}

/// An edit that did not pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rejected {
    /// Why.
    pub failure: Failure,
    /// The exchange rate at which it would have passed, as far as is known; infinite if none.
    pub needs: f64,
}

impl From<Failure> for Rejected {
    fn from(failure: Failure) -> Self {
        Self { failure, needs: f64::INFINITY }
    }
}

/// How well shaped some faces are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Σ |angle − ideal| over corners, degrees.
    angles: f64,
    /// Number of corners.
    corners: usize,
    /// Least scaled Jacobian of the quads, against the reference.
    jacobian: f64,
    /// Faces that are broken: see [`broken_below`].
    broken: u32,
    /// Σ over quads of what their scaled Jacobian lacks to [`POOR`].
    deficit: f64,
}

/// Quads below this scaled Jacobian must not become worse all together.
const POOR: f64 = 0.4;
/// Quads that were better than that may not get a lower scaled Jacobian than this where vertices are
/// moved for creases.
pub(super) const FAIR: f64 = 0.6;
/// Share of the normals at the corners of a face that must agree on which side is out.
const AGREED: f64 = 0.5;

/// Judges edits; keeps its arrays from one to the next.
#[derive(Debug, Clone, Default)]
pub struct Gate {
    stamp: Vec<u32>,
    number: Vec<u32>,
    epoch: u32,
    faces: Vec<Vertex>,
    vertices: Vec<Vertex>,
    free: Vec<bool>,
    /// Faces of the region, as numbers of the patch, that the edit made or changed.
    changed: Vec<u32>,
    patch: Patch,
    /// How far feature edges were from the crease before.
    bend: f64,
    /// The faces of the region, relaxed.
    cover: Cover,
}

/// What an edit that is to pass in the end looks like on the way there.
struct Hope {
    /// How many times the allowed growth of angles it may still be off,
    times: f64,
    /// and by what share of their sum before.
    share: f64,
    /// How much its quads may still lack of a fair scaled Jacobian.
    lack: f64,
    /// How many times as far as allowed the reference may still be from it, if that is looked at.
    bare: Option<f64>,
}

/// Before the relaxing and after each sixth of it, or after more where that is less than [`FEW`]
/// sweeps. Large patches, which are most of the work, converge fastest. Of the edits that pass in the
/// end 1.4 % are given up too early for their angles on Spot, Blub and the bunny, and 0.5 % for their
/// quads on Spot, the goat head, the penguin and the feature type; of those that do not pass for their
/// quads, three in four before the relaxing. Of those that leave the reference bare, nine in ten are
/// given up before the relaxing on Spot, and half of the others after a sixth of it; of those that
/// pass, 1 in 3000 and 1 in 200.
const HOPES: [Hope; 7] = [
    Hope { times: 7.0, share: 0.3, lack: 1.6, bare: Some(1.1) },
    Hope { times: 3.4, share: 0.15, lack: 0.4, bare: Some(1.0) },
    Hope { times: 2.2, share: 0.08, lack: 0.1, bare: None },
    Hope { times: 1.7, share: 0.05, lack: 0.07, bare: None },
    Hope { times: 1.35, share: 0.03, lack: 0.05, bare: None },
    Hope { times: 1.1, share: 0.02, lack: 0.03, bare: None },
    Hope { times: 1.0, share: 0.0, lack: 0.0, bare: None },
];

/// After fewer sweeps than this it does not pay to look at an edit on its way: its vertices would
/// have to be put on the reference first.
const FEW: u32 = 5;

impl Gate {
    /// Judges what was done to `mesh` since `mark`, which touched those vertices.
    /// The mesh is as before the edit afterwards: a caller that wants it makes it again.
    pub fn judge(
        &mut self,
        mesh: &mut QuadMesh,
        (mark, touched): (Mark, &[Vertex]),
        (setting, contact): (&Setting, &Contact),
        (sweeps, Price { worth, lambda, extra, most }): (u32, Price),
    ) -> Result<Passed, Rejected> {
        self.gather(mesh, touched, (setting, contact));
        // The patch holds a copy of the edited surroundings: the mesh can go back already.
        mesh.undo_to(mark);
        let before = self.shape_before(mesh, touched, (setting, contact));
        let mut after = self.shape_after();
        // Else faces that vanish would be worth their angles, and those that come cost them.
        let angles_before = before.mean_angle() * after.corners as f64;
        let worth = f64::from(worth);
        let allowed = lambda * worth - extra;
        let too_steep =
            |growth: f64| Rejected { failure: Failure::Angles, needs: (growth + extra) / worth };
        let least = setting.options.min_jacobian.min(before.jacobian);
        let parts = HOPES.len() as u32 - 1;
        // Where vertices slide along a crease, it takes longer until the surface is covered.
        let slides = self.patch.rails().next().is_some();
        let mut done = 0;
        for (hope, part) in HOPES.iter().zip(0..) {
            if part > 0 {
                let now = sweeps * part / parts - done;
                if now < FEW && part < parts {
                    continue;
                }
                done += now;
                let on = (setting.reference, Some(setting.lines));
                relax_local(&mut self.patch, on, setting.relax, now);
                if part == parts {
                    // Else all edits would seem to lose what the smoothing before them has fitted.
                    fit_local(&mut self.patch, setting.reference, setting.relax, setting.fit);
                }
                after = self.shape_after();
            }
            let growth = after.angles - (1.0 + hope.share) * angles_before;
            if growth > hope.times * allowed {
                return Err(too_steep(growth / hope.times));
            }
            if growth > most.max(hope.times * most) {
                return Err(Rejected { failure: Failure::Angles, needs: lambda });
            }
            if (least - after.jacobian).max(after.deficit - before.deficit) > hope.lack {
                return Err(Failure::Jacobian.into());
            }
            let bare = hope.bare.filter(|_| !slides);
            if bare.is_some_and(|times| !self.is_covered(touched, (setting, contact), times)) {
                return Err(Failure::Distance.into());
            }
        }
        if after.broken > before.broken {
            return Err(Failure::Jacobian.into());
        }
        if self.bend(setting.lines) > self.bend.max(setting.rails.unwrap_or(0.0)) {
            return Err(Failure::Distance.into());
        }
        let growth = self.distance_growth(touched, (setting, contact)).ok_or(Failure::Distance)?;
        if self.leaves_surface(setting) || growth > setting.growth * worth {
            return Err(Failure::Distance.into());
        }
        let free = (0..self.free.len() as u32).filter(|&i| self.free[i as usize]);
        let places = free.chain(self.patch.rails().map(|(i, _)| i));
        let place =
            |i: u32| (self.vertices[i as usize], self.patch.point(i), self.patch.triangle(i));
        let moved = places.map(place).collect();
        Ok(Passed {
            angle_growth: after.angles - angles_before,
            shape: after,
            mended: before.deficit - after.deficit,
            distance_growth: growth,
            moved,
        })
    }

    /// The faces within some rings of what was touched; vertices all of whose faces are among
    /// them and that nothing holds are free.
    fn gather(
        &mut self,
        mesh: &QuadMesh,
        touched: &[Vertex],
        (setting, contact): (&Setting, &Contact),
    ) {
        self.stamp.resize(mesh.vertex_ids() as usize, 0);
        self.number.resize(mesh.vertex_ids() as usize, 0);
        self.epoch += 1;
        self.faces.clear();
        self.vertices.clear();
        for &v in touched {
            if v >= mesh.vertex_ids() || !mesh.is_alive(v) || mesh.is_ghost(v) {
                continue;
            }
            if mesh.is_face(v) {
                mesh.neighbours(v).for_each(|p| self.add_vertex(mesh, p));
            } else {
                self.add_vertex(mesh, v);
            }
        }
        let mut first = 0;
        for _ in 0..setting.options.rings {
            let end = self.vertices.len();
            for i in first..end {
                self.add_faces_of(mesh, self.vertices[i]);
            }
            first = end;
        }
        self.changed.clear();
        let changed = self.faces.iter().zip(0..).filter(|(f, _)| touched.binary_search(f).is_ok());
        self.changed.extend(changed.map(|(_, i)| i));
        self.fill_patch(mesh, first, (setting, contact));
    }

    fn add_vertex(&mut self, mesh: &QuadMesh, v: Vertex) {
        if self.stamp[v as usize] != self.epoch && !mesh.is_ghost(v) {
            self.stamp[v as usize] = self.epoch;
            self.number[v as usize] = self.vertices.len() as u32;
            self.vertices.push(v);
        }
    }

    fn add_faces_of(&mut self, mesh: &QuadMesh, v: Vertex) {
        for f in mesh.neighbours(v) {
            if self.stamp[f as usize] != self.epoch && !mesh.is_ghost(f) {
                self.stamp[f as usize] = self.epoch;
                self.faces.push(f);
                mesh.neighbours(f).for_each(|p| self.add_vertex(mesh, p));
            }
        }
    }

    fn fill_patch(
        &mut self,
        mesh: &QuadMesh,
        expanded: usize,
        (setting, contact): (&Setting, &Contact),
    ) {
        self.patch.begin(setting.orientation);
        self.free.clear();
        for (i, &v) in self.vertices.iter().enumerate() {
            let free = i < expanded && !mesh.is_held(v);
            self.free.push(free);
            self.patch.add_vertex(mesh.position(v), !free, contact.near(v));
        }
        let mut corners: SmallVec<[u32; 8]> = SmallVec::new();
        for &f in &self.faces {
            corners.clear();
            corners.extend(mesh.neighbours(f).map(|v| self.number[v as usize]));
            self.patch.add_face(&corners);
        }
        if let Some(reach) = setting.rails {
            self.add_rails(mesh, expanded, (setting.lines, reach));
        }
        self.bend = self.bend(setting.lines);
    }

    /// Lets those of the first vertices slide that are within a feature line, between quads: triangles
    /// would pull them to where no quad wants them later.
    fn add_rails(&mut self, mesh: &QuadMesh, first: usize, (lines, reach): (&SharpLines, f64)) {
        for i in (0..first).filter(|&i| !self.free[i]) {
            let v = self.vertices[i];
            let is_between_quads = || mesh.neighbours(v).all(|f| mesh.valence(f) == 4);
            let is_on = || lines.closest(&mesh.position(v), reach).is_some();
            if let Some(ends) = beside(mesh, v).filter(|_| is_between_quads() && is_on()) {
                self.patch.add_rail(i as u32, ends.map(|end| self.number[end as usize]));
            }
        }
    }

    /// How far the middle of an edge beside a vertex that slides is from the crease, at most.
    fn bend(&self, lines: &SharpLines) -> f64 {
        let edges = self.patch.rails().flat_map(|(v, ends)| ends.map(|end| [v, end]));
        let points = edges.map(|edge| edge.map(|v| self.patch.point(v)));
        points.map(|[from, to]| sagitta(lines, &from, &to)).fold(0.0, f64::max)
    }

    /// The shape of the relaxed region.
    fn shape_after(&self) -> Shape {
        let mut shape = Shape::default();
        let mut points: SmallVec<[Point; 8]> = SmallVec::new();
        for f in 0..self.patch.face_count() {
            points.clear();
            points.extend(self.patch.face(f).iter().map(|&v| self.patch.point(v)));
            let up = self.patch.face(f).iter().map(|&v| self.patch.normal(v)).sum();
            shape.add(&points, &up);
        }
        shape
    }

    /// The shape of the same part of the mesh before the edit: the faces of the region that were
    /// there, and those that the edit removed.
    fn shape_before(
        &mut self,
        mesh: &QuadMesh,
        touched: &[Vertex],
        (setting, contact): (&Setting, &Contact),
    ) -> Shape {
        let mut shape = Shape::default();
        let mut points: SmallVec<[Point; 8]> = SmallVec::new();
        let gone = |&&v: &&Vertex| self.stamp.get(v as usize) != Some(&self.epoch);
        for &f in self.faces.iter().chain(touched.iter().filter(gone)) {
            if f >= mesh.vertex_ids() || !mesh.is_alive(f) || !mesh.is_face(f) || mesh.is_ghost(f) {
                continue;
            }
            points.clear();
            points.extend(mesh.neighbours(f).map(|v| mesh.position(v)));
            let near = mesh.neighbours(f).filter_map(|v| contact.near(v));
            let up: Vector = near.map(|t| setting.reference.normal(t)).sum();
            shape.add(&points, &(up * setting.orientation.sign()));
        }
        shape
    }

    /// Whether a face that the edit made or changed is too far from the reference somewhere. An edge
    /// between vertices that are held is where it was, or a chord of a feature line, which bends.
    fn leaves_surface(&self, setting: &Setting) -> bool {
        self.changed.iter().any(|&i| {
            let corners = self.patch.face(i as usize);
            let is_free = |i: usize| self.free[corners[i % corners.len()] as usize];
            let near = self.patch.triangle(corners[0]);
            let distance = |at: Point| setting.reference.closest_near(&at, near).distance;
            // The middle of the face comes first.
            let counts = |i: usize| i == 0 || is_free(i - 1) || is_free(i);
            let points = self.points_of(i);
            let mut gauges = gauges(&points).enumerate().filter(|&(i, _)| counts(i));
            gauges.any(|(_, at)| distance(at) > setting.distance)
        })
    }

    /// Whether the probes of the faces that the edit made, changed or removed are at most so many
    /// times as far from the mesh now as is allowed.
    fn is_covered(
        &mut self,
        touched: &[Vertex],
        (setting, contact): (&Setting, &Contact),
        times: f64,
    ) -> bool {
        let is_new = |f: Vertex| touched.binary_search(&f).is_ok();
        self.all_probes((touched, is_new), contact, |cover, (own, probe, before)| {
            let most = (times * setting.cover.max(before)).powi(2);
            own <= most || cover.is_within(&probe, most)
        })
    }

    /// How much Σ squared distance grows over the probes of the region; `None` if one of them is
    /// too far from the mesh now.
    fn distance_growth(
        &mut self,
        touched: &[Vertex],
        (setting, contact): (&Setting, &Contact),
    ) -> Option<f64> {
        let mut growth = 0.0;
        let near = self.all_probes((touched, |_| true), contact, |cover, (own, probe, before)| {
            let farther = own > before * before;
            let nearest = if farther { cover.nearest(&probe, own) } else { None };
            let squared = nearest.map_or(own, |n| n.0);
            growth += squared - before * before;
            squared <= setting.cover.max(before).powi(2)
        });
        near.then_some(growth)
    }

    /// Whether all probes of those faces that count are as wanted: told of each are the squared
    /// distance to the face that it was at, infinite if that has gone, its place, and how far it was
    /// from the mesh.
    fn all_probes(
        &mut self,
        (touched, counts): (&[Vertex], impl Fn(Vertex) -> bool),
        contact: &Contact,
        mut wanted: impl FnMut(&mut Cover, (f64, Point, f64)) -> bool,
    ) -> bool {
        let patch = &self.patch;
        let corners = |i| patch.face(i).iter().map(|&v| patch.point(v));
        self.cover.fill((0..self.faces.len()).map(corners));
        let cover = &mut self.cover;
        let gone = touched.iter().filter(|&&v| self.stamp.get(v as usize) != Some(&self.epoch));
        let own = self.faces.iter().zip((0..).map(Some)).chain(gone.map(|f| (f, None)));
        own.filter(|&(&f, _)| counts(f)).all(|(&f, own)| {
            contact.probes(f).all(|(probe, before)| {
                let far = own.map_or(f64::INFINITY, |i| fan_distance(cover.corners(i), &probe));
                wanted(cover, (far, probe, before))
            })
        })
    }

    fn points_of(&self, face: u32) -> SmallVec<[Point; 8]> {
        self.patch.face(face as usize).iter().map(|&v| self.patch.point(v)).collect()
    }
}

impl Default for Shape {
    fn default() -> Self {
        Self { angles: 0.0, corners: 0, jacobian: 1.0, broken: 0, deficit: 0.0 }
    }
}

impl Shape {
    /// Σ |angle − ideal| over corners, degrees.
    #[must_use]
    pub fn angles(&self) -> f64 {
        self.angles
    }

    /// Mean |angle − ideal| of the corners, degrees.
    #[must_use]
    pub fn mean_angle(&self) -> f64 {
        self.angles / self.corners.max(1) as f64
    }

    /// Least scaled Jacobian of the quads.
    #[must_use]
    pub fn jacobian(&self) -> f64 {
        self.jacobian
    }

    /// Whether no more faces are broken than in `other`, and no quads are worse, give or take a
    /// little.
    #[must_use]
    pub fn is_about_as_good_as(&self, other: &Self) -> bool {
        self.broken <= other.broken
            && self.deficit <= other.deficit + 0.02
            && self.jacobian >= other.jacobian.min(POOR)
    }

    /// [`Self::is_about_as_good_as`], and no quad that was fair is so no longer.
    pub(super) fn is_as_fair_as(&self, other: &Self) -> bool {
        self.is_about_as_good_as(other) && self.jacobian >= other.jacobian.min(FAIR)
    }

    /// Adds a face. One against whose area most of `up`, the sum of the unit normals of the
    /// reference at its corners, points is turned over; at a crease they do not agree enough to say.
    pub(super) fn add(&mut self, points: &[Point], up: &Vector) {
        let n = points.len();
        self.corners += n;
        let ideal = 180.0 - 360.0 / n as f64;
        let normal = twice_area(n, |i| points[i]);
        let over = normal.dot(up) < -AGREED * n as f64 * normal.norm();
        let along = if over { -1.0 } else { 1.0 };
        let mut least: f64 = 1.0;
        let unit = normal.try_normalize(0.0).unwrap_or_else(Vector::zeros);
        for i in 0..n {
            let to_next = points[(i + 1) % n] - points[i];
            let to_prev = points[(i + n - 1) % n] - points[i];
            let scale = (to_next.norm_squared() * to_prev.norm_squared()).sqrt();
            let sine = to_next.cross(&to_prev).dot(&unit) / scale;
            let angle = if scale > 0.0 {
                let cosine = (to_next.dot(&to_prev) / scale).clamp(-1.0, 1.0);
                let turn = rough_acos(cosine).to_degrees();
                if sine < 0.0 { 360.0 - turn } else { turn }
            } else {
                0.0
            };
            self.angles += (angle - ideal).abs();
            let jacobian = if scale > 0.0 { along * sine } else { -1.0 };
            least = least.min(jacobian);
        }
        self.broken += u32::from(least < broken_below(n));
        if n == 4 {
            self.jacobian = self.jacobian.min(least);
            self.deficit += (POOR - least).max(0.0);
        }
    }
}

/// The arc cosine to 3e-8, three times as fast. Abramowitz & Stegun 1964, 4.4.46.
fn rough_acos(x: f64) -> f64 {
    const TERMS: [f64; 8] = [
        -0.001_262_491_1,
        0.006_670_090_1,
        -0.017_088_125_6,
        0.030_891_881_0,
        -0.050_174_304_6,
        0.088_978_987_4,
        -0.214_598_801_6,
        1.570_796_305_0,
    ];
    let polynomial = TERMS.into_iter().fold(0.0, |sum, term| sum * x.abs() + term);
    let acos = (1.0 - x.abs()).sqrt() * polynomial;
    if x < 0.0 { std::f64::consts::PI - acos } else { acos }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rough_arc_cosine_is_right_to_3e_8() {
        for i in -1000..=1000 {
            let x = f64::from(i) / 1000.0;
            assert!((rough_acos(x) - x.acos()).abs() < 2.5e-8, "{x}");
        }
    }
}
