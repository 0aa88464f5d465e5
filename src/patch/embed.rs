//! Where the new vertices of a filling go: Tutte transport.
//!
//! The old patch and the filling are both embedded in the unit disk with the same rim (Tutte
//! 1963: each inner vertex at the mean of its neighbours); each new vertex takes the place that
//! the old patch has under it. The start is then fold-free in the disk and follows the surface.

use super::{Filling, Region};
use crate::mesh::{Point, Vector};
use crate::sqrtcc::{QuadMesh, Vertex};
use nalgebra::{Point2, Vector2};
use rustc_hash::FxHashMap;
use smallvec::SmallVec;
use std::f64::consts::TAU;

type Plane = Point2<f64>;

/// Places for the new vertices of `filling` on the surface of the old patch. `mesh` is as it was
/// before the patch is replaced. O(√n) sweeps over n vertices, and O(1) for each lookup if the old
/// vertices lie evenly in the disk.
#[must_use]
pub fn transport(mesh: &QuadMesh, region: &Region, filling: &Filling) -> Vec<Point> {
    OldPatch::new(mesh, region).transport(filling)
}

/// The rim on the unit circle, by length.
fn on_circle(rim: &[Point]) -> Vec<Plane> {
    let lengths: Vec<f64> =
        (0..rim.len()).map(|i| (rim[(i + 1) % rim.len()] - rim[i]).norm()).collect();
    let total: f64 = lengths.iter().sum();
    let mut at = 0.0;
    lengths
        .iter()
        .map(|&l| {
            let angle = if total > 0.0 { TAU * at / total } else { 0.0 };
            at += l;
            Plane::new(angle.cos(), angle.sin())
        })
        .collect()
}

/// Embeds `inner` vertices numbered after the rim; `neighbours[i]` are those of inner vertex i.
fn tutte(rim: &[Plane], inner: usize, neighbours: &Neighbours) -> Vec<Plane> {
    const RELAXATION: f64 = 1.6;
    let mut at = rim.to_vec();
    at.resize(rim.len() + inner, Plane::origin());
    let most = 40 + 12 * (inner as f64).sqrt() as usize;
    for _ in 0..most {
        let mut largest: f64 = 0.0;
        for (i, near) in neighbours.lists().enumerate() {
            let sum: Vector2<f64> = near.iter().map(|&j| at[j as usize].coords).sum();
            let mean = sum / near.len().max(1) as f64;
            let by = (mean - at[rim.len() + i].coords) * RELAXATION;
            at[rim.len() + i] += by;
            largest = largest.max(by.norm_squared());
        }
        if largest < 1e-10 {
            break;
        }
    }
    at
}

/// The neighbours of each inner vertex, one list after the other.
struct Neighbours {
    /// Where each list begins; one entry more than there are lists.
    first: Vec<u32>,
    listed: Vec<u32>,
}

impl Neighbours {
    fn of_filling(filling: &Filling) -> Self {
        let inner = |&v: &u32| v.checked_sub(filling.rim).map(|i| i as usize);
        let mut first = vec![0; filling.interior as usize + 1];
        for i in filling.corners.iter().filter_map(inner) {
            first[i + 1] += 1;
        }
        for i in 1..first.len() {
            first[i] += first[i - 1];
        }
        let (mut next, mut listed) = (first.clone(), vec![0; first[first.len() - 1] as usize]);
        for face in filling.faces() {
            for (k, v) in face.iter().enumerate() {
                if let Some(i) = inner(v) {
                    listed[next[i] as usize] = face[(k + 1) % face.len()];
                    next[i] += 1;
                }
            }
        }
        Self { first, listed }
    }

    fn lists(&self) -> impl Iterator<Item = &[u32]> {
        self.first.windows(2).map(|w| &self.listed[w[0] as usize..w[1] as usize])
    }
}

/// The old patch in the disk, cut into triangles around the middle of each face.
#[derive(Debug)]
pub struct OldPatch {
    /// The rim, which is that of every filling too.
    circle: Vec<Plane>,
    triangles: Vec<Triangle>,
    /// Cells along each side of the square around the disk.
    cells: usize,
    /// Triangles by cell, in order; cell `c` has those from `first[c]` to `first[c + 1]`.
    first: Vec<u32>,
    listed: Vec<u32>,
}

/// A triangle in the disk and on the surface.
type Triangle = ([Plane; 3], [Point; 3]);

