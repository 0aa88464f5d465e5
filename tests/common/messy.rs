//! Random quad-dominant meshes: regular shapes with cuts, T-junctions, splits, collapses and
//! holes, and what must be true of them after cleaning.

use super::lifted::{Dice, lifted, mess_up};
use super::{segments, shape};
use quadmend::config::Config;
use quadmend::mesh::{MendPolicy, Point, PolyMesh, Topology, Vector, mend, shapes};
use quadmend::metrics::Metrics;
use quadmend::moves::dipole::{Dipole, STEPS};
use quadmend::pipeline::Cleaned;
use quadmend::planner::gate::GateOptions;
use quadmend::sqrtcc::{QuadMesh, lower};
use quadmend::surface::triangulate;
use std::collections::{BTreeMap, BTreeSet};

/// How much larger the distance to a reference may get; it is measured by samples.
const GROWTH: f64 = 1.15;
/// Edits are judged by three probes of the reference a face, which can miss as much of a distance
/// as they are from what is between them, in mean edges.
const PROBE_GAP_EDGES: f64 = 0.29;
/// How far the middle of a face is from its sides, in mean edges, with room for larger faces.
const MID_FACE_EDGES: f64 = 0.55;
/// How far creases may be from the edges on average, in mean edges: folds alone are lost.
const CREASE_MEAN_EDGES: f64 = 0.015;
/// Distances are sampled; this much of the diagonal is not seen.
const NOISE_REL: f64 = 2e-5;

/// A mesh to clean, and the surface that it was made from.
pub(crate) struct Messy {
    /// What it is and how it was made.
    pub(crate) name: String,
    pub(crate) mesh: PolyMesh,
    pub(crate) reference: Option<PolyMesh>,
}

impl Messy {
    /// Number `seed`; `size` is about the number of quads along a side.
    pub(crate) fn new(seed: u64, size: u32) -> Self {
        let mut dice = Dice(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
        let n = size + dice.below(size);
        let (kind, regular, fine) = match seed % 5 {
            0 => ("sphere", shapes::sphere(n), shapes::sphere(4 * n)),
            1 => ("torus", shapes::torus(3 * n, n + 2), shapes::torus(12 * n, 4 * (n + 2))),
            2 => ("disk", shapes::grid(2 * n, n + 3), shapes::grid(2 * n, n + 3)),
            3 => {
                let disk = holed(&shapes::grid(2 * n, 2 * n), &mut dice);
                ("disk with holes", disk.clone(), disk)
            }
            _ => {
                let cuboid = stretched(n, &mut dice);
                ("box", cuboid.clone(), cuboid)
            }
        };
        let edits = 2 + dice.below(2 * n) as usize;
        let mesh = operated(&regular, &mut dice, edits);
        let cuts = dice.below(n) as usize;
        let mesh = cut(&mesh, &mut dice, cuts);
        let hanging = dice.below(n) as usize;
        let mesh = hung(&mesh, &mut dice, hanging);
        // Without a reference the mesh itself is the surface.
        let reference = (dice.below(4) > 0).then_some(fine);
        let surface = if reference.is_some() { "" } else { ", its own surface" };
        let name = format!("{seed}: {kind}, {} faces{surface}", mesh.face_count());
        Self { name, mesh, reference }
    }

    /// A connected mesh of about so many faces on a bumpy ring, as messy as that of a field-aligned
    /// remesher, and a scan of that ring: triangles, twice as many. O(faces).
    pub(crate) fn scanned(seed: u64, faces: u32) -> Self {
        let mut dice = Dice(seed.wrapping_mul(0x2545_f491_4f6c_dd1d));
        // Squares: the ring is as many times longer than it is thick.
        let rows = (f64::from(faces) / RING).sqrt();
        let (rows, columns) = (rows as u32, (RING * rows) as u32);
        let mut q = lifted(&shapes::torus(columns, rows));
        mess_up(&mut q, &mut dice, faces as usize / 130);
        scattered(&mut q, &mut dice, 16);
        let mesh = lower(&q, &[String::new()]).expect("a mesh").mesh;
        let mesh = cut(&mesh, &mut dice, faces as usize / 800);
        let mut mesh = hung(&mesh, &mut dice, faces as usize / 400);
        evened(&mut mesh, 10);
        let bumps = Bumps::new(&mut dice);
        let edge = std::f64::consts::TAU / f64::from(rows);
        bumps.on(&mut mesh, 0.03 * edge, &mut dice);
        // No vertex of the one is at one of the other.
        let fine = triangulate(&shapes::torus(columns + columns / 50, rows + rows / 50 + 1));
        let mut scan = PolyMesh::new(fine.points, fine.triangles).expect("a mesh");
        evened(&mut scan, 1);
        bumps.on(&mut scan, 0.005 * edge, &mut dice);
        let name = format!("{seed}: bumpy ring, {} faces", mesh.face_count());
        Self { name, mesh, reference: Some(scan) }
    }

    /// What is wrong with the result, a line each.
    pub(crate) fn faults(&self, cleaned: &Cleaned, config: &Config) -> Vec<String> {
        let (mended, _) = mend(self.mesh.clone(), MendPolicy::Mend).expect("it was cleaned");
        let mut faults = Faults { name: &self.name, lines: Vec::new() };
        judge_counts(cleaned, config, &mut faults);
        judge_distance((&mended, self.reference.is_none()), cleaned, config, &mut faults);
        judge_lines(&mended, cleaned, config, &mut faults);
        faults.lines
    }
}

/// Lines about one mesh.
struct Faults<'a> {
    name: &'a str,
    lines: Vec<String>,
}

