//! The statements of a STEP file: where each record begins, before any is parsed.

use super::super::domain_file::Problem;
use super::Read;
use crate::domain::Place;
use std::collections::BTreeMap;

/// A record: its line, and its text without the semicolon.
#[derive(Clone, Copy)]
pub(super) struct Statement<'a> {
    pub(super) line: u64,
    pub(super) text: &'a str,
}

/// Parentheses deeper than this are nobody's, and would be deep calls of the parser.
const DEEPEST: usize = 24;

fn fail<T>(text: impl Into<String>, line: u64) -> Read<T> {
    Err(Problem::Step(text.into()).at(Place::Line(line)))
}

/// The records of the data sections by their numbers.
pub(super) fn scan(text: &str) -> Read<BTreeMap<u64, Statement<'_>>> {
    let mut records = BTreeMap::new();
    let mut in_data = false;
    let mut rest = Rest { text, at: 0, line: 1 };
    let Some(first) = rest.statement()? else {
        return fail("a STEP file begins with ISO-10303-21;, but this is empty", 1);
    };
    if first.text != "ISO-10303-21" {
        return fail("a STEP file begins with ISO-10303-21;", first.line);
    }
    while let Some(statement) = rest.statement()? {
        match statement.text {
            "END-ISO-10303-21" => return Ok(records),
            "ENDSEC" => in_data = false,
            text if text == "DATA" || text.starts_with("DATA(") => in_data = true,
            text if in_data => {
                let Some(id) = number(text) else {
                    return fail("a record begins with # and a number, and =", statement.line);
                };
                if records.insert(id, statement).is_some() {
                    return fail(format!("record #{id} is there twice"), statement.line);
                }
            }
            _ => {}
        }
    }
    fail("the file ends before END-ISO-10303-21;", rest.line)
}

fn number(text: &str) -> Option<u64> {
    text.strip_prefix('#')?.split_once('=')?.0.trim().parse().ok()
}

struct Rest<'a> {
    text: &'a str,
    at: usize,
    line: u64,
}

impl<'a> Rest<'a> {
    /// The next statement, `None` at the end of the text.
    fn statement(&mut self) -> Read<Option<Statement<'a>>> {
        self.skip_blanks();
        let (start, line) = (self.at, self.line);
        let bytes = self.text.as_bytes();
        let (mut depth, mut quoted) = (0_usize, false);
        while let Some(&byte) = bytes.get(self.at) {
            match byte {
                b'\n' => self.line += 1,
                b'\'' => quoted = !quoted,
                _ if quoted => {}
                b'/' if bytes.get(self.at + 1) == Some(&b'*') => {
                    self.skip_comment();
                    continue;
                }
                b'(' => depth += 1,
                b')' => depth = depth.saturating_sub(1),
                b';' => {
                    let text = self.text[start..self.at].trim_end();
                    self.at += 1;
                    return Ok(Some(Statement { line, text }));
                }
                _ => {}
            }
            if depth > DEEPEST {
                return fail(format!("parentheses are more than {DEEPEST} deep"), self.line);
            }
            self.at += 1;
        }
        match start == bytes.len() {
            true => Ok(None),
            false => fail("the file ends within a record", line),
        }
    }

    fn skip_blanks(&mut self) {
        let bytes = self.text.as_bytes();
        while let Some(&byte) = bytes.get(self.at) {
            match byte {
                b'\n' => self.line += 1,
                b'/' if bytes.get(self.at + 1) == Some(&b'*') => {
                    self.skip_comment();
                    continue;
                }
                _ if !byte.is_ascii_whitespace() => return,
                _ => {}
            }
            self.at += 1;
        }
    }

    /// Goes behind a comment, or to the end where it has none.
    fn skip_comment(&mut self) {
        let rest = &self.text[self.at + 2..];
        let length = rest.find("*/").map_or(rest.len(), |i| i + 2);
        self.line += rest.as_bytes()[..length].iter().filter(|&&b| b == b'\n').count() as u64;
        self.at += 2 + length;
    }
}
