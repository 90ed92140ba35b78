//! `trigrade compare`: two meshes, every metric of both, and both in one picture.

use super::arguments::CompareArguments;
use super::domain_file::load_against;
use super::failure::{Diagnostic, EXIT_HOLDS, Failure};
use super::forms::{OutputForm, output_files};
use super::mesh_file::{LoadedMesh, load_mesh};
use super::outcome::Outcome;
use super::output::{Cleanup, Outputs};
use super::verdict;
use super::words::count;
use crate::check::quality::Better;
use crate::check::{Metric, MetricSummary, Report};
use crate::draw::{self, DrawError, Layer, Panel};
use crate::mesh::MeshData;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// A mesh and what the checker says of it.
struct Side {
    name: String,
    mesh: MeshData,
    report: Report,
}

/// Runs the verb.
///
/// # Errors
/// Exit code 2: a file cannot be read or written, or a picture cannot be drawn.
pub fn run(arguments: &CompareArguments, cleanup: &Cleanup) -> Result<Outcome, Failure> {
    let files = output_files(&arguments.outputs, None)?;
    if let Some(file) = files.iter().find(|file| !file.form.is_picture()) {
        let diagnostic = Diagnostic::new("a comparison is .svg, .png or .html");
        return Err(Failure::cannot_run(diagnostic.at(file.path.display())));
    }
    let domain = load_against(&arguments.against)?.map(|(_, domain)| domain);
    let side = |path| {
        let LoadedMesh { name, mesh, .. } = load_mesh(path, &arguments.reading)?;
        let report = verdict::check_mesh(&mesh, domain.as_ref());
        Ok(Side { name, mesh, report })
    };
    let sides = [side(&arguments.a)?, side(&arguments.b)?];
    let mut outputs = Outputs::prepare(&super::judged::paths(&files), cleanup)?;
    let table = table(&sides);
    for (i, file) in files.iter().enumerate() {
        let bytes = draw(&sides, &table, arguments, file.form).map_err(|e| {
            Failure::cannot_run(Diagnostic::new(e.to_string()).at(file.path.display()))
        })?;
        outputs.fill(i, |out| out.write_all(&bytes))?;
    }
    outputs.commit()?;
    let exit = sides.iter().map(|side| side.report.exit_code()).max().unwrap_or(EXIT_HOLDS);
    Ok(Outcome {
        exit,
        text: text(&sides, &table),
        json: report_json(&sides, &table),
        checked: None,
    })
}

/// A figure of both meshes.
struct Line {
    metric: Metric,
    better: Better,
    /// `mean`, `99 %`, `worst`, ...
    figure: &'static str,
    values: [Option<f64>; 2],
}

impl Line {
    /// Second minus first.
    fn difference(&self) -> Option<f64> {
        Some(self.values[1]? - self.values[0]?)
    }

    /// Which mesh is the better one in this figure.
    fn winner(&self) -> Option<usize> {
        let difference = self.difference().filter(|d| *d != 0.0)?;
        match self.better {
            Better::Lower => Some(usize::from(difference < 0.0)),
            Better::Higher => Some(usize::from(difference > 0.0)),
            Better::Neither => None,
        }
    }
}

/// Three figures of every metric: the mean, the value that 99 % keep, and the worst.
fn table(sides: &[Side; 2]) -> Vec<Line> {
    let summary = |side: &Side, metric| {
        side.report.quality.as_ref().and_then(|quality| quality.summary(metric).cloned())
    };
    Metric::all()
        .flat_map(|metric| {
            let both = [0, 1].map(|i| summary(&sides[i], metric));
            let better = metric.better();
            figures(better).map(|(figure, of)| Line {
                metric,
                better,
                figure,
                values: [0, 1].map(|i| both[i].as_ref().and_then(of)),
            })
        })
        .collect()
}

