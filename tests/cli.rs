//! The program as a user meets it: exit codes, broken inputs, nothing left behind.

#![cfg(feature = "cli")]

#[path = "common/program.rs"]
mod program;

use program::{assert_exit, err, names, out, program, run, run_in};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

fn run_with_input(arguments: &[&str], input: &[u8]) -> Output {
    program::run_with_input(Path::new("."), arguments, input)
}

/// A square with a square hole, in Triangle's form.
const PLATE: &str = "\
# a plate with a hole
8 2 0 0
1 0 0
2 4 0
3 4 4
4 0 4
5 1 1
6 2 1
7 2 2
8 1 2
8 1
1 1 2 1
2 2 3 1
3 3 4 1
4 4 1 1
5 5 6 2
6 6 7 2
7 7 8 2
8 8 5 2
1
1 1.5 1.5
";

/// The same outer square with two corners exchanged: it crosses itself.
const BOW_TIE: &str = "4 2 0 0\n1 0 0\n2 4 4\n3 4 0\n4 0 4\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n";

/// A folder with the plate in it.
fn folder() -> (TempDir, String) {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let plate = folder.path().join("plate.poly");
    fs::write(&plate, PLATE).expect("written");
    let plate = text(&plate);
    (folder, plate)
}

fn text(path: &Path) -> String {
    path.to_str().expect("UTF-8").to_owned()
}

fn at(folder: &TempDir, name: &str) -> String {
    text(&folder.path().join(name))
}

/// Whether this user may write where the mode says nobody may (root may).
fn is_above_permissions(folder: &Path) -> bool {
    let probe = folder.join("probe");
    let is_written = fs::write(&probe, b"").is_ok();
    let _ = fs::remove_file(probe);
    is_written
}

// --- exit codes -----------------------------------------------------------------------------

// spec: K1
#[test]
fn help_and_version_exit_0() {
    for arguments in [&["--help"][..], &["--version"], &["mesh", "--help"], &["help", "check"]] {
        let output = run(arguments);
        assert_exit(&output, 0);
        assert!(!out(&output).is_empty(), "{arguments:?}");
    }
    let help = out(&run(&["--help"]));
    for verb in ["mesh", "check", "demo", "explain", "convert", "plot"] {
        assert!(help.contains(verb), "{verb} is missing in the help");
    }
}

// spec: K1
#[test]
fn usage_errors_exit_2() {
    for arguments in [
        &[][..],
        &["mush"],
        &["mesh"],
        &["mesh", "a.poly"],
        &["mesh", "a.poly", "-o", "a.off", "--growth", "-1"],
        &["mesh", "a.poly", "-o", "a.off", "--growth", "nan"],
        &["mesh", "a.poly", "-o", "a.off", "--method", "magic"],
        &["mesh", "a.poly", "-o", "a.off", "--threads", "0"],
        &["check"],
        &["check", "a.off", "--report", "yaml=x"],
    ] {
        assert_exit(&run(arguments), 2);
    }
}

// spec: K1 K4
#[test]
fn a_mistyped_verb_gets_the_right_one_suggested() {
    assert!(err(&run(&["mehs"])).contains("mesh"));
    assert!(err(&run(&["mesh", "a.poly", "-o", "a.off", "--metod", "afm"])).contains("--method"));
}

// --- mesh -----------------------------------------------------------------------------------

