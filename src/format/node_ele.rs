//! Triangle's mesh files: points in `.node` (or at the head of a `.poly`), triangles in `.ele`,
//! marked edges in `.edge`. TetGen's three coordinates are read too.
//!
//! Source: the Triangle manual, "File formats" (Shewchuk, 1996-2005).

use crate::format::ReadOptions;
use crate::format::assemble::{Assembler, Cell};
use crate::format::error::{ReadError, ReadFault};
use crate::format::scan::Scanner;
use crate::format::text::TextOut;
use crate::format::view::MeshView;
use crate::mesh::MeshData;
use std::io;

fn scan(bytes: &[u8]) -> Scanner<'_> {
    Scanner::new(bytes).with_comments(b'#')
}

/// Reads an `.ele` file with the points of [`ReadOptions::nodes`] and the marked edges of
/// [`ReadOptions::edges`]; without the latter, the segments of a `.poly` given as nodes.
///
/// Triangle's attributes are reals: the first becomes the region when it is a 32-bit integer in
/// every triangle.
///
/// # Errors
/// The first fault with its file and line; [`ReadFault::Companion`] without nodes.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let mut ele = scan(bytes);
    let Some(nodes) = options.nodes else {
        return Err(ele.fail(ReadFault::Companion { extension: ".node" }));
    };
    let mut mesh = Assembler::new(1, options.split_quads);
    let mut node = scan(nodes);
    read_nodes(&mut node, &mut mesh).map_err(|error| error.in_file(".node: "))?;
    read_triangles(&mut ele, &mut mesh)?;
    match options.edges {
        Some(edges) => {
            read_edges(&mut scan(edges), &mut mesh).map_err(|error| error.in_file(".edge: "))?;
        }
        // A `.poly` goes on with its segments; a `.node` file ends here.
        None if !node.is_at_end() => {
            read_edges(&mut node, &mut mesh).map_err(|error| error.in_file(".node: "))?;
        }
        None => {}
    }
    mesh.finish(&node)
}

/// Reads the points of a `.node` file.
///
/// # Errors
/// The first fault with its line.
pub(crate) fn read_points(bytes: &[u8]) -> Result<MeshData, ReadError> {
    let mut node = scan(bytes);
    let mut mesh = Assembler::new(1, false);
    read_nodes(&mut node, &mut mesh)?;
    if !node.is_at_end() {
        let token = node.peek();
        return Err(node.malformed("the end of the file after the last point", token));
    }
    mesh.finish(&node)
}

/// Fails unless nothing is left on the line.
fn end_line(scanner: &mut Scanner, expected: &str) -> Result<(), ReadError> {
    match scanner.token_on_line() {
        None => Ok(()),
        Some(token) => Err(scanner.malformed(expected, token)),
    }
}

/// `count dimension attributes markers`, then `number x y [z] attributes... [marker]`.
fn read_nodes(scanner: &mut Scanner, mesh: &mut Assembler) -> Result<(), ReadError> {
    let count = scanner.count("points", 6)?;
    let dimension = scanner.integer_on_line("the dimension, 2 or 3")?.unwrap_or(2);
    if dimension != 2 && dimension != 3 {
        return Err(scanner.malformed("the dimension, 2 or 3", dimension.to_string().as_bytes()));
    }
    let attributes = scanner.integer_on_line("the number of attributes")?.unwrap_or(0);
    let attributes = scanner.check_count("attributes", attributes, 1)?;
    let has_marker = scanner.integer_on_line("0 or 1 boundary markers")?.unwrap_or(0) != 0;
    end_line(scanner, "the end of the first line")?;
    mesh.reserve_points(count);
    for _ in 0..count {
        scanner.skip_blank();
        let line = scanner.line();
        mesh.point_number(scanner.integer("the number of a point")?);
        let point = scanner.point(dimension as usize)?;
        for _ in 0..attributes {
            // Read for its place in the line only; its digits say nothing of the coordinates.
            scanner.token("an attribute of a point")?;
        }
        if has_marker {
            scanner.integer_on_line("the marker of a point")?;
        }
        end_line(scanner, "the end of the line of a point")?;
        mesh.point(point, line);
    }
    mesh.number_points(scanner)
}

