//! Domain files: what each format means, and what becomes of files that cannot be read.

use proptest::prelude::*;
use std::path::Path;
use trigrade::domain::validate::validate;
use trigrade::domain::{Domain, Inside, Loop, LoopRole, Place, Region, Segment};
use trigrade::format::airfoil::FarField;
use trigrade::format::domain_file::{
    DomainForm, DomainReadError, Problem, ReadOptions, read_domain,
};
use trigrade::format::{domain_json, poly};
use trigrade::point::Point2;

const FORMS: [DomainForm; 4] =
    [DomainForm::Poly, DomainForm::Json, DomainForm::Airfoil, DomainForm::GeoJson];

fn read(form: DomainForm, text: &str) -> Result<Domain, DomainReadError> {
    read_domain(text.as_bytes(), form, &ReadOptions::default())
}

fn sound(form: DomainForm, text: &str) -> Domain {
    let domain = read(form, text).unwrap_or_else(|e| panic!("{text}: {e}"));
    if let Err(faults) = validate(&domain) {
        panic!("{text}: {}", faults[0]);
    }
    domain
}

/// The message of the error a text gives, which must name a place.
fn refused(form: DomainForm, text: &str) -> (String, &'static str) {
    let error = read(form, text).err().unwrap_or_else(|| panic!("read: {text}"));
    assert_ne!(error.place, Place::Made, "{error}");
    (error.to_string(), error.problem.id())
}

const POLY: &str = "# a square with a hole\n8 2 1 1\n1 0 0 7.5 1\n2 4 0 7 2 # corner\n3 4 4 7 3\n\
    \n4 0 4 7 4\n5 1 1 7 0\n6 2 1 7 0\n7 2 2 7 0\n8 1 2 7 0\n8 1\n1 1 2 10\n2 2 3 11\n3 3 4 12\n4 4 1 13\n\
    5 5 6 20\n6 6 7 20\n7 7 8 20\n8 8 5 20\n1\n1 1.5 1.5\n1\n1 3 3 -4 0.25\n";

// spec: X9
#[test]
fn poly_says_everything() {
    let domain = sound(DomainForm::Poly, POLY);
    assert_eq!(domain.points.len(), 8);
    assert_eq!(domain.points[2], Point2::new(4.0, 4.0));
    assert_eq!(domain.point_markers, [1, 2, 3, 4, 0, 0, 0, 0]);
    assert_eq!(domain.segments[3], Segment { vertices: [3, 0], marker: 13 });
    assert_eq!(domain.inside, Inside::Carve(vec![Point2::new(1.5, 1.5)]));
    let region = Region { seed: Point2::new(3.0, 3.0), marker: -4, area_max: Some(0.25) };
    assert_eq!(domain.regions, [region]);
    assert_eq!(domain.places.points[3], Place::Line(7));
    assert_eq!(domain.places.segments[0], Place::Line(13));
    assert_eq!(domain.places.holes, [Place::Line(22)]);
    assert_eq!(domain.places.regions, [Place::Line(24)]);
}

// spec: X9
#[test]
fn poly_counts_from_zero_or_one() {
    let zero = "3 2\n0 0 0\n1 1 0\n2 0 1\n3\n0 0 1\n1 1 2\n2 2 0\n0\n";
    let one = "3 2\n1 0 0\n2 1 0\n3 0 1\n3\n1 1 2\n2 2 3\n3 3 1\n0\n";
    assert_eq!(sound(DomainForm::Poly, zero).segments, sound(DomainForm::Poly, one).segments);
    let (message, id) = refused(DomainForm::Poly, &zero.replace("2 2 0", "2 2 3"));
    assert_eq!(
        (message.as_str(), id),
        ("line 8: a segment's vertex is 3, but must be between 0 and 2", "X5")
    );
    assert_eq!(refused(DomainForm::Poly, &one.replace("3 3 1\n", "3 3 0\n")).1, "X5");
    assert_eq!(refused(DomainForm::Poly, &one.replace("1 0 0\n", "2 0 0\n")).1, "X5");
    assert_eq!(refused(DomainForm::Poly, &one.replace("3 0 1\n", "4 0 1\n")).1, "X5");
}

