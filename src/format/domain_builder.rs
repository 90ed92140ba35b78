//! Puts a domain together for the readers, item by item with its place.

use crate::domain::{Domain, Loop, LoopRole, Place, Segment};
use crate::point::Point2;
use std::collections::BTreeMap;

/// A domain under construction.
#[derive(Debug)]
pub(super) struct Builder {
    pub domain: Domain,
    /// The first point with these coordinates that a loop or segment uses.
    shared: BTreeMap<[u64; 2], u32>,
}

impl Builder {
    pub fn new() -> Self {
        Self { domain: Domain::new(Vec::new()), shared: BTreeMap::new() }
    }

    /// A point of its own.
    pub fn point(&mut self, at: Point2, place: Place) -> u32 {
        let index = self.domain.points.len() as u32;
        self.domain.points.push(at);
        self.domain.places.points.push(place);
        index
    }

    /// A point that later segments with an end at these coordinates share.
    pub fn loop_point(&mut self, at: Point2, place: Place) -> u32 {
        let index = self.point(at, place);
        self.share(index);
        index
    }

    /// Lets later segments with an end at the coordinates of this point share it.
    pub fn share(&mut self, index: u32) {
        self.shared.entry(self.domain.points[index as usize].key()).or_insert(index);
    }

    /// The end of a segment given by coordinates: an earlier point of a loop or segment, or a new one.
    pub fn segment_point(&mut self, at: Point2, place: impl FnOnce() -> Place) -> u32 {
        match self.shared.get(&at.key()) {
            Some(&index) => index,
            None => self.loop_point(at, place()),
        }
    }

    /// A ring given by coordinates. A closing point that repeats the first one is dropped. The
    /// marker of the edges is the loop's number, counted from 1.
    pub fn ring(&mut self, mut ring: Vec<(Point2, Place)>, role: LoopRole, place: Place) -> usize {
        open_ring(&mut ring);
        let vertices = ring.into_iter().map(|(at, place)| self.loop_point(at, place)).collect();
        let index = self.domain.loops.len();
        self.add_loop(Loop::new(vertices, default_marker(index), role), place);
        index
    }

    /// A loop.
    pub fn add_loop(&mut self, of: Loop, place: Place) {
        self.domain.loops.push(of);
        self.domain.places.loops.push(place);
    }

    /// A free segment.
    pub fn segment(&mut self, vertices: [u32; 2], marker: i32, place: Place) {
        self.domain.segments.push(Segment { vertices, marker });
        self.domain.places.segments.push(place);
    }
}

/// The marker of a loop that the file gives none: its number, counted from 1.
pub(super) fn default_marker(index: usize) -> i32 {
    i32::try_from(index + 1).unwrap_or(i32::MAX)
}

/// Drops the last point of a ring if it repeats the first.
pub(super) fn open_ring(ring: &mut Vec<(Point2, Place)>) {
    if let [(first, _), .., (last, _)] = &ring[..]
        && first.key() == last.key()
    {
        ring.pop();
    }
}
