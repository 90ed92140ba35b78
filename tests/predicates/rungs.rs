//! Which rung answers what.

use trigrade::point::Point2;
use trigrade::predicates::{
    Rung, Sign, incircle, incircle_perturbed, incircle_with_rung, orient2d, orient2d_with_rung,
};

use crate::oracle;
use crate::samples::{Quad, scaled};

fn quad(points: [[f64; 2]; 4]) -> Quad {
    points.map(Point2::from)
}

fn incircle_of([a, b, c, d]: Quad) -> (Sign, Rung) {
    incircle_with_rung(a, b, c, d)
}

fn orient2d_of([a, b, c, _]: Quad) -> (Sign, Rung) {
    orient2d_with_rung(a, b, c)
}

fn square(x: f64, y: f64) -> Quad {
    quad([[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]])
}

// spec: P5
#[test]
fn easy_questions_stay_on_the_filter() {
    let easy = quad([[0.1, 0.2], [1.3, 0.4], [0.6, 1.7], [0.5, 0.5]]);
    assert_eq!(incircle_of(easy), (Sign::Positive, Rung::Filter));
    assert_eq!(orient2d_of(easy), (Sign::Positive, Rung::Filter));
    let outside = quad([[0.1, 0.2], [1.3, 0.4], [0.6, 1.7], [9.5, 0.5]]);
    assert_eq!(incircle_of(outside), (Sign::Negative, Rung::Filter));
}

// spec: P5
#[test]
fn ties_on_integer_grids_take_128_bits() {
    for corner in [0.0, 999.0, -123_456.0, 4_503_599_627_370_496.0] {
        assert_eq!(incircle_of(square(corner, corner)), (Sign::Zero, Rung::Fixed128), "{corner}");
    }
    let line = quad([[0.0, 0.0], [3.0, 1.0], [6.0, 2.0], [0.0, 0.0]]);
    assert_eq!(orient2d_of(line), (Sign::Zero, Rung::Fixed128));
}

// spec: P5
#[test]
fn grids_times_a_tenth_take_256_bits() {
    let tenths = square(531.0, 77.0).map(|p| Point2::new(p.x * 0.1, p.y * 0.1));
    let (sign, rung) = incircle_of(tenths);
    assert_eq!(rung, Rung::Fixed256);
    assert_eq!(sign, oracle::incircle(tenths[0], tenths[1], tenths[2], tenths[3]));
}

// spec: P5
#[test]
fn points_on_a_circle_take_256_bits_or_512_near_an_axis() {
    let circle = |angles: [f64; 4]| angles.map(|t| Point2::new(libm::cos(t), libm::sin(t)));
    let spread = circle([0.3, 1.1, 2.4, 4.0]);
    let (sign, rung) = incircle_of(spread);
    assert_eq!(rung, Rung::Fixed256);
    assert_eq!(sign, oracle::incircle(spread[0], spread[1], spread[2], spread[3]));
    let near_axis = circle([0.000_01, 1.1, 2.4, 4.0]);
    let (sign, rung) = incircle_of(near_axis);
    assert_eq!(rung, Rung::Fixed512);
    assert_eq!(sign, oracle::incircle(near_axis[0], near_axis[1], near_axis[2], near_axis[3]));
}

/// A square and a spoiler: a side moved by less than any lattice of 126 bits can hold.
fn square_off_by(tiny: f64) -> Quad {
    quad([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [tiny, 1.0]])
}

// spec: P5
#[test]
fn ordinary_exponents_too_far_apart_take_expansions() {
    for (tiny, sign) in [(-1e-40, Sign::Negative), (1e-40, Sign::Positive)] {
        assert_eq!(incircle_of(square_off_by(tiny)), (sign, Rung::Adaptive), "{tiny}");
    }
    let line = quad([[1e-40, 0.0], [1.0, 1.0], [2.0, 2.0], [0.0, 0.0]]);
    assert_eq!(orient2d_of(line), (Sign::Negative, Rung::Adaptive));
}

