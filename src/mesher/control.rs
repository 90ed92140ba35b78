//! Making the mesh as large as is wanted: the field is made coarser or finer until it fits.
//!
//! One number varies: the coarseness. It first raises or lowers the slope of the growth field
//! between bounds within which meshes are good, and beyond them scales the whole field.

use super::field::{Fields, Tuning};
use super::options::{Count, Gradation, Method, Options};
use super::refined::TRIANGLES_PER_BOUND;
use super::scale::Scale;
use super::{MeshError, Meshed};
use crate::background::Background;
use crate::size::Prediction;

/// Slopes between which coarseness is spent on the growth field.
const SLOPE: [f64; 2] = [0.12, 0.5];
/// Octaves of coarseness searched either way.
const OCTAVES: f64 = 12.0;
/// A prediction this near to what is wanted, in octaves, is near enough.
const NEAR: f64 = 0.008;
/// Fields tried for one prediction.
const STEPS: u32 = 40;
/// An interval of coarseness below this cannot be told apart.
const WIDTH_MIN: f64 = 4e-3;
/// A mesh whose count misses the target by no more than this is taken at once.
const TARGET_MISS: f64 = 0.02;
/// Meshes made for one target.
const RUNS_MAX: usize = 6;
/// Counts jump where a layer more or less fits, and then go back and forth. A mesh that still misses
/// by more than the second figure is tried at other predictions near the target.
const DETOURS: [f64; 8] = [1.0, 0.98, 1.02, 0.96, 1.04, 0.94, 1.06, 0.92];
const DETOUR_MISS: f64 = 0.05;
/// Share of the limit that a coarsened mesh is planned to have: predictions err.
const COARSEN_SHARE: f64 = 0.85;

/// Fields of one domain at any coarseness.
pub(super) struct Control<'a> {
    pub(super) background: &'a Background,
    pub(super) options: &'a Options,
    pub(super) scale: &'a Scale,
}

impl Control<'_> {
    /// The field that fits the wanted count, and its prediction.
    ///
    /// # Errors
    /// A prediction above the limit, or a field that is none.
    pub(super) fn fields(&self) -> Result<(Fields, Prediction), MeshError> {
        let limit = self.options.triangles_max;
        let (fields, prediction) = match self.options.count {
            Count::Target(wanted) => self.fitting(wanted as f64)?,
            Count::Field | Count::Coarsen => self.at(0.0, limit)?,
        };
        if prediction.triangles <= limit as f64 {
            return Ok((fields, prediction));
        }
        if self.options.count == Count::Coarsen {
            let (fields, prediction) = self.fitting(COARSEN_SHARE * limit as f64)?;
            if prediction.triangles <= limit as f64 {
                return Ok((fields, prediction));
            }
        }
        let Prediction { triangles: predicted, stopped } = prediction;
        Err(MeshError::TooMany { predicted, stopped, limit })
    }

    /// The field at a coarseness in octaves, and its prediction.
    fn at(&self, coarseness: f64, limit: usize) -> Result<(Fields, Prediction), MeshError> {
        let tuning = self.tuning(coarseness);
        let fields = Fields::new(self.background, self.options, self.scale, tuning)?;
        let mut prediction = fields.predict(limit);
        if self.options.method == Method::Delaunay {
            prediction.triangles *= TRIANGLES_PER_BOUND;
        }
        fields.sound()?;
        Ok((fields, prediction))
    }

    fn tuning(&self, coarseness: f64) -> Tuning {
        let growth = self.options.growth;
        let ratio = libm::exp2(coarseness);
        let is_growth = self.options.gradation == Gradation::Growth
            && !matches!(self.options.method, Method::Afm | Method::Direct);
        if !is_growth || growth == 0.0 {
            return Tuning { growth, factor: ratio };
        }
        let [low, high] = SLOPE;
        let tuned = (growth * ratio).clamp(low.min(growth), high.max(growth));
        Tuning { growth: tuned, factor: ratio * (growth / tuned) }
    }

    /// The field whose prediction is near `wanted`, by the rule of false position on logarithms,
    /// from the interval's middle where that rule creeps.
    fn fitting(&self, wanted: f64) -> Result<(Fields, Prediction), MeshError> {
        let enough = (16.0 * wanted) as usize + 1000;
        let (mut fine, mut coarse) = ((-OCTAVES, None), (OCTAVES, None));
        let mut at = 0.0;
        let mut found = self.at(at, enough)?;
        for step in 0..STEPS {
            let excess = libm::log2(found.1.triangles / wanted);
            if excess.abs() <= NEAR {
                break;
            }
            // A stopped prediction says only that it is too fine.
            let known = (!found.1.stopped).then_some(excess);
            if excess > 0.0 {
                fine = (at, known);
            } else {
                coarse = (at, known);
            }
            let width = coarse.0 - fine.0;
            if width < WIDTH_MIN {
                break;
            }
            at = match (fine.1, coarse.1) {
                (Some(above), Some(below)) if step % 3 != 2 => {
                    fine.0 + width * (above / (above - below)).clamp(0.05, 0.95)
                }
                (Some(above), None) => (fine.0 + above).min(fine.0 + 0.5 * width),
                (None, Some(below)) => (coarse.0 + below).max(coarse.0 - 0.5 * width),
                _ => 0.5 * (fine.0 + coarse.0),
            };
            found = self.at(at, enough)?;
        }
        Ok(found)
    }

    /// Repeats `mesh` with fields of other counts until the mesh has the target's.
    pub(super) fn hit(
        &self,
        target: usize,
        first: Meshed,
        mut mesh: impl FnMut(&Fields, Prediction) -> Result<Meshed, MeshError>,
    ) -> Result<Meshed, MeshError> {
        let miss = |m: &Meshed| (m.mesh.triangles.len() as f64 / target as f64 - 1.0).abs();
        let mut best = first;
        let mut wanted = best.prediction.triangles;
        let mut count = best.mesh.triangles.len() as f64;
        for run in 1..RUNS_MAX + DETOURS.len() {
            let detour = run.checked_sub(RUNS_MAX).map(|i| DETOURS[i]);
            if miss(&best) <= if detour.is_some() { DETOUR_MISS } else { TARGET_MISS } {
                break;
            }
            wanted = match detour {
                None => wanted * (target as f64 / count),
                Some(factor) => target as f64 * factor,
            };
            let (fields, prediction) = self.fitting(wanted)?;
            if prediction.triangles > self.options.triangles_max as f64 {
                break;
            }
            if prediction == best.prediction && detour.is_none() {
                // The boundary alone decides.
                break;
            }
            let next = mesh(&fields, prediction)?;
            count = next.mesh.triangles.len() as f64;
            if miss(&next) < miss(&best) {
                best = next;
            }
        }
        Ok(best)
    }
}
