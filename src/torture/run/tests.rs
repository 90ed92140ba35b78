//! Runs of small shell scripts in place of meshers.

use super::*;
use crate::torture::export::BoundaryForm;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

fn plan(command: &str, out: Option<&Path>) -> Plan {
    Plan {
        selection: Selection { size_max: 10, plain: true, ..Selection::new(1) },
        cases: 45,
        tool: Tool {
            name: "a script".into(),
            command: command.into(),
            form: BoundaryForm::Json,
            answer: "off".into(),
            limit: None,
            allow: Vec::new(),
            install: None,
            running: Running::default(),
        },
        limits: Limits { time: Duration::from_secs(20), memory: 1 << 30 },
        aspect_max: None,
        shrunk_max: 2,
        trials_max: 12,
        out: out.map(Path::to_owned),
    }
}

fn unwatched(plan: &Plan) -> Run {
    run(plan, &|_| ()).expect("the script runs")
}

/// Everything but times.
fn verdicts(run: &Run) -> Vec<(u64, Judgement)> {
    run.records.iter().map(|record| (record.index, record.judgement.clone())).collect()
}

// spec: R6 R8
#[test]
fn a_mesher_that_refuses_everything_fails_on_the_valid_only() {
    let run = unwatched(&plan("exit 1", None));
    assert_eq!(run.records.len(), 45);
    for record in &run.records {
        let expected = if record.claim == "valid" { Class::RefusedValid } else { Class::Passed };
        assert_eq!(record.judgement.class, expected, "{record:?}");
    }
    assert_eq!(run.reproducers.len(), 2);
    assert!(run.reproducers.iter().all(|r| r.is_repeatable && r.trials <= 12));
}

// spec: R7
#[test]
fn a_run_is_taken_up_where_it_was_left() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let mut plan = plan("exit 1", Some(folder.path()));
    plan.shrunk_max = 0;
    plan.cases = 20;
    let first = unwatched(&plan);
    plan.cases = 30;
    let log = std::fs::read_to_string(folder.path().join("state.jsonl")).expect("a log");
    let seen = AtomicUsize::new(0);
    let second = run(&plan, &|_| {
        seen.fetch_add(1, Ordering::Relaxed);
    })
    .expect("the same plan");
    assert_eq!(seen.load(Ordering::Relaxed), 30, "old cases are told of too");
    assert_eq!(verdicts(&second)[..20], verdicts(&first)[..]);
    let after = std::fs::read_to_string(folder.path().join("state.jsonl")).expect("a log");
    assert!(after.starts_with(&log), "old cases are not run again");
    plan.selection.seed += 1;
    let error = run(&plan, &|_| ()).expect_err("another plan");
    assert!(matches!(error, RunError::State(StateError::OtherRun(_))), "{error}");
}

// spec: R8
#[test]
fn a_corpus_is_written_and_replayed() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    let first = unwatched(&plan("exit 1", Some(folder.path())));
    let corpus = read_corpus(folder.path()).expect("written");
    assert_eq!(corpus.cases.len(), first.reproducers.len());
    for (case, reproducer) in corpus.cases.iter().zip(&first.reproducers) {
        assert_eq!(case.claim, reproducer.claim);
        assert_eq!(case.domain.points, reproducer.domain.points);
    }
    let fails = replay(&plan("exit 1", None), &corpus, &|_| ()).expect("the script runs");
    assert_eq!(fails.failures().count(), corpus.cases.len());
    let other = replay(&plan("kill -SEGV $$", None), &corpus, &|_| ()).expect("the script runs");
    assert!(other.records.iter().all(|record| record.judgement.class == Class::Crash));
}

// spec: R8
#[test]
fn a_corpus_that_lies_is_refused() {
    let folder = tempfile::tempdir().expect("a temporary directory");
    assert!(matches!(read_corpus(folder.path()), Err(CorpusError::Empty(_))));
    unwatched(&plan("exit 1", Some(folder.path())));
    let case = read_corpus(folder.path()).expect("written").folders[0].join("case.json");
    let good = std::fs::read_to_string(&case).expect("readable");
    for (old, new) in [
        ("\"valid\"", "\"D8\""),
        ("\"valid\"", "\"fine\""),
        ("shrunk.json", "../shrunk.json"),
        ("{", ""),
    ] {
        std::fs::write(&case, good.replacen(old, new, 1)).expect("written");
        assert!(read_corpus(folder.path()).is_err(), "{old} -> {new}");
    }
}

#[test]
fn no_family_is_no_run() {
    let mut plan = plan("exit 1", None);
    plan.selection.families = vec!["no such".into()];
    assert!(matches!(run(&plan, &|_| ()), Err(RunError::NoFamily)));
}

/// A mesher that refuses what has an odd number of bytes, and crashes on the rest.
const FICKLE: &str = "test $(( $(wc -c < {in}) % 2 )) = 1 && exit 1; kill -SEGV $$";

// spec: R4
#[test]
fn every_class_of_failure_is_shrunk_before_a_second_of_one() {
    let run = unwatched(&Plan { trials_max: 1, ..plan(FICKLE, None) });
    let of = |class| run.records.iter().filter(move |r| r.judgement.class == class).count();
    assert!(of(Class::RefusedValid) > 2 && of(Class::Crash) > 2, "both come up, and often");
    let mut classes: Vec<Class> = run.reproducers.iter().map(|r| r.judgement.class).collect();
    classes.sort_unstable();
    assert_eq!(classes, [Class::Crash, Class::RefusedValid]);
}
