//! What must not be written over, and which stream is taken twice.

use std::path::Path;

use quadmend::io;

use super::failure::Failure;

/// Whether the path means standard input or output.
pub(super) fn is_stream(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The files of a command.
pub(super) struct Files<'a> {
    /// Meshes that are read.
    pub(super) meshes: &'a [&'a Path],
    /// Configuration and scripts.
    pub(super) texts: &'a [&'a Path],
    /// Where a mesh is written.
    pub(super) output: Option<&'a Path>,
    /// Where everything else is written.
    pub(super) others: &'a [&'a Path],
    /// Whether an output may replace an input.
    pub(super) force: bool,
}

impl Files<'_> {
    /// Finds what is wrong with them before the work is done.
    pub(super) fn check(&self) -> Result<(), Failure> {
        read_stdin_once(self.meshes)?;
        let inputs: Vec<&Path> = self.meshes.iter().chain(self.texts).copied().collect();
        let outputs: Vec<&Path> = self.output.iter().chain(self.others).copied().collect();
        keep_apart(&inputs, &outputs, self.force)?;
        Ok(outputs.into_iter().try_for_each(io::check_place)?)
    }
}

/// Refuses to read standard input for two meshes.
pub(super) fn read_stdin_once(inputs: &[&Path]) -> Result<(), Failure> {
    match inputs.iter().filter(|p| is_stream(p)).count() {
        0 | 1 => Ok(()),
        _ => Err(Failure::usage("standard input (-) can be only one of the meshes; name a file")),
    }
}

/// Refuses outputs that would replace an input, and two outputs in one place.
fn keep_apart(inputs: &[&Path], outputs: &[&Path], force: bool) -> Result<(), Failure> {
    for (i, output) in outputs.iter().enumerate() {
        if outputs[..i].iter().any(|o| is_same(o, output)) {
            let shown = output.display();
            return Err(Failure::usage(format!("two outputs go to {shown}; name another file")));
        }
        if !force && inputs.iter().any(|i| !is_stream(i) && is_same(i, output)) {
            return Err(Failure::usage(format!(
                "{} is an input and would be overwritten; name another output, or allow it with \
                 --force",
                output.display()
            )));
        }
    }
    Ok(())
}

/// The same file under two names, or the same name of a file that is not there yet.
fn is_same(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}

/// The path as messages name it.
pub(super) fn shown(path: &Path) -> String {
    if is_stream(path) { "standard input".to_owned() } else { path.display().to_string() }
}

/// A short name for tables: the file name.
pub(super) fn short_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |n| n.display().to_string())
}

/// File names, or whole paths where file names would not tell the files apart.
pub(super) fn names<F: AsRef<Path>>(files: &[F]) -> Vec<String> {
    let short: Vec<String> = files.iter().map(|f| short_name(f.as_ref())).collect();
    let unique = short.iter().enumerate().all(|(i, name)| !short[..i].contains(name));
    if unique { short } else { files.iter().map(|f| f.as_ref().display().to_string()).collect() }
}
