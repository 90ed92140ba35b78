//! Where a mesh leaves its surface by more than was asked for, and the spacings that would mend it.
//!
//! Curvature says how far an equilateral triangle leaves the surface. Beside poles and where the
//! curvature changes fast triangles leave it farther, so that the mesh is measured, and made again
//! with a finer spacing where it is too coarse.

use super::growth::Source;
use super::patch::PatchMesh;
use super::trim::descend;
use crate::surface::Surface;
use crate::vector::{Vector, add, distance, scale};

/// A triangle that leaves the surface by the error allowed asks for this much less than its square
/// root law says, so that a few rounds do.
const SAFETY: f64 = 0.9;

/// Spacings for the triangles of a patch that are farther from it than `limit`; none is below `floor`.
pub(super) fn excess(surface: &Surface, patch: &PatchMesh, limit: f64, floor: f64) -> Vec<Source> {
    let mut sources = Vec::new();
    for t in patch.mesh.triangles() {
        let corners = patch.mesh.corners(t).map(|v| v.index());
        let at = corners.map(|v| patch.lifts[v].point);
        let uv = corners.map(|v| patch.parameters[v]);
        let worst =
            samples().map(|weights| deviation(surface, weights, at, uv)).fold(0.0, f64::max);
        if worst > limit {
            let longest = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| distance(at[i], at[j]));
            let longest = longest.into_iter().fold(0.0, f64::max);
            let spacing = (SAFETY * longest * (limit / worst).sqrt()).max(floor);
            sources.push(Source { at: mean([1.0 / 3.0; 3], at), spacing });
        }
    }
    sources
}

/// The centre and the middles of the sides, as weights of the corners.
fn samples() -> impl Iterator<Item = [f64; 3]> {
    [[1.0 / 3.0; 3], [0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]].into_iter()
}

fn mean([r, s, t]: [f64; 3], [a, b, c]: [Vector; 3]) -> Vector {
    add(scale(r, a), add(scale(s, b), scale(t, c)))
}

/// Distance of a point of a triangle from the surface, whose nearest point is searched for from the
/// same mean of the parameters.
fn deviation(surface: &Surface, weights: [f64; 3], at: [Vector; 3], uv: [[f64; 2]; 3]) -> f64 {
    let p = mean(weights, at);
    let part = |i: usize| (0..3).map(|k| weights[k] * uv[k][i]).sum();
    let [u, v] = descend(surface, [part(0), part(1)], p);
    distance(surface.at(u, v), p)
}