// spec: K1 K2 K8
#[test]
fn a_domain_is_meshed_checked_and_written_in_every_form() {
    let (folder, plate) = folder();
    let forms = ["a.msh", "a.off", "a.vtu", "a.ele", "a.svg", "a.png"];
    let mut arguments = vec!["mesh".to_owned(), plate.clone()];
    for form in forms {
        arguments.extend(["-o".to_owned(), at(&folder, form)]);
    }
    let output = run(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    assert_exit(&output, 0);
    assert!(out(&output).contains("triangles"), "{}", out(&output));
    let expected =
        ["a.edge", "a.ele", "a.msh", "a.node", "a.off", "a.png", "a.svg", "a.vtu", "plate.poly"];
    assert_eq!(names(folder.path()), expected);
    for form in ["a.msh", "a.off", "a.ele"] {
        assert_exit(&run(&["check", &at(&folder, form), "--domain", &plate]), 0);
    }
}

// spec: K8
#[test]
fn a_checked_mesh_passes_the_check_on_its_own() {
    let (folder, plate) = folder();
    for method in ["graded", "afm", "direct", "delaunay-initial", "delaunay"] {
        let mesh = at(&folder, &format!("{method}.off"));
        assert_exit(&run(&["mesh", &plate, "-o", &mesh, "--method", method]), 0);
        assert_exit(&run(&["check", &mesh, "--domain", &plate]), 0);
    }
}

#[test]
fn standard_input_and_output_carry_domain_and_mesh() {
    let (folder, plate) = folder();
    let file = at(&folder, "a.off");
    assert_exit(&run(&["mesh", &plate, "-o", &file]), 0);
    let arguments = ["mesh", "-", "--from", "poly", "-o", "-", "--form", "off"];
    let output = run_with_input(&arguments, PLATE.as_bytes());
    assert_exit(&output, 0);
    assert_eq!(out(&output), fs::read_to_string(&file).expect("readable"), "the same bytes");
    let check = run_with_input(&["check", "-", "--from", "off"], &output.stdout);
    assert_exit(&check, 0);
}

#[test]
fn standard_output_needs_a_form_and_only_one_use() {
    let (_folder, plate) = folder();
    assert_exit(&run(&["mesh", &plate, "-o", "-"]), 2);
    assert!(err(&run(&["mesh", &plate, "-o", "-"])).contains("--form"));
    assert_exit(&run(&["mesh", &plate, "-o", "-", "--form", "off", "--json"]), 2);
    assert_exit(&run(&["mesh", &plate, "-o", "-", "-o", "-", "--form", "off"]), 2);
}

#[test]
fn an_unknown_extension_lists_the_known_ones() {
    let (folder, plate) = folder();
    let output = run(&["mesh", &plate, "-o", &at(&folder, "a.mhs")]);
    assert_exit(&output, 2);
    assert!(err(&output).contains("msh"), "{}", err(&output));
    assert_eq!(names(folder.path()), ["plate.poly"]);
}

#[test]
fn a_dry_run_predicts_and_writes_nothing() {
    let (folder, plate) = folder();
    let output = run(&["mesh", &plate, "--dry-run"]);
    assert_exit(&output, 0);
    assert!(out(&output).contains("triangles"), "{}", out(&output));
    assert_eq!(names(folder.path()), ["plate.poly"]);
}

// spec: K1 K2
#[test]
fn too_many_triangles_are_refused_before_any_work() {
    let (folder, plate) = folder();
    let mesh = at(&folder, "a.off");
    let output = run(&["mesh", &plate, "-o", &mesh, "--gradation", "uniform", "--spacing", "1e-9"]);
    assert_exit(&output, 2);
    assert!(err(&output).contains("--max-triangles"), "{}", err(&output));
    assert_eq!(names(folder.path()), ["plate.poly"]);
}

#[test]
fn quiet_is_silent_and_json_is_json() {
    let (folder, plate) = folder();
    let mesh = at(&folder, "a.off");
    let quiet = run(&["mesh", &plate, "-o", &mesh, "--quiet"]);
    assert_exit(&quiet, 0);
    assert_eq!((out(&quiet), err(&quiet)), (String::new(), String::new()));
    let json = run(&["mesh", &plate, "-o", &mesh, "--json"]);
    assert_exit(&json, 0);
    let report: serde_json::Value = serde_json::from_str(&out(&json)).expect("one JSON value");
    assert_eq!(report["verdict"], "passed", "{report}");
    assert!(report["triangles"].as_u64().is_some_and(|n| n >= 8), "{report}");
}

#[test]
fn a_report_goes_to_its_file() {
    let (folder, plate) = folder();
    let (mesh, report) = (at(&folder, "a.off"), at(&folder, "report.json"));
    let target = format!("json={report}");
    assert_exit(&run(&["mesh", &plate, "-o", &mesh, "--report", &target]), 0);
    let text = fs::read_to_string(&report).expect("written");
    serde_json::from_str::<serde_json::Value>(&text).expect("JSON");
}

// --- broken domains -------------------------------------------------------------------------

/// Meshes `text` and expects a complaint that holds all `words`, and nothing written.
#[track_caller]
fn assert_refused(name: &str, bytes: &[u8], exit: i32, words: &[&str]) {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let domain = folder.path().join(name);
    fs::write(&domain, bytes).expect("written");
    let output = run(&["mesh", &text(&domain), "-o", &at(&folder, "out.off")]);
    assert_exit(&output, exit);
    for word in words {
        assert!(err(&output).contains(word), "`{word}` is missing in: {}", err(&output));
    }
    assert_eq!(names(folder.path()), [name], "nothing is left behind");
}

// spec: K1 K4
#[test]
fn a_loop_that_crosses_itself_is_invalid() {
    assert_refused("bow.poly", BOW_TIE.as_bytes(), 1, &["error[D", "bow.poly:", "explain D"]);
}

// spec: K1 K4
#[test]
fn a_coordinate_that_is_no_number_is_named() {
    let nan = PLATE.replace("3 4 4\n", "3 nan 4\n");
    let folder = tempfile::tempdir().expect("a temporary directory");
    let domain = folder.path().join("nan.poly");
    fs::write(&domain, nan).expect("written");
    let output = run(&["mesh", &text(&domain), "-o", &at(&folder, "out.off")]);
    assert!(matches!(output.status.code(), Some(1 | 2)), "{}", err(&output));
    // The comment and the header are lines 1 and 2.
    assert!(err(&output).contains("nan.poly:5"), "{}", err(&output));
    assert_eq!(names(folder.path()), ["nan.poly"]);
}

// spec: K4
#[test]
fn all_faults_are_named_at_once() {
    let text = "6 2 0 0\n1 0 0\n2 4 4\n3 4 0\n4 0 4\n5 9 9\n6 9 9\n5 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n\
        5 5 6\n0\n";
    assert_refused("two.poly", text.as_bytes(), 1, &["error[D8]", "error[D4]"]);
}

// spec: K5
#[test]
fn broken_domain_files_are_malformed() {
    assert_refused("empty.poly", b"", 2, &["empty"]);
    assert_refused("cut.poly", &PLATE.as_bytes()[..60], 2, &["cut.poly:"]);
    assert_refused("garbage.poly", &[0xff, 0, 0x80, 7, 200, 13], 2, &["garbage.poly"]);
    assert_refused("cut.json", b"{\"outer\": [[0, 0], [1, 0], [1,", 2, &["cut.json"]);
    assert_refused("words.json", b"\"no domain\"", 2, &["words.json"]);
    assert_refused("unknown.xyz", PLATE.as_bytes(), 2, &["unknown.xyz", "poly"]);
}

// spec: K5
#[test]
fn a_count_of_2_to_the_40_allocates_nothing() {
    let text = PLATE.replace("8 2 0 0", "1099511627776 2 0 0");
    assert_refused("huge.poly", text.as_bytes(), 2, &["huge.poly:"]);
    let text = PLATE.replace("8 2 0 0", "-8 2 0 0");
    assert_refused("negative.poly", text.as_bytes(), 2, &["negative.poly:"]);
}

// --- broken meshes --------------------------------------------------------------------------

#[track_caller]
fn check(name: &str, bytes: &[u8], exit: i32, words: &[&str]) {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let mesh = folder.path().join(name);
    fs::write(&mesh, bytes).expect("written");
    let output = run(&["check", &text(&mesh)]);
    assert_exit(&output, exit);
    let said = out(&output) + &err(&output);
    for word in words {
        assert!(said.contains(word), "`{word}` is missing in: {said}");
    }
}

// spec: K1
#[test]
fn sound_and_unsound_meshes() {
    check("good.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 0, &[]);
    check("flat.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n", 1, &["M8"]);
    let overlap = b"OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0.2 0.2 0\n3 0 1 2\n3 0 1 3\n";
    check("overlap.off", overlap, 1, &["[M"]);
}

// spec: K1
#[test]
fn a_gate_that_is_missed_fails_unless_allowed() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let mesh = at(&folder, "a.off");
    // A right triangle with legs 1 and 4: R / 2r is 2.35, the smallest angle 14 degrees.
    fs::write(&mesh, "OFF\n3 1 0\n0 0 0\n4 0 0\n0 1 0\n3 0 1 2\n").expect("written");
    assert_exit(&run(&["check", &mesh, "--max-aspect", "2.4", "--min-angle", "14"]), 0);
    for gate in [["--max-aspect", "2.3"], ["--min-angle", "15"], ["--gate", "edge_ratio <= 4"]] {
        let missed = run(&["check", &mesh, gate[0], gate[1]]);
        assert_exit(&missed, 1);
        assert!(out(&missed).contains("MISSED"), "{}", out(&missed));
        assert_exit(&run(&["check", &mesh, gate[0], gate[1], "--allow", "Q1"]), 0);
    }
    assert_exit(&run(&["check", &mesh, "--gate", "beauty >= 1"]), 2);
    assert_exit(&run(&["check", &mesh, "--allow", "Z9"]), 2);
}

// spec: K5
#[test]
fn broken_mesh_files_are_malformed() {
    check("empty.off", b"", 2, &["empty"]);
    check("cut.off", b"OFF\n3 1 0\n0 0 0\n1 0", 2, &["cut.off:"]);
    check("huge.off", b"OFF\n1099511627776 1 0\n0 0 0\n", 2, &["huge.off:"]);
    check("garbage.msh", &[0, 159, 146, 150], 2, &["garbage.msh"]);
    check("unknown.xyz", b"OFF of a kind", 2, &["unknown.xyz"]);
}

// spec: K1
#[test]
fn a_mesh_of_another_domain_is_found_out() {
    let (folder, plate) = folder();
    let mesh = at(&folder, "a.off");
    assert_exit(&run(&["mesh", &plate, "-o", &mesh]), 0);
    let larger = at(&folder, "larger.poly");
    fs::write(&larger, PLATE.replace("3 4 4\n", "3 4.5 4.5\n")).expect("written");
    let output = run(&["check", &mesh, "--domain", &larger]);
    assert_exit(&output, 1);
    let json = run(&["check", &mesh, "--domain", &larger, "--json"]);
    assert_exit(&json, 1);
    let report: serde_json::Value = serde_json::from_str(&out(&json)).expect("one JSON value");
    assert_eq!(report["verdict"], "failed", "{report}");
}

// --- files ----------------------------------------------------------------------------------

// spec: K5
#[test]
fn files_that_cannot_be_read() {
    let (folder, plate) = folder();
    let mesh = at(&folder, "out.off");
    let missing = run(&["mesh", &at(&folder, "plat.poly"), "-o", &mesh]);
    assert_exit(&missing, 2);
    assert!(err(&missing).contains("plate.poly"), "the nearest name: {}", err(&missing));
    let directory = run(&["mesh", &text(folder.path()), "--from", "poly", "-o", &mesh]);
    assert_exit(&directory, 2);
    assert!(err(&directory).contains("directory"), "{}", err(&directory));
    let domain = run(&["check", &plate, "--from", "off"]);
    assert_exit(&domain, 2);
    assert_eq!(names(folder.path()), ["plate.poly"]);
}

// spec: K5
#[test]
fn places_that_cannot_be_written() {
    let (folder, plate) = folder();
    let missing = run(&["mesh", &plate, "-o", &at(&folder, "no/such/out.off")]);
    assert_exit(&missing, 2);
    assert!(err(&missing).contains("does not exist"), "{}", err(&missing));
    fs::create_dir(folder.path().join("dir.off")).expect("created");
    let directory = run(&["mesh", &plate, "-o", &at(&folder, "dir.off")]);
    assert_exit(&directory, 2);
    assert!(err(&directory).contains("directory"), "{}", err(&directory));
    // One impossible output: none appears.
    let both = run(&["mesh", &plate, "-o", &at(&folder, "a.off"), "-o", &at(&folder, "dir.off")]);
    assert_exit(&both, 2);
    assert_eq!(names(folder.path()), ["dir.off", "plate.poly"]);
}

// spec: K5
#[cfg(unix)]
#[test]
fn no_permission() {
    use std::os::unix::fs::PermissionsExt;
    let (folder, plate) = folder();
    let closed = folder.path().join("closed");
    fs::create_dir(&closed).expect("created");
    fs::set_permissions(&closed, fs::Permissions::from_mode(0o555)).expect("set");
    let output = run(&["mesh", &plate, "-o", &text(&closed.join("out.off"))]);
    if is_above_permissions(&closed) {
        // The system asks no permission of this user: then it must work.
        assert_exit(&output, 0);
    } else {
        assert_exit(&output, 2);
        assert!(err(&output).contains("permission denied"), "{}", err(&output));
        assert_eq!(names(&closed), [""; 0]);
    }
    let read_only = folder.path().join("old.off");
    fs::write(&read_only, b"old").expect("written");
    fs::set_permissions(&read_only, fs::Permissions::from_mode(0o444)).expect("set");
    assert_exit(&run(&["mesh", &plate, "-o", &text(&read_only)]), 2);
    assert_eq!(fs::read(&read_only).expect("there"), b"old", "the old file is untouched");
}

/// A square with n edges on each side: more than a million triangles when n is 800.
fn square(n: usize) -> String {
    let mut text = format!("{} 2 0 0\n", 4 * n);
    for i in 0..4 * n {
        let t = (i % n) as f64;
        let m = n as f64;
        let (x, y) = [(t, 0.0), (m, t), (m - t, m), (0.0, m - t)][i / n];
        text += &format!("{} {x} {y}\n", i + 1);
    }
    text += &format!("{} 0\n", 4 * n);
    for i in 0..4 * n {
        text += &format!("{} {} {}\n", i + 1, i + 1, (i + 1) % (4 * n) + 1);
    }
    text + "0\n"
}

// spec: K2
#[cfg(unix)]
#[test]
fn an_interrupt_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let mesh = at(&folder, "out.off");
    let domain = folder.path().join("square.poly");
    fs::write(&domain, square(800)).expect("written");
    let mut child = program()
        .args(["mesh", &text(&domain), "-o", &mesh, "--gradation", "uniform"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program runs");
    // The temporary file appears before the long work: then it is time.
    let is_staged = || names(folder.path()).iter().any(|name| name.starts_with(".trigrade-"));
    for _ in 0..2000 {
        if is_staged() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(is_staged(), "the output is staged beside its target");
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().expect("kill runs").success());
    let status = child.wait().expect("the program ends");
    assert_eq!(status.code(), Some(130));
    assert_eq!(names(folder.path()), ["square.poly"]);
}

// --- the small verbs ------------------------------------------------------------------------

// spec: K3
#[test]
fn explain_prints_the_rule() {
    let output = run(&["explain", "K3"]);
    assert_exit(&output, 0);
    assert!(out(&output).contains("cli.explain") && out(&output).contains("strength"));
    assert_eq!(out(&run(&["explain", "cli.explain"])), out(&output));
    let unknown = run(&["explain", "K303"]);
    assert_exit(&unknown, 2);
    assert!(err(&unknown).contains("did you mean"), "{}", err(&unknown));
    assert!(out(&run(&["explain"])).lines().count() > 5, "the list of all rules");
}

#[test]
fn completions_and_manual() {
    for shell in ["bash", "zsh", "fish"] {
        let output = run(&["completions", shell]);
        assert_exit(&output, 0);
        assert!(out(&output).contains("trigrade"), "{shell}");
    }
    assert!(out(&run(&["man"])).contains(".TH trigrade"));
    assert_exit(&run(&["completions", "tcl"]), 2);
}

#[test]
fn convert_keeps_every_bit() {
    let (folder, plate) = folder();
    let [off, msh, ele, again] = ["a.off", "b.msh", "c.ele", "d.off"].map(|n| at(&folder, n));
    assert_exit(&run(&["mesh", &plate, "-o", &off]), 0);
    assert_exit(&run(&["convert", &off, "-o", &msh]), 0);
    assert_exit(&run(&["convert", &msh, "-o", &ele]), 0);
    assert_exit(&run(&["convert", &ele, "-o", &again]), 0);
    assert_eq!(fs::read(&off).expect("there"), fs::read(&again).expect("there"));
    assert_exit(&run(&["convert", &off, "-o", &at(&folder, "x.nonsense")]), 2);
}

/// One square and one triangle beside it.
const SQUARE_AND_TRIANGLE: &str =
    "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0.5 0\n4 0 1 2 3\n3 1 4 2\n";

#[test]
fn quadrilaterals_are_split_on_request_and_said_otherwise() {
    let (folder, _) = folder();
    let [off, msh] = ["q.off", "q.msh"].map(|n| at(&folder, n));
    fs::write(&off, SQUARE_AND_TRIANGLE).expect("writable");
    let left_out = run(&["check", &off]);
    assert!(out(&left_out).contains("quad"), "{}", out(&left_out));
    assert!(out(&left_out).contains("1 triangle"), "{}", out(&left_out));
    let split = run(&["check", &off, "--split-quads"]);
    assert_exit(&split, 0);
    assert!(out(&split).contains("3 triangles"), "{}", out(&split));
    assert_exit(&run(&["convert", &off, "--split-quads", "-o", &msh]), 0);
    assert!(out(&run(&["check", &msh])).contains("3 triangles"));
}

// spec: C60
#[test]
fn a_certificate_covers_all_files_of_a_mesh() {
    let (folder, plate) = folder();
    let [ele, node, certificate] = ["c.ele", "c.node", "c.json"].map(|n| at(&folder, n));
    assert_exit(&run(&["mesh", &plate, "-o", &ele, "--certificate", &certificate]), 0);
    let verify = ["check", &ele, "--domain", &plate, "--verify-certificate", &certificate];
    assert_exit(&run(&verify), 0);
    let nodes = fs::read_to_string(&node).expect("there");
    fs::write(&node, format!("{nodes}# changed\n")).expect("writable");
    let changed = run(&verify);
    assert_exit(&changed, 1);
    assert!(out(&changed).contains("NOT CONFIRMED"), "{}", out(&changed));
}

/// Found by torture: the spokes of a fan at coordinates that subnormal numbers round.
const SUBNORMAL: &str = r#"{"format": "trigrade-domain", "version": 1, "points": [[0.0, 0.0],
[-3e-319, 0.0], [0.0, 2e-319], [-2.145e-319, 0.0], [-2.145e-319, 7e-321], [-2.145e-319, 6.6e-321],
[-2.146e-319, 4e-320]], "loops": [{"vertices": [0, 1, 2], "marker": 1, "role": "outer"}],
"segments": [{"vertices": [3, 4], "marker": 0}, {"vertices": [5, 6], "marker": 0}],
"inside": "even-odd"}"#;

