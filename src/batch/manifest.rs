//! The manifest: one line of JSON for each mesh, written as soon as the mesh is done.
//!
//! A line says what went in (hashes of mesh, reference and settings) and what came out; so a batch
//! that is started again knows which meshes are done and unchanged. While a batch runs, lines are
//! only appended, so that a run that dies loses nothing; the last line about a mesh counts.

use crate::io::{WriteError, write_atomically};
use crate::metrics::{METRICS, Metrics};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// What became of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// It was mended or edited.
    Cleaned,
    /// Neither a mend nor an edit was needed, or found.
    NothingToImprove,
    /// Its time was over; the best mesh by then was written.
    TimeLimit,
    /// The batch was interrupted; the best mesh by then was written.
    Interrupted,
    /// It or its reference cannot be read or used.
    Refused,
    /// It would need more memory than there is.
    TooLarge,
    /// The program failed on it: a bug.
    Crashed,
}

impl Status {
    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Cleaned => "cleaned",
            Self::NothingToImprove => "nothing to improve",
            Self::TimeLimit => "time limit",
            Self::Interrupted => "interrupted",
            Self::Refused => "refused",
            Self::TooLarge => "too large",
            Self::Crashed => "crashed",
        }
    }

    /// Whether a mesh was written.
    #[must_use]
    pub fn has_mesh(self) -> bool {
        !self.has_failed()
    }

    /// Whether there is an error in place of a mesh.
    #[must_use]
    pub fn has_failed(self) -> bool {
        matches!(self, Self::Refused | Self::TooLarge | Self::Crashed)
    }
}

/// What goes into a result: if it is the same again, so is the result.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    /// SHA-256 of the mesh file.
    pub input_sha256: String,
    /// SHA-256 of the file of its reference, if it has one.
    pub reference_sha256: Option<String>,
    /// SHA-256 of all settings.
    pub config_sha256: String,
    /// Version of the program.
    pub version: String,
}

/// A line: one mesh.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// File of the mesh, as it was named.
    pub input: String,
    /// File of its reference.
    pub reference: Option<String>,
    /// What it was made from; `None` if a file could not be read.
    #[serde(flatten)]
    pub source: Option<Source>,
    /// What became of it.
    pub status: Status,
    /// What went wrong, if something did.
    pub error: Option<String>,
    /// File of the result, within the folder of the batch.
    pub output: Option<String>,
    /// SHA-256 of the result.
    pub output_sha256: Option<String>,
    /// The time that it had, if that was limited.
    pub time_limit_s: Option<f64>,
    /// The time that it took.
    pub seconds: f64,
    /// Metrics before, by their keys.
    pub before: BTreeMap<String, f64>,
    /// Metrics after.
    pub after: BTreeMap<String, f64>,
}

impl Entry {
    /// Whether this is a result for the same source and at least as much time.
    #[must_use]
    pub fn is_result_of(&self, source: &Source, time_limit_s: Option<f64>) -> bool {
        let done = match self.status {
            Status::Cleaned | Status::NothingToImprove => true,
            // More time might give a better mesh.
            Status::TimeLimit => {
                let had = self.time_limit_s.unwrap_or(f64::INFINITY);
                time_limit_s.is_some_and(|limit| limit <= had)
            }
            _ => false,
        };
        done && self.source.as_ref() == Some(source)
    }
}

/// The numbers of a mesh, by the keys of the metrics; what is undefined is left out.
#[must_use]
pub fn numbers(metrics: &Metrics) -> BTreeMap<String, f64> {
    let number = |m: &crate::metrics::Metric| {
        let value = (m.value)(metrics).filter(|v| v.is_finite())?;
        Some((m.key.to_owned(), value))
    };
    METRICS.iter().filter_map(number).collect()
}

/// A manifest on disk.
#[derive(Debug)]
pub struct Manifest {
    path: PathBuf,
    known: BTreeMap<String, Entry>,
    file: File,
}

