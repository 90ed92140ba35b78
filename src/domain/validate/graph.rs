//! The domain as a graph on distinct points: what the sweep works on.
//!
//! Vertices are *ranks*: positions in the lexicographic order of the distinct finite points. So the
//! question which end of an edge the sweep meets first is a comparison of integers.

use super::fault::Owner;
use crate::domain::Domain;
use crate::point::Point2;

/// Stands for "no vertex", "no piece".
pub(super) const NONE: u32 = u32::MAX;

/// An edge between two different points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// Ranks of its ends, in the given direction.
    pub ends: [u32; 2],
    /// The loop edge or segment it is.
    pub owner: Owner,
}

impl Edge {
    /// The end the sweep meets first.
    pub fn left(&self) -> u32 {
        self.ends[0].min(self.ends[1])
    }

    /// The end the sweep meets last.
    pub fn right(&self) -> u32 {
        self.ends[0].max(self.ends[1])
    }
}

/// Distinct finite points in lexicographic order, and the rank of each point of the domain.
#[derive(Debug)]
pub(super) struct Ranks {
    /// Distinct points by rank.
    pub points: Vec<Point2>,
    /// Rank of each point of the domain, [`NONE`] where it is not finite.
    pub rank_of: Vec<u32>,
    /// Pairs of domain indices of equal points: the first of its equals, and a later one.
    pub equal: Vec<[u32; 2]>,
}

impl Ranks {
    /// Sorts the points of a domain; O(n log n).
    pub fn new(domain: &Domain) -> Self {
        let finite = domain.points.iter().enumerate().filter(|(_, p)| p.is_finite());
        let mut sorted: Vec<(Point2, u32)> = finite.map(|(i, &p)| (p, i as u32)).collect();
        sorted.sort_unstable_by(|(p, i), (q, j)| p.lexicographic(*q).then(i.cmp(j)));
        let mut ranks = Self {
            points: Vec::new(),
            rank_of: vec![NONE; domain.points.len()],
            equal: Vec::new(),
        };
        let mut first = 0;
        for (point, index) in sorted {
            if ranks.points.last().is_some_and(|p| p.key() == point.key()) {
                ranks.equal.push([first, index]);
            } else {
                ranks.points.push(point);
                first = index;
            }
            ranks.rank_of[index as usize] = ranks.points.len() as u32 - 1;
        }
        ranks
    }
}
