//! A patch: the triangles around a vertex, cut out into a small mesh of their own, where a change of
//! topology can be tried, relaxed and judged, and thrown away when it was no good.

use super::degree::Degrees;
use super::energy::{aspect_of_poor, inverse_mean_ratio};
use super::places::Places;
use super::smooth::{NOWHERE, Sheet, Smoother};
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};

/// A small mesh; its vertices are the outline's first, then those inside that may not move, then
/// the movable ones. What memory it has is reused from one patch to the next.
#[derive(Default)]
pub(crate) struct Patch {
    pub(crate) mesh: Triangulation,
    pub(crate) points: Vec<Point2>,
    /// Vertices below this index do not move.
    pub(crate) fixed: usize,
    smoother: Smoother,
    /// Vertices around the last change.
    touched: Vec<VertexId>,
}

/// Where a patch came from.
#[derive(Default)]
pub(crate) struct Origin {
    /// The triangles it was cut from, in the order they were found.
    pub(crate) triangles: Vec<TriangleId>,
    /// For each vertex of the patch that of the mesh.
    pub(crate) vertices: Vec<VertexId>,
    /// For each border of the patch what lies across it in the mesh.
    outside: Vec<Across>,
    tag: u32,
}

/// How good a patch is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Worth {
    /// Sum of squared inverse mean ratios above 1, bad ones counted more: 0 where all triangles are
    /// equilateral.
    pub(crate) excess: f64,
    /// Worst inverse mean ratio.
    pub(crate) worst: f64,
    /// Worst R/(2r) of its poor triangles, where that is asked for; 1 without any.
    pub(super) aspect: f64,
}

impl Worth {
    /// That of no triangles.
    pub(crate) const NONE: Self = Self { excess: 0.0, worst: 0.0, aspect: 1.0 };

    /// Adds a triangle with an inverse mean ratio.
    pub(crate) fn add(&mut self, f: f64) {
        self.excess += f * f - 1.0 + BAD_WEIGHT * (f - BAD).max(0.0);
        self.worst = self.worst.max(f);
    }
}

/// How a patch is cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// Rings of triangles around the vertex.
    pub(super) rings: u32,
    /// Vertices of the mesh below this index do not move.
    pub(super) fixed: usize,
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
const SWEEPS: usize = 3;

impl Patch {
    /// Takes over another patch, reusing memory.
    pub(super) fn assign(&mut self, other: &Self) {
        self.mesh.assign(&other.mesh);
        self.points.clone_from(&other.points);
        self.fixed = other.fixed;
        self.smoother.assign(&other.smoother);
        self.touched.clone_from(&other.touched);
    }

    /// Becomes the rings of triangles around a vertex of a mesh, and returns what the vertex is in
    /// the patch; `None` where they are too many, in several regions, or pinch the outline.
    pub(super) fn cut(
        &mut self,
        (mesh, outgoing): (&Triangulation, &[HalfEdgeId]),
        v: VertexId,
        cut: Cut,
        origin: &mut Origin,
        place: impl Fn(VertexId) -> Point2,
    ) -> Option<VertexId> {
        let mut found = Found::around(mesh, outgoing[v.index()], cut.rings)?;
        let outline = found.sort_vertices(mesh)?;
        origin.tag = mesh.tag(found.triangles[0]);
        let held = found.vertices[outline..].partition_point(|v| v.index() < cut.fixed);
        self.fixed = outline + held;
        self.points.clear();
        self.points.extend(found.vertices.iter().map(|&v| place(v)));
        self.mesh.clear();
        for &t in &found.triangles {
            let number = |v: VertexId| found.vertex_places.get(v.0).expect("a vertex of the patch");
            self.mesh.add(mesh.corners(t).map(|v| VertexId(number(v))));
        }
        self.link_up(mesh, &found, &mut origin.outside);
        self.smoother.at_rest(&self.mesh, self.points.len());
        self.touched.clear();
        let here = found.vertex_places.get(v.0).map(VertexId);
        (origin.triangles, origin.vertices) = (found.triangles, found.vertices);
        here
    }

    fn link_up(&mut self, mesh: &Triangulation, found: &Found, outside: &mut Vec<Across>) {
        for (i, &t) in (0..).zip(&found.triangles) {
            for (corner, e) in (0..).zip(t.half_edges()) {
                let here = TriangleId(i).half_edge(corner);
                let across = mesh.across(e);
                match (across, found.inside(across)) {
                    (Across::Twin(twin), Some(place)) => {
                        if e < twin {
                            let there = TriangleId(place).half_edge(twin.corner() as u32);
                            self.mesh.link(here, there);
                            self.mesh.set_constrained(here, mesh.is_constrained(e));
                        }
                    }
                    _ => {
                        self.mesh.set_border(here, outside.len() as u32);
                        // A constraint on the outline stays one: remembered with what lies across.
                        outside.push(across);
                    }
                }
            }
        }
    }

