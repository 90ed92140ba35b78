//! Sizes and counts as a user asks for them on the command line.

#![cfg(feature = "cli")]

#[path = "common/program.rs"]
mod program;

use program::{assert_exit, err, json, run_in};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;

/// A square of side 4 with ten segments a side, markers 1 to 4, in Triangle's form.
fn square() -> String {
    let at = |i: u32| match (i / 10, 0.4 * f64::from(i % 10)) {
        (0, t) => (t, 0.0),
        (1, t) => (4.0, t),
        (2, t) => (4.0 - t, 4.0),
        (_, t) => (0.0, 4.0 - t),
    };
    let mut text = "40 2 0 0\n".to_owned();
    for i in 0..40 {
        let (x, y) = at(i);
        text += &format!("{i} {x} {y}\n");
    }
    text += "40 1\n";
    for i in 0..40 {
        text += &format!("{i} {i} {} {}\n", (i + 1) % 40, 1 + i / 10);
    }
    text + "0\n"
}

const VIEW: &str = "View \"h\" {\nSQ(0,0,0,4,0,0,4,4,0,0,4,0){0.1,0.3,0.3,0.1};\n};\n";

fn run(folder: &Path, arguments: &[&str]) -> Output {
    run_in(folder, &[&["mesh", "square.poly", "--json"], arguments].concat())
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary directory");
    fs::write(folder.path().join("square.poly"), square()).expect("written");
    fs::write(folder.path().join("size.pos"), VIEW).expect("written");
    folder
}

#[track_caller]
fn summary(output: &Output) -> Value {
    assert_exit(output, 0);
    json(output)
}

// spec: K10
#[test]
fn every_way_to_ask_for_a_size_makes_a_checked_mesh() {
    let folder = folder();
    let ways: [&[&str]; 9] = [
        &["--spacing", "0.2"],
        &["--gradation", "uniform", "--spacing", "0.3"],
        &["--gradation", "0.2 + 0.1*abs(x - 2)"],
        &["--gradation", "-0.1 + min(H, 1)"],
        &["--gradation", "a*L1 + b*L2 + c*L3", "--density", "all-edges", "--limit-growth"],
        &["--method", "direct", "--gradation", "(D1*L2 + D2*L1)/(D1 + D2 + 1e-9)"],
        &["--spacing-at", "1=0.1", "--spacing-at", "3=0.2"],
        &["--source", "2,2,0.05", "--source", "1,1,0.1,0.5", "--source", "0,0,4,4,0.1"],
        &["--size-field", "size.pos"],
    ];
    for way in ways {
        let summary = summary(&run(folder.path(), &[way, &["-o", "out.off"]].concat()));
        assert_eq!(summary["verdict"], "passed", "{way:?}");
        assert!(summary["triangles"].as_u64().unwrap() > 8, "{way:?}");
        assert!(summary["edge_length_over_spacing"]["median"].as_f64().unwrap() > 0.4, "{way:?}");
    }
}

// spec: K10
#[test]
fn counts_are_predicted_chosen_and_coarsened() {
    let folder = folder();
    let dry = summary(&run(folder.path(), &["--spacing", "0.02", "--dry-run"]));
    assert!(dry["predicted"].as_f64().unwrap() > 50_000.0, "{dry}");
    let target = ["--spacing", "0.1", "--target", "2500", "-o", "out.off"];
    let count = summary(&run(folder.path(), &target))["triangles"].as_f64().unwrap();
    assert!((count / 2500.0 - 1.0).abs() <= 0.05, "{count}");
    let limit = ["--spacing", "0.02", "--max-triangles", "3000", "-o", "out.off"];
    let refused = run(folder.path(), &limit);
    assert_exit(&refused, 2);
    let errors = err(&refused);
    assert!(errors.contains("--coarsen") && errors.contains("--dry-run"), "{errors}");
    let coarsened = summary(&run(folder.path(), &[&limit[..], &["--coarsen"]].concat()));
    assert!(coarsened["triangles"].as_u64().unwrap() <= 3000, "{coarsened}");
}

// spec: !K10
#[test]
fn senseless_sizes_are_exit_2_and_name_what_is_wrong() {
    let folder = folder();
    fs::write(folder.path().join("bad.pos"), VIEW.replace("0.1,", "0,")).expect("written");
    let wrong: [(&[&str], &str); 9] = [
        (&["--gradation", "0.1 + wide"], "column 7"),
        (&["--gradation", "x - 1"], " at ("),
        (&["--gradation", "D1"], "column 1"),
        (&["--spacing-at", "1"], "MARKER=LENGTH"),
        (&["--source", "1,2"], "X,Y,H"),
        (&["--source", "1,2,0"], "above 0"),
        (&["--size-field", "absent.pos"], "absent.pos"),
        (&["--size-field", "bad.pos"], "positive and finite"),
        (&["--size-field", "square.poly"], ".msh"),
    ];
    for (arguments, word) in wrong {
        let output = run(folder.path(), &[arguments, &["-o", "out.off"]].concat());
        assert_exit(&output, 2);
        assert!(err(&output).contains(word), "{arguments:?}: {}", err(&output));
        assert!(!folder.path().join("out.off").exists(), "{arguments:?} left a file");
    }
}

// spec: K10 C70
#[test]
fn a_mesh_made_by_a_field_fits_it_when_checked() {
    let folder = folder();
    let _ = summary(&run(folder.path(), &["--size-field", "size.pos", "-o", "out.off"]));
    let check =
        |field: &str| run_in(folder.path(), &["check", "out.off", "--json", "--size", field]);
    let report = summary(&check("size.pos"));
    let median = report["edge_length_over_spacing"]["median"].as_f64().unwrap();
    assert!((0.8..1.2).contains(&median), "{median}");
    assert_exit(&check("absent.pos"), 2);
}
