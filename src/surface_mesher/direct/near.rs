//! The front edges near a place: a grid of cells for each size of edge.

use crate::vector::{Vector, distance, scale};
use std::collections::{BTreeMap, BTreeSet};

/// Edges by the power of two of their length and the cell that their middle lies in.
#[derive(Debug, Default)]
pub(super) struct Near {
    levels: BTreeMap<i32, BTreeMap<[i64; 3], BTreeSet<u32>>>,
}

/// Cells further out than this are one: coordinates never overflow.
const CELL_MAX: f64 = 1e15;

fn level(length: f64) -> i32 {
    if length > 0.0 && length.is_finite() { libm::ilogb(length) } else { 0 }
}

fn cell(p: Vector, level: i32) -> [i64; 3] {
    let size = libm::scalbn(1.0, level + 1);
    p.map(|x| libm::floor(x / size).clamp(-CELL_MAX, CELL_MAX) as i64)
}

impl Near {
    pub(super) fn insert(&mut self, edge: u32, [a, b]: [Vector; 2]) {
        let level = level(distance(a, b));
        let cells = self.levels.entry(level).or_default();
        cells.entry(cell(middle(a, b), level)).or_default().insert(edge);
    }

    pub(super) fn remove(&mut self, edge: u32, [a, b]: [Vector; 2]) {
        let level = level(distance(a, b));
        let Some(cells) = self.levels.get_mut(&level) else { return };
        let at = cell(middle(a, b), level);
        if let Some(list) = cells.get_mut(&at) {
            list.remove(&edge);
            if list.is_empty() {
                cells.remove(&at);
            }
        }
        if cells.is_empty() {
            self.levels.remove(&level);
        }
    }

    /// All edges that come within `radius` of `p`, and some others, in a fixed order.
    pub(super) fn around(&self, p: Vector, radius: f64) -> Vec<u32> {
        let mut found = Vec::new();
        for (&level, cells) in &self.levels {
            // An edge reaches half its length, below the size of a cell, from its middle.
            let reach = radius + libm::scalbn(1.0, level);
            let low = cell(p.map(|x| x - reach), level);
            let high = cell(p.map(|x| x + reach), level);
            let wide = (0..3).any(|i| high[i] - low[i] > 16);
            if wide {
                let inside = |c: &[i64; 3]| (0..3).all(|i| c[i] >= low[i] && c[i] <= high[i]);
                let lists = cells.iter().filter(|(c, _)| inside(c));
                found.extend(lists.flat_map(|(_, list)| list));
                continue;
            }
            for i in low[0]..=high[0] {
                for j in low[1]..=high[1] {
                    let row = cells.range([i, j, low[2]]..=[i, j, high[2]]);
                    found.extend(row.flat_map(|(_, list)| list));
                }
            }
        }
        found
    }
}

fn middle(a: Vector, b: Vector) -> Vector {
    scale(0.5, crate::vector::add(a, b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::segment_distance_sq;

    // spec: U12
    #[test]
    fn every_edge_that_comes_near_is_found_and_none_that_was_removed() {
        let step = |k: u32, m: u32| f64::from(k.wrapping_mul(2_654_435_761) % m) / f64::from(m);
        let edges: Vec<[Vector; 2]> = (0..400)
            .map(|k| {
                let a = [step(k, 97), step(k, 89), step(k, 83)];
                let size = libm::scalbn(0.3, -i32::try_from(k % 7).expect("small"));
                [a, [a[0] + size * step(k, 31), a[1] - size, a[2] + size * step(k, 17)]]
            })
            .collect();
        let mut near = Near::default();
        for (i, ends) in (0..).zip(&edges) {
            near.insert(i, *ends);
        }
        for (i, ends) in (0..).zip(&edges).filter(|(i, _)| i % 3 == 0) {
            near.remove(i, *ends);
        }
        for k in 0..60 {
            let (p, radius) = ([step(k, 37), step(k, 41), step(k, 43)], 0.02 + 0.1 * step(k, 13));
            let found = near.around(p, radius);
            for (i, [a, b]) in (0..).zip(&edges) {
                let is_near = segment_distance_sq(*a, *b, p).sqrt() <= radius;
                assert!(!(is_near && i % 3 != 0) || found.contains(&i), "edge {i}");
                assert!(i % 3 != 0 || !found.contains(&i), "edge {i} is gone");
            }
        }
    }
}
