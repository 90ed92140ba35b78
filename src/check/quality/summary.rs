//! Summaries of metrics: tallies of pieces, percentiles, histograms, the worst triangles.

use super::metric::{Better, Metric};
use super::{CHUNK, COLUMNS, Histogram, Measurements, MetricSummary, Quality, Worst};
use crate::check::gate::Gate;
use crate::check::report::TrianglePlace;
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
    /// Value and triangle, worst first.
    worst: Vec<(f64, u32)>,
    /// For each gate on this metric, its position and how many values meet it.
    met: Vec<(usize, u64)>,
}

impl Tally {
    /// Tallies the values of consecutive triangles from `first` on.
    pub(super) fn of(metric: Metric, values: &[f64], first: u32, gates: &[Gate]) -> Self {
        let mut tally = Self::empty(metric);
        if !tally.add_finite(values) {
            values.iter().for_each(|&value| tally.add_any(value));
        }
        tally.note_worst_of(values, first);
        for (position, gate) in gates.iter().enumerate().filter(|(_, g)| g.metric == metric) {
            tally
                .met
                .push((position, values.iter().filter(|&&v| gate.is_met_by(v)).count() as u64));
        }
        tally
    }

    /// Notes the worst of consecutive triangles: most values are passed over eight at a time.
    fn note_worst_of(&mut self, values: &[f64], first: u32) {
        let sign = match self.metric.better() {
            Better::Lower => 1.0,
            Better::Higher | Better::Neither => -1.0,
        };
        let bar = |worst: &[(f64, u32)]| {
            worst.get(WORST - 1).map_or(f64::NEG_INFINITY, |entry| sign * entry.0)
        };
        for (lane, values) in values.chunks(8).enumerate() {
            // Written so that NaN, on either side, passes for worse.
            let is_passed = |&value: &f64, bar: f64| sign * value <= bar;
            let current = bar(&self.worst);
            if values.iter().fold(true, |all, value| all & is_passed(value, current)) {
                continue;
            }
            for (t, value) in (first + 8 * lane as u32..).zip(values) {
                if !is_passed(value, bar(&self.worst)) {
                    self.note_worst(*value, t);
                }
            }
        }
    }

    /// Adds values in eight lanes, in a fixed order, if all are finite; else adds nothing.
    fn add_finite(&mut self, values: &[f64]) -> bool {
        let (mut sums, mut lows, mut highs) =
            ([0.0; 8], [f64::INFINITY; 8], [f64::NEG_INFINITY; 8]);
        let mut suspicious = false;
        for lane in values.chunks(8) {
            for (k, &value) in lane.iter().enumerate() {
                sums[k] += value;
                lows[k] = if value < lows[k] { value } else { lows[k] };
                highs[k] = if value > highs[k] { value } else { highs[k] };
                suspicious |= !value.is_finite();
            }
        }
        if !suspicious {
            self.finite += values.len() as u64;
            self.sum += sums.iter().sum::<f64>();
            self.min = lows.iter().copied().fold(self.min, f64::min);
            self.max = highs.iter().copied().fold(self.max, f64::max);
        }
        !suspicious
    }

    fn add_any(&mut self, value: f64) {
        if value.is_finite() {
            self.finite += 1;
            self.min = self.min.min(value);
            self.max = self.max.max(value);
            self.sum += value;
        } else {
            self.infinite += 1;
        }
    }

