//! The surface to be remeshed: equal points made one, and every reason why it is none.

use super::RemeshError;
use crate::mesh::{MeshData, NO_POINT};
use crate::skin::{BadEdge, linked};
use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation};
use crate::vector::{Vector, cross, dot, key, norm, sub, unit};
use std::collections::BTreeMap;

/// A manifold triangulated surface.
pub(super) struct Input {
    /// Points, each in some triangle, no two of them equal.
    pub(super) points: Vec<Vector>,
    /// Triangles.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Unit normals of the triangles; zero for one without area.
    pub(super) normals: Vec<Vector>,
    /// Region marker of each triangle; empty where the mesh has none.
    pub(super) regions: Vec<i32>,
    /// Markers of edges, by their lower and upper vertex.
    pub(super) markers: BTreeMap<[u32; 2], i32>,
    /// Half-edges: triangle t of the topology is triangle t of the list.
    pub(super) mesh: Triangulation,
}

impl Input {
    /// # Errors
    /// What is wrong with the mesh as a surface, with its place.
    pub(super) fn new(mesh: &MeshData) -> Result<Self, RemeshError> {
        if let Some(bad) = mesh.bad_references.first() {
            return Err(RemeshError::BadReference { triangle: bad.triangle, value: bad.value });
        }
        if mesh.triangles.is_empty() {
            return Err(RemeshError::Empty);
        }
        let (number, points) = merged(mesh)?;
        let renumbered = |v: u32| number[v as usize];
        let triangles: Vec<[u32; 3]> = mesh.triangles.iter().map(|t| t.map(renumbered)).collect();
        for (i, &[a, b, c]) in triangles.iter().enumerate() {
            if a == b || b == c || c == a {
                let at = points[if a == b { a } else { c } as usize];
                return Err(RemeshError::Collapsed { triangle: i as u32, at });
            }
        }
        let mut markers = BTreeMap::new();
        for edge in &mesh.edges {
            let [a, b] = edge.vertices.map(renumbered);
            if a != NO_POINT && b != NO_POINT && a != b {
                markers.insert([a.min(b), a.max(b)], edge.marker);
            }
        }
        let topology = linked(&triangles).map_err(|bad| bad_edge(bad, &points))?;
        assert_no_pinch(&topology, &points)?;
        let normal = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| points[v as usize]);
            unit(cross(sub(b, a), sub(c, a))).unwrap_or([0.0; 3])
        };
        let normals = triangles.iter().map(normal).collect();
        let regions = mesh.regions.clone();
        Ok(Self { points, triangles, normals, regions, markers, mesh: topology })
    }

    /// Turn of the normal across an edge, in degrees; 0 beside a triangle without area.
    pub(super) fn turn_deg(&self, e: HalfEdgeId, f: HalfEdgeId) -> f64 {
        let [n, m] = [e, f].map(|h| self.normals[h.triangle().index()]);
        if norm(n) == 0.0 || norm(m) == 0.0 {
            return 0.0;
        }
        libm::acos(dot(n, m).clamp(-1.0, 1.0)).to_degrees()
    }

    /// Diagonal of the box around the points.
    pub(super) fn diagonal(&self) -> f64 {
        let (mut low, mut high) = (self.points[0], self.points[0]);
        for p in &self.points {
            for i in 0..3 {
                low[i] = low[i].min(p[i]);
                high[i] = high[i].max(p[i]);
            }
        }
        norm(sub(high, low))
    }
}

/// The new number of each point in use, and the points: equal ones are one.
fn merged(mesh: &MeshData) -> Result<(Vec<u32>, Vec<Vector>), RemeshError> {
    let mut number = vec![NO_POINT; mesh.points.len()];
    let mut known = BTreeMap::new();
    let mut points = Vec::new();
    for &v in mesh.triangles.iter().flatten() {
        let Some(&at) = mesh.points.get(v as usize) else {
            return Err(RemeshError::BadReference { triangle: 0, value: i64::from(v) });
        };
        if at.iter().any(|x| !x.is_finite()) {
            return Err(RemeshError::NotFinite { point: v, at });
        }
        if number[v as usize] == NO_POINT {
            number[v as usize] = *known.entry(key(at)).or_insert_with(|| {
                points.push(at);
                points.len() as u32 - 1
            });
        }
    }
    Ok((number, points))
}

