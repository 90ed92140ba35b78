//! What is wrong with a triangle, and where a point would mend it.
//!
//! Floats measure; they decide which triangles are mended and where, never whether a mesh is valid.
//! Each comparison has room for its rounding on one side: a triangle passes only if its area
//! certainly is not above the bound and its smallest angle certainly not below.

use super::queue::Urgency;
use crate::point::Point2;

/// What a triangle may be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// The square of the sine of the least angle, a little raised; 0 without a bound.
    sine_sq: f64,
    /// Distance of the off-centre from the shortest edge, over that edge's length.
    off_centre: f64,
    /// The square of the cosine of the angle under which an edge is encroached upon.
    lens: f64,
}

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Flaw {
    pub(super) urgency: Urgency,
    pub(super) has_small_angle: bool,
    pub(super) is_too_large: bool,
}

/// Roundings of `det` relative to the products in it: 4u, as in the predicates' filter.
const AREA_ERROR: f64 = 2.0 * f64::EPSILON;
/// Room for the roundings of squares and products: a hundred of them.
const ROOM: f64 = 100.0 * f64::EPSILON;
/// The off-centre is this much nearer to the shortest edge than the point that makes an angle of
/// just the bound there, so that rounding cannot bring the triangle back (Shewchuk's Triangle).
const NEARER: f64 = 0.95;
/// Without a bound on angles edges are guarded as if for this one, in degrees.
const GUARDED_DEG: f64 = 30.0;

impl Bounds {
    /// For a least angle in degrees; 0 is none.
    pub(super) fn new(angle_min_deg: f64) -> Self {
        let radians = |deg: f64| deg * (std::f64::consts::PI / 180.0);
        let (sine, cosine) = (libm::sin(radians(angle_min_deg)), libm::cos(radians(angle_min_deg)));
        let guarded = if angle_min_deg > 0.0 { angle_min_deg } else { GUARDED_DEG };
        let lens = libm::cos(radians(2.0 * guarded));
        Self {
            sine_sq: sine * sine * (1.0 + ROOM),
            // An isosceles triangle with the angle a at the apex is cot(a/2)/2 times as high as wide.
            off_centre: 0.5 * NEARER * ((1.0 + cosine) / (1.0 - cosine)).sqrt(),
            lens: lens * lens,
        }
    }

    /// What is wrong with a triangle whose doubled area may be at most `doubled_max`.
    #[inline]
    pub(super) fn flaw(&self, corners: [Point2; 3], doubled_max: f64) -> Option<Flaw> {
        let Measures { doubled, error, squares: [shortest, middle, longest] } = measure(corners);
        let has_small_angle =
            self.sine_sq > 0.0 && doubled * doubled < self.sine_sq * middle * longest;
        let is_too_large = doubled + error > doubled_max;
        if !has_small_angle && !is_too_large {
            return None;
        }
        let urgency = if has_small_angle {
            Urgency::of_angle(shortest)
        } else {
            Urgency::of_area(doubled / doubled_max)
        };
        Some(Flaw { urgency, has_small_angle, is_too_large })
    }

    /// Whether `p` sees the edge `a b` under too wide an angle, which no good triangle has.
    #[inline]
    pub(super) fn encroaches(&self, [a, b]: [Point2; 2], p: Point2) -> bool {
        let (ax, ay, bx, by) = (a.x - p.x, a.y - p.y, b.x - p.x, b.y - p.y);
        let dot = ax * bx + ay * by;
        dot < 0.0 && dot * dot >= self.lens * (ax * ax + ay * ay) * (bx * bx + by * by)
    }

