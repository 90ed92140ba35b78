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
mod queue;
mod vertex;

use crate::point::Point2;
use crate::size::{Base, Hint, SizeField};
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};
use candidate::{Neighbours, Trial};
use cavity::Cavity;
use queue::Queue;
use vertex::Vertices;

pub use candidate::Rules;
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

struct Front<'a> {
    open: Triangulation,
    accepted: Triangulation,
    vertices: Vertices,
    edges: Vec<FrontEdge>,
    free_edges: Vec<u32>,
    queue: Queue,
    cavity: Cavity,
    field: &'a SizeField,
    options: FrontOptions,
    stats: FrontStats,
}

/// Runs a front from `start` until the open region is empty.
///
/// The result is a conforming triangulation of the start's region with all its vertices and
/// border edges (SPEC F1, F2). Time is linear in the number of triangles for the default order.
///
/// # Errors
/// [`FrontError::Budget`] when more than `vertices_max` points would be inserted, and
/// [`FrontError::Stopped`] when the observer says so.
pub fn advance(
    start: Start,
    field: &SizeField,
    options: FrontOptions,
    progress: Progress<'_>,
) -> Result<FrontMesh, FrontError> {
    let mut front = Front::new(start, field, options);
    let mut steps = 0;
    while let Some(id) = front.queue.pop() {
        if front.edges[id as usize].alive {
            front.step(id);
            steps += 1;
            if front.stats.inserted > options.vertices_max as u64 {
                return Err(FrontError::Budget(options.vertices_max));
            }
            if steps % PROGRESS_STEPS == 0 && !progress(front.accepted.live_count()) {
                return Err(FrontError::Stopped);
            }
        }
        front.free_edges.push(id);
    }
    debug_assert_eq!(front.open.live_count(), 0, "the front ended with an open triangle");
    let (points, spacing) = front.vertices.into_points_and_spacing();
    Ok(FrontMesh { points, mesh: front.accepted, spacing, stats: front.stats })
}

impl<'a> Front<'a> {
    fn new(start: Start, field: &'a SizeField, options: FrontOptions) -> Self {
        let edges = start
            .edges
            .iter()
            .enumerate()
            .map(|(i, &half_edge)| FrontEdge {
                half_edge,
                outer: Across::Border(i as u32),
                hint: Hint(half_edge.triangle()),
                alive: true,
            })
            .collect();
        let mut front = Self {
            open: start.region,
            accepted: Triangulation::default(),
            vertices: Vertices::new(start.points, start.spacing),
            edges,
            free_edges: Vec::new(),
            queue: Queue::new(options.order),
            cavity: Cavity::default(),
            field,
            options,
            stats: FrontStats::default(),
        };
        front.enqueue_start();
        front
    }

    /// Queues the initial edges chain by chain, each from its lexicographically smallest edge, so
    /// that the order depends on coordinates only.
    fn enqueue_start(&mut self) {
        let mut order: Vec<u32> = (0..self.edges.len() as u32).collect();
        let key = |&id: &u32| {
            let e = self.edges[id as usize].half_edge;
            [self.open.origin(e), self.open.dest(e)].map(|v| self.vertices.point(v))
        };
        order.sort_by(|i, j| {
            let ([a, b], [c, d]) = (key(i), key(j));
            a.lexicographic(c).then_with(|| b.lexicographic(d))
        });
        let lengths: Vec<f64> = order.iter().map(|id| key(id)[0].distance(key(id)[1])).collect();
        self.queue.set_unit(lengths.into_iter().fold(f64::INFINITY, f64::min));
        let mut queued = vec![false; self.edges.len()];
        for first in order {
            let mut id = first;
            while !queued[id as usize] {
                queued[id as usize] = true;
                self.enqueue(id);
                id = self.next_front_edge(id);
            }
        }
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

    fn enqueue(&mut self, id: u32) {
        let e = self.edges[id as usize].half_edge;
        let (a, b) = (self.open.origin(e), self.open.dest(e));
        let length = self.vertices.point(a).distance(self.vertices.point(b));
        let depth = 0.5 * (self.vertices.depth(a) + self.vertices.depth(b));
        self.queue.push(id, length, depth, [self.vertices.point(a), self.vertices.point(b)]);
    }

    /// One step on a base edge: a trial point if one is good enough, else the open triangle.
    fn step(&mut self, id: u32) {
        let base = self.edges[id as usize].half_edge;
        let mut hint = self.edges[id as usize].hint;
        for trial in self.trials(base, &mut hint).into_iter().flatten() {
            if self.admits(base, &trial) {
                self.insert(id, trial, hint);
                return;
            }
            self.stats.rejected += 1;
        }
        self.accept_existing(id);
    }

    /// The trial points that score better than the open triangle's own apex, best first.
    fn trials(&self, base: HalfEdgeId, hint: &mut Hint) -> candidate::Trials {
        let neighbours = Neighbours::around(&self.open, &self.vertices, base);
        let length = neighbours.mean_spacing();
        let mut trials =
            candidate::trials(&neighbours, self.options.rules, self.options.clamp, |p| {
                self.field.at(p, Base { length }, hint)
            });
        if let Some(quantum) = self.options.quantum {
            for trial in trials.iter_mut().flatten() {
                trial.point = rounded(trial.point, quantum);
            }
        }
        trials
    }

    /// Whether the trial's exact cavity is sound and its clearances are kept.
    fn admits(&mut self, base: HalfEdgeId, trial: &Trial) -> bool {
        self.cavity.carve(&mut self.open, &self.vertices, base, trial.point)
            && self.cavity.is_clear(&self.vertices, trial)
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
    fn open_edge(&mut self, half_edge: HalfEdgeId, outer: HalfEdgeId, hint: Hint) {
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
    }

    /// Inserts the trial point into its carved cavity and accepts the triangle on the base edge.
    fn insert(&mut self, id: u32, trial: Trial, hint: Hint) {
        self.stats.inserted += 1;
        let FrontEdge { half_edge: base, outer, .. } = self.edges[id as usize];
        let p = self.vertices.push(trial.point, trial.spacing, trial.depth);
        let t = self.accept(base, p, outer);
        self.edges[id as usize].alive = false;
        let fan = self.cavity.fill(&mut self.open, p);
        for &(owner, half_edge) in self.cavity.moved_borders() {
            self.edges[owner as usize].half_edge = half_edge;
        }
        self.open_edge(fan.from_a, t.half_edge(2), hint);
        self.open_edge(fan.to_b, t.half_edge(1), hint);
    }
}

/// The nearest point whose coordinates are multiples of `quantum`.
pub(crate) fn rounded(p: Point2, quantum: f64) -> Point2 {
    let round = |x: f64| libm::round(x / quantum) * quantum;
    Point2::new(round(p.x), round(p.y))
}
