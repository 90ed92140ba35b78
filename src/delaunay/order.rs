//! Spatial sorting: an order of the points in which neighbours follow each other.

use crate::point::Point2;

/// Maps coordinates to integers below 2^31, monotone in each coordinate: a point with the larger
/// integer has strictly the larger coordinate. That holds for any finite input, since rounding is
/// monotone; the decisions of an engine never depend on it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    low: Point2,
    /// Applied before subtracting, so that the difference cannot overflow.
    shrink: f64,
    scale: Point2,
}

const CELLS: f64 = (1_u32 << 31) as f64;

impl Lattice {
    /// The lattice over the bounding box of `points` (finite).
    pub(crate) fn over(points: impl Iterator<Item = Point2>) -> Self {
        let mut low = Point2::new(f64::INFINITY, f64::INFINITY);
        let mut high = Point2::new(f64::NEG_INFINITY, f64::NEG_INFINITY);
        for p in points {
            low = Point2::new(low.x.min(p.x), low.y.min(p.y));
            high = Point2::new(high.x.max(p.x), high.y.max(p.y));
        }
        let fits = (high.x - low.x).is_finite() && (high.y - low.y).is_finite();
        let shrink = if fits { 1.0 } else { 0.25 };
        let scale = |low: f64, high: f64| {
            let scale = CELLS / (high * shrink - low * shrink);
            if scale.is_finite() { scale } else { f64::MAX }
        };
        let scale = Point2::new(scale(low.x, high.x), scale(low.y, high.y));
        Self { low: Point2::new(low.x * shrink, low.y * shrink), shrink, scale }
    }

    /// The cell of a point of the box. The casts saturate: NaN (0 x infinity cannot arise) to 0.
    pub(crate) fn cell(&self, p: Point2) -> [u32; 2] {
        let cell = |v: f64, low: f64, scale: f64| {
            (((v * self.shrink - low) * scale) as u32).min((1 << 31) - 1)
        };
        [cell(p.x, self.low.x, self.scale.x), cell(p.y, self.low.y, self.scale.y)]
    }
}

/// Position of a lattice cell along the Hilbert curve through 2^31 x 2^31 cells.
pub(crate) fn hilbert([mut x, mut y]: [u32; 2]) -> u64 {
    let mut key = 0_u64;
    let mut bit = 1_u32 << 30;
    while bit > 0 {
        let (right, up) = (u64::from(x & bit != 0), u64::from(y & bit != 0));
        key = (key << 2) | ((3 * right) ^ up);
        if up == 0 {
            if right == 1 {
                x = !x;
                y = !y;
            }
            std::mem::swap(&mut x, &mut y);
        }
        bit >>= 1;
    }
    key
}

/// The indices of `points` along a Hilbert curve, equal cells by coordinates: the same points in
/// another order give the same sequence of points.
pub(crate) fn hilbert_order(points: &[Point2]) -> Vec<u32> {
    let lattice = Lattice::over(points.iter().copied());
    let mut keyed: Vec<(u64, u32)> =
        points.iter().zip(0..).map(|(&p, i)| (hilbert(lattice.cell(p)), i)).collect();
    keyed.sort_unstable_by(|a, b| {
        a.0.cmp(&b.0)
            .then_with(|| points[a.1 as usize].lexicographic(points[b.1 as usize]))
            .then(a.1.cmp(&b.1))
    });
    keyed.into_iter().map(|(_, i)| i).collect()
}
