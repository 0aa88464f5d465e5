//! How long work reports its progress and learns that it should stop.
//!
//! Library code takes a [`Watch`] instead of printing or looking at a clock.

/// A stage of the pipeline, for progress display and timings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Phase {
    /// Reading and mending the input.
    Read,
    /// Preparing the reference surface.
    Reference,
    /// Searching for edits.
    Plan,
    /// Applying edits.
    Edit,
    /// Moving vertices.
    Smooth,
    /// Measuring before and after.
    Measure,
    /// Writing results.
    Write,
    /// Trying configurations.
    Tune,
}

/// Receiver of progress; asked regularly whether to go on.
pub trait Watch: Sync {
    /// `done` of `total` units of `phase` are finished; `irregular` elements are left if known.
    fn progress(&self, phase: Phase, done: usize, total: usize, irregular: Option<usize>) {
        let _ = (phase, done, total, irregular);
    }

    /// Stage `stage` of `stages` of planning begins, counted from 0; each takes about as long.
    fn stage(&self, stage: u32, stages: u32) {
        let _ = (stage, stages);
    }

    /// So many edits have been made so far; this is the irregularity that is left.
    fn edited(&self, edits: usize, irregularity: u64) {
        let _ = (edits, irregularity);
    }

    /// Whether the caller wants the best result so far instead of more work.
    fn cancelled(&self) -> bool {
        false
    }
}

/// Watches nothing and never cancels.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Watch for Silent {}
