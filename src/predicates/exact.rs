//! Last rung: the determinant expanded into monomials, each added without rounding to an accumulator
//! as wide as the whole exponent range (Kulisch's long accumulator; Kulisch and Miranker, The
//! Arithmetic of the Digital Computer, 1986).
//!
//! Chosen over big integers of the needed width: no allocation, no case that grows with the spread of
//! the exponents, and nothing to trust but multiplication and carrying. A monomial costs the same
//! whether it is 1e300 or 1e-310, so the worst case is the only case.

use super::Sign;
use super::wide::multiply;
use crate::point::Point2;

/// The sign of `orient2d`.
pub(super) fn orient2d(a: Point2, b: Point2, c: Point2) -> Sign {
    let mut sum = ExactSum::new();
    sum.add_minors(&[], false, [a, b, c].map(ExactPoint::of));
    sum.sign()
}

/// The sign of `incircle`, expanded along the column of heights.
pub(super) fn incircle(a: Point2, b: Point2, c: Point2, d: Point2) -> Sign {
    let [a, b, c, d] = [a, b, c, d].map(ExactPoint::of);
    let cofactors =
        [(a, false, [b, c, d]), (b, true, [a, c, d]), (c, false, [a, b, d]), (d, true, [a, b, c])];
    let mut sum = ExactSum::new();
    for (lifted, negate, others) in cofactors {
        sum.add_minors(&[lifted.x, lifted.x], negate, others);
        sum.add_minors(&[lifted.y, lifted.y], negate, others);
    }
    sum.sign()
}

/// An exact number: ±significand * 2^(exponent - 1075).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Factor {
    negative: bool,
    significand: u64,
    exponent: u32,
}

impl Factor {
    /// The float.
    pub(super) fn of(value: f64) -> Self {
        let bits = value.to_bits();
        let biased = ((bits >> 52) & 0x7ff) as u32;
        let fraction = bits & ((1 << 52) - 1);
        let hidden = u64::from(biased != 0) << 52;
        Self { negative: bits >> 63 == 1, significand: fraction | hidden, exponent: biased.max(1) }
    }

    /// Twice the number; at most one factor of a product may be one.
    pub(super) fn doubled(self) -> Self {
        Self { exponent: self.exponent + 1, ..self }
    }

    /// Halfway from the float to its neighbour away from zero, on the side of its sign bit.
    pub(super) fn half_step_beyond(value: f64) -> Self {
        let Self { negative, significand, exponent } = Self::of(value);
        Self { negative, significand: 2 * significand + 1, exponent: exponent - 1 }
    }
}

/// A point with exact coordinates.
#[derive(Clone, Copy)]
pub(super) struct ExactPoint {
    pub(super) x: Factor,
    pub(super) y: Factor,
}

impl ExactPoint {
    pub(super) fn of(p: Point2) -> Self {
        Self { x: Factor::of(p.x), y: Factor::of(p.y) }
    }
}

/// An exact sum of products of up to four factors, all of the same number of factors.
///
/// Positive and negative terms are summed apart, so that nothing is ever borrowed through the whole
/// width, and compared at the end.
pub(super) struct ExactSum {
    positive: Accumulator,
    negative: Accumulator,
}

impl ExactSum {
    pub(super) fn new() -> Self {
        Self { positive: Accumulator::new(), negative: Accumulator::new() }
    }

    /// Adds the product of up to four factors, or subtracts it if `negate`.
    pub(super) fn add_product(&mut self, factors: &[Factor], negate: bool) {
        debug_assert!(factors.len() <= 4, "a product of {} factors", factors.len());
        let (mut significands, mut shift, mut negative) = ([1; 4], 0, negate);
        for (factor, significand) in factors.iter().zip(&mut significands) {
            *significand = u128::from(factor.significand);
            shift += factor.exponent;
            negative ^= factor.negative;
        }
        let [a, b, c, d] = significands;
        let product = multiply(a * b, c * d);
        if product != (0, 0) {
            let side = if negative { &mut self.negative } else { &mut self.positive };
            side.add(product, shift);
        }
    }

    /// Adds p x q = p.x q.y - p.y q.x times the common factors, at most two.
    pub(super) fn add_cross(
        &mut self,
        common: &[Factor],
        negate: bool,
        p: ExactPoint,
        q: ExactPoint,
    ) {
        let mut factors = [p.x, q.y, p.x, p.x];
        let count = 2 + common.len();
        factors[2..count].copy_from_slice(common);
        self.add_product(&factors[..count], negate);
        (factors[0], factors[1]) = (p.y, q.x);
        self.add_product(&factors[..count], !negate);
    }

    /// Adds orient2d of three points, p x q + q x r + r x p, times the common factors.
    fn add_minors(&mut self, common: &[Factor], negate: bool, [p, q, r]: [ExactPoint; 3]) {
        self.add_cross(common, negate, p, q);
        self.add_cross(common, negate, q, r);
        self.add_cross(common, negate, r, p);
    }

    /// The sign of the sum.
    pub(super) fn sign(&self) -> Sign {
        Sign::from(self.positive.compare(&self.negative))
    }
}

/// Words of an accumulator. Four exponents of at most 2047 and a product of 216 bits reach bit 8404;
/// a sum of fewer than 2^40 of them bit 8444. The addend's fifth, last word starts below bit 8188 +
/// 256, so it exists too.
const WORDS: usize = 8444_usize.div_ceil(64) + 1;

/// A nonnegative integer as wide as any sum of products of four floats.
struct Accumulator {
    /// Least significant first.
    words: [u64; WORDS],
    /// All words from here on are zero.
    used: usize,
}

impl Accumulator {
    fn new() -> Self {
        Self { words: [0; WORDS], used: 0 }
    }

    /// Adds (high * 2^128 + low) * 2^shift.
    fn add(&mut self, (high, low): (u128, u128), shift: u32) {
        let bits = shift % 64;
        let (mut below, mut carry) = (0, 0);
        let mut at = (shift / 64) as usize;
        for word in [low as u64, (low >> 64) as u64, high as u64, (high >> 64) as u64, 0] {
            let shifted = u128::from(word) << bits;
            let sum = u128::from(self.words[at]) + u128::from(shifted as u64 | below) + carry;
            (self.words[at], carry) = (sum as u64, sum >> 64);
            below = (shifted >> 64) as u64;
            at += 1;
        }
        while carry != 0 {
            let sum = u128::from(self.words[at]) + carry;
            (self.words[at], carry) = (sum as u64, sum >> 64);
            at += 1;
        }
        self.used = self.used.max(at);
    }

    fn compare(&self, other: &Self) -> std::cmp::Ordering {
        let used = self.used.max(other.used);
        self.words[..used].iter().rev().cmp(other.words[..used].iter().rev())
    }
}
