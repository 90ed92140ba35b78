//! Quality of a mesh: every metric summarised, with its worst triangles.
//!
//! Sums are formed in pieces of fixed size that are added in order, counts are integers, and ties
//! are broken by index, so a report does not depend on the number of threads.

mod lanes;
pub mod metric;
mod summary;

use super::edges::NONE;
use super::gate::Gate;
use super::report::TrianglePlace;
use lanes::{Block, WIDTH};
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
pub(super) struct Input<'a, M> {
    pub(super) triangles: &'a [[u32; 3]],
    pub(super) twin: &'a [u32],
    pub(super) measure: M,
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
pub(super) fn assess<M: Fn([u32; 3]) -> Measured + Sync>(
    input: &Input<'_, M>,
    gates: &[Gate],
) -> Measurements {
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
            let values = measure_piece(&input.measure, triangles, columns, sizes);
            finish_tallies(&values, piece, gates)
        })
        .collect();
    let smallest =
        tallies.iter().map(|t| t[Metric::Area as usize].min).fold(f64::INFINITY, f64::min);
    let beside: Vec<Vec<Tally>> = columns
        .par_chunks_mut(CHUNK * COLUMNS)
        .enumerate()
        .map(|(piece, columns)| {
            let values = compare_piece(input.twin, &sizes, (piece, smallest), columns);
            finish_tallies(&values, piece, gates)
        })
        .collect();
    drop(sizes);
    let place = |t: u32| (input.place)(t);
    summary::summarise((count, &place), &columns, [tallies, beside], gates)
}

/// Values of consecutive metrics, from the given one on.
struct Values {
    first: usize,
    columns: Vec<Vec<f64>>,
}

fn finish_tallies(values: &Values, piece: usize, gates: &[Gate]) -> Vec<Tally> {
    let first = (piece * CHUNK) as u32;
    let metrics = Metric::all().skip(values.first).zip(&values.columns);
    metrics.map(|(metric, values)| Tally::of(metric, values, first, gates)).collect()
}

/// The metrics that need no neighbours, and area and perimeter for those that do.
fn measure_piece(
    measure: &impl Fn([u32; 3]) -> Measured,
    triangles: &[[u32; 3]],
    columns: &mut [f32],
    sizes: &mut [[f64; 2]],
) -> Values {
    let mut values = vec![vec![0.0; triangles.len()]; OWN_METRICS];
    let mut block = Block::EMPTY;
    for (b, triangles) in triangles.chunks(WIDTH).enumerate() {
        let (from, to) = (b * WIDTH, b * WIDTH + triangles.len());
        for (i, &triangle) in triangles.iter().enumerate() {
            let measured = measure(triangle);
            (0..3).for_each(|k| block.edges[k][i] = measured.edges[k]);
            block.doubled_area[i] = measured.doubled_area;
            sizes[from + i] = [measured.area(), measured.perimeter()];
        }
        let metrics = block.metrics();
        for (column, metric) in values.iter_mut().zip(&metrics) {
            column[from..to].copy_from_slice(&metric[..triangles.len()]);
        }
    }
    // Only the area depends on the scale at which a triangle was measured.
    for (area, size) in values[Metric::Area as usize].iter_mut().zip(&*sizes) {
        *area = size[0];
    }
    copy_columns(&values, columns);
    Values { first: 0, columns: values }
}

/// Copies values in single precision, a metric after the other.
#[expect(clippy::cast_possible_truncation, reason = "columns are in single precision")]
fn copy_columns(values: &[Vec<f64>], columns: &mut [f32]) {
    for (column, values) in columns.chunks_mut(CHUNK).zip(values) {
        column.iter_mut().zip(values).for_each(|(slot, &value)| *slot = value as f32);
    }
}

/// The metrics that compare a triangle with others.
fn compare_piece(
    twin: &[u32],
    sizes: &[[f64; 2]],
    (piece, smallest): (usize, f64),
    columns: &mut [f32],
) -> Values {
    let first = piece * CHUNK;
    let own = &sizes[first..sizes.len().min(first + CHUNK)];
    let mut values = vec![vec![0.0; own.len()]; Metric::COUNT - OWN_METRICS];
    for (i, &size) in own.iter().enumerate() {
        let t = first + i;
        let (mut low, mut high) = (size, size);
        for &half_edge in &twin[3 * t..3 * t + 3] {
            let other = if half_edge == NONE { size } else { sizes[(half_edge / 3) as usize] };
            for k in 0..2 {
                low[k] = if other[k] < low[k] { other[k] } else { low[k] };
                high[k] = if other[k] > high[k] { other[k] } else { high[k] };
            }
        }
        values[0][i] = worst_ratio(size[0], low[0], high[0]);
        values[1][i] = worst_ratio(size[1], low[1], high[1]);
        values[2][i] = size[0] / smallest;
    }
    copy_columns(&values[..2], &mut columns[OWN_METRICS * CHUNK..]);
    Values { first: OWN_METRICS, columns: values }
}

/// The largest ratio, at least 1, of a size with the smallest and the largest around it; infinite
/// when one of them is not positive.
fn worst_ratio(size: f64, low: f64, high: f64) -> f64 {
    let (down, up) = (size / low, high / size);
    if low > 0.0 { if down > up { down } else { up } } else { f64::INFINITY }
}
