//! Fillings of a disk whose rim has k corners and sides of given lengths.
//!
//! Three and five corners take one irregular element in the middle, with a spoke to each side:
//! `side[i] = spoke[i−1] + spoke[i+1]`. Integer spokes (even perimeter) meet in a vertex (v3, v5),
//! half-integer ones (odd perimeter) in a face (f3, f5); a pure-quad mesher has to refuse those.
//! Four corners with equal opposite sides are a grid. Two, six, and four that do not close are cut
//! by a chord into two of the former.
//!
//! ```text
//!    corner i+1 ─── side i ─── foot of spoke i ─── corner i
//!        │                         │                  │
//!        │        block i+1        │ L_i    block i   │ side i−1
//!        └───────── L_{i+1} ─── centre ─── L_{i−1} ───┘
//! ```

use serde::{Deserialize, Serialize};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A polygonal disk: rim vertices 0…n−1 in order, then new ones.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Filling {
    /// Number of rim vertices.
    pub rim: u32,
    /// Number of new vertices.
    pub interior: u32,
    /// Where the corners of each face begin; one entry more than there are faces.
    pub offsets: Vec<u32>,
    /// The vertices of the faces, counter-clockwise.
    pub corners: Vec<u32>,
}

impl Filling {
    fn new(rim: u32) -> Self {
        Self { rim, interior: 0, offsets: vec![0], corners: Vec::new() }
    }

    fn vertex(&mut self) -> u32 {
        self.interior += 1;
        self.rim + self.interior - 1
    }

    fn face(&mut self, corners: impl IntoIterator<Item = u32>) {
        self.corners.extend(corners);
        self.offsets.push(self.corners.len() as u32);
    }

    /// Number of faces.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Σ |4 − valence| over new vertices and Σ |4 − degree| over faces. O(corners).
    #[must_use]
    pub fn irregularity(&self) -> u32 {
        let mut valence = vec![0u32; self.interior as usize];
        for &v in self.corners.iter().filter(|&&v| v >= self.rim) {
            valence[(v - self.rim) as usize] += 1;
        }
        let vertices: u32 = valence.iter().map(|n| n.abs_diff(4)).sum();
        vertices + self.faces().map(|f| (f.len() as u32).abs_diff(4)).sum::<u32>()
    }

    /// Number of faces that are no quads.
    #[must_use]
    pub fn irregular_faces(&self) -> usize {
        self.faces().filter(|f| f.len() != 4).count()
    }

    /// The faces, each as its vertices.
    #[must_use]
    pub fn faces(&self) -> impl ExactSizeIterator<Item = &[u32]> + '_ {
        self.offsets.windows(2).map(|w| &self.corners[w[0] as usize..w[1] as usize])
    }
}

/// The lengths of the sides of a polygon.
type Sides = smallvec::SmallVec<[u32; 6]>;

/// A polygon to fill: its rim, and which of the rim vertices are corners (sorted positions).
#[derive(Debug, Clone)]
struct Polygon {
    rim: Vec<u32>,
    corners: Vec<usize>,
}

impl Polygon {
    fn sides(&self) -> Sides {
        let (k, n) = (self.corners.len(), self.rim.len());
        (0..k)
            .map(|i| ((self.corners[(i + 1) % k] + n - self.corners[i] - 1) % n + 1) as u32)
            .collect()
    }

    /// Rim vertex at `offset` from corner `i`, in either direction.
    fn at(&self, i: usize, offset: i64) -> u32 {
        let n = self.rim.len() as i64;
        self.rim[(self.corners[i] as i64 + offset).rem_euclid(n) as usize]
    }
}

