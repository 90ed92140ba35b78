//! The user guide is true: every command in a `console` block of `docs/guide` runs and prints what
//! the page shows.
//!
//! A block is a session: `$ trigrade ...` runs the program, `$ cat > FILE <<'END'` writes a file,
//! `$ echo $?` shows the last exit code, `$ head -N FILE` the beginning of a file. All blocks of a page share a folder, in which
//! the domains of `examples/domains` lie, and those of `examples/models` in `models`. Lines after a command are what it prints, standard output
//! first; `...` stands for any text within a line, and alone for any number of lines.
//! `UPDATE_GUIDE=1 cargo test --test guide` writes what the commands print into the pages, with
//! times and their units replaced by `...`; review the difference as text.

#![cfg(feature = "cli")]

#[path = "common/program.rs"]
mod program;

use program::said;
use std::fs;
use std::path::PathBuf;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn pages() -> Vec<PathBuf> {
    let folder = root().join("docs/guide");
    let entries = fs::read_dir(&folder).expect("the guide is there");
    let mut pages: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "md"))
        .collect();
    pages.sort();
    pages
}

/// A folder with the example domains, and the models in a folder of their own.
fn playground() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let models = folder.path().join("models");
    fs::create_dir(&models).expect("made");
    for (from, to) in [("domains", folder.path()), ("models", &models)] {
        let examples = root().join("examples").join(from);
        for entry in fs::read_dir(examples).expect("the examples are there") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().expect("a name");
            fs::copy(&path, to.join(name)).expect("copied");
        }
    }
    folder
}

/// Words of a command line; single quotes keep spaces together.
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word = String::new();
    let (mut quoted, mut begun) = (false, false);
    for c in line.chars() {
        match c {
            '\'' => {
                quoted = !quoted;
                begun = true;
            }
            ' ' if !quoted => {
                if begun || !word.is_empty() {
                    words.push(std::mem::take(&mut word));
                }
                begun = false;
            }
            c => word.push(c),
        }
    }
    if begun || !word.is_empty() {
        words.push(word);
    }
    words
}

/// A page's session in its folder.
struct Session {
    folder: tempfile::TempDir,
    exit: i32,
}

impl Session {
    /// What a command prints.
    fn run(&mut self, command: &str) -> String {
        let words = words(command);
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        match words.as_slice() {
            ["echo", "$?"] => format!("{}\n", self.exit),
            ["head", count, file] => {
                let count: usize = count.trim_start_matches('-').parse().expect("a count");
                let text = fs::read_to_string(self.folder.path().join(file)).expect("a file");
                text.lines().take(count).map(|line| format!("{line}\n")).collect()
            }
            ["trigrade", arguments @ ..] => self.trigrade(arguments),
            other => panic!("the guide cannot run {other:?}"),
        }
    }

    fn trigrade(&mut self, arguments: &[&str]) -> String {
        let run = program::program()
            .args(arguments)
            .current_dir(self.folder.path())
            .env_remove("GITHUB_ACTIONS")
            .output()
            .expect("the program runs");
        self.exit = run.status.code().expect("an exit code");
        said(&run)
    }
}

/// Whether a line is matched by a pattern in which `...` stands for any text.
fn is_line(pattern: &str, line: &str) -> bool {
    let mut parts = pattern.split("...");
    let first = parts.next().unwrap_or("");
    let Some(mut rest) = line.strip_prefix(first) else { return false };
    let parts: Vec<&str> = parts.collect();
    for (i, part) in parts.iter().enumerate() {
        if i + 1 == parts.len() {
            return rest.ends_with(part);
        }
        let Some(at) = rest.find(part) else { return false };
        rest = &rest[at + part.len()..];
    }
    rest.is_empty()
}

