//! The state of a refinement and its steps.

use super::cavity::Cavity;
use super::measure::{Bounds, Flaw, centroid, shortest_side, smallest_angle_deg};
use super::pieces::{Pieces, last_place, owner, side_of};
use super::queue::Queue;
use super::{AreaBound, Progress, RefineError, RefineOptions, RefineStats, Refined, RefinedEdge};
use crate::background::{Background, INSIDE};
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::size::{Base, Hint};
use crate::triangulation::locate::Location;
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};

/// Steps between two calls of the observer.
const PROGRESS_STEPS: u64 = 1 << 13;

/// sqrt(3)/2: twice the area of the equilateral triangle of side 1.
const EQUILATERAL_DOUBLED: f64 = 0.866_025_403_784_438_6;

pub(super) struct Refiner<'a> {
    mesh: Triangulation,
    points: Vec<Point2>,
    /// Values of the field per vertex, and where it was asked; empty without a field.
    spacing: Vec<f64>,
    hints: Vec<Hint>,
    pieces: Pieces,
    /// Twice the largest area by tag; empty when no region has one.
    region_doubled: Vec<f64>,
    bounds: Bounds,
    options: RefineOptions<'a>,
    queue: Queue,
    /// Pieces to be split, with their ends at the time: a piece that has changed is left.
    encroached: Vec<(u32, [VertexId; 2])>,
    /// Pieces in the way of the last trial point.
    obstacles: Vec<u32>,
    cavity: Cavity,
    stats: RefineStats,
}

/// What became of a trial point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    Inserted,
    /// `obstacles` says which pieces are in its way.
    Blocked,
    /// It was rounded out of reach of its triangle.
    Astray,
}

impl<'a> Refiner<'a> {
    pub(super) fn new(background: &Background, options: RefineOptions<'a>) -> Self {
        let (mut mesh, edges) = background.open_region();
        let points = background.points.clone();
        let pieces = Pieces::new(&points, &edges, last_place(&points, options.quantum));
        for (i, piece) in pieces.list.iter().enumerate() {
            for (side, e) in piece.sides.iter().enumerate() {
                if let Some(e) = *e {
                    mesh.set_border(e, owner(i, side));
                }
            }
        }
        let mut refiner = Self {
            mesh,
            points,
            spacing: Vec::new(),
            hints: Vec::new(),
            pieces,
            region_doubled: region_areas(background),
            bounds: Bounds::new(options.angle_min_deg),
            options,
            queue: Queue::default(),
            encroached: Vec::new(),
            obstacles: Vec::new(),
            cavity: Cavity::default(),
            stats: RefineStats::default(),
        };
        refiner.ask_field_at_start();
        refiner
    }

    fn ask_field_at_start(&mut self) {
        let AreaBound::Field(field) = self.options.area else { return };
        self.spacing = vec![f64::NAN; self.points.len()];
        self.hints = vec![Hint(TriangleId(0)); self.points.len()];
        for t in self.mesh.triangles() {
            for v in self.mesh.corners(t) {
                let h = &mut self.spacing[v.index()];
                if h.is_nan() {
                    let hint = &mut self.hints[v.index()];
                    *hint = Hint(t);
                    *h = field.at(self.points[v.index()], Base { length: f64::INFINITY }, hint);
                }
            }
        }
    }

    /// Queues what is wrong at the start.
    pub(super) fn judge_all(&mut self) {
        let all: Vec<TriangleId> = self.mesh.triangles().collect();
        // The queue is a stack: the first triangle shall be the first to go.
        for &t in all.iter().rev() {
            self.judge(t);
        }
    }

    pub(super) fn run(&mut self, progress: Progress<'_>) -> Result<(), RefineError> {
        let mut steps = 0_u64;
        loop {
            if let Some((piece, ends)) = self.encroached.pop() {
                self.split(piece as usize, ends);
            } else if let Some(t) = self.queue.pop() {
                self.mend(t);
            } else {
                return Ok(());
            }
            steps += 1;
            if self.mesh.live_count() > self.options.triangles_max {
                return Err(RefineError::Budget(self.options.triangles_max));
            }
            if steps.is_multiple_of(PROGRESS_STEPS) && !progress(self.mesh.live_count()) {
                return Err(RefineError::Stopped);
            }
        }
    }

    fn corners(&self, t: TriangleId) -> [Point2; 3] {
        self.mesh.corners(t).map(|v| self.points[v.index()])
    }

    /// Twice the largest area of a triangle.
    #[inline]
    fn doubled_max(&self, t: TriangleId) -> f64 {
        let doubled = match self.options.area {
            AreaBound::None => f64::INFINITY,
            AreaBound::Constant(area) => 2.0 * area,
            AreaBound::Field(_) => {
                let [a, b, c] = self.mesh.corners(t).map(|v| self.spacing[v.index()]);
                let side = (a + b + c) * (1.0 / 3.0);
                EQUILATERAL_DOUBLED * side * side
            }
        };
        let region = self.region_doubled.get(self.mesh.tag(t) as usize);
        region.map_or(doubled, |&region| doubled.min(region))
    }

