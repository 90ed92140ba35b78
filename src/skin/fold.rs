//! Whether a triangle keeps its side, decided exactly, and how good its shape is.

use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::vector::{Vector, cross, dot, norm, norm_sq, sub};

/// A changed triangle turns by less than the angle of this cosine.
const TURN_COSINE: f64 = 0.2;

/// Whether a triangle faces the side that `facing` points to, as seen along the coordinate axis that
/// `facing` is closest to. Exact: leaving out a coordinate does not round.
#[must_use]
pub fn faces([a, b, c]: [Vector; 3], facing: Vector) -> bool {
    let size = facing.map(f64::abs);
    let axis = match () {
        () if size[0] >= size[1] && size[0] >= size[2] => 0,
        () if size[1] >= size[2] => 1,
        () => 2,
    };
    let flat = |p: Vector| Point2::new(p[(axis + 1) % 3], p[(axis + 2) % 3]);
    orient2d(flat(a), flat(b), flat(c)) == Sign::of(facing[axis]) && facing[axis] != 0.0
}

/// Whether a changed triangle still faces its old side, and clearly so.
pub(super) fn is_kept(corners: [Vector; 3], facing: Vector) -> bool {
    let [a, b, c] = corners;
    let normal = cross(sub(b, a), sub(c, a));
    let limit = TURN_COSINE * norm(normal) * norm(facing);
    dot(normal, facing) > limit && faces(corners, facing)
}

/// 1 for the equilateral triangle, 0 for one without area.
pub(crate) fn shape([a, b, c]: [Vector; 3]) -> f64 {
    let (ab, bc, ca) = (sub(b, a), sub(c, b), sub(a, c));
    let edges = norm_sq(ab) + norm_sq(bc) + norm_sq(ca);
    let twice = norm(cross(ab, ca));
    if edges > 0.0 { 2.0 * 3.0_f64.sqrt() * twice / edges } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: [Vector; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.75_f64, 0.0]];

    // spec: U3
    #[test]
    fn the_side_is_decided_exactly_along_any_axis() {
        let up = [0.1, -0.2, 0.9];
        assert!(faces(A, up) && !faces(A, [0.1, 0.2, -0.9]));
        assert!(!faces(A, [0.0; 3]), "no side at all");
        for turn in 1..3 {
            let rolled = A.map(|p| std::array::from_fn(|i| p[(i + turn) % 3]));
            let facing: Vector = std::array::from_fn(|i| up[(i + turn) % 3]);
            assert!(faces(rolled, facing));
        }
        let sliver = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 5e-324, 0.0]];
        assert!(faces(sliver, [0.0, 0.0, 1.0]), "one unit in the last place decides");
        let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.0, 0.0]];
        assert!(!faces(flat, [0.0, 0.0, 1.0]) && !faces(flat, [0.0, 0.0, -1.0]));
    }

    // spec: U3
    #[test]
    fn a_triangle_that_turns_too_far_is_not_kept() {
        assert!(is_kept(A, [0.0, 0.3, 1.0]));
        assert!(!is_kept(A, [0.0, 10.0, 1.0]));
    }

    #[test]
    fn shapes_are_between_nothing_and_the_equilateral() {
        let best = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.0, 0.75_f64.sqrt()]];
        assert!((shape(best) - 1.0).abs() < 1e-15);
        assert_eq!(shape([[0.0; 3]; 3]), 0.0);
        assert_eq!(shape([[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]), 0.0);
    }
}
