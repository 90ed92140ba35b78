//! Checks of the structure against its own rules, for tests, debug builds and fuzzing.

use super::{GHOST, HalfEdgeId, TriangleId, Triangulation};
use crate::point::Point2;
use crate::predicates::{Sign, incircle, orient2d};

/// A rule of the structure that does not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Broken {
    /// Two corners of a triangle are the same vertex.
    #[error("triangle {0:?} has a corner twice")]
    RepeatedCorner(TriangleId),
    /// A corner is no point.
    #[error("triangle {0:?} has a corner that is no point")]
    NoSuchPoint(TriangleId),
    /// The twin's twin is another half-edge, or the twin is not a live half-edge.
    #[error("the twin of {0:?} does not point back at it")]
    Twin(HalfEdgeId),
    /// Twins that do not join the same two vertices.
    #[error("half-edge {0:?} and its twin join different vertices")]
    Ends(HalfEdgeId),
    /// Twins of which only one is constrained.
    #[error("half-edge {0:?} and its twin disagree on being constrained")]
    Constraint(HalfEdgeId),
    /// A free list that disagrees with the flags.
    #[error("{free} slots are listed free and {dead} are not live")]
    Free {
        /// Length of the free list.
        free: usize,
        /// Slots without the live flag.
        dead: usize,
    },
    /// A finite triangle that is not counterclockwise.
    #[error("triangle {0:?} is not counterclockwise")]
    Orientation(TriangleId),
    /// A hull that turns right.
    #[error("the hull is not convex at the end of {0:?}")]
    Hull(HalfEdgeId),
    /// An unconstrained edge with the opposite vertex strictly inside the circle.
    #[error("edge {0:?} is neither constrained nor locally Delaunay")]
    Delaunay(HalfEdgeId),
}

impl Triangulation {
    /// Checks the topology: corners distinct, twins mutual and joining the same vertices,
    /// constraints on both sides, free list right.
    ///
    /// # Errors
    /// The first rule [`Broken`], in slot order.
    pub fn verify(&self) -> Result<(), Broken> {
        let dead = self.slots.len() - self.triangles().count();
        if dead != self.free.len() {
            return Err(Broken::Free { free: self.free.len(), dead });
        }
        for t in self.triangles() {
            let [a, b, c] = self.corners(t);
            if a == b || b == c || c == a {
                return Err(Broken::RepeatedCorner(t));
            }
            t.half_edges().into_iter().try_for_each(|e| self.verify_half_edge(e))?;
        }
        Ok(())
    }

    fn verify_half_edge(&self, e: HalfEdgeId) -> Result<(), Broken> {
        let Some(f) = self.twin(e) else { return Ok(()) };
        let live = f.corner() < 3 && f.triangle().index() < self.slots.len();
        if !live || !self.is_live(f.triangle()) || self.twin(f) != Some(e) || e == f {
            return Err(Broken::Twin(e));
        }
        if self.origin(e) != self.dest(f) || self.origin(f) != self.dest(e) {
            return Err(Broken::Ends(e));
        }
        if self.raw_constrained(e) != self.raw_constrained(f) {
            return Err(Broken::Constraint(e));
        }
        Ok(())
    }

    /// [`verify`](Self::verify), and with the points: finite triangles counterclockwise, the hull
    /// convex where there are ghosts, every unconstrained inner edge locally Delaunay. Together
    /// these make a constrained Delaunay triangulation of the vertices in it.
    ///
    /// # Errors
    /// The first rule [`Broken`].
    pub fn verify_geometry(&self, points: &[Point2]) -> Result<(), Broken> {
        self.verify()?;
        for t in self.triangles() {
            let corners = self.corners(t);
            if corners.iter().any(|&v| v != GHOST && v.index() >= points.len()) {
                return Err(Broken::NoSuchPoint(t));
            }
            if self.is_ghost(t) {
                self.verify_hull(points, t)?;
                continue;
            }
            let [a, b, c] = corners.map(|v| points[v.index()]);
            if orient2d(a, b, c) != Sign::Positive {
                return Err(Broken::Orientation(t));
            }
            t.half_edges().into_iter().try_for_each(|e| self.verify_delaunay(points, e))?;
        }
        Ok(())
    }

    fn verify_hull(&self, points: &[Point2], ghost: TriangleId) -> Result<(), Broken> {
        let e = self.ghost_edge(ghost);
        let next = self.twin(e.next()).ok_or(Broken::Twin(e.next()))?;
        if !self.is_ghost(next.triangle()) {
            return Err(Broken::Hull(e));
        }
        // The ghost is right of the hull edge, so its own edges run clockwise around the hull.
        let [a, b, c] = [self.origin(e), self.dest(e), self.apex(next.next())];
        if c == GHOST || self.is_line(e) {
            return Ok(());
        }
        let [a, b, c] = [a, b, c].map(|v| points[v.index()]);
        if orient2d(a, b, c) == Sign::Positive { Err(Broken::Hull(e)) } else { Ok(()) }
    }

    /// Both sides of the edge are ghosts: the points lie on one line.
    fn is_line(&self, e: HalfEdgeId) -> bool {
        self.twin(e).is_some_and(|f| self.is_ghost(f.triangle()))
    }

    fn verify_delaunay(&self, points: &[Point2], e: HalfEdgeId) -> Result<(), Broken> {
        let Some(f) = self.twin(e).filter(|_| !self.is_constrained(e)) else { return Ok(()) };
        let opposite = self.apex(f);
        if opposite == GHOST {
            return Ok(());
        }
        let [a, b, c, d] =
            [self.origin(e), self.dest(e), self.apex(e), opposite].map(|v| points[v.index()]);
        if incircle(a, b, c, d) == Sign::Positive { Err(Broken::Delaunay(e)) } else { Ok(()) }
    }
}
