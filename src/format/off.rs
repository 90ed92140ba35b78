//! OFF, the Object File Format of Geomview: points, then faces as lists of point indices from 0.
//!
//! Source: the Geomview manual, "OFF files". Normals, colours and texture coordinates of `NOFF`,
//! `COFF`, `STOFF` points are skipped; binary and 4-dimensional files are refused.

use crate::format::ReadOptions;
use crate::format::assemble::{Assembler, Cell};
use crate::format::error::ReadError;
use crate::format::scan::Scanner;
use crate::format::text::TextOut;
use crate::format::view::MeshView;
use crate::mesh::MeshData;
use std::io;

/// Reads an OFF file.
///
/// # Errors
/// The first fault with its line.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let mut scanner = Scanner::new(bytes).with_comments(b'#');
    read_keyword(&mut scanner)?;
    let points = scanner.count("points", 6)?;
    let faces = scanner.count("faces", 2)?;
    // The number of edges is often 0 or missing: nobody relies on it.
    scanner.rest_of_line();
    let mut mesh = Assembler::new(0, options.split_quads);
    mesh.reserve_points(points);
    for _ in 0..points {
        read_point(&mut scanner, &mut mesh)?;
    }
    for number in 0..faces {
        read_face(&mut scanner, number as i64, &mut mesh)?;
    }
    if !scanner.is_at_end() {
        let token = scanner.peek();
        return Err(scanner.malformed("the end of the file after the last face", token));
    }
    mesh.finish(&scanner)
}

/// `OFF` and its prefixes; the keyword may be missing.
fn read_keyword(scanner: &mut Scanner) -> Result<(), ReadError> {
    let keyword = scanner.peek();
    if keyword.first().is_some_and(u8::is_ascii_digit) {
        return Ok(());
    }
    match keyword {
        b"OFF" | b"COFF" | b"NOFF" | b"CNOFF" | b"STOFF" | b"STCOFF" | b"STNOFF" | b"STCNOFF" => {}
        [.., b'4' | b'n', b'O', b'F', b'F'] => {
            let what = "a 4- or n-dimensional OFF file".to_owned();
            return Err(scanner.unsupported(what, "save it with three coordinates"));
        }
        other => return Err(scanner.malformed("`OFF`", other)),
    }
    scanner.token("`OFF`")?;
    if scanner.peek() == b"BINARY" {
        return Err(scanner.unsupported("a binary OFF file".to_owned(), "save it as ASCII"));
    }
    Ok(())
}

/// `x y z`, then whatever the prefixes promise up to the end of the line.
fn read_point(scanner: &mut Scanner, mesh: &mut Assembler) -> Result<(), ReadError> {
    scanner.skip_blank();
    let line = scanner.line();
    let point = [
        scanner.float("the x coordinate of a point")?,
        scanner.float("the y coordinate of a point")?,
        scanner.float("the z coordinate of a point")?,
    ];
    scanner.rest_of_line();
    mesh.point(point, line);
    Ok(())
}

/// `n i1 ... in`, then an optional colour up to the end of the line.
fn read_face(scanner: &mut Scanner, number: i64, mesh: &mut Assembler) -> Result<(), ReadError> {
    scanner.skip_blank();
    let cell = Cell { number, marker: 0, line: scanner.line() };
    let count = scanner.count("corners of a face", 2)?;
    let mut corners = [0; 4];
    for index in 0..count {
        let corner = scanner.integer("a corner of a face")?;
        if let Some(entry) = corners.get_mut(index) {
            *entry = corner;
        }
    }
    scanner.rest_of_line();
    polygon(mesh, &corners, count, cell);
    Ok(())
}

/// Hands over a face with `count` corners, of which the first four are given.
pub(crate) fn polygon(mesh: &mut Assembler, corners: &[i64; 4], count: usize, cell: Cell) {
    match count {
        2 => mesh.edge([corners[0], corners[1]], cell),
        3 => mesh.triangle([corners[0], corners[1], corners[2]], cell),
        4 => mesh.quad(*corners, cell, 4, "quadrilateral"),
        _ => mesh.other(count as i64, 1, || match count {
            1 => "point".to_owned(),
            count => format!("polygon with {count} corners"),
        }),
    }
}

/// Writes an OFF file; marked edges and regions are dropped.
pub(crate) fn write(mesh: MeshView, out: &mut TextOut) -> io::Result<()> {
    out.text(&format!("OFF\n{} {} 0\n", mesh.point_count(), mesh.face_count()))?;
    for [x, y, z] in mesh.points() {
        out.float(x, b' ')?;
        out.float(y, b' ')?;
        out.float(z, b'\n')?;
    }
    for face in mesh.faces() {
        out.bytes(if face.corners().len() == 4 { b"4 " } else { b"3 " })?;
        out.corners(face.corners(), 0, b'\n')?;
    }
    Ok(())
}
