//! Meshes as arrays that the page can hand to the graphics card.

use super::Entry;
use super::thin::{SHOWN_FACES, Thinned, thin};
use crate::elements::Irregular;
use crate::mesh::Point;
use base64::prelude::{BASE64_STANDARD, Engine};
use serde_json::{Map, Value, json};

/// The arrays of a mesh, of which no more faces than [`SHOWN_FACES`] are given.
pub(super) fn mesh(entry: &Entry, centre: &Point) -> Value {
    let shown = thin(entry.mesh, &entry.inspection.elements, SHOWN_FACES);
    let elements = &entry.inspection.elements;
    let (vertex, face) = (|v: u32| shown.vertex(v), |f: u32| shown.face(f));
    json!({
        "name": entry.name,
        "file": entry.file,
        "sha256": entry.sha256,
        "vertex_count": entry.mesh.vertex_count(),
        "face_count": entry.mesh.face_count(),
        "thinned": entry.mesh.face_count() > SHOWN_FACES,
        "vertex_ids": shown.renumbered_vertices().map(ids),
        "face_ids": shown.renumbered_faces().map(ids),
        "positions": positions(entry, &shown, centre),
        "offsets": ids(&shown.offsets),
        "corners": ids(&shown.corners),
        "fields": fields(entry, &shown),
        "irregular_vertices": irregular(&elements.vertices, vertex),
        "irregular_faces": irregular(&elements.faces, face),
        "t_junctions": pairs(elements.t_junctions.iter().map(|t| {
            Some([vertex(t.vertex)?, face(t.face)?])
        })),
        "sharp_edges": edges(&elements.sharp_edges, vertex),
        "boundary_edges": edges(&elements.boundary_edges, vertex),
    })
}

fn positions(entry: &Entry, shown: &Thinned, centre: &Point) -> String {
    let points = entry.mesh.points();
    let of = |&v: &u32| (points[v as usize] - centre).iter().copied().collect::<Vec<f64>>();
    floats(shown.vertex_ids.iter().flat_map(of))
}

fn fields(entry: &Entry, shown: &Thinned) -> Map<String, Value> {
    let of = |field: &crate::metrics::FaceValues| {
        let values = shown.face_ids.iter().map(|&f| field.values[f as usize]);
        (field.field.key.to_owned(), floats(values).into())
    };
    entry.inspection.fields.iter().map(of).collect()
}

/// Pairs of number and index.
fn irregular(elements: &[Irregular], number: impl Fn(u32) -> Option<u32>) -> String {
    pairs(elements.iter().map(|e| Some([number(e.id)?, e.index.cast_unsigned()])))
}

/// Edges, less those that have become a point.
fn edges(all: &[[u32; 2]], vertex: impl Fn(u32) -> Option<u32>) -> String {
    let ends = all.iter().map(|&[a, b]| Some([vertex(a)?, vertex(b)?]));
    pairs(ends.filter(|ends| ends.is_none_or(|[a, b]| a != b)))
}

/// Those pairs of which both are shown.
fn pairs(all: impl Iterator<Item = Option<[u32; 2]>>) -> String {
    ids(&all.flatten().flatten().collect::<Vec<u32>>())
}

fn ids(numbers: &[u32]) -> String {
    let bytes: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
    BASE64_STANDARD.encode(bytes)
}

/// In single precision: what is drawn and shown needs no more.
fn floats(numbers: impl Iterator<Item = f64>) -> String {
    let bytes: Vec<u8> = numbers.flat_map(|x| (x as f32).to_le_bytes()).collect();
    BASE64_STANDARD.encode(bytes)
}
