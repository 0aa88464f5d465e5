//! Local reductions: single operations, and pairs of them, after which E is smaller.

use crate::ops::{Op, around};
use crate::sqrtcc::{QuadMesh, Vertex};

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
    for op in around(mesh, seed) {
        if depth >= 2 {
            pairs(mesh, op, most, &mut found);
        } else if let Ok(legal) = op.check_up_to(most, mesh) {
            found.push((legal.delta(), vec![op]));
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
    let Ok(legal) = first.check_up_to(2, mesh) else { return };
    let cost = legal.delta();
    Op::apply(mesh, legal);
    for v in mesh.touched_since(mark) {
        if !mesh.is_alive(v) || mesh.irregularity(v) == 0 {
            continue;
        }
        for second in around(mesh, v) {
            if let Ok(legal) = second.check_up_to(most - cost, mesh) {
                found.push((cost + legal.delta(), vec![first, second]));
            }
        }
    }
    mesh.undo_to(mark);
}
