//! `trigrade mesh`: domain in, checked mesh out.

use super::arguments::{Farfield, MeshArguments};
use super::check::write_json;
use super::console::Console;
use super::domain_file::{invalid, load_domain};
use super::failure::{Diagnostic, EXIT_HOLDS, Failure};
use super::forms::{OutputFile, OutputForm, output_files};
use super::judged::{self, Judged, certify, judge, paths, read_back};
use super::mesh_file::{self, Drawing};
use super::outcome::{Outcome, file_names};
use super::output::{Cleanup, Outputs};
use super::quads;
use super::refinement::Refinement;
use super::size_file::load_size_field;
use super::size_layers::{NodalSpacing, nodal_spacing, spacing_layers};
use super::surface;
use super::surface_options::demand_on_plane;
use super::verdict::{self, Figures};
use super::watch::{Watch, prediction, seconds};
use super::words::count;
use crate::domain::Domain;
use crate::domain::validate::validate;
use crate::format::MeshView;
use crate::mesh::{Mesh, MeshData};
use crate::mesher::{Count, Fit, MeshError, Meshed, Options, mesh_plc};
use crate::size::Prediction;
use crate::structured::GridStats;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Runs the verb.
///
/// # Errors
/// Exit code 1: the domain is invalid. Exit code 2: files, limits, options.
pub fn run(
    arguments: &MeshArguments,
    console: &Console,
    cleanup: &Cleanup,
) -> Result<Outcome, Failure> {
    if surface::is_model(arguments)? {
        return surface::run(arguments, console, cleanup);
    }
    let mut watch = Watch::new(console);
    if let Some(flag) = arguments.options.idle_flag() {
        let message = format!("{flag} has a meaning with `--method delaunay` only");
        return Err(Failure::cannot_run(Diagnostic::new(message)));
    }
    demand_on_plane(&arguments.options, &arguments.on_surface)?;
    let quads = quads::wanted(&arguments.options)?;
    let files = output_files(&arguments.outputs, arguments.form.as_deref())?;
    watch.begin("read");
    let (input, domain) = load_domain(&arguments.domain, &arguments.reading)?;
    let mut options = arguments.options.options();
    if let Some(path) = &arguments.options.size_field {
        options.table = Some(Arc::new(load_size_field(path)?));
    }
    // Staged before the long work: a target that cannot be written is known now.
    let mut targets = paths(&files);
    targets.extend(arguments.certificate.clone());
    let mut outputs = Outputs::prepare(&targets, cleanup)?;
    watch.begin("validate");
    let plc = validate(&domain).map_err(|faults| invalid(&input.name, &faults))?;
    let mut summary = Summary::of(&input.name, &domain, arguments.reading.farfield);
    if arguments.dry_run {
        let predicted = prediction(|observer| mesh_plc(plc, &options, observer));
        summary.prediction = Some(predicted.map_err(|e| no_mesh(&e))?);
        return Ok(summary.outcome(watch.finish(), arguments.timings));
    }
    let has_viewer = files.iter().any(|file| file.form == OutputForm::Html);
    let shown = has_viewer.then(|| plc.clone());
    let mut meshed = mesh_plc(plc, &options, &mut watch).map_err(|e| no_mesh(&e))?;
    if quads {
        let Mesh { points, triangles, .. } = &mut meshed.mesh;
        quads::pair(triangles, Some(points))?;
    }
    watch.begin("write");
    summary.note(&meshed, &options);
    if let Count::Target(target) = options.count {
        summary.target = Some(target);
    }
    let background = shown.and_then(|plc| nodal_spacing(plc, &options));
    write_all(&mut outputs, &files, (&meshed, quads), background)?;
    if !arguments.no_check {
        watch.begin("read back");
        let meshes = read_back(&outputs, &files, MeshView::from(&meshed.mesh))?;
        watch.begin("check");
        let by_check =
            |name: &str, mesh: &_| Judged::new(name, verdict::check_mesh(mesh, Some(&domain)), ());
        let judged = judge(&meshes, by_check);
        if arguments.certificate.is_some() {
            let certificate = certify(&outputs, &files, &judged, Some(&input))?;
            write_json(&mut outputs, files.len(), &certificate)?;
        }
        summary.judged = Some(judged);
    }
    if summary.exit() == EXIT_HOLDS {
        outputs.commit()?;
        summary.written = targets;
    }
    let laps = watch.finish();
    Ok(summary.outcome(laps, arguments.timings))
}

