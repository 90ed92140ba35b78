//! Files of points: their form, reading, and telling what is wrong with them.

use super::arguments::PointInput;
use super::domain_file;
use super::failure::{Diagnostic, Failure};
use super::input::{Input, is_dash, load};
use super::mesh_file;
use crate::domain::Domain;
use crate::format::domain_file::Problem;
use crate::format::points::{PointFile, PointForm, PointReadError, PointSet, read_points};
use crate::point::Point2;
use std::path::Path;

/// Points, or a domain, and the file they come from.
#[derive(Clone, Debug)]
pub struct Points {
    /// The file.
    pub input: Input,
    /// What it holds.
    pub file: PointFile,
}

impl Points {
    /// Reads a file of points.
    ///
    /// # Errors
    /// Exit code 2: the file cannot be read, its form is not told, or it is malformed.
    pub fn load(wanted: &PointInput) -> Result<Self, Failure> {
        let form = form_of(&wanted.points, wanted.from.as_deref())?;
        let input = load(&wanted.points)?;
        let mut outcome = read_points(&input.bytes, form, None);
        if let Err(PointReadError::Domain(error)) = &outcome
            && error.problem == Problem::NodesElsewhere
            && let Some(poly) = &input.path
            && let Ok(node) = load(&poly.with_extension("node"))
        {
            outcome = read_points(&input.bytes, form, Some(&node.bytes));
        }
        let file = outcome.map_err(|error| malformed(&input.name, &error))?;
        Ok(Self { input, file })
    }

    /// All points of the file.
    #[must_use]
    pub fn points(&self) -> &[Point2] {
        match &self.file {
            PointFile::Points(set) => &set.points,
            PointFile::Domain(domain) => &domain.points,
        }
    }

    /// The domain, if it has loops or segments.
    #[must_use]
    pub fn domain(&self) -> Option<&Domain> {
        match &self.file {
            PointFile::Domain(domain) if domain.edges().next().is_some() => Some(domain),
            _ => None,
        }
    }

    /// What of the file is not among the points.
    #[must_use]
    pub fn left_out(&self) -> &[String] {
        match &self.file {
            PointFile::Points(set) => &set.left_out,
            PointFile::Domain(_) => &[],
        }
    }

    /// A point for people: its index, and its line if the file has lines.
    #[must_use]
    pub fn told(&self, index: u32) -> String {
        let line = match &self.file {
            PointFile::Points(PointSet { lines, .. }) => lines.line(index),
            PointFile::Domain(_) => None,
        };
        match line {
            Some(line) => format!("{index} (line {line})"),
            None => index.to_string(),
        }
    }
}

/// Some pairs of equal points, in words; `None` if there are none.
#[must_use]
pub fn repetitions(points: &Points, repeated: &[[u32; 2]]) -> Option<String> {
    const LISTED: usize = 3;
    let pair = |&[dropped, kept]: &[u32; 2]| {
        format!("{} repeats {}", points.told(dropped), points.told(kept))
    };
    let listed: Vec<String> = repeated.iter().take(LISTED).map(pair).collect();
    let more = if repeated.len() > LISTED { ", ..." } else { "" };
    let count = super::words::count(repeated.len() as u64);
    match repeated.len() {
        0 => None,
        1 => Some(format!("1 point, merged: {}", listed[0])),
        _ => Some(format!("{count} points, merged: {}{more}", listed.join(", "))),
    }
}

/// The form that the user says, or that the extension names.
fn form_of(path: &Path, said: Option<&str>) -> Result<PointForm, Failure> {
    let help = format!("there are {}", PointForm::EXTENSIONS);
    if let Some(name) = said {
        return PointForm::from_extension(name).ok_or_else(|| {
            let message = format!("there is no form of points `{name}`");
            Failure::cannot_run(Diagnostic::new(message).help(help))
        });
    }
    let by_extension = || PointForm::from_extension(path.extension()?.to_str()?);
    by_extension().ok_or_else(|| {
        let message = match is_dash(path) {
            true => "standard input has no extension that names the form of the points",
            false => "the extension does not name the form of the points",
        };
        let help = format!("say it with --from: {}", PointForm::EXTENSIONS);
        Failure::cannot_run(Diagnostic::new(message).at(path.display()).help(help))
    })
}

fn malformed(name: &str, error: &PointReadError) -> Failure {
    match error {
        PointReadError::Table(error) => mesh_file::malformed(name, error),
        PointReadError::Domain(error) => domain_file::malformed(name, error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(text: &str) -> Points {
        let bytes = text.as_bytes().to_vec();
        let file = read_points(&bytes, PointForm::Xyz, None).expect("sound");
        Points { input: Input { name: "a.xyz".into(), path: None, bytes }, file }
    }

    #[test]
    fn repetitions_are_told_with_their_lines() {
        let points = points("# c\n0 0\n1 1\n0 0\n0 0\n1 1\n1 1\n");
        let pairs = [[2, 0], [3, 0], [4, 1], [5, 1]];
        assert_eq!(repetitions(&points, &[]), None);
        let one = "1 point, merged: 2 (line 4) repeats 0 (line 2)";
        assert_eq!(repetitions(&points, &pairs[..1]).as_deref(), Some(one));
        let told = repetitions(&points, &pairs).expect("four");
        assert!(told.starts_with("4 points, merged: 2 (line 4) repeats 0"), "{told}");
        assert!(told.ends_with(", 4 (line 6) repeats 1 (line 3), ..."), "{told}");
    }

    #[test]
    fn forms_by_word_and_by_name() {
        assert_eq!(form_of(Path::new("a.poly"), Some("xyz")), Ok(PointForm::Xyz));
        assert_eq!(form_of(Path::new("a.NPY"), None), Ok(PointForm::Npy));
        for (path, said) in [("a.off", None), ("-", None), ("a.csv", Some("cvs"))] {
            let failure = form_of(Path::new(path), said).expect_err("no form");
            assert!(failure.diagnostics[0].helps[0].contains("npy"), "{path}");
        }
    }
}
