//! `trigrade delaunay`: points in, their Delaunay triangulation out.

use super::arguments::DelaunayArguments;
use super::check::write_json;
use super::console::Console;
use super::domain_file;
use super::failure::{Diagnostic, EXIT_HOLDS, Failure};
use super::forms::{OutputFile, output_files_or_json};
use super::judged::{self, Judged, judge, paths, read_back};
use super::mesh_file::{self, Drawing};
use super::outcome::{Outcome, file_names};
use super::output::{Cleanup, Outputs};
use super::point_file::{Points, repetitions};
use super::verdict::{self, Figures};
use super::watch::{Watch, seconds};
use super::words::count;
use crate::check::{CheckOptions, check};
use crate::delaunay::{CdtError, Engine};
use crate::domain::Domain;
use crate::format::MeshView;
use crate::mesh::MeshData;
use crate::point::Point2;
use crate::triangulate::{
    Options, TriangulateError, Triangulated, triangulate_domain, triangulate_points,
};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Duration;

/// Runs the verb.
///
/// # Errors
/// Exit code 1: a domain that is invalid, or segments that cross. Exit code 2: files, forms.
pub fn run(
    arguments: &DelaunayArguments,
    console: &Console,
    cleanup: &Cleanup,
) -> Result<Outcome, Failure> {
    let mut watch = Watch::new(console);
    let files = output_files_or_json(&arguments.outputs, arguments.form.as_deref())?;
    let mut targets = paths(&files);
    targets.extend(arguments.map.clone());
    // Staged before the long work: a target that cannot be written is known now.
    let mut outputs = Outputs::prepare(&targets, cleanup)?;
    watch.begin("read");
    let points = Points::load(&arguments.input)?;
    watch.begin("triangulate");
    let domain = points.domain().filter(|_| !arguments.unconstrained);
    let result = triangulate(&points, domain, options(arguments))
        .map_err(|error| no_triangulation(&points, domain, &error))?;
    watch.begin("write");
    write_all(&mut outputs, &files, &result)?;
    if arguments.map.is_some() {
        write_json(&mut outputs, files.len(), &map_json(&result))?;
    }
    let mut judged = None;
    if arguments.check {
        watch.begin("check");
        judged = Some(check_written(&outputs, &files, &result, domain.is_some())?);
    }
    let passed = judged::exit(judged.as_ref()) == EXIT_HOLDS;
    if passed {
        outputs.commit()?;
    }
    let laps = watch.finish();
    let written = if passed { targets } else { Vec::new() };
    let engine = arguments.engine.engine();
    let summary = Summary { points, result, judged, written, engine, laps };
    Ok(summary.outcome(arguments.timings))
}

fn options(arguments: &DelaunayArguments) -> Options {
    Options {
        engine: arguments.engine.engine(),
        parallel: true,
        hull: arguments.hull,
        split_crossings: arguments.split_crossings,
        outline: arguments.check,
    }
}

fn triangulate(
    points: &Points,
    domain: Option<&Domain>,
    options: Options,
) -> Result<Triangulated, TriangulateError> {
    match domain {
        Some(domain) => triangulate_domain(domain, options),
        None => triangulate_points(points.points(), options),
    }
}

/// Why there is no triangulation, as exit code and complaint.
fn no_triangulation(points: &Points, domain: Option<&Domain>, error: &TriangulateError) -> Failure {
    let name = &points.input.name;
    const SPLIT: &str = "--split-crossings cuts segments where they cross";
    const HULL: &str = "--hull keeps all of the hull, whatever is inside";
    let diagnostic = Diagnostic::new(error.to_string());
    match error {
        TriangulateError::Invalid(faults) => {
            let mut failure = domain_file::invalid(name, faults);
            let help = |id: &str| match id {
                "D8" | "D9" => Some(SPLIT),
                "D14" | "D15" => Some(HULL),
                _ => None,
            };
            if let (Some(first), Some(help)) =
                (failure.diagnostics.first_mut(), help(faults[0].id()))
            {
                first.helps.push(help.to_owned());
            }
            failure
        }
        TriangulateError::Segments(CdtError::Unconstrained(_)) => {
            let help = "--unconstrained triangulates the points alone";
            Failure::cannot_run(diagnostic.at(name).help(help))
        }
        TriangulateError::Segments(CdtError::Crossing { first, second }) => {
            let told = [first, second].map(|&i| edge_told(domain, name, i));
            let diagnostic = told.into_iter().fold(diagnostic.rule("T4"), Diagnostic::at);
            Failure::findings(vec![diagnostic.help(SPLIT)])
        }
        TriangulateError::Segments(CdtError::Tangled { segment }) => {
            let place = edge_told(domain, name, *segment);
            Failure::findings(vec![diagnostic.rule("T9").at(place)])
        }
        TriangulateError::Degenerate { segment, .. } => {
            let place = edge_told(domain, name, *segment);
            Failure::findings(vec![diagnostic.rule("D4").at(place)])
        }
        TriangulateError::Points(_) => Failure::cannot_run(diagnostic.at(name)),
        TriangulateError::Inside(_) => Failure::findings(vec![diagnostic.at(name).help(HULL)]),
        TriangulateError::Segments(_) => Failure::findings(vec![diagnostic.rule("T4").at(name)]),
    }
}

