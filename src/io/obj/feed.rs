//! What `tobj` is given to read: one canonical line at a time, checked, and with its number.
//!
//! `tobj` starts a new model with its own vertices at every `o`, `g` and change of material,
//! takes `l 1 2 3` for a triangle, numbers vertices by first use, stumbles over continuations and
//! trailing comments, and says neither the line of an error nor that an index is out of range
//! before the end. So it gets `v` and `f` lines only, with three coordinates and bare indices,
//! and before them an *anchor*: a face that uses every vertex in order. There is then one model,
//! its vertices are in file order, and the line that fails is the one handed out last.

use std::collections::HashMap;
use std::io::{self, BufRead, Read};

use super::statements::{Statement, Statements, is_blank};
use crate::io::ReadFault;

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
    /// The canonical line that is being read, with its end.
    out: Vec<u8>,
    /// How much of it has been read.
    at: usize,
    vertices: usize,
    vertices_so_far: usize,
    group_of_name: HashMap<String, u32>,
    current_name: String,
    /// Group of the faces that follow, once a face has used it.
    current_group: Option<u32>,
    /// The statement behind the line that is being read.
    pub(super) current: Option<Statement<'a>>,
    /// Group of each face.
    pub(super) groups: Vec<u32>,
    /// Names of the groups; the first is the empty one.
    pub(super) group_names: Vec<String>,
    /// What was left out, in words, each once, with its first line.
    pub(super) dropped: Vec<(&'static str, usize)>,
    /// What our own checks found, and where.
    pub(super) fault: Option<(usize, ReadFault)>,
}

impl<'a> Feed<'a> {
    /// A feed of `bytes`, which have `vertices` vertex statements.
    pub(super) fn new(bytes: &'a [u8], vertices: usize) -> Self {
        Self {
            statements: Statements::new(bytes),
            out: anchor(vertices),
            at: 0,
            vertices,
            vertices_so_far: 0,
            group_of_name: HashMap::from([(String::new(), 0)]),
            current_name: String::new(),
            current_group: Some(0),
            current: None,
            groups: Vec::new(),
            group_names: vec![String::new()],
            dropped: Vec::new(),
            fault: None,
        }
    }

    /// Makes the next canonical line; none is left if it stays empty.
    fn advance(&mut self) -> io::Result<()> {
        self.out.clear();
        self.at = 0;
        while self.out.is_empty() {
            let Some(statement) = self.statements.next() else { return Ok(()) };
            let taken = self.take(&statement);
            let line = statement.line;
            self.current = Some(statement);
            if let Err(fault) = taken {
                self.fault = Some((line, fault));
                return Err(io::Error::from(io::ErrorKind::InvalidData));
            }
        }
        Ok(())
    }

    fn take(&mut self, statement: &Statement<'a>) -> Result<(), ReadFault> {
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

    fn take_vertex(&mut self, statement: &Statement<'a>) -> Result<(), ReadFault> {
        let mut words = statement.words().skip(1);
        self.out.push(b'v');
        for _ in 0..3 {
            let Some(word) = words.next() else {
                return Err(short_line(statement, "a vertex with fewer than three coordinates"));
            };
            if !word.is_ascii() {
                return Err(bad_number(word));
            }
            self.out.push(b' ');
            self.out.extend_from_slice(word);
        }
        self.out.push(b'\n');
        if words.next().is_some() {
            self.note_dropped("vertex colours and weights", statement.line);
        }
        self.vertices_so_far += 1;
        Ok(())
    }

    fn take_face(&mut self, statement: &Statement<'a>) -> Result<(), ReadFault> {
        self.out.push(b'f');
        let mut corners = 0;
        for word in statement.words().skip(1) {
            let index = vertex_index(word)?;
            self.check_bounds(index)?;
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
        Ok(())
    }

    /// Whether the vertex exists. A positive index may name one that comes later in the file, a
    /// negative one counts back from here.
    fn check_bounds(&self, index: &[u8]) -> Result<(), ReadFault> {
        let text = std::str::from_utf8(index).unwrap_or_default();
        // The text is an integer; one that does not fit is out of range as well.
        let (within, vertices) = match text.parse::<i64>() {
            Ok(i) if i < 0 => {
                (i.unsigned_abs() <= self.vertices_so_far as u64, self.vertices_so_far)
            }
            Ok(i) => (i > 0 && i.unsigned_abs() <= self.vertices as u64, self.vertices),
            Err(_) => (false, self.vertices),
        };
        let fault = || ReadFault::IndexOutOfRange {
            face: self.groups.len() + 1,
            index: excerpt(index),
            vertices,
        };
        if within { Ok(()) } else { Err(fault()) }
    }

    /// Later faces belong to the group or object of this name, whichever was named last.
    fn take_group(&mut self, statement: &Statement<'a>) -> Result<(), ReadFault> {
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

    fn leave_out(&mut self, statement: &Statement<'a>, keyword: &[u8]) -> Result<(), ReadFault> {
        let known = IGNORED.iter().find(|(_, words)| words.iter().any(|w| w.as_bytes() == keyword));
        if let Some((what, _)) = known {
            self.note_dropped(what, statement.line);
            return Ok(());
        }
        Err(ReadFault::Syntax {
            reason: "a line that is no OBJ statement",
            text: excerpt(&statement.text),
            advice: "lines begin with `v`, `f` or another keyword of the format: correct or \
                     remove this one",
        })
    }

    fn note_dropped(&mut self, what: &'static str, line: usize) {
        if self.dropped.iter().all(|&(known, _)| known != what) {
            self.dropped.push((what, line));
        }
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

/// A face that uses every vertex in order, as a line; nothing without vertices.
fn anchor(vertices: usize) -> Vec<u8> {
    let mut line = Vec::with_capacity(8 * vertices);
    if vertices > 0 {
        line.push(b'f');
        for v in 1..=vertices {
            line.extend_from_slice(format!(" {v}").as_bytes());
        }
        line.push(b'\n');
    }
    line
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

fn short_line(statement: &Statement<'_>, reason: &'static str) -> ReadFault {
    let text = excerpt(&statement.text);
    if statement.unterminated {
        return ReadFault::Cut { text };
    }
    ReadFault::Syntax { reason, text, advice: "complete or remove the line" }
}

/// The fault of a coordinate that is no number.
pub(super) fn bad_number(word: &[u8]) -> ReadFault {
    let (reason, advice) = if word.contains(&b',') {
        (
            "a number with a comma",
            "decimals are written with a point, as in `1.5`: convert the file",
        )
    } else {
        ("a coordinate that is no number", "correct the line")
    };
    ReadFault::Syntax { reason, text: excerpt(word), advice }
}

/// The start of a piece of the file, fit to be shown.
pub(super) fn excerpt(text: &[u8]) -> String {
    const LONGEST: usize = 40;
    let words: Vec<&[u8]> = text.split(|&b| is_blank(b)).filter(|w| !w.is_empty()).collect();
    let shown = String::from_utf8_lossy(&words.join(&b' ')).into_owned();
    let mut short: String =
        shown.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).take(LONGEST).collect();
    if shown.chars().nth(LONGEST).is_some() {
        short.push('…');
    }
    short
}
