//! The checker's own predicates: exact for every finite f64, by integers.
//!
//! A finite f64 is `m * 2^e` with an integer m, so coordinates along an axis become integers once
//! divided by their smallest common power of two. The sign of orient2d and orient3d does not depend
//! on the scale of an axis, so each axis has its own; incircle needs one scale for both. Three rungs:
//! 64-bit coordinates with 128-bit (orient2d) or 256-bit determinants, 128-bit coordinates with
//! 256-bit determinants, integers of any length. No rung rounds, so none needs an error bound.
//!
//! Signs are `Ordering`s relative to zero: `Greater` is positive.

use super::wide::{Int256, Wide};
use std::cmp::Ordering;

/// A point of the plane.
pub type P2 = [f64; 2];
/// A point of space.
pub type P3 = [f64; 3];

/// Bits that 64-bit coordinates may have: differences then stay below 2^62 and the sums of two
/// products of differences below 2^125.
const NARROW_BITS: u32 = 61;
/// Bits that 128-bit coordinates may have: differences stay below 2^126, orient2d below 2^253.
const MIDDLE_BITS: u32 = 125;

/// `(m, e)` with `x = m * 2^e` and m odd, or `(0, i32::MAX)` for zero.
/// REQUIRES: x is finite.
#[must_use]
pub fn mantissa_exponent(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let field = ((bits >> 52) & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)).cast_signed();
    let (magnitude, exponent) =
        if field == 0 { (fraction, -1074) } else { (fraction | (1 << 52), field - 1075) };
    if magnitude == 0 {
        return (0, i32::MAX);
    }
    let zeros = magnitude.trailing_zeros();
    let odd = magnitude >> zeros;
    (if x < 0.0 { -odd } else { odd }, exponent + zeros.cast_signed())
}

/// Coordinates along one axis as integers times a common power of two.
struct Axis<const N: usize> {
    parts: [(i64, i32); N],
    /// The common exponent.
    exponent: i32,
    /// Bits of the largest integer.
    bits: u32,
}

impl<const N: usize> Axis<N> {
    fn of(coordinates: [f64; N]) -> Self {
        let parts = coordinates.map(mantissa_exponent);
        let exponent = parts.iter().map(|part| part.1).min().unwrap_or(i32::MAX);
        let mut axis =
            Self { parts, exponent: if exponent == i32::MAX { 0 } else { exponent }, bits: 0 };
        axis.measure();
        axis
    }

    fn measure(&mut self) {
        let bits = |&(m, e): &(i64, i32)| match m {
            0 => 0,
            _ => 64 - m.unsigned_abs().leading_zeros() + self.shift(e),
        };
        self.bits = self.parts.iter().map(bits).max().unwrap_or(0);
    }

    fn shift(&self, exponent: i32) -> u32 {
        (exponent - self.exponent).cast_unsigned()
    }

    /// Brings the common exponent down to `exponent`.
    fn lower_to(&mut self, exponent: i32) {
        self.exponent = self.exponent.min(exponent);
        self.measure();
    }

    fn narrow(&self) -> [i64; N] {
        self.parts.map(|(m, e)| if m == 0 { 0 } else { m << self.shift(e) })
    }

    fn middle(&self) -> [i128; N] {
        self.parts.map(|(m, e)| if m == 0 { 0 } else { i128::from(m) << self.shift(e) })
    }

    fn wide(&self) -> [Wide; N] {
        self.parts.map(|(m, e)| match m {
            0 => Wide::zero(),
            _ => Wide::shifted(i128::from(m), self.shift(e)),
        })
    }
}

/// An exact number `integer * 2^exponent`.
pub enum Scaled {
    /// It fits 128 bits.
    Narrow(i128, i32),
    /// It does not.
    Wide(Wide, i32),
}

impl Scaled {
    /// Its order relative to zero.
    #[must_use]
    pub fn sign(&self) -> Ordering {
        match self {
            Self::Narrow(value, _) => value.cmp(&0),
            Self::Wide(value, _) => value.sign(),
        }
    }