/// Whether lines are matched by patterns of which `...` alone stands for any number of lines.
fn is_text(patterns: &[&str], lines: &[&str]) -> bool {
    match patterns {
        [] => lines.is_empty(),
        ["...", rest @ ..] => (0..=lines.len()).any(|skip| is_text(rest, &lines[skip..])),
        [first, rest @ ..] => {
            lines.first().is_some_and(|line| is_line(first, line)) && is_text(rest, &lines[1..])
        }
    }
}

/// `1.25 ms` and the like become `...`.
fn without_times(text: &str) -> String {
    let mut out = Vec::new();
    for line in text.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let unit = |word: &str| ["s", "ms", "us", "µs", "ns"].contains(&word.trim_end_matches(','));
        let mut kept: Vec<String> = Vec::new();
        let mut rest = words.iter().peekable();
        while let Some(word) = rest.next() {
            let is_number =
                !word.is_empty() && word.chars().all(|c| c.is_ascii_digit() || c == '.');
            match rest.next_if(|next| is_number && unit(next)) {
                // A fast machine may print another unit, so that it goes too.
                Some(next) => {
                    kept.push(format!("...{}", if next.ends_with(',') { "," } else { "" }))
                }
                None => kept.push((*word).to_owned()),
            }
        }
        out.push(kept.join(" "));
    }
    out.join("\n")
}

/// Runs a page; gives it with what its commands printed, and what differed.
fn play(page: &str) -> (String, Vec<String>) {
    let mut session = Session { folder: playground(), exit: 0 };
    let (mut out, mut faults) = (Vec::new(), Vec::new());
    let lines: Vec<&str> = page.lines().collect();
    let mut i = 0;
    let mut inside = false;
    while i < lines.len() {
        let line = lines[i];
        i += 1;
        out.push(line.to_owned());
        if line.starts_with("```") {
            inside = line == "```console";
            continue;
        }
        let Some(command) = line.strip_prefix("$ ").filter(|_| inside) else { continue };
        if let Some(rest) = command.strip_prefix("cat > ") {
            let file = rest.split(' ').next().expect("a file name");
            let end = lines[i..].iter().position(|l| *l == "END").expect("an END") + i;
            let text: String = lines[i..end].iter().map(|l| format!("{l}\n")).collect();
            fs::write(session.folder.path().join(file), text).expect("written");
            out.extend(lines[i..=end].iter().map(|l| (*l).to_owned()));
            i = end + 1;
            continue;
        }
        let shown =
            lines[i..].iter().take_while(|l| !l.starts_with("$ ") && !l.starts_with("```")).count();
        let patterns = &lines[i..i + shown];
        i += shown;
        let printed = session.run(command);
        let printed_lines: Vec<&str> = printed.lines().collect();
        if is_text(patterns, &printed_lines) {
            out.extend(patterns.iter().map(|l| (*l).to_owned()));
        } else {
            faults.push(format!(
                "$ {command}\nprints\n{printed}\nthe page shows\n{}",
                patterns.join("\n")
            ));
            out.extend(without_times(&printed).lines().map(str::to_owned));
        }
    }
    (out.join("\n") + "\n", faults)
}

#[test]
fn every_command_of_the_guide_prints_what_the_page_shows() {
    let update = std::env::var_os("UPDATE_GUIDE").is_some();
    let mut all = Vec::new();
    let mut commands = 0;
    // Pages do not know of each other, so they are played beside each other.
    let players = pages().into_iter().map(|path| {
        let page = fs::read_to_string(&path).expect("text");
        commands += page.lines().filter(|line| line.starts_with("$ trigrade")).count();
        (path, std::thread::spawn(move || play(&page)))
    });
    for (path, player) in players.collect::<Vec<_>>() {
        let (shown, faults) = player.join().expect("a page is played to its end");
        if update {
            fs::write(&path, shown).expect("written");
        } else {
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            all.extend(faults.into_iter().map(|fault| format!("{name}: {fault}")));
        }
    }
    assert!(commands >= 20, "only {commands} commands: the guide was not found");
    assert!(all.is_empty(), "{}", all.join("\n\n"));
}

