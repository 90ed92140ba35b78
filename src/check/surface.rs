//! A mesh against the surface model it should be a mesh of (SPEC 12.5).
//!
//! Uses the plain data of the model (points, tangents, sides) and nothing of the mesher: the foot
//! of each sample is searched for without the parameters that the mesher knew. Distances are floats
//! and are measured, not decided.

mod complex;
mod foot;

use super::report::{Collector, Draft, Finding, IdCount, Report, Verdict, show_triangle};
use super::{CheckOptions, Dimension, Id, check};
use crate::domain::Domain;
use crate::mesh::MeshData;
use crate::model::Model;
use complex::{Boundary, Complex};
use foot::{Measured, ROUNDING, Sheets};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// What is demanded of a mesh of a model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SurfaceLimits {
    /// Largest distance of a sample of a triangle from the surface.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub chord_error: Option<f64>,
    /// Largest angle between the normals of triangle and surface, in degrees.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub normal_deviation_deg: Option<f64>,
}

/// A mesh measured against its model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceReport {
    /// Largest distance from the surface: at centres and middles of sides.
    pub chord_error: f64,
    /// Largest distance of a vertex from the surface.
    pub vertex_error: f64,
    /// Largest angle between the normals of triangle and surface at the foot of its centre.
    pub normal_deviation_deg: f64,
    /// Vertices minus edges plus triangles.
    pub euler: i64,
    /// The same number of the model's own vertices, curves and patches.
    pub euler_of_model: i64,
    /// Edges of one triangle only.
    pub boundary_edges: usize,
    /// The findings, by id; at most [`list_limit`](CheckOptions::list_limit) each.
    pub findings: Vec<Finding>,
    /// Exact counts of the ids that have findings.
    pub counts: Vec<IdCount>,
}

/// The ids that only a model decides.
pub const SURFACE_IDS: [Id; 4] =
    [Id::SurfaceDeviation, Id::SurfaceFold, Id::SurfaceEuler, Id::SurfaceBoundary];

/// Checks a mesh in space and against its model: one report, and the figures.
///
/// # Complexity
/// That of [`check`] and of [`against_model`].
#[must_use]
pub fn check_on_model(
    mesh: &MeshData,
    (model, limits): (&Model, &SurfaceLimits),
    domain: Option<&Domain>,
    options: &CheckOptions,
) -> (Report, SurfaceReport) {
    let mut options = options.clone().dimension(Dimension::Space);
    options.crossing_parts |= model.parts_may_cross;
    let mut report = check(mesh, domain, &options);
    let measure = || measure(mesh, model, limits, &options);
    let pool =
        options.threads.map(|n| rayon::ThreadPoolBuilder::new().num_threads(n.max(1)).build());
    let surface = match pool {
        Some(Ok(pool)) => pool.install(measure),
        _ => measure(),
    };
    if !mesh.triangles.is_empty() {
        report.join(&surface);
    }
    (report, surface)
}

/// Measures a mesh against its model.
///
/// A triangle is measured against the patches with its region's marker; against all where the mesh
/// has no regions.
///
/// # Complexity
/// Linear in the triangles where neighbours follow each other in the mesh, `n log m` for m lattice
/// points where they do not; `n log n` for the edges.
#[must_use]
pub fn against_model(mesh: &MeshData, model: &Model, limits: &SurfaceLimits) -> SurfaceReport {
    measure(mesh, model, limits, &CheckOptions::new())
}

fn measure(
    mesh: &MeshData,
    model: &Model,
    limits: &SurfaceLimits,
    options: &CheckOptions,
) -> SurfaceReport {
    let sheets = Sheets::new(model, mesh, limits.chord_error);
    let measured = sheets.measure(mesh);
    let complex = Complex::of(model);
    let mut report = SurfaceReport { euler_of_model: complex.euler(), ..SurfaceReport::default() };
    for found in &measured {
        report.chord_error = report.chord_error.max(found.chord_error);
        report.vertex_error = report.vertex_error.max(found.vertex_error);
        report.normal_deviation_deg = report.normal_deviation_deg.max(found.turn_deg());
    }
    let edges = undirected(mesh);
    report.euler = used(mesh) as i64 - edges.len() as i64 + mesh.triangles.len() as i64;
    let boundary: Vec<[u32; 2]> =
        edges.iter().filter(|(_, count)| *count == 1).map(|(edge, _)| *edge).collect();
    report.boundary_edges = boundary.len();
    let mut out = Collector::new(mesh, options.list_limit);
    let tolerance = model.tolerance.unwrap_or(0.0).max(ROUNDING * sheets.size);
    find_deviations(&measured, limits, tolerance, (mesh, &mut out));
    find_folds(&measured, (mesh, &mut out));
    find_euler(&report, &mut out);
    let ends = Boundary { model, complex: &complex, tolerance };
    find_boundary(&ends, &boundary, (mesh, &mut out));
    (report.findings, report.counts) = out.finish(|id| options.allow.contains(&id));
    report
}

