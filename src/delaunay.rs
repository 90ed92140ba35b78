//! Delaunay and constrained Delaunay triangulation of points in the plane.

pub(crate) mod fast;
pub(crate) mod lawson;
pub(crate) mod order;

use crate::point::Point2;
use crate::triangulation::constrain::Obstacle;
use crate::triangulation::{HalfEdgeId, Triangulation, VertexId};

/// A constrained Delaunay triangulation with ghosts, and where to find things in it.
#[derive(Clone, Default)]
pub struct Cdt {
    /// The triangles, with a ghost on every hull edge; segments are constrained edges.
    pub triangulation: Triangulation,
    /// For each point a half-edge out of it; `None` only if there is but one point.
    pub outgoing: Vec<Option<HalfEdgeId>>,
    /// For each segment its half-edge from the first vertex to the second.
    pub segments: Vec<HalfEdgeId>,
}

/// Why points and segments have no constrained Delaunay triangulation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CdtError {
    /// A coordinate is NaN or infinite.
    #[error("point {index} at {point} is not finite")]
    NotFinite {
        /// Index of the point.
        index: u32,
        /// Where it is.
        point: Point2,
    },
    /// Two points have equal coordinates.
    #[error("points {first} and {second} are both at {point}")]
    Duplicate {
        /// Index of the first point.
        first: u32,
        /// Index of the second point.
        second: u32,
        /// Where they are.
        point: Point2,
    },
    /// More points than half-edge indices allow.
    #[error("{count} points are more than the {max} that can be triangulated")]
    TooMany {
        /// How many there are.
        count: usize,
        /// How many there may be.
        max: usize,
    },
    /// A segment names a point that does not exist, or joins a point to itself.
    #[error("segment {segment} joins points {} and {}, which are not two of the {count} points", .vertices[0], .vertices[1])]
    BadSegment {
        /// Index of the segment.
        segment: u32,
        /// What it names.
        vertices: [u32; 2],
        /// How many points there are.
        count: usize,
    },
    /// Two segments cross.
    #[error("segments {first} and {second} cross")]
    Crossing {
        /// The lower index.
        first: u32,
        /// The higher index.
        second: u32,
    },
    /// A segment passes through a point that is none of its ends.
    #[error("segment {segment} passes through point {vertex} at {point}")]
    Through {
        /// Index of the segment.
        segment: u32,
        /// Index of the point.
        vertex: u32,
        /// Where the point is.
        point: Point2,
    },
}

/// Most points that can be triangulated: two triangles a point, ghosts included, must fit.
pub const POINTS_MAX: usize = crate::triangulation::TRIANGLES_MAX / 2;

/// Constrained Delaunay triangulation of distinct finite points and segments between them.
///
/// # Shapes and units
/// `points: [n][2]`, `segments: [m]` pairs of indices into `points`. Fewer than two points give an
/// empty triangulation; points on one line give ghosts only.
///
/// # Errors
/// See [`CdtError`]. A segment given twice is no error.
///
/// # Complexity
/// `n log n` for points in any order, plus the triangles that the segments cross.
pub fn cdt(points: &[Point2], segments: &[[u32; 2]]) -> Result<Cdt, CdtError> {
    check_points(points)?;
    check_segments(points.len(), segments)?;
    let mut triangulation = lawson::triangulate(points);
    let mut outgoing = triangulation.outgoing(points.len());
    for i in 0..segments.len() {
        force(&mut triangulation, points, (segments, i), &mut outgoing)?;
    }
    let find = |&[a, b]: &[u32; 2]| {
        let from = outgoing[a as usize].expect("every point is a vertex");
        triangulation.half_edge_to(from, VertexId(b)).expect("every segment is an edge")
    };
    let segments = segments.iter().map(find).collect();
    Ok(Cdt { triangulation, outgoing, segments })
}

fn force(
    triangulation: &mut Triangulation,
    points: &[Point2],
    (segments, i): (&[[u32; 2]], usize),
    outgoing: &mut [Option<HalfEdgeId>],
) -> Result<(), CdtError> {
    let [a, b] = segments[i].map(VertexId);
    let from = outgoing[a.index()].expect("every point is a vertex");
    match triangulation.force_segment(points, from, b, outgoing) {
        Ok(_) => Ok(()),
        Err(Obstacle::Crosses(e)) => {
            let ends = [triangulation.origin(e).0, triangulation.dest(e).0];
            let same = |s: &[u32; 2]| *s == ends || *s == [ends[1], ends[0]];
            let first = segments.iter().position(same).expect("constrained edges are segments");
            Err(CdtError::Crossing { first: first as u32, second: i as u32 })
        }
        Err(Obstacle::Through(e)) => {
            let vertex = triangulation.origin(e);
            let point = points[vertex.index()];
            Err(CdtError::Through { segment: i as u32, vertex: vertex.0, point })
        }
        Err(Obstacle::Leaves(_)) => unreachable!("a segment lies in the hull of its ends"),
    }
}

fn check_points(points: &[Point2]) -> Result<(), CdtError> {
    if points.len() > POINTS_MAX {
        return Err(CdtError::TooMany { count: points.len(), max: POINTS_MAX });
    }
    if let Some(i) = points.iter().position(|p| !p.is_finite()) {
        return Err(CdtError::NotFinite { index: i as u32, point: points[i] });
    }
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let at = |i: u32| points[i as usize];
    order.sort_unstable_by(|&a, &b| at(a).lexicographic(at(b)).then(a.cmp(&b)));
    let same = order.windows(2).find(|w| at(w[0]).key() == at(w[1]).key());
    match same {
        Some(w) => Err(CdtError::Duplicate { first: w[0], second: w[1], point: at(w[0]) }),
        None => Ok(()),
    }
}

fn check_segments(count: usize, segments: &[[u32; 2]]) -> Result<(), CdtError> {
    let bad = |&[a, b]: &[u32; 2]| a == b || a.max(b) as usize >= count;
    match segments.iter().position(bad) {
        Some(i) => Err(CdtError::BadSegment { segment: i as u32, vertices: segments[i], count }),
        None => Ok(()),
    }
}

/// TEMPORARY
pub fn fast_for_now(points: &[Point2], parallel: bool) -> Triangulation {
    fast::triangulate(points, parallel).triangulation
}
/// TEMPORARY
pub fn lawson_for_now(points: &[Point2]) -> Triangulation {
    lawson::triangulate(points)
}
