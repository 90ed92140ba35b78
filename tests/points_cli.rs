//! `trigrade delaunay` and `trigrade voronoi` as a user meets them.

#![cfg(feature = "cli")]

#[path = "common/program.rs"]
mod program;

use program::{assert_exit, err, out};
use serde_json::Value;
use std::fs;
use std::process::Output;
use tempfile::TempDir;

/// A square of nine points, one of them twice.
const CLOUD: &str =
    "x,y,name\n0,0,a\n1,0,b\n2,0,c\n0,1,d\n1,1,e\n2,1,f\n0,2,g\n1,2,h\n2,2,i\n1,1,e again\n";

/// A square with a wall that a second one crosses.
const WALLS: &str = "\
{\"outer\": [[0,0],[4,0],[4,4],[0,4]], \"segments\": [[[1,1],[3,3]],[[1,3],[3,1]]]}";

fn run(folder: &TempDir, arguments: &[&str]) -> Output {
    program::run_in(folder.path(), arguments)
}

fn run_with_input(folder: &TempDir, arguments: &[&str], input: &str) -> Output {
    program::run_with_input(folder.path(), arguments, input.as_bytes())
}

fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary directory");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("written");
    }
    folder
}

fn names(folder: &TempDir) -> Vec<String> {
    let entries = fs::read_dir(folder.path()).expect("a directory");
    let mut names: Vec<String> =
        entries.map(|e| e.expect("an entry").file_name().into_string().expect("UTF-8")).collect();
    names.sort();
    names
}

fn read(folder: &TempDir, name: &str) -> String {
    fs::read_to_string(folder.path().join(name)).expect("readable")
}

fn json(folder: &TempDir, name: &str) -> Value {
    serde_json::from_str(&read(folder, name)).expect("JSON")
}

// spec: K20 K1
#[test]
fn a_cloud_is_triangulated_checked_and_written_in_every_form() {
    let folder = folder(&[("cloud.csv", CLOUD)]);
    let outputs =
        ["a.off", "a.msh", "a.vtu", "a.ele", "a.json", "a.svg", "a.png", "a.ply", "a.stl"];
    let mut arguments = vec!["delaunay", "cloud.csv", "--check", "--timings", "--map", "map.json"];
    outputs.iter().for_each(|name| arguments.extend(["-o", name]));
    let output = run(&folder, &arguments);
    assert_exit(&output, 0);
    let text = out(&output);
    for told in
        ["10 points", "column `name`", "9 (line 11) repeats 4 (line 6)", "8 triangles", "passed"]
    {
        assert!(text.contains(told), "{told}: {text}");
    }
    assert!(outputs.iter().all(|name| names(&folder).contains(&(*name).to_owned())));
    assert_exit(&run(&folder, &["check", "a.off", "--delaunay"]), 0);
    let map = json(&folder, "map.json");
    assert_eq!(map["map"], serde_json::json!([0, 1, 2, 3, 4, 5, 6, 7, 8, 4]));
    assert_eq!(map["repeated"], serde_json::json!([[9, 4]]));
    assert_eq!(json(&folder, "a.json")["triangles"].as_array().map(Vec::len), Some(8));
}

// spec: K20
#[test]
fn every_engine_and_any_number_of_threads_write_the_same_bytes() {
    let folder = folder(&[("cloud.csv", CLOUD)]);
    assert_exit(&run(&folder, &["delaunay", "cloud.csv", "-o", "auto.json"]), 0);
    for engine in ["watson", "lawson", "fang-piegl", "divide-conquer", "sweep"] {
        let name = format!("{engine}.json");
        assert_exit(&run(&folder, &["delaunay", "cloud.csv", "--engine", engine, "-o", &name]), 0);
        assert_eq!(read(&folder, &name), read(&folder, "auto.json"), "{engine}");
    }
    let arguments =
        ["delaunay", "-", "--from", "csv", "-o", "-", "--form", "json", "--threads", "3"];
    let output = run_with_input(&folder, &arguments, CLOUD);
    assert_exit(&output, 0);
    assert_eq!(out(&output), read(&folder, "auto.json"));
}

// spec: K21
#[test]
fn points_without_triangles_have_a_readable_answer() {
    for (text, told) in [
        ("x,y\n", "no triangles: there is no point"),
        ("1,2\n", "there is one point"),
        ("1,2\n3,4\n", "there are two points"),
        ("0,0\n1,1\n2,2\n5,5\n", "all 4 points are on one line"),
    ] {
        let folder = folder(&[("few.csv", text)]);
        let arguments = ["delaunay", "few.csv", "-o", "a.off", "-o", "a.json", "-o", "a.svg"];
        let output = run(&folder, &arguments);
        assert_exit(&output, 0);
        assert!(out(&output).contains(told), "{}", out(&output));
        assert_eq!(json(&folder, "a.json")["triangles"], serde_json::json!([]));
        // A mesh without triangles is no pass.
        let checked = run(&folder, &["delaunay", "few.csv", "-o", "b.off", "--check"]);
        assert!(matches!(checked.status.code(), Some(1 | 2)), "{}", out(&checked));
        assert!(!names(&folder).contains(&"b.off".to_owned()));
    }
}

