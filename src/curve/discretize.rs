//! Nodes along a curve: by spacing, by count, by chord error, graded, or by any spacing function.
//!
//! Every rule is a wanted spacing h at each point. The curve's corners are always nodes; the piece
//! between two of them gets n = round(integral of ds / h) edges, at equal parts of the integral. For
//! a constant h those are equal parts of the arc length.

use super::{Curve, CurveJet};
use crate::vector::{Vector, distance, norm, segment_distance_sq};

/// What is cut into edges: a curve of any kind by its parameter.
pub trait Track {
    /// First and last parameter.
    fn domain(&self) -> [f64; 2];
    /// Point and derivatives.
    fn jet(&self, t: f64) -> CurveJet;
    /// Parameters between which it is smooth enough for Gauss's rule.
    fn knots(&self) -> &[f64];
    /// Parameters of its corners.
    fn corners(&self) -> Vec<f64>;
    /// Whether it ends where it starts.
    fn is_closed(&self) -> bool;
    /// The point at a parameter.
    fn at(&self, t: f64) -> Vector {
        self.jet(t).point
    }
}

impl Track for Curve {
    fn domain(&self) -> [f64; 2] {
        self.domain()
    }

    fn jet(&self, t: f64) -> CurveJet {
        self.jet(t)
    }

    fn knots(&self) -> &[f64] {
        self.knots()
    }

    fn corners(&self) -> Vec<f64> {
        self.corners()
    }

    fn is_closed(&self) -> bool {
        self.is_closed()
    }

    fn at(&self, t: f64) -> Vector {
        self.at(t)
    }
}

/// How many edges a curve is given, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    /// The corners alone: the given points of a piecewise linear curve.
    Corners,
    /// This many edges of equal arc length, shared among the pieces between corners by length.
    Count(usize),
    /// Edges of about this length.
    Spacing(f64),
    /// Edges that leave the curve by at most this, and are at most this fraction of its length: 1/8.
    ChordError(f64),
    /// Spacing that changes linearly along the curve, from the first length to the second.
    Graded(f64, f64),
}

/// Most edges on one curve: a guard against a spacing given in the wrong unit.
pub const EDGES_MAX: usize = 10_000_000;

/// Why a curve has no nodes.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DiscretizeError {
    /// A length that is not positive and finite, or a count of 0.
    #[error("{what} is {value}, but must be positive and finite")]
    NotPositive {
        /// What the number is.
        what: &'static str,
        /// What was given.
        value: f64,
    },
    /// More edges than anybody can want.
    #[error("the curve would have {0:.3e} edges, more than {EDGES_MAX}")]
    TooMany(f64),
    /// The curve is a point.
    #[error("the curve has no length")]
    NoLength,
}

/// Parameters of the nodes along a curve, from its first to its last.
///
/// # Errors
/// See [`DiscretizeError`].
///
/// # Complexity
/// Linear in the number of knots and nodes.
pub fn nodes(curve: &impl Track, rule: Rule) -> Result<Vec<f64>, DiscretizeError> {
    check(rule)?;
    match rule {
        Rule::Corners => Ok(breaks(curve)),
        Rule::Count(count) => by_count(curve, count),
        Rule::Spacing(h) => by_spacing(curve, |_, _| h),
        Rule::ChordError(error) => by_chord_error(curve, error),
        Rule::Graded(from, to) => {
            let total = length(curve);
            by_spacing(curve, |_, way| from + (to - from) * (way / total).clamp(0.0, 1.0))
        }
    }
}

fn check(rule: Rule) -> Result<(), DiscretizeError> {
    let demand = |what, value: f64| {
        let holds = value > 0.0 && value.is_finite();
        if holds { Ok(()) } else { Err(DiscretizeError::NotPositive { what, value }) }
    };
    match rule {
        Rule::Corners => Ok(()),
        Rule::Count(count) if count > EDGES_MAX => Err(DiscretizeError::TooMany(count as f64)),
        Rule::Count(count) => demand("the count", count as f64),
        Rule::Spacing(h) => demand("the spacing", h),
        Rule::ChordError(error) => demand("the chord error", error),
        Rule::Graded(from, to) => demand("the spacing", from).and(demand("the spacing", to)),
    }
}

