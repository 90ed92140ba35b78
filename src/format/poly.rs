//! Triangle's `.poly` files (Shewchuk, <https://www.cs.cmu.edu/~quake/triangle.poly.html>): vertices,
//! segments, hole points and regions, numbered from 0 or 1, with comments from `#` to the line's end.
//!
//! Every segment becomes a free segment under the rule [`Inside::Carve`]. Attributes of vertices are
//! checked to be numbers and not kept. A region's attribute is its marker and must be an integer.

use super::domain_file::{DomainReadError, Problem, TextLines, excerpt, number};
use crate::domain::{Domain, Inside, Place, Region, Segment};
use crate::point::Point2;
use std::borrow::Cow;
use std::io::{self, Write as _};

type Read<T> = Result<T, DomainReadError>;

/// Reads a `.poly` file; `node` is the `.node` file beside it, for a file without own vertices.
///
/// # Errors
/// What keeps the file from being understood, with its line.
pub fn read(bytes: &[u8], node: Option<&[u8]>) -> Result<Domain, DomainReadError> {
    let mut domain = Domain::new(Vec::new());
    let mut table = Table::new(bytes, Place::Line);
    let header =
        table.header("the numbers of vertices, dimensions, attributes and markers", 1, 4)?;
    let first = if header[0] == 0 {
        let node = node.ok_or_else(|| Problem::NodesElsewhere.at(table.place()))?;
        let mut table = Table::new(node, Place::NodeLine);
        let header =
            table.header("the numbers of vertices, dimensions, attributes and markers", 2, 4)?;
        let first = read_vertices(&mut table, &header, &mut domain)?;
        table.end()?;
        first
    } else {
        read_vertices(&mut table, &header, &mut domain)?
    };
    read_segments(&mut table, first, &mut domain)?;
    read_holes(&mut table, &mut domain)?;
    read_regions(&mut table, &mut domain)?;
    table.end()?;
    Ok(domain)
}

/// The lines of a file with their fields, comments taken off.
struct Table<'a> {
    lines: TextLines<'a>,
    place: fn(u64) -> Place,
    line: u64,
    /// Bytes of the file: no list in it can be longer.
    size: usize,
}

/// The fields of one line.
struct Row<'a> {
    text: Cow<'a, str>,
    place: Place,
}

impl<'a> Table<'a> {
    fn new(bytes: &'a [u8], place: fn(u64) -> Place) -> Self {
        Self { lines: TextLines::new(bytes), place, line: 0, size: bytes.len() }
    }

    fn place(&self) -> Place {
        (self.place)(self.line)
    }

    fn row(&mut self) -> Option<Row<'a>> {
        for (line, text) in self.lines.by_ref() {
            self.line = line;
            let text = match text.find('#') {
                Some(end) => Cow::Owned(text[..end].to_owned()),
                None => text,
            };
            if !text.trim().is_empty() {
                return Some(Row { text, place: (self.place)(line) });
            }
        }
        self.line = self.lines.number();
        None
    }

    /// A line of counts: `needed` to `most` of them; those left out are 0.
    fn header(&mut self, what: &'static str, needed: usize, most: usize) -> Read<[u64; 4]> {
        let Some(row) = self.row() else {
            let found = "the end of the file".to_owned();
            return Err(Problem::Expected { what, found }.at(self.place()));
        };
        let fields = row.fields(what, needed, most)?;
        let mut counts = [0; 4];
        for (count, field) in counts.iter_mut().zip(fields) {
            *count = row.integer(field, "a count", 0, i64::MAX)? as u64;
        }
        Ok(counts)
    }

    /// Calls `each` with as many rows as announced. Nothing is allocated for what is only announced.
    fn rows(
        &mut self,
        what: &'static str,
        stated: u64,
        mut each: impl FnMut(u64, &Row) -> Read<()>,
    ) -> Read<()> {
        for found in 0..stated {
            let Some(row) = self.row() else {
                return Err(Problem::Truncated { what, stated, found }.at(self.place()));
            };
            each(found, &row)?;
        }
        Ok(())
    }

    /// Room to reserve for a list: what is announced, but no more than the file can hold.
    fn room(&self, stated: u64) -> usize {
        usize::try_from(stated).unwrap_or(usize::MAX).min(self.size / 4)
    }

    fn end(&mut self) -> Read<()> {
        match self.row() {
            None => Ok(()),
            Some(row) => {
                let found = format!("'{}'", excerpt(&row.text));
                Err(Problem::Expected { what: "the end of the file", found }.at(row.place))
            }
        }
    }
}

