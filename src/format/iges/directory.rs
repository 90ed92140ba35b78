//! The directory of an IGES file: two lines an entity.

use super::super::domain_file::Problem;
use super::Read;
use super::card::{Card, expected};
use crate::domain::Place;

/// An entity as its directory has it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entity {
    /// Type number.
    pub(super) kind: i64,
    /// Form number.
    pub(super) form: i64,
    /// Its matrix as a pointer; 0 for none.
    pub(super) matrix: i64,
    /// Whether it is not to be shown.
    pub(super) is_blank: bool,
    /// Whether it has no meaning but as a part of another entity.
    pub(super) is_part: bool,
    /// Its parameter lines: the first one's index, and how many.
    pub(super) lines: [usize; 2],
    /// Line of the file.
    pub(super) line: u64,
}

/// Reads the directory; parameter lines must exist, and none is claimed by two entities.
pub(super) fn read(cards: &[Card], parameters: usize) -> Read<Vec<Entity>> {
    if let ([.., last], 1) = (cards, cards.len() % 2) {
        let (what, found) = ("a second line of the entity", "the end of the section".to_owned());
        return Err(Problem::Expected { what, found }.at(Place::Line(last.line)));
    }
    let mut claimed = 0;
    cards
        .chunks_exact(2)
        .map(|pair| {
            let entity = entity(&pair[0], &pair[1])?;
            let [first, count] = entity.lines;
            claimed += count;
            if entity.kind != 0
                && (first + count > parameters || count == 0 || claimed > parameters)
            {
                let what = "a range of parameter lines that the file has, none of them twice";
                return Err(expected(what, &pair[0].data[..16], entity.line));
            }
            Ok(entity)
        })
        .collect()
}

fn entity(first: &Card, second: &Card) -> Read<Entity> {
    let kind = field(first, 0)?;
    let status = &first.data[64..72];
    let digit = |i: usize| matches!(status[i], b'1'..=b'9');
    let at = field(first, 1)?;
    let count = field(second, 3)?;
    let line = |value: i64| usize::try_from(value).unwrap_or(usize::MAX >> 2).min(usize::MAX >> 2);
    Ok(Entity {
        kind,
        form: field(second, 4)?,
        matrix: field(first, 6)?,
        is_blank: digit(1),
        // 1 is physically dependent, 2 logically, 3 both.
        is_part: matches!(status[3], b'1' | b'3'),
        lines: [line(at - 1), line(count)],
        line: first.line,
    })
}

/// An integer of eight columns; 0 where there is none.
fn field(card: &Card, index: usize) -> Read<i64> {
    let text = &card.data[8 * index..8 * index + 8];
    let digits = text.trim_ascii();
    if digits.is_empty() {
        return Ok(0);
    }
    let value = std::str::from_utf8(digits).ok().and_then(|digits| digits.parse().ok());
    value.ok_or_else(|| expected("an integer in 8 columns", text, card.line))
}
