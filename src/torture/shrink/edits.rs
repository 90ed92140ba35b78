//! What shrinking does to a boundary: things are left out, coordinates become simpler.

use crate::domain::{Domain, LoopRole};
use crate::point::Point2;
use std::collections::{BTreeMap, BTreeSet};

/// What shrinking makes smaller: vertices, loops, then digits.
pub(super) fn weight(domain: &Domain) -> (usize, usize, usize) {
    let digits = domain.points.iter().flat_map(|p| [p.x, p.y]);
    let digits = digits.map(|c| format!("{c:?}").len()).sum();
    let vertices = domain.edges().count() + domain.points.len();
    (vertices, domain.loops.len() + domain.segments.len(), digits)
}

/// Numbers that print shorter than `c`, the simplest first.
pub(super) fn shorter(c: f64) -> Vec<f64> {
    let length = |c: f64| format!("{c:?}").len();
    let mut all = vec![0.0, 1.0, 2.0, 5.0, 10.0, libm::trunc(c)];
    all.extend((1..8).map(|digits| rounded(c, digits)));
    all.retain(|&n| {
        n != c && (length(n) < length(c) || (length(n) == length(c) && n.abs() < c.abs()))
    });
    all.dedup();
    all
}

/// `c` with so many significant decimal digits.
pub(super) fn rounded(c: f64, digits: usize) -> f64 {
    format!("{c:.*e}", digits - 1).parse().unwrap_or(c)
}

/// How many vertices the loops have together.
pub(super) fn vertices(domain: &Domain) -> usize {
    domain.loops.iter().map(|l| l.vertices.len()).sum()
}

/// Without some segments.
pub(super) fn segments_left(domain: &Domain, gone: &BTreeSet<usize>) -> Domain {
    let mut left = domain.clone();
    let mut index = 0..;
    left.segments.retain(|_| !index.next().is_some_and(|i| gone.contains(&i)));
    compacted(&left, &domain.isolated_points())
}

/// Without some isolated points, counted among these.
pub(super) fn points_left(domain: &Domain, gone: &BTreeSet<usize>) -> Domain {
    let alone = domain.isolated_points().into_iter().enumerate();
    let kept: Vec<usize> =
        alone.filter(|(at, _)| !gone.contains(at)).map(|(_, point)| point).collect();
    compacted(domain, &kept)
}

/// Without some vertices of loops, counted over all loops.
pub(super) fn vertices_left(domain: &Domain, gone: &BTreeSet<usize>) -> Domain {
    let mut left = domain.clone();
    let mut index = 0..;
    for of in &mut left.loops {
        of.vertices.retain(|_| !index.next().is_some_and(|i| gone.contains(&i)));
        of.markers.truncate(of.vertices.len());
    }
    compacted(&left, &domain.isolated_points())
}

/// Without points that are neither used nor among `kept`, which is sorted, and without places in a
/// file.
fn compacted(domain: &Domain, kept: &[usize]) -> Domain {
    let mut gone = domain.isolated_points();
    gone.retain(|v| kept.binary_search(v).is_err());
    let is_left = |v: &usize| gone.binary_search(v).is_err();
    let all: Vec<usize> = (0..domain.points.len()).filter(is_left).collect();
    let new: BTreeMap<usize, u32> = all.iter().copied().zip(0..).collect();
    let mut left = domain.clone();
    left.points = all.iter().map(|&i| domain.points[i]).collect();
    left.point_markers.clear();
    left.places = crate::domain::Places::default();
    let renumber = |v: &mut u32| *v = new.get(&(*v as usize)).copied().unwrap_or(u32::MAX);
    left.loops.iter_mut().flat_map(|l| l.vertices.iter_mut()).for_each(renumber);
    left.segments.iter_mut().flat_map(|s| s.vertices.iter_mut()).for_each(renumber);
    left
}

