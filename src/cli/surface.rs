//! `trigrade mesh` on a surface model, and `trigrade check --surface`.

use super::arguments::{MeshArguments, Method};
use super::check::write_json;
use super::console::Console;
use super::domain_file::malformed;
use super::failure::{Diagnostic, EXIT_FINDINGS, EXIT_HOLDS, Failure};
use super::forms::{OutputFile, output_files};
use super::input::{Input, is_dash, load};
use super::mesh::{certify, count, paths, read_back};
use super::mesh_file::{self, Drawing};
use super::outcome::{Checked, Outcome, file_names, output_names};
use super::output::{Cleanup, Outputs};
use super::verdict::{self, Figures};
use super::watch::{Watch, seconds, stages, time, total};
use crate::check::certificate::FileHash;
use crate::check::surface::{SurfaceLimits, SurfaceReport, check_on_model};
use crate::check::{CheckOptions, Report};
use crate::format::MeshView;
use crate::format::model_file::{ModelForm, read_model};
use crate::mesh::MeshData;
use crate::mesher::Observer;
use crate::model::Model;
use crate::size::Prediction;
use crate::structured::GridMethod;
use crate::surface_mesher::{
    SurfaceMeshError, SurfaceMeshed, SurfaceMethod, SurfaceOptions, mesh_model,
};
use serde_json::{Value, json};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Whether the input of `trigrade mesh` is a surface model: as the user says, or a `.json` file
/// whose content says so.
///
/// # Errors
/// Exit code 2: the file cannot be read.
pub fn is_model(arguments: &MeshArguments) -> Result<bool, Failure> {
    let path = &arguments.domain;
    let is_one = |e: &OsStr| ["json", "bpt"].iter().any(|known| e.eq_ignore_ascii_case(known));
    match arguments.reading.from.as_deref() {
        Some(form) => Ok(ModelForm::from_name(form).is_some()),
        None if is_dash(path) || !path.extension().is_some_and(is_one) => Ok(false),
        None => Ok(ModelForm::of(path, &load(path)?.bytes).is_some()),
    }
}

/// Reads a surface model.
///
/// # Errors
/// Exit code 2: the file cannot be read or is malformed.
pub fn load_model(path: &Path, form: Option<&str>) -> Result<(Input, Model), Failure> {
    let input = load(path)?;
    let form = match form {
        Some(name) => ModelForm::from_name(name),
        None => ModelForm::of(path, &input.bytes),
    };
    let form = form.unwrap_or(ModelForm::Json);
    let model = read_model(&input.bytes, form).map_err(|error| malformed(&input.name, &error))?;
    Ok((input, model))
}

/// Meshes a surface model.
///
/// # Errors
/// Exit code 1: the model is wrong. Exit code 2: files, limits, options.
pub fn run(
    arguments: &MeshArguments,
    console: &Console,
    cleanup: &Cleanup,
) -> Result<Outcome, Failure> {
    let mut watch = Watch::new(console);
    let files = output_files(&arguments.outputs, arguments.form.as_deref())?;
    watch.begin("read");
    let (input, model) = load_model(&arguments.domain, arguments.reading.from.as_deref())?;
    let options = SurfaceOptions {
        common: arguments.options.options(),
        chord_error: arguments.on_surface.chord_error,
        angle_per_edge_deg: arguments.on_surface.angle_per_edge,
        method: method(arguments)?,
    };
    let mut targets = paths(&files);
    targets.extend(arguments.certificate.clone());
    let mut outputs = Outputs::prepare(&targets, cleanup)?;
    let mut summary =
        Summary { name: input.name.clone(), patches: model.patches.len(), ..Summary::default() };
    if arguments.dry_run {
        summary.prediction = Some(predict(&model, &options)?);
        return Ok(summary.outcome(&watch.finish(), arguments.timings));
    }
    let meshed = mesh_model(&model, &options, &mut watch).map_err(|e| no_mesh(&e))?;
    watch.begin("write");
    write_all(&mut outputs, &files, &meshed)?;
    if !arguments.no_check {
        watch.begin("read back");
        let meshes = read_back(&outputs, &files, MeshView::from(&meshed.mesh))?;
        watch.begin("check");
        let limits = SurfaceLimits::default();
        let verdict = check_all(&meshes, (&model, &limits));
        if arguments.certificate.is_some() {
            let plain = certify(&outputs, &files, Some((&verdict.name, &verdict.report)), None)?;
            let file = FileHash::of(&input.name, &[&input.bytes]);
            write_json(&mut outputs, files.len(), &plain.on_model(file, limits))?;
        }
        summary.check = Some(verdict);
    }
    summary.meshed = Some(meshed);
    if summary.exit() == EXIT_HOLDS {
        outputs.commit()?;
        summary.written = targets;
    }
    let laps = watch.finish();
    Ok(summary.outcome(&laps, arguments.timings))
}

