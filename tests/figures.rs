//! Figures 2 to 8 of Peng & Wonka 2013 on small meshes, each under its own name.

mod common;

use common::lifted::{Block, code_from, disk, fingerprint, lifted};
use quadmend::mesh::{PolyMesh, shapes};
use quadmend::moves::basic::{
    edge_collapse, edge_deletion, edge_insertion, edge_shift, vertex_split,
};
use quadmend::moves::cancel::{self, Outcome, Remainder};
use quadmend::moves::conversion::{Generate, convert, generate_pairs};
use quadmend::moves::pair::{self, Direction};
use quadmend::moves::t_junction::{self, Direction as Way};
use quadmend::moves::{Dipole, Element, Kind, MoveRefusal, Route};
use quadmend::ops::Refusal;
use quadmend::sqrtcc::{QuadKind, QuadMesh, Vertex, lower};

/// The kinds of all irregular elements, sorted.
fn kinds(q: &QuadMesh) -> Vec<Kind> {
    let mut kinds: Vec<Kind> = Element::all(q).map(|e| e.kind).collect();
    kinds.sort_unstable();
    kinds
}

fn rim_of(q: &QuadMesh) -> u32 {
    (0..4 * q.quad_ids()).find(|&h| q.kind(h / 4) == QuadKind::Boundary).expect("a boundary")
}

/// The faces of the polygon mesh, as sets of vertices of Q, sorted.
fn faces(q: &QuadMesh) -> Vec<Vec<Vertex>> {
    let mut faces: Vec<Vec<Vertex>> = q
        .vertices()
        .filter(|&f| q.is_face(f))
        .map(|f| {
            let mut corners: Vec<Vertex> = q.neighbours(f).collect();
            corners.sort_unstable();
            corners
        })
        .collect();
    faces.sort();
    faces
}

#[test]
fn figure_2_a_mesh_and_its_sqrt_cc_mesh() {
    // A triangle, a quad and a pentagon around one vertex, with a T-junction.
    let flat = |x: i32, y: i32| quadmend::mesh::Point::new(f64::from(x), f64::from(y), 0.0);
    let points: Vec<_> =
        [(0, 0), (2, 0), (4, 0), (0, 2), (2, 2), (4, 2), (2, 3), (4, 3), (1, 4), (3, 5)]
            .map(|(x, y)| flat(x, y))
            .to_vec();
    let polygons: Vec<Vec<u32>> =
        vec![vec![0, 1, 4, 3], vec![1, 2, 5, 7, 6, 4], vec![3, 4, 6, 8], vec![6, 7, 9]];
    let mesh = PolyMesh::new(points, &polygons).unwrap();
    let q = lifted(&mesh);
    // One vertex of Q for each vertex and face, one quad p, d, p', d' for each edge.
    assert_eq!(q.vertices().count(), 10 + 4);
    let edges = 13;
    assert_eq!(q.quads().count(), edges);
    for quad in q.quads() {
        let corners = [0, 1, 2, 3].map(|i| q.origin(4 * quad + i));
        assert_eq!(corners.map(|v| q.is_face(v)), [false, true, false, true]);
    }
    for f in 0..4 {
        let ring = q.neighbours(q.vertices().find(|&v| q.is_face(v)).unwrap() + f).count();
        assert_eq!(ring, polygons[f as usize].len());
    }
    let back = lower(&q, mesh.group_names()).unwrap().mesh;
    assert_eq!((back.points(), back.face_count()), (mesh.points(), 4));
}

/// A vertex in the middle of a regular disk, the four faces around it and the four vertices
/// across its edges, both counter-clockwise from the right.
fn middle() -> (QuadMesh, Vertex, Vec<Vertex>, Vec<Vertex>) {
    let q = lifted(&shapes::grid(8, 8));
    let v = 4 * 9 + 4;
    let around: Vec<u32> = q.outgoing(v).collect();
    let faces = around.iter().map(|&h| q.target(h)).collect();
    let beyond = around.iter().map(|&h| q.origin(QuadMesh::opposite(h))).collect();
    (q, v, faces, beyond)
}

