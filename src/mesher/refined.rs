//! The method delaunay: refinement in place of the front and of improvement.

use super::control::Control;
use super::field::Fields;
use super::options::{AreaMax, Count, Options};
use super::scale::Scale;
use super::{MeshError, Meshed, Observer, Renumber, Stage, region_markers};
use crate::background::Background;
use crate::front::{FrontError, FrontStats};
use crate::improve::ImproveStats;
use crate::mesh::{MarkedEdge, Mesh};
use crate::point::Point2;
use crate::refine::{AreaBound, RefineOptions, Refined, refine};
use crate::size::Prediction;

/// Triangles per unit of (area over bound): the mean triangle has about 0.65 of the largest area.
pub(super) const TRIANGLES_PER_BOUND: f64 = 1.55;

/// Refines with the areas of the field, at the count that is wanted, or with a constant bound.
pub(super) fn mesh(
    background: &Background,
    options: &Options,
    scale: &Scale,
    observer: &mut dyn Observer,
) -> Result<Meshed, MeshError> {
    observer.stage(Stage::Size);
    let run = Run { background, options, scale };
    if options.area_max == AreaMax::Field {
        let control = Control { background, options, scale };
        let (fields, prediction) = control.fields()?;
        announce(prediction, observer)?;
        let mut mesh = |fields: &Fields, prediction: Prediction| {
            run.refined(AreaBound::Field(fields.field()), prediction, observer)
        };
        let meshed = mesh(&fields, prediction)?;
        return match options.count {
            Count::Target(target) => control.hit(target, meshed, mesh),
            Count::Field | Count::Coarsen => Ok(meshed),
        };
    }
    let area = match options.area_max {
        AreaMax::Constant(area) => AreaBound::Constant(scale.shrink_area(area)),
        AreaMax::Field | AreaMax::Unbounded => AreaBound::None,
    };
    let prediction = predict(background, area);
    if prediction.triangles > options.triangles_max as f64 {
        let Prediction { triangles: predicted, stopped } = prediction;
        return Err(MeshError::TooMany { predicted, stopped, limit: options.triangles_max });
    }
    announce(prediction, observer)?;
    run.refined(area, prediction, observer)
}

/// Asks the observer whether to go on.
fn announce(prediction: Prediction, observer: &mut dyn Observer) -> Result<(), MeshError> {
    if observer.predicted(prediction) { Ok(()) } else { Err(FrontError::Stopped.into()) }
}

/// What every refinement of a domain shares.
struct Run<'a> {
    background: &'a Background,
    options: &'a Options,
    scale: &'a Scale,
}

impl Run<'_> {
    fn refined(
        &self,
        area: AreaBound<'_>,
        prediction: Prediction,
        observer: &mut dyn Observer,
    ) -> Result<Meshed, MeshError> {
        observer.stage(Stage::Refine);
        let refine_options = RefineOptions {
            area,
            angle_min_deg: self.options.angle_min_deg,
            split_boundary: self.options.split_boundary,
            triangles_max: self.options.triangles_max,
            quantum: self.scale.quantum(),
        };
        let refined = refine(self.background, &refine_options, &mut |n| observer.progress(n))?;
        observer.stage(Stage::Collect);
        Ok(collect(refined, self.background, prediction, self.scale))
    }
}

/// From the bounds on areas; a bound on angles alone predicts nothing but the initial triangles.
fn predict(background: &Background, area: AreaBound<'_>) -> Prediction {
    let constant = if let AreaBound::Constant(area) = area { area } else { f64::INFINITY };
    let mut triangles = 0.0;
    let mesh = &background.triangulation;
    for t in mesh.triangles().filter(|&t| background.is_inside(t)) {
        let region = background.region(t).and_then(|r| r.area_max).unwrap_or(f64::INFINITY);
        let bound = constant.min(region);
        let own = area_of(mesh.corners(t).map(|v| background.points[v.index()]));
        // A triangle within its bound is one triangle, however small.
        triangles += if own > bound { TRIANGLES_PER_BOUND * own / bound } else { 1.0 };
    }
    Prediction { triangles, stopped: constant == f64::INFINITY }
}

fn area_of([a, b, c]: [Point2; 3]) -> f64 {
    0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x))
}

/// Plain arrays in the user's coordinates.
fn collect(
    refined: Refined,
    background: &Background,
    prediction: Prediction,
    scale: &Scale,
) -> Meshed {
    let Refined { mut points, mesh: topology, edges, mut spacing, stats } = refined;
    let renumber = Renumber::used(&topology, points.len());
    let edge = |e: crate::refine::RefinedEdge| MarkedEdge {
        vertices: e.vertices.map(|v| renumber.number(v.0)),
        marker: e.marker,
    };
    let edges = edges.into_iter().map(edge).collect();
    let regions = region_markers(&topology, background);
    let triangles = topology.into_triangles(|v| renumber.number(v.0));
    renumber.keep_points(&mut points, scale);
    if spacing.is_empty() {
        // No field, no wish.
        spacing = vec![f64::INFINITY; points.len()];
    } else {
        renumber.keep_spacing(&mut spacing, scale);
    }
    let mesh = Mesh { points, triangles, edges, regions };
    let splits = stats.splits as usize;
    Meshed {
        mesh,
        spacing,
        prediction,
        front: FrontStats::default(),
        improve: ImproveStats::default(),
        refine: Some(stats),
        splits,
        fit: None,
        grid: None,
    }
}
