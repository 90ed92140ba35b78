//! Reading tokens, numbers and raw values from the bytes of a file, with the place of every fault.
//!
//! One scanner serves text and binary files, because MSH, PLY and legacy VTK files mix both. It
//! never allocates: a declared count is checked against the bytes that are left before anybody
//! reserves memory for it (SPEC X22).

use crate::format::error::{At, ReadError, ReadFault};
use memchr::{memchr, memmem};

/// Order of the bytes of a binary number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Endian {
    Little,
    Big,
}

/// A cursor over the bytes of a file.
#[derive(Clone, Debug)]
pub(crate) struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
    /// A byte that starts a comment to the end of the line.
    comment: Option<u8>,
    /// Whether places are byte offsets: set once binary data was met, which breaks line counting.
    binary: bool,
    /// Most significant digits of a coordinate that is not exactly an f64.
    digits: u8,
}

/// Whether `byte` separates tokens within a line.
const fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | 0x0b | 0x0c)
}

/// The first characters of `bytes`, safe to print.
pub(crate) fn excerpt(bytes: &[u8]) -> String {
    const LONGEST: usize = 32;
    let mut text = bytes[..bytes.len().min(LONGEST)].escape_ascii().to_string();
    if bytes.len() > LONGEST {
        text.push_str("...");
    }
    text
}

