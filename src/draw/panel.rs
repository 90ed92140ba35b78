//! One mesh of a picture: fills, lines, boundary and marks.

use super::edges::{self, Edge, Kind};
use super::frame::Frame;
use super::palette::mix;
use super::path::PathData;
use super::{Highlight, Options, Panel, View, text};
use std::fmt::Write as _;

/// Colours of the palette that a picture tells apart; more than the eye does.
const SHADES: usize = 48;
/// Fill of triangles without a layer: tells covered from uncovered.
const PLAIN: u32 = 0xee_f1f4;
/// Fill of triangles whose value is NaN.
const NO_VALUE: u32 = 0xb8_b8b8;
const LINE: u32 = 0x16_181c;
const BOUNDARY: u32 = 0;
const CONSTRAINT: u32 = 0xc2_185b;
const BACKGROUND: u32 = 0x7b_3fa0;
/// Okabe and Ito's vermilion: apart from every palette colour for every eye.
const MARK: &str = "#d55e00";

/// Edges are drawn in classes of length, each this much longer than the last: small enough that
/// the step in line width between classes cannot be seen.
const CLASS_RATIO: f64 = 1.15;
/// Longest edge of the first class and the number of classes: from 0.02 pixels to 75.
const CLASS_FIRST: f64 = 0.02;
const CLASSES: usize = 60;

/// Width of the lines of edges `length` pixels long: about four per cent of a short edge, so that
/// the share of ink is the same for every element size and dense parts never clog; at most 0.7.
fn line_width(length: f64) -> f64 {
    0.7 * length / (length + 18.0)
}

/// How much of a dense part the lines cover: 3/2 edges a triangle, four per cent of the length
/// wide, over the area of an equilateral triangle, less what overlaps at the corners.
const INK: f64 = 0.11;

/// Boundaries and constraints are bold, whatever their edges' length.
const BOLD: f64 = 1.3;

/// A panel laid out on the page.
pub struct Drawing<'a> {
    pub panel: &'a Panel<'a>,
    frame: Frame,
    /// Where each point lies on the page, relative to the frame's corner.
    places: Vec<[f64; 2]>,
    edges: Vec<Edge>,
    cropped: bool,
    /// Edges shorter than this, in pixels, are not drawn as lines: their triangles are tinted.
    dense: f64,
}

impl<'a> Drawing<'a> {
    pub fn new(panel: &'a Panel<'a>, mut frame: Frame) -> Self {
        let places: Vec<_> = panel.mesh.points.iter().map(|p| frame.place([p[0], p[1]])).collect();
        let edges = edges::edges(panel.mesh);
        frame.unit = unit(&edges, &places);
        Self { panel, frame, places, edges, cropped: panel.view.is_some(), dense: 0.0 }
    }

    /// For a raster of so many dots a pixel: lines closer than its dots would add up to rounding
    /// errors of the blending, so the tone that they stand for is painted instead.
    #[cfg(feature = "png")]
    pub fn rasterised(&mut self, dots: f64) {
        self.dense = 1.5 / dots;
    }

    /// Writes the panel; `id` tells it from the page's other panels.
    pub fn write(&self, out: &mut String, id: usize, options: &Options) {
        let ([x, y], [w, h]) =
            (self.frame.corner.map(text::pixels), self.frame.size.map(text::pixels));
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
        let _ = writeln!(
            out,
            "<g transform=\"scale({unit})\" fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\">"
        );
        self.write_fills(out, options);
        self.write_lines(out, options);
        self.write_background(out);
        out.push_str("</g>\n");
        self.write_marks(out);
        out.push_str("</g>\n");
        if self.cropped {
            let _ = writeln!(
                out,
                "<rect width=\"{w}\" height=\"{h}\" fill=\"none\" stroke=\"#8a8f98\" stroke-width=\"0.75\"/>"
            );
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
        // Each shade twice: plain, and tinted for dense parts.
        let mut shades: Vec<PathData> = vec![PathData::default(); 2 * (SHADES + 1)];
        for (i, &triangle) in self.panel.mesh.triangles.iter().enumerate() {
            if let Some(corners) = self.corners(triangle) {
                let tinted = usize::from(options.wireframe && self.is_dense(triangle));
                self.add_polygon(&mut shades[2 * self.shade(i) + tinted], &corners);
            }
        }
        // Crisp edges: anti-aliased neighbours would leave a pale seam between them.
        out.push_str("<g shape-rendering=\"crispEdges\">\n");
        for (shade, path) in shades.into_iter().enumerate() {
            if let Some(data) = path.finish() {
                let plain = self.colour(shade / 2, options);
                let colour = if shade % 2 == 0 { plain } else { mix(plain, LINE, INK) };
                let _ = writeln!(out, "<path fill=\"#{colour:06x}\" d=\"{data}\"/>");
            }
        }
        out.push_str("</g>\n");
    }

    fn is_dense(&self, [a, b, c]: [u32; 3]) -> bool {
        let short = |edge: &[u32; 2]| length(*edge, &self.places) < self.dense;
        [[a, b], [b, c], [c, a]].iter().filter(|edge| short(edge)).count() >= 2
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
            self.write_interior(out);
        }
        for (kind, colour) in [(Kind::Constraint, CONSTRAINT), (Kind::Boundary, BOUNDARY)] {
            let list: Vec<_> =
                self.edges.iter().filter(|e| e.kind == kind).map(|e| e.vertices).collect();
            self.write_strokes(out, (&list, &self.places), BOLD, colour);
        }
    }

