//! Merging two Delaunay triangulations that a line separates.
//!
//! A ghost stands for each hull edge `u -> v` (counterclockwise, inside on its left) and always has
//! the corners `(v, u, GHOST)`, so that its half-edges are 0: `v -> u`, the outer side of the hull
//! edge; 1: `u -> GHOST`, towards the ghost of the hull edge before; 2: `GHOST -> v`, towards the one
//! after.

use crate::point::Point2;
use crate::predicates::{Sign, incircle_perturbed, orient2d};
use crate::triangulation::arena::Arena;
use crate::triangulation::{GHOST, HalfEdgeId, TriangleId, VertexId};

/// How the line between two parts runs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Cut {
    /// First part left, second right.
    Vertical,
    /// First part below, second above.
    Horizontal,
}

/// A hull vertex and the ghost of the hull edge that starts there.
#[derive(Clone, Copy)]
struct Hull {
    vertex: VertexId,
    ghost: TriangleId,
}

/// A triangulated range of points.
#[derive(Clone, Copy)]
pub(super) struct Part {
    left: Hull,
    right: Hull,
    bottom: Hull,
    top: Hull,
    /// Two slots of the range that are not in use.
    spare: [TriangleId; 2],
    /// A lone point: no ghosts.
    single: bool,
}

/// One, two or three points.
pub(super) fn leaf(arena: &mut Arena<'_>, points: &[Point2], low: usize, high: usize) -> Part {
    let slot = |i: usize| TriangleId((2 * low + i) as u32);
    let vertex = |i: usize| VertexId((low + i) as u32);
    match high - low {
        1 => {
            let only = Hull { vertex: vertex(0), ghost: slot(0) };
            let spare = [slot(0), slot(1)];
            Part { left: only, right: only, bottom: only, top: only, spare, single: true }
        }
        2 => edge(arena, points, [vertex(0), vertex(1)], [0, 1, 2, 3].map(slot)),
        _ => {
            let [a, b, c] = [0, 1, 2].map(vertex);
            let [pa, pb, pc] = [a, b, c].map(|v| points[v.index()]);
            match orient2d(pa, pb, pc) {
                Sign::Positive => triangle(arena, points, [a, b, c], [0, 1, 2, 3, 4, 5].map(slot)),
                Sign::Negative => triangle(arena, points, [a, c, b], [0, 1, 2, 3, 4, 5].map(slot)),
                Sign::Zero => three_in_line(arena, points, [a, b, c], [0, 1, 2, 3, 4, 5].map(slot)),
            }
        }
    }
}

fn ghost(arena: &mut Arena<'_>, slot: TriangleId, from: VertexId, to: VertexId) -> Hull {
    arena.set(slot, [to, from, GHOST]);
    Hull { vertex: from, ghost: slot }
}

/// Two ghosts back to back.
fn edge(
    arena: &mut Arena<'_>,
    points: &[Point2],
    [a, b]: [VertexId; 2],
    [s, t, u, v]: [TriangleId; 4],
) -> Part {
    let hulls = [ghost(arena, s, a, b), ghost(arena, t, b, a)];
    arena.link(s.half_edge(0), t.half_edge(0));
    arena.link(s.half_edge(1), t.half_edge(2));
    arena.link(s.half_edge(2), t.half_edge(1));
    part(points, &hulls, [u, v])
}

/// A counterclockwise triangle and three ghosts.
fn triangle(
    arena: &mut Arena<'_>,
    points: &[Point2],
    corners: [VertexId; 3],
    slots: [TriangleId; 6],
) -> Part {
    let [a, b, c] = corners;
    let [t, u, v, w, s0, s1] = slots;
    arena.set(t, corners);
    let hulls = [ghost(arena, u, a, b), ghost(arena, v, b, c), ghost(arena, w, c, a)];
    for (i, (g, next)) in [(u, v), (v, w), (w, u)].into_iter().enumerate() {
        arena.link(t.half_edge(i as u32), g.half_edge(0));
        arena.link(g.half_edge(2), next.half_edge(1));
    }
    part(points, &hulls, [s0, s1])
}

