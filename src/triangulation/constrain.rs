//! Forcing a segment into a triangulation.
//!
//! The triangles the segment crosses form a cavity; on either side of the segment lies a polygon
//! whose constrained Delaunay triangulation is built anew from the segment outward (Anglada, *An
//! improved incremental algorithm for constructing restricted Delaunay triangulations*, 1997).
//! Nothing is flipped, so nothing can stall, and the result is Delaunay at once. The cavity's own
//! triangle slots are used again: as many triangles come out as went in.

use super::locate::{RayHit, between};
use super::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};
use crate::point::Point2;
use crate::predicates::{Sign, incircle_perturbed, orient2d};

/// Why a segment could not be forced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Obstacle {
    /// It crosses this constrained edge.
    Crosses(HalfEdgeId),
    /// It passes through this vertex, the origin of the half-edge.
    Through(HalfEdgeId),
    /// It leaves the triangulated region across this border.
    Leaves(HalfEdgeId),
}

/// An edge of the polygon to be triangulated: starts at `start`, has the polygon on its left.
struct ChainEdge {
    start: VertexId,
    inner: HalfEdgeId,
    outer: Outer,
    constrained: bool,
}

/// What lies on the other side of a chain edge.
#[derive(Clone, Copy)]
enum Outer {
    Across(Across),
    /// The edge dangles into the cavity: its other side is this edge of the same chain.
    Same(usize),
}

/// The triangles crossed by a segment, and the chains of edges on its two sides.
#[derive(Default)]
struct Cavity {
    triangles: Vec<TriangleId>,
    /// From the segment's end back to its start.
    left: Vec<ChainEdge>,
    /// From the segment's start to its end.
    right: Vec<ChainEdge>,
}

impl Triangulation {
    /// Makes the segment from the origin of `from` to vertex `to` a constrained edge and returns
    /// it as the half-edge from that origin. `outgoing`, if a vertex has an entry, is kept a
    /// half-edge out of that vertex. On an obstacle nothing is changed.
    ///
    /// # Requires
    /// The triangulation is constrained Delaunay; it is again afterwards.
    ///
    /// # Errors
    /// The first [`Obstacle`] on the way.
    ///
    /// # Complexity
    /// Linear in the triangles crossed plus the degree of the start; quadratic at worst in the
    /// chains, `k log k` for chains met in practice.
    pub fn force_segment(
        &mut self,
        points: &[Point2],
        from: HalfEdgeId,
        to: VertexId,
        outgoing: &mut [Option<HalfEdgeId>],
    ) -> Result<HalfEdgeId, Obstacle> {
        if let Some(e) = self.half_edge_to(from, to) {
            self.set_constrained(e, true);
            return Ok(e);
        }
        let mut cavity = self.dig(points, from, to)?;
        self.find_outer(&mut cavity);
        let start = self.origin(from);
        let mut slots = cavity.triangles.iter().copied();
        let left = self.fill(points, [start, to], &cavity.left, &mut slots);
        let right = self.fill(points, [to, start], &cavity.right, &mut slots);
        debug_assert!(slots.next().is_none(), "a cavity gives as many triangles as it had");
        self.link(left, right);
        self.set_constrained(left, true);
        for e in cavity.triangles.iter().flat_map(|t| t.half_edges()) {
            if let Some(entry) = outgoing.get_mut(self.origin(e).index()) {
                *entry = Some(e);
            }
        }
        Ok(left)
    }

    /// The vertices on either side of the triangles that the segment from the origin of `from` to
    /// `to` crosses; none if it is an edge.
    ///
    /// # Errors
    /// The first [`Obstacle`] on the way.
    pub fn beside_segment(
        &self,
        points: &[Point2],
        from: HalfEdgeId,
        to: VertexId,
    ) -> Result<Vec<VertexId>, Obstacle> {
        if self.half_edge_to(from, to).is_some() {
            return Ok(Vec::new());
        }
        let Cavity { left, right, .. } = self.dig(points, from, to)?;
        let inner = left.iter().skip(1).chain(right.iter().skip(1));
        Ok(inner.map(|edge| edge.start).collect())
    }

