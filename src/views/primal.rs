//! The way back from √CC: two colourings exist on each component, one label decides.
//!
//! Source: Peng & Wonka 2013, Proposition 3.1.

use super::{Label, rings};
use crate::mesh::{MeshError, NONE, PolyMesh, Topology};
use thiserror::Error;

/// Why a mesh is not the √CC mesh of another one.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ViewError {
    /// A face with another number of corners than four. Elements are numbered from 0.
    #[error("face {face} has {corners} corners; a √CC mesh has quads only")]
    NotAQuad {
        /// The face.
        face: usize,
        /// How many corners it has.
        corners: usize,
    },
    /// Vertices and faces cannot be told apart.
    #[error(
        "vertices {a} and {b} are joined and would have the same label; a √CC mesh can be coloured \
         with two colours"
    )]
    OddCycle {
        /// One end of the edge.
        a: u32,
        /// The other end.
        b: u32,
    },
    /// Nothing is left.
    #[error("no vertex stands for a face; is the label of the first vertex right?")]
    NoFaces,
    /// A face would have fewer than three corners.
    #[error("vertex {vertex} would be a face of {corners} corners; is the label right?")]
    ShortFace {
        /// The vertex that stands for the face.
        vertex: u32,
        /// How many corners the face would have.
        corners: usize,
    },
    /// The mesh cannot be built.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// The mesh whose √CC mesh is `view`, if the vertex of the smallest number in each component is
/// labelled `first` ([`Label::Vertex`], or anything else for a face). Vertices and faces keep
/// their order; boundary vertices that stand for faces are dropped. O(n log n).
pub fn primal(view: &PolyMesh, first: Label) -> Result<PolyMesh, ViewError> {
    if let Some((face, quad)) = view.faces().enumerate().find(|(_, f)| f.len() != 4) {
        return Err(ViewError::NotAQuad { face, corners: quad.len() });
    }
    let is_vertex = two_colouring(view, first == Label::Vertex)?;
    let mut number = vec![NONE; view.vertex_count()];
    let mut points = Vec::new();
    for (v, &point) in view.points().iter().enumerate().filter(|&(v, _)| is_vertex[v]) {
        number[v] = points.len() as u32;
        points.push(point);
    }
    let topology = Topology::new(view);
    let mut faces: Vec<(u32, Vec<u32>)> = Vec::new();
    for (&v, ring) in topology.fan_vertex.iter().zip(rings(&topology)) {
        if !is_vertex[v as usize] && !ring.is_empty() {
            let target = |&c: &u32| view.corners()[topology.next[c as usize] as usize];
            faces.push((v, ring.iter().map(|c| number[target(c) as usize]).collect()));
        }
    }
    faces.sort_by_key(|&(v, _)| v);
    match faces.iter().find(|(_, ring)| ring.len() < 3) {
        Some((vertex, ring)) => Err(ViewError::ShortFace { vertex: *vertex, corners: ring.len() }),
        None if faces.is_empty() => Err(ViewError::NoFaces),
        None => Ok(PolyMesh::new(points, faces.into_iter().map(|(_, ring)| ring))?),
    }
}

/// Whether each vertex has the colour of a vertex, the smallest of each component that of `first`.
fn two_colouring(view: &PolyMesh, first: bool) -> Result<Vec<bool>, ViewError> {
    let mut near = vec![Vec::new(); view.vertex_count()];
    for face in view.faces() {
        for (&a, &b) in face.iter().zip(face.iter().cycle().skip(1)) {
            near[a as usize].push(b);
            near[b as usize].push(a);
        }
    }
    let mut colour = vec![None; view.vertex_count()];
    for start in 0..view.vertex_count() {
        if colour[start].is_some() {
            continue;
        }
        colour[start] = Some(first);
        let mut queue = vec![(start as u32, first)];
        while let Some((a, own)) = queue.pop() {
            for &b in &near[a as usize] {
                match colour[b as usize] {
                    None => {
                        colour[b as usize] = Some(!own);
                        queue.push((b, !own));
                    }
                    Some(other) if other == own => return Err(ViewError::OddCycle { a, b }),
                    Some(_) => {}
                }
            }
        }
    }
    Ok(colour.into_iter().map(|c| c.unwrap_or(first)).collect())
}
