//! Integers of 256 and 512 bits, as far as the fixed-width rung needs them.

use super::Sign;

/// A signed integer of 256 bits in two's complement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Int256 {
    high: i128,
    low: u128,
}

impl Int256 {
    /// The exact product of two 128-bit integers.
    #[inline]
    pub(super) fn product(a: i128, b: i128) -> Self {
        let (high, low) = multiply(a as u128, b as u128);
        // Read as unsigned, a negative factor is 2^128 too large: the other factor is in excess.
        let excess = (b & (a >> 127)).wrapping_add(a & (b >> 127));
        Self { high: (high as i128).wrapping_sub(excess), low }
    }

    /// Sum, which the caller knows to fit.
    #[inline]
    pub(super) fn plus(self, other: Self) -> Self {
        let (low, carry) = self.low.overflowing_add(other.low);
        let high = self.high.wrapping_add(other.high).wrapping_add(i128::from(carry));
        Self { high, low }
    }

    /// Difference, which the caller knows to fit.
    #[inline]
    pub(super) fn minus(self, other: Self) -> Self {
        let (low, borrow) = self.low.overflowing_sub(other.low);
        let high = self.high.wrapping_sub(other.high).wrapping_sub(i128::from(borrow));
        Self { high, low }
    }

    /// The sign.
    #[inline]
    pub(super) fn sign(self) -> Sign {
        if self.high < 0 {
            Sign::Negative
        } else if self.high == 0 && self.low == 0 {
            Sign::Zero
        } else {
            Sign::Positive
        }
    }

    /// Whether it is negative, and its magnitude, most significant part first.
    #[inline]
    fn magnitude(self) -> (bool, [u128; 2]) {
        if self.high >= 0 {
            return (false, [self.high as u128, self.low]);
        }
        let (low, carry) = (!self.low).overflowing_add(1);
        (true, [(!self.high as u128).wrapping_add(u128::from(carry)), low])
    }
}

/// The sign of the sum of three products; factors below 2^254 in magnitude, so that the sum fits.
pub(super) fn sign_of_sum_of_products(pairs: [(Int256, Int256); 3]) -> Sign {
    let (mut positive, mut negative) = ([0; 4], [0; 4]);
    for (a, b) in pairs {
        let (a_negative, a) = a.magnitude();
        let (b_negative, b) = b.magnitude();
        let sum = if a_negative == b_negative { &mut positive } else { &mut negative };
        *sum = add512(*sum, multiply256(a, b));
    }
    Sign::from(positive.cmp(&negative))
}

/// Product of two 128-bit numbers, as (high, low).
#[inline]
pub(super) fn multiply(a: u128, b: u128) -> (u128, u128) {
    const MASK: u128 = u64::MAX as u128;
    let (a1, a0, b1, b0) = (a >> 64, a & MASK, b >> 64, b & MASK);
    let low = a0 * b0;
    let cross = a1 * b0 + (low >> 64);
    let middle = a0 * b1 + (cross & MASK);
    (a1 * b1 + (cross >> 64) + (middle >> 64), (middle << 64) | (low & MASK))
}

/// Product of two 256-bit numbers, most significant part first.
#[inline]
fn multiply256([a1, a0]: [u128; 2], [b1, b0]: [u128; 2]) -> [u128; 4] {
    let ((h00, l00), (h11, l11)) = (multiply(a0, b0), multiply(a1, b1));
    let ((h01, l01), (h10, l10)) = (multiply(a0, b1), multiply(a1, b0));
    let sum = add512([h11, l11, h00, l00], [0, h01, l01, 0]);
    add512(sum, [0, h10, l10, 0])
}

/// Sum of two 512-bit numbers, most significant part first; the caller knows that it fits.
#[inline]
fn add512(a: [u128; 4], b: [u128; 4]) -> [u128; 4] {
    let mut carry = false;
    let mut sum = [0; 4];
    for i in (0..4).rev() {
        let (part, over) = a[i].overflowing_add(b[i]);
        let (part, over_again) = part.overflowing_add(u128::from(carry));
        (sum[i], carry) = (part, over || over_again);
    }
    sum
}

#[cfg(test)]
mod tests {
    use num_bigint::{BigInt, BigUint};
    use proptest::prelude::*;

    use super::*;

    fn big(v: Int256) -> BigInt {
        (BigInt::from(v.high) << 128) + BigInt::from(v.low)
    }

    fn big_unsigned(parts: &[u128]) -> BigUint {
        parts.iter().fold(BigUint::default(), |sum, &part| (sum << 128) + part)
    }

    fn sign(v: &BigInt) -> Sign {
        Sign::from(v.cmp(&BigInt::default()))
    }

    #[test]
    fn products_at_the_ends_of_the_range_are_exact() {
        let ends = [i128::MIN, i128::MIN + 1, -1, 0, 1, i128::MAX - 1, i128::MAX];
        for (a, b) in ends.into_iter().flat_map(|a| ends.map(|b| (a, b))) {
            let product = Int256::product(a, b);
            assert_eq!(big(product), BigInt::from(a) * b, "{a} * {b}");
            assert_eq!(product.sign(), sign(&big(product)), "{a} * {b}");
        }
    }

    proptest! {
        #[test]
        fn integers_of_256_bits_agree_with_big_integers(
            [a, b, c, d] in any::<[i128; 4]>(), shift in 0..127,
        ) {
            let (a, c) = (a >> shift, c >> (shift / 2));
            let (ab, cd) = (Int256::product(a >> 1, b), Int256::product(c >> 1, d));
            prop_assert_eq!(big(ab), BigInt::from(a >> 1) * b);
            prop_assert_eq!(big(ab.plus(cd)), big(ab) + big(cd));
            prop_assert_eq!(big(ab.minus(cd)), big(ab) - big(cd));
            prop_assert_eq!(ab.minus(cd).sign(), sign(&(big(ab) - big(cd))));
            let (negative, magnitude) = ab.magnitude();
            prop_assert_eq!(negative, big(ab) < BigInt::default());
            prop_assert_eq!(big_unsigned(&magnitude), big(ab).magnitude().clone());
        }

        #[test]
        fn products_of_512_bits_agree_with_big_integers(
            a in any::<[u128; 2]>(), b in any::<[u128; 2]>(),
        ) {
            let product = multiply256(a, b);
            prop_assert_eq!(big_unsigned(&product), big_unsigned(&a) * big_unsigned(&b));
        }

        #[test]
        fn signs_of_sums_of_products_agree_with_big_integers(
            factors in any::<[i128; 6]>(), last in -1..=1_i128,
        ) {
            let [a, b, c, d, e, f] = factors.map(|v| Int256::product(v >> 1, v | 1));
            let (zero, last) = (Int256::product(0, 0), Int256::product(last, 1));
            let one = Int256::product(1, 1);
            let tied = [(a, b), (zero.minus(b), a), (last, one)];
            for pairs in [[(a, b), (c, d), (e, f)], tied] {
                let sum: BigInt = pairs.iter().map(|&(a, b)| big(a) * big(b)).sum();
                prop_assert_eq!(sign_of_sum_of_products(pairs), sign(&sum));
            }
        }
    }
}
