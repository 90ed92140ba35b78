//! Voronoi tessellation: the dual of the canonical Delaunay triangulation (SPEC 17).
//!
//! A site's cell is what is nearer to it than to any other site. Its corners are centres of circles
//! through three sites or more; triangles of the Delaunay triangulation that share a circle, by the
//! exact in-circle sign and not by distance, share their Voronoi vertex. Vertices are rounded once to
//! the nearest doubles; which edges and cells there are is decided exactly and does not know of the
//! rounding.
//!
//! Cells of sites on the hull are unbounded: their outer edges are rays, or whole lines when all
//! sites are on one line. [`Voronoi::clip_to_box`] and [`Voronoi::clip_to_domain`] bound them.
//!
#![doc = include_str!("../docs/pictures/voronoi.svg")]

mod box_clip;
mod clipped;
mod domain_clip;

pub use box_clip::ClipBox;
pub use clipped::{Clipped, Piece};
pub use domain_clip::DomainClipError;

use crate::delaunay::{Delaunay, Options, PointsError, delaunay};
use crate::point::Point2;
use crate::predicates::{Sign, incircle, rounded_circumcentre};
use crate::triangulation::{GHOST, HalfEdgeId, TriangleId, Triangulation};

/// An edge of the tessellation: the points that have two sites at equal distance and none nearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The site on the left of the edge and the one on the right, indices into the points given.
    pub sites: [u32; 2],
    /// The vertices where it starts and ends; `None` at infinity.
    pub ends: [Option<u32>; 2],
}

/// The Voronoi tessellation of points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Voronoi {
    /// The points as given, equal ones included.
    pub sites: Vec<Point2>,
    /// `[dropped, kept]` for every point equal to one of lower index: it has no cell.
    pub repeated: Vec<[u32; 2]>,
    /// Centres of circles through three sites or more with no site inside, rounded to nearest; one
    /// beyond the range of f64 lies at its end.
    pub vertices: Vec<Point2>,
    /// For each vertex three of the sites on its circle.
    pub circles: Vec<[u32; 3]>,
    /// Edges of positive length, each once.
    pub edges: Vec<Edge>,
    /// Edges around the cells, one cell after the other.
    rims: Vec<u32>,
    /// Where the cell of each site starts in `rims`, and the end of the last.
    starts: Vec<u32>,
}

/// One side of a cell, with the cell on its left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Side {
    /// Index of the edge.
    pub edge: u32,
    /// The site beyond it.
    pub neighbour: u32,
    /// Its ends, counterclockwise around the cell; `None` at infinity.
    pub ends: [Option<u32>; 2],
}

/// The Voronoi tessellation of finite points; equal ones are merged.
///
/// # Guarantees
/// V1 to V5.
///
/// # Errors
/// See [`PointsError`].
///
/// # Complexity
/// That of the Delaunay triangulation, `n log n`.
///
/// # Examples
///
/// ```
/// use trigrade::{point::Point2, voronoi::voronoi};
/// let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(Point2::from);
/// let cells = voronoi(&corners, false)?;
/// // The four are on one circle: one vertex, four rays, and no edge across.
/// assert_eq!(cells.vertices, [Point2::new(1.0, 1.0)]);
/// assert_eq!(cells.edges.len(), 4);
/// assert!(cells.is_unbounded(0));
/// # Ok::<(), trigrade::delaunay::PointsError>(())
/// ```
pub fn voronoi(points: &[Point2], parallel: bool) -> Result<Voronoi, PointsError> {
    let options = Options { parallel, ..Options::default() };
    let Delaunay { triangulation, repeated } = delaunay(points, options)?;
    Ok(Dual::new(&triangulation, points).tessellation(repeated))
}

impl Voronoi {
    /// The sides of a site's cell, counterclockwise: of a bounded cell from the neighbour of lowest
    /// index on, of an unbounded one from infinity to infinity. None for a lone site, whose cell is
    /// the plane, and for a repeated point.
    pub fn cell(&self, site: u32) -> impl Iterator<Item = Side> + '_ {
        let range = self.starts[site as usize] as usize..self.starts[site as usize + 1] as usize;
        self.rims[range].iter().map(move |&edge| self.side(edge, site))
    }

    fn side(&self, edge: u32, site: u32) -> Side {
        let Edge { sites: [left, right], ends: [from, to] } = self.edges[edge as usize];
        if left == site {
            Side { edge, neighbour: right, ends: [from, to] }
        } else {
            Side { edge, neighbour: left, ends: [to, from] }
        }
    }

    /// Whether the site's cell is unbounded; so is that of a lone site.
    #[must_use]
    pub fn is_unbounded(&self, site: u32) -> bool {
        let mut sides = self.cell(site).peekable();
        sides.peek().is_none() || sides.any(|side| side.ends.contains(&None))
    }

    /// Whether the point has a cell: it repeats no other.
    #[must_use]
    pub fn has_cell(&self, site: u32) -> bool {
        self.repeated.binary_search_by_key(&site, |pair| pair[0]).is_err()
    }

    /// The direction of an edge, from its first end to its second: square to the line through its
    /// sites, each component rounded once.
    #[must_use]
    pub fn direction(&self, edge: &Edge) -> [f64; 2] {
        let [a, b] = edge.sites.map(|site| self.sites[site as usize]);
        // A difference of doubles beyond their range is one of halves, which keeps the direction.
        let [dx, dy] = [a.y - b.y, b.x - a.x];
        if dx.is_finite() && dy.is_finite() {
            return [dx + 0.0, dy + 0.0];
        }
        [a.y / 2.0 - b.y / 2.0, b.x / 2.0 - a.x / 2.0]
    }
}

