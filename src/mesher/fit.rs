//! How well the mesh obeys the field: lengths of its edges over the spacing wanted there.

use super::field::Fields;
use crate::front::FrontMesh;
use crate::point::Point2;
use crate::size::{Base, Hint};
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation};
use std::collections::VecDeque;

/// Percentiles of edge length over wanted spacing, over edges that are the mesher's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// First percentile.
    pub low: f64,
    /// Median.
    pub median: f64,
    /// 99th percentile.
    pub high: f64,
    /// How many edges were measured: all, or an even sample of a large mesh.
    pub edges: usize,
}

/// Edges measured of a large mesh.
const EDGES_MAX: usize = 200_000;

/// A hint for a field that heeds none, and where none is known.
const ANYWHERE: Hint = Hint(TriangleId(0));
/// No hint yet.
const UNKNOWN: Hint = Hint(TriangleId(u32::MAX));

/// Measures a mesh; `None` when it has no edge of its own.
pub(super) fn fit(fields: &Fields, laid: &FrontMesh, fixed: usize) -> Option<Fit> {
    let mesh = &laid.mesh;
    let hints = fields.field().heeds_hint().then(|| hints(fields, laid));
    // Edges between two given points are the domain's doing.
    let is_own = |e: &HalfEdgeId| {
        mesh.twin(*e).is_some_and(|f| *e < f)
            && [mesh.origin(*e), mesh.dest(*e)].iter().any(|v| v.index() >= fixed)
    };
    let step = (3 * mesh.live_count() / 2).div_ceil(EDGES_MAX).max(1);
    let own = mesh.triangles().flat_map(TriangleId::half_edges).filter(is_own);
    let mut ratios: Vec<f64> = own
        .step_by(step)
        .map(|e| {
            let [a, b] = [mesh.origin(e), mesh.dest(e)].map(|v| laid.points[v.index()]);
            let middle = Point2::new(0.5 * a.x + 0.5 * b.x, 0.5 * a.y + 0.5 * b.y);
            let mut hint = hints.as_ref().map_or(ANYWHERE, |hints| hints[e.triangle().index()]);
            let length = a.distance(b);
            length / fields.field().at(middle, Base { length }, &mut hint)
        })
        .collect();
    ratios.sort_by(f64::total_cmp);
    let at = |share: f64| ratios[((ratios.len() - 1) as f64 * share) as usize];
    let edges = ratios.len();
    (edges > 0).then(|| Fit { low: at(0.01), median: at(0.5), high: at(0.99), edges })
}

/// For each triangle a background triangle near it and on the same side of every wall: found from
/// the boundary inwards, neighbour by neighbour.
fn hints(fields: &Fields, laid: &FrontMesh) -> Vec<Hint> {
    let mesh = &laid.mesh;
    let mut hints = vec![UNKNOWN; mesh.slot_count()];
    let mut queue = VecDeque::new();
    let sides = fields.constraint_hints();
    for e in mesh.triangles().flat_map(TriangleId::half_edges) {
        if let Across::Border(owner) = mesh.across(e)
            && let Some(hint) = fields.hint_of_edge(owner)
            && hints[e.triangle().index()] == UNKNOWN
        {
            hints[e.triangle().index()] = hint;
            queue.push_back(e.triangle());
        }
    }
    while let Some(t) = queue.pop_front() {
        let mut hint = hints[t.index()];
        let _ = fields.field().at(centroid(mesh, &laid.points, t), Base { length: 1.0 }, &mut hint);
        hints[t.index()] = hint;
        for f in t.half_edges().into_iter().filter_map(|e| mesh.twin(e)) {
            let u = f.triangle().index();
            if hints[u] == UNKNOWN {
                // The background was cut along constraints: a walk does not cross them.
                let beyond = mesh
                    .is_constrained(f)
                    .then(|| sides.get(&[mesh.origin(f), mesh.dest(f)]).copied())
                    .flatten();
                hints[u] = beyond.unwrap_or(hint);
                queue.push_back(f.triangle());
            }
        }
    }
    for hint in hints.iter_mut().filter(|hint| **hint == UNKNOWN) {
        *hint = ANYWHERE;
    }
    hints
}

fn centroid(mesh: &Triangulation, points: &[Point2], t: TriangleId) -> Point2 {
    let corners = mesh.corners(t).map(|v| points[v.index()]);
    let mean = |c: fn(&Point2) -> f64| corners.iter().map(|p| c(p) / 3.0).sum();
    Point2::new(mean(|p| p.x), mean(|p| p.y))
}
