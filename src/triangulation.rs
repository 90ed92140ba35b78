//! The one triangulation structure of the house: flat half-edge arrays, topology only.
//!
//! Used for the background mesh, for the Delaunay engines and for the open region of the front. It
//! knows no coordinates: whoever asks a geometric question passes the points in.
//!
//! A triangle owns one 32-byte slot; slot `t` holds the half-edges `4t`, `4t + 1`, `4t + 2`. The
//! stride is four and not three so that the triangle of a half-edge is a shift, and the spare words of
//! the slot hold its flags. Slots are aligned as any allocation is and not to half a cache line, which
//! measures the same: so large arrays grow and shrink in place.
//!
//! ```text
//!            origin(e2)
//!               /\            next(e0) = e1, prev(e0) = e2
//!          e2  /  \  e1       apex(e0) = origin(e2)
//!             /    \          the triangle is on the left of its half-edges
//!   origin(e0)--e0--origin(e1)
//! ```

mod append;
pub(crate) mod arena;
pub mod constrain;
pub(crate) mod fan;
pub mod locate;
mod plain;
mod split;
mod star;
pub mod verify;

use std::fmt;

/// Index of a vertex in the point array that belongs to the triangulation.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct VertexId(pub u32);

/// Index of a half-edge: `4 * triangle + corner`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct HalfEdgeId(pub u32);

/// Index of a triangle slot.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TriangleId(pub u32);

/// The vertex at infinity. A triangle that has it is a ghost: it stands for the outside of the
/// hull edge opposite, so that every edge of a Delaunay triangulation has two sides.
pub const GHOST: VertexId = VertexId(u32::MAX);

/// Largest number of triangle slots: half-edges must fit 31 bits, the top bit tags a border.
pub const TRIANGLES_MAX: usize = 1 << 29;

const BORDER_BIT: u32 = 1 << 31;

/// What lies across a half-edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Across {
    /// The opposite half-edge of the neighbouring triangle.
    Twin(HalfEdgeId),
    /// Nothing: the edge is the border of the triangulated region. The value is its owner's (the
    /// front keeps the index of its edge there), below 2^31.
    Border(u32),
}

/// One slot: three half-edges and the flags, as eight words, so that half-edge `e` finds its origin
/// in word `e & 3` and its twin in word `4 + (e & 3)` without a bounds check.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
struct Slot {
    words: [u32; 8],
}

/// Word of the flags. Bits 0..3: constrained half-edges. Bit 3: slot is live. The rest belongs to
/// the user (`tag`).
const FLAGS: usize = 3;
/// First word of what lies across; bit 31 marks a border.
const ACROSS: usize = 4;
/// Scratch word for searches; see [`Triangulation::mark`].
const MARK: usize = 7;

const LIVE: u32 = 1 << 3;
const TAG_SHIFT: u32 = 4;

/// Flat half-edge triangulation with recycled slots.
#[derive(Clone, Debug, Default)]
pub struct Triangulation {
    slots: Vec<Slot>,
    free: Vec<u32>,
}

/// The corners after 0, 1, 2, two bits each from the lowest; and those before.
const NEXT: u32 = 0b00_10_01;
const PREV: u32 = 0b01_00_10;

/// The corner after or before that of a half-edge: the compiler sees that it is in the same slot.
#[inline(always)]
const fn turned(corners: u32, e: HalfEdgeId) -> usize {
    (corners >> (2 * (e.0 & 3)) & 3) as usize
}

impl Slot {
    /// Nothing: not live.
    const FREE: Self = Self { words: [0; 8] };

    const fn new([a, b, c]: [VertexId; 3]) -> Self {
        Self { words: [a.0, b.0, c.0, LIVE, BORDER_BIT, BORDER_BIT, BORDER_BIT, 0] }
    }
}

impl VertexId {
    /// As an array index.
    #[inline]
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

impl TriangleId {
    /// As an array index.
    #[inline]
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// The triangle's half-edge from corner `corner` (0, 1 or 2) to the next.
    #[inline]
    #[must_use]
    pub const fn half_edge(self, corner: u32) -> HalfEdgeId {
        HalfEdgeId(4 * self.0 + corner)
    }