// spec: X9
#[test]
fn poly_takes_vertices_from_the_node_file() {
    let text = "0 2 0 0\n3 1\n1 1 2 5\n2 2 3 5\n3 3 1 5\n0\n";
    let error = read(DomainForm::Poly, text).unwrap_err();
    assert_eq!((error.problem.clone(), error.place), (Problem::NodesElsewhere, Place::Line(1)));
    let node = b"# nodes\n3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n";
    let options = ReadOptions { node: Some(node), ..ReadOptions::default() };
    let domain = read_domain(text.as_bytes(), DomainForm::Poly, &options).unwrap();
    assert_eq!(domain.places.points[0], Place::NodeLine(3));
    assert!(validate(&domain).is_ok());
    let options = ReadOptions { node: Some(b"3 2 0 0\n1 0 0\n2 1 0\n"), ..ReadOptions::default() };
    let error = read_domain(text.as_bytes(), DomainForm::Poly, &options).unwrap_err();
    assert_eq!(
        error.to_string(),
        "line 4 of the .node file: the file announces 3 vertices, but ends after 2"
    );
}

// spec: X5
#[test]
fn poly_markers_and_attributes_are_integers_that_fit() {
    for (good, bad) in
        [("7 2 # corner", "7 2.5"), ("7 2 # corner", "7 3000000000"), ("3 -4", "3 -4.5")]
    {
        refused(DomainForm::Poly, &POLY.replace(good, bad));
    }
    sound(DomainForm::Poly, &POLY.replace("3 3 -4 0.25", "3 3 4.0"));
}

// spec: X11
#[test]
fn schema_says_everything() {
    let text = r#"{
        "format": "trigrade-domain", "version": 1, "name": "n", "comment": null,
        "points": [[0, 0], [9, 0], [9, 9], [0, 9], [1, 1], [5, 1], [5, 5], [1, 5]],
        "point_markers": [1, 2, 3, 4, 5, 6, 7, 8],
        "loops": [
            {"vertices": [0, 1, 2, 3], "marker": 7, "role": "outer"},
            {"vertices": [4, 5, 6, 7, 4], "markers": [1, 2, 3, 4], "role": {"hole_of": 0}},
            {"vertices": [[2, 2], [3, 2], [3, 3], [2, 2]]}
        ],
        "segments": [[6, 2], {"vertices": [[6, 5], [5, 5]], "marker": -1}],
        "inside": "even-odd",
        "regions": [{"seed": [8, 1], "marker": 3, "area_max": 0.5}]
    }"#;
    let domain = sound(DomainForm::Json, text);
    assert_eq!(domain.points.len(), 12);
    assert_eq!(domain.point_markers[7..], [8, 0, 0, 0, 0]);
    assert_eq!(domain.loops[1].role, LoopRole::HoleOf(0));
    assert_eq!(domain.loops[1].markers, [1, 2, 3, 4]);
    assert_eq!(domain.loops[2], Loop::new(vec![8, 9, 10], 3, LoopRole::Any));
    assert_eq!(domain.segments[1], Segment { vertices: [11, 6], marker: -1 });
    assert_eq!(domain.places.points[9], Place::Path("$.loops[2].vertices[1]".into()));
    assert_eq!(domain.places.points.len(), 12);
    let carve = text.replace("\"even-odd\"", r#"{"carve": [[3, 1.5]]}"#);
    assert_eq!(sound(DomainForm::Json, &carve).inside, Inside::Carve(vec![Point2::new(3.0, 1.5)]));
}

