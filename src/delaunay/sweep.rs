//! Sweep line.
//!
//! Fortune, *A sweepline algorithm for Voronoi diagrams*, 1987. Under the paper's hyperbolic
//! transform a point z goes up by its distance to the nearest site, so that a Voronoi vertex lies
//! at the height of the top of its circle, and a line moving up meets each site before anything of
//! its cell. Above the line nothing is known; below it, the sites whose cells reach the line make a
//! chain, the beach. A site splits the arc of the beach below it (site event); where three arcs in
//! turn meet, the middle one ends and its three sites are a Delaunay triangle (circle event).
//!
//! Differs from the paper in what rounding may do: heights of circle tops are irrational, so floats
//! only choose the order of events. Every triangle is counterclockwise by an exact sign; that they
//! cover the hull once is certified exactly at the end; and flips restore the Delaunay property where
//! events nearly coincided, and the canonical diagonals where they did coincide. Should the
//! certificate fail (coordinates so far apart that heights are meaningless), the triangles are
//! dropped and the points are swept from left to right without a beach: each sees part of the hull
//! of those before it.

use super::assemble::{from_triangles, sorted_line};
use super::hull::convex_hull;
use super::lawson::legalize_all;
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::triangulation::{TriangleId, Triangulation, VertexId};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Delaunay triangulation of distinct finite points in lexicographic order.
pub(crate) fn triangulate(points: &[Point2]) -> Triangulation {
    if points.len() < 3 {
        return sorted_line(points);
    }
    let certified = Beach::sweep(points).and_then(|triangles| certify(points, &triangles));
    let mut triangulation = certified.unwrap_or_else(|| sweep_hull(points));
    legalize_all(&mut triangulation, points);
    triangulation
}

/// The triangulation of counterclockwise triangles, if they cover the convex hull of all points
/// exactly once and use every point. By the degree argument of SPEC 11 it is enough that what
/// remains of their boundaries is the boundary of the hull.
fn certify(points: &[Point2], triangles: &[[u32; 3]]) -> Option<Triangulation> {
    let triangulation = from_triangles(points.len(), triangles)?;
    let hull = convex_hull(points);
    let ghosts: Vec<TriangleId> =
        triangulation.triangles().filter(|&t| triangulation.is_ghost(t)).collect();
    let mut after = vec![None; points.len()];
    for (&u, &v) in hull.iter().zip(hull.iter().cycle().skip(1)) {
        after[u as usize] = Some(VertexId(v));
    }
    let on_hull = |&t: &TriangleId| {
        let e = triangulation.ghost_edge(t);
        after[triangulation.dest(e).index()] == Some(triangulation.origin(e))
    };
    let used = triangulation.outgoing(points.len()).iter().all(Option::is_some);
    (used && ghosts.len() == hull.len() && ghosts.iter().all(on_hull)).then_some(triangulation)
}

/// Each point is joined to the part of the hull of the points before it that it sees.
fn sweep_hull(points: &[Point2]) -> Triangulation {
    let mut triangles = Vec::new();
    let (mut upper, mut lower): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
    let side = |a: u32, b: u32, v: u32| {
        orient2d(points[a as usize], points[b as usize], points[v as usize])
    };
    for v in 0..points.len() as u32 {
        while let [.., a, b] = upper[..] {
            if side(a, b, v) != Sign::Positive {
                break;
            }
            triangles.push([a, b, v]);
            upper.pop();
        }
        while let [.., a, b] = lower[..] {
            if side(a, b, v) != Sign::Negative {
                break;
            }
            triangles.push([b, a, v]);
            lower.pop();
        }
        upper.push(v);
        lower.push(v);
    }
    if triangles.is_empty() {
        return sorted_line(points);
    }
    from_triangles(points.len(), &triangles).expect("each point closes what it sees")
}

/// No arc.
const NONE: u32 = u32::MAX;

/// A stretch of the beach that belongs to one site.
struct Arc {
    site: u32,
    left: u32,
    right: u32,
    /// Circle events with another number are void.
    stamp: u32,
    live: bool,
}

/// The end of an arc, at the height of the top of its circle.
struct CircleEvent {
    height: f64,
    arc: u32,
    stamp: u32,
}

impl Ord for CircleEvent {
    /// The lowest first out of the heap; ties by arc, so that runs are alike.
    fn cmp(&self, other: &Self) -> Ordering {
        other.height.total_cmp(&self.height).then(other.arc.cmp(&self.arc))
    }
}

