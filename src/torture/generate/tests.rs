//! Claims against the validator.

use super::*;
use crate::domain::validate::validate;
use std::collections::BTreeSet;

/// Whether the validator agrees with a claim; it may name further faults that follow.
fn agrees(case: &Case) -> Result<(), String> {
    let found = validate(&case.domain).map(|_| ()).map_err(|faults| {
        faults.iter().map(|fault| (fault.id(), fault.to_string())).collect::<Vec<_>>()
    });
    let holds = match (&case.claim, &found) {
        (Claim::Valid, Ok(())) => true,
        (Claim::Invalid(id), Err(faults)) => faults.iter().any(|fault| fault.0 == *id),
        _ => false,
    };
    let told = || format!("{} {} ({}): {found:?}", case.family, case.index, case.dress);
    holds.then_some(()).ok_or_else(told)
}

// spec: R1
#[test]
fn every_claim_holds_for_the_validator() {
    let wrong: Vec<String> = (0..4000).filter_map(|index| agrees(&case(20, index)).err()).collect();
    assert!(
        wrong.is_empty(),
        "{} of 4000; the first: {:?}",
        wrong.len(),
        &wrong[..wrong.len().min(8)]
    );
}

// spec: R2
#[test]
fn a_case_depends_on_seed_and_number_only() {
    for index in (0..400).rev() {
        assert_eq!(case(3, index), case(3, index));
    }
    assert_ne!(case(3, 5).domain, case(4, 5).domain);
}

// spec: R2
#[test]
fn the_first_cases_never_change() {
    let mut sum = Prng::new(0).next();
    for index in 0..500 {
        let case = case(1, index);
        for p in &case.domain.points {
            sum = sum.rotate_left(5) ^ p.key()[0] ^ p.key()[1].rotate_left(32);
        }
    }
    assert_eq!(
        sum, 3_434_603_054_367_954_429,
        "the generators changed: reproducers by seed and number are void"
    );
}

#[test]
fn all_families_and_dresses_come_up() {
    let cases: Vec<Case> = (0..2000).map(|index| case(9, index)).collect();
    let seen: BTreeSet<&str> = cases.iter().map(|case| case.family).collect();
    assert_eq!(seen.len(), families().count(), "names differ and all take turns");
    let seen: BTreeSet<&str> = cases.iter().map(|case| case.dress).collect();
    assert_eq!(seen, DRESSES.into_iter().collect());
}

#[test]
fn a_selection_draws_only_what_is_asked_for() {
    let selection = Selection {
        families: vec!["gaps".into(), "spike".into()],
        plain: true,
        ..Selection::new(1)
    };
    for index in 0..40 {
        let case = selection.case(index).expect("two families");
        assert!(["gaps", "spike"].contains(&case.family));
        assert_eq!(case.dress, "plain");
        assert!(agrees(&case).is_ok());
    }
    let none = Selection { families: vec!["no such".into()], ..Selection::new(1) };
    assert!(none.case(0).is_none());
}

#[test]
fn thousands_of_holes_and_lengths_of_1e12_come_up() {
    let most = (0..8000).map(|index| case(2, index).domain.loops.len()).max();
    assert!(most > Some(1000), "{most:?}");
    let ratio = |domain: &Domain| {
        let length =
            |[a, b]: [u32; 2]| domain.points[a as usize].distance(domain.points[b as usize]);
        let lengths: Vec<f64> = domain.edges().map(length).filter(|l| l.is_normal()).collect();
        let most = lengths.iter().copied().fold(0.0, f64::max);
        most / lengths.iter().copied().fold(f64::MAX, f64::min)
    };
    let most = (0..2000).map(|index| ratio(&case(2, index).domain)).fold(0.0, f64::max);
    assert!(most > 1e12, "{most}");
}
