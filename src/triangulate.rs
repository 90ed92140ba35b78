//! Points, or points and segments, to a Delaunay triangulation as plain data: what
//! `trigrade delaunay` hands out.
//!
//! Equal points are merged into the first of them, and [`Triangulated::map`] says what became of
//! each. Without segments the triangulation is that of the points and covers their hull. With
//! segments it is constrained, and either covers the hull too or what the domain's own rule leaves
//! of it.
//!
#![doc = include_str!("../docs/pictures/delaunay.svg")]

use crate::background::{Background, BackgroundError};
use crate::delaunay::hull::convex_hull;
use crate::delaunay::{
    Cdt, CdtError, Engine, PointsError, Split, cdt_with, delaunay, merge_equal, split_at_points,
    split_crossings,
};
use crate::domain::validate::{Fault, Plc, PlcInside, PlcSegment, validate};
use crate::domain::{Domain, Inside, Loop, LoopRole, Segment};
use crate::mesh::{MarkedEdge, Mesh};
use crate::point::Point2;
use crate::triangulation::{GHOST, TriangleId, Triangulation};
use std::collections::BTreeMap;

/// The marker of hull edges that are no segments, as Triangle has it.
pub const HULL_MARKER: i32 = 1;

/// How to triangulate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// The algorithm; with segments [`Engine::Auto`] or [`Engine::DivideConquer`].
    pub engine: Engine,
    /// Whether threads may be used; the answer is the same.
    pub parallel: bool,
    /// Cover the hull of the points, whatever the domain says of inside and outside.
    pub hull: bool,
    /// Cut segments where they cross, at rounded crossings, in place of refusing them.
    pub split_crossings: bool,
    /// Whether [`Triangulated::outline`] is wanted.
    pub outline: bool,
}

/// A Delaunay triangulation as plain data.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangulated {
    /// Different points in the order given, then crossings; triangles from their lowest corner on,
    /// sorted; segments and the edges of the hull with their markers. Without triangles (fewer than
    /// three points, or all on one line) the points are there all the same.
    pub mesh: Mesh,
    /// For each given point its index in `mesh`; `None` for one in no triangle of the domain.
    pub map: Vec<Option<u32>>,
    /// `[dropped, kept]`, indices of given points, for every point equal to an earlier one.
    pub repeated: Vec<[u32; 2]>,
    /// How many points are crossings.
    pub crossings: usize,
    /// What an independent check needs to know: the region to be covered and the segments in it, in
    /// pieces that do not cross. `None` if there are no triangles or it is not wanted.
    pub outline: Option<Domain>,
}

