//! Runs a mesher on very many boundaries, in parallel, and keeps what it got wrong.
//!
//! Every case runs in a process group and a temporary folder of its own, under limits of time and
//! memory. The verdicts do not depend on how many run at a time; times do.

mod command;
mod corpus;
mod preset;
mod running;
mod state;
mod tool;

pub use command::Limits;
pub use corpus::{Corpus, CorpusError, Reproducer, read_corpus};
pub use preset::{PRESETS, Preset};
pub use running::Running;
pub use state::StateError;
pub use tool::{Asked, Tool, ToolError};

use super::generate::{Case, Claim, Selection};
use super::judge::{Class, Demands, Judgement, judge};
use super::shrink::{Shrunk, shrink};
use crate::domain::Domain;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use state::State;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

/// What is to be run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Which boundaries.
    pub selection: Selection,
    /// How many of them.
    pub cases: u64,
    /// The mesher.
    pub tool: Tool,
    /// Limits for each case.
    pub limits: Limits,
    /// No triangle's R/(2r) may be above this.
    pub aspect_max: Option<f64>,
    /// How many failures are shrunk, one of a kind first.
    pub shrunk_max: usize,
    /// How often the mesher is asked for each of those.
    pub trials_max: u32,
    /// Where the log and the reproducers go.
    pub out: Option<PathBuf>,
}

/// A case that was run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Its number.
    pub index: u64,
    /// Its family.
    pub family: String,
    /// How its coordinates were dressed.
    pub dress: String,
    /// What should have become of it.
    pub claim: String,
    /// What became of it.
    pub judgement: Judgement,
    /// How long the mesher took.
    pub seconds: f64,
}

/// A run that is over.
#[derive(Clone, Debug)]
pub struct Run {
    /// All cases by number.
    pub records: Vec<Record>,
    /// The failures that were shrunk, by number.
    pub reproducers: Vec<Reproducer>,
}

impl Run {
    /// The cases that count against the mesher.
    pub fn failures(&self) -> impl Iterator<Item = &Record> {
        self.records.iter().filter(|record| record.judgement.class.is_failure())
    }
}

