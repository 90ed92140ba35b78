//! Boundaries in the formats that other meshers read.
//!
//! Coordinates are printed so that they read back to the same bits. What a format cannot say (roles
//! of loops, a hole too thin for a hole point) is an error: nothing is quietly changed.

mod conforming;
mod geo;
mod in2d;
mod nesting;
mod poly;
mod rings;

use crate::domain::{Domain, Inside};
use crate::format::{self, MeshForm, MeshView, WriteOptions, domain_json};
use crate::mesh::{MarkedEdge, MeshData};
use conforming::conforming;

/// A format for boundaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum BoundaryForm {
    /// trigrade JSON: says everything.
    Json,
    /// Triangle's `.poly`.
    Poly,
    /// Gmsh's `.geo` script.
    Geo,
    /// Netgen's `.in2d`.
    In2d,
    /// An SVG picture with one path, to be filled by the even-odd rule.
    Svg,
    /// GeoJSON (RFC 7946).
    GeoJson,
    /// Well-known text (OGC 06-103r4).
    Wkt,
    /// Medit `.mesh` with edges and no triangles.
    Medit,
}

/// Why a boundary cannot be written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExportError {
    /// The format has no place for something.
    #[error("{form} cannot say {what}")]
    NotExpressible {
        /// The format's extension.
        form: &'static str,
        /// What it cannot say.
        what: &'static str,
    },
    /// A writer refused.
    #[error("the boundary could not be written: {0}")]
    Write(String),
}

impl BoundaryForm {
    /// Every format.
    pub const ALL: [Self; 8] = [
        Self::Json,
        Self::Poly,
        Self::Geo,
        Self::In2d,
        Self::Svg,
        Self::GeoJson,
        Self::Wkt,
        Self::Medit,
    ];

    /// Its extension, without the dot.
    #[must_use]
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::Poly => "poly",
            Self::Geo => "geo",
            Self::In2d => "in2d",
            Self::Svg => "svg",
            Self::GeoJson => "geojson",
            Self::Wkt => "wkt",
            Self::Medit => "mesh",
        }
    }

    /// The format with an extension.
    #[must_use]
    pub fn from_extension(extension: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|form| form.extension() == extension)
    }

    /// Whether a file can carry the fault that a boundary was given. Formats without roles turn
    /// a misplaced hole into an island, which is no fault.
    #[must_use]
    pub fn carries(self, fault: &str) -> bool {
        match fault {
            "D10" | "D11" | "D12" => matches!(self, Self::Json | Self::GeoJson | Self::Wkt),
            "D3" | "D7" => matches!(self, Self::Json | Self::GeoJson | Self::Wkt | Self::Svg),
            "D15" => matches!(self, Self::Json | Self::Poly),
            "D5" => !matches!(self, Self::Svg | Self::In2d),
            _ => true,
        }
    }

    fn cannot_say(self, what: &'static str) -> ExportError {
        ExportError::NotExpressible { form: self.extension(), what }
    }
}

/// Writes a boundary.
///
/// # Errors
/// [`ExportError`]: what the format cannot say.
///
/// # Complexity
/// Linear, but for formats that need to know which loop lies in which (all but JSON and
/// SVG): O(k n) for k loops with n vertices in all; Gmsh, Netgen and Medit want edges cut at the
/// vertices that lie on them: O(n^2).
pub fn export(domain: &Domain, form: BoundaryForm) -> Result<Vec<u8>, ExportError> {
    let is_carved = matches!(domain.inside, Inside::Carve(_));
    if is_carved && !matches!(form, BoundaryForm::Json | BoundaryForm::Poly) {
        return Err(form.cannot_say("which faces hole points carve"));
    }
    let mut out = Vec::new();
    match form {
        BoundaryForm::Json => domain_json::write(domain, &mut out).map_err(refused)?,
        BoundaryForm::Poly => {
            let carved = poly::carved(domain)?;
            format::poly::write(&carved, &mut out).map_err(refused)?;
        }
        BoundaryForm::Geo => out = geo::write(&conforming(domain))?.into_bytes(),
        BoundaryForm::In2d => out = in2d::write(&conforming(domain))?.into_bytes(),
        BoundaryForm::Svg => out = rings::svg(domain)?.into_bytes(),
        BoundaryForm::GeoJson => out = rings::geojson(domain)?.into_bytes(),
        BoundaryForm::Wkt => out = rings::wkt(domain)?.into_bytes(),
        BoundaryForm::Medit => out = medit(&conforming(domain))?,
    }
    Ok(out)
}

fn refused(error: impl std::fmt::Display) -> ExportError {
    ExportError::Write(error.to_string())
}

/// Edges without triangles, as mmg2d meshes them. It fills every bounded part of the plane, holes
/// too, and keeps of the boundary what is said to be required.
fn medit(domain: &Domain) -> Result<Vec<u8>, ExportError> {
    let levels = nesting::levels(domain);
    if levels.is_none_or(|levels| levels.iter().any(|level| level.depth > 0)) {
        return Err(BoundaryForm::Medit.cannot_say("holes"));
    }
    let loops = domain.loops.iter().flat_map(|l| l.edges().zip(l.markers.iter().copied()));
    let segments = domain.segments.iter().map(|s| (s.vertices, s.marker));
    let edges = loops.chain(segments).map(|(vertices, marker)| MarkedEdge { vertices, marker });
    let mesh = MeshData {
        points: domain.points.iter().map(|p| [p.x, p.y, 0.0]).collect(),
        edges: edges.collect(),
        ..MeshData::default()
    };
    let mut out = Vec::new();
    format::write_mesh(MeshView::from(&mesh), MeshForm::Medit, WriteOptions::default(), &mut out)
        .map_err(refused)?;
    out.truncate(out.trim_ascii_end().strip_suffix(b"End").map_or(out.len(), <[u8]>::len));
    for (section, count) in
        [("RequiredVertices", mesh.points.len()), ("RequiredEdges", mesh.edges.len())]
    {
        out.extend(format!("{section}\n{count}\n").bytes());
        (1..=count).for_each(|i| out.extend(format!("{i}\n").bytes()));
    }
    out.extend(b"End\n");
    Ok(out)
}

#[cfg(test)]
mod tests;
