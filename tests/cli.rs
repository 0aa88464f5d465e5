//! The command as a script sees it: exit codes, what goes to which stream, which files are left.

use std::ffi::OsStr;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The sample mesh of the demo and its reference.
const SAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/bracket.obj");
const REFERENCE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/bracket.ref.obj");

/// A run of the command in a folder of its own.
struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// Names of the files in the folder, sorted.
    fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> =
            entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn run<S: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = S>) -> Run {
        self.run_with("", arguments)
    }

    fn run_with<S: AsRef<OsStr>>(&self, input: &str, args: impl IntoIterator<Item = S>) -> Run {
        let mut child = Command::new(env!("CARGO_BIN_EXE_quadmend"))
            .current_dir(self.folder.path())
            .args(args)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // A command that refuses its options does not read its input.
        let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
        Run::new(child.wait_with_output().unwrap())
    }
}

struct Run {
    code: i32,
    out: String,
    err: String,
}

impl Run {
    fn new(output: Output) -> Self {
        Self {
            code: output.status.code().expect("not killed"),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Asserts a failure: this code, nothing on standard output, one error in which all of these
    /// occur, and no trace of the program's inside.
    #[track_caller]
    fn fails(&self, code: i32, told: &[&str]) {
        assert_eq!((self.code, self.out.as_str()), (code, ""), "{}", self.err);
        assert_eq!(self.err.matches("error:").count(), 1, "{}", self.err);
        for words in told {
            assert!(self.err.contains(words), "`{words}` is missing in: {}", self.err);
        }
        assert!(!self.err.contains("panicked") && !self.err.contains("backtrace"), "{}", self.err);
    }

    #[track_caller]
    fn ends(&self, code: i32) -> &Self {
        assert_eq!(self.code, code, "{}{}", self.out, self.err);
        self
    }
}

/// A flat grid of n by n squares; nothing is irregular.
fn grid(n: usize) -> String {
    let pairs = |m: usize| (0..m).flat_map(move |i| (0..m).map(move |j| (i, j)));
    let vertex = |i: usize, j: usize| i * (n + 1) + j + 1;
    let points = pairs(n + 1).map(|(i, j)| format!("v {i} {j} 0"));
    let faces = pairs(n).map(|(i, j)| {
        let [a, b] = [vertex(i, j), vertex(i + 1, j)];
        format!("f {a} {b} {} {}", b + 1, a + 1)
    });
    points.chain(faces).collect::<Vec<_>>().join("\n") + "\n"
}

/// The value at a path of keys.
fn number(json: &serde_json::Value, keys: [&str; 3]) -> f64 {
    keys.iter().fold(json, |value, key| &value[key]).as_f64().unwrap()
}

#[test]
fn clean_writes_the_mesh_and_tells_before_and_after() {
    let bench = Bench::new();
    let arguments =
        ["clean", SAMPLE, "--reference", REFERENCE, "-o", "out.obj", "--json", "r.json"];
    let shown =
        ["--report", "r.html", "--pictures", "p", "--size", "160x120", "--heat", "distance"];
    let run = bench.run(arguments.iter().chain(&shown));
    run.ends(0);
    assert!(run.out.contains("irregular elements E") && run.out.contains("better"), "{}", run.out);
    assert!(run.err.contains("mended: 1 doublet"), "{}", run.err);
    assert_eq!(bench.files(), ["out.obj", "p", "r.html", "r.json"]);
    for view in ["corner", "behind"] {
        for (when, field) in ["before", "after"].iter().flat_map(|w| [(w, ""), (w, "-distance")]) {
            assert!(bench.path(&format!("p/{when}-{view}{field}.png")).is_file());
        }
    }
    assert!(bench.read("r.html").starts_with("<!doctype html>"));
    let report: serde_json::Value = serde_json::from_str(&bench.read("r.json")).unwrap();
    let elements =
        ["before", "after"].map(|m| number(&report, [m, "summary", "irregular_elements"]));
    assert!(elements[1] < 0.5 * elements[0], "{elements:?}");
    // What was reported about the mesh is what the file has.
    let measured = bench.run(["metrics", "out.obj", "--json"]);
    let measured: serde_json::Value = serde_json::from_str(&measured.ends(0).out).unwrap();
    assert_eq!(measured["topology"], report["after"]["topology"]);
}

#[test]
fn pipes_carry_the_mesh_alone_and_threads_do_not_change_it() {
    let bench = Bench::new();
    let sample = fs::read_to_string(SAMPLE).unwrap();
    let one = bench.run_with(&sample, ["clean", "-", "-r", REFERENCE, "-o", "-", "-j", "1", "-q"]);
    one.ends(0);
    assert_eq!(one.err, "", "quiet means quiet");
    assert!(one.out.lines().all(|l| ["v ", "f ", "g ", "# "].iter().any(|p| l.starts_with(p))));
    let two = bench.run_with(&sample, ["clean", "-", "-r", REFERENCE, "-o", "-", "-j", "2"]);
    assert_eq!(two.ends(0).out, one.out);
    assert!(two.err.contains("irregular elements E"), "the table makes room: {}", two.err);
    assert_eq!(bench.files(), [""; 0]);
}

#[test]
fn a_clean_mesh_is_written_and_told_by_the_exit_code() {
    let bench = Bench::new();
    let run = bench.run_with(&grid(8), ["clean", "-", "-o", "out.obj"]);
    run.ends(1);
    assert!(run.err.contains("no edit found"), "{}", run.err);
    assert_eq!(bench.read("out.obj").lines().filter(|l| l.starts_with("f ")).count(), 64);
}

#[test]
fn bad_input_leaves_no_output() {
    let bench = Bench::new();
    fs::create_dir(bench.path("folder.obj")).unwrap();
    bench.write("empty.obj", "");
    bench.write("cloud.obj", "v 0 0 0\nv 1 0 0\n");
    bench.write("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    bench.write("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
    bench.write("words.obj", "v 0 0 0\nv 1 0 zero\n");
    bench.write("binary.obj", "v 0 0 0\n\0\0\0");
    let files = bench.files();
    for (name, told) in [
        ("missing.obj", "no such file"),
        ("folder.obj", "is a folder"),
        ("empty.obj", "empty"),
        ("cloud.obj", "no faces"),
        ("range.obj", "range.obj:4"),
        ("nan.obj", "nan.obj:2"),
        ("words.obj", "words.obj:2"),
        ("binary.obj", "not a text file"),
    ] {
        bench.run(["clean", name, "-o", "out.obj", "--json", "out.json"]).fails(3, &[name, told]);
        bench.run(["metrics", name]).fails(3, &[name, told]);
    }
    assert_eq!(bench.files(), files);
}

#[test]
fn strict_refuses_what_would_be_mended() {
    let bench = Bench::new();
    bench.write("stray.obj", &format!("v 7 7 7\n{}", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n"));
    let arguments = ["clean", "stray.obj", "-o", "out.obj", "--strict"];
    bench.run(arguments).fails(3, &["stray.obj", "vertex 0"]);
    assert_eq!(bench.files(), ["stray.obj"]);
}

#[test]
fn an_input_is_overwritten_only_by_force() {
    let bench = Bench::new();
    let mesh = grid(4);
    bench.write("in.obj", &mesh);
    bench.write("scan.obj", &mesh);
    bench.write("my.toml", "");
    for outputs in [
        ["-o", "in.obj", "--json", "r.json"],
        ["-o", "./in.obj", "--json", "r.json"],
        ["-o", "scan.obj", "--json", "r.json"],
        ["-o", "out.obj", "--json", "in.obj"],
        ["-o", "out.obj", "--json", "my.toml"],
    ] {
        let inputs = ["clean", "in.obj", "-r", "scan.obj", "--config", "my.toml"];
        bench.run(inputs.iter().chain(&outputs)).fails(2, &["--force"]);
    }
    assert_eq!(bench.files(), ["in.obj", "my.toml", "scan.obj"]);
    assert_eq!((bench.read("in.obj"), bench.read("scan.obj")), (mesh.clone(), mesh));
    bench.run(["clean", "in.obj", "-o", "in.obj", "--force"]).ends(1);
    assert_eq!(bench.files(), ["in.obj", "my.toml", "scan.obj"]);
}

#[test]
fn outputs_that_have_nowhere_to_go_are_refused_before_the_work() {
    let bench = Bench::new();
    bench.write("in.obj", &grid(4));
    for (output, told) in [
        ("nowhere/out.obj", "does not exist"),
        ("out.xyz", ".obj, .ply, .off"),
        (".", "is a folder"),
    ] {
        bench.run(["clean", "in.obj", "-o", output]).fails(2, &[output, told]);
    }
    let report = ["clean", "in.obj", "-o", "out.obj", "--json", "nowhere/r.json"];
    bench.run(report).fails(2, &["nowhere/r.json"]);
    let twice = ["clean", "in.obj", "-o", "-", "--json", "-"];
    bench.run(twice).fails(2, &["two outputs"]);
    let report = ["clean", "in.obj", "-o", "out.obj", "--report", "nowhere/r.html"];
    bench.run(report).fails(2, &["nowhere/r.html"]);
    bench.run(["clean", "in.obj", "-o", "out.obj", "--view", "top"]).fails(2, &["--pictures"]);
    bench.run(["clean", "in.obj", "-o", "o.obj", "--pictures", "in.obj"]).fails(2, &["in.obj"]);
    bench.run(["clean", "-", "-r", "-", "-o", "out.obj"]).fails(2, &["standard input"]);
    assert_eq!(bench.files(), ["in.obj"]);
}

#[test]
fn wrong_configurations_name_the_nearest_right_one() {
    let bench = Bench::new();
    bench.write("in.obj", &grid(4));
    bench.write("my.toml", "[smooth]\n\niteration = 3\n");
    let clean =
        |more: [&str; 2]| bench.run(["clean", "in.obj", "-o", "out.obj"].iter().chain(&more));
    clean(["--set", "smooth.iteratoins=3"]).fails(2, &["smooth.iterations"]);
    clean(["--set", "smoth.iterations=3"]).fails(2, &["`smooth`"]);
    clean(["--set", "smooth.iterations=-3"]).fails(2, &["nearest legal value"]);
    clean(["--set", "smooth.iterations"]).fails(2, &["section.key=value"]);
    clean(["--config", "my.toml"]).fails(2, &["my.toml:3", "smooth.iterations"]);
    clean(["--preset", "blanced"]).fails(2, &["balanced"]);
    clean(["--fail-if", "irregulars>3"]).fails(2, &["irregular_elements"]);
    bench.run(["config", "check", "my.toml"]).fails(2, &["my.toml:3"]);
    assert_eq!(bench.files(), ["in.obj", "my.toml"]);
}

#[test]
fn limits_are_told_by_the_exit_code() {
    let bench = Bench::new();
    let kept = bench.run(["metrics", SAMPLE, "--fail-if", "irregular_elements>318"]);
    kept.ends(0);
    let missed = bench.run(["metrics", SAMPLE, "--fail-if", "irregular_elements>317"]);
    missed.ends(4);
    assert_eq!(missed.out, kept.out);
    assert!(missed.err.contains("irregular_elements = 318 is above 317"), "{}", missed.err);
}

#[test]
fn compare_puts_meshes_side_by_side() {
    let bench = Bench::new();
    bench.write("a.obj", &grid(4));
    bench.write("b.obj", &grid(5));
    let two = bench.run(["compare", "a.obj", "b.obj", "-r", "b.obj"]);
    let header = two.ends(0).out.lines().next().unwrap_or_default().to_owned();
    assert_eq!(header.split_whitespace().collect::<Vec<_>>(), ["a.obj", "b.obj", "change"]);
    assert!(two.out.contains("Hausdorff"), "{}", two.out);
    let three = bench.run(["compare", "a.obj", "b.obj", "a.obj", "--json"]);
    let rows: serde_json::Value = serde_json::from_str(&three.ends(0).out).unwrap();
    assert_eq!(rows.as_array().unwrap().len(), 3);
    assert_eq!(rows[1]["file"], "b.obj");
    assert_eq!(rows[1]["metrics"]["summary"]["F"], 25);
}

#[test]
fn compare_writes_csv_and_a_report() {
    let bench = Bench::new();
    bench.write("a,b.obj", &grid(4));
    bench.write("b.obj", &grid(5));
    let run = bench.run(["compare", "a,b.obj", "b.obj", "b.obj", "--csv", "--report", "r.html"]);
    let rows: Vec<Vec<&str>> =
        run.ends(0).out.lines().map(|line| line.rsplit(',').collect()).collect();
    assert_eq!(rows.len(), 4);
    assert_eq!(rows[2].len(), rows[0].len());
    assert!(run.out.starts_with("file,V,E,F,") && run.out.contains("\n\"a,b.obj\",25,40,16,"));
    assert!(bench.read("r.html").contains("three"));
    let piped = bench.run(["compare", "a,b.obj", "b.obj", "--report", "-"]);
    assert!(piped.ends(0).out.starts_with("<!doctype html>"));
    bench.run(["compare", "b.obj", "b.obj", "--report", "b.obj"]).fails(2, &["--force"]);
    bench.run(["compare", "b.obj", "b.obj", "--report", "no/r.html"]).fails(2, &["no/r.html"]);
    bench.run(["compare", "b.obj", "b.obj", "--csv", "--json"]).fails(2, &["--json"]);
}

#[test]
fn render_draws_meshes_side_by_side() {
    let bench = Bench::new();
    bench.write("a.obj", &grid(4));
    let size = |name: &str| {
        let bytes = fs::read(bench.path(name)).unwrap();
        let side = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
        [side(16), side(20)]
    };
    let plain = ["render", "a.obj", "a.obj", "-o", "p.png", "--size", "200x100", "--no-legend"];
    bench.run(plain.iter().chain(&["--view", "top", "--view", "-30,20", "--view", "left"])).ends(0);
    assert_eq!(size("p.png"), [400, 300]);
    bench.run(["render", "a.obj", "-o", "q.png", "-r", "a.obj", "--heat", "distance"]).ends(0);
    assert_eq!(size("q.png")[0], 1200);
    for (more, told) in [
        (["--heat", "distance"], "--reference"),
        (["--heat", "ugliness"], "planarity"),
        (["--view", "iso"], "corner"),
        (["--size", "big"], "1200x900"),
        (["--size", "99999x99999"], "100 million"),
        (["-o", "a.obj"], "--force"),
        (["-o", "no/p.png"], "no/p.png"),
    ] {
        let output: &[&str] = if more[0] == "-o" { &[] } else { &["-o", "r.png"] };
        bench.run(["render", "a.obj"].iter().chain(output).chain(&more)).fails(2, &[told]);
    }
    bench.run(["render", "none.obj", "-o", "r.png"]).fails(3, &["none.obj"]);
    assert_eq!(bench.files(), ["a.obj", "p.png", "q.png"]);
}

#[test]
fn plan_shows_the_edits_and_writes_nothing() {
    let bench = Bench::new();
    let table = bench.run(["plan", SAMPLE, "-r", REFERENCE]);
    assert!(table.ends(0).out.contains("removed") && table.out.contains("(step "), "{}", table.out);
    let json = bench.run(["plan", SAMPLE, "-r", REFERENCE, "--json"]);
    let edits: serde_json::Value = serde_json::from_str(&json.ends(0).out).unwrap();
    let edits = edits.as_array().unwrap();
    assert_eq!(edits.len(), table.out.lines().count() - 1);
    assert!(edits.iter().all(|e| e["kind"].is_string() && e["cost"].is_number()));
    assert_eq!(bench.files(), [""; 0]);
}

#[test]
fn the_demo_leaves_meshes_and_reports() {
    let bench = Bench::new();
    let run = bench.run(["demo"]);
    run.ends(0);
    let folder = Path::new("quadmend-demo");
    for name in
        ["input.obj", "reference.obj", "clean.obj", "report.html", "report.json", "report.txt"]
    {
        let path = folder.join(name);
        assert!(bench.path(path.to_str().unwrap()).is_file(), "{name} is missing");
        assert!(run.out.contains(path.to_str().unwrap()), "{name} is not told: {}", run.out);
    }
    let report = bench.read("quadmend-demo/report.txt");
    assert!(run.out.starts_with(&report) && report.contains("irregular elements E"), "{report}");
}

#[test]
fn the_configuration_shows_checks_and_explains_itself() {
    let bench = Bench::new();
    let shown = bench.run(["config", "show", "--set", "smooth.iterations=7"]);
    assert!(shown.ends(0).out.contains("iterations = 7\n"), "{}", shown.out);
    bench.write("my.toml", &shown.out);
    bench.run(["config", "check", "my.toml"]).ends(0);
    let again = bench.run(["config", "show", "--config", "my.toml"]);
    assert_eq!(again.ends(0).out, shown.out);
    let explained = bench.run(["config", "explain", "smooth.iterations"]);
    assert!(explained.ends(0).out.contains("default"), "{}", explained.out);
    bench.run(["config", "explain", "smooth.iteration"]).fails(2, &["smooth.iterations"]);
    assert!(bench.run(["config", "explain"]).ends(0).out.contains("smooth"));
    let schema = bench.run(["config", "schema"]);
    assert!(serde_json::from_str::<serde_json::Value>(&schema.ends(0).out).is_ok());
}

/// Cuts a pentagon and a triangle out of the grid, then smooths.
const EDITS: &str = "
    [[step]]
    do = 'edge-shift'
    fixed = { vertex = 41 }
    from = { vertex = 42 }
    to = { vertex = 33 }

    [[step]]
    do = 'smooth'
    iterations = 3
";

#[test]
fn edit_writes_the_mesh_and_logs_each_step() {
    let bench = Bench::new();
    bench.write("in.obj", &grid(8));
    bench.write("edits.toml", EDITS);
    let run = bench.run(["edit", "in.obj", "--script", "edits.toml", "-o", "out.obj"]);
    run.ends(0);
    assert_eq!(run.out, "");
    assert!(run.err.contains("step 1: edge-shift: now at vertex 33 (E 0 → 4"), "{}", run.err);
    assert!(run.err.contains("step 2: smooth: 3 iterations"), "{}", run.err);
    let measured = bench.run(["metrics", "out.obj", "--json"]);
    let measured: serde_json::Value = serde_json::from_str(&measured.ends(0).out).unwrap();
    assert_eq!(measured["summary"]["irregular_elements"], 4);
    // The same from a pipe, with the log as JSON.
    let piped = ["edit", "-", "-s", "edits.toml", "-o", "-", "--json", "log.json", "-q"];
    let piped = bench.run_with(&grid(8), piped);
    assert_eq!((piped.ends(0).out.as_str(), piped.err.as_str()), (&*bench.read("out.obj"), ""));
    let log: serde_json::Value = serde_json::from_str(&bench.read("log.json")).unwrap();
    assert_eq!(
        (&log["steps"][0]["ops"][0]["op"], &log["steps"][0]["after"]),
        (&"flip".into(), &4.into())
    );
    let dry = bench.run(["edit", "in.obj", "--script", "edits.toml", "--dry-run", "-o", "dry.obj"]);
    assert!(dry.ends(0).err.contains("step 2"), "{}", dry.err);
    assert_eq!(bench.files(), ["edits.toml", "in.obj", "log.json", "out.obj"]);
}

#[test]
fn the_logs_of_clean_and_plan_replay_to_the_same_bytes() {
    let bench = Bench::new();
    let surface = ["-r", REFERENCE, "--set", "plan.stages=1", "--set", "smooth.iterations=20"];
    let run = |command: &[&str]| bench.run(command.iter().chain(&surface));
    run(&["clean", SAMPLE, "-o", "clean.obj", "--log", "clean.toml"]).ends(0);
    run(&["plan", SAMPLE, "-o", "plan.toml"]).ends(0);
    assert_eq!(bench.read("plan.toml"), bench.read("clean.toml"));
    run(&["edit", SAMPLE, "--script", "plan.toml", "-o", "edited.obj", "-q"]).ends(0);
    assert!(bench.read("edited.obj") == bench.read("clean.obj"));

    bench.write("wrong.toml", &bench.read("plan.toml").replacen("start = ", "start = 99", 1));
    let wrong = run(&["edit", SAMPLE, "--script", "wrong.toml", "-o", "edited.obj"]);
    wrong.fails(3, &["step ", "walk", "no adjacent pair"]);
    assert!(bench.read("edited.obj") == bench.read("clean.obj"), "the output is untouched");
    run(&["clean", SAMPLE, "-o", "o.obj", "--log", SAMPLE]).fails(2, &["would be overwritten"]);
    run(&["plan", SAMPLE, "-o", "nowhere/edits.toml"]).fails(2, &["nowhere"]);
    run(&["plan", SAMPLE, "-o", "-", "--json"]).fails(2, &["--json"]);
}

#[test]
fn a_wrong_script_never_changes_the_output() {
    let bench = Bench::new();
    bench.write("in.obj", &grid(8));
    bench.write("out.obj", "as it was");
    let refused = EDITS.replace("vertex = 33", "vertex = 1");
    for (script, code, told) in [
        (refused.as_str(), 3, &["step 1 (edge-shift, line 2)", "vertex 41", "not joined"][..]),
        ("[[step]]\ndo = 'edge-shft'", 2, &["edits.toml:1", "did you mean `edge-shift`"]),
        ("[[step]]\ndo = 'merge'", 2, &["edits.toml:1", "missing field `at`"]),
        ("no = script", 2, &["edits.toml:1"]),
    ] {
        bench.write("edits.toml", script);
        bench.run(["edit", "in.obj", "--script", "edits.toml", "-o", "out.obj"]).fails(code, told);
        assert_eq!(bench.read("out.obj"), "as it was", "{script}");
    }
    let missing = ["edit", "in.obj", "--script", "none.toml", "-o", "out.obj"];
    bench.run(missing).fails(2, &["none.toml"]);
    bench.write("edits.toml", EDITS);
    let over = ["edit", "in.obj", "--script", "edits.toml", "-o", "edits.toml"];
    bench.run(over).fails(2, &["would be overwritten"]);
    // Going on: the smoothing is made; alone, the refused step is nothing.
    bench.write("edits.toml", &refused);
    let on = ["edit", "in.obj", "--script", "edits.toml", "-o", "out.obj", "--keep-going"];
    assert!(bench.run(on).ends(0).err.contains("refused: step 1"));
    bench.write("edits.toml", refused.split("[[step]]\n    do = 'smooth'").next().unwrap());
    bench.run(on).ends(1);
}

#[test]
fn help_teaches() {
    let bench = Bench::new();
    let help = bench.run(["--help"]);
    assert!(help.ends(0).out.contains("Exit codes:") && help.out.contains("Examples:"));
    for command in ["clean", "metrics", "compare", "plan", "edit", "render", "demo", "config"] {
        let help = bench.run([command, "--help"]);
        let teaches = help.out.contains("Examples:") || help.out.contains("Files:");
        assert!(help.code == 0 && teaches, "{command}: {}", help.out);
    }
    assert!(bench.run(["generate", "man"]).ends(0).out.contains(".TH"));
    assert!(bench.run(["generate", "completions", "bash"]).ends(0).out.contains("quadmend"));
    bench.run(["claen"]).fails(2, &["clean"]);
    assert_eq!(bench.run([""; 0]).code, 2);
}

#[test]
fn convert_makes_pure_quads_and_tells() {
    let bench = Bench::new();
    let run = bench.run([
        "convert",
        SAMPLE,
        "--to",
        "pure-quad",
        "--reference",
        REFERENCE,
        "-o",
        "quads.obj",
        "--json",
        "report.json",
    ]);
    let report: serde_json::Value = serde_json::from_str(&bench.read("report.json")).unwrap();
    let left = report["conversion"]["left"].as_array().unwrap().len();
    run.ends(if left == 0 { 0 } else { 4 });
    assert_eq!(run.err.matches("not a quad:").count(), left, "{}", run.err);
    assert!(run.out.contains("before") && run.err.contains("pairs converted"), "{}", run.err);
    let odd = |line: &&str| line.starts_with("f ") && line.split(' ').count() != 5;
    assert_eq!(bench.read("quads.obj").lines().filter(odd).count(), left);
}

#[test]
fn convert_tells_what_parity_stops() {
    let bench = Bench::new();
    bench.write("odd.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3 4\nf 2 5 3\n");
    let run = bench.run(["convert", "odd.obj", "--to", "pure-quad", "-o", "out.obj"]);
    run.ends(4);
    assert!(run.err.contains("5 boundary and feature edges; that number is odd"), "{}", run.err);
    assert!(bench.files().contains(&"out.obj".to_owned()));
}

#[test]
fn a_regular_mesh_has_nothing_to_convert() {
    let bench = Bench::new();
    bench.write("in.obj", &grid(4));
    bench.run(["convert", "in.obj", "--to", "pure-quad", "-o", "out.obj"]).ends(1);
    assert!(bench.files().contains(&"out.obj".to_owned()));
}

#[test]
fn convert_to_sqrtcc_and_back_gives_the_same_mesh() {
    let bench = Bench::new();
    bench.write("in.obj", &grid(4));
    for kind in ["dual", "catmull-clark", "sqrtcc"] {
        bench.run(["convert", "in.obj", "--to", kind, "-o", "view.obj"]).ends(0);
        let vertex = bench.read("view.obj").lines().next().unwrap().split(' ').count();
        assert_eq!(vertex, 7, "{kind}: coordinates and a colour");
    }
    bench.run(["convert", "view.obj", "--to", "primal", "-o", "again.obj"]).ends(0);
    let lines = |name: &str, key: &str| {
        let text = bench.read(name);
        let rows = text.lines().filter(|l| l.starts_with(key)).map(|l| {
            let mut words: Vec<String> = l.split(' ').skip(1).map(str::to_owned).collect();
            if key == "f " {
                words.sort();
            }
            words
        });
        rows.collect::<Vec<_>>()
    };
    for key in ["v ", "f "] {
        assert_eq!(lines("again.obj", key), lines("in.obj", key));
    }
}

#[test]
fn convert_refuses_what_cannot_be() {
    let bench = Bench::new();
    bench.write("in.obj", &grid(3));
    bench
        .run(["convert", "in.obj", "--to", "dual", "-o", "in.obj"])
        .fails(2, &["in.obj is an input", "--force"]);
    bench
        .run(["convert", "in.obj", "--to", "dual", "-o", "o.obj", "--json", "r.json"])
        .fails(2, &["--to pure-quad"]);
    bench
        .run(["convert", "in.obj", "--to", "dual", "-o", "o.obj", "--first", "d"])
        .fails(2, &["--to primal"]);
    bench.write("tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    bench
        .run(["convert", "tri.obj", "--to", "primal", "-o", "o.obj"])
        .fails(3, &["tri.obj", "face 0 has 3 corners", "quads only"]);
    assert_eq!(bench.files(), ["in.obj", "tri.obj"]);
}

#[test]
fn optimize_tells_mean_and_largest_before_and_after() {
    let bench = Bench::new();
    let base = ["optimize", SAMPLE, "--reference", REFERENCE, "-o", "out.obj"];
    let less = ["--set", "optimize.iterations=40", "--json", "report.json"];
    for goal in ["planar", "angles"] {
        let run = bench.run(base.into_iter().chain(["--goal", goal]).chain(less));
        run.ends(0);
        assert!(run.out.contains("planarity, mean") && run.out.contains("largest"), "{}", run.out);
        let report: serde_json::Value = serde_json::from_str(&bench.read("report.json")).unwrap();
        let key = if goal == "planar" { "planarity" } else { "angle_deviation_deg" };
        let value = |when| number(&report, [when, key, "mean"]);
        assert!(value("after") < value("before"), "{goal}: {report}");
    }
    bench
        .run(["optimize", "none.obj", "--goal", "planar", "-o", "o.obj"])
        .fails(3, &["none.obj", "no such file"]);
}
