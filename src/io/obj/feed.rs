//! What `tobj` is given to read: one canonical line at a time, checked, and with its number.
//!
//! `tobj` starts a new model with its own vertices at every `o`, `g` and change of material,
//! takes `l 1 2 3` for a triangle, numbers vertices by first use, stumbles over continuations and
//! trailing comments, and says neither the line of an error nor that an index is out of range
//! before the end. So it gets `v` and `f` lines only, with three coordinates and bare indices,
//! and after them an *anchor*: a face that uses every vertex in order. There is then one model, its
//! last face says where each vertex has gone, and the line that fails is the one handed out last.

use std::collections::HashMap;
use std::io::{self, BufRead, Read, Write};

use super::statements::{Statement, Statements};
use crate::io::fault::Located;
use crate::io::soup::{Tally, vertex_at};
use crate::io::text::{coordinates, excerpt, short_line};
use crate::io::{Dropped, ReadFault};

/// Keywords of the format that carry no polygon, and what they stand for.
const IGNORED: &[(&str, &[&str])] = &[
    ("texture coordinates", &["vt"]),
    ("normals", &["vn"]),
    (
        "materials and display settings",
        &[
            "usemtl",
            "mtllib",
            "usemap",
            "maplib",
            "bevel",
            "c_interp",
            "d_interp",
            "lod",
            "shadow_obj",
            "trace_obj",
        ],
    ),
    ("smoothing groups", &["s", "mg"]),
    ("lines and points", &["l", "p"]),
    (
        "free-form curves and surfaces",
        &[
            "vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole",
            "scrv", "sp", "end", "con", "ctech", "stech", "bsp", "bzp", "cdc", "cdp", "res",
        ],
    ),
    ("scripts", &["call", "csh"]),
];

/// Lines for `tobj`, and what it cannot be told: groups, losses, and the fault if there is one.
pub(super) struct Feed<'a> {
    statements: Statements<'a>,
    /// The statement behind the line that is being read.
    pub(super) current: Statement,
    /// The canonical line that is being read, with its end.
    out: Vec<u8>,
    /// How much of it has been read.
    at: usize,
    /// Whether the anchor has been made.
    anchored: bool,
    pub(super) tally: Tally<'a>,
    ahead: Ahead,
    group_of_name: HashMap<String, u32>,
    current_name: String,
    /// Group of the faces that follow, once a face has used it.
    current_group: Option<u32>,
    /// Group of each face.
    pub(super) groups: Vec<u32>,
    /// Names of the groups; the first is the empty one.
    pub(super) group_names: Vec<String>,
    /// What was left out.
    pub(super) dropped: Dropped,
    /// What our own checks found, and where.
    pub(super) fault: Option<Located>,
}

/// Corners that name vertices which come later in the file, or not at all: each has a larger index
/// than those before it, so that the first one out of range is among them.
#[derive(Debug, Default)]
struct Ahead {
    largest: i64,
    /// Index as it is written, its value, face and line.
    corners: Vec<(String, i64, usize, usize)>,
}

impl<'a> Feed<'a> {
    pub(super) fn new(statements: Statements<'a>, tally: Tally<'a>) -> Self {
        Self {
            statements,
            current: Statement::default(),
            out: Vec::new(),
            at: 0,
            anchored: false,
            tally,
            ahead: Ahead::default(),
            group_of_name: HashMap::from([(String::new(), 0)]),
            current_name: String::new(),
            current_group: Some(0),
            groups: Vec::new(),
            group_names: vec![String::new()],
            dropped: Dropped::default(),
            fault: None,
        }
    }

    /// Makes the next canonical line; none is left if it stays empty.
    fn advance(&mut self) -> io::Result<()> {
        self.out.clear();
        self.at = 0;
        let mut statement = std::mem::take(&mut self.current);
        let made = self.make_line(&mut statement);
        self.current = statement;
        made.map_err(|fault| {
            self.fault = Some(fault);
            io::Error::from(io::ErrorKind::InvalidData)
        })
    }

    fn make_line(&mut self, statement: &mut Statement) -> Result<(), Located> {
        while self.out.is_empty() {
            let next = self.statements.advance(statement);
            if !next.map_err(|fault| (Some(self.statements.line()), fault))? {
                return self.anchor();
            }
            self.take(statement).map_err(|fault| (Some(statement.line), fault))?;
        }
        Ok(())
    }

    /// A face that uses every vertex in order, once all are known.
    fn anchor(&mut self) -> Result<(), Located> {
        let vertices = self.tally.vertices;
        let ahead = std::mem::take(&mut self.ahead.corners);
        if let Some((index, _, face, line)) =
            ahead.into_iter().find(|&(_, value, ..)| vertex_at(value, 1, vertices).is_none())
        {
            return Err((Some(line), out_of_range(face, index, vertices)));
        }
        if std::mem::replace(&mut self.anchored, true) || vertices == 0 {
            return Ok(());
        }
        self.out.reserve(8 * vertices);
        self.out.push(b'f');
        for v in 1..=vertices {
            // A vector takes everything.
            let _ = write!(self.out, " {v}");
        }
        self.out.push(b'\n');
        Ok(())
    }

    fn take(&mut self, statement: &Statement) -> Result<(), ReadFault> {
        if statement.unfinished {
            return Err(ReadFault::Cut { text: excerpt(&statement.text) });
        }
        match statement.keyword() {
            b"v" => self.take_vertex(statement),
            b"f" | b"fo" => self.take_face(statement),
            b"g" | b"o" => self.take_group(statement),
            keyword => self.leave_out(statement, keyword),
        }
    }

