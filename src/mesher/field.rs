//! From options to the size field on a background mesh.

use super::MeshError;
use super::options::{Gradation, Method, Options};
use super::scale::Scale;
use crate::background::{Background, FrontEdge, INSIDE};
use crate::front::Start;
use crate::point::Point2;
use crate::size::{
    Base, CoarseField, Composed, Density, DirectField, Expression, ExpressionField, GrowthField,
    Hint, Inputs, NodalField, NodalRule, Prediction, RegionCaps, SizeField, SizeSource, Source,
    SourceField, SpacingTable, TableField, growth_limit, node_spacing, predict,
};
use crate::triangulation::{TriangleId, Triangulation, VertexId};
use std::collections::HashMap; // lookups only

/// What is varied to make a mesh coarser or finer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tuning {
    /// Slope of the growth field.
    pub(super) growth: f64,
    /// Factor of the whole field.
    pub(super) factor: f64,
}

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
    /// How fine the front can be beside boundary edges that are longer than `field` wants.
    coarse: Option<CoarseField>,
}

impl Fields {
    /// The field of the options as `tuning` changes it.
    ///
    /// # Errors
    /// An expression with variables that its method does not have.
    pub(super) fn new(
        background: &Background,
        options: &Options,
        scale: &Scale,
        tuning: Tuning,
    ) -> Result<Self, MeshError> {
        let (region, edges) = background.open_region();
        let points = background.points.clone();
        let boundary_spacing = node_spacing(&points, segments(&edges));
        let field = SizeField::Uniform(1.0);
        let (reach, coarse) = (None, None);
        let mut fields = Self { points, region, edges, boundary_spacing, field, reach, coarse };
        let base = fields.base(options, scale, tuning)?;
        let bare_reach = fields.reach_of(&base, options, tuning);
        fields.field = fields.composed(base, background, options, scale, tuning);
        fields.reach = bare_reach;
        fields.coarse = fields.coarse_edges();
        Ok(fields)
    }

    pub(super) fn field(&self) -> &SizeField {
        &self.field
    }

    /// Number of points the front starts with.
    pub(super) fn start_count(&self) -> usize {
        self.points.len()
    }

    /// The background triangle at an edge of the initial front.
    pub(super) fn hint_of_edge(&self, edge: u32) -> Option<Hint> {
        self.edges.get(edge as usize).map(|edge| Hint(edge.half_edge.triangle()))
    }

    /// The background triangle on the left of each side of an interior constraint.
    pub(super) fn constraint_hints(&self) -> HashMap<[VertexId; 2], Hint> {
        let interior = self.edges.iter().filter(|edge| edge.interior);
        interior.map(|edge| (edge.vertices, Hint(edge.half_edge.triangle()))).collect()
    }

    /// The value of the user's function that was no spacing, once it has given one.
    ///
    /// # Errors
    /// Names the point and the value.
    pub(super) fn sound(&self) -> Result<(), MeshError> {
        match self.field.fault() {
            Some(fault) => Err(MeshError::BadSpacing { at: fault.at, value: fault.value }),
            None => Ok(()),
        }
    }

    /// The field by method and gradation, before other sources.
    fn base(
        &self,
        options: &Options,
        scale: &Scale,
        tuning: Tuning,
    ) -> Result<SizeField, MeshError> {
        Ok(match (options.method, &options.gradation) {
            (Method::Afm, _) => SizeField::BaseLength(options.stretch),
            (Method::Direct, Gradation::Expression(expression)) => {
                let inputs = Inputs::Direct(DirectField::new(self.segments_as_points()));
                self.expression(expression, inputs, scale, tuning)?
            }
            (Method::Direct, _) => SizeField::Direct(DirectField::new(self.segments_as_points())),
            (_, Gradation::Growth) => SizeField::Growth(self.growth_field(options, tuning)),
            (_, Gradation::Mean) => SizeField::Nodal(self.nodal(options, NodalRule::Mean)),
            (_, Gradation::Third) => SizeField::Nodal(self.nodal(options, NodalRule::Third)),
            (_, Gradation::Uniform) => SizeField::Uniform(
                options.spacing.map_or_else(|| self.mean_length(), |h| scale.shrink_length(h)),
            ),
            (_, Gradation::Expression(expression)) => {
                let inputs = Inputs::Nodal(self.nodal(options, NodalRule::Mean));
                self.expression(expression, inputs, scale, tuning)?
            }
        })
    }

    fn expression(
        &self,
        expression: &Expression,
        inputs: Inputs,
        scale: &Scale,
        tuning: Tuning,
    ) -> Result<SizeField, MeshError> {
        let growth = GrowthField::new(&self.sources(&self.boundary_spacing), tuning.growth);
        let unit = scale.grow_length(1.0);
        let field = ExpressionField::new(expression.clone(), inputs, growth, unit)?;
        Ok(SizeField::Expression(Box::new(field)))
    }

