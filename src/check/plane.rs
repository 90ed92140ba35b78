//! The checks of a mesh in the plane, in order; and the frame of every report.

use super::conform::Match;
use super::constraint;
use super::coverage::{self, Covered};
use super::delaunay;
use super::domain::{self, Region};
use super::edges::{Edges, TRIANGLES_MAX};
use super::exact::ExactSum;
use super::gate::GateOutcome;
use super::id::Id;
use super::lattice::Plane;
use super::orientation::{self, Oriented};
use super::quality::{self, Measured, measure};
use super::report::{
    Collector, Draft, ExactNumber, NotChecked, Report, SCHEMA, Statistics, Verdict, triangle_place,
};
use super::structure::{self, Sound};
use super::topology;
use super::wide::Wide;
use super::{CheckOptions, Dimension, ldexp};
use crate::domain::Domain;
use crate::mesh::MeshData;
use std::collections::BTreeSet;

/// A report in the making.
pub(super) struct Run<'a> {
    pub(super) mesh: &'a MeshData,
    pub(super) options: &'a CheckOptions,
    pub(super) out: Collector<'a>,
    pub(super) statistics: Statistics,
    pub(super) not_checked: Vec<NotChecked>,
    pub(super) could_not_run: Vec<String>,
    pub(super) quality: Option<quality::Measurements>,
}

/// Checks M1 first, then what the dimension asks for.
pub(super) fn run(mesh: &MeshData, domain: Option<&Domain>, options: &CheckOptions) -> Report {
    let mut run = Run::new(mesh, options);
    let in_space = match options.dimension {
        Dimension::Auto => !is_flat(mesh),
        Dimension::Plane => false,
        Dimension::Space => true,
    };
    run.statistics.dimension = if in_space { "space" } else { "plane" }.to_owned();
    if mesh.triangles.is_empty() {
        run.out.add(Id::Empty, || Draft::new(Id::Empty, "the mesh has no triangle".to_owned()));
        run.skip_all("the mesh has no triangle");
    } else if mesh.triangles.len() > TRIANGLES_MAX || mesh.points.len() >= u32::MAX as usize {
        run.skip_all("the mesh has more triangles than 32 bits can number");
    } else if in_space {
        if domain.is_some() {
            run.could_not_run
                .push("a plane domain was given, but the points differ in z".to_owned());
        }
        super::space::check(&mut run);
    } else if is_flat(mesh) {
        check_plane(&mut run, domain);
    } else {
        run.skip_all("the points differ in z, so this is no plane mesh");
    }
    run.finish()
}

/// Whether all points that are finite have the same z.
fn is_flat(mesh: &MeshData) -> bool {
    let mut heights = mesh.points.iter().map(|p| p[2]).filter(|z| z.is_finite());
    heights.next().is_none_or(|first| heights.all(|z| z == first))
}

/// Ids that only one kind of check can find.
const SPACE_ONLY: [Id; 3] = [Id::NotClosed, Id::SurfaceOrientation, Id::SelfIntersection];
const DOMAIN_ONLY: [Id; 6] = [
    Id::Uncovered,
    Id::Outside,
    Id::BoundaryLost,
    Id::Deviation,
    Id::ConstraintLost,
    Id::PointLost,
];

fn check_plane(run: &mut Run<'_>, domain: Option<&Domain>) {
    let mesh = run.mesh;
    let region = derive_region(run, domain);
    run.skip(&SPACE_ONLY, "the mesh lies in a plane");
    let mut sound = structure::survey(mesh, &mut run.out);
    let plane = Plane::new(mesh);
    let oriented = orientation::orient(&plane, &mut sound, &mut run.out);
    let (edges, inverted) = build_edges(&mut sound, &oriented, &mut run.out);
    let given = domain.zip(region.as_ref());
    let covered =
        Covered { plane: &plane, sound: &sound, edges: &edges, inverted: &inverted, domain: given };
    let (mut concerned, matched) = coverage::check(&covered, &mut run.out);
    topology::report_crowded_edges(&sound, &edges, &mut run.out);
    topology::report_marked_edges(&sound, &mut run.out);
    let parts = topology::survey(&sound, &edges);
    if given.is_none() {
        topology::report_bow_ties(&covered, &parts, &concerned, &mut run.out);
    }
    if let Some((domain, region)) = given {
        let inner = constraint::Inner { plane: &plane, sound: &sound, domain, region };
        run.statistics.deviation =
            Some(constraint::check(&inner, &matched, run.options, &mut concerned, &mut run.out));
    }
    report_unused(run, &sound, &concerned);
    check_delaunay(run, &covered, region.as_ref());
    parts.describe(&edges, &mut run.statistics);
    describe_area(run, &oriented, &matched, region.as_ref());
    measure_quality(run, &sound, &edges.twin, |t| {
        let corners = t.map(|v| mesh.points[v as usize]);
        measure(corners, Some(plane.doubled_area(t).approximate()))
    });
}

