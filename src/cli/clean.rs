//! `quadmend clean`: the whole way from a messy mesh to a clean one.

use std::path::{Path, PathBuf};

use clap::Args;
use quadmend::pipeline::{Report, clean};
use quadmend::report::Timing;
use quadmend::watch::{Phase, Watch};

use super::Exit;
use super::aftermath::Aftermath;
use super::failure::Failure;
use super::limits::{self, Limit};
use super::look::Look;
use super::output::MeshFormat;
use super::paths::{self, is_stream};
use super::source::{Begun, Source};
use super::stop::Patience;
use super::{output, pictures, summary};

const EXAMPLES: &str = "\
Examples:
  quadmend clean remesh.obj --reference scan.obj -o clean.obj
  quadmend clean remesh.obj -o clean.obj --preset balanced --set smooth.iterations=100
  quadmend clean remesh.obj -o clean.obj --report report.html --pictures pictures
  quadmend clean - -o - < remesh.obj > clean.obj
  quadmend clean remesh.obj -o clean.obj --json report.json --fail-if 't_junctions>0'
  quadmend clean remesh.obj -o clean.obj --log edits.toml
  quadmend edit remesh.obj --script edits.toml -o clean.obj    # the same bytes
  quadmend clean remesh.obj -o clean.obj --time-limit 60       # the best of a minute

Faults that can be mended without a doubt (torn edges, turned faces, doublets, stray vertices) are
mended first and told. Boundaries and sharp features keep their shape. The table before/after
goes to standard output, or to standard error if standard output takes the mesh or the report.";

/// Clean a mesh: cancel irregular elements and T-junctions, keep the shape
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Clean {
    /// Where the cleaned mesh goes (- for standard output); an older file is replaced when
    /// the new one is complete, but never an input unless --force is given
    #[arg(short, long, value_name = "MESH")]
    output: PathBuf,

    /// Write the report as JSON: metrics before and after, mends, edits (- for standard output)
    /// [default: none]
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

    /// Write the edits as a script with which `quadmend edit` makes the same mesh again (TOML, -
    /// for standard output) [default: none]
    #[arg(long, value_name = "FILE")]
    log: Option<PathBuf>,

    /// Write a report as a single HTML file that opens offline: both meshes in 3D, heat maps, every
    /// edit, metrics before and after [default: none]
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,

    /// Draw the mesh before and after from each view into a folder, which is made if it is not
    /// there: before-VIEW.png and after-VIEW.png, and with --heat before-VIEW-FIELD.png and
    /// after-VIEW-FIELD.png [default: none; views: corner and behind]
    #[arg(long, value_name = "DIR")]
    pictures: Option<PathBuf>,

    /// Exit with code 4 if a metric of the result is beyond a limit, for example
    /// `irregular_elements>100` or `scaled_jacobian_min<0.1`; names and units are those of
    /// `quadmend metrics --json`; may be repeated [default: no limit]
    #[arg(long, value_name = "LIMIT")]
    fail_if: Vec<Limit>,

    // Before what has a heading of its own: a heading holds for all that follows.
    #[command(flatten)]
    format: MeshFormat,

    #[command(flatten)]
    source: Source,

    #[command(flatten)]
    patience: Patience,

    #[command(flatten)]
    look: Look,
}

impl Clean {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        self.check_paths()?;
        let destination = self.format.to(&self.output)?;
        let mut begun = self.source.begin(self.patience.begin()?)?;
        let shows = self.pictures.is_some() || self.report.is_some();
        let mesh = if shows { begun.input.mesh.clone() } else { begun.take_mesh() };
        let Begun { progress, config, input, policy, .. } = &begun;
        let cleaned = clean(mesh, begun.surface(), *policy, config, progress)
            .map_err(|e| self.source.failure(e))?;
        progress.progress(Phase::Write, 0, 1, None);
        destination.write(&cleaned.mesh)?;
        if let Some(path) = &self.json {
            output::file(path, &output::json(&cleaned.report)?)?;
        }
        if let Some(path) = &self.log {
            output::file(path, &output::log(&cleaned.report.edits, &cleaned.mesh)?)?;
        }
        if shows {
            let shown = Aftermath::new((input, begun.reference.as_ref()), &cleaned, config);
            self.show(&shown, progress.timings())?;
        }
        begun.progress.finish();
        self.tell(&cleaned.report)?;
        let exit =
            limits::check(&self.fail_if, &cleaned.report.after, summary::exit(&cleaned.report));
        Ok(begun.stop.exit(exit))
    }

    /// Pictures and the report for people.
    fn show(&self, shown: &Aftermath, timings: Vec<Timing>) -> Result<(), Failure> {
        let names = [&self.source.input, &self.output].map(|path| paths::short_name(path));
        if let Some(folder) = &self.pictures {
            pictures::write(folder, &self.look, &shown.pair(&names))?;
        }
        if let Some(path) = &self.report {
            let files = [&self.source.input, &self.output].map(|path| paths::shown(path));
            let reference = self.source.reference.as_deref().map(paths::shown);
            output::file(path, &shown.html((names, files, reference), timings))?;
        }
        Ok(())
    }

    /// Everything that can be found wrong before the work is found before the work.
    fn check_paths(&self) -> Result<(), Failure> {
        self.source.check_paths(None, Some(&self.output), &self.other_outputs())?;
        if self.pictures.is_none() && !self.look.is_plain() {
            return Err(Failure::usage("options of pictures need a folder: --pictures DIR"));
        }
        self.pictures.as_deref().map_or(Ok(()), output::folder)
    }

    /// Where reports go.
    fn other_outputs(&self) -> Vec<&Path> {
        let others = [&self.json, &self.log, &self.report];
        others.into_iter().flatten().map(PathBuf::as_path).collect()
    }

    fn tell(&self, report: &Report) -> Result<(), Failure> {
        if self.source.quiet() {
            return Ok(());
        }
        output::note(summary::work(report).trim_end());
        let table = summary::table(report);
        let taken = is_stream(&self.output) || self.other_outputs().into_iter().any(is_stream);
        output::table(&table, taken)
    }
}
