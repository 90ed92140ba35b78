//! Direct grading (section 3.4 of the report): the nearest edge of the initial front, at distance
//! D1 and of length L1, and the edge that its normal through the point hits on the other side, at
//! distance D2 and of length L2, give L = (D1 L2 + D2 L1) / (D1 + D2).

use crate::point::Point2;

/// Direct grading between the edges of the initial front.
///
/// A binary tree of boxes over the edges answers both searches in logarithmic time on ordinary
/// boundaries; the report's own description is linear for each.
#[derive(Debug)]
pub struct DirectField {
    /// Edges in tree order, each with the domain on its left.
    edges: Vec<[Point2; 2]>,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: Point2,
    high: Point2,
    /// Leaf: first edge and count. Inner: index of the second child (the first follows) and 0.
    first: u32,
    count: u32,
}

const LEAF_EDGES: usize = 4;

impl DirectField {
    /// Builds the tree over the edges of the initial front; `edges` must not be empty.
    ///
    /// # Panics
    /// When there is no edge.
    #[must_use]
    pub fn new(edges: Vec<[Point2; 2]>) -> Self {
        assert!(!edges.is_empty(), "direct grading needs an initial front");
        let count = edges.len();
        let mut field = Self { edges, nodes: Vec::with_capacity(count) };
        field.build(0, count);
        field
    }

    /// The spacing at `p`: positive and finite.
    #[must_use]
    pub fn at(&self, p: Point2) -> f64 {
        match self.edges_at(p) {
            ((d1, l1), Some((d2, l2))) if d1 + d2 > 0.0 => (d1 * l2 + d2 * l1) / (d1 + d2),
            ((_, l1), _) => l1,
        }
    }

    /// Distance and length of the nearest edge, and of the edge opposite, if the normal hits one.
    #[must_use]
    pub fn edges_at(&self, p: Point2) -> ((f64, f64), Option<(f64, f64)>) {
        let (nearest, foot, d1) = self.nearest(p);
        let [a, b] = self.edges[nearest];
        let away = if d1 > 0.0 {
            Point2::new(p.x - foot.x, p.y - foot.y)
        } else {
            Point2::new(a.y - b.y, b.x - a.x)
        };
        let opposite = self.hit(p, away, nearest);
        let opposite = opposite.map(|(edge, d2)| (d2, length(self.edges[edge])));
        ((d1, length(self.edges[nearest])), opposite)
    }

    fn build(&mut self, start: usize, end: usize) {
        let index = self.nodes.len();
        let (low, high) = bounds(&self.edges[start..end]);
        self.nodes.push(Node { low, high, first: start as u32, count: (end - start) as u32 });
        if end - start <= LEAF_EDGES {
            return;
        }
        let by_x = high.x - low.x >= high.y - low.y;
        let key = |e: &[Point2; 2]| if by_x { e[0].x + e[1].x } else { e[0].y + e[1].y };
        let tie = |e: &[Point2; 2], f: &[Point2; 2]| {
            key(e)
                .total_cmp(&key(f))
                .then_with(|| e[0].lexicographic(f[0]))
                .then_with(|| e[1].lexicographic(f[1]))
        };
        self.edges[start..end].sort_unstable_by(tie);
        let middle = start + (end - start) / 2;
        self.build(start, middle);
        let second = self.nodes.len() as u32;
        self.build(middle, end);
        self.nodes[index] = Node { low, high, first: second, count: 0 };
    }

    /// Index of the nearest edge (the first in tree order among equals), its foot point, distance.
    fn nearest(&self, p: Point2) -> (usize, Point2, f64) {
        let mut best = (0, foot(self.edges[0], p), f64::INFINITY);
        let mut stack = vec![0u32];
        while let Some(index) = stack.pop() {
            let node = self.nodes[index as usize];
            if box_distance(&node, p) >= best.2 {
                continue;
            }
            if node.count == 0 {
                let (near, far) = self.children_by(index, |n| box_distance(n, p));
                stack.extend([far, near]);
                continue;
            }
            for i in node.first as usize..(node.first + node.count) as usize {
                let foot = foot(self.edges[i], p);
                let distance = foot.distance(p);
                if distance < best.2 {
                    best = (i, foot, distance);
                }
            }
        }
        best
    }

    /// The first edge that the ray from `p` hits, other than `skip`, and its distance.
    fn hit(&self, p: Point2, direction: Point2, skip: usize) -> Option<(usize, f64)> {
        let norm = direction.distance(Point2::new(0.0, 0.0));
        let ray = Point2::new(direction.x / norm, direction.y / norm);
        let mut best: Option<(usize, f64)> = None;
        let mut stack = vec![0u32];
        while let Some(index) = stack.pop() {
            let node = self.nodes[index as usize];
            let limit = best.map_or(f64::INFINITY, |(_, d)| d);
            if box_entry(&node, p, ray) > limit {
                continue;
            }
            if node.count == 0 {
                let (near, far) = self.children_by(index, |n| box_entry(n, p, ray));
                stack.extend([far, near]);
                continue;
            }
            for i in node.first as usize..(node.first + node.count) as usize {
                if i != skip
                    && let Some(distance) = ray_hit(self.edges[i], p, ray)
                    && best.is_none_or(|(_, d)| distance < d)
                {
                    best = Some((i, distance));
                }
            }
        }
        best
    }

