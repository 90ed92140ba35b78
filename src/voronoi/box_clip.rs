//! Cells clipped to a box.
//!
//! All decisions are exact, and none is a tie: the box stands for one that is smaller by an
//! infinitesimal in x and a much smaller one in y. So a vertex on a side is outside, an edge along a
//! side too, and a bisector through a corner passes on one side of it. An edge meets the box where
//! its line does, between the side where the line enters and the one where it leaves, as far as its
//! own ends reach; each of that is the sign of a polynomial in the sites and the box.

use super::clipped::{Clipped, Corners, Piece, proper};
use super::{Edge, Voronoi};
use crate::domain::BoundingBox;
use crate::point::Point2;
use crate::predicates::{Axis, Sign, compare_circumcentre, nearer, rounded_bisector};
use std::str::FromStr;

/// A rectangle along the axes with an inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipBox {
    min: Point2,
    max: Point2,
}

/// A side of the box: the one from corner `i` to corner `i + 1`, from the lower left one on.
type SideIndex = usize;

/// Where an edge starts or ends in the box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    Vertex(u32),
    On(SideIndex),
}

impl ClipBox {
    /// The box between two corners; nothing if it is empty or not finite.
    #[must_use]
    pub fn new(min: Point2, max: Point2) -> Option<Self> {
        let is_proper = min.is_finite() && max.is_finite() && min.x < max.x && min.y < max.y;
        is_proper.then_some(Self { min, max })
    }

    /// The box of some points, larger by a tenth of its longer side on each side; around a single
    /// point that reaches one unit, or one float, further. Nothing without a finite point.
    #[must_use]
    pub fn around(points: &[Point2]) -> Option<Self> {
        let BoundingBox { min, max } = BoundingBox::of(points.iter().copied())?;
        // Halves, because the whole may overflow.
        let half = (max.x / 2.0 - min.x / 2.0).max(max.y / 2.0 - min.y / 2.0);
        let margin = if half > 0.0 { half / 5.0 } else { 1.0 };
        let below = |v: f64| (v - margin).min(v.next_down()).max(f64::MIN);
        let above = |v: f64| (v + margin).max(v.next_up()).min(f64::MAX);
        Self::new(Point2::new(below(min.x), below(min.y)), Point2::new(above(max.x), above(max.y)))
    }

    /// Lower left and upper right corner.
    #[must_use]
    pub const fn corners(self) -> [Point2; 2] {
        [self.min, self.max]
    }

    fn corner(self, i: usize) -> Point2 {
        match i % 4 {
            0 => self.min,
            1 => Point2::new(self.max.x, self.min.y),
            2 => self.max,
            _ => Point2::new(self.min.x, self.max.y),
        }
    }

    /// The line a side lies on: its axis, the value there, and whether inside is above it.
    fn line(self, side: SideIndex) -> (Axis, f64, bool) {
        match side {
            0 => (Axis::Y, self.min.y, true),
            1 => (Axis::X, self.max.x, false),
            2 => (Axis::Y, self.max.y, false),
            _ => (Axis::X, self.min.x, true),
        }
    }
}

impl FromStr for ClipBox {
    type Err = String;

    /// Reads `XMIN,YMIN,XMAX,YMAX`.
    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|s| s.trim().parse()).collect();
        let found = match numbers.as_deref() {
            Ok(&[x0, y0, x1, y1]) => Self::new(Point2::new(x0, y0), Point2::new(x1, y1)),
            _ => None,
        };
        let message = "is no box: give XMIN,YMIN,XMAX,YMAX with XMIN < XMAX and YMIN < YMAX";
        found.ok_or_else(|| format!("'{text}' {message}"))
    }
}

