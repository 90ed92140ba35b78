//! `trigrade check`: the verdict on anybody's mesh.

use super::arguments::CheckArguments;
use super::console::Console;
use super::domain_file::load_against;
use super::failure::{Diagnostic, EXIT_FINDINGS, Failure};
use super::forms::{OutputFile, output_files};
use super::input::{Input, load};
use super::mesh_file::{Drawing, LoadedMesh, load_mesh, write};
use super::outcome::{Checked, Outcome};
use super::output::{Cleanup, Outputs};
use super::size_file::load_node_data;
use super::surface;
use super::verdict;
use super::watch::{Watch, stages};
use super::words::count;
use crate::check::certificate::{Certificate, FileHash};
use crate::check::size::{SizeFit, size_fit};
use crate::check::surface::{SurfaceLimits, check_on_model};
use crate::check::{Baseline, CheckOptions, GateError, GateFile, Report, check};
use crate::domain::Domain;
use crate::draw;
use crate::format::MeshView;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Runs the verb.
///
/// # Errors
/// Exit code 2: a file cannot be read or is malformed, or another cannot be written. An invalid
/// domain is for `check` itself to judge: it needs no sound domain to see that a mesh does not match
/// it.
pub fn run(
    arguments: &CheckArguments,
    console: &Console,
    cleanup: &Cleanup,
) -> Result<Outcome, Failure> {
    let model = arguments.surface.as_deref();
    let model = model.map(|path| surface::load_model(path, None, arguments.weld)).transpose()?;
    let certified = arguments.verify_certificate.as_deref().map(load_certificate).transpose()?;
    let options = match &certified {
        Some(certificate) => certificate.options(),
        None => options(arguments)?,
    };
    let limits = certified.as_ref().and_then(|certificate| certificate.surface.as_ref());
    let limits = limits.map_or_else(|| surface_limits(arguments), |surface| surface.limits);
    let side = SideFiles::prepare(arguments, cleanup)?;
    let mut watch = Watch::new(console);
    watch.begin("read");
    let files = Files::load(arguments)?;
    let field = arguments.size.as_deref().map(load_node_data).transpose()?;
    watch.begin("check");
    let (mesh, name) = (&files.loaded.mesh, &files.loaded.name);
    let (report, found) = match &model {
        None => (check(mesh, files.domain(), &options), None),
        Some((_, model)) => {
            let (report, found) = check_on_model(mesh, (model, &limits), files.domain(), &options);
            (report, Some(found))
        }
    };
    let laps = watch.finish();
    let fresh = files.certificate(&report, &options);
    let fresh = match &model {
        Some((input, _)) => {
            let file = FileHash::of(&input.name, &[&input.bytes]);
            fresh.map(|fresh| fresh.on_model(file, limits))
        }
        None => fresh,
    };
    let picture =
        Drawing { highlights: draw::highlights(&report), ..Drawing::of(mesh, name.clone()) };
    side.write(&report, fresh.as_ref(), &picture)?;
    let mut outcome = Outcome {
        exit: report.exit_code(),
        text: verdict::text(&report, name),
        json: verdict::json(&report),
        checked: Some(Box::new(files.checked(report))),
    };
    if let Some(field) = &field {
        tell_size(size_fit(mesh, field), &mut outcome);
    }
    if arguments.timings {
        outcome.text.push_str(&format!("\n  {:<11}{}", "time", stages(&laps)));
    }
    if let Some(found) = &found {
        surface::tell(found, &mut outcome);
    }
    if let (Some(certified), Some(fresh)) = (certified, fresh) {
        confirm(&certified, &fresh, &mut outcome);
    }
    Ok(outcome)
}

fn surface_limits(arguments: &CheckArguments) -> SurfaceLimits {
    SurfaceLimits {
        chord_error: arguments.chord_error,
        normal_deviation_deg: arguments.normal_deviation,
    }
}

/// Adds how well the edges fit a size field.
fn tell_size(fit: Option<SizeFit>, outcome: &mut Outcome) {
    let line = match &fit {
        Some(SizeFit { percentile_1: low, median, percentile_99: high, edges, outside }) => {
            format!(
                "edge length / spacing {low:.2} (1 %), {median:.2} (50 %), {high:.2} (99 %) over {} \
                 edges, {} outside of the field",
                count(*edges),
                count(*outside)
            )
        }
        None => "the field covers no edge inside the mesh".to_owned(),
    };
    outcome.text.push_str(&format!("\n  size       {line}"));
    outcome.json["edge_length_over_spacing"] = serde_json::json!(fit);
}

/// Says whether the certificate holds; one that does not is a finding.
fn confirm(certified: &Certificate, fresh: &Certificate, outcome: &mut Outcome) {
    let line = match certified.confirmed_by(fresh) {
        Ok(()) => {
            "confirmed: the files are those certified, and the check says the same".to_owned()
        }
        Err(error) => {
            outcome.exit = outcome.exit.max(EXIT_FINDINGS);
            format!("NOT CONFIRMED: {error}")
        }
    };
    outcome.text.push_str(&format!("\n  certificate {line}"));
    outcome.json["certificate"] = line.into();
}

