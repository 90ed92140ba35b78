//! Mesh files: reading with their companions, writing any form, pictures included.

use super::arguments::MeshReading;
use super::failure::{Diagnostic, EXIT_CANNOT_RUN, EXIT_FINDINGS, Failure};
use super::forms::{OutputFile, OutputForm, is_read, mesh_to_read};
use super::input::load;
use super::output::Outputs;
use super::size_layers::NodalSpacing;
use crate::check::Metric;
use crate::check::certificate::FileHash;
use crate::draw::{self, Background, DrawError, Highlight, Layer, Panel, View, Viewer};
use crate::format::mesh_json;
use crate::format::{
    At, Companion, MeshForm, MeshView, ReadError, ReadOptions, WriteError, read_mesh,
    write_companion, write_mesh,
};
use crate::mesh::MeshData;
use std::io;
use std::path::{Path, PathBuf};

/// A mesh that was read.
pub struct LoadedMesh {
    /// The path as the user gave it, or `<stdin>`.
    pub name: String,
    /// The path, unless the mesh came from standard input.
    pub path: Option<PathBuf>,
    /// The mesh.
    pub mesh: MeshData,
    /// The main file and those that belong to it, byte by byte.
    parts: Vec<Vec<u8>>,
}

impl LoadedMesh {
    /// The identity of the files read, all of them; only before [`LoadedMesh::forget_files`].
    #[must_use]
    pub fn hash(&self) -> FileHash {
        let parts: Vec<&[u8]> = self.parts.iter().map(Vec::as_slice).collect();
        FileHash::of(&self.name, &parts)
    }

    /// Frees what was read: the text of a mesh is larger than the mesh.
    pub fn forget_files(&mut self) {
        self.parts = Vec::new();
    }
}

/// Reads a mesh and the files that belong to it.
///
/// # Errors
/// Exit code 2: the file cannot be read, its form is not told, or it is malformed.
pub fn load_mesh(path: &Path, reading: &MeshReading) -> Result<LoadedMesh, Failure> {
    let said = reading.from.as_deref();
    let main = load(&main_of(path, said))?;
    let form = mesh_to_read(path, said, &main.bytes)?;
    let companions: Vec<(Companion, Vec<u8>)> = match &main.path {
        Some(path) => form.companions().iter().filter_map(|&c| beside(path, c)).collect(),
        None => Vec::new(),
    };
    let mesh = parse(&main.bytes, form, &companions, reading.split_quads)
        .map_err(|e| malformed(&main.name, &e))?;
    let companions = companions.into_iter().map(|(_, bytes)| bytes);
    let parts = [main.bytes].into_iter().chain(companions).collect();
    Ok(LoadedMesh { name: main.name, path: main.path, mesh, parts })
}

/// `a.node` names the pair whose main file is `a.ele`.
fn main_of(path: &Path, said: Option<&str>) -> PathBuf {
    let is_node = said.is_none() && path.extension().is_some_and(|e| e == "node");
    if is_node { path.with_extension("ele") } else { path.to_owned() }
}

/// A companion's bytes, if the file is there; the reader says which ones it cannot do without.
fn beside(main: &Path, companion: Companion) -> Option<(Companion, Vec<u8>)> {
    let mut paths = vec![main.with_extension(companion.extension())];
    if companion == Companion::Nodes {
        paths.push(main.with_extension("poly"));
    }
    paths.iter().find_map(|path| Some((companion, load(path).ok()?.bytes)))
}

/// Reads a mesh from bytes.
///
/// # Errors
/// The first fault.
pub fn parse(
    bytes: &[u8],
    form: MeshForm,
    companions: &[(Companion, Vec<u8>)],
    split_quads: bool,
) -> Result<MeshData, ReadError> {
    let of = |wanted| {
        companions.iter().find(|(companion, _)| *companion == wanted).map(|(_, b)| b.as_slice())
    };
    let options =
        ReadOptions { nodes: of(Companion::Nodes), edges: of(Companion::Edges), split_quads };
    read_mesh(bytes, form, &options)
}

