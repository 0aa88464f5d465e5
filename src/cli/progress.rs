//! Progress on standard error: a bar on a terminal, a line every two seconds elsewhere.

use std::collections::BTreeMap;
use std::io::{IsTerminal, stderr};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use quadmend::io::{self, Loaded, ReadOptions};
use quadmend::report::Timing;
use quadmend::watch::{Phase, Watch};

use super::failure::Failure;
use super::output;
use super::stop::Stop;

/// Time between two lines where there is no terminal.
const PAUSE: Duration = Duration::from_secs(2);

/// Shows how far the pipeline is.
#[derive(Debug)]
pub(super) struct Progress {
    show: Show,
    verbose: bool,
    stop: Stop,
    state: Mutex<State>,
}

#[derive(Debug)]
enum Show {
    Nothing,
    Lines,
    Bar(ProgressBar),
}

#[derive(Debug)]
struct State {
    phase: Option<Phase>,
    /// When the phase began.
    began: Instant,
    /// When the last line was written.
    told: Instant,
    /// Time of the phases that are over; they may take turns.
    spent: BTreeMap<Phase, Duration>,
    /// When the work began.
    started: Instant,
    /// How the irregularity fell: when, and what it was from then on.
    fall: Vec<(Duration, u64)>,
    planning: Planning,
}

/// How far planning is.
#[derive(Debug, Default)]
struct Planning {
    /// When the first stage began, and the present one.
    began: Option<[Instant; 2]>,
    stage: u32,
    stages: u32,
    edits: usize,
}

impl Planning {
    fn enter(&mut self, stage: u32, stages: u32) {
        let now = Instant::now();
        self.began = Some([self.began.map_or(now, |began| began[0]), now]);
        (self.stage, self.stages) = (stage, stages);
    }

    /// Edits per second since planning began.
    fn speed(&self) -> Option<f64> {
        let seconds = self.began?[0].elapsed().as_secs_f64();
        (seconds > 0.0 && self.edits > 0).then(|| self.edits as f64 / seconds)
    }

    /// How long it will take yet, if the stages to come take as long as those that are over.
    fn left(&self) -> Option<Duration> {
        let [first, present] = self.began?;
        let each = (present - first).checked_div(self.stage)?;
        let rest = each * (self.stages - self.stage);
        Some(rest.saturating_sub(present.elapsed()))
    }
}

impl State {
    fn note_irregularity(&mut self, e: u64) {
        if self.fall.last().is_none_or(|last| last.1 != e) {
            self.fall.push((self.started.elapsed(), e));
        }
    }

    /// Adds the time of the phase that ends now.
    fn count_time(&mut self) {
        if let Some(phase) = self.phase {
            *self.spent.entry(phase).or_default() += self.began.elapsed();
        }
        self.began = Instant::now();
    }
}

impl Progress {
    /// Silent, or what suits standard error; the run ends with what it has when `stop` says so.
    pub(super) fn new(quiet: bool, verbose: bool, stop: Stop) -> Self {
        let show = match (quiet, stderr().is_terminal()) {
            (true, _) => Show::Nothing,
            (false, true) => Show::Bar(bar()),
            (false, false) => Show::Lines,
        };
        let now = Instant::now();
        let state = State {
            phase: None,
            began: now,
            told: now,
            spent: BTreeMap::new(),
            started: now,
            fall: Vec::new(),
            planning: Planning::default(),
        };
        Self { show, verbose, stop, state: Mutex::new(state) }
    }

    /// Says something on standard error without spoiling the bar; nothing if quiet.
    pub(super) fn tell(&self, line: &str) {
        match &self.show {
            Show::Nothing => {}
            Show::Lines => output::note(line),
            Show::Bar(bar) => bar.suspend(|| output::note(line)),
        }
    }

    /// Reads a mesh within limits, and says what was left out.
    pub(super) fn load(&self, path: &Path, options: &ReadOptions) -> Result<Loaded, Failure> {
        Ok(self.warned(io::read_within(path, options)?))
    }

