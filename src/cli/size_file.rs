//! Size fields from files.

use super::failure::{Diagnostic, Failure};
use super::input::load;
use super::mesh_file::malformed;
use crate::format::node_data::{NodeData, NodeDataForm, read_node_data};
use crate::point::Point2;
use crate::size::SpacingTable;
use std::path::Path;

/// Reads a mesh with a number at each node.
///
/// # Errors
/// Exit code 2: the file cannot be read, its extension names no such form, or it is malformed.
pub fn load_node_data(path: &Path) -> Result<NodeData, Failure> {
    let form = NodeDataForm::from_path(path).ok_or_else(|| {
        let message = "a size field is .msh (with $NodeData), .pos or .vtu";
        Failure::cannot_run(Diagnostic::new(message).at(path.display()))
    })?;
    let input = load(path)?;
    read_node_data(&input.bytes, form).map_err(|e| malformed(&input.name, &e))
}

/// Reads a background mesh with a spacing at each node.
///
/// # Errors
/// As [`load_node_data`], and where a spacing is none.
pub fn load_size_field(path: &Path) -> Result<SpacingTable, Failure> {
    let data = load_node_data(path)?;
    let points = data.points.into_iter().map(Point2::from).collect();
    let table = SpacingTable { points, spacing: data.values, triangles: data.triangles };
    table.check().map_err(|error| {
        Failure::cannot_run(Diagnostic::new(error.to_string()).at(path.display()))
    })?;
    Ok(table)
}
