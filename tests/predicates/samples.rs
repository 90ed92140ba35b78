//! Quadruples of points of every class that has ever broken a predicate, from a seed.

use trigrade::point::Point2;

pub type Quad = [Point2; 4];

type Class = fn(&mut Random) -> Quad;

/// SplitMix64 (Steele, Lea and Flood 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    pub fn below(&mut self, bound: u64) -> u64 {
        self.next() % bound
    }

    /// In [-1, 1).
    pub fn coordinate(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Any finite float, every exponent as likely.
    pub fn finite(&mut self) -> f64 {
        let value = f64::from_bits(self.next());
        if value.is_finite() { value } else { 0.0 }
    }
}

fn each(mut coordinate: impl FnMut() -> f64) -> Quad {
    std::array::from_fn(|_| Point2::new(coordinate(), coordinate()))
}

fn ulps(value: f64, steps: i64) -> f64 {
    f64::from_bits(value.to_bits().wrapping_add_signed(steps))
}

/// Every coordinate moved by at most two ulps.
fn shaken(random: &mut Random, quad: Quad) -> Quad {
    let mut shake = |v: f64| if v == 0.0 { v } else { ulps(v, random.below(5) as i64 - 2) };
    quad.map(|p| Point2::new(shake(p.x), shake(p.y)))
}

/// Times a power of two, which is exact unless it underflows.
pub fn scaled(quad: Quad, exponent: i32) -> Quad {
    let halves = [exponent / 2, exponent - exponent / 2].map(|half| 2.0_f64.powi(half));
    quad.map(|p| Point2::new(p.x * halves[0] * halves[1], p.y * halves[0] * halves[1]))
}

fn grid(random: &mut Random) -> Quad {
    each(|| random.below(8) as f64)
}

fn circle(random: &mut Random) -> Quad {
    std::array::from_fn(|_| {
        let angle = std::f64::consts::PI * random.coordinate();
        Point2::new(libm::cos(angle), libm::sin(angle))
    })
}

/// Exactly cocircular integers: 5^2 13^2 = 65^2 = 16^2 + 63^2 = 33^2 + 56^2 = 25^2 + 60^2 = 39^2 + 52^2.
fn cocircular(random: &mut Random) -> Quad {
    std::array::from_fn(|_| {
        let [x, y] = [[16.0, 63.0], [33.0, 56.0], [25.0, 60.0], [39.0, 52.0], [65.0, 0.0]]
            [random.below(5) as usize];
        let signs = random.below(8);
        let flip = |v: f64, bit: u64| if signs & bit == 0 { v } else { -v };
        let (x, y) = if signs & 4 == 0 { (x, y) } else { (y, x) };
        Point2::new(flip(x, 1), flip(y, 2))
    })
}

/// Cocircular integers of up to 50 bits, so that every width of arithmetic meets its limit, one of them
/// off by at most one.
fn any_width(random: &mut Random) -> Quad {
    let factor = (random.next() >> (21 + random.below(43))) as f64;
    let nudge = random.below(3) as f64 - 1.0;
    let [a, b, c, d] = cocircular(random).map(|p| Point2::new(p.x * factor, p.y * factor));
    [a, b, c, Point2::new(d.x + nudge, d.y)]
}

fn near_collinear(random: &mut Random) -> Quad {
    let (slope, offset) = (random.coordinate(), random.coordinate());
    std::array::from_fn(|_| {
        let x = random.coordinate();
        Point2::new(x, slope * x + offset)
    })
}

/// Ordinary coordinates beside some many powers of two smaller.
fn two_scales(random: &mut Random) -> Quad {
    let gap = -(random.below(140) as i32);
    each(|| {
        let value = random.coordinate();
        if random.below(2) == 0 { value } else { value * 2.0_f64.powi(gap) }
    })
}

/// The members of a tiny cloud far from the origin.
fn ulp_cloud(random: &mut Random) -> Quad {
    let (x, y) = (random.coordinate() * 1e6, random.coordinate());
    std::array::from_fn(|_| {
        Point2::new(ulps(x, random.below(7) as i64), ulps(y, random.below(7) as i64))
    })
}

/// Subnormals, zero and the greatest numbers.
fn extremes(random: &mut Random) -> Quad {
    let chosen = [0.0, 5e-324, 1e-310, f64::MIN_POSITIVE, 1e-200, 1.0, 1e200, 1e300, f64::MAX];
    each(|| {
        let value = chosen[random.below(9) as usize];
        if random.below(2) == 0 { value } else { -value }
    })
}

/// Names and members of one sample of each class: plain, shaken by ulps and scaled anywhere.
pub fn every_class(random: &mut Random) -> Vec<(&'static str, Quad)> {
    let mut found = Vec::new();
    let near_degenerate: [(&'static str, Class); 5] = [
        ("grid", grid),
        ("circle", circle),
        ("cocircular", cocircular),
        ("near-collinear", near_collinear),
        ("two scales", two_scales),
    ];
    for (name, class) in near_degenerate {
        let quad = class(random);
        found.push((name, quad));
        found.push((name, shaken(random, quad)));
        found.push((name, scaled(quad, random.below(2090) as i32 - 1074)));
        let tenths = quad.map(|p| Point2::new(p.x * 0.1, p.y * 0.1));
        found.push((name, tenths));
        found.push((name, scaled(shaken(random, tenths), random.below(2090) as i32 - 1074)));
    }
    found.push(("any width", any_width(random)));
    found.push(("ulp cloud", ulp_cloud(random)));
    found.push(("extremes", extremes(random)));
    found.push(("any float", each(|| random.finite())));
    let [a, b, ..] = found[random.below(25) as usize].1;
    let [.., c, d] = each(|| random.finite());
    found.push(("half ordinary, half any float", [a, b, c, d]));
    found.retain(|(_, quad)| quad.iter().all(|p| p.is_finite()));
    found
}
