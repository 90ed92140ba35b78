//! The point where two segments cross, rounded once.

use super::exact::{ExactPoint, ExactSum, Factor};
use super::{SegmentIntersection, Sign, classify};
use crate::point::Point2;

/// The point where the segments `ab` and `cd` cross, each coordinate rounded to the nearest f64, ties
/// to even; nothing unless [`classify`] says `ProperCrossing`.
///
/// The result lies in the bounding boxes of both segments, but in general on neither, and may even
/// equal an end. It does not depend on the order of the segments or of their ends.
///
/// **Requires** finite coordinates. **Guarantees** P11.
///
/// # Examples
///
/// ```
/// use trigrade::{point::Point2, predicates::rounded_crossing};
/// let [a, b, c, d] = [[0.0, 0.0], [3.0, 1.0], [0.0, 1.0], [3.0, 0.0]].map(Point2::from);
/// assert_eq!(rounded_crossing(a, b, c, d), Some(Point2::new(1.5, 0.5)));
/// assert_eq!(rounded_crossing(a, c, b, d), None);
/// ```
#[must_use]
pub fn rounded_crossing(a: Point2, b: Point2, c: Point2, d: Point2) -> Option<Point2> {
    if classify(a, b, c, d) != SegmentIntersection::ProperCrossing {
        return None;
    }
    let crossing = Crossing::of([a, b, c, d]);
    let guess = guess(a, b, c, d);
    let coordinate = |axis: Axis| {
        let [a, b, c, d] = [a, b, c, d].map(|p| axis.of(p));
        let bounds = [a.min(b).max(c.min(d)), a.max(b).min(c.max(d))];
        round_to_nearest(bounds, axis.of(guess), |value| crossing.compare(axis, value))
    };
    Some(Point2::new(coordinate(Axis::X), coordinate(Axis::Y)))
}

/// The crossing in plain floats; it only says where the exact search begins, so it may be anything.
fn guess(a: Point2, b: Point2, c: Point2, d: Point2) -> Point2 {
    let cross =
        |p: Point2, q: Point2, r: Point2| (p.x - r.x) * (q.y - r.y) - (p.y - r.y) * (q.x - r.x);
    let (start, end) = (cross(c, d, a), cross(c, d, b));
    let along = start / (start - end);
    Point2::new(a.x + along * (b.x - a.x), a.y + along * (b.y - a.y))
}

/// One of the two coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The abscissa.
    X,
    /// The ordinate.
    Y,
}

impl Axis {
    /// The coordinate of a point.
    #[must_use]
    pub const fn of(self, p: Point2) -> f64 {
        match self {
            Self::X => p.x,
            Self::Y => p.y,
        }
    }

    /// The other axis.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::X => Self::Y,
            Self::Y => Self::X,
        }
    }

    fn of_exact(self, p: ExactPoint) -> Factor {
        match self {
            Self::X => p.x,
            Self::Y => p.y,
        }
    }
}

/// The exact crossing of two lines as a fraction of polynomials.
///
/// With D = (a - b) x (c - d) the crossing is ((a x b)(c - d) - (c x d)(a - b)) / D, where p x q =
/// px qy - py qx (Cramer's rule).
struct Crossing {
    points: [ExactPoint; 4],
    /// Whether D is negative.
    denominator_negative: bool,
}

impl Crossing {
    /// The crossing of the lines `ab` and `cd`, which are not parallel.
    fn of(points: [Point2; 4]) -> Self {
        let points = points.map(ExactPoint::of);
        let mut denominator = ExactSum::new();
        add_denominator(&mut denominator, points, &[], false);
        Self { points, denominator_negative: denominator.sign() == Sign::Negative }
    }

    /// How the crossing's coordinate compares with `value`: the sign of (numerator - value D) / D.
    fn compare(&self, axis: Axis, value: Factor) -> Sign {
        let [a, b, c, d] = self.points;
        let mut sum = ExactSum::new();
        sum.add_cross(&[axis.of_exact(c)], false, a, b);
        sum.add_cross(&[axis.of_exact(d)], true, a, b);
        sum.add_cross(&[axis.of_exact(a)], true, c, d);
        sum.add_cross(&[axis.of_exact(b)], false, c, d);
        add_denominator(&mut sum, self.points, &[value], true);
        if self.denominator_negative { sum.sign().reversed() } else { sum.sign() }
    }
}

