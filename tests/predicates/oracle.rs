//! The same questions answered in rational arithmetic, straight from the definitions.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::float::FloatCore;
use num_traits::{Signed, Zero};
use trigrade::point::Point2;
use trigrade::predicates::Sign;

pub fn rational(value: f64) -> BigRational {
    BigRational::from_float(value).expect("a finite float")
}

pub fn sign(value: &BigRational) -> Sign {
    if value.is_positive() {
        Sign::Positive
    } else if value.is_negative() {
        Sign::Negative
    } else {
        Sign::Zero
    }
}

fn difference(p: Point2, q: Point2) -> [BigRational; 2] {
    [rational(p.x) - rational(q.x), rational(p.y) - rational(q.y)]
}

fn cross(p: &[BigRational; 2], q: &[BigRational; 2]) -> BigRational {
    &p[0] * &q[1] - &p[1] * &q[0]
}

pub fn orient2d(a: Point2, b: Point2, c: Point2) -> Sign {
    sign(&cross(&difference(a, c), &difference(b, c)))
}

pub fn incircle(a: Point2, b: Point2, c: Point2, d: Point2) -> Sign {
    let [a, b, c] = [a, b, c].map(|p| difference(p, d));
    let lift = |p: &[BigRational; 2]| &p[0] * &p[0] + &p[1] * &p[1];
    sign(&(lift(&a) * cross(&b, &c) + lift(&b) * cross(&c, &a) + lift(&c) * cross(&a, &b)))
}

/// `orient2d` and `incircle` in big integers on the coordinates' common lattice: a hundred times
/// faster than fractions that are kept in lowest terms, so millions of cases can be asked.
pub fn on_lattice(quad: [Point2; 4]) -> (Sign, Sign) {
    let unit = quad.iter().flat_map(|p| [p.x, p.y]).map(|v| v.integer_decode().1).min();
    let integer = |v: f64| {
        let (significand, exponent, sign) = v.integer_decode();
        let shift = exponent - unit.expect("eight coordinates");
        (BigInt::from(significand) << shift) * sign
    };
    let [ax, ay, bx, by, cx, cy, dx, dy] = [0, 1, 2, 3, 4, 5, 6, 7]
        .map(|i| integer(if i % 2 == 0 { quad[i / 2].x } else { quad[i / 2].y }));
    let cross = |p: &[BigInt; 2], q: &[BigInt; 2]| &p[0] * &q[1] - &p[1] * &q[0];
    let lift = |p: &[BigInt; 2]| &p[0] * &p[0] + &p[1] * &p[1];
    let side = cross(&[&ax - &cx, &ay - &cy], &[&bx - &cx, &by - &cy]);
    let [a, b, c] = [[ax - &dx, ay - &dy], [bx - &dx, by - &dy], [cx - dx, cy - dy]];
    let inside = lift(&a) * cross(&b, &c) + lift(&b) * cross(&c, &a) + lift(&c) * cross(&a, &b);
    (Sign::from(side.cmp(&BigInt::ZERO)), Sign::from(inside.cmp(&BigInt::ZERO)))
}

/// The crossing of the lines `ab` and `cd`, which are not parallel.
pub fn crossing(a: Point2, b: Point2, c: Point2, d: Point2) -> [BigRational; 2] {
    let (along, other) = (difference(b, a), difference(d, c));
    let t = cross(&difference(c, a), &other) / cross(&along, &other);
    [rational(a.x) + &t * &along[0], rational(a.y) + &t * &along[1]]
}

/// The sign of the lifted determinant by Leibniz' formula with heights x^2 + y^2 + eps_i, where eps is
/// a power series in one infinitesimal: the perturbation taken at its word. The point of rank r among
/// the different points, smallest first, is raised by the infinitesimal to the power (count - r).
pub fn incircle_perturbed(points: [Point2; 4]) -> Sign {
    let mut ranked = points.to_vec();
    ranked.sort_by(|p, q| p.lexicographic(*q));
    ranked.dedup();
    let power = |p: Point2| ranked.len() - ranked.iter().position(|&q| q == p).expect("ranked");
    // Coefficients of the determinant by power of the infinitesimal.
    let mut series = vec![BigRational::zero(); ranked.len() + 1];
    for (odd, [x, y, height, _one]) in permutations() {
        let area = rational(points[x].x) * rational(points[y].y);
        let area = if odd { -area } else { area };
        let lifted = points[height];
        let (u, v) = (rational(lifted.x), rational(lifted.y));
        series[0] += &area * (&u * &u + &v * &v);
        series[power(lifted)] += area;
    }
    series.iter().map(sign).find(|&sign| sign != Sign::Zero).unwrap_or(Sign::Zero)
}

/// All 24 permutations of four things, and whether they are odd.
pub fn permutations() -> Vec<(bool, [usize; 4])> {
    let mut found = Vec::new();
    for code in 0..256_usize {
        let p = [code % 4, code / 4 % 4, code / 16 % 4, code / 64];
        if (0..4).all(|i| p.contains(&i)) {
            let inversions = (0..4).flat_map(|j| (0..j).map(move |i| (i, j)));
            found.push((inversions.filter(|&(i, j)| p[i] > p[j]).count() % 2 == 1, p));
        }
    }
    found
}

/// Whether `value` is the float nearest to `exact`, ties to even.
pub fn is_nearest(value: f64, exact: &BigRational) -> bool {
    let error = (rational(value) - exact).abs();
    [value.next_down(), value.next_up()].into_iter().filter(|v| v.is_finite()).all(|neighbour| {
        let other = (rational(neighbour) - exact).abs();
        error < other || (error == other && value.to_bits().is_multiple_of(2))
    })
}

#[test]
fn the_oracle_knows_a_few_answers_by_heart() {
    let [a, b, c] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(Point2::from);
    assert_eq!(orient2d(a, b, c), Sign::Positive);
    assert_eq!(incircle(a, b, c, Point2::new(0.5, 0.5)), Sign::Positive);
    assert_eq!(incircle(a, b, c, Point2::new(1.0, 1.0)), Sign::Zero);
    assert_eq!(incircle(a, b, c, Point2::new(2.0, 1.0)), Sign::Negative);
    assert_eq!(incircle_perturbed([a, b, c, Point2::new(1.0, 1.0)]), Sign::Negative);
    assert_eq!(permutations().iter().filter(|(odd, _)| *odd).count(), 12);
    assert!(is_nearest(0.1, &BigRational::new(BigInt::from(1), BigInt::from(10))));
    assert!(!is_nearest(0.1_f64.next_up(), &BigRational::new(BigInt::from(1), BigInt::from(10))));
}
