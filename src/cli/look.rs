//! How pictures look: options that `render` and `clean --pictures` share.

use std::str::FromStr;

use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use quadmend::elements::Inspection;
use quadmend::mesh::PolyMesh;
use quadmend::metrics::{FACE_FIELDS, FaceField, FaceValues};
use quadmend::render::{HeatRange, Image, Picture, PictureError, Shading, Subject, Up, View};

/// Options of pictures.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Pictures")]
pub(super) struct Look {
    /// Where to look from: corner, behind, front, right, back, left, top, bottom, or azimuth and
    /// elevation in degrees; may be repeated [default: corner]
    #[arg(long, value_name = "NAME|AZIMUTH,ELEVATION", allow_hyphen_values = true)]
    pub(super) view: Vec<NamedView>,

    /// The axis that points up
    #[arg(long, value_enum, default_value_t = UpAxis::Y)]
    up: UpAxis,

    /// Pixels of each view
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1200x900")]
    size: Size,

    /// Colour faces by a measure instead of showing irregular elements; distance needs a
    /// --reference [default: none]
    #[arg(long, value_name = "FIELD", value_parser = fields())]
    pub(super) heat: Option<String>,

    /// Interpolate normals between vertices [default: one normal for each face]
    #[arg(long)]
    smooth_shading: bool,

    /// Leave out edges that are neither sharp nor on a boundary
    #[arg(long)]
    no_edges: bool,

    /// Leave out captions and legend
    #[arg(long)]
    no_legend: bool,
}

/// The field of a heat map and its range, if there is one.
pub(super) type Heat = Option<(&'static FaceField, HeatRange)>;

fn fields() -> PossibleValuesParser {
    FACE_FIELDS.iter().map(|f| f.key).collect::<Vec<_>>().into()
}

/// A view and what the person called it, for file names.
#[derive(Debug, Clone)]
pub(super) struct NamedView {
    pub(super) name: String,
    view: View,
}

impl FromStr for NamedView {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Ok(Self { name: text.replace(' ', ""), view: text.parse()? })
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum UpAxis {
    Y,
    Z,
}

#[derive(Debug, Clone, Copy)]
struct Size([u32; 2]);

impl FromStr for Size {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let sides =
            text.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
        sides.map(Self).ok_or("a size looks like 1200x900")
    }
}

/// A mesh to be drawn.
pub(super) struct Shown<'a> {
    pub(super) name: String,
    pub(super) mesh: &'a PolyMesh,
    pub(super) inspection: &'a Inspection,
}

impl Look {
    /// Whether anything differs from what it is without options.
    pub(super) fn is_plain(&self) -> bool {
        let choices = self.smooth_shading || self.no_edges || self.no_legend;
        self.view.is_empty() && self.heat.is_none() && !choices
    }

    /// The views that were asked for, or those called `names`.
    pub(super) fn views_or(&self, names: &[&str]) -> Vec<NamedView> {
        if self.view.is_empty() {
            return names.iter().filter_map(|name| name.parse().ok()).collect();
        }
        self.view.clone()
    }

    /// The field of the heat map with its range over all meshes, if one was asked for.
    pub(super) fn range(&self, meshes: &[Shown]) -> Heat {
        let key = self.heat.as_deref()?;
        let of: Vec<&FaceValues> = meshes.iter().filter_map(|m| m.inspection.field(key)).collect();
        let field = of.first()?.field;
        Some((field, HeatRange::of(&of)))
    }

    /// Draws `meshes` side by side, a row for each view.
    pub(super) fn draw(
        &self,
        meshes: &[Shown],
        views: &[NamedView],
        heat: Heat,
    ) -> Result<Image, PictureError> {
        self.picture(meshes, views, heat).draw()
    }

    /// Draws each of `meshes` by itself, with the same camera and legend.
    pub(super) fn draw_apart(
        &self,
        meshes: &[Shown],
        view: &NamedView,
        heat: Heat,
    ) -> Result<Vec<Image>, PictureError> {
        self.picture(meshes, std::slice::from_ref(view), heat).draw_apart()
    }

    fn picture<'a>(&self, meshes: &[Shown<'a>], views: &[NamedView], heat: Heat) -> Picture<'a> {
        Picture {
            subjects: meshes.iter().map(|shown| shown.subject(heat.map(|h| h.0))).collect(),
            views: views.iter().map(|v| v.view).collect(),
            up: match self.up {
                UpAxis::Y => Up::Y,
                UpAxis::Z => Up::Z,
            },
            panel: self.size.0,
            shading: if self.smooth_shading { Shading::Smooth } else { Shading::Flat },
            edges: !self.no_edges,
            legend: !self.no_legend,
            heat,
        }
    }
}

impl<'a> Shown<'a> {
    fn subject(&self, heat: Option<&FaceField>) -> Subject<'a> {
        let values = heat.and_then(|field| self.inspection.field(field.key));
        Subject {
            name: self.name.clone(),
            mesh: self.mesh,
            topology: &self.inspection.topology,
            elements: &self.inspection.elements,
            heat: values.map(|f| f.values.as_slice()),
        }
    }
}
