//! Feature curves of a triangulated surface: sharp edges, borders, and edges between regions or with
//! a marker, joined to chains between corners and cut anew by the spacing.

use super::input::Input;
use crate::skin::Rank;
use crate::triangulation::{HalfEdgeId, TriangleId, VertexId};
use crate::vector::{Vector, along, distance, dot, sub, unit};
use std::collections::{BTreeMap, BTreeSet};

/// A chain of feature edges between two corners, or closed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Chain {
    /// Vertices along it; the first again at the end of a closed one.
    pub(super) vertices: Vec<u32>,
    /// Marker of its edges, when they have one.
    pub(super) marker: Option<i32>,
}

/// The features of a surface.
#[derive(Clone, Debug, Default)]
pub(super) struct Features {
    pub(super) chains: Vec<Chain>,
    /// Ends of chains that are no mere start of a closed one.
    pub(super) corners: usize,
    /// What may happen to each vertex.
    pub(super) ranks: Vec<Rank>,
}

/// A new node of a chain: on the edge between two of its vertices, by the fraction of its length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    /// Index of the edge in the chain.
    pub(super) edge: usize,
    /// From 0 to 1.
    pub(super) at: f64,
}

/// Marks the features of the input as constrained edges and finds their chains.
pub(super) fn find(input: &mut Input, angle_deg: f64) -> Features {
    let edges: Vec<HalfEdgeId> = input.mesh.triangles().flat_map(TriangleId::half_edges).collect();
    let mut at: Vec<Vec<(u32, Kind)>> = vec![Vec::new(); input.points.len()];
    for e in edges {
        let twin = input.mesh.twin(e);
        if twin.is_some_and(|f| f.0 < e.0) {
            continue;
        }
        if let Some(kind) = kind(input, e, twin, angle_deg) {
            input.mesh.set_constrained(e, true);
            let [a, b] = [input.mesh.origin(e).0, input.mesh.dest(e).0];
            at[a as usize].push((b, kind));
            at[b as usize].push((a, kind));
        }
    }
    let corners: Vec<bool> =
        (0..at.len()).map(|v| is_corner(input, v as u32, &at[v], angle_deg)).collect();
    let mut walk = Walk { at: &at, corners: &corners, seen: BTreeSet::new() };
    let mut chains: Vec<Chain> = Vec::new();
    for v in (0..at.len()).filter(|&v| corners[v]) {
        chains.extend((0..at[v].len()).filter_map(|k| walk.from(v as u32, k)));
    }
    // What is left are closed curves without a corner.
    let mut ranks: Vec<Rank> = at.iter().map(|list| rank(list.len())).collect();
    for (v, list) in (0..).zip(&at) {
        for k in 0..list.len() {
            chains.extend(walk.from(v, k));
        }
    }
    for chain in &chains {
        ranks[chain.vertices[0] as usize] = Rank::Fixed;
        ranks[chain.vertices[chain.vertices.len() - 1] as usize] = Rank::Fixed;
    }
    Features { chains, corners: corners.iter().filter(|c| **c).count(), ranks }
}

fn rank(features: usize) -> Rank {
    if features == 0 { Rank::Free } else { Rank::Removable }
}

/// What makes an edge a feature: along one curve it is the same.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Kind {
    marker: Option<i32>,
    /// Regions on its two sides, the lower first.
    regions: [Option<i32>; 2],
}

fn kind(input: &Input, e: HalfEdgeId, twin: Option<HalfEdgeId>, angle_deg: f64) -> Option<Kind> {
    let [a, b] = [input.mesh.origin(e).0, input.mesh.dest(e).0];
    let marker = input.markers.get(&[a.min(b), a.max(b)]).copied();
    let region = |h: HalfEdgeId| input.regions.get(h.triangle().index()).copied();
    let mut regions = [region(e), twin.and_then(region)];
    regions.sort_unstable();
    let is_feature = match twin {
        None => true,
        Some(f) => marker.is_some() || regions[0] != regions[1] || input.turn_deg(e, f) > angle_deg,
    };
    is_feature.then_some(Kind { marker, regions })
}

/// A vertex where curves end, meet, change their kind, or turn sharply.
fn is_corner(input: &Input, v: u32, list: &[(u32, Kind)], angle_deg: f64) -> bool {
    match list {
        [] => false,
        [(a, first), (b, second)] => {
            let [from, here, to] = [*a, v, *b].map(|w| input.points[w as usize]);
            let directions = [unit(sub(here, from)), unit(sub(to, here))];
            let turn = match directions {
                [Some(p), Some(q)] => libm::acos(dot(p, q).clamp(-1.0, 1.0)).to_degrees(),
                _ => 180.0,
            };
            first != second || turn > angle_deg
        }
        _ => true,
    }
}