    fn flaw(&self, t: TriangleId) -> Option<Flaw> {
        self.bounds.flaw(self.corners(t), self.doubled_max(t))
    }

    /// Queues a triangle with a flaw, and its pieces that it encroaches upon.
    #[inline]
    fn judge(&mut self, t: TriangleId) {
        if let Some(flaw) = self.flaw(t) {
            self.queue.push(t, flaw.urgency);
        }
        if self.options.split_boundary {
            self.judge_pieces(t);
        }
    }

    fn judge_pieces(&mut self, t: TriangleId) {
        for e in t.half_edges() {
            let Across::Border(owner) = self.mesh.across(e) else { continue };
            let [a, b, apex] = [self.mesh.origin(e), self.mesh.dest(e), self.mesh.apex(e)]
                .map(|v| self.points[v.index()]);
            if self.bounds.encroaches([a, b], apex) {
                self.encroach(side_of(owner).0);
            }
        }
    }

    /// Queues a piece to be split; says whether it can be.
    fn encroach(&mut self, piece: usize) -> bool {
        let ends = self.pieces.list[piece].ends;
        let is_free = !self.pieces.list[piece].is_stuck;
        if is_free {
            self.encroached.push((piece as u32, ends));
        }
        is_free
    }

    /// Mends the triangle in a slot, if it has a flaw.
    fn mend(&mut self, t: TriangleId) {
        let Some(mut flaw) = self.flaw(t) else { return };
        flaw.has_small_angle = flaw.has_small_angle && !self.is_hopeless(t);
        if !flaw.has_small_angle && !flaw.is_too_large {
            return;
        }
        let centre = self.rounded(self.bounds.centre(self.corners(t), flaw.has_small_angle));
        match self.place(t, centre) {
            Outcome::Inserted => return,
            Outcome::Blocked if self.options.split_boundary && self.clear_the_way() => {
                self.queue.push(t, flaw.urgency);
                return;
            }
            Outcome::Blocked | Outcome::Astray => {}
        }
        if flaw.is_too_large {
            self.divide(t);
        }
    }

    /// A small angle that the domain itself demands, or that rounding would decide.
    fn is_hopeless(&self, t: TriangleId) -> bool {
        let side = t.half_edge(shortest_side(self.corners(t)) as u32);
        let (u, w) = (self.mesh.origin(side), self.mesh.dest(side));
        self.pieces.are_too_close(&self.points, u, w)
            || self.options.split_boundary && self.pieces.are_on_one_shell(&self.points, u, w)
    }

    /// Queues the obstacles of the last trial point; says whether one of them can be split.
    fn clear_the_way(&mut self) -> bool {
        let obstacles = std::mem::take(&mut self.obstacles);
        let mut is_clear = false;
        for &piece in &obstacles {
            is_clear |= self.encroach(piece as usize);
        }
        self.obstacles = obstacles;
        is_clear
    }

    fn rounded(&self, p: Point2) -> Point2 {
        self.options.quantum.map_or(p, |quantum| p.rounded_to(quantum))
    }

    /// Inserts a trial point of a triangle if it lies inside the domain, in sight of the triangle,
    /// in its circle and in no lens of a piece.
    fn place(&mut self, t: TriangleId, p: Point2) -> Outcome {
        self.obstacles.clear();
        if !p.is_finite() {
            return Outcome::Astray;
        }
        let seed = match self.mesh.locate(&self.points, p, t) {
            Location::Inside(seed) => seed,
            Location::OnVertex(_) => return Outcome::Astray,
            Location::OnEdge(e) | Location::Outside(e) => match self.mesh.across(e) {
                Across::Twin(_) => e.triangle(),
                Across::Border(owner) => {
                    self.obstacles.push(side_of(owner).0 as u32);
                    return Outcome::Blocked;
                }
            },
        };
        self.cavity.dig(&self.mesh, &self.points, seed, p);
        if !self.cavity.triangles().contains(&t) {
            return Outcome::Astray;
        }
        self.find_encroached(p);
        if !self.obstacles.is_empty() {
            return Outcome::Blocked;
        }
        self.insert(p, t);
        Outcome::Inserted
    }

    /// The pieces on the cavity's outline that have the point in their lens.
    fn find_encroached(&mut self, p: Point2) {
        for edge in self.cavity.outline() {
            if let Across::Border(owner) = edge.across {
                let ends = [edge.from, edge.to].map(|v| self.points[v.index()]);
                if self.bounds.encroaches(ends, p) {
                    self.obstacles.push(side_of(owner).0 as u32);
                }
            }
        }
    }

    /// Divides a triangle that is too large and cannot have its centre: by its centroid, if that
    /// lies strictly inside.
    fn divide(&mut self, t: TriangleId) {
        let p = self.rounded(centroid(self.corners(t)));
        let [a, b, c] = self.corners(t);
        let sides = [orient2d(a, b, p), orient2d(b, c, p), orient2d(c, a, p)];
        if sides == [Sign::Positive; 3] {
            self.cavity.dig(&self.mesh, &self.points, t, p);
            self.insert(p, t);
        }
    }

