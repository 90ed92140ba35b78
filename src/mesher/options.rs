//! What a user can ask of the mesher.

use crate::front::{Order, Rules};
use crate::improve::ImproveOptions;
use crate::refine::ANGLE_MAX_DEG;
use crate::size::{Density, Expression, SizeSource, SpacingTable};
use std::sync::Arc;

/// How the domain is meshed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Graded triangulation: the front with spacings from a size field.
    Graded,
    /// Plain advancing front: spacings from the base edge alone.
    Afm,
    /// The front with spacings from the two nearest edges of the initial front.
    Direct,
    /// The constrained Delaunay triangulation of the boundary, without new points.
    DelaunayInitial,
    /// The same with points inserted until areas and angles are within their bounds.
    Delaunay,
    /// A structured grid of a four-sided domain by transfinite interpolation.
    Transfinite,
    /// The same, smoothed by the inverse Laplace equations.
    Elliptic,
}

/// How large a triangle may be (method delaunay).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AreaMax {
    /// As the equilateral triangle of the spacing that the gradation gives.
    Field,
    /// At most this area, in the unit of the domain squared.
    Constant(f64),
    /// As large as it likes.
    Unbounded,
}

/// How spacings at the boundary become a spacing inside (method graded).
#[derive(Clone, Debug, PartialEq)]
pub enum Gradation {
    /// h(x) = min over nodes of (h_i + growth |x - x_i|).
    Growth,
    /// The report's L = a L1 + b L2 + c L3 on the background triangulation.
    Mean,
    /// The same divided by three.
    Third,
    /// The same length everywhere.
    Uniform,
    /// The user's own function; with the method direct it takes that method's variables.
    Expression(Expression),
}

/// How many triangles are wanted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Count {
    /// As many as the size field asks for; above the limit is an error.
    #[default]
    Field,
    /// As many as the field asks for; above the limit a coarser field is taken.
    Coarsen,
    /// This many: the field is made coarser or finer.
    Target(usize),
}

/// Options of the mesher. [`Options::default`] is the graded method with growth 0.25.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Method.
    pub method: Method,
    /// Which edges make the spacing at a node.
    pub density: Density,
    /// How spacings are spread inside.
    pub gradation: Gradation,
    /// Largest slope of the spacing (gradation growth).
    pub growth: f64,
    /// A side stays within [b / clamp, clamp b] of its base edge b.
    pub clamp: f64,
    /// Keep the slope of any gradation at most `growth`, from the boundary's own spacing on.
    pub limit_growth: bool,
    /// Largest spacing anywhere, in the unit of the domain. Gradation uniform takes it everywhere;
    /// there `None` is the mean length of the boundary edges.
    pub spacing: Option<f64>,
    /// Spacings at the boundary edges and constraints with these markers, growing by `growth`.
    pub spacing_at: Vec<(i32, f64)>,
    /// Points, discs and lines with spacings of their own, growing by `growth`.
    pub sources: Vec<SizeSource>,
    /// A background mesh with a spacing at each node, limited by `growth`.
    pub table: Option<Arc<SpacingTable>>,
    /// Side of a new triangle over its base edge (method afm).
    pub stretch: f64,
    /// Order of base edges.
    pub order: Order,
    /// Rules for trial points.
    pub rules: Rules,
    /// More predicted triangles than this are an error before any work.
    pub triangles_max: usize,
    /// How many triangles are wanted.
    pub count: Count,
    /// Improvement after the front.
    pub improve: ImproveOptions,
    /// Bound on areas (method delaunay).
    pub area_max: AreaMax,
    /// Least angle in degrees (method delaunay); 0 is none.
    pub angle_min_deg: f64,
    /// Whether the boundary and constraints may be split: by the method delaunay where an angle
    /// demands it, by the others where the spacing jumps or a gap is narrow.
    pub split_boundary: bool,
    /// The four corners of a structured grid: indices of the domain's points. `None` takes the four
    /// sharpest vertices of the boundary.
    pub corners: Option<[u32; 4]>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::Graded,
            density: Density::BoundaryEdges,
            gradation: Gradation::Growth,
            growth: 0.25,
            clamp: 1.5,
            limit_growth: false,
            spacing: None,
            spacing_at: Vec::new(),
            sources: Vec::new(),
            table: None,
            stretch: 1.2,
            order: Order::Depth,
            rules: Rules::Scored,
            triangles_max: 20_000_000,
            count: Count::Field,
            improve: ImproveOptions::default(),
            area_max: AreaMax::Field,
            angle_min_deg: 0.0,
            split_boundary: false,
            corners: None,
        }
    }
}