/// `count nodes-per-triangle attributes`, then `number a b c attributes...`.
fn read_triangles(scanner: &mut Scanner, mesh: &mut Assembler) -> Result<(), ReadError> {
    let count = scanner.count("triangles", 8)?;
    let corners = scanner.integer_on_line("3, 4 or 6 nodes per triangle")?.unwrap_or(3);
    if ![3, 4, 6].contains(&corners) {
        let found = corners.to_string();
        return Err(scanner.malformed("3, 4 or 6 nodes per triangle", found.as_bytes()));
    }
    let attributes = scanner.integer_on_line("the number of attributes")?.unwrap_or(0);
    let attributes = scanner.check_count("attributes", attributes, 1)?;
    end_line(scanner, "the end of the first line")?;
    let has_regions = attributes > 0 && has_integer_attributes(scanner.clone(), count, corners);
    for _ in 0..count {
        scanner.skip_blank();
        let line = scanner.line();
        let number = scanner.integer("the number of a triangle")?;
        let mut nodes = [0; 6];
        for node in &mut nodes[..corners as usize] {
            *node = scanner.integer("a corner of a triangle")?;
        }
        let mut marker = 0;
        for index in 0..attributes {
            let token = scanner.token("an attribute of a triangle")?;
            if index == 0 && has_regions {
                marker = integer_attribute(token).unwrap_or(0);
            }
        }
        end_line(scanner, "the end of the line of a triangle")?;
        let cell = Cell { number, marker, line };
        match corners {
            3 => mesh.triangle([nodes[0], nodes[1], nodes[2]], cell),
            4 => mesh.other(4, 1, || "tetrahedron".to_owned()),
            _ => mesh.other(6, 1, || "second-order triangle".to_owned()),
        }
    }
    Ok(())
}

/// An attribute that is a 32-bit integer, written as an integer or as a real such as `3.0`.
fn integer_attribute(token: &[u8]) -> Option<i64> {
    let value: f64 = std::str::from_utf8(token).ok()?.parse().ok()?;
    let is_marker = value.fract() == 0.0 && value.abs() <= f64::from(i32::MAX);
    is_marker.then_some(value as i64)
}

/// Whether the first attribute of all triangles is a 32-bit integer.
fn has_integer_attributes(mut scanner: Scanner, count: usize, corners: i64) -> bool {
    (0..count).all(|_| {
        scanner.skip_blank();
        let attribute =
            (0..corners + 2).map_while(|_| scanner.token_on_line()).nth(corners as usize + 1);
        scanner.rest_of_line();
        attribute.and_then(integer_attribute).is_some()
    })
}

/// `count markers`, then `number a b [marker]`; edges without a marker are the inner edges of the
/// triangulation, which say nothing.
fn read_edges(scanner: &mut Scanner, mesh: &mut Assembler) -> Result<(), ReadError> {
    let count = scanner.count("edges", 6)?;
    let has_marker = scanner.integer_on_line("0 or 1 boundary markers")?.unwrap_or(0) != 0;
    end_line(scanner, "the end of the first line of the edges")?;
    for _ in 0..count {
        scanner.skip_blank();
        let line = scanner.line();
        let number = scanner.integer("the number of an edge")?;
        let ends = [scanner.integer("an end of an edge")?, scanner.integer("an end of an edge")?];
        let marker = scanner.integer_on_line("the marker of an edge")?.unwrap_or(0);
        end_line(scanner, "the end of the line of an edge")?;
        if has_marker && marker != 0 {
            mesh.edge(ends, Cell { number, marker, line });
        }
    }
    Ok(())
}

/// Writes the `.node` file: points from 1, three coordinates only if some z is not +0.0.
pub(crate) fn write_nodes(mesh: MeshView, out: &mut TextOut) -> io::Result<()> {
    let dimension = if mesh.is_plane() { 2 } else { 3 };
    out.text(&format!("{} {dimension} 0 0\n", mesh.point_count()))?;
    for (number, point) in (1..).zip(mesh.points()) {
        out.integer(number, b' ')?;
        for &coordinate in &point[..dimension - 1] {
            out.float(coordinate, b' ')?;
        }
        out.float(point[dimension - 1], b'\n')?;
    }
    Ok(())
}

/// Writes the `.ele` file; the region, where the mesh has regions, is the attribute.
pub(crate) fn write_triangles(mesh: MeshView, out: &mut TextOut) -> io::Result<()> {
    let has_regions = mesh.has_regions();
    out.text(&format!("{} 3 {}\n", mesh.triangles().len(), u8::from(has_regions)))?;
    for (index, triangle) in mesh.triangles().iter().enumerate() {
        out.integer(index as i64 + 1, b' ')?;
        out.integer(i64::from(triangle[0]) + 1, b' ')?;
        out.integer(i64::from(triangle[1]) + 1, b' ')?;
        out.integer(i64::from(triangle[2]) + 1, if has_regions { b' ' } else { b'\n' })?;
        if has_regions {
            out.integer(i64::from(mesh.region(index, 0)), b'\n')?;
        }
    }
    Ok(())
}

/// Writes the `.edge` file: the marked edges.
pub(crate) fn write_edges(mesh: MeshView, out: &mut TextOut) -> io::Result<()> {
    out.text(&format!("{} 1\n", mesh.edges().len()))?;
    for (number, edge) in (1..).zip(mesh.edges()) {
        out.integer(number, b' ')?;
        out.integer(i64::from(edge.vertices[0]) + 1, b' ')?;
        out.integer(i64::from(edge.vertices[1]) + 1, b' ')?;
        out.integer(i64::from(edge.marker), b'\n')?;
    }
    Ok(())
}
