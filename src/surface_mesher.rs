//! The pipeline for surfaces: a model in, a mesh in space out.
//!
//! ```text
//! model -> curves -> per patch, in (u, v): background -> front -> improve -> lift, weld -> mesh
//!          cut once                        CDT           lays     flips,     by index
//! ```
//!
//! The front is the one of the plane: validity is exact in (u, v), lengths and shapes are those of
//! space (SPEC 12).
//!
#![doc = include_str!("../docs/pictures/surface.svg")]

mod chart;
mod cusp;
mod defects;
mod direct;
mod distances;
mod doubles;
mod even;
mod excess;
mod flip;
pub(crate) mod growth;
mod lift;
mod outline;
mod patch;
mod sizing;
mod smooth;
mod structured;
mod tip;
mod trim;

use crate::curve::CurveJet;
use crate::curve::discretize::DiscretizeError;
use crate::front::{FrontError, FrontStats};
use crate::mesh::MeshData;
use crate::mesher::{Gradation, Observer, Options, OptionsError, Stage};
use crate::model::Model;
use crate::size::{Expression, ExpressionError, Prediction};
use crate::structured::{GridMethod, GridStats};
use crate::vector::{Vector, distance};
use chart::{Sheet, SurfaceChart};
use cusp::Cusp;
use excess::{Allowed, Excess};
use growth::{Source, SpaceField};
use lift::Weld;
use outline::{Outline, ROUNDING, Rim};
use patch::{Draft, PatchMesh};
use rayon::prelude::*;
use sizing::{Curvature, Own};
use std::collections::BTreeSet;
use std::sync::OnceLock;
use structured::{Fan, Quarters};
use tip::TipFan;

pub use structured::PatchGridError;

/// How the patches are meshed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SurfaceMethod {
    /// By the front in (u, v).
    #[default]
    Front,
    /// By a front in space whose points are brought back to the surface.
    Direct,
    /// By structured grids in (u, v).
    Grid(GridMethod),
}

/// Options of the surface mesher.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceOptions {
    /// Those it has in common with the plane: growth, spacing, clamp, order, rules, limits, and the
    /// sweeps of improvement. A spacing here overrides the model's.
    pub common: Options,
    /// Largest distance of a triangle from the surface.
    pub chord_error: Option<f64>,
    /// Largest turn of the normal along an edge, in degrees.
    pub angle_per_edge_deg: Option<f64>,
    /// How the patches are meshed.
    pub method: SurfaceMethod,
}

/// A surface mesh and how it came about.
#[derive(Clone, Debug)]
pub struct SurfaceMeshed {
    /// The mesh; regions are the patches' markers.
    pub mesh: MeshData,
    /// Parameters (u, v) of each point: on a curve that patches share those of the first of them.
    /// Empty after [`SurfaceMethod::Direct`], which does not keep them.
    pub parameters: Vec<[f64; 2]>,
    /// Triangles predicted before meshing.
    pub prediction: Prediction,
    /// Smooth patches.
    pub patches: usize,
    /// Curves between and around them.
    pub curves: usize,
    /// What the fronts did.
    pub front: FrontStats,
    /// Flips and moves of the improvement.
    pub improved: [u64; 2],
    /// How structured grids came out, one a smooth patch.
    pub grids: Vec<GridStats>,
    /// Cells of structured grids: as many pairs of triangles come first; those at poles follow.
    pub cells: usize,
}

