//! What is written means what the boundary means.

use super::*;
use crate::domain::Segment;
use crate::domain::validate::validate;
use crate::format::domain_file::{DomainForm, ReadOptions, read_domain};
use crate::point::Point2;
use crate::torture::generate::{Case, Claim, case};

fn valid(count: u64) -> impl Iterator<Item = Case> {
    (0..count).map(|i| case(31, i)).filter(|case| case.claim == Claim::Valid)
}

/// A file's points, each once, in order.
fn keys(domain: &Domain) -> Vec<[u64; 2]> {
    let mut all: Vec<[u64; 2]> = domain.points.iter().map(|p| p.key()).collect();
    all.sort_unstable();
    all.dedup();
    all
}

// spec: R5
#[test]
fn what_is_written_reads_back_as_a_valid_boundary_of_the_same_points() {
    let forms = [
        (BoundaryForm::Json, DomainForm::Json),
        (BoundaryForm::Poly, DomainForm::Poly),
        (BoundaryForm::GeoJson, DomainForm::GeoJson),
    ];
    let mut written = [0; 3];
    for case in valid(400) {
        for (slot, (form, reader)) in forms.iter().enumerate() {
            let Ok(bytes) = export(&case.domain, *form) else { continue };
            let back = read_domain(&bytes, *reader, &ReadOptions::default()).expect("readable");
            let name = format!("{form:?} {} {}", case.family, case.index);
            assert_eq!(keys(&back), keys(&case.domain), "{name}");
            let faults = validate(&back).err();
            assert!(faults.is_none(), "{name}: {:?}", faults.map(|f| f[0].to_string()));
            written[slot] += 1;
        }
    }
    let all = valid(400).count();
    assert_eq!(written[0], all, "JSON says everything");
    assert!(written[1] * 10 > all * 8, "{written:?} of {all}");
    assert!(written[2] * 10 > all * 8, "{written:?} of {all}");
}

// spec: R5
#[test]
fn every_format_writes_most_boundaries_and_says_why_not() {
    for form in BoundaryForm::ALL {
        let (mut good, mut bad) = (0, 0);
        for case in valid(300) {
            match export(&case.domain, form) {
                Ok(bytes) => {
                    good += 1;
                    let text = String::from_utf8(bytes).expect("text");
                    assert!(!text.contains("NaN") && !text.contains("inf"), "{form:?}");
                }
                Err(error) => {
                    bad += 1;
                    assert!(error.to_string().contains("cannot say"), "{error}");
                }
            }
        }
        assert!(good > bad, "{form:?}: {good} written, {bad} not");
    }
}

fn plate() -> Domain {
    let text = br#"{"format": "trigrade-domain", "version": 1,
        "points": [[0, 0], [4, 0], [4, 4], [0, 4], [1, 1], [2, 1], [1, 2]],
        "loops": [{"vertices": [0, 1, 2, 3], "marker": 1}, {"vertices": [4, 5, 6], "marker": 2}],
        "segments": [{"vertices": [5, 2], "marker": 0}]}"#;
    crate::format::domain_json::read(text).expect("readable")
}

fn text(form: BoundaryForm) -> String {
    String::from_utf8(export(&plate(), form).expect("expressible")).expect("text")
}

// spec: R5
#[test]
fn a_plate_with_a_hole_in_every_format() {
    let geo = text(BoundaryForm::Geo);
    assert!(geo.contains("Plane Surface(1) = {1, 2};"), "{geo}");
    assert!(geo.contains("Curve{8} In Surface{1};"), "{geo}");
    let in2d = text(BoundaryForm::In2d);
    assert!(in2d.contains("1 0 2 1 2 -bc=1") && in2d.contains("0 1 2 5 6 -bc=1"), "{in2d}");
    assert!(in2d.contains("1 1 2 6 3 -bc=2"), "{in2d}");
    let wkt = text(BoundaryForm::Wkt);
    assert!(wkt.contains("MULTIPOLYGON (((0.0 0.0, 4.0 0.0, 4.0 4.0, 0.0 4.0, 0.0 0.0), (1.0"));
    assert!(wkt.contains("MULTILINESTRING ((2.0 1.0, 4.0 4.0))"), "{wkt}");
    let svg = text(BoundaryForm::Svg);
    assert!(svg.contains("evenodd") && svg.contains("M1.0,1.0 L2.0,1.0 L1.0,2.0 Z"), "{svg}");
    let hole = match poly::carved(&plate()).expect("expressible").inside {
        Inside::Carve(holes) => holes[0],
        Inside::EvenOdd => panic!("Triangle's rule"),
    };
    assert!(hole.x > 1.0 && hole.y > 1.0 && hole.x + hole.y < 3.0, "{hole}");
}

