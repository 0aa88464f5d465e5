//! `quadmend tune`: searches the configuration for what is best on some meshes.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use clap::{Args, ValueEnum};
use quadmend::config::Config;
use quadmend::tune::space::Varied;
use quadmend::tune::{self, Case, Findings, Goal, Judged, Observer, Task, TuneError};
use quadmend::watch::{Phase, Watch};

use super::failure::Failure;
use super::paths::{self, Files};
use super::progress::Progress;
use super::settings::{Running, Settings};
use super::stop::Stop;
use super::{Exit, output};

/// Stands for the name of a mesh in the path of its reference.
const NAME: &str = "{}";

const EXAMPLES: &str = "\
Examples:
  quadmend tune remesh.obj -r scan.obj -o tuning --trials 50
  quadmend tune 'meshes/*.obj' -o tuning --seconds 600          references: meshes/NAME.ref.obj
  quadmend tune a.obj b.obj -r 'scans/{}.obj' -o tuning --vary plan.lambda_last=200..8000,log
  quadmend tune remesh.obj -o front --goal pareto --vary plan.lambda_last --vary gate.rms=0.5..2
  quadmend tune remesh.obj -o mine --search mine.toml           a task of your own
  quadmend clean remesh.obj -r scan.obj -o clean.obj --config tuning/best.toml

The search starts from the configuration that --preset, --config and --set give; all else is judged
relative to that. In the folder are left: journal.jsonl (a line for each trial), best.toml (with
--goal pareto also front-1.toml and so on), and tune.html, which opens offline. They are renewed
after every generation of trials. The same command again goes on where the last one stopped; a
search that was interrupted ends as if it had not been.
What is searched, where, and what counts how much is in configs/tune.toml of the source; a file for
--search says what is to be different.";

