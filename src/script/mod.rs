//! Scripts: lists of edits, made one after the other on a mesh.
//!
//! A script is a TOML file of steps. What a step does is one type in `operations` and one line of
//! [`OPERATIONS`]; parsing, the list that `edit --help` shows, logging, all-or-nothing and errors
//! follow from that line. What a step is about is an [`address`]: a number, the nearest place, a
//! selection, or the result of an earlier step.
//!
//! ```toml
//! [[step]]
//! do = "cancel-t-junctions"
//! at = { nearest = [0.1, 0.2, 0.3] }
//!
//! [[step]]
//! do = "smooth"
//! ```
//! What [`log`] writes is a script, too: the edits of a cleaned mesh, which make the same mesh again.
//!
//! *Invariant:* a step is made whole or not at all, and so is a script unless it keeps going.

pub mod address;
mod error;
mod log;
mod operations;
mod run;
mod session;

pub use error::{ScriptError, StepError, Trouble};
pub use log::log;
pub use operations::{OPERATIONS, OperationKind};
pub use run::{Done, Edited, StepRecord, edit};
pub use session::Session;

use operations::Operation;
use serde::Deserialize;
use std::ops::Range;
use toml::{Spanned, Table, Value};

/// A list of edits, checked as far as that goes without a mesh.
#[derive(Debug)]
pub struct Script {
    steps: Vec<Step>,
}

/// One edit of a script.
#[derive(Debug)]
struct Step {
    /// What it does, as it is written.
    name: &'static str,
    /// Line of the script, from 1.
    line: usize,
    operation: Box<dyn Operation>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Raw {
    #[serde(default)]
    step: Vec<Spanned<Table>>,
}

impl Script {
    /// Reads a script; `file` is what errors call it.
    pub fn parse(text: &str, file: &str) -> Result<Self, ScriptError> {
        let raw: Raw = toml::from_str(text).map_err(|error| {
            let line = line_of(text, error.span().map_or(0, |span| span.start));
            ScriptError::Syntax { file: file.to_owned(), line, message: first_line(&error) }
        })?;
        if raw.step.is_empty() {
            return Err(ScriptError::Empty { file: file.to_owned() });
        }
        let (mut line, mut counted) = (1, 0);
        let steps = raw.step.into_iter().enumerate().map(|(i, table)| {
            // Steps come in the order of the text: each line break is counted once.
            let start = table.span().start.max(counted);
            line += breaks(text, counted..start);
            counted = start;
            step(table.into_inner(), line).map_err(|message| ScriptError::Step {
                file: file.to_owned(),
                line,
                number: i + 1,
                message,
            })
        });
        Ok(Self { steps: steps.collect::<Result<_, _>>()? })
    }

    /// Number of steps.
    #[must_use]
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Whether there are no steps.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }
}

fn step(mut table: Table, line: usize) -> Result<Step, String> {
    let Some(Value::String(name)) = table.remove("do") else {
        return Err("a step needs a word for what to do: do = \"…\"".to_owned());
    };
    let kind = OPERATIONS.iter().find(|kind| kind.name == name).ok_or_else(|| {
        let names = OPERATIONS.iter().map(|kind| kind.name);
        let nearest = crate::config::nearest(&name, names).unwrap_or_default();
        format!("there is no operation `{name}`; did you mean `{nearest}`?")
    })?;
    let operation =
        (kind.parse)(table).map_err(|error| format!("{name}: {}", first_line(&error)))?;
    Ok(Step { name: kind.name, line, operation })
}

fn line_of(text: &str, at: usize) -> usize {
    1 + breaks(text, 0..at)
}

fn breaks(text: &str, part: Range<usize>) -> usize {
    text.get(part).unwrap_or_default().matches('\n').count()
}

/// The message without the excerpt that TOML errors carry.
fn first_line(error: &toml::de::Error) -> String {
    error.message().lines().next().unwrap_or_default().to_owned()
}
