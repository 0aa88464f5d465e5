//! Compares every number of `metrics` with an independent checker (a numpy program beside the
//! test data), key by key: counts exactly, other numbers to 1e-4, sampled distances statistically.
//!
//! Where the data, Python, numpy or scipy are missing the test says so and passes.

mod common;

use common::{MESHES, data_folder, say};
use quadmend::mesh::PolyMesh;
use quadmend::metrics::{self, MeasureOptions, Target};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Largest relative difference of numbers that are not counts.
const RELATIVE: f64 = 1e-4;
/// Below this, numbers are rounding errors of the checker's and of ours.
const ABSOLUTE: f64 = 1e-9;

struct Checker {
    data: PathBuf,
    script: PathBuf,
}

impl Checker {
    /// The checker with the Python modules that it needs; says what is missing.
    fn find(test: &str, modules: &[&str]) -> Option<Self> {
        let data = data_folder(test)?;
        let script = data.join("../tools/measure.py");
        if !script.is_file() {
            say(&format!("SKIPPED: {test}: no checker at {}", script.display()));
            return None;
        }
        if !python_has(modules) {
            say(&format!("SKIPPED: {test}: no python3 with {}", modules.join(", ")));
            return None;
        }
        Some(Self { data, script })
    }

    fn path(&self, name: &str, kind: &str) -> PathBuf {
        self.data.join(format!("{name}{kind}"))
    }

