//! Moves in general: exact on regular grids, and thousands of random sequences on real meshes.

mod common;

use std::path::{Path, PathBuf};

use common::data_folder;
use common::lifted::{Dice, Invariants, code_from, fingerprint, lifted};
use quadmend::io;
use quadmend::mesh::{MendPolicy, Topology, mend, shapes};
use quadmend::moves::cancel::{self, Remainder};
use quadmend::moves::conversion::{Generate, convert, generate_pairs};
use quadmend::moves::pair::{self, Direction};
use quadmend::moves::t_junction::{self, Direction as Way};
use quadmend::moves::{Dipole, Element, MoveRefusal, Route, merge};
use quadmend::sqrtcc::{QuadMesh, Vertex, lift};
use quadmend::surface::{FeatureOptions, Reference, mesh_features, vertices_on_lines};

/// Random sequences on each mesh, and moves in a sequence.
const SEQUENCES: usize = 2000;
const MOVES: usize = 4;
/// Small real meshes; four of them and the sample make 10,000 sequences.
const MESHES: [&str; 4] = ["spot_im3k", "wingnut_im4k", "lilium_gmsh", "blub_im6k"];

fn read(path: &Path) -> QuadMesh {
    let mesh = mend(io::read(path).unwrap().mesh, MendPolicy::Mend).unwrap().0;
    let own = Reference::new(&mesh).unwrap();
    let (topology, options) = (Topology::new(&mesh), FeatureOptions::default());
    let mut q = lift(&mesh, &mesh_features(&mesh, &topology, &own, &options)).unwrap();
    for v in vertices_on_lines(&mesh, &topology, &own, &options) {
        q.pin(v);
    }
    q
}

/// One of the values.
fn any<T: Copy>(dice: &mut Dice, values: &[T]) -> T {
    values[dice.below(values.len() as u32) as usize]
}

/// An irregular element, and one of the few that are nearest to it.
fn neighbours(q: &QuadMesh, elements: &[Vertex], dice: &mut Dice) -> Option<[Vertex; 2]> {
    let alive: Vec<Vertex> =
        elements.iter().copied().filter(|&v| Element::at(q, v).is_ok()).collect();
    if alive.len() < 2 {
        return None;
    }
    let a = any(dice, &alive);
    let distance = |v: &Vertex| (q.location(*v) - q.location(a)).norm_squared();
    let mut near: Vec<Vertex> = alive.into_iter().filter(|&v| v != a).collect();
    let few = near.len().min(6);
    near.select_nth_unstable_by(few - 1, |v, w| distance(v).total_cmp(&distance(w)));
    near[..few].sort_unstable();
    Some([a, any(dice, &near[..few])])
}

fn dislocation(q: &QuadMesh, v: Vertex) -> Result<Dipole, MoveRefusal> {
    let mut around = q.outgoing(v).flat_map(|h| [Dipole(h), Dipole(q.twin(h))]);
    around.find(|d| d.stands(q)).ok_or(MoveRefusal::NotADislocation)
}

/// A random move of random elements; whether it was made. A refused one must leave no traces.
fn random_move(q: &mut QuadMesh, elements: &[Vertex], dice: &mut Dice) -> bool {
    let Some([a, b]) = neighbours(q, elements, dice) else { return false };
    let mark = q.mark();
    let ids = (q.vertex_ids(), q.quad_ids());
    let made = match dice.below(10) {
        0..=2 => {
            let ways = [Direction::OPPOSITE, Direction::EQUAL].concat();
            let (way, steps) = (any(dice, &ways), 1 + dice.below(3));
            pair::shift(q, [a, b], way, steps, Route::Found).map(|_| ())
        }
        3 => pair::change_type(q, [a, b], Route::Found).map(|_| ()),
        4 => convert(q, a, None).map(|_| ()),
        5 => merge::merge(q, [a, b], Route::Found).map(|_| ()),
        6 => {
            let way = any(dice, &[Way::Up, Way::Down, Way::Left, Way::Right]);
            let edges = 1 + dice.below(3);
            dislocation(q, a).and_then(|d| t_junction::shift(q, d, way, edges)).map(|_| ())
        }
        7 => {
            let left = any(dice, &[Remainder::Any, Remainder::Vertices, Remainder::Faces]);
            let pair = dislocation(q, a).and_then(|d| Ok([d, dislocation(q, b)?]));
            pair.and_then(|p| cancel::quadruple(q, p, left, Route::Found)).map(|_| ())
        }
        8 => dislocation(q, a).and_then(|d| cancel::triple(q, d, b, Route::Found)).map(|_| ()),
        _ => {
            let what = any(dice, &[Generate::Mixed, Generate::TJunctions, Generate::Duals]);
            let at = q.neighbours(q.target(q.cw(q.out(a)))).next().unwrap_or(a);
            generate_pairs(q, at, what).map(|_| ())
        }
    };
    if made.is_err() {
        assert_eq!((q.vertex_ids(), q.quad_ids()), ids, "a refusal leaves no traces");
        assert!(q.touched_since(mark).is_empty(), "a refusal leaves no traces");
    }
    made.is_ok()
}