    fn children_by(&self, index: u32, key: impl Fn(&Node) -> f64) -> (u32, u32) {
        let (first, second) = (index + 1, self.nodes[index as usize].first);
        if key(&self.nodes[first as usize]) <= key(&self.nodes[second as usize]) {
            (first, second)
        } else {
            (second, first)
        }
    }
}

fn length([a, b]: [Point2; 2]) -> f64 {
    a.distance(b)
}

fn bounds(edges: &[[Point2; 2]]) -> (Point2, Point2) {
    let (mut low, mut high) = (edges[0][0], edges[0][0]);
    for p in edges.iter().flatten() {
        low = Point2::new(low.x.min(p.x), low.y.min(p.y));
        high = Point2::new(high.x.max(p.x), high.y.max(p.y));
    }
    (low, high)
}

fn foot([a, b]: [Point2; 2], p: Point2) -> Point2 {
    let (ux, uy) = (b.x - a.x, b.y - a.y);
    let t = ((p.x - a.x) * ux + (p.y - a.y) * uy) / (ux * ux + uy * uy);
    let t = t.clamp(0.0, 1.0);
    Point2::new(a.x + t * ux, a.y + t * uy)
}

fn box_distance(node: &Node, p: Point2) -> f64 {
    let dx = (node.low.x - p.x).max(p.x - node.high.x).max(0.0);
    let dy = (node.low.y - p.y).max(p.y - node.high.y).max(0.0);
    (dx * dx + dy * dy).sqrt()
}

/// Distance along the ray to the box, infinite when it misses.
fn box_entry(node: &Node, p: Point2, ray: Point2) -> f64 {
    let slab = |low: f64, high: f64, at: f64, speed: f64| {
        if speed == 0.0 {
            let inside = low <= at && at <= high;
            return if inside { (0.0, f64::INFINITY) } else { (f64::INFINITY, 0.0) };
        }
        let (s, t) = ((low - at) / speed, (high - at) / speed);
        (s.min(t), s.max(t))
    };
    let (x_in, x_out) = slab(node.low.x, node.high.x, p.x, ray.x);
    let (y_in, y_out) = slab(node.low.y, node.high.y, p.y, ray.y);
    let entry = x_in.max(y_in).max(0.0);
    if entry <= x_out.min(y_out) { entry } else { f64::INFINITY }
}

/// Distance along the unit ray to the segment.
fn ray_hit([a, b]: [Point2; 2], p: Point2, ray: Point2) -> Option<f64> {
    let (ux, uy) = (b.x - a.x, b.y - a.y);
    let denominator = ray.x * uy - ray.y * ux;
    let (wx, wy) = (a.x - p.x, a.y - p.y);
    let along = (wx * uy - wy * ux) / denominator;
    let across = (wx * ray.y - wy * ray.x) / denominator;
    (along > 0.0 && (0.0..=1.0).contains(&across)).then_some(along)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel() -> DirectField {
        // Floor of edges of length 1 at y = 0, ceiling of edges of length 3 at y = 4.
        let p = Point2::new;
        let floor = (0..9).map(|i| [p(f64::from(i), 0.0), p(f64::from(i + 1), 0.0)]);
        let ceiling = (0..3).map(|i| [p(f64::from(3 * i + 3), 4.0), p(f64::from(3 * i), 4.0)]);
        DirectField::new(floor.chain(ceiling).collect())
    }

    // spec: H4
    #[test]
    fn between_two_walls_the_length_is_weighted_by_the_other_distance() {
        let field = channel();
        for (y, wanted) in [(1.0, 1.5), (2.0, 2.0), (3.0, 2.5)] {
            assert!((field.at(Point2::new(4.5, y)) - wanted).abs() < 1e-12, "at height {y}");
        }
    }

    // spec: H4
    #[test]
    fn a_point_on_the_wall_has_the_wall_s_length() {
        assert_eq!(channel().at(Point2::new(4.5, 0.0)), 1.0);
    }

    // spec: H4
    #[test]
    fn without_an_opposite_edge_the_nearest_decides() {
        let one = DirectField::new(vec![[Point2::new(0.0, 0.0), Point2::new(2.0, 0.0)]]);
        assert_eq!(one.at(Point2::new(1.0, 5.0)), 2.0);
    }

    // spec: H4
    #[test]
    fn the_tree_agrees_with_a_linear_search() {
        let edges: Vec<[Point2; 2]> = (0..200)
            .map(|i| {
                let at = |k: u32| {
                    let angle = f64::from(k % 200) * std::f64::consts::TAU / 200.0;
                    let radius = 2.0 + libm::sin(7.0 * angle);
                    Point2::new(radius * libm::cos(angle), radius * libm::sin(angle))
                };
                [at(i), at(i + 1)]
            })
            .collect();
        let field = DirectField::new(edges.clone());
        for k in 0..500 {
            let p = Point2::new(f64::from(k % 25) / 20.0 - 0.6, f64::from(k / 25) / 20.0 - 0.5);
            let linear =
                edges.iter().map(|&e| foot(e, p).distance(p)).fold(f64::INFINITY, f64::min);
            assert_eq!(field.nearest(p).2, linear, "{p}");
        }
    }
}
