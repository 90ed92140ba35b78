//! The advancing front (SPEC 7).
//!
//! The region not yet meshed is held at all times as a constrained Delaunay triangulation whose
//! border is the front. A step takes a base edge from the queue and does one of two things:
//!
//! 1. it accepts the open triangle on the base edge, whose apex is an existing front vertex; or
//! 2. it inserts a trial point into the open region and accepts the triangle that the point makes
//!    with the base edge.
//!
//! The first is always possible: each front edge owns exactly one open triangle. That is why the
//! front cannot get stuck, and why the accepted and the open triangles together are a conforming
//! triangulation of the domain after every step. A point is inserted only where the exact cavity
//! is strictly star-shaped around it, so no step can break that.
//!
//! Differs from the classical method (Lo 1985; Peraire et al. 1987) in that visibility, proximity
//! and crossing are not searched for among front edges but read off the open triangulation.

mod candidate;
mod cavity;
pub mod chart;
mod fan;
mod parts;
mod queue;
mod vertex;

use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::size::{Base, Hint, SizeField};
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};
use candidate::{Candidate, Candidates, Neighbours, Trial};
use cavity::{Cavity, Probe};
use chart::{Chart, Plane, Site};
use fan::Fan;
use queue::Queue;
use vertex::Vertices;

pub use candidate::Rules;
pub use parts::SharedProgress;
pub use queue::Order;

/// The state from which a front starts: the domain, all of it open.
#[derive(Clone, Debug)]
pub struct Start {
    /// Vertices of the open region.
    pub points: Vec<Point2>,
    /// The open region: no ghosts; border `i` of it is front edge `i`.
    pub region: Triangulation,
    /// The front's half-edges in `region`, with the open triangle on their left.
    pub edges: Vec<HalfEdgeId>,
    /// Spacing at each point that a front edge ends in; other entries are not read.
    pub spacing: Vec<f64>,
}

/// How the front advances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontOptions {
    /// Which front edge is the next base edge.
    pub order: Order,
    /// How a trial point is chosen.
    pub rules: Rules,
    /// L stays within [b / clamp, clamp b] of the base edge's length b.
    pub clamp: f64,
    /// The number of new vertices at which the front gives up.
    pub vertices_max: usize,
    /// New coordinates are multiples of this power of two; `None`: any float.
    pub quantum: Option<f64>,
}

/// What a front did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrontStats {
    /// Steps that accepted the open triangle on the base edge.
    pub accepted_existing: u64,
    /// Steps that inserted a point.
    pub inserted: u64,
    /// Trial points that lost against the open triangle because of the exact cavity or clearance.
    pub rejected: u64,
}

/// The finished mesh of a front: topology with adjacency, ready for improvement.
#[derive(Clone, Debug)]
pub struct FrontMesh {
    /// Vertices: those of the start first, then new ones in the order of insertion.
    pub points: Vec<Point2>,
    /// All accepted triangles in the order of acceptance; border `i` is front edge `i` of the start.
    pub mesh: Triangulation,
    /// Wanted spacing at each vertex.
    pub spacing: Vec<f64>,
    /// Counters.
    pub stats: FrontStats,
}

/// Why a front gave up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FrontError {
    /// The backstop: more new vertices than allowed.
    #[error(
        "the front passed its budget of {0} new vertices: the size field asks for more triangles \
         than predicted; raise --max-triangles or take a coarser field"
    )]
    Budget(usize),
    /// The observer asked to stop.
    #[error("stopped")]
    Stopped,
}

/// Called every few thousand steps with the number of accepted triangles; `false` stops the front.
pub type Progress<'a> = &'a mut dyn FnMut(usize) -> bool;

/// Flips before a step on a surface.
const FLIPS_MAX: u32 = 64;
/// Steps between two calls of the observer.
const PROGRESS_STEPS: u64 = 1 << 13;

#[derive(Clone, Copy, Debug)]
struct FrontEdge {
    /// In the open region, with the open triangle on its left.
    half_edge: HalfEdgeId,
    /// In the accepted mesh: what lies on the other side.
    outer: Across,
    hint: Hint,
    alive: bool,
}

