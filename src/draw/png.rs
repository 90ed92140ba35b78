//! PNG from the page's SVG.

use super::page::Page;
use super::{DrawError, Options};
use resvg::{tiny_skia, usvg};
use std::sync::Arc;

/// Draws a page; the font is built in, so the machine's fonts play no part.
pub fn png(page: &Page<'_>, options: &Options) -> Result<Vec<u8>, DrawError> {
    let tree = usvg::Tree::from_str(&page.svg(), &parser_options()).map_err(reason)?;
    draw(&tree, [options.width, page.height], options.png_scale)
}

/// Draws an SVG document that says its size.
pub fn rasterise(svg: &str, scale: f32) -> Result<Vec<u8>, DrawError> {
    let tree = usvg::Tree::from_str(svg, &parser_options()).map_err(reason)?;
    draw(&tree, [tree.size().width(), tree.size().height()].map(f64::from), scale)
}

fn draw(tree: &usvg::Tree, size: [f64; 2], scale: f32) -> Result<Vec<u8>, DrawError> {
    let [width, height] = size.map(|x| (x * f64::from(scale)).ceil());
    let mut pixmap = tiny_skia::Pixmap::new(width as u32, height as u32)
        .ok_or_else(|| reason(format!("{width} x {height} dots do not fit memory")))?;
    let transform = tiny_skia::Transform::from_scale(scale, scale);
    resvg::render(tree, transform, &mut pixmap.as_mut());
    pixmap.encode_png().map_err(reason)
}

fn parser_options() -> usvg::Options<'static> {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.load_font_data(dejavu::sans::bold().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    usvg::Options { fontdb: Arc::new(fonts), ..usvg::Options::default() }
}

fn reason(error: impl std::fmt::Display) -> DrawError {
    DrawError::Png { reason: error.to_string() }
}
