//! A few faces to relax around an edit, in buffers that are used again for the next one.

use super::RelaxOptions;
use super::kernel::{Kernel, Rail, Setting, Vertex};
use crate::mesh::{NONE, Point, PolyMesh, Vector};
use crate::surface::{Hit, Reference, SharpLines};

/// How the faces of a mesh are oriented against those of its reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Orientation {
    /// Normals point to the same side.
    #[default]
    Along,
    /// Normals point to opposite sides.
    Against,
}

impl Orientation {
    /// 1 or −1.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Along => 1.0,
            Self::Against => -1.0,
        }
    }
}

/// Faces beyond which only some have a vote.
const VOTERS: usize = 20_000;

/// Decides by vote of the faces (of many, some), by area, how `mesh` is oriented. O(log n),
/// parallel.
#[must_use]
pub fn orientation(mesh: &PolyMesh, reference: &Reference) -> Orientation {
    let every = mesh.face_count().div_ceil(VOTERS).max(1);
    let voters: Vec<usize> = (0..mesh.face_count()).step_by(every).collect();
    let centres: Vec<Point> = voters.iter().map(|&f| mesh.centre(f)).collect();
    vote(mesh, reference, voters.into_iter().zip(&reference.closest_many(&centres)))
}

/// The orientation, when it is known where on the reference some faces are.
pub(super) fn vote<'h>(
    mesh: &PolyMesh,
    reference: &Reference,
    hits: impl Iterator<Item = (usize, &'h Hit)>,
) -> Orientation {
    let vote = |(f, hit): (usize, &Hit)| mesh.area_vector(f).dot(&reference.normal(hit.triangle));
    if hits.map(vote).sum::<f64>() < 0.0 { Orientation::Against } else { Orientation::Along }
}

/// Faces and vertices of a part of a mesh, with all the memory that relaxing them takes.
///
/// Fill it with [`Region::begin`], [`Region::add_vertex`] and [`Region::add_face`], then call
/// [`relax_local`], more than once if the first result is promising. Nothing is allocated once
/// the largest region has been seen.
///
/// *Precondition:* all faces of a vertex that is not held are in the region.
#[derive(Debug, Clone, Default)]
pub struct Region {
    pub(super) kernel: Kernel,
    orientation: Orientation,
    prepared: bool,
}

impl Region {
    /// An empty region.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Empties the region for a part of a mesh that is oriented as given.
    pub fn begin(&mut self, orientation: Orientation) {
        self.kernel.offsets.clear();
        self.kernel.offsets.push(0);
        self.kernel.corners.clear();
        self.kernel.vertices.clear();
        self.kernel.rails.clear();
        (self.orientation, self.prepared) = (orientation, false);
    }

    /// Adds a vertex that may move unless it is `held`; its number in the region. `near` is a
    /// triangle of the reference close by, if known; one that the vertex lies on is believed.
    pub fn add_vertex(&mut self, point: Point, held: bool, near: Option<u32>) -> u32 {
        let far = Point::from(Vector::repeat(f64::INFINITY));
        self.kernel.vertices.push(Vertex {
            point,
            based: far,
            normal: Vector::zeros(),
            last: near.unwrap_or(NONE),
            held,
        });
        self.kernel.vertices.len() as u32 - 1
    }

    /// Adds a face by numbers of vertices of the region, all of them added before.
    pub fn add_face(&mut self, corners: &[u32]) {
        debug_assert!(corners.iter().all(|&v| (v as usize) < self.kernel.vertices.len()));
        self.kernel.corners.extend_from_slice(corners);
        self.kernel.offsets.push(self.kernel.corners.len() as u32);
    }

    /// Lets a held vertex slide along a crease, between the two vertices next to it there.
    pub fn add_rail(&mut self, vertex: u32, ends: [u32; 2]) {
        self.kernel.rails.push(Rail { vertex, ends });
    }

