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
    /// For each of its sides how the point sees where it starts.
    spokes: Vec<Spoke>,
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
}

/// What becomes of an edge that the search for the cavity has come to.
enum Crossing {
    /// The cavity goes on to the triangle behind it, which has this half-edge and this apex.
    Absorbed(HalfEdgeId, Seen),
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

    /// Whether the trial lies strictly left of the line from `a` to `b`: exact.
    #[inline]
    fn is_left(&self, a: &Seen, b: &Seen, cross: Cross) -> bool {
        let point = |end: &Seen| self.vertices.point(end.vertex);
        cross.orientation(|| [point(a), point(b), self.trial.site.at]) == Sign::Positive
    }

    #[inline]
    fn is_near(&self, a: &Seen, b: &Seen, cross: Cross) -> bool {
        if C::CURVED {
            let [a, b] = [a, b].map(|end| self.vertices.site(end.vertex));
            let p = self.trial.site;
            return self.chart.distance_sq(a, p) < self.reach_sq
                || self.chart.segment_distance_sq([a, b], p) < self.reach_sq;
        }
        is_within(&a.spoke, &b.spoke, cross, self.reach_sq)
    }

    /// Whether the trial lies in the circle of the counterclockwise triangle `t` with corners a, b, c,
    /// given the cross products of their spokes.
    #[inline]
    fn in_circle(
        &self,
        open: &Triangulation,
        t: TriangleId,
        [a, b, c]: [&Seen; 3],
        crosses: [Cross; 3],
    ) -> bool {
        if C::CURVED {
            let corners = open.corners(t).map(|v| self.vertices.point(v));
            return self.chart.in_circle(&self.circle, corners, self.trial.site.at);
        }
        let point = |corner: &Seen| self.vertices.point(corner.vertex);
        let points = || [point(a), point(b), point(c), self.trial.site.at];
        centre_in_circle([a, b, c].map(|corner| &corner.spoke), crosses, points) == Sign::Positive
    }

    /// Whether a segment keeps a squared distance from the trial.
    fn is_beyond(&self, ends: [VertexId; 2], spokes: [&Spoke; 2], distance_sq: f64) -> bool {
        if C::CURVED {
            let ends = ends.map(|v| self.vertices.site(v));
            return self.chart.segment_distance_sq(ends, self.trial.site) >= distance_sq;
        }
        !is_within(spokes[0], spokes[1], spokes[0].cross(*spokes[1]), distance_sq)
    }

    fn distance_sq(&self, v: VertexId, spoke: &Spoke) -> f64 {
        if C::CURVED {
            return self.chart.distance_sq(self.vertices.site(v), self.trial.site);
        }
        spoke.square
    }
}

/// Whether a segment comes nearer to the centre of its ends' spokes than a squared distance; without
/// a division.
#[inline]
fn is_within(a: &Spoke, b: &Spoke, cross: Cross, distance_sq: f64) -> bool {
    if a.square < distance_sq || b.square < distance_sq {
        return true;
    }
    // Between the ends the distance is the height over the segment.
    let (ux, uy) = (b.x - a.x, b.y - a.y);
    a.x * ux + a.y * uy < 0.0
        && b.x * ux + b.y * uy > 0.0
        && cross.value * cross.value < distance_sq * (ux * ux + uy * uy)
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
        let crosses = [b.spoke.cross(c.spoke), c.spoke.cross(a.spoke), a.spoke.cross(b.spoke)];
        if !probe.in_circle(open, t, [&a, &b, &c], crosses) || !probe.is_left(&a, &b, crosses[2]) {
            return false;
        }
        self.absorb(open, t);
        self.outline(&a, &b, Across::Border(0));
        self.stack.push(Side { half_edge: base.prev(), origin: c, dest: a });
        let mut side = Side { half_edge: base.next(), origin: b, dest: c };
        loop {
            let Side { half_edge, origin, dest } = &side;
            let across = open.across(*half_edge);
            match self.cross(open, probe, [origin, dest], across) {
                Crossing::Absorbed(twin, apex) => {
                    self.stack.push(Side { half_edge: twin.prev(), origin: apex, dest: *dest });
                    side = Side { half_edge: twin.next(), origin: *origin, dest: apex };
                    continue;
                }
                Crossing::Outline => self.outline(origin, dest, across),
                Crossing::Unsound => return false,
            }
            match self.stack.pop() {
                Some(next) => side = next,
                None => return true,
            }
        }
    }

    /// Whether the cavity goes on across a side from `a` to `b`: it must where `p` lies beyond the side,
    /// and may where the side is near and the triangle behind it has `p` in its circumcircle.
    #[inline]
    fn cross<C: Chart>(
        &mut self,
        open: &mut Triangulation,
        probe: &Probe<'_, C>,
        [a, b]: [&Seen; 2],
        across: Across,
    ) -> Crossing {
        let ab = a.spoke.cross(b.spoke);
        let as_outline = || match probe.is_left(a, b, ab) {
            true => Crossing::Outline,
            false => Crossing::Unsound,
        };
        let Across::Twin(twin) = across else { return as_outline() };
        // Circles on a surface are approximate: they may miss a triangle that must go.
        let must = C::CURVED && !probe.is_left(a, b, ab);
        let t = twin.triangle();
        let is_seen = open.mark(t) == self.epoch;
        let apex = probe.see(open.apex(twin));
        if !is_seen && !must {
            let crosses = [a.spoke.cross(apex.spoke), apex.spoke.cross(b.spoke), ab.reversed()];
            if !probe.in_circle(open, t, [b, a, &apex], crosses) {
                return as_outline();
            }
        }
        if !must && !probe.is_near(a, b, ab) && probe.is_left(a, b, ab) {
            return Crossing::Outline;
        }
        if is_seen {
            // The cavity closes around a vertex: it is no disk.
            return Crossing::Unsound;
        }
        self.absorb(open, t);
        Crossing::Absorbed(twin, apex)
    }

    /// Adds a side to the outline.
    #[inline]
    fn outline(&mut self, a: &Seen, b: &Seen, across: Across) {
        self.ring.push(PolygonSide { origin: a.vertex, dest: b.vertex, across });
        self.spokes.push(a.spoke);
    }

    fn begin(&mut self) {
        // Marks of recycled slots are 0, so an epoch is never 0; 2^32 insertions do not fit memory.
        self.epoch += 1;
        self.triangles.clear();
        self.ring.clear();
        self.spokes.clear();
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
        let edge_sq = |ends: [VertexId; 2]| {
            let [origin, dest] = ends.map(|v| vertices.site(v));
            let h_sq = trial.reach.powi(2);
            let [low, high] = CLEARANCE_EDGE.map(|fraction| fraction * fraction * h_sq);
            (CLEARANCE_LENGTH_SQ * chart.distance_sq(origin, dest)).clamp(low, high)
        };
        let base = self.ring[0];
        let after = self.spokes[1..].iter().skip(1).chain(&self.spokes[..1]);
        self.ring[1..].iter().zip(&self.spokes[1..]).zip(after).all(|((side, spoke), next)| {
            let is_end = side.origin == base.origin || side.origin == base.dest;
            let ends = [side.origin, side.dest];
            (is_end || probe.distance_sq(side.origin, spoke) >= vertex_sq)
                && (matches!(side.across, Across::Twin(_))
                    || probe.is_beyond(ends, [spoke, next], edge_sq(ends)))
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
