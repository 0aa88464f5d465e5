//! `quadmend batch`: many meshes, one command; failures stop no other, and it goes on where it was.

mod common;

use common::lifted::{Dice, mess_up, no_features};
use quadmend::mesh::{PolyMesh, shapes};
use quadmend::sqrtcc::{lift, lower};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn messy(seed: u64) -> PolyMesh {
    let mesh = shapes::torus(16, 8);
    let mut q = lift(&mesh, &no_features(&mesh)).expect("a torus");
    mess_up(&mut q, &mut Dice(seed), 8);
    lower(&q, mesh.group_names()).expect("a torus").mesh
}

/// Three meshes, one of them with a strange name, and a file that is none.
fn inputs(folder: &Path) {
    for (seed, name) in (0..).zip(["a", "b", "c <i>&"]) {
        quadmend::io::write(&folder.join(format!("{name}.obj")), &messy(seed)).expect(name);
    }
    fs::write(folder.join("broken.obj"), "v 0 0 x\n").expect("a file");
}

fn batch(input: &Path, out: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_quadmend"))
        .arg("batch")
        .arg(input.join("*.obj"))
        .arg("--out")
        .arg(out)
        .args(["--set", "measure.samples=2000", "--set", "plan.stages=1"])
        .args(more)
        .output()
        .expect("the command runs")
}

fn manifest(out: &Path) -> Vec<Value> {
    let text = fs::read_to_string(out.join("manifest.jsonl")).expect("a manifest");
    text.lines().map(|line| serde_json::from_str(line).expect("a line is JSON")).collect()
}

fn statuses(out: &Path) -> Vec<String> {
    let status = |line: &Value| line["status"].as_str().expect("it has one").to_owned();
    manifest(out).iter().map(status).collect()
}

#[test]
fn a_failure_stops_no_other_mesh_and_all_is_told() {
    let (input, out) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    inputs(input.path());
    let run = batch(input.path(), out.path(), &["--reports"]);
    let told = String::from_utf8_lossy(&run.stderr);
    assert_eq!(run.status.code(), Some(3), "{told}");
    assert_eq!(statuses(out.path()), ["cleaned", "cleaned", "refused", "cleaned"], "{told}");
    let lines = manifest(out.path());
    assert!(lines[2]["error"].as_str().expect("an error").contains("broken.obj:1"), "{}", lines[2]);
    for name in ["a", "b", "c <i>&"] {
        let file = |end: &str| out.path().join(format!("{name}{end}"));
        let mesh = quadmend::io::read(&file(".obj")).expect("a mesh").mesh;
        quadmend::mesh::check(&mesh).expect("a clean mesh");
        assert!(file(".html").is_file(), "{name} has a report");
    }
    let csv = fs::read_to_string(out.path().join("summary.csv")).expect("a table");
    assert_eq!(csv.lines().count(), 5, "{csv}");
    let page = fs::read_to_string(out.path().join("index.html")).expect("a page");
    assert_eq!(page.matches("<img ").count(), 6, "before and after of three meshes");
    assert!(page.contains("c &lt;i&gt;&amp;.obj") && !page.contains("<i>"), "names are text");
    assert!(page.contains("./c%20%3Ci%3E%26.obj"), "addresses are encoded");
    assert!(!page.contains("http://") && !page.contains("https://"), "nothing from elsewhere");
}

