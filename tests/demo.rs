//! The demonstration keeps its promises.

#![cfg(feature = "cli")]

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn demo(folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_trigrade"))
        .args(["demo", "--output"])
        .arg(folder)
        .output()
        .expect("the program runs")
}

fn report(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("report.json")).expect("the report is there");
    serde_json::from_str(&text).expect("the report is JSON")
}

// spec: K9
#[test]
fn it_leaves_checked_meshes_pictures_and_a_report() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let target = folder.path().join("demo");
    let output = demo(&target);
    let complaints = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{complaints}");
    for name in ["graded", "literal", "afm"] {
        for file in [format!("{name}.msh"), format!("{name}.svg"), format!("{name}-airfoil.svg")] {
            let size = fs::metadata(target.join(&file)).map_or(0, |about| about.len());
            assert!(size > 1000, "{file}: {size} bytes");
        }
        let check = Command::new(env!("CARGO_BIN_EXE_trigrade"))
            .arg("check")
            .arg(target.join(format!("{name}.msh")))
            .arg("--domain")
            .arg(target.join("naca0012.poly"))
            .output()
            .expect("the program runs");
        assert_eq!(check.status.code(), Some(0), "{name}");
    }
    let printed = String::from_utf8_lossy(&output.stdout);
    assert!(printed.contains("report.json"), "the paths are printed: {printed}");
}

// spec: K9
#[test]
fn the_default_mesh_is_a_good_one() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    assert_eq!(demo(folder.path()).status.code(), Some(0));
    let report = report(folder.path());
    let graded = &report["meshes"][0];
    assert_eq!(graded["verdict"], "passed", "{graded}");
    let triangles = graded["triangles"].as_u64().expect("a count");
    assert!((3_500..=9_000).contains(&triangles), "{triangles} triangles");
    let figure = |name: &str| graded["radius_ratio"][name].as_f64().expect("a number");
    assert!(figure("mean") <= 1.04, "mean {}", figure("mean"));
    assert!(figure("p99") <= 1.20, "99 % {}", figure("p99"));
    assert!(figure("max") <= 1.6, "max {}", figure("max"));
}

#[test]
fn a_second_run_replaces_the_first_and_gives_the_same_meshes() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    assert_eq!(demo(folder.path()).status.code(), Some(0));
    let first = fs::read(folder.path().join("graded.msh")).expect("there");
    assert_eq!(demo(folder.path()).status.code(), Some(0));
    assert_eq!(first, fs::read(folder.path().join("graded.msh")).expect("there"));
}

#[test]
fn a_file_where_the_folder_should_be_is_an_error() {
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    let output = demo(file.path());
    assert_eq!(output.status.code(), Some(2));
    assert!(!String::from_utf8_lossy(&output.stderr).contains("panicked"));
}
