//! The reference surface and its closest-point queries.

use fixedbitset::FixedBitSet;
use rayon::prelude::*;
use thiserror::Error;

use super::features::{Crease, creases};
use super::samples::{place_in_triangle, sampled};
use super::tree::{Best, CLOSEST, Tree};
use super::triangulation::{Triangulation, triangulate};
use crate::mesh::{NONE, Point, PolyMesh, Topology, Vector};

/// Queries that are answered one after the other.
const CHUNK: usize = 256;
/// Queries whose answers are in memory at the same time.
const BLOCK: usize = 256 * CHUNK;

/// Why a mesh is no reference surface.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum SurfaceError {
    /// The mesh has no triangle with an area.
    #[error("the reference surface has no face with an area (of {faces} faces)")]
    Empty {
        /// How many faces it has.
        faces: usize,
    },
}

/// The closest point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// The triangle it is on.
    pub triangle: u32,
    /// Where it is.
    pub point: Point,
    /// How far it is from the query, in the units of the file.
    pub distance: f64,
}

/// A triangle surface with exact closest-point queries.
///
/// *Invariant:* every triangle has an area. Triangles are stored in a spatially coherent order of
/// their own; queries are deterministic (the smallest triangle number wins a tie).
#[derive(Debug, Clone)]
pub struct Reference {
    /// Face of the mesh of each triangle.
    face: Vec<u32>,
    /// Number of each triangle in the triangulation of the mesh.
    source: Vec<u32>,
    /// Unit normals, unless the surface is that of a mesh in work, which is hardly asked for any.
    normals: Vec<Vector>,
    diagonal: f64,
    area: f64,
    tree: Tree,
    creases: Vec<Crease>,
}

impl Reference {
    /// Triangulates `mesh`, drops triangles without area and finds its creases. O(n log n).
    pub fn new(mesh: &PolyMesh) -> Result<Self, SurfaceError> {
        let creases = || creases(mesh, &Topology::new(mesh));
        let (surface, creases) = rayon::join(|| Self::plain(mesh), creases);
        Ok(surface?.creased(creases))
    }

    /// [`Self::new`], where the connectivity of the mesh is known.
    pub(crate) fn connected(mesh: &PolyMesh, topology: &Topology) -> Result<Self, SurfaceError> {
        Ok(Self::plain(mesh)?.creased(creases(mesh, topology)))
    }

    /// The surface with normals and these creases between vertices of the mesh.
    fn creased(self, mut creases: Vec<Crease>) -> Self {
        let mut surface = self;
        for Crease { a, b, .. } in &mut creases {
            [*a, *b] = [*a, *b].map(|v| surface.tree.places()[v as usize]);
        }
        let numbers = (0..surface.source.len() as u32).into_par_iter();
        surface.normals = numbers.map(|t| surface.normal(t)).collect();
        Self { creases, ..surface }
    }

    /// Like [`Reference::new`] without creases and kept normals: for distances to a mesh in work.
    /// O(n log n), parallel.
    pub fn plain(mesh: &PolyMesh) -> Result<Self, SurfaceError> {
        let Triangulation { points, triangles, face } = triangulate(mesh);
        let is_solid = solid(&points, mesh);
        let numbers = (0..triangles.len() as u32).into_par_iter();
        let solid: Vec<u32> = numbers.filter(|&t| is_solid(&triangles[t as usize])).collect();
        if solid.is_empty() {
            return Err(SurfaceError::Empty { faces: mesh.face_count() });
        }
        drop(is_solid);
        let corners = |k: u32| triangles[solid[k as usize] as usize];
        let (tree, order) = Tree::build(&points, solid.len(), corners);
        let source: Vec<u32> = order.into_iter().map(|k| solid[k as usize]).collect();
        let mut surface = Self {
            face: source.par_iter().map(|&t| face[t as usize]).collect(),
            source,
            normals: Vec::new(),
            area: 0.0,
            diagonal: mesh.diagonal(),
            tree,
            creases: Vec::new(),
        };
        surface.area = surface.areas().iter().sum();
        Ok(surface)
    }

