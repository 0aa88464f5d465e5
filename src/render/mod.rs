//! Pictures of meshes: headless, and the same bytes on every run.
//!
//! A [`Picture`] is a sheet of panels, a column for each mesh and a row for each [`View`], all with
//! the same camera, and a legend below. Faces go through a depth buffer at several times the
//! resolution (`raster`), which is then averaged, so that edges are smooth. Colours are
//! those of [`palette`]: irregular elements of positive index blue, of negative index yellow (Peng
//! & Wonka 2013), or a heat map of a [`FaceField`](crate::metrics::FaceField).

mod camera;
mod heat;
mod image;
mod legend;
pub mod palette;
mod panel;
mod raster;
mod sheet;
mod text;

pub use camera::{Up, VIEWS, View};
pub use heat::HeatRange;
pub use image::Image;
pub use panel::{Shading, Subject};
pub use sheet::{Picture, PictureError};
