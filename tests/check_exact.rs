//! The checker's own arithmetic against num-bigint, which it does not use.

use num_bigint::BigInt;
use num_traits::Zero;
use proptest::prelude::*;
use std::cmp::Ordering;
use trigrade::check::exact::{self, ExactSum};
use trigrade::check::wide::{Int256, Wide};

/// A finite f64 times 2^1074, an integer.
fn integer(x: f64) -> BigInt {
    let bits = x.to_bits();
    let (field, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
    let (mantissa, shift) =
        if field == 0 { (fraction, 0) } else { (fraction | (1 << 52), field - 1) };
    let magnitude = BigInt::from(mantissa) << shift;
    if x < 0.0 { -magnitude } else { magnitude }
}

fn sign(x: &BigInt) -> Ordering {
    x.cmp(&BigInt::zero())
}

fn determinant(rows: &[Vec<BigInt>]) -> BigInt {
    if rows.len() == 1 {
        return rows[0][0].clone();
    }
    let mut sum = BigInt::zero();
    for (column, entry) in rows[0].iter().enumerate() {
        let minor: Vec<Vec<BigInt>> = rows[1..]
            .iter()
            .map(|row| {
                let kept = row.iter().enumerate().filter(|(j, _)| *j != column);
                kept.map(|(_, x)| x.clone()).collect()
            })
            .collect();
        let term = entry * determinant(&minor);
        if column % 2 == 0 { sum += term } else { sum -= term }
    }
    sum
}

/// Rows p - last.
fn differences<const D: usize>(points: &[[f64; D]]) -> Vec<Vec<BigInt>> {
    let (last, rest) = points.split_last().expect("a point");
    let row = |p: &[f64; D]| (0..D).map(|k| integer(p[k]) - integer(last[k])).collect();
    rest.iter().map(row).collect()
}

fn orient2d_slow(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Ordering {
    sign(&determinant(&differences(&[a, b, c])))
}

fn incircle_slow(points: [[f64; 2]; 4]) -> Ordering {
    let mut rows = differences(&points);
    for row in &mut rows {
        let lift = &row[0] * &row[0] + &row[1] * &row[1];
        row.push(lift);
    }
    sign(&determinant(&rows))
}

fn orient3d_slow(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> Ordering {
    // Rows b - a, c - a, d - a.
    sign(&determinant(&differences(&[b, c, d, a])))
}

/// Coordinates that are often equal, close, huge, tiny or nearly collinear.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => (-4i32..5).prop_map(f64::from),
        3 => (-40i32..41).prop_map(|k| f64::from(k) * 0.1),
        2 => (-8i32..9).prop_map(|k| 1.0 + f64::from(k) * f64::EPSILON),
        2 => -1.0f64..1.0,
        2 => any::<f64>().prop_filter("finite", |x| x.is_finite()),
        1 => (-8i32..9).prop_map(|k| f64::from(k) * 5e-324),
        1 => prop_oneof![Just(f64::MAX), Just(-f64::MAX), Just(f64::MIN_POSITIVE), Just(-0.0)],
        1 => (-8i32..9).prop_map(|k| 1e300 * (1.0 + f64::from(k) * f64::EPSILON)),
    ]
}

fn point2() -> impl Strategy<Value = [f64; 2]> {
    [coordinate(), coordinate()]
}

fn point3() -> impl Strategy<Value = [f64; 3]> {
    [coordinate(), coordinate(), coordinate()]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    // spec: C2
    #[test]
    fn orient2d_is_exact(a in point2(), b in point2(), c in point2()) {
        let wanted = orient2d_slow(a, b, c);
        prop_assert_eq!(exact::orient2d(a, b, c), wanted);
        prop_assert_eq!(exact::doubled_area(a, b, c).sign(), wanted);
    }

    // spec: C2
    #[test]
    fn incircle_is_exact(p in [point2(), point2(), point2(), point2()]) {
        prop_assert_eq!(exact::incircle(p[0], p[1], p[2], p[3]), incircle_slow(p));
    }

    // spec: C2
    #[test]
    fn orient3d_is_exact(p in [point3(), point3(), point3(), point3()]) {
        let wanted = orient3d_slow(p[0], p[1], p[2], p[3]);
        prop_assert_eq!(exact::orient3d(p[0], p[1], p[2], p[3]), wanted);
    }

    // spec: C10
    #[test]
    fn area_sums_are_exact_in_any_order(
        triangles in prop::collection::vec([point2(), point2(), point2()], 0..12),
    ) {
        let mut wanted = BigInt::zero();
        let (mut forward, mut parts) = (ExactSum::default(), [ExactSum::default(), ExactSum::default()]);
        for (i, [a, b, c]) in triangles.iter().enumerate() {
            wanted += determinant(&differences(&[*b, *c, *a]));
            forward.add_scaled(&exact::doubled_area(*a, *b, *c));
            parts[i % 2].add_scaled(&exact::doubled_area(*a, *b, *c));
        }
        let [mut even, odd] = parts;
        even.merge(&odd);
        prop_assert_eq!(even.value(), forward.value());
        // In units of 2^-2148 both are integers.
        let (value, exponent) = forward.value();
        let shift = u32::try_from(exponent + 2148).expect("not below the register");
        prop_assert_eq!(value.shift_left(shift).to_string(), wanted.to_string());
    }

    #[test]
    fn wide_integers_calculate_like_big_ones(
        a in prop::collection::vec(any::<i128>(), 1..5),
        b in prop::collection::vec(any::<i128>(), 1..5),
        shift in 0u32..200,
    ) {
        let build = |parts: &[i128]| parts.iter().fold(Wide::zero(), |sum, &p| {
            sum.shift_left(100).plus(&Wide::shifted(p, 0))
        });
        let model = |parts: &[i128]| parts.iter().fold(BigInt::zero(), |sum, &p| {
            (sum << 100u32) + BigInt::from(p)
        });
        let (x, y, m, n) = (build(&a), build(&b), model(&a), model(&b));
        prop_assert_eq!(x.plus(&y).to_string(), (&m + &n).to_string());
        prop_assert_eq!(x.minus(&y).to_string(), (&m - &n).to_string());
        prop_assert_eq!(x.times(&y).to_string(), (&m * &n).to_string());
        prop_assert_eq!(x.shift_left(shift).to_string(), (&m << shift).to_string());
        prop_assert_eq!(x.shift_left(shift).shift_right(shift), x.clone());
        prop_assert_eq!(x.sign(), sign(&m));
        prop_assert_eq!(u64::from(x.bits()), m.bits());
        prop_assert_eq!(u64::from(x.trailing_zeros()), m.trailing_zeros().unwrap_or(0));
    }

    #[test]
    fn fixed_integers_calculate_like_big_ones(a: i128, b: i128, c: i64, d: i64) {
        let (a, b) = (a >> 1, b >> 1);
        let p = Int256::product(a, b);
        let q = Int256::product(i128::from(c), i128::from(d));
        let (m, n) = (BigInt::from(a) * b, BigInt::from(c) * d);
        prop_assert_eq!(p.widen().to_string(), m.to_string());
        prop_assert_eq!(p.plus(q).widen().to_string(), (&m + &n).to_string());
        prop_assert_eq!(p.minus(q).widen().to_string(), (&m - &n).to_string());
        prop_assert_eq!(p.minus(q).sign(), sign(&(m - n)));
        prop_assert_eq!(p.minus(p).sign(), Ordering::Equal);
    }

    /// Collinear by construction: the rungs must say so.
    #[test]
    fn collinear_points_are_collinear(
        a in [-1000i32..1000, -1000i32..1000],
        d in [-1000i32..1000, -1000i32..1000],
        steps in [-50i32..50, -50i32..50],
        exponent in -1000i32..900,
    ) {
        let scale = libm::scalbn(1.0, exponent);
        let at = |k: i32| [0, 1].map(|i| f64::from(a[i] + k * d[i]) * scale);
        prop_assert_eq!(exact::orient2d(at(0), at(steps[0]), at(steps[1])), Ordering::Equal);
    }
}

/// All triples of a 5x5 lattice, at scales that take every rung.
// spec: C2
#[test]
fn orient2d_on_a_small_lattice_at_every_scale() {
    let lattice: Vec<(i64, i64)> = (0..25).map(|i| (i % 5, i / 5)).collect();
    let expected = |a: (i64, i64), b: (i64, i64), c: (i64, i64)| {
        ((b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)).cmp(&0)
    };
    for (scale, offset) in
        [(1.0, 0.0), (0.1, 0.0), (1e-320, 0.0), (1e307, 0.0), (2.0, 9e15), (1e-5, 1e5)]
    {
        let exact_scale = scale == 1.0 || scale == 2.0;
        let at = |(x, y): (i64, i64)| [x as f64 * scale + offset, y as f64 * scale + offset];
        for &a in &lattice {
            for &b in &lattice {
                for &c in &lattice {
                    let got = exact::orient2d(at(a), at(b), at(c));
                    let wanted = if exact_scale {
                        expected(a, b, c)
                    } else {
                        orient2d_slow(at(a), at(b), at(c))
                    };
                    assert_eq!(got, wanted, "{a:?} {b:?} {c:?} at {scale}, {offset}");
                }
            }
        }
    }
}

#[test]
fn incircle_on_a_small_lattice() {
    let lattice: Vec<[f64; 2]> = (0..16).map(|i| [f64::from(i % 4), f64::from(i / 4)]).collect();
    let far = |p: [f64; 2]| [p[0] * 1e200, p[1] * 1e-200];
    for &a in &lattice {
        for &b in &lattice {
            for &c in &lattice[..8] {
                for &d in &lattice[..4] {
                    let wanted = incircle_slow([a, b, c, d]);
                    assert_eq!(exact::incircle(a, b, c, d), wanted);
                }
            }
        }
    }
    let [a, b, c, d] = [lattice[0], lattice[3], lattice[9], lattice[6]].map(far);
    assert_eq!(exact::incircle(a, b, c, d), incircle_slow([a, b, c, d]));
}
