//! Edges of a patch that are one edge in space, or a point of it, because the patch is closed and so
//! narrow there that the front went around it in one or two steps: they are halved until no two are.
//!
//! A seam is in the outline twice, and so is each of its vertices. Where (u, v) has room between the
//! two sides of it, space may have none.

use super::chart::SurfaceChart;
use super::defects::Cloth;
use super::outline::Rim;
use super::patch::PatchMesh;
use super::smooth::Smoother;
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation, VertexId};
use std::collections::BTreeSet;

/// Rounds of halving: an edge from a vertex to itself takes two.
const ROUNDS: usize = 8;
/// Of these, rounds that smooth what was halved; flips there may make new doubles.
const ROUNDS_SMOOTHED: usize = 4;

/// Halves the edges inside a patch that space cannot tell from others. Those that are left after the
/// last round are for the caller to find.
pub(super) fn part(chart: &SurfaceChart<'_>, patch: &mut PatchMesh, rim: &Rim) {
    let numbers: Vec<u32> = rim.nodes.iter().map(|node| node.vertex).collect();
    if numbers.iter().collect::<BTreeSet<_>>().len() == numbers.len() {
        return;
    }
    let PatchMesh { mesh, lifts, parameters, .. } = patch;
    let place = |&[u, v]: &[f64; 2]| chart.sheet.scaled(u, v);
    let mut points: Vec<Point2> = parameters.iter().map(place).collect();
    let before = points.len();
    for round in 0..ROUNDS {
        let mut cloth = Cloth { mesh: &mut *mesh, points: &mut points, lifts: &mut *lifts };
        let (known, found) = (cloth.points.len(), doubles(cloth.mesh, &numbers));
        for (ends, e) in found {
            if [cloth.mesh.origin(e), cloth.mesh.dest(e)] == ends {
                halve(chart, &mut cloth, e);
            }
        }
        let count = cloth.points.len();
        if count == known {
            break;
        }
        if round < ROUNDS_SMOOTHED {
            let mut star = Smoother::resting(chart, numbers.len(), count);
            star.wake(&cloth, |v| v >= known);
            star.settle(&mut cloth, 2);
        }
    }
    if points.len() > before {
        *parameters = points.iter().map(|&p| chart.sheet.parameters(p)).collect();
    }
}

/// Edges inside that start where they end, or have the ends of another edge, with their ends in
/// (u, v); `numbers` are the model's vertices of the first vertices.
fn doubles(mesh: &Triangulation, numbers: &[u32]) -> Vec<([VertexId; 2], HalfEdgeId)> {
    let name = |v: VertexId| match numbers.get(v.index()) {
        Some(&number) => (0, number),
        None => (1, v.0),
    };
    let on_rim =
        |e: HalfEdgeId| [mesh.origin(e), mesh.dest(e)].iter().any(|v| v.index() < numbers.len());
    let is_pole =
        |e: HalfEdgeId| mesh.twin(e).is_none() && name(mesh.origin(e)) == name(mesh.dest(e));
    // The triangle on a pole is an edge in space: two sides of it are one.
    let beside_pole = |e: HalfEdgeId| is_pole(e.prev());
    let mut all = Vec::new();
    for e in mesh.triangles().flat_map(TriangleId::half_edges).filter(|&e| on_rim(e)) {
        let twin = mesh.twin(e);
        let is_second = twin.is_some_and(|twin| twin.0 < e.0);
        let is_left_out = beside_pole(e) || twin.is_some_and(beside_pole);
        if !is_second && !is_left_out && !is_pole(e) {
            let (a, b) = (name(mesh.origin(e)), name(mesh.dest(e)));
            all.push(([a.min(b), a.max(b)], e));
        }
    }
    all.sort_by_key(|&(ends, e)| (ends, e.0));
    let groups = all.chunk_by(|s, t| s.0 == t.0);
    let double = groups.filter(|group| group.len() > 1 || group[0].0[0] == group[0].0[1]);
    double
        .flatten()
        .filter(|(_, e)| mesh.twin(*e).is_some())
        .map(|&(_, e)| ([mesh.origin(e), mesh.dest(e)], e))
        .collect()
}

/// Halves an edge in (u, v), where its triangles see the middle.
fn halve(chart: &SurfaceChart<'_>, cloth: &mut Cloth<'_>, e: HalfEdgeId) {
    let Some(twin) = cloth.mesh.twin(e) else { return };
    let at = |v: VertexId| cloth.points[v.index()];
    let (a, b) = (at(cloth.mesh.origin(e)), at(cloth.mesh.dest(e)));
    let middle = Point2::new(0.5 * (a.x + b.x), 0.5 * (a.y + b.y));
    let sees = |h: HalfEdgeId| {
        orient2d(at(cloth.mesh.origin(h)), at(cloth.mesh.dest(h)), middle) == Sign::Positive
    };
    if [e.next(), e.prev(), twin.next(), twin.prev()].into_iter().all(sees) {
        let v = VertexId(cloth.points.len() as u32);
        cloth.points.push(middle);
        cloth.lifts.push(chart.sheet.lift(middle));
        cloth.mesh.split_edge(e, v);
    }
}
