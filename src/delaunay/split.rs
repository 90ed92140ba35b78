//! Segments that cross, cut at their crossings.
//!
//! A crossing of two segments is seldom a point with f64 coordinates. It is rounded to the nearest
//! one, which bends both segments by less than the distance of neighbouring floats; the bent
//! pieces may cross others, which are then cut in turn. What comes out are segments that meet at
//! common ends only, exactly, not points on the given lines. (Snapping until nothing changes:
//! Milenkovic, *Verifiable implementations of geometric algorithms using finite precision
//! arithmetic*, 1988.)
//!
//! Bundles of nearly parallel segments would creep along each other for ever, so a segment is led
//! through every vertex it meets within the distance of neighbouring floats (the hot pixels of
//! Hobby, *Practical segment intersection with finite precision output*, 1999), decided exactly.

use super::lawson::{insert, legalize_from};
use super::{CdtError, Delaunay, Options, check_segments, delaunay};
use crate::point::Point2;
use crate::predicates::{Sign, orient2d, rounded_crossing};
use crate::triangulation::constrain::Obstacle;
use crate::triangulation::locate::Location;
use crate::triangulation::{HalfEdgeId, Triangulation, VertexId};
use std::collections::BTreeMap;

/// Segments that no longer cross.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Split {
    /// The given points, then the crossings in the order in which they were found.
    pub points: Vec<Point2>,
    /// Pieces of the segments, lower vertex first, sorted, each once.
    pub segments: Vec<[u32; 2]>,
    /// For each piece the lowest of the given segments that it is part of.
    pub parents: Vec<u32>,
    /// `[piece, segment]` for every given segment that a piece is part of, sorted: overlapping
    /// segments share pieces.
    pub covered: Vec<[u32; 2]>,
}

/// Cuts segments where they cross, overlap or pass through points, until they meet at common ends
/// only: exactly what [`cdt`](super::cdt) accepts.
///
/// # Errors
/// See [`CdtError`]: unsound points or indices; or [`CdtError::Tangled`] when rounding makes new
/// crossings again and again.
///
/// # Complexity
/// As [`cdt`](super::cdt), for the pieces.
pub fn split_crossings(points: &[Point2], segments: &[[u32; 2]]) -> Result<Split, CdtError> {
    split(points, segments, Crossings::Cut)
}

/// Cuts segments at the points that lie inside them, exactly, so that segments that overlap share
/// pieces. No point is added and nothing is rounded.
///
/// # Errors
/// See [`CdtError`]: unsound points or indices; or [`CdtError::Crossing`] with two given segments
/// that cross where there is no point.
///
/// # Complexity
/// As [`cdt`](super::cdt), for the pieces.
pub fn split_at_points(points: &[Point2], segments: &[[u32; 2]]) -> Result<Split, CdtError> {
    split(points, segments, Crossings::Refuse)
}

/// What becomes of two segments that cross.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Crossings {
    Cut,
    Refuse,
}

fn split(
    points: &[Point2],
    segments: &[[u32; 2]],
    crossings: Crossings,
) -> Result<Split, CdtError> {
    check_segments(points.len(), segments)?;
    let Delaunay { triangulation, repeated } = delaunay(points, Options::default())?;
    if let Some(&[second, first]) = repeated.first() {
        return Err(CdtError::Duplicate { first, second, point: points[first as usize] });
    }
    let pieces = segments.iter().enumerate().map(|(i, &ends)| Piece { ends, parent: i as u32 });
    let mut splitter = Splitter {
        outgoing: triangulation.outgoing(points.len()),
        triangulation,
        points: points.to_vec(),
        todo: pieces.rev().collect(),
        done: BTreeMap::new(),
    };
    for _ in 0..steps_max(points.len(), segments.len()) {
        let Some(piece) = splitter.todo.pop() else { return Ok(splitter.finish()) };
        match crossings {
            Crossings::Cut => splitter.force(piece),
            Crossings::Refuse => splitter.force_exactly(piece)?,
        }
    }
    match splitter.todo.last() {
        Some(piece) => Err(CdtError::Tangled { segment: piece.parent }),
        None => Ok(splitter.finish()),
    }
}

