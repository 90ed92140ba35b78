//! What can be said on the command line: one definition per flag feeds `-h`, `--help`, the manual
//! page, the completions and the tests.

mod plot;
mod remesh;
mod study;

pub use plot::{Colour, PlotArguments};
pub use remesh::RemeshArguments;
pub use study::{CompareArguments, StudyArguments, StudySize};

use super::words::did_you_mean;
use crate::check::report::Form;
use crate::check::{CheckOptions, Gate, Id, Metric};
use crate::delaunay::Engine;
use crate::improve::ImproveOptions;
use crate::point::Point2;
use crate::size::{Expression, SizeSource};
use crate::{front, mesher, size};
use clap::{ArgAction, Args, Parser, Subcommand, ValueEnum, ValueHint};
use std::path::PathBuf;
use std::time::Duration;

const EXIT_CODES: &str = "\
Exit codes:
  0  done, and every check holds
  1  findings: an invalid domain, a mesh that fails its check, a gate missed
  2  could not run: usage, files, malformed input, a limit
  130  interrupted; nothing half-written is left

Every complaint names the rule it applies; `trigrade explain ID` prints that rule.";

/// Graded triangulation with exact predicates, and an exact check of anybody's mesh.
#[derive(Clone, Debug, Parser)]
#[command(name = "trigrade", version, after_help = EXIT_CODES, max_term_width = 100)]
#[command(subcommand_required = true, arg_required_else_help = true)]
pub struct Arguments {
    /// Flags that every verb takes.
    #[command(flatten)]
    pub global: Global,
    /// What to do.
    #[command(subcommand)]
    pub verb: Verb,
}

/// Flags that every verb takes.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Everywhere")]
pub struct Global {
    /// Print nothing but errors.
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// Print the report as JSON on standard output, and nothing else there.
    #[arg(long, global = true)]
    pub json: bool,
    /// Write a report, repeatable: KIND is text, json, junit, sarif, github, github-summary, gitlab
    /// or tap, FILE may be `-`.
    #[arg(long, global = true, value_name = "KIND=FILE", value_parser = parse_report)]
    pub report: Vec<ReportTarget>,
    /// Worker threads; the answer is the same for any number.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Print more: the time of each stage, what was left out.
    #[arg(long, short, global = true, action = ArgAction::Count)]
    pub verbose: u8,
}

/// The verbs.
#[derive(Clone, Debug, Subcommand)]
pub enum Verb {
    /// Mesh a plane domain; the mesh is checked before it is handed out.
    Mesh(Box<MeshArguments>),
    /// Check a mesh exactly, anybody's mesh, with or without its domain.
    Check(Box<CheckArguments>),
    /// Remesh a triangulated surface: edges of a wanted length, features kept.
    Remesh(RemeshArguments),
    /// Triangulate points, or points and segments, by Delaunay's criterion.
    Delaunay(Box<DelaunayArguments>),
    /// Tessellate the plane by the nearest of some points.
    Voronoi(VoronoiArguments),
    /// Mesh the NACA 0012 airfoil by three methods and leave meshes, pictures and a report.
    Demo(DemoArguments),
    /// Print the rule behind an id such as D4 or M3; without an id, list all rules.
    Explain(ExplainArguments),
    /// Convert a mesh between formats, bit for bit where the formats allow it.
    Convert(ConvertArguments),
    /// Draw a mesh as SVG or PNG, or as an HTML viewer; with --domain, what `check` finds is marked.
    Plot(PlotArguments),
    /// Torture any mesher with adversarial boundaries, and shrink what it gets wrong.
    Torture(Box<TortureArguments>),
    /// Compare two meshes: every metric, histograms, both side by side.
    Compare(Box<CompareArguments>),
    /// Set graded triangulation beside its rivals on eleven domains.
    Study(StudyArguments),
    /// Print the completion script of a shell.
    Completions(CompletionsArguments),
    /// Print the manual page (roff).
    Man,
}

/// `trigrade mesh`
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  trigrade mesh wing.poly -o wing.msh -o wing.svg
  trigrade mesh naca.dat --farfield 15,60 -o naca.vtu
  trigrade mesh lake.poly --method delaunay --min-angle 25 --split-boundary -o lake.msh
  trigrade mesh - --from poly --form off -o - < wing.poly > wing.off
  trigrade mesh wing.poly --method afm --dry-run
  trigrade mesh vase.json --spacing 0.05 -o vase.stl -o vase.msh")]
pub struct MeshArguments {
    /// The domain: .poly, .json, .geojson or an airfoil .dat; or a surface model, .json, .bpt or .igs;
    /// `-` is standard input.
    #[arg(value_name = "DOMAIN", value_hint = ValueHint::FilePath)]
    pub domain: PathBuf,
    /// Where the mesh goes; the extension names the form, `-` is standard output; repeatable.
    #[arg(long = "output", short, value_name = "OUT", value_hint = ValueHint::FilePath)]
    #[arg(required_unless_present = "dry_run")]
    pub outputs: Vec<PathBuf>,
    /// Form of the outputs, whatever their extension (needed for `-o -`); `msh-binary` and
    /// `vtu-compressed` name encodings too.
    #[arg(long, value_name = "FORM")]
    pub form: Option<String>,
    /// How the domain is read.
    #[command(flatten)]
    pub reading: DomainReading,
    /// What is built.
    #[command(flatten)]
    pub options: MeshOptions,
    /// What is built on a surface.
    #[command(flatten)]
    pub on_surface: SurfaceFlags,
    /// Print the predicted number of triangles and stop.
    #[arg(long)]
    pub dry_run: bool,
    /// Hand the mesh out without reading it back and checking it.
    #[arg(long)]
    pub no_check: bool,
    /// Print the time of each stage.
    #[arg(long)]
    pub timings: bool,
    /// Write what was checked, on which bytes, and the answer.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "no_check")]
    pub certificate: Option<PathBuf>,
}

