//! PLY, the Stanford polygon form: a header that declares elements and their properties, then the
//! values as text or binary.
//!
//! Source: "The PLY polygon file format" (Turk, 1994). Faces may have a property `region`, edges
//! `vertex1`, `vertex2` and `marker`; all of them int.

use crate::format::ReadOptions;
use crate::format::assemble::{Assembler, Cell};
use crate::format::error::ReadError;
use crate::format::off;
use crate::format::scalar::Scalar;
use crate::format::scan::{Endian, Scanner};
use crate::format::text::TextOut;
use crate::format::view::MeshView;
use crate::mesh::MeshData;
use std::io;

/// A property of an element.
#[derive(Debug)]
struct Property {
    name: Vec<u8>,
    scalar: Scalar,
    /// The type of the count before a list; `None` for a single value.
    count: Option<Scalar>,
}

/// An element: its name, how often it occurs, its properties.
#[derive(Debug)]
struct Element {
    name: Vec<u8>,
    count: i64,
    properties: Vec<Property>,
}

/// Reads a PLY file: ASCII or binary of either byte order.
///
/// # Errors
/// The first fault with its line, or its byte offset when the file is binary.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let mut scanner = Scanner::new(bytes);
    let (endian, elements) = read_header(&mut scanner)?;
    if endian.is_some() {
        scanner.set_binary();
    }
    let mut mesh = Assembler::new(0, options.split_quads);
    for element in &elements {
        let values = Values { endian, element };
        match element.name.as_slice() {
            b"vertex" => values.read_vertices(&mut scanner, &mut mesh)?,
            b"face" => values.read_faces(&mut scanner, &mut mesh)?,
            b"edge" => values.read_edges(&mut scanner, &mut mesh)?,
            _ => values.read_others(&mut scanner, &mut mesh)?,
        }
    }
    if !elements.iter().any(|element| element.name == b"vertex") {
        return Err(scanner.malformed("`element vertex`", b"end_header"));
    }
    mesh.finish(&scanner)
}

fn read_header(scanner: &mut Scanner) -> Result<(Option<Endian>, Vec<Element>), ReadError> {
    scanner.expect("ply")?;
    scanner.expect("format")?;
    let endian = match scanner.token("ascii or binary_little_endian")? {
        b"ascii" => None,
        b"binary_little_endian" => Some(Endian::Little),
        b"binary_big_endian" => Some(Endian::Big),
        other => return Err(scanner.malformed("ascii or binary_little_endian", other)),
    };
    scanner.expect("1.0")?;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        match scanner.token("a line of the header, such as `element` or `end_header`")? {
            b"comment" | b"obj_info" => drop(scanner.rest_of_line()),
            b"element" => {
                let name = scanner.token("the name of an element")?.to_vec();
                let count = scanner.integer("the number of elements")?;
                elements.push(Element { name, count, properties: Vec::new() });
            }
            b"property" => {
                let property = read_property(scanner)?;
                match elements.last_mut() {
                    Some(element) => element.properties.push(property),
                    None => return Err(scanner.malformed("`element` before", b"property")),
                }
            }
            b"end_header" => {
                scanner.rest_of_line();
                return Ok((endian, elements));
            }
            other => return Err(scanner.malformed("`element`, `property` or `end_header`", other)),
        }
    }
}

fn read_property(scanner: &mut Scanner) -> Result<Property, ReadError> {
    let scalar = |scanner: &mut Scanner| {
        let name = scanner.token("a number type such as `double`")?;
        Scalar::from_ply_name(name)
            .ok_or_else(|| scanner.malformed("a number type such as `double`", name))
    };
    let is_list = scanner.peek() == b"list";
    let count = if is_list {
        scanner.token("`list`")?;
        Some(scalar(scanner)?)
    } else {
        None
    };
    let scalar = scalar(scanner)?;
    let name = scanner.token("the name of a property")?.to_vec();
    Ok(Property { name, scalar, count })
}

/// The values of an element.
struct Values<'e> {
    endian: Option<Endian>,
    element: &'e Element,
}

