//! Reading and writing meshes: one file a format, found by the extension of the file name.
//!
//! A format is one implementation of [`Format`] and one line in [`FORMATS`]. Reading gives a
//! soup of polygons as the file has it; `mesh::mend` makes it fit to be edited. The path `-`
//! stands for standard input and output, in the first format of the list.
//!
//! *Invariant:* nothing is printed; what a person should know comes back as a [`Warning`].

mod atomic;
mod obj;

use std::fmt;
use std::io::{self, Read, Write};
use std::path::Path;

use thiserror::Error;

use crate::mesh::{MeshError, PolyMesh};

pub use atomic::write_atomically;
pub use obj::Obj;

/// All formats, the default one first.
pub const FORMATS: &[&dyn Format] = &[&Obj];

/// A file format for polygon meshes.
pub trait Format: Sync {
    /// What people call it.
    fn name(&self) -> &'static str;

    /// File name extensions in lower case, without the dot.
    fn extensions(&self) -> &'static [&'static str];

    /// Reads a whole file. `file` is its name, for messages. Linear in the size of the file.
    fn read(&self, bytes: &[u8], file: &str) -> Result<Loaded, ReadError>;

    /// Writes a mesh so that reading it gives the same mesh again. Linear in its size.
    fn write(&self, mesh: &PolyMesh, out: &mut dyn Write) -> io::Result<()>;

    /// Writes a mesh with a colour (red, green, blue, 0 to 1) for each vertex. Formats that have
    /// none leave them out.
    fn write_coloured(
        &self,
        mesh: &PolyMesh,
        colours: &[[f64; 3]],
        out: &mut dyn Write,
    ) -> io::Result<()> {
        let _ = colours;
        self.write(mesh, out)
    }
}

/// A mesh as it was read, and what was left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// The polygons in file order: any soup, not mended yet.
    pub mesh: PolyMesh,
    /// What the person who gave the file should know.
    pub warnings: Vec<Warning>,
    /// SHA-256 of the file, in hexadecimal digits.
    pub sha256: String,
}

/// Something that was read without error, but not kept.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Warning {
    /// Parts of the file that no edit of the connectivity could keep.
    Dropped {
        /// Name of the file.
        file: String,
        /// What was dropped, in words.
        what: Vec<&'static str>,
        /// First line that has any of it, from 1.
        line: usize,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Dropped { file, what, line } = self;
        let what = what.join(", ");
        write!(f, "{file}: {what} dropped (first at line {line}): only the polygons are kept")
    }
}

/// Why a file could not be read, and where.
#[derive(Debug, Error)]
#[error("{file}{}: {fault}", line.map(|l| format!(":{l}")).unwrap_or_default())]
pub struct ReadError {
    /// Name of the file.
    pub file: String,
    /// Line of the file, from 1, if the fault has one.
    pub line: Option<usize>,
    /// What is wrong with it.
    #[source]
    pub fault: ReadFault,
}

/// What can be wrong with a file. Every message says what to do about it.
#[derive(Debug, Error)]
pub enum ReadFault {
    /// There is no such file.
    #[error("no such file; check the path")]
    Missing,
    /// The path leads to a folder.
    #[error("is a folder, not a mesh; name a file in it")]
    Directory,
    /// The system refused to read it.
    #[error("cannot be read ({0}); check its permissions and the disk")]
    Unreadable(io::Error),
    /// No reader for this file name.
    #[error("no reader for files {extension}; known extensions: {known}")]
    UnknownFormat {
        /// The extension with its dot in quotes, or words for none.
        extension: String,
        /// Extensions that can be read.
        known: String,
    },
    /// Nothing in it.
    #[error("the file is empty; write the mesh again from the program that made it")]
    Empty,
    /// Not a text file.
    #[error("is not a text file (byte {offset} is zero); export it as a text OBJ")]
    Binary {
        /// Where the first zero byte is, from 0.
        offset: usize,
    },
    /// Text in another encoding.
    #[error("is not UTF-8 text; save the file in UTF-8")]
    NotUtf8,
    /// A line that the format does not allow.
    #[error("{reason} in `{text}`; {advice}")]
    Syntax {
        /// What is wrong.
        reason: &'static str,
        /// The words in question, shortened.
        text: String,
        /// What to do about it.
        advice: &'static str,
    },
    /// The file stops in the middle of a line.
    #[error("the file ends in the middle of a line (`{text}`); it was cut: copy it again")]
    Cut {
        /// What there is of the line.
        text: String,
    },
    /// A face names a vertex that does not exist.
    #[error(
        "face {face} names vertex {index}, but the file has vertices 1 to {vertices}; \
         the file is damaged or cut: write it again"
    )]
    IndexOutOfRange {
        /// Number of the face in the file, from 1.
        face: usize,
        /// The index as it is written.
        index: String,
        /// How many vertices the file has, or had so far for a negative index.
        vertices: usize,
    },
    /// A coordinate is NaN, infinite, or too large to compute with.
    #[error(
        "vertex {vertex} has the coordinate `{text}`, which is not a finite number below 1e100; \
         repair or rescale the model in the program that made it"
    )]
    NotFinite {
        /// Number of the vertex in the file, from 1.
        vertex: usize,
        /// The coordinate as it is written.
        text: String,
    },
    /// No polygon in the file.
    #[error(
        "has {vertices} vertices but no faces; a mesh is needed, not a point cloud or curves \
         (or the file was cut)"
    )]
    NoFaces {
        /// How many vertices it has.
        vertices: usize,
    },
    /// The polygons make no mesh.
    #[error("{0}; split the model into smaller ones")]
    Mesh(#[from] MeshError),
}

