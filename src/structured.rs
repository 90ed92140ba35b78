//! Structured grids of four-sided regions: transfinite interpolation, elliptic smoothing, and the
//! exact test for folded cells (SPEC 20).
//!
//! Points are parameters: of the plane itself, or (u, v) of a patch. What a length is the
//! [`Chart`] says.

//!
//! ```
//! use trigrade::point::Point2;
//! use trigrade::structured::{Sides, fractions, transfinite};
//! // The unit square with two edges below and above, one left and right.
//! let around = [(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 1.0), (0.0, 1.0)];
//! let around = around.map(|(x, y)| Point2::new(x, y));
//! let sides = Sides::of_loop(&around, [0, 2, 3, 5]);
//! let along = Sides {
//!     south: fractions(&sides.south, |a, b| b.x - a.x),
//!     east: vec![0.0, 1.0],
//!     north: fractions(&sides.north, |a, b| b.x - a.x),
//!     west: vec![0.0, 1.0],
//! };
//! let grid = transfinite(&sides, &along);
//! assert_eq!((grid.columns, grid.rows), (2, 1));
//! assert_eq!(grid.at(1, 1), Point2::new(0.5, 1.0));
//! ```

mod cells;
mod transfinite;
mod winslow;

pub use cells::{concave_cells, pair_up};
pub use transfinite::{fractions, transfinite};
pub use winslow::{Relaxed, relax};

use crate::metric::FirstForm;
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::skin::shape;
use crate::vector::Vector;

/// The points of a grid of `columns` x `rows` cells, row by row from the south.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Cells in a row.
    pub columns: usize,
    /// Rows of cells.
    pub rows: usize,
    /// `[(columns + 1) (rows + 1)]`
    pub points: Vec<Point2>,
}

/// The four sides of a region: south and north from west to east, west and east from south to
/// north. Sides that meet share their corner to the bit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sides<T> {
    /// First row.
    pub south: Vec<T>,
    /// Last column.
    pub east: Vec<T>,
    /// Last row.
    pub north: Vec<T>,
    /// First column.
    pub west: Vec<T>,
}

/// What grid methods are there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GridMethod {
    /// Transfinite interpolation of the boundary (Gordon and Hall).
    Transfinite,
    /// The same, then smoothed by the inverse Laplace equations (Winslow).
    Elliptic,
}

/// How a grid came out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridStats {
    /// Cells in a row.
    pub columns: usize,
    /// Rows of cells.
    pub rows: usize,
    /// What the smoothing did; `None` for the transfinite method.
    pub relaxed: Option<Relaxed>,
}

/// How parameters measure: the plane itself, or a patch.
pub trait Chart {
    /// The first fundamental form at a point.
    fn form(&self, p: Point2) -> FirstForm;
    /// The Laplace-Beltrami operator of the parameters u and v themselves: zero in the plane.
    fn beltrami(&self, p: Point2) -> [f64; 2];
}

/// The plane.
#[derive(Clone, Copy, Debug, Default)]
pub struct Plane;

impl Chart for Plane {
    fn form(&self, _: Point2) -> FirstForm {
        FirstForm { e: 1.0, f: 0.0, g: 1.0 }
    }

    fn beltrami(&self, _: Point2) -> [f64; 2] {
        [0.0; 2]
    }
}

/// A cell of which neither diagonal gives two counterclockwise triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Folded {
    /// How many such cells there are.
    pub count: usize,
    /// Column of the first, from 0.
    pub column: usize,
    /// Row of the first, from 0.
    pub row: usize,
}

impl<T: Copy> Sides<T> {
    /// The number of edges of south, east, north and west.
    #[must_use]
    pub fn counts(&self) -> [usize; 4] {
        [&self.south, &self.east, &self.north, &self.west].map(|side| side.len().saturating_sub(1))
    }

    /// The sides of a closed loop between four corners, given by rising positions in it; the side
    /// after the first corner is south, the loop runs counterclockwise.
    ///
    /// # Panics
    /// When a position is not below the length of the loop.
    #[must_use]
    pub fn of_loop(around: &[T], corners: [usize; 4]) -> Self {
        let side = |i: usize| -> Vec<T> {
            let (from, to) = (corners[i], corners[(i + 1) % 4]);
            let length = (to + around.len() - from) % around.len();
            (0..=length).map(|k| around[(from + k) % around.len()]).collect()
        };
        let reversed = |i: usize| side(i).into_iter().rev().collect();
        Self { south: side(0), east: side(1), north: reversed(2), west: reversed(3) }
    }

    /// The same with another value for each point.
    #[must_use]
    pub fn map<U>(&self, mut of: impl FnMut(T) -> U) -> Sides<U> {
        let mut all = |side: &[T]| side.iter().map(|&p| of(p)).collect();
        Sides {
            south: all(&self.south),
            east: all(&self.east),
            north: all(&self.north),
            west: all(&self.west),
        }
    }
}

impl Grid {
    /// Index of the point in column `i` and row `j`.
    #[must_use]
    pub fn index(&self, i: usize, j: usize) -> usize {
        j * (self.columns + 1) + i
    }

    /// The point in column `i` and row `j`.
    #[must_use]
    pub fn at(&self, i: usize, j: usize) -> Point2 {
        self.points[self.index(i, j)]
    }

    /// Corners of a cell, counterclockwise from the south-west.
    #[must_use]
    pub fn cell(&self, i: usize, j: usize) -> [usize; 4] {
        let [a, b] = [self.index(i, j), self.index(i, j + 1)];
        [a, a + 1, b + 1, b]
    }

