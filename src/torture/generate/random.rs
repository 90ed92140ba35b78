//! Random simple polygons: grown vertex by vertex, and untangled by 2-opt moves.
//!
//! Valid because each step is tested exactly against every edge: growing keeps the ring simple, and
//! untangling is over only when the ring is.

use super::Family;
use super::draft::Draft;
use super::lattice::{Site, is_simple, meet, turn};
use crate::torture::prng::Prng;

/// Grown polygons.
pub(super) const GROWN: Family = Family::valid(
    "grown",
    "random simple polygons grown by pulling random edges to random points",
    grown,
);
/// Untangled tours.
pub(super) const TWO_OPT: Family =
    Family::valid("two-opt", "random closed tours untangled by 2-opt moves", two_opt);

/// Whether edge i of a simple ring can be replaced by two edges over p.
fn can_pull(ring: &[Site], i: usize, p: Site) -> bool {
    let n = ring.len();
    let (a, b) = (ring[i], ring[(i + 1) % n]);
    let (before, after) = (ring[(i + n - 1) % n], ring[(i + 2) % n]);
    if turn(a, p, b).is_eq() || ring.contains(&p) {
        return false;
    }
    // The neighbouring edges share a and b; they must not touch the new edges elsewhere.
    let clear = |edge: [Site; 2], new: [Site; 2]| !meet(edge, new);
    let along = |u: Site, at: Site, v: Site| {
        let dot = |axis: usize| i128::from(u[axis] - at[axis]) * i128::from(v[axis] - at[axis]);
        turn(u, at, v).is_eq() && dot(0) + dot(1) > 0
    };
    !along(before, a, p)
        && !along(after, b, p)
        && (n == 3 || (clear([before, a], [p, b]) && clear([b, after], [a, p])))
        && (0..n).filter(|&j| j != i && (j + 1) % n != i && j != (i + 1) % n).all(|j| {
            let edge = [ring[j], ring[(j + 1) % n]];
            clear(edge, [a, p]) && clear(edge, [p, b])
        })
}

fn grown(prng: &mut Prng, size: usize) -> Draft {
    let side = 1 << *prng.pick(&[3, 4, 8, 20, 40]);
    let site = |prng: &mut Prng| [prng.range(0, side), prng.range(0, side)];
    let mut ring = vec![[0, 0], [side, 0], [0, side]];
    let n = 4 + size.min(120);
    for _ in 0..20 * n {
        if ring.len() >= n {
            break;
        }
        let (i, p) = (prng.index(ring.len()), site(prng));
        // From a triangle, is_simple judges: two of its edges are neighbours of both new ones.
        let mut longer = ring.clone();
        longer.insert(i + 1, p);
        if if ring.len() == 3 { is_simple(&longer) } else { can_pull(&ring, i, p) } {
            ring = longer;
        }
    }
    Draft::ring(ring)
}

/// Untangles a tour; `None` when touching points keep it from becoming simple.
fn untangle(mut ring: Vec<Site>) -> Option<Vec<Site>> {
    let n = ring.len();
    // Each move shortens the tour; the limit is for those of equal length.
    for _ in 0..n * n {
        let crossing = (0..n).find_map(|i| {
            let last = if i == 0 { n - 1 } else { n };
            let meets = |&j: &usize| meet([ring[i], ring[i + 1]], [ring[j], ring[(j + 1) % n]]);
            if i + 1 >= n { None } else { (i + 2..last).find(meets).map(|j| (i, j)) }
        });
        match crossing {
            Some((i, j)) => ring[i + 1..=j].reverse(),
            None => return is_simple(&ring).then_some(ring),
        }
    }
    None
}

fn two_opt(prng: &mut Prng, size: usize) -> Draft {
    let side = 1 << *prng.pick(&[4, 8, 20, 40]);
    let n = 4 + size.min(50);
    for _ in 0..4 {
        let mut ring: Vec<Site> =
            (0..n).map(|_| [prng.range(0, side), prng.range(0, side)]).collect();
        ring.sort_unstable();
        ring.dedup();
        prng.shuffle(&mut ring);
        if let Some(ring) = (ring.len() >= 3).then(|| untangle(ring)).flatten() {
            return Draft::ring(ring);
        }
    }
    grown(prng, size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grown_and_untangled_rings_are_simple() {
        let mut prng = Prng::new(11);
        for size in [0, 3, 10, 40] {
            for _ in 0..20 {
                for make in [grown, two_opt] {
                    let draft = make(&mut prng, size);
                    assert!(is_simple(&draft.rings[0].sites), "{:?}", draft.rings[0].sites);
                }
            }
        }
    }

    #[test]
    fn a_pull_through_another_edge_is_refused() {
        let ring = [[0, 0], [8, 0], [8, 8], [0, 8]];
        assert!(can_pull(&ring, 0, [4, 4]));
        assert!(can_pull(&ring, 0, [4, -4]));
        assert!(!can_pull(&ring, 0, [4, 9]), "through the far side");
        assert!(!can_pull(&ring, 0, [4, 8]), "onto the far side");
        assert!(!can_pull(&ring, 0, [12, 4]), "through the next side");
        assert!(!can_pull(&ring, 0, [8, 4]), "along the next side");
        assert!(!can_pull(&ring, 0, [4, 0]), "along itself");
    }
}
