//! The pieces that the boundary and the constraints are cut into.
//!
//! A piece knows which stretch of its segment it is, so that a new point is computed from the ends
//! of the segment and not from points that were rounded before: however often a segment is split,
//! its nodes are off it by rounding once.

use crate::background::FrontEdge;
use crate::point::Point2;
use crate::triangulation::{HalfEdgeId, VertexId};

/// A piece of a boundary segment or constraint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// From where to where, the domain on the left.
    pub(super) ends: [VertexId; 2],
    /// The stretch of the segment: 0 is its start, 1 its end.
    stretch: [f64; 2],
    /// Index of the segment.
    pub(super) segment: u32,
    /// Half-edges from the first end to the second, and back; on a boundary there is one side.
    pub(super) sides: [Option<HalfEdgeId>; 2],
    /// It cannot be split: too short, or too crooked.
    pub(super) is_stuck: bool,
}

/// A segment as given.
#[derive(Clone, Copy, Debug)]
struct Segment {
    ends: [VertexId; 2],
    marker: i32,
    /// Whether another segment leaves that end at an angle below 60 degrees.
    is_acute: [bool; 2],
}

/// All pieces and what they were cut from.
#[derive(Default)]
pub(super) struct Pieces {
    pub(super) list: Vec<Piece>,
    segments: Vec<Segment>,
    /// For each vertex the segment that it was put on, if it is no vertex of the domain's own.
    on: Vec<u32>,
    /// The unit in the last place of the largest coordinate.
    unit: f64,
}

const ON_NONE: u32 = u32::MAX;

/// A piece has at least as many units in the last place of the largest coordinate: below,
/// rounding would turn its halves by an angle that shows.
const PIECE_MIN: f64 = 4096.0;

/// A segment that is split has at least as many: a node is two units off at most, and with more than
/// 2^-20 of its length off, the segment would count as lost (SPEC 9.1).
pub(crate) const SEGMENT_MIN: f64 = (1_u64 << 22) as f64;

/// Vertices at the same distance from a common corner up to this part of it are on one shell.
const SHELL: f64 = 1e-3;

/// Two segments that enclose less than 60 degrees: cosine above this.
const ACUTE_COSINE: f64 = 0.5;

/// Name of one side of a piece, as the owner of a border.
pub(super) fn owner(piece: usize, side: usize) -> u32 {
    (2 * piece + side) as u32
}

/// The piece and the side that a border's owner names.
pub(super) fn side_of(owner: u32) -> (usize, usize) {
    (owner as usize / 2, owner as usize % 2)
}

impl Pieces {
    /// A piece for each boundary edge, and one for both sides of each interior constraint, which
    /// follow each other in `edges`. Boundary edges come first.
    pub(super) fn new(points: &[Point2], edges: &[FrontEdge], unit: f64) -> Self {
        let mut pieces = Self { on: vec![ON_NONE; points.len()], unit, ..Self::default() };
        let mut waiting: Option<u32> = None;
        for edge in edges {
            if let Some(piece) = waiting.take() {
                pieces.list[piece as usize].sides[1] = Some(edge.half_edge);
                continue;
            }
            let piece = pieces.list.len() as u32;
            waiting = edge.interior.then_some(piece);
            let (ends, marker) = (edge.vertices, edge.marker);
            pieces.segments.push(Segment { ends, marker, is_acute: [false; 2] });
            pieces.list.push(Piece {
                ends: edge.vertices,
                stretch: [0.0, 1.0],
                segment: piece,
                sides: [Some(edge.half_edge), None],
                is_stuck: false,
            });
        }
        pieces.find_acute(points);
        pieces
    }

    /// The pieces in the order of their segments and along each, with the segments' markers.
    pub(super) fn in_order(&self) -> Vec<(&Piece, i32)> {
        let marked = |piece| (piece, self.marker(piece));
        let mut list: Vec<(&Piece, i32)> = self.list.iter().map(marked).collect();
        list.sort_by(|(p, _), (q, _)| {
            p.segment.cmp(&q.segment).then(p.stretch[0].total_cmp(&q.stretch[0]))
        });
        list
    }

    fn marker(&self, piece: &Piece) -> i32 {
        self.segments[piece.segment as usize].marker
    }

    /// Marks the ends of segments at which another leaves at less than 60 degrees.
    fn find_acute(&mut self, points: &[Point2]) {
        let mut ends: Vec<(VertexId, u32)> = Vec::with_capacity(2 * self.segments.len());
        for (segment, i) in self.segments.iter().zip(0..) {
            ends.extend([(segment.ends[0], 2 * i), (segment.ends[1], 2 * i + 1)]);
        }
        ends.sort_unstable();
        for star in ends.chunk_by(|(u, _), (v, _)| u == v) {
            // With seven or more, some two are that close.
            let is_crowded = star.len() > 6;
            for (k, &(v, end)) in star.iter().enumerate() {
                let others = star.iter().enumerate().filter(|&(j, _)| j != k);
                let acute = is_crowded
                    || others.into_iter().any(|(_, &(_, other))| {
                        let [p, q] = [end, other].map(|end| points[self.far_end(end).index()]);
                        is_acute(points[v.index()], p, q)
                    });
                self.segments[end as usize / 2].is_acute[end as usize % 2] = acute;
            }
        }
    }