struct Front<'a, C: Chart> {
    open: Triangulation,
    accepted: Triangulation,
    vertices: Vertices<C::Lift>,
    edges: Vec<FrontEdge>,
    free_edges: Vec<u32>,
    queue: Queue,
    cavity: Cavity,
    /// Scratch space of [`legalise`](Self::legalise).
    suspects: Vec<HalfEdgeId>,
    chart: &'a C,
    options: FrontOptions,
    stats: FrontStats,
    /// The initial edges in an order that depends on coordinates only.
    start_order: Vec<u32>,
}

/// Runs a front from `start` until the open region is empty.
///
/// The result is a conforming triangulation of the start's region with all its vertices and
/// border edges (SPEC F1, F2). Pieces of the region that do not hang together have fronts of their
/// own, which run at the same time: the result is the same for any number of threads, and its points
/// and triangles are piece by piece in the order of their smallest edges (SPEC F10, F11). Time is
/// linear in the number of triangles for the default order.
///
/// # Errors
/// [`FrontError::Budget`] when more than `vertices_max` points would be inserted, and
/// [`FrontError::Stopped`] when the observer says so.
pub fn advance(
    start: Start,
    field: &SizeField,
    options: FrontOptions,
    progress: SharedProgress<'_>,
) -> Result<FrontMesh, FrontError> {
    parts::advance(start, &Plane { field }, options, progress)
}

/// One front in any chart; `lifts` is what lies above the start's points. Returns what lies above
/// the points of the mesh, too.
///
/// # Errors
/// As [`advance`].
pub fn advance_on<C: Chart>(
    start: Start,
    lifts: Vec<C::Lift>,
    chart: &C,
    options: FrontOptions,
    progress: Progress<'_>,
) -> Result<(FrontMesh, Vec<C::Lift>), FrontError> {
    let hints = start.edges.iter().map(|e| Hint(e.triangle())).collect();
    let mut report = |triangles, _| match progress(triangles) {
        true => Ok(()),
        false => Err(FrontError::Stopped),
    };
    Front::new(start, hints, lifts, chart, options).run(&mut report)
}

impl<'a, C: Chart> Front<'a, C> {
    fn new(
        start: Start,
        hints: Vec<Hint>,
        lifts: Vec<C::Lift>,
        chart: &'a C,
        options: FrontOptions,
    ) -> Self {
        let edges = (0..).zip(start.edges.iter().zip(hints)).map(|(i, (&half_edge, hint))| {
            FrontEdge { half_edge, outer: Across::Border(i), hint, alive: true }
        });
        let edges = edges.collect();
        let mut front = Self {
            open: start.region,
            accepted: Triangulation::default(),
            vertices: Vertices::new(start.points, lifts, start.spacing),
            edges,
            free_edges: Vec::new(),
            queue: Queue::new(options.order),
            cavity: Cavity::default(),
            suspects: Vec::new(),
            chart,
            options,
            stats: FrontStats::default(),
            start_order: Vec::new(),
        };
        front.start_order = front.enqueue_start();
        front
    }

    /// Advances until the open region is empty; `report` hears now and then of the accepted triangles
    /// and the inserted points, and may end it.
    fn run(
        mut self,
        report: &mut dyn FnMut(usize, u64) -> Result<(), FrontError>,
    ) -> Result<(FrontMesh, Vec<C::Lift>), FrontError> {
        self.fan_corners();
        let mut steps = 0;
        while let Some(id) = self.queue.pop() {
            if self.edges[id as usize].alive {
                self.step(id);
                steps += 1;
                if self.stats.inserted > self.options.vertices_max as u64 {
                    return Err(FrontError::Budget(self.options.vertices_max));
                }
                if steps % PROGRESS_STEPS == 0 {
                    report(self.accepted.live_count(), self.stats.inserted)?;
                }
            }
            self.free_edges.push(id);
        }
        debug_assert_eq!(self.open.live_count(), 0, "the front ended with an open triangle");
        let (points, lifts, spacing) = self.vertices.into_parts();
        Ok((FrontMesh { points, mesh: self.accepted, spacing, stats: self.stats }, lifts))
    }