impl Faults<'_> {
    fn unless(&mut self, holds: bool, what: impl FnOnce() -> String) {
        if !holds {
            self.lines.push(format!("{}: {}", self.name, what()));
        }
    }
}

/// E, size, shape of the elements, and what no clean mesh has.
fn judge_counts(cleaned: &Cleaned, config: &Config, faults: &mut Faults) {
    let report = &cleaned.report;
    let (old, new) = (&report.before.summary, &report.after.summary);
    let (e, left) = (old.irregular_elements, new.irregular_elements);
    faults.unless(left <= e, || format!("E has risen from {e} to {left}"));
    faults.unless(new.manifold && new.oriented && new.gauss_bonnet_exact, || format!("{new:?}"));
    faults.unless(new.degenerate.connectivity.is_clean(), || format!("{:?}", new.degenerate));
    let inverted = [&report.before, &report.after]
        .map(|m| m.quality.scaled_jacobian_quads.map_or(0, |j| j.count_below_0));
    faults.unless(inverted[1] <= inverted[0], || format!("inverted quads {inverted:?}"));
    let flipped = [old, new].map(|s| s.flipped_faces.unwrap_or(0));
    faults.unless(flipped[1] <= flipped[0], || format!("flipped faces {flipped:?}"));
    let drift = (new.faces as f64 / old.faces as f64).ln().abs();
    faults.unless(drift <= config.plan.size_drift + 0.01, || {
        format!("faces {} -> {}", old.faces, new.faces)
    });
}

/// The mesh stays as near to its reference as it was, or as a mesh on itself may go.
fn judge_distance(
    (mended, on_itself): (&PolyMesh, bool),
    cleaned: &Cleaned,
    config: &Config,
    faults: &mut Faults,
) {
    let (old, new) = (&cleaned.report.before.summary, &cleaned.report.after.summary);
    let edge = quadmend::surface::mean_edge(mended, &Topology::new(mended)) / mended.diagonal();
    let gate = &config.gate;
    // A flat mesh is on its reference to the bit.
    let is_exact = old.rms.is_some_and(|rms| rms < NOISE_REL);
    let own = room(gate);
    for (what, of, own) in [
        ("Hausdorff", [old.hausdorff, new.hausdorff], own),
        ("RMS", [old.rms, new.rms], gate.own_rms_edges * gate.rms),
    ] {
        let [old, new] = of.map(|d| d.expect("distances are measured"));
        let own = if on_itself || is_exact { own * edge } else { 0.0 };
        let most = GROWTH * old.max(own) + NOISE_REL;
        faults.unless(new <= most, || {
            format!("{what} distance {old:.5} -> {new:.5}, at most {most:.5} of the diagonal")
        });
    }
}

