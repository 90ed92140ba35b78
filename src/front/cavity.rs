//! The Delaunay cavity of a trial point in the open region: it decides exactly whether the point
//! may be inserted, holds the vertices and front edges it must keep clear of, and is refilled with
//! the new triangles (Bowyer 1981; Watson 1981).

use super::candidate::Trial;
use super::chart::Chart;
use super::vertex::Vertices;
use crate::predicates::{Cross, Sign, Spoke, centre_in_circle};
use crate::triangulation::fan::PolygonSide;
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};

/// Scratch space of the cavity; reused, so that the front allocates nothing per step.
#[derive(Default)]
pub(super) struct Cavity {
    epoch: u32,
    /// Triangles whose circumcircle contains the point, in the order they were found.
    triangles: Vec<TriangleId>,
    /// Their outline, counterclockwise, the base edge first.
    ring: Vec<PolygonSide>,
    stack: Vec<Side>,
    moved: Vec<(u32, HalfEdgeId)>,
}

/// A vertex as the point sees it.
#[derive(Clone, Copy)]
struct Seen {
    vertex: VertexId,
    spoke: Spoke,
}

/// A side of a triangle in the cavity.
#[derive(Clone, Copy)]
struct Side {
    half_edge: HalfEdgeId,
    origin: Seen,
    dest: Seen,
    /// Of the spokes to its origin and its destination.
    cross: Cross,
}

impl Side {
    fn outline(&self, across: Across) -> PolygonSide {
        PolygonSide { origin: self.origin.vertex, dest: self.dest.vertex, across }
    }
}

/// What becomes of an edge that the search for the cavity has come to.
enum Crossing {
    /// The cavity goes on: the other two sides of the triangle behind it, in the order of the outline.
    Absorbed([Side; 2]),
    Outline,
    Unsound,
}

/// The two open half-edges at the new point that become front edges.
pub(super) struct Fan {
    /// From the base edge's origin to the new point.
    pub(super) from_a: HalfEdgeId,
    /// From the new point to the base edge's destination.
    pub(super) to_b: HalfEdgeId,
}

/// Edges farther from the point than this many spacings are not flipped away: what the far open
/// region looks like does not matter before the front gets there. In front of a flat front the
/// circumcircles are huge and the full cavity has 16 triangles on average, that of two spacings 8;
/// from 1.25 spacings on the meshes come out the same on all domains tried.
const REACH: f64 = 1.5;
/// A new point keeps this fraction of its spacing from every other vertex it sees.
const CLEARANCE_VERTEX: f64 = 0.66;
/// And from every front edge this fraction, squared, of the edge's length, but at least the first
/// and at most the second of the given fractions of its own spacing: beside an edge much longer than
/// the spacing a point that is too near makes a needle, one that is too far starves the front.
const CLEARANCE_LENGTH_SQ: f64 = 0.3 * 0.3;
const CLEARANCE_EDGE: [f64; 2] = [0.4, 0.8];

/// A trial among the vertices it has to fit in with.
pub(super) struct Probe<'a, C: Chart> {
    chart: &'a C,
    vertices: &'a Vertices<C::Lift>,
    trial: &'a Trial<C::Lift>,
    circle: C::Circle,
    reach_sq: f64,
}

impl<'a, C: Chart> Probe<'a, C> {
    pub(super) fn new(
        chart: &'a C,
        vertices: &'a Vertices<C::Lift>,
        trial: &'a Trial<C::Lift>,
    ) -> Self {
        let circle = chart.circle(trial.site);
        Self { chart, vertices, trial, circle, reach_sq: (REACH * trial.reach).powi(2) }
    }

    #[inline]
    fn see(&self, vertex: VertexId) -> Seen {
        Seen { vertex, spoke: Spoke::new(self.trial.site.at, self.vertices.point(vertex)) }
    }

