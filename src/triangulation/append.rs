//! Putting triangulations together.

use super::{ACROSS, BORDER_BIT, FLAGS, LIVE, Slot, TRIANGLES_MAX, Triangulation, VertexId};

impl Triangulation {
    /// Adds the triangles of another triangulation after all slots, in their order, with other
    /// numbers of vertices and of border owners. Links, tags, constraints and marks come along.
    ///
    /// # Requires
    /// The other one has no free slots.
    pub(crate) fn append(
        &mut self,
        other: &Self,
        vertex: impl Fn(VertexId) -> VertexId,
        owner: impl Fn(u32) -> u32,
    ) {
        debug_assert!(other.free.is_empty(), "free slots would be appended as triangles");
        assert!(self.slots.len() + other.slots.len() <= TRIANGLES_MAX, "more than 2^29 triangles");
        let first = 4 * self.slots.len() as u32;
        let moved = |slot: &Slot| {
            let mut words = slot.words;
            debug_assert!(words[FLAGS] & LIVE != 0, "a free slot");
            for corner in 0..3 {
                words[corner] = vertex(VertexId(words[corner])).0;
                let across = &mut words[ACROSS + corner];
                *across = match *across & BORDER_BIT {
                    0 => *across + first,
                    _ => BORDER_BIT | owner(*across & !BORDER_BIT),
                };
            }
            Slot { words }
        };
        self.slots.extend(other.slots.iter().map(moved));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::triangulation::{Across, HalfEdgeId, TriangleId};

    /// Two triangles at an edge, the second with a tag and a constraint.
    fn pair() -> Triangulation {
        let mut pair = Triangulation::default();
        let [a, b, c, d] = [0, 1, 2, 3].map(VertexId);
        let (t, u) = (pair.add([a, b, c]), pair.add([b, a, d]));
        pair.link(t.half_edge(0), u.half_edge(0));
        pair.set_border(t.half_edge(1), 5);
        pair.set_tag(u, 7);
        pair.set_constrained(u.half_edge(0), true);
        pair
    }

    #[test]
    fn what_is_appended_is_the_same_under_other_numbers() {
        let (mut both, pair) = (pair(), pair());
        both.append(&pair, |v| VertexId(v.0 + 10), |owner| owner + 100);
        assert_eq!(both.live_count(), 4);
        for t in [TriangleId(0), TriangleId(1)] {
            assert_eq!(both.corners(t), pair.corners(t), "what was there stays");
            let moved = TriangleId(t.0 + 2);
            assert_eq!(both.corners(moved), pair.corners(t).map(|v| VertexId(v.0 + 10)));
            assert_eq!(both.tag(moved), pair.tag(t));
        }
        let moved = |e: HalfEdgeId| HalfEdgeId(e.0 + 8);
        let e = TriangleId(0).half_edge(0);
        assert_eq!(both.twin(moved(e)), pair.twin(e).map(moved));
        assert!(both.is_constrained(moved(e)));
        assert_eq!(both.across(moved(e.next())), Across::Border(105));
        assert_eq!(both.across(e.next()), Across::Border(5));
    }

    #[test]
    fn nothing_appended_changes_nothing() {
        let mut both = pair();
        both.append(&Triangulation::default(), |_| unreachable!(), |_| unreachable!());
        assert_eq!(both.live_count(), 2);
        assert_eq!(both.corners(TriangleId(1)), pair().corners(TriangleId(1)));
    }

    #[test]
    #[should_panic(expected = "free slots")]
    #[cfg(debug_assertions)]
    fn free_slots_cannot_be_appended() {
        let mut holed = pair();
        holed.remove(TriangleId(0));
        pair().append(&holed, |v| v, |owner| owner);
    }
}
