//! The ladder itself: which rung is asked when.

use super::{Sign, adaptive, exact, filter, fixed};
use crate::point::Point2;

/// The rung that answered, cheapest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Rung {
    /// Floats with an error bound.
    Filter,
    /// Integers of at most 128 bits.
    Fixed128,
    /// Integers of at most 256 bits.
    Fixed256,
    /// Integers of at most 512 bits.
    Fixed512,
    /// Adaptive expansions of floats (`robust`).
    Adaptive,
    /// An accumulator as wide as the whole exponent range.
    Exact,
}

/// Which side of the line from `a` to `b` the point `c` lies on: `Positive` on the left.
///
/// The sign of twice the signed area of the triangle `a`, `b`, `c`.
///
/// **Laws.** Two arguments exchanged: the sign is reversed. Arguments rotated: the same sign. Scaled
/// by a power of two or moved, where that is exact: the same sign.
///
/// **Requires** finite coordinates. **Guarantees** P1, P3, P4.
///
/// # Examples
///
/// ```
/// use trigrade::{point::Point2, predicates::{orient2d, Sign}};
/// let [a, b] = [Point2::new(0.0, 0.0), Point2::new(1e300, 1e300)];
/// assert_eq!(orient2d(a, b, Point2::new(1e-310, 2e-310)), Sign::Positive);
/// ```
#[inline]
#[must_use]
pub fn orient2d(a: Point2, b: Point2, c: Point2) -> Sign {
    match filter::orient2d(a, b, c) {
        Some(sign) => sign,
        None => orient2d_unfiltered(a, b, c).0,
    }
}

/// [`orient2d`], and the rung that answered.
#[must_use]
pub fn orient2d_with_rung(a: Point2, b: Point2, c: Point2) -> (Sign, Rung) {
    match filter::orient2d(a, b, c) {
        Some(sign) => (sign, Rung::Filter),
        None => orient2d_unfiltered(a, b, c),
    }
}

#[cold]
#[inline(never)]
pub(super) fn orient2d_unfiltered(a: Point2, b: Point2, c: Point2) -> (Sign, Rung) {
    if let Some(answer) = fixed::orient2d(a, b, c) {
        answer
    } else if let Some(sign) = adaptive::orient2d(a, b, c) {
        (sign, Rung::Adaptive)
    } else {
        (exact::orient2d(a, b, c), Rung::Exact)
    }
}

/// Whether `d` lies inside (`Positive`), on (`Zero`) or outside the circle through the
/// counterclockwise `a`, `b`, `c`.
///
/// The sign of the 4x4 determinant with rows (x, y, x^2 + y^2, 1); for a clockwise `a`, `b`, `c`
/// inside and outside are exchanged.
///
/// **Laws.** An odd permutation of the arguments reverses the sign, an even one keeps it. Scaled by
/// a power of two or moved, where that is exact: the same sign.
///
/// **Requires** finite coordinates. **Guarantees** P2, P3, P4.
#[inline]
#[must_use]
pub fn incircle(a: Point2, b: Point2, c: Point2, d: Point2) -> Sign {
    match filter::incircle(a, b, c, d) {
        Some(sign) => sign,
        None => incircle_unfiltered(a, b, c, d).0,
    }
}

/// [`incircle`], and the rung that answered.
#[must_use]
pub fn incircle_with_rung(a: Point2, b: Point2, c: Point2, d: Point2) -> (Sign, Rung) {
    match filter::incircle(a, b, c, d) {
        Some(sign) => (sign, Rung::Filter),
        None => incircle_unfiltered(a, b, c, d),
    }
}

/// The rungs above the filter.
#[cold]
#[inline(never)]
pub(super) fn incircle_unfiltered(a: Point2, b: Point2, c: Point2, d: Point2) -> (Sign, Rung) {
    if let Some(answer) = fixed::incircle(a, b, c, d) {
        answer
    } else if let Some(sign) = adaptive::incircle(a, b, c, d) {
        (sign, Rung::Adaptive)
    } else {
        (exact::incircle(a, b, c, d), Rung::Exact)
    }
}

/// What each rung that can answer says, so that tests and fuzzers can compare them.
#[doc(hidden)]
#[must_use]
pub fn orient2d_by_every_rung(a: Point2, b: Point2, c: Point2) -> Vec<(Sign, Rung)> {
    let answers = [
        filter::orient2d(a, b, c).map(|sign| (sign, Rung::Filter)),
        fixed::orient2d(a, b, c),
        adaptive::orient2d(a, b, c).map(|sign| (sign, Rung::Adaptive)),
        Some((exact::orient2d(a, b, c), Rung::Exact)),
    ];
    answers.into_iter().flatten().collect()
}

/// What each rung that can answer says, so that tests and fuzzers can compare them.
#[doc(hidden)]
#[must_use]
pub fn incircle_by_every_rung(a: Point2, b: Point2, c: Point2, d: Point2) -> Vec<(Sign, Rung)> {
    let answers = [
        filter::incircle(a, b, c, d).map(|sign| (sign, Rung::Filter)),
        fixed::incircle(a, b, c, d),
        adaptive::incircle(a, b, c, d).map(|sign| (sign, Rung::Adaptive)),
        Some((exact::incircle(a, b, c, d), Rung::Exact)),
    ];
    answers.into_iter().flatten().collect()
}