    /// Puts a point into the cavity that was dug for it.
    fn insert(&mut self, p: Point2, near: TriangleId) {
        let v = self.add_vertex(p, self.mesh.corners(near)[0]);
        self.stats.inserted += 1;
        self.fill(v, true);
        self.judge_fan();
    }

    fn add_vertex(&mut self, p: Point2, near: VertexId) -> VertexId {
        let v = VertexId(self.points.len() as u32);
        self.points.push(p);
        if let AreaBound::Field(field) = self.options.area {
            let mut hint = self.hints[near.index()];
            self.spacing.push(field.at(p, Base { length: f64::INFINITY }, &mut hint));
            self.hints.push(hint);
        }
        v
    }

    fn fill(&mut self, v: VertexId, is_closed: bool) {
        let pieces = &mut self.pieces;
        self.cavity.fill(&mut self.mesh, v, is_closed, |owner, e| {
            let (piece, side) = side_of(owner);
            pieces.list[piece].sides[side] = Some(e);
        });
    }

    fn judge_fan(&mut self) {
        for i in 0..self.cavity.triangles().len() {
            self.judge(self.cavity.triangles()[i]);
        }
    }

    /// Splits a piece in the middle, unless it has changed since it was queued.
    fn split(&mut self, piece: usize, ends: [VertexId; 2]) {
        let whole = self.pieces.list[piece];
        if whole.ends != ends || whole.is_stuck {
            return;
        }
        let middle = self.pieces.middle(&self.points, &whole);
        let middle = middle.map(|(p, at)| (self.rounded(p), at));
        let Some((p, at)) = middle.filter(|&(p, _)| self.can_split(whole.sides, p)) else {
            self.pieces.list[piece].is_stuck = true;
            return;
        };
        let v = self.add_vertex(p, ends[0]);
        self.stats.splits += 1;
        let rest = self.pieces.cut(piece, v, at);
        for (side, e) in whole.sides.into_iter().enumerate() {
            let Some(e) = e else { continue };
            // Side 0 runs from the piece to the rest, side 1 back.
            let numbers = if side == 0 { [piece, rest] } else { [rest, piece] };
            self.split_side(e, v, numbers.map(|piece| owner(piece, side)));
        }
    }

    /// Whether the point lies strictly left of the other two edges on each side of a piece.
    fn can_split(&self, sides: [Option<HalfEdgeId>; 2], p: Point2) -> bool {
        sides.into_iter().flatten().flat_map(|e| [e.next(), e.prev()]).all(|e| {
            let [a, b] = [self.mesh.origin(e), self.mesh.dest(e)].map(|v| self.points[v.index()]);
            orient2d(a, b, p) == Sign::Positive
        })
    }

    /// Splits the border edge `e` by `v`; its parts get the owners given, in its direction.
    fn split_side(&mut self, e: HalfEdgeId, v: VertexId, owners: [u32; 2]) {
        self.cavity.dig_beside(&self.mesh, &self.points, e, self.points[v.index()]);
        self.fill(v, false);
        let fan = self.cavity.triangles();
        let (first, last) = (fan[0], fan[fan.len() - 1]);
        let parts = [last.half_edge(1), first.half_edge(2)];
        for (part, owner) in parts.into_iter().zip(owners) {
            self.mesh.set_border(part, owner);
            let (piece, side) = side_of(owner);
            self.pieces.list[piece].sides[side] = Some(part);
        }
        self.judge_fan();
    }

    /// Counts what is still wrong.
    pub(super) fn survey(&mut self) {
        let mut smallest: f64 = 60.0;
        for t in self.mesh.triangles() {
            if self.options.angle_min_deg > 0.0 {
                smallest = smallest.min(smallest_angle_deg(self.corners(t)));
            }
            if let Some(flaw) = self.flaw(t) {
                self.stats.small_angles += u64::from(flaw.has_small_angle);
                self.stats.too_large += u64::from(flaw.is_too_large);
            }
        }
        self.stats.smallest_angle_deg = smallest;
    }

    /// Glues the two sides of each constraint and hands everything out.
    pub(super) fn finish(mut self) -> Refined {
        let mut edges = Vec::with_capacity(self.pieces.list.len());
        for (piece, marker) in self.pieces.in_order() {
            if let [Some(e), Some(f)] = piece.sides {
                self.mesh.link(e, f);
                self.mesh.set_constrained(e, true);
            }
            edges.push(RefinedEdge { vertices: piece.ends, marker });
        }
        let Self { mesh, points, spacing, stats, .. } = self;
        Refined { points, mesh, edges, spacing, stats }
    }
}

/// Twice the largest area by tag; empty when no region has one.
fn region_areas(background: &Background) -> Vec<f64> {
    if background.regions.iter().all(|region| region.area_max.is_none()) {
        return Vec::new();
    }
    let none = std::iter::repeat_n(f64::INFINITY, INSIDE as usize + 1);
    let regions = background.regions.iter();
    none.chain(regions.map(|r| 2.0 * r.area_max.unwrap_or(f64::INFINITY))).collect()
}
