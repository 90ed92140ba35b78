//! Where a mesh leaves its surface by more than was asked for, and how that is mended: by spacings for
//! another mesh, and by halving edges where that leaves a rest.
//!
//! Curvature says how far an equilateral triangle leaves the surface. Beside poles, where the
//! curvature changes fast, and where triangles are not equilateral, they leave it farther.

use super::chart::SurfaceChart;
use super::defects::Cloth;
use super::growth::Source;
use super::patch::PatchMesh;
use super::smooth::Smoother;
use super::trim::descend;
use crate::front::chart::{Chart, Site};
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::surface::Surface;
use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation, VertexId};
use crate::vector::{Vector, add, distance, scale};

/// A triangle that leaves the surface by the error allowed asks for this much less than its square
/// root law says, so that a few rounds do.
const SAFETY: f64 = 0.9;
/// Rounds of halving.
const ROUNDS: usize = 8;
/// Of these, rounds that flip and smooth what was halved; the others only halve, which always helps.
const ROUNDS_SMOOTHED: usize = 5;
/// Edges are halved rather than the patch meshed again when at most this part of the triangles is too
/// far away.
const FEW: f64 = 0.03;

/// A side of this part of the longest one is halved in its place.
const NOT_MUCH_SHORTER: f64 = 0.7;

/// How far a mesh may be from its surface.
#[derive(Clone, Copy)]
pub(super) struct Allowed<'a> {
    pub(super) limit: f64,
    /// No edge is asked for that is shorter than this.
    pub(super) floor: f64,
    /// Whether a vertex is a node of a curve that is cut as the model says.
    pub(super) is_kept: &'a (dyn Fn(usize) -> bool + Sync),
}

/// What is too far away.
#[derive(Clone, Debug, Default)]
pub(super) struct Excess {
    /// Spacings for the triangles.
    pub(super) sources: Vec<Source>,
    /// How many triangles cannot be mended by halving edges: those on the outline and at poles.
    pub(super) borders: usize,
    /// How many triangles have been measured.
    pub(super) measured: usize,
}

impl Excess {
    pub(super) fn join(&mut self, other: Self) {
        self.sources.extend(other.sources);
        self.borders += other.borders;
        self.measured += other.measured;
    }

    /// Whether halving some edges inside patches mends it.
    pub(super) fn is_local(&self) -> bool {
        self.borders == 0 && self.sources.len() as f64 <= FEW * self.measured as f64
    }
}

/// Spacings for the triangles of a patch that are farther from it than allowed.
pub(super) fn excess(chart: &SurfaceChart<'_>, patch: &PatchMesh, allowed: Allowed<'_>) -> Excess {
    let surface = chart.sheet.surface;
    let mut excess = Excess::default();
    let site = |v: usize| (patch.lifts[v].point, patch.parameters[v]);
    for t in patch.mesh.triangles() {
        excess.measured += 1;
        let found = Measured::new(surface, &patch.mesh, t, site, allowed);
        if found.worst() > allowed.limit {
            let at = patch.mesh.corners(t).map(|v| patch.lifts[v.index()].point);
            let (side, longest) = longest(at);
            let on_border = patch.mesh.twin(t.half_edge(side as u32)).is_none();
            let at_pole = patch.mesh.corners(t).iter().any(|v| patch.lifts[v.index()].is_pole());
            let is_far = found.border.iter().any(|&off| off > allowed.limit);
            excess.borders += usize::from(on_border || at_pole || is_far);
            let part = SAFETY * (allowed.limit / found.worst()).sqrt();
            let centre = mean([1.0 / 3.0; 3], at);
            // Triangles may be larger than the field wants them: then it has to want less than it does.
            let [u, v] = [0, 1].map(|i| {
                patch.mesh.corners(t).iter().map(|w| patch.parameters[w.index()][i]).sum::<f64>()
                    / 3.0
            });
            let wanted = chart.spacing_at(chart.sheet.scaled(u, v), centre);
            let spacing = (part * longest.min(wanted)).max(allowed.floor);
            excess.sources.push(Source { at: centre, spacing });
        }
    }
    excess
}

/// Distances of a triangle from the surface: at its centre and in the middles of its sides.
struct Measured {
    inside: f64,
    /// Of the sides on the outline that may be cut anew.
    border: [f64; 3],
}

impl Measured {
    fn new(
        surface: &Surface,
        mesh: &Triangulation,
        t: TriangleId,
        site: impl Fn(usize) -> (Vector, [f64; 2]),
        allowed: Allowed<'_>,
    ) -> Self {
        let corners = mesh.corners(t).map(|v| v.index());
        let sites = corners.map(site);
        let (at, uv) = (sites.map(|s| s.0), sites.map(|s| s.1));
        if at[0] == at[1] || at[1] == at[2] || at[2] == at[0] {
            // At a pole: it will be left out.
            return Self { inside: 0.0, border: [0.0; 3] };
        }
        if corners.iter().any(|&v| (allowed.is_kept)(v)) {
            // It is as large as the model asks for.
            return Self { inside: 0.0, border: [0.0; 3] };
        }
        let off = |weights: [f64; 3]| deviation(surface, weights, (at, uv), allowed.limit);
        let mut found = Self { inside: off([1.0 / 3.0; 3]), border: [0.0; 3] };
        for (i, e) in t.half_edges().into_iter().enumerate() {
            let mut weights = [0.5; 3];
            weights[(i + 2) % 3] = 0.0;
            match mesh.twin(e) {
                Some(_) => found.inside = found.inside.max(off(weights)),
                None => found.border[i] = off(weights),
            }
        }
        found
    }

