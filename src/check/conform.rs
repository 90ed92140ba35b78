//! Conformity with a domain: which edges of the mesh's boundary are segments of the domain, whole
//! or subdivided, and what is left over on either side.

use super::along::Along;
use super::beside::Beside;
use super::domain::{DomainEdge, Region, Source};
use super::edges::ChainEdge;
use super::exact::P2;
use super::structure::Sound;
use super::tree::{Bounds, Tree};
use std::collections::{BTreeMap, BTreeSet};

/// An edge of the mesh's boundary minus the domain's: a cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Residual {
    pub(super) from: u32,
    pub(super) to: u32,
    pub(super) weight: i32,
    /// For an edge of the mesh: the triangle on its left.
    pub(super) triangle: Option<u32>,
    /// For an edge of the domain (which is run backwards): where it comes from.
    pub(super) source: Option<Source>,
    /// For an edge of the domain: its points.
    pub(super) domain_points: Option<[u32; 2]>,
}

/// A domain edge that is a chain of mesh edges through further nodes.
#[derive(Clone, Debug)]
pub(super) struct Subdivided {
    pub(super) edge: DomainEdge,
    pub(super) nodes: Vec<u32>,
}

/// How a mesh's boundary fits the domain's.
#[derive(Default)]
pub(super) struct Match {
    /// Boundary segments that the mesh subdivides.
    pub(super) subdivided: Vec<Subdivided>,
    /// What is left over: empty when the boundaries agree.
    pub(super) residual: Vec<Residual>,
    /// The domain's boundary for winding numbers; built only when something is left over.
    outline: Option<(Tree<2>, Vec<[P2; 2]>)>,
}

impl Match {
    /// 1 if the point lies inside the domain, else 0.
    pub(super) fn winding_of_domain(&self, q: Beside) -> i32 {
        let Some((tree, edges)) = &self.outline else { return 0 };
        let ray = Bounds { low: q.u, high: [q.u[0], f64::INFINITY] };
        let mut sum = 0;
        tree.visit(&ray, |i| {
            let [s, t] = edges[i as usize];
            sum += q.winding(s, t);
        });
        sum
    }
}

/// The vertex of the mesh at each point of the domain, or, where there is none, a number of its own
/// above all points of the mesh.
pub(super) fn domain_vertices(sound: &Sound<'_>, region: &Region) -> Vec<u32> {
    let z = sound.mesh.points.first().map_or(0.0, |p| p[2]);
    let count = sound.mesh.points.len() as u32;
    let vertex = |(i, &[x, y]): (u32, &P2)| sound.point_at(&[x, y, z]).unwrap_or(count + i);
    (0u32..).zip(&region.points).map(vertex).collect()
}

/// Matches the chain (edges of positive weight) with the domain's boundary.
pub(super) fn match_boundary(
    at: &impl Fn(u32) -> P2,
    sound: &Sound<'_>,
    chain: &[ChainEdge],
    region: &Region,
) -> Match {
    let vertices = domain_vertices(sound, region);
    let mut open = Open::new(chain);
    let mut missing = Vec::new();
    for edge in &region.boundary {
        let [from, to] = [edge.from, edge.to].map(|p| vertices[p as usize]);
        if !open.take(from, to) {
            missing.push((*edge, from, to));
        }
    }
    let corners: BTreeSet<u32> = missing.iter().flat_map(|m| [m.1, m.2]).collect();
    let mut result = Match::default();
    for (edge, from, to) in missing {
        let nodes = open.walk(at, [from, to], &corners);
        if nodes.is_empty() {
            result.residual.push(backwards(edge, from, to));
        } else {
            open.take_path(from, &nodes, to);
            result.subdivided.push(Subdivided { edge, nodes });
        }
    }
    result.residual.extend(open.left_over());
    if !result.residual.is_empty() {
        let ends = |e: &DomainEdge| [e.from, e.to].map(|p| region.points[p as usize]);
        let edges: Vec<[P2; 2]> = region.boundary.iter().map(ends).collect();
        result.outline = Some((Tree::new(edges.iter().map(|&e| Bounds::around(e))), edges));
    }
    result
}

fn backwards(edge: DomainEdge, from: u32, to: u32) -> Residual {
    Residual {
        from: to,
        to: from,
        weight: 1,
        triangle: None,
        source: Some(edge.source),
        domain_points: Some([edge.from, edge.to]),
    }
}

/// Boundary edges of the mesh that no segment of the domain has claimed yet.
struct Open {
    /// Triangle and remaining weight by (from, to).
    edges: BTreeMap<(u32, u32), (u32, i32)>,
}

