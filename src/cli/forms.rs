//! Which form a file has: by its name, or as the user says; and which files an output consists of.

use super::failure::{Diagnostic, Failure};
use super::input::is_dash;
use super::words::did_you_mean;
use crate::format::{Companion, Encoding, MeshForm, MshVersion, WriteOptions};
use std::path::{Path, PathBuf};

/// A form that `mesh`, `convert` or `plot` can write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputForm {
    /// A mesh file.
    Mesh(MeshForm, WriteOptions),
    /// A vector picture.
    Svg,
    /// A pixel picture.
    Png,
    /// The viewer: one HTML file that needs no network.
    Html,
    /// A triangulation as JSON; only of verbs that make one of points.
    Json,
}

/// Extensions that name a form of mesh, in the order that messages list them.
const MESH_EXTENSIONS: [&str; 14] = [
    "msh", "off", "vtu", "ele", "vtk", "mesh", "su2", "obj", "ply", "stl", "vol", "14", "2dm",
    "inp",
];

impl OutputForm {
    /// The form called `name`: an extension, or `msh22`, `msh41`; with `-binary` or `-compressed`
    /// after it for those encodings, where the form has them.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        let (name, encoding) = match name.rsplit_once('-') {
            Some((name, "binary")) => (name, Encoding::Binary),
            Some((name, "compressed")) => (name, Encoding::Compressed),
            _ => (name.as_str(), Encoding::Ascii),
        };
        let msh_version = match name {
            "svg" | "png" | "html" if encoding != Encoding::Ascii => return None,
            "svg" => return Some(Self::Svg),
            "png" => return Some(Self::Png),
            "html" => return Some(Self::Html),
            "msh22" => MshVersion::V22,
            _ => MshVersion::V41,
        };
        let is_wanted = |form: &MeshForm| form.is_written() && form.has_encoding(encoding);
        let form = mesh_form_named(name).filter(is_wanted)?;
        Some(Self::Mesh(form, WriteOptions { encoding, msh_version }))
    }

    /// Whether it is a picture.
    #[must_use]
    pub fn is_picture(self) -> bool {
        matches!(self, Self::Svg | Self::Png | Self::Html)
    }
}

/// The form of mesh called `name`: an extension; Triangle's two files go by either of theirs.
fn mesh_form_named(name: &str) -> Option<MeshForm> {
    match name {
        "node" => Some(MeshForm::NodeEle),
        "msh22" | "msh41" => Some(MeshForm::Msh),
        other => MeshForm::from_extension(other),
    }
}

/// The names of all mesh forms that `is_wanted`, for messages.
fn mesh_names(is_wanted: impl Fn(MeshForm) -> bool) -> String {
    let known = |name: &&&str| MeshForm::from_extension(name).is_some_and(&is_wanted);
    MESH_EXTENSIONS.iter().filter(known).copied().collect::<Vec<_>>().join(", ")
}

/// The form of a mesh to be read: what the user says, else the extension, else the first bytes.
///
/// # Errors
/// Exit code 2 when none of the three tells.
pub fn mesh_to_read(path: &Path, said: Option<&str>, bytes: &[u8]) -> Result<MeshForm, Failure> {
    if let Some(name) = said {
        let form = mesh_form_named(&name.to_ascii_lowercase());
        return form.ok_or_else(|| unknown(name, &mesh_names(is_read)));
    }
    let by_extension = || mesh_form_named(&path.extension()?.to_str()?.to_ascii_lowercase());
    by_extension().or_else(|| MeshForm::sniff(bytes)).ok_or_else(|| {
        Failure::cannot_run(
            Diagnostic::new("the name does not tell the form of the mesh")
                .at(path.display())
                .help(format!("say it with --from: {}", mesh_names(is_read))),
        )
    })
}

/// Whether the form can be read back.
#[must_use]
pub fn is_read(form: MeshForm) -> bool {
    crate::format::READERS.iter().any(|(known, _)| *known == form)
}

fn unknown(name: &str, known: &str) -> Failure {
    Failure::cannot_run(
        Diagnostic::new(format!("there is no form `{name}`{}", did_you_mean(name, words(known))))
            .help(format!("there are {known}")),
    )
}

/// The names in a list for messages.
fn words(list: &str) -> impl Iterator<Item = &str> {
    list.split([',', ';', ' ']).filter(|word| !word.is_empty())
}

/// One file of an output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFile {
    /// Where it goes.
    pub path: PathBuf,
    /// The form of the output it belongs to.
    pub form: OutputForm,
    /// Which of the form's files it is; `None` for the main one.
    pub companion: Option<Companion>,
}

/// The files that the outputs consist of, in the order given.
///
/// # Errors
/// Exit code 2: the form is not told, unknown, or needs several files on standard output.
pub fn output_files(paths: &[PathBuf], said: Option<&str>) -> Result<Vec<OutputFile>, Failure> {
    let mut files = Vec::new();
    for path in paths {
        let form = output_form(path, said)?;
        let companions = match form {
            OutputForm::Mesh(form, _) => form.companions(),
            OutputForm::Svg | OutputForm::Png | OutputForm::Html | OutputForm::Json => &[],
        };
        if is_dash(path) && !companions.is_empty() {
            let diagnostic = Diagnostic::new("standard output takes one file, this form has more");
            return Err(Failure::cannot_run(diagnostic.help("write it to a file: -o NAME.ele")));
        }
        let main = main_path(path, form);
        for &companion in companions {
            let path = main.with_extension(companion.extension());
            files.push(OutputFile { path, form, companion: Some(companion) });
        }
        files.push(OutputFile { path: main, form, companion: None });
    }
    Ok(files)
}

