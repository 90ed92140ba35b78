//! Surface models: patches that share curves, as plain data exactly as the user gave it.

use crate::curve::Curve;
use crate::curve::discretize::Rule;
use crate::surface::Surface;

/// A surface model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The patches. Sides of different patches (or of one: a seam) that are the same curve to the
    /// bit, in either direction, are one curve of the model.
    pub patches: Vec<Patch>,
    /// Curves with a rule or marker of their own.
    pub curves: Vec<ModelCurve>,
    /// Spacing of the curves without a rule, and the largest spacing inside patches.
    pub spacing: Option<f64>,
    /// How far apart the ends of curves that meet in a corner of a Coons patch may be.
    pub corner_tolerance: Option<f64>,
}

/// A patch of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// As messages call it.
    pub name: String,
    /// The surface.
    pub surface: Surface,
    /// Marker of its triangles.
    pub marker: i32,
    /// Whether its triangles face against the surface's normal. Patches that hang together are
    /// turned to face as the first of them does; a closed model faces outwards.
    pub reversed: bool,
}

/// A curve of a model that the file says something about.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelCurve {
    /// As messages call it.
    pub name: String,
    /// The curve.
    pub curve: Curve,
    /// How it is cut into edges; the model's spacing where there is none.
    pub rule: Option<Rule>,
    /// Marker of its edges; curves without one are marked only where the surface ends.
    pub marker: Option<i32>,
}

impl Model {
    /// Diagonal of the box around all control points of the patches' sides.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        let sides = self
            .patches
            .iter()
            .flat_map(|patch| crate::surface::Side::ALL.map(|side| patch.surface.side(side)));
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for curve in sides {
            for p in curve.points() {
                for i in 0..3 {
                    low[i] = low[i].min(p[i]);
                    high[i] = high[i].max(p[i]);
                }
            }
        }
        let diagonal = crate::vector::distance(low, high);
        if diagonal.is_finite() { diagonal } else { 0.0 }
    }
}
