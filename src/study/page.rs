//! The study as one HTML page that loads nothing.

use super::chart::{COLOURS, Measure, chart};
use super::claims::find;
use super::table::{HEADINGS, cells};
use super::{Claim, Row, Setting, StudyDomain, System};
use base64::prelude::{BASE64_STANDARD, Engine as _};
use std::fmt::Write as _;

/// The pictures of a domain, as PNG: everything, and the close-up.
#[derive(Clone, Debug)]
pub struct Pictures {
    /// All of the domain, a panel a system.
    pub whole: Vec<u8>,
    /// The close-up, likewise.
    pub close: Vec<u8>,
    /// The close-up of some systems before any improvement.
    pub raw: Vec<u8>,
}

/// What the page is made of.
#[derive(Clone, Copy, Debug)]
pub struct Study<'a> {
    /// The domains with their pictures.
    pub domains: &'a [(&'a StudyDomain, Pictures)],
    /// All rows.
    pub rows: &'a [Row],
    /// The statements, judged.
    pub claims: &'a [Claim],
    /// A line on how it was run.
    pub note: &'a str,
}

const STYLE: &str = include_str!("page.css");

/// Writes the page.
#[must_use]
pub fn html(study: &Study<'_>) -> String {
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Graded triangulation beside its rivals</title>\n<style>\n{STYLE}</style>\n</head>\n\
         <body>\n<h1>Graded triangulation beside its rivals</h1>\n"
    );
    write_introduction(&mut out, study);
    write_claims(&mut out, study.claims);
    write_charts(&mut out, study);
    for (domain, pictures) in study.domains {
        write_domain(&mut out, domain, pictures, study.rows);
    }
    for setting in Setting::ALL {
        let _ = writeln!(out, "<h2>{}: all figures</h2>", setting.title());
        write_table(&mut out, study.rows, setting);
    }
    out + "</body>\n</html>\n"
}

fn write_introduction(out: &mut String, study: &Study<'_>) {
    let meshes = study.rows.iter().filter(|row| row.figures.is_some()).count();
    let sound = study.rows.iter().filter(|row| row.figures.is_some_and(|f| f.passed)).count();
    let _ = writeln!(
        out,
        "<p>{} domains, dense at the boundary and sparse away from it, each meshed by six systems \
         in three settings: {meshes} meshes, of which {sound} pass the exact check against their \
         domain. R/2r is the circumradius over twice the inradius, 1 for an equilateral triangle. \
         The area ratio is that of a triangle to its neighbours, far/dense how much longer edges are \
         far from the dense part of the boundary than there. All figures of quality are measured by \
         the checker, which shares no code with the mesher. {}</p>",
        study.domains.len(),
        study.note
    );
    out.push_str("<table class=\"systems\"><tr><th>system</th><th></th><th>asked for by</th></tr>");
    for (system, colour) in System::ALL.into_iter().zip(COLOURS) {
        let _ = write!(
            out,
            "<tr><td><i style=\"background:{colour}\"></i> {}</td><td>{}</td>\
             <td><code>trigrade mesh DOMAIN.json -o MESH.msh {}</code></td></tr>",
            system.name(),
            system.title(),
            system.flags()
        );
    }
    let _ = writeln!(
        out,
        "</table>\n<p>Raw meshes come with <code>--no-improve</code>, equal numbers of triangles \
         with <code>--target COUNT</code>; COUNT is what the plain front makes, which has no \
         spacing that could be scaled. The \
         domains lie beside this page.</p>"
    );
}

fn write_claims(out: &mut String, claims: &[Claim]) {
    out.push_str("<h2>What holds</h2>\n");
    for of_report in [true, false] {
        let heading = if of_report {
            "Statements of the report that the methods come from"
        } else {
            "Statements of ours"
        };
        let _ = writeln!(out, "<h3>{heading}</h3>");
        claims.iter().filter(|c| c.is_of_the_report == of_report).for_each(|c| write_claim(out, c));
    }
}