    fn growth_field(&self, options: &Options, tuning: Tuning) -> GrowthField {
        GrowthField::along(&self.sources(&self.node_spacing(options.density)), tuning.growth)
    }

    /// The base with what keeps it down: nothing in the ordinary case.
    fn composed(
        &self,
        base: SizeField,
        background: &Background,
        options: &Options,
        scale: &Scale,
        tuning: Tuning,
    ) -> SizeField {
        let mut composed = Composed::plain(base);
        if options.limit_growth && !composed.base.is_lipschitz() {
            composed.limit = Some(self.limit(&composed.base, tuning));
        }
        if options.gradation != Gradation::Uniform
            && let Some(h) = options.spacing
        {
            composed.cap = scale.shrink_length(h);
        }
        let sources = self.user_sources(options, scale);
        if !sources.is_empty() {
            composed.sources = Some(SourceField::new(sources, options.growth));
        }
        composed.table = options.table.as_deref().map(|t| table_field(t, options, scale));
        composed.regions = self.region_caps(background, scale);
        composed.factor = tuning.factor;
        if composed.is_plain() { composed.base } else { SizeField::Composed(Box::new(composed)) }
    }

    /// The largest field of the slope below `base` and the boundary's spacing.
    fn limit(&self, base: &SizeField, tuning: Tuning) -> GrowthField {
        let boundary = self.sources(&self.boundary_spacing);
        let bound = GrowthField::new(&boundary, tuning.growth);
        let at = |t: TriangleId, p: Point2| base.at(p, Base { length: bound.at(p) }, &mut Hint(t));
        growth_limit(self.cover(), at, &boundary, tuning.growth)
    }

    /// The user's sources and, as lines, the edges with a spacing of their own.
    fn user_sources(&self, options: &Options, scale: &Scale) -> Vec<SizeSource> {
        let mut sources: Vec<SizeSource> = options
            .sources
            .iter()
            .map(|source| SizeSource {
                ends: source.ends.map(|p| scale.shrunk(p)),
                radius: scale.shrink_length(source.radius),
                spacing: scale.shrink_length(source.spacing),
            })
            .collect();
        for edge in &self.edges {
            let ends = edge.vertices.map(|v| self.points[v.index()]);
            let wanted = options.spacing_at.iter().filter(|(marker, _)| *marker == edge.marker);
            sources.extend(wanted.map(|&(_, h)| SizeSource::line(ends, scale.shrink_length(h))));
        }
        sources
    }

    /// Spacings whose equilateral triangles have the largest area that each region allows.
    fn region_caps(&self, background: &Background, scale: &Scale) -> Option<RegionCaps> {
        let cap = |area: Option<f64>| {
            let area = area.filter(|a| a.is_finite() && *a > 0.0);
            // The root first: an area may be out of range where its root is not.
            let side = area.map(|a| scale.shrink_length(SIDE_PER_ROOT_AREA * a.sqrt()));
            side.filter(|h| *h > 0.0).unwrap_or(f64::INFINITY)
        };
        let mut caps = vec![f64::INFINITY];
        caps.extend(background.regions.iter().map(|region| cap(region.area_max)));
        let slots = 0..self.region.slot_count() as u32;
        let regions = slots.map(|t| self.region.tag(TriangleId(t)).saturating_sub(INSIDE));
        caps.iter()
            .any(|cap| cap.is_finite())
            .then(|| RegionCaps { regions: regions.collect(), caps })
    }

    /// Spacings by the chosen edges; nodes without an edge have none.
    fn node_spacing(&self, density: Density) -> Vec<Option<f64>> {
        match density {
            Density::BoundaryEdges => self.boundary_spacing.clone(),
            Density::AllEdges => node_spacing(&self.points, all_edges(&self.region, &self.edges)),
        }
    }

