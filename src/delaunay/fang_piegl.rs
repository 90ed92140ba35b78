//! Triangle by triangle, with a uniform grid to find neighbours.
//!
//! Fang and Piegl, *Delaunay triangulation using a uniform grid*, 1993. Starting from edges whose
//! outer side is done, the third vertex of the triangle on the open side of an edge is looked for
//! in the grid cells around it, ring by ring; once one is found, only the cells that its circle
//! touches can hold a better one. Differs from the paper in starting from the whole convex hull, so
//! that no edge is searched in vain.
//!
//! Rounding decides nothing: the cells a circle touches are bounded from outside, or all of them
//! are taken, and among the points in them exact signs choose.

use super::assemble::{from_triangles, sorted_line};
use super::hull::convex_hull;
use crate::point::Point2;
use crate::predicates::{Sign, incircle_perturbed, orient2d};
use crate::triangulation::Triangulation;
use std::collections::BTreeSet;

/// Delaunay triangulation of distinct finite points in lexicographic order.
pub(crate) fn triangulate(points: &[Point2]) -> Triangulation {
    let hull = convex_hull(points);
    if hull.len() < 3 {
        return sorted_line(points);
    }
    let grid = Grid::new(points);
    let mut triangles = Vec::new();
    // Edges with a triangle still to come on their left. Each triangle closes those of its edges
    // that were open and opens the reverse of the others.
    let mut open: BTreeSet<[u32; 2]> = BTreeSet::new();
    let ends = hull.iter().zip(hull.iter().cycle().skip(1));
    open.extend(ends.map(|(&a, &b)| [a, b]));
    while let Some([a, b]) = open.pop_first() {
        let c = grid.third(a, b).expect("an edge inside the hull has points on both sides");
        triangles.push([a, b, c]);
        for [u, v] in [[b, c], [c, a]] {
            if !open.remove(&[u, v]) {
                open.insert([v, u]);
            }
        }
    }
    from_triangles(points.len(), &triangles).expect("Delaunay triangles fit together")
}

/// The points in the cells of a square grid, about two a cell.
struct Grid<'a> {
    points: &'a [Point2],
    low: Point2,
    /// Cells per unit; 0 where the box has no extent.
    scale: Point2,
    side: usize,
    /// Points of cell `c`: `members[starts[c]..starts[c + 1]]`.
    starts: Vec<u32>,
    members: Vec<u32>,
}

/// A rectangle of cells, bounds included.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Cells {
    x: [usize; 2],
    y: [usize; 2],
}

impl<'a> Grid<'a> {
    fn new(points: &'a [Point2]) -> Self {
        let fold = |f: fn(f64, f64) -> f64| {
            points.iter().copied().reduce(|a, b| Point2::new(f(a.x, b.x), f(a.y, b.y)))
        };
        let low = fold(f64::min).expect("there are points");
        let high = fold(f64::max).expect("there are points");
        let side = ((points.len() as f64 / 2.0).sqrt() as usize).max(1);
        let scale = |low: f64, high: f64| {
            let scale = side as f64 / (high - low);
            if scale.is_finite() { scale } else { 0.0 }
        };
        let scale = Point2::new(scale(low.x, high.x), scale(low.y, high.y));
        let mut grid = Self { points, low, scale, side, starts: Vec::new(), members: Vec::new() };
        grid.sort();
        grid
    }

    fn sort(&mut self) {
        let cells: Vec<usize> = self.points.iter().map(|&p| self.index(p)).collect();
        self.starts = vec![0; self.side * self.side + 1];
        cells.iter().for_each(|&c| self.starts[c + 1] += 1);
        for c in 1..self.starts.len() {
            self.starts[c] += self.starts[c - 1];
        }
        let mut next = self.starts.clone();
        self.members = vec![0; cells.len()];
        for (&c, i) in cells.iter().zip(0..) {
            self.members[next[c] as usize] = i;
            next[c] += 1;
        }
    }

    /// Column of an abscissa or row of an ordinate: monotone, whatever is rounded.
    fn cell(&self, v: f64, low: f64, scale: f64) -> usize {
        (((v - low) * scale) as usize).min(self.side - 1)
    }

    fn column(&self, x: f64) -> usize {
        self.cell(x, self.low.x, self.scale.x)
    }

    fn row(&self, y: f64) -> usize {
        self.cell(y, self.low.y, self.scale.y)
    }

    fn index(&self, p: Point2) -> usize {
        self.row(p.y) * self.side + self.column(p.x)
    }

