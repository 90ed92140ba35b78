//! Winding numbers infinitesimally beside an edge, exactly.
//!
//! The point q = u + eps (v - u) + eps^2 n, with n the left (or right) normal of v - u, lies in no
//! segment between the given points. How often a chain winds around it is counted along the upward
//! ray from q; every tie is decided by the next power of eps. Only orient2d is needed.
//!
//! ```text
//!         ray |        q is just beside the edge u -> v, next to u
//!             q
//!        u ------------------> v
//! ```

use super::exact::{P2, lexicographic, orient2d};
use std::cmp::Ordering;

/// A point infinitesimally beside the directed edge from `u` to `v`, next to `u`.
#[derive(Clone, Copy)]
pub(super) struct Beside {
    pub(super) u: P2,
    pub(super) v: P2,
    pub(super) left: bool,
}

impl Beside {
    /// Whether q's abscissa lies above (`Greater`) or below that of u; never equal.
    fn shift(&self) -> Ordering {
        let along = self.v[0].partial_cmp(&self.u[0]).unwrap_or(Ordering::Equal);
        // On a vertical edge the normal decides: the left normal of (0, dy) is (-dy, 0).
        let upward = self.v[1] > self.u[1];
        let normal = if upward == self.left { Ordering::Less } else { Ordering::Greater };
        along.then(normal)
    }

    /// Whether the abscissa of `p` lies left of q's.
    fn is_left_of(&self, p: P2) -> bool {
        match p[0].partial_cmp(&self.u[0]) {
            Some(Ordering::Less) => true,
            Some(Ordering::Equal) => self.shift().is_gt(),
            _ => false,
        }
    }

    /// Which side of the line from `s` to `t` the point q lies on; `Equal` never.
    pub(super) fn side(&self, s: P2, t: P2) -> Ordering {
        let parallel = || {
            // s -> t runs along the line of u -> v, in the same direction or back.
            let forward = lexicographic(s, t) == lexicographic(self.u, self.v);
            if forward == self.left { Ordering::Greater } else { Ordering::Less }
        };
        orient2d(s, t, self.u).then_with(|| orient2d(s, t, self.v)).then_with(parallel)
    }

    /// The winding number around q contributed by the directed segment from `s` to `t`.
    pub(super) fn winding(&self, s: P2, t: P2) -> i32 {
        let (s_left, t_left) = (self.is_left_of(s), self.is_left_of(t));
        if s_left == t_left {
            return 0;
        }
        // The ray goes up, so q must lie below: to the right of a rightward segment.
        match (s_left, self.side(s, t)) {
            (true, Ordering::Less) => -1,
            (false, Ordering::Greater) => 1,
            _ => 0,
        }
    }

    /// Whether q lies in the counterclockwise triangle a, b, c.
    pub(super) fn is_in(&self, [a, b, c]: [P2; 3]) -> bool {
        [(a, b), (b, c), (c, a)].iter().all(|&(s, t)| self.side(s, t).is_gt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [P2; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    fn winding(polygon: &[P2], q: Beside) -> i32 {
        let n = polygon.len();
        (0..n).map(|i| q.winding(polygon[i], polygon[(i + 1) % n])).sum()
    }

    #[test]
    fn the_left_of_a_counterclockwise_boundary_is_inside() {
        for i in 0..4 {
            let (a, b) = (SQUARE[i], SQUARE[(i + 1) % 4]);
            for (u, v, left, expected) in
                [(a, b, true, 1), (a, b, false, 0), (b, a, true, 0), (b, a, false, 1)]
            {
                assert_eq!(winding(&SQUARE, Beside { u, v, left }), expected, "{u:?} {v:?} {left}");
            }
        }
    }

    #[test]
    fn a_direction_from_a_vertex_points_inside_or_outside() {
        let inward = Beside { u: [0.0, 0.0], v: [5.0, 4.0], left: true };
        assert_eq!(winding(&SQUARE, inward), 1);
        let outward = Beside { u: [0.0, 0.0], v: [-5.0, 4.0], left: true };
        assert_eq!(winding(&SQUARE, outward), 0);
    }

    #[test]
    fn a_wide_fan_is_counted_twice() {
        let twice: Vec<P2> = SQUARE.iter().chain(&SQUARE).copied().collect();
        assert_eq!(winding(&twice, Beside { u: [0.5, 0.5], v: [1.0, 0.5], left: true }), 2);
        let inside = Beside { u: [0.0, 0.0], v: [1.0, 0.0], left: true };
        assert!(inside.is_in([SQUARE[0], SQUARE[1], SQUARE[2]]));
        assert!(!inside.is_in([SQUARE[0], SQUARE[2], SQUARE[3]]));
    }
}
