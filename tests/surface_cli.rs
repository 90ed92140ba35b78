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

/// A sphere's mesh as OFF, and the same with a triangle turned over.
fn sphere_and_fold(folder: &Path) -> [String; 2] {
    let sound = folder.join("sound.off");
    let arguments = ["mesh", &example("sphere.json"), "--spacing", "0.3", "-o", &text(&sound)];
    assert_exit(&run(&arguments), 0);
    let mesh = std::fs::read_to_string(&sound).expect("an OFF file");
    let line = mesh.lines().rev().nth(20).expect("a triangle").to_owned();
    let [three, a, b, c] = line.split_whitespace().collect::<Vec<_>>()[..] else {
        panic!("{line}")
    };
    let folded = folder.join("folded.off");
    let turned = mesh.replacen(&line, &format!("{three} {b} {a} {c}"), 1);
    std::fs::write(&folded, turned).expect("written");
    [text(&sound), text(&folded)]
}

// spec: C60 S9 S8
#[test]
fn findings_against_a_model_are_in_every_form_of_report() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let [sound, folded] = sphere_and_fold(folder.path());
    let model = example("sphere.json");
    for (form, failed) in [
        ("junit", "<failure"),
        ("sarif", "\"ruleId\": \"S9\""),
        ("github", "::error"),
        ("gitlab", "S9"),
        ("tap", "not ok"),
        ("json", "\"id\": \"S9\""),
        ("text", "error[S9]"),
    ] {
        let file = folder.path().join(form);
        let report = format!("{form}={}", text(&file));
        let told = |mesh: &str, exit| {
            let arguments = ["check", mesh, "--surface", &model, "--report", &report];
            assert_exit(&run(&arguments), exit);
            std::fs::read_to_string(&file).expect("the report")
        };
        let found = told(&folded, 1);
        assert!(found.contains("S9") && found.contains(failed), "{form}: {found}");
        assert!(!told(&sound, 0).contains(failed), "{form}");
    }
    let strict = ["check", &sound, "--surface", &model, "--chord-error", "1e-6", "--json"];
    let output = run(&strict);
    assert_exit(&output, 1);
    let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let counts = json["counts"].as_array().expect("counts");
    assert_eq!((counts.len(), &counts[0]["id"]), (1, &Value::from("S8")), "{counts:?}");
    assert!(counts[0]["count"].as_u64() > counts[0]["listed"].as_u64(), "all are counted");
    let allowed = [&strict[..6], &["--allow", "S8"]].concat();
    assert_exit(&run(&allowed), 0);
    let plain = run(&["check", &sound, "--json"]);
    let json: Value = serde_json::from_slice(&plain.stdout).expect("JSON");
    let skipped = json["not_checked"].as_array().expect("a list").iter().map(|e| &e["id"]);
    assert_eq!(skipped.filter(|id| id.as_str().is_some_and(|id| id.starts_with('S'))).count(), 4);
}

// spec: C60
#[test]
fn certificates_name_the_model_and_the_limits() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let file = |name: &str| text(&folder.path().join(name));
    let (mesh, paper) = (file("a.msh"), file("a.cert.json"));
    let (model, other) = (example("sphere.json"), example("torus.json"));
    let made = ["mesh", &model, "--spacing", "0.3", "-o", &mesh, "--certificate", &paper];
    assert_exit(&run(&made), 0);
    let confirm = ["check", &mesh, "--surface", &model, "--verify-certificate", &paper];
    assert!(assert_exit(&run(&confirm), 0).contains("confirmed"));
    let told = assert_exit(&run(&["check", &mesh, "--verify-certificate", &paper]), 1);
    assert!(told.contains("with a surface model"), "{told}");
    let wrong = ["check", &mesh, "--surface", &other, "--verify-certificate", &paper];
    assert!(assert_exit(&run(&wrong), 1).contains("model is another file"));
    let strict =
        ["check", &mesh, "--surface", &model, "--chord-error", "0.1", "--certificate", &paper];
    assert_exit(&run(&strict), 0);
    let json: Value = serde_json::from_slice(&std::fs::read(&paper).expect("there")).expect("JSON");
    assert_eq!(json["surface"]["limits"]["chord_error"], 0.1);
    assert_exit(&run(&confirm), 0);
}

// spec: X60 X62
#[test]
fn bezier_patch_files_are_models() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let (patches, mesh) = (folder.path().join("two.bpt"), text(&folder.path().join("a.off")));
    let two = "2\n1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n1 1\n1 0 0\n1 1 0\n2 0 1\n2 1 1\n";
    std::fs::write(&patches, two).expect("written");
    let told = assert_exit(&run(&["mesh", &text(&patches), "--spacing", "0.2", "-o", &mesh]), 0);
    assert!(told.contains("2 smooth patches between 7 curves"), "{told}");
    assert_exit(&run(&["check", &mesh, "--surface", &text(&patches)]), 0);
    std::fs::write(&patches, two.replace("2 1 1\n", "")).expect("written");
    let told = assert_exit(&run(&["mesh", &text(&patches), "-o", &mesh]), 2);
    assert!(told.contains("two.bpt:11") && told.contains("control point"), "{told}");
}

