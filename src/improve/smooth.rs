//! Smoothing: each movable vertex takes a step towards the place where its triangles are best.

use super::energy::better_place;
use super::flip::{flip_suspects, flip_to_delaunay};
use crate::point::Point2;
use crate::triangulation::{HalfEdgeId, TriangleId, Triangulation, VertexId};

/// No half-edge.
pub(crate) const NOWHERE: HalfEdgeId = HalfEdgeId(u32::MAX);

/// Steps shorter than this fraction of the distance to the first neighbour are not worth a move.
const STEP_MIN: f64 = 1e-3;
/// The same while a change is on trial, when it only has to be told from others.
const STEP_MIN_TRIAL: f64 = 2e-2;

/// The mesh under improvement.
pub(super) struct Sheet<'a> {
    pub(super) mesh: &'a mut Triangulation,
    pub(super) points: &'a mut [Point2],
    /// Vertices below this index never move.
    pub(super) fixed: usize,
    /// New coordinates are multiples of this power of two.
    pub(super) quantum: Option<f64>,
}

/// Which vertices and edges of a sheet are worth another look.
#[derive(Default)]
pub(super) struct Smoother {
    /// A half-edge out of each vertex, or [`NOWHERE`].
    pub(super) outgoing: Vec<HalfEdgeId>,
    /// Vertices whose star has changed since they were last looked at.
    active: Vec<bool>,
    /// All triangles are suspects, which need not be listed then.
    all_suspect: bool,
    /// Triangles whose edges may be not Delaunay any more.
    suspects: Vec<TriangleId>,
    /// For each triangle whether it is a suspect.
    suspected: Vec<bool>,
    /// Scratch space of [`flip`](Self::flip).
    edges: Vec<HalfEdgeId>,
    /// Least step of a move over the distance to a neighbour.
    step_min: f64,
    link: Vec<Point2>,
    link_vertices: Vec<VertexId>,
}

impl Smoother {
    /// For a mesh of so many vertices, all of them active, and all edges suspect.
    pub(super) fn new(mesh: &Triangulation, vertices: usize) -> Self {
        let (active, suspected) = (vec![true; vertices], vec![false; mesh.slot_count()]);
        let (step_min, all_suspect) = (STEP_MIN, true);
        let mut smoother = Self { active, suspected, step_min, all_suspect, ..Self::default() };
        smoother.find_outgoing(mesh, vertices);
        smoother
    }

    /// For a mesh with a half-edge out of each vertex; triangles at active vertices are suspect.
    pub(super) fn from_parts(
        mesh: &Triangulation,
        outgoing: Vec<HalfEdgeId>,
        active: Vec<bool>,
    ) -> Self {
        let suspected = vec![false; mesh.slot_count()];
        let step_min = STEP_MIN;
        let mut smoother = Self { outgoing, active, suspected, step_min, ..Self::default() };
        for t in mesh.triangles() {
            if mesh.corners(t).iter().any(|v| smoother.active[v.index()]) {
                smoother.suspect(t);
            }
        }
        smoother
    }

    /// For a mesh of so many vertices, none of them active.
    pub(super) fn at_rest(&mut self, mesh: &Triangulation, vertices: usize) {
        self.active.clear();
        self.active.resize(vertices, false);
        self.suspects.clear();
        self.suspected.clear();
        self.suspected.resize(mesh.slot_count(), false);
        self.step_min = STEP_MIN_TRIAL;
        self.find_outgoing(mesh, vertices);
    }

    /// A half-edge out of each vertex, and nothing else of it is kept.
    pub(super) fn into_outgoing(self) -> Vec<HalfEdgeId> {
        self.outgoing
    }

    /// Takes over what another one knows, reusing its own memory.
    pub(super) fn assign(&mut self, other: &Self) {
        self.outgoing.clone_from(&other.outgoing);
        self.active.clone_from(&other.active);
        self.suspects.clone_from(&other.suspects);
        self.suspected.clone_from(&other.suspected);
        self.step_min = other.step_min;
    }

    /// A new vertex in no triangle.
    pub(super) fn push(&mut self) {
        self.outgoing.push(NOWHERE);
        self.active.push(true);
    }

    /// A triangle that is new: its corners become active, its edges suspect.
    pub(super) fn touch(&mut self, mesh: &Triangulation, t: TriangleId) {
        for e in t.half_edges() {
            let v = mesh.origin(e).index();
            self.outgoing[v] = e;
            self.active[v] = true;
        }
        self.suspect(t);
    }

    fn suspect(&mut self, t: TriangleId) {
        if t.index() >= self.suspected.len() {
            self.suspected.resize(t.index() + 1, false);
        }
        if !std::mem::replace(&mut self.suspected[t.index()], true) {
            self.suspects.push(t);
        }
    }

    fn find_outgoing(&mut self, mesh: &Triangulation, vertices: usize) {
        find_outgoing(mesh, vertices, &mut self.outgoing);
    }

