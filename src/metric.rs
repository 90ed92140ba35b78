//! What the first and second fundamental form of a surface say: lengths, areas, curvatures.

use crate::surface::{SurfaceJet, Tangents};
use crate::vector::{Vector, cross, dot, unit};

/// The first fundamental form: ds^2 = E du^2 + 2 F du dv + G dv^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstForm {
    /// X_u . X_u
    pub e: f64,
    /// X_u . X_v
    pub f: f64,
    /// X_v . X_v
    pub g: f64,
}

impl FirstForm {
    /// Of two tangents.
    #[must_use]
    pub fn new(tangents: &Tangents) -> Self {
        let Tangents { u, v, .. } = *tangents;
        Self { e: dot(u, u), f: dot(u, v), g: dot(v, v) }
    }

    /// Area of the surface over the unit of area of (u, v): sqrt(E G - F^2).
    #[must_use]
    pub fn area(&self) -> f64 {
        (self.e * self.g - self.f * self.f).max(0.0).sqrt()
    }

    /// Squared length of the parameter vector (du, dv) on the surface.
    #[must_use]
    pub fn length_sq(&self, du: f64, dv: f64) -> f64 {
        self.e * du * du + 2.0 * self.f * du * dv + self.g * dv * dv
    }

    /// Ratio of the longest to the shortest image of a unit parameter vector; infinite where the
    /// map is singular.
    #[must_use]
    pub fn stretch(&self) -> f64 {
        let (mean, half) = (0.5 * (self.e + self.g), 0.5 * (self.e - self.g));
        let radius = half.hypot(self.f);
        let low = mean - radius;
        if low > 0.0 { ((mean + radius) / low).sqrt() } else { f64::INFINITY }
    }
}

/// The unit normal X_u x X_v / |X_u x X_v|; `None` where the map is singular.
#[must_use]
pub fn normal(tangents: &Tangents) -> Option<Vector> {
    unit(cross(tangents.u, tangents.v))
}

/// Principal curvatures, the one that is larger in magnitude first; `None` where the map is
/// singular. Positive where the surface bends towards its normal.
#[must_use]
pub fn principal_curvatures(jet: &SurfaceJet) -> Option<[f64; 2]> {
    let n = normal(&jet.tangents)?;
    let FirstForm { e, f, g } = FirstForm::new(&jet.tangents);
    let [l, m, k] = [jet.uu, jet.uv, jet.vv].map(|second| dot(second, n));
    let determinant = e * g - f * f;
    let mean = 0.5 * (e * k - 2.0 * f * m + g * l) / determinant;
    let gauss = (l * k - m * m) / determinant;
    let root = (mean * mean - gauss).max(0.0).sqrt();
    let pair = if mean >= 0.0 { [mean + root, mean - root] } else { [mean - root, mean + root] };
    pair.iter().all(|k| k.is_finite()).then_some(pair)
}
