//! The viewer: one HTML file with the mesh and everything that shows it, and no network.
//!
//! Rust writes the data (little-endian arrays in base64) and a few facts in JSON; the scripts in
//! `viewer/` compute measures, draw by WebGL 2 (or a plain canvas) and run the side panel. They
//! are joined in the order of [`SCRIPTS`] into one scope.

use super::{DrawError, Highlight, Layer, Palette, check_layer, text};
use crate::mesh::MeshData;
use base64::prelude::{BASE64_STANDARD, Engine as _};
use serde_json::json;
use std::fmt::Write as _;

const TEMPLATE: &str = include_str!("viewer/viewer.html");
const CSS: &str = include_str!("viewer/viewer.css");
const SCRIPTS: [&str; 6] = [
    include_str!("viewer/data.js"),
    include_str!("viewer/measures.js"),
    include_str!("viewer/camera.js"),
    include_str!("viewer/webgl.js"),
    include_str!("viewer/canvas2d.js"),
    include_str!("viewer/main.js"),
];

/// What the viewer shows.
///
/// The usual measures (R/(2r), angles, edge ratio, area, area ratio to neighbours) are computed
/// by the viewer; `layers` adds further ones. Playback lays the triangles in the mesh's order,
/// which for a mesh of the front is the order in which they were laid.
#[derive(Clone, Copy, Debug)]
pub struct Viewer<'a> {
    /// Heading and window title.
    pub title: &'a str,
    /// The mesh, in the plane or (if some z is not 0) in space.
    pub mesh: &'a MeshData,
    /// Further values of the triangles; the first one is shown first.
    pub layers: &'a [Layer],
    /// Findings: listed, marked, and zoomed to on a click.
    pub highlights: &'a [Highlight],
    /// The background mesh with its size field.
    pub background: Option<Background<'a>>,
    /// Colours at the start.
    pub palette: Palette,
}

/// A background mesh as a layer of the viewer.
#[derive(Clone, Copy, Debug)]
pub struct Background<'a> {
    /// Its points and triangles.
    pub mesh: &'a MeshData,
    /// The size field: the wanted edge length at each of its points, or empty.
    pub spacing: &'a [f64],
}

impl<'a> Viewer<'a> {
    /// A viewer of a mesh alone.
    #[must_use]
    pub fn new(title: &'a str, mesh: &'a MeshData) -> Self {
        Self {
            title,
            mesh,
            layers: &[],
            highlights: &[],
            background: None,
            palette: Palette::default(),
        }
    }
}

/// Writes the viewer as one HTML document that loads nothing.
///
/// What it shows first can be chosen after `#` in its address, e.g.
/// `view.html#measure=min_angle&view=0,0,1,1&show=background&triangle=12`; the keys are `measure`
/// (`radius_ratio`, `min_angle`, `max_angle`, `edge_ratio`, `area`, `area_ratio`, `edge_length`,
/// `order`, `layer-0`, ...), `palette`, `view`, `triangle`, `finding` (from 1), `frame`, `show`,
/// `hide` and `renderer=canvas`.
///
/// # Errors
/// [`DrawError::ValueCount`] when a layer does not fit the mesh, and [`DrawError::SpacingCount`]
/// when the size field does not fit the background mesh.
///
/// # Complexity
/// O(n); about 27 bytes a triangle in the plane, 10 more for each layer.
pub fn html(viewer: &Viewer<'_>) -> Result<String, DrawError> {
    viewer.layers.iter().try_for_each(|layer| check_layer(0, layer, viewer.mesh))?;
    if let Some(Background { mesh, spacing }) = viewer.background
        && !spacing.is_empty()
        && spacing.len() != mesh.points.len()
    {
        return Err(DrawError::SpacingCount { values: spacing.len(), points: mesh.points.len() });
    }
    Ok(fill(&[
        ("title", &text::escape(viewer.title)),
        ("css", CSS),
        ("meta", &meta(viewer)),
        ("data", &data(viewer)),
        ("js", &SCRIPTS.concat()),
    ]))
}

