//! Coverage: whether the triangles cover the domain exactly once (SPEC 9, the coverage theorem).
//!
//! With a domain: the boundary chain of the mesh equals the domain's boundary cycle, edge by edge.
//! Without one: the mesh's own boundary edges meet at vertices only, with winding number 1 on their
//! left and 0 on their right. Both are decided with orientation signs and counting alone. Only when
//! they fail does the slow part start, which finds out why and says it once.

use super::beside::Beside;
use super::chain::{self, Groups, OnEdge};
use super::conform::{self, Match, Residual};
use super::domain::{self, Region, show_source};
use super::edges::{ChainEdge, Edges};
use super::exact::P2;
use super::id::Id;
use super::lattice::Plane;
use super::report::{Collector, DomainPlace, Draft, show_triangle, show_vertex};
use super::structure::Sound;
use super::sweep::{self, Directed};
use super::tree::Tree;
use crate::domain::Domain;
use std::collections::BTreeSet;

/// What the coverage checks work on.
pub(super) struct Covered<'a> {
    pub(super) plane: &'a Plane<'a>,
    pub(super) sound: &'a Sound<'a>,
    pub(super) edges: &'a Edges,
    /// Sorted: triangles folded over, which explain what is wrong around them.
    pub(super) inverted: &'a [u32],
    /// The given domain and what was derived from it.
    pub(super) domain: Option<(&'a Domain, &'a Region)>,
}

/// Samples of the winding number per fault: enough to tell its kind, bounded for rubbish.
const SAMPLES: usize = 64;

impl Covered<'_> {
    /// Coordinates of a vertex of the mesh, or, from the number of points on, of the domain.
    fn at(&self, vertex: u32) -> P2 {
        let count = self.sound.mesh.points.len();
        match (self.domain, (vertex as usize).checked_sub(count)) {
            (Some((_, region)), Some(point)) => region.points[point],
            _ => self.plane.point(vertex),
        }
    }

    fn is_mesh_vertex(&self, vertex: u32) -> bool {
        (vertex as usize) < self.sound.mesh.points.len()
    }

    fn show(&self, vertex: u32) -> String {
        if self.is_mesh_vertex(vertex) {
            return show_vertex(self.sound.mesh, vertex);
        }
        let [x, y] = self.at(vertex);
        format!("({x:?}, {y:?})")
    }

    fn corners(&self, triangle: u32) -> [P2; 3] {
        self.sound.triangles[triangle as usize].map(|v| self.at(v))
    }

    /// Whether another finding explains what is wrong around these vertices: an edge of three
    /// triangles, a folded triangle, or one that had to be left out.
    fn is_explained(&self, vertices: &BTreeSet<u32>) -> bool {
        let has = |v: &u32| vertices.contains(v);
        let crowded = |e: &super::edges::Irregular| {
            e.forward.len() + e.backward.len() > 2 && e.vertices.iter().all(has)
        };
        let two_of = |corners: &[u32; 3]| corners.iter().filter(|&v| has(v)).count() >= 2;
        self.edges.irregular.iter().any(crowded)
            || self.inverted.iter().any(|&t| two_of(&self.sound.triangles[t as usize]))
            || self.sound.dropped.iter().any(|c| two_of(&c.map(|v| self.canonical(v))))
    }

    fn canonical(&self, corner: u32) -> u32 {
        if corner == crate::mesh::NO_POINT { corner } else { self.sound.vertex(corner) }
    }
}