    /// Makes a change; `false` when it cannot be made. New coordinates are multiples of the quantum.
    pub(super) fn make(&mut self, change: Change, quantum: Option<f64>) -> bool {
        self.touched.clear();
        match change {
            Change::Flip(a, b) => self.edge(a, b).is_some_and(|e| self.flip(e)),
            Change::Remove(v) => self.remove(v),
            Change::Split(a, b) => self.edge(a, b).is_some_and(|e| self.split(e, quantum)),
        }
    }

    /// Smooths and flips to Delaunay from where a change was made; gives up after the first sweep
    /// when the excess is then above the first limit, and after its flips when it is above the second.
    pub(super) fn relax(&mut self, quantum: Option<f64>, [unflipped_max, flipped_max]: [f64; 2]) {
        let Self { mesh, points, fixed, smoother, .. } = self;
        let mut sheet = Sheet { mesh, points, fixed: *fixed, quantum };
        smoother.sweep(&mut sheet);
        if unflipped_max < f64::INFINITY && excess(sheet.mesh, sheet.points) > unflipped_max {
            return;
        }
        smoother.flip(&mut sheet);
        if excess(sheet.mesh, sheet.points) > flipped_max {
            return;
        }
        for _ in 1..SWEEPS {
            if smoother.sweep(&mut sheet) == 0 {
                break;
            }
        }
        smoother.flip(&mut sheet);
    }

    /// Vertices around the last change, some of them more than once.
    pub(super) fn touched(&self) -> &[VertexId] {
        &self.touched
    }

    pub(super) fn worth(&self) -> Worth {
        let mut worth = Worth::NONE;
        for corners in triangles(&self.mesh, &self.points) {
            let [a, b, c] = corners;
            let f = inverse_mean_ratio(a, b, c);
            worth.add(f);
            worth.aspect = worth.aspect.max(aspect_of_poor(f, corners));
        }
        worth
    }

    /// Adds the changes worth trying around a vertex.
    pub(super) fn changes(&self, v: VertexId, list: &mut Vec<Change>) {
        let outgoing = &self.smoother.outgoing;
        Degrees { mesh: &self.mesh, points: &self.points, outgoing }.changes(v, list);
    }

    /// By how much a change raises the excess before anything is relaxed; infinite when it inverts a
    /// triangle or cannot be made. Floats: this ranks.
    pub(super) fn rise(&self, change: Change) -> f64 {
        match change {
            Change::Flip(a, b) => self.edge(a, b).map_or(f64::INFINITY, |e| self.rise_of_flip(e)),
            Change::Split(a, b) => self.edge(a, b).map_or(f64::INFINITY, |e| self.rise_of_split(e)),
            Change::Remove(v) => self.rise_of_removal(v),
        }
    }

    fn rise_of_flip(&self, e: HalfEdgeId) -> f64 {
        let Some(f) = self.mesh.twin(e) else { return f64::INFINITY };
        let [a, b] = [self.mesh.origin(e), self.mesh.dest(e)].map(|v| self.points[v.index()]);
        let [c, d] = [self.mesh.apex(e), self.mesh.apex(f)].map(|v| self.points[v.index()]);
        shortfall(d, c, a) + shortfall(c, d, b) - shortfall(a, b, c) - shortfall(b, a, d)
    }

    fn rise_of_split(&self, e: HalfEdgeId) -> f64 {
        let Some(f) = self.mesh.twin(e) else { return f64::INFINITY };
        let [a, b] = [self.mesh.origin(e), self.mesh.dest(e)].map(|v| self.points[v.index()]);
        let [c, d] = [self.mesh.apex(e), self.mesh.apex(f)].map(|v| self.points[v.index()]);
        let m = Point2::new(0.5 * a.x + 0.5 * b.x, 0.5 * a.y + 0.5 * b.y);
        let after: f64 =
            [(b, c), (c, a), (a, d), (d, b)].map(|(p, q)| shortfall(p, q, m)).iter().sum();
        after - shortfall(a, b, c) - shortfall(b, a, d)
    }

    /// The polygon is fanned from the first of its corners from which no triangle is inverted.
    fn rise_of_removal(&self, v: VertexId) -> f64 {
        let Some(start) = self.out_of(v) else { return f64::INFINITY };
        let own = self.points[v.index()];
        let dest = |e| self.points[self.mesh.dest(e).index()];
        let link: Vec<Point2> = self.mesh.star(start).map(dest).collect();
        let n = link.len();
        let at = |i: usize| link[i % n];
        let before: f64 = (0..n).map(|i| shortfall(own, at(i), at(i + 1))).sum();
        let fan =
            |w: usize| (1..n - 1).map(|i| shortfall(at(w), at(w + i), at(w + i + 1))).sum::<f64>();
        let after = (0..n).map(fan).find(|after| after.is_finite());
        after.map_or(f64::INFINITY, |after| after - before)
    }

