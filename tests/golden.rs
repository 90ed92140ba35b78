//! Golden meshes: the same domain and options give the same bytes, on every platform.
//!
//! `tests/golden` holds the domains and their meshes (OFF). After a wanted change,
//! `UPDATE_GOLDEN=1 cargo test --test golden` rewrites both; review the difference as code.

#![cfg(feature = "cli")]

#[path = "golden/domains.rs"]
mod domains;
#[path = "common/program.rs"]
mod program;

use domains::{GOLDENS, Golden};
use std::fs;
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

fn is_updating() -> bool {
    std::env::var_os("UPDATE_GOLDEN").is_some()
}

/// Compares, or rewrites when asked to; the first line that differs is named.
fn assert_golden(path: &Path, new: &str) {
    if is_updating() {
        fs::write(path, new).expect("the golden file can be written");
    }
    let old = fs::read_to_string(path)
        .unwrap_or_else(|e| panic!("{}: {e}; UPDATE_GOLDEN=1 makes it", path.display()));
    if old == new {
        return;
    }
    let line = old.lines().zip(new.lines()).take_while(|(a, b)| a == b).count();
    panic!(
        "{}:{}: differs: `{}` became `{}`; UPDATE_GOLDEN=1 accepts it",
        path.display(),
        line + 1,
        old.lines().nth(line).unwrap_or("(end)"),
        new.lines().nth(line).unwrap_or("(end)"),
    );
}

fn mesh(golden: &Golden, more: &[&str]) -> String {
    let run = program::program()
        .args(["mesh", "--quiet", "--form", "off", "-o", "-"])
        .args(golden.options)
        .args(more)
        .arg(folder().join(golden.file_name()))
        .output()
        .expect("the program runs");
    let complaints = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success(), "{}: {complaints}", golden.name);
    String::from_utf8(run.stdout).expect("OFF is text")
}

#[test]
fn the_domain_files_are_what_the_formulas_give() {
    for golden in &GOLDENS {
        assert_golden(&folder().join(golden.file_name()), &golden.text());
    }
}

// spec: K6
#[test]
fn meshes_are_the_golden_ones_byte_for_byte() {
    for golden in &GOLDENS {
        assert_golden(&folder().join(format!("{}.off", golden.name)), &mesh(golden, &[]));
    }
}

// spec: K6
#[test]
fn threads_do_not_change_a_byte() {
    for golden in &GOLDENS {
        assert_eq!(
            mesh(golden, &["--threads", "1"]),
            mesh(golden, &["--threads", "3"]),
            "{}",
            golden.name
        );
    }
}

/// Worst R / 2r of an OFF mesh, by the formula abc / (8 (s - a)(s - b)(s - c)).
fn worst_aspect(off: &str) -> f64 {
    let mut lines = off.lines().skip(1);
    let numbers =
        |line: &str| line.split_whitespace().map(|w| w.parse().expect("a number")).collect();
    let counts: Vec<f64> = numbers(lines.next().expect("counts"));
    let points: Vec<Vec<f64>> = lines.by_ref().take(counts[0] as usize).map(numbers).collect();
    let aspect = |line: &str| {
        let corners: Vec<&Vec<f64>> =
            line.split_whitespace().skip(1).map(|w| &points[w.parse::<usize>().unwrap()]).collect();
        let length = |i: usize, j: usize| {
            libm::hypot(corners[i][0] - corners[j][0], corners[i][1] - corners[j][1])
        };
        let (a, b, c) = (length(1, 2), length(2, 0), length(0, 1));
        a * b * c / ((b + c - a) * (c + a - b) * (a + b - c))
    };
    lines.map(aspect).fold(0.0, f64::max)
}

#[test]
fn no_triangle_is_worse_than_its_bound() {
    for golden in &GOLDENS {
        let worst = worst_aspect(&mesh(golden, &[]));
        assert!((1.0 - 1e-9..=golden.aspect_max).contains(&worst), "{}: {worst}", golden.name);
    }
}

#[test]
fn the_aspect_ratio_of_known_triangles() {
    let equilateral = "OFF\n3 1 0\n0 0 0\n1 0 0\n0.5 0.8660254037844386 0\n3 0 1 2\n";
    assert!((worst_aspect(equilateral) - 1.0).abs() < 1e-12);
    // 3-4-5: R = 2.5, r = 1.
    assert_eq!(worst_aspect("OFF\n3 1 0\n0 0 0\n4 0 0\n0 3 0\n3 0 1 2\n"), 1.25);
}
