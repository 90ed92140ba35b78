//! Delta debugging: the smallest boundary that still gets the same verdict.
//!
//! Whole loops go first, then segments, points and vertices, then digits of coordinates. A
//! candidate counts only if its own verdict (valid, or invalid by the same rule) is unchanged, which
//! [`validate`] decides exactly, and if the mesher fails on it in the same way.
//!
//! Source: A. Zeller, R. Hildebrandt, Simplifying and isolating failure-inducing input, IEEE Trans.
//! Softw. Eng. 28 (2002); reduction to ever smaller chunks.

use super::generate::Claim;
use super::judge::Judgement;
use crate::domain::validate::validate;
use crate::domain::{Domain, LoopRole};
use crate::point::Point2;
use std::collections::{BTreeMap, BTreeSet};

/// A shrunk boundary and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Shrunk {
    /// The boundary.
    pub domain: Domain,
    /// Its verdict, from a run of its own.
    pub judgement: Judgement,
    /// How often the mesher was asked.
    pub trials: u32,
}

/// Shrinks a boundary on which a mesher fails. `ask` runs the mesher and judges its answer; it is
/// called at most `trials_max` times. `None` when even the first call does not fail as `known`.
///
/// # Complexity
/// At most `trials_max` runs; as many validations and a multiple of them in discarded candidates.
pub fn shrink(
    domain: &Domain,
    claim: Claim,
    known: &Judgement,
    trials_max: u32,
    ask: &mut dyn FnMut(&Domain) -> Judgement,
) -> Option<Shrunk> {
    let mut search = Search { claim, known, trials_max, trials: 1, ask, last: None };
    let judgement = (search.ask)(domain);
    if !judgement.is_like(known) {
        return None;
    }
    search.last = Some(judgement);
    let mut best = domain.clone();
    loop {
        let before = weight(&best);
        best = search.without_loops(best);
        best = search.without_segments(best);
        best = search.without_points(best);
        best = search.without_vertices(best);
        best = search.with_simple_coordinates(best);
        best = search.with_small_numbers(best);
        if weight(&best) >= before || search.is_over() {
            break;
        }
    }
    let (judgement, trials) = (search.last?, search.trials);
    Some(Shrunk { domain: best, judgement, trials })
}

/// What shrinking makes smaller: vertices, loops, then digits.
fn weight(domain: &Domain) -> (usize, usize, usize) {
    let digits = domain.points.iter().flat_map(|p| [p.x, p.y]);
    let digits = digits.map(|c| format!("{c:?}").len()).sum();
    let vertices = domain.edges().count() + domain.points.len();
    (vertices, domain.loops.len() + domain.segments.len(), digits)
}

/// Whether the boundary is what the claim says.
#[must_use]
pub fn keeps_claim(domain: &Domain, claim: Claim) -> bool {
    match (validate(domain), claim) {
        (Ok(_), Claim::Valid) => true,
        (Err(faults), Claim::Invalid(id)) => faults.iter().any(|fault| fault.id() == id),
        _ => false,
    }
}

struct Search<'a> {
    claim: Claim,
    known: &'a Judgement,
    trials_max: u32,
    trials: u32,
    ask: &'a mut dyn FnMut(&Domain) -> Judgement,
    last: Option<Judgement>,
}

