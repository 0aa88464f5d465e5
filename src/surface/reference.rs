//! The reference surface and its closest-point queries.

use rayon::prelude::*;
use thiserror::Error;

use super::features::{Crease, border_edges, creases};
use super::samples::{sample_places, sample_triangles};
use super::tree::{Best, CLOSEST, Tree};
use super::triangulation::{Triangulation, triangulate};
use crate::mesh::{Point, PolyMesh, Topology, Vector};

/// Queries that are answered one after the other.
const CHUNK: usize = 256;

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
    points: Vec<Point>,
    triangles: Vec<[u32; 3]>,
    face: Vec<u32>,
    normals: Vec<Vector>,
    diagonal: f64,
    area: f64,
    tree: Tree,
    creases: Vec<Crease>,
    borders: Vec<[u32; 2]>,
}

impl Reference {
    /// Triangulates `mesh`, drops triangles without area and finds its creases and borders.
    /// O(n log n).
    pub fn new(mesh: &PolyMesh) -> Result<Self, SurfaceError> {
        let mut surface = Self::plain(mesh)?;
        let topology = Topology::new(mesh);
        surface.creases = creases(mesh, &topology);
        surface.borders = border_edges(mesh, &topology);
        Ok(surface)
    }

    /// Like [`Reference::new`] without creases and borders: for distances to a mesh in work.
    pub fn plain(mesh: &PolyMesh) -> Result<Self, SurfaceError> {
        let Triangulation { points, triangles, face } = triangulate(mesh);
        let place = |t: &[u32; 3]| t.map(|v| points[v as usize]);
        let tiny = mesh.diagonal() * f64::EPSILON;
        let solid: Vec<u32> = (0..triangles.len() as u32)
            .into_par_iter()
            .filter(|&t| area_vector(&place(&triangles[t as usize])).norm() > tiny * tiny)
            .collect();
        if solid.is_empty() {
            return Err(SurfaceError::Empty { faces: mesh.face_count() });
        }
        let corners: Vec<[Point; 3]> =
            solid.par_iter().map(|&t| place(&triangles[t as usize])).collect();
        let (tree, order) = Tree::build(&corners);
        let kept = |k: &u32| solid[*k as usize] as usize;
        drop(corners);
        let areas: Vec<Vector> =
            (0..order.len() as u32).into_par_iter().map(|t| area_vector(tree.corners(t))).collect();
        Ok(Self {
            triangles: order.iter().map(|k| triangles[kept(k)]).collect(),
            face: order.iter().map(|k| face[kept(k)]).collect(),
            area: areas.iter().map(Vector::norm).sum(),
            normals: areas.into_par_iter().map(|a| a / a.norm()).collect(),
            diagonal: mesh.diagonal(),
            points,
            tree,
            creases: Vec::new(),
            borders: Vec::new(),
        })
    }

    /// Points of the surface: those of the mesh, then the centres of its larger polygons.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Triangles with an area, in the order of this surface.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The face of the original mesh that each triangle is a part of.
    #[must_use]
    pub fn faces(&self) -> &[u32] {
        &self.face
    }

    /// Unit normal of each triangle.
    #[must_use]
    pub fn normals(&self) -> &[Vector] {
        &self.normals
    }

    /// Unit normal of triangle `t`.
    #[must_use]
    pub fn normal(&self, t: u32) -> &Vector {
        &self.normals[t as usize]
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

    /// Edges between two polygons with a noticeable dihedral angle.
    #[must_use]
    pub fn creases(&self) -> &[Crease] {
        &self.creases
    }

    /// Edges with a polygon on one side only, or on more than two.
    #[must_use]
    pub fn borders(&self) -> &[[u32; 2]] {
        &self.borders
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
        (t as usize) < self.triangles.len() && self.tree.at(t, query).0 <= tolerance * tolerance
    }

    /// The closest points of many queries, in their order; neighbours should be near each other.
    /// Parallel; independent of the number of threads.
    #[must_use]
    pub fn closest_many(&self, queries: &[Point]) -> Vec<Hit> {
        let chunk = |queries: &[Point]| {
            let mut last = 0;
            let find = |q| {
                let hit = self.closest_near(q, last);
                last = hit.triangle;
                hit
            };
            queries.iter().map(find).collect::<Vec<_>>()
        };
        queries.par_chunks(CHUNK).flat_map_iter(chunk).collect()
    }

    /// Which of many queries are farther than `radius` from the surface, ascending: faster than
    /// their closest points where few are; neighbours should be near each other. Parallel.
    #[must_use]
    pub fn farther_than(&self, queries: &[Point], radius: f64) -> Vec<u32> {
        let chunk = |(k, queries): (usize, &[Point])| {
            let (mut last, mut far) = (0, Vec::new());
            for (query, i) in queries.iter().zip((k * CHUNK) as u32..) {
                if self.is_on(query, last, radius) {
                    continue;
                }
                match self.tree.near(query, radius) {
                    Some(triangle) => last = triangle,
                    None => far.push(i),
                }
            }
            far
        };
        queries.par_chunks(CHUNK).enumerate().flat_map_iter(chunk).collect()
    }

    /// About evenly spread points of the surface, `count` of them, always the same.
    #[must_use]
    pub fn samples(&self, count: usize) -> Vec<Point> {
        sample_triangles(&self.points, &self.triangles, count)
    }

    /// The same points, each with the triangle that it is on.
    #[must_use]
    pub fn sample_places(&self, count: usize) -> Vec<(u32, Point)> {
        sample_places(&self.points, &self.triangles, count)
    }

    fn start(&self, query: &Point, last: u32) -> Best {
        let triangle = last.min(self.triangles.len() as u32 - 1);
        let (squared, point) = self.tree.at(triangle, query);
        Best { squared, triangle, point }
    }
}

/// Half the cross product of two sides: the length is the area.
fn area_vector([a, b, c]: &[Point; 3]) -> Vector {
    (b - a).cross(&(c - a)) * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::tree::closest_on_triangle;
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
