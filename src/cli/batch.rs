//! `quadmend batch`: many meshes, each cleaned as `clean` does it.

use std::any::Any;
use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use clap::Args;
use quadmend::batch::manifest::{Source, numbers};
use quadmend::batch::{self, Entry, Manifest, Memory, Row, Status, estimate};
use quadmend::config::Config;
use quadmend::io::{self, FORMATS, Format, Loaded, write_atomically};
use quadmend::mesh::MendPolicy;
use quadmend::pipeline::{Cleaned, clean};
use quadmend::watch::Watch;

use super::aftermath::Aftermath;
use super::failure::Failure;
use super::paths::{self, Files};
use super::progress::Progress;
use super::settings::{Running, Settings};
use super::stop::{Cause, Seconds, Stop};
use super::{Exit, output, summary};

const EXAMPLES: &str = "\
Examples:
  quadmend batch 'in/*.obj' --out cleaned --reference-dir scans
  quadmend batch 'in/*.obj' --out cleaned --time-limit 120 --memory-limit 8 --reports
  quadmend batch 'in/*.obj' --out cleaned         # again: goes on with what is not done yet

Files in the folder:
  NAME.obj          each cleaned mesh
  NAME.html         its report, with --reports
  manifest.jsonl    a line for each mesh: hashes of what went in and came out, status, metrics
  summary.csv       the same as a table
  index.html        the same to look at, with pictures before and after
  thumbnails/       the pictures

A mesh that fails (unreadable, too large, even a bug of this program) is told in all of these and
stops no other; the exit code is 3 then. A mesh is passed over if the manifest has a result for the
same mesh, reference, configuration and version, and the result is still there. Ctrl-C ends the
meshes in work with their best so far; they are done again the next time.";

/// Clean many meshes, and leave them with a manifest and an overview in a folder
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Batch {
    /// Meshes, patterns such as 'in/*.obj' or 'in/**/*.obj', or folders
    #[arg(required = true)]
    inputs: Vec<String>,

    /// Folder for the results; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,

    /// Folder with the surface of each mesh NAME.obj, called NAME.obj or NAME.ref.obj; a mesh
    /// without one is not cleaned [default: each mesh on its own surface]
    #[arg(short, long, value_name = "DIR")]
    reference_dir: Option<PathBuf>,

    /// Also write a report for each mesh, as `clean --report` does
    #[arg(long)]
    reports: bool,

    /// Refuse meshes that have anything to mend, instead of mending them [default: mend]
    #[arg(long)]
    strict: bool,

    /// Allow results to replace inputs
    #[arg(long)]
    force: bool,

    /// Seconds for each mesh, after which the best mesh so far is taken; what comes out then depends
    /// on the speed of the machine [default: none]
    #[arg(long, value_name = "SECONDS")]
    time_limit: Option<Seconds>,

    /// Memory for all meshes together in GB (10⁹ bytes): a mesh waits until what it is estimated to
    /// need is free, and is refused if it never can be [default: four fifths of what is free]
    #[arg(long, value_name = "GB", value_parser = gigabytes)]
    memory_limit: Option<u64>,

    #[command(flatten)]
    settings: Settings,

    #[command(flatten)]
    running: Running,
}

/// A mesh to clean.
struct Job {
    input: PathBuf,
    /// Names of its files in the folder begin with this.
    name: String,
    /// Its surface if it has one, or why there is none.
    reference: Result<Option<PathBuf>, String>,
}

/// Why there is no mesh.
type Trouble = (Status, String);

/// Everything that all meshes share.
struct Work<'a> {
    options: &'a Batch,
    config: Config,
    config_sha256: String,
    memory: Memory,
    progress: Progress,
    manifest: Mutex<Manifest>,
}

