//! The oracle of the predicates: rational arithmetic, written down from the definitions.

use num_rational::BigRational;
use num_traits::{Signed, Zero};
use trigrade::point::Point2;
use trigrade::predicates::Sign;

fn exact(value: f64) -> BigRational {
    BigRational::from_float(value).expect("finite")
}

fn sign(value: &BigRational) -> Sign {
    if value.is_zero() {
        Sign::Zero
    } else if value.is_positive() {
        Sign::Positive
    } else {
        Sign::Negative
    }
}

fn difference(a: Point2, b: Point2) -> [BigRational; 2] {
    [exact(a.x) - exact(b.x), exact(a.y) - exact(b.y)]
}

/// The sign of (a - c) x (b - c).
pub fn orient2d(a: Point2, b: Point2, c: Point2) -> Sign {
    let ([ax, ay], [bx, by]) = (difference(a, c), difference(b, c));
    sign(&(ax * by - ay * bx))
}

/// The sign of the determinant of the rows (p - d, |p - d|^2) for p = a, b, c.
pub fn incircle(a: Point2, b: Point2, c: Point2, d: Point2) -> Sign {
    let [p, q, r] = [a, b, c].map(|p| {
        let [x, y] = difference(p, d);
        let lift = &x * &x + &y * &y;
        [x, y, lift]
    });
    let minor = |u: &[BigRational; 3], v: &[BigRational; 3]| &u[0] * &v[1] - &u[1] * &v[0];
    sign(&(&p[2] * minor(&q, &r) + &q[2] * minor(&r, &p) + &r[2] * minor(&p, &q)))
}

/// Whether `p` lies on the segment from a to b, but is neither end.
pub fn is_inside_segment(p: Point2, [a, b]: [Point2; 2]) -> bool {
    let between = |p: f64, a: f64, b: f64| (a.min(b)..=a.max(b)).contains(&p);
    p != a
        && p != b
        && orient2d(a, b, p) == Sign::Zero
        && between(p.x, a.x, b.x)
        && between(p.y, a.y, b.y)
}

/// Whether two segments have a point inside both in common.
pub fn cross([a, b]: [Point2; 2], [c, d]: [Point2; 2]) -> bool {
    let opposite = |s: Sign, t: Sign| s != Sign::Zero && s == t.reversed();
    opposite(orient2d(a, b, c), orient2d(a, b, d)) && opposite(orient2d(c, d, a), orient2d(c, d, b))
}
