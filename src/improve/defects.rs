//! Removal of defects: vertices inside with more or fewer than six triangles.
//!
//! A pair of vertices with five and seven triangles is a dislocation of the lattice. Flipping an
//! edge moves it along, removing or adding a vertex moves it across, and two that meet vanish. Such
//! changes are searched for on patches, and kept only if the patch is better for them.

use super::ImproveStats;
use super::attempt::{Attempt, Effort, Searcher, View};
use super::degree::Degrees;
use super::patch::{Origin, Patch};
use super::smooth::{NOWHERE, Smoother};
use crate::point::Point2;
use crate::triangulation::{HalfEdgeId, Triangulation, VertexId};
use rayon::prelude::*;

/// Searches made on the same state of the mesh, before what they have found takes its place. Part
/// of the result, so it does not depend on the number of threads.
const BATCH: usize = 64;
/// Searches that share memory, one after the other.
const SHARE: usize = 4;
/// In a mesh that is good as a whole only triangles worse than this are worth a search.
const POOR: f64 = 1.08;

/// Searches for better topologies at the irregular vertices of a mesh.
pub(super) struct Defects<'a> {
    pub(super) mesh: &'a mut Triangulation,
    pub(super) points: &'a mut Vec<Point2>,
    pub(super) spacing: &'a mut Vec<f64>,
    /// Vertices below this index never move.
    fixed: usize,
    quantum: Option<f64>,
    effort: Effort,
    /// A half-edge out of each vertex that is in a triangle.
    outgoing: Vec<HalfEdgeId>,
    /// Vertices whose surroundings have changed since they were last tried.
    active: Vec<bool>,
    /// Vertices around which something has changed in this batch.
    changed: Vec<bool>,
    /// And in any batch.
    unsettled: Vec<bool>,
    /// Vertices without a triangle worse than this are left alone.
    least: f64,
}

impl<'a> Defects<'a> {
    pub(super) fn new(
        mesh: &'a mut Triangulation,
        (points, spacing): (&'a mut Vec<Point2>, &'a mut Vec<f64>),
        fixed: usize,
        quantum: Option<f64>,
        effort: Effort,
        outgoing: Vec<HalfEdgeId>,
    ) -> Self {
        let active = vec![true; points.len()];
        let changed = vec![false; points.len()];
        let unsettled = changed.clone();
        Self {
            mesh,
            points,
            spacing,
            fixed,
            quantum,
            effort,
            outgoing,
            active,
            changed,
            unsettled,
            least: 1.0,
        }
    }

    /// What is left to smooth: wherever something has changed.
    pub(super) fn into_smoother(self) -> Smoother {
        Smoother::from_parts(self.mesh, self.outgoing, self.unsettled)
    }

    /// One pass over the irregular vertices and those with bad triangles, worst first; ends before
    /// more than `budget` changes have been tried in all, and returns the number of changes kept. The
    /// first pass finds out whether the mean inverse mean ratio is above 1 by less than `enough`.
    pub(super) fn pass(&mut self, budget: u64, enough: f64, stats: &mut ImproveStats) -> u64 {
        let before = stats.changes;
        let list = self.worst_first(stats.tried == 0, enough);
        for batch in list.chunks(BATCH) {
            if !self.batch(batch, budget, stats) {
                break;
            }
        }
        stats.changes - before
    }

    /// Searches around some vertices at once and keeps what is found, in their order; `false` when
    /// the budget is spent.
    fn batch(&mut self, batch: &[VertexId], budget: u64, stats: &mut ImproveStats) -> bool {
        let batch: Vec<VertexId> =
            batch.iter().copied().filter(|v| std::mem::take(&mut self.active[v.index()])).collect();
        let view = self.view();
        let search = |share: &[VertexId]| {
            let mut searcher = Searcher::default();
            share.iter().map(|&v| searcher.search(view, v)).collect::<Vec<Attempt>>()
        };
        let attempts: Vec<Vec<Attempt>> = batch.par_chunks(SHARE).map(search).collect();
        let mut touched = Vec::new();
        let mut is_within = true;
        for (&v, mut attempt) in batch.iter().zip(attempts.into_iter().flatten()) {
            if attempt.origin.vertices.iter().any(|u| self.changed[u.index()]) {
                // What was looked at is no more: look again.
                attempt = Searcher::default().search(self.view(), v);
            }
            if stats.tried + attempt.tried > budget {
                is_within = false;
                break;
            }
            stats.tried += attempt.tried;
            if let Some(patch) = attempt.better {
                stats.changes += 1;
                self.keep(&patch, &mut attempt.origin);
                touched.append(&mut attempt.origin.vertices);
            }
        }
        for v in touched {
            self.changed[v.index()] = false;
        }
        is_within
    }

    fn view(&self) -> View<'_> {
        let degrees = Degrees { mesh: self.mesh, points: self.points, outgoing: &self.outgoing };
        View { degrees, fixed: self.fixed, quantum: self.quantum, effort: self.effort }
    }

    /// Active vertices worth trying, by the worst triangle around them, then by index.
    fn worst_first(&mut self, is_first: bool, enough: f64) -> Vec<VertexId> {
        let first = is_first.then(|| self.view().degrees.survey());
        if first.as_ref().is_some_and(|survey| survey.mean < 1.0 + enough) {
            self.least = POOR;
        }
        let is_candidate = |v: &usize| first.as_ref().is_none_or(|survey| survey.irregular[*v]);
        let degrees = self.view().degrees;
        let mut found: Vec<(f64, VertexId)> = (self.fixed..self.points.len())
            .filter(|&v| self.active[v])
            .filter(is_candidate)
            .map(|v| VertexId(v as u32))
            .filter_map(|v| degrees.defect(v).map(|worst| (worst, v)))
            .filter(|&(worst, _)| worst > self.least)
            .collect();
        // The others have none until something changes around them.
        self.active.fill(false);
        for (_, v) in &found {
            self.active[v.index()] = true;
        }
        found.sort_by(|s, t| t.0.total_cmp(&s.0).then(s.1.cmp(&t.1)));
        found.into_iter().map(|(_, v)| v).collect()
    }

    fn keep(&mut self, patch: &Patch, origin: &mut Origin) {
        for (&v, &p) in origin.vertices.iter().zip(&patch.points) {
            self.points[v.index()] = p;
            self.outgoing[v.index()] = NOWHERE;
        }
        // Sums of floats depend on their order: by size is an order that all inputs share.
        let mut around: Vec<f64> =
            origin.vertices.iter().map(|v| self.spacing[v.index()]).collect();
        around.sort_by(f64::total_cmp);
        let mean = around.iter().sum::<f64>() / around.len() as f64;
        let (points, spacing) = (&mut *self.points, &mut *self.spacing);
        let push = |p: Point2| {
            points.push(p);
            spacing.push(mean);
            VertexId(points.len() as u32 - 1)
        };
        let mut new = Vec::new();
        origin.replace(self.mesh, patch, push, |mesh, e| new.push((mesh.origin(e), e)));
        self.outgoing.resize(self.points.len(), NOWHERE);
        self.active.resize(self.points.len(), true);
        self.changed.resize(self.points.len(), true);
        self.unsettled.resize(self.points.len(), true);
        for (v, e) in new {
            self.outgoing[v.index()] = e;
        }
        for v in &origin.vertices {
            self.active[v.index()] = true;
            self.changed[v.index()] = true;
            self.unsettled[v.index()] = true;
        }
    }
}
