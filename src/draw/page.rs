//! The page: panels in rows with captions, legends and lists of marks.

use super::frame::{Frame, View};
use super::legend::{self, Summary};
use super::panel::Drawing;
use super::text::{self, Anchor};
use super::{Options, Panel};
use std::fmt::Write as _;

const MARGIN: f64 = 16.0;
const GAP: f64 = 20.0;
const TITLE: f64 = 28.0;
/// Two lines above each panel: its caption and its figures.
const CAPTION: f64 = 38.0;
const LIST_LINE: f64 = 15.0;
/// Lines in the list of marks below a panel.
const LIST_MAX: usize = 12;
const LEGEND_WIDTH: f64 = 420.0;

const TITLE_STYLE: &str = " font-size=\"16\" font-weight=\"bold\" fill=\"#14171a\"";
const CAPTION_STYLE: &str = " font-size=\"13\" font-weight=\"bold\" fill=\"#22262c\"";
const FIGURES_STYLE: &str = " font-size=\"11\" fill=\"#4a4f57\"";

/// A picture laid out: where each panel goes, and how large the page is.
pub struct Page<'a> {
    options: &'a Options,
    cells: Vec<Cell<'a>>,
    /// Height of the page; its width is the options'.
    pub height: f64,
}

/// A panel with its surroundings.
struct Cell<'a> {
    drawing: Drawing<'a>,
    summary: Option<Summary>,
    corner: [f64; 2],
    width: f64,
    /// Page ordinate below the drawing, where the legend starts.
    below: f64,
}

impl<'a> Page<'a> {
    /// Lays out panels that have been found to fit their layers.
    pub fn new(panels: &'a [Panel<'a>], options: &'a Options) -> Self {
        let columns = match options.columns {
            0 => panels.len().min(3),
            n => n.min(panels.len()),
        };
        let inner = options.width - 2.0 * MARGIN - GAP * (columns - 1) as f64;
        // Never narrower than a legend's labels, whatever the number of columns.
        let width = (inner / columns as f64).max(40.0);
        let sizes = sizes(panels, [width, options.panel_height]);
        let mut page = Self { options, cells: Vec::new(), height: MARGIN };
        if !options.title.is_empty() {
            page.height += TITLE;
        }
        for (row, sizes) in panels.chunks(columns).zip(sizes.chunks(columns)) {
            page.add_row(row, sizes, width);
        }
        page.height += MARGIN;
        page
    }

    fn add_row(&mut self, panels: &'a [Panel<'a>], sizes: &[[f64; 2]], width: f64) {
        if !self.cells.is_empty() {
            self.height += GAP;
        }
        let top = self.height;
        let tallest = sizes.iter().fold(0.0_f64, |h, s| h.max(s[1]));
        let below = top + CAPTION + tallest + 10.0;
        for (i, (panel, size)) in panels.iter().zip(sizes).enumerate() {
            let corner = [MARGIN + i as f64 * (width + GAP), top];
            let view = panel.view.or_else(|| View::of(panel.mesh)).unwrap_or(UNIT_VIEW);
            let middle = [(width - size[0]) / 2.0, CAPTION + (tallest - size[1]) / 2.0];
            let at = [corner[0] + middle[0], corner[1] + middle[1]];
            let drawing = Drawing::new(panel, Frame::new(view, at, *size));
            let summary = panel.layer.and_then(Summary::of);
            self.cells.push(Cell { drawing, summary, corner, width, below });
            let end = below + self.cells[self.cells.len() - 1].height_below();
            self.height = self.height.max(end);
        }
    }

    /// The same page to be drawn with so many dots a pixel.
    #[cfg(feature = "png")]
    pub fn rasterised(mut self, dots: f64) -> Self {
        self.cells.iter_mut().for_each(|cell| cell.drawing.rasterised(dots));
        self
    }

    /// The document.
    pub fn svg(&self) -> String {
        let mut out = String::new();
        let [width, height] = [self.options.width, self.height].map(text::pixels);
        let _ = writeln!(
            out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" font-family=\"{}\">",
            text::FONT
        );
        let _ = writeln!(out, "<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>");
        if !self.options.title.is_empty() {
            let title = text::fitted(&self.options.title, self.options.width - 2.0 * MARGIN, 16.0);
            let _ = writeln!(out, "<title>{}</title>", text::escape(&self.options.title));
            text::push(&mut out, [MARGIN, MARGIN + 14.0], Anchor::Start, TITLE_STYLE, &title);
        }
        for (i, cell) in self.cells.iter().enumerate() {
            cell.write(&mut out, i, self.options);
        }
        out.push_str("</svg>\n");
        out
    }
}