    /// The values of the sides at the places of the boundary, `inner` elsewhere.
    #[must_use]
    pub fn with_sides<T: Copy>(&self, sides: &Sides<T>, inner: &[T]) -> Vec<T> {
        let mut all = inner.to_vec();
        for i in 0..=self.columns {
            all[self.index(i, 0)] = sides.south[i];
            all[self.index(i, self.rows)] = sides.north[i];
        }
        for j in 0..=self.rows {
            all[self.index(0, j)] = sides.west[j];
            all[self.index(self.columns, j)] = sides.east[j];
        }
        all
    }

    /// The cells between two columns and two rows of points.
    #[must_use]
    pub fn part(&self, [west, east]: [usize; 2], [south, north]: [usize; 2]) -> Self {
        let row = |j: usize| self.points[self.index(west, j)..=self.index(east, j)].to_vec();
        Self {
            columns: east - west,
            rows: north - south,
            points: (south..=north).flat_map(row).collect(),
        }
    }

    /// Puts the points of a part back, its south-west corner at a column and row.
    pub fn put(&mut self, [column, row]: [usize; 2], part: &Self) {
        let width = part.columns + 1;
        for (j, points) in part.points.chunks_exact(width).enumerate() {
            let start = self.index(column, row + j);
            self.points[start..start + width].copy_from_slice(points);
        }
    }

    /// Two counterclockwise triangles for each cell, row by row; where both diagonals give such
    /// the one with the better worse triangle in space, the rising one when they are equal.
    ///
    /// # Errors
    /// The cells without a good diagonal, decided exactly.
    pub fn triangles(&self, space: &[Vector]) -> Result<Vec<[u32; 3]>, Folded> {
        let mut triangles = Vec::with_capacity(2 * self.columns * self.rows);
        let mut folded: Option<Folded> = None;
        for row in 0..self.rows {
            for column in 0..self.columns {
                match self.split(self.cell(column, row), space) {
                    Some(pair) => triangles.extend(pair),
                    None => {
                        folded.get_or_insert(Folded { count: 0, column, row }).count += 1;
                    }
                }
            }
        }
        folded.map_or(Ok(triangles), Err)
    }

    /// The two triangles of a cell.
    fn split(&self, [a, b, c, d]: [usize; 4], space: &[Vector]) -> Option<[[u32; 3]; 2]> {
        let rising = [[a, b, c], [a, c, d]];
        let falling = [[a, b, d], [b, c, d]];
        let is_good = |pair: &[[usize; 3]; 2]| {
            pair.iter().all(|t| {
                let [a, b, c] = t.map(|v| self.points[v]);
                orient2d(a, b, c) == Sign::Positive
            })
        };
        let worse = |pair: &[[usize; 3]; 2]| {
            pair.iter().map(|t| shape(t.map(|v| space[v]))).fold(f64::INFINITY, f64::min)
        };
        let chosen = match (is_good(&rising), is_good(&falling)) {
            (true, true) if worse(&falling) > worse(&rising) => falling,
            (true, _) => rising,
            (false, true) => falling,
            (false, false) => return None,
        };
        Some(chosen.map(|t| t.map(|v| v as u32)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(points: [[f64; 2]; 4]) -> Grid {
        let [a, b, c, d] = points.map(Point2::from);
        Grid { columns: 1, rows: 1, points: vec![a, b, d, c] }
    }

    fn split(points: [[f64; 2]; 4]) -> Result<Vec<[u32; 3]>, Folded> {
        let grid = grid(points);
        let space: Vec<Vector> = grid.points.iter().map(|p| [p.x, p.y, 0.0]).collect();
        grid.triangles(&space)
    }

    // spec: W4
    #[test]
    fn the_shorter_diagonal_of_a_rhombus_is_taken() {
        let rising = split([[0.0, 0.0], [1.0, 0.5], [1.2, 1.2], [0.5, 1.0]]).expect("convex");
        assert_eq!(rising, [[0, 1, 2], [1, 3, 2]]);
        let falling = split([[0.0, 0.0], [1.5, -1.0], [1.0, 1.0], [-1.0, 1.5]]).expect("convex");
        assert_eq!(falling, [[0, 1, 3], [0, 3, 2]]);
    }

    // spec: W4
    #[test]
    fn a_cell_with_a_reentrant_corner_has_one_diagonal() {
        let dart = split([[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]]).expect("a dart");
        assert_eq!(dart, [[0, 1, 3], [0, 3, 2]]);
    }

    // spec: W5
    #[test]
    fn a_cell_that_is_turned_over_flat_or_crossed_is_folded() {
        for wrong in [
            [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]],
            [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]],
            [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]],
        ] {
            assert_eq!(split(wrong), Err(Folded { count: 1, column: 0, row: 0 }));
        }
        // One unit in the last place decides.
        let almost = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 5e-324]];
        assert_eq!(split(almost), Ok(vec![[0, 1, 2], [1, 3, 2]]));
    }

    // spec: W2
    #[test]
    fn a_loop_falls_into_sides() {
        let around: Vec<u32> = (0..10).collect();
        let sides = Sides::of_loop(&around, [1, 4, 6, 9]);
        assert_eq!(sides.south, [1, 2, 3, 4]);
        assert_eq!(sides.east, [4, 5, 6]);
        assert_eq!(sides.north, [9, 8, 7, 6]);
        assert_eq!(sides.west, [1, 0, 9]);
        assert_eq!(sides.counts(), [3, 2, 3, 2]);
    }
}
