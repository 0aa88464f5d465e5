//! Local reductions: single operations, and pairs of them, after which E is smaller.

use crate::ops::{Collapse, Flip, MIN_VALENCE, Op, Split, Turn};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};

/// The sequences of one operation near `seed` that lower E, or else of two; best first.
/// `mesh` is as before afterwards. O(valence²) probes for one operation, squared for two.
pub fn reductions(mesh: &mut QuadMesh, seed: Vertex, depth: u32) -> Vec<(i32, Vec<Op>)> {
    let found = sequences(mesh, seed, 1, -1);
    if found.is_empty() && depth >= 2 { sequences(mesh, seed, 2, -1) } else { found }
}

/// The sequences of `depth` operations (one or two) near `seed` that change E by at most `most`;
/// best first. `mesh` is as before afterwards.
pub fn sequences(mesh: &mut QuadMesh, seed: Vertex, depth: u32, most: i32) -> Vec<(i32, Vec<Op>)> {
    let mut found = Vec::new();
    for op in operations(mesh, seed) {
        if depth >= 2 {
            pairs(mesh, op, most, &mut found);
        } else if let Some(delta) = op.check(mesh).ok().map(|l| l.delta()).filter(|&d| d <= most) {
            found.push((delta, vec![op]));
        }
    }
    found.sort();
    found.dedup();
    found
}

/// Extends `first` by every second operation around what it touched.
fn pairs(mesh: &mut QuadMesh, first: Op, most: i32, found: &mut Vec<(i32, Vec<Op>)>) {
    let mark = mesh.mark();
    // A first operation that costs four cannot be made good by one more.
    let Some(legal) = first.check(mesh).ok().filter(|l| l.delta() <= 2) else { return };
    let cost = legal.delta();
    Op::apply(mesh, legal);
    for v in mesh.touched_since(mark) {
        if !mesh.is_alive(v) || mesh.irregularity(v) == 0 {
            continue;
        }
        for second in operations(mesh, v) {
            let delta = second.check(mesh).ok().map(|legal| cost + legal.delta());
            if let Some(delta) = delta.filter(|&d| d <= most) {
                found.push((delta, vec![first, second]));
            }
        }
    }
    mesh.undo_to(mark);
}

/// Every operation that can change the valence of `v`; not yet checked.
fn operations(mesh: &QuadMesh, v: Vertex) -> Vec<Op> {
    let mut ops = Vec::with_capacity(64);
    if mesh.is_ghost(v) || mesh.valence(v) > 16 {
        return ops;
    }
    for h in mesh.outgoing(v) {
        ops.push(Op::Collapse(Collapse { edge: h }));
        ops.push(Op::Collapse(Collapse { edge: QuadMesh::next(h) }));
        for edge in [h, QuadMesh::next(h), QuadMesh::opposite(h)] {
            for turn in [Turn::Ccw, Turn::Cw] {
                ops.push(Op::Flip(Flip { edge, turn }));
            }
        }
        splits_beside(mesh, h, &mut ops);
    }
    splits_of(mesh, v, &mut ops);
    ops
}

/// Splits of `v` itself into two of at least three edges each.
fn splits_of(mesh: &QuadMesh, v: Vertex, ops: &mut Vec<Op>) {
    let half = mesh.valence(v) / 2;
    for first in mesh.outgoing(v) {
        let mut last = mesh.ccw(first);
        for _ in MIN_VALENCE - 1..=half {
            last = mesh.ccw(last);
            ops.push(Op::Split(Split { first, last }));
        }
    }
}

/// Splits of the neighbour at the end of `h` by which `v` gains an edge.
fn splits_beside(mesh: &QuadMesh, h: HalfEdge, ops: &mut Vec<Op>) {
    let t = mesh.twin(h);
    let n = mesh.valence(mesh.origin(t));
    if !(4..=16).contains(&n) {
        return;
    }
    let mut other = mesh.ccw(t);
    for _ in 0..n - 3 {
        other = mesh.ccw(other);
        ops.push(Op::Split(Split { first: t, last: other }));
        ops.push(Op::Split(Split { first: other, last: t }));
    }
}
