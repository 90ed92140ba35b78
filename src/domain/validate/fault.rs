//! What can be wrong with a domain: one variant for each violable rule of SPEC 3, with the places,
//! indices and coordinates a user needs to find it.

use crate::domain::{Domain, Place};
use crate::point::Point2;
use std::fmt;

/// A point of a domain, as a fault names it.
#[derive(Clone, Debug, PartialEq)]
pub struct VertexRef {
    /// Index into [`Domain::points`].
    pub index: u32,
    /// Its coordinates.
    pub at: Point2,
    /// Where it stands in the file.
    pub place: Place,
}

/// A loop of a domain, as a fault names it.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopRef {
    /// Index into [`Domain::loops`].
    pub index: usize,
    /// The loop's first vertex, when it has one that exists.
    pub first: Option<Point2>,
    /// Where it stands in the file.
    pub place: Place,
}

/// The loop or list of segments an edge belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Owner {
    /// The edge from vertex `edge` to the next one of a loop.
    Loop {
        /// Index into [`Domain::loops`].
        index: usize,
        /// Index into the loop's vertices of the edge's start.
        edge: usize,
    },
    /// A free segment: index into [`Domain::segments`].
    Segment(usize),
}

/// An edge of a loop or a free segment, as a fault names it.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeRef {
    /// Where it belongs.
    pub owner: Owner,
    /// Its ends, in the given direction.
    pub ends: [VertexRef; 2],
    /// Where it stands in the file: its own place, else that of its start.
    pub place: Place,
}

/// What a seed is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeedKind {
    /// A hole point of [`Inside::Carve`](crate::domain::Inside::Carve).
    Hole,
    /// The seed of a region.
    Region,
}

/// A hole point or region seed, as a fault names it.
#[derive(Clone, Debug, PartialEq)]
pub struct SeedRef {
    /// What it is for.
    pub kind: SeedKind,
    /// Index into the hole points or [`Domain::regions`].
    pub index: usize,
    /// Its coordinates.
    pub at: Point2,
    /// Where it stands in the file.
    pub place: Place,
}

