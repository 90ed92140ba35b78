//! Second rung: integers of fixed width.
//!
//! Coordinates are dyadic rationals, so the differences of a predicate are integers on a common
//! lattice of some power of two, and the determinant is homogeneous, so that power does not matter
//! for its sign. A difference of two floats is exactly a float plus a rounding error (Knuth's
//! two-sum; Shewchuk 1997, theorem 7). Points of one mesh are seldom far apart in exponent, so the
//! lattice is nearly always small: integer grids need a few bits, a grid times 0.1 about 45, points
//! on a circle rounded to f64 about 60. There expansions are at their slowest, while integers of 128
//! and 256 bits cost a few times the filter.

use super::wide::{Int256, sign_of_sum_of_products};
use super::{Rung, Sign};
use crate::point::Point2;

/// The sign of `orient2d` if the four differences fit one lattice of 126 bits.
pub(super) fn orient2d(a: Point2, b: Point2, c: Point2) -> Option<(Sign, Rung)> {
    let differences = Differences::of([(a.x, c.x), (a.y, c.y), (b.x, c.x), (b.y, c.y)])?;
    match differences.width {
        0..=62 => Some((orient2d_128(differences.narrow()), Rung::Fixed128)),
        63..=126 => Some((orient2d_256(differences.wide()), Rung::Fixed256)),
        _ => None,
    }
}

/// Differences below 2^62 in magnitude: products below 2^124.
fn orient2d_128([ax, ay, bx, by]: [i64; 4]) -> Sign {
    Sign::from(times(ax, by).cmp(&times(ay, bx)))
}

/// Differences below 2^126 in magnitude: products below 2^252.
fn orient2d_256([ax, ay, bx, by]: [i128; 4]) -> Sign {
    Int256::product(ax, by).minus(Int256::product(ay, bx)).sign()
}

/// The sign of `incircle` if the six differences fit one lattice of 126 bits.
pub(super) fn incircle(a: Point2, b: Point2, c: Point2, d: Point2) -> Option<(Sign, Rung)> {
    let from_d = |p: Point2| [(p.x, d.x), (p.y, d.y)];
    let [[ax, ay], [bx, by], [cx, cy]] = [from_d(a), from_d(b), from_d(c)];
    let differences = Differences::of([ax, ay, bx, by, cx, cy])?;
    match differences.width {
        0..=30 => Some((incircle_128(differences.narrow()), Rung::Fixed128)),
        31..=62 => Some((incircle_256(differences.narrow()), Rung::Fixed256)),
        63..=126 => Some((incircle_512(differences.wide()), Rung::Fixed512)),
        _ => None,
    }
}

/// Differences below 2^30 in magnitude: lifts and minors below 2^61, the sum of three of their
/// products below 2^124.
fn incircle_128([ax, ay, bx, by, cx, cy]: [i64; 6]) -> Sign {
    let det = times(ax * ax + ay * ay, bx * cy - cx * by)
        + times(bx * bx + by * by, cx * ay - ax * cy)
        + times(cx * cx + cy * cy, ax * by - bx * ay);
    Sign::from(det.cmp(&0))
}

/// Differences below 2^62 in magnitude: lifts and minors below 2^125, the sum below 2^252.
fn incircle_256([ax, ay, bx, by, cx, cy]: [i64; 6]) -> Sign {
    let lift = |x, y| times(x, x) + times(y, y);
    let minor = |px, py, qx, qy| times(px, qy) - times(qx, py);
    Int256::product(lift(ax, ay), minor(bx, by, cx, cy))
        .plus(Int256::product(lift(bx, by), minor(cx, cy, ax, ay)))
        .plus(Int256::product(lift(cx, cy), minor(ax, ay, bx, by)))
        .sign()
}

/// Differences below 2^126 in magnitude: lifts and minors below 2^253, the sum below 2^508.
fn incircle_512([ax, ay, bx, by, cx, cy]: [i128; 6]) -> Sign {
    let lift = |x, y| Int256::product(x, x).plus(Int256::product(y, y));
    let minor = |px, py, qx, qy| Int256::product(px, qy).minus(Int256::product(qx, py));
    sign_of_sum_of_products([
        (lift(ax, ay), minor(bx, by, cx, cy)),
        (lift(bx, by), minor(cx, cy, ax, ay)),
        (lift(cx, cy), minor(ax, ay, bx, by)),
    ])
}

#[inline(always)]
fn times(a: i64, b: i64) -> i128 {
    i128::from(a) * i128::from(b)
}

/// `N` exact differences and the lattice they share.
struct Differences<const N: usize> {
    rounded: [Dyadic; N],
    /// What rounding cut off the differences, if anything.
    errors: Option<[Dyadic; N]>,
    /// Exponent of the lattice's unit.
    unit: i32,
    /// Every difference is below 2^width units in magnitude.
    width: u32,
}

