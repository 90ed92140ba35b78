//! The growth-limited field of space: h(x) = min over sources i of (h_i + g |x - x_i|), and at most
//! a cap.
//!
//! The same field as in the plane (SPEC 6), with distances through space, which are at most those
//! along the surface: its slope on the surface is at most g. An octree answers it as the quadtree of
//! the plane does.

use crate::vector::{Vector, distance};

/// A source: a point and the spacing wanted there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Source {
    pub(crate) at: Vector,
    pub(crate) spacing: f64,
}

/// Growth-limited distance field in space.
#[derive(Debug)]
pub(crate) struct SpaceField {
    growth: f64,
    cap: f64,
    origin: Vector,
    size: f64,
    nodes: Vec<Node>,
    sources: Vec<Source>,
}

/// A cell: eight children at `first ..`, or a leaf with sources `first .. first + count`.
#[derive(Clone, Copy, Debug)]
struct Node {
    first: u32,
    count: u32,
}

const INNER: u32 = u32::MAX;
const EMPTY: Node = Node { first: 0, count: 0 };
/// Below this depth a cell is 2^-30 of the model.
const DEPTH_MAX: u32 = 30;
/// A leaf is at most this many spacings wide.
const LEAF_WIDTH: f64 = 2.0;
/// Lists up to this length are kept whole.
const LIST_MAX: usize = 6;

#[derive(Clone, Copy)]
struct Cell {
    origin: Vector,
    size: f64,
    depth: u32,
}

impl Cell {
    fn child(self, octant: usize) -> Self {
        let half = self.size / 2.0;
        let shift = |i: usize| if octant >> i & 1 == 0 { 0.0 } else { half };
        let origin = std::array::from_fn(|i| self.origin[i] + shift(i));
        Self { origin, size: half, depth: self.depth + 1 }
    }

    /// Smallest and largest distance from `p` to the cell.
    fn distances(self, p: Vector) -> (f64, f64) {
        let half = self.size / 2.0;
        let (mut near, mut far) = (0.0, 0.0);
        for (x, origin) in p.into_iter().zip(self.origin) {
            let d = (x - (origin + half)).abs();
            near += (d - half).max(0.0).powi(2);
            far += (d + half).powi(2);
        }
        (f64::sqrt(near), f64::sqrt(far))
    }

    /// A lattice of 27 points.
    fn samples(self) -> impl Iterator<Item = Vector> {
        (0..27_u32).map(move |k| {
            let step = |i: u32| f64::from(k / 3_u32.pow(i) % 3) / 2.0 * self.size;
            [self.origin[0] + step(0), self.origin[1] + step(1), self.origin[2] + step(2)]
        })
    }
}

impl SpaceField {
    /// Builds the field; `cap` may be infinite when there is a source.
    pub(crate) fn new(sources: &[Source], growth: f64, cap: f64) -> Self {
        let useful: Vec<Source> = sources.iter().copied().filter(|s| s.spacing < cap).collect();
        let (origin, size) = bounding_cube(&useful);
        let mut field = Self { growth, cap, origin, size, nodes: vec![EMPTY], sources: Vec::new() };
        field.build(0, Cell { origin, size, depth: 0 }, useful);
        field
    }

    /// The spacing at `p`.
    pub(crate) fn at(&self, p: Vector) -> f64 {
        let mut x: Vector =
            std::array::from_fn(|i| ((p[i] - self.origin[i]) / self.size).clamp(0.0, 1.0));
        let mut node = self.nodes[0];
        while node.count == INNER {
            let mut octant = 0;
            for (i, x) in x.iter_mut().enumerate() {
                *x *= 2.0;
                if *x >= 1.0 {
                    *x -= 1.0;
                    octant |= 1 << i;
                }
            }
            node = self.nodes[node.first as usize + octant];
        }
        let list = &self.sources[node.first as usize..(node.first + node.count) as usize];
        self.minimum(list, p).1
    }

    fn minimum(&self, list: &[Source], p: Vector) -> (usize, f64) {
        let mut best = (usize::MAX, self.cap);
        for (i, source) in list.iter().enumerate() {
            let h = source.spacing + self.growth * distance(source.at, p);
            if h < best.1 {
                best = (i, h);
            }
        }
        best
    }

