//! How many triangles vertices have, and which changes of topology that suggests.

use super::energy::inverse_mean_ratio;
use super::patch::Change;
use super::smooth::NOWHERE;
use crate::point::Point2;
use crate::triangulation::{HalfEdgeId, Triangulation, VertexId};

/// What a vertex has.
const REGULAR: usize = 6;
/// A regular vertex with a triangle worse than this is tried too.
const BAD: f64 = 1.1;

/// A mesh as its vertices see it.
#[derive(Clone, Copy)]
pub(super) struct Degrees<'a> {
    pub(super) mesh: &'a Triangulation,
    pub(super) points: &'a [Point2],
    /// A half-edge out of each vertex, or [`NOWHERE`].
    pub(super) outgoing: &'a [HalfEdgeId],
}

/// What a mesh is like.
pub(super) struct Survey {
    /// For each vertex whether it may have a defect.
    pub(super) irregular: Vec<bool>,
    /// Mean inverse mean ratio of the triangles.
    pub(super) mean: f64,
}

impl Degrees<'_> {
    /// The worst inverse mean ratio around a vertex where that calls for a change: where the vertex
    /// is irregular or has a bad triangle.
    pub(super) fn defect(&self, v: VertexId) -> Option<f64> {
        let start = self.out_of(v)?;
        let worst = self.worst(start);
        (worst > BAD || self.degree(start) != Some(REGULAR)).then_some(worst)
    }

    /// Looks at all vertices and triangles at once, in the order of the triangles.
    pub(super) fn survey(&self) -> Survey {
        // Six triangles, none of them bad; more than 127 are not told from each other.
        const IS_BAD: u8 = 128;
        let mut counts = vec![0_u8; self.points.len()];
        let mut sum = 0.0;
        for t in self.mesh.triangles() {
            let corners = self.mesh.corners(t);
            let [a, b, c] = corners.map(|v| self.points[v.index()]);
            let f = inverse_mean_ratio(a, b, c);
            sum += f;
            let bad = if f > BAD { IS_BAD } else { 0 };
            for v in corners {
                let count = &mut counts[v.index()];
                *count = ((*count & !IS_BAD) + 1).min(IS_BAD - 1) | (*count & IS_BAD) | bad;
            }
        }
        let irregular = counts.into_iter().map(|count| usize::from(count) != REGULAR).collect();
        Survey { irregular, mean: sum / self.mesh.live_count() as f64 }
    }

    /// Adds the changes worth trying around a vertex that are not in the list yet.
    pub(super) fn changes(&self, v: VertexId, list: &mut Vec<Change>) {
        let Some(start) = self.out_of(v) else { return };
        let mut add = |change| {
            if !list.contains(&change) {
                list.push(change);
            }
        };
        let own = self.charge(v);
        let is_bad = self.worst(start) > BAD;
        if own < 0 || is_bad {
            add(Change::Remove(v));
        }
        for e in self.mesh.star(start) {
            let e = if own < 0 { e.next() } else { e };
            let Some(twin) = self.mesh.twin(e) else { continue };
            let [a, b] = [self.mesh.origin(e), self.mesh.dest(e)];
            let ends = self.charge(a) + self.charge(b);
            let apexes = self.charge(self.mesh.apex(e)) + self.charge(self.mesh.apex(twin));
            // A flip takes one triangle from each end and gives one to each apex.
            if ends + 1 > apexes || is_bad {
                add(Change::Flip(a.min(b), a.max(b)));
            }
            if own > 0 && apexes < 0 || is_bad {
                add(Change::Split(a.min(b), a.max(b)));
            }
        }
    }

    fn out_of(&self, v: VertexId) -> Option<HalfEdgeId> {
        Some(self.outgoing[v.index()]).filter(|&e| e != NOWHERE)
    }

    /// Worst inverse mean ratio around the origin of `e`.
    fn worst(&self, e: HalfEdgeId) -> f64 {
        let shape = |h: HalfEdgeId| {
            let [a, b, c] = self.mesh.corners(h.triangle()).map(|v| self.points[v.index()]);
            inverse_mean_ratio(a, b, c)
        };
        self.mesh.star(e).map(shape).fold(1.0, f64::max)
    }

    /// Number of triangles at the origin of `e`, `None` on a border.
    fn degree(&self, e: HalfEdgeId) -> Option<usize> {
        let mut degree = 0;
        let mut at = e;
        loop {
            degree += 1;
            at = self.mesh.rotate_ccw(at)?;
            if at == e {
                return Some(degree);
            }
        }
    }

    /// How many triangles a vertex has too many; 0 on the border, where none is known to be right.
    fn charge(&self, v: VertexId) -> i32 {
        let degree = self.out_of(v).and_then(|e| self.degree(e));
        degree.map_or(0, |degree| degree as i32 - REGULAR as i32)
    }
}
