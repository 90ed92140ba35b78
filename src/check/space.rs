//! Surfaces in space: manifold, consistently oriented, closed if demanded, free of degenerate
//! triangles and of self-intersections (SPEC 9).

mod intersect;
mod join;

use super::edges::{Edges, Irregular, NONE};
use super::id::Id;
use super::plane::{Run, measure_quality, report_unused};
use super::quality::measure;
use super::report::{Collector, Draft, show_triangle, show_vertex};
use super::structure::{self, Sound};
use super::topology;
use intersect::Space;
use std::collections::{BTreeMap, BTreeSet};

/// Ids that only a plane mesh can have.
const PLANE_ONLY: [Id; 14] = [
    Id::Clockwise,
    Id::MixedOrientation,
    Id::Inverted,
    Id::HangingNode,
    Id::Overlap,
    Id::Uncovered,
    Id::Outside,
    Id::BoundaryLost,
    Id::Deviation,
    Id::ConstraintLost,
    Id::PointLost,
    Id::NotDelaunay,
    Id::NotConstrainedDelaunay,
    Id::NotClosed,
];

/// Checks a surface.
pub(super) fn check(run: &mut Run<'_>) {
    let mesh = run.mesh;
    let plane_only = &PLANE_ONLY[..PLANE_ONLY.len() - usize::from(run.options.closed)];
    run.skip(plane_only, "the mesh is a surface in space");
    if !run.options.closed {
        run.skip(&[Id::NotClosed], "not asked for");
    }
    if run.options.delaunay || run.options.constrained_delaunay {
        run.could_not_run.push("the Delaunay property is not checked in space".to_owned());
    }
    let mut sound = structure::survey(mesh, &mut run.out);
    let edges = build_edges(&mut sound, &mut run.out);
    let space = Space::new(mesh);
    let flat = report_degenerate(&space, &sound, &mut run.out);
    topology::report_crowded_edges(&sound, &edges, &mut run.out);
    topology::report_marked_edges(&sound, &mut run.out);
    report_orientation(&sound, &edges, &mut run.out);
    let parts = topology::survey(&sound, &edges);
    let apart = run.options.crossing_parts.then_some(&parts);
    report_pinches(&sound, &edges, apart, &mut run.out);
    parts.describe(&edges, &mut run.statistics);
    if run.options.closed && run.statistics.boundary_edges > 0 {
        let (count, loops) = (run.statistics.boundary_edges, run.statistics.boundary_loops);
        let text = format!("the surface has {count} boundary edges in {loops} loops");
        let ends = edges.chain.iter().take(8).flat_map(|e| [e.from, e.to]);
        run.out.add(Id::NotClosed, || Draft::new(Id::NotClosed, text).vertices(ends));
    }
    let (tests, mut pairs) = join::intersecting_pairs(&space, &sound.triangles, &flat);
    if run.options.crossing_parts {
        pairs.retain(|&pair| parts.are_one(pair));
    }
    run.statistics.intersection_tests = Some(tests);
    report_intersections(&sound, &edges, (&pairs, &flat), &mut run.out);
    report_unused(run, &sound, &BTreeSet::new());
    measure_quality(run, &sound, &edges.twin, |t| {
        measure(t.map(|v| mesh.points[v as usize]), None)
    });
}

/// The adjacency once duplicate triangles are left out.
fn build_edges(sound: &mut Sound<'_>, out: &mut Collector<'_>) -> Edges {
    let edges = Edges::of(&sound.triangles, sound.mesh.points.len());
    let copies = topology::report_duplicates(sound, &edges, |_| false, out);
    if copies.is_empty() {
        return edges;
    }
    sound.remove(&copies);
    Edges::of(&sound.triangles, sound.mesh.points.len())
}

/// Reports M8; gives the triangles without area, sorted.
fn report_degenerate(space: &Space<'_>, sound: &Sound<'_>, out: &mut Collector<'_>) -> Vec<u32> {
    let flat = space.degenerate(&sound.triangles);
    for &t in &flat {
        out.add(Id::ZeroArea, || {
            let corners = sound.triangles[t as usize];
            let [a, b, c] = corners.map(|v| show_vertex(sound.mesh, v));
            let number = show_triangle(sound.mesh, sound.origin(t));
            let text = format!(
                "triangle {number} has no area: its corners {a}, {b} and {c} lie on a line"
            );
            Draft::new(Id::ZeroArea, text).triangles([sound.origin(t)]).vertices(corners)
        });
    }
    flat
}

