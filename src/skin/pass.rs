//! Passes over a whole skin, in the order of the slots.

use super::{Ground, Rank, Skin};
use crate::triangulation::{HalfEdgeId, VertexId};

/// Edges longer than this many times what is wanted are split: then the halves are nearer to it.
const LONG: f64 = 4.0 / 3.0;
/// Edges shorter than this are collapsed: then their neighbours are nearer to it.
const SHORT: f64 = 4.0 / 5.0;
/// Flips and moves after each pass of splits and collapses.
const MOVES: u32 = 3;
/// Most passes of splits or collapses in a row; each halves or doubles lengths.
const REPEATS: u32 = 40;

/// How often what is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Rounds of split, collapse, flip by valence and even out.
    pub rounds: u32,
    /// Rounds of flip by shape and polish after that.
    pub polish: u32,
}

impl Default for Effort {
    fn default() -> Self {
        Self { rounds: 10, polish: 10 }
    }
}

/// What passes have done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Passes {
    /// Edges split.
    pub splits: u64,
    /// Edges collapsed.
    pub collapses: u64,
    /// Edges flipped.
    pub flips: u64,
    /// Vertices moved.
    pub moves: u64,
}

/// More new vertices than allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("more than {0} new vertices: gave up")]
pub struct TooManyVertices(pub usize);

impl<G: Ground> Skin<'_, G> {
    /// Makes all edges about as long as wanted, then all triangles as well-shaped as they get.
    ///
    /// # Errors
    /// When more than `vertices_max` vertices would have been made.
    pub fn remesh(
        &mut self,
        effort: Effort,
        vertices_max: usize,
    ) -> Result<Passes, TooManyVertices> {
        let mut passes = Passes::default();
        for _ in 0..effort.rounds {
            self.split_long(&mut passes, vertices_max)?;
            self.collapse_short(&mut passes);
            for _ in 0..MOVES {
                passes.flips += self.flip_where(Self::is_valence_better);
                passes.moves += self.even_out();
            }
        }
        self.improve(effort.polish, &mut passes);
        Ok(passes)
    }

    /// Flips and moves until nothing changes, at most `rounds` times.
    pub fn improve(&mut self, rounds: u32, passes: &mut Passes) {
        for _ in 0..rounds {
            let flips = self.flip_where(Self::is_shape_better);
            let moves = self.polish();
            passes.flips += flips;
            passes.moves += moves;
            if flips + moves == 0 {
                break;
            }
        }
    }

    fn split_long(
        &mut self,
        passes: &mut Passes,
        vertices_max: usize,
    ) -> Result<(), TooManyVertices> {
        for _ in 0..REPEATS {
            let mut long: Vec<(f64, HalfEdgeId)> =
                self.edges().into_iter().map(|e| (self.ratio(e), e)).collect();
            long.retain(|&(ratio, e)| ratio > LONG && !self.mesh.is_constrained(e));
            // Longest first, so that long triangles are cut across.
            long.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.0.cmp(&b.1.0)));
            let mut count = 0;
            for (ratio, e) in long {
                let is_current = self.ratio(e) == ratio && !self.mesh.is_constrained(e);
                if is_current && self.is_longest(e) && self.split_middle(e) {
                    count += 1;
                }
                if self.mesh.live_count() > 2 * vertices_max {
                    return Err(TooManyVertices(vertices_max));
                }
            }
            passes.splits += count;
            passes.flips += self.flip_where(Self::is_shape_better);
            if count == 0 {
                break;
            }
        }
        Ok(())
    }

    /// Whether an edge is the longest free one of its triangles: fans are cut across, not along.
    fn is_longest(&self, e: HalfEdgeId) -> bool {
        let ratio = self.ratio(e);
        let beside = [Some(e), self.mesh.twin(e)].into_iter().flatten();
        beside
            .flat_map(|h| [h.next(), h.prev()])
            .all(|h| self.mesh.is_constrained(h) || self.ratio(h) <= ratio)
    }

    fn collapse_short(&mut self, passes: &mut Passes) {
        for _ in 0..REPEATS {
            let mut short: Vec<(f64, HalfEdgeId, [VertexId; 2])> = Vec::new();
            for e in self.edges() {
                let ends = [self.mesh.origin(e), self.mesh.dest(e)];
                let is_leftover = ends.iter().any(|v| self.ranks[v.index()] == Rank::Removable)
                    && self.mesh.is_constrained(e);
                let ratio = if is_leftover { 0.0 } else { self.ratio(e) };
                if ratio < SHORT {
                    short.push((ratio, e, ends));
                }
            }
            short.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.0.cmp(&b.1.0)));
            let mut count = 0;
            for (_, e, ends) in short {
                count += u64::from(self.is_still(e, ends) && self.collapse_either_way(e));
            }
            passes.collapses += count;
            if count == 0 {
                break;
            }
        }
    }

    /// Collapses an edge towards the end that must stay, or the one it started from.
    fn collapse_either_way(&mut self, e: HalfEdgeId) -> bool {
        let back = self.mesh.twin(e);
        let towards_end = self.can_collapse(e);
        let chosen = if towards_end {
            Some(e)
        } else {
            // On a border the edge has one half-edge only: the way back is taken by the fan.
            back.filter(|&f| self.can_collapse(f))
        };
        chosen.map(|h| self.collapse(h)).is_some()
    }

    fn flip_where(&mut self, is_better: impl Fn(&Self, HalfEdgeId) -> bool) -> u64 {
        let mut flips = 0;
        for e in self.edges() {
            if !self.mesh.is_constrained(e) && is_better(self, e) && self.can_flip(e) {
                self.flip(e);
                flips += 1;
            }
        }
        flips
    }

    /// Whether a flip brings the numbers of neighbours nearer to six, and ruins no triangle.
    fn is_valence_better(&self, e: HalfEdgeId) -> bool {
        let Some(f) = self.mesh.twin(e) else { return false };
        let ends = [self.mesh.origin(e), self.mesh.dest(e)];
        let apexes = [self.mesh.apex(e), self.mesh.apex(f)];
        if ends.iter().chain(&apexes).any(|v| self.ranks[v.index()] != Rank::Free) {
            return self.is_shape_better(e);
        }
        let excess = |v: VertexId, by: i64| (self.valence(v).0 as i64 - 6 + by).pow(2);
        let now: i64 = ends.iter().chain(&apexes).map(|&v| excess(v, 0)).sum();
        let then: i64 = ends.iter().map(|&v| excess(v, -1)).sum::<i64>()
            + apexes.iter().map(|&v| excess(v, 1)).sum::<i64>();
        let is_sound = |[before, after]: [f64; 2]| after > 0.3 || after > before;
        then < now && self.flip_shapes(e).is_some_and(is_sound)
    }

    /// Whether a flip makes the worse of two triangles better.
    fn is_shape_better(&self, e: HalfEdgeId) -> bool {
        self.flip_shapes(e).is_some_and(|[before, after]| after > before * (1.0 + 1e-9))
    }
}
