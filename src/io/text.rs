//! Text as lines, words and numbers: what all text formats share.
//!
//! Lines may end in LF, CRLF or CR, and a mark of the byte order at the start is passed over. Only
//! one line is held at a time.

use std::io::{self, BufRead, Write};

use rayon::prelude::*;

use super::ReadFault;

/// The lines of a file, one at a time.
pub(super) struct Lines<'a> {
    source: &'a mut dyn BufRead,
    text: Vec<u8>,
    number: usize,
    terminated: bool,
    /// Bytes before the current line.
    offset: u64,
}

impl<'a> Lines<'a> {
    /// No line is read yet. Other encodings than UTF-8 are refused as far as they show.
    pub(super) fn new(source: &'a mut dyn BufRead) -> Result<Self, ReadFault> {
        let start = source.fill_buf()?;
        if start.starts_with(b"\xff\xfe") || start.starts_with(b"\xfe\xff") {
            return Err(ReadFault::NotUtf8);
        }
        let mark = if start.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        source.consume(mark);
        Ok(Self { source, text: Vec::new(), number: 0, terminated: true, offset: mark as u64 })
    }

    /// Reads the next line; false if there is none.
    pub(super) fn advance(&mut self) -> Result<bool, ReadFault> {
        self.text.clear();
        let mut any = false;
        loop {
            let chunk = self.source.fill_buf()?;
            let stop = chunk.iter().position(|b| matches!(b, b'\n' | b'\r' | 0));
            let taken = stop.unwrap_or(chunk.len());
            let byte = stop.map(|at| chunk[at]);
            if byte == Some(0) {
                return Err(ReadFault::Binary { offset: self.offset + taken as u64 });
            }
            if !any && !chunk.is_empty() {
                any = true;
                self.number += 1;
            }
            let ended = chunk.is_empty() || stop.is_some();
            self.text.extend_from_slice(&chunk[..taken]);
            self.consume(taken + usize::from(stop.is_some()));
            if ended {
                if byte == Some(b'\r') && self.source.fill_buf()?.first() == Some(&b'\n') {
                    self.consume(1);
                }
                self.terminated = stop.is_some();
                break;
            }
        }
        Ok(any)
    }

    /// Reads on to a line with a word in it; false if there is none.
    pub(super) fn advance_to_words(&mut self) -> Result<bool, ReadFault> {
        while self.advance()? {
            if self.words().next().is_some() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn consume(&mut self, bytes: usize) {
        self.source.consume(bytes);
        self.offset += bytes as u64;
    }

    /// The line without its end.
    pub(super) fn text(&self) -> &[u8] {
        &self.text
    }

    /// Its words.
    pub(super) fn words(&self) -> impl Iterator<Item = &[u8]> {
        words(&self.text)
    }

    /// Its number, from 1.
    pub(super) fn number(&self) -> usize {
        self.number.max(1)
    }

    /// Whether it has an end, and is not where the file stops.
    pub(super) fn is_terminated(&self) -> bool {
        self.terminated
    }

    /// What follows the line.
    pub(super) fn source(&mut self) -> &mut dyn BufRead {
        self.source
    }
}

/// Refuses a file in which anything but white space is left.
pub(super) fn check_end(source: &mut dyn BufRead) -> Result<(), ReadFault> {
    loop {
        let chunk = source.fill_buf()?;
        if chunk.is_empty() {
            return Ok(());
        }
        if !chunk.iter().all(|&b| is_blank(b)) {
            return Err(ReadFault::Trailing);
        }
        let length = chunk.len();
        source.consume(length);
    }
}

/// White space between words, as `char::is_whitespace` has it among the ASCII characters.
pub(super) fn is_blank(b: u8) -> bool {
    matches!(b, b' ' | 9..=13)
}

/// The words of a text.
pub(super) fn words(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split(|&b| is_blank(b)).filter(|w| !w.is_empty())
}

/// A text without white space at its ends.
pub(super) fn trim(text: &[u8]) -> &[u8] {
    let start = text.iter().position(|&b| !is_blank(b)).unwrap_or(text.len());
    let end = text.iter().rposition(|&b| !is_blank(b)).map_or(start, |e| e + 1);
    &text[start..end]
}

/// The number that a word says; also NaN and infinities.
pub(super) fn number(word: &[u8]) -> Result<f64, ReadFault> {
    let parsed = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
    parsed.ok_or_else(|| {
        let (reason, advice) = if word.contains(&b',') {
            (
                "a number with a comma",
                "decimals are written with a point, as in `1.5`: convert the file",
            )
        } else {
            ("a word that is no number", "correct the line")
        };
        ReadFault::Syntax { reason, text: excerpt(word), advice }
    })
}

/// The first three words as coordinates; `None` if there are fewer.
pub(super) fn coordinates<'w>(
    words: &mut impl Iterator<Item = &'w [u8]>,
) -> Result<Option<[f64; 3]>, ReadFault> {
    let mut point = [0.0; 3];
    for x in &mut point {
        let Some(word) = words.next() else { return Ok(None) };
        *x = number(word)?;
    }
    Ok(Some(point))
}

/// The fault of a line that is not complete: cut where the file ends with it.
pub(super) fn short_line(text: &[u8], terminated: bool, reason: &'static str) -> ReadFault {
    let text = excerpt(text);
    if terminated {
        return ReadFault::Syntax { reason, text, advice: "complete or remove the line" };
    }
    ReadFault::Cut { text }
}

/// The start of a piece of the file, fit to be shown.
pub(super) fn excerpt(text: &[u8]) -> String {
    const LONGEST: usize = 40;
    // Words may be as long as the file; four bytes is the longest character.
    let enough = &text[..text.len().min(16 * LONGEST)];
    let shown =
        String::from_utf8_lossy(&words(enough).collect::<Vec<_>>().join(&b' ')).into_owned();
    let mut short: String =
        shown.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).take(LONGEST).collect();
    if shown.chars().nth(LONGEST).is_some() {
        short.push('…');
    }
    short
}