    fn take_vertex(&mut self, statement: &Statement) -> Result<(), ReadFault> {
        let mut words = statement.words().skip(1);
        let reason = "a vertex with fewer than three coordinates";
        let short = || short_line(&statement.text, !statement.unterminated, reason);
        let point = coordinates(&mut words)?.ok_or_else(short)?;
        if words.next().is_some() {
            self.dropped.note("vertex colours and weights", statement.line);
        }
        let word = |axis| statement.words().nth(1 + axis);
        self.tally.vertex(point, |axis| word(axis).map(excerpt).unwrap_or_default())?;
        self.out.push(b'v');
        for word in statement.words().skip(1).take(3) {
            self.out.push(b' ');
            self.out.extend_from_slice(word);
        }
        self.out.push(b'\n');
        Ok(())
    }

    fn take_face(&mut self, statement: &Statement) -> Result<(), ReadFault> {
        self.out.push(b'f');
        let mut corners = 0;
        for word in statement.words().skip(1) {
            let index = vertex_index(word)?;
            self.check_index(index, statement.line)?;
            self.tally.corner()?;
            self.out.push(b' ');
            self.out.extend_from_slice(index);
            corners += 1;
        }
        self.out.push(b'\n');
        if corners < 3 && statement.unterminated {
            return Err(ReadFault::Cut { text: excerpt(&statement.text) });
        }
        let group = self.group();
        self.groups.push(group);
        self.tally.face()
    }

    /// Whether the vertex exists. A positive index may name one that comes later in the file, a
    /// negative one counts back from here.
    fn check_index(&mut self, index: &[u8], line: usize) -> Result<(), ReadFault> {
        let vertices = self.tally.vertices;
        let (face, shown) = (self.tally.faces + 1, || excerpt(index));
        // The text is an integer; one that does not fit is out of range as well.
        let value = std::str::from_utf8(index).ok().and_then(|text| text.parse::<i64>().ok());
        let value = value.ok_or_else(|| out_of_range(face, shown(), vertices))?;
        let first = if value < 0 { -(vertices as i64) } else { 1 };
        if vertex_at(value, first, vertices).is_some() {
            return Ok(());
        }
        if value <= 0 {
            return Err(out_of_range(face, shown(), vertices));
        }
        if value > self.ahead.largest {
            self.ahead.largest = value;
            self.ahead.corners.push((shown(), value, face, line));
        }
        Ok(())
    }

    /// Later faces belong to the group or object of this name, whichever was named last.
    fn take_group(&mut self, statement: &Statement) -> Result<(), ReadFault> {
        let text = std::str::from_utf8(&statement.text).map_err(|_| ReadFault::NotUtf8)?;
        let words: Vec<&str> = text.split_whitespace().skip(1).collect();
        self.current_name = words.join(" ");
        self.current_group = None;
        Ok(())
    }

    /// The group of the next face. Groups without faces get no number.
    fn group(&mut self) -> u32 {
        if let Some(group) = self.current_group {
            return group;
        }
        let next = self.group_names.len() as u32;
        let group = *self.group_of_name.entry(self.current_name.clone()).or_insert(next);
        if group == next {
            self.group_names.push(self.current_name.clone());
        }
        self.current_group = Some(group);
        group
    }

    fn leave_out(&mut self, statement: &Statement, keyword: &[u8]) -> Result<(), ReadFault> {
        let known = IGNORED.iter().find(|(_, words)| words.iter().any(|w| w.as_bytes() == keyword));
        if let Some((what, _)) = known {
            self.dropped.note(what, statement.line);
            return Ok(());
        }
        Err(ReadFault::Syntax {
            reason: "a line that is no OBJ statement",
            text: excerpt(&statement.text),
            advice: "lines begin with `v`, `f` or another keyword of the format: correct or \
                     remove this one",
        })
    }
}

impl Read for Feed<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.fill_buf()?.read(buffer)?;
        self.consume(n);
        Ok(n)
    }
}

impl BufRead for Feed<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.at == self.out.len() {
            self.advance()?;
        }
        Ok(&self.out[self.at..])
    }

    fn consume(&mut self, amount: usize) {
        self.at += amount;
    }
}

/// The vertex of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`: an integer, not checked for range.
fn vertex_index(word: &[u8]) -> Result<&[u8], ReadFault> {
    let mut parts = word.split(|&b| b == b'/');
    let index = parts.next().unwrap_or_default();
    let digits = index.strip_prefix(b"-").or(index.strip_prefix(b"+")).unwrap_or(index);
    let whole = !digits.is_empty() && digits.iter().all(u8::is_ascii_digit);
    let extra_is_whole = parts.clone().all(|p| p.iter().all(|b| b"+-0123456789".contains(b)));
    if whole && extra_is_whole && parts.count() <= 2 {
        return Ok(index);
    }
    Err(ReadFault::Syntax {
        reason: "a face corner that is no whole number",
        text: excerpt(word),
        advice: "corners are written as `7`, `7/8`, `7//9` or `7/8/9`: correct the line",
    })
}

fn out_of_range(face: usize, index: String, vertices: usize) -> ReadFault {
    ReadFault::IndexOutOfRange { face, index, first: 1, vertices }
}
