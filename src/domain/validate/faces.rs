//! The faces of the planar graph that a sweep without conflicts leaves.
//!
//! Half-edge `2 p` runs along piece `p` to the right, `2 p + 1` back. Around each vertex the
//! half-edges are sorted by angle; the walks along `next` are the boundary cycles of faces, with
//! the face on the left. The cycle around a connected component is joined to the face in which
//! the component lies: the one above the piece below its leftmost vertex, which the sweep noted.

use super::graph::NONE;
use super::sweep::{Piece, Sweep};
use crate::point::Point2;
use crate::predicates::{Sign, orient2d};
use std::cmp::Ordering;

/// The unbounded face; see [`Faces::of_half_edge`].
pub(super) const UNBOUNDED: u32 = 0;

/// Half-edges around every vertex, counterclockwise.
#[derive(Debug)]
pub(super) struct Stars {
    first: Vec<u32>,
    outgoing: Vec<u32>,
}

/// The vertex a half-edge starts from.
pub(super) fn origin(pieces: &[Piece], half_edge: u32) -> u32 {
    let piece = pieces[half_edge as usize / 2];
    if half_edge.is_multiple_of(2) { piece.left } else { piece.right }
}

impl Stars {
    /// Sorts the half-edges around each vertex from straight down (excluded) counterclockwise.
    pub fn new(points: &[Point2], pieces: &[Piece]) -> Self {
        let half_edges = 2 * pieces.len() as u32;
        let mut first = vec![0_u32; points.len() + 1];
        for h in 0..half_edges {
            first[origin(pieces, h) as usize + 1] += 1;
        }
        for vertex in 0..points.len() {
            first[vertex + 1] += first[vertex];
        }
        let mut free = first.clone();
        let mut outgoing = vec![0; half_edges as usize];
        for h in 0..half_edges {
            let slot = &mut free[origin(pieces, h) as usize];
            outgoing[*slot as usize] = h;
            *slot += 1;
        }
        let mut stars = Self { first, outgoing };
        for vertex in 0..points.len() as u32 {
            let range = stars.range(vertex);
            stars.outgoing[range].sort_by(|&g, &h| by_angle(points, pieces, g, h));
        }
        stars
    }

    fn range(&self, vertex: u32) -> std::ops::Range<usize> {
        self.first[vertex as usize] as usize..self.first[vertex as usize + 1] as usize
    }

    /// The half-edges that start from a vertex, counterclockwise; those to the right come first.
    pub fn of(&self, vertex: u32) -> &[u32] {
        &self.outgoing[self.range(vertex)]
    }
}

/// Order of two half-edges from the same vertex. Half-edges 2 p lead to lexicographically larger
/// points, that is to angles in (-90°, 90°]; the others to (90°, 270°]. Within each the angle
/// between two is below 180°, so that the orientation tells their order.
fn by_angle(points: &[Point2], pieces: &[Piece], g: u32, h: u32) -> Ordering {
    (g % 2).cmp(&(h % 2)).then_with(|| {
        let [vertex, a, b] = [origin(pieces, g), origin(pieces, g ^ 1), origin(pieces, h ^ 1)]
            .map(|v| points[v as usize]);
        match orient2d(vertex, a, b) {
            Sign::Positive => Ordering::Less,
            Sign::Zero => Ordering::Equal,
            Sign::Negative => Ordering::Greater,
        }
    })
}

/// The faces, numbered from 0; [`UNBOUNDED`] is the one around everything.
#[derive(Debug)]
pub(super) struct Faces {
    /// The face on the left of each half-edge.
    pub of_half_edge: Vec<u32>,
    /// How many there are.
    pub count: usize,
}

impl Faces {
    /// Finds the faces in linear time but for the union of cycles.
    pub fn new(sweep: &Sweep, stars: &Stars) -> Self {
        let next = next_half_edges(sweep, stars);
        let (cycles, cycle_count) = number_cycles(&next);
        let mut union = Union::new(cycle_count);
        for vertex in 0..sweep.below.len() as u32 {
            let Some(&top) = stars.of(vertex).last() else { continue };
            // The leftmost vertex of a component is the only one all of whose pieces leave to the
            // right and below whose uppermost piece, counterclockwise, the outside begins. A vertex
            // like it inside a component joins a cycle with its own face: no harm is done.
            if top.is_multiple_of(2) {
                let around = face_above(sweep.below[vertex as usize]);
                union.join(cycles[top as usize], around.map_or(UNBOUNDED, |h| cycles[h as usize]));
            }
        }
        union.number(cycles)
    }
}

/// The half-edge with the face above a piece on its left.
pub(super) fn face_above(piece: u32) -> Option<u32> {
    (piece != NONE).then(|| 2 * piece)
}

fn next_half_edges(sweep: &Sweep, stars: &Stars) -> Vec<u32> {
    let mut next = vec![NONE; 2 * sweep.pieces.len()];
    for vertex in 0..sweep.below.len() as u32 {
        let star = stars.of(vertex);
        let before = star.last().into_iter().chain(star);
        for (&clockwise, &h) in before.zip(star) {
            next[(h ^ 1) as usize] = clockwise;
        }
    }
    next
}

/// The cycle of each half-edge, numbered from 1, and one more than the number of cycles.
fn number_cycles(next: &[u32]) -> (Vec<u32>, usize) {
    let mut cycles = vec![NONE; next.len()];
    let mut count = UNBOUNDED + 1;
    for start in 0..next.len() {
        let mut h = start;
        if cycles[h] != NONE {
            continue;
        }
        while cycles[h] == NONE {
            cycles[h] = count;
            h = next[h] as usize;
        }
        count += 1;
    }
    (cycles, count as usize)
}

/// Union of cycles into faces, by halving paths to the lowest number.
struct Union {
    parent: Vec<u32>,
}

impl Union {
    fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    fn find(&mut self, mut cycle: u32) -> u32 {
        while self.parent[cycle as usize] != cycle {
            let parent = self.parent[cycle as usize];
            self.parent[cycle as usize] = self.parent[parent as usize];
            cycle = self.parent[cycle as usize];
        }
        cycle
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }

    fn number(mut self, cycles: Vec<u32>) -> Faces {
        let mut count = 0;
        let mut face_of = vec![NONE; self.parent.len()];
        for cycle in 0..self.parent.len() as u32 {
            let root = self.find(cycle) as usize;
            if face_of[root] == NONE {
                face_of[root] = count;
                count += 1;
            }
            face_of[cycle as usize] = face_of[root];
        }
        let of_half_edge = cycles.into_iter().map(|c| face_of[c as usize]).collect();
        Faces { of_half_edge, count: count as usize }
    }
}