impl Search<'_> {
    fn is_over(&self) -> bool {
        self.trials >= self.trials_max
    }

    /// Whether the mesher fails on a candidate just so.
    fn fails(&mut self, candidate: &Domain) -> bool {
        if self.is_over() || !keeps_claim(candidate, self.claim) {
            return false;
        }
        self.trials += 1;
        let judgement = (self.ask)(candidate);
        let is_like = judgement.is_like(self.known);
        if is_like {
            self.last = Some(judgement);
        }
        is_like
    }

    /// Leaves out as many of `items` as it can, in chunks of half, a quarter, ... one.
    fn reduce(
        &mut self,
        best: Domain,
        items: usize,
        without: &dyn Fn(&Domain, &BTreeSet<usize>) -> Domain,
    ) -> Domain {
        let mut kept: Vec<usize> = (0..items).collect();
        let (mut gone, mut shrunk) = (BTreeSet::new(), best.clone());
        let mut chunk = items.div_ceil(2);
        while chunk > 0 && !self.is_over() {
            let mut at = 0;
            while at < kept.len() {
                let end = (at + chunk).min(kept.len());
                let more: BTreeSet<usize> =
                    gone.iter().copied().chain(kept[at..end].iter().copied()).collect();
                let candidate = without(&best, &more);
                if self.fails(&candidate) {
                    (gone, shrunk) = (more, candidate);
                    kept.drain(at..end);
                } else {
                    at = end;
                }
            }
            chunk /= 2;
        }
        shrunk
    }

    fn without_loops(&mut self, best: Domain) -> Domain {
        let count = best.loops.len();
        self.reduce(best, count, &loops_left)
    }

    fn without_segments(&mut self, best: Domain) -> Domain {
        let count = best.segments.len();
        self.reduce(best, count, &|domain, gone| {
            let mut left = domain.clone();
            let mut index = 0..;
            left.segments.retain(|_| !index.next().is_some_and(|i| gone.contains(&i)));
            compacted(&left, &isolated(domain))
        })
    }

    fn without_points(&mut self, best: Domain) -> Domain {
        let alone: Vec<usize> = isolated(&best).into_iter().collect();
        self.reduce(best, alone.len(), &|domain, gone| {
            let kept = (0..alone.len()).filter(|i| !gone.contains(i)).map(|i| alone[i]).collect();
            compacted(domain, &kept)
        })
    }

    fn without_vertices(&mut self, best: Domain) -> Domain {
        let count = best.loops.iter().map(|l| l.vertices.len()).sum();
        self.reduce(best, count, &|domain, gone| {
            let mut left = domain.clone();
            let mut index = 0..;
            for of in &mut left.loops {
                of.vertices.retain(|_| !index.next().is_some_and(|i| gone.contains(&i)));
                of.markers.truncate(of.vertices.len());
            }
            compacted(&left, &isolated(domain))
        })
    }

    /// Tries simpler coordinates for all points at once, the simplest first.
    fn with_simple_coordinates(&mut self, best: Domain) -> Domain {
        let coarse = (1..25).map(|bits| on_grid(&best, f64::from(1u32 << bits)));
        let fine = [unit(&best), moved(&best)];
        let mut candidates = std::iter::once(ranks(&best)).chain(coarse).chain(fine);
        let simple =
            candidates.find(|candidate| weight(candidate) < weight(&best) && self.fails(candidate));
        let mut best = simple.unwrap_or(best);
        for digits in 1..16 {
            let candidate = mapped(&best, &|c| rounded(c, digits));
            if weight(&candidate) < weight(&best) && self.fails(&candidate) {
                best = candidate;
                break;
            }
        }
        best
    }

    /// Tries a shorter number for one coordinate after the other.
    fn with_small_numbers(&mut self, mut best: Domain) -> Domain {
        for i in 0..best.points.len() {
            for axis in 0..2 {
                let old = <[f64; 2]>::from(best.points[i])[axis];
                for new in shorter(old) {
                    let mut candidate = best.clone();
                    let mut point = <[f64; 2]>::from(candidate.points[i]);
                    point[axis] = new;
                    candidate.points[i] = point.into();
                    if self.fails(&candidate) {
                        best = candidate;
                        break;
                    }
                }
            }
        }
        best
    }
}