impl PartialOrd for CircleEvent {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for CircleEvent {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for CircleEvent {}

struct Beach<'a> {
    points: &'a [Point2],
    arcs: Vec<Arc>,
    events: BinaryHeap<CircleEvent>,
    /// Some arc near each of a row of equal intervals of x: where searches start.
    buckets: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

impl<'a> Beach<'a> {
    /// The triangles of all circle events; `None` if the points lie on one line or far apart.
    fn sweep(points: &'a [Point2]) -> Option<Vec<[u32; 3]>> {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let key = |v: u32| points[v as usize];
        order.sort_by(|&v, &w| {
            key(v).y.partial_cmp(&key(w).y).unwrap_or(Ordering::Equal).then(v.cmp(&w))
        });
        let count = 2 * (points.len() as f64).sqrt() as usize + 1;
        let mut beach = Self {
            points,
            arcs: Vec::with_capacity(2 * points.len()),
            events: BinaryHeap::new(),
            buckets: vec![NONE; count],
            triangles: Vec::with_capacity(2 * points.len()),
        };
        beach.add_arc(order[0], NONE, NONE);
        for &site in &order[1..] {
            beach.finish_arcs_below(key(site).y);
            beach.site_event(site);
        }
        beach.finish_arcs_below(f64::INFINITY);
        (!beach.triangles.is_empty()).then_some(beach.triangles)
    }

    fn at(&self, v: u32) -> Point2 {
        self.points[v as usize]
    }

    fn finish_arcs_below(&mut self, height: f64) {
        while let Some(event) = self.events.pop_if_at_most(height) {
            let arc = &self.arcs[event.arc as usize];
            if arc.live && arc.stamp == event.stamp {
                self.circle_event(event.arc);
            }
        }
    }

    fn circle_event(&mut self, arc: u32) {
        let Arc { site, left, right, .. } = self.arcs[arc as usize];
        self.triangles.push([self.site(left), site, self.site(right)]);
        self.arcs[arc as usize].live = false;
        self.join(left, right);
        self.foresee(left);
        self.foresee(right);
    }

    fn site_event(&mut self, site: u32) {
        let below = self.arc_below(self.at(site));
        let bucket = self.bucket(self.at(site).x);
        let Arc { site: old, right, .. } = self.arcs[below as usize];
        let new = self.add_arc(site, below, right);
        self.buckets[bucket] = new;
        if self.at(old).y < self.at(site).y {
            // The arc goes on on the other side of the new one.
            let rest = self.add_arc(old, new, right);
            self.foresee(rest);
        }
        self.foresee(below);
        self.foresee(new);
        if right != NONE {
            self.foresee(right);
        }
    }

    fn add_arc(&mut self, site: u32, left: u32, right: u32) -> u32 {
        let arc = self.arcs.len() as u32;
        self.arcs.push(Arc { site, left, right, stamp: 0, live: true });
        self.join(left, arc);
        self.join(arc, right);
        arc
    }

    fn join(&mut self, left: u32, right: u32) {
        if let Some(arc) = self.arcs.get_mut(left as usize) {
            arc.right = right;
        }
        if let Some(arc) = self.arcs.get_mut(right as usize) {
            arc.left = left;
        }
    }

    fn site(&self, arc: u32) -> u32 {
        self.arcs[arc as usize].site
    }

    /// Enters the event that ends an arc, if its neighbours close in on it.
    fn foresee(&mut self, arc: u32) {
        let Arc { site, left, right, .. } = self.arcs[arc as usize];
        self.arcs[arc as usize].stamp += 1;
        if left == NONE || right == NONE {
            return;
        }
        let corners = [self.site(left), site, self.site(right)].map(|v| self.at(v));
        let [a, b, c] = corners;
        if orient2d(a, b, c) == Sign::Positive {
            let (height, stamp) = (circle_top(corners), self.arcs[arc as usize].stamp);
            self.events.push(CircleEvent { height, arc, stamp });
        }
    }

    fn bucket(&self, x: f64) -> usize {
        let [low, high] = [self.points[0].x, self.points[self.points.len() - 1].x];
        let place = (x - low) / (high - low) * self.buckets.len() as f64;
        (place as usize).min(self.buckets.len() - 1)
    }

    /// The arc straight below a site: from an arc near it, along the beach.
    fn arc_below(&self, s: Point2) -> u32 {
        let mut arc = self.start_near(self.bucket(s.x));
        loop {
            let Arc { left, right, .. } = self.arcs[arc as usize];
            if left != NONE && self.is_left_of_meeting(s, left, arc) {
                arc = left;
            } else if right != NONE && !self.is_left_of_meeting(s, arc, right) {
                arc = right;
            } else {
                return arc;
            }
        }
    }

