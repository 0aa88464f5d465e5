//! The propositions of Peng & Wonka 2013, each under its own name.

mod common;

use std::collections::HashMap;

use common::lifted::{
    Block, Dice, Invariants, code_from, disk, fingerprint, lifted, mess_up, samples,
};
use quadmend::mesh::{NONE, PolyMesh, Topology, shapes};
use quadmend::moves::cancel::{self, Outcome, Remainder};
use quadmend::moves::pair::{self, Direction};
use quadmend::moves::path::Offset;
use quadmend::moves::t_junction::{self, Direction as Way};
use quadmend::moves::{Element, Kind, MoveRefusal, Route, merge};
use quadmend::ops::{Collapse, Flip, Op, Split, Turn};
use quadmend::sqrtcc::{QuadMesh, Vertex, lower};

/// The irregular elements inside.
fn elements(q: &QuadMesh) -> Vec<Element> {
    Element::all(q).collect()
}

/// The two irregular elements inside, that with an edge too few first.
fn two(q: &QuadMesh) -> [Vertex; 2] {
    let mut pair: [Element; 2] = elements(q).try_into().expect("two elements");
    pair.sort_by_key(|e| -e.kind.index());
    pair.map(|e| e.at)
}

fn separation(q: &QuadMesh, pair: [Vertex; 2]) -> Offset {
    pair::separation(q, pair, Route::Found).expect("a path")
}

fn shifted(q: &mut QuadMesh, pair: [Vertex; 2], direction: Direction, steps: u32) -> [Vertex; 2] {
    let between = separation(q, pair);
    let moved = pair::shift(q, pair, direction, steps, Route::Found);
    moved.unwrap_or_else(|e| panic!("{direction:?}, {steps} steps, {between:?}: {e}")).pair
}

/// The colours that follow from the one of `start`, vertex by vertex; none if they contradict.
fn coloured(q: &QuadMesh, start: Vertex, colour: bool) -> Option<Vec<bool>> {
    let mut colours = vec![None; q.vertex_ids() as usize];
    colours[start as usize] = Some(colour);
    let mut queue = vec![start];
    while let Some(v) = queue.pop() {
        let other = !colours[v as usize]?;
        for w in q.neighbours(v) {
            match colours[w as usize] {
                Some(known) if known != other => return None,
                Some(_) => {}
                None => {
                    colours[w as usize] = Some(other);
                    queue.push(w);
                }
            }
        }
    }
    colours.into_iter().collect()
}

#[test]
fn proposition_3_1_two_colourings_and_a_unique_inverse() {
    for (name, mesh, features) in samples() {
        let q = quadmend::sqrtcc::lift(&mesh, &features).unwrap();
        let labels: Vec<bool> = (0..q.vertex_ids()).map(|v| q.is_face(v)).collect();
        // Connected, so that one label decides all: there are two colourings, of which one is the
        // mesh and the other its dual.
        let same = coloured(&q, 0, labels[0]).expect(name);
        let other = coloured(&q, 0, !labels[0]).expect(name);
        assert_eq!(same, labels, "{name}");
        assert!(same.iter().zip(&other).all(|(a, b)| a != b), "{name}");
        let back = lower(&q, mesh.group_names()).unwrap().mesh;
        assert_eq!(
            (back.points(), back.face_count()),
            (mesh.points(), mesh.face_count()),
            "{name}"
        );
    }
}

/// Edges of Q from `start` to every other vertex.
fn distances(q: &QuadMesh, start: Vertex) -> Vec<u32> {
    let mut far = vec![u32::MAX; q.vertex_ids() as usize];
    far[start as usize] = 0;
    let mut queue = std::collections::VecDeque::from([start]);
    while let Some(v) = queue.pop_front() {
        for w in q.neighbours(v).filter(|&w| !q.is_ghost(w)) {
            if far[w as usize] == u32::MAX {
                far[w as usize] = far[v as usize] + 1;
                queue.push_back(w);
            }
        }
    }
    far
}

#[test]
fn proposition_3_2_distance_is_even_exactly_between_elements_of_one_type() {
    for (name, mesh, features) in samples() {
        let mut q = quadmend::sqrtcc::lift(&mesh, &features).unwrap();
        mess_up(&mut q, &mut Dice(7), 60);
        let all: Vec<Vertex> = q.vertices().filter(|&v| q.irregularity(v) > 0).collect();
        assert!(all.len() > 10, "{name}");
        for &a in &all {
            let far = distances(&q, a);
            for &b in &all {
                assert_eq!(
                    far[b as usize].is_multiple_of(2),
                    q.is_face(a) == q.is_face(b),
                    "{name}"
                );
            }
        }
    }
}

