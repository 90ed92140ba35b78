//! Entities, nodes and elements of Gmsh's MSH 4.1 files: blocks that belong to entities.

use crate::format::assemble::{Assembler, Cell};
use crate::format::error::{ReadError, ReadFault, WriteError};
use crate::format::msh::{self, Codec, DEFAULT_REGION, Groups, LINE, QUADRILATERAL, TRIANGLE};
use crate::format::msh_view;
use crate::format::scan::Scanner;
use crate::format::text::TextOut;
use crate::format::view::MeshView;
use std::collections::BTreeMap;
use std::io;

/// The physical group of each entity that has one, by dimension and tag.
pub(crate) type Entities = BTreeMap<(i64, i64), i64>;

/// Reads what follows `$Entities`.
pub(crate) fn read_entities(scanner: &mut Scanner, codec: Codec) -> Result<Entities, ReadError> {
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = codec.size(scanner, "a number of entities")?;
    }
    let mut entities = Entities::new();
    for (dimension, count) in (0..).zip(counts) {
        // A point has three coordinates, any other entity a bounding box of six.
        let floats = if dimension == 0 { 3 } else { 6 };
        let count = scanner.check_count("entities", count, codec.bytes(1, 1, floats))?;
        for _ in 0..count {
            read_entity(scanner, codec, dimension, &mut entities)?;
        }
    }
    Ok(entities)
}

fn read_entity(
    scanner: &mut Scanner,
    codec: Codec,
    dimension: i64,
    entities: &mut Entities,
) -> Result<(), ReadError> {
    let tag = codec.int(scanner, "the tag of an entity")?;
    for _ in 0..if dimension == 0 { 3 } else { 6 } {
        codec.float(scanner, "the bounding box of an entity")?;
    }
    let count = codec.size(scanner, "the number of physical groups of an entity")?;
    for _ in 0..scanner.check_count("physical groups", count, codec.bytes(1, 0, 0))? {
        let group = codec.int(scanner, "a physical group of an entity")?;
        entities.entry((dimension, tag)).or_insert(group);
    }
    if dimension > 0 {
        let count = codec.size(scanner, "the number of bounding entities")?;
        for _ in 0..scanner.check_count("bounding entities", count, codec.bytes(1, 0, 0))? {
            codec.int(scanner, "a bounding entity")?;
        }
    }
    Ok(())
}

/// Number of blocks and of items: the head of `$Nodes` and `$Elements`.
fn read_head(
    scanner: &mut Scanner,
    codec: Codec,
    what: &'static str,
    bytes_each: usize,
) -> Result<(i64, usize), ReadError> {
    let blocks = codec.size(scanner, "the number of blocks")?;
    let count = codec.size(scanner, "the number of nodes or elements")?;
    codec.size(scanner, "the smallest number")?;
    codec.size(scanner, "the largest number")?;
    scanner.check_count("blocks", blocks, codec.bytes(3, 1, 0))?;
    Ok((blocks, scanner.check_count(what, count, bytes_each)?))
}

/// Reads what follows `$Nodes`.
pub(crate) fn read_nodes(
    scanner: &mut Scanner,
    codec: Codec,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    let (blocks, declared) = read_head(scanner, codec, "nodes", codec.bytes(0, 1, 3))?;
    mesh.reserve_points(declared);
    for _ in 0..blocks {
        read_node_block(scanner, codec, mesh)?;
    }
    if mesh.point_count() != declared {
        let present = mesh.point_count() as u64;
        let declared = declared as i64;
        return Err(scanner.fail(ReadFault::Mismatch { what: "nodes", declared, present }));
    }
    mesh.number_points(scanner)
}

/// Node numbers first, then the coordinates, with parameters when the block is parametric.
fn read_node_block(
    scanner: &mut Scanner,
    codec: Codec,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    let dimension = codec.int(scanner, "the dimension of an entity, 0 to 3")?;
    codec.int(scanner, "the tag of an entity")?;
    let parameters = match codec.int(scanner, "0 or 1 for parametric")? {
        0 => 0,
        1 if (0..=3).contains(&dimension) => dimension,
        other => {
            return Err(scanner.malformed("0 or 1 for parametric", &[b'0' + (other & 7) as u8]));
        }
    };
    let count = codec.size(scanner, "the number of nodes of a block")?;
    let count = scanner.check_count("nodes of a block", count, codec.bytes(0, 1, 3))?;
    for _ in 0..count {
        mesh.point_number(codec.size(scanner, "a node number")?);
    }
    for _ in 0..count {
        let line = codec.line(scanner);
        mesh.point(codec.point(scanner)?, line);
        for _ in 0..parameters {
            codec.float(scanner, "a parameter of a node")?;
        }
    }
    Ok(())
}

