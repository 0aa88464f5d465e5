//! Progress on standard error: a bar on a terminal, a line every two seconds elsewhere.

use std::io::{IsTerminal, stderr};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use quadmend::watch::{Phase, Watch};

use super::output;

/// Time between two lines where there is no terminal.
const PAUSE: Duration = Duration::from_secs(2);

/// Shows how far the pipeline is.
#[derive(Debug)]
pub(super) struct Progress {
    show: Show,
    verbose: bool,
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
    began: Instant,
    told: Instant,
}

impl Progress {
    /// Silent, or what suits standard error.
    pub(super) fn new(quiet: bool, verbose: bool) -> Self {
        let show = match (quiet, stderr().is_terminal()) {
            (true, _) => Show::Nothing,
            (false, true) => Show::Bar(bar()),
            (false, false) => Show::Lines,
        };
        let now = Instant::now();
        Self { show, verbose, state: Mutex::new(State { phase: None, began: now, told: now }) }
    }

    /// Ends the display; the time of the last phase is told.
    pub(super) fn finish(&self) {
        self.tell_time(&self.lock());
        if let Show::Bar(bar) = &self.show {
            bar.finish_and_clear();
        }
    }

    fn enter(&self, state: &mut State, phase: Phase) {
        self.tell_time(state);
        (state.phase, state.began) = (Some(phase), Instant::now());
        if let Show::Bar(bar) = &self.show {
            bar.set_prefix(words(phase));
        }
    }

    fn tell_time(&self, state: &State) {
        if let (true, Some(phase)) = (self.verbose, state.phase) {
            let line = format!("{}: {:.2} s", words(phase), state.began.elapsed().as_secs_f64());
            match &self.show {
                Show::Bar(bar) => bar.suspend(|| output::note(&line)),
                _ => output::note(&line),
            }
        }
    }

    /// A thread that panicked while it reported left nothing half done.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Watch for Progress {
    fn progress(&self, phase: Phase, done: usize, total: usize, irregular: Option<usize>) {
        let mut state = self.lock();
        if state.phase != Some(phase) {
            self.enter(&mut state, phase);
        }
        let left = irregular.map(|n| format!("{n} irregular")).unwrap_or_default();
        match &self.show {
            Show::Bar(bar) => {
                bar.set_length(total as u64);
                bar.set_position(done as u64);
                bar.set_message(left);
            }
            Show::Lines if state.told.elapsed() >= PAUSE => {
                state.told = Instant::now();
                let comma = if left.is_empty() { "" } else { ", " };
                output::note(&format!("{}: {done} of {total}{comma}{left}", words(phase)));
            }
            Show::Nothing | Show::Lines => {}
        }
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
    }
}
