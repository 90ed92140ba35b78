//! Quality metrics against reference values, gates and baselines.

use std::path::PathBuf;
use trigrade::check::quality::{OWN_METRICS, measure};
use trigrade::check::{Baseline, CheckOptions, Gate, GateOutcome, Id, Metric, Verdict, check};
use trigrade::mesh::MeshData;

fn reference_data(name: &str) -> Option<String> {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data"));
    std::fs::read_to_string(folder.join(name)).ok()
}

fn metrics(corners: [[f64; 3]; 3]) -> [f64; OWN_METRICS] {
    measure(corners, None).metrics()
}

/// Our metric for each of Verdict's, and the value in terms of ours.
fn ours(name: &str, m: &[f64; OWN_METRICS]) -> Option<f64> {
    Some(match name {
        "tri_area" => m[Metric::Area as usize],
        "tri_aspect_ratio" => m[Metric::VerdictAspectRatio as usize],
        "tri_edge_ratio" => m[Metric::EdgeRatio as usize],
        "tri_radius_ratio" => m[Metric::RadiusRatio as usize],
        "tri_minimum_angle" => m[Metric::MinAngle as usize],
        "tri_maximum_angle" => m[Metric::MaxAngle as usize],
        "tri_shape" => m[Metric::Shape as usize],
        "tri_scaled_jacobian" => m[Metric::ScaledJacobian as usize],
        "tri_equiangle_skew" => m[Metric::EquiangleSkew as usize],
        "tri_condition" | "tri_aspect_frobenius" => 1.0 / m[Metric::Shape as usize],
        _ => return None,
    })
}

// spec: Q3
#[test]
fn metrics_agree_with_the_reference_values_of_verdict() {
    let Some(text) = reference_data("quality/verdict_tri_quad.json") else { return };
    let data: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let mut compared = 0;
    for test in data["tests"].as_array().expect("tests") {
        if test["n_nodes"] != 3 {
            continue;
        }
        let corner = |i: usize, k: usize| test["coords"][i][k].as_f64().expect("a coordinate");
        let corners = [0, 1, 2].map(|i| [0, 1, 2].map(|k| corner(i, k)));
        let m = metrics(corners);
        for (name, wanted) in test["expected"].as_object().expect("values") {
            if let (Some(got), Some(wanted)) = (ours(name, &m), wanted.as_f64()) {
                let tolerance = 1e-5 + 1e-5 * wanted.abs();
                assert!(
                    (got - wanted).abs() <= tolerance,
                    "{}: {name} {got} {wanted}",
                    test["name"]
                );
                compared += 1;
            }
        }
    }
    assert!(compared >= 15, "{compared} values compared");
}

fn assert_near(got: f64, wanted: f64, what: &str) {
    assert!((got - wanted).abs() <= 1e-12 * wanted.abs().max(1.0), "{what}: {got}, not {wanted}");
}

// spec: Q3
#[test]
fn the_equilateral_triangle_is_best() {
    let height = 3f64.sqrt() / 2.0;
    let m = metrics([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, height, 0.0]]);
    for (metric, wanted) in [
        (Metric::RadiusRatio, 1.0),
        (Metric::VerdictAspectRatio, 1.0),
        (Metric::EdgeRatio, 1.0),
        (Metric::MinAngle, 60.0),
        (Metric::MaxAngle, 60.0),
        (Metric::RadiusEdgeRatio, 1.0 / 3f64.sqrt()),
        (Metric::ScaledJacobian, 1.0),
        (Metric::Shape, 1.0),
        (Metric::EquiangleSkew, 0.0),
        (Metric::Area, height / 2.0),
    ] {
        assert_near(m[metric as usize], wanted, metric.name());
    }
}

// spec: Q3
#[test]
fn the_triangle_3_4_5_by_hand() {
    // A = 6, r = 1, R = 5/2.
    let m = metrics([[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 3.0, 1.0]]);
    let smallest = 0.6f64.asin().to_degrees();
    for (metric, wanted) in [
        (Metric::RadiusRatio, 1.25),
        (Metric::VerdictAspectRatio, 5.0 / (2.0 * 3f64.sqrt())),
        (Metric::EdgeRatio, 5.0 / 3.0),
        (Metric::MinAngle, smallest),
        (Metric::MaxAngle, 90.0),
        (Metric::RadiusEdgeRatio, 2.5 / 3.0),
        (Metric::ScaledJacobian, 2.0 / 3f64.sqrt() * 0.6),
        (Metric::Shape, 4.0 * 3f64.sqrt() * 6.0 / 50.0),
        (Metric::EquiangleSkew, (60.0 - smallest) / 60.0),
        (Metric::Area, 6.0),
    ] {
        assert_near(m[metric as usize], wanted, metric.name());
    }
}

