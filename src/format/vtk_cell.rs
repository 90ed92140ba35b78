//! Cells of VTK files by their type codes, as VTU and legacy files share them.
//!
//! Source: `vtkCellType.h`.

use crate::format::assemble::{Assembler, Cell};

/// VTK's code of a 2-point line.
pub(crate) const LINE: i64 = 3;
/// VTK's code of a triangle.
pub(crate) const TRIANGLE: i64 = 5;
/// VTK's code of a polygon.
pub(crate) const POLYGON: i64 = 7;
const PIXEL: i64 = 8;
/// VTK's code of a quadrilateral.
pub(crate) const QUADRILATERAL: i64 = 9;

/// Names of the cells that are not read as triangles or edges.
const NAMES: [(i64, &str); 19] = [
    (0, "empty cell"),
    (1, "vertex"),
    (2, "poly-vertex"),
    (4, "polyline"),
    (6, "triangle strip"),
    (POLYGON, "polygon"),
    (PIXEL, "pixel"),
    (QUADRILATERAL, "quadrilateral"),
    (10, "tetrahedron"),
    (11, "voxel"),
    (12, "hexahedron"),
    (13, "wedge"),
    (14, "pyramid"),
    (21, "quadratic edge"),
    (22, "quadratic triangle"),
    (23, "quadratic quadrilateral"),
    (24, "quadratic tetrahedron"),
    (25, "quadratic hexahedron"),
    (69, "Lagrange triangle"),
];

/// The name of a cell type.
fn kind(code: i64) -> String {
    match NAMES.iter().find(|entry| entry.0 == code) {
        Some((_, name)) => format!("{name} (VTK type {code})"),
        None => format!("VTK type {code}"),
    }
}

/// Names of the cell arrays that say the region of a triangle, the likeliest first.
pub(crate) const REGION_ARRAYS: [&[u8]; 4] =
    [b"region", b"gmsh:physical", b"medit:ref", b"CellEntityIds"];
/// Names of the cell arrays that say the marker of an edge, the likeliest first.
pub(crate) const MARKER_ARRAYS: [&[u8]; 4] =
    [b"marker", b"gmsh:physical", b"medit:ref", b"CellEntityIds"];

/// The cells of a piece.
#[derive(Debug, Default)]
pub(crate) struct Cells {
    /// Corners of all cells, one cell after the other.
    pub(crate) connectivity: Vec<i64>,
    /// Where the corners of each cell end.
    pub(crate) ends: Vec<i64>,
    /// VTK's code of each cell.
    pub(crate) types: Vec<i64>,
    /// Region of each cell; empty for none.
    pub(crate) regions: Vec<i64>,
    /// Marker of each cell; empty for none.
    pub(crate) markers: Vec<i64>,
}

impl Cells {
    /// Hands all cells over, numbered from `first`: `Err` with what is expected where the arrays
    /// contradict each other.
    pub(crate) fn assemble(&self, mesh: &mut Assembler, first: i64) -> Result<(), &'static str> {
        let mut start = 0;
        for (index, (&end, &code)) in self.ends.iter().zip(&self.types).enumerate() {
            let range = start..usize::try_from(end).unwrap_or(0);
            let corners =
                self.connectivity.get(range).ok_or("offsets that rise from cell to cell")?;
            start += corners.len();
            let source = if code == LINE { &self.markers } else { &self.regions };
            let marker = source.get(index).copied().unwrap_or(0);
            cell(mesh, code, corners, Cell { number: first + index as i64, marker, line: None })?;
        }
        Ok(())
    }
}

/// Hands a cell over: `Err` with what is expected when its type and its number of corners
/// contradict each other.
pub(crate) fn cell(
    mesh: &mut Assembler,
    code: i64,
    corners: &[i64],
    cell: Cell,
) -> Result<(), &'static str> {
    match (code, corners) {
        (LINE, &[a, b]) => mesh.edge([a, b], cell),
        (TRIANGLE | POLYGON, &[a, b, c]) => mesh.triangle([a, b, c], cell),
        (QUADRILATERAL | POLYGON, &[a, b, c, d]) => {
            mesh.quad([a, b, c, d], cell, code, &kind(QUADRILATERAL));
        }
        // A pixel lists its corners row by row.
        (PIXEL, &[a, b, d, c]) => mesh.quad([a, b, c, d], cell, code, &kind(PIXEL)),
        (LINE, _) => return Err("a line with 2 points"),
        (TRIANGLE, _) => return Err("a triangle with 3 points"),
        (QUADRILATERAL | PIXEL, _) => return Err("a quadrilateral with 4 points"),
        _ => mesh.other(code, 1, || kind(code)),
    }
    Ok(())
}
