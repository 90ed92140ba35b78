//! Files of points: what the Delaunay triangulation and the Voronoi tessellation start from.
//!
//! A file of points may also be a domain (Triangle's `.poly`, trigrade JSON, GeoJSON): then it is
//! read as one, segments and all. Points are handed out as the file gives them, equal ones
//! included; coordinates that are not finite are refused with their place. What is left out, a third
//! coordinate or further columns, is said in [`PointSet::left_out`].

mod csv;
mod json;
mod npy;
mod xyz;

use super::domain_file::{DomainForm, DomainReadError, ReadOptions, read_domain};
use super::error::{At, ReadError, ReadFault};
use super::node_ele;
use crate::domain::Domain;
use crate::mesh::LineIndex;
use crate::point::Point2;

/// A form of files of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PointForm {
    /// Triangle's `.node`.
    Node,
    /// Columns separated by commas, semicolons or tabs, with or without a line of names.
    Csv,
    /// Columns separated by blanks.
    Xyz,
    /// `NumPy` array of shape (n, 2) or (n, 3).
    Npy,
    /// An array of positions, `{"points": [...]}`, or a domain.
    Json,
    /// A domain.
    Domain(DomainForm),
}

impl PointForm {
    /// The extensions that name a form, for messages.
    pub const EXTENSIONS: &'static str = "node, csv, tsv, xyz, txt, npy, json, geojson, poly, dat";

    /// The form of a file with this extension, in any case.
    #[must_use]
    pub fn from_extension(extension: &str) -> Option<Self> {
        Some(match extension.to_ascii_lowercase().as_str() {
            "node" => Self::Node,
            "csv" | "tsv" => Self::Csv,
            "xyz" | "txt" => Self::Xyz,
            "npy" => Self::Npy,
            "json" => Self::Json,
            other => Self::Domain(DomainForm::from_extension(other)?),
        })
    }
}

/// Points as a file gives them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointSet {
    /// Finite points in file order, equal ones included.
    pub points: Vec<Point2>,
    /// Where each stands, in a text file of lines.
    pub lines: LineIndex,
    /// What of the file is not among the points, in words.
    pub left_out: Vec<String>,
}

/// What a file of points holds.
#[derive(Clone, Debug, PartialEq)]
pub enum PointFile {
    /// Points alone.
    Points(PointSet),
    /// Points, loops and segments.
    Domain(Box<Domain>),
}

/// Why a file of points cannot be read: the first fault and its place.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PointReadError {
    /// A file of lines or bytes.
    #[error(transparent)]
    Table(#[from] ReadError),
    /// JSON or a domain.
    #[error(transparent)]
    Domain(#[from] DomainReadError),
}

impl PointReadError {
    /// The SPEC id of the rule that the file breaks.
    #[must_use]
    pub fn rule(&self) -> &'static str {
        match self {
            Self::Table(error) => error.rule(),
            Self::Domain(error) => error.problem.id(),
        }
    }
}

/// Reads a file of points; `node` is the `.node` file beside a `.poly` file without own vertices.
///
/// # Errors
/// The first fault, with its line, byte or JSON path.
///
/// # Complexity
/// Linear in the size of the file, whatever counts it states.
pub fn read_points(
    bytes: &[u8],
    form: PointForm,
    node: Option<&[u8]>,
) -> Result<PointFile, PointReadError> {
    Ok(PointFile::Points(match form {
        PointForm::Node => read_node(bytes)?,
        PointForm::Csv => csv::read(bytes)?,
        PointForm::Xyz => xyz::read(bytes)?,
        PointForm::Npy => npy::read(bytes)?,
        PointForm::Json => return json::read(bytes),
        PointForm::Domain(form) => {
            let domain = read_domain(bytes, form, &ReadOptions { node, far_field: None })?;
            return Ok(PointFile::Domain(Box::new(domain)));
        }
    }))
}

/// Triangle's `.node` file, through its reader of meshes.
fn read_node(bytes: &[u8]) -> Result<PointSet, ReadError> {
    let mesh = node_ele::read_points(bytes)?;
    let mut set = PointSet { lines: mesh.point_lines, ..PointSet::default() };
    let mut is_flat = true;
    for (&[x, y, z], i) in mesh.points.iter().zip(0..) {
        if !(x.is_finite() && y.is_finite()) {
            return Err(not_finite([x, y], At::Line(set.lines.line(i).unwrap_or(0))));
        }
        is_flat &= z == 0.0;
        set.points.push(Point2::new(x, y));
    }
    set.left_out.extend((!is_flat).then(|| THIRD.to_owned()));
    Ok(set)
}

/// What is said of points in space.
const THIRD: &str = "the third coordinate";

/// The error that a point is not finite.
fn not_finite([x, y]: [f64; 2], at: At) -> ReadError {
    let bad = if x.is_finite() { y } else { x };
    let fault = ReadFault::Number { literal: bad.to_string(), range: "finite coordinates" };
    ReadError { file: "", at, fault }
}

#[cfg(test)]
mod tests;
