//! Outlines of grid cells: combs, spirals, Hilbert curves, mazes; stretched without mercy.
//!
//! Valid because the cells of a [`Cells`] set never meet in a corner alone, so their outline is a
//! set of simple closed curves, and because stretching rows and columns by different positive
//! widths keeps the order of all coordinates.

use super::Family;
use super::draft::Draft;
use super::lattice::Site;
use crate::torture::prng::Prng;
use std::collections::{BTreeMap, BTreeSet};

/// Teeth and gaps.
pub(super) const COMB: Family =
    Family::valid("comb", "long teeth side by side, gaps down to one unit", comb);
/// A spiral corridor.
pub(super) const SPIRAL: Family =
    Family::valid("spiral", "a long corridor wound into a square spiral", spiral);
/// A Hilbert curve.
pub(super) const HILBERT: Family =
    Family::valid("hilbert", "a corridor along a Hilbert curve of order 1 to 4", hilbert);
/// A random maze.
pub(super) const MAZE: Family =
    Family::valid("maze", "a random maze; its cycles make holes of all shapes", maze);
/// Every vertex of a grid.
pub(super) const GRID: Family = Family::valid(
    "grid",
    "a rectilinear boundary with a vertex at every grid point, and isolated grid points inside",
    grid,
);

/// Rooms at even places and the passages between neighbouring rooms.
#[derive(Default)]
struct Cells {
    filled: BTreeSet<Site>,
}

impl Cells {
    /// Opens the passage between two rooms that are neighbours, and both rooms.
    fn join(&mut self, a: Site, b: Site) {
        self.filled.extend([
            [2 * a[0], 2 * a[1]],
            [a[0] + b[0], a[1] + b[1]],
            [2 * b[0], 2 * b[1]],
        ]);
    }

    fn path(rooms: &[Site]) -> Self {
        let mut cells = Self::default();
        rooms.windows(2).for_each(|pair| cells.join(pair[0], pair[1]));
        cells
    }

    /// Closed chains of unit edges with the cells on their left, in a fixed order.
    fn outlines(&self) -> Vec<Vec<Site>> {
        let mut next: BTreeMap<Site, Site> = BTreeMap::new();
        for &[x, y] in &self.filled {
            let corners = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]];
            let beyond = [[x, y - 1], [x + 1, y], [x, y + 1], [x - 1, y]];
            for side in (0..4).filter(|&side| !self.filled.contains(&beyond[side])) {
                let twice = next.insert(corners[side], corners[(side + 1) % 4]);
                debug_assert!(twice.is_none(), "cells that meet in a corner");
            }
        }
        let mut rings = Vec::new();
        while let Some((start, mut at)) = next.pop_first() {
            let mut ring = vec![start];
            while at != start {
                ring.push(at);
                at = next.remove(&at).unwrap_or(start);
            }
            rings.push(ring);
        }
        rings
    }
}

/// Leaves out vertices at straight angles.
fn corners_only(ring: &[Site]) -> Vec<Site> {
    let n = ring.len();
    let is_corner = |&i: &usize| {
        let [a, b, c] = [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]];
        (b[0] - a[0], b[1] - a[1]) != (c[0] - b[0], c[1] - b[1])
    };
    (0..n).filter(is_corner).map(|i| ring[i]).collect()
}

/// Strictly rising places for the grid lines 0 ..= `lines`; wide and narrow by turns or at random.
fn stretch(prng: &mut Prng, lines: i64) -> Vec<i64> {
    let bits = *prng.pick(&[1, 1, 4, 12, 30]);
    let wide = prng.magnitude(bits);
    let by_turns = prng.one_in(2);
    let mut at = 0;
    (0..=lines)
        .map(|line| {
            let here = at;
            at += if by_turns { [wide, 1][(line % 2) as usize] } else { prng.magnitude(bits) };
            here
        })
        .collect()
}

fn draft(cells: &Cells, prng: &mut Prng) -> Draft {
    let lines = cells.filled.iter().flatten().max().map_or(0, |line| line + 1);
    let (columns, rows) = (stretch(prng, lines), stretch(prng, lines));
    let keep_all = prng.one_in(3);
    let mut draft = Draft::default();
    for ring in cells.outlines() {
        let ring = if keep_all { ring } else { corners_only(&ring) };
        let at = |s: &Site| [columns[s[0] as usize], rows[s[1] as usize]];
        draft.add(ring.iter().map(at).collect(), crate::domain::LoopRole::Any);
    }
    draft
}

fn comb(prng: &mut Prng, size: usize) -> Draft {
    let mut cells = Cells::default();
    let teeth = 2 + size.min(200) as i64 / 4;
    for x in 0..teeth {
        let high = prng.range(1, 3);
        if x + 1 < teeth {
            cells.join([x, 0], [x + 1, 0]);
        }
        (0..high).for_each(|y| cells.join([x, y], [x, y + 1]));
    }
    draft(&cells, prng)
}