const UNIT_VIEW: View = View { x0: 0.0, y0: 0.0, x1: 1.0, y1: 1.0 };

/// Width and height of each panel on the page, all within `room`. Panels without a view of their
/// own have one scale; a panel with a view fills its room.
fn sizes(panels: &[Panel<'_>], room: [f64; 2]) -> Vec<[f64; 2]> {
    let whole: Vec<[f64; 2]> = panels
        .iter()
        .map(|p| p.view.or_else(|| View::of(p.mesh)).unwrap_or(UNIT_VIEW).half_size())
        .collect();
    let fit = |size: &[f64; 2]| -> f64 { (room[0] / size[0]).min(room[1] / size[1]) };
    // Ratios to the largest extent: a scale in pixels a unit would overflow for tiny meshes.
    let shared = panels
        .iter()
        .zip(&whole)
        .filter(|(p, _)| p.view.is_none())
        .fold([0.0_f64; 2], |m, (_, size)| [m[0].max(size[0]), m[1].max(size[1])]);
    panels
        .iter()
        .zip(&whole)
        .map(|(panel, size)| {
            let largest = if panel.view.is_some() { *size } else { shared };
            let reference = largest[0].max(largest[1]);
            let scale = fit(&largest.map(|s| s / reference));
            size.map(|s| (s / reference * scale).max(1.0))
        })
        .collect()
}

impl Cell<'_> {
    fn legend_height(&self) -> f64 {
        if self.summary.is_some() { legend::HEIGHT } else { 0.0 }
    }

    fn height_below(&self) -> f64 {
        let lines = self.drawing.panel.highlights.len();
        let lines = if lines > LIST_MAX { LIST_MAX + 1 } else { lines };
        self.legend_height() + lines as f64 * LIST_LINE
    }

    fn write(&self, out: &mut String, id: usize, options: &Options) {
        let [x, y] = self.corner;
        let panel = self.drawing.panel;
        let caption = text::fitted(&panel.caption, self.width, 13.0);
        text::push(out, [x, y + 13.0], Anchor::Start, CAPTION_STYLE, &caption);
        let figures = text::fitted(&self.figures(), self.width, 11.0);
        text::push(out, [x, y + 29.0], Anchor::Start, FIGURES_STYLE, &figures);
        self.drawing.write(out, id, options);
        if let (Some(layer), Some(summary)) = (panel.layer, &self.summary) {
            let width = LEGEND_WIDTH.min(self.width);
            let at = [x + (self.width - width) / 2.0, self.below];
            legend::write(out, at, width, (layer, summary), options.palette);
        }
        self.write_list(out);
    }

    /// The line under the caption: how many triangles, and how many of them are not to be seen.
    fn figures(&self) -> String {
        let total = text::count(self.drawing.panel.mesh.triangles.len());
        match self.drawing.undrawable() {
            0 => format!("{total} triangles"),
            n => {
                format!("{total} triangles, {} not drawn (bad index or coordinate)", text::count(n))
            }
        }
    }

    fn write_list(&self, out: &mut String) {
        let highlights = self.drawing.panel.highlights;
        let mut y = self.below + self.legend_height() + 10.0;
        for (i, highlight) in highlights.iter().take(LIST_MAX).enumerate() {
            let line = text::fitted(&format!("{}: {}", i + 1, highlight.label), self.width, 11.0);
            text::push(out, [self.corner[0], y], Anchor::Start, FIGURES_STYLE, &line);
            y += LIST_LINE;
        }
        if highlights.len() > LIST_MAX {
            let line = format!("and {} more", text::count(highlights.len() - LIST_MAX));
            text::push(out, [self.corner[0], y], Anchor::Start, FIGURES_STYLE, &line);
        }
    }
}