impl OldPatch {
    /// Embeds `region` of a mesh that is as it was before anything is replaced.
    #[must_use]
    pub fn new(mesh: &QuadMesh, region: &Region) -> Self {
        let rim: Vec<Vertex> = region.rim.iter().map(|&h| mesh.target(h)).collect();
        let circle = on_circle(&rim.iter().map(|&v| mesh.position(v)).collect::<Vec<_>>());
        let all = rim.iter().chain(&region.interior);
        let number: FxHashMap<Vertex, u32> = all.zip(0..).map(|(&v, i)| (v, i)).collect();
        let mut neighbours = Neighbours { first: vec![0], listed: Vec::new() };
        for &v in &region.interior {
            neighbours.listed.extend(mesh.diagonals(v).filter_map(|w| number.get(&w)));
            neighbours.first.push(neighbours.listed.len() as u32);
        }
        let at = tutte(&circle, region.interior.len(), &neighbours);
        let mut triangles = Vec::with_capacity(4 * region.faces.len());
        for &f in &region.faces {
            let corners: SmallVec<[(Plane, Point); 8]> = mesh
                .neighbours(f)
                .filter_map(|v| number.get(&v).map(|&i| (at[i as usize], mesh.position(v))))
                .collect();
            let n = corners.len() as f64;
            let flat = Plane::from(corners.iter().map(|c| c.0.coords).sum::<Vector2<f64>>() / n);
            let solid = Point::from(corners.iter().map(|c| c.1.coords).sum::<Vector>() / n);
            for (i, a) in corners.iter().enumerate() {
                let b = &corners[(i + 1) % corners.len()];
                triangles.push(([flat, a.0, b.0], [solid, a.1, b.1]));
            }
        }
        let (first, listed) = (Vec::new(), Vec::new());
        let mut patch = Self { circle, triangles, cells: 1, first, listed };
        patch.sort_into_cells();
        patch
    }

    /// Places for the new vertices of `filling`, see [`transport`].
    #[must_use]
    pub fn transport(&self, filling: &Filling) -> Vec<Point> {
        let neighbours = Neighbours::of_filling(filling);
        let new = tutte(&self.circle, filling.interior as usize, &neighbours);
        new[self.circle.len()..].iter().map(|&p| self.lift(p)).collect()
    }

    /// Lists the triangles whose box meets each cell.
    fn sort_into_cells(&mut self) {
        self.cells = (self.triangles.len() as f64).sqrt().ceil().max(1.0) as usize;
        let cells = self.cells;
        let covered = |(flat, _): &Triangle| {
            let (low, high) =
                (flat[0].inf(&flat[1]).inf(&flat[2]), flat[0].sup(&flat[1]).sup(&flat[2]));
            let ([x0, y0], [x1, y1]) = (self.cell(low), self.cell(high));
            (y0..=y1).flat_map(move |y| (x0..=x1).map(move |x| y * cells + x))
        };
        let mut first = vec![0; cells * cells + 1];
        for c in self.triangles.iter().flat_map(covered) {
            first[c + 1] += 1;
        }
        for c in 0..cells * cells {
            first[c + 1] += first[c];
        }
        let mut listed = vec![0; first[cells * cells] as usize];
        let mut next = first.clone();
        for (triangle, i) in self.triangles.iter().zip(0..) {
            for c in covered(triangle) {
                listed[next[c] as usize] = i;
                next[c] += 1;
            }
        }
        (self.first, self.listed) = (first, listed);
    }

    /// Column and row of the cell at `p`.
    fn cell(&self, p: Plane) -> [usize; 2] {
        let last = self.cells - 1;
        [p.x, p.y].map(|x| ((0.5 * (x + 1.0) * self.cells as f64).max(0.0) as usize).min(last))
    }

    /// The point of the patch over `p`: in the first triangle that contains it, or else in that
    /// which nearly does.
    fn lift(&self, p: Plane) -> Point {
        let [x, y] = self.cell(p);
        let c = y * self.cells + x;
        let near = &self.listed[self.first[c] as usize..self.first[c + 1] as usize];
        let near = near.iter().map(|&i| &self.triangles[i as usize]);
        let (inside, point) = lift_among(near, p);
        if inside >= 0.0 { point } else { lift_among(self.triangles.iter(), p).1 }
    }
}

/// How far inside (negative: outside) `p` is in the first of the triangles that contains it, or in
/// the one that comes nearest to that, and the point on the surface.
fn lift_among<'a>(triangles: impl Iterator<Item = &'a Triangle>, p: Plane) -> (f64, Point) {
    let mut best = (f64::NEG_INFINITY, Point::origin());
    for (flat, solid) in triangles {
        let weights = barycentric(flat, p);
        let inside = weights.iter().copied().fold(f64::INFINITY, f64::min);
        if inside > best.0 {
            let w = weights.map(|w| w.clamp(0.0, 1.0));
            let sum: f64 = w.iter().sum();
            let at: Vector = (0..3).map(|i| solid[i].coords * (w[i] / sum)).sum();
            best = (inside, Point::from(at));
            if inside >= 0.0 {
                break;
            }
        }
    }
    best
}

fn barycentric([a, b, c]: &[Plane; 3], p: Plane) -> [f64; 3] {
    let cross = |u: Vector2<f64>, v: Vector2<f64>| u.x * v.y - u.y * v.x;
    let area = cross(b - a, c - a);
    if area.abs() < 1e-300 {
        return [f64::NEG_INFINITY; 3];
    }
    let (wb, wc) = (cross(p - a, c - a) / area, cross(b - a, p - a) / area);
    [1.0 - wb - wc, wb, wc]
}
