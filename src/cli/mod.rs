//! The command line: one file a command.
//!
//! Standard output carries data only (what a command is asked for); progress, warnings and errors
//! go to standard error. A command returns its [`Exit`] or a [`Failure`] that knows its own.
//!
//! *Invariant:* this is the only place that prints, looks at the clock or at the terminal.

mod aftermath;
mod batch;
mod clean;
mod compare;
mod config;
mod convert;
mod demo;
mod edit;
mod failure;
mod generate;
mod limits;
mod look;
mod measuring;
mod metrics;
mod optimize;
mod output;
mod paths;
mod pictures;
mod plan;
mod progress;
mod render;
mod settings;
mod source;
mod stop;
mod summary;
mod tune;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use failure::Failure;

/// How a run ended, as the exit code that scripts see.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Exit {
    /// Everything asked for was done.
    Done = 0,
    /// There was nothing to improve; the output was written all the same.
    NothingToImprove = 1,
    /// The command line, the configuration or the place for the output is wrong.
    Usage = 2,
    /// A mesh is missing, damaged or refused.
    BadInput = 3,
    /// A limit of `--fail-if` was missed, or not every face could be made a quad; the output was
    /// written all the same.
    LimitMissed = 4,
    /// Somebody ended the run; what it had by then was written.
    Interrupted = 130,
}

const EXIT_CODES: &str = "\
Exit codes:
  0  done
  1  nothing to improve (the output is written all the same)
  2  usage or configuration
  3  bad input; nothing is written (`batch`: not every mesh could be cleaned)
  4  a limit given with --fail-if was missed, or not every face could be made a quad (the output
     is written all the same)
130  interrupted: the best mesh so far is written (nothing is after a second interrupt)";

const EXAMPLES: &str = "\
Examples:
  quadmend demo                                             try it on the sample mesh
  quadmend clean remesh.obj --reference scan.obj -o clean.obj
  quadmend batch 'in/*.obj' --out cleaned                   clean many
  quadmend metrics remesh.obj                               what is wrong with it?
  quadmend compare remesh.obj clean.obj --reference scan.obj
  quadmend edit remesh.obj --script edits.toml -o edited.obj   make chosen edits
  quadmend render remesh.obj clean.obj -o both.png          how does it look?
  quadmend tune remesh.obj -r scan.obj -o tuning            which settings suit it best?
  quadmend config explain smooth                            what can be tuned?";

/// Cleans the connectivity of quad-dominant meshes: irregular vertices and faces and T-junctions
/// are moved in pairs until they cancel, and the shape is kept.
#[derive(Debug, Parser)]
#[command(version, max_term_width = 100, arg_required_else_help = true)]
#[command(after_help = format!("{EXAMPLES}\n\n{EXIT_CODES}"))]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Clean(clean::Clean),
    Batch(batch::Batch),
    Metrics(metrics::MetricsCommand),
    Compare(compare::Compare),
    Plan(plan::Plan),
    Edit(edit::Edit),
    Convert(convert::Convert),
    Optimize(optimize::Optimize),
    Render(render::Render),
    Tune(tune::Tune),
    Demo(demo::Demo),
    Config(config::ConfigCommand),
    Generate(generate::Generate),
}

/// Parses, runs, and says what went wrong.
pub(crate) fn main() -> ExitCode {
    let exit = run(&Cli::parse().command).unwrap_or_else(|failure| failure.report());
    ExitCode::from(exit as u8)
}

fn run(command: &Command) -> Result<Exit, Failure> {
    match command {
        Command::Clean(command) => command.run(),
        Command::Batch(command) => command.run(),
        Command::Metrics(command) => command.run(),
        Command::Compare(command) => command.run(),
        Command::Plan(command) => command.run(),
        Command::Edit(command) => command.run(),
        Command::Convert(command) => command.run(),
        Command::Optimize(command) => command.run(),
        Command::Render(command) => command.run(),
        Command::Tune(command) => command.run(),
        Command::Demo(command) => command.run(),
        Command::Config(command) => command.run(),
        Command::Generate(command) => command.run(),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_well_formed() {
        super::Cli::command().debug_assert();
    }
}