/// The few best fillings of a rim of `n` vertices with corners at the given positions, the most
/// evenly proportioned first; none if no template fits. O(n²) for the chords tried.
#[must_use]
pub fn fillings(n: usize, corners: &[usize], most: usize) -> Vec<Filling> {
    let whole = Polygon { rim: (0..n as u32).collect(), corners: corners.to_vec() };
    let simple = |polygon: &Polygon| {
        let mut filling = Filling::new(n as u32);
        fill(polygon, &mut filling).map(|()| filling)
    };
    match corners.len() {
        3..=5 if is_simple(&whole.sides()) => simple(&whole).into_iter().collect(),
        4 if one_edge_apart(&whole.sides()) => dislocated(&whole, n as u32, most),
        2 | 4 | 6 => chords(&whole, most)
            .into_iter()
            .filter_map(|chord| {
                let mut filling = Filling::new(n as u32);
                let parts = split(&whole, chord, &mut filling);
                parts.iter().try_for_each(|part| fill(part, &mut filling))?;
                Some(filling)
            })
            .collect(),
        _ => Vec::new(),
    }
}

/// Spokes of three or five.
type Spokes = smallvec::SmallVec<[u32; 5]>;

/// Twice the spoke lengths; `None` unless all are positive.
fn double_spokes(sides: &[u32]) -> Option<Spokes> {
    let length = |own: i64| u32::try_from(own).ok().filter(|&l| l > 0);
    match *sides {
        [a, b, c] => {
            let [a, b, c] = [a, b, c].map(i64::from);
            [b + c - a, c + a - b, a + b - c].into_iter().map(length).collect()
        }
        [a, b, c, d, e] => {
            let sides = [a, b, c, d, e].map(i64::from);
            let total: i64 = sides.iter().sum();
            (0..5).map(|i| length(total - 2 * (sides[(i + 2) % 5] + sides[(i + 3) % 5]))).collect()
        }
        _ => None,
    }
}

fn is_simple(sides: &[u32]) -> bool {
    match sides {
        [a, b, c, d] => a == c && b == d,
        _ => double_spokes(sides).is_some(),
    }
}

fn fill(polygon: &Polygon, filling: &mut Filling) -> Option<()> {
    let sides = polygon.sides();
    if let [a, b, c, d] = sides[..] {
        return (a == c && b == d).then(|| grid(polygon, a, b, filling));
    }
    let doubled = double_spokes(&sides)?;
    if doubled[0] % 2 == 0 {
        around_vertex(polygon, &doubled.iter().map(|l| l / 2).collect::<Vec<_>>(), filling);
    } else {
        around_face(polygon, &doubled.iter().map(|l| l / 2).collect::<Vec<_>>(), filling);
    }
    Some(())
}

fn grid(polygon: &Polygon, columns: u32, rows: u32, filling: &mut Filling) {
    let mut ids = vec![0; ((columns + 1) * (rows + 1)) as usize];
    let at = |u: u32, v: u32| (v * (columns + 1) + u) as usize;
    for v in 0..=rows {
        for u in 0..=columns {
            ids[at(u, v)] = match (u, v) {
                (u, 0) => polygon.at(0, i64::from(u)),
                (0, v) => polygon.at(0, -i64::from(v)),
                (u, v) if u == columns => polygon.at(1, i64::from(v)),
                (u, v) if v == rows => polygon.at(3, -i64::from(u)),
                _ => filling.vertex(),
            };
        }
    }
    for v in 0..rows {
        for u in 0..columns {
            filling
                .face([(u, v), (u + 1, v), (u + 1, v + 1), (u, v + 1)].map(|(u, v)| ids[at(u, v)]));
        }
    }
}

/// Whether opposite sides differ by one edge in one direction only: a Burgers vector (±1, 0).
fn one_edge_apart(sides: &[u32]) -> bool {
    sides[0].abs_diff(sides[2]) + sides[1].abs_diff(sides[3]) == 1
}

/// Grids in which one column begins inside: at a face (f3–v5, a dual T-junction) or at a hanging
/// vertex (v3–f5, a T-junction). No chord separates such a pair.
fn dislocated(polygon: &Polygon, n: u32, most: usize) -> Vec<Filling> {
    let sides = polygon.sides();
    let Some(bottom) = (0..4).find(|&i| sides[i] + 1 == sides[(i + 2) % 4]) else {
        return Vec::new();
    };
    let corners = (0..4).map(|i| polygon.corners[(bottom + i) % 4]).collect();
    let turned = Polygon { rim: polygon.rim.clone(), corners };
    let (columns, rows) = (sides[bottom], sides[(bottom + 1) % 4]);
    // The middle first, then a quarter off it either way.
    let spread = |size: u32| [size / 2, size / 4, size - size / 4];
    let places = spread(columns).into_iter().zip(spread(rows));
    let kinds = places.flat_map(|(at, level)| [(at, level, true), (at, level, false)]);
    let fits = kinds.filter(|&(at, level, dual)| {
        (1..rows).contains(&level) && if dual { (1..columns).contains(&at) } else { at < columns }
    });
    let all =
        fits.map(|(at, level, dual)| column_begins(&turned, n, (columns, rows), (at, level, dual)));
    all.take(most).collect()
}