    /// Queues the initial edges chain by chain, each from its lexicographically smallest edge, so
    /// that the order depends on coordinates only.
    fn enqueue_start(&mut self) -> Vec<u32> {
        let mut order: Vec<u32> = (0..self.edges.len() as u32).collect();
        let key = |&id: &u32| {
            let e = self.edges[id as usize].half_edge;
            [self.open.origin(e), self.open.dest(e)].map(|v| self.vertices.point(v))
        };
        order.sort_by(|i, j| {
            let ([a, b], [c, d]) = (key(i), key(j));
            a.lexicographic(c).then_with(|| b.lexicographic(d))
        });
        let shortest = order.iter().map(|&id| self.length(id)).fold(f64::INFINITY, f64::min);
        self.queue.set_unit(shortest);
        let mut queued = vec![false; self.edges.len()];
        for &first in &order {
            let mut id = first;
            while !queued[id as usize] {
                queued[id as usize] = true;
                self.enqueue(id);
                id = self.next_front_edge(id);
            }
        }
        order
    }

    /// The front edge that starts where this one ends, around the same open fan.
    fn next_front_edge(&self, id: u32) -> u32 {
        let mut e = self.edges[id as usize].half_edge.next();
        loop {
            match self.open.across(e) {
                Across::Border(owner) => return owner,
                Across::Twin(twin) => e = twin.next(),
            }
        }
    }

    /// Length of a front edge. That of a pole is infinite, so that it comes last: its triangle is
    /// an edge in space, and what it looks like must be left to its neighbours.
    fn length(&self, id: u32) -> f64 {
        let e = self.edges[id as usize].half_edge;
        let [a, b] = self.ends(e);
        let length = self.chart.distance_sq(a, b).sqrt();
        if C::CURVED && length == 0.0 { f64::INFINITY } else { length }
    }

    fn ends(&self, e: HalfEdgeId) -> [Site<C::Lift>; 2] {
        [self.open.origin(e), self.open.dest(e)].map(|v| self.vertices.site(v))
    }

    fn enqueue(&mut self, id: u32) {
        let e = self.edges[id as usize].half_edge;
        let (a, b) = (self.open.origin(e), self.open.dest(e));
        let length = self.length(id);
        let depth = 0.5 * (self.vertices.depth(a) + self.vertices.depth(b));
        self.queue.push(id, length, depth, [self.vertices.point(a), self.vertices.point(b)]);
    }

    /// One step on a base edge: a trial point if one is good enough, else the open triangle.
    fn step(&mut self, id: u32) {
        let mut hint = self.edges[id as usize].hint;
        if let Some(frame) = self.chart.frame(self.ends(self.edges[id as usize].half_edge)) {
            if C::CURVED {
                self.legalise(id, &frame);
            }
            let base = self.edges[id as usize].half_edge;
            let candidates = self.candidates(&frame, base, &mut hint);
            for candidate in candidates.as_slice() {
                let trial = self.placed(&frame, candidate);
                if let Some(trial) = trial.filter(|trial| self.admits(base, trial)) {
                    self.insert(id, trial, hint);
                    return;
                }
                self.stats.rejected += 1;
            }
        }
        self.accept_existing(id);
    }

    /// Flips open edges around the triangle on a base edge until it is Delaunay as the metric there
    /// sees it, so that its apex is the right existing vertex: what the plane has anyhow. Flips are
    /// valid by exact signs, and bounded in number, since the metric is not the same everywhere.
    fn legalise(&mut self, id: u32, frame: &C::Frame) {
        let circle = self.chart.circle_at(frame);
        let base = self.edges[id as usize].half_edge;
        let mut suspects = std::mem::take(&mut self.suspects);
        self.push_spokes(base, &mut suspects);
        let mut flips = 0;
        while let Some(e) = suspects.pop() {
            let Across::Twin(twin) = self.open.across(e) else { continue };
            let quad = [self.open.origin(e), self.open.dest(e), self.open.apex(e)];
            let corners = quad.map(|v| self.vertices.point(v));
            let ([a, b, c], d) = (corners, self.vertices.point(self.open.apex(twin)));
            let is_left = |p, q, r| orient2d(p, q, r) == Sign::Positive;
            if self.chart.in_circle(&circle, corners, d) && is_left(a, d, c) && is_left(d, b, c) {
                let e = self.open.flip(e);
                let twin = self.open.twin(e).expect("a flipped edge has two sides");
                for side in [e.next(), e.prev(), twin.next(), twin.prev()] {
                    if let Across::Border(owner) = self.open.across(side) {
                        self.edges[owner as usize].half_edge = side;
                    } else {
                        suspects.push(side);
                    }
                }
                flips += 1;
                if flips == FLIPS_MAX {
                    break;
                }
            }
        }
        suspects.clear();
        self.suspects = suspects;
    }

