//! A patch: the triangles around a vertex, cut out into a small mesh of their own, where a change of
//! topology can be tried, relaxed and judged, and thrown away when it was no good.

use super::energy::inverse_mean_ratio;
use super::smooth::{NOWHERE, Sheet, Smoother};
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};

/// A small mesh; its vertices are the outline's first, then those inside that may not move, then
/// the movable ones. What memory it has is reused from one patch to the next.
#[derive(Default)]
pub(super) struct Patch {
    pub(super) mesh: Triangulation,
    pub(super) points: Vec<Point2>,
    /// Vertices below this index do not move.
    pub(super) fixed: usize,
    smoother: Smoother,
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
    triangle_places: Vec<u32>,
    /// For each vertex of the mesh the last epoch in which it was found.
    seen: Vec<u32>,
    /// And its place in the patch.
    vertex_places: Vec<u32>,
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
    /// Takes over another patch, reusing memory.
    pub(super) fn assign(&mut self, other: &Self) {
        self.mesh.assign(&other.mesh);
        self.points.clone_from(&other.points);
        self.fixed = other.fixed;
        self.smoother.assign(&other.smoother);
    }

    /// Becomes the rings of triangles around the origin of `start` in `mesh`; `false` where they are
    /// too many, in several regions, or pinch the outline.
    pub(super) fn cut(
        &mut self,
        mesh: &mut Triangulation,
        points: &[Point2],
        start: HalfEdgeId,
        cut: Cut,
        origin: &mut Origin,
    ) -> bool {
        let Some(outline) = origin.collect(mesh, points.len(), start, cut) else { return false };
        let held = origin.vertices[outline..].partition_point(|v| v.index() < cut.fixed);
        self.fixed = outline + held;
        self.points.clear();
        self.points.extend(origin.vertices.iter().map(|v| points[v.index()]));
        self.mesh.clear();
        for &t in &origin.triangles {
            let corners = mesh.corners(t).map(|v| VertexId(origin.vertex_places[v.index()]));
            self.mesh.add(corners);
        }
        self.link_up(mesh, cut.epoch, origin);
        self.smoother.at_rest(&self.mesh, self.points.len());
        true
    }

    fn link_up(&mut self, mesh: &Triangulation, epoch: u32, origin: &mut Origin) {
        origin.outside.clear();
        let places = &origin.triangle_places;
        let place = |t: TriangleId| TriangleId(places[t.index()]);
        let outside = &mut origin.outside;
        for (i, &t) in (0..).zip(&origin.triangles) {
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

    /// Smooths and flips to Delaunay from where a change was made; gives up after the first sweep
    /// when it is `hopeless`.
    pub(super) fn relax(&mut self, quantum: Option<f64>, hopeless: f64) {
        let Self { mesh, points, fixed, smoother } = self;
        let mut sheet = Sheet { mesh, points, fixed: *fixed, quantum };
        smoother.sweep(&mut sheet);
        smoother.flip(&mut sheet);
        if excess(sheet.mesh, sheet.points) > hopeless {
            return;
        }
        for _ in 1..SWEEPS {
            if smoother.sweep(&mut sheet) == 0 {
                break;
            }
            smoother.flip(&mut sheet);
        }
    }

    pub(super) fn worth(&self) -> Worth {
        let mut worth = Worth { excess: 0.0, worst: 0.0 };
        for f in ratios(&self.mesh, &self.points) {
            worth.excess += f * f - 1.0 + BAD_WEIGHT * (f - BAD).max(0.0);
            worth.worst = worth.worst.max(f);
        }
        worth
    }

    fn edge(&self, a: VertexId, b: VertexId) -> Option<HalfEdgeId> {
        let e = self.mesh.half_edge_to(self.out_of(a)?, b)?;
        (!self.mesh.is_constrained(e)).then_some(e)
    }

    fn out_of(&self, v: VertexId) -> Option<HalfEdgeId> {
        Some(self.smoother.outgoing[v.index()]).filter(|&e| e != NOWHERE)
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
            self.smoother.touch(&self.mesh, e.triangle());
            self.smoother.touch(&self.mesh, f.triangle());
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
        self.smoother.push();
        for outer in self.mesh.split_edge(e, m) {
            self.smoother.touch(&self.mesh, outer.triangle());
        }
        true
    }

    /// Replaces the star of a movable vertex by the fan of one of its neighbours, the first from
    /// which all of it is seen.
    fn remove(&mut self, v: VertexId) -> bool {
        if v.index() < self.fixed {
            return false;
        }
        let Some(start) = self.out_of(v) else { return false };
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
        self.smoother.outgoing[v.index()] = NOWHERE;
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
            self.smoother.touch(&self.mesh, t);
        }
        attach(&mut self.mesh, before.expect("a polygon of four"), w + n - 1);
        true
    }
}

fn ratios(mesh: &Triangulation, points: &[Point2]) -> impl Iterator<Item = f64> {
    mesh.triangles().map(|t| {
        let [a, b, c] = mesh.corners(t).map(|v| points[v.index()]);
        inverse_mean_ratio(a, b, c)
    })
}

/// Sum of squared inverse mean ratios above 1.
fn excess(mesh: &Triangulation, points: &[Point2]) -> f64 {
    ratios(mesh, points).map(|f| f * f - 1.0).sum()
}

impl Origin {
    /// Collects the triangles within so many rings of the origin of `start`, marked with the epoch,
    /// and their vertices: the outline's first, each kind in the order of the mesh. Returns the
    /// number of vertices on the outline; `None` where the triangles are too many, in several
    /// regions, or pinch the outline.
    fn collect(
        &mut self,
        mesh: &mut Triangulation,
        points: usize,
        start: HalfEdgeId,
        Cut { rings, epoch, .. }: Cut,
    ) -> Option<usize> {
        self.triangle_places.resize(mesh.slot_count().max(self.triangle_places.len()), 0);
        self.seen.resize(points, 0);
        self.vertex_places.resize(points, 0);
        self.tag = mesh.tag(start.triangle());
        self.triangles.clear();
        self.vertices.clear();
        // Vertices whose stars are still to be taken, by a half-edge out of them.
        let mut ring = vec![start];
        let mut next = Vec::new();
        self.find(mesh.origin(start), epoch);
        for _ in 0..rings {
            for &e in &ring {
                self.take_star(mesh, e, epoch, &mut next)?;
            }
            ring.clear();
            std::mem::swap(&mut ring, &mut next);
        }
        self.sort_vertices(mesh, epoch)
    }

