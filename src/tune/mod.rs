//! The tuner: searches the configuration for what is best on some meshes.
//!
//! A [`Task`] says which knobs are turned ([`space`]), what counts ([`objective`]) and how trials
//! are chosen. Trial 0 is the configuration that the search starts from; all others are judged
//! relative to it. Trials of a generation are chosen together and run at the same time; they are
//! looked at in the order of their numbers, so the search is the same for any number of threads.
//! The [`journal`] holds every trial: a search that was interrupted goes on as if it had not been.

mod choice;
pub mod journal;
pub mod objective;
mod page;
mod plot;
mod search;
pub mod space;
pub mod task;

pub use page::page;
pub use search::{Findings, Judged, Observer, search};
pub use task::{Goal, Task};

use crate::config::ConfigError;
use crate::mesh::PolyMesh;
use crate::metrics::MetricsError;
use crate::pipeline::CleanError;
use std::path::PathBuf;
use thiserror::Error;

/// A mesh to try configurations on.
#[derive(Debug, Clone)]
pub struct Case {
    /// The file it was read from.
    pub file: String,
    /// SHA-256 of the mesh and of its reference, empty if it has none.
    pub sha256: [String; 2],
    /// The mesh.
    pub mesh: PolyMesh,
    /// The surface to stay on, if it is not the mesh.
    pub reference: Option<PolyMesh>,
}

/// Why a search stopped.
#[derive(Debug, Error)]
pub enum TuneError {
    /// The task cannot be read.
    #[error("{name}: {message}")]
    Task {
        /// What was read.
        name: String,
        /// What is wrong with it.
        message: String,
    },
    /// A knob or its value is wrong.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// There is nothing to vary.
    #[error("the space has no knob: name one, as in `\"cost.step\" = {{ low = 0.1, high = 10 }}`")]
    NoKnob,
    /// What cannot be varied.
    #[error(
        "`{key}` is not a number that can be varied; name a knob with its section, as cost.step"
    )]
    NoNumber {
        /// What was named.
        key: String,
    },
    /// A range that the knob does not have.
    #[error("`{key}` from {low} to {high}: its range goes upwards and lies from {min} to {max}")]
    Range {
        /// The knob.
        key: String,
        /// What was given.
        low: f64,
        /// What was given.
        high: f64,
        /// What is allowed.
        min: f64,
        /// What is allowed.
        max: f64,
    },
    /// Ratios to nothing.
    #[error("`{key}` from {low}: where ratios count, values must be more than 0; give a `low`")]
    LogRange {
        /// The knob.
        key: String,
        /// What was given.
        low: f64,
    },
    /// No meshes.
    #[error("there is no mesh to try configurations on")]
    NoMesh,
    /// A mesh cannot be cleaned.
    #[error("{file}: {source}")]
    Mesh {
        /// The file.
        file: String,
        /// Why.
        source: CleanError,
    },
    /// A mesh cannot be measured.
    #[error("{file}: {source}")]
    Measure {
        /// The file.
        file: String,
        /// Why.
        source: MetricsError,
    },
    /// The journal cannot be read or written.
    #[error("{}: the journal cannot be used: {source}", file.display())]
    Journal {
        /// The file.
        file: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A line of the journal is none.
    #[error("{}:{line}: this is no line of a journal ({message}); remove it", file.display())]
    DamagedJournal {
        /// The file.
        file: PathBuf,
        /// The line, from 1.
        line: usize,
        /// What the JSON reader says.
        message: String,
    },
    /// The journal of another search.
    #[error(
        "{} is the journal of another search ({what}); repeat what it was begun with, or name \
         another folder",
        file.display()
    )]
    OtherSearch {
        /// The file.
        file: PathBuf,
        /// What differs.
        what: String,
    },
    /// The estimator refuses what it was told: a bug of this program.
    #[error("no trial could be chosen ({0}); please report this with the journal")]
    Sampler(parzen::ParzenError),
}
