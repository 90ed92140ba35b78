//! The bilinear Coons patch between four curves (Coons 1967; section 6 of the report):
//!
//! X(u, v) = (1 - v) S(u) + v N(u) + (1 - u) W(v) + u E(v) - the bilinear patch of the corners.

use super::{Side, SurfaceError, SurfaceJet, Tangents};
use crate::curve::{Curve, CurveJet};
use crate::vector::{Vector, add, along, distance, key, scale, sub};

/// A bilinear Coons patch; u and v run from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Coons {
    /// South, east, north, west, each in the direction of the rising parameter.
    sides: [Curve; 4],
    /// At (0, 0), (1, 0), (1, 1), (0, 1).
    corners: [Vector; 4],
}

impl Coons {
    /// The patch between four curves, each in the direction of the rising parameter: south and
    /// north from west to east, west and east from south to north.
    ///
    /// The curves must meet at the corners: exactly, or up to `tolerance` when one is given; then
    /// the ends of the south and of the north curve are the corners.
    ///
    /// # Errors
    /// [`SurfaceError::Gap`] names the first two curves that do not meet, and by how much.
    pub fn new(
        [south, east, north, west]: [Curve; 4],
        tolerance: Option<f64>,
    ) -> Result<Self, SurfaceError> {
        let ([sw, se], [nw, ne]) = (south.ends(), north.ends());
        let ([ws, wn], [es, en]) = (west.ends(), east.ends());
        for (first, second, from, to) in [
            ("south", "west", sw, ws),
            ("south", "east", se, es),
            ("north", "east", ne, en),
            ("north", "west", nw, wn),
        ] {
            let gap = distance(from, to);
            let meets = key(from) == key(to) || tolerance.is_some_and(|tolerance| gap <= tolerance);
            if !meets {
                return Err(SurfaceError::Gap { first, second, gap, from, to });
            }
        }
        Ok(Self { sides: [south, east, north, west], corners: [sw, se, ne, nw] })
    }

    pub(super) fn side(&self, side: Side) -> &Curve {
        &self.sides[side as usize]
    }

    /// As [`jet`](Self::jet), without the second derivatives.
    pub(super) fn tangents(&self, u: f64, v: f64) -> Tangents {
        let (u, v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
        let [south, east, north, west] =
            [(0, u), (1, v), (2, u), (3, v)].map(|(i, t)| unit_tangent(&self.sides[i], t));
        let [sw, se, ne, nw] = self.corners;
        let (low, high) = (mix(u, sw, se), mix(u, nw, ne));
        let point = add(mix(v, south[0], north[0]), mix(u, west[0], east[0]));
        let du = add(mix(v, south[1], north[1]), sub(east[0], west[0]));
        let dv = add(mix(u, west[1], east[1]), sub(north[0], south[0]));
        Tangents {
            point: along(point, -1.0, mix(v, low, high)),
            u: along(du, -1.0, mix(v, sub(se, sw), sub(ne, nw))),
            v: along(dv, -1.0, sub(high, low)),
        }
    }

    pub(super) fn jet(&self, u: f64, v: f64) -> SurfaceJet {
        let (u, v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
        let [south, east, north, west] =
            [(0, u), (1, v), (2, u), (3, v)].map(|(i, t)| unit_jet(&self.sides[i], t));
        let [sw, se, ne, nw] = self.corners;
        let bilinear = mix(v, mix(u, sw, se), mix(u, nw, ne));
        let bilinear_u = mix(v, sub(se, sw), sub(ne, nw));
        let bilinear_v = sub(mix(u, nw, ne), mix(u, sw, se));
        let twist = sub(sub(ne, nw), sub(se, sw));
        let across = |a: Vector, b: Vector| sub(b, a);
        let point = add(mix(v, south.point, north.point), mix(u, west.point, east.point));
        let du = add(mix(v, south.first, north.first), across(west.point, east.point));
        let dv = add(mix(u, west.first, east.first), across(south.point, north.point));
        let uv = add(across(south.first, north.first), across(west.first, east.first));
        SurfaceJet {
            tangents: Tangents {
                point: along(point, -1.0, bilinear),
                u: along(du, -1.0, bilinear_u),
                v: along(dv, -1.0, bilinear_v),
            },
            uu: mix(v, south.second, north.second),
            uv: along(uv, -1.0, twist),
            vv: mix(u, west.second, east.second),
        }
    }
}

fn mix(t: f64, a: Vector, b: Vector) -> Vector {
    add(scale(1.0 - t, a), scale(t, b))
}

/// A curve's point and first derivative with its parameter stretched to [0, 1].
fn unit_tangent(curve: &Curve, t: f64) -> [Vector; 2] {
    let [start, end] = curve.domain();
    let width = end - start;
    let [point, first] = curve.tangent(start + width * t);
    [point, scale(width, first)]
}

/// A curve's jet with its parameter stretched to [0, 1].
fn unit_jet(curve: &Curve, t: f64) -> CurveJet {
    let [start, end] = curve.domain();
    let width = end - start;
    let CurveJet { point, first, second } = curve.jet(start + width * t);
    CurveJet { point, first: scale(width, first), second: scale(width * width, second) }
}
