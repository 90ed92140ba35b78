//! Improvement of a finished mesh: flips to constrained Delaunay, smoothing, and other topologies
//! where the lattice has defects (SPEC 8).
//!
//! Every change keeps the mesh valid: a flip is made only where the exact in-circle sign asks for
//! it, a vertex moves only where every triangle around it stays strictly counterclockwise.
//! Vertices of the boundary and of constraints never move.

mod attempt;
mod balance;
mod books;
mod defects;
mod degree;
mod energy;
mod flip;
mod forced;
mod patch;
mod places;
mod smooth;
mod split;

pub(crate) use attempt::{Attempt, Effort, GAIN_MIN, Search, Searcher};
use balance::balance;
pub(crate) use books::{Books, Searched};
use defects::{Defects, Lattice};
pub use flip::flip_to_delaunay;
pub use forced::{Forced, forced_aspect};
pub(crate) use patch::{Origin, Patch, Worth};
pub(crate) use smooth::NOWHERE;
use smooth::{Sheet, Smoother};
pub use split::{SplitOptions, split_long_edges};

use crate::point::Point2;
use crate::triangulation::Triangulation;

/// How much improvement to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImproveOptions {
    /// Sweeps of smoothing over all movable vertices, each followed by flips.
    pub sweeps: u32,
    /// Passes over the irregular vertices and the worst triangles, where other topologies are tried.
    pub passes: u32,
    /// Rings of triangles that a try relaxes.
    pub rings: u32,
    /// Changes in a chain of tries: when none makes things better, the search goes on from the least
    /// bad one.
    pub depth: u32,
    /// Changes tried in each step of a chain after its first, those that do the least harm at first;
    /// 0 for all of them, as at bad triangles in any case.
    pub breadth: u32,
    /// No more tries than this: the budget counts operations, so that the answer does not depend on
    /// a clock.
    pub tries_max: u64,
    /// A mesh is good as a whole when the mean inverse mean ratio of its triangles is above 1 by less
    /// than this many millionths; then changes are tried at poor triangles only, and nothing is
    /// balanced. 0 for none.
    pub enough: u32,
    /// Rounds of small moves at the end, for the worst triangles and for neighbours of like area.
    pub balances: u32,
}

impl ImproveOptions {
    /// Neither smoothing nor flips nor anything else but flips to Delaunay.
    pub const NONE: Self = Self {
        sweeps: 0,
        passes: 0,
        rings: 0,
        depth: 0,
        breadth: 0,
        tries_max: 0,
        enough: 0,
        balances: 0,
    };

    /// A level of effort: 0 smooths, 1 tries other topologies at the worst places, 2 everywhere and
    /// more carefully, 3 until nothing gets better. Each level costs some times the one before.
    #[must_use]
    pub const fn level(level: u8) -> Self {
        match level {
            0 => Self { sweeps: 4, ..Self::NONE },
            1 => Self {
                sweeps: 4,
                passes: 8,
                rings: 3,
                depth: 2,
                breadth: 6,
                tries_max: 32_000,
                enough: 600,
                balances: 3,
            },
            2 => Self {
                passes: 6,
                rings: 4,
                breadth: 0,
                tries_max: 400_000,
                enough: 0,
                ..Self::level(1)
            },
            _ => Self { sweeps: 6, passes: 16, depth: 6, tries_max: u64::MAX, ..Self::level(2) },
        }
    }
}

impl Default for ImproveOptions {
    fn default() -> Self {
        Self::level(1)
    }
}

/// What improvement did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ImproveStats {
    /// Flipped edges.
    pub flips: u64,
    /// Moves of vertices.
    pub moves: u64,
    /// Changes of topology that were tried.
    pub tried: u64,
    /// Changes of topology that were kept.
    pub changes: u64,
    /// Edges that were halved before all of it, because the front had left them too long.
    pub splits: u64,
}

/// Flips and smooths `mesh`, and adds or removes vertices where that makes it better; vertices below
/// `fixed` never move and never go, and new coordinates are multiples of `quantum` if there is one.
/// A new vertex gets the mean spacing of those around it; one that has gone stays in `points`, in no
/// triangle. Afterwards the mesh is constrained Delaunay.
///
/// Linear in triangles for the first sweep; later ones look at what has changed only. A try costs
/// some ten microseconds.
pub fn improve(
    mesh: &mut Triangulation,
    points: &mut Vec<Point2>,
    spacing: &mut Vec<f64>,
    fixed: usize,
    quantum: Option<f64>,
    options: ImproveOptions,
) -> ImproveStats {
    let mut stats = ImproveStats::default();
    let mut smoother = Smoother::new(mesh, points.len());
    let mut sheet = Sheet { mesh, points, fixed, quantum };
    if options.sweeps > 0 {
        stats.moves += smoother.sweep(&mut sheet);
    }
    stats.flips += smoother.flip_all(&mut sheet);
    settle(&mut smoother, &mut sheet, options.sweeps, &mut stats);
    let mut is_good = false;
    if options.passes > 0 && options.depth > 0 {
        let ImproveOptions { rings, depth, breadth, .. } = options;
        let effort = Effort { rings, depth, breadth };
        let lattice = Lattice { mesh, points, spacing, fixed, quantum, effort };
        (smoother, is_good) = mend(lattice, smoother, options, &mut stats);
        let mut sheet = Sheet { mesh, points, fixed, quantum };
        if stats.changes > 0 {
            stats.moves += smoother.sweep(&mut sheet);
            stats.flips += smoother.flip(&mut sheet);
            settle(&mut smoother, &mut sheet, options.sweeps, &mut stats);
        }
    }
    if options.balances > 0 && !is_good {
        let mut sheet = Sheet { mesh, points, fixed, quantum };
        let [moves, flips] = balance(&mut smoother, &mut sheet, options.balances);
        (stats.moves, stats.flips) = (stats.moves + moves, stats.flips + flips);
    }
    stats
}

/// Searches for better topologies; returns what is left to smooth, and whether the mesh was good as a
/// whole before.
fn mend(
    lattice: Lattice<'_>,
    smoother: Smoother,
    options: ImproveOptions,
    stats: &mut ImproveStats,
) -> (Smoother, bool) {
    let mut defects = Defects::new(lattice, smoother.into_outgoing());
    let enough = 1e-6 * f64::from(options.enough);
    for _ in 0..options.passes {
        if defects.pass(options.tries_max, enough) == 0 {
            break;
        }
    }
    (stats.tried, stats.changes) = (defects.books.tried, defects.books.changes);
    let is_good = defects.is_good();
    (defects.into_smoother(), is_good)
}

/// Sweeps of smoothing after the first, each followed by flips.
fn settle(smoother: &mut Smoother, sheet: &mut Sheet<'_>, sweeps: u32, stats: &mut ImproveStats) {
    for _ in 1..sweeps {
        let moves = smoother.sweep(sheet);
        stats.moves += moves;
        stats.flips += smoother.flip(sheet);
        if moves == 0 {
            break;
        }
    }
}