/// A row of right triangles on [0, n] x [0, 1], the first square split unevenly.
fn row(n: u32) -> MeshData {
    let x = |i: u32| if i == 1 { 0.25 } else { f64::from(i) };
    let points = (0..=n).flat_map(|i| [[x(i), 0.0, 0.0], [x(i), 1.0, 0.0]]).collect();
    let quad = |i: u32| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]];
    MeshData { points, triangles: (0..n).flat_map(quad).collect(), ..MeshData::default() }
}

// spec: Q4
#[test]
fn neighbours_are_compared_by_area_and_by_size() {
    let report = check(&row(4), None, &CheckOptions::new());
    let quality = report.quality.expect("quality");
    let ratio = quality.summary(Metric::NeighbourAreaRatio).expect("a summary");
    // Triangles of 0.125 beside triangles of 0.875.
    assert_eq!(ratio.max, Some(7.0));
    assert_eq!(ratio.min, Some(1.0));
    assert_eq!(ratio.worst[0].triangle.index, 0);
    let spread = quality.summary(Metric::AreaSpread).expect("a summary");
    assert_eq!((spread.min, spread.max), (Some(1.0), Some(7.0)));
    let perimeter = |w: f64| w + 1.0 + (w * w + 1.0).sqrt();
    let gradation = quality.summary(Metric::EdgeLengthGradation).expect("a summary");
    assert_near(gradation.max.expect("a value"), perimeter(1.75) / perimeter(0.25), "gradation");
}

// spec: Q5
#[test]
fn summaries_count_every_triangle_once() {
    let mesh = row(2500);
    let report = check(&mesh, None, &CheckOptions::new());
    let quality = report.quality.expect("quality");
    assert_eq!(quality.triangles, 5000);
    for summary in &quality.metrics {
        assert_eq!(summary.histogram.counts.iter().sum::<u64>(), 5000, "{}", summary.metric);
        assert_eq!(summary.histogram.counts.len(), summary.histogram.bounds.len() + 1);
        assert_eq!(summary.count + summary.infinite, 5000);
        assert_eq!(summary.worst.len(), 10);
        let order =
            [summary.min, summary.percentile_1, summary.percentile_50, summary.percentile_99];
        // Percentiles are rounded to single precision.
        for pair in order.windows(2) {
            let (a, b) = (pair[0].expect("finite"), pair[1].expect("finite"));
            assert!(a <= b * (1.0 + 1e-6) + 1e-6, "{}: {order:?}", summary.metric);
        }
    }
}

// spec: Q1
#[test]
fn gates_count_shares_exactly() {
    let mesh = row(50);
    let outcome = |text: &str| {
        let report =
            check(&mesh, None, &CheckOptions::new().gate(Gate::parse(text).expect("a gate")));
        let result = report.gates[0].clone();
        assert_eq!(report.passed(), result.outcome == GateOutcome::Held, "{text}");
        assert_eq!(report.count(Id::GateMissed), u64::from(!report.passed()));
        (result.outcome, result.met, result.total)
    };
    // 4 of the 100 triangles are not half of a unit square.
    assert_eq!(outcome("area <= 0.5"), (GateOutcome::Missed, 98, 100));
    assert_eq!(outcome("area <= 0.5 @ 98%"), (GateOutcome::Held, 98, 100));
    assert_eq!(outcome("area <= 0.5 @ 98.0001%"), (GateOutcome::Missed, 98, 100));
    assert_eq!(outcome("area < 0.5 @ 3%"), (GateOutcome::Missed, 2, 100));
    assert_eq!(outcome("area_spread <= 7"), (GateOutcome::Held, 100, 100));
    assert_eq!(outcome("neighbour_area_ratio <= 6.999"), (GateOutcome::Missed, 98, 100));
}

// spec: Q1 C9
#[test]
fn a_gate_that_cannot_be_evaluated_never_passes() {
    let gate = || Gate::parse("radius_ratio <= 3").expect("a gate");
    let empty = check(&MeshData::default(), None, &CheckOptions::new().gate(gate()));
    assert_eq!(empty.verdict, Verdict::CouldNotRun);
    assert_eq!(empty.gates[0].outcome, GateOutcome::CouldNotRun);
    let mut faulty = row(1);
    faulty.triangles = vec![[0, 1, 99]];
    let report = check(&faulty, None, &CheckOptions::new().allow(Id::BadReference).gate(gate()));
    assert_eq!(report.verdict, Verdict::CouldNotRun);
    assert_eq!(report.exit_code(), 2);
}

// spec: Q1
#[test]
fn an_infinite_value_misses_its_gate() {
    let points = vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [1.0, 0.0, 0.0]];
    let mesh = MeshData { points, triangles: vec![[0, 1, 2], [1, 0, 3]], ..MeshData::default() };
    let gate = Gate::parse("radius_ratio <= 1e300").expect("a gate");
    let report = check(&mesh, None, &CheckOptions::new().allow(Id::ZeroArea).gate(gate));
    assert_eq!(report.ids(), [Id::ZeroArea, Id::GateMissed]);
    assert_eq!(report.verdict, Verdict::Failed);
    assert_eq!(report.gates[0].worst, None);
}

