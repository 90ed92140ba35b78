//! Gmsh's MSH files: the header, and the sections that versions 2.2 and 4.1 share.
//!
//! Source: the Gmsh reference manual, "Gmsh file formats". Physical groups are the markers of
//! edges and the regions of triangles; an entity in several groups gets the first.

use crate::format::assemble::{Assembler, Cell};
use crate::format::error::ReadError;
use crate::format::scan::{Endian, Scanner};
use crate::format::text::TextOut;
use crate::format::view::MeshView;
use crate::format::{ReadOptions, msh22, msh41};
use crate::mesh::MeshData;
use std::collections::BTreeSet;
use std::io;

/// Gmsh's element types: code, number of nodes, name.
const ELEMENT_TYPES: [(i64, usize, &str); 38] = [
    (1, 2, "line"),
    (2, 3, "triangle"),
    (3, 4, "quadrilateral"),
    (4, 4, "tetrahedron"),
    (5, 8, "hexahedron"),
    (6, 6, "prism"),
    (7, 5, "pyramid"),
    (8, 3, "second-order line"),
    (9, 6, "second-order triangle"),
    (10, 9, "second-order quadrilateral"),
    (11, 10, "second-order tetrahedron"),
    (12, 27, "second-order hexahedron"),
    (13, 18, "second-order prism"),
    (14, 14, "second-order pyramid"),
    (15, 1, "point"),
    (16, 8, "8-node quadrilateral"),
    (17, 20, "20-node hexahedron"),
    (18, 15, "15-node prism"),
    (19, 13, "13-node pyramid"),
    (20, 9, "9-node triangle"),
    (21, 10, "third-order triangle"),
    (22, 12, "12-node triangle"),
    (23, 15, "fourth-order triangle"),
    (24, 15, "incomplete fifth-order triangle"),
    (25, 21, "fifth-order triangle"),
    (26, 4, "third-order line"),
    (27, 5, "fourth-order line"),
    (28, 6, "fifth-order line"),
    (29, 20, "third-order tetrahedron"),
    (30, 35, "fourth-order tetrahedron"),
    (31, 56, "fifth-order tetrahedron"),
    (36, 16, "third-order quadrilateral"),
    (37, 25, "fourth-order quadrilateral"),
    (38, 36, "fifth-order quadrilateral"),
    (90, 40, "third-order prism"),
    (91, 75, "fourth-order prism"),
    (92, 64, "third-order hexahedron"),
    (93, 125, "fourth-order hexahedron"),
];

/// Gmsh's code of a 2-node line.
pub(crate) const LINE: i64 = 1;
/// Gmsh's code of a 3-node triangle.
pub(crate) const TRIANGLE: i64 = 2;
/// Gmsh's code of a 4-node quadrilateral.
pub(crate) const QUADRILATERAL: i64 = 3;

/// How numbers stand in the file: as text, or binary with an order of bytes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Codec {
    /// `None`: text.
    pub(crate) endian: Option<Endian>,
    /// Whether a `size_t` of version 4.1 takes four bytes instead of eight.
    pub(crate) short_size: bool,
}

impl Codec {
    /// A C `int`.
    #[inline]
    pub(crate) fn int(self, scanner: &mut Scanner, expected: &str) -> Result<i64, ReadError> {
        match self.endian {
            None => scanner.integer(expected),
            Some(endian) => scanner.i32(endian, expected),
        }
    }

    /// A C `size_t`.
    #[inline]
    pub(crate) fn size(self, scanner: &mut Scanner, expected: &str) -> Result<i64, ReadError> {
        match self.endian {
            None => scanner.integer(expected),
            Some(endian) if self.short_size => scanner.i32(endian, expected),
            Some(endian) => scanner.i64(endian, expected),
        }
    }

    /// A C `double`.
    #[inline]
    pub(crate) fn float(self, scanner: &mut Scanner, expected: &str) -> Result<f64, ReadError> {
        match self.endian {
            None => scanner.float(expected),
            Some(endian) => scanner.f64(endian, expected),
        }
    }

    /// Three doubles.
    #[inline]
    pub(crate) fn point(self, scanner: &mut Scanner) -> Result<[f64; 3], ReadError> {
        Ok([
            self.float(scanner, "the x coordinate of a node")?,
            self.float(scanner, "the y coordinate of a node")?,
            self.float(scanner, "the z coordinate of a node")?,
        ])
    }

    /// The line on which the next item of a text file stands.
    #[inline]
    pub(crate) fn line(self, scanner: &mut Scanner) -> Option<u64> {
        if self.endian.is_none() {
            scanner.skip_blank();
        }
        scanner.line()
    }