/// Search the configuration for what is best on some meshes
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Tune {
    /// The meshes (OBJ), or quoted patterns such as 'meshes/*.obj'
    #[arg(required = true)]
    meshes: Vec<String>,

    /// The folder for journal, configurations and page; it is made if it is not there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,

    /// Surface that each mesh stays on; {} stands for the name of the mesh without `.obj`
    /// [default: NAME.ref.obj beside the mesh if it is there, else the mesh itself]
    #[arg(short, long, value_name = "MESH")]
    reference: Option<String>,

    /// What to search for, and where (TOML) [default: all cost weights, least score]
    #[arg(long, value_name = "FILE")]
    search: Option<PathBuf>,

    /// Vary this knob, in place of those of the task: KEY, KEY=LOW..HIGH or KEY=LOW..HIGH,log;
    /// may be repeated [default range: that of the knob]
    #[arg(long, value_name = "KEY[=RANGE]")]
    vary: Vec<Varied>,

    /// What to look for [default: that of the task]
    #[arg(long, value_name = "GOAL")]
    goal: Option<GoalName>,

    /// What chance depends on [default: that of the task]
    #[arg(long, value_name = "N")]
    seed: Option<u32>,

    /// Trials in all, those of the journal included [default: 100, or no limit with --seconds]
    #[arg(long, value_name = "N")]
    trials: Option<usize>,

    /// Begin no more trials after this time [default: no limit]
    #[arg(long, value_name = "S")]
    seconds: Option<u64>,

    #[command(flatten)]
    settings: Settings,

    #[command(flatten)]
    running: Running,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum GoalName {
    /// The smallest weighted score
    Score,
    /// Configurations of which none is better in all measures
    Pareto,
}

impl Tune {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        let (task, start) = (self.task()?, self.settings.load()?);
        let files = self.files()?;
        self.check_paths(&files)?;
        let progress = self.running.start(Stop::default())?;
        let cases = self.cases(&files, &start, &progress)?;
        output::folder(&self.output)?;
        let console = Console {
            progress: &progress,
            folder: &self.output,
            best: Mutex::new(f64::INFINITY),
            trials: self.trials,
            end: self.seconds.map(|s| Instant::now() + Duration::from_secs(s)),
        };
        let journal = self.output.join("journal.jsonl");
        let most = self.most();
        let findings = tune::search((&task, &start), &cases, most, &journal, &console)?;
        write(&self.output, &findings)?;
        progress.finish();
        if !self.running.quiet {
            output::data(&told(&findings))?;
        }
        // That the start is the best is an answer, too.
        Ok(Exit::Done)
    }

    fn most(&self) -> usize {
        // More than anybody waits for, where only time limits.
        let unlimited = 1_000_000;
        self.trials.unwrap_or(if self.seconds.is_some() { unlimited } else { 100 })
    }

    fn task(&self) -> Result<Task, Failure> {
        let mut task = match &self.search {
            None => Task::default(),
            Some(file) => {
                let shown = file.display().to_string();
                let text = std::fs::read_to_string(file)
                    .map_err(|e| Failure::usage(format!("{shown}: {e}")))?;
                Task::read(&shown, &text)?
            }
        };
        task.seed = self.seed.unwrap_or(task.seed);
        task.goal = match self.goal {
            None => task.goal,
            Some(GoalName::Score) => Goal::Score,
            Some(GoalName::Pareto) => Goal::Pareto,
        };
        if !self.vary.is_empty() {
            task.vary(&self.vary)?;
        }
        Ok(task)
    }

    /// The meshes that the arguments name, less those that are references of others.
    fn files(&self) -> Result<Vec<PathBuf>, Failure> {
        let mut files: Vec<PathBuf> = Vec::new();
        for pattern in &self.meshes {
            let found = matches(pattern)?;
            files.extend(found.into_iter().filter(|f| !is_reference(f)));
        }
        files.sort();
        files.dedup();
        if files.is_empty() {
            return Err(Failure::usage("the patterns match no mesh; look at them with `ls`"));
        }
        Ok(files)
    }

    fn reference_of(&self, mesh: &Path) -> Option<PathBuf> {
        let name = mesh.file_stem().unwrap_or_default().to_string_lossy();
        match &self.reference {
            Some(pattern) => Some(pattern.replace(NAME, &name).into()),
            None => Some(beside(mesh)).filter(|file| file.is_file()),
        }
    }

    fn check_paths(&self, files: &[PathBuf]) -> Result<(), Failure> {
        let one_for_all = self.reference.as_ref().is_some_and(|r| !r.contains(NAME));
        if one_for_all && files.len() > 1 {
            return Err(Failure::usage(
                "one reference for several meshes: write {} for the name of the mesh, as in \
                 --reference 'scans/{}.obj'",
            ));
        }
        let references: Vec<PathBuf> = files.iter().filter_map(|f| self.reference_of(f)).collect();
        let meshes: Vec<&Path> = files.iter().chain(&references).map(PathBuf::as_path).collect();
        let texts: Vec<&Path> = [&self.search, &self.settings.config]
            .into_iter()
            .flatten()
            .map(PathBuf::as_path)
            .collect();
        Files { meshes: &meshes, texts: &texts, output: None, others: &[], force: false }.check()
    }

    fn cases(
        &self,
        files: &[PathBuf],
        config: &Config,
        progress: &Progress,
    ) -> Result<Vec<Case>, Failure> {
        progress.progress(Phase::Read, 0, 1, None);
        let load = |path: &Path| progress.load(path, &config.read);
        let one = |file: &PathBuf| {
            let mesh = load(file)?;
            let reference = self.reference_of(file).map(|r| load(&r)).transpose()?;
            let sha256 = reference.as_ref().map_or_else(String::new, |r| r.sha256.clone());
            Ok(Case {
                file: paths::shown(file),
                sha256: [mesh.sha256, sha256],
                mesh: mesh.mesh,
                reference: reference.map(|r| r.mesh),
            })
        };
        files.iter().map(one).collect()
    }
}

/// Files that a pattern matches; what is no pattern names itself.
fn matches(pattern: &str) -> Result<Vec<PathBuf>, Failure> {
    if Path::new(pattern).exists() || !pattern.contains(['*', '?', '[']) {
        return Ok(vec![pattern.into()]);
    }
    let found = glob::glob(pattern)
        .map_err(|e| Failure::usage(format!("{pattern}: this is no pattern of files: {e}")))?;
    found.map(|file| file.map_err(|e| Failure::usage(format!("{pattern}: {e}")))).collect()
}

