//! Every fault of a domain at once, and the sound domain as a planar linear complex.
//!
//! All decisions are exact. One sweep over the sorted points splits edges at the vertices on them
//! and finds whether any two cross or overlap; the faces of the resulting planar graph then say what
//! lies inside what. A domain without faults takes O((n + k) log n) time for n points and edges and
//! k splits, whatever the lengths and directions of its edges.
//!
//! A fault that only follows from another is not named again: a loop whose own shape is broken is
//! left out when nesting is judged, and whether anything is inside is asked only of sound loops.

mod conflict;
mod faces;
mod fault;
mod graph;
mod local;
mod nesting;
mod orientation;
mod passes;
mod status;
mod sweep;

pub use fault::{EdgeRef, Fault, LoopRef, Owner, SeedKind, SeedRef, VertexRef};
pub use orientation::loop_orientation;

use crate::domain::{Domain, Inside, Place, Region};
use crate::point::Point2;
use conflict::{Conflicts, Meeting, conflicts};
use faces::{Faces, Stars, UNBOUNDED, face_above};
use fault::Name;
use graph::{Edge, NONE};
use local::{Draft, seeds};
use nesting::Nesting;
use passes::{along, crossing_passes};
use std::collections::BTreeSet;
use sweep::{Location, Sweep, sweep};

/// So many crossings and overlaps are listed for any domain before the list may stop.
const LISTED_AT_LEAST: usize = 10_000;

/// A segment of a [`Plc`]: meets other segments at its end points only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlcSegment {
    /// Indices into [`Plc::points`], in the direction of the loop edge or segment it came from.
    pub vertices: [u32; 2],
    /// Marker of the segment it came from.
    pub marker: i32,
    /// Whether it belongs to a loop: under the even-odd rule, crossing it switches inside and
    /// outside. Free segments are interior constraints.
    pub in_loop: bool,
}

/// Which faces of a [`Plc`] are inside.
#[derive(Clone, Debug, PartialEq)]
pub enum PlcInside {
    /// Reached from infinity by crossing an odd number of `in_loop` segments.
    EvenOdd,
    /// Not reached from infinity nor from one of these points without crossing a segment.
    Carve(Vec<Point2>),
}

/// A validated domain: distinct finite points, segments that meet only at shared end points.
#[derive(Clone, Debug, PartialEq)]
pub struct Plc {
    /// Distinct points, in the order in which the domain first lists them.
    pub points: Vec<Point2>,
    /// Marker of each point, that of the first of its equals in the domain; empty or as long as
    /// `points`.
    pub point_markers: Vec<i32>,
    /// Segments; no two share both ends. Those of loops come first, in the order of the domain; an
    /// edge that was split at vertices on it gives several in a row.
    pub segments: Vec<PlcSegment>,
    /// The rule for inside.
    pub inside: PlcInside,
    /// Region seeds.
    pub regions: Vec<Region>,
    /// The index into `points` of each point of the domain.
    pub vertex_of: Vec<u32>,
}

/// Checks a domain against all rules of SPEC 3.
///
/// # Errors
/// All faults, ordered by the rule they break and then as the domain lists things.
///
/// # Complexity
/// O((n + k) log n) for n points and edges and k splits if there are no faults. Otherwise the
/// search for further crossings and overlaps is cut off after work and a number of faults
/// proportional to the input, which is then a fault of its own ([`Fault::ListStopped`]).
///
/// ```
/// use trigrade::domain::Domain;
/// use trigrade::domain::validate::validate;
/// let bow_tie = Domain::of_rings(&[vec![[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]]]);
/// let faults = validate(&bow_tie).unwrap_err();
/// assert_eq!(faults[0].id(), "D8");
/// ```
pub fn validate(domain: &Domain) -> Result<Plc, Vec<Fault>> {
    let mut draft = Draft::new(domain);
    draft.faults.extend(nesting::check_roles(domain));
    let seeds: Vec<SeedRef> = seeds(domain).filter(|seed| seed.at.is_finite()).collect();
    let graph = PlanarGraph::new(&mut draft, &seeds);
    check_inside(&mut draft, &graph, &seeds);
    if draft.faults.is_empty() {
        return Ok(plc(&draft, &graph));
    }
    let mut faults = draft.faults;
    faults.sort_by_key(|fault| fault.id()[1..].parse::<u32>().unwrap_or(u32::MAX));
    Err(faults)
}