/// Why there is no surface mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceMeshError {
    /// A model without patches.
    #[error("the model has no patch")]
    Empty,
    /// A curve cannot be cut into edges.
    #[error("{name}: {error}")]
    Curve {
        /// The curve.
        name: String,
        /// Why not.
        error: DiscretizeError,
    },
    /// The outline of a patch in (u, v) has no triangulation.
    #[error("patch {name} has no outline in (u, v): {reason}")]
    Outline {
        /// The patch.
        name: String,
        /// Why not.
        reason: String,
    },
    /// A loop of a trimmed patch is wrong.
    #[error("patch {name} cannot be trimmed: {reason}")]
    Trim {
        /// The patch.
        name: String,
        /// Why not.
        reason: String,
    },
    /// A patch whose tangent turns round at a line.
    #[error(
        "patch {name} has a cusp or a fold where {parameter} is {value}, near {at:?}: its tangent \
         vanishes and turns round there, so that it has no normal (rule S33); make it two patches \
         that meet there"
    )]
    Cusp {
        /// The patch.
        name: String,
        /// `u` or `v`.
        parameter: char,
        /// Its value.
        value: f64,
        /// A point of the cusp.
        at: Vector,
    },
    /// A patch is all poles.
    #[error("patch {name} is a point or a line: two neighbouring sides of it are poles")]
    Flat {
        /// The patch.
        name: String,
    },
    /// The edges are too long to tell the two sides of a seam apart.
    #[error(
        "patch {name}: an edge joins a vertex with itself across a seam near {at:?}; take a smaller --spacing"
    )]
    Coarse {
        /// The patch.
        name: String,
        /// Where.
        at: Vector,
    },
    /// A front in space did not close.
    #[error(
        "the front in space on patch {name} did not close: {edges} edges are left near {at:?}; take \
         a smaller --spacing, or the method of (u, v)"
    )]
    Stuck {
        /// The patch.
        name: String,
        /// Where.
        at: Vector,
        /// Front edges left.
        edges: usize,
    },
    /// The gradation function is none for surfaces.
    #[error("gradation: {0}")]
    Gradation(#[from] ExpressionError),
    /// A gradation that reads spacings off the background triangulation, which models have none of.
    #[error(
        "gradation {0} takes the mean of three nodes of the background triangulation of a plane \
         domain; on models spacings come from space: take growth, uniform or an expression"
    )]
    PlaneGradation(&'static str),
    /// The gradation function's value is no spacing.
    #[error("the gradation gives {value} at {at:?}: a spacing must be positive and finite")]
    NoSpacing {
        /// Its value.
        value: f64,
        /// Where.
        at: Vector,
    },
    /// A patch has no structured grid.
    #[error(transparent)]
    Grid(#[from] PatchGridError),
    /// The prediction is above the limit.
    #[error(
        "the spacings ask for {}{predicted:.0} triangles, above the limit of {limit}: raise --max-triangles, or take a larger --spacing",
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
    /// A front gave up.
    #[error(transparent)]
    Front(#[from] FrontError),
    /// Options that make no sense.
    #[error(transparent)]
    Options(#[from] OptionsError),
}

impl SurfaceOptions {
    /// Whether every number is in its range.
    ///
    /// # Errors
    /// The first option out of range.
    pub fn check(&self) -> Result<(), OptionsError> {
        self.common.check()?;
        let demand = |name, value: Option<f64>, high: f64, rule| match value {
            Some(value) if !(value > 0.0 && value <= high) => {
                Err(OptionsError { name, value, rule })
            }
            _ => Ok(()),
        };
        demand("chord-error", self.chord_error, f64::MAX, "positive and finite")?;
        demand("angle-per-edge", self.angle_per_edge_deg, 120.0, "above 0 and at most 120")
    }
}

/// Curves without a rule get edges of this fraction of the model's diagonal when no spacing is given.
const DEFAULT_SPACING: f64 = 1.0 / 20.0;
/// The same when the curvature decides: only a bound.
const DEFAULT_SPACING_CURVED: f64 = 1.0 / 8.0;
/// No spacing by curvature is below this fraction of the model's diagonal.
const CURVATURE_FLOOR: f64 = 1e-4;
/// Samples of the curvature in each direction of a patch.
const CURVATURE_SAMPLES: u32 = 40;

/// Meshes a model. Nothing about the result needs to be believed: [`check`](crate::check) can be
/// asked.
///
/// # Errors
/// [`SurfaceMeshError`].
///
/// # Complexity
/// Linear in triangles, `n log n` in boundary nodes and samples of the curvature.
///
/// ```
/// use trigrade::format::model_json;
/// use trigrade::mesher::Unobserved;
/// use trigrade::surface_mesher::{SurfaceOptions, mesh_model};
/// # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/models/two_coons.json");
/// let model = model_json::read(&std::fs::read(path)?)?;
/// let meshed = mesh_model(&model, &SurfaceOptions::default(), &mut Unobserved)?;
/// let report = trigrade::check::check(&meshed.mesh, None, &Default::default());
/// assert!(report.passed());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn mesh_model(
    model: &Model,
    options: &SurfaceOptions,
    observer: &mut dyn Observer,
) -> Result<SurfaceMeshed, SurfaceMeshError> {
    options.check()?;
    let mut finer = Vec::new();
    let mut round = 1;
    loop {
        let (meshed, excess) = mesh_once(model, options, (&finer, round == ROUNDS), observer)?;
        if excess.is_empty() {
            return Ok(meshed);
        }
        finer.extend(excess);
        round += 1;
    }
}

/// Times that a model is meshed at most, to keep the chord error asked for.
const ROUNDS: usize = 6;

/// Meshes a model with some more sources of spacing; gives the mesh, and the sources that it lacks:
/// none where halving some edges has mended it, or in the last round.
fn mesh_once(
    model: &Model,
    options: &SurfaceOptions,
    (finer, is_last): (&[Source], bool),
    observer: &mut dyn Observer,
) -> Result<(SurfaceMeshed, Vec<Source>), SurfaceMeshError> {
    observer.stage(Stage::Background);
    let mut plan = Plan::new(model, options, finer)?;
    let mut rims = plan.rims(model)?;
    if let SurfaceMethod::Grid(method) = options.method {
        let limit = options.common.triangles_max;
        return Ok((plan.grids(model, &rims, (method, limit), observer)?, Vec::new()));
    }
    if options.method == SurfaceMethod::Direct {
        return Ok((plan.direct(model, &rims, &options.common, observer)?, Vec::new()));
    }
    let tips = tip::fans(&mut plan.outline, &mut rims);
    let drafts = plan.drafts(model, &rims)?;

    plan.demand_spacings()?;
    observer.stage(Stage::Size);
    let limit = options.common.triangles_max;
    let predictions = predict_all(&drafts, limit)?;
    let triangles = predictions.iter().sum();
    let prediction = Prediction { triangles, stopped: false };
    if !observer.predicted(prediction) {
        return Err(FrontError::Stopped.into());
    }

    observer.stage(Stage::Front);
    let mut weld = Weld::new(&plan.outline);
    let mut meshed = plan.nothing_yet(prediction);
    let mut jobs: Vec<(Draft<'_>, f64)> = drafts.into_iter().zip(predictions).collect();
    let mut patches = Vec::new();
    while !jobs.is_empty() {
        let some: Vec<_> = jobs.drain(..jobs.len().min(AT_ONCE)).collect();
        let done: usize =
            patches.iter().map(|patch: &PatchMesh| patch.mesh.triangles().count()).sum();
        patches.extend(mesh_some(some, &options.common, &mut |n| observer.progress(done + n))?);
    }
    plan.demand_spacings()?;
    let mut excess = plan.excess(&patches, &rims);
    if !excess.sources.is_empty() && (is_last || excess.is_local()) {
        plan.halve(&mut patches, &rims);
        excess = plan.excess(&patches, &rims);
    }
    plan.part_doubles(&mut patches, &rims);
    for (i, patch) in patches.into_iter().enumerate() {
        let piece = &plan.outline.pieces[i];
        meshed.front.accepted_existing += patch.stats.accepted_existing;
        meshed.front.inserted += patch.stats.inserted;
        meshed.front.rejected += patch.stats.rejected;
        meshed.improved[0] += patch.flips;
        meshed.improved[1] += patch.moves;
        let of = &model.patches[piece.patch];
        weld.add(i as u32, (of.marker, &of.name), &rims[i], &patch)?;
    }
    for TipFan { piece, corners } in tips {
        let of = plan.outline.pieces[piece as usize].patch;
        weld.push(piece, model.patches[of].marker, corners);
    }
    observer.stage(Stage::Collect);
    (meshed.mesh, meshed.parameters) = weld.finish(model, &plan.outline, &rims);
    let finer = if is_last { Vec::new() } else { excess.sources };
    Ok((meshed, finer))
}

/// Patches that are meshed at the same time; between such groups the observer is asked whether to
/// go on.
const AT_ONCE: usize = 16;

/// Meshes some patches, each for itself: no patch depends on another, so that the number of threads
/// changes nothing.
fn mesh_some(
    mut jobs: Vec<(Draft<'_>, f64)>,
    options: &Options,
    progress: &mut dyn FnMut(usize) -> bool,
) -> Result<Vec<PatchMesh>, SurfaceMeshError> {
    // A triangle mesh has half as many vertices as triangles; the backstop is three times that.
    let vertices_max = |predicted: f64| (1.5 * predicted) as usize + 1000;
    if jobs.len() == 1 {
        let (draft, predicted) = jobs.remove(0);
        return Ok(vec![draft.mesh(options, vertices_max(predicted), progress)?]);
    }
    let mesh = |(draft, predicted): (Draft<'_>, f64)| {
        draft.mesh(options, vertices_max(predicted), &mut |_| true)
    };
    let patches: Vec<Result<PatchMesh, SurfaceMeshError>> =
        jobs.into_par_iter().map(mesh).collect();
    let patches = patches.into_iter().collect::<Result<Vec<_>, _>>()?;
    match progress(patches.iter().map(|patch| patch.mesh.triangles().count()).sum()) {
        true => Ok(patches),
        false => Err(FrontError::Stopped.into()),
    }
}

/// Predicted triangles of each patch.
fn predict_all(drafts: &[Draft<'_>], limit: usize) -> Result<Vec<f64>, SurfaceMeshError> {
    let mut sum = 0.0;
    let mut all = Vec::new();
    for draft in drafts {
        let Prediction { triangles, stopped } = draft.predict(limit as f64);
        sum += triangles;
        if sum > limit as f64 {
            return Err(SurfaceMeshError::TooMany { predicted: sum, stopped, limit });
        }
        all.push(triangles);
    }
    Ok(all)
}

/// Everything that is known before the first triangle.
struct Plan {
    outline: Outline,
    field: SpaceField,
    curvature: Curvature,
    /// How far off is the same, and how far off its surface no curve may be.
    tolerances: [f64; 2],
}

impl Plan {
    fn new(
        model: &Model,
        options: &SurfaceOptions,
        finer: &[Source],
    ) -> Result<Self, SurfaceMeshError> {
        let mut outline = Outline::new(model)?;
        if outline.pieces.is_empty() {
            return Err(SurfaceMeshError::Empty);
        }
        demand_no_cusp(model, &outline)?;
        let diagonal = model.diagonal();
        let mut curvature = Curvature {
            chord_error: options.chord_error.or(model.chord_error),
            angle: options.angle_per_edge_deg.or(model.angle_per_edge_deg).map(f64::to_radians),
            floor: CURVATURE_FLOOR * diagonal,
            own: None,
        };
        let own = own_gradation(options)?;
        let given = options.common.spacing.or(model.spacing);
        let is_curved = curvature.is_on() || own.is_some();
        let fraction = if is_curved { DEFAULT_SPACING_CURVED } else { DEFAULT_SPACING };
        let spacing = given.unwrap_or(fraction * diagonal);
        curvature.own = own.map(|expression| Own { expression, spacing, fault: OnceLock::new() });
        let cap = if given.is_some() || outline.needs_default() { spacing } else { f64::INFINITY };
        let growth = options.common.growth;
        let mut sources = Vec::new();
        if options.method == SurfaceMethod::Front {
            sources = tip::sources(&outline, spacing);
        }
        if curvature.is_on() {
            sources.extend(samples(&outline, &curvature));
            sources.extend(finer);
        }
        let near = SpaceField::new(&sources, growth, spacing);
        let along = |jet: &CurveJet| curvature.along(jet).min(near.at(jet.point));
        outline.cut(&along)?;
        if matches!(options.method, SurfaceMethod::Grid(_)) {
            outline.even(&along)?;
        }
        let same = model.tolerance.unwrap_or(0.0);
        let tolerance = same.max(ROUNDING * diagonal);
        let off = model.tolerance.map_or(trim::OFF * diagonal, |_| tolerance);
        outline.number(tolerance);
        let is_uniform = options.common.gradation == Gradation::Uniform;
        if !is_uniform {
            sources.extend(node_sources(&outline));
        }
        let cap = if is_uniform { spacing } else { cap };
        let field = SpaceField::new(&sources, growth, cap);
        Ok(Self { outline, field, curvature, tolerances: [tolerance, off] })
    }

    /// Whether the user's own function gave a spacing wherever it was asked.
    fn demand_spacings(&self) -> Result<(), SurfaceMeshError> {
        let fault = self.curvature.own.as_ref().and_then(|own| own.fault.get());
        fault.map_or(Ok(()), |&(value, at)| Err(SurfaceMeshError::NoSpacing { value, at }))
    }

    /// What is told of a run before its first triangle.
    fn nothing_yet(&self, prediction: Prediction) -> SurfaceMeshed {
        SurfaceMeshed {
            mesh: MeshData::default(),
            parameters: Vec::new(),
            prediction,
            patches: self.outline.pieces.len(),
            curves: self.outline.curves.iter().filter(|shared| shared.uses > 0).count(),
            front: FrontStats::default(),
            improved: [0; 2],
            grids: Vec::new(),
            cells: 0,
        }
    }

    /// Structured grids on all patches.
    fn grids(
        &self,
        model: &Model,
        rims: &[Rim],
        (method, limit): (GridMethod, usize),
        observer: &mut dyn Observer,
    ) -> Result<SurfaceMeshed, SurfaceMeshError> {
        observer.stage(Stage::Size);
        let quarters = Quarters::all(self, model, rims)?;
        let triangles = quarters.iter().map(|q| q.triangles() as f64).sum();
        if triangles > limit as f64 {
            return Err(SurfaceMeshError::TooMany { predicted: triangles, stopped: false, limit });
        }
        let prediction = Prediction { triangles, stopped: false };
        if !observer.predicted(prediction) {
            return Err(FrontError::Stopped.into());
        }
        observer.stage(Stage::Grid);
        let mut weld = Weld::new(&self.outline);
        let mut meshed = self.nothing_yet(prediction);
        let mut fans = Vec::new();
        for quarter in &quarters {
            meshed.grids.push(quarter.lay(method, &mut weld, &mut fans)?);
        }
        meshed.cells = weld.mesh.triangles.len() / 2;
        for Fan { piece, marker, corners } in fans {
            weld.push(piece, marker, corners);
        }
        observer.stage(Stage::Collect);
        (meshed.mesh, meshed.parameters) = weld.finish(model, &self.outline, rims);
        Ok(meshed)
    }

    /// Parts edges of patches that are the same edge in space.
    fn part_doubles(&self, patches: &mut [PatchMesh], rims: &[Rim]) {
        patches.par_iter_mut().enumerate().for_each(|(i, patch)| {
            doubles::part(&self.chart(i), patch, &rims[i]);
        });
    }

    /// Where the patches leave their surfaces too far.
    fn excess(&self, patches: &[PatchMesh], rims: &[Rim]) -> Excess {
        let Some(limit) = self.curvature.chord_error else { return Excess::default() };
        let kept = self.outline.ruled_vertices();
        let of = |(i, patch): (usize, &PatchMesh)| {
            let is_kept = is_kept(&kept, &rims[i]);
            let allowed = Allowed { limit, floor: self.curvature.floor, is_kept: &is_kept };
            excess::excess(&self.chart(i), patch, allowed)
        };
        let lists: Vec<Excess> = patches.par_iter().enumerate().map(of).collect();
        let mut all = Excess::default();
        lists.into_iter().for_each(|excess| all.join(excess));
        all
    }

    /// Halves edges where the patches leave their surfaces too far.
    fn halve(&self, patches: &mut [PatchMesh], rims: &[Rim]) {
        let Some(limit) = self.curvature.chord_error else { return };
        let kept = self.outline.ruled_vertices();
        patches.par_iter_mut().enumerate().for_each(|(i, patch)| {
            let is_kept = is_kept(&kept, &rims[i]);
            let allowed = Allowed { limit, floor: self.curvature.floor, is_kept: &is_kept };
            excess::halve(&self.chart(i), patch, rims[i].nodes.len(), allowed);
        });
    }

    fn rims(&self, model: &Model) -> Result<Vec<Rim>, SurfaceMeshError> {
        let around = |piece: &outline::Piece| {
            let name = model.patches[piece.patch].name.clone();
            match self.outline.rim(piece, self.tolerances) {
                Err(reason) => Err(SurfaceMeshError::Trim { name, reason }),
                Ok(rim) if rim.nodes.iter().any(|node| node.vertex == u32::MAX) => {
                    Err(SurfaceMeshError::Flat { name })
                }
                Ok(rim) => Ok(rim),
            }
        };
        self.outline.pieces.iter().map(around).collect()
    }

    fn chart(&self, piece: usize) -> SurfaceChart<'_> {
        SurfaceChart {
            sheet: Sheet::new(&self.outline.pieces[piece].surface),
            field: &self.field,
            curvature: &self.curvature,
        }
    }

    fn drafts(&self, model: &Model, rims: &[Rim]) -> Result<Vec<Draft<'_>>, SurfaceMeshError> {
        let draft = |(i, rim): (usize, &Rim)| {
            let name = &model.patches[self.outline.pieces[i].patch].name;
            Draft::new(self.chart(i), rim, &self.outline.points, name)
        };
        rims.iter().enumerate().map(draft).collect()
    }
}

/// Whether a vertex of a patch is one of a curve that the model says how to cut.
fn is_kept<'a>(kept: &'a BTreeSet<u32>, rim: &'a Rim) -> impl Fn(usize) -> bool + Sync + 'a {
    move |v| rim.nodes.get(v).is_some_and(|node| kept.contains(&node.vertex))
}

/// The gradation function of the options, if they have one that surfaces can use.
fn own_gradation(options: &SurfaceOptions) -> Result<Option<Expression>, SurfaceMeshError> {
    match &options.common.gradation {
        Gradation::Expression(expression) => {
            expression.demand_surface()?;
            Ok(Some(expression.clone()))
        }
        Gradation::Mean => Err(SurfaceMeshError::PlaneGradation("mean")),
        Gradation::Third => Err(SurfaceMeshError::PlaneGradation("third")),
        Gradation::Growth | Gradation::Uniform => Ok(None),
    }
}

/// Whether no patch that is not trimmed has a cusp.
fn demand_no_cusp(model: &Model, outline: &Outline) -> Result<(), SurfaceMeshError> {
    let whole = outline.pieces.iter().filter(|piece| !piece.has_outline);
    let mut cusps = whole.filter_map(|piece| Some((piece, cusp::find(&piece.surface)?)));
    let Some((piece, Cusp { is_across_u, parameter: value, at })) = cusps.next() else {
        return Ok(());
    };
    let name = model.patches[piece.patch].name.clone();
    let parameter = if is_across_u { 'u' } else { 'v' };
    Err(SurfaceMeshError::Cusp { name, parameter, value, at })
}

/// The spacings that the curvature wants all over the patches.
fn samples(outline: &Outline, curvature: &Curvature) -> Vec<Source> {
    let mut sources = Vec::new();
    for piece in &outline.pieces {
        let [[u0, u1], [v0, v1]] = piece.surface.domain();
        let step = |i: u32| f64::from(i) / f64::from(CURVATURE_SAMPLES);
        for k in 0..(CURVATURE_SAMPLES + 1).pow(2) {
            let (i, j) = (k % (CURVATURE_SAMPLES + 1), k / (CURVATURE_SAMPLES + 1));
            let jet = piece.surface.jet(u0 + step(i) * (u1 - u0), v0 + step(j) * (v1 - v0));
            let spacing = curvature.spacing(&jet);
            if spacing.is_finite() {
                sources.push(Source { at: jet.tangents.point, spacing });
            }
        }
    }
    sources
}

/// The spacing at each node: the mean length of the edges at it.
fn node_sources(outline: &Outline) -> Vec<Source> {
    let mut sums = vec![(0.0, 0_u32); outline.points.len()];
    for shared in outline.curves.iter().filter(|shared| shared.uses > 0) {
        for pair in shared.vertices.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|v| v as usize);
            let length = distance(outline.points[a], outline.points[b]);
            for v in [a, b] {
                sums[v].0 += length;
                sums[v].1 += 1;
            }
        }
    }
    let nodes = outline.points.iter().zip(sums).filter(|(_, (_, count))| *count > 0);
    nodes.map(|(&at, (sum, count))| Source { at, spacing: sum / f64::from(count) }).collect()
}