/// How the patches are meshed.
fn method(arguments: &MeshArguments) -> Result<SurfaceMethod, Failure> {
    if arguments.options.corners.is_some() {
        let message = "--corners has a meaning for plane domains only: patches have their own";
        return Err(Failure::cannot_run(Diagnostic::new(message)));
    }
    Ok(match arguments.options.method {
        Method::Transfinite => SurfaceMethod::Grid(GridMethod::Transfinite),
        Method::Elliptic => SurfaceMethod::Grid(GridMethod::Elliptic),
        Method::DirectSurface => SurfaceMethod::Direct,
        _ => SurfaceMethod::Front,
    })
}

/// Stops the mesher as soon as it has predicted the number of triangles.
#[derive(Default)]
struct Predict {
    prediction: Option<Prediction>,
}

impl Observer for Predict {
    fn predicted(&mut self, prediction: Prediction) -> bool {
        self.prediction = Some(prediction);
        false
    }
}

fn predict(model: &Model, options: &SurfaceOptions) -> Result<Prediction, Failure> {
    let mut observer = Predict::default();
    let outcome = mesh_model(model, options, &mut observer);
    match (observer.prediction, outcome) {
        (Some(prediction), _) => Ok(prediction),
        (None, Err(error)) => Err(no_mesh(&error)),
        (None, Ok(_)) => unreachable!("the mesher predicts before it meshes"),
    }
}

fn no_mesh(error: &SurfaceMeshError) -> Failure {
    let diagnostic = Diagnostic::new(error.to_string());
    match error {
        SurfaceMeshError::Empty
        | SurfaceMeshError::Curve { .. }
        | SurfaceMeshError::Grid(_)
        | SurfaceMeshError::Outline { .. }
        | SurfaceMeshError::Trim { .. }
        | SurfaceMeshError::Flat { .. } => Failure::findings(vec![diagnostic]),
        SurfaceMeshError::Coarse { .. }
        | SurfaceMeshError::Stuck { .. }
        | SurfaceMeshError::TooMany { .. }
        | SurfaceMeshError::Front(_)
        | SurfaceMeshError::Options(_) => Failure::cannot_run(diagnostic),
    }
}

fn write_all(
    outputs: &mut Outputs,
    files: &[OutputFile],
    meshed: &SurfaceMeshed,
) -> Result<(), Failure> {
    let drawing = Drawing::of(&meshed.mesh, "");
    let view = MeshView::from(&meshed.mesh).with_parameters(&meshed.parameters);
    for (i, file) in files.iter().enumerate() {
        mesh_file::write(outputs, i, file, view, &drawing)?;
    }
    Ok(())
}

/// The checks of one mesh that was read back.
struct Verdict {
    name: String,
    report: Report,
    surface: SurfaceReport,
}

impl Verdict {
    fn passed(&self) -> bool {
        self.report.passed()
    }
}

/// Checks each mesh in space and against the model; the first that does not pass, or the first.
fn check_all(meshes: &[(String, MeshData)], on: (&Model, &SurfaceLimits)) -> Verdict {
    let mut first = None;
    for (name, mesh) in meshes {
        let (report, surface) = check_on_model(mesh, on, None, &CheckOptions::new());
        let verdict = Verdict { name: name.clone(), report, surface };
        if !verdict.passed() {
            return verdict;
        }
        first.get_or_insert(verdict);
    }
    first.expect("at least one mesh is read back")
}

/// What is told of a run.
#[derive(Default)]
struct Summary {
    name: String,
    patches: usize,
    prediction: Option<Prediction>,
    meshed: Option<SurfaceMeshed>,
    check: Option<Verdict>,
    written: Vec<PathBuf>,
}

impl Summary {
    fn exit(&self) -> u8 {
        let passed = self.check.as_ref().is_none_or(Verdict::passed);
        if passed { EXIT_HOLDS } else { EXIT_FINDINGS }
    }