/// Why the mesher made no mesh, as exit code and complaint.
#[must_use]
pub fn no_mesh(error: &MeshError) -> Failure {
    let diagnostic = Diagnostic::new(error.to_string());
    match error {
        MeshError::Invalid(_) | MeshError::Background(_) | MeshError::Grid(_) => {
            Failure::findings(vec![diagnostic])
        }
        MeshError::TooMany { .. } => Failure::cannot_run(
            diagnostic
                .help("`--dry-run` prints the prediction; a larger --max-triangles allows it")
                .help("--coarsen takes the field that fits, --target COUNT any other"),
        ),
        MeshError::Front(_)
        | MeshError::Refine(_)
        | MeshError::Split(_)
        | MeshError::Options(_)
        | MeshError::Gradation(_)
        | MeshError::Table(_)
        | MeshError::BadSpacing { .. } => Failure::cannot_run(diagnostic),
    }
}

/// Writes every file into its stage.
fn write_all(
    outputs: &mut Outputs,
    files: &[OutputFile],
    (meshed, quads): (&Meshed, bool),
    background: Option<NodalSpacing>,
) -> Result<(), Failure> {
    let needs_picture = files.iter().any(|file| file.form.is_picture());
    let data = if needs_picture { MeshData::from(&meshed.mesh) } else { MeshData::default() };
    let layers = match background {
        Some(_) => spacing_layers(&data, &meshed.spacing),
        None => Vec::new(),
    };
    // Without a field the background is a mesh and no more.
    let spacing = |nodal: NodalSpacing| match layers.is_empty() {
        true => NodalSpacing { spacing: Vec::new(), ..nodal },
        false => nodal,
    };
    let background = background.map(spacing);
    let drawing = Drawing { layers, background, ..Drawing::of(&data, "") };
    for (i, file) in files.iter().enumerate() {
        let cells = quads.then_some(meshed.mesh.triangles.len() / 2);
        let view = quads::view(MeshView::from(&meshed.mesh), cells);
        mesh_file::write(outputs, i, file, view, &drawing)?;
    }
    Ok(())
}

/// A mesh this near to its target has reached it.
const TARGET_TOLERANCE: f64 = 0.05;

/// What is told of a run.
struct Summary {
    name: String,
    points: usize,
    prediction: Option<Prediction>,
    mesh: Option<(usize, usize)>,
    refinement: Option<Refinement>,
    splits: usize,
    fit: Option<Fit>,
    grid: Option<GridStats>,
    target: Option<usize>,
    judged: Option<Judged>,
    written: Vec<PathBuf>,
    far_field: Option<Farfield>,
}

impl Summary {
    fn of(name: &str, domain: &Domain, far_field: Option<Farfield>) -> Self {
        Self {
            name: name.to_owned(),
            points: domain.points.len(),
            prediction: None,
            mesh: None,
            refinement: None,
            splits: 0,
            fit: None,
            grid: None,
            target: None,
            judged: None,
            written: Vec::new(),
            far_field,
        }
    }

    fn note(&mut self, meshed: &Meshed, options: &Options) {
        self.prediction = Some(meshed.prediction);
        self.refinement = meshed.refine.map(|stats| Refinement::new(stats, options));
        self.splits = meshed.splits;
        self.mesh = Some((meshed.mesh.points.len(), meshed.mesh.triangles.len()));
        self.fit = meshed.fit;
        self.grid = meshed.grid;
    }

    /// What to say when the target was not reached: the boundary alone may ask for more or less.
    fn missed_target(&self) -> Option<String> {
        let (target, (_, triangles)) = (self.target?, self.mesh?);
        let ratio = triangles as f64 / target as f64;
        ((ratio - 1.0).abs() > TARGET_TOLERANCE).then(|| {
            format!(
                "the target of {} triangles is out of reach with this boundary",
                count(target as u64)
            )
        })
    }

    fn exit(&self) -> u8 {
        judged::exit(self.judged.as_ref())
    }