impl Batch {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        let config = self.settings.load()?;
        let jobs = self.jobs()?;
        self.check_paths(&jobs)?;
        output::folder(&self.out.join("thumbnails"))?;
        let stop = Stop::listen(None)?;
        let path = self.out.join("manifest.jsonl");
        let manifest = Manifest::open(&path)
            .map_err(|e| Failure::usage(format!("{}: cannot be written ({e})", path.display())))?;
        let settings = format!("strict = {}\n{}", self.strict, config.to_toml());
        let work = Work {
            options: self,
            config,
            config_sha256: io::fingerprint(settings.as_bytes()),
            memory: Memory::new(self.memory_limit.or_else(free_memory).unwrap_or(u64::MAX)),
            progress: self.running.start(stop)?,
            manifest: Mutex::new(manifest),
        };
        let failed = work.run(&jobs, &stop)?;
        let entries = work.finish()?;
        self.write_overview(&entries)?;
        Ok(stop.exit(if failed > 0 { Exit::BadInput } else { Exit::Done }))
    }

    /// The meshes in the order of their names.
    fn jobs(&self) -> Result<Vec<Job>, Failure> {
        let mut inputs = Vec::new();
        for pattern in &self.inputs {
            let found = expand(pattern)?;
            if found.is_empty() {
                return Err(Failure::usage(format!("no mesh matches {pattern}")));
            }
            inputs.extend(found);
        }
        inputs.sort();
        inputs.dedup();
        // In a folder that has both, a surface is no mesh of its own.
        let names: Vec<String> = inputs.iter().map(|input| stem(input)).collect();
        let is_surface =
            |name: &str| name.strip_suffix(".ref").is_some_and(|of| names.iter().any(|n| n == of));
        let jobs = inputs.into_iter().zip(&names).filter(|(_, name)| !is_surface(name));
        Ok(jobs
            .map(|(input, name)| Job {
                input,
                name: name.clone(),
                reference: self.reference_of(name),
            })
            .collect())
    }

    fn reference_of(&self, name: &str) -> Result<Option<PathBuf>, String> {
        let Some(folder) = &self.reference_dir else { return Ok(None) };
        let extensions = || FORMATS.iter().flat_map(|format| format.extensions);
        let mut names = [".ref", ""].into_iter().flat_map(|middle| {
            let ends = extensions()
                .flat_map(|extension| [extension.to_string(), format!("{extension}.gz")]);
            ends.map(move |end| format!("{name}{middle}.{end}"))
        });
        let found = names.find_map(|name| Some(folder.join(name)).filter(|path| path.is_file()));
        let missing = || format!("no surface {name}.ref.obj or {name}.obj in {}", folder.display());
        found.map(Some).ok_or_else(missing)
    }

    fn check_paths(&self, jobs: &[Job]) -> Result<(), Failure> {
        let mut inputs: BTreeMap<&str, &Path> = BTreeMap::new();
        for job in jobs {
            if let Some(other) = inputs.insert(&job.name, &job.input) {
                return Err(Failure::usage(format!(
                    "{} and {} would have results of the same name; give them other names, or \
                     clean them into different folders",
                    other.display(),
                    job.input.display()
                )));
            }
        }
        output::folder(&self.out)?;
        let references = jobs.iter().filter_map(|job| job.reference.as_ref().ok()?.as_deref());
        let meshes: Vec<&Path> = jobs.iter().map(|job| &*job.input).chain(references).collect();
        let outputs: Vec<PathBuf> = jobs.iter().map(|job| self.output(job)).collect();
        let others: Vec<&Path> = outputs.iter().map(PathBuf::as_path).collect();
        let config = self.settings.config.as_deref();
        let texts = config.as_slice();
        Files { meshes: &meshes, texts, output: None, others: &others, force: self.force }.check()
    }

    fn output(&self, job: &Job) -> PathBuf {
        self.out.join(format!("{}.obj", job.name))
    }

    fn thumbnail(&self, name: &str, when: &str) -> PathBuf {
        self.out.join("thumbnails").join(format!("{name}-{when}.png"))
    }

    /// What the page shows of a mesh: what there is in the folder.
    fn row<'a>(&self, entry: &'a Entry) -> Row<'a> {
        let Some(output) = &entry.output else {
            return Row { entry, pictures: None, report: None };
        };
        let name = stem(Path::new(output));
        let [before, after] = ["before", "after"].map(|when| fs::read(self.thumbnail(&name, when)));
        let report = format!("{name}.html");
        Row {
            entry,
            pictures: before.ok().zip(after.ok()).map(|(before, after)| [before, after]),
            report: self.out.join(&report).is_file().then_some(report),
        }
    }

    /// The table and the page.
    fn write_overview(&self, entries: &[Entry]) -> Result<(), Failure> {
        output::file(&self.out.join("summary.csv"), &batch::csv(entries))?;
        let rows: Vec<Row> = entries.iter().map(|entry| self.row(entry)).collect();
        output::file(&self.out.join("index.html"), &batch::page("quadmend batch", &rows))
    }
}