// spec: X4 X5 X6
#[test]
fn schema_refuses_what_it_does_not_know() {
    let cases = [
        (r#"{"loops": 3}"#, "$.loops: expected an array of loops, found 3", "X4"),
        (r#"{"loops": [{}]}"#, "$.loops[0]: the key 'vertices' is missing", "X4"),
        (
            r#"{"loops": [{"vertices": [-1]}]}"#,
            "$.loops[0].vertices[0]: a point's index is -1, but must be between 0 and 4294967295",
            "X5",
        ),
        (
            r#"{"loops": [{"vertices": [1099511627776]}]}"#,
            "$.loops[0].vertices[0]: a point's index is 1099511627776, but must be between 0 and 4294967295",
            "X5",
        ),
        (
            r#"{"loops": [{"vertices": [0.5]}]}"#,
            "$.loops[0].vertices[0]: expected a point's index, found 0.5",
            "X4",
        ),
        (
            r#"{"loops": [{"vertices": [[0]]}]}"#,
            "$.loops[0].vertices[0]: expected a point [x, y], found an array of 1",
            "X4",
        ),
        (
            r#"{"loops": [{"vertices": [["0", 1]]}]}"#,
            "$.loops[0].vertices[0][0]: expected a number, found the string '0'",
            "X4",
        ),
        (r#"{"loops": [], "segmnts": []}"#, "$: unknown key 'segmnts'", "X6"),
        (
            r#"{"loops": [{"vertices": [], "roles": "outer"}]}"#,
            "$.loops[0]: unknown key 'roles'",
            "X6",
        ),
        (
            r#"{"loops": [{"vertices": [], "role": "inner"}]}"#,
            "$.loops[0].role: expected a role: \"any\", \"outer\" or {\"hole_of\": loop}, found the string 'inner'",
            "X4",
        ),
        (
            r#"{"loops": [{"vertices": [0, 1], "markers": [1]}]}"#,
            "$.loops[0].markers: there are 1 markers, but there must be 2",
            "X3",
        ),
        (
            r#"{"loops": [{"vertices": [0], "markers": [1], "marker": 1}]}"#,
            "$.loops[0]: 'marker' and 'markers' exclude each other",
            "X6",
        ),
        (
            r#"{"loops": [], "points": [[0,0]], "point_markers": [1, 2]}"#,
            "$.point_markers: there are 2 point markers, but there must be 1",
            "X3",
        ),
        (
            r#"{"loops": [], "segments": [[0]]}"#,
            "$.segments[0]: there are 1 ends of a segment, but there must be 2",
            "X3",
        ),
        (
            r#"{"loops": [], "inside": "odd"}"#,
            "$.inside: expected a rule: \"even-odd\" or {\"carve\": [points]}, found the string 'odd'",
            "X4",
        ),
        (
            r#"{"loops": [], "regions": [{"seed": [0,0], "area_max": 0}]}"#,
            "$.regions[0].area_max: expected an area above 0, found 0",
            "X4",
        ),
        (
            r#"{"format": "other"}"#,
            "$.format: expected the format 'trigrade-domain', found the string 'other'",
            "X4",
        ),
        (
            r#"{"format": "trigrade-domain", "version": 2}"#,
            "$.version: the version is 2, but must be between 1 and 1",
            "X5",
        ),
        (r#"{"outer": [], "polygons": []}"#, "$: 'outer' and 'polygons' exclude each other", "X6"),
        (r#"{"holes": [[]], "points": []}"#, "$.holes[0]: the key 'outer' is missing", "X4"),
        (r#"{"polygons": [{}]}"#, "$.polygons[0]: the key 'outer' is missing", "X4"),
        (
            r#"{"polygons": [[]]}"#,
            "$.polygons[0]: expected a polygon {\"outer\": .., \"holes\": ..}, found an array of 0",
            "X4",
        ),
        (r#"{"a": 1}"#, "$: the key 'loops' is missing", "X4"),
        ("[]", "$: expected an object with the domain, found an array of 0", "X4"),
        ("null", "$: expected an object with the domain, found null", "X4"),
    ];
    for (text, message, id) in cases {
        assert_eq!(refused(DomainForm::Json, text), (message.to_owned(), id), "{text}");
    }
}

// spec: X12
#[test]
fn plain_layout() {
    let text = r#"{"name": "x", "outer": [[0,0],[9,0],[9,9],[0,9],[0,0]], "holes": [[[1,1],[2,1],[1,2]]],
        "segments": [[[4,4],[5,5]],[[5,5],[9,9]]], "points": [[6,1]], "wrapped": true, "hole_seeds": []}"#;
    let domain = sound(DomainForm::Json, text);
    assert_eq!(domain.points.len(), 10);
    assert_eq!(domain.segments[1].vertices, [8, 2]);
    assert_eq!(domain.loops[1], Loop::new(vec![4, 5, 6], 2, LoopRole::HoleOf(0)));
    assert_eq!(domain.places.points[6], Place::Path("$.holes[0][2]".into()));
    let islands = r#"{"polygons": [{"outer": [[0,0],[9,0],[0,9]], "holes": [[[1,1],[4,1],[1,4]]]},
        {"outer": [[1.5,1.5],[2,1.5],[1.5,2]], "holes": []}]}"#;
    assert_eq!(sound(DomainForm::Json, islands).loops[2].role, LoopRole::Outer);
}

// spec: X12
#[test]
fn hole_seeds_ask_for_the_rule_of_triangle() {
    let text = r#"{"outer": [[0,0],[9,0],[9,9],[0,9]], "wrapped": true, "holes": [],
        "segments": [[[1,1],[2,1]],[[2,1],[1,2]],[[1,2],[1,1]]], "hole_seeds": [[1.2,1.2]]}"#;
    let domain = sound(DomainForm::Json, text);
    assert_eq!(domain.inside, Inside::Carve(vec![Point2::new(1.2, 1.2)]));
    assert_eq!(domain.places.holes, [Place::Path("$.hole_seeds[0]".into())]);
    let both = text.replace("\"holes\": []", "\"holes\": [[[5,5],[6,5],[5,6]]]");
    assert_eq!(refused(DomainForm::Json, &both).1, "X6");
}

const SELIG: &str = "EXAMPLE\n 1.0  0.0\n 0.5  0.1\n 0.0  0.0\n 0.5 -0.1\n 1.0  0.0\n";
const LEDNICER: &str =
    "EXAMPLE\n  3.  3.\n\n 0.0 0.0\n 0.5 0.1\n 1.0 0.0\n\n 0.0 0.0\n 0.5 -0.1\n 1.0 0.0\n";

// spec: X13
#[test]
fn both_airfoil_layouts_give_the_same_loop() {
    let (selig, lednicer) =
        (sound(DomainForm::Airfoil, SELIG), sound(DomainForm::Airfoil, LEDNICER));
    assert_eq!(selig.points, lednicer.points);
    assert_eq!(selig.points.len(), 4);
    assert_eq!(selig.loops, [Loop::new(vec![0, 1, 2, 3], 1, LoopRole::Outer)]);
    assert_eq!(lednicer.places.points[0], Place::Line(6));
    // An open trailing edge, with and without a name.
    let open = SELIG.replace("1.0  0.0\n 0.5  0.1", "1.0  0.01\n 0.5  0.1");
    assert_eq!(sound(DomainForm::Airfoil, &open).points.len(), 5);
    assert_eq!(sound(DomainForm::Airfoil, open.trim_start_matches("EXAMPLE\n")).points.len(), 5);
}

// spec: X8 X13
#[test]
fn a_far_field_makes_the_air_the_domain() {
    let far_field = Some(FarField { chords: 10.0, points: 60 });
    let options = ReadOptions { far_field, ..ReadOptions::default() };
    let domain = read_domain(SELIG.as_bytes(), DomainForm::Airfoil, &options).unwrap();
    let plc = validate(&domain).unwrap();
    assert_eq!(plc.points.len(), 64);
    assert_eq!(domain.loops[0].role, LoopRole::HoleOf(1));
    assert_eq!(domain.loops[1].role, LoopRole::Outer);
    assert!(
        domain.points[4..].iter().all(|p| (p.distance(Point2::new(0.5, 0.0)) - 10.0).abs() < 1e-9)
    );
    for far_field in [
        FarField { chords: 10.0, points: 2 },
        FarField { chords: 10.0, points: u32::MAX },
        FarField { chords: 0.0, points: 60 },
        FarField { chords: f64::NAN, points: 60 },
        FarField { chords: f64::INFINITY, points: 60 },
    ] {
        let options = ReadOptions { far_field: Some(far_field), ..ReadOptions::default() };
        let error = read_domain(SELIG.as_bytes(), DomainForm::Airfoil, &options).unwrap_err();
        assert_eq!(error.problem.id(), "X8", "{far_field:?}");
    }
}

// spec: X3 X4 X13
#[test]
fn broken_airfoils() {
    let cases = [
        ("", "line 1: expected a name and then points x y, found no line with two numbers", "X4"),
        (
            "NAME\n",
            "line 2: expected a name and then points x y, found no line with two numbers",
            "X4",
        ),
        ("NAME\n1 0\nx y\n", "line 3: expected a point: two numbers x y, found 'x'", "X4"),
        ("NAME\n1 0\n0 0 0\n", "line 3: expected a point: two numbers x y, found '0 0 0'", "X4"),
        (
            "NAME\n1 0\n0,5 0,1\n",
            "line 3: '0,5' is not a number: write a decimal point, not a comma, and blanks between numbers",
            "X2",
        ),
        (
            "NAME\n61. 61.\n0 0\n",
            "line 2: the file announces 122 points on both sides, but ends after 1",
            "X3",
        ),
        (
            "NAME\n2 2\n0 0\n1 0\n0 0\n1 0\n1 0\n",
            "line 2: there are 5 points on both sides, but there must be 4",
            "X3",
        ),
    ];
    for (text, message, id) in cases {
        assert_eq!(refused(DomainForm::Airfoil, text), (message.to_owned(), id), "{text}");
    }
}

// spec: X14
#[test]
fn geojson_polygons_lines_and_points() {
    let polygon = r#"{"type": "Polygon", "coordinates": [[[0,0],[9,0],[9,9],[0,9],[0,0]], [[1,1],[1,2],[2,1],[1,1]]]}"#;
    let domain = sound(DomainForm::GeoJson, polygon);
    assert_eq!((domain.points.len(), domain.loops.len()), (7, 2));
    assert_eq!(domain.places.points[4], Place::Path("$.coordinates[1][0]".into()));
    assert_eq!(sound(DomainForm::Json, polygon), domain);
    let collection = format!(
        r#"{{"type": "FeatureCollection", "features": [
        {{"type": "Feature", "properties": null, "geometry": {polygon}}},
        {{"type": "Feature", "properties": {{}}, "geometry": null}},
        {{"type": "Feature", "properties": {{"a": 1}}, "geometry": {{"type": "GeometryCollection", "geometries": [
            {{"type": "MultiPolygon", "coordinates": [[[[9,9],[10,9],[10,10],[9,9]]]]}},
            {{"type": "LineString", "coordinates": [[4,4],[5,5],[9,9,100]]}},
            {{"type": "MultiLineString", "coordinates": [[[5,5],[4,6]]]}},
            {{"type": "Point", "coordinates": [3,7]}},
            {{"type": "MultiPoint", "coordinates": [[3,6],[4,7]]}}
        ]}}}}]}}"#
    );
    let domain = sound(DomainForm::GeoJson, &collection);
    assert_eq!((domain.points.len(), domain.loops.len(), domain.segments.len()), (16, 3, 3));
    assert_eq!(domain.segments[1].vertices[1], 2);
    let path = "$.features[2].geometry.geometries[0].coordinates[0][0][2]";
    assert_eq!(domain.places.points[9], Place::Path(path.into()));
}

