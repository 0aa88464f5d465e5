//! Feature lines of the mesh: vertices within them slide along the creases of the reference.

use super::cover::gauges;
use super::gate::shape_of;
use crate::mesh::Point;
use crate::ops::within_line;
use crate::patch::crossing::Slide;
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};
use crate::surface::{Reference, SharpLines};
use smallvec::SmallVec;

/// Vertices of a line, to either side of where it is resampled, that slide at most.
const WINDOW: usize = 6;
/// From this turn on a line has a corner, which stays.
const CORNER_DEG: f64 = 40.0;
/// How far from the chord the crease may be, in lengths of the edge.
const SAGITTA: f64 = 0.3;
/// How much corners around may deviate more, on the mean, where a vertex is put onto a crease; the
/// smoothing that follows takes back a part.
const SETTLING_DEG: f64 = 8.0;
/// Shares of the way to the next vertex of the line that are tried.
const STRIDES: [f64; 3] = [0.25, 0.1, 0.03];

/// The vertices before and after `v` on its feature line, if the line runs on through it without a
/// corner.
pub(super) fn beside(mesh: &QuadMesh, v: Vertex) -> Option<[Vertex; 2]> {
    if mesh.is_face(v) || !mesh.is_held(v) || !within_line(mesh, v) {
        return None;
    }
    let mut on = mesh.outgoing(v).filter(|&h| mesh.is_frozen(QuadMesh::quad(h)));
    let mut next = || on.next().map(|h| mesh.origin(QuadMesh::opposite(h)));
    let ends = [next()?, next()?];
    let [a, b] = ends.map(|end| mesh.position(end) - mesh.position(v));
    (a.angle(&-b) <= CORNER_DEG.to_radians()).then_some(ends)
}

/// Faces of the polygon mesh at a vertex.
pub(super) fn faces_at(mesh: &QuadMesh, v: Vertex) -> impl Iterator<Item = Vertex> + '_ {
    mesh.neighbours(v).filter(|&f| !mesh.is_ghost(f))
}

/// What vertices slide on.
#[derive(Debug, Clone, Copy)]
pub struct Rails<'a> {
    /// The surface to stay on.
    pub reference: &'a Reference,
    /// Its sharp features.
    pub lines: &'a SharpLines,
    /// How far chords may be from the crease, and faces from the surface, if they were nearer before;
    /// in units of the file.
    pub tolerance: f64,
}

/// Lets the vertices within feature lines slide, one after the other, to where the angles around
/// them deviate less. Those that are on the crease stay on it; others stay. O(vertices · sweeps).
pub fn relax(mesh: &mut QuadMesh, rails: Rails, sweeps: u32) {
    let within = |&v: &Vertex| beside(mesh, v).is_some();
    let vertices: Vec<Vertex> = mesh.vertices().filter(within).collect();
    for _ in 0..sweeps {
        let moved = vertices.iter().filter(|&&v| rails.slide(mesh, v)).count();
        if moved == 0 {
            return;
        }
    }
}

/// How far the middle of a chord is from the crease that it stands for; infinite if that is farther
/// than it is long.
pub(super) fn sagitta(lines: &SharpLines, from: &Point, to: &Point) -> f64 {
    let middle = nalgebra::center(from, to);
    let near = lines.closest(&middle, (to - from).norm());
    near.map_or(f64::INFINITY, |on| (on - middle).norm())
}