    /// Says what was left out of a mesh.
    pub(super) fn warned(&self, loaded: Loaded) -> Loaded {
        for warning in &loaded.warnings {
            self.tell(&format!("warning: {warning}"));
        }
        loaded
    }

    /// How long each phase has taken so far.
    pub(super) fn timings(&self) -> Vec<Timing> {
        let mut state = self.lock();
        state.count_time();
        let one = |(&phase, spent): (&Phase, &Duration)| Timing {
            phase: words(phase),
            seconds: spent.as_secs_f64(),
        };
        state.spent.iter().map(one).collect()
    }

    /// Ends the display; if verbose, tells how the irregularity fell and how long each phase took.
    pub(super) fn finish(self) {
        let mut state = self.lock();
        state.count_time();
        for (when, left) in state.fall.iter().filter(|_| self.verbose) {
            self.tell(&format!("{:>10} {:7.2} s", format!("E {left}"), when.as_secs_f64()));
        }
        for (phase, spent) in state.spent.iter().filter(|_| self.verbose) {
            self.tell(&format!("{:>10} {:7.2} s", words(*phase), spent.as_secs_f64()));
        }
    }

    /// E so far, the speed, and the time left.
    fn words(&self, state: &State) -> Vec<String> {
        let e = state.fall.last().map(|(_, e)| format!("E {e}"));
        let speed = state.planning.speed().map(|speed| format!("{speed:.1} edits/s"));
        let left = state.planning.left().filter(|_| state.phase == Some(Phase::Plan));
        let left = [left, self.stop.left()].into_iter().flatten().min();
        let left = left.map(|left| format!("{:.0} s left", left.as_secs_f64()));
        [e, speed, left].into_iter().flatten().collect()
    }

    fn enter(&self, state: &mut State, phase: Phase) {
        state.count_time();
        state.phase = Some(phase);
        if let Show::Bar(bar) = &self.show {
            bar.set_prefix(words(phase));
        }
    }

    /// A thread that panicked while it reported left nothing half done.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A run that stops with an error leaves no bar behind.
impl Drop for Progress {
    fn drop(&mut self) {
        if let Show::Bar(bar) = &self.show {
            bar.finish_and_clear();
        }
    }
}

impl Watch for Progress {
    fn progress(&self, phase: Phase, done: usize, total: usize, irregular: Option<usize>) {
        let mut state = self.lock();
        if state.phase != Some(phase) {
            self.enter(&mut state, phase);
        }
        if let Some(n) = irregular {
            state.note_irregularity(n as u64);
        }
        match &self.show {
            Show::Bar(bar) => {
                bar.set_length(total as u64);
                bar.set_position(done as u64);
                bar.set_message(self.words(&state).join(", "));
            }
            Show::Lines if state.told.elapsed() >= PAUSE => {
                state.told = Instant::now();
                let far = format!("{}: {done} of {total}", words(phase));
                let all: Vec<String> = std::iter::once(far).chain(self.words(&state)).collect();
                output::note(&all.join(", "));
            }
            Show::Nothing | Show::Lines => {}
        }
    }

    fn stage(&self, stage: u32, stages: u32) {
        self.lock().planning.enter(stage, stages);
    }

    fn edited(&self, edits: usize, irregularity: u64) {
        let mut state = self.lock();
        state.planning.edits = edits;
        state.note_irregularity(irregularity);
    }

    fn cancelled(&self) -> bool {
        self.stop.cause().is_some()
    }
}

fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{prefix:>10} {bar:40} {pos}/{len}  {msg}");
    // The template is a constant that indicatif accepts; its own style would do as well.
    ProgressBar::new(0).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

fn words(phase: Phase) -> &'static str {
    match phase {
        Phase::Read => "reading",
        Phase::Reference => "reference",
        Phase::Plan => "planning",
        Phase::Edit => "editing",
        Phase::Smooth => "smoothing",
        Phase::Measure => "measuring",
        Phase::Write => "writing",
        Phase::Tune => "tuning",
    }
}