/// The template with each `{{key}}` replaced by its value, in the order of the template; values
/// are not searched again.
fn fill(values: &[(&str, &str)]) -> String {
    let length: usize = values.iter().map(|v| v.1.len()).sum();
    let mut out = String::with_capacity(TEMPLATE.len() + length);
    let mut rest = TEMPLATE;
    for (key, value) in values {
        let (before, after) = rest.split_once(&format!("{{{{{key}}}}}")).unwrap_or((rest, ""));
        out.push_str(before);
        out.push_str(value);
        rest = after;
    }
    out.push_str(rest);
    out
}

/// Facts in JSON, fit to stand inside a script element.
fn meta(viewer: &Viewer<'_>) -> String {
    let layers: Vec<_> = viewer
        .layers
        .iter()
        .map(|l| json!({ "name": l.name, "range": l.range, "better": l.better }))
        .collect();
    let palettes: serde_json::Map<_, _> =
        Palette::ALL.iter().map(|p| (p.name().to_owned(), json!(p.stops()))).collect();
    let background = viewer.background.map(|b| json!({ "dimension": dimension(b.mesh) }));
    let meta = json!({
        "title": viewer.title,
        "dimension": dimension(viewer.mesh),
        "layers": layers,
        "highlights": viewer.highlights,
        "background": background,
        "palette": viewer.palette.name(),
        "palettes": palettes,
    });
    // "<" only occurs inside strings of JSON; escaped, no text can end the element.
    meta.to_string().replace('<', "\\u003c")
}

/// 3 when some point leaves the plane, else 2.
fn dimension(mesh: &MeshData) -> u8 {
    if mesh.points.iter().any(|p| p[2] != 0.0 && !p[2].is_nan()) { 3 } else { 2 }
}

/// The arrays, each in an element of its own.
fn data(viewer: &Viewer<'_>) -> String {
    let mesh = viewer.mesh;
    let mut out = String::new();
    push_points(&mut out, "points", mesh);
    push_triangles(&mut out, "triangles", mesh);
    let ends = mesh.edges.iter().flat_map(|e| e.vertices);
    push(&mut out, "edges", ends.flat_map(u32::to_le_bytes).collect());
    let numbers = mesh.triangle_numbers.iter().map(|&n| n as f64);
    push(&mut out, "numbers", numbers.flat_map(f64::to_le_bytes).collect());
    for (i, layer) in viewer.layers.iter().enumerate() {
        push_doubles(&mut out, &format!("layer-{i}"), &layer.values);
    }
    if let Some(background) = viewer.background {
        push_points(&mut out, "background-points", background.mesh);
        push_triangles(&mut out, "background-triangles", background.mesh);
        push_doubles(&mut out, "spacing", background.spacing);
    }
    out
}

fn push_points(out: &mut String, id: &str, mesh: &MeshData) {
    let dimension = usize::from(dimension(mesh));
    let coordinates = mesh.points.iter().flat_map(|p| &p[..dimension]);
    push(out, id, coordinates.flat_map(|x| x.to_le_bytes()).collect());
}

fn push_triangles(out: &mut String, id: &str, mesh: &MeshData) {
    push(out, id, mesh.triangles.iter().flatten().flat_map(|v| v.to_le_bytes()).collect());
}

fn push_doubles(out: &mut String, id: &str, values: &[f64]) {
    push(out, id, values.iter().flat_map(|x| x.to_le_bytes()).collect());
}

/// An array as base64 in an element that browsers do not run; nothing when it is empty.
fn push(out: &mut String, id: &str, bytes: Vec<u8>) {
    if bytes.is_empty() {
        return;
    }
    let _ = write!(out, "<script type=\"text/plain\" id=\"data-{id}\">");
    BASE64_STANDARD.encode_string(&bytes, out);
    out.push_str("</script>\n");
}
