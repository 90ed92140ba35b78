//! A tree of boxes around triangles, for the nearest point of a triangulated surface.

use crate::vector::{Vector, along, dot, norm_sq, sub};

/// Triangles in a binary tree of boxes, in flat arrays.
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// Triangles in the order of the leaves.
    order: Vec<u32>,
}

/// A box; a leaf with triangles `first .. first + count`, or an inner node (`count` 0) whose
/// children are the next node and `first`.
#[derive(Clone, Copy)]
struct Node {
    low: Vector,
    high: Vector,
    first: u32,
    count: u32,
}

/// Leaves have at most this many triangles.
const LEAF: usize = 4;

/// The nearest point of some triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Nearest {
    pub(super) triangle: u32,
    pub(super) point: Vector,
    pub(super) distance_sq: f64,
}

/// The triangles of a surface as the tree sees them.
#[derive(Clone, Copy)]
pub(super) struct Corners<'a> {
    pub(super) points: &'a [Vector],
    pub(super) triangles: &'a [[u32; 3]],
}

impl Corners<'_> {
    pub(super) fn of(self, t: u32) -> [Vector; 3] {
        self.triangles[t as usize].map(|v| self.points[v as usize])
    }
}

impl Tree {
    /// Builds the tree in O(n log n).
    pub(super) fn new(corners: Corners<'_>) -> Self {
        let count = corners.triangles.len();
        let mut items: Vec<(Vector, u32)> = (0..count as u32)
            .map(|t| {
                let [a, b, c] = corners.of(t);
                (std::array::from_fn(|i| a[i] + b[i] + c[i]), t)
            })
            .collect();
        let mut tree = Self { nodes: Vec::new(), order: Vec::with_capacity(count) };
        if count > 0 {
            tree.build(&mut items, corners);
        }
        tree
    }

    fn build(&mut self, items: &mut [(Vector, u32)], corners: Corners<'_>) {
        let (low, high) = bounds(items.iter().flat_map(|&(_, t)| corners.of(t)));
        let index = self.nodes.len();
        let (first, count) = (self.order.len() as u32, items.len() as u32);
        self.nodes.push(Node { low, high, first, count });
        if items.len() <= LEAF {
            self.order.extend(items.iter().map(|&(_, t)| t));
            return;
        }
        let (from, to) = bounds(items.iter().map(|&(centre, _)| centre));
        let extent = sub(to, from);
        let axis = (0..3).fold(0, |best, i| if extent[i] > extent[best] { i } else { best });
        let middle = items.len() / 2;
        items.select_nth_unstable_by(middle, |a, b| {
            a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1))
        });
        let (left, right) = items.split_at_mut(middle);
        self.build(left, corners);
        let second = self.nodes.len() as u32;
        self.build(right, corners);
        self.nodes[index] = Node { low, high, first: second, count: 0 };
    }

    /// The nearest point to `p` of the triangles that `is_wanted`; `seed` is a triangle to start
    /// with, which must be wanted.
    pub(super) fn nearest(
        &self,
        corners: Corners<'_>,
        p: Vector,
        seed: Option<u32>,
        is_wanted: impl Fn(u32) -> bool,
    ) -> Option<Nearest> {
        let mut best = seed.map(|t| on_triangle(corners, t, p));
        let mut stack: Vec<(f64, u32)> = Vec::with_capacity(64);
        if !self.nodes.is_empty() {
            stack.push((0.0, 0));
        }
        while let Some((away, index)) = stack.pop() {
            if best.is_some_and(|b| away >= b.distance_sq) {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                let leaf = &self.order[node.first as usize..(node.first + node.count) as usize];
                for &t in leaf.iter().filter(|&&t| is_wanted(t)) {
                    let found = on_triangle(corners, t, p);
                    if best.is_none_or(|b| found.distance_sq < b.distance_sq) {
                        best = Some(found);
                    }
                }
                continue;
            }
            let [near, far] = [index + 1, node.first].map(|i| (self.nodes[i as usize].away(p), i));
            let (near, far) = if far.0 < near.0 { (far, near) } else { (near, far) };
            stack.push(far);
            stack.push(near);
        }
        best
    }
}

impl Node {
    /// Squared distance of `p` from the box.
    fn away(&self, p: Vector) -> f64 {
        (0..3).map(|i| (self.low[i] - p[i]).max(p[i] - self.high[i]).max(0.0).powi(2)).sum()
    }
}