// spec: R5
#[test]
fn gmsh_is_told_to_keep_isolated_points() {
    let mut whole = plate();
    let number = whole.points.len() + 1;
    whole.points.push(Point2::new(3.5, 3.0));
    let bytes = export(&whole, BoundaryForm::Geo).expect("expressible");
    let text = String::from_utf8(bytes).expect("text");
    assert!(text.contains(&format!("Point{{{number}}} In Surface{{1}};")), "{text}");
}

// spec: R5
#[test]
fn mmg_is_asked_to_keep_the_boundary_of_a_plate_without_holes() {
    let error = export(&plate(), BoundaryForm::Medit).expect_err("it would fill the hole");
    assert_eq!(error.to_string(), "mesh cannot say holes");
    let mut whole = plate();
    whole.loops.truncate(1);
    let bytes = export(&whole, BoundaryForm::Medit).expect("expressible");
    let text = String::from_utf8(bytes).expect("text");
    let edges = whole.edges().count();
    let required: String = (1..=edges).map(|i| format!("{i}\n")).collect();
    assert!(text.ends_with(&format!("RequiredEdges\n{edges}\n{required}End\n")), "{text}");
    let vertices = whole.points.len();
    assert!(text.contains(&format!("\nRequiredVertices\n{vertices}\n1\n2\n")), "{text}");
    assert_eq!(text.matches("End").count(), 1);
}

#[test]
fn what_a_format_cannot_say_is_refused() {
    let mut domain = plate();
    domain.points.push(crate::point::Point2::new(3.0, 3.5));
    for form in [BoundaryForm::Svg, BoundaryForm::In2d] {
        let error = export(&domain, form).expect_err("isolated points");
        assert!(error.to_string().ends_with("cannot say isolated points"), "{error}");
    }
    domain.inside = Inside::Carve(Vec::new());
    assert!(export(&domain, BoundaryForm::Geo).is_err());
    assert!(!BoundaryForm::Poly.carries("D10") && BoundaryForm::Json.carries("D10"));
    assert!(BoundaryForm::Poly.carries("D8"));
}

#[test]
fn segments_in_a_hole_are_not_embedded_in_the_surface() {
    let ring = |a: f64, b: f64| vec![[a, a], [b, a], [b, b], [a, b]];
    let domain = Domain::of_rings(&[ring(0.0, 8.0), ring(2.0, 6.0)]);
    let with = |ends: [[f64; 2]; 2]| {
        let mut domain = domain.clone();
        let first = domain.points.len() as u32;
        domain.points.extend(ends.map(Point2::from));
        domain.segments.push(Segment { vertices: [first, first + 1], marker: 3 });
        domain
    };
    for form in [BoundaryForm::Geo, BoundaryForm::In2d] {
        assert!(export(&with([[1.0, 1.0], [1.0, 4.0]]), form).is_ok());
        // From a corner of the hole into it, and along the diagonal from corner to corner.
        for ends in [[[2.0, 2.0], [3.0, 3.5]], [[2.0, 2.0], [6.0, 6.0]]] {
            let error = export(&with(ends), form).expect_err("in the hole").to_string();
            assert!(error.ends_with("segments and points outside the domain"), "{error}");
        }
    }
}

#[test]
fn extensions_name_formats() {
    for form in BoundaryForm::ALL {
        assert_eq!(BoundaryForm::from_extension(form.extension()), Some(form));
    }
    assert_eq!(BoundaryForm::from_extension("msh"), None);
}
