//! Triangles of a polygon mesh, cut so that independent measurements agree.
//!
//! Triangles stay as they are, quads are cut by the shorter diagonal (the first one if equal),
//! larger polygons become fans about the mean of their corners.

use crate::mesh::{Point, PolyMesh};

/// Triangles made of the faces of a polygon mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Triangulation {
    /// The points of the mesh, then the means of its faces of five and more corners.
    pub points: Vec<Point>,
    /// Corners of each triangle, face by face.
    pub triangles: Vec<[u32; 3]>,
    /// The face that each triangle is a part of.
    pub face: Vec<u32>,
}

/// Cuts every face of `mesh` into triangles; faces of fewer than three corners give none. O(n).
#[must_use]
pub fn triangulate(mesh: &PolyMesh) -> Triangulation {
    let mut out = Triangulation {
        points: mesh.points().to_vec(),
        triangles: Vec::with_capacity(2 * mesh.face_count()),
        face: Vec::with_capacity(2 * mesh.face_count()),
    };
    for (f, face) in mesh.faces().enumerate() {
        match *face {
            [] | [_] | [_, _] => {}
            [a, b, c] => out.triangles.push([a, b, c]),
            [a, b, c, d] => out.cut_quad([a, b, c, d]),
            _ => out.fan(face, mesh.centre(f)),
        }
        out.face.resize(out.triangles.len(), f as u32);
    }
    out
}

impl Triangulation {
    fn cut_quad(&mut self, [a, b, c, d]: [u32; 4]) {
        let length = |u: u32, v: u32| (self.points[u as usize] - self.points[v as usize]).norm();
        if length(a, c) <= length(b, d) {
            self.triangles.extend([[a, b, c], [a, c, d]]);
        } else {
            self.triangles.extend([[a, b, d], [b, c, d]]);
        }
    }

    fn fan(&mut self, face: &[u32], centre: Point) {
        let middle = self.points.len() as u32;
        self.points.push(centre);
        let next = face.iter().cycle().skip(1);
        self.triangles.extend(face.iter().zip(next).map(|(&a, &b)| [a, b, middle]));
    }
}