fn bounds(points: impl Iterator<Item = Vector>) -> (Vector, Vector) {
    points.fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), |(low, high), p| {
        (
            std::array::from_fn(|i| f64::min(low[i], p[i])),
            std::array::from_fn(|i| f64::max(high[i], p[i])),
        )
    })
}

fn on_triangle(corners: Corners<'_>, triangle: u32, p: Vector) -> Nearest {
    let point = nearest_on_triangle(corners.of(triangle), p);
    Nearest { triangle, point, distance_sq: norm_sq(sub(p, point)) }
}

/// The point of a triangle nearest to `p` (C. Ericson, Real-Time Collision Detection, 2005, 5.1.5).
fn nearest_on_triangle([a, b, c]: [Vector; 3], p: Vector) -> Vector {
    let (ab, ac) = (sub(b, a), sub(c, a));
    let (d1, d2) = (dot(ab, sub(p, a)), dot(ac, sub(p, a)));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (dot(ab, sub(p, b)), dot(ac, sub(p, b)));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3 {
        return along(a, d1 / (d1 - d3), ab);
    }
    let (d5, d6) = (dot(ab, sub(p, c)), dot(ac, sub(p, c)));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6 {
        return along(a, d2 / (d2 - d6), ac);
    }
    let va = d3 * d6 - d5 * d4;
    let (up, down) = (d4 - d3, d5 - d6);
    if va <= 0.0 && up >= 0.0 && down >= 0.0 && up + down > 0.0 {
        return along(b, up / (up + down), sub(c, b));
    }
    let sum = va + vb + vc;
    if sum > 0.0 { along(along(a, vb / sum, ab), vc / sum, ac) } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{distance, segment_distance_sq};

    fn step(k: u32, m: u32) -> f64 {
        f64::from(k.wrapping_mul(2_654_435_761) % m) / f64::from(m)
    }

    fn soup() -> (Vec<Vector>, Vec<[u32; 3]>) {
        let points: Vec<Vector> =
            (0..300).map(|k| [step(k, 97), step(k, 89), step(k, 83)]).collect();
        let near = |k: u32| [k, (k + 97) % 300, (k + 5) % 300];
        (points, (0..200).map(near).collect())
    }

    // spec: U4
    #[test]
    fn the_nearest_point_is_that_of_a_linear_search() {
        let (points, triangles) = soup();
        let corners = Corners { points: &points, triangles: &triangles };
        let tree = Tree::new(corners);
        for k in 0..200 {
            let p = [1.4 * step(k, 31) - 0.2, step(k, 37), 1.2 * step(k, 41)];
            let is_wanted = |t: u32| t % 3 != 1;
            let all = (0..200_u32).filter(|&t| is_wanted(t)).map(|t| on_triangle(corners, t, p));
            let least = all.map(|n| n.distance_sq).fold(f64::INFINITY, f64::min);
            for seed in [None, Some(3 * (k % 60))] {
                let found = tree.nearest(corners, p, seed, is_wanted).expect("some triangle");
                assert_eq!(found.distance_sq, least);
                assert!(is_wanted(found.triangle));
            }
        }
        assert_eq!(tree.nearest(corners, [0.0; 3], None, |_| false), None);
        let none = Corners { points: &[], triangles: &[] };
        assert_eq!(Tree::new(none).nearest(none, [0.0; 3], None, |_| true), None);
    }

    // spec: U4
    #[test]
    fn the_nearest_point_of_a_triangle_is_on_it_and_no_side_is_nearer() {
        let triangle = [[0.1, 0.0, 0.3], [1.0, 0.2, 0.0], [0.3, 0.9, 0.5]];
        let [a, b, c] = triangle;
        for k in 0..500 {
            let p = [3.0 * step(k, 31) - 1.0, 3.0 * step(k, 37) - 1.0, 3.0 * step(k, 41) - 1.0];
            let q = nearest_on_triangle(triangle, p);
            let away = distance(p, q);
            for (x, y) in [(a, b), (b, c), (c, a)] {
                assert!(away <= segment_distance_sq(x, y, p).sqrt() + 1e-12);
            }
            // The nearest point of a triangle is its own nearest point.
            assert!(distance(nearest_on_triangle(triangle, q), q) < 1e-12);
        }
        assert_eq!(nearest_on_triangle([a, a, a], [5.0; 3]), a, "a triangle of one point");
    }
}
