//! A patch: the triangles around a vertex, cut out into a small mesh of their own, where a change of
//! topology can be tried, relaxed and judged, and thrown away when it was no good.

use super::smooth::{Smoother, inverse_mean_ratio};
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};

/// A small mesh; its vertices are the outline's first, then those inside that may not move, then
/// the movable ones.
#[derive(Clone, Default)]
pub(super) struct Patch {
    pub(super) mesh: Triangulation,
    pub(super) points: Vec<Point2>,
    /// Vertices below this index do not move.
    pub(super) fixed: usize,
}

/// Where a patch came from.
#[derive(Default)]
pub(super) struct Origin {
    /// The triangles it was cut from, in the order they were found.
    pub(super) triangles: Vec<TriangleId>,
    /// For each vertex of the patch that of the mesh.
    pub(super) vertices: Vec<VertexId>,
    /// For each border of the patch what lies across it in the mesh.
    pub(super) outside: Vec<Across>,
    /// For each triangle of the mesh its place in the patch, valid for those in it.
    places: Vec<u32>,
    tag: u32,
}

/// How good a patch is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Worth {
    /// Sum of squared inverse mean ratios above 1, bad ones counted more: 0 where all triangles are
    /// equilateral.
    pub(super) excess: f64,
    /// Worst inverse mean ratio.
    pub(super) worst: f64,
}

/// How a patch is cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// Rings of triangles around the vertex.
    pub(super) rings: u32,
    /// Vertices of the mesh below this index do not move.
    pub(super) fixed: usize,
    /// Marks the triangles of this patch.
    pub(super) epoch: u32,
}

/// A change of topology in a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Change {
    /// The other diagonal of the two triangles at an edge, given by its ends.
    Flip(VertexId, VertexId),
    /// The vertex goes, its triangles become those of its polygon.
    Remove(VertexId),
    /// A vertex in the middle of an edge, given by its ends.
    Split(VertexId, VertexId),
}

/// A triangle with an inverse mean ratio above this counts more: R/(2r) is then about 1.1.
const BAD: f64 = 1.06;
/// By how much more.
const BAD_WEIGHT: f64 = 6.0;
/// A larger patch is no ordinary place.
const TRIANGLES_MAX: usize = 200;
/// Sweeps of smoothing and flips before a change is judged.
const SWEEPS: usize = 4;

impl Patch {
    /// Cuts the rings of triangles around the origin of `start` out of `mesh`. `None` where they are
    /// too many, in several regions, or pinch the outline.
    pub(super) fn cut(
        mesh: &mut Triangulation,
        points: &[Point2],
        start: HalfEdgeId,
        cut: Cut,
        origin: &mut Origin,
    ) -> Option<Self> {
        let Cut { fixed, epoch, .. } = cut;
        collect_rings(mesh, start, cut, &mut origin.triangles)?;
        origin.tag = mesh.tag(start.triangle());
        let mut outline = Vec::new();
        let mut inside = Vec::new();
        for &t in &origin.triangles {
            if mesh.tag(t) != origin.tag {
                return None;
            }
            for e in t.half_edges() {
                let is_outline = match mesh.across(e) {
                    Across::Border(_) => true,
                    Across::Twin(twin) => mesh.mark(twin.triangle()) != epoch,
                };
                if is_outline {
                    outline.push(mesh.origin(e));
                }
                inside.push(mesh.origin(e));
            }
        }
        let edges = outline.len();
        outline.sort_unstable();
        outline.dedup();
        if outline.len() != edges {
            return None;
        }
        inside.sort_unstable();
        inside.dedup();
        inside.retain(|v| outline.binary_search(v).is_err());
        let held = inside.partition_point(|v| v.index() < fixed);
        origin.vertices.clear();
        origin.vertices.extend(outline.iter().chain(&inside));
        let count = outline.len();
        let local = |v: VertexId| {
            let place = outline.binary_search(&v).unwrap_or_else(|_| {
                count + inside.binary_search(&v).expect("a vertex of the patch")
            });
            VertexId(place as u32)
        };
        let mut patch = Self {
            mesh: Triangulation::with_capacity(origin.triangles.len() + 4),
            points: origin.vertices.iter().map(|v| points[v.index()]).collect(),
            fixed: count + held,
        };
        let all = std::mem::take(&mut origin.triangles);
        for &t in &all {
            let new = patch.mesh.add(mesh.corners(t).map(local));
            patch.mesh.set_tag(new, 0);
        }
        patch.link_up(mesh, &all, epoch, origin);
        origin.triangles = all;
        Some(patch)
    }

