//! Aquaveo SMS's `.2dm` files: a card a line, in any order.
//!
//! Source: the XMS wiki, "2D Mesh Files *.2dm". The third number of a node is its elevation, which
//! is no coordinate: z = 0. The material of a triangle is its region. `E2L` edges have their
//! material as marker; the edges of a node string `NS` have the number after its end, else its rank.

use crate::format::ReadOptions;
use crate::format::assemble::{Assembler, Cell};
use crate::format::error::ReadError;
use crate::format::scan::Scanner;
use crate::mesh::MeshData;

/// Reads a `.2dm` file.
///
/// # Errors
/// The first fault with its line.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let mut scanner = Scanner::new(bytes);
    let first = scanner.token("`MESH2D`")?;
    if first != b"MESH2D" {
        return Err(scanner.malformed("`MESH2D`", first));
    }
    scanner.rest_of_line();
    let mut mesh = Assembler::new(1, options.split_quads);
    // Elements usually stand before the nodes they name.
    let mut nodes = scanner.clone();
    while !nodes.is_at_end() {
        read_node(&mut nodes, &mut mesh)?;
    }
    if mesh.point_count() == 0 {
        return Err(nodes.malformed("a node card `ND`", b""));
    }
    mesh.number_points(&nodes)?;
    let mut string = NodeString::default();
    while !scanner.is_at_end() {
        read_card(&mut scanner, &mut string, &mut mesh)?;
    }
    if string.last.is_some() {
        return Err(scanner.malformed("the end of a node string, a negative number", b""));
    }
    mesh.finish(&nodes)
}

/// `ND number x y z`; other cards are skipped.
fn read_node(scanner: &mut Scanner, mesh: &mut Assembler) -> Result<(), ReadError> {
    let line = scanner.line();
    if scanner.token("a card")? == b"ND" {
        mesh.point_number(scanner.integer("the number of a node")?);
        mesh.point(scanner.point(2)?, line);
    }
    scanner.rest_of_line();
    Ok(())
}

/// The node string at hand.
#[derive(Default)]
struct NodeString {
    /// How many were met.
    count: i64,
    /// The latest node; `None` between strings.
    last: Option<i64>,
    /// Its edges, whose marker is known at its end.
    edges: Vec<([i64; 2], Option<u64>)>,
}

fn read_card(
    scanner: &mut Scanner,
    string: &mut NodeString,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    let line = scanner.line();
    let card = scanner.token("a card")?;
    let kind = match card {
        b"E3T" | b"E4Q" | b"E2L" => {
            read_element(scanner, card, line, mesh)?;
            None
        }
        b"NS" => {
            read_node_string(scanner, line, string, mesh)?;
            None
        }
        b"E3L" => Some((3, "second-order line (E3L)")),
        b"E6T" => Some((6, "second-order triangle (E6T)")),
        b"E8Q" => Some((8, "second-order quadrilateral (E8Q)")),
        b"E9Q" => Some((9, "second-order quadrilateral (E9Q)")),
        _ if card[0].is_ascii_uppercase() || card[0] == b'#' => None,
        _ => return Err(scanner.malformed("a card such as `E3T` or `ND`", card)),
    };
    if let Some((code, kind)) = kind {
        mesh.other(code, 1, || kind.to_owned());
    }
    scanner.rest_of_line();
    Ok(())
}

/// `E3T number n1 n2 n3 [material]` and its like.
fn read_element(
    scanner: &mut Scanner,
    card: &[u8],
    line: Option<u64>,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    let number = scanner.integer("the number of an element")?;
    let mut nodes = [0; 4];
    let count = usize::from(card[1] - b'0');
    for node in &mut nodes[..count] {
        *node = scanner.integer("a node of an element")?;
    }
    let marker = scanner.integer_on_line("the material of an element")?.unwrap_or(0);
    let cell = Cell { number, marker, line };
    match card {
        b"E3T" => mesh.triangle([nodes[0], nodes[1], nodes[2]], cell),
        b"E2L" => mesh.edge([nodes[0], nodes[1]], cell),
        _ => mesh.quad(nodes, cell, 4, "quadrilateral (E4Q)"),
    }
    Ok(())
}

/// `NS n1 n2 ... -n [number]`, over as many cards as it takes.
fn read_node_string(
    scanner: &mut Scanner,
    line: Option<u64>,
    string: &mut NodeString,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    while let Some(value) = scanner.integer_on_line("a node of a node string")? {
        let node = value.abs();
        if let Some(last) = string.last {
            string.edges.push(([last, node], line));
        }
        string.last = Some(node);
        if value < 0 {
            string.count += 1;
            let number =
                scanner.token_on_line().and_then(|token| scanner.parse_integer(token, "").ok());
            let marker = number.unwrap_or(string.count);
            for (rank, (ends, line)) in (0..).zip(string.edges.drain(..)) {
                mesh.edge(ends, Cell { number: rank, marker, line });
            }
            string.last = None;
            return Ok(());
        }
    }
    Ok(())
}
