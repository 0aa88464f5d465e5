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
    /// Whether there is less than in the mesh.
    pub(super) fn is_thinner(&self) -> bool {
        self.face_ids.len() < self.face_of.len()
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

/// All of a mesh of at most `most` faces; else as fine as it can be with about that many.
pub(super) fn thin(mesh: &PolyMesh, elements: &Elements, most: usize) -> Thinned {
    if mesh.face_count() <= most {
        return merged(mesh, (0..mesh.vertex_count() as u32).collect());
    }
    let kept = kept(mesh, elements);
    // A surface meets about as many cells as the square of how many there are along it.
    let mut cells = 2.0 * (most as f64).sqrt();
    loop {
        let thinned = merged(mesh, clusters(mesh, &kept, cells));
        if thinned.face_ids.len() <= most || cells < 2.0 {
            return thinned;
        }
        cells *= 0.8;
    }
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
fn merged(mesh: &PolyMesh, stands_for: Vec<u32>) -> Thinned {
    let mut thinned = Thinned {
        vertex_ids: Vec::new(),
        face_ids: Vec::new(),
        offsets: vec![0],
        corners: Vec::new(),
        vertex_of: vec![NONE; mesh.vertex_count()],
        face_of: vec![NONE; mesh.face_count()],
    };
    let mut numbers = vec![NONE; mesh.vertex_count()];
    for (f, face) in (0..).zip(mesh.faces()) {
        let mut corners: Vec<u32> = face.iter().map(|&v| stands_for[v as usize]).collect();
        corners.dedup();
        if corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() < 3 {
            continue;
        }
        for v in corners {
            if numbers[v as usize] == NONE {
                numbers[v as usize] = thinned.vertex_ids.len() as u32;
                thinned.vertex_ids.push(v);
            }
            thinned.corners.push(numbers[v as usize]);
        }
        thinned.face_of[f as usize] = thinned.face_ids.len() as u32;
        thinned.face_ids.push(f);
        thinned.offsets.push(thinned.corners.len() as u32);
    }
    for (of, by) in thinned.vertex_of.iter_mut().zip(stands_for) {
        *of = numbers[by as usize];
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
        assert!(!shown.is_thinner());
        assert_eq!((shown.offsets.as_slice(), shown.face_ids.len()), (mesh.offsets(), 54));
    }

    #[test]
    fn large_meshes_lose_faces_but_no_irregular_element() {
        let mesh = shapes::cube(20);
        let elements = Elements::new(&mesh, &Topology::new(&mesh), None);
        let shown = thin(&mesh, &elements, 600);
        assert!(shown.is_thinner() && (50..=600).contains(&shown.face_ids.len()));
        for corner in &elements.vertices {
            let number = shown.vertex(corner.id).unwrap();
            assert_eq!(shown.vertex_ids[number as usize], corner.id);
        }
    }
}
