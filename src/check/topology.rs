//! What follows from adjacency alone: duplicate triangles, edges of more than two triangles, bow
//! ties, parts and loops.

use super::chain::Groups;
use super::coverage::Covered;
use super::edges::{Edges, NONE};
use super::id::Id;
use super::report::{Collector, Draft, Statistics, show_triangle, show_vertex};
use super::structure::Sound;
use std::collections::{BTreeMap, BTreeSet};

/// Reports M7; gives the copies to leave out, sorted. Of each set one stays: the first that is not
/// `reversed`, if there is one.
///
/// A triangle and its copy share three edges, and each of them is irregular: two run the same way,
/// or, if one copy is reversed and has no other neighbours, all three are shared in pairs.
pub(super) fn report_duplicates(
    sound: &Sound<'_>,
    edges: &Edges,
    reversed: impl Fn(u32) -> bool,
    out: &mut Collector<'_>,
) -> Vec<u32> {
    let crowded = edges.irregular.iter().flat_map(super::edges::Irregular::triangles);
    let mut candidates: Vec<u32> = crowded.collect();
    let glued = |t: &u32| {
        let at = 3 * *t as usize;
        let twins = &edges.twin[at..at + 3];
        twins[0] != NONE && twins.iter().all(|&h| h != NONE && h / 3 == twins[0] / 3)
    };
    candidates.extend((0..sound.triangles.len() as u32).filter(glued));
    candidates.sort_unstable();
    candidates.dedup();
    let mut sets: BTreeMap<[u32; 3], Vec<u32>> = BTreeMap::new();
    for t in candidates {
        let mut corners = sound.triangles[t as usize];
        corners.sort_unstable();
        sets.entry(corners).or_default().push(t);
    }
    let mut copies = Vec::new();
    for set in sets.values().filter(|set| set.len() > 1) {
        let kept = set.iter().copied().find(|&t| !reversed(t)).unwrap_or(set[0]);
        copies.extend(set.iter().filter(|&&t| t != kept).map(|&t| (t, kept)));
    }
    copies.sort_unstable();
    for &(copy, kept) in &copies {
        out.add(Id::DuplicateTriangle, || duplicate(sound, [kept, copy]));
    }
    copies.into_iter().map(|pair| pair.0).collect()
}

fn duplicate(sound: &Sound<'_>, pair: [u32; 2]) -> Draft {
    let [first, again] = pair.map(|t| sound.origin(t));
    let text = format!(
        "triangle {} has the same corners as triangle {}",
        show_triangle(sound.mesh, again),
        show_triangle(sound.mesh, first)
    );
    Draft::new(Id::DuplicateTriangle, text)
        .triangles([first, again])
        .vertices(sound.triangles[pair[0] as usize])
}

/// Reports M12.
pub(super) fn report_crowded_edges(sound: &Sound<'_>, edges: &Edges, out: &mut Collector<'_>) {
    for edge in &edges.irregular {
        let count = edge.forward.len() + edge.backward.len();
        if count <= 2 {
            continue;
        }
        out.add(Id::NonManifoldEdge, || {
            let [a, b] = edge.vertices.map(|v| show_vertex(sound.mesh, v));
            let text = format!("{count} triangles share the edge from {a} to {b}");
            let triangles = edge.triangles().map(|t| sound.origin(t));
            Draft::new(Id::NonManifoldEdge, text)
                .triangles(triangles.take(16))
                .vertices(edge.vertices)
                .measured("triangles", count as f64)
        });
    }
}

/// Reports M22: marked edges of the file that no triangle has.
pub(super) fn report_marked_edges(sound: &Sound<'_>, out: &mut Collector<'_>) {
    let mesh = sound.mesh;
    let exists = |v: u32| (v as usize) < mesh.points.len();
    let given = mesh.edges.iter().map(|e| e.vertices).filter(|e| e.iter().all(|&v| exists(v)));
    let sorted = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    let mut missing: BTreeSet<[u32; 2]> =
        given.map(|e| sorted(e.map(|v| sound.vertex(v)))).collect();
    if missing.is_empty() {
        return;
    }
    let mut ends = vec![false; mesh.points.len()];
    missing.iter().flatten().for_each(|&v| ends[v as usize] = true);
    let known =
        sound.dropped.iter().map(|t| t.map(|v| if exists(v) { sound.vertex(v) } else { v }));
    for [a, b, c] in sound.triangles.iter().copied().chain(known) {
        for edge in [[a, b], [b, c], [c, a]] {
            if edge.iter().all(|&v| exists(v) && ends[v as usize]) {
                missing.remove(&sorted(edge));
            }
        }
    }
    for edge in missing {
        out.add(Id::MarkedEdge, || {
            let [a, b] = edge.map(|v| show_vertex(mesh, v));
            let text = format!("the marked edge from {a} to {b} is no edge of a triangle");
            Draft::new(Id::MarkedEdge, text).vertices(edge)
        });
    }
}

/// Parts connected through edges, and counts.
pub(super) struct Parts {
    /// The part of each triangle, when there is more than one.
    of_triangle: Option<Vec<u32>>,
    components: u64,
    vertices: u64,
    boundary_edges: u64,
    boundary_loops: u64,
    triangles: u64,
}

impl Parts {
    /// The part of a triangle.
    pub(super) fn of(&self, t: u32) -> u32 {
        self.of_triangle.as_ref().map_or(0, |labels| labels[t as usize])
    }

    /// Whether two triangles hang together.
    pub(super) fn are_one(&self, [a, b]: [u32; 2]) -> bool {
        self.of(a) == self.of(b)
    }
}

