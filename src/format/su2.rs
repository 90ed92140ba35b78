//! SU2's native meshes (`.su2`): `KEY= value` lines, each before its list.
//!
//! Source: the SU2 documentation, "Mesh file". Cell types are VTK's. Marker tags are names: a file
//! whose tags are all integers gives those, any other numbers its tags 1, 2, 3, ... in file order.

use crate::format::ReadOptions;
use crate::format::assemble::{Assembler, Cell};
use crate::format::error::{ReadError, ReadFault};
use crate::format::scan::Scanner;
use crate::format::text::TextOut;
use crate::format::view::MeshView;
use crate::format::vtk_cell;
use crate::mesh::{MarkedEdge, MeshData};
use std::collections::BTreeMap;
use std::io;

/// Reads an SU2 mesh.
///
/// # Errors
/// The first fault with its line.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let mut scanner = Scanner::new(bytes).with_comments(b'%');
    let mut reader = Su2Reader {
        dimension: 0,
        marker: 0,
        tags: marker_tags(scanner.clone()),
        declared: None,
        is_skipping: false,
        mesh: Assembler::new(0, options.split_quads),
    };
    let (mut has_points, mut has_cells) = (false, false);
    while !scanner.is_at_end() {
        let key = read_key(&mut scanner, reader.is_skipping)?;
        reader.section(&mut scanner, key)?;
        has_points |= key == b"NPOIN";
        has_cells |= key == b"NELEM";
    }
    if !has_points || !has_cells {
        let missing = if has_cells { "`NPOIN=`" } else { "`NELEM=`" };
        return Err(scanner.malformed(missing, b""));
    }
    let present = reader.marker as u64;
    if let Some(declared) = reader.declared.filter(|&declared| declared != present as i64) {
        return Err(scanner.fail(ReadFault::Mismatch { what: "markers", declared, present }));
    }
    reader.mesh.finish(&scanner)
}

/// The number of each marker tag, in file order.
fn marker_tags(mut scanner: Scanner) -> Vec<i64> {
    let mut names = Vec::new();
    while let Some(line) = scanner.next_line() {
        if let Some(value) = line.strip_prefix(b"MARKER_TAG") {
            let value = value.trim_ascii_start();
            names.push(value.strip_prefix(b"=").unwrap_or(value).trim_ascii());
        }
    }
    let number = |name: &&[u8]| std::str::from_utf8(name).ok()?.parse::<i32>().ok().map(i64::from);
    let numbers: Option<Vec<i64>> = names.iter().map(number).collect();
    numbers.unwrap_or_else(|| (1..=names.len() as i64).collect())
}

/// Consumes `KEY=`, also with spaces before the sign; an empty key is a line without one.
fn read_key<'a>(scanner: &mut Scanner<'a>, is_skipping: bool) -> Result<&'a [u8], ReadError> {
    let mut line = scanner.clone();
    let text = line.next_line().unwrap_or_default();
    let Some(sign) = text.iter().position(|&byte| byte == b'=') else {
        if is_skipping {
            *scanner = line;
            return Ok(b"");
        }
        return Err(scanner.malformed("a key such as `NPOIN=`", text));
    };
    scanner.skip_bytes(sign + 1);
    Ok(text[..sign].trim_ascii())
}

struct Su2Reader {
    /// 0 until `NDIME=` was met.
    dimension: usize,
    /// How many markers were met.
    marker: usize,
    tags: Vec<i64>,
    /// The value of `NMARK=`.
    declared: Option<i64>,
    /// Whether lines without a key belong to a section that says nothing of the mesh.
    is_skipping: bool,
    mesh: Assembler,
}

impl Su2Reader {
    fn section(&mut self, scanner: &mut Scanner, key: &[u8]) -> Result<(), ReadError> {
        if !key.is_empty() {
            self.is_skipping = key.starts_with(b"FFD_");
        }
        match key {
            b"NDIME" => match scanner.integer("the dimension, 2 or 3")? {
                value @ (2 | 3) => self.dimension = value as usize,
                other => {
                    let found = other.to_string();
                    return Err(scanner.malformed("the dimension, 2 or 3", found.as_bytes()));
                }
            },
            b"NELEM" => self.cells(scanner, "elements", 0)?,
            b"NPOIN" => self.points(scanner)?,
            b"NMARK" => self.declared = Some(scanner.integer("the number of markers")?),
            b"MARKER_TAG" => {
                self.marker += 1;
                scanner.rest_of_line();
            }
            b"MARKER_ELEMS" => {
                let tag = self.marker.checked_sub(1).and_then(|index| self.tags.get(index));
                let tag = *tag.ok_or_else(|| scanner.malformed("`MARKER_TAG=` before", key))?;
                self.cells(scanner, "elements of a marker", tag)?;
            }
            b"NZONE" if scanner.clone().integer("zones")? != 1 => {
                let what = "a mesh of several zones".to_owned();
                return Err(scanner.unsupported(what, "save each zone in a file of its own"));
            }
            _ => drop(scanner.rest_of_line()),
        }
        Ok(())
    }

