//! Divide and conquer on sorted points.
//!
//! Guibas and Stolfi, *Primitives for the manipulation of general subdivisions and the computation
//! of Voronoi diagrams*, 1985, section 9; names are the paper's. Differs from it in one way: only
//! the origin rings of the quad-edge structure are stored, since the left-face ring follows from
//! them (`Lnext = Sym Oprev`) and nothing here asks for the dual.

use super::assemble::{from_triangles, sorted_line};
use crate::point::Point2;
use crate::predicates::{Sign, incircle_perturbed, orient2d};
use crate::triangulation::Triangulation;

/// A directed edge; its reverse is `e ^ 1`.
type Edge = usize;

/// Delaunay triangulation of distinct finite points in lexicographic order.
pub(crate) fn triangulate(points: &[Point2]) -> Triangulation {
    if points.len() < 2 {
        return Triangulation::default();
    }
    let mut subdivision = Subdivision { points, edges: Vec::new() };
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
}

struct Subdivision<'a> {
    points: &'a [Point2],
    edges: Vec<Ring>,
}

fn sym(e: Edge) -> Edge {
    e ^ 1
}

impl Subdivision<'_> {
    fn org(&self, e: Edge) -> u32 {
        self.edges[e].origin
    }

    fn dest(&self, e: Edge) -> u32 {
        self.edges[sym(e)].origin
    }

    fn onext(&self, e: Edge) -> Edge {
        self.edges[e].onext
    }

    fn oprev(&self, e: Edge) -> Edge {
        self.edges[e].oprev
    }

    fn lnext(&self, e: Edge) -> Edge {
        self.oprev(sym(e))
    }

    fn rprev(&self, e: Edge) -> Edge {
        self.onext(sym(e))
    }

    fn make_edge(&mut self, a: u32, b: u32) -> Edge {
        let e = self.edges.len();
        self.edges.push(Ring { origin: a, onext: e, oprev: e, live: true });
        self.edges.push(Ring { origin: b, onext: e + 1, oprev: e + 1, live: true });
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
    fn connect(&mut self, a: Edge, b: Edge) -> Edge {
        let e = self.make_edge(self.dest(a), self.org(b));
        self.splice(e, self.lnext(a));
        self.splice(sym(e), b);
        e
    }

    fn delete(&mut self, e: Edge) {
        for side in [e, sym(e)] {
            self.splice(side, self.oprev(side));
            self.edges[side].live = false;
        }
    }

    fn at(&self, v: u32) -> Point2 {
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
            2 => {
                let e = self.make_edge(low as u32, low as u32 + 1);
                (e, sym(e))
            }
            3 => self.three(low as u32),
            _ => {
                let middle = low.midpoint(high);
                let left = self.delaunay(low, middle);
                let right = self.delaunay(middle, high);
                self.merge(left, right)
            }
        }
    }

    fn three(&mut self, first: u32) -> (Edge, Edge) {
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

    fn merge(
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
        let ends = [self.dest(basel), self.org(basel)];
        let mut lcand = self.onext(sym(basel));
        if valid(self, lcand) {
            while self.in_circle([ends[0], ends[1], self.dest(lcand)], self.dest(self.onext(lcand)))
            {
                let next = self.onext(lcand);
                self.delete(lcand);
                lcand = next;
            }
        }
        let mut rcand = self.oprev(basel);
        if valid(self, rcand) {
            while self.in_circle([ends[0], ends[1], self.dest(rcand)], self.dest(self.oprev(rcand)))
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
    fn triangles(&self) -> Vec<[u32; 3]> {
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