/// Adds D = a x c - a x d - b x c + b x d times the common factor.
fn add_denominator(
    sum: &mut ExactSum,
    [a, b, c, d]: [ExactPoint; 4],
    common: &[Factor],
    negate: bool,
) {
    sum.add_cross(common, negate, a, c);
    sum.add_cross(common, !negate, a, d);
    sum.add_cross(common, !negate, b, c);
    sum.add_cross(common, negate, b, d);
}

/// The float nearest to a number within the bounds that is known by comparison only: bisection over
/// the floats in between, at most 66 steps, five where the guess is good.
fn round_to_nearest(bounds: [f64; 2], guess: f64, compare: impl Fn(Factor) -> Sign) -> f64 {
    let [mut low, mut high] = bounds.map(rank);
    let guess = rank(guess.clamp(bounds[0], bounds[1]));
    let mut probes =
        [guess.saturating_sub(GUESS_REACH), guess.saturating_add(GUESS_REACH)].into_iter();
    while low < high.saturating_sub(1) {
        let middle = match probes.next() {
            Some(probe) if low < probe && probe < high => probe,
            Some(_) => continue,
            None => i64::midpoint(low, high),
        };
        match compare(Factor::of(unrank(middle))) {
            Sign::Negative => high = middle,
            Sign::Zero => return unrank(middle),
            Sign::Positive => low = middle,
        }
    }
    nearer_neighbour(low, high, compare)
}

/// The float nearest to a number that is known by comparison only, ties to even; the largest float,
/// with the number's sign, for a number beyond it.
pub(super) fn rounded_by(guess: f64, compare: impl Fn(Factor) -> Sign) -> f64 {
    if compare(Factor::of(f64::MAX)) != Sign::Negative {
        return f64::MAX;
    }
    if compare(Factor::of(f64::MIN)) != Sign::Positive {
        return f64::MIN;
    }
    let guess = if guess.is_nan() { 0.0 } else { guess };
    round_to_nearest([f64::MIN, f64::MAX], guess, compare) + 0.0
}

/// How many floats a good guess may be off.
const GUESS_REACH: i64 = 4;

/// Which of the floats ranked `low` and `high`, the same or neighbours, a number between them is
/// nearer to.
fn nearer_neighbour(low: i64, high: i64, compare: impl Fn(Factor) -> Sign) -> f64 {
    if low >= high {
        return unrank(low);
    }
    // The midpoint lies beyond the one nearer to zero; if that one is zero, on the other's side.
    let inner = if low >= 0 { unrank(low) } else { unrank(high).copysign(-1.0) };
    match compare(Factor::half_step_beyond(inner)) {
        Sign::Negative => unrank(low),
        Sign::Positive => unrank(high),
        Sign::Zero if low % 2 == 0 => unrank(low),
        Sign::Zero => unrank(high),
    }
}

/// Position of a float among all floats, 0 for both zeros. Even for an even significand.
fn rank(value: f64) -> i64 {
    let magnitude = value.abs().to_bits() as i64;
    if value < 0.0 { -magnitude } else { magnitude }
}

fn unrank(rank: i64) -> f64 {
    let magnitude = f64::from_bits(rank.unsigned_abs());
    if rank < 0 { -magnitude } else { magnitude }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_count_the_floats_in_order() {
        let ordered = [f64::MIN, -1.0, -5e-324, 0.0, 5e-324, f64::MIN_POSITIVE, 1.0, f64::MAX];
        assert!(ordered.windows(2).all(|pair| rank(pair[0]) < rank(pair[1])));
        assert!(ordered.iter().all(|&v| unrank(rank(v)).to_bits() == v.to_bits()));
        assert_eq!(rank(5e-324) - rank(-5e-324), 2, "the zeros are one");
        assert_eq!(rank(1.0) - rank(1.0_f64.next_down()), 1);
    }

    #[test]
    fn ties_go_to_the_even_neighbour_on_both_sides_of_zero() {
        let between = |low: f64, high: f64| {
            nearer_neighbour(rank(low), rank(high), |midpoint| {
                let inner = if low >= 0.0 { low.abs() } else { high.copysign(-1.0) };
                assert_eq!(midpoint, Factor::half_step_beyond(inner));
                Sign::Zero
            })
        };
        for even in [1.0, 0.0, f64::MIN_POSITIVE, 3.0 * 2.0_f64.powi(900)] {
            assert_eq!(rank(even) % 2, 0, "{even} is even");
            assert_eq!(between(even, even.next_up()), even);
            assert_eq!(between(even.next_down(), even), even);
            assert_eq!(between(-even, (-even).next_up()), -even);
        }
    }
}
