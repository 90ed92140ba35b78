//! Point location by walking.
//!
//! A visibility walk (Devillers, Pion, Teillaud, *Walking in a triangulation*, 2002) that leaves
//! each triangle by an edge which has the target strictly on its other side. It ends in a Delaunay
//! triangulation; in another it may cycle, so its steps are bounded and then the straight walk
//! takes over, which moves along a line and cannot come back. Both decide by exact orientation.

use super::{Across, GHOST, HalfEdgeId, TriangleId, Triangulation, VertexId};
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};

/// Where a point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// In the interior of a triangle.
    Inside(TriangleId),
    /// In the interior of an edge.
    OnEdge(HalfEdgeId),
    /// On the vertex this half-edge starts from.
    OnVertex(HalfEdgeId),
    /// Strictly right of this half-edge of a finite triangle, which has a ghost or a border across.
    /// On a convex triangulation with ghosts: outside the hull. Among borders: the walk was
    /// stopped here, and a region that is not convex may still have the point elsewhere.
    /// (Where there are ghosts only, all points being collinear: an edge of some ghost.)
    Outside(HalfEdgeId),
}

/// What a ray from a vertex meets first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayHit {
    /// The ray runs along an edge to its other end.
    Vertex {
        /// The edge, as one of its halves.
        edge: HalfEdgeId,
        /// A half-edge out of the vertex reached.
        at: HalfEdgeId,
    },
    /// It enters the triangle of this half-edge, which is the side opposite its vertex.
    Edge(HalfEdgeId),
    /// It leaves the triangulation at once; a hull or border edge at the vertex that has the
    /// target strictly right of it or in line with it.
    Outside(HalfEdgeId),
}

impl Triangulation {
    /// Finds `q`, walking from the triangle `hint` (live, ghost or not).
    ///
    /// # Complexity
    /// Proportional to the triangles between `hint` and `q`.
    #[must_use]
    pub fn locate(&self, points: &[Point2], q: Point2, hint: TriangleId) -> Location {
        let Some(start) = self.finite_near(hint) else {
            return self.locate_on_line(points, q);
        };
        self.visibility_walk(points, q, start)
            .unwrap_or_else(|| self.straight_walk(points, q, start.half_edge(0)))
    }

    /// `hint`, or the finite triangle across if it is a ghost, or any finite one.
    fn finite_near(&self, hint: TriangleId) -> Option<TriangleId> {
        if !self.is_ghost(hint) {
            return Some(hint);
        }
        let inward = self.twin(self.ghost_edge(hint)).map(HalfEdgeId::triangle);
        inward
            .filter(|&t| !self.is_ghost(t))
            .or_else(|| self.triangles().find(|&t| !self.is_ghost(t)))
    }

    /// The half-edge of a ghost triangle that joins its two finite vertices.
    #[inline]
    #[must_use]
    pub fn ghost_edge(&self, ghost: TriangleId) -> HalfEdgeId {
        let corners = self.corners(ghost);
        debug_assert!(corners.contains(&GHOST), "not a ghost");
        let at = if corners[0] == GHOST { 1 } else { 2 * u32::from(corners[1] == GHOST) };
        ghost.half_edge(at)
    }

    /// `None` when the step bound is reached. The edge tried first alternates by a fixed
    /// multiplicative generator, which breaks nearly all cycles before the bound does.
    fn visibility_walk(&self, points: &[Point2], q: Point2, from: TriangleId) -> Option<Location> {
        let mut here = from;
        let mut entered = None;
        let mut dice = 1_u32;
        for _ in 0..=self.slot_count() {
            dice = dice.wrapping_mul(0x9E37_79B1).wrapping_add(0x7F4A_7C15);
            match self.leave(points, q, (here, entered), dice >> 31) {
                Ok(location) => return Some(location),
                Err(across) => {
                    here = across.triangle();
                    entered = Some(across);
                }
            }
        }
        None
    }