    fn touch(&mut self, t: TriangleId) {
        self.touched.extend(self.mesh.corners(t));
        self.smoother.touch(&self.mesh, t);
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
            self.touch(e.triangle());
            self.touch(f.triangle());
        }
        convex
    }

    fn split(&mut self, e: HalfEdgeId, quantum: Option<f64>) -> bool {
        let Some(f) = self.mesh.twin(e) else { return false };
        let [a, b] = [self.mesh.origin(e), self.mesh.dest(e)];
        let [p, q] = [a, b].map(|v| self.points[v.index()]);
        let middle = Point2::new(0.5 * p.x + 0.5 * q.x, 0.5 * p.y + 0.5 * q.y);
        let middle = quantum.map_or(middle, |quantum| middle.rounded_to(quantum));
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
            self.touch(outer.triangle());
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
            self.touch(t);
        }
        attach(&mut self.mesh, before.expect("a polygon of four"), w + n - 1);
        true
    }
}

fn triangles(mesh: &Triangulation, points: &[Point2]) -> impl Iterator<Item = [Point2; 3]> {
    mesh.triangles().map(|t| mesh.corners(t).map(|v| points[v.index()]))
}

fn ratios(mesh: &Triangulation, points: &[Point2]) -> impl Iterator<Item = f64> {
    triangles(mesh, points).map(|[a, b, c]| inverse_mean_ratio(a, b, c))
}

/// What a triangle adds to the excess.
fn shortfall(a: Point2, b: Point2, c: Point2) -> f64 {
    inverse_mean_ratio(a, b, c).powi(2) - 1.0
}

/// Sum of squared inverse mean ratios above 1.
fn excess(mesh: &Triangulation, points: &[Point2]) -> f64 {
    ratios(mesh, points).map(|f| f * f - 1.0).sum()
}

/// The triangles and vertices of a patch in the mesh.
struct Found {
    triangles: Vec<TriangleId>,
    vertices: Vec<VertexId>,
    triangle_places: Places,
    vertex_places: Places,
}

impl Found {
    /// The triangles within so many rings of the origin of `start`; `None` where they are too many or
    /// in several regions.
    fn around(mesh: &Triangulation, start: HalfEdgeId, rings: u32) -> Option<Self> {
        if start == NOWHERE {
            return None;
        }
        let mut found = Self {
            triangles: Vec::with_capacity(96),
            vertices: Vec::with_capacity(64),
            triangle_places: Places::default(),
            vertex_places: Places::default(),
        };
        found.find(mesh.origin(start));
        // Vertices whose stars are still to be taken, by a half-edge out of them.
        let mut ring = vec![start];
        let mut next = Vec::new();
        for _ in 0..rings {
            for &e in &ring {
                for spoke in mesh.star(e) {
                    found.take(mesh, spoke, &mut next)?;
                }
            }
            ring.clear();
            std::mem::swap(&mut ring, &mut next);
        }
        Some(found)
    }

    /// Takes the triangle of a half-edge, and lists a half-edge out of each vertex that is new.
    fn take(
        &mut self,
        mesh: &Triangulation,
        e: HalfEdgeId,
        next: &mut Vec<HalfEdgeId>,
    ) -> Option<()> {
        let t = e.triangle();
        if self.triangle_places.insert(t.0, self.triangles.len() as u32) {
            self.triangles.push(t);
            if self.triangles.len() > TRIANGLES_MAX || mesh.tag(t) != mesh.tag(self.triangles[0]) {
                return None;
            }
            for side in [e.next(), e.prev()] {
                if self.find(mesh.origin(side)) {
                    next.push(side);
                }
            }
        }
        Some(())
    }

    /// Whether a vertex has not been found before.
    fn find(&mut self, v: VertexId) -> bool {
        let is_new = self.vertex_places.insert(v.0, 0);
        if is_new {
            self.vertices.push(v);
        }
        is_new
    }

    /// The place of the triangle across an edge, if that is in the patch.
    fn inside(&self, across: Across) -> Option<u32> {
        match across {
            Across::Twin(twin) => self.triangle_places.get(twin.triangle().0),
            Across::Border(_) => None,
        }
    }

    /// Orders the vertices, the outline's first, each kind as in the mesh, and gives them their
    /// places; returns the number on the outline, `None` where that is pinched.
    fn sort_vertices(&mut self, mesh: &Triangulation) -> Option<usize> {
        let mut outline: Vec<VertexId> = Vec::with_capacity(32);
        for e in self.triangles.iter().flat_map(|t| t.half_edges()) {
            if self.inside(mesh.across(e)).is_none() {
                outline.push(mesh.origin(e));
            }
        }
        outline.sort_unstable();
        if outline.windows(2).any(|pair| pair[0] == pair[1]) {
            return None;
        }
        self.vertices.sort_unstable_by_key(|v| (outline.binary_search(v).is_err(), *v));
        for (place, v) in (0..).zip(&self.vertices) {
            self.vertex_places.set(v.0, place);
        }
        Some(outline.len())
    }
}

impl Origin {
    /// Puts a changed patch in the place of its origin: new vertices get new numbers from `push`,
    /// and `touched` is told each new half-edge.
    pub(crate) fn replace(
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
