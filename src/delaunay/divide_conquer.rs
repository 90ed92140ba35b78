//! Divide and conquer on sorted points.
//!
//! Guibas and Stolfi, *Primitives for the manipulation of general subdivisions and the computation
//! of Voronoi diagrams*, 1985, section 9; names are the paper's. Differs from it in one way: only
//! the origin rings of the quad-edge structure are stored, since the left-face ring follows from
//! them (`Lnext = Sym Oprev`) and nothing here asks for the dual.
//!
//! The subdivision also serves `divide_conquer_cdt.rs`: an edge may carry a segment, and is then
//! never removed by a merge.

use super::assemble::{from_triangles, sorted_line};
use crate::point::Point2;
use crate::predicates::{Sign, incircle_perturbed, orient2d};
use crate::triangulation::Triangulation;

/// A directed edge; its reverse is `e ^ 1`.
pub(super) type Edge = usize;

/// No segment.
pub(super) const FREE: u32 = u32::MAX;

/// Delaunay triangulation of distinct finite points in lexicographic order.
pub(crate) fn triangulate(points: &[Point2]) -> Triangulation {
    if points.len() < 2 {
        return Triangulation::default();
    }
    let mut subdivision = Subdivision::new(points);
    subdivision.delaunay(0, points.len());
    let triangles = subdivision.triangles();
    if triangles.is_empty() {
        return sorted_line(points);
    }
    from_triangles(points.len(), &triangles).expect("the subdivision is planar")
}

#[derive(Clone, Copy)]
struct Ring {
    origin: u32,
    onext: Edge,
    oprev: Edge,
    live: bool,
    /// The segment that the edge is, or [`FREE`].
    segment: u32,
}

pub(super) struct Subdivision<'a> {
    pub(super) points: &'a [Point2],
    edges: Vec<Ring>,
    /// For each point an edge out of it, if there is one.
    outgoing: Vec<Option<Edge>>,
}

pub(super) fn sym(e: Edge) -> Edge {
    e ^ 1
}

impl<'a> Subdivision<'a> {
    pub(super) fn new(points: &'a [Point2]) -> Self {
        Self { points, edges: Vec::new(), outgoing: vec![None; points.len()] }
    }

    /// An edge out of a point that has one.
    pub(super) fn out_of(&self, v: u32) -> Edge {
        self.outgoing[v as usize].expect("the point has an edge")
    }

    /// The segment that the edge is, or [`FREE`].
    pub(super) fn segment(&self, e: Edge) -> u32 {
        self.edges[e].segment
    }

    /// Lets the edge be a segment, on both sides.
    pub(super) fn set_segment(&mut self, e: Edge, segment: u32) {
        for side in [e, sym(e)] {
            self.edges[side].segment = segment;
        }
    }

    pub(super) fn org(&self, e: Edge) -> u32 {
        self.edges[e].origin
    }

    pub(super) fn dest(&self, e: Edge) -> u32 {
        self.edges[sym(e)].origin
    }

    pub(super) fn onext(&self, e: Edge) -> Edge {
        self.edges[e].onext
    }

    pub(super) fn oprev(&self, e: Edge) -> Edge {
        self.edges[e].oprev
    }

    pub(super) fn lnext(&self, e: Edge) -> Edge {
        self.oprev(sym(e))
    }

    fn rprev(&self, e: Edge) -> Edge {
        self.onext(sym(e))
    }

    pub(super) fn make_edge(&mut self, a: u32, b: u32) -> Edge {
        let e = self.edges.len();
        for (origin, side) in [(a, e), (b, e + 1)] {
            let ring = Ring { origin, onext: side, oprev: side, live: true, segment: FREE };
            self.edges.push(ring);
            self.outgoing[origin as usize] = Some(side);
        }
        e
    }

    /// Joins the origin rings of two edges if they are distinct, else splits the one they share.
    fn splice(&mut self, a: Edge, b: Edge) {
        let (after_a, after_b) = (self.onext(a), self.onext(b));
        self.edges[a].onext = after_b;
        self.edges[b].onext = after_a;
        self.edges[after_b].oprev = a;
        self.edges[after_a].oprev = b;
    }

    /// A new edge from the end of `a` to the start of `b`, in the same left face.
    pub(super) fn connect(&mut self, a: Edge, b: Edge) -> Edge {
        let e = self.make_edge(self.dest(a), self.org(b));
        self.splice(e, self.lnext(a));
        self.splice(sym(e), b);
        e
    }

    pub(super) fn delete(&mut self, e: Edge) {
        for side in [e, sym(e)] {
            let (origin, next) = (self.org(side), self.onext(side));
            self.outgoing[origin as usize] = (next != side).then_some(next);
            self.splice(side, self.oprev(side));
            self.edges[side].live = false;
        }
    }

    pub(super) fn at(&self, v: u32) -> Point2 {
        self.points[v as usize]
    }

