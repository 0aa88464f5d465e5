//! The guide: every command in it runs, and its pictures are what the commands write.
//!
//! `QUADMEND_WRITE_GUIDE=1 cargo test --test guide` renews the pictures.

use std::fs;
use std::path::{Path, PathBuf};
#[cfg(unix)]
use std::process::Command;

/// Pictures of a page load quickly.
const LARGEST_PICTURE: u64 = 150_000;

fn guide() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/guide")
}

fn page(name: &str) -> String {
    fs::read_to_string(guide().join(name)).unwrap()
}

/// The lines of the shell blocks of a page.
#[cfg(unix)]
fn commands(text: &str) -> Vec<String> {
    let mut inside = false;
    let mut lines = Vec::new();
    for line in text.lines() {
        if line.starts_with("```") {
            inside = line == "```sh";
        } else if inside && !line.trim().is_empty() {
            lines.push(line.to_owned());
        }
    }
    lines
}

/// The pages, in the order in which they are read.
const PAGES: [&str; 5] = ["README.md", "first-remesh.md", "numbers.md", "presets.md", "tuning.md"];

/// Runs the commands of a page, in order.
#[cfg(unix)]
fn follow(name: &str, folder: &Path) {
    let program = Path::new(env!("CARGO_BIN_EXE_quadmend")).parent().unwrap();
    let mut path = vec![program.to_path_buf()];
    path.extend(std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()));
    let text = page(name);
    let commands = commands(&text);
    assert!(!commands.is_empty(), "{name} has no commands");
    for line in &commands {
        let run = Command::new("sh")
            .args(["-c", line])
            .current_dir(folder)
            .env("PATH", std::env::join_paths(&path).unwrap())
            .output()
            .unwrap();
        let told = String::from_utf8_lossy(&run.stderr);
        assert!(run.status.success(), "{name}: {line}: {told}");
    }
    for picture in pictures(&text) {
        let made = folder.join(picture);
        assert!(made.is_file(), "{name} shows {picture}, which no command of it writes");
        if std::env::var_os("QUADMEND_WRITE_GUIDE").is_some() {
            fs::copy(made, guide().join("pictures").join(picture)).unwrap();
        }
    }
}

/// Names of the pictures that a page shows.
fn pictures(text: &str) -> Vec<&str> {
    text.split("](pictures/").skip(1).filter_map(|rest| rest.split(')').next()).collect()
}

#[test]
#[cfg(unix)]
fn the_commands_run_page_after_page() {
    let folder = tempfile::tempdir().unwrap();
    for name in PAGES {
        follow(name, folder.path());
    }
}

#[test]
fn pictures_are_there_and_small_and_all_are_shown() {
    let pages = PAGES.map(page);
    let shown: Vec<&str> = pages.iter().flat_map(|text| pictures(text)).collect();
    for entry in fs::read_dir(guide().join("pictures")).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        assert!(shown.contains(&name.as_str()), "{name} is shown nowhere");
        assert!(entry.metadata().unwrap().len() < LARGEST_PICTURE, "{name} is too large");
    }
    for name in shown {
        assert!(guide().join("pictures").join(name).is_file(), "{name} is missing");
    }
}

/// Every metric that a page names in code exists, and so does every field.
#[test]
fn the_names_of_metrics_are_right() {
    use quadmend::metrics::{FACE_FIELDS, METRICS};
    let text = page("numbers.md");
    let first = text.split("## Connectivity").next().unwrap();
    let rows = first.lines().filter(|l| l.starts_with("| ") && l.contains('`'));
    let keys: Vec<&str> = rows.filter_map(|l| l.split('`').nth(1)).collect();
    assert_eq!(keys.len(), 6);
    assert!(keys.iter().all(|key| METRICS.iter().any(|m| m.key == *key)), "{keys:?}");
    for field in FACE_FIELDS {
        assert!(text.contains(&format!("`{}`", field.key)), "{} is not explained", field.key);
    }
}