fn three_in_line(
    arena: &mut Arena<'_>,
    points: &[Point2],
    mut corners: [VertexId; 3],
    [s0, s1, s2, s3, s4, s5]: [TriangleId; 6],
) -> Part {
    corners.sort_unstable_by(|a, b| points[a.index()].lexicographic(points[b.index()]));
    let only = Hull { vertex: corners[0], ghost: s0 };
    let spare = [s0, s1];
    let first = Part { left: only, right: only, bottom: only, top: only, spare, single: true };
    let rest = edge(arena, points, [corners[1], corners[2]], [s2, s3, s4, s5]);
    merge(arena, points, (first, rest), Cut::Vertical)
}

/// The part with these hull vertices.
fn part(points: &[Point2], hulls: &[Hull], spare: [TriangleId; 2]) -> Part {
    let at = |h: Hull| points[h.vertex.index()];
    let pick = |better: &dyn Fn(Point2, Point2) -> bool| {
        hulls.iter().copied().reduce(|a, b| if better(at(b), at(a)) { b } else { a })
    };
    let pick = |better: &dyn Fn(Point2, Point2) -> bool| pick(better).expect("a hull has vertices");
    Part {
        left: pick(&|b, a| b.lexicographic(a).is_lt()),
        right: pick(&|b, a| b.lexicographic(a).is_gt()),
        bottom: pick(&|b, a| b.y < a.y),
        top: pick(&|b, a| b.y > a.y),
        spare,
        single: false,
    }
}

/// The seam while it is sewn: the base edge runs from `l` (first part) to `r` (second part), all
/// below it is done.
struct Seam<'a, 'b> {
    arena: &'a mut Arena<'b>,
    points: &'a [Point2],
    l: VertexId,
    r: VertexId,
    /// Ghost of the hull edge that leaves `l` upward, `None` for a lone point.
    left: Option<TriangleId>,
    /// Ghost of the hull edge that comes down to `r`.
    right: Option<TriangleId>,
    /// The half-edge `r -> l` of the triangle below the base.
    base: HalfEdgeId,
}

/// Sews two parts together. For a horizontal cut read left as below and right as above: everything
/// is turned by a right angle.
pub(super) fn merge(
    arena: &mut Arena<'_>,
    points: &[Point2],
    (first, second): (Part, Part),
    cut: Cut,
) -> Part {
    let start = match cut {
        Cut::Vertical => (first.right, second.left),
        Cut::Horizontal => (first.top, second.bottom),
    };
    let start =
        (Some(start.0).filter(|_| !first.single), Some(start.1).filter(|_| !second.single), start);
    let (low_left, low_right) = lower_tangent(arena, points, start);
    let [bottom, top] = first.spare;
    let (l, r) = (low_left.vertex, low_right.vertex);
    let left = (!first.single).then_some(low_left.ghost);
    let after = (!second.single).then_some(low_right.ghost);
    let before = left.map(|g| arena.twin(g.half_edge(1)).triangle());
    let right = after.map(|g| arena.twin(g.half_edge(1)).triangle());
    arena.set(bottom, [r, l, GHOST]);
    if let Some(before) = before {
        arena.link(bottom.half_edge(1), before.half_edge(2));
    }
    if let Some(after) = after {
        arena.link(bottom.half_edge(2), after.half_edge(1));
    }
    let mut seam = Seam { arena, points, l, r, left, right, base: bottom.half_edge(0) };
    seam.sew();
    let Seam { arena, l: l_top, r: r_top, left: after_top, right: before_top, base, .. } = seam;
    arena.set(top, [l_top, r_top, GHOST]);
    arena.link(top.half_edge(0), base);
    // A lone point has no ghosts; of a part of which but one vertex stays on the hull, all ghosts are
    // used up and the bottom one comes next. Either way the new ghosts are neighbours there.
    let ghost_left = |g: &TriangleId| *g != bottom;
    match before_top.filter(ghost_left) {
        Some(g) => arena.link(top.half_edge(1), g.half_edge(2)),
        None => arena.link(top.half_edge(1), bottom.half_edge(2)),
    }
    match after_top.filter(ghost_left) {
        Some(g) => arena.link(top.half_edge(2), g.half_edge(1)),
        None => arena.link(top.half_edge(2), bottom.half_edge(1)),
    }
    let from_first = |h: Hull| if h.vertex == l { Hull { ghost: bottom, ..h } } else { h };
    let from_second = |h: Hull| if h.vertex == r_top { Hull { ghost: top, ..h } } else { h };
    let at = |h: Hull| points[h.vertex.index()];
    let choose = |a: Hull, b: Hull, second_better: bool| {
        if second_better { from_second(b) } else { from_first(a) }
    };
    let left_better = at(second.left).lexicographic(at(first.left)).is_lt();
    let right_better = at(second.right).lexicographic(at(first.right)).is_gt();
    Part {
        left: choose(first.left, second.left, left_better),
        right: choose(first.right, second.right, right_better),
        bottom: choose(first.bottom, second.bottom, at(second.bottom).y < at(first.bottom).y),
        top: choose(first.top, second.top, at(second.top).y > at(first.top).y),
        spare: second.spare,
        single: false,
    }
}

