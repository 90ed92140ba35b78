//! `trigrade study` and `trigrade compare` keep their promises.

#![cfg(feature = "cli")]

#[path = "common/program.rs"]
mod program;

use program::{assert_exit, names, program, run_in as run};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;
use std::time::Duration;
use tempfile::TempDir;

const STUDY: [&str; 9] =
    ["study", "--out", "study", "--size", "small", "--domain", "crack", "--domain", "airfoil"];

/// One study that the tests share.
fn shared() -> &'static (TempDir, Output) {
    static RUN: OnceLock<(TempDir, Output)> = OnceLock::new();
    RUN.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let output = run(folder.path(), &STUDY);
        (folder, output)
    })
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).expect("it is there")).expect("JSON")
}

// spec: K31
#[test]
fn a_study_leaves_a_page_tables_domains_and_pictures_and_nothing_else() {
    let (folder, output) = shared();
    assert_exit(output, 0);
    let expected = [
        "airfoil-close.png",
        "airfoil-raw.png",
        "airfoil.json",
        "airfoil.png",
        "crack-close.png",
        "crack-raw.png",
        "crack.json",
        "crack.png",
        "report.html",
        "study.csv",
        "study.json",
    ];
    let study = folder.path().join("study");
    assert_eq!(names(&study), expected);
    for name in expected.iter().filter(|name| name.ends_with(".png")) {
        let bytes = fs::read(study.join(name)).expect("it is there");
        assert!(bytes.starts_with(b"\x89PNG") && bytes.len() > 10_000, "{name}");
    }
    let page = fs::read_to_string(study.join("report.html")).expect("text");
    assert_eq!(page.matches("data:image/png;base64,iVBOR").count(), 6);
    for loader in ["http:", "https:", "href=", "url("] {
        assert!(!page.contains(loader), "{loader}");
    }
}

// spec: K32
#[test]
fn a_study_has_a_row_for_every_domain_system_and_setting() {
    let (folder, _) = shared();
    let study = json(&folder.path().join("study/study.json"));
    let rows = study["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 2 * 6 * 3);
    for row in rows {
        let figures = &row["figures"];
        assert!(figures["passed"] == true, "{row}");
        let ratio = |name: &str| figures[name].as_f64().expect("a number");
        assert!(1.0 <= ratio("ratio_mean") && ratio("ratio_mean") <= ratio("ratio_p99"), "{row}");
        assert!(ratio("ratio_p99") <= ratio("ratio_max") * 1.000_001, "{row}");
    }
    let csv = fs::read_to_string(folder.path().join("study/study.csv")).expect("text");
    assert_eq!(csv.lines().count(), rows.len() + 1);
}

// spec: K33
#[test]
fn verdicts_follow_from_the_rows_of_the_same_file() {
    let (folder, output) = shared();
    let study = json(&folder.path().join("study/study.json"));
    let find = |system: &str, setting: &str| {
        let rows = study["rows"].as_array().expect("rows");
        let row = rows.iter().find(|row| {
            row["domain"] == "airfoil" && row["system"] == system && row["setting"] == setting
        });
        row.expect("it is there")["figures"].clone()
    };
    let holds = |id: &str| {
        let claims = study["claims"].as_array().expect("claims");
        let claim = claims.iter().find(|claim| claim["id"] == id).expect("it is judged");
        claim["outcomes"][0]["holds"].clone()
    };
    let less = |a: &Value, b: &Value, name: &str| {
        Value::from(a[name].as_f64().expect("a number") < b[name].as_f64().expect("a number"))
    };
    let (graded, afm) = (find("graded", "raw"), find("afm", "raw"));
    assert_eq!(holds("afm-clashes"), less(&graded, &afm, "ratio_max"));
    let (graded, afm) = (find("graded", "own"), find("afm", "own"));
    assert_eq!(holds("gentler-sizes"), less(&graded, &afm, "area_ratio_p99"));
    let printed = String::from_utf8_lossy(&output.stdout);
    for claim in study["claims"].as_array().expect("claims") {
        assert!(printed.contains(claim["verdict"].as_str().expect("text")), "{claim}");
    }
}

// spec: K32
#[test]
fn a_row_can_be_made_again_from_the_files_of_the_study() {
    let (folder, _) = shared();
    let output = run(
        folder.path(),
        &["mesh", "study/airfoil.json", "-o", "again.msh", "--method", "afm", "--json"],
    );
    assert_exit(&output, 0);
    let again: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let study = json(&folder.path().join("study/study.json"));
    let rows = study["rows"].as_array().expect("rows");
    let row = rows.iter().find(|r| r["domain"] == "airfoil" && r["system"] == "afm");
    let figures = &row.expect("it is there")["figures"];
    assert_eq!(again["triangles"], figures["triangles"]);
    assert_eq!(again["quality"]["mean"], figures["ratio_mean"]);
}

// spec: K31
#[test]
fn an_unknown_domain_is_refused_with_the_nearest_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = run(folder.path(), &["study", "--out", "x", "--domain", "airfoi"]);
    assert_exit(&output, 2);
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(complaint.contains("'airfoil'"), "{complaint}");
    assert!(names(folder.path()).is_empty());
    fs::write(folder.path().join("file"), b"in the way").expect("written");
    assert_exit(&run(folder.path(), &["study", "--out", "file", "--size", "small"]), 2);
    assert_eq!(fs::read(folder.path().join("file")).expect("there"), b"in the way");
}