impl Work<'_> {
    /// Cleans the meshes, as many at a time as there are threads; how many failed.
    ///
    /// The threads here only wait: the work of all is done by the one pool. A thread of the pool
    /// that ran a mesh could come to run a second one in the middle of the first.
    fn run(&self, jobs: &[Job], stop: &Stop) -> Result<usize, Failure> {
        let (next, failed) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let some = || -> Result<(), Failure> {
            while stop.cause().is_none() {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let Some(job) = jobs.get(number) else { break };
                let words = match self.entry(job) {
                    Some(entry) => {
                        failed.fetch_add(usize::from(entry.status.has_failed()), Ordering::Relaxed);
                        let words = told(&entry);
                        self.add(entry)?;
                        words
                    }
                    None => "done before".to_owned(),
                };
                let shown = job.input.display();
                self.progress.tell(&format!("[{}/{}] {shown}: {words}", number + 1, jobs.len()));
            }
            Ok(())
        };
        std::thread::scope(|scope| {
            let count = rayon::current_num_threads().min(jobs.len());
            let threads: Vec<_> = (0..count).map(|_| scope.spawn(some)).collect();
            let ended = threads.into_iter().map(|thread| {
                thread.join().unwrap_or_else(|panic| Err(Failure::usage(message(&*panic))))
            });
            ended.collect::<Result<(), Failure>>()
        })?;
        Ok(failed.into_inner())
    }

    /// What becomes of a mesh; nothing if that is known.
    fn entry(&self, job: &Job) -> Option<Entry> {
        let began = Instant::now();
        let limit = self.options.time_limit.map(|limit| limit.0.as_secs_f64());
        let reference = job.reference.as_ref().ok().cloned().flatten();
        let source = self.source(job, reference.as_deref());
        let name = job.input.display().to_string();
        if source.as_ref().is_some_and(|source| self.is_done(&name, source, limit)) {
            return None;
        }
        // A mesh leaves nothing behind but files, which appear whole.
        let cleaned = catch_unwind(AssertUnwindSafe(|| self.clean(job, reference.as_deref())));
        let cleaned = cleaned.unwrap_or_else(|panic| Err((Status::Crashed, message(&*panic))));
        let mut entry = Entry {
            input: name,
            reference: reference.map(|path| path.display().to_string()),
            source,
            status: Status::Cleaned,
            error: None,
            output: None,
            output_sha256: None,
            time_limit_s: limit,
            seconds: 0.0,
            before: BTreeMap::new(),
            after: BTreeMap::new(),
        };
        match cleaned {
            Ok((cleaned, status)) => {
                entry.status = status;
                entry.before = numbers(&cleaned.report.before);
                entry.after = numbers(&cleaned.report.after);
                entry.output_sha256 = hash(&self.options.output(job));
                entry.output = Some(format!("{}.obj", job.name));
            }
            Err((status, error)) => (entry.status, entry.error) = (status, Some(error)),
        }
        entry.seconds = (began.elapsed().as_secs_f64() * 1e3).round() / 1e3;
        Some(entry)
    }

    fn source(&self, job: &Job, reference: Option<&Path>) -> Option<Source> {
        Some(Source {
            input_sha256: hash(&job.input)?,
            reference_sha256: reference.map_or(Some(None), |path| hash(path).map(Some))?,
            config_sha256: self.config_sha256.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
        })
    }

    /// Whether there is a result, and it is still as it was written.
    fn is_done(&self, input: &str, source: &Source, limit: Option<f64>) -> bool {
        let known = self.manifest().get(input).cloned();
        let Some(known) = known.filter(|entry| entry.is_result_of(source, limit)) else {
            return false;
        };
        let file = known.output.map(|output| self.options.out.join(output));
        let report = file.as_ref().map(|file| file.with_extension("html"));
        let is_there = file.and_then(|file| hash(&file)) == known.output_sha256;
        is_there && (!self.options.reports || report.is_some_and(|report| report.is_file()))
    }

    /// Reads, cleans and writes a mesh.
    fn clean(&self, job: &Job, reference: Option<&Path>) -> Result<(Cleaned, Status), Trouble> {
        let refused = |error: String| (Status::Refused, error);
        job.reference.as_ref().map_err(|error| refused(error.clone()))?;
        let limits = &self.config.read;
        let read = |path: &Path| io::read_within(path, limits).map_err(|e| refused(e.to_string()));
        let (input, reference) = (read(&job.input)?, reference.map(read).transpose()?);
        let surface = reference.as_ref().map(|loaded| &loaded.mesh);
        let faces = surface.unwrap_or(&input.mesh).face_count();
        let needed = estimate(input.mesh.face_count(), faces);
        let _lease = self.memory.take(needed).map_err(|e| (Status::TooLarge, e.to_string()))?;
        let limit = self.options.time_limit.map(|limit| limit.0);
        let stop = Stop::listen(limit).map_err(|failure| (Status::Refused, failure.words()))?;
        let strict = self.options.strict;
        let policy = if strict { MendPolicy::Strict } else { MendPolicy::Mend };
        let cleaned = clean(input.mesh.clone(), surface, policy, &self.config, &Until(stop))
            .map_err(|e| refused(e.to_string()))?;
        self.write(job, (&input, reference.as_ref()), &cleaned)
            .map_err(|failure| refused(failure.words()))?;
        let status = match (cleaned.report.stopped, summary::exit(&cleaned.report)) {
            (true, _) if stop.cause() == Some(Cause::Interrupt) => Status::Interrupted,
            (true, _) => Status::TimeLimit,
            (false, Exit::NothingToImprove) => Status::NothingToImprove,
            _ => Status::Cleaned,
        };
        Ok((cleaned, status))
    }

    /// The mesh, its pictures and its report.
    fn write(
        &self,
        job: &Job,
        (input, reference): (&Loaded, Option<&Loaded>),
        cleaned: &Cleaned,
    ) -> Result<(), Failure> {
        let path = self.options.output(job);
        io::write(&path, &cleaned.mesh)?;
        let images = batch::thumbnails(&input.mesh, &cleaned.mesh)?;
        for (when, image) in ["before", "after"].iter().zip(images) {
            let path = self.options.thumbnail(&job.name, when);
            write_atomically(&path, |out| image.write_png(out))?;
        }
        if !self.options.reports {
            return Ok(());
        }
        let names = [&job.input, &path].map(|path| paths::short_name(path));
        let files = [&job.input, &path].map(|path| paths::shown(path));
        let surface = job.reference.as_ref().ok().and_then(Option::as_deref).map(paths::shown);
        let shown = Aftermath::new((input, reference), cleaned, &self.config);
        output::file(&path.with_extension("html"), &shown.html((names, files, surface), Vec::new()))
    }

    fn add(&self, entry: Entry) -> Result<(), Failure> {
        let added = self.manifest().add(entry);
        added.map_err(|e| Failure::usage(format!("the manifest cannot be written ({e})")))
    }

    /// A line of it is written in one go, so it is sound whatever happens.
    fn manifest(&self) -> MutexGuard<'_, Manifest> {
        self.manifest.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn finish(self) -> Result<Vec<Entry>, Failure> {
        let manifest = self.manifest.into_inner().unwrap_or_else(PoisonError::into_inner);
        self.progress.finish();
        Ok(manifest.finish()?)
    }
}