/// Parameters of the nodes for a spacing that depends on the point's derivatives and on the length
/// of the way to it.
///
/// # Errors
/// [`DiscretizeError::TooMany`], [`DiscretizeError::NoLength`].
pub fn by_spacing(
    curve: &impl Track,
    spacing: impl Fn(&CurveJet, f64) -> f64,
) -> Result<Vec<f64>, DiscretizeError> {
    let mut way = 0.0;
    let mut all = Vec::new();
    for piece in breaks(curve).windows(2) {
        let table = Table::new(curve, piece[0], piece[1], way, &spacing);
        way = table.way;
        let count = edges(curve, piece, table.total())?;
        all.extend(table.parts(curve, count, &spacing));
    }
    all.push(curve.domain()[1]);
    Ok(all)
}

/// The same with this many edges in all, at equal parts of the integral; for curves without corners.
///
/// # Errors
/// [`DiscretizeError::TooMany`], [`DiscretizeError::NoLength`].
pub fn by_count_and_spacing(
    curve: &impl Track,
    count: usize,
    spacing: impl Fn(&CurveJet, f64) -> f64,
) -> Result<Vec<f64>, DiscretizeError> {
    check(Rule::Count(count))?;
    let [start, end] = curve.domain();
    let table = Table::new(curve, start, end, 0.0, &spacing);
    edges(curve, &[start, end], table.total())?;
    let mut all = table.parts(curve, count, &spacing);
    all.push(end);
    Ok(all)
}

/// Number of edges of a piece that asks for this many.
fn edges(curve: &impl Track, piece: &[f64], wanted: f64) -> Result<usize, DiscretizeError> {
    if wanted > EDGES_MAX as f64 {
        return Err(DiscretizeError::TooMany(wanted));
    }
    if wanted.is_nan() || wanted <= 0.0 {
        return Err(DiscretizeError::NoLength);
    }
    // A closed curve in one piece needs three edges to enclose anything.
    let whole = curve.is_closed() && [piece[0], piece[1]] == curve.domain();
    Ok((libm::round(wanted) as usize).max(if whole { 3 } else { 1 }))
}

fn by_count(curve: &impl Track, count: usize) -> Result<Vec<f64>, DiscretizeError> {
    let breaks = breaks(curve);
    let tables: Vec<Table> =
        breaks.windows(2).map(|p| Table::new(curve, p[0], p[1], 0.0, &|_, _| 1.0)).collect();
    let lengths: Vec<f64> = tables.iter().map(Table::total).collect();
    if lengths.iter().any(|l| l.is_nan() || *l <= 0.0) {
        return Err(DiscretizeError::NoLength);
    }
    let mut all = Vec::new();
    for (table, count) in tables.iter().zip(shares(&lengths, count)) {
        all.extend(table.parts(curve, count, &|_, _| 1.0));
    }
    all.push(curve.domain()[1]);
    Ok(all)
}

/// `count` edges shared among pieces by their lengths, at least one each: the next edge goes to the
/// piece with the longest edges.
fn shares(lengths: &[f64], count: usize) -> Vec<usize> {
    let total: f64 = lengths.iter().sum();
    let mut shares: Vec<usize> =
        lengths.iter().map(|l| ((count as f64 * l / total) as usize).max(1)).collect();
    while shares.iter().sum::<usize>() < count {
        let edge = |i: usize| lengths[i] / shares[i] as f64;
        let longest = (0..shares.len()).fold(0, |a, b| if edge(b) > edge(a) { b } else { a });
        shares[longest] += 1;
    }
    shares
}

/// Spacings from the curvature; then, while an edge leaves the curve too far, all are made shorter.
fn by_chord_error(curve: &impl Track, error: f64) -> Result<Vec<f64>, DiscretizeError> {
    let longest = length(curve) / 8.0;
    let mut factor = 1.0;
    loop {
        let spacing =
            |jet: &CurveJet, _| factor * spacing_for_chord(jet.curvature(), error, longest);
        let nodes = by_spacing(curve, spacing)?;
        let worst = chord_error(curve, &nodes);
        if worst <= error || factor < 1e-3 {
            return Ok(nodes);
        }
        factor *= (error / worst).sqrt().clamp(0.5, 0.95);
    }
}

/// The edge that leaves a circle of this curvature by `error` (its sagitta), but at most `longest`:
/// s = r - sqrt(r^2 - h^2/4), so h = 2 sqrt(s (2 r - s)).
#[must_use]
pub fn spacing_for_chord(curvature: f64, error: f64, longest: f64) -> f64 {
    let radius = 1.0 / curvature;
    if !radius.is_finite() || error >= radius {
        return if radius.is_finite() { longest.min(2.0 * radius) } else { longest };
    }
    longest.min(2.0 * (error * (2.0 * radius - error)).sqrt())
}