    /// Whether a vertex has not been found before.
    fn find(&mut self, v: VertexId, epoch: u32) -> bool {
        let is_new = self.seen[v.index()] != epoch;
        if is_new {
            self.seen[v.index()] = epoch;
            self.vertices.push(v);
        }
        is_new
    }

    /// Takes the triangles around the origin of `start`, and lists a half-edge out of each vertex
    /// that is new.
    fn take_star(
        &mut self,
        mesh: &mut Triangulation,
        start: HalfEdgeId,
        epoch: u32,
        next: &mut Vec<HalfEdgeId>,
    ) -> Option<()> {
        let (mut e, mut clockwise) = (start, false);
        loop {
            let t = e.triangle();
            if mesh.mark(t) != epoch {
                if self.triangles.len() == TRIANGLES_MAX || mesh.tag(t) != self.tag {
                    return None;
                }
                mesh.set_mark(t, epoch);
                self.triangle_places[t.index()] = self.triangles.len() as u32;
                self.triangles.push(t);
                for side in [e.next(), e.prev()] {
                    if self.find(mesh.origin(side), epoch) {
                        next.push(side);
                    }
                }
            }
            let ccw = if clockwise { None } else { mesh.rotate_ccw(e) };
            match ccw {
                Some(turned) if turned == start => return Some(()),
                Some(turned) => e = turned,
                None => {
                    let from = if clockwise { e } else { start };
                    clockwise = true;
                    match mesh.rotate_cw(from) {
                        Some(turned) => e = turned,
                        None => return Some(()),
                    }
                }
            }
        }
    }

    /// Orders the vertices found and gives them their places.
    fn sort_vertices(&mut self, mesh: &Triangulation, epoch: u32) -> Option<usize> {
        const OUTLINE: u32 = 1;
        for v in &self.vertices {
            self.vertex_places[v.index()] = 0;
        }
        let mut outline = 0;
        for e in self.triangles.iter().flat_map(|t| t.half_edges()) {
            let inside = mesh.twin(e).is_some_and(|twin| mesh.mark(twin.triangle()) == epoch);
            if !inside {
                let place = &mut self.vertex_places[mesh.origin(e).index()];
                if *place == OUTLINE {
                    return None;
                }
                *place = OUTLINE;
                outline += 1;
            }
        }
        let places = &self.vertex_places;
        self.vertices.sort_unstable_by_key(|v| (places[v.index()] != OUTLINE, v.0));
        for (place, v) in (0..).zip(&self.vertices) {
            self.vertex_places[v.index()] = place;
        }
        Some(outline)
    }

    /// The place of a vertex of the mesh in the patch cut in `epoch`.
    pub(super) fn place(&self, v: VertexId, epoch: u32) -> Option<VertexId> {
        let is_there = self.seen.get(v.index()).is_some_and(|&seen| seen == epoch);
        is_there.then(|| VertexId(self.vertex_places[v.index()]))
    }

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
