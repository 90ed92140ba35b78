//! Arcs and circles as rational quadratics: a piece for each quarter turn or less, whose middle
//! control point lies where the tangents meet and has the cosine of half its angle as weight.

use super::{Curve, CurveError};
use crate::vector::{Vector, add, along, cross, dot, norm, norm_sq, scale, sub, unit};
use std::f64::consts::{FRAC_PI_2, TAU};

impl Curve {
    /// The arc of a circle from one point through another to a third; its ends are exact. The
    /// parameter runs from 0 to 1.
    ///
    /// # Errors
    /// [`CurveError::NoArc`] when the points lie on a line.
    pub fn arc(from: Vector, via: Vector, to: Vector) -> Result<Self, CurveError> {
        let (u, w) = (sub(via, from), sub(to, from));
        let normal = cross(u, w);
        let area_sq = norm_sq(normal);
        let centre = add(
            from,
            scale(
                0.5 / area_sq,
                add(scale(norm_sq(u), cross(w, normal)), scale(norm_sq(w), cross(normal, u))),
            ),
        );
        let normal = unit(normal).filter(|_| centre.iter().all(|x| x.is_finite()));
        let normal = normal.ok_or(CurveError::NoArc)?;
        let (start, end) = (sub(from, centre), sub(to, centre));
        let angle = libm::atan2(dot(normal, cross(start, end)), dot(start, end));
        let angle = if angle > 0.0 { angle } else { angle + TAU };
        Self::turn(centre, normal, start, angle, from, to)
    }

    /// The circle about `centre` in the plane across `normal`, counterclockwise about it, that
    /// starts and ends in `from`. The parameter runs from 0 to 1.
    ///
    /// # Errors
    /// [`CurveError::NoCircle`] when it has no radius or no plane.
    pub fn circle(centre: Vector, normal: Vector, from: Vector) -> Result<Self, CurveError> {
        let normal = unit(normal).ok_or(CurveError::NoCircle)?;
        let arm = sub(from, centre);
        let height = dot(arm, normal);
        let centre = along(centre, height, normal);
        let start = sub(from, centre);
        if !(norm(start) > 0.0 && norm(start).is_finite()) {
            return Err(CurveError::NoCircle);
        }
        Self::turn(centre, normal, start, TAU, from, from)
    }

    fn turn(
        centre: Vector,
        normal: Vector,
        start: Vector,
        angle: f64,
        from: Vector,
        to: Vector,
    ) -> Result<Self, CurveError> {
        let pieces = (libm::ceil(angle / FRAC_PI_2 - 1e-9) as usize).max(1);
        let half = angle / (2.0 * pieces as f64);
        let across = cross(normal, start);
        let spoke = |i: usize, reach: f64| {
            let turn = half * i as f64;
            let arm = add(scale(libm::cos(turn), start), scale(libm::sin(turn), across));
            along(centre, reach, arm)
        };
        let mut points: Vec<Vector> = (0..=2 * pieces)
            .map(|i| spoke(i, if i % 2 == 1 { 1.0 / libm::cos(half) } else { 1.0 }))
            .collect();
        (points[0], points[2 * pieces]) = (from, to);
        let weights = (0..=2 * pieces).map(|i| if i % 2 == 1 { libm::cos(half) } else { 1.0 });
        let weights = weights.collect();
        let inner = (1..pieces).flat_map(|i| [i as f64 / pieces as f64; 2]);
        let knots = [0.0; 3].into_iter().chain(inner).chain([1.0; 3]).collect();
        Self::new(2, knots, points, weights)
    }
}