// spec: K11 S8 S9
#[test]
fn a_form_without_regions_is_checked_against_all_patches() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let mesh = text(&folder.path().join("teapot.stl"));
    assert_exit(&run(&["mesh", &example("teapot.json"), "-o", &mesh]), 0);
}

// spec: K38
#[test]
fn an_iges_file_is_meshed_checked_and_welded() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let mesh = text(&folder.path().join("part.vtu"));
    let model = example("tube.igs");
    let told = assert_exit(&run(&["mesh", &model, "--spacing", "0.3", "-o", &mesh]), 0);
    assert!(told.contains("lengths are in millimetres") && told.contains("closed"), "{told}");
    let told = assert_exit(&run(&["check", &mesh, "--surface", &model, "--closed"]), 0);
    assert!(told.contains("Euler number 2, closed"), "{told}");
    let welded = ["mesh", &model, "--spacing", "0.3", "--weld", "1e-4", "--json", "-o", &mesh];
    let output = run(&welded);
    assert_exit(&output, 0);
    let told: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert!(told["notes"][0].as_str().is_some_and(|note| note.contains("millimetres")), "{told}");
    let check = ["check", &mesh, "--surface", &model, "--weld", "1e-4"];
    assert_exit(&run(&check), 0);
    let cut = folder.path().join("cut.igs");
    let whole = std::fs::read(&model).expect("the example");
    std::fs::write(&cut, &whole[..whole.len() / 2]).expect("writable");
    let told = assert_exit(&run(&["mesh", &text(&cut), "-o", &mesh]), 2);
    assert!(told.contains("cut.igs:"), "{told}");
    for wrong in ["0", "-1", "nan"] {
        let weld = format!("--weld={wrong}");
        assert_exit(&run(&["mesh", &model, &weld, "-o", &mesh]), 2);
    }
}

// spec: K39
#[test]
fn grids_of_domains_and_models_are_written_as_quadrilaterals() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let square = text(&folder.path().join("square.json"));
    let points = "[[0,0],[1,0],[2,0],[2,1],[2,2],[1,2],[0,2],[0,1]]";
    std::fs::write(&square, format!(r#"{{"outer": {points}}}"#)).expect("writable");
    let mesh = |name: &str| text(&folder.path().join(name));
    let grid = ["--method", "elliptic", "--corners", "0,2,4,6", "--quads"];
    for name in ["a.msh", "a.vtu", "a.vtk", "a.off", "a.obj", "a.su2"] {
        let out = mesh(name);
        let all = [&["mesh", &square, "-o", &out][..], &grid].concat();
        assert_exit(&run(&all), 0);
        let told = assert_exit(&run(&["check", &out, "--split-quads", "--domain", &square]), 0);
        assert!(told.contains("8 triangles, 9 points"), "{told}");
        assert_exit(&run(&["check", &out, "--domain", &square]), 2);
    }
    for (name, more, exit, word) in [
        ("a.stl", &grid[..], 2, "cannot carry the quadrilaterals"),
        ("c.vtu", &["--quads"][..], 2, "transfinite or elliptic only"),
    ] {
        let out = mesh(name);
        let told = assert_exit(&run(&[&["mesh", &square, "-o", &out][..], more].concat()), exit);
        assert!(told.contains(word), "{told}");
        assert!(name == "a.stl" || !Path::new(&out).exists(), "{out}");
    }
    let model = mesh("patch.json");
    let bent = r#"{"patches": [{"kind": "bezier", "net": [[[0,0,0],[0,1,1],[0,2,0]], [[2,0,0],[2,1,1],[2,2,0]]]}]}"#;
    std::fs::write(&model, bent).expect("writable");
    let out = mesh("patch.vtu");
    let all =
        ["mesh", &model, "--spacing", "0.5", "--method", "transfinite", "--quads", "-o", &out];
    assert_exit(&run(&all), 0);
    let check = ["check", &out, "--split-quads", "--surface", &model];
    assert_exit(&run(&check), 0);
    assert_exit(
        &run(&check.map(|word| if word == "--split-quads" { "--timings" } else { word })),
        2,
    );
}

// spec: W10
#[test]
fn a_cell_that_is_not_convex_is_no_quadrilateral() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let domain = text(&folder.path().join("arrow.json"));
    std::fs::write(&domain, r#"{"outer": [[0,0],[2,0],[0.5,0.5],[0,2]]}"#).expect("writable");
    let out = text(&folder.path().join("arrow.vtu"));
    let all = ["mesh", &domain, "--method", "transfinite", "--corners", "0,1,2,3", "-o", &out];
    assert_exit(&run(&all), 0);
    let told = assert_exit(&run(&[&all[..], &["--quads"]].concat()), 1);
    assert!(told.contains("1 cells of the grid are not convex") && told.contains("W10"), "{told}");
}
