//! Delaunay refinement (SPEC 18): points are inserted into the constrained Delaunay triangulation
//! of a domain until its triangles are small enough and, on request, wide enough.
//!
//! The area criterion is the report's "final Delaunay triangulation". The bound on angles is
//! Chew's second algorithm (*Guaranteed-quality mesh generation for curved surfaces*, 1993) as
//! Shewchuk describes it (*Delaunay refinement algorithms for triangular mesh generation*, 2002):
//! a segment is guarded by a lens, a triangle is mended by its off-centre (Üngör 2009), small
//! angles of the input are met with concentric shells (Ruppert 1995) and by the rule of Miller, Pav
//! and Walkington (2003). Differs from it in that free vertices stay where a segment is split.
//!
//! Signs are exact. A centre is rounded and is then an ordinary point: located, and inserted only
//! where it lies inside the domain. Floats say which triangle is mended next and where.

mod cavity;
mod measure;
mod pieces;
mod queue;
mod refiner;

pub(crate) use pieces::{SEGMENT_MIN, last_place};

use crate::background::Background;
use crate::point::Point2;
use crate::size::SizeField;
use crate::triangulation::{Triangulation, VertexId};
use refiner::Refiner;

/// The largest angle that can be asked for. Chew's algorithm is known to end for up to 30 degrees
/// and is seen to end for up to about 34; no triangulation has a least angle above 60.
pub const ANGLE_MAX_DEG: f64 = 34.0;

/// How large a triangle may be.
#[derive(Clone, Copy, Debug)]
pub enum AreaBound<'a> {
    /// As large as it likes.
    None,
    /// At most this area.
    Constant(f64),
    /// At most the area of the equilateral triangle whose side is the mean of the field's values at
    /// the corners.
    Field(&'a SizeField),
}

/// What refinement shall reach.
#[derive(Clone, Copy, Debug)]
pub struct RefineOptions<'a> {
    /// The bound on areas.
    pub area: AreaBound<'a>,
    /// The least angle in degrees, up to [`ANGLE_MAX_DEG`]; 0 for none.
    pub angle_min_deg: f64,
    /// Whether the boundary and the constraints may be split.
    pub split_boundary: bool,
    /// The number of triangles at which refinement gives up.
    pub triangles_max: usize,
    /// New coordinates are multiples of this power of two; `None`: any float.
    pub quantum: Option<f64>,
}

/// What refinement did, and what it could not do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RefineStats {
    /// Points inserted inside the domain.
    pub inserted: u64,
    /// Points inserted on the boundary and on constraints.
    pub splits: u64,
    /// Triangles with an angle below the bound.
    pub small_angles: u64,
    /// The smallest angle of all, in degrees; 60 where no bound was asked for.
    pub smallest_angle_deg: f64,
    /// Triangles with an area above their bound.
    pub too_large: u64,
}

/// An edge of the boundary or of a constraint in the refined mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RefinedEdge {
    /// From where to where, the domain on the left.
    pub vertices: [VertexId; 2],
    /// The marker of its segment.
    pub marker: i32,
}

/// A refined triangulation.
#[derive(Clone, Debug)]
pub struct Refined {
    /// Vertices: those of the domain first, then new ones in the order of insertion.
    pub points: Vec<Point2>,
    /// The triangles inside; constraints are constrained edges.
    pub mesh: Triangulation,
    /// Boundary edges, then constraints, each list in the order of the background's segments.
    pub edges: Vec<RefinedEdge>,
    /// The field's value at each vertex; empty without a field.
    pub spacing: Vec<f64>,
    /// Counters.
    pub stats: RefineStats,
}

/// Why refinement gave up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RefineError {
    /// More triangles than allowed.
    #[error(
        "refinement passed the limit of {0} triangles: raise --max-triangles, or ask for a larger \
         area or a smaller angle"
    )]
    Budget(usize),
    /// The observer asked to stop.
    #[error("stopped")]
    Stopped,
}

/// Called every few thousand insertions with the number of triangles; `false` stops refinement.
pub type Progress<'a> = &'a mut dyn FnMut(usize) -> bool;

/// Refines the constrained Delaunay triangulation of a domain.
///
/// The areas of [`Region`](crate::domain::Region)s bound their triangles too. What cannot be
/// mended without splitting the boundary, or at all, is counted in [`RefineStats`].
///
/// # Errors
/// [`RefineError`]: the limit passed, or the observer's wish.
///
/// # Guarantees
/// E1 to E8.
///
/// # Complexity
/// Linear in the number of triangles made, in practice.
pub fn refine(
    background: &Background,
    options: &RefineOptions<'_>,
    progress: Progress<'_>,
) -> Result<Refined, RefineError> {
    let mut refiner = Refiner::new(background, *options);
    refiner.judge_all();
    refiner.run(progress)?;
    refiner.survey();
    Ok(refiner.finish())
}
