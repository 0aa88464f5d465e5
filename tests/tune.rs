//! The tuner: the same search however often it is interrupted and whatever it runs on, files that
//! other commands take, and presets that do what their names say.

mod common;

use common::browser::Browser;
use common::lifted::{Dice, lifted, mess_up};
use common::say;
use quadmend::config::Config;
use quadmend::io;
use quadmend::mesh::{MendPolicy, PolyMesh, shapes};
use quadmend::metrics::{Summary, measure};
use quadmend::pipeline::clean;
use quadmend::script::{self, Script, edit};
use quadmend::sqrtcc::lower;
use quadmend::tune::{Case, Findings, Observer, Task, TuneError, search};
use quadmend::watch::Silent;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};

const SPACE: &str = "
    [space]
    \"plan.lambda_last\" = { low = 20, high = 2000, log = true }
    \"plan.tries\" = { low = 1, high = 5 }
    \"cost.triple\" = {}";

/// A torus after some random operations.
fn messy(seed: u64) -> PolyMesh {
    let mut q = lifted(&shapes::torus(16, 10));
    mess_up(&mut q, &mut Dice(seed), 24);
    q.commit();
    lower(&q, &[String::new()]).unwrap().mesh
}

fn cases() -> Vec<Case> {
    let case = |seed: u64| Case {
        file: format!("torus-{seed}"),
        sha256: [seed.to_string(), String::new()],
        mesh: messy(seed),
        reference: None,
    };
    vec![case(1), case(2)]
}

/// One stage and little smoothing.
fn quick() -> Config {
    [
        "plan.stages=1",
        "plan.rounds=2",
        "plan.smooth_between=2",
        "smooth.iterations=2",
        "measure.samples=1000",
    ]
    .iter()
    .fold(Config::default(), |config, set| config.with_assignment(set).unwrap())
}

/// Has enough after so many trials.
struct Patience {
    left: AtomicUsize,
}

impl Observer for Patience {
    fn trial(&self, _: usize, _: f64, _: usize) {
        let _ = self.left.fetch_update(Ordering::SeqCst, Ordering::SeqCst, |n| n.checked_sub(1));
    }

    fn enough(&self) -> bool {
        self.left.load(Ordering::SeqCst) == 0
    }
}

fn searched(
    text: &str,
    (trials, patience): (usize, usize),
    journal: &Path,
) -> Result<Findings, TuneError> {
    let task = Task::read("test", &format!("{text}{SPACE}")).unwrap();
    let patience = Patience { left: AtomicUsize::new(patience) };
    search((&task, &quick()), &cases(), trials, journal, &patience)
}

#[test]
fn an_interrupted_search_ends_as_if_it_had_not_been() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, torn] = ["whole.jsonl", "torn.jsonl"].map(|name| folder.path().join(name));
    for goal in ["goal = \"score\"", "goal = \"pareto\""] {
        let at_once = searched(goal, (14, usize::MAX), &whole).unwrap();
        assert_eq!(at_once.trials.len(), 15, "the start and 14 trials");
        // Stopped in the middle of a generation, cut off in the middle of a line, and once more.
        searched(goal, (14, 3), &torn).unwrap();
        let text = fs::read_to_string(&torn).unwrap();
        fs::write(&torn, &text[..text.len() - 20]).unwrap();
        let part = searched(goal, (14, 4), &torn).unwrap();
        assert!(part.trials.len() < 15, "{}", part.trials.len());
        let resumed = searched(goal, (14, usize::MAX), &torn).unwrap();
        assert_eq!(resumed.trials, at_once.trials);
        assert_eq!(resumed.best(), at_once.best());
        assert_eq!(resumed.importance, at_once.importance);
        // Nothing is left to do, and nothing is written.
        let before = fs::read(&torn).unwrap();
        searched(goal, (14, 0), &torn).unwrap();
        assert_eq!(fs::read(&torn).unwrap(), before);
        for file in [&whole, &torn] {
            fs::remove_file(file).unwrap();
        }
    }
}