    /// The vertices that slide, each with those next to it on its crease.
    pub fn rails(&self) -> impl Iterator<Item = (u32, [u32; 2])> + '_ {
        self.kernel.rails.iter().map(|rail| (rail.vertex, rail.ends))
    }

    /// Number of vertices.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.kernel.vertices.len()
    }

    /// Number of faces.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.kernel.face_count()
    }

    /// The vertices of face `f`, as numbers of the region.
    #[must_use]
    pub fn face(&self, f: usize) -> &[u32] {
        self.kernel.face(f)
    }

    /// Where vertex `v` is.
    #[must_use]
    pub fn point(&self, v: u32) -> Point {
        self.kernel.vertices[v as usize].point
    }

    /// Where the vertices are, in order.
    #[must_use]
    pub fn points(&self) -> impl ExactSizeIterator<Item = Point> + '_ {
        self.kernel.vertices.iter().map(|v| v.point)
    }

    /// The triangle of the reference that vertex `v` is on, after it was relaxed.
    #[must_use]
    pub fn triangle(&self, v: u32) -> u32 {
        self.kernel.vertices[v as usize].last
    }

    /// Normal of the reference at vertex `v` on the side of the mesh, after it was relaxed.
    #[must_use]
    pub fn normal(&self, v: u32) -> Vector {
        self.kernel.vertices[v as usize].normal
    }
}

/// How relaxing a region went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelaxReport {
    /// Iterations done, of all calls since the region was begun.
    pub iterations: u32,
    /// Weighted sum of squared distances of corners to where their faces want them; no unit.
    pub energy: f64,
    /// Root mean square move of the vertices in the last iteration, in edges.
    pub motion: f64,
}

/// Relaxes a region for so many iterations and leaves its free vertices on the reference.
///
/// Single-threaded. O(iterations · corners), and a closest-point query for each free vertex in
/// every [`RelaxOptions::project_every`] iterations.
pub fn relax_local(
    region: &mut Region,
    (reference, lines): (&Reference, Option<&SharpLines>),
    options: &RelaxOptions,
    iterations: u32,
) -> RelaxReport {
    let setting = Setting::new(options, region.orientation.sign(), false);
    let kernel = &mut region.kernel;
    if !region.prepared {
        kernel.prepare();
        kernel.find_normals(reference, &setting);
        region.prepared = true;
    }
    kernel.run((reference, lines), &setting, (iterations, 0.0), |_| false);
    kernel.land(reference, &setting);
    RelaxReport { iterations: kernel.iterations, energy: kernel.energy, motion: kernel.motion }
}