    fn empty(metric: Metric) -> Self {
        Self {
            metric,
            finite: 0,
            infinite: 0,
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
            sum: 0.0,
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

/// Bounds of the histogram's intervals: numbers of at most eight significant bits, so that counts by
/// the upper half of a single-precision number give the histogram.
fn bounds(metric: Metric) -> &'static [f32] {
    match metric {
        Metric::MinAngle => &[5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0],
        Metric::MaxAngle => {
            &[65.0, 70.0, 75.0, 80.0, 90.0, 100.0, 110.0, 120.0, 135.0, 150.0, 165.0]
        }
        Metric::ScaledJacobian | Metric::Shape | Metric::EquiangleSkew => {
            &[0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 0.9375]
        }
        Metric::RadiusEdgeRatio => &[0.625, 0.75, 0.875, 1.0, 1.25, 1.5, 2.0, 3.0, 5.0, 10.0],
        Metric::Area => AREAS,
        Metric::AreaSpread => &[1.5, 2.0, 4.0, 8.0, 16.0, 64.0, 256.0, 1024.0, 65536.0],
        _ => &[1.0625, 1.125, 1.25, 1.375, 1.5, 2.0, 3.0, 5.0, 10.0, 100.0],
    }
}

/// Powers of 2^6 from 2^-36 to 2^24.
const AREAS: &[f32] = &[
    1.455_191_5e-11,
    9.313_226e-10,
    5.960_464_5e-8,
    3.814_697_3e-6,
    2.441_406_3e-4,
    0.015_625,
    1.0,
    64.0,
    4096.0,
    262_144.0,
    16_777_216.0,
];

/// Names a triangle.
type Place<'a> = &'a (dyn Fn(u32) -> TrianglePlace + Sync);

/// Puts the tallies of all pieces together.
pub(super) fn summarise(
    (count, place): (usize, Place<'_>),
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
    let smallest = totals[Metric::Area as usize].min;
    let mut spreads: Vec<Spread> = (0..COLUMNS)
        .into_par_iter()
        .map(|column| {
            let bounds = bounds(Metric::all().nth(column).unwrap_or(Metric::Area));
            Column { columns, column, count }.spread(bounds)
        })
        .collect();
    let areas = Column { columns, column: Metric::Area as usize, count };
    spreads.push(areas.scaled(&spreads[Metric::Area as usize], smallest));
    let metrics = totals.iter().zip(&spreads).map(|(total, s)| summary(place, total, s)).collect();
    Measurements { quality: Quality { metrics, triangles: count as u64 }, met }
}

fn summary(place: Place<'_>, total: &Tally, spread: &Spread) -> MetricSummary {
    let some = |value: f64| (total.finite > 0).then_some(value);
    let worst = |&(value, t): &(f64, u32)| Worst {
        triangle: place(t),
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
        percentile_1: spread.percentiles[0],
        percentile_50: spread.percentiles[1],
        percentile_99: spread.percentiles[2],
        histogram: Histogram {
            bounds: bounds(total.metric).iter().map(|&b| f64::from(b)).collect(),
            counts: spread.counts.clone(),
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

/// The values of one metric, in single precision.
struct Column<'a> {
    columns: &'a [f32],
    column: usize,
    count: usize,
}

/// How the values of a metric are spread.
struct Spread {
    /// The values that 1, 50 and 99 of a hundred triangles do not exceed.
    percentiles: [Option<f64>; 3],
    /// Finite values by the histogram's intervals.
    counts: Vec<u64>,
}

impl Column<'_> {
    fn pieces(&self) -> impl Iterator<Item = &[f32]> {
        self.columns.chunks(CHUNK * COLUMNS).enumerate().map(|(piece, block)| {
            let length = CHUNK.min(self.count - piece * CHUNK);
            &block[self.column * CHUNK..self.column * CHUNK + length]
        })
    }

    /// Percentiles by nearest rank and the histogram, by two passes of radix selection over 16 bits
    /// each: exact in single precision, and free of any order of threads.
    fn spread(&self, bounds: &[f32]) -> Spread {
        let coarse = self.count_upper_halves();
        let ranks = [1usize, 50, 99].map(|p| (self.count * p).div_ceil(100).max(1) as u64);
        let percentiles = self
            .select(ranks.map(|rank| find_rank(&coarse, rank)))
            .map(|value| value.is_finite().then_some(f64::from(value)));
        Spread { percentiles, counts: histogram(&coarse, bounds) }
    }

    /// The spread of the values divided by the smallest of them, given that of the values.
    fn scaled(&self, spread: &Spread, smallest: f64) -> Spread {
        let scale = 1.0 / smallest;
        let finite = |value: f64| Some(value * scale).filter(|v| v.is_finite());
        Spread {
            percentiles: spread.percentiles.map(|p| p.and_then(finite)),
            counts: self.scaled_histogram(bounds(Metric::AreaSpread), scale),
        }
    }

    /// How many keys have each upper half. Two counters each: good meshes have most of their values
    /// in a few buckets, and an increment must not wait for the one before it.
    fn count_upper_halves(&self) -> Vec<u32> {
        let mut even = vec![0u32; 1 << 16];
        let mut odd = vec![0u32; 1 << 16];
        for piece in self.pieces() {
            let mut pairs = piece.chunks_exact(2);
            for pair in &mut pairs {
                even[(ordered(pair[0]) >> 16) as usize] += 1;
                odd[(ordered(pair[1]) >> 16) as usize] += 1;
            }
            pairs.remainder().iter().for_each(|&v| even[(ordered(v) >> 16) as usize] += 1);
        }
        even.iter_mut().zip(odd).for_each(|(e, o)| *e += o);
        even
    }

    /// The values of three ranks, each given by its upper half and its place (from 1) among the keys
    /// that have it.
    fn select(&self, wanted: [(u32, u64); 3]) -> [f32; 3] {
        let highs = wanted.map(|w| w.0);
        let mut fine = [(); 3].map(|()| vec![0u32; 1 << 16]);
        for values in self.pieces().flat_map(|piece| piece.chunks(16)) {
            let of_none = |&v: &f32| highs.iter().fold(true, |n, &h| n & (ordered(v) >> 16 != h));
            if values.iter().fold(true, |none, v| none & of_none(v)) {
                continue;
            }
            for key in values.iter().map(|&v| ordered(v)) {
                for (counts, high) in fine.iter_mut().zip(highs) {
                    if key >> 16 == high {
                        counts[(key & 0xffff) as usize] += 1;
                    }
                }
            }
        }
        std::array::from_fn(|k| {
            let (high, rank) = wanted[k];
            from_ordered((high << 16) | find_rank(&fine[k], rank).0)
        })
    }

    /// The histogram of the values times a positive scale.
    fn scaled_histogram(&self, bounds: &[f32], scale: f64) -> Vec<u64> {
        // Scaling is monotone: a bound on scaled values is one on the values, found by bisection.
        let reaches = |key: u32, bound: f64| f64::from(from_ordered(key)) * scale >= bound;
        let cut = |bound: f64| {
            let (mut below, mut above) = (ordered(f32::NEG_INFINITY), ordered(f32::INFINITY) + 1);
            while above - below > 1 {
                let middle = below + (above - below) / 2;
                *(if reaches(middle, bound) { &mut above } else { &mut below }) = middle;
            }
            above
        };
        let lowest = ordered(f32::NEG_INFINITY) + 1;
        let bounds = bounds.iter().map(|&b| cut(f64::from(b)));
        let cuts = [lowest].into_iter().chain(bounds).chain([cut(f64::INFINITY)]);
        let at_least: Vec<u64> = cuts.map(|cut| self.count_from(cut)).collect();
        at_least.windows(2).map(|w| w[0] - w[1]).collect()
    }

    /// How many keys are at least `cut`.
    fn count_from(&self, cut: u32) -> u64 {
        let of = |piece: &[f32]| piece.iter().map(|&v| u32::from(ordered(v) >= cut)).sum::<u32>();
        self.pieces().map(|piece| u64::from(of(piece))).sum()
    }
}

/// Finite values by interval, from the counts by upper halves.
fn histogram(coarse: &[u32], bounds: &[f32]) -> Vec<u64> {
    let cuts = bounds.iter().map(|&b| (ordered(b) >> 16) as usize);
    let first = (ordered(f32::NEG_INFINITY) >> 16) as usize + 1;
    let last = (ordered(f32::INFINITY) >> 16) as usize;
    let mut from = first;
    let mut counts = Vec::with_capacity(bounds.len() + 1);
    for to in cuts.chain([last]) {
        counts.push(coarse[from..to].iter().map(|&c| u64::from(c)).sum());
        from = to;
    }
    counts
}

/// The bucket that holds the rank-th value (from 1), and its rank within.
fn find_rank(counts: &[u32], mut rank: u64) -> (u32, u64) {
    for (bucket, count) in (0u32..).zip(counts.iter().map(|&c| u64::from(c))) {
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
        let column = Column { columns: &columns, column: 2, count };
        let spread = column.spread(&[0.0, 512.0, 1024.0]);
        assert_eq!(spread.percentiles, wanted);
        let below = |b: f32| sorted.partition_point(|&v| v < b) as u64;
        let cuts = [below(0.0), below(512.0), below(1024.0), count as u64];
        let counts = [cuts[0], cuts[1] - cuts[0], cuts[2] - cuts[1], cuts[3] - cuts[2]];
        assert_eq!(spread.counts, counts);
        assert_eq!(column.scaled_histogram(&[0.0, 512.0, 1024.0], 1.0), counts);
    }

    #[test]
    fn bounds_have_eight_significant_bits_and_rise() {
        for metric in Metric::all() {
            let bounds = bounds(metric);
            assert!(bounds.windows(2).all(|w| w[0] < w[1]), "{metric}");
            assert!(bounds.iter().all(|b| ordered(*b) & 0xffff == 0), "{metric}");
        }
    }

    #[test]
    fn lanes_give_up_on_values_that_are_not_finite() {
        let finite: Vec<f64> = (0..20).map(f64::from).collect();
        let tally = Tally::of(Metric::Area, &finite, 0, &[]);
        assert_eq!((tally.finite, tally.min, tally.max, tally.sum), (20, 0.0, 19.0, 190.0));
        let mut mixed = finite.clone();
        mixed[7] = f64::INFINITY;
        let tally = Tally::of(Metric::Area, &mixed, 0, &[]);
        assert_eq!((tally.finite, tally.infinite, tally.sum), (19, 1, 183.0));
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