/// Random sequences of moves, each undone; the number of moves that were made.
fn sequences(q: &mut QuadMesh, dice: &mut Dice) -> usize {
    let invariants = Invariants::of(q);
    let before = fingerprint(q);
    let elements: Vec<Vertex> = Element::all(q).map(|e| e.at).collect();
    let mut made = 0;
    for number in 1..=SEQUENCES {
        let mark = q.mark();
        for _ in 0..MOVES {
            made += usize::from(random_move(q, &elements, dice));
        }
        for v in q.touched_since(mark) {
            assert!(!q.is_alive(v) || q.is_ghost(v) || q.check_vertex(v).is_ok(), "{number}");
        }
        if number % 250 == 0 {
            assert_eq!(Invariants::of(q), invariants, "{number}");
        }
        q.undo_to(mark);
        if number % 250 == 0 {
            assert!(fingerprint(q) == before, "{number}: undo is exact");
        }
    }
    made
}

#[test]
fn random_sequences_keep_every_invariant_and_undo_to_identical_bytes() {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/bracket.obj");
    let real = data_folder("random sequences of moves")
        .into_iter()
        .flat_map(|folder| MESHES.map(|name| folder.join(name).with_extension("obj")));
    let paths: Vec<PathBuf> = std::iter::once(sample).chain(real).filter(|p| p.is_file()).collect();
    for (path, seed) in paths.iter().zip(1..) {
        let made = sequences(&mut read(path), &mut Dice(seed));
        assert!(made > SEQUENCES, "{}: only {made} moves were legal", path.display());
    }
}

#[test]
fn on_a_regular_torus_each_move_has_its_exact_inverse() {
    let (mut q, far, pairs) = facing_on_a_torus();
    let mut at = t_junction::shift(&mut q, pairs[0], Way::Down, 4).unwrap().dipole;
    at = t_junction::shift(&mut q, at, Way::Left, 3).unwrap().dipole;
    let (start, invariants) = (code_from(&q, far), Invariants::of(&q));
    for way in [Way::Up, Way::Down, Way::Left, Way::Right] {
        for edges in 1..=3 {
            let there = t_junction::shift(&mut q, at, way, edges).unwrap().dipole;
            assert_ne!(code_from(&q, far), start);
            assert_eq!(Invariants::of(&q), invariants);
            at = t_junction::shift(&mut q, there, way.inverse(), edges).unwrap().dipole;
            assert_eq!(code_from(&q, far), start, "{way:?} {edges}");
        }
    }
    // The v3 of one with the f5 of the other.
    let pair = [q.origin(at.0), q.target(pairs[1].0)];
    all_there_and_back(&mut q, far, pair, Direction::OPPOSITE);
    // The two v3, which face one another.
    let (mut q, far, pairs) = facing_on_a_torus();
    let at = t_junction::shift(&mut q, pairs[0], Way::Down, 6).unwrap().dipole;
    let pair = [q.origin(at.0), q.origin(pairs[1].0)];
    all_there_and_back(&mut q, far, pair, Direction::EQUAL);
}

/// Two T-junctions whose hanging vertices are neighbours, and a half-edge far from them.
fn facing_on_a_torus() -> (QuadMesh, u32, [Dipole; 2]) {
    let mut q = lifted(&shapes::torus(30, 30));
    let far = q.out(0);
    let (pairs, _) = generate_pairs(&mut q, 15 * 30 + 15, Generate::TJunctions).unwrap();
    (q, far, pairs)
}

/// Moves a pair in each direction that its partners leave free, and back.
fn all_there_and_back(q: &mut QuadMesh, far: u32, pair: [Vertex; 2], ways: [Direction; 4]) {
    let (start, mut made) = (code_from(q, far), 0);
    for way in ways {
        let mark = q.mark();
        if let Ok(moved) = pair::shift(q, pair, way, 1, Route::Found) {
            made += 1;
            assert!(
                moved.pair.iter().zip(pair).all(|(&new, old)| q.is_face(new) != q.is_face(old))
            );
            pair::shift(q, moved.pair, way.inverse(), 1, Route::Found).unwrap();
            assert_eq!(code_from(q, far), start, "{way:?}");
        }
        q.undo_to(mark);
    }
    assert!(made >= 2, "beside their partners, some directions are free");
}
