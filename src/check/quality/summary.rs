//! Summaries of metrics: tallies of pieces, percentiles, histograms, the worst triangles.

use super::metric::{Better, Metric};
use super::{CHUNK, COLUMNS, Histogram, Input, Measurements, MetricSummary, Quality, Worst};
use crate::check::gate::Gate;
use rayon::prelude::*;

/// Triangles named per metric.
const WORST: usize = 10;

/// What one piece contributes to the summary of one metric.
pub(super) struct Tally {
    metric: Metric,
    finite: u64,
    infinite: u64,
    pub(super) min: f64,
    max: f64,
    sum: f64,
    counts: Vec<u64>,
    /// Value and triangle, worst first.
    worst: Vec<(f64, u32)>,
    /// For each gate on this metric, its position and how many values meet it.
    met: Vec<(usize, u64)>,
}

impl Tally {
    /// Tallies the values of consecutive triangles from `first` on.
    pub(super) fn of(metric: Metric, values: &[f64], first: u32, gates: &[Gate]) -> Self {
        let bounds = bounds(metric);
        let mut tally = Self::empty(metric);
        for (t, &value) in (first..).zip(values) {
            tally.note_worst(value, t);
            if !value.is_finite() {
                tally.infinite += 1;
                continue;
            }
            tally.finite += 1;
            tally.min = tally.min.min(value);
            tally.max = tally.max.max(value);
            tally.sum += value;
            tally.counts[bounds.iter().take_while(|&&b| b <= value).count()] += 1;
        }
        for (position, gate) in gates.iter().enumerate().filter(|(_, g)| g.metric == metric) {
            tally
                .met
                .push((position, values.iter().filter(|&&v| gate.is_met_by(v)).count() as u64));
        }
        tally
    }

    fn empty(metric: Metric) -> Self {
        Self {
            metric,
            finite: 0,
            infinite: 0,
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
            sum: 0.0,
            counts: vec![0; bounds(metric).len() + 1],
            worst: Vec::with_capacity(WORST + 1),
            met: Vec::new(),
        }
    }

    /// Keeps the worst few; among equals the lowest triangles.
    fn note_worst(&mut self, value: f64, triangle: u32) {
        let metric = self.metric;
        if self.worst.len() == WORST && !is_worse(metric, value, self.worst[WORST - 1].0) {
            return;
        }
        let at = self.worst.partition_point(|&(other, _)| !is_worse(metric, value, other));
        self.worst.insert(at, (value, triangle));
        self.worst.truncate(WORST);
    }

    /// Adds the tally of the piece that follows.
    fn append(&mut self, next: &Self) {
        self.finite += next.finite;
        self.infinite += next.infinite;
        self.min = self.min.min(next.min);
        self.max = self.max.max(next.max);
        self.sum += next.sum;
        self.counts.iter_mut().zip(&next.counts).for_each(|(a, b)| *a += b);
        next.worst.iter().for_each(|&(value, t)| self.note_worst(value, t));
        for &(position, count) in &next.met {
            match self.met.iter_mut().find(|m| m.0 == position) {
                Some(entry) => entry.1 += count,
                None => self.met.push((position, count)),
            }
        }
    }
}

/// Undefined values are worst, then infinite ones.
fn is_worse(metric: Metric, a: f64, b: f64) -> bool {
    let badness = |v: f64| match metric.better() {
        _ if v.is_nan() => f64::INFINITY,
        Better::Higher | Better::Neither => -v,
        Better::Lower => v,
    };
    badness(a) > badness(b)
}

/// Bounds of the histogram's intervals.
fn bounds(metric: Metric) -> &'static [f64] {
    match metric {
        Metric::MinAngle => &[5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0],
        Metric::MaxAngle => {
            &[65.0, 70.0, 75.0, 80.0, 90.0, 100.0, 110.0, 120.0, 135.0, 150.0, 165.0]
        }
        Metric::ScaledJacobian | Metric::Shape | Metric::EquiangleSkew => {
            &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]
        }
        Metric::RadiusEdgeRatio => &[0.6, 0.7, 0.8, 1.0, 1.2, 1.414, 2.0, 3.0, 5.0, 10.0],
        Metric::Area => &[1e-12, 1e-9, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 1e3, 1e6],
        Metric::AreaSpread => &[1.5, 2.0, 5.0, 10.0, 100.0, 1e3, 1e4, 1e6],
        _ => &[1.05, 1.1, 1.2, 1.3, 1.5, 2.0, 3.0, 5.0, 10.0, 100.0],
    }
}

/// Puts the tallies of all pieces together.
pub(super) fn summarise(
    input: &Input<'_>,
    columns: &[f32],
    pieces: [Vec<Vec<Tally>>; 2],
    gates: &[Gate],
) -> Measurements {
    let mut totals: Vec<Tally> = Metric::all().map(Tally::empty).collect();
    for tallies in pieces.iter().flatten().flatten() {
        totals[tallies.metric as usize].append(tallies);
    }
    let mut met = vec![0; gates.len()];
    totals.iter().flat_map(|t| &t.met).for_each(|&(position, count)| met[position] = count);
    let count = input.triangles.len();
    let smallest = totals[Metric::Area as usize].min;
    let metrics: Vec<MetricSummary> = totals
        .par_iter()
        .map(|total| {
            let column =
                if total.metric == Metric::AreaSpread { Metric::Area } else { total.metric };
            let mut percentiles = percentiles(columns, column as usize, count);
            if total.metric == Metric::AreaSpread {
                percentiles = percentiles.map(|p| p.map(|area| area / smallest));
            }
            summary(input, total, percentiles)
        })
        .collect();
    Measurements { quality: Quality { metrics, triangles: count as u64 }, met }
}

