//! Reading and writing meshes: one file a format, found by the extension of the file name.
//!
//! A format is one [`Format`] and one line in [`FORMATS`]. Reading gives a soup of polygons as the
//! file has it; `mesh::mend` makes it fit to be edited. Files are read and written in one pass, and
//! never held as a whole. Packed files (`mesh.ply.gz`) are unpacked on the way. The path `-` stands
//! for standard input, whose format its first bytes tell, and for standard output.
//!
//! *Invariant:* nothing is printed; what a person should know comes back as a [`Warning`].

mod atomic;
mod fault;
mod obj;
mod off;
mod options;
mod ply;
mod soup;
mod source;
mod stl;
mod text;

use std::fmt;
use std::fs::File;
use std::io::{self, BufRead, Read, Write};
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;

use crate::mesh::PolyMesh;

pub use atomic::{check_place, write_atomically};
pub use fault::{ReadError, ReadFault, WriteError};
pub use obj::OBJ;
pub use off::OFF;
pub use options::ReadOptions;
pub use ply::{PLY, PLY_ASCII, PLY_BIG_ENDIAN};
pub use source::fingerprint;
pub use stl::STL;

use fault::{Located, whole};
use soup::Content;
use source::Fingerprinted;

/// All formats, the default one first. Of several with the same extension, the first is written.
pub const FORMATS: &[Format] = &[OBJ, PLY, PLY_ASCII, PLY_BIG_ENDIAN, OFF, STL];

/// Red, green and blue, from 0 to 1.
pub type Colour = [f64; 3];

/// A file format for polygon meshes.
#[derive(Debug, Clone, Copy)]
pub struct Format {
    /// What it is called on the command line.
    pub name: &'static str,
    /// File name extensions in lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// How such a file may begin.
    starts: &'static [&'static str],
    read: fn(&mut dyn BufRead, &ReadOptions) -> Result<Content, Located>,
    /// Writes a mesh so that reading it gives the same points and faces again.
    write: Option<Writer>,
}

/// Writes a mesh, perhaps with a colour for each vertex.
type Writer = fn(&PolyMesh, Option<&[Colour]>, &mut dyn Write) -> io::Result<()>;