    fn far_end(&self, end: u32) -> VertexId {
        self.segments[end as usize / 2].ends[1 - end as usize % 2]
    }

    /// The point that splits a piece, and its place on the segment; `None` if it is too short.
    ///
    /// The middle; but beside an acute corner a power of two away from it, so that the pieces of
    /// all segments that meet there end on common circles and do not encroach upon each other
    /// (Ruppert's concentric shells).
    pub(super) fn middle(&self, points: &[Point2], piece: &Piece) -> Option<(Point2, f64)> {
        let segment = &self.segments[piece.segment as usize];
        let [a, b] = segment.ends.map(|v| points[v.index()]);
        let whole = a.distance(b);
        let [from, to] = piece.stretch;
        let length = (to - from) * whole;
        if whole < SEGMENT_MIN * self.unit || length < 2.0 * PIECE_MIN * self.unit {
            return None;
        }
        let acute = [from == 0.0 && segment.is_acute[0], to == 1.0 && segment.is_acute[1]];
        let at = match acute {
            [true, false] => shell(length) / whole,
            [false, true] => 1.0 - shell(length) / whole,
            _ => 0.5 * (from + to),
        };
        (from < at && at < to).then(|| (between(a, b, at), at))
    }

    /// Cuts a piece at vertex `v`: the piece keeps its first part; returns the number of the second.
    pub(super) fn cut(&mut self, piece: usize, v: VertexId, at: f64) -> usize {
        let second = self.list.len();
        let first = &mut self.list[piece];
        let mut rest = *first;
        first.ends[1] = v;
        first.stretch[1] = at;
        rest.ends[0] = v;
        rest.stretch[0] = at;
        self.list.push(rest);
        if self.on.len() <= v.index() {
            self.on.resize(v.index() + 1, ON_NONE);
        }
        self.on[v.index()] = rest.segment;
        second
    }

    /// Whether an edge is so short that points laid beside it would be moved visibly by rounding.
    pub(super) fn are_too_close(&self, points: &[Point2], u: VertexId, w: VertexId) -> bool {
        points[u.index()].distance(points[w.index()]) < PIECE_MIN * self.unit
    }

    /// Whether two vertices lie on two segments that meet, as far from their common corner: the
    /// edge between them is as short as the corner is sharp, and no point can change that (Miller,
    /// Pav and Walkington 2003).
    pub(super) fn are_on_one_shell(&self, points: &[Point2], u: VertexId, w: VertexId) -> bool {
        let on = |v: VertexId| self.on.get(v.index()).copied().filter(|&s| s != ON_NONE);
        let (Some(s), Some(t)) = (on(u), on(w)) else { return false };
        if s == t {
            return false;
        }
        let [s, t] = [s, t].map(|i| self.segments[i as usize].ends);
        let corner = s.into_iter().find(|v| t.contains(v));
        corner.is_some_and(|corner| {
            let [du, dw] = [u, w].map(|v| points[v.index()].distance(points[corner.index()]));
            (du - dw).abs() <= SHELL * du.min(dw)
        })
    }
}

/// The unit in the last place of the largest coordinate; among subnormal numbers that is the least of
/// them, which `quantum` stands for where coordinates were scaled.
pub(crate) fn last_place(points: &[Point2], quantum: Option<f64>) -> f64 {
    let largest = points.iter().flat_map(|p| [p.x.abs(), p.y.abs()]).fold(0.0, f64::max);
    (f64::EPSILON * largest).max(quantum.unwrap_or(0.0))
}

/// The power of two from a third to two thirds of a length.
fn shell(length: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    f64::from_bits((length * (2.0 / 3.0)).to_bits() & EXPONENT)
}

/// The point at `at` from `a` (0) to `b` (1), computed from the nearer end: three roundings, each
/// of at most half a unit in the last place of the largest coordinate, and none at all across a
/// horizontal or vertical segment.
fn between(a: Point2, b: Point2, at: f64) -> Point2 {
    let (near, far, at) = if at <= 0.5 { (a, b, at) } else { (b, a, 1.0 - at) };
    Point2::new(near.x + at * (far.x - near.x), near.y + at * (far.y - near.y))
}