/// Every written mesh that can be read, by name, read from its bytes when asked for; quadrilaterals,
/// which are written on demand only, as two triangles each.
pub fn written_meshes<'a>(
    outputs: &'a Outputs,
    files: &'a [OutputFile],
) -> impl Iterator<Item = Result<(String, MeshData), Failure>> + 'a {
    let mut companions: Vec<(Companion, Vec<u8>)> = Vec::new();
    files.iter().enumerate().filter_map(move |(i, file)| {
        let OutputForm::Mesh(form, _) = file.form else { return None };
        if !is_read(form) {
            return None;
        }
        let bytes = match outputs.read_back(i) {
            Ok(bytes) => bytes,
            Err(failure) => return Some(Err(failure)),
        };
        if let Some(companion) = file.companion {
            // Companions stand before their main file.
            companions.push((companion, bytes));
            return None;
        }
        let name = file.path.display().to_string();
        let mesh = parse(&bytes, form, &std::mem::take(&mut companions), true);
        Some(mesh.map_err(|e| unreadable(&name, &e)).map(|mesh| (name, mesh)))
    })
}

/// A file that was written and cannot be read back is a fault of this program.
#[must_use]
pub fn unreadable(name: &str, error: &ReadError) -> Failure {
    let mut failure = malformed(name, error);
    failure.exit = EXIT_FINDINGS;
    failure.diagnostics[0].message.insert_str(0, "the written mesh cannot be read back: ");
    failure.diagnostics[0].helps.push("this is a fault of trigrade; nothing was written".into());
    failure
}

/// A reader's error as a complaint about the file `name`.
#[must_use]
pub fn malformed(name: &str, error: &ReadError) -> Failure {
    let file = error.file.trim_end_matches([':', ' ']);
    let name = if file.is_empty() { name.to_owned() } else { beside_name(name, file) };
    let place = match error.at {
        At::Line(line) => format!("{name}:{line}"),
        At::Byte(byte) => format!("{name} (byte {byte})"),
    };
    let diagnostic = Diagnostic::new(error.fault.to_string()).rule(error.rule()).at(place);
    Failure { exit: EXIT_CANNOT_RUN, diagnostics: vec![diagnostic] }
}

/// The companion's name, from that of the main file and the companion's extension.
fn beside_name(main: &str, extension: &str) -> String {
    let path = Path::new(main).with_extension(extension.trim_start_matches('.'));
    path.display().to_string()
}

/// Writes one file of an output into its stage.
///
/// # Errors
/// Exit code 2 when the mesh cannot be written in this form, or the disk refuses.
pub fn write(
    outputs: &mut Outputs,
    index: usize,
    file: &OutputFile,
    mesh: MeshView<'_>,
    drawing: &Drawing<'_>,
) -> Result<(), Failure> {
    // What the form refuses must not be told as a fault of the disk.
    let mut refusal = None;
    let written = outputs.fill(index, |out| {
        let outcome = match (file.form, file.companion) {
            (OutputForm::Mesh(..), Some(companion)) => {
                write_companion(mesh, companion, out).map_err(Refusal::from)
            }
            (OutputForm::Mesh(form, options), None) => {
                write_mesh(mesh, form, options, out).map_err(Refusal::from)
            }
            (OutputForm::Json, _) if mesh.has_quads() => {
                Err(Refusal::Form("this JSON cannot carry the quadrilaterals of a grid".into()))
            }
            (OutputForm::Json, _) => mesh_json::write(mesh, out).map_err(Refusal::from),
            (OutputForm::Svg, _) => drawing
                .svg()
                .map_err(Refusal::from)
                .and_then(|svg| out.write_all(svg.as_bytes()).map_err(Refusal::Disk)),
            (OutputForm::Png, _) => drawing
                .png()
                .map_err(Refusal::from)
                .and_then(|png| out.write_all(&png).map_err(Refusal::Disk)),
            (OutputForm::Html, _) => drawing
                .html(&file_name(&file.path))
                .map_err(Refusal::from)
                .and_then(|html| out.write_all(html.as_bytes()).map_err(Refusal::Disk)),
        };
        match outcome {
            Ok(()) => Ok(()),
            Err(Refusal::Disk(error)) => Err(error),
            Err(Refusal::Form(message)) => {
                refusal = Some(message);
                Ok(())
            }
        }
    });
    match refusal {
        Some(message) => Err(Failure::cannot_run(Diagnostic::new(message).at(file.path.display()))),
        None => written,
    }
}