impl Rails<'_> {
    /// Puts free vertices that are at most `reach` from a crease onto it and pins them, the nearest
    /// first, where faces stay about as good: those. O(vertices · log n).
    pub fn settle(self, mesh: &mut QuadMesh, reach: f64) -> Vec<Vertex> {
        let free = |&v: &Vertex| !(mesh.is_face(v) || mesh.is_ghost(v) || mesh.is_held(v));
        let near = |v: Vertex| {
            let place = self.lines.closest(&mesh.position(v), reach)?;
            Some(((place - mesh.position(v)).norm(), v, place))
        };
        let mut near: Vec<_> = mesh.vertices().filter(free).filter_map(near).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        near.retain(|&(_, v, place)| self.settles(mesh, v, place));
        near.into_iter().map(|(_, v, _)| v).collect()
    }

    /// Puts `v` there and pins it, unless that spoils the faces around; whether it did.
    fn settles(&self, mesh: &mut QuadMesh, v: Vertex, place: Point) -> bool {
        let faces: SmallVec<[Vertex; 8]> = faces_at(mesh, v).collect();
        let corners: u32 = faces.iter().map(|&f| mesh.valence(f)).sum();
        let state =
            |mesh: &QuadMesh| (shape_of(mesh, faces.iter().copied()), self.distance(mesh, &faces));
        let (at, (before, near)) = (mesh.position(v), state(mesh));
        mesh.set_position(v, place);
        let (after, off) = state(mesh);
        let allowed = before.angles() + SETTLING_DEG * f64::from(corners);
        let is_fair = after.angles() <= allowed
            && after.is_as_fair_as(&before)
            && off <= near.max(self.tolerance);
        if is_fair {
            mesh.pin(v);
        } else {
            mesh.set_position(v, at);
        }
        is_fair
    }

    /// Slides `v` to the best of a few places; whether it moved.
    fn slide(&self, mesh: &mut QuadMesh, v: Vertex) -> bool {
        let Some(ends) = beside(mesh, v) else { return false };
        let at = mesh.position(v);
        if self.lines.closest(&at, self.tolerance).is_none() {
            return false;
        }
        let [before, after] = ends.map(|w| mesh.position(w));
        let bend =
            |at: &Point| sagitta(self.lines, at, &before).max(sagitta(self.lines, at, &after));
        let most = bend(&at).max(self.tolerance);
        let faces: SmallVec<[Vertex; 8]> = faces_at(mesh, v).collect();
        let now = shape_of(mesh, faces.iter().copied());
        let mut best = (now, at);
        for (end, stride) in [before, after].iter().flat_map(|e| STRIDES.map(|s| (e, s))) {
            let chord = (end - at) * stride;
            // Farther off is another crease.
            let near = self.tolerance.max(chord.norm()).min(most);
            let Some(place) = self.lines.closest(&(at + chord), near) else { continue };
            if bend(&place) > most {
                continue;
            }
            mesh.set_position(v, place);
            let shape = shape_of(mesh, faces.iter().copied());
            if shape.angles() < best.0.angles() && shape.is_about_as_good_as(&now) {
                best = (shape, place);
            }
        }
        mesh.set_position(v, best.1);
        if best.1 == at {
            return false;
        }
        let off = self.distance(mesh, &faces);
        if off > self.tolerance {
            mesh.set_position(v, at);
            if off > self.distance(mesh, &faces) {
                return false;
            }
            mesh.set_position(v, best.1);
        }
        true
    }

    /// How far the faces are from the surface at most.
    fn distance(&self, mesh: &QuadMesh, faces: &[Vertex]) -> f64 {
        let off = |&f: &Vertex| {
            let corners: SmallVec<[Point; 8]> =
                mesh.neighbours(f).map(|v| mesh.position(v)).collect();
            self.off(&corners)
        };
        faces.iter().map(off).fold(0.0, f64::max)
    }

    /// How far a face of these corners is from the surface at most.
    pub(super) fn off(&self, corners: &[Point]) -> f64 {
        let away = |at: Point| self.reference.closest(&at).distance;
        gauges(corners).map(away).fold(0.0, f64::max)
    }
}

/// The part of a feature line around an edge, as it is before the edge is resampled.
pub(super) struct Line {
    vertices: Vec<Vertex>,
    points: Vec<Point>,
    /// The end of the edge that comes second among the vertices.
    middle: usize,
    /// Length of the edge, in units of the file.
    edge: f64,
}

