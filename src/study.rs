//! The study: graded triangulation beside its rivals on eleven domains.
//!
//! The domains are dense at the boundary and sparse away from it, and made by formulas, so that a
//! study needs no input ([`domains`]). Each is meshed by six systems ([`System`]) in three settings
//! ([`Setting`]). The figures of a mesh ([`Figures`]) come from the checker, which knows nothing of
//! the mesher; statements are judged from the figures alone ([`mod@claims`]).
//!
//! ```
//! use trigrade::mesh::MeshData;
//! use trigrade::study::{DOMAINS, Detail, Setting, System, figures, mesh};
//!
//! let domain = (DOMAINS[0].make)(Detail::Small);
//! let meshed = mesh(&domain, &System::Graded.options(Setting::Own, 0))?;
//! let figures = figures(&MeshData::from(&meshed.mesh), &domain).expect("quality is measured");
//! assert!(figures.passed && figures.ratio_mean < 1.1);
//! # Ok::<(), trigrade::mesher::MeshError>(())
//! ```

pub mod chart;
pub mod claims;
mod depth;
pub mod domains;
pub mod page;
pub mod table;

pub use claims::{Claim, Outcome, claims};
pub use depth::far_over_dense;
pub use domains::{DOMAINS, Detail, StudyDomain};

use crate::check::{CheckOptions, Metric, Quality, check};
use crate::domain::Domain;
use crate::improve::ImproveOptions;
use crate::mesh::MeshData;
use crate::mesher::{
    Count, Gradation, MeshError, Meshed, Method, Options, Unobserved, mesh_domain,
};
use crate::size::Density;
use serde::Serialize;

/// A way to mesh: the systems of the report, and the default of this program first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum System {
    /// Graded, spacings limited in growth (the default).
    Graded,
    /// Graded, the report's literal field: L = a L1 + b L2 + c L3 of means over all edges.
    Literal,
    /// The literal field divided by three.
    Third,
    /// Spacings from the two edges of the initial front that the base edge's normal meets.
    Direct,
    /// Plain advancing front without a size field.
    Afm,
    /// Delaunay refinement by the area criterion.
    Delaunay,
}

impl System {
    /// All, in the order of tables.
    pub const ALL: [Self; 6] =
        [Self::Graded, Self::Literal, Self::Third, Self::Direct, Self::Afm, Self::Delaunay];

    /// Its name in tables and files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Graded => "graded",
            Self::Literal => "literal",
            Self::Third => "third",
            Self::Direct => "direct",
            Self::Afm => "afm",
            Self::Delaunay => "delaunay",
        }
    }

    /// A line for people.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Graded => "graded, growth-limited (default)",
            Self::Literal => "graded, literal field",
            Self::Third => "graded, literal field / 3",
            Self::Direct => "direct grading",
            Self::Afm => "plain advancing front (AFM)",
            Self::Delaunay => "Delaunay, area criterion",
        }
    }

    /// The flags of `trigrade mesh` that ask for it.
    #[must_use]
    pub const fn flags(self) -> &'static str {
        match self {
            Self::Graded => "",
            Self::Literal => "--gradation mean --density all-edges",
            Self::Third => "--gradation third --density all-edges",
            Self::Direct => "--method direct",
            Self::Afm => "--method afm",
            Self::Delaunay => "--method delaunay",
        }
    }

    /// The mesher's options in a setting; `target` counts where numbers are to be equal.
    #[must_use]
    pub fn options(self, setting: Setting, target: usize) -> Options {
        let own = Options::default();
        let field = |gradation| Options { gradation, density: Density::AllEdges, ..own.clone() };
        let method = |method| Options { method, ..own.clone() };
        let mut options = match self {
            Self::Graded => own,
            Self::Literal => field(Gradation::Mean),
            Self::Third => field(Gradation::Third),
            Self::Direct => method(Method::Direct),
            Self::Afm => method(Method::Afm),
            Self::Delaunay => method(Method::Delaunay),
        };
        match setting {
            Setting::Own => {}
            Setting::Raw => options.improve = ImproveOptions::NONE,
            // The plain front has no field to scale: it sets the number for the others.
            Setting::Equal if self == Self::Afm => {}
            Setting::Equal => options.count = Count::Target(target),
        }
        options
    }
}

/// What is held equal between the systems.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Setting {
    /// Nothing: as many triangles as each system asks for, improved as usual.
    Own,
    /// The same without any improvement after the triangles are laid.
    Raw,
    /// The number of triangles: each system is scaled to what the plain front makes, which has no
    /// field that could be scaled.
    Equal,
}

impl Setting {
    /// All, in the order of tables.
    pub const ALL: [Self; 3] = [Self::Own, Self::Raw, Self::Equal];

    /// A heading.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Own => "Each system's own number of triangles",
            Self::Raw => "Before any improvement (no flips, no smoothing, no repair)",
            Self::Equal => "Equal numbers of triangles",
        }
    }

    /// Its name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Own => "own",
            Self::Raw => "raw",
            Self::Equal => "equal",
        }
    }
}

