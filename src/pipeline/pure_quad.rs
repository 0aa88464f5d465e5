//! From a quad-dominant mesh to one of quads only: mend → lift → convert → relax → lower.
//!
//! The connectivity is the work of [`crate::moves::pure`]; here the surroundings of each change
//! are relaxed on the reference, and at the end all of them together within the budget of
//! distance. What is far from any change stays as it is, to the bit.

use super::prepare::{Prepared, measure_clean};
use super::{CleanError, budget, lift_held};
use crate::config::Config;
use crate::mesh::{MendPolicy, MendReport, MeshError, PolyMesh};
use crate::metrics::{Metrics, measure};
use crate::moves::pure::{self, Conversion, Kind};
use crate::smooth::{Budget, Orientation, RelaxOptions, Surroundings, orientation, smooth};
use crate::sqrtcc::{QuadMesh, Vertex, lower};
use crate::surface::{Reference, mean_edge};
use crate::watch::{Phase, Watch};
use serde::Serialize;

/// Rings of faces around a change that are relaxed with it.
const RINGS: u32 = 3;
/// Iterations of relaxing after each change.
const SWEEPS: u32 = 24;
/// A change after which a quad has a scaled Jacobian below this is made only if there is no other.
const POOR: f64 = 0.25;

/// What was done to a mesh.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Defects that were mended before anything else.
    pub mends: MendReport,
    /// Edges that were held as sharp features.
    pub feature_edges: usize,
    /// The mesh as it was read.
    pub before: Metrics,
    /// The mesh that is returned.
    pub after: Metrics,
    /// The change of connectivity.
    pub conversion: Conversion,
}

/// A converted mesh and how it came about.
#[derive(Debug, Clone)]
pub struct Converted {
    /// The mesh: quads only, unless the report names what must be left.
    pub mesh: PolyMesh,
    /// What was done.
    pub report: Report,
}

/// Converts every face of `mesh` that is no quad, on the surface of `reference` (its own if there
/// is none). Boundaries, features and their vertices stay as they are.
pub fn pure_quad(
    mesh: PolyMesh,
    reference: Option<&PolyMesh>,
    policy: MendPolicy,
    config: &Config,
    watch: &dyn Watch,
) -> Result<Converted, CleanError> {
    let raw = mesh.clone();
    watch.progress(Phase::Measure, 0, 2, None);
    let prepared = Prepared::new(mesh, reference, policy)?;
    let target = prepared.target(reference, config);
    let before = measure(&raw, Some(&target))?;
    let (q, feature_edges, conversion) = edit(&prepared, config, watch)?;
    let Prepared { mesh, mends, .. } = prepared;
    let result = lower(&q, mesh.group_names())?.mesh;
    watch.progress(Phase::Measure, 1, 2, None);
    let after = measure_clean(&result, &target)?;
    let report = Report { mends, feature_edges, before, after, conversion };
    Ok(Converted { mesh: result, report })
}

/// Lifts, converts and smooths; also the number of feature edges.
fn edit(
    Prepared { mesh, topology, surface, .. }: &Prepared,
    config: &Config,
    watch: &dyn Watch,
) -> Result<(QuadMesh, usize, Conversion), CleanError> {
    let reference = &**surface;
    let allowed = budget(mesh, reference, (&config.gate, mean_edge(mesh, topology)))?;
    let (mut q, feature_edges) = lift_held(mesh, topology, reference, &config.features)?;
    let surface = (reference, orientation(mesh, reference));
    let Settled { conversion, touched } =
        convert_settled(&mut q, Kind::Faces, surface, &config.relax, watch);
    smooth_within(&mut q, Some(&touched), (reference, allowed), config, watch)?;
    q.commit();
    Ok((q, feature_edges, conversion))
}

/// Converts every face of a mesh that has been cleaned, and smooths first what has changed, which
/// brings it back near the surface, and from there all of it.
pub(super) fn convert_cleaned(
    q: &mut QuadMesh,
    surface: (&Reference, Orientation),
    allowed: Budget,
    config: &Config,
    watch: &dyn Watch,
) -> Result<Conversion, MeshError> {
    let Settled { conversion, touched } =
        convert_settled(q, Kind::Faces, surface, &config.relax, watch);
    if !conversion.ops.is_empty() {
        for around in [Some(&*touched), None] {
            smooth_within(q, around, (surface.0, allowed), config, watch)?;
        }
    }
    Ok(conversion)
}

/// A conversion, and the vertices that it tried to change.
pub(crate) struct Settled {
    pub(crate) conversion: Conversion,
    pub(crate) touched: Vec<Vertex>,
}

/// Converts, and relaxes the surroundings of each change on the surface.
pub(crate) fn convert_settled(
    q: &mut QuadMesh,
    kind: Kind,
    (reference, side): (&Reference, Orientation),
    relax: &RelaxOptions,
    watch: &dyn Watch,
) -> Settled {
    let mut touched = Vec::new();
    let mut settle = |q: &mut QuadMesh, changed: &[Vertex]| {
        let around = Surroundings::gather(q, changed, RINGS);
        touched.extend_from_slice(changed);
        around.relax(q, (reference, side), relax, SWEEPS) - POOR
    };
    let conversion = pure::convert(q, kind, &mut settle, watch);
    Settled { conversion, touched }
}

/// Smooths what is near the `touched` vertices, or everything, within the budget of distance.
fn smooth_within(
    q: &mut QuadMesh,
    touched: Option<&[Vertex]>,
    (reference, allowed): (&Reference, Budget),
    config: &Config,
    watch: &dyn Watch,
) -> Result<(), MeshError> {
    let lowered = lower(q, &[String::new()])?;
    let held = touched.map(|touched| {
        let mut held = vec![true; q.vertex_ids() as usize];
        for v in Surroundings::gather(q, touched, RINGS).free(q) {
            held[v as usize] = false;
        }
        lowered.vertex_ids.iter().map(|&v| held[v as usize]).collect()
    });
    let held: Vec<bool> = held.unwrap_or_else(|| lowered.held.clone());
    let budget = Budget {
        rms: allowed.rms * config.smooth.budget,
        hausdorff: allowed.hausdorff * config.smooth.budget,
    };
    let options = (&config.smooth, &config.relax);
    let (points, _) = smooth(&lowered.mesh, &held, reference, options, Some(budget), watch);
    for (&v, point) in lowered.vertex_ids.iter().zip(points) {
        q.set_position(v, point);
    }
    Ok(())
}
