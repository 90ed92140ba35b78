//! Splitting a triangle or an edge by a new vertex.

use super::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};

impl Triangulation {
    /// Splits a triangle by a vertex inside it; returns its three outer half-edges, each now
    /// corner 0 of its own triangle with `v` as apex. The tag goes to all three.
    ///
    /// ```text
    ///        c
    ///       /|\         (a, b, v) keeps the slot of t; its half-edges 0: a -> b, 1: b -> v,
    ///      / v \        2: v -> a. The others are new: (b, c, v) and (c, a, v).
    ///     / / \ \
    ///    a-------b
    /// ```
    pub fn split_triangle(&mut self, t: TriangleId, v: VertexId) -> [HalfEdgeId; 3] {
        let [a, b, c] = self.corners(t);
        let tag = self.tag(t);
        let outer = t.half_edges().map(|h| self.side(h));
        let second = self.add_tagged([b, c, v], tag);
        let third = self.add_tagged([c, a, v], tag);
        self.set_corners(t, [a, b, v]);
        let fan = [t, second, third];
        for i in 0..3 {
            self.attach(fan[i].half_edge(0), outer[i]);
        }
        self.close_fan(&fan);
        fan.map(|u| u.half_edge(0))
    }

    /// Splits the edge `e = a -> b` by a vertex on it: two triangles a side. Both halves keep the
    /// constraint and, on a border, the owner value. Returns the outer half-edges, each corner 0
    /// of its triangle with `v` as apex: two on a border edge, else four.
    ///
    /// The half-edge `a -> v` is `result[1].next()`, and `v -> b` is `result[0].prev()`.
    pub fn split_edge(&mut self, e: HalfEdgeId, v: VertexId) -> Vec<HalfEdgeId> {
        let twin = self.twin(e);
        let (across, constrained) = self.side(e);
        let [right, left] = self.split_side(e, v);
        if let Some(f) = twin {
            let [twin_right, twin_left] = self.split_side(f, v);
            self.attach_pair(right.prev(), twin_left.next(), constrained);
            self.attach_pair(left.next(), twin_right.prev(), constrained);
            vec![right, left, twin_right, twin_left]
        } else {
            self.attach(right.prev(), (across, constrained));
            self.attach(left.next(), (across, constrained));
            vec![right, left]
        }
    }

    /// One side of [`split_edge`](Self::split_edge): `(a, b, c)` becomes `(b, c, v)` and
    /// `(c, a, v)`, linked along `v c`; the halves of `a b` are left for the caller.
    fn split_side(&mut self, e: HalfEdgeId, v: VertexId) -> [HalfEdgeId; 2] {
        let t = e.triangle();
        let (a, b, c) = (self.origin(e), self.dest(e), self.apex(e));
        let (bc, ca) = (self.side(e.next()), self.side(e.prev()));
        let tag = self.tag(t);
        let left = self.add_tagged([c, a, v], tag);
        self.set_corners(t, [b, c, v]);
        self.attach(t.half_edge(0), bc);
        self.attach(left.half_edge(0), ca);
        self.attach_pair(t.half_edge(1), left.half_edge(2), false);
        [t.half_edge(0), left.half_edge(0)]
    }

    /// Links triangles `(x, y, v)` in counterclockwise order around `v` along their spokes.
    fn close_fan(&mut self, fan: &[TriangleId]) {
        for (i, &t) in fan.iter().enumerate() {
            let next = fan[(i + 1) % fan.len()];
            self.attach_pair(t.half_edge(1), next.half_edge(2), false);
        }
    }

    fn attach_pair(&mut self, e: HalfEdgeId, f: HalfEdgeId, constrained: bool) {
        self.link(e, f);
        self.set_constrained_side(e, constrained);
        self.set_constrained_side(f, constrained);
    }

    fn add_tagged(&mut self, corners: [VertexId; 3], tag: u32) -> TriangleId {
        let t = self.add(corners);
        self.set_tag(t, tag);
        t
    }

    pub(super) fn side(&self, e: HalfEdgeId) -> (Across, bool) {
        (self.across(e), self.raw_constrained(e))
    }
}
