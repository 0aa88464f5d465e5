//! Thinning out meshes that are too large to look at in a browser.
//!
//! Vertices in the same cell of a grid become one (Rossignac & Borrel, *Multi-resolution 3D
//! approximations for rendering complex scenes*, 1993), but for those of irregular elements, which
//! all stay where they are: what the report is about is never left out.

use crate::elements::Elements;
use crate::mesh::{NONE, Point, PolyMesh};
use std::collections::BTreeMap;

/// Faces of a mesh beyond which a report shows it thinned out.
pub const SHOWN_FACES: usize = 120_000;

/// The part of a mesh that is shown.
#[derive(Debug, Clone)]
pub(super) struct Thinned {
    /// Vertex of the mesh of each shown vertex.
    pub(super) vertex_ids: Vec<u32>,
    /// Face of the mesh of each shown face.
    pub(super) face_ids: Vec<u32>,
    /// Where the corners of each shown face begin; one entry more than there are faces.
    pub(super) offsets: Vec<u32>,
    /// Shown vertices of the faces.
    pub(super) corners: Vec<u32>,
    /// Shown vertex of each vertex, or [`NONE`].
    vertex_of: Vec<u32>,
    /// Shown face of each face, or [`NONE`].
    face_of: Vec<u32>,
}

impl Thinned {
    /// Vertex of the mesh of each shown vertex, where they are not numbered alike.
    pub(super) fn renumbered_vertices(&self) -> Option<&[u32]> {
        (self.vertex_ids.len() < self.vertex_of.len()).then_some(&self.vertex_ids)
    }

    /// Face of the mesh of each shown face, where they are not numbered alike.
    pub(super) fn renumbered_faces(&self) -> Option<&[u32]> {
        (self.face_ids.len() < self.face_of.len()).then_some(&self.face_ids)
    }

    /// The shown vertex that stands for a vertex.
    pub(super) fn vertex(&self, v: u32) -> Option<u32> {
        Some(self.vertex_of[v as usize]).filter(|&shown| shown != NONE)
    }

    /// The number of a face among those shown.
    pub(super) fn face(&self, f: u32) -> Option<u32> {
        Some(self.face_of[f as usize]).filter(|&shown| shown != NONE)
    }
}

/// All of a mesh of at most `most` faces, less what cannot be drawn (vertices of no face, faces of
/// fewer than three vertices); else as fine as it can be with about that many.
pub(super) fn thin(mesh: &PolyMesh, elements: &Elements, most: usize) -> Thinned {
    if mesh.face_count() <= most {
        return merged(mesh, &all(mesh));
    }
    let kept = kept(mesh, elements);
    // A surface meets about as many cells as the square of how many there are along it.
    let mut cells = 2.0 * (most as f64).sqrt();
    loop {
        let thinned = merged(mesh, &clusters(mesh, &kept, cells));
        if thinned.face_ids.len() <= most || cells < 2.0 {
            return thinned;
        }
        cells *= 0.8;
    }
}

/// Every vertex stands for itself.
fn all(mesh: &PolyMesh) -> Vec<u32> {
    (0..mesh.vertex_count() as u32).collect()
}

/// The vertices that must stay.
fn kept(mesh: &PolyMesh, elements: &Elements) -> Vec<bool> {
    let mut kept = vec![false; mesh.vertex_count()];
    let faces = elements.faces.iter().flat_map(|f| mesh.face(f.id as usize));
    for &v in elements.vertices.iter().map(|v| &v.id).chain(faces) {
        kept[v as usize] = true;
    }
    kept
}

/// For each vertex, the one that stands for all in its cell.
fn clusters(mesh: &PolyMesh, kept: &[bool], cells: f64) -> Vec<u32> {
    let (low, high) = mesh.bounds().unwrap_or((Point::origin(), Point::origin()));
    let cell = ((high - low).max() / cells).max(f64::MIN_POSITIVE);
    let mut first = BTreeMap::new();
    let of = |(v, p): (usize, &Point)| {
        let key = (p - low).map(|x| (x / cell).floor() as i64);
        if kept[v] { v as u32 } else { *first.entry([key.x, key.y, key.z]).or_insert(v as u32) }
    };
    mesh.points().iter().enumerate().map(of).collect()
}

/// The mesh with each vertex replaced by the one that stands for it.
fn merged(mesh: &PolyMesh, stands_for: &[u32]) -> Thinned {
    let mut thinned = Thinned {
        vertex_ids: Vec::new(),
        face_ids: Vec::new(),
        offsets: vec![0],
        corners: Vec::new(),
        vertex_of: vec![NONE; mesh.vertex_count()],
        face_of: vec![NONE; mesh.face_count()],
    };
    // Vertices keep their order, so that a mesh of which all is shown keeps its numbers.
    let mut used = vec![false; mesh.vertex_count()];
    for &v in mesh.corners() {
        used[stands_for[v as usize] as usize] = true;
    }
    let mut numbers = vec![NONE; mesh.vertex_count()];
    for v in (0..mesh.vertex_count() as u32).filter(|&v| used[v as usize]) {
        numbers[v as usize] = thinned.vertex_ids.len() as u32;
        thinned.vertex_ids.push(v);
    }
    for (f, face) in (0..).zip(mesh.faces()) {
        let mut corners: Vec<u32> = face.iter().map(|&v| stands_for[v as usize]).collect();
        corners.dedup();
        if corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() < 3 {
            continue;
        }
        thinned.corners.extend(corners.iter().map(|&v| numbers[v as usize]));
        thinned.face_of[f as usize] = thinned.face_ids.len() as u32;
        thinned.face_ids.push(f);
        thinned.offsets.push(thinned.corners.len() as u32);
    }
    for (of, by) in thinned.vertex_of.iter_mut().zip(stands_for) {
        *of = numbers[*by as usize];
    }
    thinned
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Topology, shapes};

    #[test]
    fn small_meshes_are_shown_whole() {
        let mesh = shapes::cube(3);
        let shown = thin(&mesh, &Elements::default(), 54);
        assert_eq!((shown.renumbered_vertices(), shown.renumbered_faces()), (None, None));
        assert_eq!(
            (shown.offsets.as_slice(), shown.corners.as_slice()),
            (mesh.offsets(), mesh.corners())
        );
    }

    #[test]
    fn what_cannot_be_drawn_leaves_the_numbers_of_the_rest() {
        let points = shapes::grid(2, 1).points().to_vec();
        let mesh = PolyMesh::new(points, [vec![1, 4, 1], vec![1, 2, 5, 4]]).unwrap();
        let shown = thin(&mesh, &Elements::default(), 10);
        assert_eq!(shown.renumbered_vertices(), Some([1, 2, 4, 5].as_slice()));
        assert_eq!(shown.renumbered_faces(), Some([1].as_slice()));
        assert_eq!((shown.vertex(5), shown.vertex(0), shown.face(0)), (Some(3), None, None));
    }

    #[test]
    fn large_meshes_lose_faces_but_no_irregular_element() {
        let mesh = shapes::cube(20);
        let elements = Elements::new(&mesh, &Topology::new(&mesh), None);
        let shown = thin(&mesh, &elements, 600);
        assert!((50..=600).contains(&shown.renumbered_faces().map_or(0, <[u32]>::len)));
        for corner in &elements.vertices {
            let number = shown.vertex(corner.id).unwrap();
            assert_eq!(shown.vertex_ids[number as usize], corner.id);
        }
    }
}
