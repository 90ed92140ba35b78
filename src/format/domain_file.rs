//! Domain files: which form a file has, reading it, and what can keep it from being read.
//!
//! A reader hands out a [`Domain`] just as the file gives it, with the place of every item, or the
//! first thing that keeps the file from being understood. Whether the domain is sound is asked by
//! [`validate`](crate::domain::validate::validate), which names all faults at once.

use super::airfoil::{self, FarField};
use super::{domain_json, geojson, poly};
use crate::curve::CurveError;
use crate::curve::discretize::DiscretizeError;
use crate::domain::{Domain, Place};
use crate::point::Point2;
use crate::surface::SurfaceError;
use std::fmt;
use std::path::Path;

/// The forms of domain files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DomainForm {
    /// Triangle's `.poly`.
    Poly,
    /// trigrade JSON, and the plain layout of outer ring, holes, segments and points.
    Json,
    /// Airfoil coordinates as the UIUC collection has them (Selig's and Lednicer's layout).
    Airfoil,
    /// GeoJSON (RFC 7946).
    GeoJson,
}

impl DomainForm {
    /// The form a file name's extension stands for (`poly`, `json`, `dat`, `geojson`), in any case.
    #[must_use]
    pub fn from_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "poly" => Some(Self::Poly),
            "json" => Some(Self::Json),
            "dat" => Some(Self::Airfoil),
            "geojson" => Some(Self::GeoJson),
            _ => None,
        }
    }

    /// The form the extension of a path stands for.
    #[must_use]
    pub fn from_path(path: &Path) -> Option<Self> {
        Self::from_extension(path.extension()?.to_str()?)
    }

    /// The form that the content looks like: text that starts with a brace is JSON (whose reader
    /// also takes GeoJSON), a first line of three or four integers of which the second is 2 starts
    /// a `.poly` file, other text is an airfoil. A guess from the first lines; the reader decides.
    #[must_use]
    pub fn sniff(bytes: &[u8]) -> Self {
        let first = TextLines::new(bytes).find(|(_, line)| !line.starts_with('#'));
        let text = first.map(|(_, line)| line).unwrap_or_default();
        if text.starts_with(['{', '[']) {
            return Self::Json;
        }
        let header: Option<Vec<i64>> = text.split_whitespace().map(|t| t.parse().ok()).collect();
        match header.as_deref() {
            Some([_, 2, _] | [_, 2, _, _]) => Self::Poly,
            _ => Self::Airfoil,
        }
    }
}

/// What readers need besides the file.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReadOptions<'a> {
    /// The `.node` file beside a `.poly` file, for one whose own list of vertices is empty. Readers
    /// do no input or output: on [`Problem::NodesElsewhere`] read that file and call again.
    pub node: Option<&'a [u8]>,
    /// A circle around an airfoil, which makes the air the domain; without it the airfoil is.
    pub far_field: Option<FarField>,
}

/// Reads a domain file of the given form. [`DomainForm::Json`] also takes GeoJSON.
///
/// # Errors
/// The first thing that keeps the file from being understood, with its line or JSON path. Memory
/// and time are bounded by a multiple of the file's size, whatever numbers it states.
///
/// ```
/// use trigrade::format::domain_file::{DomainForm, ReadOptions, read_domain};
/// let json = br#"{"outer": [[0, 0], [4, 0], [4, 4], [0, 4]], "holes": [[[1, 1], [2, 1], [1, 2]]]}"#;
/// let domain = read_domain(json, DomainForm::Json, &ReadOptions::default())?;
/// assert_eq!(domain.loops.len(), 2);
/// # Ok::<(), trigrade::format::domain_file::DomainReadError>(())
/// ```
pub fn read_domain(
    bytes: &[u8],
    form: DomainForm,
    options: &ReadOptions,
) -> Result<Domain, DomainReadError> {
    match form {
        DomainForm::Poly => poly::read(bytes, options.node),
        DomainForm::Json => domain_json::read(bytes),
        DomainForm::Airfoil => airfoil::read(bytes, options.far_field),
        DomainForm::GeoJson => geojson::read(bytes),
    }
}

/// Why a domain file cannot be read, and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{problem}", Lead(place))]
pub struct DomainReadError {
    /// The line or JSON path; [`Place::Made`] when it is the file as a whole.
    pub place: Place,
    /// What is wrong there.
    pub problem: Problem,
}

