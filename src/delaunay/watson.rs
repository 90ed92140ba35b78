//! Incremental insertion by cavities.
//!
//! Watson, *Computing the n-dimensional Delaunay tessellation with application to Voronoi
//! polytopes*, 1981 (and Bowyer in the same year): the triangles whose circle holds the new point
//! are removed, and the star-shaped hole they leave is filled by joining its edges to the point.
//! Differs from the paper in two ways: instead of a super-triangle there is a ghost triangle on
//! every hull edge, whose circle is the half-plane beyond; and the hole is found by walking to the
//! point and spreading from there, in place of a search through all triangles not yet finished.

use super::assemble::sorted_line;
use super::incremental::{conflicts, first_off_line, seed};
use super::order::hilbert_order;
use crate::point::Point2;
use crate::triangulation::locate::Location;
use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation, VertexId};

/// Delaunay triangulation of distinct finite points in lexicographic order.
pub(crate) fn triangulate(points: &[Point2]) -> Triangulation {
    let order = hilbert_order(points);
    let Some(third) = first_off_line(points, &order) else { return sorted_line(points) };
    let mut triangulation = Triangulation::with_capacity(2 * points.len());
    let mut hint = seed(&mut triangulation, points, [order[0], order[1], order[third]]);
    for (i, &v) in order.iter().enumerate().skip(2).filter(|&(i, _)| i != third) {
        debug_assert!(i >= 2, "the first two are in the seed");
        hint = insert(&mut triangulation, points, VertexId(v), hint);
    }
    triangulation
}

fn insert(
    triangulation: &mut Triangulation,
    points: &[Point2],
    v: VertexId,
    hint: TriangleId,
) -> TriangleId {
    let p = points[v.index()];
    let first = match triangulation.locate(points, p, hint) {
        Location::Inside(t) => t,
        Location::OnEdge(e) => e.triangle(),
        Location::Outside(e) => triangulation.twin(e).expect("ghosts surround the hull").triangle(),
        Location::OnVertex(_) => unreachable!("points are distinct"),
    };
    let (cavity, rim) = cavity(triangulation, points, p, first);
    for t in cavity {
        triangulation.remove(t);
    }
    fill(triangulation, v, rim)
}

/// The connected set of triangles whose circle holds `p`, and its rim: for each edge of the hole,
/// counterclockwise from `a` to `b`, the half-edge `b -> a` outside.
fn cavity(
    triangulation: &mut Triangulation,
    points: &[Point2],
    p: Point2,
    first: TriangleId,
) -> (Vec<TriangleId>, Vec<HalfEdgeId>) {
    const IN_CAVITY: u32 = 1;
    let mut cavity = vec![first];
    let mut rim = Vec::new();
    triangulation.set_mark(first, IN_CAVITY);
    let mut next = 0;
    while next < cavity.len() {
        for e in cavity[next].half_edges() {
            let outer = triangulation.twin(e).expect("ghosts close the surface");
            let t = outer.triangle();
            if triangulation.mark(t) == IN_CAVITY {
                continue;
            }
            if conflicts(triangulation, points, t, p) {
                triangulation.set_mark(t, IN_CAVITY);
                cavity.push(t);
            } else {
                rim.push(outer);
            }
        }
        next += 1;
    }
    (cavity, rim)
}

/// Joins every edge of the rim to `v`; neighbours meet where one edge ends and another starts.
fn fill(triangulation: &mut Triangulation, v: VertexId, rim: Vec<HalfEdgeId>) -> TriangleId {
    let mut spokes: Vec<(VertexId, TriangleId)> = Vec::with_capacity(rim.len());
    for outer in rim {
        let (a, b) = (triangulation.dest(outer), triangulation.origin(outer));
        let t = triangulation.add([a, b, v]);
        triangulation.link(t.half_edge(0), outer);
        spokes.push((a, t));
    }
    spokes.sort_unstable_by_key(|&(start, _)| start);
    for &(_, t) in &spokes {
        let end = triangulation.dest(t.half_edge(0));
        let next =
            spokes.binary_search_by_key(&end, |&(start, _)| start).expect("the rim is closed");
        triangulation.link(t.half_edge(1), spokes[next].1.half_edge(2));
    }
    spokes[0].1
}
