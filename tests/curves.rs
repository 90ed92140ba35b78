//! Curves against their laws, and their nodes against closed forms.

use std::f64::consts::{PI, TAU};
use trigrade::curve::discretize::{
    DiscretizeError, Rule, by_spacing, chord_error, edge_lengths, length, nodes, points,
    spacing_for_chord, spacing_for_triangles,
};
use trigrade::curve::{Curve, CurveError, CurveJet};
use trigrade::vector::{Vector, distance, norm, scale, sub};

fn wave() -> Curve {
    let points = [[0.0, 0.0], [1.0, 2.0], [2.0, -1.0], [4.0, 1.0], [5.0, 0.0], [6.0, 3.0]];
    Curve::clamped(3, points.map(|[x, y]| [x, y, 0.5 * x]).to_vec()).expect("a curve")
}

fn unit_circle() -> Curve {
    Curve::circle([0.0; 3], [0.0, 0.0, 2.0], [1.0, 0.0, 0.0]).expect("a circle")
}

fn assert_near(a: Vector, b: Vector, tolerance: f64) {
    assert!(distance(a, b) <= tolerance, "{a:?} against {b:?}");
}

// spec: S1
#[test]
fn derivatives_agree_with_differences() {
    let step = 1e-5;
    let weighted = Curve::new(
        2,
        vec![0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0],
        vec![[0.0; 3], [1.0, 2.0, 0.0], [3.0, 1.0, 1.0], [4.0, 0.0, 0.0]],
        vec![1.0, 0.3, 2.0, 1.5],
    )
    .expect("a NURBS curve");
    for curve in [wave(), unit_circle(), weighted] {
        let [start, end] = curve.domain();
        for i in 1..40 {
            let t = start + (end - start) * (f64::from(i) + 0.31) / 41.0;
            let [low, high] = [t - step, t + step].map(|t| curve.jet(t));
            let jet = curve.jet(t);
            assert_near(jet.point, curve.at(t), 1e-14);
            let slope = scale(0.5 / step, sub(high.point, low.point));
            assert_near(jet.first, slope, 1e-7 * (1.0 + norm(jet.first)));
            let bend = scale(0.5 / step, sub(high.first, low.first));
            assert_near(jet.second, bend, 1e-6 * (1.0 + norm(jet.second)));
        }
    }
}

// spec: S1
#[test]
fn a_circle_is_round_and_closed_to_the_bit() {
    let circle = unit_circle();
    for i in 0..=100 {
        let jet = circle.jet(f64::from(i) / 100.0);
        assert!((norm(jet.point) - 1.0).abs() < 1e-15);
        assert!((jet.curvature() - 1.0).abs() < 1e-12);
    }
    assert!(circle.is_closed());
    assert_eq!(circle.ends(), [[1.0, 0.0, 0.0]; 2]);
    assert!((length(&circle) - TAU).abs() < 1e-9);
}

// spec: S1
#[test]
fn arcs_have_exact_ends_and_pass_through_their_middle() {
    for (from, via, to) in [
        ([1.0, 0.0, 0.0], [0.6, 0.8, 0.0], [-1.0, 0.0, 0.0]),
        ([0.1, 0.7, 0.3], [2.0, 0.4, -1.0], [0.3, 0.1, 0.2]),
    ] {
        let arc = Curve::arc(from, via, to).expect("an arc");
        assert_eq!(arc.ends(), [from, to]);
        let nearest = (0..=20_000)
            .map(|i| distance(arc.at(f64::from(i) / 20_000.0), via))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-3, "{nearest}");
    }
    assert_eq!(Curve::arc([0.0; 3], [1.0; 3], [2.0; 3]), Err(CurveError::NoArc));
    assert_eq!(Curve::arc([0.0; 3], [0.0; 3], [2.0; 3]), Err(CurveError::NoArc));
}

// spec: S1
#[test]
fn a_periodic_curve_is_smooth_where_it_closes() {
    let points = (0..7).map(|i| {
        let angle = f64::from(i) * TAU / 7.0;
        [libm::cos(angle), libm::sin(angle), 0.1 * libm::cos(3.0 * angle)]
    });
    for degree in [1, 2, 3, 4] {
        let curve = Curve::periodic(degree, points.clone().collect()).expect("a closed curve");
        let [start, end] = curve.domain();
        assert!(curve.is_closed());
        assert_eq!(curve.at(start), curve.at(end));
        if degree > 1 {
            assert_near(curve.jet(start).first, curve.jet(end).first, 1e-13);
        }
    }
    let two = Curve::periodic(2, vec![[0.0; 3]; 2]);
    assert_eq!(two, Err(CurveError::TooFewPoints { points: 2, degree: 2 }));
}