// spec: K31
#[cfg(unix)]
#[test]
fn an_interrupted_study_leaves_no_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut child = program()
        .current_dir(folder.path())
        .args(["study", "--out", "study", "--domain", "lake"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program runs");
    let study = folder.path().join("study");
    let is_staged = || study.is_dir() && !names(&study).is_empty();
    for _ in 0..2000 {
        if is_staged() {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(is_staged(), "outputs are staged before the work");
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().expect("kill runs").success());
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    assert_eq!(names(&study), [""; 0]);
}

/// Two meshes of the shared study's airfoil.
fn two_meshes() -> &'static TempDir {
    static MESHES: OnceLock<TempDir> = OnceLock::new();
    MESHES.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let domain = shared().0.path().join("study/airfoil.json");
        fs::copy(domain, folder.path().join("airfoil.json")).expect("copied");
        for (name, method) in [("a.off", "graded"), ("b.vtu", "delaunay")] {
            let words = ["mesh", "airfoil.json", "-o", name, "--method", method, "-q"];
            assert_exit(&run(folder.path(), &words), 0);
        }
        folder
    })
}

// spec: K35
#[test]
fn a_comparison_tells_every_metric_of_both_and_their_difference() {
    let folder = two_meshes().path();
    let words = ["compare", "a.off", "b.vtu", "--domain", "airfoil.json", "--json"];
    let output = run(folder, &words);
    assert_exit(&output, 0);
    let compared: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let figures = compared["figures"].as_array().expect("figures");
    assert_eq!(figures.len(), 3 * 13);
    for name in ["a.off", "b.vtu"] {
        let words = ["check", name, "--domain", "airfoil.json", "--json"];
        let checked: Value = serde_json::from_slice(&run(folder, &words).stdout).expect("JSON");
        let side = if name == "a.off" { "a" } else { "b" };
        assert_eq!(compared[side]["check"]["quality"], checked["quality"], "as `check` says");
        let summary = &checked["quality"]["metrics"][0];
        assert_eq!((&figures[0]["figure"], &figures[0][side]), (&"mean".into(), &summary["mean"]));
    }
    let [a, b] = ["a", "b"].map(|side| figures[0][side].as_f64().expect("a number"));
    assert_eq!(figures[0]["difference"].as_f64(), Some(b - a));
    assert_eq!(figures[0]["better"], if a < b { "a" } else { "b" });
}

// spec: K35 G20
#[test]
fn a_comparison_is_drawn_in_three_forms() {
    let folder = two_meshes().path();
    let words = ["compare", "a.off", "b.vtu", "-o", "c.svg", "-o", "c.png", "-o", "c.html", "-q"];
    assert_exit(&run(folder, &words), 0);
    let svg = fs::read_to_string(folder.join("c.svg")).expect("text");
    roxmltree::Document::parse(&svg).expect("XML");
    let page = fs::read_to_string(folder.join("c.html")).expect("text");
    assert!(page.contains("radius_ratio") && page.contains("<svg"));
    assert!(fs::read(folder.join("c.png")).expect("there").starts_with(b"\x89PNG"));
}

// spec: K35
#[test]
fn what_cannot_be_compared_leaves_nothing() {
    let folder = two_meshes().path();
    // A folder of its own: other tests write into the one of the meshes.
    let results = folder.join("results");
    fs::create_dir(&results).expect("made");
    for words in [
        &["compare", "a.off", "missing.off", "-o", "results/d.svg"][..],
        &["compare", "a.off", "b.vtu", "-o", "results/d.msh"],
        &["compare", "a.off", "b.vtu", "-o", "results/d.svg", "--window", "0,0,0,1"],
        &["compare", "a.off"],
    ] {
        assert_exit(&run(folder, words), 2);
    }
    assert_eq!(names(&results), [""; 0]);
    fs::write(folder.join("broken.off"), "OFF\n3 1 0\n0 0 0\n0 1 0\n1 0 0\n3 0 1 2\n")
        .expect("written");
    let output = run(folder, &["compare", "a.off", "broken.off"]);
    assert_exit(&output, 1);
    assert!(String::from_utf8_lossy(&output.stdout).contains("check failed"), "clockwise");
}
