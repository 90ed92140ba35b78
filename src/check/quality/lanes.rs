//! The metrics of many triangles at once: plain loops over fixed-size arrays, without branches or
//! calls, which compilers turn into vector code. Only IEEE operations, so every platform gets the
//! same values.

use super::metric::OWN_METRICS;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Triangles per block.
pub(super) const WIDTH: usize = 32;

/// Edge lengths and twice the signed area of [`WIDTH`] triangles.
pub(super) struct Block {
    pub(super) edges: [[f64; WIDTH]; 3],
    pub(super) doubled_area: [f64; WIDTH],
}

impl Block {
    pub(super) const EMPTY: Self = Self { edges: [[1.0; WIDTH]; 3], doubled_area: [1.0; WIDTH] };

    /// The metrics of each triangle, by metric.
    pub(super) fn metrics(&self) -> [[f64; WIDTH]; OWN_METRICS] {
        let mut out = [[0.0; WIDTH]; OWN_METRICS];
        for i in 0..WIDTH {
            let edges = [self.edges[0][i], self.edges[1][i], self.edges[2][i]];
            let row = metrics(edges, self.doubled_area[i]);
            for (column, value) in out.iter_mut().zip(row) {
                column[i] = value;
            }
        }
        out
    }
}

/// The larger; compiles to one instruction, which `f64::max` with its care for NaN does not.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The metrics of a triangle alone, from its edge lengths and twice its signed area, in the order
/// of [`super::Metric`]; infinite where the area is zero and the metric divides by it.
///
/// With D = 2 A and perimeter P: R = abc / (2 D), r = D / P.
#[inline(always)]
pub(super) fn metrics([a, b, c]: [f64; 3], signed: f64) -> [f64; OWN_METRICS] {
    let sqrt3 = 1.732_050_807_568_877_2;
    let doubled = signed.abs();
    let inverse = 1.0 / doubled;
    let perimeter = a + b + c;
    let (low, high) = (smaller(a, b), larger(a, b));
    let (long, short) = (larger(high, c), smaller(low, c));
    let middle = larger(low, smaller(high, c));
    let two_longest = long * middle;
    let (long2, middle2, short2) = (long * long, middle * middle, short * short);
    // The angles opposite the shortest and the longest edge.
    let min_angle = angle(doubled, 0.5 * ((long2 - short2) + middle2));
    let max_angle = angle(doubled, 0.5 * ((short2 - long2) + middle2));
    [
        (two_longest * inverse) * (short * perimeter * inverse) * 0.25,
        long * perimeter * inverse * (0.5 / sqrt3),
        long / short,
        min_angle,
        max_angle,
        0.5 * two_longest * inverse,
        (2.0 / sqrt3) * signed / two_longest,
        2.0 * sqrt3 * doubled / (long2 + middle2 + short2),
        larger((max_angle - 60.0) * (1.0 / 120.0), (60.0 - min_angle) * (1.0 / 60.0)),
        0.5 * signed,
    ]
}

/// `(atan(sqrt z) / sqrt z - 1) / z` on [0, tan(pi/8)^2], interpolated at Chebyshev nodes: its error
/// adds less than 1e-17 to the angle.
const ARCTANGENT: [f64; 11] = [
    -0.333_333_333_333_333_3,
    0.199_999_999_999_955_2,
    -0.142_857_142_856_665_42,
    0.111_111_110_152_563_61,
    -0.090_909_045_781_239_03,
    0.076_921_831_908_260_87,
    -0.066_645_114_473_819_48,
    0.058_581_489_128_022_1,
    -0.050_854_497_379_402_6,
    0.039_231_658_295_587_19,
    -0.019_176_887_119_062_26,
];

/// The angle, 0 to 180 degrees, whose sine and cosine are as `y >= 0` to `x`.
#[inline(always)]
fn angle(y: f64, x: f64) -> f64 {
    // Reduced to the first octant, then to half of it by tan(t - pi/4) = (tan t - 1)/(tan t + 1).
    let width = x.abs();
    let (low, high) = (smaller(width, y), larger(width, y));
    let is_wide = low > 0.414_213_562_373_095_03 * high;
    let q = if is_wide { low - high } else { low } / if is_wide { low + high } else { high };
    let z = q * q;
    let mut sum = ARCTANGENT[10];
    for i in (0..10).rev() {
        sum = sum * z + ARCTANGENT[i];
    }
    let octant = (q + q * z * sum) + if is_wide { FRAC_PI_4 } else { 0.0 };
    let quadrant = if y > width { FRAC_PI_2 - octant } else { octant };
    let half_turn = if x < 0.0 { PI - quadrant } else { quadrant };
    half_turn * (180.0 / PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: Q3
    #[test]
    fn angles_are_those_of_the_library() {
        for i in 0..=100_000 {
            let turn = f64::from(i) / 100_000.0 * PI;
            for size in [1.0, 1e-120, 1e120] {
                let (y, x) = (size * libm::sin(turn).abs(), size * libm::cos(turn));
                let wanted = libm::atan2(y, x).to_degrees();
                let got = angle(y, x);
                assert!((got - wanted).abs() <= 1e-13 * wanted.abs(), "{i}: {got}, not {wanted}");
            }
        }
        let exact = [(0.0, 1.0, 0.0), (1.0, 1.0, 45.0), (1.0, 0.0, 90.0), (1.0, -1.0, 135.0)];
        for (y, x, degrees) in exact {
            assert_eq!(angle(y, x), degrees);
        }
        assert_eq!(angle(0.0, -1.0), 180.0);
    }

    #[test]
    fn a_block_gives_what_single_triangles_give() {
        let mut block = Block::EMPTY;
        for i in 0..WIDTH {
            let a = 1.0 + i as f64;
            let shape = [a, a + 0.5, 1.25];
            (0..3).for_each(|k| block.edges[k][i] = shape[k]);
            block.doubled_area[i] = if i % 5 == 0 { 0.0 } else { 0.25 - a };
        }
        let columns = block.metrics();
        for i in 0..WIDTH {
            let edges = block.edges.map(|e| e[i]);
            let row = metrics(edges, block.doubled_area[i]);
            let bits = |values: [f64; OWN_METRICS]| values.map(f64::to_bits);
            assert_eq!(bits(columns.map(|c| c[i])), bits(row), "{i}");
        }
    }
}
