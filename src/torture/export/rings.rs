//! Formats made of rings: SVG paths, GeoJSON, well-known text.

use super::nesting::levels;
use super::{BoundaryForm, ExportError};
use crate::domain::{BoundingBox, Domain, Loop};
use crate::point::Point2;
use serde_json::{Value, json};

fn points<'a>(domain: &'a Domain, of: &'a Loop) -> impl Iterator<Item = Point2> + 'a {
    of.vertices.iter().map(|&v| domain.points[v as usize])
}

/// A ring with its first point again at the end.
fn closed(domain: &Domain, of: &Loop) -> Vec<Point2> {
    points(domain, of).chain(points(domain, of).take(1)).collect()
}

/// Each outer ring with its holes.
fn polygons(domain: &Domain, form: BoundaryForm) -> Result<Vec<Vec<Vec<Point2>>>, ExportError> {
    let what = "which of these touching loops lies in which";
    let levels = levels(domain).ok_or_else(|| form.cannot_say(what))?;
    let outer = (0..levels.len()).filter(|&i| levels[i].is_outer());
    let polygon = |i: usize| {
        let holes = (0..levels.len()).filter(|&j| levels[j].around == Some(i));
        std::iter::once(i).chain(holes).map(|j| closed(domain, &domain.loops[j])).collect()
    };
    Ok(outer.map(polygon).collect())
}

fn isolated(domain: &Domain) -> Vec<Point2> {
    domain.isolated_points().into_iter().map(|v| domain.points[v]).collect()
}

fn ends(domain: &Domain) -> Vec<Vec<Point2>> {
    domain.segments.iter().map(|s| s.vertices.map(|v| domain.points[v as usize]).to_vec()).collect()
}

/// A geometry collection of a multipolygon, lines and points.
pub fn geojson(domain: &Domain) -> Result<String, ExportError> {
    let mut geometries = Vec::new();
    let mut add = |kind: &str, coordinates: Value| {
        if coordinates.as_array().is_some_and(|all| !all.is_empty()) {
            geometries.push(json!({ "type": kind, "coordinates": coordinates }));
        }
    };
    add("MultiPolygon", json!(polygons(domain, BoundaryForm::GeoJson)?));
    add("MultiLineString", json!(ends(domain)));
    add("MultiPoint", json!(isolated(domain)));
    Ok(format!("{:#}\n", json!({ "type": "GeometryCollection", "geometries": geometries })))
}

/// A geometry collection, as [`geojson`].
pub fn wkt(domain: &Domain) -> Result<String, ExportError> {
    let chain = |line: &Vec<Point2>| {
        let all: Vec<String> = line.iter().map(|p| format!("{:?} {:?}", p.x, p.y)).collect();
        format!("({})", all.join(", "))
    };
    let chains = |lines: &[Vec<Point2>]| lines.iter().map(chain).collect::<Vec<_>>().join(", ");
    let polygons = polygons(domain, BoundaryForm::Wkt)?;
    let polygons: Vec<String> = polygons.iter().map(|p| format!("({})", chains(p))).collect();
    let alone: Vec<Vec<Point2>> = isolated(domain).into_iter().map(|p| vec![p]).collect();
    let parts = [
        ("MULTIPOLYGON", polygons.join(", ")),
        ("MULTILINESTRING", chains(&ends(domain))),
        ("MULTIPOINT", chains(&alone)),
    ];
    let parts = parts.iter().filter(|(_, text)| !text.is_empty());
    let parts: Vec<String> = parts.map(|(kind, text)| format!("{kind} ({text})")).collect();
    Ok(format!("GEOMETRYCOLLECTION ({})\n", parts.join(", ")))
}

/// One path, filled by the even-odd rule; segments are a second, unfilled one.
pub fn svg(domain: &Domain) -> Result<String, ExportError> {
    if !isolated(domain).is_empty() {
        return Err(BoundaryForm::Svg.cannot_say("isolated points"));
    }
    let path = |all: &mut dyn Iterator<Item = Point2>| {
        let steps: Vec<String> = all.map(|p| format!("{:?},{:?}", p.x, p.y)).collect();
        format!("M{}", steps.join(" L"))
    };
    let loops: Vec<String> =
        domain.loops.iter().map(|l| format!("{} Z", path(&mut points(domain, l)))).collect();
    let lines: Vec<String> =
        ends(domain).into_iter().map(|line| path(&mut line.into_iter())).collect();
    let bounds = BoundingBox::of(domain.points.iter().copied());
    let view = bounds.map_or_else(String::new, |BoundingBox { min, max }| {
        format!("{:?} {:?} {:?} {:?}", min.x, min.y, max.x - min.x, max.y - min.y)
    });
    let mut out = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{view}\">\n");
    out += &format!("<path fill-rule=\"evenodd\" d=\"{}\"/>\n", loops.join(" "));
    if !lines.is_empty() {
        out += &format!("<path fill=\"none\" stroke=\"black\" d=\"{}\"/>\n", lines.join(" "));
    }
    Ok(out + "</svg>\n")
}
