//! Lawson's flips (Lawson 1977): until every unconstrained edge is locally Delaunay.

use crate::point::Point2;
use crate::predicates::{Sign, incircle_perturbed};
use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation};

/// Flips every edge whose opposite vertex lies inside the circumcircle, until none does; returns
/// the number of flips.
///
/// Ends because each flip lowers the surface of the triangulation lifted to the paraboloid,
/// strictly and exactly; with
/// the symbolic perturbation the result is the constrained Delaunay triangulation of the mesh's
/// points, which is unique (SPEC 2). A locally non-Delaunay edge lies in a convex quadrilateral, so
/// orientation stays positive. Linear time on a mesh that is nearly Delaunay.
pub fn flip_to_delaunay(mesh: &mut Triangulation, points: &[Point2]) -> u64 {
    let mut suspects = Vec::new();
    let mut flips = 0;
    for t in 0..mesh.slot_count() as u32 {
        let t = TriangleId(t);
        if mesh.is_live(t) {
            // Each edge once, from the side with the smaller half-edge.
            let sides = t.half_edges().into_iter();
            suspects.extend(sides.filter(|&e| mesh.twin(e).is_some_and(|f| e < f)));
            flips += flip_suspects(mesh, points, &mut suspects, |_, _| ());
        }
    }
    flips
}

/// Flips the edges in `suspects` that are not locally Delaunay and what that makes suspect, until
/// the list is empty; returns the number of flips. `flipped` is told each flipped half-edge.
pub(super) fn flip_suspects(
    mesh: &mut Triangulation,
    points: &[Point2],
    suspects: &mut Vec<HalfEdgeId>,
    mut flipped: impl FnMut(&Triangulation, HalfEdgeId),
) -> u64 {
    let mut flips = 0;
    while let Some(e) = suspects.pop() {
        if is_locally_delaunay(mesh, points, e) {
            continue;
        }
        let twin = mesh.twin(e).expect("an edge without a twin is constrained");
        suspects.extend([e.next(), e.prev(), twin.next(), twin.prev()]);
        let e = mesh.flip(e);
        flipped(mesh, e);
        flips += 1;
    }
    flips
}

fn is_locally_delaunay(mesh: &Triangulation, points: &[Point2], e: HalfEdgeId) -> bool {
    if mesh.is_constrained(e) {
        return true;
    }
    let Some(twin) = mesh.twin(e) else { return true };
    let [a, b, c] = mesh.corners(e.triangle()).map(|v| points[v.index()]);
    let d = points[mesh.apex(twin).index()];
    incircle_perturbed(a, b, c, d) != Sign::Positive
}
