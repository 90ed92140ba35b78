//! One patch: the background triangulation of its outline in (u, v), the front, improvement.

use super::chart::{Lift, SurfaceChart};
use super::defects::{Cloth, Defects};
use super::outline::{Node, Rim};
use super::smooth::Smoother;
use super::{SurfaceMeshError, flip};
use crate::background::{Background, OUTSIDE};
use crate::domain::validate::{Plc, PlcInside, PlcSegment};
use crate::front::{FrontMesh, FrontOptions, FrontStats, Start};
use crate::improve::ImproveOptions;
use crate::mesher::Options;
use crate::point::Point2;
use crate::size::{Prediction, predict};
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation};
use crate::vector::Vector;

/// A patch before the front.
pub(super) struct Draft<'a> {
    chart: SurfaceChart<'a>,
    background: Background,
    lifts: Vec<Lift>,
}

/// A patch with its mesh.
pub(super) struct PatchMesh {
    /// Parameters of the vertices.
    pub(super) parameters: Vec<[f64; 2]>,
    pub(super) lifts: Vec<Lift>,
    pub(super) mesh: Triangulation,
    pub(super) stats: FrontStats,
    pub(super) flips: u64,
    pub(super) moves: u64,
}

impl<'a> Draft<'a> {
    /// Triangulates the outline; `points` are those of the model's vertices.
    pub(super) fn new(
        chart: SurfaceChart<'a>,
        rim: &Rim,
        points: &[Vector],
        name: &str,
    ) -> Result<Self, SurfaceMeshError> {
        let nodes = &rim.nodes;
        let at: Vec<Point2> = nodes.iter().map(|n| chart.sheet.scaled(n.u, n.v)).collect();
        let count = at.len() as u32;
        let segments = rim.loops().flat_map(|range| {
            let (start, end) = (range.start as u32, range.end as u32);
            (start..end).map(move |i| {
                let next = if i + 1 == end { start } else { i + 1 };
                PlcSegment { vertices: [i, next], marker: 0, in_loop: true }
            })
        });
        let plc = Plc {
            points: at,
            point_markers: Vec::new(),
            segments: segments.collect(),
            inside: PlcInside::EvenOdd,
            regions: Vec::new(),
            vertex_of: (0..count).collect(),
        };
        let background = Background::new(&plc).map_err(|error| SurfaceMeshError::Outline {
            name: name.to_owned(),
            reason: error.to_string(),
        })?;
        let lift = |(node, &at): (&Node, &Point2)| Lift {
            point: points[node.vertex as usize],
            ..chart.sheet.lift(at)
        };
        let lifts = nodes.iter().zip(&background.points).map(lift).collect();
        Ok(Self { chart, background, lifts })
    }

    /// Predicts the number of triangles; stops soon after `limit`.
    pub(super) fn predict(&self, limit: f64) -> Prediction {
        let mesh = &self.background.triangulation;
        let inside = mesh.triangles().filter(|&t| mesh.tag(t) != OUTSIDE);
        let corners = |t: TriangleId| mesh.corners(t).map(|v| self.background.points[v.index()]);
        predict(inside.map(|t| (t, corners(t))), |_, p| self.flat_spacing(p), limit)
    }

    /// The spacing that asks for as many triangles in the plane of (u, v) as are wanted in space.
    fn flat_spacing(&self, p: Point2) -> f64 {
        let lift = self.chart.sheet.lift(p);
        self.chart.spacing_at(p, lift.point) / lift.form().area().sqrt()
    }

    /// Lays and improves the triangles.
    pub(super) fn mesh(
        self,
        options: &Options,
        vertices_max: usize,
        progress: &mut dyn FnMut(usize) -> bool,
    ) -> Result<PatchMesh, SurfaceMeshError> {
        let Self { chart, background, mut lifts } = self;
        let (mut region, _) = background.open_region();
        flip::towards_circles(&mut region, &background.points, &lifts);
        let edges = border(&region, background.points.len());
        let sites = background.points.iter().zip(&lifts);
        let spacing = sites.map(|(&at, lift)| chart.spacing_at(at, lift.point)).collect();
        let start = Start { points: background.points.clone(), region, edges, spacing };
        let front_options = FrontOptions {
            order: options.order,
            rules: options.rules,
            clamp: options.clamp,
            vertices_max,
            quantum: None,
        };
        let (laid, laid_lifts) =
            crate::front::advance_on(start, lifts, &chart, front_options, progress)?;
        lifts = laid_lifts;
        let FrontMesh { mut points, mut mesh, stats, .. } = laid;
        let fixed = background.points.len();
        let cloth = Cloth { mesh: &mut mesh, points: &mut points, lifts: &mut lifts };
        let [flips, moves] = improve(&chart, cloth, fixed, options.improve);
        let parameters = points.iter().map(|&p| chart.sheet.parameters(p)).collect();
        Ok(PatchMesh { parameters, lifts, mesh, stats, flips, moves })
    }
}

/// Flips and smooths, and changes the topology where the lattice has defects; returns the numbers of
/// flips and moves.
fn improve(
    chart: &SurfaceChart<'_>,
    mut cloth: Cloth<'_>,
    fixed: usize,
    options: ImproveOptions,
) -> [u64; 2] {
    let mut star = Smoother::new(chart, fixed, cloth.points.len());
    let done = star.settle(&mut cloth, options.sweeps);
    if options.passes == 0 || options.depth == 0 {
        return done;
    }
    let mut defects = Defects::new(chart, &cloth, fixed, options);
    for _ in 0..options.passes {
        if !defects.pass(&mut cloth) {
            break;
        }
    }
    if defects.books.changes == 0 {
        return done;
    }
    star.wake(&cloth, |v| defects.books.unsettled[v]);
    let more = star.settle(&mut cloth, options.sweeps);
    [done[0] + more[0], done[1] + more[1]]
}

/// The half-edge of each border edge, by its number: flips move them.
fn border(region: &Triangulation, count: usize) -> Vec<HalfEdgeId> {
    let mut edges = vec![HalfEdgeId(0); count];
    for e in region.triangles().flat_map(TriangleId::half_edges) {
        if let Across::Border(owner) = region.across(e) {
            edges[owner as usize] = e;
        }
    }
    edges
}
