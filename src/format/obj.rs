//! Wavefront OBJ: a statement a line.
//!
//! Source: the Wavefront "Advanced Visualizer" manual, appendix B1. Of a face's `v/vt/vn` the
//! vertex counts; a negative number counts back from the latest vertex. Free-form curves and
//! surfaces are counted.

use crate::format::ReadOptions;
use crate::format::assemble::{Assembler, Cell};
use crate::format::error::ReadError;
use crate::format::off;
use crate::format::scan::Scanner;
use crate::format::text::TextOut;
use crate::format::view::MeshView;
use crate::mesh::MeshData;
use std::io;

/// Statements that say nothing of points or cells.
const SKIPPED: [&[u8]; 33] = [
    b"vt",
    b"vn",
    b"vp",
    b"g",
    b"o",
    b"s",
    b"mg",
    b"usemtl",
    b"mtllib",
    b"usemap",
    b"maplib",
    b"shadow_obj",
    b"trace_obj",
    b"ctech",
    b"stech",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"deg",
    b"bmat",
    b"step",
    b"cstype",
    b"parm",
    b"trim",
    b"hole",
    b"scrv",
    b"sp",
    b"end",
    b"con",
    b"call",
    b"csh",
    b"bsp",
];

/// Reads an OBJ file.
///
/// # Errors
/// The first fault with its line.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let mut scanner = Scanner::new(bytes).with_comments(b'#');
    let mut mesh = Assembler::new(1, options.split_quads);
    let mut number = 0;
    while !scanner.is_at_end() {
        let line = scanner.line();
        let cell = Cell { number, marker: 0, line };
        match scanner.token("a statement such as `v` or `f`")? {
            b"v" => {
                let point = scanner.point(3)?;
                mesh.point(point, line);
                // A weight, or a colour, may follow.
                scanner.rest_of_line();
            }
            b"f" | b"fo" => {
                let (corners, count) = read_corners(&mut scanner, &mesh)?;
                if count < 3 {
                    return Err(scanner.malformed("a face with three or more corners", b"fewer"));
                }
                off::polygon(&mut mesh, &corners, count, cell);
                number += 1;
            }
            b"l" => match read_corners(&mut scanner, &mesh)? {
                ([a, b, ..], 2) => mesh.edge([a, b], cell),
                _ => mesh.other(-1, 1, || "polyline".to_owned()),
            },
            b"p" => {
                let (_, count) = read_corners(&mut scanner, &mesh)?;
                mesh.other(-2, count as u64, || "point".to_owned());
            }
            b"curv" | b"curv2" | b"surf" => {
                mesh.other(-3, 1, || "free-form curve or surface".to_owned());
                scanner.rest_of_line();
            }
            word if SKIPPED.contains(&word) => drop(scanner.rest_of_line()),
            word => return Err(scanner.malformed("a statement such as `v` or `f`", word)),
        }
    }
    if mesh.point_count() == 0 {
        return Err(scanner.malformed("a vertex", b""));
    }
    mesh.finish(&scanner)
}

/// The vertices of a face or line up to the end of the line: the first four, and how many.
fn read_corners(scanner: &mut Scanner, mesh: &Assembler) -> Result<([i64; 4], usize), ReadError> {
    let (mut corners, mut count) = ([0; 4], 0);
    while let Some(token) = scanner.token_on_line() {
        if token == b"\\" {
            let what = "a continued line".to_owned();
            return Err(scanner.unsupported(what, "put each statement on one line"));
        }
        let vertex = token.split(|&byte| byte == b'/').next().unwrap_or(token);
        let number = scanner.parse_integer(vertex, "the number of a vertex")?;
        if let Some(corner) = corners.get_mut(count) {
            let back = mesh.point_count() as i64 + 1 + number;
            *corner = if number < 0 && back > 0 { back } else { number };
        }
        count += 1;
    }
    Ok((corners, count))
}

/// Writes an OBJ file; marked edges and regions are dropped.
pub(crate) fn write(mesh: MeshView, out: &mut TextOut) -> io::Result<()> {
    for [x, y, z] in mesh.points() {
        out.bytes(b"v ")?;
        out.float(x, b' ')?;
        out.float(y, b' ')?;
        out.float(z, b'\n')?;
    }
    for face in mesh.faces() {
        out.bytes(b"f ")?;
        out.corners(face.corners(), 1, b'\n')?;
    }
    Ok(())
}