type Figure = (&'static str, fn(&MetricSummary) -> Option<f64>);

fn figures(better: Better) -> [Figure; 3] {
    let mean: Figure = ("mean", |s| s.mean);
    match better {
        Better::Higher => [mean, ("1 %", |s| s.percentile_1), ("least", |s| s.min)],
        Better::Lower => [mean, ("99 %", |s| s.percentile_99), ("most", |s| s.max)],
        Better::Neither => [mean, ("least", |s| s.min), ("most", |s| s.max)],
    }
}

/// A value to five digits; a dash where there is none.
fn value(value: Option<f64>) -> String {
    let Some(v) = value else { return "-".to_owned() };
    let size = v.abs();
    match size {
        0.0 => "0".to_owned(),
        s if !(1e-4..1e6).contains(&s) => format!("{v:.3e}"),
        s if s >= 100.0 => format!("{v:.2}"),
        _ => format!("{v:.4}"),
    }
}

fn signed(difference: Option<f64>) -> String {
    let text = value(difference);
    if difference.is_some_and(|d| d > 0.0) { format!("+{text}") } else { text }
}

fn winner(line: &Line) -> &'static str {
    match line.winner() {
        Some(0) => "A",
        Some(_) => "B",
        None if line.difference() == Some(0.0) => "=",
        None => "",
    }
}

fn text(sides: &[Side; 2], table: &[Line]) -> String {
    let mut text = String::new();
    for (letter, side) in ["A", "B"].iter().zip(sides) {
        let [triangles, points] =
            [side.mesh.triangles.len(), side.mesh.points.len()].map(|n| count(n as u64));
        let verdict = verdict::word(&side.report);
        let _ = writeln!(
            text,
            "{letter}: {}: {triangles} triangles, {points} points, check {verdict}",
            side.name
        );
    }
    let heading = ["metric", "", "A", "B", "B - A", "better"];
    let _ = write!(
        text,
        "\n{:<23}{:<6}{:>12}{:>12}{:>12}  {}",
        heading[0], heading[1], heading[2], heading[3], heading[4], heading[5]
    );
    for line in table {
        let name = if line.figure == "mean" { line.metric.name() } else { "" };
        let [a, b] = line.values.map(value);
        let difference = signed(line.difference());
        let row =
            format!("{name:<23}{:<6}{a:>12}{b:>12}{difference:>12}  {}", line.figure, winner(line));
        let _ = write!(text, "\n{}", row.trim_end());
    }
    let wins = |i| table.iter().filter(|line| line.winner() == Some(i)).count();
    let _ = write!(text, "\n\nA is better in {} figures, B in {}", wins(0), wins(1));
    text
}

fn report_json(sides: &[Side; 2], table: &[Line]) -> Value {
    let side = |side: &Side| {
        json!({
            "mesh": side.name,
            "verdict": verdict::word(&side.report),
            "triangles": side.mesh.triangles.len(),
            "points": side.mesh.points.len(),
            "check": side.report,
        })
    };
    let figures = table.iter().map(|line| {
        json!({
            "metric": line.metric,
            "figure": line.figure,
            "a": line.values[0],
            "b": line.values[1],
            "difference": line.difference(),
            "better": line.winner().map(|i| ["a", "b"][i]),
        })
    });
    json!({
        "schema": "trigrade-compare/1",
        "a": side(&sides[0]),
        "b": side(&sides[1]),
        "figures": figures.collect::<Vec<_>>(),
    })
}

/// The picture, or the page around it.
fn draw(
    sides: &[Side; 2],
    table: &[Line],
    arguments: &CompareArguments,
    form: OutputForm,
) -> Result<Vec<u8>, DrawError> {
    let meshes = sides.each_ref().map(|side| &side.mesh);
    let ratios = meshes.map(Layer::radius_ratio);
    let panels = [0, 1].map(|i| {
        let caption = format!("{}: {}", ["A", "B"][i], sides[i].name);
        let panel = Panel::new(meshes[i], caption).coloured(&ratios[i]);
        Panel { view: arguments.window, ..panel }
    });
    let layers = draw::comparison_layers(meshes);
    let width = f64::from(arguments.width);
    let options = draw::Options { width, columns: 2, png_scale: 1.5, ..draw::Options::default() };
    match form {
        OutputForm::Png => draw::comparison_png(&panels, &layers, &options),
        OutputForm::Html => {
            let svg = draw::comparison(&panels, &layers, &options)?;
            Ok(page(sides, table, &svg).into_bytes())
        }
        _ => draw::comparison(&panels, &layers, &options).map(String::into_bytes),
    }
}

