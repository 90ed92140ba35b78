//! One mesh of a picture: fills, lines, boundary and marks.

use super::edges::{self, Edge, Kind};
use super::frame::Frame;
use super::path::PathData;
use super::{Highlight, Options, Panel, View, text};
use std::fmt::Write as _;

/// Colours of the palette that a picture tells apart; more than the eye does.
const SHADES: usize = 48;
/// Fill of triangles without a layer: tells covered from uncovered.
const PLAIN: u32 = 0xee_f1f4;
/// Fill of triangles whose value is NaN.
const NO_VALUE: u32 = 0xb8_b8b8;
const LINE: &str = "#2b2f36";
/// Okabe and Ito's vermilion: apart from every palette colour for every eye.
const MARK: &str = "#d55e00";
const BACKGROUND: &str = "#c0417f";

/// Classes of line width: edges up to this many pixels long get a line this wide. About four
/// per cent of the length, so that the share of ink is the same for every element size and dense
/// parts never clog; on the page a line is at most 0.7 wide.
const WIDTHS: [(f64, f64); 8] = [
    (0.35, 0.012),
    (0.75, 0.025),
    (1.5, 0.05),
    (3.0, 0.1),
    (6.0, 0.18),
    (12.0, 0.3),
    (24.0, 0.45),
    (f64::INFINITY, 0.65),
];
/// The same for boundary edges, bold.
const BOUNDARY_WIDTHS: [(f64, f64); 5] =
    [(0.75, 0.4), (1.5, 0.55), (3.0, 0.8), (6.0, 1.1), (f64::INFINITY, 1.5)];

/// A panel laid out on the page.
pub struct Drawing<'a> {
    pub panel: &'a Panel<'a>,
    frame: Frame,
    /// Where each point lies on the page, relative to the frame's corner.
    places: Vec<[f64; 2]>,
    edges: Vec<Edge>,
    cropped: bool,
}

impl<'a> Drawing<'a> {
    pub fn new(panel: &'a Panel<'a>, mut frame: Frame) -> Self {
        let places: Vec<_> =
            panel.mesh.points.iter().map(|p| frame.place([p[0], p[1]])).collect();
        let edges = edges::edges(panel.mesh);
        frame.unit = unit(&edges, &places);
        Self { panel, frame, places, edges, cropped: panel.view.is_some() }
    }

    /// Writes the panel; `id` tells it from the page's other panels.
    pub fn write(&self, out: &mut String, id: usize, options: &Options) {
        let ([x, y], [w, h]) = (self.frame.corner.map(text::pixels), self.frame.size.map(text::pixels));
        let clip = if self.cropped {
            let _ = writeln!(
                out,
                "<clipPath id=\"clip{id}\"><rect width=\"{w}\" height=\"{h}\"/></clipPath>"
            );
            format!(" clip-path=\"url(#clip{id})\"")
        } else {
            String::new()
        };
        let _ = writeln!(out, "<g transform=\"translate({x} {y})\"><g{clip}>");
        let unit = self.frame.unit;
        let _ = writeln!(out, "<g transform=\"scale({unit})\" fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\">");
        self.write_fills(out, options);
        self.write_lines(out, options);
        self.write_background(out);
        out.push_str("</g>\n");
        self.write_marks(out);
        out.push_str("</g>\n");
        if self.cropped {
            let _ = writeln!(out, "<rect width=\"{w}\" height=\"{h}\" fill=\"none\" stroke=\"#8a8f98\" stroke-width=\"0.75\"/>");
        }
        self.write_outline(out);
        out.push_str("</g>\n");
    }

    /// How many triangles have a corner that does not exist or is not finite.
    pub fn undrawable(&self) -> usize {
        let mesh = self.panel.mesh;
        mesh.triangles.iter().filter(|&&t| super::layer::corners(mesh, t).is_none()).count()
    }

    fn corners(&self, triangle: [u32; 3]) -> Option<[[f64; 2]; 3]> {
        super::layer::corners(self.panel.mesh, triangle)?;
        Some(triangle.map(|v| self.places[v as usize]))
    }

    fn write_fills(&self, out: &mut String, options: &Options) {
        let mut shades: Vec<PathData> = vec![PathData::default(); SHADES + 1];
        for (i, &triangle) in self.panel.mesh.triangles.iter().enumerate() {
            if let Some(corners) = self.corners(triangle) {
                self.add_polygon(&mut shades[self.shade(i)], &corners);
            }
        }
        // Crisp edges: anti-aliased neighbours would leave a pale seam between them.
        out.push_str("<g shape-rendering=\"crispEdges\">\n");
        for (shade, path) in shades.into_iter().enumerate() {
            if let Some(data) = path.finish() {
                let colour = self.colour(shade, options);
                let _ = writeln!(out, "<path fill=\"#{colour:06x}\" d=\"{data}\"/>");
            }
        }
        out.push_str("</g>\n");
    }

