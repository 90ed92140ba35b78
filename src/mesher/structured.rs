//! The methods transfinite and elliptic: a structured grid in place of the front.

use super::scale::Scale;
use super::{MeshError, Meshed, Observer, Options, Stage};
use crate::background::Background;
use crate::domain::validate::Plc;
use crate::front::{FrontError, FrontStats};
use crate::improve::ImproveStats;
use crate::mesh::{MarkedEdge, Mesh};
use crate::point::Point2;
use crate::size::Prediction;
use crate::structured::{
    Folded, Grid, GridMethod, GridStats, Plane, Sides, fractions, relax, transfinite,
};
use crate::vector::Vector;
use std::collections::BTreeMap;

/// Why a domain has no grid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GridError {
    /// More than one boundary loop.
    #[error(
        "a grid needs a domain with one boundary loop, without holes and pinches; this one is no \
         such loop near {at}"
    )]
    Loops {
        /// A vertex off the first loop, or on it twice.
        at: Point2,
    },
    /// Interior constraints or points.
    #[error("a grid needs a domain without constraints and points inside; there is one at {at}")]
    Constraint {
        /// Where.
        at: Point2,
    },
    /// A corner that is no vertex of the boundary.
    #[error(
        "corner {index} is not a vertex of the boundary; vertices count from 0 in the file's order"
    )]
    Corner {
        /// As given.
        index: u32,
    },
    /// Two corners in one place.
    #[error("corner {index} is given twice")]
    Repeated {
        /// As given.
        index: u32,
    },
    /// The four sharpest vertices are not told from the rest.
    #[error(
        "the boundary has no four sharpest vertices: the angles at {fourth} and {fifth} are both \
         {angle_deg:.1} degrees; name the corners with --corners I,J,K,L"
    )]
    Ambiguous {
        /// The fourth sharpest.
        fourth: Point2,
        /// As sharp.
        fifth: Point2,
        /// Interior angle there.
        angle_deg: f64,
    },
    /// Opposite sides of different length.
    #[error(
        "between the corners {corners:?} the boundary has {} and {} segments on one pair of \
         opposite sides, {} and {} on the other: opposite sides need equal numbers; cut the \
         boundary so, or name other corners with --corners I,J,K,L",
        .counts[0], .counts[2], .counts[1], .counts[3]
    )]
    Counts {
        /// Where the corners are.
        corners: [[f64; 2]; 4],
        /// Segments of south, east, north, west.
        counts: [usize; 4],
    },
    /// Cells turned over.
    #[error(
        "the grid folds: {count} of its cells have no diagonal with both triangles counterclockwise, \
         the first in column {column} and row {row} near {at}; {advice}"
    )]
    Folded {
        /// How many.
        count: usize,
        /// Column of the first, from 0.
        column: usize,
        /// Row of the first, from 0.
        row: usize,
        /// Centre of its corners.
        at: Point2,
        /// What to do.
        advice: &'static str,
    },
}

/// Angles closer than this are equal: a choice of corners, not of validity.
const SAME_ANGLE_DEG: f64 = 0.1;

/// Meshes a domain with four sides.
pub(super) fn mesh(
    background: &Background,
    plc: &Plc,
    method: GridMethod,
    options: &Options,
    (scale, observer): (&Scale, &mut dyn Observer),
) -> Result<Meshed, MeshError> {
    observer.stage(Stage::Size);
    let around = boundary_loop(background, scale)?;
    let points: Vec<Point2> = around.iter().map(|&v| background.points[v as usize]).collect();
    let corners = corners(plc, &around, &points, options.corners, scale)?;
    let sides = Sides::of_loop(&around, corners);
    let counts = sides.counts();
    if counts[0] != counts[2] || counts[1] != counts[3] {
        let corners = corners.map(|k| scale.grow(points[k]).into());
        return Err(GridError::Counts { corners, counts }.into());
    }
    let triangles = 2.0 * counts[0] as f64 * counts[1] as f64;
    if triangles > options.triangles_max as f64 {
        let limit = options.triangles_max;
        return Err(MeshError::TooMany { predicted: triangles, stopped: false, limit });
    }
    let prediction = Prediction { triangles, stopped: false };
    if !observer.predicted(prediction) {
        return Err(FrontError::Stopped.into());
    }
    observer.stage(Stage::Grid);
    let at = sides.map(|v| background.points[v as usize]);
    let (grid, stats) = lay(&at, method, scale);
    let folded = |folded| named(&grid, folded, method, scale);
    let space: Vec<Vector> = grid.points.iter().map(|p| [p.x, p.y, 0.0]).collect();
    let triangles = grid.triangles(&space).map_err(folded)?;
    observer.stage(Stage::Collect);
    let mesh = collect(&grid, &sides, triangles, background, scale);
    Ok(Meshed {
        spacing: vec![f64::INFINITY; mesh.points.len()],
        mesh,
        prediction,
        front: FrontStats::default(),
        improve: ImproveStats::default(),
        refine: None,
        splits: 0,
        fit: None,
        grid: Some(stats),
    })
}

/// The grid and how it came out.
fn lay(sides: &Sides<Point2>, method: GridMethod, scale: &Scale) -> (Grid, GridStats) {
    let of = |side: &[Point2]| fractions(side, Point2::distance);
    let Sides { south, east, north, west } = sides;
    let along = Sides { south: of(south), east: of(east), north: of(north), west: of(west) };
    let mut grid = transfinite(sides, &along);
    let relaxed = (method == GridMethod::Elliptic).then(|| relax(&mut grid, &Plane));
    if let Some(quantum) = scale.quantum() {
        let rounded: Vec<Point2> = grid.points.iter().map(|p| p.rounded_to(quantum)).collect();
        grid.points = grid.with_sides(sides, &rounded);
    }
    let stats = GridStats { columns: grid.columns, rows: grid.rows, relaxed };
    (grid, stats)
}

