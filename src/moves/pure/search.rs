//! The cheapest sequence of operations by which one irregular element meets another of its kind.
//!
//! One element is the *carrier*: each operation hands its oddness on to another element near it
//! (a step of a dislocation, or its emission), until an operation makes two regular at once (the
//! absorption). States are explored by execution through the journal and undone; two states are
//! the same if the carrier is the same element with the same valence. The search is led by the
//! number of elements between the carrier and the nearest other irregular one (A*; Hart, Nilsson,
//! Raphael 1968).

use super::effect::{Effect, Kind};
use crate::mesh::NONE;
use crate::ops::{Op, around};
use crate::sqrtcc::{QuadMesh, Vertex};
use rustc_hash::FxHashSet;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Steps that one irregular element more or less is worth.
const WEIGHT: i32 = 8;
/// What absorbing a dislocation is hoped to gain.
const HOPE: i32 = 2;
/// The costliest operation that is tried: the emission of a dislocation next to an irregular
/// element.
const MOST_DELTA: i32 = 4;

/// A state that was reached.
#[derive(Debug, Clone, Copy, Default)]
struct Node {
    parent: u32,
    op: Option<Op>,
    steps: u32,
    delta: i32,
    /// The irregular element that is left, `None` if none is.
    carrier: Option<Vertex>,
    /// The element of the unedited mesh that the carrier is, or descends from, and its valence.
    place: (Vertex, u32),
}

/// How far a search goes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Limits {
    /// Most operations of a path.
    pub(super) reach: u32,
    /// Most by which E may grow.
    pub(super) most: i32,
}

/// A search for the cheapest paths of one element.
#[derive(Debug, Default)]
pub(super) struct Search {
    /// Vertex ids of the unedited mesh.
    planned: u32,
    kind: Kind,
    limits: Limits,
    /// Elements between each one and the nearest irregular one.
    ahead: Vec<u32>,
    tree: Vec<Node>,
    open: BinaryHeap<Reverse<(i32, u32)>>,
    closed: FxHashSet<(Vertex, u32)>,
}

impl Search {
    /// A search that begins with `start`; `None` if nothing is near enough. O(n).
    pub(super) fn new(mesh: &QuadMesh, start: Vertex, kind: Kind, limits: Limits) -> Option<Self> {
        let ahead = distances(mesh, start, kind, limits.reach)?;
        let planned = mesh.vertex_ids();
        let mut search = Self { planned, kind, limits, ahead, ..Self::default() };
        let place = (start, mesh.valence(start));
        search.push(Node { carrier: Some(start), place, ..Node::default() });
        Some(search)
    }

    /// The next cheapest path. `mesh` has to be as it was when the search began, and is so again
    /// afterwards. O(states · (reach + operations around an element)).
    pub(super) fn next(&mut self, mesh: &mut QuadMesh) -> Option<Vec<Op>> {
        while let Some(Reverse((_, n))) = self.open.pop() {
            let node = self.tree[n as usize];
            if node.carrier.is_none() {
                return Some(self.path(n));
            }
            if self.closed.insert(node.place) {
                self.expand(mesh, n);
            }
        }
        None
    }

    fn push(&mut self, node: Node) {
        let left = if node.carrier.is_some() { self.ahead[node.place.0 as usize] } else { 0 };
        let reachable = left != NONE && node.steps + left / 2 <= self.limits.reach;
        let worth = node.carrier.is_some() || node.delta <= self.limits.most;
        if reachable && worth && !self.closed.contains(&node.place) {
            let hope = if node.carrier.is_some() { HOPE } else { 0 };
            let cost = WEIGHT * (node.delta - hope) + (node.steps + left) as i32;
            self.open.push(Reverse((cost, self.tree.len() as u32)));
            self.tree.push(node);
        }
    }

    /// Walks to a state, notes what every operation there leads to, and undoes it all.
    fn expand(&mut self, mesh: &mut QuadMesh, n: u32) {
        let node = self.tree[n as usize];
        let mark = mesh.mark();
        let there = self.path(n).into_iter().try_for_each(|op| op.run(mesh).map(drop));
        if let (Ok(()), Some(carrier)) = (there, node.carrier) {
            for (op, delta, left) in steps(mesh, carrier, self.kind) {
                let place = match left {
                    Some((v, valence)) if v < self.planned => (v, valence),
                    Some((_, valence)) => (node.place.0, valence),
                    None => (NONE, 0),
                };
                self.push(Node {
                    parent: n,
                    op: Some(op),
                    steps: node.steps + 1,
                    delta: node.delta + delta,
                    carrier: left.map(|(v, _)| v),
                    place,
                });
            }
        }
        mesh.undo_to(mark);
    }

    fn path(&self, mut n: u32) -> Vec<Op> {
        let mut ops = Vec::new();
        while let Node { parent, op: Some(op), .. } = self.tree[n as usize] {
            ops.push(op);
            n = parent;
        }
        ops.reverse();
        ops
    }
}

/// Elements between each one and the nearest irregular one but `start`, without crossing frozen
/// edges; `None` if that is too far from `start`. O(n), nearly all of it for clearing memory.
fn distances(mesh: &QuadMesh, start: Vertex, kind: Kind, reach: u32) -> Option<Vec<u32>> {
    // In a step the carrier can pass an element by.
    let far = 2 * reach;
    let (_, near) = flood(mesh, vec![start], kind, far);
    let targets: Vec<Vertex> =
        near.into_iter().filter(|&v| v != start && mesh.valence(v) != 4).collect();
    (!targets.is_empty()).then(|| flood(mesh, targets, kind, far).0)
}

/// The distance of every element from the nearest of `from`, as far as it is at most `most`, and
/// those elements, the nearest first.
fn flood(mesh: &QuadMesh, from: Vec<Vertex>, kind: Kind, most: u32) -> (Vec<u32>, Vec<Vertex>) {
    let mut distance = vec![NONE; mesh.vertex_ids() as usize];
    for &v in &from {
        distance[v as usize] = 0;
    }
    let mut met = from;
    let mut next = 0;
    while let Some(&v) = met.get(next) {
        next += 1;
        let d = distance[v as usize] + 1;
        if d > most {
            break;
        }
        for h in mesh.outgoing(v).filter(|&h| !mesh.is_frozen(QuadMesh::quad(h))) {
            let w = mesh.origin(QuadMesh::opposite(h));
            if distance[w as usize] == NONE && kind.covers(mesh, w) {
                distance[w as usize] = d;
                met.push(w);
            }
        }
    }
    (distance, met)
}

/// An operation, its change of E, and the irregular element with its valence that is left.
type Step = (Op, i32, Option<(Vertex, u32)>);

/// The operations that hand on the oddness of `carrier` or absorb it.
fn steps(mesh: &QuadMesh, carrier: Vertex, kind: Kind) -> Vec<Step> {
    let mut found = Vec::new();
    for op in around(mesh, carrier) {
        let Ok(legal) = op.check_up_to(MOST_DELTA, mesh) else { continue };
        let Some(effect) = Effect::of(mesh, op, kind) else { continue };
        if !effect.before.contains(&carrier) {
            continue;
        }
        match (effect.before.len(), effect.after.as_slice()) {
            (1, &[left]) => found.push((op, legal.delta(), Some(left))),
            (2, []) => found.push((op, legal.delta(), None)),
            _ => {}
        }
    }
    found
}