impl<'a> Scanner<'a> {
    /// A cursor at the first byte.
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        // Some editors put a byte order mark before UTF-8 text.
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { bytes, at, line: 1, comment: None, binary: false, digits: 0 }
    }

    /// A cursor at offset `start`, with the line it is on.
    pub(crate) fn within(bytes: &'a [u8], start: usize) -> Self {
        let lines = bytes[..start].iter().filter(|&&byte| byte == b'\n').count() as u64;
        Self { at: start, line: lines + 1, ..Self::new(bytes) }
    }

    /// The same cursor; `byte` starts a comment that ends with its line.
    pub(crate) fn with_comments(self, byte: u8) -> Self {
        Self { comment: Some(byte), ..self }
    }

    /// From here on faults are placed by byte offset.
    pub(crate) fn set_binary(&mut self) {
        self.binary = true;
    }

    /// Line of the next byte, from 1; `None` once the file turned out to be binary.
    pub(crate) fn line(&self) -> Option<u64> {
        (!self.binary).then_some(self.line)
    }

    /// The bytes not yet read.
    pub(crate) fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// See [`MeshData::decimal_digits`](crate::mesh::MeshData::decimal_digits).
    pub(crate) fn decimal_digits(&self) -> Option<u8> {
        (!self.binary && self.digits > 0).then_some(self.digits)
    }

    /// An error at the cursor.
    #[cold]
    pub(crate) fn fail(&self, fault: ReadFault) -> ReadError {
        let at = if self.binary { At::Byte(self.at as u64) } else { At::Line(self.line) };
        ReadError { file: "", at, fault }
    }

    /// The error that `found` stands where `expected` should, or that the file ends there.
    #[cold]
    pub(crate) fn malformed(&self, expected: &str, found: &[u8]) -> ReadError {
        let expected = expected.to_owned();
        self.fail(if found.is_empty() && self.at >= self.bytes.len() {
            ReadFault::Truncated { expected }
        } else {
            ReadFault::Malformed { expected, found: excerpt(found) }
        })
    }

    /// The error that `what` is not supported.
    #[cold]
    pub(crate) fn unsupported(&self, what: String, advice: &'static str) -> ReadError {
        self.fail(ReadFault::Unsupported { what, advice })
    }

    /// Skips spaces and comments up to the end of the line.
    #[inline]
    fn skip_space(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            if is_space(byte) {
                self.at += 1;
            } else if Some(byte) == self.comment {
                self.skip_to_line_end();
                return;
            } else {
                return;
            }
        }
    }

    /// Moves to the line feed that ends this line, or to the end of the file.
    fn skip_to_line_end(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += memchr(b'\n', rest).unwrap_or(rest.len());
    }

    /// Skips spaces, comments and line ends.
    #[inline]
    pub(crate) fn skip_blank(&mut self) {
        loop {
            self.skip_space();
            if self.bytes.get(self.at) != Some(&b'\n') {
                return;
            }
            self.at += 1;
            self.line += 1;
        }
    }

    /// Whether nothing but blanks and comments is left; skips them.
    pub(crate) fn is_at_end(&mut self) -> bool {
        self.skip_blank();
        self.at >= self.bytes.len()
    }

    /// Whether nothing but blanks is left on this line; skips them.
    pub(crate) fn is_at_line_end(&mut self) -> bool {
        self.skip_space();
        matches!(self.bytes.get(self.at), None | Some(b'\n'))
    }

    /// The token at the cursor, not consumed; empty at a blank.
    #[inline]
    fn peek_here(&self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let is_end = |&byte: &u8| is_space(byte) || byte == b'\n' || Some(byte) == self.comment;
        &rest[..rest.iter().position(is_end).unwrap_or(rest.len())]
    }

    /// The next token on this or a later line, not consumed; empty at the end of the file.
    #[inline]
    pub(crate) fn peek(&mut self) -> &'a [u8] {
        self.skip_blank();
        self.peek_here()
    }

    /// Consumes and returns the next token on this or a later line.
    pub(crate) fn token(&mut self, expected: &str) -> Result<&'a [u8], ReadError> {
        let token = self.peek();
        if token.is_empty() {
            return Err(self.malformed(expected, token));
        }
        self.at += token.len();
        Ok(token)
    }

    /// Consumes and returns the next token of this line, if there is one.
    pub(crate) fn token_on_line(&mut self) -> Option<&'a [u8]> {
        self.skip_space();
        let token = self.peek_here();
        self.at += token.len();
        (!token.is_empty()).then_some(token)
    }

    /// Consumes the rest of the line with its line feed; returns it trimmed, comments included.
    pub(crate) fn rest_of_line(&mut self) -> &'a [u8] {
        let start = self.at;
        self.skip_to_line_end();
        let text = &self.bytes[start..self.at];
        if self.at < self.bytes.len() {
            self.at += 1;
            self.line += 1;
        }
        text.trim_ascii()
    }

    /// Consumes the next line; returns it trimmed and without its comment, `None` at the end of
    /// the file.
    pub(crate) fn next_line(&mut self) -> Option<&'a [u8]> {
        if self.at >= self.bytes.len() {
            return None;
        }
        let line = self.rest_of_line();
        let comment = self.comment.and_then(|byte| memchr(byte, line));
        Some(comment.map_or(line, |end| line[..end].trim_ascii_end()))
    }

    /// Consumes `word`, or fails.
    pub(crate) fn expect(&mut self, word: &str) -> Result<(), ReadError> {
        let token = self.peek();
        if token != word.as_bytes() {
            return Err(self.malformed(&format!("`{word}`"), token));
        }
        self.at += token.len();
        Ok(())
    }

    /// Consumes an integer on this or a later line.
    #[inline]
    pub(crate) fn integer(&mut self, expected: &str) -> Result<i64, ReadError> {
        let token = self.peek();
        let value = self.parse_integer(token, expected)?;
        self.at += token.len();
        Ok(value)
    }

    /// Consumes an integer on this line; `None` where the line ends.
    pub(crate) fn integer_on_line(&mut self, expected: &str) -> Result<Option<i64>, ReadError> {
        if self.is_at_line_end() { Ok(None) } else { self.integer(expected).map(Some) }
    }

    /// The value of `token` as an integer.
    #[inline]
    pub(crate) fn parse_integer(&self, token: &[u8], expected: &str) -> Result<i64, ReadError> {
        let (negative, digits) = match token {
            [b'-', digits @ ..] => (true, digits),
            [b'+', digits @ ..] => (false, digits),
            digits => (false, digits),
        };
        if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
            return Err(self.malformed(expected, token));
        }
        let significant = digits.len() - digits.iter().take_while(|&&d| d == b'0').count();
        // 18 digits always fit an i64; more are nobody's index or count.
        if significant > 18 {
            let literal = excerpt(token);
            return Err(self.fail(ReadFault::Number { literal, range: "counts and indices" }));
        }
        let value = digits.iter().fold(0_i64, |sum, d| sum.wrapping_mul(10) + i64::from(d - b'0'));
        Ok(if negative { -value } else { value })
    }

    /// Consumes a count of items that take `bytes_each` bytes of the file at least.
    pub(crate) fn count(
        &mut self,
        what: &'static str,
        bytes_each: usize,
    ) -> Result<usize, ReadError> {
        let expected = format!("the number of {what}");
        let declared = self.integer(&expected)?;
        self.check_count(what, declared, bytes_each)
    }

    /// A declared count as a number that memory may be reserved for: each item takes `bytes_each`
    /// bytes of the rest of the file at least, so a lie is found before anything is allocated.
    pub(crate) fn check_count(
        &self,
        what: &'static str,
        declared: i64,
        bytes_each: usize,
    ) -> Result<usize, ReadError> {
        // The last item of a text file may lack its separator: hence + 1.
        let possible = (self.rest().len() as u64 + 1) / bytes_each.max(1) as u64;
        match u64::try_from(declared) {
            Ok(count) if count <= possible && count < u64::from(u32::MAX) => Ok(count as usize),
            _ => Err(self.fail(ReadFault::Count { what, declared, possible })),
        }
    }

    /// Consumes a decimal on this or a later line: the f64 nearest to it (SPEC X23).
    #[inline]
    pub(crate) fn float(&mut self, expected: &str) -> Result<f64, ReadError> {
        let token = self.peek();
        let value = self.parse_float(token, expected)?;
        self.at += token.len();
        Ok(value)
    }

    /// Consumes the first `dimension` coordinates of a point; the others are 0.
    #[inline]
    pub(crate) fn point(&mut self, dimension: usize) -> Result<[f64; 3], ReadError> {
        const NAMES: [&str; 3] =
            ["the x coordinate of a point", "the y coordinate of a point", "the z coordinate"];
        let mut point = [0.0; 3];
        for (coordinate, name) in point.iter_mut().zip(NAMES).take(dimension) {
            *coordinate = self.float(name)?;
        }
        Ok(point)
    }

    /// Consumes `N` references to points.
    #[inline]
    pub(crate) fn corners<const N: usize>(&mut self) -> Result<[i64; N], ReadError> {
        let mut corners = [0; N];
        for corner in &mut corners {
            *corner = self.integer("the number of a point")?;
        }
        Ok(corners)
    }

    /// The value of `token` as a decimal, noting its digits.
    #[inline]
    pub(crate) fn parse_float(&mut self, token: &[u8], expected: &str) -> Result<f64, ReadError> {
        let text = std::str::from_utf8(token).map_err(|_| self.malformed(expected, token))?;
        let value = match text.parse::<f64>() {
            Ok(value) => value,
            Err(_) => self.parse_fortran(text, expected)?,
        };
        if value.is_infinite() && token.iter().any(u8::is_ascii_digit) {
            let literal = excerpt(token);
            return Err(self.fail(ReadFault::Number { literal, range: "f64" }));
        }
        if usize::from(self.digits) < token.len().min(usize::from(u8::MAX)) {
            self.note_digits(token);
        }
        Ok(value)
    }

    /// Fortran's `1.5D+03`, which ADCIRC and Abaqus files have.
    #[cold]
    fn parse_fortran(&self, text: &str, expected: &str) -> Result<f64, ReadError> {
        let error = || self.malformed(expected, text.as_bytes());
        // Only a digit or a point may precede the exponent: `d` alone is no number.
        let (mantissa, exponent) = text.split_once(['d', 'D']).ok_or_else(error)?;
        if !mantissa.ends_with(|c: char| c.is_ascii_digit() || c == '.') {
            return Err(error());
        }
        format!("{mantissa}e{exponent}").parse().map_err(|_| error())
    }

    /// Raises `digits` to the significant digits of a decimal that is not exactly an f64.
    fn note_digits(&mut self, token: &[u8]) {
        let mantissa = token.split(|b| b.is_ascii_alphabetic()).next().unwrap_or(token);
        let is_digit = |b: &&u8| b.is_ascii_digit();
        let leading = |b: &&u8| !matches!(**b, b'1'..=b'9');
        let count = mantissa.iter().skip_while(leading).filter(is_digit).count();
        if count > usize::from(self.digits) && !is_exact(mantissa, mantissa.len() == token.len()) {
            self.digits = count.min(usize::from(u8::MAX)) as u8;
        }
    }

    /// Consumes `length` raw bytes.
    pub(crate) fn take(&mut self, length: usize, expected: &str) -> Result<&'a [u8], ReadError> {
        match self.rest().get(..length) {
            Some(bytes) => {
                self.at += length;
                Ok(bytes)
            }
            None => Err(self.fail(ReadFault::Truncated { expected: expected.to_owned() })),
        }
    }

    /// Consumes `N` raw bytes, put into little-endian order.
    #[inline]
    fn take_array<const N: usize>(
        &mut self,
        endian: Endian,
        expected: &str,
    ) -> Result<[u8; N], ReadError> {
        let mut bytes = [0; N];
        bytes.copy_from_slice(self.take(N, expected)?);
        if endian == Endian::Big {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// Consumes a binary 32-bit signed integer.
    #[inline]
    pub(crate) fn i32(&mut self, endian: Endian, expected: &str) -> Result<i64, ReadError> {
        Ok(i64::from(i32::from_le_bytes(self.take_array(endian, expected)?)))
    }

    /// Consumes a binary 64-bit signed integer.
    #[inline]
    pub(crate) fn i64(&mut self, endian: Endian, expected: &str) -> Result<i64, ReadError> {
        Ok(i64::from_le_bytes(self.take_array(endian, expected)?))
    }

    /// Consumes a binary double.
    #[inline]
    pub(crate) fn f64(&mut self, endian: Endian, expected: &str) -> Result<f64, ReadError> {
        Ok(f64::from_le_bytes(self.take_array(endian, expected)?))
    }

    /// Consumes a binary 32-bit float.
    #[inline]
    pub(crate) fn f32(&mut self, endian: Endian, expected: &str) -> Result<f64, ReadError> {
        Ok(f64::from(f32::from_le_bytes(self.take_array(endian, expected)?)))
    }

    /// Consumes a binary 32-bit unsigned integer.
    pub(crate) fn u32(&mut self, endian: Endian, expected: &str) -> Result<i64, ReadError> {
        Ok(i64::from(u32::from_le_bytes(self.take_array(endian, expected)?)))
    }

    /// Consumes `length` bytes of this line.
    pub(crate) fn skip_bytes(&mut self, length: usize) {
        self.at += length.min(self.rest().len());
    }

    /// Moves on to byte `offset` of a binary file, never back, so that no file is read twice.
    pub(crate) fn seek_forward(&mut self, offset: i64, expected: &str) -> Result<(), ReadError> {
        match usize::try_from(offset) {
            Ok(offset) if offset >= self.at && offset <= self.bytes.len() => {
                self.at = offset;
                Ok(())
            }
            _ => Err(self.malformed(expected, offset.to_string().as_bytes())),
        }
    }

    /// Moves past the next occurrence of `word`, wherever it stands.
    pub(crate) fn skip_past(&mut self, word: &[u8], expected: &str) -> Result<(), ReadError> {
        let Some(found) = memmem::find(self.rest(), word) else {
            self.line += self.rest().iter().filter(|&&b| b == b'\n').count() as u64;
            self.at = self.bytes.len();
            return Err(self.fail(ReadFault::Truncated { expected: expected.to_owned() }));
        };
        let skipped = &self.bytes[self.at..self.at + found];
        self.line += skipped.iter().filter(|&&b| b == b'\n').count() as u64;
        self.at += found + word.len();
        Ok(())
    }
}

/// Whether a decimal without exponent (`plain`) is a dyadic rational that an f64 holds: its digits,
/// as an integer, are then a multiple of 5^k for k digits after the point.
fn is_exact(mantissa: &[u8], plain: bool) -> bool {
    let digits = mantissa.iter().filter(|b| b.is_ascii_digit());
    let places = mantissa.iter().rev().take_while(|&&b| b != b'.').count();
    let places = if mantissa.contains(&b'.') { places as u32 } else { 0 };
    if !plain || digits.clone().count() > 19 || places > 19 {
        return false;
    }
    let value = digits.fold(0_u64, |sum, d| sum.wrapping_mul(10).wrapping_add(u64::from(d - b'0')));
    let fives = 5_u64.pow(places);
    value % fives == 0 && value / fives <= 1 << 53
}