    /// The fewest bytes that `ints` ints, `sizes` sizes and `floats` doubles take.
    pub(crate) const fn bytes(self, ints: usize, sizes: usize, floats: usize) -> usize {
        match self.endian {
            None => 2 * (ints + sizes + floats),
            Some(_) if self.short_size => 4 * ints + 4 * sizes + 8 * floats,
            Some(_) => 4 * ints + 8 * sizes + 8 * floats,
        }
    }
}

/// Number of nodes and name of an element type.
pub(crate) fn element_type(
    scanner: &Scanner,
    code: i64,
) -> Result<(usize, &'static str), ReadError> {
    match ELEMENT_TYPES.iter().find(|entry| entry.0 == code) {
        Some(&(_, nodes, name)) => Ok((nodes, name)),
        None => Err(scanner.unsupported(
            format!("Gmsh element type {code}"),
            "save the mesh with linear elements",
        )),
    }
}

/// Hands an element over; `read_node` gives its node numbers one by one.
#[inline]
pub(crate) fn element(
    mesh: &mut Assembler,
    (code, nodes, name): (i64, usize, &str),
    cell: Cell,
    mut read_node: impl FnMut() -> Result<i64, ReadError>,
) -> Result<(), ReadError> {
    match code {
        TRIANGLE => mesh.triangle([read_node()?, read_node()?, read_node()?], cell),
        LINE => mesh.edge([read_node()?, read_node()?], cell),
        QUADRILATERAL if mesh.splits_quads() => {
            let corners = [read_node()?, read_node()?, read_node()?, read_node()?];
            mesh.quad(corners, cell, code, name);
        }
        _ => {
            for _ in 0..nodes {
                read_node()?;
            }
            mesh.other(code, 1, || format!("{name} (Gmsh type {code})"));
        }
    }
    Ok(())
}

/// Which versions a file may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Version {
    V2,
    V41,
}

/// Reads an MSH file of version 2 or 4.1, ASCII or binary of either byte order.
///
/// # Errors
/// The first fault with its line, or its byte offset when the file is binary.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let mut scanner = Scanner::new(bytes);
    let (version, codec) = read_header(&mut scanner)?;
    let mut mesh = Assembler::new(1, options.split_quads);
    let (mut has_nodes, mut has_elements) = (false, false);
    let mut entities = msh41::Entities::default();
    while !scanner.is_at_end() {
        let name = scanner.token("a section such as `$Nodes`")?;
        if name.len() < 2 || name[0] != b'$' || name.starts_with(b"$End") {
            return Err(scanner.malformed("a section such as `$Nodes`", name));
        }
        match name {
            b"$Nodes" | b"$Elements" | b"$Entities" => scanner.rest_of_line(),
            _ => &[],
        };
        match (name, version) {
            (b"$Nodes", _) if has_nodes => return Err(scanner.malformed("one `$Nodes`", name)),
            (b"$Nodes", Version::V2) => msh22::read_nodes(&mut scanner, codec, &mut mesh)?,
            (b"$Nodes", Version::V41) => msh41::read_nodes(&mut scanner, codec, &mut mesh)?,
            (b"$Elements", Version::V2) => msh22::read_elements(&mut scanner, codec, &mut mesh)?,
            (b"$Elements", Version::V41) => {
                msh41::read_elements(&mut scanner, codec, &entities, &mut mesh)?;
            }
            (b"$Entities", Version::V41) => entities = msh41::read_entities(&mut scanner, codec)?,
            (b"$ParametricNodes", _) => {
                let what = "a section `$ParametricNodes`".to_owned();
                return Err(scanner.unsupported(what, "save it without parametric coordinates"));
            }
            _ => {
                skip_section(&mut scanner, name)?;
                continue;
            }
        }
        has_nodes |= name == b"$Nodes";
        has_elements |= name == b"$Elements";
        scanner.expect(&format!("$End{}", name[1..].escape_ascii()))?;
    }
    if !has_nodes || !has_elements {
        let missing = if has_nodes { "`$Elements`" } else { "`$Nodes`" };
        return Err(scanner.malformed(missing, b""));
    }
    mesh.finish(&scanner)
}

/// How numbers stand in an MSH file.
pub(crate) fn codec(bytes: &[u8]) -> Result<Codec, ReadError> {
    read_header(&mut Scanner::new(bytes)).map(|(_, codec)| codec)
}

/// Skips a section that holds no mesh, whatever bytes it has.
fn skip_section(scanner: &mut Scanner, name: &[u8]) -> Result<(), ReadError> {
    let end = [b"$End", &name[1..]].concat();
    scanner.skip_past(&end, &format!("`{}`", end.escape_ascii()))
}

