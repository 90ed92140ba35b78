//! Spacing: the edge length wanted at a point.
//!
//! Definitions, and which inequality each field keeps, are in SPEC chapter 6. All fields rank
//! candidates and choose positions; no decision about validity rests on them.

mod boxes;
mod coarse;
mod composed;
mod custom;
mod direct;
mod expression;
mod growth;
mod limit;
mod nodal;
mod predict;
mod sources;
mod spacing;
mod table;

pub use coarse::CoarseField;
pub use composed::{Composed, RegionCaps};
pub use custom::{BadSpacing, ExpressionField, Inputs};
pub use direct::DirectField;
pub use expression::{Expression, ExpressionError, Variable};
pub use growth::{GrowthField, Source};
pub use limit::growth_limit;
pub use nodal::{NodalField, NodalRule};
pub use predict::{Prediction, predict};
pub use sources::{SizeSource, SourceField};
pub use spacing::{Density, node_spacing};
pub use table::{SpacingTable, TableError, TableField};

use crate::point::Point2;
use crate::triangulation::TriangleId;

/// Where the last question was answered: a caller keeps one per front edge, so that a walk starts
/// on the right side of a thin wall and is short.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hint(pub TriangleId);

/// The base edge a question is asked for: `afm` and the clamp depend on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Base {
    /// Length of the base edge: the mean of the spacings at its ends.
    pub length: f64,
}

/// A size field.
///
/// The mesher makes its own from a domain and the options; one can be asked by hand, too:
///
/// ```
/// use trigrade::point::Point2;
/// use trigrade::size::{GrowthField, Source};
/// // A node with spacing 0.1, from which the spacing grows by 0.25 a unit of length.
/// let field = GrowthField::new(&[Source { at: Point2::new(0.0, 0.0), spacing: 0.1 }], 0.25);
/// assert_eq!(field.at(Point2::new(0.0, 0.0)), 0.1);
/// assert!((field.at(Point2::new(3.0, 4.0)) - 1.35).abs() < 1e-12);
/// ```
#[derive(Debug)]
pub enum SizeField {
    /// The same length everywhere.
    Uniform(f64),
    /// Growth-limited distance to the boundary nodes (the default).
    Growth(GrowthField),
    /// The report's field: node spacings interpolated on the background triangulation.
    Nodal(NodalField),
    /// The report's direct grading from the two nearest edges of the initial front.
    Direct(DirectField),
    /// Plain advancing front: this factor times the length of the base edge.
    BaseLength(f64),
    /// The user's own gradation function.
    Expression(Box<ExpressionField>),
    /// The smallest of several.
    Composed(Box<Composed>),
}

impl SizeField {
    /// The spacing wanted at `p` for a triangle on `base`; `hint` is read and updated.
    ///
    /// Positive and finite for every finite `p`. Costs a walk (nodal), a descent of a tree
    /// (growth), two searches of a tree (direct) or nothing.
    #[must_use]
    pub fn at(&self, p: Point2, base: Base, hint: &mut Hint) -> f64 {
        match self {
            Self::Uniform(h) => *h,
            Self::Growth(field) => field.at(p),
            Self::Nodal(field) => field.at(p, hint),
            Self::Direct(field) => field.at(p),
            Self::BaseLength(stretch) => stretch * base.length,
            Self::Expression(field) => field.at(p, hint),
            Self::Composed(field) => field.at(p, base, hint),
        }
    }

    /// Whether neighbouring values differ by a bounded slope, so that clearances may trust them.
    #[must_use]
    pub fn is_lipschitz(&self) -> bool {
        match self {
            Self::Uniform(_) | Self::Growth(_) => true,
            Self::Composed(field) => field.is_lipschitz(),
            _ => false,
        }
    }

    /// Whether the answer depends on the hint: that of a field on the background triangles.
    #[must_use]
    pub fn heeds_hint(&self) -> bool {
        match self {
            Self::Nodal(_) | Self::Expression(_) => true,
            Self::Composed(field) => field.base.heeds_hint() || field.regions.is_some(),
            Self::Uniform(_) | Self::Growth(_) | Self::Direct(_) | Self::BaseLength(_) => false,
        }
    }

    /// Whether some value may be no spacing: that of a user's function.
    #[must_use]
    pub fn can_fail(&self) -> bool {
        match self {
            Self::Expression(_) => true,
            Self::Composed(field) => field.base.can_fail(),
            _ => false,
        }
    }

    /// The first value of the user's function that was no spacing, if it has given one.
    #[must_use]
    pub fn fault(&self) -> Option<BadSpacing> {
        match self {
            Self::Expression(field) => field.fault(),
            Self::Composed(field) => field.base.fault(),
            _ => None,
        }
    }
}
