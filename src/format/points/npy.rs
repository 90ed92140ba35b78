//! Points as a `NumPy` array: shape (n, 2) or (n, 3), floats or integers of either byte order, rows or
//! columns together.
//!
//! Source: the `NumPy` documentation, `numpy.lib.format`, versions 1.0 to 3.0. The header is a
//! Python literal with the keys `descr`, `fortran_order` and `shape`; arrays of objects are pickles
//! and refused, as is everything that is not a table of numbers.

use super::{PointSet, THIRD, not_finite};
use crate::format::error::{ReadError, ReadFault};
use crate::format::scan::{Endian, Scanner, excerpt};
use crate::point::Point2;

const MAGIC: &[u8] = b"\x93NUMPY";

/// Reads the points of an array.
///
/// # Errors
/// The first fault, with its byte.
pub(super) fn read(bytes: &[u8]) -> Result<PointSet, ReadError> {
    let mut scanner = Scanner::new(bytes);
    scanner.set_binary();
    let magic = scanner.take(MAGIC.len(), "the first bytes of a NumPy file")?;
    if magic != MAGIC {
        return Err(scanner.malformed("the first bytes of a NumPy file, `\\x93NUMPY`", magic));
    }
    let header = read_header(&mut scanner)?;
    let array = Array::described_by(header, &scanner)?;
    array.points(&scanner)
}

/// The text of the header.
fn read_header<'a>(scanner: &mut Scanner<'a>) -> Result<&'a [u8], ReadError> {
    let version = scanner.take(2, "the version")?;
    let length = match version[0] {
        1 => scanner.take(2, "the length of the header")?,
        2 | 3 => scanner.take(4, "the length of the header")?,
        other => {
            let what = format!("version {other} of NumPy's format");
            return Err(scanner.unsupported(what, "save it with a NumPy of today"));
        }
    };
    let length = length.iter().rev().fold(0, |sum, &byte| sum << 8 | usize::from(byte));
    scanner.take(length, "the header")
}

/// Kind of number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Float,
    Signed,
    Unsigned,
}

/// The numbers of an array.
struct Array {
    kind: Kind,
    /// Bytes of a number.
    size: usize,
    endian: Endian,
    by_columns: bool,
    rows: usize,
    columns: usize,
}

impl Array {
    fn described_by(header: &[u8], scanner: &Scanner) -> Result<Self, ReadError> {
        let missing = |key: &str| scanner.malformed(&format!("the key `{key}`"), header);
        let kind = entry(header, b"'descr'").ok_or_else(|| missing("descr"))?;
        let (kind, size, endian) = number_type(kind, scanner)?;
        let order = entry(header, b"'fortran_order'").ok_or_else(|| missing("fortran_order"))?;
        let by_columns = match order {
            order if order.starts_with(b"True") => true,
            order if order.starts_with(b"False") => false,
            other => return Err(scanner.malformed("`True` or `False`", other)),
        };
        let shape = entry(header, b"'shape'").ok_or_else(|| missing("shape"))?;
        let [rows, columns] = table_shape(shape, scanner)?;
        // In 128 bits: the product of any two counts and 8 fits.
        let (stated, present) =
            (rows as u128 * columns as u128 * size as u128, scanner.rest().len());
        if stated > present as u128 {
            let (declared, possible) =
                (i64::try_from(rows).unwrap_or(i64::MAX), present / size / columns);
            let possible = possible as u64;
            return Err(scanner.fail(ReadFault::Count { what: "points", declared, possible }));
        }
        if stated < present as u128 || rows >= u32::MAX as usize {
            let (declared, present) = (rows as i64, (present / size / columns) as u64);
            return Err(scanner.fail(ReadFault::Mismatch { what: "points", declared, present }));
        }
        Ok(Self { kind, size, endian, by_columns, rows, columns })
    }

