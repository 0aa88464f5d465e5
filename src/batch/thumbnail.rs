//! Small pictures of a mesh before and after.

use crate::elements::Elements;
use crate::mesh::{PolyMesh, Topology};
use crate::render::{Image, Picture, PictureError, Shading, Subject, Up, VIEWS};

/// Pixels across and down.
const SIZE: [u32; 2] = [320, 240];

/// Draws both meshes with the same camera, their irregular elements marked.
pub fn thumbnails(before: &PolyMesh, after: &PolyMesh) -> Result<[Image; 2], PictureError> {
    let topologies = [before, after].map(Topology::new);
    let elements: Vec<Elements> = [before, after]
        .into_iter()
        .zip(&topologies)
        .map(|(mesh, topology)| Elements::new(mesh, topology, None))
        .collect();
    let subject = |i: usize, mesh| Subject {
        name: String::new(),
        mesh,
        topology: &topologies[i],
        elements: &elements[i],
        heat: None,
    };
    let picture = Picture {
        subjects: vec![subject(0, before), subject(1, after)],
        views: vec![VIEWS[0].1],
        up: Up::Y,
        panel: SIZE,
        shading: Shading::Smooth,
        edges: false,
        legend: false,
        heat: None,
    };
    let images = picture.draw_apart()?;
    images.try_into().map_err(|_| PictureError::Nothing)
}