/// Options that make no sense.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{name} is {value}, but must be {rule}")]
pub struct OptionsError {
    /// The option as the command line names it.
    pub name: &'static str,
    /// What was given.
    pub value: f64,
    /// What is allowed.
    pub rule: &'static str,
}

impl Options {
    /// Whether every number is in its range.
    ///
    /// # Errors
    /// The first option out of range.
    pub fn check(&self) -> Result<(), OptionsError> {
        let demand = |name, value: f64, holds: bool, rule| {
            if holds { Ok(()) } else { Err(OptionsError { name, value, rule }) }
        };
        demand("growth", self.growth, (0.0..=10.0).contains(&self.growth), "from 0 to 10")?;
        demand("clamp", self.clamp, (1.0..=100.0).contains(&self.clamp), "from 1 to 100")?;
        demand("stretch", self.stretch, (0.5..=10.0).contains(&self.stretch), "from 0.5 to 10")?;
        if let Some(h) = self.spacing {
            demand("spacing", h, is_length(h), "positive and finite")?;
        }
        for &(_, h) in &self.spacing_at {
            demand("spacing-at", h, is_length(h), "positive and finite")?;
        }
        for source in &self.sources {
            demand(
                "source",
                source.spacing,
                source.is_sound(),
                "a positive and finite spacing at a finite place",
            )?;
        }
        if let Count::Target(n) = self.count {
            let wanted = n as f64;
            demand(
                "target",
                wanted,
                (1..=self.triangles_max).contains(&n),
                "from 1 to --max-triangles",
            )?;
        }
        let bound = match self.area_max {
            AreaMax::Constant(area) => area,
            AreaMax::Field | AreaMax::Unbounded => f64::INFINITY,
        };
        let by_field = self.method != Method::Delaunay || self.area_max == AreaMax::Field;
        let rule = "`field` where a number of triangles is wanted (--target, --coarsen)";
        demand("max-area", bound, by_field || self.count == Count::Field, rule)?;
        if let AreaMax::Constant(area) = self.area_max {
            demand("max-area", area, area.is_finite() && area > 0.0, "positive and finite")?;
        }
        let angle = self.angle_min_deg;
        demand("min-angle", angle, (0.0..=ANGLE_MAX_DEG).contains(&angle), "from 0 to 34 degrees")
    }
}

fn is_length(h: f64) -> bool {
    h.is_finite() && h > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::point::Point2;

    // spec: H6
    #[test]
    fn numbers_out_of_range_are_named() {
        assert_eq!(Options::default().check(), Ok(()));
        let source = SizeSource::point(Point2::new(0.0, f64::NAN), 1.0, 0.0);
        let broken = [
            (Options { growth: -0.1, ..Options::default() }, "growth"),
            (Options { growth: f64::NAN, ..Options::default() }, "growth"),
            (Options { clamp: 0.9, ..Options::default() }, "clamp"),
            (Options { stretch: f64::INFINITY, ..Options::default() }, "stretch"),
            (Options { spacing: Some(0.0), ..Options::default() }, "spacing"),
            (Options { spacing: Some(f64::NAN), ..Options::default() }, "spacing"),
            (Options { area_max: AreaMax::Constant(0.0), ..Options::default() }, "max-area"),
            (Options { area_max: AreaMax::Constant(f64::NAN), ..Options::default() }, "max-area"),
            (Options { angle_min_deg: -1.0, ..Options::default() }, "min-angle"),
            (Options { angle_min_deg: 34.1, ..Options::default() }, "min-angle"),
            (Options { angle_min_deg: f64::NAN, ..Options::default() }, "min-angle"),
            (Options { spacing_at: vec![(1, -1.0)], ..Options::default() }, "spacing-at"),
            (Options { sources: vec![source], ..Options::default() }, "source"),
            (Options { count: Count::Target(0), ..Options::default() }, "target"),
            (Options { count: Count::Target(usize::MAX), ..Options::default() }, "target"),
        ];
        for (options, name) in broken {
            assert_eq!(options.check().unwrap_err().name, name);
        }
    }
}