    /// The surface of `mesh`, whose faces are those of this surface in other places, with triangles
    /// of the same numbers; none if a triangle has got or lost an area. O(n), parallel.
    #[must_use]
    pub fn moved(mut self, mesh: &PolyMesh) -> Option<Self> {
        let Triangulation { points, triangles, .. } = triangulate(mesh);
        let is_solid = solid(&points, mesh);
        let count = triangles.par_iter().filter(|t| is_solid(t)).count();
        let stays = |&s: &u32| triangles.get(s as usize).is_some_and(&is_solid);
        if count != self.source.len() || !self.source.par_iter().all(stays) {
            return None;
        }
        drop(is_solid);
        let source = &self.source;
        self.tree.follow(&points, |k| triangles[source[k as usize] as usize]);
        self.normals = Vec::new();
        self.diagonal = mesh.diagonal();
        self.area = self.areas().iter().sum();
        Some(self)
    }

    /// The area of each triangle as it is. Parallel.
    fn areas(&self) -> Vec<f64> {
        let numbers = (0..self.source.len() as u32).into_par_iter();
        numbers.map(|t| self.area_vector(t).norm()).collect()
    }

    /// Points of the surface, those of the mesh and the centres of its larger polygons: first those
    /// that triangles use, in the order of these.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        self.tree.points()
    }

    /// The vertices of the mesh, `count` of them, in the order of [`Self::points`]. O(n).
    pub(crate) fn vertices_in_order(&self, count: usize) -> Vec<u32> {
        let mut vertices = vec![NONE; self.points().len()];
        for (v, &place) in self.tree.places().iter().enumerate().take(count) {
            vertices[place as usize] = v as u32;
        }
        vertices.retain(|&v| v != NONE);
        vertices
    }

    /// The faces of the mesh, `count` of them, in the order of their triangles, then those without.
    /// O(n).
    pub(crate) fn faces_in_order(&self, count: usize) -> Vec<u32> {
        let mut seen = FixedBitSet::with_capacity(count);
        let all = self.faces().iter().copied().chain(0..count as u32);
        all.filter(|&f| !seen.put(f as usize)).collect()
    }

    /// Triangles with an area, in the order of this surface.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        self.tree.triangles()
    }

    /// The face of the original mesh that each triangle is a part of.
    #[must_use]
    pub fn faces(&self) -> &[u32] {
        &self.face
    }

    /// Unit normal of triangle `t`.
    #[must_use]
    pub fn normal(&self, t: u32) -> Vector {
        self.normals.get(t as usize).copied().unwrap_or_else(|| {
            let along = self.area_vector(t);
            along / along.norm()
        })
    }

    /// Normal of triangle `t` that is as long as its area.
    fn area_vector(&self, t: u32) -> Vector {
        area_vector(&self.tree.corners(t))
    }

    /// Bounding-box diagonal of the used vertices, in the units of the file.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        self.diagonal
    }

    /// Sum of the areas of the triangles, in squared units of the file.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.area
    }

    /// Edges between two polygons with a noticeable dihedral angle, between [points](Self::points).
    #[must_use]
    pub fn creases(&self) -> &[Crease] {
        &self.creases
    }

    /// The closest point of the surface. O(log n) expected.
    #[must_use]
    pub fn closest(&self, query: &Point) -> Hit {
        self.closest_near(query, 0)
    }

    /// The same as [`Reference::closest`], faster if triangle `last` is near the answer.
    #[must_use]
    pub fn closest_near(&self, query: &Point, last: u32) -> Hit {
        let best = self.tree.search(query, self.start(query, last), |_| true, CLOSEST);
        Hit { triangle: best.triangle, point: best.point, distance: best.squared.sqrt() }
    }

    /// The closest point of the triangles that face like `normal`, if there is one within
    /// `reach`; otherwise the plain closest point.
    ///
    /// On a thin sheet the other side may be closer than the own one; a projection must not hop
    /// there. `last` only speeds the search up.
    #[must_use]
    pub fn closest_facing(&self, query: &Point, normal: &Vector, last: u32, reach: f64) -> Hit {
        let faces = |t: u32| self.normal(t).dot(normal) >= 0.0;
        let start = self.start(query, last);
        let start = if start.squared <= reach * reach && faces(start.triangle) {
            start
        } else {
            Best::within(reach)
        };
        self.tree
            .search(query, start, faces, CLOSEST)
            .hit()
            .unwrap_or_else(|| self.closest_near(query, last))
    }

    /// Whether some point of the surface is at most `radius` away. O(log n) expected.
    #[must_use]
    pub fn is_within(&self, query: &Point, radius: f64) -> bool {
        self.tree.is_within(query, radius)
    }

    /// Whether a point is at most `tolerance` away from triangle `t`; false if there is none such.
    #[must_use]
    pub fn is_on(&self, query: &Point, t: u32, tolerance: f64) -> bool {
        (t as usize) < self.triangles().len() && self.tree.at(t, query).0 <= tolerance * tolerance
    }

    /// The closest points of many queries, in their order; neighbours should be near each other.
    /// Parallel; independent of the number of threads.
    #[must_use]
    pub fn closest_many(&self, queries: &[Point]) -> Vec<Hit> {
        let mut hits = Vec::with_capacity(queries.len());
        self.closest_each(queries, &mut Vec::new(), |_, hit| hits.push(*hit));
        hits
    }

    /// Hands on the closest point of each of many queries, in their order, with its number.
    ///
    /// `near` has a triangle near the answer to each, or is shorter than they are or [`NONE`] where
    /// none is known, and is brought up to date: where these are the answers to all but the same
    /// queries it is twice as fast. Parallel, in blocks: there are never many answers in memory.
    pub fn closest_each(
        &self,
        queries: &[Point],
        near: &mut Vec<u32>,
        mut each: impl FnMut(usize, &Hit),
    ) {
        near.resize(queries.len(), NONE);
        let nowhere = Hit { triangle: 0, point: Point::origin(), distance: 0.0 };
        let mut hits = vec![nowhere; BLOCK.min(queries.len())];
        let blocks = queries.chunks(BLOCK).zip(near.chunks_mut(BLOCK));
        for (k, (queries, near)) in blocks.enumerate() {
            let chunks = queries.par_chunks(CHUNK).zip(near.par_chunks_mut(CHUNK));
            hits.par_chunks_mut(CHUNK).zip(chunks).for_each(|(hits, (queries, near))| {
                let mut last = 0;
                for (hit, (query, near)) in hits.iter_mut().zip(queries.iter().zip(near)) {
                    *hit = self.closest_near(query, if *near == NONE { last } else { *near });
                    last = hit.triangle;
                    *near = last;
                }
            });
            for (i, hit) in hits[..queries.len()].iter().enumerate() {
                each(k * BLOCK + i, hit);
            }
        }
    }

    /// Which of many queries are farther than `radius` from the surface, ascending: faster than
    /// their closest points where few are. `near` says for each a triangle that may be near enough,
    /// or [`NONE`], and is brought up to date. Parallel.
    #[must_use]
    pub fn farther_than(&self, queries: &[Point], radius: f64, near: &mut [u32]) -> Vec<u32> {
        let chunk = |(k, (queries, near)): (usize, (&[Point], &mut [u32]))| {
            let (mut last, mut far) = (NONE, Vec::new());
            for ((query, near), i) in queries.iter().zip(near).zip((k * CHUNK) as u32..) {
                let found = [*near, last].into_iter().find(|&t| self.is_on(query, t, radius));
                *near = found.or_else(|| self.tree.near(query, radius)).unwrap_or(NONE);
                if *near == NONE {
                    far.push(i);
                } else {
                    last = *near;
                }
            }
            far
        };
        let chunks = queries.par_chunks(CHUNK).zip(near.par_chunks_mut(CHUNK));
        chunks.enumerate().flat_map_iter(chunk).collect()
    }

    /// The points that triangles use, in the order of these: neighbours are near each other.
    /// O(triangles).
    #[must_use]
    pub fn used_points(&self) -> &[Point] {
        let last = self.triangles().par_iter().flatten().max();
        &self.points()[..last.map_or(0, |&v| v as usize + 1)]
    }

    /// About evenly spread points of the surface, `count` of them, always the same.
    #[must_use]
    pub fn samples(&self, count: usize) -> Vec<Point> {
        self.samples_on(&self.sampled(count))
    }

    /// The triangle that each of those points is on.
    #[must_use]
    pub fn sampled(&self, count: usize) -> Vec<u32> {
        sampled(&self.areas(), count)
    }

    /// Where the samples on the triangles `sampled` are now: [`Self::samples`], as long as nothing
    /// has [moved](Self::moved). Parallel.
    #[must_use]
    pub fn samples_on(&self, sampled: &[u32]) -> Vec<Point> {
        let place = |(i, &t)| place_in_triangle(i, &self.tree.corners(t));
        sampled.par_iter().enumerate().map(place).collect()
    }

    fn start(&self, query: &Point, last: u32) -> Best {
        let triangle = last.min(self.triangles().len() as u32 - 1);
        let (squared, point) = self.tree.at(triangle, query);
        Best { squared, triangle, point }
    }
}

