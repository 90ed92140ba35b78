//! Trial points on a base edge, scored against the open triangle's own apex.
//!
//! Floats rank here; what is valid is decided by the cavity's exact predicates.

use super::chart::{Chart, Site};
use super::vertex::Vertices;
use crate::point::Point2;
use crate::triangulation::{Across, HalfEdgeId, Triangulation, VertexId};

/// How a trial point is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rules {
    /// The point at the two wanted lengths and the bisectors of the adjacent front angles are
    /// scored against the existing apex by the worst triangle each would make.
    Scored,
    /// The report's three rules on the smaller adjacent front angle: below 90 degrees close it,
    /// up to 120 degrees one point on its bisector, beyond that one isosceles triangle.
    Hard,
}

/// A point that might be inserted, in the coordinates of the base edge's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate {
    pub(super) point: Point2,
    spacing: f64,
    reach: f64,
    depth: f64,
    score: f64,
}

/// A point that might be inserted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Trial<L> {
    pub(super) site: Site<L>,
    /// Spacing at the point: its clearances are measured in it.
    pub(super) spacing: f64,
    /// The scale of its surroundings: the spacing, but not less than what a side on a base edge much
    /// longer than that can shrink to.
    pub(super) reach: f64,
    /// Way from the boundary.
    pub(super) depth: f64,
}

impl<L> Trial<L> {
    /// A point on the boundary's own behalf, whatever its score.
    pub(super) fn given(site: Site<L>, spacing: f64) -> Self {
        Self { site, spacing, reach: spacing, depth: 0.0 }
    }

    /// The candidate, once its place is known.
    pub(super) fn placed(site: Site<L>, candidate: &Candidate) -> Self {
        Self { site, spacing: candidate.spacing, reach: candidate.reach, depth: candidate.depth }
    }
}

/// At most three candidates, best first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidates {
    list: [Candidate; 3],
    len: usize,
}

impl Candidates {
    const NONE: Self = Self {
        list: [Candidate {
            point: Point2::new(0.0, 0.0),
            spacing: 0.0,
            reach: 0.0,
            depth: 0.0,
            score: 0.0,
        }; 3],
        len: 0,
    };

    /// Adds a candidate behind those that are as good.
    #[inline]
    fn add(&mut self, candidate: Candidate) {
        let mut at = self.len;
        while at > 0 && self.list[at - 1].score.total_cmp(&candidate.score).is_lt() {
            self.list[at] = self.list[at - 1];
            at -= 1;
        }
        self.list[at] = candidate;
        self.len += 1;
    }

    pub(super) fn as_slice(&self) -> &[Candidate] {
        &self.list[..self.len]
    }
}

/// The base edge and its open triangle's apex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Neighbours {
    pub(super) a: Point2,
    pub(super) b: Point2,
    apex: Point2,
    spacing: [f64; 3],
    depth: f64,
}

/// The corners of the front at the ends of the base edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corners {
    /// Far end of the front edge that ends in `a`, and the angle there.
    left: Corner,
    /// Far end of the front edge that starts in `b`, and the angle there.
    right: Corner,
}

/// A corner of the front at an end of the base edge, on the open side.
#[derive(Clone, Copy, Debug)]
struct Corner {
    far: Point2,
    /// Cosine of the angle between base edge and front edge.
    cosine: f64,
    /// Whether the angle is below 180 degrees.
    convex: bool,
}

impl Corner {
    fn new(at: Point2, along: Point2, far: Point2, turns_left: bool) -> Self {
        let (ux, uy) = (along.x - at.x, along.y - at.y);
        let (vx, vy) = (far.x - at.x, far.y - at.y);
        let norm = ((ux * ux + uy * uy) * (vx * vx + vy * vy)).sqrt();
        let cross = ux * vy - uy * vx;
        Self {
            far,
            cosine: (ux * vx + uy * vy) / norm,
            convex: if turns_left { cross > 0.0 } else { cross < 0.0 },
        }
    }

    /// Whether the angle is below the one with this cosine.
    fn is_below(&self, cosine: f64) -> bool {
        self.convex && self.cosine > cosine
    }
}