/// The spacing at which equilateral triangles on this area are about `count` (section 3.1 of the
/// report: boundary curves discretised for the number of triangles wanted).
#[must_use]
pub fn spacing_for_triangles(area: f64, count: f64) -> f64 {
    const AREA_OF_SIDE_1: f64 = 0.433_012_701_892_219_3;
    (area / (AREA_OF_SIDE_1 * count)).sqrt()
}

/// Largest distance of the curve from the edges between its nodes, at seven points of each.
#[must_use]
pub fn chord_error(curve: &impl Track, nodes: &[f64]) -> f64 {
    let worst = |pair: &[f64]| {
        let (a, b) = (curve.at(pair[0]), curve.at(pair[1]));
        let at = |i: u32| curve.at(pair[0] + f64::from(i) / 8.0 * (pair[1] - pair[0]));
        (1..8).map(|i| segment_distance_sq(a, b, at(i))).fold(0.0, f64::max)
    };
    nodes.windows(2).map(worst).fold(0.0, f64::max).sqrt()
}

/// Arc length of the curve.
#[must_use]
pub fn length(curve: &impl Track) -> f64 {
    let part = |piece: &[f64]| Table::new(curve, piece[0], piece[1], 0.0, &|_, _| 1.0).total();
    breaks(curve).windows(2).map(part).sum()
}

/// The points at these parameters.
#[must_use]
pub fn points(curve: &impl Track, nodes: &[f64]) -> Vec<Vector> {
    nodes.iter().map(|&t| curve.at(t)).collect()
}

/// The ends of the parameter and the corners between.
fn breaks(curve: &impl Track) -> Vec<f64> {
    let [start, end] = curve.domain();
    let mut breaks = vec![start];
    breaks.extend(curve.corners());
    breaks.push(end);
    breaks
}

/// Intervals a knot interval is cut into: the rule of five points then gives arc lengths to 1e-9 of
/// ordinary curves.
const CUTS: usize = 16;
/// Where the spacing changes fast these are halved until halving changes the number of edges by no more
/// than this, and this part of it: else a sum might fall along the curve, and nodes change places.
const PLACED: f64 = 1e-2;
const ACCURATE: f64 = 1e-4;
/// Most times that an interval is halved.
const HALVINGS: u32 = 40;

/// The integral of ds / h over the intervals of a piece.
struct Table {
    /// Parameters of the interval ends.
    at: Vec<f64>,
    /// Integral up to each.
    sum: Vec<f64>,
    /// Arc length up to each, from the start of the curve.
    ways: Vec<f64>,
    /// Arc length at the end, from the start of the curve.
    way: f64,
}

impl Table {
    fn new(
        curve: &impl Track,
        from: f64,
        to: f64,
        way: f64,
        spacing: &impl Fn(&CurveJet, f64) -> f64,
    ) -> Self {
        let mut knots: Vec<f64> =
            curve.knots().iter().copied().filter(|&k| k > from && k < to).collect();
        knots.dedup();
        let ends: Vec<f64> = [from].into_iter().chain(knots).chain([to]).collect();
        let mut table = Self { at: vec![from], sum: vec![0.0], ways: vec![way], way };
        for pair in ends.windows(2) {
            for i in 1..=CUTS {
                let low = table.at[table.at.len() - 1];
                let high = if i == CUTS {
                    pair[1]
                } else {
                    pair[0] + (pair[1] - pair[0]) * (i as f64 / CUTS as f64)
                };
                table.extend(curve, low, high, spacing);
            }
        }
        table
    }

