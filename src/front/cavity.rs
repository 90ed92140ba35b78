//! The Delaunay cavity of a trial point in the open region: it decides exactly whether the point
//! may be inserted, holds the vertices and front edges it must keep clear of, and is refilled with
//! the new triangles (Bowyer 1981; Watson 1981).

use super::candidate::Trial;
use super::chart::Chart;
use super::vertex::Vertices;
use crate::predicates::{Sign, orient2d};
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};

/// Scratch space of the cavity; reused, so that the front allocates nothing per step.
#[derive(Default)]
pub(super) struct Cavity {
    epoch: u32,
    /// Triangles whose circumcircle contains the point, in the order they were found.
    triangles: Vec<TriangleId>,
    /// Their outline, counterclockwise, the base edge first.
    ring: Vec<RingEdge>,
    stack: Vec<HalfEdgeId>,
    moved: Vec<(u32, HalfEdgeId)>,
}

#[derive(Clone, Copy)]
struct RingEdge {
    origin: VertexId,
    dest: VertexId,
    across: Across,
}

/// What becomes of an edge that the search for the cavity has come to.
enum Crossing {
    Absorbed(HalfEdgeId),
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

    /// Whether the trial lies strictly left of an edge: exact.
    fn is_left(&self, edge: RingEdge) -> bool {
        let [a, b] = [edge.origin, edge.dest].map(|v| self.vertices.point(v));
        orient2d(a, b, self.trial.site.at) == Sign::Positive
    }

    fn is_near(&self, edge: RingEdge) -> bool {
        let [a, b] = [edge.origin, edge.dest].map(|v| self.vertices.site(v));
        let p = self.trial.site;
        self.chart.distance_sq(a, p) < self.reach_sq
            || self.chart.segment_distance_sq([a, b], p) < self.reach_sq
    }

    fn in_circle(&self, corners: [VertexId; 3]) -> bool {
        let corners = corners.map(|v| self.vertices.point(v));
        self.chart.in_circle(&self.circle, corners, self.trial.site.at)
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
        if !probe.in_circle(open.corners(base.triangle())) {
            return false;
        }
        self.absorb(open, base.triangle());
        self.stack.extend([base.prev(), base.next(), base]);
        while let Some(e) = self.stack.pop() {
            let edge = RingEdge {
                origin: open.origin(e),
                dest: open.dest(e),
                across: if e == base { Across::Border(0) } else { open.across(e) },
            };
            match self.cross(open, probe, edge) {
                Crossing::Absorbed(twin) => self.stack.extend([twin.prev(), twin.next()]),
                Crossing::Outline => self.ring.push(edge),
                Crossing::Unsound => return false,
            }
        }
        true
    }

    /// Whether the cavity goes on across an edge: it must where `p` lies beyond the edge, and may
    /// where the edge is near and the triangle behind it has `p` in its circumcircle.
    fn cross<C: Chart>(
        &mut self,
        open: &mut Triangulation,
        probe: &Probe<'_, C>,
        edge: RingEdge,
    ) -> Crossing {
        let Across::Twin(twin) = edge.across else {
            return if probe.is_left(edge) { Crossing::Outline } else { Crossing::Unsound };
        };
        // Circles on a surface are approximate: they may miss a triangle that must go.
        let must = C::CURVED && !probe.is_left(edge);
        let is_seen = open.mark(twin.triangle()) == self.epoch;
        if !is_seen && !must && !probe.in_circle(open.corners(twin.triangle())) {
            return if probe.is_left(edge) { Crossing::Outline } else { Crossing::Unsound };
        }
        if !must && !probe.is_near(edge) && probe.is_left(edge) {
            return Crossing::Outline;
        }
        if is_seen {
            // The cavity closes around a vertex: it is no disk.
            return Crossing::Unsound;
        }
        self.absorb(open, twin.triangle());
        Crossing::Absorbed(twin)
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
        for &t in &self.triangles {
            open.remove(t);
        }
        let mut fan: Option<Fan> = None;
        for edge in &self.ring[1..] {
            let t = open.add([edge.origin, edge.dest, p]);
            open.set_tag(t, tag);
            open.relink(t.half_edge(0), edge.across);
            if let Across::Border(owner) = edge.across {
                self.moved.push((owner, t.half_edge(0)));
            }
            fan = Some(match fan {
                None => Fan { from_a: t.half_edge(1), to_b: t.half_edge(2) },
                Some(Fan { from_a, to_b }) => {
                    open.link(from_a, t.half_edge(2));
                    Fan { from_a: t.half_edge(1), to_b }
                }
            });
        }
        fan.expect("an outline has at least three edges")
    }

    /// The front edges whose half-edge changed in the last `fill`.
    pub(super) fn moved_borders(&self) -> &[(u32, HalfEdgeId)] {
        &self.moved
    }
}
