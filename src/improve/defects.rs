//! Removal of defects: vertices inside with more or fewer than six triangles.
//!
//! A pair of vertices with five and seven triangles is a dislocation of the lattice. Flipping an
//! edge moves it along, removing or adding a vertex moves it across, and two that meet vanish. Such
//! changes are searched for on patches, and kept only if the patch is better for them.

use super::attempt::{Attempt, Effort, Searcher, View};
use super::books::{Books, Searched};
use super::degree::Degrees;
use super::patch::{Origin, Patch};
use super::smooth::Smoother;
use crate::point::Point2;
use crate::triangulation::{HalfEdgeId, Triangulation, VertexId};

/// In a mesh that is good as a whole only triangles worse than this are worth a search.
const POOR: f64 = 1.08;

/// A mesh in the plane, and how it is searched.
pub(super) struct Lattice<'a> {
    pub(super) mesh: &'a mut Triangulation,
    pub(super) points: &'a mut Vec<Point2>,
    pub(super) spacing: &'a mut Vec<f64>,
    /// Vertices below this index never move.
    pub(super) fixed: usize,
    pub(super) quantum: Option<f64>,
    pub(super) effort: Effort,
}

/// Searches for better topologies at the irregular vertices of a mesh.
pub(super) struct Defects<'a> {
    lattice: Lattice<'a>,
    pub(super) books: Books,
    /// Vertices without a triangle worse than this are left alone.
    least: f64,
}

impl<'a> Defects<'a> {
    /// For a mesh with a half-edge out of each vertex that is in a triangle.
    pub(super) fn new(lattice: Lattice<'a>, outgoing: Vec<HalfEdgeId>) -> Self {
        Self { lattice, books: Books::new(outgoing), least: 1.0 }
    }

    /// Whether the first pass has found the mesh good as a whole.
    pub(super) fn is_good(&self) -> bool {
        self.least == POOR
    }

    /// What is left to smooth: wherever something has changed.
    pub(super) fn into_smoother(self) -> Smoother {
        Smoother::from_parts(self.lattice.mesh, self.books.outgoing, self.books.unsettled)
    }

    /// One pass over the irregular vertices and those with bad triangles, worst first; ends before
    /// more than `budget` changes have been tried in all, and returns the number of changes kept. The
    /// first pass finds out whether the mean inverse mean ratio is above 1 by less than `enough`.
    pub(super) fn pass(&mut self, budget: u64, enough: f64) -> u64 {
        let before = self.books.changes;
        let list = self.worst_first(enough);
        self.books.pass(&mut self.lattice, &list, |_| budget);
        self.books.changes - before
    }

    /// Active vertices worth trying with the worst triangle around them, worst first, then by index.
    fn worst_first(&mut self, enough: f64) -> Vec<(f64, VertexId)> {
        let Books { outgoing, active, tried, .. } = &mut self.books;
        let degrees = self.lattice.view(outgoing).degrees;
        let first = (*tried == 0).then(|| degrees.survey());
        if first.as_ref().is_some_and(|survey| survey.mean < 1.0 + enough) {
            self.least = POOR;
        }
        let is_candidate = |v: &usize| first.as_ref().is_none_or(|survey| survey.irregular[*v]);
        let mut found: Vec<(f64, VertexId)> = (self.lattice.fixed..outgoing.len())
            .filter(|&v| active[v])
            .filter(is_candidate)
            .map(|v| VertexId(v as u32))
            .filter_map(|v| degrees.defect(v).map(|worst| (worst, v)))
            .filter(|&(worst, _)| worst > self.least)
            .collect();
        // The others have none until something changes around them.
        active.fill(false);
        for (_, v) in &found {
            active[v.index()] = true;
        }
        found.sort_by(|s, t| t.0.total_cmp(&s.0).then(s.1.cmp(&t.1)));
        found
    }
}

impl Lattice<'_> {
    fn view<'b>(&'b self, outgoing: &'b [HalfEdgeId]) -> View<'b> {
        let degrees = Degrees { mesh: self.mesh, points: self.points, outgoing };
        View { degrees, fixed: self.fixed, quantum: self.quantum, effort: self.effort }
    }
}

impl Searched for Lattice<'_> {
    type Better = Patch;

    fn search(&self, outgoing: &[HalfEdgeId], searcher: &mut Searcher, v: VertexId) -> Attempt {
        searcher.search(self.view(outgoing), v)
    }

    fn replace(
        &mut self,
        patch: &Patch,
        origin: &mut Origin,
        touched: impl FnMut(&Triangulation, HalfEdgeId),
    ) {
        for (&v, &p) in origin.vertices.iter().zip(&patch.points) {
            self.points[v.index()] = p;
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
        origin.replace(self.mesh, patch, push, touched);
    }

    fn vertex_count(&self) -> usize {
        self.points.len()
    }
}