    fn worst(&self) -> f64 {
        self.border.iter().copied().fold(self.inside, f64::max)
    }
}

/// The longest side of a triangle, and its length.
fn longest(at: [Vector; 3]) -> (usize, f64) {
    let lengths = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| distance(at[i], at[j]));
    let mut side = 0;
    for i in 1..3 {
        if lengths[i] > lengths[side] {
            side = i;
        }
    }
    (side, lengths[side])
}

fn mean([r, s, t]: [f64; 3], [a, b, c]: [Vector; 3]) -> Vector {
    add(scale(r, a), add(scale(s, b), scale(t, c)))
}

/// Distance of a point of a triangle from the surface, whose nearest point is searched for from the
/// same mean of the parameters; where that is no good, as beside poles, from the corners too.
fn deviation(
    surface: &Surface,
    weights: [f64; 3],
    (at, uv): ([Vector; 3], [[f64; 2]; 3]),
    limit: f64,
) -> f64 {
    let p = mean(weights, at);
    let part = |i: usize| (0..3).map(|k| weights[k] * uv[k][i]).sum();
    let off = |from: [f64; 2]| {
        let [u, v] = descend(surface, from, p);
        distance(surface.at(u, v), p)
    };
    let found = off([part(0), part(1)]);
    if found <= limit { found } else { uv.into_iter().map(off).fold(found, f64::min) }
}

/// Halves edges inside a patch until no triangle is farther from the surface than allowed; vertices
/// below `fixed` do not move. Returns the number of edges halved.
pub(super) fn halve(
    chart: &SurfaceChart<'_>,
    patch: &mut PatchMesh,
    fixed: usize,
    allowed: Allowed<'_>,
) -> u64 {
    let PatchMesh { mesh, lifts, parameters, .. } = patch;
    let mut points: Vec<Point2> =
        parameters.iter().map(|&[u, v]| chart.sheet.scaled(u, v)).collect();
    let mut halved = 0;
    for round in 0..ROUNDS {
        let mut cloth = Cloth { mesh: &mut *mesh, points: &mut points, lifts: &mut *lifts };
        let before = cloth.points.len();
        let far = too_far(chart, &cloth, allowed);
        for (corners, t) in far {
            if cloth.mesh.is_live(t) && cloth.mesh.corners(t) == corners {
                halve_longest(chart, &mut cloth, t, allowed.floor);
            }
        }
        let count = cloth.points.len();
        if count == before {
            break;
        }
        halved += (count - before) as u64;
        if round < ROUNDS_SMOOTHED {
            let mut star = Smoother::resting(chart, fixed, count);
            star.wake(&cloth, |v| v >= before);
            star.settle(&mut cloth, 2);
        }
    }
    *parameters = points.iter().map(|&p| chart.sheet.parameters(p)).collect();
    halved
}

/// The triangles that are too far from the surface.
fn too_far(
    chart: &SurfaceChart<'_>,
    cloth: &Cloth<'_>,
    allowed: Allowed<'_>,
) -> Vec<([VertexId; 3], TriangleId)> {
    let site = |v: usize| (cloth.lifts[v].point, chart.sheet.parameters(cloth.points[v]));
    let surface = chart.sheet.surface;
    let is_far = |t: &TriangleId| {
        Measured::new(surface, cloth.mesh, *t, site, allowed).inside > allowed.limit
    };
    let far = cloth.mesh.triangles().filter(is_far);
    far.map(|t| (cloth.mesh.corners(t), t)).collect()
}

/// Halves the longest side of a triangle: no angle is then less than half of the smallest before
/// (Rosenberg and Stenger, 1975). Where that is an edge of the outline, the next one, if it is not
/// much shorter.
fn halve_longest(chart: &SurfaceChart<'_>, cloth: &mut Cloth<'_>, t: TriangleId, floor: f64) {
    let ends = |e: HalfEdgeId| [cloth.mesh.origin(e), cloth.mesh.dest(e)].map(|v| v.index());
    let length = |e: HalfEdgeId| {
        let [a, b] = ends(e).map(|v| cloth.lifts[v].point);
        distance(a, b)
    };
    let mut sides = t.half_edges().map(|e| (length(e), e));
    sides.sort_by(|s, t| t.0.total_cmp(&s.0));
    let least = (NOT_MUCH_SHORTER * sides[0].0).max(2.0 * floor);
    let sides = sides.into_iter().filter(|(length, _)| *length > least);
    for (e, twin) in sides.filter_map(|(_, e)| Some((e, cloth.mesh.twin(e)?))) {
        let [a, b] = ends(e).map(|v| Site { at: cloth.points[v], lift: cloth.lifts[v] });
        let Some(middle) = middle(chart, [a, b]) else { continue };
        let outer = [e.next(), e.prev(), twin.next(), twin.prev()];
        let sees = |&h: &HalfEdgeId| {
            let [p, q] = ends(h).map(|v| cloth.points[v]);
            orient2d(p, q, middle.at) == Sign::Positive
        };
        if outer.iter().all(sees) {
            let v = VertexId(cloth.points.len() as u32);
            cloth.points.push(middle.at);
            cloth.lifts.push(middle.lift);
            cloth.mesh.split_edge(e, v);
            return;
        }
    }
}

/// The place on the surface over the middle of an edge.
fn middle(
    chart: &SurfaceChart<'_>,
    [a, b]: [Site<super::chart::Lift>; 2],
) -> Option<Site<super::chart::Lift>> {
    let frame = chart.frame([a, b])?;
    let half = 0.5 * distance(a.lift.point, b.lift.point);
    chart.place(&frame, Point2::new(half, 0.0))
}
