//! How well a mesh obeys a size field that somebody gives: edge length over the spacing wanted at
//! the edge's middle. A measurement in floats; no finding rests on it.

use super::tree::{Bounds, Tree};
use crate::format::node_data::NodeData;
use crate::mesh::MeshData;
use serde::Serialize;

/// Percentiles of edge length over wanted spacing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SizeFit {
    /// First percentile.
    pub percentile_1: f64,
    /// Median.
    pub median: f64,
    /// 99th percentile.
    pub percentile_99: f64,
    /// Edges measured: those with a triangle on either side.
    pub edges: u64,
    /// Edges left out because their middle is in no triangle of the field, or its value there is no
    /// spacing.
    pub outside: u64,
}

/// Measures the edges inside the mesh; `None` when none can be measured.
///
/// O(n log n) for n edges and triangles of the field.
#[must_use]
pub fn size_fit(mesh: &MeshData, field: &NodeData) -> Option<SizeFit> {
    let sound = |t: &&[u32; 3]| t.iter().all(|&v| (v as usize) < field.points.len());
    let triangles: Vec<[u32; 3]> = field.triangles.iter().filter(sound).copied().collect();
    let corners = |t: &[u32; 3]| t.map(|v| field.points[v as usize]);
    let tree = Tree::new(triangles.iter().map(|t| Bounds::around(corners(t))));
    let wanted = |p: [f64; 2]| {
        let mut found: Option<f64> = None;
        tree.visit(&Bounds::around([p]), |i| {
            let t = &triangles[i as usize];
            if found.is_none()
                && let Some(weights) = weights(corners(t), p)
            {
                let value: f64 = (0..3).map(|k| weights[k] * field.values[t[k] as usize]).sum();
                found = (value > 0.0 && value.is_finite()).then_some(value);
            }
        });
        found
    };
    let mut outside = 0;
    let mut ratios = Vec::new();
    for [a, b] in inner_edges(mesh) {
        let [[ax, ay, _], [bx, by, _]] = [a, b].map(|v| mesh.points[v as usize]);
        match wanted([0.5 * ax + 0.5 * bx, 0.5 * ay + 0.5 * by]) {
            Some(spacing) => ratios.push(((bx - ax).powi(2) + (by - ay).powi(2)).sqrt() / spacing),
            None => outside += 1,
        }
    }
    ratios.sort_by(f64::total_cmp);
    let at = |share: f64| ratios[((ratios.len() - 1) as f64 * share) as usize];
    let edges = ratios.len() as u64;
    (edges > 0).then(|| SizeFit {
        percentile_1: at(0.01),
        median: at(0.5),
        percentile_99: at(0.99),
        edges,
        outside,
    })
}

/// Each edge that two triangles have, once.
fn inner_edges(mesh: &MeshData) -> Vec<[u32; 2]> {
    let count = mesh.points.len();
    let mut sides: Vec<[u32; 2]> = mesh
        .triangles
        .iter()
        .filter(|t| t.iter().all(|&v| (v as usize) < count))
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]].map(|[u, v]| [u.min(v), u.max(v)]))
        .collect();
    sides.sort_unstable();
    let twice = sides.chunk_by(|s, t| s == t).filter(|group| group.len() > 1);
    twice.map(|group| group[0]).collect()
}

/// Barycentric coordinates of a point of the triangle, whatever its orientation.
fn weights([a, b, c]: [[f64; 2]; 3], p: [f64; 2]) -> Option<[f64; 3]> {
    let area = |u: [f64; 2], v: [f64; 2], w: [f64; 2]| {
        (v[0] - u[0]) * (w[1] - u[1]) - (v[1] - u[1]) * (w[0] - u[0])
    };
    let whole = area(a, b, c);
    let weights = [area(b, c, p) / whole, area(c, a, p) / whole, area(a, b, p) / whole];
    // On a side a weight may round to just below 0.
    weights.iter().all(|&w| w >= -1e-9).then_some(weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh() -> MeshData {
        // A square cut into four by its centre: four inner edges of length sqrt(2).
        let points = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0]];
        MeshData {
            points: points.iter().map(|&[x, y]| [x, y, 0.0]).collect(),
            triangles: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
            ..MeshData::default()
        }
    }

    fn field(values: [f64; 4]) -> NodeData {
        NodeData {
            points: vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]],
            values: values.to_vec(),
            triangles: vec![[0, 1, 2], [0, 3, 2]],
        }
    }

    // spec: C70
    #[test]
    fn inner_edges_are_measured_at_their_middle() {
        let fit = size_fit(&mesh(), &field([2.0; 4])).expect("four edges");
        assert!((fit.median - 0.5_f64.sqrt()).abs() < 1e-12);
        assert_eq!((fit.edges, fit.outside), (4, 0));
        let fit = size_fit(&mesh(), &field([1.0, 2.0, 3.0, 2.0])).expect("four edges");
        assert!((fit.percentile_1 - 2.0_f64.sqrt() / 2.5).abs() < 1e-12, "{fit:?}");
    }

    // spec: !C70
    #[test]
    fn what_the_field_does_not_cover_is_counted_and_left_out() {
        let half = NodeData { triangles: vec![[0, 1, 2]], ..field([2.0; 4]) };
        let fit = size_fit(&mesh(), &half).expect("three edges");
        assert_eq!((fit.edges, fit.outside), (3, 1), "the diagonal's halves are covered");
        let nan = size_fit(&mesh(), &field([f64::NAN; 4]));
        assert_eq!(nan, None);
        let wild = NodeData { triangles: vec![[0, 1, 99]], ..field([2.0; 4]) };
        assert_eq!(size_fit(&mesh(), &wild), None);
        assert_eq!(size_fit(&MeshData::default(), &field([2.0; 4])), None);
    }
}
