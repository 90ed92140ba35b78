//! The domain as the checker sees it, derived from the plain data: its boundary as a cycle of
//! directed edges with the inside on their left, its interior constraints, its isolated points.
//!
//! Nothing is taken over from the mesher's own reading of the domain. Faces are found by an exact
//! sweep; which of them are inside follows from the parity of loops or from the hole points.

use super::exact::{P2, lexicographic, orient2d};
use super::points::PointIndex;
use super::report::DomainPlace;
use super::sweep::{Conflict, Directed, Faces, Side, sweep};
use super::tree::{Bounds, Tree};
use crate::domain::{Domain, Inside, Place};
use std::collections::BTreeSet;

/// Where a segment of the domain comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// A loop, and the position of the segment's first vertex in it.
    Loop(u32, u32),
    /// A free segment.
    Segment(u32),
}

/// A piece of the domain's segments between points that are equal to no other.
#[derive(Clone, Copy, Debug)]
pub(super) struct DomainEdge {
    pub(super) from: u32,
    pub(super) to: u32,
    pub(super) source: Source,
}

/// The domain as a checker needs it.
pub(super) struct Region {
    /// Coordinates of the domain's points.
    pub(super) points: Vec<P2>,
    /// Edges with the inside on their left and the outside on their right.
    pub(super) boundary: Vec<DomainEdge>,
    /// Edges with the inside on both sides.
    pub(super) constraints: Vec<DomainEdge>,
    /// Points inside that no segment uses.
    pub(super) isolated: Vec<u32>,
}

/// Why a domain has no definite inside.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum Fault {
    #[error("{what} of the domain names point {index}; it has {count} points")]
    BadReference { what: String, index: u32, count: usize },
    #[error("point {index} of the domain is not finite")]
    NotFinite { index: usize },
    #[error("{first} and {second} of the domain meet elsewhere than at a common end")]
    Crossing { first: String, second: String },
    #[error("the domain has no inside")]
    Nothing,
}

/// A segment of the domain between canonical points, lexicographically directed.
#[derive(Clone, Copy)]
struct Piece {
    ends: [u32; 2],
    /// Number of loop segments along it: crossing an odd one switches inside and outside.
    loops: u32,
    source: Source,
}

/// Derives the boundary cycle and the constraints.
///
/// O(n log n) for a domain of n segments that meet at common ends only.
pub(super) fn derive(domain: &Domain) -> Result<Region, Fault> {
    let points: Vec<P2> = domain.points.iter().map(|p| [p.x, p.y]).collect();
    if let Some(index) = domain.points.iter().position(|p| !p.is_finite()) {
        return Err(Fault::NotFinite { index });
    }
    let canonical = canonical_points(&points);
    let pieces = pieces(domain, &points, &canonical)?;
    let isolated = isolated_points(&points, &canonical, &pieces);
    let seeds = match &domain.inside {
        Inside::EvenOdd => Vec::new(),
        Inside::Carve(seeds) => {
            seeds.iter().filter(|s| s.is_finite()).map(|p| [p.x, p.y]).collect()
        }
    };
    let table: Vec<P2> = points.iter().copied().chain(seeds).collect();
    let queries: Vec<u32> =
        isolated.iter().copied().chain(points.len() as u32..table.len() as u32).collect();
    let sweep_over = |pieces: &[Piece]| {
        let directed: Vec<Directed> = pieces.iter().map(Piece::directed).collect();
        sweep(&table, &directed, &queries)
    };
    let mut pieces = pieces;
    let faces = match sweep_over(&pieces) {
        Ok(faces) => faces,
        Err(_) => {
            pieces = split(&points, pieces);
            sweep_over(&pieces)
                .map_err(|Conflict([a, b])| crossing(&pieces[a as usize], &pieces[b as usize]))?
        }
    };
    let inside = Inner::of(&domain.inside, &faces, isolated.len());
    let region = assemble(points, &pieces, &isolated, (&faces, &inside));
    if region.boundary.is_empty() { Err(Fault::Nothing) } else { Ok(region) }
}

impl Piece {
    fn directed(&self) -> Directed {
        let weight = i32::from(self.loops % 2 == 1);
        Directed { from: self.ends[0], to: self.ends[1], weight }
    }
}

fn crossing(a: &Piece, b: &Piece) -> Fault {
    Fault::Crossing { first: show_source(a.source), second: show_source(b.source) }
}

pub(super) fn show_source(source: Source) -> String {
    match source {
        Source::Loop(l, i) => format!("segment {i} of loop {l}"),
        Source::Segment(s) => format!("segment {s}"),
    }
}

/// The first of the points with the same coordinates, for every point.
fn canonical_points(points: &[P2]) -> Vec<u32> {
    let (_, pairs) = PointIndex::new(points, |_| true);
    let mut canonical: Vec<u32> = (0..points.len() as u32).collect();
    for (first, again) in pairs {
        canonical[again as usize] = first;
    }
    canonical
}