/// The triangulation while its dual is read from it.
struct Dual<'a> {
    triangulation: &'a Triangulation,
    points: &'a [Point2],
    /// For each triangle one that stands for all on its circle.
    class: Vec<u32>,
}

/// No number given yet.
const NEW: u32 = u32::MAX;

impl<'a> Dual<'a> {
    fn new(triangulation: &'a Triangulation, points: &'a [Point2]) -> Self {
        let class = (0..triangulation.slot_count() as u32).collect();
        let mut dual = Self { triangulation, points, class };
        let mut todo = Vec::new();
        for t in triangulation.triangles().filter(|&t| !triangulation.is_ghost(t)) {
            if dual.class[t.index()] != t.0 {
                continue;
            }
            todo.push(t);
            while let Some(u) = todo.pop() {
                for v in u.half_edges().map(|e| dual.on_same_circle(e)).into_iter().flatten() {
                    // The first triangle found of a class stands for it.
                    if v != t && dual.class[v.index()] == v.0 {
                        dual.class[v.index()] = t.0;
                        todo.push(v);
                    }
                }
            }
        }
        dual
    }

    /// The triangle across an edge, if it has the same circle.
    fn on_same_circle(&self, e: HalfEdgeId) -> Option<TriangleId> {
        let f = self.triangulation.twin(e)?;
        let apex = self.triangulation.apex(f);
        if apex == GHOST || self.triangulation.is_ghost(f.triangle()) {
            return None;
        }
        let corners = self.triangulation.corners(e.triangle());
        let [a, b, c] = corners.map(|v| self.points[v.index()]);
        (incircle(a, b, c, self.points[apex.index()]) == Sign::Zero).then(|| f.triangle())
    }

    /// What stands for a triangle's circle; nothing for a ghost.
    fn circle(&self, t: TriangleId) -> Option<u32> {
        (!self.triangulation.is_ghost(t)).then(|| self.class[t.index()])
    }

    fn tessellation(&self, repeated: Vec<[u32; 2]>) -> Voronoi {
        let mut result = Voronoi { sites: self.points.to_vec(), repeated, ..Voronoi::default() };
        let outgoing = self.triangulation.outgoing(self.points.len());
        // Numbers of vertices and edges in the order in which the cells meet them: it depends on the
        // order of the sites, not on the slots of the triangulation.
        let mut numbers = vec![NEW; self.triangulation.slot_count()];
        let mut known: Vec<[u32; 4]> = vec![[NEW; 4]; self.triangulation.slot_count()];
        for &first in &outgoing {
            result.starts.push(result.rims.len() as u32);
            let Some(first) = first else { continue };
            for e in self.rim(first) {
                let f = self.triangulation.twin(e).expect("ghosts surround the hull");
                let seen = known[f.triangle().index()][f.corner()];
                let edge = match seen {
                    NEW => result.add_edge(self, e, &mut numbers),
                    edge => edge,
                };
                known[e.triangle().index()][e.corner()] = edge;
                result.rims.push(edge);
            }
        }
        result.starts.push(result.rims.len() as u32);
        result
    }

    /// The half-edges out of a site that have a Voronoi edge, in the order of [`Voronoi::cell`].
    fn rim(&self, first: HalfEdgeId) -> Vec<HalfEdgeId> {
        let t = self.triangulation;
        let circles = |e: HalfEdgeId| {
            let beyond = t.twin(e).map(HalfEdgeId::triangle);
            [beyond.and_then(|u| self.circle(u)), self.circle(e.triangle())]
        };
        let has_length = |e: &HalfEdgeId| {
            let [from, to] = circles(*e);
            t.dest(*e) != GHOST && (from.is_none() || from != to)
        };
        let mut rim: Vec<HalfEdgeId> = t.star(first).filter(has_length).collect();
        let from_infinity = rim.iter().position(|&e| circles(e)[0].is_none());
        let lowest = || (0..rim.len()).min_by_key(|&i| t.dest(rim[i]));
        let start = match from_infinity {
            // On a line a site between two has two edges from infinity.
            Some(_) if rim.iter().all(|&e| circles(e) == [None, None]) => lowest(),
            Some(start) => Some(start),
            None => lowest(),
        };
        rim.rotate_left(start.unwrap_or(0));
        rim
    }
}

impl Voronoi {
    /// Adds the edge between the origin of a half-edge, on its left, and the destination.
    fn add_edge(&mut self, dual: &Dual<'_>, e: HalfEdgeId, numbers: &mut [u32]) -> u32 {
        let t = dual.triangulation;
        let beyond = t.twin(e).expect("ghosts surround the hull").triangle();
        let ends = [beyond, e.triangle()]
            .map(|u| dual.circle(u).map(|class| self.vertex(dual, TriangleId(class), numbers)));
        self.edges.push(Edge { sites: [t.origin(e).0, t.dest(e).0], ends });
        self.edges.len() as u32 - 1
    }

    fn vertex(&mut self, dual: &Dual<'_>, class: TriangleId, numbers: &mut [u32]) -> u32 {
        if numbers[class.index()] == NEW {
            numbers[class.index()] = self.vertices.len() as u32;
            let corners = dual.triangulation.corners(class).map(|v| v.0);
            let [a, b, c] = corners.map(|v| dual.points[v as usize]);
            let centre = rounded_circumcentre(a, b, c).expect("a triangle is not flat");
            self.vertices.push(centre);
            self.circles.push(corners);
        }
        numbers[class.index()]
    }
}
