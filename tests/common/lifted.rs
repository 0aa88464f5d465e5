//! Meshes in the √CC domain for property tests: samples, random operations, and what must not
//! change.

use fixedbitset::FixedBitSet;
use quadmend::mesh::{PolyMesh, Topology, shapes};
use quadmend::ops::{Collapse, Flip, Op, Split, Turn};
use quadmend::sqrtcc::{QuadMesh, lift};

/// No edge is a feature.
pub(crate) fn no_features(mesh: &PolyMesh) -> FixedBitSet {
    FixedBitSet::with_capacity(mesh.corner_count())
}

/// The mesh in the √CC domain, without features.
pub(crate) fn lifted(mesh: &PolyMesh) -> QuadMesh {
    lift(mesh, &no_features(mesh)).expect("shapes can be lifted")
}

/// The edges of the cube [−1, 1]³.
pub(crate) fn cube_edges(mesh: &PolyMesh) -> FixedBitSet {
    let topology = Topology::new(mesh);
    let mut features = no_features(mesh);
    for h in 0..mesh.corner_count() {
        let ends =
            [h, topology.next[h] as usize].map(|c| mesh.points()[mesh.corners()[c] as usize]);
        let sides = (0..3)
            .filter(|&k| ends.iter().all(|p| (p[k] - ends[0][k].signum()).abs() < 1e-9))
            .count();
        features.set(h, sides == 2);
    }
    features
}

/// A closed mesh, one with a boundary, one with a handle, one with features; each with its
/// feature half-edges.
pub(crate) fn samples() -> Vec<(&'static str, PolyMesh, FixedBitSet)> {
    let plain = |name, mesh: PolyMesh| {
        let features = no_features(&mesh);
        (name, mesh, features)
    };
    let cube = shapes::cube(8);
    let edges = cube_edges(&cube);
    vec![
        plain("sphere", shapes::sphere(8)),
        plain("disk", shapes::grid(16, 12)),
        plain("torus", shapes::torus(24, 12)),
        ("cube with features", cube, edges),
    ]
}

/// A random operation at a random place; most are refused.
pub(crate) fn operation(q: &QuadMesh, kind: u8, place: u32, turns: u32) -> Op {
    let edge = place % (4 * q.quad_ids());
    match kind % 4 {
        0 => Op::Flip(Flip { edge, turn: Turn::Ccw }),
        1 => Op::Flip(Flip { edge, turn: Turn::Cw }),
        2 => Op::Collapse(Collapse { edge }),
        _ => {
            let mut last = edge;
            if q.is_quad_alive(edge / 4) {
                for _ in 0..2 + turns % 3 {
                    last = q.ccw(last);
                }
            }
            Op::Split(Split { first: edge, last })
        }
    }
}

/// Random numbers that are the same in every run (splitmix64).
#[derive(Debug, Clone)]
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    /// A number below `end`.
    pub(crate) fn below(&mut self, end: u32) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % u64::from(end)) as u32
    }
}

/// Makes `edits` random legal operations.
pub(crate) fn mess_up(q: &mut QuadMesh, dice: &mut Dice, edits: usize) {
    let mut done = 0;
    while done < edits {
        let op = operation(q, dice.below(4) as u8, dice.below(u32::MAX), dice.below(3));
        done += usize::from(op.run(q).is_ok());
    }
}

/// Everything that tells two states of Q apart.
pub(crate) fn fingerprint(q: &QuadMesh) -> String {
    let mut fresh = q.clone();
    fresh.commit();
    format!("{fresh:?}")
}

/// The places of all held vertices, bit for bit.
pub(crate) fn held_points(q: &QuadMesh) -> Vec<[u64; 3]> {
    let held = q.vertices().filter(|&v| q.is_held(v));
    let mut points: Vec<_> = held.map(|v| q.position(v).coords.map(f64::to_bits).into()).collect();
    // A pin gets a new id when its surroundings are refilled.
    points.sort_unstable();
    points
}

/// The ends of all edges on boundaries and features.
pub(crate) fn frozen_edges(q: &QuadMesh) -> Vec<[u32; 2]> {
    let frozen = q.quads().filter(|&e| q.is_frozen(e));
    frozen.map(|e| [q.origin(4 * e), q.origin(4 * e + 2)]).collect()
}

/// What no edit may change, and what holds at all times.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Invariants {
    chi: i64,
    held: Vec<[u64; 3]>,
    frozen: Vec<[u32; 2]>,
}

impl Invariants {
    /// Those of `q`, after every executable check has passed.
    pub(crate) fn of(q: &QuadMesh) -> Self {
        q.check().expect("a sound mesh");
        let chi = q.euler_characteristic();
        assert_eq!(q.index_sum(), 4 * chi, "equation 1");
        Self { chi, held: held_points(q), frozen: frozen_edges(q) }
    }
}
