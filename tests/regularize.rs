//! Regularising a disk (Figure 11, 2a to 2b): as few irregular elements as the rim allows, exact
//! undo, and a reason for every refusal.

mod common;

use common::lifted::{Dice, Invariants, fingerprint, lifted, mess_up};
use quadmend::mesh::shapes;
use quadmend::moves::regularize::{Refusal, around, faces};
use quadmend::ops::{Flip, Op, Turn};
use quadmend::sqrtcc::{QuadMesh, Vertex};

const MOST: usize = 80;

/// A torus on which one edge shift has left four irregular elements; and one of them.
fn shifted() -> (QuadMesh, Vertex) {
    let mut q = lifted(&shapes::torus(20, 16));
    Op::Flip(Flip { edge: q.out(105), turn: Turn::Ccw }).run(&mut q).unwrap();
    q.commit();
    assert_eq!(q.total_irregularity(), 4);
    let irregular = q.vertices().find(|&v| q.irregularity(v) > 0).unwrap();
    (q, irregular)
}

#[test]
fn figure_11_a_cluster_becomes_regular_and_undo_is_exact() {
    let (mut q, cluster) = shifted();
    let (before, invariants, mark) = (fingerprint(&q), Invariants::of(&q), q.mark());
    let done = around(&mut q, cluster, MOST).unwrap();
    assert_eq!((done.delta, q.total_irregularity()), (-4, 0));
    assert_eq!(Invariants::of(&q), invariants);
    q.undo_to(mark);
    assert!(fingerprint(&q) == before);
    done.refill.run(&mut q).unwrap();
    assert_eq!(q.total_irregularity(), 0, "the refill can be made again");
}

#[test]
fn a_set_of_faces_is_regularised() {
    let (mut q, cluster) = shifted();
    let near: Vec<Vertex> = q.neighbours(cluster).chain(q.diagonals(cluster)).collect();
    let mut disk: Vec<Vertex> =
        near.iter().flat_map(|&v| q.neighbours(v).chain([v])).filter(|&v| q.is_face(v)).collect();
    disk.sort_unstable();
    disk.dedup();
    assert_eq!(faces(&mut q, &disk, MOST).unwrap().delta, -4);
}

#[test]
fn random_clusters_never_get_worse_and_keep_every_invariant() {
    let mut q = lifted(&shapes::sphere(10));
    mess_up(&mut q, &mut Dice(11), 80);
    let (start, invariants) = (q.total_irregularity(), Invariants::of(&q));
    for v in 0..q.vertex_ids() {
        if q.is_alive(v) && q.irregularity(v) > 0 {
            let (before, same) = (q.total_irregularity() as i64, fingerprint(&q));
            match around(&mut q, v, MOST) {
                Ok(done) => {
                    assert!(done.delta < 0);
                    assert_eq!(q.total_irregularity() as i64, before + i64::from(done.delta));
                }
                Err(_) => assert!(fingerprint(&q) == same, "a refusal leaves no trace"),
            }
        }
    }
    assert_eq!(Invariants::of(&q), invariants);
    assert!(q.total_irregularity() < start / 2, "{start} to {}", q.total_irregularity());
}

#[test]
fn refusals_name_their_reason() {
    let mut q = lifted(&shapes::torus(12, 10));
    let face = q.vertices().find(|&v| q.is_face(v)).unwrap();
    let told = |r: Result<_, Refusal>| {
        r.map(|_: quadmend::moves::regularize::Regularized| ()).unwrap_err()
    };
    assert_eq!(told(faces(&mut q, &[], MOST)), Refusal::Empty);
    assert_eq!(told(faces(&mut q, &[0], MOST)), Refusal::Gone(0));
    assert_eq!(told(around(&mut q, u32::MAX, MOST)), Refusal::Gone(u32::MAX));
    let regular = Refusal::AsRegularAsCanBe { before: 0, after: 0 };
    assert_eq!(told(faces(&mut q, &[face], MOST)), regular);
    let row: Vec<Vertex> = (0..12).map(|i| face + i).collect();
    assert_eq!(told(faces(&mut q, &row, MOST)), Refusal::NotADisk, "an annulus");
    assert_eq!(told(faces(&mut q, &[face, face + 1], 1)), Refusal::TooLarge);
    assert!(told(faces(&mut q, &row, MOST)).to_string().contains("no disk"));
}
