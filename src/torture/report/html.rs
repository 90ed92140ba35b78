//! The run as one page that needs nothing else.

use super::{Table, picture, slowest, worst};
use crate::torture::judge::Class;
use crate::torture::run::{Plan, Record, Reproducer, Run};
use std::collections::BTreeMap;
use std::fmt::Write;

const STYLE: &str = "body{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:70rem;padding:0 1rem}\
table{border-collapse:collapse}td,th{padding:.15rem .6rem;text-align:right;border-bottom:1px solid #ddd}\
td:first-child,th:first-child{text-align:left}td.bad{background:#fbdcd3}td.good{background:#e2f2e0}\
article{display:flex;gap:1.2rem;flex-wrap:wrap;border-top:2px solid #ccc;padding:1rem 0}\
article div{flex:1 1 25rem;min-width:0}pre{white-space:pre-wrap;overflow-wrap:anywhere;background:#f4f4f4;padding:.5rem}";

/// The page.
#[must_use]
pub fn html(run: &Run, plan: &Plan) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write_page(&mut out, run, plan);
    out
}

fn write_page(out: &mut String, run: &Run, plan: &Plan) -> std::fmt::Result {
    let name = escaped(&plan.tool.name);
    let (cases, failures) = (run.records.len(), run.failures().count());
    write!(
        out,
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/><title>torture of {name}\
         </title><style>{STYLE}</style></head><body><h1>torture of {name}</h1>\
         <p>{failures} failures in {cases} cases, seed {}. Command:</p><pre>{}</pre>",
        plan.selection.seed,
        escaped(&plan.tool.command)
    )?;
    write_table(out, &Table::of(run))?;
    if !run.reproducers.is_empty() {
        out.push_str("<h2>Failures, shrunk</h2>");
    }
    run.reproducers.iter().try_for_each(|r| write_reproducer(out, r))?;
    write_lists(out, run)?;
    out.push_str("</body></html>\n");
    Ok(())
}

fn write_table(out: &mut String, table: &Table) -> std::fmt::Result {
    let classes = table.classes();
    out.push_str("<h2>Verdicts</h2><table><tr><th>family</th><th>claim</th>");
    classes.iter().try_for_each(|class| write!(out, "<th>{class}</th>"))?;
    out.push_str("</tr>");
    let mut row = |family: &str, claim: &str, counts: &BTreeMap<Class, u64>| {
        write!(out, "<tr><td>{family}</td><td>{claim}</td>")?;
        classes.iter().try_for_each(|class| match counts.get(class) {
            None => write!(out, "<td></td>"),
            Some(n) if class.is_failure() => write!(out, "<td class=\"bad\">{n}</td>"),
            Some(n) => write!(out, "<td class=\"good\">{n}</td>"),
        })?;
        write!(out, "</tr>")
    };
    for (family, (claim, counts)) in &table.rows {
        row(family, claim, counts)?;
    }
    row("all", "", &table.total)?;
    out.push_str("</table>");
    Ok(())
}

fn write_reproducer(out: &mut String, r: &Reproducer) -> std::fmt::Result {
    let class = r.judgement.class;
    write!(
        out,
        "<article>{}<div><h3>{class}: {} {}</h3><p>The boundary is {}; shrunk from {} to {} points \
         in {} runs.</p><pre>{}</pre>",
        picture(&r.domain),
        r.family,
        r.index,
        r.claim,
        r.original.points.len(),
        r.domain.points.len(),
        r.trials,
        escaped(&r.judgement.reason),
    )?;
    if !r.is_repeatable {
        out.push_str("<p>It did not fail when it was run again, so it was not shrunk.</p>");
    }
    if let Some(folder) = &r.folder {
        let folder = escaped(&folder.display().to_string());
        write!(out, "<p>Files: <a href=\"{folder}\">{folder}</a></p>")?;
    }
    out.push_str("</div></article>");
    Ok(())
}

fn write_lists(out: &mut String, run: &Run) -> std::fmt::Result {
    let mut list = |title: &str, items: Vec<(&Record, String)>| {
        write!(out, "<h2>{title}</h2><table>")?;
        for (record, value) in items {
            let Record { family, index, .. } = record;
            write!(out, "<tr><td>{family} {index}</td><td>{value}</td></tr>")?;
        }
        write!(out, "</table>")
    };
    let times = slowest(run).into_iter().map(|r| (r, format!("{:.3} s", r.seconds)));
    list("Slowest", times.collect())?;
    let ratios = worst(run).into_iter().map(|(r, ratio)| (r, format!("{ratio:.4e}")));
    list("Worst triangles, R/(2r)", ratios.collect())
}

/// Text as HTML shows it. Characters that no XML may hold, as a dying program prints them, go.
fn escaped(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '&' => "&amp;".to_owned(),
            '<' => "&lt;".to_owned(),
            '>' => "&gt;".to_owned(),
            '"' => "&quot;".to_owned(),
            c if c.is_control() && c != '\n' && c != '\t' => "\u{fffd}".to_owned(),
            c => c.to_string(),
        })
        .collect()
}
