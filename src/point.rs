//! Points of the plane and of space, as every stage and both halves of the house see them.

use serde::{Deserialize, Serialize};

/// A point of the plane, in the unit of the input file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub struct Point2 {
    /// Abscissa.
    pub x: f64,
    /// Ordinate.
    pub y: f64,
}

impl Point2 {
    /// The point (x, y).
    #[must_use]
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// Whether both coordinates are finite.
    #[must_use]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }

    /// Squared Euclidean distance to `other`; may overflow or underflow, so it ranks, never decides.
    #[must_use]
    pub fn distance_sq(self, other: Self) -> f64 {
        let (dx, dy) = (other.x - self.x, other.y - self.y);
        dx * dx + dy * dy
    }

    /// Euclidean distance to `other`, rounded; it ranks, never decides.
    #[must_use]
    pub fn distance(self, other: Self) -> f64 {
        self.distance_sq(other).sqrt()
    }

    /// The nearest point whose coordinates are multiples of `quantum`, a power of two.
    #[must_use]
    pub fn rounded_to(self, quantum: f64) -> Self {
        let round = |x: f64| libm::round(x / quantum) * quantum;
        Self::new(round(self.x), round(self.y))
    }

    /// Key by which equal points are equal: the coordinates' bits with -0.0 folded into 0.0.
    #[must_use]
    pub fn key(self) -> [u64; 2] {
        [(self.x + 0.0).to_bits(), (self.y + 0.0).to_bits()]
    }

    /// Order by x, then by y (`f64::total_cmp` with -0.0 equal to 0.0): the order of every tie-break.
    #[must_use]
    pub fn lexicographic(self, other: Self) -> std::cmp::Ordering {
        (self.x + 0.0)
            .total_cmp(&(other.x + 0.0))
            .then_with(|| (self.y + 0.0).total_cmp(&(other.y + 0.0)))
    }
}

impl From<[f64; 2]> for Point2 {
    fn from([x, y]: [f64; 2]) -> Self {
        Self { x, y }
    }
}

impl From<Point2> for [f64; 2] {
    fn from(p: Point2) -> Self {
        [p.x, p.y]
    }
}

impl std::fmt::Display for Point2 {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "({:?}, {:?})", self.x, self.y)
    }
}