/// The edges of all loops and segments without a fault in their shape, split where they meet.
struct PlanarGraph {
    edges: Vec<Edge>,
    sweep: Sweep,
    stars: Stars,
}

impl PlanarGraph {
    /// Sweeps until nothing crosses, leaving out what has a fault; names those faults.
    fn new(draft: &mut Draft, seeds: &[SeedRef]) -> Self {
        let limit = LISTED_AT_LEAST + 2 * draft.edges.len();
        let seeds: Vec<Point2> = seeds.iter().map(|seed| seed.at).collect();
        let mut edges = draft.edges.clone();
        loop {
            let ends: Vec<[u32; 2]> = edges.iter().map(|e| [e.left(), e.right()]).collect();
            let sweep = sweep(&draft.ranks.points, &ends, &seeds);
            if sweep.conflicts.is_empty() {
                let stars = Stars::new(&draft.ranks.points, &sweep.pieces);
                let crossing = crossing_passes(&sweep, &stars, &edges, limit);
                if crossing.is_empty() {
                    return Self { edges, sweep, stars };
                }
                for found in &crossing {
                    name_crossing_passes(draft, &edges, *found);
                }
                draft.stop_list(crossing.len() >= limit);
            } else {
                // Each round leaves something out, so there are finitely many.
                for edge in sweep.conflicts.iter().flatten() {
                    draft.mark_bad(edges[*edge as usize].owner);
                }
                name_conflicts(
                    draft,
                    &edges,
                    &conflicts(&draft.ranks.points, &ends, &sweep, limit),
                );
            }
            edges.retain(|edge| draft.is_edge_sound(edge));
        }
    }
}

impl Draft<'_> {
    fn stop_list(&mut self, stop: bool) {
        let conflict = |f: &&Fault| ["D8", "D9"].contains(&f.id());
        if stop && !self.faults.iter().any(|f| f.id() == "D16") {
            let listed = self.faults.iter().filter(conflict).count();
            self.faults.push(Fault::ListStopped { listed });
        }
    }
}

fn name_conflicts(draft: &mut Draft, edges: &[Edge], found: &Conflicts) {
    for &(pair, meeting) in &found.pairs {
        let owners = pair.map(|edge| edges[edge as usize].owner);
        owners.iter().for_each(|&owner| draft.mark_bad(owner));
        let refs = || Box::new(owners.map(|owner| draft.domain.edge_ref(owner)));
        let fault = match meeting {
            Meeting::Crossing => {
                let [e, f] = pair.map(|edge| {
                    edges[edge as usize].ends.map(|rank| draft.ranks.points[rank as usize])
                });
                Fault::Crossing { edges: refs(), near: crossing_point(e, f) }
            }
            Meeting::Overlap(_) if draft.arms.binary_search(&pair).is_ok() => continue,
            Meeting::Overlap(ends) => Fault::Overlap {
                edges: refs(),
                shared: ends.map(|rank| draft.ranks.points[rank as usize]),
            },
        };
        draft.faults.push(fault);
    }
    draft.stop_list(!found.complete);
}

fn name_crossing_passes(draft: &mut Draft, edges: &[Edge], found: passes::CrossingPasses) {
    let owners = found.edges.map(|edge| edges[edge as usize].owner);
    owners.iter().for_each(|&owner| draft.mark_bad(owner));
    let refs = owners.map(|owner| draft.domain.edge_ref(owner));
    let is_at = |v: &&VertexRef| draft.ranks.rank_of[v.index as usize] == found.vertex;
    let listed = || draft.ranks.rank_of.iter().position(|&rank| rank == found.vertex);
    let at_end = refs.iter().flat_map(|edge| &edge.ends).find(is_at).map(|v| v.index);
    let Some(index) = at_end.or_else(|| listed().map(|i| i as u32)) else { return };
    let vertex = draft.domain.vertex_ref(index);
    draft.faults.push(Fault::CrossingAtVertex { vertex, edges: Box::new(refs) });
}