#[test]
fn points_of_a_fan_are_kept_by_subnormal_numbers() {
    let (folder, _) = folder();
    let [domain, mesh] = ["s.json", "s.off"].map(|n| at(&folder, n));
    fs::write(&domain, SUBNORMAL).expect("writable");
    let output = run(&["mesh", &domain, "-o", &mesh]);
    assert_exit(&output, 0);
}

#[test]
fn plot_draws() {
    let (folder, plate) = folder();
    let [off, svg, png] = ["a.off", "a.svg", "a.png"].map(|n| at(&folder, n));
    assert_exit(&run(&["mesh", &plate, "-o", &off]), 0);
    assert_exit(&run(&["plot", &off, "-o", &svg, "-o", &png, "--window", "0,0,2,2"]), 0);
    assert!(fs::read_to_string(&svg).expect("text").contains("<svg"));
    assert!(fs::read(&png).expect("there").starts_with(b"\x89PNG"));
    assert_exit(&run(&["plot", &off, "-o", &svg, "--window", "2,0,0,2"]), 2);
    assert_exit(&run(&["plot", &off, "-o", &at(&folder, "b.off")]), 2);
}

// spec: K30
#[test]
fn plot_colours_by_any_metric_and_marks_what_check_finds() {
    let (folder, plate) = folder();
    let [off, svg, html] = ["a.off", "a.svg", "a.html"].map(|n| at(&folder, n));
    assert_exit(&run(&["mesh", &plate, "-o", &off]), 0);
    let mut pictures = Vec::new();
    for colour in ["radius_ratio", "min_angle", "gradation", "area_spread", "none"] {
        assert_exit(&run(&["plot", &off, "-o", &svg, "--colour", colour]), 0);
        pictures.push(fs::read_to_string(&svg).expect("text"));
    }
    for (i, picture) in pictures.iter().enumerate() {
        assert!(!pictures[..i].contains(picture), "{i}");
    }
    let unknown = run(&["plot", &off, "-o", &svg, "--colour", "beauty"]);
    assert_exit(&unknown, 2);
    assert!(err(&unknown).contains("radius_ratio"), "{}", err(&unknown));

    let marks = |mesh: &str| {
        assert_exit(&run(&["plot", mesh, "-o", &html, "--domain", &plate]), 0);
        let page = fs::read_to_string(&html).expect("text");
        assert!(page.contains("id=\"data-spacing\"") && page.contains("data-background-points"));
        page.contains("\"label\":\"M")
    };
    assert!(!marks(&off), "a sound mesh has no findings");
    let text = fs::read_to_string(&off).expect("text");
    let broken = at(&folder, "b.off");
    let last = text.trim_end().rfind('\n').expect("lines");
    let count = text.lines().nth(1).expect("counts");
    let numbers: Vec<usize> =
        count.split_whitespace().map(|n| n.parse().expect("a count")).collect();
    let fewer = format!("{} {} {}", numbers[0], numbers[1] - 1, numbers[2]);
    fs::write(&broken, text[..=last].replacen(count, &fewer, 1)).expect("written");
    assert!(marks(&broken), "a triangle is missing");
}

