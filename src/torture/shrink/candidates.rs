//! Simpler boundaries one step away, for the shrinkers of test frameworks.

use super::edits::{
    loops_left, points_left, segments_left, shorter, simple_coordinates, vertices, vertices_left,
    weight, with_number,
};
use super::keeps_claim;
use crate::domain::Domain;
use crate::torture::generate::Claim;
use std::ops::Range;

/// Boundaries one step simpler than `domain` that keep its claim, the boldest steps first: half of
/// the loops is left out, then a quarter, ... one; then segments, isolated points and vertices in
/// the same way; then coordinates become simpler, all at once and one by one. Who follows the
/// first that still fails, and starts over from it, ends at a boundary from which nothing can be taken.
///
/// # Complexity
/// Made as they are asked for; O(n) of them, each O(n log n) for n vertices.
pub fn candidates(domain: &Domain, claim: Claim) -> impl Iterator<Item = Domain> + use<> {
    let (left_out, simpler) = (domain.clone(), domain.clone());
    let fewer = leaving_out(domain).map(move |(of, range)| of.left(&left_out, range));
    // Lists of whole boundaries are made when their turn comes, not before.
    let coordinates = std::iter::once_with(move || {
        let all_at_once: Vec<Domain> =
            simple_coordinates(&simpler).filter(|new| weight(new) < weight(&simpler)).collect();
        all_at_once.into_iter().chain(one_by_one(simpler))
    });
    fewer.chain(coordinates.flatten()).filter(move |new| keeps_claim(new, claim))
}

/// What can be left out of a boundary.
#[derive(Clone, Copy, Debug)]
enum Parts {
    Loops,
    Segments,
    Points,
    Vertices,
}

impl Parts {
    const ALL: [Self; 4] = [Self::Loops, Self::Segments, Self::Points, Self::Vertices];

    fn count(self, domain: &Domain) -> usize {
        match self {
            Self::Loops => domain.loops.len(),
            Self::Segments => domain.segments.len(),
            Self::Points => domain.isolated_points().len(),
            Self::Vertices => vertices(domain),
        }
    }

    fn left(self, domain: &Domain, gone: Range<usize>) -> Domain {
        let left = match self {
            Self::Loops => loops_left,
            Self::Segments => segments_left,
            Self::Points => points_left,
            Self::Vertices => vertices_left,
        };
        left(domain, &gone.collect())
    }
}

fn leaving_out(domain: &Domain) -> impl Iterator<Item = (Parts, Range<usize>)> + use<> {
    let counts = Parts::ALL.map(|of| (of, of.count(domain)));
    counts.into_iter().flat_map(|(of, count)| chunks(count).map(move |range| (of, range)))
}

/// Halves, quarters, ... single ones of 0..count.
fn chunks(count: usize) -> impl Iterator<Item = Range<usize>> {
    let first = count.div_ceil(2);
    let sizes = std::iter::successors(Some(first), |&size| Some(size / 2)).take_while(|&s| s > 0);
    sizes.flat_map(move |size| (0..count).step_by(size).map(move |at| at..(at + size).min(count)))
}

fn one_by_one(domain: Domain) -> impl Iterator<Item = Domain> {
    let numbers = (0..domain.points.len()).flat_map(|point| [(point, 0), (point, 1)]);
    numbers.flat_map(move |(point, axis)| {
        let old = <[f64; 2]>::from(domain.points[point])[axis];
        let new = |number| with_number(&domain, point, axis, number);
        shorter(old).into_iter().map(new).collect::<Vec<_>>()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::torture::generate::case;

    #[test]
    fn chunks_end_with_single_ones_and_cover_everything_each_time() {
        let all: Vec<Range<usize>> = chunks(5).collect();
        assert_eq!(all, [0..3, 3..5, 0..1, 1..2, 2..3, 3..4, 4..5]);
        assert_eq!(chunks(0).count(), 0);
        assert!(chunks(1).eq(std::iter::once(0..1)));
    }

    // spec: R13
    #[test]
    fn candidates_keep_the_claim_and_are_other_boundaries() {
        for index in 0..40 {
            let case = case(12, index);
            for candidate in candidates(&case.domain, case.claim).take(30) {
                assert!(keeps_claim(&candidate, case.claim), "{} {index}", case.family);
                assert_ne!(candidate, case.domain, "{} {index}", case.family);
            }
        }
    }

    // spec: R13
    #[test]
    fn what_is_left_of_a_boundary_whose_every_simplification_fails_is_a_triangle() {
        let case = case(3, 20); // many holes
        let mut best = case.domain.clone();
        assert!(vertices(&best) > 12, "{}", vertices(&best));
        while let Some(next) = candidates(&best, case.claim).next() {
            let is_less = (weight(&next), sum(&next)) < (weight(&best), sum(&best));
            assert!(is_less, "each step is simpler, or this would not end");
            best = next;
        }
        assert_eq!(vertices(&best), 3, "{best:?}");
    }

    fn sum(domain: &Domain) -> u64 {
        domain.points.iter().map(|p| (p.x.abs() + p.y.abs()) as u64).sum()
    }
}
