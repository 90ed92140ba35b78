//! A search for a better topology around one vertex: it looks at the mesh and leaves it alone, so
//! that several can be made at once.
//!
//! Most single changes make things worse before another one makes them better: a dislocation of the
//! lattice has to glide over a barrier. So the search goes on from the least bad change to what that
//! suggests, some steps deep (the chains of Lin and Kernighan, 1973), and is a success when the end
//! of a chain is better than its beginning.

use super::degree::Degrees;
use super::patch::{Change, Cut, Origin, Patch, Worth};
use crate::point::Point2;
use crate::triangulation::{HalfEdgeId, Triangulation, VertexId};

/// A success must lower the excess of its patch by this much, or it is not worth its disturbance.
pub(crate) const GAIN_MIN: f64 = 3e-3;
/// A change that is so much worse than the best so far after one sweep and flips is given up.
const HOPELESS: f64 = 1.15;
/// And before the flips by this factor more, where not everything is tried.
const HOPELESS_UNFLIPPED: f64 = 1.1 * HOPELESS;
/// Where a patch has a worse inverse mean ratio than this, everything is tried.
const BAD: f64 = 1.1;
/// Two patches of the same origin whose excesses differ by less than this are the same again.
const SAME: f64 = 5e-3;

/// How much is tried around a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Effort {
    /// Rings of triangles in a patch.
    pub(crate) rings: u32,
    /// Length of a chain of changes.
    pub(crate) depth: u32,
    /// Changes tried in each step after the first, least harmful first; 0 for all of them.
    pub(crate) breadth: u32,
}

/// What came of a search.
pub(crate) struct Attempt<Better = Patch> {
    /// Changes tried.
    pub(crate) tried: u64,
    /// Where the patch came from.
    pub(crate) origin: Origin,
    /// What is to take its place, if the search was a success.
    pub(crate) better: Option<Better>,
}

impl<Better> Default for Attempt<Better> {
    fn default() -> Self {
        Self { tried: 0, origin: Origin::default(), better: None }
    }
}

/// The topology that is searched, and how.
#[derive(Clone, Copy)]
pub(crate) struct Search<'a> {
    pub(crate) mesh: &'a Triangulation,
    /// A half-edge out of each vertex that is in a triangle.
    pub(crate) outgoing: &'a [HalfEdgeId],
    /// Vertices below this index do not move.
    pub(crate) fixed: usize,
    pub(crate) quantum: Option<f64>,
    pub(crate) effort: Effort,
}

/// The mesh as it is looked at.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) degrees: Degrees<'a>,
    /// Vertices below this index do not move.
    pub(super) fixed: usize,
    pub(super) quantum: Option<f64>,
    pub(super) effort: Effort,
}

/// Memory for searches, reused from one to the next.
#[derive(Default)]
pub(crate) struct Searcher {
    base: Patch,
    trial: Patch,
    next: Patch,
    best: Patch,
    changes: Vec<Change>,
    /// Changes by what they do before anything is relaxed.
    ranked: Vec<(f64, Change)>,
    around: Vec<VertexId>,
}

/// How far a search has come.
struct Goal {
    worst: f64,
    aspect: f64,
    /// Less excess than this is a success, or a better one.
    bound: f64,
    found: bool,
    tried: u64,
    /// Whether the search is not to be narrowed.
    everything: bool,
}

impl Searcher {
    /// Searches around a vertex.
    pub(super) fn search(&mut self, view: View<'_>, v: VertexId) -> Attempt {
        let View { degrees, fixed, quantum, effort } = view;
        let Degrees { mesh, points, outgoing } = degrees;
        let search = Search { mesh, outgoing, fixed, quantum, effort };
        self.search_at(search, v, |v| points[v.index()])
    }

    /// Searches around a vertex where the vertices are where `place` says: in the plane, or in one
    /// that touches a surface.
    pub(crate) fn search_at(
        &mut self,
        search: Search<'_>,
        v: VertexId,
        place: impl Fn(VertexId) -> Point2,
    ) -> Attempt {
        let Search { mesh, outgoing, fixed, quantum, effort } = search;
        let Effort { rings, depth, breadth } = effort;
        let mut attempt = Attempt::default();
        let cut = Cut { rings, fixed };
        let origin = &mut attempt.origin;
        let Some(here) = self.base.cut((mesh, outgoing), v, cut, origin, place) else {
            return attempt;
        };
        let now = self.base.worth();
        if now.excess == f64::INFINITY {
            return attempt;
        }
        let bound = now.excess - GAIN_MIN;
        let everything = breadth == 0 || now.worst > BAD;
        let mut goal = Goal {
            worst: now.worst,
            aspect: now.aspect,
            bound,
            found: false,
            tried: 0,
            everything,
        };
        let mut seen = vec![now.excess];
        self.around.clear();
        self.around.push(here);
        for step in 0..depth {
            self.list_changes();
            if step > 0 && !everything {
                self.shortlist(breadth as usize);
            }
            let least = self.try_all(quantum, &mut goal, &seen);
            if goal.found || least == f64::INFINITY {
                break;
            }
            seen.push(least);
            std::mem::swap(&mut self.base, &mut self.next);
            self.around.clear();
            self.around.extend(self.base.touched());
            self.around.sort_unstable();
            self.around.dedup();
        }
        attempt.tried = goal.tried;
        attempt.better = goal.found.then(|| std::mem::take(&mut self.best));
        attempt
    }

    /// Lists the changes around the vertices in question.
    fn list_changes(&mut self) {
        self.changes.clear();
        for &v in &self.around {
            self.base.changes(v, &mut self.changes);
        }
    }

    /// Leaves no more changes than `most`: those that do the least harm before anything is relaxed.
    fn shortlist(&mut self, most: usize) {
        if self.changes.len() <= most {
            return;
        }
        self.ranked.clear();
        self.ranked.extend(self.changes.iter().map(|&change| (self.base.rise(change), change)));
        self.ranked.sort_by(|s, t| s.0.total_cmp(&t.0));
        self.changes.clear();
        self.changes.extend(self.ranked.iter().take(most).map(|&(_, change)| change));
    }

    /// Tries the listed changes from the base on; returns the least excess that is no success and
    /// has not been seen, whose patch is then the next.
    fn try_all(&mut self, quantum: Option<f64>, goal: &mut Goal, seen: &[f64]) -> f64 {
        let mut least = f64::INFINITY;
        for &change in &self.changes {
            self.trial.assign(&self.base);
            if !self.trial.make(change, quantum) {
                continue;
            }
            goal.tried += 1;
            let unflipped = if goal.everything { f64::INFINITY } else { HOPELESS_UNFLIPPED };
            self.trial.relax(quantum, [unflipped, HOPELESS].map(|factor| factor * goal.bound));
            let Worth { excess, worst, aspect } = self.trial.worth();
            if excess < goal.bound && worst <= goal.worst && aspect <= goal.aspect {
                goal.bound = excess;
                goal.found = true;
                std::mem::swap(&mut self.trial, &mut self.best);
            } else if excess < least && seen.iter().all(|s| (s - excess).abs() > SAME) {
                least = excess;
                std::mem::swap(&mut self.trial, &mut self.next);
            }
        }
        least
    }
}
