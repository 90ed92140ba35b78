//! Delaunay and constrained Delaunay triangulation of points in the plane.

mod assemble;
mod divide_conquer;
mod divide_conquer_cdt;
mod fang_piegl;
mod fast;
pub(crate) mod hull;
mod incremental;
pub(crate) mod lawson;
mod order;
mod split;
mod sweep;
mod watson;

pub use split::{Split, split_at_points, split_crossings};

use crate::point::Point2;
use crate::triangulation::constrain::Obstacle;
use crate::triangulation::{GHOST, HalfEdgeId, Triangulation, VertexId};

/// The algorithm; all give the same triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Engine {
    /// The fastest: divide and conquer over the cells of a Morton curve, on `threads` threads.
    #[default]
    Auto,
    /// Insertion by cavities (Watson 1981).
    Watson,
    /// Insertion by flips (Lawson 1977).
    Lawson,
    /// Triangle by triangle with a uniform grid (Fang and Piegl 1993). Quadratic for points on
    /// circles, and where the grid does not spread them.
    FangPiegl,
    /// Divide and conquer (Guibas and Stolfi 1985).
    DivideConquer,
    /// Sweep line (Fortune 1987).
    Sweep,
}

impl Engine {
    /// Every engine.
    pub const ALL: [Self; 6] =
        [Self::Auto, Self::Watson, Self::Lawson, Self::FangPiegl, Self::DivideConquer, Self::Sweep];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Watson => "watson",
            Self::Lawson => "lawson",
            Self::FangPiegl => "fang-piegl",
            Self::DivideConquer => "divide-conquer",
            Self::Sweep => "sweep",
        }
    }

    /// The engine of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|engine| engine.name() == name)
    }
}

/// How to triangulate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// The algorithm.
    pub engine: Engine,
    /// Whether [`Engine::Auto`] may use the threads of the current rayon pool. The result is the
    /// same, to the slot.
    pub parallel: bool,
}

/// A Delaunay triangulation.
#[derive(Clone, Debug, Default)]
pub struct Delaunay {
    /// The triangles, with a ghost on every hull edge. All points on one line: ghosts only. Fewer
    /// than two different points: nothing.
    pub triangulation: Triangulation,
    /// `[dropped, kept]` for every point equal to one of lower index, sorted: it is in no triangle.
    pub repeated: Vec<[u32; 2]>,
}

impl Delaunay {
    /// The finite triangles, counterclockwise, each from its lowest corner on, sorted: the same
    /// list from every engine.
    #[must_use]
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let t = &self.triangulation;
        let finite = t.triangles().map(|u| t.corners(u)).filter(|c| !c.contains(&GHOST));
        let from_lowest = |[a, b, c]: [u32; 3]| match a.min(b).min(c) {
            low if low == a => [a, b, c],
            low if low == b => [b, c, a],
            _ => [c, a, b],
        };
        let mut list: Vec<[u32; 3]> = finite.map(|c| from_lowest(c.map(|v| v.0))).collect();
        list.sort_unstable();
        list
    }
}

/// Why points cannot be triangulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PointsError {
    /// A coordinate is NaN or infinite.
    #[error("point {index} at {point} is not finite")]
    NotFinite {
        /// Index of the point.
        index: u32,
        /// Where it is.
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
}

/// Delaunay triangulation of finite points: the unique one of SPEC 5. Equal points are merged.
///
/// # Shapes and units
/// `points: [n][2]` in any unit.
///
/// # Guarantees
/// L1, L2, L3, L4.
///
/// # Errors
/// See [`PointsError`].
///
/// # Complexity
/// [`Engine::Auto`]: `n log n`; 80 bytes a point and the input.
///
/// ```
/// use trigrade::delaunay::{Engine, Options, delaunay};
/// use trigrade::point::Point2;
/// let grid: Vec<Point2> = (0..25).map(|i| Point2::from([f64::from(i % 5), f64::from(i / 5)])).collect();
/// let by = |engine| delaunay(&grid, Options { engine, parallel: false }).map(|made| made.triangles());
/// assert_eq!(by(Engine::Sweep)?, by(Engine::Watson)?, "the answer is unique, even on a grid");
/// # Ok::<(), trigrade::delaunay::PointsError>(())
/// ```
pub fn delaunay(points: &[Point2], options: Options) -> Result<Delaunay, PointsError> {
    check_points(points)?;
    let run = match options.engine {
        Engine::Auto => return Ok(fast::triangulate(points, options.parallel)),
        Engine::Watson => watson::triangulate,
        Engine::Lawson => lawson::triangulate,
        Engine::FangPiegl => fang_piegl::triangulate,
        Engine::DivideConquer => divide_conquer::triangulate,
        Engine::Sweep => sweep::triangulate,
    };
    let (distinct, index, repeated) = merge_equal(points);
    let mut triangulation = run(&distinct);
    triangulation.rename(&index);
    Ok(Delaunay { triangulation, repeated })
}

