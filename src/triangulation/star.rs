//! The triangles around a vertex.

use super::{HalfEdgeId, Triangulation, VertexId};

/// Iterator of [`Triangulation::star`].
pub struct Star<'a> {
    triangulation: &'a Triangulation,
    first: HalfEdgeId,
    next: Option<HalfEdgeId>,
    clockwise: bool,
}

impl Triangulation {
    /// The half-edges out of the origin of `e`, one per triangle around it: counterclockwise from
    /// `e`, and where a border stops that, on clockwise from `e`.
    #[must_use]
    pub fn star(&self, e: HalfEdgeId) -> Star<'_> {
        Star { triangulation: self, first: e, next: Some(e), clockwise: false }
    }

    /// The half-edge from the origin of `e` to `to`, if there is one with a triangle on its left.
    #[must_use]
    pub fn half_edge_to(&self, e: HalfEdgeId, to: VertexId) -> Option<HalfEdgeId> {
        self.star(e).find(|&h| self.dest(h) == to)
    }

    /// For each of `vertices` vertices a half-edge out of it, or `None` for one in no triangle.
    /// The one chosen is the first in slot order.
    #[must_use]
    pub fn outgoing(&self, vertices: usize) -> Vec<Option<HalfEdgeId>> {
        let mut outgoing = vec![None; vertices];
        for e in self.triangles().flat_map(super::TriangleId::half_edges) {
            let slot = outgoing.get_mut(self.origin(e).index());
            if let Some(slot) = slot.filter(|slot| slot.is_none()) {
                *slot = Some(e);
            }
        }
        outgoing
    }
}

impl Iterator for Star<'_> {
    type Item = HalfEdgeId;

    fn next(&mut self) -> Option<HalfEdgeId> {
        let here = self.next?;
        self.next = if self.clockwise {
            self.triangulation.rotate_cw(here)
        } else {
            match self.triangulation.rotate_ccw(here) {
                Some(e) if e == self.first => None,
                Some(e) => Some(e),
                None => {
                    self.clockwise = true;
                    self.triangulation.rotate_cw(self.first)
                }
            }
        };
        Some(here)
    }
}
