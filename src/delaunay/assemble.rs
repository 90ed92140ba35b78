//! From a list of triangles, or from points on a line, to the triangulation structure.

use crate::point::Point2;
use crate::triangulation::{GHOST, HalfEdgeId, TriangleId, Triangulation, VertexId};

/// The triangulation with these counterclockwise triangles and a ghost on every hull edge. `None`
/// if they are no triangulated disc with a simple boundary: a directed edge occurs twice, or two
/// boundary edges start from one vertex, or two end there.
pub(crate) fn from_triangles(vertices: usize, triangles: &[[u32; 3]]) -> Option<Triangulation> {
    let mut triangulation = Triangulation::with_capacity(triangles.len() + vertices);
    let mut edges: Vec<(u32, u32, HalfEdgeId)> = Vec::with_capacity(3 * triangles.len());
    for corners in triangles {
        let t = triangulation.add(corners.map(VertexId));
        edges.extend(t.half_edges().map(|e| {
            let (a, b) = (triangulation.origin(e).0, triangulation.dest(e).0);
            (a.min(b), a.max(b), e)
        }));
    }
    edges.sort_unstable();
    let mut hull = Vec::new();
    for group in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        match *group {
            [(.., e)] => hull.push(e),
            [(.., e), (.., f)] if triangulation.origin(e) == triangulation.dest(f) => {
                triangulation.link(e, f);
            }
            _ => return None,
        }
    }
    add_ghosts(&mut triangulation, vertices, &hull).then_some(triangulation)
}

/// A ghost for each of the half-edges of a hull; whether they form simple cycles.
fn add_ghosts(triangulation: &mut Triangulation, vertices: usize, hull: &[HalfEdgeId]) -> bool {
    let mut starting: Vec<Option<TriangleId>> = vec![None; vertices];
    for &e in hull {
        let (u, v) = (triangulation.origin(e), triangulation.dest(e));
        let ghost = triangulation.add([v, u, GHOST]);
        triangulation.link(e, ghost.half_edge(0));
        if starting[u.index()].replace(ghost).is_some() {
            return false;
        }
    }
    for ghost in starting.clone().into_iter().flatten() {
        let end = triangulation.origin(ghost.half_edge(0));
        let Some(next) = starting[end.index()].take() else { return false };
        triangulation.link(ghost.half_edge(2), next.half_edge(1));
    }
    true
}

/// Distinct points on one line, in order along it: two ghosts for each piece of it and nothing
/// finite. One point or none gives an empty triangulation.
pub(crate) fn line(sorted: &[VertexId]) -> Triangulation {
    let mut triangulation = Triangulation::default();
    let sides: Vec<[TriangleId; 2]> = sorted
        .windows(2)
        .map(|w| [[w[0], w[1], GHOST], [w[1], w[0], GHOST]].map(|g| triangulation.add(g)))
        .collect();
    for [up, down] in &sides {
        triangulation.link(up.half_edge(0), down.half_edge(0));
    }
    for pair in sides.windows(2) {
        triangulation.link(pair[0][0].half_edge(1), pair[1][0].half_edge(2));
        triangulation.link(pair[0][1].half_edge(2), pair[1][1].half_edge(1));
    }
    if let (Some(first), Some(last)) = (sides.first(), sides.last()) {
        triangulation.link(first[0].half_edge(2), first[1].half_edge(1));
        triangulation.link(last[0].half_edge(1), last[1].half_edge(2));
    }
    triangulation
}

/// The triangulation of points that all lie on one line, sorted lexicographically.
pub(crate) fn sorted_line(points: &[Point2]) -> Triangulation {
    debug_assert!(points.is_sorted_by(|a, b| a.lexicographic(*b).is_lt()), "sorted and distinct");
    let vertices: Vec<VertexId> = (0..points.len() as u32).map(VertexId).collect();
    line(&vertices)
}