    fn right_of(&self, v: u32, e: Edge) -> bool {
        orient2d(self.at(self.org(e)), self.at(self.dest(e)), self.at(v)) == Sign::Negative
    }

    fn left_of(&self, v: u32, e: Edge) -> bool {
        orient2d(self.at(self.org(e)), self.at(self.dest(e)), self.at(v)) == Sign::Positive
    }

    fn in_circle(&self, [a, b, c]: [u32; 3], d: u32) -> bool {
        incircle_perturbed(self.at(a), self.at(b), self.at(c), self.at(d)) == Sign::Positive
    }

    /// Triangulates points `low..high`; returns the counterclockwise hull edge out of the leftmost
    /// point and the clockwise one out of the rightmost.
    fn delaunay(&mut self, low: usize, high: usize) -> (Edge, Edge) {
        match high - low {
            2 => self.two(low as u32),
            3 => self.three(low as u32),
            _ => {
                let middle = low.midpoint(high);
                let left = self.delaunay(low, middle);
                let right = self.delaunay(middle, high);
                self.merge(left, right)
            }
        }
    }

    pub(super) fn two(&mut self, first: u32) -> (Edge, Edge) {
        let e = self.make_edge(first, first + 1);
        (e, sym(e))
    }

    pub(super) fn three(&mut self, first: u32) -> (Edge, Edge) {
        let [s1, s2, s3] = [first, first + 1, first + 2];
        let (a, b) = (self.make_edge(s1, s2), self.make_edge(s2, s3));
        self.splice(sym(a), b);
        match orient2d(self.at(s1), self.at(s2), self.at(s3)) {
            Sign::Positive => {
                self.connect(b, a);
                (a, sym(b))
            }
            Sign::Negative => {
                let c = self.connect(b, a);
                (sym(c), c)
            }
            Sign::Zero => (a, sym(b)),
        }
    }

    pub(super) fn merge(
        &mut self,
        (mut ldo, mut ldi): (Edge, Edge),
        (mut rdi, mut rdo): (Edge, Edge),
    ) -> (Edge, Edge) {
        // The lower common tangent of left and right.
        loop {
            if self.left_of(self.org(rdi), ldi) {
                ldi = self.lnext(ldi);
            } else if self.right_of(self.org(ldi), rdi) {
                rdi = self.rprev(rdi);
            } else {
                break;
            }
        }
        let mut basel = self.connect(sym(rdi), ldi);
        if self.org(ldi) == self.org(ldo) {
            ldo = sym(basel);
        }
        if self.org(rdi) == self.org(rdo) {
            rdo = basel;
        }
        while let Some(next) = self.rise(basel) {
            basel = next;
        }
        (ldo, rdo)
    }

    /// The next cross edge above `basel`, after deleting the edges it makes invalid; `None` at the
    /// upper common tangent.
    fn rise(&mut self, basel: Edge) -> Option<Edge> {
        let valid = |s: &Self, e: Edge| s.right_of(s.dest(e), basel);
        // With segments a vertex below the base may lie in the circle, hidden: only a triangle above
        // the base gives way.
        let ends = [self.dest(basel), self.org(basel)];
        let mut lcand = self.onext(sym(basel));
        if valid(self, lcand) {
            while self.segment(lcand) == FREE
                && valid(self, self.onext(lcand))
                && self
                    .in_circle([ends[0], ends[1], self.dest(lcand)], self.dest(self.onext(lcand)))
            {
                let next = self.onext(lcand);
                self.delete(lcand);
                lcand = next;
            }
        }
        let mut rcand = self.oprev(basel);
        if valid(self, rcand) {
            while self.segment(rcand) == FREE
                && valid(self, self.oprev(rcand))
                && self
                    .in_circle([ends[0], ends[1], self.dest(rcand)], self.dest(self.oprev(rcand)))
            {
                let next = self.oprev(rcand);
                self.delete(rcand);
                rcand = next;
            }
        }
        let (left, right) = (valid(self, lcand), valid(self, rcand));
        if !left && !right {
            return None;
        }
        let left_triangle = [self.dest(lcand), self.org(lcand), self.org(rcand)];
        if !left || (right && self.in_circle(left_triangle, self.dest(rcand))) {
            Some(self.connect(rcand, sym(basel)))
        } else {
            Some(self.connect(sym(basel), sym(lcand)))
        }
    }

    /// The counterclockwise faces of three edges.
    pub(super) fn triangles(&self) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        for e in (0..self.edges.len()).filter(|&e| self.edges[e].live) {
            let (f, g) = (self.lnext(e), self.lnext(self.lnext(e)));
            let [a, b, c] = [e, f, g].map(|e| self.org(e));
            let once = e < f && e < g && self.lnext(g) == e;
            if once && orient2d(self.at(a), self.at(b), self.at(c)) == Sign::Positive {
                triangles.push([a, b, c]);
            }
        }
        triangles
    }
}
