//! The two streams: data on standard output, words on standard error.

use std::io::{self, Write};
use std::path::Path;

use clap::Args;
use clap::builder::PossibleValuesParser;
use quadmend::io::{Destination, FORMATS, Format, write_atomically};
use quadmend::mesh::PolyMesh;
use quadmend::planner::schedule::EditRecord;
use quadmend::render::Image;
use serde::Serialize;

use super::failure::Failure;

/// In what format a mesh is written.
#[derive(Debug, Args)]
pub(super) struct MeshFormat {
    /// Format of the mesh that is written; a name that ends in .gz packs it as well [default: by
    /// the name of the file, obj for standard output]
    #[arg(long, value_name = "FORMAT", value_parser = written_formats())]
    format: Option<String>,
}

fn written_formats() -> PossibleValuesParser {
    let written = FORMATS.iter().filter(|f| f.is_written());
    written.map(|f| f.name).collect::<Vec<_>>().into()
}

impl MeshFormat {
    /// Where a mesh goes, if it can go there.
    pub(super) fn to<'a>(&self, path: &'a Path) -> Result<Destination<'a>, Failure> {
        Ok(Destination::new(path, self.format.as_deref().and_then(Format::named))?)
    }
}

/// Writes data to standard output.
pub(super) fn data(text: &str) -> Result<(), Failure> {
    file(Path::new("-"), text)
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