#[test]
fn figure_3_the_five_basic_operations() {
    let (mut q, v, around, beyond) = middle();
    let (start, rim) = (code_from(&q, rim_of(&q)), rim_of(&q));
    let before = fingerprint(&q);
    let mark = q.mark();

    // Vertex split, and the edge collapse that takes it back.
    let new = vertex_split(&mut q, v, [around[0], around[2]]).unwrap().element;
    assert_eq!([v, new].map(|v| q.valence(v)), [3, 3]);
    assert_eq!([around[0], around[2]].map(|f| q.valence(f)), [5, 5]);
    assert_eq!(kinds(&q), [Kind::V3, Kind::V3, Kind::F5, Kind::F5]);
    edge_collapse(&mut q, [v, new]).unwrap();
    assert_eq!(code_from(&q, rim), start);
    q.undo_to(mark);

    // Edge insertion, and the edge deletion that takes it back.
    let corners: Vec<Vertex> = q.neighbours(around[0]).collect();
    let new = edge_insertion(&mut q, around[0], [corners[0], corners[2]]).unwrap().element;
    assert_eq!([around[0], new].map(|f| q.valence(f)), [3, 3]);
    assert_eq!(kinds(&q), [Kind::V5, Kind::V5, Kind::F3, Kind::F3]);
    edge_deletion(&mut q, [corners[0], corners[2]]).unwrap();
    assert_eq!(code_from(&q, rim), start);
    q.undo_to(mark);

    // Edge shift there and back.
    let (from, fixed) = (v, beyond[0]);
    let to = beyond[1];
    edge_shift(&mut q, fixed, [from, to]).unwrap();
    assert_eq!(kinds(&q), [Kind::V3, Kind::V5, Kind::F3, Kind::F5]);
    assert_eq!([from, to].map(|v| q.valence(v)), [3, 5]);
    assert!(faces(&q).iter().any(|f| f.contains(&fixed) && f.contains(&to)));
    edge_shift(&mut q, fixed, [to, from]).unwrap();
    assert_eq!(code_from(&q, rim), start);
    q.undo_to(mark);

    // An edge collapse and an edge deletion of a regular mesh.
    edge_collapse(&mut q, [v, beyond[0]]).unwrap();
    assert_eq!(kinds(&q), [Kind::F3, Kind::F3], "and a vertex of six edges");
    q.undo_to(mark);
    edge_deletion(&mut q, [v, beyond[0]]).unwrap();
    assert_eq!(kinds(&q), [Kind::V3, Kind::V3], "and a hexagon");
    q.undo_to(mark);
    assert!(fingerprint(&q) == before, "undo is exact");
}

#[test]
fn figure_3_refusals_name_their_reason() {
    let (mut q, v, around, beyond) = middle();
    let before = fingerprint(&q);
    let apart = 2 * 9 + 2;
    assert_eq!(edge_collapse(&mut q, [v, apart]), Err(MoveRefusal::NotJoined(v, apart)));
    assert_eq!(edge_collapse(&mut q, [v, around[0]]), Err(MoveRefusal::NotAVertex(around[0])));
    assert_eq!(edge_insertion(&mut q, v, [beyond[0], beyond[1]]), Err(MoveRefusal::NotAFace(v)));
    assert_eq!(edge_collapse(&mut q, [0, 1]), Err(Refusal::Frozen.into()));
    let thin = vertex_split(&mut q, v, [around[0], around[1]]);
    assert_eq!(thin, Err(Refusal::Valence.into()));
    assert_eq!(
        edge_shift(&mut q, v, [beyond[0], apart]),
        Err(MoveRefusal::NotJoined(beyond[0], apart))
    );
    let nowhere = q.vertex_ids();
    assert_eq!(edge_deletion(&mut q, [nowhere, v]), Err(MoveRefusal::Gone(nowhere)));
    assert!(fingerprint(&q) == before, "refusals leave no traces");
}

