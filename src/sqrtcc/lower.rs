//! Lowering Q to the polygon mesh: the neighbours of each d-vertex, in order, are a face.
//!
//! The inverse of [`super::lift`]; unique once the colours are given (Peng & Wonka 2013,
//! Proposition 3.1).

use super::QuadMesh;
use crate::mesh::{MeshError, NONE, PolyMesh};

/// A polygon mesh and where its elements are in Q.
#[derive(Debug, Clone)]
pub struct Lowered {
    /// The mesh; vertices and faces in the order of their ids in Q.
    pub mesh: PolyMesh,
    /// Vertex of Q of each vertex.
    pub vertex_ids: Vec<u32>,
    /// Vertex of Q of each face.
    pub face_ids: Vec<u32>,
    /// Whether each vertex lies on a boundary or feature.
    pub held: Vec<bool>,
}

/// Lowers Q. `group_names` are those of the mesh that was lifted. O(size of Q).
pub fn lower(q: &QuadMesh, group_names: &[String]) -> Result<Lowered, MeshError> {
    let (face_ids, vertex_ids): (Vec<u32>, Vec<u32>) = q.vertices().partition(|&v| q.is_face(v));
    let mut number = vec![NONE; q.vertex_ids() as usize];
    for (i, &v) in vertex_ids.iter().enumerate() {
        number[v as usize] = i as u32;
    }
    let (mut offsets, mut corners) = (vec![0], Vec::with_capacity(4 * face_ids.len()));
    for &f in &face_ids {
        corners.extend(q.neighbours(f).map(|v| number[v as usize]));
        offsets.push(corners.len() as u32);
    }
    let points = vertex_ids.iter().map(|&v| q.position(v)).collect();
    let mesh = PolyMesh::from_rows(points, offsets, corners)?
        .with_groups(face_ids.iter().map(|&f| q.group(f)).collect(), group_names.to_vec());
    let held = vertex_ids.iter().map(|&v| q.is_held(v)).collect();
    Ok(Lowered { mesh, vertex_ids, face_ids, held })
}