/// The last part of a path, for people.
fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// Why a file was not written.
enum Refusal {
    /// The disk.
    Disk(io::Error),
    /// The form or the picture.
    Form(String),
}

impl From<WriteError> for Refusal {
    fn from(error: WriteError) -> Self {
        match error {
            WriteError::Io(error) => Self::Disk(error),
            other => Self::Form(other.to_string()),
        }
    }
}

impl From<DrawError> for Refusal {
    fn from(error: DrawError) -> Self {
        Self::Form(error.to_string())
    }
}

/// What a picture of a mesh shows.
#[derive(Clone, Debug)]
pub struct Drawing<'a> {
    /// The mesh.
    pub mesh: &'a MeshData,
    /// A line above it.
    pub title: String,
    /// The part to draw; `None` draws everything.
    pub view: Option<View>,
    /// Width in CSS pixels.
    pub width: f64,
    /// What it points at.
    pub highlights: Vec<Highlight>,
    /// The metric that colours it; `None` leaves it without colours.
    pub colour: Option<Metric>,
    /// Further values of the triangles, for the viewer.
    pub layers: Vec<Layer>,
    /// The background mesh with its spacings, for the viewer.
    pub background: Option<NodalSpacing>,
}

impl<'a> Drawing<'a> {
    /// All of `mesh`.
    #[must_use]
    pub fn of(mesh: &'a MeshData, title: impl Into<String>) -> Self {
        Self {
            mesh,
            title: title.into(),
            view: None,
            width: draw::Options::default().width,
            highlights: Vec::new(),
            colour: Some(Metric::RadiusRatio),
            layers: Vec::new(),
            background: None,
        }
    }

    fn options(&self) -> draw::Options {
        draw::Options { width: self.width, ..draw::Options::default() }
    }

    /// Surfaces in space are drawn in perspective, unless a window of the plane is asked for.
    fn is_in_space(&self) -> bool {
        self.view.is_none() && self.highlights.is_empty() && draw::is_in_space(self.mesh)
    }

    /// The values that colour it.
    fn layer(&self) -> Option<Layer> {
        match self.colour? {
            // Signed areas play no part in it, so that broken meshes are drawn as usual.
            Metric::RadiusRatio => Some(Layer::radius_ratio(self.mesh)),
            other => Some(Layer::metric(self.mesh, other)),
        }
    }

    fn panel<'b>(&'b self, layer: Option<&'b Layer>) -> Panel<'b> {
        let mut panel = Panel { layer, ..Panel::new(self.mesh, self.title.clone()) };
        panel.highlights = &self.highlights;
        match self.view {
            Some(view) => panel.cropped(view),
            None => panel,
        }
    }

    /// As SVG: coloured by a metric, or a surface in space shaded.
    ///
    /// # Errors
    /// A view or page that cannot be drawn.
    pub fn svg(&self) -> Result<String, DrawError> {
        if self.is_in_space() {
            return Ok(draw::perspective(self.mesh, &self.title, &self.options())?.0);
        }
        let layer = self.layer();
        draw::svg(&[self.panel(layer.as_ref())], &self.options())
    }

    /// As PNG, likewise.
    ///
    /// # Errors
    /// A view or page that cannot be drawn.
    pub fn png(&self) -> Result<Vec<u8>, DrawError> {
        if self.is_in_space() {
            return draw::perspective_png(self.mesh, &self.title, &self.options());
        }
        let layer = self.layer();
        draw::png(&[self.panel(layer.as_ref())], &self.options())
    }

    /// As a viewer in one HTML file, which is called `name` unless there is a title.
    ///
    /// # Errors
    /// None that a mesh alone can give.
    pub fn html(&self, name: &str) -> Result<String, DrawError> {
        let title = if self.title.is_empty() { name } else { &self.title };
        let background = self.background.as_ref();
        let viewer = Viewer {
            highlights: &self.highlights,
            layers: &self.layers,
            background: background.map(|b| Background { mesh: &b.mesh, spacing: &b.spacing }),
            ..Viewer::new(title, self.mesh)
        };
        draw::html(&viewer)
    }
}
