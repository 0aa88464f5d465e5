//! What happens when writing fails or the program is killed: the old file stays, or the new one is
//! whole.

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use quadmend::io;
use quadmend::mesh::shapes;

mod common;

const SAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/bracket.obj");
const QUICK: [&str; 8] = [
    "--set",
    "plan.stages=1",
    "--set",
    "smooth.iterations=3",
    "--set",
    "measure.samples=1000",
    "-j",
    "1",
];

fn quadmend(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_quadmend"));
    command.current_dir(folder).args(arguments).stdin(Stdio::null());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    quadmend(folder, arguments).output().unwrap()
}

fn told(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Random numbers below one, others for every run of the test.
fn shares() -> impl Iterator<Item = f64> {
    let seed = std::process::id();
    let mut state = u64::from(seed) | 1;
    std::iter::repeat_with(move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24)
    })
}

#[test]
fn killed_at_any_moment_the_output_is_the_old_or_the_new_one() {
    let folder = tempfile::tempdir().unwrap();
    // No edits: reading, measuring and writing are what can be caught in the middle.
    io::write(&folder.path().join("in.obj"), &shapes::torus(40, 25)).unwrap();
    let clean = ["clean", "in.obj", "-o", "out.obj", "--json", "report.json"];
    let quick = ["--set", "plan.stages=1", "--set", "smooth.iterations=0"];
    let arguments: Vec<&str> = clean.iter().chain(&quick).chain(&QUICK[4..]).copied().collect();
    let began = Instant::now();
    let whole = run(folder.path(), &arguments);
    let mut longest = began.elapsed();
    assert!(matches!(whole.status.code(), Some(0 | 1)), "{}", told(&whole));
    let new = ["out.obj", "report.json"].map(|name| fs::read(folder.path().join(name)).unwrap());
    let mut killed = 0;
    for share in shares().take(400) {
        if killed == 50 {
            break;
        }
        let moment = longest.mul_f64(share);
        for name in ["out.obj", "report.json"] {
            fs::write(folder.path().join(name), "old").unwrap();
        }
        let mut child = quadmend(folder.path(), &arguments).spawn().unwrap();
        std::thread::sleep(moment);
        child.kill().unwrap();
        if child.wait().unwrap().code().is_none() {
            killed += 1;
        } else {
            // On a machine that was busy at first, a run is over sooner than the first one.
            longest = moment;
        }
        for (name, new) in ["out.obj", "report.json"].iter().zip(&new) {
            let now = fs::read(folder.path().join(name)).unwrap();
            assert!(now == b"old" || now == *new, "{name} is neither after {moment:?}");
        }
    }
    assert_eq!(killed, 50, "too few were still running when they were killed");
}

#[test]
fn a_full_disk_is_told_with_the_name_of_the_file() {
    if !Path::new("/dev/full").exists() {
        return common::say("SKIPPED: a full disk: there is no /dev/full");
    }
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("full.obj");
    #[cfg(unix)]
    std::os::unix::fs::symlink("/dev/full", &output).unwrap();
    let more = ["clean", SAMPLE, "-o", "full.obj"];
    let failed = run(folder.path(), &more.iter().chain(&QUICK).copied().collect::<Vec<_>>());
    assert_eq!(failed.status.code(), Some(2), "{}", told(&failed));
    assert!(told(&failed).contains("full.obj: cannot be written"), "{}", told(&failed));
    // On standard output, and for a report; the mesh is whole by then.
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let failed = quadmend(folder.path(), &["metrics", SAMPLE]).stdout(full).output().unwrap();
    assert_eq!(failed.status.code(), Some(2));
    assert!(told(&failed).contains("standard output: cannot be written"), "{}", told(&failed));
    let report = ["clean", SAMPLE, "-o", "out.obj", "--json", "full.obj"];
    let failed = run(folder.path(), &report.iter().chain(&QUICK).copied().collect::<Vec<_>>());
    assert_eq!(failed.status.code(), Some(2));
    assert!(told(&failed).contains("full.obj: cannot be written"), "{}", told(&failed));
    assert!(io::read(&folder.path().join("out.obj")).is_ok());
}