    fn build(&mut self, index: usize, cell: Cell, mut list: Vec<Source>) {
        let smallest = self.prune(cell, &mut list);
        let narrow = cell.size <= LEAF_WIDTH * smallest;
        if narrow || list.len() <= LIST_MAX || cell.depth >= DEPTH_MAX {
            let list = if list.len() > LIST_MAX { self.sampled(cell, &list) } else { list };
            let (first, count) = (self.sources.len() as u32, list.len() as u32);
            self.nodes[index] = Node { first, count };
            self.sources.extend(list);
            return;
        }
        let first = self.nodes.len();
        self.nodes[index] = Node { first: first as u32, count: INNER };
        self.nodes.extend([EMPTY; 8]);
        for octant in 0..8 {
            self.build(first + octant, cell.child(octant), list.clone());
        }
    }

    /// Drops the sources that are nowhere in the cell the smallest; returns a lower bound of the
    /// field in the cell.
    fn prune(&self, cell: Cell, list: &mut Vec<Source>) -> f64 {
        let bounds = |s: &Source| {
            let (near, far) = cell.distances(s.at);
            (s.spacing + self.growth * near, s.spacing + self.growth * far)
        };
        let (mut lowest, mut ceiling) = (self.cap, self.cap);
        for source in list.iter() {
            let (low, high) = bounds(source);
            lowest = lowest.min(low);
            ceiling = ceiling.min(high);
        }
        list.retain(|source| bounds(source).0 <= ceiling);
        lowest
    }

    /// The sources that are smallest at one of the cell's samples, in list order.
    fn sampled(&self, cell: Cell, list: &[Source]) -> Vec<Source> {
        let best = cell.samples().map(|p| self.minimum(list, p).0);
        let mut kept: Vec<usize> = best.filter(|&i| i < list.len()).collect();
        kept.sort_unstable();
        kept.dedup();
        kept.into_iter().map(|i| list[i]).collect()
    }
}

fn bounding_cube(sources: &[Source]) -> (Vector, f64) {
    let Some(first) = sources.first() else { return ([0.0; 3], 1.0) };
    let (mut low, mut high) = (first.at, first.at);
    for Source { at, .. } in sources {
        for i in 0..3 {
            low[i] = low[i].min(at[i]);
            high[i] = high[i].max(at[i]);
        }
    }
    let size = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    (low, if size > 0.0 { size } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn helix() -> Vec<Source> {
        (0..400)
            .map(|i| {
                let t = f64::from(i) / 20.0;
                let at = [libm::cos(t), libm::sin(t), 0.2 * t];
                Source { at, spacing: 0.01 + 0.002 * f64::from(i % 50) }
            })
            .collect()
    }

    // spec: S6
    #[test]
    fn the_tree_stays_within_five_percent_of_the_minimum() {
        let sources = helix();
        for (growth, cap) in [(0.1, f64::INFINITY), (0.25, f64::INFINITY), (0.25, 0.06)] {
            let field = SpaceField::new(&sources, growth, cap);
            for k in 0..8000_u32 {
                let step = |n: u32| f64::from(n % 20) / 9.5 - 1.0;
                let p = [step(k), step(k / 20), 2.0 + 2.0 * step(k / 400)];
                let all = sources.iter().map(|s| s.spacing + growth * distance(s.at, p));
                let truth = all.fold(cap, f64::min);
                let h = field.at(p);
                assert!(h >= truth && h <= 1.05 * truth, "{p:?}: {h} for {truth}");
            }
        }
    }

    // spec: S6
    #[test]
    fn without_a_source_below_it_the_cap_rules() {
        assert_eq!(SpaceField::new(&[], 0.25, 0.5).at([1.0, 2.0, 3.0]), 0.5);
        let far = [Source { at: [0.0; 3], spacing: 0.7 }];
        assert_eq!(SpaceField::new(&far, 0.25, 0.5).at([0.0; 3]), 0.5);
        assert_eq!(SpaceField::new(&far, 0.25, f64::INFINITY).at([0.0; 3]), 0.7);
    }
}
