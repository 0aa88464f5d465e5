//! Why a run stopped, and the exit code that goes with it.

use std::error::Error;

use anyhow::anyhow;
use quadmend::config::ConfigError;
use quadmend::io::{ReadError, WriteError};
use quadmend::metrics::MetricsError;
use quadmend::pipeline::CleanError;
use quadmend::render::PictureError;
use quadmend::script::ScriptError;

use super::Exit;
use super::output;

/// An error on its way to the person, with its exit code.
#[derive(Debug)]
pub(super) struct Failure {
    exit: Exit,
    error: anyhow::Error,
}

impl Failure {
    /// The command line asks for something that cannot be.
    pub(super) fn usage(message: impl Into<String>) -> Self {
        Self { exit: Exit::Usage, error: anyhow!(message.into()) }
    }

    /// The same failure of the mesh called `file`.
    pub(super) fn of_file(file: &str, error: impl Error + Send + Sync + 'static) -> Self {
        Self { exit: Exit::BadInput, error: anyhow!(error).context(file.to_owned()) }
    }

    /// What went wrong, with its causes, in one line.
    pub(super) fn words(&self) -> String {
        let mut told = String::new();
        for cause in self.error.chain().map(ToString::to_string) {
            // Many errors quote their cause; nobody needs to read it twice.
            if told.is_empty() {
                told = cause;
            } else if !told.contains(&cause) {
                told = format!("{told}: {cause}");
            }
        }
        told
    }

    /// Says on standard error what went wrong, and gives the exit code.
    pub(super) fn report(&self) -> Exit {
        output::note(&format!("error: {}", self.words()));
        self.exit
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        Self { exit: Exit::BadInput, error: error.into() }
    }
}

impl From<CleanError> for Failure {
    fn from(error: CleanError) -> Self {
        Self { exit: Exit::BadInput, error: error.into() }
    }
}

impl From<ScriptError> for Failure {
    fn from(error: ScriptError) -> Self {
        let wrong_text = matches!(
            error,
            ScriptError::Syntax { .. } | ScriptError::Empty { .. } | ScriptError::Step { .. }
        );
        let exit = if wrong_text { Exit::Usage } else { Exit::BadInput };
        Self { exit, error: error.into() }
    }
}

impl From<MetricsError> for Failure {
    fn from(error: MetricsError) -> Self {
        Self { exit: Exit::BadInput, error: error.into() }
    }
}

impl From<ConfigError> for Failure {
    fn from(error: ConfigError) -> Self {
        Self { exit: Exit::Usage, error: error.into() }
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Self { exit: Exit::Usage, error: error.into() }
    }
}

impl From<PictureError> for Failure {
    fn from(error: PictureError) -> Self {
        Self { exit: Exit::Usage, error: error.into() }
    }
}
