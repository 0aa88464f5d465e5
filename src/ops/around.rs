//! The operations around one element, for whoever searches among them.

use super::{Collapse, Flip, MIN_VALENCE, Op, Split, Turn};
use crate::sqrtcc::{HalfEdge, QuadMesh, Vertex};

/// Every operation that can change the valence of `v`; not yet checked.
#[must_use]
pub fn around(mesh: &QuadMesh, v: Vertex) -> Vec<Op> {
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
