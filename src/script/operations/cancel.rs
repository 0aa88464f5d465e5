//! Cancelling T-junctions, triples and quadruples (Peng & Wonka 2013, Proposition 3.7).

use super::Operation;
use super::movement::{ends, kinds, route, standing, stops};
use crate::moves::cancel::{Cancelled, Outcome, Remainder, quadruple, triple};
use crate::script::address::{Address, Select, dislocation, nearest};
use crate::script::error::Trouble;
use crate::script::run::Done;
use crate::script::session::Session;
use crate::sqrtcc::Vertex;
use crate::watch::Watch;
use serde::Deserialize;

/// Cancels T-junctions with one another.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CancelTJunctions {
    at: Address,
    with: Option<Address>,
    #[serde(default)]
    left: Remainder,
    #[serde(default)]
    path: Vec<Address>,
}

impl Operation for CancelTJunctions {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        pairs(session, (&self.at, self.with.as_ref()), self.left, &self.path, Select::TJunctions)
    }
}

/// Cancels any two dislocations with one another.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CancelQuadruple {
    at: Address,
    with: Option<Address>,
    #[serde(default)]
    left: Remainder,
    #[serde(default)]
    path: Vec<Address>,
}

impl Operation for CancelQuadruple {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        pairs(session, (&self.at, self.with.as_ref()), self.left, &self.path, Select::Dislocations)
    }
}

/// Cancels each of the dislocations `at` with the one `with`, or the nearest.
fn pairs(
    session: &mut Session,
    (at, with): (&Address, Option<&Address>),
    left: Remainder,
    path: &[Address],
    select: Select,
) -> Result<Done, Trouble> {
    let elements = at.find(session, select)?;
    let stops = stops(session, path)?;
    session.each(&elements, select, |session, v| {
        let one = standing(session, v)?;
        let other = other_end(session, with, v, select)?;
        let other = standing(session, other)?;
        let done = quadruple(session.mesh_mut(), [one, other], left, route(&stops))?;
        Ok(told(session, done))
    })
}

/// Where the other one stands: at the address, or the nearest that shares no element with the
/// dislocation at `v`.
fn other_end(
    session: &Session,
    address: Option<&Address>,
    v: Vertex,
    select: Select,
) -> Result<Vertex, Trouble> {
    if let Some(address) = address {
        return address.one(session, select);
    }
    let mesh = session.mesh();
    let five = dislocation(mesh, v).map(|d| mesh.target(d.0));
    let shares = |&w: &Vertex| dislocation(mesh, w).map(|d| mesh.target(d.0)) == five;
    let but: Vec<Vertex> =
        five.into_iter().flat_map(|five| mesh.neighbours(five)).filter(shares).chain([v]).collect();
    nearest(mesh, mesh.location(v), select, &but)
}

fn told(session: &Session, done: Cancelled) -> Done {
    let words = match done.outcome {
        Outcome::Complete => "complete: all four are gone".to_owned(),
        _ => format!("left: {}", kinds(session, &done.left.unwrap_or_default())),
    };
    Done {
        words,
        results: done.left.into_iter().flatten().collect(),
        ops: done.ops,
        ..Done::default()
    }
}

/// Lets a lone element swallow a dislocation.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CancelTriple {
    at: Address,
    with: Option<Address>,
    #[serde(default)]
    path: Vec<Address>,
}

impl Operation for CancelTriple {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let elements = self.at.find(session, Select::Dislocations)?;
        let stops = stops(session, &self.path)?;
        session.each(&elements, Select::Dislocations, |session, v| {
            let dipole = standing(session, v)?;
            let own = ends(session, dipole);
            let lone = if let Some(address) = &self.with {
                address.one(session, Select::Irregular)?
            } else {
                let mesh = session.mesh();
                nearest(mesh, mesh.location(v), Select::Irregular, &own)?
            };
            let done = triple(session.mesh_mut(), dipole, lone, route(&stops))?;
            let words = format!("left: {}", kinds(session, &[done.left.at]));
            Ok(Done { words, results: vec![done.left.at], ops: done.ops, ..Done::default() })
        })
    }
}
