//! The designs of Figures 9, 10 and 11: one surface, several connectivities, compared in
//! planarity and angles after optimisation.

mod common;

use common::lifted::{lifted, no_features};
use common::{data_folder, say};
use quadmend::config::Config;
use quadmend::io;
use quadmend::mesh::{MendPolicy, Point, PolyMesh, Topology, check, mend, shapes};
use quadmend::metrics::matched_t_junctions;
use quadmend::moves::dipole::STEPS;
use quadmend::moves::pure::{Kind, convert};
use quadmend::moves::t_junction::{self, Direction};
use quadmend::moves::{Dipole, regularize};
use quadmend::ops::{Flip, Op, Split, Turn, around};
use quadmend::optimize::{Fairness, Goal};
use quadmend::pipeline::optimize::optimize;
use quadmend::pipeline::pure_quad::pure_quad;
use quadmend::planner::cost::CostOptions;
use quadmend::planner::movement::MovementGraph;
use quadmend::sqrtcc::{QuadMesh, Vertex, lift, lower};
use quadmend::surface::{Reference, mesh_features};
use quadmend::views::catmull_clark;
use quadmend::watch::Silent;

/// An eight-cornered roof: a square block with a block at each side and two at each corner, so
/// that four vertices have five edges; refined, and bent to a dome.
fn roof(refinements: u32) -> PolyMesh {
    let mut points = Vec::new();
    let mut number = |x: f64, y: f64| {
        let at = Point::new(x, y, 0.0);
        points.iter().position(|p: &Point| (p - at).norm() < 1e-9).unwrap_or_else(|| {
            points.push(at);
            points.len() - 1
        }) as u32
    };
    let mut faces =
        vec![[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| number(x, y))];
    for quarter in 0..4 {
        let turned = |[x, y]: [f64; 2]| match quarter {
            0 => [x, y],
            1 => [-y, x],
            2 => [-x, -y],
            _ => [y, -x],
        };
        let side = [[1.0, -1.0], [2.4, -1.0], [2.4, 1.0], [1.0, 1.0]];
        let low = [[1.0, 1.0], [2.4, 1.0], [2.4, 1.7], [2.05, 2.05]];
        let high = [[1.0, 1.0], [2.05, 2.05], [1.7, 2.4], [1.0, 2.4]];
        for block in [side, low, high] {
            faces.push(block.map(|p| {
                let [x, y] = turned(p);
                number(x, y)
            }));
        }
    }
    let mut mesh = PolyMesh::new(points, faces).unwrap();
    for _ in 0..refinements {
        mesh = catmull_clark(&mesh).unwrap().mesh;
    }
    let bent =
        |p: &Point| Point::new(p.x, p.y, -0.1 * (p.x * p.x + 0.4 * p.x * p.y + 2.0 * p.y * p.y));
    mesh.set_points(mesh.points().iter().map(bent).collect());
    mesh
}

fn lower_one(q: &QuadMesh) -> PolyMesh {
    lower(q, &[String::new()]).unwrap().mesh
}

/// Valences of irregular vertices and degrees of irregular faces, sorted.
fn irregular(q: &QuadMesh) -> (Vec<u32>, Vec<u32>) {
    let of = |kind: Kind| {
        let mut valences: Vec<u32> = kind.irregular(q).map(|v| q.valence(v)).collect();
        valences.sort_unstable();
        valences
    };
    (of(Kind::Vertices), of(Kind::Faces))
}

/// Fairness after equal angles were asked for, and after planes were.
fn fairness(mesh: &PolyMesh, reference: &PolyMesh) -> [Fairness; 2] {
    let config = Config::default();
    let run = |mesh: PolyMesh, goal| {
        optimize(mesh, Some(reference), goal, MendPolicy::Strict, &config, &Silent).unwrap()
    };
    let fair = run(mesh.clone(), Goal::Angles);
    let planar = run(fair.mesh.clone(), Goal::Planar);
    [fair.report.after.fairness, planar.report.after.fairness]
}