fn named(grid: &Grid, folded: Folded, method: GridMethod, scale: &Scale) -> GridError {
    let Folded { count, column, row } = folded;
    let corners = grid.cell(column, row).map(|v| scale.grow(grid.points[v]));
    let centre = |of: fn(Point2) -> f64| corners.iter().map(|&p| 0.25 * of(p)).sum::<f64>();
    let advice = match method {
        GridMethod::Transfinite => "`--method elliptic` often mends it",
        GridMethod::Elliptic => "cut the domain in parts, or take another method",
    };
    GridError::Folded {
        count,
        column,
        row,
        at: Point2::new(centre(|p| p.x), centre(|p| p.y)),
        advice,
    }
}

/// The vertices of the only boundary loop, counterclockwise.
fn boundary_loop(background: &Background, scale: &Scale) -> Result<Vec<u32>, GridError> {
    let place = |v: u32| scale.grow(background.points[v as usize]);
    let (boundary, interior) = background.edges.split_at(background.boundary_count);
    if let Some(edge) = interior.first() {
        return Err(GridError::Constraint { at: place(edge.vertices[0].0) });
    }
    let mut next = BTreeMap::new();
    for edge in boundary {
        let [a, b] = edge.vertices.map(|v| v.0);
        if next.insert(a, b).is_some() {
            return Err(GridError::Loops { at: place(a) });
        }
    }
    let start = boundary[0].vertices[0].0;
    let mut around = vec![start];
    while let Some(v) = next.remove(&around[around.len() - 1]).filter(|&v| v != start) {
        around.push(v);
    }
    if let Some((&v, _)) = next.first_key_value() {
        return Err(GridError::Loops { at: place(v) });
    }
    let mut on_loop = vec![false; background.points.len()];
    around.iter().for_each(|&v| on_loop[v as usize] = true);
    let mesh = &background.triangulation;
    let inside = mesh.triangles().filter(|&t| background.is_inside(t));
    match inside.flat_map(|t| mesh.corners(t)).find(|v| !on_loop[v.index()]) {
        Some(v) => Err(GridError::Constraint { at: place(v.0) }),
        None => Ok(around),
    }
}

/// Positions of the four corners on the loop, rising; the first is the first one given, or else
/// the first on the loop.
fn corners(
    plc: &Plc,
    around: &[u32],
    points: &[Point2],
    given: Option<[u32; 4]>,
    scale: &Scale,
) -> Result<[usize; 4], GridError> {
    let Some(given) = given else { return sharpest(points, scale) };
    let mut positions = [0; 4];
    for (k, &index) in given.iter().enumerate() {
        let vertex = plc.vertex_of.get(index as usize).copied();
        let position = vertex.and_then(|v| around.iter().position(|&w| w == v));
        positions[k] = position.ok_or(GridError::Corner { index })?;
        if positions[..k].contains(&positions[k]) {
            return Err(GridError::Repeated { index });
        }
    }
    let first = positions[0];
    positions.sort_by_key(|&position| (position + around.len() - first) % around.len());
    Ok(positions)
}

/// The four vertices with the sharpest interior angles.
fn sharpest(points: &[Point2], scale: &Scale) -> Result<[usize; 4], GridError> {
    let count = points.len();
    let angle = |k: usize| {
        let [a, p, b] = [points[(k + count - 1) % count], points[k], points[(k + 1) % count]];
        let (ux, uy, vx, vy) = (b.x - p.x, b.y - p.y, a.x - p.x, a.y - p.y);
        let turn = libm::atan2(ux * vy - uy * vx, ux * vx + uy * vy).to_degrees();
        if turn < 0.0 { turn + 360.0 } else { turn }
    };
    let mut order: Vec<(f64, usize)> = (0..count).map(|k| (angle(k), k)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    if count < 4 {
        let at = |k: usize| scale.grow(points[k.min(count - 1)]);
        return Err(GridError::Loops { at: at(0) });
    }
    if count > 4 && order[4].0 - order[3].0 < SAME_ANGLE_DEG {
        let [fourth, fifth] = [order[3].1, order[4].1].map(|k| scale.grow(points[k]));
        return Err(GridError::Ambiguous { fourth, fifth, angle_deg: order[3].0 });
    }
    let mut corners = [order[0].1, order[1].1, order[2].1, order[3].1];
    corners.sort_unstable();
    Ok(corners)
}

/// Plain arrays in the user's coordinates.
fn collect(
    grid: &Grid,
    sides: &Sides<u32>,
    triangles: Vec<[u32; 3]>,
    background: &Background,
    scale: &Scale,
) -> Mesh {
    let owners = grid.with_sides(sides, &vec![u32::MAX; grid.points.len()]);
    let mut number = vec![0; background.points.len()];
    for (i, &owner) in owners.iter().enumerate().filter(|(_, owner)| **owner != u32::MAX) {
        number[owner as usize] = i as u32;
    }
    let edge = |edge: &crate::background::FrontEdge| MarkedEdge {
        vertices: edge.vertices.map(|v| number[v.index()]),
        marker: edge.marker,
    };
    Mesh {
        points: grid.points.iter().map(|&p| scale.grow(p)).collect(),
        regions: match background.regions.first() {
            Some(region) => vec![region.marker; triangles.len()],
            None => Vec::new(),
        },
        triangles,
        edges: background.edges.iter().map(edge).collect(),
    }
}
