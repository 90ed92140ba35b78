//! Gaps and clearances far below one unit, slivers and fans of tiny angles.
//!
//! For a primitive vector d the nearest lattice line parallel to it passes at 1 / |d|
//! ([`nearest_left`]). Shapes on both sides of such a pair of lines are disjoint, by the sign of one
//! determinant, however close they are.

use super::Family;
use super::draft::{Draft, rectangle};
use super::lattice::{Site, gcd, nearest_left};
use crate::domain::LoopRole;
use crate::torture::prng::Prng;

/// Holes with a slanted gap between them.
pub(super) const GAPS: Family = Family::valid(
    "gaps",
    "stacked holes whose parallel sides are 1 / length apart, often below a unit in the last place",
    gaps,
);
/// A triangle of area 1/2.
pub(super) const SLIVER: Family =
    Family::valid("sliver", "a triangle of area 1/2 with sides up to 2^40", sliver);
/// Interior segments at tiny angles.
pub(super) const FAN: Family =
    Family::valid("fan", "interior segments that leave one vertex at angles down to 1e-12", fan);

/// A primitive vector with both coordinates in 2 ..= 2^bits; `bits` is at least 2.
pub(super) fn primitive(prng: &mut Prng, bits: u32) -> Site {
    loop {
        let d = [1 + prng.magnitude(bits), 1 + prng.magnitude(bits)];
        if gcd(d[0], d[1]) == 1 {
            return d;
        }
    }
}

fn sum(a: Site, b: Site) -> Site {
    [a[0] + b[0], a[1] + b[1]]
}

/// The k-th slab lies where det(d, x) is between k (|d|^2 + 1) and that plus |d|^2.
fn gaps(prng: &mut Prng, size: usize) -> Draft {
    let bits = 2 + prng.below(22) as u32;
    let d = primitive(prng, bits);
    let (thick, gap) = ([-d[1], d[0]], nearest_left(d));
    let mut slabs = Draft::default();
    let mut base = [0, 0];
    for _ in 0..2 + size.min(12) / 3 {
        let (top, role) = (sum(base, thick), LoopRole::HoleOf(0));
        slabs.add(vec![base, sum(base, d), sum(top, d), top], role);
        base = sum(top, gap);
    }
    let margin = prng.range(1, 1 + 2 * d[0]);
    slabs.move_to([margin, margin]);
    let [_, high] = slabs.bounds();
    let mut draft = Draft::ring(rectangle([0, 0], [high[0] + margin, high[1] + margin]));
    draft.rings[0].role = LoopRole::Outer;
    draft.rings.append(&mut slabs.rings);
    draft
}

fn sliver(prng: &mut Prng, _size: usize) -> Draft {
    let bits = 2 + prng.below(39) as u32;
    let d = primitive(prng, bits);
    Draft::ring(vec![[0, 0], d, nearest_left(d)])
}

/// All segments leave the corner (0, 0) of a square for different directions.
fn fan(prng: &mut Prng, size: usize) -> Draft {
    let bits = 4 + prng.below(18) as u32;
    let d = primitive(prng, bits);
    let w = nearest_left(d);
    let count = 1 + size.min(60) as i64;
    // d + k w and its neighbour d + (k + 1) w span a triangle of area 1/2.
    let tips: Vec<Site> = (0..count).map(|k| [d[0] + k * w[0], d[1] + k * w[1]]).collect();
    let reach = tips.iter().flatten().max().copied().unwrap_or(1);
    let mut draft = Draft::square(reach + prng.range(1, reach));
    draft.segments = tips.into_iter().map(|tip| [[0, 0], tip]).collect();
    draft
}
