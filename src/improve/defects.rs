//! Removal of defects: vertices inside with more or fewer than six triangles.
//!
//! A pair of vertices with five and seven triangles is a dislocation of the lattice. Flipping an
//! edge moves it along, removing or adding a vertex moves it across, and two that meet vanish. Each
//! such change is tried on a patch, relaxed, and kept only if the patch is better for it.

use super::ImproveStats;
use super::patch::{Change, Cut, Origin, Patch};
use super::energy::inverse_mean_ratio;
use crate::point::Point2;
use crate::triangulation::{HalfEdgeId, Triangulation, VertexId};

/// What a vertex has.
const REGULAR: usize = 6;
/// A regular vertex with a triangle worse than this is tried too.
const BAD: f64 = 1.1;
/// A change must lower the excess of its patch by this much, or it is not worth its disturbance.
const GAIN_MIN: f64 = 2e-3;

/// A change that is so much worse than the best so far after one sweep is given up.
const HOPELESS: f64 = 1.1;
/// Tries changes at the irregular vertices of a mesh.
pub(super) struct Defects<'a> {
    pub(super) mesh: &'a mut Triangulation,
    pub(super) points: &'a mut Vec<Point2>,
    pub(super) spacing: &'a mut Vec<f64>,
    /// Vertices below this index never move.
    pub(super) fixed: usize,
    pub(super) quantum: Option<f64>,
    /// Rings of triangles in a patch.
    pub(super) rings: u32,
    /// A half-edge out of each vertex that is in a triangle.
    outgoing: Vec<Option<HalfEdgeId>>,
    /// Vertices whose surroundings have changed since they were last tried.
    active: Vec<bool>,
    epoch: u32,
    origin: Origin,
    patches: Patches,
}

/// A patch as it is, one under trial, and the best so far.
#[derive(Default)]
struct Patches {
    before: Patch,
    trial: Patch,
    best: Patch,
}

impl<'a> Defects<'a> {
    pub(super) fn new(
        mesh: &'a mut Triangulation,
        points: &'a mut Vec<Point2>,
        spacing: &'a mut Vec<f64>,
        fixed: usize,
        quantum: Option<f64>,
        rings: u32,
    ) -> Self {
        let outgoing = mesh.outgoing(points.len());
        for t in 0..mesh.slot_count() as u32 {
            mesh.set_mark(crate::triangulation::TriangleId(t), 0);
        }
        let active = vec![true; points.len()];
        let (epoch, origin, patches) = (0, Origin::default(), Patches::default());
        Self {
            mesh,
            points,
            spacing,
            fixed,
            quantum,
            rings,
            outgoing,
            active,
            epoch,
            origin,
            patches,
        }
    }

    /// One pass over the irregular vertices and those with bad triangles, worst first; ends when
    /// `budget` changes have been tried, and returns the number of changes kept.
    pub(super) fn pass(&mut self, budget: u64, stats: &mut ImproveStats) -> u64 {
        let mut kept = 0;
        for v in self.worst_first() {
            if stats.tried >= budget {
                break;
            }
            // A change nearby may have taken the vertex away.
            let Some(start) = self.outgoing[v as usize] else { continue };
            if std::mem::take(&mut self.active[v as usize]) {
                let (tried, is_kept) = self.try_at(start);
                stats.tried += u64::from(tried);
                kept += u64::from(is_kept);
            }
        }
        stats.changes += kept;
        kept
    }

    /// Active vertices worth trying, by the worst triangle around them, then by index.
    fn worst_first(&self) -> Vec<u32> {
        let mut found: Vec<(f64, u32)> = Vec::new();
        for v in (self.fixed..self.points.len()).filter(|&v| self.active[v]) {
            let Some(start) = self.outgoing[v] else { continue };
            let worst = self.worst(start);
            if worst > BAD || self.degree(start) != Some(REGULAR) {
                found.push((worst, v as u32));
            }
        }
        found.sort_by(|s, t| t.0.total_cmp(&s.0).then(s.1.cmp(&t.1)));
        found.into_iter().map(|(_, v)| v).collect()
    }

    /// Worst inverse mean ratio around the origin of `e`.
    fn worst(&self, e: HalfEdgeId) -> f64 {
        let shape = |h: HalfEdgeId| {
            let [a, b, c] = self.mesh.corners(h.triangle()).map(|v| self.points[v.index()]);
            inverse_mean_ratio(a, b, c)
        };
        self.mesh.star(e).map(shape).fold(1.0, f64::max)
    }