/// Something of a domain that names points or loops by index.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// D1: a loop or segment names a point that the domain does not have.
    NoSuchPoint {
        /// The loop vertex or segment.
        owner: Owner,
        /// The index that names nothing.
        value: u32,
        /// How many points there are.
        count: usize,
        /// Where the loop or segment stands.
        place: Place,
    },
    /// D2: a coordinate is NaN or infinite.
    NotFinite {
        /// The point.
        vertex: VertexRef,
    },
    /// D2: a coordinate of a seed is NaN or infinite.
    SeedNotFinite {
        /// The seed.
        seed: SeedRef,
    },
    /// D3: a loop has fewer than three different points.
    TooFewPoints {
        /// The loop.
        of: LoopRef,
        /// How many different points follow each other in it.
        distinct: usize,
    },
    /// D4: two consecutive points of a loop, or the ends of a segment, are equal.
    EqualNeighbours {
        /// The edge without length.
        edge: EdgeRef,
    },
    /// D5: two points of the domain that do not both belong to loops are equal.
    DuplicatePoint {
        /// The point listed first, and the one that repeats it.
        vertices: [VertexRef; 2],
    },
    /// D6: a loop turns back on itself at a vertex.
    Spike {
        /// The loop.
        of: LoopRef,
        /// The tip.
        tip: VertexRef,
    },
    /// D7: all points of a loop lie on one line.
    ZeroArea {
        /// The loop.
        of: LoopRef,
        /// How many vertices it has.
        vertices: usize,
    },
    /// D8: the interiors of two edges cross.
    Crossing {
        /// The edges.
        edges: Box<[EdgeRef; 2]>,
        /// Where, rounded.
        near: Point2,
    },
    /// D8: two loops, or two passes of one loop, cross at a vertex.
    CrossingAtVertex {
        /// The vertex.
        vertex: VertexRef,
        /// The edges on which the two passes leave the vertex.
        edges: Box<[EdgeRef; 2]>,
    },
    /// D9: two edges share more than a point.
    Overlap {
        /// The edges.
        edges: Box<[EdgeRef; 2]>,
        /// Ends of the shared stretch.
        shared: [Point2; 2],
    },
    /// D10: a hole does not lie inside the loop it claims to be a hole of.
    HoleOutside {
        /// The hole.
        hole: LoopRef,
        /// The loop it claims.
        outer: LoopRef,
    },
    /// D11: a hole lies inside a further loop that lies inside the loop it claims.
    HoleInsideOther {
        /// The hole.
        hole: LoopRef,
        /// The loop it claims.
        outer: LoopRef,
        /// The innermost loop around it.
        around: LoopRef,
    },
    /// D12: an outer loop lies inside another one without a hole between them.
    OuterInsideOuter {
        /// The inner one.
        inner: LoopRef,
        /// The innermost loop around it.
        around: LoopRef,
    },
    /// D13: a loop claims to be a hole of something that cannot have holes.
    NotAnOuterLoop {
        /// The loop with the claim.
        hole: LoopRef,
        /// The index it claims: itself, a hole, or no loop at all.
        claimed: usize,
    },
    /// D14: a hole point lies where nothing is to be carved, or a region seed outside the domain.
    SeedOutside {
        /// The seed.
        seed: SeedRef,
    },
    /// D14: a seed lies on an edge or vertex, so that it names no face.
    SeedOnBoundary {
        /// The seed.
        seed: SeedRef,
    },
    /// D15: no face is inside.
    Empty {
        /// What of the file there is to point at.
        place: Place,
    },
    /// D1: a list of markers is not as long as the list it belongs to.
    MarkerCount {
        /// The loop, or `None` for [`Domain::point_markers`].
        of: Option<LoopRef>,
        /// How many markers there are.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// D16: the search for crossings and overlaps stopped after so many that more may exist.
    ListStopped {
        /// How many crossings and overlaps are listed.
        listed: usize,
    },
}