/// Reads what follows `$Elements`.
pub(crate) fn read_elements(
    scanner: &mut Scanner,
    codec: Codec,
    entities: &Entities,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    let (blocks, declared) = read_head(scanner, codec, "elements", codec.bytes(0, 2, 0))?;
    let mut present = 0;
    for _ in 0..blocks {
        present += read_element_block(scanner, codec, entities, mesh)?;
    }
    if present != declared {
        let (declared, present) = (declared as i64, present as u64);
        return Err(scanner.fail(ReadFault::Mismatch { what: "elements", declared, present }));
    }
    Ok(())
}

fn read_element_block(
    scanner: &mut Scanner,
    codec: Codec,
    entities: &Entities,
    mesh: &mut Assembler,
) -> Result<usize, ReadError> {
    let dimension = codec.int(scanner, "the dimension of an entity")?;
    let tag = codec.int(scanner, "the tag of an entity")?;
    let code = codec.int(scanner, "an element type")?;
    let (nodes, name) = msh::element_type(scanner, code)?;
    let count = codec.size(scanner, "the number of elements of a block")?;
    let bytes_each = codec.bytes(0, 1 + nodes, 0);
    let count = scanner.check_count("elements of a block", count, bytes_each)?;
    let marker = entities.get(&(dimension, tag)).copied().unwrap_or(0);
    for _ in 0..count {
        let line = codec.line(scanner);
        let number = codec.size(scanner, "an element number")?;
        let cell = Cell { number, marker, line };
        msh::element(mesh, (code, nodes, name), cell, || {
            codec.size(scanner, "a node of an element")
        })?;
    }
    Ok(count)
}

/// Writes an MSH 4.1 file: an entity for each marker of edges and each region of triangles, whose
/// physical group is the marker or region (none for 0; 1 in a mesh without regions).
pub(crate) fn write(mesh: MeshView, is_binary: bool, out: &mut TextOut) -> Result<(), WriteError> {
    let groups = Groups::of(mesh);
    msh::write_header(out, "4.1", is_binary, &groups)?;
    let mut out = Out { out, is_binary };
    out.entities(mesh, &groups)?;
    out.nodes(mesh)?;
    out.elements(mesh, &groups)?;
    msh_view::write(mesh.parameters(), is_binary, out.out)?;
    Ok(())
}

/// Writes values as text or binary.
struct Out<'o, 'w> {
    out: &'o mut TextOut<'w>,
    is_binary: bool,
}

impl Out<'_, '_> {
    /// A C `int`.
    fn int(&mut self, value: i64, end: u8) -> io::Result<()> {
        match self.is_binary {
            true => self.out.bytes(&(value as i32).to_le_bytes()),
            false => self.out.integer(value, end),
        }
    }

    /// A C `size_t`.
    #[inline]
    fn size(&mut self, value: i64, end: u8) -> io::Result<()> {
        match self.is_binary {
            true => self.out.bytes(&value.to_le_bytes()),
            false => self.out.integer(value, end),
        }
    }

    /// A C `double`.
    fn float(&mut self, value: f64, end: u8) -> io::Result<()> {
        match self.is_binary {
            true => self.out.bytes(&value.to_le_bytes()),
            false => self.out.float(value, end),
        }
    }

    /// The end of a section.
    fn end(&mut self, section: &str) -> io::Result<()> {
        let newline = if self.is_binary { "\n" } else { "" };
        self.out.text(&format!("{newline}$End{section}\n"))
    }

    fn entities(&mut self, mesh: MeshView, groups: &Groups) -> io::Result<()> {
        self.out.text("$Entities\n")?;
        self.size(0, b' ')?;
        self.size(groups.markers.len() as i64, b' ')?;
        self.size(groups.regions.len() as i64, b' ')?;
        self.size(0, b'\n')?;
        let bounds = bounds(mesh);
        for (tag, &marker) in (1..).zip(&groups.markers) {
            self.entity(tag, marker, bounds)?;
        }
        for (tag, &region) in (1..).zip(&groups.regions) {
            self.entity(tag, region, bounds)?;
        }
        self.end("Entities")
    }

