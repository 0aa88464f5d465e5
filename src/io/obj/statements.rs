//! An OBJ file as a sequence of statements: continuations joined, comments and blanks taken off.

use std::borrow::Cow;

/// One statement and where it stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Statement<'a> {
    /// Line on which it begins, from 1.
    pub(super) line: usize,
    /// Its words, the keyword first. Never empty.
    pub(super) text: Cow<'a, [u8]>,
    /// Whether the file ends before the line does.
    pub(super) unterminated: bool,
    /// Whether the file ends where a continuation was announced.
    pub(super) unfinished: bool,
}

impl Statement<'_> {
    /// The words of the statement.
    pub(super) fn words(&self) -> impl Iterator<Item = &[u8]> {
        self.text.split(|&b| is_blank(b)).filter(|w| !w.is_empty())
    }

    /// The first word.
    pub(super) fn keyword(&self) -> &[u8] {
        self.text.split(|&b| is_blank(b)).next().unwrap_or_default()
    }
}

/// Statements of a file, in order. Linear in its size.
///
/// Lines may end in LF, CRLF or CR; a mark of the byte order at the start is passed over.
#[derive(Debug, Clone)]
pub(super) struct Statements<'a> {
    rest: &'a [u8],
    line: usize,
}

impl<'a> Statements<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), line: 1 }
    }

    /// The next line without its end, and whether it has one.
    fn next_line(&mut self) -> Option<(&'a [u8], bool)> {
        if self.rest.is_empty() {
            return None;
        }
        let end = self.rest.iter().position(|&b| b == b'\n' || b == b'\r');
        let end_length = end.map_or(0, |e| if self.rest[e..].starts_with(b"\r\n") { 2 } else { 1 });
        let (line, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.rest = &rest[end_length..];
        self.line += 1;
        Some((line, end.is_some()))
    }

    /// Appends the lines that `first` announces with a backslash. A path at the end of a comment
    /// is no announcement: the comment has been taken off before.
    fn join(&mut self, first: &'a [u8]) -> (Vec<u8>, bool, bool) {
        let (mut text, mut line) = (Vec::new(), first);
        while let Some(part) = line.strip_suffix(b"\\") {
            text.extend_from_slice(part);
            text.push(b' ');
            let Some((next, terminated)) = self.next_line() else { return (text, true, true) };
            line = without_comment(next);
            if !terminated {
                text.extend_from_slice(line.strip_suffix(b"\\").unwrap_or(line));
                return (text, true, line.ends_with(b"\\"));
            }
        }
        text.extend_from_slice(line);
        (text, false, false)
    }
}

impl<'a> Iterator for Statements<'a> {
    type Item = Statement<'a>;

    fn next(&mut self) -> Option<Statement<'a>> {
        loop {
            let line = self.line;
            let (first, terminated) = self.next_line()?;
            let first = without_comment(first);
            if first.ends_with(b"\\") {
                let (text, unterminated, unfinished) = self.join(first);
                let text = trim(&text).to_vec();
                if !text.is_empty() || unfinished {
                    return Some(Statement { line, text: text.into(), unterminated, unfinished });
                }
            } else if !trim(first).is_empty() {
                let text = Cow::Borrowed(trim(first));
                return Some(Statement {
                    line,
                    text,
                    unterminated: !terminated,
                    unfinished: false,
                });
            }
        }
    }
}

/// White space between words, as `char::is_whitespace` has it among the ASCII characters.
pub(super) fn is_blank(b: u8) -> bool {
    matches!(b, b' ' | 9..=13)
}

fn trim(text: &[u8]) -> &[u8] {
    let start = text.iter().position(|&b| !is_blank(b)).unwrap_or(text.len());
    let end = text.iter().rposition(|&b| !is_blank(b)).map_or(start, |e| e + 1);
    &text[start..end]
}

/// The line up to `#`. In names (`g part#2`) the sign only counts at the start of a word.
fn without_comment(line: &[u8]) -> &[u8] {
    let Some(mut at) = line.iter().position(|&b| b == b'#') else { return line };
    if !matches!(trim(line).first(), Some(b'v' | b'f')) {
        let starts_word = |i: usize| line[i] == b'#' && (i == 0 || is_blank(line[i - 1]));
        at = (at..line.len()).find(|&i| starts_word(i)).unwrap_or(line.len());
    }
    &line[..at]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(bytes: &[u8]) -> Vec<(usize, String)> {
        Statements::new(bytes)
            .map(|s| (s.line, String::from_utf8_lossy(&s.text).into_owned()))
            .collect()
    }

    #[test]
    fn lines_are_joined_stripped_and_counted() {
        let file = b"\xef\xbb\xbf# c:\\\r\n\r\nv 1 2 \\\r\n 3 # end\rf 1#x\ng a#1 #b\n";
        let want = [(3, "v 1 2   3"), (5, "f 1"), (6, "g a#1")];
        assert_eq!(texts(file), want.map(|(l, t)| (l, t.to_owned())));
    }

    #[test]
    fn a_cut_end_is_known() {
        let last = |bytes: &'static [u8]| Statements::new(bytes).last().unwrap();
        assert!(!last(b"v 1 2 3\n").unterminated);
        assert!(last(b"v 1 2").unterminated);
        assert!(last(b"f 1 2 \\").unfinished);
        assert!(last(b"f 1 2 \\\n").unfinished);
        assert!(!last(b"f 1 2 \\\n3\n").unfinished);
    }
}