// spec: S1
#[test]
fn a_reversed_curve_is_the_same_one_backwards() {
    let curve = wave();
    let back = curve.reversed();
    let [start, end] = curve.domain();
    for i in 0..=10 {
        let t = start + (end - start) * f64::from(i) / 10.0;
        assert_near(curve.at(t), back.at(start + end - t), 1e-13);
    }
    assert_eq!(curve.same_as(&curve), Some(false));
    assert_eq!(curve.same_as(&back), Some(true));
    let mut moved = curve.points().to_vec();
    moved[2][1] += 1e-15;
    assert_eq!(curve.same_as(&Curve::clamped(3, moved).expect("a curve")), None);
}

// spec: S1
#[test]
fn pieces_between_corners_are_the_curve() {
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0];
    let points = vec![[0.0; 3], [1.0, 1.0, 0.0], [2.0, 0.0, 0.0], [3.0, 2.0, 1.0], [4.0, 0.0, 0.0]];
    let curve = Curve::new(2, knots, points.clone(), vec![1.0, 2.0, 1.0, 0.5, 1.0]).expect("ok");
    assert_eq!(curve.corners(), [1.0]);
    let pieces = curve.pieces();
    assert_eq!(pieces.len(), 2);
    assert_eq!(pieces[0].ends(), [points[0], points[2]]);
    assert_eq!(pieces[1].ends(), [points[2], points[4]]);
    for i in 0..=10 {
        let t = f64::from(i) / 10.0;
        assert_near(pieces[0].at(t), curve.at(t), 1e-15);
        assert_near(pieces[1].at(1.0 + t), curve.at(1.0 + t), 1e-15);
    }
    assert_eq!(Curve::polyline(points).expect("ok").pieces().len(), 4);
}

// spec: S1
#[test]
fn broken_numbers_are_named() {
    let p = vec![[0.0; 3], [1.0; 3], [2.0; 3]];
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    let new = |degree, knots: &[f64], points: &[Vector], weights: &[f64]| {
        Curve::new(degree, knots.to_vec(), points.to_vec(), weights.to_vec()).unwrap_err()
    };
    assert_eq!(new(0, &knots, &p, &[]), CurveError::Degree(0));
    assert_eq!(new(16, &knots, &p, &[]), CurveError::Degree(16));
    assert_eq!(new(3, &knots, &p, &[]), CurveError::TooFewPoints { points: 3, degree: 3 });
    let count = CurveError::KnotCount { found: 5, points: 3, degree: 2 };
    assert_eq!(new(2, &knots[1..], &p, &[]), count);
    let falling = [0.0, 0.0, 0.0, 1.0, 0.5, 1.0];
    assert_eq!(new(2, &falling, &p, &[]), CurveError::KnotOrder { index: 4 });
    assert_eq!(new(2, &[0.0; 6], &p, &[]), CurveError::NoRange);
    assert_eq!(new(2, &knots, &p, &[1.0]), CurveError::WeightCount { found: 1, points: 3 });
    let weight = CurveError::Weight { index: 1, value: -1.0 };
    assert_eq!(new(2, &knots, &p, &[1.0, -1.0, 1.0]), weight);
    let nan = [[0.0; 3], [f64::NAN; 3], [2.0; 3]];
    assert_eq!(
        new(2, &knots, &nan, &[]),
        CurveError::NotFinite { what: "control point", index: 1 }
    );
    let apart = CurveError::KnotRepeated { value: 0.5, times: 2, degree: 1 };
    let four = vec![[0.0; 3]; 4];
    assert_eq!(new(1, &[0.0, 0.0, 0.5, 0.5, 1.0, 1.0], &four, &[]), apart);
    assert_eq!(Curve::circle([0.0; 3], [0.0; 3], [1.0; 3]), Err(CurveError::NoCircle));
    assert_eq!(
        Curve::circle([0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]),
        Err(CurveError::NoCircle)
    );
}

// spec: S2
#[test]
fn nodes_by_count_lie_at_equal_arc_lengths() {
    let curve = wave();
    let at = nodes(&curve, Rule::Count(20)).expect("nodes");
    assert_eq!(at.len(), 21);
    let total = length(&curve);
    for pair in at.windows(2) {
        // The arc between two nodes, by a fine polygon.
        let fine = (0..=2000).map(|i| pair[0] + (pair[1] - pair[0]) * f64::from(i) / 2000.0);
        let arc: f64 = edge_lengths(&points(&curve, &fine.collect::<Vec<_>>())).iter().sum();
        assert!((arc / (total / 20.0) - 1.0).abs() < 1e-6, "{arc}");
    }
}

// spec: S2
#[test]
fn a_circle_by_spacing_is_a_regular_polygon() {
    let circle = unit_circle();
    let at = nodes(&circle, Rule::Spacing(0.1)).expect("nodes");
    let chords = edge_lengths(&points(&circle, &at));
    // Four quarters, each with round(pi / 2 / 0.1) edges.
    assert_eq!(chords.len(), 64);
    let side = 2.0 * libm::sin(PI / 64.0);
    assert!(chords.iter().all(|c| (c / side - 1.0).abs() < 1e-8), "{chords:?}");
}

