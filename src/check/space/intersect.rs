//! Exact intersection of triangles in space, by signs of orient3d and, in a common plane, orient2d.
//!
//! Most triangles whose boxes meet are neighbours, and a line that separates their projections along
//! an axis proves at once that they do not meet improperly. Coordinates are rounded down to the lattice
//! for that, with a bound in integers on what this may change: a sign counts where it is certain.

use crate::check::exact::{self, P3, orient2d};
use crate::check::lattice::Lattice;
use crate::check::ldexp;
use crate::check::wide::Int256;
use crate::mesh::MeshData;
use crate::vector::{cross, sub};
use rayon::prelude::*;
use std::cmp::Ordering::{self, Equal, Greater, Less};

/// Coordinates of a mesh in space, and the exact predicates on its points by index.
pub(super) struct Space<'a> {
    mesh: &'a MeshData,
    lattice: Lattice<3>,
    /// Coordinates in units of the lattice, towards 0: each is less than 1 off, and below 2^61.
    rounded: Vec<[i64; 3]>,
}

/// No determinant of two rows of rounded coordinates is farther from the true one. Differences, true
/// or rounded, are below 2^62 and 2 apart: |a b - a' b'| <= |a| |b - b'| + |b'| |a - a'| < 2^64, twice.
const OFF_IN_PLANE: i128 = 1 << 65;
/// The root of the same for three rows: six products are each off by at most
/// (m + 2)^3 - m^3 = 6 m^2 + 12 m + 8 for differences up to m < 2^62, together less than 2^130.
const OFF_IN_SPACE_ROOT: i128 = 1 << 65;

/// Triangles per piece of parallel work.
const CHUNK: usize = 1 << 14;

impl<'a> Space<'a> {
    pub(super) fn new(mesh: &'a MeshData) -> Self {
        let lattice = Lattice::of(&mesh.points);
        #[expect(clippy::cast_possible_truncation, reason = "this is how it is rounded")]
        let round = |p: &P3| p.map(|x| ldexp(x, -lattice.exponent) as i64);
        let rounded = mesh.points.par_iter().with_min_len(CHUNK).map(round).collect();
        Self { mesh, lattice, rounded }
    }

    /// The sign of the area of a triangle's projection along an axis, if that is certain from rounded
    /// coordinates; else `Equal`.
    #[inline]
    fn clear_turn(&self, axis: usize, corners: [u32; 3]) -> Ordering {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        clear_turn_of(corners.map(|v| {
            let p = &self.rounded[v as usize];
            [p[i], p[j]]
        }))
    }

