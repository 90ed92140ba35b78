//! Surface models on the command line.

#![cfg(feature = "cli")]

#[path = "common/program.rs"]
mod program;

use program::run;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Output;

fn example(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/models");
    folder.join(name).display().to_string()
}

fn text(path: &Path) -> String {
    path.display().to_string()
}

#[track_caller]
fn assert_exit(output: &Output, exit: i32) -> String {
    program::assert_exit(output, exit);
    program::err(output) + &program::out(output)
}

// spec: K11
#[test]
fn a_model_is_meshed_in_every_form_and_checked_against_itself() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let outputs: Vec<PathBuf> = ["msh", "vtu", "stl", "obj", "ply", "off"]
        .map(|e| folder.path().join(format!("a.{e}")))
        .into();
    let model = example("sphere.json");
    let mut arguments = vec!["mesh".to_owned(), model.clone(), "--spacing".into(), "0.3".into()];
    arguments.extend(outputs.iter().flat_map(|path| ["-o".to_owned(), text(path)]));
    let told = assert_exit(&run(&arguments.iter().map(String::as_str).collect::<Vec<_>>()), 0);
    assert!(told.contains("chord error") && told.contains("closed"), "{told}");
    for path in &outputs {
        let checked = run(&["check", &text(path), "--surface", &model, "--closed"]);
        let told = assert_exit(&checked, 0);
        assert!(told.contains("Euler number 2, closed"), "{told}");
    }
    let strict = ["check", &text(&outputs[0]), "--surface", &model, "--chord-error", "1e-6"];
    let told = assert_exit(&run(&strict), 1);
    assert!(told.contains("error[S8]"), "{told}");
    let other = ["check", &text(&outputs[0]), "--surface", &example("torus.json")];
    assert!(assert_exit(&run(&other), 1).contains("error[S10]"));
}

// spec: K11
#[test]
fn curvature_flags_and_json_reports() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let mesh = text(&folder.path().join("a.off"));
    let model = example("torus.json");
    let count = |more: &[&str]| {
        let all = [&["mesh", "--json", "-o", &mesh, &model][..], more].concat();
        let output = run(&all);
        assert_exit(&output, 0);
        let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(json["verdict"], "passed");
        assert_eq!(json["surface"]["euler"], 0);
        json["triangles"].as_u64().expect("a count")
    };
    let coarse = count(&["--spacing", "0.3"]);
    assert!(count(&["--spacing", "0.3", "--chord-error", "0.005"]) > coarse);
    assert!(count(&["--spacing", "0.3", "--angle-per-edge", "15"]) > coarse);
}

// spec: !K11
#[test]
fn what_cannot_be_done_is_told() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let mesh = text(&folder.path().join("a.off"));
    let broken = folder.path().join("broken.json");
    std::fs::write(&broken, r#"{"patches": [{"kind": "disk"}]}"#).expect("written");
    let told = assert_exit(&run(&["mesh", &text(&broken), "-o", &mesh]), 2);
    assert!(told.contains("$.patches[0].kind"), "{told}");
    let none = folder.path().join("none.json");
    std::fs::write(&none, r#"{"patches": []}"#).expect("written");
    assert!(assert_exit(&run(&["mesh", &text(&none), "-o", &mesh]), 1).contains("no patch"));
    let model = example("sphere.json");
    let told = assert_exit(&run(&["mesh", &model, "--spacing", "1e-5", "-o", &mesh]), 2);
    assert!(told.contains("--max-triangles"), "{told}");
    assert!(!folder.path().join("a.off").exists(), "nothing is left behind");
}

// spec: S2 S5
#[test]
fn a_plane_domain_may_have_curved_loops() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let (domain, mesh) = (folder.path().join("d.json"), text(&folder.path().join("a.off")));
    let spline =
        r#"{"kind": "bspline", "points": [[0, 0], [2, -1], [4, 1], [6, 0]], "spacing": 0.4}"#;
    let arc = r#"{"kind": "arc", "points": [[6, 0], [3, 4], [0, 0]], "count": 20, "marker": 9}"#;
    let hole = r#"{"kind": "circle", "centre": [3, 2], "from": [4, 2], "chord_error": 0.01}"#;
    let loops =
        format!(r#"{{"loops": [{{"curves": [{spline}, {arc}]}}, {{"curves": [{hole}]}}]}}"#);
    std::fs::write(&domain, &loops).expect("written");
    assert_exit(&run(&["mesh", &text(&domain), "-o", &mesh]), 0);
    assert_exit(&run(&["check", &mesh, "--domain", &text(&domain)]), 0);
    for (from, to, expected) in [
        ("[6, 0], [3, 4]", "[6, 0.25], [3, 4]", "error[S5]"),
        (r#", "spacing": 0.4"#, "", "spacing"),
        (r#""chord_error": 0.01"#, r#""chord_error": 0"#, "error[S2]"),
        ("[3, 4]", "[3, 0]", "error[S1]"),
        ("[2, -1]", "[2, -1, 1]", "plane"),
    ] {
        std::fs::write(&domain, loops.replacen(from, to, 1)).expect("written");
        let told = assert_exit(&run(&["mesh", &text(&domain), "-o", &mesh]), 2);
        assert!(told.contains(expected), "{told}");
    }
}
