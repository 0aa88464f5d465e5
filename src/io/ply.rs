//! Polygon files: a header that declares elements, and their data as text or binary.
//!
//! Coordinates are written as `double`, so that they stay as they are to the last bit. Properties
//! other than places and corners are dropped.
//!
//! Read here and not by the crate `ply-rs-bw`, which gathers all elements of a kind, each with its
//! own vector, before they can be looked at, and text lines of any length; its messages know no
//! vertex. Format: G. Turk, *The PLY Polygon File Format*, 1994.

mod header;

use std::io::{self, BufRead, Write};

use self::header::{Element, Encoding, Header, Property, Scalar};
use super::fault::{Located, whole};
use super::soup::{Content, Soup};
use super::source::read_exactly;
use super::text::{
    Lines, check_end, excerpt, is_blank, number, short_line, words, write_number, write_rows,
};
use super::{Colour, Dropped, Format, ReadFault, ReadOptions};
use crate::mesh::PolyMesh;

/// Polygon files, written in binary with the small end first.
pub const PLY: Format = Format {
    name: "ply",
    extensions: &["ply"],
    starts: &["ply"],
    read,
    write: Some(|mesh, colours, out| write(mesh, colours, Encoding::LittleEndian, out)),
};

/// The same, written as text.
pub const PLY_ASCII: Format = Format {
    name: "ply-ascii",
    write: Some(|mesh, colours, out| write(mesh, colours, Encoding::Ascii, out)),
    ..PLY
};

/// The same, written in binary with the big end first.
pub const PLY_BIG_ENDIAN: Format = Format {
    name: "ply-big-endian",
    write: Some(|mesh, colours, out| write(mesh, colours, Encoding::BigEndian, out)),
    ..PLY
};

fn read(source: &mut dyn BufRead, options: &ReadOptions) -> Result<Content, Located> {
    let mut lines = Lines::new(source).map_err(whole)?;
    let header = Header::read(&mut lines).map_err(|fault| (Some(lines.number()), fault))?;
    let binary = header.encoding != Encoding::Ascii;
    let mut body = Body {
        values: Values { lines, encoding: header.encoding, element: None, at: 0 },
        soup: Soup::new(options),
        dropped: Dropped::default(),
    };
    if let Err(fault) = body.read(&header) {
        return Err(((!binary).then(|| body.values.lines.number()), fault));
    }
    body.soup.finish(body.dropped).map_err(whole)
}

/// The data behind the header, on their way into a mesh.
struct Body<'a, 'h> {
    values: Values<'a, 'h>,
    soup: Soup<'a>,
    dropped: Dropped,
}

