//! The fast engine: divide and conquer over the cells of a Morton curve.
//!
//! The points are sorted along the curve, so every node of its quadtree, cut into halves by
//! alternating directions, is a range of them. The halves of a node are triangulated and merged
//! across the cut (Guibas and Stolfi 1985; with cells in place of strips, Dwyer, *A faster
//! divide-and-conquer algorithm for constructing Delaunay triangulations*, 1987). The
//! structure is the triangle with ghosts of Shewchuk's Triangle (1996, section 3) and not the quad
//! edge: where a hull edge's ghost is glued to the other half's vertex it becomes the triangle, so
//! a merge writes little. A range of n points owns 2n slots and no others, so neighbouring points
//! have neighbouring triangles and halves can run on two threads.
//!
//! Points of one cell at the curve's finest level are cut at their lexicographic median.

mod merge;

use super::order::{Lattice, Sorted, morton_sort};
use crate::point::Point2;
use crate::triangulation::Triangulation;
use crate::triangulation::arena::Arena;
use merge::{Cut, Part};

/// Below this many points a range is not worth a second thread.
const PARALLEL_MIN: usize = 1 << 14;

/// A Delaunay triangulation and the points that were merged into others.
pub(crate) struct Fast {
    pub(crate) triangulation: Triangulation,
    pub(crate) repeated: Vec<[u32; 2]>,
}

/// Triangulates finite points; equal ones are merged.
pub(crate) fn triangulate(points: &[Point2], parallel: bool) -> Fast {
    let Sorted { points, index, repeated, lattice } = morton_sort(points);
    let mut triangulation = Triangulation::unfinished(2 * points.len());
    if points.len() > 1 {
        let job = Job { points: &points, lattice, parallel };
        job.build(&mut triangulation.arena(), 0, points.len());
    }
    drop(points);
    triangulation.finish(&index);
    Fast { triangulation, repeated }
}

struct Job<'a> {
    points: &'a [Point2],
    lattice: Lattice,
    parallel: bool,
}

impl Job<'_> {
    fn build(&self, arena: &mut Arena<'_>, low: usize, high: usize) -> Part {
        if high - low <= 3 {
            return merge::leaf(arena, self.points, low, high);
        }
        let (middle, cut) = self.cut(low, high);
        let (left, right) = if self.parallel && high - low > PARALLEL_MIN {
            let (mut first, mut second) = arena.split_at(2 * middle as u32);
            rayon::join(
                || self.build(&mut first, low, middle),
                || self.build(&mut second, middle, high),
            )
        } else {
            (self.build(arena, low, middle), self.build(arena, middle, high))
        };
        merge::merge(arena, self.points, (left, right), cut)
    }

    /// Where to cut a range: at the highest bit in which its cells differ.
    fn cut(&self, low: usize, high: usize) -> (usize, Cut) {
        let [first, last] = [low, high - 1].map(|i| self.lattice.cell(self.points[i]));
        let (x, y) = (first[0] ^ last[0], first[1] ^ last[1]);
        if (x | y) == 0 {
            return (low.midpoint(high), Cut::Vertical);
        }
        // x is the upper bit of each pair, so it wins where both have the same highest bit.
        let axis = usize::from(x < y && x < (x ^ y));
        let bit = 31 - [x, y][axis].leading_zeros();
        let range = &self.points[low..high];
        let below = |p: &Point2| self.lattice.cell(*p)[axis] >> bit & 1 == 0;
        let middle = low + range.partition_point(below);
        (middle, if axis == 0 { Cut::Vertical } else { Cut::Horizontal })
    }
}
