//! A skin: a triangulation whose vertices move on a surface in space, and the local operations that
//! keep it one (SPEC 19).
//!
//! Splits, collapses, flips and moves (M. Botsch, L. Kobbelt, A remeshing approach to
//! multiresolution modeling, SGP 2004). Topology is kept by the link condition; that no triangle
//! turns over is decided exactly in the coordinate plane that its former normal faces most.

mod collapse;
mod fold;
mod link;
mod pass;
mod smooth;
#[cfg(test)]
mod tests;

pub use fold::faces;
pub(crate) use fold::shape;
pub use link::{BadEdge, linked};
pub use pass::{Effort, Passes, TooManyVertices};

use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation, VertexId};
use crate::vector::{Vector, add, cross, distance, scale, sub, unit};
use fold::is_kept;

/// The surface that a skin lies on.
pub trait Ground: Sync {
    /// What the search for a foot starts from.
    type Place: Copy + Send + Sync;
    /// The foot of `p` on the smooth part `region` of the surface, near `from` if that is known,
    /// where the surface faces like `facing`.
    fn foot(
        &self,
        p: Vector,
        region: u32,
        facing: Vector,
        from: Option<Self::Place>,
    ) -> Option<Foot<Self::Place>>;
    /// The wanted edge length at a point of space.
    fn spacing(&self, p: Vector) -> f64;
}

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot<P> {
    /// The point.
    pub point: Vector,
    /// The surface's unit normal there.
    pub normal: Vector,
    /// Where the next search may start.
    pub place: P,
}

/// What may happen to a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rank {
    /// Nothing.
    Fixed,
    /// It may vanish along the feature curve it lies on; it never moves.
    Removable,
    /// It may move and vanish.
    Free,
}

/// A triangulation on a surface. Constrained edges and borders are feature curves; the tag of a
/// triangle is the smooth part of the surface it lies on.
pub struct Skin<'a, G: Ground> {
    /// The surface.
    pub ground: &'a G,
    /// Topology.
    pub mesh: Triangulation,
    /// Positions.
    pub points: Vec<Vector>,
    /// What may happen to each vertex.
    pub ranks: Vec<Rank>,
    /// Wanted edge length at each vertex.
    spacing: Vec<f64>,
    places: Vec<Option<G::Place>>,
    /// A half-edge out of each vertex; stale for vertices that have vanished.
    out: Vec<HalfEdgeId>,
    gone: Vec<bool>,
    /// Vertices around which something has changed since they were last polished in vain.
    awake: Vec<bool>,
}

impl<'a, G: Ground> Skin<'a, G> {
    /// A skin of a triangulation in which every point is a vertex.
    ///
    /// # Panics
    /// When a point is in no triangle.
    pub fn new(ground: &'a G, mesh: Triangulation, points: Vec<Vector>, ranks: Vec<Rank>) -> Self {
        let out = mesh.outgoing(points.len());
        let out = out.into_iter().map(|e| e.expect("every point is in a triangle")).collect();
        let spacing = points.iter().map(|&p| ground.spacing(p)).collect();
        let (places, gone) = (vec![None; points.len()], vec![false; points.len()]);
        let awake = vec![true; points.len()];
        Self { ground, mesh, points, ranks, spacing, places, out, gone, awake }
    }

    /// Where the search for the foot of a vertex may start.
    pub fn set_place(&mut self, v: VertexId, place: G::Place) {
        self.places[v.index()] = Some(place);
    }

    /// Whether the vertex is still there.
    #[must_use]
    pub fn is_there(&self, v: usize) -> bool {
        !self.gone[v]
    }

    /// A half-edge out of a vertex.
    #[must_use]
    pub fn out(&self, v: VertexId) -> HalfEdgeId {
        self.out[v.index()]
    }

    pub(crate) fn at(&self, v: VertexId) -> Vector {
        self.points[v.index()]
    }

    fn corners(&self, t: TriangleId) -> [Vector; 3] {
        self.mesh.corners(t).map(|v| self.at(v))
    }