/// Topology and boundaries are those of the input, bit for bit, and features where they were.
fn judge_lines(mended: &PolyMesh, cleaned: &Cleaned, config: &Config, faults: &mut Faults) {
    let result = &cleaned.mesh;
    let (before, after) = (Topology::new(mended), Topology::new(result));
    let shapes = [shape(mended), shape(result)];
    faults.unless(shapes[0] == shapes[1], || format!("χ and loops {shapes:?}"));
    let boundary = |m: &PolyMesh, t: &Topology| segments(m, t, t.boundary_half_edges());
    let [old, new] = [boundary(mended, &before), boundary(result, &after)];
    faults.unless(old == new, || "the boundary is not what it was".to_owned());
    // Features may be resampled, and their vertices slide: the creases are where they were. A fold
    // of an edge or two is no feature, and may end up in the middle of a face, but hardly any is.
    let creases = |m: &Metrics| m.reference.as_ref()?.features.to_any_mesh_edge;
    let report = &cleaned.report;
    if let (Some(old), Some(new)) = (creases(&report.before), creases(&report.after)) {
        let edge = quadmend::surface::mean_edge(mended, &before) / mended.diagonal();
        let farthest = room(&config.gate).max(MID_FACE_EDGES) * edge;
        for (what, [old, new], room) in [
            ("at most", [old.max, new.max], farthest),
            ("on average", [old.mean, new.mean], CREASE_MEAN_EDGES * edge),
        ] {
            let most = GROWTH * old + room;
            faults.unless(new <= most, || {
                format!("creases {what} {old:.5} -> {new:.5} from the nearest edge, not {most:.5}")
            });
        }
    }
}

/// How far single edits may leave the surface, in mean edges: what the last smoothing cannot take
/// back stays.
fn room(gate: &GateOptions) -> f64 {
    gate.own_hausdorff_edges * gate.hausdorff * gate.distance + PROBE_GAP_EDGES
}

/// A box with edges of random lengths.
fn stretched(n: u32, dice: &mut Dice) -> PolyMesh {
    let mut mesh = shapes::cube(n);
    let scale = [0; 3].map(|_| 1.0 + f64::from(dice.below(100)) / 100.0);
    let points = mesh.points().iter();
    let points = points.map(|p| Point::new(p.x * scale[0], p.y * scale[1], p.z * scale[2]));
    mesh.set_points(points.collect());
    mesh
}

/// The mesh without up to four rectangles of faces that do not touch.
fn holed(grid: &PolyMesh, dice: &mut Dice) -> PolyMesh {
    let side = (grid.face_count() as f64).sqrt() as u32;
    let size = (side / 6).max(1);
    let mut gone = BTreeSet::new();
    for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        if dice.below(3) > 0 {
            let (x, y) = (x * side / 2 + 2 + dice.below(size), y * side / 2 + 2 + dice.below(size));
            let cells = (0..size).flat_map(|j| (0..size).map(move |i| (y + j) * side + x + i));
            gone.extend(cells);
        }
    }
    let kept = grid.faces().zip(0..).filter(|(_, f)| !gone.contains(f)).map(|(face, _)| face);
    compact(grid.points(), kept.map(<[u32]>::to_vec).collect())
}

/// A mesh of these faces, without the points that none of them uses.
fn compact(points: &[Point], mut faces: Vec<Vec<u32>>) -> PolyMesh {
    let mut number = BTreeMap::new();
    let mut used = Vec::new();
    for v in faces.iter_mut().flatten() {
        *v = *number.entry(*v).or_insert_with(|| {
            used.push(points[*v as usize]);
            used.len() as u32 - 1
        });
    }
    PolyMesh::new(used, faces).expect("a mesh")
}

/// The mesh after random flips, collapses and splits in √CC.
fn operated(mesh: &PolyMesh, dice: &mut Dice, edits: usize) -> PolyMesh {
    let mut q = lifted(mesh);
    mess_up(&mut q, dice, edits);
    lower(&q, mesh.group_names()).expect("a mesh").mesh
}

/// Some quads are cut in two triangles.
fn cut(mesh: &PolyMesh, dice: &mut Dice, cuts: usize) -> PolyMesh {
    let mut faces: Vec<Vec<u32>> = mesh.faces().map(<[u32]>::to_vec).collect();
    for _ in 0..cuts {
        let f = dice.below(faces.len() as u32) as usize;
        if let [a, b, c, d] = faces[f][..] {
            faces[f] = vec![a, b, c];
            faces.push(vec![a, c, d]);
        }
    }
    PolyMesh::new(mesh.points().to_vec(), faces).expect("a mesh")
}