    fn nodal(&self, options: &Options, rule: NodalRule) -> NodalField {
        let mean = self.mean_length();
        let spacing = self.node_spacing(options.density);
        let spacing = spacing.into_iter().map(|h| h.unwrap_or(mean)).collect();
        NodalField::new(self.region.clone(), self.points.clone(), spacing, rule)
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
    fn reach_of(&self, base: &SizeField, options: &Options, tuning: Tuning) -> Option<GrowthField> {
        let limited = base.is_lipschitz() || options.limit_growth;
        let factor = match base {
            SizeField::BaseLength(stretch) => *stretch,
            _ if limited && tuning.factor <= 1.0 => return None,
            _ => options.clamp,
        };
        let slope = (factor - 1.0).max(0.0) / (0.433_012_701_892_219_3 * (factor + 1.0));
        // Where the slope is bounded anyhow, that bound must not be the tighter one.
        let slope = if limited { slope.max(tuning.factor * tuning.growth) } else { slope };
        Some(GrowthField::new(&self.sources(&self.boundary_spacing), slope))
    }

    /// Whether the boundary is so coarse somewhere that the front cannot follow the field from it.
    pub(super) fn has_coarse_boundary(&self) -> bool {
        self.coarse.is_some()
    }

    /// For each tag of the background its first triangle.
    pub(super) fn hints_by_tag(&self) -> HashMap<u32, Hint> {
        let mut hints = HashMap::new();
        for t in self.region.triangles() {
            hints.entry(self.region.tag(t)).or_insert(Hint(t));
        }
        hints
    }

    /// The spacing that a mesh can have at a point, asked for at a background triangle.
    pub(super) fn attainable(&self, p: Point2, hint: Hint) -> f64 {
        if self.field.fault().is_some() {
            // Whoever sums or splits stops at once; `sound` says why.
            return NOTHING;
        }
        let finest = self.coarse.as_ref().map_or(0.0, |coarse| coarse.at(p));
        self.reachable(hint.0, p).max(finest)
    }

    /// Edges that are much longer than the field wants at their middle.
    fn coarse_edges(&self) -> Option<CoarseField> {
        let is_followed = match &self.field {
            // The boundary itself has made this field.
            SizeField::Growth(_) => false,
            SizeField::Composed(field) => {
                field.is_lipschitz() || matches!(field.base, SizeField::Expression(_))
            }
            field => field.is_lipschitz() || matches!(field, SizeField::Expression(_)),
        };
        if !is_followed {
            return None;
        }
        let coarse: Vec<[Point2; 2]> = self
            .edges
            .iter()
            .filter_map(|edge| {
                let [a, b] = edge.vertices.map(|v| self.points[v.index()]);
                let middle = Point2::new(0.5 * a.x + 0.5 * b.x, 0.5 * a.y + 0.5 * b.y);
                let (length, t) = (a.distance(b), edge.half_edge.triangle());
                let wanted = self.field.at(middle, Base { length }, &mut Hint(t));
                (length > COARSE_EDGE * wanted).then_some([a, b])
            })
            .collect();
        (!coarse.is_empty()).then(|| CoarseField::new(coarse))
    }

    /// The background triangles inside and their corners.
    fn cover(&self) -> impl Iterator<Item = (TriangleId, [Point2; 3])> + '_ {
        self.region.triangles().map(|t| (t, self.region.corners(t).map(|v| self.points[v.index()])))
    }

    /// Predicts the number of triangles; stops soon after `limit`.
    pub(super) fn predict(&self, limit: usize) -> Prediction {
        predict(self.cover(), |t, p| self.attainable(p, Hint(t)), limit as f64)
    }

    /// The spacing that the front will reach at a point of a background triangle.
    fn reachable(&self, t: TriangleId, p: Point2) -> f64 {
        let bound = self.reach.as_ref().map_or(f64::INFINITY, |reach| reach.at(p));
        let base = match &self.field {
            SizeField::BaseLength(_) => return bound,
            // The stretch is in the bound already.
            SizeField::Composed(field) => match field.base {
                SizeField::BaseLength(stretch) => bound / stretch,
                _ => bound,
            },
            _ => bound,
        };
        self.field.at(p, Base { length: base }, &mut Hint(t)).min(bound)
    }

    /// The state the front starts from.
    pub(super) fn start(&self) -> Start {
        let bounded = self.field.is_lipschitz();
        let own = |h: &Option<f64>| h.filter(|_| !bounded).unwrap_or(f64::NAN);
        let mut spacing: Vec<f64> = self.boundary_spacing.iter().map(own).collect();
        for t in self.region.triangles() {
            for v in self.region.corners(t) {
                let h = &mut spacing[v.index()];
                if bounded || h.is_nan() {
                    // Between two regions the smaller of their spacings; `min` passes NaN over.
                    *h = h.min(self.reachable(t, self.points[v.index()]));
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

/// Below any spacing that passes a limit; its inverse square is finite.
const NOTHING: f64 = 1e-150;
/// Boundary edges longer than this many wanted spacings count as coarse.
const COARSE_EDGE: f64 = 1.7;
/// Side of an equilateral triangle over the root of its area: 2 / 3^(1/4).
const SIDE_PER_ROOT_AREA: f64 = 1.519_671_371_303_185;

fn table_field(table: &SpacingTable, options: &Options, scale: &Scale) -> TableField {
    let shrunk = SpacingTable {
        points: table.points.iter().map(|&p| scale.shrunk(p)).collect(),
        spacing: table.spacing.iter().map(|&h| scale.shrink_length(h)).collect(),
        triangles: table.triangles.clone(),
    };
    TableField::new(&shrunk, options.growth)
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