/// A row of README's table of meshers as the program gives it; `None` for those of other meshers.
fn row_of(line: &str) -> Option<String> {
    let name = line.strip_prefix('|')?.split('|').next()?.trim();
    let is_bold = name.starts_with("**");
    let flags = name.trim_matches('*').strip_prefix("trigrade mesh")?;
    let domain = root().join("examples/domains/naca0012.poly");
    let fixed = ["mesh", domain.to_str()?, "-o", "-", "--form", "off", "--report", "json=r.json"];
    let arguments: Vec<&str> = fixed.into_iter().chain(flags.split_whitespace()).collect();
    let folder = tempfile::tempdir().expect("a temporary directory");
    let output = program::run_in(folder.path(), &arguments);
    assert!(output.status.success(), "{}", program::err(&output));
    let report = fs::read(folder.path().join("r.json")).expect("a report");
    let report: serde_json::Value = serde_json::from_slice(&report).expect("JSON");
    let triangles = report["triangles"].as_u64()?;
    let triangles = format!("{},{:03}", triangles / 1000, triangles % 1000);
    let [mean, p99, max] = ["mean", "p99", "max"].map(|key| report["quality"][key].as_f64());
    let figures = [format!("{:.3}", mean?), format!("{:.3}", p99?), format!("{:.2}", max?)];
    let bold = |text: &str| if is_bold { format!("**{text}**") } else { text.to_owned() };
    let [mean, p99, max] = figures.each_ref().map(|figure| bold(figure));
    Some(format!("| {name} | {triangles} | {mean} | {p99} | {max} |"))
}

#[test]
fn the_figures_of_the_readme_are_those_of_the_program() {
    let path = root().join("README.md");
    let text = fs::read_to_string(&path).expect("README.md");
    let (mut page, mut rows, mut wrong) = (String::new(), 0, Vec::new());
    for line in text.lines() {
        let row = row_of(line).unwrap_or_else(|| line.to_owned());
        rows += usize::from(line.contains("| **trigrade mesh"));
        if row != line {
            wrong.push(format!("{line}\n  now {row}"));
        }
        page += &format!("{row}\n");
    }
    if std::env::var_os("UPDATE_GUIDE").is_some() {
        fs::write(&path, page).expect("README.md can be written");
    } else {
        assert!(wrong.is_empty(), "UPDATE_GUIDE=1 writes them:\n{}", wrong.join("\n"));
    }
    assert!(rows >= 2, "the table is there");
}

#[test]
fn every_page_is_in_the_summary_and_links_lead_somewhere() {
    let folder = root().join("docs/guide");
    let summary = fs::read_to_string(folder.join("SUMMARY.md")).expect("the summary");
    for path in pages() {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        assert!(name == "SUMMARY.md" || summary.contains(&format!("]({name})")), "{name}");
        let text = fs::read_to_string(&path).expect("text");
        for (at, _) in text.match_indices("](") {
            let target = text[at + 2..].split(')').next().unwrap_or("");
            let file = target.split('#').next().unwrap_or("");
            if !file.is_empty() && !file.contains("://") {
                assert!(folder.join(file).exists(), "{name} links to {target}");
            }
        }
    }
}

#[test]
fn patterns_match_as_described() {
    assert!(is_line("total ... s", "total 0.25 s") && !is_line("total ... s", "total 0.25 ms!"));
    assert!(is_line("a...b...c", "a1b2c") && !is_line("a...b...c", "a1c2b"));
    assert!(is_text(&["x", "...", "z"], &["x", "1", "2", "z"]) && !is_text(&["x"], &["x", "y"]));
    assert_eq!(words("check 'a b' c ''"), ["check", "a b", "c", ""]);
    assert_eq!(without_times("read 1.5 ms, check 2 s"), "read ..., check ...");
    let (page, faults) = play("```console\n$ echo $?\n1\n```\n");
    assert_eq!((page.as_str(), faults.len()), ("```console\n$ echo $?\n0\n```\n", 1));
}
