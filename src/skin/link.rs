//! From a list of triangles to half-edges.

use crate::triangulation::{HalfEdgeId, Triangulation, VertexId};

/// An edge that no surface has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BadEdge {
    /// Its ends.
    pub vertices: [u32; 2],
    /// How many triangles have it; two that run along it in the same direction are bad as well.
    pub count: usize,
}

/// Links triangles; triangle t of the list is triangle t of the result, open edges are borders.
///
/// # Errors
/// The first edge, by its ends, of more than two triangles, or of two that run along it in the same
/// direction.
///
/// # Complexity
/// O(n log n).
pub fn linked(triangles: &[[u32; 3]]) -> Result<Triangulation, BadEdge> {
    let mut mesh = Triangulation::with_capacity(triangles.len());
    let mut edges: Vec<([u32; 2], HalfEdgeId)> = Vec::with_capacity(3 * triangles.len());
    for corners in triangles {
        let t = mesh.add(corners.map(VertexId));
        for e in t.half_edges() {
            let [a, b] = [mesh.origin(e).0, mesh.dest(e).0];
            edges.push(([a.min(b), a.max(b)], e));
        }
    }
    edges.sort_unstable_by_key(|&(ends, e)| (ends, e.0));
    for group in edges.chunk_by(|a, b| a.0 == b.0) {
        match group {
            [_] => {}
            &[(_, e), (_, f)] if mesh.origin(e) != mesh.origin(f) => mesh.link(e, f),
            _ => return Err(BadEdge { vertices: group[0].0, count: group.len() }),
        }
    }
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: U1
    #[test]
    fn two_triangles_share_an_edge_in_opposite_directions_only() {
        let mesh = linked(&[[0, 1, 2], [2, 1, 3]]).expect("a surface");
        let twins = mesh.triangles().flat_map(|t| t.half_edges()).filter_map(|e| mesh.twin(e));
        assert_eq!(twins.count(), 2);
        let same = linked(&[[0, 1, 2], [1, 2, 3]]).expect_err("same direction");
        assert_eq!(same, BadEdge { vertices: [1, 2], count: 2 });
        let three = linked(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]]).expect_err("three");
        assert_eq!(three, BadEdge { vertices: [0, 1], count: 3 });
    }
}
