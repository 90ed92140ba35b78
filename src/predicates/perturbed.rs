//! Ties of [`incircle`](super::incircle) broken by a symbolic perturbation of the lifted heights.
//!
//! Definition and the argument for uniqueness: SPEC 2.2. The device is Edelsbrunner and Mücke's
//! (Simulation of Simplicity, 1990), applied to the height alone as by Alliez, Devillers and
//! Snoeyink (Removing Degeneracies by Perturbing the Problem or Perturbing the World, 2000): points
//! stay where they are, so [`orient2d`] keeps its zeros.

use super::{Sign, filter, ladder, orient2d};
use crate::point::Point2;

/// [`incircle`](super::incircle) under the symbolic perturbation of the lifted heights: `Zero` only
/// if all four points are collinear or two of them are equal.
///
/// Every point's height x^2 + y^2 gets an infinitesimal of its own added, infinitely larger for the
/// lexicographically larger point. So the largest of four cocircular points counts as outside the
/// circle through the others.
///
/// **Laws.** An odd permutation of the arguments reverses the sign, an even one keeps it.
///
/// **Requires** finite coordinates. **Guarantees** P6, P7, P8.
///
/// # Examples
///
/// ```
/// use trigrade::{point::Point2, predicates::{incircle_perturbed, Sign}};
/// let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point2::from);
/// assert_eq!(incircle_perturbed(a, b, d, c), Sign::Negative); // the square is cut from b to d
/// ```
#[inline]
#[must_use]
pub fn incircle_perturbed(a: Point2, b: Point2, c: Point2, d: Point2) -> Sign {
    match filter::incircle(a, b, c, d) {
        Some(sign) => sign,
        None => unfiltered(a, b, c, d),
    }
}

#[cold]
#[inline(never)]
pub(super) fn unfiltered(a: Point2, b: Point2, c: Point2, d: Point2) -> Sign {
    match ladder::incircle_unfiltered(a, b, c, d).0 {
        Sign::Zero => tie_break([a, b, c, d]),
        sign => sign,
    }
}

/// Sign of the determinant's perturbation: the cofactor of the largest point that has a nonzero one.
fn tie_break(points: [Point2; 4]) -> Sign {
    let order = descending(&points);
    // Equal points are one point with one height: the determinant has two equal rows.
    if order.windows(2).any(|pair| points[pair[0]] == points[pair[1]]) {
        return Sign::Zero;
    }
    order
        .into_iter()
        .map(|i| height_cofactor(points, i))
        .find(|&sign| sign != Sign::Zero)
        .unwrap_or(Sign::Zero)
}

/// Indices of the points from the lexicographically largest to the smallest, by insertion.
fn descending(points: &[Point2; 4]) -> [usize; 4] {
    let mut order = [0, 1, 2, 3];
    for end in 1..4 {
        let mut i = end;
        while i > 0 && precedes(points[order[i - 1]], points[order[i]]) {
            order.swap(i - 1, i);
            i -= 1;
        }
    }
    order
}

/// Whether [`Point2::lexicographic`] is `Less`, for finite coordinates.
fn precedes(p: Point2, q: Point2) -> bool {
    p.x < q.x || (p.x == q.x && p.y < q.y)
}

/// Sign of the cofactor of point `i`'s height in the determinant with rows (x, y, height, 1).
fn height_cofactor([a, b, c, d]: [Point2; 4], i: usize) -> Sign {
    match i {
        0 => orient2d(b, c, d),
        1 => orient2d(a, c, d).reversed(),
        2 => orient2d(a, b, d),
        _ => orient2d(a, b, c).reversed(),
    }
}