/// Σ boundary (1 − e) + Σ interior (4 − n) + Σ faces (4 − d), and 4χ, from the polygons alone.
fn both_sides_of_equation_1(mesh: &PolyMesh) -> (i64, i64) {
    let topology = Topology::new(mesh);
    let boundary = |h: &usize| topology.twin[*h] == NONE;
    let mut faces_at = vec![0_i64; mesh.vertex_count()];
    let mut on_boundary = vec![false; mesh.vertex_count()];
    for (h, &v) in mesh.corners().iter().enumerate() {
        faces_at[v as usize] += 1;
        if boundary(&h) {
            on_boundary[v as usize] = true;
        }
    }
    let index = |v: usize| if on_boundary[v] { 1 - (faces_at[v] - 1) } else { 4 - faces_at[v] };
    let vertices: i64 = (0..mesh.vertex_count()).map(index).sum();
    let faces: i64 = mesh.faces().map(|f| 4 - f.len() as i64).sum();
    let open = (0..mesh.corner_count()).filter(boundary).count();
    let edges = mesh.corner_count().midpoint(open);
    let chi = mesh.vertex_count() as i64 - edges as i64 + mesh.face_count() as i64;
    (vertices + faces, 4 * chi)
}

/// The faces of a grid without those of some of its cells, and without stray vertices.
fn pierced(columns: u32, rows: u32, holes: &[(u32, u32)]) -> PolyMesh {
    let grid = shapes::grid(columns, rows);
    let cells = holes.iter().map(|&(i, j)| (j * columns + i) as usize).collect::<Vec<_>>();
    let kept = (0..grid.face_count()).filter(|f| !cells.contains(f)).map(|f| grid.face(f));
    PolyMesh::new(grid.points().to_vec(), kept).unwrap()
}

#[test]
fn equation_1_gauss_bonnet_with_chords_and_several_loops() {
    let meshes = [
        ("chords only", shapes::grid(9, 1)),
        ("a single face", shapes::grid(1, 1)),
        ("one hole", pierced(7, 6, &[(3, 3)])),
        ("holes with chords between them", pierced(9, 5, &[(1, 2), (3, 2), (5, 2), (7, 2)])),
        ("a torus", shapes::torus(8, 6)),
        ("a sphere", shapes::sphere(4)),
    ];
    for (name, mesh) in meshes {
        let (sum, expected) = both_sides_of_equation_1(&mesh);
        assert_eq!(sum, expected, "{name}");
        let mut q = lifted(&mesh);
        if mesh.face_count() > 20 {
            mess_up(&mut q, &mut Dice(3), 40);
        }
        let edited = lower(&q, mesh.group_names()).unwrap().mesh;
        assert_eq!(both_sides_of_equation_1(&edited), (expected, expected), "{name}");
    }
}

/// All operations on the mesh as it is, legal or not.
fn all_operations(q: &QuadMesh) -> Vec<Op> {
    let mut ops = Vec::new();
    for edge in (0..4 * q.quad_ids()).filter(|&h| q.is_quad_alive(h / 4)) {
        ops.push(Op::Collapse(Collapse { edge }));
        ops.extend([Turn::Ccw, Turn::Cw].map(|turn| Op::Flip(Flip { edge, turn })));
        let mut last = q.ccw(q.ccw(edge));
        for _ in 0..q.valence(q.origin(edge)).saturating_sub(3) {
            ops.push(Op::Split(Split { first: edge, last }));
            last = q.ccw(last);
        }
    }
    ops
}

/// Walks through every state within so many operations of the start in which E is small enough
/// to come back, and calls `seen` in each one whose rim is as it was.
struct Exhaustion<'a> {
    rim: u32,
    at_rim: Vec<(Vertex, u32)>,
    visited: HashMap<u64, u32>,
    seen: &'a mut dyn FnMut(&QuadMesh, u64),
}

