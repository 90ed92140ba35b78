//! Against rational and integer arithmetic, over near-degenerate inputs and the whole exponent range.

use std::collections::BTreeMap;

use trigrade::predicates::{
    Rung, Sign, incircle, incircle_by_every_rung, incircle_perturbed, incircle_with_rung, orient2d,
    orient2d_by_every_rung, orient2d_with_rung,
};

use crate::oracle;
use crate::samples::{Quad, Random, every_class};

/// Checks both predicates, by every rung that can answer, and the perturbed one, against the true
/// signs of `orient2d` and `incircle`.
fn check(class: &str, quad: Quad, (side, inside): (Sign, Sign)) {
    let [a, b, c, d] = quad;
    assert_eq!(orient2d(a, b, c), side, "orient2d, {class}: {quad:?}");
    for (sign, rung) in orient2d_by_every_rung(a, b, c) {
        assert_eq!(sign, side, "orient2d by {rung:?}, {class}: {quad:?}");
    }
    assert_eq!(incircle(a, b, c, d), inside, "incircle, {class}: {quad:?}");
    for (sign, rung) in incircle_by_every_rung(a, b, c, d) {
        assert_eq!(sign, inside, "incircle by {rung:?}, {class}: {quad:?}");
    }
    if inside != Sign::Zero {
        assert_eq!(incircle_perturbed(a, b, c, d), inside, "perturbed, {class}: {quad:?}");
    }
}

#[derive(Debug, Default)]
struct Tally {
    cases: usize,
    zeros: usize,
    orient2d: BTreeMap<Rung, usize>,
    incircle: BTreeMap<Rung, usize>,
}

/// Checks `rounds` samples of each class.
fn check_rounds(seed: u64, rounds: usize, truth: impl Fn(Quad) -> (Sign, Sign)) -> Tally {
    let mut random = Random::new(seed);
    let mut tally = Tally::default();
    for (class, quad) in (0..rounds).flat_map(|_| every_class(&mut random)) {
        let [a, b, c, d] = quad;
        let signs = truth(quad);
        check(class, quad, signs);
        tally.cases += 1;
        tally.zeros += usize::from(signs.1 == Sign::Zero);
        *tally.orient2d.entry(orient2d_with_rung(a, b, c).1).or_insert(0) += 1;
        *tally.incircle.entry(incircle_with_rung(a, b, c, d).1).or_insert(0) += 1;
    }
    tally
}

// spec: P1 P2 P4
#[test]
fn every_rung_agrees_with_rational_arithmetic() {
    let tally = check_rounds(1, 100, |quad| {
        let [a, b, c, d] = quad;
        let signs = (oracle::orient2d(a, b, c), oracle::incircle(a, b, c, d));
        assert_eq!(oracle::on_lattice(quad), signs, "the oracles: {quad:?}");
        signs
    });
    assert!(tally.cases > 2_000, "{tally:?}");
}

// spec: P1 P2 P4
#[test]
fn every_rung_agrees_with_big_integers() {
    let tally = check_rounds(6, 1_000, oracle::on_lattice);
    assert!(tally.zeros * 20 > tally.cases, "the samples are not degenerate enough: {tally:?}");
    for rung in [Rung::Filter, Rung::Fixed128, Rung::Fixed256, Rung::Fixed512, Rung::Exact] {
        let enough = |n: &usize| n * 500 > tally.cases;
        assert!(tally.incircle.get(&rung).is_some_and(enough), "{rung:?} hardly used: {tally:?}");
    }
}

// spec: P1 P2 P4
#[test]
#[ignore = "a minute: cargo test --release --test predicates -- --ignored --nocapture"]
fn a_million_cases_agree_with_big_integers() {
    let tally = check_rounds(2, 36_000, oracle::on_lattice);
    println!("{tally:?}");
    assert!(tally.cases >= 1_000_000, "{tally:?}");
}
