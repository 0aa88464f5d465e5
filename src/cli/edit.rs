//! `quadmend edit`: chosen edits, one after the other, from a script.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use quadmend::script::{Edited, OPERATIONS, Script, StepError, StepRecord, edit};
use quadmend::watch::{Phase, Watch};
use serde::Serialize;

use super::failure::Failure;
use super::output::MeshFormat;
use super::source::Source;
use super::stop::Stop;
use super::{Exit, output};

const EXAMPLES: &str = "\
Examples:
  quadmend edit remesh.obj --script edits.toml -o edited.obj
  quadmend edit remesh.obj --script edits.toml --dry-run
  quadmend edit remesh.obj --reference scan.obj --script edits.toml -o edited.obj --keep-going

A script is a list of steps:
  [[step]]
  do = \"cancel-t-junctions\"                  # the T-junction nearest to a place,
  at = { nearest = [0.1, 0.2, 0.3] }         # with the one nearest to it
  [[step]]
  do = \"move-t-junction\"
  at = { all = \"t-junctions\", within = { center = [0, 0, 0], radius = 0.5 } }
  to = \"up\"
  [[step]]
  do = \"smooth\"

An address is one of
  { vertex = 12 }  { face = 7 }                numbers of the file, from 1
  { nearest = [x, y, z] }                      the nearest of what the step is about
  { nearest = [x, y, z], kind = \"v5\" }
  { all = \"t-junctions\" }                      a selection, for steps that take several;
     within = { center = [x, y, z], radius = r } or { min = […], max = […] }
  { step = 2, result = 1 }                     what an earlier step left
Kinds: vertices, faces, elements, irregular, v3, v5, f3, f5, t-junctions, duals, dislocations, six.
An edge is { vertices = [3, 7] } or { nearest = [x, y, z] }.
A path is a list of addresses that it leads through: path = [{ face = 7 }, { vertex = 12 }].";

/// Make chosen edits: the operations of the paper, from a script
#[derive(Debug, Args)]
#[command(after_help = help())]
pub(super) struct Edit {
    /// The list of edits (TOML)
    #[arg(short, long, value_name = "FILE")]
    script: PathBuf,

    /// Where the edited mesh goes (- for standard output); an older file is replaced when the
    /// new one is complete, but never an input unless --force is given
    #[arg(short, long, value_name = "MESH", required_unless_present = "dry_run")]
    output: Option<PathBuf>,

    #[command(flatten)]
    caution: Caution,

    /// Write a log as JSON, with the operations of every step (- for standard output)
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

    #[command(flatten)]
    format: MeshFormat,

    #[command(flatten)]
    source: Source,
}

/// What becomes of a script that does not go through.
#[derive(Debug, Args)]
struct Caution {
    /// Make the edits and tell what came of them, but write no mesh
    #[arg(long)]
    dry_run: bool,

    /// Pass over what is refused instead of giving up; without it, nothing is written unless every
    /// step is made
    #[arg(long)]
    keep_going: bool,
}

#[derive(Serialize)]
struct Log<'a> {
    steps: &'a [StepRecord],
    refused: Vec<String>,
}

impl Edit {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        self.check_paths()?;
        let output = self.output.as_deref().map(|path| self.format.to(path)).transpose()?;
        let script = self.read_script()?;
        let mut begun = self.source.begin(Stop::default())?;
        let (mesh, surface) = (begun.take_mesh(), begun.surface());
        let options = (&begun.config, self.caution.keep_going);
        let edited = edit(mesh, surface, begun.policy, &script, options, &begun.progress)?;
        if let Some(destination) = output.filter(|_| !self.caution.dry_run) {
            begun.progress.progress(Phase::Write, 0, 1, None);
            destination.write(&edited.mesh)?;
        }
        begun.progress.finish();
        self.tell(&edited)?;
        Ok(if edited.steps.is_empty() { Exit::NothingToImprove } else { Exit::Done })
    }

    fn read_script(&self) -> Result<Script, Failure> {
        let shown = self.script.display().to_string();
        let text = std::fs::read_to_string(&self.script)
            .map_err(|error| Failure::usage(format!("{shown}: cannot be read: {error}")))?;
        Ok(Script::parse(&text, &shown)?)
    }

    /// Everything that can be found wrong before the work is found before the work.
    fn check_paths(&self) -> Result<(), Failure> {
        let json = self.json.as_deref();
        self.source.check_paths(Some(&self.script), self.output.as_deref(), json.as_slice())
    }

    fn tell(&self, edited: &Edited) -> Result<(), Failure> {
        if !self.source.quiet() {
            output::note(log(edited).trim_end());
        }
        let Some(path) = &self.json else { return Ok(()) };
        let refused = edited.refused.iter().map(StepError::to_string).collect();
        let log = Log { steps: &edited.steps, refused };
        output::file(path, &output::json(&log)?)
    }
}

/// The steps one by one, then what was refused.
fn log(edited: &Edited) -> String {
    let mut text = String::new();
    for StepRecord { step, operation, done, before, after, ops, refills } in &edited.steps {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "step {step}: {operation}: {done} (E {before} → {after}, {} operations)",
            ops.len() + refills.len()
        );
    }
    for error in &edited.refused {
        let _ = writeln!(text, "refused: {error}");
    }
    text
}

fn help() -> String {
    let lines = OPERATIONS.iter().map(|kind| format!("  {:<20} {}\n", kind.name, kind.about));
    format!("{EXAMPLES}\n\nOperations and their keys:\n{}", lines.collect::<String>())
}
