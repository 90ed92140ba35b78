//! From options to the size field on a background mesh.

use super::options::{Gradation, Method, Options};
use super::scale::Scale;
use crate::background::{Background, FrontEdge};
use crate::front::Start;
use crate::point::Point2;
use crate::size::{
    Base, Density, DirectField, GrowthField, Hint, NodalField, NodalRule, Prediction, SizeField,
    Source, node_spacing, predict,
};
use crate::triangulation::{TriangleId, Triangulation};

/// The size field of a run, and what it was made from.
pub(super) struct Fields {
    points: Vec<Point2>,
    region: Triangulation,
    edges: Vec<FrontEdge>,
    /// Mean length of the boundary edges at each node.
    boundary_spacing: Vec<Option<f64>>,
    field: SizeField,
    /// What the front can reach of `field` when sides are clamped to their base edge.
    reach: Option<GrowthField>,
}

impl Fields {
    pub(super) fn new(background: &Background, options: &Options, scale: &Scale) -> Self {
        let (region, edges) = background.open_region();
        let points = background.points.clone();
        let boundary_spacing = node_spacing(&points, segments(&edges));
        let mut fields = Self {
            points,
            region,
            edges,
            boundary_spacing,
            field: SizeField::Uniform(1.0),
            reach: None,
        };
        fields.field = fields.chosen(options, scale);
        fields.reach = fields.reach(options);
        fields
    }

    pub(super) fn field(&self) -> &SizeField {
        &self.field
    }

    fn chosen(&self, options: &Options, scale: &Scale) -> SizeField {
        match options.method {
            Method::Afm => SizeField::BaseLength(options.stretch),
            Method::Direct => SizeField::Direct(DirectField::new(self.segments_as_points())),
            Method::Graded | Method::DelaunayInitial | Method::Delaunay => {
                match options.gradation {
                    Gradation::Growth => {
                        let spacing = self.node_spacing(options.density);
                        SizeField::Growth(GrowthField::new(&self.sources(&spacing), options.growth))
                    }
                    Gradation::Mean => self.nodal(options.density, NodalRule::Mean),
                    Gradation::Third => self.nodal(options.density, NodalRule::Third),
                    Gradation::Uniform => SizeField::Uniform(
                        options
                            .spacing
                            .map_or_else(|| self.mean_length(), |h| scale.shrink_length(h)),
                    ),
                }
            }
        }
    }

    /// Spacings by the chosen edges; nodes without an edge have none.
    fn node_spacing(&self, density: Density) -> Vec<Option<f64>> {
        match density {
            Density::BoundaryEdges => self.boundary_spacing.clone(),
            Density::AllEdges => node_spacing(&self.points, all_edges(&self.region, &self.edges)),
        }
    }

    fn nodal(&self, density: Density, rule: NodalRule) -> SizeField {
        let mean = self.mean_length();
        let spacing = self.node_spacing(density).into_iter().map(|h| h.unwrap_or(mean)).collect();
        SizeField::Nodal(NodalField::new(self.region.clone(), self.points.clone(), spacing, rule))
    }

    fn sources(&self, spacing: &[Option<f64>]) -> Vec<Source> {
        let source = |(&at, &h): (&Point2, &Option<f64>)| h.map(|spacing| Source { at, spacing });
        let mut sources: Vec<Source> = self.points.iter().zip(spacing).filter_map(source).collect();
        // Ties between sources go to the first: their order must not be the input's.
        sources.sort_by(|s, t| s.at.lexicographic(t.at));
        sources
    }

    fn segments_as_points(&self) -> Vec<[Point2; 2]> {
        self.edges.iter().map(|e| e.vertices.map(|v| self.points[v.index()])).collect()
    }

    fn mean_length(&self) -> f64 {
        let mut lengths: Vec<f64> =
            self.segments_as_points().iter().map(|[a, b]| a.distance(*b)).collect();
        lengths.sort_by(f64::total_cmp);
        lengths.iter().sum::<f64>() / lengths.len() as f64
    }

    /// Sides that are at most `k` times their base grow by `k` over a height of sqrt(3)/2 of the
    /// mean of the two: a slope of (k - 1) / (sqrt(3)/2 (k + 1)/2).
    fn reach(&self, options: &Options) -> Option<GrowthField> {
        let factor = match self.field {
            SizeField::Uniform(_) | SizeField::Growth(_) => return None,
            SizeField::BaseLength(stretch) => stretch,
            SizeField::Nodal(_) | SizeField::Direct(_) => options.clamp,
        };
        let slope = (factor - 1.0).max(0.0) / (0.433_012_701_892_219_3 * (factor + 1.0));
        Some(GrowthField::new(&self.sources(&self.boundary_spacing), slope))
    }

    /// Predicts the number of triangles; stops soon after `limit`.
    pub(super) fn predict(&self, limit: usize) -> Prediction {
        let cover = self
            .region
            .triangles()
            .map(|t| (t, self.region.corners(t).map(|v| self.points[v.index()])));
        predict(cover, |t, p| self.reachable(t, p), limit as f64)
    }

    /// The spacing that the front will reach at a point of a background triangle.
    fn reachable(&self, t: TriangleId, p: Point2) -> f64 {
        let bound = self.reach.as_ref().map_or(f64::INFINITY, |reach| reach.at(p));
        match self.field {
            SizeField::BaseLength(_) => bound,
            _ => self.field.at(p, Base { length: bound }, &mut Hint(t)).min(bound),
        }
    }

    /// The state the front starts from.
    pub(super) fn start(&self) -> Start {
        let mut spacing: Vec<f64> =
            self.boundary_spacing.iter().map(|h| h.unwrap_or(f64::NAN)).collect();
        for t in self.region.triangles() {
            for v in self.region.corners(t) {
                let h = &mut spacing[v.index()];
                if self.field.is_lipschitz() || h.is_nan() {
                    *h = self.reachable(t, self.points[v.index()]);
                }
            }
        }
        Start {
            points: self.points.clone(),
            region: self.region.clone(),
            edges: self.edges.iter().map(|e| e.half_edge).collect(),
            spacing,
        }
    }
}

fn segments(edges: &[FrontEdge]) -> impl Iterator<Item = [u32; 2]> + '_ {
    edges
        .iter()
        .filter(|e| !e.interior || e.vertices[0] < e.vertices[1])
        .map(|e| e.vertices.map(|v| v.0))
}

/// Each edge of the region once: twins from the smaller half-edge, borders from the list.
fn all_edges<'a>(
    region: &'a Triangulation,
    borders: &'a [FrontEdge],
) -> impl Iterator<Item = [u32; 2]> + 'a {
    let inner = region
        .triangles()
        .flat_map(|t| t.half_edges())
        .filter(|&e| region.twin(e).is_some_and(|f| e < f))
        .map(|e| [region.origin(e).0, region.dest(e).0]);
    inner.chain(segments(borders))
}