    /// One sweep over the active vertices in index order; returns the number of moves. Edges that
    /// a move makes suspect wait for [`flip`](Self::flip).
    ///
    /// A vertex moves only if every triangle around it stays strictly counterclockwise (exact), the
    /// energy falls, and the worst of its triangles does not get worse.
    pub(super) fn sweep(&mut self, sheet: &mut Sheet<'_>) -> u64 {
        let mut moves = 0;
        for v in sheet.fixed..sheet.points.len() {
            if !std::mem::take(&mut self.active[v]) {
                continue;
            }
            let start = self.outgoing[v];
            if start == NOWHERE || !self.gather_link(sheet, start) {
                continue;
            }
            if let Some(place) =
                better_place(sheet.points[v], &self.link, sheet.quantum, self.step_min)
            {
                sheet.points[v] = place;
                moves += 1;
                self.active[v] = true;
                for &u in &self.link_vertices {
                    self.active[u.index()] = true;
                }
                if !self.all_suspect {
                    self.suspect_star(sheet.mesh, start);
                }
            }
        }
        moves
    }

    /// Looks again at the corners of some triangles, and at nothing else.
    pub(super) fn wake_where(&mut self, sheet: &Sheet<'_>, wakes: impl Fn([Point2; 3]) -> bool) {
        self.active.fill(false);
        for t in sheet.mesh.triangles() {
            let corners = sheet.mesh.corners(t);
            if wakes(corners.map(|v| sheet.points[v.index()])) {
                corners.into_iter().for_each(|v| self.active[v.index()] = true);
            }
        }
    }

    /// A half-edge out of a vertex that is in a triangle and active, which it is no more.
    pub(super) fn take_active(&mut self, v: usize) -> Option<HalfEdgeId> {
        let is_active = std::mem::take(&mut self.active[v]);
        Some(self.outgoing[v]).filter(|&start| is_active && start != NOWHERE)
    }

    /// Looks again at the origin of a half-edge, the vertices around it and the edges of its star.
    pub(super) fn wake_star(&mut self, mesh: &Triangulation, start: HalfEdgeId) {
        self.active[mesh.origin(start).index()] = true;
        for e in mesh.star(start) {
            self.active[mesh.dest(e).index()] = true;
        }
        self.suspect_star(mesh, start);
    }

    /// All edges of the mesh are flipped to Delaunay: for the first time, when all are suspect.
    pub(super) fn flip_all(&mut self, sheet: &mut Sheet<'_>) -> u64 {
        self.all_suspect = false;
        let flips = flip_to_delaunay(sheet.mesh, sheet.points);
        if flips > 0 {
            self.find_outgoing(sheet.mesh, sheet.points.len());
        }
        flips
    }

    /// Flips the edges of suspect triangles to Delaunay.
    pub(super) fn flip(&mut self, sheet: &mut Sheet<'_>) -> u64 {
        let Sheet { mesh, points, .. } = sheet;
        self.edges.clear();
        for &t in self.suspects.iter().filter(|&&t| mesh.is_live(t)) {
            // An edge between two suspects once, from the side with the smaller half-edge.
            self.edges.extend(t.half_edges().into_iter().filter(|&e| {
                mesh.twin(e).is_some_and(|f| e < f || !self.suspected[f.triangle().index()])
            }));
        }
        self.forget_suspects();
        let (outgoing, active) = (&mut self.outgoing, &mut self.active);
        flip_suspects(mesh, points, &mut self.edges, |mesh, e| {
            let f = mesh.twin(e).expect("a flipped edge has two sides");
            for g in [e, e.next(), e.prev(), f.prev()] {
                let v = mesh.origin(g).index();
                outgoing[v] = g;
                active[v] = true;
            }
        })
    }

    fn forget_suspects(&mut self) {
        for t in self.suspects.drain(..) {
            self.suspected[t.index()] = false;
        }
    }

    fn suspect_star(&mut self, mesh: &Triangulation, start: HalfEdgeId) {
        let mut e = start;
        loop {
            self.suspect(e.triangle());
            match mesh.rotate_ccw(e) {
                Some(next) if next != start => e = next,
                _ => return,
            }
        }
    }

    /// Fills `link` with the polygon around the origin of `start`; `false` on the border.
    fn gather_link(&mut self, sheet: &Sheet<'_>, start: HalfEdgeId) -> bool {
        self.link.clear();
        self.link_vertices.clear();
        let mut e = start;
        loop {
            let u = sheet.mesh.dest(e);
            self.link_vertices.push(u);
            self.link.push(sheet.points[u.index()]);
            match sheet.mesh.rotate_ccw(e) {
                None => return false,
                Some(next) if next == start => return true,
                Some(next) => e = next,
            }
        }
    }
}

/// A half-edge out of each vertex, [`NOWHERE`] for one in no triangle.
fn find_outgoing(mesh: &Triangulation, vertices: usize, outgoing: &mut Vec<HalfEdgeId>) {
    outgoing.clear();
    outgoing.resize(vertices, NOWHERE);
    for e in mesh.triangles().flat_map(TriangleId::half_edges) {
        outgoing[mesh.origin(e).index()] = e;
    }
}
