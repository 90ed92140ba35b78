//! The boundaries of torture as values of proptest, quickcheck and arbitrary, used on this crate's
//! own mesher and on meshers that err on purpose.

use arbitrary::{Arbitrary, Unstructured};
use proptest::strategy::{Strategy as _, ValueTree as _};
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner};
use quickcheck::Arbitrary as _;
use trigrade::domain::Domain;
use trigrade::mesh::MeshData;
use trigrade::mesher::{MeshError, Options, Unobserved, mesh_domain};
use trigrade::torture::generate::{Case, Claim, Selection};
use trigrade::torture::judge::{Answer, Demands, judge};
use trigrade::torture::shrink::keeps_claim;
use trigrade::torture::strategy::proptest::cases;

fn ours(domain: &Domain) -> Answer {
    match mesh_domain(domain, &Options::default(), &mut Unobserved) {
        Ok(meshed) => Answer::Mesh(Box::new(MeshData::from(&meshed.mesh))),
        Err(error @ MeshError::TooMany { .. }) => Answer::Limit(error.to_string()),
        Err(error) => Answer::Refused(error.to_string()),
    }
}

/// What is wrong with this crate's mesh of a case.
fn complaint(case: &Case) -> Option<String> {
    let judgement = judge(&case.domain, case.claim, &ours(&case.domain), &Demands::default());
    judgement.class.is_failure().then_some(judgement.reason)
}

fn small() -> Selection {
    Selection { size_max: 40, ..Selection::new(0) }
}

/// A runner of proptest whose cases are the same each time.
fn runner(cases: u32) -> TestRunner {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

/// A mesher that gives up where the domain has a hole.
fn copes(case: &Case) -> bool {
    case.claim != Claim::Valid || case.domain.loops.len() < 2
}

// spec: R10 R13
#[test]
fn proptest_finds_nothing_wrong_with_our_meshes() {
    let outcome = runner(60).run(&cases(small()), |case| {
        complaint(&case).map_or(Ok(()), |reason| Err(TestCaseError::fail(reason)))
    });
    outcome.expect("no boundary is meshed wrongly");
}

// spec: R13
#[test]
fn proptest_shrinks_to_two_triangles() {
    let outcome = runner(200).run(&cases(small()), |case| match copes(&case) {
        true => Ok(()),
        false => Err(TestCaseError::fail("a hole")),
    });
    let Err(TestError::Fail(_, case)) = outcome else { panic!("holes are drawn: {outcome:?}") };
    assert_eq!(case.domain.loops.len(), 2);
    assert!(case.domain.loops.iter().all(|l| l.vertices.len() == 3), "{:?}", case.domain);
    assert!(keeps_claim(&case.domain, Claim::Valid));
}

// spec: R13
#[test]
fn a_tree_goes_back_to_the_simplest_failure() {
    let mut runner = TestRunner::deterministic();
    let selection = Selection { families: vec!["grid".into()], ..small() };
    let mut tree = cases(selection).new_tree(&mut runner).expect("a family is selected");
    let first = tree.current();
    // Everything fails but what is simpler than the first step.
    assert!(tree.simplify());
    let best = tree.current();
    assert_ne!(best, first);
    assert!(tree.simplify());
    while tree.complicate() {}
    assert_eq!(tree.current(), best);
    assert!(!tree.complicate(), "there is nothing left to try");
}

// spec: R13
#[test]
fn a_selection_of_no_family_is_refused() {
    let nothing = Selection { families: vec!["no such".into()], ..small() };
    assert!(cases(nothing).new_tree(&mut TestRunner::deterministic()).is_err());
}

// spec: R10 R13
#[test]
fn quickcheck_finds_nothing_wrong_with_our_meshes() {
    fn is_meshed_well(case: Case) -> bool {
        complaint(&case).is_none()
    }
    quickcheck::QuickCheck::new()
        .rng(quickcheck::Gen::from_size_and_seed(4, 2024))
        .tests(60)
        .quickcheck(is_meshed_well as fn(Case) -> bool);
}

// spec: R13
#[test]
fn what_quickcheck_shrinks_to_keeps_the_claim() {
    let mut source = quickcheck::Gen::from_size_and_seed(4, 9);
    for _ in 0..40 {
        let case = <Case as quickcheck::Arbitrary>::arbitrary(&mut source);
        assert!(keeps_claim(&case.domain, case.claim), "{}", case.family);
        for simpler in case.shrink().take(10) {
            assert_eq!((simpler.family, simpler.claim), (case.family, case.claim));
            assert!(keeps_claim(&simpler.domain, case.claim), "{}", case.family);
            assert_ne!(simpler.domain, case.domain);
        }
    }
}

// spec: R13
#[test]
fn any_nine_bytes_are_a_boundary() {
    for byte in 0..=255u8 {
        let bytes = [byte, 1, 2, 3, 4, 5, 6, 7, byte];
        let case = <Case as Arbitrary>::arbitrary(&mut Unstructured::new(&bytes))
            .expect("nine bytes will do");
        assert!(keeps_claim(&case.domain, case.claim), "{}", case.family);
    }
    let hint = <Case as Arbitrary>::size_hint(0);
    assert_eq!(hint, (9, Some(9)));
}
