//! Tensor products of NURBS.

mod cut;

use super::{Side, SurfaceError, SurfaceJet, Tangents};
use crate::curve::basis::{Basis, NARROW, Table, WIDTH};
use crate::curve::{
    Curve, CurveError, check_knots, check_points, clamped_knots, cuts, piece_knots,
};
use crate::vector::{Vector, add, along, scale, sub};

/// A NURBS surface.
///
/// # Shapes and units
/// `net: [rows * columns]` with the point (i, j) at `i * columns + j`: i counts along u, j along v.
#[derive(Clone, Debug, PartialEq)]
pub struct Tensor {
    degrees: [usize; 2],
    knots: [Vec<f64>; 2],
    tables: [Table; 2],
    counts: [usize; 2],
    net: Vec<Vector>,
    weights: Vec<f64>,
    /// Whether lines of full multiplicity are no creases: the surface is one piece.
    is_joined: bool,
}

/// Weighted sums for one order of derivatives in either direction.
#[derive(Clone, Copy, Default)]
struct Sum {
    point: Vector,
    weight: f64,
}

impl Sum {
    #[inline]
    fn add(&mut self, part: f64, other: &Self) {
        self.point = along(self.point, part, other.point);
        self.weight += part * other.weight;
    }
}

impl Tensor {
    /// A NURBS surface from the rows of its control net (a row has u constant); `weights` is empty
    /// or has the same shape.
    ///
    /// # Errors
    /// The first rule that the numbers break.
    pub fn new(
        degrees: [usize; 2],
        knots: [Vec<f64>; 2],
        rows: &[Vec<Vector>],
        weights: &[Vec<f64>],
    ) -> Result<Self, SurfaceError> {
        let counts = [rows.len(), rows.first().map_or(0, Vec::len)];
        let lengths = rows.iter().map(Vec::len).chain(weights.iter().map(Vec::len));
        for (row, found) in lengths.enumerate() {
            if found != counts[1] {
                let row = row % rows.len().max(1);
                return Err(SurfaceError::Net { row, found, expected: counts[1] });
            }
        }
        for (i, direction) in ['u', 'v'].into_iter().enumerate() {
            check_knots(degrees[i], &knots[i], counts[i])
                .map_err(|error| SurfaceError::Spline { direction, error })?;
        }
        let (net, weights) = (rows.concat(), weights.concat());
        check_points(&net, &weights)
            .map_err(|error| SurfaceError::Spline { direction: 'u', error })?;
        let tables = tables(&knots, degrees, counts);
        Ok(Self { degrees, knots, tables, counts, net, weights, is_joined: false })
    }

