//! `trigrade remesh`: a triangulated surface in, a checked one out.

use super::arguments::RemeshArguments;
use super::console::Console;
use super::failure::{Diagnostic, EXIT_FINDINGS, EXIT_HOLDS, Failure};
use super::forms::output_files;
use super::judged::{self, Judged, judge, paths, read_back};
use super::mesh_file::{self, Drawing, LoadedMesh, load_mesh};
use super::outcome::{Checked, Outcome, file_names};
use super::output::{Cleanup, Outputs};
use super::verdict::{self, Figures};
use super::watch::{Watch, seconds};
use super::words::{boundary, count};
use crate::check::{CheckOptions, Dimension, Id, Report, check};
use crate::format::MeshView;
use crate::mesh::MeshData;
use crate::remesh::{RemeshError, Remeshed, euler_number, remesh};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Duration;

/// New vertices lie within this fraction of the input's size of it.
const ON_SURFACE: f64 = 1e-9;

/// Runs the verb.
///
/// # Errors
/// Exit code 1: the input is no sound surface. Exit code 2: files, limits, options.
pub fn run(
    arguments: &RemeshArguments,
    console: &Console,
    cleanup: &Cleanup,
) -> Result<Outcome, Failure> {
    let mut watch = Watch::new(console);
    let files = output_files(&arguments.outputs, arguments.form.as_deref())?;
    watch.begin("read");
    let LoadedMesh { name, mesh, .. } = load_mesh(&arguments.mesh, &arguments.reading)?;
    refuse_other_cells(&name, &mesh)?;
    let mut outputs = Outputs::prepare(&paths(&files), cleanup)?;
    watch.begin("check input");
    let before = in_space(&mesh, false);
    if !before.passed() {
        return Ok(unsound(&name, before));
    }
    watch.begin("remesh");
    let remeshed = remesh(&mesh, &arguments.options()).map_err(|e| no_mesh(&name, &e))?;
    watch.begin("write");
    let drawing = Drawing::of(&remeshed.mesh, "");
    for (i, file) in files.iter().enumerate() {
        mesh_file::write(&mut outputs, i, file, MeshView::from(&remeshed.mesh), &drawing)?;
    }
    let mut summary = Summary {
        name,
        triangles: mesh.triangles.len(),
        remeshed,
        judged: None,
        written: Vec::new(),
    };
    if !arguments.no_check {
        watch.begin("read back");
        let meshes = read_back(&outputs, &files, MeshView::from(&summary.remeshed.mesh))?;
        watch.begin("check");
        let before = Before { mesh: &mesh, is_closed: before.statistics.boundary_edges == 0 };
        let each = |name: &str, mesh: &_| judged(name, mesh, &before, &summary.remeshed);
        summary.judged = Some(judge(&meshes, each));
    }
    if summary.exit() == EXIT_HOLDS {
        outputs.commit()?;
        summary.written = paths(&files);
    }
    Ok(summary.outcome(&watch.finish(), arguments.timings))
}

/// The surface as it was.
struct Before<'a> {
    mesh: &'a MeshData,
    is_closed: bool,
}

/// Cells that are no triangles would leave holes.
fn refuse_other_cells(name: &str, mesh: &MeshData) -> Result<(), Failure> {
    let is_surface = |kind: &str| kind.starts_with("quad") || kind.contains("poly");
    let Some(other) = mesh.other_cells.iter().find(|other| is_surface(&other.kind)) else {
        return Ok(());
    };
    let message = format!("the mesh has {} cells of the kind {}", count(other.count), other.kind);
    let help = "`--split-quads` cuts quadrilaterals in two";
    Err(Failure::cannot_run(Diagnostic::new(message).at(name).help(help)))
}

fn in_space(mesh: &MeshData, closed: bool) -> Report {
    let options = CheckOptions::new().dimension(Dimension::Space).closed(closed);
    check(mesh, None, &options.allow(Id::UnusedVertex))
}

/// What is told of an input that is no sound surface.
fn unsound(name: &str, report: Report) -> Outcome {
    let text = format!(
        "{}\n{name}: not remeshed, for it is no sound surface",
        verdict::findings(&report, name)
    );
    let json = json!({
        "schema": "trigrade-remesh/1",
        "verdict": "input-failed",
        "input": name,
        "check": report,
    });
    let checked = Some(Box::new(Checked { report, mesh: name.to_owned(), domain: None }));
    Outcome { exit: EXIT_FINDINGS, text, json, checked }
}

