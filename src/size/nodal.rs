//! The report's field: node spacings interpolated linearly on the background triangulation,
//! L = a L1 + b L2 + c L3 with the barycentric coordinates (a, b, c), and the same divided by 3.

use crate::point::Point2;
use crate::size::Hint;
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};

/// How the three node spacings of a background triangle make a spacing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodalRule {
    /// L = a L1 + b L2 + c L3.
    Mean,
    /// L = (a L1 + b L2 + c L3) / 3.
    Third,
}

/// Node spacings on a background triangulation of the domain.
#[derive(Debug)]
pub struct NodalField {
    background: Triangulation,
    points: Vec<Point2>,
    spacing: Vec<f64>,
    rule: NodalRule,
}

/// A walk that takes longer has met a ring of slivers; the triangle it has reached serves.
const STEPS_MAX: usize = 10_000;

impl NodalField {
    /// A field on the triangles of `background` (no ghosts; its borders stop a walk), whose
    /// vertices are `points` with the given spacings, positive and finite.
    #[must_use]
    pub fn new(
        background: Triangulation,
        points: Vec<Point2>,
        spacing: Vec<f64>,
        rule: NodalRule,
    ) -> Self {
        assert_eq!(points.len(), spacing.len(), "one spacing per point");
        Self { background, points, spacing, rule }
    }

    /// The spacing at `p`, found by a walk from the hint; a point that the walk cannot reach (it
    /// lies across the border) takes the nearest barycentric coordinates of the last triangle.
    #[must_use]
    pub fn at(&self, p: Point2, hint: &mut Hint) -> f64 {
        let (t, weights) = self.walk(p, hint.0);
        *hint = Hint(t);
        let corners = self.background.corners(t);
        let mean: f64 = (0..3).map(|i| weights[i] * self.spacing[corners[i].index()]).sum();
        match self.rule {
            NodalRule::Mean => mean,
            NodalRule::Third => mean / 3.0,
        }
    }

    /// Barycentric coordinates of `p`, found as by [`at`](Self::at), and the spacings at the three
    /// corners: first the lexicographically smallest corner, then counterclockwise, so that the
    /// order does not depend on how the domain was written down.
    #[must_use]
    pub fn corners_at(&self, p: Point2, hint: &mut Hint) -> ([f64; 3], [f64; 3]) {
        let (t, weights) = self.walk(p, hint.0);
        *hint = Hint(t);
        let corners = self.background.corners(t).map(VertexId::index);
        let at = |i: usize| self.points[corners[i]];
        let first = [1, 2]
            .into_iter()
            .fold(0, |f, i| if at(i).lexicographic(at(f)).is_lt() { i } else { f });
        let order = [first, (first + 1) % 3, (first + 2) % 3];
        (order.map(|i| weights[i]), order.map(|i| self.spacing[corners[i]]))
    }

    /// The triangle of `p`, or the last one before the border, with non-negative weights.
    fn walk(&self, p: Point2, start: TriangleId) -> (TriangleId, [f64; 3]) {
        let mut t = start;
        let mut from = None;
        for _ in 0..STEPS_MAX {
            let weights = self.barycentric(t, p);
            match self.exit(t, weights, from) {
                Some(twin) => {
                    from = Some(twin);
                    t = twin.triangle();
                }
                None => return (t, clamped(weights)),
            }
        }
        (t, clamped(self.barycentric(t, p)))
    }

    /// The half-edge beyond the most violated side that is no border, entering the neighbour.
    fn exit(
        &self,
        t: TriangleId,
        weights: [f64; 3],
        from: Option<HalfEdgeId>,
    ) -> Option<HalfEdgeId> {
        let mut best = None;
        let mut worst = 0.0;
        for (i, &weight) in weights.iter().enumerate() {
            // The side opposite corner i starts at corner i + 1.
            let side = t.half_edge(((i + 1) % 3) as u32);
            if weight < worst
                && Some(side) != from
                && let Across::Twin(twin) = self.background.across(side)
            {
                (worst, best) = (weight, Some(twin));
            }
        }
        best
    }

    /// Barycentric coordinates of `p`, rounded.
    fn barycentric(&self, t: TriangleId, p: Point2) -> [f64; 3] {
        let [a, b, c] = self.background.corners(t).map(|v| self.points[v.index()]);
        let area =
            |u: Point2, v: Point2, w: Point2| (v.x - u.x) * (w.y - u.y) - (v.y - u.y) * (w.x - u.x);
        let whole = area(a, b, c);
        if whole > 0.0 {
            [area(b, c, p) / whole, area(c, a, p) / whole, area(a, b, p) / whole]
        } else {
            // A sliver whose area rounds to nothing: its corners serve alike.
            [1.0 / 3.0; 3]
        }
    }
}

fn clamped(weights: [f64; 3]) -> [f64; 3] {
    let positive = weights.map(|w| w.max(0.0));
    let sum: f64 = positive.iter().sum();
    if sum.is_finite() && sum > 0.0 { positive.map(|w| w / sum) } else { [1.0 / 3.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The unit square cut along its diagonal from (0, 0) to (1, 1).
    fn square(rule: NodalRule) -> NodalField {
        let mut background = Triangulation::default();
        let v = [0, 1, 2, 3].map(VertexId);
        let lower = background.add([v[0], v[1], v[2]]);
        let upper = background.add([v[0], v[2], v[3]]);
        background.link(lower.half_edge(2), upper.half_edge(0));
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point2::from);
        NodalField::new(background, points.to_vec(), vec![1.0, 2.0, 4.0, 8.0], rule)
    }

    fn at(field: &NodalField, x: f64, y: f64, start: u32) -> f64 {
        field.at(Point2::new(x, y), &mut Hint(TriangleId(start)))
    }

    // spec: H3
    #[test]
    fn nodes_edges_and_interior_are_interpolated_from_any_hint() {
        let field = square(NodalRule::Mean);
        for start in [0, 1] {
            assert_eq!(at(&field, 1.0, 0.0, start), 2.0);
            assert_eq!(at(&field, 0.0, 1.0, start), 8.0);
            assert_eq!(at(&field, 0.5, 0.5, start), 2.5);
            assert!((at(&field, 2.0 / 3.0, 1.0 / 3.0, start) - 7.0 / 3.0).abs() < 1e-12);
        }
    }

    // spec: H3
    #[test]
    fn the_third_rule_divides_by_three() {
        assert_eq!(at(&square(NodalRule::Third), 0.5, 0.5, 0), 2.5 / 3.0);
    }

    // spec: H3
    #[test]
    fn outside_takes_the_nearest_values_and_never_extrapolates() {
        let field = square(NodalRule::Mean);
        for (x, y) in [(5.0, 0.5), (-3.0, -3.0), (0.5, 9.0), (1e300, -1e300)] {
            let h = at(&field, x, y, 0);
            assert!((1.0..=8.0).contains(&h), "({x}, {y}): {h}");
        }
    }

    #[test]
    fn a_walk_updates_the_hint() {
        let field = square(NodalRule::Mean);
        let mut hint = Hint(TriangleId(0));
        let _ = field.at(Point2::new(0.1, 0.9), &mut hint);
        assert_eq!(hint, Hint(TriangleId(1)));
    }
}
