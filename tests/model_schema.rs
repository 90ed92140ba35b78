//! The JSON schema of surface models, the reader and the examples say the same.

#[path = "common/models.rs"]
mod models;

use serde_json::{Value, json};
use trigrade::format::model_json;

fn validator() -> jsonschema::Validator {
    let schema = include_str!("../schemas/model-1.schema.json");
    let schema: Value = serde_json::from_str(schema).expect("JSON");
    jsonschema::validator_for(&schema).expect("a schema")
}

fn examples() -> Vec<(String, Value)> {
    let read =
        |(name, bytes): (String, Vec<u8>)| (name, serde_json::from_slice(&bytes).expect("JSON"));
    models::examples().into_iter().map(read).collect()
}

// spec: X64
#[test]
fn the_examples_meet_the_schema() {
    let validator = validator();
    assert!(examples().len() >= 9);
    for (name, model) in examples() {
        let faults: Vec<String> = validator.iter_errors(&model).map(|e| e.to_string()).collect();
        assert_eq!(faults, [""; 0], "{name}");
    }
}

/// Models of every kind of patch and curve.
fn sound() -> Vec<Value> {
    let circle = json!({"kind": "circle", "centre": [0, 0], "from": [0.2, 0], "normal": [0, 0, 1]});
    let line = |a: [i32; 3], b: [i32; 3]| json!({"kind": "polyline", "points": [a, b], "count": 3});
    let patch = |patch: Value| json!({"patches": [patch]});
    vec![
        json!({"patches": []}),
        json!({"format": "trigrade-model", "version": 1, "spacing": 0.1, "curves": [], "patches": []}),
        patch(
            json!({"kind": "bilinear", "net": [[[0, 0], [0, 1]], [[1, 0], [1, 1, 1]]], "marker": -3}),
        ),
        patch(
            json!({"kind": "bspline", "degrees": [1, 1], "net": [[[0, 0], [0, 1]], [[1, 0], [1, 1]]],
            "weights": [[1, 1], [1, 2]], "knots": [[0, 0, 1, 1], [0, 0, 1, 1]], "sides": {"west": {"count": 4, "marker": 2}}}),
        ),
        patch(
            json!({"kind": "plane", "corner": [0, 0], "u": [1, 0], "v": [0, 1], "holes": [[circle]], "reversed": true}),
        ),
        patch(
            json!({"kind": "plane", "corner": [0, 0], "u": [1, 0], "v": [0, 1], "outline": [{"curve": circle, "uv": circle}]}),
        ),
        patch(
            json!({"kind": "revolution", "profile": line([1, 0, 0], [1, 0, 1]), "axis": [0, 0, 2], "angles": [0, 90]}),
        ),
        patch(
            json!({"kind": "coons", "sides": {"south": line([0, 0, 0], [1, 0, 0]), "north": line([0, 1, 0], [1, 1, 0]),
            "west": line([0, 0, 0], [0, 1, 0]), "east": line([1, 0, 0], [1, 1, 0])}}),
        ),
    ]
}

/// A change, as the text of one place and what takes its place.
const WRONG: [(usize, &str, &str); 24] = [
    (0, r#""patches""#, r#""patch""#),
    (0, "[]", "{}"),
    (1, r#""trigrade-model""#, r#""trigrade-mesh""#),
    (1, r#""version":1"#, r#""version":2"#),
    (1, r#""spacing":0.1"#, r#""spacing":0"#),
    (1, r#""spacing":0.1"#, r#""spacing":"0.1""#),
    (1, r#""spacing":0.1"#, r#""angle_per_edge":121"#),
    (1, r#""spacing":0.1"#, r#""chord_error":-1"#),
    (1, r#""curves":[]"#, r#""curves":[{"kind":"polyline","points":[[0,0],[1,1]]}]"#),
    (2, r#""bilinear""#, r#""bilinar""#),
    (2, r#""marker":-3"#, r#""marker":3.5"#),
    (2, r#""marker":-3"#, r#""marker":99999999999"#),
    (2, "[0,0]", "[0]"),
    (2, "[0,0]", "[0,0,0,1]"),
    (2, r#""marker":-3"#, r#""degrees":[1,1]"#),
    (3, r#""degrees":[1,1]"#, r#""degrees":[1,16]"#),
    (3, r#""count":4"#, r#""count":0"#),
    (3, r#""count":4"#, r#""count":4,"spacing":1"#),
    (3, r#""west""#, r#""up""#),
    (4, r#""u":[1,0],"#, ""),
    (4, r#""reversed":true"#, r#""reversed":"yes""#),
    (5, r#""curve":"#, r#""arc":"#),
    (6, r#""angles":[0,90]"#, r#""angles":[90]"#),
    (7, r#""south""#, r#""down""#),
];

// spec: X64
#[test]
fn the_schema_and_the_reader_take_the_same_models() {
    let validator = validator();
    for model in sound() {
        let faults: Vec<String> = validator.iter_errors(&model).map(|e| e.to_string()).collect();
        assert_eq!(faults, [""; 0], "{model}");
        let read = model_json::read(model.to_string().as_bytes());
        assert!(read.is_ok(), "{model}: {}", read.unwrap_err());
    }
}

// spec: !X64
#[test]
fn the_schema_and_the_reader_refuse_the_same_models() {
    let (validator, sound) = (validator(), sound());
    for (index, from, to) in WRONG {
        let text = sound[index].to_string();
        let broken = text.replacen(from, to, 1);
        assert_ne!(broken, text, "{from} is not in {text}");
        let value: Value = serde_json::from_str(&broken).expect("still JSON");
        assert!(!validator.is_valid(&value), "the schema takes {broken}");
        assert!(model_json::read(broken.as_bytes()).is_err(), "the reader takes {broken}");
    }
}
