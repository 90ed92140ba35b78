//! How two closed segments meet, and where a point lies on a segment or a triangle: all exact.

use super::{Sign, orient2d};
use crate::point::Point2;

/// One end of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SegmentEnd {
    /// The first of its two points.
    Start,
    /// The second of its two points.
    End,
}

/// One of the two segments given to [`classify`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum WhichSegment {
    /// The segment `ab`.
    First,
    /// The segment `cd`.
    Second,
}

/// How two closed segments meet, as [`classify`] tells it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SegmentIntersection {
    /// They have no point in common.
    Disjoint,
    /// Their interiors have exactly one point in common, and they are not collinear.
    ProperCrossing,
    /// Their only common point is an end of both.
    SharedEndpoint {
        /// Which end of the first segment; `Start` if it has no length.
        first: SegmentEnd,
        /// Which end of the second segment; `Start` if it has no length.
        second: SegmentEnd,
    },
    /// Their only common point is an end of one and lies in the interior of the other.
    EndpointInInterior {
        /// The segment whose end it is.
        segment: WhichSegment,
        /// Which end of that segment; `Start` if it has no length.
        end: SegmentEnd,
    },
    /// They are collinear, share more than a point, and are not the same.
    CollinearOverlap {
        /// Lexicographically smallest common point, an end of one of them.
        from: Point2,
        /// Lexicographically largest common point, an end of one of them.
        to: Point2,
    },
    /// They are the same set of points, in either direction; both may be the same single point.
    Identical,
}

/// How the closed segments `ab` and `cd` meet. Either may have no length.
///
/// **Laws.** Exchanging the segments or the ends of one changes nothing but the names in the answer.
///
/// **Requires** finite coordinates. **Guarantees** P9.
///
/// # Examples
///
/// ```
/// use trigrade::{point::Point2, predicates::{classify, SegmentIntersection}};
/// let [a, b, c, d] = [[0.0, 0.0], [2.0, 2.0], [0.0, 2.0], [2.0, 0.0]].map(Point2::from);
/// assert_eq!(classify(a, b, c, d), SegmentIntersection::ProperCrossing);
/// ```
#[must_use]
pub fn classify(a: Point2, b: Point2, c: Point2, d: Point2) -> SegmentIntersection {
    if !boxes_meet(a, b, c, d) {
        return SegmentIntersection::Disjoint;
    }
    let (c_side, d_side) = (orient2d(a, b, c), orient2d(a, b, d));
    let (a_side, b_side) = (orient2d(c, d, a), orient2d(c, d, b));
    match [c_side, d_side, a_side, b_side] {
        // All four points are on one line, also when a segment has no length and lies on the other's
        // line; then the ends' order along that line decides.
        [Sign::Zero, Sign::Zero, Sign::Zero, Sign::Zero] => classify_collinear(a, b, c, d),
        _ if same_strict_side(c_side, d_side) || same_strict_side(a_side, b_side) => {
            SegmentIntersection::Disjoint
        }
        sides if sides.contains(&Sign::Zero) => classify_touch([a, b, c, d], sides),
        _ => SegmentIntersection::ProperCrossing,
    }
}

fn same_strict_side(p: Sign, q: Sign) -> bool {
    p == q && p != Sign::Zero
}

/// Two segments on one line.
fn classify_collinear(a: Point2, b: Point2, c: Point2, d: Point2) -> SegmentIntersection {
    let ((a_low, a_high), (c_low, c_high)) = (sorted(a, b), sorted(c, d));
    let from = if a_low.lexicographic(c_low).is_lt() { c_low } else { a_low };
    let to = if a_high.lexicographic(c_high).is_lt() { a_high } else { c_high };
    if (a_low, a_high) == (c_low, c_high) {
        SegmentIntersection::Identical
    } else if from == to {
        meet_at(from, [a, b, c, d])
    } else if from.lexicographic(to).is_lt() {
        SegmentIntersection::CollinearOverlap { from, to }
    } else {
        SegmentIntersection::Disjoint
    }
}