/// Writes `count` rows, each as `row` writes it. In parallel, in blocks: there are never many rows
/// in memory.
pub(super) fn write_rows(
    out: &mut dyn Write,
    count: usize,
    row: impl Fn(usize, &mut dyn Write) -> io::Result<()> + Sync,
) -> io::Result<()> {
    const CHUNK: usize = 1 << 11;
    const BLOCK: usize = 1 << 16;
    for block in (0..count).step_by(BLOCK) {
        let rows = |start: usize| {
            let mut text = Vec::new();
            let end = count.min(start + CHUNK);
            (start..end).try_for_each(|i| row(i, &mut text)).map(|()| text)
        };
        let starts: Vec<usize> = (block..count.min(block + BLOCK)).step_by(CHUNK).collect();
        let texts: Vec<io::Result<Vec<u8>>> = starts.into_par_iter().map(rows).collect();
        texts.into_iter().try_for_each(|text| out.write_all(&text?))?;
    }
    Ok(())
}

/// Writes a space and the shortest decimal that reads back as `x`.
pub(super) fn write_number(out: &mut dyn Write, x: f64) -> io::Result<()> {
    if x == 0.0 || (1e-5..1e16).contains(&x.abs()) {
        write!(out, " {x}")
    } else {
        write!(out, " {x:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(mut bytes: &[u8]) -> Vec<(usize, String, bool)> {
        let mut lines = Lines::new(&mut bytes).unwrap();
        let mut all = Vec::new();
        while lines.advance().unwrap() {
            let text = String::from_utf8_lossy(lines.text()).into_owned();
            all.push((lines.number(), text, lines.is_terminated()));
        }
        all
    }

    #[test]
    fn every_system_ends_its_lines() {
        let want = [(1, "a", true), (2, "", true), (3, "b c", false)];
        let want = want.map(|(n, text, end)| (n, text.to_owned(), end));
        for text in ["a\n\nb c", "a\r\n\r\nb c", "a\r\rb c", "\u{feff}a\n\rb c"] {
            assert_eq!(lines(text.as_bytes()), want, "{text:?}");
        }
        assert_eq!(lines(b"a\n").len(), 1);
        assert_eq!(lines(b""), []);
    }

    #[test]
    fn lines_that_come_in_pieces_are_whole() {
        let mut pieces = io::BufReader::with_capacity(2, &b"one\r\ntwo\rthree\n"[..]);
        let mut lines = Lines::new(&mut pieces).unwrap();
        let mut all = Vec::new();
        while lines.advance().unwrap() {
            all.push(String::from_utf8_lossy(lines.text()).into_owned());
        }
        assert_eq!(all, ["one", "two", "three"]);
    }

    #[test]
    fn zeros_are_told_where_they_are() {
        let mut bytes = &b"ab\nc\0"[..];
        let mut lines = Lines::new(&mut bytes).unwrap();
        assert!(lines.advance().unwrap());
        assert!(matches!(lines.advance(), Err(ReadFault::Binary { offset: 4 })));
    }
}
