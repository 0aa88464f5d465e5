//! What every run begins with, a mended mesh and a surface to stay on, and what it ends with.

use super::CleanError;
use crate::config::Config;
use crate::mesh::{MendPolicy, MendReport, PolyMesh, Topology, check_connected, mend_connected};
use crate::metrics::{Metrics, Target, measure_connected};
use crate::surface::Reference;
use std::sync::Arc;

/// A mended mesh, and the surface to stay on.
pub(super) struct Prepared {
    pub(super) mesh: PolyMesh,
    pub(super) topology: Topology,
    pub(super) mends: MendReport,
    pub(super) surface: Arc<Reference>,
}

impl Prepared {
    /// Mends `mesh` and prepares the surface of `reference`, at the same time, or its own.
    pub(super) fn new(
        mesh: PolyMesh,
        reference: Option<&PolyMesh>,
        policy: MendPolicy,
    ) -> Result<Self, CleanError> {
        let (mended, given) =
            rayon::join(|| mend_connected(mesh, policy), || reference.map(Reference::new));
        let (mesh, topology, mends) = mended?;
        let surface = given.unwrap_or_else(|| Reference::connected(&mesh, &topology))?;
        Ok(Self { mesh, topology, mends, surface: Arc::new(surface) })
    }

    /// What is measured against: the surface of `reference`, with which this was made.
    pub(super) fn target(&self, reference: Option<&PolyMesh>, config: &Config) -> Target {
        let mesh = reference.unwrap_or(&self.mesh);
        Target::on(Arc::clone(&self.surface), mesh, &config.measure)
    }
}

/// The metrics of what is to be written, which must be clean.
pub(super) fn measure_clean(mesh: &PolyMesh, target: &Target) -> Result<Metrics, CleanError> {
    let topology = Topology::new(mesh);
    check_connected(mesh, &topology).map_err(CleanError::Flawed)?;
    Ok(measure_connected((mesh, &topology), Some(target))?)
}
