//! Curves: piecewise linear, B-spline and NURBS of any degree, arcs and circles.
//!
//! One representation serves all: control points, knots and weights. A piecewise linear curve has
//! degree 1; an arc is a rational quadratic (Piegl and Tiller, "The NURBS book", 1997, 7.3), so its
//! ends are exact. A curve of the plane has z = 0.

mod arc;
pub mod basis;
pub mod cut;
pub mod discretize;

use crate::vector::{Vector, add, along, key, scale, sub};
use basis::{Basis, DEGREE_MAX, NARROW, Table, WIDTH};

/// A curve.
///
/// # Shapes and units
/// `knots: [points + degree + 1]`, rising; the parameter runs from `knots[degree]` to
/// `knots[points]`. `weights` is empty (all 1) or one a control point.
///
/// ```
/// use trigrade::curve::Curve;
/// // A parabola: one quadratic piece, from its first control point to its last.
/// let points = vec![[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [2.0, 0.0, 0.0]];
/// let curve = Curve::clamped(2, points)?;
/// assert_eq!(curve.at(0.5), [1.0, 1.0, 0.0]);
/// assert_eq!(curve.ends(), [[0.0; 3], [2.0, 0.0, 0.0]]);
/// # Ok::<(), trigrade::curve::CurveError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    degree: usize,
    knots: Vec<f64>,
    points: Vec<Vector>,
    weights: Vec<f64>,
    closed: bool,
    table: Table,
}

/// A point of a curve with the derivatives there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveJet {
    /// The point.
    pub point: Vector,
    /// First derivative by the parameter.
    pub first: Vector,
    /// Second derivative by the parameter.
    pub second: Vector,
}

/// What is wrong with a curve.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CurveError {
    /// The degree is 0 or too large.
    #[error("the degree is {0}, but must be from 1 to {DEGREE_MAX}")]
    Degree(usize),
    /// There are too few control points for the degree.
    #[error("there are {points} control points, but a curve of degree {degree} needs at least {}", degree + 1)]
    TooFewPoints {
        /// How many there are.
        points: usize,
        /// The degree.
        degree: usize,
    },
    /// The number of knots does not fit.
    #[error("there are {found} knots, but {points} control points and degree {degree} need {}", points + degree + 1)]
    KnotCount {
        /// How many there are.
        found: usize,
        /// Number of control points.
        points: usize,
        /// The degree.
        degree: usize,
    },
    /// A knot is below the one before it.
    #[error("knot {index} is below the knot before it")]
    KnotOrder {
        /// Index of the knot.
        index: usize,
    },
    /// A knot is repeated more often than the degree, inside, so that the curve would come apart.
    #[error(
        "knot {value} is repeated {times} times inside, more often than the degree {degree}: the curve comes apart there"
    )]
    KnotRepeated {
        /// The knot.
        value: f64,
        /// How often.
        times: usize,
        /// The degree.
        degree: usize,
    },
    /// All knots are equal.
    #[error("the knots leave no parameters between the first and the last")]
    NoRange,
    /// The number of weights does not fit.
    #[error("there are {found} weights for {points} control points")]
    WeightCount {
        /// How many there are.
        found: usize,
        /// Number of control points.
        points: usize,
    },
    /// A weight is not positive and finite.
    #[error("weight {index} is {value}, but must be positive and finite")]
    Weight {
        /// Index of the weight.
        index: usize,
        /// What it is.
        value: f64,
    },
    /// A coordinate or knot is not finite.
    #[error("{what} {index} is not finite")]
    NotFinite {
        /// Control point or knot.
        what: &'static str,
        /// Its index.
        index: usize,
    },
    /// Three points that should give an arc lie on a line.
    #[error("the three points of the arc lie on a line")]
    NoArc,
    /// A circle without a radius or an axis.
    #[error(
        "the circle needs a normal, and a point that is not on the line through its centre along it"
    )]
    NoCircle,
}

impl Curve {
    /// A NURBS curve.
    ///
    /// # Errors
    /// [`CurveError`]: the first rule that the numbers break.
    pub fn new(
        degree: usize,
        knots: Vec<f64>,
        points: Vec<Vector>,
        weights: Vec<f64>,
    ) -> Result<Self, CurveError> {
        check_knots(degree, &knots, points.len())?;
        check_points(&points, &weights)?;
        let table = Table::new(&knots, degree, points.len());
        let mut curve = Self { degree, knots, points, weights, closed: false, table };
        let [start, end] = curve.domain();
        curve.closed = key(curve.at(start)) == key(curve.at(end)) && !curve.is_point();
        Ok(curve)
    }