impl Fault {
    /// The id of the broken rule in SPEC 3.
    #[must_use]
    pub fn id(&self) -> &'static str {
        match self {
            Self::NoSuchPoint { .. } | Self::MarkerCount { .. } => "D1",
            Self::NotFinite { .. } | Self::SeedNotFinite { .. } => "D2",
            Self::TooFewPoints { .. } => "D3",
            Self::EqualNeighbours { .. } => "D4",
            Self::DuplicatePoint { .. } => "D5",
            Self::Spike { .. } => "D6",
            Self::ZeroArea { .. } => "D7",
            Self::Crossing { .. } | Self::CrossingAtVertex { .. } => "D8",
            Self::Overlap { .. } => "D9",
            Self::HoleOutside { .. } => "D10",
            Self::HoleInsideOther { .. } => "D11",
            Self::OuterInsideOuter { .. } => "D12",
            Self::NotAnOuterLoop { .. } => "D13",
            Self::SeedOutside { .. } | Self::SeedOnBoundary { .. } => "D14",
            Self::Empty { .. } => "D15",
            Self::ListStopped { .. } => "D16",
        }
    }

    /// Where the fault shows in the file, most telling place first; never empty.
    #[must_use]
    pub fn places(&self) -> Vec<&Place> {
        match self {
            Self::NoSuchPoint { place, .. } | Self::Empty { place } => vec![place],
            Self::NotFinite { vertex } => vec![&vertex.place],
            Self::SeedNotFinite { seed }
            | Self::SeedOutside { seed }
            | Self::SeedOnBoundary { seed } => vec![&seed.place],
            Self::TooFewPoints { of, .. } | Self::ZeroArea { of, .. } => vec![&of.place],
            Self::MarkerCount { of: Some(of), .. } => vec![&of.place],
            Self::MarkerCount { .. } | Self::ListStopped { .. } => vec![&Place::Made],
            Self::EqualNeighbours { edge } => vec![&edge.place],
            Self::DuplicatePoint { vertices: [a, b] } => vec![&b.place, &a.place],
            Self::Spike { tip, of } => vec![&tip.place, &of.place],
            Self::Crossing { edges, .. } | Self::Overlap { edges, .. } => {
                edges.iter().map(|edge| &edge.place).collect()
            }
            Self::CrossingAtVertex { vertex, edges } => {
                vec![&vertex.place, &edges[0].place, &edges[1].place]
            }
            Self::HoleOutside { hole, outer } => vec![&hole.place, &outer.place],
            Self::HoleInsideOther { hole, around, outer } => {
                vec![&hole.place, &around.place, &outer.place]
            }
            Self::OuterInsideOuter { inner, around } => vec![&inner.place, &around.place],
            Self::NotAnOuterLoop { hole, .. } => vec![&hole.place],
        }
    }

    /// Coordinates to look at, most telling first; empty when the fault has none.
    #[must_use]
    pub fn coordinates(&self) -> Vec<Point2> {
        match self {
            Self::NotFinite { vertex } | Self::CrossingAtVertex { vertex, .. } => vec![vertex.at],
            Self::SeedNotFinite { seed }
            | Self::SeedOutside { seed }
            | Self::SeedOnBoundary { seed } => vec![seed.at],
            Self::TooFewPoints { of, .. } | Self::ZeroArea { of, .. } => {
                of.first.into_iter().collect()
            }
            Self::EqualNeighbours { edge } => edge.ends.iter().map(|v| v.at).collect(),
            Self::DuplicatePoint { vertices } => vertices.iter().map(|v| v.at).collect(),
            Self::Spike { tip, .. } => vec![tip.at],
            Self::Crossing { near, .. } => vec![*near],
            Self::Overlap { shared, .. } => shared.to_vec(),
            Self::HoleOutside { hole: inner, .. }
            | Self::HoleInsideOther { hole: inner, .. }
            | Self::NotAnOuterLoop { hole: inner, .. }
            | Self::OuterInsideOuter { inner, .. } => inner.first.into_iter().collect(),
            Self::NoSuchPoint { .. }
            | Self::Empty { .. }
            | Self::MarkerCount { .. }
            | Self::ListStopped { .. } => Vec::new(),
        }
    }
}

impl fmt::Display for VertexRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "point {} {}{}", self.index, self.at, At(&self.place))
    }
}

impl fmt::Display for LoopRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "loop {}{}", self.index, At(&self.place))
    }
}

impl fmt::Display for Owner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Loop { index, edge } => write!(f, "edge {edge} of loop {index}"),
            Self::Segment(index) => write!(f, "segment {index}"),
        }
    }
}

impl fmt::Display for EdgeRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [a, b] = &self.ends;
        write!(f, "{} from {} to {}{}", self.owner, a.at, b.at, At(&self.place))
    }
}

impl fmt::Display for SeedRef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.kind {
            SeedKind::Hole => "hole point",
            SeedKind::Region => "seed of region",
        };
        write!(f, "{what} {} {}{}", self.index, self.at, At(&self.place))
    }
}

/// A place in brackets after an item's name; nothing for items that no file gave.
struct At<'a>(&'a Place);