/// What is wrong with a domain file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Problem {
    /// The file is not JSON.
    #[error("this is not JSON: {0}")]
    Json(String),
    /// The file is JSON, but not GeoJSON.
    #[error("this is not GeoJSON: {0}")]
    GeoJson(String),
    /// Something else was expected.
    #[error("expected {what}, found {found}")]
    Expected {
        /// What was expected.
        what: &'static str,
        /// What the file has.
        found: String,
    },
    /// A number is NaN, infinite or too large for a double.
    #[error("'{0}' is not a finite number of double precision")]
    NotFinite(String),
    /// A number with a decimal comma.
    #[error(
        "'{0}' is not a number: write a decimal point, not a comma, and blanks between numbers"
    )]
    DecimalComma(String),
    /// An integer is out of its range.
    #[error("{what} is {found}, but must be between {low} and {high}")]
    OutOfRange {
        /// What the integer is.
        what: &'static str,
        /// The integer as the file has it.
        found: String,
        /// The least that would do.
        low: i64,
        /// The greatest that would do.
        high: i64,
    },
    /// The file ends before all items it announces.
    #[error("the file announces {stated} {what}, but ends after {found}")]
    Truncated {
        /// The items.
        what: &'static str,
        /// How many are announced.
        stated: u64,
        /// How many there are.
        found: u64,
    },
    /// A list has another length than it must have.
    #[error("there are {found} {what}, but there must be {expected}")]
    Length {
        /// The items.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// A key the format does not have.
    #[error("unknown key '{0}'")]
    UnknownKey(String),
    /// A key that must be there is not.
    #[error("the key '{0}' is missing")]
    MissingKey(&'static str),
    /// Two things exclude each other.
    #[error("{0} and {1} exclude each other")]
    Excluded(&'static str, &'static str),
    /// A GeoJSON ring does not end where it starts.
    #[error("a ring must end with its first position, {first}, but ends with {last}")]
    NotClosed {
        /// The first position.
        first: Point2,
        /// The last one.
        last: Point2,
    },
    /// The vertices of a `.poly` file stand in the `.node` file beside it, which is not given.
    #[error("the file has no vertices of its own, and there is no .node file beside it")]
    NodesElsewhere,
    /// An option of the reader makes no sense.
    #[error("{0}")]
    Option(&'static str),
    /// Numbers that make no curve.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// A curve cannot be cut into edges as asked.
    #[error(transparent)]
    Nodes(#[from] DiscretizeError),
    /// Numbers that make no surface.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The curves of a loop do not meet.
    #[error("the curve starts {gap:e} from where the one before it ends: {from:?} against {to:?}")]
    Joint {
        /// The distance.
        gap: f64,
        /// Where the curve before it ends.
        from: [f64; 3],
        /// Where the curve starts.
        to: [f64; 3],
    },
    /// An entity of an IGES file that is not read, or makes no sense.
    #[error("{0}")]
    Entity(String),
    /// A record of a STEP file that is not read, or makes no sense.
    #[error("{0}")]
    Step(String),
    /// A name that the file does not define, or defines twice.
    #[error("{0}")]
    Name(String),
}

impl Problem {
    /// The id of the broken rule in SPEC 13.
    #[must_use]
    pub fn id(&self) -> &'static str {
        match self {
            Self::Json(_) | Self::GeoJson(_) => "X1",
            Self::NotFinite(_) | Self::DecimalComma(_) => "X2",
            Self::Truncated { .. } | Self::Length { .. } | Self::NodesElsewhere => "X3",
            Self::Expected { .. } | Self::MissingKey(_) => "X4",
            Self::OutOfRange { .. } => "X5",
            Self::UnknownKey(_) | Self::Excluded(..) => "X6",
            Self::NotClosed { .. } => "X7",
            Self::Option(_) => "X8",
            Self::Curve(_) => "S1",
            Self::Nodes(_) => "S2",
            Self::Surface(_) => "S3",
            Self::Joint { .. } => "S5",
            Self::Entity(_) => "X66",
            Self::Step(_) => "X73",
            Self::Name(_) => "S7",
        }
    }

    /// This problem in a place.
    pub(super) fn at(self, place: Place) -> DomainReadError {
        DomainReadError { place, problem: self }
    }
}

/// A place in front of a message.
struct Lead<'a>(&'a Place);

impl fmt::Display for Lead<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Place::Made => Ok(()),
            place => write!(f, "{place}: "),
        }
    }
}

/// The start of what a file has in some place, short enough for a message.
pub(super) fn excerpt(text: &str) -> String {
    const LONGEST: usize = 40;
    let printable = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let mut start: String = text.chars().take(LONGEST).map(printable).collect();
    if text.chars().nth(LONGEST).is_some() {
        start.push_str("...");
    }
    start
}

/// The lines of a text file that say something: without the byte order mark, line ends (`\n` or
/// `\r\n`), blanks at both ends, and empty lines; numbered from 1. Bytes that are no UTF-8 become
/// replacement characters: they may stand in names and comments, and are no part of a number.
#[derive(Clone)]
pub(super) struct TextLines<'a> {
    lines: std::slice::Split<'a, u8, fn(&u8) -> bool>,
    number: u64,
}

impl<'a> TextLines<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let is_end: fn(&u8) -> bool = |&byte| byte == b'\n';
        Self { lines: without_mark(bytes).split(is_end), number: 0 }
    }

    /// The number of the last line looked at.
    pub(super) fn number(&self) -> u64 {
        self.number
    }
}

impl<'a> Iterator for TextLines<'a> {
    type Item = (u64, std::borrow::Cow<'a, str>);

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let line = self.lines.next()?;
            self.number += 1;
            let line = line.trim_ascii();
            if !line.is_empty() {
                return Some((self.number, String::from_utf8_lossy(line)));
            }
        }
    }
}

/// The file without a UTF-8 byte order mark.
pub(super) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

/// A finite number from a token of a text file.
pub(super) fn number(token: &str, what: &'static str) -> Result<f64, Problem> {
    match token.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(Problem::NotFinite(excerpt(token))),
        Err(_) if token.contains(',') && token.replace(',', ".").parse::<f64>().is_ok() => {
            Err(Problem::DecimalComma(excerpt(token)))
        }
        Err(_) => Err(Problem::Expected { what, found: format!("'{}'", excerpt(token)) }),
    }
}