    /// Number of triangles at the origin of `e`, `None` on a border.
    fn degree(&self, e: HalfEdgeId) -> Option<usize> {
        let mut degree = 0;
        let mut at = e;
        loop {
            degree += 1;
            at = self.mesh.rotate_ccw(at)?;
            if at == e {
                return Some(degree);
            }
        }
    }

    /// How many triangles a vertex has too many; 0 on the border, where none is known to be right.
    fn charge(&self, v: VertexId) -> i32 {
        let degree = self.outgoing[v.index()].and_then(|e| self.degree(e));
        degree.map_or(0, |degree| degree as i32 - REGULAR as i32)
    }

    /// Changes worth trying around a vertex, in the terms of the mesh.
    fn changes(&self, start: HalfEdgeId) -> Vec<Change> {
        let v = self.mesh.origin(start);
        let star: Vec<HalfEdgeId> = self.mesh.star(start).collect();
        let mut changes = Vec::new();
        let own = self.charge(v);
        let is_bad = self.worst(start) > BAD;
        if own < 0 || is_bad {
            changes.push(Change::Remove(v));
        }
        for &e in &star {
            let edges = if own < 0 { e.next() } else { e };
            let Some(twin) = self.mesh.twin(edges) else { continue };
            let [a, b] = [self.mesh.origin(edges), self.mesh.dest(edges)];
            let ends = self.charge(a) + self.charge(b);
            let apexes = self.charge(self.mesh.apex(edges)) + self.charge(self.mesh.apex(twin));
            // A flip takes one triangle from each end and gives one to each apex.
            if ends + 1 > apexes || is_bad {
                changes.push(Change::Flip(a, b));
            }
            if own > 0 && apexes < 0 || is_bad {
                changes.push(Change::Split(a, b));
            }
        }
        changes
    }

    /// Tries the changes around one vertex and keeps the best; returns how many were tried and
    /// whether one was kept.
    fn try_at(&mut self, start: HalfEdgeId) -> (u32, bool) {
        self.epoch += 1;
        let changes = self.changes(start);
        if changes.is_empty() {
            return (0, false);
        }
        let cut = Cut { rings: self.rings, fixed: self.fixed, epoch: self.epoch };
        let Patches { mut before, mut trial, mut best } = std::mem::take(&mut self.patches);
        if !before.cut(self.mesh, self.points, start, cut, &mut self.origin) {
            self.patches = Patches { before, trial, best };
            return (0, false);
        }
        let now = before.worth();
        let mut bound = now.excess - GAIN_MIN;
        let mut tried = 0;
        let mut found = false;
        for change in changes {
            let Some(change) = self.local(change) else { continue };
            trial.assign(&before);
            if !trial.make(change) {
                continue;
            }
            tried += 1;
            trial.relax(self.quantum, HOPELESS * bound);
            let worth = trial.worth();
            if worth.excess < bound && worth.worst <= now.worst {
                bound = worth.excess;
                found = true;
                std::mem::swap(&mut trial, &mut best);
            }
        }
        if found {
            self.keep(&best);
        }
        self.patches = Patches { before, trial, best };
        (tried, found)
    }

    /// A change in the patch's terms.
    fn local(&self, change: Change) -> Option<Change> {
        let local = |v: VertexId| self.origin.place(v, self.epoch);
        Some(match change {
            Change::Flip(a, b) => Change::Flip(local(a)?, local(b)?),
            Change::Split(a, b) => Change::Split(local(a)?, local(b)?),
            Change::Remove(v) => Change::Remove(local(v)?),
        })
    }

    fn keep(&mut self, patch: &Patch) {
        for (&v, &p) in self.origin.vertices.iter().zip(&patch.points) {
            self.points[v.index()] = p;
            self.outgoing[v.index()] = None;
            self.active[v.index()] = true;
        }
        // Sums of floats depend on their order: by size is an order that all inputs share.
        let mut around: Vec<f64> =
            self.origin.vertices.iter().map(|v| self.spacing[v.index()]).collect();
        around.sort_by(f64::total_cmp);
        let mean = around.iter().sum::<f64>() / around.len() as f64;
        let (points, spacing) = (&mut *self.points, &mut *self.spacing);
        let (outgoing, active) = (&mut self.outgoing, &mut self.active);
        let push = |p: Point2| {
            points.push(p);
            spacing.push(mean);
            active.push(true);
            VertexId(points.len() as u32 - 1)
        };
        let mut touched = Vec::new();
        self.origin.replace(self.mesh, patch, push, |mesh, e| touched.push((mesh.origin(e), e)));
        outgoing.resize(self.points.len(), None);
        for (v, e) in touched {
            outgoing[v.index()].get_or_insert(e);
        }
    }
}