/// Two triangles that run along their common edge in the same direction.
fn same_way(edge: &Irregular) -> Option<[u32; 2]> {
    match (edge.forward.as_slice(), edge.backward.as_slice()) {
        (&[a, b], []) | ([], &[a, b]) => Some([a, b]),
        _ => None,
    }
}

/// Reports M26, once for each part of the surface.
///
/// Neighbours that run along their edge in opposite directions agree, others do not. A flood gives
/// every triangle of a part a side; where it contradicts itself the part has only one side.
fn report_orientation(sound: &Sound<'_>, edges: &Edges, out: &mut Collector<'_>) {
    let pairs: Vec<[u32; 2]> = edges.irregular.iter().filter_map(same_way).collect();
    if pairs.is_empty() {
        return;
    }
    let mut disagreeing: Vec<(u32, u32)> =
        pairs.iter().flat_map(|&[a, b]| [(a, b), (b, a)]).collect();
    disagreeing.sort_unstable();
    let mut sides = vec![0i8; sound.triangles.len()];
    for &[seed, _] in &pairs {
        if sides[seed as usize] == 0 {
            let part = flood_sides(seed, edges, &disagreeing, &mut sides);
            report_part(sound, &part, &sides, out);
        }
    }
}

/// A part of a surface and whether it has two sides.
struct SidedPart {
    triangles: Vec<u32>,
    contradiction: Option<u32>,
}

fn flood_sides(
    seed: u32,
    edges: &Edges,
    disagreeing: &[(u32, u32)],
    sides: &mut [i8],
) -> SidedPart {
    let mut part = SidedPart { triangles: vec![seed], contradiction: None };
    sides[seed as usize] = 1;
    let mut next = 0;
    while next < part.triangles.len() {
        let t = part.triangles[next];
        next += 1;
        let twins = edges.twin[3 * t as usize..3 * t as usize + 3].iter();
        let agreeing = twins.filter(|&&h| h != NONE).map(|h| (h / 3, 1));
        let start = disagreeing.partition_point(|pair| pair.0 < t);
        let others = disagreeing[start..].iter().take_while(|pair| pair.0 == t);
        for (u, sign) in agreeing.chain(others.map(|pair| (pair.1, -1))) {
            let wanted = sides[t as usize] * sign;
            match sides[u as usize] {
                0 => {
                    sides[u as usize] = wanted;
                    part.triangles.push(u);
                }
                side if side != wanted => part.contradiction = part.contradiction.or(Some(u)),
                _ => {}
            }
        }
    }
    part
}

fn report_part(sound: &Sound<'_>, part: &SidedPart, sides: &[i8], out: &mut Collector<'_>) {
    const NAMED: usize = 10;
    out.add(Id::SurfaceOrientation, || {
        if let Some(t) = part.contradiction {
            let text = format!("a part of {} triangles has only one side", part.triangles.len());
            return Draft::new(Id::SurfaceOrientation, text).triangles([sound.origin(t)]);
        }
        let of_side = |side: i8| {
            let mut list: Vec<u32> =
                part.triangles.iter().copied().filter(|&t| sides[t as usize] == side).collect();
            list.sort_unstable();
            list
        };
        let (one, other) = (of_side(1), of_side(-1));
        let odd = if other.len() <= one.len() { other } else { one };
        let text = format!(
            "{} of the {} triangles connected with triangle {} face the other side",
            odd.len(),
            part.triangles.len(),
            show_triangle(sound.mesh, sound.origin(odd[0]))
        );
        Draft::new(Id::SurfaceOrientation, text)
            .triangles(odd.iter().take(NAMED).map(|&t| sound.origin(t)))
            .measured("triangles", odd.len() as f64)
    });
}

