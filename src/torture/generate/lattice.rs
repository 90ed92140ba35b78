//! Exact geometry on the integer lattice: what generators prove their claims with.
//!
//! It shares nothing with the floating-point predicates, so that a wrong one cannot vouch for
//! itself. Coordinates stay within [`LIMIT`], hence every determinant within 2^111.

use std::cmp::Ordering;

/// A point of the integer lattice.
pub type Site = [i64; 2];

/// Largest coordinate in magnitude: up to here every integer is a double.
pub const LIMIT: i64 = 1 << 53;

/// Sign of the area of the triangle a, b, c: `Greater` when it is counterclockwise.
#[must_use]
pub fn turn(a: Site, b: Site, c: Site) -> Ordering {
    let d = |p: Site, axis: usize| i128::from(p[axis]) - i128::from(a[axis]);
    (d(b, 0) * d(c, 1)).cmp(&(d(b, 1) * d(c, 0)))
}

/// Whether p, which lies on the line through a and b, lies on the closed segment a b.
fn within(a: Site, b: Site, p: Site) -> bool {
    (0..2).all(|axis| p[axis] >= a[axis].min(b[axis]) && p[axis] <= a[axis].max(b[axis]))
}

/// Whether the closed segments a b and c d have a common point.
#[must_use]
pub fn meet([a, b]: [Site; 2], [c, d]: [Site; 2]) -> bool {
    let boxes = (0..2).all(|axis| {
        a[axis].min(b[axis]) <= c[axis].max(d[axis]) && c[axis].min(d[axis]) <= a[axis].max(b[axis])
    });
    if !boxes {
        return false;
    }
    let (abc, abd, cda, cdb) = (turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b));
    let touches = |side: Ordering, p, q, r| side == Ordering::Equal && within(p, q, r);
    (abc != abd && cda != cdb && abc.is_ne() && abd.is_ne() && cda.is_ne() && cdb.is_ne())
        || touches(abc, a, b, c)
        || touches(abd, a, b, d)
        || touches(cda, c, d, a)
        || touches(cdb, c, d, b)
}

/// Whether a ring is a simple polygon: edges meet in common ends of neighbours only, and no
/// neighbour turns back. Tests every pair of edges.
#[must_use]
pub fn is_simple(ring: &[Site]) -> bool {
    let n = ring.len();
    let edge = |i: usize| [ring[i % n], ring[(i + 1) % n]];
    let folds = |i: usize| {
        let [a, b] = edge(i);
        let c = edge(i + 1)[1];
        a == b || (turn(a, b, c).is_eq() && (within(a, b, c) || within(b, c, a)))
    };
    n >= 3
        && !(0..n).any(folds)
        && (0..n).all(|i| {
            let last = if i == 0 { n - 1 } else { n };
            (i + 2..last).all(|j| !meet(edge(i), edge(j)))
        })
}

/// Greatest common divisor of two numbers that are not both 0.
#[must_use]
pub fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a.abs() } else { gcd(b, a % b) }
}

/// For coprime n, m > 0 with n > 1 the site w nearest to the line of d = (n, m) on its left:
/// det(d, w) = 1, with 0 < `w[0]` <= n. Its distance from the line is 1 / |d|.
#[must_use]
pub fn nearest_left([n, m]: Site) -> Site {
    // n v - m u = 1: u is minus the inverse of m modulo n.
    let (mut old, mut new) = ((n, 0i64), (m % n, 1i64));
    while new.0 != 0 {
        let q = old.0 / new.0;
        (old, new) = (new, (old.0 - q * new.0, old.1 - q * new.1));
    }
    let u = (-old.1).rem_euclid(n);
    let u = if u == 0 { n } else { u };
    let v = (i128::from(m) * i128::from(u) + 1) / i128::from(n);
    [u, v as i64]
}

/// Order of directions by angle from the positive x axis, counterclockwise; exact.
#[must_use]
pub fn by_angle(a: Site, b: Site) -> Ordering {
    let half = |p: Site| p[1] < 0 || (p[1] == 0 && p[0] < 0);
    half(a).cmp(&half(b)).then_with(|| turn([0, 0], b, a))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_meet_when_they_share_a_point() {
        let s = [[0, 0], [4, 4]];
        assert!(meet(s, [[0, 4], [4, 0]]), "they cross");
        assert!(meet(s, [[2, 2], [5, 0]]), "an end on the other");
        assert!(meet(s, [[3, 3], [9, 9]]), "they overlap");
        assert!(meet(s, [[4, 4], [5, 0]]), "a common end");
        assert!(!meet(s, [[5, 5], [9, 9]]), "apart on one line");
        assert!(!meet(s, [[0, 1], [3, 4]]), "parallel");
        assert!(!meet(s, [[3, 2], [4, 0]]), "apart");
    }

    #[test]
    fn simple_and_other_rings() {
        assert!(is_simple(&[[0, 0], [4, 0], [4, 4], [2, 1], [0, 4]]));
        assert!(is_simple(&[[0, 0], [2, 0], [4, 0], [4, 4]]), "a straight angle");
        assert!(!is_simple(&[[0, 0], [4, 4], [4, 0], [0, 4]]), "a bow tie");
        assert!(!is_simple(&[[0, 0], [4, 0], [2, 0], [2, 3]]), "a spike");
        assert!(!is_simple(&[[0, 0], [4, 0], [4, 4], [2, 0], [0, 4]]), "a touching vertex");
        assert!(!is_simple(&[[0, 0], [0, 0], [4, 4]]), "a repeated vertex");
        assert!(!is_simple(&[[0, 0], [4, 4]]), "two points");
    }

    #[test]
    fn the_nearest_site_is_at_determinant_one() {
        for d in [[2, 1], [7, 3], [7, 100], [1_000_003, 999_983], [(1 << 40) + 1, (1 << 39) + 5]] {
            assert_eq!(gcd(d[0], d[1]), 1, "{d:?}");
            let [u, v] = nearest_left(d);
            let det = i128::from(d[0]) * i128::from(v) - i128::from(d[1]) * i128::from(u);
            assert_eq!(det, 1, "{d:?}");
            assert!(0 < u && u <= d[0]);
        }
    }

    #[test]
    fn angles_run_once_around() {
        let around = [[1, 0], [2, 1], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
        for pair in around.windows(2) {
            assert_eq!(by_angle(pair[0], pair[1]), Ordering::Less, "{pair:?}");
        }
        assert_eq!(by_angle([1, 2], [2, 4]), Ordering::Equal);
    }
}