/// A grid with `columns` columns below `level` and one more above. A T-junction hangs in the
/// upper side of cell `at` of the row below; a dual one is a triangle on vertex `at` of the level.
fn column_begins(
    polygon: &Polygon,
    n: u32,
    (columns, rows): (u32, u32),
    (at, level, dual): (u32, u32, bool),
) -> Filling {
    let mut filling = Filling::new(n);
    let first_wide = if dual { level + 1 } else { level };
    let widths: Vec<u32> = (0..=rows).map(|v| columns + u32::from(v >= first_wide)).collect();
    let ids: Vec<Vec<u32>> = (0..=rows)
        .map(|v| {
            let width = widths[v as usize];
            let place = |u| match (u, v) {
                (u, 0) => polygon.at(0, i64::from(u)),
                (0, v) => polygon.at(0, -i64::from(v)),
                (u, v) if u == width => polygon.at(1, i64::from(v)),
                (u, v) if v == rows => polygon.at(3, -i64::from(u)),
                _ => filling.vertex(),
            };
            (0..=width).map(place).collect()
        })
        .collect();
    for v in 0..rows as usize {
        let (low, high) = (&ids[v], &ids[v + 1]);
        let widens = low.len() < high.len();
        for u in 0..columns.min(widths[v]) as usize + usize::from(!widens && widths[v] > columns) {
            // Above the place where the new column begins, the upper level is one ahead.
            let shift = usize::from(widens && u >= at as usize + usize::from(!dual));
            if widens && dual && u == at as usize {
                filling.face([low[u], high[u + 1], high[u]]);
            }
            if widens && !dual && u == at as usize {
                filling.face([low[u], low[u + 1], high[u + 2], high[u + 1], high[u]]);
            } else {
                filling.face([low[u], low[u + 1], high[u + 1 + shift], high[u + shift]]);
            }
        }
    }
    filling
}

/// Vertices of the block at corner `i`: `width` + 1 along side i, `height` + 1 along side i−1.
struct Block {
    width: u32,
    ids: Vec<u32>,
}

impl Block {
    fn new(
        polygon: &Polygon,
        i: usize,
        width: u32,
        height: u32,
        mut inside: impl FnMut(u32, u32) -> u32,
    ) -> Self {
        let mut ids = Vec::with_capacity(((width + 1) * (height + 1)) as usize);
        for v in 0..=height {
            for u in 0..=width {
                ids.push(match (u, v) {
                    (u, 0) => polygon.at(i, i64::from(u)),
                    (0, v) => polygon.at(i, -i64::from(v)),
                    _ => inside(u, v),
                });
            }
        }
        Self { width, ids }
    }

    fn at(&self, u: u32, v: u32) -> u32 {
        self.ids[(v * (self.width + 1) + u) as usize]
    }

    fn quads(&self, filling: &mut Filling) {
        let height = self.ids.len() as u32 / (self.width + 1) - 1;
        for v in 0..height {
            for u in 0..self.width {
                filling.face(
                    [(u, v), (u + 1, v), (u + 1, v + 1), (u, v + 1)].map(|(u, v)| self.at(u, v)),
                );
            }
        }
    }
}

/// Integer spokes: neighbouring blocks share the vertices of the spoke between them.
fn around_vertex(polygon: &Polygon, spokes: &[u32], filling: &mut Filling) {
    let k = spokes.len();
    let centre = filling.vertex();
    let inner: Vec<Vec<u32>> =
        spokes.iter().map(|&l| (1..l).map(|_| filling.vertex()).collect()).collect();
    for i in 0..k {
        let before = (i + k - 1) % k;
        let (width, height) = (spokes[before], spokes[i]);
        let block = Block::new(polygon, i, width, height, |u, v| match (u, v) {
            (u, v) if u == width && v == height => centre,
            (u, v) if u == width => inner[i][v as usize - 1],
            (u, v) if v == height => inner[before][u as usize - 1],
            _ => filling.vertex(),
        });
        block.quads(filling);
    }
}

