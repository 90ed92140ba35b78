//! How fine a mesh can be beside a boundary that is coarser than its field.

use super::boxes::{Boxed, Boxes, between, nearest_on_segment};
use crate::point::Point2;

/// Sides on a coarse edge start at this fraction of it.
const START: f64 = 0.6;
/// From there they shrink by this much per unit of distance.
const SLOPE: f64 = 0.7;

/// The spacing below which no side can be, near long boundary edges.
#[derive(Debug)]
pub struct CoarseField {
    edges: Boxes<Edge>,
}

#[derive(Debug)]
struct Edge {
    ends: [Point2; 2],
}

impl Edge {
    /// Minus the bound that this edge sets: the tree looks for the smallest.
    fn at(&self, p: Point2) -> f64 {
        let foot = between(self.ends, nearest_on_segment(self.ends, p));
        SLOPE * foot.distance(p) + self.least()
    }
}

impl Boxed for Edge {
    fn bounds(&self) -> [Point2; 2] {
        let [a, b] = self.ends;
        [Point2::new(a.x.min(b.x), a.y.min(b.y)), Point2::new(a.x.max(b.x), a.y.max(b.y))]
    }

    fn least(&self) -> f64 {
        -START * self.ends[0].distance(self.ends[1])
    }
}

impl CoarseField {
    /// The bound that these edges set.
    #[must_use]
    pub fn new(edges: impl IntoIterator<Item = [Point2; 2]>) -> Self {
        Self { edges: Boxes::new(edges.into_iter().map(|ends| Edge { ends }).collect()) }
    }

    /// The largest over edges of 0.6 b - 0.7 |x - edge|, or 0.
    #[must_use]
    pub fn at(&self, p: Point2) -> f64 {
        self.edges.smallest(p, SLOPE, |edge| edge.at(p)).map_or(0.0, |(_, h)| (-h).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: H5
    #[test]
    fn the_bound_falls_from_the_longest_edge_nearby() {
        let p = Point2::new;
        let field = CoarseField::new([[p(0.0, 0.0), p(10.0, 0.0)], [p(10.0, 0.0), p(10.0, 1.0)]]);
        assert!((field.at(p(5.0, 0.0)) - 6.0).abs() < 1e-12);
        assert!((field.at(p(5.0, 2.0)) - 4.6).abs() < 1e-12);
        assert!(
            (field.at(p(10.0, 0.5)) - 5.65).abs() < 1e-12,
            "the long one counts beside the short"
        );
        assert_eq!(field.at(p(0.0, 99.0)), 0.0);
        assert_eq!(CoarseField::new([]).at(p(0.0, 0.0)), 0.0);
    }
}
