//! Boundaries below the graph of a function: near-collinear chains, needles, jumps, near-duplicates.
//!
//! Valid because the upper chain runs with strictly rising x above the lower edge, so it is a
//! function's graph, and nothing else lies between.

use super::Family;
use super::draft::Draft;
use super::lattice::Site;
use crate::torture::prng::Prng;

/// Vertices within a unit of a long slanted line.
pub(super) const NEAR_COLLINEAR: Family = Family::valid(
    "near-collinear",
    "a chain of vertices that deviate from a slanted line by a unit or not at all",
    near_collinear,
);
/// Needles of a unit's width.
pub(super) const NEEDLES: Family =
    Family::valid("needles", "spikes one to three units wide and up to 2^40 high", needles);
/// Edges of 1 and of 2^40 side by side.
pub(super) const JUMPS: Family =
    Family::valid("jumps", "neighbouring edges whose lengths differ by up to 1e12", jumps);
/// Pairs of vertices a unit apart.
pub(super) const NEAR_DUPLICATES: Family = Family::valid(
    "near-duplicates",
    "pairs of vertices, and of isolated points, one unit apart on a large boundary",
    near_duplicates,
);
/// A band a unit high.
pub(super) const ZIPPER: Family =
    Family::valid("zipper", "two sawtooth chains one unit above each other", zipper);

/// Closes an upper chain of rising x by a flat floor `depth` below its lowest vertex.
fn close(mut chain: Vec<Site>, depth: i64) -> Vec<Site> {
    let floor = chain.iter().map(|s| s[1]).min().unwrap_or(0) - depth;
    let (first, last) = (chain[0][0], chain[chain.len() - 1][0]);
    chain.reverse();
    chain.extend([[first, floor], [last, floor]]);
    chain
}

fn near_collinear(prng: &mut Prng, size: usize) -> Draft {
    let step = [prng.magnitude(24), prng.range(-(1 << 24), 1 << 24)];
    let chain: Vec<Site> =
        (0..size as i64).map(|i| [i * step[0], i * step[1] + prng.range(-1, 1)]).collect();
    let width = size as i64 * step[0];
    Draft::ring(close(chain, 1 + prng.range(0, width)))
}

fn needles(prng: &mut Prng, size: usize) -> Draft {
    let high = 4 + prng.below(37) as u32;
    let (mut x, mut chain) = (0, Vec::new());
    for i in 0..2 * size + 1 {
        let y = if i % 2 == 0 { prng.range(0, 2) } else { prng.magnitude(high) };
        chain.push([x, y]);
        x += prng.range(1, 3);
    }
    Draft::ring(close(chain, prng.magnitude(high)))
}

fn jumps(prng: &mut Prng, size: usize) -> Draft {
    let bits = 5 + prng.below(36) as u32;
    let (mut x, mut chain) = (0, Vec::new());
    for _ in 0..size.clamp(3, 400) {
        let (high, wide) = (*prng.pick(&[3, bits]), *prng.pick(&[2, bits]));
        chain.push([x, prng.magnitude(high)]);
        x += prng.magnitude(wide);
    }
    Draft::ring(close(chain, prng.magnitude(bits)))
}

fn near_duplicates(prng: &mut Prng, size: usize) -> Draft {
    let (mut x, mut chain) = (0, Vec::new());
    for _ in 0..size.max(2) {
        let y = prng.range(0, 1 << 20);
        chain.extend([[x, y], [x + 1, y + prng.range(-1, 1)]]);
        x += prng.range(1 << 10, 1 << 20);
    }
    let (floor, width) = (1 << 20, x - (1 << 10));
    let mut draft = Draft::ring(close(chain, floor));
    // Isolated pairs on two lines well between the floor and the chain.
    for i in 0..prng.below(5) as i64 {
        let at = [1 + i * (width / 8).max(4), -(floor / 2)];
        draft.points.extend([at, [at[0] + prng.range(0, 1), at[1] + 1]]);
    }
    draft.points.sort_unstable();
    draft.points.dedup();
    draft
}

fn zipper(prng: &mut Prng, size: usize) -> Draft {
    let bits = 1 + prng.below(30) as u32;
    let (mut x, mut low) = (0, Vec::new());
    for _ in 0..size.max(2) {
        low.push([x, prng.magnitude(bits)]);
        x += prng.magnitude(4);
    }
    let high: Vec<Site> = low.iter().rev().map(|s| [s[0], s[1] + 1]).collect();
    Draft::ring(low.into_iter().chain(high).collect())
}
