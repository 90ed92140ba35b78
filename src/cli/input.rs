//! Reading inputs: one function for a path or `-`, with limits and clear errors.

use super::failure::{Diagnostic, Failure};
use super::words::nearest;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Largest regular file that is read, in bytes. A 100-million-triangle text mesh fits.
pub const FILE_BYTES_MAX: u64 = 16 << 30;

/// Largest input from a pipe or device, in bytes: those do not say how much will come.
pub const STREAM_BYTES_MAX: u64 = 4 << 30;

/// An input: its bytes, and what to call it in messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// The path as the user gave it, or `<stdin>`.
    pub name: String,
    /// The path, unless the input came from standard input.
    pub path: Option<PathBuf>,
    /// Everything it holds.
    pub bytes: Vec<u8>,
}

/// Whether the argument means standard input or output.
#[must_use]
pub fn is_dash(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Reads a file, or standard input for `-`.
///
/// # Errors
/// A missing file (with the nearest name in its directory), a directory, no permission, an empty
/// input, more than [`FILE_BYTES_MAX`] or [`STREAM_BYTES_MAX`] bytes: all exit code 2.
pub fn load(path: &Path) -> Result<Input, Failure> {
    let (name, bytes) = if is_dash(path) {
        let name = "<stdin>".to_owned();
        let bytes = read_stream(&mut io::stdin().lock(), &name)?;
        (name, bytes)
    } else {
        (path.display().to_string(), read_path(path)?)
    };
    if bytes.is_empty() {
        return Err(Failure::cannot_run(Diagnostic::new("the input is empty").at(&name)));
    }
    let path = (!is_dash(path)).then(|| path.to_owned());
    Ok(Input { name, path, bytes })
}

fn read_path(path: &Path) -> Result<Vec<u8>, Failure> {
    let cannot = |e: io::Error| Failure::io("read", path, &e);
    let mut file = File::open(path).map_err(|e| missing(path, &e))?;
    let about = file.metadata().map_err(cannot)?;
    if about.is_dir() {
        return Err(Failure::io("read", path, &io::Error::from(io::ErrorKind::IsADirectory)));
    }
    if !about.is_file() {
        return read_stream(&mut file, &path.display().to_string());
    }
    if about.len() > FILE_BYTES_MAX {
        return Err(too_large(&path.display().to_string(), FILE_BYTES_MAX));
    }
    // The capacity is what the file system says the file has; a file that grows meanwhile is cut.
    let mut bytes = Vec::with_capacity(about.len() as usize + 1);
    file.take(FILE_BYTES_MAX).read_to_end(&mut bytes).map_err(cannot)?;
    Ok(bytes)
}

fn read_stream(stream: &mut dyn Read, name: &str) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    stream
        .take(STREAM_BYTES_MAX + 1)
        .read_to_end(&mut bytes)
        .map_err(|e| Failure::io("read", Path::new(name), &e))?;
    if bytes.len() as u64 > STREAM_BYTES_MAX {
        return Err(too_large(name, STREAM_BYTES_MAX));
    }
    Ok(bytes)
}

fn too_large(name: &str, limit: u64) -> Failure {
    Failure::cannot_run(
        Diagnostic::new(format!("the input is larger than {} GiB", limit >> 30)).at(name),
    )
}

fn missing(path: &Path, error: &io::Error) -> Failure {
    let mut failure = Failure::io("read", path, error);
    if error.kind() == io::ErrorKind::NotFound
        && let Some(near) = nearest_file(path)
    {
        let help = format!("did you mean `{}`?", near.display());
        failure.diagnostics[0].helps.push(help);
    }
    failure
}

/// The file in the same directory whose name is nearest to the one that does not exist.
fn nearest_file(path: &Path) -> Option<PathBuf> {
    let wanted = path.file_name()?.to_str()?;
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // A directory with more entries than this is not worth the search.
    let names: Vec<String> = std::fs::read_dir(folder)
        .ok()?
        .take(1000)
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    let near = nearest(wanted, names.iter().map(String::as_str))?;
    Some(path.with_file_name(near))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(failure: &Failure) -> String {
        failure.diagnostics[0].to_string()
    }

    // spec: K5
    #[test]
    fn a_missing_file_names_the_nearest_one() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        std::fs::write(folder.path().join("wing.poly"), "x").expect("written");
        let failure = load(&folder.path().join("wimg.poly")).expect_err("there is no such file");
        assert_eq!(failure.exit, 2);
        assert!(message(&failure).contains("no such file"), "{}", message(&failure));
        assert!(message(&failure).contains("wing.poly"), "{}", message(&failure));
    }

    // spec: K5
    #[test]
    fn a_directory_is_not_read() {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let failure = load(folder.path()).expect_err("a directory has no bytes");
        assert!(message(&failure).contains("it is a directory"), "{}", message(&failure));
    }

    // spec: K5
    #[test]
    fn an_empty_file_is_not_an_input() {
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        let failure = load(file.path()).expect_err("nothing in it");
        assert_eq!((failure.exit, message(&failure).contains("empty")), (2, true));
    }

    #[test]
    fn a_file_is_read_whole() {
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        std::fs::write(file.path(), b"4 2 0 0\n").expect("written");
        assert_eq!(load(file.path()).expect("readable").bytes, b"4 2 0 0\n");
    }
}
