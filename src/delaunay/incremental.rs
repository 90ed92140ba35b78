//! What the incremental engines start from, and the circle of a triangle, ghost or not.

use crate::point::Point2;
use crate::predicates::{Sign, incircle_perturbed, orient2d};
use crate::triangulation::locate::between;
use crate::triangulation::{GHOST, TriangleId, Triangulation, VertexId};

/// Position in the order of the first point that is not in line with the first two.
pub(crate) fn first_off_line(points: &[Point2], order: &[u32]) -> Option<usize> {
    let [a, b] = [order.first()?, order.get(1)?].map(|&v| points[v as usize]);
    let off = |&v: &u32| orient2d(a, b, points[v as usize]) != Sign::Zero;
    order.iter().skip(2).position(off).map(|i| i + 2)
}

/// One triangle and its three ghosts.
pub(crate) fn seed(
    triangulation: &mut Triangulation,
    points: &[Point2],
    corners: [u32; 3],
) -> TriangleId {
    let [a, b, c] = corners.map(VertexId);
    let [pa, pb, pc] = corners.map(|v| points[v as usize]);
    let ccw = orient2d(pa, pb, pc) == Sign::Positive;
    let [a, b, c] = if ccw { [a, b, c] } else { [a, c, b] };
    let t = triangulation.add([a, b, c]);
    let ghosts = [[b, a, GHOST], [c, b, GHOST], [a, c, GHOST]].map(|g| triangulation.add(g));
    for i in 0..3 {
        triangulation.link(t.half_edge(i as u32), ghosts[i].half_edge(0));
        triangulation.link(ghosts[i].half_edge(2), ghosts[(i + 1) % 3].half_edge(1));
    }
    t
}

/// Whether `p` lies in the perturbed open circle of a triangle, ghost or not.
pub(crate) fn conflicts(
    triangulation: &Triangulation,
    points: &[Point2],
    t: TriangleId,
    p: Point2,
) -> bool {
    let corners = triangulation.corners(t);
    if corners.contains(&GHOST) {
        let e = triangulation.ghost_edge(t);
        let [a, b] = [triangulation.origin(e), triangulation.dest(e)].map(|v| points[v.index()]);
        return match orient2d(a, b, p) {
            Sign::Positive => true,
            Sign::Zero => between(a, p, b),
            Sign::Negative => false,
        };
    }
    let [a, b, c] = corners.map(|v| points[v.index()]);
    incircle_perturbed(a, b, c, p) == Sign::Positive
}
