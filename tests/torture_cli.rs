//! `trigrade torture` as a user meets it.

#![cfg(all(feature = "cli", unix))]

#[path = "common/program.rs"]
mod program;

use program::{assert_exit, err, json, program, run, said};
use std::fs;
use std::process::{Command, Output, Stdio};

fn torture(arguments: &[&str]) -> Output {
    run(&[&["torture"], arguments].concat())
}

const SMALL: [&str; 5] = ["--cases", "40", "--max-size", "8", "--plain"];

// spec: R12 R10
#[test]
fn this_program_passes_and_that_is_exit_code_0() {
    let output = torture(&SMALL);
    assert_exit(&output, 0);
    assert!(said(&output).contains("self: 0 failures in 40 cases"), "{}", said(&output));
}

// spec: R12 R9
#[test]
fn failures_are_exit_code_1_with_reports_and_reproducers() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let out = folder.path().join("torture");
    let out_text = out.display().to_string();
    let extra = ["--mesher", "test -s {in} && exit 1", "--shrink", "1", "--trials", "5", "--json"];
    let arguments = [&SMALL[..], &extra, &["--out", &out_text]].concat();
    let output = torture(&arguments);
    assert_exit(&output, 1);
    let json = json(&output);
    assert_eq!(json["schema"], "trigrade-torture/1");
    assert_eq!(json["cases"], 40);
    assert!(json["verdicts"]["refused-valid"].as_u64() > Some(10), "{json}");
    for name in ["report.html", "report.json", "state.jsonl"] {
        assert!(out.join(name).is_file(), "{name}");
    }
    let below = json["reproducers"][0]["folder"].as_str().expect("a folder");
    for name in ["case.json", "original.json", "shrunk.json", "boundary.poly"] {
        assert!(out.join(below).join(name).is_file(), "{name}");
    }
    let replayed = torture(&["--replay", &out_text]);
    // This program meshes what another refused.
    assert_exit(&replayed, 0);
}

// spec: R12
#[test]
fn what_cannot_run_is_exit_code_2_and_says_what_would_help() {
    let cases: [(&[&str], &str); 8] = [
        (&["--mesher", "no-such-program-as-this {in} {out}"], "cannot be started"),
        (&["--mesher", "cat"], "{in}"),
        (&["--preset", "no-such"], "gmsh, triangle"),
        (&["--family", "no-such"], "--list"),
        (&["--form", "no-such"], "geojson"),
        (&["--replay", "no/such/folder"], "case.json"),
        (&["--memory", "1"], "16M"),
        (&["--timeout", "0"], "above 0"),
    ];
    for (arguments, expected) in cases {
        let output = torture(arguments);
        assert_exit(&output, 2);
        assert!(err(&output).contains(expected), "{arguments:?}: {}", err(&output));
    }
}

// spec: R6
#[test]
fn a_hang_and_a_crash_are_told_apart_and_end_nothing() {
    let small = ["--cases", "3", "--max-size", "5", "--shrink", "0", "--family", "stars", "--json"];
    let class = |extra: &[&str]| {
        let json = json(&torture(&[&small[..], extra].concat()));
        json["verdicts"].as_object().expect("counts").keys().cloned().collect::<Vec<_>>()
    };
    assert_eq!(class(&["--mesher", "sleep 60; : {in}", "--timeout", "0.2"]), ["hang"]);
    assert_eq!(class(&["--mesher", "kill -SEGV $$; : {in}"]), ["crash"]);
}

#[test]
fn the_list_names_families_and_presets() {
    let output = torture(&["--list"]);
    assert_exit(&output, 0);
    let said = said(&output);
    for name in ["near-collinear", "crossing-by-little", "invalid (D8)", "netgen", "mmg2d"] {
        assert!(said.contains(name), "{name}: {said}");
    }
}

// spec: R9
#[test]
fn verdicts_do_not_depend_on_the_number_of_threads() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let verdicts = |threads: &str| {
        let out = folder.path().join(threads).display().to_string();
        let extra = ["--mesher", "test -s {in} && exit 1", "--shrink", "0", "--threads", threads];
        torture(&[&SMALL[..], &extra, &["--out", &out]].concat());
        let text = fs::read_to_string(format!("{out}/report.json")).expect("a report");
        let mut json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let list = json["failed"].as_array_mut().expect("failures");
        list.iter_mut().for_each(|record| record["seconds"] = 0.into());
        json["failed"].clone()
    };
    assert_eq!(verdicts("1"), verdicts("3"));
}

// spec: K2 R6
#[test]
fn an_interrupt_ends_the_meshers_too() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let [begun, survived] = ["begun", "survived"].map(|name| folder.path().join(name));
    let (note, trace) = (begun.display(), survived.display());
    let mesher = format!("touch '{note}'; (sleep 4; touch '{trace}') & sleep 300; : {{in}}");
    let mut torture = program()
        .args(["torture", "--mesher", &mesher, "--form", "json"])
        .args(["--cases", "1", "--timeout", "300"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program runs");
    let pause = |milliseconds| std::thread::sleep(std::time::Duration::from_millis(milliseconds));
    (0..4000).take_while(|_| !begun.exists()).for_each(|_| pause(5));
    assert!(begun.exists(), "the mesher is under way");
    let status = Command::new("kill").args(["-INT", &torture.id().to_string()]).status();
    assert!(status.expect("kill runs").success());
    assert_eq!(torture.wait().expect("the program ends").code(), Some(130));
    pause(4500);
    assert!(!survived.exists(), "a child of the mesher went on");
}