    /// The triangle's three half-edges.
    #[inline]
    #[must_use]
    pub const fn half_edges(self) -> [HalfEdgeId; 3] {
        [self.half_edge(0), self.half_edge(1), self.half_edge(2)]
    }
}

impl HalfEdgeId {
    /// The triangle on the left.
    #[inline]
    #[must_use]
    pub const fn triangle(self) -> TriangleId {
        TriangleId(self.0 >> 2)
    }

    /// Position in its triangle: 0, 1 or 2.
    #[inline]
    #[must_use]
    pub const fn corner(self) -> usize {
        (self.0 & 3) as usize
    }

    /// The next half-edge counterclockwise around the triangle.
    #[inline]
    #[must_use]
    pub const fn next(self) -> Self {
        Self(if self.0 & 3 == 2 { self.0 - 2 } else { self.0 + 1 })
    }

    /// The previous half-edge around the triangle.
    #[inline]
    #[must_use]
    pub const fn prev(self) -> Self {
        Self(if self.0 & 3 == 0 { self.0 + 2 } else { self.0 - 1 })
    }
}

impl Triangulation {
    /// An empty triangulation with room for `triangles` slots.
    #[must_use]
    pub fn with_capacity(triangles: usize) -> Self {
        Self { slots: Vec::with_capacity(triangles), free: Vec::new() }
    }

    /// Becomes a copy of another triangulation, reusing memory.
    pub(crate) fn assign(&mut self, other: &Self) {
        self.slots.clone_from(&other.slots);
        self.free.clone_from(&other.free);
    }

    /// Removes everything but the memory.
    pub(crate) fn clear(&mut self) {
        self.slots.clear();
        self.free.clear();
    }

    /// Number of slots, live or free: every triangle's index is below it.
    #[must_use]
    pub fn slot_count(&self) -> usize {
        self.slots.len()
    }

    /// Number of live triangles, ghosts included.
    #[must_use]
    pub fn live_count(&self) -> usize {
        self.slots.len() - self.free.len()
    }

    /// Whether the slot holds a triangle.
    #[inline]
    #[must_use]
    pub fn is_live(&self, t: TriangleId) -> bool {
        self.slots[t.index()].words[FLAGS] & LIVE != 0
    }

    /// The live triangles in slot order.
    pub fn triangles(&self) -> impl Iterator<Item = TriangleId> + '_ {
        (0..self.slots.len() as u32).map(TriangleId).filter(|&t| self.is_live(t))
    }

    /// The corners of a triangle, counterclockwise.
    #[inline]
    #[must_use]
    pub fn corners(&self, t: TriangleId) -> [VertexId; 3] {
        let [a, b, c, ..] = self.slots[t.index()].words;
        [VertexId(a), VertexId(b), VertexId(c)]
    }

    /// Whether the triangle has the vertex at infinity.
    #[inline]
    #[must_use]
    pub fn is_ghost(&self, t: TriangleId) -> bool {
        self.corners(t).contains(&GHOST)
    }

    /// Where the half-edge starts.
    #[inline]
    #[must_use]
    pub fn origin(&self, e: HalfEdgeId) -> VertexId {
        VertexId(self.slots[e.triangle().index()].words[e.corner()])
    }

    /// Where the half-edge ends.
    #[inline]
    #[must_use]
    pub fn dest(&self, e: HalfEdgeId) -> VertexId {
        VertexId(self.slots[e.triangle().index()].words[turned(NEXT, e)])
    }

    /// The vertex of the half-edge's triangle that is not on it.
    #[inline]
    #[must_use]
    pub fn apex(&self, e: HalfEdgeId) -> VertexId {
        VertexId(self.slots[e.triangle().index()].words[turned(PREV, e)])
    }

    /// What lies across the half-edge.
    #[inline]
    #[must_use]
    pub fn across(&self, e: HalfEdgeId) -> Across {
        let raw = self.slots[e.triangle().index()].words[ACROSS + e.corner()];
        if raw & BORDER_BIT == 0 {
            Across::Twin(HalfEdgeId(raw))
        } else {
            Across::Border(raw & !BORDER_BIT)
        }
    }

