//! The planner on generated meshes: dislocations annihilate and are absorbed by lone elements,
//! local reductions do what they say, and a messed-up shape becomes clean again.

mod common;

use common::lifted::{Dice, Invariants, fingerprint, lifted, mess_up, samples};
use common::{Segment, say, segments, shape};
use quadmend::config::Config;
use quadmend::mesh::{MendPolicy, Point, PolyMesh, Topology, Vector, shapes};
use quadmend::moves::dipole::STEPS;
use quadmend::moves::{Dipole, Step};
use quadmend::ops::{Flip, Op, Turn};
use quadmend::patch::fillings;
use quadmend::pipeline;
use quadmend::planner::cost::CostOptions;
use quadmend::planner::edit::Edit;
use quadmend::planner::global::groups;
use quadmend::planner::local;
use quadmend::planner::movement::{Cancellation, MovementGraph};
use quadmend::sqrtcc::{QuadMesh, Vertex, lift, lower};
use quadmend::watch::Silent;
use std::collections::BTreeSet;

/// Steps that a search goes.
const REACH: u16 = 16;

/// Turns one edge at `v`: a T-junction and the opposite dual one, in regular surroundings.
fn emit(q: &mut QuadMesh, v: Vertex) -> [Dipole; 2] {
    let known: Vec<Dipole> = Dipole::all(q).collect();
    let edge = q.out(v);
    let delta = Op::Flip(Flip { edge, turn: Turn::Ccw }).run(q).expect("a regular place");
    assert_eq!(delta, 4, "two pairs");
    let new: Vec<Dipole> = Dipole::all(q).filter(|d| !known.contains(d)).collect();
    let find = |t: bool| new.iter().copied().find(|d| d.is_t_junction() == t);
    // Adjacent ones can be paired in several ways; each v3 has a v5 of the other colour beside it.
    [find(true), find(false)].map(|d| d.expect("a dislocation of each type"))
}

/// Walks up to `count` random steps with ΔE = 0.
fn stroll(q: &mut QuadMesh, mut at: Dipole, dice: &mut Dice, count: u32) -> Dipole {
    for _ in 0..count {
        let mark = q.mark();
        let step = STEPS[dice.below(STEPS.len() as u32) as usize];
        match at.step(q, step) {
            Ok(done) if done.delta == 0 && done.dipole.is_some() => {
                at = done.dipole.unwrap_or(at);
            }
            _ => q.undo_to(mark),
        }
    }
    at
}

/// The cheapest way to an absorption that `wanted` accepts: kind, gain, steps.
fn search(
    q: &mut QuadMesh,
    start: Dipole,
    wanted: impl Fn(Cancellation) -> bool,
) -> Option<(Cancellation, u32, Vec<Step>)> {
    let costs = CostOptions::default();
    let before = fingerprint(q);
    let graph = MovementGraph::new(q, start, REACH, &costs);
    let (mut refused, mut found) = (Vec::new(), None);
    while let Some((node, cost)) = graph.search(&refused) {
        assert!(cost > 0.0 && cost.is_finite());
        let kind = graph.cancellation(node).expect("a search ends at a goal");
        if wanted(kind) {
            found = Some((kind, graph.gain(node), graph.steps(node)));
            break;
        }
        refused.push(node);
        if refused.len() > 200 {
            break;
        }
    }
    drop(graph);
    assert!(fingerprint(q) == before, "a search leaves the mesh as it was");
    found
}

/// Makes the steps; the change of E, measured.
fn walk(q: &mut QuadMesh, start: Dipole, steps: &[Step]) -> i64 {
    let before = q.total_irregularity() as i64;
    let (mut at, mut delta) = (Some(start), 0);
    for &step in steps {
        let done = at.expect("absorbed at the last step only").step(q, step).expect("legal");
        (at, delta) = (done.dipole, delta + i64::from(done.delta));
    }
    let measured = q.total_irregularity() as i64 - before;
    assert_eq!(measured, delta, "predicted and measured change of E");
    measured
}

