//! Improvement of a finished mesh: flips to constrained Delaunay and smoothing (SPEC 8).
//!
//! Every change keeps the mesh valid: a flip is made only where the exact in-circle sign asks for
//! it, a vertex moves only where every triangle around it stays strictly counterclockwise.
//! Vertices of the boundary and of constraints never move.

mod flip;
mod smooth;

pub use flip::flip_to_delaunay;
pub use smooth::{SmoothStats, smooth};

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

/// Flips and smooths `mesh`; vertices below `fixed` never move. Linear in triangles per sweep.
pub fn improve(
    mesh: &mut Triangulation,
    points: &mut [Point2],
    fixed: usize,
    options: ImproveOptions,
) -> ImproveStats {
    let mut stats = ImproveStats { flips: flip_to_delaunay(mesh, points), moves: 0 };
    for _ in 0..options.sweeps {
        let moved = smooth(mesh, points, fixed);
        stats.moves += moved.moves;
        let flips = flip_to_delaunay(mesh, points);
        stats.flips += flips;
        if moved.moves == 0 && flips == 0 {
            break;
        }
    }
    stats
}
