//! A background mesh with a spacing at each node, as a user gives it in a file.

use super::boxes::{Boxed, Boxes, between, nearest_on_segment};
use super::growth::{GrowthField, Source};
use crate::point::Point2;

/// Triangles in the plane with a spacing at each of their points: plain data.
///
/// # Shapes and units
/// `points: [n]`, `spacing: [n]` in the unit of the domain, `triangles: [m][3]` indices into them,
/// of any orientation, conforming or not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpacingTable {
    /// Nodes.
    pub points: Vec<Point2>,
    /// Spacing at each node.
    pub spacing: Vec<f64>,
    /// Triangles between them.
    pub triangles: Vec<[u32; 3]>,
}

/// Why a table is no size field.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// No triangles.
    #[error("the background mesh has no triangle")]
    Empty,
    /// A spacing is missing or makes no sense.
    #[error("the spacing at node {node}, {at}, is {value}: it must be positive and finite")]
    Spacing {
        /// Index of the node.
        node: usize,
        /// Where it is.
        at: Point2,
        /// What stands there.
        value: f64,
    },
    /// A triangle names a node that is not there, or one at no finite place.
    #[error(
        "triangle {triangle} of the background mesh names node {node}, which has no finite place"
    )]
    Node {
        /// Index of the triangle.
        triangle: usize,
        /// Index of the node.
        node: u32,
    },
}

impl SpacingTable {
    /// Whether it is a size field.
    ///
    /// # Errors
    /// The first fault.
    pub fn check(&self) -> Result<(), TableError> {
        if self.triangles.is_empty() {
            return Err(TableError::Empty);
        }
        for (triangle, &node) in
            self.triangles.iter().enumerate().flat_map(|(t, c)| c.iter().map(move |n| (t, n)))
        {
            let i = node as usize;
            let (Some(&at), Some(&value)) = (self.points.get(i), self.spacing.get(i)) else {
                return Err(TableError::Node { triangle, node });
            };
            if !at.is_finite() {
                return Err(TableError::Node { triangle, node });
            }
            if !(value > 0.0 && value.is_finite()) {
                return Err(TableError::Spacing { node: i, at, value });
            }
        }
        Ok(())
    }
}

/// A triangle of the table.
#[derive(Debug)]
struct Piece {
    corners: [Point2; 3],
    spacing: [f64; 3],
}

impl Boxed for Piece {
    fn bounds(&self) -> [Point2; 2] {
        let [a, b, c] = self.corners;
        [
            Point2::new(a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y)),
            Point2::new(a.x.max(b.x).max(c.x), a.y.max(b.y).max(c.y)),
        ]
    }

    fn least(&self) -> f64 {
        0.0
    }
}

impl Piece {
    /// Distance to the point, and the spacing at the nearest point of the triangle.
    fn nearest(&self, p: Point2) -> (f64, f64) {
        if let Some(weights) = self.weights(p) {
            let mean = weights.iter().zip(self.spacing).map(|(w, h)| w * h).sum();
            return (0.0, mean);
        }
        let side = |i: usize| {
            let (ends, h) = (
                [i, (i + 1) % 3].map(|k| self.corners[k]),
                [i, (i + 1) % 3].map(|k| self.spacing[k]),
            );
            let t = nearest_on_segment(ends, p);
            (between(ends, t).distance(p), (1.0 - t) * h[0] + t * h[1])
        };
        let (first, second, third) = (side(0), side(1), side(2));
        let nearer = if second.0 < first.0 { second } else { first };
        if third.0 < nearer.0 { third } else { nearer }
    }

    /// Barycentric coordinates of a point inside.
    fn weights(&self, p: Point2) -> Option<[f64; 3]> {
        let [a, b, c] = self.corners;
        let area =
            |u: Point2, v: Point2, w: Point2| (v.x - u.x) * (w.y - u.y) - (v.y - u.y) * (w.x - u.x);
        let whole = area(a, b, c);
        let weights = [area(b, c, p) / whole, area(c, a, p) / whole, area(a, b, p) / whole];
        weights.iter().all(|&w| w >= 0.0 && w.is_finite()).then_some(weights)
    }
}

/// The spacing of a table at any point, growth-limited.
#[derive(Debug)]
pub struct TableField {
    pieces: Boxes<Piece>,
    limit: GrowthField,
}

