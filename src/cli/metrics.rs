//! `quadmend metrics`: what a mesh is like.

use std::path::PathBuf;

use clap::Args;
use quadmend::metrics::table;

use super::Exit;
use super::failure::Failure;
use super::limits::{self, Limit};
use super::measuring::Measuring;
use super::output;
use super::paths::short_name;

const EXAMPLES: &str = "\
Examples:
  quadmend metrics remesh.obj
  quadmend metrics clean.obj --reference scan.obj --json > clean.json
  quadmend metrics clean.obj --fail-if 't_junctions>0' --fail-if 'flipped_faces>0'

The mesh is measured as it is, without mending it first. Lengths relative to a bounding box are
relative to its diagonal.";

/// Measure a mesh: connectivity, irregular elements, quality, distance to a reference
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct MetricsCommand {
    /// The mesh to measure (OBJ, PLY or OFF, - for standard input)
    mesh: PathBuf,

    /// Exit with code 4 if a metric is beyond a limit, for example `irregular_elements>100` or
    /// `scaled_jacobian_min<0.1`; names and units are those of --json; may be repeated
    /// [default: no limit]
    #[arg(long, value_name = "LIMIT")]
    fail_if: Vec<Limit>,

    #[command(flatten)]
    measuring: Measuring,
}

impl MetricsCommand {
    pub(super) fn run(&self) -> Result<Exit, Failure> {
        let measured = self.measuring.measure(&[&self.mesh])?;
        let name = short_name(&self.mesh);
        let mut exit = Exit::Done;
        for metrics in measured.meshes.iter().map(|m| &m.metrics) {
            let json = self.measuring.json;
            output::data(&if json { output::json(metrics)? } else { table(&[(&name, metrics)]) })?;
            exit = limits::check(&self.fail_if, metrics, exit);
        }
        Ok(exit)
    }
}
