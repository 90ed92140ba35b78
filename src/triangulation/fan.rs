//! Refilling a polygon with triangles about one vertex.

use super::{
    Across, BORDER_BIT, HalfEdgeId, LIVE, Slot, TAG_SHIFT, TriangleId, Triangulation, VertexId,
};

/// A side of a polygon, with the polygon on its left.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PolygonSide {
    pub(crate) origin: VertexId,
    pub(crate) dest: VertexId,
    /// What lies across.
    pub(crate) across: Across,
}

impl Across {
    /// The word in a slot.
    #[inline]
    const fn raw(self) -> u32 {
        match self {
            Self::Twin(twin) => twin.0,
            Self::Border(owner) => BORDER_BIT | owner,
        }
    }
}

impl Triangulation {
    /// Replaces triangles by those that the sides of a chain make with a vertex, in the slots of the old
    /// ones as far as they go; `triangles` then holds the new ones, the triangle of side `i` at `i`, its
    /// half-edge 0 on the side. The outer half-edges at the vertex are borders with owner value 0;
    /// nothing is constrained, and marks are 0.
    ///
    /// # Requires
    /// Each side starts where the one before ends. What lies across a side is none of the old triangles.
    pub(crate) fn refill(
        &mut self,
        triangles: &mut Vec<TriangleId>,
        sides: impl ExactSizeIterator<Item = PolygonSide>,
        apex: VertexId,
        tag: u32,
    ) {
        let count = sides.len();
        while triangles.len() > count {
            self.remove(triangles[triangles.len() - 1]);
            triangles.pop();
        }
        while triangles.len() < count {
            triangles.push(self.add([apex; 3]));
        }
        let mut before = BORDER_BIT;
        for (i, PolygonSide { origin, dest, across }) in sides.enumerate() {
            let t = triangles[i];
            let after = triangles.get(i + 1).map_or(BORDER_BIT, |next| next.half_edge(2).0);
            let flags = LIVE | tag << TAG_SHIFT;
            self.slots[t.index()] =
                Slot { words: [origin.0, dest.0, apex.0, flags, across.raw(), after, before, 0] };
            if let Across::Twin(twin) = across {
                self.set_across(twin, t.half_edge(0));
            }
            before = t.half_edge(1).0;
        }
    }

    #[inline]
    fn set_across(&mut self, e: HalfEdgeId, twin: HalfEdgeId) {
        self.slots[e.triangle().index()].words[super::ACROSS + e.corner()] = twin.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles at an edge of a square, one of them with a neighbour outside.
    fn square() -> (Triangulation, [TriangleId; 3]) {
        let mut mesh = Triangulation::default();
        let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(VertexId);
        let (t, u, out) = (mesh.add([a, b, c]), mesh.add([a, c, d]), mesh.add([c, b, e]));
        mesh.link(t.half_edge(2), u.half_edge(0));
        mesh.link(t.half_edge(1), out.half_edge(0));
        mesh.set_border(u.half_edge(2), 7);
        (mesh, [t, u, out])
    }

    fn sides(mesh: &Triangulation, [t, u, _]: [TriangleId; 3]) -> [PolygonSide; 4] {
        [t.half_edge(0), t.half_edge(1), u.half_edge(1), u.half_edge(2)].map(|e| PolygonSide {
            origin: mesh.origin(e),
            dest: mesh.dest(e),
            across: mesh.across(e),
        })
    }

    #[test]
    fn a_square_is_refilled_by_four_triangles_but_for_its_base() {
        let (mut mesh, ids) = square();
        let (all, mut triangles) = (sides(&mesh, ids), vec![ids[0], ids[1]]);
        mesh.refill(&mut triangles, all[1..].iter().copied(), VertexId(5), 9);
        assert_eq!(triangles.len(), 3);
        assert_eq!(triangles[..2], ids[..2], "old slots first");
        assert_eq!(mesh.live_count(), 4);
        for (&t, side) in triangles.iter().zip(&all[1..]) {
            assert_eq!(mesh.corners(t), [side.origin, side.dest, VertexId(5)]);
            assert_eq!(mesh.across(t.half_edge(0)), side.across);
            assert_eq!((mesh.tag(t), mesh.mark(t)), (9, 0));
        }
        assert_eq!(mesh.twin(ids[2].half_edge(0)), Some(triangles[0].half_edge(0)));
        for pair in triangles.windows(2) {
            assert_eq!(mesh.twin(pair[0].half_edge(1)), Some(pair[1].half_edge(2)));
            assert_eq!(mesh.twin(pair[1].half_edge(2)), Some(pair[0].half_edge(1)));
        }
        assert_eq!(mesh.across(triangles[0].half_edge(2)), Across::Border(0));
        assert_eq!(mesh.across(triangles[2].half_edge(1)), Across::Border(0));
    }

    #[test]
    fn slots_that_are_not_needed_are_given_back() {
        let (mut mesh, ids) = square();
        let (all, mut triangles) = (sides(&mesh, ids), vec![ids[0], ids[1]]);
        mesh.refill(&mut triangles, all[3..].iter().copied(), VertexId(2), 0);
        assert_eq!((triangles.len(), mesh.live_count()), (1, 2));
        assert!(!mesh.is_live(ids[1]));
        assert_eq!(mesh.across(ids[0].half_edge(0)), Across::Border(7));
    }
}
