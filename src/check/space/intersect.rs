//! Exact intersection of triangles in space, by signs of orient3d and, in a common plane, orient2d.

use crate::check::exact::{self, P3, orient2d};
use crate::check::lattice::Lattice;
use crate::mesh::MeshData;
use rayon::prelude::*;
use std::cmp::Ordering::{self, Equal, Greater, Less};

/// Coordinates of a mesh in space, and the exact predicates on its points by index.
pub(super) struct Space<'a> {
    mesh: &'a MeshData,
    lattice: Lattice<3>,
}

/// Triangles per piece of parallel work.
const CHUNK: usize = 1 << 14;

impl<'a> Space<'a> {
    pub(super) fn new(mesh: &'a MeshData) -> Self {
        Self { mesh, lattice: Lattice::of(&mesh.points) }
    }

    pub(super) fn point(&self, v: u32) -> P3 {
        self.mesh.points[v as usize]
    }

    /// Which side of the plane through a, b, c the point d lies on.
    fn orient(&self, corners: [u32; 4]) -> Ordering {
        match self.lattice.points(corners) {
            Some([a, b, c, d]) => {
                exact::orient3d_narrow([0, 1, 2].map(|k| [a[k], b[k], c[k], d[k]]))
            }
            None => {
                let [a, b, c, d] = corners.map(|v| self.point(v));
                exact::orient3d(a, b, c, d)
            }
        }
    }

    /// The sign of the area of a triangle's projection along an axis.
    fn orient_along(&self, axis: usize, corners: [u32; 3]) -> Ordering {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        match self.lattice.points(corners) {
            Some([a, b, c]) => exact::determinant([a[i], b[i], c[i]], [a[j], b[j], c[j]]).cmp(&0),
            None => {
                let [a, b, c] = corners.map(|v| self.point(v)).map(|p| [p[i], p[j]]);
                orient2d(a, b, c)
            }
        }
    }

    /// An axis along which the triangle's projection has an area; `None` when it has none itself.
    fn open_axis(&self, corners: [u32; 3]) -> Option<usize> {
        [2, 0, 1].into_iter().find(|&axis| self.orient_along(axis, corners).is_ne())
    }

    /// The triangles whose corners lie on a line, sorted.
    pub(super) fn degenerate(&self, triangles: &[[u32; 3]]) -> Vec<u32> {
        let piece = |(chunk, triangles): (usize, &[[u32; 3]])| {
            let numbered = ((chunk * CHUNK) as u32..).zip(triangles);
            let flat = numbered.filter(|(_, t)| self.open_axis(**t).is_none());
            flat.map(|(t, _)| t).collect::<Vec<u32>>()
        };
        triangles.par_chunks(CHUNK).enumerate().flat_map_iter(piece).collect()
    }

    /// Whether two triangles with area meet in more than their common corners and edge.
    pub(super) fn meet_improperly(&self, mut s: [u32; 3], mut t: [u32; 3]) -> bool {
        let common = bring_common_first(&mut s, &mut t);
        match common {
            0 => self.disjoint_corners_meet(s, t),
            1 => self.meet_beyond_corner(s, t),
            2 => self.overlap_along_edge(s, t),
            _ => true,
        }
    }

    /// No common corner: any meeting counts. Some edge of one then meets the other.
    fn disjoint_corners_meet(&self, s: [u32; 3], t: [u32; 3]) -> bool {
        let of_t = t.map(|v| self.orient([s[0], s[1], s[2], v]));
        if is_one_sided(&of_t) {
            return false;
        }
        let of_s = s.map(|v| self.orient([t[0], t[1], t[2], v]));
        if is_one_sided(&of_s) {
            return false;
        }
        (0..3).any(|i| self.segment_meets(i, (t, of_t), s))
            || (0..3).any(|i| self.segment_meets(i, (s, of_s), t))
    }

    /// Whether edge i of a triangle, whose corners have the given sides of the other's plane, meets
    /// the other.
    fn segment_meets(&self, i: usize, (of, sides): ([u32; 3], [Ordering; 3]), t: [u32; 3]) -> bool {
        let j = (i + 1) % 3;
        self.sided_segment_meets([of[i], of[j]], [sides[i], sides[j]], t)
    }