/// How a mesh file is read.
#[derive(Clone, Debug, Default, Args)]
pub struct MeshReading {
    /// Form of the mesh, whatever its extension (needed for `-`).
    #[arg(long, value_name = "FORM")]
    pub from: Option<String>,
    /// Split each quadrilateral into two triangles; without it they are counted and left out.
    #[arg(long)]
    pub split_quads: bool,
}

/// How a domain file is read.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Domain")]
pub struct DomainReading {
    /// Form of the domain, whatever its extension: poly, json, geojson, dat, or model.
    #[arg(long, value_name = "FORM")]
    pub from: Option<String>,
    /// Far-field circle around an airfoil: its radius in chords and its number of points.
    #[arg(long, value_name = "RADIUS,POINTS", value_parser = parse_farfield)]
    pub farfield: Option<Farfield>,
}

/// The domain that a mesh is set against.
#[derive(Clone, Debug, Default, Args)]
pub struct Against {
    /// The domain that the mesh must cover, its boundary preserved.
    #[arg(long, value_name = "DOMAIN", value_hint = ValueHint::FilePath)]
    pub domain: Option<PathBuf>,
    /// Form of the domain, whatever its extension.
    #[arg(long, value_name = "FORM", requires = "domain")]
    pub domain_from: Option<String>,
    /// Far-field circle, as it was given to `mesh`.
    #[arg(long, value_name = "RADIUS,POINTS", value_parser = parse_farfield, requires = "domain")]
    pub farfield: Option<Farfield>,
}

impl Against {
    /// How the domain is read.
    #[must_use]
    pub fn reading(&self) -> DomainReading {
        DomainReading { from: self.domain_from.clone(), farfield: self.farfield }
    }
}

/// What the mesher is asked to do.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Meshing")]
pub struct MeshOptions {
    /// How triangles are laid.
    #[arg(long, value_enum, default_value_t = Method::Graded)]
    pub method: Method,
    /// Spacing at the boundary nodes.
    #[arg(long, value_enum, default_value_t = Density::BoundaryEdges)]
    pub density: Density,
    /// How spacing spreads from the boundary into the domain: growth, mean, third, uniform, or an
    /// expression such as `a*L1 + b*L2 + c*L3` of a, b, c, L1, L2, L3, x, y and H, the growth field
    /// (with `--method direct` of D1, D2, L1, L2, x, y and H); on surface models an expression of x, y,
    /// z, the principal curvatures k1 and k2, the area element J of the patch, and H, the spacing.
    #[arg(long, value_name = "NAME|EXPR", default_value = "growth", value_parser = parse_gradation)]
    #[arg(allow_hyphen_values = true)]
    pub gradation: mesher::Gradation,
    /// Largest slope of the spacing: of gradation growth, from sources, and with --limit-growth.
    #[arg(long, value_name = "SLOPE", default_value_t = 0.25, value_parser = parse_positive)]
    pub growth: f64,
    /// Limit the slope of any gradation, from the boundary's own spacing on.
    #[arg(long)]
    pub limit_growth: bool,
    /// Keep the spacing within [b/K, K b] of the base edge's length b.
    #[arg(long, value_name = "K", default_value_t = 1.5, value_parser = parse_clamp)]
    pub clamp: f64,
    /// Largest spacing anywhere; for `--gradation uniform` the spacing, else the mean boundary edge.
    #[arg(long, value_name = "LENGTH", value_parser = parse_positive)]
    pub spacing: Option<f64>,
    /// Spacing at the edges with a marker, growing from there; repeatable.
    #[arg(long, value_name = "MARKER=LENGTH", value_parser = parse_spacing_at)]
    #[arg(allow_hyphen_values = true)]
    pub spacing_at: Vec<(i32, f64)>,
    /// Spacing H at a point, within R of it, or along a line, growing from there; repeatable.
    #[arg(long, value_name = "X,Y,H[,R]|X1,Y1,X2,Y2,H", value_parser = parse_source)]
    #[arg(allow_hyphen_values = true)]
    pub source: Vec<SizeSource>,
    /// A background mesh with a spacing at each node: .msh with $NodeData, .pos, or .vtu.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub size_field: Option<PathBuf>,
    /// Which front edge goes first.
    #[arg(long, value_enum, default_value_t = Order::Depth)]
    pub order: Order,
    /// The angle rules of the front: candidates that are scored, or hard decisions.
    #[arg(long, value_enum, default_value_t = Rules::Scored)]
    pub rules: Rules,
    /// Refuse, before any work, to make more triangles than this.
    #[arg(long, value_name = "COUNT", default_value_t = 20_000_000)]
    pub max_triangles: u32,
    /// Largest area with `--method delaunay`: a number, `none`, or `field` for the equilateral
    /// triangle of the spacing there (the default, but `none` with --min-angle).
    #[arg(long, value_name = "AREA", value_parser = parse_max_area)]
    pub max_area: Option<mesher::AreaMax>,
    /// Least angle with `--method delaunay`, in degrees up to 34; where the boundary stands in the
    /// way, see --split-boundary.
    #[arg(long, value_name = "DEGREES", value_parser = parse_positive)]
    pub min_angle: Option<f64>,
    /// The four corners of a structured grid: vertices of the boundary, counted from 0 in the file's
    /// order; without it the four sharpest.
    #[arg(long, value_name = "I,J,K,L", value_parser = parse_corners)]
    pub corners: Option<[u32; 4]>,
    /// Write the cells of a structured grid as quadrilaterals (.msh, .vtu, .vtk, .off, .obj, .su2).
    #[arg(long)]
    pub quads: bool,
    /// Allow new points on the boundary and on constraints: where --min-angle demands them, and
    /// with the other methods where the spacing jumps or a gap is narrow.
    #[arg(long)]
    pub split_boundary: bool,
    /// Take a coarser field where the field asks for more than --max-triangles.
    #[arg(long, conflicts_with = "target")]
    pub coarsen: bool,
    /// Make about this many triangles: the field becomes coarser or finer until they come out.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..))]
    pub target: Option<u32>,
    /// Effort after the front: 0 smooths, 1 also repairs the worst places, 2 all defects of the
    /// lattice it can, 3 until nothing gets better; each some ten times as long as the one before.
    #[arg(long, value_name = "LEVEL", default_value_t = 1)]
    #[arg(value_parser = clap::value_parser!(u8).range(0..=3))]
    pub optimize: u8,
    /// Leave out all improvement after the front.
    #[arg(long, conflicts_with = "optimize")]
    pub no_improve: bool,
}

