//! The arrays of a VTU file: text, base64 or raw bytes, compressed or not.
//!
//! A compressed array can be far larger than the file. What it would expand to is known from its
//! header before anything is expanded, and must be what the counts of the file ask for and within
//! [`expansion_limit`] (SPEC X26).

use crate::format::error::{At, ReadError, ReadFault};
use crate::format::scalar::Scalar;
use crate::format::scan::{Endian, Scanner, excerpt};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use std::borrow::Cow;
use std::io::Read;

/// How the whole file is written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coding {
    pub(super) endian: Endian,
    /// Type of the sizes before binary data: [`Scalar::U32`] or [`Scalar::U64`].
    pub(super) header: Scalar,
    pub(super) compression: Compression,
}

/// How binary data of a file is compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    Zlib,
    /// LZ4 or LZMA.
    Other,
}

/// Where the values of an array stand: offsets into the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    Ascii { start: usize, end: usize },
    Base64 { start: usize, end: usize },
    Raw { start: usize, end: usize },
}

/// An array as its element declares it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Array {
    pub(super) scalar: Scalar,
    pub(super) source: Source,
}

/// The most that all arrays of a file of `size` bytes may expand to: 16 MiB, or 256 times the file.
pub(super) fn expansion_limit(size: usize) -> u64 {
    (16 << 20) + 256 * size as u64
}

/// Decodes arrays, within the limit.
pub(super) struct Decoder<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) coding: Coding,
    /// What may still be expanded.
    pub(super) left: u64,
    /// See [`MeshData::decimal_digits`](crate::mesh::MeshData::decimal_digits).
    pub(super) digits: Option<u8>,
}

/// A fault in the array at hand, before its place is known.
type Fallible<T> = Result<T, ReadFault>;

fn malformed(expected: &str, found: &[u8]) -> ReadFault {
    ReadFault::Malformed { expected: expected.to_owned(), found: excerpt(found) }
}

fn truncated() -> ReadFault {
    ReadFault::Truncated { expected: "the data of an array".to_owned() }
}

/// The line of byte `offset`, unless binary data makes lines meaningless.
pub(super) fn place(bytes: &[u8], offset: usize) -> At {
    let before = &bytes[..offset.min(bytes.len())];
    At::Line(before.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1)
}

impl<'a> Decoder<'a> {
    /// The values of `array`, which must be `count`, as doubles.
    pub(super) fn floats(
        &mut self,
        array: Array,
        what: &'static str,
        count: u64,
    ) -> Result<Vec<f64>, ReadError> {
        if let Source::Ascii { start, end } = array.source {
            return self.text(start, end, (what, count), |scanner| scanner.float("a coordinate"));
        }
        let bytes = self.bytes_of(array, what, count)?;
        Ok(array.scalar.floats(&bytes, self.coding.endian))
    }

    /// The values of `array`, which must be `count`, as integers.
    pub(super) fn integers(
        &mut self,
        array: Array,
        what: &'static str,
        count: u64,
    ) -> Result<Vec<i64>, ReadError> {
        if let Source::Ascii { start, end } = array.source {
            return self.text(start, end, (what, count), |scanner| scanner.integer("an integer"));
        }
        let bytes = self.bytes_of(array, what, count)?;
        Ok(array.scalar.integers(&bytes, self.coding.endian))
    }

