//! The √CC domain: lifting and lowering a mesh of 20,184 quads, each operation with its undo, and
//! the steps of a dislocation.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use fixedbitset::FixedBitSet;
use quadmend::mesh::{PolyMesh, shapes};
use quadmend::moves::Dipole;
use quadmend::moves::dipole::STEPS;
use quadmend::ops::{Collapse, Flip, Op, Split, Turn};
use quadmend::sqrtcc::{QuadMesh, lift, lower};

fn lifted(mesh: &PolyMesh) -> QuadMesh {
    lift(mesh, &FixedBitSet::with_capacity(mesh.corner_count()))
        .unwrap_or_else(|e| unreachable!("shapes can be lifted: {e}"))
}

fn both_ways(c: &mut Criterion) {
    let mesh = shapes::sphere(58);
    let q = lifted(&mesh);
    let mut group = c.benchmark_group("20,184 quads");
    group.bench_function("lift", |b| b.iter(|| lifted(&mesh)));
    group.bench_function("lower", |b| b.iter(|| lower(&q, mesh.group_names())));
    group.bench_function("check", |b| b.iter(|| q.check()));
    group.bench_function("total irregularity", |b| b.iter(|| q.total_irregularity()));
    group.finish();
}

fn operations(c: &mut Criterion) {
    let mut q = lifted(&shapes::torus(100, 100));
    // An edge in regular surroundings: every operation is legal there.
    let edge = q.out(5050);
    let last = q.ccw(q.ccw(edge));
    let all = [
        ("flip", Op::Flip(Flip { edge, turn: Turn::Ccw })),
        ("collapse", Op::Collapse(Collapse { edge })),
        ("split", Op::Split(Split { first: edge, last })),
    ];
    let mut group = c.benchmark_group("operation");
    for (name, op) in all {
        assert!(op.check(&q).is_ok(), "{name} is legal");
        group.bench_function(format!("{name}: check"), |b| b.iter(|| black_box(op).check(&q)));
        group.bench_function(format!("{name}: check, apply, undo"), |b| {
            b.iter(|| {
                let mark = q.mark();
                let delta = op.run(&mut q);
                q.undo_to(mark);
                delta
            });
        });
    }
    group.finish();
}

fn steps(c: &mut Criterion) {
    let mut q = lifted(&shapes::torus(100, 100));
    let edge = q.out(5050);
    let _ = Op::Flip(Flip { edge, turn: Turn::Ccw }).run(&mut q);
    let Some(dipole) = Dipole::all(&q).find(|d| d.is_t_junction()) else {
        unreachable!("a flip makes a T-junction");
    };
    let mut group = c.benchmark_group("dislocation");
    group.bench_function("each of six steps, undone", |b| {
        b.iter(|| {
            for step in STEPS {
                let mark = q.mark();
                let _ = black_box(dipole.step(&mut q, step));
                q.undo_to(mark);
            }
        });
    });
    group.bench_function("find all in 10,000 quads", |b| b.iter(|| Dipole::all(&q).count()));
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = both_ways, operations, steps
}
criterion_main!(benches);
