//! `quadmend optimize`: planar or equiangular faces on the connectivity that is there.

use std::fmt::Write;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use quadmend::optimize;
use quadmend::pipeline::optimize::{Report, State, optimize};
use quadmend::watch::{Phase, Watch};

use super::failure::Failure;
use super::output::MeshFormat;
use super::paths::is_stream;
use super::source::Source;
use super::stop::Patience;
use super::{Exit, output};

const EXAMPLES: &str = "\
Examples:
  quadmend optimize clean.obj --goal planar --reference scan.obj -o panels.obj
  quadmend optimize clean.obj --goal angles -o fair.obj --json report.json
  quadmend optimize clean.obj --goal planar --set optimize.rms_edges=0.2 -o flat.obj

Only vertices move; boundaries, features and their vertices stay. The distance to the reference
keeps to optimize.hausdorff_edges and optimize.rms_edges. Planarity is how far the corners of a face are from a
plane, over its mean diagonal (triangles are not counted); the deviation of angles is from the
mean angle of the face.";

/// Move vertices for planar or equiangular faces; the connectivity stays
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct Optimize {
    /// What to optimise
    #[arg(long)]
    goal: Goal,

    /// Where the result goes (- for standard output); never an input unless --force is given
    #[arg(short, long, value_name = "MESH")]
    output: PathBuf,

    /// Write the report as JSON (- for standard output) [default: none]
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

    #[command(flatten)]
    format: MeshFormat,

    #[command(flatten)]
    source: Source,

    #[command(flatten)]
    patience: Patience,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Goal {
    /// Each face in a plane
    Planar,
    /// Equal angles in each face
    Angles,
}

impl Optimize {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        self.check_paths()?;
        let destination = self.format.to(&self.output)?;
        let mut begun = self.source.begin(self.patience.begin()?)?;
        let goal = match self.goal {
            Goal::Planar => optimize::Goal::Planar,
            Goal::Angles => optimize::Goal::Angles,
        };
        let (mesh, surface) = (begun.take_mesh(), begun.surface());
        let done = optimize(mesh, surface, goal, begun.policy, &begun.config, &begun.progress)
            .map_err(|e| self.source.failure(e))?;
        begun.progress.progress(Phase::Write, 0, 1, None);
        destination.write(&done.mesh)?;
        if let Some(path) = &self.json {
            output::file(path, &output::json(&done.report)?)?;
        }
        begun.progress.finish();
        self.tell(&done.report)?;
        Ok(begun.stop.exit(Exit::Done))
    }

    fn check_paths(&self) -> Result<(), Failure> {
        let json = self.json.as_deref();
        self.source.check_paths(None, Some(&self.output), json.as_slice())
    }

    fn tell(&self, report: &Report) -> Result<(), Failure> {
        if self.source.quiet() {
            return Ok(());
        }
        for mend in &report.mends.mends {
            output::note(&format!("mended: {}", mend.sentence));
        }
        let table = table(report);
        let taken = is_stream(&self.output) || self.json.as_deref().is_some_and(is_stream);
        output::table(&table, taken)
    }
}

/// A line of the table: label and value.
type Line = (&'static str, fn(&State) -> f64);

const LINES: &[Line] = &[
    ("planarity, mean", |s| s.fairness.planarity.mean),
    ("planarity, largest", |s| s.fairness.planarity.max),
    ("deviation of angles, mean [deg]", |s| s.fairness.angle_deviation_deg.mean),
    ("deviation of angles, largest [deg]", |s| s.fairness.angle_deviation_deg.max),
    ("Hausdorff distance [% of diagonal]", |s| 100.0 * s.hausdorff_rel),
    ("RMS distance [% of diagonal]", |s| 100.0 * s.rms_rel),
];

fn table(report: &Report) -> String {
    let mut text = format!("{:<36} {:>10} {:>10}\n", "", "before", "after");
    for (label, value) in LINES {
        let (before, after) = (value(&report.before), value(&report.after));
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{label:<36} {before:>10.5} {after:>10.5}");
    }
    text
}
