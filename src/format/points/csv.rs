//! Points as columns separated by commas, semicolons or tabs, read by the `csv` crate (RFC 4180).
//!
//! The separator is the first of the three that the first line has. A first line of which the
//! first two fields are no numbers names the columns: those called x and y (or longitude and
//! latitude, easting and northing) are taken, else the first two. Lines from `#` on are comments.

use super::{PointSet, not_finite};
use crate::format::error::{At, ReadError, ReadFault};
use crate::format::scan::{Scanner, excerpt};
use crate::point::Point2;
use csv::{ByteRecord, ReaderBuilder, Trim};

/// Names of the columns that are taken, in pairs.
const NAMES: [[&str; 2]; 6] = [
    ["x", "y"],
    ["lon", "lat"],
    ["long", "lat"],
    ["lng", "lat"],
    ["longitude", "latitude"],
    ["easting", "northing"],
];

/// Reads the points of a file, one a record.
///
/// # Errors
/// The first record without two finite numbers in the columns taken, with its line.
pub(super) fn read(bytes: &[u8]) -> Result<PointSet, ReadError> {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(Trim::All)
        .delimiter(separator(bytes))
        .from_reader(bytes);
    let mut set = PointSet::default();
    let mut columns = [0, 1];
    let mut names = None;
    let mut record = ByteRecord::new();
    let mut width = 0;
    while read_record(&mut reader, &mut record)? {
        let line = line_of(bytes, &record);
        if set.points.is_empty() && names.is_none() && is_header(&record) {
            columns = columns_of(&record);
            names = Some(record.clone());
            continue;
        }
        set.lines.push(set.points.len() as u32, line);
        set.points.push(point(&record, columns, line)?);
        width = width.max(record.len());
    }
    set.left_out.extend(left_out(names.as_ref(), columns, width));
    Ok(set)
}

fn read_record(
    reader: &mut csv::Reader<&[u8]>,
    record: &mut ByteRecord,
) -> Result<bool, ReadError> {
    // In memory and without regard to text or width, nothing can be wrong; were it, it has a line.
    reader.read_byte_record(record).map_err(|error| {
        let line = error.position().map_or(0, csv::Position::line);
        let found = error.to_string();
        fail(line, ReadFault::Malformed { expected: "a line of columns".to_owned(), found })
    })
}

/// The line on which a record starts: its position is that of the empty lines and comments before.
fn line_of(bytes: &[u8], record: &ByteRecord) -> u64 {
    let Some(position) = record.position() else { return 0 };
    let start = usize::try_from(position.byte()).unwrap_or(usize::MAX).min(bytes.len());
    let lines = bytes[start..].split(|&byte| byte == b'\n');
    let says_nothing = |line: &&[u8]| line.trim_ascii().is_empty() || line.starts_with(b"#");
    position.line() + lines.take_while(says_nothing).count() as u64
}

fn fail(line: u64, fault: ReadFault) -> ReadError {
    ReadError { file: "", at: At::Line(line), fault }
}

/// The separator: the first one in the first line that is no comment.
fn separator(bytes: &[u8]) -> u8 {
    let says = |line: &&[u8]| !line.trim_ascii().is_empty() && !line.starts_with(b"#");
    let line = bytes.split(|&byte| byte == b'\n').find(says).unwrap_or_default();
    let found = line.iter().copied().find(|byte| [b',', b';', b'\t'].contains(byte));
    found.unwrap_or(b',')
}

/// Whether the first two fields of a record are no numbers.
fn is_header(record: &ByteRecord) -> bool {
    let is_name = |field: &[u8]| !field.is_empty() && parse(field).is_none();
    record.len() > 1 && record.iter().take(2).all(is_name)
}

fn parse(field: &[u8]) -> Option<f64> {
    std::str::from_utf8(field).ok()?.parse().ok()
}

/// The columns that a line of names points at; the first two if it does not.
fn columns_of(names: &ByteRecord) -> [usize; 2] {
    let at = |name: &str| names.iter().position(|n| n.eq_ignore_ascii_case(name.as_bytes()));
    let found = NAMES.iter().find_map(|[x, y]| Some([at(x)?, at(y)?]));
    found.unwrap_or([0, 1])
}

fn point(record: &ByteRecord, columns: [usize; 2], line: u64) -> Result<Point2, ReadError> {
    let Some(fields) = record.get(columns[0]).zip(record.get(columns[1])) else {
        let expected = "columns separated by commas, semicolons or tabs".to_owned();
        let found = match record.len() {
            1 => excerpt(record.get(0).unwrap_or_default()),
            count => format!("{count} columns"),
        };
        return Err(fail(line, ReadFault::Malformed { expected, found }));
    };
    let x = number(fields.0, "the x coordinate of a point", line)?;
    let y = number(fields.1, "the y coordinate of a point", line)?;
    if x.is_finite() && y.is_finite() {
        return Ok(Point2::new(x, y));
    }
    Err(not_finite([x, y], At::Line(line)))
}

/// A field as a number, by the rules of all text files.
fn number(field: &[u8], expected: &str, line: u64) -> Result<f64, ReadError> {
    if field.is_empty() {
        let (expected, found) = (expected.to_owned(), "an empty column".to_owned());
        return Err(fail(line, ReadFault::Malformed { expected, found }));
    }
    let number = Scanner::new(field).parse_float(field, expected);
    number.map_err(|error| ReadError { at: At::Line(line), ..error })
}

/// The columns that are not taken.
fn left_out(names: Option<&ByteRecord>, taken: [usize; 2], width: usize) -> Option<String> {
    let others = (0..width).filter(|column| !taken.contains(column));
    let name = |column: usize| match names.and_then(|names| names.get(column)) {
        Some(name) => format!("`{}`", excerpt(name)),
        None => (column + 1).to_string(),
    };
    let mut listed: Vec<String> = others.clone().take(4).map(name).collect();
    let rest = others.count().saturating_sub(listed.len());
    listed.extend((rest > 0).then(|| format!("{rest} more")));
    match listed.len() {
        0 => None,
        1 => Some(format!("column {}", listed[0])),
        _ => Some(format!("columns {}", listed.join(", "))),
    }
}
