//! What the front knows of each vertex.

use super::chart::Site;
use crate::point::Point2;
use crate::triangulation::VertexId;

/// Vertices of the front: position, what lies above it, wanted spacing, and depth, the way from the
/// boundary.
pub(super) struct Vertices<L> {
    points: Vec<Point2>,
    lifts: Vec<L>,
    spacing: Vec<f64>,
    depth: Vec<f64>,
}

impl<L: Copy> Vertices<L> {
    pub(super) fn new(points: Vec<Point2>, lifts: Vec<L>, spacing: Vec<f64>) -> Self {
        assert_eq!(points.len(), spacing.len(), "one spacing per point");
        assert_eq!(points.len(), lifts.len(), "one lift per point");
        let depth = vec![0.0; points.len()];
        Self { points, lifts, spacing, depth }
    }

    pub(super) fn point(&self, v: VertexId) -> Point2 {
        self.points[v.index()]
    }

    pub(super) fn site(&self, v: VertexId) -> Site<L> {
        Site { at: self.points[v.index()], lift: self.lifts[v.index()] }
    }

    pub(super) fn spacing(&self, v: VertexId) -> f64 {
        self.spacing[v.index()]
    }

    pub(super) fn depth(&self, v: VertexId) -> f64 {
        self.depth[v.index()]
    }

    pub(super) fn push(&mut self, site: Site<L>, spacing: f64, depth: f64) -> VertexId {
        self.points.push(site.at);
        self.lifts.push(site.lift);
        self.spacing.push(spacing);
        self.depth.push(depth);
        VertexId(self.points.len() as u32 - 1)
    }

    pub(super) fn into_parts(self) -> (Vec<Point2>, Vec<L>, Vec<f64>) {
        (self.points, self.lifts, self.spacing)
    }
}
