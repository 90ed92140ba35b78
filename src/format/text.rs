//! Writing numbers as text: shortest decimals that read back to the same bits, buffered.

use std::io::{self, Write};

/// Bytes collected before they are handed on.
const BUFFER_BYTES: usize = 1 << 16;

impl Write for TextOut<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes(bytes)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.flush_buffer()?;
        self.out.flush()
    }
}

/// A buffered writer of tokens and raw values.
pub(crate) struct TextOut<'a> {
    out: &'a mut dyn Write,
    buffer: Vec<u8>,
}

impl<'a> TextOut<'a> {
    pub(crate) fn new(out: &'a mut dyn Write) -> Self {
        Self { out, buffer: Vec::with_capacity(BUFFER_BYTES + 64) }
    }

    /// Appends raw bytes.
    #[inline]
    pub(crate) fn bytes(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.buffer.extend_from_slice(bytes);
        if self.buffer.len() >= BUFFER_BYTES { self.flush_buffer() } else { Ok(()) }
    }

    fn flush_buffer(&mut self) -> io::Result<()> {
        self.out.write_all(&self.buffer)?;
        self.buffer.clear();
        Ok(())
    }

    /// Appends text.
    pub(crate) fn text(&mut self, text: &str) -> io::Result<()> {
        self.bytes(text.as_bytes())
    }

    /// Appends an integer and `end`.
    #[inline]
    pub(crate) fn integer(&mut self, value: i64, end: u8) -> io::Result<()> {
        let mut digits = itoa::Buffer::new();
        self.buffer.extend_from_slice(digits.format(value).as_bytes());
        self.bytes(&[end])
    }

    /// Appends references to points, counted from `base`, with blanks between them and `end`.
    #[inline]
    pub(crate) fn corners(&mut self, corners: &[u32], base: i64, end: u8) -> io::Result<()> {
        for (index, &corner) in corners.iter().enumerate() {
            let after = if index + 1 == corners.len() { end } else { b' ' };
            self.integer(i64::from(corner) + base, after)?;
        }
        Ok(())
    }

    /// Appends a finite number as JSON and Rust read it back to the same bits, -0.0 included.
    pub(crate) fn number(&mut self, value: f64) -> io::Result<()> {
        let mut digits = zmij::Buffer::new();
        self.bytes(digits.format_finite(value).as_bytes())
    }

    /// Appends the shortest decimal that reads back to the same bits, and `end`. Infinities and
    /// NaN become `inf`, `-inf` and `nan`, which C, Fortran, Python and Rust read.
    #[inline]
    pub(crate) fn float(&mut self, value: f64, end: u8) -> io::Result<()> {
        let mut digits = zmij::Buffer::new();
        let text = if value.is_finite() {
            // `1.0` is as exact as `1` but longer: meshes are full of zeros and ones.
            let text = digits.format_finite(value);
            text.strip_suffix(".0").unwrap_or(text)
        } else if value.is_nan() {
            "nan"
        } else if value > 0.0 {
            "inf"
        } else {
            "-inf"
        };
        self.buffer.extend_from_slice(text.as_bytes());
        self.bytes(&[end])
    }

    /// Hands everything on.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        self.flush_buffer()?;
        self.out.flush()
    }
}
