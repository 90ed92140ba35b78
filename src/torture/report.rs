//! What a run found: for people, for programs, and as a page with pictures.

mod html;
mod picture;

pub use html::html;
pub use picture::picture;

use super::judge::Class;
use super::run::{Plan, Record, Reproducer, Run};
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
fn worst<'a>(run: &'a Run) -> Vec<(&'a Record, f64)> {
    let ratio = |record: &'a Record| Some((record, record.judgement.radius_ratio_max?));
    let mut all: Vec<(&Record, f64)> = run.records.iter().filter_map(ratio).collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.index.cmp(&b.0.index)));
    all.truncate(LISTED);
    all
}

/// The run for programs.
#[must_use]
pub fn json(run: &Run, plan: &Plan) -> Value {
    let table = Table::of(run);
    let counts = |counts: &BTreeMap<Class, u64>| -> Value {
        counts.iter().map(|(class, n)| (class.name().to_owned(), json!(n))).collect()
    };
    let rows = table.rows.iter().map(|(family, (claim, row))| {
        json!({ "family": family, "claim": claim, "verdicts": counts(row) })
    });
    let worst = worst(run).into_iter().map(|(record, ratio)| {
        json!({ "index": record.index, "family": record.family, "radius_ratio": ratio })
    });
    let slowest = slowest(run).into_iter().map(|record| {
        json!({ "index": record.index, "family": record.family, "seconds": record.seconds })
    });
    json!({
        "schema": "trigrade-torture/1",
        "mesher": plan.tool.name,
        "command": plan.tool.command,
        "seed": plan.selection.seed,
        "cases": run.records.len(),
        "failures": run.failures().count(),
        "verdicts": counts(&table.total),
        "families": rows.collect::<Vec<_>>(),
        "failed": run.failures().collect::<Vec<_>>(),
        "reproducers": run.reproducers.iter().map(reproducer_json).collect::<Vec<_>>(),
        "slowest": slowest.collect::<Vec<_>>(),
        "worst": worst.collect::<Vec<_>>(),
    })
}

fn reproducer_json(reproducer: &Reproducer) -> Value {
    json!({
        "index": reproducer.index,
        "family": reproducer.family,
        "claim": reproducer.claim.to_string(),
        "points": reproducer.domain.points.len(),
        "loops": reproducer.domain.loops.len(),
        "verdict": reproducer.judgement,
        "repeatable": reproducer.is_repeatable,
        "trials": reproducer.trials,
        "folder": reproducer.folder,
    })
}

/// The run for people.
#[must_use]
pub fn text(run: &Run, plan: &Plan) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write_text(&mut out, run, plan);
    out
}

fn write_text(out: &mut String, run: &Run, plan: &Plan) -> std::fmt::Result {
    write_table(out, &Table::of(run))?;
    run.reproducers.iter().try_for_each(|reproducer| write_reproducer(out, reproducer, plan))?;
    out.push('\n');
    if let Some(record) = slowest(run).first() {
        write!(out, "\nslowest: {} {}, {:.2} s", record.family, record.index, record.seconds)?;
    }
    if let Some((record, ratio)) = worst(run).first() {
        write!(out, "\nworst:   {} {}, R/(2r) = {ratio:.4e}", record.family, record.index)?;
    }
    let (failures, cases) = (run.failures().count(), run.records.len());
    write!(out, "\n{}: {failures} failures in {cases} cases", plan.tool.name)
}

fn write_table(out: &mut String, table: &Table) -> std::fmt::Result {
    let classes = table.classes();
    write!(out, "{:22}", "")?;
    classes.iter().try_for_each(|class| write!(out, " {class:>16}"))?;
    let total = ("all", &table.total);
    let rows = table.rows.iter().map(|(family, (_, counts))| (family.as_str(), counts));
    for (name, counts) in rows.chain([total]) {
        write!(out, "\n{name:22}")?;
        classes.iter().try_for_each(|class| match counts.get(class) {
            Some(count) => write!(out, " {count:>16}"),
            None => write!(out, " {:>16}", "."),
        })?;
    }
    Ok(())
}

fn write_reproducer(out: &mut String, r: &Reproducer, plan: &Plan) -> std::fmt::Result {
    let (class, points) = (r.judgement.class, r.domain.points.len());
    write!(out, "\n\n{class}: {} {} ({}), shrunk to {points} points", r.family, r.index, r.claim)?;
    if !r.is_repeatable {
        write!(out, "\n  it did not fail when it was run again, so it was not shrunk")?;
    }
    write!(out, "\n  {}", first_line(&r.judgement.reason))?;
    if let (Some(below), Some(folder)) = (&r.folder, &plan.out) {
        write!(out, "\n  --> {}", folder.join(below).display())?;
    }
    Ok(())
}

/// The first line of a reason, cut where it gets long.
fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or("").chars().take(200).collect()
}

#[cfg(test)]
mod tests;
