//! The identifiers of findings: one per class of defect, the same as in `SPEC.md`.

use serde::{Deserialize, Serialize};

/// What a finding violates.
///
/// The serialised form is the SPEC id (`"M15"`), which is never reused or renumbered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Id {
    /// The mesh has no triangle: nothing could be checked.
    #[serde(rename = "M1")]
    Empty,
    /// A triangle names a point that does not exist.
    #[serde(rename = "M2")]
    BadReference,
    /// A triangle names a point twice.
    #[serde(rename = "M3")]
    RepeatedVertex,
    /// A coordinate is NaN or infinite.
    #[serde(rename = "M4")]
    NotFinite,
    /// Two points in use have the same coordinates.
    #[serde(rename = "M5")]
    DuplicateVertex,
    /// No triangle uses a point.
    #[serde(rename = "M6")]
    UnusedVertex,
    /// Two triangles have the same three corners.
    #[serde(rename = "M7")]
    DuplicateTriangle,
    /// A triangle's corners lie on a line.
    #[serde(rename = "M8")]
    ZeroArea,
    /// Every triangle is clockwise.
    #[serde(rename = "M9")]
    Clockwise,
    /// Some triangles list their corners clockwise, others counterclockwise.
    #[serde(rename = "M10")]
    MixedOrientation,
    /// A triangle is folded over its neighbours.
    #[serde(rename = "M11")]
    Inverted,
    /// More than two triangles share an edge.
    #[serde(rename = "M12")]
    NonManifoldEdge,
    /// Parts of the mesh hang together by a vertex only.
    #[serde(rename = "M13")]
    BowTie,
    /// A vertex lies inside another triangle's edge.
    #[serde(rename = "M14")]
    HangingNode,
    /// Triangles overlap.
    #[serde(rename = "M15")]
    Overlap,
    /// Part of the domain is not covered.
    #[serde(rename = "M16")]
    Uncovered,
    /// A triangle lies outside the domain.
    #[serde(rename = "M17")]
    Outside,
    /// A boundary segment of the domain is not a chain of mesh edges.
    #[serde(rename = "M18")]
    BoundaryLost,
    /// A node of a subdivided segment lies too far from it.
    #[serde(rename = "M19")]
    Deviation,
    /// An interior constraint is not a chain of mesh edges.
    #[serde(rename = "M20")]
    ConstraintLost,
    /// An isolated point of the domain is not a mesh vertex.
    #[serde(rename = "M21")]
    PointLost,
    /// A marked edge of the file is no edge of a triangle.
    #[serde(rename = "M22")]
    MarkedEdge,
    /// An interior edge is not locally Delaunay.
    #[serde(rename = "M23")]
    NotDelaunay,
    /// An interior edge that is no constraint is not locally Delaunay.
    #[serde(rename = "M24")]
    NotConstrainedDelaunay,
    /// A surface that should be closed has a boundary.
    #[serde(rename = "M25")]
    NotClosed,
    /// Neighbouring triangles of a surface disagree about its sides.
    #[serde(rename = "M26")]
    SurfaceOrientation,
    /// A surface intersects itself.
    #[serde(rename = "M27")]
    SelfIntersection,
    /// A triangle is too far from the surface of the model, or faces too far away from it.
    #[serde(rename = "S8")]
    SurfaceDeviation,
    /// A triangle faces against the others of its patch.
    #[serde(rename = "S9")]
    SurfaceFold,
    /// The Euler number is not the model's.
    #[serde(rename = "S10")]
    SurfaceEuler,
    /// The mesh does not end where the model ends.
    #[serde(rename = "S11")]
    SurfaceBoundary,
    /// A quality gate is missed.
    #[serde(rename = "Q1")]
    GateMissed,
    /// A metric is worse than in the baseline.
    #[serde(rename = "Q2")]
    BaselineMissed,
}

use Id::{
    BadReference, BaselineMissed, BoundaryLost, BowTie, Clockwise, ConstraintLost, Deviation,
    DuplicateTriangle, DuplicateVertex, Empty, GateMissed, HangingNode, Inverted, MarkedEdge,
    MixedOrientation, NonManifoldEdge, NotClosed, NotConstrainedDelaunay, NotDelaunay, NotFinite,
    Outside, Overlap, PointLost, RepeatedVertex, SelfIntersection, SurfaceBoundary,
    SurfaceDeviation, SurfaceEuler, SurfaceFold, SurfaceOrientation, Uncovered, UnusedVertex,
    ZeroArea,
};

