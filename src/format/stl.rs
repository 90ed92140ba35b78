//! STL: triangles as triples of coordinates, ASCII or binary.
//!
//! Source: 3D Systems, "StereoLithography interface specification" (1989). Vertices are merged only
//! when all their bits are equal, so -0.0 and 0.0 stay two points (SPEC X31); normals are skipped.

use crate::format::assemble::{Assembler, Cell};
use crate::format::error::{ReadError, ReadFault, WriteError};
use crate::format::scan::{Endian, Scanner};
use crate::format::text::TextOut;
use crate::format::view::MeshView;
use crate::format::{MeshForm, ReadOptions};
use crate::mesh::MeshData;
use std::collections::HashMap; // lookups only
use std::io;

/// Bytes before the triangles of a binary file: a comment and the count.
const HEADER_BYTES: usize = 84;
/// Bytes of a triangle of a binary file: normal, three vertices, attribute.
const TRIANGLE_BYTES: usize = 50;

/// Numbers points by their bits.
#[derive(Default)]
struct Merger {
    /// Looked up, never iterated over: its order shows nowhere.
    known: HashMap<[u64; 3], i64>,
}

impl Merger {
    fn index(&mut self, point: [f64; 3], line: Option<u64>, mesh: &mut Assembler) -> i64 {
        *self.known.entry(point.map(f64::to_bits)).or_insert_with(|| {
            mesh.point(point, line);
            mesh.point_count() as i64 - 1
        })
    }
}

/// Reads an STL file.
///
/// # Errors
/// The first fault with its line, or its byte offset when the file is binary.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let scanner = Scanner::new(bytes);
    let mesh = Assembler::new(0, options.split_quads);
    // Binary files may start with `solid` too: what tells them is that their size fits their count.
    let is_ascii = bytes.trim_ascii_start().starts_with(b"solid");
    if declared_size(bytes) == Some(bytes.len() as u64) || !(is_ascii || bytes.is_empty()) {
        return read_binary(scanner, mesh);
    }
    read_text(scanner, mesh)
}

/// The size that the count of a binary file asks for.
fn declared_size(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER_BYTES - 4..HEADER_BYTES)?.first_chunk::<4>()?;
    let count = u64::from(u32::from_le_bytes(*count));
    Some(HEADER_BYTES as u64 + TRIANGLE_BYTES as u64 * count)
}

fn read_binary(mut scanner: Scanner, mut mesh: Assembler) -> Result<MeshData, ReadError> {
    scanner.set_binary();
    scanner.take(HEADER_BYTES - 4, "a header of 80 bytes")?;
    let count = scanner.u32(Endian::Little, "the number of triangles")?;
    let count = scanner.check_count("triangles", count, TRIANGLE_BYTES)?;
    let present = scanner.rest().len();
    if present != count * TRIANGLE_BYTES {
        let (declared, present) = (count as i64, (present / TRIANGLE_BYTES) as u64);
        return Err(scanner.fail(ReadFault::Mismatch { what: "triangles", declared, present }));
    }
    let mut merger = Merger::default();
    for number in 0..count as i64 {
        scanner.take(12, "a normal")?;
        let mut corners = [0; 3];
        for corner in &mut corners {
            let mut point = [0.0; 3];
            for coordinate in &mut point {
                *coordinate = scanner.f32(Endian::Little, "a coordinate")?;
            }
            *corner = merger.index(point, None, &mut mesh);
        }
        scanner.take(2, "an attribute")?;
        mesh.triangle(corners, Cell { number, marker: 0, line: None });
    }
    mesh.finish(&scanner)
}

