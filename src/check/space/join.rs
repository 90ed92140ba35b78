//! Finding the pairs of triangles whose boxes meet: a tree of boxes over the Morton order, joined
//! with itself.
//!
//! Boxes are kept in single precision. The map from coordinates to floats is monotone (each rounded
//! operation is), so boxes that are disjoint in the image are disjoint: no pair is missed, and no
//! rounding needs to be undone.

use super::intersect::Space;
use rayon::prelude::*;
use std::cell::LazyCell;

/// Triangles per leaf.
const LEAF: usize = 4;
/// Improper meetings counted per triangle with triangles that follow it in the tree; bounds the
/// answer for surfaces in which everything meets everything.
const MEETINGS_MAX: usize = 64;

/// Lower and upper corner of a closed box; a fourth coordinate, all 0, makes four comparisons one.
type Corners = [[f32; 4]; 2];

const NOWHERE: Corners = [[f32::INFINITY; 4], [f32::NEG_INFINITY; 4]];

#[inline]
fn meet(a: &Corners, b: &Corners) -> bool {
    (0..4).fold(true, |all, k| all & (a[0][k] <= b[1][k]) & (b[0][k] <= a[1][k]))
}

fn join(a: Corners, b: &Corners) -> Corners {
    [std::array::from_fn(|k| a[0][k].min(b[0][k])), std::array::from_fn(|k| a[1][k].max(b[1][k]))]
}

/// A monotone map of coordinates to floats, about [-1, 1] for the triangles' points.
struct Frame {
    middle: [f64; 3],
    exponent: i32,
}

impl Frame {
    fn of(space: &Space<'_>, triangles: &[[u32; 3]]) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in triangles.iter().flatten().map(|&v| space.point(v)) {
            for k in 0..3 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        let extent = (0..3).map(|k| high[k] / 2.0 - low[k] / 2.0).fold(0.0, f64::max);
        Self {
            middle: std::array::from_fn(|k| low[k] / 2.0 + high[k] / 2.0),
            exponent: if extent > 0.0 { libm::ilogb(extent) + 1 } else { 0 },
        }
    }

    fn map(&self, p: [f64; 3]) -> [f32; 4] {
        // Halves cannot overflow.
        let [x, y, z] = std::array::from_fn(|k| {
            let half = p[k] / 2.0 - self.middle[k] / 2.0;
            crate::check::ldexp(half, 1 - self.exponent) as f32
        });
        [x, y, z, 0.0]
    }
}

/// The 63-bit Morton code of a place in [-1, 1]^3.
fn morton(corners: &Corners) -> u64 {
    let spread = |x: u64| {
        let x = (x | x << 32) & 0x001f_0000_0000_ffff;
        let x = (x | x << 16) & 0x001f_0000_ff00_00ff;
        let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
        let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
        (x | x << 2) & 0x1249_2492_4924_9249
    };
    (0..3).fold(0, |code, k| {
        let middle = f64::from(corners[0][k]) + f64::from(corners[1][k]);
        // -2..2 becomes 0..2^21; `as` saturates.
        let cell = ((middle + 2.0) * f64::from(1 << 19)) as u64;
        code | spread(cell.min((1 << 21) - 1)) << k
    })
}

/// A complete binary tree of boxes, node 1 on top, over triangles in Morton order.
struct Boxes {
    nodes: Vec<Corners>,
    items: Vec<(Corners, u32)>,
    leaves: usize,
}

impl Boxes {
    fn new(space: &Space<'_>, triangles: &[[u32; 3]], skip: &[u32]) -> Self {
        let frame = Frame::of(space, triangles);
        let bounds = |t: u32| {
            let corners = triangles[t as usize].map(|v| frame.map(space.point(v)));
            corners.iter().fold(NOWHERE, |b, &p| join(b, &[p, p]))
        };
        let wanted = (0..triangles.len() as u32).filter(|t| skip.binary_search(t).is_err());
        let mut order: Vec<(u64, u32)> =
            wanted.collect::<Vec<_>>().into_par_iter().map(|t| (morton(&bounds(t)), t)).collect();
        order.par_sort_unstable();
        let items: Vec<(Corners, u32)> =
            order.into_par_iter().map(|(_, t)| (bounds(t), t)).collect();
        let leaves = items.len().div_ceil(LEAF).next_power_of_two();
        let mut boxes = Self { nodes: vec![NOWHERE; 2 * leaves], items, leaves };
        for node in (1..2 * leaves).rev() {
            boxes.nodes[node] = if node >= leaves {
                boxes.leaf(node).iter().fold(NOWHERE, |b, item| join(b, &item.0))
            } else {
                join(boxes.nodes[2 * node], &boxes.nodes[2 * node + 1])
            };
        }
        boxes
    }

