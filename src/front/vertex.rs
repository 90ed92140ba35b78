//! What the front knows of each vertex.

use crate::point::Point2;
use crate::triangulation::VertexId;

/// Vertices of the front: position, wanted spacing, and depth, the way from the boundary.
pub(super) struct Vertices {
    points: Vec<Point2>,
    attributes: Vec<Attributes>,
}

#[derive(Clone, Copy)]
struct Attributes {
    spacing: f64,
    depth: f64,
}

impl Vertices {
    pub(super) fn new(points: Vec<Point2>, spacing: Vec<f64>) -> Self {
        assert_eq!(points.len(), spacing.len(), "one spacing per point");
        let attributes =
            spacing.into_iter().map(|spacing| Attributes { spacing, depth: 0.0 }).collect();
        Self { points, attributes }
    }

    pub(super) fn point(&self, v: VertexId) -> Point2 {
        self.points[v.index()]
    }

    pub(super) fn spacing(&self, v: VertexId) -> f64 {
        self.attributes[v.index()].spacing
    }

    pub(super) fn depth(&self, v: VertexId) -> f64 {
        self.attributes[v.index()].depth
    }

    pub(super) fn push(&mut self, point: Point2, spacing: f64, depth: f64) -> VertexId {
        self.points.push(point);
        self.attributes.push(Attributes { spacing, depth });
        VertexId(self.points.len() as u32 - 1)
    }

    pub(super) fn into_points_and_spacing(self) -> (Vec<Point2>, Vec<f64>) {
        (self.points, self.attributes.iter().map(|a| a.spacing).collect())
    }
}