    fn link_up(
        &mut self,
        mesh: &Triangulation,
        all: &[TriangleId],
        epoch: u32,
        origin: &mut Origin,
    ) {
        origin.outside.clear();
        origin.places.resize(mesh.slot_count().max(origin.places.len()), 0);
        for (i, &t) in (0..).zip(all) {
            origin.places[t.index()] = i;
        }
        let places = &origin.places;
        let place = |t: TriangleId| TriangleId(places[t.index()]);
        let outside = &mut origin.outside;
        for (i, &t) in (0..).zip(all) {
            for (corner, e) in (0..).zip(t.half_edges()) {
                let here = TriangleId(i).half_edge(corner);
                match mesh.across(e) {
                    Across::Twin(twin) if mesh.mark(twin.triangle()) == epoch => {
                        if e < twin {
                            let there = place(twin.triangle()).half_edge(twin.corner() as u32);
                            self.mesh.link(here, there);
                            self.mesh.set_constrained(here, mesh.is_constrained(e));
                        }
                    }
                    across => {
                        self.mesh.set_border(here, outside.len() as u32);
                        // A constraint on the outline stays one: remembered with what lies across.
                        outside.push(across);
                    }
                }
            }
        }
    }

    /// Makes a change; `false` when it cannot be made.
    pub(super) fn make(&mut self, change: Change) -> bool {
        match change {
            Change::Flip(a, b) => self.edge(a, b).is_some_and(|e| self.flip(e)),
            Change::Remove(v) => self.remove(v),
            Change::Split(a, b) => self.edge(a, b).is_some_and(|e| self.split(e)),
        }
    }

    /// Smooths and flips to Delaunay; gives up after the first sweep when it is `hopeless`.
    pub(super) fn relax(&mut self, quantum: Option<f64>, hopeless: f64) {
        let mut smoother = Smoother::new(&mut self.mesh, &mut self.points, self.fixed, quantum);
        smoother.sweep();
        smoother.flip_all();
        if smoother.excess() > hopeless {
            return;
        }
        for _ in 1..SWEEPS {
            if smoother.sweep() == 0 {
                break;
            }
            smoother.flip();
        }
    }

    pub(super) fn worth(&self) -> Worth {
        let mut worth = Worth { excess: 0.0, worst: 0.0 };
        for t in self.mesh.triangles() {
            let [a, b, c] = self.mesh.corners(t).map(|v| self.points[v.index()]);
            let f = inverse_mean_ratio(a, b, c);
            worth.excess += f * f - 1.0 + BAD_WEIGHT * (f - BAD).max(0.0);
            worth.worst = worth.worst.max(f);
        }
        worth
    }

    fn edge(&self, a: VertexId, b: VertexId) -> Option<HalfEdgeId> {
        let mut edges = self.mesh.triangles().flat_map(TriangleId::half_edges);
        edges.find(|&e| {
            self.mesh.origin(e) == a && self.mesh.dest(e) == b && !self.mesh.is_constrained(e)
        })
    }

    fn is_ccw(&self, corners: [VertexId; 3]) -> bool {
        let [a, b, c] = corners.map(|v| self.points[v.index()]);
        orient2d(a, b, c) == Sign::Positive
    }

    fn flip(&mut self, e: HalfEdgeId) -> bool {
        let Some(f) = self.mesh.twin(e) else { return false };
        let [a, b] = [self.mesh.origin(e), self.mesh.dest(e)];
        let [c, d] = [self.mesh.apex(e), self.mesh.apex(f)];
        let convex = self.is_ccw([d, c, a]) && self.is_ccw([c, d, b]);
        if convex {
            self.mesh.flip(e);
        }
        convex
    }

    fn split(&mut self, e: HalfEdgeId) -> bool {
        let Some(f) = self.mesh.twin(e) else { return false };
        let [a, b] = [self.mesh.origin(e), self.mesh.dest(e)];
        let [p, q] = [a, b].map(|v| self.points[v.index()]);
        let middle = Point2::new(0.5 * p.x + 0.5 * q.x, 0.5 * p.y + 0.5 * q.y);
        let hull: [HalfEdgeId; 4] = [e.next(), e.prev(), f.next(), f.prev()];
        let ends = hull.map(|h| [self.mesh.origin(h), self.mesh.dest(h)]);
        let m = VertexId(self.points.len() as u32);
        self.points.push(middle);
        if !ends.iter().all(|&[u, v]| self.is_ccw([u, v, m])) {
            self.points.pop();
            return false;
        }
        self.mesh.split_edge(e, m);
        true
    }