// spec: Q2
#[test]
fn a_mesh_meets_its_own_baseline_and_a_worse_one_does_not() {
    let good = check(&row(1), None, &CheckOptions::new());
    let baseline = Baseline::of(good.quality.as_ref().expect("quality"));
    let text = serde_json::to_string(&baseline).expect("serialises");
    let baseline = Baseline::parse(&text).expect("reads back");
    let with = |mesh: &MeshData, tolerance: f64| {
        let mut baseline = baseline.clone();
        baseline.tolerance = tolerance;
        check(mesh, None, &CheckOptions::new().baseline(baseline))
    };
    assert!(with(&row(1), 0.0).passed());
    let worse = with(&row(4), 0.0);
    assert_eq!(worse.ids(), [Id::BaselineMissed]);
    assert!(worse.findings.iter().any(|f| f.message.contains("neighbour_area_ratio")));
    assert!(with(&row(4), 100.0).passed());
    let empty = with(&MeshData::default(), 0.0);
    assert_eq!(empty.verdict, Verdict::CouldNotRun);
}

/// The exact area serves quality too: a sliver one ulp thick has a finite ratio.
#[test]
fn a_sliver_one_ulp_thick_has_a_quality() {
    let points = vec![[1.0, 1.0, 0.0], [2.0, 2.0, 0.0], [1.5, 1.5f64.next_up(), 0.0]];
    let mesh = MeshData { points, triangles: vec![[0, 1, 2]], ..MeshData::default() };
    let report = check(&mesh, None, &CheckOptions::new());
    let quality = report.quality.expect("quality");
    let area = quality.summary(Metric::Area).expect("a summary").max;
    assert_eq!(area, Some(f64::EPSILON / 2.0));
    let ratio = quality.summary(Metric::RadiusRatio).expect("a summary").max;
    assert!(ratio.is_some_and(|r| r > 1e30), "{ratio:?}");
}

/// The manifest's facts about meshes that other programs wrote.
#[test]
fn real_meshes_get_the_verdict_of_their_manifest() {
    let Some(text) = reference_data("meshes/MANIFEST.json") else { return };
    let manifest: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    for case in manifest["cases"].as_array().expect("cases") {
        let name = case["name"].as_str().expect("a name");
        let off = reference_data(&format!("meshes/{name}.off")).expect("an OFF file");
        let mesh = read_off(&off);
        let report = check(&mesh, None, &CheckOptions::new().allow(Id::UnusedVertex));
        let n_tri = case["n_tri"].as_u64().expect("a number");
        assert_eq!(report.statistics.triangles, n_tri, "{name}");
        if n_tri == 0 {
            assert_eq!(report.ids(), [Id::Empty], "{name}");
            continue;
        }
        let flags: Vec<&str> =
            case["flags"].as_array().expect("flags").iter().filter_map(|f| f.as_str()).collect();
        let mut wanted = Vec::new();
        if flags.contains(&"mixed-orientation") {
            wanted.push(Id::MixedOrientation);
        } else if case["all_clockwise"] == true {
            wanted.push(Id::Clockwise);
        }
        if case["n_quad"] == 0 {
            let found: Vec<Id> =
                report.ids().into_iter().filter(|&id| id != Id::UnusedVertex).collect();
            assert_eq!(found, wanted, "{name}: {:?}", report.findings);
            let same = |field: &str, got: f64| {
                let wanted = case[field].as_f64().expect("a number");
                assert!(
                    (got - wanted).abs() <= 1e-9 * wanted.abs(),
                    "{name}: {field} {got} {wanted}"
                );
            };
            same("euler", report.statistics.euler as f64);
            same("n_boundary_edges", report.statistics.boundary_edges as f64);
            same("area", report.statistics.area.as_ref().and_then(|a| a.rounded).expect("an area"));
            let quality = report.quality.expect("quality");
            let summary = |metric| quality.summary(metric).expect("a summary");
            same("min_angle_deg", summary(Metric::MinAngle).min.expect("finite"));
            same("max_angle_deg", summary(Metric::MaxAngle).max.expect("finite"));
        }
    }
}

/// The triangles of an OFF file; the readers proper have their own tests.
fn read_off(text: &str) -> MeshData {
    let mut words = text
        .lines()
        .map(|line| line.split('#').next().unwrap_or(""))
        .flat_map(str::split_whitespace)
        .skip(1);
    let mut number = || words.next().expect("a word").parse::<f64>().expect("a number");
    let (points, faces) = (number() as usize, number() as usize);
    number();
    let points = (0..points).map(|_| [number(), number(), number()]).collect();
    let mut triangles = Vec::new();
    for _ in 0..faces {
        let corners: Vec<u32> = (0..number() as usize).map(|_| number() as u32).collect();
        if let &[a, b, c] = corners.as_slice() {
            triangles.push([a, b, c]);
        }
    }
    MeshData { points, triangles, ..MeshData::default() }
}