#[test]
fn figure_9_three_designs_of_one_surface() {
    let (first, reference) = (roof(3), roof(5));
    let mut q = lifted(&first);
    assert_eq!(irregular(&q), (vec![5; 4], vec![]), "four v5");
    convert(&mut q, Kind::Vertices, &mut |_, _| 0.0, &Silent);
    assert_eq!(irregular(&q), (vec![], vec![5; 4]), "four pentagons");
    let second = lower_one(&q);
    let pentagons: Vec<Vertex> = Kind::Faces.irregular(&q).collect();
    for f in pentagons {
        // An edge inserted: f5 → f3 + f4, and its ends get a fifth edge (Figure 8).
        let cut = |first| Op::Split(Split { first, last: q.ccw(q.ccw(first)) });
        let cuts: Vec<Op> = q.outgoing(f).map(cut).collect();
        assert!(cuts.iter().any(|op| op.run(&mut q) == Ok(2)));
    }
    assert_eq!(irregular(&q), (vec![5; 8], vec![3; 4]), "four triangles and eight v5");
    let designs =
        [("four v5", first), ("four pentagons", second), ("four triangles", lower_one(&q))];
    let mut results = Vec::new();
    for (name, mesh) in &designs {
        check(mesh).unwrap();
        let [fair, planar] = fairness(mesh, &reference);
        say(&format!(
            "{name:<16} angles {:.2}/{:.1} deg, planarity {:.5}/{:.4} -> {:.5}/{:.4}",
            fair.angle_deviation_deg.mean,
            fair.angle_deviation_deg.max,
            fair.planarity.mean,
            fair.planarity.max,
            planar.planarity.mean,
            planar.planarity.max,
        ));
        assert!(planar.planarity.mean < fair.planarity.mean, "{name}");
        assert!(planar.planarity.max < 0.8 * fair.planarity.max, "{name}");
        results.push(fair);
    }
    let [vertices, pentagons, _] = results[..] else { panic!("three designs") };
    assert!(
        pentagons.angle_deviation_deg.max < vertices.angle_deviation_deg.max + 5.0,
        "a regular pentagon has equal angles"
    );
}

/// Walks a dislocation the cheapest way until it is absorbed; how many elements fewer there are.
fn cancel(q: &mut QuadMesh, dipole: Dipole, reach: u16) -> Option<u32> {
    let costs = CostOptions::default();
    let graph = MovementGraph::new(q, dipole, reach, &costs);
    let (node, _) = graph.search(&[])?;
    let (steps, gain) = (graph.steps(node), graph.gain(node));
    drop(graph);
    let mut at = Some(dipole);
    for step in steps {
        at = at?.step(q, step).ok()?.dipole;
    }
    Some(gain)
}

/// Whether the place still exists and a dislocation stands there.
fn stands(q: &QuadMesh, dipole: Dipole) -> bool {
    q.is_quad_alive(QuadMesh::quad(dipole.0)) && dipole.stands(q)
}

fn t_junctions(q: &QuadMesh) -> Vec<Dipole> {
    Dipole::all(q).filter(|d| d.is_t_junction()).collect()
}

/// A T-junction as far as it glides in the given number of steps without a change of E.
fn glide(q: &mut QuadMesh, mut at: Dipole, steps: usize) -> Dipole {
    for _ in 0..steps {
        let mark = q.mark();
        match at.step(q, STEPS[1]).ok().filter(|s| s.delta == 0).and_then(|s| s.dipole) {
            Some(next) => at = next,
            None => q.undo_to(mark),
        }
    }
    at
}

#[test]
fn figure_10_t_junctions_are_moved_merged_and_the_last_pair_changes_its_type() {
    let reference = shapes::grid(30, 24);
    let mut q = lift(&reference, &no_features(&reference)).unwrap();
    // Three edge shifts make three pairs of opposite T-junctions, which glide apart.
    for place in [31 * 6 + 8, 31 * 12 + 15, 31 * 18 + 21] {
        let old = t_junctions(&q);
        Op::Flip(Flip { edge: q.out(place), turn: Turn::Ccw }).run(&mut q).unwrap();
        let new = t_junctions(&q).into_iter().find(|d| !old.contains(d)).expect("a T-junction");
        glide(&mut q, new, 4);
    }
    let mut stages = vec![("made", q.clone())];
    let first = t_junctions(&q)[0];
    t_junction::shift(&mut q, first, Direction::Down, 1).expect("room to move");
    stages.push(("moved", q.clone()));
    while q.total_irregularity() > 4 {
        let all: Vec<Dipole> = Dipole::all(&q).collect();
        assert!(all.into_iter().any(|d| cancel(&mut q, d, 24).is_some()), "no pair can be merged");
    }
    stages.push(("merged", q.clone()));
    for t in t_junctions(&q) {
        // Half a move: v3 and f5 become f3 and v5.
        let changed = STEPS.into_iter().filter(|s| s.displacement().swaps_type()).any(|step| {
            let mark = q.mark();
            let done = stands(&q, t) && t.step(&mut q, step).is_ok_and(|s| s.delta == 0);
            if !done {
                q.undo_to(mark);
            }
            done
        });
        assert!(changed, "an odd step");
    }
    stages.push(("type changed", q.clone()));
    let mut angles = Vec::new();
    for (name, q) in &stages {
        q.check().unwrap();
        let mesh = lower_one(q);
        let [fair, _] = fairness(&mesh, &reference);
        let hanging = matched_t_junctions(&mesh, &Topology::new(&mesh));
        say(&format!(
            "{name:<14} E {:>2}, T-junctions {hanging}, angles {:.2}/{:.1} deg",
            q.total_irregularity(),
            fair.angle_deviation_deg.mean,
            fair.angle_deviation_deg.max
        ));
        angles.push(fair.angle_deviation_deg.mean);
    }
    assert!(angles[2] < angles[0], "fewer T-junctions, fairer faces: {angles:?}");
    assert!(angles[3] < angles[0], "{angles:?}");
    assert_eq!((q.total_irregularity(), t_junctions(&q).len()), (4, 0));
}

