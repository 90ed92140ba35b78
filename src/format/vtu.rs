//! VTU, the XML form of VTK's unstructured grids.
//!
//! Source: the VTK user's guide, "XML file formats", and VTK's own reader for what it leaves open:
//! a base64 stream of compressed data starts with its header in a base64 stream of its own.
//!
//! Written files have the triangles first, then the marked edges as lines; the cell arrays `region`
//! and `marker` say the region of a triangle and the marker of an edge, and are 0 elsewhere. Read
//! are also Gmsh's and meshio's arrays `gmsh:physical` and `medit:ref`.

mod data;
mod read;
#[cfg(test)]
mod tests;
mod write;

pub use read::read;
pub(crate) use read::read_point_data;
pub(crate) use write::write;