    fn outcome(self, laps: &[(String, Duration)], timings: bool) -> Outcome {
        let checked = self.check.as_ref().map(|verdict| {
            let (report, mesh) = (verdict.report.clone(), verdict.name.clone());
            Box::new(Checked { report, mesh, domain: Some(self.name.clone()) })
        });
        Outcome {
            exit: self.exit(),
            text: self.text(laps, timings),
            json: self.json(laps),
            checked,
        }
    }

    fn text(&self, laps: &[(String, Duration)], timings: bool) -> String {
        let mut lines = vec![format!("{}: {} patches", self.name, count(self.patches as u64))];
        let mut line = |label: &str, text: String| lines.push(format!("  {label:<11}{text}"));
        let predicted = self.prediction.or(self.meshed.as_ref().map(|meshed| meshed.prediction));
        if let Some(prediction) = predicted {
            line("predicted", format!("{} triangles", count(prediction.triangles as u64)));
        }
        if let Some(SurfaceMeshed { mesh, patches, curves, .. }) = &self.meshed {
            let [triangles, points] =
                [mesh.triangles.len(), mesh.points.len()].map(|n| count(n as u64));
            line(
                "meshed",
                format!(
                    "{triangles} triangles, {points} points on {patches} smooth patches between {curves} curves"
                ),
            );
        }
        match &self.check {
            Some(verdict) => {
                if let Some(figures) = Figures::of(&verdict.report) {
                    line("quality", figures.to_string());
                }
                line("surface", measures(&verdict.surface));
                line("check", verdict::sentence(&verdict.report, &verdict.name));
            }
            None if self.meshed.is_some() => line("check", "left out (--no-check)".into()),
            None => {}
        }
        if timings {
            line("time", stages(laps));
        }
        line("total", time(total(laps)));
        if !self.written.is_empty() {
            line("written", output_names(&self.written));
        }
        if let Some(verdict) = self.check.as_ref().filter(|verdict| !verdict.passed()) {
            line("written", "nothing: the mesh did not pass its check".into());
            lines.push(verdict::findings(&verdict.report, &verdict.name));
        }
        lines.retain(|line| !line.is_empty());
        lines.join("\n")
    }

    fn json(&self, laps: &[(String, Duration)]) -> Value {
        let verdict = match &self.check {
            Some(verdict) if verdict.passed() => "passed",
            Some(_) => "failed",
            None => "not-checked",
        };
        let predicted = self.prediction.or(self.meshed.as_ref().map(|meshed| meshed.prediction));
        let report = self.check.as_ref().map(|verdict| &verdict.report);
        json!({
            "schema": "trigrade-mesh/1",
            "verdict": verdict,
            "domain": self.name,
            "predicted": predicted.map(|p| p.triangles),
            "points": self.meshed.as_ref().map(|meshed| meshed.mesh.points.len()),
            "triangles": self.meshed.as_ref().map(|meshed| meshed.mesh.triangles.len()),
            "quality": report.and_then(Figures::of).map(|f| f.json()),
            "surface": self.check.as_ref().map(|verdict| as_json(&verdict.surface)),
            "written": file_names(&self.written),
            "seconds": seconds(laps),
            "check": report,
        })
    }
}

/// The figures of a mesh against its surface.
fn measures(found: &SurfaceReport) -> String {
    let SurfaceReport { chord_error, normal_deviation_deg, euler, boundary_edges, .. } = found;
    let boundary = match boundary_edges {
        0 => "closed".to_owned(),
        n => format!("{} boundary edges", count(*n as u64)),
    };
    format!(
        "chord error {chord_error:.3e}, normals within {normal_deviation_deg:.2}°, Euler number {euler}, {boundary}"
    )
}

fn as_json(found: &SurfaceReport) -> Value {
    json!({
        "chord_error": found.chord_error,
        "vertex_error": found.vertex_error,
        "normal_deviation_deg": found.normal_deviation_deg,
        "euler": found.euler,
        "euler_of_model": found.euler_of_model,
        "boundary_edges": found.boundary_edges,
    })
}

/// Adds what was measured against a model to the outcome of a check.
pub fn tell(found: &SurfaceReport, outcome: &mut Outcome) {
    outcome.text.push_str(&format!("\n  {:<11}{}", "surface", measures(found)));
    outcome.json["surface"] = as_json(found);
}
