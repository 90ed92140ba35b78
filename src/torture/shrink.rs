//! Delta debugging: the smallest boundary that still gets the same verdict.
//!
//! Whole loops go first, then segments, points and vertices, then digits of coordinates. A
//! candidate counts only if its own verdict (valid, or invalid by the same rule) is unchanged, which
//! [`validate`] decides exactly, and if the mesher fails on it in the same way.
//!
//! Source: A. Zeller, R. Hildebrandt, Simplifying and isolating failure-inducing input, IEEE Trans.
//! Softw. Eng. 28 (2002); reduction to ever smaller chunks.

mod candidates;
mod edits;

pub use candidates::candidates;

use super::generate::Claim;
use super::judge::Judgement;
use crate::domain::Domain;
use crate::domain::validate::validate;
use edits::{
    loops_left, mapped, points_left, rounded, segments_left, shorter, simple_coordinates, vertices,
    vertices_left, weight, with_number,
};
use std::collections::BTreeSet;

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
        self.reduce(best, count, &segments_left)
    }

    fn without_points(&mut self, best: Domain) -> Domain {
        let count = best.isolated_points().len();
        self.reduce(best, count, &points_left)
    }

    fn without_vertices(&mut self, best: Domain) -> Domain {
        let count = vertices(&best);
        self.reduce(best, count, &vertices_left)
    }

    /// Tries simpler coordinates for all points at once, the simplest first.
    fn with_simple_coordinates(&mut self, best: Domain) -> Domain {
        let mut candidates = simple_coordinates(&best);
        let simple =
            candidates.find(|candidate| weight(candidate) < weight(&best) && self.fails(candidate));
        drop(candidates);
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
                    let candidate = with_number(&best, i, axis, new);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::torture::generate::Selection;
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
}
