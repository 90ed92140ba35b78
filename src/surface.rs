//! Surfaces: maps of a rectangle of parameters (u, v) into space.
//!
//! Three representations serve all kinds: a tensor product of NURBS (planes, Bezier and piecewise
//! bilinear patches are such), a bilinear Coons patch between four curves, and a curve that turns
//! about an axis. Evaluation is written for the mesher: a point with both first derivatives, or with
//! the second ones too. The normal is the direction of dX/du x dX/dv.

mod coons;
mod revolution;
mod tensor;
mod trace;

pub use coons::Coons;
pub use revolution::Revolution;
pub use tensor::Tensor;
pub use trace::{Line, Trace};

use crate::curve::{Curve, CurveError};
use crate::vector::Vector;

/// A surface patch.
///
/// ```
/// use trigrade::metric::{FirstForm, normal};
/// use trigrade::surface::{Surface, Tensor};
/// // A bilinear patch over the unit square, one corner lifted.
/// let rows = [
///     vec![[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]], // u = 0
///     vec![[1.0, 0.0, 0.0], [1.0, 1.0, 1.0]], // u = 1
/// ];
/// let patch = Surface::Tensor(Tensor::bezier(&rows)?);
/// assert_eq!(patch.at(0.5, 0.5), [0.5, 0.5, 0.25]);
/// let tangents = patch.tangents(0.0, 0.0);
/// assert_eq!(normal(&tangents), Some([0.0, 0.0, 1.0]));
/// assert_eq!(FirstForm::new(&tangents).area(), 1.0);
/// # Ok::<(), trigrade::surface::SurfaceError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Surface {
    /// Tensor product of B-splines or NURBS.
    Tensor(Tensor),
    /// Bilinear Coons patch.
    Coons(Box<Coons>),
    /// Surface of revolution.
    Revolution(Revolution),
}

/// A point of a surface and the two first derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangents {
    /// The point.
    pub point: Vector,
    /// Derivative by u.
    pub u: Vector,
    /// Derivative by v.
    pub v: Vector,
}

/// A point of a surface with first and second derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceJet {
    /// The point and the first derivatives.
    pub tangents: Tangents,
    /// Second derivative by u.
    pub uu: Vector,
    /// Mixed derivative.
    pub uv: Vector,
    /// Second derivative by v.
    pub vv: Vector,
}

/// A side of the rectangle of parameters, counterclockwise around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// v is least; u rises.
    South,
    /// u is greatest; v rises.
    East,
    /// v is greatest; u falls counterclockwise, but [`Surface::side`] gives the curve with u rising.
    North,
    /// u is least; as for the north, the curve has v rising.
    West,
}

impl Side {
    /// All four, counterclockwise.
    pub const ALL: [Self; 4] = [Self::South, Self::East, Self::North, Self::West];

    /// As model files name it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::South => "south",
            Self::East => "east",
            Self::North => "north",
            Self::West => "west",
        }
    }
}

/// What is wrong with a surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// Its knots, control points or weights are wrong in one direction.
    #[error("in the direction of {direction}: {error}")]
    Spline {
        /// u or v.
        direction: char,
        /// What is wrong.
        error: CurveError,
    },
    /// The control net is no rectangle.
    #[error("row {row} of the control net has {found} points, but the first row has {expected}")]
    Net {
        /// Index of the row.
        row: usize,
        /// How many points it has.
        found: usize,
        /// How many the first row has.
        expected: usize,
    },
    /// Two sides of a Coons patch do not meet.
    #[error(
        "the {first} and the {second} curve leave a gap of {gap:e} at their corner: {from:?} against {to:?}"
    )]
    Gap {
        /// One side.
        first: &'static str,
        /// The other side.
        second: &'static str,
        /// Distance of their ends.
        gap: f64,
        /// End of the first.
        from: Vector,
        /// End of the second.
        to: Vector,
    },
    /// The axis has no direction.
    #[error("the axis has no direction")]
    NoAxis,
    /// The angle of revolution is out of range.
    #[error("the angle is {0} degrees, but must be above 0 and at most 360")]
    Angle(f64),
}

impl Surface {
    /// Range of u and of v.
    #[must_use]
    pub fn domain(&self) -> [[f64; 2]; 2] {
        match self {
            Self::Tensor(surface) => surface.domain(),
            Self::Coons(_) => [[0.0, 1.0]; 2],
            Self::Revolution(surface) => surface.domain(),
        }
    }

    /// The point at (u, v), which is taken into the domain.
    #[must_use]
    pub fn at(&self, u: f64, v: f64) -> Vector {
        match self {
            Self::Tensor(surface) => surface.at(u, v),
            Self::Coons(surface) => surface.tangents(u, v).point,
            Self::Revolution(surface) => surface.tangents(u, v).point,
        }
    }

    /// The point with both tangents.
    #[must_use]
    pub fn tangents(&self, u: f64, v: f64) -> Tangents {
        match self {
            Self::Tensor(surface) => surface.tangents(u, v),
            Self::Coons(surface) => surface.tangents(u, v),
            Self::Revolution(surface) => surface.tangents(u, v),
        }
    }

    /// The point with all derivatives up to the second.
    #[must_use]
    pub fn jet(&self, u: f64, v: f64) -> SurfaceJet {
        match self {
            Self::Tensor(surface) => surface.jet(u, v),
            Self::Coons(surface) => surface.jet(u, v),
            Self::Revolution(surface) => surface.jet(u, v),
        }
    }

    /// The curve along a side, in the direction of the rising parameter.
    #[must_use]
    pub fn side(&self, side: Side) -> Curve {
        match self {
            Self::Tensor(surface) => surface.side(side),
            Self::Coons(surface) => surface.side(side).clone(),
            Self::Revolution(surface) => surface.side(side),
        }
    }

    /// The patches between the lines where the surface may have a crease: each is smooth.
    #[must_use]
    pub fn pieces(&self) -> Vec<Self> {
        match self {
            Self::Tensor(surface) => surface.pieces().into_iter().map(Self::Tensor).collect(),
            Self::Revolution(surface) => {
                surface.pieces().into_iter().map(Self::Revolution).collect()
            }
            Self::Coons(_) => vec![self.clone()],
        }
    }

    /// The same surface as one piece if its normal does not turn at the lines where it may have a
    /// crease, as on a cylinder or a torus made of rational quarters; itself otherwise.
    #[must_use]
    pub fn joined(self) -> Self {
        match self {
            Self::Tensor(surface) => Self::Tensor(surface.joined()),
            Self::Revolution(surface) => Self::Revolution(surface.joined()),
            Self::Coons(_) => self,
        }
    }
}
