//! The rules of the house: which module may use which, and who may print.

use std::fs;
use std::path::{Path, PathBuf};

/// Modules by rank; one may use those of its own rank and below, without cycles.
const RANKS: &[(usize, &[&str])] = &[
    (0, &["knobs", "watch"]),
    (1, &["mesh"]),
    (2, &["sqrtcc", "surface", "io"]),
    (3, &["ops"]),
    (4, &["moves", "patch", "smooth", "metrics", "views"]),
    (5, &["planner", "optimize", "elements"]),
    (6, &["config", "pipeline", "script"]),
    (7, &["tune", "batch", "render", "report"]),
    (8, &["cli", "viewer", "main"]),
];

/// What only the command line may do: print, look at the clock, read the environment.
const OUTSIDE_WORLD: &[&str] =
    &["println!", "print!", "eprintln!", "eprint!", "dbg!", "std::time", "std::env", "stderr()"];

/// A line of source with its place.
struct Line {
    file: PathBuf,
    number: usize,
    module: String,
    text: String,
}

impl Line {
    fn place(&self) -> String {
        format!("{}:{}", self.file.display(), self.number)
    }
}

/// The library's lines of code: no comments, and nothing after the tests of a file begin.
fn lines() -> Vec<Line> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut lines = Vec::new();
    for file in files(&root) {
        let below = file.strip_prefix(&root).unwrap();
        let module = below.iter().next().unwrap().to_str().unwrap().trim_end_matches(".rs");
        let source = fs::read_to_string(&file).unwrap();
        let code = source.lines().take_while(|l| l.trim() != "mod tests {");
        for (number, text) in (1..).zip(code).filter(|(_, l)| !l.trim_start().starts_with("//")) {
            let (file, module) = (Path::new("src").join(below), module.to_owned());
            lines.push(Line { file, number, module, text: text.to_owned() });
        }
    }
    lines
}

/// Source files, without those that only tests are made of.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let tests = test_modules(folder);
    let below = |path: PathBuf| if path.is_dir() { files(&path) } else { vec![path] };
    let is_code = |path: &PathBuf| {
        let stem = path.file_stem().and_then(|s| s.to_str()).unwrap_or_default();
        path.extension().is_some_and(|e| e == "rs") && !tests.iter().any(|t| t == stem)
    };
    paths.into_iter().flat_map(below).filter(is_code).collect()
}

/// Files of a folder that its `mod.rs` declares under `#[cfg(test)]`.
fn test_modules(folder: &Path) -> Vec<String> {
    let source = fs::read_to_string(folder.join("mod.rs")).unwrap_or_default();
    let after = source.split("#[cfg(test)]\n").skip(1);
    let names = after.filter_map(|rest| rest.lines().next()?.split("mod ").nth(1));
    names.map(|name| name.trim_end_matches(';').to_owned()).collect()
}

fn rank(module: &str) -> usize {
    let found = RANKS.iter().find(|(_, modules)| modules.contains(&module));
    found.unwrap_or_else(|| panic!("module `{module}` has no rank: give it one in this test")).0
}

/// Modules that a line names after `crate::` or, in the command, `quadmend::`.
fn used(line: &str) -> Vec<&str> {
    let starts = ["crate::", "quadmend::"];
    let after = starts.iter().flat_map(|start| line.split(start).skip(1));
    after
        .map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or(""))
        .filter(|name| name.starts_with(|c: char| c.is_lowercase()))
        .collect()
}

#[test]
fn modules_use_lower_ranks_only() {
    let mut uses = Vec::new();
    for line in lines().iter().filter(|l| !["lib", "main"].contains(&l.module.as_str())) {
        for name in used(&line.text).into_iter().filter(|name| *name != line.module) {
            assert!(
                rank(name) <= rank(&line.module),
                "{}: `{}` (rank {}) uses `{name}` (rank {}), which is above it",
                line.place(),
                line.module,
                rank(&line.module),
                rank(name)
            );
            uses.push((line.module.clone(), name.to_owned(), line.place()));
        }
    }
    assert!(uses.len() > 20, "the test no longer sees what modules use");
    for (from, to, place) in &uses {
        let back = uses.iter().find(|(f, t, _)| (f, t) == (to, from));
        assert!(back.is_none(), "{place}: `{from}` and `{to}` use each other");
    }
}

#[test]
fn every_module_of_the_library_has_a_rank() {
    for line in lines().iter().filter(|l| l.module == "lib") {
        if let Some(module) = line.text.trim().strip_prefix("pub mod ") {
            let _ = rank(module.trim_end_matches(';'));
        }
    }
}

#[test]
fn only_the_command_line_meets_the_outside_world() {
    for line in lines().iter().filter(|l| rank_or_top(&l.module) < 7) {
        for what in OUTSIDE_WORLD {
            assert!(
                !line.text.contains(what),
                "{}: `{what}` belongs to the command line; take a Watch or an argument",
                line.place()
            );
        }
    }
}

/// `lib` only lists modules; `main` is the command.
fn rank_or_top(module: &str) -> usize {
    if module == "lib" { 0 } else { rank(module) }
}

#[test]
fn the_reader_of_lines_sees_what_is_used() {
    assert_eq!(used("use crate::mesh::{NONE, PolyMesh};"), ["mesh"]);
    assert_eq!(used("    features: crate::surface::FeatureOptions,"), ["surface"]);
    assert_eq!(used("use quadmend::io::{self, Loaded};"), ["io"]);
    assert_eq!(used("use crate::NONE;"), [""; 0]);
}
