//! `quadmend generate`: manual page and shell completions, from the same source as `--help`.

use clap::{Args, CommandFactory, Subcommand};
use clap_complete::Shell;

use super::failure::Failure;
use super::output;
use super::{Cli, Exit};

/// Write the manual page or shell completions
#[derive(Debug, Args)]
pub(super) struct Generate {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Write the manual page (roff); read it with `quadmend generate man | man -l -`
    Man,
    /// Write completions for a shell
    Completions {
        /// The shell
        shell: Shell,
    },
}

impl Generate {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        let (mut command, mut text) = (Cli::command(), Vec::new());
        match self.what {
            What::Man => clap_mangen::Man::new(command)
                .render(&mut text)
                .map_err(|e| Failure::usage(format!("the manual page cannot be made: {e}")))?,
            What::Completions { shell } => {
                clap_complete::generate(shell, &mut command, "quadmend", &mut text);
            }
        }
        output::data(&String::from_utf8_lossy(&text))?;
        Ok(Exit::Done)
    }
}