// spec: S2
#[test]
fn the_chord_error_is_kept_and_not_overdone() {
    for error in [1e-2, 1e-3, 1e-5] {
        for curve in [unit_circle(), wave()] {
            let at = nodes(&curve, Rule::ChordError(error)).expect("nodes");
            let worst = chord_error(&curve, &at);
            assert!(worst <= error && worst > 0.2 * error, "{worst} for {error}");
        }
    }
    assert!((spacing_for_chord(1.0, 0.5, 9.0) - 3.0_f64.sqrt()).abs() < 1e-15, "the hexagon's");
    assert_eq!(spacing_for_chord(0.0, 0.5, 9.0), 9.0);
    assert_eq!(spacing_for_chord(1.0, 5.0, 9.0), 2.0);
}

// spec: S2
#[test]
fn graded_nodes_grow_steadily_from_one_spacing_to_the_other() {
    let line = Curve::polyline(vec![[0.0; 3], [10.0, 0.0, 0.0]]).expect("a line");
    let at = nodes(&line, Rule::Graded(0.1, 1.0)).expect("nodes");
    let edges = edge_lengths(&points(&line, &at));
    assert!(edges.windows(2).all(|pair| pair[1] > pair[0]), "{edges:?}");
    assert!((edges[0] / 0.1 - 1.0).abs() < 0.1, "{edges:?}");
    assert!((edges[edges.len() - 1] / 1.0 - 1.0).abs() < 0.1, "{edges:?}");
}

// spec: S2
#[test]
fn spacings_that_change_within_an_edge_of_the_next_keep_the_order_of_nodes() {
    let line = Curve::polyline(vec![[0.0; 3], [1.0, 0.0, 0.0]]).unwrap();
    let peak =
        |at: f64, least: f64| move |jet: &CurveJet, _: f64| least + 0.3 * (jet.point[0] - at).abs();
    for (at, least) in
        [(0.3123, 1e-3), (0.3123, 1e-6), (1.0 / 3.0, 1e-9), (0.0, 1e-6), (0.97, 1e-4)]
    {
        let spacing = peak(at, least);
        let nodes = by_spacing(&line, spacing).unwrap();
        assert!(nodes.is_sorted_by(|a, b| a < b), "{nodes:?}");
        for pair in nodes.windows(2) {
            let middle = line.jet(0.5 * (pair[0] + pair[1]));
            let ratio = (pair[1] - pair[0]) / spacing(&middle, 0.0);
            assert!((0.6..1.5).contains(&ratio), "{ratio} at {pair:?} of {at} {least}");
        }
    }
}

// spec: S2
#[test]
fn spacings_that_jump_keep_the_order_of_nodes() {
    let line = Curve::polyline(vec![[0.0; 3], [1.0, 0.0, 0.0]]).unwrap();
    for (at, width) in [(0.37, 0.1), (0.37, 1e-3), (0.5, 1e-6), (0.123_456, 1e-9)] {
        let spacing = |jet: &CurveJet, _: f64| match (jet.point[0] - at).abs() < width {
            true => 1e-2 * width,
            false => 0.05,
        };
        let nodes = by_spacing(&line, spacing).unwrap();
        assert!(nodes.is_sorted_by(|a, b| a < b), "{at} {width}");
    }
}

// spec: S2
#[test]
fn corners_are_always_nodes() {
    let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.3, 0.0]];
    let bent = Curve::polyline(corners.clone()).expect("a polyline");
    for (rule, count) in [(Rule::Corners, 2), (Rule::Spacing(0.26), 5), (Rule::Count(10), 10)] {
        let found = points(&bent, &nodes(&bent, rule).expect("nodes"));
        assert_eq!(found.len(), count + 1, "{rule:?}");
        assert!(corners.iter().all(|c| found.contains(c)), "{rule:?}: {found:?}");
    }
}

// spec: S2
#[test]
fn the_number_of_triangles_wanted_gives_a_spacing() {
    // A unit square holds 4 / sqrt(3) / h^2 equilateral triangles.
    let h = spacing_for_triangles(1.0, 4.0 / 3.0_f64.sqrt() * 100.0);
    assert!((h - 0.1).abs() < 1e-15);
}

// spec: S2
#[test]
fn senseless_rules_are_refused() {
    let curve = wave();
    for rule in [
        Rule::Count(0),
        Rule::Spacing(0.0),
        Rule::Spacing(f64::NAN),
        Rule::ChordError(-1.0),
        Rule::Graded(1.0, f64::INFINITY),
    ] {
        let refused = nodes(&curve, rule);
        assert!(matches!(refused, Err(DiscretizeError::NotPositive { .. })), "{rule:?}");
    }
    for rule in [Rule::Spacing(1e-12), Rule::Count(usize::MAX)] {
        assert!(matches!(nodes(&curve, rule), Err(DiscretizeError::TooMany(_))), "{rule:?}");
    }
    let point = Curve::clamped(2, vec![[1.0; 3]; 3]).expect("a point");
    assert!(point.is_point());
    for rule in [Rule::Count(3), Rule::Spacing(1.0)] {
        assert_eq!(nodes(&point, rule), Err(DiscretizeError::NoLength));
    }
}