/// `(id, SPEC id, slug, rule)` of every id, in order.
const TABLE: [(Id, &str, &str, &str); 33] = [
    (Empty, "M1", "empty-mesh", "a mesh has at least one triangle"),
    (BadReference, "M2", "bad-reference", "every corner of a triangle names a point of the mesh"),
    (
        RepeatedVertex,
        "M3",
        "repeated-vertex",
        "the three corners of a triangle are different points",
    ),
    (NotFinite, "M4", "not-finite", "coordinates are finite numbers"),
    (DuplicateVertex, "M5", "duplicate-vertex", "no two points in use have equal coordinates"),
    (UnusedVertex, "M6", "unused-vertex", "every point is a corner of a triangle"),
    (DuplicateTriangle, "M7", "duplicate-triangle", "no two triangles have the same corners"),
    (ZeroArea, "M8", "zero-area", "the corners of a triangle do not lie on a line"),
    (Clockwise, "M9", "clockwise", "triangles are counterclockwise"),
    (MixedOrientation, "M10", "mixed-orientation", "all triangles list their corners in one sense"),
    (Inverted, "M11", "inverted", "no triangle is folded over its neighbours"),
    (NonManifoldEdge, "M12", "non-manifold-edge", "at most two triangles share an edge"),
    (BowTie, "M13", "bow-tie", "parts of a mesh do not hang together by a vertex only"),
    (HangingNode, "M14", "hanging-node", "no vertex lies inside an edge of a triangle"),
    (Overlap, "M15", "overlap", "the interiors of triangles are disjoint"),
    (Uncovered, "M16", "uncovered", "the triangles cover the domain"),
    (Outside, "M17", "outside", "no triangle lies outside the domain"),
    (BoundaryLost, "M18", "boundary-lost", "every boundary segment is a chain of mesh edges"),
    (Deviation, "M19", "deviation", "nodes of a subdivided segment lie on it up to rounding"),
    (
        ConstraintLost,
        "M20",
        "constraint-lost",
        "every interior constraint is a chain of mesh edges",
    ),
    (PointLost, "M21", "point-lost", "every isolated point of the domain is a mesh vertex"),
    (MarkedEdge, "M22", "marked-edge", "every marked edge is an edge of a triangle"),
    (NotDelaunay, "M23", "not-delaunay", "every interior edge is locally Delaunay"),
    (
        NotConstrainedDelaunay,
        "M24",
        "not-constrained-delaunay",
        "every interior edge that is no constraint is locally Delaunay",
    ),
    (NotClosed, "M25", "not-closed", "a closed surface has no boundary"),
    (
        SurfaceOrientation,
        "M26",
        "surface-orientation",
        "neighbours run along their edge in opposite directions",
    ),
    (
        SelfIntersection,
        "M27",
        "self-intersection",
        "triangles of a surface meet in a common vertex or edge only",
    ),
    (
        SurfaceDeviation,
        "S8",
        "surface-deviation",
        "vertices lie on the model's surface, triangles as near to it as demanded",
    ),
    (SurfaceFold, "S9", "surface-fold", "all triangles of a patch face the same side"),
    (SurfaceEuler, "S10", "surface-euler", "the mesh has the Euler number of the model"),
    (
        SurfaceBoundary,
        "S11",
        "surface-boundary",
        "the mesh ends where the model ends, and has its corners",
    ),
    (GateMissed, "Q1", "gate-missed", "every quality gate holds"),
    (BaselineMissed, "Q2", "baseline-missed", "no metric is worse than in the baseline"),
];

impl Id {
    /// Every id, in the order of reports.
    pub fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|row| row.0)
    }

    fn row(self) -> &'static (Self, &'static str, &'static str, &'static str) {
        &TABLE[self as usize]
    }

    /// The SPEC id, such as `"M15"`.
    #[must_use]
    pub fn code(self) -> &'static str {
        self.row().1
    }

    /// The name for people, such as `"overlap"`.
    #[must_use]
    pub fn slug(self) -> &'static str {
        self.row().2
    }

    /// The rule that a finding of this id breaks, in half a sentence.
    #[must_use]
    pub fn rule(self) -> &'static str {
        self.row().3
    }
}

impl std::fmt::Display for Id {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.code())
    }
}

/// Text that names no id.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is neither the id (M15) nor the name (overlap) of a finding")]
pub struct UnknownId(pub String);

impl std::str::FromStr for Id {
    type Err = UnknownId;

    /// Reads a SPEC id in either case, or a name.
    fn from_str(text: &str) -> Result<Self, UnknownId> {
        let wanted = text.trim();
        let matches = |row: &&(Self, &str, &str, &str)| {
            row.1.eq_ignore_ascii_case(wanted) || row.2.eq_ignore_ascii_case(wanted)
        };
        TABLE.iter().find(matches).map(|row| row.0).ok_or_else(|| UnknownId(wanted.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_follows_the_enumeration() {
        for (i, id) in Id::all().enumerate() {
            assert_eq!(id as usize, i);
            assert_eq!(serde_json::to_value(id).unwrap(), id.code());
            assert_eq!(id.code().parse::<Id>(), Ok(id));
            assert_eq!(id.slug().parse::<Id>(), Ok(id));
        }
    }

    #[test]
    fn unknown_names_are_refused() {
        assert_eq!("M0".parse::<Id>().unwrap_err().to_string().split('\'').nth(1), Some("M0"));
        assert!("".parse::<Id>().is_err());
    }
}
