//! Which loop lies in which: exactly, loop by loop. Slow and simple; not the validator's way.

use crate::domain::{Domain, LoopRole};
use crate::point::Point2;
use crate::predicates::{Sign, orient2d, point_on_segment};

/// Where a loop stands among the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level {
    /// How many loops are around it.
    pub depth: usize,
    /// The innermost of those.
    pub around: Option<usize>,
}

impl Level {
    /// Whether the domain lies inside the loop, next to it.
    pub const fn is_outer(self) -> bool {
        self.depth.is_multiple_of(2)
    }
}

/// Whether a point lies inside a loop; `None` when it lies on it.
pub fn is_inside(domain: &Domain, of: usize, p: Point2) -> Option<bool> {
    let mut inside = false;
    for [a, b] in domain.loops[of].edges() {
        let [a, b] = [a, b].map(|v| domain.points[v as usize]);
        if point_on_segment(p, a, b) {
            return None;
        }
        if (a.y > p.y) != (b.y > p.y) {
            let left = orient2d(a, b, p) == Sign::Positive;
            inside ^= left == (b.y > a.y);
        }
    }
    Some(inside)
}

/// Whether loop `inner` lies in loop `outer`; `None` when all its vertices lie on that.
fn lies_in(domain: &Domain, inner: usize, outer: usize) -> Option<bool> {
    let points = domain.loops[inner].vertices.iter().map(|&v| domain.points[v as usize]);
    points.into_iter().find_map(|p| is_inside(domain, outer, p))
}

/// A box around each loop.
fn boxes(domain: &Domain) -> Vec<[Point2; 2]> {
    let of = |l: &crate::domain::Loop| {
        let points = l.vertices.iter().map(|&v| domain.points[v as usize]);
        let bounds = crate::domain::BoundingBox::of(points);
        bounds.map_or([Point2::new(0.0, 0.0); 2], |b| [b.min, b.max])
    };
    domain.loops.iter().map(of).collect()
}

/// The levels of all loops, or `None` where touching loops hide them. Claimed roles are taken
/// at their word, so that a false claim is written as it is made.
pub fn levels(domain: &Domain) -> Option<Vec<Level>> {
    let claimed = domain.loops.iter().map(|l| match l.role {
        LoopRole::Any => None,
        LoopRole::Outer => Some(Level { depth: 0, around: None }),
        LoopRole::HoleOf(of) => Some(Level { depth: 1, around: Some(of) }),
    });
    if let Some(claimed) = claimed.collect::<Option<Vec<Level>>>() {
        return Some(claimed);
    }
    let boxes = boxes(domain);
    let count = domain.loops.len();
    let around = (0..count).map(|i| {
        let holds = |j: &usize| {
            let ([a, b], [c, d]) = (boxes[i], boxes[*j]);
            *j != i && c.x <= a.x && c.y <= a.y && d.x >= b.x && d.y >= b.y
        };
        let candidates = (0..count).filter(holds);
        let tested = candidates.map(|j| Some((j, lies_in(domain, i, j)?)));
        let tested: Option<Vec<(usize, bool)>> = tested.collect();
        tested.map(|all| all.into_iter().filter(|t| t.1).map(|t| t.0).collect::<Vec<_>>())
    });
    let around: Vec<Vec<usize>> = around.collect::<Option<_>>()?;
    let innermost = |all: &Vec<usize>| all.iter().copied().max_by_key(|&j| around[j].len());
    Some(around.iter().map(|all| Level { depth: all.len(), around: innermost(all) }).collect())
}

/// Whether a point lies in the domain by the even-odd rule; `None` when it lies on a loop.
fn is_in_domain(domain: &Domain, p: Point2) -> Option<bool> {
    let inside = (0..domain.loops.len()).map(|of| is_inside(domain, of, p));
    inside.into_iter().try_fold(false, |parity, inside| Some(parity ^ inside?))
}

/// Whether all segments and isolated points lie in the domain. A segment that crosses no loop lies
/// where one of its ends or its middle does; one with all three on loops counts as outside.
pub fn constraints_are_inside(domain: &Domain) -> bool {
    let point = |v: usize| domain.points[v];
    let is_in = |points: &[Point2]| {
        points.iter().find_map(|&p| is_in_domain(domain, p)).unwrap_or_default()
    };
    let segment_is_in = |[a, b]: [u32; 2]| {
        let [p, q] = [a, b].map(|v| point(v as usize));
        is_in(&[p, q, Point2::new(0.5 * p.x + 0.5 * q.x, 0.5 * p.y + 0.5 * q.y)])
    };
    domain.segments.iter().all(|s| segment_is_in(s.vertices))
        && domain.isolated_points().into_iter().all(|v| is_in(&[point(v)]))
}