#[test]
fn a_batch_goes_on_with_what_is_not_done_or_has_changed() {
    let (input, out) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    inputs(input.path());
    batch(input.path(), out.path(), &[]);
    let done_before = |run: &Output| {
        let told = String::from_utf8_lossy(&run.stderr);
        told.lines().filter(|line| line.contains("done before")).count()
    };
    let first = manifest(out.path());
    assert_eq!(done_before(&batch(input.path(), out.path(), &[])), 3, "all but the broken one");
    // The run before it was ended in the middle of a line.
    let path = out.path().join("manifest.jsonl");
    let text = fs::read_to_string(&path).expect("a manifest");
    fs::write(&path, &text[..text.len() - 30]).expect("a manifest");
    assert_eq!(done_before(&batch(input.path(), out.path(), &[])), 2, "the torn line is lost");
    quadmend::io::write(&input.path().join("a.obj"), &messy(7)).expect("a mesh");
    fs::write(out.path().join("b.obj"), "damaged").expect("a file");
    assert_eq!(done_before(&batch(input.path(), out.path(), &[])), 1, "a and b are done again");
    let other = ["--set", "smooth.iterations=100"];
    assert_eq!(done_before(&batch(input.path(), out.path(), &other)), 0, "other settings");
    let hash = |lines: &[Value], i: usize| lines[i]["output_sha256"].clone();
    batch(input.path(), out.path(), &[]);
    let last = manifest(out.path());
    assert_eq!(last.len(), first.len(), "one line a mesh");
    assert_eq!(hash(&first, 1), hash(&last, 1), "the same again");
    assert_ne!(hash(&first, 0), hash(&last, 0), "another mesh");
}

#[test]
fn limits_of_time_and_memory_hold_for_each_mesh() {
    let (input, out) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    inputs(input.path());
    let run = batch(input.path(), out.path(), &["--memory-limit", "0.001"]);
    assert_eq!(run.status.code(), Some(3));
    let refused = ["too-large", "too-large", "refused", "too-large"];
    assert_eq!(statuses(out.path()), refused);
    fs::remove_file(input.path().join("broken.obj")).expect("a file");
    fs::remove_file(out.path().join("manifest.jsonl")).expect("a file");
    let run = batch(input.path(), out.path(), &["--time-limit", "0"]);
    assert_eq!(run.status.code(), Some(0), "a mesh whose time is over is a result");
    assert_eq!(statuses(out.path()), ["time-limit"; 3]);
    let again = batch(input.path(), out.path(), &["--time-limit", "0"]);
    assert!(String::from_utf8_lossy(&again.stderr).matches("done before").count() == 3);
    let run = batch(input.path(), out.path(), &["--time-limit", "60"]);
    assert_eq!(run.status.code(), Some(0));
    assert_eq!(statuses(out.path()), ["cleaned"; 3], "more time may give a better mesh");
}

#[test]
fn references_are_found_by_name_and_a_missing_one_is_told() {
    let (input, out) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let surfaces = tempfile::tempdir().unwrap();
    inputs(input.path());
    fs::remove_file(input.path().join("broken.obj")).expect("a file");
    let fine = shapes::torus(64, 32);
    for name in ["a.ref.obj", "b.obj"] {
        quadmend::io::write(&surfaces.path().join(name), &fine).expect(name);
    }
    let folder = surfaces.path().display().to_string();
    let run = batch(input.path(), out.path(), &["--reference-dir", &folder]);
    assert_eq!(run.status.code(), Some(3));
    assert_eq!(statuses(out.path()), ["cleaned", "cleaned", "refused"]);
    let lines = manifest(out.path());
    assert!(lines[0]["reference"].as_str().is_some_and(|file| file.ends_with("a.ref.obj")));
    assert!(lines[2]["error"].as_str().is_some_and(|error| error.contains("no surface c <i>&")));
}

#[test]
fn results_that_would_meet_are_refused_before_the_work() {
    let (input, out) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    inputs(input.path());
    let run = batch(input.path(), input.path(), &[]);
    assert_eq!(run.status.code(), Some(2), "inputs would be replaced");
    let other = input.path().join("other");
    fs::create_dir(&other).expect("a folder");
    fs::copy(input.path().join("a.obj"), other.join("a.obj")).expect("a file");
    let other = other.display().to_string();
    let run = batch(input.path(), out.path(), &[&other]);
    assert_eq!(run.status.code(), Some(2), "two meshes of one name");
    assert!(String::from_utf8_lossy(&run.stderr).contains("same name"));
}