/// Without some loops, and without the holes that claim them.
pub(super) fn loops_left(domain: &Domain, gone: &BTreeSet<usize>) -> Domain {
    let is_gone = |i: usize| {
        let claims = domain.loops.get(i).map(|l| l.role);
        gone.contains(&i) || matches!(claims, Some(LoopRole::HoleOf(of)) if gone.contains(&of))
    };
    let all: Vec<usize> = (0..domain.loops.len()).filter(|&i| !is_gone(i)).collect();
    let mut left = domain.clone();
    left.loops = all.iter().map(|&i| domain.loops[i].clone()).collect();
    for of in &mut left.loops {
        if let LoopRole::HoleOf(outer) = &mut of.role {
            *outer = all.binary_search(outer).unwrap_or(usize::MAX);
        }
    }
    compacted(&left, &domain.isolated_points())
}

/// With one coordinate replaced.
pub(super) fn with_number(domain: &Domain, point: usize, axis: usize, number: f64) -> Domain {
    let mut new = domain.clone();
    let mut place = <[f64; 2]>::from(new.points[point]);
    place[axis] = number;
    new.points[point] = place.into();
    new
}

/// The boundary in simpler coordinates, the simplest first: ranks, ever finer grids, and moved.
pub(super) fn simple_coordinates(domain: &Domain) -> impl Iterator<Item = Domain> + '_ {
    let coarse = (1..25).map(|bits| on_grid(domain, f64::from(1u32 << bits)));
    let fine = [unit, moved].into_iter().map(|of| of(domain));
    std::iter::once_with(|| ranks(domain)).chain(coarse).chain(fine)
}

/// Every coordinate mapped.
pub(super) fn mapped(domain: &Domain, of: &dyn Fn(f64) -> f64) -> Domain {
    let mut new = domain.clone();
    for p in &mut new.points {
        *p = Point2::new(of(p.x), of(p.y));
    }
    new
}

/// Every coordinate becomes its rank among those of its axis.
fn ranks(domain: &Domain) -> Domain {
    let rank = |axis: usize| {
        let mut all: Vec<f64> =
            domain.points.iter().map(|&p| <[f64; 2]>::from(p)[axis] + 0.0).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        move |c: f64| all.partition_point(|&other| other < c) as f64
    };
    let (x, y) = (rank(0), rank(1));
    let mut new = domain.clone();
    for p in &mut new.points {
        *p = Point2::new(x(p.x), y(p.y));
    }
    new
}

/// Scaled by a power of two so that the largest coordinate is about 1000.
fn unit(domain: &Domain) -> Domain {
    let largest = domain.points.iter().flat_map(|p| [p.x.abs(), p.y.abs()]).fold(0.0, f64::max);
    let (_, exponent) = libm::frexp(largest);
    mapped(&moved(domain), &|c| libm::scalbn(c, 10 - exponent))
}

/// Integers from 0 to `cells`, by rounding; tried, not trusted.
fn on_grid(domain: &Domain, cells: f64) -> Domain {
    let Some(bounds) = domain.bounding_box() else { return domain.clone() };
    let side = (bounds.max.x - bounds.min.x).max(bounds.max.y - bounds.min.y);
    let place = |c: f64, low: f64| libm::round((c - low) / side * cells);
    let mut new = domain.clone();
    for p in &mut new.points {
        *p = Point2::new(place(p.x, bounds.min.x), place(p.y, bounds.min.y));
    }
    new
}

/// Moved so that the smallest coordinates are 0; rounding may spoil it, which the trial shows.
fn moved(domain: &Domain) -> Domain {
    let Some(bounds) = domain.bounding_box() else { return domain.clone() };
    let mut new = domain.clone();
    for p in &mut new.points {
        *p = Point2::new(p.x - bounds.min.x, p.y - bounds.min.y);
    }
    new
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::torture::generate::{Case, Selection};

    #[test]
    fn holes_of_a_loop_that_goes_go_with_it() {
        let selection = Selection { families: vec!["many-holes".into()], ..Selection::new(3) };
        let has_roles =
            |case: &Case| case.domain.loops.iter().skip(1).all(|l| l.role == LoopRole::HoleOf(0));
        let case = (0..20).filter_map(|i| selection.case(i)).find(has_roles).expect("most have");
        assert!(loops_left(&case.domain, &BTreeSet::from([0])).loops.is_empty());
    }

    #[test]
    fn shorter_numbers_are_shorter() {
        assert!(shorter(0.0).is_empty());
        assert!(shorter(123_456.75).contains(&123_456.0));
        assert!(shorter(1.0 + f64::EPSILON).contains(&1.0));
    }
}
