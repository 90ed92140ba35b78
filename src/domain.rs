//! Domains: what is to be meshed, as plain data exactly as the user gave it.
//!
//! A domain is a planar straight-line graph (PSLG) given as closed loops, free segments and
//! points, plus a rule that says which of its faces are meshed. Nothing here is repaired: a
//! [`Domain`] may be invalid, and [`validate`] finds every fault at once
//! and turns a sound one into a [`Plc`](crate::domain::validate::Plc).

pub mod naca;
pub mod validate;

use crate::point::Point2;
use std::fmt;

/// What a loop claims to be. Orientation is never a claim: it is normalised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopRole {
    /// The file makes no claim; nesting decides (even-odd rule).
    Any,
    /// Outer boundary of a piece of the domain, in no loop or in a hole (an island).
    Outer,
    /// A hole of the loop with this index in [`Domain::loops`].
    HoleOf(usize),
}

/// A closed loop of segments; the closing segment from the last vertex to the first is implied.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// Indices into [`Domain::points`], without a repeated closing vertex.
    pub vertices: Vec<u32>,
    /// Marker of the segment from vertex i to vertex i + 1; same length as `vertices`.
    pub markers: Vec<i32>,
    /// What the file claims of the loop.
    pub role: LoopRole,
}

/// A segment that belongs to no loop: an interior constraint, or (rule [`Inside::Carve`]) any
/// segment of a `.poly` file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Indices into [`Domain::points`].
    pub vertices: [u32; 2],
    /// The segment's marker.
    pub marker: i32,
}

/// Which faces of the planar straight-line graph are meshed.
#[derive(Clone, Debug, PartialEq)]
pub enum Inside {
    /// Those an odd number of loops wind around; free segments are interior constraints.
    EvenOdd,
    /// Triangle's rule: all but those that can be reached from infinity, or from one of these hole
    /// points, without crossing a segment.
    Carve(Vec<Point2>),
}

/// A seed of a region: all triangles in its face get `marker`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// A point inside the region.
    pub seed: Point2,
    /// The region's marker.
    pub marker: i32,
    /// Largest wanted triangle area; `None` when the file gives none.
    pub area_max: Option<f64>,
}

/// Where an item of a domain came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line (1-based) of the file.
    Line(u64),
    /// A line (1-based) of the `.node` file beside a `.poly` file.
    NodeLine(u64),
    /// A JSON path such as `$.loops[2].vertices[5]`.
    Path(String),
    /// Made by the program (a far-field circle), or given through the library.
    Made,
}

/// Places of a domain's items; each list is empty (all [`Place::Made`]) or as long as its items.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Places {
    /// One per point.
    pub points: Vec<Place>,
    /// One per loop.
    pub loops: Vec<Place>,
    /// One per free segment.
    pub segments: Vec<Place>,
    /// One per hole point of [`Inside::Carve`].
    pub holes: Vec<Place>,
    /// One per region.
    pub regions: Vec<Place>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::NodeLine(line) => write!(f, "line {line} of the .node file"),
            Self::Path(path) => f.write_str(path),
            Self::Made => f.write_str("made by the program"),
        }
    }
}

/// A planar domain as given.
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    /// Vertices of loops and segments, and isolated points (used by neither): those must become
    /// mesh vertices when they lie inside.
    pub points: Vec<Point2>,
    /// Marker of each point; empty or as long as `points`.
    pub point_markers: Vec<i32>,
    /// Closed loops.
    pub loops: Vec<Loop>,
    /// Free segments.
    pub segments: Vec<Segment>,
    /// Which faces are meshed.
    pub inside: Inside,
    /// Region seeds.
    pub regions: Vec<Region>,
    /// Where each item stood in the file.
    pub places: Places,
}

/// The smallest rectangle with sides along the axes that holds all points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingBox {
    /// Lower left corner.
    pub min: Point2,
    /// Upper right corner.
    pub max: Point2,
}

impl BoundingBox {
    /// The box of the finite ones among `points`; `None` when there are none.
    pub fn of(points: impl IntoIterator<Item = Point2>) -> Option<Self> {
        points.into_iter().filter(|p| p.is_finite()).fold(None, |bounds, p| {
            let Self { min, max } = bounds.unwrap_or(Self { min: p, max: p });
            Some(Self {
                min: Point2::new(min.x.min(p.x), min.y.min(p.y)),
                max: Point2::new(max.x.max(p.x), max.y.max(p.y)),
            })
        })
    }
}

impl Domain {
    /// A domain with the given points and nothing else, under the even-odd rule.
    #[must_use]
    pub fn new(points: Vec<Point2>) -> Self {
        Self {
            points,
            point_markers: Vec::new(),
            loops: Vec::new(),
            segments: Vec::new(),
            inside: Inside::EvenOdd,
            regions: Vec::new(),
            places: Places::default(),
        }
    }

    /// A domain of closed rings under the even-odd rule: a ring in another one is a hole, a ring in
    /// a hole an island. The edges of ring i carry the marker i + 1. Orientation does not matter.
    ///
    /// ```
    /// use trigrade::domain::Domain;
    /// let plate = Domain::of_rings(&[
    ///     vec![[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]],
    ///     vec![[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]],
    /// ]);
    /// assert_eq!((plate.points.len(), plate.loops.len()), (8, 2));
    /// assert!(trigrade::domain::validate::validate(&plate).is_ok());
    /// ```
    #[must_use]
    pub fn of_rings<P: Copy + Into<Point2>>(rings: &[Vec<P>]) -> Self {
        let mut domain = Self::new(rings.iter().flatten().map(|&p| p.into()).collect());
        let mut first = 0;
        for (marker, ring) in (1..).zip(rings) {
            let end = first + ring.len() as u32;
            domain.loops.push(Loop::new((first..end).collect(), marker, LoopRole::Any));
            first = end;
        }
        domain
    }

    /// Box of the points that loops and segments use; of all points when they use none.
    #[must_use]
    pub fn bounding_box(&self) -> Option<BoundingBox> {
        let ends = self.edges().flatten();
        BoundingBox::of(ends.filter_map(|i| self.points.get(i as usize).copied()))
            .or_else(|| BoundingBox::of(self.points.iter().copied()))
    }

    /// End points of every loop edge, loop by loop, then of every free segment.
    pub fn edges(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let loops = self.loops.iter().flat_map(Loop::edges);
        loops.chain(self.segments.iter().map(|s| s.vertices))
    }

    /// Indices of the points that no edge uses, in rising order.
    #[must_use]
    pub fn isolated_points(&self) -> Vec<usize> {
        let mut is_used = vec![false; self.points.len()];
        for v in self.edges().flatten() {
            if let Some(used) = is_used.get_mut(v as usize) {
                *used = true;
            }
        }
        (0..is_used.len()).filter(|&v| !is_used[v]).collect()
    }
}

impl Loop {
    /// A loop whose edges all carry `marker`.
    #[must_use]
    pub fn new(vertices: Vec<u32>, marker: i32, role: LoopRole) -> Self {
        Self { markers: vec![marker; vertices.len()], vertices, role }
    }

    /// End points of the loop's edges; edge i runs from vertex i to vertex i + 1, cyclically.
    pub fn edges(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        let next = self.vertices.iter().skip(1).chain(self.vertices.first());
        self.vertices.iter().zip(next).map(|(&a, &b)| [a, b])
    }
}