impl Voronoi {
    /// The cells within a box.
    ///
    /// # Guarantees
    /// V6: which cells meet the box and along which edges is decided exactly; corners are Voronoi
    /// vertices, crossings of edges with the box rounded to nearest along its sides, and the box's own
    /// corners.
    ///
    /// # Complexity
    /// Linear in the size of the tessellation, and a logarithm for its corners.
    #[must_use]
    pub fn clip_to_box(&self, bounds: ClipBox) -> Clipped {
        let clip = Clip::new(self, bounds);
        let mut corners = Numbered::of(self.vertices.len());
        let mut pieces = Vec::new();
        for site in (0..self.sites.len() as u32).filter(|&site| self.has_cell(site)) {
            let ring = clip.ring(site, &mut corners);
            pieces.extend(proper(ring).map(|ring| Piece { site, rings: vec![ring] }));
        }
        Clipped { points: corners.corners.points, pieces }
    }

    /// Each edge as far as it lies in a box, its ends rounded, with the index of the edge.
    pub(super) fn edges_in(&self, bounds: ClipBox) -> Vec<(u32, [Point2; 2])> {
        let clip = Clip::new(self, bounds);
        let edges = self.edges.iter().zip(&clip.ends).zip(0..);
        let inside = edges.filter_map(|((edge, ends), i)| Some((i, edge, (*ends)?)));
        inside.map(|(i, edge, ends)| (i, ends.map(|end| clip.place(edge, end)))).collect()
    }
}

/// Corners, with the numbers that vertices have among them once they are known.
struct Numbered {
    corners: Corners,
    of_vertex: Vec<Option<u32>>,
}

impl Numbered {
    fn of(vertices: usize) -> Self {
        Self { corners: Corners::default(), of_vertex: vec![None; vertices] }
    }

    fn vertex(&mut self, vertex: u32, at: Point2) -> u32 {
        let corners = &mut self.corners;
        *self.of_vertex[vertex as usize].get_or_insert_with(|| corners.at(at))
    }
}

struct Clip<'a> {
    voronoi: &'a Voronoi,
    bounds: ClipBox,
    /// For each edge its ends in the box, if it meets it.
    ends: Vec<Option<[End; 2]>>,
}

impl<'a> Clip<'a> {
    fn new(voronoi: &'a Voronoi, bounds: ClipBox) -> Self {
        let mut clip = Self { voronoi, bounds, ends: Vec::new() };
        clip.ends = voronoi.edges.iter().map(|edge| clip.ends_of(edge)).collect();
        clip
    }

    /// Whether a vertex lies strictly on the inner side of a side's line.
    fn is_within(&self, vertex: u32, side: SideIndex) -> bool {
        let (axis, value, is_above) = self.bounds.line(side);
        let rounded = axis.of(self.voronoi.vertices[vertex as usize]);
        // Rounding is monotone: only a coordinate that rounds to the very value needs a second look.
        let order = if rounded == value {
            let circle = self.voronoi.circles[vertex as usize];
            let sites = circle.map(|site| self.voronoi.sites[site as usize]);
            compare_circumcentre(sites, axis, value)
        } else {
            Sign::of(if rounded > value { 1.0 } else { -1.0 })
        };
        order == if is_above { Sign::Positive } else { Sign::Negative }
    }

    /// Whether a corner of the smaller box is nearer to the left site of an edge. Where the box's own
    /// corner is as near to both, the infinitesimal in x decides, then that in y.
    fn is_left(&self, edge: &Edge, corner: usize) -> bool {
        let [a, b] = edge.sites.map(|site| self.voronoi.sites[site as usize]);
        let inward = |low: bool, difference: f64| if low { difference } else { -difference };
        let from_left = corner.is_multiple_of(4) || corner % 4 == 3;
        let from_below = corner % 4 < 2;
        match nearer(self.bounds.corner(corner), a, b) {
            Sign::Zero if a.x != b.x => inward(from_left, if a.x > b.x { 1.0 } else { -1.0 }) > 0.0,
            Sign::Zero => inward(from_below, if a.y > b.y { 1.0 } else { -1.0 }) > 0.0,
            sign => sign == Sign::Positive,
        }
    }