fn no_mesh(name: &str, error: &RemeshError) -> Failure {
    let diagnostic = Diagnostic::new(error.to_string()).at(name);
    match error {
        RemeshError::Option { .. } | RemeshError::TooMany { .. } | RemeshError::Budget(_) => {
            Failure::cannot_run(diagnostic)
        }
        _ => Failure::findings(vec![diagnostic]),
    }
}

/// The check of a new mesh, its Euler number, and what it does not keep of the old one.
fn judged(name: &str, mesh: &MeshData, input: &Before<'_>, remeshed: &Remeshed) -> Judged<i64> {
    let (euler, wanted) = (euler_number(&mesh.triangles), euler_number(&input.mesh.triangles));
    let mut judged = Judged::new(name, in_space(mesh, input.is_closed), euler);
    let mut complain = |message: String, rule| {
        judged.complaints.push(Diagnostic::new(message).rule(rule).at(name));
    };
    if euler != wanted {
        complain(format!("the Euler number is {euler}, that of the input {wanted}"), "U7");
    }
    let away = remeshed.deviation.vertices;
    if away > ON_SURFACE * remeshed.diagonal {
        complain(format!("a vertex is {away:e} off the input"), "U4");
    }
    judged
}

/// What is told of a run.
struct Summary {
    name: String,
    triangles: usize,
    remeshed: Remeshed,
    judged: Option<Judged<i64>>,
    written: Vec<PathBuf>,
}

impl Summary {
    fn exit(&self) -> u8 {
        judged::exit(self.judged.as_ref())
    }

    fn outcome(self, laps: &[(String, Duration)], timings: bool) -> Outcome {
        let (exit, text, json) = (self.exit(), self.text(laps, timings), self.json(laps));
        let checked = self.judged.as_ref().map(|judged| judged.checked(&self.name));
        Outcome { exit, text, json, checked }
    }

    fn text(&self, laps: &[(String, Duration)], timings: bool) -> String {
        let Remeshed { mesh, curves, corners, parts, deviation, .. } = &self.remeshed;
        let mut lines = vec![format!("{}: {} triangles", self.name, count(self.triangles as u64))];
        let mut line = |label: &str, text: String| lines.push(format!("  {label:<11}{text}"));
        line("features", format!("{parts} smooth parts, {curves} curves, {corners} corners"));
        let [triangles, points] =
            [mesh.triangles.len(), mesh.points.len()].map(|n| count(n as u64));
        line("remeshed", format!("{triangles} triangles, {points} points"));
        line(
            "deviation",
            format!(
                "of the new surface {:.3e}, of the old one {:.3e}",
                deviation.to_input, deviation.from_input
            ),
        );
        match &self.judged {
            Some(Judged { name, report, measured: euler, .. }) => {
                if let Some(figures) = Figures::of(report) {
                    line("quality", figures.to_string());
                }
                let boundary = boundary(report.statistics.boundary_edges);
                line("surface", format!("Euler number {euler}, {boundary}"));
                line("check", verdict::sentence(report, name));
            }
            None => line("check", "left out (--no-check)".into()),
        }
        lines.extend(judged::closing(self.judged.as_ref(), laps, timings, &self.written));
        lines.join("\n")
    }

    fn json(&self, laps: &[(String, Duration)]) -> Value {
        let Remeshed { mesh, curves, corners, parts, deviation, passes, .. } = &self.remeshed;
        let report = self.judged.as_ref().map(|judged| &judged.report);
        json!({
            "schema": "trigrade-remesh/1",
            "verdict": judged::word(self.judged.as_ref()),
            "input": self.name,
            "input_triangles": self.triangles,
            "triangles": mesh.triangles.len(),
            "points": mesh.points.len(),
            "features": { "parts": parts, "curves": curves, "corners": corners },
            "deviation": {
                "vertices": deviation.vertices,
                "to_input": deviation.to_input,
                "from_input": deviation.from_input,
            },
            "passes": {
                "splits": passes.splits,
                "collapses": passes.collapses,
                "flips": passes.flips,
                "moves": passes.moves,
            },
            "euler": self.judged.as_ref().map(|judged| judged.measured),
            "quality": report.and_then(Figures::of).map(|f| f.json()),
            "written": file_names(&self.written),
            "seconds": seconds(laps),
            "check": report,
        })
    }
}
