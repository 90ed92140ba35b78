//! The figures of a study as text, CSV and JSON.

use super::{Claim, Row, Setting};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Headings of the columns of figures, as the text and the page have them.
pub const HEADINGS: [&str; 8] =
    ["triangles", "mean", "99 %", "max", "angle min", "area ratio 99 %", "far/dense", "time"];

/// A row's figures, one text a heading; a dash where there is no mesh.
#[must_use]
pub fn cells(row: &Row) -> [String; HEADINGS.len()] {
    let Some(f) = &row.figures else { return HEADINGS.map(|_| "-".to_owned()) };
    let target = if row.is_on_target() { "" } else { " !" };
    [
        format!("{}{target}", f.triangles),
        format!("{:.4}", f.ratio_mean),
        format!("{:.3}", f.ratio_p99),
        format!("{:.3}", f.ratio_max),
        format!("{:.1}°", f.angle_min_deg),
        format!("{:.2}", f.area_ratio_p99),
        format!("{:.2}", f.far_over_dense),
        format!("{:.1} ms", 1e3 * row.seconds),
    ]
}

/// Rows of a setting as text with aligned columns; rows that miss their target carry a `!`.
#[must_use]
pub fn text(rows: &[Row], setting: Setting) -> String {
    let mut text = format!("{}\n\n{:<17}{:<10}", setting.title(), "domain", "system");
    for (heading, width) in HEADINGS.iter().zip(WIDTHS) {
        let _ = write!(text, "{heading:>width$}");
    }
    let mut before = "";
    for row in rows.iter().filter(|row| row.setting == setting) {
        let name = if row.domain == before { "" } else { row.domain };
        before = row.domain;
        let _ = write!(text, "\n{name:<17}{:<10}", row.system.name());
        for (cell, width) in cells(row).iter().zip(WIDTHS) {
            let _ = write!(text, "{cell:>width$}");
        }
    }
    text
}

const WIDTHS: [usize; HEADINGS.len()] = [11, 9, 8, 9, 11, 17, 11, 12];

/// The statements with their verdicts, as text.
#[must_use]
pub fn claims_text(claims: &[Claim]) -> String {
    let each = claims.iter().map(|claim| format!("{}\n    {}", claim.statement, claim.sentence()));
    each.collect::<Vec<_>>().join("\n")
}

/// All rows as CSV with a heading; empty cells where there is no mesh.
#[must_use]
pub fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "domain,system,setting,target,triangles,points,ratio_mean,ratio_p99,ratio_max,\
         angle_min_deg,area_ratio_p99,far_over_dense,passed,seconds\n",
    );
    for row in rows {
        let target = row.target.map_or(String::new(), |n| n.to_string());
        let names = [row.domain, row.system.name(), row.setting.name()].join(",");
        let _ = write!(text, "{names},{target},");
        match &row.figures {
            Some(f) => {
                let numbers = [f.ratio_mean, f.ratio_p99, f.ratio_max, f.angle_min_deg];
                let more = [f.area_ratio_p99, f.far_over_dense];
                let numbers: Vec<String> =
                    numbers.iter().chain(&more).map(f64::to_string).collect();
                let _ = write!(text, "{},{},{},", f.triangles, f.points, numbers.join(","));
                let _ = writeln!(text, "{},{}", f.passed, row.seconds);
            }
            None => {
                let _ = writeln!(text, ",,,,,,,,,{}", row.seconds);
            }
        }
    }
    text
}

/// Everything as JSON.
#[must_use]
pub fn json(rows: &[Row], claims: &[Claim]) -> Value {
    let judged = claims.iter().map(|claim| {
        let mut value = json!(claim);
        value["verdict"] = claim.sentence().into();
        value
    });
    json!({
        "schema": "trigrade-study/1",
        "rows": rows,
        "claims": judged.collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::{Figures, System, claims};

    fn rows() -> Vec<Row> {
        let figures = Figures {
            triangles: 1234,
            points: 640,
            ratio_mean: 1.023,
            ratio_p99: 1.1,
            ratio_max: f64::INFINITY,
            angle_min_deg: 31.5,
            area_ratio_p99: 1.6,
            far_over_dense: 4.0,
            passed: true,
        };
        let row = |system, setting, figures| Row {
            domain: "airfoil",
            system,
            setting,
            target: (setting == Setting::Equal).then_some(1000),
            figures,
            reason: None,
            seconds: 0.0125,
        };
        vec![
            row(System::Graded, Setting::Own, Some(figures)),
            row(System::Afm, Setting::Own, None),
            row(System::Afm, Setting::Equal, Some(figures)),
        ]
    }

    // spec: K32
    #[test]
    fn the_text_aligns_and_says_which_targets_were_missed() {
        let own = text(&rows(), Setting::Own);
        let lines: Vec<&str> = own.lines().skip(2).collect();
        assert_eq!(lines.len(), 3, "{own}");
        let widths: Vec<usize> = lines.iter().map(|line| line.chars().count()).collect();
        assert!(widths.iter().all(|w| *w == widths[0]), "{own}");
        assert!(
            lines[1].contains("1234 ") && lines[1].ends_with("12.5 ms") && lines[2].contains('-')
        );
        assert!(text(&rows(), Setting::Equal).contains("1234 !"));
    }

    // spec: K32
    #[test]
    fn csv_and_json_carry_every_row() {
        let rows = rows();
        let text = csv(&rows);
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let records: Vec<csv::StringRecord> =
            reader.records().collect::<Result<_, _>>().expect("as many cells in every row");
        assert_eq!(records.len(), 3);
        assert_eq!((&records[0][4], &records[1][4], &records[2][3]), ("1234", "", "1000"));
        let value = json(&rows, &claims(&rows));
        assert_eq!(value["rows"][0]["figures"]["triangles"], 1234);
        assert_eq!(value["rows"][2]["setting"], "equal");
        assert!(value["claims"][0]["verdict"].is_string());
    }
}
