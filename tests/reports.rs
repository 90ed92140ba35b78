//! Every form of report, read by a consumer of its own kind: schemas, parsers, `prove`.

use serde_json::Value;
use std::collections::BTreeSet;
use std::process::{Command, Stdio};
use trigrade::check::report::{Form, Subject, render};
use trigrade::check::{CheckOptions, Gate, Id, Report, Verdict, check};
use trigrade::mesh::{MeshData, OtherCells};

/// A name with everything that some form must escape.
const NASTY: &str = "a b,c:d%e\"f'<g>&|#h\\i]]>\u{1}\u{e9}.msh";

const SUBJECTS: [Subject<'static>; 2] = [
    Subject { mesh: "meshes/wing.msh", domain: Some("wing.poly") },
    Subject { mesh: NASTY, domain: None },
];

/// The unit square in two triangles, read from a text file.
fn square() -> MeshData {
    let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mut mesh =
        MeshData { points, triangles: vec![[0, 1, 2], [0, 2, 3]], ..MeshData::default() };
    (0..4).for_each(|i| mesh.point_lines.push(i, 6 + u64::from(i)));
    (0..2).for_each(|i| mesh.triangle_lines.push(i, 13 + u64::from(i)));
    mesh
}

/// A name, the report, and how many findings of how many failing ids it has.
struct Case {
    name: &'static str,
    report: Report,
}

fn cases() -> Vec<Case> {
    let mut overlapping = square();
    overlapping.triangles[1] = [0, 1, 3];
    let mut unused = square();
    unused.points.extend([[0.5, 9.0, 0.0]; 30]);
    let mut foreign = square();
    foreign.other_cells.push(OtherCells { kind: "quadrilateral <4>".into(), count: 3 });
    let mut broken = square();
    broken.points[3][0] = f64::NAN;
    broken.triangles.push([2, 2, u32::MAX]);
    let gates = |texts: &[&str]| {
        let gates = texts.iter().map(|text| Gate::parse(text).expect("a gate"));
        gates.fold(CheckOptions::new(), CheckOptions::gate)
    };
    let (empty, plain) = (MeshData::default(), CheckOptions::new());
    let run = |name, mesh: &MeshData, options: &CheckOptions| Case {
        name,
        report: check(mesh, None, options),
    };
    vec![
        run("sound", &square(), &plain),
        run("overlap", &overlapping, &plain),
        run("unused", &unused, &plain.clone().list_limit(3)),
        run("allowed", &unused, &plain.clone().allow(Id::UnusedVertex)),
        run("foreign", &foreign, &plain),
        run("broken", &broken, &plain),
        run("empty", &empty, &plain),
        run("gates held", &square(), &gates(&["min_angle >= 20", "radius_ratio <= 3 @ 99%"])),
        run("gates missed", &square(), &gates(&["radius_ratio <= 1.1", "min_angle > 10"])),
        run("gates not run", &empty, &gates(&["radius_ratio <= 1.1"])),
    ]
}