/// Where the reference of a mesh is looked for.
fn beside(mesh: &Path) -> PathBuf {
    mesh.with_extension("ref.obj")
}

/// Whether the file is the reference of a mesh beside it.
fn is_reference(file: &Path) -> bool {
    let name = file.to_string_lossy();
    name.strip_suffix(".ref.obj").is_some_and(|mesh| Path::new(&format!("{mesh}.obj")).is_file())
}

/// Shows how the search goes, and keeps the files of the folder up to date.
struct Console<'a> {
    progress: &'a Progress,
    folder: &'a Path,
    best: Mutex<f64>,
    trials: Option<usize>,
    end: Option<Instant>,
}

impl Observer for Console<'_> {
    fn trial(&self, number: usize, score: f64, done: usize) {
        let total = self.trials.map_or(done, |trials| trials + 1);
        self.progress.progress(Phase::Tune, done, total, None);
        // Another thread that panicked has left a number all the same.
        let mut best = self.best.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if score < *best {
            *best = score;
            self.progress.tell(&format!("best so far: score {score:.4}, trial {number}"));
        }
    }

    fn generation(&self, findings: &Findings) {
        // At the end they are written once more, and then it is told what is in the way.
        let _ = write(self.folder, findings);
    }

    fn enough(&self) -> bool {
        self.end.is_some_and(|end| Instant::now() >= end)
    }
}

/// The configurations and the page.
fn write(folder: &Path, findings: &Findings) -> Result<(), Failure> {
    output::file(&folder.join("best.toml"), &configuration(findings, findings.best())?)?;
    if findings.task.goal == Goal::Pareto {
        for (number, judged) in (1..).zip(findings.front()) {
            let file = folder.join(format!("front-{number}.toml"));
            output::file(&file, &configuration(findings, judged)?)?;
        }
    }
    output::file(&folder.join("tune.html"), &tune::page(findings)?)
}

/// A trial as a file for `--config`.
fn configuration(findings: &Findings, judged: &Judged) -> Result<String, Failure> {
    let config = findings.config(judged)?;
    let measures: Vec<String> = tune::objective::QUANTITIES
        .iter()
        .zip(&judged.ratios)
        .map(|(quantity, ratio)| format!("{} × {ratio:.3}", quantity.label))
        .collect();
    Ok(format!(
        "# Trial {} of `quadmend tune`, seed {}: score {:.4} relative to where the search began\n\
         # ({}).\n{}",
        judged.trial.number,
        findings.task.seed,
        judged.score,
        measures.join(", "),
        config.to_toml_changed()
    ))
}

/// The best trials in a table.
fn told(findings: &Findings) -> String {
    let names: Vec<&str> = tune::objective::QUANTITIES.iter().map(|q| q.name).collect();
    let mut text = format!("{:<10} {:>8}", "trial", "score");
    for name in &names {
        // Writing to a string cannot fail.
        let _ = write!(text, " {name:>10}");
    }
    let mut shown: Vec<(&str, &Judged)> = vec![("start", &findings.trials[0])];
    match findings.task.goal {
        Goal::Score => shown.push(("best", findings.best())),
        Goal::Pareto => shown.extend(findings.front().into_iter().map(|t| ("front", t))),
    }
    for (what, judged) in shown {
        let name = format!("{what} {}", judged.trial.number);
        let _ = write!(text, "\n{name:<10} {:>8.4}", judged.score);
        for ratio in &judged.ratios {
            let _ = write!(text, " {ratio:>10.3}");
        }
    }
    text + "\nAll relative to the start, over all meshes; less is better.\n"
}

impl From<TuneError> for Failure {
    fn from(error: TuneError) -> Self {
        match error {
            TuneError::Mesh { file, source } => Self::of_file(&file, source),
            TuneError::Measure { file, source } => Self::of_file(&file, source),
            other => Self::usage(other.to_string()),
        }
    }
}