/// Two segments that meet in one point and are not both on one line: the point is the end that lies
/// on the other's line.
fn classify_touch(points: [Point2; 4], sides: [Sign; 4]) -> SegmentIntersection {
    let [a, b, c, d] = points;
    let ends = [(c, sides[0]), (d, sides[1]), (a, sides[2]), (b, sides[3])];
    ends.into_iter()
        .find(|&(end, side)| {
            side == Sign::Zero && on_collinear_segment(end, a, b) && on_collinear_segment(end, c, d)
        })
        .map_or(SegmentIntersection::Disjoint, |(end, _)| meet_at(end, points))
}

/// The name of a meeting in the single point `p`, an end of at least one of the segments.
fn meet_at(p: Point2, [a, b, c, d]: [Point2; 4]) -> SegmentIntersection {
    match (end_at(p, a, b), end_at(p, c, d)) {
        (Some(first), Some(second)) => SegmentIntersection::SharedEndpoint { first, second },
        (Some(end), None) => {
            SegmentIntersection::EndpointInInterior { segment: WhichSegment::First, end }
        }
        (None, Some(end)) => {
            SegmentIntersection::EndpointInInterior { segment: WhichSegment::Second, end }
        }
        (None, None) => unreachable!("segments that touch do so at an end"),
    }
}

fn end_at(p: Point2, start: Point2, end: Point2) -> Option<SegmentEnd> {
    if p == start {
        Some(SegmentEnd::Start)
    } else if p == end {
        Some(SegmentEnd::End)
    } else {
        None
    }
}

fn sorted(p: Point2, q: Point2) -> (Point2, Point2) {
    if q.lexicographic(p).is_lt() { (q, p) } else { (p, q) }
}

/// Whether the closed bounding boxes of `ab` and `cd` meet.
fn boxes_meet(a: Point2, b: Point2, c: Point2, d: Point2) -> bool {
    let meet = |a: f64, b: f64, c: f64, d: f64| a.min(b) <= c.max(d) && c.min(d) <= a.max(b);
    meet(a.x, b.x, c.x, d.x) && meet(a.y, b.y, c.y, d.y)
}

/// Whether `p` lies on the closed segment `ab`, which may have no length.
///
/// **Requires** finite coordinates. **Guarantees** P10.
#[must_use]
pub fn point_on_segment(p: Point2, a: Point2, b: Point2) -> bool {
    on_collinear_segment(p, a, b) && orient2d(a, b, p) == Sign::Zero
}

/// Whether `p`, known to be collinear with `a` and `b`, lies on the closed segment `ab`.
///
/// Compares coordinates only. For any other `p` it says whether it lies in the bounding box.
#[must_use]
pub fn on_collinear_segment(p: Point2, a: Point2, b: Point2) -> bool {
    let between = |p: f64, a: f64, b: f64| a.min(b) <= p && p <= a.max(b);
    between(p.x, a.x, b.x) && between(p.y, a.y, b.y)
}

/// Where a point lies in regard to a closed triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PointInTriangle {
    /// In the interior.
    Inside,
    /// In the interior of the edge from corner `i` to corner `i + 1` (mod 3).
    OnEdge(usize),
    /// At the corner.
    AtCorner(usize),
    /// Not in the closed triangle.
    Outside,
}

/// Where `p` lies in regard to the closed triangle with counterclockwise `corners`.
///
/// **Requires** finite coordinates, `orient2d` of the corners `Positive`. **Guarantees** P10.
#[must_use]
pub fn point_in_triangle(p: Point2, corners: [Point2; 3]) -> PointInTriangle {
    let [a, b, c] = corners;
    match [orient2d(a, b, p), orient2d(b, c, p), orient2d(c, a, p)] {
        sides if sides.contains(&Sign::Negative) => PointInTriangle::Outside,
        [Sign::Zero, _, Sign::Zero] => PointInTriangle::AtCorner(0),
        [Sign::Zero, Sign::Zero, _] => PointInTriangle::AtCorner(1),
        [_, Sign::Zero, Sign::Zero] => PointInTriangle::AtCorner(2),
        [Sign::Zero, _, _] => PointInTriangle::OnEdge(0),
        [_, Sign::Zero, _] => PointInTriangle::OnEdge(1),
        [_, _, Sign::Zero] => PointInTriangle::OnEdge(2),
        _ => PointInTriangle::Inside,
    }
}
