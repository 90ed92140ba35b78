//! A tree of points of space, for the nearest ones.

use crate::vector::{Vector, norm_sq, sub};

/// Points with values, in an order in which the middle of every range splits it along one axis.
pub(super) struct Tree<T> {
    items: Vec<(Vector, T)>,
}

/// Ranges up to this length are searched one by one.
const LEAF: usize = 8;

impl<T: Copy> Tree<T> {
    pub(super) fn new(mut items: Vec<(Vector, T)>) -> Self {
        arrange(&mut items, 0);
        Self { items }
    }

    /// At most `count` points nearest to `p`, nearest first, with their squared distances.
    pub(super) fn nearest(&self, p: Vector, count: usize) -> Vec<(f64, T)> {
        let mut best = Vec::with_capacity(count + 1);
        search(&self.items, 0, &Query { p, count }, &mut best);
        best
    }
}

/// The range is split along x, y and z in turn.
fn arrange<T: Copy>(items: &mut [(Vector, T)], axis: usize) {
    if items.len() <= LEAF {
        return;
    }
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]));
    let (low, high) = items.split_at_mut(middle);
    arrange(low, (axis + 1) % 3);
    arrange(&mut high[1..], (axis + 1) % 3);
}

struct Query {
    p: Vector,
    count: usize,
}

fn search<T: Copy>(items: &[(Vector, T)], axis: usize, query: &Query, best: &mut Vec<(f64, T)>) {
    if items.len() <= LEAF {
        items.iter().for_each(|item| offer(item, query, best));
        return;
    }
    let middle = items.len() / 2;
    let split = query.p[axis] - items[middle].0[axis];
    let (low, high) = (&items[..middle], &items[middle + 1..]);
    let (near, far) = if split < 0.0 { (low, high) } else { (high, low) };
    search(near, (axis + 1) % 3, query, best);
    offer(&items[middle], query, best);
    if best.len() < query.count || split * split < best[best.len() - 1].0 {
        search(far, (axis + 1) % 3, query, best);
    }
}

fn offer<T: Copy>(item: &(Vector, T), query: &Query, best: &mut Vec<(f64, T)>) {
    let away = norm_sq(sub(query.p, item.0));
    let place = best.partition_point(|(other, _)| *other <= away);
    if place < query.count {
        best.insert(place, (away, item.1));
        best.truncate(query.count);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: S8
    #[test]
    fn the_nearest_points_are_those_of_a_linear_search() {
        let step = |k: u32, m: u32| f64::from(k.wrapping_mul(2_654_435_761) % m) / f64::from(m);
        let points: Vec<(Vector, u32)> =
            (0..500).map(|k| ([step(k, 97), step(k, 89), step(k, 83)], k)).collect();
        let tree = Tree::new(points.clone());
        for k in 0..100 {
            let p = [step(k, 31), step(k, 37), 1.2 * step(k, 41)];
            let mut all: Vec<f64> = points.iter().map(|(q, _)| norm_sq(sub(p, *q))).collect();
            all.sort_by(f64::total_cmp);
            let found: Vec<f64> = tree.nearest(p, 4).iter().map(|(d, _)| *d).collect();
            assert_eq!(found, all[..4]);
        }
    }

    #[test]
    fn an_empty_tree_has_no_nearest_point() {
        let tree: Tree<u32> = Tree::new(Vec::new());
        assert!(tree.nearest([0.0; 3], 3).is_empty());
    }
}