    /// `(f, e)` with the value near `f * 2^e`.
    #[must_use]
    pub fn approximate(&self) -> (f64, i32) {
        match self {
            #[expect(clippy::cast_precision_loss, reason = "an approximation is asked for")]
            Self::Narrow(value, exponent) => (*value as f64, *exponent),
            Self::Wide(value, exponent) => {
                let (f, e) = value.approximate();
                (f, e + exponent)
            }
        }
    }
}

/// Twice the signed area of the triangle a, b, c: positive when it is counterclockwise.
#[must_use]
pub fn doubled_area(a: P2, b: P2, c: P2) -> Scaled {
    let (x, y) = (Axis::of([a[0], b[0], c[0]]), Axis::of([a[1], b[1], c[1]]));
    let exponent = x.exponent + y.exponent;
    let bits = x.bits.max(y.bits);
    if bits <= NARROW_BITS {
        return Scaled::Narrow(determinant(x.narrow(), y.narrow()), exponent);
    }
    if bits <= MIDDLE_BITS {
        let ([ax, bx, cx], [ay, by, cy]) = (x.middle(), y.middle());
        let first = Int256::product(bx - ax, cy - ay);
        return Scaled::Wide(first.minus(Int256::product(by - ay, cx - ax)).widen(), exponent);
    }
    Scaled::Wide(determinant_wide(&x.wide(), &y.wide()), exponent)
}

/// Which side of the line from `a` to `b` the point `c` lies on: `Greater` on the left.
#[must_use]
pub fn orient2d(a: P2, b: P2, c: P2) -> Ordering {
    let (x, y) = (Axis::of([a[0], b[0], c[0]]), Axis::of([a[1], b[1], c[1]]));
    let bits = x.bits.max(y.bits);
    if bits <= NARROW_BITS {
        return determinant(x.narrow(), y.narrow()).cmp(&0);
    }
    if bits <= MIDDLE_BITS {
        let ([ax, bx, cx], [ay, by, cy]) = (x.middle(), y.middle());
        let first = Int256::product(bx - ax, cy - ay);
        return first.minus(Int256::product(by - ay, cx - ax)).sign();
    }
    determinant_wide(&x.wide(), &y.wide()).sign()
}

/// `(bx - ax)(cy - ay) - (by - ay)(cx - ax)` for coordinates whose differences fit 63 bits.
#[inline]
#[must_use]
pub fn determinant([ax, bx, cx]: [i64; 3], [ay, by, cy]: [i64; 3]) -> i128 {
    i128::from(bx - ax) * i128::from(cy - ay) - i128::from(by - ay) * i128::from(cx - ax)
}

fn determinant_wide([ax, bx, cx]: &[Wide; 3], [ay, by, cy]: &[Wide; 3]) -> Wide {
    let first = bx.minus(ax).times(&cy.minus(ay));
    first.minus(&by.minus(ay).times(&cx.minus(ax)))
}

/// Whether `d` lies inside (`Greater`), on or outside the circle through the counterclockwise
/// `a`, `b`, `c`.
#[must_use]
pub fn incircle(a: P2, b: P2, c: P2, d: P2) -> Ordering {
    let mut x = Axis::of([a[0], b[0], c[0], d[0]]);
    let mut y = Axis::of([a[1], b[1], c[1], d[1]]);
    let exponent = x.exponent.min(y.exponent);
    x.lower_to(exponent);
    y.lower_to(exponent);
    if x.bits.max(y.bits) <= NARROW_BITS {
        return incircle_narrow(x.narrow(), y.narrow());
    }
    incircle_wide(&x.wide(), &y.wide())
}

