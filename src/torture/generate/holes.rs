//! Holes: nested, touching, by the thousand; islands in them; vertices hanging on edges.
//!
//! Valid because every hole stays in a cell of its own whose interiors are disjoint; where two touch
//! they do so in points of the cells' common border, without crossing.

use super::Family;
use super::draft::{Draft, rectangle};
use super::lattice::Site;
use crate::domain::LoopRole;
use crate::torture::prng::Prng;

/// Rings in rings.
pub(super) const NESTED: Family = Family::valid(
    "nested",
    "rings in rings, squares and diamonds by turns, one unit apart or touching",
    nested,
);
/// Holes that touch.
pub(super) const TOUCHING: Family = Family::valid(
    "touching",
    "diamonds that touch each other and the outer ring at points, cutting the domain in pieces",
    touching,
);
/// Very many holes.
pub(super) const MANY_HOLES: Family =
    Family::valid("many-holes", "a plate with up to thousands of small holes", many_holes);
/// Islands in holes in islands.
pub(super) const ISLANDS: Family =
    Family::valid("islands", "islands in holes in islands, several beside each other", islands);
/// Vertices inside edges.
pub(super) const HANGING: Family = Family::valid(
    "hanging",
    "vertices of holes, and ends of segments, in the interior of other edges",
    hanging,
);

/// The square with corners on the axes, `r` from its centre.
fn diamond([x, y]: Site, r: i64) -> Vec<Site> {
    vec![[x + r, y], [x, y + r], [x - r, y], [x, y - r]]
}

/// A square of half side r holds a diamond of radius <= r, which holds a square of half side
/// r / 2; equality touches.
fn nested(prng: &mut Prng, size: usize) -> Draft {
    let depth = 2 + size.min(40) / 2;
    let mut draft = Draft::default();
    let mut r: i64 = 1 << 48;
    while r > 4 && draft.rings.len() < depth {
        let shrink = prng.below(3);
        let ring = match draft.rings.len() % 2 {
            0 => rectangle([-r, -r], [r, r]),
            _ => diamond([0, 0], r),
        };
        draft.add(ring, LoopRole::Any);
        let room = if draft.rings.len() % 2 == 1 { r } else { r / 2 };
        r = match shrink {
            0 => room,
            1 => room - 1,
            _ => 1 + prng.range(room / 2, room - 2),
        };
    }
    draft
}

fn touching(prng: &mut Prng, size: usize) -> Draft {
    let k = 1 + (size as f64).sqrt().min(20.0) as i64;
    let r = prng.magnitude(20);
    let mut draft = Draft::square(2 * r * k);
    for (i, j) in (0..k).flat_map(|i| (0..k).map(move |j| (i, j))) {
        // Full diamonds touch their neighbours and the outer ring; smaller ones stand alone.
        let radius = if prng.one_in(3) && r > 1 { prng.range(1, r - 1) } else { r };
        if k == 1 || !prng.one_in(4) {
            draft.add(diamond([r + 2 * r * i, r + 2 * r * j], radius), LoopRole::HoleOf(0));
        }
    }
    draft
}

fn many_holes(prng: &mut Prng, size: usize) -> Draft {
    let k = 2 + (size as i64 / 2).min(50);
    let pitch = 8 << prng.below(20);
    let mut draft = Draft::square(pitch * k);
    let shape = prng.below(4);
    for (i, j) in (0..k).flat_map(|i| (0..k).map(move |j| (i, j))) {
        let [x, y] = [pitch * i + pitch / 2, pitch * j + pitch / 2];
        let r = prng.range(1, pitch / 2 - 1);
        let ring = match if shape == 3 { prng.below(3) } else { shape } {
            0 => rectangle([x - r, y - r], [x + r, y + r]),
            1 => diamond([x, y], r),
            _ => vec![[x - r, y - r], [x + r, y - 1], [x + prng.range(1 - r, r), y + r]],
        };
        draft.add(ring, LoopRole::HoleOf(0));
    }
    draft
}

/// Four rings beside each other in the square, and in those, as long as there is room.
fn fill(draft: &mut Draft, low: Site, side: i64, prng: &mut Prng, budget: &mut usize) {
    for corner in [[0, 0], [1, 0], [0, 1], [1, 1]] {
        let half = side / 2;
        if half < 8 || *budget == 0 || prng.one_in(3) {
            continue;
        }
        *budget -= 1;
        let at = [low[0] + corner[0] * half + 1, low[1] + corner[1] * half + 1];
        let ring = half - 2 - prng.range(0, half / 4);
        draft.add(rectangle(at, [at[0] + ring, at[1] + ring]), LoopRole::Any);
        fill(draft, at, ring, prng, budget);
    }
}

fn islands(prng: &mut Prng, size: usize) -> Draft {
    let side = 1 << prng.range(6, 40);
    let mut draft = Draft::ring(rectangle([0, 0], [side, side]));
    fill(&mut draft, [0, 0], side, prng, &mut size.clamp(2, 300));
    draft
}

/// Triangles hang with one vertex from the upper side, segments stand on the lower one.
fn hanging(prng: &mut Prng, size: usize) -> Draft {
    let count = 1 + size.min(100) as i64 / 2;
    let pitch = 4 << prng.below(16);
    let (width, height) = (pitch * count, 8 * pitch);
    let mut draft = Draft::ring(rectangle([0, 0], [width, height]));
    draft.rings[0].role = LoopRole::Outer;
    for i in 0..count {
        let x = i * pitch + prng.range(1, pitch - 1);
        let (left, right) = (i * pitch + prng.range(0, 1), (i + 1) * pitch - 1);
        let low = height - prng.range(1, 3 * pitch);
        if left != right && i > 0 && prng.one_in(2) {
            draft.add(vec![[x, height], [left, low], [right, low]], LoopRole::HoleOf(0));
        }
        let top = prng.range(1, 4 * pitch);
        draft.segments.push([[x, 0], [x, top]]);
        // A branch leaves the segment's interior, to the right within its own cell.
        if top > 2 && x + 1 < (i + 1) * pitch && prng.one_in(2) {
            let from = [x, prng.range(1, top - 1)];
            draft.segments.push([from, [x + 1, prng.range(1, 4 * pitch)]]);
        }
    }
    draft
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_lie_inside_and_come_by_the_thousand() {
        let draft = many_holes(&mut Prng::new(1), 3000);
        assert!(draft.rings.len() > 2000);
        let [low, high] = draft.bounds();
        for ring in &draft.rings[1..] {
            assert!(ring.sites.iter().flatten().all(|&c| c > low[0] && c < high[0]));
        }
    }

    #[test]
    fn rings_are_nested_as_deep_as_asked() {
        assert_eq!(nested(&mut Prng::new(2), 40).rings.len(), 22);
    }
}
