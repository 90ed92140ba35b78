//! `trigrade demo`: the NACA 0012 airfoil by three methods, checked, with pictures and a report.

use super::arguments::DemoArguments;
use super::console::Console;
use super::failure::{EXIT_HOLDS, Failure};
use super::forms::{OutputFile, OutputForm};
use super::mesh::no_mesh;
use super::mesh_file::{self, Drawing, malformed, parse};
use super::outcome::Outcome;
use super::output::{Cleanup, Outputs};
use super::verdict::{self, Figures};
use super::watch::{Watch, seconds, time, total};
use super::words::count;
use crate::check::Report;
use crate::domain::naca::naca0012;
use crate::domain::{Domain, LoopRole};
use crate::draw::View;
use crate::format::domain_file::{DomainForm, ReadOptions, read_domain};
use crate::format::{MeshForm, MeshView, WriteOptions};
use crate::mesh::MeshData;
use crate::mesher::{Gradation, Meshed, Method, Options, mesh_domain};
use crate::point::Point2;
use crate::size::Density;
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Name of the domain's file in the folder.
const DOMAIN_FILE: &str = "naca0012.poly";

/// One way to mesh the airfoil.
struct Case {
    /// Stem of its files.
    name: &'static str,
    /// A line for people.
    title: &'static str,
    options: Options,
}

fn cases() -> [Case; 3] {
    let literal =
        Options { gradation: Gradation::Mean, density: Density::AllEdges, ..Options::default() };
    [
        Case {
            name: "graded",
            title: "graded, growth-limited spacing (default)",
            options: Options::default(),
        },
        Case { name: "literal", title: "graded, mean of all background edges", options: literal },
        Case {
            name: "afm",
            title: "plain advancing front",
            options: Options { method: Method::Afm, ..Options::default() },
        },
    ]
}

/// A file of a case: its place among the outputs, and the part of the plane a picture shows.
type CaseFile = (usize, OutputFile, Option<View>);

/// What came of a case.
struct Done {
    case: Case,
    meshed: Meshed,
    data: MeshData,
    report: Report,
    laps: Vec<(String, Duration)>,
}

/// Runs the verb.
///
/// # Errors
/// Exit code 2 when the folder cannot be written, 1 when a mesh does not pass its check.
pub fn run(
    arguments: &DemoArguments,
    console: &Console,
    cleanup: &Cleanup,
) -> Result<Outcome, Failure> {
    let folder = &arguments.output;
    std::fs::create_dir_all(folder).map_err(|e| Failure::io("create the folder", folder, &e))?;
    let files = Files::of(folder);
    let mut outputs = Outputs::prepare(&files.paths(), cleanup)?;
    // The domain takes the way every user's does: from a file.
    let poly = poly(&naca0012());
    outputs.fill(Files::DOMAIN, |out| out.write_all(poly.as_bytes()))?;
    let domain = read(&outputs)?;
    let mut done = Vec::new();
    for (i, case) in cases().into_iter().enumerate() {
        let watch = Watch::new(console);
        done.push(run_case(case, &domain, watch, (&mut outputs, &files.cases[i]))?);
    }
    let exit = done.iter().map(|case| case.report.exit_code()).max().unwrap_or(EXIT_HOLDS);
    let (text, json) = (table(&done), report_json(&done));
    outputs.fill(Files::TEXT, |out| writeln!(out, "{text}"))?;
    outputs.fill(Files::JSON, |out| writeln!(out, "{json:#}"))?;
    if exit == EXIT_HOLDS {
        outputs.commit()?;
    }
    Ok(Outcome { exit, text: format!("{text}\n\n{}", files.listing(exit)), json, checked: None })
}

/// The files of the demonstration, in the order they are staged.
struct Files {
    folder: PathBuf,
    cases: Vec<Vec<CaseFile>>,
}

impl Files {
    const DOMAIN: usize = 0;
    const TEXT: usize = 1;
    const JSON: usize = 2;

    fn of(folder: &Path) -> Self {
        let mut next = 3;
        let mut case = |name: &str| {
            let close_up = View { x0: -0.25, y0: -0.45, x1: 1.25, y1: 0.45 };
            let msh = OutputForm::Mesh(MeshForm::Msh, WriteOptions::default());
            [
                (format!("{name}.msh"), msh, None),
                (format!("{name}.svg"), OutputForm::Svg, None),
                (format!("{name}.png"), OutputForm::Png, None),
                (format!("{name}-airfoil.svg"), OutputForm::Svg, Some(close_up)),
                (format!("{name}-airfoil.png"), OutputForm::Png, Some(close_up)),
            ]
            .into_iter()
            .map(|(file, form, view)| {
                let file = OutputFile { path: folder.join(file), form, companion: None };
                next += 1;
                (next - 1, file, view)
            })
            .collect()
        };
        let cases = cases().iter().map(|c| case(c.name)).collect();
        Self { folder: folder.to_owned(), cases }
    }

    fn paths(&self) -> Vec<PathBuf> {
        let fixed = [DOMAIN_FILE, "report.txt", "report.json"].map(|name| self.folder.join(name));
        let rest = self.cases.iter().flatten().map(|(_, file, _)| file.path.clone());
        fixed.into_iter().chain(rest).collect()
    }

