//! The status of a plane sweep: the segments that cross the sweep line, from low to high.
//!
//! A treap (Seidel, Aragon 1996) whose priorities are a fixed mixing of the segment's number, with a
//! doubly linked list through its nodes. The order is decided by the caller when it searches;
//! insertion takes the place found, so no comparison is made twice.

use std::cmp::Ordering;

/// No segment.
pub(super) const NONE: u32 = u32::MAX;

/// Links of one segment.
#[derive(Clone, Copy)]
struct Node {
    left: u32,
    right: u32,
    parent: u32,
    below: u32,
    above: u32,
}

const LOOSE: Node = Node { left: NONE, right: NONE, parent: NONE, below: NONE, above: NONE };

/// Segments by height; a segment is its number.
pub(super) struct Status {
    nodes: Vec<Node>,
    root: u32,
    lowest: u32,
}

/// Priority of a node: the finaliser of SplitMix64, truncated.
fn priority(node: u32) -> (u32, u32) {
    let mut z = u64::from(node).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    ((z >> 32) as u32, node)
}

impl Status {
    pub(super) fn new(segments: usize) -> Self {
        Self { nodes: vec![LOOSE; segments], root: NONE, lowest: NONE }
    }

    fn node(&self, segment: u32) -> Node {
        self.nodes[segment as usize]
    }

    fn node_mut(&mut self, segment: u32) -> &mut Node {
        &mut self.nodes[segment as usize]
    }

    /// The segment next below, or [`NONE`].
    pub(super) fn below(&self, segment: u32) -> u32 {
        self.node(segment).below
    }

    /// The segment next above; of [`NONE`], the lowest one.
    pub(super) fn above(&self, segment: u32) -> u32 {
        if segment == NONE { self.lowest } else { self.node(segment).above }
    }

    /// The highest segment below a point, or the segment it lies on as an error. `side` says on
    /// which side of a segment the point lies: `Greater` above.
    pub(super) fn locate(&self, side: impl Fn(u32) -> Ordering) -> Result<u32, u32> {
        let (mut below, mut current) = (NONE, self.root);
        while current != NONE {
            match side(current) {
                Ordering::Equal => return Err(current),
                Ordering::Greater => {
                    below = current;
                    current = self.node(current).right;
                }
                Ordering::Less => current = self.node(current).left,
            }
        }
        Ok(below)
    }

    /// Inserts a segment directly above another, or lowest above [`NONE`].
    pub(super) fn insert(&mut self, segment: u32, below: u32) {
        let above = self.above(below);
        self.nodes[segment as usize] = Node { below, above, ..LOOSE };
        if below == NONE {
            self.lowest = segment;
        } else {
            self.node_mut(below).above = segment;
        }
        if above != NONE {
            self.node_mut(above).below = segment;
        }
        // Of two neighbours in order one is an ancestor of the other, so one has a free link.
        if below != NONE && self.node(below).right == NONE {
            self.node_mut(below).right = segment;
            self.node_mut(segment).parent = below;
        } else if above != NONE {
            self.node_mut(above).left = segment;
            self.node_mut(segment).parent = above;
        } else {
            self.root = segment;
        }
        while self.node(segment).parent != NONE
            && priority(segment) < priority(self.node(segment).parent)
        {
            self.rotate_up(segment);
        }
    }

    /// Removes a segment.
    pub(super) fn remove(&mut self, segment: u32) {
        loop {
            let Node { left, right, .. } = self.node(segment);
            let child = match (left, right) {
                (NONE, NONE) => break,
                (NONE, child) | (child, NONE) => child,
                _ if priority(left) < priority(right) => left,
                _ => right,
            };
            self.rotate_up(child);
        }
        let Node { parent, below, above, .. } = self.node(segment);
        self.replace_child(parent, segment, NONE);
        if below == NONE {
            self.lowest = above;
        } else {
            self.node_mut(below).above = above;
        }
        if above != NONE {
            self.node_mut(above).below = below;
        }
    }

    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        if parent == NONE {
            self.root = new;
        } else if self.node(parent).left == old {
            self.node_mut(parent).left = new;
        } else {
            self.node_mut(parent).right = new;
        }
    }

    /// Lifts a node above its parent, keeping the order.
    fn rotate_up(&mut self, child: u32) {
        let parent = self.node(child).parent;
        let grandparent = self.node(parent).parent;
        let moved = if self.node(parent).left == child {
            let moved = std::mem::replace(&mut self.node_mut(child).right, parent);
            self.node_mut(parent).left = moved;
            moved
        } else {
            let moved = std::mem::replace(&mut self.node_mut(child).left, parent);
            self.node_mut(parent).right = moved;
            moved
        };
        if moved != NONE {
            self.node_mut(moved).parent = parent;
        }
        self.replace_child(grandparent, parent, child);
        self.node_mut(child).parent = grandparent;
        self.node_mut(parent).parent = child;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn listed(status: &Status) -> Vec<u32> {
        std::iter::successors(Some(status.above(NONE)), |&s| Some(status.above(s)))
            .take_while(|&s| s != NONE)
            .collect()
    }

    /// Numbers as segments, ordered by value, against a sorted vector.
    #[test]
    fn keeps_the_order_of_a_sorted_list() {
        let mut status = Status::new(500);
        let mut model: Vec<u32> = Vec::new();
        for step in 0..4000u32 {
            let value = step.wrapping_mul(2_654_435_761) % 500;
            match model.binary_search(&value) {
                Ok(at) => {
                    assert_eq!(status.locate(|s| value.cmp(&s)), Err(value));
                    status.remove(value);
                    model.remove(at);
                }
                Err(at) => {
                    let below = status.locate(|s| value.cmp(&s)).unwrap();
                    assert_eq!(below, if at == 0 { NONE } else { model[at - 1] });
                    status.insert(value, below);
                    model.insert(at, value);
                }
            }
            assert_eq!(listed(&status), model);
        }
    }
}
