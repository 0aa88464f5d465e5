//! An OBJ file as a sequence of statements: continuations joined, comments and blanks taken off.

use crate::io::ReadFault;
use crate::io::text::{Lines, is_blank, trim, words};

/// One statement and where it stands.
#[derive(Debug, Clone, Default)]
pub(super) struct Statement {
    /// Line on which it begins, from 1.
    pub(super) line: usize,
    /// Its words, the keyword first, and what is between them. Empty after the last statement.
    pub(super) text: Vec<u8>,
    /// Whether the file ends before the line does.
    pub(super) unterminated: bool,
    /// Whether the file ends where a continuation was announced.
    pub(super) unfinished: bool,
}

impl Statement {
    /// The words of the statement.
    pub(super) fn words(&self) -> impl Iterator<Item = &[u8]> {
        words(&self.text)
    }

    /// The first word.
    pub(super) fn keyword(&self) -> &[u8] {
        self.words().next().unwrap_or_default()
    }
}

/// Statements of a file, in order. Linear in its size.
pub(super) struct Statements<'a> {
    lines: Lines<'a>,
}

impl<'a> Statements<'a> {
    pub(super) fn new(lines: Lines<'a>) -> Self {
        Self { lines }
    }

    /// The line that is being read.
    pub(super) fn line(&self) -> usize {
        self.lines.number()
    }

    /// Reads the next statement into `statement`; false if there is none.
    pub(super) fn advance(&mut self, statement: &mut Statement) -> Result<bool, ReadFault> {
        loop {
            statement.text.clear();
            if !self.lines.advance()? {
                return Ok(false);
            }
            statement.line = self.lines.number();
            self.join(statement)?;
            if statement.unfinished || !trim(&statement.text).is_empty() {
                return Ok(true);
            }
        }
    }

    /// Takes the line, and those that it announces with a backslash. A path at the end of a comment
    /// is no announcement: the comment has been taken off before.
    fn join(&mut self, statement: &mut Statement) -> Result<(), ReadFault> {
        loop {
            statement.text.extend_from_slice(without_comment(self.lines.text()));
            statement.unterminated = !self.lines.is_terminated();
            statement.unfinished = statement.text.last() == Some(&b'\\');
            if !statement.unfinished {
                return Ok(());
            }
            if let Some(mark) = statement.text.last_mut() {
                *mark = b' ';
            }
            if !self.lines.advance()? {
                statement.unterminated = true;
                return Ok(());
            }
        }
    }
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

    fn statements(mut bytes: &[u8]) -> Vec<Statement> {
        let mut statements = Statements::new(Lines::new(&mut bytes).unwrap());
        let (mut all, mut next) = (Vec::new(), Statement::default());
        while statements.advance(&mut next).unwrap() {
            all.push(next.clone());
        }
        all
    }

    #[test]
    fn lines_are_joined_stripped_and_counted() {
        let file = b"\xef\xbb\xbf# c:\\\r\n\r\nv 1 2 \\\r\n 3 # end\rf 1#x\ng a#1 #b\n";
        let text = |s: &Statement| String::from_utf8_lossy(trim(&s.text)).into_owned();
        let texts: Vec<_> = statements(file).iter().map(|s| (s.line, text(s))).collect();
        let want = [(3, "v 1 2   3"), (5, "f 1"), (6, "g a#1")];
        assert_eq!(texts, want.map(|(l, t)| (l, t.to_owned())));
    }

    #[test]
    fn a_cut_end_is_known() {
        let last = |bytes: &'static [u8]| statements(bytes).pop().unwrap();
        assert!(!last(b"v 1 2 3\n").unterminated);
        assert!(last(b"v 1 2").unterminated);
        assert!(last(b"f 1 2 \\").unfinished);
        assert!(last(b"f 1 2 \\\n").unfinished);
        assert!(!last(b"f 1 2 \\\n3\n").unfinished);
    }
}
