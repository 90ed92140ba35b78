//! The demonstration keeps its promises.

#![cfg(feature = "cli")]

#[path = "common/program.rs"]
mod program;

use program::{assert_exit, out, program, run};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;
use std::sync::OnceLock;
use tempfile::TempDir;

/// One run that the tests share.
fn shared() -> &'static (TempDir, Output) {
    static RUN: OnceLock<(TempDir, Output)> = OnceLock::new();
    RUN.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let output = demo(folder.path());
        (folder, output)
    })
}

fn demo(folder: &Path) -> Output {
    program().args(["demo", "--output"]).arg(folder).output().expect("the program runs")
}

fn report(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("report.json")).expect("the report is there");
    serde_json::from_str(&text).expect("the report is JSON")
}

// spec: K9
#[test]
fn it_leaves_checked_meshes_pictures_and_a_report() {
    let (folder, output) = shared();
    let target = folder.path();
    assert_exit(output, 0);
    for name in ["graded", "literal", "afm"] {
        for file in [format!("{name}.msh"), format!("{name}.svg"), format!("{name}-airfoil.svg")] {
            let size = fs::metadata(target.join(&file)).map_or(0, |about| about.len());
            assert!(size > 1000, "{file}: {size} bytes");
        }
        let [mesh, domain] = [&format!("{name}.msh"), "naca0012.poly"]
            .map(|name| target.join(name).to_str().expect("UTF-8").to_owned());
        assert_exit(&run(&["check", &mesh, "--domain", &domain]), 0);
    }
    assert!(out(output).contains("report.json"), "the paths are printed: {}", out(output));
}

// spec: K9
#[test]
fn the_default_mesh_is_a_good_one() {
    let report = report(shared().0.path());
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
fn a_second_run_gives_the_same_meshes_and_pictures() {
    // A folder of another name, and one that does not exist yet.
    let folder = tempfile::tempdir().expect("a temporary directory");
    let again = folder.path().join("some/where");
    assert_exit(&demo(&again), 0);
    for name in ["graded.msh", "afm.msh", "literal-airfoil.svg", "naca0012.poly"] {
        let read = |folder: &Path| fs::read(folder.join(name)).expect("there");
        assert!(read(&again) == read(shared().0.path()), "{name} differs");
    }
}

#[test]
fn a_file_where_the_folder_should_be_is_an_error() {
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    assert_exit(&demo(file.path()), 2);
}