    #[inline]
    fn side(half_edge: HalfEdgeId, origin: Seen, dest: Seen) -> Side {
        Side { half_edge, origin, dest, cross: origin.spoke.cross(dest.spoke) }
    }

    /// Whether the trial lies strictly left of a side: exact.
    #[inline]
    fn is_left(&self, side: &Side) -> bool {
        let ends = [side.origin, side.dest];
        let points = || {
            let [a, b] = ends.map(|end| self.vertices.point(end.vertex));
            [a, b, self.trial.site.at]
        };
        side.cross.orientation(points) == Sign::Positive
    }

    #[inline]
    fn is_near(&self, side: &Side) -> bool {
        if C::CURVED {
            let [a, b] = [side.origin, side.dest].map(|end| self.vertices.site(end.vertex));
            let p = self.trial.site;
            return self.chart.distance_sq(a, p) < self.reach_sq
                || self.chart.segment_distance_sq([a, b], p) < self.reach_sq;
        }
        let [a, b] = [side.origin.spoke, side.dest.spoke];
        if a.square < self.reach_sq || b.square < self.reach_sq {
            return true;
        }
        // Between the ends the distance is the height over the side.
        let (ux, uy) = (b.x - a.x, b.y - a.y);
        let is_between = a.x * ux + a.y * uy < 0.0 && b.x * ux + b.y * uy > 0.0;
        let cross_sq = side.cross.value * side.cross.value;
        is_between && cross_sq < self.reach_sq * (ux * ux + uy * uy)
    }

    /// Whether the trial lies in the circle of the triangle that is made of three sides.
    #[inline]
    fn in_circle(&self, open: &Triangulation, t: TriangleId, [ab, bc, ca]: [&Side; 3]) -> bool {
        if C::CURVED {
            let corners = open.corners(t).map(|v| self.vertices.point(v));
            return self.chart.in_circle(&self.circle, corners, self.trial.site.at);
        }
        let corners = [ab.origin, bc.origin, ca.origin];
        let points = || {
            let [a, b, c] = corners.map(|corner| self.vertices.point(corner.vertex));
            [a, b, c, self.trial.site.at]
        };
        let crosses = [bc.cross, ca.cross, ab.cross];
        centre_in_circle(corners.map(|corner| corner.spoke), crosses, points) == Sign::Positive
    }
}

impl Cavity {
    /// Finds the cavity of `p` that contains the open triangle on `base`; `false` when that
    /// triangle does not belong to it or `p` does not see the whole outline from strictly inside.
    pub(super) fn carve<C: Chart>(
        &mut self,
        open: &mut Triangulation,
        probe: &Probe<'_, C>,
        base: HalfEdgeId,
    ) -> bool {
        self.begin();
        let t = base.triangle();
        let [a, b, c] = [open.origin(base), open.dest(base), open.apex(base)].map(|v| probe.see(v));
        let ab = Probe::<C>::side(base, a, b);
        let bc = Probe::<C>::side(base.next(), b, c);
        let ca = Probe::<C>::side(base.prev(), c, a);
        if !probe.in_circle(open, t, [&ab, &bc, &ca]) {
            return false;
        }
        self.absorb(open, t);
        if !probe.is_left(&ab) {
            return false;
        }
        self.ring.push(ab.outline(Across::Border(0)));
        self.stack.extend([ca, bc]);
        while let Some(side) = self.stack.pop() {
            let across = open.across(side.half_edge);
            match self.cross(open, probe, &side, across) {
                Crossing::Absorbed([next, last]) => self.stack.extend([last, next]),
                Crossing::Outline => self.ring.push(side.outline(across)),
                Crossing::Unsound => return false,
            }
        }
        true
    }