// spec: P5
#[test]
fn exponents_beyond_the_range_of_expansions_take_the_accumulator() {
    for tiny in [1e-43, 1e-310, 5e-324] {
        assert_eq!(incircle_of(square_off_by(tiny)), (Sign::Positive, Rung::Exact), "{tiny}");
        assert_eq!(incircle_of(square_off_by(-tiny)), (Sign::Negative, Rung::Exact), "{tiny}");
        let huge = 1e300;
        let line = quad([[tiny, 0.0], [huge, huge], [-huge, -huge], [0.0, 0.0]]);
        assert_eq!(orient2d_of(line), (Sign::Positive, Rung::Exact), "{tiny}");
    }
}

// spec: P4
#[test]
fn the_ranges_where_expansions_fail_are_decided_exactly() {
    // Corners and a centre of a square whose fourth corner is off by one part in 2^50 either way.
    let off = 2.0_f64.powi(-50);
    for exponent in [-1000, -300, -230, -219, -218, -217, 0, 251, 252, 253, 300, 1000] {
        for (sign, delta) in [(Sign::Positive, -off), (Sign::Zero, 0.0), (Sign::Negative, off)] {
            let [a, b, c, _] = square(0.0, 0.0);
            let d = Point2::new(0.0, 1.0 + delta);
            let scaled = scaled([a, b, c, d], exponent);
            assert_eq!(incircle_of(scaled).0, sign, "2^{exponent}, {delta}");
        }
    }
}

// spec: P4
#[test]
fn expansions_really_fail_outside_their_range() {
    let inside = square_off_by(2.0_f64.powi(-50));
    let [a, b, c, d] = scaled(inside, -260).map(robust_coord);
    assert!(robust::incircle(a, b, c, d) <= 0.0, "the lower guard could be dropped");
    let [a, b, c, d] = scaled(inside, 257).map(robust_coord);
    assert!(robust::incircle(a, b, c, d).is_nan(), "the upper guard could be dropped");
    for exponent in [-260, 257] {
        assert_eq!(incircle_of(scaled(inside, exponent)).0, Sign::Positive, "2^{exponent}");
    }
}

fn robust_coord(p: Point2) -> robust::Coord<f64> {
    robust::Coord { x: p.x, y: p.y }
}

// spec: P4
#[test]
fn huge_and_tiny_grids_keep_their_ties() {
    for exponent in [-1074, -1073, -1030, -1022, -500, 500, 960, 1022] {
        let square = scaled(square(0.0, 0.0), exponent);
        // A subnormal counts as wide as the least normal number, 53 bits above the last.
        let rung = if exponent < -1044 { Rung::Fixed256 } else { Rung::Fixed128 };
        assert_eq!(incircle_of(square), (Sign::Zero, rung), "2^{exponent}");
        let [a, b, c, d] = square;
        assert_eq!(incircle_perturbed(a, b, c, d), Sign::Positive, "2^{exponent}");
        assert_eq!(orient2d(a, b, c), Sign::Positive, "2^{exponent}");
    }
}

// spec: P4
#[test]
fn differences_that_overflow_are_decided_exactly() {
    let m = f64::MAX;
    let square = quad([[-m, -m], [m, -m], [m, m], [-m, m]]);
    assert_eq!(incircle_of(square), (Sign::Zero, Rung::Exact));
    assert_eq!(orient2d_of(square), (Sign::Positive, Rung::Exact));
    let less = quad([[-m, -m], [m, -m], [m, m], [-m, m.next_down()]]);
    assert_eq!(incircle_of(less), (Sign::Positive, Rung::Exact));
}

// spec: P4
#[test]
fn coordinates_that_are_not_finite_do_not_panic() {
    let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, 1e300, 5e-324];
    for code in 0..odd.len().pow(4) {
        let at = |i: u32| odd[code / odd.len().pow(i) % odd.len()];
        let [a, b, c] = [[at(0), at(1)], [at(2), at(3)], [at(1), at(2)]].map(Point2::from);
        let d = Point2::new(at(3), at(0));
        let _some_sign = (orient2d(a, b, c), incircle(a, b, c, d), incircle_perturbed(a, b, c, d));
    }
}
