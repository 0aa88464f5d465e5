//! Shapes for tests.

use crate::mesh::{Point, PolyMesh, Vector};

/// A closed box of `n` by `n` quads a side, bulged towards a ball by `round` (0 to 1).
pub(crate) fn cube(n: u32, round: f64, noise: f64) -> PolyMesh {
    let mut points: Vec<Point> = Vec::new();
    let mut ids = std::collections::BTreeMap::new();
    let mut faces = Vec::new();
    let mut vertex = |key: [u32; 3], points: &mut Vec<Point>| {
        *ids.entry(key).or_insert_with(|| {
            let p = Vector::from(key.map(|k| 2.0 * f64::from(k) / f64::from(n) - 1.0));
            let wave = (12.9 * p.x + 78.2 * p.y + 37.7 * p.z).sin() * 43758.5;
            let p = p.lerp(&p.normalize(), round) * (1.0 + noise * (wave - wave.floor()));
            points.push(Point::from(p));
            points.len() as u32 - 1
        })
    };
    for side in 0..6usize {
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut face = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(|[i, j]| {
                let mut key = [0; 3];
                key[side % 3] = if side < 3 { n } else { 0 };
                (key[(side + 1) % 3], key[(side + 2) % 3]) = (i, j);
                vertex(key, &mut points)
            });
            if side >= 3 {
                face.reverse();
            }
            faces.push(face);
        }
    }
    PolyMesh::new(points, faces).unwrap()
}

/// A flat square of `n` by `n` unit quads.
pub(crate) fn grid(n: u32) -> PolyMesh {
    let at = |i: u32, j: u32| i * (n + 1) + j;
    let pairs = |n: u32| (0..n).flat_map(move |i| (0..n).map(move |j| (i, j)));
    let points = pairs(n + 1).map(|(i, j)| Point::new(f64::from(i), f64::from(j), 0.0)).collect();
    let quad = |(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
    PolyMesh::new(points, pairs(n).map(quad)).unwrap()
}
