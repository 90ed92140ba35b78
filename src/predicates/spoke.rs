//! Predicates about one point and many others around it, when what depends on fewer than all of them
//! is computed once: the same filters in pieces, with the same rungs behind them.

use super::filter::{self, INCIRCLE_ERROR, ORIENT2D_ERROR, UNDERFLOW};
use super::{Sign, ladder, perturbed};
use crate::point::Point2;

/// A point as seen from another one, the *centre*: rounded differences, and the sum of their squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spoke {
    /// Difference of the abscissas.
    pub x: f64,
    /// Difference of the ordinates.
    pub y: f64,
    /// Squared distance, rounded.
    pub square: f64,
}

impl Spoke {
    /// From the centre to a point.
    #[inline(always)]
    #[must_use]
    pub fn new(centre: Point2, to: Point2) -> Self {
        let (x, y) = (to.x - centre.x, to.y - centre.y);
        Self { x, y, square: x * x + y * y }
    }

    /// The cross product with another spoke of the same centre.
    #[inline(always)]
    #[must_use]
    pub fn cross(self, other: Self) -> Cross {
        let (left, right) = (self.x * other.y, self.y * other.x);
        Cross { value: left - right, size: left.abs() + right.abs() }
    }
}

/// The cross product of two spokes: that of the triangle which the centre makes with their ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cross {
    /// Rounded; it ranks.
    pub value: f64,
    /// Sum of the sizes of its terms, to which its error is proportional.
    size: f64,
}

impl Cross {
    /// That of the spokes exchanged.
    #[inline(always)]
    #[must_use]
    pub fn reversed(self) -> Self {
        Self { value: -self.value, size: self.size }
    }

    /// [`orient2d`](super::orient2d) of the spokes' ends and the centre; `points` gives these three.
    ///
    /// **Guarantees** P1.
    #[inline(always)]
    #[must_use]
    pub fn orientation(self, points: impl FnOnce() -> [Point2; 3]) -> Sign {
        let bound = ORIENT2D_ERROR * self.size + UNDERFLOW;
        filter::decide(self.value, bound).unwrap_or_else(|| {
            let [a, b, centre] = points();
            ladder::orient2d_unfiltered(a, b, centre).0
        })
    }
}

/// [`incircle_perturbed`](super::incircle_perturbed) of the ends of three spokes and their centre,
/// given the cross products of the second and third, third and first, first and second spoke;
/// `points` gives the four points.
///
/// **Guarantees** P2, P6.
#[inline(always)]
#[must_use]
pub fn centre_in_circle(
    [a, b, c]: [&Spoke; 3],
    [bc, ca, ab]: [Cross; 3],
    points: impl FnOnce() -> [Point2; 4],
) -> Sign {
    let det = a.square * bc.value + b.square * ca.value + c.square * ab.value;
    let permanent = a.square * bc.size + b.square * ca.size + c.square * ab.size;
    let underflow = UNDERFLOW * (a.square + b.square + c.square + 1.0);
    filter::decide(det, INCIRCLE_ERROR * permanent + underflow).unwrap_or_else(|| {
        let [a, b, c, centre] = points();
        perturbed::unfiltered(a, b, c, centre)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::predicates::{incircle_perturbed, orient2d};

    /// Points of a small lattice, scaled and moved so that differences round.
    fn lattice(scale: f64, offset: f64) -> Vec<Point2> {
        let at = |k: i32| f64::from(k) * scale + offset;
        (0..9).map(|k| Point2::new(at(k % 3), at(k / 3))).collect()
    }

    fn both(p: Point2, [a, b, c]: [Point2; 3]) -> [Sign; 2] {
        let [u, v, w] = [a, b, c].map(|q| Spoke::new(p, q));
        let crosses = [v.cross(w), w.cross(u), u.cross(v)];
        let inside = centre_in_circle([&u, &v, &w], crosses, || [a, b, c, p]);
        [u.cross(v).orientation(|| [a, b, p]), inside]
    }

    // spec: P1 P2 P6
    #[test]
    fn in_pieces_the_predicates_say_what_they_say_as_a_whole() {
        for (scale, offset) in [(1.0, 0.0), (0.1, 1e3), (1e-310, 0.0), (1e300, -1e300)] {
            let points = lattice(scale, offset);
            for i in 0..9 * 9 * 9 * 9 {
                let [p, a, b, c] = [729, 81, 9, 1].map(|place| points[i / place % 9]);
                let whole = [orient2d(a, b, p), incircle_perturbed(a, b, c, p)];
                assert_eq!(both(p, [a, b, c]), whole, "{p} {a} {b} {c}");
            }
        }
    }

    // spec: P1
    #[test]
    fn exchanged_spokes_have_the_other_sign() {
        let (o, points) = (Point2::new(0.1, 0.2), lattice(0.1, 0.0));
        for &a in &points {
            for &b in &points {
                let cross = Spoke::new(o, a).cross(Spoke::new(o, b));
                let sign = cross.orientation(|| [a, b, o]);
                assert_eq!(cross.reversed().orientation(|| [b, a, o]), sign.reversed());
            }
        }
    }
}
