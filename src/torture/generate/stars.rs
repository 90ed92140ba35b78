//! Star-shaped and cocircular boundaries.
//!
//! Valid because the vertices follow each other around the origin by exact angles less than half a
//! turn apart, so every ray from the origin meets the ring once.

use super::Family;
use super::draft::Draft;
use super::lattice::{Site, by_angle, gcd, turn};
use crate::domain::LoopRole;
use crate::torture::prng::Prng;

/// Stars.
pub(super) const STARS: Family =
    Family::valid("stars", "star-shaped polygons whose radii differ by up to 1e12", stars);
/// Points exactly on circles.
pub(super) const COCIRCULAR: Family = Family::valid(
    "cocircular",
    "polygons with all vertices exactly on one circle, rings of them, and the centre",
    cocircular,
);

/// Primitive directions with coordinates up to `reach`, counterclockwise, no two the same.
fn directions(reach: i64) -> Vec<Site> {
    let axis = -reach..=reach;
    let mut all: Vec<Site> = axis
        .clone()
        .flat_map(|x| axis.clone().map(move |y| [x, y]))
        .filter(|&[x, y]| (x, y) != (0, 0) && gcd(x, y) == 1)
        .collect();
    all.sort_by(|&a, &b| by_angle(a, b));
    all
}

/// Whether each direction lies less than half a turn after the one before.
fn goes_around(ring: &[Site]) -> bool {
    let n = ring.len();
    n >= 3 && (0..n).all(|i| turn([0, 0], ring[i], ring[(i + 1) % n]).is_gt())
}

/// Some of the directions; those along the axes stay, so that none is half a turn away.
fn some(all: &[Site], count: usize, prng: &mut Prng) -> Vec<Site> {
    let share = (all.len() / count.max(1)).max(1) as u64;
    let is_kept = |s: &Site| s[0] == 0 || s[1] == 0 || prng.one_in(share);
    all.iter().copied().filter(is_kept).collect()
}

fn stars(prng: &mut Prng, size: usize) -> Draft {
    let reach = 2 + (size as i64 / 8).min(12);
    let bits = 1 + prng.below(40) as u32;
    let ring = some(&directions(reach), size, prng);
    debug_assert!(goes_around(&ring));
    let far = |[x, y]: Site| {
        let r = prng.magnitude(bits);
        [x * r, y * r]
    };
    Draft::ring(ring.into_iter().map(far).collect())
}

/// Sites on the circle x^2 + y^2 = r^2, counterclockwise.
fn circle(r: i64) -> Vec<Site> {
    let root = |n: i64| {
        let near = (n as f64).sqrt() as i64;
        (near - 1..=near + 1).find(|&y| y >= 0 && y * y == n)
    };
    let mut all: Vec<Site> = (-r..=r)
        .filter_map(|x| Some((x, root(r * r - x * x)?)))
        .flat_map(|(x, y)| [[x, y], [x, -y]])
        .collect();
    all.sort_by(|&a, &b| by_angle(a, b));
    all.dedup();
    all
}

/// Radii with many Pythagorean triples: products of primes of the form 4k + 1.
const RADII: [i64; 5] = [5, 65, 325, 1105, 5525];

fn cocircular(prng: &mut Prng, size: usize) -> Draft {
    let r = RADII[(size / 5).min(RADII.len() - 1)];
    let ring = some(&circle(r), size, prng);
    debug_assert!(goes_around(&ring));
    let times = prng.magnitude(30);
    let scaled = |ring: &[Site], k: i64| ring.iter().map(|s| [s[0] * k, s[1] * k]).collect();
    let mut draft = Draft::ring(scaled(&ring, 3 * times));
    match prng.below(3) {
        // The same ring at a third of the size lies inside, for both are convex around the centre.
        0 => draft.add(scaled(&ring, times), LoopRole::Any),
        1 => draft.points.push([0, 0]),
        _ => {}
    }
    draft
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_have_as_many_sites_as_number_theory_says() {
        for (r, count) in [(5, 12), (65, 36), (325, 60), (1105, 108), (5525, 180)] {
            let ring = circle(r);
            assert_eq!(ring.len(), count, "radius {r}");
            assert!(goes_around(&ring));
        }
    }

    #[test]
    fn a_ring_that_turns_back_does_not_go_around() {
        assert!(goes_around(&[[1, 0], [0, 1], [-1, -1]]));
        assert!(!goes_around(&[[1, 0], [0, 1], [-1, 1]]), "more than half a turn is missing");
        assert!(!goes_around(&[[1, 0], [-1, -1], [0, 1]]), "clockwise");
    }
}
