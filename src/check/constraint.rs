//! Interior constraints and isolated points of the domain, and how far the nodes of subdivided
//! segments lie from them.

use super::CheckOptions;
use super::along::Along;
use super::conform::{Match, Subdivided, domain_vertices};
use super::domain::{self, DomainEdge, Region, show_source};
use super::exact::P2;
use super::id::Id;
use super::lattice::Plane;
use super::report::{Collector, DeviationStatistics, Draft, show_vertex};
use super::structure::Sound;
use crate::domain::Domain;
use std::collections::{BTreeMap, BTreeSet};

/// What the checks inside a domain work on.
pub(super) struct Inner<'a> {
    pub(super) plane: &'a Plane<'a>,
    pub(super) sound: &'a Sound<'a>,
    pub(super) domain: &'a Domain,
    pub(super) region: &'a Region,
}

/// Checks M19 to M21.
pub(super) fn check(
    inner: &Inner<'_>,
    matched: &Match,
    options: &CheckOptions,
    concerned: &mut BTreeSet<u32>,
    out: &mut Collector<'_>,
) -> DeviationStatistics {
    let vertices = domain_vertices(inner.sound, inner.region);
    report_lost_points(inner, &vertices, concerned, out);
    let mut subdivided = matched.subdivided.clone();
    let (chains, lost) = follow_constraints(inner, &vertices);
    subdivided.extend(chains);
    for edge in lost {
        let ends = [edge.from, edge.to].map(|p| vertices[p as usize]);
        // A finding about the boundary at both ends explains the loss.
        if ends.iter().all(|v| concerned.contains(v)) {
            continue;
        }
        let known = ends.into_iter().filter(|&v| (v as usize) < inner.sound.mesh.points.len());
        out.add(Id::ConstraintLost, || lost_constraint(inner, &edge).vertices(known.clone()));
        concerned.extend(known);
    }
    let mut statistics = DeviationStatistics::default();
    for chain in &subdivided {
        measure(inner, chain, options, &mut statistics, out);
    }
    statistics
}

/// A point of the file that no triangle uses is no vertex.
fn report_lost_points(
    inner: &Inner<'_>,
    vertices: &[u32],
    concerned: &mut BTreeSet<u32>,
    out: &mut Collector<'_>,
) {
    for &point in &inner.region.isolated {
        let vertex = vertices[point as usize];
        match inner.sound.used.get(vertex as usize) {
            Some(true) => continue,
            Some(false) => drop(concerned.insert(vertex)),
            None => {}
        }
        out.add(Id::PointLost, || {
            let [x, y] = inner.region.points[point as usize];
            let text =
                format!("point {point} of the domain, ({x:?}, {y:?}), is no vertex of the mesh");
            Draft::new(Id::PointLost, text).domain([domain::place(inner.domain, &[point], None)])
        });
    }
}

fn lost_constraint(inner: &Inner<'_>, edge: &DomainEdge) -> Draft {
    let show = |p: u32| {
        let [x, y] = inner.region.points[p as usize];
        format!("({x:?}, {y:?})")
    };
    let text = format!(
        "the constraint from {} to {} ({}) is not a chain of mesh edges",
        show(edge.from),
        show(edge.to),
        show_source(edge.source)
    );
    let place = domain::place(inner.domain, &[edge.from, edge.to], Some(edge.source));
    Draft::new(Id::ConstraintLost, text).domain([place])
}

/// The constraints that further nodes subdivide, and those that are no chain of edges.
fn follow_constraints(inner: &Inner<'_>, vertices: &[u32]) -> (Vec<Subdivided>, Vec<DomainEdge>) {
    let (mut chains, mut lost) = (Vec::new(), Vec::new());
    if inner.region.constraints.is_empty() {
        return (chains, lost);
    }
    let mut stars = Stars::new(inner);
    for &edge in &inner.region.constraints {
        let ends = [edge.from, edge.to].map(|p| vertices[p as usize]);
        match stars.follow(ends) {
            Some(nodes) if nodes.is_empty() => {}
            Some(nodes) => chains.push(Subdivided { edge, nodes }),
            None => lost.push(edge),
        }
    }
    (chains, lost)
}