    /// The piecewise linear curve through the points, with the parameter 0, 1, 2, ... at them.
    ///
    /// # Errors
    /// Fewer than two points, or one that is not finite.
    pub fn polyline(points: Vec<Vector>) -> Result<Self, CurveError> {
        let knots = clamped_knots(1, points.len());
        Self::new(1, knots, points, Vec::new())
    }

    /// The B-spline of these control points that starts in the first and ends in the last, with
    /// knots at 0, 1, 2, ...
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn clamped(degree: usize, points: Vec<Vector>) -> Result<Self, CurveError> {
        let knots = clamped_knots(degree, points.len());
        Self::new(degree, knots, points, Vec::new())
    }

    /// The closed B-spline of these control points, as smooth at its start as anywhere.
    ///
    /// # Errors
    /// As [`new`](Self::new); fewer than three points.
    pub fn periodic(degree: usize, mut points: Vec<Vector>) -> Result<Self, CurveError> {
        if points.len() < 3 {
            return Err(CurveError::TooFewPoints { points: points.len(), degree: degree.max(2) });
        }
        let count = points.len();
        points.extend_from_within(..degree.min(count));
        if points.len() < count + degree {
            return Err(CurveError::TooFewPoints { points: count, degree });
        }
        let knots = (0..=count + 2 * degree).map(|i| i as f64).collect();
        let mut curve = Self::new(degree, knots, points, Vec::new())?;
        curve.closed = true;
        Ok(curve)
    }

    /// Degree.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Knots.
    #[must_use]
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Control points.
    #[must_use]
    pub fn points(&self) -> &[Vector] {
        &self.points
    }

    /// Weights; empty when all are 1.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// First and last parameter.
    #[must_use]
    pub fn domain(&self) -> [f64; 2] {
        [self.knots[self.degree], self.knots[self.points.len()]]
    }

    /// First and last point: equal bits for a closed curve.
    #[must_use]
    pub fn ends(&self) -> [Vector; 2] {
        let [start, end] = self.domain();
        [self.at(start), self.at(end)]
    }

    /// Whether it ends where it starts.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Whether it is but a point: all control points are equal. The side of a patch that is
    /// collapsed to a pole is such a curve.
    #[must_use]
    pub fn is_point(&self) -> bool {
        self.points.iter().all(|&p| key(p) == key(self.points[0]))
    }

    /// The point at parameter `t`, which is taken into the domain.
    #[must_use]
    pub fn at(&self, t: f64) -> Vector {
        let [start, end] = self.domain();
        let t = if self.closed && t >= end { start } else { t.clamp(start, end) };
        let basis = self.basis::<1, WIDTH>(t);
        if let Some(i) = basis.rows[0][..=self.degree].iter().position(|&n| n == 1.0) {
            // No weight may disturb a point that is a control point.
            return self.points[basis.first + i];
        }
        self.sums(&basis).point()
    }

    /// The point at parameter `t` with two derivatives, from the right where they jump.
    #[must_use]
    pub fn jet(&self, t: f64) -> CurveJet {
        let [start, end] = self.domain();
        self.all_sums::<3>(t.clamp(start, end)).jet()
    }

    /// The point at parameter `t` and the first derivative, from the right where it jumps: the same
    /// as those of [`jet`](Self::jet), sooner.
    #[must_use]
    pub fn tangent(&self, t: f64) -> [Vector; 2] {
        let [start, end] = self.domain();
        let sums = self.all_sums::<2>(t.clamp(start, end));
        let point = sums.point();
        [point, sums.first(point)]
    }

    #[inline]
    fn all_sums<const N: usize>(&self, t: f64) -> Sums<N> {
        match self.table.at::<N>(t) {
            Some(basis) => self.sums(&basis),
            None if self.degree < NARROW => self.sums(&self.basis::<N, NARROW>(t)),
            None => self.sums(&self.basis::<N, WIDTH>(t)),
        }
    }

    #[inline]
    fn basis<const N: usize, const W: usize>(&self, t: f64) -> Basis<N, W> {
        Basis::at(&self.knots, self.degree, self.points.len(), t)
    }

    /// The parameters where the curve may have a corner: inner knots repeated `degree` times.
    #[must_use]
    pub fn corners(&self) -> Vec<f64> {
        corner_knots(&self.knots, self.degree, self.points.len())
    }