    /// Whether a segment with ends on the given sides of a triangle's plane meets the triangle.
    fn sided_segment_meets(&self, [p, q]: [u32; 2], sides: [Ordering; 2], t: [u32; 3]) -> bool {
        match sides {
            [Equal, Equal] => self.coplanar_segment_meets([p, q], t),
            [a, b] if a == b => false,
            _ => {
                // The line through p and q passes the three edges on one side.
                let [a, b, c] = t;
                let turns = [[a, b], [b, c], [c, a]].map(|[u, v]| self.orient([p, q, u, v]));
                !(turns.contains(&Greater) && turns.contains(&Less))
            }
        }
    }

    /// The same for a segment in the triangle's plane, seen along an axis in which the triangle has
    /// an area.
    fn coplanar_segment_meets(&self, [p, q]: [u32; 2], t: [u32; 3]) -> bool {
        let Some(axis) = self.open_axis(t) else { return true };
        let turn = |a, b, c| self.orient_along(axis, [a, b, c]);
        let facing = turn(t[0], t[1], t[2]);
        let edges = [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
        let is_in = |v: u32| edges.iter().all(|&[a, b]| turn(a, b, v) != facing.reverse());
        is_in(p) || is_in(q) || edges.iter().any(|&e| self.coplanar_segments_meet(axis, [p, q], e))
    }

    fn coplanar_segments_meet(&self, axis: usize, [p, q]: [u32; 2], [a, b]: [u32; 2]) -> bool {
        let turn = |u, v, w| self.orient_along(axis, [u, v, w]);
        let (of_a, of_b) = (turn(p, q, a), turn(p, q, b));
        let (of_p, of_q) = (turn(a, b, p), turn(a, b, q));
        if of_a.is_eq() && of_b.is_eq() {
            // On one line: they meet when their boxes do.
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            let at = |v: u32| (self.point(v)[i], self.point(v)[j]);
            let order = |u: u32, v: u32| if at(u) <= at(v) { (u, v) } else { (v, u) };
            let ((p, q), (a, b)) = (order(p, q), order(a, b));
            return at(p) <= at(b) && at(a) <= at(q);
        }
        of_a != of_b && of_p != of_q
    }

    /// One common corner, the first of both: they meet beyond it exactly when the opposite edge of
    /// one meets the other, for a segment from the common corner leaves a triangle through the
    /// opposite edge.
    fn meet_beyond_corner(&self, s: [u32; 3], t: [u32; 3]) -> bool {
        let of_t = [t[1], t[2]].map(|v| self.orient([s[0], s[1], s[2], v]));
        if of_t[0] == of_t[1] && of_t[0].is_ne() {
            return false;
        }
        let of_s = [s[1], s[2]].map(|v| self.orient([t[0], t[1], t[2], v]));
        if of_s[0] == of_s[1] && of_s[0].is_ne() {
            return false;
        }
        self.sided_segment_meets([t[1], t[2]], of_t, s)
            || self.sided_segment_meets([s[1], s[2]], of_s, t)
    }

    /// A common edge, the first two corners of both: they overlap when they lie in one plane with
    /// their apexes on the same side of the edge.
    fn overlap_along_edge(&self, s: [u32; 3], t: [u32; 3]) -> bool {
        if self.orient([s[0], s[1], s[2], t[2]]).is_ne() {
            return false;
        }
        let Some(axis) = self.open_axis(s) else { return true };
        self.orient_along(axis, s) == self.orient_along(axis, [s[0], s[1], t[2]])
    }
}

/// Whether all signs are positive, or all negative.
fn is_one_sided(signs: &[Ordering; 3]) -> bool {
    signs[0].is_ne() && signs[0] == signs[1] && signs[1] == signs[2]
}

/// Reorders both triangles so that common corners come first, in the same order; how many.
fn bring_common_first(s: &mut [u32; 3], t: &mut [u32; 3]) -> usize {
    let mut common = 0;
    for i in 0..3 {
        if let Some(j) = (common..3).find(|&j| t[j] == s[i]) {
            s.swap(common, i);
            t.swap(common, j);
            common += 1;
        }
    }
    common
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether the triangles 0 1 2 and the given one of these points meet improperly.
    fn meet(points: &[P3], t: [u32; 3]) -> bool {
        let mesh = MeshData { points: points.to_vec(), ..MeshData::default() };
        let mut answers = Vec::new();
        // Beside a huge point that no triangle uses, none of the others is on the lattice.
        let mut alone = mesh.clone();
        alone.points.push([1.5e300; 3]);
        for mesh in [mesh, alone] {
            let space = Space::new(&mesh);
            for shift in 0..3 {
                let (mut s, mut u) = ([0, 1, 2], t);
                s.rotate_left(shift);
                answers.push(space.meet_improperly(s, u));
                answers.push(space.meet_improperly(u, s));
                u.swap(0, 2);
                answers.push(space.meet_improperly(s, u));
            }
        }
        assert!(answers.iter().all(|&a| a == answers[0]), "{answers:?}");
        answers[0]
    }

    const BASE: [P3; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    fn with(more: &[P3]) -> Vec<P3> {
        BASE.iter().chain(more).copied().collect()
    }

    #[test]
    fn triangles_without_common_corners() {
        let t = [3, 4, 5];
        let pierced = with(&[[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 0.5]]);
        assert!(meet(&pierced, t));
        let beside = with(&[[5.0, 5.0, -1.0], [5.0, 5.0, 1.0], [9.0, 9.0, 0.5]]);
        assert!(!meet(&beside, t));
        let touching = with(&[[1.0, 1.0, 0.0], [1.0, 2.0, 1.0], [2.0, 1.0, 1.0]]);
        assert!(meet(&touching, t));
        let above = with(&[[1.0, 1.0, 5e-324], [1.0, 2.0, 1.0], [2.0, 1.0, 1.0]]);
        assert!(!meet(&above, t));
        let edge_to_edge = with(&[[2.0, -1.0, 0.0], [2.0, 1.0, 0.0], [2.0, 0.0, 3.0]]);
        assert!(meet(&edge_to_edge, t));
    }

    #[test]
    fn triangles_in_one_plane() {
        let t = [3, 4, 5];
        let inside = with(&[[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 2.0, 0.0]]);
        assert!(meet(&inside, t));
        let around = with(&[[-9.0, -9.0, 0.0], [30.0, -9.0, 0.0], [-9.0, 30.0, 0.0]]);
        assert!(meet(&around, t));
        let beside = with(&[[4.0, 4.0, 0.0], [5.0, 4.0, 0.0], [4.0, 5.0, 0.0]]);
        assert!(!meet(&beside, t));
        let star = with(&[[3.0, 3.0, 0.0], [-1.0, 1.0, 0.0], [1.0, -1.0, 0.0]]);
        assert!(meet(&star, t));
        let corner_on_edge = with(&[[2.0, 2.0, 0.0], [5.0, 2.0, 0.0], [5.0, 5.0, 0.0]]);
        assert!(meet(&corner_on_edge, t));
        let upright = |p: &P3| [p[2], p[0], p[1]];
        assert!(meet(&inside.iter().map(upright).collect::<Vec<_>>(), t));
        assert!(!meet(&beside.iter().map(upright).collect::<Vec<_>>(), t));
    }

    #[test]
    fn triangles_with_a_common_corner() {
        let t = [0, 3, 4];
        assert!(!meet(&with(&[[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]), t));
        assert!(!meet(&with(&[[1.0, 1.0, 1.0], [1.0, 2.0, 1.0]]), t));
        assert!(meet(&with(&[[1.0, 1.0, 1.0], [1.0, 1.0, -1.0]]), t));
        assert!(meet(&with(&[[9.0, 9.0, 9.0], [9.0, 9.0, -9.0]]), t));
        assert!(meet(&with(&[[1.0, 1.0, 0.0], [1.0, 2.0, 1.0]]), t));
        assert!(meet(&with(&[[2.0, 1.0, 0.0], [1.0, 2.0, 0.0]]), t));
        assert!(meet(&with(&[[8.0, 0.0, 0.0], [8.0, -1.0, 0.0]]), t));
    }

    #[test]
    fn triangles_with_a_common_edge() {
        assert!(!meet(&with(&[[4.0, 4.0, 0.0]]), [1, 2, 3]));
        assert!(!meet(&with(&[[1.0, 1.0, 1e-300]]), [1, 2, 3]));
        assert!(meet(&with(&[[1.0, 1.0, 0.0]]), [1, 2, 3]));
        assert!(meet(&with(&[]), [1, 2, 0]));
    }
}