/// The neighbours of vertices, read off the triangles once for all vertices.
struct Stars<'a> {
    inner: &'a Inner<'a>,
    /// Where each vertex's neighbours end.
    ends: Vec<u32>,
    neighbours: Vec<u32>,
    /// Points of the domain that are vertices: a chain does not pass through them.
    corners: BTreeSet<u32>,
}

impl<'a> Stars<'a> {
    fn new(inner: &'a Inner<'a>) -> Self {
        let triangles = &inner.sound.triangles;
        let mut ends = vec![0u32; inner.sound.mesh.points.len() + 1];
        for &v in triangles.iter().flatten() {
            ends[v as usize + 1] += 2;
        }
        for v in 1..ends.len() {
            ends[v] += ends[v - 1];
        }
        let mut neighbours = vec![0; triangles.len() * 6];
        for &[a, b, c] in triangles.iter() {
            for (v, others) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
                let at = ends[v as usize] as usize;
                neighbours[at..at + 2].copy_from_slice(&others);
                ends[v as usize] += 2;
            }
        }
        ends.pop();
        let corners = domain_vertices(inner.sound, inner.region).into_iter().collect();
        Self { inner, ends, neighbours, corners }
    }

    fn at(&self, vertex: u32) -> P2 {
        self.inner.plane.point(vertex)
    }

    fn of(&self, vertex: u32) -> &[u32] {
        let start = if vertex == 0 { 0 } else { self.ends[vertex as usize - 1] };
        &self.neighbours[start as usize..self.ends[vertex as usize] as usize]
    }

    /// Nodes of a chain of mesh edges between two vertices along the segment between them; the
    /// nearest neighbour to the segment that advances comes next.
    fn follow(&mut self, [from, to]: [u32; 2]) -> Option<Vec<u32>> {
        let count = self.inner.sound.mesh.points.len();
        if from as usize >= count || to as usize >= count {
            return None;
        }
        let mut nodes: Vec<u32> = Vec::new();
        let mut last: Option<Along> = None;
        loop {
            let current = nodes.last().copied().unwrap_or(from);
            if self.of(current).contains(&to) {
                return Some(nodes);
            }
            let mut best: BTreeMap<(u64, u32), Along> = BTreeMap::new();
            for &v in self.of(current).iter().filter(|v| !self.corners.contains(v)) {
                let along = Along::new(self.at(from), self.at(to), self.at(v));
                let advances = last.as_ref().is_none_or(|l| l.is_before(&along));
                if advances && along.is_between() && along.is_near() {
                    // Non-negative floats order like their bits.
                    best.insert((along.deviation().0.to_bits(), v), along);
                }
            }
            let ((_, v), along) = best.into_iter().next()?;
            nodes.push(v);
            last = Some(along);
        }
    }
}

/// Checks M19 for one chain: a finding names its farthest node.
fn measure(
    inner: &Inner<'_>,
    chain: &Subdivided,
    options: &CheckOptions,
    statistics: &mut DeviationStatistics,
    out: &mut Collector<'_>,
) {
    let [from, to] = [chain.edge.from, chain.edge.to].map(|p| inner.region.points[p as usize]);
    let (mut worst, mut within) = ((0.0, 0.0, chain.nodes[0]), true);
    for &node in &chain.nodes {
        let along = Along::new(from, to, inner.plane.point(node));
        let (length, ulps) = along.deviation();
        if length > worst.0 {
            worst = (length, ulps, node);
        }
        within &= match options.deviation_length {
            Some(limit) => along.within_length(limit),
            None => along.within_ulps(options.deviation_ulps),
        };
    }
    statistics.subdivided_segments += 1;
    statistics.nodes += chain.nodes.len() as u64;
    statistics.length_max = statistics.length_max.max(worst.0);
    statistics.ulps_max = statistics.ulps_max.max(worst.1);
    if within {
        return;
    }
    out.add(Id::Deviation, || {
        let (length, ulps, node) = worst;
        let text = format!(
            "vertex {} lies {length:e} ({ulps:.1} ulps) beside {}",
            show_vertex(inner.sound.mesh, node),
            show_source(chain.edge.source)
        );
        let points = [chain.edge.from, chain.edge.to];
        Draft::new(Id::Deviation, text)
            .vertices([node])
            .domain([domain::place(inner.domain, &points, Some(chain.edge.source))])
            .measured("length", length)
            .measured("ulps", ulps)
    });
}