/// Shifts the free vertices of a region that was relaxed along their normals so that the faces lie
/// on the reference in the mean: `share` of the whole way. The next relaxing puts them back.
///
/// Single-threaded. A closest-point query for each face.
pub fn fit_local(region: &mut Region, reference: &Reference, options: &RelaxOptions, share: f64) {
    let setting = Setting::new(options, region.orientation.sign(), false);
    region.kernel.fit(reference, &setting, share);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::FeatureOptions;
    use crate::surface::trial::{cube, grid};

    const N: u32 = 8;

    fn on_rim(v: u32) -> bool {
        let (i, j) = (v / (N + 1), v % (N + 1));
        i % N == 0 || j % N == 0
    }

    fn plane() -> Reference {
        Reference::new(&grid(N)).unwrap()
    }

    /// The grid as a region with its rim held, its free vertices moved by `shift`.
    fn region(shift: impl Fn(u32) -> Vector) -> Region {
        let mesh = grid(N);
        let mut region = Region::new();
        region.begin(Orientation::Along);
        for (&p, v) in mesh.points().iter().zip(0..) {
            let held = on_rim(v);
            region.add_vertex(if held { p } else { p + shift(v) }, held, None);
        }
        mesh.faces().for_each(|f| region.add_face(f));
        region
    }

    fn jitter(v: u32) -> Vector {
        let wave = |k: f64| (f64::from(v) * k).sin() * 0.45;
        Vector::new(wave(12.9), wave(78.2), wave(37.7))
    }

    fn far_from_grid(region: &Region) -> f64 {
        let gaps = region.points().zip(grid(N).points().to_vec()).map(|(p, q)| (p - q).norm());
        gaps.fold(0.0, f64::max)
    }

    #[test]
    fn a_jittered_grid_becomes_regular_again() {
        let mut region = region(jitter);
        let before = far_from_grid(&region);
        let report = relax_local(&mut region, (&plane(), None), &RelaxOptions::default(), 150);
        assert!(before > 0.5 && far_from_grid(&region) < 0.02, "{}", far_from_grid(&region));
        assert_eq!(report.iterations, 150);
        for (p, v) in region.points().zip(0..) {
            assert!(p.z.abs() < 1e-15, "on the plane");
            assert!(!on_rim(v) || p == grid(N).points()[v as usize], "the rim is held");
        }
    }

    /// Quads on both sides of an edge of a cube; on the edge itself, vertices crowd at one end.
    #[test]
    fn vertices_on_rails_even_out_along_their_crease() {
        let reference = Reference::new(&cube(8, 0.0, 0.0)).unwrap();
        let lines = SharpLines::new(&reference, &FeatureOptions::default(), 0.25);
        let even = |i: u32| 0.15 * f64::from(i) - 0.45;
        let mut region = Region::new();
        region.begin(Orientation::Along);
        for i in 0..=6 {
            let crowded = if i % 6 == 0 { 0.0 } else { -0.02 * f64::from(i) };
            for [y, z, shift] in [[1.0, 0.85, 0.0], [1.0, 1.0, crowded], [0.85, 1.0, 0.0]] {
                region.add_vertex(Point::new(even(i) + shift, y, z), true, None);
            }
        }
        for (i, side) in (0..6).flat_map(|i| [(i, 0), (i, 1)]) {
            let first = 3 * i + side;
            region.add_face(&[first, first + 1, first + 4, first + 3]);
        }
        for i in 1..6 {
            region.add_rail(3 * i + 1, [3 * i - 2, 3 * i + 4]);
        }
        let on = (&reference, Some(&lines));
        relax_local(&mut region, on, &RelaxOptions::default(), 60);
        for i in 0..=6 {
            let place = Point::new(even(i), 1.0, 1.0);
            assert!((region.point(3 * i + 1) - place).norm() < 1e-3, "{i}");
            assert_eq!(region.point(3 * i), Point::new(even(i), 1.0, 0.85), "the others are held");
        }
    }

    #[test]
    fn turned_over_quads_are_turned_right() {
        let middle = (N / 2) * (N + 1) + N / 2;
        let mut region =
            region(|v| if v == middle { Vector::new(1.4, 1.4, 0.0) } else { Vector::zeros() });
        relax_local(&mut region, (&plane(), None), &RelaxOptions::default(), 100);
        assert!(far_from_grid(&region) < 0.02, "{}", far_from_grid(&region));
    }

    #[test]
    fn relaxing_in_two_parts_goes_on_where_it_was() {
        let mut region = region(jitter);
        let options = RelaxOptions::default();
        let first = relax_local(&mut region, (&plane(), None), &options, 10);
        let second = relax_local(&mut region, (&plane(), None), &options, 20);
        assert_eq!((first.iterations, second.iterations), (10, 30));
        assert!(second.energy < first.energy);
    }

    #[test]
    fn a_t_junction_stays_straight() {
        // Six by four quads; right of column 3 the row 1..2 is split in two.
        let mut region = Region::new();
        region.begin(Orientation::Along);
        let at = |i: u32, j: u32| i * 5 + j;
        for (i, j) in (0..7).flat_map(|i| (0..5).map(move |j| (i, j))) {
            let held = i % 6 == 0 || j % 4 == 0;
            let nudge = if held { 0.0 } else { 0.15 * f64::from(i * 3 + j * 7).sin() };
            let p = Point::new(f64::from(i) + nudge, f64::from(j) - nudge, 0.0);
            region.add_vertex(p, held, None);
        }
        let split: Vec<u32> = (3..7)
            .map(|i| region.add_vertex(Point::new(f64::from(i), 1.6, 0.0), i == 6, None))
            .collect();
        for (i, j) in (0..6).flat_map(|i| (0..4).map(move |j| (i, j))) {
            let quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            match (i, j) {
                (2, 1) => region.add_face(&[quad[0], quad[1], split[0], quad[2], quad[3]]),
                (3.., 1) => {
                    let (a, b) = (split[i as usize - 3], split[i as usize - 2]);
                    region.add_face(&[quad[0], quad[1], b, a]);
                    region.add_face(&[a, b, quad[2], quad[3]]);
                }
                _ => region.add_face(&quad),
            }
        }
        let plane = Reference::new(&grid(7)).unwrap();
        relax_local(&mut region, (&plane, None), &RelaxOptions::default(), 300);
        let [a, h, b] = [at(3, 1), split[0], at(3, 2)].map(|v| region.point(v));
        let bend = (h - a).angle(&(b - h)).to_degrees();
        assert!(bend < 8.0, "the side of the T-junction bends by {bend} degrees");
    }
}
