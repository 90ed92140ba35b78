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
/// `edges` lists each edge once, as indices into `points`. Time is linear.
pub fn node_spacing(
    points: &[Point2],
    edges: impl IntoIterator<Item = [u32; 2]>,
) -> Vec<Option<f64>> {
    let mut sums = vec![(0.0, 0u32); points.len()];
    for edge in edges {
        let length = points[edge[0] as usize].distance(points[edge[1] as usize]);
        for v in edge {
            let (sum, count) = &mut sums[v as usize];
            *sum += length;
            *count += 1;
        }
    }
    sums.into_iter().map(|(sum, count)| (count > 0).then(|| sum / f64::from(count))).collect()
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