type Start = (Option<Hull>, Option<Hull>, (Hull, Hull));

/// Walks down both hulls to the edge that has everything on its left or on its line.
fn lower_tangent(arena: &Arena<'_>, points: &[Point2], start: Start) -> (Hull, Hull) {
    let (left, right, (mut l, mut r)) = start;
    let at = |v: VertexId| points[v.index()];
    loop {
        let mut moved = false;
        while left.is_some() {
            let ghost = arena.twin(l.ghost.half_edge(1)).triangle();
            let vertex = arena.origin(ghost.half_edge(1));
            if orient2d(at(l.vertex), at(r.vertex), at(vertex)) != Sign::Negative {
                break;
            }
            l = Hull { vertex, ghost };
            moved = true;
        }
        while right.is_some() {
            let vertex = arena.origin(r.ghost.half_edge(0));
            if orient2d(at(l.vertex), at(r.vertex), at(vertex)) != Sign::Negative {
                break;
            }
            r = Hull { vertex, ghost: arena.twin(r.ghost.half_edge(2)).triangle() };
            moved = true;
        }
        if !moved {
            return (l, r);
        }
    }
}

impl Seam<'_, '_> {
    #[inline(always)]
    fn at(&self, v: VertexId) -> Point2 {
        self.points[v.index()]
    }

    fn sew(&mut self) {
        loop {
            let (pl, pr) = (self.at(self.l), self.at(self.r));
            let left = self.left_candidate(pl, pr);
            let right = self.right_candidate(pl, pr);
            match (left, right) {
                (None, None) => return,
                (Some(v), None) => self.take_left(v),
                (None, Some(v)) => self.take_right(v),
                (Some(v), Some(w)) => {
                    if incircle_perturbed(self.at(v), pl, pr, self.at(w)) == Sign::Positive {
                        self.take_right(w);
                    } else {
                        self.take_left(v);
                    }
                }
            }
        }
    }

    /// The vertex next to `l` up its hull, after removing the edges to it that the base's new
    /// triangle invalidates; `None` if it is not above the base.
    #[inline(always)]
    fn left_candidate(&mut self, pl: Point2, pr: Point2) -> Option<VertexId> {
        let ghost = self.left?;
        let mut vertex = self.arena.origin(ghost.half_edge(0));
        if orient2d(pl, pr, self.at(vertex)) != Sign::Positive {
            return None;
        }
        loop {
            let inner = self.arena.twin(ghost.half_edge(0));
            let beyond = self.arena.origin(inner.prev());
            let stays = beyond == GHOST
                || incircle_perturbed(pl, pr, self.at(vertex), self.at(beyond)) != Sign::Positive;
            if stays {
                return Some(vertex);
            }
            self.drop_left(ghost, inner, [vertex, beyond]);
            vertex = beyond;
        }
    }

