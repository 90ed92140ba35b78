//! Every option of `trigrade mesh` with a model as input: it changes what comes out, or it is refused
//! by its name with the reason.

#![cfg(feature = "cli")]

#[path = "common/program.rs"]
mod program;

use program::{err, out, run};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// What becomes of an option.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fate {
    /// The mesh is another one.
    Mesh,
    /// The mesh is the same, and what is told or written beside it is another.
    Told,
    /// Exit code 2, and the option is named.
    Refused,
}
use Fate::{Mesh, Refused, Told};

/// Options with a value, under which others (behind the first list) each has its fate.
const CASES: &[(&[&str], &[&str], Fate)] = &[
    (&["--method", "direct-surface"], &[], Mesh),
    (&["--method", "transfinite"], &[], Mesh),
    (&["--method", "elliptic"], &[], Mesh),
    (&["--method", "afm"], &[], Refused),
    (&["--method", "direct"], &[], Refused),
    (&["--method", "delaunay"], &[], Refused),
    (&["--method", "delaunay-initial"], &[], Refused),
    (&["--density", "all-edges"], &[], Refused),
    (&["--gradation", "uniform"], &["--spacing", "0.3"], Mesh),
    (&["--gradation", "0.1 + 0.1*x"], &[], Mesh),
    (&["--gradation", "mean"], &[], Refused),
    (&["--gradation", "third"], &[], Refused),
    (&["--gradation", "uniform"], &["--method", "elliptic"], Refused),
    (&["--growth", "0.6"], &["--spacing", "0.3"], Mesh),
    (&["--growth", "0.6"], &["--method", "transfinite"], Refused),
    (&["--limit-growth"], &[], Refused),
    (&["--clamp", "1.05"], &[], Mesh),
    (&["--clamp", "1.05"], &["--method", "transfinite"], Refused),
    (&["--clamp", "1.05"], &["--method", "direct-surface"], Refused),
    (&["--spacing", "0.2"], &[], Mesh),
    (&["--spacing-at", "1=0.1"], &[], Refused),
    (&["--source", "0,0,0.1"], &[], Refused),
    (&["--size-field", "field.pos"], &[], Refused),
    (&["--order", "shortest"], &[], Mesh),
    (&["--order", "shortest"], &["--method", "elliptic"], Refused),
    (&["--rules", "hard"], &[], Mesh),
    (&["--rules", "hard"], &["--method", "direct-surface"], Refused),
    (&["--max-triangles", "10"], &[], Refused),
    (&["--max-area", "0.1"], &[], Refused),
    (&["--min-angle", "20"], &[], Refused),
    (&["--corners", "0,1,2,3"], &[], Refused),
    (&["--quads"], &["--method", "transfinite"], Mesh),
    (&["--quads"], &[], Refused),
    (&["--split-boundary"], &[], Refused),
    (&["--coarsen"], &[], Refused),
    (&["--target", "500"], &[], Refused),
    (&["--optimize", "0"], &[], Mesh),
    (&["--optimize", "0"], &["--method", "transfinite"], Refused),
    (&["--no-improve"], &[], Mesh),
    (&["--no-improve"], &["--method", "elliptic"], Refused),
    (&["--chord-error", "0.001"], &[], Mesh),
    (&["--angle-per-edge", "4"], &[], Mesh),
    (&["--farfield", "15,60"], &[], Refused),
    (&["--from", "nurbs"], &[], Refused),
    (&["--dry-run"], &[], Told),
    (&["--no-check"], &[], Told),
    (&["--timings"], &[], Told),
    (&["--json"], &[], Told),
    (&["--quiet"], &[], Told),
    (&["--verbose"], &[], Told),
];

/// Options that the table cannot try so simply, and what holds them.
const ELSEWHERE: &[(&str, &str)] = &[
    ("--output", "every case here"),
    ("--weld", "tests/iges.rs"),
    ("--form", "tests/surface_cli.rs"),
    ("--certificate", "tests/surface_cli.rs"),
    ("--report", "tests/reports.rs"),
    ("--threads", "tests/parts.rs: the answer is the same for any number"),
    ("--help", "it is read here"),
];

