//! Nodes and elements of Gmsh's MSH 2.2 files: one flat list each.

use crate::format::MeshForm;
use crate::format::assemble::{Assembler, Cell};
use crate::format::error::{ReadError, WriteError};
use crate::format::msh::{self, Codec, DEFAULT_REGION, Groups, LINE, QUADRILATERAL, TRIANGLE};
use crate::format::msh_view;
use crate::format::scan::Scanner;
use crate::format::text::TextOut;
use crate::format::view::MeshView;
use std::io;

/// Reads what follows `$Nodes`.
pub(crate) fn read_nodes(
    scanner: &mut Scanner,
    codec: Codec,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    let count = scanner.count("nodes", codec.bytes(1, 0, 3))?;
    start_records(scanner, codec);
    mesh.reserve_points(count);
    for _ in 0..count {
        let line = codec.line(scanner);
        mesh.point_number(codec.int(scanner, "a node number")?);
        mesh.point(codec.point(scanner)?, line);
    }
    mesh.number_points(scanner)
}

/// The count stands on a line of its own, as text in binary files too.
fn start_records(scanner: &mut Scanner, codec: Codec) {
    if codec.endian.is_some() {
        scanner.rest_of_line();
    }
}

/// Reads what follows `$Elements`.
pub(crate) fn read_elements(
    scanner: &mut Scanner,
    codec: Codec,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    let count = scanner.count("elements", codec.bytes(2, 0, 0))?;
    start_records(scanner, codec);
    if codec.endian.is_none() {
        return (0..count).try_for_each(|_| read_text_element(scanner, codec, mesh));
    }
    let mut left = count as i64;
    while left > 0 {
        left -= read_binary_block(scanner, codec, mesh, left)?;
    }
    Ok(())
}

/// `number type tag-count tags... nodes...`
fn read_text_element(
    scanner: &mut Scanner,
    codec: Codec,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    let line = codec.line(scanner);
    let number = scanner.integer("an element number")?;
    let code = scanner.integer("an element type")?;
    let (nodes, name) = msh::element_type(scanner, code)?;
    let tag_count = scanner.integer("the number of tags of an element")?;
    let marker = read_tags(scanner, codec, tag_count)?;
    let cell = Cell { number, marker, line };
    msh::element(mesh, (code, nodes, name), cell, || scanner.integer("a node of an element"))
}

/// The tags of an element: the first is its physical group, or 0.
fn read_tags(scanner: &mut Scanner, codec: Codec, count: i64) -> Result<i64, ReadError> {
    let mut physical = 0;
    for index in 0..scanner.check_count("tags of an element", count, 1)? {
        let tag = codec.int(scanner, "a tag of an element")?;
        if index == 0 {
            physical = tag;
        }
    }
    Ok(physical)
}

/// A block of elements of one type; returns how many.
fn read_binary_block(
    scanner: &mut Scanner,
    codec: Codec,
    mesh: &mut Assembler,
    left: i64,
) -> Result<i64, ReadError> {
    let code = codec.int(scanner, "an element type")?;
    let (nodes, name) = msh::element_type(scanner, code)?;
    let count = codec.int(scanner, "the number of elements of a block")?;
    let tag_count = codec.int(scanner, "the number of tags of a block")?;
    scanner.check_count("elements of a block", count, codec.bytes(1 + nodes, 0, 0))?;
    if count < 1 || count > left {
        let found = count.to_string();
        return Err(
            scanner.malformed("a block with as many elements as declared", found.as_bytes())
        );
    }
    for _ in 0..count {
        let number = codec.int(scanner, "an element number")?;
        let marker = read_tags(scanner, codec, tag_count)?;
        let cell = Cell { number, marker, line: None };
        msh::element(mesh, (code, nodes, name), cell, || {
            codec.int(scanner, "a node of an element")
        })?;
    }
    Ok(count)
}

