//! Curves of a model that agree within a tolerance, made one: files without names for the edges that
//! faces share say them once for each face.

use super::{Model, TrimCurve};
use crate::curve::Curve;
use crate::curve::discretize::Track;
use crate::surface::Side;
use crate::vector::{Vector, distance};
use std::collections::BTreeMap;

/// Places where two curves are compared.
const SAMPLES: u32 = 32;
/// A tolerance below this fraction of the model's size is rounding, and welds nothing.
const LEAST: f64 = 1e-13;

impl Model {
    /// Makes curves one that trim patches and agree within `tolerance`: their ends, and 31 points
    /// between at equal parts of their parameters, one way or the other. Ends of such curves that lie
    /// within it become one point. Sides of patches are not moved; curves that agree with one become
    /// that side.
    ///
    /// # Complexity
    /// `n log n` for n curves of which few have their ends in common.
    pub fn weld(&mut self, tolerance: f64) {
        let size = self.diagonal();
        if !(tolerance > LEAST * size && tolerance.is_finite()) {
            return;
        }
        self.tolerance = Some(self.tolerance.unwrap_or(0.0).max(tolerance));
        let mut known = Known::new(tolerance);
        for named in &self.curves {
            known.keep(&named.curve);
        }
        for (i, patch) in self.patches.iter().enumerate() {
            if self.trims.get(&i).is_none_or(|trim| trim.outline.is_none()) {
                let sides = Side::ALL.map(|side| patch.surface.side(side));
                sides.iter().filter(|side| !side.is_point()).for_each(|side| known.keep(side));
            }
        }
        for trim in self.trims.values_mut() {
            for curve in trim.outline.iter_mut().chain(&mut trim.holes).flatten() {
                if let TrimCurve::Space { curve, .. } = curve {
                    known.settle(curve);
                }
            }
        }
    }
}

/// The curves met so far, and their ends.
struct Known {
    tolerance: f64,
    points: Vec<Vector>,
    /// Points by the cube that they lie in.
    cubes: BTreeMap<[i64; 3], Vec<usize>>,
    curves: BTreeMap<[usize; 2], Vec<Curve>>,
}

impl Known {
    fn new(tolerance: f64) -> Self {
        let (points, cubes, curves) = (Vec::new(), BTreeMap::new(), BTreeMap::new());
        Self { tolerance, points, cubes, curves }
    }

    fn cube(&self, p: Vector) -> [i64; 3] {
        p.map(|x| libm::floor(x / self.tolerance) as i64)
    }

    /// The first point within the tolerance of this one, which is added where there is none.
    fn point(&mut self, p: Vector) -> usize {
        let [x, y, z] = self.cube(p);
        let beside = |x: i64| x.saturating_sub(1)..=x.saturating_add(1);
        let mut near =
            beside(x).flat_map(|x| beside(y).flat_map(move |y| beside(z).map(move |z| [x, y, z])));
        let found = near.find_map(|cube| {
            let list = self.cubes.get(&cube)?;
            list.iter().copied().find(|&i| distance(self.points[i], p) <= self.tolerance)
        });
        found.unwrap_or_else(|| {
            self.points.push(p);
            self.cubes.entry([x, y, z]).or_default().push(self.points.len() - 1);
            self.points.len() - 1
        })
    }

    fn ends(&mut self, curve: &Curve) -> ([usize; 2], [usize; 2]) {
        let ends = curve.ends().map(|p| self.point(p));
        let mut sorted = ends;
        sorted.sort_unstable();
        (ends, sorted)
    }

    /// Takes a curve as it is.
    fn keep(&mut self, curve: &Curve) {
        let (_, ends) = self.ends(curve);
        self.curves.entry(ends).or_default().push(curve.clone());
    }

    /// Makes a curve the one that it agrees with, or moves its ends to the points that they are.
    fn settle(&mut self, curve: &mut Curve) {
        let (ends, sorted) = self.ends(curve);
        let tolerance = self.tolerance;
        let known = self.curves.entry(sorted).or_default();
        let same = known.iter().find_map(|known| {
            let backwards = || known.reversed();
            if agree(known, curve, tolerance) {
                return Some(known.clone());
            }
            agree(&backwards(), curve, tolerance).then(backwards)
        });
        *curve = same.unwrap_or_else(|| {
            let moved = curve.with_ends(ends.map(|i| self.points[i]));
            known.push(moved.clone());
            moved
        });
    }
}

