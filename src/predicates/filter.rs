//! First rung: floating point with an a-priori error bound.
//!
//! Notation: u = 2^-53 is the unit roundoff, so fl(x op y) = (x op y)(1 + δ), |δ| <= u, but for a
//! product that underflows, which has an absolute error of at most η = 2^-1075 instead; sums and
//! differences never underflow inexactly. θ_k stands for any product of k factors (1 + δ)^±1, minus
//! one; |θ_k| <= k u / (1 - k u) < 1.0000001 k u for the k below (Higham, Accuracy and Stability of
//! Numerical Algorithms, 3.1).
//!
//! Overflow needs no test of its own: an infinite or NaN intermediate makes the bound infinite or
//! NaN, and then neither comparison holds.
//!
//! The shape is Shewchuk's stage A (Adaptive Precision Floating-Point Arithmetic, 1997, 4.3 and
//! 4.4), with an underflow term his analysis excludes.

use super::Sign;
use crate::point::Point2;

const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// 2^-1022, beside which every underflow error is small.
pub(super) const UNDERFLOW: f64 = f64::MIN_POSITIVE;

/// Bound of the relative error of `orient2d`: 4u.
///
/// The computed products l and r stand for the exact l(1 + θ_3) and r(1 + θ_3): a rounding each for
/// two differences and the product. So the exact determinant is l - r up to 3.0000003 u (|l| + |r|).
/// fl(l - r) has the sign of l - r and at most (1 + u) times its size, and the computed bound loses
/// at most a factor (1 - u)^3; the remaining 0.99 u (|l| + |r|) covers both.
pub(super) const ORIENT2D_ERROR: f64 = 4.0 * UNIT_ROUNDOFF;

/// Bound of the relative error of `incircle`: 14u.
///
/// Roundings behind each value: a difference 1, a product 3, a 2x2 minor 4, a lift (a sum of squares)
/// 4, their product 9, the sum of three of them 11. So the computed determinant is off by at most
/// |θ_11| P, where P is the permanent in exact arithmetic, itself the computed one up to another
/// θ_11, a second-order term. The computed bound loses at most (1 - u)^3.
pub(super) const INCIRCLE_ERROR: f64 = 14.0 * UNIT_ROUNDOFF;

/// The sign of `orient2d` if the float result exceeds its error bound.
///
/// Underflow: either product may be off by η, together 2^-1074, far below [`UNDERFLOW`].
#[inline(always)]
pub(super) fn orient2d(a: Point2, b: Point2, c: Point2) -> Option<Sign> {
    let left = (a.x - c.x) * (b.y - c.y);
    let right = (a.y - c.y) * (b.x - c.x);
    let bound = ORIENT2D_ERROR * (left.abs() + right.abs()) + UNDERFLOW;
    decide(left - right, bound)
}

/// The sign of `incircle` if the float result exceeds its error bound.
///
/// Underflow: each of the six products of differences may be off by η and is multiplied by a lift;
/// each of the six squares may be off by η and is multiplied by a minor, at most the sum of two
/// lifts; the last three products may be off by η. With L the sum of the lifts that is at most
/// 10 η (L + 1), while `UNDERFLOW * (L + 1)` is 2^53 η (L + 1): room enough for its own roundings
/// and for an L that suffered from underflow itself.
#[inline(always)]
pub(super) fn incircle(a: Point2, b: Point2, c: Point2, d: Point2) -> Option<Sign> {
    let (adx, ady) = (a.x - d.x, a.y - d.y);
    let (bdx, bdy) = (b.x - d.x, b.y - d.y);
    let (cdx, cdy) = (c.x - d.x, c.y - d.y);
    let (bc, cb) = (bdx * cdy, cdx * bdy);
    let (ca, ac) = (cdx * ady, adx * cdy);
    let (ab, ba) = (adx * bdy, bdx * ady);
    let a_lift = adx * adx + ady * ady;
    let b_lift = bdx * bdx + bdy * bdy;
    let c_lift = cdx * cdx + cdy * cdy;
    let det = a_lift * (bc - cb) + b_lift * (ca - ac) + c_lift * (ab - ba);
    let permanent = a_lift * (bc.abs() + cb.abs())
        + b_lift * (ca.abs() + ac.abs())
        + c_lift * (ab.abs() + ba.abs());
    let underflow = UNDERFLOW * (a_lift + b_lift + c_lift + 1.0);
    decide(det, INCIRCLE_ERROR * permanent + underflow)
}

/// One branch for the bound, which is seldom missed, and none for the sign, which nobody can predict.
#[inline(always)]
pub(super) fn decide(det: f64, bound: f64) -> Option<Sign> {
    let sign = if det > 0.0 { Sign::Positive } else { Sign::Negative };
    (det.abs() > bound).then_some(sign)
}
