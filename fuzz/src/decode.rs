//! From bytes to points: the awkward ones are likely, and every finite f64 is possible.

use arbitrary::Unstructured;
use trigrade::point::Point2;

/// Reads a fuzzer's bytes; when they run out, zeros follow.
pub struct Decoder<'a> {
    bytes: Unstructured<'a>,
}

impl<'a> Decoder<'a> {
    /// Over all of `bytes`.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes: Unstructured::new(bytes) }
    }

    /// A number below `end`.
    pub fn below(&mut self, end: u32) -> u32 {
        self.bytes.arbitrary::<u32>().unwrap_or(0) % end
    }

    /// A byte.
    pub fn byte(&mut self) -> u8 {
        self.bytes.arbitrary().unwrap_or(0)
    }

    /// Any finite float.
    pub fn finite(&mut self) -> f64 {
        let value = f64::from_bits(self.bytes.arbitrary().unwrap_or(0));
        // Of what is not finite, the sign and the mantissa are kept.
        if value.is_finite() { value } else { f64::from_bits(value.to_bits() & !(1 << 62)) }
    }

    /// A multiple of 1 in [-8, 8): many ties, many collinear points.
    fn lattice(&mut self) -> f64 {
        f64::from(self.byte() % 16) - 8.0
    }

    /// A few units in the last place beside `value`.
    fn nudged(&mut self, value: f64) -> f64 {
        match self.byte() % 8 {
            0 => value.next_up(),
            1 => value.next_down(),
            2 => value.next_up().next_up(),
            _ => value,
        }
    }

    /// A point; `before` are the points so far, from which the near-degenerate ones are made.
    pub fn point(&mut self, before: &[Point2]) -> Point2 {
        let kind = self.byte() % 8;
        let (x, y) = match (kind, before) {
            (0, _) => (self.finite(), self.finite()),
            (1, _) => {
                // A lattice far from the origin, or tiny, or huge.
                let scale = libm::ldexp(1.0, self.below(2000) as i32 - 1000);
                let (x, y) = (self.lattice() * scale, self.lattice() * scale);
                (self.nudged(x), self.nudged(y))
            }
            (2 | 3, [.., a, b]) => {
                let t = f64::from(self.byte()) / 64.0 - 1.0;
                let (x, y) = (a.x + t * (b.x - a.x), a.y + t * (b.y - a.y));
                (self.nudged(x), self.nudged(y))
            }
            (4, [.., a, b, c]) => {
                // The fourth corner of a parallelogram: cocircular when it is a rectangle.
                let (x, y) = (a.x + c.x - b.x, a.y + c.y - b.y);
                (self.nudged(x), self.nudged(y))
            }
            _ => (self.lattice(), self.lattice()),
        };
        let finite = |value: f64| if value.is_finite() { value } else { 0.0 };
        Point2::new(finite(x), finite(y))
    }

    /// Up to `count_max` points.
    pub fn points(&mut self, count_max: u32) -> Vec<Point2> {
        let mut points = Vec::new();
        for _ in 0..self.below(count_max + 1) {
            let next = self.point(&points);
            points.push(next);
        }
        points
    }
}
