//! Meshes in the √CC domain for property tests: samples, random operations, and what must not
//! change.

use fixedbitset::FixedBitSet;
use quadmend::mesh::{Point, PolyMesh, Topology, shapes};
use quadmend::ops::{Collapse, Flip, Op, Split, Turn};
use quadmend::patch::fillings;
use quadmend::sqrtcc::{QuadKind, QuadMesh, lift};

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

/// The connectivity of Q as seen from a half-edge, whatever the numbers, as a hash: for each
/// half-edge in the order in which a search meets it, the place of its twin in that order.
pub(crate) fn code_from(q: &QuadMesh, start: u32) -> u64 {
    let mut place = vec![u32::MAX; 4 * q.quad_ids() as usize];
    let mut order: Vec<u32> = Vec::new();
    let mut meet = |h: u32, order: &mut Vec<u32>| {
        if place[h as usize] == u32::MAX {
            // The whole quad at once, from the corner where it is met.
            for e in [h, QuadMesh::next(h), QuadMesh::opposite(h), QuadMesh::prev(h)] {
                place[e as usize] = order.len() as u32;
                order.push(e);
            }
        }
        place[h as usize]
    };
    meet(start, &mut order);
    let (mut code, mut at) = (0_u64, 0);
    while at < order.len() {
        let twin = meet(q.twin(order[at]), &mut order);
        code = (code ^ u64::from(twin)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23);
        at += 1;
    }
    code
}

/// A disk with corners between sides of so many edges, and the fewest irregular elements inside
/// that these allow: its √CC mesh, and a half-edge on its rim.
pub(crate) fn disk(sides: &[u32]) -> Option<(QuadMesh, u32)> {
    let rim: u32 = sides.iter().sum();
    let corners: Vec<usize> = sides
        .iter()
        .scan(0, |at, &side| {
            let corner = *at;
            *at += side as usize;
            Some(corner)
        })
        .collect();
    let filling = fillings(rim as usize, &corners, 1).into_iter().next()?;
    let turn = std::f64::consts::TAU / f64::from(rim);
    let points = (0..rim + filling.interior).map(|v| {
        let (angle, radius) = (turn * f64::from(v), if v < rim { 1.0 } else { 0.0 });
        Point::new(radius * angle.cos(), radius * angle.sin(), 0.0)
    });
    let mesh = PolyMesh::new(points.collect(), filling.faces()).expect("a filling is a mesh");
    let q = lifted(&mesh);
    let rim = (0..4 * q.quad_ids()).find(|&h| q.kind(h / 4) == QuadKind::Boundary)?;
    Some((q, rim))
}

/// A polygonal disk with four sides, each a list of vertices from corner to corner, all in one
/// turn: bottom, right, top, left.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    pub(crate) vertices: u32,
    pub(crate) faces: Vec<Vec<u32>>,
    pub(crate) sides: [Vec<u32>; 4],
    /// The hanging vertices.
    pub(crate) hanging: Vec<u32>,
}

impl Block {
    /// A rectangle, `width` edges at the bottom and one more at the top: a T-junction whose stem
    /// points up hangs in row `row` (from 1 to `height` − 1), column `column`.
    pub(crate) fn with_t_junction(width: u32, height: u32, column: u32, row: u32) -> Self {
        let mut lines: Vec<Vec<u32>> = Vec::new();
        let mut vertices = 0;
        for line in 0..=height {
            let count = width + 1 + u32::from(line >= row);
            lines.push((vertices..vertices + count).collect());
            vertices += count;
        }
        let mut faces = Vec::new();
        for pair in lines.windows(2) {
            let (low, high) = (&pair[0], &pair[1]);
            let extra = (high.len() - low.len()) as u32;
            for c in 0..low.len() - 1 {
                let before = c + usize::from(extra == 1 && c as u32 > column);
                let after = c + 1 + usize::from(extra == 1 && c as u32 >= column);
                let mut face = vec![low[c], low[c + 1]];
                face.extend(high[before..=after].iter().rev());
                faces.push(face);
            }
        }
        let turned = |side: Vec<u32>| side.into_iter().rev().collect();
        let last = |line: &Vec<u32>| line[line.len() - 1];
        let sides = [
            lines[0].clone(),
            lines.iter().map(last).collect(),
            turned(lines[height as usize].clone()),
            turned(lines.iter().map(|l| l[0]).collect()),
        ];
        let hanging = vec![lines[row as usize][column as usize + 1]];
        Self { vertices, faces, sides, hanging }
    }

    /// Turned counter-clockwise by quarters.
    pub(crate) fn turned(mut self, quarters: usize) -> Self {
        self.sides.rotate_right(quarters);
        self
    }

    /// The edges of each side.
    pub(crate) fn lengths(&self) -> [usize; 4] {
        self.sides.each_ref().map(|side| side.len() - 1)
    }

    /// Glued at its right side to the left side of another one, which is as long.
    pub(crate) fn beside(mut self, other: &Self) -> Self {
        let mut number: Vec<u32> = vec![u32::MAX; other.vertices as usize];
        for (&mine, &theirs) in self.sides[1].iter().rev().zip(&other.sides[3]) {
            number[theirs as usize] = mine;
        }
        for n in number.iter_mut().filter(|n| **n == u32::MAX) {
            *n = self.vertices;
            self.vertices += 1;
        }
        let new = |v: &u32| number[*v as usize];
        self.faces.extend(other.faces.iter().map(|face| face.iter().map(new).collect()));
        self.hanging.extend(other.hanging.iter().map(new));
        self.sides[0].extend(other.sides[0][1..].iter().map(new));
        self.sides[1] = other.sides[1].iter().map(new).collect();
        let mut top: Vec<u32> = other.sides[2].iter().map(new).collect();
        top.extend(&self.sides[2][1..]);
        self.sides[2] = top;
        self
    }

    /// Its √CC mesh, and the half-edge from the corner bottom left to the face there.
    pub(crate) fn lifted(&self) -> (QuadMesh, u32) {
        let point = |v: u32| Point::new(f64::from(v), f64::from(v % 7), 0.0);
        let points = (0..self.vertices).map(point).collect();
        let q = lifted(&PolyMesh::new(points, &self.faces).expect("blocks are meshes"));
        let corner = self.sides[0][0];
        let h = q.outgoing(corner).find(|&h| !q.is_ghost(q.target(h))).expect("it has a face");
        (q, h)
    }
}
