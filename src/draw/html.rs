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
const SCRIPTS: [&str; 7] = [
    include_str!("viewer/data.js"),
    include_str!("viewer/measures.js"),
    include_str!("viewer/camera.js"),
    include_str!("viewer/detail.js"),
    include_str!("viewer/webgl.js"),
    include_str!("viewer/canvas2d.js"),
    include_str!("viewer/main.js"),
];

/// What the viewer shows.
///
/// Every metric of the checker is computed by the viewer; `layers` adds further values. Playback lays the triangles in the mesh's order,
/// which for a mesh of the front is the order in which they were laid.
#[derive(Clone, Copy, Debug)]
pub struct Viewer<'a> {
    /// Heading and window title.
    pub title: &'a str,
    /// The mesh, in the plane or (if some z is not 0) in space.
    pub mesh: &'a MeshData,
    /// Further values of the triangles.
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
/// (a [`Metric`](crate::check::Metric) by its name, `edge_length`, `order`, `layer-0`, ...),
/// `palette`, `view`, `triangle`, `finding` (from 1), `frame`, `show`, `hide`, `facts=all` (every
/// measure of the chosen triangle), `renderer` (`webgl2` or `canvas`; without it the faster one),
/// `move=N`, which turns or pans for N frames and leaves the median time of one, in milliseconds, in
/// `data-frame` of the document's body, and `detail=coarse`: a mesh in space turns as a coarser one
/// however fast the machine is.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Better;
    use crate::mesh::{MarkedEdge, NO_POINT};

    fn mesh() -> MeshData {
        MeshData {
            points: vec![
                [0.1, -0.0, 0.0],
                [4.0, 0.0, 0.0],
                [4.0, f64::NAN, 0.0],
                [1e300, 3.0, 0.0],
            ],
            triangles: vec![[0, 1, 2], [1, 3, NO_POINT]],
            edges: vec![MarkedEdge { vertices: [0, 1], marker: -3 }],
            ..MeshData::default()
        }
    }

    /// The bytes of a data element.
    fn decoded(html: &str, id: &str) -> Option<Vec<u8>> {
        let (_, rest) =
            html.split_once(&format!("<script type=\"text/plain\" id=\"data-{id}\">"))?;
        BASE64_STANDARD.decode(rest.split_once("</script>")?.0).ok()
    }

    fn meta_of(html: &str) -> serde_json::Value {
        let (_, rest) = html.split_once("id=\"meta\">").expect("facts");
        serde_json::from_str(rest.split_once("</script>").expect("an end").0).expect("JSON")
    }

    // spec: G10
    #[test]
    fn arrays_are_carried_bit_for_bit() {
        let mesh = mesh();
        let html = html(&Viewer::new("m", &mesh)).expect("fits");
        let bits: Vec<u8> =
            mesh.points.iter().flat_map(|p| [p[0], p[1]]).flat_map(f64::to_le_bytes).collect();
        assert_eq!(decoded(&html, "points"), Some(bits));
        let corners: Vec<u8> =
            mesh.triangles.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        assert_eq!(decoded(&html, "triangles"), Some(corners));
        assert_eq!(decoded(&html, "edges"), Some(vec![0, 0, 0, 0, 1, 0, 0, 0]));
        assert_eq!(decoded(&html, "numbers"), None);
        assert_eq!(meta_of(&html)["dimension"], 2);
    }

    #[test]
    fn points_out_of_the_plane_make_it_a_mesh_in_space() {
        let mut mesh = mesh();
        mesh.points[3][2] = 5.0;
        let html = html(&Viewer::new("m", &mesh)).expect("fits");
        assert_eq!(meta_of(&html)["dimension"], 3);
        assert_eq!(decoded(&html, "points").map(|b| b.len()), Some(4 * 3 * 8));
    }

    // spec: G22
    #[test]
    fn every_metric_of_the_checker_is_offered() {
        for metric in crate::check::Metric::all() {
            assert!(SCRIPTS[1].contains(&format!("id: \"{metric}\"")), "{metric}");
        }
    }

    // spec: G11
    #[test]
    fn the_document_loads_nothing() {
        let mesh = mesh();
        let html = html(&Viewer::new("m", &mesh)).expect("fits").to_lowercase();
        let loaders =
            ["http:", "https:", "src=", "href=", "@import", "url(", "fetch(", "xmlhttp", "import("];
        for loader in loaders {
            assert!(!html.contains(loader), "{loader}");
        }
    }

    #[test]
    fn no_text_can_break_out_of_its_place() {
        let mesh = mesh();
        let nasty = "</script><script>alert(1)</script><!-- \" & {{data}} {{js}}";
        let highlights = [Highlight { label: nasty.into(), ..Highlight::default() }];
        let layers = [Layer::new(nasty, vec![1.0, 2.0], Better::Low)];
        let viewer =
            Viewer { highlights: &highlights, layers: &layers, ..Viewer::new(nasty, &mesh) };
        let html = html(&viewer).expect("fits");
        assert!(!html.contains("<script>alert") && !html.contains("<!--"));
        let meta = meta_of(&html);
        assert_eq!(meta["title"], nasty);
        assert_eq!(meta["highlights"][0]["label"], nasty);
        assert_eq!(meta["layers"][0]["name"], nasty);
        let plain = super::html(&Viewer::new("", &mesh)).expect("fits");
        let scripts = |html: &str| html.matches("<script").count();
        assert_eq!(scripts(&html), scripts(&plain) + 1, "one more: the layer's values");
    }

    // spec: G2
    #[test]
    fn layers_and_size_fields_that_do_not_fit_are_refused() {
        let mesh = mesh();
        let layers = [Layer::new("area", vec![1.0], Better::Low)];
        let error = html(&Viewer { layers: &layers, ..Viewer::new("m", &mesh) });
        assert!(matches!(error, Err(DrawError::ValueCount { values: 1, triangles: 2, .. })));
        let background = Some(Background { mesh: &mesh, spacing: &[1.0] });
        let error = html(&Viewer { background, ..Viewer::new("m", &mesh) });
        assert_eq!(error, Err(DrawError::SpacingCount { values: 1, points: 4 }));
    }

    // spec: G5
    #[test]
    fn the_same_viewer_gives_the_same_bytes() {
        let mesh = mesh();
        let make = || html(&Viewer::new("m", &mesh)).expect("fits");
        assert_eq!(make(), make());
        let empty = MeshData::default();
        assert!(html(&Viewer::new("empty", &empty)).is_ok());
    }
}
