//! JUnit XML: a suite for the mesh, a test case for each id and each gate.

use super::render::{Status, Subject, findings_count, findings_of, places, status, tested_ids};
use super::text::gate_line;
use super::{Report, Verdict};
use crate::check::{GateOutcome, GateResult, Id};
use quick_junit::{NonSuccessKind, TestCase, TestCaseStatus, TestSuite};
use std::fmt::Write as _;

pub(super) fn junit(report: &Report, subject: &Subject<'_>) -> String {
    let mut suite = TestSuite::new(subject.mesh);
    suite.add_test_case(run_case(report));
    suite.add_test_cases(tested_ids(report).map(|id| id_case(report, subject, id)));
    suite.add_test_cases(report.gates.iter().map(gate_case));
    for case in &mut suite.test_cases {
        case.set_classname("trigrade.check");
    }
    let mut document = quick_junit::Report::new("trigrade check");
    document.add_test_suite(suite);
    // Writing XML to memory fails for no input; the empty text would fail every consumer.
    document.to_string().unwrap_or_default()
}

/// Whether everything asked for could be checked: an error case, so that it is never a pass.
fn run_case(report: &Report) -> TestCase {
    let status = if report.verdict == Verdict::CouldNotRun {
        unsuccessful(NonSuccessKind::Error, &report.could_not_run.join("; "), "could-not-run")
    } else {
        TestCaseStatus::success()
    };
    TestCase::new("everything asked for was checked", status)
}

fn id_case(report: &Report, subject: &Subject<'_>, id: Id) -> TestCase {
    let name = format!("{id} {}", id.slug());
    match status(report, id) {
        Status::Holds => TestCase::new(name, TestCaseStatus::success()),
        Status::Allowed(count) => {
            let mut case = TestCase::new(name, TestCaseStatus::success());
            case.set_system_out(format!("allowed: {}", findings_count(count.count)));
            case
        }
        Status::Skipped(why) => {
            let mut status = TestCaseStatus::skipped();
            status.set_message(why);
            TestCase::new(name, status)
        }
        Status::Fails(count) => {
            let message = format!("{}: {}", findings_count(count.count), id.rule());
            let mut status = unsuccessful(NonSuccessKind::Failure, &message, id.code());
            status.set_description(list(report, subject, id, count.count - count.listed));
            TestCase::new(name, status)
        }
    }
}

/// The findings of an id with their places, a line each.
fn list(report: &Report, subject: &Subject<'_>, id: Id, more: u64) -> String {
    let mut out = String::new();
    for finding in findings_of(report, id) {
        let _ = writeln!(out, "{}", finding.message);
        for place in places(finding, subject) {
            let _ = writeln!(out, "  {place}");
        }
    }
    if more > 0 {
        let _ = writeln!(out, "... and {} more", findings_count(more));
    }
    out
}

fn gate_case(gate: &GateResult) -> TestCase {
    let status = match gate.outcome {
        GateOutcome::Held => TestCaseStatus::success(),
        GateOutcome::Missed => {
            unsuccessful(NonSuccessKind::Failure, &gate_line(gate), Id::GateMissed.code())
        }
        GateOutcome::CouldNotRun => {
            unsuccessful(NonSuccessKind::Error, &gate_line(gate), "could-not-run")
        }
    };
    TestCase::new(format!("gate {}", gate.gate), status)
}

fn unsuccessful(kind: NonSuccessKind, message: &str, category: &str) -> TestCaseStatus {
    let mut status = TestCaseStatus::non_success(kind);
    status.set_message(message).set_type(category);
    status
}