/// [`output_files`], where `.json` names a form too.
///
/// # Errors
/// As there.
pub fn output_files_or_json(
    paths: &[PathBuf],
    said: Option<&str>,
) -> Result<Vec<OutputFile>, Failure> {
    let is_json = |name: &str| name.eq_ignore_ascii_case("json");
    let mut files = Vec::new();
    for path in paths {
        let extension = path.extension().and_then(|e| e.to_str());
        match said.or(extension).is_some_and(is_json) {
            true => {
                files.push(OutputFile {
                    path: path.clone(),
                    form: OutputForm::Json,
                    companion: None,
                });
            }
            false => files.extend(output_files(std::slice::from_ref(path), said)?),
        }
    }
    Ok(files)
}

/// `a.node` names the same pair of files as `a.ele`.
fn main_path(path: &Path, form: OutputForm) -> PathBuf {
    match form {
        OutputForm::Mesh(MeshForm::NodeEle, _) => path.with_extension("ele"),
        _ => path.to_owned(),
    }
}

fn output_form(path: &Path, said: Option<&str>) -> Result<OutputForm, Failure> {
    let known = || {
        format!(
            "{}, msh22, svg, png, html; msh-binary, vtu-compressed and the like",
            mesh_names(MeshForm::is_written)
        )
    };
    if let Some(name) = said {
        return OutputForm::named(name).ok_or_else(|| unknown(name, &known()));
    }
    if is_dash(path) {
        let diagnostic = Diagnostic::new("standard output has no extension that names a form");
        return Err(Failure::cannot_run(diagnostic.help(format!("add --form: {}", known()))));
    }
    let by_extension = || OutputForm::named(path.extension()?.to_str()?);
    by_extension().ok_or_else(|| {
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        let near = did_you_mean(&extension, words(&known()));
        let mut diagnostic =
            Diagnostic::new(format!("the extension names no form that is written{near}"))
                .at(path.display())
                .help(format!("there are {}; or add --form", known()));
        if path.extension().is_some_and(|extension| extension == "json") {
            diagnostic = diagnostic.help("a report is written with --report json=FILE");
        }
        Failure::cannot_run(diagnostic)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(paths: &[&str], said: Option<&str>) -> Result<Vec<OutputFile>, Failure> {
        output_files(&paths.iter().map(PathBuf::from).collect::<Vec<_>>(), said)
    }

    #[test]
    fn extensions_name_forms_in_any_case() {
        let files = files(&["a.MSH", "b.svg", "c.png"], None).expect("all known");
        assert!(matches!(files[0].form, OutputForm::Mesh(MeshForm::Msh, _)));
        assert_eq!((files[1].form, files[2].form), (OutputForm::Svg, OutputForm::Png));
    }

    #[test]
    fn triangles_form_is_three_files() {
        for name in ["a.ele", "a.node"] {
            let files = files(&[name], None).expect("known");
            let paths: Vec<_> = files.iter().map(|file| file.path.clone()).collect();
            assert_eq!(paths, ["a.node", "a.edge", "a.ele"].map(PathBuf::from));
        }
    }

    #[test]
    fn a_version_of_msh_can_be_asked_for() {
        let file = &files(&["a.msh"], Some("msh22")).expect("known")[0];
        let OutputForm::Mesh(MeshForm::Msh, options) = file.form else { panic!("{file:?}") };
        assert_eq!(options.msh_version, MshVersion::V22);
    }

    #[test]
    fn an_encoding_can_be_asked_for() {
        for (name, encoding) in [
            ("msh-binary", Encoding::Binary),
            ("MSH22-Binary", Encoding::Binary),
            ("stl-binary", Encoding::Binary),
            ("vtu-compressed", Encoding::Compressed),
            ("off", Encoding::Ascii),
        ] {
            let Some(OutputForm::Mesh(_, options)) = OutputForm::named(name) else {
                panic!("{name}")
            };
            assert_eq!(options.encoding, encoding, "{name}");
        }
        for wrong in ["off-binary", "svg-binary", "ply-compressed", "-binary", "msh-ascii"] {
            assert_eq!(OutputForm::named(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn what_no_form_is_told_for_is_refused() {
        for (paths, said) in [
            (&["-"][..], None),
            (&["a"], None),
            (&["a.xyz"], None),
            (&["a.json"], None),
            (&["a.msh"], Some("xyz")),
            (&["-"], Some("ele")),
        ] {
            let failure = files(paths, said).expect_err("no form");
            assert_eq!(failure.exit, 2, "{paths:?}");
            assert!(!failure.diagnostics[0].helps.is_empty(), "{paths:?}");
        }
    }

    #[test]
    fn a_mesh_is_known_by_word_by_name_or_by_sight() {
        let form = |path, said, bytes| mesh_to_read(Path::new(path), said, bytes);
        assert_eq!(form("a.msh", Some("off"), b""), Ok(MeshForm::Off));
        assert_eq!(form("a.msh", None, b"OFF\n"), Ok(MeshForm::Msh));
        assert_eq!(form("-", None, b"OFF\n"), Ok(MeshForm::Off));
        assert!(form("-", None, b"?").is_err());
        assert!(form("a.off", Some("of"), b"OFF\n").is_err());
    }
}
