//! The lines of an IGES file: sections by the letter in column 73, and the global section.

use super::super::domain_file::{DomainReadError, Problem, excerpt};
use super::Read;
use super::fields::{split, trimmed};
use crate::domain::Place;

/// Columns of a line that hold data.
const DATA: usize = 72;
/// Sections in their order.
const LETTERS: &[u8; 5] = b"SGDPT";

/// A line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Card<'a> {
    /// Its number in the file, from 1.
    pub(super) line: u64,
    /// Columns 1 to 72.
    pub(super) data: &'a [u8],
}

/// The lines by section.
#[derive(Debug, Default)]
pub(super) struct Sections<'a> {
    cards: [Vec<Card<'a>>; 5],
}

impl<'a> Sections<'a> {
    /// Sorts the lines of a file; their sequence numbers and the counts of the last line must fit.
    pub(super) fn of(bytes: &'a [u8]) -> Read<Self> {
        let mut sections = Self::default();
        let mut last = 0;
        for (line, text) in (1..).zip(bytes.split(|&byte| byte == b'\n')) {
            let text = text.strip_suffix(b"\r").unwrap_or(text);
            if text.trim_ascii().is_empty() {
                continue;
            }
            let (section, sequence) = letter(text, line)?;
            if section < last {
                return Err(expected("sections in the order S, G, D, P, T", &text[DATA..], line));
            }
            last = section;
            let cards = &mut sections.cards[section];
            if sequence != Some(cards.len() as u64 + 1) {
                let what = "the sequence number of the line in its section";
                return Err(expected(what, &text[DATA + 1..], line));
            }
            cards.push(Card { line, data: &text[..DATA] });
        }
        sections.demand_end()?;
        Ok(sections)
    }

    /// The last line counts those of the other sections: `S      1G      4D     54P     27`.
    fn demand_end(&self) -> Read<()> {
        let [.., end] = &self.cards;
        let Some(card) = end.first() else {
            let (what, found) = ("a last line of section T", "the end of the file".to_owned());
            return Err(Problem::Expected { what, found }.at(Place::Made));
        };
        for (i, &letter) in LETTERS[..4].iter().enumerate() {
            let field = &card.data[8 * i..8 * i + 8];
            let stated = (field[0] == letter).then(|| whole(&field[1..])).flatten();
            let found = self.cards[i].len();
            if stated != Some(found as u64) {
                let what = "the number of lines of each section, as the file has them";
                return Err(expected(what, field, card.line));
            }
        }
        Ok(())
    }

    pub(super) fn global(&self) -> &[Card<'a>] {
        &self.cards[1]
    }

    pub(super) fn directory(&self) -> &[Card<'a>] {
        &self.cards[2]
    }

    pub(super) fn parameters(&self) -> &[Card<'a>] {
        &self.cards[3]
    }
}

/// Index of a line's section, and its sequence number.
fn letter(text: &[u8], line: u64) -> Read<(usize, Option<u64>)> {
    let what = "a line of 80 columns with one of S, G, D, P, T in column 73";
    let found = text.get(DATA).ok_or_else(|| expected(what, text, line))?;
    match LETTERS.iter().position(|letter| letter == found) {
        Some(section) => Ok((section, whole(text.get(DATA + 1..80).unwrap_or_default()))),
        None if matches!(found, b'C' | b'B') && line == 1 => {
            let message =
                "compressed and binary IGES files are not read: export fixed-length ASCII";
            Err(Problem::Entity(message.to_owned()).at(Place::Line(line)))
        }
        None => Err(expected(what, text, line)),
    }
}

/// A number without a sign.
fn whole(text: &[u8]) -> Option<u64> {
    std::str::from_utf8(text.trim_ascii()).ok()?.parse().ok()
}

pub(super) fn expected(what: &'static str, found: &[u8], line: u64) -> DomainReadError {
    let found = format!("'{}'", excerpt(&String::from_utf8_lossy(found.trim_ascii())));
    Problem::Expected { what, found }.at(Place::Line(line))
}

/// What the global section says.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Global {
    /// Separates parameters.
    pub(super) delimiter: u8,
    /// Ends a record.
    pub(super) end: u8,
    /// Model space over real lengths; 1 where the file says nothing.
    pub(super) scale: f64,
    /// The unit of lengths in words.
    pub(super) unit: String,
    /// The smallest distance that tells two points apart.
    pub(super) resolution: Option<f64>,
}

/// Names of the unit flags 1 to 11; 3 stands for the name in the file.
const UNITS: [&str; 11] = [
    "inches",
    "millimetres",
    "",
    "feet",
    "miles",
    "metres",
    "kilometres",
    "mils",
    "micrometres",
    "centimetres",
    "microinches",
];

impl Global {
    pub(super) fn of(cards: &[Card]) -> Read<Self> {
        let Some(first) = cards.first() else {
            let (what, found) = ("a global section", "none".to_owned());
            return Err(Problem::Expected { what, found }.at(Place::Made));
        };
        let text: Vec<u8> = cards.iter().flat_map(|card| card.data).copied().collect();
        let wrong = |what| expected(what, &text, first.line);
        let (delimiter, at) = delimiter(&text, 0, b',', b',')
            .ok_or_else(|| wrong("the delimiter of parameters, such as `1H,,`"))?;
        let (end, at) = self::delimiter(&text, at, delimiter, b';')
            .filter(|(end, _)| *end != delimiter)
            .ok_or_else(|| wrong("the delimiter of records, such as `1H;,`"))?;
        let ranges = split(&text[at..], delimiter, end).map_err(wrong)?;
        // The delimiters were parameters 1 and 2.
        let field = |number: usize| {
            ranges.get(number - 3).map_or(&b""[..], |range| trimmed(&text[at..], range))
        };
        let real = |number| super::fields::real(field(number));
        Ok(Self {
            delimiter,
            end,
            scale: real(13).filter(|scale| *scale > 0.0).unwrap_or(1.0),
            unit: unit(field(14), field(15)),
            resolution: real(19).filter(|resolution| *resolution > 0.0),
        })
    }
}

/// A delimiter at `at`, given as `1H` and its character or left out, and where the next field starts.
fn delimiter(text: &[u8], at: usize, separator: u8, default: u8) -> Option<(u8, usize)> {
    if *text.get(at)? == separator {
        return Some((default, at + 1));
    }
    let &[b'1', b'H', found, next] = text.get(at..at + 4)? else { return None };
    let may =
        !found.is_ascii_alphanumeric() && found.is_ascii_graphic() && !b"+-.".contains(&found);
    let is_first = at == 0;
    let after = if is_first { found } else { separator };
    (may && (next == after || (!is_first && next == found))).then_some((found, at + 4))
}

fn unit(flag: &[u8], name: &[u8]) -> String {
    let flag = whole(flag).unwrap_or(1);
    match UNITS.get((flag as usize).wrapping_sub(1)) {
        Some(&known) if !known.is_empty() => known.to_owned(),
        _ => {
            let from = name.iter().position(|&byte| byte == b'H').map_or(0, |at| at + 1);
            excerpt(&String::from_utf8_lossy(&name[from..]))
        }
    }
}