    fn listing(&self, exit: u8) -> String {
        if exit != EXIT_HOLDS {
            return "nothing was written: a mesh did not pass its check".into();
        }
        let at = |name: &str| self.folder.join(name).display().to_string();
        format!(
            "pictures  {}\n          {}\nmeshes    {}\ndomain    {}\nreport    {}",
            at("graded.png"),
            at("graded-airfoil.png"),
            at("graded.msh"),
            at(DOMAIN_FILE),
            at("report.json"),
        )
    }
}

fn read(outputs: &Outputs) -> Result<Domain, Failure> {
    let bytes = outputs.read_back(Files::DOMAIN)?;
    read_domain(&bytes, DomainForm::Poly, &ReadOptions::default()).map_err(|e| {
        Failure::cannot_run(super::failure::Diagnostic::new(e.to_string()).at(DOMAIN_FILE))
    })
}

fn run_case(
    case: Case,
    domain: &Domain,
    mut watch: Watch,
    (outputs, files): (&mut Outputs, &[CaseFile]),
) -> Result<Done, Failure> {
    let meshed = mesh_domain(domain, &case.options, &mut watch).map_err(|e| no_mesh(&e))?;
    watch.begin("write");
    let plain = MeshData::from(&meshed.mesh);
    for (index, file, view) in files {
        let title = format!("NACA 0012: {}", case.title);
        let drawing = Drawing { view: *view, ..Drawing::of(&plain, title) };
        mesh_file::write(outputs, *index, file, MeshView::from(&meshed.mesh), &drawing)?;
    }
    watch.begin("read back");
    let (index, file, _) = &files[0];
    let name = file.path.display().to_string();
    let data = parse(&outputs.read_back(*index)?, MeshForm::Msh, &[], false)
        .map_err(|e| malformed(&name, &e))?;
    watch.begin("check");
    let report = verdict::check_mesh(&data, Some(domain));
    Ok(Done { case, meshed, data, report, laps: watch.finish() })
}

fn table(done: &[Done]) -> String {
    let mut text = String::from(
        "NACA 0012: 200 points on the airfoil, 60 on a far field of 15 chords\n\n\
         method                                      triangles  predicted   R/2r mean    99 %     \
         max  angle min  verdict       time\n",
    );
    for Done { case, meshed, data, report, laps } in done {
        let figures = Figures::of(report).unwrap_or_default();
        let total = total(laps);
        let _ = writeln!(
            text,
            "{:<43}{:>10}{:>11}{:>12.4}{:>8.3}{:>8.3}{:>10.1}°  {:<8}{:>10}",
            case.title,
            count(data.triangles.len() as u64),
            count(meshed.prediction.triangles as u64),
            figures.mean,
            figures.p99,
            figures.max,
            figures.angle_min_deg,
            verdict::word(report),
            time(total),
        );
    }
    text.truncate(text.trim_end().len());
    text
}

fn report_json(done: &[Done]) -> Value {
    let mesh = |Done { case, meshed, data, report, laps }: &Done| {
        json!({
            "name": case.name,
            "method": case.title,
            "verdict": verdict::word(report),
            "predicted": meshed.prediction.triangles,
            "triangles": data.triangles.len(),
            "points": data.points.len(),
            "radius_ratio": Figures::of(report).map(|figures| figures.json()),
            "seconds": seconds(laps),
            "check": report,
        })
    };
    json!({
        "schema": "trigrade-demo/1",
        "domain": DOMAIN_FILE,
        "meshes": done.iter().map(mesh).collect::<Vec<_>>(),
    })
}

/// A domain of closed loops in Triangle's form; coordinates read back to the same bits.
fn poly(domain: &Domain) -> String {
    let mut text = String::from("# NACA 0012 in a circle of 15 chords\n");
    let _ = writeln!(text, "{} 2 0 0", domain.points.len());
    for (i, Point2 { x, y }) in domain.points.iter().enumerate() {
        let _ = writeln!(text, "{} {x} {y}", i + 1);
    }
    let total: usize = domain.loops.iter().map(|ring| ring.vertices.len()).sum();
    let _ = writeln!(text, "{total} 1");
    let mut number = 0;
    for ring in &domain.loops {
        for (i, marker) in ring.markers.iter().enumerate() {
            let (a, b) = (ring.vertices[i], ring.vertices[(i + 1) % ring.vertices.len()]);
            number += 1;
            let _ = writeln!(text, "{number} {} {} {marker}", a + 1, b + 1);
        }
    }
    let holes = domain.loops.iter().filter(|ring| matches!(ring.role, LoopRole::HoleOf(_)));
    let _ = writeln!(text, "{}", holes.count());
    // The middle of the chord lies inside the airfoil, the domain's only hole.
    text + "1 0.5 0\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: K9
    #[test]
    fn the_domain_survives_its_file() {
        let domain = naca0012();
        let text = poly(&domain);
        let read = read_domain(text.as_bytes(), DomainForm::Poly, &ReadOptions::default())
            .expect("the file is well formed");
        assert_eq!(read.points, domain.points, "to the bit");
        assert_eq!(text.lines().last(), Some("1 0.5 0"));
    }

    #[test]
    fn every_file_has_a_place_of_its_own() {
        let mut paths = Files::of(Path::new("demo")).paths();
        assert_eq!(paths.len(), 18);
        paths.sort();
        paths.dedup();
        assert_eq!(paths.len(), 18);
    }
}