const STYLE: &str = "body{font:15px/1.45 system-ui,sans-serif;margin:1.5rem auto;max-width:90rem;padding:0 1rem;color:#1b1f24}\
table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:.9rem}td,th{padding:.1rem .9rem;text-align:right}\
td:first-child,td:nth-child(2),th:first-child{text-align:left}tr.first td{border-top:1px solid #d5d9df}\
td.a{color:#0072b2;font-weight:600}td.b{color:#b34700;font-weight:600}svg{max-width:100%;height:auto}";

fn page(sides: &[Side; 2], table: &[Line], svg: &str) -> String {
    let escape = |text: &str| text.replace('&', "&amp;").replace('<', "&lt;");
    let names = sides.each_ref().map(|side| escape(&side.name));
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <title>{0} and {1}</title>\n<style>{STYLE}</style></head>\n<body><h1>{0} and {1}</h1>\n\
         {svg}<table>\n<tr><th>metric</th><th></th><th>A</th><th>B</th><th>B - A</th>\
         <th>better</th></tr>\n",
        names[0], names[1]
    );
    for line in table {
        let is_first = line.figure == "mean";
        let name = if is_first { line.metric.name() } else { "" };
        let row = if is_first { " class=\"first\"" } else { "" };
        let [a, b] = line.values.map(value);
        let class = line.winner().map_or("", |i| ["a", "b"][i]);
        let _ = writeln!(
            out,
            "<tr{row}><td title=\"{}\">{name}</td><td>{}</td><td>{a}</td><td>{b}</td><td>{}</td>\
             <td class=\"{class}\">{}</td></tr>",
            escape(line.metric.formula()),
            line.figure,
            signed(line.difference()),
            winner(line)
        );
    }
    out + "</table></body></html>\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{CheckOptions, check};

    fn side(height: f64) -> Side {
        let points = vec![[0.0; 3], [4.0, 0.0, 0.0], [2.0, height, 0.0]];
        let mesh = MeshData { points, triangles: vec![[0, 1, 2]], ..MeshData::default() };
        let report = check(&mesh, None, &CheckOptions::default());
        Side { name: format!("<{height}>.off"), mesh, report }
    }

    // spec: K35
    #[test]
    fn the_better_mesh_is_named_whichever_way_a_metric_points() {
        let table = table(&[side(0.5), side(3.4)]);
        assert_eq!(table.len(), 3 * Metric::COUNT);
        let of = |metric| table.iter().find(|line| line.metric == metric).expect("it is there");
        assert_eq!(of(Metric::RadiusRatio).winner(), Some(1), "lower is better");
        assert_eq!(of(Metric::MinAngle).winner(), Some(1), "higher is better");
        assert_eq!(of(Metric::Area).winner(), None, "neither is better");
        assert!(of(Metric::Area).difference().is_some_and(|d| d > 5.0));
        let same = super::table(&[side(1.0), side(1.0)]);
        assert!(same.iter().all(|line| line.winner().is_none() && line.difference() == Some(0.0)));
    }

    // spec: K35
    #[test]
    fn a_mesh_without_quality_is_compared_without_figures() {
        let mut empty = side(1.0);
        empty.mesh = MeshData::default();
        empty.report = check(&empty.mesh, None, &CheckOptions::default());
        let sides = [side(1.0), empty];
        let table = table(&sides);
        assert!(table.iter().all(|line| line.winner().is_none()));
        assert!(text(&sides, &table).contains('-'));
    }

    // spec: K35
    #[test]
    fn the_page_is_one_document_and_escapes_names() {
        let sides = [side(1.0), side(2.0)];
        let page = page(&sides, &table(&sides), "<svg></svg>");
        assert!(page.contains("&lt;1>.off") && !page.contains("<1>"));
        for loader in ["http:", "href=", "src=", "url(", "<script"] {
            assert!(!page.contains(loader), "{loader}");
        }
    }

    #[test]
    fn values_have_about_five_digits() {
        let of = |v: f64| value(Some(v));
        assert_eq!(
            [of(1.23456), of(0.0), of(1234.567), of(1e-9)],
            ["1.2346", "0", "1234.57", "1.000e-9"]
        );
        assert_eq!(
            (signed(Some(0.5)), signed(Some(-0.5)), signed(None)),
            ("+0.5000".into(), "-0.5000".into(), "-".into())
        );
    }
}
