//! The books of a search for better topologies all over a mesh, in the plane or on a surface: which
//! vertices are worth a search, what has been tried, and what has been found.
//!
//! Searches look at the mesh and leave it alone. A few are made on one state of it, on all threads; then
//! what they have found is kept in their order, and a search whose patch has changed meanwhile is made
//! again. So the result is as if they were made one after the other, for any number of threads.

use super::attempt::{Attempt, Searcher};
use super::patch::Origin;
use super::smooth::NOWHERE;
use crate::triangulation::{HalfEdgeId, Triangulation, VertexId};
use rayon::prelude::*;

/// Vertices taken off the list of active ones at once: one that becomes active while its batch is searched
/// has its turn in the next pass. Part of the result, so it does not depend on the number of threads.
const BATCH: usize = 64;
/// Searches of a thread on the same state of the mesh. No part of the result; the more there are, the
/// more of them are made again.
const SHARE: usize = 2;

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
    /// Memory for searches that are made one at a time.
    searcher: Searcher,
}

impl Books {
    /// For a mesh with a half-edge out of each vertex, nothing of it tried yet.
    pub(crate) fn new(outgoing: Vec<HalfEdgeId>) -> Self {
        let count = outgoing.len();
        let [active, changed, unsettled] = [true, false, false].map(|of_all| vec![of_all; count]);
        let searcher = Searcher::default();
        Self { outgoing, active, changed, unsettled, tried: 0, changes: 0, searcher }
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

    /// Searches around some vertices and keeps what is found, in their order; `false` when the budget
    /// is spent.
    fn batch<M: Searched>(&mut self, mesh: &mut M, batch: &[(f64, VertexId)], budget: u64) -> bool {
        let active = &mut self.active;
        let take = |&(_, v): &(f64, VertexId)| std::mem::take(&mut active[v.index()]).then_some(v);
        let batch: Vec<VertexId> = batch.iter().filter_map(take).collect();
        // One thread looks at each state once.
        let threads = rayon::current_num_threads();
        let wave = if threads == 1 { 1 } else { SHARE * threads };
        batch.chunks(wave).all(|wave| self.wave(mesh, wave, budget))
    }

    /// Searches around some vertices at once, and then as [`batch`](Self::batch).
    fn wave<M: Searched>(&mut self, mesh: &mut M, wave: &[VertexId], budget: u64) -> bool {
        let attempts = self.search(mesh, wave);
        let mut touched = Vec::new();
        let mut is_within = true;
        for (&v, mut attempt) in wave.iter().zip(attempts) {
            if attempt.origin.vertices.iter().any(|u| self.changed[u.index()]) {
                // What was looked at is no more: look again.
                attempt = mesh.search(&self.outgoing, &mut self.searcher, v);
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

    /// What comes of searches around some vertices on the present state of the mesh.
    fn search<M: Searched>(&mut self, mesh: &M, wave: &[VertexId]) -> Vec<Attempt<M::Better>> {
        let outgoing = &self.outgoing;
        if let &[v] = wave {
            return vec![mesh.search(outgoing, &mut self.searcher, v)];
        }
        let shares = wave.par_iter().with_max_len(1);
        shares
            .map_init(Searcher::default, |searcher, &v| mesh.search(outgoing, searcher, v))
            .collect()
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
