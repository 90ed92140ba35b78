//! Third rung: Shewchuk's adaptive expansions, from the `robust` crate, where they are safe.
//!
//! An expansion holds a number as an unevaluated sum of floats, so it is exact only while none of
//! its terms overflows or underflows. Two coordinates of at least 2^-142 (or zero) differ by a
//! multiple of 2^-194, and a product of four such differences and all its rounding errors is a
//! multiple of 2^-776, above the least subnormal 2^-1074. At most 2^201 each, the products stay below
//! 2^820 and overflow in no intermediate. Outside, `incircle` was seen to lose its sign from about
//! 2^-218 down and to turn NaN from about 2^252 up.

use super::Sign;
use crate::point::Point2;

/// 2^-142.
const LEAST: f64 = f64::from_bits((1023 - 142) << 52);
/// 2^201.
const GREATEST: f64 = f64::from_bits((1023 + 201) << 52);

/// The sign of `orient2d` if all coordinates are in the safe range.
pub(super) fn orient2d(a: Point2, b: Point2, c: Point2) -> Option<Sign> {
    let safe = [a, b, c].into_iter().all(is_safe);
    safe.then(|| Sign::of(robust::orient2d(coord(a), coord(b), coord(c))))
}

/// The sign of `incircle` if all coordinates are in the safe range.
pub(super) fn incircle(a: Point2, b: Point2, c: Point2, d: Point2) -> Option<Sign> {
    let safe = [a, b, c, d].into_iter().all(is_safe);
    safe.then(|| Sign::of(robust::incircle(coord(a), coord(b), coord(c), coord(d))))
}

fn is_safe(p: Point2) -> bool {
    let safe = |v: f64| v == 0.0 || (LEAST..=GREATEST).contains(&v.abs());
    safe(p.x) && safe(p.y)
}

fn coord(p: Point2) -> robust::Coord<f64> {
    robust::Coord { x: p.x, y: p.y }
}
