//! What can be wrong with a configuration, and where it was said.

use std::fmt;
use std::path::PathBuf;
use thiserror::Error;

/// Where a value comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// A file, or a preset under its name, and the line from 1.
    Line {
        /// Name of the file.
        file: String,
        /// The line, from 1.
        line: usize,
    },
    /// An assignment of the command line.
    Assignment(String),
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line { file, line } => write!(f, "{file}:{line}"),
            Self::Assignment(text) => write!(f, "--set {text}"),
        }
    }
}

/// A value that a knob does not take.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct IllegalValue {
    /// Where it was said.
    pub origin: Origin,
    /// The knob with its section.
    pub key: String,
    /// What was written.
    pub value: String,
    /// What would be legal, with range and unit.
    pub expected: String,
    /// The nearest legal value; the default for a value of another kind.
    pub nearest: String,
}

/// Why there is no configuration.
#[derive(Debug, Error)]
pub enum ConfigError {
    /// The file can not be read.
    #[error("{}: the configuration can not be read: {source}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The text is no TOML.
    #[error("{origin}: {message}")]
    Syntax {
        /// Where.
        origin: Origin,
        /// What the TOML reader says.
        message: String,
    },
    /// An assignment has no `=` or no dot.
    #[error("--set {text}: an assignment looks like section.key=value")]
    NotAnAssignment {
        /// What was given.
        text: String,
    },
    /// There is no such preset.
    #[error("there is no preset `{name}`; did you mean `{nearest}`? (there are: {known})")]
    UnknownPreset {
        /// What was asked for.
        name: String,
        /// The most similar preset.
        nearest: String,
        /// All presets.
        known: String,
    },
    /// There is no such section.
    #[error("{origin}: there is no section `{section}`; did you mean `{nearest}`?")]
    UnknownSection {
        /// Where.
        origin: Origin,
        /// What was written.
        section: String,
        /// The most similar section, or the full name of the knob that has this name.
        nearest: String,
    },
    /// The section has no such knob.
    #[error("{origin}: there is no knob `{section}.{key}`; did you mean `{nearest}`?")]
    UnknownKey {
        /// Where.
        origin: Origin,
        /// The section.
        section: String,
        /// What was written.
        key: String,
        /// The most similar knob, with its section.
        nearest: String,
    },
    /// A value of another kind than the knob takes.
    #[error("{}: `{}` takes {}, not {}", .0.origin, .0.key, .0.expected, .0.value)]
    WrongType(Box<IllegalValue>),
    /// A value that the knob does not allow.
    #[error(
        "{}: `{}` = {} is out of range: it takes {}; the nearest legal value is {}",
        .0.origin, .0.key, .0.value, .0.expected, .0.nearest
    )]
    OutOfRange(Box<IllegalValue>),
    /// There is neither a section nor a knob of this name.
    #[error("there is no section or knob `{name}`; did you mean `{nearest}`?")]
    UnknownName {
        /// What was asked for.
        name: String,
        /// The most similar section or knob.
        nearest: String,
    },
    /// Values that are legal one by one, but that the section does not take.
    #[error("{origin}: {message}")]
    Rejected {
        /// Where.
        origin: Origin,
        /// What the section says.
        message: String,
    },
}