    /// The sign of orient3d, if it is certain from rounded coordinates; else `Equal`.
    fn clear_orient(&self, corners: [u32; 4]) -> Ordering {
        let [a, b, c, d] = corners.map(|v| self.rounded[v as usize]);
        let determinant = exact::determinant_narrow([0, 1, 2].map(|k| [a[k], b[k], c[k], d[k]]));
        let off = Int256::product(OFF_IN_SPACE_ROOT, OFF_IN_SPACE_ROOT);
        match (determinant.minus(off).sign(), determinant.plus(off).sign()) {
            (Greater, _) => Greater,
            (_, Less) => Less,
            _ => Equal,
        }
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
            None => self.clear_orient(corners).then_with(|| {
                let [a, b, c, d] = corners.map(|v| self.point(v));
                exact::orient3d(a, b, c, d)
            }),
        }
    }

    /// The sign of the area of a triangle's projection along an axis.
    fn orient_along(&self, axis: usize, corners: [u32; 3]) -> Ordering {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        match self.lattice.points(corners) {
            Some([a, b, c]) => exact::determinant([a[i], b[i], c[i]], [a[j], b[j], c[j]]).cmp(&0),
            None => self.clear_turn(axis, corners).then_with(|| {
                let [a, b, c] = corners.map(|v| self.point(v)).map(|p| [p[i], p[j]]);
                orient2d(a, b, c)
            }),
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

    /// Whether two triangles with area meet in more than their common corners and edge; they are looked
    /// at along `axis` first.
    pub(super) fn meet_improperly(&self, axis: usize, mut s: [u32; 3], mut t: [u32; 3]) -> bool {
        let common = bring_common_first(&mut s, &mut t);
        if self.are_beside(axis, (s, t), common) {
            return false;
        }
        match common {
            0 => self.disjoint_corners_meet(s, t),
            1 => self.meet_beyond_corner(s, t),
            2 => self.overlap_along_edge(s, t),
            _ => true,
        }
    }

    /// The axis along which a triangle's projection is largest, up to rounding.
    pub(super) fn facing_axis(&self, corners: [u32; 3]) -> usize {
        let [a, b, c] = corners.map(|v| self.point(v));
        let normal = cross(sub(b, a), sub(c, a)).map(f64::abs);
        let larger = usize::from(normal[1] > normal[0]);
        if normal[2] > normal[larger] { 2 } else { larger }
    }

    /// Whether the projections of two triangles along an axis show that they meet in their common
    /// corners, the first of both, alone: a line has all other corners of one strictly on one side,
    /// and no corner of the other on that side. It runs along an edge of one of them, through the
    /// common corners. The plane above it meets the first triangle in the common corners or edge.
    fn are_beside(&self, axis: usize, (s, t): ([u32; 3], [u32; 3]), common: usize) -> bool {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let projected = |v: u32| {
            let p = &self.rounded[v as usize];
            [p[i], p[j]]
        };
        let (s, t) = (s.map(projected), t.map(projected));
        let parts = |line: [[i64; 2]; 2], own: [i64; 2], others: &[[i64; 2]]| {
            let side = clear_turn_of([line[0], line[1], own]).reverse();
            let is_across = |&p: &[i64; 2]| clear_turn_of([line[0], line[1], p]) == side;
            side.is_ne() && others.iter().all(is_across)
        };
        match common {
            0 => [(s, t), (t, s)]
                .iter()
                .any(|(s, t)| (0..3).any(|i| parts([s[i], s[(i + 1) % 3]], s[(i + 2) % 3], t))),
            1 => {
                parts([s[0], s[1]], s[2], &t[1..])
                    || parts([s[0], s[2]], s[1], &t[1..])
                    || parts([t[0], t[1]], t[2], &s[1..])
                    || parts([t[0], t[2]], t[1], &s[1..])
            }
            2 => parts([s[0], s[1]], s[2], &t[2..]),
            _ => false,
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

/// The sign of the area of a triangle of rounded coordinates, if it is certain; else `Equal`.
#[inline]
fn clear_turn_of([a, b, c]: [[i64; 2]; 3]) -> Ordering {
    match exact::determinant([a[0], b[0], c[0]], [a[1], b[1], c[1]]) {
        d if d > OFF_IN_PLANE => Greater,
        d if d < -OFF_IN_PLANE => Less,
        _ => Equal,
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
                for axis in 0..3 {
                    answers.push(space.meet_improperly(axis, s, u));
                    answers.push(space.meet_improperly(axis, u, s));
                }
                u.swap(0, 2);
                answers.push(space.meet_improperly(space.facing_axis(s), s, u));
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

    // spec: C71
    #[test]
    fn rounded_signs_are_right_where_they_are_certain() {
        // Coordinates with bits far below the lattice, flat and nearly flat triangles among them.
        let step = |k: u32| f64::from(k.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24);
        let tiny = |k: u32| 1e-24 * step(k);
        let points: Vec<P3> = (0..400)
            .map(|k| {
                let (x, y) = (step(3 * k), step(3 * k + 1));
                let z = if k % 3 == 0 { x + y } else { step(3 * k + 2) };
                [x + tiny(k), y - tiny(k + 7), z + tiny(k + 3)]
            })
            .chain((0..40).map(|k| [f64::from(k % 5) + tiny(k), f64::from(k / 5), tiny(k + 1)]))
            .collect();
        let mesh = MeshData { points, ..MeshData::default() };
        let space = Space::new(&mesh);
        let (mut clear, mut unclear) = (0, 0);
        for k in 0..4000_u32 {
            let pick = |i: u32| (k.wrapping_mul(31).wrapping_add(i * 97 + i * i * k)) % 440;
            let corners = [pick(0), pick(1), pick(2), pick(3)];
            let [a, b, c, d] = corners.map(|v| space.point(v));
            let rounded = space.clear_orient(corners);
            assert!(rounded.is_eq() || rounded == exact::orient3d(a, b, c, d), "{corners:?}");
            (clear, unclear) =
                (clear + u32::from(rounded.is_ne()), unclear + u32::from(rounded.is_eq()));
            for axis in 0..3 {
                let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
                let turn = space.clear_turn(axis, [corners[0], corners[1], corners[2]]);
                let [a, b, c] = [a, b, c].map(|p| [p[i], p[j]]);
                assert!(turn.is_eq() || turn == orient2d(a, b, c), "{corners:?} {axis}");
            }
        }
        assert!(clear > 1000 && unclear > 10, "{clear} {unclear}");
    }

    // spec: C71
    #[test]
    fn beside_in_a_projection_is_beside() {
        let step = |k: u32| f64::from(k.wrapping_mul(2_654_435_761) >> 20) / 256.0;
        let points: Vec<P3> = (0..60).map(|k| [0, 1, 2].map(|i| step(3 * k + i))).collect();
        let mesh = MeshData { points, ..MeshData::default() };
        let space = Space::new(&mesh);
        let (mut beside, mut meeting) = (0, 0);
        for k in 0..6000_u32 {
            let pick = |i: u32| (k.wrapping_mul(17).wrapping_add(i * 23 + i * i * k)) % 60;
            let (mut s, mut t) = ([pick(0), pick(1), pick(2)], [pick(3), pick(4), pick(5)]);
            // One common corner in every third pair, two in every third.
            t[..(k % 3) as usize].copy_from_slice(&s[..(k % 3) as usize]);
            let differ = |t: [u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
            if !differ(s) || !differ(t) {
                continue;
            }
            let common = bring_common_first(&mut s, &mut t);
            let truth = match common {
                0 => space.disjoint_corners_meet(s, t),
                1 => space.meet_beyond_corner(s, t),
                2 => space.overlap_along_edge(s, t),
                _ => continue,
            };
            let shown = (0..3).any(|axis| space.are_beside(axis, (s, t), common));
            assert!(!(shown && truth), "{s:?} {t:?}");
            (beside, meeting) = (beside + u32::from(shown), meeting + u32::from(truth));
        }
        assert!(beside > 1000 && meeting > 200, "{beside} {meeting}");
    }

    #[test]
    fn triangles_with_a_common_edge() {
        assert!(!meet(&with(&[[4.0, 4.0, 0.0]]), [1, 2, 3]));
        assert!(!meet(&with(&[[1.0, 1.0, 1e-300]]), [1, 2, 3]));
        assert!(meet(&with(&[[1.0, 1.0, 0.0]]), [1, 2, 3]));
        assert!(meet(&with(&[]), [1, 2, 0]));
    }
}