    /// The point that mends a triangle: its circumcentre, or the off-centre on the bisector of the
    /// shortest edge where that is nearer (Üngör, Off-centers: a new type of Steiner points for
    /// computing size-optimal quality-guaranteed Delaunay triangulations, 2009).
    pub(super) fn centre(&self, corners: [Point2; 3], has_small_angle: bool) -> Point2 {
        let [a, b, c] = from_shortest(corners);
        let (dx, dy, ex, ey) = (b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
        let (dd, ee) = (dx * dx + dy * dy, ex * ex + ey * ey);
        let scale = 0.5 / (dx * ey - dy * ex);
        let (ux, uy) = ((ey * dd - dy * ee) * scale, (dx * ee - ex * dd) * scale);
        let height = (uy * dx - ux * dy) / dd;
        if has_small_angle && height > self.off_centre {
            let k = self.off_centre;
            return Point2::new(a.x + (0.5 * dx - k * dy), a.y + (0.5 * dy + k * dx));
        }
        Point2::new(a.x + ux, a.y + uy)
    }
}

struct Measures {
    /// Twice the area.
    doubled: f64,
    /// Bound of its rounding error.
    error: f64,
    /// Squared lengths of the sides, ascending.
    squares: [f64; 3],
}

#[inline]
fn measure([a, b, c]: [Point2; 3]) -> Measures {
    let (ux, uy, vx, vy) = (b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
    let (wx, wy) = (c.x - b.x, c.y - b.y);
    let (left, right) = (ux * vy, uy * vx);
    let (uu, vv, ww) = (ux * ux + uy * uy, vx * vx + vy * vy, wx * wx + wy * wy);
    let (low, high) = (uu.min(vv), uu.max(vv));
    let squares = [low.min(ww), low.max(high.min(ww)), high.max(ww)];
    let error = AREA_ERROR * (left.abs() + right.abs()) + f64::MIN_POSITIVE;
    Measures { doubled: left - right, error, squares }
}

/// The corners from the start of the shortest side on.
fn from_shortest(corners: [Point2; 3]) -> [Point2; 3] {
    let first = shortest_side(corners);
    [0, 1, 2].map(|i| corners[(first + i) % 3])
}

/// Corner from which the shortest side starts.
pub(super) fn shortest_side([a, b, c]: [Point2; 3]) -> usize {
    let (ab, bc, ca) = (a.distance_sq(b), b.distance_sq(c), c.distance_sq(a));
    if ab <= bc && ab <= ca {
        0
    } else if bc <= ca {
        1
    } else {
        2
    }
}

/// The smallest angle in degrees.
pub(super) fn smallest_angle_deg(corners: [Point2; 3]) -> f64 {
    let Measures { doubled, squares: [_, middle, longest], .. } = measure(corners);
    let sine = doubled / (middle.sqrt() * longest.sqrt());
    libm::asin(sine.clamp(0.0, 1.0)) * (180.0 / std::f64::consts::PI)
}

/// The mean of the corners.
pub(super) fn centroid([a, b, c]: [Point2; 3]) -> Point2 {
    const THIRD: f64 = 1.0 / 3.0;
    // From one corner, so that it stays near them however far away the origin is.
    Point2::new(
        a.x + ((b.x - a.x) + (c.x - a.x)) * THIRD,
        a.y + ((b.y - a.y) + (c.y - a.y)) * THIRD,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::predicates::{PointInTriangle, point_in_triangle};

    fn triangle(coordinates: [[f64; 2]; 3]) -> [Point2; 3] {
        coordinates.map(Point2::from)
    }

    fn is_flawed(angle: f64, doubled_max: f64, corners: [Point2; 3]) -> [bool; 2] {
        let flaw = Bounds::new(angle).flaw(corners, doubled_max);
        flaw.map_or([false; 2], |f| [f.has_small_angle, f.is_too_large])
    }

    #[test]
    fn flaws_are_seen_and_nothing_else() {
        let right = triangle([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(is_flawed(0.0, f64::INFINITY, right), [false, false]);
        assert_eq!(is_flawed(44.9, f64::INFINITY, right), [false, false]);
        assert_eq!(is_flawed(45.1, f64::INFINITY, right), [true, false]);
        assert_eq!(is_flawed(0.0, 0.99, right), [false, true]);
        assert_eq!(is_flawed(45.1, 0.99, right), [true, true]);
        // On the bound itself rounding could hide a larger area, so it is mended.
        assert_eq!(is_flawed(0.0, 1.0, right), [false, true]);
        assert_eq!(is_flawed(0.0, 1.0 + 1e-14, right), [false, false]);
    }

    #[test]
    fn angles_are_those_of_the_corners() {
        let half = 3.0_f64.sqrt() / 2.0;
        let cases = [
            ([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], 45.0),
            ([[0.0, 0.0], [1.0, 0.0], [0.5, half]], 60.0),
            ([[0.0, 0.0], [1.0, 0.0], [0.5, half / 3.0]], 30.0),
        ];
        for (corners, angle) in cases {
            for turn in 0..3 {
                let mut corners = triangle(corners);
                corners.rotate_left(turn);
                assert!((smallest_angle_deg(corners) - angle).abs() < 1e-9, "{corners:?}");
            }
        }
    }

    #[test]
    fn the_circumcentre_is_as_far_from_all_corners() {
        let corners = triangle([[3.0, 1.0], [4.5, 1.25], [3.5, 2.5]]);
        let centre = Bounds::new(0.0).centre(corners, false);
        let radii = corners.map(|p| p.distance(centre));
        assert!((radii[0] - radii[1]).abs() < 1e-14 && (radii[0] - radii[2]).abs() < 1e-14);
    }

    #[test]
    fn the_off_centre_makes_an_angle_just_above_the_bound() {
        let corners = triangle([[0.0, 0.0], [0.01, 0.0], [0.005, 1.0]]);
        for angle in [5.0, 20.0, 25.0, 30.0] {
            let bounds = Bounds::new(angle);
            let p = bounds.centre(corners, true);
            let made = smallest_angle_deg([corners[0], corners[1], p]);
            assert!(made > angle && made < 1.06 * angle, "{angle}: {made}");
            // Rotated corners give the same point.
            assert_eq!(p, bounds.centre([corners[1], corners[2], corners[0]], true));
        }
        let p = Bounds::new(1e-3).centre(corners, true);
        assert_eq!(p, Bounds::new(0.0).centre(corners, false), "the circumcentre is nearer");
    }

    #[test]
    fn a_lens_is_the_points_that_see_the_edge_under_a_wide_angle() {
        let edge = triangle([[-1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]);
        let edge = [edge[0], edge[1]];
        let bounds = Bounds::new(30.0);
        let height = 1.0 / 3.0_f64.sqrt(); // an angle of 120 degrees
        assert!(bounds.encroaches(edge, Point2::new(0.0, 0.999 * height)));
        assert!(!bounds.encroaches(edge, Point2::new(0.0, 1.001 * height)));
        assert!(bounds.encroaches(edge, Point2::new(0.0, -0.5 * height)));
        assert!(!bounds.encroaches(edge, Point2::new(2.0, 0.0)));
    }

    #[test]
    fn the_centroid_is_inside() {
        let corners = triangle([[1e6, 1e6], [1e6 + 1e-3, 1e6], [1e6, 1e6 + 1e-3]]);
        let p = centroid(corners);
        assert!(matches!(point_in_triangle(p, corners), PointInTriangle::Inside));
    }
}
