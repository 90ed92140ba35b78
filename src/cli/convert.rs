//! `trigrade convert` and `trigrade plot`: a mesh in, files out, nothing changed.

use super::arguments::{ConvertArguments, PlotArguments};
use super::console::Console;
use super::domain_file::load_against;
use super::failure::{Diagnostic, EXIT_HOLDS, Failure};
use super::forms::{OutputFile, OutputForm, output_files};
use super::mesh_file::{Drawing, LoadedMesh, load_mesh, write};
use super::outcome::Outcome;
use super::output::{Cleanup, Outputs};
use super::size_layers::{NodalSpacing, nodal_spacing};
use super::verdict::check_mesh;
use super::words::count;
use crate::domain::Domain;
use crate::domain::validate::validate;
use crate::draw::{self, Highlight};
use crate::format::MeshView;
use crate::mesh::MeshData;
use crate::mesher::Options;
use serde_json::json;
use std::path::PathBuf;

/// Runs `trigrade convert`.
///
/// # Errors
/// Exit code 2: files, forms, or a mesh that cannot be carried over without loss.
pub fn convert(
    arguments: &ConvertArguments,
    console: &Console,
    cleanup: &Cleanup,
) -> Result<Outcome, Failure> {
    let files = output_files(&arguments.outputs, arguments.form.as_deref())?;
    let LoadedMesh { name, mesh, .. } = load_mesh(&arguments.mesh, &arguments.reading)?;
    refuse_bad_references(&name, &mesh)?;
    for other in &mesh.other_cells {
        console.detail(&format!("left out: {} {}", other.count, other.kind));
    }
    let drawing = Drawing::of(&mesh, "");
    write_files(&files, &mesh, &drawing, cleanup)?;
    Ok(outcome(&name, &mesh, &files))
}

/// Runs `trigrade plot`.
///
/// # Errors
/// Exit code 2: files, forms that are no pictures, an empty window.
pub fn plot(arguments: &PlotArguments, cleanup: &Cleanup) -> Result<Outcome, Failure> {
    let files = output_files(&arguments.outputs, arguments.form.as_deref())?;
    if let Some(file) = files.iter().find(|file| !file.form.is_picture()) {
        let diagnostic =
            Diagnostic::new("a picture is .svg, .png or .html").at(file.path.display());
        return Err(Failure::cannot_run(diagnostic.help("`trigrade convert` writes meshes")));
    }
    let LoadedMesh { name, path, mesh, .. } = load_mesh(&arguments.mesh, &arguments.reading)?;
    let file_name = || {
        let last = path.as_deref().and_then(std::path::Path::file_name);
        last.map_or_else(|| name.clone(), |last| last.to_string_lossy().into_owned())
    };
    let title = arguments.title.clone().unwrap_or_else(file_name);
    let (highlights, background) = match load_against(&arguments.against)? {
        Some((_, domain)) => against(&mesh, &domain),
        None => (Vec::new(), None),
    };
    let drawing = Drawing {
        view: arguments.window,
        width: f64::from(arguments.width),
        colour: arguments.colour.0,
        highlights,
        background,
        ..Drawing::of(&mesh, title)
    };
    write_files(&files, &mesh, &drawing, cleanup)?;
    Ok(outcome(&name, &mesh, &files))
}

/// The findings of a mesh against its domain, and the domain's background mesh.
fn against(mesh: &MeshData, domain: &Domain) -> (Vec<Highlight>, Option<NodalSpacing>) {
    let report = check_mesh(mesh, Some(domain));
    let background = validate(domain).ok().and_then(|plc| nodal_spacing(plc, &Options::default()));
    (draw::highlights(&report), background)
}

fn write_files(
    files: &[OutputFile],
    mesh: &MeshData,
    drawing: &Drawing<'_>,
    cleanup: &Cleanup,
) -> Result<(), Failure> {
    let paths: Vec<PathBuf> = files.iter().map(|file| file.path.clone()).collect();
    let mut outputs = Outputs::prepare(&paths, cleanup)?;
    for (i, file) in files.iter().enumerate() {
        write(&mut outputs, i, file, MeshView::from(mesh), drawing)?;
    }
    outputs.commit()
}

/// A triangle that names no point cannot be written in another form.
fn refuse_bad_references(name: &str, mesh: &MeshData) -> Result<(), Failure> {
    let Some(bad) = mesh.bad_references.first() else { return Ok(()) };
    let message = format!(
        "triangle {} names point {}, which does not exist ({} such reference(s) in all)",
        bad.triangle,
        bad.value,
        mesh.bad_references.len()
    );
    let help = format!("`trigrade check {name}` names all of them");
    Err(Failure::cannot_run(Diagnostic::new(message).at(name).help(help)))
}

fn outcome(name: &str, mesh: &MeshData, files: &[OutputFile]) -> Outcome {
    let paths: Vec<String> = files.iter().map(|file| file.path.display().to_string()).collect();
    let triangles = mesh.triangles.len();
    let dropped = files.iter().filter_map(|file| match (file.form, file.companion) {
        (OutputForm::Mesh(form, _), None) => Some((form, MeshView::from(mesh).dropped_by(form))),
        _ => None,
    });
    let lost: String = dropped
        .filter(|(_, what)| !what.is_empty())
        .map(|(form, what)| {
            format!("\n  left out, for {form} has no place for it: {}", what.join(", "))
        })
        .collect();
    Outcome {
        exit: EXIT_HOLDS,
        text: format!(
            "{name}: {} triangles -> {}{lost}",
            count(triangles as u64),
            paths.join(", ")
        ),
        json: json!({
            "schema": "trigrade-convert/1",
            "input": name,
            "points": mesh.points.len(),
            "triangles": triangles,
            "written": paths,
        }),
        checked: None,
    }
}
