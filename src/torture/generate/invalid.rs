//! Invalid boundaries, each with one deliberate fault of a known rule of SPEC 3.

use super::Family;
use super::draft::{Draft, rectangle};
use super::gaps::primitive;
use super::lattice::{Site, nearest_left, turn};
use crate::domain::LoopRole;
use crate::torture::prng::Prng;

/// All families of invalid boundaries.
pub(super) const FAMILIES: [Family; 17] = [
    Family::invalid(
        "crossing-by-little",
        "D8",
        "a hole crosses a slanted edge by 1 / length",
        barely,
    ),
    Family::invalid("bow-tie", "D8", "a ring that crosses itself", bow_tie),
    Family::invalid("crossing-holes", "D8", "two holes that cross", crossing_holes),
    Family::invalid("crossing-segments", "D8", "two interior segments that cross", segments),
    Family::invalid(
        "crossing-at-vertices",
        "D8",
        "a hole that crosses the outer ring at its vertices",
        at_vertices,
    ),
    Family::invalid(
        "overlap",
        "D9",
        "a hole that shares part of an edge with the outer ring",
        overlap,
    ),
    Family::invalid("repeated-loop", "D9", "the same ring twice", repeated_loop),
    Family::invalid(
        "repeated-segment",
        "D9",
        "a segment that overlaps another by a unit",
        repeated_segment,
    ),
    Family::invalid("hole-outside", "D10", "a hole that lies outside its outer ring", hole_outside),
    Family::invalid(
        "hole-in-hole",
        "D11",
        "a hole of a ring, inside another hole of it",
        hole_in_hole,
    ),
    Family::invalid("outer-in-outer", "D12", "an outer ring inside another", outer_in_outer),
    Family::invalid("equal-neighbours", "D4", "the same vertex twice in a row", equal_neighbours),
    Family::invalid(
        "duplicate-point",
        "D5",
        "an isolated point where a vertex lies",
        duplicate_point,
    ),
    Family::invalid("spike", "D6", "an edge that returns on itself", spike),
    Family::invalid("flat", "D7", "a ring whose vertices lie on one line", flat),
    Family::invalid("two-points", "D3", "a ring of two vertices", two_points),
    Family::invalid("unclosed", "D15", "a chain of segments that encloses nothing", unclosed),
];

/// A quarter of a random square's side: at least `least`.
fn quarter(prng: &mut Prng, least: i64) -> i64 {
    least + prng.magnitude(40)
}

/// The hole's tip is the lattice point nearest to the edge on the far side.
fn barely(prng: &mut Prng, _size: usize) -> Draft {
    let bits = 6 + prng.below(18) as u32;
    let d = loop {
        let d = primitive(prng, bits);
        if d[0] > 32 && d[1] > 32 {
            break d;
        }
    };
    let [u, v] = nearest_left(d);
    let outer = vec![[0, 0], d, [-d[1], d[0]]];
    let centre = [(d[0] - d[1]) / 3, (d[0] + d[1]) / 3];
    let mut draft = Draft::ring(outer);
    let tip = [d[0] - u, d[1] - v];
    let beside = [[centre[0] - 1, centre[1]], [centre[0], centre[1] + 1]];
    let third = beside.into_iter().find(|&p| turn(tip, centre, p).is_ne());
    draft.add(vec![tip, centre, third.unwrap_or(beside[0])], LoopRole::Any);
    draft
}

fn bow_tie(prng: &mut Prng, _size: usize) -> Draft {
    let (w, h) = (quarter(prng, 1), quarter(prng, 1));
    Draft::ring(vec![[0, 0], [w, h], [w, 0], [0, h]])
}

fn crossing_holes(prng: &mut Prng, _size: usize) -> Draft {
    let q = quarter(prng, 3);
    let mut draft = Draft::square(4 * q);
    draft.add(rectangle([1, 1], [2 * q, 2 * q]), LoopRole::HoleOf(0));
    draft.add(rectangle([2 * q - 1, 2 * q - 1], [3 * q, 3 * q]), LoopRole::HoleOf(0));
    draft
}

fn segments(prng: &mut Prng, _size: usize) -> Draft {
    let q = quarter(prng, 2);
    let mut draft = Draft::square(4 * q);
    draft.segments = vec![[[q, q], [3 * q, 3 * q - 1]], [[q, q + 1], [3 * q, 3 * q - 2]]];
    draft
}

