//! A boundary as a small picture.

use crate::domain::{BoundingBox, Domain};
use crate::point::Point2;
use std::fmt::Write;

/// Side of the picture in pixels, and its margin.
const SIDE: f64 = 280.0;
const MARGIN: f64 = 12.0;
/// With more vertices than this they are not marked.
const MARKED_MAX: usize = 200;
/// A boundary that is so much longer than wide is stretched, for else one would see a line.
const STRETCHED_FROM: f64 = 20.0;

/// The boundary as an SVG element: the even-odd inside filled, constraints in colour, vertices as dots.
///
/// Positions are rounded to a tenth of a pixel: what is closer looks the same.
#[must_use]
pub fn picture(domain: &Domain) -> String {
    let Some(frame) = Frame::of(domain) else { return String::new() };
    let size = SIDE + 2.0 * MARGIN;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{size}\" height=\"{size}\" \
         viewBox=\"0 0 {size} {size}\" role=\"img\">"
    );
    let place = |v: u32| domain.points.get(v as usize).map(|&p| frame.place(p));
    // Writing to a string cannot fail.
    let mut path = String::new();
    for of in &domain.loops {
        let places: Vec<String> = of.vertices.iter().filter_map(|&v| place(v)).collect();
        let _ = write!(path, "M{}Z", places.join("L"));
    }
    let _ = write!(
        out,
        "<path d=\"{path}\" fill=\"#cfe3f5\" fill-rule=\"evenodd\" stroke=\"#123\" \
         stroke-linejoin=\"round\"/>"
    );
    let mut path = String::new();
    for segment in &domain.segments {
        if let [Some(a), Some(b)] = segment.vertices.map(place) {
            let _ = write!(path, "M{a}L{b}");
        }
    }
    let _ = write!(out, "<path d=\"{path}\" stroke=\"#b30\" fill=\"none\"/>");
    if domain.points.len() <= MARKED_MAX {
        let dots = domain.points.iter().map(|&p| format!("M{}h0", frame.place(p)));
        let dots: String = dots.collect();
        let _ = write!(
            out,
            "<path d=\"{dots}\" stroke=\"#123\" stroke-width=\"4\" stroke-linecap=\"round\"/>"
        );
    }
    if frame.is_stretched() {
        let _ = write!(
            out,
            "<text x=\"{MARGIN}\" y=\"{size}\" font-size=\"10\">axes scaled apart</text>"
        );
    }
    out + "</svg>"
}

struct Frame {
    low: Point2,
    scale: [f64; 2],
}

impl Frame {
    fn of(domain: &Domain) -> Option<Self> {
        let BoundingBox { min, max } = BoundingBox::of(domain.points.iter().copied())?;
        // Halves, so that the widest of all boxes does not overflow.
        let extent = [max.x / 2.0 - min.x / 2.0, max.y / 2.0 - min.y / 2.0];
        let long = extent[0].max(extent[1]);
        let scale = extent.map(|side| match side {
            side if side * STRETCHED_FROM < long && side > 0.0 => side,
            _ => long,
        });
        (long > 0.0).then_some(Self { low: min, scale })
    }

    fn is_stretched(&self) -> bool {
        self.scale[0] != self.scale[1]
    }

    fn place(&self, p: Point2) -> String {
        let share = |c: f64, low: f64, scale: f64| (c / 2.0 - low / 2.0) / scale * SIDE;
        let x = MARGIN + share(p.x, self.low.x, self.scale[0]);
        let y = MARGIN + SIDE - share(p.y, self.low.y, self.scale[1]);
        format!("{x:.1},{y:.1}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::torture::generate::case;

    #[test]
    fn every_boundary_has_a_picture_with_finite_places() {
        for index in 0..600 {
            let picture = picture(&case(2, index).domain);
            assert!(picture.starts_with("<svg") && picture.ends_with("</svg>"));
            assert!(
                !picture.contains("NaN") && !picture.contains("inf"),
                "case {index}: {picture}"
            );
            roxmltree::Document::parse(&picture).expect("well-formed");
        }
    }

    #[test]
    fn nothing_to_draw_gives_no_picture() {
        assert_eq!(picture(&Domain::new(Vec::new())), "");
        assert_eq!(picture(&Domain::new(vec![Point2::new(1.0, 1.0)])), "");
    }
}