impl Exhaustion<'_> {
    fn explore(&mut self, q: &mut QuadMesh, left: u32) {
        let code = code_from(q, self.rim);
        let best = self.visited.entry(code).or_insert(0);
        if *best > left {
            return;
        }
        *best = left + 1;
        if self.at_rim.iter().all(|&(v, n)| q.valence(v) == n) {
            (self.seen)(q, code);
        }
        if left == 0 {
            return;
        }
        for op in all_operations(q) {
            let mark = q.mark();
            if op.run(q).is_ok() {
                self.explore(q, left - 1);
            }
            q.undo_to(mark);
        }
    }
}

fn every_state_near(
    q: &mut QuadMesh,
    rim: u32,
    depth: u32,
    seen: &mut dyn FnMut(&QuadMesh, u64),
) -> usize {
    let at_rim = q.vertices().filter(|&v| q.is_held(v)).map(|v| (v, q.valence(v))).collect();
    let mut exhaustion = Exhaustion { rim, at_rim, visited: HashMap::new(), seen };
    exhaustion.explore(q, depth);
    exhaustion.visited.len()
}

/// The interior elements that are not regular, whatever their index.
fn irregular_inside(q: &QuadMesh) -> usize {
    q.vertices().filter(|&v| !q.is_held(v) && q.valence(v) != 4).count()
}

#[test]
fn proposition_3_3_no_element_is_made_removed_moved_or_converted_alone() {
    // Four corners: regular. Three: one f3 or v3. Five: one f5 or v5.
    let cases: [(&[u32], u32); 8] = [
        (&[2, 2, 2, 2], 4),
        (&[3, 2, 3, 2], 3),
        (&[1, 1, 1], 2),
        (&[2, 2, 2], 6),
        (&[3, 2, 2], 5),
        (&[1, 1, 1, 1, 1], 6),
        (&[2, 2, 2, 2, 3], 3),
        (&[2, 2, 2, 2, 2], 4),
    ];
    for (sides, depth) in cases {
        let (mut q, rim) = disk(sides).unwrap_or_else(|| panic!("{sides:?}"));
        let (start, count) = (code_from(&q, rim), irregular_inside(&q));
        assert_eq!(count, usize::from(sides.len() != 4), "{sides:?}");
        let mut alone = 0;
        let states = every_state_near(&mut q, rim, depth, &mut |q, code| {
            let now = irregular_inside(q);
            if now <= 1 {
                alone += 1;
                assert_eq!(now, count, "{sides:?}: an element was made or removed alone");
                assert_eq!(code, start, "{sides:?}: an element was moved or converted alone");
            }
        });
        assert!(alone >= 1 && states >= 1, "{sides:?}");
    }
}

#[test]
fn proposition_3_4_opposite_indices_translate_together() {
    for sides in [[14, 15, 15, 14], [14, 14, 17, 15], [16, 17, 13, 17], [14, 18, 17, 14]] {
        let Some((mut q, rim)) = disk(&sides) else { panic!("{sides:?}") };
        let (start, before) = (code_from(&q, rim), Invariants::of(&q));
        let (pair, total) = (two(&q), q.total_irregularity());
        let between = separation(&q, pair);
        for direction in Direction::OPPOSITE {
            for steps in 1..=3 {
                let mark = q.mark();
                let print = fingerprint(&q);
                let moved = shifted(&mut q, pair, direction, steps);
                assert_eq!(Invariants::of(&q), before);
                assert_eq!(q.total_irregularity(), total, "{direction:?}");
                for (old, new) in pair.into_iter().zip(moved) {
                    let odd = steps % 2 == 1;
                    assert_eq!(q.is_face(old) != q.is_face(new), odd, "{direction:?} {steps}");
                }
                let after = separation(&q, moved);
                assert_eq!(after.canonical(), between.canonical(), "{direction:?} {steps}");
                assert_ne!(code_from(&q, rim), start);
                shifted(&mut q, moved, direction.inverse(), steps);
                assert_eq!(code_from(&q, rim), start, "{direction:?} {steps}");
                q.undo_to(mark);
                assert!(fingerprint(&q) == print, "undo is exact");
            }
        }
    }
}

/// How the separation of two elements of equal index changes: by the diagonal of the quadrant in
/// which it lies, turned.
fn change(separation: Offset, direction: Direction) -> Offset {
    let first = |q: &i32| {
        let Offset { x, y } = separation.turned(-q);
        x > 0 && y >= 0
    };
    let quadrant = (0..4).find(first).expect("two different places");
    let turn = match direction {
        Direction::Apart => 0,
        Direction::RotateLeft => 1,
        Direction::Closer => 2,
        _ => 3,
    };
    Offset { x: 1, y: 1 }.turned(quadrant + turn)
}

