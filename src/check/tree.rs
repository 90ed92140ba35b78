//! A tree of boxes, to find those that meet a given box.
//!
//! Median splits along the widest axis (a k-d tree over the boxes' middles); comparisons of floats
//! are exact, so no item is missed. O(n log n) to build.

/// A closed box: lower and upper corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds<const D: usize> {
    pub(super) low: [f64; D],
    pub(super) high: [f64; D],
}

impl<const D: usize> Bounds<D> {
    pub(super) const EMPTY: Self = Self { low: [f64::INFINITY; D], high: [f64::NEG_INFINITY; D] };

    /// The smallest box around points.
    pub(super) fn around(points: impl IntoIterator<Item = [f64; D]>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.and(&Self { low: p, high: p }))
    }

    fn and(&self, other: &Self) -> Self {
        Self {
            low: std::array::from_fn(|k| self.low[k].min(other.low[k])),
            high: std::array::from_fn(|k| self.high[k].max(other.high[k])),
        }
    }

    pub(super) fn meets(&self, other: &Self) -> bool {
        (0..D).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }
}

/// Items per leaf.
const LEAF: usize = 4;

struct Node<const D: usize> {
    bounds: Bounds<D>,
    from: u32,
    to: u32,
    /// The right child; the left one follows directly. 0 for a leaf.
    right: u32,
}

/// Boxes by place.
pub(super) struct Tree<const D: usize> {
    items: Vec<(Bounds<D>, u32)>,
    nodes: Vec<Node<D>>,
}

impl<const D: usize> Tree<D> {
    /// Builds the tree; items are numbered in the order given.
    pub(super) fn new(boxes: impl Iterator<Item = Bounds<D>>) -> Self {
        let mut tree = Self { items: boxes.zip(0u32..).collect(), nodes: Vec::new() };
        let count = tree.items.len();
        if count > 0 {
            tree.build(0, count);
        }
        tree
    }

    fn build(&mut self, from: usize, to: usize) -> u32 {
        let items = &mut self.items[from..to];
        let bounds = items.iter().fold(Bounds::EMPTY, |b, item| b.and(&item.0));
        let node = self.nodes.len() as u32;
        self.nodes.push(Node { bounds, from: from as u32, to: to as u32, right: 0 });
        if items.len() > LEAF {
            // Halving first keeps the widths of huge boxes finite.
            let width = |k: usize| bounds.high[k] / 2.0 - bounds.low[k] / 2.0;
            let axis = (1..D).fold(0, |best, k| if width(k) > width(best) { k } else { best });
            let middle = |b: &Bounds<D>| b.low[axis] / 2.0 + b.high[axis] / 2.0;
            let half = items.len() / 2;
            items.select_nth_unstable_by(half, |a, b| {
                middle(&a.0).total_cmp(&middle(&b.0)).then(a.1.cmp(&b.1))
            });
            self.build(from, from + half);
            self.nodes[node as usize].right = self.build(from + half, to);
        }
        node
    }

    /// Calls `visit` with each item whose box meets `wanted`, in the tree's own fixed order.
    pub(super) fn visit(&self, wanted: &Bounds<D>, mut visit: impl FnMut(u32)) {
        let mut work = if self.nodes.is_empty() { Vec::new() } else { vec![0u32] };
        while let Some(n) = work.pop() {
            let node = &self.nodes[n as usize];
            if !node.bounds.meets(wanted) {
                continue;
            }
            if node.right == 0 {
                let items = &self.items[node.from as usize..node.to as usize];
                items.iter().filter(|item| item.0.meets(wanted)).for_each(|item| visit(item.1));
            } else {
                work.extend([node.right, n + 1]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_what_a_scan_finds() {
        let at = |i: u32, m: u32| f64::from(i.wrapping_mul(2_654_435_761) % m);
        let boxes: Vec<Bounds<2>> = (0..300)
            .map(|i| {
                let (x, y) = (at(i, 101), at(i + 7, 97));
                Bounds { low: [x, y], high: [x + at(i, 5), y + at(i, 7)] }
            })
            .collect();
        let tree = Tree::new(boxes.iter().copied());
        for wanted in &boxes {
            let mut found = Vec::new();
            tree.visit(wanted, |i| found.push(i));
            found.sort_unstable();
            let scan: Vec<u32> =
                (0u32..).zip(&boxes).filter(|(_, b)| b.meets(wanted)).map(|(i, _)| i).collect();
            assert_eq!(found, scan);
        }
    }

    #[test]
    fn an_empty_tree_finds_nothing() {
        let tree = Tree::<3>::new(std::iter::empty());
        tree.visit(&Bounds { low: [0.0; 3], high: [1.0; 3] }, |_| panic!("nothing is there"));
    }
}