    /// Twice the area vector.
    fn normal(&self, t: TriangleId) -> Vector {
        let [a, b, c] = self.corners(t);
        cross(sub(b, a), sub(c, a))
    }

    /// The mean of the normals around a vertex.
    fn normal_at(&self, v: VertexId) -> Vector {
        let star = self.mesh.star(self.out(v)).map(HalfEdgeId::triangle);
        let sum = star.fold([0.0; 3], |sum, t| add(sum, self.normal(t)));
        unit(sum).unwrap_or([0.0, 0.0, 1.0])
    }

    fn length(&self, e: HalfEdgeId) -> f64 {
        distance(self.at(self.mesh.origin(e)), self.at(self.mesh.dest(e)))
    }

    /// Length of an edge over the length wanted there.
    fn ratio(&self, e: HalfEdgeId) -> f64 {
        let [a, b] = [self.mesh.origin(e), self.mesh.dest(e)].map(|v| self.spacing[v.index()]);
        self.length(e) / (0.5 * (a + b))
    }

    /// Whether two vertices are joined.
    fn is_edge(&self, a: VertexId, b: VertexId) -> bool {
        self.mesh.star(self.out(a)).any(|e| self.mesh.dest(e) == b || self.mesh.apex(e) == b)
    }

    /// Number of neighbours, and whether the vertex is on the border.
    fn valence(&self, v: VertexId) -> (usize, bool) {
        let mut count = 0;
        let mut on_border = false;
        for e in self.mesh.star(self.out(v)) {
            count += 1;
            on_border |= self.mesh.twin(e).is_none();
        }
        (count + usize::from(on_border), on_border)
    }

    fn anchor_triangle(&mut self, t: TriangleId) {
        for e in t.half_edges() {
            self.out[self.mesh.origin(e).index()] = e;
            self.awake[self.mesh.origin(e).index()] = true;
        }
    }

    /// Adds a vertex that is in no triangle yet.
    fn add_vertex(&mut self, at: Vector, rank: Rank, place: Option<G::Place>) -> VertexId {
        self.points.push(at);
        self.ranks.push(rank);
        self.spacing.push(self.ground.spacing(at));
        self.places.push(place);
        self.out.push(HalfEdgeId(0));
        self.gone.push(false);
        self.awake.push(true);
        VertexId(self.points.len() as u32 - 1)
    }

    /// Splits an edge by a new vertex at `at`, which lies on the edge or near it.
    pub fn split(&mut self, e: HalfEdgeId, at: Vector, rank: Rank) -> VertexId {
        self.split_with(e, at, rank, None)
    }

    fn split_with(
        &mut self,
        e: HalfEdgeId,
        at: Vector,
        rank: Rank,
        place: Option<G::Place>,
    ) -> VertexId {
        let v = self.add_vertex(at, rank, place);
        for outer in self.mesh.split_edge(e, v) {
            self.anchor_triangle(outer.triangle());
        }
        v
    }

    /// Splits a free edge at the foot of its middle, if nothing turns over by that.
    fn split_middle(&mut self, e: HalfEdgeId) -> bool {
        let (a, b) = (self.mesh.origin(e), self.mesh.dest(e));
        let middle = scale(0.5, add(self.at(a), self.at(b)));
        let t = e.triangle();
        let mut facing = self.normal(t);
        if let Some(f) = self.mesh.twin(e) {
            facing = add(facing, self.normal(f.triangle()));
        }
        let Some(facing) = unit(facing) else { return false };
        let from = self.places[a.index()].or(self.places[b.index()]);
        let foot = self.ground.foot(middle, self.mesh.tag(t), facing, from);
        let Some(Foot { point, place, .. }) = foot else { return false };
        if distance(point, middle) > 0.5 * self.length(e) {
            return false;
        }
        let sides = [Some(e), self.mesh.twin(e)];
        let stays = sides.into_iter().flatten().all(|h| {
            let (a, b, c) = (self.mesh.origin(h), self.mesh.dest(h), self.mesh.apex(h));
            let [a, b, c] = [a, b, c].map(|v| self.at(v));
            is_kept([a, point, c], facing) && is_kept([point, b, c], facing)
        });
        if stays {
            self.split_with(e, point, Rank::Free, Some(place));
        }
        stays
    }

