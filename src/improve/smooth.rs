//! Smoothing: each movable vertex takes a step towards the place where its triangles are best.
//!
//! The energy of a vertex is the sum over its triangles of f^2, where f = (sum of squared sides) /
//! (4 sqrt(3) area) is the inverse mean ratio (Knupp, "Algebraic mesh quality metrics", 2001): 1 for
//! an equilateral triangle, infinite for a flat one, smooth between, and free of square roots. One
//! Newton step on it costs about as much as evaluating it twice.

use super::flip::{flip_suspects, flip_to_delaunay};
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation, VertexId};

/// The mesh under improvement, and which of its vertices are worth another look.
pub(super) struct Smoother<'a> {
    mesh: &'a mut Triangulation,
    points: &'a mut [Point2],
    /// Vertices below this index never move.
    fixed: usize,
    /// New coordinates are multiples of this power of two.
    quantum: Option<f64>,
    /// A half-edge out of each vertex.
    outgoing: Vec<Option<HalfEdgeId>>,
    /// Vertices whose star has changed since they were last looked at.
    active: Vec<bool>,
    link: Vec<Point2>,
    link_vertices: Vec<VertexId>,
    suspects: Vec<HalfEdgeId>,
}

impl<'a> Smoother<'a> {
    pub(super) fn new(
        mesh: &'a mut Triangulation,
        points: &'a mut [Point2],
        fixed: usize,
        quantum: Option<f64>,
    ) -> Self {
        let outgoing = outgoing(mesh, points.len());
        let active = vec![true; points.len()];
        let (link, link_vertices, suspects) = (Vec::new(), Vec::new(), Vec::new());
        Self { mesh, points, fixed, quantum, outgoing, active, link, link_vertices, suspects }
    }

    /// One sweep over the active vertices in index order; returns the number of moves. Edges that
    /// a move makes suspect wait for [`flip`](Self::flip).
    ///
    /// A vertex moves only if every triangle around it stays strictly counterclockwise (exact), the
    /// energy falls, and the worst of its triangles does not get worse.
    pub(super) fn sweep(&mut self) -> u64 {
        let mut moves = 0;
        for v in self.fixed..self.points.len() {
            if !std::mem::take(&mut self.active[v]) {
                continue;
            }
            let Some(start) = self.outgoing[v].filter(|&e| self.gather_link(e)) else { continue };
            if let Some(place) = better_place(self.points[v], &self.link, self.quantum) {
                self.points[v] = place;
                moves += 1;
                self.active[v] = true;
                for &u in &self.link_vertices {
                    self.active[u.index()] = true;
                }
                self.suspect_star(start);
            }
        }
        moves
    }

    /// All edges of the mesh are flipped to Delaunay: for the first time, when all are suspect.
    pub(super) fn flip_all(&mut self) -> u64 {
        self.suspects.clear();
        let flips = flip_to_delaunay(self.mesh, self.points);
        self.outgoing = outgoing(self.mesh, self.points.len());
        flips
    }

    /// Flips the edges made suspect by the last sweep.
    pub(super) fn flip(&mut self) -> u64 {
        let (outgoing, active) = (&mut self.outgoing, &mut self.active);
        flip_suspects(self.mesh, self.points, &mut self.suspects, |mesh, e| {
            let f = mesh.twin(e).expect("a flipped edge has two sides");
            for g in [e, e.next(), e.prev(), f.prev()] {
                let v = mesh.origin(g).index();
                outgoing[v] = Some(g);
                active[v] = true;
            }
        })
    }

    /// Sum of squared inverse mean ratios above 1.
    pub(super) fn excess(&self) -> f64 {
        let excess = |t: TriangleId| {
            let [a, b, c] = self.mesh.corners(t).map(|v| self.points[v.index()]);
            let f = inverse_mean_ratio(a, b, c);
            f * f - 1.0
        };
        self.mesh.triangles().map(excess).sum()
    }

    fn suspect_star(&mut self, start: HalfEdgeId) {
        let mut e = start;
        loop {
            self.suspects.extend([e, e.next()]);
            match self.mesh.rotate_ccw(e) {
                Some(next) if next != start => e = next,
                _ => return,
            }
        }
    }

    /// Fills `link` with the polygon around the origin of `start`; `false` on the border.
    fn gather_link(&mut self, start: HalfEdgeId) -> bool {
        self.link.clear();
        self.link_vertices.clear();
        let mut e = start;
        loop {
            let u = self.mesh.dest(e);
            self.link_vertices.push(u);
            self.link.push(self.points[u.index()]);
            match self.mesh.rotate_ccw(e) {
                None => return false,
                Some(next) if next == start => return true,
                Some(next) => e = next,
            }
        }
    }
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

/// The inverse mean ratio of a triangle, at least 1; infinite for one that is not counterclockwise.
pub(super) fn inverse_mean_ratio(a: Point2, b: Point2, c: Point2) -> f64 {
    const TWO_SQRT_3: f64 = 3.464_101_615_137_754_6;
    let double_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    let squares = a.distance_sq(b) + b.distance_sq(c) + c.distance_sq(a);
    if double_area > 0.0 { squares / (TWO_SQRT_3 * double_area) } else { f64::INFINITY }
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
fn better_place(v: Point2, link: &[Point2], quantum: Option<f64>) -> Option<Point2> {
    let now = energy(v, link);
    let [mut dx, mut dy] = now.step()?;
    let reach_sq = v.distance_sq(link[0]);
    for _ in 0..TRIES {
        if dx * dx + dy * dy < STEP_MIN * STEP_MIN * reach_sq {
            return None;
        }
        let place = Point2::new(v.x + dx, v.y + dy);
        let place = quantum.map_or(place, |q| place.rounded_to(q));
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