    fn start_near(&self, bucket: usize) -> u32 {
        let live = |b: usize| {
            let arc = *self.buckets.get(b)?;
            self.arcs.get(arc as usize).filter(|a| a.live).map(|_| arc)
        };
        let near = (0..self.buckets.len())
            .find_map(|k| live(bucket + k).or_else(|| live(bucket.checked_sub(k)?)));
        near.unwrap_or_else(|| {
            self.arcs.iter().position(|a| a.live).expect("the beach is never empty") as u32
        })
    }

    /// Whether `s`, on the sweep line, is left of where two neighbouring arcs meet. The arc of the
    /// higher site is a stretch around its abscissa; outside it the other is nearer to the line.
    fn is_left_of_meeting(&self, s: Point2, left: u32, right: u32) -> bool {
        let (p, q) = (self.at(self.site(left)), self.at(self.site(right)));
        if p.y == s.y && q.y == s.y {
            return s.x < p.x.midpoint(q.x);
        }
        let left_nearer = s.distance_sq(p) * (s.y - q.y) < s.distance_sq(q) * (s.y - p.y);
        match p.y.partial_cmp(&q.y) {
            Some(Ordering::Greater) => s.x <= p.x || left_nearer,
            Some(Ordering::Less) => s.x < q.x && left_nearer,
            _ => left_nearer,
        }
    }
}

/// Height of the top of a circle: that of its centre under the hyperbolic transform. Rounded.
fn circle_top([a, b, c]: [Point2; 3]) -> f64 {
    let (ax, ay, cx, cy) = (a.x - b.x, a.y - b.y, c.x - b.x, c.y - b.y);
    let (a2, c2) = (ax * ax + ay * ay, cx * cx + cy * cy);
    let d = 2.0 * (cx * ay - cy * ax);
    let (x, y) = ((ay * c2 - cy * a2) / -d, (cx * a2 - ax * c2) / d);
    b.y + y + (x * x + y * y).sqrt()
}

/// A peek and a pop in one.
trait PopIf {
    fn pop_if_at_most(&mut self, height: f64) -> Option<CircleEvent>;
}

impl PopIf for BinaryHeap<CircleEvent> {
    fn pop_if_at_most(&mut self, height: f64) -> Option<CircleEvent> {
        let due = self.peek().is_some_and(|e| height == f64::INFINITY || e.height <= height);
        if due { self.pop() } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sorted points of a rounded circle, a grid and a scattered lot.
    fn inputs() -> Vec<Vec<Point2>> {
        let angle = |i: u32| f64::from(i) * 0.031_4;
        let circle = (0..200).map(|i| Point2::new(libm::cos(angle(i)), libm::sin(angle(i))));
        let grid = (0..225).map(|i| Point2::new(f64::from(i % 15) * 0.1, f64::from(i / 15) * 0.1));
        let lot = (0..500_u32).map(|i| {
            let hash = i.wrapping_mul(0x9E37_79B1);
            Point2::new(f64::from(hash >> 16), f64::from(hash.wrapping_mul(0x85EB_CA6B) >> 16))
        });
        let mut inputs = vec![circle.collect::<Vec<_>>(), grid.collect(), lot.collect()];
        inputs.iter_mut().for_each(|points| points.sort_unstable_by(|a, b| a.lexicographic(*b)));
        inputs.iter_mut().for_each(|points| points.dedup());
        inputs
    }

    #[test]
    fn the_beach_is_certified_on_ordinary_points() {
        for points in inputs() {
            let triangles = Beach::sweep(&points).unwrap();
            assert!(certify(&points, &triangles).is_some(), "{} points", points.len());
        }
    }

    #[test]
    fn the_certificate_refuses_what_does_not_cover_the_hull() {
        for points in inputs() {
            let triangles = Beach::sweep(&points).unwrap();
            for drop in 0..triangles.len() {
                let mut fewer = triangles.clone();
                fewer.remove(drop);
                assert!(certify(&points, &fewer).is_none());
            }
            let mut twice = triangles.clone();
            twice.push(triangles[0]);
            assert!(certify(&points, &twice).is_none());
        }
    }

    #[test]
    fn without_a_beach_the_triangles_are_the_same() {
        for points in inputs() {
            let mut other = sweep_hull(&points);
            legalize_all(&mut other, &points);
            other.verify_geometry(&points).unwrap();
            let corners = |t: &Triangulation| {
                let mut list: Vec<_> = t.triangles().map(|u| t.corners(u)).collect();
                list.iter_mut().for_each(|c| c.sort_unstable());
                list.sort_unstable();
                list
            };
            assert_eq!(corners(&other), corners(&triangulate(&points)));
        }
    }
}