    /// The same curve from its end to its start.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let [start, end] = self.domain();
        let mut curve = self.clone();
        curve.points.reverse();
        curve.weights.reverse();
        curve.knots = self.knots.iter().rev().map(|&knot| start + (end - knot)).collect();
        curve.table = Table::new(&curve.knots, curve.degree, curve.points.len());
        curve
    }

    /// Whether the other curve is the same one, forwards (`false`) or backwards (`true`): equal to
    /// the bit in degree, control points and weights, with proportional knots.
    #[must_use]
    pub fn same_as(&self, other: &Self) -> Option<bool> {
        if self.is_alike(other) {
            return Some(false);
        }
        self.is_alike(&other.reversed()).then_some(true)
    }

    fn is_alike(&self, other: &Self) -> bool {
        let normal = |curve: &Self, i: usize| {
            let [start, end] = curve.domain();
            (curve.knots[i] - start) / (end - start)
        };
        // Knots of a reversed curve are rounded anew: within a few units in the last place.
        let close = |i: usize| (normal(self, i) - normal(other, i)).abs() <= 4.0 * f64::EPSILON;
        self.degree == other.degree
            && self.points.len() == other.points.len()
            && self.points.iter().zip(&other.points).all(|(p, q)| key(*p) == key(*q))
            && self.same_weights(other)
            && (0..self.knots.len()).all(close)
    }

    fn same_weights(&self, other: &Self) -> bool {
        (0..self.points.len()).all(|i| self.weight(i) == other.weight(i))
    }

    fn weight(&self, i: usize) -> f64 {
        self.weights.get(i).copied().unwrap_or(1.0)
    }

    /// Its image under an affine map.
    #[must_use]
    pub fn mapped(&self, map: impl Fn(Vector) -> Vector) -> Self {
        Self { points: self.points.iter().map(|&p| map(p)).collect(), ..self.clone() }
    }

    /// The pieces between its corners, each a curve of its own.
    #[must_use]
    pub fn pieces(&self) -> Vec<Self> {
        let cuts = cuts(&self.knots, self.degree, self.points.len());
        cuts.windows(2).map(|cut| self.piece(cut[0], cut[1])).collect()
    }

    /// The piece from control point `from` to control point `to`, at both of which the curve has
    /// corners or ends.
    fn piece(&self, from: usize, to: usize) -> Self {
        let weights =
            if self.weights.is_empty() { Vec::new() } else { self.weights[from..=to].to_vec() };
        let points = self.points[from..=to].to_vec();
        let knots = piece_knots(&self.knots, self.degree, from, to);
        let table = Table::new(&knots, self.degree, points.len());
        let mut piece = Self { degree: self.degree, knots, points, weights, closed: false, table };
        let [start, end] = piece.ends();
        piece.closed = key(start) == key(end) && !piece.is_point();
        piece
    }

    #[inline]
    fn sums<const N: usize, const W: usize>(&self, basis: &Basis<N, W>) -> Sums<N> {
        let mut sums = Sums { points: [[0.0; 3]; N], weights: [0.0; N] };
        if self.weights.is_empty() {
            let points = &self.points[basis.first..=basis.first + self.degree];
            // From the first of them: derivatives between equal points are then exactly 0.
            for (r, &point) in points.iter().enumerate().skip(1) {
                let arm = sub(point, points[0]);
                for order in 0..N {
                    sums.points[order] = along(sums.points[order], basis.rows[order][r], arm);
                }
            }
            sums.points[0] = add(points[0], sums.points[0]);
            sums.weights[0] = 1.0;
            return sums;
        }
        let range = basis.first..=basis.first + self.degree;
        let controls = self.points[range.clone()].iter().zip(&self.weights[range]);
        for (r, (&point, &weight)) in controls.enumerate() {
            for order in 0..N {
                let part = basis.rows[order][r] * weight;
                sums.points[order] = along(sums.points[order], part, point);
                sums.weights[order] += part;
            }
        }
        sums
    }
}

/// Weighted sums of control points, and of the weights alone, for N orders of derivatives.
struct Sums<const N: usize> {
    points: [Vector; N],
    weights: [f64; N],
}

impl<const N: usize> Sums<N> {
    #[inline]
    fn point(&self) -> Vector {
        scale(1.0 / self.weights[0], self.points[0])
    }

    /// The quotient rule.
    #[inline]
    fn first(&self, point: Vector) -> Vector {
        scale(1.0 / self.weights[0], sub(self.points[1], scale(self.weights[1], point)))
    }
}