    /// Adds the open half-edges at the ends of a base edge, those of its own triangle last.
    fn push_spokes(&self, base: HalfEdgeId, list: &mut Vec<HalfEdgeId>) {
        for (first, turn) in [
            (base.next(), HalfEdgeId::next as fn(HalfEdgeId) -> HalfEdgeId),
            (base.prev(), HalfEdgeId::prev),
        ] {
            let start = list.len();
            list.push(first);
            while let Across::Twin(twin) = self.open.across(list[list.len() - 1]) {
                list.push(turn(twin));
            }
            list[start..].reverse();
        }
    }

    /// The trial points that score better than the open triangle's own apex, best first.
    fn candidates(&self, frame: &C::Frame, base: HalfEdgeId, hint: &mut Hint) -> Candidates {
        let Self { chart, open, vertices, options, .. } = self;
        let neighbours = Neighbours::of(*chart, frame, open, vertices, base);
        let length = neighbours.mean_spacing();
        let corners = || neighbours.corners(*chart, frame, open, vertices, base);
        candidate::trials(&neighbours, options.rules, options.clamp, corners, |p| {
            chart.spacing(frame, p, Base { length }, hint)
        })
    }

    fn placed(&self, frame: &C::Frame, candidate: &Candidate) -> Option<Trial<C::Lift>> {
        let site = self.chart.place(frame, candidate.point)?;
        Some(Trial::placed(self.rounded(site), candidate))
    }

    /// The site at coordinates that growing back to the user's scale does not round.
    fn rounded(&self, site: Site<C::Lift>) -> Site<C::Lift> {
        let at = self.options.quantum.map_or(site.at, |quantum| site.at.rounded_to(quantum));
        Site { at, ..site }
    }

    /// Whether the trial's exact cavity is sound and its clearances are kept.
    fn admits(&mut self, base: HalfEdgeId, trial: &Trial<C::Lift>) -> bool {
        let probe = Probe::new(self.chart, &self.vertices, trial);
        self.cavity.carve(&mut self.open, &probe, base) && self.cavity.is_clear(&probe)
    }

    fn accept_existing(&mut self, id: u32) {
        self.stats.accepted_existing += 1;
        let FrontEdge { half_edge: base, outer, hint, .. } = self.edges[id as usize];
        let t = self.accept(base, self.open.apex(base), outer);
        self.edges[id as usize].alive = false;
        for (side, corner) in [(base.next(), 1), (base.prev(), 2)] {
            match self.open.across(side) {
                Across::Border(closed) => self.close(closed, t.half_edge(corner)),
                Across::Twin(twin) => {
                    self.open_edge(twin, t.half_edge(corner), hint);
                }
            }
        }
        self.open.remove(base.triangle());
    }

    /// Adds a triangle on the base edge to the accepted mesh, in the region of the open one.
    fn accept(&mut self, base: HalfEdgeId, apex: VertexId, outer: Across) -> TriangleId {
        let t = self.accepted.add([self.open.origin(base), self.open.dest(base), apex]);
        self.accepted.set_tag(t, self.open.tag(base.triangle()));
        self.accepted.relink(t.half_edge(0), outer);
        t
    }

    /// Ends a front edge whose open triangle is being accepted.
    fn close(&mut self, id: u32, inner: HalfEdgeId) {
        let edge = &mut self.edges[id as usize];
        edge.alive = false;
        let outer = edge.outer;
        self.accepted.relink(inner, outer);
    }