impl Row<'_> {
    /// The fields, if there are between `needed` and `most`.
    fn fields(&self, what: &'static str, needed: usize, most: usize) -> Read<Vec<&str>> {
        let fields: Vec<&str> = self.text.split_whitespace().take(most.saturating_add(1)).collect();
        if (needed..=most).contains(&fields.len()) {
            return Ok(fields);
        }
        let found = format!("'{}'", excerpt(&self.text));
        Err(Problem::Expected { what, found }.at(self.place.clone()))
    }

    fn number(&self, field: &str) -> Read<f64> {
        number(field, "a number").map_err(|problem| problem.at(self.place.clone()))
    }

    fn point(&self, [x, y]: [&str; 2]) -> Read<Point2> {
        Ok(Point2::new(self.number(x)?, self.number(y)?))
    }

    fn integer(&self, field: &str, what: &'static str, low: i64, high: i64) -> Read<i64> {
        match field.parse::<i128>() {
            Ok(value) if (low.into()..=high.into()).contains(&value) => Ok(value as i64),
            Ok(_) => {
                let found = excerpt(field);
                Err(Problem::OutOfRange { what, found, low, high }.at(self.place.clone()))
            }
            Err(_) => {
                let found = format!("'{}'", excerpt(field));
                Err(Problem::Expected { what, found }.at(self.place.clone()))
            }
        }
    }

    fn marker(&self, field: &str) -> Read<i32> {
        let marker = self.integer(field, "a marker", i32::MIN.into(), i32::MAX.into())?;
        Ok(marker as i32)
    }
}

/// Reads the vertices that `header` announces; returns the number of the first one, 0 or 1.
fn read_vertices(table: &mut Table, header: &[u64; 4], domain: &mut Domain) -> Read<u64> {
    let [count, dimensions, attributes, markers] = *header;
    if dimensions != 2 {
        let (what, found) = ("the number of dimensions", dimensions.to_string());
        return Err(Problem::OutOfRange { what, found, low: 2, high: 2 }.at(table.place()));
    }
    let has_marker = has_marker(table, markers)?;
    domain.points.reserve(table.room(count));
    let columns = usize::try_from(attributes).unwrap_or(usize::MAX).saturating_add(3);
    let columns = columns.saturating_add(usize::from(has_marker));
    let mut first = 0;
    table.rows("vertices", count, |index, row| {
        let what = "a vertex: number, x, y, attributes and marker as announced";
        let fields = row.fields(what, columns, columns)?;
        if index == 0 {
            first = row.integer(fields[0], "the first vertex's number", 0, 1)? as u64;
        }
        let expected = (first + index) as i64;
        row.integer(fields[0], "the vertex's number", expected, expected)?;
        domain.points.push(row.point([fields[1], fields[2]])?);
        domain.places.points.push(row.place.clone());
        let mut rest = fields[3..].iter();
        if has_marker {
            let marker = rest.next_back().map_or(Ok(0), |field| row.marker(field))?;
            domain.point_markers.push(marker);
        }
        rest.try_for_each(|field| row.number(field).map(|_| ()))
    })?;
    Ok(first)
}

fn has_marker(table: &Table, markers: u64) -> Read<bool> {
    if markers <= 1 {
        return Ok(markers == 1);
    }
    let (what, found) = ("the number of markers", markers.to_string());
    Err(Problem::OutOfRange { what, found, low: 0, high: 1 }.at(table.place()))
}

fn read_segments(table: &mut Table, first: u64, domain: &mut Domain) -> Read<()> {
    let [count, markers, ..] = table.header("the numbers of segments and markers", 1, 2)?;
    let columns = 3 + usize::from(has_marker(table, markers)?);
    domain.segments.reserve(table.room(count));
    let (low, high) = (first as i64, first as i64 + domain.points.len() as i64 - 1);
    table.rows("segments", count, |_, row| {
        let what = "a segment: number, two vertices, and marker if announced";
        let fields = row.fields(what, columns, columns)?;
        row.integer(fields[0], "the segment's number", i64::MIN, i64::MAX)?;
        let end = |field| row.integer(field, "a segment's vertex", low, high);
        let vertices = [(end(fields[1])? - low) as u32, (end(fields[2])? - low) as u32];
        let marker = fields.get(3).map_or(Ok(0), |field| row.marker(field))?;
        domain.segments.push(Segment { vertices, marker });
        domain.places.segments.push(row.place.clone());
        Ok(())
    })
}

