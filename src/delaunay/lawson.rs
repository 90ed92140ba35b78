//! Incremental insertion with edge flips.
//!
//! Lawson, *Software for C1 surface interpolation*, 1977. A point splits the triangle or edge it
//! lies on; every edge opposite it that has the point inside the circle of the triangle beyond is
//! flipped, which makes two more such edges. The outside is made of ghost triangles, one for each
//! hull edge, whose "circle" is the open half-plane beyond the edge together with the open edge: so
//! a point outside the hull is no special case, and no artificial coordinates exist.

use super::order::hilbert_order;
use crate::point::Point2;
use crate::predicates::{Sign, incircle_perturbed, orient2d};
use crate::triangulation::locate::{Location, between};
use crate::triangulation::{GHOST, HalfEdgeId, TriangleId, Triangulation, VertexId};

/// Delaunay triangulation of distinct finite points, in Hilbert order.
pub(crate) fn triangulate(points: &[Point2]) -> Triangulation {
    let order = hilbert_order(points);
    insert_all(points, &order)
}

/// Inserts the points in the order given.
pub(crate) fn insert_all(points: &[Point2], order: &[u32]) -> Triangulation {
    let Some(third) = first_off_line(points, order) else {
        return line(points, order);
    };
    let mut triangulation = Triangulation::with_capacity(2 * points.len() + 2);
    let mut hint = seed(&mut triangulation, points, [order[0], order[1], order[third]]);
    for (i, &v) in order.iter().enumerate().skip(2) {
        if i != third {
            hint = insert(&mut triangulation, points, VertexId(v), hint);
        }
    }
    triangulation
}

/// Position in the order of the first point that is not in line with the first two.
fn first_off_line(points: &[Point2], order: &[u32]) -> Option<usize> {
    let [a, b] = [order.first()?, order.get(1)?].map(|&v| points[v as usize]);
    let off = |&v: &u32| orient2d(a, b, points[v as usize]) != Sign::Zero;
    order.iter().skip(2).position(off).map(|i| i + 2)
}

/// One triangle and its three ghosts.
fn seed(triangulation: &mut Triangulation, points: &[Point2], corners: [u32; 3]) -> TriangleId {
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

/// Points all on one line: two ghosts for each piece of it, and nothing finite. One point or none
/// gives an empty triangulation.
pub(crate) fn line(points: &[Point2], order: &[u32]) -> Triangulation {
    let mut sorted: Vec<VertexId> = order.iter().map(|&v| VertexId(v)).collect();
    sorted.sort_unstable_by(|a, b| points[a.index()].lexicographic(points[b.index()]));
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

/// Inserts vertex `v`, distinct from all others, into a (constrained) Delaunay triangulation with
/// ghosts, walking from `hint`; returns a triangle at `v`.
pub(crate) fn insert(
    triangulation: &mut Triangulation,
    points: &[Point2],
    v: VertexId,
    hint: TriangleId,
) -> TriangleId {
    let mut opposite = match triangulation.locate(points, points[v.index()], hint) {
        Location::Inside(t) => triangulation.split_triangle(t, v).to_vec(),
        Location::OnEdge(e) => triangulation.split_edge(e, v),
        Location::Outside(e) => {
            let ghost = triangulation.twin(e).expect("ghosts surround the hull");
            triangulation.split_triangle(ghost.triangle(), v).to_vec()
        }
        Location::OnVertex(_) => return hint,
    };
    let at = opposite[0].triangle();
    legalize(triangulation, points, v, &mut opposite);
    at
}

/// Flips until every edge opposite `v` is Delaunay; `opposite` holds edges whose triangle's apex
/// is `v`.
pub(crate) fn legalize(
    triangulation: &mut Triangulation,
    points: &[Point2],
    v: VertexId,
    opposite: &mut Vec<HalfEdgeId>,
) {
    let p = points[v.index()];
    while let Some(e) = opposite.pop() {
        let Some(f) = triangulation.twin(e).filter(|_| !triangulation.is_constrained(e)) else {
            continue;
        };
        if in_circle(triangulation, points, f.triangle(), p) {
            triangulation.flip(e);
            opposite.push(e.prev());
            opposite.push(f.next());
        }
    }
}

/// Whether `p` lies in the perturbed open circle of a triangle, ghost or not.
pub(crate) fn in_circle(
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
