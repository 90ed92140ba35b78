//! Improvement of a finished mesh: flips to constrained Delaunay and smoothing (SPEC 8).
//!
//! Every change keeps the mesh valid: a flip is made only where the exact in-circle sign asks for
//! it, a vertex moves only where every triangle around it stays strictly counterclockwise.
//! Vertices of the boundary and of constraints never move.

mod flip;
mod smooth;

pub use flip::flip_to_delaunay;
use smooth::Smoother;

use crate::point::Point2;
use crate::triangulation::Triangulation;

/// How much improvement to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImproveOptions {
    /// Sweeps of smoothing over all movable vertices, each followed by flips.
    pub sweeps: u32,
}

impl Default for ImproveOptions {
    fn default() -> Self {
        Self { sweeps: 4 }
    }
}

/// What improvement did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ImproveStats {
    /// Flipped edges.
    pub flips: u64,
    /// Moves of vertices.
    pub moves: u64,
}

/// Flips and smooths `mesh`; vertices below `fixed` never move, and new coordinates are multiples
/// of `quantum` if there is one. Afterwards the mesh is constrained Delaunay.
///
/// Linear in triangles for the first sweep; later ones look at what has changed only.
pub fn improve(
    mesh: &mut Triangulation,
    points: &mut [Point2],
    fixed: usize,
    quantum: Option<f64>,
    options: ImproveOptions,
) -> ImproveStats {
    let mut smoother = Smoother::new(mesh, points, fixed, quantum);
    let mut stats = ImproveStats::default();
    if options.sweeps > 0 {
        stats.moves = smoother.sweep();
    }
    stats.flips = smoother.flip_all();
    for _ in 1..options.sweeps {
        let moves = smoother.sweep();
        stats.moves += moves;
        stats.flips += smoother.flip();
        if moves == 0 {
            break;
        }
    }
    stats
}