/// Numbers that print shorter than `c`, the simplest first.
fn shorter(c: f64) -> Vec<f64> {
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
fn rounded(c: f64, digits: usize) -> f64 {
    format!("{c:.*e}", digits - 1).parse().unwrap_or(c)
}

/// Points that no loop and no segment uses.
fn isolated(domain: &Domain) -> BTreeSet<usize> {
    let used: BTreeSet<usize> = domain.edges().flatten().map(|v| v as usize).collect();
    (0..domain.points.len()).filter(|i| !used.contains(i)).collect()
}

/// Without points that are neither used nor among `kept`, and without places in a file.
fn compacted(domain: &Domain, kept: &BTreeSet<usize>) -> Domain {
    let used: BTreeSet<usize> = domain.edges().flatten().map(|v| v as usize).collect();
    let all: Vec<usize> =
        (0..domain.points.len()).filter(|i| used.contains(i) || kept.contains(i)).collect();
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
fn loops_left(domain: &Domain, gone: &BTreeSet<usize>) -> Domain {
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
    compacted(&left, &isolated(domain))
}

fn mapped(domain: &Domain, of: &dyn Fn(f64) -> f64) -> Domain {
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
    use crate::torture::judge::{Answer, Demands, judge};

    fn verdict(domain: &Domain, claim: Claim, answer: &Answer) -> Judgement {
        judge(domain, claim, answer, &Demands::default())
    }

    /// A mesher that refuses whatever has at least two loops.
    fn refuses_holes(domain: &Domain) -> Judgement {
        let answer = match domain.loops.len() {
            0 | 1 => Answer::Crash("not this time".into()),
            _ => Answer::Refused("two loops".into()),
        };
        verdict(domain, Claim::Valid, &answer)
    }

    // spec: R4
    #[test]
    fn what_is_left_of_a_plate_is_two_triangles() {
        let selection = Selection { families: vec!["many-holes".into()], ..Selection::new(3) };
        let case = selection.case(1).expect("a family");
        assert!(case.domain.loops.len() > 2);
        let known = refuses_holes(&case.domain);
        let shrunk =
            shrink(&case.domain, case.claim, &known, 3000, &mut refuses_holes).expect("it fails");
        assert_eq!(shrunk.domain.loops.len(), 2);
        assert!(shrunk.domain.points.len() <= 6, "{:?}", shrunk.domain);
        assert!(keeps_claim(&shrunk.domain, Claim::Valid));
        assert!(shrunk.judgement.is_like(&known));
        let largest = shrunk.domain.points.iter().flat_map(|p| [p.x, p.y]).fold(0.0, f64::max);
        assert!(largest <= 100.0, "coordinates are small integers: {:?}", shrunk.domain.points);
    }

    // spec: R4
    #[test]
    fn an_invalid_boundary_keeps_its_fault() {
        let selection = Selection { families: vec!["spike".into()], ..Selection::new(5) };
        let case = selection.case(2).expect("a family");
        let mut accepts = |domain: &Domain| {
            let mesh = crate::mesh::MeshData { triangles: vec![[0, 1, 2]], ..Default::default() };
            verdict(domain, case.claim, &Answer::Mesh(Box::new(mesh)))
        };
        let known = accepts(&case.domain);
        let shrunk = shrink(&case.domain, case.claim, &known, 500, &mut accepts).expect("it fails");
        assert_eq!(case.claim, Claim::Invalid("D6"));
        assert!(keeps_claim(&shrunk.domain, case.claim));
        assert!(shrunk.domain.points.len() <= 4, "{:?}", shrunk.domain);
    }

    // spec: R4
    #[test]
    fn a_failure_that_does_not_come_back_is_not_shrunk() {
        let case = crate::torture::generate::case(1, 0);
        let known = verdict(&case.domain, Claim::Valid, &Answer::Hang("once".into()));
        let mut passes =
            |domain: &Domain| verdict(domain, Claim::Valid, &Answer::Refused(String::new()));
        assert_eq!(shrink(&case.domain, case.claim, &known, 100, &mut passes), None);
    }

    // spec: R4
    #[test]
    fn the_mesher_is_not_asked_more_often_than_allowed() {
        let case = crate::torture::generate::case(1, 1);
        let known = verdict(&case.domain, Claim::Valid, &Answer::Refused(String::new()));
        let mut asked = 0;
        let mut refuses = |domain: &Domain| {
            asked += 1;
            verdict(domain, Claim::Valid, &Answer::Refused(String::new()))
        };
        let shrunk = shrink(&case.domain, case.claim, &known, 7, &mut refuses).expect("it fails");
        assert_eq!((shrunk.trials, asked), (7, 7));
    }

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
