//! A run that is told to stop ends soon, with a mesh that is valid, smoothed and within its budgets.

mod common;

use common::messy::Messy;
use quadmend::config::Config;
use quadmend::mesh::{MendPolicy, Point, Vector};
use quadmend::pipeline::{self, Cleaned};
use quadmend::watch::{Phase, Watch};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

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