#[test]
fn threads_do_not_matter_and_seeds_do() {
    let folder = tempfile::tempdir().unwrap();
    let run = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let journal = folder.path().join(format!("{threads}-{seed}.jsonl"));
        let task = format!("seed = {seed}\ngeneration = 3\n");
        pool.install(|| searched(&task, (6, usize::MAX), &journal)).unwrap().trials
    };
    assert_eq!(run(1, 1), run(4, 1));
    assert_ne!(run(1, 1)[1..], run(1, 2)[1..]);
}

#[test]
fn the_journal_of_another_search_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal.jsonl");
    searched("", (1, usize::MAX), &journal).unwrap();
    let error = searched("seed = 5\n", (1, usize::MAX), &journal).unwrap_err().to_string();
    assert!(error.contains("another search (task.seed: 1 there, 5 here)"), "{error}");
    fs::write(&journal, fs::read_to_string(&journal).unwrap() + "{}\n").unwrap();
    let error = searched("", (1, usize::MAX), &journal).unwrap_err().to_string();
    assert!(error.contains("journal.jsonl:4: this is no line"), "{error}");
}

fn quadmend(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_quadmend"));
    command.current_dir(folder).args(arguments).output().unwrap()
}

const FEW: [&str; 10] = [
    "--set",
    "plan.stages=1",
    "--set",
    "plan.rounds=2",
    "--set",
    "plan.smooth_between=2",
    "--set",
    "smooth.iterations=2",
    "--set",
    "measure.samples=1000",
];

#[test]
fn the_command_leaves_files_that_others_take() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    for (name, seed) in [("a.obj", 1), ("b.obj", 2)] {
        io::write(&here.join(name), &messy(seed)).unwrap();
    }
    io::write(&here.join("a.ref.obj"), &shapes::torus(16, 10)).unwrap();
    let arguments = |trials| {
        let own = ["tune", "*.obj", "-o", "out", "--goal", "pareto", "--trials", trials];
        let vary = ["--vary", "plan.lambda_last=20..2000,log", "--vary", "gate.rms=0.5..2"];
        [&own[..], &vary, &FEW].concat()
    };
    let run = quadmend(here, &arguments("12"));
    let told = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success(), "{told}");
    assert!(told.contains("best so far: score 1.0000, trial 0"), "{told}");
    assert!(String::from_utf8_lossy(&run.stdout).contains("front "), "the front is told");
    let journal = fs::read_to_string(here.join("out/journal.jsonl")).unwrap();
    assert_eq!(journal.lines().count(), 1 + 1 + 12, "what is searched, the start, trials");
    // The reference is one, and no mesh.
    let head: serde_json::Value = serde_json::from_str(journal.lines().next().unwrap()).unwrap();
    let meshes = head["meshes"].as_array().unwrap();
    assert_eq!(meshes.len(), 2);
    assert!(meshes[0][1] != "" && meshes[1][1] == "", "{meshes:?}");

    for file in ["out/best.toml", "out/front-1.toml"] {
        let checked = quadmend(here, &["config", "check", file]);
        assert!(checked.status.success(), "{file}: {}", String::from_utf8_lossy(&checked.stderr));
    }
    let page = fs::read_to_string(here.join("out/tune.html")).unwrap();
    for wanted in ["plan.lambda_last", "gate.rms", "Which knobs matter", "prefers-color-scheme"] {
        assert!(page.contains(wanted), "{wanted}");
    }
    assert!(!page.contains("http://") && !page.contains("https://"), "the page asks the network");
    assert_eq!(page.matches("<svg").count(), page.matches("</svg>").count());
    show(&here.join("out/tune.html"));

    // Asked for no more, it only says again what is there.
    let again = quadmend(here, &arguments("12"));
    assert_eq!((again.status, again.stdout), (run.status, run.stdout));
    assert_eq!(fs::read_to_string(here.join("out/journal.jsonl")).unwrap(), journal);
}