/// `solid name`, facets, `endsolid name`; several solids may follow each other.
fn read_text(mut scanner: Scanner, mut mesh: Assembler) -> Result<MeshData, ReadError> {
    let mut merger = Merger::default();
    let mut number = 0;
    loop {
        scanner.expect("solid")?;
        scanner.rest_of_line();
        while scanner.peek() == b"facet" {
            let cell = Cell { number, marker: 0, line: scanner.line() };
            let corners = read_facet(&mut scanner, &mut merger, &mut mesh)?;
            mesh.triangle(corners, cell);
            number += 1;
        }
        match scanner.token("`facet` or `endsolid`")? {
            b"endsolid" => drop(scanner.rest_of_line()),
            other => return Err(scanner.malformed("`facet` or `endsolid`", other)),
        }
        if scanner.is_at_end() {
            return mesh.finish(&scanner);
        }
    }
}

/// `facet normal x y z outer loop vertex ... endloop endfacet`.
fn read_facet(
    scanner: &mut Scanner,
    merger: &mut Merger,
    mesh: &mut Assembler,
) -> Result<[i64; 3], ReadError> {
    scanner.expect("facet")?;
    // Some writers leave the normal out, or write `nan`: nothing depends on it.
    scanner.rest_of_line();
    scanner.expect("outer")?;
    scanner.expect("loop")?;
    let mut corners = [0; 3];
    for corner in &mut corners {
        scanner.expect("vertex")?;
        let line = scanner.line();
        let point = scanner.point(3)?;
        *corner = merger.index(point, line, mesh);
    }
    scanner.expect("endloop")?;
    scanner.expect("endfacet")?;
    Ok(corners)
}

/// Writes an STL file; points of no triangle, marked edges and regions are dropped, equal points
/// become one when read back. A binary file holds 32-bit floats: other coordinates are refused.
pub(crate) fn write(mesh: MeshView, is_binary: bool, out: &mut TextOut) -> Result<(), WriteError> {
    if is_binary {
        return write_binary(mesh, out);
    }
    out.text("solid triangulation\n")?;
    for triangle in mesh.triangles() {
        let corners = triangle.map(|corner| mesh.point(corner as usize));
        out.text("facet normal ")?;
        write_vector(normal(corners), out)?;
        out.text(" outer loop\n")?;
        for corner in corners {
            out.text("  vertex ")?;
            write_vector(corner, out)?;
        }
        out.text(" endloop\nendfacet\n")?;
    }
    out.text("endsolid triangulation\n")?;
    Ok(())
}

fn write_vector([x, y, z]: [f64; 3], out: &mut TextOut) -> io::Result<()> {
    out.float(x, b' ')?;
    out.float(y, b' ')?;
    out.float(z, b'\n')
}

fn write_binary(mesh: MeshView, out: &mut TextOut) -> Result<(), WriteError> {
    let is_single = |c: &f64| f64::from(*c as f32).to_bits() == c.to_bits();
    let form = MeshForm::Stl;
    if !mesh.points().flatten().all(|coordinate| is_single(&coordinate)) {
        let what = "coordinates that are no 32-bit floats in binary; ASCII keeps all bits";
        return Err(WriteError::Carry { form, what });
    }
    let Ok(count) = u32::try_from(mesh.triangles().len()) else {
        return Err(WriteError::Carry { form, what: "more than 4,294,967,295 triangles" });
    };
    let mut header = [b' '; HEADER_BYTES - 4];
    header[..13].copy_from_slice(b"triangulation");
    out.bytes(&header)?;
    out.bytes(&count.to_le_bytes())?;
    for triangle in mesh.triangles() {
        let corners = triangle.map(|corner| mesh.point(corner as usize));
        for coordinate in [normal(corners)].iter().chain(&corners).flatten() {
            out.bytes(&(*coordinate as f32).to_le_bytes())?;
        }
        out.bytes(&[0, 0])?;
    }
    Ok(())
}

/// The unit normal, or zeros where it is lost to rounding: readers then compute their own.
fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let difference = |p: [f64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
    let (u, v) = (difference(b), difference(c));
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = (cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]).sqrt();
    let normal = cross.map(|component| component / length);
    if normal.iter().all(|component| component.is_finite()) { normal } else { [0.0; 3] }
}
