//! What a run found: for people, for programs, and as a page with pictures.

mod html;
mod picture;

pub use html::html;
pub use picture::picture;

use super::judge::{Class, Judgement};
use super::run::{Plan, Record, Run};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;

/// How many of the slowest and of the worst cases are listed.
const LISTED: usize = 10;

/// How many cases of each family had each verdict.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Family, claim and counts, the families by name.
    pub rows: BTreeMap<String, (String, BTreeMap<Class, u64>)>,
    /// Counts of all.
    pub total: BTreeMap<Class, u64>,
}

impl Table {
    /// The table of a run.
    #[must_use]
    pub fn of(run: &Run) -> Self {
        let mut table = Self::default();
        for record in &run.records {
            let claim = record.claim.clone();
            let row = table.rows.entry(record.family.clone()).or_insert((claim, BTreeMap::new()));
            *row.1.entry(record.judgement.class).or_default() += 1;
            *table.total.entry(record.judgement.class).or_default() += 1;
        }
        table
    }

    /// The verdicts that occur, in the order of [`Class::ALL`].
    #[must_use]
    pub fn classes(&self) -> Vec<Class> {
        Class::ALL.into_iter().filter(|class| self.total.contains_key(class)).collect()
    }
}

/// The slowest cases first.
fn slowest(run: &Run) -> Vec<&Record> {
    let mut all: Vec<&Record> = run.records.iter().collect();
    all.sort_by(|a, b| b.seconds.total_cmp(&a.seconds).then(a.index.cmp(&b.index)));
    all.truncate(LISTED);
    all
}

/// The cases with the worst triangles first.
fn worst(run: &Run) -> Vec<(&Record, f64)> {
    let ratio = |record| Some((record, Judgement::radius_ratio(&record_judgement(record))?));
    let mut all: Vec<(&Record, f64)> = run.records.iter().filter_map(ratio).collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.index.cmp(&b.0.index)));
    all.truncate(LISTED);
    all
}
