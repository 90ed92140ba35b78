//! Spatial sorting: orders of the points in which neighbours follow each other.

use crate::point::Point2;

/// Maps coordinates to integers below 2^31, monotone in each coordinate: of two points the one with
/// the larger integer has strictly the larger coordinate. Rounding is monotone, so that holds for
/// any finite input, and engines may cut a point set between two cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lattice {
    x: Axis,
    y: Axis,
}

/// One coordinate: `(v * before - low) * scale`.
#[derive(Clone, Copy, Debug)]
struct Axis {
    /// A power of two that keeps the difference from overflowing and the scale from doing so.
    before: f64,
    low: f64,
    scale: f64,
}

/// Bits of a cell's coordinate.
pub(crate) const CELL_BITS: u32 = 31;
const CELLS: f64 = (1_u32 << CELL_BITS) as f64;

impl Axis {
    fn over(low: f64, high: f64) -> Self {
        let width = high - low;
        let before = if width.is_infinite() {
            0.25
        } else if width > 0.0 && width < 1e-200 {
            // Both ends are below 2^54 widths, so this cannot overflow.
            (2.0_f64).powi(600)
        } else {
            1.0
        };
        let (low, high) = (low * before, high * before);
        let scale = if high > low { CELLS / (high - low) } else { 0.0 };
        Self { before, low, scale }
    }

    #[inline(always)]
    fn cell(&self, v: f64) -> u32 {
        (((v * self.before - self.low) * self.scale) as u32).min((1 << CELL_BITS) - 1)
    }
}

impl Lattice {
    /// The lattice over the bounding box of `points` (finite, or none).
    pub(crate) fn over(points: &[Point2]) -> Self {
        let first = points.first().copied().unwrap_or(Point2::new(0.0, 0.0));
        let (mut low, mut high) = (first, first);
        for p in points {
            low = Point2::new(low.x.min(p.x), low.y.min(p.y));
            high = Point2::new(high.x.max(p.x), high.y.max(p.y));
        }
        Self { x: Axis::over(low.x, high.x), y: Axis::over(low.y, high.y) }
    }

    /// The level at which the cells of two points part: see [`level`].
    #[inline(always)]
    pub(crate) fn level(&self, p: Point2, q: Point2) -> u32 {
        level(self.cell(p), self.cell(q))
    }

    /// The cell of a point of the box.
    #[inline(always)]
    pub(crate) fn cell(&self, p: Point2) -> [u32; 2] {
        [self.x.cell(p.x), self.y.cell(p.y)]
    }
}

/// Level of the tree of the Morton curve at which two cells part, counted from the finest: 0 for
/// the same cell, else odd if they part by x and even if by y.
#[inline(always)]
fn level([x, y]: [u32; 2], [u, v]: [u32; 2]) -> u32 {
    let by_x = 2 * (32 - (x ^ u).leading_zeros());
    let by_y = 2 * (32 - (y ^ v).leading_zeros());
    // x is the upper of two bits, so it decides where both differ from the same bit on.
    if by_x >= by_y { (by_x + 1) * u32::from(by_x > 0) } else { by_y }
}

/// Position of a cell along the Hilbert curve through 2^31 x 2^31 cells.
pub(crate) fn hilbert([mut x, mut y]: [u32; 2]) -> u64 {
    let mut key = 0_u64;
    let mut bit = 1_u32 << (CELL_BITS - 1);
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
    let lattice = Lattice::over(points);
    let mut keyed: Vec<(u64, u32)> =
        points.iter().zip(0..).map(|(&p, i)| (hilbert(lattice.cell(p)), i)).collect();
    keyed.sort_unstable_by(|a, b| {
        a.0.cmp(&b.0)
            .then_with(|| points[a.1 as usize].lexicographic(points[b.1 as usize]))
            .then(a.1.cmp(&b.1))
    });
    keyed.into_iter().map(|(_, i)| i).collect()
}

/// Position of a cell along the Morton curve: bits of x and y in turn, x first.
pub(crate) fn morton([x, y]: [u32; 2]) -> u64 {
    (spread(x) << 1) | spread(y)
}

