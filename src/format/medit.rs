//! Medit's `.mesh` files (INRIA): keywords, each with a count and a list. The binary `.meshb` is
//! read too.
//!
//! Source: "Medit: an interactive mesh visualization software" (Frey, INRIA RT-0253), and libMeshb
//! for the keywords since and for the binary form. References of edges are markers, references of
//! triangles are regions.

use crate::format::ReadOptions;
use crate::format::assemble::{Assembler, Cell};
use crate::format::error::ReadError;
use crate::format::scan::{Endian, Scanner};
use crate::format::text::TextOut;
use crate::format::view::MeshView;
use crate::mesh::MeshData;
use std::io;

/// Keywords with a counted list: libMeshb's code, name, numbers of an item (0: one coordinate each
/// dimension). The last number of a cell is its reference.
const LISTS: [(i64, &str, usize); 33] = [
    (5, "Edges", 3),
    (6, "Triangles", 4),
    (7, "Quadrilaterals", 5),
    (8, "Tetrahedra", 5),
    (9, "Prisms", 7),
    (10, "Hexahedra", 9),
    (49, "Pyramids", 6),
    (25, "EdgesP2", 4),
    (24, "TrianglesP2", 7),
    (27, "QuadrilateralsQ2", 10),
    (30, "TetrahedraP2", 11),
    (86, "PrismsP2", 19),
    (33, "HexahedraQ2", 28),
    (87, "PyramidsP2", 15),
    (13, "Corners", 1),
    (14, "Ridges", 1),
    (15, "RequiredVertices", 1),
    (16, "RequiredEdges", 1),
    (17, "RequiredTriangles", 1),
    (18, "RequiredQuadrilaterals", 1),
    (19, "TangentAtEdgeVertices", 3),
    (20, "NormalAtVertices", 2),
    (21, "NormalAtTriangleVertices", 3),
    (22, "NormalAtQuadrilateralVertices", 3),
    (0, "TangentAtVertices", 2),
    (60, "Normals", 0),
    (59, "Tangents", 0),
    (0, "SubDomainFromMesh", 4),
    (0, "SubDomainFromGeom", 4),
    (0, "VertexOnGeometricVertex", 2),
    (0, "VertexOnGeometricEdge", 3),
    (0, "EdgeOnGeometricEdge", 2),
    (0, "BoundingBox", 4),
];

/// Keywords with one value and no list.
const VALUES: [&str; 4] = ["AngleOfCornerBound", "Geometry", "Identifier", "Time"];

const VERTICES: i64 = 4;
const EDGES: i64 = 5;
const TRIANGLES: i64 = 6;
const QUADRILATERALS: i64 = 7;

/// Reads a Medit file, ASCII or binary.
///
/// # Errors
/// The first fault with its line, or its byte offset when the file is binary.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let mut scanner = Scanner::new(bytes).with_comments(b'#');
    let mesh = Assembler::new(1, options.split_quads);
    if matches!(bytes, [1, 0, 0, 0, ..] | [0, 0, 0, 1, ..]) {
        scanner.set_binary();
        return read_binary(scanner, mesh);
    }
    read_text(scanner, mesh)
}

fn read_text(mut scanner: Scanner, mut mesh: Assembler) -> Result<MeshData, ReadError> {
    if scanner.peek() == b"MFEM" {
        let what = "an MFEM mesh".to_owned();
        return Err(scanner.unsupported(what, "save it in another form, such as VTU or Gmsh"));
    }
    scanner.expect("MeshVersionFormatted")?;
    scanner.integer("the version")?;
    let mut dimension = None;
    let mut has_vertices = false;
    loop {
        let keyword = scanner.token("a keyword such as `Triangles` or `End`")?;
        match keyword {
            b"End" => break,
            b"Dimension" => match scanner.integer("the dimension, 2 or 3")? {
                value @ (2 | 3) => dimension = Some(value as usize),
                other => {
                    let found = other.to_string();
                    return Err(scanner.malformed("the dimension, 2 or 3", found.as_bytes()));
                }
            },
            b"Vertices" => {
                has_vertices = true;
                let dimension = dimension
                    .ok_or_else(|| scanner.malformed("`Dimension` before vertices", keyword))?;
                read_vertices(&mut scanner, dimension, &mut mesh)?;
            }
            keyword => read_list(&mut scanner, keyword, dimension.unwrap_or(3), &mut mesh)?,
        }
    }
    if !has_vertices {
        return Err(scanner.malformed("`Vertices`", b"End"));
    }
    mesh.finish(&scanner)
}

