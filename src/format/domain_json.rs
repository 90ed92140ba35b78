//! Domains as JSON: trigrade's own schema, read and written, and the plain layout, read only.
//!
//! The schema is in SPEC 13. Numbers are read to the nearest double and written with the fewest
//! digits that read back to the same bits, so a domain goes out and in again unchanged.

use super::domain_builder::{Builder, default_marker};
use super::domain_file::{DomainReadError, Problem, excerpt, without_mark};
use super::{curve_json, domain_json_plain, geojson};
use crate::domain::{Domain, Inside, Loop, LoopRole, Place, Region};
use crate::point::Point2;
use serde_json::{Map, Value};
use std::fmt::{self, Write as _};
use std::io;

/// The value of the key `format` in files of this schema.
pub const FORMAT: &str = "trigrade-domain";

/// The value of the key `version`; files of another version are refused.
pub const VERSION: u64 = 1;

/// Reads a domain from JSON: trigrade's schema, the plain layout, or GeoJSON.
///
/// # Errors
/// What keeps the file from being understood, with its line and column or JSON path.
pub fn read(bytes: &[u8]) -> Result<Domain, DomainReadError> {
    let bytes = without_mark(bytes);
    let value: Value = parse(bytes)?;
    let root = Item { value: &value, path: &Path::Root };
    let keys = root.object("an object with the domain")?;
    if keys.contains_key("format") || keys.contains_key("loops") {
        read_schema(root)
    } else if keys.contains_key("type")
        && !["outer", "polygons"].iter().any(|&k| keys.contains_key(k))
    {
        geojson::read(bytes)
    } else {
        domain_json_plain::read(root)
    }
}

/// Parses JSON; errors carry the line.
pub(super) fn parse(bytes: &[u8]) -> Result<Value, DomainReadError> {
    serde_json::from_slice(bytes).map_err(|error| {
        let place = match error.line() {
            0 => Place::Made,
            line => Place::Line(line as u64),
        };
        Problem::Json(error.to_string()).at(place)
    })
}

/// A path into a JSON file, as a list from the value up to the root.
#[derive(Clone, Copy, Debug)]
pub(super) enum Path<'a> {
    Root,
    Key(&'a Self, &'static str),
    Index(&'a Self, usize),
}

impl fmt::Display for Path<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Root => f.write_str("$"),
            Self::Key(parent, key) => write!(f, "{parent}.{key}"),
            Self::Index(parent, index) => write!(f, "{parent}[{index}]"),
        }
    }
}

impl Path<'_> {
    pub fn place(&self) -> Place {
        Place::Path(self.to_string())
    }
}

/// A value in a JSON file and the path to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item<'a> {
    pub value: &'a Value,
    pub path: &'a Path<'a>,
}

pub(super) type Read<T> = Result<T, DomainReadError>;

impl<'a> Item<'a> {
    pub fn place(self) -> Place {
        self.path.place()
    }

    pub fn error(self, problem: Problem) -> DomainReadError {
        problem.at(self.place())
    }

    pub fn expected(self, what: &'static str) -> DomainReadError {
        let found = match self.value {
            Value::Null => "null".to_owned(),
            Value::Bool(value) => value.to_string(),
            Value::Number(value) => excerpt(&value.to_string()),
            Value::String(text) => format!("the string '{}'", excerpt(text)),
            Value::Array(items) => format!("an array of {}", items.len()),
            Value::Object(_) => "an object".to_owned(),
        };
        self.error(Problem::Expected { what, found })
    }