/// A file system of one page, if we may mount one.
#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_fills_while_writing_keeps_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    io::write(&folder.path().join("in.obj"), &shapes::torus(40, 30)).unwrap();
    fs::create_dir(folder.path().join("small")).unwrap();
    let script = "mount -t tmpfs -o size=16k none small && echo old > small/out.obj && \
        { \"$0\" clean in.obj -o small/out.obj --set plan.stages=1 --set measure.samples=1000 -q; \
        echo \"code $?\"; cat small/out.obj; ls -A small; }";
    let output = Command::new("unshare")
        .args(["-rm", "sh", "-c", script, env!("CARGO_BIN_EXE_quadmend")])
        .current_dir(folder.path())
        .output();
    // Whether the script got as far as running the command.
    let ran = output.ok().filter(|o| String::from_utf8_lossy(&o.stdout).contains("code"));
    let Some(output) = ran else {
        return common::say("SKIPPED: a disk that fills: no small file system can be mounted here");
    };
    let shown = String::from_utf8_lossy(&output.stdout);
    assert_eq!(shown, "code 2\nold\nout.obj\n", "{}", told(&output));
    assert!(told(&output).contains("small/out.obj: cannot be written"), "{}", told(&output));
}

#[cfg(unix)]
#[test]
fn places_that_cannot_be_written_are_refused_before_the_work() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("kept.obj"), "old").unwrap();
    let protect = |name: &str, mode| {
        fs::set_permissions(folder.path().join(name), fs::Permissions::from_mode(mode)).unwrap();
    };
    protect("kept.obj", 0o444);
    fs::create_dir(folder.path().join("closed")).unwrap();
    protect("closed", 0o555);
    let mut places = vec![("nowhere/out.obj", "does not exist"), ("kept.obj", "write-protected")];
    // The superuser may write there all the same.
    if fs::write(folder.path().join("closed/probe"), "").is_err() {
        places.push(("closed/out.obj", "cannot be written"));
    } else {
        common::say("SKIPPED: a read-only folder: the superuser may write there");
    }
    for (place, words) in places {
        for arguments in [["-o", place, "--json", "r.json"], ["-o", "out.obj", "--json", place]] {
            let began = Instant::now();
            let failed = run(folder.path(), &[&["clean", SAMPLE][..], &arguments].concat());
            assert_eq!(failed.status.code(), Some(2), "{place}: {}", told(&failed));
            let message = told(&failed);
            assert!(message.contains(place) && message.contains(words), "{message}");
            assert!(!message.contains("mended"), "the work was done before: {message}");
            assert!(began.elapsed() < Duration::from_secs(5));
            assert!(!folder.path().join("out.obj").exists());
        }
    }
    protect("closed", 0o755);
    assert_eq!(fs::read_to_string(folder.path().join("kept.obj")).unwrap(), "old");
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let folder = tempfile::tempdir().unwrap();
    // More than a pipe holds.
    io::write(&folder.path().join("in.obj"), &shapes::torus(100, 60)).unwrap();
    let clean = ["clean", "in.obj", "-o", "-", "--json", "r.json", "--set", "plan.stages=1"];
    for format in ["obj", "ply", "off"] {
        let more = ["--format", format, "--set", "smooth.iterations=0"];
        let arguments: Vec<&str> = clean.iter().chain(&more).chain(&QUICK[4..]).copied().collect();
        let mut child = quadmend(folder.path(), &arguments).spawn().unwrap();
        let mut start = [0; 64];
        let mut out = child.stdout.take().unwrap();
        out.read_exact(&mut start).unwrap();
        drop(out);
        let ended = child.wait_with_output().unwrap();
        assert!(matches!(ended.status.code(), Some(0 | 1)), "{format}: {}", told(&ended));
        assert!(!told(&ended).contains("error"), "{}", told(&ended));
        assert!(folder.path().join("r.json").exists(), "the report is written all the same");
        fs::remove_file(folder.path().join("r.json")).unwrap();
    }
}