impl<'h> Body<'_, 'h> {
    fn read(&mut self, header: &'h Header) -> Result<(), ReadFault> {
        let vertices = header.count("vertex");
        self.soup.tally.announce(vertices, header.count("face"))?;
        // An element without properties has no data, however many there are.
        for element in header.elements.iter().filter(|e| !e.properties.is_empty()) {
            match element.name.as_str() {
                "vertex" => self.read_vertices(element)?,
                "face" => self.read_faces(element, vertices as usize)?,
                _ => self.skip(element)?,
            }
        }
        check_end(self.values.lines.source())
    }

    fn read_vertices(&mut self, element: &'h Element) -> Result<(), ReadFault> {
        let axes = ["x", "y", "z"].map(|axis| element.position(&[axis], false));
        let [Some(x), Some(y), Some(z)] = axes else {
            return Err(undeclared(element, "vertices without x, y and z"));
        };
        if element.properties.len() > 3 {
            self.dropped.note("normals, colours and other values of vertices", element.line);
        }
        for found in 0..element.count {
            self.values.begin(element, found)?;
            let mut point = [0.0; 3];
            for (i, property) in element.properties.iter().enumerate() {
                if property.length.is_some() {
                    self.values.skip(property)?;
                    continue;
                }
                let value = self.values.next(property.scalar)?;
                if let Some(axis) = [x, y, z].iter().position(|&at| at == i) {
                    point[axis] = value;
                }
            }
            self.values.end()?;
            self.soup.vertex(point, |axis| point[axis].to_string())?;
        }
        Ok(())
    }

    fn read_faces(&mut self, element: &'h Element, vertices: usize) -> Result<(), ReadFault> {
        let Some(corners) = element.position(&["vertex_indices", "vertex_index"], true) else {
            return Err(undeclared(element, "faces without a list vertex_indices"));
        };
        if element.properties.len() > 1 {
            self.dropped.note("colours and other values of faces", element.line);
        }
        for found in 0..element.count {
            self.values.begin(element, found)?;
            for (i, property) in element.properties.iter().enumerate() {
                if i != corners {
                    self.values.skip(property)?;
                    continue;
                }
                for _ in 0..self.values.length(property)? {
                    self.soup.corner(self.values.next(property.scalar)?, vertices)?;
                }
            }
            self.values.end()?;
            self.soup.end_face()?;
        }
        Ok(())
    }

    fn skip(&mut self, element: &'h Element) -> Result<(), ReadFault> {
        self.dropped.note("elements other than vertices and faces", element.line);
        for found in 0..element.count {
            self.values.begin(element, found)?;
            element.properties.iter().try_for_each(|property| self.values.skip(property))?;
            self.values.end()?;
        }
        Ok(())
    }
}

/// The numbers of the elements, one after the other.
struct Values<'a, 'h> {
    lines: Lines<'a>,
    encoding: Encoding,
    /// The element that is being read, and how many of its kind have been.
    element: Option<(&'h Element, u64)>,
    /// How many bytes of the line have been read, of a text.
    at: usize,
}

impl<'h> Values<'_, 'h> {
    /// Goes to the next element: in a text, each has a line.
    fn begin(&mut self, element: &'h Element, found: u64) -> Result<(), ReadFault> {
        self.at = 0;
        self.element = Some((element, found));
        let any = match self.encoding {
            Encoding::Ascii => self.lines.advance_to_words()?,
            _ => !self.lines.source().fill_buf()?.is_empty(),
        };
        if any { Ok(()) } else { Err(short(self.element)) }
    }

    /// After the last property.
    fn end(&self) -> Result<(), ReadFault> {
        let text = self.lines.text();
        if self.encoding == Encoding::Ascii && words(&text[self.at..]).next().is_some() {
            return Err(ReadFault::Syntax {
                reason: "a line with more values than the header declares",
                text: excerpt(text),
                advice: "correct the line or export the file again",
            });
        }
        Ok(())
    }

    /// The next number; every type fits into an `f64`.
    fn next(&mut self, scalar: Scalar) -> Result<f64, ReadFault> {
        if self.encoding == Encoding::Ascii {
            return self.word();
        }
        let (mut bytes, size) = ([0; 8], scalar.size());
        let element = self.element;
        read_exactly(self.lines.source(), &mut bytes[..size], || short(element))?;
        if self.encoding == Encoding::BigEndian {
            bytes[..size].reverse();
        }
        Ok(scalar.value(bytes))
    }

    fn word(&mut self) -> Result<f64, ReadFault> {
        let rest = &self.lines.text()[self.at..];
        let Some(start) = rest.iter().position(|&b| !is_blank(b)) else {
            let reason = "a line with fewer values than the header declares";
            return Err(short_line(self.lines.text(), self.lines.is_terminated(), reason));
        };
        let word = rest[start..].split(|&b| is_blank(b)).next().unwrap_or_default();
        let value = number(word)?;
        self.at += start + word.len();
        Ok(value)
    }

    /// The length of a list.
    fn length(&mut self, property: &Property) -> Result<u64, ReadFault> {
        let Some(scalar) = property.length else { return Ok(1) };
        let length = self.next(scalar)?;
        if length >= 0.0 && length.fract() == 0.0 {
            return Ok(length as u64);
        }
        Err(ReadFault::Syntax {
            reason: "a list whose length is no count",
            text: length.to_string(),
            advice: "export the file again",
        })
    }