/// A loop's edge or segment for people: its place, and its ends.
fn edge_told(domain: Option<&Domain>, name: &str, index: u32) -> String {
    let Some(domain) = domain else { return name.to_owned() };
    let Some([a, b]) = domain.edges().nth(index as usize) else { return name.to_owned() };
    let loops = domain.loops.iter().map(|l| l.vertices.len()).sum::<usize>();
    let place = (index as usize).checked_sub(loops).and_then(|i| domain.places.segments.get(i));
    let place = place.map_or_else(|| name.to_owned(), |p| domain_file::place_in(name, p));
    let at = |v: u32| domain.points.get(v as usize).map_or_else(String::new, Point2::to_string);
    format!("{place} from {} to {}", at(a), at(b))
}

fn write_all(
    outputs: &mut Outputs,
    files: &[OutputFile],
    result: &Triangulated,
) -> Result<(), Failure> {
    let needs_picture = files.iter().any(|file| file.form.is_picture());
    let data = if needs_picture { MeshData::from(&result.mesh) } else { MeshData::default() };
    let drawing = Drawing::of(&data, "");
    for (i, file) in files.iter().enumerate() {
        mesh_file::write(outputs, i, file, MeshView::from(&result.mesh), &drawing)?;
    }
    Ok(())
}

fn map_json(result: &Triangulated) -> Value {
    json!({
        "schema": "trigrade-map/1",
        "map": result.map,
        "repeated": result.repeated,
        "crossings": result.crossings,
    })
}

/// Lets the checker judge every mesh read back from its bytes: the region is covered exactly once, every
/// point is a vertex, every segment a chain of edges, and no circle holds a vertex across an edge.
fn check_written(
    outputs: &Outputs,
    files: &[OutputFile],
    result: &Triangulated,
    is_constrained: bool,
) -> Result<Judged, Failure> {
    let meshes = read_back(outputs, files, MeshView::from(&result.mesh))?;
    let options = CheckOptions::default();
    let options = match is_constrained {
        true => options.constrained_delaunay(true),
        false => options.delaunay(true),
    };
    let outline = result.outline.as_ref();
    Ok(judge(&meshes, |name, mesh| Judged::new(name, check(mesh, outline, &options), ())))
}

/// What is told of a run.
struct Summary {
    points: Points,
    result: Triangulated,
    judged: Option<Judged>,
    written: Vec<PathBuf>,
    engine: Engine,
    laps: Vec<(String, Duration)>,
}

impl Summary {
    fn exit(&self) -> u8 {
        judged::exit(self.judged.as_ref())
    }

    fn outcome(self, timings: bool) -> Outcome {
        let checked = self.judged.as_ref().map(|judged| judged.checked(&self.points.input.name));
        Outcome { exit: self.exit(), text: self.text(timings), json: self.json(), checked }
    }

    fn outside(&self) -> usize {
        self.result.map.iter().filter(|new| new.is_none()).count()
    }

    fn text(&self, timings: bool) -> String {
        let given = self.points.points().len();
        let mut lines = vec![format!("{}: {} points", self.points.input.name, count(given as u64))];
        let mut line = |label: &str, text: String| lines.push(format!("  {label:<11}{text}"));
        if !self.points.left_out().is_empty() {
            line("left out", self.points.left_out().join("; "));
        }
        if let Some(text) = repetitions(&self.points, &self.result.repeated) {
            line("repeated", text);
        }
        if self.outside() > 0 {
            line("outside", format!("{} points, left out", count(self.outside() as u64)));
        }
        if self.result.crossings > 0 {
            line("crossings", format!("{} points", count(self.result.crossings as u64)));
        }
        line("meshed", self.meshed());
        if let Some(Judged { name, report, .. }) = &self.judged {
            if let Some(figures) = Figures::of(report) {
                line("quality", figures.to_string());
            }
            line("check", verdict::sentence(report, name));
        }
        lines.extend(judged::closing(self.judged.as_ref(), &self.laps, timings, &self.written));
        lines.join("\n")
    }

    fn meshed(&self) -> String {
        let mesh = &self.result.mesh;
        let [triangles, points] =
            [mesh.triangles.len(), mesh.points.len()].map(|n| count(n as u64));
        let why = match mesh.points.len() {
            _ if !mesh.triangles.is_empty() => {
                let engine = self.engine.name();
                return format!("{triangles} triangles, {points} points ({engine})");
            }
            0 => "there is no point".to_owned(),
            1 => "there is one point".to_owned(),
            2 => "there are two points".to_owned(),
            _ => format!("all {points} points are on one line"),
        };
        format!("no triangles: {why}")
    }

    fn json(&self) -> Value {
        json!({
            "schema": "trigrade-delaunay/1",
            "verdict": judged::word(self.judged.as_ref()),
            "input": self.points.input.name,
            "given": self.points.points().len(),
            "left_out": self.points.left_out(),
            "repeated": self.result.repeated.len(),
            "outside": self.outside(),
            "crossings": self.result.crossings,
            "engine": self.engine.name(),
            "points": self.result.mesh.points.len(),
            "triangles": self.result.mesh.triangles.len(),
            "written": file_names(&self.written),
            "seconds": seconds(&self.laps),
            "check": self.judged.as_ref().map(|judged| &judged.report),
        })
    }
}
