//! Triangles waiting to be mended, in buckets.
//!
//! A bucket is a stack: what was made last is mended first, so that work stays in one place and in
//! the cache. Between buckets the more urgent goes first. An entry is a slot, not a triangle: when
//! its turn comes the slot may hold another triangle, which is then judged anew.

use crate::triangulation::TriangleId;

/// How urgent a flaw is; higher goes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Urgency(u16);

/// Binades of a float: one bucket each for areas, two for lengths.
const BINADES: u16 = 2048;

impl Urgency {
    /// Number of different urgencies.
    const COUNT: usize = 2 * BINADES as usize + 1;

    /// Of an area that is `ratio` times what is allowed: the larger, the more urgent; but the last
    /// [`TOGETHER`] binades are one bucket, so that a place is finished before the next is begun
    /// and neighbours lie beside each other in memory.
    #[inline]
    pub(super) fn of_area(ratio: f64) -> Self {
        Self(binade(ratio).max(ONE + TOGETHER))
    }

    /// Of a small angle, by the square of the shortest edge: the shorter, the more urgent, and all
    /// of them before any area. Off-centres grow from the small to the large (Üngör, 4).
    #[inline]
    pub(super) fn of_angle(shortest_sq: f64) -> Self {
        Self(2 * BINADES - binade(shortest_sq))
    }
}

/// The binade of 1.
const ONE: u16 = 1023;
/// Binades of ratios of areas that share a bucket.
const TOGETHER: u16 = 10;

/// Exponent of a float that is not negative.
#[inline]
fn binade(x: f64) -> u16 {
    (x.to_bits() >> 52) as u16 & (BINADES - 1)
}

/// The queue.
pub(super) struct Queue {
    buckets: Vec<Vec<u32>>,
    /// No bucket above this one has an entry.
    top: usize,
}

impl Default for Queue {
    fn default() -> Self {
        Self { buckets: vec![Vec::new(); Urgency::COUNT], top: 0 }
    }
}

impl Queue {
    #[inline]
    pub(super) fn push(&mut self, t: TriangleId, urgency: Urgency) {
        let bucket = urgency.0 as usize;
        self.buckets[bucket].push(t.0);
        self.top = self.top.max(bucket);
    }

    #[inline]
    pub(super) fn pop(&mut self) -> Option<TriangleId> {
        loop {
            match self.buckets[self.top].pop() {
                Some(t) => return Some(TriangleId(t)),
                None if self.top == 0 => return None,
                None => self.top -= 1,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_edges_go_before_long_ones_and_angles_before_areas() {
        let mut queue = Queue::default();
        let urgencies = [
            Urgency::of_area(1500.0),
            Urgency::of_angle(4.0),
            Urgency::of_area(10000.0),
            Urgency::of_angle(0.1),
            Urgency::of_area(f64::INFINITY),
            Urgency::of_angle(0.0),
        ];
        for (urgency, i) in urgencies.into_iter().zip(0..) {
            queue.push(TriangleId(i), urgency);
        }
        let order: Vec<u32> = std::iter::from_fn(|| queue.pop()).map(|t| t.0).collect();
        assert_eq!(order, [5, 3, 1, 4, 2, 0]);
        assert_eq!(queue.pop(), None);
    }

    #[test]
    fn within_a_bucket_the_last_goes_first() {
        let mut queue = Queue::default();
        for i in 0..5 {
            queue.push(TriangleId(i), Urgency::of_area(1.0 + 0.1 * f64::from(i)));
        }
        let order: Vec<u32> = std::iter::from_fn(|| queue.pop()).map(|t| t.0).collect();
        assert_eq!(order, [4, 3, 2, 1, 0]);
    }
}