/// How much the reference bends around an element.
fn bend(q: &QuadMesh, v: Vertex, reference: &Reference) -> f64 {
    let normal = |v: Vertex| reference.normal(reference.closest(&q.location(v)).triangle);
    let here = normal(v);
    q.neighbours(v).chain(q.diagonals(v)).map(|w| 1.0 - here.dot(&normal(w))).sum()
}

/// How much the reference bends at the irregular elements, in the mean.
fn fit(q: &QuadMesh, reference: &Reference) -> f64 {
    let irregular = q.vertices().filter(|&v| q.irregularity(v) > 0);
    let bends: Vec<f64> = irregular.map(|v| bend(q, v, reference)).collect();
    bends.iter().sum::<f64>() / bends.len().max(1) as f64
}

/// Pair-wise movement (Proposition 3.4) of `v` and another element: an operation at `v` emits a
/// dislocation, which is absorbed elsewhere. It stays if E does not grow and elements stand where
/// the surface bends more.
fn relocate(q: &mut QuadMesh, v: Vertex, reference: &Reference) -> bool {
    let before = fit(q, reference);
    for op in around(q, v) {
        let start = q.mark();
        let Ok(cost @ 1..=2) = op.run(q) else {
            q.undo_to(start);
            continue;
        };
        let near: Vec<Vertex> =
            q.touched_since(start).into_iter().filter(|&w| q.is_alive(w)).collect();
        let emitted: Vec<Dipole> =
            near.iter().flat_map(|&w| q.outgoing(w)).map(Dipole).filter(|d| d.stands(q)).collect();
        for dipole in emitted {
            let mark = q.mark();
            if cancel(q, dipole, 6).is_some_and(|gain| gain as i32 >= cost)
                && fit(q, reference) > 1.01 * before
            {
                return true;
            }
            q.undo_to(mark);
        }
        q.undo_to(start);
    }
    false
}

#[test]
fn figure_11_recipe_on_a_real_remesh() {
    let Some(folder) = data_folder("figure_11_recipe_on_a_real_remesh") else { return };
    let read = |name: &str| io::read(&folder.join(name)).unwrap().mesh;
    let (mesh, scan) = (read("wingnut_im4k.obj"), read("wingnut_im4k.ref.obj"));
    let (mesh, _) = mend(mesh, MendPolicy::Mend).unwrap();
    let reference = Reference::new(&scan).unwrap();
    let features =
        mesh_features(&mesh, &Topology::new(&mesh), &reference, &Config::default().features);
    let mut q = lift(&mesh, &features).unwrap();
    let mut counts = vec![q.total_irregularity()];
    // 1. Regularise clusters of high degree.
    let is_high = |q: &QuadMesh, v: Vertex| {
        let next: u32 = q.neighbours(v).map(|w| q.irregularity(w)).sum();
        q.irregularity(v) > 0 && q.irregularity(v) + next >= 3
    };
    for v in 0..q.vertex_ids() {
        if q.is_alive(v) && is_high(&q, v) {
            let _ = regularize::around(&mut q, v, 40);
        }
    }
    counts.push(q.total_irregularity());
    // 2. Remove excess: every dislocation that can be absorbed is.
    loop {
        let all: Vec<Dipole> = Dipole::all(&q).collect();
        let mut cancelled = 0;
        for d in all {
            cancelled += usize::from(stands(&q, d) && cancel(&mut q, d, 14).is_some());
        }
        if cancelled == 0 {
            break;
        }
    }
    counts.push(q.total_irregularity());
    // 3. Relocate what is left to where the surface bends.
    let loose = fit(&q, &reference);
    let left: Vec<Vertex> = q.vertices().filter(|&v| q.irregularity(v) > 0).take(40).collect();
    let mut moved = 0;
    for v in left {
        let stays = q.is_alive(v) && q.irregularity(v) > 0;
        moved += usize::from(stays && relocate(&mut q, v, &reference));
    }
    let fitted = fit(&q, &reference);
    counts.push(q.total_irregularity());
    q.check().unwrap();
    // 4. Make it pure quad.
    let config = Config::default();
    let done = pure_quad(lower_one(&q), Some(&scan), MendPolicy::Strict, &config, &Silent).unwrap();
    let after = &done.report.after.summary;
    say(&format!(
        "E {counts:?}, then {}; {moved} pairs moved, bend at elements {loose:.3} to {fitted:.3}",
        after.irregular_elements
    ));
    assert!(moved > 0 && fitted > loose, "{moved} pairs moved, {loose} to {fitted}");
    assert!(counts.windows(2).all(|w| w[1] <= w[0]), "{counts:?}");
    assert!(counts[3] < counts[0] / 2, "{counts:?}");
    assert!(after.pure_quad && after.irregular_elements as u64 <= counts[3] + 4);
}
