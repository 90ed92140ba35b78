//! The model as vertices, curves and patches, and where it ends.

use super::foot::ROUNDING;
use crate::curve::Curve;
use crate::curve::discretize::Track;
use crate::mesh::MeshData;
use crate::model::{Model, Patch, Trim, TrimCurve};
use crate::surface::{Line, Side, Trace};
use crate::vector::{Vector, distance, dot, key, segment_distance_sq, sub};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// Parts of a curve's polygon.
const POLYGON: usize = 64;

/// Parts of a polygon that a foot is searched from.
const PARTS: usize = 3;

fn polygon(curve: &Line) -> Vec<Vector> {
    let [start, end] = curve.domain();
    (0..=POLYGON).map(|i| curve.at(start + (end - start) * (i as f64 / POLYGON as f64))).collect()
}

/// Whether a point lies on a curve up to rounding: Newton's steps from the nearest parts of its
/// polygon.
fn is_on(curve: &Line, polygon: &[Vector], p: Vector, tolerance: f64) -> bool {
    let [start, end] = curve.domain();
    let mut order: Vec<(f64, usize)> =
        (0..POLYGON).map(|i| (segment_distance_sq(polygon[i], polygon[i + 1], p), i)).collect();
    order.select_nth_unstable_by(PARTS, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    order[..PARTS].iter().any(|&(_, i)| {
        let mut t = start + (end - start) * ((i as f64 + 0.5) / POLYGON as f64);
        for _ in 0..20 {
            let jet = curve.jet(t);
            if distance(jet.point, p) <= 1e-3 * tolerance {
                return true;
            }
            let step = dot(sub(p, jet.point), jet.first) / dot(jet.first, jet.first);
            t = if step.is_finite() { (t + step).clamp(start, end) } else { t };
        }
        distance(curve.at(t), p) <= tolerance
    })
}

/// A curve where the model ends.
struct End<'a> {
    curve: &'a Line,
    polygon: Vec<Vector>,
    /// A box that holds it: that of its polygon and a part of it more on each side.
    low: Vector,
    high: Vector,
}

impl<'a> End<'a> {
    fn new(curve: &'a Line) -> Self {
        let polygon = polygon(curve);
        let parts = polygon.windows(2).map(|pair| distance(pair[0], pair[1]));
        let longest = parts.fold(0.0, f64::max);
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in &polygon {
            for i in 0..3 {
                (low[i], high[i]) = (low[i].min(p[i] - longest), high[i].max(p[i] + longest));
            }
        }
        Self { curve, polygon, low, high }
    }

    fn holds(&self, p: Vector, tolerance: f64) -> bool {
        let near =
            (0..3).all(|i| p[i] >= self.low[i] - tolerance && p[i] <= self.high[i] + tolerance);
        near && is_on(self.curve, &self.polygon, p, tolerance)
    }
}

/// Where the model ends.
pub(super) struct Boundary<'a> {
    pub(super) model: &'a Model,
    pub(super) complex: &'a Complex,
    /// How far off is rounding.
    pub(super) tolerance: f64,
}

impl Boundary<'_> {
    /// The ends of the model's curves that are no vertices of the mesh.
    pub(super) fn missing_corners(&self, mesh: &MeshData) -> Vec<Vector> {
        let mut corners: BTreeMap<[u64; 3], Vector> =
            self.complex.ends().map(|p| (key(p), p)).collect();
        mesh.points.iter().for_each(|&p| {
            corners.remove(&key(p));
        });
        let rounding = (!self.model.trims.is_empty()).then_some(self.tolerance);
        let is_near = |p: Vector| {
            let close = |tolerance| mesh.points.iter().any(|&q| distance(p, q) <= tolerance);
            self.model.corner_tolerance.or(rounding).is_some_and(close)
        };
        corners.into_values().filter(|&p| !is_near(p)).collect()
    }

    /// Those of some vertices that lie on no curve where the model ends.
    pub(super) fn off(&self, mesh: &MeshData, vertices: &[u32]) -> Vec<u32> {
        let ends: Vec<End<'_>> = self.complex.boundary().map(End::new).collect();
        let is_off = |v: &&u32| {
            let p = mesh.points[**v as usize];
            !ends.iter().any(|end| end.holds(p, self.tolerance))
        };
        vertices.par_iter().filter(is_off).copied().collect()
    }
}