/// Why a file could not be written. An older file of that name is left as it was.
#[derive(Debug, Error)]
pub enum WriteError {
    /// No writer for this file name.
    #[error("{file}: no writer for files {extension}; known extensions: {known}")]
    UnknownFormat {
        /// Name of the file.
        file: String,
        /// The extension with its dot in quotes, or words for none.
        extension: String,
        /// Extensions that can be written.
        known: String,
    },
    /// The path leads to a folder.
    #[error("{file}: is a folder; name a file in it")]
    Directory {
        /// Name of the file.
        file: String,
    },
    /// The folder is not there.
    #[error("{file}: the folder it should go to does not exist; create it first")]
    NoFolder {
        /// Name of the file.
        file: String,
    },
    /// The old file may not be replaced.
    #[error("{file}: is write-protected; choose another name or allow writing")]
    Protected {
        /// Name of the file.
        file: String,
    },
    /// The system refused.
    #[error(
        "{file}: cannot be written ({source}); check permissions and free space (nothing was left \
         behind, an older file is unchanged)"
    )]
    Io {
        /// Name of the file.
        file: String,
        /// What the system said.
        source: io::Error,
    },
}

/// Reads the mesh at `path`; `-` is standard input. The whole file is held in memory meanwhile.
pub fn read(path: &Path) -> Result<Loaded, ReadError> {
    let file = display_name(path, "standard input");
    let fail = |fault| ReadError { file: file.clone(), line: None, fault };
    let format = format_of(path).map_err(|(extension, known)| {
        // A missing file or a folder is the better news, whatever it is called.
        fail(read_bytes(path).err().unwrap_or(ReadFault::UnknownFormat { extension, known }))
    })?;
    format.read(&read_bytes(path).map_err(fail)?, &file)
}

/// Writes `mesh` to `path`, whole or not at all; `-` is standard output.
pub fn write(path: &Path, mesh: &PolyMesh) -> Result<(), WriteError> {
    let format = writer_for(path)?;
    write_atomically(path, |out| format.write(mesh, out))
}

/// Writes `mesh` with a colour for each vertex to `path`, whole or not at all.
///
/// # Panics
/// If there is not one colour for each vertex: that is a bug of the caller.
pub fn write_coloured(
    path: &Path,
    mesh: &PolyMesh,
    colours: &[[f64; 3]],
) -> Result<(), WriteError> {
    assert_eq!(colours.len(), mesh.vertex_count(), "one colour for each vertex");
    let format = writer_for(path)?;
    write_atomically(path, |out| format.write_coloured(mesh, colours, out))
}

/// Whether [`write`] could write to `path` as far as its name tells, so that a long computation
/// need not end with a mesh that has nowhere to go.
pub fn check_output(path: &Path) -> Result<(), WriteError> {
    check_place(path)?;
    writer_for(path).map(|_| ())
}

/// Whether there could be a file at `path`: its folder exists, and it is no folder itself.
pub fn check_place(path: &Path) -> Result<(), WriteError> {
    let file = path.display().to_string();
    let folder = path.parent().filter(|f| !f.as_os_str().is_empty());
    match folder {
        _ if path.is_dir() => Err(WriteError::Directory { file }),
        Some(folder) if !folder.is_dir() => Err(WriteError::NoFolder { file }),
        _ => Ok(()),
    }
}

fn writer_for(path: &Path) -> Result<&'static dyn Format, WriteError> {
    format_of(path).map_err(|(extension, known)| {
        let file = path.display().to_string();
        WriteError::UnknownFormat { file, extension, known }
    })
}

/// The format for `path`, or its extension in words and the extensions that are known.
fn format_of(path: &Path) -> Result<&'static dyn Format, (String, String)> {
    if is_standard_stream(path) {
        return Ok(FORMATS[0]);
    }
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let found = extension
        .as_deref()
        .and_then(|e| FORMATS.iter().copied().find(|f| f.extensions().contains(&e)));
    found.ok_or_else(|| {
        let known = FORMATS.iter().flat_map(|f| f.extensions()).map(|e| format!(".{e}"));
        let words = extension.map_or("without an extension".into(), |e| format!("named `.{e}`"));
        (words, known.collect::<Vec<_>>().join(", "))
    })
}

fn read_bytes(path: &Path) -> Result<Vec<u8>, ReadFault> {
    if is_standard_stream(path) {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes).map_err(ReadFault::Unreadable)?;
        return Ok(bytes);
    }
    std::fs::read(path).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => ReadFault::Missing,
        _ if path.is_dir() => ReadFault::Directory,
        _ => ReadFault::Unreadable(error),
    })
}

fn is_standard_stream(path: &Path) -> bool {
    path.as_os_str() == "-"
}

fn display_name(path: &Path, stream: &str) -> String {
    if is_standard_stream(path) { stream.to_owned() } else { path.display().to_string() }
}

/// SHA-256 of `bytes`, in hexadecimal digits.
#[must_use]
pub fn fingerprint(bytes: &[u8]) -> String {
    use sha2::{Digest, Sha256};
    use std::fmt::Write;
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}