/// Watches nothing but when to end.
struct Until(Stop);

impl Watch for Until {
    fn cancelled(&self) -> bool {
        self.0.cause().is_some()
    }
}

/// What became of a mesh, in a line.
fn told(entry: &Entry) -> String {
    if let Some(error) = &entry.error {
        return format!("{}: {error}", entry.status.words());
    }
    let e = |numbers: &BTreeMap<String, f64>| numbers.get("irregular_elements").copied();
    let (before, after) = (e(&entry.before), e(&entry.after));
    let [before, after] = [before, after].map(|e| e.unwrap_or(f64::NAN));
    format!("{}, E {before} → {after}, {:.1} s", entry.status.words(), entry.seconds)
}

/// The meshes that a pattern stands for, or those in a folder.
fn expand(pattern: &str) -> Result<Vec<PathBuf>, Failure> {
    let path = Path::new(pattern);
    if path.is_file() {
        return Ok(vec![path.to_owned()]);
    }
    let wanted = if path.is_dir() { format!("{pattern}/*") } else { pattern.to_owned() };
    let found = glob::glob(&wanted)
        .map_err(|e| Failure::usage(format!("{pattern}: not a pattern for files: {e}")))?;
    let is_mesh = |path: &PathBuf| path.is_file() && Format::of(path).is_some();
    // What cannot be read is told when it is cleaned; folders that cannot be listed have no meshes.
    Ok(found.filter_map(Result::ok).filter(is_mesh).collect())
}

/// The name of a file without its folder and the extensions of its format.
fn stem(path: &Path) -> String {
    let unpacked = path.with_extension("");
    let path = if path.extension().is_some_and(|e| e == "gz") { &unpacked } else { path };
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}

fn hash(path: &Path) -> Option<String> {
    fs::read(path).ok().map(|bytes| io::fingerprint(&bytes))
}

fn gigabytes(text: &str) -> Result<u64, String> {
    let bytes = text.parse::<f64>().ok().filter(|gb| gb.is_finite() && *gb > 0.0);
    bytes.map(|gb| (gb * 1e9) as u64).ok_or_else(|| "a number above 0, for example 8".to_owned())
}

/// Four fifths of the memory that is free, where the system tells.
fn free_memory() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024 / 5 * 4)
}

/// What a panic says.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    let text = text.unwrap_or_else(|| "no message".to_owned());
    format!("a bug of this program ({text}); please report this with the input")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_words() {
        for panic in [catch_unwind(|| panic!("no {}", 7)), catch_unwind(|| panic!("no 7"))] {
            let words = message(&*panic.expect_err("it panics"));
            assert!(words.contains("(no 7)"), "{words}");
        }
    }

    #[test]
    fn memory_is_more_than_nothing() {
        assert_eq!(gigabytes("1.5"), Ok(1_500_000_000));
        for wrong in ["0", "-1", "inf", "much"] {
            assert!(gigabytes(wrong).is_err(), "{wrong}");
        }
    }
}
