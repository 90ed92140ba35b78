//! Fans at corners where a long front edge meets a short one.
//!
//! The spacing beside a vertex cannot follow two boundary edges whose lengths differ by more than a
//! triangle can take; the angle between them must be spent on the way from one to the other. Equal
//! steps are best: k similar triangles with the angle alpha/k at the vertex and sides in the ratio
//! rho^(1/k), where rho is the ratio of the two edges. Their aspect ratio is the least worst one that
//! any mesh with this corner can have, if the angle is all there is.

use crate::point::Point2;

/// Corners with a smaller ratio of edge lengths are left to the front's own rules.
const RATIO_MIN: f64 = 2.2;
/// More triangles than this are never better: 64 of them in a full turn have angles below 6 degrees.
const TRIANGLES_MAX: u32 = 64;

/// A fan of similar triangles about a corner, from the long edge to the short one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fan {
    /// Number of triangles.
    pub(super) triangles: u32,
    /// Angle of each at the corner, in radians.
    angle: f64,
    /// Length of each side over the one before.
    ratio: f64,
}

impl Fan {
    /// The best fan for two edges of these lengths at an angle (radians); `None` when they match
    /// well enough, or when no fan of more than one triangle is better.
    pub(super) fn between(long: f64, short: f64, angle: f64) -> Option<Self> {
        let ratio = long / short;
        if !(ratio >= RATIO_MIN && ratio.is_finite()) {
            return None;
        }
        let fan = |k: u32| {
            let ratio = libm::exp2(-libm::log2(ratio) / f64::from(k));
            Self { triangles: k, angle: angle / f64::from(k), ratio }
        };
        let mut best = fan(1);
        for k in 2..=TRIANGLES_MAX {
            if fan(k).aspect() < best.aspect() {
                best = fan(k);
            }
        }
        (best.triangles > 1).then_some(best)
    }

    /// Aspect ratio R/(2r) of each triangle; infinite when it is none.
    pub(super) fn aspect(&self) -> f64 {
        if self.angle >= std::f64::consts::PI {
            return f64::INFINITY;
        }
        let (sine, cosine) = (libm::sin(self.angle), libm::cos(self.angle));
        let opposite = (1.0 + self.ratio * self.ratio - 2.0 * self.ratio * cosine).sqrt();
        let double_area = self.ratio * sine;
        let product = self.ratio * opposite;
        product * (1.0 + self.ratio + opposite) / (4.0 * double_area * double_area)
    }

    /// The end of the next side: `end` turned about `corner` by one angle, counterclockwise or
    /// clockwise, and drawn in.
    pub(super) fn next(&self, corner: Point2, end: Point2, counterclockwise: bool) -> Point2 {
        let (sine, cosine) = (libm::sin(self.angle), libm::cos(self.angle));
        let sine = if counterclockwise { sine } else { -sine };
        let (x, y) = (self.ratio * (end.x - corner.x), self.ratio * (end.y - corner.y));
        Point2::new(corner.x + cosine * x - sine * y, corner.y + sine * x + cosine * y)
    }
}

/// Angle at `corner` from `from` counterclockwise to `to`, in (0, 2 pi].
pub(super) fn angle(corner: Point2, from: Point2, to: Point2) -> f64 {
    let (ux, uy) = (from.x - corner.x, from.y - corner.y);
    let (vx, vy) = (to.x - corner.x, to.y - corner.y);
    let turn = libm::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
    if turn > 0.0 { turn } else { turn + std::f64::consts::TAU }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    // spec: F9
    #[test]
    fn equal_fans_reach_the_known_aspect_ratios() {
        for (turn, aspect) in [(PI, 4.81), (FRAC_PI_2, 16.1)] {
            let fan = Fan::between(1000.0, 1.0, turn).expect("a ratio of 1000 needs a fan");
            assert!((fan.aspect() / aspect - 1.0).abs() < 0.02, "{turn}: {fan:?} {}", fan.aspect());
        }
    }

    // spec: F9
    #[test]
    fn edges_that_match_need_no_fan() {
        for (long, short, turn) in [(1.0, 1.0, PI), (2.0, 1.0, PI), (1.0, 0.0, PI), (3.0, 1.0, 0.2)]
        {
            assert_eq!(Fan::between(long, short, turn), None, "{long} : {short} at {turn}");
        }
    }

    // spec: F9
    #[test]
    fn the_last_side_of_a_fan_meets_the_short_edge() {
        let (corner, long, short) =
            (Point2::new(1.0, 2.0), Point2::new(9.0, 2.0), Point2::new(1.0, 2.5));
        for (turn, ccw) in [(FRAC_PI_2, true), (3.0 * FRAC_PI_2, false)] {
            let fan = Fan::between(8.0, 0.5, turn).expect("a ratio of 16 needs a fan");
            let end = (0..fan.triangles).fold(long, |end, _| fan.next(corner, end, ccw));
            assert!(end.distance(short) < 1e-12, "{end}");
        }
    }

    #[test]
    fn angles_go_once_around() {
        let o = Point2::new(0.0, 0.0);
        let (east, north, west) =
            (Point2::new(1.0, 0.0), Point2::new(0.0, 2.0), Point2::new(-1.0, 0.0));
        assert_eq!(angle(o, east, north), FRAC_PI_2);
        assert_eq!(angle(o, north, east), 3.0 * FRAC_PI_2);
        assert_eq!(angle(o, east, west), PI);
        assert_eq!(angle(o, east, east), 2.0 * PI);
    }
}