    /// The vertex that makes the Delaunay triangle on the left of `a -> b`.
    fn third(&self, a: u32, b: u32) -> Option<u32> {
        let mut searched: Option<Cells> = None;
        let mut best = None;
        let mut wanted = self.around(a, b);
        let whole = Cells { x: [0, self.side - 1], y: [0, self.side - 1] };
        while searched != Some(wanted) {
            for c in self.new_cells(wanted, searched) {
                let members = self.starts[c] as usize..self.starts[c + 1] as usize;
                for &v in &self.members[members] {
                    self.consider([a, b], v, &mut best);
                }
            }
            searched = Some(wanted);
            wanted = match best {
                None => grown(wanted, self.side),
                Some(c) => wanted.or(self.circle_cells([a, b, c]).unwrap_or(whole)),
            };
        }
        best
    }

    fn around(&self, a: u32, b: u32) -> Cells {
        let [a, b] = [a, b].map(|v| self.points[v as usize]);
        let (x, y) = ([self.column(a.x), self.column(b.x)], [self.row(a.y), self.row(b.y)]);
        Cells { x: [x[0].min(x[1]), x[0].max(x[1])], y: [y[0].min(y[1]), y[0].max(y[1])] }
    }

    fn new_cells(&self, wanted: Cells, searched: Option<Cells>) -> impl Iterator<Item = usize> {
        let side = self.side;
        let rows = wanted.y[0]..=wanted.y[1];
        let cells = rows.flat_map(move |y| (wanted.x[0]..=wanted.x[1]).map(move |x| (x, y)));
        let done = move |x: usize, y: usize| {
            searched
                .is_some_and(|s| (s.x[0]..=s.x[1]).contains(&x) && (s.y[0]..=s.y[1]).contains(&y))
        };
        cells.filter(move |&(x, y)| !done(x, y)).map(move |(x, y)| y * side + x)
    }

    fn consider(&self, [a, b]: [u32; 2], v: u32, best: &mut Option<u32>) {
        let [pa, pb, pv] = [a, b, v].map(|v| self.points[v as usize]);
        if v == a || v == b || orient2d(pa, pb, pv) != Sign::Positive {
            return;
        }
        let better = best.is_none_or(|c| {
            incircle_perturbed(pa, pb, self.points[c as usize], pv) == Sign::Positive
        });
        if better {
            *best = Some(v);
        }
    }

    /// Cells that cover the circle through three points; `None` if rounding leaves it too vague.
    fn circle_cells(&self, corners: [u32; 3]) -> Option<Cells> {
        let [a, b, c] = corners.map(|v| self.points[v as usize]);
        let (bx, by, cx, cy) = (b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
        let (b2, c2) = (bx * bx + by * by, cx * cx + cy * cy);
        let d = 2.0 * (bx * cy - by * cx);
        // With u = 2^-53, d is off by less than 8 u (|bx cy| + |by cx|), the numerators by less
        // than 8 u times the sum of their terms: far inside these margins while d is not small.
        let product = (bx * cy).abs().max((by * cx).abs());
        if d <= 1e-8 * product || product.min(b2).min(c2) < 1e-250 {
            return None;
        }
        let (x, y) = ((cy * b2 - by * c2) / d, (bx * c2 - cx * b2) / d);
        let terms = ((cy * b2).abs() + (by * c2).abs() + (bx * c2).abs() + (cx * b2).abs()) / d;
        let r = (x * x + y * y).sqrt() * (1.0 + 1e-6) + terms * 1e-14;
        let [x0, x1, y0, y1] = [a.x + x - r, a.x + x + r, a.y + y - r, a.y + y + r];
        let pad = (a.x.abs() + a.y.abs()) * 1e-15;
        [x0, x1, y0, y1].iter().all(|v| v.is_finite()).then(|| Cells {
            x: [self.column(x0 - pad), self.column(x1 + pad)],
            y: [self.row(y0 - pad), self.row(y1 + pad)],
        })
    }
}

impl Cells {
    fn or(self, other: Self) -> Self {
        let join = |a: [usize; 2], b: [usize; 2]| [a[0].min(b[0]), a[1].max(b[1])];
        Self { x: join(self.x, other.x), y: join(self.y, other.y) }
    }
}

/// One more ring of cells.
fn grown(cells: Cells, side: usize) -> Cells {
    let grow = |r: [usize; 2]| [r[0].saturating_sub(1), (r[1] + 1).min(side - 1)];
    Cells { x: grow(cells.x), y: grow(cells.y) }
}