#[test]
fn proposition_3_4_equal_indices_change_their_separation() {
    for sides in [
        &[16_u32, 18][..],
        &[20, 20],
        &[9, 9, 9, 9, 9, 9],
        &[8, 9, 10, 8, 9, 10],
        &[8, 12, 8, 8, 12, 8],
    ] {
        let Some((mut q, rim)) = disk(sides) else { panic!("{sides:?}") };
        let (start, before) = (code_from(&q, rim), Invariants::of(&q));
        let (pair, total) = (two(&q), q.total_irregularity());
        let between = separation(&q, pair);
        for direction in Direction::EQUAL {
            let mark = q.mark();
            let moved = shifted(&mut q, pair, direction, 1);
            assert_eq!(Invariants::of(&q), before);
            assert_eq!(q.total_irregularity(), total, "{direction:?}");
            let after = separation(&q, moved);
            let expected = between + change(between, direction);
            assert_eq!(after.canonical(), expected.canonical(), "{direction:?} from {between:?}");
            shifted(&mut q, moved, direction.inverse(), 1);
            assert_eq!(code_from(&q, rim), start, "{direction:?}");
            q.undo_to(mark);
        }
    }
}

#[test]
fn proposition_3_5_only_the_same_type_and_index_merge() {
    let mut merged = 0;
    for sides in [
        [8_u32, 9, 10, 8, 9, 10],
        [9; 6],
        [7, 9, 8, 10, 8, 8],
        [8, 9, 8, 9, 9, 8],
        [6, 9, 7, 9, 9, 7],
    ] {
        let Some((mut q, rim)) = disk(&sides) else { continue };
        let (start, pair, total) = (code_from(&q, rim), two(&q), q.total_irregularity());
        let kinds = pair.map(|v| Element::at(&q, v).unwrap().kind);
        let before = fingerprint(&q);
        let mark = q.mark();
        let done = merge::merge(&mut q, pair, Route::Found);
        if kinds[0] != kinds[1] {
            assert_eq!(done, Err(MoveRefusal::DifferentTypes(kinds[0], kinds[1])));
            assert!(fingerprint(&q) == before, "a refusal leaves no traces");
            continue;
        }
        let done = done.unwrap_or_else(|e| panic!("{sides:?}: {e}"));
        merged += 1;
        assert_eq!(q.valence(done.element), 6);
        assert_eq!((q.total_irregularity(), irregular_inside(&q)), (total, 1), "{sides:?}");
        q.check().unwrap();
        let (halves, _) = merge::split_element(&mut q, done.element, None).unwrap();
        assert_eq!(q.total_irregularity(), total);
        let again = merge::merge(&mut q, halves, Route::Found).unwrap();
        assert_eq!(q.valence(again.element), 6);
        q.undo_to(mark);
        assert_eq!(code_from(&q, rim), start);
        assert!(fingerprint(&q) == before, "undo is exact");
    }
    assert!(merged >= 2, "{merged}");
    let (mut q, _) = disk(&[16, 18]).unwrap();
    let pair = two(&q);
    let refused = merge::merge(&mut q, pair, Route::Found);
    assert!(matches!(refused, Err(MoveRefusal::TooFewEdges(_))), "{refused:?}");
    let (mut q, _) = disk(&[14, 14, 17, 15]).unwrap();
    let pair = two(&q);
    let refused = merge::merge(&mut q, pair, Route::Found);
    assert!(matches!(refused, Err(MoveRefusal::OppositeIndices(..))), "{refused:?}");
}

#[test]
fn proposition_3_6_t_junctions_move_by_whole_edges_in_four_directions() {
    let (width, height, column, row) = (9, 8, 4, 4);
    // Up eats the stem: the T-junction hangs one row higher; left is one column less.
    for (way, steps, (column_after, row_after)) in [
        (Way::Up, 1, (column, row + 1)),
        (Way::Up, 3, (column, row + 3)),
        (Way::Down, 2, (column, row - 2)),
        (Way::Left, 1, (column - 1, row)),
        (Way::Right, 3, (column + 3, row)),
    ] {
        let block = Block::with_t_junction(width, height, column, row);
        let (mut q, rim) = block.lifted();
        let start = code_from(&q, rim);
        let at = t_junction::at(&q, block.hanging[0]).unwrap();
        let before = fingerprint(&q);
        let mark = q.mark();
        let moved = t_junction::shift(&mut q, at, way, steps).unwrap();
        q.check().unwrap();
        assert_eq!(elements(&q).len(), 2, "{way:?}");
        let (expected, its_rim) =
            Block::with_t_junction(width, height, column_after, row_after).lifted();
        assert_eq!(code_from(&q, rim), code_from(&expected, its_rim), "{way:?} {steps}");
        t_junction::shift(&mut q, moved.dipole, way.inverse(), steps).unwrap();
        assert_eq!(code_from(&q, rim), start, "{way:?} {steps}");
        q.undo_to(mark);
        assert!(fingerprint(&q) == before, "undo is exact");
    }
}