fn write_claim(out: &mut String, claim: &Claim) {
    let [holds, fails, open] = claim.split();
    let class = match (holds.len(), fails.len()) {
        (_, 0) if holds.is_empty() => "open",
        (_, 0) => "holds",
        (0, _) => "fails",
        _ => "partly",
    };
    let _ = writeln!(
        out,
        "<details class=\"claim {class}\"><summary>{} <b>It {}.</b></summary><p>{}</p><table>",
        claim.statement,
        claim.sentence(),
        claim.rule
    );
    for (list, word) in [(fails, "does not hold"), (open, "not judged"), (holds, "holds")] {
        for outcome in list {
            let _ = writeln!(
                out,
                "<tr><td>{}</td><td>{word}</td><td class=\"left\">{}</td></tr>",
                outcome.domain, outcome.figures
            );
        }
    }
    out.push_str("</table></details>\n");
}

fn write_charts(out: &mut String, study: &Study<'_>) {
    out.push_str("<h2>Shapes at a glance</h2>\n<p class=\"legend\">");
    for (system, colour) in System::ALL.into_iter().zip(COLOURS) {
        let _ =
            write!(out, "<span><i style=\"background:{colour}\"></i> {}</span> ", system.title());
    }
    out.push_str("</p>\n<div class=\"charts\">\n");
    let own = [
        Measure { title: "R/2r, mean", value: |f| f.ratio_mean },
        Measure { title: "R/2r, 99 %", value: |f| f.ratio_p99 },
        Measure { title: "R/2r, worst", value: |f| f.ratio_max },
        Measure { title: "Area ratio to neighbours, 99 %", value: |f| f.area_ratio_p99 },
    ];
    own.iter().for_each(|m| out.push_str(&chart(study.rows, Setting::Own, *m)));
    let raw = Measure { title: "R/2r, worst, before any improvement", value: |f| f.ratio_max };
    out.push_str(&chart(study.rows, Setting::Raw, raw));
    let equal = Measure { title: "R/2r, 99 %, equal numbers of triangles", value: |f| f.ratio_p99 };
    out.push_str(&chart(study.rows, Setting::Equal, equal));
    out.push_str("</div>\n");
}

fn write_domain(out: &mut String, domain: &StudyDomain, pictures: &Pictures, rows: &[Row]) {
    let _ = writeln!(
        out,
        "<section id=\"{}\">\n<h2>{}</h2>\n<p>{} <code>{}.json</code></p>",
        domain.name, domain.title, domain.about, domain.name
    );
    let shown = [
        ("all of it", &pictures.whole),
        ("close-up", &pictures.close),
        ("close-up before any improvement", &pictures.raw),
    ];
    for (what, png) in shown {
        let _ = write!(
            out,
            "<figure><img alt=\"{}, {what}, side by side at one scale\" src=\"data:image/png;base64,",
            domain.title
        );
        BASE64_STANDARD.encode_string(png, out);
        let _ = writeln!(
            out,
            "\"><figcaption>{}, {what}, at one scale</figcaption></figure>",
            domain.title
        );
    }
    let own: Vec<Row> = rows.iter().filter(|row| row.domain == domain.name).cloned().collect();
    for setting in Setting::ALL {
        let _ = writeln!(out, "<h3>{}</h3>", setting.title());
        write_table(out, &own, setting);
    }
    out.push_str("</section>\n");
}

