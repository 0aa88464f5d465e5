//! Features that are resampled: the operations and their inverses, and what meets across a line.

mod common;

use common::lifted::{code_from, cube_edges, fingerprint};
use quadmend::mesh::shapes;
use quadmend::ops::{Refusal, Resample, within_line};
use quadmend::patch::{Refill, fillings};
use quadmend::planner::clusters::{Clusters, Limits};
use quadmend::planner::crossings::{Bounds, Crossings};
use quadmend::sqrtcc::{HalfEdge, QuadKind, QuadMesh, Vertex, lift};
use quadmend::surface::{FeatureOptions, Reference, SharpLines};

/// A cube of 8 by 8 quads a side, its edges features.
fn cube() -> (QuadMesh, SharpLines) {
    let mesh = shapes::cube(8);
    let q = lift(&mesh, &cube_edges(&mesh)).expect("a cube");
    let lines = SharpLines::new(&Reference::new(&mesh).unwrap(), &FeatureOptions::default(), 0.25);
    (q, lines)
}

/// A half-edge of each feature edge, out of one of its ends.
fn feature_edges(q: &QuadMesh) -> Vec<HalfEdge> {
    q.quads().filter(|&e| q.kind(e) == QuadKind::Feature).map(|e| 4 * e).collect()
}

/// Resamples; the change of E is the one that was predicted.
fn resample(q: &mut QuadMesh, what: Resample) -> Vertex {
    let before = q.total_irregularity() as i64;
    let delta = what.check(q).expect("a legal one").delta();
    let vertex = what.run(q).expect("it was legal");
    assert_eq!(q.total_irregularity() as i64 - before, i64::from(delta), "{what:?}");
    q.check().expect("a sound mesh");
    assert_eq!(q.index_sum(), 4 * q.euler_characteristic(), "equation 1");
    vertex
}

#[test]
fn cut_and_join_are_inverse_on_every_feature_edge() {
    let (mut q, _) = cube();
    let start = q.quads().map(|e| 4 * e).find(|&h| !q.is_frozen(h >> 2)).unwrap();
    let (code, state) = (code_from(&q, start), fingerprint(&q));
    let edges = feature_edges(&q);
    assert_eq!(edges.len(), 12 * 8);
    for edge in edges {
        let mark = q.mark();
        let (u, w) = (q.origin(edge), q.origin(QuadMesh::opposite(edge)));
        let x = resample(&mut q, Resample::Cut { edge });
        assert_eq!((q.valence(x), q.total_irregularity()), (2, 4));
        let back = q.outgoing(u).find(|&h| q.origin(QuadMesh::opposite(h)) == x).unwrap();
        assert_eq!(resample(&mut q, Resample::Join { edge: back }), u);
        assert_eq!(code_from(&q, start), code, "u–w is one edge again");
        assert_eq!(q.total_irregularity(), 0);
        assert!(q.diagonals(u).any(|v| v == w));
        q.undo_to(mark);
        assert_eq!(fingerprint(&q), state, "undone to the bit");
    }
}

#[test]
fn corners_of_lines_and_edges_beside_them_stay() {
    let (mut q, _) = cube();
    let (mut corners, mut joined) = (0, 0);
    for edge in feature_edges(&q).into_iter().flat_map(|h| [h, QuadMesh::opposite(h)]) {
        let gone = q.origin(QuadMesh::opposite(edge));
        let mark = q.mark();
        if within_line(&q, gone) {
            let kept = resample(&mut q, Resample::Join { edge });
            assert!(within_line(&q, kept) || q.sectors(kept).count() == 3);
            joined += 1;
        } else {
            assert_eq!(Resample::Join { edge }.run(&mut q), Err(Refusal::Held));
            corners += 1;
        }
        q.undo_to(mark);
    }
    assert_eq!((corners, joined), (3 * 8, 12 * 16 - 3 * 8));
    let free = q.quads().find(|&e| q.kind(e) == QuadKind::Free).unwrap();
    assert_eq!(Resample::Cut { edge: 4 * free }.run(&mut q), Err(Refusal::Frozen));
}