impl TableField {
    /// A field of a sound table (see [`SpacingTable::check`]) with slope at most `growth` between
    /// its nodes.
    #[must_use]
    pub fn new(table: &SpacingTable, growth: f64) -> Self {
        let piece = |t: &[u32; 3]| Piece {
            corners: t.map(|v| table.points[v as usize]),
            spacing: t.map(|v| table.spacing[v as usize]),
        };
        let pieces = Boxes::new(table.triangles.iter().map(piece).collect());
        let mut nodes: Vec<u32> = table.triangles.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let source = |v: u32| {
            let v = v as usize;
            Source { at: table.points[v], spacing: table.spacing[v] }
        };
        let mut sources: Vec<Source> = nodes.into_iter().map(source).collect();
        sources
            .sort_by(|s, t| s.at.lexicographic(t.at).then_with(|| s.spacing.total_cmp(&t.spacing)));
        Self { pieces, limit: GrowthField::new(&sources, growth) }
    }

    /// The spacing at `p`: interpolated in the triangle that holds it, outside of all of them at
    /// the nearest point of one; and not above what growth from the nodes allows.
    #[must_use]
    pub fn at(&self, p: Point2) -> f64 {
        let nearest = self.pieces.smallest(p, 1.0, |piece| piece.nearest(p).0);
        let value = nearest.map_or(f64::INFINITY, |(piece, _)| piece.nearest(p).1);
        value.min(self.limit.at(p))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> SpacingTable {
        let points = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]].map(Point2::from).to_vec();
        // The second triangle is clockwise: files say either.
        SpacingTable {
            points,
            spacing: vec![1.0, 1.5, 2.0, 1.5],
            triangles: vec![[0, 1, 2], [0, 3, 2]],
        }
    }

    // spec: H9
    #[test]
    fn values_are_interpolated_inside_and_nearest_outside() {
        let field = TableField::new(&table(), 1.0);
        for (x, y, wanted) in [
            (0.0, 0.0, 1.0),
            (4.0, 0.0, 1.5),
            (2.0, 2.0, 1.5),
            (3.0, 1.0, 1.5),
            (1.0, 3.0, 1.5),
            (-9.0, -9.0, 1.0),
            (2.0, -3.0, 1.25),
            (99.0, 99.0, 2.0),
        ] {
            let h = field.at(Point2::new(x, y));
            assert!((h - wanted).abs() < 1e-12, "({x}, {y}): {h}");
        }
    }

    // spec: H9
    #[test]
    fn growth_from_the_nodes_limits_a_steep_table() {
        let steep = SpacingTable { spacing: vec![0.1, 9.0, 9.0, 9.0], ..table() };
        let field = TableField::new(&steep, 0.25);
        assert!((field.at(Point2::new(2.0, 0.0)) - 0.6).abs() < 1e-12);
        assert!(TableField::new(&steep, 9.0).at(Point2::new(2.0, 0.0)) > 4.0);
    }

    // spec: !H9
    #[test]
    fn tables_that_are_no_field_are_refused_by_node() {
        assert_eq!(table().check(), Ok(()));
        let empty = SpacingTable { triangles: Vec::new(), ..table() };
        assert_eq!(empty.check(), Err(TableError::Empty));
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let broken = SpacingTable { spacing: vec![1.0, value, 1.0, 1.0], ..table() };
            assert!(matches!(broken.check(), Err(TableError::Spacing { node: 1, .. })), "{value}");
        }
        let beyond = SpacingTable { triangles: vec![[0, 1, 7]], ..table() };
        assert_eq!(beyond.check(), Err(TableError::Node { triangle: 0, node: 7 }));
        let short = SpacingTable { spacing: vec![1.0], ..table() };
        assert_eq!(short.check(), Err(TableError::Node { triangle: 0, node: 1 }));
    }

    #[test]
    fn slivers_of_no_area_serve_by_their_sides() {
        let flat = SpacingTable {
            points: [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]].map(Point2::from).to_vec(),
            spacing: vec![1.0, 2.0, 3.0],
            triangles: vec![[0, 1, 2]],
        };
        assert_eq!(TableField::new(&flat, 5.0).at(Point2::new(0.5, 3.0)), 1.5);
    }
}
