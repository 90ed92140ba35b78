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

use super::Delaunay;
use super::order::{Lattice, Sorted, morton_sort};
use crate::point::Point2;
use crate::triangulation::Triangulation;
use crate::triangulation::arena::Arena;
use merge::{Cut, Part};

/// Below this many points a range is not worth a second thread.
const PARALLEL_MIN: usize = 1 << 14;

/// Triangulates finite points; equal ones are merged.
pub(crate) fn triangulate(points: &[Point2], parallel: bool) -> Delaunay {
    let Sorted { index, repeated, lattice } = morton_sort(points);
    let mut triangulation = Triangulation::unfinished(index);
    // Only now, when the indices have gone into the slots: at no time are both lists there.
    let points: Vec<Point2> = triangulation.names().map(|name| points[name as usize]).collect();
    if points.len() > 1 {
        let job = Job { points: &points, lattice, parallel };
        job.build(&mut triangulation.arena(), 0, points.len());
    }
    drop(points);
    triangulation.finish();
    Delaunay { triangulation, repeated }
}

struct Job<'a> {
    points: &'a [Point2],
    lattice: Lattice,
    parallel: bool,
}

/// A range of points that is a node of the curve's tree, triangulated only when it has to be.
struct Node {
    low: usize,
    high: usize,
    /// The level at which the node was cut off from what comes before it.
    level: u32,
    part: Option<Part>,
}

impl Job<'_> {
    /// Triangulates a range, in halves on two threads while that pays.
    fn build(&self, arena: &mut Arena<'_>, low: usize, high: usize) -> Part {
        if !self.parallel || high - low <= PARALLEL_MIN {
            return self.scan(arena, low, high);
        }
        let level = self.level(low, high - 1);
        if level == 0 {
            return self.bisect(arena, low, high);
        }
        let below = |p: &Point2| self.lattice.level(self.points[low], *p) < level;
        let middle = low + self.points[low..high].partition_point(below);
        let (mut first, mut second) = arena.split_at(2 * middle as u32);
        let parts = rayon::join(
            || self.build(&mut first, low, middle),
            || self.build(&mut second, middle, high),
        );
        merge::merge(arena, self.points, parts, cut_of(level))
    }

    /// Triangulates a range in one pass: a node is merged into the one before it as soon as a point
    /// beyond their common parent comes, which the level between neighbours tells.
    fn scan(&self, arena: &mut Arena<'_>, low: usize, high: usize) -> Part {
        let mut stack = vec![self.cell_node(arena, low, high, u32::MAX)];
        while let Some(next) = stack.last().map(|node| node.high).filter(|&next| next < high) {
            let level = self.level(next - 1, next);
            self.merge_below(arena, &mut stack, level);
            stack.push(self.cell_node(arena, next, high, level));
        }
        self.merge_below(arena, &mut stack, u32::MAX);
        let whole = stack.pop().expect("the first node stays");
        self.part(arena, &whole)
    }

    /// Merges the nodes on top of the stack that were cut apart below `level`.
    fn merge_below(&self, arena: &mut Arena<'_>, stack: &mut Vec<Node>, level: u32) {
        while let Some(second) = stack.pop_if(|node| node.level < level) {
            let first = stack.last_mut().expect("the first node's level is the highest");
            if second.high - first.low > 3 {
                let parts = (self.part(arena, first), self.part(arena, &second));
                first.part = Some(merge::merge(arena, self.points, parts, cut_of(second.level)));
            }
            first.high = second.high;
        }
    }

    /// The node of the points that share the cell of point `low`: nearly always that point alone.
    fn cell_node(&self, arena: &mut Arena<'_>, low: usize, limit: usize, level: u32) -> Node {
        let mut high = low + 1;
        while high < limit && self.level(low, high) == 0 {
            high += 1;
        }
        let part = (high - low > 3).then(|| self.bisect(arena, low, high));
        Node { low, high, level, part }
    }

    fn part(&self, arena: &mut Arena<'_>, node: &Node) -> Part {
        node.part.unwrap_or_else(|| merge::leaf(arena, self.points, node.low, node.high))
    }

    /// Triangulates points in lexicographic order by halves.
    fn bisect(&self, arena: &mut Arena<'_>, low: usize, high: usize) -> Part {
        if high - low <= 3 {
            return merge::leaf(arena, self.points, low, high);
        }
        let middle = low.midpoint(high);
        let parts = (self.bisect(arena, low, middle), self.bisect(arena, middle, high));
        merge::merge(arena, self.points, parts, Cut::Vertical)
    }

    fn level(&self, i: usize, j: usize) -> u32 {
        self.lattice.level(self.points[i], self.points[j])
    }
}

/// Odd levels are cut apart by x, even ones by y.
fn cut_of(level: u32) -> Cut {
    if level % 2 == 1 { Cut::Vertical } else { Cut::Horizontal }
}
