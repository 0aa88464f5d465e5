//! What the header of a PLY file says about the data behind it.

use crate::io::ReadFault;
use crate::io::text::{Lines, excerpt, words};

/// How numbers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

impl Encoding {
    /// Its name in files.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Ascii => "ascii",
            Self::LittleEndian => "binary_little_endian",
            Self::BigEndian => "binary_big_endian",
        }
    }
}

/// A type of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// Names of types, in the words of 1994 and later ones.
const SCALARS: &[(Scalar, [&str; 2])] = &[
    (Scalar::I8, ["char", "int8"]),
    (Scalar::U8, ["uchar", "uint8"]),
    (Scalar::I16, ["short", "int16"]),
    (Scalar::U16, ["ushort", "uint16"]),
    (Scalar::I32, ["int", "int32"]),
    (Scalar::U32, ["uint", "uint32"]),
    (Scalar::F32, ["float", "float32"]),
    (Scalar::F64, ["double", "float64"]),
];

impl Scalar {
    /// Bytes of a number.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number that these bytes are, the small end first.
    pub(super) fn value(self, bytes: [u8; 8]) -> f64 {
        let [a, b, c, d, ..] = bytes;
        match self {
            Self::I8 => i8::from_le_bytes([a]).into(),
            Self::U8 => a.into(),
            Self::I16 => i16::from_le_bytes([a, b]).into(),
            Self::U16 => u16::from_le_bytes([a, b]).into(),
            Self::I32 => i32::from_le_bytes([a, b, c, d]).into(),
            Self::U32 => u32::from_le_bytes([a, b, c, d]).into(),
            Self::F32 => f32::from_le_bytes([a, b, c, d]).into(),
            Self::F64 => f64::from_le_bytes(bytes),
        }
    }
}

/// What an element has: a number, or a list with the type of its length.
#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) length: Option<Scalar>,
    pub(super) scalar: Scalar,
}

/// Things of one kind.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    /// Line of its declaration.
    pub(super) line: usize,
}

impl Element {
    /// Where the property of one of these names stands.
    pub(super) fn position(&self, names: &[&str], is_list: bool) -> Option<usize> {
        let fits = |p: &Property| p.length.is_some() == is_list && names.contains(&&*p.name);
        self.properties.iter().position(fits)
    }
}

/// The whole header.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
}

impl Header {
    pub(super) fn read(lines: &mut Lines<'_>) -> Result<Self, ReadFault> {
        advance(lines)?;
        if lines.words().ne([b"ply"]) {
            return Err(fault(lines, "a first line that is not `ply`"));
        }
        let (mut encoding, mut elements) = (None, Vec::new());
        loop {
            advance(lines)?;
            let text = std::str::from_utf8(lines.text());
            let text = text.unwrap_or_default().split_ascii_whitespace().collect::<Vec<_>>();
            match text[..] {
                ["format", name, "1.0"] => encoding = Some(find_encoding(lines, name)?),
                ["element", name, count] => elements.push(element(lines, &elements, name, count)?),
                ["property", ref rest @ ..] => {
                    let property = property(rest);
                    let element = elements.last_mut().zip(property);
                    let (element, property) =
                        element.ok_or_else(|| fault(lines, "a property that is not understood"))?;
                    element.properties.push(property);
                }
                ["end_header"] => break,
                _ if is_comment(lines) => {}
                _ => return Err(fault(lines, "a line that is no part of a PLY header")),
            }
        }
        let encoding = encoding.ok_or_else(|| fault(lines, "a header without `format`"))?;
        Ok(Self { encoding, elements })
    }

    /// How many elements of a name there are.
    pub(super) fn count(&self, name: &str) -> u64 {
        self.elements.iter().find(|e| e.name == name).map_or(0, |e| e.count)
    }
}

fn advance(lines: &mut Lines<'_>) -> Result<(), ReadFault> {
    let text = || ReadFault::Cut { text: excerpt(b"the header") };
    if lines.advance()? { Ok(()) } else { Err(text()) }
}

/// Comments may be in any encoding.
fn is_comment(lines: &Lines<'_>) -> bool {
    matches!(words(lines.text()).next(), None | Some(b"comment" | b"obj_info"))
}

fn find_encoding(lines: &Lines<'_>, name: &str) -> Result<Encoding, ReadFault> {
    let known = [Encoding::Ascii, Encoding::LittleEndian, Encoding::BigEndian];
    let found = known.into_iter().find(|e| e.name() == name);
    found.ok_or_else(|| fault(lines, "a format that is not known"))
}

fn element(
    lines: &Lines<'_>,
    before: &[Element],
    name: &str,
    count: &str,
) -> Result<Element, ReadFault> {
    let count = count.parse().map_err(|_| fault(lines, "a count that is no whole number"))?;
    if before.iter().any(|e| e.name == name) {
        return Err(fault(lines, "an element that was declared before"));
    }
    Ok(Element { name: name.to_owned(), count, properties: Vec::new(), line: lines.number() })
}

fn property(words: &[&str]) -> Option<Property> {
    let scalar = |name: &str| Some(SCALARS.iter().find(|(_, names)| names.contains(&name))?.0);
    let (length, name, of) = match *words {
        ["list", length, of, name] => (Some(scalar(length)?), name, of),
        [of, name] => (None, name, of),
        _ => return None,
    };
    Some(Property { name: name.to_owned(), length, scalar: scalar(of)? })
}

fn fault(lines: &Lines<'_>, reason: &'static str) -> ReadFault {
    ReadFault::Syntax {
        reason,
        text: excerpt(lines.text()),
        advice: "correct the header or export the file again",
    }
}
