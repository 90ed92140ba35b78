//! Plain arrays from a triangulation, in little more memory than that of the larger.

use super::{FLAGS, LIVE, Triangulation, VertexId};

/// Slots that are not worth giving back on their own.
const SHARE_MIN: usize = 1 << 12;

impl Triangulation {
    /// The corners of the live triangles in slot order, each run through `number`.
    ///
    /// The slots are given back as their triangles are copied, last ones first, so that both are never
    /// there in full: where the allocator shrinks in place, as for large arrays on Linux, no more than a
    /// sixteenth of the slots is.
    #[must_use]
    pub fn into_triangles(mut self, number: impl Fn(VertexId) -> u32) -> Vec<[u32; 3]> {
        let mut triangles = vec![[0; 3]; self.live_count()];
        let share = (self.slots.len() / 16).max(SHARE_MIN);
        let mut end = triangles.len();
        while !self.slots.is_empty() {
            let kept = self.slots.len().saturating_sub(share);
            for slot in self.slots.drain(kept..).rev().filter(|s| s.words[FLAGS] & LIVE != 0) {
                end -= 1;
                let [a, b, c, ..] = slot.words;
                triangles[end] = [a, b, c].map(|v| number(VertexId(v)));
            }
            self.slots.shrink_to_fit();
        }
        triangles
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strip of triangles, every `nth` slot free.
    fn strip(count: u32, nth: u32) -> (Triangulation, Vec<[u32; 3]>) {
        let mut mesh = Triangulation::default();
        let corners = |i: u32| [i, i + 1, i + 2];
        let ids: Vec<_> = (0..count).map(|i| mesh.add(corners(i).map(VertexId))).collect();
        for &t in ids.iter().filter(|t| t.0 % nth == 1) {
            mesh.remove(t);
        }
        let kept = (0..count).filter(|i| i % nth != 1).map(corners).collect();
        (mesh, kept)
    }

    #[test]
    fn live_triangles_keep_their_order_in_shares_of_any_size() {
        for (count, nth) in [(0, 2), (1, 2), (5, 2), (4096, 3), (4097, 5), (100_000, 7)] {
            let (mesh, kept) = strip(count, nth);
            let renumbered: Vec<[u32; 3]> = kept.iter().map(|t| t.map(|v| v + 10)).collect();
            assert_eq!(mesh.into_triangles(|v| v.0 + 10), renumbered, "{count} slots");
        }
    }

    #[test]
    fn no_live_triangle_no_array() {
        let (mesh, kept) = strip(2, 1_000_000);
        assert_eq!(kept.len(), 1);
        let mut empty = mesh;
        empty.remove(crate::triangulation::TriangleId(0));
        assert!(empty.into_triangles(|_| unreachable!()).is_empty());
    }
}
