//! Instructions that small runs take, counted by valgrind: a slow-down fails on any machine,
//! however busy.
//!
//! Skipped, loudly, where there is no valgrind. After a change that is meant, put in the count
//! that the test tells.

mod common;

use common::lifted::{Dice, lifted, mess_up};
use common::say;
use quadmend::mesh::shapes;
use quadmend::sqrtcc::lower;
use std::path::Path;
use std::process::Command;

/// Compilers and allocators differ by so much; a slow-down that matters is more.
const SLACK: f64 = 1.25;

/// What is run, and the millions of instructions that it took when that was last looked at.
const RUNS: [(&str, &str, f64); 3] = [
    ("reading and measuring", "metrics mesh.obj -r fine.obj", 165.0),
    ("smoothing", "clean mesh.obj -r fine.obj -o out.obj --set plan.stages=0", 1628.0),
    ("planning", "clean mesh.obj -r fine.obj -o out.obj --set plan.stages=1", 1464.0),
];

/// Millions of instructions of a run in `folder`; nothing if there is no valgrind.
fn count(folder: &Path, arguments: &str) -> Option<f64> {
    let run = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(env!("CARGO_BIN_EXE_quadmend"))
        .args(arguments.split(' '))
        .args(["-j", "1", "-q", "--set", "measure.samples=5000"])
        .current_dir(folder)
        .output()
        .ok()?;
    let told = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.code().is_some_and(|code| code < 2), "{arguments}: {told}");
    let collected = told.lines().find_map(|line| line.split("Collected :").nth(1));
    let number = collected.unwrap_or_else(|| panic!("valgrind tells no count: {told}"));
    Some(number.trim().parse::<f64>().expect("a number") / 1e6)
}

#[test]
fn small_runs_take_no_more_instructions_than_before() {
    if !cfg!(debug_assertions) {
        say("SKIPPED: instruction counts are those of the test profile");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut q = lifted(&shapes::sphere(8));
    mess_up(&mut q, &mut Dice(0), 12);
    let messy = lower(&q, &[String::new()]).expect("a sphere").mesh;
    for (name, mesh) in [("mesh.obj", &messy), ("fine.obj", &shapes::sphere(24))] {
        quadmend::io::write(&folder.path().join(name), mesh).expect(name);
    }
    let mut slow = Vec::new();
    for (what, arguments, before) in RUNS {
        let Some(now) = count(folder.path(), arguments) else {
            say("SKIPPED: no valgrind here to count instructions with");
            return;
        };
        let line = format!("{what}: {now:.0} million instructions, {before:.0} before");
        say(&line);
        if now > SLACK * before {
            slow.push(line);
        }
    }
    assert!(slow.is_empty(), "slower than before: {slow:?}");
}
