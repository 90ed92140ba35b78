//! The background mesh: the constrained Delaunay triangulation of a domain's boundary, with every
//! triangle known to be inside or outside, and the open region the front starts from.

use crate::delaunay::{Cdt, CdtError, cdt};
use crate::domain::Region;
use crate::domain::validate::{Plc, PlcInside};
use crate::point::Point2;
use crate::triangulation::locate::Location;
use crate::triangulation::{Across, HalfEdgeId, TriangleId, Triangulation, VertexId};

/// Tag of a triangle outside the domain, and of every ghost.
pub const OUTSIDE: u32 = 0;
/// Tag of a triangle inside the domain but in no region; `INSIDE + 1 + i` is region `i`.
pub const INSIDE: u32 = 1;

/// An edge of the domain's boundary or an interior constraint, as the front meets it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrontEdge {
    /// Half-edge of the triangle on its left, which is inside the domain.
    pub half_edge: HalfEdgeId,
    /// From where to where.
    pub vertices: [VertexId; 2],
    /// Index into the segments of the domain.
    pub segment: u32,
    /// The segment's marker.
    pub marker: i32,
    /// Whether the domain lies on both sides: then the other side is a front edge of its own.
    pub interior: bool,
}

/// Constrained Delaunay triangulation of a validated domain.
#[derive(Clone)]
pub struct Background {
    /// The domain's points, in its order.
    pub points: Vec<Point2>,
    /// All of the hull, with ghosts; segments constrained; tags say inside, outside and region.
    pub triangulation: Triangulation,
    /// For each point a half-edge out of it.
    pub outgoing: Vec<Option<HalfEdgeId>>,
    /// Boundary edges with the domain on their left, in the order of the segments; then both sides
    /// of the interior constraints.
    pub edges: Vec<FrontEdge>,
    /// How many of `edges` are boundary.
    pub boundary_count: usize,
    /// Marker of each region; triangle tags count from them.
    pub regions: Vec<Region>,
}

/// Which list of a domain a seed stands in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeedKind {
    /// A hole of a `.poly` file.
    Hole,
    /// A region seed.
    Region,
}

impl std::fmt::Display for SeedKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Hole => "hole",
            Self::Region => "region",
        })
    }
}

/// Why a domain has no background mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BackgroundError {
    /// The points and segments are not sound.
    #[error(transparent)]
    Cdt(#[from] CdtError),
    /// A seed lies on a segment, so it names no face.
    #[error("{kind} seed {index} at {seed} lies on segment {segment}")]
    SeedOnSegment {
        /// Hole or region.
        kind: SeedKind,
        /// Index among its kind.
        index: usize,
        /// Where it is.
        seed: Point2,
        /// A segment it lies on.
        segment: u32,
    },
    /// A seed lies outside the domain, or a hole's seed where the outside reaches anyhow.
    #[error("{kind} seed {index} at {seed} lies outside the domain")]
    SeedOutside {
        /// Hole or region.
        kind: SeedKind,
        /// Index among its kind.
        index: usize,
        /// Where it is.
        seed: Point2,
    },
    /// Two region seeds lie in one region with different markers.
    #[error("region seeds {first} and {second} at {seed} lie in the same region")]
    RegionTwice {
        /// Index of the first seed.
        first: usize,
        /// Index of the second seed.
        second: usize,
        /// Where the second is.
        seed: Point2,
    },
    /// More regions than a triangle's tag can tell apart.
    #[error("{0} region seeds are more than the 268435453 a triangle's tag can tell apart")]
    TooManyRegions(usize),
    /// No triangle is inside.
    #[error("the domain is empty: no triangle of its boundary lies inside")]
    Empty,
}

impl Background {
    /// Triangulates the domain and tags its triangles.
    ///
    /// # Errors
    /// See [`BackgroundError`]; for a `Plc` made by validation the points and segments are sound.
    pub fn new(plc: &Plc) -> Result<Self, BackgroundError> {
        let ends: Vec<[u32; 2]> = plc.segments.iter().map(|s| s.vertices).collect();
        Self::of(plc, cdt(&plc.points, &ends)?)
    }

    /// Tags the triangles of the constrained Delaunay triangulation of the domain's points and
    /// segments.
    ///
    /// # Errors
    /// See [`BackgroundError`]; those of seeds, and a domain with nothing inside.
    pub fn of(plc: &Plc, cdt: Cdt) -> Result<Self, BackgroundError> {
        if plc.regions.len() >= (1 << 28) - 2 {
            return Err(BackgroundError::TooManyRegions(plc.regions.len()));
        }
        let Cdt { mut triangulation, outgoing, segments } = cdt;
        let mut faces = Faces { plc, segments: &segments, triangulation: &mut triangulation };
        match &plc.inside {
            PlcInside::EvenOdd => faces.flood_even_odd(),
            PlcInside::Carve(holes) => faces.carve(holes)?,
        }
        faces.tag_regions()?;
        let (edges, boundary_count) = faces.front_edges();
        if boundary_count == 0 {
            return Err(BackgroundError::Empty);
        }
        let (points, regions) = (plc.points.clone(), plc.regions.clone());
        Ok(Self { points, triangulation, outgoing, edges, boundary_count, regions })
    }