/// Says of a triangle of these points of `mesh` whether it has an area.
fn solid(points: &[Point], mesh: &PolyMesh) -> impl Fn(&[u32; 3]) -> bool + Sync {
    let tiny = mesh.diagonal() * f64::EPSILON;
    move |t| area_vector(&t.map(|v| points[v as usize])).norm() > tiny * tiny
}

/// Half the cross product of two sides: the length is the area.
fn area_vector([a, b, c]: &[Point; 3]) -> Vector {
    (b - a).cross(&(c - a)) * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::tree::closest_on_triangle;
    use crate::surface::trial::cube;
    use proptest::prelude::*;

    fn soup() -> impl Strategy<Value = Vec<[[f64; 3]; 3]>> {
        let corner = || prop::array::uniform3(-1.0..1.0f64);
        prop::collection::vec(prop::array::uniform3(corner()), 1..60)
    }

    fn mesh_of(triangles: &[[[f64; 3]; 3]]) -> PolyMesh {
        let points = triangles.iter().flatten().map(|&p| Point::from(p)).collect();
        let faces = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
        PolyMesh::new(points, faces).unwrap()
    }

    proptest! {
        #[test]
        fn closest_is_what_brute_force_finds(
            triangles in soup(), query in prop::array::uniform3(-2.0..2.0f64), last in 0u32..60,
        ) {
            let surface = Reference::new(&mesh_of(&triangles)).unwrap();
            let query = Point::from(query);
            let brute = surface.triangles().iter().map(|t| {
                let corners = t.map(|v| surface.points()[v as usize]);
                (closest_on_triangle(&query, &corners) - query).norm()
            }).fold(f64::INFINITY, f64::min);
            let hit = surface.closest(&query);
            prop_assert!((hit.distance - brute).abs() <= 1e-15);
            prop_assert_eq!(hit, surface.closest_near(&query, last));
            prop_assert!(((hit.point - query).norm() - hit.distance).abs() < 1e-14);
        }
    }

    #[test]
    fn a_surface_that_has_moved_answers_like_a_new_one() {
        let (mut mesh, queries) = (cube(12, 0.5, 0.0), cube(9, 1.0, 0.1));
        let still = Reference::plain(&mesh).unwrap();
        let swell = |p: &Point| Point::from(p.coords * (1.0 + 0.3 * (5.0 * p.x).sin()));
        mesh.set_points(mesh.points().iter().map(swell).collect());
        let (moved, new) = (still.clone().moved(&mesh).unwrap(), Reference::plain(&mesh).unwrap());
        assert_eq!(moved.faces(), still.faces(), "triangles keep their numbers");
        for query in queries.points() {
            let (a, b) = (moved.closest(query), new.closest(query));
            assert!((a.distance - b.distance).abs() < 1e-14, "{a:?} {b:?}");
        }
        assert!((moved.area() - new.area()).abs() < 1e-12);
        let samples = moved.samples_on(&still.sampled(500));
        assert!(samples.iter().all(|p| new.closest(p).distance < 1e-14), "samples go along");
        // A face that has lost its area has no triangles.
        let mut points = mesh.points().to_vec();
        let [a, b, c] = [0, 1, 2].map(|k| mesh.face(0)[k] as usize);
        (points[b], points[c]) = (points[a], points[a]);
        mesh.set_points(points);
        assert!(moved.moved(&mesh).is_none());
    }

    #[test]
    fn points_are_stored_as_triangles_use_them() {
        let ball = crate::mesh::shapes::sphere(6);
        let faces = ball.faces().map(|face| face.iter().map(|v| v + 1).collect::<Vec<u32>>());
        let unused = std::iter::once(Point::origin());
        let points = unused.chain(ball.points().iter().copied()).collect();
        let mesh = PolyMesh::new(points, faces).unwrap();
        let surface = Reference::plain(&mesh).unwrap();
        let mut seen = 0;
        for &v in surface.triangles().as_flattened() {
            assert!(v <= seen, "no point is left out");
            seen = seen.max(v + 1);
        }
        assert_eq!(surface.used_points(), &surface.points()[..mesh.vertex_count() - 1]);
        let vertices = surface.vertices_in_order(mesh.vertex_count());
        assert_eq!(vertices.last(), Some(&0), "no triangle uses this one");
        let in_order = vertices.iter().map(|&v| mesh.points()[v as usize]);
        assert!(in_order.eq(surface.points().iter().copied()));
        let mut faces = surface.faces_in_order(mesh.face_count());
        assert!(surface.faces()[..2].contains(&faces[0]));
        faces.sort_unstable();
        assert!(faces.into_iter().eq(0..mesh.face_count() as u32), "each of them once");
    }

    #[test]
    fn what_was_nearest_last_time_only_speeds_queries_up() {
        let (surface, queries) =
            (Reference::plain(&cube(12, 0.5, 0.0)).unwrap(), cube(70, 1.0, 0.1));
        let hits = surface.closest_many(queries.points());
        assert!(hits.len() > BLOCK / 4, "more than a chunk");
        let mut near: Vec<u32> = (0..100).chain([NONE, u32::MAX - 1]).collect();
        for _ in 0..2 {
            let mut again = Vec::new();
            surface.closest_each(queries.points(), &mut near, |i, hit| again.push((i, *hit)));
            assert!(again.iter().map(|a| a.0).eq(0..hits.len()));
            assert!(again.iter().map(|a| a.1).eq(hits.iter().copied()));
            assert!(near.iter().copied().eq(hits.iter().map(|hit| hit.triangle)));
        }
    }

    #[test]
    fn places_that_are_covered_need_no_search() {
        let surface = Reference::plain(&cube(12, 0.5, 0.0)).unwrap();
        let queries = cube(20, 0.6, 0.0);
        let far = |q: &Point, radius: f64| surface.closest(q).distance > radius;
        let mut near = vec![NONE; queries.vertex_count()];
        for radius in [0.1, 0.05, 0.01, 0.05] {
            let found = surface.farther_than(queries.points(), radius, &mut near);
            let numbers = 0..queries.vertex_count() as u32;
            let wanted = numbers.filter(|&i| far(&queries.points()[i as usize], radius));
            assert!(found.iter().copied().eq(wanted), "at {radius}");
        }
    }

    /// Two parallel unit squares 0.02 apart with normals that point away from each other.
    fn thin_sheet() -> Reference {
        let square = |z: f64| [[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
        let points = square(0.0).into_iter().chain(square(0.02)).map(Point::from).collect();
        Reference::new(&PolyMesh::new(points, [[3, 2, 1, 0], [4, 5, 6, 7]]).unwrap()).unwrap()
    }

    #[test]
    fn projection_stays_on_its_side_of_a_thin_sheet() {
        let sheet = thin_sheet();
        let query = Point::new(0.3, 0.3, 0.004);
        assert!(sheet.closest(&query).point.z.abs() < 1e-15);
        let up = Vector::z();
        let near = sheet.closest_facing(&query, &up, 0, 0.1);
        assert!((near.point.z - 0.02).abs() < 1e-15, "the upper side faces up");
        let short = sheet.closest_facing(&query, &up, 0, 0.001);
        assert!(short.point.z.abs() < 1e-15, "out of reach: the plain closest point");
    }

    #[test]
    fn flat_and_collinear_triangles_are_dropped() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let points: Vec<Point> = points.into_iter().map(Point::from).collect();
        let line = PolyMesh::new(points.clone(), [[0, 1, 2]]).unwrap();
        assert_eq!(Reference::new(&line).unwrap_err(), SurfaceError::Empty { faces: 1 });
        let both = Reference::new(&PolyMesh::new(points, [[0, 1, 2], [0, 1, 3]]).unwrap()).unwrap();
        assert_eq!((both.triangles().len(), both.area(), both.faces()), (1, 0.5, &[1u32][..]));
    }
}