    /// The opposite half-edge, or `None` on the border.
    #[inline]
    #[must_use]
    pub fn twin(&self, e: HalfEdgeId) -> Option<HalfEdgeId> {
        match self.across(e) {
            Across::Twin(twin) => Some(twin),
            Across::Border(_) => None,
        }
    }

    /// Whether the edge must not be flipped. The border counts as constrained.
    #[inline]
    #[must_use]
    pub fn is_constrained(&self, e: HalfEdgeId) -> bool {
        let slot = &self.slots[e.triangle().index()];
        slot.words[FLAGS] & (1 << e.corner()) != 0
            || slot.words[ACROSS + e.corner()] & BORDER_BIT != 0
    }

    /// Sets or clears the constraint on both sides of the edge.
    pub fn set_constrained(&mut self, e: HalfEdgeId, constrained: bool) {
        self.set_constrained_side(e, constrained);
        if let Some(twin) = self.twin(e) {
            self.set_constrained_side(twin, constrained);
        }
    }

    /// Sets or clears the constraint on this side only: for code that builds triangles one by one.
    #[inline]
    pub fn set_constrained_side(&mut self, e: HalfEdgeId, constrained: bool) {
        let flags = &mut self.slots[e.triangle().index()].words[FLAGS];
        if constrained {
            *flags |= 1 << e.corner();
        } else {
            *flags &= !(1 << e.corner());
        }
    }

    /// The caller's 28-bit word on a triangle (region, inside or outside); 0 in a new triangle.
    #[inline]
    #[must_use]
    pub fn tag(&self, t: TriangleId) -> u32 {
        self.slots[t.index()].words[FLAGS] >> TAG_SHIFT
    }

    /// Sets the caller's word; it must be below 2^28.
    pub fn set_tag(&mut self, t: TriangleId, tag: u32) {
        debug_assert!(tag < 1 << 28, "a tag has 28 bits");
        let flags = &mut self.slots[t.index()].words[FLAGS];
        *flags = (*flags & ((1 << TAG_SHIFT) - 1)) | (tag << TAG_SHIFT);
    }

    /// Scratch word for searches that mark what they have seen (0 in a new triangle).
    #[inline]
    #[must_use]
    pub fn mark(&self, t: TriangleId) -> u32 {
        self.slots[t.index()].words[MARK]
    }

    /// Sets the scratch word.
    pub fn set_mark(&mut self, t: TriangleId, mark: u32) {
        self.slots[t.index()].words[MARK] = mark;
    }

    /// Adds a triangle with the given corners, in a recycled slot if there is one. Its edges are
    /// borders with owner value 0 until linked; nothing is constrained, tag and mark are 0.
    pub fn add(&mut self, corners: [VertexId; 3]) -> TriangleId {
        let slot = Slot::new(corners);
        if let Some(t) = self.free.pop() {
            self.slots[t as usize] = slot;
            TriangleId(t)
        } else {
            assert!(self.slots.len() < TRIANGLES_MAX, "more than 2^29 triangles");
            self.slots.push(slot);
            TriangleId(self.slots.len() as u32 - 1)
        }
    }

    /// Removes a triangle; its slot will be reused. Neighbours keep stale links: the caller relinks.
    pub fn remove(&mut self, t: TriangleId) {
        debug_assert!(self.is_live(t), "removing a triangle twice");
        self.slots[t.index()].words[FLAGS] = 0;
        self.free.push(t.0);
    }

    /// Overwrites the corners of a live triangle in place (links, flags and tag stay).
    #[inline]
    pub fn set_corners(&mut self, t: TriangleId, corners: [VertexId; 3]) {
        let words = &mut self.slots[t.index()].words;
        [words[0], words[1], words[2]] = corners.map(|v| v.0);
    }

    /// Makes two half-edges each other's twin.
    #[inline]
    pub fn link(&mut self, e: HalfEdgeId, f: HalfEdgeId) {
        self.slots[e.triangle().index()].words[ACROSS + e.corner()] = f.0;
        self.slots[f.triangle().index()].words[ACROSS + f.corner()] = e.0;
    }

