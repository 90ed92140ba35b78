//! Geometric predicates: the sign of a polynomial in the coordinates, right for every finite f64.
//!
//! A question climbs a ladder and stops at the first rung that can answer it. No rung ever answers
//! wrongly; a rung that cannot decide says so.
//!
//! | rung | file | answers |
//! |---|---|---|
//! | filter | `filter.rs` | whenever the float result exceeds its own error bound |
//! | fixed | `fixed.rs` | whenever the coordinate differences fit one lattice of 126 bits |
//! | adaptive | `adaptive.rs` | the rest, where expansions neither overflow nor underflow (`robust`) |
//! | exact | `exact.rs` | everything else: 1e300 beside 1e-310 |
//!
//! Every function requires finite coordinates; with others it returns some sign, without a panic.
//! No sign depends on build flags: Rust never contracts `a * b + c` to a fused operation, and the
//! bounds of the filter hold for every IEEE 754 evaluation in double precision.

mod adaptive;
mod circumcentre;
mod crossing;
mod exact;
mod filter;
mod fixed;
mod ladder;
mod perturbed;
mod segment;
mod spoke;
mod wide;

pub use circumcentre::{compare_circumcentre, nearer, rounded_bisector, rounded_circumcentre};
pub use crossing::{Axis, rounded_crossing};
pub use ladder::{Rung, incircle, incircle_with_rung, orient2d, orient2d_with_rung};
#[doc(hidden)]
pub use ladder::{incircle_by_every_rung, orient2d_by_every_rung};
pub use perturbed::incircle_perturbed;
pub use segment::{
    PointInTriangle, SegmentEnd, SegmentIntersection, WhichSegment, classify, on_collinear_segment,
    point_in_triangle, point_on_segment,
};
pub use spoke::{Cross, Spoke, centre_in_circle};

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
    #[inline]
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
    #[inline]
    #[must_use]
    pub const fn reversed(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Zero => Self::Zero,
            Self::Positive => Self::Negative,
        }
    }
}

impl From<std::cmp::Ordering> for Sign {
    /// The sign of a difference, from how its terms compare.
    #[inline]
    fn from(order: std::cmp::Ordering) -> Self {
        match order {
            std::cmp::Ordering::Less => Self::Negative,
            std::cmp::Ordering::Equal => Self::Zero,
            std::cmp::Ordering::Greater => Self::Positive,
        }
    }
}
