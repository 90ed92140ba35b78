//! Every fault of a domain at once, and the sound domain as a planar linear complex.

use crate::domain::Region;
use crate::point::Point2;

/// A segment of a [`Plc`]: meets other segments at its end points only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlcSegment {
    /// Indices into [`Plc::points`].
    pub vertices: [u32; 2],
    /// Marker of the segment it came from.
    pub marker: i32,
    /// Whether it belongs to a loop: under the even-odd rule, crossing it switches inside and
    /// outside. Free segments are interior constraints.
    pub in_loop: bool,
}

/// Which faces of a [`Plc`] are inside.
#[derive(Clone, Debug, PartialEq)]
pub enum PlcInside {
    /// Reached from infinity by crossing an odd number of `in_loop` segments.
    EvenOdd,
    /// Not reached from infinity nor from one of these points without crossing a segment.
    Carve(Vec<Point2>),
}

/// A validated domain: distinct finite points, segments that meet only at shared end points.
#[derive(Clone, Debug, PartialEq)]
pub struct Plc {
    /// Distinct points, in the order in which the domain first lists them.
    pub points: Vec<Point2>,
    /// Segments; no two share both ends.
    pub segments: Vec<PlcSegment>,
    /// The rule for inside.
    pub inside: PlcInside,
    /// Region seeds.
    pub regions: Vec<Region>,
}
