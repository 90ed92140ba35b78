//! Values that colour the triangles of a mesh.

use crate::mesh::MeshData;
use serde::Serialize;

/// Which end of a measure is the good one; the good end is drawn light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Better {
    /// Small values are good, as for R/(2r).
    Low,
    /// Large values are good, as for the smallest angle.
    High,
}

/// One value for each triangle, and how to show them.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// What the values are, as the legend prints it, e.g. `R/(2r)`.
    pub name: String,
    /// One a triangle, in the mesh's order; NaN is drawn grey as "no value".
    pub values: Vec<f64>,
    /// The values at the two ends of the palette, low one first; values outside take the end's
    /// colour. The same range in every picture makes pictures comparable.
    pub range: [f64; 2],
    /// Which end is good.
    pub better: Better,
}

impl Layer {
    /// A layer whose range is that of its finite values.
    #[must_use]
    pub fn new(name: impl Into<String>, values: Vec<f64>, better: Better) -> Self {
        let finite = values.iter().copied().filter(|v| v.is_finite());
        let (low, high) = finite
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        let range = if low <= high { [low, high] } else { [0.0, 1.0] };
        Self { name: name.into(), values, range, better }
    }

    /// R/(2r), circumradius over twice the inradius, of every triangle: 1 is equilateral, infinite
    /// is flat. Coloured over [1, 1.6] so that pictures of different meshes compare.
    #[must_use]
    pub fn radius_ratio(mesh: &MeshData) -> Self {
        let values = mesh.triangles.iter().map(|&t| radius_ratio(mesh, t)).collect();
        Self { range: [1.0, 1.6], ..Self::new("R/(2r)", values, Better::Low) }
    }

    /// Where `value` lies in the palette: 0 at the good end, 1 at the bad one; `None` for NaN.
    pub(super) fn badness(&self, value: f64) -> Option<f64> {
        if value.is_nan() {
            return None;
        }
        let t = self.fraction(value);
        Some(if self.better == Better::Low { t } else { 1.0 - t })
    }

    /// Where `value` lies in the range, clamped to [0, 1]; NaN gives 0.
    pub(super) fn fraction(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        if high <= low {
            return if value > high { 1.0 } else { 0.0 };
        }
        // Halves, so that the difference of huge values does not overflow.
        let t = (value / 2.0 - low / 2.0) / (high / 2.0 - low / 2.0);
        if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) }
    }

    /// The value at fraction `t` of the range.
    pub(super) fn value_at(&self, t: f64) -> f64 {
        self.range[0] * (1.0 - t) + self.range[1] * t
    }
}

/// R/(2r) = a b c (a + b + c) / (16 K²) with sides a, b, c and area K; NaN for a bad index.
fn radius_ratio(mesh: &MeshData, triangle: [u32; 3]) -> f64 {
    let Some([p, q, r]) = corners(mesh, triangle) else { return f64::NAN };
    let sides = [sub(r, q), sub(p, r), sub(q, p)];
    // Scaled by the longest coordinate difference: products neither overflow nor underflow.
    let size = sides.iter().flatten().fold(0.0_f64, |m, c| m.max(c.abs()));
    if size == 0.0 {
        return f64::INFINITY;
    }
    let [a, b, c] = sides.map(|s| s.map(|x| x / size));
    let [la, lb, lc] = [a, b, c].map(norm);
    let twice_area = norm(cross(b, c));
    la * lb * lc * (la + lb + lc) / (4.0 * twice_area * twice_area)
}

/// The corners of a triangle, `None` if one does not exist or is not finite.
pub(super) fn corners(mesh: &MeshData, triangle: [u32; 3]) -> Option<[[f64; 3]; 3]> {
    let [a, b, c] = triangle.map(|v| mesh.points.get(v as usize).copied());
    let corners = [a?, b?, c?];
    corners.iter().flatten().all(|x| x.is_finite()).then_some(corners)
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn norm(a: [f64; 3]) -> f64 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(points: [[f64; 3]; 3]) -> MeshData {
        MeshData { points: points.to_vec(), triangles: vec![[0, 1, 2]], ..MeshData::default() }
    }

    fn ratio(points: [[f64; 3]; 3]) -> f64 {
        Layer::radius_ratio(&mesh(points)).values[0]
    }

    #[test]
    fn radius_ratio_of_known_triangles() {
        let h = 3.0_f64.sqrt() / 2.0;
        let equilateral = ratio([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, h, 0.0]]);
        assert!((equilateral - 1.0).abs() < 1e-14, "{equilateral}");
        // 3-4-5: R = 5/2, r = 1.
        let right = ratio([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 3.0, 0.0]]);
        assert!((right - 1.25).abs() < 1e-14, "{right}");
        let in_space = ratio([[0.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 4.0, 3.0]]);
        assert!((in_space - 1.25).abs() < 1e-14, "{in_space}");
    }

    #[test]
    fn radius_ratio_is_scale_free_and_flat_is_infinite() {
        for scale in [1e-300, 1.0, 1e300] {
            let right = ratio([[0.0, 0.0, 0.0], [4.0 * scale, 0.0, 0.0], [0.0, 3.0 * scale, 0.0]]);
            assert!((right - 1.25).abs() < 1e-12, "{right} at {scale}");
        }
        assert_eq!(ratio([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0]]), f64::INFINITY);
        assert_eq!(ratio([[1.0, 1.0, 0.0]; 3]), f64::INFINITY);
    }

    #[test]
    fn bad_triangles_have_no_value() {
        let mut bad = mesh([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, f64::NAN, 0.0]]);
        assert!(Layer::radius_ratio(&bad).values[0].is_nan());
        bad.triangles[0] = [0, 1, 7];
        assert!(Layer::radius_ratio(&bad).values[0].is_nan());
    }

    #[test]
    fn badness_runs_from_the_good_end() {
        let mut layer = Layer::new("angle", vec![10.0, 60.0, f64::NAN], Better::High);
        assert_eq!(layer.range, [10.0, 60.0]);
        assert_eq!(layer.badness(60.0), Some(0.0));
        assert_eq!(layer.badness(10.0), Some(1.0));
        assert_eq!(layer.badness(f64::NAN), None);
        layer.better = Better::Low;
        assert_eq!(layer.badness(f64::INFINITY), Some(1.0));
        assert_eq!(layer.badness(f64::NEG_INFINITY), Some(0.0));
    }

    #[test]
    fn degenerate_and_huge_ranges_do_not_divide_by_zero() {
        let flat = Layer::new("x", vec![5.0, 5.0], Better::Low);
        assert_eq!(flat.badness(5.0), Some(0.0));
        let huge = Layer::new("x", vec![-1.7e308, 1.7e308], Better::Low);
        assert_eq!(huge.badness(0.0), Some(0.5));
        let none = Layer::new("x", vec![f64::NAN], Better::Low);
        assert_eq!(none.range, [0.0, 1.0]);
    }
}