impl Open {
    fn new(chain: &[ChainEdge]) -> Self {
        Self { edges: chain.iter().map(|e| ((e.from, e.to), (e.triangle, e.weight))).collect() }
    }

    fn take(&mut self, from: u32, to: u32) -> bool {
        match self.edges.get_mut(&(from, to)) {
            Some((_, weight)) if *weight > 0 => {
                *weight -= 1;
                true
            }
            _ => false,
        }
    }

    fn take_path(&mut self, from: u32, nodes: &[u32], to: u32) {
        let mut current = from;
        for &next in nodes.iter().chain([&to]) {
            self.take(current, next);
            current = next;
        }
    }

    /// Nodes of a chain of unclaimed edges along the segment, or none. They advance along it and
    /// stay near it, so the walk ends; they are no corners of the domain. Where the boundary goes
    /// on along several edges, the nearest to the segment is tried first, then the others: each
    /// node is left for good at most once.
    fn walk(
        &self,
        at: &impl Fn(u32) -> P2,
        [from, to]: [u32; 2],
        corners: &BTreeSet<u32>,
    ) -> Vec<u32> {
        let measure = |v: u32| Along::new(at(from), at(to), at(v));
        let mut path: Vec<(u32, Along)> = Vec::new();
        let mut dead = BTreeSet::new();
        loop {
            let current = path.last().map_or(from, |&(v, _)| v);
            if !path.is_empty() && self.next(current).any(|v| v == to) {
                return path.into_iter().map(|(v, _)| v).collect();
            }
            let advances =
                |along: &Along| path.last().is_none_or(|(_, last)| last.is_before(along));
            let step = self
                .next(current)
                .filter(|v| !corners.contains(v) && !dead.contains(v))
                .map(|v| (v, measure(v)))
                .filter(|(_, along)| advances(along) && along.is_between() && along.is_near())
                .min_by(|(_, a), (_, b)| a.compare_deviation(b));
            if let Some(step) = step {
                path.push(step);
            } else if let Some((v, _)) = path.pop() {
                dead.insert(v);
            } else {
                return Vec::new();
            }
        }
    }

    /// Heads of the unclaimed edges that start at a node.
    fn next(&self, node: u32) -> impl Iterator<Item = u32> {
        let edges = self.edges.range((node, 0)..=(node, u32::MAX));
        edges.filter(|(_, (_, weight))| *weight > 0).map(|(&(_, v), _)| v)
    }

    fn left_over(&self) -> impl Iterator<Item = Residual> {
        self.edges.iter().filter(|(_, (_, weight))| *weight > 0).map(
            |(&(from, to), &(t, weight))| Residual {
                from,
                to,
                weight,
                triangle: Some(t),
                source: None,
                domain_points: None,
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes of the walk from node 0 at (0, 0) to node 1 at (1, 0) along edges of weight 1.
    fn walk(nodes: &[P2], edges: &[(u32, u32)]) -> Vec<u32> {
        let chain: Vec<ChainEdge> = edges
            .iter()
            .map(|&(from, to)| ChainEdge { from, to, weight: 1, triangle: 0 })
            .collect();
        let at = |v: u32| [&[[0.0, 0.0], [1.0, 0.0]], nodes].concat()[v as usize];
        Open::new(&chain).walk(&at, [0, 1], &BTreeSet::new())
    }

    #[test]
    fn a_walk_comes_back_from_a_chain_that_leads_nowhere() {
        // A hole of three nearly flat nodes touches the segment in its first inner node.
        let nodes = [[0.25, 0.0], [0.5, 0.0], [0.75, 0.0], [0.5, 1e-9], [0.6, 2e-9]];
        let hole = [(2, 3), (3, 6), (6, 2)];
        assert_eq!(
            walk(&nodes, &[&hole[..], &[(0, 2), (2, 5), (5, 4), (4, 1)]].concat()),
            [2, 5, 4]
        );
        assert_eq!(walk(&nodes, &hole), [0u32; 0]);
    }

    #[test]
    fn a_walk_takes_the_nearest_of_two_ways() {
        let nodes = [[0.5, 1e-9], [0.5, -1e-12], [0.5, 2e-9]];
        for way in [[2, 3, 4], [4, 3, 2], [3, 4, 2]] {
            let edges: Vec<_> = way.iter().flat_map(|&v| [(0, v), (v, 1)]).collect();
            assert_eq!(walk(&nodes, &edges), [3]);
        }
    }
}
