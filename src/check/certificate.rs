//! Certificates: what was checked, on which bytes, and what came of it.
//!
//! A certificate is a claim that anybody can check again: it names the files by their SHA-256, lists
//! the ids that were checked and those that were not, and gives the verdict, the counts and the exact
//! area. It is no signature and proves nothing by itself; verifying one means reading the same
//! bytes and checking them anew.

use super::report::{IdCount, NotChecked, Report, Verdict};
use super::surface::SurfaceLimits;
use super::{CheckOptions, Id};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// The schema of a serialised [`Certificate`].
pub const CERTIFICATE_SCHEMA: &str = "trigrade-certificate/1";

/// A file by its contents.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FileHash {
    /// The name it had; only its contents are certified.
    pub name: String,
    /// How many bytes it has.
    pub bytes: u64,
    /// SHA-256 in hexadecimal digits.
    pub sha256: String,
}

impl FileHash {
    /// Of a file of this name and these contents; files that belong together are hashed one after
    /// the other.
    #[must_use]
    pub fn of(name: &str, parts: &[&[u8]]) -> Self {
        let mut hash = Sha256::new();
        for part in parts {
            hash.update(part);
        }
        let digits = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
        let bytes = parts.iter().map(|part| part.len() as u64).sum();
        Self { name: name.to_owned(), bytes, sha256: digits }
    }
}

/// The surface model that a mesh was checked against, and what was demanded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CertifiedModel {
    /// The model.
    pub file: FileHash,
    /// Limits of the distances and normals.
    pub limits: SurfaceLimits,
}

/// What a check said of certain bytes.
///
/// ```
/// use trigrade::check::certificate::{Certificate, FileHash};
/// use trigrade::check::{CheckOptions, check};
/// use trigrade::format::{MeshForm, read_mesh};
///
/// let file = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
/// let mesh = read_mesh(file, MeshForm::Off, &Default::default())?;
/// let options = CheckOptions::new();
/// let certify = |bytes: &[u8]| {
///     let report = check(&mesh, None, &options);
///     Certificate::new(&report, &options, FileHash::of("a.off", &[bytes]), None)
/// };
/// let text = serde_json::to_string(&certify(file))?;
/// // Whoever has the file confirms it, and notices any other one.
/// let certificate = Certificate::parse(&text)?;
/// assert!(certificate.confirmed_by(&certify(file)).is_ok());
/// assert!(certificate.confirmed_by(&certify(b"OFF\n")).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    /// [`CERTIFICATE_SCHEMA`].
    pub schema: String,
    /// Version of trigrade that checked.
    pub version: String,
    /// The mesh.
    pub mesh: FileHash,
    /// The domain, if the mesh was checked against one.
    pub domain: Option<FileHash>,
    /// The surface model, if the mesh was checked against one.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub surface: Option<CertifiedModel>,
    /// The answer.
    pub verdict: Verdict,
    /// Ids whose check ran to its end.
    pub checked: Vec<Id>,
    /// Ids whose check did not run, and why.
    pub not_checked: Vec<NotChecked>,
    /// Ids whose findings were allowed.
    pub allowed: Vec<Id>,
    /// Exact counts of findings.
    pub counts: Vec<IdCount>,
    /// Points of the mesh.
    pub points: u64,
    /// Triangles of the mesh.
    pub triangles: u64,
    /// Exact area of the mesh, `"N"` or `"N/2^k"`; only in the plane.
    pub area: Option<String>,
}