fn read_header(scanner: &mut Scanner) -> Result<(Version, Codec), ReadError> {
    while scanner.peek() == b"$Comments" {
        skip_section(scanner, b"$Comments")?;
    }
    scanner.expect("$MeshFormat")?;
    let number = scanner.token("the version of the MSH file")?;
    let version = match number {
        b"2" | b"2.0" | b"2.1" | b"2.2" => Version::V2,
        b"4.1" => Version::V41,
        _ => {
            let what = format!("MSH version {}", number.escape_ascii());
            return Err(scanner.unsupported(what, "save it as version 4.1 or 2.2"));
        }
    };
    let is_binary = match scanner.token("the file type, 0 or 1")? {
        b"0" => false,
        b"1" => true,
        other => return Err(scanner.malformed("the file type, 0 or 1", other)),
    };
    let short_size = match scanner.token("the data size, 4 or 8")? {
        b"8" => false,
        b"4" if version == Version::V41 || !is_binary => true,
        other => return Err(scanner.malformed("the data size 8", other)),
    };
    let endian = if is_binary { Some(read_endian(scanner)?) } else { None };
    scanner.expect("$EndMeshFormat")?;
    Ok((version, Codec { endian, short_size }))
}

/// The integer 1 in the file's order of bytes.
fn read_endian(scanner: &mut Scanner) -> Result<Endian, ReadError> {
    scanner.rest_of_line();
    scanner.set_binary();
    match scanner.take(4, "the binary integer 1")? {
        [1, 0, 0, 0] => Ok(Endian::Little),
        [0, 0, 0, 1] => Ok(Endian::Big),
        other => Err(scanner.malformed("the binary integer 1", other)),
    }
}

/// Ranks of the distinct markers of a mesh: entity tags are rank + 1, so that any i32, 0 and
/// negative ones too, can be the marker of an entity.
#[derive(Debug)]
pub(crate) struct Groups {
    /// Distinct markers of edges, rising.
    pub(crate) markers: Vec<i32>,
    /// Distinct regions of triangles, rising; never empty.
    pub(crate) regions: Vec<i32>,
}

/// The region of a mesh that names none: Gmsh shows and saves physical groups only, and 0 is none.
pub(crate) const DEFAULT_REGION: i32 = 1;

impl Groups {
    pub(crate) fn of(mesh: MeshView) -> Self {
        let markers: BTreeSet<i32> = mesh.edges().iter().map(|edge| edge.marker).collect();
        let mut regions: BTreeSet<i32> = BTreeSet::new();
        if mesh.has_regions() {
            regions.extend((0..mesh.triangles().len()).map(|index| mesh.region(index, 0)));
        }
        if regions.is_empty() {
            regions.insert(DEFAULT_REGION);
        }
        Self { markers: markers.into_iter().collect(), regions: regions.into_iter().collect() }
    }

    /// The entity tag of edges with `marker`.
    pub(crate) fn curve(&self, marker: i32) -> i64 {
        self.markers.partition_point(|&other| other < marker) as i64 + 1
    }

    /// The entity tag of triangles in `region`.
    pub(crate) fn surface(&self, region: i32) -> i64 {
        self.regions.partition_point(|&other| other < region) as i64 + 1
    }
}

/// Writes `$MeshFormat` and `$PhysicalNames`.
pub(crate) fn write_header(
    out: &mut TextOut,
    version: &str,
    is_binary: bool,
    groups: &Groups,
) -> io::Result<()> {
    out.text(&format!("$MeshFormat\n{version} {} 8\n", u8::from(is_binary)))?;
    if is_binary {
        out.bytes(&1_i32.to_le_bytes())?;
        out.text("\n")?;
    }
    out.text("$EndMeshFormat\n")?;
    // Gmsh takes a physical group numbered 0 for none, and the sign for an orientation.
    let markers: Vec<i32> = groups.markers.iter().copied().filter(|&m| m > 0).collect();
    let regions: Vec<i32> = groups.regions.iter().copied().filter(|&r| r > 0).collect();
    if markers.is_empty() && regions.is_empty() {
        return Ok(());
    }
    out.text(&format!("$PhysicalNames\n{}\n", markers.len() + regions.len()))?;
    for marker in markers {
        out.text(&format!("1 {marker} \"marker {marker}\"\n"))?;
    }
    for region in regions {
        out.text(&format!("2 {region} \"region {region}\"\n"))?;
    }
    out.text("$EndPhysicalNames\n")
}