/// Checks M14 to M18; gives the vertices that the findings concern, and the match with the
/// domain.
pub(super) fn check(covered: &Covered<'_>, out: &mut Collector<'_>) -> (BTreeSet<u32>, Match) {
    let chain = &covered.edges.chain;
    let Some((_, region)) = covered.domain else {
        return (own_boundary(covered, chain, out), Match::default());
    };
    let mut matched = conform::match_boundary(&|v| covered.at(v), covered.sound, chain, region);
    let polygon_is_simple = || sweep_chain(covered, chain).is_ok();
    if matched.residual.is_empty() && (matched.subdivided.is_empty() || polygon_is_simple()) {
        return (BTreeSet::new(), matched);
    }
    let mut concerned = BTreeSet::new();
    let split = report_hanging(covered, chain, &mut concerned, out);
    matched = conform::match_boundary(&|v| covered.at(v), covered.sound, &split, region);
    if matched.residual.is_empty() {
        if !matched.subdivided.is_empty() {
            concerned.extend(report_own(covered, &split, out));
        }
        return (concerned, matched);
    }
    concerned.extend(report_residual(covered, &matched, out));
    (concerned, matched)
}

/// The case without a domain.
fn own_boundary(
    covered: &Covered<'_>,
    chain: &[ChainEdge],
    out: &mut Collector<'_>,
) -> BTreeSet<u32> {
    if sweep_chain(covered, chain).is_ok() {
        return BTreeSet::new();
    }
    let mut concerned = BTreeSet::new();
    let split = report_hanging(covered, chain, &mut concerned, out);
    concerned.extend(report_own(covered, &split, out));
    concerned
}

/// Winding numbers left and right of each edge of the chain, if its edges meet at vertices only;
/// `Err` when they do not, or when one is not (1, 0).
fn sweep_chain(covered: &Covered<'_>, chain: &[ChainEdge]) -> Result<(), Option<Vec<bool>>> {
    let vertices = chain::vertices(chain);
    let points: Vec<P2> = vertices.iter().map(|&v| covered.at(v)).collect();
    let index = |v: u32| vertices.partition_point(|&w| w < v) as u32;
    let directed =
        |e: &ChainEdge| Directed { from: index(e.from), to: index(e.to), weight: e.weight };
    let directed: Vec<Directed> = chain.iter().map(directed).collect();
    let faces = sweep::sweep(&points, &directed, &[]).map_err(|_| None)?;
    let good: Vec<bool> = (0..chain.len())
        .map(|i| faces.left[i].winding == 1 && faces.right[i].winding == 0)
        .collect();
    if good.iter().all(|&g| g) { Ok(()) } else { Err(Some(good)) }
}

/// Reports M14 and gives the chain with its edges split at the vertices on them.
fn report_hanging(
    covered: &Covered<'_>,
    chain: &[ChainEdge],
    concerned: &mut BTreeSet<u32>,
    out: &mut Collector<'_>,
) -> Vec<ChainEdge> {
    let at = |v: u32| covered.at(v);
    let on_edges = chain::vertices_on_edges(at, chain);
    if on_edges.is_empty() {
        return chain.to_vec();
    }
    let overlapping = overlapping(covered, chain, &on_edges);
    for (on, overlaps) in on_edges.iter().zip(overlapping) {
        if overlaps {
            continue;
        }
        let edge = &chain[on.edge];
        concerned.extend([on.vertex, edge.from, edge.to]);
        out.add(Id::HangingNode, || {
            let triangle = covered.sound.origin(edge.triangle);
            let text = format!(
                "vertex {} hangs on the edge from {} to {} of triangle {}",
                covered.show(on.vertex),
                covered.show(edge.from),
                covered.show(edge.to),
                show_triangle(covered.sound.mesh, triangle)
            );
            Draft::new(Id::HangingNode, text)
                .triangles([triangle])
                .vertices([on.vertex, edge.from, edge.to])
        });
    }
    chain::split(at, chain, &on_edges)
}