    fn text<T>(
        &mut self,
        start: usize,
        end: usize,
        (what, count): (&'static str, u64),
        read: impl Fn(&mut Scanner<'a>) -> Result<T, ReadError>,
    ) -> Result<Vec<T>, ReadError> {
        let mut scanner = Scanner::within(&self.bytes[..end], start);
        let declared = i64::try_from(count).unwrap_or(i64::MAX);
        let count = scanner.check_count(what, declared, 2)?;
        let mut values = Vec::with_capacity(count);
        for _ in 0..count {
            values.push(read(&mut scanner)?);
        }
        if !scanner.is_at_end() {
            let found = scanner.peek();
            return Err(scanner.malformed(&format!("{count} {what} and no more"), found));
        }
        self.digits = self.digits.max(scanner.decimal_digits());
        Ok(values)
    }

    /// The bytes of `count` values.
    fn bytes_of(
        &mut self,
        array: Array,
        what: &'static str,
        count: u64,
    ) -> Result<Cow<'a, [u8]>, ReadError> {
        let unsupported = || ReadFault::Unsupported {
            what: "a compressor other than vtkZLibDataCompressor".to_owned(),
            advice: "save the file uncompressed or with zlib",
        };
        let is_readable = self.coding.compression != Compression::Other;
        let (start, result) = match array.source {
            Source::Base64 { start, .. } | Source::Raw { start, .. } if !is_readable => {
                (start, Err(unsupported()))
            }
            Source::Ascii { start, .. } => (start, Err(malformed("binary data", b""))),
            Source::Base64 { start, end } => (start, self.base64(array, start, end, (what, count))),
            Source::Raw { start, end } => (start, self.raw(array, start, end, (what, count))),
        };
        result.map_err(|fault| {
            let at = match array.source {
                Source::Raw { .. } => At::Byte(start as u64),
                _ => place(self.bytes, start),
            };
            ReadError { file: "", at, fault }
        })
    }

    fn base64(
        &mut self,
        array: Array,
        start: usize,
        end: usize,
        expected: (&'static str, u64),
    ) -> Fallible<Cow<'a, [u8]>> {
        let text = self.bytes[start..end].trim_ascii();
        let text = if text.iter().any(u8::is_ascii_whitespace) {
            Cow::Owned(text.iter().copied().filter(|byte| !byte.is_ascii_whitespace()).collect())
        } else {
            Cow::Borrowed(text)
        };
        let stream = Base64(&text);
        let size = self.coding.header.size();
        if self.coding.compression == Compression::Zlib {
            let blocks = stream.decode(0, 3 * size)?;
            let blocks = self.block_count(&blocks, text.len())?;
            let header = stream.decode(0, (3 + blocks) * size)?;
            let header = self.read_header(&header, array, expected)?;
            let data = stream.decode(encoded((3 + blocks) * size), header.compressed()?)?;
            return self.expand(&header, &data).map(Cow::Owned);
        }
        // Some writers end the stream after the length, others go on.
        let ends = text.get(..encoded(size)).is_some_and(|head| head.contains(&b'='));
        let separate = ends && text.len() > encoded(size);
        let length = stream.decode(0, size)?;
        let length = self.check_length(&length, array, expected)?;
        if separate && !size.is_multiple_of(3) {
            return stream.decode(encoded(size), length).map(Cow::Owned);
        }
        let mut bytes = stream.decode(0, size + length)?;
        bytes.drain(..size);
        Ok(Cow::Owned(bytes))
    }

    fn raw(
        &mut self,
        array: Array,
        start: usize,
        end: usize,
        expected: (&'static str, u64),
    ) -> Fallible<Cow<'a, [u8]>> {
        let bytes = &self.bytes[start..end];
        let size = self.coding.header.size();
        if self.coding.compression == Compression::Zlib {
            let head = bytes.get(..3 * size).ok_or_else(truncated)?;
            let header_bytes = (3 + self.block_count(head, bytes.len())?) * size;
            let header = bytes.get(..header_bytes).ok_or_else(truncated)?;
            let header = self.read_header(header, array, expected)?;
            return self.expand(&header, &bytes[header_bytes..]).map(Cow::Owned);
        }
        let head = bytes.get(..size).ok_or_else(truncated)?;
        let length = self.check_length(head, array, expected)?;
        bytes[size..].get(..length).map(Cow::Borrowed).ok_or_else(truncated)
    }

    /// The number of bytes that stands before uncompressed data.
    fn check_length(
        &mut self,
        head: &[u8],
        array: Array,
        (what, count): (&'static str, u64),
    ) -> Fallible<usize> {
        let length = self.numbers(head)[0];
        self.check_total(length as u64, array, (what, count))?;
        // Many arrays may share one stretch of appended data.
        let limit = self.left;
        let left = limit.checked_sub(length as u64).ok_or(ReadFault::Expansion { limit });
        self.left = left?;
        usize::try_from(length).map_err(|_| truncated())
    }

    /// The sizes before data, which are never negative: one beyond i64 is the largest i64.
    fn numbers(&self, bytes: &[u8]) -> Vec<i64> {
        self.coding.header.integers(bytes, self.coding.endian)
    }

    /// An array must have the bytes that the counts of the file ask for.
    fn check_total(
        &self,
        bytes: u64,
        array: Array,
        (what, count): (&'static str, u64),
    ) -> Fallible<()> {
        let size = array.scalar.size() as u64;
        if count.checked_mul(size) == Some(bytes) {
            return Ok(());
        }
        let declared = i64::try_from(count).unwrap_or(i64::MAX);
        Err(ReadFault::Mismatch { what, declared, present: bytes / size })
    }

    /// The number of compressed blocks, each of which has a size in a header within `room` bytes.
    fn block_count(&self, head: &[u8], room: usize) -> Fallible<usize> {
        let declared = self.numbers(head)[0];
        let possible = (room / self.coding.header.size()) as u64;
        match usize::try_from(declared) {
            Ok(blocks) if blocks as u64 <= possible => Ok(blocks),
            _ => Err(ReadFault::Count { what: "compressed blocks", declared, possible }),
        }
    }

    fn read_header(
        &mut self,
        bytes: &[u8],
        array: Array,
        expected: (&'static str, u64),
    ) -> Fallible<Header> {
        let numbers = self.numbers(bytes);
        let (block, last) = (numbers[1] as u64, numbers[2] as u64);
        let sizes: Vec<u64> = numbers[3..].iter().map(|&size| size as u64).collect();
        let full = sizes.len() as u64 - u64::from(last != 0 && !sizes.is_empty());
        let rest = if sizes.is_empty() { 0 } else { last };
        let total = full.checked_mul(block).and_then(|bytes| bytes.checked_add(rest));
        let limit = self.left;
        let total = total.filter(|&total| total <= limit);
        let total = total.ok_or(ReadFault::Expansion { limit })?;
        self.check_total(total, array, expected)?;
        self.left -= total;
        Ok(Header { block, last, sizes, total })
    }

    /// Expands the blocks; each must give exactly the bytes that the header says.
    fn expand(&self, header: &Header, mut data: &[u8]) -> Fallible<Vec<u8>> {
        let mut bytes = Vec::new();
        for (index, &size) in header.sizes.iter().enumerate() {
            let is_last = index + 1 == header.sizes.len();
            let length = if is_last && header.last != 0 { header.last } else { header.block };
            let size = usize::try_from(size).map_err(|_| truncated())?;
            let block = data.get(..size).ok_or_else(truncated)?;
            data = &data[size..];
            let before = bytes.len() as u64;
            // One byte more than allowed shows that the block is longer than declared.
            let result = ZlibDecoder::new(block).take(length + 1).read_to_end(&mut bytes);
            if result.is_err() || bytes.len() as u64 - before != length {
                let expected = format!("a zlib block of {length} bytes");
                return Err(malformed(&expected, block));
            }
        }
        debug_assert_eq!(bytes.len() as u64, header.total);
        Ok(bytes)
    }
}

/// The header of compressed data.
struct Header {
    /// Bytes of a full block once expanded.
    block: u64,
    /// Bytes of the last block if it is not full, else 0.
    last: u64,
    /// Compressed bytes of each block.
    sizes: Vec<u64>,
    /// Bytes of all blocks once expanded.
    total: u64,
}

impl Header {
    /// Bytes of all compressed blocks.
    fn compressed(&self) -> Fallible<usize> {
        let sum = self.sizes.iter().try_fold(0_u64, |sum, &size| sum.checked_add(size));
        sum.and_then(|sum| usize::try_from(sum).ok()).ok_or_else(truncated)
    }
}

/// Characters of a base64 stream of `bytes` bytes.
const fn encoded(bytes: usize) -> usize {
    bytes.div_ceil(3) * 4
}

/// Base64 characters without spaces.
struct Base64<'t>(&'t [u8]);

impl Base64<'_> {
    /// The first `length` bytes of the stream that starts at character `start`.
    fn decode(&self, start: usize, length: usize) -> Fallible<Vec<u8>> {
        let available = self.0.get(start..).ok_or_else(truncated)?;
        if length > available.len() {
            return Err(truncated());
        }
        let characters = available.get(..encoded(length)).ok_or_else(truncated)?;
        let decoded = STANDARD.decode(characters);
        let mut bytes = decoded.map_err(|_| malformed("base64 data", characters))?;
        if bytes.len() < length {
            return Err(truncated());
        }
        bytes.truncate(length);
        Ok(bytes)
    }
}