    /// Which of the shades a triangle has; the last one is for no value.
    fn shade(&self, triangle: usize) -> usize {
        let Some(layer) = self.panel.layer else { return 0 };
        layer
            .badness(layer.values[triangle])
            .map_or(SHADES, |t| (t * (SHADES - 1) as f64).round() as usize)
    }

    fn colour(&self, shade: usize, options: &Options) -> u32 {
        match shade {
            _ if self.panel.layer.is_none() => PLAIN,
            SHADES => NO_VALUE,
            shade => options.palette.colour(shade as f64 / (SHADES - 1) as f64),
        }
    }

    fn add_polygon(&self, path: &mut PathData, corners: &[[f64; 2]; 3]) {
        let grid = |p: &[f64; 2]| self.frame.grid(*p);
        if corners.iter().all(|&p| self.frame.holds(p)) {
            path.polygon(&[grid(&corners[0]), grid(&corners[1]), grid(&corners[2])]);
        } else {
            let cut: Vec<_> = self.frame.clip(corners).iter().map(grid).collect();
            path.polygon(&cut);
        }
    }

    fn write_lines(&self, out: &mut String, options: &Options) {
        if options.wireframe {
            self.write_classes(out, Kind::Interior, &WIDTHS, LINE);
        }
        self.write_classes(out, Kind::Constraint, &BOUNDARY_WIDTHS, "#1b6fb5");
        self.write_classes(out, Kind::Boundary, &BOUNDARY_WIDTHS, "#000");
    }

    fn write_classes(&self, out: &mut String, kind: Kind, widths: &[(f64, f64)], colour: &str) {
        let mut classes = vec![Vec::new(); widths.len()];
        for edge in self.edges.iter().filter(|e| e.kind == kind) {
            let length = length(edge.vertices, &self.places);
            let class = widths.iter().position(|w| length <= w.0);
            if let Some(class) = class {
                classes[class].push(edge.vertices);
            }
        }
        for (class, &(_, width)) in classes.iter().zip(widths) {
            let width = width / self.frame.unit;
            if let Some(data) = self.strokes(class, &self.places) {
                let _ = writeln!(
                    out,
                    "<path stroke=\"{colour}\" stroke-width=\"{}\" d=\"{data}\"/>",
                    text::pixels(width)
                );
            }
        }
    }

    fn write_background(&self, out: &mut String) {
        let Some(mesh) = self.panel.background else { return };
        let places: Vec<_> =
            mesh.points.iter().map(|p| self.frame.place([p[0], p[1]])).collect();
        let list: Vec<_> = edges::edges(mesh).iter().map(|e| e.vertices).collect();
        if let Some(data) = self.strokes(&list, &places) {
            let width = text::pixels(0.5 / self.frame.unit);
            let _ = writeln!(
                out,
                "<path stroke=\"{BACKGROUND}\" stroke-width=\"{width}\" d=\"{data}\"/>"
            );
        }
    }

    /// Path data through `edges`, cut to the frame.
    fn strokes(&self, edges: &[[u32; 2]], places: &[[f64; 2]]) -> Option<String> {
        let mut path = PathData::default();
        for stroke in edges::strokes(edges, places.len()) {
            let line: Vec<_> = stroke.iter().map(|&v| places[v as usize]).collect();
            if line.iter().all(|&p| self.frame.holds(p)) {
                let grid: Vec<_> = line.iter().map(|&p| self.frame.grid(p)).collect();
                path.polyline(&grid);
            } else {
                self.add_cut(&mut path, &line);
            }
        }
        path.finish()
    }

    fn add_cut(&self, path: &mut PathData, line: &[[f64; 2]]) {
        for piece in line.windows(2).filter(|w| w.iter().flatten().all(|x| x.is_finite())) {
            let cut: Vec<_> =
                self.frame.clip(piece).into_iter().map(|p| self.frame.grid(p)).collect();
            path.polyline(&cut);
        }
    }

    fn write_outline(&self, out: &mut String) {
        let Some(View { x0, y0, x1, y1 }) = self.panel.outline else { return };
        let ([left, top], [right, bottom]) =
            (self.frame.place([x0, y1]), self.frame.place([x1, y0]));
        // Never smaller than can be seen.
        let (w, h) = ((right - left).max(4.0), (bottom - top).max(4.0));
        let [x, y, w, h] = [left, top, w, h].map(text::pixels);
        let _ = writeln!(
            out,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" fill=\"none\" stroke=\"{MARK}\" stroke-width=\"1.2\"/>"
        );
    }

    fn write_marks(&self, out: &mut String) {
        for (i, highlight) in self.panel.highlights.iter().take(MARKS_MAX).enumerate() {
            self.write_mark(out, i + 1, highlight);
        }
    }