impl MeshOptions {
    /// The same in the library's terms.
    #[must_use]
    pub fn options(&self) -> mesher::Options {
        let defaults = mesher::Options::default();
        mesher::Options {
            method: match self.method {
                Method::Graded => mesher::Method::Graded,
                Method::Afm => mesher::Method::Afm,
                Method::Direct => mesher::Method::Direct,
                Method::DelaunayInitial => mesher::Method::DelaunayInitial,
                Method::Delaunay => mesher::Method::Delaunay,
                Method::Transfinite => mesher::Method::Transfinite,
                Method::Elliptic => mesher::Method::Elliptic,
                // Refused for plane domains, and asked for by its own option for models.
                Method::DirectSurface => mesher::Method::Graded,
            },
            density: match self.density {
                Density::AllEdges => size::Density::AllEdges,
                Density::BoundaryEdges => size::Density::BoundaryEdges,
            },
            gradation: self.gradation.clone(),
            growth: self.growth,
            clamp: self.clamp,
            limit_growth: self.limit_growth,
            spacing: self.spacing,
            spacing_at: self.spacing_at.clone(),
            sources: self.source.clone(),
            count: match self.target {
                Some(target) => mesher::Count::Target(target as usize),
                None if self.coarsen => mesher::Count::Coarsen,
                None => mesher::Count::Field,
            },
            order: match self.order {
                Order::Depth => front::Order::Depth,
                Order::Shortest => front::Order::Shortest,
            },
            rules: match self.rules {
                Rules::Scored => front::Rules::Scored,
                Rules::Hard => front::Rules::Hard,
            },
            triangles_max: self.max_triangles as usize,
            improve: match self.no_improve {
                true => ImproveOptions::NONE,
                false => ImproveOptions::level(self.optimize),
            },
            area_max: self.max_area.unwrap_or(match self.min_angle {
                Some(_) => mesher::AreaMax::Unbounded,
                None => mesher::AreaMax::Field,
            }),
            angle_min_deg: self.min_angle.unwrap_or(0.0),
            split_boundary: self.split_boundary,
            corners: self.corners,
            ..defaults
        }
    }

    /// A flag that the method does not heed.
    #[must_use]
    pub fn idle_flag(&self) -> Option<&'static str> {
        let is_refined = self.method == Method::Delaunay;
        match (self.max_area, self.min_angle) {
            (Some(_), _) if !is_refined => Some("--max-area"),
            (_, Some(_)) if !is_refined => Some("--min-angle"),
            _ => None,
        }
    }
}

/// What the mesher is asked to do on a surface model.
#[derive(Clone, Copy, Debug, Default, Args)]
#[command(next_help_heading = "Surface models")]
pub struct SurfaceFlags {
    /// Largest distance of a triangle from the surface: edges are shorter where it bends.
    #[arg(long, value_name = "LENGTH", value_parser = parse_positive)]
    pub chord_error: Option<f64>,
    /// Largest turn of the surface's normal along an edge, in degrees.
    #[arg(long, value_name = "DEGREES", value_parser = parse_positive)]
    pub angle_per_edge: Option<f64>,
    /// Make curves one that trim patches and agree within this, as the edges of neighbouring faces of
    /// IGES files do; corners likewise.
    #[arg(long, value_name = "LENGTH", value_parser = parse_positive)]
    pub weld: Option<f64>,
}

/// `--method`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// Advancing front with the size field of the background triangulation.
    Graded,
    /// Plain advancing front: equilateral on the base edge, no size field.
    Afm,
    /// Spacing from the two boundary edges that the base edge's normal meets.
    Direct,
    /// The constrained Delaunay triangulation of the boundary alone.
    DelaunayInitial,
    /// The same refined until areas and angles are within their bounds.
    Delaunay,
    /// Structured grid of a four-sided domain or patches: transfinite interpolation of the sides.
    Transfinite,
    /// The same, smoothed by the inverse Laplace equations.
    Elliptic,
    /// Surface models: the front advances in space, new points are brought back to the surface.
    DirectSurface,
}

/// `--density`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Density {
    /// Mean length of all background edges at the node.
    AllEdges,
    /// Mean length of the boundary edges at the node.
    BoundaryEdges,
}

