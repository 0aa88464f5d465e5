//! Closest points of a sphere of 108,000 triangles: from nothing, from the triangle of the
//! answer, and of one side only.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use quadmend::mesh::{Point, shapes};
use quadmend::surface::{Hit, Reference};

/// Points a little off the sphere, each with its closest point.
fn queries(surface: &Reference) -> Vec<(Point, Hit)> {
    let near = |p: &Point| p * 1.001;
    let points: Vec<Point> = shapes::sphere(13).points().iter().map(near).collect();
    let hits = surface.closest_many(&points);
    points.into_iter().zip(hits).collect()
}

fn closest(c: &mut Criterion) {
    let mesh = shapes::sphere(95);
    let surface = Reference::plain(&mesh).unwrap_or_else(|e| unreachable!("a sphere: {e}"));
    let queries = queries(&surface);
    let mut group = c.benchmark_group(format!("closest of {}", queries.len()));
    group.bench_function("cold", |b| {
        b.iter(|| queries.iter().map(|(p, _)| surface.closest(p).distance).sum::<f64>());
    });
    group.bench_function("warm", |b| {
        let warm = |(p, h): &(Point, Hit)| surface.closest_near(p, h.triangle).distance;
        b.iter(|| queries.iter().map(warm).sum::<f64>());
    });
    group.bench_function("facing", |b| {
        let facing = |(p, h): &(Point, Hit)| {
            surface.closest_facing(p, &surface.normal(h.triangle), h.triangle, 0.1).distance
        };
        b.iter(|| queries.iter().map(facing).sum::<f64>());
    });
    group.finish();
    c.bench_function("build", |b| b.iter(|| black_box(Reference::plain(&mesh))));
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = closest
}
criterion_main!(benches);