// spec: X1 X7
#[test]
fn broken_geojson() {
    let open = r#"{"type": "Polygon", "coordinates": [[[0,0],[9,0],[9,9],[0,9]]]}"#;
    let short = r#"{"type": "Polygon", "coordinates": [[[0]]]}"#;
    let message = "$.coordinates[0][0]: expected a position [x, y], found 1 numbers";
    assert_eq!(refused(DomainForm::GeoJson, short), (message.to_owned(), "X4"));
    let message = "$.coordinates[0]: a ring must end with its first position, (0.0, 0.0), but ends with (0.0, 9.0)";
    assert_eq!(refused(DomainForm::GeoJson, open), (message.to_owned(), "X7"));
    for text in [
        r#"{"type": "Polygon"}"#,
        r#"{"type": "Poligon", "coordinates": []}"#,
        r#"{"type": "Polygon", "coordinates": [[["0", 1]]]}"#,
        r#"{"type": "FeatureCollection"}"#,
        "{\"type\": \"Polygon\", \"coordinates\": [",
        "[]",
        "",
        "{\"a\": \"\u{0}\"",
    ] {
        let error = read(DomainForm::GeoJson, text).unwrap_err();
        assert_eq!(error.problem.id(), "X1", "{text}: {error}");
    }
    assert!(read_domain(b"\xff\xfe{", DomainForm::GeoJson, &ReadOptions::default()).is_err());
}

