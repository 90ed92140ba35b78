//! Validity of a triangle beside a front, in the tangent plane of its base edge.
//!
//! Points are projected with rounding; from there on every decision is exact. So a triangle is
//! accepted only if the projected one is counterclockwise, meets no projected front edge but in common
//! ends, and has no front vertex in it.

use crate::point::Point2;
use crate::predicates::{
    PointInTriangle, SegmentIntersection, Sign, classify, orient2d, point_in_triangle,
};
use crate::vector::{Vector, cross, dot, sub, unit};

/// A plane that touches the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tangent {
    origin: Vector,
    x: Vector,
    y: Vector,
}

impl Tangent {
    /// The plane through `a` with the normal `normal`, in which x runs from `a` to `b`; `None` when the
    /// edge has no direction in it.
    pub(super) fn new(a: Vector, b: Vector, normal: Vector) -> Option<Self> {
        let y = unit(cross(normal, sub(b, a)))?;
        let x = unit(cross(y, normal))?;
        Some(Self { origin: a, x, y })
    }

    /// The direction in the plane that points to the left of the edge.
    pub(super) fn left(&self) -> Vector {
        self.y
    }

    pub(super) fn flat(&self, p: Vector) -> Point2 {
        let d = sub(p, self.origin);
        Point2::new(dot(d, self.x), dot(d, self.y))
    }
}

/// A front edge near by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beside {
    pub(super) vertices: [u32; 2],
    pub(super) flat: [Point2; 2],
}

/// The triangle of a base edge and an apex, in the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial {
    /// Base from, base to, apex; a new apex is `u32::MAX`.
    pub(super) vertices: [u32; 3],
    pub(super) flat: [Point2; 3],
}

impl Trial {
    /// Whether the triangle lies in the open region, as far as the edges near by tell. Front edges
    /// that are sides of it are left to the caller.
    pub(super) fn is_clear(&self, beside: &[Beside]) -> bool {
        let [a, b, c] = self.flat;
        orient2d(a, b, c) == Sign::Positive && beside.iter().all(|edge| self.is_clear_of(edge))
    }

    fn is_clear_of(&self, edge: &Beside) -> bool {
        let is_corner = edge.vertices.map(|v| self.vertices.contains(&v));
        if is_corner == [true, true] {
            return true;
        }
        let [a, b, c] = self.flat;
        let is_outside = |i: usize| {
            is_corner[i] || point_in_triangle(edge.flat[i], [a, b, c]) == PointInTriangle::Outside
        };
        if !is_outside(0) || !is_outside(1) {
            return false;
        }
        [[0, 2], [1, 2]].iter().all(|&[i, j]| {
            let shares = edge.vertices.contains(&self.vertices[i])
                || edge.vertices.contains(&self.vertices[j]);
            let met = classify(self.flat[i], self.flat[j], edge.flat[0], edge.flat[1]);
            met == SegmentIntersection::Disjoint || (shares && is_at_end(met))
        })
    }
}

/// Whether two segments meet in ends of both only.
fn is_at_end(met: SegmentIntersection) -> bool {
    matches!(met, SegmentIntersection::SharedEndpoint { .. })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trial(apex: [f64; 2]) -> Trial {
        let flat = [[0.0, 0.0], [1.0, 0.0], apex].map(Point2::from);
        Trial { vertices: [0, 1, 2], flat }
    }

    fn edge(vertices: [u32; 2], ends: [[f64; 2]; 2]) -> Beside {
        Beside { vertices, flat: ends.map(Point2::from) }
    }

    // spec: U12
    #[test]
    fn a_triangle_is_clear_of_edges_that_it_only_touches_at_corners() {
        let over = trial([0.5, 1.0]);
        let clear = [
            edge([5, 6], [[2.0, 0.0], [2.0, 1.0]]),
            edge([2, 6], [[0.5, 1.0], [0.5, 2.0]]),
            edge([6, 0], [[-1.0, 0.5], [0.0, 0.0]]),
            edge([1, 2], [[1.0, 0.0], [0.5, 1.0]]),
            edge([1, 0], [[1.0, 0.0], [0.0, 0.0]]),
        ];
        assert!(over.is_clear(&clear));
        assert!(!trial([0.5, -1.0]).is_clear(&[]), "clockwise");
        assert!(!trial([7.0, 0.0]).is_clear(&[]), "flat");
    }

    // spec: U12
    #[test]
    fn crossings_touches_and_vertices_inside_are_refused() {
        let over = trial([0.5, 1.0]);
        for wrong in [
            edge([5, 6], [[-1.0, 0.5], [2.0, 0.5]]),
            edge([5, 6], [[0.5, 0.2], [0.5, 0.3]]),
            edge([0, 6], [[0.0, 0.0], [1.0, 1.0]]),
            edge([0, 6], [[0.0, 0.0], [0.25, 0.5]]),
            edge([2, 6], [[0.5, 1.0], [0.5, 0.5]]),
            edge([5, 6], [[0.25, 0.5], [-1.0, 0.5]]),
            edge([5, 6], [[0.5, 1.0], [0.5, 2.0]]),
            edge([0, 6], [[0.0, 0.0], [1.0, 2.0]]),
        ] {
            assert!(!over.is_clear(&[wrong]), "{wrong:?}");
        }
    }

    // spec: U12
    #[test]
    fn the_plane_has_the_edge_along_x_and_the_open_side_on_the_left() {
        let plane = Tangent::new([1.0, 0.0, 0.0], [1.0, 2.0, 0.1], [0.0, 0.0, 1.0]).expect("one");
        assert_eq!(plane.left(), [-1.0, 0.0, 0.0]);
        assert_eq!(plane.flat([0.0, 2.0, 9.0]), Point2::new(2.0, 1.0));
        assert!(Tangent::new([0.0; 3], [0.0; 3], [0.0, 0.0, 1.0]).is_none());
    }
}
