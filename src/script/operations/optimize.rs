//! Planar or equiangular faces, on the connectivity as it is.

use super::Operation;
use crate::mesh::Topology;
use crate::optimize::{Fairness, Goal, Options, optimize};
use crate::pipeline::optimize::allowed;
use crate::script::error::Trouble;
use crate::script::run::Done;
use crate::script::session::Session;
use crate::sqrtcc::lower;
use crate::watch::Watch;
use serde::Deserialize;

/// Moves all vertices that nothing holds towards a goal, near the reference.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Optimize {
    goal: Goal,
}

impl Operation for Optimize {
    fn run(&self, session: &mut Session, watch: &dyn Watch) -> Result<Done, Trouble> {
        let other = |error: String| Trouble::other(error);
        let mut lowered =
            lower(session.mesh(), session.group_names).map_err(|error| other(error.to_string()))?;
        let config = session.config;
        let topology = Topology::new(&lowered.mesh);
        let allowed = allowed((&lowered.mesh, &topology), session.reference, config)
            .map_err(|error| other(error.to_string()))?;
        let options =
            Options { optimize: &config.optimize, smooth: &config.smooth, relax: &config.relax };
        let goal = (self.goal, options);
        let before = Fairness::of(&lowered.mesh);
        let points =
            optimize(&lowered.mesh, &lowered.held, session.reference, goal, allowed, watch);
        for (&v, &point) in lowered.vertex_ids.iter().zip(&points) {
            session.mesh_mut().set_position(v, point);
        }
        lowered.mesh.set_points(points);
        let after = Fairness::of(&lowered.mesh);
        let words = format!(
            "planarity {:.5} → {:.5}, angles {:.2}° → {:.2}° in the mean",
            before.planarity.mean,
            after.planarity.mean,
            before.angle_deviation_deg.mean,
            after.angle_deviation_deg.mean
        );
        Ok(Done { words, ..Done::default() })
    }
}