/// `--order`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Order {
    /// Nearest to the boundary first.
    Depth,
    /// Shortest first.
    Shortest,
}

/// `--rules`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Rules {
    /// Every rule offers a candidate; the best one is taken.
    Scored,
    /// The angle decides.
    Hard,
}

/// A file of points.
#[derive(Clone, Debug, Args)]
pub struct PointInput {
    /// The points: .node, .csv, .xyz, .npy, .json, .geojson or .poly; `-` is standard input.
    #[arg(value_name = "POINTS", value_hint = ValueHint::FilePath)]
    pub points: PathBuf,
    /// Form of the points, whatever their extension (needed for `-`).
    #[arg(long, value_name = "FORM")]
    pub from: Option<String>,
}

/// `trigrade delaunay`
#[derive(Clone, Debug, Args)]
#[command(
    after_help = "\
Examples:
  trigrade delaunay cloud.csv -o cloud.off -o cloud.svg
  trigrade delaunay cloud.npy --engine sweep --check -o cloud.vtu
  trigrade delaunay terrain.poly --hull --split-crossings -o terrain.msh
  trigrade delaunay - --from xyz -o - --form json < cloud.xyz > cloud.json",
    after_long_help = "\
The answer is unique (SPEC 5): any engine, any order of the points and any number of threads give
the same triangles; cocircular points are no exception. Equal points are merged into the first of
them; --map says what became of each point.

A file with loops or segments (.poly, .json, .geojson, .dat) is triangulated with them as
constraints, and what the domain's own rule calls outside is removed; --hull keeps it,
--unconstrained uses the points alone. Segments that cross are an error that names both;
--split-crossings cuts them where they cross, at points rounded to doubles.

Fewer than three different points, or points on one line, have no triangles: the outputs then hold
the points alone.

Examples:
  trigrade delaunay cloud.csv -o cloud.off -o cloud.svg
  trigrade delaunay cloud.npy --engine sweep --check -o cloud.vtu
  trigrade delaunay terrain.poly --hull --split-crossings -o terrain.msh
  trigrade delaunay - --from xyz -o - --form json < cloud.xyz > cloud.json"
)]
pub struct DelaunayArguments {
    /// What is read.
    #[command(flatten)]
    pub input: PointInput,
    /// Where the mesh goes: .off, .msh, .json, .svg, ...; `-` is standard output; repeatable.
    #[arg(long = "output", short, value_name = "OUT", value_hint = ValueHint::FilePath)]
    #[arg(required = true)]
    pub outputs: Vec<PathBuf>,
    /// Form of the outputs, whatever their extension (needed for `-o -`).
    #[arg(long, value_name = "FORM")]
    pub form: Option<String>,
    /// The algorithm; all give the same triangles.
    #[arg(long, value_enum, default_value_t = EngineName::Auto)]
    pub engine: EngineName,
    /// With segments: cover the hull of the points, outside and holes too.
    #[arg(long, conflicts_with = "unconstrained")]
    pub hull: bool,
    /// With segments: cut those that cross at their rounded crossings.
    #[arg(long, conflicts_with = "unconstrained")]
    pub split_crossings: bool,
    /// Use the points of the file alone, no loops and no segments.
    #[arg(long)]
    pub unconstrained: bool,
    /// Write what became of each point, as JSON.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub map: Option<PathBuf>,
    /// Read the mesh back and let `check` judge it: coverage, every point, every circle.
    #[arg(long)]
    pub check: bool,
    /// Print the time of each stage.
    #[arg(long)]
    pub timings: bool,
}

/// `trigrade voronoi`
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  trigrade voronoi stations.csv -o cells.json
  trigrade voronoi stations.csv --clip box -o cells.obj -o cells.svg
  trigrade voronoi stations.csv --clip 0,0,100,50 -o cells.png
  trigrade voronoi stations.csv --clip country.geojson -o cells.json
Places are rounded once to doubles; which cells and edges there are is exact (SPEC 17).")]
pub struct VoronoiArguments {
    /// What is read.
    #[command(flatten)]
    pub input: PointInput,
    /// Where it goes: .json, .obj, .svg or .png; `-` is standard output; repeatable.
    #[arg(long = "output", short, value_name = "OUT", value_hint = ValueHint::FilePath)]
    #[arg(required = true)]
    pub outputs: Vec<PathBuf>,
    /// Form of the outputs, whatever their extension (needed for `-o -`).
    #[arg(long, value_name = "FORM")]
    pub form: Option<String>,
    /// Clip the cells: `box` around the points, XMIN,YMIN,XMAX,YMAX, or a domain file.
    #[arg(long, value_name = "box|X0,Y0,X1,Y1|DOMAIN", allow_hyphen_values = true)]
    pub clip: Option<String>,
    /// Form of the domain to clip to, whatever its extension.
    #[arg(long, value_name = "FORM", requires = "clip")]
    pub clip_from: Option<String>,
    /// Print the time of each stage.
    #[arg(long)]
    pub timings: bool,
}

impl VoronoiArguments {
    /// How the domain to clip to is read.
    #[must_use]
    pub fn clip_reading(&self) -> DomainReading {
        DomainReading { from: self.clip_from.clone(), farfield: None }
    }
}

/// `--engine`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum EngineName {
    /// The fastest: divide and conquer over a Morton curve; segments are forced one by one.
    Auto,
    /// Insertion by cavities (Watson 1981).
    Watson,
    /// Insertion by flips (Lawson 1977).
    Lawson,
    /// Triangle by triangle with a uniform grid (Fang and Piegl 1993).
    FangPiegl,
    /// Divide and conquer (Guibas and Stolfi 1985); with segments too.
    DivideConquer,
    /// Sweep line (Fortune 1987).
    Sweep,
}