    /// The half-edge across which the walk goes on, as seen from the neighbour; or the answer.
    fn leave(
        &self,
        points: &[Point2],
        q: Point2,
        (here, entered): (TriangleId, Option<HalfEdgeId>),
        turn: u32,
    ) -> Result<Location, HalfEdgeId> {
        let first = match entered {
            Some(e) if turn == 0 => e.next(),
            Some(e) => e.prev(),
            None => here.half_edge(turn),
        };
        let order = match entered {
            Some(_) if turn == 0 => [first, first.next(), first.prev()],
            _ => [first, first.prev(), first.next()],
        };
        let mut zeros = [None; 2];
        let mut blocked = None;
        for e in order.into_iter().filter(|&e| Some(e) != entered) {
            match self.side_of(points, e, q) {
                Sign::Negative => match self.twin(e) {
                    Some(f) if !self.is_ghost(f.triangle()) => return Err(f),
                    _ => blocked = Some(e),
                },
                Sign::Zero if zeros[0].is_none() => zeros[0] = Some(e),
                Sign::Zero => zeros[1] = Some(e),
                Sign::Positive => {}
            }
        }
        Ok(match (blocked, zeros) {
            (Some(e), _) => Location::Outside(e),
            (None, [None, _]) => Location::Inside(here),
            (None, [Some(e), None]) => Location::OnEdge(e),
            (None, [Some(e), Some(f)]) => Location::OnVertex(if e.next() == f { f } else { e }),
        })
    }

    #[inline]
    fn side_of(&self, points: &[Point2], e: HalfEdgeId, q: Point2) -> Sign {
        orient2d(points[self.origin(e).index()], points[self.dest(e).index()], q)
    }

    /// Location along the line from the origin of `from` to `q`: cannot cycle, as each step comes
    /// nearer to `q` on that line.
    fn straight_walk(&self, points: &[Point2], q: Point2, from: HalfEdgeId) -> Location {
        let mut vertex = from;
        loop {
            if points[self.origin(vertex).index()] == q {
                return Location::OnVertex(vertex);
            }
            match self.ray(points, vertex, q) {
                RayHit::Outside(e) => return Location::Outside(e),
                RayHit::Vertex { edge, at } => {
                    let [a, b] = [vertex, at].map(|h| points[self.origin(h).index()]);
                    if between(a, q, b) {
                        return Location::OnEdge(edge);
                    }
                    vertex = at;
                }
                RayHit::Edge(e) => match self.cross_until_vertex(points, q, (vertex, e)) {
                    Ok(location) => return location,
                    Err(next) => vertex = next,
                },
            }
        }
    }

    /// Crosses edges from the triangle of `e` until `q` is found or a vertex lies on the line.
    fn cross_until_vertex(
        &self,
        points: &[Point2],
        q: Point2,
        (vertex, mut e): (HalfEdgeId, HalfEdgeId),
    ) -> Result<Location, HalfEdgeId> {
        let start = points[self.origin(vertex).index()];
        loop {
            match self.side_of(points, e, q) {
                Sign::Positive => return Ok(Location::Inside(e.triangle())),
                Sign::Zero => return Ok(Location::OnEdge(e)),
                Sign::Negative => {}
            }
            let f = match self.twin(e) {
                Some(f) if !self.is_ghost(f.triangle()) => f,
                _ => return Ok(Location::Outside(e)),
            };
            let apex = points[self.apex(f).index()];
            match orient2d(start, q, apex) {
                Sign::Positive => e = f.next(),
                Sign::Negative => e = f.prev(),
                Sign::Zero if apex == q || between(start, apex, q) => return Err(f.prev()),
                Sign::Zero => return Ok(Location::Inside(f.triangle())),
            }
        }
    }

    /// What the ray from the origin of `from` towards `q` (another point) meets first.
    #[must_use]
    pub fn ray(&self, points: &[Point2], from: HalfEdgeId, q: Point2) -> RayHit {
        let a = points[self.origin(from).index()];
        let mut outside = from;
        for e in self.star(from) {
            let (u, w) = (self.dest(e), self.apex(e));
            if u != GHOST && self.ray_runs_along(points, a, q, u) {
                return RayHit::Vertex { edge: e, at: e.next() };
            }
            if u == GHOST || w == GHOST {
                outside = if w == GHOST { e } else { e.prev() };
                continue;
            }
            let (u, w) = (points[u.index()], points[w.index()]);
            let left = orient2d(a, q, w);
            if orient2d(a, q, u) == Sign::Negative && left == Sign::Positive {
                return RayHit::Edge(e.next());
            }
            if left == Sign::Zero && same_direction(a, q, w) {
                // Seen from this side too: along a border the edge has only this half.
                return RayHit::Vertex { edge: e.prev(), at: e.prev() };
            }
            if let Across::Border(_) = self.across(e.prev()) {
                outside = e.prev();
            }
        }
        RayHit::Outside(self.outer_edge(points, outside, q))
    }