impl Neighbours {
    /// Looks at the triangle on the base edge in the open region.
    #[inline]
    pub(super) fn of<C: Chart>(
        chart: &C,
        frame: &C::Frame,
        open: &Triangulation,
        vertices: &Vertices<C::Lift>,
        base: HalfEdgeId,
    ) -> Self {
        let [a, b, c] = [open.origin(base), open.dest(base), open.apex(base)];
        let point = |v: VertexId| chart.local(frame, vertices.site(v));
        let [pa, pb, apex] = [a, b, c].map(point);
        let spacing = [a, b, c].map(|v| vertices.spacing(v));
        let depth = 0.5 * (vertices.depth(a) + vertices.depth(b));
        Self { a: pa, b: pb, apex, spacing, depth }
    }

    /// Looks around the ends of the base edge: costs a rotation about each.
    pub(super) fn corners<C: Chart>(
        &self,
        chart: &C,
        frame: &C::Frame,
        open: &Triangulation,
        vertices: &Vertices<C::Lift>,
        base: HalfEdgeId,
    ) -> Corners {
        let point = |v: VertexId| chart.local(frame, vertices.site(v));
        let is_pole = |u: VertexId, v: VertexId| {
            C::CURVED && chart.distance_sq(vertices.site(u), vertices.site(v)) == 0.0
        };
        let left = Corner::new(self.a, self.b, point(left_end(open, base, is_pole)), true);
        let right = Corner::new(self.b, self.a, point(right_end(open, base, is_pole)), false);
        Corners { left, right }
    }

    /// Mean of the spacings at the ends of the base edge: its length, freed of the accidents of
    /// placement. Had new spacings been taken from the length itself, they would drift.
    pub(super) fn mean_spacing(&self) -> f64 {
        0.5 * (self.spacing[0] + self.spacing[1])
    }
}

/// Origin of the front edge that ends where the base edge starts; the edge of a pole, which is a
/// point in space, is passed over.
fn left_end(
    open: &Triangulation,
    base: HalfEdgeId,
    is_pole: impl Fn(VertexId, VertexId) -> bool,
) -> VertexId {
    let mut e = base.prev();
    loop {
        while let Across::Twin(twin) = open.across(e) {
            e = twin.prev();
        }
        if !is_pole(open.origin(e), open.dest(e)) {
            return open.origin(e);
        }
        e = e.prev();
    }
}

/// Destination of the front edge that starts where the base edge ends, with the same exception.
fn right_end(
    open: &Triangulation,
    base: HalfEdgeId,
    is_pole: impl Fn(VertexId, VertexId) -> bool,
) -> VertexId {
    let mut e = base.next();
    loop {
        while let Across::Twin(twin) = open.across(e) {
            e = twin.next();
        }
        if !is_pole(open.origin(e), open.dest(e)) {
            return open.dest(e);
        }
        e = e.next();
    }
}

/// An inserted point must beat the existing apex by this factor.
const NEW_POINT_WEIGHT: f64 = 0.97;
/// Scores are at most 1, so no new point beats an apex with this one: it need not be looked for.
const UNBEATABLE: f64 = 0.9701;
/// Evaluations of the field for a scored trial: the second moves the point by less than 2 %.
const SCORED_STEPS: usize = 2;
/// Evaluations for the report's fixed point, and its tolerance.
const HARD_STEPS: usize = 20;
const FIXED_POINT_TOLERANCE: f64 = 1e-3;
/// A base edge this much longer than its spacing is coarse: the boundary forces it.
const COARSE_BASE: f64 = 1.3;
/// Beside a coarse base edge a point keeps its clearances from this fraction of the edge.
const COARSE_REACH: f64 = 0.45;
/// A corner up to 150 degrees is closed by the triangle next to the trial one.
const COS_WEDGE: f64 = -0.866_025_403_784_438_6;
/// A bisector point is tried between 80 and 145 degrees.
const COS_BISECT_MIN: f64 = 0.173_648_177_666_930_3;
const COS_BISECT_MAX: f64 = -0.819_152_044_288_991_8;