/// n segments may cross n^2 times, and a crossing makes four pieces; beyond that only rounding makes
/// crossings. The cap keeps hopeless input from running for hours.
fn steps_max(points: usize, segments: usize) -> usize {
    const CAP: usize = 1 << 26;
    let crossings = segments.saturating_mul(segments.saturating_add(64));
    crossings.saturating_add(points).saturating_mul(8).min(CAP)
}

#[derive(Clone, Copy)]
struct Piece {
    ends: [u32; 2],
    parent: u32,
}

struct Splitter {
    triangulation: Triangulation,
    points: Vec<Point2>,
    outgoing: Vec<Option<HalfEdgeId>>,
    todo: Vec<Piece>,
    /// Parents of each edge that is constrained now, by its sorted ends.
    done: BTreeMap<[u32; 2], Vec<u32>>,
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl Splitter {
    fn finish(self) -> Split {
        let mut split = Split { points: self.points, ..Split::default() };
        for ((piece, mut parents), i) in self.done.into_iter().zip(0..) {
            parents.sort_unstable();
            parents.dedup();
            split.segments.push(piece);
            split.parents.push(parents[0]);
            split.covered.extend(parents.into_iter().map(|parent| [i, parent]));
        }
        split
    }

    /// A half-edge out of `v`; entries go stale where flips have been.
    fn out_of(&mut self, v: u32) -> HalfEdgeId {
        let hint = self.outgoing[v as usize].filter(|&e| {
            self.triangulation.is_live(e.triangle()) && self.triangulation.origin(e) == VertexId(v)
        });
        let e = hint.unwrap_or_else(|| self.find(v));
        self.outgoing[v as usize] = Some(e);
        e
    }

    fn find(&self, v: u32) -> HalfEdgeId {
        let any = self.outgoing.iter().flatten().next().expect("there are vertices");
        let at = self.points[v as usize];
        match self.triangulation.locate(&self.points, at, any.triangle()) {
            Location::OnVertex(e) => e,
            other => unreachable!("every point is a vertex, not {other:?}"),
        }
    }

    fn force(&mut self, Piece { ends, parent }: Piece) {
        let [a, b] = ends;
        let (from, to) = (self.out_of(a), VertexId(b));
        let beside = match self.triangulation.beside_segment(&self.points, from, to) {
            Ok(beside) => beside,
            Err(Obstacle::Through(e)) => vec![self.triangulation.origin(e)],
            Err(Obstacle::Crosses(e)) => {
                let [c, d] = [self.triangulation.origin(e), self.triangulation.dest(e)];
                match self.hot(ends, &[c, d]) {
                    Some(_) => vec![c, d],
                    None => return self.cut(Piece { ends, parent }, e),
                }
            }
            Err(Obstacle::Leaves(_)) => unreachable!("a segment lies in the hull of its ends"),
        };
        if let Some(v) = self.hot(ends, &beside) {
            self.queue([a, v], parent);
            self.queue([v, b], parent);
            return;
        }
        let done = self.triangulation.force_segment(&self.points, from, to, &mut self.outgoing);
        debug_assert!(done.is_ok(), "the way was clear");
        self.done.entry(sorted(ends)).or_default().push(parent);
    }

    /// Forces a piece as it stands, led through points inside it.
    fn force_exactly(&mut self, Piece { ends, parent }: Piece) -> Result<(), CdtError> {
        let [a, b] = ends;
        let (from, to) = (self.out_of(a), VertexId(b));
        match self.triangulation.force_segment(&self.points, from, to, &mut self.outgoing) {
            Ok(_) => self.done.entry(sorted(ends)).or_default().push(parent),
            Err(Obstacle::Through(e)) => {
                let v = self.triangulation.origin(e).0;
                self.queue([a, v], parent);
                self.queue([v, b], parent);
            }
            Err(Obstacle::Crosses(e)) => {
                let [c, d] = [self.triangulation.origin(e).0, self.triangulation.dest(e).0];
                let other = self.done[&sorted([c, d])][0];
                let (first, second) = (parent.min(other), parent.max(other));
                return Err(CdtError::Crossing { first, second });
            }
            Err(Obstacle::Leaves(_)) => unreachable!("a segment lies in the hull of its ends"),
        }
        Ok(())
    }

    /// The first of some vertices that the piece passes within the distance of neighbouring floats.
    /// It lies strictly between the ends in lexicographic order, so leading pieces through such
    /// vertices comes to an end.
    fn hot(&self, ends: [u32; 2], vertices: &[VertexId]) -> Option<u32> {
        let [a, b] = ends.map(|v| self.points[v as usize]);
        let is_hot = |v: &&VertexId| {
            let p = self.points[v.index()];
            let order = a.lexicographic(p);
            order.is_ne() && order == p.lexicographic(b) && passes_pixel([a, b], p)
        };
        vertices.iter().find(is_hot).map(|v| v.0)
    }

    /// Cuts a piece and the constrained edge `e` that it crosses at their rounded crossing.
    fn cut(&mut self, Piece { ends: [a, b], parent }: Piece, e: HalfEdgeId) {
        let [c, d] = [self.triangulation.origin(e).0, self.triangulation.dest(e).0];
        let [pa, pb, pc, pd] = [a, b, c, d].map(|v| self.points[v as usize]);
        let at = rounded_crossing(pa, pb, pc, pd).expect("the walk met a proper crossing");
        let others = self.done.remove(&sorted([c, d])).expect("constrained edges are done");
        self.release(e);
        let v = match self.hot([c, d], &[VertexId(a), VertexId(b)]) {
            Some(v) => {
                self.queue([a, b], parent);
                v
            }
            None => {
                let v = self.vertex_at(at, e);
                self.queue([a, v], parent);
                self.queue([v, b], parent);
                v
            }
        };
        for other in others {
            self.queue([c, v], other);
            self.queue([v, d], other);
        }
    }

    fn queue(&mut self, ends: [u32; 2], parent: u32) {
        if ends[0] != ends[1] {
            self.todo.push(Piece { ends, parent });
        }
    }

    /// Makes a constrained edge an ordinary one and restores the Delaunay property around it.
    fn release(&mut self, e: HalfEdgeId) {
        self.triangulation.set_constrained(e, false);
        let mut stack = vec![e];
        legalize_from(&mut self.triangulation, &self.points, &mut stack);
    }

    /// The vertex at a point of the hull, a new one if there is none.
    fn vertex_at(&mut self, at: Point2, near: HalfEdgeId) -> u32 {
        match self.triangulation.locate(&self.points, at, near.triangle()) {
            Location::OnVertex(e) => return self.triangulation.origin(e).0,
            Location::OnEdge(e) if self.triangulation.is_constrained(e) => self.open(e),
            _ => {}
        }
        let v = self.points.len() as u32;
        self.points.push(at);
        let t = insert(&mut self.triangulation, &self.points, VertexId(v), near.triangle());
        let out = t.half_edges().into_iter().find(|&h| self.triangulation.origin(h).0 == v);
        self.outgoing.push(out);
        v
    }

    /// A crossing fell on a constrained edge: it is to be forced again, in pieces.
    fn open(&mut self, e: HalfEdgeId) {
        let ends = [self.triangulation.origin(e).0, self.triangulation.dest(e).0];
        if let Some(parents) = self.done.remove(&sorted(ends)) {
            self.release(e);
            parents.into_iter().for_each(|parent| self.queue(ends, parent));
        }
    }
}

/// Whether the line through a segment meets the box of the floats around `p`.
fn passes_pixel([a, b]: [Point2; 2], p: Point2) -> bool {
    let xs = [p.x.next_down(), p.x.next_up()];
    let ys = [p.y.next_down(), p.y.next_up()];
    let mut sides = xs.into_iter().flat_map(|x| ys.map(|y| orient2d(a, b, Point2::new(x, y))));
    let first = sides.next();
    first == Some(Sign::Zero) || !sides.all(|side| Some(side) == first)
}