/// Why there is no triangulation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TriangulateError {
    /// The points.
    #[error(transparent)]
    Points(#[from] PointsError),
    /// The segments.
    #[error(transparent)]
    Segments(#[from] CdtError),
    /// A segment joins two equal points.
    #[error("segment {segment} joins points {} and {}, which are equal", .vertices[0], .vertices[1])]
    Degenerate {
        /// Index among the loops' edges and then the free segments.
        segment: u32,
        /// Its points.
        vertices: [u32; 2],
    },
    /// The domain breaks rules.
    #[error("the domain has {} faults", .0.len())]
    Invalid(Vec<Fault>),
    /// Nothing is inside, or a seed is misplaced.
    #[error(transparent)]
    Inside(BackgroundError),
}

impl From<BackgroundError> for TriangulateError {
    fn from(error: BackgroundError) -> Self {
        match error {
            BackgroundError::Cdt(error) => Self::Segments(error),
            other => Self::Inside(other),
        }
    }
}

/// Delaunay triangulation of points; equal ones are merged.
///
/// # Errors
/// A point that is not finite, or too many.
///
/// # Complexity
/// That of [`delaunay()`].
///
/// ```
/// use trigrade::point::Point2;
/// use trigrade::triangulate::triangulate_points;
/// let points = [[0.0, 0.0], [2.0, 0.0], [1.0, 2.0], [1.0, 0.5], [2.0, 0.0]].map(Point2::from);
/// let made = triangulate_points(&points, Default::default())?;
/// assert_eq!(made.mesh.triangles.len(), 3);
/// assert_eq!(made.map[4], made.map[1], "equal points are one");
/// # Ok::<(), trigrade::triangulate::TriangulateError>(())
/// ```
pub fn triangulate_points(
    points: &[Point2],
    options: Options,
) -> Result<Triangulated, TriangulateError> {
    let engine = crate::delaunay::Options { engine: options.engine, parallel: options.parallel };
    let result = delaunay(points, engine)?;
    let keep = Kept::of(points.len(), result.repeated);
    let triangles = finite_triangles(&result.triangulation, |_| true);
    let corners = triangles.iter().map(|t| t.1.map(|v| keep.map[v as usize]));
    let mut mesh = Mesh { points: keep.pick(points), ..Mesh::default() };
    mesh.triangles = corners.collect();
    mesh.edges = hull_edges(&result.triangulation, |v| keep.map[v as usize]);
    let outline = options.outline.then(|| outline(&mesh)).flatten();
    let map = keep.map.into_iter().map(Some).collect();
    Ok(Triangulated { mesh, map, repeated: keep.repeated, crossings: 0, outline })
}

/// Constrained Delaunay triangulation of a domain's points, loops and segments.
///
/// # Errors
/// See [`TriangulateError`]. Without [`Options::hull`] and [`Options::split_crossings`] all faults
/// of the domain are named at once.
///
/// # Complexity
/// That of [`cdt_with`].
pub fn triangulate_domain(
    domain: &Domain,
    options: Options,
) -> Result<Triangulated, TriangulateError> {
    if !options.hull && !options.split_crossings {
        let plc = validate(domain).map_err(TriangulateError::Invalid)?;
        let mut result = carved(&plc, options)?;
        let renumbered = |v: &u32| result.map[*v as usize];
        result.map = plc.vertex_of.iter().map(renumbered).collect();
        result.repeated = Kept::of_equal(&domain.points).repeated;
        result.outline = options.outline.then(|| domain.clone());
        return Ok(result);
    }
    let pieces = Pieces::of(domain, options.split_crossings)?;
    let plc = pieces.plc(domain);
    let mut result = match options.hull {
        true => whole_hull(&plc, options)?,
        false => carved(&plc, options)?,
    };
    result.map = pieces.kept.map.iter().map(|&v| result.map[v as usize]).collect();
    result.repeated = pieces.kept.repeated;
    result.crossings = pieces.split.points.len() - pieces.distinct;
    if options.outline && !options.hull {
        result.outline = Some(pieces_as_domain(&plc, domain));
    }
    Ok(result)
}

/// Which points are kept when equal ones are merged.
struct Kept {
    /// For each point its rank among those kept, or that of the one it repeats.
    map: Vec<u32>,
    repeated: Vec<[u32; 2]>,
}

impl Kept {
    fn of(count: usize, repeated: Vec<[u32; 2]>) -> Self {
        let mut map = Vec::with_capacity(count);
        let mut dropped = repeated.iter().peekable();
        let mut next = 0;
        for i in 0..count as u32 {
            match dropped.next_if(|pair| pair[0] == i) {
                // The point kept has a lower index.
                Some(&[_, kept]) => map.push(map[kept as usize]),
                None => {
                    map.push(next);
                    next += 1;
                }
            }
        }
        Self { map, repeated }
    }

    fn of_equal(points: &[Point2]) -> Self {
        Self::of(points.len(), merge_equal(points).2)
    }

    /// The points kept.
    fn pick(&self, points: &[Point2]) -> Vec<Point2> {
        let mut dropped = self.repeated.iter().map(|pair| pair[0]).peekable();
        let kept = (0..).zip(points).filter(|(i, _)| dropped.next_if_eq(i).is_none());
        kept.map(|(_, &point)| point).collect()
    }
}

/// The loops' edges and segments of a domain, cut until they meet at common ends only.
struct Pieces {
    kept: Kept,
    /// How many different points the domain has.
    distinct: usize,
    split: Split,
}

impl Pieces {
    fn of(domain: &Domain, crossings: bool) -> Result<Self, TriangulateError> {
        crate::delaunay::check_points(&domain.points)?;
        let edges: Vec<[u32; 2]> = domain.edges().collect();
        for (&vertices, segment) in edges.iter().zip(0..) {
            let count = domain.points.len();
            if vertices.iter().any(|&v| v as usize >= count) {
                return Err(CdtError::BadSegment { segment, vertices, count }.into());
            }
        }
        let kept = Kept::of_equal(&domain.points);
        let points = kept.pick(&domain.points);
        let segments: Vec<[u32; 2]> =
            edges.iter().map(|edge| edge.map(|v| kept.map[v as usize])).collect();
        if let Some(segment) = segments.iter().position(|[a, b]| a == b) {
            let vertices = edges[segment];
            return Err(TriangulateError::Degenerate { segment: segment as u32, vertices });
        }
        let split = match crossings {
            true => split_crossings(&points, &segments)?,
            false => split_at_points(&points, &segments)?,
        };
        Ok(Self { kept, distinct: points.len(), split })
    }

    /// The pieces with the marker of the first segment they are part of. Under the even-odd rule a
    /// piece that an even number of loops run along does not switch inside and outside.
    fn plc(&self, domain: &Domain) -> Plc {
        let loops = domain.loops.iter().flat_map(|l| l.markers.iter().copied());
        let in_loops = domain.loops.iter().map(|l| l.vertices.len()).sum::<usize>() as u32;
        let markers: Vec<i32> =
            loops.chain(domain.segments.iter().map(|segment| segment.marker)).collect();
        let mut odd = vec![false; self.split.segments.len()];
        for &[piece, _] in self.split.covered.iter().filter(|pair| pair[1] < in_loops) {
            odd[piece as usize] ^= true;
        }
        let marker = |parent: u32| markers.get(parent as usize).copied().unwrap_or(0);
        let parts = self.split.segments.iter().zip(&self.split.parents).zip(odd);
        let segment = |((&vertices, &parent), in_loop)| PlcSegment {
            vertices,
            marker: marker(parent),
            in_loop,
        };
        Plc {
            points: self.split.points.clone(),
            point_markers: Vec::new(),
            segments: parts.map(segment).collect(),
            inside: match &domain.inside {
                Inside::EvenOdd => PlcInside::EvenOdd,
                Inside::Carve(holes) => PlcInside::Carve(holes.clone()),
            },
            regions: domain.regions.clone(),
            vertex_of: self.kept.map.clone(),
        }
    }
}

/// The pieces as a domain of their own. Those that switch inside and outside are an even number at
/// each vertex, so they are closed walks.
fn pieces_as_domain(plc: &Plc, given: &Domain) -> Domain {
    let mut domain = Domain::new(plc.points.clone());
    (domain.inside, domain.regions) = (given.inside.clone(), given.regions.clone());
    let by_parity = given.inside == Inside::EvenOdd;
    let mut at: Vec<Vec<u32>> = vec![Vec::new(); plc.points.len()];
    for segment in &plc.segments {
        let PlcSegment { vertices: [a, b], marker, in_loop } = *segment;
        if by_parity && in_loop {
            at[a as usize].push(b);
            at[b as usize].push(a);
        } else {
            domain.segments.push(Segment { vertices: [a, b], marker });
        }
    }
    for start in 0..plc.points.len() as u32 {
        while let Some(mut here) = at[start as usize].pop() {
            let mut walk = vec![start];
            let mut before = start;
            loop {
                let back = at[here as usize].iter().position(|&v| v == before);
                at[here as usize].swap_remove(back.expect("a piece has two ends"));
                if here == start {
                    break;
                }
                walk.push(here);
                before = here;
                here = at[here as usize].pop().expect("as many pieces leave as arrive");
            }
            domain.loops.push(Loop::new(walk, 0, LoopRole::Any));
        }
    }
    domain
}

fn constrained(plc: &Plc, options: Options) -> Result<Cdt, TriangulateError> {
    let ends: Vec<[u32; 2]> = plc.segments.iter().map(|s| s.vertices).collect();
    let engine = crate::delaunay::Options { engine: options.engine, parallel: options.parallel };
    Ok(cdt_with(&plc.points, &ends, engine)?)
}

/// All triangles of the hull; the map is of the complex's points.
fn whole_hull(plc: &Plc, options: Options) -> Result<Triangulated, TriangulateError> {
    let cdt = constrained(plc, options)?;
    let triangles = finite_triangles(&cdt.triangulation, |_| true);
    let mut mesh = Mesh { points: plc.points.clone(), ..Mesh::default() };
    mesh.triangles = triangles.into_iter().map(|t| t.1).collect();
    let given = plc.segments.iter();
    mesh.edges = given.map(|s| MarkedEdge { vertices: s.vertices, marker: s.marker }).collect();
    let mut known: Vec<[u32; 2]> = mesh.edges.iter().map(|edge| sorted(edge.vertices)).collect();
    known.sort_unstable();
    let hull = hull_edges(&cdt.triangulation, |v| v);
    let is_new = |edge: &MarkedEdge| known.binary_search(&sorted(edge.vertices)).is_err();
    mesh.edges.extend(hull.into_iter().filter(is_new));
    let outline = options.outline.then(|| outline(&mesh)).flatten();
    let map = (0..plc.points.len() as u32).map(Some).collect();
    Ok(Triangulated { mesh, map, outline, ..Triangulated::default() })
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The triangles inside; the map is of the complex's points.
fn carved(plc: &Plc, options: Options) -> Result<Triangulated, TriangulateError> {
    let background = Background::of(plc, constrained(plc, options)?)?;
    let triangulation = &background.triangulation;
    let triangles = finite_triangles(triangulation, |t| background.is_inside(t));
    let mut map: Vec<Option<u32>> = vec![None; plc.points.len()];
    for &v in triangles.iter().flat_map(|t| &t.1) {
        map[v as usize] = Some(0);
    }
    let mut mesh = Mesh::default();
    for (&point, new) in plc.points.iter().zip(&mut map) {
        if let Some(new) = new {
            *new = mesh.points.len() as u32;
            mesh.points.push(point);
        }
    }
    let renumbered = |v: u32| map[v as usize].expect("a corner is kept");
    mesh.triangles = triangles.iter().map(|t| t.1.map(renumbered)).collect();
    let inner = &background.edges[background.boundary_count..];
    // An inner constraint is listed from both sides.
    let edges = background.edges[..background.boundary_count].iter().chain(inner.iter().step_by(2));
    mesh.edges = edges
        .map(|e| MarkedEdge { vertices: e.vertices.map(|v| renumbered(v.0)), marker: e.marker })
        .collect();
    if !background.regions.is_empty() {
        let region = |t: TriangleId| background.region_of_tag(triangulation.tag(t));
        mesh.regions = triangles.iter().map(|t| region(t.0)).collect();
    }
    Ok(Triangulated { mesh, map, ..Triangulated::default() })
}

/// The finite triangles that are wanted, each from its lowest corner on, sorted by corners.
fn finite_triangles(
    triangulation: &Triangulation,
    is_wanted: impl Fn(TriangleId) -> bool,
) -> Vec<(TriangleId, [u32; 3])> {
    let wanted = triangulation.triangles().filter(|&t| !triangulation.is_ghost(t) && is_wanted(t));
    let mut list: Vec<(TriangleId, [u32; 3])> =
        wanted.map(|t| (t, from_lowest(triangulation.corners(t).map(|v| v.0)))).collect();
    list.sort_unstable_by_key(|t| t.1);
    list
}

fn from_lowest([a, b, c]: [u32; 3]) -> [u32; 3] {
    match a.min(b).min(c) {
        low if low == a => [a, b, c],
        low if low == b => [b, c, a],
        _ => [c, a, b],
    }
}

/// The edges of the hull, counterclockwise from the one that starts in the lowest point; none if
/// all points are on one line.
fn hull_edges(triangulation: &Triangulation, name: impl Fn(u32) -> u32) -> Vec<MarkedEdge> {
    let mut next = BTreeMap::new();
    for ghost in triangulation.triangles().filter(|&t| triangulation.is_ghost(t)) {
        let e = triangulation.ghost_edge(ghost);
        let is_finite =
            triangulation.twin(e).is_some_and(|f| !triangulation.is_ghost(f.triangle()));
        debug_assert!(triangulation.origin(e) != GHOST, "a ghost has one infinite corner");
        if is_finite {
            next.insert(name(triangulation.dest(e).0), name(triangulation.origin(e).0));
        }
    }
    let Some((&first, _)) = next.first_key_value() else { return Vec::new() };
    let chain =
        std::iter::successors(Some(first), |v| next.get(v).copied().filter(|&v| v != first));
    let edge = |v: u32| MarkedEdge { vertices: [v, next[&v]], marker: HULL_MARKER };
    chain.map(edge).collect()
}

/// The hull of a mesh's points, found anew, and its marked edges inside.
fn outline(mesh: &Mesh) -> Option<Domain> {
    let mut order: Vec<u32> = (0..mesh.points.len() as u32).collect();
    let at = |i: u32| mesh.points[i as usize];
    order.sort_unstable_by(|&a, &b| at(a).lexicographic(at(b)));
    let sorted_points: Vec<Point2> = order.iter().map(|&i| at(i)).collect();
    let hull: Vec<u32> =
        convex_hull(&sorted_points).into_iter().map(|i| order[i as usize]).collect();
    if hull.is_empty() {
        return None;
    }
    let mut domain = Domain::new(mesh.points.clone());
    let around = Loop::new(hull, HULL_MARKER, LoopRole::Outer);
    let mut on_hull: Vec<[u32; 2]> = around.edges().map(sorted).collect();
    on_hull.sort_unstable();
    let is_inner = |edge: &&MarkedEdge| on_hull.binary_search(&sorted(edge.vertices)).is_err();
    let inner = mesh.edges.iter().filter(is_inner);
    domain.segments =
        inner.map(|edge| Segment { vertices: edge.vertices, marker: edge.marker }).collect();
    domain.loops = vec![around];
    Some(domain)
}