impl Values<'_> {
    /// How often the element occurs, checked against the bytes left.
    fn count(&self, scanner: &Scanner, what: &'static str) -> Result<usize, ReadError> {
        let size = |property: &Property| match self.endian {
            None => 2,
            Some(_) => property.count.unwrap_or(property.scalar).size(),
        };
        let bytes_each = self.element.properties.iter().map(size).sum();
        scanner.check_count(what, self.element.count, bytes_each)
    }

    fn integer(&self, scanner: &mut Scanner, scalar: Scalar) -> Result<i64, ReadError> {
        match self.endian {
            None => scanner.integer("an integer"),
            Some(endian) => Ok(scalar.integer(scanner.take(scalar.size(), "an integer")?, endian)),
        }
    }

    fn float(&self, scanner: &mut Scanner, scalar: Scalar) -> Result<f64, ReadError> {
        match self.endian {
            None => scanner.float("a coordinate"),
            Some(endian) => Ok(scalar.float(scanner.take(scalar.size(), "a number")?, endian)),
        }
    }

    /// Skips a property.
    fn skip(&self, scanner: &mut Scanner, property: &Property) -> Result<(), ReadError> {
        let count = match property.count {
            None => 1,
            Some(scalar) => {
                let count = self.integer(scanner, scalar)?;
                let bytes_each = if self.endian.is_some() { property.scalar.size() } else { 2 };
                scanner.check_count("values of a list", count, bytes_each)?
            }
        };
        if self.endian.is_some() {
            return scanner.take(count * property.scalar.size(), "a property").map(drop);
        }
        (0..count).try_for_each(|_| scanner.token("a property").map(drop))
    }

    /// The rank of the single-valued property with this name.
    fn rank(&self, name: &str) -> Option<usize> {
        let is_it = |p: &Property| p.name == name.as_bytes() && p.count.is_none();
        self.element.properties.iter().position(is_it)
    }

    fn read_vertices(&self, scanner: &mut Scanner, mesh: &mut Assembler) -> Result<(), ReadError> {
        let count = self.count(scanner, "vertices")?;
        let ranks = ["x", "y", "z"].map(|name| self.rank(name));
        if ranks[0].is_none() || ranks[1].is_none() {
            return Err(scanner.malformed("vertices with properties x and y", b"end_header"));
        }
        mesh.reserve_points(count);
        for _ in 0..count {
            if self.endian.is_none() {
                scanner.skip_blank();
            }
            let line = scanner.line();
            let mut point = [0.0; 3];
            for (rank, property) in self.element.properties.iter().enumerate() {
                match ranks.iter().position(|&known| known == Some(rank)) {
                    Some(axis) => point[axis] = self.float(scanner, property.scalar)?,
                    None => self.skip(scanner, property)?,
                }
            }
            mesh.point(point, line);
        }
        Ok(())
    }

    fn read_faces(&self, scanner: &mut Scanner, mesh: &mut Assembler) -> Result<(), ReadError> {
        let count = self.count(scanner, "faces")?;
        let region = self.rank("region");
        let is_list = |p: &Property| {
            matches!(p.name.as_slice(), b"vertex_indices" | b"vertex_index") && p.count.is_some()
        };
        let Some(list) = self.element.properties.iter().position(is_list) else {
            if count == 0 {
                return Ok(());
            }
            return Err(scanner.malformed("faces with a list vertex_indices", b"end_header"));
        };
        for number in 0..count as i64 {
            if self.endian.is_none() {
                scanner.skip_blank();
            }
            let mut cell = Cell { number, marker: 0, line: scanner.line() };
            let mut corners = ([0; 4], 0);
            for (rank, property) in self.element.properties.iter().enumerate() {
                if rank == list {
                    corners = self.read_corners(scanner, property)?;
                } else if Some(rank) == region && property.scalar.is_integer() {
                    cell.marker = self.integer(scanner, property.scalar)?;
                } else {
                    self.skip(scanner, property)?;
                }
            }
            off::polygon(mesh, &corners.0, corners.1, cell);
        }
        Ok(())
    }

    /// The first four corners of a face, and how many it has.
    fn read_corners(
        &self,
        scanner: &mut Scanner,
        property: &Property,
    ) -> Result<([i64; 4], usize), ReadError> {
        let scalar = property.count.unwrap_or(Scalar::U8);
        let count = self.integer(scanner, scalar)?;
        let bytes_each = if self.endian.is_some() { property.scalar.size() } else { 2 };
        let count = scanner.check_count("corners of a face", count, bytes_each)?;
        let mut corners = [0; 4];
        for index in 0..count {
            let corner = self.integer(scanner, property.scalar)?;
            if let Some(entry) = corners.get_mut(index) {
                *entry = corner;
            }
        }
        Ok((corners, count))
    }

    fn read_edges(&self, scanner: &mut Scanner, mesh: &mut Assembler) -> Result<(), ReadError> {
        let count = self.count(scanner, "edges")?;
        let ranks = ["vertex1", "vertex2", "marker"].map(|name| self.rank(name));
        if count > 0 && (ranks[0].is_none() || ranks[1].is_none()) {
            return Err(scanner.malformed("edges with vertex1 and vertex2", b"end_header"));
        }
        for number in 0..count as i64 {
            if self.endian.is_none() {
                scanner.skip_blank();
            }
            let line = scanner.line();
            let mut values = [0; 3];
            for (rank, property) in self.element.properties.iter().enumerate() {
                match ranks.iter().position(|&known| known == Some(rank)) {
                    Some(place) if property.scalar.is_integer() => {
                        values[place] = self.integer(scanner, property.scalar)?;
                    }
                    _ => self.skip(scanner, property)?,
                }
            }
            mesh.edge([values[0], values[1]], Cell { number, marker: values[2], line });
        }
        Ok(())
    }

    /// Elements that are no vertices, faces or edges: triangle strips are cells, others are not.
    fn read_others(&self, scanner: &mut Scanner, mesh: &mut Assembler) -> Result<(), ReadError> {
        let properties = &self.element.properties;
        if properties.is_empty() {
            return Ok(());
        }
        let count = self.count(scanner, "elements")?;
        for _ in 0..count {
            properties.iter().try_for_each(|property| self.skip(scanner, property))?;
        }
        if self.element.name == b"tristrips" {
            mesh.other(-1, count as u64, || "triangle strip".to_owned());
        }
        Ok(())
    }
}