/// A disk with a v3–v5 (or f3–f5) pair, one with two elements of index +1, one of index −1.
fn pairs() -> [QuadMesh; 3] {
    [&[14, 14, 17, 15][..], &[16, 18], &[8, 9, 10, 8, 9, 10]]
        .map(|sides| disk(sides).unwrap_or_else(|| panic!("{sides:?}")).0)
}

fn both(q: &QuadMesh) -> [Vertex; 2] {
    let all: Vec<Vertex> = Element::all(q).map(|e| e.at).collect();
    all.try_into().expect("two elements")
}

#[test]
fn figure_4_a_pair_moves_in_four_directions() {
    for mut q in pairs() {
        let (pair, rim) = (both(&q), rim_of(&q));
        let opposite = kinds(&q)[0].index() != kinds(&q)[1].index();
        let ways = if opposite { Direction::OPPOSITE } else { Direction::EQUAL };
        let mark = q.mark();
        let mut ends = Vec::new();
        for way in ways {
            let moved = pair::shift(&mut q, pair, way, 2, Route::Found).unwrap();
            // Two steps keep the types.
            let types = |pair: [Vertex; 2]| pair.map(|v| q.is_face(v));
            assert_eq!(types(moved.pair), types(pair));
            ends.push(code_from(&q, rim));
            q.undo_to(mark);
        }
        ends.push(code_from(&q, rim));
        ends.sort_unstable();
        ends.dedup();
        assert_eq!(ends.len(), 5, "four different places, and where they began");
        let wrong = if opposite { Direction::Closer } else { Direction::ClimbLeft };
        let refused = pair::shift(&mut q, pair, wrong, 1, Route::Found);
        assert_eq!(refused, Err(MoveRefusal::Direction));
    }
}

#[test]
fn figure_4_the_order_of_two_directions_does_not_matter() {
    let [mut q, ..] = pairs();
    let (pair, rim, mark) = (both(&q), rim_of(&q), q.mark());
    for one in Direction::OPPOSITE {
        for other in Direction::OPPOSITE {
            let codes = [[one, other], [other, one]].map(|ways| {
                let mut at = pair;
                for way in ways {
                    at = pair::shift(&mut q, at, way, 1, Route::Found).unwrap().pair;
                }
                let code = code_from(&q, rim);
                q.undo_to(mark);
                code
            });
            assert_eq!(codes[0], codes[1], "{one:?} and {other:?}");
        }
    }
}

#[test]
fn figure_5_a_t_junction_goes_round_in_a_circle() {
    let block = Block::with_t_junction(9, 8, 4, 4);
    let (mut q, rim) = block.lifted();
    let start = code_from(&q, rim);
    let mut at = t_junction::at(&q, block.hanging[0]).unwrap();
    let mut places = vec![start];
    for way in [Way::Up, Way::Left, Way::Down, Way::Right] {
        at = t_junction::shift(&mut q, at, way, 1).unwrap().dipole;
        assert_eq!(kinds(&q), [Kind::V3, Kind::F5], "{way:?}");
        places.push(code_from(&q, rim));
    }
    assert_eq!(places.pop(), Some(start), "back where it began");
    places.sort_unstable();
    places.dedup();
    assert_eq!(places.len(), 4);
    let lone = q.vertices().find(|&v| !q.is_held(v)).unwrap();
    assert_eq!(t_junction::at(&q, lone), Err(MoveRefusal::NotATJunction));
}

