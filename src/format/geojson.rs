//! Domains as GeoJSON (RFC 7946), read by the `geojson` crate.
//!
//! Each polygon gives an outer loop and its holes. Lines give free segments and points give
//! isolated points, at any depth of features and collections. Positions are plane coordinates as
//! they stand: no projection, heights ignored. Properties are ignored.

use super::domain_builder::Builder;
use super::domain_file::{DomainReadError, Problem, without_mark};
use super::domain_json::Path;
use crate::domain::{Domain, LoopRole, Place};
use crate::point::Point2;
use geojson::{GeoJson, Geometry, GeometryValue, Position};

type Read<T> = Result<T, DomainReadError>;

/// Reads a domain from GeoJSON.
///
/// # Errors
/// What keeps the file from being understood, with its line or JSON path. A ring that is not
/// closed, as the RFC demands, is one of them.
pub fn read(bytes: &[u8]) -> Result<Domain, DomainReadError> {
    let text = std::str::from_utf8(without_mark(bytes))
        .map_err(|error| Problem::Json(error.to_string()).at(Place::Made))?;
    let file: GeoJson = text.parse().map_err(refused)?;
    let mut builder = Builder::new();
    let root = Path::Root;
    match &file {
        GeoJson::Geometry(geometry) => read_geometry(geometry, &root, &mut builder)?,
        GeoJson::Feature(feature) => {
            if let Some(geometry) = &feature.geometry {
                read_geometry(geometry, &Path::Key(&root, "geometry"), &mut builder)?;
            }
        }
        GeoJson::FeatureCollection(collection) => {
            let features = Path::Key(&root, "features");
            for (i, feature) in collection.features.iter().enumerate() {
                if let Some(geometry) = &feature.geometry {
                    let path = Path::Index(&features, i);
                    read_geometry(geometry, &Path::Key(&path, "geometry"), &mut builder)?;
                }
            }
        }
    }
    Ok(builder.domain)
}

fn refused(error: geojson::Error) -> DomainReadError {
    match error {
        geojson::Error::MalformedGeoJson(error) if error.line() > 0 => {
            let place = Place::Line(error.line() as u64);
            let problem = if error.is_data() { Problem::GeoJson } else { Problem::Json };
            problem(error.to_string()).at(place)
        }
        error => Problem::GeoJson(error.to_string()).at(Place::Made),
    }
}

fn read_geometry(geometry: &Geometry, path: &Path, builder: &mut Builder) -> Read<()> {
    if let GeometryValue::GeometryCollection { geometries } = &geometry.value {
        let path = Path::Key(path, "geometries");
        return each(geometries, &path, |geometry, path| read_geometry(geometry, path, builder));
    }
    let path = &Path::Key(path, "coordinates");
    match &geometry.value {
        GeometryValue::Point { coordinates } => read_point(coordinates, path, builder),
        GeometryValue::MultiPoint { coordinates } => {
            each(coordinates, path, |point, path| read_point(point, path, builder))
        }
        GeometryValue::LineString { coordinates } => read_line(coordinates, path, builder),
        GeometryValue::MultiLineString { coordinates } => {
            each(coordinates, path, |line, path| read_line(line, path, builder))
        }
        GeometryValue::Polygon { coordinates } => read_polygon(coordinates, path, builder),
        GeometryValue::MultiPolygon { coordinates } => {
            each(coordinates, path, |polygon, path| read_polygon(polygon, path, builder))
        }
        GeometryValue::GeometryCollection { .. } => Ok(()),
    }
}

fn each<T>(items: &[T], path: &Path, mut read: impl FnMut(&T, &Path) -> Read<()>) -> Read<()> {
    let mut items = items.iter().enumerate();
    items.try_for_each(|(i, item)| read(item, &Path::Index(path, i)))
}

fn point(position: &Position, path: &Path) -> Read<Point2> {
    match position.as_slice() {
        [x, y, ..] => Ok(Point2::new(*x, *y)),
        short => {
            let found = format!("{} numbers", short.len());
            Err(Problem::Expected { what: "a position [x, y]", found }.at(path.place()))
        }
    }
}

fn read_point(position: &Position, path: &Path, builder: &mut Builder) -> Read<()> {
    let at = point(position, path)?;
    builder.point(at, path.place());
    Ok(())
}

fn read_line(line: &[Position], path: &Path, builder: &mut Builder) -> Read<()> {
    let mut before = None;
    each(line, path, |position, path| {
        let at = point(position, path)?;
        let vertex = builder.segment_point(at, || path.place());
        if let Some(before) = before {
            builder.segment([before, vertex], 0, path.place());
        }
        before = Some(vertex);
        Ok(())
    })
}

fn read_polygon(rings: &[Vec<Position>], path: &Path, builder: &mut Builder) -> Read<()> {
    let mut outer = None;
    each(rings, path, |ring, path| {
        let role = outer.map_or(LoopRole::Outer, LoopRole::HoleOf);
        let index = builder.ring(read_ring(ring, path)?, role, path.place());
        outer.get_or_insert(index);
        Ok(())
    })
}

fn read_ring(ring: &[Position], path: &Path) -> Read<Vec<(Point2, Place)>> {
    let mut points = Vec::with_capacity(ring.len());
    each(ring, path, |position, path| {
        points.push((point(position, path)?, path.place()));
        Ok(())
    })?;
    match points[..] {
        [(first, _), .., (last, _)] if first.key() != last.key() => {
            Err(Problem::NotClosed { first, last }.at(path.place()))
        }
        _ => Ok(points),
    }
}
