//! Moving, converting and merging irregular elements (Peng & Wonka 2013, section 3.4).

use super::Operation;
use crate::moves::conversion::{Generate, convert, generate_pairs};
use crate::moves::merge::{merge, split_element};
use crate::moves::pair::{self, Direction, Moved};
use crate::moves::t_junction;
use crate::moves::{Dipole, Element, MoveRefusal, Route, Step};
use crate::script::address::{Address, Select, dislocation, nearest};
use crate::script::error::Trouble;
use crate::script::run::Done;
use crate::script::session::Session;
use crate::sqrtcc::{QuadMesh, Vertex};
use crate::watch::Watch;
use serde::Deserialize;

/// Moves two irregular elements together.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MovePair {
    at: Address,
    with: Option<Address>,
    to: Direction,
    #[serde(default = "once")]
    steps: u32,
    #[serde(default)]
    path: Vec<Address>,
}

fn once() -> u32 {
    1
}

impl Operation for MovePair {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let at = self.at.one(session, Select::Irregular)?;
        let opposite = Direction::OPPOSITE.contains(&self.to);
        let with = partner(session, self.with.as_ref(), at, |a, b| (a != b) == opposite)?;
        let stops = stops(session, &self.path)?;
        let moved = pair::shift(session.mesh_mut(), [at, with], self.to, self.steps, route(&stops));
        moved.map(|m| told(session, m)).map_err(|refusal| Trouble::from(refusal).at(at))
    }
}

/// Changes the type of two irregular elements.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ChangeType {
    at: Address,
    with: Option<Address>,
    #[serde(default)]
    path: Vec<Address>,
}

impl Operation for ChangeType {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let elements = self.at.find(session, Select::Irregular)?;
        let stops = stops(session, &self.path)?;
        session.each(&elements, Select::Irregular, |session, at| {
            let with = partner(session, self.with.as_ref(), at, |_, _| true)?;
            let moved = pair::change_type(session.mesh_mut(), [at, with], route(&stops))?;
            Ok(told(session, moved))
        })
    }
}

/// Converts single elements to the other type, at the price of a pair each.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Convert {
    at: Address,
    towards: Option<Address>,
}

impl Operation for Convert {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let elements = self.at.find(session, Select::Irregular)?;
        let towards =
            self.towards.as_ref().map(|a| a.one(session, Select::Elements)).transpose()?;
        session.each(&elements, Select::Irregular, |session, v| {
            let done = convert(session.mesh_mut(), v, towards)?;
            let ends = ends(session, done.pair);
            let words = format!("now {}", kinds(session, &[done.element, ends[0], ends[1]]));
            Ok(Done {
                words,
                results: vec![done.element, ends[0], ends[1]],
                ops: vec![done.op],
                ..Done::default()
            })
        })
    }
}

/// Makes two adjacent pairs out of nothing.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GeneratePairs {
    at: Address,
    what: Generate,
}

impl Operation for GeneratePairs {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let faces = self.what == Generate::Duals;
        let v = self.at.one(session, if faces { Select::Faces } else { Select::Vertices })?;
        let (pairs, op) = generate_pairs(session.mesh_mut(), v, self.what)
            .map_err(|refusal| Trouble::from(refusal).at(v))?;
        let results = pairs.map(|d| ends(session, d)).concat();
        let words = format!("made {}", kinds(session, &results));
        Ok(Done { words, results, ops: vec![op], ..Done::default() })
    }
}

/// Merges two elements of index −1.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Merge {
    at: Address,
    with: Option<Address>,
    #[serde(default)]
    path: Vec<Address>,
}

impl Operation for Merge {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let at = self.at.one(session, Select::Irregular)?;
        let with = partner(session, self.with.as_ref(), at, |a, b| a == b)?;
        let stops = stops(session, &self.path)?;
        let merged = merge(session.mesh_mut(), [at, with], route(&stops))
            .map_err(|refusal| Trouble::from(refusal).at(at))?;
        let words = format!("now {}", session.name(merged.element));
        Ok(Done { words, results: vec![merged.element], ops: merged.ops, ..Done::default() })
    }
}

/// Splits an element of index −2.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SplitElement {
    at: Address,
    through: Option<Address>,
}

impl Operation for SplitElement {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let elements = self.at.find(session, Select::Six)?;
        let through =
            self.through.as_ref().map(|a| a.one(session, Select::Elements)).transpose()?;
        session.each(&elements, Select::Six, |session, v| {
            let (pair, made) = split_element(session.mesh_mut(), v, through)?;
            let words = format!("now {}", kinds(session, &pair));
            Ok(Done { words, results: pair.to_vec(), ops: vec![made.op], ..Done::default() })
        })
    }
}

/// Moves T-junctions by whole edges.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MoveTJunction {
    at: Address,
    to: t_junction::Direction,
    #[serde(default = "once")]
    edges: u32,
}

