//! Sign algebra: permutations, scaling, translation.

use proptest::prelude::*;
use quickcheck::{TestResult, quickcheck};
use trigrade::point::Point2;
use trigrade::predicates::{Sign, incircle, incircle_perturbed, orient2d};

use crate::oracle::permutations;
use crate::samples::scaled;

fn point() -> impl Strategy<Value = Point2> {
    prop_oneof![
        (-8..8_i32, -8..8_i32).prop_map(|(x, y)| Point2::new(f64::from(x), f64::from(y))),
        (-8..8_i32, -8..8_i32)
            .prop_map(|(x, y)| Point2::new(f64::from(x) * 0.1, f64::from(y) * 0.1)),
        (-1.0..1.0, -1.0..1.0).prop_map(|(x, y)| Point2::new(x, y)),
        (finite(), finite()).prop_map(|(x, y)| Point2::new(x, y)),
    ]
}

fn finite() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |v| v.is_finite())
}

fn with_parity(odd: bool, sign: Sign) -> Sign {
    if odd { sign.reversed() } else { sign }
}

/// Checks the law of permutations for a predicate of four points.
fn obeys_permutations(quad: [Point2; 4], predicate: impl Fn([Point2; 4]) -> Sign) -> bool {
    let sign = predicate(quad);
    permutations()
        .into_iter()
        .all(|(odd, p)| predicate(p.map(|i| quad[i])) == with_parity(odd, sign))
}

proptest! {
    // spec: P3
    #[test]
    fn orient2d_obeys_permutations(a in point(), b in point(), c in point()) {
        let sign = orient2d(a, b, c);
        prop_assert_eq!(orient2d(b, c, a), sign);
        prop_assert_eq!(orient2d(c, a, b), sign);
        prop_assert_eq!(orient2d(b, a, c), sign.reversed());
        prop_assert_eq!(orient2d(a, c, b), sign.reversed());
        prop_assert_eq!(orient2d(c, b, a), sign.reversed());
    }

    // spec: P3 P7
    #[test]
    fn incircle_obeys_permutations(a in point(), b in point(), c in point(), d in point()) {
        prop_assert!(obeys_permutations([a, b, c, d], |[a, b, c, d]| incircle(a, b, c, d)));
        prop_assert!(obeys_permutations([a, b, c, d], |[a, b, c, d]| incircle_perturbed(a, b, c, d)));
    }

    // spec: P3
    #[test]
    fn powers_of_two_change_no_sign(
        quad in [(-99..99_i64, -99..99_i64), (-99..99, -99..99), (-99..99, -99..99), (-99..99, -99..99)],
        exponent in -1074..1010_i32,
    ) {
        let quad = quad.map(|(x, y)| Point2::new(x as f64, y as f64));
        let ([a, b, c, d], [e, f, g, h]) = (quad, scaled(quad, exponent));
        prop_assert_eq!(orient2d(a, b, c), orient2d(e, f, g));
        prop_assert_eq!(incircle(a, b, c, d), incircle(e, f, g, h));
        prop_assert_eq!(incircle_perturbed(a, b, c, d), incircle_perturbed(e, f, g, h));
    }

    // spec: P3
    #[test]
    fn quarter_turns_change_no_sign_and_mirrors_reverse_it(
        a in point(), b in point(), c in point(), d in point(),
    ) {
        let [e, f, g, h] = [a, b, c, d].map(|p| Point2::new(-p.y, p.x));
        prop_assert_eq!(orient2d(a, b, c), orient2d(e, f, g));
        prop_assert_eq!(incircle(a, b, c, d), incircle(e, f, g, h));
        let [e, f, g, h] = [a, b, c, d].map(|p| Point2::new(-p.x, p.y));
        prop_assert_eq!(orient2d(a, b, c), orient2d(e, f, g).reversed());
        prop_assert_eq!(incircle(a, b, c, d), incircle(e, f, g, h).reversed());
    }

    // spec: P3
    #[test]
    fn a_repeated_point_is_always_a_tie(a in point(), b in point(), c in point()) {
        prop_assert_eq!(orient2d(a, b, a), Sign::Zero);
        prop_assert_eq!(orient2d(a, b, b), Sign::Zero);
        for d in [a, b, c] {
            prop_assert_eq!(incircle(a, b, c, d), Sign::Zero);
            prop_assert_eq!(incircle_perturbed(a, b, c, d), Sign::Zero);
        }
    }
}

type Node = (i32, i32);

fn moved((x, y): Node, (dx, dy): (i64, i64)) -> Point2 {
    Point2::new((i64::from(x) + dx) as f64, (i64::from(y) + dy) as f64)
}

quickcheck! {
    // spec: P3
    fn exact_translations_change_no_sign(nodes: (Node, Node, Node, Node), by: Node) -> bool {
        // Sums of 32-bit integers and 2^20 multiples of them stay below 2^53: exact.
        let by = (i64::from(by.0) << 20, i64::from(by.1) << 20);
        let quad = [nodes.0, nodes.1, nodes.2, nodes.3];
        let [a, b, c, d] = quad.map(|node| moved(node, (0, 0)));
        let [e, f, g, h] = quad.map(|node| moved(node, by));
        orient2d(a, b, c) == orient2d(e, f, g)
            && incircle(a, b, c, d) == incircle(e, f, g, h)
            && incircle_perturbed(a, b, c, d) == incircle_perturbed(e, f, g, h)
    }

    // spec: P3
    fn orient2d_is_antisymmetric_for_any_floats(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> TestResult {
        let [a, b, c] = [a, b, c].map(|(x, y)| Point2::new(x, y));
        if ![a, b, c].iter().all(|p| p.is_finite()) {
            return TestResult::discard();
        }
        TestResult::from_bool(orient2d(a, b, c) == orient2d(b, a, c).reversed()
            && orient2d(a, b, c) == orient2d(b, c, a))
    }

    // spec: P3 P7
    fn incircle_obeys_permutations_on_a_lattice(nodes: (u8, u8, u8, u8)) -> bool {
        let node = |code: u8| Point2::new(f64::from(code / 16), f64::from(code % 16));
        let quad = [node(nodes.0), node(nodes.1), node(nodes.2), node(nodes.3)];
        obeys_permutations(quad, |[a, b, c, d]| incircle(a, b, c, d))
            && obeys_permutations(quad, |[a, b, c, d]| incircle_perturbed(a, b, c, d))
    }
}
