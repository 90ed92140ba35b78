//! Removal of defects on a surface: the search of SPEC 8 for better topologies, made in the plane that
//! touches the surface; what it finds is brought back to the surface and judged there.

use super::chart::{Frame, Lift, SurfaceChart};
use super::flip::shape;
use crate::front::chart::Site;
use crate::improve::{
    Attempt, Books, Effort, GAIN_MIN, ImproveOptions, NOWHERE, Origin, Patch, Search, Searched,
    Searcher, Worth,
};
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation, VertexId};
use crate::vector::distance;

/// What a vertex has.
const REGULAR: u32 = 6;
/// A regular vertex with a triangle worse than this (inverse mean ratio) is tried too.
const BAD: f64 = 1.1;
/// A mesh in (u, v) with what lies above it.
pub(super) struct Cloth<'a> {
    pub(super) mesh: &'a mut Triangulation,
    pub(super) points: &'a mut Vec<Point2>,
    pub(super) lifts: &'a mut Vec<Lift>,
}

/// Searches for better topologies at the irregular vertices of a patch.
pub(super) struct Defects<'a> {
    chart: &'a SurfaceChart<'a>,
    /// Vertices below this index never move.
    fixed: usize,
    effort: Effort,
    /// No more changes are tried than these: with and without bad triangles around.
    budgets: [u64; 2],
    pub(super) books: Books,
}

/// A patch in the plane and its vertices on the surface.
type Raised = (Patch, Vec<Site<Lift>>);

/// A mesh, and how it is searched.
struct Spread<'a, 'b> {
    chart: &'a SurfaceChart<'a>,
    fixed: usize,
    effort: Effort,
    cloth: &'a mut Cloth<'b>,
}

/// The mesh as it is looked at.
#[derive(Clone, Copy)]
struct View<'a> {
    chart: &'a SurfaceChart<'a>,
    search: Search<'a>,
    points: &'a [Point2],
    lifts: &'a [Lift],
}

impl<'a> Defects<'a> {
    pub(super) fn new(
        chart: &'a SurfaceChart<'a>,
        cloth: &Cloth<'_>,
        fixed: usize,
        options: ImproveOptions,
    ) -> Self {
        let mut outgoing = vec![NOWHERE; cloth.points.len()];
        for e in cloth.mesh.triangles().flat_map(TriangleId::half_edges) {
            outgoing[cloth.mesh.origin(e).index()] = e;
        }
        Self {
            chart,
            fixed,
            effort: Effort { rings: options.rings, depth: options.depth, breadth: options.breadth },
            budgets: budgets(cloth.mesh.live_count() as u64, options.tries_max),
            books: Books::new(outgoing),
        }
    }

    /// One pass over the irregular vertices and those with bad triangles, worst first; whether another
    /// one may find more: the budgets are not spent, and something has changed.
    pub(super) fn pass(&mut self, cloth: &mut Cloth<'_>) -> bool {
        let before = self.books.changes;
        let list = self.worst_first(cloth);
        let Self { chart, fixed, effort, budgets, .. } = *self;
        let mut spread = Spread { chart, fixed, effort, cloth };
        let is_within =
            self.books.pass(&mut spread, &list, |worst| budgets[usize::from(worst > BAD)]);
        is_within && self.books.changes > before
    }

    /// Active vertices worth trying with the worst triangle around them, worst first, then by index.
    fn worst_first(&self, cloth: &Cloth<'_>) -> Vec<(f64, VertexId)> {
        let mut around = vec![(0_u32, 1.0_f64); cloth.points.len()];
        for t in cloth.mesh.triangles() {
            let corners = cloth.mesh.corners(t).map(|v| v.index());
            let ratio = inverse(corners.map(|v| &cloth.lifts[v]));
            for v in corners {
                around[v] = (around[v].0 + 1, around[v].1.max(ratio));
            }
        }
        let defect = |v: usize| {
            let (degree, worst) = around[v];
            let is_one = degree > 0 && (degree != REGULAR || worst > BAD);
            (self.books.active[v] && is_one).then_some((worst, VertexId(v as u32)))
        };
        let mut found: Vec<_> = (self.fixed..cloth.points.len()).filter_map(defect).collect();
        found.sort_by(|s, t| t.0.total_cmp(&s.0).then(s.1.cmp(&t.1)));
        found
    }
}

impl Searched for Spread<'_, '_> {
    type Better = Raised;