    /// Whether an edge may be flipped without a double edge or a triangle turned over.
    fn can_flip(&self, e: HalfEdgeId) -> bool {
        let Some(f) = self.mesh.twin(e).filter(|_| !self.mesh.is_constrained(e)) else {
            return false;
        };
        let [a, b] = [self.mesh.origin(e), self.mesh.dest(e)];
        let [c, d] = [self.mesh.apex(e), self.mesh.apex(f)];
        let facing = add(self.normal(e.triangle()), self.normal(f.triangle()));
        let [pa, pb, pc, pd] = [a, b, c, d].map(|v| self.at(v));
        let thin = |v: VertexId| self.valence(v).0 <= 3;
        is_kept([pd, pc, pa], facing)
            && is_kept([pc, pd, pb], facing)
            && !self.is_edge(c, d)
            && !thin(a)
            && !thin(b)
    }

    fn flip(&mut self, e: HalfEdgeId) {
        let e = self.mesh.flip(e);
        let f = self.mesh.twin(e).expect("a flipped edge has two sides");
        self.anchor_triangle(e.triangle());
        self.anchor_triangle(f.triangle());
    }

    /// The worse shape of the triangles of an edge before and after a flip.
    fn flip_shapes(&self, e: HalfEdgeId) -> Option<[f64; 2]> {
        let f = self.mesh.twin(e)?;
        let [a, b] = [self.mesh.origin(e), self.mesh.dest(e)].map(|v| self.at(v));
        let [c, d] = [self.mesh.apex(e), self.mesh.apex(f)].map(|v| self.at(v));
        let before = shape([a, b, c]).min(shape([b, a, d]));
        Some([before, shape([d, c, a]).min(shape([c, d, b]))])
    }

    /// The live half-edges, one a side of an edge, in slot order; each edge once.
    fn edges(&self) -> Vec<HalfEdgeId> {
        let all = self.mesh.triangles().flat_map(TriangleId::half_edges);
        all.filter(|&e| self.mesh.twin(e).is_none_or(|f| e.0 < f.0)).collect()
    }

    /// Whether a half-edge found earlier still joins the same vertices.
    fn is_still(&self, e: HalfEdgeId, ends: [VertexId; 2]) -> bool {
        self.mesh.is_live(e.triangle()) && [self.mesh.origin(e), self.mesh.dest(e)] == ends
    }

    /// Live vertices and triangles with their tags: the points that are there, renumbered in order.
    #[must_use]
    pub fn collect(&self) -> Collected {
        let mut number = vec![u32::MAX; self.points.len()];
        let mut collected = Collected::default();
        for (v, &point) in self.points.iter().enumerate().filter(|(v, _)| self.is_there(*v)) {
            number[v] = collected.points.len() as u32;
            collected.points.push(point);
            collected.origin.push(v as u32);
        }
        for t in self.mesh.triangles() {
            collected.triangles.push(self.mesh.corners(t).map(|v| number[v.index()]));
            collected.tags.push(self.mesh.tag(t));
            for e in t.half_edges().into_iter().filter(|&e| self.mesh.is_constrained(e)) {
                let twin = self.mesh.twin(e);
                if twin.is_none_or(|f| e.0 < f.0) {
                    let ends = [self.mesh.origin(e), self.mesh.dest(e)];
                    collected.features.push(ends.map(|v| number[v.index()]));
                }
            }
        }
        collected
    }
}

/// A skin as plain arrays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Collected {
    /// Points.
    pub points: Vec<Vector>,
    /// Index of each point in the skin.
    pub origin: Vec<u32>,
    /// Triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Smooth part of each triangle.
    pub tags: Vec<u32>,
    /// Feature edges and borders.
    pub features: Vec<[u32; 2]>,
}