/// Some quads are cut in two across, so that their neighbours get a hanging corner each.
fn hung(mesh: &PolyMesh, dice: &mut Dice, cuts: usize) -> PolyMesh {
    let mut points = mesh.points().to_vec();
    let mut faces: Vec<Vec<u32>> = mesh.faces().map(<[u32]>::to_vec).collect();
    let mut at = vec![Vec::new(); points.len()];
    for (face, f) in faces.iter().zip(0..) {
        for &v in face {
            at[v as usize].push(f);
        }
    }
    for _ in 0..cuts {
        let f = dice.below(faces.len() as u32) as usize;
        let [a, b, c, d] = faces[f][..] else { continue };
        let mut middle = |u: u32, v: u32| {
            points.push(nalgebra::center(&points[u as usize], &points[v as usize]));
            points.len() as u32 - 1
        };
        let (m, n) = (middle(a, b), middle(c, d));
        faces[f] = vec![a, m, n, d];
        faces.push(vec![m, b, c, n]);
        let new = faces.len() - 1;
        for v in [b, c] {
            at[v as usize].push(new);
        }
        at.extend([vec![f, new], vec![f, new]]);
        for (u, v, w) in [(a, b, m), (c, d, n)] {
            let beyond =
                at[u as usize].iter().find(|&&g| g != f && insert(&mut faces[g], (u, v), w));
            if let Some(&g) = beyond {
                at[w as usize].push(g);
            }
        }
    }
    PolyMesh::new(points, faces).expect("a mesh")
}

/// Puts `w` on the edge of a face from `v` to `u`, if it has one; whether it has.
fn insert(face: &mut Vec<u32>, (u, v): (u32, u32), w: u32) -> bool {
    let n = face.len();
    let edge = (0..n).find(|&k| (face[k], face[(k + 1) % n]) == (v, u));
    edge.map(|at| face.insert(at + 1, w)).is_some()
}

/// Lets each dislocation walk some steps on its own, so that what was made together is apart.
fn scattered(q: &mut QuadMesh, dice: &mut Dice, most: u32) {
    let all: Vec<Dipole> = Dipole::all(q).collect();
    for start in all {
        let (way, steps) = (STEPS[dice.below(STEPS.len() as u32) as usize], dice.below(most));
        let mut at = Some(start).filter(|d| q.is_quad_alive(d.0 / 4) && d.stands(q));
        for _ in 0..steps {
            let stepped = at.and_then(|d| d.step(q, way).ok()).filter(|done| done.delta == 0);
            at = stepped.and_then(|done| done.dipole);
        }
    }
}

/// Radius of a ring whose tube has the radius 1.
const RING: f64 = 5.0;

/// The direction from the axis of a ring, and that from the middle of its tube.
fn directions(p: &Point, radius: f64) -> (Vector, Vector) {
    let out = Vector::new(p.x, p.y, 0.0).normalize();
    (out, (p.coords - out * radius).normalize())
}

/// A torus as a ring, on which vertices are moved to the mean of the faces around them.
fn evened(torus: &mut PolyMesh, passes: usize) {
    let on_ring = |p: &Point, radius: f64| {
        let (out, normal) = directions(p, radius);
        Point::from(out * RING + normal)
    };
    torus.set_points(torus.points().iter().map(|p| on_ring(p, 3.0)).collect());
    for _ in 0..passes {
        let mut sums = vec![(Vector::zeros(), 0.0); torus.vertex_count()];
        for f in 0..torus.face_count() {
            let middle = torus.centre(f).coords;
            for &v in torus.face(f) {
                let (sum, count) = &mut sums[v as usize];
                (*sum, *count) = (*sum + middle, *count + 1.0);
            }
        }
        let mean = |(sum, count): (Vector, f64)| on_ring(&Point::from(sum / count), RING);
        torus.set_points(sums.into_iter().map(mean).collect());
    }
}

/// Waves on a ring: direction times frequency, phase, and height.
struct Bumps(Vec<(Vector, f64, f64)>);

impl Bumps {
    fn new(dice: &mut Dice) -> Self {
        let wave = |dice: &mut Dice| {
            let along = Vector::from([0; 3].map(|_| 1.5 * symmetric(dice)));
            (along, 3.0 * symmetric(dice), 0.05)
        };
        Self((0..12).map(|_| wave(dice)).collect())
    }

    /// The ring with the waves, each vertex moved by up to so much in all directions.
    fn on(&self, ring: &mut PolyMesh, noise: f64, dice: &mut Dice) {
        let height = |p: &Point| {
            let waves = self.0.iter();
            waves.map(|(k, phase, height)| height * (k.dot(&p.coords) + phase).sin()).sum::<f64>()
        };
        let mut shake = || Vector::from([0; 3].map(|_| noise * symmetric(dice)));
        let place = |p: &Point| p + directions(p, RING).1 * height(p) + shake();
        ring.set_points(ring.points().iter().map(place).collect());
    }
}

/// A number between −1 and 1.
fn symmetric(dice: &mut Dice) -> f64 {
    f64::from(dice.below(2001)) / 1000.0 - 1.0
}