/// `count`, then `x y [z] reference`.
fn read_vertices(
    scanner: &mut Scanner,
    dimension: usize,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    let count = scanner.count("vertices", 6)?;
    mesh.reserve_points(count);
    for _ in 0..count {
        scanner.skip_blank();
        let line = scanner.line();
        let point = scanner.point(dimension)?;
        scanner.integer("the reference of a vertex")?;
        mesh.point(point, line);
    }
    Ok(())
}

/// A list of cells, or one that says nothing of the mesh and is skipped.
fn read_list(
    scanner: &mut Scanner,
    keyword: &[u8],
    dimension: usize,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    if VALUES.iter().any(|value| value.as_bytes() == keyword) {
        return scanner.token("a value").map(drop);
    }
    let known = LISTS.iter().find(|entry| entry.1.as_bytes() == keyword);
    let Some(&(code, name, numbers)) = known else {
        return Err(scanner.malformed("a keyword such as `Triangles` or `End`", keyword));
    };
    let numbers = if numbers == 0 { dimension } else { numbers };
    let count = scanner.count("items of a list", 2 * numbers)?;
    for number in 0..count as i64 {
        scanner.skip_blank();
        let cell = Cell { number, marker: 0, line: scanner.line() };
        if matches!(code, EDGES | TRIANGLES | QUADRILATERALS) {
            read_cell(scanner, code, cell, mesh, |scanner| scanner.integer("a number"))?;
        } else {
            for _ in 0..numbers {
                scanner.token("a number of a list")?;
            }
            count_other(mesh, code, name, 1);
        }
    }
    Ok(())
}

/// Cells are counted; corners, ridges, normals and the like are not cells.
fn count_other(mesh: &mut Assembler, code: i64, name: &str, count: usize) {
    if name.starts_with(['E', 'T', 'Q', 'P', 'H']) && !name.starts_with("Tangent") && code != 0 {
        mesh.other(code, count as u64, || format!("{name} (Medit)"));
    }
}

fn read_cell(
    scanner: &mut Scanner,
    code: i64,
    cell: Cell,
    mesh: &mut Assembler,
    mut next: impl FnMut(&mut Scanner) -> Result<i64, ReadError>,
) -> Result<(), ReadError> {
    let mut corners = [0; 4];
    let count = (code - EDGES) as usize + 2;
    for corner in &mut corners[..count] {
        *corner = next(scanner)?;
    }
    let [a, b, c, _] = corners;
    let cell = Cell { marker: next(scanner)?, ..cell };
    match code {
        EDGES => mesh.edge([a, b], cell),
        TRIANGLES => mesh.triangle([a, b, c], cell),
        _ => mesh.quad(corners, cell, code, "Quadrilaterals (Medit)"),
    }
    Ok(())
}

/// How numbers of a binary file are stored.
#[derive(Clone, Copy)]
struct Binary {
    endian: Endian,
    version: i64,
}

impl Binary {
    fn integer(self, scanner: &mut Scanner, expected: &str) -> Result<i64, ReadError> {
        match self.version {
            4.. => scanner.i64(self.endian, expected),
            _ => scanner.i32(self.endian, expected),
        }
    }

    /// The offset of the next keyword.
    fn position(self, scanner: &mut Scanner) -> Result<i64, ReadError> {
        match self.version {
            3.. => scanner.i64(self.endian, "the place of the next keyword"),
            _ => scanner.i32(self.endian, "the place of the next keyword"),
        }
    }

    fn float(self, scanner: &mut Scanner) -> Result<f64, ReadError> {
        match self.version {
            2.. => scanner.f64(self.endian, "a coordinate"),
            _ => scanner.f32(self.endian, "a coordinate"),
        }
    }

    const fn integer_bytes(self) -> usize {
        if self.version >= 4 { 8 } else { 4 }
    }
}

