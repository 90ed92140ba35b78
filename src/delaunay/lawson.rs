//! Incremental insertion with edge flips.
//!
//! Lawson, *Software for C1 surface interpolation*, 1977. A point splits the triangle or edge it
//! lies on; every edge opposite it that has the point inside the circle of the triangle beyond is
//! flipped, which makes two more such edges. The outside is made of ghost triangles, one for each
//! hull edge, whose "circle" is the open half-plane beyond the edge together with the open edge: so
//! a point outside the hull is no special case, and no artificial coordinates exist.

use super::assemble::line;
use super::incremental::{conflicts, first_off_line, seed};
use super::order::hilbert_order;
use crate::point::Point2;
use crate::triangulation::locate::Location;
use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation, VertexId};

/// Delaunay triangulation of distinct finite points, in Hilbert order.
pub(crate) fn triangulate(points: &[Point2]) -> Triangulation {
    let order = hilbert_order(points);
    insert_all(points, &order)
}

/// Inserts the points in the order given.
pub(crate) fn insert_all(points: &[Point2], order: &[u32]) -> Triangulation {
    let Some(third) = first_off_line(points, order) else {
        let mut sorted: Vec<VertexId> = order.iter().map(|&v| VertexId(v)).collect();
        sorted.sort_unstable_by(|a, b| points[a.index()].lexicographic(points[b.index()]));
        return line(&sorted);
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
        if conflicts(triangulation, points, f.triangle(), p) {
            triangulation.flip(e);
            opposite.push(e.prev());
            opposite.push(f.next());
        }
    }
}

/// Flips until every edge that may flip is Delaunay.
pub(crate) fn legalize_all(triangulation: &mut Triangulation, points: &[Point2]) {
    let mut stack: Vec<HalfEdgeId> =
        triangulation.triangles().flat_map(TriangleId::half_edges).collect();
    legalize_from(triangulation, points, &mut stack);
}

/// Flips the finite edges on the stack that are not Delaunay, and those that this disturbs.
pub(crate) fn legalize_from(
    triangulation: &mut Triangulation,
    points: &[Point2],
    stack: &mut Vec<HalfEdgeId>,
) {
    while let Some(e) = stack.pop() {
        let Some(f) = triangulation.twin(e).filter(|_| !triangulation.is_constrained(e)) else {
            continue;
        };
        let apex = triangulation.apex(e);
        let ghost = triangulation.is_ghost(e.triangle()) || triangulation.is_ghost(f.triangle());
        if !ghost && conflicts(triangulation, points, f.triangle(), points[apex.index()]) {
            triangulation.flip(e);
            // A flip renames its outer edges; an edge still on the stack under its old name is one
            // of these four.
            stack.extend([e.next(), e.prev(), f.next(), f.prev()]);
        }
    }
}