// spec: K22
#[test]
fn segments_are_constraints_and_crossings_are_named_or_cut() {
    let folder = folder(&[("walls.json", WALLS)]);
    let refused = run(&folder, &["delaunay", "walls.json", "-o", "a.off"]);
    assert_exit(&refused, 1);
    assert!(err(&refused).contains("--split-crossings"), "{}", err(&refused));
    let refused = run(&folder, &["delaunay", "walls.json", "-o", "a.off", "--hull"]);
    assert_exit(&refused, 1);
    let told = err(&refused);
    assert!(
        told.contains("error[T4]") && told.contains("(1.0, 1.0)") && told.contains("(1.0, 3.0)"),
        "{told}"
    );
    assert_eq!(names(&folder), ["walls.json"]);
    for extra in [&["--hull"][..], &[]] {
        let mut arguments =
            vec!["delaunay", "walls.json", "-o", "a.msh", "--split-crossings", "--check"];
        arguments.extend(extra);
        let output = run(&folder, &arguments);
        assert_exit(&output, 0);
        assert!(out(&output).contains("crossings  1 points"), "{}", out(&output));
    }
    let alone = [
        "delaunay",
        "walls.json",
        "-o",
        "a.off",
        "--unconstrained",
        "--engine",
        "sweep",
        "--check",
    ];
    assert_exit(&run(&folder, &alone), 0);
    let sweep = run(
        &folder,
        &[
            "delaunay",
            "walls.json",
            "-o",
            "b.off",
            "--hull",
            "--split-crossings",
            "--engine",
            "sweep",
        ],
    );
    assert_exit(&sweep, 2);
    assert!(err(&sweep).contains("divide-conquer"), "{}", err(&sweep));
}

// spec: K22
#[test]
fn a_domain_is_carved_unless_its_hull_is_asked_for() {
    const PLATE: &str = "8 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 1 1\n6 2 1\n7 2 2\n8 1 2\n8 1\n\
        1 1 2 1\n2 2 3 1\n3 3 4 1\n4 4 1 1\n5 5 6 2\n6 6 7 2\n7 7 8 2\n8 8 5 2\n1\n1 1.5 1.5\n";
    let folder = folder(&[("plate.poly", PLATE)]);
    let triangles = |extra: &[&str]| {
        let mut arguments = vec!["delaunay", "plate.poly", "-o", "a.json", "--check"];
        arguments.extend(extra);
        assert_exit(&run(&folder, &arguments), 0);
        json(&folder, "a.json")["triangles"].as_array().expect("a list").len()
    };
    assert_eq!(triangles(&[]), 8);
    assert_eq!(triangles(&["--engine", "divide-conquer"]), 8);
    assert_eq!(triangles(&["--hull"]), 10);
    assert_eq!(triangles(&["--unconstrained"]), 10);
    // Open breaklines enclose nothing.
    fs::write(folder.path().join("open.poly"), "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n1 0\n1 1 2\n0\n")
        .expect("written");
    let empty = run(&folder, &["delaunay", "open.poly", "-o", "b.off"]);
    assert_exit(&empty, 1);
    assert!(err(&empty).contains("--hull"), "{}", err(&empty));
    assert_exit(&run(&folder, &["delaunay", "open.poly", "-o", "b.off", "--hull"]), 0);
}

// spec: K4 K5
#[test]
fn unreadable_points_are_refused_with_their_place() {
    let folder =
        folder(&[("a.csv", "x,y\n1,2\n3,four\n"), ("a.npy", "\u{93}NUMPY"), ("a.xyz", "1 nan\n")]);
    for verb in ["delaunay", "voronoi"] {
        let bad = run(&folder, &[verb, "a.csv", "-o", "b.json"]);
        assert_exit(&bad, 2);
        assert!(err(&bad).contains("a.csv:3") && err(&bad).contains("error[X20]"), "{}", err(&bad));
        for arguments in [
            &[verb, "a.npy", "-o", "b.json"][..],
            &[verb, "a.xyz", "-o", "b.json"],
            &[verb, "missing.csv", "-o", "b.json"],
            &[verb, "-", "-o", "b.json"],
            &[verb, "a.csv", "--from", "cvs", "-o", "b.json"],
            &[verb, "a.csv", "-o", "b.xyz"],
            &[verb, "a.csv", "-o", "no/such/b.json"],
            &[verb, "a.csv"],
        ] {
            assert_exit(&run(&folder, arguments), 2);
        }
    }
    assert_eq!(names(&folder), ["a.csv", "a.npy", "a.xyz"], "nothing is left behind");
}

