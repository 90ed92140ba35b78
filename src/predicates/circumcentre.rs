//! Circumcentres and bisectors: points that are constructed, rounded once, and compared exactly.
//!
//! The centre of the circle through a, b, c is (X, Y) / D with, summed over the cyclic orders,
//!
//! ```text
//! X = sum |a|^2 (b.y - c.y)    Y = sum |a|^2 (c.x - b.x)    D = 2 sum a.x (b.y - c.y)
//! ```
//!
//! so comparing a coordinate with a float is the sign of a polynomial of degree 3. The float nearest
//! to a coordinate is first looked for in double-double arithmetic (Dekker 1971) with a running
//! error bound; if the bound does not settle the rounding, it is found by comparing exactly.

use super::Sign;
use super::crossing::{Axis, rounded_by};
use super::exact::{ExactSum, Factor};
use crate::point::Point2;

/// The centre of the circle through three points, each coordinate rounded to the nearest f64, ties to
/// even; beyond the range of f64 the largest one. Nothing if the points are collinear.
///
/// Neither the order of the points nor build flags change the result.
///
/// **Requires** finite coordinates. **Guarantees** P12.
///
/// # Examples
///
/// ```
/// use trigrade::{point::Point2, predicates::rounded_circumcentre};
/// let [a, b, c] = [[0.0, 0.0], [1.0, 0.0], [0.0, 3.0]].map(Point2::from);
/// assert_eq!(rounded_circumcentre(a, b, c), Some(Point2::new(0.5, 1.5)));
/// assert_eq!(rounded_circumcentre(a, b, a), None);
/// ```
#[must_use]
pub fn rounded_circumcentre(a: Point2, b: Point2, c: Point2) -> Option<Point2> {
    let orientation = super::orient2d(a, b, c);
    if orientation == Sign::Zero {
        return None;
    }
    if let Some(centre) = by_doubles(a, b, c) {
        return Some(centre);
    }
    let guess = guess(a, b, c);
    let coordinate = |axis: Axis| {
        rounded_by(axis.of(guess), |value| compare([a, b, c], orientation, axis, value))
    };
    Some(Point2::new(coordinate(Axis::X), coordinate(Axis::Y)))
}

/// How a coordinate of the centre of the circle through three points that are not collinear compares
/// with a value: Positive if the centre's is larger.
///
/// **Requires** finite coordinates. **Guarantees** P12.
#[must_use]
pub fn compare_circumcentre([a, b, c]: [Point2; 3], axis: Axis, value: f64) -> Sign {
    compare([a, b, c], super::orient2d(a, b, c), axis, Factor::of(value))
}

/// Which of two points is nearer to `p`: Positive for `a`, Negative for `b`.
///
/// **Requires** finite coordinates. **Guarantees** P13.
#[must_use]
pub fn nearer(p: Point2, a: Point2, b: Point2) -> Sign {
    // |p - b|^2 - |p - a|^2, coordinate by coordinate (b - a) ((b - p) + (a - p)). Each factor has a
    // relative error below 3 half-units of its permanent, so the sum is off by less than
    // 8 epsilon times the permanent, unless something over- or underflows.
    let term = |p: f64, a: f64, b: f64| {
        let (difference, from_a, from_b) = (b - a, a - p, b - p);
        (difference * (from_b + from_a), difference.abs() * (from_b.abs() + from_a.abs()))
    };
    let ((x, x_size), (y, y_size)) = (term(p.x, a.x, b.x), term(p.y, a.y, b.y));
    let (sum, size) = (x + y, x_size + y_size);
    if size < 1e300 && sum.abs() > 8.0 * f64::EPSILON * size && size > 1e-280 {
        return Sign::of(sum);
    }
    nearer_exactly(p, a, b)
}

/// |b|^2 - |a|^2 - 2 p (b - a).
fn nearer_exactly(p: Point2, a: Point2, b: Point2) -> Sign {
    let mut sum = ExactSum::new();
    for axis in [Axis::X, Axis::Y] {
        let [p, a, b] = [p, a, b].map(|q| Factor::of(axis.of(q)));
        sum.add_product(&[b, b], false);
        sum.add_product(&[a, a], true);
        sum.add_product(&[p.doubled(), b], true);
        sum.add_product(&[p.doubled(), a], false);
    }
    sum.sign()
}