/// A bent patch with a finer side: small, and not the same by any two rules.
const MODEL: &str = r#"{"format": "trigrade-model", "version": 1, "spacing": 0.25, "patches": [
    {"kind": "bezier", "sides": {"south": {"spacing": 0.08}}, "net": [
        [[0, 0, 0], [0, 0.5, 0.3], [0, 1, 0]],
        [[0.5, 0, 0.2], [0.5, 0.6, 1.2], [0.5, 1.1, 0]],
        [[1, 0, 0], [1.1, 0.5, 0.1], [1, 1, 0.4]]]}]}"#;

/// Exit code, mesh, and what was told.
fn meshed(folder: &Path, flags: &[&str]) -> (Option<i32>, Option<Vec<u8>>, String) {
    let target: PathBuf = folder.join("a.off");
    let _ = fs::remove_file(&target);
    let model = folder.join("model.json");
    fs::write(&model, MODEL).expect("written");
    let (model, name) = (model.display().to_string(), target.display().to_string());
    let output = run(&[&["mesh", &model, "-o", &name][..], flags].concat());
    (output.status.code(), fs::read(&target).ok(), err(&output) + &out(&output))
}

// spec: K44
#[test]
fn every_option_is_heeded_or_refused_by_its_name() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let mut plain_runs = BTreeMap::new();
    for &(flags, under, fate) in CASES {
        let all = [under, flags].concat();
        let (exit, mesh, told) = meshed(folder.path(), &all);
        if fate == Refused {
            assert_eq!((exit, &mesh), (Some(2), &None), "{all:?}: {told}");
            // A form that the file is not in shows by what is missing.
            let is_form = flags[0] == "--from" && told.contains("'degree_u' is missing");
            assert!(told.contains(flags[0]) || is_form, "{all:?}: {told}");
            continue;
        }
        assert_eq!(exit, Some(0), "{all:?}: {told}");
        let run = || meshed(folder.path(), under);
        let (_, plain, told_before) = plain_runs.entry(under).or_insert_with(run);
        assert!(plain.is_some(), "{under:?}: {told_before}");
        match fate {
            Mesh => assert!(mesh.is_some() && mesh != *plain, "{all:?} changes nothing: {told}"),
            // Times differ from run to run.
            _ => {
                let shape = |text: &str| text.replace(|c: char| c.is_ascii_digit(), "");
                assert_ne!(shape(&told), shape(told_before), "{all:?} tells nothing");
            }
        }
    }
}

// spec: K44
#[test]
fn the_table_has_every_option_of_the_verb() {
    let help = out(&run(&["mesh", "--help"]));
    let words = help.split(|c: char| !(c.is_ascii_lowercase() || c == '-'));
    let lines = help.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
    let of_line = |line: &str| {
        let word = line.split([' ', '=', '[']).find(|word| word.starts_with("--"));
        // `--verbose...` may be given more than once.
        word.map(|word| word.trim_end_matches('.').to_owned())
    };
    let known: BTreeSet<String> = CASES
        .iter()
        .map(|(flags, ..)| flags[0].to_owned())
        .chain(ELSEWHERE.iter().map(|(flag, _)| (*flag).to_owned()))
        .collect();
    let listed: BTreeSet<String> = lines.filter_map(of_line).collect();
    assert!(listed.len() > 35, "{listed:?}");
    let missing: Vec<_> = listed.difference(&known).collect();
    assert!(missing.is_empty(), "options that no case tries on a model: {missing:?}");
    let words: BTreeSet<&str> = words.collect();
    let gone: Vec<_> = known.iter().filter(|flag| !words.contains(flag.as_str())).collect();
    assert!(gone.is_empty(), "options that are none: {gone:?}");
}

// spec: K45
#[test]
fn options_of_models_are_refused_for_plane_domains() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let domain = folder.path().join("a.poly");
    let square = "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n";
    fs::write(&domain, square).expect("written");
    let name = domain.display().to_string();
    for flags in [["--chord-error", "0.1"], ["--angle-per-edge", "9"], ["--weld", "0.1"]] {
        let output = run(&[&["mesh", &name, "--dry-run"][..], &flags].concat());
        assert_eq!(output.status.code(), Some(2));
        let told = err(&output);
        assert!(told.contains(flags[0]) && told.contains("surface models only"), "{told}");
    }
}