impl<const N: usize> Differences<N> {
    /// The differences of the pairs; nothing if one overflows.
    #[inline(always)]
    fn of(pairs: [(f64, f64); N]) -> Option<Self> {
        let split = pairs.map(|(a, b)| two_diff(a, b));
        let rounded = split.map(|(value, _)| Dyadic::of(value));
        // Bits, not comparisons, so that there is one branch for all.
        let error_bits = split.iter().fold(0, |bits, (_, error)| bits | error.abs().to_bits());
        let errors = (error_bits != 0).then(|| split.map(|(_, error)| Dyadic::of(error)));
        let mut unit = least_unit(&rounded);
        let mut top = greatest_top(&rounded);
        if let Some(errors) = &errors {
            unit = unit.min(least_unit(errors));
            top = top.max(greatest_top(errors));
        }
        // A value and its error add up to at most 2^top, since the sum rounds to the value; one bit
        // more makes the bound strict.
        let width = (top - unit + 1).max(0).unsigned_abs();
        (top <= Dyadic::GREATEST_TOP).then_some(Self { rounded, errors, unit, width })
    }

    /// The differences in units, for a width of at most 62.
    #[inline(always)]
    fn narrow(&self) -> [i64; N] {
        let mut differences = self.rounded.map(|part| part.in_units(self.unit));
        if let Some(errors) = &self.errors {
            for (difference, error) in differences.iter_mut().zip(errors) {
                *difference += error.in_units(self.unit);
            }
        }
        differences
    }

    /// The differences in units, for a width of at most 126.
    fn wide(&self) -> [i128; N] {
        let mut differences = self.rounded.map(|part| part.in_wide_units(self.unit));
        if let Some(errors) = &self.errors {
            for (difference, error) in differences.iter_mut().zip(errors) {
                *difference += error.in_wide_units(self.unit);
            }
        }
        differences
    }
}

#[inline(always)]
fn least_unit(parts: &[Dyadic]) -> i32 {
    parts.iter().fold(Dyadic::ZERO.unit, |unit, part| unit.min(part.unit))
}

#[inline(always)]
fn greatest_top(parts: &[Dyadic]) -> i32 {
    parts.iter().fold(Dyadic::ZERO.top, |top, part| top.max(part.top))
}

/// A float as an odd integer times a power of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Dyadic {
    /// Odd, or zero.
    odd: i64,
    /// Exponent of two, biased by 1074 so that no finite float has a negative one.
    unit: i32,
    /// The magnitude is below 2^top, with the same bias.
    top: i32,
}

impl Dyadic {
    /// Zero is on every lattice and below every bound.
    const ZERO: Self = Self { odd: 0, unit: i32::MAX / 2, top: i32::MIN / 2 };

    /// Bound of the greatest finite float: 2^1024.
    const GREATEST_TOP: i32 = 1024 + 1074;

    /// The float's odd part and exponent; infinities and NaN get a `top` above the greatest.
    ///
    /// Without branches: whether a difference on a grid is zero, nobody can predict.
    #[inline(always)]
    fn of(value: f64) -> Self {
        let bits = value.to_bits();
        let exponent = ((bits >> 52) & 0x7ff) as i32;
        let is_normal = exponent != 0;
        let significand = (bits & ((1 << 52) - 1)) | (u64::from(is_normal) << 52);
        let zeros = significand.trailing_zeros() & 63;
        let magnitude = (significand >> zeros) as i64;
        let sign = bits as i64 >> 63;
        let unit = exponent - i32::from(is_normal);
        let is_zero = significand == 0;
        Self {
            odd: (magnitude ^ sign) - sign,
            unit: if is_zero { Self::ZERO.unit } else { unit + zeros as i32 },
            top: if is_zero { Self::ZERO.top } else { unit + 53 },
        }
    }

    /// The value in units of 2^unit; the caller knows that it is a multiple and fits.
    #[inline(always)]
    fn in_units(self, unit: i32) -> i64 {
        // The mask matters for zero only, whose unit is out of this world.
        self.odd << ((self.unit - unit) & 63)
    }

    fn in_wide_units(self, unit: i32) -> i128 {
        i128::from(self.odd) << ((self.unit - unit) & 127)
    }
}

/// a - b as the rounded difference and its rounding error, exact unless the difference overflows.
#[inline(always)]
fn two_diff(a: f64, b: f64) -> (f64, f64) {
    let difference = a - b;
    let b_virtual = a - difference;
    let a_virtual = difference + b_virtual;
    (difference, (a - a_virtual) + (b_virtual - b))
}
