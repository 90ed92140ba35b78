//! The convex hull of sorted points.

use crate::point::Point2;
use crate::predicates::{Sign, orient2d};

/// The hull of sorted points, counterclockwise, with the points on its edges; empty if all
/// are on one line. (Andrew, *Another efficient algorithm for convex hulls in two dimensions*,
/// 1979.)
pub(crate) fn convex_hull(points: &[Point2]) -> Vec<u32> {
    let on_line = |v: &u32| {
        let last = points.len() - 1;
        orient2d(points[0], points[last], points[*v as usize]) == Sign::Zero
    };
    if points.len() < 3 || (0..points.len() as u32).all(|v| on_line(&v)) {
        return Vec::new();
    }
    let mut lower = chain(points, 0..points.len() as u32);
    let mut upper = chain(points, (0..points.len() as u32).rev());
    lower.pop();
    upper.pop();
    lower.append(&mut upper);
    lower
}

fn chain(points: &[Point2], order: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut chain: Vec<u32> = Vec::new();
    let at = |v: u32| points[v as usize];
    for v in order {
        while let [.., a, b] = chain[..] {
            if orient2d(at(a), at(b), at(v)) != Sign::Negative {
                break;
            }
            chain.pop();
        }
        chain.push(v);
    }
    chain
}
