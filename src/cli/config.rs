//! `quadmend config`: what can be tuned, and to what it is set.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use quadmend::config::{Config, SECTIONS, explain, schema};

use super::Exit;
use super::failure::Failure;
use super::output;
use super::settings::Settings;

const EXAMPLES: &str = "\
Examples:
  quadmend config show > my.toml            a file to start from, every knob explained
  quadmend config check my.toml             is it right?
  quadmend config explain smooth.iterations what does this knob do?
  quadmend config schema > schema.json      for editors that complete TOML";

/// Show, check and explain the configuration
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct ConfigCommand {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Write the configuration as TOML, every knob with its meaning, unit, range and default
    Show {
        #[command(flatten)]
        settings: Settings,

        /// Write the values only, without comments
        #[arg(long)]
        bare: bool,
    },
    /// Check configuration files; the first error is told with its file and line
    Check {
        /// The files (TOML)
        #[arg(required = true)]
        files: Vec<PathBuf>,
    },
    /// Write the JSON schema of configuration files
    Schema,
    /// Say what sections and knobs mean
    Explain {
        /// A section (smooth), a knob (smooth.iterations), or a knob without its section
        /// [default: the list of sections]
        name: Option<String>,
    },
}

impl ConfigCommand {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        let text = match &self.action {
            Action::Show { settings, bare: false } => settings.load()?.to_toml_commented(),
            Action::Show { settings, bare: true } => settings.load()?.to_toml(),
            Action::Check { files } => check(files)?,
            Action::Schema => output::json(&schema())?,
            Action::Explain { name: Some(name) } => explain(name)?,
            Action::Explain { name: None } => sections(),
        };
        output::data(&text)?;
        Ok(Exit::Done)
    }
}

fn check(files: &[PathBuf]) -> Result<String, Failure> {
    let one = |file: &PathBuf| {
        Config::load(None, Some(file), &[] as &[&str])?;
        Ok(format!("{}: right\n", file.display()))
    };
    files.iter().map(one).collect()
}

fn sections() -> String {
    let lines = SECTIONS.iter().map(|s| format!("{:<10} {}", s.name, s.about.trim()));
    lines.collect::<Vec<_>>().join("\n") + "\n"
}
