//! Constrained Delaunay triangulation by divide and conquer.
//!
//! The points are halved along their lexicographic order, and with them the segments that have both
//! ends in one half; the constrained triangulations of the halves are merged as Guibas and Stolfi
//! merge (1985), except that no edge is removed that is a segment; then the segments with an end in
//! each half are laid in. So a segment is touched at one node of the recursion only, the lowest that
//! has both its ends. SPEC 5.2 shows that the merge is right with segments.
//!
//! Chew, *Constrained Delaunay triangulations*, 1989, also merges, but strips in place of halves: he
//! cuts the segments at the strips' borders, which keeps the worst case at n log n and needs
//! points at infinity. Here a long segment costs what it crosses when it is laid in, as in any
//! incremental method, and in return no artificial point exists.

use super::assemble::{from_triangles, sorted_line};
use super::divide_conquer::{Edge, FREE, Subdivision, sym};
use super::{Cdt, CdtError, found, merge_equal};
use crate::point::Point2;
use crate::predicates::{Sign, incircle_perturbed, orient2d};
use crate::triangulation::Triangulation;
use crate::triangulation::locate::same_direction;

/// Constrained Delaunay triangulation of distinct finite points.
pub(super) fn triangulate(points: &[Point2], segments: &[[u32; 2]]) -> Result<Cdt, CdtError> {
    let (sorted, index, _) = merge_equal(points);
    let mut rank = vec![0; points.len()];
    for (&i, r) in index.iter().zip(0..) {
        rank[i as usize] = r;
    }
    let ends = segments.iter().map(|s| s.map(|v| rank[v as usize])).collect();
    let mut job = Job { subdivision: Subdivision::new(&sorted), ends };
    let mut triangulation = job.run().map_err(|error| error.told(points, &index))?;
    triangulation.rename(&index);
    let outgoing = triangulation.outgoing(points.len());
    let mut cdt = found(triangulation, outgoing, segments);
    for &e in &cdt.segments {
        cdt.triangulation.set_constrained(e, true);
    }
    Ok(cdt)
}

/// What is in the way of a segment, points by rank.
enum InTheWay {
    Segment { first: u32, second: u32 },
    Point { segment: u32, at: u32 },
}

impl InTheWay {
    fn told(self, points: &[Point2], index: &[u32]) -> CdtError {
        match self {
            Self::Segment { first, second } => {
                CdtError::Crossing { first: first.min(second), second: first.max(second) }
            }
            Self::Point { segment, at } => {
                let vertex = index[at as usize];
                CdtError::Through { segment, vertex, point: points[vertex as usize] }
            }
        }
    }
}

struct Job<'a> {
    subdivision: Subdivision<'a>,
    /// Ends of the segments, by rank.
    ends: Vec<[u32; 2]>,
}