/// What the checker measured on a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Triangles.
    pub triangles: usize,
    /// Points.
    pub points: usize,
    /// Mean of R/(2r).
    pub ratio_mean: f64,
    /// R/(2r) that 99 % of the triangles do not exceed.
    pub ratio_p99: f64,
    /// Largest R/(2r).
    pub ratio_max: f64,
    /// Smallest angle in degrees.
    pub angle_min_deg: f64,
    /// Ratio of areas across an edge that 99 % of the triangles do not exceed.
    pub area_ratio_p99: f64,
    /// How much longer edges are far from the dense part of the boundary, see [`far_over_dense`].
    pub far_over_dense: f64,
    /// Whether the check found nothing.
    pub passed: bool,
}

/// A line of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Name of the domain.
    pub domain: &'static str,
    /// System.
    pub system: System,
    /// Setting.
    pub setting: Setting,
    /// Triangles asked for (setting equal).
    pub target: Option<usize>,
    /// The figures; `None` where there is no mesh.
    pub figures: Option<Figures>,
    /// Why there is no mesh.
    pub reason: Option<String>,
    /// Seconds that meshing took, by the clock of the one who ran it.
    pub seconds: f64,
}

impl Row {
    /// Whether the mesh has the number of triangles that was asked for, within 5 %.
    #[must_use]
    pub fn is_on_target(&self) -> bool {
        match (self.target, &self.figures) {
            (Some(target), Some(figures)) => {
                (figures.triangles as f64 / target as f64 - 1.0).abs() <= 0.05
            }
            (target, figures) => target.is_none() && figures.is_some(),
        }
    }
}

/// Meshes a domain by a system. See [`mesh_domain`].
///
/// # Errors
/// As [`mesh_domain`].
pub fn mesh(domain: &Domain, options: &Options) -> Result<Meshed, MeshError> {
    mesh_domain(domain, options, &mut Unobserved)
}

/// Checks a mesh against its domain and takes its figures; `None` if nothing could be measured.
#[must_use]
pub fn figures(mesh: &MeshData, domain: &Domain) -> Option<Figures> {
    let report = check(mesh, Some(domain), &CheckOptions::default());
    let quality = report.quality.as_ref()?;
    let ratio = quality.summary(Metric::RadiusRatio)?;
    Some(Figures {
        triangles: mesh.triangles.len(),
        points: mesh.points.len(),
        ratio_mean: ratio.mean?,
        ratio_p99: ratio.percentile_99?,
        ratio_max: worst(quality, Metric::RadiusRatio)?,
        angle_min_deg: quality.summary(Metric::MinAngle)?.min?,
        area_ratio_p99: quality.summary(Metric::NeighbourAreaRatio)?.percentile_99?,
        far_over_dense: far_over_dense(mesh),
        passed: report.passed(),
    })
}

/// The largest value; infinite when a triangle has none.
fn worst(quality: &Quality, metric: Metric) -> Option<f64> {
    let summary = quality.summary(metric)?;
    if summary.infinite > 0 { Some(f64::INFINITY) } else { summary.max }
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: K32
    #[test]
    fn systems_differ_in_their_options_and_settings_in_what_they_hold_equal() {
        let own: Vec<Options> = System::ALL.iter().map(|s| s.options(Setting::Own, 9)).collect();
        for (i, options) in own.iter().enumerate() {
            assert!(own[..i].iter().all(|other| other != options), "{i}");
            assert_eq!(options.check(), Ok(()));
        }
        assert_eq!(own[0], Options::default(), "the first one is the default");
        let equal = System::Direct.options(Setting::Equal, 9);
        assert_eq!((equal.count, equal.method), (Count::Target(9), Method::Direct));
        assert_eq!(System::Afm.options(Setting::Equal, 9), own[4], "it sets the number");
        let raw = System::Third.options(Setting::Raw, 9);
        assert_eq!((raw.improve, raw.count), (ImproveOptions::NONE, Count::Field));
    }

    // spec: K32
    #[test]
    fn figures_are_those_of_the_checker() {
        let domain = (DOMAINS[0].make)(Detail::Small);
        let options = System::Graded.options(Setting::Own, 0);
        let meshed = mesh(&domain, &options).expect("a mesh");
        let mut data = MeshData::from(&meshed.mesh);
        let figures = figures(&data, &domain).expect("measured");
        assert!(figures.passed && figures.triangles == data.triangles.len(), "{figures:?}");
        assert!(1.0 <= figures.ratio_mean && figures.ratio_mean <= figures.ratio_p99);
        assert!(figures.ratio_p99 <= figures.ratio_max && figures.angle_min_deg < 60.0);
        data.triangles.swap_remove(5);
        let figures = super::figures(&data, &domain).expect("measured");
        assert!(!figures.passed, "a triangle is missing");
    }

    #[test]
    fn a_target_is_reached_within_five_per_cent() {
        let figures = Figures {
            triangles: 104,
            points: 60,
            ratio_mean: 1.0,
            ratio_p99: 1.0,
            ratio_max: 1.0,
            angle_min_deg: 60.0,
            area_ratio_p99: 1.0,
            far_over_dense: 1.0,
            passed: true,
        };
        let row = |target, figures| Row {
            domain: "x",
            system: System::Afm,
            setting: Setting::Equal,
            target,
            figures,
            reason: None,
            seconds: 0.0,
        };
        assert!(row(Some(100), Some(figures)).is_on_target());
        assert!(!row(Some(90), Some(figures)).is_on_target());
        assert!(!row(Some(100), None).is_on_target() && !row(None, None).is_on_target());
        assert!(row(None, Some(figures)).is_on_target());
    }
}