/// Reports M13: vertices whose triangles are more than one fan; fans of different parts may meet
/// where `apart` says what the parts are.
fn report_pinches(
    sound: &Sound<'_>,
    edges: &Edges,
    apart: Option<&topology::Parts>,
    out: &mut Collector<'_>,
) {
    let explained: BTreeSet<u32> = edges
        .irregular
        .iter()
        .flat_map(|e| e.vertices)
        .chain(sound.dropped.iter().flatten().copied())
        .collect();
    let fans = count_fans(sound, edges, apart);
    for (v, &count) in
        (0u32..).zip(&fans).filter(|(v, count)| **count > 1 && !explained.contains(v))
    {
        out.add(Id::BowTie, || {
            let text = format!(
                "{count} parts of the surface hang together by vertex {}",
                show_vertex(sound.mesh, v)
            );
            Draft::new(Id::BowTie, text).vertices([v])
        });
    }
}

/// How many fans of edge-connected triangles each vertex has.
///
/// Corner h of a triangle is the start of half-edge h. The next corner counterclockwise around the
/// vertex starts the twin of the edge that arrives there.
fn count_fans(sound: &Sound<'_>, edges: &Edges, apart: Option<&topology::Parts>) -> Vec<u32> {
    let arriving = |h: u32| h - h % 3 + (h + 2) % 3;
    let leaving = |h: u32| h - h % 3 + (h + 1) % 3;
    let ahead = |h: u32| edges.twin[arriving(h) as usize];
    let behind = |h: u32| match edges.twin[h as usize] {
        NONE => NONE,
        twin => leaving(twin),
    };
    let corners = 3 * sound.triangles.len() as u32;
    let mut seen = vec![false; corners as usize];
    let mut fans = vec![0u32; sound.mesh.points.len()];
    let mut seen_in = BTreeSet::new();
    for start in 0..corners {
        if seen[start as usize] {
            continue;
        }
        let v = sound.triangles[(start / 3) as usize][(start % 3) as usize];
        let mut is_new = |parts: &topology::Parts| seen_in.insert((v, parts.of(start / 3)));
        let is_apart = apart.is_some_and(&mut is_new);
        if fans[v as usize] == 0 || !is_apart {
            fans[v as usize] += 1;
        }
        for step in [&ahead as &dyn Fn(u32) -> u32, &behind] {
            let mut h = start;
            while h != NONE && (h == start || !seen[h as usize]) {
                seen[h as usize] = true;
                h = step(h);
                if h == start {
                    break;
                }
            }
        }
    }
    fans
}

/// Reports M27, but for triangles around an edge of more than two triangles, and for neighbours of
/// one and the same triangle without area: those touch because it has none.
fn report_intersections(
    sound: &Sound<'_>,
    edges: &Edges,
    (pairs, flat): (&[[u32; 2]], &[u32]),
    out: &mut Collector<'_>,
) {
    let crowded: Vec<&Irregular> =
        edges.irregular.iter().filter(|e| e.forward.len() + e.backward.len() > 2).collect();
    let ends = |corners: [u32; 3], i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % 3]);
        [a.min(b), a.max(b)]
    };
    let mut flat_at: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    for &t in flat {
        let corners = sound.triangles[t as usize];
        (0..3).for_each(|i| flat_at.entry(ends(corners, i)).or_default().push(t));
    }
    let flat_at = &flat_at;
    let flat_neighbours = |t: u32| {
        let corners = sound.triangles[t as usize];
        let lists = (0..3).filter_map(move |i| flat_at.get(&ends(corners, i)));
        lists.flatten().copied().collect::<BTreeSet<u32>>()
    };
    for &pair in pairs {
        let around = |e: &&Irregular| pair.iter().all(|&t| e.triangles().any(|u| u == t));
        let [s, t] = pair.map(&flat_neighbours);
        if crowded.iter().any(around) || !s.is_disjoint(&t) {
            continue;
        }
        out.add(Id::SelfIntersection, || {
            let triangles = pair.map(|t| sound.origin(t));
            let [a, b] = triangles.map(|t| show_triangle(sound.mesh, t));
            let corner = sound.triangles[pair[0] as usize][0];
            let near = show_vertex(sound.mesh, corner);
            let text = format!("triangles {a} and {b} intersect, near {near}");
            Draft::new(Id::SelfIntersection, text).triangles(triangles).vertices([corner])
        });
    }
}