    fn measure(&self, mesh: &Path, reference: Option<&Path>) -> Value {
        let mut python = Command::new("python3");
        python.arg(&self.script).arg(mesh).arg("--json");
        if let Some(reference) = reference {
            python.arg("--ref").arg(reference).args(["--samples", &SAMPLES.to_string()]);
        }
        let output = python.output().expect("python3 runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).expect("the checker writes JSON")
    }
}

fn python_has(modules: &[&str]) -> bool {
    let import = format!("import {}", modules.join(", "));
    let output = Command::new("python3").args(["-c", &import]).output();
    output.is_ok_and(|o| o.status.success())
}

fn read(path: &Path) -> PolyMesh {
    quadmend::io::read(path).expect("the mesh can be read").mesh
}

/// Appends to `faults` where `ours` differs from `theirs`.
fn compare(at: &str, ours: &Value, theirs: &Value, faults: &mut Vec<String>) {
    match (ours, theirs) {
        (Value::Object(a), Value::Object(b)) => {
            for key in b.keys().filter(|k| !a.contains_key(*k)) {
                faults.push(format!("{at}.{key}: only the checker has it"));
            }
            for (key, value) in a {
                match b.get(key) {
                    Some(other) => compare(&format!("{at}.{key}"), value, other, faults),
                    None => faults.push(format!("{at}.{key}: the checker does not have it")),
                }
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (i, (x, y)) in a.iter().zip(b).enumerate() {
                compare(&format!("{at}[{i}]"), x, y, faults);
            }
        }
        _ if same_leaf(ours, theirs) => {}
        _ => faults.push(format!("{at}: {ours} here, {theirs} there")),
    }
}

fn same_leaf(ours: &Value, theirs: &Value) -> bool {
    if ours == theirs {
        return true;
    }
    let integral = ours.is_i64() || theirs.is_i64();
    match (ours.as_f64(), theirs.as_f64()) {
        (Some(a), Some(b)) if !integral => near(a, b, RELATIVE, ABSOLUTE),
        _ => false,
    }
}

fn near(a: f64, b: f64, relative: f64, absolute: f64) -> bool {
    (a - b).abs() <= absolute.max(relative * b.abs())
}

fn compare_without_reference(checker: &Checker, name: &str, path: &Path, faults: &mut Vec<String>) {
    let theirs = checker.measure(path, None);
    let ours = metrics::measure(&read(path), None).expect("the mesh has faces");
    let ours = serde_json::to_value(ours).expect("metrics are JSON");
    for part in ["topology", "quality", "summary"] {
        compare(&format!("{name}.{part}"), &ours[part], &theirs[part], faults);
    }
}

#[test]
fn counts_and_qualities_agree_with_the_checker() {
    let test = "counts_and_qualities_agree_with_the_checker";
    let Some(checker) = Checker::find(test, &["numpy", "scipy"]) else { return };
    let mut faults = Vec::new();
    for name in MESHES {
        compare_without_reference(&checker, name, &checker.path(name, ".obj"), &mut faults);
    }
    assert!(faults.is_empty(), "{} differences:\n{}", faults.len(), faults.join("\n"));
}

/// Samples for distances, on both sides: with 200 000 of them the checker's own Hausdorff
/// distance still varies by 10 % from seed to seed, on wingnut.
const SAMPLES: u32 = 1_000_000;

/// How far a number may be from one that the checker finds with random samples or, for curves,
/// with a search among near pieces: relative, and absolute in diagonals. `None`: not compared.
fn tolerance(key: &str) -> Option<(f64, f64)> {
    match key {
        "distance_backend" => None,
        "hausdorff" => Some((0.05, 3e-5)),
        // On a planar mesh all error is in a few samples near its holes.
        "rms" | "mean" => Some((0.02, 3e-7)),
        "flipped_faces" | "flipped_share" => Some((0.1, 0.0)),
        "ref_to_mesh_mean"
        | "mesh_to_ref_mean"
        | "max"
        | "p95"
        | "mean_in_edge_lengths"
        | "share_within_0_1_edge" => Some((0.02, ABSOLUTE)),
        _ => Some((RELATIVE, ABSOLUTE)),
    }
}

fn compare_reference(at: &str, ours: &Value, theirs: &Value, faults: &mut Vec<String>) {
    let (Value::Object(a), Value::Object(b)) = (ours, theirs) else {
        return faults.push(format!("{at}: {ours} here, {theirs} there"));
    };
    assert!(a.keys().eq(b.keys()) || a.len() == b.len(), "{at}: {a:?} here, {b:?} there");
    for (key, x) in a {
        let (at, y) = (format!("{at}.{key}"), &b[key]);
        let Some((relative, absolute)) = tolerance(key) else { continue };
        match (x.as_f64(), y.as_f64()) {
            (Some(x), Some(y)) if near(x, y, relative, absolute) => {}
            (Some(x), Some(y)) => faults.push(format!("{at}: {x} here, {y} there")),
            _ if x == y => {}
            _ => compare_reference(&at, x, y, faults),
        }
    }
}

#[test]
fn distances_agree_with_the_checker() {
    let test = "distances_agree_with_the_checker";
    let Some(checker) = Checker::find(test, &["numpy", "scipy", "igl"]) else { return };
    let mut faults = Vec::new();
    let options = MeasureOptions { samples: SAMPLES, ..Default::default() };
    for name in [
        "spot_im3k",
        "blub_im6k",
        "wingnut_im4k",
        "plate_gmsh",
        "mountain_im15k",
        "featuretype_im6k",
    ] {
        let (path, reference) = (checker.path(name, ".obj"), checker.path(name, ".ref.obj"));
        let theirs = checker.measure(&path, Some(&reference));
        let target = Target::new(&read(&reference), &options);
        let target = target.expect("the reference is a surface");
        let ours = metrics::measure(&read(&path), Some(&target)).expect("the mesh has faces");
        let ours = serde_json::to_value(ours).expect("metrics are JSON");
        compare_reference(name, &ours["reference"], &theirs["reference"], &mut faults);
    }
    assert!(faults.is_empty(), "{} differences:\n{}", faults.len(), faults.join("\n"));
}

/// A soup on few vertices: all sorts of edges with many faces, repeated corners, bow-ties,
/// T-junctions. The generator is Knuth's, so that the soup is the same everywhere.
fn soup(seed: u64, vertices: u64, faces: usize) -> String {
    let mut state = seed;
    let mut below = |n: u64| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % n
    };
    let mut lines: Vec<String> = Vec::new();
    for _ in 0..vertices {
        lines.push(format!("v {} {} {}", below(97), below(97), below(97)));
    }
    for _ in 0..faces {
        let corners = (0..3 + below(4)).map(|_| (1 + below(vertices)).to_string());
        lines.push(format!("f {}", corners.collect::<Vec<_>>().join(" ")));
    }
    lines.join("\n")
}

#[test]
fn soups_agree_with_the_checker() {
    let test = "soups_agree_with_the_checker";
    let Some(checker) = Checker::find(test, &["numpy", "scipy"]) else { return };
    let mut faults = Vec::new();
    for (seed, vertices, faces) in [(1, 6, 8), (2, 12, 9), (3, 40, 60), (4, 200, 90), (5, 9, 200)] {
        let file = tempfile::Builder::new().suffix(".obj").tempfile().expect("a temporary file");
        std::fs::write(file.path(), soup(seed, vertices, faces)).expect("the soup is written");
        compare_without_reference(&checker, &format!("soup {seed}"), file.path(), &mut faults);
    }
    assert!(faults.is_empty(), "{} differences:\n{}", faults.len(), faults.join("\n"));
}
