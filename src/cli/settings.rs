//! Options that several commands share.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use quadmend::config::{Config, PRESETS};

use super::failure::Failure;
use super::progress::Progress;
use super::stop::Stop;

/// Where the values of the knobs come from: defaults ← preset ← file ← assignments.
#[derive(Debug, Args)]
#[command(next_help_heading = "Configuration (later ones win: preset, file, assignments)")]
pub(super) struct Settings {
    /// Start from a named configuration [default: default]
    #[arg(long, value_name = "NAME", value_parser = presets())]
    preset: Option<String>,

    /// Read values from a TOML file (make one with `quadmend config show`) [default: none]
    #[arg(long, value_name = "FILE")]
    pub(super) config: Option<PathBuf>,

    /// Set one knob, for example smooth.iterations=100; may be repeated [default: none]
    #[arg(long = "set", value_name = "SECTION.KEY=VALUE")]
    assignments: Vec<String>,
}

fn presets() -> PossibleValuesParser {
    PRESETS.iter().map(|(name, _)| *name).collect::<Vec<_>>().into()
}

impl Settings {
    /// Loads and checks the configuration.
    pub(super) fn load(&self) -> Result<Config, Failure> {
        let file = self.config.as_deref();
        Ok(Config::load(self.preset.as_deref(), file, &self.assignments)?)
    }
}

/// How a long run behaves.
#[derive(Debug, Args)]
#[command(next_help_heading = "Running")]
pub(super) struct Running {
    /// Threads to compute with; the result is the same for any number [default: all cores]
    #[arg(short = 'j', long, value_name = "N")]
    threads: Option<NonZeroUsize>,

    /// Show nothing but errors
    #[arg(short, long, conflicts_with = "verbose")]
    pub(super) quiet: bool,

    /// Also show how long each phase took, in seconds
    #[arg(short, long)]
    verbose: bool,
}

impl Running {
    /// Sets the number of threads and gives what watches the run until it is over or to `stop`.
    pub(super) fn start(&self, stop: Stop) -> Result<Progress, Failure> {
        if let Some(threads) = self.threads {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.get());
            pool.build_global().map_err(|e| {
                Failure::usage(format!("cannot compute with {threads} threads: {e}"))
            })?;
        }
        Ok(Progress::new(self.quiet, self.verbose, stop))
    }
}
