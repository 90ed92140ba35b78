//! Parts and images of NURBS surfaces, and creases that are none.

use super::super::SurfaceError;
use super::Tensor;
use crate::curve::CurveError;
use crate::curve::cut::{Weighted, between, projected, weighted};
use crate::vector::{Vector, cross, norm, sub, unit};

/// Places along a line where the normals on its two sides are compared.
const SAMPLES: u32 = 8;
/// Normals that differ by less than this (radians) are those of a smooth surface.
const SMOOTH: f64 = 1e-6;

impl Tensor {
    /// The part between two rising parameters of either direction, clamped all around.
    ///
    /// # Errors
    /// A range with nothing in it.
    pub fn part(&self, ranges: [[f64; 2]; 2]) -> Result<Self, SurfaceError> {
        let domain = self.domain();
        let mut clipped = [[0.0; 2]; 2];
        for (i, direction) in ['u', 'v'].into_iter().enumerate() {
            clipped[i] = [ranges[i][0].max(domain[i][0]), ranges[i][1].min(domain[i][1])];
            let is_range = clipped[i][0] < clipped[i][1];
            if !is_range {
                return Err(SurfaceError::Spline { direction, error: CurveError::NoRange });
            }
        }
        let [rows, columns] = self.counts;
        let weight = |k: usize| self.weights.get(k).copied().unwrap_or(1.0);
        let row = |i: usize| -> Vec<Weighted> {
            (i * columns..(i + 1) * columns).map(|k| weighted(self.net[k], weight(k))).collect()
        };
        let [du, dv] = self.degrees;
        let mut knots = [Vec::new(), Vec::new()];
        let mut net: Vec<Vec<Weighted>> = Vec::new();
        for i in 0..rows {
            let (along_v, points) = between(dv, &self.knots[1], &row(i), clipped[1]);
            knots[1] = along_v;
            net.push(points);
        }
        let mut lines: Vec<Vec<Weighted>> = Vec::new();
        for j in 0..net[0].len() {
            let line: Vec<Weighted> = net.iter().map(|row| row[j]).collect();
            let (along_u, points) = between(du, &self.knots[0], &line, clipped[0]);
            knots[0] = along_u;
            lines.push(points);
        }
        let counts = [lines[0].len(), lines.len()];
        let all = || (0..counts[0]).flat_map(|i| lines.iter().map(move |line| line[i]));
        let net = all().map(projected).collect();
        let weights =
            if self.weights.is_empty() { Vec::new() } else { all().map(|p| p[3]).collect() };
        let tables = super::tables(&knots, self.degrees, counts);
        Ok(Self { degrees: self.degrees, knots, tables, counts, net, weights, is_joined: false })
    }

    /// Its image under an affine map.
    #[must_use]
    pub fn mapped(&self, map: impl Fn(Vector) -> Vector) -> Self {
        Self { net: self.net.iter().map(|&p| map(p)).collect(), ..self.clone() }
    }

    /// See [`Surface::joined`](super::super::Surface::joined).
    pub(in super::super) fn joined(self) -> Self {
        let pieces = self.pieces();
        let first = pieces[0].domain()[0];
        let columns = pieces.iter().take_while(|piece| piece.domain()[0] == first).count();
        let is_smooth = (0..pieces.len()).all(|k| {
            let meets = |before: usize, i: usize| pieces[before].meets_smoothly(&pieces[k], i);
            (k < columns || meets(k - columns, 0)) && (k % columns == 0 || meets(k - 1, 1))
        });
        Self { is_joined: is_smooth, ..self }
    }