#[test]
fn figure_6_the_four_configurations_of_two_t_junctions() {
    let expected = [Outcome::Straight, Outcome::Diagonal, Outcome::Complete, Outcome::Diagonal];
    for (turn, expected) in expected.into_iter().enumerate() {
        let one = Block::with_t_junction(9, 8, 5, 4);
        let (width, height) = if turn % 2 == 0 { (9, 8) } else { (8, 9) };
        let make = |width| Block::with_t_junction(width, height, 3, 4).turned(turn);
        let other = make(width);
        // The glued side may be the one that is an edge longer.
        let other = if other.lengths()[3] > 8 { make(width - 1) } else { other };
        let block = one.beside(&other);
        for left in [Remainder::Vertices, Remainder::Faces] {
            let (mut q, _) = block.lifted();
            let pair = [0, 1].map(|i| t_junction::at(&q, block.hanging[i]).unwrap());
            assert_eq!(cancel::predict(&q, pair, Route::Found), Ok(expected), "{turn}");
            let done = cancel::quadruple(&mut q, pair, left, Route::Found).unwrap();
            assert_eq!(done.outcome, expected);
            let remain: &[Kind] = match (expected, left) {
                (Outcome::Complete, _) => &[],
                (_, Remainder::Faces) => &[Kind::F3, Kind::F5],
                _ => &[Kind::V3, Kind::V5],
            };
            assert_eq!(kinds(&q), remain, "{turn}");
        }
    }
}

#[test]
fn figure_6_along_a_path_of_the_user() {
    let block =
        Block::with_t_junction(9, 8, 4, 4).beside(&Block::with_t_junction(9, 8, 4, 4).turned(2));
    let (mut q, rim) = block.lifted();
    let pair = [0, 1].map(|i| t_junction::at(&q, block.hanging[i]).unwrap());
    // Far around, below both: through the second row of vertices from the bottom.
    let stops: Vec<Vertex> = [8, 14].map(|c| second_row(&q, &block, c)).to_vec();
    let mark = q.mark();
    let around = cancel::quadruple(&mut q, pair, Remainder::Any, Route::Through(&stops)).unwrap();
    let code = code_from(&q, rim);
    q.undo_to(mark);
    let straight = cancel::quadruple(&mut q, pair, Remainder::Any, Route::Found).unwrap();
    assert_eq!(code_from(&q, rim), code, "what is left does not depend on the way");
    assert_ne!(around.ops.len(), straight.ops.len());
    q.undo_to(mark);
    let refused = cancel::quadruple(&mut q, pair, Remainder::Any, Route::Through(&[0]));
    assert_eq!(refused, Err(MoveRefusal::BrokenPath(0)), "the corner is no way");
}

/// A vertex two rows above the bottom of a block.
fn second_row(q: &QuadMesh, block: &Block, column: usize) -> Vertex {
    let bottom = block.sides[0][column];
    let up = |v: Vertex, from: &[Vertex]| {
        q.diagonals(v).find(|w| !q.is_held(*w) && !from.contains(w)).expect("a vertex above")
    };
    let first = up(bottom, &[]);
    // Straight on: across from the bottom one.
    let around: Vec<Vertex> = q.diagonals(first).collect();
    let below = around.iter().position(|&v| v == bottom).expect("they are joined");
    around[(below + 2) % 4]
}

#[test]
fn figure_7_equal_indices_move_closer_apart_and_around() {
    let [_, plus, minus] = pairs();
    for mut q in [plus, minus] {
        let (pair, rim) = (both(&q), rim_of(&q));
        let (start, mark) = (code_from(&q, rim), q.mark());
        // Once around: four directions cancel out.
        let mut at = pair;
        for way in
            [Direction::Apart, Direction::RotateLeft, Direction::RotateRight, Direction::Closer]
        {
            at = pair::shift(&mut q, at, way, 1, Route::Found).unwrap().pair;
        }
        assert_eq!(code_from(&q, rim), start);
        // Closer until they touch, and a reason why they cannot go on.
        let mut steps = 0;
        let refused = loop {
            match pair::shift(&mut q, at, Direction::Closer, 1, Route::Found) {
                Ok(moved) => at = moved.pair,
                Err(refusal) => break refusal,
            }
            steps += 1;
            assert!(steps < 40);
        };
        assert!(steps >= 1, "{refused}");
        let apart = pair::separation(&q, at, Route::Found).unwrap();
        assert!(apart.x.abs() + apart.y.abs() <= 2, "{apart:?}");
        q.undo_to(mark);
    }
}