/// [`incircle`] for integer coordinates whose differences stay below 2^62.
///
/// Each lifted height and each minor stays below 2^125, each product below 2^250.
#[must_use]
pub fn incircle_narrow(x: [i64; 4], y: [i64; 4]) -> Ordering {
    let d = |i: usize| (i128::from(x[i] - x[3]), i128::from(y[i] - y[3]));
    let [a, b, c] = [d(0), d(1), d(2)];
    let lift = |p: (i128, i128)| p.0 * p.0 + p.1 * p.1;
    let minor = |p: (i128, i128), q: (i128, i128)| p.0 * q.1 - p.1 * q.0;
    let term = |p, q, r| Int256::product(lift(p), minor(q, r));
    term(a, b, c).plus(term(b, c, a)).plus(term(c, a, b)).sign()
}

fn incircle_wide(x: &[Wide; 4], y: &[Wide; 4]) -> Ordering {
    let d = |i: usize| (x[i].minus(&x[3]), y[i].minus(&y[3]));
    let [a, b, c] = [d(0), d(1), d(2)];
    let term = |p: &(Wide, Wide), q: &(Wide, Wide), r: &(Wide, Wide)| {
        let lift = p.0.times(&p.0).plus(&p.1.times(&p.1));
        lift.times(&q.0.times(&r.1).minus(&q.1.times(&r.0)))
    };
    term(&a, &b, &c).plus(&term(&b, &c, &a)).plus(&term(&c, &a, &b)).sign()
}

/// Which side of the plane through `a`, `b`, `c` the point `d` lies on: `Greater` when a, b, c
/// appear counterclockwise seen from d.
#[must_use]
pub fn orient3d(a: P3, b: P3, c: P3, d: P3) -> Ordering {
    let axes = [0, 1, 2].map(|k| Axis::of([a[k], b[k], c[k], d[k]]));
    if axes.iter().all(|axis| axis.bits <= NARROW_BITS) {
        return orient3d_narrow(axes.map(|axis| axis.narrow()));
    }
    orient3d_wide(&axes.map(|axis| axis.wide()))
}

/// [`orient3d`] for integer coordinates, given by axis, whose differences stay below 2^62.
#[must_use]
pub fn orient3d_narrow(axes: [[i64; 4]; 3]) -> Ordering {
    determinant_narrow(axes).sign()
}

/// The determinant whose sign is that of [`orient3d`], for integers as in [`orient3d_narrow`].
#[must_use]
pub fn determinant_narrow(axes: [[i64; 4]; 3]) -> Int256 {
    let [x, y, z] =
        axes.map(|[a, b, c, d]| [i128::from(b - a), i128::from(c - a), i128::from(d - a)]);
    let minor = |p: [i128; 3], q: [i128; 3]| p[0] * q[1] - p[1] * q[0];
    Int256::product(minor(y, z), x[2])
        .plus(Int256::product(minor(z, x), y[2]))
        .plus(Int256::product(minor(x, y), z[2]))
}

fn orient3d_wide(axes: &[[Wide; 4]; 3]) -> Ordering {
    let [x, y, z] = [0, 1, 2].map(|k| [1, 2, 3].map(|i: usize| axes[k][i].minus(&axes[k][0])));
    let term = |p: &[Wide; 3], q: &[Wide; 3], r: &[Wide; 3]| {
        p[0].times(&q[1]).minus(&p[1].times(&q[0])).times(&r[2])
    };
    term(&y, &z, &x).plus(&term(&z, &x, &y)).plus(&term(&x, &y, &z)).sign()
}

/// Order by x, then by y, of finite points: exact, for floats compare exactly; -0.0 equals 0.0.
#[must_use]
pub fn lexicographic(a: P2, b: P2) -> Ordering {
    a.partial_cmp(&b).unwrap_or(Ordering::Equal)
}

/// An exact sum of numbers `integer * 2^exponent`: a fixed-point register that spans every product
/// of two finite f64 differences, kept in 32-bit digits so that carries can wait.
///
/// Addition is exact, so the sum is the same in any order and for any number of threads.
#[derive(Clone)]
pub struct ExactSum {
    digits: Box<[i64]>,
    /// Additions since the carries were last resolved.
    pending: u32,
}