/// Writes a PLY file, ASCII or binary little-endian. Marked edges and regions are dropped: an element
/// `edge` and more properties are good PLY, but common readers refuse the whole file for them.
pub(crate) fn write(mesh: MeshView, is_binary: bool, out: &mut TextOut) -> io::Result<()> {
    let format = if is_binary { "binary_little_endian" } else { "ascii" };
    let (points, triangles) = (mesh.point_count(), mesh.triangles());
    out.text(&format!("ply\nformat {format} 1.0\nelement vertex {points}\n"))?;
    out.text("property double x\nproperty double y\nproperty double z\n")?;
    out.text(&format!("element face {}\n", triangles.len()))?;
    out.text("property list uchar int vertex_indices\n")?;
    out.text("end_header\n")?;
    for [x, y, z] in mesh.points() {
        if is_binary {
            [x, y, z].iter().try_for_each(|c| out.bytes(&c.to_le_bytes()))?;
        } else {
            out.float(x, b' ')?;
            out.float(y, b' ')?;
            out.float(z, b'\n')?;
        }
    }
    for &[a, b, c] in triangles {
        if is_binary {
            out.bytes(&[3])?;
            [a, b, c].iter().try_for_each(|corner| out.bytes(&corner.to_le_bytes()))?;
        } else {
            out.bytes(b"3 ")?;
            out.integer(i64::from(a), b' ')?;
            out.integer(i64::from(b), b' ')?;
            out.integer(i64::from(c), b'\n')?;
        }
    }
    Ok(())
}
