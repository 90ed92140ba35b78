//! What is left of a tessellation in a box or a domain: polygons that share their corners.

use crate::point::Point2;
use std::collections::BTreeMap;

/// A connected piece of a cell.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Piece {
    /// The site, an index into the points given.
    pub site: u32,
    /// Polygons through [`Clipped::points`]: the outer one counterclockwise, then holes clockwise.
    pub rings: Vec<Vec<u32>>,
}

/// The cells of a tessellation within a box or a domain.
///
/// Pieces share corners, not only places: a corner on two pieces has one index, so the pieces cover
/// without gap or overlap and their exact areas add up to that of the whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clipped {
    /// Corners, all different.
    pub points: Vec<Point2>,
    /// Pieces by site; in a box each cell that meets it has one.
    pub pieces: Vec<Piece>,
}

impl Clipped {
    /// Area of a piece, rounded; it ranks, never decides.
    #[must_use]
    pub fn area(&self, piece: &Piece) -> f64 {
        piece.rings.iter().map(|ring| self.ring_area(ring)).sum()
    }

    fn ring_area(&self, ring: &[u32]) -> f64 {
        let at = |i: usize| self.points[ring[i % ring.len()] as usize];
        let Some(&first) = ring.first() else { return 0.0 };
        let origin = self.points[first as usize];
        let cross = |i: usize| {
            let (p, q) = (at(i), at(i + 1));
            (p.x - origin.x) * (q.y - origin.y) - (p.y - origin.y) * (q.x - origin.x)
        };
        (0..ring.len()).map(cross).sum::<f64>() / 2.0
    }
}

/// Corners under construction: each place once.
#[derive(Debug, Default)]
pub(super) struct Corners {
    pub(super) points: Vec<Point2>,
    known: BTreeMap<[u64; 2], u32>,
}

impl Corners {
    /// The index of the corner at a place.
    pub(super) fn at(&mut self, p: Point2) -> u32 {
        let points = &mut self.points;
        *self.known.entry(p.key()).or_insert_with(|| {
            points.push(p);
            points.len() as u32 - 1
        })
    }
}

/// A ring without corners that follow themselves; nothing if fewer than three are left.
pub(super) fn proper(mut ring: Vec<u32>) -> Option<Vec<u32>> {
    ring.dedup();
    while ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    (ring.len() > 2).then_some(ring)
}