/// The exact sum of at most 2^32 numbers of 128 bits: their halves, summed apart.
#[derive(Clone, Copy, Default)]
pub struct Lanes {
    high: i128,
    low: u128,
}

impl Lanes {
    /// Adds a number.
    #[inline]
    pub fn add(&mut self, value: i128) {
        self.high += value >> 64;
        self.low += value.cast_unsigned() & u128::from(u64::MAX);
    }
}

/// The smallest exponent of a product of two f64: 2 * -1074.
const SUM_EXPONENT: i32 = -2148;
/// Digits for 2148 bits below the point, 2 * 1024 + 2 above it, and 62 for four billion summands.
const SUM_DIGITS: usize = (2148 + 2050 + 62) / 32 + 2;

impl Default for ExactSum {
    fn default() -> Self {
        Self { digits: vec![0; SUM_DIGITS].into_boxed_slice(), pending: 0 }
    }
}

impl ExactSum {
    /// Adds `value * 2^exponent`.
    pub fn add(&mut self, value: i128, exponent: i32) {
        let offset = (exponent - SUM_EXPONENT).cast_unsigned();
        let (whole, part) = ((offset / 32) as usize, offset % 32);
        let sign = if value < 0 { -1 } else { 1 };
        let mut rest = value.unsigned_abs();
        let mut carry = 0u64;
        let mut index = whole;
        while rest != 0 || carry != 0 {
            let digit = (((rest & 0xffff_ffff) as u64) << part) | carry;
            self.digits[index] += sign * (digit & 0xffff_ffff).cast_signed();
            carry = digit >> 32;
            rest >>= 32;
            index += 1;
        }
        self.settle_later();
    }

    /// Adds the numbers gathered in units of `2^exponent`.
    pub fn add_lanes(&mut self, lanes: &Lanes, exponent: i32) {
        self.add(lanes.low.cast_signed(), exponent);
        self.add(lanes.high, exponent + 64);
    }

    /// Adds an exact number.
    pub fn add_scaled(&mut self, value: &Scaled) {
        match value {
            Scaled::Narrow(value, exponent) => self.add(*value, *exponent),
            Scaled::Wide(value, exponent) => self.add_wide(value, *exponent),
        }
    }

    fn add_wide(&mut self, value: &Wide, exponent: i32) {
        let negative = value.sign() == Ordering::Less;
        for (i, limb) in value.limbs().iter().enumerate() {
            let part = if negative { -i128::from(*limb) } else { i128::from(*limb) };
            self.add(part, exponent + 64 * i32::try_from(i).unwrap_or(0));
        }
    }

    /// Adds another sum.
    pub fn merge(&mut self, other: &Self) {
        for (digit, more) in self.digits.iter_mut().zip(&other.digits) {
            *digit += more;
        }
        self.settle();
    }

    /// Digits stay below 2^62: a pending addition adds less than 2^32 to each.
    fn settle_later(&mut self) {
        self.pending += 1;
        if self.pending == 1 << 29 {
            self.settle();
        }
    }

    fn settle(&mut self) {
        let mut carry = 0;
        for digit in &mut self.digits {
            let value = *digit + carry;
            *digit = value & 0xffff_ffff;
            carry = value >> 32;
        }
        if let Some(top) = self.digits.last_mut() {
            *top += carry << 32;
        }
        self.pending = 0;
    }

    /// The sum as `(integer, exponent)`, the integer odd or zero.
    #[must_use]
    pub fn value(&self) -> (Wide, i32) {
        let mut total = Wide::zero();
        for (i, &digit) in self.digits.iter().enumerate() {
            let shift = u32::try_from(i * 32).unwrap_or(0);
            total = total.plus(&Wide::shifted(i128::from(digit), shift));
        }
        let zeros = total.trailing_zeros();
        (
            total.shift_right(zeros),
            if zeros == 0 && total.sign().is_eq() { 0 } else { SUM_EXPONENT + zeros.cast_signed() },
        )
    }
}