    /// The Bezier patch of a control net: degrees by the size of the net, parameters from 0 to 1.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn bezier(rows: &[Vec<Vector>]) -> Result<Self, SurfaceError> {
        let degrees = [rows.len(), rows.first().map_or(0, Vec::len)].map(|n| n.saturating_sub(1));
        Self::clamped(degrees, rows)
    }

    /// The B-spline surface of a control net with knots 0, 1, 2, ... that reaches its edges.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn clamped(degrees: [usize; 2], rows: &[Vec<Vector>]) -> Result<Self, SurfaceError> {
        let counts = [rows.len(), rows.first().map_or(0, Vec::len)];
        for i in 0..2 {
            if degrees[i] >= counts[i] {
                let error = CurveError::TooFewPoints { points: counts[i], degree: degrees[i] };
                return Err(SurfaceError::Spline { direction: ['u', 'v'][i], error });
            }
        }
        let knots = [0, 1].map(|i| clamped_knots(degrees[i], counts[i]));
        Self::new(degrees, knots, rows, &[])
    }

    pub(super) fn domain(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|i| [self.knots[i][self.degrees[i]], self.knots[i][self.counts[i]]])
    }

    pub(super) fn at(&self, u: f64, v: f64) -> Vector {
        self.all_sums::<1>(u, v)[0][0].point()
    }

    pub(super) fn tangents(&self, u: f64, v: f64) -> Tangents {
        match self.is_narrow() && self.weights.is_empty() {
            true => self.plain_tangents(u, v),
            false => tangents(&self.all_sums::<2>(u, v)),
        }
    }

    pub(super) fn jet(&self, u: f64, v: f64) -> SurfaceJet {
        let sums = self.all_sums::<3>(u, v);
        let first = self.tangents(u, v);
        let Tangents { point, u: du, v: dv } = first;
        let weight = sums[0][0].weight;
        let (wu, wv) = (sums[1][0].weight, sums[0][1].weight);
        // The quotient rule, once more.
        let second = |sum: &Sum, terms: [(f64, Vector); 3]| {
            let rest = terms.iter().fold(sum.point, |rest, (part, a)| along(rest, -part, *a));
            scale(1.0 / weight, rest)
        };
        SurfaceJet {
            tangents: first,
            uu: second(&sums[2][0], [(2.0 * wu, du), (sums[2][0].weight, point), (0.0, du)]),
            uv: second(&sums[1][1], [(wu, dv), (wv, du), (sums[1][1].weight, point)]),
            vv: second(&sums[0][2], [(2.0 * wv, dv), (sums[0][2].weight, point), (0.0, dv)]),
        }
    }

    /// Whether the basis functions fit a narrow array.
    fn is_narrow(&self) -> bool {
        self.degrees.iter().all(|&degree| degree < NARROW)
    }

    /// Point and tangents where the degrees are low and all weights are 1: the usual case.
    fn plain_tangents(&self, u: f64, v: f64) -> Tangents {
        let (u, v) = (self.narrow_basis::<2>(0, u), self.narrow_basis::<2>(1, v));
        let mut sums = Tangents { point: [0.0; 3], u: [0.0; 3], v: [0.0; 3] };
        let mut base = [0.0; 3];
        for r in 0..=self.degrees[0] {
            let start = (u.first + r) * self.counts[1] + v.first;
            let controls = &self.net[start..=start + self.degrees[1]];
            // From the first point of the row, and from the first row: derivatives between equal
            // points, those of a pole, are then exactly 0.
            let (mut row, mut slope) = (controls[0], [0.0; 3]);
            for (s, &control) in controls.iter().enumerate().skip(1) {
                let arm = sub(control, controls[0]);
                row = along(row, v.rows[0][s], arm);
                slope = along(slope, v.rows[1][s], arm);
            }
            if r == 0 {
                base = row;
            }
            let arm = sub(row, base);
            sums.point = along(sums.point, u.rows[0][r], arm);
            sums.u = along(sums.u, u.rows[1][r], arm);
            sums.v = along(sums.v, u.rows[0][r], slope);
        }
        Tangents { point: add(base, sums.point), ..sums }
    }

    /// Sums for orders of derivatives by u and by v that are together below N.
    fn all_sums<const N: usize>(&self, u: f64, v: f64) -> [[Sum; N]; N] {
        match self.is_narrow() {
            true => self.sums(&self.basis::<N, NARROW>(0, u), &self.basis::<N, NARROW>(1, v)),
            false => self.sums(&self.basis::<N, WIDTH>(0, u), &self.basis::<N, WIDTH>(1, v)),
        }
    }

    fn sums<const N: usize, const W: usize>(
        &self,
        u: &Basis<N, W>,
        v: &Basis<N, W>,
    ) -> [[Sum; N]; N] {
        let mut sums = [[Sum::default(); N]; N];
        for r in 0..=self.degrees[0] {
            let mut row = [Sum::default(); N];
            let start = (u.first + r) * self.counts[1] + v.first;
            for s in 0..=self.degrees[1] {
                let weight = self.weights.get(start + s).copied().unwrap_or(1.0);
                let control = Sum { point: scale(weight, self.net[start + s]), weight };
                for (sum, parts) in row.iter_mut().zip(&v.rows) {
                    sum.add(parts[s], &control);
                }
            }
            for (i, (line, parts)) in sums.iter_mut().zip(&u.rows).enumerate() {
                for (sum, along_v) in line[..N - i].iter_mut().zip(&row) {
                    sum.add(parts[r], along_v);
                }
            }
        }
        sums
    }

    /// By the table, if it has one for the parameter.
    #[inline]
    fn narrow_basis<const N: usize>(&self, direction: usize, t: f64) -> Basis<N, NARROW> {
        self.tables[direction].at(t).unwrap_or_else(|| self.basis(direction, t))
    }

    #[inline]
    fn basis<const N: usize, const W: usize>(&self, direction: usize, t: f64) -> Basis<N, W> {
        let (degree, count) = (self.degrees[direction], self.counts[direction]);
        let knots = &self.knots[direction];
        Basis::at(knots, degree, count, t.clamp(knots[degree], knots[count]))
    }

    pub(super) fn side(&self, side: Side) -> Curve {
        let [rows, columns] = self.counts;
        let index = |k: usize| match side {
            Side::South => k * columns,
            Side::North => k * columns + columns - 1,
            Side::West => k,
            Side::East => (rows - 1) * columns + k,
        };
        let along_u = matches!(side, Side::South | Side::North);
        let direction = usize::from(!along_u);
        let count = self.counts[direction];
        let points = (0..count).map(|k| self.net[index(k)]).collect();
        let weights = match self.weights.is_empty() {
            true => Vec::new(),
            false => (0..count).map(|k| self.weights[index(k)]).collect(),
        };
        let knots = self.knots[direction].clone();
        Curve::new(self.degrees[direction], knots, points, weights)
            .expect("a side obeys the rules that the surface obeys")
    }

    /// The pieces between knots repeated as often as the degree.
    pub(super) fn pieces(&self) -> Vec<Self> {
        if self.is_joined {
            return vec![self.clone()];
        }
        let cuts = [0, 1].map(|i| cuts(&self.knots[i], self.degrees[i], self.counts[i]));
        let mut pieces = Vec::new();
        for u in cuts[0].windows(2) {
            for v in cuts[1].windows(2) {
                pieces.push(self.piece([u[0], u[1]], [v[0], v[1]]));
            }
        }
        pieces
    }

    fn piece(&self, rows: [usize; 2], columns: [usize; 2]) -> Self {
        let indices = (rows[0]..=rows[1])
            .flat_map(|i| (columns[0]..=columns[1]).map(move |j| i * self.counts[1] + j));
        let net = indices.clone().map(|k| self.net[k]).collect();
        let weights = indices.filter_map(|k| self.weights.get(k).copied()).collect();
        let knots = [
            piece_knots(&self.knots[0], self.degrees[0], rows[0], rows[1]),
            piece_knots(&self.knots[1], self.degrees[1], columns[0], columns[1]),
        ];
        let counts = [rows[1] - rows[0] + 1, columns[1] - columns[0] + 1];
        let (degrees, tables) = (self.degrees, tables(&knots, self.degrees, counts));
        Self { degrees, knots, tables, counts, net, weights, is_joined: false }
    }
}

