//! `trigrade mesh` on a surface model, and `trigrade check --surface`.

use super::arguments::{MeshArguments, Method};
use super::check::write_json;
use super::console::Console;
use super::domain_file::malformed;
use super::failure::{Diagnostic, EXIT_HOLDS, Failure};
use super::forms::{OutputFile, output_files};
use super::input::{Input, is_dash, load};
use super::judged::{self, Judged, certify, judge, paths, read_back};
use super::mesh_file::{self, Drawing};
use super::outcome::{Outcome, file_names};
use super::output::{Cleanup, Outputs};
use super::quads;
use super::surface_options::{demand_on_model, demand_slope_of_use};
use super::verdict::{self, Figures};
use super::watch::{Watch, prediction, seconds};
use super::words::{boundary, count};
use crate::check::CheckOptions;
use crate::check::certificate::FileHash;
use crate::check::surface::{SurfaceLimits, SurfaceReport, check_on_model};
use crate::format::MeshView;
use crate::format::model_file::{ModelForm, read_model};
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
    let known = ["json", "bpt", "igs", "iges", "step", "stp", "p21"];
    let is_one = |e: &OsStr| known.iter().any(|known| e.eq_ignore_ascii_case(known));
    refuse_step(path)?;
    match arguments.reading.from.as_deref() {
        Some(form) => Ok(ModelForm::from_name(form).is_some()),
        None if is_dash(path) || !path.extension().is_some_and(is_one) => Ok(false),
        None => Ok(ModelForm::of(path, &load(path)?.bytes).is_some()),
    }
}

/// Without the feature `step`, STEP files are not read; what to do instead is said before anything is
/// tried.
fn refuse_step(path: &Path) -> Result<(), Failure> {
    if cfg!(feature = "step") { Ok(()) } else { demand_no_step(path) }
}

fn demand_no_step(path: &Path) -> Result<(), Failure> {
    let is_step = |e: &OsStr| ["step", "stp", "p21"].iter().any(|k| e.eq_ignore_ascii_case(k));
    if !path.extension().is_some_and(is_step) {
        return Ok(());
    }
    let diagnostic = Diagnostic::new("STEP files are not read").rule("X71").at(path.display());
    let help = "a build with `--features step` reads them; or export the surfaces as IGES (trimmed \
                surfaces, not solids), or as NURBS in JSON; a mesh of the part, as STL or OBJ, goes \
                through `trigrade remesh`";
    Err(Failure::cannot_run(diagnostic.help(help)))
}

