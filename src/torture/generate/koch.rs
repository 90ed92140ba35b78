//! The Koch snowflake on a triangular lattice, drawn on the square one by an affine map.
//!
//! Valid because the snowflake's approximations are simple polygons and affine maps keep that.

use super::Family;
use super::draft::Draft;
use super::lattice::Site;
use crate::torture::prng::Prng;

/// Koch's snowflake.
pub(super) const KOCH: Family =
    Family::valid("koch", "Koch's snowflake of order 0 to 4, plain or sheared", koch);

/// The six directions of the triangular lattice in the basis of two of them.
const DIRECTIONS: [Site; 6] = [[1, 0], [0, 1], [-1, 1], [-1, 0], [0, -1], [1, -1]];

/// Corner directions of the snowflake: each edge turns right by 60, left by 120, right by 60.
fn directions(order: u32) -> Vec<usize> {
    let mut path = vec![0, 2, 4];
    for _ in 0..order {
        path = path.into_iter().flat_map(|d| [d, (d + 5) % 6, (d + 1) % 6, d]).collect();
    }
    path
}

fn koch(prng: &mut Prng, size: usize) -> Draft {
    let order = (size as u32 / 8).min(4);
    // 26 / 15 is near the square root of 3: almost regular. Other maps shear it.
    let basis: [Site; 2] = match prng.below(3) {
        0 => [[30, 0], [15, 26]],
        1 => [[1, 0], [0, 1]],
        _ => [[prng.magnitude(20), 1], [prng.range(0, 1 << 20), 1 + prng.magnitude(20)]],
    };
    let flat = basis[0][0] * basis[1][1] == basis[0][1] * basis[1][0];
    let basis = if flat { [[1, 0], [0, 1]] } else { basis };
    let mut at = [0, 0];
    let ring = directions(order).into_iter().map(|d| {
        let here = at;
        at = [at[0] + DIRECTIONS[d][0], at[1] + DIRECTIONS[d][1]];
        [0, 1].map(|axis| here[0] * basis[0][axis] + here[1] * basis[1][axis])
    });
    Draft::ring(ring.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::torture::generate::lattice::is_simple;

    #[test]
    fn snowflakes_are_simple() {
        for size in [0, 8, 16, 24] {
            let draft = koch(&mut Prng::new(size), size as usize);
            assert_eq!(draft.rings[0].sites.len(), 3 * 4usize.pow(size as u32 / 8));
            assert!(is_simple(&draft.rings[0].sites));
        }
    }
}