    /// Collects the cavity of the segment without changing anything but marks of its triangles.
    fn dig(&self, points: &[Point2], from: HalfEdgeId, to: VertexId) -> Result<Cavity, Obstacle> {
        let (a, b) = (points[self.origin(from).index()], points[to.index()]);
        let mut crossed = match self.ray(points, from, b) {
            RayHit::Edge(e) => e,
            RayHit::Vertex { at, .. } => return Err(Obstacle::Through(at)),
            RayHit::Outside(e) => return Err(Obstacle::Leaves(e)),
        };
        let mut cavity = Cavity::default();
        cavity.triangles.push(crossed.triangle());
        cavity.left.push(self.chain_edge(crossed.next()));
        cavity.right.push(self.chain_edge(crossed.prev()));
        loop {
            let f = match self.twin(crossed) {
                Some(_) if self.is_constrained(crossed) => return Err(Obstacle::Crosses(crossed)),
                Some(f) => f,
                None => return Err(Obstacle::Leaves(crossed)),
            };
            cavity.triangles.push(f.triangle());
            if self.apex(f) == to {
                cavity.left.push(self.chain_edge(f.prev()));
                cavity.right.push(self.chain_edge(f.next()));
                break;
            }
            let apex = points[self.apex(f).index()];
            debug_assert!(apex != b, "points are distinct");
            match orient2d(a, b, apex) {
                Sign::Zero => {
                    debug_assert!(between(a, apex, b), "the walk stays on the segment");
                    return Err(Obstacle::Through(f.prev()));
                }
                Sign::Positive => {
                    cavity.left.push(self.chain_edge(f.prev()));
                    crossed = f.next();
                }
                Sign::Negative => {
                    cavity.right.push(self.chain_edge(f.next()));
                    crossed = f.prev();
                }
            }
        }
        cavity.left.reverse();
        Ok(cavity)
    }

    fn chain_edge(&self, inner: HalfEdgeId) -> ChainEdge {
        let (across, constrained) = self.side(inner);
        ChainEdge { start: self.origin(inner), inner, outer: Outer::Across(across), constrained }
    }

    /// Finds the chain edges whose other side is in the cavity too. The scratch marks point from a
    /// triangle to its chain edges and are cleared again.
    fn find_outer(&mut self, cavity: &mut Cavity) {
        for chain in [&mut cavity.left, &mut cavity.right] {
            for (i, edge) in chain.iter().enumerate() {
                self.set_mark(edge.inner.triangle(), i as u32 + 1);
            }
            for i in 0..chain.len() {
                let Outer::Across(Across::Twin(twin)) = chain[i].outer else { continue };
                // A triangle has at most one edge in each chain, so one mark suffices.
                let other = self.mark(twin.triangle()) as usize;
                if other > 0 && chain[other - 1].inner == twin {
                    chain[i].outer = Outer::Same(other - 1);
                }
            }
            for edge in chain.iter() {
                self.set_mark(edge.inner.triangle(), 0);
            }
        }
    }

    /// Triangulates the polygon `base[0] -> base[1] -> chain -> base[0]`, and returns the half-edge
    /// of the base. Each step finds the apex of a base: the vertex whose circle through the base
    /// holds no other vertex of the chain; it splits the chain in two.
    fn fill(
        &mut self,
        points: &[Point2],
        base: [VertexId; 2],
        chain: &[ChainEdge],
        slots: &mut impl Iterator<Item = TriangleId>,
    ) -> HalfEdgeId {
        let mut placed: Vec<Option<HalfEdgeId>> = vec![None; chain.len()];
        let mut first = None;
        // (range of the chain, its base as the half-edge of the triangle before)
        let mut todo = vec![(0, chain.len(), None::<HalfEdgeId>)];
        while let Some((low, high, parent)) = todo.pop() {
            if high - low == 1 {
                let side = parent.expect("a base is no chain edge");
                self.place(side, low, chain, &mut placed);
                continue;
            }
            let p = if high == chain.len() { base[0] } else { chain[high].start };
            let q = chain[low].start;
            let apex = apex_of(points, [p, q], &chain[low..high]) + low;
            let t = slots.next().expect("a cavity gives as many triangles as it had");
            self.reset(t, [p, q, chain[apex].start]);
            match parent {
                Some(parent) => self.link(parent, t.half_edge(0)),
                None => first = Some(t.half_edge(0)),
            }
            todo.push((low, apex, Some(t.half_edge(1))));
            todo.push((apex, high, Some(t.half_edge(2))));
        }
        first.expect("a cavity has a triangle on each side")
    }

    /// Puts the new half-edge `side` in the place of chain edge `i`.
    fn place(
        &mut self,
        side: HalfEdgeId,
        i: usize,
        chain: &[ChainEdge],
        placed: &mut [Option<HalfEdgeId>],
    ) {
        placed[i] = Some(side);
        self.set_constrained_side(side, chain[i].constrained);
        match chain[i].outer {
            Outer::Across(across) => self.relink(side, across),
            Outer::Same(j) => {
                if let Some(other) = placed[j] {
                    self.link(side, other);
                }
            }
        }
    }

    /// Gives a live slot new corners and forgets its constraints; tag and mark stay.
    fn reset(&mut self, t: TriangleId, corners: [VertexId; 3]) {
        self.set_corners(t, corners);
        for e in t.half_edges() {
            self.set_constrained_side(e, false);
        }
    }
}

/// Index in the chain of the vertex that makes the Delaunay triangle on the base `p -> q`.
fn apex_of(points: &[Point2], [p, q]: [VertexId; 2], chain: &[ChainEdge]) -> usize {
    let (p, q) = (points[p.index()], points[q.index()]);
    let mut best = 1;
    for i in 2..chain.len() {
        let [c, v] = [best, i].map(|k| points[chain[k].start.index()]);
        if c != v && incircle_perturbed(p, q, c, v) == Sign::Positive {
            best = i;
        }
    }
    best
}