    fn write_mark(&self, out: &mut String, number: usize, highlight: &Highlight) {
        let Some(around) = self.write_mark_shapes(out, highlight) else { return };
        let [x0, y0, x1, y1] = around;
        let (x, y) = ((x0 + x1) / 2.0, (y0 + y1) / 2.0);
        let reach = ((x1 - x0).max(y1 - y0) / 2.0).min(1e4);
        if reach < 6.0 {
            let [cx, cy, r] = [x, y, reach + 5.0].map(text::pixels);
            let _ = writeln!(out, "<circle cx=\"{cx}\" cy=\"{cy}\" r=\"{r}\" fill=\"none\" stroke=\"{MARK}\" stroke-width=\"1.4\"/>");
        }
        let away = 0.75 * (reach.min(40.0) + 6.0);
        let at = [x + away, y - away];
        text::push(out, at, text::Anchor::Start, MARK_TEXT, &number.to_string());
    }

    /// Draws triangles, edges and points of a highlight; returns the rectangle around those that
    /// lie in the frame.
    fn write_mark_shapes(&self, out: &mut String, highlight: &Highlight) -> Option<[f64; 4]> {
        let mut seen = Bounds::default();
        let mut path = PathData::default();
        for &t in &highlight.triangles {
            if let Some(corners) =
                self.panel.mesh.triangles.get(t as usize).and_then(|&t| self.corners(t))
            {
                let cut = self.frame.clip(&corners);
                seen.add(&cut);
                path.polygon(&cut.iter().map(|&p| self.frame.grid(p)).collect::<Vec<_>>());
            }
        }
        self.mark_path(out, path, &format!("fill=\"{MARK}\" fill-opacity=\"0.35\""), 1.2);
        let mut path = PathData::default();
        for edge in &highlight.edges {
            if let [Some(a), Some(b)] = edge.map(|v| self.finite_place(v)) {
                let cut = self.frame.clip(&[a, b]);
                seen.add(&cut);
                path.polyline(&cut.iter().map(|&p| self.frame.grid(p)).collect::<Vec<_>>());
            }
        }
        self.mark_path(out, path, "fill=\"none\"", 2.4);
        for place in highlight.vertices.iter().filter_map(|&v| self.finite_place(v)) {
            if self.frame.holds(place) {
                seen.add(&[place]);
                let [x, y] = place.map(text::pixels);
                let _ = writeln!(out, "<circle cx=\"{x}\" cy=\"{y}\" r=\"2.2\" fill=\"{MARK}\"/>");
            }
        }
        seen.0
    }

    fn mark_path(&self, out: &mut String, path: PathData, fill: &str, width: f64) {
        if let Some(data) = path.finish() {
            let unit = self.frame.unit;
            let width = text::pixels(width / unit);
            let _ = writeln!(out, "<path transform=\"scale({unit})\" {fill} stroke=\"{MARK}\" stroke-width=\"{width}\" stroke-linejoin=\"round\" d=\"{data}\"/>");
        }
    }

    fn finite_place(&self, vertex: u32) -> Option<[f64; 2]> {
        let place = *self.places.get(vertex as usize)?;
        place.iter().all(|x| x.is_finite()).then_some(place)
    }
}

/// Marks drawn in one panel; more would hide the mesh.
pub const MARKS_MAX: usize = 200;

const MARK_TEXT: &str = " font-size=\"12\" font-weight=\"bold\" fill=\"#b34700\" stroke=\"#fff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"";

/// The rectangle around places: x0, y0, x1, y1.
#[derive(Default)]
struct Bounds(Option<[f64; 4]>);

impl Bounds {
    fn add(&mut self, places: &[[f64; 2]]) {
        for &[x, y] in places {
            let [x0, y0, x1, y1] = self.0.unwrap_or([x, y, x, y]);
            self.0 = Some([x0.min(x), y0.min(y), x1.max(x), y1.max(y)]);
        }
    }
}

fn length([a, b]: [u32; 2], places: &[[f64; 2]]) -> f64 {
    let ([ax, ay], [bx, by]) = (places[a as usize], places[b as usize]);
    ((bx - ax) * (bx - ax) + (by - ay) * (by - ay)).sqrt()
}

/// The step of path coordinates: a fortieth of a small edge, so that small elements keep their
/// shape when a viewer zooms in; the smallest one per cent may be coarser.
fn unit(edges: &[Edge], places: &[[f64; 2]]) -> f64 {
    let mut lengths: Vec<f64> =
        edges.iter().map(|e| length(e.vertices, places)).filter(|l| *l > 0.0).collect();
    let small = lengths.len() / 100;
    if lengths.is_empty() {
        return UNITS[0];
    }
    let (_, &mut small, _) = lengths.select_nth_unstable_by(small, f64::total_cmp);
    UNITS.into_iter().find(|unit| unit * 40.0 <= small).unwrap_or(UNITS[UNITS.len() - 1])
}

/// Powers of ten, so that the scale is short and exact.
const UNITS: [f64; 4] = [0.05, 0.01, 0.001, 0.0001];