/// Writes an MSH 2.2 file; the physical group of an edge is its marker, that of a triangle its
/// region (1 in a mesh without regions).
pub(crate) fn write(mesh: MeshView, is_binary: bool, out: &mut TextOut) -> Result<(), WriteError> {
    let elements = mesh.edges().len() + mesh.face_count();
    if i32::try_from(elements).is_err() || i32::try_from(mesh.point_count()).is_err() {
        let what = "more than 2,147,483,647 nodes or elements";
        return Err(WriteError::Carry { form: MeshForm::Msh, what });
    }
    let groups = Groups::of(mesh);
    msh::write_header(out, "2.2", is_binary, &groups)?;
    out.text(&format!("$Nodes\n{}\n", mesh.point_count()))?;
    for (number, point) in (1..).zip(mesh.points()) {
        write_node(number, point, is_binary, out)?;
    }
    let end = if is_binary { "\n" } else { "" };
    out.text(&format!("{end}$EndNodes\n$Elements\n{elements}\n"))?;
    write_edges(mesh, &groups, is_binary, out)?;
    write_faces(mesh, &groups, is_binary, out)?;
    out.text(&format!("{end}$EndElements\n"))?;
    msh_view::write(mesh.parameters(), is_binary, out)?;
    Ok(())
}

fn write_node(number: i32, point: [f64; 3], binary: bool, out: &mut TextOut) -> io::Result<()> {
    if binary {
        out.bytes(&number.to_le_bytes())?;
        return point.iter().try_for_each(|c| out.bytes(&c.to_le_bytes()));
    }
    out.integer(i64::from(number), b' ')?;
    out.float(point[0], b' ')?;
    out.float(point[1], b' ')?;
    out.float(point[2], b'\n')
}

fn write_edges(mesh: MeshView, groups: &Groups, binary: bool, out: &mut TextOut) -> io::Result<()> {
    let edges = mesh.edges();
    write_block_header(LINE, edges.len(), binary, out)?;
    for (number, edge) in (1..).zip(edges) {
        let tags = [i64::from(edge.marker), groups.curve(edge.marker)];
        write_element((number, LINE), tags, &edge.vertices, binary, out)?;
    }
    Ok(())
}

fn write_faces(mesh: MeshView, groups: &Groups, binary: bool, out: &mut TextOut) -> io::Result<()> {
    let quads = mesh.quad_count();
    let first = mesh.edges().len() as i64 + 1;
    for (index, face) in mesh.faces().enumerate() {
        let code = if index < quads { QUADRILATERAL } else { TRIANGLE };
        if index == 0 || index == quads {
            let length = if index < quads { quads } else { mesh.face_count() - quads };
            write_block_header(code, length, binary, out)?;
        }
        let region = mesh.face_region(index, DEFAULT_REGION);
        let tags = [i64::from(region), groups.surface(region)];
        write_element((first + index as i64, code), tags, face.corners(), binary, out)?;
    }
    Ok(())
}

/// In a binary file a block of elements of one type starts with type, count, number of tags.
fn write_block_header(code: i64, count: usize, binary: bool, out: &mut TextOut) -> io::Result<()> {
    if !binary || count == 0 {
        return Ok(());
    }
    [code as i32, count as i32, 2].iter().try_for_each(|value| out.bytes(&value.to_le_bytes()))
}

fn write_element(
    (number, code): (i64, i64),
    tags: [i64; 2],
    nodes: &[u32],
    binary: bool,
    out: &mut TextOut,
) -> io::Result<()> {
    if binary {
        let values = [number, tags[0], tags[1]];
        values.iter().try_for_each(|&value| out.bytes(&(value as i32).to_le_bytes()))?;
        return nodes.iter().try_for_each(|&node| out.bytes(&(node as i32 + 1).to_le_bytes()));
    }
    for value in [number, code, 2, tags[0]] {
        out.integer(value, b' ')?;
    }
    out.integer(tags[1], b' ')?;
    for (index, &node) in nodes.iter().enumerate() {
        let end = if index + 1 == nodes.len() { b'\n' } else { b' ' };
        out.integer(i64::from(node) + 1, end)?;
    }
    Ok(())
}