/// Calls `each` for every case and subject, with the report in `form`.
fn for_all(form: Form, each: impl Fn(&Case, &Subject<'_>, &str)) {
    for case in cases() {
        for subject in SUBJECTS {
            each(&case, &subject, &render(&case.report, form, &subject));
        }
    }
}

fn failing(report: &Report) -> Vec<Id> {
    report.counts.iter().filter(|entry| !entry.allowed).map(|entry| entry.id).collect()
}

#[test]
fn the_cases_have_every_verdict() {
    let verdicts: Vec<Verdict> = cases().iter().map(|case| case.report.verdict).collect();
    for wanted in [Verdict::Passed, Verdict::Failed, Verdict::CouldNotRun] {
        assert!(verdicts.contains(&wanted), "{wanted:?} is missing in {verdicts:?}");
    }
    let find = |name| cases().into_iter().find(|case| case.name == name).expect("a case").report;
    assert_eq!(find("overlap").ids(), [Id::Overlap]);
    assert_eq!(find("unused").count(Id::UnusedVertex), 30);
    assert_eq!(find("unused").findings.len(), 3);
    assert_eq!(find("gates missed").ids(), [Id::GateMissed]);
}

// spec: C40
#[test]
fn every_form_is_the_same_for_the_same_report_and_ends_with_a_line_end() {
    for form in Form::ALL {
        for_all(form, |case, subject, text| {
            assert_eq!(text, render(&case.report, form, subject), "{} {form}", case.name);
            assert!(text.ends_with('\n'), "{} {form}: {text:?}", case.name);
        });
    }
}

// spec: C41
#[test]
fn json_meets_its_schema_and_reads_back() {
    let schema: Value =
        serde_json::from_str(include_str!("../schemas/report-1.schema.json")).expect("JSON");
    let schema = jsonschema::validator_for(&schema).expect("a schema");
    for_all(Form::Json, |case, subject, text| {
        let document: Value = serde_json::from_str(text).expect("JSON");
        let faults: Vec<String> = schema.iter_errors(&document).map(|e| e.to_string()).collect();
        assert!(faults.is_empty(), "{}: {faults:?}\n{text}", case.name);
        let report: Report = serde_json::from_str(text).expect("a report");
        assert_eq!(report, case.report, "{}", case.name);
        assert_eq!(document["mesh"], subject.mesh);
        assert_eq!(document["domain"].as_str(), subject.domain);
    });
    let mut wrong: Value = serde_json::to_value(&cases()[0].report).expect("JSON");
    wrong["verdict"] = "maybe".into();
    assert!(!schema.is_valid(&wrong), "the schema refuses what is wrong");
}

// spec: C42
#[test]
fn junit_is_read_by_a_parser_that_sees_the_verdict() {
    for_all(Form::Junit, |case, subject, text| {
        let suites = junit_parser::from_reader(text.as_bytes()).expect("JUnit");
        let suite = &suites.suites[0];
        let name = subject.mesh.replace('\u{1}', "");
        assert_eq!(suite.name, name, "{}", case.name);
        let report = &case.report;
        assert_eq!(suite.tests as usize, suite.cases.len());
        assert_eq!(suite.errors > 0, report.verdict == Verdict::CouldNotRun, "{text}");
        let unsound = suite.failures + suite.errors > 0;
        assert_eq!(unsound, !report.passed(), "{}: {text}", case.name);
        for id in failing(report).into_iter().filter(|id| *id != Id::GateMissed) {
            let named =
                |c: &&junit_parser::TestCase| c.original_name == format!("{id} {}", id.slug());
            let case = suite.cases.iter().find(named).expect("a test case for the id");
            assert!(case.status.is_failure(), "{text}");
            let failure = case.status.failure_as_ref();
            let first = report.findings.iter().find(|f| f.id == id).expect("listed");
            assert!(failure.text.contains(&first.message), "{}", failure.text);
        }
    });
}

// spec: C42
#[test]
fn junit_skips_what_was_not_checked_and_names_gates() {
    let case = cases().into_iter().find(|case| case.name == "gates missed").expect("a case");
    let text = render(&case.report, Form::Junit, &SUBJECTS[0]);
    let suites = junit_parser::from_reader(text.as_bytes()).expect("JUnit");
    let cases = &suites.suites[0].cases;
    let skipped = cases.iter().filter(|case| case.status.is_skipped()).count();
    assert!(skipped > 0 && skipped <= case.report.not_checked.len(), "{text}");
    let failed: Vec<&str> =
        cases.iter().filter(|c| c.status.is_failure()).map(|c| c.original_name.as_str()).collect();
    assert_eq!(failed, ["gate radius_ratio <= 1.1"], "{text}");
}

// spec: C43
#[test]
fn sarif_meets_the_schema_of_oasis() {
    // One pattern of the published schema, that of languages, is no valid regular expression.
    let text = include_str!("schemas/sarif-2.1.0.json");
    let text =
        text.replace("^[a-zA-Z]{2}|^[a-zA-Z]{2}-[a-zA-Z]{2}]?$", "^[a-zA-Z]{2}(-[a-zA-Z]{2})?$");
    let schema: Value = serde_json::from_str(&text).expect("JSON");
    let schema = jsonschema::validator_for(&schema).expect("a schema");
    for_all(Form::Sarif, |case, _, text| {
        let document: Value = serde_json::from_str(text).expect("JSON");
        let faults: Vec<String> = schema
            .iter_errors(&document)
            .map(|e| format!("{e} at {}", e.instance_path()))
            .collect();
        assert!(faults.is_empty(), "{}: {faults:?}\n{text}", case.name);
        let run = &document["runs"][0];
        let results = run["results"].as_array().expect("results");
        assert_eq!(results.len(), case.report.findings.len());
        for (result, finding) in results.iter().zip(&case.report.findings) {
            let rule = result["ruleIndex"].as_u64().expect("an index") as usize;
            assert_eq!(run["tool"]["driver"]["rules"][rule]["id"], result["ruleId"]);
            assert_eq!(result["message"]["text"], finding.message.as_str());
            assert_eq!(result["level"] == "note", finding.allowed);
            if let Some(line) = finding.triangles.first().and_then(|t| t.line) {
                let place = &result["locations"][0]["physicalLocation"];
                assert_eq!(place["region"]["startLine"], line);
            }
        }
        let exit = run["invocations"][0]["exitCode"].as_u64();
        assert_eq!(exit, Some(u64::from(case.report.exit_code())));
    });
}

// spec: C44
#[test]
fn github_commands_have_one_line_each_and_at_most_ten_errors() {
    for_all(Form::Github, |case, _, text| {
        let errors: Vec<&str> = text.lines().filter(|l| l.starts_with("::error ")).collect();
        assert!(errors.len() <= 10, "{text}");
        assert_eq!(errors.is_empty(), case.report.passed(), "{}: {text}", case.name);
        for line in text.lines() {
            let (head, data) = line[2..].split_once("::").expect("command::data");
            let (command, properties) = head.split_once(' ').expect("properties");
            assert!(["error", "notice"].contains(&command), "{line}");
            for property in properties.split(',') {
                let (name, value) = property.split_once('=').expect("name=value");
                assert!(["file", "line", "title"].contains(&name), "{line}");
                assert!(!value.is_empty() && !value.contains(':'), "{line}");
            }
            assert!(!data.is_empty());
        }
    });
    let overlap = cases().into_iter().find(|case| case.name == "overlap").expect("a case");
    let text = render(&overlap.report, Form::Github, &SUBJECTS[0]);
    assert!(text.starts_with("::error file=meshes/wing.msh,line=1"), "{text}");
}

// spec: C44
#[test]
fn github_summaries_are_tables_without_markup_of_names() {
    for_all(Form::GithubSummary, |case, _, text| {
        assert!(text.starts_with("## "), "{text}");
        assert!(!text.contains("<g>"), "{text}");
        let rows = text.lines().filter(|l| l.starts_with('|'));
        for row in rows {
            let bars = row.replace("\\|", "").matches('|').count();
            assert!(bars == 4 || bars == 6, "{}: {row}", case.name);
        }
    });
}

// spec: C45
#[test]
fn gitlab_issues_have_the_fields_it_asks_for() {
    for_all(Form::Gitlab, |case, subject, text| {
        let issues: Vec<Value> = serde_json::from_str(text).expect("an array");
        let report = &case.report;
        assert_eq!(issues.len(), report.findings.len() + report.could_not_run.len());
        let fingerprints: BTreeSet<&str> =
            issues.iter().filter_map(|issue| issue["fingerprint"].as_str()).collect();
        assert_eq!(fingerprints.len(), issues.len(), "fingerprints are unique: {text}");
        for issue in &issues {
            assert!(issue["description"].as_str().is_some_and(|d| !d.is_empty()));
            assert!(issue["check_name"].as_str().is_some_and(|d| !d.is_empty()));
            let severity = issue["severity"].as_str().expect("a severity");
            assert!(["info", "minor", "major", "critical", "blocker"].contains(&severity));
            assert_eq!(issue["location"]["path"], subject.mesh);
            assert!(issue["location"]["lines"]["begin"].as_u64() >= Some(1));
        }
    });
}

/// Test points of a TAP document: number, whether ok, whether skipped.
fn points(tap: &str) -> Vec<(usize, bool, bool)> {
    let point = |line: &str| {
        let (ok, rest) = match line.strip_prefix("not ok ") {
            Some(rest) => (false, rest),
            None => (true, line.strip_prefix("ok ")?),
        };
        Some((rest.split(' ').next()?.parse().ok()?, ok, rest.contains(" # SKIP ")))
    };
    tap.lines().filter_map(point).collect()
}

// spec: C46
#[test]
fn tap_keeps_its_plan_and_fails_when_the_check_does() {
    for_all(Form::Tap, |case, _, text| {
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("TAP version 13"));
        let plan = lines.next().and_then(|l| l.strip_prefix("1..")).and_then(|n| n.parse().ok());
        let all = points(text);
        assert_eq!(plan, Some(all.len()), "{text}");
        assert!(all.iter().enumerate().all(|(i, point)| point.0 == i + 1), "{text}");
        assert_eq!(all.iter().all(|point| point.1), case.report.passed(), "{}", case.name);
        let skipped = all.iter().filter(|point| point.2).count();
        assert!(skipped <= case.report.not_checked.len());
    });
}

