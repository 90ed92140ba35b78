//! What a viewer shows of a size field: the background mesh with a spacing at each of its nodes,
//! and the spacing that each triangle was to have.

use crate::domain::validate::Plc;
use crate::draw::{Better, Layer};
use crate::improve::ImproveOptions;
use crate::mesh::MeshData;
use crate::mesher::{Count, Method, Options, Unobserved, mesh_plc};

/// The background mesh of a domain and the spacings at its nodes.
#[derive(Clone, Debug)]
pub struct NodalSpacing {
    /// The constrained Delaunay triangulation of the boundary.
    pub mesh: MeshData,
    /// One for each of its points.
    pub spacing: Vec<f64>,
}

/// The background that the mesher itself would use with these options; `None` where there is none.
#[must_use]
pub fn nodal_spacing(plc: Plc, options: &Options) -> Option<NodalSpacing> {
    let options = Options {
        method: Method::DelaunayInitial,
        improve: ImproveOptions::NONE,
        count: Count::Field,
        split_boundary: false,
        ..options.clone()
    };
    let meshed = mesh_plc(plc, &options, &mut Unobserved).ok()?;
    let is_known = meshed.spacing.iter().all(|h| h.is_finite());
    let spacing = if is_known { meshed.spacing } else { Vec::new() };
    Some(NodalSpacing { mesh: MeshData::from(&meshed.mesh), spacing })
}

/// The wanted spacing of each triangle, and its mean edge over that; none where no spacing was asked
/// for.
#[must_use]
pub fn spacing_layers(mesh: &MeshData, spacing: &[f64]) -> Vec<Layer> {
    if spacing.len() != mesh.points.len() || !spacing.iter().all(|h| h.is_finite()) {
        return Vec::new();
    }
    let mean = |t: &[u32; 3]| t.iter().map(|&v| spacing[v as usize]).sum::<f64>() / 3.0;
    let wanted: Vec<f64> = mesh.triangles.iter().map(mean).collect();
    let edge = |a: u32, b: u32| {
        let (p, q) = (mesh.points[a as usize], mesh.points[b as usize]);
        libm::hypot(q[0] - p[0], q[1] - p[1])
    };
    let fit = mesh.triangles.iter().zip(&wanted).map(|(&[a, b, c], h)| {
        let perimeter = edge(a, b) + edge(b, c) + edge(c, a);
        perimeter / 3.0 / h
    });
    let fit = Layer::new("mean edge / wanted spacing", fit.collect(), Better::Low);
    vec![Layer::new("wanted spacing", wanted, Better::Low), Layer { range: [0.5, 1.5], ..fit }]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::naca::naca0012;
    use crate::domain::validate::validate;

    // spec: G21
    #[test]
    fn every_node_of_the_background_has_the_spacing_of_the_boundary_there() {
        let plc = validate(&naca0012()).expect("sound");
        let points = plc.points.len();
        let nodal = nodal_spacing(plc, &Options::default()).expect("there is one");
        assert_eq!((nodal.mesh.points.len(), nodal.spacing.len()), (points, points));
        assert_eq!(nodal.mesh.triangles.len(), points, "one hole: n + 2 h - 2");
        let (low, high) = (0..points).fold((f64::INFINITY, 0.0_f64), |(low, high), i| {
            (low.min(nodal.spacing[i]), high.max(nodal.spacing[i]))
        });
        assert!(low < 1e-3 && high > 1.0, "{low} {high}");
    }

    // spec: G21
    #[test]
    fn layers_compare_each_triangle_with_the_spacing_at_its_corners() {
        let mesh = MeshData {
            points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.5, 0.75_f64.sqrt(), 0.0]],
            triangles: vec![[0, 1, 2]],
            ..MeshData::default()
        };
        let layers = spacing_layers(&mesh, &[1.0, 2.0, 3.0]);
        assert_eq!(layers[0].values, [2.0]);
        assert!((layers[1].values[0] - 0.5).abs() < 1e-12);
        assert!(spacing_layers(&mesh, &[1.0]).is_empty(), "spacings of another mesh");
        assert!(spacing_layers(&mesh, &[1.0, f64::INFINITY, 1.0]).is_empty(), "no field");
    }
}