struct Walk<'a> {
    at: &'a [Vec<(u32, Kind)>],
    corners: &'a [bool],
    /// Edges of known chains, by their lower and upper vertex.
    seen: BTreeSet<[u32; 2]>,
}

impl Walk<'_> {
    /// The chain that starts with the `k`-th feature edge at `start`, unless it is known.
    fn from(&mut self, start: u32, k: usize) -> Option<Chain> {
        let (mut next, kind) = self.at[start as usize][k];
        let ends = |a: u32, b: u32| [a.min(b), a.max(b)];
        if self.seen.contains(&ends(start, next)) {
            return None;
        }
        let mut vertices = vec![start];
        let mut here = start;
        loop {
            self.seen.insert(ends(here, next));
            vertices.push(next);
            if self.corners[next as usize] || next == start {
                return Some(Chain { vertices, marker: kind.marker });
            }
            let list = &self.at[next as usize];
            let onward = if list[0].0 == here { list[1].0 } else { list[0].0 };
            (here, next) = (next, onward);
        }
    }
}

/// How chains are cut: each gets round(integral of ds / h) edges of equal parts of that integral, at
/// least one, two beside another chain between the same corners, three when closed.
///
/// # Errors
/// The number of edges, when it is above `limit`.
pub(super) fn cuts(
    input: &Input,
    chains: &[Chain],
    spacing: &dyn Fn(Vector) -> f64,
    limit: usize,
) -> Result<Vec<Vec<Cut>>, f64> {
    let edges: f64 = chains.iter().map(|chain| Sampled::new(input, chain, spacing).total).sum();
    if edges > limit as f64 {
        return Err(edges);
    }
    let mut between: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    let ends = |chain: &Chain| {
        let (a, b) = (chain.vertices[0], chain.vertices[chain.vertices.len() - 1]);
        [a.min(b), a.max(b)]
    };
    for chain in chains {
        *between.entry(ends(chain)).or_default() += 1;
    }
    let cut = |chain: &Chain| {
        let [a, b] = ends(chain);
        let least = match between[&[a, b]] {
            _ if a == b => 3,
            1 => 1,
            _ => 2,
        };
        Sampled::new(input, chain, spacing).cut(least)
    };
    Ok(chains.iter().map(cut).collect())
}

/// Samples of the spacing on each edge of a chain.
const SAMPLES: usize = 8;

/// Lengths over spacings along a chain.
struct Sampled {
    /// Edge of the chain, sample on it, and the integral of ds / h up to the sample's piece.
    pieces: Vec<(usize, usize, f64)>,
    /// The whole integral.
    total: f64,
}

impl Sampled {
    fn new(input: &Input, chain: &Chain, spacing: &dyn Fn(Vector) -> f64) -> Self {
        let mut sampled = Self { pieces: Vec::new(), total: 0.0 };
        for (edge, pair) in chain.vertices.windows(2).enumerate() {
            let [a, b] = [pair[0], pair[1]].map(|v| input.points[v as usize]);
            let length = distance(a, b) / SAMPLES as f64;
            for k in 0..SAMPLES {
                let at = (k as f64 + 0.5) / SAMPLES as f64;
                sampled.pieces.push((edge, k, sampled.total));
                sampled.total += length / spacing(along(a, at, sub(b, a)));
            }
        }
        sampled
    }

    /// At equal parts of the integral, at least `least` of them.
    fn cut(&self, least: usize) -> Vec<Cut> {
        let Self { pieces, total } = self;
        let count = (libm::round(*total) as usize).max(least);
        let mut cuts = Vec::with_capacity(count);
        let mut i = 0;
        for n in 1..count {
            let wanted = total * n as f64 / count as f64;
            while i + 1 < pieces.len() && pieces[i + 1].2 <= wanted {
                i += 1;
            }
            let (edge, k, from) = pieces[i];
            let to = pieces.get(i + 1).map_or(*total, |next| next.2);
            let part = if to > from { (wanted - from) / (to - from) } else { 0.5 };
            cuts.push(Cut { edge, at: (k as f64 + part) / SAMPLES as f64 });
        }
        cuts
    }
}

/// A cut this near to a vertex of the chain, as a fraction of the edge, is taken there.
pub(super) const AT_VERTEX: f64 = 1e-6;