    /// Replaces the star of a movable vertex by the fan of one of its neighbours, the first from
    /// which all of it is seen.
    fn remove(&mut self, v: VertexId) -> bool {
        if v.index() < self.fixed {
            return false;
        }
        let Some(start) = self
            .mesh
            .triangles()
            .flat_map(TriangleId::half_edges)
            .find(|&e| self.mesh.origin(e) == v)
        else {
            return false;
        };
        let star: Vec<HalfEdgeId> = self.mesh.star(start).collect();
        let n = star.len();
        if star.iter().any(|&e| self.mesh.is_constrained(e)) || n < 4 {
            return false;
        }
        let link: Vec<VertexId> = star.iter().map(|&e| self.mesh.dest(e)).collect();
        let sees = |w: usize| {
            (1..n - 1).all(|i| self.is_ccw([link[w], link[(w + i) % n], link[(w + i + 1) % n]]))
        };
        let Some(w) = (0..n).find(|&w| sees(w)) else { return false };
        let outer: Vec<(Across, bool)> = star
            .iter()
            .map(|e| (self.mesh.across(e.next()), self.mesh.is_constrained(e.next())))
            .collect();
        for e in &star {
            self.mesh.remove(e.triangle());
        }
        let attach = |mesh: &mut Triangulation, side: HalfEdgeId, i: usize| {
            let (across, constrained) = outer[i % n];
            mesh.relink(side, across);
            if constrained {
                mesh.set_constrained(side, true);
            }
        };
        let mut before: Option<HalfEdgeId> = None;
        for i in 1..n - 1 {
            let t = self.mesh.add([link[w], link[(w + i) % n], link[(w + i + 1) % n]]);
            match before {
                None => attach(&mut self.mesh, t.half_edge(0), w),
                Some(side) => self.mesh.link(side, t.half_edge(0)),
            }
            attach(&mut self.mesh, t.half_edge(1), w + i);
            before = Some(t.half_edge(2));
        }
        attach(&mut self.mesh, before.expect("a polygon of four"), w + n - 1);
        true
    }
}

/// Triangles within so many rings of a vertex, marked with the epoch; `None` where they are too many.
fn collect_rings(
    mesh: &mut Triangulation,
    start: HalfEdgeId,
    Cut { rings, epoch, .. }: Cut,
    triangles: &mut Vec<TriangleId>,
) -> Option<()> {
    triangles.clear();
    let mut ring = vec![start];
    for _ in 0..rings {
        let first = triangles.len();
        for &e in &ring {
            let star: Vec<TriangleId> = mesh.star(e).map(HalfEdgeId::triangle).collect();
            for t in star {
                if mesh.mark(t) != epoch {
                    mesh.set_mark(t, epoch);
                    triangles.push(t);
                }
            }
            if triangles.len() > TRIANGLES_MAX {
                return None;
            }
        }
        ring = triangles[first..].iter().flat_map(|t| t.half_edges()).collect();
    }
    Some(())
}

impl Origin {
    /// Puts a changed patch in the place of its origin: new vertices get new numbers from `push`,
    /// and `touched` is told each new half-edge.
    pub(super) fn replace(
        &mut self,
        mesh: &mut Triangulation,
        patch: &Patch,
        mut push: impl FnMut(Point2) -> VertexId,
        mut touched: impl FnMut(&Triangulation, HalfEdgeId),
    ) {
        for &p in &patch.points[self.vertices.len()..] {
            self.vertices.push(push(p));
        }
        let constrained: Vec<bool> = self
            .outside
            .iter()
            .map(|across| matches!(across, Across::Twin(twin) if mesh.is_constrained(*twin)))
            .collect();
        for &t in &self.triangles {
            mesh.remove(t);
        }
        let live: Vec<TriangleId> = patch.mesh.triangles().collect();
        let mut image = vec![TriangleId(0); patch.mesh.slot_count()];
        for &t in &live {
            let new = mesh.add(patch.mesh.corners(t).map(|v| self.vertices[v.index()]));
            mesh.set_tag(new, self.tag);
            image[t.index()] = new;
        }
        let there = |e: HalfEdgeId| image[e.triangle().index()].half_edge(e.corner() as u32);
        for e in live.iter().flat_map(|t| t.half_edges()) {
            match patch.mesh.across(e) {
                Across::Twin(twin) if e < twin => {
                    mesh.link(there(e), there(twin));
                    mesh.set_constrained(there(e), patch.mesh.is_constrained(e));
                }
                Across::Twin(_) => {}
                Across::Border(i) => {
                    mesh.relink(there(e), self.outside[i as usize]);
                    if constrained[i as usize] {
                        mesh.set_constrained(there(e), true);
                    }
                }
            }
        }
        for e in live.iter().flat_map(|t| t.half_edges()) {
            touched(mesh, there(e));
        }
    }
}