/// A diamond whose vertices on the right edge let its ring pass from inside to outside there.
fn at_vertices(prng: &mut Prng, _size: usize) -> Draft {
    let q = quarter(prng, 1);
    let mut draft = Draft::ring(rectangle([0, 0], [4 * q, 4 * q]));
    draft.add(vec![[2 * q, 2 * q], [4 * q, q], [6 * q, 2 * q], [4 * q, 3 * q]], LoopRole::Any);
    draft
}

fn overlap(prng: &mut Prng, _size: usize) -> Draft {
    let q = quarter(prng, 1);
    let mut draft = Draft::square(4 * q);
    draft.add(rectangle([q, 0], [2 * q, q]), LoopRole::HoleOf(0));
    draft
}

fn repeated_loop(prng: &mut Prng, _size: usize) -> Draft {
    let q = quarter(prng, 1);
    let mut draft = Draft::square(4 * q);
    draft.add(rectangle([q, q], [2 * q, 2 * q]), LoopRole::Any);
    draft.add(rectangle([q, q], [2 * q, 2 * q]), LoopRole::Any);
    draft.rings[0].role = LoopRole::Any;
    draft
}

fn repeated_segment(prng: &mut Prng, _size: usize) -> Draft {
    let q = quarter(prng, 2);
    let mut draft = Draft::square(4 * q);
    draft.segments = vec![[[q, q], [2 * q, q]], [[2 * q - 1, q], [3 * q, q]]];
    draft
}

fn hole_outside(prng: &mut Prng, _size: usize) -> Draft {
    let q = quarter(prng, 1);
    let mut draft = Draft::square(2 * q);
    draft.add(rectangle([2 * q + 1, q], [3 * q + 1, 2 * q]), LoopRole::HoleOf(0));
    draft
}

fn hole_in_hole(prng: &mut Prng, _size: usize) -> Draft {
    let q = quarter(prng, 3);
    let mut draft = Draft::square(4 * q);
    draft.add(rectangle([1, 1], [3 * q, 3 * q]), LoopRole::HoleOf(0));
    draft.add(rectangle([2, 2], [2 * q, 2 * q]), LoopRole::HoleOf(0));
    draft
}

fn outer_in_outer(prng: &mut Prng, _size: usize) -> Draft {
    let q = quarter(prng, 1);
    let mut draft = Draft::square(4 * q);
    draft.add(rectangle([q, q], [2 * q, 2 * q]), LoopRole::Outer);
    draft
}

/// A convex ring: a square with the vertices of a slanted side on a parabola.
fn convex(prng: &mut Prng, size: usize) -> Vec<Site> {
    let n = 2 + size.min(60) as i64;
    let step = prng.magnitude(20);
    (0..=n).map(|i| [i * step, i * i]).chain([[n * step, n * n + 1], [0, n * n + 1]]).collect()
}

fn equal_neighbours(prng: &mut Prng, size: usize) -> Draft {
    let mut ring = convex(prng, size);
    let i = prng.index(ring.len());
    ring.insert(i, ring[i]);
    Draft::ring(ring)
}

fn duplicate_point(prng: &mut Prng, size: usize) -> Draft {
    let ring = convex(prng, size);
    let mut draft = Draft::ring(ring.clone());
    draft.points.push(*prng.pick(&ring));
    draft
}

fn spike(prng: &mut Prng, _size: usize) -> Draft {
    let q = quarter(prng, 1);
    let tip = prng.range(1, 3 * q);
    let outer = vec![[0, 0], [q, 0], [q, tip], [q, 0], [4 * q, 0], [4 * q, 4 * q], [0, 4 * q]];
    Draft::ring(outer)
}

fn flat(prng: &mut Prng, _size: usize) -> Draft {
    let [x, y] = primitive(prng, 20);
    Draft::ring(vec![[0, 0], [x, y], [3 * x, 3 * y]])
}

fn two_points(prng: &mut Prng, _size: usize) -> Draft {
    let q = quarter(prng, 1);
    let mut draft = Draft::ring(rectangle([0, 0], [4 * q, 4 * q]));
    draft.add(vec![[q, q], [2 * q, 3 * q]], LoopRole::Any);
    draft
}

fn unclosed(prng: &mut Prng, size: usize) -> Draft {
    let ring = convex(prng, size);
    let segments = ring.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    Draft { segments, carved: true, ..Draft::default() }
}
