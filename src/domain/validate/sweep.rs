//! A sweep over all edges that splits them at the vertices on them and finds where they cross.
//!
//! Shamos and Hoey's sweep (Geometric intersection problems, FOCS 1976, section 3) in O((n + k)
//! log n) for n points and edges and k splits, with two additions. An edge with a vertex in its
//! interior is split there: the vertex lies exactly on it, so both pieces lie exactly on it too.
//! And where two edges cross or overlap, the pair is recorded and one of them leaves the sweep, so
//! that the order of the rest stays sound and the sweep goes on. Every decision is the sign of
//! `orient2d` or a comparison of ranks; no point is ever constructed.
//!
//! On edges of which none cross or overlap the result is the planar graph they form. Otherwise
//! at least one conflict is recorded, and all conflicts are between an edge in `removed` and another.

use super::graph::NONE;
use super::status::{Position, Status};
use crate::point::Point2;
use crate::predicates::{SegmentIntersection, Sign, classify, orient2d};

/// A piece of an edge between two vertices that follow each other on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Piece {
    /// Rank of the end the sweep meets first.
    pub left: u32,
    /// Rank of the other end.
    pub right: u32,
    /// The edge it is part of.
    pub edge: u32,
    /// The next piece to the right on the same edge, or [`NONE`].
    pub next: u32,
}

/// Where a seed lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Location {
    /// On a vertex or a piece.
    OnBoundary,
    /// In the face above this piece; [`NONE`] when no piece lies below.
    Above(u32),
}

/// What a sweep finds.
#[derive(Debug, Default)]
pub(super) struct Sweep {
    /// Piece i is the leftmost one of edge i; further ones follow by `next`.
    pub pieces: Vec<Piece>,
    /// For each vertex, the piece just below it (not one that ends or starts there), or [`NONE`].
    pub below: Vec<u32>,
    /// Edges taken out because they cross or overlap others; sorted.
    pub removed: Vec<u32>,
    /// Pairs of edges that cross or overlap: some, and at least one if there are any.
    pub conflicts: Vec<[u32; 2]>,
    /// For each seed, where it lies. Meaningful only without conflicts.
    pub located: Vec<Location>,
}

/// Sweeps over `points` (distinct, in lexicographic order), `edges` (ranks, left end first) and
/// `seeds` (finite).
pub(super) fn sweep(points: &[Point2], edges: &[[u32; 2]], seeds: &[Point2]) -> Sweep {
    let mut sweeper = Sweeper::new(points, edges, seeds);
    let starts = Starts::new(points.len(), edges);
    let mut order: Vec<usize> = (0..seeds.len()).collect();
    order.sort_by(|&i, &j| seeds[i].lexicographic(seeds[j]));
    let mut waiting = order.into_iter().peekable();
    for vertex in 0..points.len() as u32 {
        while let Some(seed) =
            waiting.next_if(|&s| seeds[s].lexicographic(points[vertex as usize]).is_le())
        {
            sweeper.locate(seed, seeds[seed], Some(points[vertex as usize]));
        }
        sweeper.visit(vertex, starts.of(vertex));
    }
    for seed in waiting {
        sweeper.locate(seed, seeds[seed], None);
    }
    sweeper.result.removed.sort_unstable();
    sweeper.result.removed.dedup();
    sweeper.result
}

/// The edges that start (have their left end) at each vertex.
struct Starts {
    first: Vec<u32>,
    edges: Vec<u32>,
}

impl Starts {
    fn new(vertices: usize, edges: &[[u32; 2]]) -> Self {
        let mut first = vec![0; vertices + 1];
        for [left, _] in edges {
            first[*left as usize + 1] += 1;
        }
        for vertex in 0..vertices {
            first[vertex + 1] += first[vertex];
        }
        let mut free = first.clone();
        let mut sorted = vec![0; edges.len()];
        for (edge, [left, _]) in edges.iter().enumerate() {
            let slot = &mut free[*left as usize];
            sorted[*slot as usize] = edge as u32;
            *slot += 1;
        }
        Self { first, edges: sorted }
    }

    fn of(&self, vertex: u32) -> &[u32] {
        let vertex = vertex as usize;
        &self.edges[self.first[vertex] as usize..self.first[vertex + 1] as usize]
    }
}

struct Sweeper<'a> {
    points: &'a [Point2],
    status: Status,
    /// Pieces that leave the vertex under the sweep line to the right; kept to save allocations.
    leaving: Vec<u32>,
    result: Sweep,
}

impl<'a> Sweeper<'a> {
    fn new(points: &'a [Point2], edges: &[[u32; 2]], seeds: &[Point2]) -> Self {
        let piece = |(edge, &[left, right]): (usize, &[u32; 2])| {
            debug_assert!(left < right);
            Piece { left, right, edge: edge as u32, next: NONE }
        };
        let result = Sweep {
            pieces: edges.iter().enumerate().map(piece).collect(),
            below: vec![NONE; points.len()],
            located: vec![Location::OnBoundary; seeds.len()],
            ..Sweep::default()
        };
        Self { points, status: Status::default(), leaving: Vec::new(), result }
    }

    fn piece(&self, piece: u32) -> Piece {
        self.result.pieces[piece as usize]
    }

    fn point(&self, vertex: u32) -> Point2 {
        self.points[vertex as usize]
    }

    /// On which side of a piece (directed to the right) a point lies: `Positive` means above.
    fn side(&self, piece: u32, point: Point2) -> Sign {
        let Piece { left, right, .. } = self.piece(piece);
        orient2d(self.point(left), self.point(right), point)
    }