fn tables(knots: &[Vec<f64>; 2], degrees: [usize; 2], counts: [usize; 2]) -> [Table; 2] {
    [0, 1].map(|i| Table::new(&knots[i], degrees[i], counts[i]))
}

impl Sum {
    fn point(&self) -> Vector {
        if self.weight == 1.0 { self.point } else { scale(1.0 / self.weight, self.point) }
    }
}

fn tangents<const N: usize>(sums: &[[Sum; N]; N]) -> Tangents {
    let (point, weight) = (sums[0][0].point(), sums[0][0].weight);
    let first = |sum: &Sum| scale(1.0 / weight, sub(sum.point, scale(sum.weight, point)));
    Tangents { point, u: first(&sums[1][0]), v: first(&sums[0][1]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: S1
    #[test]
    fn plain_tangents_are_those_of_the_sums_and_exactly_zero_along_a_pole() {
        let height = |i: usize, j: usize| (i * i + 3 * j) as f64 % 5.0;
        let tip = [0.3, 0.7, 1e3];
        let row = |i: usize| (0..6).map(|j| [i as f64, j as f64, height(i, j)]).collect();
        let rows: Vec<Vec<Vector>> =
            (0..5).map(|i| if i == 0 { vec![tip; 6] } else { row(i) }).collect();
        let patch = Tensor::clamped([2, 3], &rows).expect("a patch");
        let [[u0, u1], [v0, v1]] = patch.domain();
        for k in 0..400 {
            let part = |n: u32| f64::from(n) / 19.0;
            let (u, v) = (u0 + part(k / 20) * (u1 - u0), v0 + part(k % 20) * (v1 - v0));
            let (plain, sums) = (patch.tangents(u, v), tangents(&patch.all_sums::<2>(u, v)));
            for (a, b) in [(plain.point, sums.point), (plain.u, sums.u), (plain.v, sums.v)] {
                assert!(crate::vector::norm(sub(a, b)) <= 1e-12 * 1e3, "{u} {v}");
            }
            if k < 20 {
                assert_eq!((plain.point, plain.v), (tip, [0.0; 3]), "{v}");
            }
        }
    }
}
