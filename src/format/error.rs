//! What can be wrong with a mesh file, and where.

use crate::format::MeshForm;

/// Where in a file a fault stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum At {
    /// Line of a text file, counted from 1.
    Line(u64),
    /// Offset into a binary file, counted from 0.
    Byte(u64),
}

impl std::fmt::Display for At {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// A mesh file that cannot be read: the first fault and its place.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}{at}: {fault} (SPEC {})", fault.rule())]
pub struct ReadError {
    /// Which file of a form that has several, e.g. `.node: `; empty for the file itself.
    pub file: &'static str,
    /// Line or byte.
    pub at: At,
    /// What is wrong.
    pub fault: ReadFault,
}

impl ReadError {
    /// The SPEC id of the rule that the file breaks.
    #[must_use]
    pub fn rule(&self) -> &'static str {
        self.fault.rule()
    }

    /// The same error, said to stand in a companion file such as `.node: `.
    #[must_use]
    pub(crate) fn in_file(self, file: &'static str) -> Self {
        Self { file, ..self }
    }
}

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReadFault {
    /// Something else stands where the form demands `expected`.
    #[error("expected {expected}, found `{found}`")]
    Malformed {
        /// What the form demands here.
        expected: String,
        /// The first characters of what stands here.
        found: String,
    },
    /// The file ends too soon.
    #[error("the file ends where {expected} should stand")]
    Truncated {
        /// What the form demands here.
        expected: String,
    },
    /// A declared count is negative, or more than the rest of the file can hold.
    #[error("{declared} {what} are declared, but the file has room for {possible} at most")]
    Count {
        /// What is counted.
        what: &'static str,
        /// The count in the file.
        declared: i64,
        /// The most that could follow.
        possible: u64,
    },
    /// Two counts in the file contradict each other.
    #[error("{declared} {what} are declared, but there are {present}")]
    Mismatch {
        /// What is counted.
        what: &'static str,
        /// The count in the file.
        declared: i64,
        /// The number that is there.
        present: u64,
    },
    /// A literal that no finite f64, or no 64-bit integer, can stand for.
    #[error("`{literal}` is beyond the range of {range}")]
    Number {
        /// The first characters of the literal.
        literal: String,
        /// The type whose range it leaves.
        range: &'static str,
    },
    /// Two points of the file have the same number, so references to it are ambiguous.
    #[error("point number {number} is given twice")]
    Duplicate {
        /// The number.
        number: i64,
    },
    /// A version, an encoding or a kind of data that is not read.
    #[error("{what} is not supported; {advice}")]
    Unsupported {
        /// What is not read.
        what: String,
        /// What to do instead.
        advice: &'static str,
    },
    /// Expanding compressed data would take more memory than the file's size allows.
    #[error("compressed data would expand beyond {limit} bytes")]
    Expansion {
        /// The limit that the declared sizes and the size of the file set.
        limit: u64,
    },
    /// The form's name, or the file's first bytes, fit no mesh file known here.
    #[error("this is no mesh file of a form known here")]
    UnknownForm,
    /// The form keeps its points in a second file that was not given.
    #[error("the points of this form stand in a {extension} file beside it, which is missing")]
    Companion {
        /// The extension of the missing file.
        extension: &'static str,
    },
}

impl ReadFault {
    /// The SPEC id of the rule broken.
    #[must_use]
    pub const fn rule(&self) -> &'static str {
        match self {
            Self::Malformed { .. } | Self::UnknownForm | Self::Companion { .. } => "X20",
            Self::Truncated { .. } => "X21",
            Self::Count { .. } | Self::Mismatch { .. } => "X22",
            Self::Number { .. } => "X23",
            Self::Duplicate { .. } => "X24",
            Self::Unsupported { .. } => "X26",
            Self::Expansion { .. } => "X29",
        }
    }
}

/// Why a mesh was not written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The form is read here but not written.
    #[error("{0} files are read but not written")]
    ReadOnly(MeshForm),
    /// The form has no such encoding.
    #[error("{form} files have no {encoding} encoding here")]
    Encoding {
        /// The form.
        form: MeshForm,
        /// The encoding asked for.
        encoding: &'static str,
    },
    /// A triangle or edge names a point that the mesh does not have.
    #[error("{item} {index} names a point that the mesh does not have, so it cannot be written")]
    BadReference {
        /// `triangle` or `edge`.
        item: &'static str,
        /// Its index, from 0.
        index: usize,
    },
    /// A list of the mesh has the wrong length.
    #[error("the mesh has {regions} region markers for {triangles} triangles")]
    Regions {
        /// Number of region markers.
        regions: usize,
        /// Number of triangles.
        triangles: usize,
    },
    /// The form cannot carry the value.
    #[error("{form} files cannot carry {what}")]
    Carry {
        /// The form.
        form: MeshForm,
        /// What it cannot carry.
        what: &'static str,
    },
    /// The output refused the bytes.
    #[error("cannot write the mesh: {0}")]
    Io(#[from] std::io::Error),
}