impl Format {
    /// The format called `name`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        FORMATS.iter().find(|f| f.name == name).copied()
    }

    /// The format that the name of a file tells, packed or not.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        format_of(path).ok()
    }

    /// Whether meshes can be written in it.
    #[must_use]
    pub fn is_written(&self) -> bool {
        self.write.is_some()
    }

    /// Reads a whole file, packed or not, from `source`; `file` is its name, for messages. Linear
    /// in its size.
    pub fn read(
        self,
        source: impl Read,
        file: &str,
        options: &ReadOptions,
    ) -> Result<Loaded, ReadError> {
        read_from(source, Some(self), file, options)
    }

    /// The bytes of a mesh in this format, not packed; none if it is not written.
    #[must_use]
    pub fn bytes(self, mesh: &PolyMesh, colours: Option<&[Colour]>) -> Vec<u8> {
        let mut bytes = Vec::new();
        // A vector takes everything.
        let _ = self.write.map(|write| write(mesh, colours, &mut bytes));
        bytes
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
        /// First line that has or announces any of it, from 1.
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

/// What a reader left out, in words, each once, with its first line.
#[derive(Debug, Default)]
struct Dropped(Vec<(&'static str, usize)>);

impl Dropped {
    fn note(&mut self, what: &'static str, line: usize) {
        if self.0.iter().all(|&(known, _)| known != what) {
            self.0.push((what, line));
        }
    }

    fn warning(self, file: &str) -> Option<Warning> {
        let line = self.0.iter().map(|&(_, line)| line).min()?;
        let what = self.0.into_iter().map(|(what, _)| what).collect();
        Some(Warning::Dropped { file: file.to_owned(), what, line })
    }
}

/// Reads the mesh at `path`, as large as it may be by default; `-` is standard input.
pub fn read(path: &Path) -> Result<Loaded, ReadError> {
    read_within(path, &ReadOptions::default())
}

/// Reads the mesh at `path` within limits; `-` is standard input.
pub fn read_within(path: &Path, options: &ReadOptions) -> Result<Loaded, ReadError> {
    let file = display_name(path, "standard input");
    if is_standard_stream(path) {
        return read_from(io::stdin().lock(), None, &file, options);
    }
    let fail = |fault| ReadError { file: file.clone(), line: None, fault };
    // A missing file or a folder is the better news, whatever it is called.
    let source = open(path).map_err(fail)?;
    let format = format_of(path).map_err(|extension| {
        fail(ReadFault::UnknownFormat { extension, known: extensions(|_| true) })
    })?;
    format.read(source, &file, options)
}

fn open(path: &Path) -> Result<File, ReadFault> {
    match File::open(path) {
        _ if path.is_dir() => Err(ReadFault::Directory),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Err(ReadFault::Missing),
        opened => opened.map_err(ReadFault::Unreadable),
    }
}

/// Reads a mesh in a format, or in the one that its first bytes tell.
fn read_from(
    source: impl Read,
    format: Option<Format>,
    file: &str,
    options: &ReadOptions,
) -> Result<Loaded, ReadError> {
    let mut source = Fingerprinted::new(source);
    let content = source.open(options, |content| match content.fill_buf().map_err(whole)? {
        [] => Err(whole(ReadFault::Empty)),
        start => (format.unwrap_or_else(|| format_that_starts(start)).read)(content, options),
    });
    let content =
        content.map_err(|(line, fault)| ReadError { file: file.to_owned(), line, fault })?;
    let warnings = content.dropped.warning(file).into_iter().collect();
    Ok(Loaded { mesh: content.mesh, warnings, sha256: source.sha256() })
}

/// The format whose files start like this; the first of all if none does.
fn format_that_starts(bytes: &[u8]) -> Format {
    let starts = |f: &&Format| f.starts.iter().any(|start| bytes.starts_with(start.as_bytes()));
    FORMATS.iter().find(starts).copied().unwrap_or(OBJ)
}

/// Writes `mesh` to `path`, whole or not at all; `-` is standard output.
pub fn write(path: &Path, mesh: &PolyMesh) -> Result<(), WriteError> {
    Destination::new(path, None)?.write(mesh)
}

/// Where a mesh goes, and in what format.
#[derive(Debug, Clone, Copy)]
pub struct Destination<'a> {
    path: &'a Path,
    write: Writer,
}

impl<'a> Destination<'a> {
    /// A file in the format that is given or that its name tells; `-` is standard output. Fails if
    /// there could be no such file, so that a long computation need not end with a mesh that has
    /// nowhere to go.
    pub fn new(path: &'a Path, format: Option<Format>) -> Result<Self, WriteError> {
        check_place(path)?;
        let format = format.map_or_else(|| format_of(path), Ok);
        let written = format.and_then(|format| {
            let words = || format!("of the format {} (it is only read)", format.name);
            format.write.ok_or_else(words)
        });
        let write = written.map_err(|extension| WriteError::UnknownFormat {
            file: path.display().to_string(),
            extension,
            known: extensions(Format::is_written),
        })?;
        Ok(Self { path, write })
    }

    /// Writes `mesh`, whole or not at all.
    pub fn write(&self, mesh: &PolyMesh) -> Result<(), WriteError> {
        self.write_with(mesh, None)
    }

    /// Writes `mesh` with a colour for each vertex, whole or not at all.
    ///
    /// # Panics
    /// If there is not one colour for each vertex: that is a bug of the caller.
    pub fn write_coloured(&self, mesh: &PolyMesh, colours: &[Colour]) -> Result<(), WriteError> {
        assert_eq!(colours.len(), mesh.vertex_count(), "one colour for each vertex");
        self.write_with(mesh, Some(colours))
    }

    fn write_with(&self, mesh: &PolyMesh, colours: Option<&[Colour]>) -> Result<(), WriteError> {
        write_atomically(self.path, |out| {
            if !is_packed(self.path) {
                return (self.write)(mesh, colours, out);
            }
            // No name and no time: the same mesh gives the same bytes.
            let mut packed = GzEncoder::new(out, Compression::default());
            (self.write)(mesh, colours, &mut packed)?;
            packed.finish().map(|_| ())
        })
    }
}

/// The format that the name tells, or its extension in words.
fn format_of(path: &Path) -> Result<Format, String> {
    if is_standard_stream(path) {
        return Ok(FORMATS[0]);
    }
    let packed = is_packed(path).then(|| path.with_extension(""));
    let extension = lower_extension(packed.as_deref().unwrap_or(path));
    let known = |f: &&Format| extension.as_deref().is_some_and(|e| f.extensions.contains(&e));
    FORMATS.iter().find(known).copied().ok_or_else(|| {
        let end = if packed.is_some() { ".gz" } else { "" };
        extension.map_or("without an extension".into(), |e| format!("named `.{e}{end}`"))
    })
}

/// The extensions of some formats, each once.
fn extensions(which: impl Fn(&Format) -> bool) -> String {
    let mut known: Vec<String> = FORMATS
        .iter()
        .filter(|f| which(f))
        .flat_map(|f| f.extensions)
        .map(|e| format!(".{e}"))
        .collect();
    known.dedup();
    known.join(", ") + ", each also with .gz"
}

fn is_packed(path: &Path) -> bool {
    lower_extension(path).as_deref() == Some("gz")
}

fn lower_extension(path: &Path) -> Option<String> {
    path.extension().map(|e| e.to_string_lossy().to_lowercase())
}

fn is_standard_stream(path: &Path) -> bool {
    path.as_os_str() == "-"
}

fn display_name(path: &Path, stream: &str) -> String {
    if is_standard_stream(path) { stream.to_owned() } else { path.display().to_string() }
}
