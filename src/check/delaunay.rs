//! The Delaunay property, edge by edge.
//!
//! An interior edge is locally Delaunay when the apex on its one side does not lie inside the
//! circle of the triangle on the other. If every interior edge that is no constraint is, the mesh is
//! the constrained Delaunay triangulation (Lee and Lin 1986), up to cocircular ties; boundary edges
//! are constraints.

use super::coverage::Covered;
use super::domain::Region;
use super::edges::NONE;
use super::id::Id;
use super::report::{Collector, Draft, show_vertex};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Half-edges per piece of parallel work.
const CHUNK: usize = 1 << 14;

/// Checks M23, or M24, which exempts the constraints of the domain and the marked edges of the file.
pub(super) fn check(
    id: Id,
    covered: &Covered<'_>,
    region: Option<&Region>,
    out: &mut Collector<'_>,
) {
    let exempt = if id == Id::NotConstrainedDelaunay {
        constraints(covered, region)
    } else {
        BTreeSet::new()
    };
    let sound = covered.sound;
    for half_edge in violations(covered, &exempt) {
        let [a, b, c, d] = corners(covered, half_edge);
        out.add(id, || {
            let show = |v| show_vertex(sound.mesh, v);
            let text = format!(
                "the edge from {} to {} is not locally Delaunay: {} lies inside the circle of its \
                 other triangle",
                show(a),
                show(b),
                show(d)
            );
            let twin = covered.edges.twin[half_edge as usize];
            let triangles = [half_edge / 3, twin / 3].map(|t| sound.origin(t));
            Draft::new(id, text).triangles(triangles).vertices([a, b, c, d])
        });
    }
}

/// Edges that need not be locally Delaunay, lower vertex first.
fn constraints(covered: &Covered<'_>, region: Option<&Region>) -> BTreeSet<(u32, u32)> {
    let sound = covered.sound;
    let count = sound.mesh.points.len() as u32;
    let marked =
        sound.mesh.edges.iter().map(|e| e.vertices).filter(|e| e.iter().all(|&v| v < count));
    let marked = marked.map(|e| e.map(|v| sound.vertex(v)));
    let vertices = region.map(|r| super::conform::domain_vertices(sound, r));
    let given = region.zip(vertices).map(|(region, vertices)| {
        let edges = region.constraints.iter();
        edges.map(|e| [e.from, e.to].map(|p| vertices[p as usize])).collect::<Vec<_>>()
    });
    marked.chain(given.into_iter().flatten()).map(|[a, b]| (a.min(b), a.max(b))).collect()
}

/// Ends of a half-edge, the apex of its triangle and the apex across.
fn corners(covered: &Covered<'_>, half_edge: u32) -> [u32; 4] {
    let corner =
        |h: u32, k: u32| covered.sound.triangles[(h / 3) as usize][((h % 3 + k) % 3) as usize];
    let twin = covered.edges.twin[half_edge as usize];
    [corner(half_edge, 0), corner(half_edge, 1), corner(half_edge, 2), corner(twin, 2)]
}

/// The half-edges, one per edge, whose twin's apex lies inside the circle of their triangle.
fn violations(covered: &Covered<'_>, exempt: &BTreeSet<(u32, u32)>) -> Vec<u32> {
    let piece = |(chunk, twins): (usize, &[u32])| {
        let mut found = Vec::new();
        for (half_edge, &twin) in ((chunk * CHUNK) as u32..).zip(twins) {
            if twin == NONE || twin < half_edge {
                continue;
            }
            let all = corners(covered, half_edge);
            let ends = (all[0].min(all[1]), all[0].max(all[1]));
            let inside = || covered.plane.incircle(all).is_gt();
            if !exempt.contains(&ends) && inside() {
                found.push(half_edge);
            }
        }
        found
    };
    covered.edges.twin.par_chunks(CHUNK).enumerate().flat_map_iter(piece).collect()
}
