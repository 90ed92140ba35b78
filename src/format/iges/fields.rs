//! Parameters of an IGES record: text between delimiters, strings as `5Hhello`.

use super::super::domain_file::{DomainReadError, Problem, excerpt};
use super::Read;
use super::card::{Card, Global};
use crate::domain::Place;
use crate::vector::Vector;
use std::ops::Range;

/// Columns of a parameter line that hold data.
const DATA: usize = 64;

/// Where the fields of a record stand.
///
/// # Errors
/// What is missing.
pub(super) fn split(
    text: &[u8],
    delimiter: u8,
    end: u8,
) -> Result<Vec<Range<usize>>, &'static str> {
    let mut ranges = Vec::new();
    let mut at = 0;
    loop {
        let start = at;
        at = after_string(text, at).ok_or("a string within its record")?;
        let rest = &text[at..];
        let length = rest.iter().position(|&byte| byte == delimiter || byte == end);
        let stop = at + length.ok_or("the delimiter that ends a record")?;
        ranges.push(start..stop);
        if text[stop] == end {
            return Ok(ranges);
        }
        at = stop + 1;
    }
}

/// Behind a string that stands at `at`; `at` itself where there is none.
fn after_string(text: &[u8], at: usize) -> Option<usize> {
    let blanks = text[at..].iter().take_while(|byte| **byte == b' ').count();
    let start = at + blanks;
    let digits = text[start..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    if digits == 0 || text.get(start + digits) != Some(&b'H') {
        return Some(at);
    }
    let length: usize = std::str::from_utf8(&text[start..start + digits]).ok()?.parse().ok()?;
    (start + digits + 1).checked_add(length).filter(|&end| end <= text.len())
}

pub(super) fn trimmed<'a>(text: &'a [u8], range: &Range<usize>) -> &'a [u8] {
    text[range.clone()].trim_ascii()
}

/// A finite number, which may have Fortran's exponent `D`.
pub(super) fn real(text: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(text).ok()?;
    if !text.bytes().all(|b| b.is_ascii_digit() || b"+-.eEdD".contains(&b)) {
        return None;
    }
    text.replace(['d', 'D'], "e").parse().ok().filter(|value: &f64| value.is_finite())
}

/// The parameters of an entity, read one after the other.
pub(super) struct Fields<'a> {
    cards: &'a [Card<'a>],
    text: Vec<u8>,
    ranges: Vec<Range<usize>>,
    at: usize,
}

impl<'a> Fields<'a> {
    pub(super) fn of(cards: &'a [Card<'a>], global: &Global) -> Read<Self> {
        let text: Vec<u8> = cards.iter().flat_map(|card| &card.data[..DATA]).copied().collect();
        let ranges = split(&text, global.delimiter, global.end);
        let ranges = ranges.map_err(|what| {
            let found = format!("'{}'", excerpt(&String::from_utf8_lossy(&text)));
            let line = cards.first().map_or(Place::Made, |card| Place::Line(card.line));
            Problem::Expected { what, found }.at(line)
        })?;
        Ok(Self { cards, text, ranges, at: 0 })
    }

    /// Bytes of the record.
    pub(super) fn size(&self) -> usize {
        self.text.len()
    }

    /// Fields that are left.
    pub(super) fn left(&self) -> usize {
        self.ranges.len().saturating_sub(self.at)
    }

    /// The line that it starts on; 0 without one.
    pub(super) fn line(&self) -> u64 {
        self.cards.first().map_or(0, |card| card.line)
    }

    /// The line that field `index` starts on.
    fn place(&self, index: usize) -> Place {
        let offset = self.ranges.get(index).or(self.ranges.last()).map_or(0, |range| range.start);
        let card = self.cards.get(offset / DATA).or(self.cards.last());
        card.map_or(Place::Made, |card| Place::Line(card.line))
    }

    /// An error at the field read last.
    pub(super) fn fail(&self, problem: Problem) -> DomainReadError {
        problem.at(self.place(self.at.saturating_sub(1)))
    }

    /// The next field; empty where it is left to its default.
    fn next(&mut self, what: &'static str) -> Read<&[u8]> {
        let index = self.at;
        self.at += 1;
        match self.ranges.get(index) {
            Some(range) => Ok(trimmed(&self.text, range)),
            None => {
                let found = "the end of the entity".to_owned();
                Err(self.fail(Problem::Expected { what, found }))
            }
        }
    }

    fn unexpected(&self, what: &'static str) -> DomainReadError {
        let text = self.ranges.get(self.at - 1).map_or(&b""[..], |r| trimmed(&self.text, r));
        let found = format!("'{}'", excerpt(&String::from_utf8_lossy(text)));
        self.fail(Problem::Expected { what, found })
    }

    /// An integer; 0 where it is left out.
    pub(super) fn int(&mut self, what: &'static str) -> Read<i64> {
        let text = self.next(what)?;
        if text.is_empty() {
            return Ok(0);
        }
        let value = std::str::from_utf8(text).ok().and_then(|text| text.parse().ok());
        value.ok_or_else(|| self.unexpected(what))
    }

    /// A finite number; 0 where it is left out.
    pub(super) fn real(&mut self, what: &'static str) -> Read<f64> {
        let text = self.next(what)?;
        if text.is_empty() {
            return Ok(0.0);
        }
        let value = real(text);
        value.ok_or_else(|| self.unexpected(what))
    }

    pub(super) fn reals(&mut self, what: &'static str, count: usize) -> Read<Vec<f64>> {
        // The count was compared with the fields that are left.
        (0..count).map(|_| self.real(what)).collect()
    }

    pub(super) fn vector(&mut self, what: &'static str) -> Read<Vector> {
        Ok([self.real(what)?, self.real(what)?, self.real(what)?])
    }

    /// A number of items with `each` fields that must follow, from `least` on.
    pub(super) fn count(&mut self, what: &'static str, least: usize, each: usize) -> Read<usize> {
        let stated = self.int(what)?;
        let most = (self.ranges.len().saturating_sub(self.at)) / each.max(1);
        match usize::try_from(stated) {
            Ok(count) if count >= least && count <= most => Ok(count),
            _ => {
                let (low, high) = (least as i64, most as i64);
                let found = stated.to_string();
                Err(self.fail(Problem::OutOfRange { what, found, low, high }))
            }
        }
    }

    /// The product of two counts, if as many items with `each` fields can follow.
    pub(super) fn product(
        &self,
        counts: [usize; 2],
        what: &'static str,
        each: usize,
    ) -> Read<usize> {
        let most = (self.ranges.len().saturating_sub(self.at)) / each.max(1);
        match counts[0].checked_mul(counts[1]) {
            Some(product) if product <= most => Ok(product),
            _ => {
                let found = format!("{} times {}", counts[0], counts[1]);
                Err(self.fail(Problem::OutOfRange { what, found, low: 1, high: most as i64 }))
            }
        }
    }
}
