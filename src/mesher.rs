//! The pipeline: a domain in, a mesh out, a line per stage.

mod builder;
mod control;
mod field;
mod fit;
mod options;
mod refined;
mod scale;
mod structured;

pub use builder::Mesher;
pub use fit::Fit;
pub use options::{AreaMax, Count, Gradation, Method, Options, OptionsError};
pub use structured::GridError;

use crate::background::{Background, BackgroundError};
use crate::domain::Domain;
use crate::domain::validate::{Fault, Plc, validate};
use crate::front::{self, FrontError, FrontMesh, FrontOptions, FrontStats, Start};
use crate::improve::{ImproveStats, SplitOptions, improve, split_long_edges};
use crate::mesh::{MarkedEdge, Mesh};
use crate::point::Point2;
use crate::refine::{RefineError, RefineStats};
use crate::size::{ExpressionError, Prediction, SpacingTable, TableError};
use crate::structured::{GridMethod, GridStats};
use crate::subdivide::{self, TooManyPoints, subdivide};
use crate::triangulation::{Across, HalfEdgeId, Triangulation};
use control::Control;
use field::Fields;
use scale::Scale;
use std::collections::HashMap; // lookups only

/// A stage of the pipeline, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Finding every fault of the domain.
    Validate,
    /// Constrained Delaunay triangulation of the boundary.
    Background,
    /// Node spacings, size field and prediction.
    Size,
    /// The advancing front.
    Front,
    /// Delaunay refinement, in place of the front.
    Refine,
    /// A structured grid, in place of the front.
    Grid,
    /// Flips and smoothing.
    Improve,
    /// Plain arrays.
    Collect,
}

impl std::fmt::Display for Stage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Validate => "validate",
            Self::Background => "background",
            Self::Size => "size field",
            Self::Front => "front",
            Self::Refine => "refine",
            Self::Grid => "grid",
            Self::Improve => "improve",
            Self::Collect => "collect",
        })
    }
}

/// Watches a run: for progress bars, timings and stopping. The library has no clock of its own.
/// Progress may be reported from any thread, one at a time.
pub trait Observer: Send {
    /// A stage begins.
    fn stage(&mut self, _stage: Stage) {}
    /// The prediction is known; `false` stops the run.
    fn predicted(&mut self, _prediction: Prediction) -> bool {
        true
    }
    /// The front has laid this many triangles; `false` stops the run.
    fn progress(&mut self, _triangles: usize) -> bool {
        true
    }
}

/// An observer that does not look.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unobserved;

impl Observer for Unobserved {}

/// A mesh and how it came about.
#[derive(Clone, Debug)]
pub struct Meshed {
    /// The mesh.
    pub mesh: Mesh,
    /// Wanted spacing at each of its points; infinite where no field was asked for (method delaunay).
    pub spacing: Vec<f64>,
    /// Triangles predicted before meshing.
    pub prediction: Prediction,
    /// What the front did.
    pub front: FrontStats,
    /// What improvement did.
    pub improve: ImproveStats,
    /// What refinement did (method delaunay).
    pub refine: Option<RefineStats>,
    /// Points inserted on the boundary and on constraints.
    pub splits: usize,
    /// How well its edges fit the wanted spacing; `None` when all of them are the domain's.
    pub fit: Option<Fit>,
    /// How the structured grid came out (methods transfinite and elliptic).
    pub grid: Option<GridStats>,
}

