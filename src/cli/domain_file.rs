//! Domain files: reading with the `.node` file beside a `.poly`, and telling faults.

use super::arguments::{Against, DomainReading};
use super::failure::{Diagnostic, EXIT_CANNOT_RUN, Failure};
use super::input::{Input, is_dash, load};
use super::words::did_you_mean;
use crate::domain::validate::Fault;
use crate::domain::{Domain, Place};
use crate::format::airfoil::FarField;
use crate::format::domain_file::{DomainForm, DomainReadError, Problem, ReadOptions, read_domain};
use std::path::Path;

/// The names of the forms, for messages.
const FORMS: &str = "poly, json, geojson, dat";

/// Reads a domain.
///
/// # Errors
/// Exit code 2: the file cannot be read, its form is not told, or it is malformed.
pub fn load_domain(path: &Path, reading: &DomainReading) -> Result<(Input, Domain), Failure> {
    let input = load(path)?;
    let form = form_of(path, reading.from.as_deref())?;
    let far_field = reading.farfield.map(|far| FarField { chords: far.radius, points: far.points });
    let options = ReadOptions { node: None, far_field };
    let mut outcome = read_domain(&input.bytes, form, &options);
    if let Err(DomainReadError { problem: Problem::NodesElsewhere, .. }) = &outcome
        && let Some(node) = input.path.as_deref().and_then(node_beside)
    {
        let options = ReadOptions { node: Some(&node), ..options };
        outcome = read_domain(&input.bytes, form, &options);
    }
    let domain = outcome.map_err(|error| malformed(&input.name, &error))?;
    Ok((input, domain))
}

/// Reads the domain that a mesh is set against, if there is one.
///
/// # Errors
/// As [`load_domain`].
pub fn load_against(against: &Against) -> Result<Option<(Input, Domain)>, Failure> {
    let reading = against.reading();
    against.domain.as_ref().map(|path| load_domain(path, &reading)).transpose()
}

fn node_beside(poly: &Path) -> Option<Vec<u8>> {
    load(&poly.with_extension("node")).ok().map(|input| input.bytes)
}

/// The form that the user says, or that the extension names.
fn form_of(path: &Path, said: Option<&str>) -> Result<DomainForm, Failure> {
    if let Some(name) = said {
        return DomainForm::from_extension(name).ok_or_else(|| {
            let near = did_you_mean(name, FORMS.split(", "));
            let message = format!("there is no form of domain `{name}`{near}");
            Failure::cannot_run(Diagnostic::new(message).help(format!("there are {FORMS}")))
        });
    }
    DomainForm::from_path(path).ok_or_else(|| {
        let message = match is_dash(path) {
            true => "standard input has no extension that names the form of the domain",
            false => "the extension does not name the form of the domain",
        };
        let help = format!("say it with --from: {FORMS}");
        Failure::cannot_run(Diagnostic::new(message).at(path.display()).help(help))
    })
}

/// A reader's error as a complaint about the file `name`.
#[must_use]
pub fn malformed(name: &str, error: &DomainReadError) -> Failure {
    let diagnostic = Diagnostic::new(error.problem.to_string())
        .rule(error.problem.id())
        .at(place_in(name, &error.place));
    Failure { exit: EXIT_CANNOT_RUN, diagnostics: vec![diagnostic] }
}

/// A place as editors and people find it.
#[must_use]
pub fn place_in(name: &str, place: &Place) -> String {
    match place {
        Place::Line(line) => format!("{name}:{line}"),
        Place::NodeLine(line) => {
            format!("{}:{line}", Path::new(name).with_extension("node").display())
        }
        Place::Path(path) => format!("{name} at {path}"),
        Place::Made => name.to_owned(),
    }
}

/// The faults of an invalid domain, each with its places.
#[must_use]
pub fn invalid(name: &str, faults: &[Fault]) -> Failure {
    Failure::findings(faults.iter().map(|fault| complaint(name, fault)).collect())
}

fn complaint(name: &str, fault: &Fault) -> Diagnostic {
    let mut diagnostic = Diagnostic::new(fault.to_string()).rule(fault.id());
    for place in fault.places() {
        let text = place_in(name, place);
        if !diagnostic.places.contains(&text) {
            diagnostic = diagnostic.at(text);
        }
    }
    diagnostic
}

#[cfg(test)]
mod tests {
    use super::*;

    // spec: K4
    #[test]
    fn places_are_told_so_that_editors_find_them() {
        assert_eq!(place_in("a/b.poly", &Place::Line(7)), "a/b.poly:7");
        assert_eq!(place_in("a/b.poly", &Place::NodeLine(7)), "a/b.node:7");
        assert_eq!(place_in("b.json", &Place::Path("$.loops[2]".into())), "b.json at $.loops[2]");
        assert_eq!(place_in("b.dat", &Place::Made), "b.dat");
    }

    #[test]
    fn forms_by_word_and_by_name() {
        assert_eq!(form_of(Path::new("a.xyz"), Some("poly")), Ok(DomainForm::Poly));
        assert_eq!(form_of(Path::new("a.JSON"), None), Ok(DomainForm::Json));
        for (path, said) in [("a.xyz", None), ("-", None), ("a.poly", Some("polly"))] {
            let failure = form_of(Path::new(path), said).expect_err("no form");
            assert!(failure.diagnostics[0].helps[0].contains("geojson"), "{path}");
        }
    }
}
