//! What can go wrong with a file, and what to do about it.

use std::io;

use thiserror::Error;

use crate::mesh::MeshError;

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

/// A fault and its line, from 1, if it has one.
pub(super) type Located = (Option<usize>, ReadFault);

/// A fault of the whole file.
pub(super) fn whole(fault: impl Into<ReadFault>) -> Located {
    (None, fault.into())
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
    #[error("is not a text file (byte {offset} is zero); export it as text in UTF-8")]
    Binary {
        /// Where the first zero byte is, from 0.
        offset: u64,
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
    /// A variant of the format that is not read.
    #[error("is {variant}, which is not read; export it as {instead}")]
    Variant {
        /// What it is.
        variant: String,
        /// What would be read.
        instead: &'static str,
    },
    /// The file stops in the middle of a line.
    #[error("the file ends in the middle of a line (`{text}`); it was cut: copy it again")]
    Cut {
        /// What there is of the line.
        text: String,
    },
    /// The file stops before all that it announces.
    #[error("the file ends after {found} of {announced} {what}; it was cut: copy it again")]
    Short {
        /// What there is too little of.
        what: String,
        /// How many there are.
        found: u64,
        /// How many there should be.
        announced: u64,
    },
    /// The file goes on after all that it announces.
    #[error(
        "the file goes on after all that its header announces; the counts of the header are \
         wrong: write it again"
    )]
    Trailing,
    /// Packed data that cannot be unpacked.
    #[error("the gzip data is damaged or was cut ({0}); copy it again")]
    Packed(io::Error),
    /// Packed data of an improbable size: a bomb, or a file without any content.
    #[error(
        "unpacks to more than {times} times its size; if it is a mesh all the same, unpack it \
         before, or allow more with --set read.expansion=2000"
    )]
    Expansion {
        /// The limit, `read.expansion`.
        times: u32,
    },
    /// More of something than the options allow.
    #[error(
        "has more than {limit} {what}; if that is right, allow more with --set read.{knob}=N, \
         otherwise write the file again"
    )]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many are allowed.
        limit: u32,
        /// The key of the limit in section `read`.
        knob: &'static str,
    },
    /// A face names a vertex that does not exist.
    #[error(
        "face {face} names vertex {index}, but the file has {}; the file is damaged or cut: write \
         it again", numbers(*.first, *.vertices)
    )]
    IndexOutOfRange {
        /// Number of the face in the file, from 1.
        face: usize,
        /// The index as it is written.
        index: String,
        /// The number of the first vertex in this format.
        first: usize,
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

/// The numbers that vertices have, in words.
fn numbers(first: usize, vertices: usize) -> String {
    match vertices.checked_sub(1) {
        None => "no vertices before it".to_owned(),
        Some(others) => format!("vertices {first} to {}", first + others),
    }
}

/// A fault that went through a reader of the standard library comes out as it was.
impl From<io::Error> for ReadFault {
    fn from(error: io::Error) -> Self {
        error.downcast::<ReadFault>().unwrap_or_else(ReadFault::Unreadable)
    }
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