impl EngineName {
    /// The same in the library's terms.
    #[must_use]
    pub const fn engine(self) -> Engine {
        match self {
            Self::Auto => Engine::Auto,
            Self::Watson => Engine::Watson,
            Self::Lawson => Engine::Lawson,
            Self::FangPiegl => Engine::FangPiegl,
            Self::DivideConquer => Engine::DivideConquer,
            Self::Sweep => Engine::Sweep,
        }
    }
}

/// `trigrade check`
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  trigrade check wing.msh --domain wing.poly
  trigrade check wing.off --max-aspect 3 --gate 'min_angle >= 25 @ 99%' --json
  trigrade check wing.msh --gates gates.toml --report junit=out.xml --picture findings.html
  trigrade check - --from off < wing.off")]
pub struct CheckArguments {
    /// The mesh; `-` is standard input.
    #[arg(value_name = "MESH", value_hint = ValueHint::FilePath)]
    pub mesh: PathBuf,
    /// How the mesh is read.
    #[command(flatten)]
    pub reading: MeshReading,
    /// What it must cover.
    #[command(flatten)]
    pub against: Against,
    /// The surface model that the mesh must be a mesh of.
    #[arg(long, value_name = "MODEL", value_hint = ValueHint::FilePath, conflicts_with = "domain")]
    pub surface: Option<PathBuf>,
    /// No triangle may be farther from the surface than this.
    #[arg(long, value_name = "LENGTH", value_parser = parse_positive, requires = "surface")]
    pub chord_error: Option<f64>,
    /// No triangle's normal may be off the surface's by more than this, in degrees.
    #[arg(long, value_name = "DEGREES", value_parser = parse_positive, requires = "surface")]
    pub normal_deviation: Option<f64>,
    /// Curves of the model that agree within this are one, as they were for `mesh`.
    #[arg(long, value_name = "LENGTH", value_parser = parse_positive, requires = "surface")]
    pub weld: Option<f64>,
    /// What is demanded.
    #[command(flatten)]
    pub demands: Demands,
    /// Measure edge lengths against a size field: .msh with $NodeData, .pos, or .vtu.
    #[arg(long, value_name = "FIELD", value_hint = ValueHint::FilePath)]
    pub size: Option<PathBuf>,
    /// Write the quality of this mesh, for a later --baseline.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub save_baseline: Option<PathBuf>,
    /// Draw the mesh with its findings; .svg, .png or .html (a viewer); repeatable.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub picture: Vec<PathBuf>,
    /// Write what was checked, on which bytes, and the answer.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub certificate: Option<PathBuf>,
    /// Check again what a certificate says, on the files given.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub verify_certificate: Option<PathBuf>,
    /// Say how long reading and checking took.
    #[arg(long)]
    pub timings: bool,
}

/// What is demanded of a mesh beyond conformity.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Demands")]
pub struct Demands {
    /// No triangle's R/(2r) may be above this.
    #[arg(long, value_name = "RATIO", value_parser = parse_clamp)]
    pub max_aspect: Option<f64>,
    /// No angle may be below this, in degrees.
    #[arg(long, value_name = "DEGREES", value_parser = parse_positive)]
    pub min_angle: Option<f64>,
    /// No two neighbours' areas may differ by more than this factor.
    #[arg(long, value_name = "FACTOR", value_parser = parse_clamp)]
    pub max_area_ratio: Option<f64>,
    /// Any metric: `radius_ratio <= 3 @ 99%`; repeatable.
    #[arg(long, value_name = "GATE", value_parser = parse_gate)]
    pub gate: Vec<Gate>,
    /// Every interior edge must be locally Delaunay.
    #[arg(long)]
    pub delaunay: bool,
    /// Every interior edge that is no constraint must be locally Delaunay.
    #[arg(long)]
    pub constrained_delaunay: bool,
    /// A surface mesh must have no boundary.
    #[arg(long)]
    pub closed: bool,
    /// How far a node of a subdivided segment may be from it, in units in the last place.
    #[arg(long, value_name = "ULPS", value_parser = parse_positive)]
    pub deviation_ulps: Option<f64>,
    /// Findings of this id are reported but do not fail; repeatable.
    #[arg(long, value_name = "ID")]
    pub allow: Vec<Id>,
    /// A TOML file of gates and allowed ids: `gates = ["radius_ratio <= 3 @ 99%"]`, `allow = ["M6"]`.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub gates: Option<PathBuf>,
    /// Quality may not be worse than in this file, which --save-baseline wrote.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub baseline: Option<PathBuf>,
}

impl Demands {
    /// The same in the checker's terms.
    #[must_use]
    pub fn options(&self) -> CheckOptions {
        let most = |metric, bound: Option<f64>| bound.map(|bound| Gate::at_most(metric, bound));
        let mut gates = Vec::new();
        gates.extend(most(Metric::RadiusRatio, self.max_aspect));
        gates.extend(self.min_angle.map(|bound| Gate::at_least(Metric::MinAngle, bound)));
        gates.extend(most(Metric::NeighbourAreaRatio, self.max_area_ratio));
        gates.extend(self.gate.iter().cloned());
        let mut options = CheckOptions::new()
            .delaunay(self.delaunay)
            .constrained_delaunay(self.constrained_delaunay)
            .closed(self.closed);
        if let Some(ulps) = self.deviation_ulps {
            options.deviation_ulps = ulps;
        }
        options.gates = gates;
        options.allow = self.allow.iter().copied().collect();
        options
    }
}

