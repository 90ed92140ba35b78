//! Cells of a grid from the two triangles of each.

use crate::point::Point2;
use crate::predicates::{Sign, orient2d};

/// Turns the corners of each two triangles that follow each other into (a, b, c) and (a, c, d), so
/// that (a, b, c, d) is the cell they are the halves of. Triangles keep their places and orientation.
///
/// # Errors
/// The index of the first pair without a common edge that they run along in opposite directions.
pub fn pair_up(triangles: &mut [[u32; 3]]) -> Result<(), usize> {
    for (i, pair) in triangles.chunks_mut(2).enumerate() {
        let [first, second] = pair else { return Err(i) };
        let turned = (0..3).map(|k| [first[k], first[(k + 1) % 3], first[(k + 2) % 3]]);
        // The edge from c back to a is the other's from a to c.
        let common = turned.into_iter().find_map(|own| {
            let [a, _, c] = own;
            let k = (0..3).find(|&k| second[k] == a && second[(k + 1) % 3] == c)?;
            Some((own, [a, c, second[(k + 2) % 3]]))
        });
        (*first, *second) = common.ok_or(i)?;
    }
    Ok(())
}

/// The cells of the plane that are not strictly convex, decided exactly, after [`pair_up`]: how many,
/// and the first.
#[must_use]
pub fn concave_cells(points: &[Point2], triangles: &[[u32; 3]]) -> Option<(usize, usize)> {
    let is_convex = |pair: &[[u32; 3]]| {
        let ([a, b, c], d) = (pair[0], pair[1][2]);
        let [a, b, c, d] = [a, b, c, d].map(|v| points[v as usize]);
        [[a, b, c], [b, c, d], [c, d, a], [d, a, b]]
            .iter()
            .all(|&[a, b, c]| orient2d(a, b, c) == Sign::Positive)
    };
    let mut concave = triangles.chunks_exact(2).enumerate().filter(|(_, pair)| !is_convex(pair));
    let (first, _) = concave.next()?;
    Some((1 + concave.count(), first))
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: W9
    #[test]
    fn either_diagonal_gives_the_cell() {
        for (pair, cell) in [
            ([[0, 1, 2], [0, 2, 3]], [[0, 1, 2], [0, 2, 3]]),
            ([[0, 1, 3], [1, 2, 3]], [[3, 0, 1], [3, 1, 2]]),
            ([[2, 0, 1], [2, 3, 0]], [[0, 1, 2], [0, 2, 3]]),
        ] {
            let mut found = pair;
            assert_eq!(pair_up(&mut found), Ok(()));
            assert_eq!(found, cell);
        }
    }

    // spec: W9
    #[test]
    fn triangles_that_share_no_edge_are_no_cell() {
        for mut wrong in [vec![[0, 1, 2], [3, 4, 5]], vec![[0, 1, 2]], vec![[0, 1, 2], [0, 3, 2]]] {
            let copy = wrong.clone();
            assert_eq!(pair_up(&mut wrong), Err(0));
            assert_eq!(wrong, copy);
        }
        let mut second = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 5, 6]];
        assert_eq!(pair_up(&mut second), Err(1));
    }

    // spec: W10
    #[test]
    fn cells_with_an_angle_of_a_half_turn_or_more_are_found() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point2::from);
        let cell = [[0, 1, 2], [0, 2, 3]];
        assert_eq!(concave_cells(&square, &cell), None);
        for corner in [[0.5, 0.5], [0.4, 0.4]] {
            let mut bent = square;
            bent[2] = corner.into();
            let mut pair = [[0, 1, 2], [0, 2, 3]];
            assert_eq!(pair_up(&mut pair), Ok(()));
            assert_eq!(concave_cells(&bent, &pair), Some((1, 0)), "{corner:?}");
        }
    }
}
