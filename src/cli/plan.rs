//! `quadmend plan`: the edits that `clean` would make, and what they cost.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use quadmend::io;
use quadmend::mesh::MendPolicy;
use quadmend::pipeline::plan;
use quadmend::planner::edit::Edit;
use quadmend::planner::schedule::EditRecord;
use quadmend::report;
use quadmend::watch::{Phase, Watch};

use super::failure::Failure;
use super::paths::is_stream;
use super::settings::{Running, Settings};
use super::{Exit, output, paths};

const EXAMPLES: &str = "\
Examples:
  quadmend plan remesh.obj --reference scan.obj
  quadmend plan remesh.obj --set cost.type_change=2 --json > edits.json
  quadmend plan remesh.obj -o edits.toml
  quadmend edit remesh.obj --script edits.toml -o clean.obj    # what `clean` would have written

Columns: removed, irregular elements fewer; cost, of the path (weighted as in the section `cost`
of the configuration; the terms follow at the end of the line); angle, growth of the summed
deviation of corner angles around the edit, in degrees; place, in the units of the file.";

/// Show the edits that `clean` would make, with their cost terms; no mesh is written
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Plan {
    /// The mesh to plan for, polygons of any degree (OBJ, - for standard input)
    input: PathBuf,

    /// Surface to stay on, in the same position and scale (OBJ, - for standard input)
    /// [default: the input]
    #[arg(short, long, value_name = "MESH")]
    reference: Option<PathBuf>,

    /// Refuse a mesh that has anything to mend, instead of mending it [default: mend]
    #[arg(long)]
    strict: bool,

    /// Write the edits as a script for `quadmend edit`, which makes them (TOML, - for standard
    /// output, in place of the table) [default: none]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Allow the output to replace an input
    #[arg(long)]
    force: bool,

    /// Write JSON instead of a table: every operation of every edit
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    settings: Settings,

    #[command(flatten)]
    running: Running,
}

impl Plan {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        self.check_paths()?;
        let config = self.settings.load()?;
        let progress = self.running.start()?;
        progress.progress(Phase::Read, 0, 1, None);
        let mesh = progress.read(&self.input)?;
        let reference = self.reference.as_deref().map(|path| progress.read(path)).transpose()?;
        let policy = if self.strict { MendPolicy::Strict } else { MendPolicy::Mend };
        let planned = plan(mesh, reference.as_ref(), policy, &config, &progress)
            .map_err(|e| Failure::of_file(&paths::shown(&self.input), e))?;
        progress.finish();
        let edits = &planned.edits;
        if let Some(path) = &self.output {
            output::file(path, &output::log(edits, &planned.mesh)?)?;
        }
        if !self.output.as_deref().is_some_and(is_stream) {
            output::data(&if self.json { output::json(edits)? } else { table(edits) })?;
        }
        Ok(if edits.is_empty() { Exit::NothingToImprove } else { Exit::Done })
    }

    fn check_paths(&self) -> Result<(), Failure> {
        let meshes: Vec<&Path> =
            std::iter::once(&*self.input).chain(self.reference.as_deref()).collect();
        paths::read_stdin_once(&meshes)?;
        let inputs: Vec<&Path> =
            meshes.into_iter().chain(self.settings.config.as_deref()).collect();
        let outputs: Vec<&Path> = self.output.as_deref().into_iter().collect();
        paths::keep_apart(&inputs, &outputs, self.force)?;
        if self.json && self.output.as_deref().is_some_and(is_stream) {
            return Err(Failure::usage("--json and `-o -` both go to standard output"));
        }
        Ok(outputs.into_iter().try_for_each(io::check_place)?)
    }
}

fn table(edits: &[EditRecord]) -> String {
    let mut text = format!(
        "{:>5} {:>5}  {:<36} {:>7} {:>8} {:>8}  place\n",
        "edit", "round", "kind", "removed", "cost", "angle"
    );
    for (number, record) in (1..).zip(edits) {
        let [x, y, z] = record.place;
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{number:>5} {:>5}  {:<36} {:>7} {:>8.2} {:>8.1}  {x:.4} {y:.4} {z:.4}{}",
            record.round,
            report::words(&record.edit),
            record.gain,
            record.cost,
            record.angle_growth_deg,
            terms(&record.edit)
        );
    }
    text
}

fn terms(edit: &Edit) -> String {
    let Edit::Walk { terms, .. } = edit else { return String::new() };
    let words: Vec<String> = terms.iter().map(|t| format!("{} {:.2}", t.name, t.cost)).collect();
    format!("  ({})", words.join(", "))
}