/// Where findings go, and the mesh they are about.
type Finder<'a, 'b> = (&'a MeshData, &'a mut Collector<'b>);

fn find_deviations(
    measured: &[Measured],
    limits: &SurfaceLimits,
    rounding: f64,
    (mesh, out): Finder<'_, '_>,
) {
    let mut find = |t: u32, what: String, measured: (&'static str, f64)| {
        let id = Id::SurfaceDeviation;
        out.add(id, || {
            let text = format!("triangle {} {what}", show_triangle(mesh, t));
            Draft::new(id, text).triangles([t]).measured(measured.0, measured.1)
        });
    };
    for m in measured {
        let (off, chord, turn) = (m.vertex_error, m.chord_error, m.turn_deg());
        if off > rounding {
            let what = format!("has a corner that is {off:e} off the surface");
            find(m.triangle, what, ("vertex_error", off));
        } else if let Some(limit) = limits.chord_error.filter(|limit| chord > *limit) {
            let what = format!("leaves the surface by {chord:e}, above the limit of {limit:e}");
            find(m.triangle, what, ("chord_error", chord));
        } else if let Some(limit) = limits.normal_deviation_deg.filter(|limit| turn > *limit) {
            let what = format!(
                "has a normal {turn:.2} degrees off the surface's, above the limit of {limit}"
            );
            find(m.triangle, what, ("normal_deviation_deg", turn));
        }
    }
}

/// Triangles that face against most others of their piece.
fn find_folds(measured: &[Measured], (mesh, out): Finder<'_, '_>) {
    let facing = || measured.iter().filter_map(|m| m.cosine.map(|c| (m, c < 0.0)));
    let mut votes: BTreeMap<usize, [u64; 2]> = BTreeMap::new();
    for (m, is_against) in facing() {
        votes.entry(m.piece).or_default()[usize::from(is_against)] += 1;
    }
    for (m, is_against) in facing() {
        let [with, against] = votes[&m.piece];
        if is_against != (against > with) {
            out.add(Id::SurfaceFold, || {
                let number = show_triangle(mesh, m.triangle);
                let text = format!("triangle {number} faces against the others of its patch");
                Draft::new(Id::SurfaceFold, text).triangles([m.triangle])
            });
        }
    }
}

fn find_euler(report: &SurfaceReport, out: &mut Collector<'_>) {
    let (found, wanted) = (report.euler, report.euler_of_model);
    if found != wanted {
        out.add(Id::SurfaceEuler, || {
            let text = format!("the mesh has the Euler number {found}, the model {wanted}");
            let draft = Draft::new(Id::SurfaceEuler, text);
            draft.measured("euler", found as f64).measured("euler_of_model", wanted as f64)
        });
    }
}

/// The mesh ends where the model ends, and the corners of the model are vertices.
fn find_boundary(ends: &Boundary<'_>, boundary: &[[u32; 2]], (mesh, out): Finder<'_, '_>) {
    for p in ends.missing_corners(mesh) {
        out.add(Id::SurfaceBoundary, || {
            let text = format!("the corner of the model at {p:?} is no vertex of the mesh");
            Draft::new(Id::SurfaceBoundary, text)
        });
    }
    let mut vertices: Vec<u32> = boundary.iter().flatten().copied().collect();
    vertices.sort_unstable();
    vertices.dedup();
    for v in ends.off(mesh, &vertices) {
        out.add(Id::SurfaceBoundary, || {
            let p = mesh.points[v as usize];
            let text = format!("the mesh ends at vertex {v} at {p:?}, where the model does not");
            Draft::new(Id::SurfaceBoundary, text).vertices([v])
        });
    }
}

/// How many vertices the triangles name, those that do not exist too.
fn used(mesh: &MeshData) -> usize {
    let mut is_used = vec![false; mesh.points.len()];
    let mut missing = BTreeSet::new();
    for &v in mesh.triangles.iter().flatten() {
        match is_used.get_mut(v as usize) {
            Some(slot) => *slot = true,
            None => drop(missing.insert(v)),
        }
    }
    is_used.into_iter().filter(|&used| used).count() + missing.len()
}

/// Edges with the number of triangles at each, sorted; those of points that do not exist are left out.
///
/// Upper ends are counted into buckets by their lower ends and sorted within.
fn undirected(mesh: &MeshData) -> Vec<([u32; 2], usize)> {
    let sides = || {
        let around = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
        let ends = mesh.triangles.iter().flat_map(around).map(|[a, b]| [a.min(b), a.max(b)]);
        ends.filter(|edge| (edge[1] as usize) < mesh.points.len())
    };
    let mut starts = vec![0_usize; mesh.points.len() + 1];
    sides().for_each(|[low, _]| starts[low as usize + 1] += 1);
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut upper = vec![0; starts[mesh.points.len()]];
    let mut next = starts.clone();
    for [low, high] in sides() {
        upper[next[low as usize]] = high;
        next[low as usize] += 1;
    }
    let mut edges = Vec::with_capacity(upper.len() / 2 + 1);
    for (low, ends) in (0..).zip(starts.windows(2)) {
        let bucket = &mut upper[ends[0]..ends[1]];
        bucket.sort_unstable();
        edges.extend(bucket.chunk_by(|a, b| a == b).map(|run| ([low, run[0]], run.len())));
    }
    edges
}

impl Report {
    /// Takes over what was found against a model.
    fn join(&mut self, surface: &SurfaceReport) {
        self.not_checked.retain(|entry| !SURFACE_IDS.contains(&entry.id));
        self.checked.extend(SURFACE_IDS);
        self.checked.sort_unstable();
        self.checked.dedup();
        self.findings.extend(surface.findings.iter().cloned());
        self.findings.sort_by_key(|finding| finding.id);
        self.counts.extend(surface.counts.iter().cloned());
        self.counts.sort_by_key(|entry| entry.id);
        if self.verdict == Verdict::Passed && surface.counts.iter().any(|entry| !entry.allowed) {
            self.verdict = Verdict::Failed;
        }
    }
}