    /// Whether the normals agree where the other piece follows in direction `i`.
    fn meets_smoothly(&self, next: &Self, i: usize) -> bool {
        let (own, other) = (self.domain(), next.domain());
        (0..=SAMPLES).all(|k| {
            let [low, high] = own[1 - i];
            let t = low + f64::from(k) / f64::from(SAMPLES) * (high - low);
            let at = |s: f64| if i == 0 { [s, t] } else { [t, s] };
            let normal = |of: &Self, [u, v]: [f64; 2]| {
                let tangents = of.tangents(u, v);
                unit(cross(tangents.u, tangents.v))
            };
            match (normal(self, at(own[i][1])), normal(next, at(other[i][0]))) {
                (Some(a), Some(b)) => norm(sub(a, b)) <= SMOOTH,
                (a, b) => a.is_none() && b.is_none(),
            }
        })
    }

    /// Whether its knots are clamped all around, so that its sides are rows of its net.
    #[must_use]
    pub fn is_clamped(&self) -> bool {
        let domain = self.domain();
        (0..2).all(|i| {
            let [start, end] = domain[i];
            let times = |t: f64| self.knots[i].iter().filter(|&&knot| knot == t).count();
            times(start) > self.degrees[i] && times(end) > self.degrees[i]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::Curve;
    use crate::vector::distance;

    fn bumps() -> Tensor {
        let row = |i: u32| -> Vec<Vector> {
            (0..6).map(|j| [f64::from(i), f64::from(j), f64::from((3 * i + 2 * j) % 5)]).collect()
        };
        let rows: Vec<Vec<Vector>> = (0..5).map(row).collect();
        let weights: Vec<Vec<f64>> =
            (0..5).map(|i| (0..6).map(|j| 1.0 + 0.25 * f64::from((i + j) % 3)).collect()).collect();
        let uniform = |n: u32| (0..n).map(f64::from).collect();
        Tensor::new([2, 3], [uniform(8), uniform(10)], &rows, &weights).expect("a surface")
    }

    // spec: S3
    #[test]
    fn a_part_is_the_same_surface_and_clamped() {
        let whole = bumps();
        assert!(!whole.is_clamped());
        let [[u0, u1], [v0, v1]] = whole.domain();
        for ranges in [[[u0, u1], [v0, v1]], [[2.5, 4.0], [3.0, 5.75]], [[3.0, 3.25], [4.5, 4.75]]]
        {
            let part = whole.part(ranges).expect("a part");
            assert!(part.is_clamped() && part.domain() == ranges);
            for k in 0..81_u32 {
                let at = |i: usize, k: u32| {
                    ranges[i][0] + f64::from(k) / 8.0 * (ranges[i][1] - ranges[i][0])
                };
                let (u, v) = (at(0, k % 9), at(1, k / 9));
                assert!(distance(part.at(u, v), whole.at(u, v)) < 1e-12, "{u} {v}");
            }
        }
        assert!(whole.part([[9.0, 10.0], [v0, v1]]).is_err());
        assert!(whole.part([[u0, u1], [5.0, 5.0]]).is_err());
    }

    // spec: S3
    #[test]
    fn quarters_of_a_cylinder_are_one_piece_and_a_ridge_is_not() {
        let circle = Curve::circle([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]).expect("a circle");
        let lift = |p: &Vector| vec![*p, [p[0], p[1], 2.0]];
        let rows: Vec<Vec<Vector>> = circle.points().iter().map(lift).collect();
        let weights: Vec<Vec<f64>> = circle.weights().iter().map(|&w| vec![w, w]).collect();
        let knots = [circle.knots().to_vec(), vec![0.0, 0.0, 1.0, 1.0]];
        let tube = Tensor::new([2, 1], knots, &rows, &weights).expect("a tube");
        assert_eq!(tube.pieces().len(), 4);
        assert_eq!(tube.joined().pieces().len(), 1);
        let net = [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [2.0, 0.0, 0.0]];
        let rows: Vec<Vec<Vector>> = net.iter().map(|p| vec![*p, [p[0], 1.0, p[2]]]).collect();
        let ridge = Tensor::clamped([1, 1], &rows).expect("a roof");
        assert_eq!(ridge.joined().pieces().len(), 2);
    }
}
