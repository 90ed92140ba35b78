//! Elliptic smoothing: the inverse Laplace equations (A. M. Winslow, J. Comput. Phys. 1, 1966), on a
//! patch the inverse Laplace-Beltrami equations (J. F. Thompson, Z. U. A. Warsi, C. W. Mastin,
//! Numerical Grid Generation, 1985), solved by over-relaxed line sweeps in a fixed order.
//!
//! The grid parameters are harmonic on the region, so a continuous solution has no fold whatever
//! the sides (on a convex image the theorem of Rado); the discrete one is tested like any other.

use super::{Chart, Grid};
use crate::metric::FirstForm;
use crate::point::Point2;

/// What the smoothing did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Relaxed {
    /// Sweeps over all rows and columns.
    pub sweeps: u32,
    /// Largest distance, over the size of the region, that one equation would still move its point.
    pub residual: f64,
}

/// Most sweeps.
const SWEEPS_MAX: u32 = 2000;
/// Where the smoothing stops, over the size of the region.
const TOLERANCE: f64 = 1e-10;
/// The first sweeps are not over-relaxed: they undo the folds.
const CAREFUL_SWEEPS: u32 = 10;
/// More over-relaxation than this is never worth its risk.
const FACTOR_MAX: f64 = 1.9;
/// A residual that has grown so much tells of too much over-relaxation.
const GROWN: f64 = 10.0;

/// Smooths the inner points of a grid; at most 2000 sweeps, until the residual is 1e-10.
///
/// # Complexity
/// A sweep is linear in the points; their number grows with the longer side of the grid.
pub fn relax(grid: &mut Grid, chart: &impl Chart) -> Relaxed {
    let size = extent(&grid.points);
    let mut factor = over_relaxation(grid);
    let mut best = f64::INFINITY;
    let mut done = Relaxed { sweeps: 0, residual: residual(grid, chart) / size };
    while done.residual > TOLERANCE && done.sweeps < SWEEPS_MAX {
        let by = if done.sweeps < CAREFUL_SWEEPS { 1.0 } else { factor };
        for j in 1..grid.rows {
            let line: Vec<[usize; 2]> = (0..=grid.columns).map(|i| [i, j]).collect();
            sweep(grid, chart, &line, by);
        }
        for i in 1..grid.columns {
            let line: Vec<[usize; 2]> = (0..=grid.rows).map(|j| [i, j]).collect();
            sweep(grid, chart, &line, by);
        }
        done.sweeps += 1;
        done.residual = residual(grid, chart) / size;
        if done.residual > GROWN * best {
            factor = 1.0 + 0.5 * (factor - 1.0);
            best = done.residual;
        }
        best = best.min(done.residual);
    }
    done
}

/// The best factor for Laplace's equation on a square as wide as the longer side.
fn over_relaxation(grid: &Grid) -> f64 {
    let longer = grid.columns.max(grid.rows) as f64;
    let angle = std::f64::consts::SQRT_2 * std::f64::consts::PI / longer;
    (2.0 / (1.0 + angle)).clamp(1.0, FACTOR_MAX)
}

fn extent(points: &[Point2]) -> f64 {
    let (mut low, mut high) = (points[0], points[0]);
    for p in points {
        low = Point2::new(low.x.min(p.x), low.y.min(p.y));
        high = Point2::new(high.x.max(p.x), high.y.max(p.y));
    }
    let size = low.distance(high);
    if size > 0.0 { size } else { 1.0 }
}

/// The equation at a point: weights of its neighbours along xi and eta, and the rest.
struct Stencil {
    /// g22: weight of each neighbour in the row.
    row: f64,
    /// g11: weight of each neighbour in the column.
    column: f64,
    /// What is left of the equation, by coordinate: mixed derivative and source.
    rest: [f64; 2],
}