/// The rows of a setting; the best figure of each domain is set off, and targets missed are marked.
fn write_table(out: &mut String, rows: &[Row], setting: Setting) {
    out.push_str("<table><tr><th>domain</th><th>system</th>");
    for heading in HEADINGS {
        let _ = write!(out, "<th>{heading}</th>");
    }
    out.push_str("</tr>\n");
    let mut before = "";
    for row in rows.iter().filter(|row| row.setting == setting) {
        let class = if row.domain == before { "" } else { " class=\"first\"" };
        let name = if row.domain == before { "" } else { row.domain };
        before = row.domain;
        let _ = write!(out, "<tr{class}><td>{name}</td><td>{}</td>", row.system.name());
        let best = best(rows, row);
        for (i, cell) in cells(row).iter().enumerate() {
            let cell = if best[i] { format!("<b>{cell}</b>") } else { cell.clone() };
            let _ = write!(out, "<td>{cell}</td>");
        }
        if let Some(reason) = &row.reason {
            let _ = write!(out, "<td class=\"left\">{}</td>", escape(reason));
        }
        out.push_str("</tr>\n");
    }
    let missed = rows.iter().any(|row| row.setting == setting && !row.is_on_target());
    out.push_str("</table>\n");
    if missed {
        out.push_str("<p class=\"small\">! more than 5 % from the number asked for: the boundary alone asks for more, or the system has no way to make more.</p>\n");
    }
}

/// Which of a row's figures are the best of its domain and setting.
fn best(rows: &[Row], row: &Row) -> [bool; HEADINGS.len()] {
    let mut best = [false; HEADINGS.len()];
    let Some(own) = &row.figures else { return best };
    let others = System::ALL.into_iter().filter_map(|s| find(rows, row.domain, s, row.setting));
    let others: Vec<_> = others.filter_map(|row| row.figures).collect();
    let least = |value: fn(&super::Figures) -> f64| others.iter().all(|o| value(own) <= value(o));
    best[1] = least(|f| f.ratio_mean);
    best[2] = least(|f| f.ratio_p99);
    best[3] = least(|f| f.ratio_max);
    best[4] = least(|f| -f.angle_min_deg);
    best[5] = least(|f| f.area_ratio_p99);
    best
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::{DOMAINS, Figures, claims};

    fn row(system: System, setting: Setting, ratio: Option<f64>) -> Row {
        let figures = ratio.map(|ratio| Figures {
            triangles: 100,
            points: 60,
            ratio_mean: ratio,
            ratio_p99: ratio,
            ratio_max: ratio,
            angle_min_deg: 60.0 / ratio,
            area_ratio_p99: ratio,
            far_over_dense: 2.0,
            passed: true,
        });
        let reason = figures.is_none().then(|| "a < b & c".to_owned());
        Row { domain: "airfoil", system, setting, target: None, figures, reason, seconds: 0.01 }
    }

    fn page(rows: &[Row]) -> String {
        let png = |byte| vec![byte; 5];
        let domains = [(&DOMAINS[0], Pictures { whole: png(1), close: png(2), raw: png(3) })];
        let claims = claims(rows);
        html(&Study { domains: &domains, rows, claims: &claims, note: "Run by a test." })
    }

    // spec: K34
    #[test]
    fn the_page_carries_pictures_tables_and_verdicts_and_loads_nothing() {
        let rows: Vec<Row> = Setting::ALL
            .into_iter()
            .flat_map(|setting| {
                [
                    row(System::Graded, setting, Some(1.02)),
                    row(System::Afm, setting, Some(1.3)),
                    row(System::Delaunay, setting, None),
                ]
            })
            .collect();
        let html = page(&rows);
        for part in [
            "AQEBAQE=",
            "AgICAgI=",
            "AwMDAwM=",
            "Run by a test.",
            "<b>1.0200</b>",
            "a &lt; b &amp; c",
        ] {
            assert!(html.contains(part), "{part}");
        }
        assert!(!html.contains("<b>1.3000</b>"), "the worse one is not set off");
        for claim in claims(&rows) {
            assert!(html.contains(claim.statement) && html.contains(&claim.sentence()));
        }
        for loader in ["http:", "https:", "href=", "@import", "url(", "src=\"/", "<script"] {
            assert!(!html.contains(loader), "{loader}");
        }
        assert_eq!(html.matches("src=").count(), 3, "the three pictures");
    }

    // spec: K34
    #[test]
    fn a_page_without_meshes_is_a_page() {
        let html = page(&[row(System::Graded, Setting::Own, None)]);
        assert!(html.contains("cannot be judged") && html.ends_with("</html>\n"));
    }
}