// spec: G21
#[test]
fn a_viewer_of_a_new_mesh_carries_its_size_field() {
    let (folder, plate) = folder();
    let html = at(&folder, "a.html");
    let page = |arguments: &[&str]| {
        let words = [&["mesh", plate.as_str(), "-o", &html], arguments].concat();
        assert_exit(&run(&words), 0);
        fs::read_to_string(&html).expect("text")
    };
    let graded = page(&["--spacing", "0.5"]);
    assert!(graded.contains("wanted spacing") && graded.contains("id=\"data-spacing\""));
    let refined = page(&["--method", "delaunay", "--min-angle", "20"]);
    assert!(!refined.contains("\"wanted spacing\""), "no spacing was asked for");
    assert!(!refined.contains("id=\"data-spacing\"") && refined.contains("data-background-points"));
}

#[test]
fn a_closed_pipe_is_no_crash() {
    let mut child = program()
        .args(["completions", "bash"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("the program ends");
    assert!(!err(&output).contains("panicked"), "{}", err(&output));
}

#[test]
fn committed_examples_can_be_meshed() {
    let examples = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("examples/domains");
    for name in names(&examples) {
        let path = text(&examples.join(&name));
        let output = run(&["mesh", &path, "-o", "-", "--form", "off", "--quiet"]);
        assert_exit(&output, 0);
    }
}

// spec: K42
#[test]
fn misspelt_words_are_met_by_those_that_were_meant() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let path = folder.path();
    fs::write(
        path.join("square.poly"),
        "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n",
    )
    .expect("written");
    let slips = [
        ("mseh square.poly -o a.msh", "mesh"),
        ("mesh square.poly -o a.msh --gradtion mean", "--gradation"),
        ("mesh square.poly -o a.msh --method grade", "graded"),
        ("mesh square.poly -o a.msh --gradation grwoth", "did you mean `growth`?"),
        ("mesh sqare.poly -o a.msh", "did you mean `square.poly`?"),
        ("mesh square.poly -o a.mhs", "did you mean `msh`?"),
        ("mesh square.poly -o a.msh --form ofg", "did you mean `off`?"),
        ("mesh square.poly --from poyl -o a.msh", "did you mean `poly`?"),
        ("mesh square.poly -o a.msh --report jnit=b.xml", "did you mean `junit`?"),
        ("check a.msh --gate min_agle>=3", "did you mean `min_angle`?"),
        ("plot a.msh -o a.svg --colour min_agle", "did you mean `min_angle`?"),
        ("torture --preset gmhs", "did you mean `gmsh`?"),
        ("torture --family star", "did you mean `stars`?"),
        ("explain cli.did-you-man", "did you mean `cli.did-you-mean`?"),
    ];
    for (line, meant) in slips {
        let output = run_in(path, &line.split_whitespace().collect::<Vec<_>>());
        assert_exit(&output, 2);
        assert!(err(&output).contains(meant), "{line}: {}", err(&output));
    }
    // What is far from every word is met by none.
    let output = run_in(path, &["mesh", "square.poly", "-o", "a.msh", "--gradation", "nonsense"]);
    assert_exit(&output, 2);
    assert!(!err(&output).contains("did you mean"), "{}", err(&output));
    assert_eq!(names(path), ["square.poly"]);
}

// spec: K43
#[test]
fn of_many_faults_the_first_forty_are_printed_and_all_reported() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let path = folder.path();
    // Fifty points far out, each given twice.
    let pairs: Vec<String> = (0..100).map(|i| format!("{} {} 9\n", i + 5, i / 2)).collect();
    let head = "104 2 0 0\n1 -9 -9\n2 99 -9\n3 99 99\n4 -9 99\n";
    let text = format!("{head}{}4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n", pairs.concat());
    fs::write(path.join("twins.poly"), text).expect("written");
    let line = ["mesh", "twins.poly", "-o", "a.off", "--report", "json=report.json"];
    let output = run_in(path, &line);
    assert_exit(&output, 1);
    assert_eq!(err(&output).matches("error[").count(), 40, "{}", err(&output));
    assert!(err(&output).contains("... and 10 more"), "{}", err(&output));
    let report = fs::read(path.join("report.json")).expect("a report");
    let report: serde_json::Value = serde_json::from_slice(&report).expect("JSON");
    assert_eq!(report["errors"].as_array().map(Vec::len), Some(50));
}
