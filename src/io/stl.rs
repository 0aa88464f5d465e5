//! STL: loose triangles, as text or binary. A reference is all that they can be, so they are read
//! only; corners in exactly the same place become one vertex.
//!
//! Read here and not by the crate `stl_io`, which wants to seek (packed files and pipes cannot) and
//! cuts the coordinates of text to 32 bits. Format: 3D Systems, *Stereolithography Interface
//! Specification*, 1988.

use std::io::BufRead;

use rustc_hash::FxHashMap;

use super::fault::{Located, whole};
use super::soup::{Content, Soup};
use super::source::read_exactly;
use super::text::{Lines, check_end, coordinates, excerpt, short_line, trim};
use super::{Dropped, Format, ReadFault, ReadOptions};

/// Stereolithography files.
pub const STL: Format =
    Format { name: "stl", extensions: &["stl"], starts: &["solid"], read, write: None };

/// Words that may begin a line of a text, besides `vertex` and `endloop`.
const FRAME: &[&[u8]] = &[b"solid", b"facet", b"outer", b"endfacet", b"endsolid"];

fn read(source: &mut dyn BufRead, options: &ReadOptions) -> Result<Content, Located> {
    let mut triangles = Triangles { soup: Soup::new(options), numbers: FxHashMap::default() };
    if is_text(source.fill_buf().map_err(whole)?) {
        let mut lines = Lines::new(source).map_err(whole)?;
        let read = triangles.read_text(&mut lines);
        read.map_err(|fault| (Some(lines.number()), fault))?;
    } else {
        triangles.read_binary(source).map_err(whole)?;
    }
    triangles.soup.finish(Dropped::default()).map_err(whole)
}

/// Binary files may begin with `solid`, too, but soon have bytes that no text has.
fn is_text(start: &[u8]) -> bool {
    let start = start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start);
    let control = |b: &u8| *b < b' ' && !super::text::is_blank(*b);
    trim(start).starts_with(b"solid") && !start.iter().any(control)
}

struct Triangles<'a> {
    soup: Soup<'a>,
    /// The vertex at each place.
    numbers: FxHashMap<[u64; 3], usize>,
}

impl Triangles<'_> {
    fn read_text(&mut self, lines: &mut Lines<'_>) -> Result<(), ReadFault> {
        let (mut corners, mut open) = (0, false);
        while lines.advance_to_words()? {
            let mut words = lines.words();
            match words.next().unwrap_or_default() {
                b"vertex" => {
                    let reason = "a vertex with fewer than three coordinates";
                    let short = || short_line(lines.text(), lines.is_terminated(), reason);
                    let point = coordinates(&mut words)?.ok_or_else(short)?;
                    let word = |axis| lines.words().nth(1 + axis);
                    self.corner(point, |axis| word(axis).map(excerpt).unwrap_or_default())?;
                    corners += 1;
                }
                b"endloop" if corners != 3 => {
                    return Err(unknown(lines, "a loop without three vertices"));
                }
                b"endloop" => {
                    self.soup.end_face()?;
                    corners = 0;
                }
                word if FRAME.contains(&word) => open = word != b"endsolid",
                _ => return Err(unknown(lines, "a line that is no STL statement")),
            }
        }
        if open { Err(ReadFault::Cut { text: excerpt(lines.text()) }) } else { Ok(()) }
    }

    fn read_binary(&mut self, source: &mut dyn BufRead) -> Result<(), ReadFault> {
        let mut header = [0; 84];
        read_exactly(source, &mut header, || short("headers", 0, 1))?;
        let [.., a, b, c, d] = header;
        let announced = u64::from(u32::from_le_bytes([a, b, c, d]));
        self.soup.tally.announce(0, announced)?;
        for found in 0..announced {
            // The normal, three corners, and two bytes that mean nothing.
            let mut triangle = [0; 50];
            read_exactly(source, &mut triangle, || short("triangles", found, announced))?;
            for corner in triangle[12..48].chunks_exact(12) {
                let mut point = [0.0; 3];
                for (x, bytes) in point.iter_mut().zip(corner.chunks_exact(4)) {
                    *x = f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]).into();
                }
                self.corner(point, |axis| point[axis].to_string())?;
            }
            self.soup.end_face()?;
        }
        check_end(source)
    }

    /// A corner of the current triangle, at a vertex that is there already or a new one.
    fn corner(&mut self, point: [f64; 3], text: impl Fn(usize) -> String) -> Result<(), ReadFault> {
        // Adding zero makes one number of both zeros.
        let place = point.map(|x| (x + 0.0).to_bits());
        let next = self.numbers.len();
        let vertex = *self.numbers.entry(place).or_insert(next);
        if vertex == next {
            self.soup.vertex(point, text)?;
        }
        self.soup.corner(vertex as f64, self.numbers.len())
    }
}

fn short(what: &str, found: u64, announced: u64) -> ReadFault {
    ReadFault::Short { what: what.to_owned(), found, announced }
}

fn unknown(lines: &Lines<'_>, reason: &'static str) -> ReadFault {
    ReadFault::Syntax {
        reason,
        text: excerpt(lines.text()),
        advice: "correct the file or export it again",
    }
}
