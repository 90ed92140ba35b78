//! The direction of a loop, exactly and without computing an area.

use crate::point::Point2;
use crate::predicates::{Sign, orient2d};

/// The sign of the area that a loop encloses: `Positive` if it runs counterclockwise, `Zero` if it
/// has fewer than three points or lies on one line.
///
/// At the lexicographically smallest point all edges lead to the right, and what is below the lowest
/// of them is outside: a counterclockwise loop leaves on it, a clockwise one arrives on it.
///
/// **Requires** a loop that does not cross or overlap itself (SPEC D6, D8, D9); it may touch itself.
/// Vertices are indices into `points`, and must exist.
///
/// # Complexity
/// O(n) comparisons, and two orientations for each visit of the smallest point.
///
/// # Examples
///
/// ```
/// use trigrade::{domain::validate::loop_orientation, point::Point2, predicates::Sign};
/// let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(Point2::from);
/// assert_eq!(loop_orientation(&points, &[0, 1, 2]), Sign::Positive);
/// assert_eq!(loop_orientation(&points, &[0, 2, 1]), Sign::Negative);
/// ```
#[must_use]
pub fn loop_orientation(points: &[Point2], vertices: &[u32]) -> Sign {
    let at = |i: usize| points[vertices[i % vertices.len()] as usize];
    let Some(first) = (0..vertices.len()).min_by(|&i, &j| at(i).lexicographic(at(j))) else {
        return Sign::Zero;
    };
    let origin = at(first);
    let visits = (0..vertices.len()).filter(|&i| at(i).key() == origin.key());
    let mut lowest: Option<(Point2, Sign)> = None;
    for i in visits {
        let ends = [(at(i + 1), Sign::Positive), (at(i + vertices.len() - 1), Sign::Negative)];
        for (end, direction) in ends {
            lowest = Some(match lowest {
                None => (end, direction),
                Some((best, kept)) => match orient2d(origin, best, end) {
                    Sign::Positive => (best, kept),
                    Sign::Negative => (end, direction),
                    Sign::Zero => (best, Sign::Zero),
                },
            });
        }
    }
    lowest.map_or(Sign::Zero, |(_, direction)| direction)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sign(ring: &[[f64; 2]]) -> Sign {
        let points: Vec<Point2> = ring.iter().map(|&p| p.into()).collect();
        let mut vertices: Vec<u32> = (0..points.len() as u32).collect();
        let forward = loop_orientation(&points, &vertices);
        for _ in 0..vertices.len() {
            vertices.rotate_left(1);
            assert_eq!(loop_orientation(&points, &vertices), forward);
        }
        vertices.reverse();
        assert_eq!(loop_orientation(&points, &vertices), forward.reversed());
        forward
    }

    // spec: D19
    #[test]
    fn direction_of_loops() {
        assert_eq!(sign(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), Sign::Positive);
        assert_eq!(sign(&[[0.0, 0.0], [9.0, 1.0], [1.0, 1.0], [1.0, 9.0]]), Sign::Positive);
        // The smallest point in the middle of a straight side, and in a needle one ulp wide.
        assert_eq!(sign(&[[0.0, 0.0], [1.0, 0.0], [0.0, 2.0], [0.0, 1.0]]), Sign::Positive);
        assert_eq!(sign(&[[0.0, 0.0], [1e300, 5e-324], [1e300, 1e-323]]), Sign::Positive);
    }

    // spec: D19
    #[test]
    fn direction_of_loops_that_touch_themselves_at_the_smallest_point() {
        // Two lobes side by side, and a lobe with a hole that hangs on the same point.
        let lobes = [[0., 0.], [4., -3.], [4., -1.], [0., 0.], [4., 1.], [4., 3.]];
        assert_eq!(sign(&lobes), Sign::Positive);
        let hole = [[0., 0.], [9., -9.], [9., 9.], [0., 0.], [4., 1.], [4., -1.]];
        assert_eq!(sign(&hole), Sign::Positive);
    }

    #[test]
    fn no_direction_without_area() {
        assert_eq!(sign(&[]), Sign::Zero);
        assert_eq!(sign(&[[1.0, 2.0]]), Sign::Zero);
        assert_eq!(sign(&[[1.0, 2.0], [3.0, 4.0]]), Sign::Zero);
        assert_eq!(sign(&[[0.0, 0.0], [2.0, 2.0], [1.0, 1.0]]), Sign::Zero);
    }
}