/// Where pictures are wanted, draws the page; without them, there is nothing more to be seen.
fn show(page: &Path) {
    let Some(pictures) = std::env::var_os("QUADMEND_SCREENSHOTS") else { return };
    let Some(mut browser) = Browser::start("tune", [1300, 1400]) else { return };
    browser.open(page);
    browser.wait_for("document.readyState === 'complete'");
    fs::write(Path::new(&pictures).join("tune.png"), browser.screenshot()).unwrap();
    say("tune.png is drawn");
}

#[test]
fn what_cannot_be_searched_is_told_with_its_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    io::write(&folder.path().join("a.obj"), &messy(1)).unwrap();
    fs::write(folder.path().join("bad.toml"), "sead = 1\n").unwrap();
    for (arguments, code, wanted) in [
        (&["a.obj", "--vary", "cost.stepp"][..], 2, "did you mean `cost.step`?"),
        (&["a.obj", "--vary", "cost.step=0..1000"], 2, "from 0.001 to 100"),
        (&["a.obj", "--search", "bad.toml"], 2, "sead"),
        (&["nothing-*.obj"], 2, "match no mesh"),
        (&["there-is-none.obj"], 3, "there-is-none.obj"),
        (&["a.obj", "-r", "none.obj"], 3, "none.obj"),
    ] {
        let all = [&["tune", "-o", "out", "--trials", "1"], arguments].concat();
        let run = quadmend(folder.path(), &all);
        let told = String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(code), "{arguments:?}: {told}");
        assert!(told.contains(wanted), "{arguments:?}: {told}");
    }
}

fn sample() -> [PolyMesh; 2] {
    ["", ".ref"].map(|kind| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
        io::read(&folder.join(format!("bracket{kind}.obj"))).unwrap().mesh
    })
}

/// Cleans the sample with a preset, makes it again from the log, and gives it before and after.
fn with_preset(name: &str, settings: &[&str]) -> [Summary; 2] {
    let [mesh, scan] = sample();
    let config = settings
        .iter()
        .fold(Config::preset(name).unwrap(), |config, set| config.with_assignment(set).unwrap());
    let mended = MendPolicy::Mend;
    let done = clean(mesh.clone(), Some(&scan), mended, &config, &Silent).unwrap();
    let log = script::log(&done.report.edits, done.mesh.points()).unwrap();
    let script = Script::parse(&log, "log").unwrap();
    let again = edit(mesh, Some(&scan), mended, &script, (&config, false), &Silent).unwrap();
    assert_eq!(again.mesh.points(), done.mesh.points(), "{name}: the log makes another mesh");
    assert!(again.mesh.faces().eq(done.mesh.faces()), "{name}: the log makes other faces");
    assert_eq!(
        measure(&again.mesh, None).unwrap().summary.pure_quad,
        done.report.after.summary.pure_quad
    );
    [done.report.before.summary, done.report.after.summary]
}

#[test]
fn the_preset_pure_quad_leaves_quads_only() {
    let [_, usual] = with_preset("balanced", &["plan.stages=1", "smooth.iterations=20"]);
    let [before, after] = with_preset("pure-quad", &["plan.stages=1", "smooth.iterations=20"]);
    assert!(after.pure_quad && after.manifold && after.oriented);
    let (e, most) = (after.irregular_elements, usual.irregular_elements + 8);
    assert!(e <= most, "E {e}, without the conversion {}", usual.irregular_elements);
    assert!(e < before.irregular_elements / 2);
    assert!(after.rms.unwrap() < 1.1 * before.rms.unwrap(), "{:?}", after.rms);
}

#[test]
fn the_preset_t_junctions_takes_nothing_else_away() {
    let [before, after] = with_preset("t-junctions", &[]);
    assert!(before.t_junctions > 40 && 10 * after.t_junctions < before.t_junctions, "{after:?}");
    let (from, to) = (before.irregular_elements, after.irregular_elements);
    assert!(to.abs_diff(from) * 10 <= from, "E {from}, then {to}");
    assert!(after.faces.abs_diff(before.faces) * 50 <= before.faces, "{}", after.faces);
    assert!(after.rms.unwrap() <= before.rms.unwrap(), "{after:?}");
    assert!(after.hausdorff.unwrap() <= 1.1 * before.hausdorff.unwrap(), "{after:?}");
}
