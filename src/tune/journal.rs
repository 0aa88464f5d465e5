//! The journal of a search: one line of JSON that says what is searched, then one for each trial.
//!
//! Lines are added as trials end, in any order, so that an interruption loses no trial that was
//! over. A last line that was cut off by it is dropped.

use super::objective::Measures;
use super::space::Space;
use super::task::Task;
use super::{Case, TuneError};
use crate::config::Config;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// What makes two searches the same: with it, trials follow from one another.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// The program that searches.
    pub version: String,
    /// The task, without its space.
    pub task: Task,
    /// The space.
    pub space: Space,
    /// The configuration that the search starts from.
    pub start: Config,
    /// SHA-256 of the meshes and their references.
    pub meshes: Vec<[String; 2]>,
}

impl Head {
    /// Of the search for `task` from `start` on, on the meshes of `cases`.
    pub(super) fn new(task: &Task, space: &Space, start: &Config, cases: &[Case]) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            // Its ranges may say the same in different words.
            task: Task { space: toml::map::Map::new(), ..task.clone() },
            space: space.clone(),
            start: start.clone(),
            meshes: cases.iter().map(|c| c.sha256.clone()).collect(),
        }
    }
}

/// A trial that is over.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Its number; 0 is the start.
    pub number: usize,
    /// What the knobs of the space were set to.
    pub values: Vec<f64>,
    /// What came of each mesh.
    pub measures: Vec<Measures>,
}

/// A journal that trials are added to.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    /// The trials that it holds, by number.
    pub(super) trials: BTreeMap<usize, Trial>,
}

impl Journal {
    /// Opens the journal of the search that `head` describes, or begins it.
    pub(super) fn open(path: &Path, head: &Head) -> Result<Self, TuneError> {
        let wrong = |source| TuneError::Journal { file: path.to_owned(), source };
        let text = match std::fs::read_to_string(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
            read => read.map_err(wrong)?,
        };
        // What was cut off has no line break.
        let whole = text.rfind('\n').map_or(0, |at| at + 1);
        let trials = read(path, &text[..whole], head)?;
        let mut file = OpenOptions::new().create(true).append(true).open(path).map_err(wrong)?;
        file.set_len(whole as u64).map_err(wrong)?;
        if whole == 0 {
            writeln!(file, "{}", line(head)).map_err(wrong)?;
        }
        Ok(Self { path: path.to_owned(), file, trials })
    }

    /// Adds a trial, and brings it to the disk.
    pub(super) fn add(&mut self, trial: Trial) -> Result<(), TuneError> {
        let line = line(&trial) + "\n";
        // In one piece: a line that is cut off is cut off at its end.
        let done = self.file.write_all(line.as_bytes()).and_then(|()| self.file.sync_data());
        done.map_err(|source| TuneError::Journal { file: self.path.clone(), source })?;
        self.trials.insert(trial.number, trial);
        Ok(())
    }
}

fn line(value: &impl Serialize) -> String {
    // Numbers, lists and texts, all of which JSON can say.
    serde_json::to_string(value).unwrap_or_default()
}

/// The trials of a text, if it is the journal of this search.
fn read(path: &Path, text: &str, head: &Head) -> Result<BTreeMap<usize, Trial>, TuneError> {
    let damaged = |number: usize| {
        let file = path.to_owned();
        move |e: serde_json::Error| TuneError::DamagedJournal {
            file,
            line: number,
            message: e.to_string(),
        }
    };
    let mut lines = (1..).zip(text.lines());
    if let Some((number, line)) = lines.next() {
        let old: Value = serde_json::from_str(line).map_err(damaged(number))?;
        let new = serde_json::to_value(head).map_err(damaged(number))?;
        if let Some(what) = difference(&old, &new) {
            return Err(TuneError::OtherSearch { file: path.to_owned(), what });
        }
    }
    lines
        .map(|(number, line)| {
            let trial: Trial = serde_json::from_str(line).map_err(damaged(number))?;
            Ok((trial.number, trial))
        })
        .collect()
}

/// The first place where two values differ, in words.
fn difference(old: &Value, new: &Value) -> Option<String> {
    match (old, new) {
        (Value::Object(a), Value::Object(b)) => {
            let keys = a.keys().chain(b.keys().filter(|key| !a.contains_key(*key)));
            let (null, mut keys) = (Value::Null, keys);
            keys.find_map(|key| {
                let inner = difference(a.get(key).unwrap_or(&null), b.get(key).unwrap_or(&null))?;
                Some(if inner.starts_with(": ") {
                    format!("{key}{inner}")
                } else {
                    format!("{key}.{inner}")
                })
            })
        }
        _ if old == new => None,
        _ => Some(format!(": {old} there, {new} here")),
    }
}