    /// Makes the half-edge a border with the given owner value (below 2^31).
    #[inline]
    pub fn set_border(&mut self, e: HalfEdgeId, owner: u32) {
        debug_assert!(owner < BORDER_BIT, "an owner value has 31 bits");
        self.slots[e.triangle().index()].words[ACROSS + e.corner()] = BORDER_BIT | owner;
    }

    /// Copies what lies across `from` (twin or border) to `to`, and points the twin back at it.
    #[inline]
    pub fn relink(&mut self, to: HalfEdgeId, across: Across) {
        match across {
            Across::Twin(twin) => self.link(to, twin),
            Across::Border(owner) => self.set_border(to, owner),
        }
    }

    /// The half-edge out of the same origin, next counterclockwise; `None` past the border.
    #[inline]
    #[must_use]
    pub fn rotate_ccw(&self, e: HalfEdgeId) -> Option<HalfEdgeId> {
        self.twin(e.prev())
    }

    /// The half-edge out of the same origin, next clockwise; `None` past the border.
    #[inline]
    #[must_use]
    pub fn rotate_cw(&self, e: HalfEdgeId) -> Option<HalfEdgeId> {
        self.twin(e).map(HalfEdgeId::next)
    }

    /// Flips the edge in its quadrilateral and returns the same half-edge, now the other diagonal.
    ///
    /// ```text
    ///        c                 c
    ///       / \               /|\
    ///      / e \     ->      / | \       before: e = a -> b, triangles abc and bad
    ///     a-----b           a e|  b      after:  e = d -> c, triangles dca and cdb
    ///      \   /             \ | /
    ///       \ /               \|/
    ///        d                 d
    /// ```
    ///
    /// # Requires
    /// The edge has a twin and is not constrained. Whether the quadrilateral is convex is the
    /// caller's to know. Both triangles keep their tags; constraints of the outer edges move along.
    #[inline]
    pub fn flip(&mut self, e: HalfEdgeId) -> HalfEdgeId {
        debug_assert!(!self.is_constrained(e), "flipping a constrained edge");
        let f = self.twin(e).expect("only an edge with two sides can flip");
        let (t, u) = (e.triangle(), f.triangle());
        let (e_next, e_prev, f_next, f_prev) = (e.next(), e.prev(), f.next(), f.prev());
        let [a, b, c, d] =
            [self.origin(e), self.origin(f), self.origin(e_prev), self.origin(f_prev)];
        let outer =
            [e_next, e_prev, f_next, f_prev].map(|h| (self.across(h), self.raw_constrained(h)));
        // e keeps its corner: t = (d, c, a), u = (c, d, b) with f = c -> d.
        self.set_origin(e, d);
        self.set_origin(e_next, c);
        self.set_origin(e_prev, a);
        self.set_origin(f, c);
        self.set_origin(f_next, d);
        self.set_origin(f_prev, b);
        debug_assert!(t != u, "an edge glued to itself");
        self.attach(e_next, outer[1]);
        self.attach(e_prev, outer[2]);
        self.attach(f_next, outer[3]);
        self.attach(f_prev, outer[0]);
        e
    }

    #[inline]
    fn raw_constrained(&self, e: HalfEdgeId) -> bool {
        self.slots[e.triangle().index()].words[FLAGS] & (1 << e.corner()) != 0
    }

    #[inline]
    fn set_origin(&mut self, e: HalfEdgeId, v: VertexId) {
        self.slots[e.triangle().index()].words[e.corner()] = v.0;
    }

    #[inline]
    fn attach(&mut self, e: HalfEdgeId, (across, constrained): (Across, bool)) {
        self.relink(e, across);
        self.set_constrained_side(e, constrained);
    }
}

macro_rules! debug_as {
    ($($id:ident $letter:literal),*) => {$(
        impl fmt::Debug for $id {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($letter, "{}"), self.0)
            }
        }
    )*};
}
debug_as!(VertexId "v", HalfEdgeId "e", TriangleId "t");