    /// Whether a triangle lies inside the domain.
    #[must_use]
    pub fn is_inside(&self, t: TriangleId) -> bool {
        self.triangulation.tag(t) != OUTSIDE
    }

    /// Marker of the region an inside triangle lies in, if a seed named it.
    #[must_use]
    pub fn region(&self, t: TriangleId) -> Option<&Region> {
        let tag = self.triangulation.tag(t);
        self.regions.get(tag.checked_sub(INSIDE + 1)? as usize)
    }

    /// Marker of the region that a triangle's tag names; 0 where no seed named it.
    #[must_use]
    pub fn region_of_tag(&self, tag: u32) -> i32 {
        let region = tag.checked_sub(INSIDE + 1).and_then(|i| self.regions.get(i as usize));
        region.map_or(0, |region| region.marker)
    }

    /// The inside triangles alone, in compact slots, with the domain's vertices and tags: the
    /// starting state of the front. No ghosts; every boundary edge and both sides of every interior
    /// constraint is `Across::Border(i)` with `i` the index into the list returned beside it, which
    /// is [`edges`](Self::edges) with the half-edges of this triangulation.
    #[must_use]
    pub fn open_region(&self) -> (Triangulation, Vec<FrontEdge>) {
        let from = &self.triangulation;
        let mut open = Triangulation::with_capacity(from.live_count());
        let mut copy = vec![None; from.slot_count()];
        for t in from.triangles().filter(|&t| self.is_inside(t)) {
            let new = open.add(from.corners(t));
            open.set_tag(new, from.tag(t));
            copy[t.index()] = Some(new);
        }
        let image = |e: HalfEdgeId| {
            copy[e.triangle().index()].map(|t: TriangleId| t.half_edge(e.corner() as u32))
        };
        for e in from.triangles().flat_map(TriangleId::half_edges) {
            let (Some(new), Across::Twin(f)) = (image(e), from.across(e)) else { continue };
            if let Some(twin) = image(f).filter(|_| !from.is_constrained(e)) {
                open.link(new, twin);
            }
        }
        let mut edges = self.edges.clone();
        for (edge, i) in edges.iter_mut().zip(0..) {
            edge.half_edge = image(edge.half_edge).expect("left of a front edge is inside");
            open.set_border(edge.half_edge, i);
        }
        (open, edges)
    }
}

/// The faces of the domain while they are being told apart.
struct Faces<'a> {
    plc: &'a Plc,
    segments: &'a [HalfEdgeId],
    triangulation: &'a mut Triangulation,
}