/// Figure 6: two opposite dislocations on a torus vanish wholly, whichever of them walks.
#[test]
fn opposite_dislocations_find_each_other_and_vanish() {
    let mut kinds = [0; 2];
    for seed in 0..24 {
        let mut dice = Dice(seed);
        let mut q = lifted(&shapes::torus(40, 40));
        let invariants = Invariants::of(&q);
        let [mut t, mut dual] = emit(&mut q, 820);
        t = stroll(&mut q, t, &mut dice, 7);
        // Walking around the first may have changed where the other one stands.
        if dual.stands(&q) {
            dual = stroll(&mut q, dual, &mut dice, 7);
        }
        assert_eq!(q.total_irregularity(), 4, "seed {seed}: two pairs are left");
        for start in [t, dual].into_iter().filter(|d| d.stands(&q)).collect::<Vec<_>>() {
            let (kind, gain, steps) = search(&mut q, start, |k| k != Cancellation::Triple)
                .unwrap_or_else(|| panic!("seed {seed}: {start:?} finds nothing"));
            assert_eq!(gain, 4, "seed {seed}");
            kinds[usize::from(kind == Cancellation::Quadruple)] += 1;
            let mark = q.mark();
            assert_eq!(walk(&mut q, start, &steps), -4, "seed {seed}");
            assert_eq!(q.total_irregularity(), 0, "seed {seed}: a regular torus");
            assert_eq!(Invariants::of(&q), invariants, "seed {seed}");
            q.undo_to(mark);
        }
    }
    assert!(kinds.iter().all(|&n| n > 5), "T-junction pairs and others are met: {kinds:?}");
}

/// A disk with one irregular element in the middle of `sides` equal sides: a vertex if the
/// perimeter is even, else a face.
fn lone_element(sides: usize, length: u32) -> PolyMesh {
    let n = sides as u32 * length;
    let corners: Vec<usize> = (0..sides).map(|i| i * length as usize).collect();
    let filling = fillings(n as usize, &corners, 1).swap_remove(0);
    let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(n);
    let rim = (0..n).map(|i| Point::new(angle(i).cos(), angle(i).sin(), 0.0));
    let mut points: Vec<Point> = rim.collect();
    points.resize((n + filling.interior) as usize, Point::origin());
    for _ in 0..200 {
        let mut sums = vec![(Vector::zeros(), 0.0); points.len()];
        for face in filling.faces() {
            for (i, &a) in face.iter().enumerate() {
                let (sum, count) = &mut sums[a as usize];
                *sum += points[face[(i + 1) % face.len()] as usize].coords;
                *count += 1.0;
            }
        }
        for v in n as usize..points.len() {
            points[v] = Point::from(sums[v].0 / sums[v].1);
        }
    }
    let faces: Vec<Vec<u32>> = filling.faces().map(<[u32]>::to_vec).collect();
    PolyMesh::new(points, faces).expect("a disk")
}

/// The irregular vertices and faces that are not on the boundary.
fn irregular(q: &QuadMesh) -> Vec<Vertex> {
    q.vertices().filter(|&v| !q.is_held(v) && q.irregularity(v) > 0).collect()
}

/// Triple cancellation: a dislocation and a lone v3, v5, f3 or f5 become one lone element.
#[test]
fn lone_elements_absorb_dislocations() {
    for (sides, length) in [(3, 16), (3, 15), (5, 12), (5, 11)] {
        let mesh = lone_element(sides, length);
        let mut q = lifted(&mesh);
        let [lone] = irregular(&q)[..] else { panic!("one element in the middle") };
        assert_eq!(q.is_face(lone), sides as u32 * length % 2 == 1, "parity decides the type");
        // Up to three quads of Q away from it, but not beside it.
        let ring = |of: Vec<Vertex>| -> Vec<Vertex> {
            of.into_iter().flat_map(|v| q.diagonals(v).collect::<Vec<_>>()).collect()
        };
        let apart = |v: &Vertex| *v != lone && !q.diagonals(*v).any(|w| w == lone);
        let near: Vec<Vertex> =
            (0..3).fold(vec![lone], |of, _| ring(of)).into_iter().filter(apart).collect();
        let (first, last) = (near[0], near[near.len() - 1]);
        for v in [first, last] {
            let mark = q.mark();
            let invariants = Invariants::of(&q);
            for start in emit(&mut q, v) {
                let again = q.mark();
                let total = q.total_irregularity();
                let found = search(&mut q, start, |k| k == Cancellation::Triple);
                let (_, gain, steps) =
                    found.unwrap_or_else(|| panic!("{sides} × {length}: {start:?}: no triple"));
                assert_eq!(gain, 2, "{sides} × {length}");
                assert_eq!(walk(&mut q, start, &steps), -2, "{sides} × {length}");
                assert_eq!(q.total_irregularity(), total - 2, "{sides} × {length}");
                assert_eq!(Invariants::of(&q), invariants, "{sides} × {length}");
                q.undo_to(again);
            }
            q.undo_to(mark);
        }
    }
}

