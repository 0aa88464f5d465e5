//! `quadmend compare`: meshes side by side.

use std::path::{Path, PathBuf};

use clap::Args;
use quadmend::metrics::{Metrics, table};
use serde_json::json;

use super::Exit;
use super::failure::Failure;
use super::measuring::Measuring;
use super::output;
use super::paths::short_name;

const EXAMPLES: &str = "\
Examples:
  quadmend compare remesh.obj clean.obj --reference scan.obj
  quadmend compare remesh.obj gentle.obj balanced.obj --json > all.json

Two meshes are read as before and after: a last column says how much each number changed and
whether that is better.";

/// Measure meshes side by side, before and after
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Compare {
    /// The mesh before (OBJ, - for standard input)
    before: PathBuf,

    /// The mesh after, and more if wanted (OBJ, - for standard input)
    #[arg(required = true)]
    after: Vec<PathBuf>,

    #[command(flatten)]
    measuring: Measuring,
}

impl Compare {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        let files: Vec<&Path> =
            std::iter::once(&self.before).chain(&self.after).map(PathBuf::as_path).collect();
        let measured = self.measuring.measure(&files)?;
        let text = if self.measuring.json {
            let row = |(file, metrics): (&&Path, _)| json!({ "file": file, "metrics": metrics });
            output::json(&files.iter().zip(&measured).map(row).collect::<Vec<_>>())?
        } else {
            let names = names(&files);
            let columns: Vec<(&str, &Metrics)> =
                names.iter().map(String::as_str).zip(&measured).collect();
            table(&columns)
        };
        output::data(&text)?;
        Ok(Exit::Done)
    }
}

/// File names, or whole paths where file names would not tell the meshes apart.
fn names(files: &[&Path]) -> Vec<String> {
    let short: Vec<String> = files.iter().map(|f| short_name(f)).collect();
    let unique = short.iter().enumerate().all(|(i, name)| !short[..i].contains(name));
    if unique { short } else { files.iter().map(|f| f.display().to_string()).collect() }
}
