//! When a run is to end with what it has: at a time limit, or when it is interrupted.
//!
//! The first interrupt asks for the best result so far; the second one ends the program at once,
//! and leaves the outputs as they were.

use std::str::FromStr;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use clap::Args;

use super::failure::Failure;
use super::{Exit, output};

/// How often the run was interrupted.
static INTERRUPTS: AtomicUsize = AtomicUsize::new(0);
/// Whether the handler is there, or why not; a program can have one.
static HANDLER: OnceLock<Result<(), String>> = OnceLock::new();

/// How long a run may take.
#[derive(Debug, Args)]
#[command(next_help_heading = "Time")]
pub(super) struct Patience {
    /// End after about so many seconds with the best mesh so far: valid, smoothed, within its
    /// budgets. What comes out then depends on the speed of the machine. Ctrl-C (or SIGTERM) does
    /// the same and exits with code 130; a second one ends at once and writes nothing
    /// [default: none]
    #[arg(long, value_name = "SECONDS")]
    time_limit: Option<Seconds>,
}

/// A length of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Seconds(pub(super) Duration);

impl FromStr for Seconds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let seconds = text.parse().ok().and_then(|s| Duration::try_from_secs_f64(s).ok());
        seconds.map(Self).ok_or_else(|| "seconds are a number from 0, for example 90".to_owned())
    }
}

impl Patience {
    /// Listens for interrupts, and lets the time run.
    pub(super) fn begin(&self) -> Result<Stop, Failure> {
        Stop::listen(self.time_limit.map(|limit| limit.0))
    }
}

/// Why a run ends early.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cause {
    /// Its time is over.
    TimeLimit,
    /// Somebody wants it to end.
    Interrupt,
}

/// Tells when a run is to end.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Stop {
    listens: bool,
    deadline: Option<Instant>,
}

impl Stop {
    /// At an interrupt or after `limit`, whichever is first.
    pub(super) fn listen(limit: Option<Duration>) -> Result<Self, Failure> {
        let handler =
            HANDLER.get_or_init(|| ctrlc::set_handler(interrupt).map_err(|e| e.to_string()));
        handler.as_ref().map_err(|e| Failure::usage(format!("cannot listen for Ctrl-C: {e}")))?;
        // A limit beyond what the clock can count is none.
        let deadline = limit.and_then(|limit| Instant::now().checked_add(limit));
        Ok(Self { listens: true, deadline })
    }

    /// Why the run is to end, if it is.
    pub(super) fn cause(&self) -> Option<Cause> {
        if self.listens && INTERRUPTS.load(Ordering::Relaxed) > 0 {
            return Some(Cause::Interrupt);
        }
        self.deadline.filter(|&end| Instant::now() >= end).map(|_| Cause::TimeLimit)
    }

    /// How much time there is.
    pub(super) fn left(&self) -> Option<Duration> {
        self.deadline.map(|end| end.saturating_duration_since(Instant::now()))
    }

    /// The exit code of a run that would have ended with `exit`.
    pub(super) fn exit(&self, exit: Exit) -> Exit {
        if self.cause() == Some(Cause::Interrupt) { Exit::Interrupted } else { exit }
    }
}

fn interrupt() {
    if INTERRUPTS.fetch_add(1, Ordering::Relaxed) == 0 {
        output::note("interrupted: ending with the best result so far; once more ends at once");
    } else {
        std::process::exit(i32::from(Exit::Interrupted as u8));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_are_finite_and_not_negative() {
        let parse = |text: &str| text.parse::<Seconds>().ok().map(|s| s.0);
        assert_eq!(parse("1.5"), Some(Duration::from_millis(1500)));
        assert_eq!(parse("0"), Some(Duration::ZERO));
        for wrong in ["-1", "nan", "inf", "2s", ""] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn a_limit_passes_and_none_does_not() {
        let ends = |deadline| Stop { listens: false, deadline }.cause();
        assert_eq!(ends(Some(Instant::now())), Some(Cause::TimeLimit));
        assert_eq!(ends(Some(Instant::now() + Duration::from_secs(60))), None);
        assert_eq!(ends(None), None);
    }
}
