//! One mesh from one side: faces, edges, and the elements that stand out.

use super::camera::Camera;
use super::heat::HeatRange;
use super::image::Image;
use super::palette::{self, Rgb, mix};
use super::raster::{Canvas, OVERSAMPLING, Place};
use crate::elements::{Elements, edges};
use crate::mesh::{PolyMesh, Topology, Vector};
use crate::surface::{mean_edge, triangulate};

/// A mesh with what is to be shown of it.
#[derive(Debug, Clone)]
pub struct Subject<'a> {
    /// Its name in the caption.
    pub name: String,
    /// The mesh.
    pub mesh: &'a PolyMesh,
    /// Its connectivity.
    pub topology: &'a Topology,
    /// Its elements that stand out.
    pub elements: &'a Elements,
    /// Values of its faces for a heat map.
    pub heat: Option<&'a [f64]>,
}

/// How light falls on faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shading {
    /// Every face has one normal.
    #[default]
    Flat,
    /// Normals are interpolated between vertices.
    Smooth,
}

/// Depth that lifts a mark above every face, in pixels of the canvas.
const IN_FRONT: f64 = 1e5;

/// How a panel is drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Style {
    pub(super) shading: Shading,
    pub(super) edges: bool,
    pub(super) heat: Option<HeatRange>,
}

/// Lengths of the drawing, in pixels of the canvas.
struct Pen {
    line: f64,
    disc: f64,
}

impl Pen {
    /// In proportion to the mean edge, within what can be seen and what does not smear.
    fn new(edge: f64) -> Self {
        let pixel = f64::from(OVERSAMPLING);
        let line = (0.07 * edge).clamp(0.45 * pixel, 1.5 * pixel);
        Self { line, disc: (0.26 * edge).clamp(1.7 * pixel, 6.5 * pixel) }
    }
}

/// Draws `subject`.
pub(super) fn draw(subject: &Subject, camera: &Camera, size: [u32; 2], style: Style) -> Image {
    let mut canvas = Canvas::new(size[0], size[1], palette::PAPER);
    let places: Vec<Place> = subject.mesh.points().iter().map(|p| camera.project(p)).collect();
    let pen = Pen::new(camera.scale * mean_edge(subject.mesh, subject.topology));
    faces(&mut canvas, subject, camera, style);
    // Before lines are drawn, which would hide what stands on them.
    let seen: Vec<bool> = places.iter().map(|&p| canvas.shows(p)).collect();
    if style.edges {
        let ends = |h: u32| {
            [h, subject.topology.next[h as usize]].map(|c| subject.mesh.corners()[c as usize])
        };
        let all: Vec<[u32; 2]> = edges(subject.topology).map(ends).collect();
        lines(&mut canvas, &places, &all, pen.line, palette::EDGE);
    }
    let strong = 2.6 * pen.line;
    lines(&mut canvas, &places, &subject.elements.boundary_edges, strong, palette::BOUNDARY);
    lines(&mut canvas, &places, &subject.elements.sharp_edges, strong, palette::SHARP);
    if style.heat.is_none() {
        let at = |v: u32| seen[v as usize].then(|| places[v as usize]);
        marks(&mut canvas, at, subject.elements, pen.disc);
    }
    canvas.resolve()
}

fn lines(canvas: &mut Canvas, places: &[Place], edges: &[[u32; 2]], width: f64, colour: Rgb) {
    // A line lies on faces that may be steep: what it is wide, it must be lifted.
    for ends in edges {
        canvas.line(ends.map(|v| places[v as usize]), width, 1.6 * width, colour);
    }
}

/// Discs for irregular vertices, rings around those that hang: whole or not at all, in front of all
/// faces.
fn marks(
    canvas: &mut Canvas,
    seen_at: impl Fn(u32) -> Option<Place>,
    elements: &Elements,
    radius: f64,
) {
    let rim = (0.22 * radius).max(0.5 * f64::from(OVERSAMPLING));
    for at in elements.t_junctions.iter().filter_map(|t| seen_at(t.vertex)) {
        canvas.ring(at, [radius + rim, radius + 3.0 * rim], IN_FRONT, palette::T_JUNCTION);
    }
    for vertex in &elements.vertices {
        let Some(at) = seen_at(vertex.id) else { continue };
        let grown = if vertex.index.abs() > 1 { 1.35 * radius } else { radius };
        canvas.ring(at, [0.0, grown + rim], IN_FRONT, palette::INK);
        canvas.ring(at, [0.0, grown], IN_FRONT + radius, palette::index(vertex.index));
    }
}

fn faces(canvas: &mut Canvas, subject: &Subject, camera: &Camera, style: Style) {
    let surface = triangulate(subject.mesh);
    let places: Vec<Place> = surface.points.iter().map(|p| camera.project(p)).collect();
    let colours = face_colours(subject, style);
    let flat: Vec<f64> = (0..subject.mesh.face_count())
        .map(|f| light(camera, &subject.mesh.area_vector(f)))
        .collect();
    let smooth: Vec<f64> = match style.shading {
        Shading::Flat => Vec::new(),
        Shading::Smooth => vertex_normals(subject.mesh).iter().map(|n| light(camera, n)).collect(),
    };
    for (triangle, &face) in surface.triangles.iter().zip(&surface.face) {
        let (face, corners) = (face as usize, triangle.map(|v| v as usize));
        let colour = colours[face];
        let at = |v: usize| smooth.get(v).copied().unwrap_or(flat[face]);
        let lights = corners.map(at);
        canvas.triangle(corners.map(|v| places[v]), |weights| {
            lit(colour, weights.iter().zip(lights).map(|(w, l)| w * l).sum())
        });
    }
}

/// Heat, or the index of each face.
fn face_colours(subject: &Subject, style: Style) -> Vec<Rgb> {
    if let (Some(range), Some(values)) = (style.heat, subject.heat) {
        return values.iter().map(|&v| palette::heat(range.place(v))).collect();
    }
    let mut colours = vec![palette::FACE; subject.mesh.face_count()];
    for face in &subject.elements.faces {
        colours[face.id as usize] = palette::index(face.index);
    }
    colours
}

fn vertex_normals(mesh: &PolyMesh) -> Vec<Vector> {
    let mut normals = vec![Vector::zeros(); mesh.vertex_count()];
    for (f, face) in mesh.faces().enumerate() {
        let area = mesh.area_vector(f);
        for &v in face {
            normals[v as usize] += area;
        }
    }
    normals
}

/// How much light a surface of this normal sends to the eye, from a lamp above its left shoulder;
/// negative if it is seen from behind. What has no normal is lit as if it faced the eye.
fn light(camera: &Camera, normal: &Vector) -> f64 {
    let length = normal.norm();
    if length <= 0.0 || !length.is_finite() {
        return 1.0;
    }
    let facing = camera.facing(&(normal / length));
    let side = if facing[2] < 0.0 { -1.0 } else { 1.0 };
    let [right, up, toward] = facing.map(|x| side * x);
    let lamp = (-0.40 * right + 0.50 * up + 0.77 * toward).max(0.0);
    side * (0.50 + 0.56 * (0.55 * lamp + 0.45 * toward))
}

/// The colour in that light. Backs are another colour, so that holes and turned faces show.
fn lit(colour: Rgb, light: f64) -> Rgb {
    let surface = if light < 0.0 { mix(colour, palette::BACK, 0.8) } else { colour };
    mix([0; 3], surface, light.abs().min(1.0))
}
