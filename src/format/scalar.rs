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

    /// The type that a legacy VTK file calls `name`, in lower case.
    pub(crate) fn from_vtk_name(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "vtktypeint8" => Self::I8,
            "unsigned_char" | "vtktypeuint8" => Self::U8,
            "short" | "vtktypeint16" => Self::I16,
            "unsigned_short" | "vtktypeuint16" => Self::U16,
            // A vtkIdType is written as an int whatever its size in memory.
            "int" | "vtkidtype" | "vtktypeint32" => Self::I32,
            "unsigned_int" | "vtktypeuint32" => Self::U32,
            "long" | "vtktypeint64" => Self::I64,
            "unsigned_long" | "vtktypeuint64" => Self::U64,
            "float" => Self::F32,
            "double" => Self::F64,
            _ => return None,
        })
    }

    /// The type that a PLY file calls `name`.
    pub(crate) fn from_ply_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"int64" => Self::I64,
            b"uint64" => Self::U64,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// The number that the bytes of one hold, as a double.
    #[inline]
    pub(crate) fn float(self, bytes: &[u8], endian: Endian) -> f64 {
        match self {
            Self::F32 => f64::from(f32::from_bits(raw(bytes, endian) as u32)),
            Self::F64 => f64::from_bits(raw(bytes, endian)),
            _ => self.integer(bytes, endian) as f64,
        }
    }

    /// The number that the bytes of one hold, as [`Self::integers`] does it.
    #[inline]
    pub(crate) fn integer(self, bytes: &[u8], endian: Endian) -> i64 {
        let bits = raw(bytes, endian);
        match self {
            Self::I8 => i64::from(bits as i8),
            Self::I16 => i64::from(bits as i16),
            Self::I32 => i64::from(bits as i32),
            Self::I64 => bits as i64,
            Self::U8 | Self::U16 | Self::U32 | Self::U64 => i64::try_from(bits).unwrap_or(i64::MAX),
            Self::F32 | Self::F64 => self.float(bytes, endian) as i64,
        }
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

/// The bits of a number of at most eight bytes.
#[inline]
fn raw(bytes: &[u8], endian: Endian) -> u64 {
    let join = |bits: u64, &byte: &u8| bits << 8 | u64::from(byte);
    match endian {
        Endian::Little => bytes.iter().rev().fold(0, join),
        Endian::Big => bytes.iter().fold(0, join),
    }
}