    /// Whether the cavity goes on across a side: it must where `p` lies beyond the side, and may
    /// where the side is near and the triangle behind it has `p` in its circumcircle.
    #[inline]
    fn cross<C: Chart>(
        &mut self,
        open: &mut Triangulation,
        probe: &Probe<'_, C>,
        side: &Side,
        across: Across,
    ) -> Crossing {
        let Across::Twin(twin) = across else {
            return if probe.is_left(side) { Crossing::Outline } else { Crossing::Unsound };
        };
        // Circles on a surface are approximate: they may miss a triangle that must go.
        let must = C::CURVED && !probe.is_left(side);
        let t = twin.triangle();
        let is_seen = open.mark(t) == self.epoch;
        let apex = probe.see(open.apex(twin));
        let next = Probe::<C>::side(twin.next(), side.origin, apex);
        let last = Probe::<C>::side(twin.prev(), apex, side.dest);
        let back = Side {
            half_edge: twin,
            origin: side.dest,
            dest: side.origin,
            cross: side.cross.reversed(),
        };
        if !is_seen && !must && !probe.in_circle(open, t, [&back, &next, &last]) {
            return if probe.is_left(side) { Crossing::Outline } else { Crossing::Unsound };
        }
        if !must && !probe.is_near(side) && probe.is_left(side) {
            return Crossing::Outline;
        }
        if is_seen {
            // The cavity closes around a vertex: it is no disk.
            return Crossing::Unsound;
        }
        self.absorb(open, t);
        Crossing::Absorbed([next, last])
    }

    fn begin(&mut self) {
        // Marks of recycled slots are 0, so an epoch is never 0; 2^32 insertions do not fit memory.
        self.epoch += 1;
        self.triangles.clear();
        self.ring.clear();
        self.stack.clear();
        self.moved.clear();
    }

    fn absorb(&mut self, open: &mut Triangulation, t: TriangleId) {
        open.set_mark(t, self.epoch);
        self.triangles.push(t);
    }

    /// Whether the trial keeps its clearances from the outline. The nearest vertex that a point
    /// sees is its neighbour in the Delaunay triangulation, so it is on the outline. Float
    /// arithmetic: this ranks, `carve` has decided.
    pub(super) fn is_clear<C: Chart>(&self, probe: &Probe<'_, C>) -> bool {
        let Probe { chart, vertices, trial, .. } = *probe;
        let vertex_sq = (CLEARANCE_VERTEX * trial.reach).powi(2);
        let edge_sq = |length_sq: f64| {
            let h_sq = trial.reach.powi(2);
            let [low, high] = CLEARANCE_EDGE.map(|fraction| fraction * fraction * h_sq);
            (CLEARANCE_LENGTH_SQ * length_sq).clamp(low, high)
        };
        let ends = self.ring[0];
        self.ring[1..].iter().all(|edge| {
            let [origin, dest] = [edge.origin, edge.dest].map(|v| vertices.site(v));
            let is_end = edge.origin == ends.origin || edge.origin == ends.dest;
            (is_end || chart.distance_sq(origin, trial.site) >= vertex_sq)
                && (matches!(edge.across, Across::Twin(_))
                    || chart.segment_distance_sq([origin, dest], trial.site)
                        >= edge_sq(chart.distance_sq(origin, dest)))
        })
    }

    /// Replaces the carved triangles by the fan of `p`, without the triangle on the base edge.
    pub(super) fn fill(&mut self, open: &mut Triangulation, p: VertexId) -> Fan {
        let tag = open.tag(self.triangles[0]);
        let sides = &self.ring[1..];
        open.refill(&mut self.triangles, sides.iter().copied(), p, tag);
        for (t, side) in self.triangles.iter().zip(sides) {
            if let Across::Border(owner) = side.across {
                self.moved.push((owner, t.half_edge(0)));
            }
        }
        let (first, last) = (self.triangles[0], self.triangles[sides.len() - 1]);
        Fan { from_a: last.half_edge(1), to_b: first.half_edge(2) }
    }

    /// The front edges whose half-edge changed in the last `fill`.
    pub(super) fn moved_borders(&self) -> &[(u32, HalfEdgeId)] {
        &self.moved
    }
}
