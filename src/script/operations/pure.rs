//! Irregular faces to irregular vertices, and back.

use super::Operation;
use crate::moves::pure::Kind;
use crate::pipeline::pure_quad::{Settled, convert_settled};
use crate::script::error::Trouble;
use crate::script::run::Done;
use crate::script::session::Session;
use crate::smooth::orientation;
use crate::sqrtcc::lower;
use crate::watch::Watch;
use serde::Deserialize;

/// Converts every irregular face that parity allows: a pure quad mesh.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PureQuad {}

impl Operation for PureQuad {
    fn run(&self, session: &mut Session, watch: &dyn Watch) -> Result<Done, Trouble> {
        convert(session, Kind::Faces, watch)
    }
}

/// Converts every irregular vertex for which a way is found.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FacesFromVertices {}

impl Operation for FacesFromVertices {
    fn run(&self, session: &mut Session, watch: &dyn Watch) -> Result<Done, Trouble> {
        convert(session, Kind::Vertices, watch)
    }
}

/// What cannot be converted is told and is a result, no refusal.
fn convert(session: &mut Session, kind: Kind, watch: &dyn Watch) -> Result<Done, Trouble> {
    let lowered = lower(session.mesh(), session.group_names)
        .map_err(|error| Trouble::other(error.to_string()))?;
    let surface = (session.reference, orientation(&lowered.mesh, session.reference));
    let relax = &session.config.relax;
    let Settled { conversion, .. } =
        convert_settled(session.mesh_mut(), kind, surface, relax, watch);
    let done = format!(
        "{} divided, {} pairs converted, {} left",
        conversion.divided,
        conversion.pairs,
        conversion.left.len()
    );
    let obstructions = conversion.obstructions.iter().map(ToString::to_string);
    let words = std::iter::once(done).chain(obstructions).collect::<Vec<_>>().join("; ");
    Ok(Done { words, results: conversion.left, ops: conversion.ops, ..Done::default() })
}
