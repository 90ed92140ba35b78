//! The edges of a mesh, once each, and long strokes through them.

use crate::mesh::MeshData;

/// What an edge is, by how many triangles have it and by the file's marked edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Between two triangles (or more, in a broken mesh).
    Interior,
    /// Marked by the file and between two triangles, or marked without being a triangle's edge.
    Constraint,
    /// On one triangle only.
    Boundary,
}

/// An edge as a pair of point indices, lower one first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    pub vertices: [u32; 2],
    pub kind: Kind,
}

/// Every edge between points that exist, in order of their indices.
///
/// O(n log n): the directed pairs are sorted and equal ones counted.
pub fn edges(mesh: &MeshData) -> Vec<Edge> {
    let points = mesh.points.len();
    let mut sides: Vec<u64> = Vec::with_capacity(mesh.triangles.len() * 3 + mesh.edges.len());
    let drawable = mesh.triangles.iter().filter(|t| t.iter().all(|&v| (v as usize) < points));
    for &[a, b, c] in drawable {
        sides.extend([[a, b], [b, c], [c, a]].map(|e| key(e, false)));
    }
    let marked = mesh.edges.iter().map(|e| e.vertices);
    sides.extend(marked.filter(|e| e.iter().all(|&v| (v as usize) < points)).map(|e| key(e, true)));
    sides.sort_unstable();
    sides.chunk_by(|a, b| a >> 1 == b >> 1).filter_map(classify).collect()
}

/// An undirected edge as one sortable number; the lowest bit says that the file marks it.
fn key([a, b]: [u32; 2], marked: bool) -> u64 {
    // A lower index of 2^31 would need a mesh of 50 GB; below that the shift loses nothing.
    u64::from(a.min(b)) << 33 | u64::from(a.max(b)) << 1 | u64::from(marked)
}

fn classify(group: &[u64]) -> Option<Edge> {
    let key = group[0];
    let vertices = [(key >> 33) as u32, (key >> 1) as u32];
    if vertices[0] == vertices[1] {
        return None;
    }
    let marks = group.iter().filter(|k| **k & 1 == 1).count();
    let kind = match (group.len() - marks, marks) {
        (1, _) => Kind::Boundary,
        (_, 0) => Kind::Interior,
        _ => Kind::Constraint,
    };
    Some(Edge { vertices, kind })
}

/// Joins edges end to end into few long strokes, each a list of point indices.
///
/// Greedy: from the first unused edge on, the walk takes the first unused edge at each point.
/// O(edges + points).
pub fn strokes(edges: &[[u32; 2]], points: usize) -> Vec<Vec<u32>> {
    let mut walk = Walk::new(edges, points);
    let mut strokes = Vec::new();
    for (i, &[a, _]) in edges.iter().enumerate() {
        if !walk.used[i] {
            strokes.push(walk.from(a));
        }
    }
    strokes
}

/// Edges by point, with a cursor at each point to the first edge that may be unused.
struct Walk<'a> {
    edges: &'a [[u32; 2]],
    /// Edge indices grouped by point; the group of point v ends at `end[v]`.
    incident: Vec<u32>,
    cursor: Vec<u32>,
    end: Vec<u32>,
    used: Vec<bool>,
}

impl<'a> Walk<'a> {
    fn new(edges: &'a [[u32; 2]], points: usize) -> Self {
        let mut end = vec![0_u32; points];
        for &v in edges.iter().flatten() {
            end[v as usize] += 1;
        }
        let mut total = 0;
        for e in &mut end {
            total += *e;
            *e = total;
        }
        // Filled from the back, so that each group ends up in order and its start is the cursor.
        let mut cursor = end.clone();
        let mut incident = vec![0_u32; total as usize];
        for (i, edge) in edges.iter().enumerate().rev() {
            for &v in edge.iter().rev() {
                cursor[v as usize] -= 1;
                incident[cursor[v as usize] as usize] = i as u32;
            }
        }
        Self { edges, incident, cursor, end, used: vec![false; edges.len()] }
    }

    fn from(&mut self, start: u32) -> Vec<u32> {
        let mut stroke = vec![start];
        let mut here = start;
        while let Some(edge) = self.take(here) {
            let [a, b] = self.edges[edge];
            here = if a == here { b } else { a };
            stroke.push(here);
        }
        stroke
    }

    fn take(&mut self, vertex: u32) -> Option<usize> {
        let v = vertex as usize;
        while self.cursor[v] < self.end[v] {
            let edge = self.incident[self.cursor[v] as usize] as usize;
            self.cursor[v] += 1;
            if !std::mem::replace(&mut self.used[edge], true) {
                return Some(edge);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::MarkedEdge;

    fn square() -> MeshData {
        MeshData {
            points: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            edges: vec![MarkedEdge { vertices: [0, 1], marker: 1 }],
            ..MeshData::default()
        }
    }

    fn kinds(mesh: &MeshData) -> Vec<([u32; 2], Kind)> {
        edges(mesh).iter().map(|e| (e.vertices, e.kind)).collect()
    }

    #[test]
    fn edges_are_listed_once_with_their_kind() {
        use Kind::{Boundary, Constraint, Interior};
        let mut mesh = square();
        let rim = [[0, 1], [0, 3], [1, 2], [2, 3]];
        let with_diagonal = |kind| {
            let mut all: Vec<_> = rim.iter().map(|&e| (e, Boundary)).collect();
            all.insert(1, ([0, 2], kind));
            all
        };
        assert_eq!(kinds(&mesh), with_diagonal(Interior));
        mesh.edges.push(MarkedEdge { vertices: [2, 0], marker: 3 });
        assert_eq!(kinds(&mesh), with_diagonal(Constraint));
        mesh.edges.push(MarkedEdge { vertices: [1, 3], marker: 3 });
        assert!(kinds(&mesh).contains(&([1, 3], Constraint)), "marked but no triangle's edge");
    }

    #[test]
    fn edges_of_broken_triangles_are_left_out_and_loops_dropped() {
        let mut mesh = square();
        mesh.triangles.extend([[0, 1, 9], [0, u32::MAX, 1], [3, 3, 3]]);
        mesh.edges.push(MarkedEdge { vertices: [0, 77], marker: 1 });
        assert_eq!(kinds(&mesh), kinds(&square()));
    }

    #[test]
    fn the_largest_indices_are_kept_apart() {
        let high = u32::MAX - 1;
        assert!(key([0, high], false) != key([high, 0], true));
        assert_eq!(key([5, high], false), key([high, 5], false));
        assert_ne!(key([1, 2], false) >> 1, key([1, 3], false) >> 1);
    }

    #[test]
    fn strokes_use_every_edge_exactly_once() {
        let list: Vec<[u32; 2]> = edges(&square()).iter().map(|e| e.vertices).collect();
        let strokes = strokes(&list, 4);
        let mut walked: Vec<[u32; 2]> = strokes
            .iter()
            .flat_map(|s| s.windows(2).map(|w| [w[0].min(w[1]), w[0].max(w[1])]))
            .collect();
        walked.sort_unstable();
        assert_eq!(walked, list);
        assert!(strokes.len() <= 2, "{strokes:?}");
    }

    #[test]
    fn no_edges_give_no_strokes() {
        assert!(strokes(&[], 0).is_empty());
        assert!(edges(&MeshData::default()).is_empty());
    }
}
