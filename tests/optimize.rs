//! Geometry optimisation: better faces, the same connectivity, near the reference.

use quadmend::config::Config;
use quadmend::mesh::{MendPolicy, Point, PolyMesh, Vector, shapes};
use quadmend::optimize::{Goal, planarity};
use quadmend::pipeline::optimize::{Optimized, optimize};
use quadmend::watch::Silent;

/// A bowl over a grid; inner vertices shaken by up to `size`.
fn bowl(n: u32, size: f64) -> PolyMesh {
    let mut mesh = shapes::grid(n, n);
    let inner = |p: &Point| [p.x, p.y].iter().all(|&x| x > 0.0 && x < f64::from(n));
    let shake = |(v, p): (usize, &Point)| {
        let wave = |k: f64| if inner(p) { (v as f64 * k).sin() * size } else { 0.0 };
        let q = (p + Vector::new(wave(12.9), wave(78.2), 0.0)) * (8.0 / f64::from(n));
        Point::new(q.x, q.y, 0.05 * ((q.x - 4.0).powi(2) + (q.y - 4.0).powi(2)))
    };
    mesh.set_points(mesh.points().iter().enumerate().map(shake).collect());
    mesh
}

fn run(goal: Goal) -> (PolyMesh, Optimized) {
    let (mesh, reference) = (bowl(16, 0.3), bowl(64, 0.0));
    let config = Config::default();
    let done = optimize(mesh.clone(), Some(&reference), goal, MendPolicy::Strict, &config, &Silent);
    (mesh, done.unwrap())
}

#[test]
fn faces_become_planar_and_the_boundary_stays() {
    let (mesh, done) = run(Goal::Planar);
    let [before, after] = [done.report.before, done.report.after];
    assert!(
        after.fairness.planarity.mean < 0.3 * before.fairness.planarity.mean,
        "{before:?} {after:?}"
    );
    assert!(after.fairness.planarity.max < before.fairness.planarity.max);
    assert_eq!(done.mesh.corners(), mesh.corners(), "fixed connectivity");
    assert_eq!(done.report.held, 4 * 16);
    for (v, (p, q)) in mesh.points().iter().zip(done.mesh.points()).enumerate() {
        let rim = [v / 17, v % 17].iter().any(|i| i % 16 == 0);
        assert!(!rim || p == q, "the boundary is held to the bit");
    }
}

#[test]
fn angles_become_equal() {
    let (_, done) = run(Goal::Angles);
    let [before, after] =
        [done.report.before, done.report.after].map(|s| s.fairness.angle_deviation_deg);
    assert!(after.mean < 0.3 * before.mean && after.max < before.max, "{before:?} {after:?}");
}

#[test]
fn the_result_does_not_depend_on_threads() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(Goal::Planar).1.mesh)
    };
    assert_eq!(with(1), with(2));
}

#[test]
fn the_distance_keeps_to_the_budget() {
    let (mesh, reference) = (bowl(16, 0.3), bowl(64, 0.0));
    let config = Config::default()
        .with_assignment("optimize.rms_edges=0")
        .and_then(|c| c.with_assignment("optimize.hausdorff_edges=0"))
        .unwrap();
    let done = optimize(mesh, Some(&reference), Goal::Planar, MendPolicy::Strict, &config, &Silent)
        .unwrap();
    let [before, after] = [done.report.before, done.report.after];
    assert!(after.hausdorff_rel <= 1.02 * before.hausdorff_rel, "{before:?} {after:?}");
    assert!(after.rms_rel <= 1.02 * before.rms_rel, "{before:?} {after:?}");
}

#[test]
fn planarity_of_a_warped_square_is_the_distance_of_its_diagonals() {
    let h = 0.1;
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, h], [1.0, 1.0, 0.0], [0.0, 1.0, h]];
    let mesh = PolyMesh::new(corners.map(Point::from).to_vec(), [[0, 1, 2, 3]]).unwrap();
    assert!((planarity(&mesh, 0) - h / 2f64.sqrt()).abs() < 1e-12);
}