/// The trial points worth inserting on a base edge; `corners` looks around its ends, `field` gives
/// the spacing at a point.
pub(super) fn trials(
    n: &Neighbours,
    rules: Rules,
    clamp: f64,
    corners: impl FnOnce() -> Corners,
    mut field: impl FnMut(Point2) -> f64,
) -> Candidates {
    let base = n.a.distance(n.b);
    let placer = Placer { n, clamp, base, is_coarse: base > COARSE_BASE * n.mean_spacing() };
    match rules {
        Rules::Scored => placer.scored(corners, &mut field),
        Rules::Hard => placer.hard(&corners(), &mut field),
    }
}

struct Placer<'a> {
    n: &'a Neighbours,
    clamp: f64,
    base: f64,
    /// Whether the base edge is much longer than its spacing.
    is_coarse: bool,
}

impl Placer<'_> {
    fn scored(
        &self,
        corners: impl FnOnce() -> Corners,
        field: &mut impl FnMut(Point2) -> f64,
    ) -> Candidates {
        let n = self.n;
        let mut candidates = Candidates::NONE;
        let (shape, fit) = (shape(n.a, n.b, n.apex), self.fit(n.apex, n.spacing[2]));
        if self.is_unbeatable(shape, fit) {
            return candidates;
        }
        let floor = shape * self.weight(fit);
        let corners = corners();
        let (front, spacing) = self.settle(SCORED_STEPS, field, |p, h| p.two_lengths(h));
        let mut add = |point: Point2| {
            let score = self.score(&corners, point, spacing);
            // What is not a number is no worse.
            let is_worse = NEW_POINT_WEIGHT * score <= floor;
            if !is_worse {
                candidates.add(self.candidate(point, spacing, score));
            }
        };
        add(front);
        for (corner, at, along) in [(&corners.left, n.a, n.b), (&corners.right, n.b, n.a)] {
            if corner.is_below(COS_BISECT_MAX) && !corner.is_below(COS_BISECT_MIN) {
                add(self.bisector(corner, at, along, spacing));
            }
        }
        candidates
    }

    fn hard(
        &self,
        Corners { left, right }: &Corners,
        field: &mut impl FnMut(Point2) -> f64,
    ) -> Candidates {
        let n = self.n;
        let mut candidates = Candidates::NONE;
        let sharper_left = left.convex && (!right.convex || left.cosine >= right.cosine);
        let (corner, at, along) = if sharper_left { (left, n.a, n.b) } else { (right, n.b, n.a) };
        if corner.is_below(0.0) {
            return candidates;
        }
        let (front, spacing) = self.settle(HARD_STEPS, field, |p, h| p.isosceles(h));
        let point =
            if corner.is_below(-0.5) { self.bisector(corner, at, along, spacing) } else { front };
        candidates.add(self.candidate(point, spacing, 1.0));
        candidates
    }

    /// Repeats spacing and place until they agree; returns both, the spacing being the last one
    /// evaluated.
    fn settle(
        &self,
        steps: usize,
        field: &mut impl FnMut(Point2) -> f64,
        place: impl Fn(&Self, f64) -> Point2,
    ) -> (Point2, f64) {
        let mean = self.n.mean_spacing();
        // From a coarse base edge a point is further away than the spacing of its ends allows for: held
        // to that, fine spacing would spread from the ends of long edges, layer by layer, far beyond
        // what the field asks for.
        let near = if self.is_coarse { self.base } else { mean };
        let mut spacing = mean;
        let mut point = place(self, spacing);
        for _ in 0..steps {
            let last = spacing;
            spacing = field(point).clamp(mean / self.clamp, near * self.clamp);
            if spacing == last {
                break;
            }
            point = place(self, spacing);
            if (spacing - last).abs() <= FIXED_POINT_TOLERANCE * spacing {
                break;
            }
        }
        (point, spacing)
    }

    fn candidate(&self, point: Point2, spacing: f64, score: f64) -> Candidate {
        let height = cross(self.n.a, self.n.b, point) / self.base;
        let (reach, depth) = (spacing.max(COARSE_REACH * self.base), self.n.depth + height);
        Candidate { point, spacing, reach, depth, score }
    }

    /// The wanted length between vertices of these spacings, in reach of the base edge.
    fn length(&self, h: f64, k: f64) -> f64 {
        (0.5 * (h + k)).clamp(self.base / self.clamp, self.base * self.clamp)
    }

    /// The point at the wanted length from either end of the base edge.
    fn two_lengths(&self, spacing: f64) -> Point2 {
        let [h_a, h_b, _] = self.n.spacing;
        self.at_lengths(self.length(h_a, spacing), self.length(h_b, spacing))
    }

    /// The apex of the isosceles triangle with sides of the wanted length.
    fn isosceles(&self, spacing: f64) -> Point2 {
        let side = self.length(spacing, spacing);
        self.at_lengths(side, side)
    }

    /// The point left of the base edge at the given distances from its ends.
    fn at_lengths(&self, from_a: f64, from_b: f64) -> Point2 {
        let Neighbours { a, b, .. } = *self.n;
        let d = self.base;
        let along = 0.5 * (d + (from_a - from_b) * ((from_a + from_b) / d));
        let height = (from_a * from_a - along * along).max(0.04 * from_a * from_a).sqrt();
        let (ux, uy) = ((b.x - a.x) / d, (b.y - a.y) / d);
        Point2::new(a.x + along * ux - height * uy, a.y + along * uy + height * ux)
    }

    /// The point on the bisector of a corner, at the mean of its two edges and the wanted length.
    fn bisector(&self, corner: &Corner, at: Point2, along: Point2, spacing: f64) -> Point2 {
        let side = at.distance(corner.far);
        let (ux, uy) = ((along.x - at.x) / self.base, (along.y - at.y) / self.base);
        let (vx, vy) = ((corner.far.x - at.x) / side, (corner.far.y - at.y) / side);
        let (wx, wy) = (ux + vx, uy + vy);
        let norm = (wx * wx + wy * wy).sqrt();
        let length = 0.35 * (self.base + side) + 0.3 * spacing;
        Point2::new(at.x + length * wx / norm, at.y + length * wy / norm)
    }

    /// Whether shape times weight is at least [`UNBEATABLE`], without the roots.
    fn is_unbeatable(&self, shape: f64, fit: f64) -> bool {
        if self.is_coarse {
            return shape * fit >= UNBEATABLE;
        }
        let least = UNBEATABLE / shape;
        shape > 0.0 && fit >= least.powi(8)
    }

    /// Score of a new point: the worst of its triangle and of those that it leaves in the corners, and
    /// how its sides fit the wanted lengths.
    fn score(&self, Corners { left, right }: &Corners, p: Point2, spacing: f64) -> f64 {
        let n = self.n;
        let mut worst = shape(n.a, n.b, p);
        if left.is_below(COS_WEDGE) {
            worst = worst.min(shape(n.a, p, left.far));
        }
        if right.is_below(COS_WEDGE) {
            worst = worst.min(shape(p, n.b, right.far));
        }
        worst * self.weight(self.fit(p, spacing))
    }

    /// How well the two sides at `p` fit the wanted lengths: 1 when they do, towards 0.
    fn fit(&self, p: Point2, spacing: f64) -> f64 {
        let n = self.n;
        let side = |end: Point2, h: f64| {
            let wanted = if self.is_coarse { self.length(h, spacing) } else { 0.5 * (h + spacing) };
            let ratio = end.distance(p) / wanted;
            ratio.min(1.0 / ratio)
        };
        side(n.a, n.spacing[0]) * side(n.b, n.spacing[1])
    }

    /// What a fit counts for. The eighth root makes it a tie-break beside the shape: without it uniform
    /// meshes drift, with its square root graded ones get too many vertices of degree 5 and 7 (measured
    /// on three domains). On a coarse base edge the way to the wanted length matters as much as the
    /// shape: with a root there, the front closes triangles as coarse as the boundary.
    fn weight(&self, fit: f64) -> f64 {
        if self.is_coarse { fit } else { fit.sqrt().sqrt().sqrt() }
    }
}

fn cross(a: Point2, b: Point2, c: Point2) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// Mean ratio 4 sqrt(3) area / (sum of squared sides): 1 when equilateral, negative when inverted.
pub(super) fn shape(a: Point2, b: Point2, c: Point2) -> f64 {
    const TWO_SQRT_3: f64 = 3.464_101_615_137_754_6;
    TWO_SQRT_3 * cross(a, b, c) / (a.distance_sq(b) + b.distance_sq(c) + c.distance_sq(a))
}
