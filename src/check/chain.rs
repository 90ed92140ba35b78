//! The boundary chain of a mesh: comparing it with the domain's boundary, and splitting its edges
//! at the vertices that hang on them.

use super::edges::ChainEdge;
use super::exact::{P2, lexicographic, orient2d};
use super::tree::{Bounds, Tree};
use std::collections::BTreeMap;

/// A vertex strictly inside an edge of the chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct OnEdge {
    /// Position of the edge in the chain.
    pub(super) edge: usize,
    pub(super) vertex: u32,
}

/// The different vertices of a chain, sorted.
pub(super) fn vertices(chain: &[ChainEdge]) -> Vec<u32> {
    let mut all: Vec<u32> = chain.iter().flat_map(|e| [e.from, e.to]).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// The box around an edge.
pub(super) fn bounds(at: impl Fn(u32) -> P2, edge: [u32; 2]) -> Bounds<2> {
    Bounds::around(edge.map(at))
}

/// Finds every vertex of the chain that lies exactly on an edge of the chain, but not at its end.
pub(super) fn vertices_on_edges(at: impl Fn(u32) -> P2, chain: &[ChainEdge]) -> Vec<OnEdge> {
    let tree = Tree::new(chain.iter().map(|e| bounds(&at, [e.from, e.to])));
    let mut found = Vec::new();
    for vertex in vertices(chain) {
        let p = at(vertex);
        tree.visit(&Bounds { low: p, high: p }, |i| {
            let e = &chain[i as usize];
            let is_end = e.from == vertex || e.to == vertex;
            if !is_end && orient2d(at(e.from), at(e.to), p).is_eq() {
                found.push(OnEdge { edge: i as usize, vertex });
            }
        });
    }
    found.sort_unstable();
    found
}

/// Splits edges at the vertices on them and sums up what then runs along the same two vertices.
pub(super) fn split(
    at: impl Fn(u32) -> P2,
    chain: &[ChainEdge],
    on_edges: &[OnEdge],
) -> Vec<ChainEdge> {
    let mut pieces = Vec::with_capacity(chain.len() + on_edges.len());
    let mut rest = on_edges;
    for (i, edge) in chain.iter().enumerate() {
        let count = rest.partition_point(|o| o.edge <= i);
        let (here, later) = rest.split_at(count);
        rest = later;
        let mut stops: Vec<u32> = here.iter().map(|o| o.vertex).collect();
        let forward = lexicographic(at(edge.from), at(edge.to)).is_lt();
        stops.sort_unstable_by(|&a, &b| {
            let order = lexicographic(at(a), at(b));
            if forward { order } else { order.reverse() }
        });
        let mut from = edge.from;
        for to in stops.into_iter().chain([edge.to]) {
            pieces.push(ChainEdge { from, to, ..*edge });
            from = to;
        }
    }
    net(pieces)
}

/// What runs along two vertices: the net weight from the lower to the higher, and a triangle that
/// runs so and one that runs back.
#[derive(Default)]
struct Sum {
    weight: i32,
    owners: [Option<u32>; 2],
}

/// The sum of directed edges, as edges of positive weight sorted by their ends.
pub(super) fn net(pieces: Vec<ChainEdge>) -> Vec<ChainEdge> {
    let mut sums: BTreeMap<[u32; 2], Sum> = BTreeMap::new();
    for e in pieces {
        let forward = e.from < e.to;
        let sum = sums.entry([e.from.min(e.to), e.from.max(e.to)]).or_default();
        sum.weight += if forward { e.weight } else { -e.weight };
        sum.owners[usize::from(!forward)].get_or_insert(e.triangle);
    }
    sums.into_iter().filter_map(|(ends, sum)| sum.edge(ends)).collect()
}

impl Sum {
    fn edge(&self, [low, high]: [u32; 2]) -> Option<ChainEdge> {
        let (from, to) = if self.weight > 0 { (low, high) } else { (high, low) };
        let triangle = self.owners[usize::from(self.weight < 0)]?;
        let weight = self.weight.abs();
        (weight != 0).then_some(ChainEdge { from, to, weight, triangle })
    }
}

/// Groups edges by connection through vertices: the group of each edge, groups numbered in the
/// order of their first edge.
pub(super) fn connected(edges: &[[u32; 2]]) -> Vec<usize> {
    let mut groups = Groups::new(edges.len());
    let mut first: BTreeMap<u32, usize> = BTreeMap::new();
    for (i, ends) in edges.iter().enumerate() {
        for &v in ends {
            let other = *first.entry(v).or_insert(i);
            groups.join(i, other);
        }
    }
    groups.numbers()
}

/// A union-find forest over positions; the lowest position of a group is its root.
pub(super) struct Groups {
    parents: Vec<usize>,
}

impl Groups {
    pub(super) fn new(count: usize) -> Self {
        Self { parents: (0..count).collect() }
    }

    /// Paths are halved on the way.
    pub(super) fn root(&mut self, mut i: usize) -> usize {
        while self.parents[i] != i {
            self.parents[i] = self.parents[self.parents[i]];
            i = self.parents[i];
        }
        i
    }

    pub(super) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b)] = a.min(b);
    }

    /// The group of each position, numbered by first members.
    pub(super) fn numbers(mut self) -> Vec<usize> {
        let mut numbers = vec![0; self.parents.len()];
        let mut next = 0;
        for i in 0..self.parents.len() {
            let root = self.root(i);
            if root == i {
                numbers[i] = next;
                next += 1;
            } else {
                numbers[i] = numbers[root];
            }
        }
        numbers
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edge(from: u32, to: u32) -> ChainEdge {
        ChainEdge { from, to, weight: 1, triangle: from }
    }

    #[test]
    fn a_split_edge_cancels_against_its_halves() {
        let points = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]];
        let at = |v: u32| points[v as usize];
        let chain = [edge(0, 1), edge(1, 2), edge(2, 0)];
        let on = vertices_on_edges(at, &chain);
        assert_eq!(on, [OnEdge { edge: 0, vertex: 2 }]);
        assert_eq!(split(at, &chain, &on), []);
    }

    #[test]
    fn weights_add_up() {
        let sum = net(vec![edge(3, 1), edge(3, 1), edge(1, 3), edge(5, 4)]);
        assert_eq!(sum, [edge(3, 1), edge(5, 4)]);
    }

    #[test]
    fn groups_are_numbered_by_first_members() {
        assert_eq!(connected(&[[0, 1], [5, 6], [1, 2], [6, 7], [9, 9]]), [0, 1, 0, 1, 2]);
    }
}