impl Operation for MoveTJunction {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let elements = self.at.find(session, Select::TJunctions)?;
        session.each(&elements, Select::TJunctions, |session, v| {
            let at = t_junction::at(session.mesh(), v)?;
            let done = t_junction::shift(session.mesh_mut(), at, self.to, self.edges)?;
            let results = ends(session, done.dipole).to_vec();
            let words = format!("now at {}", session.name(results[0]));
            Ok(Done { words, results, ops: done.ops, ..Done::default() })
        })
    }
}

/// Walks a T-junction, or a dual one, by single steps that the script chooses.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Walk {
    at: Option<Address>,
    /// The half-edge of the √CC mesh from its edge too few to the one too many: what logs have.
    start: Option<Dipole>,
    steps: Vec<Step>,
}

impl Operation for Walk {
    fn run(&self, session: &mut Session, _: &dyn Watch) -> Result<Done, Trouble> {
        let start = self.place(session)?;
        let v = session.mesh().origin(start.0);
        let mut at = Some(start);
        let mut ops = Vec::new();
        for (i, &step) in self.steps.iter().enumerate() {
            let gone =
                || Trouble::other(format!("it was absorbed before step {} of its way", i + 1));
            let stepped = at.ok_or_else(gone)?.step(session.mesh_mut(), step);
            let stepped = stepped.map_err(|refusal| Trouble::from(refusal).at(v))?;
            ops.push(stepped.op);
            at = stepped.dipole;
        }
        let results = at.map_or_else(Vec::new, |d| ends(session, d).to_vec());
        let words = match results.first() {
            Some(&x) => format!("now at {}", session.name(x)),
            None => "absorbed".to_owned(),
        };
        Ok(Done { words, results, ops, ..Done::default() })
    }
}

impl Walk {
    /// Where the walk begins.
    fn place(&self, session: &Session) -> Result<Dipole, Trouble> {
        match (&self.at, self.start) {
            (Some(address), None) => {
                let v = address.one(session, Select::Dislocations)?;
                standing(session, v)
            }
            (None, Some(start)) => {
                let (mesh, quad) = (session.mesh(), QuadMesh::quad(start.0));
                let is_there = quad < mesh.quad_ids() && mesh.is_quad_alive(quad);
                if is_there && start.stands(mesh) {
                    Ok(start)
                } else {
                    Err(MoveRefusal::NotADislocation.into())
                }
            }
            _ => Err(Trouble::other("a walk begins either `at` an address or at a `start`")),
        }
    }
}

/// The dislocation with its edge too few at `v`.
pub(super) fn standing(session: &Session, v: Vertex) -> Result<Dipole, Trouble> {
    let refusal = || Trouble::from(MoveRefusal::NotADislocation).at(v);
    dislocation(session.mesh(), v).ok_or_else(refusal)
}

/// The elements of a dislocation.
pub(super) fn ends(session: &Session, dipole: Dipole) -> [Vertex; 2] {
    [session.mesh().origin(dipole.0), session.mesh().target(dipole.0)]
}

/// The elements that a path leads through.
pub(super) fn stops(session: &Session, path: &[Address]) -> Result<Vec<Vertex>, Trouble> {
    path.iter().map(|address| address.one(session, Select::Elements)).collect()
}

pub(super) fn route(stops: &[Vertex]) -> Route<'_> {
    if stops.is_empty() { Route::Found } else { Route::Through(stops) }
}

/// The other element of a pair: the one that is addressed, or the nearest with a suitable index.
fn partner(
    session: &Session,
    address: Option<&Address>,
    at: Vertex,
    suits: impl Fn(i32, i32) -> bool,
) -> Result<Vertex, Trouble> {
    if let Some(address) = address {
        return address.one(session, Select::Irregular);
    }
    let mesh = session.mesh();
    let first = Element::at(mesh, at).map_err(|refusal| Trouble::from(refusal).at(at))?;
    let unsuitable = Element::all(mesh)
        .filter(|other| !suits(first.kind.index(), other.kind.index()))
        .map(|other| other.at);
    let but: Vec<Vertex> = unsuitable.chain([at]).collect();
    nearest(mesh, mesh.location(at), Select::Irregular, &but)
}

fn told(session: &Session, moved: Moved) -> Done {
    let words = format!("now {}", kinds(session, &moved.pair));
    Done { words, results: moved.pair.to_vec(), ops: moved.ops, ..Done::default() }
}

/// The elements with their kinds.
pub(super) fn kinds(session: &Session, elements: &[Vertex]) -> String {
    let word = |&v: &Vertex| match Element::at(session.mesh(), v) {
        Ok(element) => format!("{} at {}", element.kind, session.name(v)),
        Err(_) => session.name(v),
    };
    elements.iter().map(word).collect::<Vec<_>>().join(", ")
}
