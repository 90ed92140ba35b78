//! Which front edge is the next base edge.

use crate::point::Point2;
use std::cmp::{Ordering, Reverse};
use std::collections::{BinaryHeap, VecDeque};

/// Order of the base edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// Depth from the boundary plus the edge's own length, in sixteenths of an octave, first come
    /// first served within: the front stays short and smooth.
    Depth,
    /// Shortest edge first, ties by coordinates: the classical order of the report.
    Shortest,
}

/// Queue of front edges. Closed edges stay in it until they come up; the caller skips them.
pub(super) enum Queue {
    Depth(Buckets),
    Shortest(BinaryHeap<Reverse<Shortest>>),
}

impl Queue {
    pub(super) fn new(order: Order) -> Self {
        match order {
            Order::Depth => Self::Depth(Buckets::default()),
            Order::Shortest => Self::Shortest(BinaryHeap::new()),
        }
    }

    /// The length that fills the first bucket: the shortest edge of the initial front.
    pub(super) fn set_unit(&mut self, shortest: f64) {
        if let Self::Depth(buckets) = self {
            buckets.floor = bucket_of(shortest);
        }
    }

    pub(super) fn push(&mut self, id: u32, length: f64, depth: f64, ends: [Point2; 2]) {
        match self {
            Self::Depth(buckets) => buckets.push(id, depth + length),
            Self::Shortest(heap) => heap.push(Reverse(Shortest { length, ends, id })),
        }
    }

    pub(super) fn pop(&mut self) -> Option<u32> {
        match self {
            Self::Depth(buckets) => buckets.pop(),
            Self::Shortest(heap) => heap.pop().map(|Reverse(entry)| entry.id),
        }
    }
}

/// Buckets of keys, a sixteenth of an octave each; keys below the current bucket join it.
#[derive(Default)]
pub(super) struct Buckets {
    buckets: Vec<VecDeque<u32>>,
    floor: u64,
    current: usize,
}

/// Exponent and four bits of the mantissa: monotone in the key, exact, and the same everywhere.
fn bucket_of(key: f64) -> u64 {
    key.max(0.0).to_bits() >> 48
}

impl Buckets {
    fn push(&mut self, id: u32, key: f64) {
        let index = (bucket_of(key).saturating_sub(self.floor) as usize).max(self.current);
        if index >= self.buckets.len() {
            self.buckets.resize_with(index + 1, VecDeque::new);
        }
        self.buckets[index].push_back(id);
    }

    fn pop(&mut self) -> Option<u32> {
        while let Some(bucket) = self.buckets.get_mut(self.current) {
            let first = bucket.pop_front();
            if first.is_some() {
                return first;
            }
            *bucket = VecDeque::new();
            self.current += 1;
        }
        None
    }
}

/// An entry of the shortest-first order, total by length and then coordinates.
pub(super) struct Shortest {
    length: f64,
    ends: [Point2; 2],
    id: u32,
}

impl Ord for Shortest {
    fn cmp(&self, other: &Self) -> Ordering {
        self.length
            .total_cmp(&other.length)
            .then_with(|| self.ends[0].lexicographic(other.ends[0]))
            .then_with(|| self.ends[1].lexicographic(other.ends[1]))
            .then_with(|| self.id.cmp(&other.id))
    }
}

impl PartialOrd for Shortest {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Shortest {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Shortest {}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(x: f64) -> [Point2; 2] {
        [Point2::new(x, 0.0), Point2::new(x, 1.0)]
    }

    // spec: F4
    #[test]
    fn shortest_order_is_by_length_then_coordinates_whatever_the_insertion_order() {
        for order in [[0, 1, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1]] {
            let mut queue = Queue::new(Order::Shortest);
            for id in order {
                let length = if id == 3 { 0.5 } else { 1.0 };
                queue.push(id, length, 0.0, ends(f64::from(id)));
            }
            let popped: Vec<u32> = std::iter::from_fn(|| queue.pop()).collect();
            assert_eq!(popped, [3, 0, 1, 2]);
        }
    }

    // spec: F4
    #[test]
    fn depth_order_serves_buckets_in_order_and_each_first_come_first_served() {
        let mut queue = Queue::new(Order::Depth);
        queue.set_unit(1.0);
        for (id, key) in [(0, 4.0), (1, 1.0), (2, 1.01), (3, 0.5), (4, 2.0)] {
            queue.push(id, key, 0.0, ends(0.0));
        }
        assert_eq!(queue.pop(), Some(1));
        assert_eq!(queue.pop(), Some(2));
        assert_eq!(queue.pop(), Some(3), "below the unit is the first bucket");
        assert_eq!(queue.pop(), Some(4));
        queue.push(5, 1.0, 0.0, ends(0.0));
        assert_eq!(queue.pop(), Some(5), "below the current bucket joins it");
        assert_eq!(queue.pop(), Some(0));
        assert_eq!(queue.pop(), None);
    }

    #[test]
    fn extreme_keys_need_no_more_than_the_exponents_there_are() {
        let mut queue = Queue::new(Order::Depth);
        queue.set_unit(5e-324);
        for (id, key) in [(0, f64::MAX), (1, f64::INFINITY), (2, 5e-324)] {
            queue.push(id, key, 0.0, ends(0.0));
        }
        assert_eq!([queue.pop(), queue.pop(), queue.pop()], [Some(2), Some(0), Some(1)]);
    }
}
