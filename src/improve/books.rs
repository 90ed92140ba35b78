//! The books of a search for better topologies all over a mesh, in the plane or on a surface: which
//! vertices are worth a search, what has been tried, and what has been found.
//!
//! Searches look at the mesh and leave it alone. Some are made on one state of it, on all threads; then
//! what they have found is kept in their order, and a search whose patch has changed meanwhile is made
//! again. So the result does not depend on the number of threads.

use super::attempt::{Attempt, Searcher};
use super::patch::Origin;
use super::smooth::NOWHERE;
use crate::triangulation::{HalfEdgeId, Triangulation, VertexId};
use rayon::prelude::*;

/// Searches made on the same state of the mesh, before what they have found takes its place. Part
/// of the result, so it does not depend on the number of threads.
const BATCH: usize = 64;
/// Searches that share memory, one after the other.
const SHARE: usize = 4;

/// A mesh that is searched.
pub(crate) trait Searched: Sync {
    /// What takes the place of a patch.
    type Better: Send;

    /// Searches around a vertex; `outgoing` has a half-edge out of each vertex that is in a triangle.
    fn search(
        &self,
        outgoing: &[HalfEdgeId],
        searcher: &mut Searcher,
        v: VertexId,
    ) -> Attempt<Self::Better>;

    /// Puts something better in the place it came from, vertices that are new after all others and
    /// into `origin`; `touched` is told each new half-edge.
    fn replace(
        &mut self,
        better: &Self::Better,
        origin: &mut Origin,
        touched: impl FnMut(&Triangulation, HalfEdgeId),
    );

    /// Vertices, with those in no triangle.
    fn vertex_count(&self) -> usize;
}

/// What has been tried and found so far, and where it is worth looking again.
pub(crate) struct Books {
    /// A half-edge out of each vertex that is in a triangle, [`NOWHERE`] for others.
    pub(crate) outgoing: Vec<HalfEdgeId>,
    /// Vertices whose surroundings have changed since they were last tried.
    pub(crate) active: Vec<bool>,
    /// Vertices around which something has changed in this batch.
    changed: Vec<bool>,
    /// And in any batch.
    pub(crate) unsettled: Vec<bool>,
    /// Changes of topology that were tried.
    pub(crate) tried: u64,
    /// Changes of topology that were kept.
    pub(crate) changes: u64,
}

impl Books {
    /// For a mesh with a half-edge out of each vertex, nothing of it tried yet.
    pub(crate) fn new(outgoing: Vec<HalfEdgeId>) -> Self {
        let count = outgoing.len();
        let [active, changed, unsettled] = [true, false, false].map(|of_all| vec![of_all; count]);
        Self { outgoing, active, changed, unsettled, tried: 0, changes: 0 }
    }

    /// Searches around the vertices of a list of (how bad it is there, vertex), in its order, and keeps
    /// what is found; ends with `false` before more changes have been tried in all than `budget` allows
    /// where it is so bad.
    pub(crate) fn pass<M: Searched>(
        &mut self,
        mesh: &mut M,
        list: &[(f64, VertexId)],
        budget: impl Fn(f64) -> u64,
    ) -> bool {
        list.chunks(BATCH).all(|batch| self.batch(mesh, batch, budget(batch[0].0)))
    }

    /// Searches around some vertices at once and keeps what is found, in their order; `false` when
    /// the budget is spent.
    fn batch<M: Searched>(&mut self, mesh: &mut M, batch: &[(f64, VertexId)], budget: u64) -> bool {
        let active = &mut self.active;
        let take = |&(_, v): &(f64, VertexId)| std::mem::take(&mut active[v.index()]).then_some(v);
        let batch: Vec<VertexId> = batch.iter().filter_map(take).collect();
        let (seen, outgoing) = (&*mesh, &self.outgoing);
        let search = |share: &[VertexId]| {
            let mut searcher = Searcher::default();
            share.iter().map(|&v| seen.search(outgoing, &mut searcher, v)).collect::<Vec<_>>()
        };
        let attempts: Vec<Vec<_>> = batch.par_chunks(SHARE).map(search).collect();
        let mut touched = Vec::new();
        let mut is_within = true;
        for (&v, mut attempt) in batch.iter().zip(attempts.into_iter().flatten()) {
            if attempt.origin.vertices.iter().any(|u| self.changed[u.index()]) {
                // What was looked at is no more: look again.
                attempt = mesh.search(&self.outgoing, &mut Searcher::default(), v);
            }
            if self.tried + attempt.tried > budget {
                is_within = false;
                break;
            }
            self.tried += attempt.tried;
            if let Some(better) = attempt.better {
                self.changes += 1;
                self.keep(mesh, &better, &mut attempt.origin);
                touched.append(&mut attempt.origin.vertices);
            }
        }
        for v in touched {
            self.changed[v.index()] = false;
        }
        is_within
    }

    fn keep<M: Searched>(&mut self, mesh: &mut M, better: &M::Better, origin: &mut Origin) {
        for v in &origin.vertices {
            self.outgoing[v.index()] = NOWHERE;
        }
        let mut new = Vec::new();
        mesh.replace(better, origin, |mesh, e| new.push((mesh.origin(e), e)));
        let count = mesh.vertex_count();
        self.outgoing.resize(count, NOWHERE);
        for (v, e) in new {
            self.outgoing[v.index()] = e;
        }
        for list in [&mut self.active, &mut self.changed, &mut self.unsettled] {
            list.resize(count, true);
            for v in &origin.vertices {
                list[v.index()] = true;
            }
        }
    }
}