/// Where the bisector of `a` and `b` meets the line on which the coordinate of `axis` is `value`: the
/// other coordinate, rounded to the nearest f64, ties to even; beyond the range of f64 the largest.
///
/// **Requires** finite coordinates, and that a and b differ in the other coordinate. **Guarantees**
/// P13.
#[must_use]
pub fn rounded_bisector(a: Point2, b: Point2, axis: Axis, value: f64) -> f64 {
    let (a, b) = if axis.other().of(a) <= axis.other().of(b) { (a, b) } else { (b, a) };
    let (along, across) = (|p: Point2| axis.of(p), |p: Point2| axis.other().of(p));
    let slope = (along(b) - along(a)) / (across(b) - across(a));
    let middle = |f: &dyn Fn(Point2) -> f64| f(a) / 2.0 + f(b) / 2.0;
    let guess = middle(&across) + (middle(&along) - value) * slope;
    let fixed = Factor::of(value).doubled();
    rounded_by(guess, |candidate| {
        let mut sum = ExactSum::new();
        for (p, negate) in [(a, true), (b, false)] {
            let (s, t) = (Factor::of(along(p)), Factor::of(across(p)));
            sum.add_product(&[s, s], negate);
            sum.add_product(&[t, t], negate);
            sum.add_product(&[fixed, s], !negate);
            sum.add_product(&[candidate.doubled(), t], !negate);
        }
        // The denominator 2 (b - a) across is positive.
        sum.sign()
    })
}

/// The sign of (numerator - value D) / D.
fn compare([a, b, c]: [Point2; 3], orientation: Sign, axis: Axis, value: Factor) -> Sign {
    let factors = |p: Point2| [Factor::of(p.x), Factor::of(p.y)];
    let twice = value.doubled();
    let mut sum = ExactSum::new();
    for [p, q, r] in [[a, b, c], [b, c, a], [c, a, b]] {
        let ([px, py], [qx, qy], [rx, ry]) = (factors(p), factors(q), factors(r));
        let (plus, minus) = match axis {
            Axis::X => (qy, ry),
            Axis::Y => (rx, qx),
        };
        for square in [px, py] {
            sum.add_product(&[square, square, plus], false);
            sum.add_product(&[square, square, minus], true);
        }
        sum.add_product(&[twice, px, qy], true);
        sum.add_product(&[twice, px, ry], false);
    }
    if orientation == Sign::Negative { sum.sign().reversed() } else { sum.sign() }
}

