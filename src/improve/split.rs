//! Splitting of edges much longer than the spacing wanted at their middle.
//!
//! The front follows its field from one layer to the next. Where the boundary is coarser than the
//! field by more than the layers can make up for before fronts meet, triangles are left that are
//! too large: their longest edges are halved until none is.

use super::flip::flip_suspects;
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation, VertexId};

/// Edges longer than this many spacings are split: the halves are then as much too short as the
/// whole was too long, and no shorter than the edges that a front lays.
const SPLIT: f64 = 1.45;

/// An edge is left whole whose middle is nearer to a third corner than this fraction of its half.
const APEX_MIN: f64 = 0.5;

/// Where new points may be, and how many.
#[derive(Clone, Copy, Debug)]
pub struct SplitOptions {
    /// New coordinates are multiples of this power of two.
    pub quantum: Option<f64>,
    /// Points of the mesh at which splitting stops.
    pub points_max: usize,
}

/// Halves every unconstrained edge that is the longest such edge of one of its triangles and longer than 1.45
/// times `wanted` (of the triangle's tag and the edge's middle), longest first, and restores the
/// constrained Delaunay triangulation after each, until there is none; returns the number of new
/// points, or `None` when `points_max` is passed.
///
/// An edge whose middle is too near to a third corner is left whole. Ends: with a field bounded from
/// below points keep a distance; the limit bounds them in any case.
pub fn split_long_edges(
    mesh: &mut Triangulation,
    points: &mut Vec<Point2>,
    spacing: &mut Vec<f64>,
    mut wanted: impl FnMut(u32, Point2) -> f64,
    options: SplitOptions,
) -> Option<u64> {
    let mut splits = 0;
    loop {
        let mut long = long_edges(mesh, points, &mut wanted);
        long.sort_by(|s, t| t.length.total_cmp(&s.length).then(s.edge.cmp(&t.edge)));
        let before = splits;
        for entry in &long {
            if entry.is_there(mesh) && split(mesh, points, entry.edge, options.quantum) {
                spacing.push(entry.wanted);
                splits += 1;
            }
            if points.len() > options.points_max {
                return None;
            }
        }
        if splits == before {
            return Some(splits);
        }
    }
}

/// An edge that is too long.
struct Long {
    length: f64,
    wanted: f64,
    edge: HalfEdgeId,
    ends: [VertexId; 2],
}

impl Long {
    /// Whether flips have left the edge in its place.
    fn is_there(&self, mesh: &Triangulation) -> bool {
        [mesh.origin(self.edge), mesh.dest(self.edge)] == self.ends
            && !mesh.is_constrained(self.edge)
    }
}

fn long_edges(
    mesh: &Triangulation,
    points: &[Point2],
    wanted: &mut impl FnMut(u32, Point2) -> f64,
) -> Vec<Long> {
    let length =
        |e: HalfEdgeId| points[mesh.origin(e).index()].distance(points[mesh.dest(e).index()]);
    // Constraints are not split: beside them the longest of the other edges counts.
    let is_longest = |t: TriangleId, most: f64| {
        t.half_edges().iter().all(|&h| mesh.is_constrained(h) || length(h) <= most)
    };
    let mut long = Vec::new();
    for e in mesh.triangles().flat_map(TriangleId::half_edges) {
        let Some(twin) = mesh.twin(e).filter(|f| e < *f && !mesh.is_constrained(e)) else {
            continue;
        };
        let own = length(e);
        if is_longest(e.triangle(), own) || is_longest(twin.triangle(), own) {
            let wanted = wanted(mesh.tag(e.triangle()), middle(mesh, points, e));
            if own > SPLIT * wanted {
                let ends = [mesh.origin(e), mesh.dest(e)];
                long.push(Long { length: own, wanted, edge: e, ends });
            }
        }
    }
    long
}

fn middle(mesh: &Triangulation, points: &[Point2], e: HalfEdgeId) -> Point2 {
    let [p, q] = [mesh.origin(e), mesh.dest(e)].map(|v| points[v.index()]);
    Point2::new(0.5 * p.x + 0.5 * q.x, 0.5 * p.y + 0.5 * q.y)
}

/// Splits an edge at its middle, if the four triangles are strictly counterclockwise.
fn split(
    mesh: &mut Triangulation,
    points: &mut Vec<Point2>,
    e: HalfEdgeId,
    quantum: Option<f64>,
) -> bool {
    let Some(f) = mesh.twin(e) else { return false };
    let m = middle(mesh, points, e);
    let m = quantum.map_or(m, |q| m.rounded_to(q));
    let outer = [e.next(), e.prev(), f.next(), f.prev()];
    let sees = |h: HalfEdgeId| {
        let [p, q] = [mesh.origin(h), mesh.dest(h)].map(|v| points[v.index()]);
        orient2d(p, q, m) == Sign::Positive
    };
    let reach_sq = (APEX_MIN * points[mesh.origin(e).index()].distance(m)).powi(2);
    let is_clear = [e, f].iter().all(|&h| points[mesh.apex(h).index()].distance_sq(m) >= reach_sq);
    if !is_clear || !outer.into_iter().all(sees) {
        return false;
    }
    let v = VertexId(points.len() as u32);
    points.push(m);
    let mut suspects = mesh.split_edge(e, v);
    flip_suspects(mesh, points, &mut suspects, |_, _| ());
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The unit square as two triangles, counterclockwise.
    fn square() -> (Triangulation, Vec<Point2>, Vec<f64>) {
        let mut mesh = Triangulation::default();
        let v = [0, 1, 2, 3].map(VertexId);
        let lower = mesh.add([v[0], v[1], v[2]]);
        let upper = mesh.add([v[0], v[2], v[3]]);
        mesh.link(lower.half_edge(2), upper.half_edge(0));
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point2::from).to_vec();
        (mesh, points, vec![1.0; 4])
    }

    const FREE: SplitOptions = SplitOptions { quantum: None, points_max: 10_000 };

    // spec: I7
    #[test]
    fn no_edge_inside_that_is_longest_stays_too_long() {
        let (mut mesh, mut points, mut spacing) = square();
        let wanted = |_: u32, p: Point2| 0.05 + 0.7 * p.x.min(p.y).min(1.0 - p.x).min(1.0 - p.y);
        let wanted = |t: u32, p: Point2| (0.6 - wanted(t, p)).max(0.1);
        let splits = split_long_edges(&mut mesh, &mut points, &mut spacing, wanted, FREE);
        assert!(splits.is_some_and(|splits| splits > 4), "{splits:?}");
        assert_eq!(points.len(), spacing.len());
        assert!(long_edges(&mesh, &points, &mut { wanted }).is_empty());
        for t in mesh.triangles() {
            let [a, b, c] = mesh.corners(t).map(|v| points[v.index()]);
            assert_eq!(orient2d(a, b, c), Sign::Positive);
        }
        // The border has not been touched.
        let borders = mesh.triangles().flat_map(TriangleId::half_edges);
        assert_eq!(borders.filter(|&e| mesh.twin(e).is_none()).count(), 4);
    }

    // spec: !I7
    #[test]
    fn too_fine_a_field_stops_at_the_limit() {
        let (mut mesh, mut points, mut spacing) = square();
        let limit = SplitOptions { points_max: 50, ..FREE };
        let splits = split_long_edges(&mut mesh, &mut points, &mut spacing, |_, _| 1e-6, limit);
        assert_eq!(splits, None);
        assert!(points.len() <= 51);
    }
}
