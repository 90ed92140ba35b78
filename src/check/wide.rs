//! Integers wider than the machine's: 256 bits for the common case, any length for the rest.
//!
//! The checker decides with integers only. Two's complement arithmetic has no rounding to argue
//! about, which is why it was preferred to floating-point expansions: the mesher's predicates use
//! those, and a fault in their theory must not be shared.

use std::cmp::Ordering;

/// A signed 256-bit integer, two's complement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Int256 {
    high: i128,
    low: u128,
}

impl Int256 {
    /// Zero.
    pub const ZERO: Self = Self { high: 0, low: 0 };

    /// The exact product of two 128-bit integers; always fits.
    #[must_use]
    pub fn product(a: i128, b: i128) -> Self {
        let (high, low) = multiply_unsigned(a.unsigned_abs(), b.unsigned_abs());
        let magnitude = Self { high: high.cast_signed(), low };
        if (a < 0) == (b < 0) { magnitude } else { magnitude.negated() }
    }

    /// The negated integer.
    #[must_use]
    pub fn negated(self) -> Self {
        let (low, carry) = (!self.low).overflowing_add(1);
        Self { high: (!self.high).wrapping_add(i128::from(carry)), low }
    }

    /// The sum; the caller keeps operands small enough (below 2^254) for it to fit.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        let (low, carry) = self.low.overflowing_add(other.low);
        Self { high: self.high.wrapping_add(other.high).wrapping_add(i128::from(carry)), low }
    }

    /// The difference; same condition as [`Int256::plus`].
    #[must_use]
    pub fn minus(self, other: Self) -> Self {
        self.plus(other.negated())
    }

    /// Its order relative to zero.
    #[must_use]
    pub fn sign(self) -> Ordering {
        match self.high.cmp(&0) {
            Ordering::Equal => self.low.cmp(&0),
            decided => decided,
        }
    }

    /// The same value as an integer of any length.
    #[must_use]
    pub fn widen(self) -> Wide {
        let negative = self.high < 0;
        let magnitude = if negative { self.negated() } else { self };
        let (high, low) = (magnitude.high.cast_unsigned(), magnitude.low);
        Wide::from_limbs(negative, [low, high].into_iter().flat_map(halves).collect())
    }
}

/// The low and the high 64 bits.
#[expect(clippy::cast_possible_truncation, reason = "the truncated part is the other limb")]
fn halves(value: u128) -> [u64; 2] {
    [value as u64, (value >> 64) as u64]
}

/// The 256-bit product of unsigned numbers as (high, low), by 64-bit schoolbook multiplication.
fn multiply_unsigned(a: u128, b: u128) -> (u128, u128) {
    let ([a0, a1], [b0, b1]) = (halves(a), halves(b));
    let wide = |x: u64, y: u64| u128::from(x) * u128::from(y);
    let (low, high) = (wide(a0, b0), wide(a1, b1));
    let (middle, overflow) = wide(a0, b1).overflowing_add(wide(a1, b0));
    let (low, carry) = low.overflowing_add(middle << 64);
    let high = high + (middle >> 64) + (u128::from(overflow) << 64) + u128::from(carry);
    (high, low)
}

/// A signed integer of any length: sign and magnitude, least significant limb first, no leading
/// zero limb; zero has no limbs and is not negative.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wide {
    negative: bool,
    limbs: Vec<u64>,
}

impl Wide {
    /// Zero.
    #[must_use]
    pub const fn zero() -> Self {
        Self { negative: false, limbs: Vec::new() }
    }

    fn from_limbs(negative: bool, mut limbs: Vec<u64>) -> Self {
        while limbs.last() == Some(&0) {
            limbs.pop();
        }
        Self { negative: negative && !limbs.is_empty(), limbs }
    }

    /// The magnitude, least significant limb first.
    #[must_use]
    pub fn limbs(&self) -> &[u64] {
        &self.limbs
    }

    /// The integer `mantissa * 2^shift`.
    #[must_use]
    pub fn shifted(mantissa: i128, shift: u32) -> Self {
        let limbs = halves(mantissa.unsigned_abs()).to_vec();
        Self::from_limbs(mantissa < 0, limbs).shift_left(shift)
    }

    /// The integer times `2^shift`.
    #[must_use]
    pub fn shift_left(&self, shift: u32) -> Self {
        let (whole, part) = ((shift / 64) as usize, shift % 64);
        let mut limbs = vec![0; whole];
        let mut carry = 0;
        for &limb in &self.limbs {
            limbs.push((limb << part) | carry);
            carry = if part == 0 { 0 } else { limb >> (64 - part) };
        }
        limbs.push(carry);
        Self::from_limbs(self.negative, limbs)
    }

    /// Its order relative to zero.
    #[must_use]
    pub fn sign(&self) -> Ordering {
        match (self.limbs.is_empty(), self.negative) {
            (true, _) => Ordering::Equal,
            (false, true) => Ordering::Less,
            (false, false) => Ordering::Greater,
        }
    }

    /// The negated integer.
    #[must_use]
    pub fn negated(mut self) -> Self {
        self.negative = !self.negative && !self.limbs.is_empty();
        self
    }