    fn search(
        &self,
        outgoing: &[HalfEdgeId],
        searcher: &mut Searcher,
        v: VertexId,
    ) -> Attempt<Raised> {
        let Cloth { mesh, points, lifts } = &*self.cloth;
        let (fixed, effort) = (self.fixed, self.effort);
        let search = Search { mesh, outgoing, fixed, quantum: None, effort };
        View { chart: self.chart, search, points, lifts }.look(searcher, v)
    }

    fn replace(
        &mut self,
        (patch, sites): &Raised,
        origin: &mut Origin,
        touched: impl FnMut(&Triangulation, HalfEdgeId),
    ) {
        let Cloth { mesh, points, lifts } = &mut *self.cloth;
        let mut rest = sites.iter();
        for (&v, site) in origin.vertices.iter().zip(rest.by_ref()) {
            points[v.index()] = site.at;
            lifts[v.index()] = site.lift;
        }
        let push = |_: Point2| {
            let site = rest.next().expect("a place for each vertex of the patch");
            points.push(site.at);
            lifts.push(site.lift);
            VertexId(points.len() as u32 - 1)
        };
        origin.replace(mesh, patch, push, touched);
    }

    fn vertex_count(&self) -> usize {
        self.cloth.points.len()
    }
}

/// How many changes are tried in a mesh of so many triangles: around vertices that are only irregular,
/// and around those with bad triangles too.
///
/// A try costs as much as some five triangles. A large mesh has many irregular vertices with nearly
/// equilateral triangles around them, and is hardly better without them.
fn budgets(triangles: u64, most: u64) -> [u64; 2] {
    let irregular = 4000_u64.saturating_sub(triangles) + triangles / 200;
    [irregular, irregular + 1000 + triangles / 5].map(|budget| budget.min(most))
}

impl View<'_> {
    /// Searches around a vertex; a success in the plane counts if it is one on the surface.
    fn look(&self, searcher: &mut Searcher, v: VertexId) -> Attempt<Raised> {
        let Some(frame) = self.frame(v) else { return Attempt::default() };
        let place = |w: VertexId| frame.local_of(self.lifts[w.index()].point);
        let Attempt { tried, origin, better } = searcher.search_at(self.search, v, place);
        let raised = better.and_then(|patch| {
            let sites = self.raise(&frame, &patch, &origin)?;
            Some((patch, sites))
        });
        Attempt { tried, origin, better: raised }
    }

    /// The plane that touches the surface at a vertex.
    fn frame(&self, v: VertexId) -> Option<Frame> {
        let e = self.search.outgoing[v.index()];
        if e == NOWHERE {
            return None;
        }
        let [here, there] = [v, self.search.mesh.dest(e)].map(|v| self.lifts[v.index()].point);
        self.chart.frame_at(self.points[v.index()], distance(here, there))
    }

    fn site(&self, v: VertexId) -> Site<Lift> {
        Site { at: self.points[v.index()], lift: self.lifts[v.index()] }
    }

    /// The vertices of a patch on the surface, if it is valid in (u, v), exactly, and better in space.
    fn raise(&self, frame: &Frame, patch: &Patch, origin: &Origin) -> Option<Vec<Site<Lift>>> {
        let mut sites: Vec<Site<Lift>> = origin.vertices.iter().map(|&v| self.site(v)).collect();
        let old = sites.len();
        for (i, &local) in patch.points.iter().enumerate().skip(patch.fixed) {
            let start = if i < old { sites[i].at } else { frame.guess(local) };
            let site = self.chart.place_from(frame, local, start)?;
            if i < old { sites[i] = site } else { sites.push(site) }
        }
        let mesh = self.search.mesh;
        let mut now = Worth::NONE;
        for &t in &origin.triangles {
            now.add(inverse(mesh.corners(t).map(|v| &self.lifts[v.index()])));
        }
        let mut then = Worth::NONE;
        for t in patch.mesh.triangles() {
            let corners = patch.mesh.corners(t).map(|v| &sites[v.index()]);
            let [a, b, c] = corners.map(|site| site.at);
            if orient2d(a, b, c) != Sign::Positive {
                return None;
            }
            then.add(inverse(corners.map(|site| &site.lift)));
        }
        let is_better = then.excess < now.excess - GAIN_MIN && then.worst <= now.worst;
        is_better.then_some(sites)
    }
}

/// The inverse mean ratio of a triangle in space: 1 when equilateral, infinite when it faces away.
fn inverse(corners: [&Lift; 3]) -> f64 {
    let ratio = shape(corners);
    if ratio > 0.0 { 1.0 / ratio } else { f64::INFINITY }
}