    /// The lowest position not below `point`.
    fn position(&self, point: Point2) -> Position {
        self.status.partition(|piece| self.side(piece, point) == Sign::Positive)
    }

    fn locate(&mut self, seed: usize, point: Point2, next_vertex: Option<Point2>) {
        let at = self.position(point);
        let touches = self.status.get(at).is_some_and(|p| self.side(p, point) == Sign::Zero);
        if !touches && next_vertex.is_none_or(|vertex| vertex.key() != point.key()) {
            self.result.located[seed] = Location::Above(self.status.before(at).unwrap_or(NONE));
        }
    }

    /// Moves the sweep line over a vertex.
    fn visit(&mut self, vertex: u32, starting: &[u32]) {
        let point = self.point(vertex);
        let mut at = self.position(point);
        self.result.below[vertex as usize] = self.status.before(at).unwrap_or(NONE);
        self.leaving.clear();
        self.leaving.extend_from_slice(starting);
        at = self.arrive(vertex, at);
        self.sort_leaving(vertex);
        let below = self.status.before(at);
        let above = self.status.get(at);
        for &piece in &self.leaving {
            at = self.status.insert(at, piece);
        }
        let lowest = self.leaving.first().copied().or(above);
        let highest = self.leaving.last().copied().or(below);
        if self.neighbours_cross(below, lowest) || self.neighbours_cross(highest, above) {
            self.part(point);
        }
    }

    /// Takes the pieces through `vertex` out of the status. Those that do not end there are split:
    /// the right part of the lowest one leaves again; further ones cross it, and leave the sweep.
    fn arrive(&mut self, vertex: u32, mut at: Position) -> Position {
        let mut through = NONE;
        while let Some(piece) = self.status.get(at) {
            if self.side(piece, self.point(vertex)) != Sign::Zero {
                break;
            }
            at = self.status.remove(at);
            if self.piece(piece).right == vertex {
                continue;
            }
            if through == NONE {
                through = piece;
            } else {
                self.conflict(through, piece);
            }
        }
        if through != NONE {
            let rest = self.split(through, vertex);
            self.leaving.push(rest);
        }
        at
    }

    /// Splits a piece at a vertex on it and returns the right part.
    fn split(&mut self, piece: u32, vertex: u32) -> u32 {
        let rest = self.result.pieces.len() as u32;
        let whole = self.piece(piece);
        self.result.pieces.push(Piece { left: vertex, ..whole });
        let left = &mut self.result.pieces[piece as usize];
        (left.right, left.next) = (vertex, rest);
        rest
    }

    /// Sorts the leaving pieces from bottom to top; of those in one direction only one stays.
    fn sort_leaving(&mut self, vertex: u32) {
        if self.leaving.len() < 2 {
            return;
        }
        let mut leaving = std::mem::take(&mut self.leaving);
        let origin = self.point(vertex);
        leaving.sort_by(|&s, &t| {
            match orient2d(origin, self.point(self.piece(s).right), self.point(self.piece(t).right))
            {
                Sign::Positive => std::cmp::Ordering::Less,
                Sign::Negative => std::cmp::Ordering::Greater,
                Sign::Zero => s.cmp(&t),
            }
        });
        leaving.dedup_by(|later, kept| {
            let overlap = self.side(*kept, self.point(self.piece(*later).right)) == Sign::Zero;
            if overlap {
                self.conflict(*kept, *later);
            }
            overlap
        });
        self.leaving = leaving;
    }

    /// Records that two edges cross or overlap; the second one leaves the sweep.
    fn conflict(&mut self, kept: u32, removed: u32) {
        let (kept, removed) = (self.piece(kept).edge, self.piece(removed).edge);
        self.result.conflicts.push([kept.min(removed), kept.max(removed)]);
        self.result.removed.push(removed);
    }

    /// Takes pieces out of the status until no two neighbours cross among those through `point`,
    /// the one below and the one above them.
    fn part(&mut self, point: Point2) {
        while let Some((lower, upper)) = self.crossing_neighbours(point) {
            // The longer one goes: it may cross many more. Any choice would be right.
            let (kept, removed) = if self.length(lower) > self.length(upper) {
                (upper, lower)
            } else {
                (lower, upper)
            };
            self.conflict(kept, removed);
            self.status.remove_near(self.position(point), removed);
        }
    }

    fn crossing_neighbours(&self, point: Point2) -> Option<(u32, u32)> {
        let mut at = self.position(point);
        let mut lower = self.status.before(at);
        while let Some(upper) = self.status.get(at) {
            if self.neighbours_cross(lower, Some(upper)) {
                return Some((lower?, upper));
            }
            if self.side(upper, point) != Sign::Zero {
                return None;
            }
            (lower, at) = (Some(upper), self.status.above(at));
        }
        None
    }

    fn neighbours_cross(&self, lower: Option<u32>, upper: Option<u32>) -> bool {
        lower.zip(upper).is_some_and(|(lower, upper)| self.cross(lower, upper))
    }

    fn length(&self, piece: u32) -> f64 {
        let Piece { left, right, .. } = self.piece(piece);
        self.point(left).distance(self.point(right))
    }

    /// Whether the interiors of two pieces cross in a point.
    fn cross(&self, s: u32, t: u32) -> bool {
        let (s, t) = (self.piece(s), self.piece(t));
        if s.left == t.left || s.right == t.right {
            return false;
        }
        let [a, b, c, d] = [s.left, s.right, t.left, t.right].map(|v| self.point(v));
        classify(a, b, c, d) == SegmentIntersection::ProperCrossing
    }
}
