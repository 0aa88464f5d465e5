//! Object File Format: counts, then a line for each vertex and a line for each face.
//!
//! Read are `OFF` and its kinds with normals, colours and texture coordinates, which are dropped
//! (`NOFF`, `COFF`, `STOFF`); written are `OFF` and, with colours, `COFF`. Format: Geomview manual,
//! *OFF files*.

use std::io::{self, BufRead, Write};

use super::fault::{Located, whole};
use super::soup::{Content, Soup};
use super::text::{
    Lines, coordinates, excerpt, number, short_line, words, write_number, write_rows,
};
use super::{Colour, Dropped, Format, ReadFault, ReadOptions};
use crate::mesh::PolyMesh;

/// The Object File Format.
pub const OFF: Format =
    Format { name: "off", extensions: &["off"], starts: KEYWORDS, read, write: Some(write) };

/// What a file may begin with.
const KEYWORDS: &[&str] = &["OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"];

fn read(source: &mut dyn BufRead, options: &ReadOptions) -> Result<Content, Located> {
    let mut rows = Rows { lines: Lines::new(source).map_err(whole)? };
    let (mut soup, mut dropped) = (Soup::new(options), Dropped::default());
    let body = rows.read_body(&mut soup, &mut dropped);
    body.map_err(|fault| (Some(rows.lines.number()), fault))?;
    soup.finish(dropped).map_err(whole)
}

/// The lines that have more than a comment.
struct Rows<'a> {
    lines: Lines<'a>,
}

impl Rows<'_> {
    fn read_body(&mut self, soup: &mut Soup<'_>, dropped: &mut Dropped) -> Result<(), ReadFault> {
        let (vertices, faces) = self.read_header()?;
        soup.tally.announce(vertices, faces)?;
        for found in 0..vertices {
            self.advance("vertices", found, vertices)?;
            self.read_vertex(soup, dropped)?;
        }
        for found in 0..faces {
            self.advance("faces", found, faces)?;
            self.read_face(vertices as usize, soup, dropped)?;
        }
        if self.next()? { Err(ReadFault::Trailing) } else { Ok(()) }
    }

    /// How many vertices and faces there are; the counts may stand beside the keyword.
    fn read_header(&mut self) -> Result<(u64, u64), ReadFault> {
        if !self.next()? {
            return Err(ReadFault::Empty);
        }
        let mut words = self.words();
        let keyword = words.next().unwrap_or_default();
        if !KEYWORDS.iter().any(|k| k.as_bytes() == keyword) {
            return Err(unknown_keyword(keyword));
        }
        match words.next() {
            Some(b"BINARY") => return Err(unknown_keyword(b"binary OFF")),
            Some(_) => return self.counts(1),
            None => {}
        }
        drop(words);
        self.advance("lines of counts", 0, 1)?;
        self.counts(0)
    }

    /// The numbers of vertices and faces; that of edges is often wrong and never needed.
    fn counts(&self, skipped: usize) -> Result<(u64, u64), ReadFault> {
        let mut words = self.words().skip(skipped);
        match (words.next(), words.next()) {
            (Some(vertices), Some(faces)) => Ok((count(vertices)?, count(faces)?)),
            _ => Err(self.short("a line without the numbers of vertices and faces")),
        }
    }

    fn read_vertex(&self, soup: &mut Soup<'_>, dropped: &mut Dropped) -> Result<(), ReadFault> {
        let mut words = self.words();
        let Some(point) = coordinates(&mut words)? else {
            return Err(self.short("a vertex with fewer than three coordinates"));
        };
        if words.next().is_some() {
            dropped.note("normals, colours and texture coordinates", self.lines.number());
        }
        soup.vertex(point, |axis| self.words().nth(axis).map(excerpt).unwrap_or_default())
    }

    fn read_face(
        &self,
        vertices: usize,
        soup: &mut Soup<'_>,
        dropped: &mut Dropped,
    ) -> Result<(), ReadFault> {
        let mut words = self.words();
        for _ in 0..count(words.next().unwrap_or_default())? {
            let word = words.next().ok_or_else(|| self.short("a face with too few corners"))?;
            soup.corner(number(word)?, vertices)?;
        }
        if words.next().is_some() {
            dropped.note("colours of faces", self.lines.number());
        }
        soup.end_face()
    }

    fn advance(&mut self, what: &str, found: u64, announced: u64) -> Result<(), ReadFault> {
        let short = || ReadFault::Short { what: what.to_owned(), found, announced };
        if self.next()? { Ok(()) } else { Err(short()) }
    }

    fn next(&mut self) -> Result<bool, ReadFault> {
        while self.lines.advance_to_words()? {
            if self.words().next().is_some() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The words of the line before a comment.
    fn words(&self) -> impl Iterator<Item = &[u8]> {
        words(self.lines.text().split(|&b| b == b'#').next().unwrap_or_default())
    }

    fn short(&self, reason: &'static str) -> ReadFault {
        short_line(self.lines.text(), self.lines.is_terminated(), reason)
    }
}

fn count(word: &[u8]) -> Result<u64, ReadFault> {
    let parsed = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
    parsed.ok_or_else(|| ReadFault::Syntax {
        reason: "a word that is no count",
        text: excerpt(word),
        advice: "correct the line",
    })
}

fn unknown_keyword(keyword: &[u8]) -> ReadFault {
    let known: &[&[u8]] = &[b"4OFF", b"nOFF", b"4nOFF", b"binary OFF"];
    if known.contains(&keyword) {
        let variant = String::from_utf8_lossy(keyword).into_owned();
        return ReadFault::Variant { variant, instead: "text OFF in three dimensions" };
    }
    ReadFault::Syntax {
        reason: "a first word that is no OFF",
        text: excerpt(keyword),
        advice: "OFF files begin with `OFF`: correct the file, or its name",
    }
}

fn write(mesh: &PolyMesh, colours: Option<&[Colour]>, out: &mut dyn Write) -> io::Result<()> {
    let keyword = if colours.is_some() { "COFF" } else { "OFF" };
    writeln!(out, "{keyword}\n{} {} 0", mesh.vertex_count(), mesh.face_count())?;
    write_rows(out, mesh.vertex_count(), |v, out| {
        let numbers = mesh.points()[v].iter().chain(colours.map_or(&[][..], |c| &c[v]));
        write_row(out, numbers, colours.is_some())
    })?;
    write_rows(out, mesh.face_count(), |f, out| {
        write!(out, "{}", mesh.face(f).len())?;
        mesh.face(f).iter().try_for_each(|v| write!(out, " {v}"))?;
        out.write_all(b"\n")
    })
}

/// Numbers between blanks; after colours, the opacity.
fn write_row<'a>(
    out: &mut dyn Write,
    mut numbers: impl Iterator<Item = &'a f64>,
    opaque: bool,
) -> io::Result<()> {
    numbers.try_for_each(|&x| write_number(out, x))?;
    out.write_all(if opaque { b" 1\n" } else { b"\n" })
}