/// The demands of the command line and of the files it names.
fn options(arguments: &CheckArguments) -> Result<CheckOptions, Failure> {
    let mut options = arguments.demands.options();
    if let Some(path) = &arguments.demands.gates {
        let file = GateFile::parse(&text_of(path)?).map_err(|e| wrong(path, &e))?;
        options.gates.extend(file.gates);
        options.allow.extend(file.allow);
    }
    if let Some(path) = &arguments.demands.baseline {
        options.baseline = Some(Baseline::parse(&text_of(path)?).map_err(|e| wrong(path, &e))?);
    }
    Ok(options)
}

fn wrong(path: &Path, error: &GateError) -> Failure {
    Failure::cannot_run(Diagnostic::new(error.to_string()).at(path.display()))
}

fn text_of(path: &Path) -> Result<String, Failure> {
    String::from_utf8(load(path)?.bytes).map_err(|_| {
        Failure::cannot_run(Diagnostic::new("this is no UTF-8 text").at(path.display()))
    })
}

fn load_certificate(path: &Path) -> Result<Certificate, Failure> {
    Certificate::parse(&text_of(path)?)
        .map_err(|e| Failure::cannot_run(Diagnostic::new(e.to_string()).at(path.display())))
}

/// What is checked, and the identity of the files if a certificate is about them.
struct Files {
    loaded: LoadedMesh,
    domain: Option<(Input, Domain)>,
    hash: Option<FileHash>,
}

impl Files {
    fn load(arguments: &CheckArguments) -> Result<Self, Failure> {
        let mut loaded = load_mesh(&arguments.mesh, &arguments.reading)?;
        let certifies = arguments.certificate.is_some() || arguments.verify_certificate.is_some();
        let hash = certifies.then(|| loaded.hash());
        loaded.forget_files();
        Ok(Self { loaded, domain: load_against(&arguments.against)?, hash })
    }

    fn domain(&self) -> Option<&Domain> {
        self.domain.as_ref().map(|(_, domain)| domain)
    }

    /// The certificate, if one is written or confirmed.
    fn certificate(&self, report: &Report, options: &CheckOptions) -> Option<Certificate> {
        let hash = |input: &Input| FileHash::of(&input.name, &[&input.bytes]);
        let domain = self.domain.as_ref().map(|(input, _)| hash(input));
        Some(Certificate::new(report, options, self.hash.clone()?, domain))
    }

    fn checked(&self, report: Report) -> Checked {
        let domain = self.domain.as_ref().map(|(input, _)| input.name.clone());
        Checked { report, mesh: self.loaded.name.clone(), domain }
    }
}

/// The files that a check writes beside its reports, staged before its work begins.
struct SideFiles {
    outputs: Outputs,
    pictures: Vec<OutputFile>,
    certificate: Option<usize>,
    baseline: Option<usize>,
}

impl SideFiles {
    fn prepare(arguments: &CheckArguments, cleanup: &Cleanup) -> Result<Self, Failure> {
        let pictures = output_files(&arguments.picture, None)?;
        if let Some(other) = pictures.iter().find(|file| !file.form.is_picture()) {
            let message = "a picture is .svg, .png or .html";
            return Err(Failure::cannot_run(Diagnostic::new(message).at(other.path.display())));
        }
        let mut paths: Vec<PathBuf> = pictures.iter().map(|file| file.path.clone()).collect();
        let mut place = |path: &Option<PathBuf>| {
            path.as_ref().map(|path| {
                paths.push(path.clone());
                paths.len() - 1
            })
        };
        let certificate = place(&arguments.certificate);
        let baseline = place(&arguments.save_baseline);
        let outputs = Outputs::prepare(&paths, cleanup)?;
        Ok(Self { outputs, pictures, certificate, baseline })
    }

    fn write(
        mut self,
        report: &Report,
        certificate: Option<&Certificate>,
        picture: &Drawing<'_>,
    ) -> Result<(), Failure> {
        for (i, file) in self.pictures.iter().enumerate() {
            write(&mut self.outputs, i, file, MeshView::from(picture.mesh), picture)?;
        }
        if let (Some(index), Some(certificate)) = (self.certificate, certificate) {
            write_json(&mut self.outputs, index, certificate)?;
        }
        if let Some(index) = self.baseline {
            let quality = report.quality.as_ref().ok_or_else(|| {
                Failure::cannot_run(Diagnostic::new("no quality was measured: no baseline"))
            })?;
            write_json(&mut self.outputs, index, &Baseline::of(quality))?;
        }
        self.outputs.commit()
    }
}

/// Fills an output with pretty JSON and a line end.
///
/// # Errors
/// Exit code 2 when the disk refuses.
pub fn write_json(
    outputs: &mut Outputs,
    index: usize,
    value: &impl Serialize,
) -> Result<(), Failure> {
    outputs.fill(index, |out| {
        serde_json::to_writer_pretty(&mut *out, value)?;
        out.write_all(b"\n")
    })
}
