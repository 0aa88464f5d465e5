//! A run that is told to stop ends soon, with a mesh that is valid, smoothed and within its budgets.

mod common;

use common::messy::Messy;
use quadmend::config::Config;
use quadmend::mesh::{MendPolicy, Point, Vector};
use quadmend::pipeline::{self, Cleaned};
use quadmend::watch::{Phase, Watch};
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

/// Cancels after it has been asked so many times, and counts what happens from then on.
#[derive(Default)]
struct After {
    questions: u32,
    asked: AtomicU32,
    /// What was reported afterwards.
    late: Mutex<Late>,
}

#[derive(Debug, Default, Clone)]
struct Late {
    planned: usize,
    stages: usize,
    edited: usize,
}

impl After {
    fn questions(questions: u32) -> Self {
        Self { questions, ..Self::default() }
    }

    fn is_over(&self) -> bool {
        self.asked.load(Ordering::Relaxed) > self.questions
    }

    fn note(&self, note: impl Fn(&mut Late)) {
        if self.is_over() {
            note(&mut self.late.lock().expect("nobody panics here"));
        }
    }
}

impl Watch for After {
    fn progress(&self, phase: Phase, _: usize, _: usize, _: Option<usize>) {
        self.note(|late| late.planned += usize::from(phase == Phase::Plan));
    }

    fn stage(&self, _: u32, _: u32) {
        self.note(|late| late.stages += 1);
    }

    fn edited(&self, _: usize, _: u64) {
        self.note(|late| late.edited += 1);
    }

    fn cancelled(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) >= self.questions
    }
}

fn config() -> Config {
    let mut config = Config::default();
    config.measure.samples = 20_000;
    config
}

fn clean(messy: &Messy, watch: &dyn Watch) -> Cleaned {
    let (mesh, reference) = (messy.mesh.clone(), messy.reference.as_ref());
    pipeline::clean(mesh, reference, MendPolicy::Mend, &config(), watch)
        .unwrap_or_else(|e| panic!("{}: {e}", messy.name))
}

/// Stopped at any moment, from the first to almost the last, in planning and in smoothing.
#[test]
fn a_stopped_run_is_valid_and_within_its_budgets() {
    for seed in 0..5 {
        let messy = Messy::new(seed, 5);
        let whole = After::questions(u32::MAX);
        let done = clean(&messy, &whole);
        assert!(!done.report.stopped);
        let asked = whole.asked.load(Ordering::Relaxed);
        for share in [0.0, 0.1, 0.4, 0.8, 0.99] {
            let watch = After::questions((f64::from(asked) * share) as u32);
            let cleaned = clean(&messy, &watch);
            assert!(cleaned.report.stopped, "{}, {share}", messy.name);
            let faults = messy.faults(&cleaned, &config());
            assert!(faults.is_empty(), "stopped after {share} of the questions: {faults:?}");
            let late = watch.late.lock().expect("nobody panics here").clone();
            // Elements that threads had begun with are planned to the end, and made.
            assert!(late.planned <= rayon::current_num_threads() + 1, "{late:?}");
            assert!(late.stages == 0 && late.edited <= 1, "{late:?}");
        }
    }
}

/// The last smoothing is short, but there is one: angles are those of a smoothed mesh.
#[test]
fn a_run_that_is_stopped_at_once_is_smoothed() {
    let mut messy = Messy::new(1, 8);
    let shake = |(v, p): (usize, &Point)| {
        let wave = |k: f64| 0.05 * (v as f64 * k).sin();
        p + Vector::new(wave(12.9), wave(78.2), wave(37.7))
    };
    messy.mesh.set_points(messy.mesh.points().iter().enumerate().map(shake).collect());
    let cleaned = clean(&messy, &After::questions(0));
    assert!(cleaned.report.edits.is_empty(), "no time for edits");
    let [before, after] = [&cleaned.report.before, &cleaned.report.after]
        .map(|m| m.summary.fig10_mean.expect("it has faces"));
    assert!(after < 0.75 * before, "angle deviation {before} -> {after}");
}

/// The command on the sample mesh, with smoothing that takes minutes.
fn slow_clean(folder: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_quadmend"));
    command.args(["clean", "assets/bracket.obj", "--reference", "assets/bracket.ref.obj", "-o"]);
    command.arg(folder.join("clean.obj"));
    command.args(["--set", "plan.smooth_between=5000", "--set", "smooth.still_edges=0"]);
    command.args(more).stdout(Stdio::null()).stderr(Stdio::piped());
    command
}

/// Sends `SIGINT` so many times, from when the run reports progress.
fn interrupted(mut run: Child, times: u32) -> (Option<i32>, String) {
    let mut told = BufReader::new(run.stderr.take().expect("it is piped"));
    let mut text = String::new();
    told.read_line(&mut text).expect("a run tells how far it is");
    for _ in 0..times {
        let sent = Command::new("kill").args(["-INT", &run.id().to_string()]).status();
        assert!(sent.expect("there is a kill").success());
        // Signals that come together count as one.
        std::thread::sleep(Duration::from_millis(300));
    }
    told.read_to_string(&mut text).expect("text");
    (run.wait().expect("it ends").code(), text)
}

#[test]
fn a_time_limit_ends_a_run_with_a_whole_mesh_that_its_log_makes_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let log = path("edits.toml").display().to_string();
    let run = slow_clean(folder.path(), &["--time-limit", "2", "--log", &log]).output();
    let run = run.expect("the command runs");
    let told = String::from_utf8_lossy(&run.stderr);
    assert_eq!(run.status.code(), Some(0), "{told}");
    assert!(told.contains("best mesh so far"), "{told}");
    let again = Command::new(env!("CARGO_BIN_EXE_quadmend"))
        .args(["edit", "assets/bracket.obj", "--reference", "assets/bracket.ref.obj", "--script"])
        .args([path("edits.toml"), "-o".into(), path("again.obj")])
        .status();
    assert!(again.expect("the command runs").code().is_some_and(|code| code < 2));
    let [clean, again] = ["clean.obj", "again.obj"].map(|f| std::fs::read(path(f)).expect(f));
    assert!(clean == again, "the log of a stopped run makes the same mesh");
}

#[test]
fn an_interrupt_ends_a_run_with_the_mesh_so_far() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = slow_clean(folder.path(), &[]).spawn().expect("the command runs");
    let (code, told) = interrupted(run, 1);
    assert_eq!(code, Some(130), "{told}");
    let mesh = quadmend::io::read(&folder.path().join("clean.obj")).expect("a whole mesh").mesh;
    quadmend::mesh::check(&mesh).expect("a clean mesh");
}

#[test]
fn a_second_interrupt_ends_a_run_without_touching_its_output() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("clean.obj"), "old").expect("a file");
    let slow_end = ["--set", "smooth.hurried=5000", "--set", "smooth.iterations=5000"];
    let run = slow_clean(folder.path(), &slow_end).spawn().expect("the command runs");
    let (code, told) = interrupted(run, 2);
    assert_eq!(code, Some(130), "{told}");
    assert_eq!(std::fs::read(folder.path().join("clean.obj")).expect("a file"), b"old", "{told}");
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 1, "nothing is left");
}
