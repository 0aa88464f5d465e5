//! Relaxing a region as the judge of edits does, and smoothing a sphere of 20,000 quads.

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use quadmend::mesh::{Point, PolyMesh, Vector, shapes};
use quadmend::smooth::{Orientation, Region, RelaxOptions, SmoothOptions, relax_local, smooth};
use quadmend::surface::Reference;
use quadmend::watch::Silent;

/// Quads on a side of the square patch: 169 vertices, 121 of them free.
const SIDE: u32 = 12;

fn reference() -> Reference {
    let mesh = shapes::sphere(95);
    Reference::plain(&mesh).unwrap_or_else(|e| unreachable!("a sphere: {e}"))
}

/// The same small move of a vertex every time.
fn shake(v: u32, size: f64) -> Vector {
    let wave = |k: f64| (f64::from(v) * k).sin() * size;
    Vector::new(wave(12.9), wave(78.2), wave(37.7))
}

/// A patch of the sphere, shaken; each vertex with whether it is held and a triangle near it.
fn patch(surface: &Reference) -> Vec<(Point, bool, u32)> {
    let vertex = |(v, p): (u32, &Point)| {
        let (i, j) = (v % (SIDE + 1), v / (SIDE + 1));
        let held = i % SIDE == 0 || j % SIDE == 0;
        let on = Point::from(Vector::new(p.x - 6.0, p.y - 6.0, 40.0).normalize());
        let triangle = surface.closest(&on).triangle;
        (if held { on } else { on + shake(v, 0.008) }, held, triangle)
    };
    (0..).zip(shapes::grid(SIDE, SIDE).points()).map(vertex).collect()
}

fn relax(c: &mut Criterion) {
    let (surface, faces) = (reference(), shapes::grid(SIDE, SIDE));
    let (patch, options) = (patch(&surface), RelaxOptions::default());
    let mut region = Region::new();
    c.bench_function("relax 169 vertices 24 times", |b| {
        b.iter(|| {
            region.begin(Orientation::Along);
            for &(p, held, triangle) in &patch {
                region.add_vertex(p, held, Some(triangle));
            }
            faces.faces().for_each(|f| region.add_face(f));
            relax_local(&mut region, (&surface, None), &options, 8);
            relax_local(&mut region, (&surface, None), &options, 16)
        });
    });
}

fn shaken(mut mesh: PolyMesh) -> PolyMesh {
    let points = (0..).zip(mesh.points()).map(|(v, p)| p + shake(v, 0.005)).collect();
    mesh.set_points(points);
    mesh
}

fn whole(c: &mut Criterion) {
    let (surface, mesh) = (reference(), shaken(shapes::sphere(58)));
    let held = vec![false; mesh.vertex_count()];
    let smoothing = SmoothOptions { iterations: 24, ..SmoothOptions::default() };
    let options = (&smoothing, &RelaxOptions::default());
    c.bench_function("smooth 20,184 quads 24 times", |b| {
        b.iter_batched(
            || mesh.clone(),
            |mesh| smooth(&mesh, &held, &surface, options, None, &Silent),
            BatchSize::PerIteration,
        );
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = relax, whole
}
criterion_main!(benches);