// spec: K23
#[test]
fn cells_are_written_in_every_form() {
    let folder = folder(&[("cloud.csv", CLOUD)]);
    let output = run(
        &folder,
        &["voronoi", "cloud.csv", "--timings", "-o", "a.json", "-o", "a.svg", "-o", "a.png"],
    );
    assert_exit(&output, 0);
    let text = out(&output);
    for told in ["9 cells", "9, 8 unbounded; 4 vertices, 12 edges", "repeats 4", "9 pieces"] {
        assert!(text.contains(told) || told == "9 cells", "{told}: {text}");
    }
    let cells = json(&folder, "a.json");
    assert_eq!(cells["schema"], "trigrade-voronoi/1");
    assert_eq!(cells["vertices"].as_array().map(Vec::len), Some(4));
    assert!(read(&folder, "a.svg").starts_with("<svg"));
    for clip in ["box", "-0.5,-0.5,2.5,2.5"] {
        assert_exit(&run(&folder, &["voronoi", "cloud.csv", "--clip", clip, "-o", "a.obj"]), 0);
        assert_eq!(read(&folder, "a.obj").matches("\nf ").count(), 9);
    }
    assert_exit(&run(&folder, &["voronoi", "cloud.csv", "-o", "b.obj"]), 2);
    assert_exit(&run(&folder, &["voronoi", "cloud.csv", "--clip", "1,1,0,0", "-o", "b.obj"]), 2);
    let plain = run_with_input(
        &folder,
        &["voronoi", "-", "--from", "csv", "-o", "-", "--form", "json"],
        CLOUD,
    );
    assert_exit(&plain, 0);
    let value: Value = serde_json::from_slice(&plain.stdout).expect("JSON");
    assert_eq!(value.get("clipped"), None);
}

// spec: K23
#[test]
fn cells_are_clipped_to_a_domain() {
    let wall = "{\"outer\": [[0,0],[4,0],[4,4],[0,4]], \"holes\": [[[1,1],[3,1],[3,3],[1,3]]]}";
    let folder = folder(&[("two.xyz", "0 2\n4 2\n"), ("frame.json", wall), ("bad.json", WALLS)]);
    let output = run(&folder, &["voronoi", "two.xyz", "--clip", "frame.json", "-o", "a.json"]);
    assert_exit(&output, 0);
    let pieces = json(&folder, "a.json")["clipped"]["pieces"].clone();
    assert_eq!(pieces.as_array().map(Vec::len), Some(2));
    let invalid = run(&folder, &["voronoi", "two.xyz", "--clip", "bad.json", "-o", "b.json"]);
    assert_exit(&invalid, 1);
    assert!(err(&invalid).contains("D8"), "{}", err(&invalid));
    assert_exit(&run(&folder, &["voronoi", "two.xyz", "--clip", "no.json", "-o", "b.json"]), 2);
}

// spec: K21 K23
#[test]
fn few_sites_have_cells_or_say_that_there_are_none() {
    for (text, cells) in [("x,y\n", 0), ("1,2\n", 1), ("1,2\n3,4\n", 2), ("0,0\n1,1\n5,5\n", 3)] {
        let folder = folder(&[("few.csv", text)]);
        let arguments =
            ["voronoi", "few.csv", "--clip", "box", "-o", "a.json", "-o", "a.obj", "-o", "a.svg"];
        assert_exit(&run(&folder, &arguments), 0);
        let value = json(&folder, "a.json");
        assert_eq!(value["cells"].as_array().map(Vec::len), Some(cells));
        assert_eq!(value["clipped"]["pieces"].as_array().map(Vec::len), Some(cells));
    }
}

// spec: K20
#[test]
fn reports_tell_the_check_of_a_triangulation() {
    let folder = folder(&[("cloud.csv", CLOUD)]);
    let junit =
        ["delaunay", "cloud.csv", "-o", "a.off", "--check", "--report", "junit=r.xml", "--json"];
    let output = run(&folder, &junit);
    assert_exit(&output, 0);
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(
        (&report["schema"], &report["verdict"]),
        (&"trigrade-delaunay/1".into(), &"passed".into())
    );
    assert!(read(&folder, "r.xml").contains("M23"));
    // Without a check there is no verdict to report.
    assert_exit(
        &run(&folder, &["delaunay", "cloud.csv", "-o", "a.off", "--report", "junit=r.xml"]),
        2,
    );
}

#[test]
fn help_fits_a_screen() {
    let folder = folder(&[]);
    for verb in ["delaunay", "voronoi"] {
        let output = run(&folder, &[verb, "-h"]);
        assert_exit(&output, 0);
        assert!(out(&output).lines().count() <= 48, "{}", out(&output));
        assert!(out(&run(&folder, &[verb, "--help"])).contains("SPEC"));
    }
}
