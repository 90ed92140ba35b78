//! Slots of a triangulation under construction by several workers at once.
//!
//! An arena is a range of the slots; disjoint ranges can be handed to different threads. Slot
//! indices are those of the whole. Triangles are written in full, and linked by raw half-edges.

use super::{ACROSS, FLAGS, HalfEdgeId, LIVE, Slot, TriangleId, Triangulation, VertexId};

/// A range of slots.
pub(crate) struct Arena<'a> {
    slots: &'a mut [Slot],
    /// Index of the first.
    base: u32,
}

impl Triangulation {
    /// `count` slots, none live, to be filled through an [`Arena`] and then
    /// [finished](Self::finish).
    pub(crate) fn unfinished(count: usize) -> Self {
        Self { slots: vec![Slot::FREE; count], free: Vec::new() }
    }

    /// All slots as an arena.
    pub(crate) fn arena(&mut self) -> Arena<'_> {
        Arena { slots: &mut self.slots, base: 0 }
    }

    /// Lists the slots that were not used, and renames the vertices.
    pub(crate) fn finish(&mut self, names: &[u32]) {
        let unused = self.slots.iter().zip(0..).filter(|(slot, _)| slot.words[FLAGS] & LIVE == 0);
        self.free = unused.map(|(_, i)| i).collect();
        self.rename(names);
    }

    /// Replaces each vertex `v` by `names[v]`; ghosts stay.
    pub(crate) fn rename(&mut self, names: &[u32]) {
        for word in self.slots.iter_mut().flat_map(|slot| &mut slot.words[..3]) {
            if let Some(&name) = names.get(*word as usize) {
                *word = name;
            }
        }
    }
}

impl Arena<'_> {
    /// The arena's part below slot `at`, and the rest.
    pub(crate) fn split_at(&mut self, at: u32) -> (Arena<'_>, Arena<'_>) {
        let (low, high) = self.slots.split_at_mut((at - self.base) as usize);
        (Arena { slots: low, base: self.base }, Arena { slots: high, base: at })
    }

    #[inline(always)]
    fn words(&self, t: u32) -> &[u32; 8] {
        &self.slots[(t - self.base) as usize].words
    }

    #[inline(always)]
    fn words_mut(&mut self, t: u32) -> &mut [u32; 8] {
        &mut self.slots[(t - self.base) as usize].words
    }

    /// Where the half-edge starts.
    #[inline(always)]
    pub(crate) fn origin(&self, e: HalfEdgeId) -> VertexId {
        VertexId(self.words(e.0 >> 2)[e.corner()])
    }

    /// What the half-edge is linked to.
    #[inline(always)]
    pub(crate) fn twin(&self, e: HalfEdgeId) -> HalfEdgeId {
        HalfEdgeId(self.words(e.0 >> 2)[ACROSS + e.corner()])
    }

    /// Makes two half-edges each other's twin.
    #[inline(always)]
    pub(crate) fn link(&mut self, e: HalfEdgeId, f: HalfEdgeId) {
        self.words_mut(e.0 >> 2)[ACROSS + e.corner()] = f.0;
        self.words_mut(f.0 >> 2)[ACROSS + f.corner()] = e.0;
    }

    /// Makes a slot the live triangle with these corners; its links stay what they were.
    #[inline(always)]
    pub(crate) fn set(&mut self, t: TriangleId, corners: [VertexId; 3]) {
        let words = self.words_mut(t.0);
        [words[0], words[1], words[2], words[FLAGS]] =
            [corners[0].0, corners[1].0, corners[2].0, LIVE];
    }

    /// Moves one corner.
    #[inline(always)]
    pub(crate) fn set_origin(&mut self, e: HalfEdgeId, v: VertexId) {
        self.words_mut(e.0 >> 2)[e.corner()] = v.0;
    }
}
