//! A binary tree of boxes over items of the plane, for the smallest of a function that grows with
//! distance: nearest triangles, sources that spread.

use crate::point::Point2;

/// The tree; items are in its order, which depends on coordinates only.
#[derive(Debug)]
pub(super) struct Boxes<T> {
    items: Vec<T>,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: Point2,
    high: Point2,
    /// Smallest of the items' own values.
    least: f64,
    /// Leaf: first item and count. Inner: index of the second child (the first follows) and 0.
    first: u32,
    count: u32,
}

const LEAF_ITEMS: usize = 4;

/// What the tree needs to know of an item.
pub(super) trait Boxed {
    /// Lower left and upper right corner.
    fn bounds(&self) -> [Point2; 2];
    /// A value below which the item's value is nowhere.
    fn least(&self) -> f64;
}

impl<T: Boxed> Boxes<T> {
    /// Builds the tree in O(n log^2 n).
    pub(super) fn new(items: Vec<T>) -> Self {
        let count = items.len();
        let mut tree = Self { items, nodes: Vec::new() };
        if count > 0 {
            tree.build(0, count);
        }
        tree
    }

    fn build(&mut self, start: usize, end: usize) {
        let index = self.nodes.len();
        let (low, high, least) = whole(&self.items[start..end]);
        let count = (end - start) as u32;
        self.nodes.push(Node { low, high, least, first: start as u32, count });
        if end - start <= LEAF_ITEMS {
            return;
        }
        let by_x = high.x - low.x >= high.y - low.y;
        self.items[start..end].sort_by(|s, t| {
            let key = |item: &T| {
                let [low, high] = item.bounds();
                let middle = [0.5 * low.x + 0.5 * high.x, 0.5 * low.y + 0.5 * high.y];
                if by_x { middle } else { [middle[1], middle[0]] }
            };
            let (s, t) = (key(s), key(t));
            s[0].total_cmp(&t[0]).then(s[1].total_cmp(&t[1]))
        });
        let middle = start + (end - start) / 2;
        self.build(start, middle);
        let second = self.nodes.len() as u32;
        self.build(middle, end);
        self.nodes[index] = Node { low, high, least, first: second, count: 0 };
    }

    /// The smallest `value` of an item, where no item's value is below `slope` times its distance
    /// from `p` plus its least; `None` without items. Ties go to the first in tree order.
    pub(super) fn smallest(
        &self,
        p: Point2,
        slope: f64,
        mut value: impl FnMut(&T) -> f64,
    ) -> Option<(&T, f64)> {
        let mut best: Option<(usize, f64)> = None;
        let bound = |node: &Node| node.least + slope * distance(node, p);
        // The tree halves its items: 2^32 of them are 32 levels, with one waiting sibling each.
        let mut stack = [0_u32; 40];
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let index = stack[depth] as usize;
            let node = &self.nodes[index];
            if best.is_some_and(|(_, least)| bound(node) >= least) {
                continue;
            }
            if node.count == 0 {
                let (first, second) = (index as u32 + 1, node.first);
                let is_nearer =
                    bound(&self.nodes[first as usize]) <= bound(&self.nodes[second as usize]);
                let (near, far) = if is_nearer { (first, second) } else { (second, first) };
                (stack[depth], stack[depth + 1]) = (far, near);
                depth += 2;
                continue;
            }
            for i in node.first as usize..(node.first + node.count) as usize {
                let value = value(&self.items[i]);
                if best.is_none_or(|(_, least)| value < least) {
                    best = Some((i, value));
                }
            }
        }
        best.map(|(i, value)| (&self.items[i], value))
    }
}

fn whole<T: Boxed>(items: &[T]) -> (Point2, Point2, f64) {
    let [mut low, mut high] = items[0].bounds();
    let mut least = f64::INFINITY;
    for item in items {
        let [l, h] = item.bounds();
        low = Point2::new(low.x.min(l.x), low.y.min(l.y));
        high = Point2::new(high.x.max(h.x), high.y.max(h.y));
        least = least.min(item.least());
    }
    (low, high, least)
}

fn distance(node: &Node, p: Point2) -> f64 {
    let dx = (node.low.x - p.x).max(p.x - node.high.x).max(0.0);
    let dy = (node.low.y - p.y).max(p.y - node.high.y).max(0.0);
    (dx * dx + dy * dy).sqrt()
}

/// The point of a segment nearest to `p`, as a fraction of the way from `a` to `b`.
pub(super) fn nearest_on_segment([a, b]: [Point2; 2], p: Point2) -> f64 {
    let (ux, uy) = (b.x - a.x, b.y - a.y);
    let length_sq = ux * ux + uy * uy;
    if length_sq > 0.0 {
        (((p.x - a.x) * ux + (p.y - a.y) * uy) / length_sq).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// The point at a fraction of the way from `a` to `b`.
pub(super) fn between([a, b]: [Point2; 2], t: f64) -> Point2 {
    Point2::new((1.0 - t) * a.x + t * b.x, (1.0 - t) * a.y + t * b.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Dot(Point2, f64);

    impl Boxed for Dot {
        fn bounds(&self) -> [Point2; 2] {
            [self.0, self.0]
        }
        fn least(&self) -> f64 {
            self.1
        }
    }

    fn dots() -> Vec<Dot> {
        let at = |k: u32| f64::from((k * 7919) % 1009) / 100.0;
        (0..300).map(|k| Dot(Point2::new(at(k), at(k + 500)), at(k + 37) / 10.0)).collect()
    }

    #[test]
    fn the_tree_agrees_with_a_linear_search() {
        let (tree, all) = (Boxes::new(dots()), dots());
        for k in 0..400 {
            let p = Point2::new(f64::from(k % 20), f64::from(k / 20) - 5.0);
            for slope in [0.0, 0.3, 1.0] {
                let value = |dot: &Dot| dot.1 + slope * dot.0.distance(p);
                let linear = all.iter().map(value).fold(f64::INFINITY, f64::min);
                assert_eq!(tree.smallest(p, slope, value).map(|(_, v)| v), Some(linear), "{p}");
            }
        }
    }

    #[test]
    fn nothing_has_no_smallest() {
        let empty = Boxes::<Dot>::new(Vec::new());
        assert!(empty.smallest(Point2::new(0.0, 0.0), 1.0, |_| 0.0).is_none());
    }

    #[test]
    fn ten_thousand_equal_items_end() {
        let heap = (0..10_000).map(|_| Dot(Point2::new(1.0, 1.0), 2.0)).collect();
        let tree = Boxes::<Dot>::new(heap);
        let p = Point2::new(4.0, 5.0);
        assert_eq!(tree.smallest(p, 1.0, |dot| dot.1 + dot.0.distance(p)).unwrap().1, 7.0);
    }

    #[test]
    fn a_segment_without_length_is_its_point() {
        let p = Point2::new(1.0, 2.0);
        assert_eq!(nearest_on_segment([p, p], Point2::new(5.0, 5.0)), 0.0);
        assert_eq!(between([p, p], 0.0), p);
    }
}
