//! Pure conversion: every irregular face becomes irregular vertices (a pure quad mesh), or every
//! irregular vertex becomes irregular faces.
//!
//! ```text
//!   a─────b─────c          a─────b─────c     An f3 and an f5 that share an edge: an edge shift
//!   │ \   f5    │          │     │     │     makes them quads; a loses an edge (v3) and b gains
//!   │   \       │   ──►    │     │     │     one (v5). Apart from one another, the f3 emits a
//!   │ f3  \     │          │     │     │     dislocation that walks to the f5 and is absorbed
//!   d─────e─────f          d─────e─────f     there.
//! ```
//! Large even elements are divided. Odd ones can only go in pairs: the number of odd faces of a
//! part of the mesh between frozen edges has the parity of the number of those edges, whatever is
//! done inside ([`Obstruction`]). In regular surroundings a pair goes at the same E: the emission
//! leaves a vertex where the face was, and the absorption one where the other was.
//! Source: Peng & Wonka 2013, section 3.3 (type change, Proposition 3.4; single conversion,
//! Figure 8) and Figure 11 (make pure quad).

mod effect;
mod parity;
mod search;

pub use effect::Kind;
pub use parity::{Obstruction, obstructions};

use crate::ops::{Op, Split};
use crate::sqrtcc::{QuadMesh, Vertex};
use crate::watch::{Phase, Watch};
use search::{Limits, Search};
use serde::Serialize;

/// Longest paths of the rounds, in operations: near pairs go first.
const REACHES: [u32; 6] = [2, 4, 8, 16, 32, 64];
/// Changes of E that a pair may make at most, in the order in which that is tried.
const DELTAS: [i32; 5] = [-4, -2, 0, 2, 4];
/// Pairs that lower E are looked for only this near: that is not what a conversion is for.
const NEAR: u32 = 12;
/// Paths of one element that are tried in a round, and in the last ones.
const TRIES: usize = 6;
const LAST_TRIES: usize = 40;

/// What a conversion did.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Conversion {
    /// The operations, in order.
    pub ops: Vec<Op>,
    /// Large elements that were divided.
    pub divided: usize,
    /// Pairs that met.
    pub pairs: usize,
    /// The change of E.
    pub delta: i64,
    /// Irregular elements of the kind that are left.
    pub left: Vec<Vertex>,
    /// Why some must be left.
    pub obstructions: Vec<Obstruction>,
}

/// Moves vertices after a change to where they look well, and says how well they do: from 0 on it
/// is well enough. It gets the mesh and the vertices that were changed, and must not change the
/// connectivity.
pub type Settle<'a> = dyn FnMut(&mut QuadMesh, &[Vertex]) -> f64 + 'a;

/// Converts all irregular elements of `kind` that parity allows.
///
/// What does not look well to `settle` is undone and done otherwise, as long as there is another
/// way. Boundaries, features and held vertices stay. Undone by [`QuadMesh::undo_to`] like any
/// edit. If cancelled, what is converted so far stays.
pub fn convert(
    mesh: &mut QuadMesh,
    kind: Kind,
    settle: &mut Settle,
    watch: &dyn Watch,
) -> Conversion {
    let before = mesh.total_irregularity() as i64;
    let mut ops = Vec::new();
    divide_large(mesh, kind, &mut ops, settle);
    let divided = ops.len();
    let obstructions = if kind == Kind::Faces { obstructions(mesh) } else { Vec::new() };
    let total = kind.irregular(mesh).count();
    let mut pairs = 0;
    for limits in rounds() {
        let seeds: Vec<Vertex> = kind.irregular(mesh).collect();
        for seed in seeds {
            let waits = mesh.is_alive(seed) && mesh.valence(seed) != 4;
            if waits && !watch.cancelled() {
                let made = pair_up(mesh, (seed, kind), limits, settle);
                pairs += usize::from(made.is_some());
                ops.extend(made.into_iter().flatten());
                watch.progress(Phase::Edit, 2 * pairs, total, None);
            }
        }
    }
    let delta = mesh.total_irregularity() as i64 - before;
    let left = kind.irregular(mesh).collect();
    Conversion { ops, divided, pairs, delta, left, obstructions }
}

/// Makes `seed` and another element regular; the operations, if a way was found that looks well,
/// or, in the last rounds, the one that looks best.
fn pair_up(
    mesh: &mut QuadMesh,
    (seed, kind): (Vertex, Kind),
    limits: Limits,
    settle: &mut Settle,
) -> Option<Vec<Op>> {
    let mut search = Search::new(mesh, seed, kind, limits)?;
    let mut best: Option<(f64, Vec<Op>)> = None;
    let tries = if limits.most == i32::MAX { LAST_TRIES } else { TRIES };
    let mark = mesh.mark();
    for _ in 0..tries {
        let Some(path) = search.next(mesh) else { break };
        let looks = run(mesh, &path, settle);
        if looks.is_some_and(|looks| looks >= 0.0) {
            return Some(path);
        }
        mesh.undo_to(mark);
        best = match looks {
            Some(looks) if best.as_ref().is_none_or(|b| looks > b.0) => Some((looks, path)),
            _ => best,
        };
    }
    let (_, path) = best.filter(|_| limits.most == i32::MAX)?;
    run(mesh, &path, settle).map(|_| path)
}

/// Makes a change, whole or not at all; how well it looks.
fn run(mesh: &mut QuadMesh, path: &[Op], settle: &mut Settle) -> Option<f64> {
    let mark = mesh.mark();
    if path.iter().try_for_each(|op| op.run(mesh).map(drop)).is_err() {
        mesh.undo_to(mark);
        return None;
    }
    Some(settle(mesh, &mesh.touched_since(mark)))
}

/// What is tried, one round after the other; in the last ones anything goes.
fn rounds() -> impl Iterator<Item = Limits> {
    let all = DELTAS.into_iter().flat_map(|most| REACHES.map(|reach| Limits { reach, most }));
    let near = all.filter(|limits| limits.most >= 0 || limits.reach <= NEAR);
    near.chain([256, 4096].map(|reach| Limits { reach, most: i32::MAX }))
}

/// Cuts regular elements off those of valence six and more, where that raises E least.
fn divide_large(mesh: &mut QuadMesh, kind: Kind, ops: &mut Vec<Op>, settle: &mut Settle) {
    let large: Vec<Vertex> = kind.irregular(mesh).filter(|&v| mesh.valence(v) >= 6).collect();
    for v in large {
        while mesh.valence(v) >= 6 {
            let best =
                cuts(mesh, v).filter_map(|op| Some((op.check(mesh).ok()?.delta(), op))).min();
            let Some((_, op)) = best else { break };
            if run(mesh, &[op], settle).is_none() {
                break;
            }
            ops.push(op);
        }
    }
}

/// The splits of `v` by which a regular element comes off.
fn cuts(mesh: &QuadMesh, v: Vertex) -> impl Iterator<Item = Op> + '_ {
    mesh.outgoing(v).map(|first| {
        let last = mesh.ccw(mesh.ccw(mesh.ccw(first)));
        Op::Split(Split { first, last })
    })
}
