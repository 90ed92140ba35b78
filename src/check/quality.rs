//! Quality of a mesh: every metric summarised, with its worst triangles.
//!
//! Sums are formed in pieces of fixed size that are added in order, counts are integers, and ties
//! are broken by index, so a report does not depend on the number of threads.

pub mod metric;
mod summary;

use super::edges::NONE;
use super::gate::Gate;
use super::report::TrianglePlace;
pub use metric::{Better, Measured, Metric, OWN_METRICS, measure};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use summary::Tally;

/// A triangle and its value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// The triangle.
    pub triangle: TrianglePlace,
    /// Its value; `None` when infinite.
    pub value: Option<f64>,
}

/// How many values lie in each interval.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Histogram {
    /// Bounds between the intervals, rising.
    pub bounds: Vec<f64>,
    /// One more than bounds: interval i holds the values from `bounds[i - 1]` to below `bounds[i]`.
    pub counts: Vec<u64>,
}

/// One metric over all triangles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MetricSummary {
    /// The metric.
    pub metric: Metric,
    /// Its formula.
    pub formula: String,
    /// Which values are better.
    pub better: Better,
    /// Triangles with a finite value.
    pub count: u64,
    /// Triangles whose value is infinite or undefined.
    pub infinite: u64,
    /// Smallest finite value.
    pub min: Option<f64>,
    /// Mean of the finite values.
    pub mean: Option<f64>,
    /// Largest finite value.
    pub max: Option<f64>,
    /// The value that 1 % of the triangles do not exceed, in single precision.
    pub percentile_1: Option<f64>,
    /// The median, in single precision.
    pub percentile_50: Option<f64>,
    /// The value that 99 % of the triangles do not exceed, in single precision.
    pub percentile_99: Option<f64>,
    /// Distribution of the finite values.
    pub histogram: Histogram,
    /// The worst triangles, worst first.
    pub worst: Vec<Worst>,
}

/// The quality of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quality {
    /// One summary per metric, in the order of [`Metric`].
    pub metrics: Vec<MetricSummary>,
    /// Triangles measured: those with three different, finite corners.
    pub triangles: u64,
}

impl Quality {
    /// The summary of a metric.
    #[must_use]
    pub fn summary(&self, metric: Metric) -> Option<&MetricSummary> {
        self.metrics.iter().find(|summary| summary.metric == metric)
    }
}

/// Triangles per piece of work: sums are formed within pieces, then over pieces in order.
pub(crate) const CHUNK: usize = 1 << 13;

/// Metrics with a column of values: all but the area spread, which the area's column gives.
pub(crate) const COLUMNS: usize = Metric::COUNT - 1;

/// A triangulation to be measured.
pub(super) struct Input<'a> {
    pub(super) triangles: &'a [[u32; 3]],
    pub(super) twin: &'a [u32],
    pub(super) measure: &'a (dyn Fn([u32; 3]) -> Measured + Sync),
    pub(super) place: &'a (dyn Fn(u32) -> TrianglePlace + Sync),
}

/// The answer to the gates beside the summaries.
pub(super) struct Measurements {
    pub(super) quality: Quality,
    /// For each gate, how many triangles meet its bound.
    pub(super) met: Vec<u64>,
}

/// Measures all triangles.
///
/// O(n); 64 bytes a triangle while it runs.
pub(super) fn assess(input: &Input<'_>, gates: &[Gate]) -> Measurements {
    let count = input.triangles.len();
    let pieces = count.div_ceil(CHUNK);
    let mut columns = vec![0f32; pieces * CHUNK * COLUMNS];
    let mut sizes = vec![[0f64; 2]; count];
    let tallies: Vec<Vec<Tally>> = columns
        .par_chunks_mut(CHUNK * COLUMNS)
        .zip(input.triangles.par_chunks(CHUNK))
        .zip(sizes.par_chunks_mut(CHUNK))
        .enumerate()
        .map(|(piece, ((columns, triangles), sizes))| {
            finish_tallies(measure_piece(input, triangles, columns, sizes), piece, gates)
        })
        .collect();
    let smallest =
        tallies.iter().map(|t| t[Metric::Area as usize].min).fold(f64::INFINITY, f64::min);
    let beside: Vec<Vec<Tally>> = columns
        .par_chunks_mut(CHUNK * COLUMNS)
        .enumerate()
        .map(|(piece, columns)| {
            let values = compare_piece(input.twin, &sizes, (piece, smallest), columns);
            finish_tallies(values, piece, gates)
        })
        .collect();
    drop(sizes);
    summary::summarise(input, &columns, [tallies, beside], gates)
}

type Values = Vec<(Metric, Vec<f64>)>;

fn finish_tallies(values: Values, piece: usize, gates: &[Gate]) -> Vec<Tally> {
    let first = (piece * CHUNK) as u32;
    values.iter().map(|(metric, values)| Tally::of(*metric, values, first, gates)).collect()
}

/// The metrics that need no neighbours, and area and perimeter for those that do.
fn measure_piece(
    input: &Input<'_>,
    triangles: &[[u32; 3]],
    columns: &mut [f32],
    sizes: &mut [[f64; 2]],
) -> Values {
    let mut values: Values =
        Metric::all().take(OWN_METRICS).map(|m| (m, Vec::with_capacity(triangles.len()))).collect();
    for (i, &triangle) in triangles.iter().enumerate() {
        let measured = (input.measure)(triangle);
        let metrics = measured.metrics();
        sizes[i] = [metrics[Metric::Area as usize], measured.perimeter()];
        for (k, &value) in metrics.iter().enumerate() {
            values[k].1.push(value);
            columns[k * CHUNK + i] = value as f32;
        }
    }
    values
}

/// The metrics that compare a triangle with others.
fn compare_piece(
    twin: &[u32],
    sizes: &[[f64; 2]],
    (piece, smallest): (usize, f64),
    columns: &mut [f32],
) -> Values {
    let first = piece * CHUNK;
    let range = first..sizes.len().min(first + CHUNK);
    let mut values: Values =
        Metric::all().skip(OWN_METRICS).map(|m| (m, Vec::with_capacity(range.len()))).collect();
    for (i, t) in range.enumerate() {
        let [area, perimeter] = sizes[t];
        let mut ratios = [1.0f64; 2];
        for &half_edge in &twin[3 * t..3 * t + 3] {
            if half_edge != NONE {
                let other = sizes[(half_edge / 3) as usize];
                ratios[0] = worse(ratios[0], area, other[0]);
                ratios[1] = worse(ratios[1], perimeter, other[1]);
            }
        }
        values[0].1.push(ratios[0]);
        values[1].1.push(ratios[1]);
        values[2].1.push(area / smallest);
        columns[OWN_METRICS * CHUNK + i] = ratios[0] as f32;
        columns[(OWN_METRICS + 1) * CHUNK + i] = ratios[1] as f32;
    }
    values
}

/// The larger of a ratio and the ratio of two sizes taken so that it is at least 1; infinite when
/// one of them is not positive.
fn worse(ratio: f64, a: f64, b: f64) -> f64 {
    if a > 0.0 && b > 0.0 { ratio.max(a / b).max(b / a) } else { f64::INFINITY }
}
