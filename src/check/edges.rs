//! Adjacency, rebuilt from the triangles alone.
//!
//! Half-edge 3t + i runs from corner i of triangle t to the next. Half-edges are counted into
//! buckets by their lower vertex and sorted within: linear time, no hashing, 24 bytes a triangle
//! while it runs and 12 after.

/// The twin of a half-edge that has none, or more than one.
pub(super) const NONE: u32 = u32::MAX;

/// An edge with a nonzero coefficient in the sum of the triangles' boundaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ChainEdge {
    pub(super) from: u32,
    pub(super) to: u32,
    /// How many more triangles run along it from `from` to `to` than back; positive.
    pub(super) weight: i32,
    /// A triangle that runs along it so.
    pub(super) triangle: u32,
}

/// An edge that is neither shared by two triangles in opposite directions nor of one triangle.
#[derive(Clone, Debug)]
pub(super) struct Irregular {
    pub(super) vertices: [u32; 2],
    /// Triangles that run from the first vertex to the second.
    pub(super) forward: Vec<u32>,
    /// Triangles that run back.
    pub(super) backward: Vec<u32>,
}

impl Irregular {
    pub(super) fn triangles(&self) -> impl Iterator<Item = u32> {
        self.forward.iter().chain(&self.backward).copied()
    }
}

/// Edges of a mesh.
pub(super) struct Edges {
    /// The opposite half-edge of each half-edge, or [`NONE`].
    pub(super) twin: Vec<u32>,
    /// The boundary chain, in the order of lower vertices.
    pub(super) chain: Vec<ChainEdge>,
    /// Edges with other than two opposite triangles or one.
    pub(super) irregular: Vec<Irregular>,
    /// Number of different edges.
    pub(super) count: u64,
}

/// Most triangles that half-edges with a direction bit can number in 32 bits.
pub(super) const TRIANGLES_MAX: usize = (u32::MAX / 6) as usize;

impl Edges {
    /// Builds the adjacency of triangles whose corners are below `vertices`.
    ///
    /// O(n) plus the sorting of each vertex's own edges.
    pub(super) fn of(triangles: &[[u32; 3]], vertices: usize) -> Self {
        let (starts, mut entries) = bucket(triangles, vertices);
        let mut edges = Self {
            twin: vec![NONE; triangles.len() * 3],
            chain: Vec::new(),
            irregular: Vec::new(),
            count: 0,
        };
        let mut from = 0;
        for (lower, &end) in (0u32..).zip(&starts[..vertices]) {
            let bucket = &mut entries[from as usize..end as usize];
            from = end;
            sort_small(bucket);
            for group in bucket.chunk_by(|a, b| a >> 32 == b >> 32) {
                edges.add(lower, group);
            }
        }
        edges
    }

    /// Adds an edge: all half-edges between `lower` and one other vertex.
    fn add(&mut self, lower: u32, group: &[u64]) {
        self.count += 1;
        let other = (group[0] >> 32) as u32;
        match *group {
            [one] => {
                let (half_edge, forward) = unpack(one);
                let [from, to] = if forward { [lower, other] } else { [other, lower] };
                self.chain.push(ChainEdge { from, to, weight: 1, triangle: half_edge / 3 });
            }
            [one, two] if (one ^ two) & 1 == 1 => {
                let (one, two) = (unpack(one).0, unpack(two).0);
                self.twin[one as usize] = two;
                self.twin[two as usize] = one;
            }
            _ => self.add_irregular([lower, other], group),
        }
    }

    fn add_irregular(&mut self, vertices: [u32; 2], group: &[u64]) {
        let along = |wanted: bool| {
            let matching = group.iter().map(|&e| unpack(e)).filter(move |e| e.1 == wanted);
            matching.map(|e| e.0 / 3).collect::<Vec<u32>>()
        };
        let (forward, backward) = (along(true), along(false));
        let weight = forward.len() as i32 - backward.len() as i32;
        let [from, to] = if weight > 0 { vertices } else { [vertices[1], vertices[0]] };
        let triangle = if weight > 0 { forward.first() } else { backward.first() };
        if let (Some(&triangle), true) = (triangle, weight != 0) {
            self.chain.push(ChainEdge { from, to, weight: weight.abs(), triangle });
        }
        self.irregular.push(Irregular { vertices, forward, backward });
    }
}

/// An entry packs the higher vertex, the half-edge and whether it starts at the lower vertex.
fn pack(higher: u32, half_edge: u32, forward: bool) -> u64 {
    (u64::from(higher) << 32) | u64::from(half_edge << 1) | u64::from(forward)
}

#[expect(clippy::cast_possible_truncation, reason = "the lower half is what is wanted")]
fn unpack(entry: u64) -> (u32, bool) {
    (entry as u32 >> 1, entry & 1 == 1)
}

/// Half-edges by lower vertex: the end of each vertex's bucket, and the entries.
fn bucket(triangles: &[[u32; 3]], vertices: usize) -> (Vec<u32>, Vec<u64>) {
    let mut ends = vec![0u32; vertices + 1];
    for &[a, b, c] in triangles {
        for (u, v) in [(a, b), (b, c), (c, a)] {
            ends[u.min(v) as usize + 1] += 1;
        }
    }
    for v in 0..vertices {
        ends[v + 1] += ends[v];
    }
    let mut entries = vec![0u64; triangles.len() * 3];
    let mut half_edge = 0;
    for &[a, b, c] in triangles {
        for (u, v) in [(a, b), (b, c), (c, a)] {
            let next = &mut ends[u.min(v) as usize];
            entries[*next as usize] = pack(u.max(v), half_edge, u < v);
            *next += 1;
            half_edge += 1;
        }
    }
    (ends, entries)
}

/// Buckets hold six entries on average: insertion sort, unless a vertex has very many.
fn sort_small(bucket: &mut [u64]) {
    const LONG: usize = 32;
    if bucket.len() > LONG {
        bucket.sort_unstable();
        return;
    }
    for i in 1..bucket.len() {
        let entry = bucket[i];
        let mut j = i;
        while j > 0 && bucket[j - 1] > entry {
            bucket[j] = bucket[j - 1];
            j -= 1;
        }
        bucket[j] = entry;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_share_an_edge() {
        let edges = Edges::of(&[[0, 1, 2], [2, 1, 3]], 4);
        assert_eq!(edges.count, 5);
        assert_eq!(edges.twin, [NONE, 3, NONE, 1, NONE, NONE]);
        let chain: Vec<_> = edges.chain.iter().map(|e| (e.from, e.to)).collect();
        assert_eq!(chain, [(0, 1), (2, 0), (1, 3), (3, 2)]);
        assert!(edges.irregular.is_empty());
    }

    #[test]
    fn a_third_triangle_makes_an_edge_irregular() {
        let edges = Edges::of(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]], 5);
        assert_eq!(edges.irregular.len(), 1);
        assert_eq!(edges.irregular[0].forward, [0, 2]);
        assert_eq!(edges.irregular[0].backward, [1]);
        let along = edges.chain.iter().find(|e| (e.from, e.to) == (0, 1)).unwrap();
        assert_eq!(along.weight, 1);
    }

    #[test]
    fn long_buckets_sort_like_short_ones() {
        let fan: Vec<[u32; 3]> = (1..100).map(|i| [0, i, i + 1]).collect();
        let edges = Edges::of(&fan, 101);
        assert_eq!(edges.count, 99 * 2 + 1);
        assert_eq!(edges.chain.len(), 101);
    }
}
