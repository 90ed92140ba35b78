//! Test Anything Protocol, version 13: a test point for each id and each gate.
//!
//! Version 14 would do as well, but consumers of it read 13 too, and `prove` reads no other.

use super::render::{
    Status, Subject, findings_count, findings_of, places, status, tested_ids, verdict,
};
use super::text::gate_line;
use super::{Report, Verdict};
use crate::check::{GateOutcome, Id};
use serde_json::Value;
use std::fmt::Write as _;

/// Findings shown below a failed test point.
const SHOWN_MAX: usize = 5;

pub(super) fn tap(report: &Report, subject: &Subject<'_>) -> String {
    let ids: Vec<Id> = tested_ids(report).collect();
    let mut out = String::from("TAP version 13\n");
    let _ = writeln!(out, "1..{}", 1 + ids.len() + report.gates.len());
    let _ = writeln!(out, "# {}", one_line(subject.mesh));
    let mut number = 1;
    let sound = report.verdict != Verdict::CouldNotRun;
    push_point(&mut out, sound, number, "everything asked for was checked", "");
    for why in &report.could_not_run {
        push_note(&mut out, "could not run", why);
    }
    for id in ids {
        number += 1;
        push_id(&mut out, report, subject, (number, id));
    }
    for gate in &report.gates {
        number += 1;
        let held = gate.outcome == GateOutcome::Held;
        push_point(&mut out, held, number, &gate_line(gate), "");
    }
    let _ = writeln!(out, "# {}", one_line(&verdict(report)));
    out
}

fn push_id(out: &mut String, report: &Report, subject: &Subject<'_>, (number, id): (usize, Id)) {
    let name = format!("{id} {}", id.slug());
    match status(report, id) {
        Status::Holds => push_point(out, true, number, &name, ""),
        Status::Skipped(why) => {
            push_point(out, true, number, &name, &format!(" # SKIP {}", one_line(why)));
        }
        Status::Allowed(count) => {
            let name = format!("{name}: {} allowed", findings_count(count.count));
            push_point(out, true, number, &name, "");
        }
        Status::Fails(count) => {
            push_point(out, false, number, &name, "");
            push_note(out, "rule", id.rule());
            push_note(out, "count", &findings_count(count.count));
            for finding in findings_of(report, id).take(SHOWN_MAX) {
                let at = places(finding, subject);
                push_note(out, "finding", &finding.message);
                push_note(out, "at", &at[0].to_string());
            }
        }
    }
}

/// A test point; `directive` is written as it is.
fn push_point(out: &mut String, ok: bool, number: usize, description: &str, directive: &str) {
    let word = if ok { "ok" } else { "not ok" };
    // "#" would start a directive, "\" an escape.
    let description = one_line(description).replace('\\', "\\\\").replace('#', "\\#");
    let _ = writeln!(out, "{word} {number} - {description}{directive}");
}

/// A comment, which every consumer passes on; strings are quoted as in JSON.
fn push_note(out: &mut String, name: &str, text: &str) {
    let _ = writeln!(out, "#   {name}: {}", Value::from(text));
}

fn one_line(text: &str) -> String {
    text.replace(['\n', '\r'], " ")
}