/// The different points in lexicographic order, the lowest index of each, and the rest as
/// [`Delaunay::repeated`].
pub(crate) fn merge_equal(points: &[Point2]) -> (Vec<Point2>, Vec<u32>, Vec<[u32; 2]>) {
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let at = |i: u32| points[i as usize];
    order.sort_unstable_by(|&a, &b| at(a).lexicographic(at(b)).then(a.cmp(&b)));
    let (mut index, mut repeated): (Vec<u32>, Vec<[u32; 2]>) = (Vec::new(), Vec::new());
    for i in order {
        match index.last() {
            Some(&kept) if at(kept) == at(i) => repeated.push([i, kept]),
            _ => index.push(i),
        }
    }
    repeated.sort_unstable();
    (index.iter().map(|&i| at(i)).collect(), index, repeated)
}

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
    /// A point is not finite, or there are too many.
    #[error(transparent)]
    Points(#[from] PointsError),
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
    /// The engine has no constraints.
    #[error("the engine {0} has no constraints; auto and divide-conquer have")]
    Unconstrained(&'static str),
    /// Two segments cross.
    #[error("segments {first} and {second} cross")]
    Crossing {
        /// The lower index.
        first: u32,
        /// The higher index.
        second: u32,
    },
    /// Cutting crossings does not come to an end.
    #[error("cutting segment {segment} where it crosses others makes new crossings without end")]
    Tangled {
        /// Index of a segment not done.
        segment: u32,
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
    cdt_with(points, segments, Options::default())
}

/// [`cdt`] by a given engine: [`Engine::Auto`] forces segment after segment,
/// [`Engine::DivideConquer`] merges constrained triangulations of halves.
///
/// # Errors
/// See [`CdtError`]; the other engines have no constraints.
pub fn cdt_with(
    points: &[Point2],
    segments: &[[u32; 2]],
    options: Options,
) -> Result<Cdt, CdtError> {
    check_segments(points.len(), segments)?;
    match options.engine {
        Engine::Auto => force_all(points, segments, options),
        Engine::DivideConquer => {
            check_points(points)?;
            check_distinct(points)?;
            divide_conquer_cdt::triangulate(points, segments)
        }
        other => Err(CdtError::Unconstrained(other.name())),
    }
}

/// Forces segment after segment into the Delaunay triangulation.
fn force_all(points: &[Point2], segments: &[[u32; 2]], options: Options) -> Result<Cdt, CdtError> {
    let Delaunay { mut triangulation, repeated } = delaunay(points, options)?;
    if let Some(&[second, first]) = repeated.first() {
        return Err(CdtError::Duplicate { first, second, point: points[first as usize] });
    }
    let mut outgoing = triangulation.outgoing(points.len());
    for i in 0..segments.len() {
        force(&mut triangulation, points, (segments, i), &mut outgoing)?;
    }
    Ok(found(triangulation, outgoing, segments))
}

/// The triangulation with the half-edge of each segment, which is an edge of it.
fn found(
    triangulation: Triangulation,
    outgoing: Vec<Option<HalfEdgeId>>,
    segments: &[[u32; 2]],
) -> Cdt {
    let find = |&[a, b]: &[u32; 2]| {
        let from = outgoing[a as usize].expect("every point is a vertex");
        triangulation.half_edge_to(from, VertexId(b)).expect("every segment is an edge")
    };
    let segments = segments.iter().map(find).collect();
    Cdt { triangulation, outgoing, segments }
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

pub(crate) fn check_points(points: &[Point2]) -> Result<(), PointsError> {
    if points.len() > POINTS_MAX {
        return Err(PointsError::TooMany { count: points.len(), max: POINTS_MAX });
    }
    match points.iter().position(|p| !p.is_finite()) {
        Some(i) => Err(PointsError::NotFinite { index: i as u32, point: points[i] }),
        None => Ok(()),
    }
}

fn check_distinct(points: &[Point2]) -> Result<(), CdtError> {
    match merge_equal(points).2.first() {
        Some(&[second, first]) => {
            Err(CdtError::Duplicate { first, second, point: points[first as usize] })
        }
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