impl Stencil {
    fn at(grid: &Grid, chart: &impl Chart, [i, j]: [usize; 2]) -> Self {
        let half = |a: Point2, b: Point2| [0.5 * (a.x - b.x), 0.5 * (a.y - b.y)];
        let [ux, vx] = half(grid.at(i + 1, j), grid.at(i - 1, j));
        let [uy, vy] = half(grid.at(i, j + 1), grid.at(i, j - 1));
        let p = grid.at(i, j);
        let FirstForm { e, f, g } = chart.form(p);
        let product =
            |[a, b]: [f64; 2], [c, d]: [f64; 2]| e * a * c + f * (a * d + b * c) + g * b * d;
        let (g11, g12, g22) =
            (product([ux, vx], [ux, vx]), product([ux, vx], [uy, vy]), product([uy, vy], [uy, vy]));
        let rising = half(grid.at(i + 1, j + 1), grid.at(i + 1, j - 1));
        let falling = half(grid.at(i - 1, j + 1), grid.at(i - 1, j - 1));
        let area_sq = (e * g - f * f) * (ux * vy - uy * vx).powi(2);
        let source = chart.beltrami(p);
        // The mixed derivative is half of (rising - falling).
        let rest = std::array::from_fn(|k| -g12 * (rising[k] - falling[k]) - area_sq * source[k]);
        Self { row: g22, column: g11, rest }
    }
}

/// Solves the equations of the inner points of a row or column together, the others held.
fn sweep(grid: &mut Grid, chart: &impl Chart, line: &[[usize; 2]], factor: f64) {
    let inner = &line[1..line.len() - 1];
    if inner.is_empty() {
        return;
    }
    let is_row = line[0][1] == line[1][1];
    let mut system = Tridiagonal::default();
    for &[i, j] in inner {
        let Stencil { row, column, rest } = Stencil::at(grid, chart, [i, j]);
        let (along, across, beside) = match is_row {
            true => (row, column, [grid.at(i, j - 1), grid.at(i, j + 1)]),
            false => (column, row, [grid.at(i - 1, j), grid.at(i + 1, j)]),
        };
        let [a, b] = beside;
        system.push(
            along,
            across,
            [across * (a.x + b.x) + rest[0], across * (a.y + b.y) + rest[1]],
        );
    }
    let [first, last] = [line[0], line[line.len() - 1]].map(|[i, j]| grid.at(i, j));
    for (&[i, j], wanted) in inner.iter().zip(system.solve(first, last)) {
        let (index, old) = (grid.index(i, j), grid.at(i, j));
        let mix = |old: f64, new: f64| old + factor * (new - old);
        let new = Point2::new(mix(old.x, wanted[0]), mix(old.y, wanted[1]));
        if new.is_finite() {
            grid.points[index] = new;
        }
    }
}

/// Equations `along (p[k-1] + p[k+1]) - 2 (along + across) p[k] + right[k] = 0`.
#[derive(Default)]
struct Tridiagonal {
    along: Vec<f64>,
    diagonal: Vec<f64>,
    right: Vec<[f64; 2]>,
}

impl Tridiagonal {
    fn push(&mut self, along: f64, across: f64, right: [f64; 2]) {
        self.along.push(along);
        self.diagonal.push(2.0 * (along + across));
        self.right.push(right);
    }

    /// Thomas's algorithm; the values before the first and after the last are given.
    fn solve(mut self, first: Point2, last: Point2) -> Vec<[f64; 2]> {
        let count = self.along.len();
        let add = |right: &mut [f64; 2], by: f64, p: Point2| {
            right[0] += by * p.x;
            right[1] += by * p.y;
        };
        add(&mut self.right[0], self.along[0], first);
        add(&mut self.right[count - 1], self.along[count - 1], last);
        for k in 1..count {
            // Row k: -along p[k-1] + diagonal p[k] - along p[k+1] = right.
            let by = self.along[k] / self.diagonal[k - 1];
            self.diagonal[k] -= by * self.along[k - 1];
            let [x, y] = self.right[k - 1];
            add(&mut self.right[k], by, Point2::new(x, y));
        }
        let mut next = [0.0; 2];
        for k in (0..count).rev() {
            let by = if k + 1 < count { self.along[k] } else { 0.0 };
            let value = |c: usize| (self.right[k][c] + by * next[c]) / self.diagonal[k];
            next = [value(0), value(1)];
            self.right[k] = next;
        }
        self.right
    }
}