/// Whether a triangle at the vertex reaches to the left of the edge it lies on: then triangles
/// overlap there, and that is the finding.
fn overlapping(covered: &Covered<'_>, chain: &[ChainEdge], on_edges: &[OnEdge]) -> Vec<bool> {
    let mut wanted: Vec<u32> = on_edges.iter().map(|o| o.vertex).collect();
    wanted.sort_unstable();
    wanted.dedup();
    let mut fans: Vec<Vec<u32>> = vec![Vec::new(); wanted.len()];
    for triangle in covered.sound.triangles.iter() {
        for v in triangle {
            if let Ok(at) = wanted.binary_search(v) {
                fans[at].extend(triangle);
            }
        }
    }
    let reaches_left = |on: &OnEdge| {
        let edge = &chain[on.edge];
        let (a, b) = (covered.at(edge.from), covered.at(edge.to));
        let fan = wanted.binary_search(&on.vertex).map(|at| &fans[at]);
        fan.is_ok_and(|f| f.iter().any(|&v| super::exact::orient2d(a, b, covered.at(v)).is_gt()))
    };
    on_edges.iter().map(reaches_left).collect()
}

/// Reports overlaps of a mesh whose own boundary crosses itself or winds wrongly.
fn report_own(
    covered: &Covered<'_>,
    chain: &[ChainEdge],
    out: &mut Collector<'_>,
) -> BTreeSet<u32> {
    let mut good = match sweep_chain(covered, chain) {
        Ok(()) => return BTreeSet::new(),
        Err(Some(good)) => good,
        Err(None) => Vec::new(),
    };
    let ends: Vec<[u32; 2]> = chain.iter().map(|e| [e.from, e.to]).collect();
    let mut groups = chain::connected(&ends);
    let mut witnesses: Vec<Option<[usize; 2]>> = vec![None; chain.len()];
    if good.is_empty() {
        let crossings = crossings(covered, &ends);
        groups = join_crossing(&groups, &crossings);
        good = vec![true; chain.len()];
        for pair in crossings {
            witnesses[groups[pair[0]]].get_or_insert(pair);
        }
        let sane: Vec<usize> =
            (0..chain.len()).filter(|&i| witnesses[groups[i]].is_none()).collect();
        let rest: Vec<ChainEdge> = sane.iter().map(|&i| chain[i]).collect();
        if let Err(Some(rest_good)) = sweep_chain(covered, &rest) {
            sane.iter().zip(rest_good).for_each(|(&i, g)| good[i] = g);
        }
    }
    for (i, _) in good.iter().enumerate().filter(|(_, g)| !**g) {
        witnesses[groups[i]].get_or_insert([i, i]);
    }
    let mut concerned = BTreeSet::new();
    for (group, pair) in witnesses.iter().enumerate() {
        let Some(pair) = pair else { continue };
        let members = (0..chain.len()).filter(|&i| groups[i] == group);
        let vertices: BTreeSet<u32> = members.flat_map(|i| ends[i]).collect();
        if !covered.is_explained(&vertices) {
            out.add(Id::Overlap, || overlap_of_edges(covered, pair.map(|i| chain[i])));
        }
        concerned.extend(vertices);
    }
    concerned
}

/// Every pair of edges that meet elsewhere than at a common end.
fn crossings(covered: &Covered<'_>, ends: &[[u32; 2]]) -> Vec<[usize; 2]> {
    let at = |v: u32| covered.at(v);
    let sorted = |[a, b]: [u32; 2]| {
        if super::exact::lexicographic(at(a), at(b)).is_gt() { [b, a] } else { [a, b] }
    };
    let tree = Tree::new(ends.iter().map(|&e| chain::bounds(at, e)));
    let mut found = Vec::new();
    for (i, &e) in ends.iter().enumerate() {
        tree.visit(&chain::bounds(at, e), |j| {
            let j = j as usize;
            if i < j && sweep::segments_conflict(at, sorted(e), sorted(ends[j])) {
                found.push([i, j]);
            }
        });
    }
    found.sort_unstable();
    found
}

fn join_crossing(groups: &[usize], crossings: &[[usize; 2]]) -> Vec<usize> {
    let mut forest = Groups::new(groups.len());
    let mut first = vec![None; groups.len()];
    for (i, &group) in groups.iter().enumerate() {
        forest.join(i, *first[group].get_or_insert(i));
    }
    crossings.iter().for_each(|&[a, b]| forest.join(a, b));
    forest.numbers()
}

