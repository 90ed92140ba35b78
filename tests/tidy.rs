//! Rules of the house that no compiler enforces: who may import whom, and what must not leak.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Files under `folder` with one of the extensions, in alphabetical order.
fn files(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    let wanted = |path: &Path| {
        path.extension().is_some_and(|e| extensions.iter().any(|wanted| e == *wanted))
    };
    paths
        .into_iter()
        .flat_map(|path| match path.is_dir() {
            true if path.ends_with("target") || path.ends_with(".git") => Vec::new(),
            true => files(&path, extensions),
            false if wanted(&path) => vec![path],
            false => Vec::new(),
        })
        .collect()
}

fn name(path: &Path) -> String {
    path.strip_prefix(root()).expect("below the root").display().to_string()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Code lines with their numbers: no comments, nothing from the unit tests at the foot.
fn code(text: &str) -> Vec<(usize, &str)> {
    text.lines()
        .enumerate()
        .take_while(|(_, line)| line.trim() != "#[cfg(test)]")
        .map(|(i, line)| (i + 1, line.split("//").next().unwrap_or("")))
        .collect()
}

/// Top-level modules of the crate that a line of code names: `crate::a`, `crate::{a, b::c}`.
fn crate_modules(line: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (at, pattern) in line.match_indices("crate::") {
        let rest = &line[at + pattern.len()..];
        let named: Vec<&str> = match rest.strip_prefix('{') {
            Some(list) => top_level(list),
            None => vec![rest],
        };
        for path in named {
            let module: String =
                path.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            found.extend((!module.is_empty()).then_some(module));
        }
    }
    found
}

/// The items of a braced list, split at commas that are in no inner brace.
fn top_level(list: &str) -> Vec<&str> {
    let (mut depth, mut start, mut items) = (0, 0, Vec::new());
    for (i, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => {
                items.push(list[start..i].trim_start());
                return items;
            }
            '}' => depth -= 1,
            ',' if depth == 0 => {
                items.push(list[start..i].trim_start());
                start = i + 1;
            }
            _ => {}
        }
    }
    items.push(list[start..].trim_start());
    items
}

/// Fails for each crate module that a file below src names and must not.
fn forbid_modules(is_file: impl Fn(&str) -> bool, is_allowed: impl Fn(&str) -> bool) {
    for path in files(&root().join("src"), &["rs"]) {
        let name = name(&path);
        if !is_file(&name) {
            continue;
        }
        // Imports may span lines: joined up to the semicolon.
        let text = read(&path);
        let joined: String =
            code(&text).iter().map(|(_, line)| line.trim()).collect::<Vec<_>>().join(" ");
        for module in joined.split(';').flat_map(crate_modules) {
            assert!(is_allowed(&module), "{name}: must not use crate::{module}");
        }
    }
}

fn is_of(name: &str, module: &str) -> bool {
    name == format!("src/{module}.rs") || name.starts_with(&format!("src/{module}/"))
}

/// Plain data and what both halves of the house may use.
const PLAIN: [&str; 8] =
    ["vector", "point", "curve", "surface", "metric", "model", "mesh", "domain"];

// spec: C1 K7
#[test]
fn check_imports_nothing_it_checks() {
    forbid_modules(
        |name| is_of(name, "check"),
        |module| ["check", "format"].contains(&module) || PLAIN.contains(&module),
    );
    for path in files(&root().join("src/check"), &["rs"]) {
        let text = read(&path);
        for (line, code) in code(&text) {
            // Even plain data must not bring the mesher's predicates in through the back door.
            let leak = ["validate::", "predicates", "triangulation", "robust::"];
            let bad = leak.iter().find(|word| code.contains(**word));
            assert!(bad.is_none(), "{}:{line}: check has its own arithmetic", name(&path));
        }
    }
}

