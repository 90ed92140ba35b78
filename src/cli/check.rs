//! `trigrade check`: the verdict on anybody's mesh.

use super::arguments::{CheckArguments, DomainReading};
use super::domain_file::load_domain;
use super::failure::Failure;
use super::mesh_file::load_mesh;
use super::outcome::Outcome;
use super::verdict;
use crate::check::check;

/// Runs the verb.
///
/// # Errors
/// Exit code 2: a file cannot be read or is malformed. An invalid domain is for `check` itself to
/// judge: it needs no sound domain to see that a mesh does not match it.
pub fn run(arguments: &CheckArguments) -> Result<Outcome, Failure> {
    let (input, mesh) = load_mesh(&arguments.mesh, arguments.from.as_deref())?;
    let reading =
        DomainReading { from: arguments.domain_from.clone(), farfield: arguments.farfield };
    let domain = match &arguments.domain {
        Some(path) => Some(load_domain(path, &reading)?.1),
        None => None,
    };
    let report = check(&mesh, domain.as_ref(), &arguments.demands.options());
    Ok(Outcome {
        exit: report.exit_code(),
        text: verdict::text(&report, &input.name),
        json: verdict::json(&report),
    })
}
