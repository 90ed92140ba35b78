//! SPEC.md and the tests move together: every invariant has a test, every mark names an invariant.
//!
//! An invariant is `**ID** [slug] sentence`, a mark is a comment `// spec: ID ID ...` directly
//! above a test. `!ID` marks a test of what must be refused; alone it holds up nothing.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Rust sources under `folder` in alphabetical order; none when it does not exist.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    paths
        .into_iter()
        .flat_map(|path| match path.is_dir() {
            true if path.ends_with("target") => Vec::new(),
            true => sources(&path),
            false if path.extension().is_some_and(|e| e == "rs") => vec![path],
            false => Vec::new(),
        })
        .collect()
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Invariant {
    id: String,
    slug: String,
    wording: String,
}

fn is_id(text: &str) -> bool {
    let mut letters = text.chars();
    letters.next().is_some_and(|c| c.is_ascii_uppercase())
        && text.len() > 1
        && letters.all(|c| c.is_ascii_digit())
}

/// The invariants of a specification, with their words joined to one line.
fn invariants(spec: &str) -> Vec<Invariant> {
    let lines: Vec<&str> = spec.lines().collect();
    let head = |line: &str| -> Option<(String, String)> {
        let (id, rest) = line.strip_prefix("**")?.split_once("**")?;
        let (slug, _) = rest.trim_start().strip_prefix('[')?.split_once(']')?;
        is_id(id).then(|| (id.to_owned(), slug.to_owned()))
    };
    (0..lines.len())
        .filter_map(|i| {
            let (id, slug) = head(lines[i])?;
            let more = lines[i + 1..]
                .iter()
                .take_while(|line| !line.trim().is_empty() && head(line).is_none());
            let words = std::iter::once(&lines[i]).chain(more).map(|line| line.trim());
            Some(Invariant { id, slug, wording: words.collect::<Vec<_>>().join(" ") })
        })
        .collect()
}

/// A mark and what stands under it.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Mark {
    id: String,
    place: String,
    /// Whether it stands above a test, and not for a refusal only.
    is_support: bool,
}

fn marks(name: &str, text: &str) -> Vec<Mark> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let mut found = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let Some(ids) = line.strip_prefix(concat!("// sp", "ec:")) else { continue };
        let is_on_a_test = lines[i + 1..]
            .iter()
            .take_while(|next| next.starts_with("//") || next.starts_with("#["))
            .any(|next| next.starts_with("#[test]"))
            || lines.get(i + 1).is_some_and(|next| next.starts_with("fn "));
        found.extend(ids.split([' ', ',']).filter(|id| !id.is_empty()).map(|id| Mark {
            id: id.trim_start_matches('!').to_owned(),
            place: format!("{name}:{}", i + 1),
            is_support: is_on_a_test && !id.starts_with('!'),
        }));
    }
    found
}

fn all_marks() -> Vec<Mark> {
    ["src", "tests", "fuzz", "benches"]
        .iter()
        .flat_map(|folder| sources(&root().join(folder)))
        .flat_map(|path| {
            let name = path.strip_prefix(root()).expect("below the root").display().to_string();
            marks(&name, &fs::read_to_string(&path).expect("readable"))
        })
        .collect()
}

fn spec() -> Vec<Invariant> {
    invariants(&fs::read_to_string(root().join("SPEC.md")).expect("SPEC.md is at the root"))
}

#[test]
fn no_id_and_no_slug_is_defined_twice() {
    let mut seen = BTreeSet::new();
    for invariant in spec() {
        assert!(seen.insert(invariant.id.clone()), "{} is defined twice", invariant.id);
        assert!(seen.insert(invariant.slug.clone()), "[{}] is defined twice", invariant.slug);
    }
    assert!(!seen.is_empty(), "SPEC.md has invariants");
}

#[test]
fn every_invariant_says_how_strong_it_is() {
    let strengths = ["by type", "exact", "exhaustive", "sampled", "measured", "assumed", "proved"];
    for Invariant { id, wording, .. } in spec() {
        let (_, strength) = wording
            .split_once("*strength:*")
            .unwrap_or_else(|| panic!("{id} has no line `*strength:* ...`"));
        assert!(
            strengths.iter().any(|word| strength.contains(word)),
            "{id}: `{}` names none of {strengths:?}",
            strength.trim()
        );
    }
}

#[test]
fn every_invariant_has_a_test() {
    let tested: BTreeSet<String> =
        all_marks().into_iter().filter(|mark| mark.is_support).map(|mark| mark.id).collect();
    let untested: Vec<String> = spec()
        .into_iter()
        .filter(|rule| !tested.contains(&rule.id) && !rule.wording.contains("*strength:* assumed"))
        .map(|rule| format!("{} [{}]", rule.id, rule.slug))
        .collect();
    assert!(untested.is_empty(), "invariants without a test: {untested:#?}");
}

#[test]
fn every_mark_names_an_invariant() {
    let known: BTreeSet<String> = spec().into_iter().map(|rule| rule.id).collect();
    let unknown: Vec<String> = all_marks()
        .into_iter()
        .filter(|mark| !known.contains(&mark.id))
        .map(|mark| format!("{}: {}", mark.place, mark.id))
        .collect();
    assert!(unknown.is_empty(), "marks that name no invariant of SPEC.md: {unknown:#?}");
}

/// Ids that the program itself prints, as string literals: `"M3"`.
fn literal_ids(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (i, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("//") {
            continue;
        }
        let pieces: Vec<&str> = line.split('"').collect();
        let quoted = pieces.iter().skip(1).step_by(2);
        found.extend(quoted.filter(|piece| is_id(piece)).map(|id| (i + 1, (*id).to_owned())));
    }
    found
}

/// The part of a source file above its unit tests.
fn without_tests(text: &str) -> &str {
    text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text)
}

#[test]
fn every_id_that_the_program_prints_is_an_invariant() {
    let rules = spec();
    let known: BTreeSet<&str> = rules.iter().map(|rule| rule.id.as_str()).collect();
    let chapters: BTreeSet<char> = known.iter().filter_map(|id| id.chars().next()).collect();
    for path in sources(&root().join("src")) {
        let text = fs::read_to_string(&path).expect("readable");
        for (line, id) in literal_ids(without_tests(&text)) {
            // A literal such as "R2" whose letter is no chapter is no id.
            let is_chapter = id.chars().next().is_some_and(|c| chapters.contains(&c));
            assert!(
                !is_chapter || known.contains(id.as_str()),
                "{}:{line}: {id} is not in SPEC.md",
                path.display()
            );
        }
    }
}

#[test]
fn the_machinery_sees_what_it_should() {
    let spec = "**P1** [a.b] One\nmore.\n*strength:* exact\n**P2** [c] Two\n\n**P3** no slug\n";
    let ids: Vec<String> = invariants(spec).into_iter().map(|rule| rule.id).collect();
    assert_eq!(ids, ["P1", "P2"]);
    assert_eq!(invariants(spec)[0].wording, "**P1** [a.b] One more. *strength:* exact");
    let text = concat!("    // sp", "ec: P1 !P2\n    #[test]\n", "// sp", "ec: P3\nlet x = 1;\n");
    let seen: Vec<(String, bool)> =
        marks("f", text).into_iter().map(|mark| (mark.id, mark.is_support)).collect();
    assert_eq!(seen, [("P1".into(), true), ("P2".into(), false), ("P3".into(), false)]);
    assert_eq!(literal_ids("rule(\"M3\"), \"no\", \"m3\", \"M\""), [(1, "M3".to_owned())]);
}
