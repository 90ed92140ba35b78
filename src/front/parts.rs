//! A front for each piece of the open region that hangs together: components of the domain, and
//! regions that interior constraints separate. No piece sees another, so they are meshed at the
//! same time, and what comes out does not depend on how many at once.

use super::{Front, FrontError, FrontMesh, FrontOptions, FrontStats, Plane, Start};
use crate::point::Point2;
use crate::size::Hint;
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Told the number of accepted triangles of all pieces every few thousand steps of one; `false` stops the front.
pub type SharedProgress<'a> = &'a mut (dyn FnMut(usize) -> bool + Send);

/// A piece of a start, with numbers of its own.
struct Part {
    start: Start,
    hints: Vec<Hint>,
    /// For each of its points that of the whole.
    vertices: Vec<VertexId>,
    /// For each of its front edges that of the whole.
    edges: Vec<u32>,
}

/// Triangles of the open region by the piece they belong to.
struct Pieces {
    /// For each slot of the region its piece.
    of: Vec<u32>,
    count: u32,
}

const NO_PIECE: u32 = u32::MAX;

impl Pieces {
    /// The pieces in the order of their lexicographically smallest front edges, so that their order
    /// depends on coordinates only.
    fn of(start: &Start) -> Self {
        let mut pieces = Self { of: vec![NO_PIECE; start.region.slot_count()], count: 0 };
        let Some(&first) = start.edges.first() else { return pieces };
        if pieces.flood(&start.region, first.triangle()) == start.region.live_count() {
            return pieces;
        }
        pieces = Self { of: vec![NO_PIECE; start.region.slot_count()], count: 0 };
        let ends = |e: HalfEdgeId| {
            [start.region.origin(e), start.region.dest(e)].map(|v| start.points[v.index()])
        };
        let mut edges = start.edges.clone();
        edges.sort_by(|&e, &f| {
            let ([a, b], [c, d]) = (ends(e), ends(f));
            a.lexicographic(c).then_with(|| b.lexicographic(d))
        });
        for e in edges {
            if pieces.of[e.triangle().index()] == NO_PIECE {
                pieces.flood(&start.region, e.triangle());
            }
        }
        pieces
    }

    /// Makes all that hangs together with a triangle the next piece; returns its size.
    fn flood(&mut self, region: &Triangulation, t: TriangleId) -> usize {
        let piece = self.count;
        self.count += 1;
        self.of[t.index()] = piece;
        let mut todo = vec![t];
        let mut size = 0;
        while let Some(t) = todo.pop() {
            size += 1;
            for u in t.half_edges().into_iter().filter_map(|e| region.twin(e)) {
                let of = &mut self.of[u.triangle().index()];
                if *of == NO_PIECE {
                    *of = piece;
                    todo.push(u.triangle());
                }
            }
        }
        size
    }

    /// The triangles of each piece in the order of their slots.
    fn triangles(&self) -> Vec<Vec<TriangleId>> {
        let mut lists = vec![Vec::new(); self.count as usize];
        for (&piece, t) in self.of.iter().zip(0..) {
            if piece != NO_PIECE {
                lists[piece as usize].push(TriangleId(t));
            }
        }
        lists
    }
}

/// Cuts pieces out of a start.
struct Cutter<'a> {
    start: &'a Start,
    /// For each slot of the region its number in its piece.
    slots: Vec<TriangleId>,
    /// For each point its number in the piece that is being cut.
    numbers: Vec<u32>,
}

impl Cutter<'_> {
    fn part(&mut self, triangles: &[TriangleId]) -> Part {
        let from = &self.start.region;
        let mut region = Triangulation::with_capacity(triangles.len());
        let mut vertices = Vec::new();
        for &t in triangles {
            let corners = from.corners(t).map(|v| {
                let number = &mut self.numbers[v.index()];
                if *number == u32::MAX {
                    *number = vertices.len() as u32;
                    vertices.push(v);
                }
                VertexId(*number)
            });
            let new = region.add(corners);
            region.set_tag(new, from.tag(t));
            self.slots[t.index()] = new;
        }
        let (mut edges, mut half_edges, mut hints) = (Vec::new(), Vec::new(), Vec::new());
        for e in triangles.iter().flat_map(|t| t.half_edges()) {
            let here = self.image(e);
            match from.across(e) {
                Across::Twin(twin) => {
                    region.link(here, self.image(twin));
                    region.set_constrained_side(here, from.is_constrained(e));
                }
                Across::Border(_) => {}
            }
        }
        // Front edges keep the order of the whole.
        let mut borders: Vec<(u32, HalfEdgeId)> = Vec::new();
        for e in triangles.iter().flat_map(|t| t.half_edges()) {
            if let Across::Border(owner) = from.across(e) {
                borders.push((owner, e));
            }
        }
        borders.sort_unstable();
        for (i, &(owner, e)) in (0..).zip(&borders) {
            region.set_border(self.image(e), i);
            half_edges.push(self.image(e));
            hints.push(Hint(e.triangle()));
            edges.push(owner);
        }
        for v in &vertices {
            self.numbers[v.index()] = u32::MAX;
        }
        let points = vertices.iter().map(|v| self.start.points[v.index()]).collect();
        let spacing = vertices.iter().map(|v| self.start.spacing[v.index()]).collect();
        let start = Start { points, region, edges: half_edges, spacing };
        Part { start, hints, vertices, edges }
    }

    fn image(&self, e: HalfEdgeId) -> HalfEdgeId {
        self.slots[e.triangle().index()].half_edge(e.corner() as u32)
    }
}

