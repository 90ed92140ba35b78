//! `trigrade convert`: a mesh in, files out, nothing changed.

use super::arguments::ConvertArguments;
use super::console::Console;
use super::failure::{Diagnostic, EXIT_HOLDS, Failure};
use super::forms::{OutputFile, OutputForm, output_files};
use super::judged::paths;
use super::mesh_file::{Drawing, LoadedMesh, load_mesh, write};
use super::outcome::Outcome;
use super::output::{Cleanup, Outputs};
use super::words::count;
use crate::format::MeshView;
use crate::mesh::MeshData;
use serde_json::json;

/// Runs the verb.
///
/// # Errors
/// Exit code 2: files, forms, or a mesh that cannot be carried over without loss.
pub fn run(
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

/// Writes the mesh and its pictures, all or none.
///
/// # Errors
/// Exit code 2: a form that cannot carry the mesh, or the disk.
pub fn write_files(
    files: &[OutputFile],
    mesh: &MeshData,
    drawing: &Drawing<'_>,
    cleanup: &Cleanup,
) -> Result<(), Failure> {
    let mut outputs = Outputs::prepare(&paths(files), cleanup)?;
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

/// What is told of files written from a mesh, and what they have no place for.
#[must_use]
pub fn outcome(name: &str, mesh: &MeshData, files: &[OutputFile]) -> Outcome {
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