/// The finding for two boundary edges that cross, or for one with a covered right side.
fn overlap_of_edges(covered: &Covered<'_>, [a, b]: [ChainEdge; 2]) -> Draft {
    let other = if a == b { second_cover(covered, &a) } else { Some(b.triangle) };
    overlap(covered, a.triangle, other, [a.from, a.to, b.from, b.to])
}

/// A second triangle over the left or over the right side of an edge, next to its start.
fn second_cover(covered: &Covered<'_>, edge: &ChainEdge) -> Option<u32> {
    let (u, v) = (covered.at(edge.from), covered.at(edge.to));
    [true, false].into_iter().find_map(|left| {
        let q = Beside { u, v, left };
        let over = |t: &u32| *t != edge.triangle && q.is_in(covered.corners(*t));
        (0..covered.sound.triangles.len() as u32).find(over)
    })
}

fn overlap(covered: &Covered<'_>, t: u32, other: Option<u32>, near: [u32; 4]) -> Draft {
    let mesh = covered.sound.mesh;
    let t = covered.sound.origin(t);
    let other = other.map(|o| covered.sound.origin(o));
    let text = match other {
        Some(o) => {
            format!("triangles {} and {} overlap", show_triangle(mesh, t), show_triangle(mesh, o))
        }
        None => format!("triangle {} is overlapped", show_triangle(mesh, t)),
    };
    let text = format!("{text} near {}", covered.show(near[0]));
    let vertices: BTreeSet<u32> = near.into_iter().filter(|&v| covered.is_mesh_vertex(v)).collect();
    Draft::new(Id::Overlap, text).triangles([t].into_iter().chain(other)).vertices(vertices)
}

/// A connected part of the difference between the mesh's boundary and the domain's.
struct Fault<'a> {
    edges: Vec<&'a Residual>,
    vertices: BTreeSet<u32>,
}

/// What was seen of a fault.
#[derive(Default)]
struct Seen {
    uncovered: bool,
    outside: bool,
    overlap: Option<(u32, u32)>,
}

fn report_residual(
    covered: &Covered<'_>,
    matched: &Match,
    out: &mut Collector<'_>,
) -> BTreeSet<u32> {
    let residual = &matched.residual;
    let ends: Vec<[u32; 2]> = residual.iter().map(|e| [e.from, e.to]).collect();
    let groups = chain::connected(&ends);
    let count = groups.iter().max().map_or(0, |g| g + 1);
    let mut faults: Vec<Fault<'_>> =
        (0..count).map(|_| Fault { edges: Vec::new(), vertices: BTreeSet::new() }).collect();
    for (edge, group) in residual.iter().zip(groups) {
        faults[group].edges.push(edge);
        faults[group].vertices.extend([edge.from, edge.to]);
    }
    let mut concerned = BTreeSet::new();
    for fault in &faults {
        if !covered.is_explained(&fault.vertices) {
            let seen = look(covered, matched, fault);
            report_fault(covered, fault, &seen, out);
        }
        concerned.extend(fault.vertices.iter().filter(|&&v| covered.is_mesh_vertex(v)));
    }
    concerned
}

/// Samples the excess of coverage beside the edges of a fault.
///
/// The excess on an edge's left is that on its right plus the edge's weight, so some sample is not
/// zero unless the whole fault has no area.
fn look(covered: &Covered<'_>, matched: &Match, fault: &Fault<'_>) -> Seen {
    let mut seen = Seen::default();
    let step = fault.edges.len().div_ceil(SAMPLES);
    for edge in fault.edges.iter().step_by(step) {
        let (u, v) = (covered.at(edge.from), covered.at(edge.to));
        for left in [true, false] {
            let q = Beside { u, v, left };
            let wind = |e: &&Residual| e.weight * q.winding(covered.at(e.from), covered.at(e.to));
            let excess: i32 = fault.edges.iter().map(wind).sum();
            if excess < 0 {
                seen.uncovered = true;
            } else if excess > 0 {
                match excess + matched.winding_of_domain(q) {
                    1 => seen.outside = true,
                    _ => seen.overlap = seen.overlap.or_else(|| covering_pair(covered, q)),
                }
            }
        }
    }
    seen
}

