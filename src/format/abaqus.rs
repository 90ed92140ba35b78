//! Abaqus input files (`.inp`): nodes and elements; other keywords are skipped.
//!
//! Source: the Abaqus keywords reference, `*NODE` and `*ELEMENT`. Three-node plane, shell, membrane
//! and surface elements are triangles, two-node trusses, beams and rigid links are edges, four-node
//! ones quadrilaterals; elements of other types are counted.

use crate::format::ReadOptions;
use crate::format::assemble::{Assembler, Cell};
use crate::format::error::ReadError;
use crate::format::scan::Scanner;
use crate::mesh::MeshData;

/// Types of triangles, quadrilaterals and edges without the letters that name their formulation.
const SHAPES: [(&str, Shape); 27] = [
    ("S3", Shape::Triangle),
    ("STRI3", Shape::Triangle),
    ("CPS3", Shape::Triangle),
    ("CPE3", Shape::Triangle),
    ("CPEG3", Shape::Triangle),
    ("CAX3", Shape::Triangle),
    ("CGAX3", Shape::Triangle),
    ("M3D3", Shape::Triangle),
    ("SFM3D3", Shape::Triangle),
    ("R3D3", Shape::Triangle),
    ("DC2D3", Shape::Triangle),
    ("AC2D3", Shape::Triangle),
    ("S4", Shape::Quad),
    ("CPS4", Shape::Quad),
    ("CPE4", Shape::Quad),
    ("CPEG4", Shape::Quad),
    ("CAX4", Shape::Quad),
    ("M3D4", Shape::Quad),
    ("SFM3D4", Shape::Quad),
    ("R3D4", Shape::Quad),
    ("DC2D4", Shape::Quad),
    ("AC2D4", Shape::Quad),
    ("T2D2", Shape::Edge),
    ("T3D2", Shape::Edge),
    ("B21", Shape::Edge),
    ("B31", Shape::Edge),
    ("R2D2", Shape::Edge),
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    Edge,
    Triangle,
    Quad,
}

impl Shape {
    /// The shape of elements of a type, in upper case.
    fn of(name: &str) -> Option<Self> {
        // Reduced integration, hybrid, thermal, small strain and the like are letters at the end.
        let base = name.trim_end_matches(|c: char| c.is_ascii_alphabetic());
        SHAPES.iter().find(|(known, _)| *known == base).map(|&(_, shape)| shape)
    }
}

/// What the data lines at hand are.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Block {
    Nodes,
    Elements(String),
    Skipped,
}

/// Reads an Abaqus input file.
///
/// # Errors
/// The first fault with its line.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let mut mesh = Assembler::new(1, options.split_quads);
    let mut nodes = Scanner::new(bytes);
    // Elements may stand before the nodes they name.
    read_blocks(&mut nodes, |scanner, block, text, line| match block {
        Block::Nodes => read_node(scanner, text, line, &mut mesh),
        _ => Ok(()),
    })?;
    if mesh.point_count() == 0 {
        return Err(nodes.malformed("a node after `*NODE`", b""));
    }
    mesh.number_points(&nodes)?;
    let mut element = Element::default();
    read_blocks(&mut Scanner::new(bytes), |scanner, block, text, line| match block {
        Block::Elements(kind) => element.read_line(scanner, (kind, text), line, &mut mesh),
        _ if element.is_open => {
            Err(scanner.malformed("the rest of an element after a comma", text))
        }
        _ => Ok(()),
    })?;
    if element.is_open {
        return Err(nodes.malformed("the rest of an element after a comma", b""));
    }
    mesh.finish(&nodes)
}

/// Hands over every data line with the keyword that it belongs to.
fn read_blocks<'a>(
    scanner: &mut Scanner<'a>,
    mut data: impl FnMut(&mut Scanner<'a>, &Block, &'a [u8], Option<u64>) -> Result<(), ReadError>,
) -> Result<(), ReadError> {
    let mut block = Block::Skipped;
    let mut is_first = true;
    while !scanner.is_at_end() {
        let line = scanner.line();
        let mut ahead = scanner.clone();
        let text = ahead.rest_of_line();
        if text.starts_with(b"**") {
        } else if text.starts_with(b"*") {
            block = keyword(scanner, text)?;
        } else if is_first {
            return Err(scanner.malformed("a keyword such as `*NODE`", text));
        } else {
            data(scanner, &block, text, line)?;
        }
        is_first &= text.starts_with(b"**");
        scanner.rest_of_line();
    }
    Ok(())
}