#[test]
fn no_stage_reads_a_later_one() {
    // In the order data flows; `format` and `draw` are not stages.
    const STAGES: [&str; 15] = [
        "predicates",
        "triangulation",
        "delaunay",
        "background",
        "triangulate",
        "voronoi",
        "size",
        "skin",
        "structured",
        "front",
        "improve",
        "mesher",
        "surface_mesher",
        "remesh",
        "cli",
    ];
    for (i, stage) in STAGES.iter().enumerate() {
        forbid_modules(
            |name| is_of(name, stage),
            |module| !STAGES[i + 1..].contains(&module) && (module != "check" || *stage == "cli"),
        );
    }
    for plain in PLAIN {
        // The validator of domains stands on the predicates; nothing above it may.
        forbid_modules(
            |name| is_of(name, plain),
            |module| PLAIN.contains(&module) || (plain == "domain" && module == "predicates"),
        );
    }
}

#[test]
fn torture_knows_nothing_of_the_mesher() {
    const MESHER: [&str; 9] = [
        "background",
        "delaunay",
        "front",
        "improve",
        "mesher",
        "size",
        "triangulate",
        "triangulation",
        "voronoi",
    ];
    // The writer of hole points compares the two rules for what is inside, on the triangulation of
    // the boundary; no verdict on a mesh comes near it.
    const EXPORTER: &str = "src/torture/export/poly.rs";
    let judges = |name: &str| is_of(name, "torture") && name != EXPORTER;
    forbid_modules(judges, |module| !MESHER.contains(&module));
    let allowed = |module: &str| module == "background" || !MESHER.contains(&module);
    forbid_modules(|name| name == EXPORTER, allowed);
}

#[test]
fn the_triangulation_knows_no_coordinates() {
    for path in files(&root().join("src"), &["rs"]) {
        if name(&path) != "src/triangulation.rs" {
            continue;
        }
        for (line, code) in code(&read(&path)) {
            let bad = ["Point2", "f64", "f32"].iter().find(|word| code.contains(**word));
            assert!(bad.is_none(), "src/triangulation.rs:{line}: topology only");
        }
    }
}

// spec: K6
#[test]
fn the_library_has_no_clock_no_randomness_and_no_platform_trigonometry() {
    const BANNED: [(&str, &str); 9] = [
        ("Instant::now", "no clock below the command line"),
        ("SystemTime", "no clock below the command line"),
        ("thread_rng", "no randomness"),
        ("HashMap", "hashing order is not deterministic: BTreeMap, or say `lookups only`"),
        ("HashSet", "hashing order is not deterministic: BTreeSet, or say `lookups only`"),
        (".sin()", "libm::sin: the same on every platform"),
        (".cos()", "libm::cos: the same on every platform"),
        (".acos()", "libm::acos: the same on every platform"),
        ("static mut", "no global state"),
    ];
    for path in files(&root().join("src"), &["rs"]) {
        let name = name(&path);
        // Runs of foreign programs need a clock for their limits.
        if is_of(&name, "cli") || is_of(&name, "torture/run") {
            continue;
        }
        let text = read(&path);
        // A hash table that is never iterated is as deterministic as any other.
        let is_excused = |word: &str| word.starts_with("Hash") && text.contains("// lookups only");
        for (line, code) in code(&text) {
            for (word, why) in BANNED.iter().filter(|(word, _)| !is_excused(word)) {
                assert!(!code.contains(*word), "{name}:{line}: error: {word} is banned: {why}");
            }
        }
    }
}

#[test]
fn files_are_read_and_written_in_format_and_cli_only() {
    for path in files(&root().join("src"), &["rs"]) {
        let name = name(&path);
        // Foreign programs are fed and read through files.
        let modules = ["cli", "format", "torture/run"];
        if modules.iter().any(|module| is_of(&name, module)) || name == "src/main.rs" {
            continue;
        }
        let text = read(&path);
        for (line, code) in code(&text) {
            let bad = ["std::fs", "File::", "println!", "eprintln!", "std::env::"];
            let bad = bad.iter().find(|word| code.contains(**word));
            assert!(bad.is_none(), "{name}:{line}: input and output live in format and cli");
        }
    }
}