    /// `count [count]`, then `x y [z] [index]`.
    fn points(&mut self, scanner: &mut Scanner) -> Result<(), ReadError> {
        if self.dimension == 0 {
            return Err(scanner.malformed("`NDIME=` before points", b"NPOIN="));
        }
        let count = scanner.count("points", 4)?;
        scanner.rest_of_line();
        self.mesh.reserve_points(count);
        for _ in 0..count {
            scanner.skip_blank();
            let line = scanner.line();
            let point = scanner.point(self.dimension)?;
            scanner.rest_of_line();
            self.mesh.point(point, line);
        }
        Ok(())
    }

    /// `count`, then `type corners... [index]`.
    fn cells(
        &mut self,
        scanner: &mut Scanner,
        what: &'static str,
        marker: i64,
    ) -> Result<(), ReadError> {
        let count = scanner.count(what, 4)?;
        scanner.rest_of_line();
        for number in 0..count as i64 {
            scanner.skip_blank();
            let cell = Cell { number, marker, line: scanner.line() };
            let code = scanner.integer("a VTK cell type")?;
            let corners = match code {
                1 => 1,
                3 => 2,
                5 => 3,
                9 | 10 => 4,
                14 => 5,
                13 => 6,
                12 => 8,
                other => {
                    let found = other.to_string();
                    return Err(scanner.malformed("a VTK cell type such as 5", found.as_bytes()));
                }
            };
            let mut values = [0; 8];
            for value in &mut values[..corners] {
                *value = scanner.integer("the index of a point")?;
            }
            scanner.rest_of_line();
            let result = vtk_cell::cell(&mut self.mesh, code, &values[..corners], cell);
            result.map_err(|expected| scanner.malformed(expected, b"another number"))?;
        }
        Ok(())
    }
}

/// Writes an SU2 mesh: the edges of each marker together, in the order in which markers first
/// occur; regions are dropped. Two dimensions if every z is +0.0.
pub(crate) fn write(mesh: MeshView, out: &mut TextOut) -> io::Result<()> {
    let dimension = if mesh.is_plane() { 2 } else { 3 };
    out.text(&format!("NDIME= {dimension}\nNELEM= {}\n", mesh.face_count()))?;
    for (index, face) in (0..).zip(mesh.faces()) {
        out.bytes(if face.corners().len() == 4 { b"9 " } else { b"5 " })?;
        out.corners(face.corners(), 0, b' ')?;
        out.integer(index, b'\n')?;
    }
    out.text(&format!("NPOIN= {}\n", mesh.point_count()))?;
    for (index, point) in (0..).zip(mesh.points()) {
        for &coordinate in &point[..dimension] {
            out.float(coordinate, b' ')?;
        }
        out.integer(index, b'\n')?;
    }
    let groups = by_marker(mesh.edges());
    out.text(&format!("NMARK= {}\n", groups.len()))?;
    for group in groups {
        let marker = group[0].marker;
        out.text(&format!("MARKER_TAG= {marker}\nMARKER_ELEMS= {}\n", group.len()))?;
        for edge in group {
            out.bytes(b"3 ")?;
            out.integer(i64::from(edge.vertices[0]), b' ')?;
            out.integer(i64::from(edge.vertices[1]), b'\n')?;
        }
    }
    Ok(())
}

/// The edges of each marker, in the order in which markers first occur.
fn by_marker(edges: &[MarkedEdge]) -> Vec<Vec<MarkedEdge>> {
    let mut ranks = BTreeMap::new();
    let mut groups: Vec<Vec<MarkedEdge>> = Vec::new();
    for &edge in edges {
        let rank = *ranks.entry(edge.marker).or_insert(groups.len());
        if rank == groups.len() {
            groups.push(Vec::new());
        }
        groups[rank].push(edge);
    }
    groups
}