    /// The triangles of a leaf; leaves share them out evenly.
    fn leaf(&self, node: usize) -> &[(Corners, u32)] {
        // There are fewer than 2^32 triangles, and no more leaves: no product overflows.
        let (count, i) = (self.items.len() as u64, (node - self.leaves) as u64);
        let cut = |i: u64| ((i * count) >> self.leaves.trailing_zeros()) as usize;
        &self.items[cut(i)..cut(i + 1)]
    }

    /// Calls `visit` with all pairs of nodes, at or below two given ones, that are leaves whose
    /// boxes meet.
    fn leaf_pairs(&self, a: usize, b: usize, visit: &mut impl FnMut(usize, usize)) {
        let mut work = vec![(a, b)];
        while let Some((a, b)) = work.pop() {
            if !meet(&self.nodes[a], &self.nodes[b]) {
                continue;
            }
            match (a >= self.leaves, a == b) {
                (true, _) => visit(a, b),
                (false, true) => {
                    work.extend([(2 * a + 1, 2 * a + 1), (2 * a, 2 * a + 1), (2 * a, 2 * a)]);
                }
                (false, false) => {
                    let pairs = [(1, 1), (1, 0), (0, 1), (0, 0)];
                    work.extend(pairs.map(|(i, j)| (2 * a + i, 2 * b + j)));
                }
            }
        }
    }
}

/// What one piece of the join found.
#[derive(Default)]
struct Found {
    tests: u64,
    pairs: Vec<[u32; 2]>,
}

/// Number of exact tests, and the pairs of triangles that meet in more than a common corner or edge,
/// sorted; the triangles to `skip` (sorted) have no area and are left out.
pub(super) fn intersecting_pairs(
    space: &Space<'_>,
    triangles: &[[u32; 3]],
    skip: &[u32],
) -> (u64, Vec<[u32; 2]>) {
    let boxes = Boxes::new(space, triangles, skip);
    // Pairs of nodes on one level are the pieces of work: the same for any number of threads.
    let level = boxes.leaves.min(64);
    let mut pieces = Vec::new();
    for a in level..2 * level {
        pieces.extend(
            (a..2 * level).filter(|&b| meet(&boxes.nodes[a], &boxes.nodes[b])).map(|b| (a, b)),
        );
    }
    let found: Vec<Found> =
        pieces.par_iter().map(|&(a, b)| examine(&boxes, (a, b), space, triangles)).collect();
    let mut pairs: Vec<[u32; 2]> = found.iter().flat_map(|f| &f.pairs).copied().collect();
    pairs.sort_unstable();
    (found.iter().map(|f| f.tests).sum(), pairs)
}

fn examine(
    boxes: &Boxes,
    (a, b): (usize, usize),
    space: &Space<'_>,
    triangles: &[[u32; 3]],
) -> Found {
    let mut found = Found::default();
    let mut met: std::collections::BTreeMap<u32, usize> = std::collections::BTreeMap::new();
    boxes.leaf_pairs(a, b, &mut |a, b| {
        for (i, (bounds, t)) in boxes.leaf(a).iter().enumerate() {
            let axis = LazyCell::new(|| space.facing_axis(triangles[*t as usize]));
            let others = if a == b { &boxes.leaf(b)[i + 1..] } else { boxes.leaf(b) };
            for (other, u) in others {
                if !meet(bounds, other) || met.get(t).is_some_and(|&m| m >= MEETINGS_MAX) {
                    continue;
                }
                found.tests += 1;
                let [s, u_corners] = [*t, *u].map(|t| triangles[t as usize]);
                if space.meet_improperly(*axis, s, u_corners) {
                    found.pairs.push([*t.min(u), *t.max(u)]);
                    *met.entry(*t).or_default() += 1;
                }
            }
        }
    });
    found
}
