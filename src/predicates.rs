//! Geometric predicates: the sign of a polynomial in the coordinates, right for every finite f64.

use crate::point::Point2;

/// The sign of an exact expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Sign {
    /// Below zero.
    Negative,
    /// Exactly zero.
    Zero,
    /// Above zero.
    Positive,
}

impl Sign {
    /// The sign of a float; NaN counts as zero, so pass exact values only.
    #[must_use]
    pub fn of(value: f64) -> Self {
        if value > 0.0 {
            Self::Positive
        } else if value < 0.0 {
            Self::Negative
        } else {
            Self::Zero
        }
    }

    /// The sign of the negated expression.
    #[must_use]
    pub const fn reversed(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Zero => Self::Zero,
            Self::Positive => Self::Negative,
        }
    }
}

fn coord(p: Point2) -> robust::Coord<f64> {
    robust::Coord { x: p.x, y: p.y }
}

/// Which side of the line from `a` to `b` the point `c` lies on: `Positive` on the left.
#[must_use]
pub fn orient2d(a: Point2, b: Point2, c: Point2) -> Sign {
    Sign::of(robust::orient2d(coord(a), coord(b), coord(c)))
}

/// Whether `d` lies inside (`Positive`), on or outside the circle through the counterclockwise
/// `a`, `b`, `c`.
#[must_use]
pub fn incircle(a: Point2, b: Point2, c: Point2, d: Point2) -> Sign {
    Sign::of(robust::incircle(coord(a), coord(b), coord(c), coord(d)))
}

/// [`incircle`] under the symbolic perturbation of the lifted heights: `Zero` only if all four
/// points are collinear or two of them are equal.
///
/// Every point's height x^2 + y^2 gets an infinitesimal of its own added, infinitely larger for the
/// lexicographically larger point (Edelsbrunner and Muecke 1990, on the height alone).
#[must_use]
pub fn incircle_perturbed(a: Point2, b: Point2, c: Point2, d: Point2) -> Sign {
    let sign = incircle(a, b, c, d);
    if sign == Sign::Zero { tie_break([a, b, c, d]) } else { sign }
}

/// Sign of the determinant's perturbation: the cofactor of the largest point that has a nonzero one.
#[cold]
fn tie_break(points: [Point2; 4]) -> Sign {
    let mut order = [0, 1, 2, 3];
    order.sort_by(|&i, &j| points[j].lexicographic(points[i]));
    if order.windows(2).any(|w| points[w[0]] == points[w[1]]) {
        return Sign::Zero;
    }
    order
        .into_iter()
        .map(|i| height_cofactor(points, i))
        .find(|&sign| sign != Sign::Zero)
        .unwrap_or(Sign::Zero)
}

/// Sign of the cofactor of point `i`'s height in the determinant with rows (x, y, height, 1).
fn height_cofactor([a, b, c, d]: [Point2; 4], i: usize) -> Sign {
    match i {
        0 => orient2d(b, c, d),
        1 => orient2d(a, c, d).reversed(),
        2 => orient2d(a, b, d),
        _ => orient2d(a, b, c).reversed(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_corner_of_a_square_is_cut_off() {
        let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point2::from);
        assert_eq!(incircle_perturbed(a, b, d, c), Sign::Negative, "(1, 1) is raised most");
        assert_eq!(incircle_perturbed(a, b, c, d), Sign::Positive);
        assert_eq!(incircle_perturbed(b, c, d, a), Sign::Negative, "b and d are joined");
        assert_eq!(incircle_perturbed(a, b, c, a), Sign::Zero, "equal points are one point");
    }
}
