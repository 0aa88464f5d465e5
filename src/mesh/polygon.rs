//! The polygon mesh in compressed rows: one array of corners, one of face offsets.
//!
//! *Invariant:* every corner names an existing point, every coordinate is finite.

use thiserror::Error;

/// A point in space, in the units of the input file.
pub type Point = nalgebra::Point3<f64>;
/// A displacement or direction in space.
pub type Vector = nalgebra::Vector3<f64>;

/// Why a list of faces is no mesh.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum MeshError {
    /// A face names a point that does not exist.
    #[error("face {face} names vertex {vertex}, but there are only {vertices} vertices")]
    IndexOutOfRange {
        /// Number of the face, from 0.
        face: usize,
        /// The vertex it names, from 0.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not a finite number")]
    NotFinite {
        /// Number of the vertex, from 0.
        vertex: usize,
    },
    /// More corners or vertices than 31-bit ids can name.
    #[error("{count} {what} are more than this program can number (2^31 - 1)")]
    TooLarge {
        /// What there is too much of.
        what: &'static str,
        /// How many there are.
        count: usize,
    },
}

/// A polygon mesh: points, and faces as cycles of point numbers.
///
/// The storage accepts any soup of polygons (non-manifold, degenerate, of any degree); what is
/// required of a mesh that is to be edited is checked where it is lifted.
#[derive(Debug, Clone, PartialEq)]
pub struct PolyMesh {
    points: Vec<Point>,
    offsets: Vec<u32>,
    corners: Vec<u32>,
    groups: Vec<u32>,
    group_names: Vec<String>,
}

impl Default for PolyMesh {
    /// Nothing.
    fn default() -> Self {
        Self {
            points: Vec::new(),
            offsets: vec![0],
            corners: Vec::new(),
            groups: Vec::new(),
            group_names: vec![String::new()],
        }
    }
}

impl PolyMesh {
    /// Builds a mesh from points and the corners of each face. O(points + corners).
    pub fn new<F: AsRef<[u32]>>(
        points: Vec<Point>,
        faces: impl IntoIterator<Item = F>,
    ) -> Result<Self, MeshError> {
        let mut offsets = vec![0];
        let mut corners = Vec::new();
        for face in faces {
            corners.extend_from_slice(face.as_ref());
            offsets.push(corners.len() as u32);
        }
        Self::from_rows(points, offsets, corners)
    }

    /// Builds a mesh from compressed rows: face `f` has `corners[offsets[f]..offsets[f + 1]]`.
    pub fn from_rows(
        points: Vec<Point>,
        offsets: Vec<u32>,
        corners: Vec<u32>,
    ) -> Result<Self, MeshError> {
        for (what, count) in [("vertices", points.len()), ("corners", corners.len())] {
            if count >= i32::MAX as usize {
                return Err(MeshError::TooLarge { what, count });
            }
        }
        if let Some(vertex) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(MeshError::NotFinite { vertex });
        }
        if let Some(at) = corners.iter().position(|&v| v as usize >= points.len()) {
            return Err(MeshError::IndexOutOfRange {
                face: offsets.partition_point(|&o| o as usize <= at) - 1,
                vertex: corners[at],
                vertices: points.len(),
            });
        }
        let groups = vec![0; offsets.len() - 1];
        Ok(Self { points, offsets, corners, groups, group_names: vec![String::new()] })
    }

    /// Names the group of each face: `groups[f]` is an index into `names`.
    ///
    /// # Panics
    /// If the lengths do not fit the mesh: that is a bug of the caller, not of the input.
    #[must_use]
    pub fn with_groups(mut self, groups: Vec<u32>, names: Vec<String>) -> Self {
        assert_eq!(groups.len(), self.face_count(), "one group for each face");
        assert!(groups.iter().all(|&g| (g as usize) < names.len()), "each group has a name");
        self.groups = groups;
        self.group_names = names;
        self
    }

    /// Number of vertices, used or not.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.points.len()
    }

    /// Number of faces.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Number of corners, which is the number of half-edges.
    #[must_use]
    pub fn corner_count(&self) -> usize {
        self.corners.len()
    }

    /// All points, by vertex number.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// The same mesh with its points moved.
    ///
    /// # Panics
    /// If the number of points changes.
    pub fn set_points(&mut self, points: Vec<Point>) {
        assert_eq!(points.len(), self.points.len(), "one point for each vertex");
        self.points = points;
    }

    /// All corners, face by face: the vertex at each.
    #[must_use]
    pub fn corners(&self) -> &[u32] {
        &self.corners
    }

    /// Where the corners of each face begin; one entry more than there are faces.
    #[must_use]
    pub fn offsets(&self) -> &[u32] {
        &self.offsets
    }

    /// The vertices of face `f`, in order.
    #[must_use]
    pub fn face(&self, f: usize) -> &[u32] {
        &self.corners[self.offsets[f] as usize..self.offsets[f + 1] as usize]
    }

    /// The faces in order, each as its vertices.
    #[must_use]
    pub fn faces(&self) -> impl ExactSizeIterator<Item = &[u32]> + '_ {
        (0..self.face_count()).map(|f| self.face(f))
    }

    /// Group number of each face.
    #[must_use]
    pub fn groups(&self) -> &[u32] {
        &self.groups
    }

    /// Names of the groups; the empty name is "no group".
    #[must_use]
    pub fn group_names(&self) -> &[String] {
        &self.group_names
    }

    /// Smallest and largest coordinates of the vertices that faces use; `None` without faces.
    #[must_use]
    pub fn bounds(&self) -> Option<(Point, Point)> {
        self.corners.iter().map(|&v| self.points[v as usize]).fold(None, |b, p| {
            Some(b.map_or((p, p), |(lo, hi): (Point, Point)| (lo.inf(&p), hi.sup(&p))))
        })
    }

    /// Length of the bounding-box diagonal of the used vertices; 0 without faces.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        self.bounds().map_or(0.0, |(lo, hi)| (hi - lo).norm())
    }

    /// Area vector of face `f` after Newell: its length is the area of a planar polygon.
    #[must_use]
    pub fn area_vector(&self, f: usize) -> Vector {
        let face = self.face(f);
        let Some(&first) = face.first() else { return Vector::zeros() };
        let origin = self.points[first as usize];
        let arm = |v: u32| self.points[v as usize] - origin;
        face.windows(2).map(|e| arm(e[0]).cross(&arm(e[1]))).sum::<Vector>() * 0.5
    }

    /// Mean of the corners of face `f`.
    #[must_use]
    pub fn centre(&self, f: usize) -> Point {
        let face = self.face(f);
        let sum: Vector = face.iter().map(|&v| self.points[v as usize].coords).sum();
        Point::from(sum / face.len().max(1) as f64)
    }
}
