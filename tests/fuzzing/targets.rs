//! What is fuzzed: one function a target, which gets any bytes and must come back. `cargo fuzz` (in
//! `fuzz/`) and the test `fuzzing` run the same functions.

#[path = "../common/lifted.rs"]
mod lifted;

use quadmend::config::Config;
use quadmend::io::{Format, OBJ, OFF, PLY, ReadOptions, STL};
use quadmend::mesh::{MendPolicy, Point, PolyMesh, check, mend, shapes};
use quadmend::script::Script;
use quadmend::sqrtcc::{QuadMesh, lower};

use lifted::{Invariants, fingerprint, lifted, operation};

/// A target and the folder of its seeds.
pub(crate) type Target = (&'static str, fn(&[u8]));

/// All of them.
pub(crate) const TARGETS: &[Target] = &[
    ("obj", |bytes| read(OBJ, bytes)),
    ("ply", |bytes| read(PLY, bytes)),
    ("off", |bytes| read(OFF, bytes)),
    ("stl", |bytes| read(STL, bytes)),
    ("config", config),
    ("script", script),
    ("edits", edits),
];

/// A file that is read is a mesh; written and read again it is the same mesh, and it can be mended
/// to a clean one or is refused.
fn read(format: Format, bytes: &[u8]) {
    let options = ReadOptions { vertices: 5_000, faces: 5_000, degree: 500, expansion: 10 };
    let read = |bytes: &[u8]| format.read(bytes, "fuzzed", &options);
    let Ok(loaded) = read(bytes) else { return };
    if format.is_written() {
        let again = read(&format.bytes(&loaded.mesh, None)).expect("what was written is read");
        assert_eq!(again.mesh.corners(), loaded.mesh.corners());
        assert_eq!(again.mesh.offsets(), loaded.mesh.offsets());
        assert_eq!(again.mesh.points(), loaded.mesh.points());
    }
    if let Ok((mended, _)) = mend(loaded.mesh, MendPolicy::Mend) {
        assert_eq!(check(&mended), Ok(()));
    }
}

/// A configuration that is accepted is written as a file that says the same.
fn config(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let Ok(config) = Config::default().with_text("fuzzed", &text) else { return };
    let again = Config::default().with_text("again", &config.to_toml_commented());
    assert_eq!(again.expect("what was written is read"), config);
}

fn script(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    if let Ok(script) = Script::parse(&text, "fuzzed") {
        assert!(script.len() <= text.len());
    }
}

/// Any operations on any mesh keep every invariant, and undo to what was there.
fn edits(bytes: &[u8]) {
    let [shape, rest @ ..] = bytes else { return };
    let (mesh, rest) = match shape % 5 {
        0 => (shapes::sphere(3), rest),
        1 => (shapes::grid(6, 5), rest),
        2 => (shapes::torus(7, 5), rest),
        3 => (shapes::cube(2), rest),
        _ => soup(rest),
    };
    let Ok((mesh, _)) = mend(mesh, MendPolicy::Mend) else { return };
    let mut q = lifted(&mesh);
    let (start, before) = (q.mark(), fingerprint(&q));
    let invariants = Invariants::of(&q);
    for step in rest.chunks_exact(4).take(200) {
        run(&mut q, [step[0], step[1], step[2], step[3]], &invariants);
    }
    let lowered = lower(&q, mesh.group_names()).expect("it was a mesh before");
    assert_eq!(check(&lowered.mesh), Ok(()));
    q.undo_to(start);
    assert_eq!(fingerprint(&q), before);
}

fn run(q: &mut QuadMesh, [kind, high, low, turns]: [u8; 4], invariants: &Invariants) {
    let op = operation(q, kind, u32::from(high) << 8 | u32::from(low), turns.into());
    let elements = q.total_irregularity() as i64;
    if op.check(q).is_err() {
        let state = fingerprint(q);
        assert!(op.run(q).is_err());
        return assert_eq!(fingerprint(q), state, "a refused operation leaves no trace");
    }
    let delta = op.run(q).expect("it was legal");
    assert_eq!(q.total_irregularity() as i64, elements + i64::from(delta));
    assert_eq!(Invariants::of(q), *invariants);
}

/// Faces on twenty vertices, four corners each, and what is left of the bytes.
fn soup(bytes: &[u8]) -> (PolyMesh, &[u8]) {
    let (faces, rest) = bytes.split_at(bytes.len().min(80));
    let faces = faces.chunks_exact(4).map(|f| [f[0], f[1], f[2], f[3]].map(|v| u32::from(v) % 20));
    let point = |v: u32| Point::new(f64::from(v), f64::from(v * v % 7), f64::from(v * v % 5));
    let mesh = PolyMesh::new((0..20).map(point).collect(), faces).expect("vertices are there");
    (mesh, rest)
}
