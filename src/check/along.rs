//! How nodes lie along a segment that they subdivide: exact deviation, progress, tolerance.

use super::exact::{P2, Scaled, doubled_area, mantissa_exponent};
use super::wide::Wide;
use std::cmp::Ordering;

/// A node beside the segment from `from` to `to`: integers over one common power of two.
pub(super) struct Along {
    /// Twice the area of the triangle from, to, node.
    cross: Wide,
    /// Squared length of the segment.
    length_sq: Wide,
    /// (node - from) . (to - from).
    progress: Wide,
    /// The power of two by which coordinates were divided.
    exponent: i32,
    /// The unit in the last place of the largest coordinate of the segment's ends, as an exponent.
    ulp_exponent: i32,
}

/// The exponent of the distance from |x| to the next larger float.
fn ulp_exponent(x: f64) -> i32 {
    let field = ((x.to_bits() >> 52) & 0x7ff) as i32;
    field.max(1) - 1075
}

impl Along {
    pub(super) fn new(from: P2, to: P2, node: P2) -> Self {
        let all = [from[0], from[1], to[0], to[1], node[0], node[1]].map(mantissa_exponent);
        let lowest = all.iter().map(|part| part.1).min().unwrap_or(0);
        let exponent = if lowest == i32::MAX { 0 } else { lowest };
        let integer = |k: usize| match all[k] {
            (0, _) => Wide::zero(),
            (m, e) => Wide::shifted(i128::from(m), (e - exponent).cast_unsigned()),
        };
        let [fx, fy, tx, ty, nx, ny] = [0, 1, 2, 3, 4, 5].map(integer);
        let (dx, dy) = (tx.minus(&fx), ty.minus(&fy));
        let (px, py) = (nx.minus(&fx), ny.minus(&fy));
        let largest = from.iter().chain(&to).fold(0.0f64, |m, c| m.max(c.abs()));
        Self {
            cross: dx.times(&py).minus(&dy.times(&px)),
            length_sq: dx.times(&dx).plus(&dy.times(&dy)),
            progress: dx.times(&px).plus(&dy.times(&py)),
            exponent,
            ulp_exponent: ulp_exponent(largest),
        }
    }

    /// Whether the node's foot lies strictly between the ends.
    pub(super) fn is_between(&self) -> bool {
        self.progress.sign().is_gt() && self.progress.minus(&self.length_sq).sign().is_lt()
    }

    /// Whether this node's foot lies strictly before another's on the same segment.
    ///
    /// The two may be scaled by different powers of two.
    pub(super) fn is_before(&self, other: &Self) -> bool {
        let common = self.exponent.min(other.exponent);
        let scaled = |a: &Self| a.progress.shift_left(2 * (a.exponent - common).cast_unsigned());
        scaled(self).minus(&scaled(other)).sign().is_lt()
    }

    /// Compares the deviations from the same segment of this node and another, exactly.
    ///
    /// The two may be scaled by different powers of two.
    pub(super) fn compare_deviation(&self, other: &Self) -> Ordering {
        let common = self.exponent.min(other.exponent);
        let scaled =
            |a: &Self| a.cross_absolute().shift_left(2 * (a.exponent - common).cast_unsigned());
        scaled(self).minus(&scaled(other)).sign()
    }

    fn cross_absolute(&self) -> Wide {
        if self.cross.sign().is_lt() { self.cross.clone().negated() } else { self.cross.clone() }
    }

    /// Whether the deviation is at most 2^-20 of the segment's length: near enough to take the node
    /// for a node of this segment. Only the name of a finding depends on it: a node that is taken
    /// so is still gated by its deviation, one that is not leaves the segment lost.
    pub(super) fn is_near(&self) -> bool {
        const NEAR_BITS: u32 = 20;
        self.cross_absolute().shift_left(NEAR_BITS).minus(&self.length_sq).sign().is_le()
    }

    /// Whether the deviation is at most `limit` ulps, decided exactly:
    /// cross^2 <= limit^2 ulp^2 length^2.
    pub(super) fn within_ulps(&self, limit: f64) -> bool {
        let (m, e) = mantissa_exponent(limit);
        self.within(m, e.saturating_add(self.ulp_exponent))
    }

    /// Whether the deviation is at most the length `limit`, decided exactly.
    pub(super) fn within_length(&self, limit: f64) -> bool {
        let (m, e) = mantissa_exponent(limit);
        self.within(m, e)
    }

    /// Whether the deviation is at most `m * 2^e`.
    fn within(&self, m: i64, e: i32) -> bool {
        if m <= 0 || self.cross.sign().is_eq() {
            return self.cross.sign().is_eq();
        }
        let left = self.cross.times(&self.cross);
        let factor = Wide::shifted(i128::from(m), 0);
        let right = factor.times(&factor).times(&self.length_sq);
        // cross^2 has the scale 2^(4 exponent), length^2 that of 2^(2 exponent).
        let shift = 2 * (e - self.exponent);
        let difference = if shift >= 0 {
            left.minus(&right.shift_left(shift.cast_unsigned()))
        } else {
            left.shift_left(shift.unsigned_abs()).minus(&right)
        };
        difference.sign() != Ordering::Greater
    }

    /// The deviation in the unit of the coordinates and in ulps, rounded; for messages.
    pub(super) fn deviation(&self) -> (f64, f64) {
        let ((c, ce), (l, le)) = (self.cross.approximate(), self.length_sq.approximate());
        // An even exponent has an exact root.
        let (l, le) = if le % 2 == 0 { (l, le) } else { (2.0 * l, le - 1) };
        let (value, exponent) = ((c / l.sqrt()).abs(), ce - le / 2);
        let scaled = |e: i32| super::ldexp(value, e);
        (scaled(exponent + self.exponent), scaled(exponent + self.exponent - self.ulp_exponent))
    }
}

/// Twice the signed area of a closed polygon, exactly.
pub(super) fn polygon_area(edges: impl Iterator<Item = (P2, P2)>) -> super::exact::ExactSum {
    let mut sum = super::exact::ExactSum::default();
    for (a, b) in edges {
        let doubled: Scaled = doubled_area([0.0, 0.0], a, b);
        sum.add_scaled(&doubled);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_node_one_ulp_off_is_measured_as_such() {
        let node = [0.5, f64::EPSILON];
        let along = Along::new([0.0, 0.0], [1.0, 0.0], node);
        assert!(along.is_between() && along.is_near());
        assert_eq!(along.deviation(), (f64::EPSILON, 1.0));
        assert!(along.within_ulps(1.0));
        assert!(!along.within_ulps(0.999_999));
        assert!(along.within_length(f64::EPSILON));
        assert!(!along.within_length(f64::EPSILON / 2.0));
    }

    #[test]
    fn deviation_is_exact_for_huge_and_tiny_numbers() {
        for scale in [1e300, 1e-300] {
            let along = Along::new([0.0, 0.0], [scale, 0.0], [scale / 2.0, scale / 4.0]);
            assert!(along.is_between() && !along.is_near());
            assert!(along.within_length(scale / 4.0));
            assert!(!along.within_length(scale / 4.0 * (1.0 - f64::EPSILON)));
            assert!((along.deviation().0 / (scale / 4.0) - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn order_along_a_segment_is_independent_of_scale() {
        let at = |x: f64| Along::new([0.0, 0.0], [1.0, 1.0], [x, x]);
        assert!(at(0.1).is_before(&at(0.5)));
        assert!(!at(0.5).is_before(&at(0.1)));
        assert!(!at(0.5).is_before(&at(0.5)));
        assert!(!at(-0.5).is_between() && !at(1.0).is_between());
    }
}