impl Manifest {
    /// Opens the manifest at `path`, or begins one. A line that cannot be read (a run that died
    /// while it wrote it, another version) is as good as none.
    pub fn open(path: &Path) -> io::Result<Self> {
        let text = match fs::read_to_string(path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            text => text.unwrap_or_default(),
        };
        let lines = text.lines().filter_map(|line| serde_json::from_str::<Entry>(line).ok());
        let known = lines.map(|entry| (entry.input.clone(), entry)).collect();
        let mut file = OpenOptions::new().create(true).append(true).open(path)?;
        if !text.is_empty() && !text.ends_with('\n') {
            file.write_all(b"\n")?;
        }
        Ok(Self { path: path.to_owned(), known, file })
    }

    /// What is known about a mesh.
    #[must_use]
    pub fn get(&self, input: &str) -> Option<&Entry> {
        self.known.get(input)
    }

    /// Adds a line.
    pub fn add(&mut self, entry: Entry) -> io::Result<()> {
        self.file.write_all(line(&entry)?.as_bytes())?;
        self.known.insert(entry.input.clone(), entry);
        Ok(())
    }

    /// Writes it anew with one line for each mesh, ordered by name, and gives the lines.
    pub fn finish(self) -> Result<Vec<Entry>, WriteError> {
        let entries: Vec<Entry> = self.known.into_values().collect();
        write_atomically(&self.path, |out| {
            entries.iter().try_for_each(|entry| out.write_all(line(entry)?.as_bytes()))
        })?;
        Ok(entries)
    }
}

fn line(entry: &Entry) -> io::Result<String> {
    Ok(serde_json::to_string(entry)? + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(input: &str) -> Source {
        Source {
            input_sha256: input.into(),
            reference_sha256: None,
            config_sha256: "c".into(),
            version: "1".into(),
        }
    }

    fn entry(input: &str, status: Status, time_limit_s: Option<f64>) -> Entry {
        Entry {
            input: input.into(),
            reference: None,
            source: Some(source(input)),
            status,
            error: None,
            output: None,
            output_sha256: None,
            time_limit_s,
            seconds: 0.25,
            before: BTreeMap::from([("F".into(), 12.0)]),
            after: BTreeMap::new(),
        }
    }

    #[test]
    fn the_last_line_about_a_mesh_counts_and_torn_lines_do_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("manifest.jsonl");
        let mut manifest = Manifest::open(&path).unwrap();
        for (input, status) in
            [("b", Status::Crashed), ("a", Status::Cleaned), ("b", Status::Cleaned)]
        {
            manifest.add(entry(input, status, None)).unwrap();
        }
        drop(manifest);
        let torn = fs::read_to_string(&path).unwrap() + "{\"input\":\"c\",\"sta";
        fs::write(&path, torn).unwrap();
        let mut manifest = Manifest::open(&path).unwrap();
        assert_eq!(manifest.get("b"), Some(&entry("b", Status::Cleaned, None)));
        assert_eq!(manifest.get("c"), None);
        manifest.add(entry("d", Status::Refused, None)).unwrap();
        let names: Vec<String> =
            manifest.finish().unwrap().into_iter().map(|entry| entry.input).collect();
        assert_eq!(names, ["a", "b", "d"]);
        assert_eq!(fs::read_to_string(&path).unwrap().lines().count(), 3);
    }

    #[test]
    fn only_results_of_the_same_source_with_enough_time_count() {
        let of = |status, had, limit| entry("a", status, had).is_result_of(&source("a"), limit);
        assert!(of(Status::Cleaned, Some(5.0), None), "it was done before its time was over");
        assert!(of(Status::TimeLimit, Some(5.0), Some(5.0)));
        assert!(
            !of(Status::TimeLimit, Some(5.0), Some(6.0)) && !of(Status::TimeLimit, Some(5.0), None)
        );
        assert!(!of(Status::Interrupted, None, None) && !of(Status::Crashed, None, None));
        assert!(!entry("a", Status::Cleaned, None).is_result_of(&source("b"), None));
    }
}