/// The centre in plain floats; it only says where the exact search begins, so it may be anything.
fn guess(a: Point2, b: Point2, c: Point2) -> Point2 {
    let (bx, by, cx, cy) = (b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
    let (lift_b, lift_c) = (bx * bx + by * by, cx * cx + cy * cy);
    let twice = 2.0 * (bx * cy - by * cx);
    let centre = Point2::new(
        a.x + (lift_b * cy - lift_c * by) / twice,
        a.y + (lift_c * bx - lift_b * cx) / twice,
    );
    if centre.is_finite() { centre } else { a }
}

/// A number as the unevaluated sum of two floats.
#[derive(Clone, Copy)]
struct Double {
    high: f64,
    low: f64,
}

impl Double {
    /// a + b exactly (Knuth).
    #[inline]
    fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let back = high - a;
        Self { high, low: (a - (high - back)) + (b - back) }
    }

    /// a b exactly, unless it over- or underflows (Dekker; splitting after Veltkamp).
    #[inline]
    fn product(a: f64, b: f64) -> Self {
        const SPLIT: f64 = ((1_u64 << 27) + 1) as f64;
        let halves = |v: f64| {
            let c = SPLIT * v;
            let high = c - (c - v);
            (high, v - high)
        };
        let high = a * b;
        let ((ah, al), (bh, bl)) = (halves(a), halves(b));
        Self { high, low: ((ah * bh - high) + ah * bl + al * bh) + al * bl }
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        let (high, low) = (Self::sum(self.high, other.high), Self::sum(self.low, other.low));
        let first = Self::sum(high.high, high.low + low.high);
        Self::sum(first.high, first.low + low.low)
    }

    #[inline]
    fn negated(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }

    #[inline]
    fn times(self, other: Self) -> Self {
        let product = Self::product(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        Self::sum(product.high, product.low + cross)
    }

    #[inline]
    fn over(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self.plus(other.times(Self { high: first, low: 0.0 }).negated());
        let second = rest.high / other.high;
        let rest = rest.plus(other.times(Self { high: second, low: 0.0 }).negated());
        Self::sum(first, second).plus(Self { high: rest.high / other.high, low: 0.0 })
    }
}

/// Relative error of a few operations on doubles: each is good to 2^-100 of its permanent.
const ROUNDOFF: f64 = 1.0 / (1_u128 << 95) as f64;

/// Magnitudes for which nothing over- or underflows in polynomials of degree 3.
const LARGE: f64 = (1_u128 << 127) as f64 * (1_u128 << 73) as f64;

/// The centre, if double-double arithmetic settles both roundings.
fn by_doubles(a: Point2, b: Point2, c: Point2) -> Option<Point2> {
    let difference = |p: f64, q: f64| Double::sum(p, -q);
    let [bx, by] = [difference(b.x, a.x), difference(b.y, a.y)];
    let [cx, cy] = [difference(c.x, a.x), difference(c.y, a.y)];
    let fits = |d: Double| d.high == 0.0 || (1.0 / LARGE..LARGE).contains(&d.high.abs());
    if ![bx, by, cx, cy].into_iter().all(fits) || a.x.abs().max(a.y.abs()) > LARGE {
        return None;
    }
    let (lift_b, lift_c) = (bx.times(bx).plus(by.times(by)), cx.times(cx).plus(cy.times(cy)));
    // p q - r s, and an upper bound of its error.
    let minor = |p: Double, q: Double, r: Double, s: Double| {
        let (pq, rs) = (p.times(q), r.times(s));
        (pq.plus(rs.negated()), ROUNDOFF * (pq.high.abs() + rs.high.abs()))
    };
    let (half, half_error) = minor(bx, cy, by, cx);
    if half.high.abs() <= 4.0 * half_error {
        return None;
    }
    let coordinate = |(numerator, error): (Double, f64), start: f64| {
        let quotient = numerator.over(half);
        let size = quotient.high.abs();
        let error = (error + size * half_error) / (half.high.abs() - half_error) + size * ROUNDOFF;
        let quotient = Double { high: quotient.high / 2.0, low: quotient.low / 2.0 };
        let at = quotient.plus(Double { high: start, low: 0.0 });
        settled(at, error + at.high.abs() * ROUNDOFF)
    };
    let x = coordinate(minor(lift_b, cy, lift_c, by), a.x)?;
    let y = coordinate(minor(lift_c, bx, lift_b, cx), a.y)?;
    Some(Point2::new(x, y))
}

/// The float that all numbers within `error` of `at` round to, if there is one.
fn settled(at: Double, error: f64) -> Option<f64> {
    // The sums with `low` round themselves.
    let error = 1.1 * error + at.low.abs() * (4.0 * f64::EPSILON);
    let (below, above) = (at.high + (at.low - error), at.high + (at.low + error));
    // Where floats are subnormal or huge, `error` itself may have been rounded away.
    let is_ordinary = at.high == 0.0 && error == 0.0
        || (f64::MIN_POSITIVE * 1e40..LARGE * LARGE).contains(&at.high.abs());
    (below == above && is_ordinary).then_some(below + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;
    use num_traits::{Signed, Zero};
    use proptest::prelude::*;

    fn exact(v: f64) -> BigRational {
        BigRational::from_float(v).expect("finite")
    }

    fn sign(v: &BigRational) -> Sign {
        match (v.is_zero(), v.is_positive()) {
            (true, _) => Sign::Zero,
            (_, true) => Sign::Positive,
            _ => Sign::Negative,
        }
    }

    /// The centre in rational arithmetic.
    fn centre(a: Point2, b: Point2, c: Point2) -> [BigRational; 2] {
        let orders =
            [[a, b, c], [b, c, a], [c, a, b]].map(|order| order.map(|p| [exact(p.x), exact(p.y)]));
        let (mut x, mut y, mut half) = (exact(0.0), exact(0.0), exact(0.0));
        for [p, q, r] in &orders {
            let lift = &p[0] * &p[0] + &p[1] * &p[1];
            x += &lift * (&q[1] - &r[1]);
            y += &lift * (&r[0] - &q[0]);
            half += &p[0] * (&q[1] - &r[1]);
        }
        let twice = exact(2.0) * half;
        [x / &twice, y / &twice]
    }

    /// Whether a float is the nearest to a number, ties to even, clamped to the range.
    fn is_nearest(rounded: f64, number: &BigRational) -> bool {
        let max = exact(f64::MAX);
        if number.abs() >= max {
            return rounded == if number.is_positive() { f64::MAX } else { f64::MIN };
        }
        let off = |v: f64| (exact(v) - number).abs();
        let neighbours = [rounded.next_down(), rounded.next_up()];
        neighbours.into_iter().filter(|v| v.is_finite()).all(|v| {
            let order = off(rounded).cmp(&off(v));
            order.is_lt() || (order.is_eq() && rounded.to_bits().is_multiple_of(2))
        })
    }

    /// Integers, ulps, decimals and every exponent.
    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![
            3 => (-4_i32..5).prop_map(f64::from),
            3 => (0_u64..4).prop_map(|k| f64::from_bits(1.0_f64.to_bits() + k)),
            3 => -1.0..1.0,
            2 => (-300_i32..300).prop_map(|k| 1.5 * 2.0_f64.powi(k)),
            1 => any::<f64>().prop_filter("finite", |v| v.is_finite()),
        ]
    }

    fn point() -> impl Strategy<Value = Point2> {
        (coordinate(), coordinate()).prop_map(|(x, y)| Point2::new(x, y))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(3000))]

        // spec: P12
        #[test]
        fn circumcentres_are_rounded_to_nearest(a in point(), b in point(), c in point()) {
            let rounded = rounded_circumcentre(a, b, c);
            let flat = super::super::orient2d(a, b, c) == Sign::Zero;
            prop_assert_eq!(rounded.is_none(), flat);
            if let Some(found) = rounded {
                let [x, y] = centre(a, b, c);
                prop_assert!(is_nearest(found.x, &x), "{} {}", found.x, x);
                prop_assert!(is_nearest(found.y, &y), "{} {}", found.y, y);
                for order in [[b, c, a], [b, a, c], [c, b, a]] {
                    prop_assert_eq!(rounded_circumcentre(order[0], order[1], order[2]), rounded);
                }
            }
        }

        // spec: P12
        #[test]
        fn circumcentres_compare_exactly(
            a in point(), b in point(), c in point(), other in coordinate(),
        ) {
            let Some(rounded) = rounded_circumcentre(a, b, c) else { return Ok(()) };
            let [x, y] = centre(a, b, c);
            for value in [other, rounded.x, rounded.x.next_up().min(f64::MAX)] {
                let found = compare_circumcentre([a, b, c], Axis::X, value);
                prop_assert_eq!(found, sign(&(&x - exact(value))));
            }
            for value in [other, rounded.y, rounded.y.next_down().max(f64::MIN)] {
                let found = compare_circumcentre([a, c, b], Axis::Y, value);
                prop_assert_eq!(found, sign(&(&y - exact(value))));
            }
        }

        // spec: P13
        #[test]
        fn the_nearer_of_two_is_exact(p in point(), a in point(), b in point()) {
            let square = |q: Point2| {
                let (x, y) = (exact(q.x) - exact(p.x), exact(q.y) - exact(p.y));
                &x * &x + &y * &y
            };
            let expected = sign(&(square(b) - square(a)));
            prop_assert_eq!(nearer(p, a, b), expected);
            prop_assert_eq!(nearer_exactly(p, a, b), expected);
            prop_assert_eq!(nearer(p, b, a), expected.reversed());
        }

        // spec: P13
        #[test]
        fn bisectors_are_rounded_to_nearest(a in point(), b in point(), value in coordinate()) {
            let two = exact(2.0);
            let lift = |p: Point2| exact(p.x) * exact(p.x) + exact(p.y) * exact(p.y);
            for axis in [Axis::X, Axis::Y] {
                let (s, t) = (|p| exact(axis.of(p)), |p| exact(axis.other().of(p)));
                if t(a) == t(b) {
                    continue;
                }
                let number = (lift(b) - lift(a) - &two * exact(value) * (s(b) - s(a)))
                    / (&two * (t(b) - t(a)));
                let found = rounded_bisector(a, b, axis, value);
                prop_assert!(is_nearest(found, &number), "{} {}", found, number);
                prop_assert_eq!(rounded_bisector(b, a, axis, value), found);
            }
        }
    }

    #[test]
    fn the_fast_way_settles_ordinary_triangles() {
        let settles = |points: [[f64; 2]; 3]| {
            let [a, b, c] = points.map(Point2::from);
            by_doubles(a, b, c)
        };
        assert_eq!(settles([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), Some(Point2::new(0.5, 0.5)));
        assert!(settles([[0.1, 0.2], [0.7, 0.3], [0.4, 0.9]]).is_some());
        assert!(settles([[0.0, 0.0], [1e300, 0.0], [0.0, 1.0]]).is_none());
    }
}