#[test]
fn figure_8_conversion_of_a_single_element() {
    for (sides, from) in [
        (&[5_u32, 5, 5][..], Kind::F3),
        (&[6, 6, 6], Kind::V3),
        (&[5, 5, 5, 5, 5], Kind::F5),
        (&[6, 6, 6, 6, 6], Kind::V5),
    ] {
        let (mut q, rim) = disk(sides).unwrap();
        let start = code_from(&q, rim);
        assert_eq!(kinds(&q), [from]);
        let v = Element::all(&q).next().unwrap().at;
        let total = q.total_irregularity();
        let done = convert(&mut q, v, None).unwrap();
        q.check().unwrap();
        assert_eq!(q.total_irregularity(), total + 2);
        // f5 → v5 + f3–v5, f3 → v3 + v3–f5, and the same with v and f.
        let mut expected = match from {
            Kind::F5 => [Kind::V5, Kind::F3, Kind::V5],
            Kind::F3 => [Kind::V3, Kind::V3, Kind::F5],
            Kind::V5 => [Kind::F5, Kind::V3, Kind::F5],
            Kind::V3 => [Kind::F3, Kind::F3, Kind::V5],
        };
        expected.sort_unstable();
        assert_eq!(kinds(&q), expected);
        assert_eq!(Element::at(&q, done.element).unwrap().kind, from.other_type());
        assert!(done.pair.stands(&q));
        // The inverse is a triple cancellation; a lone element has one place only.
        let predicted = cancel::predict_triple(&q, done.pair, done.element, Route::Found);
        let back = cancel::triple(&mut q, done.pair, done.element, Route::Found).unwrap();
        assert_eq!(back.left.kind, from);
        assert_eq!(predicted, Ok(from));
        assert_eq!(code_from(&q, rim), start);
    }
}

#[test]
fn figure_8_pairs_out_of_nothing_and_back() {
    for (what, expected) in [
        (Generate::Mixed, [Kind::V3, Kind::V5, Kind::F3, Kind::F5]),
        (Generate::TJunctions, [Kind::V3, Kind::V3, Kind::F5, Kind::F5]),
        (Generate::Duals, [Kind::V5, Kind::V5, Kind::F3, Kind::F3]),
    ] {
        let (mut q, v, around, _) = middle();
        let rim = rim_of(&q);
        let start = code_from(&q, rim);
        let at = if what == Generate::Duals { around[0] } else { v };
        let (pairs, _) = generate_pairs(&mut q, at, what).unwrap();
        assert_eq!(kinds(&q), expected);
        // Apart from one another, then together again.
        let mark = q.mark();
        let walked = walk_away(&mut q, pairs);
        assert_eq!(cancel::predict(&q, walked, Route::Found), Ok(Outcome::Complete));
        let done = cancel::quadruple(&mut q, walked, Remainder::Any, Route::Found).unwrap();
        assert_eq!(done.outcome, Outcome::Complete);
        assert_eq!(code_from(&q, rim), start, "{what:?}");
        q.undo_to(mark);
        let refused = generate_pairs(&mut q, at, what);
        assert!(refused.is_err(), "not in irregular surroundings");
    }
}

/// The first of two dislocations some steps away from the other.
fn walk_away(q: &mut QuadMesh, [one, other]: [Dipole; 2]) -> [Dipole; 2] {
    use quadmend::moves::dipole::STEPS;
    let mut at = one;
    for _ in 0..2 {
        let far = |q: &QuadMesh, d: Dipole| {
            (q.location(q.origin(d.0)) - q.location(q.origin(other.0))).norm()
        };
        let mark = q.mark();
        let mut best: Option<(f64, Dipole)> = None;
        let mut chosen = None;
        for step in STEPS {
            let next = at.step(q, step).ok().filter(|s| s.delta == 0).and_then(|s| s.dipole);
            if let Some(next) = next.filter(|&n| best.is_none_or(|(d, _)| far(q, n) > d)) {
                best = Some((far(q, next), next));
                chosen = Some(step);
            }
            q.undo_to(mark);
        }
        at = at.step(q, chosen.expect("a way")).unwrap().dipole.unwrap();
    }
    [at, other]
}