/// Rooms of a k by k square, from the rim inwards.
fn spiral_rooms(k: i64) -> Vec<Site> {
    let (mut at, mut step, mut seen) = ([0, 0], [1, 0], BTreeSet::new());
    let mut rooms = Vec::new();
    for _ in 0..k * k {
        rooms.push(at);
        seen.insert(at);
        let ahead = |step: Site| [at[0] + step[0], at[1] + step[1]];
        let is_free = |s: Site| s.iter().all(|c| (0..k).contains(c)) && !seen.contains(&s);
        if !is_free(ahead(step)) {
            step = [-step[1], step[0]];
        }
        at = ahead(step);
    }
    rooms
}

fn spiral(prng: &mut Prng, size: usize) -> Draft {
    let k = 2 + (size as i64 / 6).min(14);
    draft(&Cells::path(&spiral_rooms(k)), prng)
}

/// The d-th room of the Hilbert curve through 2^order by 2^order rooms.
fn hilbert_room(order: u32, d: i64) -> Site {
    let (mut x, mut y, mut t) = (0, 0, d);
    for level in 0..order {
        let s = 1 << level;
        let (rx, ry) = (1 & (t / 2), 1 & (t ^ (t / 2)));
        if ry == 0 {
            if rx == 1 {
                (x, y) = (s - 1 - x, s - 1 - y);
            }
            (x, y) = (y, x);
        }
        (x, y, t) = (x + s * rx, y + s * ry, t / 4);
    }
    [x, y]
}

fn hilbert(prng: &mut Prng, size: usize) -> Draft {
    let order = 1 + (size as u32 / 12).min(3);
    let rooms: Vec<Site> = (0..1 << (2 * order)).map(|d| hilbert_room(order, d)).collect();
    draft(&Cells::path(&rooms), prng)
}

fn maze_cells(prng: &mut Prng, size: usize) -> Cells {
    let k = 2 + (size as f64).sqrt() as i64;
    let mut cells = Cells::default();
    let (mut seen, mut stack) = (BTreeSet::from([[0, 0]]), vec![[0, 0]]);
    let inside = |s: &Site| s.iter().all(|c| (0..k).contains(c));
    while let Some(&[x, y]) = stack.last() {
        let around = [[x + 1, y], [x, y + 1], [x - 1, y], [x, y - 1]];
        let around: Vec<Site> = around.into_iter().filter(inside).collect();
        let free: Vec<Site> = around.iter().copied().filter(|s| !seen.contains(s)).collect();
        if free.is_empty() {
            if prng.one_in(6) {
                cells.join([x, y], *prng.pick(&around));
            }
            stack.pop();
            continue;
        }
        let room = *prng.pick(&free);
        cells.join([x, y], room);
        seen.insert(room);
        stack.push(room);
    }
    cells
}

fn maze(prng: &mut Prng, size: usize) -> Draft {
    let cells = maze_cells(prng, size);
    draft(&cells, prng)
}

fn grid(prng: &mut Prng, size: usize) -> Draft {
    let cells = maze_cells(prng, size / 4);
    let scale = prng.range(2, 4);
    let mut draft = Draft::default();
    for ring in cells.outlines() {
        let n = ring.len();
        let fine = (0..n).flat_map(|i| {
            let ([ax, ay], [bx, by]) = (ring[i], ring[(i + 1) % n]);
            (0..scale).map(move |k| [ax * scale + (bx - ax) * k, ay * scale + (by - ay) * k])
        });
        draft.add(fine.collect(), crate::domain::LoopRole::Any);
    }
    for &[x, y] in &cells.filled {
        let inner =
            (1..scale).flat_map(|i| (1..scale).map(move |j| [x * scale + i, y * scale + j]));
        draft.points.extend(inner.filter(|_| prng.one_in(2)));
    }
    draft
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::torture::generate::lattice::is_simple;

    #[test]
    fn outlines_of_a_block_and_of_a_ring_of_cells() {
        let cells = Cells::path(&[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]);
        let rings = cells.outlines();
        assert_eq!(rings.len(), 2, "an outer one and a hole");
        assert!(rings.iter().all(|ring| is_simple(ring)));
        assert_eq!(corners_only(&rings[0]).len(), 4);
    }

    #[test]
    fn curves_visit_every_room_once_and_step_to_neighbours() {
        let hilbert: Vec<Site> = (0..64).map(|d| hilbert_room(3, d)).collect();
        for rooms in [hilbert, spiral_rooms(8)] {
            assert_eq!(rooms.iter().collect::<BTreeSet<_>>().len(), 64);
            for pair in rooms.windows(2) {
                let far = (pair[0][0] - pair[1][0]).abs() + (pair[0][1] - pair[1][1]).abs();
                assert_eq!(far, 1, "{pair:?}");
            }
        }
    }
}