/// The pieces of a start; one alone is the start itself and is not cut out: `None`.
fn cut(start: &Start) -> Option<Vec<Part>> {
    let pieces = Pieces::of(start);
    if pieces.count < 2 {
        return None;
    }
    let slots = vec![TriangleId(0); start.region.slot_count()];
    let mut cutter = Cutter { start, slots, numbers: vec![u32::MAX; start.points.len()] };
    Some(pieces.triangles().iter().map(|triangles| cutter.part(triangles)).collect())
}

/// What all fronts together have done.
struct Tally<'a> {
    triangles: usize,
    inserted: u64,
    inserted_max: u64,
    progress: SharedProgress<'a>,
    outcome: Result<(), FrontError>,
}

impl Tally<'_> {
    /// More triangles and points; an error when all fronts have to stop.
    fn add(&mut self, triangles: usize, inserted: u64) -> Result<(), FrontError> {
        self.triangles += triangles;
        self.inserted += inserted;
        self.outcome?;
        if self.inserted > self.inserted_max {
            self.outcome = Err(FrontError::Budget(self.inserted_max as usize));
        } else if !(self.progress)(self.triangles) {
            self.outcome = Err(FrontError::Stopped);
        }
        self.outcome
    }
}

/// A part's finished mesh, and its numbers in the whole.
struct Laid {
    mesh: FrontMesh,
    vertices: Vec<VertexId>,
    edges: Vec<u32>,
}

/// Runs the front of one part.
fn lay(
    part: Part,
    plane: &Plane<'_>,
    options: FrontOptions,
    tally: &Mutex<Tally<'_>>,
) -> Result<Laid, FrontError> {
    let Part { start, hints, vertices, edges } = part;
    let (mut triangles, mut inserted) = (0, 0);
    let mut report = |t: usize, n: u64| {
        let mut tally = tally.lock().unwrap_or_else(PoisonError::into_inner);
        let outcome = tally.add(t - triangles, n - inserted);
        (triangles, inserted) = (t, n);
        outcome
    };
    let lifts = vec![(); start.points.len()];
    let front = Front::new(start, hints, lifts, plane, options);
    let (mesh, _) = front.run(&mut report)?;
    report(mesh.mesh.live_count(), mesh.stats.inserted)?;
    Ok(Laid { mesh, vertices, edges })
}

/// Runs a front from `start`, one for each piece; a piece alone has the front it has always had.
///
/// The points of the pieces follow each other in the order of the pieces, and so do their triangles.
pub(super) fn advance(
    start: Start,
    plane: &Plane<'_>,
    options: FrontOptions,
    progress: SharedProgress<'_>,
) -> Result<FrontMesh, FrontError> {
    let Some(parts) = cut(&start) else {
        let lifts = vec![(); start.points.len()];
        return super::advance_on(start, lifts, plane, options, progress).map(|(mesh, _)| mesh);
    };
    let Start { points, spacing, .. } = start;
    let inserted_max = options.vertices_max as u64;
    let tally = Tally { triangles: 0, inserted: 0, inserted_max, progress, outcome: Ok(()) };
    let tally = Mutex::new(tally);
    let lay = |part| lay(part, plane, options, &tally);
    let laid: Vec<Result<Laid, FrontError>> = if plane.field.can_fail() {
        // Which of a function's faults comes first is part of the answer.
        parts.into_iter().map(lay).collect()
    } else {
        parts.into_par_iter().map(lay).collect()
    };
    let laid = laid.into_iter().collect::<Result<Vec<Laid>, _>>()?;
    Ok(glue(points, spacing, laid))
}

/// One mesh of all pieces.
fn glue(mut points: Vec<Point2>, mut spacing: Vec<f64>, laid: Vec<Laid>) -> FrontMesh {
    let count = laid.iter().map(|part| part.mesh.mesh.slot_count()).sum();
    let mut mesh = Triangulation::with_capacity(count);
    let mut stats = FrontStats::default();
    for Laid { mesh: part, vertices, edges } in laid {
        let given = vertices.len();
        let before = (points.len() - given) as u32;
        let number = |v: VertexId| match vertices.get(v.index()) {
            Some(&own) => own,
            None => VertexId(before + v.0),
        };
        mesh.append(&part.mesh, number, |edge| edges[edge as usize]);
        points.extend_from_slice(&part.points[given..]);
        spacing.extend_from_slice(&part.spacing[given..]);
        stats.accepted_existing += part.stats.accepted_existing;
        stats.inserted += part.stats.inserted;
        stats.rejected += part.stats.rejected;
    }
    FrontMesh { points, mesh, spacing, stats }
}