/// Puts a zero before every bit.
fn spread(v: u32) -> u64 {
    let mut v = u64::from(v);
    v = (v | (v << 16)) & 0x0000_FFFF_0000_FFFF;
    v = (v | (v << 8)) & 0x00FF_00FF_00FF_00FF;
    v = (v | (v << 4)) & 0x0F0F_0F0F_0F0F_0F0F;
    v = (v | (v << 2)) & 0x3333_3333_3333_3333;
    (v | (v << 1)) & 0x5555_5555_5555_5555
}

/// Distinct points along the Morton curve.
pub(crate) struct Sorted {
    /// Indices in the input, the lowest among equals; points of one cell in lexicographic order.
    pub(crate) index: Vec<u32>,
    /// (dropped, kept): input indices of repeated points.
    pub(crate) repeated: Vec<[u32; 2]>,
    /// The lattice of the cells.
    pub(crate) lattice: Lattice,
}

/// Sorts finite points along the Morton curve and merges equal ones.
pub(crate) fn morton_sort(points: &[Point2]) -> Sorted {
    let lattice = Lattice::over(points);
    // The upper 32 bits of the key, by radix; the few ties after that by comparison.
    let key = |p: Point2| (morton(lattice.cell(p)) >> (2 * CELL_BITS - 32)) as u32;
    let mut keyed: Vec<[u32; 2]> = points.iter().zip(0..).map(|(&p, i)| [key(p), i]).collect();
    radix_sort(&mut keyed);
    sort_ties(&mut keyed, points, &lattice);
    let repeated = merge_equal(&mut keyed, points);
    let index = keyed.into_iter().map(|[_, i]| i).collect();
    Sorted { index, repeated, lattice }
}

const DIGIT_BITS: u32 = 11;
const DIGITS: usize = 1 << DIGIT_BITS;

/// Stable least-significant-digit radix sort by the first component, in three passes.
fn radix_sort(items: &mut Vec<[u32; 2]>) {
    let mut counts = [[0_u32; DIGITS]; 3];
    let digit = |key: u32, pass: usize| (key >> (DIGIT_BITS * pass as u32)) as usize % DIGITS;
    for &[key, _] in items.iter() {
        for pass in 0..3 {
            counts[pass][digit(key, pass)] += 1;
        }
    }
    let mut other = vec![[0; 2]; items.len()];
    for (pass, count) in counts.iter_mut().enumerate() {
        if count.iter().any(|&c| c as usize == items.len()) {
            continue;
        }
        let mut start = 0;
        for c in count.iter_mut() {
            start += std::mem::replace(c, start);
        }
        for &item in items.iter() {
            let place = &mut count[digit(item[0], pass)];
            other[*place as usize] = item;
            *place += 1;
        }
        std::mem::swap(items, &mut other);
    }
}

/// Orders items of equal radix key by their whole key, then by coordinates, then by index.
fn sort_ties(items: &mut [[u32; 2]], points: &[Point2], lattice: &Lattice) {
    let at = |item: &[u32; 2]| points[item[1] as usize];
    for run in items.chunk_by_mut(|a, b| a[0] == b[0]).filter(|run| run.len() > 1) {
        run.sort_unstable_by(|a, b| {
            let key = |item| morton(lattice.cell(at(item)));
            key(a).cmp(&key(b)).then_with(|| at(a).lexicographic(at(b))).then(a[1].cmp(&b[1]))
        });
    }
}

/// Drops all but the first of equal neighbours, which have equal keys; `[dropped, kept]` of each.
fn merge_equal(items: &mut Vec<[u32; 2]>, points: &[Point2]) -> Vec<[u32; 2]> {
    let mut repeated = Vec::new();
    items.dedup_by(|later, first| {
        let is_equal =
            later[0] == first[0] && points[later[1] as usize] == points[first[1] as usize];
        if is_equal {
            repeated.push([later[1], first[1]]);
        }
        is_equal
    });
    repeated.sort_unstable();
    repeated
}
