//! ADCIRC's grids (`fort.14`, `.14`, `.grd`).
//!
//! Source: the ADCIRC user's manual, "Fort.14". The third number of a node is its depth, which is
//! no coordinate: z = 0. Boundary segments become marked edges: open ones with marker -1, land and
//! island ones with their type IBTYPE; a closed island also gets its closing edge. Of barrier types
//! the nodes on the first side count.

use crate::format::ReadOptions;
use crate::format::assemble::{Assembler, Cell};
use crate::format::error::ReadError;
use crate::format::scan::Scanner;
use crate::mesh::MeshData;

/// The marker of open boundaries: IBTYPE is never negative.
const OPEN: i64 = -1;

/// Boundary types of islands, whose last node is followed by the first.
const ISLANDS: [i64; 3] = [1, 11, 21];

/// Reads an ADCIRC grid.
///
/// # Errors
/// The first fault with its line.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let mut scanner = Scanner::new(bytes);
    // The title may be empty, and may hold anything.
    scanner.rest_of_line();
    let elements = scanner.integer("the number of elements")?;
    let nodes = scanner.count("nodes", 8)?;
    let elements = scanner.check_count("elements", elements, 10)?;
    scanner.rest_of_line();
    let mut mesh = Assembler::new(1, options.split_quads);
    read_nodes(&mut scanner, nodes, &mut mesh)?;
    read_elements(&mut scanner, elements, &mut mesh)?;
    // Grids of other programs end here.
    if !scanner.is_at_end() {
        read_boundaries(&mut scanner, &mut mesh, false)?;
    }
    if !scanner.is_at_end() {
        read_boundaries(&mut scanner, &mut mesh, true)?;
    }
    mesh.finish(&scanner)
}

/// `number x y depth`
fn read_nodes(scanner: &mut Scanner, count: usize, mesh: &mut Assembler) -> Result<(), ReadError> {
    mesh.reserve_points(count);
    for _ in 0..count {
        scanner.skip_blank();
        let line = scanner.line();
        mesh.point_number(scanner.integer("the number of a node")?);
        mesh.point(scanner.point(2)?, line);
        scanner.rest_of_line();
    }
    mesh.number_points(scanner)
}

/// `number corners n1 n2 n3`
fn read_elements(
    scanner: &mut Scanner,
    count: usize,
    mesh: &mut Assembler,
) -> Result<(), ReadError> {
    for _ in 0..count {
        scanner.skip_blank();
        let line = scanner.line();
        let number = scanner.integer("the number of an element")?;
        let cell = Cell { number, marker: 0, line };
        match scanner.integer("the number of corners, 3 or 4")? {
            3 => mesh.triangle(scanner.corners()?, cell),
            4 => mesh.quad(scanner.corners()?, cell, 4, "quadrilateral"),
            other => {
                let found = other.to_string();
                return Err(scanner.malformed("3 or 4 corners", found.as_bytes()));
            }
        }
        scanner.rest_of_line();
    }
    Ok(())
}

/// Number of segments, number of nodes in all; then for each segment its number of nodes (and, for
/// land, its type) and the nodes, one a line.
fn read_boundaries(
    scanner: &mut Scanner,
    mesh: &mut Assembler,
    has_types: bool,
) -> Result<(), ReadError> {
    let segments = scanner.count("boundary segments", 2)?;
    scanner.rest_of_line();
    scanner.integer("the number of boundary nodes")?;
    scanner.rest_of_line();
    let mut number = 0;
    for _ in 0..segments {
        let nodes = scanner.count("nodes of a boundary segment", 2)?;
        let marker = if has_types { scanner.integer("the type of a boundary")? } else { OPEN };
        scanner.rest_of_line();
        let mut ends: Option<(i64, i64)> = None;
        for _ in 0..nodes {
            scanner.skip_blank();
            let cell = Cell { number, marker, line: scanner.line() };
            let node = scanner.integer("a node of a boundary")?;
            scanner.rest_of_line();
            if let Some((_, last)) = ends {
                mesh.edge([last, node], cell);
                number += 1;
            }
            ends = Some((ends.map_or(node, |ends| ends.0), node));
        }
        if let Some((first, last)) = ends.filter(|&(first, last)| first != last)
            && ISLANDS.contains(&marker)
            && has_types
        {
            mesh.edge([last, first], Cell { number, marker, line: scanner.line() });
            number += 1;
        }
    }
    Ok(())
}