/// The domain as the checks need it, unless it has no definite inside.
fn derive_region(run: &mut Run<'_>, domain: Option<&Domain>) -> Option<Region> {
    let Some(domain) = domain else {
        run.skip(&DOMAIN_ONLY, "no domain was given");
        return None;
    };
    run.skip(&[Id::BowTie], "the domain's boundary decides");
    match domain::derive(domain) {
        Ok(region) => Some(region),
        Err(fault) => {
            let why = format!("the domain is not sound: {fault}");
            run.skip(&DOMAIN_ONLY, &why);
            run.could_not_run.push(why);
            None
        }
    }
}

/// The adjacency once duplicate triangles are left out, and the folded triangles as numbered then.
fn build_edges(
    sound: &mut Sound<'_>,
    oriented: &Oriented,
    out: &mut Collector<'_>,
) -> (Edges, Vec<u32>) {
    let edges = Edges::of(&sound.triangles, sound.mesh.points.len());
    let copies = topology::report_duplicates(sound, &edges, |_| false, out);
    if copies.is_empty() {
        return (edges, oriented.inverted.clone());
    }
    let renumbered = |&t: &u32| match copies.binary_search(&t) {
        Ok(_) => None,
        Err(before) => Some(t - before as u32),
    };
    let inverted = oriented.inverted.iter().filter_map(renumbered).collect();
    sound.remove(&copies);
    (Edges::of(&sound.triangles, sound.mesh.points.len()), inverted)
}

/// Checks M6, unless a triangle that names a wrong point may have meant one that seems unused.
pub(super) fn report_unused(run: &mut Run<'_>, sound: &Sound<'_>, concerned: &BTreeSet<u32>) {
    if run.out.has(Id::BadReference) || run.out.has(Id::RepeatedVertex) {
        run.skip(&[Id::UnusedVertex], "triangles with wrong references may have meant any point");
    } else {
        structure::report_unused(sound, concerned, &mut run.out);
    }
}

fn check_delaunay(run: &mut Run<'_>, covered: &Covered<'_>, region: Option<&Region>) {
    for (id, wanted) in [
        (Id::NotDelaunay, run.options.delaunay),
        (Id::NotConstrainedDelaunay, run.options.constrained_delaunay),
    ] {
        if wanted {
            delaunay::check(id, covered, region, &mut run.out);
        } else {
            run.skip(&[id], "not asked for");
        }
    }
}

/// The exact areas of mesh and domain; where the boundaries agree exactly, so must they.
fn describe_area(run: &mut Run<'_>, oriented: &Oriented, matched: &Match, region: Option<&Region>) {
    run.statistics.area = Some(half(&oriented.doubled_area));
    let Some(region) = region else { return };
    let at = |p: u32| region.points[p as usize];
    let edges = region.boundary.iter().map(|e| (at(e.from), at(e.to)));
    let doubled = super::along::polygon_area(edges);
    run.statistics.domain_area = Some(half(&doubled));
    let broken = [Id::BadReference, Id::RepeatedVertex, Id::NotFinite, Id::DuplicateTriangle];
    let complete = !broken.into_iter().any(|id| run.out.has(id));
    let equal = oriented.doubled_area.value() == doubled.value();
    if complete && matched.residual.is_empty() && matched.subdivided.is_empty() && !equal {
        run.could_not_run.push(
            "the exact area of the mesh contradicts its exact boundary: this is a fault of the checker"
                .to_owned(),
        );
    }
}

/// Half of an exact sum, as a number.
fn half(doubled: &ExactSum) -> ExactNumber {
    let (value, exponent) = doubled.value();
    let exponent = exponent - 1;
    let (f, e) = value.approximate();
    let rounded = ldexp(f, e + exponent);
    let exact = match exponent {
        _ if value == Wide::zero() => "0".to_owned(),
        0.. => value.shift_left(exponent.unsigned_abs()).to_string(),
        _ => format!("{value}/2^{}", exponent.unsigned_abs()),
    };
    ExactNumber { exact, rounded: rounded.is_finite().then_some(rounded) }
}

/// Quality of the sound triangles, and how many meet each gate.
pub(super) fn measure_quality(
    run: &mut Run<'_>,
    sound: &Sound<'_>,
    twin: &[u32],
    measure: impl Fn([u32; 3]) -> Measured + Sync,
) {
    let wanted =
        run.options.quality || !run.options.gates.is_empty() || run.options.baseline.is_some();
    if !wanted || sound.triangles.is_empty() {
        return;
    }
    let place = |t: u32| triangle_place(sound.mesh, sound.origin(t));
    let input = quality::Input { triangles: &sound.triangles, twin, measure, place: &place };
    run.quality = Some(quality::assess(&input, &run.options.gates));
}