impl Line {
    /// From the edge of `h` up to [`WINDOW`] vertices on either side, but not past the end of a line.
    pub(super) fn around(mesh: &QuadMesh, h: HalfEdge) -> Self {
        let half = |h: HalfEdge, against: &[Vertex]| {
            let (mut from, mut v) = (mesh.origin(QuadMesh::opposite(h)), mesh.origin(h));
            let mut vertices = vec![v];
            while let Some(ends) = beside(mesh, v).filter(|_| vertices.len() <= WINDOW) {
                let next = if ends[0] == from { ends[1] } else { ends[0] };
                if vertices.contains(&next) || against.contains(&next) {
                    break;
                }
                vertices.push(next);
                (from, v) = (v, next);
            }
            vertices
        };
        let mut vertices = half(h, &[mesh.origin(QuadMesh::opposite(h))]);
        vertices.reverse();
        let middle = vertices.len();
        let onward = half(QuadMesh::opposite(h), &vertices);
        vertices.extend(onward);
        let points = vertices.iter().map(|&v| mesh.position(v)).collect();
        let edge =
            mesh.position(mesh.origin(h)) - mesh.position(mesh.origin(QuadMesh::opposite(h)));
        Self { vertices, points, middle, edge: edge.norm() }
    }

    /// Where the vertices go once `vertex` has come, or all but one of the ends of the edge have
    /// gone: as densely along the line as they were, with the ends of the part where they are.
    pub(super) fn slides(&self, mesh: &QuadMesh, vertex: Vertex, lines: &SharpLines) -> Vec<Slide> {
        let mut after = self.vertices.clone();
        if !after.contains(&vertex) {
            after.insert(self.middle, vertex);
        }
        after.retain(|&v| mesh.is_alive(v));
        let (last, ends) = (self.points.len() - 1, after.len() - 1);
        let at = |i: usize| {
            let place = i as f64 * last as f64 / ends as f64;
            let from = (place as usize).min(last - 1);
            let share = place - from as f64;
            let on = self.points[from] + (self.points[from + 1] - self.points[from]) * share;
            lines.closest(&on, SAGITTA * self.edge).unwrap_or(on)
        };
        let inner = (1..ends).map(|i| Slide { vertex: after[i], to: at(i).coords.into() });
        inner.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sqrtcc::lift;
    use crate::surface::{FeatureOptions, trial};
    use fixedbitset::FixedBitSet;

    #[test]
    fn vertices_near_a_crease_settle_on_it() {
        let mesh = trial::cube(8, 0.0, 0.0);
        let reference = Reference::new(&mesh).unwrap();
        let lines = SharpLines::new(&reference, &FeatureOptions::default(), 0.25);
        let rails = Rails { reference: &reference, lines: &lines, tolerance: 0.01 };
        let mut q = lift(&mesh, &FixedBitSet::with_capacity(mesh.corner_count())).unwrap();
        let at = |q: &QuadMesh, place: Point| {
            let here = |&v: &Vertex| !q.is_face(v) && (q.position(v) - place).norm() < 1e-9;
            q.vertices().find(here).unwrap()
        };
        let middle = Point::new(0.0, 1.0, 1.0);
        let [near, far] = [middle, Point::new(1.0, 0.0, 1.0)].map(|place| at(&q, place));
        q.set_position(near, Point::new(0.0, 0.95, 1.0));
        q.set_position(far, Point::new(1.0, 0.0, 0.85));
        q.commit();
        let settled = rails.settle(&mut q, 0.1);
        assert!(settled.contains(&near) && settled.iter().all(|&v| q.is_pin(v)));
        assert!((q.position(near) - middle).norm() < 1e-12);
        assert!(q.is_pin(near));
        assert_eq!(q.position(far), Point::new(1.0, 0.0, 0.85));
        assert!(!q.is_pin(far));
        let inside = at(&q, Point::new(0.0, 0.0, 1.0));
        assert!(!q.is_pin(inside));
    }
}
