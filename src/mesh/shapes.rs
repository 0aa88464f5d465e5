//! Regular meshes of simple surfaces: material for tests, benches and examples.

use super::{Point, PolyMesh};
use std::f64::consts::TAU;

/// A flat rectangle of `columns` × `rows` unit quads.
#[must_use]
pub fn grid(columns: u32, rows: u32) -> PolyMesh {
    let at = |i: u32, j: u32| j * (columns + 1) + i;
    let points = cells(columns + 1, rows + 1)
        .map(|(i, j)| Point::new(f64::from(i), f64::from(j), 0.0))
        .collect();
    let faces =
        cells(columns, rows).map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    build(points, faces)
}

/// A torus (radii 3 and 1) of `columns` quads around the axis and `rows` around the tube.
#[must_use]
pub fn torus(columns: u32, rows: u32) -> PolyMesh {
    let at = |i: u32, j: u32| (j % rows) * columns + i % columns;
    let points = cells(columns, rows)
        .map(|(i, j)| {
            let (u, v) =
                (TAU * f64::from(i) / f64::from(columns), TAU * f64::from(j) / f64::from(rows));
            Point::new((3.0 + v.cos()) * u.cos(), (3.0 + v.cos()) * u.sin(), v.sin())
        })
        .collect();
    let faces =
        cells(columns, rows).map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    build(points, faces)
}

/// The surface of the cube [−1, 1]³ with `n` × `n` quads on each side.
#[must_use]
pub fn cube(n: u32) -> PolyMesh {
    let mut numbers = std::collections::BTreeMap::new();
    let mut points = Vec::new();
    let mut faces = Vec::new();
    for axis in 0..3 {
        for side in [0, n] {
            let mut corner = |i: u32, j: u32| {
                let mut at = [0; 3];
                (at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]) = (side, i, j);
                *numbers.entry(at).or_insert_with(|| {
                    points.push(Point::from(at.map(|x| 2.0 * f64::from(x) / f64::from(n) - 1.0)));
                    points.len() as u32 - 1
                })
            };
            for (i, j) in cells(n, n) {
                let mut face =
                    [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
                if side == 0 {
                    face.reverse();
                }
                faces.push(face);
            }
        }
    }
    build(points, faces)
}

/// The unit sphere as an inflated [`cube`].
#[must_use]
pub fn sphere(n: u32) -> PolyMesh {
    let mut mesh = cube(n);
    let points = mesh.points().iter().map(|p| Point::from(p.coords.normalize())).collect();
    mesh.set_points(points);
    mesh
}

fn cells(columns: u32, rows: u32) -> impl Iterator<Item = (u32, u32)> {
    (0..rows).flat_map(move |j| (0..columns).map(move |i| (i, j)))
}

fn build(points: Vec<Point>, faces: impl IntoIterator<Item = [u32; 4]>) -> PolyMesh {
    PolyMesh::new(points, faces).unwrap_or_else(|e| unreachable!("shapes are meshes: {e}"))
}
