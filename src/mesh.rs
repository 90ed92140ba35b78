//! Meshes as plain arrays: what the mesher hands out, and what a mesh file says.
//!
//! Both halves of the house share these types and nothing else: no adjacency is stored, so nothing
//! the mesher believes about its mesh can reach the checker.

use crate::point::Point2;
use serde::{Deserialize, Serialize};

/// An edge of a mesh that carries a marker: a piece of the boundary or of an interior constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MarkedEdge {
    /// Indices into the mesh's points.
    pub vertices: [u32; 2],
    /// The marker of the segment the edge is part of.
    pub marker: i32,
}

/// A plane triangulation as the mesher makes it.
///
/// # Shapes and units
/// `points: [n][2]` in the unit of the domain; `triangles: [m][3]` indices into `points`,
/// counterclockwise; `regions` is empty or `[m]`; `edges: [k]`, boundary edges with the domain on
/// their left first given in that direction, then interior constraints.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// Vertices.
    pub points: Vec<Point2>,
    /// Counterclockwise triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Boundary edges and interior constraints with their markers.
    pub edges: Vec<MarkedEdge>,
    /// Region marker of each triangle; empty when the domain names no regions.
    pub regions: Vec<i32>,
}

/// The corner of a triangle that names no point.
pub const NO_POINT: u32 = u32::MAX;

/// A reference of a triangle to a point that the file does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BadReference {
    /// Index into [`MeshData::triangles`].
    pub triangle: u32,
    /// 0, 1 or 2.
    pub corner: u8,
    /// What the file says, in the file's own numbering.
    pub value: i64,
}

/// A marked edge that names a point the file does not have; it is not among [`MeshData::edges`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BadEdge {
    /// The file's own number of the edge, or its rank among the file's edges.
    pub edge: i64,
    /// What the file says, in the file's own numbering.
    pub value: i64,
    /// Line of the edge, when known.
    pub line: Option<u64>,
}

/// Cells of a mesh file that are not triangles or marked edges: counted, never silently dropped.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct OtherCells {
    /// The format's own name of the cell type, e.g. `quadrilateral (Gmsh type 3)`.
    pub kind: String,
    /// How many the file has.
    pub count: u64,
}

/// A mesh file as it was read, or anybody's arrays: nothing repaired, nothing dropped.
///
/// ```
/// use trigrade::check::check;
/// use trigrade::mesh::MeshData;
/// let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = |triangles: &[[u32; 3]]| MeshData {
///     points: points.clone(),
///     triangles: triangles.to_vec(),
///     ..MeshData::default()
/// };
/// let report = |mesh: &MeshData| check(mesh, None, &Default::default());
/// assert!(report(&mesh(&[[0, 1, 2], [0, 2, 3]])).passed());
/// // Two triangles that lie over each other.
/// assert!(!report(&mesh(&[[0, 1, 2], [0, 1, 3]])).passed());
/// ```
///
/// # Shapes and units
/// `points: [n][3]`, z = 0 where the file has two coordinates; `triangles: [m][3]`, in the file's
/// order and orientation, [`NO_POINT`] where `bad_references` says what stood there.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeshData {
    /// Vertices; coordinates may be NaN or infinite when the file says so.
    pub points: Vec<[f64; 3]>,
    /// Triangles in file order.
    pub triangles: Vec<[u32; 3]>,
    /// Marked edges (boundary, constraints) that the file lists, in file order.
    pub edges: Vec<MarkedEdge>,
    /// Region (physical group, attribute) of each triangle, or empty.
    pub regions: Vec<i32>,
    /// References to points that do not exist.
    pub bad_references: Vec<BadReference>,
    /// Marked edges left out because they name points that do not exist.
    pub bad_edges: Vec<BadEdge>,
    /// Cells of other kinds.
    pub other_cells: Vec<OtherCells>,
    /// The file's own number of each point when that is not 0, 1, 2, ...; else empty.
    pub point_numbers: Vec<i64>,
    /// The file's own number of each triangle when that is not 0, 1, 2, ...; else empty.
    pub triangle_numbers: Vec<i64>,
    /// Line (1-based) of each point, or empty for a binary file.
    pub point_lines: LineIndex,
    /// Line (1-based) of each triangle, or empty for a binary file.
    pub triangle_lines: LineIndex,
    /// Most significant decimal digits of a coordinate that is not exactly an f64 (below 17 means
    /// that the file may not carry every f64); `None` for a binary file or when all are exact.
    pub decimal_digits: Option<u8>,
}

/// Where in a text file the entries of an array stand, compressed: runs of entries on consecutive
/// lines. Memory is proportional to the runs, so an ordinary file costs a few bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LineIndex {
    /// `(first entry, its line)`; within a run entry i+1 stands one line below entry i.
    runs: Vec<(u32, u64)>,
}

impl LineIndex {
    /// Records that `entry` stands on `line`; entries must come in rising order.
    pub fn push(&mut self, entry: u32, line: u64) {
        let predicted = self.runs.last().map(|&(first, at)| at + u64::from(entry - first));
        if predicted != Some(line) {
            self.runs.push((entry, line));
        }
    }

    /// The line of `entry`, or `None` if nothing was recorded at or before it.
    #[must_use]
    pub fn line(&self, entry: u32) -> Option<u64> {
        let after = self.runs.partition_point(|&(first, _)| first <= entry);
        let (first, line) = *self.runs.get(after.checked_sub(1)?)?;
        Some(line + u64::from(entry - first))
    }
}

impl From<&Mesh> for MeshData {
    fn from(mesh: &Mesh) -> Self {
        Self {
            points: mesh.points.iter().map(|p| [p.x, p.y, 0.0]).collect(),
            triangles: mesh.triangles.clone(),
            edges: mesh.edges.clone(),
            regions: mesh.regions.clone(),
            ..Self::default()
        }
    }
}
