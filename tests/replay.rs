//! Logs of cleaned meshes: they make the same mesh again, and a wrong one is refused.

mod common;

use common::{data_folder, say};
use quadmend::config::Config;
use quadmend::io;
use quadmend::mesh::{MendPolicy, PolyMesh};
use quadmend::pipeline::{Cleaned, clean};
use quadmend::script::{self, Edited, Script, ScriptError, StepError, edit};
use quadmend::watch::Silent;
use std::path::Path;
use toml::{Table, Value};

/// One stage and little smoothing: every kind of edit, in little time.
fn quick() -> Config {
    let settings =
        ["plan.stages=1", "plan.rounds=3", "plan.smooth_between=4", "smooth.iterations=8"];
    settings.iter().fold(Config::default(), |config, set| config.with_assignment(set).unwrap())
}

fn read(folder: &Path, name: &str) -> [PolyMesh; 2] {
    ["", ".ref"].map(|kind| io::read(&folder.join(format!("{name}{kind}.obj"))).unwrap().mesh)
}

fn sample() -> [PolyMesh; 2] {
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("assets"), "bracket")
}

fn cleaned([mesh, scan]: &[PolyMesh; 2]) -> (Cleaned, String) {
    let done = clean(mesh.clone(), Some(scan), MendPolicy::Mend, &quick(), &Silent).unwrap();
    let log = script::log(&done.report.edits, done.mesh.points()).unwrap();
    (done, log)
}

fn replay([mesh, scan]: &[PolyMesh; 2], log: &str) -> Result<Edited, ScriptError> {
    let script = Script::parse(log, "edits.toml")?;
    let options = (&quick(), false);
    edit(mesh.clone(), Some(scan), MendPolicy::Mend, &script, options, &Silent)
}

fn bytes(mesh: &PolyMesh) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.obj");
    io::write(&path, mesh).unwrap();
    std::fs::read(path).unwrap()
}

#[test]
fn a_log_makes_the_same_bytes_again() {
    let mut all = vec![("bracket", sample())];
    if let Some(folder) = data_folder("a_log_makes_the_same_bytes_again") {
        // Torn and turned, with vertices held on creases: its log has pins and starts mended.
        all.push(("penguin", read(&folder, "penguin_mlpair")));
        // Walls between creases: its log has crossings.
        all.push(("featuretype", read(&folder, "featuretype_im6k")));
    }
    for (name, meshes) in all {
        let (done, log) = cleaned(&meshes);
        let again = replay(&meshes, &log).unwrap();
        assert!(bytes(&again.mesh) == bytes(&done.mesh), "{name}");
        assert_eq!(again.steps.len(), done.report.edits.len() + 1, "{name}: a step for each edit");
        let kinds = ["operations", "walk", "refill", "crossing", "ideals", "place"];
        let count = |kind| again.steps.iter().filter(|step| step.operation == kind).count();
        say(&format!("{name}: {:?} of {kinds:?}, {} bytes", kinds.map(count), log.len()));
        assert!(name != "bracket" || kinds.map(count).iter().filter(|&&n| n > 0).count() >= 4);
        assert!(name != "featuretype" || count("crossing") > 0 && count("ideals") > 0);
    }
}

/// The steps of a log, to be made wrong.
struct Log(Table);

impl Log {
    fn steps(&mut self) -> &mut Vec<Value> {
        self.0["step"].as_array_mut().unwrap()
    }

    /// Number (from 0) of the first step that does this.
    fn first(&mut self, what: &str) -> usize {
        self.steps().iter().position(|step| step["do"].as_str() == Some(what)).unwrap()
    }

    /// The list at a path of keys of a step.
    fn list<'a>(&'a mut self, step: usize, keys: &[&str]) -> &'a mut Vec<Value> {
        let at = keys.iter().fold(&mut self.steps()[step], |value, key| &mut value[*key]);
        at.as_array_mut().unwrap()
    }
}

/// Makes a log wrong; the step (from 0) that is wrong then.
type Spoil = fn(&mut Log) -> usize;

#[test]
fn a_wrong_log_is_refused_with_its_step() {
    let meshes = sample();
    let (_, text) = cleaned(&meshes);
    let spoils: [(&str, &str, Spoil); 9] = [
        ("walk", "no adjacent pair", |log| {
            let i = log.first("walk");
            log.steps()[i]["start"] = Value::Integer(4_000_000_000);
            i
        }),
        ("operations", "no longer exists", |log| {
            let i = log.first("operations");
            let op = &mut log.list(i, &["ops"])[0];
            let key = if op["op"].as_str() == Some("split") { "last" } else { "edge" };
            op[key] = Value::Integer(4_000_000_000);
            i
        }),
        ("refill", "no disk", |log| {
            let i = log.first("refill");
            let far = log.list(i + 1, &["faces"])[0].clone();
            log.list(i, &["faces"]).push(far);
            i
        }),
        ("refill", "not those of the faces", |log| {
            let i = log.first("refill");
            log.list(i, &["rim"]).rotate_left(1);
            i
        }),
        ("refill", "there is no face 7 ", |log| {
            let i = log.first("refill");
            log.list(i, &["faces"])[0] = Value::Integer(7);
            i
        }),
        ("refill", "no list of faces", |log| {
            let i = log.first("refill");
            log.list(i, &["filling", "offsets"]).pop();
            i
        }),
        ("refill", "filling", |log| {
            let i = log.first("refill");
            log.list(i, &["filling", "corners"]).swap(0, 5);
            i
        }),
        ("refill", "pins", |log| {
            let i = log.first("refill");
            log.list(i, &["pins"]).push(Value::Integer(0));
            i
        }),
        ("place", "vertices now", |log| {
            let i = log.first("place");
            log.list(i, &["points"]).pop();
            i
        }),
    ];
    for (operation, reason, spoil) in spoils {
        let mut log = Log(toml::from_str(&text).unwrap());
        let i = spoil(&mut log);
        let error = replay(&meshes, &toml::to_string(&log.0).unwrap()).expect_err(reason);
        let ScriptError::Refused(StepError { number, operation: named, reason: told, .. }) = error
        else {
            panic!("{operation}: {error}")
        };
        assert_eq!((number, named), (i + 1, operation), "{told}");
        assert!(told.contains(reason), "{told}");
    }
    // Left out: the first edit, and one in the middle.
    for i in [0, Log(toml::from_str(&text).unwrap()).steps().len() / 2] {
        let mut log = Log(toml::from_str(&text).unwrap());
        log.steps().remove(i);
        assert!(replay(&meshes, &toml::to_string(&log.0).unwrap()).is_err(), "step {}", i + 1);
    }
}
