//! Node spacing: the mean length of the edges at a node.

use crate::point::Point2;

/// Which edges the mean at a node is taken over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Density {
    /// All edges of the background triangulation (the report's definition).
    AllEdges,
    /// Boundary edges and interior constraints only.
    BoundaryEdges,
}

/// Mean length of the edges at each of the `points`; `None` where no edge ends.
///
/// `edges` lists each edge once, as indices into `points`; their order does not matter, to the last
/// bit. Time is O(n log n).
pub fn node_spacing(
    points: &[Point2],
    edges: impl IntoIterator<Item = [u32; 2]>,
) -> Vec<Option<f64>> {
    let mut ends: Vec<(u32, f64)> = Vec::new();
    for [a, b] in edges {
        let length = points[a as usize].distance(points[b as usize]);
        ends.extend([(a, length), (b, length)]);
    }
    // Sums of floats depend on their order: shortest first is an order that all inputs share.
    ends.sort_unstable_by(|(u, l), (v, m)| u.cmp(v).then(l.total_cmp(m)));
    let mut spacing = vec![None; points.len()];
    for node in ends.chunk_by(|(u, _), (v, _)| u == v) {
        let sum: f64 = node.iter().map(|(_, length)| length).sum();
        spacing[node[0].0 as usize] = Some(sum / node.len() as f64);
    }
    spacing
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: H1
    #[test]
    fn spacing_is_the_mean_of_the_edges_at_the_node() {
        let points = [[0.0, 0.0], [3.0, 0.0], [3.0, 4.0], [9.0, 9.0]].map(Point2::from);
        let spacing = node_spacing(&points, [[0, 1], [1, 2], [2, 0]]);
        assert_eq!(spacing, [Some(4.0), Some(3.5), Some(4.5), None]);
    }

    // spec: H1
    #[test]
    fn a_node_without_edges_has_no_spacing() {
        assert_eq!(node_spacing(&[Point2::new(1.0, 1.0)], []), [None]);
    }
}
