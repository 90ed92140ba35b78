//! Smoothing: each movable vertex takes a step towards the place where its triangles are best.
//!
//! The energy of a vertex is the sum over its triangles of f^2, where f = (sum of squared sides) /
//! (4 sqrt(3) area) is the inverse mean ratio (Knupp, "Algebraic mesh quality metrics", 2001): 1 for
//! an equilateral triangle, infinite for a flat one, smooth between, and free of square roots. One
//! Newton step on it costs about as much as evaluating it twice.

use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation, VertexId};

/// What a sweep did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SmoothStats {
    /// Vertices that moved.
    pub moves: u64,
}

/// One sweep over the vertices from `fixed` on, in index order.
///
/// A vertex moves only if every triangle around it stays strictly counterclockwise (exact), the
/// energy falls, and the worst of its triangles does not get worse.
pub fn smooth(mesh: &Triangulation, points: &mut [Point2], fixed: usize) -> SmoothStats {
    let outgoing = outgoing(mesh, points.len());
    let mut stats = SmoothStats::default();
    let mut link = Vec::with_capacity(16);
    for v in fixed..points.len() {
        if let Some(e) = outgoing[v]
            && around(mesh, points, e, &mut link)
            && let Some(place) = better_place(points[v], &link)
        {
            points[v] = place;
            stats.moves += 1;
        }
    }
    stats
}

/// A half-edge out of each vertex.
fn outgoing(mesh: &Triangulation, vertices: usize) -> Vec<Option<HalfEdgeId>> {
    let mut outgoing = vec![None; vertices];
    for t in 0..mesh.slot_count() as u32 {
        let t = TriangleId(t);
        if mesh.is_live(t) {
            let corners: [VertexId; 3] = mesh.corners(t);
            for (e, v) in t.half_edges().into_iter().zip(corners) {
                outgoing[v.index()] = Some(e);
            }
        }
    }
    outgoing
}

/// Fills `link` with the polygon around the origin of `e`; `false` when it is on the border.
fn around(
    mesh: &Triangulation,
    points: &[Point2],
    start: HalfEdgeId,
    link: &mut Vec<Point2>,
) -> bool {
    link.clear();
    let mut e = start;
    loop {
        link.push(points[mesh.dest(e).index()]);
        match mesh.rotate_ccw(e) {
            None => return false,
            Some(next) if next == start => return true,
            Some(next) => e = next,
        }
    }
}

/// Energy, its gradient and Hessian, and the worst inverse mean ratio (unscaled) of a star.
struct Energy {
    value: f64,
    worst: f64,
    gradient: [f64; 2],
    hessian: [f64; 3],
}

fn energy(v: Point2, link: &[Point2]) -> Energy {
    let mut sum = Energy { value: 0.0, worst: 0.0, gradient: [0.0; 2], hessian: [0.0; 3] };
    for (i, &u) in link.iter().enumerate() {
        let w = link[if i + 1 == link.len() { 0 } else { i + 1 }];
        sum.add(v, u, w);
    }
    sum
}

impl Energy {
    /// Adds the triangle (v, u, w): f = q / a with q the squared sides and a twice the area.
    fn add(&mut self, v: Point2, u: Point2, w: Point2) {
        let (ux, uy, wx, wy) = (u.x - v.x, u.y - v.y, w.x - v.x, w.y - v.y);
        let (ex, ey) = (wx - ux, wy - uy);
        let q = ux * ux + uy * uy + wx * wx + wy * wy + ex * ex + ey * ey;
        let a = ux * wy - uy * wx;
        let f = q / a;
        // d(2 area)/dv is the edge u -> w turned a quarter: (-ey, ex); dq/dv = -2 (u + w - 2 v).
        let (ax, ay) = (-ey, ex);
        let gx = (-2.0 * (ux + wx) - f * ax) / a;
        let gy = (-2.0 * (uy + wy) - f * ay) / a;
        let (hxx, hyy) = ((4.0 - 2.0 * gx * ax) / a, (4.0 - 2.0 * gy * ay) / a);
        let hxy = -(gx * ay + gy * ax) / a;
        self.value += f * f;
        self.worst = if a > 0.0 { self.worst.max(f) } else { f64::INFINITY };
        self.gradient[0] += f * gx;
        self.gradient[1] += f * gy;
        self.hessian[0] += gx * gx + f * hxx;
        self.hessian[1] += gx * gy + f * hxy;
        self.hessian[2] += gy * gy + f * hyy;
    }

    /// The Newton step, or `None` where the energy is not convex.
    fn step(&self) -> Option<[f64; 2]> {
        let [xx, xy, yy] = self.hessian;
        let [gx, gy] = self.gradient;
        let determinant = xx * yy - xy * xy;
        (determinant > 0.0 && xx > 0.0)
            .then(|| [(xy * gy - yy * gx) / determinant, (xy * gx - xx * gy) / determinant])
    }
}

/// Steps shorter than this fraction of the distance to the first neighbour are not worth a move.
const STEP_MIN: f64 = 1e-3;
/// Newton's step, then halves of it.
const TRIES: u32 = 3;

/// A place for the vertex `v` in its link that is better and valid, if a step finds one.
fn better_place(v: Point2, link: &[Point2]) -> Option<Point2> {
    let now = energy(v, link);
    let [mut dx, mut dy] = now.step()?;
    let reach_sq = v.distance_sq(link[0]);
    for _ in 0..TRIES {
        if dx * dx + dy * dy < STEP_MIN * STEP_MIN * reach_sq {
            return None;
        }
        let place = Point2::new(v.x + dx, v.y + dy);
        let then = energy(place, link);
        if then.value < now.value && then.worst <= now.worst && is_valid(place, link) {
            return Some(place);
        }
        (dx, dy) = (0.5 * dx, 0.5 * dy);
    }
    None
}

/// Whether all triangles of the star are strictly counterclockwise, exactly.
fn is_valid(v: Point2, link: &[Point2]) -> bool {
    v.is_finite()
        && (0..link.len())
            .all(|i| orient2d(v, link[i], link[(i + 1) % link.len()]) == Sign::Positive)
}