// spec: K40
#[test]
fn what_only_one_system_has_stands_behind_a_condition() {
    const PARTICULAR: [&str; 5] =
        ["std::os::unix", "std::os::windows", "std::os::linux", "rustix::", "/proc/"];
    // An item is as long as a screen at most: its condition is not far above.
    const NEAR: usize = 30;
    let folders = ["src", "tests"].map(|folder| files(&root().join(folder), &["rs"]));
    for path in folders.into_iter().flatten().filter(|path| !path.ends_with("tests/tidy.rs")) {
        let text = read(&path);
        let lines: Vec<&str> = text.lines().map(str::trim).collect();
        let is_conditional = |line: &&str| line.starts_with("#[cfg(") && !line.contains("(test)");
        for (i, line) in lines.iter().enumerate() {
            let Some(word) = PARTICULAR.iter().find(|word| line.contains(**word)) else { continue };
            let above = &lines[i.saturating_sub(NEAR)..i];
            assert!(
                lines[..20.min(i)].iter().any(|line| line.starts_with("#![cfg("))
                    || above.iter().any(is_conditional),
                "{}:{}: `{word}` without #[cfg(unix)] or the like",
                name(&path),
                i + 1
            );
        }
    }
    let text = read(&root().join("Cargo.toml"));
    let (_, unix) = text.split_once("[target.'cfg(unix)'.dependencies]").expect("a section");
    assert!(unix.trim_start().starts_with("rustix"), "what only Unix has is asked for only there");
}

#[test]
fn the_map_of_the_code_names_every_module_and_every_test() {
    let map = read(&root().join("ARCHITECTURE.md"));
    let lib = read(&root().join("src/lib.rs"));
    let modules: Vec<&str> =
        lib.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    assert!(modules.len() > 20, "{modules:?}");
    for module in modules {
        assert!(map.contains(&format!("`{module}`")), "ARCHITECTURE.md lacks the module {module}");
    }
    let entries = fs::read_dir(root().join("tests")).expect("the tests");
    for entry in entries.map(|entry| entry.expect("an entry").path()) {
        let is_test =
            entry.join("main.rs").exists() || entry.extension().is_some_and(|e| e == "rs");
        let name = name(&entry);
        let path = if entry.is_dir() { format!("{name}/main.rs") } else { name };
        assert!(!is_test || map.contains(&format!("`{path}`")), "ARCHITECTURE.md lacks {path}");
    }
    // And nothing that is gone.
    for word in map.split('`').skip(1).step_by(2).filter(|word| word.starts_with("tests/")) {
        assert!(root().join(word).exists(), "ARCHITECTURE.md names {word}");
    }
}

#[test]
fn there_is_no_unsafe_code() {
    let lib = read(&root().join("src/lib.rs"));
    assert!(lib.contains("#![forbid(unsafe_code)]"), "the library forbids it");
    for path in files(&root().join("src"), &["rs"]) {
        let text = read(&path);
        for (line, code) in code(&text) {
            let words: BTreeSet<&str> = code.split_whitespace().collect();
            assert!(!words.contains("unsafe"), "{}:{line}", name(&path));
        }
    }
}

#[test]
fn nothing_of_a_developers_machine_leaks() {
    let extensions = ["rs", "md", "toml", "json", "poly", "dat", "off", "svg", "txt", "run"];
    // In pieces, so that this file passes its own test.
    let banned = [concat!("/ho", "me/"), concat!("/ro", "ot/"), concat!("/Us", "ers/")];
    let banned_words = [concat!("/wo", "rk/"), concat!("C:\\", "Users")];
    for path in files(&root(), &extensions) {
        let Ok(text) = fs::read_to_string(&path) else { continue };
        for word in banned.iter().chain(&banned_words) {
            assert!(!text.contains(word), "{}: names {word}", name(&path));
        }
    }
}

#[test]
fn the_parser_of_imports_sees_what_it_should() {
    assert_eq!(crate_modules("use crate::point::Point2"), ["point"]);
    assert_eq!(
        crate_modules("use crate::{mesh::{A, B}, front, size::x}"),
        ["mesh", "front", "size"]
    );
    assert_eq!(crate_modules("let x = crate::mesher::mesh(a, crate::size::h)"), ["mesher", "size"]);
    assert_eq!(crate_modules("use std::crate_like"), [""; 0]);
    assert_eq!(code("a // b\n#[cfg(test)]\nc"), [(1, "a ")]);
}
