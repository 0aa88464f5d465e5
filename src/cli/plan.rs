//! `quadmend plan`: the edits that `clean` would make, and what they cost.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use quadmend::pipeline::plan;
use quadmend::planner::edit::Edit;
use quadmend::planner::schedule::EditRecord;
use quadmend::report;

use super::failure::Failure;
use super::paths::is_stream;
use super::source::Source;
use super::stop::Patience;
use super::{Exit, output};

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
    /// Write the edits as a script for `quadmend edit`, which makes them (TOML, - for standard
    /// output, in place of the table) [default: none]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Write JSON instead of a table: every operation of every edit
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    source: Source,

    #[command(flatten)]
    patience: Patience,
}

impl Plan {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        self.check_paths()?;
        let mut begun = self.source.begin(self.patience.begin()?)?;
        let (mesh, surface) = (begun.take_mesh(), begun.surface());
        let planned = plan(mesh, surface, begun.policy, &begun.config, &begun.progress)
            .map_err(|e| self.source.failure(e))?;
        begun.progress.finish();
        let edits = &planned.edits;
        if let Some(path) = &self.output {
            output::file(path, &output::log(edits, &planned.mesh)?)?;
        }
        if !self.output.as_deref().is_some_and(is_stream) {
            output::data(&if self.json { output::json(edits)? } else { table(edits) })?;
        }
        let exit = if edits.is_empty() { Exit::NothingToImprove } else { Exit::Done };
        Ok(begun.stop.exit(exit))
    }

    fn check_paths(&self) -> Result<(), Failure> {
        if self.json && self.output.as_deref().is_some_and(is_stream) {
            return Err(Failure::usage("--json and `-o -` both go to standard output"));
        }
        self.source.check_paths(None, None, self.output.as_deref().as_slice())
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