// spec: C46
#[test]
fn tap_is_understood_by_prove_where_perl_is_installed() {
    let mut version = Command::new("prove");
    version.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
    if !version.status().is_ok_and(|status| status.success()) {
        return;
    }
    let directory = tempfile::tempdir().expect("a directory");
    for (i, case) in cases().iter().enumerate() {
        let file = directory.path().join(format!("{i}.tap"));
        std::fs::write(&file, render(&case.report, Form::Tap, &SUBJECTS[1])).expect("written");
        let output =
            Command::new("prove").args(["-e", "cat"]).arg(&file).output().expect("prove runs");
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(output.status.success(), case.report.passed(), "{}: {said}", case.name);
        assert!(!said.contains("Parse errors"), "{}: {said}", case.name);
    }
}

// spec: C47
#[test]
fn text_names_the_rule_the_lines_and_what_was_not_checked() {
    let text = |name: &str| {
        let case = cases().into_iter().find(|case| case.name == name).expect("a case");
        render(&case.report, Form::Text, &SUBJECTS[0])
    };
    let overlap = text("overlap");
    assert!(overlap.starts_with("error[M15]: "), "{overlap}");
    assert!(overlap.contains("  --> meshes/wing.msh:13: triangle 0\n"), "{overlap}");
    assert!(overlap.contains("see `trigrade explain M15`"), "{overlap}");
    assert!(overlap.contains("verdict     FAILED: 1 finding of 1 kinds"), "{overlap}");
    let sound = text("sound");
    assert!(sound.contains("radius_ratio") && sound.contains("R / (2 r)"), "{sound}");
    assert!(sound.contains("not checked") && sound.contains("(no gate was given)"), "{sound}");
    assert!(text("unused").contains("... and 27 findings more of M6"), "{}", text("unused"));
    assert!(text("allowed").starts_with("allowed[M6]: "));
    assert!(text("gates missed").contains("radius_ratio <= 1.1: MISSED, holds for only 0 of 2"));
    assert!(text("empty").contains("verdict     could not run"), "{}", text("empty"));
}

#[test]
fn forms_are_read_by_name_and_unknown_ones_are_named() {
    for form in Form::ALL {
        assert_eq!(form.name().parse(), Ok(form));
    }
    let error = "html".parse::<Form>().expect_err("no such form").to_string();
    assert!(error.contains("'html'") && error.contains("github-summary"), "{error}");
}