/// Why a run could not be carried out.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The mesher could not be asked.
    #[error(transparent)]
    Tool(#[from] ToolError),
    /// The log cannot be used.
    #[error(transparent)]
    State(#[from] StateError),
    /// Reproducers cannot be read or written.
    #[error(transparent)]
    Corpus(#[from] CorpusError),
    /// No family has the name that was asked for.
    #[error("no family is selected")]
    NoFamily,
}

impl From<std::io::Error> for RunError {
    fn from(error: std::io::Error) -> Self {
        Self::Tool(ToolError::Io(error))
    }
}

/// Runs a plan. `progress` is told of each case as it ends, in any order.
///
/// # Errors
/// [`RunError`]: never for what a mesher does with a boundary.
pub fn run(plan: &Plan, progress: &(dyn Fn(&Record) + Sync)) -> Result<Run, RunError> {
    if plan.selection.drawn().is_empty() {
        return Err(RunError::NoFamily);
    }
    let (state, mut records) = match &plan.out {
        Some(out) => {
            std::fs::create_dir_all(out)?;
            let (state, records) = State::open(&out.join("state.jsonl"), &plan_json(plan))?;
            (Some(state), records)
        }
        None => (None, Vec::new()),
    };
    let mut is_done = vec![false; usize::try_from(plan.cases).unwrap_or(0)];
    records.retain(|record| record.index < plan.cases);
    for record in &records {
        is_done[record.index as usize] = true;
        progress(record);
    }
    let pending: Vec<u64> = (0..plan.cases).filter(|&i| !is_done[i as usize]).collect();
    let new: Result<Vec<Record>, RunError> = pending
        .par_iter()
        .with_max_len(1)
        .filter_map(|&index| plan.selection.case(index))
        .map(|case| {
            let record = run_case(plan, &case)?;
            if let Some(state) = &state {
                state.add(&record)?;
            }
            progress(&record);
            Ok(record)
        })
        .collect();
    records.extend(new?);
    records.sort_by_key(|record| record.index);
    let reproducers = reproduce(plan, &records)?;
    Ok(Run { records, reproducers })
}

/// Runs the reproducers of a corpus; their numbers are their places in it.
///
/// # Errors
/// As [`run`].
pub fn replay(
    plan: &Plan,
    corpus: &Corpus,
    progress: &(dyn Fn(&Record) + Sync),
) -> Result<Run, RunError> {
    let records: Result<Vec<Record>, RunError> = corpus
        .cases
        .par_iter()
        .with_max_len(1)
        .map(|case| {
            let record = run_case(plan, case)?;
            progress(&record);
            Ok(record)
        })
        .collect();
    Ok(Run { records: records?, reproducers: Vec::new() })
}

/// What a log must agree on before it is taken up: all that verdicts depend on, but for the number
/// of cases, which may grow.
fn plan_json(plan: &Plan) -> Value {
    json!({
        "schema": "trigrade-torture-state/1",
        "version": env!("CARGO_PKG_VERSION"),
        "selection": plan.selection,
        "command": plan.tool.command,
        "form": plan.tool.form.extension(),
        "answer": plan.tool.answer,
        "allow": plan.tool.allow,
        "max_aspect": plan.aspect_max,
        "seconds": plan.limits.time.as_secs_f64(),
        "memory": plan.limits.memory,
    })
}

fn run_case(plan: &Plan, case: &Case) -> Result<Record, RunError> {
    let folder = tempfile::tempdir()?;
    let (judgement, asked) = ask_and_judge(plan, &case.domain, case.claim, folder.path())?;
    Ok(Record {
        index: case.index,
        family: case.family.to_owned(),
        dress: case.dress.to_owned(),
        claim: case.claim.to_string(),
        judgement,
        seconds: asked.seconds,
    })
}

fn ask_and_judge(
    plan: &Plan,
    domain: &Domain,
    claim: Claim,
    folder: &Path,
) -> Result<(Judgement, Asked), ToolError> {
    let asked = plan.tool.ask(domain, claim, &plan.limits, folder)?;
    let demands = Demands { aspect_max: plan.aspect_max, allow: plan.tool.allow.clone() };
    // A fault of our own in judging must not end a run of hours; it is told as what it is.
    let judged = catch_unwind(AssertUnwindSafe(|| judge(domain, claim, &asked.answer, &demands)));
    let judgement = judged.unwrap_or_else(|_| Judgement {
        class: Class::Unreadable,
        findings: Vec::new(),
        reason: "trigrade's own check failed on this answer; please report it".into(),
        triangles: 0,
        radius_ratio_max: None,
    });
    Ok((judgement, asked))
}

/// Shrinks failures of every class, and of every kind in it, before a second of any; writes them down.
fn reproduce(plan: &Plan, records: &[Record]) -> Result<Vec<Reproducer>, RunError> {
    let failures = records.iter().filter(|record| record.judgement.class.is_failure()).collect();
    let by_family = by_turns(failures, |record| record.family.clone());
    let by_finding = by_turns(by_family, |record| record.judgement.findings.first().copied());
    let by_class = by_turns(by_finding, |record| record.judgement.class);
    let mut chosen: Vec<&Record> = by_class.into_iter().take(plan.shrunk_max).collect();
    chosen.sort_by_key(|record| record.index);
    chosen.into_par_iter().with_max_len(1).map(|record| reproduce_one(plan, record)).collect()
}

/// One record of each key, then a second of each, and so on; those of a key keep their order.
fn by_turns<K: Ord>(records: Vec<&Record>, key: impl Fn(&Record) -> K) -> Vec<&Record> {
    let mut of_key: BTreeMap<K, Vec<&Record>> = BTreeMap::new();
    for record in records {
        of_key.entry(key(record)).or_default().push(record);
    }
    let rounds = of_key.values().map(Vec::len).max().unwrap_or(0);
    (0..rounds).flat_map(|i| of_key.values().filter_map(move |all| all.get(i)).copied()).collect()
}

fn reproduce_one(plan: &Plan, record: &Record) -> Result<Reproducer, RunError> {
    let case = plan.selection.case(record.index).ok_or(RunError::NoFamily)?;
    let mut trouble = None;
    let mut ask = |domain: &Domain| {
        let asked = tempfile::tempdir()
            .map_err(ToolError::Io)
            .and_then(|folder| ask_and_judge(plan, domain, case.claim, folder.path()));
        match asked {
            Ok((judgement, _)) => judgement,
            Err(error) => {
                trouble.get_or_insert(error);
                // Like no failure, so that the search ends where it is.
                Judgement {
                    class: Class::NotAsked,
                    findings: Vec::new(),
                    ..record.judgement.clone()
                }
            }
        }
    };
    let shrunk = shrink(&case.domain, case.claim, &record.judgement, plan.trials_max, &mut ask);
    if let Some(error) = trouble {
        return Err(error.into());
    }
    let is_repeatable = shrunk.is_some();
    let Shrunk { domain, judgement, trials } = shrunk.unwrap_or_else(|| Shrunk {
        domain: case.domain.clone(),
        judgement: record.judgement.clone(),
        trials: 1,
    });
    let reproducer = Reproducer {
        index: record.index,
        family: case.family.to_owned(),
        claim: case.claim,
        original: case.domain,
        domain,
        judgement,
        trials,
        is_repeatable,
        folder: None,
    };
    match &plan.out {
        Some(out) => Ok(corpus::write(out, reproducer, plan)?),
        None => Ok(reproducer),
    }
}

#[cfg(all(test, unix))]
mod tests;