/// Why a certificate does not hold.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CertificateError {
    /// It is not a certificate.
    #[error("this is no certificate: {0}")]
    Malformed(String),
    /// It speaks of other files.
    #[error("the {what} is another file than the one certified: SHA-256 {found}, not {certified}")]
    OtherFile {
        /// Mesh, domain or model.
        what: &'static str,
        /// Of the file given.
        found: String,
        /// Of the file certified.
        certified: String,
    },
    /// With a domain or without.
    #[error("the certificate was made {0} a domain: check the mesh the same way")]
    Domain(&'static str),
    /// With a surface model or without.
    #[error("the certificate was made {0} a surface model: check the mesh the same way")]
    Model(&'static str),
    /// The files are the same and the check says something else.
    #[error("the check does not confirm the certificate's {0}")]
    Differs(&'static str),
}

impl Certificate {
    /// Certifies what `report` says.
    #[must_use]
    pub fn new(
        report: &Report,
        options: &CheckOptions,
        mesh: FileHash,
        domain: Option<FileHash>,
    ) -> Self {
        Self {
            schema: CERTIFICATE_SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            mesh,
            domain,
            surface: None,
            verdict: report.verdict,
            checked: report.checked.clone(),
            not_checked: report.not_checked.clone(),
            allowed: options.allow.iter().copied().collect(),
            counts: report.counts.clone(),
            points: report.statistics.points,
            triangles: report.statistics.triangles,
            area: report.statistics.area.as_ref().map(|area| area.exact.clone()),
        }
    }

    /// Names the surface model that the report is about too.
    #[must_use]
    pub fn on_model(mut self, file: FileHash, limits: SurfaceLimits) -> Self {
        self.surface = Some(CertifiedModel { file, limits });
        self
    }

    /// Reads the JSON that serialising a certificate gives.
    ///
    /// # Errors
    /// [`CertificateError::Malformed`].
    pub fn parse(text: &str) -> Result<Self, CertificateError> {
        let malformed = |why: String| CertificateError::Malformed(why);
        let certificate: Self =
            serde_json::from_str(text).map_err(|error| malformed(error.to_string()))?;
        if certificate.schema == CERTIFICATE_SCHEMA {
            Ok(certificate)
        } else {
            Err(malformed(format!("its schema is {:?}", certificate.schema)))
        }
    }

    /// The options under which it was made, as far as the certified facts depend on them.
    #[must_use]
    pub fn options(&self) -> CheckOptions {
        let mut options = CheckOptions::new()
            .delaunay(self.checked.contains(&Id::NotDelaunay))
            .constrained_delaunay(self.checked.contains(&Id::NotConstrainedDelaunay))
            .closed(self.checked.contains(&Id::NotClosed));
        options.allow = self.allowed.iter().copied().collect();
        options
    }

    /// Whether `fresh`, made of the files at hand by a new check, says the same of the same bytes.
    ///
    /// # Errors
    /// The first difference.
    pub fn confirmed_by(&self, fresh: &Self) -> Result<(), CertificateError> {
        same_file("mesh", &self.mesh, &fresh.mesh)?;
        match (&self.domain, &fresh.domain) {
            (Some(certified), Some(found)) => same_file("domain", certified, found)?,
            (None, None) => {}
            (Some(_), None) => return Err(CertificateError::Domain("with")),
            (None, Some(_)) => return Err(CertificateError::Domain("without")),
        }
        match (&self.surface, &fresh.surface) {
            (Some(certified), Some(found)) => same_file("model", &certified.file, &found.file)?,
            (None, None) => {}
            (Some(_), None) => return Err(CertificateError::Model("with")),
            (None, Some(_)) => return Err(CertificateError::Model("without")),
        }
        let same = |holds, what| if holds { Ok(()) } else { Err(CertificateError::Differs(what)) };
        same(self.verdict == fresh.verdict, "verdict")?;
        same(self.checked == fresh.checked, "list of checked ids")?;
        same(self.not_checked == fresh.not_checked, "list of ids not checked")?;
        same(self.counts == fresh.counts, "counts of findings")?;
        same(self.points == fresh.points, "number of points")?;
        same(self.triangles == fresh.triangles, "number of triangles")?;
        same(self.area == fresh.area, "area")
    }
}

fn same_file(
    what: &'static str,
    certified: &FileHash,
    found: &FileHash,
) -> Result<(), CertificateError> {
    if (certified.bytes, &certified.sha256) == (found.bytes, &found.sha256) {
        return Ok(());
    }
    let [found, certified] = [found, certified].map(|file| file.sha256.clone());
    Err(CertificateError::OtherFile { what, found, certified })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::check;
    use crate::mesh::MeshData;

    fn certificate() -> Certificate {
        let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
        let mesh = MeshData { points, triangles: vec![[0, 1, 2]], ..MeshData::default() };
        let options = CheckOptions::new();
        let report = check(&mesh, None, &options);
        Certificate::new(&report, &options, FileHash::of("a.off", &[b"abc"]), None)
    }

    // spec: C60
    #[test]
    fn a_certificate_survives_its_file_and_confirms_itself() {
        let made = certificate();
        let text = serde_json::to_string(&made).expect("serialisable");
        let read = Certificate::parse(&text).expect("readable");
        assert_eq!(read, made);
        assert_eq!(read.confirmed_by(&made), Ok(()));
        assert_eq!(made.area.as_deref(), Some("1/2^1"));
    }

    // spec: C60
    #[test]
    fn the_hash_is_sha_256() {
        let hash = FileHash::of("a", &[b"a", b"bc"]);
        let known = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!((hash.sha256.as_str(), hash.bytes), (known, 3));
    }

    // spec: C60
    #[test]
    fn every_difference_is_told() {
        let made = certificate();
        let differs = |change: fn(&mut Certificate)| {
            let mut other = made.clone();
            change(&mut other);
            made.confirmed_by(&other).expect_err("another certificate").to_string()
        };
        assert!(differs(|c| c.mesh = FileHash::of("a.off", &[b"abd"])).contains("another file"));
        assert!(differs(|c| c.domain = Some(c.mesh.clone())).contains("without a domain"));
        assert!(differs(|c| c.verdict = Verdict::Failed).contains("verdict"));
        assert!(differs(|c| c.checked.clear()).contains("checked ids"));
        assert!(differs(|c| c.triangles += 1).contains("number of triangles"));
        assert!(differs(|c| c.area = None).contains("area"));
    }

    #[test]
    fn other_text_is_no_certificate() {
        for text in ["", "{}", "[]", "{\"schema\": \"trigrade-certificate/2\"}"] {
            assert!(Certificate::parse(text).is_err(), "{text}");
        }
    }
}
