//! Smoothing between edits: new vertices have only a rough place.

use super::Operation;
use crate::script::error::Trouble;
use crate::script::run::Done;
use crate::script::session::Session;
use crate::smooth::{SmoothOptions, smooth};
use crate::sqrtcc::lower;
use crate::watch::Watch;
use serde::Deserialize;

/// Moves all vertices that nothing holds for good face shapes, on the reference.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Smooth {
    /// Most iterations; by default what the configuration says.
    iterations: Option<u32>,
}

impl Operation for Smooth {
    fn run(&self, session: &mut Session, watch: &dyn Watch) -> Result<Done, Trouble> {
        let lowered = lower(session.mesh(), session.group_names)
            .map_err(|error| Trouble::other(error.to_string()))?;
        let iterations = self.iterations.unwrap_or(session.config.smooth.iterations);
        let options = SmoothOptions { iterations, ..session.config.smooth.clone() };
        let settings = (&options, &session.config.relax);
        let (points, report) =
            smooth(&lowered.mesh, &lowered.held, session.reference, settings, None, watch);
        for (&v, point) in lowered.vertex_ids.iter().zip(points) {
            session.mesh_mut().set_position(v, point);
        }
        let words = format!("{} iterations", report.iterations);
        Ok(Done { words, ..Done::default() })
    }
}
