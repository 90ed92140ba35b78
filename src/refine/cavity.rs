//! The triangles whose circle holds a new vertex, and the fan that takes their place.
//!
//! The cavity grows from a seed across every edge behind which the circle holds the point. Taking
//! an edge into it is one flip of Lawson's insertion, so the fan is what Lawson's flips would give
//! (SPEC 18.2): strictly counterclockwise triangles whatever was rounded, and no flip is undone.
//! Borders stop it, so what lies behind a constraint is never seen.

use crate::point::Point2;
use crate::predicates::{Sign, incircle_perturbed};
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};

/// An edge of the cavity's outline, the cavity on its left.
#[derive(Clone, Copy, Debug)]
pub(super) struct OutlineEdge {
    pub(super) from: VertexId,
    pub(super) to: VertexId,
    pub(super) across: Across,
}

/// A cavity; its memory is used again for the next.
#[derive(Default)]
pub(super) struct Cavity {
    /// The triangles in it; after filling, those of the fan.
    triangles: Vec<TriangleId>,
    outline: Vec<OutlineEdge>,
    stack: Vec<HalfEdgeId>,
}

impl Cavity {
    /// The outline counterclockwise; of a cavity on a border edge, all but that edge.
    pub(super) fn outline(&self) -> &[OutlineEdge] {
        &self.outline
    }

    /// The triangles of the cavity, or of the fan once it is filled.
    pub(super) fn triangles(&self) -> &[TriangleId] {
        &self.triangles
    }

    /// Digs the cavity of a point inside the triangle `seed` or on an edge of it that has a twin.
    pub(super) fn dig(
        &mut self,
        mesh: &Triangulation,
        points: &[Point2],
        seed: TriangleId,
        p: Point2,
    ) {
        let [first, second, third] = seed.half_edges();
        self.start(seed, &[third, second, first]);
        self.grow(mesh, points, p);
    }

    /// Digs the cavity of a point that will split the border edge `e`: it lies strictly left of the
    /// other two edges of its triangle.
    pub(super) fn dig_beside(
        &mut self,
        mesh: &Triangulation,
        points: &[Point2],
        e: HalfEdgeId,
        p: Point2,
    ) {
        self.start(e.triangle(), &[e.prev(), e.next()]);
        self.grow(mesh, points, p);
    }

    /// `edges` in the reverse of the order in which they shall be looked across.
    fn start(&mut self, seed: TriangleId, edges: &[HalfEdgeId]) {
        self.triangles.clear();
        self.triangles.push(seed);
        self.outline.clear();
        self.stack.clear();
        self.stack.extend_from_slice(edges);
    }

    /// Depth first and counterclockwise, so that the outline comes out in order.
    fn grow(&mut self, mesh: &Triangulation, points: &[Point2], p: Point2) {
        while let Some(e) = self.stack.pop() {
            let across = mesh.across(e);
            if let Across::Twin(f) = across
                && conflicts(mesh, points, f.triangle(), p)
            {
                self.triangles.push(f.triangle());
                self.stack.extend([f.prev(), f.next()]);
                continue;
            }
            self.outline.push(OutlineEdge { from: mesh.origin(e), to: mesh.dest(e), across });
        }
    }

    /// Replaces the cavity by the fan of `v` over the outline, closed for a point inside. Calls
    /// `border` for each border of the outline with its owner and its new half-edge.
    pub(super) fn fill(
        &mut self,
        mesh: &mut Triangulation,
        v: VertexId,
        is_closed: bool,
        mut border: impl FnMut(u32, HalfEdgeId),
    ) {
        let tag = mesh.tag(self.triangles[0]);
        while self.triangles.len() < self.outline.len() {
            let t = mesh.add([v; 3]);
            mesh.set_tag(t, tag);
            self.triangles.push(t);
        }
        let mut last = None;
        for (edge, &t) in self.outline.iter().zip(&self.triangles) {
            mesh.set_corners(t, [edge.from, edge.to, v]);
            let outer = t.half_edge(0);
            mesh.relink(outer, edge.across);
            if let Across::Border(owner) = edge.across {
                border(owner, outer);
            }
            if let Some(last) = last {
                mesh.link(last, t.half_edge(2));
            }
            last = Some(t.half_edge(1));
        }
        if let Some(last) = last.filter(|_| is_closed) {
            mesh.link(last, self.triangles[0].half_edge(2));
        }
    }
}

/// Whether the perturbed circle of a triangle holds `p`.
#[inline]
fn conflicts(mesh: &Triangulation, points: &[Point2], t: TriangleId, p: Point2) -> bool {
    let [a, b, c] = mesh.corners(t).map(|v| points[v.index()]);
    incircle_perturbed(a, b, c, p) == Sign::Positive
}