/// The half-edge between two joined vertices, in either direction.
pub(super) fn between(
    mesh: &crate::triangulation::Triangulation,
    out: HalfEdgeId,
    to: VertexId,
) -> Option<HalfEdgeId> {
    mesh.star(out).find_map(|e| {
        if mesh.dest(e) == to {
            Some(e)
        } else if mesh.apex(e) == to {
            Some(e.prev())
        } else {
            None
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{MarkedEdge, MeshData};

    /// The unit cube, two triangles a face.
    fn cube() -> MeshData {
        let points = (0..8_u32).map(|k| [0, 1, 2].map(|i| f64::from(k >> i & 1))).collect();
        let quads =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        MeshData { points, triangles, ..MeshData::default() }
    }

    fn features(mesh: &MeshData, angle: f64) -> (Input, Features) {
        let mut input = Input::new(mesh).expect("a surface");
        let features = find(&mut input, angle);
        (input, features)
    }

    // spec: U2
    #[test]
    fn a_cube_has_twelve_edges_and_eight_corners() {
        let (input, found) = features(&cube(), 40.0);
        assert_eq!((found.chains.len(), found.corners), (12, 8));
        assert!(found.ranks.iter().all(|&rank| rank == Rank::Fixed));
        assert_eq!(super::super::input::parts(&input.mesh).iter().max(), Some(&5));
        let (_, smooth) = features(&cube(), 100.0);
        assert_eq!((smooth.chains.len(), smooth.corners), (0, 0));
    }

    // spec: U2
    #[test]
    fn borders_markers_and_regions_are_features_at_any_angle() {
        let mut sheet = MeshData {
            points: (0..9_u32).map(|k| [f64::from(k % 3), f64::from(k / 3), 0.0]).collect(),
            ..MeshData::default()
        };
        for k in [0, 1, 3, 4] {
            sheet.triangles.extend([[k, k + 1, k + 4], [k, k + 4, k + 3]]);
        }
        let (_, open) = features(&sheet, 180.0);
        assert_eq!((open.chains.len(), open.corners), (1, 0), "a closed border without a corner");
        assert_eq!(open.chains[0].vertices.len(), 9);
        let (_, square) = features(&sheet, 40.0);
        assert_eq!((square.chains.len(), square.corners), (4, 4));
        sheet.regions = vec![1, 1, 2, 2, 1, 1, 2, 2];
        let (_, halves) = features(&sheet, 180.0);
        assert_eq!((halves.chains.len(), halves.corners), (3, 2));
        sheet.edges.push(MarkedEdge { vertices: [3, 4], marker: 5 });
        let (_, marked) = features(&sheet, 180.0);
        let with = marked.chains.iter().filter(|chain| chain.marker == Some(5)).count();
        assert_eq!((marked.corners, with), (4, 1));
    }

    // spec: U2
    #[test]
    fn cuts_are_at_equal_parts_of_length_over_spacing() {
        let points: Vec<_> = [0.0, 1.0, 4.0].map(|x| [x, 0.0, 0.0]).to_vec();
        let mesh = MeshData {
            points: [points, vec![[0.0, 1.0, 0.0], [4.0, 1.0, 0.0]]].concat(),
            triangles: vec![[0, 1, 3], [1, 4, 3], [1, 2, 4]],
            ..MeshData::default()
        };
        let (input, _) = features(&mesh, 40.0);
        // Vertices are numbered as the triangles first name them.
        let chain = Chain { vertices: vec![0, 1, 4], marker: None };
        let place = |cut: &Cut| if cut.edge == 0 { cut.at } else { 1.0 + 3.0 * cut.at };
        let at = |h: f64| -> Vec<f64> {
            Sampled::new(&input, &chain, &|_| h).cut(1).iter().map(place).collect()
        };
        for (h, expected) in [(9.0, vec![]), (2.0, vec![2.0]), (1.3, vec![4.0 / 3.0, 8.0 / 3.0])] {
            let found = at(h);
            assert_eq!(found.len(), expected.len());
            for (a, b) in found.iter().zip(&expected) {
                assert!((a - b).abs() < 1e-12, "{a} for {b}");
            }
        }
        assert_eq!(
            Sampled::new(&input, &chain, &|_| 100.0).cut(3).len(),
            2,
            "at least three edges"
        );
        let many = cuts(&input, &[chain], &|_| 1e-12, 1000).expect_err("too many");
        assert!((many / 4e12 - 1.0).abs() < 1e-9, "{many}");
    }
}
