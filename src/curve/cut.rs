//! Parts of curves: knots are inserted until the ends of the part are control points (Boehm, "Inserting
//! new knots into B-spline curves", 1980; Piegl and Tiller, "The NURBS book", 1997, 5.2).

use super::{Curve, CurveError};
use crate::vector::Vector;

/// A control point with its weight: (w x, w y, w z, w).
pub type Weighted = [f64; 4];

/// Puts a weight to a point.
#[must_use]
pub fn weighted([x, y, z]: Vector, w: f64) -> Weighted {
    [w * x, w * y, w * z, w]
}

/// The point of a weighted one.
#[must_use]
pub fn projected([x, y, z, w]: Weighted) -> Vector {
    [x / w, y / w, z / w]
}

/// Inserts a knot within the domain once.
fn insert(degree: usize, knots: &mut Vec<f64>, points: &mut Vec<Weighted>, t: f64) {
    // t lies in [knots[k], knots[k + 1]).
    let k = knots.partition_point(|&knot| knot <= t) - 1;
    let mut new = points.clone();
    new.insert(k.min(points.len()), points[k.min(points.len() - 1)]);
    for i in k + 1 - degree..=k {
        if i >= points.len() {
            break;
        }
        let span = knots[i + degree] - knots[i];
        let part = if span > 0.0 { (t - knots[i]) / span } else { 0.0 };
        new[i] = std::array::from_fn(|c| (1.0 - part) * points[i - 1][c] + part * points[i][c]);
    }
    *points = new;
    knots.insert(k + 1, t);
}

/// The B-spline between two parameters of its domain, clamped at both.
#[must_use]
pub fn between(
    degree: usize,
    knots: &[f64],
    points: &[Weighted],
    [from, to]: [f64; 2],
) -> (Vec<f64>, Vec<Weighted>) {
    let (mut knots, mut points) = (knots.to_vec(), points.to_vec());
    for t in [from, to] {
        let times = knots.iter().filter(|&&knot| knot == t).count();
        for _ in times..degree {
            insert(degree, &mut knots, &mut points, t);
        }
    }
    // The control point before the last of the knots at `from` lies on the curve there.
    let first = knots.partition_point(|&knot| knot <= from) - 1 - degree;
    let last = knots.partition_point(|&knot| knot < to) - 1;
    let inner = knots.iter().copied().filter(|&knot| knot > from && knot < to);
    let clamp = |t: f64| std::iter::repeat_n(t, degree + 1);
    let clamped = clamp(from).chain(inner).chain(clamp(to)).collect();
    (clamped, points[first..=last].to_vec())
}

impl Curve {
    /// The part between two rising parameters of the domain, clamped at both.
    ///
    /// # Errors
    /// [`CurveError::NoRange`] when there is nothing between them.
    pub fn part(&self, [from, to]: [f64; 2]) -> Result<Self, CurveError> {
        let [start, end] = self.domain();
        let range = [from.max(start), to.min(end)];
        if from.is_nan() || to.is_nan() || range[0] >= range[1] {
            return Err(CurveError::NoRange);
        }
        let points: Vec<Weighted> =
            (0..self.points.len()).map(|i| weighted(self.points[i], self.weight(i))).collect();
        let (knots, points) = between(self.degree, &self.knots, &points, range);
        let weights = match self.weights.is_empty() {
            true => Vec::new(),
            false => points.iter().map(|p| p[3]).collect(),
        };
        let points = points.into_iter().map(projected).collect();
        Self::new(self.degree, knots, points, weights)
    }

    /// The same curve with other ends, where its ends are control points.
    #[must_use]
    pub fn with_ends(&self, ends: [Vector; 2]) -> Self {
        let last = self.points.len() - 1;
        let is_clamped =
            |at: Vector, i: usize| crate::vector::key(at) == crate::vector::key(self.points[i]);
        let found = self.ends();
        let mut points = self.points.clone();
        if is_clamped(found[0], 0) {
            points[0] = ends[0];
        }
        if is_clamped(found[1], last) {
            points[last] = ends[1];
        }
        Self::new(self.degree, self.knots.clone(), points, self.weights.clone())
            .unwrap_or_else(|_| self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::distance;

    fn wave(rational: bool) -> Curve {
        let points: Vec<Vector> =
            (0..7).map(|i| [f64::from(i), f64::from(i * i % 5), f64::from(i % 3)]).collect();
        let weights = if rational { vec![1.0, 2.0, 0.5, 1.0, 3.0, 1.0, 1.0] } else { Vec::new() };
        let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 4.0, 4.0, 4.0, 4.0];
        Curve::new(3, knots, points, weights).expect("a curve")
    }

    // spec: S1
    #[test]
    fn a_part_is_the_same_curve_between_its_ends() {
        for curve in [
            wave(false),
            wave(true),
            Curve::periodic(3, wave(false).points().to_vec()).expect("closed"),
        ] {
            let [start, end] = curve.domain();
            for [a, b] in [[0.0, 1.0], [0.1, 0.7], [0.25, 1.0], [0.5, 0.55], [0.0, 0.5]] {
                let range = [a, b].map(|part: f64| start + part * (end - start));
                let part = curve.part(range).expect("a part");
                assert_eq!(part.domain(), range);
                for i in 0..=20 {
                    let t = range[0] + f64::from(i) / 20.0 * (range[1] - range[0]);
                    let gap = distance(part.jet(t).point, curve.jet(t).point);
                    assert!(gap < 1e-13, "{range:?} {t}: {gap}");
                }
            }
        }
    }

    // spec: S1
    #[test]
    fn there_is_no_part_without_a_range() {
        for range in [[1.0, 1.0], [2.0, 1.0], [5.0, 6.0], [f64::NAN, 1.0]] {
            assert_eq!(wave(true).part(range), Err(CurveError::NoRange), "{range:?}");
        }
    }

    // spec: S1
    #[test]
    fn ends_move_only_where_they_are_control_points() {
        let moved = wave(false).with_ends([[0.0, 0.0, 1.0], [6.0, 1.0, 1.0]]);
        assert_eq!(moved.ends(), [[0.0, 0.0, 1.0], [6.0, 1.0, 1.0]]);
        let closed = Curve::periodic(2, wave(false).points().to_vec()).expect("closed");
        assert_eq!(closed.with_ends([[9.0; 3]; 2]).ends(), closed.ends());
    }
}
