//! Reports of a run made by hand.

use super::*;
use crate::torture::export::BoundaryForm;
use crate::torture::generate::{Selection, case};
use crate::torture::judge::Judgement;
use crate::torture::run::{Limits, Reproducer, Running, Tool};
use std::time::Duration;

fn plan() -> Plan {
    Plan {
        selection: Selection::new(5),
        cases: 3,
        tool: Tool {
            name: "a <mesher> & co".into(),
            command: "mesher \"{in}\" {out}".into(),
            form: BoundaryForm::Json,
            answer: "off".into(),
            limit: None,
            allow: Vec::new(),
            install: None,
            running: Running::default(),
        },
        limits: Limits { time: Duration::from_secs(1), memory: 1 << 30 },
        aspect_max: None,
        shrunk_max: 1,
        trials_max: 1,
        out: None,
    }
}

fn run() -> Run {
    let verdict = |class, reason: &str, ratio| Judgement {
        class,
        findings: Vec::new(),
        reason: reason.into(),
        triangles: 5,
        radius_ratio_max: ratio,
    };
    let record = |index: u64, judgement: Judgement| Record {
        index,
        family: case(5, index).family.into(),
        dress: "plain".into(),
        claim: "valid".into(),
        judgement,
        seconds: index as f64,
    };
    let crash = verdict(Class::Crash, "ended by signal 11: <\u{1}\nmore", None);
    let boundary = case(5, 1);
    Run {
        records: vec![
            record(0, verdict(Class::Passed, "", Some(1.5))),
            record(1, crash.clone()),
            record(2, verdict(Class::Passed, "", Some(2.5))),
        ],
        reproducers: vec![Reproducer {
            index: 1,
            family: boundary.family.into(),
            claim: boundary.claim,
            original: boundary.domain.clone(),
            domain: boundary.domain,
            judgement: crash,
            trials: 3,
            is_repeatable: true,
            folder: Some("failures/000001-crash".into()),
        }],
    }
}

// spec: R9
#[test]
fn json_has_the_table_the_failures_and_the_extremes() {
    let json = json(&run(), &plan());
    assert_eq!(json["failures"], 1);
    assert_eq!(json["verdicts"]["crash"], 1);
    assert_eq!(json["verdicts"]["passed"], 2);
    assert_eq!(json["failed"][0]["index"], 1);
    assert_eq!(json["slowest"][0]["index"], 2);
    assert_eq!(json["worst"][0]["radius_ratio"], 2.5);
    assert_eq!(json["reproducers"][0]["folder"], "failures/000001-crash");
}

// spec: R9
#[test]
fn the_page_is_well_formed_whatever_a_mesher_prints() {
    let page = html(&run(), &plan());
    let document = roxmltree::Document::parse_with_options(
        &page,
        roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() },
    );
    let document = document.expect("well-formed");
    let count = |name: &str| document.descendants().filter(|n| n.has_tag_name(name)).count();
    assert_eq!(count("article"), 1);
    assert!(page.contains("a &lt;mesher&gt; &amp; co") && page.contains("<svg"));
    assert!(!page.contains("src=") && !page.contains("<script"), "it needs nothing else");
}

// spec: R9
#[test]
fn the_text_names_the_first_line_of_each_reason() {
    let text = text(&run(), &plan());
    assert!(text.contains("ended by signal 11: <"), "{text}");
    assert!(!text.contains("more"), "{text}");
    assert!(text.ends_with("1 failures in 3 cases"), "{text}");
}