/// All segments; those along the same two points are one piece.
fn pieces(domain: &Domain, points: &[P2], canonical: &[u32]) -> Result<Vec<Piece>, Fault> {
    let mut raw: Vec<([u32; 2], bool, Source)> = Vec::new();
    for (l, ring) in (0u32..).zip(&domain.loops) {
        let n = ring.vertices.len();
        for (i, &from) in (0u32..).zip(&ring.vertices) {
            raw.push(([from, ring.vertices[(i as usize + 1) % n]], true, Source::Loop(l, i)));
        }
    }
    for (s, segment) in (0u32..).zip(&domain.segments) {
        raw.push((segment.vertices, false, Source::Segment(s)));
    }
    let count = points.len();
    for (ends, _, source) in &mut raw {
        if let Some(&index) = ends.iter().find(|&&v| v as usize >= count) {
            return Err(Fault::BadReference { what: show_source(*source), index, count });
        }
        *ends = ends.map(|v| canonical[v as usize]);
        ends.sort_unstable_by(|&a, &b| lexicographic(points[a as usize], points[b as usize]));
    }
    let piece = |(ends, in_loop, source)| Piece { ends, loops: u32::from(in_loop), source };
    Ok(merge(raw.into_iter().filter(|raw| raw.0[0] != raw.0[1]).map(piece).collect()))
}

/// Makes one piece of those between the same points; the first source stands.
fn merge(mut pieces: Vec<Piece>) -> Vec<Piece> {
    pieces.sort_by_key(|piece| piece.ends);
    let one =
        |group: &[Piece]| Piece { loops: group.iter().map(|piece| piece.loops).sum(), ..group[0] };
    pieces.chunk_by(|a, b| a.ends == b.ends).map(one).collect()
}

/// Splits pieces at the ends of others that lie exactly on them: rings may touch so, and segments
/// may end so.
fn split(points: &[P2], pieces: Vec<Piece>) -> Vec<Piece> {
    let at = |v: u32| points[v as usize];
    let tree = Tree::new(pieces.iter().map(|p| Bounds::around(p.ends.map(at))));
    let mut stops: Vec<Vec<u32>> = vec![Vec::new(); pieces.len()];
    let mut ends: Vec<u32> = pieces.iter().flat_map(|p| p.ends).collect();
    ends.sort_unstable_by(|&a, &b| lexicographic(at(a), at(b)));
    ends.dedup();
    for v in ends {
        tree.visit(&Bounds { low: at(v), high: at(v) }, |i| {
            let [a, b] = pieces[i as usize].ends;
            if a != v && b != v && orient2d(at(a), at(b), at(v)).is_eq() {
                stops[i as usize].push(v);
            }
        });
    }
    let cut = |(piece, stops): (Piece, Vec<u32>)| {
        // Stops come in lexicographic order, as the ends of a piece do.
        let from = std::iter::once(piece.ends[0]).chain(stops.clone());
        let to = stops.into_iter().chain([piece.ends[1]]);
        from.zip(to).map(move |(a, b)| Piece { ends: [a, b], ..piece }).collect::<Vec<_>>()
    };
    merge(pieces.into_iter().zip(stops).flat_map(cut).collect())
}

fn isolated_points(points: &[P2], canonical: &[u32], pieces: &[Piece]) -> Vec<u32> {
    let mut used = vec![false; points.len()];
    pieces.iter().flat_map(|p| p.ends).for_each(|v| used[v as usize] = true);
    (0..points.len() as u32).filter(|&v| canonical[v as usize] == v && !used[v as usize]).collect()
}

/// Which sides are inside.
enum Inner {
    Odd,
    /// All faces but these.
    Except(BTreeSet<u32>),
}

impl Inner {
    fn of(rule: &Inside, faces: &Faces, isolated: usize) -> Self {
        match rule {
            Inside::EvenOdd => Self::Odd,
            Inside::Carve(_) => {
                let seeds = faces.queries[isolated..].iter().flatten().map(|side| side.face);
                Self::Except(seeds.chain([0]).collect())
            }
        }
    }

    fn has(&self, side: Side) -> bool {
        match self {
            Self::Odd => side.winding % 2 != 0,
            Self::Except(outside) => !outside.contains(&side.face),
        }
    }
}

fn assemble(
    points: Vec<P2>,
    pieces: &[Piece],
    isolated: &[u32],
    (faces, inner): (&Faces, &Inner),
) -> Region {
    let (mut boundary, mut constraints) = (Vec::new(), Vec::new());
    for (i, piece) in pieces.iter().enumerate() {
        let [a, b] = piece.ends;
        let edge = |from, to| DomainEdge { from, to, source: piece.source };
        match (inner.has(faces.left[i]), inner.has(faces.right[i])) {
            (true, false) => boundary.push(edge(a, b)),
            (false, true) => boundary.push(edge(b, a)),
            (true, true) => constraints.push(edge(a, b)),
            (false, false) => {}
        }
    }
    let within = |i: usize| faces.queries[i].is_some_and(|side| inner.has(side));
    let isolated = (0..isolated.len()).filter(|&i| within(i)).map(|i| isolated[i]).collect();
    Region { points, boundary, constraints, isolated }
}

/// A place of the domain for a finding.
pub(super) fn place(domain: &Domain, points: &[u32], source: Option<Source>) -> DomainPlace {
    let at = |list: &[Place], i: u32| list.get(i as usize).and_then(show_place);
    let text = match source {
        Some(Source::Loop(l, i)) => {
            let vertex = domain.loops.get(l as usize).and_then(|r| r.vertices.get(i as usize));
            let point = vertex.and_then(|&v| at(&domain.places.points, v));
            at(&domain.places.loops, l).or(point)
        }
        Some(Source::Segment(s)) => at(&domain.places.segments, s),
        None => points.first().and_then(|&p| at(&domain.places.points, p)),
    };
    let coordinates = points.iter().filter_map(|&p| domain.points.get(p as usize));
    DomainPlace {
        points: points.to_vec(),
        coordinates: coordinates.map(|p| [p.x, p.y]).collect(),
        source: text,
    }
}

fn show_place(place: &Place) -> Option<String> {
    match place {
        Place::Made => None,
        known => Some(known.to_string()),
    }
}