fn agree(a: &Curve, b: &Curve, tolerance: f64) -> bool {
    let ([a0, a1], [b0, b1]) = (Track::domain(a), Track::domain(b));
    (0..=SAMPLES).all(|i| {
        let part = f64::from(i) / f64::from(SAMPLES);
        distance(a.at(a0 + part * (a1 - a0)), b.at(b0 + part * (b1 - b0))) <= tolerance
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Patch, Trim};
    use crate::surface::{Surface, Tensor};

    fn square(x: f64) -> Surface {
        let rows =
            [vec![[x, 0.0, 0.0], [x, 1.0, 0.0]], vec![[x + 1.0, 0.0, 0.0], [x + 1.0, 1.0, 0.0]]];
        Surface::Tensor(Tensor::bezier(&rows).expect("a square"))
    }

    fn line(a: Vector, b: Vector) -> TrimCurve {
        let curve = Curve::polyline(vec![a, b]).expect("a line");
        TrimCurve::Space { curve, parameters: None }
    }

    /// Two squares side by side, the edge between them said twice, `off` apart.
    fn two(off: f64) -> Model {
        let around = |x: f64, off: f64| {
            let corners = [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x + 1.0, 1.0, 0.0], [x, 1.0, 0.0]];
            let corners = corners.map(|[a, b, c]| [a + off, b, c]);
            let outline = (0..4).map(|i| line(corners[i], corners[(i + 1) % 4])).collect();
            Trim { outline: Some(outline), holes: Vec::new() }
        };
        let patches = vec![Patch::plain(0, square(0.0)), Patch::plain(1, square(1.0))];
        let trims = BTreeMap::from([(0, around(0.0, 0.0)), (1, around(1.0, off))]);
        Model { patches, trims, ..Model::default() }
    }

    fn curve(model: &Model, patch: usize, i: usize) -> Curve {
        let TrimCurve::Space { curve, .. } = &model.trims[&patch].outline.as_ref().expect("one")[i]
        else {
            panic!("a curve in space");
        };
        curve.clone()
    }

    // spec: S25
    #[test]
    fn curves_within_the_tolerance_become_one_and_their_ends_too() {
        let mut model = two(1e-7);
        assert_eq!(curve(&model, 0, 1).same_as(&curve(&model, 1, 3)), None);
        model.weld(1e-6);
        assert_eq!(curve(&model, 0, 1).same_as(&curve(&model, 1, 3)), Some(true));
        assert_eq!(curve(&model, 1, 0).ends()[0], [1.0, 0.0, 0.0], "moved to the first");
        assert_eq!(model.tolerance, Some(1e-6));
    }

    // spec: S25
    #[test]
    fn curves_farther_apart_stay_as_they_are() {
        for (off, tolerance) in [(1e-3, 1e-6), (1e-7, 0.0), (1e-7, f64::NAN), (1e-7, f64::INFINITY)]
        {
            let mut model = two(off);
            model.weld(tolerance);
            assert_eq!(curve(&model, 0, 1).same_as(&curve(&model, 1, 3)), None, "{tolerance}");
        }
    }

    // spec: S25
    #[test]
    fn a_curve_with_the_ends_of_a_side_but_another_way_is_not_the_side() {
        let mut model = two(1e-7);
        let bowed = vec![[1.0, 0.0, 0.0], [1.0, 0.5, 0.1], [1.0, 1.0, 0.0]];
        let bowed = Curve::clamped(2, bowed).expect("a curve");
        let outline = model.trims.get_mut(&0).and_then(|trim| trim.outline.as_mut());
        outline.expect("one")[1] = TrimCurve::Space { curve: bowed.clone(), parameters: None };
        model.weld(1e-6);
        assert_eq!(curve(&model, 0, 1), bowed);
        assert_eq!(bowed.same_as(&curve(&model, 1, 3)), None);
    }

    // spec: S25
    #[test]
    fn sides_of_patches_are_not_moved() {
        let mut model = two(1e-7);
        model.trims.remove(&0);
        model.weld(1e-6);
        let side = model.patches[0].surface.side(Side::East);
        assert_eq!(side.same_as(&curve(&model, 1, 3)), Some(true));
        assert_eq!(model.patches, two(0.0).patches);
    }
}
