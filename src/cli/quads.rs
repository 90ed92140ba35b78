//! `--quads`: the cells of structured grids as quadrilaterals.

use super::arguments::{MeshOptions, Method};
use super::failure::{Diagnostic, Failure};
use crate::format::MeshView;
use crate::point::Point2;
use crate::structured::{concave_cells, pair_up};

/// Whether quadrilaterals are asked for.
///
/// # Errors
/// Exit code 2: the method has no cells.
pub fn wanted(options: &MeshOptions) -> Result<bool, Failure> {
    let is_grid = matches!(options.method, Method::Transfinite | Method::Elliptic);
    if options.quads && !is_grid {
        let message = "--quads has a meaning with --method transfinite or elliptic only: other \
                       methods make triangles without cells";
        return Err(Failure::cannot_run(Diagnostic::new(message).rule("W9")));
    }
    Ok(options.quads)
}

/// Pairs the triangles of cells; in the plane cells must be convex.
///
/// # Errors
/// Exit code 1: a cell is not convex.
pub fn pair(triangles: &mut [[u32; 3]], plane: Option<&[Point2]>) -> Result<(), Failure> {
    pair_up(triangles).map_err(|cell| {
        let message = format!("cell {cell} of the grid has no two triangles with a common edge");
        Failure::findings(vec![Diagnostic::new(message).rule("W9")])
    })?;
    match plane.and_then(|points| concave_cells(points, triangles)) {
        None => Ok(()),
        Some((count, first)) => {
            let at = plane.map(|points| points[triangles[2 * first][0] as usize]);
            let at = at.map_or(String::new(), |at| format!(" near {at}"));
            let message = format!(
                "{count} cells of the grid are not convex, the first{at}: they are no sound \
                 quadrilaterals"
            );
            let help = "leave out --quads, or take --method elliptic or other --corners";
            let diagnostic = Diagnostic::new(message).rule("W10").help(help);
            Err(Failure::findings(vec![diagnostic]))
        }
    }
}

/// The mesh as it is written, its first triangles as so many quadrilaterals.
#[must_use]
pub fn view(mesh: MeshView<'_>, quads: Option<usize>) -> MeshView<'_> {
    quads.and_then(|count| mesh.with_first_quads(count)).unwrap_or(mesh)
}
