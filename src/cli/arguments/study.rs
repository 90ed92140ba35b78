//! The flags of `trigrade study` and `trigrade compare`.

use super::{Against, MeshReading};
use crate::study::{DOMAINS, Detail};
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum, ValueHint};
use std::path::PathBuf;

/// `trigrade study`
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  trigrade study --out study
  trigrade study --out airfoil --domain airfoil --size small
Exit codes: 0 every mesh passed its check, 1 one did not, 2 the folder could not be written.")]
pub struct StudyArguments {
    /// The folder that everything goes to: report.html, study.csv, study.json, the domains and
    /// their pictures.
    #[arg(long, short, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
    /// Only this domain; repeatable.
    #[arg(long, value_name = "NAME", value_parser = domain_names())]
    pub domain: Vec<String>,
    /// How many boundary points the domains have.
    #[arg(long, value_enum, default_value_t = StudySize::Full)]
    pub size: StudySize,
}

fn domain_names() -> PossibleValuesParser {
    PossibleValuesParser::new(DOMAINS.iter().map(|domain| domain.name))
}

/// `--size`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StudySize {
    /// About a quarter of the points: a second or two.
    Small,
    /// All of them.
    Full,
}

impl StudySize {
    /// The same in the library's terms.
    #[must_use]
    pub const fn detail(self) -> Detail {
        match self {
            Self::Small => Detail::Small,
            Self::Full => Detail::Full,
        }
    }
}

/// `trigrade compare`
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  trigrade compare old.msh new.msh
  trigrade compare ours.msh theirs.vtu --domain wing.poly -o both.html -o both.png
  trigrade compare a.off b.off --window -0.2,-0.3,1.2,0.3 -o close.svg
Exit codes: 0 compared, 1 a mesh fails its check, 2 a file could not be read or written.")]
pub struct CompareArguments {
    /// The first mesh.
    #[arg(value_name = "A", value_hint = ValueHint::FilePath)]
    pub a: PathBuf,
    /// The second mesh.
    #[arg(value_name = "B", value_hint = ValueHint::FilePath)]
    pub b: PathBuf,
    /// How both are read.
    #[command(flatten)]
    pub reading: MeshReading,
    /// What both must cover.
    #[command(flatten)]
    pub against: Against,
    /// Both side by side at one scale, and their histograms: .svg, .png or .html, which has the
    /// table too; repeatable.
    #[arg(long = "output", short, value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub outputs: Vec<PathBuf>,
    /// Draw only this part of the plane.
    #[arg(long, value_name = "X0,Y0,X1,Y1", allow_hyphen_values = true)]
    pub window: Option<crate::draw::View>,
    /// Width of the picture in pixels.
    #[arg(long, value_name = "PIXELS", default_value_t = 1400)]
    #[arg(value_parser = clap::value_parser!(u32).range(200..=20_000))]
    pub width: u32,
}
