//! The oracle: checks anybody's mesh exactly, and grades it.
//!
//! ```text
//! MeshData -> structure -> orientation -> edges -> coverage -> constraints -> quality -> Report
//!             references   exact signs    rebuilt   chain of    chains of      metrics
//!             duplicates   folds                    boundary    mesh edges     gates
//! ```
//!
//! It shares no code with the mesher: it reads plain data, rebuilds adjacency itself, never repairs,
//! and has its own integer arithmetic ([`exact`]). No decision uses a tolerance. Each class of
//! defect has an [`Id`] (SPEC 9, 10), and a defect is reported once, by its cause: a finding that
//! follows from another one is left out.

mod along;
mod beside;
pub mod certificate;
mod chain;
mod conform;
mod constraint;
mod coverage;
mod delaunay;
mod domain;
mod edges;
pub mod exact;
pub mod gate;
pub mod id;
mod lattice;
mod orientation;
mod plane;
mod points;
pub mod quality;
pub mod report;
pub mod size;
mod space;
mod status;
mod structure;
pub mod surface;
mod sweep;
mod topology;
mod tree;
mod tree3;
pub mod wide;

pub use gate::{Baseline, Gate, GateError, GateFile, GateOutcome, GateResult};
pub use id::Id;
pub use quality::{Metric, MetricSummary, Quality};
pub use report::{Finding, Report, Verdict};

use crate::domain::Domain;
use crate::mesh::MeshData;
use std::collections::BTreeSet;

/// Whether a mesh is checked as a triangulation of the plane or as a surface in space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dimension {
    /// Plane when all points have the same z, else space.
    #[default]
    Auto,
    /// The plane; the check cannot run when points differ in z.
    Plane,
    /// Space, even when all points have the same z.
    Space,
}

/// What to check, and how strictly.
///
/// ```
/// use trigrade::check::{CheckOptions, Gate, Id};
///
/// let options = CheckOptions::new().allow(Id::UnusedVertex).gate(Gate::parse("shape >= 0.2")?);
/// # Ok::<(), trigrade::check::GateError>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct CheckOptions {
    /// Findings of these ids are reported but do not fail.
    pub allow: BTreeSet<Id>,
    /// Plane or space.
    pub dimension: Dimension,
    /// Check that every interior edge is locally Delaunay.
    pub delaunay: bool,
    /// The same for interior edges that are no constraints.
    pub constrained_delaunay: bool,
    /// Demand that a surface is closed.
    pub closed: bool,
    /// Parts of a surface that do not hang together may cross each other.
    pub crossing_parts: bool,
    /// Most findings listed per id; all are counted.
    pub list_limit: u64,
    /// Largest deviation of a subdividing node from its segment, in units in the last place of the
    /// largest coordinate of the segment's ends.
    pub deviation_ulps: f64,
    /// Largest deviation as a length; takes the place of `deviation_ulps` when given.
    pub deviation_length: Option<f64>,
    /// Measure quality.
    pub quality: bool,
    /// Quality gates.
    pub gates: Vec<Gate>,
    /// The quality that the mesh must not fall behind.
    pub baseline: Option<Baseline>,
    /// Threads to use; `None` for the caller's rayon pool. The report does not depend on it.
    pub threads: Option<usize>,
}

impl Default for CheckOptions {
    /// Everything that needs no claim about the mesh, listing 20 findings per id, nodes of
    /// subdivided segments within 4 ulps.
    ///
    /// A node at from + t (to - from), computed in floats, has four roundings per coordinate, each of
    /// half an ulp of a number no larger than the ends' difference; 4 ulps allow for that.
    fn default() -> Self {
        Self {
            allow: BTreeSet::new(),
            dimension: Dimension::Auto,
            delaunay: false,
            constrained_delaunay: false,
            closed: false,
            crossing_parts: false,
            list_limit: 20,
            deviation_ulps: 4.0,
            deviation_length: None,
            quality: true,
            gates: Vec::new(),
            baseline: None,
            threads: None,
        }
    }
}

impl CheckOptions {
    /// The defaults.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Findings of this id do not fail.
    #[must_use]
    pub fn allow(mut self, id: Id) -> Self {
        self.allow.insert(id);
        self
    }

    /// Adds a quality gate.
    #[must_use]
    pub fn gate(mut self, gate: Gate) -> Self {
        self.gates.push(gate);
        self
    }

    /// Compares with a baseline.
    #[must_use]
    pub fn baseline(mut self, baseline: Baseline) -> Self {
        self.baseline = Some(baseline);
        self
    }

    /// Sets plane or space.
    #[must_use]
    pub fn dimension(mut self, dimension: Dimension) -> Self {
        self.dimension = dimension;
        self
    }

    /// Switches the check that interior edges are locally Delaunay.
    #[must_use]
    pub fn delaunay(mut self, on: bool) -> Self {
        self.delaunay = on;
        self
    }

    /// Switches the check that interior edges but constraints are locally Delaunay.
    #[must_use]
    pub fn constrained_delaunay(mut self, on: bool) -> Self {
        self.constrained_delaunay = on;
        self
    }

    /// Demands that a surface is closed.
    #[must_use]
    pub fn closed(mut self, on: bool) -> Self {
        self.closed = on;
        self
    }

    /// Allows parts of a surface that do not hang together to cross each other.
    #[must_use]
    pub fn crossing_parts(mut self, on: bool) -> Self {
        self.crossing_parts = on;
        self
    }

    /// Sets how many findings are listed per id.
    #[must_use]
    pub fn list_limit(mut self, limit: u64) -> Self {
        self.list_limit = limit;
        self
    }

    /// Sets the number of threads.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = Some(threads);
        self
    }
}

/// Checks a mesh, against a domain if one is given.
///
/// # Guarantees
/// C1 to C9 of the specification: exact decisions, no valid mesh rejected, the same report for any
/// number of threads. Never panics, whatever the mesh says.
///
/// # Complexity
/// O(n + b log b) for a sound mesh of n triangles and b boundary edges, about 130 bytes a triangle
/// beside the mesh. Finding out what is wrong with a broken one may take longer.
///
/// ```
/// use trigrade::check::{CheckOptions, Id, check};
/// use trigrade::mesh::MeshData;
///
/// let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mut mesh = MeshData { points, triangles: vec![[0, 1, 2], [0, 2, 3]], ..MeshData::default() };
/// assert!(check(&mesh, None, &CheckOptions::new()).passed());
///
/// mesh.triangles[1] = [0, 1, 3];
/// assert_eq!(check(&mesh, None, &CheckOptions::new()).ids(), [Id::Overlap]);
/// ```
#[must_use]
pub fn check(mesh: &MeshData, domain: Option<&Domain>, options: &CheckOptions) -> Report {
    let pool = options.threads.and_then(|threads| {
        rayon::ThreadPoolBuilder::new().num_threads(threads.max(1)).build().ok()
    });
    match pool {
        Some(pool) => pool.install(|| plane::run(mesh, domain, options)),
        None => plane::run(mesh, domain, options),
    }
}

/// `x * 2^exponent`, rounded once; any exponent.
#[inline]
fn ldexp(x: f64, exponent: i32) -> f64 {
    if (-1000..=1000).contains(&exponent) {
        let bits = (1023 + i64::from(exponent)) << 52;
        let scaled = x * f64::from_bits(bits.cast_unsigned());
        // A product of a normal number that stays normal is exact.
        if scaled.abs() >= f64::MIN_POSITIVE || x == 0.0 {
            return scaled;
        }
    }
    libm::scalbn(x, exponent)
}
