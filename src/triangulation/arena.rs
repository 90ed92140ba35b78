//! Slots of a triangulation under construction by several workers at once.
//!
//! An arena is a range of the slots; disjoint ranges can be handed to different threads. Slot
//! indices are those of the whole. Triangles are written in full, and linked by raw half-edges.

use super::{
    ACROSS, FLAGS, GHOST, HalfEdgeId, LIVE, MARK, Slot, TriangleId, Triangulation, VertexId,
};

/// A range of slots.
pub(crate) struct Arena<'a> {
    slots: &'a mut [Slot],
    /// Index of the first.
    base: u32,
}

impl Triangulation {
    /// Two slots for each of the names, none live, to be filled through an [`Arena`] and then
    /// [finished](Self::finish). The names wait in the scratch words, so that they cost nothing.
    pub(crate) fn unfinished(names: Vec<u32>) -> Self {
        let mut slots = vec![Slot::FREE; 2 * names.len()];
        for (slot, name) in slots.iter_mut().step_by(2).zip(names) {
            slot.words[MARK] = name;
        }
        Self { slots, free: Vec::new() }
    }

    /// The names that wait in the scratch words.
    pub(crate) fn names(&self) -> impl ExactSizeIterator<Item = u32> + '_ {
        self.slots.iter().step_by(2).map(|slot| slot.words[MARK])
    }

    /// All slots as an arena.
    pub(crate) fn arena(&mut self) -> Arena<'_> {
        Arena { slots: &mut self.slots, base: 0 }
    }

    /// Replaces each vertex by its name, and lists the slots that were not used.
    pub(crate) fn finish(&mut self) {
        for i in 0..self.slots.len() {
            let mut words = self.slots[i].words;
            for word in &mut words[..3] {
                if *word != GHOST.0 {
                    *word = self.slots[2 * *word as usize].words[MARK];
                }
            }
            [self.slots[i].words[0], self.slots[i].words[1], self.slots[i].words[2]] =
                [words[0], words[1], words[2]];
            if words[FLAGS] & LIVE == 0 {
                self.free.push(i as u32);
            }
        }
        for slot in self.slots.iter_mut().step_by(2) {
            slot.words[MARK] = 0;
        }
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