fn is_acute(v: Point2, p: Point2, q: Point2) -> bool {
    let (px, py, qx, qy) = (p.x - v.x, p.y - v.y, q.x - v.x, q.y - v.y);
    let dot = px * qx + py * qy;
    dot > ACUTE_COSINE * ((px * px + py * py).sqrt() * (qx * qx + qy * qy).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edge(a: u32, b: u32, interior: bool) -> FrontEdge {
        let vertices = [a, b].map(VertexId);
        FrontEdge { half_edge: HalfEdgeId(0), vertices, segment: 0, marker: 0, interior }
    }

    fn corner(degrees: f64) -> (Vec<Point2>, Pieces) {
        let angle = degrees.to_radians();
        let far = Point2::new(3.2 * libm::cos(angle), 3.2 * libm::sin(angle));
        let points = vec![Point2::new(0.0, 0.0), Point2::new(2.5, 0.0), far];
        let pieces = Pieces::new(&points, &[edge(0, 1, false), edge(2, 0, false)], f64::EPSILON);
        (points, pieces)
    }

    #[test]
    fn beside_an_acute_corner_pieces_end_on_powers_of_two() {
        for (degrees, first, second) in [(59.0, 1.0, 2.0), (61.0, 1.25, 1.6), (5.0, 1.0, 2.0)] {
            let (points, pieces) = corner(degrees);
            let at = |i: usize| pieces.middle(&points, &pieces.list[i]).unwrap().0;
            assert!((at(0).distance(points[0]) - first).abs() < 1e-15, "{degrees}");
            assert!((at(1).distance(points[0]) - second).abs() < 1e-15, "{degrees}");
        }
    }

    #[test]
    fn shells_are_from_one_to_two_thirds() {
        for i in 1..1000 {
            let length = f64::from(i) * 0.013;
            let ratio = shell(length) / length;
            assert!((1.0 / 3.0..=2.0 / 3.0).contains(&ratio), "{length}: {ratio}");
        }
    }

    #[test]
    fn nodes_of_a_segment_that_is_split_often_stay_on_it() {
        let points = [[0.1, 0.7], [1.9, 1.3]].map(Point2::from).to_vec();
        let mut pieces = Pieces::new(&points, &[edge(0, 1, false)], f64::EPSILON);
        for round in 0..30 {
            let piece = pieces.list[round % 2];
            let (p, at) = pieces.middle(&points, &piece).unwrap();
            let off = (p.x - 0.1) * 0.6 - (p.y - 0.7) * 1.8;
            assert!(off.abs() / 1.9 < 4.0 * f64::EPSILON, "{off}");
            pieces.cut(round % 2, VertexId(2 + round as u32), at);
        }
        assert_eq!(pieces.list.len(), 31);
    }

    #[test]
    fn level_segments_stay_level() {
        let points = [[0.1, 0.3], [0.7, 0.3]].map(Point2::from).to_vec();
        let pieces = Pieces::new(&points, &[edge(0, 1, false)], f64::EPSILON);
        assert_eq!(pieces.middle(&points, &pieces.list[0]).unwrap().0.y, 0.3);
    }

    #[test]
    fn what_is_too_short_stays_whole() {
        for (length, is_split) in [(1e-13, false), (9e-10, false), (1e-9, true)] {
            let points = [[1.0, 1.0], [1.0, 1.0 - length]].map(Point2::from).to_vec();
            let pieces = Pieces::new(&points, &[edge(0, 1, false)], f64::EPSILON);
            let middle = pieces.middle(&points, &pieces.list[0]);
            assert_eq!(middle.is_some(), is_split, "{length}");
        }
        let points = [[0.0, 0.0], [1.0, 0.0]].map(Point2::from).to_vec();
        let mut pieces = Pieces::new(&points, &[edge(0, 1, false)], f64::EPSILON);
        let mut count = 0;
        while let Some((_, at)) = pieces.middle(&points, &pieces.list[0]) {
            count += 1;
            pieces.cut(0, VertexId(1 + count), at);
        }
        assert_eq!(count, 40, "halves down to 4096 units in the last place");
    }

    #[test]
    fn vertices_on_one_shell_are_those_as_far_from_a_common_corner() {
        let (mut points, mut pieces) = corner(20.0);
        let turned = |r: f64| {
            let angle = 20.0_f64.to_radians();
            Point2::new(r * libm::cos(angle), r * libm::sin(angle))
        };
        points.extend([Point2::new(1.0, 0.0), turned(1.0), turned(0.5)]);
        pieces.cut(0, VertexId(3), 0.4);
        pieces.cut(1, VertexId(4), 0.6875);
        pieces.cut(1, VertexId(5), 0.84375);
        let shell = |u, w| pieces.are_on_one_shell(&points, VertexId(u), VertexId(w));
        assert!(shell(3, 4) && shell(4, 3));
        assert!(!shell(3, 5), "another distance");
        assert!(!shell(4, 5), "the same segment");
        assert!(!shell(1, 2) && !shell(0, 3), "vertices of the domain");
    }

    #[test]
    fn a_constraint_is_one_piece_with_two_sides() {
        let points = [[0.0, 0.0], [1.0, 0.0]].map(Point2::from).to_vec();
        let pieces = Pieces::new(&points, &[edge(0, 1, true), edge(1, 0, true)], f64::EPSILON);
        assert_eq!(pieces.list.len(), 1);
        assert!(pieces.list[0].sides.iter().all(Option::is_some));
        assert_eq!(side_of(owner(7, 1)), (7, 1));
    }
}