impl Faces<'_> {
    /// Tags triangles inside that lie across an odd number of loop segments from infinity.
    fn flood_even_odd(&mut self) {
        // The scratch mark says seen; parity is the tag.
        let mut switches = vec![0_u8; self.triangulation.slot_count()];
        for (segment, &e) in self.plc.segments.iter().zip(self.segments) {
            for h in [Some(e), self.triangulation.twin(e)].into_iter().flatten() {
                switches[h.triangle().index()] |= u8::from(segment.in_loop) << h.corner();
            }
        }
        let mut todo = Vec::from_iter(self.a_ghost());
        for &t in &todo {
            self.triangulation.set_mark(t, 1);
        }
        while let Some(t) = todo.pop() {
            for e in t.half_edges() {
                let Some(u) = self.triangulation.twin(e).map(HalfEdgeId::triangle) else {
                    continue;
                };
                if self.triangulation.mark(u) == 0 {
                    let switch = u32::from(switches[t.index()] >> e.corner() & 1);
                    self.triangulation.set_tag(u, self.triangulation.tag(t) ^ switch);
                    self.triangulation.set_mark(u, 1);
                    todo.push(u);
                }
            }
        }
        self.clear_marks();
    }

    /// Tags everything inside, then floods the outside from infinity and from the hole seeds.
    fn carve(&mut self, holes: &[Point2]) -> Result<(), BackgroundError> {
        let all: Vec<TriangleId> = self.triangulation.triangles().collect();
        for &t in &all {
            self.triangulation.set_tag(t, INSIDE);
        }
        if let Some(ghost) = self.a_ghost() {
            self.flood(ghost, OUTSIDE);
        }
        let mut seeds = Vec::with_capacity(holes.len());
        for (index, &seed) in holes.iter().enumerate() {
            seeds.push(self.find_seed(SeedKind::Hole, index, seed)?);
        }
        for t in seeds {
            if self.triangulation.tag(t) != OUTSIDE {
                self.flood(t, OUTSIDE);
            }
        }
        Ok(())
    }

    fn tag_regions(&mut self) -> Result<(), BackgroundError> {
        for (index, region) in self.plc.regions.iter().enumerate() {
            let t = self.find_seed(SeedKind::Region, index, region.seed)?;
            match self.triangulation.tag(t) {
                INSIDE => self.flood(t, INSIDE + 1 + index as u32),
                tag => {
                    let first = (tag - INSIDE - 1) as usize;
                    if self.plc.regions[first].marker != region.marker {
                        let seed = region.seed;
                        return Err(BackgroundError::RegionTwice { first, second: index, seed });
                    }
                }
            }
        }
        Ok(())
    }

    /// An inside triangle at the seed.
    fn find_seed(
        &self,
        kind: SeedKind,
        index: usize,
        seed: Point2,
    ) -> Result<TriangleId, BackgroundError> {
        let outside = BackgroundError::SeedOutside { kind, index, seed };
        let on_segment = |segment| BackgroundError::SeedOnSegment { kind, index, seed, segment };
        let hint = self.a_ghost().filter(|_| seed.is_finite()).ok_or_else(|| outside.clone())?;
        let triangulation = &*self.triangulation;
        let t = match triangulation.locate(&self.plc.points, seed, hint) {
            Location::Outside(_) => return Err(outside),
            Location::Inside(t) => t,
            Location::OnEdge(e) if triangulation.is_constrained(e) => {
                return Err(on_segment(self.segment_of(e)));
            }
            Location::OnEdge(e) => e.triangle(),
            Location::OnVertex(e) => {
                match triangulation.star(e).find(|&h| triangulation.is_constrained(h)) {
                    Some(h) => return Err(on_segment(self.segment_of(h))),
                    None => e.triangle(),
                }
            }
        };
        if triangulation.tag(t) == OUTSIDE { Err(outside) } else { Ok(t) }
    }

    fn segment_of(&self, e: HalfEdgeId) -> u32 {
        let twin = self.triangulation.twin(e);
        let found = self.segments.iter().position(|&s| s == e || Some(s) == twin);
        found.expect("constrained edges are segments") as u32
    }

    /// Gives `tag` to all triangles reached from `t` without crossing a segment.
    fn flood(&mut self, t: TriangleId, tag: u32) {
        self.triangulation.set_tag(t, tag);
        let mut todo = vec![t];
        while let Some(t) = todo.pop() {
            for e in t.half_edges() {
                let next = self.triangulation.twin(e).map(HalfEdgeId::triangle);
                let open = next.filter(|_| !self.triangulation.is_constrained(e));
                if let Some(u) = open.filter(|&u| self.triangulation.tag(u) != tag) {
                    self.triangulation.set_tag(u, tag);
                    todo.push(u);
                }
            }
        }
    }

    fn a_ghost(&self) -> Option<TriangleId> {
        self.triangulation.triangles().find(|&t| self.triangulation.is_ghost(t))
    }

    fn clear_marks(&mut self) {
        let all: Vec<TriangleId> = self.triangulation.triangles().collect();
        for t in all {
            self.triangulation.set_mark(t, 0);
        }
    }

    /// Boundary edges, then both sides of interior constraints, and how many are boundary.
    /// Segments with the outside on both sides are dropped.
    fn front_edges(&self) -> (Vec<FrontEdge>, usize) {
        let inside = |e: HalfEdgeId| self.triangulation.tag(e.triangle()) != OUTSIDE;
        let (mut boundary, mut interior) = (Vec::new(), Vec::new());
        for ((segment, &e), i) in self.plc.segments.iter().zip(self.segments).zip(0..) {
            let f = self.triangulation.twin(e).expect("ghosts surround the hull");
            let edge = |half_edge, interior| FrontEdge {
                half_edge,
                vertices: [
                    self.triangulation.origin(half_edge),
                    self.triangulation.dest(half_edge),
                ],
                segment: i,
                marker: segment.marker,
                interior,
            };
            match (inside(e), inside(f)) {
                (true, true) => interior.extend([edge(e, true), edge(f, true)]),
                (true, false) => boundary.push(edge(e, false)),
                (false, true) => boundary.push(edge(f, false)),
                (false, false) => {}
            }
        }
        let count = boundary.len();
        boundary.append(&mut interior);
        (boundary, count)
    }
}
