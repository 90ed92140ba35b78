//! Places by their distances from the ends of a base edge, for where the tangent plane at the edge does
//! not reach as far: beside the tip of a cone, which is narrower than the triangle wanted.
//!
//! Levenberg's and Marquardt's method on the two distances, in the metric at each iterate. Where no
//! place is that far from both ends, as in a tip narrower than the edge, it gives the one that comes
//! nearest to it.

use super::chart::Sheet;
use crate::metric::FirstForm;
use crate::point::Point2;
use crate::vector::{Vector, dot, norm, sub};

/// Most iterates.
const STEPS: usize = 40;
/// Good enough: this fraction of the wanted distances.
const ENOUGH: f64 = 1e-3;
/// The damping at the start, and how it changes after steps that lead nearer or farther away.
const DAMPING: [f64; 3] = [1e-2, 0.3, 4.0];
/// No step of an iterate is longer than this fraction of the wanted distances.
const STRIDE: f64 = 0.5;

/// Points and how far from each the place should be.
pub(super) struct Distances {
    pub(super) ends: [Vector; 2],
    pub(super) wanted: [f64; 2],
    /// Bounds of the scaled parameters.
    pub(super) window: [Point2; 2],
}

impl Distances {
    /// The place nearest to the wanted distances that is found from scaled parameters beside the edge.
    pub(super) fn place(&self, sheet: &Sheet<'_>, start: Point2) -> Point2 {
        let mut at = self.clamped(start);
        let mut tangents = sheet.tangents(at);
        let mut misses = self.misses(tangents.point);
        let mut damping = DAMPING[0];
        for _ in 0..STEPS {
            if misses.iter().zip(self.wanted).all(|(miss, wanted)| miss.abs() <= ENOUGH * wanted) {
                break;
            }
            let step =
                self.step(&FirstForm::new(&tangents), self.slopes(&tangents), misses, damping);
            let next = self.clamped(Point2::new(at.x + step[0], at.y + step[1]));
            if next == at {
                break;
            }
            let there = sheet.tangents(next);
            let missed = self.misses(there.point);
            if square(missed) < square(misses) {
                (at, tangents, misses) = (next, there, missed);
                damping *= DAMPING[1];
            } else {
                damping *= DAMPING[2];
            }
        }
        at
    }

    fn clamped(&self, p: Point2) -> Point2 {
        let [low, high] = self.window;
        Point2::new(p.x.clamp(low.x, high.x), p.y.clamp(low.y, high.y))
    }

    fn misses(&self, p: Vector) -> [f64; 2] {
        std::array::from_fn(|i| norm(sub(p, self.ends[i])) - self.wanted[i])
    }

    /// The derivatives of the two distances by the parameters.
    fn slopes(&self, tangents: &crate::surface::Tangents) -> [[f64; 2]; 2] {
        self.ends.map(|end| {
            let arm = sub(tangents.point, end);
            let length = norm(arm).max(f64::MIN_POSITIVE);
            [dot(arm, tangents.u) / length, dot(arm, tangents.v) / length]
        })
    }

    /// (J'J + damping * first fundamental form) step = -J' misses, not longer than the stride.
    fn step(
        &self,
        form: &FirstForm,
        [a, b]: [[f64; 2]; 2],
        misses: [f64; 2],
        damping: f64,
    ) -> [f64; 2] {
        let FirstForm { e, f, g } = form;
        let m = [
            a[0] * a[0] + b[0] * b[0] + damping * e,
            a[0] * a[1] + b[0] * b[1] + damping * f,
            a[1] * a[1] + b[1] * b[1] + damping * g,
        ];
        let right = [0, 1].map(|i| -(a[i] * misses[0] + b[i] * misses[1]));
        let determinant = m[0] * m[2] - m[1] * m[1];
        let (u, v) = (
            (m[2] * right[0] - m[1] * right[1]) / determinant,
            (m[0] * right[1] - m[1] * right[0]) / determinant,
        );
        let length = (e * u * u + 2.0 * f * u * v + g * v * v).max(0.0).sqrt();
        let stride = STRIDE * (self.wanted[0] + self.wanted[1]);
        let part = if length > stride { stride / length } else { 1.0 };
        if u.is_finite() && v.is_finite() { [part * u, part * v] } else { [0.0; 2] }
    }
}

fn square([a, b]: [f64; 2]) -> f64 {
    a * a + b * b
}
