//! The displacement table of the six steps, on a torus large enough to be a plane.

use fixedbitset::FixedBitSet;
use quadmend::mesh::{Vector, shapes};
use quadmend::moves::dipole::{Dipole, STEPS, Step};
use quadmend::moves::t_junction::{self, Direction};
use quadmend::ops::{Flip, Op, Turn};
use quadmend::sqrtcc::{QuadMesh, lift};

const SIZE: u32 = 40;

/// A torus grid with two opposite dislocations, made by one FLIP; and one of them.
fn torus_with_dislocation() -> (QuadMesh, Dipole) {
    let mesh = shapes::torus(SIZE, SIZE);
    let mut q = lift(&mesh, &FixedBitSet::with_capacity(mesh.corner_count())).unwrap();
    // Grid coordinates as positions, so that displacements can be read off.
    for v in 0..SIZE * SIZE {
        q.set_position(v, [f64::from(v % SIZE), f64::from(v / SIZE), 0.0].into());
    }
    let centre = q.out(SIZE * SIZE / 2 + SIZE / 2);
    Op::Flip(Flip { edge: centre, turn: Turn::Ccw }).run(&mut q).unwrap();
    let pairs: Vec<Dipole> = Dipole::all(&q).collect();
    let t = pairs.iter().copied().find(|d| d.is_t_junction()).unwrap();
    // Apart from one another, so that both are in regular surroundings.
    let mut at = t;
    for _ in 0..6 {
        at = [Step::GlideLeft, Step::GlideRight]
            .into_iter()
            .find_map(|s| {
                let mark = q.mark();
                let next = at.step(&mut q, s).ok().filter(|d| d.delta == 0).and_then(|d| d.dipole);
                let farther = next.filter(|n| distance(&q, *n, t) > distance(&q, at, t) - 1e-9);
                if farther.is_none() {
                    q.undo_to(mark);
                }
                farther
            })
            .unwrap();
    }
    (q, at)
}

fn place(q: &QuadMesh, d: Dipole) -> Vector {
    (q.location(q.origin(d.0)).coords + q.location(q.target(d.0)).coords) / 2.0
}

fn distance(q: &QuadMesh, a: Dipole, b: Dipole) -> f64 {
    (place(q, a) - place(q, b)).norm()
}

#[test]
fn every_step_keeps_e_and_its_inverse_restores_the_mesh() {
    let (mut q, mut at) = torus_with_dislocation();
    let total = q.total_irregularity();
    for step in STEPS {
        let before = (q.vertices().count(), q.quads().count());
        let there = at.step(&mut q, step).unwrap_or_else(|e| panic!("{step:?}: {e}"));
        assert_eq!(there.delta, 0, "{step:?}");
        let moved = there.dipole.unwrap_or_else(|| panic!("{step:?} lost the dislocation"));
        let swaps = step.displacement().swaps_type();
        assert_eq!(moved.is_t_junction() != at.is_t_junction(), swaps, "{step:?}");
        assert_eq!(q.quads().count() as i32 - before.1 as i32, step.quads_added(), "{step:?}");
        let back = moved.step(&mut q, step.inverse()).unwrap_or_else(|e| panic!("{step:?}: {e}"));
        assert_eq!(back.delta, 0, "{step:?}");
        at = back.dipole.unwrap_or_else(|| panic!("{step:?}: lost on the way back"));
        assert_eq!((q.vertices().count(), q.quads().count()), before, "{step:?}");
        assert_eq!(q.total_irregularity(), total, "{step:?}");
        q.check().unwrap();
    }
}

#[test]
fn displacement_table() {
    let (q, at) = torus_with_dislocation();
    // Both diagonals of the lattice of Q have length 1 in units of a primal edge.
    for (one, other) in [
        ([Step::ClimbLeft, Step::ClimbRight], [Step::ClimbRight, Step::ClimbLeft]),
        ([Step::SinkLeft, Step::SinkRight], [Step::SinkRight, Step::SinkLeft]),
        ([Step::ClimbLeft, Step::SinkRight], [Step::GlideRight, Step::GlideRight]),
        ([Step::ClimbLeft, Step::SinkLeft], [Step::GlideLeft, Step::GlideRight]),
    ] {
        let sums = [one, other].map(|w| w[0].displacement() + w[1].displacement());
        let ends = [one, other].map(|way| {
            let mut q = q.clone();
            let mut d = at;
            for step in way {
                d = d.step(&mut q, step).unwrap().dipole.unwrap();
            }
            place(&q, d)
        });
        if sums[0] == sums[1] {
            assert!((ends[0] - ends[1]).norm() < 0.5, "{one:?} and {other:?}: {ends:?}");
        } else {
            assert!((ends[0] - ends[1]).norm() > 0.5, "{one:?} and {other:?}: {ends:?}");
        }
    }
}

#[test]
fn figure_5_and_proposition_3_6_t_junctions_move_by_whole_edges() {
    let (q, at) = torus_with_dislocation();
    let start = place(&q, at);
    let ends = [Direction::Up, Direction::Down, Direction::Left, Direction::Right].map(|to| {
        let mut q = q.clone();
        let total = q.total_irregularity();
        let d = t_junction::shift(&mut q, at, to, 1).unwrap().dipole;
        assert_eq!(q.total_irregularity(), total, "{to:?}");
        assert_eq!(d.is_t_junction(), at.is_t_junction(), "{to:?}");
        q.check().unwrap();
        place(&q, d) - start
    });
    assert!((ends[0] + ends[1]).norm() < 0.6, "up and down are opposite: {ends:?}");
    assert!((ends[2] + ends[3]).norm() < 0.6, "left and right are opposite: {ends:?}");
    assert!(ends[0].dot(&ends[2]).abs() < 0.5, "up and left are square: {ends:?}");
}