/// Where two edges cross, rounded, for the eyes of the user only.
fn crossing_point([a, b]: [Point2; 2], [c, d]: [Point2; 2]) -> Point2 {
    let cross =
        |p: Point2, q: Point2, r: Point2| (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    let (from, to) = (cross(c, d, a), cross(c, d, b));
    let share = from / (from - to);
    let share = if (0.0..=1.0).contains(&share) { share } else { 0.5 };
    Point2::new(a.x * (1.0 - share) + b.x * share, a.y * (1.0 - share) + b.y * share)
}

/// Checks what the faces decide: claims of nesting, seeds, and whether anything is inside.
fn check_inside(draft: &mut Draft, graph: &PlanarGraph, seeds: &[SeedRef]) {
    let domain = draft.domain;
    let faces = Faces::new(&graph.sweep, &graph.stars);
    let nesting = Nesting::new(domain.loops.len(), &graph.edges, &graph.sweep, &faces);
    let misplaced = nesting::check_claims(domain, &nesting, &draft.bad_loops);
    draft.faults.extend(misplaced);
    let face_of = |location: &Location| match *location {
        Location::OnBoundary => None,
        Location::Above(piece) => {
            Some(face_above(piece).map_or(UNBOUNDED, |h| faces.of_half_edge[h as usize]))
        }
    };
    let located: Vec<Option<u32>> = graph.sweep.located.iter().map(face_of).collect();
    let named = seeds.iter().zip(&located);
    let carved: BTreeSet<u32> = named
        .clone()
        .filter(|(seed, _)| seed.kind == SeedKind::Hole)
        .filter_map(|(_, &face)| face)
        .chain([UNBOUNDED])
        .collect();
    let is_inside = |face: u32| match domain.inside {
        Inside::EvenOdd => nesting.depth[face as usize] % 2 == 1,
        Inside::Carve(_) => !carved.contains(&face),
    };
    let sound = draft.is_sound();
    for (seed, face) in named {
        let outside = |face: u32| match seed.kind {
            SeedKind::Hole => face == UNBOUNDED,
            SeedKind::Region => !is_inside(face),
        };
        match *face {
            None => draft.faults.push(Fault::SeedOnBoundary { seed: seed.clone() }),
            Some(face) if sound && outside(face) => {
                draft.faults.push(Fault::SeedOutside { seed: seed.clone() });
            }
            Some(_) => {}
        }
    }
    if draft.faults.is_empty() && !(0..faces.count as u32).any(is_inside) {
        draft.faults.push(Fault::Empty { place: any_place(domain) });
    }
}

/// A place of the file to point at when the domain as a whole is at fault.
fn any_place(domain: &Domain) -> Place {
    let places = &domain.places;
    let mut lists = [&places.loops, &places.segments, &places.points].into_iter();
    lists.find_map(|list| list.first().cloned()).unwrap_or(Place::Made)
}

fn plc(draft: &Draft, graph: &PlanarGraph) -> Plc {
    let domain = draft.domain;
    let mut plc = Plc {
        points: Vec::with_capacity(draft.ranks.points.len()),
        point_markers: Vec::new(),
        segments: Vec::with_capacity(graph.sweep.pieces.len()),
        inside: match &domain.inside {
            Inside::EvenOdd => PlcInside::EvenOdd,
            Inside::Carve(holes) => PlcInside::Carve(holes.clone()),
        },
        regions: domain.regions.clone(),
        vertex_of: Vec::with_capacity(domain.points.len()),
    };
    let mut index_of = vec![NONE; draft.ranks.points.len()];
    for (i, &rank) in draft.ranks.rank_of.iter().enumerate() {
        let slot = &mut index_of[rank as usize];
        if *slot == NONE {
            *slot = plc.points.len() as u32;
            plc.points.push(domain.points[i]);
            plc.point_markers.extend(domain.point_markers.get(i));
        }
        plc.vertex_of.push(*slot);
    }
    for (e, edge) in graph.edges.iter().enumerate() {
        let (marker, in_loop) = match edge.owner {
            Owner::Loop { index, edge } => (domain.loops[index].markers[edge], true),
            Owner::Segment(index) => (domain.segments[index].marker, false),
        };
        plc.segments.extend(along(&graph.sweep.pieces, &graph.edges, e).into_iter().map(|h| {
            let ends = [h, h ^ 1].map(|h| faces::origin(&graph.sweep.pieces, h));
            PlcSegment { vertices: ends.map(|rank| index_of[rank as usize]), marker, in_loop }
        }));
    }
    plc
}