/// The first two triangles over a point.
fn covering_pair(covered: &Covered<'_>, q: Beside) -> Option<(u32, u32)> {
    let count = covered.sound.triangles.len() as u32;
    let mut over = (0..count).filter(|&t| q.is_in(covered.corners(t)));
    Some((over.next()?, over.next()?))
}

/// One finding a fault: the most specific that explains all of it.
fn report_fault(covered: &Covered<'_>, fault: &Fault<'_>, seen: &Seen, out: &mut Collector<'_>) {
    let vertex_lost = fault.vertices.iter().any(|&v| !covered.is_mesh_vertex(v));
    let first = fault.edges[0];
    if let Some((t, o)) = seen.overlap {
        out.add(Id::Overlap, || {
            overlap(covered, t, Some(o), [first.from, first.to, first.from, first.to])
        });
        return;
    }
    let id = match (seen.uncovered, seen.outside) {
        _ if vertex_lost => Id::BoundaryLost,
        (true, true) => Id::BoundaryLost,
        (true, false) => Id::Uncovered,
        (false, true) => Id::Outside,
        // Without area: the boundary runs along another one, past a vertex.
        (false, false) => Id::BoundaryLost,
    };
    out.add(id, || describe(covered, fault, id));
}

fn describe(covered: &Covered<'_>, fault: &Fault<'_>, id: Id) -> Draft {
    let mesh = covered.sound.mesh;
    let first = covered.show(fault.edges[0].from);
    let triangles: BTreeSet<u32> =
        fault.edges.iter().filter_map(|e| e.triangle).map(|t| covered.sound.origin(t)).collect();
    let number = triangles.first().map_or(0, |&t| show_triangle(mesh, t));
    let text = match id {
        Id::Uncovered => format!("a part of the domain at {first} is not covered"),
        Id::Outside => format!("triangle {number} lies outside the domain"),
        _ => lost_text(covered, fault),
    };
    let doubled = super::along::polygon_area(fault.edges.iter().flat_map(|e| {
        std::iter::repeat_n(
            (covered.at(e.from), covered.at(e.to)),
            e.weight.unsigned_abs() as usize,
        )
    }));
    let (value, exponent) = doubled.value();
    let (f, e) = value.approximate();
    let known = fault.vertices.iter().copied().filter(|&v| covered.is_mesh_vertex(v));
    let listed = 16;
    Draft::new(id, text)
        .triangles(triangles.into_iter().take(listed))
        .vertices(known.take(listed))
        .domain(domain_places(covered, fault).take(listed))
        .measured("excess_area", super::ldexp(f, e + exponent - 1))
}

fn lost_text(covered: &Covered<'_>, fault: &Fault<'_>) -> String {
    let Some((edge, source)) = fault.edges.iter().find_map(|e| e.source.map(|s| (e, s))) else {
        return "the boundary is not preserved".to_owned();
    };
    // The residual runs against the domain's own direction.
    format!(
        "{} from {} to {} is not a chain of mesh edges",
        show_source(source),
        covered.show(edge.to),
        covered.show(edge.from)
    )
}

fn domain_places<'a>(
    covered: &'a Covered<'_>,
    fault: &'a Fault<'_>,
) -> impl Iterator<Item = DomainPlace> + 'a {
    fault.edges.iter().filter_map(|e| {
        let (domain, _) = covered.domain?;
        let points = e.domain_points?;
        Some(domain::place(domain, &points, e.source))
    })
}