/// The crossing that is found from `seed` leaves no irregular element, as far as there were any,
/// and keeps the cube a cube; how many lines it crosses.
fn is_mended_from(q: &mut QuadMesh, lines: &SharpLines, seed: Vertex) -> usize {
    let before = q.total_irregularity();
    let state = fingerprint(q);
    let bounds = Bounds { edges: 8, faces: 400, partners: 12, tries: 3 };
    let found = Crossings::default().around(q, seed, lines, bounds);
    assert_eq!(fingerprint(q), state, "searching changes nothing");
    let (gain, crossing) = found.into_iter().next().expect("a crossing");
    crossing.run(q).expect("it was found on this mesh");
    q.check().expect("a sound mesh");
    assert_eq!(before - q.total_irregularity(), u64::from(gain));
    assert_eq!(q.total_irregularity(), 0);
    assert_eq!(q.vertices().filter(|&v| q.valence(v) != 4).count(), 8, "the corners");
    for v in q.vertices().filter(|&v| !q.is_face(v) && q.is_held(v)) {
        let at = q.position(v);
        let off = at.iter().filter(|x| (x.abs() - 1.0).abs() > 1e-12).count();
        assert!(off <= 1, "{at} is not on an edge of the cube");
    }
    crossing.shifts.len()
}

/// A half-edge of a feature edge in the middle of an edge of the cube.
fn middle_edge(q: &QuadMesh) -> HalfEdge {
    let is_middle = |&h: &HalfEdge| {
        let ends = [h, QuadMesh::opposite(h)].map(|h| q.position(q.origin(h)));
        let middle = nalgebra::center(&ends[0], &ends[1]);
        middle.iter().filter(|x| x.abs() < 0.3).count() == 1
    };
    feature_edges(q).into_iter().find(is_middle).unwrap()
}

#[test]
fn elements_on_both_sides_of_a_line_cancel() {
    let (mut q, lines) = cube();
    let edge = middle_edge(&q);
    let face = q.target(edge);
    resample(&mut q, Resample::Cut { edge });
    assert_eq!(is_mended_from(&mut q, &lines, face), 1);
}

#[test]
fn elements_cancel_through_a_wall_between_two_lines() {
    let (mut q, lines) = cube();
    let first = middle_edge(&q);
    // Straight through the side of the cube to the line at its other end.
    let (mut out, mut wall) = (QuadMesh::prev(first), Vec::new());
    loop {
        wall.push(q.origin(out));
        out = q.ccw(q.ccw(out));
        if q.is_frozen(out >> 2) {
            break;
        }
        out = QuadMesh::opposite(out);
    }
    assert_eq!(wall.len(), 8);
    let (near, second) = (q.target(first), QuadMesh::prev(out));
    let ends = [first, second].map(|edge| resample(&mut q, Resample::Cut { edge }));
    let at = [q.find(ends[0], wall[0]).unwrap(), q.find(ends[1], wall[7]).unwrap()];
    let region = Clusters::default().spanning(&q, &at, &wall, 100).unwrap();
    let filling = fillings(region.rim.len(), &region.corners, 1).remove(0);
    Refill::new(&q, &region, filling).unwrap().run(&mut q).unwrap();
    assert_eq!(q.total_irregularity(), 4, "one pair beyond each line, none between");
    assert_eq!(is_mended_from(&mut q, &lines, near), 2);
}

#[test]
fn nothing_is_looked_for_where_nothing_is_irregular() {
    let (mut q, lines) = cube();
    let limits = Limits { faces: 100, partners: 4, least_gain: 1 };
    let face = q.target(middle_edge(&q));
    assert!(Clusters::default().around(&q, face, limits).is_empty());
    let bounds = Bounds { edges: 8, faces: 400, partners: 4, tries: 3 };
    assert!(Crossings::default().around(&mut q, face, &lines, bounds).is_empty());
}