/// Counts parts, vertices and boundary loops.
pub(super) fn survey(sound: &Sound<'_>, edges: &Edges) -> Parts {
    let triangles = sound.triangles.len();
    let (labels, components) = label(triangles, &edges.twin);
    let mut used = vec![false; sound.mesh.points.len()];
    sound.triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
    Parts {
        of_triangle: (components > 1).then_some(labels),
        components,
        vertices: used.iter().filter(|&&u| u).count() as u64,
        boundary_edges: boundary(edges).count() as u64,
        boundary_loops: count_loops(&sound.triangles, edges),
        triangles: triangles as u64,
    }
}

/// The part of each triangle, numbered by their first triangles.
///
/// Union-find in which the lower index is the root: neighbours are mostly near in memory, so one pass
/// in order beats a flood, which jumps.
fn label(triangles: usize, twin: &[u32]) -> (Vec<u32>, u64) {
    let mut labels: Vec<u32> = (0..triangles as u32).collect();
    for (t, twins) in (0u32..).zip(twin.chunks_exact(3)) {
        for &half_edge in twins {
            // Each pair of neighbours once; NONE / 3 is above every index.
            if half_edge / 3 < t {
                join(&mut labels, half_edge / 3, t);
            }
        }
    }
    let mut parts = 0;
    for t in 0..triangles {
        let parent = labels[t] as usize;
        labels[t] = if parent == t {
            parts += 1;
            parts - 1
        } else {
            labels[parent]
        };
    }
    (labels, u64::from(parts))
}

/// Joins the sets of two triangles.
fn join(parents: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b) as usize] = a.min(b);
}

/// The lowest triangle of a set; halves the way to it (Tarjan, van Leeuwen 1984).
fn root(parents: &mut [u32], mut t: u32) -> u32 {
    loop {
        let parent = parents[t as usize];
        if parent == t {
            return t;
        }
        let above = parents[parent as usize];
        parents[t as usize] = above;
        t = above;
    }
}

/// The edges of one triangle: those of the chain that are not irregular.
fn boundary(edges: &Edges) -> impl Iterator<Item = &super::edges::ChainEdge> {
    let irregular: BTreeSet<[u32; 2]> = edges.irregular.iter().map(|e| e.vertices).collect();
    let ends = |e: &super::edges::ChainEdge| [e.from.min(e.to), e.from.max(e.to)];
    edges.chain.iter().filter(move |e| !irregular.contains(&ends(e)))
}

/// Closed chains of boundary edges, each followed around the fan at its vertices: where loops touch
/// at a vertex, each stays a loop of its own.
fn count_loops(triangles: &[[u32; 3]], edges: &Edges) -> u64 {
    let next = |h: u32| h - h % 3 + (h + 1) % 3;
    let half_edge = |e: &super::edges::ChainEdge| {
        let at = triangles[e.triangle as usize].iter().position(|&v| v == e.from)?;
        Some(3 * e.triangle + at as u32)
    };
    let starts: Vec<u32> = boundary(edges).filter_map(half_edge).collect();
    let position: BTreeMap<u32, usize> = starts.iter().enumerate().map(|(i, &h)| (h, i)).collect();
    let mut groups = Groups::new(starts.len());
    for (i, &start) in starts.iter().enumerate() {
        let mut half_edge = next(start);
        while edges.twin[half_edge as usize] != NONE {
            half_edge = next(edges.twin[half_edge as usize]);
        }
        if let Some(&j) = position.get(&half_edge) {
            groups.join(i, j);
        }
    }
    groups.numbers().iter().max().map_or(0, |&m| m as u64 + 1)
}

impl Parts {
    /// Writes the counts.
    pub(super) fn describe(&self, edges: &Edges, statistics: &mut Statistics) {
        statistics.vertices_used = self.vertices;
        statistics.edges = edges.count;
        statistics.boundary_edges = self.boundary_edges;
        statistics.boundary_loops = self.boundary_loops;
        statistics.components = self.components;
        statistics.euler = self.vertices as i64 - edges.count as i64 + self.triangles as i64;
    }
}

/// Reports M13: a vertex by which alone parts of the mesh hang together.
///
/// Loops that touch at a vertex of one and the same part are no bow tie: that is how holes touch.
pub(super) fn report_bow_ties(
    covered: &Covered<'_>,
    parts: &Parts,
    concerned: &BTreeSet<u32>,
    out: &mut Collector<'_>,
) {
    let Some(labels) = &parts.of_triangle else { return };
    let (sound, edges) = (covered.sound, covered.edges);
    // Where something else is wrong, parts may hang together by a vertex because of it.
    let mut explained = concerned.clone();
    explained.extend(sound.dropped.iter().flatten());
    explained.extend(edges.irregular.iter().flat_map(|e| e.vertices));
    let mut joints: BTreeMap<u32, BTreeMap<u32, u32>> = BTreeMap::new();
    for edge in &edges.chain {
        let part = labels[edge.triangle as usize];
        joints.entry(edge.from).or_default().entry(part).or_insert(edge.triangle);
    }
    for (vertex, fans) in joints {
        if fans.len() < 2 || explained.contains(&vertex) {
            continue;
        }
        out.add(Id::BowTie, || {
            let text = format!(
                "{} parts of the mesh hang together by vertex {} only",
                fans.len(),
                show_vertex(sound.mesh, vertex)
            );
            let triangles = fans.values().map(|&t| sound.origin(t));
            Draft::new(Id::BowTie, text).triangles(triangles.take(16)).vertices([vertex])
        });
    }
}