impl Job<'_> {
    fn run(&mut self) -> Result<Triangulation, InTheWay> {
        let points = self.subdivision.points;
        if points.len() < 2 {
            return Ok(Triangulation::default());
        }
        let all = (0..self.ends.len() as u32).collect();
        self.solve([0, points.len()], all)?;
        let triangles = self.subdivision.triangles();
        if triangles.is_empty() {
            return Ok(sorted_line(points));
        }
        Ok(from_triangles(points.len(), &triangles).expect("the subdivision is planar"))
    }

    /// Triangulates points `low..high` with the segments between them; returns the hull edges that
    /// a merge starts from.
    fn solve(
        &mut self,
        [low, high]: [usize; 2],
        segments: Vec<u32>,
    ) -> Result<(Edge, Edge), InTheWay> {
        let (hull, segments) = match high - low {
            2 => (self.subdivision.two(low as u32), segments),
            3 => (self.subdivision.three(low as u32), segments),
            _ => {
                let middle = low.midpoint(high);
                let [left, right, across] = self.divided(segments, middle as u32);
                let left = self.solve([low, middle], left)?;
                let right = self.solve([middle, high], right)?;
                (self.subdivision.merge(left, right), across)
            }
        };
        segments.into_iter().try_for_each(|segment| self.lay(segment))?;
        Ok(hull)
    }

    /// Segments with both ends below `middle`, with none, and with one.
    fn divided(&self, segments: Vec<u32>, middle: u32) -> [Vec<u32>; 3] {
        let mut parts: [Vec<u32>; 3] = Default::default();
        for segment in segments {
            let [a, b] = self.ends[segment as usize].map(|end| end >= middle);
            let part = if a != b { 2 } else { usize::from(a) };
            parts[part].push(segment);
        }
        parts
    }

    /// Makes a segment an edge: what it crosses is removed, and the polygon on either side of it is
    /// triangulated.
    fn lay(&mut self, segment: u32) -> Result<(), InTheWay> {
        let [a, b] = self.ends[segment as usize];
        let (first, last, crossed) = match self.way(segment, [a, b])? {
            Way::Edge(e) => {
                if self.subdivision.segment(e) == FREE {
                    self.subdivision.set_segment(e, segment);
                }
                return Ok(());
            }
            Way::Crosses { first, last, crossed } => (first, last, crossed),
        };
        crossed.into_iter().for_each(|e| self.subdivision.delete(e));
        // Both lie on the rim of the one face that is left: `first` ends in a, `last` starts in b.
        let e = self.subdivision.connect(first, last);
        self.subdivision.set_segment(e, segment);
        self.fill(e);
        self.fill(sym(e));
        Ok(())
    }

    /// What lies between the ends of a segment.
    fn way(&self, segment: u32, [a, b]: [u32; 2]) -> Result<Way, InTheWay> {
        let s = &self.subdivision;
        let [pa, pb] = [a, b].map(|v| s.at(v));
        let side = |v: u32| orient2d(pa, pb, s.at(v));
        let mut e = s.out_of(a);
        // Turn about a until the segment lies between e and the edge after it.
        loop {
            let v = s.dest(e);
            if v == b {
                return Ok(Way::Edge(e));
            }
            match side(v) {
                Sign::Zero if same_direction(pa, pb, s.at(v)) => {
                    return Err(InTheWay::Point { segment, at: v });
                }
                Sign::Negative if side(s.dest(s.onext(e))) == Sign::Positive => break,
                _ => e = s.onext(e),
            }
        }
        let first = sym(s.onext(e));
        let mut crossed = Vec::new();
        // The edge ahead runs from the right of the segment to its left.
        let mut ahead = s.lnext(e);
        loop {
            if s.segment(ahead) != FREE {
                return Err(InTheWay::Segment { first: s.segment(ahead), second: segment });
            }
            crossed.push(ahead);
            let beyond = sym(ahead);
            let (near, far) = (s.lnext(beyond), s.lnext(s.lnext(beyond)));
            let apex = s.dest(near);
            if apex == b {
                return Ok(Way::Crosses { first, last: far, crossed });
            }
            ahead = match side(apex) {
                Sign::Zero => return Err(InTheWay::Point { segment, at: apex }),
                Sign::Positive => near,
                Sign::Negative => far,
            };
        }
    }

    /// Triangulates the polygon on the left of an edge, every vertex of which was seen across the
    /// edge: the apex has the circle through the edge's ends that holds no other vertex, and
    /// leaves two such polygons (SPEC 4.3).
    fn fill(&mut self, base: Edge) {
        let mut todo = vec![base];
        while let Some(base) = todo.pop() {
            let s = &mut self.subdivision;
            let (after, third) = (s.lnext(base), s.lnext(s.lnext(base)));
            if s.lnext(third) == base {
                continue;
            }
            let before = sym(s.onext(base));
            let from = apex(s, base);
            let mut second = after;
            if from != third {
                second = s.connect(base, from);
                todo.push(sym(second));
            }
            if from != before {
                let closing = s.connect(second, base);
                todo.push(sym(closing));
            }
        }
    }
}

/// How a segment can come to be an edge.
enum Way {
    /// It is one.
    Edge(Edge),
    /// By removal of the edges it crosses; `first` then ends in its start, `last` starts in its end.
    Crosses { first: Edge, last: Edge, crossed: Vec<Edge> },
}

/// The edge of the polygon left of `base` that starts in the apex of the base's triangle.
fn apex(s: &Subdivision<'_>, base: Edge) -> Edge {
    let [p, q] = [s.org(base), s.dest(base)].map(|v| s.at(v));
    let mut best = s.lnext(s.lnext(base));
    let mut next = s.lnext(best);
    while next != base {
        let (c, v) = (s.org(best), s.org(next));
        if c != v && incircle_perturbed(p, q, s.at(c), s.at(v)) == Sign::Positive {
            best = next;
        }
        next = s.lnext(next);
    }
    best
}