fn summary(input: &Input<'_>, total: &Tally, percentiles: [Option<f64>; 3]) -> MetricSummary {
    let some = |value: f64| (total.finite > 0).then_some(value);
    let worst = |&(value, t): &(f64, u32)| Worst {
        triangle: (input.place)(t),
        value: value.is_finite().then_some(value),
    };
    MetricSummary {
        metric: total.metric,
        formula: total.metric.formula().to_owned(),
        better: total.metric.better(),
        count: total.finite,
        infinite: total.infinite,
        min: some(total.min),
        mean: some(total.sum / total.finite as f64).filter(|m| m.is_finite()),
        max: some(total.max),
        percentile_1: percentiles[0],
        percentile_50: percentiles[1],
        percentile_99: percentiles[2],
        histogram: Histogram {
            bounds: bounds(total.metric).to_vec(),
            counts: total.counts.clone(),
        },
        worst: total.worst.iter().map(worst).collect(),
    }
}

/// A number that orders like the float: the usual trick of flipping the sign bit, or all bits.
fn ordered(value: f32) -> u32 {
    let bits = value.to_bits();
    if bits >> 31 == 1 { !bits } else { bits | 1 << 31 }
}

fn from_ordered(key: u32) -> f32 {
    f32::from_bits(if key >> 31 == 1 { key & !(1 << 31) } else { !key })
}

/// The values below which 1, 50 and 99 of a hundred triangles lie (nearest rank), by two passes of
/// radix selection over 16 bits each: exact in single precision, and free of any order of threads.
fn percentiles(columns: &[f32], column: usize, count: usize) -> [Option<f64>; 3] {
    let values = || {
        columns.chunks(CHUNK * COLUMNS).enumerate().flat_map(move |(piece, block)| {
            let length = CHUNK.min(count - piece * CHUNK);
            block[column * CHUNK..column * CHUNK + length].iter().map(|&v| ordered(v))
        })
    };
    let ranks = [1usize, 50, 99].map(|p| (count * p).div_ceil(100).max(1) as u64);
    let mut coarse = vec![0u64; 1 << 16];
    values().for_each(|key| coarse[(key >> 16) as usize] += 1);
    let starts = ranks.map(|rank| find_rank(&coarse, rank));
    let mut fine: [Vec<u64>; 3] = std::array::from_fn(|_| vec![0u64; 1 << 16]);
    for key in values() {
        for (start, fine) in starts.iter().zip(&mut fine) {
            if key >> 16 == start.0 {
                fine[(key & 0xffff) as usize] += 1;
            }
        }
    }
    std::array::from_fn(|i| {
        let (high, rest) = starts[i];
        let value = from_ordered((high << 16) | find_rank(&fine[i], rest).0);
        value.is_finite().then_some(f64::from(value))
    })
}

/// The bucket that holds the rank-th value (from 1), and its rank within.
fn find_rank(counts: &[u64], mut rank: u64) -> (u32, u64) {
    for (bucket, &count) in (0u32..).zip(counts) {
        if rank <= count {
            return (bucket, rank);
        }
        rank -= count;
    }
    (0, rank)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_order_like_floats() {
        let values = [f32::NEG_INFINITY, -2.5, -0.0, 0.0, 1e-40, 1.0, 3.5, f32::INFINITY];
        for pair in values.windows(2) {
            assert!(ordered(pair[0]) < ordered(pair[1]), "{pair:?}");
        }
        for value in values {
            assert_eq!(from_ordered(ordered(value)).to_bits(), value.to_bits());
        }
    }

    #[test]
    fn percentiles_are_those_of_a_sorted_list() {
        let count = 3 * CHUNK / 2;
        let value = |i: usize| ((i * 7919) % count) as f32 - 1000.0;
        let mut columns = vec![0f32; 2 * CHUNK * COLUMNS];
        for i in 0..count {
            columns[(i / CHUNK) * CHUNK * COLUMNS + 2 * CHUNK + i % CHUNK] = value(i);
        }
        let mut sorted: Vec<f32> = (0..count).map(value).collect();
        sorted.sort_by(f32::total_cmp);
        let wanted = [1, 50, 99].map(|p| Some(f64::from(sorted[(count * p).div_ceil(100) - 1])));
        assert_eq!(percentiles(&columns, 2, count), wanted);
    }

    #[test]
    fn the_worst_are_the_highest_or_the_lowest() {
        let values: Vec<f64> = (0..100).map(f64::from).collect();
        let angles = Tally::of(Metric::MinAngle, &values, 5, &[]);
        assert_eq!(angles.worst[0], (0.0, 5));
        let ratios = Tally::of(Metric::EdgeRatio, &values, 5, &[]);
        assert_eq!(ratios.worst[9], (90.0, 95));
        let mut undefined = Tally::of(Metric::EdgeRatio, &[1.0, f64::NAN, 2.0], 0, &[]);
        undefined.append(&ratios);
        assert_eq!((undefined.worst[0].1, undefined.infinite, undefined.finite), (1, 1, 102));
    }
}