    fn outcome(self, laps: Vec<(String, Duration)>, timings: bool) -> Outcome {
        let checked = self.judged.as_ref().map(|judged| judged.checked(&self.name));
        let (text, json) = (self.text(&laps, timings), self.json(&laps));
        Outcome { exit: self.exit(), text, json, checked }
    }

    fn text(&self, laps: &[(String, Duration)], timings: bool) -> String {
        let mut lines = vec![self.heading()];
        let mut line = |label: &str, text: String| lines.push(format!("  {label:<11}{text}"));
        if let Some(prediction) = self.prediction {
            line("predicted", format!("{} triangles", count(prediction.triangles as u64)));
        }
        if let Some((points, triangles)) = self.mesh {
            let [triangles, points] = [triangles, points].map(|n| count(n as u64));
            line("meshed", format!("{triangles} triangles, {points} points"));
        }
        if let Some(grid) = &self.grid {
            line("grid", grid_in_words(grid));
        }
        if self.splits > 0 {
            line("boundary", format!("{} points added", count(self.splits as u64)));
        }
        for shortfall in self.refinement.iter().flat_map(Refinement::sentences) {
            line("refined", shortfall);
        }
        if let Some(fit) = self.fit {
            let [low, median, high] = [fit.low, fit.median, fit.high];
            line(
                "size",
                format!(
                    "edge length / spacing {low:.2} (1 %), {median:.2} (50 %), {high:.2} (99 %)"
                ),
            );
        }
        if let Some(text) = self.missed_target() {
            line("target", text);
        }
        match &self.judged {
            Some(Judged { name, report, .. }) => {
                if let Some(figures) = Figures::of(report) {
                    line("quality", figures.to_string());
                }
                line("check", verdict::sentence(report, name));
            }
            None if self.mesh.is_some() => line("check", "left out (--no-check)".into()),
            None => {}
        }
        lines.extend(judged::closing(self.judged.as_ref(), laps, timings, &self.written));
        lines.join("\n")
    }

    fn heading(&self) -> String {
        let far = self.far_field.map_or(String::new(), |far| {
            format!(", far field of {} chords with {} points", far.radius, far.points)
        });
        format!("{}: {} points{far}", self.name, count(self.points as u64))
    }

    fn json(&self, laps: &[(String, Duration)]) -> Value {
        let report = self.judged.as_ref().map(|judged| &judged.report);
        json!({
            "schema": "trigrade-mesh/1",
            "verdict": judged::word(self.judged.as_ref()),
            "domain": self.name,
            "predicted": self.prediction.map(|p| p.triangles),
            "points": self.mesh.map(|(points, _)| points),
            "triangles": self.mesh.map(|(_, triangles)| triangles),
            "boundary_points_added": self.splits,
            "refinement": self.refinement.as_ref().map(Refinement::json),
            "edge_length_over_spacing": self.fit.map(|fit| json!({
                "percentile_1": fit.low,
                "median": fit.median,
                "percentile_99": fit.high,
                "edges": fit.edges,
            })),
            "grid": self.grid.map(|grid| json!({
                "columns": grid.columns,
                "rows": grid.rows,
                "sweeps": grid.relaxed.map(|done| done.sweeps),
                "residual": grid.relaxed.map(|done| done.residual),
            })),
            "quality": report.and_then(Figures::of).map(|f| f.json()),
            "written": file_names(&self.written),
            "seconds": seconds(laps),
            "check": report,
        })
    }
}

/// A structured grid in words.
#[must_use]
pub fn grid_in_words(grid: &GridStats) -> String {
    let cells = format!("{} x {} cells", grid.columns, grid.rows);
    match grid.relaxed {
        None => cells,
        Some(done) => {
            format!("{cells}, {} sweeps, residual {:.1e}", done.sweeps, done.residual)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::failure::EXIT_FINDINGS;

    // spec: K1
    #[test]
    fn a_limit_is_exit_2_and_an_empty_domain_exit_1() {
        let many = MeshError::TooMany { predicted: 1e9, stopped: true, limit: 10 };
        assert_eq!(no_mesh(&many).exit, 2);
        let empty = MeshError::Background(crate::background::BackgroundError::Empty);
        assert_eq!(no_mesh(&empty).exit, EXIT_FINDINGS);
    }
}