/// Half-integer spokes, given rounded down: neighbouring blocks are joined by a strip of quads,
/// and the inmost corners of all blocks are the face in the middle.
fn around_face(polygon: &Polygon, spokes: &[u32], filling: &mut Filling) {
    let k = spokes.len();
    let blocks: Vec<Block> = (0..k)
        .map(|i| {
            Block::new(polygon, i, spokes[(i + k - 1) % k], spokes[i], |_, _| filling.vertex())
        })
        .collect();
    for i in 0..k {
        let (here, there) = (&blocks[i], &blocks[(i + 1) % k]);
        here.quads(filling);
        let (width, height) = (here.width, spokes[(i + 1) % k]);
        for t in 0..spokes[i] {
            filling.face([
                here.at(width, t),
                there.at(t, height),
                there.at(t + 1, height),
                here.at(width, t + 1),
            ]);
        }
    }
    filling.face((0..k).map(|i| blocks[i].at(blocks[i].width, spokes[i])));
}

/// A cut from `start` on side `from` to `end` on side `to`, both counted from the start of the
/// side, with `length` edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Chord {
    from: usize,
    start: u32,
    to: usize,
    end: u32,
    length: u32,
}

impl Chord {
    /// Side lengths of the part on the left of the chord's way back, and of the part on the other.
    fn parts(&self, sides: &[u32]) -> [Sides; 2] {
        let k = sides.len();
        let walk = |from: usize, start: u32, to: usize, end: u32| {
            let mut lengths = Sides::from_slice(&[sides[from] - start]);
            let mut i = (from + 1) % k;
            while i != to {
                lengths.push(sides[i]);
                i = (i + 1) % k;
            }
            lengths.push(end);
            lengths.push(self.length);
            lengths
        };
        [
            walk(self.from, self.start, self.to, self.end),
            walk(self.to, self.end, self.from, self.start),
        ]
    }
}

/// The best chords: both parts must be simple, and the more even their spokes, the better.
fn chords(polygon: &Polygon, most: usize) -> Vec<Chord> {
    let sides = polygon.sides();
    let k = sides.len();
    let pairs: Vec<(usize, usize)> = match k {
        2 => vec![(0, 1)],
        4 => (0..4).map(|i| (i, (i + 1) % 4)).collect(),
        _ => (0..3).map(|i| (i, i + 3)).collect(),
    };
    let mut scored = Vec::new();
    for (from, to) in pairs {
        for start in (1..sides[from]).step_by(stride(sides[from])) {
            for end in (1..sides[to]).step_by(stride(sides[to])) {
                let mut parts = Chord { from, start, to, end, length: 0 }.parts(&sides);
                for length in lengths(&parts) {
                    parts
                        .iter_mut()
                        .filter_map(|part| part.last_mut())
                        .for_each(|last| *last = length);
                    if let [Some(a), Some(b)] = spokes(&parts) {
                        let chord = Chord { from, start, to, end, length };
                        // Of numbers that are not negative the bits are in the same order.
                        scored.push(Reverse((imbalance(&a, &b, length).to_bits(), chord)));
                    }
                }
            }
        }
    }
    // Of thousands only the first few are looked at.
    let mut best = BinaryHeap::from(scored);
    let in_order = std::iter::from_fn(|| best.pop().map(|Reverse((_, chord))| chord));
    distinct(in_order, polygon, &sides, most)
}

/// Long sides are tried at some twenty places only.
fn stride(side: u32) -> usize {
    (side as usize / 20).max(1)
}

