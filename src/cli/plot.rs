//! `trigrade plot`: a mesh in, pictures out, with what `check` finds when its domain is given.

use super::arguments::PlotArguments;
use super::convert::{outcome, write_files};
use super::domain_file::load_against;
use super::failure::{Diagnostic, Failure};
use super::forms::output_files;
use super::mesh_file::{Drawing, LoadedMesh, load_mesh};
use super::outcome::Outcome;
use super::output::Cleanup;
use super::size_layers::{NodalSpacing, nodal_spacing};
use super::verdict::check_mesh;
use crate::domain::Domain;
use crate::domain::validate::validate;
use crate::draw::{self, Highlight};
use crate::mesh::MeshData;
use crate::mesher::Options;
use std::path::Path;

/// Runs the verb.
///
/// # Errors
/// Exit code 2: files, forms that are no pictures, an empty window.
pub fn run(arguments: &PlotArguments, cleanup: &Cleanup) -> Result<Outcome, Failure> {
    let files = output_files(&arguments.outputs, arguments.form.as_deref())?;
    if let Some(file) = files.iter().find(|file| !file.form.is_picture()) {
        let diagnostic =
            Diagnostic::new("a picture is .svg, .png or .html").at(file.path.display());
        return Err(Failure::cannot_run(diagnostic.help("`trigrade convert` writes meshes")));
    }
    let LoadedMesh { name, path, mesh, .. } = load_mesh(&arguments.mesh, &arguments.reading)?;
    let file_name = || {
        let last = path.as_deref().and_then(Path::file_name);
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