impl<'a> Run<'a> {
    fn new(mesh: &'a MeshData, options: &'a CheckOptions) -> Self {
        let statistics = Statistics {
            points: mesh.points.len() as u64,
            triangles: mesh.triangles.len() as u64,
            decimal_digits: mesh.decimal_digits,
            other_cells: mesh.other_cells.clone(),
            ..Statistics::default()
        };
        Self {
            mesh,
            options,
            out: Collector::new(mesh, options.list_limit),
            statistics,
            not_checked: Vec::new(),
            could_not_run: Vec::new(),
            quality: None,
        }
    }

    /// Notes that ids were not checked; the first reason given for an id stands.
    pub(super) fn skip(&mut self, ids: &[Id], why: &str) {
        for &id in ids {
            if self.not_checked.iter().all(|entry| entry.id != id) {
                self.not_checked.push(NotChecked { id, why: why.to_owned() });
            }
        }
    }

    fn skip_all(&mut self, why: &str) {
        let geometric: Vec<Id> = Id::all()
            .filter(|&id| !matches!(id, Id::Empty | Id::GateMissed | Id::BaselineMissed))
            .collect();
        self.skip(&geometric, why);
        self.could_not_run.push(why.to_owned());
    }

    fn finish(mut self) -> Report {
        self.skip(&super::surface::SURFACE_IDS, "no surface model was given");
        let gates = self.judge_gates();
        self.judge_baseline();
        let allowed = |id: Id| self.options.allow.contains(&id);
        let (findings, counts) = self.out.finish(allowed);
        let verdict = if !self.could_not_run.is_empty() {
            Verdict::CouldNotRun
        } else if counts.iter().any(|entry| !entry.allowed) {
            Verdict::Failed
        } else {
            Verdict::Passed
        };
        self.not_checked.sort_by_key(|entry| entry.id);
        let skipped: BTreeSet<Id> = self.not_checked.iter().map(|entry| entry.id).collect();
        Report {
            schema: SCHEMA.to_owned(),
            verdict,
            could_not_run: self.could_not_run,
            findings,
            counts,
            checked: Id::all().filter(|id| !skipped.contains(id)).collect(),
            not_checked: self.not_checked,
            statistics: self.statistics,
            quality: self.quality.filter(|_| self.options.quality).map(|m| m.quality),
            gates,
        }
    }

    fn judge_gates(&mut self) -> Vec<super::GateResult> {
        if self.options.gates.is_empty() {
            self.skip(&[Id::GateMissed], "no gate was given");
        }
        let mut results = Vec::new();
        for (i, gate) in self.options.gates.iter().enumerate() {
            let result = match &self.quality {
                Some(measured) => gate.result(&measured.quality, measured.met[i]),
                None => gate.not_run(),
            };
            match result.outcome {
                GateOutcome::Held => {}
                GateOutcome::Missed => self.report_gate(gate, &result),
                GateOutcome::CouldNotRun => {
                    self.could_not_run.push(format!("the gate '{gate}' could not be evaluated"));
                }
            }
            results.push(result);
        }
        results
    }

    fn report_gate(&mut self, gate: &super::Gate, result: &super::GateResult) {
        let worst =
            self.quality.as_ref().and_then(|m| m.quality.summary(gate.metric)?.worst.first());
        let triangle = worst.map(|w| w.triangle.index);
        let text = format!(
            "{gate}: only {} of {} triangles do; the worst value is {}",
            result.met,
            result.total,
            result.worst.map_or_else(|| "infinite".to_owned(), |w| w.to_string())
        );
        self.out.add(Id::GateMissed, || {
            let draft = Draft::new(Id::GateMissed, text).triangles(triangle);
            draft
                .measured("worst", result.worst.unwrap_or(f64::INFINITY))
                .measured("bound", gate.bound)
        });
    }

    fn judge_baseline(&mut self) {
        let Some(baseline) = &self.options.baseline else {
            self.skip(&[Id::BaselineMissed], "no baseline was given");
            return;
        };
        let Some(measured) = &self.quality else {
            self.could_not_run.push("there is no quality to compare with the baseline".to_owned());
            return;
        };
        for r in baseline.compare(&measured.quality) {
            let show = |v: Option<f64>| v.map_or_else(|| "infinite".to_owned(), |v| v.to_string());
            self.out.add(Id::BaselineMissed, || {
                let text = format!(
                    "the {} {} was {}, now it is {}",
                    r.what,
                    r.metric,
                    show(r.then),
                    show(r.now)
                );
                Draft::new(Id::BaselineMissed, text)
                    .measured("baseline", r.then.unwrap_or(f64::INFINITY))
                    .measured("now", r.now.unwrap_or(f64::INFINITY))
            });
        }
    }
}
