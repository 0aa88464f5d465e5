//! A sheet: a column for each mesh, a row for each view, captions above and a legend below.

use super::camera::{Camera, Up, View};
use super::heat::HeatRange;
use super::image::Image;
use super::legend;
use super::palette;
use super::panel::{self, Shading, Style, Subject};
use super::raster::OVERSAMPLING;
use super::text::Pen;
use crate::mesh::Point;
use crate::metrics::FaceField;
use rayon::prelude::*;
use thiserror::Error;

/// Most pixels of a sheet.
const MOST_PIXELS: u64 = 100_000_000;
/// Fewest pixels across a panel.
const LEAST_PANEL: u32 = 16;

/// Why there is no picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum PictureError {
    /// Nothing to show.
    #[error("a picture needs a mesh and a view")]
    Nothing,
    /// Panels too small or too many pixels in all.
    #[error(
        "panels of {width} × {height} pixels for {panels} views cannot be drawn: they need at \
         least 16 pixels each way and 100 million in all"
    )]
    Size {
        /// Pixels across a panel.
        width: u32,
        /// Pixels down a panel.
        height: u32,
        /// How many panels there are.
        panels: usize,
    },
    /// The font that the program carries cannot be read.
    #[error("the font of the program is damaged")]
    Font,
}

/// What is to be drawn, and how.
#[derive(Debug, Clone)]
pub struct Picture<'a> {
    /// A column for each.
    pub subjects: Vec<Subject<'a>>,
    /// A row for each.
    pub views: Vec<View>,
    /// The axis that points up.
    pub up: Up,
    /// Pixels across and down a panel.
    pub panel: [u32; 2],
    /// How light falls.
    pub shading: Shading,
    /// Whether all edges are drawn, and not only features and boundaries.
    pub edges: bool,
    /// Whether there are captions and a legend.
    pub legend: bool,
    /// The field and range of a heat map, in place of the colours of indices.
    pub heat: Option<(&'static FaceField, HeatRange)>,
}

impl<'a> Picture<'a> {
    /// Draws it. All panels have the same scale, and those of a row the same camera.
    pub fn draw(&self) -> Result<Image, PictureError> {
        self.check()?;
        let all: Vec<&Subject> = self.subjects.iter().collect();
        self.sheet(&all)
    }

    /// Draws each mesh on a sheet of its own, with the same cameras and the same legend as if they
    /// were side by side.
    pub fn draw_apart(&self) -> Result<Vec<Image>, PictureError> {
        self.check()?;
        self.subjects.iter().map(|subject| self.sheet(&[subject])).collect()
    }

    /// A sheet of some of the subjects.
    fn sheet(&self, shown: &[&Subject<'a>]) -> Result<Image, PictureError> {
        let [width, height] = self.panel;
        let text = (width / 44).clamp(11, 40);
        let pen = Pen::new(text as f32).ok_or(PictureError::Font)?;
        let [columns, rows] = [shown.len(), self.views.len()].map(|n| n as u32);
        let head = if self.legend { 2 * text } else { 0 };
        let foot = self
            .legend
            .then(|| legend::draw(&self.subjects, self.heat, (&pen, text), width * columns));
        let below = foot.as_ref().map_or(0, |f| f.size()[1]);
        let mut sheet = Image::new(width * columns, head + rows * height + below, palette::PAPER);
        for (panel, [column, row]) in self.panels(shown) {
            sheet.paste(&panel, [column * width, head + row * height]);
        }
        if let Some(foot) = foot {
            for (column, subject) in (0..columns).zip(shown) {
                caption(&mut sheet, &pen, subject, [column * width + text, width - text, text]);
            }
            sheet.paste(&foot, [0, head + rows * height]);
        }
        Ok(sheet)
    }

    fn check(&self) -> Result<(), PictureError> {
        let panels = self.subjects.len() * self.views.len();
        if panels == 0 {
            return Err(PictureError::Nothing);
        }
        let [width, height] = self.panel;
        let all = (u64::from(width) * u64::from(height)).saturating_mul(panels as u64);
        if width < LEAST_PANEL || height < LEAST_PANEL || all > MOST_PIXELS {
            return Err(PictureError::Size { width, height, panels });
        }
        Ok(())
    }

    /// The panels of some of the subjects, each with its column and row.
    fn panels(&self, shown: &[&Subject<'a>]) -> Vec<(Image, [u32; 2])> {
        let points: Vec<Point> = self.subjects.iter().flat_map(used_points).collect();
        let size = self.panel.map(|pixels| pixels * OVERSAMPLING);
        let margin = f64::from(size[0].min(size[1])) * 0.04;
        let style = Style {
            shading: self.shading,
            edges: self.edges,
            heat: self.heat.map(|(_, range)| range),
        };
        let fit = |&view: &View| Camera::fit(view, self.up, &points, size, margin);
        let cameras: Vec<Camera> = self.views.iter().map(fit).collect();
        let rows = 0..cameras.len();
        let places: Vec<[usize; 2]> =
            rows.flat_map(|row| (0..shown.len()).map(move |column| [column, row])).collect();
        let draw = |&[column, row]: &[usize; 2]| {
            let panel = panel::draw(shown[column], &cameras[row], size, style);
            (panel, [column as u32, row as u32])
        };
        places.par_iter().map(draw).collect()
    }
}

/// The points of faces: a vertex of no face must not make the rest small.
fn used_points(subject: &Subject) -> Vec<Point> {
    let mut used = vec![false; subject.mesh.vertex_count()];
    for &v in subject.mesh.corners() {
        used[v as usize] = true;
    }
    let points = subject.mesh.points().iter().zip(used);
    points.filter_map(|(p, used)| used.then_some(*p)).collect()
}

/// Name and counts of a mesh, as much of it as there is room for.
fn caption(sheet: &mut Image, pen: &Pen, subject: &Subject, [left, width, text]: [u32; 3]) {
    let elements = subject.elements.vertices.iter().chain(&subject.elements.faces);
    let e: u32 = elements.map(|e| e.index.unsigned_abs()).sum();
    let t = subject.elements.t_junctions.len();
    let t = match t {
        0 => String::new(),
        1 => ", 1 T-junction".to_owned(),
        _ => format!(", {t} T-junctions"),
    };
    let counts = format!("{} faces, E = {e}{t}", subject.mesh.face_count());
    let base = text * 7 / 5;
    pen.write(sheet, &subject.name, [left, base], palette::INK);
    let after = pen.width(&subject.name) + text;
    if after + pen.width(&counts) <= width {
        pen.write(sheet, &counts, [left + after, base], palette::FAINT);
    }
}