    fn ends_of(&self, edge: &Edge) -> Option<[End; 2]> {
        let [from, to] = edge.ends;
        if let (Some(u), Some(v)) = (from, to) {
            let within = |vertex| [0, 1, 2, 3].map(|side| self.is_within(vertex, side));
            let (u_within, v_within) = (within(u), within(v));
            if u_within == [true; 4] && v_within == [true; 4] {
                return Some([End::Vertex(u), End::Vertex(v)]);
            }
            if (0..4).any(|side| !u_within[side] && !v_within[side]) {
                return None;
            }
        }
        let left = [0, 1, 2, 3].map(|corner| self.is_left(edge, corner));
        // Around the box the line is entered where the left ends, and left where it begins.
        let entry = (0..4).find(|&i| left[i] && !left[(i + 1) % 4])?;
        let exit = (0..4).find(|&i| !left[i] && left[(i + 1) % 4])?;
        let misses = from.is_some_and(|u| !self.is_within(u, exit))
            || to.is_some_and(|v| !self.is_within(v, entry));
        let end = |vertex: Option<u32>, side| match vertex.filter(|&v| self.is_within(v, side)) {
            Some(vertex) => End::Vertex(vertex),
            None => End::On(side),
        };
        (!misses).then(|| [end(from, entry), end(to, exit)])
    }

    fn place(&self, edge: &Edge, end: End) -> Point2 {
        let side = match end {
            End::Vertex(vertex) => return self.voronoi.vertices[vertex as usize],
            End::On(side) => side,
        };
        let (axis, value, _) = self.bounds.line(side);
        let [a, b] = edge.sites.map(|site| self.voronoi.sites[site as usize]);
        let other = axis.other();
        let [low, high] = [self.bounds.min, self.bounds.max].map(|p| other.of(p));
        let along = match other.of(a) == other.of(b) {
            // A bisector parallel to a side has all of it on one side, so no end is on it.
            true => low,
            false => rounded_bisector(a, b, axis, value).clamp(low, high),
        };
        match axis {
            Axis::X => Point2::new(value, along),
            Axis::Y => Point2::new(along, value),
        }
    }

    /// The corners of a cell's part in the box, counterclockwise.
    fn ring(&self, site: u32, numbered: &mut Numbered) -> Vec<u32> {
        let sides: Vec<(&Edge, [End; 2])> = self
            .voronoi
            .cell(site)
            .filter_map(|side| {
                let edge = &self.voronoi.edges[side.edge as usize];
                let [from, to] = self.ends[side.edge as usize]?;
                Some((edge, if edge.sites[0] == site { [from, to] } else { [to, from] }))
            })
            .collect();
        let mut ring = Vec::new();
        if sides.is_empty() && self.owns_box(site) {
            ring.extend((0..4).map(|i| numbered.corners.at(self.bounds.corner(i))));
        }
        for (i, &(edge, [from, to])) in sides.iter().enumerate() {
            let place = self.place(edge, from);
            ring.push(match from {
                End::Vertex(vertex) => numbered.vertex(vertex, place),
                End::On(_) => numbered.corners.at(place),
            });
            // A vertex is where the next side starts.
            let End::On(leaves) = to else { continue };
            let corners = &mut numbered.corners;
            ring.push(corners.at(self.place(edge, to)));
            let End::On(enters) = sides[(i + 1) % sides.len()].1[0] else { continue };
            // A lone edge cuts off what lies on its left, all around.
            let mut side = leaves;
            while side != enters {
                side = (side + 1) % 4;
                ring.push(corners.at(self.bounds.corner(side)));
            }
        }
        ring
    }

    /// Whether a cell without an edge in the box holds all of it.
    fn owns_box(&self, site: u32) -> bool {
        self.voronoi.cell(site).all(|side| {
            let edge = &self.voronoi.edges[side.edge as usize];
            self.is_left(edge, 0) == (edge.sites[0] == site)
        })
    }
}