/// `trigrade demo`
#[derive(Clone, Debug, Args)]
pub struct DemoArguments {
    /// The folder that everything goes to.
    #[arg(long, short, value_name = "FOLDER", default_value = "trigrade-demo")]
    pub output: PathBuf,
}

/// `trigrade explain`
#[derive(Clone, Debug, Args)]
pub struct ExplainArguments {
    /// An id (M3) or a slug (mesh.positive) of SPEC.md.
    #[arg(value_name = "ID")]
    pub id: Option<String>,
}

/// `trigrade convert`
#[derive(Clone, Debug, Args)]
pub struct ConvertArguments {
    /// The mesh; `-` is standard input.
    #[arg(value_name = "MESH", value_hint = ValueHint::FilePath)]
    pub mesh: PathBuf,
    /// How the mesh is read.
    #[command(flatten)]
    pub reading: MeshReading,
    /// Where it goes; the extension names the form, `-` is standard output; repeatable.
    #[arg(long = "output", short, value_name = "OUT", required = true)]
    pub outputs: Vec<PathBuf>,
    /// Form of the outputs, whatever their extension (needed for `-o -`); `msh-binary` and
    /// `vtu-compressed` name encodings too.
    #[arg(long, value_name = "FORM")]
    pub form: Option<String>,
}

/// `trigrade torture`
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  trigrade torture --cases 1000
  trigrade torture --preset gmsh --plain --cases 1000 --out gmsh-torture
  trigrade torture --mesher 'mymesher {in} -o {out}' --form geojson --answer vtu
  trigrade torture --preset gmsh --replay gmsh-torture
Exit codes: 0 no failure, 1 failures, 2 the mesher could not be run at all.")]
pub struct TortureArguments {
    /// The mesher's command line for the shell: {in} is the boundary, {out} the mesh, {stem} the
    /// boundary without its extension.
    #[arg(long, value_name = "COMMAND", conflicts_with = "preset")]
    pub mesher: Option<String>,
    /// A mesher known by name: self, gmsh, triangle, netgen, mmg2d, spade.
    #[arg(long, value_name = "NAME", default_value = "self")]
    pub preset: String,
    /// What the mesher reads: json, poly, geo, in2d, svg, geojson, wkt, mesh; without it the
    /// preset's own, and poly for --mesher.
    #[arg(long, value_name = "FORM")]
    pub form: Option<String>,
    /// What the mesher writes: an extension for {out}, or a path such as {stem}.1.ele.
    #[arg(long, value_name = "FORM")]
    pub answer: Option<String>,
    /// Everything follows from it: the same seed gives the same boundaries everywhere.
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub seed: u64,
    /// How many boundaries.
    #[arg(long, value_name = "COUNT", default_value_t = 1000)]
    #[arg(value_parser = clap::value_parser!(u64).range(1..=100_000_000))]
    pub cases: u64,
    /// Only this family; repeatable.
    #[arg(long, value_name = "FAMILY")]
    pub family: Vec<String>,
    /// No family goes far above this number of vertices.
    #[arg(long, value_name = "COUNT", default_value_t = 3000)]
    #[arg(value_parser = clap::value_parser!(u32).range(3..=100_000))]
    pub max_size: u32,
    /// Keep coordinates at integers of moderate size, for meshers that work with tolerances.
    #[arg(long)]
    pub plain: bool,
    /// Processor time for each boundary, in seconds.
    ///
    /// Rounded up to whole ones; a mesher that waits without working is ended after five times as
    /// long by the clock. On Windows it is time by the clock.
    #[arg(long, value_name = "SECONDS", default_value = "30", value_parser = parse_duration)]
    pub timeout: Duration,
    /// Memory for each boundary: bytes, or with a suffix such as 500M or 4G (`ulimit -v`).
    #[arg(long, value_name = "SIZE", default_value = "4G", value_parser = parse_size)]
    pub memory: u64,
    /// No triangle's R/(2r) may be above this.
    #[arg(long, value_name = "RATIO", value_parser = parse_clamp)]
    pub max_aspect: Option<f64>,
    /// Findings of this id do not count; repeatable.
    #[arg(long, value_name = "ID")]
    pub allow: Vec<Id>,
    /// How many failures are shrunk, one of each kind first.
    #[arg(long, value_name = "COUNT", default_value_t = 20)]
    pub shrink: u32,
    /// How often the mesher is asked at most to shrink one failure.
    #[arg(long, value_name = "COUNT", default_value_t = 400)]
    pub trials: u32,
    /// Folder for the report, the reproducers and the log from which a run is taken up again.
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Run the reproducers in this folder again, in place of new boundaries.
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub replay: Option<PathBuf>,
    /// List the families and the presets.
    #[arg(long)]
    pub list: bool,
}

/// `trigrade completions`
#[derive(Clone, Debug, Args)]
pub struct CompletionsArguments {
    /// The shell.
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

/// Radius in chords and number of points of a far-field circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Farfield {
    /// In chords.
    pub radius: f64,
    /// On the circle.
    pub points: u32,
}

/// A report that is wanted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReportTarget {
    /// What form.
    pub form: Form,
    /// Where to; `-` is standard output.
    pub path: PathBuf,
}

