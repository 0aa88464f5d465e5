//! `quadmend compare`: meshes side by side.

use std::path::{Path, PathBuf};

use clap::Args;
use quadmend::batch;
use quadmend::elements::Inspection;
use quadmend::metrics::{METRICS, Metrics, table};
use quadmend::report::{Document, Entry};
use quadmend::surface::Reference;
use serde_json::json;

use super::Exit;
use super::failure::Failure;
use super::measuring::{Measurements, Measuring};
use super::output;
use super::paths::{self, Files};

const EXAMPLES: &str = "\
Examples:
  quadmend compare remesh.obj clean.obj --reference scan.obj
  quadmend compare remesh.obj gentle.obj balanced.obj --json > all.json
  quadmend compare results/*.obj --reference scan.obj --csv > results.csv
  quadmend compare remesh.obj clean.obj --reference scan.obj --report report.html

Two meshes are read as before and after: a last column says how much each number changed and
whether that is better.";

/// Measure meshes side by side, before and after
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Compare {
    /// The mesh before (OBJ, PLY or OFF, - for standard input)
    before: PathBuf,

    /// The mesh after, and more if wanted (OBJ, PLY or OFF, - for standard input)
    #[arg(required = true)]
    after: Vec<PathBuf>,

    /// Write comma-separated values instead of a table: a row for each mesh, a column for each
    /// metric, named as in --json
    #[arg(long, conflicts_with = "json")]
    csv: bool,

    /// Also write a report as a single HTML file that opens offline: the meshes in 3D, heat maps,
    /// histograms [default: none]
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,

    /// Allow the report to replace an input
    #[arg(long)]
    force: bool,

    #[command(flatten)]
    measuring: Measuring,
}

impl Compare {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        let files: Vec<&Path> =
            std::iter::once(&self.before).chain(&self.after).map(PathBuf::as_path).collect();
        self.check_paths(&files)?;
        let measured = self.measuring.measure(&files)?;
        if let Some(path) = &self.report {
            output::file(path, &self.html(&files, &measured)?)?;
        }
        if self.report.as_deref().is_some_and(paths::is_stream) {
            return Ok(Exit::Done);
        }
        output::data(&self.text(&files, &measured)?)?;
        Ok(Exit::Done)
    }

    fn check_paths(&self, files: &[&Path]) -> Result<(), Failure> {
        let texts = self.measuring.settings.config.as_deref();
        let meshes: Vec<&Path> =
            files.iter().copied().chain(self.measuring.reference.as_deref()).collect();
        let (texts, others) = (texts.as_slice(), self.report.as_deref());
        let others = others.as_slice();
        Files { meshes: &meshes, texts, output: None, others, force: self.force }.check()
    }

    fn text(&self, files: &[&Path], measured: &Measurements) -> Result<String, Failure> {
        let metrics = measured.meshes.iter().map(|m| &m.metrics);
        if self.csv {
            return Ok(csv(files, metrics));
        }
        if self.measuring.json {
            let row = |(file, metrics): (&&Path, _)| json!({ "file": file, "metrics": metrics });
            return output::json(&files.iter().zip(metrics).map(row).collect::<Vec<_>>());
        }
        let names = paths::names(files);
        let columns: Vec<(&str, &Metrics)> =
            names.iter().map(String::as_str).zip(metrics).collect();
        Ok(table(&columns))
    }

    fn html(&self, files: &[&Path], measured: &Measurements) -> Result<String, Failure> {
        let path = self.measuring.reference.as_deref();
        let reference = measured.reference.as_ref().zip(path);
        let surface = reference.map(|(loaded, path)| {
            Reference::new(&loaded.mesh).map_err(|e| Failure::of_file(&paths::shown(path), e))
        });
        let surface = surface.transpose()?;
        let inspect = |mesh| Inspection::new(mesh, surface.as_ref(), &measured.config.features);
        let inspections: Vec<Inspection> =
            measured.meshes.iter().map(|m| inspect(&m.loaded.mesh)).collect();
        let names = paths::names(files);
        let entry = |i: usize| Entry {
            name: names[i].clone(),
            file: paths::shown(files[i]),
            sha256: Some(measured.meshes[i].loaded.sha256.clone()),
            mesh: &measured.meshes[i].loaded.mesh,
            inspection: &inspections[i],
            metrics: &measured.meshes[i].metrics,
        };
        let document = Document {
            title: names.join(" · "),
            meshes: (0..files.len()).map(entry).collect(),
            reference: reference.map(|(l, path)| (paths::shown(path), l.sha256.clone())),
            run: None,
        };
        Ok(document.html())
    }
}

/// A row for each mesh, a column for each metric; empty where there is no value.
fn csv<'a>(files: &[&Path], metrics: impl Iterator<Item = &'a Metrics>) -> String {
    let keys: Vec<&str> = METRICS.iter().map(|m| m.key).collect();
    let mut rows = vec![format!("file,{}\n", keys.join(","))];
    for (file, metrics) in files.iter().zip(metrics) {
        let cell = |value: Option<f64>| value.map(|v| v.to_string()).unwrap_or_default();
        let cells: Vec<String> = METRICS.iter().map(|m| cell((m.value)(metrics))).collect();
        rows.push(format!("{},{}\n", batch::quoted(&file.display().to_string()), cells.join(",")));
    }
    rows.concat()
}