/// Largest distance that one equation would move its own point.
fn residual(grid: &Grid, chart: &impl Chart) -> f64 {
    let mut largest: f64 = 0.0;
    for j in 1..grid.rows {
        for i in 1..grid.columns {
            let Stencil { row, column, rest } = Stencil::at(grid, chart, [i, j]);
            let [w, e, s, n] =
                [grid.at(i - 1, j), grid.at(i + 1, j), grid.at(i, j - 1), grid.at(i, j + 1)];
            let weight = 2.0 * (row + column);
            if weight > 0.0 {
                let x = (row * (w.x + e.x) + column * (s.x + n.x) + rest[0]) / weight;
                let y = (row * (w.y + e.y) + column * (s.y + n.y) + rest[1]) / weight;
                largest = largest.max(grid.at(i, j).distance(Point2::new(x, y)));
            }
        }
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::super::Plane;
    use super::*;

    fn lattice(columns: usize, rows: usize, of: impl Fn(f64, f64) -> [f64; 2]) -> Grid {
        let at = |k: usize| {
            let (i, j) = (k % (columns + 1), k / (columns + 1));
            of(i as f64 / columns as f64, j as f64 / rows as f64).into()
        };
        Grid { columns, rows, points: (0..(columns + 1) * (rows + 1)).map(at).collect() }
    }

    // spec: W3
    #[test]
    fn an_affine_lattice_is_a_solution() {
        let mut grid = lattice(6, 4, |s, t| [2.0 * s + t, s - 3.0 * t]);
        let before = grid.clone();
        let done = relax(&mut grid, &Plane);
        assert!(done.residual < 1e-14 && done.sweeps <= 1, "{done:?}");
        for (p, q) in grid.points.iter().zip(&before.points) {
            assert!(p.distance(*q) < 1e-13);
        }
    }

    // spec: W3
    #[test]
    fn inner_points_in_a_heap_find_the_lattice() {
        let heap = |s: f64, t: f64| {
            let inner = s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0;
            if inner { [0.1, 0.8] } else { [s, t] }
        };
        let mut grid = lattice(12, 9, heap);
        let done = relax(&mut grid, &Plane);
        assert!(done.residual <= TOLERANCE, "{done:?}");
        let truth = lattice(12, 9, |s, t| [s, t]);
        for (p, q) in grid.points.iter().zip(&truth.points) {
            assert!(p.distance(*q) < 1e-7, "{p} for {q}");
        }
    }

    // spec: W3
    #[test]
    fn the_quarter_ring_is_the_conformal_one() {
        // Its parameters are harmonic: the angle, and the logarithm of the radius.
        let ring = |s: f64, t: f64| {
            let (radius, angle) = (libm::exp2(s), 0.5 * std::f64::consts::PI * t);
            [radius * libm::cos(angle), radius * libm::sin(angle)]
        };
        let bulge = |s: f64, t: f64| {
            let by = s * (1.0 - s) * t * (1.0 - t);
            ring(s + 2.0 * by, t - 1.5 * by)
        };
        let (mut grid, truth) = (lattice(40, 40, bulge), lattice(40, 40, ring));
        let done = relax(&mut grid, &Plane);
        assert!(done.residual <= TOLERANCE && done.sweeps < 400, "{done:?}");
        for (p, q) in grid.points.iter().zip(&truth.points) {
            assert!(p.distance(*q) < 1e-3, "{p} for {q}");
        }
    }

    // spec: W6
    #[test]
    fn the_same_grid_gives_the_same_bits() {
        let bent = |s: f64, t: f64| [s + 0.2 * t * t, t + 0.3 * libm::sin(3.0 * s)];
        let run = || {
            let mut grid = lattice(20, 15, bent);
            (relax(&mut grid, &Plane), grid)
        };
        assert_eq!(run(), run());
    }

    // spec: W3
    #[test]
    fn a_grid_without_inner_points_is_left_alone() {
        let mut grid = lattice(5, 1, |s, t| [s, t + s * s]);
        let before = grid.clone();
        assert_eq!(relax(&mut grid, &Plane), Relaxed { sweeps: 0, residual: 0.0 });
        assert_eq!(grid, before);
    }
}
