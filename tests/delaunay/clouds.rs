//! Point sets that are hard on a Delaunay triangulation, from a fixed generator.

use trigrade::point::Point2;

/// SplitMix64 (Steele, Lea, Flood 2014): a fixed sequence for each seed.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}

pub fn uniform(n: usize, seed: u64) -> Vec<Point2> {
    let mut random = Random::new(seed);
    (0..n).map(|_| Point2::new(random.unit(), random.unit())).collect()
}

pub fn clusters(n: usize, seed: u64) -> Vec<Point2> {
    let mut random = Random::new(seed);
    let centres = uniform(n.div_ceil(100).max(1), seed + 1);
    (0..n)
        .map(|i| {
            let c = centres[i % centres.len()];
            let (r, s) =
                (random.unit() * random.unit() * 1e-3, random.unit() * 1e-3 * random.unit());
            Point2::new(c.x + r, c.y - s)
        })
        .collect()
}

pub fn grid(side: usize, step: f64) -> Vec<Point2> {
    let at = |i: usize| Point2::new((i % side) as f64 * step, (i / side) as f64 * step);
    (0..side * side).map(at).collect()
}

pub fn circle(n: usize) -> Vec<Point2> {
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
    (0..n).map(|i| Point2::new(libm::cos(angle(i)), libm::sin(angle(i)))).collect()
}

pub fn two_circles(n: usize) -> Vec<Point2> {
    let mut points = circle(n / 2);
    points.extend(circle(n - n / 2).into_iter().map(|p| Point2::new(3.0 + p.x, p.y)));
    points
}

pub fn parabola(n: usize) -> Vec<Point2> {
    let at = |i: usize| i as f64 / n as f64 - 0.5;
    (0..n).map(|i| Point2::new(at(i), at(i) * at(i))).collect()
}

pub fn axis_cross(n: usize) -> Vec<Point2> {
    let at = |i: usize| (i / 2 + 1) as f64 * if i % 4 < 2 { 1.0 } else { -1.0 };
    (0..n)
        .map(|i| if i % 2 == 0 { Point2::new(at(i), 0.0) } else { Point2::new(0.0, at(i)) })
        .collect()
}

/// All but one on a line.
pub fn line_and_one(n: usize) -> Vec<Point2> {
    let mut points: Vec<_> = (1..n).map(|i| Point2::new(i as f64, 2.0 * i as f64)).collect();
    points.push(Point2::new(0.25, 1e-3));
    points
}

pub fn line(n: usize) -> Vec<Point2> {
    (0..n).map(|i| Point2::new(i as f64 * 0.5, 3.0 - i as f64)).collect()
}

/// Neighbouring floats around (0.5, 0.5) and (1, 1), where the unit in the last place changes.
pub fn ulps(side: u64, at: f64) -> Vec<Point2> {
    let shift = |i: u64| f64::from_bits(at.to_bits() - side / 2 + i);
    (0..side * side).map(|k| Point2::new(shift(k % side), shift(k / side))).collect()
}

pub fn spiral(n: usize) -> Vec<Point2> {
    (0..n)
        .map(|i| {
            let (angle, r) = (0.1 * i as f64, 1.0 + 0.01 * i as f64);
            Point2::new(r * libm::cos(angle), r * libm::sin(angle))
        })
        .collect()
}

/// Coordinates from 1e-310 to 1e300 side by side.
pub fn extremes() -> Vec<Point2> {
    let values = [-1e300, -1.0, -1e-310, 0.0, 5e-324, 1e-310, 1e-160, 1.0, 1e160, 1e300];
    values.iter().flat_map(|&x| values.iter().map(move |&y| Point2::new(x, y))).collect()
}

/// (name, points) of everything above with about `n` points, distinct.
pub fn all(n: usize) -> Vec<(&'static str, Vec<Point2>)> {
    let side = (n as f64).sqrt() as usize;
    vec![
        ("uniform", uniform(n, 1)),
        ("clusters", clusters(n, 2)),
        ("grid", grid(side, 1.0)),
        ("grid times 0.1", grid(side, 0.1)),
        ("circle", circle(n)),
        ("two circles", two_circles(n)),
        ("parabola", parabola(n)),
        ("axis cross", axis_cross(n)),
        ("line and one", line_and_one(n)),
        ("line", line(n)),
        ("ulps at 0.5", ulps(side as u64, 0.5)),
        ("ulps at 1", ulps(side as u64, 1.0)),
        ("spiral", spiral(n)),
        ("extremes", extremes()),
    ]
    .into_iter()
    .map(|(name, points)| (name, distinct(points)))
    .collect()
}

/// The points without repetitions, in order.
pub fn distinct(points: Vec<Point2>) -> Vec<Point2> {
    let mut seen = std::collections::HashSet::new();
    points.into_iter().filter(|p| seen.insert(p.key())).collect()
}