/// Why an edge is none of a surface.
fn bad_edge(bad: BadEdge, points: &[Vector]) -> RemeshError {
    let [from, to] = bad.vertices.map(|v| points[v as usize]);
    match bad.count {
        2 => RemeshError::Orientation { from, to },
        count => RemeshError::Crowded { count, from, to },
    }
}

/// Every vertex has one fan of triangles.
fn assert_no_pinch(mesh: &Triangulation, points: &[Vector]) -> Result<(), RemeshError> {
    let mut corners = vec![0_usize; points.len()];
    for v in mesh.triangles().flat_map(|t| mesh.corners(t)) {
        corners[v.index()] += 1;
    }
    for (v, e) in mesh.outgoing(points.len()).into_iter().enumerate() {
        let Some(e) = e else { continue };
        if mesh.star(e).count() != corners[v] {
            return Err(RemeshError::Pinch { at: points[v] });
        }
    }
    Ok(())
}

/// The smooth part that each triangle lies on: what can be reached without crossing a feature.
pub(super) fn parts(mesh: &Triangulation) -> Vec<u32> {
    let mut part = vec![u32::MAX; mesh.slot_count()];
    let mut count = 0;
    for seed in mesh.triangles() {
        if part[seed.index()] != u32::MAX {
            continue;
        }
        part[seed.index()] = count;
        let mut open: Vec<TriangleId> = vec![seed];
        while let Some(t) = open.pop() {
            for e in t.half_edges().into_iter().filter(|&e| !mesh.is_constrained(e)) {
                let Some(f) = mesh.twin(e) else { continue };
                if part[f.triangle().index()] == u32::MAX {
                    part[f.triangle().index()] = count;
                    open.push(f.triangle());
                }
            }
        }
        count += 1;
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> MeshData {
        MeshData {
            points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
            ..MeshData::default()
        }
    }

    fn error(mesh: &MeshData) -> RemeshError {
        Input::new(mesh).err().expect("no surface")
    }

    // spec: U1
    #[test]
    fn a_closed_surface_is_linked_all_round_and_equal_points_are_one() {
        let mut mesh = tetrahedron();
        // An unused point, and a copy of a used one with another sign of zero.
        mesh.points.extend([[9.0; 3], [-0.0, 0.0, 1.0]]);
        mesh.triangles[3] = [2, 0, 5];
        let input = Input::new(&mesh).expect("a surface");
        assert_eq!(input.points.len(), 4);
        assert!(
            input
                .mesh
                .triangles()
                .flat_map(TriangleId::half_edges)
                .all(|e| { input.mesh.twin(e).is_some() })
        );
        assert_eq!(parts(&input.mesh), [0; 4]);
    }

    // spec: U1
    #[test]
    fn what_is_no_manifold_surface_is_refused_with_its_place() {
        let mut crowded = tetrahedron();
        crowded.points.push([1.0, 1.0, 1.0]);
        crowded.triangles.push([0, 1, 4]);
        assert!(matches!(error(&crowded), RemeshError::Crowded { count: 3, .. }));
        let mut turned = tetrahedron();
        turned.triangles[0].swap(0, 1);
        assert!(matches!(error(&turned), RemeshError::Orientation { .. }));
        let mut flat = tetrahedron();
        flat.triangles[2] = [1, 1, 3];
        assert!(matches!(error(&flat), RemeshError::Collapsed { triangle: 2, .. }));
        let mut pinched = tetrahedron();
        let more = [[2.0, 0.0, 5.0], [0.0, 2.0, 5.0]];
        pinched.points.extend(more);
        pinched.triangles.push([3, 4, 5]);
        assert_eq!(error(&pinched), RemeshError::Pinch { at: [0.0, 0.0, 1.0] });
        assert_eq!(error(&MeshData::default()), RemeshError::Empty);
    }

    // spec: U1
    #[test]
    fn points_that_are_none_are_refused() {
        let mut infinite = tetrahedron();
        infinite.points[2][1] = f64::INFINITY;
        assert!(matches!(error(&infinite), RemeshError::NotFinite { point: 2, .. }));
        let mut missing = tetrahedron();
        missing.triangles[1][2] = 77;
        assert!(matches!(error(&missing), RemeshError::BadReference { value: 77, .. }));
    }
}