/// The lengths of the chord, whose place in `parts` is the last, for which both parts can have
/// positive spokes: in a triangle less than the sum of the other sides and more than their
/// difference, and likewise in a pentagon.
fn lengths(parts: &[Sides; 2]) -> std::ops::Range<u32> {
    let (mut least, mut most) = (1, u32::MAX);
    for part in parts {
        let a = |i: usize| i64::from(part[i]);
        let (low, high) = if part.len() == 3 {
            ((a(0) - a(1)).abs() + 1, a(0) + a(1))
        } else {
            // Spokes 1 and 2 shrink with the length of side 4, the others grow.
            let high = (a(1) + a(2) + a(0) - a(3)).min(a(2) + a(3) + a(1) - a(0));
            let low =
                [a(1) + a(2) - a(0) - a(3), a(1) + a(0) - a(3) - a(2), a(2) + a(3) - a(0) - a(1)];
            (low.into_iter().max().unwrap_or(0) + 1, high)
        };
        (least, most) = (least.max(low.max(1) as u32), most.min(high.max(1) as u32));
    }
    least..most
}

/// Twice the spokes of both parts; `None` for one that has none.
fn spokes(parts: &[Sides; 2]) -> [Option<Spokes>; 2] {
    let [a, b] = parts;
    [double_spokes(a), double_spokes(b)]
}

/// How uneven a pair of parts is: the mean squared deviation of the spokes from their mean, plus
/// a little for long chords.
fn imbalance(a: &[u32], b: &[u32], length: u32) -> f64 {
    let spread = |l: &[u32]| {
        let mean = f64::from(l.iter().sum::<u32>()) / l.len() as f64;
        l.iter().map(|&x| (f64::from(x) - mean).powi(2)).sum::<f64>() / l.len() as f64
    };
    spread(a) + spread(b) + 0.01 * f64::from(length)
}

/// Where the spokes of the two elements that a chord separates meet the rim, in half edges from
/// its start: the same for all chords that cut the same filling, and near for near ones.
type Feet = smallvec::SmallVec<[u32; 8]>;

fn feet(polygon: &Polygon, chord: Chord, spokes: [&[u32]; 2]) -> Feet {
    let (k, turn) = (polygon.corners.len(), 2 * polygon.rim.len() as u32);
    let part = |from: usize, start: u32, spokes: &[u32]| {
        let mut feet: Feet = (0..spokes.len() - 1)
            .map(|i| {
                let begins =
                    polygon.corners[(from + i) % k] as u32 + if i == 0 { start } else { 0 };
                (2 * begins + spokes[(i + spokes.len() - 1) % spokes.len()]) % turn
            })
            .collect();
        feet.sort_unstable();
        feet
    };
    let mut both = [part(chord.from, chord.start, spokes[0]), part(chord.to, chord.end, spokes[1])];
    both.sort();
    both.into_iter().flatten().collect()
}

/// The first few whose spokes meet the rim at clearly different places.
fn distinct(
    chords: impl Iterator<Item = Chord>,
    polygon: &Polygon,
    sides: &[u32],
    most: usize,
) -> Vec<Chord> {
    let turn = 2 * polygon.rim.len() as u32;
    let apart = |a: u32, b: u32| a.abs_diff(b).min(turn - a.abs_diff(b));
    let clear = (turn / 32).max(2);
    let differs = |a: &Feet, b: &Feet| {
        a.len() != b.len() || a.iter().zip(b).any(|(&a, &b)| apart(a, b) >= clear)
    };
    let mut chosen: Vec<(Chord, Feet)> = Vec::new();
    for chord in chords {
        if chosen.len() == most {
            break;
        }
        let [Some(a), Some(b)] = spokes(&chord.parts(sides)) else { continue };
        let feet = feet(polygon, chord, [&a, &b]);
        if chosen.iter().all(|(_, other)| differs(other, &feet)) {
            chosen.push((chord, feet));
        }
    }
    chosen.into_iter().map(|(chord, _)| chord).collect()
}