impl Sums<3> {
    /// The quotient rule, once more.
    fn jet(&self) -> CurveJet {
        let [w, dw, ddw] = self.weights;
        let point = self.point();
        let first = self.first(point);
        let rest = add(scale(2.0 * dw, first), scale(ddw, point));
        CurveJet { point, first, second: scale(1.0 / w, sub(self.points[2], rest)) }
    }
}

impl CurveJet {
    /// Curvature: |C' x C''| / |C'|^3; 0 where the curve stands still.
    #[must_use]
    pub fn curvature(&self) -> f64 {
        let speed = crate::vector::norm(self.first);
        let bend = crate::vector::norm(crate::vector::cross(self.first, self.second));
        if speed > 0.0 { bend / (speed * speed * speed) } else { 0.0 }
    }
}

/// Knots 0, 0, ..., 1, 2, ..., n, n with the ends repeated degree + 1 times.
#[must_use]
pub fn clamped_knots(degree: usize, points: usize) -> Vec<f64> {
    let last = points.saturating_sub(degree);
    (0..=points + degree).map(|i| i.saturating_sub(degree).min(last) as f64).collect()
}

/// The rules for knots, which hold for curves and for either direction of a surface.
///
/// # Errors
/// The first rule that is broken.
pub fn check_knots(degree: usize, knots: &[f64], points: usize) -> Result<(), CurveError> {
    if degree == 0 || degree > DEGREE_MAX {
        return Err(CurveError::Degree(degree));
    }
    if points <= degree {
        return Err(CurveError::TooFewPoints { points, degree });
    }
    if knots.len() != points + degree + 1 {
        return Err(CurveError::KnotCount { found: knots.len(), points, degree });
    }
    if let Some(index) = knots.iter().position(|knot| !knot.is_finite()) {
        return Err(CurveError::NotFinite { what: "knot", index });
    }
    if let Some(before) = knots.windows(2).position(|pair| pair[1] < pair[0]) {
        return Err(CurveError::KnotOrder { index: before + 1 });
    }
    let (start, end) = (knots[degree], knots[points]);
    if start >= end || !(end - start).is_finite() {
        return Err(CurveError::NoRange);
    }
    for run in knots.chunk_by(|a, b| a == b).filter(|run| run[0] > start && run[0] < end) {
        if run.len() > degree {
            return Err(CurveError::KnotRepeated { value: run[0], times: run.len(), degree });
        }
    }
    Ok(())
}

/// The rules for control points and weights.
///
/// # Errors
/// The first rule that is broken.
pub fn check_points(points: &[Vector], weights: &[f64]) -> Result<(), CurveError> {
    if let Some(index) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(CurveError::NotFinite { what: "control point", index });
    }
    if !weights.is_empty() && weights.len() != points.len() {
        return Err(CurveError::WeightCount { found: weights.len(), points: points.len() });
    }
    match weights.iter().position(|w| !(w.is_finite() && *w > 0.0)) {
        Some(index) => Err(CurveError::Weight { index, value: weights[index] }),
        None => Ok(()),
    }
}

/// Inner knots repeated `degree` times.
#[must_use]
pub fn corner_knots(knots: &[f64], degree: usize, points: usize) -> Vec<f64> {
    let (start, end) = (knots[degree], knots[points]);
    knots
        .chunk_by(|a, b| a == b)
        .filter(|run| run.len() >= degree && run[0] > start && run[0] < end)
        .map(|run| run[0])
        .collect()
}

/// Indices of the control points at the two ends and at each corner between.
#[must_use]
pub fn cuts(knots: &[f64], degree: usize, points: usize) -> Vec<usize> {
    let mut cuts = vec![0];
    for corner in corner_knots(knots, degree, points) {
        // The run's first knot has index i: the point i - 1 is on the curve.
        cuts.push(knots.partition_point(|&knot| knot < corner) - 1);
    }
    cuts.push(points - 1);
    cuts
}

/// Knots of the piece between two cuts, clamped at cuts inside.
#[must_use]
pub fn piece_knots(knots: &[f64], degree: usize, from: usize, to: usize) -> Vec<f64> {
    let mut piece = knots[from..=to + degree + 1].to_vec();
    if from > 0 {
        piece[0] = piece[1];
    }
    let last = piece.len() - 1;
    if to + degree + 2 < knots.len() {
        piece[last] = piece[last - 1];
    }
    piece
}