#[test]
fn proposition_3_7_predicts_what_is_left_of_two_t_junctions() {
    let mut dice = Dice(37);
    let mut seen = HashMap::new();
    let mut rectangles = 0;
    for case in 0..1600_u32 {
        // The side that is glued is as long in both blocks: height, or width for turned ones.
        let turns = [dice.below(4), dice.below(4)];
        let common = 7 + dice.below(4);
        let [one, other] = turns.map(|turn| {
            let free = 7 + dice.below(4);
            // What the sides right and left of the block are before it is turned.
            let (width, height) = if turn % 2 == 0 { (free, common) } else { (common, free) };
            (turn, width, height, dice.below(8), dice.below(8))
        });
        let build = |(turn, width, height, a, b): (u32, u32, u32, u32, u32), glued: usize| {
            let make = |width| {
                Block::with_t_junction(width, height, 2 + a % (width - 4), 3 + b % (height - 5))
                    .turned(turn as usize)
            };
            let block = make(width);
            // Where the longer side is the one to be glued, one column less.
            if block.lengths()[glued] > common as usize { make(width - 1) } else { block }
        };
        let block = build(one, 1).beside(&build(other, 3));
        let [bottom, right, top, left] = block.lengths();
        let rectangle = bottom == top && right == left;
        let (mut q, _) = block.lifted();
        let pair = [0, 1].map(|i| t_junction::at(&q, block.hanging[i]).unwrap());
        let wanted = [Remainder::Any, Remainder::Vertices, Remainder::Faces][case as usize % 3];
        let before = fingerprint(&q);
        let predicted = cancel::predict(&q, pair, Route::Found);
        let predicted = predicted.unwrap_or_else(|e| panic!("{case} {block:?}: {e}"));
        assert!(fingerprint(&q) == before, "a prediction touches nothing");
        assert_eq!(predicted == Outcome::Complete, rectangle, "{turns:?} {:?}", block.lengths());
        rectangles += usize::from(rectangle);
        let mark = q.mark();
        let made = cancel::quadruple(&mut q, pair, wanted, Route::Found);
        *seen.entry(((turns[1] + 4 - turns[0]) % 4, predicted)).or_insert(0) += 1;
        let made = made.unwrap_or_else(|e| panic!("{case} {turns:?} {wanted:?}: {e}"));
        q.check().unwrap();
        assert_eq!(made.outcome, predicted);
        match made.left {
            None => assert_eq!(irregular_inside(&q), 0),
            Some([three, five]) => {
                assert_eq!(irregular_inside(&q), 2);
                let kinds = [three, five].map(|v| Element::at(&q, v).unwrap().kind);
                let expected = [[Kind::V3, Kind::V5], [Kind::F3, Kind::F5]];
                match wanted {
                    Remainder::Any => assert!(expected.contains(&kinds), "{kinds:?}"),
                    Remainder::Vertices => assert_eq!(kinds, expected[0]),
                    Remainder::Faces => assert_eq!(kinds, expected[1]),
                }
                let apart = separation(&q, [three, five]);
                let promised = cancel::separation_left(predicted);
                assert_eq!(apart.canonical(), promised.canonical());
            }
        }
        q.undo_to(mark);
        assert!(fingerprint(&q) == before, "undo is exact");
    }
    // Figure 6: half a turn is complete; both quarters, and none, leave a pair.
    let orientations = [
        (0, Outcome::Straight),
        (1, Outcome::Diagonal),
        (2, Outcome::Complete),
        (3, Outcome::Diagonal),
    ];
    assert_eq!(seen.len(), 4, "{seen:?}");
    assert!(orientations.iter().all(|key| seen[key] > 200), "{seen:?}");
    assert!(rectangles > 200, "{rectangles}");
}
