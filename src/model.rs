//! Surface models: patches that share curves, as plain data exactly as the user gave it.

mod weld;

use crate::curve::Curve;
use crate::curve::discretize::Rule;
use crate::surface::Surface;
use std::collections::BTreeMap;

/// A surface model.
///
/// ```
/// use trigrade::mesher::Unobserved;
/// use trigrade::model::{Model, Patch};
/// use trigrade::surface::{Surface, Tensor};
/// use trigrade::surface_mesher::{SurfaceOptions, mesh_model};
///
/// let rows = [
///     vec![[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
///     vec![[1.0, 0.0, 0.0], [1.0, 1.0, 1.0]],
/// ];
/// let patch = Patch::plain(0, Surface::Tensor(Tensor::bezier(&rows)?));
/// let model = Model { patches: vec![patch], spacing: Some(0.25), ..Model::default() };
/// let meshed = mesh_model(&model, &SurfaceOptions::default(), &mut Unobserved)?;
/// assert!(meshed.mesh.triangles.len() > 20);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The patches. Sides of different patches (or of one: a seam) that are the same curve to the
    /// bit, in either direction, are one curve of the model.
    pub patches: Vec<Patch>,
    /// Curves with a rule or marker of their own.
    pub curves: Vec<ModelCurve>,
    /// Spacing of the curves without a rule, and the largest spacing inside patches.
    pub spacing: Option<f64>,
    /// Largest distance of a triangle from the surface, where the mesher is not asked for another.
    pub chord_error: Option<f64>,
    /// Largest turn of the normal along an edge, in degrees, where it is not asked for another.
    pub angle_per_edge_deg: Option<f64>,
    /// How far apart the ends of curves that meet in a corner of a Coons patch may be.
    pub corner_tolerance: Option<f64>,
    /// What is cut away from patches, by their index.
    pub trims: BTreeMap<usize, Trim>,
    /// Whether parts that share no curve may cross each other: a handle that runs into its pot.
    pub parts_may_cross: bool,
    /// How far apart what is the same may be, where that is more than rounding: the ends of curves
    /// of a loop, curves and the surfaces that they trim. The curves of (u, v) beside curves of space
    /// then only say near which place these lie.
    pub tolerance: Option<f64>,
    /// What the reader wants to be told: the unit, what it left out.
    pub notes: Vec<String>,
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

/// What is cut away from a patch by loops of curves, each ending where the next starts, the last
/// where the first starts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trim {
    /// The loop that takes the place of the sides.
    pub outline: Option<Vec<TrimCurve>>,
    /// The loops around holes.
    pub holes: Vec<Vec<TrimCurve>>,
}

impl Trim {
    /// All loops, the outline first.
    pub fn loops(&self) -> impl Iterator<Item = &Vec<TrimCurve>> {
        self.outline.iter().chain(&self.holes)
    }
}

/// A curve of a loop.
#[derive(Clone, Debug, PartialEq)]
pub enum TrimCurve {
    /// A curve of (u, v), which no other patch shares.
    Parameters {
        /// The curve; its z is 0.
        curve: Curve,
        /// How its image in space is cut into edges; the model's spacing where there is none.
        rule: Option<Rule>,
        /// Marker of its edges.
        marker: Option<i32>,
    },
    /// A curve of space that lies on the surface: the same to the bit on all patches that share it.
    Space {
        /// The curve.
        curve: Curve,
        /// The same curve in (u, v), by the same parameter up to its range; found by projection
        /// where it is not given.
        parameters: Option<Curve>,
    },
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

impl Patch {
    /// A patch that its file says nothing more about: named and marked by its number from 1.
    #[must_use]
    pub fn plain(index: usize, surface: Surface) -> Self {
        let number = index + 1;
        let marker = i32::try_from(number).unwrap_or(i32::MAX);
        Self { name: number.to_string(), surface, marker, reversed: false }
    }
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
