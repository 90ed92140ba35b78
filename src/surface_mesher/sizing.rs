//! Spacing by curvature, and by the user's own function.

use crate::curve::CurveJet;
use crate::curve::discretize::spacing_for_chord;
use crate::metric::{FirstForm, principal_curvatures};
use crate::size::Expression;
use crate::surface::SurfaceJet;
use crate::vector::Vector;
use std::sync::OnceLock;

/// What the curvature of surface and curves is asked for.
#[derive(Debug)]
pub(super) struct Curvature {
    /// Largest distance of a triangle from the surface.
    pub(super) chord_error: Option<f64>,
    /// Largest turn of the normal along an edge, in radians.
    pub(super) angle: Option<f64>,
    /// No spacing by curvature is below this.
    pub(super) floor: f64,
    /// The user's own spacing.
    pub(super) own: Option<Own>,
}

/// The user's own spacing.
#[derive(Debug)]
pub(super) struct Own {
    pub(super) expression: Expression,
    /// The spacing of the model.
    pub(super) spacing: f64,
    /// The first value that is no spacing, and where. The run goes on without it, and whoever runs it
    /// asks at the end.
    pub(super) fault: OnceLock<(f64, Vector)>,
}

impl Own {
    fn at(&self, jet: &SurfaceJet) -> f64 {
        // A pole has no curvature; the spacing grows towards it from around.
        let Some(curvatures) = principal_curvatures(jet) else { return f64::INFINITY };
        let (point, area) = (jet.tangents.point, FirstForm::new(&jet.tangents).area());
        let value = self.expression.on_surface(point, self.spacing, curvatures, area);
        if value > 0.0 && value.is_finite() {
            return value;
        }
        let _ = self.fault.set((value, point));
        f64::INFINITY
    }
}

/// Edges are laid up to this much longer than wanted, so that much less is wanted.
const SAFETY: f64 = 0.82;

impl Curvature {
    pub(super) fn is_on(&self) -> bool {
        self.chord_error.is_some() || self.angle.is_some() || self.own.is_some()
    }

    /// The spacing at a point of a surface; infinite where nothing is asked for, or where the map
    /// is singular.
    ///
    /// A triangle of side h leaves a cylinder of curvature k by k h^2 / 8 and a sphere by
    /// k h^2 / 6: the curvatures are joined to k1 + k2 / 3.
    pub(super) fn spacing(&self, jet: &SurfaceJet) -> f64 {
        let own = self.own.as_ref().map_or(f64::INFINITY, |own| own.at(jet)).max(self.floor);
        let Some([k1, k2]) = principal_curvatures(jet) else { return own };
        own.min(self.of(k1.abs() + k2.abs() / 3.0, k1.abs()))
    }

    /// The spacing at a point of a curve.
    pub(super) fn along(&self, jet: &CurveJet) -> f64 {
        self.of(jet.curvature(), jet.curvature())
    }

    fn of(&self, for_chord: f64, for_angle: f64) -> f64 {
        let chord = self
            .chord_error
            .map_or(f64::INFINITY, |error| spacing_for_chord(for_chord, error, f64::INFINITY));
        let angle = self.angle.map_or(f64::INFINITY, |a| 2.0 * libm::sin(0.5 * a) / for_angle);
        (SAFETY * chord.min(angle)).max(self.floor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn jet(k: f64) -> CurveJet {
        CurveJet { point: [0.0; 3], first: [1.0, 0.0, 0.0], second: [0.0, k, 0.0] }
    }

    // spec: S6
    #[test]
    fn chord_error_and_angle_give_the_edges_of_regular_polygons() {
        let rule = Curvature {
            chord_error: None,
            angle: Some(60_f64.to_radians()),
            floor: 0.0,
            own: None,
        };
        assert!((rule.along(&jet(0.5)) - SAFETY * 2.0).abs() < 1e-15, "a hexagon of radius 2");
        let rule = Curvature { chord_error: Some(0.5), angle: None, floor: 0.0, own: None };
        assert!((rule.along(&jet(1.0)) - SAFETY * 3.0_f64.sqrt()).abs() < 1e-15, "a triangle");
        assert_eq!(rule.along(&jet(0.0)), f64::INFINITY);
    }

    // spec: S6
    #[test]
    fn no_spacing_is_below_the_floor() {
        let rule = Curvature { chord_error: Some(1e-9), angle: Some(0.1), floor: 0.3, own: None };
        assert_eq!(rule.along(&jet(1e12)), 0.3);
        let off = Curvature { chord_error: None, angle: None, floor: 0.3, own: None };
        assert!(!off.is_on());
        assert_eq!(off.along(&jet(1e12)), f64::INFINITY);
    }
}