    /// Adds the interval from `low`, where the table ends, to `high`: in halves where the rule does not
    /// agree with itself, as around a point with a spacing much smaller than the interval.
    fn extend(
        &mut self,
        curve: &impl Track,
        low: f64,
        high: f64,
        spacing: &impl Fn(&CurveJet, f64) -> f64,
    ) {
        // Intervals still to be added, the next one last: their ends, and how often they were halved.
        let mut todo = vec![(high, 0)];
        let mut low = low;
        while let Some((high, halved)) = todo.pop() {
            let middle = 0.5 * (low + high);
            let (sum, arc) = integrate(curve, low, high, self.way, spacing);
            let (first, way) = integrate(curve, low, middle, self.way, spacing);
            let (second, _) = integrate(curve, middle, high, self.way + way, spacing);
            let differs = (first + second - sum).abs() > PLACED + ACCURATE * sum;
            if differs && halved < HALVINGS && low < middle && middle < high {
                todo.push((high, halved + 1));
                todo.push((middle, halved + 1));
                continue;
            }
            self.at.push(high);
            self.sum.push(self.sum[self.sum.len() - 1] + sum);
            self.way += arc;
            self.ways.push(self.way);
            low = high;
        }
    }

    fn total(&self) -> f64 {
        self.sum[self.sum.len() - 1]
    }

    /// Parameters that cut the integral into `count` equal parts, without the last end.
    fn parts(
        &self,
        curve: &impl Track,
        count: usize,
        spacing: &impl Fn(&CurveJet, f64) -> f64,
    ) -> Vec<f64> {
        let step = self.total() / count as f64;
        let start = [self.at[0]].into_iter();
        let inner = (1..count).map(|i| self.invert(curve, step * i as f64, spacing));
        let parts: Vec<f64> = start.clone().chain(inner).collect();
        if parts.is_sorted_by(|a, b| a < b) {
            return parts;
        }
        // A spacing that jumps may fool the rule within an interval; the table itself rises.
        start.chain((1..count).map(|i| self.between(step * i as f64).1)).collect()
    }

    /// The interval in which the integral comes to `sum`, and the parameter if the integral rises evenly
    /// there.
    fn between(&self, sum: f64) -> (usize, f64) {
        let i = self.sum.partition_point(|&s| s <= sum).clamp(1, self.sum.len() - 1) - 1;
        let part = (sum - self.sum[i]) / (self.sum[i + 1] - self.sum[i]);
        (i, self.at[i] + part.clamp(0.0, 1.0) * (self.at[i + 1] - self.at[i]))
    }

    /// The parameter up to which the integral is `sum`: Newton's method, kept in its interval.
    fn invert(
        &self,
        curve: &impl Track,
        sum: f64,
        spacing: &impl Fn(&CurveJet, f64) -> f64,
    ) -> f64 {
        let (i, mut t) = self.between(sum);
        let (start, way) = (self.at[i], self.ways[i]);
        let (mut low, mut high) = (start, self.at[i + 1]);
        for _ in 0..40 {
            let excess = integrate(curve, start, t, way, spacing).0 - (sum - self.sum[i]);
            if excess > 0.0 {
                high = t
            } else {
                low = t
            }
            let jet = curve.jet(t);
            let slope = norm(jet.first) / spacing(&jet, way);
            let newton = t - excess / slope;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            let settled = (next - t).abs() <= 1e-15 * (t.abs() + self.at[i + 1] - start);
            t = next;
            if settled {
                break;
            }
        }
        t
    }
}

/// Points and weights of Gauss's rule of five points on [-1, 1].
const GAUSS: [[f64; 2]; 5] = [
    [-0.906_179_845_938_664, 0.236_926_885_056_189_1],
    [-0.538_469_310_105_683_1, 0.478_628_670_499_366_5],
    [0.0, 0.568_888_888_888_888_9],
    [0.538_469_310_105_683_1, 0.478_628_670_499_366_5],
    [0.906_179_845_938_664, 0.236_926_885_056_189_1],
];

/// Integral of ds / h and arc length from `low` to `high`; the way to `low` is given.
fn integrate(
    curve: &impl Track,
    low: f64,
    high: f64,
    way: f64,
    spacing: &impl Fn(&CurveJet, f64) -> f64,
) -> (f64, f64) {
    let (half, middle) = (0.5 * (high - low), 0.5 * (high + low));
    let (mut sum, mut arc) = (0.0, 0.0);
    for [x, weight] in GAUSS {
        let jet = curve.jet(middle + half * x);
        let part = weight * half * norm(jet.first);
        // The way within the interval is nearly proportional to the parameter.
        sum += part / spacing(&jet, way + norm(jet.first) * half * (1.0 + x));
        arc += part;
    }
    (sum, arc)
}

/// Lengths of the edges between the nodes.
#[must_use]
pub fn edge_lengths(points: &[Vector]) -> Vec<f64> {
    points.windows(2).map(|pair| distance(pair[0], pair[1])).collect()
}