/// The block that a keyword line such as `*ELEMENT, TYPE=S3` starts.
fn keyword(scanner: &Scanner, text: &[u8]) -> Result<Block, ReadError> {
    let text = String::from_utf8_lossy(text).to_ascii_uppercase();
    let mut parts = text.split(',').map(str::trim);
    let name: String = parts.next().unwrap_or_default().split_whitespace().collect();
    let value = |key: &str, part: &str| {
        let (name, value) = part.split_once('=')?;
        (name.trim() == key).then(|| value.trim().to_owned())
    };
    match name.as_str() {
        "*NODE" => Ok(Block::Nodes),
        "*ELEMENT" => match parts.find_map(|part| value("TYPE", part)) {
            Some(kind) => Ok(Block::Elements(kind)),
            None => Err(scanner.malformed("`*ELEMENT` with TYPE=", text.as_bytes())),
        },
        "*INCLUDE" | "*NGEN" | "*NFILL" | "*NCOPY" | "*ELGEN" | "*ELCOPY" => {
            let what = format!("the keyword {name}");
            Err(scanner.unsupported(what, "list all nodes and elements in the file itself"))
        }
        _ => Ok(Block::Skipped),
    }
}

/// `number, x, y, z`; a coordinate left out is 0.
fn read_node(
    scanner: &mut Scanner,
    text: &[u8],
    line: Option<u64>,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    let mut parts = text.split(|&byte| byte == b',').map(<[u8]>::trim_ascii);
    let number = parts.next().unwrap_or_default();
    mesh.point_number(scanner.parse_integer(number, "the number of a node")?);
    let mut point = [0.0; 3];
    for (coordinate, part) in point.iter_mut().zip(parts) {
        if !part.is_empty() {
            *coordinate = scanner.parse_float(part, "a coordinate of a node")?;
        }
    }
    mesh.point(point, line);
    Ok(())
}

/// The element at hand, which may go on over several lines.
#[derive(Default)]
struct Element {
    is_open: bool,
    number: i64,
    line: Option<u64>,
    corners: [i64; 4],
    count: usize,
}

impl Element {
    /// `number, n1, n2, ...`; a line that ends in a comma goes on in the next.
    fn read_line(
        &mut self,
        scanner: &mut Scanner,
        (kind, text): (&str, &[u8]),
        line: Option<u64>,
        mesh: &mut Assembler,
    ) -> Result<(), ReadError> {
        let goes_on = text.ends_with(b",");
        let text = text.strip_suffix(b",").unwrap_or(text);
        for part in text.split(|&byte| byte == b',').map(<[u8]>::trim_ascii) {
            let value = scanner.parse_integer(part, "a number of an element")?;
            if !self.is_open {
                *self = Self { is_open: true, number: value, line, ..Self::default() };
                continue;
            }
            if let Some(corner) = self.corners.get_mut(self.count) {
                *corner = value;
            }
            self.count += 1;
        }
        if goes_on { Ok(()) } else { self.finish(scanner, kind, mesh) }
    }

    fn finish(
        &mut self,
        scanner: &Scanner,
        kind: &str,
        mesh: &mut Assembler,
    ) -> Result<(), ReadError> {
        self.is_open = false;
        let cell = Cell { number: self.number, marker: 0, line: self.line };
        let [a, b, c, _] = self.corners;
        match (Shape::of(kind), self.count) {
            (Some(Shape::Edge), 2 | 3) => mesh.edge([a, b], cell),
            (Some(Shape::Triangle), 3) => mesh.triangle([a, b, c], cell),
            (Some(Shape::Quad), 4) if mesh.splits_quads() => {
                mesh.quad(self.corners, cell, 0, kind);
            }
            (Some(Shape::Quad), 4) => {
                mesh.other_named(format!("quadrilateral {}", kind.escape_debug()));
            }
            (Some(_), count) => {
                let found = format!("{count} nodes");
                return Err(scanner.malformed("as many nodes as the type has", found.as_bytes()));
            }
            (None, count) => {
                mesh.other_named(format!("element {} with {count} nodes", kind.escape_debug()))
            }
        }
        Ok(())
    }
}
