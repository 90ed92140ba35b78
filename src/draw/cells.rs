//! Pictures of Voronoi cells: polygons with holes, and the sites.

use super::frame::{Frame, View};
use super::path::PathData;
use super::{DrawError, Options, WIDTH_MAX};
use crate::point::Point2;
use crate::voronoi::Clipped;
use std::fmt::Write as _;

/// Space around the picture, in CSS pixels.
const MARGIN: f64 = 12.0;

/// Draws clipped cells, the sites as dots, as an SVG document.
///
/// # Errors
/// [`DrawError`] for a page that cannot be drawn.
pub fn cells_svg(
    clipped: &Clipped,
    sites: &[Point2],
    options: &Options,
) -> Result<String, DrawError> {
    let (width, scale) = (options.width, options.png_scale);
    if !(200.0..=WIDTH_MAX).contains(&width) || !(0.01..=20.0).contains(&scale) {
        return Err(DrawError::PageSize { width, scale });
    }
    let corners = if clipped.points.is_empty() { sites } else { &clipped.points };
    let view = View::around_points(corners);
    let size = fitted(view, width - 2.0 * MARGIN, options.panel_height);
    let frame = Frame::new(view, [MARGIN, MARGIN], size);
    let spacing = spacing(size, clipped.pieces.len());
    Ok(document(&frame, clipped, sites, width, spacing))
}

/// The picture of [`cells_svg`] as PNG.
///
/// # Errors
/// Those of [`cells_svg`], and when the picture is too large for memory.
#[cfg(feature = "png")]
pub fn cells_png(
    clipped: &Clipped,
    sites: &[Point2],
    options: &Options,
) -> Result<Vec<u8>, DrawError> {
    let svg = cells_svg(clipped, sites, options)?;
    super::png::rasterise(&svg, options.png_scale)
}

/// The size of a view on the page: as wide as allowed unless that is too high.
fn fitted(view: View, width: f64, height: f64) -> [f64; 2] {
    let [w, h] = view.half_size();
    let ratio = (h / w).clamp(1e-3, 1e3);
    if width * ratio <= height { [width, width * ratio] } else { [height / ratio, height] }
}

/// How far apart sites are on the page, about.
fn spacing([width, height]: [f64; 2], cells: usize) -> f64 {
    (width * height / cells.max(1) as f64).sqrt()
}

fn document(
    frame: &Frame,
    clipped: &Clipped,
    sites: &[Point2],
    width: f64,
    spacing: f64,
) -> String {
    let height = frame.size[1] + 2.0 * MARGIN;
    let line = (spacing * 0.03).clamp(0.05, 1.0);
    let dot = (spacing * 0.06).clamp(0.1, 2.5);
    let place = |p: Point2| frame.grid(frame.place([p.x, p.y]));
    let mut path = PathData::default();
    for ring in clipped.pieces.iter().flat_map(|piece| &piece.rings) {
        let places: Vec<[i64; 2]> =
            ring.iter().map(|&i| place(clipped.points[i as usize])).collect();
        path.polygon(&places);
    }
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height:.2}\" \
         viewBox=\"0 0 {width} {height:.2}\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n\
         <g transform=\"translate({MARGIN} {MARGIN}) scale(0.01)\">\n"
    );
    if let Some(data) = path.finish() {
        let _ = writeln!(
            svg,
            "<path d=\"{data}\" fill=\"#e8eef5\" fill-rule=\"evenodd\" stroke=\"#24425f\" \
             stroke-width=\"{:.1}\" stroke-linejoin=\"round\"/>",
            100.0 * line
        );
    }
    // A dot is a line of no length with round ends.
    let mut dots = PathData::default();
    let drawn = sites.iter().map(|p| frame.place([p.x, p.y])).filter(|&p| frame.holds(p));
    drawn.map(|p| frame.grid(p)).for_each(|p| dots.polyline(&[p, p]));
    if let Some(data) = dots.finish() {
        let _ = writeln!(
            svg,
            "<path d=\"{data}\" fill=\"none\" stroke=\"#b3321f\" stroke-width=\"{:.1}\" \
             stroke-linecap=\"round\"/>",
            200.0 * dot
        );
    }
    svg.push_str("</g>\n</svg>\n");
    svg
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::voronoi::{ClipBox, voronoi};

    fn clipped(sites: &[Point2]) -> Clipped {
        let bounds = ClipBox::around(sites).expect("there are sites");
        voronoi(sites, false).expect("finite").clip_to_box(bounds)
    }

    fn sites() -> Vec<Point2> {
        (0..25).map(|i| Point2::new(f64::from(i % 5) * 1.1, f64::from(i / 5))).collect()
    }

    // spec: V9
    #[test]
    fn a_picture_has_every_cell_and_every_site() {
        let sites = sites();
        let svg = cells_svg(&clipped(&sites), &sites, &Options::default()).expect("drawn");
        let document = roxmltree::Document::parse(&svg).expect("XML");
        let paths: Vec<&str> =
            document.descendants().filter_map(|node| node.attribute("d")).collect();
        assert_eq!(paths.len(), 2);
        assert_eq!(paths[0].matches('z').count(), 25);
        assert_eq!(paths[1].to_lowercase().matches('m').count(), 25);
    }

    // spec: V9
    #[test]
    fn odd_sites_give_a_picture_of_finite_numbers() {
        let p = Point2::new;
        for sites in [
            vec![],
            vec![p(1.0, 2.0)],
            vec![p(-1e308, 0.0), p(1e308, 5e-324)],
            vec![p(1e-310, 0.0), p(0.0, 1e-310), p(0.0, 0.0)],
        ] {
            let clipped = if sites.is_empty() { Clipped::default() } else { clipped(&sites) };
            let svg = cells_svg(&clipped, &sites, &Options::default()).expect("drawn");
            roxmltree::Document::parse(&svg).expect("XML");
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        }
        let page = Options { width: 1.0, ..Options::default() };
        assert!(cells_svg(&Clipped::default(), &[], &page).is_err());
    }

    #[cfg(feature = "png")]
    #[test]
    fn a_picture_becomes_a_png() {
        let sites = sites();
        let png = cells_png(&clipped(&sites), &sites, &Options::default()).expect("drawn");
        assert!(png.starts_with(b"\x89PNG"));
    }
}
