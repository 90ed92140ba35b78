//! Pictures of meshes: SVG, PNG and a one-file HTML viewer.
//!
//! Everything here reads plain data ([`MeshData`]) and draws what it finds, sound or broken: a
//! triangle that cannot be drawn (an index out of range, a coordinate that is not finite) is
//! counted in the picture's caption and left out, never repaired.
//!
//! A picture is a list of [`Panel`]s at one scale. Colours come from a [`Layer`] of values, one a
//! triangle; [`Layer::radius_ratio`] is the usual one. Lines are as wide as the elements allow
//! (SPEC 14, G4), so that ten triangles and a million both look right.
//!
//! The same input gives the same bytes on every platform: only exactly rounded operations are
//! used, and every number is printed in a fixed form.

use crate::mesh::MeshData;
use serde::Serialize;

mod cells;
mod edges;
mod findings;
mod frame;
mod html;
mod layer;
mod legend;
mod metric_layer;
mod overlay;
mod page;
mod palette;
mod panel;
mod path;
mod perspective;
#[cfg(feature = "png")]
mod png;
mod text;

#[cfg(feature = "png")]
pub use cells::cells_png;
pub use cells::cells_svg;
pub use findings::highlights;
pub use frame::{ParseViewError, View};
pub use html::{Background, Viewer, html};
pub use layer::{Better, Layer};
pub use overlay::{comparison, comparison_layers};
pub use palette::{Palette, ParsePaletteError};
pub use perspective::{is_in_space, perspective};

/// One mesh in a picture.
#[derive(Clone, Debug)]
pub struct Panel<'a> {
    /// The mesh; its x and y are drawn, z is ignored.
    pub mesh: &'a MeshData,
    /// Values to colour the triangles by; `None` leaves them unfilled.
    pub layer: Option<&'a Layer>,
    /// A line above the panel.
    pub caption: String,
    /// The part to draw; `None` draws everything.
    pub view: Option<View>,
    /// A rectangle to outline, to show where another panel's close-up lies.
    pub outline: Option<View>,
    /// A second mesh of which only the edges are drawn, e.g. the background triangulation.
    pub background: Option<&'a MeshData>,
    /// Places to point at.
    pub highlights: &'a [Highlight],
}

impl<'a> Panel<'a> {
    /// A panel of the whole mesh without colours.
    #[must_use]
    pub fn new(mesh: &'a MeshData, caption: impl Into<String>) -> Self {
        Self {
            mesh,
            layer: None,
            caption: caption.into(),
            view: None,
            outline: None,
            background: None,
            highlights: &[],
        }
    }

    /// The same panel coloured by `layer`.
    #[must_use]
    pub fn coloured(mut self, layer: &'a Layer) -> Self {
        self.layer = Some(layer);
        self
    }

    /// The same panel cut to `view`.
    #[must_use]
    pub fn cropped(mut self, view: View) -> Self {
        self.view = Some(view);
        self
    }
}

/// A place of a mesh that a picture points at, for instance a finding of the checker.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Highlight {
    /// What is the matter, in a few words; listed beside the picture under the mark's number.
    pub label: String,
    /// Indices of triangles.
    pub triangles: Vec<u32>,
    /// Edges as pairs of point indices; they need not be edges of a triangle.
    pub edges: Vec<[u32; 2]>,
    /// Indices of points.
    pub vertices: Vec<u32>,
    /// Places that are not points of the mesh: one pair of coordinates for a spot, more for a line
    /// through them.
    pub lines: Vec<Vec<[f64; 2]>>,
}

/// How a picture looks.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// A line at the top; empty for none.
    pub title: String,
    /// Width of the page in CSS pixels (1/96 inch).
    pub width: f64,
    /// Most height a panel may take, in CSS pixels.
    pub panel_height: f64,
    /// Panels in a row; 0 puts up to three beside each other.
    pub columns: usize,
    /// Colours of the values.
    pub palette: Palette,
    /// Whether edges are drawn; boundaries always are.
    pub wireframe: bool,
    /// Pixels of a PNG for each CSS pixel.
    pub png_scale: f32,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            title: String::new(),
            width: 960.0,
            panel_height: 928.0,
            columns: 0,
            palette: Palette::default(),
            wireframe: true,
            png_scale: 2.0,
        }
    }
}