    /// Of the two hull edges beside the ghost at a vertex, one that has `q` strictly right of it.
    fn outer_edge(&self, points: &[Point2], e: HalfEdgeId, q: Point2) -> HalfEdgeId {
        if !self.is_ghost(e.triangle()) {
            return e;
        }
        let hull = self.ghost_edge(e.triangle());
        let beside = [self.origin(hull), self.dest(hull)];
        let pick = self
            .star(hull)
            .chain(self.star(hull.next()))
            .filter(|h| self.is_ghost(h.triangle()))
            .map(|h| self.ghost_edge(h.triangle()))
            .find(|&g| self.side_of(points, g, q) == Sign::Positive);
        debug_assert!(!beside.contains(&GHOST), "a ghost has one infinite corner");
        pick.and_then(|g| self.twin(g)).unwrap_or(hull)
    }

    fn ray_runs_along(&self, points: &[Point2], a: Point2, q: Point2, u: VertexId) -> bool {
        let u = points[u.index()];
        orient2d(a, q, u) == Sign::Zero && same_direction(a, q, u)
    }

    /// All points on one line: only ghosts, two an edge.
    fn locate_on_line(&self, points: &[Point2], q: Point2) -> Location {
        let mut last = HalfEdgeId(0);
        for ghost in self.triangles() {
            let e = self.ghost_edge(ghost);
            let [a, b] = [self.origin(e), self.dest(e)].map(|v| points[v.index()]);
            last = e;
            if a == q {
                return Location::OnVertex(e);
            }
            if b == q {
                return Location::OnVertex(e.next());
            }
            if orient2d(a, b, q) == Sign::Zero && between(a, q, b) {
                return Location::OnEdge(e);
            }
        }
        Location::Outside(last)
    }
}

/// Whether `q` and `u`, both in line with `a`, lie on the same side of it. Exact: comparisons only.
pub(crate) fn same_direction(a: Point2, q: Point2, u: Point2) -> bool {
    a.lexicographic(q) == a.lexicographic(u)
}

/// Whether `m`, in line with `a` and `b`, lies strictly between them. Exact: comparisons only.
pub(crate) fn between(a: Point2, m: Point2, b: Point2) -> bool {
    let order = a.lexicographic(m);
    order.is_ne() && order == m.lexicographic(b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::delaunay::cdt;

    fn lattice(side: u32) -> Vec<Point2> {
        let cells = 0..side * side;
        cells.map(|i| Point2::new(f64::from(i % side), f64::from(i / side))).collect()
    }

    /// The place as a set of vertices, whatever half-edge names it.
    fn vertices(t: &Triangulation, place: Location) -> Vec<VertexId> {
        let mut list = match place {
            Location::Inside(u) => t.corners(u).to_vec(),
            Location::OnEdge(e) => vec![t.origin(e), t.dest(e)],
            Location::OnVertex(e) => vec![t.origin(e)],
            Location::Outside(_) => Vec::new(),
        };
        list.sort_unstable();
        list
    }

    // spec: T2
    #[test]
    fn the_straight_walk_finds_what_the_visibility_walk_finds() {
        let points = lattice(6);
        let t = cdt(&points, &[[1, 14], [9, 34], [20, 33]]).unwrap().triangulation;
        for start in t.triangles().filter(|&u| !t.is_ghost(u)) {
            for i in -2..26 {
                for j in -2..26 {
                    let q = Point2::new(f64::from(i) / 4.0, f64::from(j) / 4.0);
                    let straight = t.straight_walk(&points, q, start.half_edge(0));
                    let walk = t.visibility_walk(&points, q, start).unwrap();
                    assert_eq!(vertices(&t, straight), vertices(&t, walk), "{start:?} {q}");
                    if let Location::Outside(e) = straight {
                        assert_eq!(t.side_of(&points, e, q), Sign::Negative);
                    }
                }
            }
        }
    }
}
