//! Number types of binary files, and arrays of them.

use crate::format::scan::Endian;

/// A number type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// Converts every chunk of bytes that makes one number.
macro_rules! convert {
    ($type:ty, $bytes:expr, $endian:expr, $convert:expr) => {{
        let chunks = $bytes.as_chunks::<{ size_of::<$type>() }>().0.iter();
        match $endian {
            Endian::Little => chunks.map(|&c| $convert(<$type>::from_le_bytes(c))).collect(),
            Endian::Big => chunks.map(|&c| $convert(<$type>::from_be_bytes(c))).collect(),
        }
    }};
}

impl Scalar {
    /// The type that a VTU file calls `name`.
    pub(crate) fn from_vtu_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"Int8" => Self::I8,
            b"UInt8" => Self::U8,
            b"Int16" => Self::I16,
            b"UInt16" => Self::U16,
            b"Int32" => Self::I32,
            b"UInt32" => Self::U32,
            b"Int64" => Self::I64,
            b"UInt64" => Self::U64,
            b"Float32" => Self::F32,
            b"Float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes of a number.
    pub(crate) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Whether numbers of the type are integers.
    pub(crate) const fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// All numbers in `bytes` as doubles; a 64-bit integer is rounded.
    pub(crate) fn floats(self, bytes: &[u8], endian: Endian) -> Vec<f64> {
        match self {
            Self::F32 => convert!(f32, bytes, endian, f64::from),
            Self::F64 => convert!(f64, bytes, endian, |value| value),
            _ => self.integers(bytes, endian).into_iter().map(|value| value as f64).collect(),
        }
    }

    /// All numbers in `bytes` as integers; an unsigned one beyond i64 becomes the largest i64 and a
    /// fraction is cut off, so callers that mind ask [`Self::is_integer`] first.
    pub(crate) fn integers(self, bytes: &[u8], endian: Endian) -> Vec<i64> {
        let unsigned = |value: u64| i64::try_from(value).unwrap_or(i64::MAX);
        match self {
            Self::I8 => convert!(i8, bytes, endian, i64::from),
            Self::U8 => convert!(u8, bytes, endian, i64::from),
            Self::I16 => convert!(i16, bytes, endian, i64::from),
            Self::U16 => convert!(u16, bytes, endian, i64::from),
            Self::I32 => convert!(i32, bytes, endian, i64::from),
            Self::U32 => convert!(u32, bytes, endian, i64::from),
            Self::I64 => convert!(i64, bytes, endian, |value| value),
            Self::U64 => convert!(u64, bytes, endian, unsigned),
            Self::F32 => convert!(f32, bytes, endian, |value| value as i64),
            Self::F64 => convert!(f64, bytes, endian, |value| value as i64),
        }
    }
}
