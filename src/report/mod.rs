//! The HTML report: one file that opens offline, with the meshes in it.
//!
//! The page (`web/`, bundled into `web/dist`) draws itself from the JSON made here: meshes and
//! their fields as base64 of little-endian arrays, the table of metrics, and of a run of `clean`
//! its edits, refusals, configuration and timings.
//!
//! *Invariant:* the same meshes and runs give the same bytes, but for the timings that are handed
//! in.

mod charts;
mod geometry;
mod run;
mod thin;

pub use run::{Run, Timing, words};
pub use thin::SHOWN_FACES;

use crate::elements::Inspection;
use crate::mesh::{Point, PolyMesh};
use crate::metrics::{Better, FaceValues, Line, Metrics, lines};
use crate::render::HeatRange;
use serde_json::{Value, json};

const PAGE: &str = include_str!("../../web/src/page.html");
/// The look of all pages: colours for light and dark, tables, charts.
pub(crate) const STYLE: &str = include_str!("../../web/dist/report.css");
const SCRIPT: &str = include_str!("../../web/dist/report.js");

/// A mesh of the report with all that is known about it.
#[derive(Debug, Clone)]
pub struct Entry<'a> {
    /// Its name on the page.
    pub name: String,
    /// The file it was read from or written to.
    pub file: String,
    /// SHA-256 of that file, if it was read.
    pub sha256: Option<String>,
    /// The mesh.
    pub mesh: &'a PolyMesh,
    /// Its elements and the quality of its faces.
    pub inspection: &'a Inspection,
    /// Its metrics.
    pub metrics: &'a Metrics,
}

/// A report on some meshes.
#[derive(Debug, Clone)]
pub struct Document<'a> {
    /// Heading of the page.
    pub title: String,
    /// The meshes; the first two are shown first, and two are read as before and after.
    pub meshes: Vec<Entry<'a>>,
    /// The reference, as file and SHA-256, if there is one.
    pub reference: Option<(String, String)>,
    /// How the second mesh came about, if it was cleaned from the first.
    pub run: Option<Run<'a>>,
}

/// A template with texts in place of its marks, which come in the order of the template, so that a
/// mark within a text is left alone.
pub(crate) fn filled(template: &str, parts: &[(&str, &str)]) -> String {
    let length = parts.iter().map(|(_, text)| text.len()).sum::<usize>();
    let mut page = String::with_capacity(template.len() + length);
    let mut rest = template;
    for (mark, text) in parts {
        let (before, after) = rest.split_once(mark).unwrap_or((rest, ""));
        page.push_str(before);
        page.push_str(text);
        rest = after;
    }
    page + rest
}

/// A text as HTML.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

impl Document<'_> {
    /// The whole file.
    #[must_use]
    pub fn html(&self) -> String {
        // What could end the script element is written as an escape that JSON has for it.
        let data = self.data().to_string().replace('<', "\\u003c");
        let title = escaped(&self.title);
        filled(
            PAGE,
            &[("@TITLE@", &title), ("@STYLE@", STYLE), ("@DATA@", &data), ("@SCRIPT@", SCRIPT)],
        )
    }

    fn data(&self) -> Value {
        let centre = self.centre();
        let metrics: Vec<&Metrics> = self.meshes.iter().map(|m| m.metrics).collect();
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "title": self.title,
            "reference": self.reference.as_ref().map(|(file, sha256)| json!({
                "file": file, "sha256": sha256,
            })),
            "meshes": self.meshes.iter().map(|m| geometry::mesh(m, &centre)).collect::<Vec<_>>(),
            "fields": self.fields(),
            "table": lines(&metrics).iter().map(row).collect::<Vec<_>>(),
            "histograms": charts::histograms(&self.meshes),
            "run": self.run.as_ref().map(|run| run.json(&centre)),
        })
    }

    /// The fields that some mesh has, with the range of their heat map.
    fn fields(&self) -> Vec<Value> {
        let Some(first) = self.meshes.first() else { return Vec::new() };
        let one = |values: &FaceValues| {
            let field = values.field;
            let of = self.meshes.iter().filter_map(|m| m.inspection.field(field.key));
            let range = HeatRange::of(&of.collect::<Vec<_>>());
            json!({
                "key": field.key,
                "label": field.label,
                "unit": field.unit,
                "better": if field.better == Better::Higher { "higher" } else { "lower" },
                "low": range.low,
                "high": range.high,
            })
        };
        first.inspection.fields.iter().map(one).collect()
    }

    /// Middle of the first mesh: near it, single precision is enough for drawing.
    fn centre(&self) -> Point {
        let bounds = self.meshes.first().and_then(|m| m.mesh.bounds());
        bounds.map_or_else(Point::origin, |(low, high)| nalgebra::center(&low, &high))
    }
}

fn row(line: &Line) -> Value {
    json!({
        "key": line.metric.key,
        "group": line.metric.group,
        "label": line.metric.label,
        "unit": line.metric.unit,
        "values": line.values,
        "change": line.change.as_ref().map(|change| json!({
            "extent": change.extent, "judgement": change.judgement,
        })),
        "best": line.best,
    })
}