    fn points(&self, scanner: &Scanner) -> Result<PointSet, ReadError> {
        let bytes = scanner.rest();
        let mut set = PointSet { points: Vec::with_capacity(self.rows), ..PointSet::default() };
        for row in 0..self.rows {
            let place = |column| {
                let index = if self.by_columns {
                    column * self.rows + row
                } else {
                    row * self.columns + column
                };
                index * self.size
            };
            let [x, y] = [0, 1].map(|column| self.number(&bytes[place(column)..][..self.size]));
            if !(x.is_finite() && y.is_finite()) {
                let mut at = scanner.clone();
                at.skip_bytes(place(usize::from(x.is_finite())));
                return Err(not_finite([x, y], at.fail(ReadFault::UnknownForm).at));
            }
            set.points.push(Point2::new(x, y));
        }
        set.left_out.extend((self.columns == 3).then(|| THIRD.to_owned()));
        Ok(set)
    }

    /// The double nearest to a number of up to eight bytes.
    fn number(&self, bytes: &[u8]) -> f64 {
        let mut padded = [0; 8];
        for (i, target) in padded.iter_mut().enumerate().take(bytes.len()) {
            *target = bytes[if self.endian == Endian::Little { i } else { bytes.len() - 1 - i }];
        }
        let bits = u64::from_le_bytes(padded);
        let unused = 64 - 8 * self.size as u32;
        match (self.kind, self.size) {
            (Kind::Float, 4) => f64::from(f32::from_bits(bits as u32)),
            (Kind::Float, _) => f64::from_bits(bits),
            (Kind::Signed, _) => (((bits << unused) as i64) >> unused) as f64,
            (Kind::Unsigned, _) => bits as f64,
        }
    }
}

/// What stands after `key` and its colon.
fn entry<'a>(header: &'a [u8], key: &[u8]) -> Option<&'a [u8]> {
    let at = memchr::memmem::find(header, key)?;
    let rest = header[at + key.len()..].trim_ascii_start();
    Some(rest.strip_prefix(b":")?.trim_ascii_start())
}

/// A type such as `'<f8'`.
fn number_type(text: &[u8], scanner: &Scanner) -> Result<(Kind, usize, Endian), ReadError> {
    let expected = "a type of numbers such as '<f8'";
    let Some(name) = text.strip_prefix(b"'").and_then(|t| t.split(|&b| b == b'\'').next()) else {
        // A list of fields, or no literal at all.
        return Err(scanner.unsupported(
            "an array of records".to_owned(),
            "save the two columns of coordinates as an array of floats",
        ));
    };
    let endian = match name.first() {
        Some(b'<' | b'|' | b'=') => Endian::Little,
        Some(b'>') => Endian::Big,
        _ => return Err(scanner.malformed(expected, name)),
    };
    let known = match &name[1..] {
        b"f4" => (Kind::Float, 4),
        b"f8" => (Kind::Float, 8),
        [kind @ (b'i' | b'u'), size @ (b'1' | b'2' | b'4' | b'8')] => {
            let kind = if *kind == b'i' { Kind::Signed } else { Kind::Unsigned };
            (kind, usize::from(size - b'0'))
        }
        _ => {
            let what = format!("an array of type `{}`", excerpt(name));
            return Err(scanner.unsupported(what, "save it as float64: a.astype('<f8')"));
        }
    };
    Ok((known.0, known.1, endian))
}

/// The shape `(n, 2)` or `(n, 3)`.
fn table_shape(text: &[u8], scanner: &Scanner) -> Result<[usize; 2], ReadError> {
    let expected = "a shape (n, 2) or (n, 3)";
    let inner = text.strip_prefix(b"(").and_then(|t| t.split(|&b| b == b')').next());
    let fail = || scanner.malformed(expected, text);
    let sizes = inner.ok_or_else(fail)?.split(|&b| b == b',').map(<[u8]>::trim_ascii);
    let sizes: Vec<&[u8]> = sizes.filter(|size| !size.is_empty()).take(4).collect();
    let [rows, columns] = sizes[..] else { return Err(fail()) };
    let [rows, columns] = [rows, columns].map(|size| scanner.parse_integer(size, expected));
    match (usize::try_from(rows?), usize::try_from(columns?)) {
        (Ok(rows), Ok(columns @ (2 | 3))) => Ok([rows, columns]),
        _ => Err(fail()),
    }
}