    #[inline(always)]
    fn right_candidate(&mut self, pl: Point2, pr: Point2) -> Option<VertexId> {
        let ghost = self.right?;
        let mut vertex = self.arena.origin(ghost.half_edge(1));
        if orient2d(pl, pr, self.at(vertex)) != Sign::Positive {
            return None;
        }
        loop {
            let inner = self.arena.twin(ghost.half_edge(0));
            let beyond = self.arena.origin(inner.prev());
            let stays = beyond == GHOST
                || incircle_perturbed(pl, pr, self.at(vertex), self.at(beyond)) != Sign::Positive;
            if stays {
                return Some(vertex);
            }
            self.drop_right(ghost, inner, [vertex, beyond]);
            vertex = beyond;
        }
    }

    /// Removes the hull edge from `l` to `vertex`: the triangle behind it becomes the ghost of
    /// `beyond -> vertex`, and the ghost that of `l -> beyond`.
    fn drop_left(&mut self, ghost: TriangleId, inner: HalfEdgeId, [vertex, beyond]: [VertexId; 2]) {
        let (to_beyond, to_l) = (self.arena.twin(inner.next()), self.arena.twin(inner.prev()));
        let after = self.arena.twin(ghost.half_edge(2));
        let other = inner.triangle();
        self.arena.set_origin(ghost.half_edge(0), beyond);
        self.arena.set(other, [vertex, beyond, GHOST]);
        self.arena.link(ghost.half_edge(0), to_l);
        self.arena.link(other.half_edge(0), to_beyond);
        self.arena.link(ghost.half_edge(2), other.half_edge(1));
        self.arena.link(other.half_edge(2), after);
    }

    /// Removes the hull edge from `vertex` to `r`: the triangle behind it becomes the ghost of
    /// `vertex -> beyond`, and the ghost that of `beyond -> r`.
    fn drop_right(
        &mut self,
        ghost: TriangleId,
        inner: HalfEdgeId,
        [vertex, beyond]: [VertexId; 2],
    ) {
        let (to_r, to_vertex) = (self.arena.twin(inner.next()), self.arena.twin(inner.prev()));
        let before = self.arena.twin(ghost.half_edge(1));
        let other = inner.triangle();
        self.arena.set_origin(ghost.half_edge(1), beyond);
        self.arena.set(other, [beyond, vertex, GHOST]);
        self.arena.link(ghost.half_edge(0), to_r);
        self.arena.link(other.half_edge(0), to_vertex);
        self.arena.link(ghost.half_edge(1), other.half_edge(2));
        self.arena.link(other.half_edge(1), before);
    }

    /// The left ghost becomes the triangle `(vertex, l, r)`.
    #[inline(always)]
    fn take_left(&mut self, vertex: VertexId) {
        let ghost = self.left.expect("a candidate has a ghost");
        let after = self.arena.twin(ghost.half_edge(2)).triangle();
        self.arena.set_origin(ghost.half_edge(2), self.r);
        self.arena.link(ghost.half_edge(1), self.base);
        self.base = ghost.half_edge(2);
        self.l = vertex;
        self.left = Some(after);
    }

    /// The right ghost becomes the triangle `(r, vertex, l)`.
    #[inline(always)]
    fn take_right(&mut self, vertex: VertexId) {
        let ghost = self.right.expect("a candidate has a ghost");
        let before = self.arena.twin(ghost.half_edge(1)).triangle();
        self.arena.set_origin(ghost.half_edge(2), self.l);
        self.arena.link(ghost.half_edge(2), self.base);
        self.base = ghost.half_edge(1);
        self.r = vertex;
        self.right = Some(before);
    }
}