/// Curves by their sorted ends.
type ByEnds = BTreeMap<[[u64; 3]; 2], Vec<usize>>;

/// The model as a complex of vertices, curves and patches.
pub(super) struct Complex {
    /// Each curve once, with the number of sides that it is.
    curves: Vec<(Line, u32)>,
    poles: BTreeSet<[u64; 3]>,
    /// Euler numbers of the patches without their boundaries, summed.
    faces: i64,
    /// Ends of curves that are not farther apart are one vertex: those of loops meet up to rounding.
    tolerance: f64,
}

impl Complex {
    pub(super) fn of(model: &Model) -> Self {
        let rounding = if model.trims.is_empty() { 0.0 } else { ROUNDING * model.diagonal() };
        let tolerance = model.tolerance.unwrap_or(0.0).max(rounding);
        let (curves, poles) = (Vec::new(), BTreeSet::new());
        let mut complex = Self { curves, poles, faces: 0, tolerance };
        let mut known: ByEnds = BTreeMap::new();
        for (i, patch) in model.patches.iter().enumerate() {
            let trim = model.trims.get(&i);
            for piece in patch.surface.pieces() {
                complex.faces += 1 - trim.map_or(0, |trim| trim.holes.len() as i64);
                if trim.is_none_or(|trim| trim.outline.is_none()) {
                    complex.add_sides(Side::ALL.map(|side| piece.side(side)), &mut known);
                }
            }
            if let Some(trim) = trim {
                complex.add_loops(trim, patch, &mut known);
            }
        }
        complex
    }

    fn add_sides(&mut self, sides: [Curve; 4], known: &mut ByEnds) {
        for side in sides {
            match side.is_point() {
                true => drop(self.poles.insert(key(side.ends()[0]))),
                false => side.pieces().into_iter().for_each(|curve| self.add(curve, known)),
            }
        }
    }

    fn add_loops(&mut self, trim: &Trim, patch: &Patch, known: &mut ByEnds) {
        for curve in trim.loops().flatten() {
            match curve {
                TrimCurve::Space { curve, .. } => {
                    let pieces = curve.pieces().into_iter().filter(|piece| !piece.is_point());
                    pieces.for_each(|piece| self.add(piece, known));
                }
                TrimCurve::Parameters { curve, .. } => {
                    for parameters in curve.pieces() {
                        let trace = Trace { surface: patch.surface.clone(), parameters };
                        self.curves.push((Line::Trace(Box::new(trace)), 1));
                    }
                }
            }
        }
    }

    fn add(&mut self, curve: Curve, known: &mut ByEnds) {
        let mut ends = curve.ends().map(key);
        ends.sort_unstable();
        let known = known.entry(ends).or_default();
        let same = |&&i: &&usize| self.curves[i].0.same_as(&curve).is_some();
        match known.iter().find(same) {
            Some(&i) => self.curves[i].1 += 1,
            None => {
                known.push(self.curves.len());
                self.curves.push((Line::Curve(curve), 1));
            }
        }
    }

    /// The ends of all curves.
    fn ends(&self) -> impl Iterator<Item = Vector> + '_ {
        self.curves.iter().flat_map(|(curve, _)| curve.ends())
    }

    /// The curves that are a side of one patch only.
    fn boundary(&self) -> impl Iterator<Item = &Line> {
        self.curves.iter().filter(|(_, uses)| *uses == 1).map(|(curve, _)| curve)
    }

    pub(super) fn euler(&self) -> i64 {
        let ends = self.ends().map(|p| (key(p), p));
        let ends: BTreeMap<[u64; 3], Vector> = ends.collect();
        let mut vertices: Vec<Vector> = Vec::new();
        for p in ends.values() {
            let is_known = |q: &Vector| self.tolerance > 0.0 && distance(*p, *q) <= self.tolerance;
            if !vertices.iter().any(is_known) {
                vertices.push(*p);
            }
        }
        let alone = self.poles.iter().filter(|pole| !ends.contains_key(*pole)).count();
        (vertices.len() + alone) as i64 - self.curves.len() as i64 + self.faces
    }
}