    fn skip(&mut self, property: &Property) -> Result<(), ReadFault> {
        for _ in 0..self.length(property)? {
            self.next(property.scalar)?;
        }
        Ok(())
    }
}

/// The file ends in or before this element.
fn short(element: Option<(&Element, u64)>) -> ReadFault {
    let name = element.map(|(e, _)| excerpt(e.name.as_bytes())).unwrap_or_default();
    let (announced, found) = element.map_or((0, 0), |(e, found)| (e.count, found));
    ReadFault::Short { what: format!("elements `{name}`"), found, announced }
}

fn undeclared(element: &Element, reason: &'static str) -> ReadFault {
    ReadFault::Syntax {
        reason,
        text: format!("element {}", excerpt(element.name.as_bytes())),
        advice: "export the file again as a polygon mesh",
    }
}

fn write(
    mesh: &PolyMesh,
    colours: Option<&[Colour]>,
    encoding: Encoding,
    out: &mut dyn Write,
) -> io::Result<()> {
    let longest = mesh.faces().map(<[u32]>::len).max().unwrap_or(0);
    // Some programs read no other lists than those of bytes; most faces are short enough.
    let long = u8::try_from(longest).is_err();
    write_header(mesh, colours.is_some(), (encoding, long), out)?;
    write_rows(out, mesh.vertex_count(), |v, out| {
        mesh.points()[v].iter().try_for_each(|&x| write_double(x, encoding, out))?;
        for part in colours.map_or(&[][..], |c| &c[v]) {
            write_whole((part * 255.0).round() as u8, encoding, out)?;
        }
        end_line(encoding, out)
    })?;
    write_rows(out, mesh.face_count(), |f, out| {
        let face = mesh.face(f);
        if long {
            write_whole(face.len() as u32, encoding, out)?;
        } else {
            write_whole(face.len() as u8, encoding, out)?;
        }
        face.iter().try_for_each(|&v| write_whole(v, encoding, out))?;
        end_line(encoding, out)
    })
}

fn write_header(
    mesh: &PolyMesh,
    coloured: bool,
    (encoding, long): (Encoding, bool),
    out: &mut dyn Write,
) -> io::Result<()> {
    writeln!(out, "ply\nformat {} 1.0\nelement vertex {}", encoding.name(), mesh.vertex_count())?;
    ["x", "y", "z"].iter().try_for_each(|axis| writeln!(out, "property double {axis}"))?;
    if coloured {
        let parts = ["red", "green", "blue"];
        parts.iter().try_for_each(|part| writeln!(out, "property uchar {part}"))?;
    }
    let length = if long { "uint" } else { "uchar" };
    writeln!(out, "element face {}", mesh.face_count())?;
    writeln!(out, "property list {length} uint vertex_indices\nend_header")
}

fn write_double(x: f64, encoding: Encoding, out: &mut dyn Write) -> io::Result<()> {
    match encoding {
        Encoding::Ascii => write_number(out, x),
        Encoding::LittleEndian => out.write_all(&x.to_le_bytes()),
        Encoding::BigEndian => out.write_all(&x.to_be_bytes()),
    }
}

/// Writes a whole number in as many bytes as its type has.
fn write_whole<N: Into<u32> + Copy>(
    number: N,
    encoding: Encoding,
    out: &mut dyn Write,
) -> io::Result<()> {
    let (whole, size): (u32, usize) = (number.into(), size_of::<N>());
    match encoding {
        Encoding::Ascii => write!(out, " {whole}"),
        Encoding::LittleEndian => out.write_all(&whole.to_le_bytes()[..size]),
        Encoding::BigEndian => out.write_all(&whole.to_be_bytes()[4 - size..]),
    }
}

fn end_line(encoding: Encoding, out: &mut dyn Write) -> io::Result<()> {
    if encoding == Encoding::Ascii { out.write_all(b"\n") } else { Ok(()) }
}