/// Reads a surface model; with `weld`, curves that agree within it are made one.
///
/// # Errors
/// Exit code 2: the file cannot be read or is malformed.
pub fn load_model(
    path: &Path,
    form: Option<&str>,
    weld: Option<f64>,
) -> Result<(Input, Model), Failure> {
    refuse_step(path)?;
    let input = load(path)?;
    let form = match form {
        Some(name) => ModelForm::from_name(name),
        None => ModelForm::of(path, &input.bytes),
    };
    let form = form.unwrap_or(ModelForm::Json);
    let mut model =
        read_model(&input.bytes, form).map_err(|error| malformed(&input.name, &error))?;
    if let Some(tolerance) = weld {
        model.weld(tolerance);
    }
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
    let quads = quads::wanted(&arguments.options)?;
    demand_on_model(arguments)?;
    let files = output_files(&arguments.outputs, arguments.form.as_deref())?;
    watch.begin("read");
    let (input, model) = load_model(
        &arguments.domain,
        arguments.reading.from.as_deref(),
        arguments.on_surface.weld,
    )?;
    let options = SurfaceOptions {
        common: arguments.options.options(),
        chord_error: arguments.on_surface.chord_error,
        angle_per_edge_deg: arguments.on_surface.angle_per_edge,
        method: method(arguments.options.method),
    };
    demand_slope_of_use(arguments, &model)?;
    let mut targets = paths(&files);
    targets.extend(arguments.certificate.clone());
    let mut outputs = Outputs::prepare(&targets, cleanup)?;
    let mut summary =
        Summary { name: input.name.clone(), patches: model.patches.len(), ..Summary::default() };
    summary.notes.clone_from(&model.notes);
    if arguments.dry_run {
        let predicted = prediction(|observer| mesh_model(&model, &options, observer));
        summary.prediction = Some(predicted.map_err(|e| no_mesh(&e))?);
        return Ok(summary.outcome(&watch.finish(), arguments.timings));
    }
    let mut meshed = mesh_model(&model, &options, &mut watch).map_err(|e| no_mesh(&e))?;
    if quads {
        quads::pair(&mut meshed.mesh.triangles[..2 * meshed.cells], None)?;
    }
    watch.begin("write");
    write_all(&mut outputs, &files, (&meshed, quads))?;
    if !arguments.no_check {
        watch.begin("read back");
        let meshes = read_back(&outputs, &files, MeshView::from(&meshed.mesh))?;
        watch.begin("check");
        let limits = SurfaceLimits::default();
        let judged = judge(&meshes, |name, mesh| {
            let options = CheckOptions::new();
            let (report, found) = check_on_model(mesh, (&model, &limits), None, &options);
            Judged::new(name, report, found)
        });
        if arguments.certificate.is_some() {
            let plain = certify(&outputs, &files, &judged, None)?;
            let file = FileHash::of(&input.name, &[&input.bytes]);
            write_json(&mut outputs, files.len(), &plain.on_model(file, limits))?;
        }
        summary.judged = Some(judged);
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
fn method(method: Method) -> SurfaceMethod {
    match method {
        Method::Transfinite => SurfaceMethod::Grid(GridMethod::Transfinite),
        Method::Elliptic => SurfaceMethod::Grid(GridMethod::Elliptic),
        Method::DirectSurface => SurfaceMethod::Direct,
        // Others are refused before.
        _ => SurfaceMethod::Front,
    }
}

fn no_mesh(error: &SurfaceMeshError) -> Failure {
    let diagnostic = Diagnostic::new(error.to_string());
    match error {
        SurfaceMeshError::Empty
        | SurfaceMeshError::Cusp { .. }
        | SurfaceMeshError::Curve { .. }
        | SurfaceMeshError::Grid(_)
        | SurfaceMeshError::Outline { .. }
        | SurfaceMeshError::Trim { .. }
        | SurfaceMeshError::Flat { .. } => Failure::findings(vec![diagnostic]),
        SurfaceMeshError::Coarse { .. }
        | SurfaceMeshError::Stuck { .. }
        | SurfaceMeshError::TooMany { .. }
        | SurfaceMeshError::Front(_)
        | SurfaceMeshError::Gradation(_)
        | SurfaceMeshError::PlaneGradation(_)
        | SurfaceMeshError::NoSpacing { .. }
        | SurfaceMeshError::Options(_) => Failure::cannot_run(diagnostic),
    }
}

fn write_all(
    outputs: &mut Outputs,
    files: &[OutputFile],
    (meshed, quads): (&SurfaceMeshed, bool),
) -> Result<(), Failure> {
    let drawing = Drawing::of(&meshed.mesh, "");
    let view = MeshView::from(&meshed.mesh).with_parameters(&meshed.parameters);
    let view = quads::view(view, quads.then_some(meshed.cells));
    for (i, file) in files.iter().enumerate() {
        mesh_file::write(outputs, i, file, view, &drawing)?;
    }
    Ok(())
}

/// What is told of a run.
#[derive(Default)]
struct Summary {
    name: String,
    patches: usize,
    /// What the reader of the model wants to be told.
    notes: Vec<String>,
    prediction: Option<Prediction>,
    meshed: Option<SurfaceMeshed>,
    judged: Option<Judged<SurfaceReport>>,
    written: Vec<PathBuf>,
}

impl Summary {
    fn exit(&self) -> u8 {
        judged::exit(self.judged.as_ref())
    }

    fn outcome(self, laps: &[(String, Duration)], timings: bool) -> Outcome {
        let checked = self.judged.as_ref().map(|judged| judged.checked(&self.name));
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
        self.notes.iter().for_each(|note| line("note", note.clone()));
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
        match &self.judged {
            Some(Judged { name, report, measured, .. }) => {
                if let Some(figures) = Figures::of(report) {
                    line("quality", figures.to_string());
                }
                line("surface", measures(measured));
                line("check", verdict::sentence(report, name));
            }
            None if self.meshed.is_some() => line("check", "left out (--no-check)".into()),
            None => {}
        }
        lines.extend(judged::closing(self.judged.as_ref(), laps, timings, &self.written));
        lines.join("\n")
    }

    fn json(&self, laps: &[(String, Duration)]) -> Value {
        let predicted = self.prediction.or(self.meshed.as_ref().map(|meshed| meshed.prediction));
        let report = self.judged.as_ref().map(|judged| &judged.report);
        json!({
            "schema": "trigrade-mesh/1",
            "verdict": judged::word(self.judged.as_ref()),
            "domain": self.name,
            "notes": self.notes,
            "predicted": predicted.map(|p| p.triangles),
            "points": self.meshed.as_ref().map(|meshed| meshed.mesh.points.len()),
            "triangles": self.meshed.as_ref().map(|meshed| meshed.mesh.triangles.len()),
            "quality": report.and_then(Figures::of).map(|f| f.json()),
            "surface": self.judged.as_ref().map(|judged| as_json(&judged.measured)),
            "written": file_names(&self.written),
            "seconds": seconds(laps),
            "check": report,
        })
    }
}

/// The figures of a mesh against its surface.
fn measures(found: &SurfaceReport) -> String {
    let SurfaceReport { chord_error, normal_deviation_deg, euler, boundary_edges, .. } = found;
    let boundary = boundary(*boundary_edges as u64);
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

#[cfg(test)]
mod tests {
    use super::*;

    // spec: X71
    #[test]
    fn step_files_are_refused_with_what_to_do_instead() {
        for name in ["part.step", "part.STP", "a/b.p21"] {
            let failure = demand_no_step(Path::new(name)).expect_err(name);
            assert_eq!(failure.exit, 2, "{name}");
            let told = failure.diagnostics[0].to_string();
            assert!(told.contains("STEP files are not read") && told.contains("IGES"), "{told}");
            assert!(told.contains("--features step") && told.contains(name), "{told}");
        }
        assert!(demand_no_step(Path::new("step.json")).is_ok());
    }
}
