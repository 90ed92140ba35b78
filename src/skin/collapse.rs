//! Edge collapse: a vertex vanishes into its neighbour.

use super::fold::{is_kept, shape};
use super::{Ground, Rank, Skin};
use crate::triangulation::{Across, HalfEdgeId, TriangleId, VertexId};
use crate::vector::distance;

/// No collapse makes an edge longer than this many times what is wanted there.
const RATIO_MAX: f64 = 4.0 / 3.0;
/// No collapse makes a triangle worse than this, unless it was worse before.
const SHAPE_MIN: f64 = 0.3;

impl<G: Ground> Skin<'_, G> {
    /// Whether the origin of `e` may vanish into its end.
    pub(super) fn can_collapse(&self, e: HalfEdgeId) -> bool {
        let (a, b) = (self.mesh.origin(e), self.mesh.dest(e));
        let is_allowed = match self.ranks[a.index()] {
            Rank::Fixed => false,
            Rank::Removable => self.mesh.is_constrained(e),
            Rank::Free => true,
        };
        is_allowed && self.is_link_sound(e, a, b) && self.is_shape_sound(e, a, b)
    }

    /// The link condition: the ends have no common neighbours but the apexes of their edge.
    fn is_link_sound(&self, e: HalfEdgeId, a: VertexId, b: VertexId) -> bool {
        let around_a = self.neighbours(a);
        let around_b = self.neighbours(b);
        let common = around_a.iter().filter(|v| around_b.contains(v)).count();
        let sides = if self.mesh.twin(e).is_some() { 2 } else { 1 };
        let is_ear = |h: HalfEdgeId| {
            self.mesh.twin(h.next()).is_none() && self.mesh.twin(h.prev()).is_none()
        };
        if is_ear(e) || self.mesh.twin(e).is_some_and(is_ear) {
            return false;
        }
        // At least a triangle must be left, and a tetrahedron must not fold onto itself.
        common == sides && around_a.len() > 2 && around_a.len() + around_b.len() > 6
    }

    /// Neighbours of a vertex, in the order of its star.
    fn neighbours(&self, v: VertexId) -> Vec<VertexId> {
        let mut all = Vec::with_capacity(8);
        for e in self.mesh.star(self.out(v)) {
            all.push(self.mesh.dest(e));
            if self.mesh.twin(e.prev()).is_none() {
                all.push(self.mesh.apex(e));
            }
        }
        all
    }

    /// No triangle turns over, becomes bad, or gets a long edge.
    fn is_shape_sound(&self, e: HalfEdgeId, a: VertexId, b: VertexId) -> bool {
        let target = self.at(b);
        let is_free = self.ranks[a.index()] == Rank::Free;
        self.mesh.star(e).all(|h| {
            let (x, y) = (self.mesh.dest(h), self.mesh.apex(h));
            if x == b || y == b {
                return true;
            }
            let old = self.corners(h.triangle());
            let new = [target, self.at(x), self.at(y)];
            let wanted = 0.5 * (self.spacing[b.index()] + self.spacing[x.index()]);
            let is_short = distance(target, self.at(x)) <= RATIO_MAX * wanted;
            is_kept(new, self.normal(h.triangle()))
                && (!is_free || is_short)
                && shape(new) >= SHAPE_MIN.min(0.5 * shape(old))
        })
    }

    /// Lets the origin of `e` vanish into its end; [`can_collapse`](Self::can_collapse) holds.
    pub(super) fn collapse(&mut self, e: HalfEdgeId) {
        let (a, b) = (self.mesh.origin(e), self.mesh.dest(e));
        let star: Vec<HalfEdgeId> = self.mesh.star(e).collect();
        let flat: Vec<TriangleId> =
            [Some(e), self.mesh.twin(e)].into_iter().flatten().map(HalfEdgeId::triangle).collect();
        for &h in star.iter().filter(|h| !flat.contains(&h.triangle())) {
            let mut corners = self.mesh.corners(h.triangle());
            corners[h.corner()] = b;
            self.mesh.set_corners(h.triangle(), corners);
        }
        self.close(e);
        if let Some(f) = self.mesh.twin(e) {
            self.close(f);
        }
        flat.iter().for_each(|&t| self.mesh.remove(t));
        for &h in star.iter().filter(|h| !flat.contains(&h.triangle())) {
            self.anchor_triangle(h.triangle());
        }
        self.gone[a.index()] = true;
    }

    /// Glues the two other sides of a triangle of the collapsed edge together.
    fn close(&mut self, e: HalfEdgeId) {
        let (x, y) = (e.next(), e.prev());
        let keeps = self.mesh.is_constrained(x) || self.mesh.is_constrained(y);
        match (self.mesh.across(x), self.mesh.across(y)) {
            (Across::Twin(p), Across::Twin(q)) => {
                self.mesh.link(p, q);
                self.mesh.set_constrained(p, keeps);
            }
            (Across::Twin(p), Across::Border(owner)) | (Across::Border(owner), Across::Twin(p)) => {
                self.mesh.set_border(p, owner);
                self.mesh.set_constrained_side(p, true);
            }
            (Across::Border(_), Across::Border(_)) => {
                unreachable!("a triangle of its own is not collapsed")
            }
        }
    }
}