    /// Tag, bounding box (the whole mesh's: any box that holds the entity will do), physical group,
    /// no bounding entities.
    fn entity(&mut self, tag: i64, group: i32, bounds: [[f64; 3]; 2]) -> io::Result<()> {
        self.int(tag, b' ')?;
        for &value in bounds.iter().flatten() {
            self.float(value, b' ')?;
        }
        self.size(i64::from(group != 0), b' ')?;
        if group != 0 {
            self.int(i64::from(group), b' ')?;
        }
        self.size(0, b'\n')
    }

    fn nodes(&mut self, mesh: MeshView) -> io::Result<()> {
        let count = mesh.point_count() as i64;
        self.out.text("$Nodes\n")?;
        self.head(1, count)?;
        self.block([2, 1, 0], count)?;
        for number in 1..=count {
            self.size(number, b'\n')?;
        }
        for point in mesh.points() {
            self.float(point[0], b' ')?;
            self.float(point[1], b' ')?;
            self.float(point[2], b'\n')?;
        }
        self.end("Nodes")
    }

    /// Number of blocks, of items, smallest and largest number.
    fn head(&mut self, blocks: i64, count: i64) -> io::Result<()> {
        self.size(blocks, b' ')?;
        self.size(count, b' ')?;
        self.size(i64::from(count > 0), b' ')?;
        self.size(count, b'\n')
    }

    fn block(&mut self, ints: [i64; 3], count: i64) -> io::Result<()> {
        for value in ints {
            self.int(value, b' ')?;
        }
        self.size(count, b'\n')
    }

    /// Elements keep their order: a new block starts wherever the marker or region changes.
    fn elements(&mut self, mesh: MeshView, groups: &Groups) -> io::Result<()> {
        let edges: Vec<_> = mesh.edges().chunk_by(|a, b| a.marker == b.marker).collect();
        let runs = face_runs(mesh);
        let blocks = edges.len() + runs.len();
        let count = (mesh.edges().len() + mesh.face_count()) as i64;
        self.out.text("$Elements\n")?;
        self.head(blocks as i64, count)?;
        let mut number = 1;
        for run in edges {
            self.block([1, groups.curve(run[0].marker), LINE], run.len() as i64)?;
            for edge in run {
                self.element(number, &edge.vertices)?;
                number += 1;
            }
        }
        let mut faces = mesh.faces();
        for ((region, corners), length) in runs {
            let code = if corners == 4 { QUADRILATERAL } else { TRIANGLE };
            self.block([2, groups.surface(region), code], length as i64)?;
            for face in faces.by_ref().take(length) {
                self.element(number, face.corners())?;
                number += 1;
            }
        }
        self.end("Elements")
    }

    #[inline]
    fn element(&mut self, number: i64, nodes: &[u32]) -> io::Result<()> {
        self.size(number, b' ')?;
        for (index, &node) in nodes.iter().enumerate() {
            let end = if index + 1 == nodes.len() { b'\n' } else { b' ' };
            self.size(i64::from(node) + 1, end)?;
        }
        Ok(())
    }
}

/// Runs of faces of the same region and number of corners, with their lengths.
fn face_runs(mesh: MeshView) -> Vec<((i32, usize), usize)> {
    let mut runs: Vec<((i32, usize), usize)> = Vec::new();
    for (index, face) in mesh.faces().enumerate() {
        let kind = (mesh.face_region(index, DEFAULT_REGION), face.corners().len());
        match runs.last_mut() {
            Some((last, length)) if *last == kind => *length += 1,
            _ => runs.push((kind, 1)),
        }
    }
    runs
}

/// Smallest and largest coordinates; zeros for a mesh without finite points.
fn bounds(mesh: MeshView) -> [[f64; 3]; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for point in mesh.points().filter(|point| point.iter().all(|c| c.is_finite())) {
        for axis in 0..3 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    }
    if low[0] > high[0] { [[0.0; 3]; 2] } else { [low, high] }
}
