//! Reproducers in a folder: a folder each, with the boundary, the answer and what is wrong with it.

use super::Plan;
use crate::domain::Domain;
use crate::format::domain_json;
use crate::torture::export::{BoundaryForm, export};
use crate::torture::generate::{Case, Claim, families};
use crate::torture::judge::Judgement;
use crate::torture::shrink::keeps_claim;
use serde::Deserialize;
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};

/// A failure, shrunk.
#[derive(Clone, Debug)]
pub struct Reproducer {
    /// The number of its case.
    pub index: u64,
    /// The family of its case.
    pub family: String,
    /// What must become of it.
    pub claim: Claim,
    /// The boundary as it was generated.
    pub original: Domain,
    /// The boundary as it was shrunk.
    pub domain: Domain,
    /// The verdict on the answer to the shrunk boundary.
    pub judgement: Judgement,
    /// How often the mesher was asked.
    pub trials: u32,
    /// Whether the failure came back when it was run again.
    pub is_repeatable: bool,
    /// Where it was written, below the run's folder.
    pub folder: Option<PathBuf>,
}

/// Reproducers to be run again.
#[derive(Clone, Debug, Default)]
pub struct Corpus {
    /// The boundaries, numbered by place.
    pub cases: Vec<Case>,
    /// The folder of each.
    pub folders: Vec<PathBuf>,
}

/// Why a corpus cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum CorpusError {
    /// A file.
    #[error("{}: {source}", path.display())]
    Io {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A file that does not say what it should.
    #[error("{}: {why}", path.display())]
    Malformed {
        /// Which.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// There is nothing to replay.
    #[error("{}: no folder in it has a case.json", .0.display())]
    Empty(PathBuf),
}

/// The part of `case.json` that a replay needs.
#[derive(Deserialize)]
struct CaseFile {
    family: String,
    claim: String,
    boundary: String,
}

/// Writes a reproducer below `out`.
///
/// # Errors
/// [`CorpusError::Io`].
pub fn write(
    out: &Path,
    mut reproducer: Reproducer,
    plan: &Plan,
) -> Result<Reproducer, CorpusError> {
    let class = reproducer.judgement.class.name();
    let name = PathBuf::from("failures").join(format!("{:06}-{class}", reproducer.index));
    let folder = out.join(&name);
    let told = |path: &Path| {
        let path = path.to_owned();
        move |source| CorpusError::Io { path, source }
    };
    fs::create_dir_all(&folder).map_err(told(&folder))?;
    let save = |file: &str, bytes: &[u8]| {
        let path = folder.join(file);
        fs::write(&path, bytes).map_err(told(&path))
    };
    for (file, domain) in
        [("original.json", &reproducer.original), ("shrunk.json", &reproducer.domain)]
    {
        let bytes = export(domain, BoundaryForm::Json).unwrap_or_default();
        save(file, &bytes)?;
    }
    // The mesher runs once more, in the folder, so that its input and its answer stay there.
    let _ = plan.tool.ask(&reproducer.domain, reproducer.claim, &plan.limits, &folder);
    let about = json!({
        "schema": "trigrade-torture-case/1",
        "family": reproducer.family,
        "seed": plan.selection.seed,
        "index": reproducer.index,
        "claim": claim_word(reproducer.claim),
        "boundary": "shrunk.json",
        "verdict": reproducer.judgement,
        "repeatable": reproducer.is_repeatable,
        "trials": reproducer.trials,
        "mesher": plan.tool.name,
        "command": plan.tool.command,
    });
    save("case.json", format!("{about:#}\n").as_bytes())?;
    reproducer.folder = Some(name);
    Ok(reproducer)
}

/// A claim as `case.json` has it: `valid`, or the rule that is broken.
pub fn claim_word(claim: Claim) -> &'static str {
    match claim {
        Claim::Valid => "valid",
        Claim::Invalid(fault) => fault,
    }
}

/// Reads all folders with a `case.json` in `folder` or in its `failures`, by name.
///
/// # Errors
/// [`CorpusError`]; also when a boundary is not what its file claims, by exact validation.
pub fn read_corpus(folder: &Path) -> Result<Corpus, CorpusError> {
    let mut found = Vec::new();
    for root in [folder.to_owned(), folder.join("failures")] {
        let Ok(entries) = fs::read_dir(&root) else { continue };
        let paths = entries.flatten().map(|entry| entry.path());
        found.extend(paths.filter(|path| path.join("case.json").is_file()));
    }
    found.sort();
    if found.is_empty() {
        return Err(CorpusError::Empty(folder.to_owned()));
    }
    let cases: Result<Vec<Case>, CorpusError> =
        (0..).zip(&found).map(|(index, folder)| read_case(folder, index)).collect();
    Ok(Corpus { cases: cases?, folders: found })
}

fn read_case(folder: &Path, index: u64) -> Result<Case, CorpusError> {
    let read = |path: &Path| {
        fs::read(path).map_err(|source| CorpusError::Io { path: path.to_owned(), source })
    };
    let about = folder.join("case.json");
    let malformed = |why: String| CorpusError::Malformed { path: about.clone(), why };
    let file: CaseFile =
        serde_json::from_slice(&read(&about)?).map_err(|error| malformed(error.to_string()))?;
    if file.boundary.contains(['/', '\\']) {
        return Err(malformed("the boundary must lie in the same folder".into()));
    }
    let boundary = folder.join(&file.boundary);
    let domain = domain_json::read(&read(&boundary)?).map_err(|error| CorpusError::Malformed {
        path: boundary.clone(),
        why: error.to_string(),
    })?;
    let of_family = families().find(|family| family.name == file.family);
    let claims = families().map(|family| family.claim);
    let claim = claims.into_iter().find(|&claim| claim_word(claim) == file.claim);
    let claim = claim.ok_or_else(|| malformed(format!("`{}` is no claim", file.claim)))?;
    if !keeps_claim(&domain, claim) {
        let why = format!("the boundary is not {claim}, as case.json says");
        return Err(CorpusError::Malformed { path: boundary, why });
    }
    let family = of_family.map_or("other", |family| family.name);
    Ok(Case { index, family, dress: "plain", claim, domain })
}