    fn write_interior(&self, out: &mut String) {
        let mut classes = vec![Vec::new(); CLASSES];
        for edge in self.edges.iter().filter(|e| e.kind == Kind::Interior) {
            let length = length(edge.vertices, &self.places);
            if length >= self.dense {
                classes[class(length)].push(edge.vertices);
            }
        }
        let mut longest = CLASS_FIRST;
        for list in &classes {
            self.write_strokes(out, (list, &self.places), line_width(longest), LINE);
            longest *= CLASS_RATIO;
        }
    }

    fn write_strokes(
        &self,
        out: &mut String,
        (list, places): (&[[u32; 2]], &[[f64; 2]]),
        width: f64,
        colour: u32,
    ) {
        if let Some(data) = self.strokes(list, places) {
            let width = text::pixels(width / self.frame.unit);
            let _ = writeln!(
                out,
                "<path stroke=\"#{colour:06x}\" stroke-width=\"{width}\" d=\"{data}\"/>"
            );
        }
    }

    fn write_background(&self, out: &mut String) {
        let Some(mesh) = self.panel.background else { return };
        let places: Vec<_> = mesh.points.iter().map(|p| self.frame.place([p[0], p[1]])).collect();
        let list: Vec<_> = edges::edges(mesh).iter().map(|e| e.vertices).collect();
        self.write_strokes(out, (&list, &places), 0.5, BACKGROUND);
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
            let _ = writeln!(
                out,
                "<circle cx=\"{cx}\" cy=\"{cy}\" r=\"{r}\" fill=\"none\" stroke=\"{MARK}\" stroke-width=\"1.4\"/>"
            );
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
        for line in &highlight.lines {
            let places: Vec<_> = line.iter().map(|&p| self.frame.place(p)).collect();
            for piece in places.windows(2).filter(|w| w.iter().flatten().all(|x| x.is_finite())) {
                let cut = self.frame.clip(piece);
                seen.add(&cut);
                path.polyline(&cut.iter().map(|&p| self.frame.grid(p)).collect::<Vec<_>>());
            }
        }
        self.mark_path(out, path, "fill=\"none\"", 2.4);
        let spots = highlight.lines.iter().filter(|line| line.len() == 1).flatten();
        let spots = spots.map(|&p| self.frame.place(p)).filter(|p| p.iter().all(|x| x.is_finite()));
        for place in highlight.vertices.iter().filter_map(|&v| self.finite_place(v)).chain(spots) {
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
            let _ = writeln!(
                out,
                "<path transform=\"scale({unit})\" {fill} stroke=\"{MARK}\" stroke-width=\"{width}\" stroke-linejoin=\"round\" d=\"{data}\"/>"
            );
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

/// Which class an edge of this length belongs to; the last one takes all longer ones, and edges
/// without a length.
fn class(length: f64) -> usize {
    let mut longest = CLASS_FIRST;
    let mut class = 0;
    while class < CLASSES - 1 && (length > longest || length.is_nan()) {
        longest *= CLASS_RATIO;
        class += 1;
    }
    class
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