impl fmt::Display for At<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Place::Made => Ok(()),
            place => write!(f, " [{place}]"),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchPoint { owner, value, count, place } => write!(
                f,
                "{owner}{} names point {value}, but there are {count} points, numbered from 0",
                At(place)
            ),
            Self::NotFinite { vertex } => write!(f, "{vertex} is not finite"),
            Self::SeedNotFinite { seed } => write!(f, "{seed} is not finite"),
            Self::TooFewPoints { of, distinct } => {
                write!(f, "{of} has {distinct} different points; a loop needs at least 3")
            }
            Self::EqualNeighbours { edge } => {
                write!(
                    f,
                    "{edge} has equal end points (points {} and {})",
                    edge.ends[0].index, edge.ends[1].index
                )
            }
            Self::DuplicatePoint { vertices: [a, b] } => write!(f, "{b} repeats {a}"),
            Self::Spike { of, tip } => write!(f, "{of} turns back on itself at {tip}"),
            Self::ZeroArea { of, vertices } => {
                write!(f, "{of} has no area: its {vertices} vertices lie on one line")
            }
            Self::Crossing { edges, near } => {
                write!(f, "{} crosses {} near {near}", edges[0], edges[1])
            }
            Self::CrossingAtVertex { vertex, edges } => {
                write!(
                    f,
                    "the pass through {vertex} along {} crosses the one along {}",
                    edges[0], edges[1]
                )
            }
            Self::Overlap { edges, shared: [a, b] } => {
                write!(f, "{} overlaps {} from {a} to {b}", edges[0], edges[1])
            }
            Self::HoleOutside { hole, outer } => {
                write!(f, "{hole} claims to be a hole of {outer}, but does not lie inside it")
            }
            Self::HoleInsideOther { hole, outer, around } => write!(
                f,
                "{hole} claims to be a hole of {outer}, but lies inside {around}, which lies inside that"
            ),
            Self::OuterInsideOuter { inner, around } => {
                write!(f, "{inner} claims to be an outer boundary, but lies inside {around}")
            }
            Self::NotAnOuterLoop { hole, claimed } => {
                write!(f, "{hole} claims to be a hole of loop {claimed}, which is no outer loop")
            }
            Self::SeedOutside { seed } if seed.kind == SeedKind::Hole => {
                write!(f, "{seed} carves nothing: it already lies outside")
            }
            Self::SeedOutside { seed } => write!(f, "{seed} lies outside the domain"),
            Self::SeedOnBoundary { seed } => {
                write!(f, "{seed} lies on an edge or vertex, so it names no face")
            }
            Self::Empty { .. } => f.write_str("the domain is empty: its boundary encloses nothing"),
            Self::MarkerCount { of, found, expected } => {
                match of {
                    Some(of) => write!(f, "{of}")?,
                    None => f.write_str("the list of point markers")?,
                }
                write!(f, " has {found} markers, but needs {expected}")
            }
            Self::ListStopped { listed } => write!(
                f,
                "the list of crossings and overlaps stops here, after {listed}; there may be more"
            ),
        }
    }
}

/// What faults need of a domain: its items under the names users know them by.
pub(super) trait Name {
    fn vertex_ref(&self, index: u32) -> VertexRef;
    fn loop_ref(&self, index: usize) -> LoopRef;
    fn edge_ref(&self, owner: Owner) -> EdgeRef;
    fn owner_place(&self, owner: Owner) -> Place;
}

fn place(places: &[Place], index: usize) -> Place {
    places.get(index).cloned().unwrap_or(Place::Made)
}

impl Name for Domain {
    fn vertex_ref(&self, index: u32) -> VertexRef {
        VertexRef {
            index,
            at: self.points[index as usize],
            place: place(&self.places.points, index as usize),
        }
    }

    fn loop_ref(&self, index: usize) -> LoopRef {
        let vertices = self.loops.get(index).map_or(&[][..], |l| &l.vertices);
        LoopRef {
            index,
            first: vertices.first().and_then(|&v| self.points.get(v as usize).copied()),
            place: place(&self.places.loops, index),
        }
    }

    /// REQUIRES: the owner and its points exist.
    fn edge_ref(&self, owner: Owner) -> EdgeRef {
        let ends = match owner {
            Owner::Loop { index, edge } => {
                let vertices = &self.loops[index].vertices;
                [vertices[edge], vertices[(edge + 1) % vertices.len()]]
            }
            Owner::Segment(index) => self.segments[index].vertices,
        };
        EdgeRef {
            owner,
            ends: ends.map(|v| self.vertex_ref(v)),
            place: match owner {
                Owner::Loop { .. } => place(&self.places.points, ends[0] as usize),
                Owner::Segment(_) => self.owner_place(owner),
            },
        }
    }

    fn owner_place(&self, owner: Owner) -> Place {
        match owner {
            Owner::Loop { index, .. } => place(&self.places.loops, index),
            Owner::Segment(index) => place(&self.places.segments, index),
        }
    }
}