/// The corners of the cube on a sphere are lone v3.
#[test]
fn a_dislocation_ends_at_a_corner_of_the_sphere() {
    let mut q = lifted(&shapes::sphere(12));
    let corner = irregular(&q)[0];
    assert_eq!(q.total_irregularity(), 8);
    let at = q.diagonals(corner).next().expect("a neighbour");
    let away = q.diagonals(at).find(|&v| v != corner && q.irregularity(v) == 0);
    let away = away.expect("a regular vertex two edges from the corner");
    let away = q.diagonals(away).find(|&v| v != at).expect("another");
    for start in emit(&mut q, away) {
        let mark = q.mark();
        let (_, gain, steps) =
            search(&mut q, start, |k| k == Cancellation::Triple).expect("a triple cancellation");
        assert_eq!((gain, walk(&mut q, start, &steps)), (2, -2));
        assert_eq!(q.total_irregularity(), 10, "7 corners, one that has moved, and the partner");
        q.check().expect("a sound mesh");
        q.undo_to(mark);
    }
}

#[test]
fn local_reductions_reduce_by_what_they_say() {
    let mut by_length = [0; 3];
    for (name, mesh, features) in samples() {
        for seed in 0..4 {
            let mut q = lift(&mesh, &features).expect(name);
            mess_up(&mut q, &mut Dice(seed), 60);
            let (invariants, state) = (Invariants::of(&q), fingerprint(&q));
            let before = q.total_irregularity() as i64;
            let seeds: Vec<Vertex> = q.vertices().filter(|&v| q.irregularity(v) > 0).collect();
            for v in seeds.into_iter().step_by(3) {
                let found = local::reductions(&mut q, v, 2);
                assert!(found.is_sorted(), "{name}: best first");
                for (delta, ops) in found.into_iter().step_by(2) {
                    let mark = q.mark();
                    for op in &ops {
                        op.run(&mut q).unwrap_or_else(|e| panic!("{name}: {op:?}: {e}"));
                    }
                    let measured = q.total_irregularity() as i64 - before;
                    assert!(measured < 0, "{name}: {ops:?} does not reduce");
                    assert_eq!(measured, i64::from(delta), "{name}: {ops:?}");
                    by_length[ops.len()] += 1;
                    q.undo_to(mark);
                }
            }
            assert_eq!(Invariants::of(&q), invariants, "{name}");
            assert!(fingerprint(&q) == state, "{name}: the search left traces");
        }
    }
    assert!(by_length[1] > 50 && by_length[2] > 50, "both depths are met: {by_length:?}");
}

/// Ends of the boundary edges, bit for bit, sorted.
fn boundary(mesh: &PolyMesh) -> Vec<Segment> {
    let topology = Topology::new(mesh);
    segments(mesh, &topology, topology.boundary_half_edges())
}