    /// The sum.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        if self.negative == other.negative {
            return Self::from_limbs(self.negative, add_magnitudes(&self.limbs, &other.limbs));
        }
        match compare_magnitudes(&self.limbs, &other.limbs) {
            Ordering::Less => {
                Self::from_limbs(other.negative, subtract_magnitudes(&other.limbs, &self.limbs))
            }
            _ => Self::from_limbs(self.negative, subtract_magnitudes(&self.limbs, &other.limbs)),
        }
    }

    /// The difference.
    #[must_use]
    pub fn minus(&self, other: &Self) -> Self {
        self.plus(&other.clone().negated())
    }

    /// The product, by the schoolbook method: operands here have at most 140 limbs.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        let mut limbs = vec![0u64; self.limbs.len() + other.limbs.len()];
        for (i, &a) in self.limbs.iter().enumerate() {
            let mut carry = 0u128;
            for (j, &b) in other.limbs.iter().enumerate() {
                let sum = u128::from(a) * u128::from(b) + u128::from(limbs[i + j]) + carry;
                let [low, high] = halves(sum);
                limbs[i + j] = low;
                carry = u128::from(high);
            }
            limbs[i + other.limbs.len()] = halves(carry)[0];
        }
        Self::from_limbs(self.negative != other.negative, limbs)
    }

    /// How many factors of two it has; zero has none.
    #[must_use]
    pub fn trailing_zeros(&self) -> u32 {
        let whole = self.limbs.iter().take_while(|&&limb| limb == 0).count();
        let part = self.limbs.get(whole).map_or(0, |limb| limb.trailing_zeros());
        u32::try_from(whole * 64).unwrap_or(u32::MAX).saturating_add(part)
    }

    /// The integer divided by `2^shift`, rounded towards zero.
    #[must_use]
    pub fn shift_right(&self, shift: u32) -> Self {
        let (whole, part) = ((shift / 64) as usize, shift % 64);
        let kept = self.limbs.get(whole..).unwrap_or(&[]);
        let next = |i: usize| kept.get(i + 1).copied().unwrap_or(0);
        let limb = |i: usize| {
            if part == 0 { kept[i] } else { (kept[i] >> part) | (next(i) << (64 - part)) }
        };
        Self::from_limbs(self.negative, (0..kept.len()).map(limb).collect())
    }

    /// Number of bits of the magnitude.
    #[must_use]
    pub fn bits(&self) -> u32 {
        let limbs = u32::try_from(self.limbs.len()).unwrap_or(u32::MAX / 64);
        self.limbs.last().map_or(0, |top| limbs * 64 - top.leading_zeros())
    }

    /// The value as `(f, e)` with the value near `f * 2^e`, |f| < 2^64, relative error below 2^-52.
    /// It serves messages and statistics; nothing is decided with it.
    #[must_use]
    pub fn approximate(&self) -> (f64, i32) {
        let drop = self.bits().saturating_sub(64);
        let top = self.shift_right(drop).limbs.first().copied().unwrap_or(0);
        #[expect(clippy::cast_precision_loss, reason = "an approximation is what is asked for")]
        let magnitude = top as f64;
        let exponent = i32::try_from(drop).unwrap_or(i32::MAX);
        (if self.negative { -magnitude } else { magnitude }, exponent)
    }
}

impl std::fmt::Display for Wide {
    /// Decimal digits, by repeated division by 10^19, the largest power of ten in a limb.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        const CHUNK: u64 = 10_000_000_000_000_000_000;
        let mut limbs = self.limbs.clone();
        let mut chunks = Vec::new();
        while !limbs.is_empty() {
            let mut remainder = 0u64;
            for limb in limbs.iter_mut().rev() {
                let value = (u128::from(remainder) << 64) | u128::from(*limb);
                *limb = halves(value / u128::from(CHUNK))[0];
                remainder = halves(value % u128::from(CHUNK))[0];
            }
            chunks.push(remainder);
            while limbs.last() == Some(&0) {
                limbs.pop();
            }
        }
        let mut digits = chunks.pop().unwrap_or(0).to_string();
        for chunk in chunks.iter().rev() {
            digits.push_str(&format!("{chunk:019}"));
        }
        f.pad_integral(!self.negative, "", &digits)
    }
}

fn add_magnitudes(a: &[u64], b: &[u64]) -> Vec<u64> {
    let (long, short) = if a.len() >= b.len() { (a, b) } else { (b, a) };
    let mut carry = false;
    let mut sum = Vec::with_capacity(long.len() + 1);
    for (i, &limb) in long.iter().enumerate() {
        let (partial, first) = limb.overflowing_add(short.get(i).copied().unwrap_or(0));
        let (total, second) = partial.overflowing_add(u64::from(carry));
        sum.push(total);
        carry = first || second;
    }
    sum.push(u64::from(carry));
    sum
}

/// REQUIRES: a >= b.
fn subtract_magnitudes(a: &[u64], b: &[u64]) -> Vec<u64> {
    let mut borrow = false;
    let mut difference = Vec::with_capacity(a.len());
    for (i, &limb) in a.iter().enumerate() {
        let (partial, first) = limb.overflowing_sub(b.get(i).copied().unwrap_or(0));
        let (total, second) = partial.overflowing_sub(u64::from(borrow));
        difference.push(total);
        borrow = first || second;
    }
    difference
}

fn compare_magnitudes(a: &[u64], b: &[u64]) -> Ordering {
    a.len().cmp(&b.len()).then_with(|| a.iter().rev().cmp(b.iter().rev()))
}
