//! Curves of a model in space: NURBS curves, and curves in the parameters of a surface.

use super::{Surface, SurfaceJet};
use crate::curve::discretize::Track;
use crate::curve::{Curve, CurveJet};
use crate::vector::{Vector, along, key, scale};

/// A curve in the parameters of a surface, seen in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// The surface.
    pub surface: Surface,
    /// The curve of (u, v); its z is 0.
    pub parameters: Curve,
}

/// A curve in space, of either kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Line {
    /// A NURBS curve.
    Curve(Curve),
    /// A curve on a surface.
    Trace(Box<Trace>),
}

impl Trace {
    /// The chain rule, twice.
    fn jet(&self, t: f64) -> CurveJet {
        let CurveJet { point: at, first: d, second: dd } = self.parameters.jet(t);
        let SurfaceJet { tangents, uu, uv, vv } = self.surface.jet(at[0], at[1]);
        let first = along(scale(d[0], tangents.u), d[1], tangents.v);
        let straight = along(scale(dd[0], tangents.u), dd[1], tangents.v);
        let bent = along(along(scale(d[0] * d[0], uu), 2.0 * d[0] * d[1], uv), d[1] * d[1], vv);
        CurveJet { point: tangents.point, first, second: along(straight, 1.0, bent) }
    }
}

impl Line {
    /// The point at a parameter.
    #[must_use]
    pub fn at(&self, t: f64) -> Vector {
        match self {
            Self::Curve(curve) => curve.at(t),
            Self::Trace(trace) => {
                let [u, v, _] = trace.parameters.at(t);
                trace.surface.at(u, v)
            }
        }
    }

    /// First and last point: equal bits for a closed curve.
    #[must_use]
    pub fn ends(&self) -> [Vector; 2] {
        let [start, end] = self.domain();
        [self.at(start), self.at(end)]
    }

    /// Whether it is the same NURBS curve, and whether the other way around.
    #[must_use]
    pub fn same_as(&self, curve: &Curve) -> Option<bool> {
        match self {
            Self::Curve(own) => own.same_as(curve),
            Self::Trace(_) => None,
        }
    }
}

impl Track for Line {
    fn domain(&self) -> [f64; 2] {
        match self {
            Self::Curve(curve) => curve.domain(),
            Self::Trace(trace) => trace.parameters.domain(),
        }
    }

    fn jet(&self, t: f64) -> CurveJet {
        match self {
            Self::Curve(curve) => curve.jet(t),
            Self::Trace(trace) => trace.jet(t),
        }
    }

    fn knots(&self) -> &[f64] {
        match self {
            Self::Curve(curve) => curve.knots(),
            Self::Trace(trace) => trace.parameters.knots(),
        }
    }

    fn corners(&self) -> Vec<f64> {
        match self {
            Self::Curve(curve) => curve.corners(),
            Self::Trace(trace) => trace.parameters.corners(),
        }
    }

    fn is_closed(&self) -> bool {
        let [from, to] = self.ends();
        key(from) == key(to)
    }
}