/// `1 version`, then keyword code, place of the next keyword, count, list.
fn read_binary(mut scanner: Scanner, mut mesh: Assembler) -> Result<MeshData, ReadError> {
    let endian = if scanner.rest()[0] == 1 { Endian::Little } else { Endian::Big };
    scanner.take(4, "the number 1")?;
    let version = scanner.i32(endian, "the version")?;
    if !(1..=4).contains(&version) {
        let what = format!("Medit version {version}");
        return Err(scanner.unsupported(what, "save it as version 1 to 4"));
    }
    let binary = Binary { endian, version };
    let mut dimension = 0;
    loop {
        let code = scanner.i32(endian, "the code of a keyword")?;
        if code == 54 {
            break;
        }
        let next = binary.position(&mut scanner)?;
        match code {
            // GmfDimension: an int in every version.
            3 => dimension = scanner.i32(endian, "the dimension")?,
            VERTICES if dimension == 2 || dimension == 3 => {
                read_binary_vertices(&mut scanner, binary, dimension as usize, &mut mesh)?;
            }
            VERTICES => return Err(scanner.malformed("dimension 2 or 3 before vertices", b"other")),
            _ => read_binary_list(&mut scanner, binary, code, &mut mesh)?,
        }
        scanner.seek_forward(next, "the next keyword")?;
    }
    if dimension == 0 {
        return Err(scanner.malformed("the dimension before the end", b"End"));
    }
    mesh.finish(&scanner)
}

fn read_binary_vertices(
    scanner: &mut Scanner,
    binary: Binary,
    dimension: usize,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    let count = binary.integer(scanner, "the number of vertices")?;
    let float_bytes = if binary.version >= 2 { 8 } else { 4 };
    let bytes_each = dimension * float_bytes + binary.integer_bytes();
    let count = scanner.check_count("vertices", count, bytes_each)?;
    mesh.reserve_points(count);
    for _ in 0..count {
        let mut point = [0.0; 3];
        for coordinate in &mut point[..dimension] {
            *coordinate = binary.float(scanner)?;
        }
        binary.integer(scanner, "the reference of a vertex")?;
        mesh.point(point, None);
    }
    Ok(())
}

/// Edges, triangles and quadrilaterals are read, other cells counted; the rest is skipped by the
/// place of the next keyword.
fn read_binary_list(
    scanner: &mut Scanner,
    binary: Binary,
    code: i64,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    let Some(&(_, name, numbers)) = LISTS.iter().find(|entry| entry.0 == code && code != 0) else {
        return Ok(());
    };
    let count = binary.integer(scanner, "the number of items of a list")?;
    let count = scanner.check_count("items of a list", count, numbers * binary.integer_bytes())?;
    if !matches!(code, EDGES | TRIANGLES | QUADRILATERALS) {
        // Not a loop: the list is not consumed here, so a file could have it gone through often.
        count_other(mesh, code, name, count);
        return Ok(());
    }
    for number in 0..count as i64 {
        let cell = Cell { number, marker: 0, line: None };
        read_cell(scanner, code, cell, mesh, |scanner| {
            binary.integer(scanner, "a number of a cell")
        })?;
    }
    Ok(())
}

/// Writes an ASCII Medit file; two coordinates if every z is +0.0.
pub(crate) fn write(mesh: MeshView, out: &mut TextOut) -> io::Result<()> {
    let dimension = if mesh.is_plane() { 2 } else { 3 };
    out.text(&format!("MeshVersionFormatted 2\n\nDimension {dimension}\n\n"))?;
    out.text(&format!("Vertices\n{}\n", mesh.point_count()))?;
    for point in mesh.points() {
        for &coordinate in &point[..dimension] {
            out.float(coordinate, b' ')?;
        }
        out.bytes(b"0\n")?;
    }
    out.text(&format!("\nEdges\n{}\n", mesh.edges().len()))?;
    for edge in mesh.edges() {
        out.integer(i64::from(edge.vertices[0]) + 1, b' ')?;
        out.integer(i64::from(edge.vertices[1]) + 1, b' ')?;
        out.integer(i64::from(edge.marker), b'\n')?;
    }
    out.text(&format!("\nTriangles\n{}\n", mesh.triangles().len()))?;
    for (index, triangle) in mesh.triangles().iter().enumerate() {
        for &corner in triangle {
            out.integer(i64::from(corner) + 1, b' ')?;
        }
        out.integer(i64::from(mesh.region(index, 0)), b'\n')?;
    }
    out.text("\nEnd\n")
}