/// Why a picture could not be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DrawError {
    /// No panel was given.
    #[error("a picture needs at least one mesh")]
    NoPanel,
    /// A layer has a different number of values than the mesh has triangles.
    #[error(
        "panel {panel}: layer '{layer}' has {values} values for {triangles} triangles (SPEC G2)"
    )]
    ValueCount {
        /// Which panel, from 0.
        panel: usize,
        /// The layer's name.
        layer: String,
        /// How many values it has.
        values: usize,
        /// How many triangles the mesh has.
        triangles: usize,
    },
    /// The size field has a different number of values than the background mesh has points.
    #[error("the size field has {values} values for {points} points of the background mesh")]
    SpacingCount {
        /// How many values it has.
        values: usize,
        /// How many points the mesh has.
        points: usize,
    },
    /// The rectangle to draw is empty or not finite.
    #[error("panel {panel}: the view {view} is empty; give x0,y0,x1,y1 with x0 < x1 and y0 < y1")]
    EmptyView {
        /// Which panel, from 0.
        panel: usize,
        /// The view.
        view: View,
    },
    /// The page size is not usable.
    #[error("a page {width} pixels wide at {scale} dots a pixel cannot be drawn")]
    PageSize {
        /// The width asked for, in CSS pixels.
        width: f64,
        /// Dots for each of them.
        scale: f32,
    },
    /// The rasteriser refused.
    #[error("the picture could not be turned into a PNG: {reason}")]
    Png {
        /// What it said.
        reason: String,
    },
}

/// Draws the panels as an SVG document.
///
/// # Errors
/// [`DrawError`] when there is no panel, a layer does not fit its mesh, or a view or the page is
/// empty. Broken meshes are no error: what can be drawn is drawn, and the caption says what not.
///
/// # Complexity
/// O(n log n) in triangles; about 30 bytes of SVG a triangle.
///
/// ```
/// use trigrade::draw::{self, Layer, Options, Panel};
/// use trigrade::mesh::MeshData;
///
/// let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = MeshData { points, triangles: vec![[0, 1, 2], [0, 2, 3]], ..MeshData::default() };
/// let layer = Layer::radius_ratio(&mesh);
/// let svg = draw::svg(&[Panel::new(&mesh, "two").coloured(&layer)], &Options::default())?;
/// assert!(svg.contains("2 triangles"));
/// # Ok::<(), draw::DrawError>(())
/// ```
pub fn svg(panels: &[Panel<'_>], options: &Options) -> Result<String, DrawError> {
    check_input(panels, options)?;
    Ok(page::Page::new(panels, options).svg())
}

/// Draws the panels as a PNG: the picture of [`svg`], `png_scale` dots for each CSS pixel. Where
/// edges are closer together than dots, their tone is painted in place of lines.
///
/// Text is set in DejaVu Sans, which is built in, so that it needs no fonts on the machine.
///
/// # Errors
/// Those of [`svg`], and when the picture is too large for memory.
#[cfg(feature = "png")]
pub fn png(panels: &[Panel<'_>], options: &Options) -> Result<Vec<u8>, DrawError> {
    check_input(panels, options)?;
    let dots = f64::from(options.png_scale);
    png::png(&page::Page::new(panels, options).rasterised(dots), options)
}

/// Draws a surface in space as a PNG: the picture of [`perspective`].
///
/// # Errors
/// Those of [`perspective`], and when the picture is too large for memory.
#[cfg(feature = "png")]
pub fn perspective_png(
    mesh: &MeshData,
    title: &str,
    options: &Options,
) -> Result<Vec<u8>, DrawError> {
    let (svg, _) = perspective(mesh, title, options)?;
    png::rasterise(&svg, options.png_scale)
}

/// Draws two meshes as a PNG: the picture of [`comparison`].
///
/// # Errors
/// Those of [`comparison`], and when the picture is too large for memory.
#[cfg(feature = "png")]
pub fn comparison_png(
    panels: &[Panel<'_>; 2],
    histograms: &[[Layer; 2]],
    options: &Options,
) -> Result<Vec<u8>, DrawError> {
    png::rasterise(&comparison(panels, histograms, options)?, options.png_scale)
}

/// The widest page: beyond it SVG viewers lose precision.
const WIDTH_MAX: f64 = 20_000.0;

fn check_input(panels: &[Panel<'_>], options: &Options) -> Result<(), DrawError> {
    if panels.is_empty() {
        return Err(DrawError::NoPanel);
    }
    let (width, scale) = (options.width, options.png_scale);
    let height_ok = (10.0..=WIDTH_MAX).contains(&options.panel_height);
    if !(200.0..=WIDTH_MAX).contains(&width) || !(0.01..=20.0).contains(&scale) || !height_ok {
        return Err(DrawError::PageSize { width, scale });
    }
    panels.iter().enumerate().try_for_each(|(i, panel)| check_panel(i, panel))
}

fn check_panel(index: usize, panel: &Panel<'_>) -> Result<(), DrawError> {
    panel.layer.map_or(Ok(()), |layer| check_layer(index, layer, panel.mesh))?;
    for view in [panel.view, panel.outline].into_iter().flatten() {
        if !view.is_proper() {
            return Err(DrawError::EmptyView { panel: index, view });
        }
    }
    Ok(())
}

fn check_layer(panel: usize, layer: &Layer, mesh: &MeshData) -> Result<(), DrawError> {
    let (values, triangles) = (layer.values.len(), mesh.triangles.len());
    if values == triangles {
        return Ok(());
    }
    Err(DrawError::ValueCount { panel, layer: layer.name.clone(), values, triangles })
}

#[cfg(test)]
mod tests;
