//! All pairs of edges that cross or overlap, once the sweep has shown that there are some.
//!
//! Every such pair contains an edge that the sweep took out, so only those are tested, each against
//! the edges whose bounding boxes meet its own: a binary tree of boxes over the edges along a Morton
//! curve finds them. Work and list are bounded by a multiple of the input, since n edges can cross
//! in n (n - 1) / 2 points.

use super::sweep::Sweep;
use crate::domain::BoundingBox;
use crate::point::Point2;
use crate::predicates::{SegmentIntersection, classify};

/// Boxes visited for each edge of the input, on average, before the search stops. On real outlines
/// an edge meets tens of boxes.
const VISITS_PER_EDGE: usize = 400;

/// Boxes visited at least, so that small domains are searched to the end.
const VISITS_MIN: usize = 1_000_000;

/// Edges in a leaf of the tree.
const LEAF: usize = 8;

/// How two edges meet that may not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Meeting {
    /// Their interiors cross in one point.
    Crossing,
    /// They share a stretch between two vertices (ranks).
    Overlap([u32; 2]),
}

/// Pairs of edges that cross or overlap.
#[derive(Debug, Default)]
pub(super) struct Conflicts {
    /// Pairs with the lower edge first, sorted.
    pub pairs: Vec<([u32; 2], Meeting)>,
    /// Whether these are all.
    pub complete: bool,
}

/// How the edges `e` and `f` (ranks, left end first) meet, if they cross or overlap.
pub(super) fn meeting(points: &[Point2], e: [u32; 2], f: [u32; 2]) -> Option<Meeting> {
    let [a, b, c, d] = [e[0], e[1], f[0], f[1]].map(|v| points[v as usize]);
    match classify(a, b, c, d) {
        SegmentIntersection::ProperCrossing => Some(Meeting::Crossing),
        SegmentIntersection::CollinearOverlap { .. } | SegmentIntersection::Identical => {
            Some(Meeting::Overlap([e[0].max(f[0]), e[1].min(f[1])]))
        }
        _ => None,
    }
}

/// Lists the pairs; at least those the sweep met, at most `limit` or little more.
pub(super) fn conflicts(
    points: &[Point2],
    edges: &[[u32; 2]],
    sweep: &Sweep,
    limit: usize,
) -> Conflicts {
    let mut pairs = sweep.conflicts.clone();
    let tree = Tree::new(points, edges);
    let mut visits = VISITS_MIN.max(VISITS_PER_EDGE * edges.len());
    let mut complete = true;
    for &removed in &sweep.removed {
        complete = tree.query(removed, &mut visits, |other| {
            if meeting(points, edges[removed as usize], edges[other as usize]).is_some() {
                pairs.push([removed.min(other), removed.max(other)]);
            }
            pairs.len() < limit
        });
        if !complete {
            break;
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    let meet = |pair: [u32; 2]| {
        let [e, f] = pair.map(|edge| edges[edge as usize]);
        meeting(points, e, f).map(|meeting| (pair, meeting))
    };
    Conflicts { pairs: pairs.into_iter().filter_map(meet).collect(), complete }
}

/// A complete binary tree of bounding boxes; node i has the children 2 i + 1 and 2 i + 2.
struct Tree {
    /// Boxes of the edges, by edge.
    edges: Vec<BoundingBox>,
    /// Edges along the Morton curve, cut evenly among the leaves.
    order: Vec<u32>,
    nodes: Vec<BoundingBox>,
    leaves: usize,
}

const EVERYWHERE: BoundingBox = BoundingBox {
    min: Point2::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
    max: Point2::new(f64::INFINITY, f64::INFINITY),
};

impl Tree {
    fn new(points: &[Point2], edges: &[[u32; 2]]) -> Self {
        let bounds = |ends: &[u32; 2]| BoundingBox::of(ends.map(|v| points[v as usize]));
        let boxes: Vec<_> = edges.iter().map(|e| bounds(e).unwrap_or(EVERYWHERE)).collect();
        let around = BoundingBox::of(points.iter().copied()).unwrap_or(EVERYWHERE);
        let codes: Vec<u64> = boxes.iter().map(|b| morton(around, *b)).collect();
        let mut order: Vec<u32> = (0..edges.len() as u32).collect();
        order.sort_unstable_by_key(|&edge| (codes[edge as usize], edge));
        let leaves = edges.len().div_ceil(LEAF).next_power_of_two();
        let mut tree =
            Self { edges: boxes, order, nodes: vec![EVERYWHERE; 2 * leaves - 1], leaves };
        for node in (0..tree.nodes.len()).rev() {
            tree.nodes[node] = tree.bounds(node);
        }
        tree
    }

    fn leaf(&self, node: usize) -> Option<&[u32]> {
        let leaf = (node + 1).checked_sub(self.leaves)?;
        let cut = |leaf: usize| leaf * self.order.len() / self.leaves;
        Some(&self.order[cut(leaf)..cut(leaf + 1)])
    }

    fn bounds(&self, node: usize) -> BoundingBox {
        let corners = |b: BoundingBox| [b.min, b.max];
        let below: Vec<BoundingBox> = match self.leaf(node) {
            Some(edges) => edges.iter().map(|&e| self.edges[e as usize]).collect(),
            None => vec![self.nodes[2 * node + 1], self.nodes[2 * node + 2]],
        };
        let nothing = BoundingBox { min: EVERYWHERE.max, max: EVERYWHERE.min };
        BoundingBox::of(below.into_iter().flat_map(corners)).unwrap_or(nothing)
    }

    /// Calls `found` for the edges whose boxes meet that of `edge`, until it says false or `visits`
    /// are used up; returns whether neither happened.
    fn query(&self, edge: u32, visits: &mut usize, mut found: impl FnMut(u32) -> bool) -> bool {
        let bounds = self.edges[edge as usize];
        let mut stack = vec![0];
        while let Some(node) = stack.pop() {
            if *visits == 0 {
                return false;
            }
            *visits -= 1;
            if !meet(self.nodes[node], bounds) {
                continue;
            }
            match self.leaf(node) {
                None => stack.extend([2 * node + 2, 2 * node + 1]),
                Some(edges) => {
                    let near = |&e: &u32| e != edge && meet(self.edges[e as usize], bounds);
                    if !edges.iter().copied().filter(near).all(&mut found) {
                        return false;
                    }
                }
            }
        }
        true
    }
}

fn meet(a: BoundingBox, b: BoundingBox) -> bool {
    a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y
}

/// Position of a box's middle along the Morton curve of `around`: it ranks, never decides.
fn morton(around: BoundingBox, bounds: BoundingBox) -> u64 {
    let cell = |min: f64, max: f64, low: f64, high: f64| {
        // Halved first, so that no difference overflows.
        let share = (low / 4.0 + high / 4.0 - min / 2.0) / (max / 2.0 - min / 2.0);
        spread((share * f64::from(u32::MAX)) as u32)
    };
    let x = cell(around.min.x, around.max.x, bounds.min.x, bounds.max.x);
    x | cell(around.min.y, around.max.y, bounds.min.y, bounds.max.y) << 1
}

/// Puts a zero between any two bits.
fn spread(bits: u32) -> u64 {
    let mut x = u64::from(bits);
    for (shift, mask) in [
        (16, 0x0000_ffff_0000_ffff_u64),
        (8, 0x00ff_00ff_00ff_00ff),
        (4, 0x0f0f_0f0f_0f0f_0f0f),
        (2, 0x3333_3333_3333_3333),
        (1, 0x5555_5555_5555_5555),
    ] {
        x = (x | x << shift) & mask;
    }
    x
}