fn parse_report(text: &str) -> Result<ReportTarget, String> {
    let (kind, path) =
        text.split_once('=').ok_or("write it as KIND=FILE, e.g. json=report.json")?;
    let form = kind.parse::<Form>().map_err(|error| {
        let near = did_you_mean(kind, Form::ALL.map(Form::name));
        format!("{error}{near}")
    })?;
    if path.is_empty() {
        return Err("the file name is missing after `=`".into());
    }
    Ok(ReportTarget { form, path: path.into() })
}

/// A gate; where its metric is misspelt, with the one that is meant.
fn parse_gate(text: &str) -> Result<Gate, String> {
    Gate::parse(text).map_err(|error| {
        let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
        let metric = text.trim().split(|c| !is_word(c)).next().unwrap_or_default();
        format!("{error}{}", metric_meant(metric))
    })
}

/// `; did you mean ...?` where the word is no metric but nearly one.
fn metric_meant(word: &str) -> String {
    let known: Vec<String> = Metric::all().map(|metric| metric.to_string()).collect();
    match word.parse::<Metric>() {
        Ok(_) => String::new(),
        Err(_) => did_you_mean(word, known.iter().map(String::as_str)),
    }
}

fn parse_finite(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err("the number must be finite".into()),
        Err(_) => Err(format!("`{text}` is not a number")),
    }
}

fn parse_positive(text: &str) -> Result<f64, String> {
    let value = parse_finite(text)?;
    if value > 0.0 { Ok(value) } else { Err("the number must be above 0".into()) }
}

fn parse_max_area(text: &str) -> Result<mesher::AreaMax, String> {
    match text.trim() {
        "field" => Ok(mesher::AreaMax::Field),
        "none" => Ok(mesher::AreaMax::Unbounded),
        number => parse_positive(number)
            .map(mesher::AreaMax::Constant)
            .map_err(|error| format!("{error}; or write `field` or `none`")),
    }
}

fn parse_duration(text: &str) -> Result<Duration, String> {
    let seconds = parse_positive(text)?;
    if seconds <= 86_400.0 {
        Ok(Duration::from_secs_f64(seconds))
    } else {
        Err("a case may take a day at most".into())
    }
}

/// Bytes, with a suffix K, M or G for powers of 1024.
fn parse_size(text: &str) -> Result<u64, String> {
    let wrong = || format!("`{text}` is no size such as 500M or 4G");
    let split = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let (digits, suffix) = text.split_at(split);
    let shift = match suffix {
        "" => 0,
        "K" => 10,
        "M" => 20,
        "G" => 30,
        _ => return Err(wrong()),
    };
    let count: u64 = digits.parse().map_err(|_| wrong())?;
    let bytes = count.checked_mul(1 << shift).ok_or_else(wrong)?;
    // Below that no program starts, and every case would look like a crash.
    if bytes >= 16 << 20 { Ok(bytes) } else { Err("a mesher needs at least 16M".into()) }
}

fn parse_clamp(text: &str) -> Result<f64, String> {
    let value = parse_finite(text)?;
    if value >= 1.0 { Ok(value) } else { Err("the factor must be at least 1".into()) }
}

fn parse_gradation(text: &str) -> Result<mesher::Gradation, String> {
    Ok(match text.trim() {
        "growth" => mesher::Gradation::Growth,
        "mean" => mesher::Gradation::Mean,
        "third" => mesher::Gradation::Third,
        "uniform" => mesher::Gradation::Uniform,
        _ => mesher::Gradation::Expression(Expression::parse(text).map_err(|error| {
            let near = did_you_mean(text.trim(), ["growth", "mean", "third", "uniform"]);
            format!("{error}{near}")
        })?),
    })
}

fn parse_corners(text: &str) -> Result<[u32; 4], String> {
    let wrong = || format!("`{text}` is not four vertices such as 0,10,20,30");
    let numbers: Result<Vec<u32>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    numbers.map_err(|_| wrong())?.try_into().map_err(|_| wrong())
}

fn parse_spacing_at(text: &str) -> Result<(i32, f64), String> {
    let (marker, length) = text.split_once('=').ok_or("write it as MARKER=LENGTH, e.g. 2=0.01")?;
    let marker =
        marker.trim().parse().map_err(|_| format!("`{marker}` is no marker: a whole number"))?;
    Ok((marker, parse_positive(length)?))
}

fn parse_source(text: &str) -> Result<SizeSource, String> {
    let numbers: Vec<f64> = text.split(',').map(parse_finite).collect::<Result<_, _>>()?;
    let source = match numbers[..] {
        [x, y, h] => SizeSource::point(Point2::new(x, y), h, 0.0),
        [x, y, h, radius] => SizeSource::point(Point2::new(x, y), h, radius),
        [x1, y1, x2, y2, h] => SizeSource::line([Point2::new(x1, y1), Point2::new(x2, y2)], h),
        _ => return Err("write it as X,Y,H or X,Y,H,RADIUS, or as X1,Y1,X2,Y2,H".into()),
    };
    if source.is_sound() {
        Ok(source)
    } else {
        Err("the spacing must be above 0 and the radius not below 0".into())
    }
}