/// A soak: random legal edits are cleaned away again.
#[test]
fn a_messed_up_shape_becomes_clean() {
    let mut config = Config::default();
    config.measure.samples = 20_000;
    // The reference is finer: a mesh on a reference of its own edges has no distance to spare.
    let sphere = || (shapes::sphere(12), shapes::sphere(48));
    let torus = || (shapes::torus(48, 20), shapes::torus(192, 80));
    let disk = || (shapes::grid(30, 24), shapes::grid(30, 24));
    let cases = [
        ("sphere", sphere(), 0, 20),
        ("sphere", sphere(), 1, 40),
        ("torus", torus(), 2, 20),
        ("torus", torus(), 3, 40),
        ("disk", disk(), 4, 20),
        ("disk", disk(), 5, 40),
    ];
    for (name, (regular, reference), seed, edits) in cases {
        let mut q = lifted(&regular);
        mess_up(&mut q, &mut Dice(seed), edits);
        let messy = lower(&q, regular.group_names()).expect(name).mesh;
        let cleaned =
            pipeline::clean(messy.clone(), Some(&reference), MendPolicy::Mend, &config, &Silent)
                .unwrap_or_else(|e| panic!("{name} {seed}: {e}"));
        let (before, after) = (&cleaned.report.before.summary, &cleaned.report.after.summary);
        let (e, left) = (before.irregular_elements, after.irregular_elements);
        say(&format!("{name} {seed}: E {e} -> {left}"));
        assert!(left <= e, "{name} {seed}: E has risen from {e} to {left}");
        assert!(left * 10 <= e * 3, "{name} {seed}: E {e} -> {left}");
        assert_eq!(shape(&cleaned.mesh), shape(&messy), "{name} {seed}: χ and loops");
        assert_eq!(boundary(&cleaned.mesh), boundary(&messy), "{name} {seed}: boundary");
        assert!(after.manifold && after.oriented && after.gauss_bonnet_exact, "{name} {seed}");
        assert!(after.degenerate.connectivity.is_clean(), "{name} {seed}");
        for edit in cleaned.report.edits.iter().filter(|e| matches!(e.edit, Edit::Refill(_))) {
            let pays = edit.gain > 0 || edit.angle_growth_deg <= -config.plan.relocation_saves;
            assert!(pays, "{name} {seed}: a refill for nothing");
        }
    }
}

/// Without a reference the input is the surface to stay on.
#[test]
fn a_mesh_is_cleaned_without_a_reference() {
    let mut config = Config::default();
    config.measure.samples = 20_000;
    let mut q = lifted(&shapes::sphere(12));
    mess_up(&mut q, &mut Dice(0), 20);
    let messy = lower(&q, &[String::new()]).expect("a sphere").mesh;
    let cleaned = pipeline::clean(messy, None, MendPolicy::Mend, &config, &Silent)
        .unwrap_or_else(|e| panic!("{e}"));
    let (before, after) = (&cleaned.report.before.summary, &cleaned.report.after.summary);
    assert!(after.irregular_elements * 2 <= before.irregular_elements, "half of it at least");
}

/// What is left may be a vertex or a face; `cost.face` decides where a refill has the choice.
#[test]
fn survivors_are_of_the_type_that_costs_less() {
    let irregular_faces = |price: &str| -> usize {
        let left = |seed: u64| {
            let mut q = lifted(&shapes::sphere(10));
            mess_up(&mut q, &mut Dice(seed), 25);
            let messy = lower(&q, &[String::new()]).expect("a sphere").mesh;
            let config = Config::default().with_assignment(price).expect("a price");
            let surface = shapes::sphere(30);
            let done = pipeline::clean(messy, Some(&surface), MendPolicy::Mend, &config, &Silent)
                .expect("it is cleaned");
            done.mesh.faces().filter(|f| f.len() != 4).count()
        };
        (0..4).map(left).sum()
    };
    let [dear, cheap] = ["cost.face=2000", "cost.face=-2000"].map(irregular_faces);
    say(&format!("irregular faces left: {dear} where they are dear, {cheap} where cheap"));
    assert!(dear < cheap);
}

#[test]
fn the_global_plan_brings_opposite_burgers_vectors_together() {
    let (mut one, mut two) = (0, 0);
    for seed in 0..40 {
        let mut q = lifted(&shapes::torus(24, 24));
        let mut dice = Dice(seed);
        let faraway: Vec<Vertex> = q.vertices().step_by(300).take(2).collect();
        let [t_junction, _] = emit(&mut q, faraway[0]);
        stroll(&mut q, t_junction, &mut dice, 24);
        let found = groups(&q, 60, &BTreeSet::new());
        one += usize::from(matches!(&found[..], [g] if g.gain == 4 && g.members.len() == 4));
        // A second flip far away: each finds its own again.
        emit(&mut q, faraway[1]);
        let found = groups(&q, 60, &BTreeSet::new());
        two += usize::from(found.len() == 2 && found.iter().all(|g| g.gain == 4));
        // What was tried is not proposed again.
        let tried = found.iter().map(|g| g.link).collect();
        let again = groups(&q, 60, &tried);
        assert!(again.iter().all(|g| !tried.contains(&g.link)));
    }
    // Now and then elements stand so close that no way leads between them.
    assert!(one >= 38 && two >= 36, "{one} and {two} of 40");
}