    /// Makes an open half-edge a new front edge and queues it.
    fn open_edge(&mut self, half_edge: HalfEdgeId, outer: HalfEdgeId, hint: Hint) -> u32 {
        let edge = FrontEdge { half_edge, outer: Across::Twin(outer), hint, alive: true };
        let id = if let Some(id) = self.free_edges.pop() {
            self.edges[id as usize] = edge;
            id
        } else {
            self.edges.push(edge);
            self.edges.len() as u32 - 1
        };
        self.open.set_border(half_edge, id);
        self.enqueue(id);
        id
    }

    /// Inserts the trial point into its carved cavity, accepts the triangle on the base edge, and
    /// returns the two new front edges: from the base's origin, and to its destination.
    fn insert(&mut self, id: u32, trial: Trial<C::Lift>, hint: Hint) -> [u32; 2] {
        self.stats.inserted += 1;
        let FrontEdge { half_edge: base, outer, .. } = self.edges[id as usize];
        let p = self.vertices.push(trial.site, trial.spacing, trial.depth);
        let t = self.accept(base, p, outer);
        self.edges[id as usize].alive = false;
        let fan = self.cavity.fill(&mut self.open, p);
        for &(owner, half_edge) in self.cavity.moved_borders() {
            self.edges[owner as usize].half_edge = half_edge;
        }
        let from_a = self.open_edge(fan.from_a, t.half_edge(2), hint);
        [from_a, self.open_edge(fan.to_b, t.half_edge(1), hint)]
    }

    /// Lays fans at the corners where edges of very different length meet, before the front starts:
    /// later its points would be in the way.
    fn fan_corners(&mut self) {
        if self.options.rules == Rules::Hard {
            return;
        }
        for id in std::mem::take(&mut self.start_order) {
            self.fan_at_origin(id);
        }
    }

    /// Lays the fan at the corner where a front edge starts.
    fn fan_at_origin(&mut self, id: u32) {
        if !self.edges[id as usize].alive {
            return;
        }
        let out = self.edges[id as usize].half_edge;
        let before = self.previous_front_edge(id);
        let into = self.edges[before as usize].half_edge;
        let Some(frame) = self.chart.frame(self.ends(out)) else { return };
        let point = |v| self.chart.local(&frame, self.vertices.site(v));
        let [corner, next, last] =
            [self.open.origin(out), self.open.dest(out), self.open.origin(into)].map(point);
        let (long, short) = (corner.distance(next), corner.distance(last));
        let turn = fan::angle(corner, next, last);
        if let Some(fan) = Fan::between(long, short, turn) {
            self.lay_fan(id, fan, &frame, [corner, next], true);
        } else if let Some(fan) = Fan::between(short, long, turn) {
            self.lay_fan(before, fan, &frame, [corner, last], false);
        }
    }

    /// Lays the triangles of a fan but the last, which the short edge closes, as far as they fit.
    fn lay_fan(
        &mut self,
        mut id: u32,
        fan: Fan,
        frame: &C::Frame,
        [corner, mut end]: [Point2; 2],
        outgoing: bool,
    ) {
        for _ in 1..fan.triangles {
            let FrontEdge { half_edge: base, mut hint, .. } = self.edges[id as usize];
            end = fan.next(corner, end, outgoing);
            let length = self.vertices.spacing(self.open.origin(base));
            let spacing = self.chart.spacing(frame, end, Base { length }, &mut hint);
            let site = self.chart.place(frame, end).map(|site| self.rounded(site));
            let trial = site.map(|site| Trial::given(site, spacing));
            let Some(trial) = trial.filter(|trial| self.admits(base, trial)) else { return };
            let [from_a, to_b] = self.insert(id, trial, hint);
            id = if outgoing { from_a } else { to_b };
        }
    }

    /// The front edge that ends where this one starts, around the same open fan.
    fn previous_front_edge(&self, id: u32) -> u32 {
        let mut e = self.edges[id as usize].half_edge.prev();
        loop {
            match self.open.across(e) {
                Across::Border(owner) => return owner,
                Across::Twin(twin) => e = twin.prev(),
            }
        }
    }
}