fn parse_farfield(text: &str) -> Result<Farfield, String> {
    let (radius, points) = text.split_once(',').ok_or("write it as RADIUS,POINTS, e.g. 15,60")?;
    let radius = parse_positive(radius)?;
    // Below three points there is no circle; above a million it is surely a slip.
    match points.trim().parse::<u32>() {
        Ok(points @ 3..=1_000_000) => Ok(Farfield { radius, points }),
        _ => Err("the number of points must be a whole number from 3 to 1000000".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    // spec: K1
    #[test]
    fn the_definition_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn every_flag_has_a_help_line() {
        let command = Arguments::command();
        for verb in command.get_subcommands() {
            for argument in verb.get_arguments() {
                let id = argument.get_id();
                assert!(argument.get_help().is_some(), "{} {id} has no help", verb.get_name());
            }
        }
    }

    #[test]
    fn defaults_are_those_of_the_library() {
        let Verb::Mesh(mesh) = Arguments::parse_from(["trigrade", "mesh", "a", "-o", "b"]).verb
        else {
            panic!("the verb is mesh");
        };
        assert_eq!(mesh.options.options(), mesher::Options::default());
    }

    fn options_of(line: &str) -> MeshOptions {
        let words = ["trigrade", "mesh", "a", "-o", "b"].into_iter().chain(line.split_whitespace());
        match Arguments::parse_from(words).verb {
            Verb::Mesh(mesh) => mesh.options,
            other => panic!("the verb is mesh, not {other:?}"),
        }
    }

    // spec: E10
    #[test]
    fn areas_are_bounded_by_the_field_unless_angles_are_asked_for() {
        let area = |line| options_of(line).options().area_max;
        assert_eq!(area("--method delaunay"), mesher::AreaMax::Field);
        assert_eq!(area("--method delaunay --min-angle 20"), mesher::AreaMax::Unbounded);
        assert_eq!(area("--method delaunay --max-area 0.5"), mesher::AreaMax::Constant(0.5));
        let both = "--method delaunay --max-area field --min-angle 20";
        assert_eq!(area(both), mesher::AreaMax::Field);
        for wrong in ["0", "-1", "nan", "inf", "", "large"] {
            assert!(parse_max_area(wrong).is_err(), "{wrong}");
        }
    }

    // spec: E10
    #[test]
    fn bounds_that_a_method_does_not_heed_are_named() {
        assert_eq!(options_of("--min-angle 20").idle_flag(), Some("--min-angle"));
        assert_eq!(options_of("--method afm --max-area 1").idle_flag(), Some("--max-area"));
        assert_eq!(options_of("--method delaunay --min-angle 20").idle_flag(), None);
        assert_eq!(options_of("--split-boundary").idle_flag(), None);
    }

    #[test]
    fn engines_are_called_what_the_library_calls_them() {
        for name in EngineName::value_variants() {
            let value = name.to_possible_value().expect("none is hidden");
            assert_eq!(value.get_name(), name.engine().name());
        }
        assert_eq!(EngineName::value_variants().len(), Engine::ALL.len());
    }

    #[test]
    fn reports_are_kind_and_file() {
        let target = parse_report("json=a=b.json").expect("only the first `=` separates");
        assert_eq!(target, ReportTarget { form: Form::Json, path: "a=b.json".into() });
        for wrong in ["json", "json=", "yaml=a", "=a"] {
            assert!(parse_report(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn numbers_outside_their_range_are_refused() {
        for wrong in ["0", "-1", "nan", "inf", "1e999", "", "one"] {
            assert!(parse_positive(wrong).is_err(), "{wrong}");
        }
        assert!(parse_clamp("0.5").is_err());
        assert_eq!(parse_clamp("1"), Ok(1.0));
    }

    #[test]
    fn sizes_and_times() {
        assert_eq!(parse_size("500M"), Ok(500 << 20));
        assert_eq!(parse_size("4G"), Ok(4 << 30));
        for wrong in ["", "G", "-1", "4T", "1", "99999999999999999999", "99999999999G", "1.5G"] {
            assert!(parse_size(wrong).is_err(), "{wrong}");
        }
        assert_eq!(parse_duration("1.5"), Ok(Duration::from_millis(1500)));
        for wrong in ["0", "-1", "1e300", "soon"] {
            assert!(parse_duration(wrong).is_err(), "{wrong}");
        }
    }

    // spec: K10
    #[test]
    fn gradations_are_names_or_expressions() {
        assert_eq!(parse_gradation("mean"), Ok(mesher::Gradation::Mean));
        assert!(matches!(parse_gradation("0.1 + 0.2*x"), Ok(mesher::Gradation::Expression(_))));
        let error = parse_gradation("0.1 + wide").expect_err("no such variable");
        assert!(error.starts_with("column 7:"), "{error}");
    }

    // spec: K10
    #[test]
    fn sources_are_points_discs_and_lines() {
        let p = Point2::new;
        assert_eq!(parse_source("1,-2,0.5"), Ok(SizeSource::point(p(1.0, -2.0), 0.5, 0.0)));
        assert_eq!(parse_source("1,2,0.5,3"), Ok(SizeSource::point(p(1.0, 2.0), 0.5, 3.0)));
        let line = SizeSource::line([p(0.0, 0.0), p(1.0, 1.0)], 0.1);
        assert_eq!(parse_source("0,0,1,1,0.1"), Ok(line));
        for wrong in ["", "1,2", "1,2,0", "1,2,0.5,-1", "1,2,3,4,5,6", "1,2,nan", "a,b,c"] {
            assert!(parse_source(wrong).is_err(), "{wrong}");
        }
        assert_eq!(parse_spacing_at("-3=0.5"), Ok((-3, 0.5)));
        for wrong in ["", "3", "3=0", "x=1", "3=", "=1", "1.5=2"] {
            assert!(parse_spacing_at(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn far_fields() {
        assert_eq!(parse_farfield("15,60"), Ok(Farfield { radius: 15.0, points: 60 }));
        for wrong in ["15", "15,2", "0,60", "15,-3", "15,99999999999", "15,60,3"] {
            assert!(parse_farfield(wrong).is_err(), "{wrong}");
        }
    }
}