/// Cuts a polygon along a chord, whose inner vertices are new.
fn split(polygon: &Polygon, chord: Chord, filling: &mut Filling) -> [Polygon; 2] {
    let n = polygon.rim.len();
    let a = (polygon.corners[chord.from] + chord.start as usize) % n;
    let b = (polygon.corners[chord.to] + chord.end as usize) % n;
    let inner: Vec<u32> = (1..chord.length).map(|_| filling.vertex()).collect();
    let part = |from: usize, to: usize, way_back: Vec<u32>| {
        let mut positions = vec![from];
        while positions.last() != Some(&to) {
            positions.push((positions[positions.len() - 1] + 1) % n);
        }
        let corners = (0..positions.len())
            .filter(|&i| {
                i == 0 || i + 1 == positions.len() || polygon.corners.contains(&positions[i])
            })
            .collect();
        let rim = positions.iter().map(|&p| polygon.rim[p]).chain(way_back).collect();
        Polygon { rim, corners }
    };
    let reversed = inner.iter().rev().copied().collect();
    [part(a, b, reversed), part(b, a, inner)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Irregularity inside a filling: new vertices and all faces; checks that it is a disk.
    fn irregularity(filling: &Filling) -> u32 {
        let mut edges = BTreeMap::<(u32, u32), u32>::new();
        for face in filling.faces() {
            for (i, &a) in face.iter().enumerate() {
                let b = face[(i + 1) % face.len()];
                assert_ne!(a, b);
                assert!(edges.insert((a, b), 1).is_none(), "edge {a}-{b} twice the same way");
            }
        }
        let rim_edges =
            (0..filling.rim).filter(|&i| edges.contains_key(&(i, (i + 1) % filling.rim))).count();
        assert_eq!(rim_edges, filling.rim as usize, "the rim is whole");
        let open = edges.keys().filter(|&&(a, b)| !edges.contains_key(&(b, a))).count();
        assert_eq!(open, filling.rim as usize, "only the rim is open");
        let (v, e, f) = (
            i64::from(filling.rim + filling.interior),
            (edges.len() as i64).midpoint(i64::from(filling.rim)),
            filling.face_count() as i64,
        );
        assert_eq!(v - e + f, 1, "a disk");
        filling.irregularity()
    }

    fn rim(sides: &[u32]) -> (usize, Vec<usize>) {
        let starts = sides.iter().scan(0, |at, &s| {
            let start = *at;
            *at += s as usize;
            Some(start)
        });
        (sides.iter().sum::<u32>() as usize, starts.collect())
    }

    fn best(sides: &[u32]) -> Option<Filling> {
        let (n, corners) = rim(sides);
        fillings(n, &corners, 3).into_iter().next()
    }

    #[test]
    fn a_rectangle_that_closes_is_regular() {
        for sides in [[1, 1, 1, 1], [3, 5, 3, 5], [7, 2, 7, 2]] {
            assert_eq!(irregularity(&best(&sides).unwrap()), 0, "{sides:?}");
        }
    }

    #[test]
    fn three_and_five_corners_take_one_element_of_either_parity() {
        for sides in [
            &[1, 1, 1][..],
            &[2, 2, 2],
            &[3, 4, 5],
            &[3, 4, 4],
            &[1, 1, 1, 1, 1],
            &[2, 2, 2, 2, 2],
            &[3, 3, 3, 2, 2],
            &[2, 3, 3, 2, 3],
        ] {
            let filling = best(sides).unwrap_or_else(|| panic!("{sides:?}"));
            assert_eq!(irregularity(&filling), 1, "{sides:?}");
            let odd = sides.iter().sum::<u32>() % 2 == 1;
            let by_face = filling.faces().any(|f| f.len() != 4);
            assert_eq!(odd, by_face, "{sides:?}: an odd perimeter takes a face");
        }
    }

    #[test]
    fn rectangles_that_do_not_close_two_and_six_corners_take_two() {
        for sides in
            [&[4, 5, 5, 5][..], &[4, 4, 6, 5], &[6, 6], &[3, 3, 3, 3, 3, 3], &[4, 3, 4, 4, 3, 5]]
        {
            let (n, corners) = rim(sides);
            let all = fillings(n, &corners, 3);
            assert!(!all.is_empty(), "{sides:?}");
            for filling in all {
                assert_eq!(irregularity(&filling), 2, "{sides:?}");
            }
        }
    }

    #[test]
    fn sides_that_no_template_fits_are_refused() {
        assert!(best(&[1, 1, 2]).is_none());
        assert!(best(&[1, 1, 9]).is_none());
    }
}