    pub fn object(self, what: &'static str) -> Read<&'a Map<String, Value>> {
        self.value.as_object().ok_or_else(|| self.expected(what))
    }

    pub fn array(self, what: &'static str) -> Read<&'a Vec<Value>> {
        self.value.as_array().ok_or_else(|| self.expected(what))
    }

    /// Calls `each` with every item of an array.
    pub fn each(self, what: &'static str, mut each: impl FnMut(Item) -> Read<()>) -> Read<()> {
        let mut items = self.array(what)?.iter().enumerate();
        items.try_for_each(|(i, value)| each(Item { value, path: &Path::Index(self.path, i) }))
    }

    /// Calls `then` with the value of a key, if there is one and it is not null.
    pub fn key<T>(self, key: &'static str, then: impl FnOnce(Item) -> Read<T>) -> Read<Option<T>> {
        match self.value.get(key) {
            None | Some(Value::Null) => Ok(None),
            Some(value) => then(Item { value, path: &Path::Key(self.path, key) }).map(Some),
        }
    }

    pub fn only_keys(self, known: &[&str]) -> Read<()> {
        match self.object("an object")?.keys().find(|key| !known.contains(&key.as_str())) {
            Some(key) => Err(self.error(Problem::UnknownKey(excerpt(key)))),
            None => Ok(()),
        }
    }

    pub fn number(self) -> Read<f64> {
        self.value.as_f64().ok_or_else(|| self.expected("a number"))
    }

    pub fn position(self) -> Read<Point2> {
        let what = "a point [x, y]";
        let [x, y] = &self.array(what)?[..] else { return Err(self.expected(what)) };
        let coordinate = |value, i| Item { value, path: &Path::Index(self.path, i) }.number();
        Ok(Point2::new(coordinate(x, 0)?, coordinate(y, 1)?))
    }

    pub fn positions(self, what: &'static str) -> Read<Vec<(Point2, Place)>> {
        let mut points = Vec::new();
        self.each(what, |item| {
            points.push((item.position()?, item.place()));
            Ok(())
        })?;
        Ok(points)
    }

    pub fn integer(self, what: &'static str, low: i64, high: i64) -> Read<i64> {
        let number = self.value.as_number().ok_or_else(|| self.expected(what))?;
        match number.as_i64() {
            Some(value) if (low..=high).contains(&value) => Ok(value),
            None if number.is_f64() && number.as_f64().is_some_and(|x| x.fract() != 0.0) => {
                Err(self.expected(what))
            }
            _ => Err(self.error(Problem::OutOfRange {
                what,
                found: excerpt(&number.to_string()),
                low,
                high,
            })),
        }
    }

    pub fn marker(self) -> Read<i32> {
        self.integer("a marker", i32::MIN.into(), i32::MAX.into()).map(|marker| marker as i32)
    }
}

fn read_schema(root: Item) -> Read<Domain> {
    root.only_keys(&[
        "format",
        "version",
        "name",
        "comment",
        "points",
        "point_markers",
        "loops",
        "segments",
        "inside",
        "regions",
    ])?;
    root.key("format", |item| match item.value.as_str() {
        Some(FORMAT) => Ok(()),
        _ => Err(item.expected("the format 'trigrade-domain'")),
    })?;
    let version = VERSION as i64;
    root.key("version", |item| item.integer("the version", version, version).map(|_| ()))?;
    let mut builder = Builder::new();
    root.key("points", |item| {
        item.each("an array of points", |item| {
            builder.point(item.position()?, item.place());
            Ok(())
        })
    })?;
    read_point_markers(root, &mut builder.domain)?;
    root.key("loops", |item| item.each("an array of loops", |item| read_loop(item, &mut builder)))?;
    root.key("segments", |item| {
        item.each("an array of segments", |item| read_segment(item, &mut builder))
    })?;
    root.key("inside", |item| read_inside(item, &mut builder.domain))?;
    root.key("regions", |item| {
        item.each("an array of regions", |item| read_region(item, &mut builder.domain))
    })?;
    let domain = &mut builder.domain;
    if !domain.point_markers.is_empty() {
        // Points given by coordinates have none.
        domain.point_markers.resize(domain.points.len(), 0);
    }
    Ok(builder.domain)
}

fn read_point_markers(root: Item, domain: &mut Domain) -> Read<()> {
    root.key("point_markers", |item| {
        item.each("an array of markers", |item| {
            domain.point_markers.push(item.marker()?);
            Ok(())
        })?;
        let (found, expected) = (domain.point_markers.len(), domain.points.len());
        if found == 0 || found == expected {
            return Ok(());
        }
        Err(item.error(Problem::Length { what: "point markers", found, expected }))
    })?;
    Ok(())
}

/// A vertex: an index into the points listed, or the coordinates of a new point.
fn read_vertex(
    item: Item,
    builder: &mut Builder,
    new: impl FnOnce(&mut Builder, Point2) -> u32,
) -> Read<u32> {
    match item.value {
        Value::Array(_) => item.position().map(|at| new(builder, at)),
        Value::Number(_) => {
            let index = item.integer("a point's index", 0, i64::from(u32::MAX))? as u32;
            if (index as usize) < builder.domain.points.len() {
                builder.share(index);
            }
            Ok(index)
        }
        _ => Err(item.expected("a point's index or a point [x, y]")),
    }
}

fn read_loop(item: Item, builder: &mut Builder) -> Read<()> {
    item.only_keys(&["vertices", "curves", "marker", "markers", "role"])?;
    if item.value.get("curves").is_some_and(|curves| !curves.is_null()) {
        return read_curved_loop(item, builder);
    }
    let mut vertices = Vec::new();
    let mut by_coordinates = false;
    item.key("vertices", |item| {
        item.each("an array of vertices", |item| {
            by_coordinates = item.value.is_array();
            let new = |builder: &mut Builder, at| builder.loop_point(at, item.place());
            vertices.push(read_vertex(item, builder, new)?);
            Ok(())
        })
    })?
    .ok_or_else(|| item.error(Problem::MissingKey("vertices")))?;
    drop_closing(builder, &mut vertices, by_coordinates);
    let marker = item.key("marker", |item| item.marker())?;
    let mut markers = Vec::new();
    let listed = item.key("markers", |item| {
        item.each("an array of markers", |item| {
            markers.push(item.marker()?);
            Ok(())
        })?;
        let (found, expected) = (markers.len(), vertices.len());
        if found == expected {
            return Ok(());
        }
        Err(item.error(Problem::Length { what: "markers", found, expected }))
    })?;
    if listed.is_none() {
        let marker = marker.unwrap_or(default_marker(builder.domain.loops.len()));
        markers = vec![marker; vertices.len()];
    } else if marker.is_some() {
        return Err(item.error(Problem::Excluded("'marker'", "'markers'")));
    }
    let role = item.key("role", read_role)?.unwrap_or(LoopRole::Any);
    builder.add_loop(Loop { vertices, markers, role }, item.place());
    Ok(())
}

/// A loop of curves, each cut into edges by its own rule.
fn read_curved_loop(item: Item, builder: &mut Builder) -> Read<()> {
    for (key, name) in [("vertices", "'vertices'"), ("markers", "'markers'")] {
        if item.value.get(key).is_some_and(|value| !value.is_null()) {
            return Err(item.error(Problem::Excluded(name, "'curves'")));
        }
    }
    let default = default_marker(builder.domain.loops.len());
    let default = item.key("marker", |item| item.marker())?.unwrap_or(default);
    let role = item.key("role", read_role)?.unwrap_or(LoopRole::Any);
    let (mut vertices, mut markers) = (Vec::new(), Vec::new());
    item.key("curves", |item| {
        for (points, marker, place) in curve_json::chain(item)? {
            for [x, y, _] in points {
                vertices.push(builder.loop_point(Point2::new(x, y), place.clone()));
                markers.push(marker.unwrap_or(default));
            }
        }
        Ok(())
    })?;
    builder.add_loop(Loop { vertices, markers, role }, item.place());
    Ok(())
}

/// Drops a closing vertex: the first one's index again, or coordinates equal to the first one's.
fn drop_closing(builder: &mut Builder, vertices: &mut Vec<u32>, by_coordinates: bool) {
    let point = |v: u32| builder.domain.points.get(v as usize).map(|p| p.key());
    let [first, .., last] = vertices[..] else { return };
    let closes = by_coordinates && point(first) == point(last);
    if first == last || closes {
        vertices.pop();
    }
    if closes && last as usize + 1 == builder.domain.points.len() && first != last {
        builder.domain.points.pop();
        builder.domain.places.points.pop();
    }
}

fn read_role(item: Item) -> Read<LoopRole> {
    match item.value {
        Value::String(role) if role == "any" => Ok(LoopRole::Any),
        Value::String(role) if role == "outer" => Ok(LoopRole::Outer),
        Value::Object(_) => {
            item.only_keys(&["hole_of"])?;
            let outer =
                item.key("hole_of", |item| item.integer("a loop's index", 0, i64::from(u32::MAX)))?;
            let outer = outer.ok_or_else(|| item.error(Problem::MissingKey("hole_of")))?;
            Ok(LoopRole::HoleOf(outer as usize))
        }
        _ => Err(item.expected("a role: \"any\", \"outer\" or {\"hole_of\": loop}")),
    }
}

fn read_segment(item: Item, builder: &mut Builder) -> Read<()> {
    let mut ends = Vec::new();
    let mut read_ends = |item: Item| {
        item.each("two vertices", |item| {
            let new = |builder: &mut Builder, at| builder.segment_point(at, || item.place());
            ends.push(read_vertex(item, builder, new)?);
            Ok(())
        })
    };
    let mut marker = None;
    if item.value.is_array() {
        read_ends(item)?;
    } else {
        item.only_keys(&["vertices", "marker"])?;
        item.key("vertices", &mut read_ends)?
            .ok_or_else(|| item.error(Problem::MissingKey("vertices")))?;
        marker = item.key("marker", |item| item.marker())?;
    }
    let &[a, b] = &ends[..] else {
        let found = ends.len();
        return Err(item.error(Problem::Length { what: "ends of a segment", found, expected: 2 }));
    };
    builder.segment([a, b], marker.unwrap_or(0), item.place());
    Ok(())
}

fn read_inside(item: Item, domain: &mut Domain) -> Read<()> {
    match item.value {
        Value::String(rule) if rule == "even-odd" => Ok(()),
        Value::Object(_) => {
            item.only_keys(&["carve"])?;
            item.key("carve", |item| carve(item, domain))?
                .ok_or_else(|| item.error(Problem::MissingKey("carve")))
        }
        _ => Err(item.expected("a rule: \"even-odd\" or {\"carve\": [points]}")),
    }
}

/// Sets the rule to carving from the listed points.
pub(super) fn carve(item: Item, domain: &mut Domain) -> Read<()> {
    let (holes, places) = item.positions("an array of hole points")?.into_iter().unzip();
    (domain.inside, domain.places.holes) = (Inside::Carve(holes), places);
    Ok(())
}

fn read_region(item: Item, domain: &mut Domain) -> Read<()> {
    item.only_keys(&["seed", "marker", "area_max"])?;
    let seed = item.key("seed", |item| item.position())?;
    let seed = seed.ok_or_else(|| item.error(Problem::MissingKey("seed")))?;
    let marker = item.key("marker", |item| item.marker())?.unwrap_or(0);
    let area_max = item.key("area_max", |item| match item.number()? {
        area if area > 0.0 => Ok(area),
        _ => Err(item.expected("an area above 0")),
    })?;
    domain.regions.push(Region { seed, marker, area_max });
    domain.places.regions.push(item.place());
    Ok(())
}

/// Writes a domain in trigrade's schema; [`read`] gives it back, but for [`Domain::places`] and a
/// loop that ends with its first vertex again, to the bit.
///
/// # Errors
/// Those of `out`, and `InvalidData` if a number is not finite: JSON has no such numbers.
pub fn write(domain: &Domain, out: &mut impl io::Write) -> io::Result<()> {
    let mut text = format!("{{\n  \"format\": \"{FORMAT}\",\n  \"version\": {VERSION}");
    list(&mut text, "points", &domain.points, |text, p| write_point(text, *p));
    if !domain.point_markers.is_empty() {
        list(&mut text, "point_markers", &domain.point_markers, |text, m| write!(text, "{m}"));
    }
    list(&mut text, "loops", &domain.loops, write_loop);
    list(&mut text, "segments", &domain.segments, |text, segment| {
        let [a, b] = segment.vertices;
        write!(text, "{{\"vertices\": [{a}, {b}], \"marker\": {}}}", segment.marker)
    });
    match &domain.inside {
        Inside::EvenOdd => text.push_str(",\n  \"inside\": \"even-odd\""),
        Inside::Carve(holes) => {
            text.push_str(",\n  \"inside\": {\"carve\": ");
            write_list(&mut text, holes, |text, p| write_point(text, *p));
            text.push('}');
        }
    }
    list(&mut text, "regions", &domain.regions, write_region);
    text.push_str("\n}\n");
    let holes = match &domain.inside {
        Inside::Carve(holes) => &holes[..],
        Inside::EvenOdd => &[],
    };
    let seeds = domain.regions.iter().map(|region| region.seed);
    if !domain.points.iter().chain(holes).copied().chain(seeds).all(Point2::is_finite) {
        let message = "a coordinate is not finite, which JSON cannot say";
        return Err(io::Error::new(io::ErrorKind::InvalidData, message));
    }
    out.write_all(text.as_bytes())
}

fn list<T>(
    text: &mut String,
    key: &str,
    items: &[T],
    each: impl Fn(&mut String, &T) -> fmt::Result,
) {
    text.push_str(",\n  \"");
    text.push_str(key);
    text.push_str("\": ");
    write_list(text, items, each);
}

fn write_list<T>(text: &mut String, items: &[T], each: impl Fn(&mut String, &T) -> fmt::Result) {
    text.push('[');
    for (i, item) in items.iter().enumerate() {
        text.push_str(if i == 0 { "\n    " } else { ",\n    " });
        // Writing to a string cannot fail.
        let _ = each(text, item);
    }
    text.push_str(if items.is_empty() { "]" } else { "\n  ]" });
}

fn write_point(text: &mut String, Point2 { x, y }: Point2) -> fmt::Result {
    write!(text, "[{x:?}, {y:?}]")
}

fn write_loop(text: &mut String, of: &Loop) -> fmt::Result {
    write!(text, "{{\"vertices\": {:?}, ", of.vertices)?;
    match of.markers.first() {
        Some(marker) if of.markers.iter().all(|m| m == marker) => {
            write!(text, "\"marker\": {marker}, ")?;
        }
        _ => write!(text, "\"markers\": {:?}, ", of.markers)?,
    }
    match of.role {
        LoopRole::Any => text.write_str("\"role\": \"any\"}"),
        LoopRole::Outer => text.write_str("\"role\": \"outer\"}"),
        LoopRole::HoleOf(outer) => write!(text, "\"role\": {{\"hole_of\": {outer}}}}}"),
    }
}

fn write_region(text: &mut String, region: &Region) -> fmt::Result {
    text.push_str("{\"seed\": ");
    write_point(text, region.seed)?;
    write!(text, ", \"marker\": {}", region.marker)?;
    match region.area_max {
        Some(area) => write!(text, ", \"area_max\": {area:?}}}"),
        None => text.write_str("}"),
    }
}