fn read_holes(table: &mut Table, domain: &mut Domain) -> Read<()> {
    let [count, ..] = table.header("the number of holes", 1, 1)?;
    let mut holes = Vec::with_capacity(table.room(count));
    table.rows("holes", count, |_, row| {
        let fields = row.fields("a hole: number, x, y", 3, 3)?;
        holes.push(row.point([fields[1], fields[2]])?);
        domain.places.holes.push(row.place.clone());
        Ok(())
    })?;
    domain.inside = Inside::Carve(holes);
    Ok(())
}

/// Reads the regions, if the file goes on.
fn read_regions(table: &mut Table, domain: &mut Domain) -> Read<()> {
    let Some(header) = table.row() else { return Ok(()) };
    let fields = header.fields("the number of regions", 1, 1)?;
    let count = header.integer(fields[0], "the number of regions", 0, i64::MAX)? as u64;
    table.rows("regions", count, |_, row| {
        let what = "a region: number, x, y, attribute, and greatest area or none";
        let fields = row.fields(what, 4, 5)?;
        let seed = row.point([fields[1], fields[2]])?;
        let area = fields.get(4).map_or(Ok(-1.0), |field| row.number(field))?;
        let marker = region_marker(row, fields[3])?;
        domain.regions.push(Region { seed, marker, area_max: (area > 0.0).then_some(area) });
        domain.places.regions.push(row.place.clone());
        Ok(())
    })
}

/// A region's attribute: a number in Triangle, an integer (possibly with a decimal point) here.
fn region_marker(row: &Row, field: &str) -> Read<i32> {
    let attribute = row.number(field)?;
    let marker = attribute as i32;
    if f64::from(marker) == attribute {
        return Ok(marker);
    }
    let found = format!("'{}'", excerpt(field));
    Err(Problem::Expected { what: "a region's attribute that is an integer", found }
        .at(row.place.clone()))
}

/// Writes a domain as a `.poly` file, vertices numbered from 0; [`read`] gives the same points,
/// segments, holes and regions to the bit.
///
/// The format knows segments and hole points only: loops are written as segments, after which they
/// are no loops, so a domain with loops can be written only if it has Triangle's rule.
///
/// # Errors
/// Those of `out`, and `InvalidData` if the format cannot say what the domain says: the even-odd
/// rule, or a number that is not finite.
pub fn write(domain: &Domain, out: &mut impl io::Write) -> io::Result<()> {
    let invalid = |message| Err(io::Error::new(io::ErrorKind::InvalidData, message));
    let Inside::Carve(holes) = &domain.inside else {
        return invalid("a .poly file cannot state the even-odd rule; it needs hole points");
    };
    let seeds = domain.regions.iter().map(|region| region.seed);
    if !domain.points.iter().chain(holes).copied().chain(seeds).all(Point2::is_finite) {
        return invalid("a coordinate is not finite, which a .poly file cannot say");
    }
    let mut out = io::BufWriter::new(out);
    let has_markers = u8::from(!domain.point_markers.is_empty());
    writeln!(out, "{} 2 0 {has_markers}", domain.points.len())?;
    for (i, p) in domain.points.iter().enumerate() {
        write!(out, "{i} {:?} {:?}", p.x, p.y)?;
        match domain.point_markers.get(i) {
            Some(marker) => writeln!(out, " {marker}")?,
            None => writeln!(out)?,
        }
    }
    let markers = domain.loops.iter().flat_map(|l| l.markers.iter().copied());
    let markers = markers.chain(domain.segments.iter().map(|segment| segment.marker));
    let segments: Vec<_> = domain.edges().zip(markers).collect();
    writeln!(out, "{} 1", segments.len())?;
    for (i, ([a, b], marker)) in segments.into_iter().enumerate() {
        writeln!(out, "{i} {a} {b} {marker}")?;
    }
    writeln!(out, "{}", holes.len())?;
    for (i, p) in holes.iter().enumerate() {
        writeln!(out, "{i} {:?} {:?}", p.x, p.y)?;
    }
    writeln!(out, "{}", domain.regions.len())?;
    for (i, region) in domain.regions.iter().enumerate() {
        let (p, area) = (region.seed, region.area_max.unwrap_or(-1.0));
        writeln!(out, "{i} {:?} {:?} {} {area:?}", p.x, p.y, region.marker)?;
    }
    out.flush()
}
