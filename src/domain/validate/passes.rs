//! Loops that cross at a vertex: exactly, by the circular order of the edges around it.
//!
//! Each visit of a loop to a vertex is a *pass*: it arrives on one half-edge and leaves on another.
//! Two passes touch without crossing iff their four half-edges do not alternate around the vertex;
//! no passes alternate iff the circular sequence of passes is a word of balanced brackets.

use super::faces::{Stars, origin};
use super::fault::Owner;
use super::graph::{Edge, NONE};
use super::sweep::{Piece, Sweep};

/// Two passes that cross: the vertex and the edges on which each leaves or arrives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CrossingPasses {
    /// Rank of the vertex.
    pub vertex: u32,
    /// An edge of each pass.
    pub edges: [u32; 2],
}

/// Pairs of passes that cross: all, or if there are `limit` or more, at least so many.
pub(super) fn crossing_passes(
    sweep: &Sweep,
    stars: &Stars,
    edges: &[Edge],
    limit: usize,
) -> Vec<CrossingPasses> {
    let partner = partners(sweep, edges);
    let mut found = Vec::new();
    let mut open: Vec<u32> = Vec::new();
    for vertex in 0..sweep.below.len() as u32 {
        let star = stars.of(vertex);
        if star.len() < 4 {
            continue;
        }
        open.clear();
        for &h in star.iter().filter(|&&h| partner[h as usize] != NONE) {
            let Some(start) = open.iter().rposition(|&g| g == partner[h as usize]) else {
                open.push(h);
                continue;
            };
            open.remove(start);
            let edge = |h: u32| sweep.pieces[h as usize / 2].edge;
            let crossed = open[start..].iter().map(|&g| CrossingPasses {
                vertex,
                edges: [edge(h).min(edge(g)), edge(h).max(edge(g))],
            });
            found.extend(crossed);
            if found.len() >= limit {
                return found;
            }
        }
    }
    found
}

/// For each half-edge of a loop, the other half-edge of its pass through its origin.
fn partners(sweep: &Sweep, edges: &[Edge]) -> Vec<u32> {
    let mut partner = vec![NONE; 2 * sweep.pieces.len()];
    let mut first = 0;
    while first < edges.len() {
        let Owner::Loop { index, .. } = edges[first].owner else { break };
        let of_loop = |e: &&Edge| matches!(e.owner, Owner::Loop { index: i, .. } if i == index);
        let count = edges[first..].iter().take_while(of_loop).count();
        let walk: Vec<u32> =
            (first..first + count).flat_map(|e| along(&sweep.pieces, edges, e)).collect();
        let before = walk.last().into_iter().chain(&walk);
        for (&arriving, &leaving) in before.zip(&walk) {
            partner[leaving as usize] = arriving ^ 1;
            partner[(arriving ^ 1) as usize] = leaving;
        }
        first += count;
    }
    partner
}

/// The half-edges of an edge's pieces in its own direction.
pub(super) fn along(pieces: &[Piece], edges: &[Edge], edge: usize) -> Vec<u32> {
    let mut half_edges = Vec::with_capacity(1);
    let mut piece = edge as u32;
    while piece != NONE {
        half_edges.push(2 * piece);
        piece = pieces[piece as usize].next;
    }
    if edges[edge].ends[0] > edges[edge].ends[1] {
        half_edges.reverse();
        half_edges.iter_mut().for_each(|h| *h ^= 1);
    }
    debug_assert_eq!(origin(pieces, half_edges[0]), edges[edge].ends[0]);
    half_edges
}