// spec: X2
#[test]
fn numbers_that_are_not_finite_are_refused() {
    for bad in ["nan", "NaN", "inf", "-Infinity", "1e999", "-1e400"] {
        let (message, id) =
            refused(DomainForm::Poly, &POLY.replace("4 0 7 2", &format!("4 {bad} 7 2")));
        assert_eq!(message, format!("line 4: '{bad}' is not a finite number of double precision"));
        assert_eq!(id, "X2");
        assert_eq!(refused(DomainForm::Airfoil, &SELIG.replace("-0.1", bad)).1, "X2");
        for json in
            [r#"{"outer": [[0,0],[BAD,0],[0,1]]}"#, r#"{"loops": [{"vertices": [[0,0],[BAD,0]]}]}"#]
        {
            let (message, id) = refused(DomainForm::Json, &json.replace("BAD", bad));
            assert!(id == "X1" && message.starts_with("line 1: this is not JSON"), "{message}");
        }
        refused(DomainForm::GeoJson, &format!(r#"{{"type": "Point", "coordinates": [0, {bad}]}}"#));
    }
    refused(DomainForm::Poly, &POLY.replace("4 0 7 2", "4 0,5 7 2"));
    // The least number that is not zero, and the greatest one.
    let tiny = sound(DomainForm::Poly, &POLY.replace("2 4 0 7", "2 4 -4.9e-324 7"));
    assert_eq!(tiny.points[1].y, -f64::from_bits(1));
}

// spec: X3
#[test]
fn counts_that_lie_cost_nothing() {
    for count in ["1099511627776", "9223372036854775807"] {
        for text in [
            format!("{count} 2 0 0\n1 0 0\n"),
            format!("1 2 {count} 0\n1 0 0\n"),
            format!("1 2 0 0\n1 0 0\n{count} 0\n"),
            format!("1 2 0 0\n1 0 0\n0 0\n{count}\n"),
            format!("1 2 0 0\n1 0 0\n0 0\n0\n{count}\n"),
        ] {
            let (message, id) = refused(DomainForm::Poly, &text);
            assert!(id == "X3" || id == "X4", "{message}");
        }
    }
    for count in ["-1", "18446744073709551616", "1e9", "three"] {
        let (_, id) = refused(DomainForm::Poly, &format!("{count} 2 0 0\n1 0 0\n"));
        assert!(id == "X4" || id == "X5");
    }
    refused(DomainForm::Poly, "3 3 0 0\n");
    refused(DomainForm::Poly, "3 2 0 2\n");
}

// spec: X3
#[test]
fn every_truncation_of_a_poly_file_by_lines_is_noticed() {
    let lines: Vec<&str> = POLY.lines().collect();
    for kept in 0..lines.len() {
        // The list of regions may be missing altogether.
        let may_end = kept == 22;
        assert_eq!(read(DomainForm::Poly, &lines[..kept].join("\n")).is_ok(), may_end, "{kept}");
    }
    refused(DomainForm::Poly, &format!("{POLY}1 2 3\n"));
}

// spec: X15
#[test]
fn line_ends_and_byte_order_marks_do_not_matter() {
    let json = "{\"outer\": [[0,0],\n[1,0],\n[0,1]]}\n";
    for (form, text) in [
        (DomainForm::Poly, POLY),
        (DomainForm::Airfoil, SELIG),
        (DomainForm::Airfoil, LEDNICER),
        (DomainForm::Json, json),
    ] {
        let plain = sound(form, text);
        for variant in [
            text.replace('\n', "\r\n"),
            format!("\u{feff}{text}"),
            text.trim_end().to_owned(),
            text.replace(' ', "\t "),
        ] {
            assert_eq!(sound(form, &variant), plain);
        }
    }
}

// spec: X1
#[test]
fn deep_nesting_is_refused() {
    for depth in [200, 100_000] {
        for open in [
            "[",
            "{\"outer\":",
            "{\"loops\":[",
            "{\"type\":\"GeometryCollection\",\"geometries\":[",
        ] {
            let text = open.repeat(depth);
            for form in FORMS {
                assert!(read(form, &text).is_err());
            }
        }
    }
}

// spec: X16
#[test]
fn forms_are_known_by_extension_and_by_content() {
    for (name, form) in [
        ("a.poly", DomainForm::Poly),
        ("b/c.POLY", DomainForm::Poly),
        ("a.json", DomainForm::Json),
        ("a.geojson", DomainForm::GeoJson),
        ("naca.dat", DomainForm::Airfoil),
    ] {
        assert_eq!(DomainForm::from_path(Path::new(name)), Some(form));
    }
    assert_eq!(DomainForm::from_path(Path::new("poly")), None);
    assert_eq!(DomainForm::from_extension("msh"), None);
    assert_eq!(DomainForm::sniff(POLY.as_bytes()), DomainForm::Poly);
    assert_eq!(DomainForm::sniff(SELIG.as_bytes()), DomainForm::Airfoil);
    assert_eq!(DomainForm::sniff(LEDNICER.as_bytes()), DomainForm::Airfoil);
    assert_eq!(DomainForm::sniff("\u{feff} {\"a\": 1}".as_bytes()), DomainForm::Json);
    assert_eq!(DomainForm::sniff(b""), DomainForm::Airfoil);
}

fn finite() -> impl Strategy<Value = f64> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO
}

fn points(most: usize) -> impl Strategy<Value = Vec<Point2>> {
    prop::collection::vec((finite(), finite()), 0..most)
        .prop_map(|list| list.into_iter().map(|(x, y)| Point2::new(x, y)).collect())
}

fn role() -> impl Strategy<Value = LoopRole> {
    prop_oneof![Just(LoopRole::Any), Just(LoopRole::Outer), (0_usize..9).prop_map(LoopRole::HoleOf)]
}

prop_compose! {
    /// Any domain at all, sound or not.
    fn domain()(
        points in points(30),
        markers in prop::collection::vec(any::<i32>(), 30),
        marked in any::<bool>(),
        loops in prop::collection::vec((prop::collection::vec((0_u32..30, any::<i32>()), 0..9), role()), 0..4),
        segments in prop::collection::vec((0_u32..30, 0_u32..30, any::<i32>()), 0..9),
        holes in prop::option::of(self::points(4)),
        regions in prop::collection::vec((finite(), finite(), any::<i32>(), prop::option::of(1e-300_f64..1e300)), 0..4),
    ) -> Domain {
        let mut domain = Domain::new(points);
        if marked {
            domain.point_markers = markers[..domain.points.len()].to_vec();
        }
        for (list, role) in loops {
            let (mut vertices, mut markers): (Vec<u32>, Vec<i32>) = list.into_iter().unzip();
            // Such a closing vertex is dropped by convention: the one thing that does not return.
            while vertices.len() > 1 && vertices.first() == vertices.last() {
                vertices.pop();
                markers.pop();
            }
            domain.loops.push(Loop { vertices, markers, role });
        }
        domain.segments = segments.into_iter().map(|(a, b, marker)| Segment { vertices: [a, b], marker }).collect();
        domain.inside = holes.map_or(Inside::EvenOdd, Inside::Carve);
        domain.regions = regions
            .into_iter()
            .map(|(x, y, marker, area_max)| Region { seed: Point2::new(x, y), marker, area_max })
            .collect();
        domain
    }
}

/// A domain's exact content: the bits of every number, without places.
fn content(domain: &Domain) -> String {
    let mut domain = domain.clone();
    domain.places = Default::default();
    format!("{domain:?}")
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    // spec: X17
    #[test]
    fn json_goes_out_and_in_unchanged(domain in domain()) {
        let mut file = Vec::new();
        domain_json::write(&domain, &mut file).unwrap();
        let back = domain_json::read(&file).map_err(|e| TestCaseError::fail(e.to_string()))?;
        prop_assert_eq!(content(&back), content(&domain));
    }

    // spec: X17
    #[test]
    fn poly_goes_out_and_in_unchanged(mut domain in domain()) {
        domain.loops.clear();
        let count = domain.points.len() as u32;
        domain.segments.retain(|s| s.vertices.iter().all(|&v| v < count));
        if domain.inside == Inside::EvenOdd || count == 0 {
            return Ok(());
        }
        let mut file = Vec::new();
        poly::write(&domain, &mut file).unwrap();
        let back = poly::read(&file, None).map_err(|e| TestCaseError::fail(e.to_string()))?;
        prop_assert_eq!(content(&back), content(&domain));
    }

    // spec: D16 X18
    #[test]
    fn any_domain_is_judged_without_panic(domain in domain()) {
        let _ = validate(&domain);
    }

    // spec: X18
    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        for form in FORMS {
            let _ = read_domain(&bytes, form, &ReadOptions { node: Some(&bytes), ..ReadOptions::default() });
        }
        let _ = DomainForm::sniff(&bytes);
    }

    // spec: X18
    #[test]
    fn damaged_files_are_read_or_refused(at in 0_usize..400, byte in any::<u8>(), cut in any::<bool>()) {
        let mut json = Vec::new();
        domain_json::write(&read(DomainForm::Poly, POLY).unwrap(), &mut json).unwrap();
        let texts = [POLY.as_bytes(), &json, SELIG.as_bytes(), LEDNICER.as_bytes()];
        for (text, form) in texts.into_iter().zip([DomainForm::Poly, DomainForm::Json, DomainForm::Airfoil, DomainForm::Airfoil]) {
            let mut bytes = text.to_vec();
            let at = at % bytes.len();
            if cut { bytes.truncate(at) } else { bytes[at] = byte }
            if let Ok(domain) = read_domain(&bytes, form, &ReadOptions::default()) {
                let _ = validate(&domain);
            }
        }
    }
}

// spec: X17
#[test]
fn writers_refuse_what_the_format_cannot_say() {
    let mut domain = sound(DomainForm::Poly, POLY);
    domain.inside = Inside::EvenOdd;
    assert!(poly::write(&domain, &mut Vec::new()).is_err());
    domain.points[0].x = f64::NAN;
    assert!(domain_json::write(&domain, &mut Vec::new()).is_err());
}
