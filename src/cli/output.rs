//! The two streams: data on standard output, words on standard error.

use std::io::{self, ErrorKind, Write};
use std::path::Path;

use quadmend::io::{WriteError, write_atomically};
use quadmend::mesh::PolyMesh;
use quadmend::planner::schedule::EditRecord;
use quadmend::render::Image;
use serde::Serialize;

use super::failure::Failure;

/// Writes data to standard output. A reader that has seen enough (`| head`) is not an error.
pub(super) fn data(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            let file = "standard output".to_owned();
            Err(WriteError::Io { file, source: error }.into())
        }
        _ => Ok(()),
    }
}

/// Writes a line to standard error, for people.
pub(super) fn note(line: &str) {
    // There is nobody left to tell if this fails.
    let _ = writeln!(io::stderr().lock(), "{line}");
}

/// A value as indented JSON with a line break at its end.
pub(super) fn json(value: &impl Serialize) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(value);
    let text = text.map_err(|e| Failure::usage(format!("the result is no JSON: {e}")))?;
    Ok(text + "\n")
}

/// The edits of a run as a script that makes them again and leaves the vertices as in `mesh`.
pub(super) fn log(edits: &[EditRecord], mesh: &PolyMesh) -> Result<String, Failure> {
    let text = quadmend::script::log(edits, mesh.points());
    text.map_err(|e| Failure::usage(format!("the edits are no TOML: {e}")))
}

/// Writes a text to a file, whole or not at all; `-` is standard output.
pub(super) fn file(path: &Path, text: &str) -> Result<(), Failure> {
    if path.as_os_str() == "-" {
        return data(text);
    }
    Ok(write_atomically(path, |out| out.write_all(text.as_bytes()))?)
}

/// Shows a table: on standard output, unless that has taken other data.
pub(super) fn table(text: &str, taken: bool) -> Result<(), Failure> {
    if !taken {
        return data(text);
    }
    note(text.trim_end());
    Ok(())
}

/// Writes a picture as PNG, whole or not at all; `-` is standard output.
pub(super) fn picture(path: &Path, image: &Image) -> Result<(), Failure> {
    Ok(write_atomically(path, |out| image.write_png(out))?)
}

/// Makes a folder if it is not there.
pub(super) fn folder(path: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(path).map_err(|e| {
        let shown = path.display();
        Failure::usage(format!("{shown}: the folder cannot be made ({e}); give another"))
    })
}
