//! Netgen's `.vol` files.
//!
//! Source: Netgen's `Mesh::Save`. The boundary condition number of a surface element is its region,
//! the first number of an edge segment its marker.

use crate::format::ReadOptions;
use crate::format::assemble::{Assembler, Cell};
use crate::format::error::ReadError;
use crate::format::scan::Scanner;
use crate::mesh::MeshData;

/// Reads a Netgen mesh.
///
/// # Errors
/// The first fault with its line.
pub fn read(bytes: &[u8], options: &ReadOptions) -> Result<MeshData, ReadError> {
    let mut scanner = Scanner::new(bytes).with_comments(b'#');
    if scanner.expect("mesh3d").is_err() && scanner.expect("mesh2d").is_err() {
        let found = scanner.peek();
        return Err(scanner.malformed("`mesh3d`", found));
    }
    let mut mesh = Assembler::new(1, options.split_quads);
    let mut has_points = false;
    loop {
        let keyword = scanner.token("a keyword such as `points` or `endmesh`")?;
        match keyword {
            b"endmesh" => break,
            b"points" => {
                has_points = true;
                read_points(&mut scanner, &mut mesh)?;
            }
            b"surfaceelements" | b"surfaceelementsgi" | b"surfaceelementsuv" => {
                read_surface_elements(&mut scanner, &mut mesh)?;
            }
            b"volumeelements" => read_volume_elements(&mut scanner, &mut mesh)?,
            b"edgesegments" | b"edgesegmentsgi" | b"edgesegmentsgi2" => {
                read_edges(&mut scanner, &mut mesh)?;
            }
            _ if keyword[0].is_ascii_alphabetic() => skip_section(&mut scanner),
            _ => return Err(scanner.malformed("a keyword such as `points`", keyword)),
        }
    }
    if !has_points {
        return Err(scanner.malformed("`points` before `endmesh`", b"endmesh"));
    }
    mesh.finish(&scanner)
}

/// Skips lines up to one that starts with a letter: the next keyword.
fn skip_section(scanner: &mut Scanner) {
    scanner.rest_of_line();
    while !scanner.is_at_end() && !scanner.peek()[0].is_ascii_alphabetic() {
        scanner.rest_of_line();
    }
}

fn read_points(scanner: &mut Scanner, mesh: &mut Assembler) -> Result<(), ReadError> {
    let count = scanner.count("points", 6)?;
    mesh.reserve_points(count);
    for _ in 0..count {
        scanner.skip_blank();
        let line = scanner.line();
        let point = scanner.point(3)?;
        scanner.rest_of_line();
        mesh.point(point, line);
    }
    Ok(())
}

/// `surface condition domain-in domain-out n p1 ... pn`, then geometry.
fn read_surface_elements(scanner: &mut Scanner, mesh: &mut Assembler) -> Result<(), ReadError> {
    let count = scanner.count("surface elements", 12)?;
    for number in 0..count as i64 {
        scanner.skip_blank();
        let line = scanner.line();
        let [_, marker, _, _, corners] = scanner.corners::<5>()?;
        let cell = Cell { number, marker, line };
        match corners {
            3 => mesh.triangle(scanner.corners()?, cell),
            4 => mesh.quad(scanner.corners()?, cell, 4, "quadrilateral"),
            6 => mesh.other(6, 1, || "second-order triangle".to_owned()),
            8 => mesh.other(8, 1, || "second-order quadrilateral".to_owned()),
            other => {
                let found = other.to_string();
                return Err(scanner.malformed("3, 4, 6 or 8 corners", found.as_bytes()));
            }
        }
        scanner.rest_of_line();
    }
    Ok(())
}

/// `material n p1 ... pn`: counted.
fn read_volume_elements(scanner: &mut Scanner, mesh: &mut Assembler) -> Result<(), ReadError> {
    let count = scanner.count("volume elements", 4)?;
    for _ in 0..count {
        let [_, corners] = scanner.corners::<2>()?;
        mesh.other(100_i64.saturating_add(corners), 1, || match corners {
            4 => "tetrahedron".to_owned(),
            5 => "pyramid".to_owned(),
            6 => "prism".to_owned(),
            8 => "hexahedron".to_owned(),
            corners => format!("volume element with {corners} points"),
        });
        scanner.rest_of_line();
    }
    Ok(())
}

/// `condition 0 p1 p2`, then geometry.
fn read_edges(scanner: &mut Scanner, mesh: &mut Assembler) -> Result<(), ReadError> {
    let count = scanner.count("edge segments", 8)?;
    for number in 0..count as i64 {
        scanner.skip_blank();
        let line = scanner.line();
        let [marker, _, a, b] = scanner.corners::<4>()?;
        mesh.edge([a, b], Cell { number, marker, line });
        scanner.rest_of_line();
    }
    Ok(())
}