/// Why there is no mesh.
#[derive(Clone, Debug, thiserror::Error)]
pub enum MeshError {
    /// The domain is invalid; every fault is listed.
    #[error("the domain has {} fault{}; the first: {}", .0.len(), if .0.len() == 1 { "" } else { "s" }, .0[0])]
    Invalid(Vec<Fault>),
    /// The domain is sound but a seed is not, or nothing is inside.
    #[error(transparent)]
    Background(#[from] BackgroundError),
    /// The prediction is above the limit.
    #[error(
        "the size field asks for {}{predicted:.0} triangles, above the limit of {limit}: raise \
         --max-triangles, let --coarsen or --target choose a coarser field, or take one (a larger \
         --growth or --spacing)",
        if *.stopped { "more than " } else { "about " }
    )]
    TooMany {
        /// Predicted number of triangles.
        predicted: f64,
        /// Whether the prediction is only a lower bound.
        stopped: bool,
        /// The limit.
        limit: usize,
    },
    /// The front gave up.
    #[error(transparent)]
    Front(#[from] FrontError),
    /// Refinement gave up.
    #[error(transparent)]
    Refine(#[from] RefineError),
    /// The boundary would be split too often.
    #[error(transparent)]
    Split(#[from] TooManyPoints),
    /// The domain has no structured grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// Options that make no sense.
    #[error(transparent)]
    Options(#[from] OptionsError),
    /// The gradation function is none for this method.
    #[error("gradation: {0}")]
    Gradation(#[from] ExpressionError),
    /// The background mesh is no size field.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The gradation function's value is no spacing.
    #[error("the gradation gives {value} at {at}: a spacing must be positive and finite")]
    BadSpacing {
        /// Where.
        at: Point2,
        /// The function's value.
        value: f64,
    },
}

/// Meshes a domain: graded triangulation by an advancing front (SPEC 7).
///
/// The boundary's points and segments are kept. The result is conforming; nothing about it needs
/// to be believed, since [`check`](crate::check) can be asked.
///
/// # Errors
/// [`MeshError`]: an invalid domain (all its faults), a budget passed, senseless options.
///
/// # Complexity
/// O(n log n) for n boundary points, plus linear time in the number of triangles.
///
/// ```
/// use trigrade::domain::Domain;
/// use trigrade::mesher::{Options, Unobserved, mesh_domain};
/// let square = Domain::of_rings(&[vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]]);
/// let meshed = mesh_domain(&square, &Options::default(), &mut Unobserved)?;
/// assert_eq!(meshed.mesh.triangles.len(), 2, "as coarse as its boundary");
/// # Ok::<(), trigrade::mesher::MeshError>(())
/// ```
pub fn mesh_domain(
    domain: &Domain,
    options: &Options,
    observer: &mut dyn Observer,
) -> Result<Meshed, MeshError> {
    options.check()?;
    observer.stage(Stage::Validate);
    let plc = validate(domain).map_err(MeshError::Invalid)?;
    mesh_plc(plc, options, observer)
}

/// Meshes a validated domain. See [`mesh_domain`].
///
/// # Errors
/// As [`mesh_domain`], but for faults of the domain.
pub fn mesh_plc(
    mut plc: Plc,
    options: &Options,
    observer: &mut dyn Observer,
) -> Result<Meshed, MeshError> {
    options.check()?;
    options.table.as_deref().map_or(Ok(()), SpacingTable::check)?;
    let scale = Scale::of(&plc.points);
    scale.shrink(&mut plc);

    observer.stage(Stage::Background);
    let mut background = Background::new(&plc)?;
    if options.method == Method::Delaunay {
        return refined::mesh(&background, options, &scale, observer);
    }
    if let Some(method) = grid_method(options.method) {
        return structured::mesh(&background, &plc, method, options, (&scale, observer));
    }
    let splits = split_boundary(&plc, &mut background, options, &scale)?;

    observer.stage(Stage::Size);
    let control = Control { background: &background, options, scale: &scale };
    let (fields, prediction) = control.fields()?;
    if !observer.predicted(prediction) {
        return Err(FrontError::Stopped.into());
    }
    let mut mesh = |fields: &Fields, prediction: Prediction| {
        mesh_field(&background, fields, prediction, options, &scale, observer)
    };
    let meshed = mesh(&fields, prediction)?;
    let meshed = match options.count {
        Count::Target(target) => control.hit(target, meshed, mesh)?,
        Count::Field | Count::Coarsen => meshed,
    };
    Ok(Meshed { splits, ..meshed })
}

/// The structured grid that a method asks for.
fn grid_method(method: Method) -> Option<GridMethod> {
    match method {
        Method::Transfinite => Some(GridMethod::Transfinite),
        Method::Elliptic => Some(GridMethod::Elliptic),
        _ => None,
    }
}

/// Splits the boundary where that is asked for; returns the number of new points.
fn split_boundary(
    plc: &Plc,
    background: &mut Background,
    options: &Options,
    scale: &Scale,
) -> Result<usize, MeshError> {
    if !options.split_boundary {
        return Ok(0);
    }
    let split_options = subdivide::SplitOptions {
        growth: options.growth,
        spacing: options.spacing.map(|h| scale.shrink_length(h)),
        points_max: options.triangles_max,
        quantum: scale.quantum(),
    };
    let (split, count) = subdivide(plc, background, split_options)?;
    *background = Background::new(&split)?;
    Ok(count)
}

/// Front, improvement and plain arrays for one size field.
fn mesh_field(
    background: &Background,
    fields: &Fields,
    prediction: Prediction,
    options: &Options,
    scale: &Scale,
    observer: &mut dyn Observer,
) -> Result<Meshed, MeshError> {
    observer.stage(Stage::Front);
    let mut laid = lay(fields, options, prediction, scale, observer)?;
    let borders = border_half_edges(&laid.mesh, background.edges.len());
    join_constraints(&mut laid.mesh, background, &borders);

    observer.stage(Stage::Improve);
    let mut splits = 0;
    if fields.has_coarse_boundary() && options.method != Method::DelaunayInitial {
        splits = split_coarse(&mut laid, fields, prediction, scale)?;
    }
    let fixed = background.points.len();
    let FrontMesh { mesh, points, spacing, .. } = &mut laid;
    let mut improve = improve(mesh, points, spacing, fixed, scale.quantum(), options.improve);
    improve.splits = splits;

    observer.stage(Stage::Collect);
    let fit = fit::fit(fields, &laid, fixed);
    let made = Made { prediction, improve, fit };
    Ok(collect(laid, background, made, scale))
}

/// Lays the triangles: by the front, or none but the background's own.
fn lay(
    fields: &Fields,
    options: &Options,
    prediction: Prediction,
    scale: &Scale,
    observer: &mut dyn Observer,
) -> Result<FrontMesh, MeshError> {
    let start = fields.start();
    if options.method == Method::DelaunayInitial {
        let Start { points, region, spacing, .. } = start;
        return Ok(FrontMesh { points, mesh: region, spacing, stats: FrontStats::default() });
    }
    let front_options = FrontOptions {
        order: options.order,
        rules: options.rules,
        clamp: options.clamp,
        vertices_max: backstop(prediction),
        quantum: scale.quantum(),
    };
    let mut progress = |n| fields.sound().is_ok() && observer.progress(n);
    let laid = front::advance(start, fields.field(), front_options, &mut progress);
    fields.sound()?;
    Ok(laid?)
}

/// Splits what the front has left too large between boundaries coarser than the field.
fn split_coarse(
    laid: &mut FrontMesh,
    fields: &Fields,
    prediction: Prediction,
    scale: &Scale,
) -> Result<u64, MeshError> {
    let hints = fields.hints_by_tag();
    let FrontMesh { mesh, points, spacing, .. } = laid;
    let new_max = backstop(prediction);
    let points_max = fields.start_count() + new_max;
    let options = SplitOptions { quantum: scale.quantum(), points_max };
    let wanted = |tag: u32, p: Point2| fields.attainable(p, hints[&tag]);
    let splits = split_long_edges(mesh, points, spacing, wanted, options);
    fields.sound()?;
    splits.ok_or_else(|| FrontError::Budget(new_max).into())
}

/// New vertices at which the front gives up: three times as many as predicted.
fn backstop(prediction: Prediction) -> usize {
    // A triangle mesh has half as many vertices as triangles.
    (1.5 * prediction.triangles) as usize + 1000
}

/// For each border value of the mesh its half-edge.
fn border_half_edges(mesh: &Triangulation, count: usize) -> Vec<Option<HalfEdgeId>> {
    let mut borders = vec![None; count];
    for e in mesh.triangles().flat_map(|t| t.half_edges()) {
        if let Across::Border(owner) = mesh.across(e) {
            borders[owner as usize] = Some(e);
        }
    }
    borders
}

/// Glues the two sides of each interior constraint, along which the front was cut.
fn join_constraints(
    mesh: &mut Triangulation,
    background: &Background,
    borders: &[Option<HalfEdgeId>],
) {
    let interior = &background.edges[background.boundary_count..];
    let mut waiting = HashMap::new();
    for (edge, &side) in interior.iter().zip(&borders[background.boundary_count..]) {
        let side = side.expect("a front edge has a triangle");
        let [a, b] = edge.vertices;
        match waiting.remove(&[b, a]) {
            None => {
                waiting.insert([a, b], side);
            }
            Some(other) => {
                mesh.link(side, other);
                mesh.set_constrained(side, true);
            }
        }
    }
    debug_assert!(waiting.is_empty(), "an interior constraint with one side");
}

/// What is told of a mesh beside it.
struct Made {
    prediction: Prediction,
    improve: ImproveStats,
    fit: Option<Fit>,
}

/// Plain arrays in the user's coordinates, without points that no triangle uses. The arrays of the
/// front become those of the mesh where they can: memory is at its fullest here.
fn collect(laid: FrontMesh, background: &Background, made: Made, scale: &Scale) -> Meshed {
    let FrontMesh { mut points, mesh: topology, mut spacing, stats } = laid;
    let renumber = Renumber::used(&topology, points.len());
    let edges = marked_edges(background, &renumber);
    let regions = region_markers(&topology, background);
    let triangles = topology.into_triangles(|v| renumber.number(v.0));
    renumber.keep_points(&mut points, scale);
    renumber.keep_spacing(&mut spacing, scale);
    let mesh = Mesh { points, triangles, edges, regions };
    let Made { prediction, improve, fit } = made;
    let (refine, splits, grid) = (None, 0, None);
    Meshed { mesh, spacing, prediction, front: stats, improve, refine, splits, fit, grid }
}

fn region_markers(topology: &Triangulation, background: &Background) -> Vec<i32> {
    if background.regions.is_empty() {
        return Vec::new();
    }
    topology.triangles().map(|t| background.region_of_tag(topology.tag(t))).collect()
}

/// Boundary edges first, then each interior constraint once.
fn marked_edges(background: &Background, renumber: &Renumber) -> Vec<MarkedEdge> {
    let (boundary, interior) = background.edges.split_at(background.boundary_count);
    boundary
        .iter()
        .chain(interior.iter().filter(|edge| edge.vertices[0] < edge.vertices[1]))
        .map(|edge| MarkedEdge {
            vertices: edge.vertices.map(|v| renumber.number(v.0)),
            marker: edge.marker,
        })
        .collect()
}

/// New numbers of the points in use, in the old order.
struct Renumber {
    /// For each point its new number; `None` when all are in use.
    new: Option<Vec<u32>>,
}

const UNUSED: u32 = u32::MAX;

impl Renumber {
    fn used(topology: &Triangulation, points: usize) -> Self {
        let mut is_used = vec![false; points];
        for v in topology.triangles().flat_map(|t| topology.corners(t)) {
            is_used[v.index()] = true;
        }
        if is_used.iter().all(|&used| used) {
            return Self { new: None };
        }
        let mut next = 0;
        let number = |used| {
            let number = next;
            next += u32::from(used);
            if used { number } else { UNUSED }
        };
        Self { new: Some(is_used.into_iter().map(number).collect()) }
    }

    fn number(&self, old: u32) -> u32 {
        self.new.as_ref().map_or(old, |new| new[old as usize])
    }

    /// Leaves the points in use, in the user's coordinates.
    fn keep_points(&self, points: &mut Vec<Point2>, scale: &Scale) {
        self.keep(points);
        for p in points {
            *p = scale.grow(*p);
        }
    }

    /// Leaves the spacings at points in use, in the user's unit.
    fn keep_spacing(&self, spacing: &mut Vec<f64>, scale: &Scale) {
        self.keep(spacing);
        for h in spacing {
            *h = scale.grow_length(*h);
        }
    }

    /// Leaves the items of points in use.
    fn keep<T>(&self, items: &mut Vec<T>) {
        if let Some(new) = &self.new {
            let mut numbers = new.iter();
            items.retain(|_| numbers.next() != Some(&UNUSED));
        }
    }
}
