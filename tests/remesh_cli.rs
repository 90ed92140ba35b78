//! `trigrade remesh` and the methods of structured grids as a user meets them.

#![cfg(feature = "cli")]

#[path = "common/program.rs"]
mod program;

use program::{assert_exit, json, run_in, said};
use std::fs;
use std::path::Path;
use std::process::Output;

fn run(folder: &Path, line: &str) -> Output {
    run_in(folder, &line.split_whitespace().collect::<Vec<_>>())
}

#[track_caller]
fn told(output: &Output, exit: i32) -> String {
    assert_exit(output, exit);
    said(output)
}

/// The unit cube as OFF, with its quadrilaterals or with triangles.
fn cube(as_quads: bool) -> String {
    let mut text = format!("OFF\n8 {} 0\n", if as_quads { 6 } else { 12 });
    for k in 0..8 {
        text += &format!("{} {} {}\n", k & 1, k >> 1 & 1, k >> 2 & 1);
    }
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    for [a, b, c, d] in quads {
        text += &match as_quads {
            true => format!("4 {a} {b} {c} {d}\n"),
            false => format!("3 {a} {b} {c}\n3 {a} {c} {d}\n"),
        };
    }
    text
}

// spec: U15
#[test]
fn a_cube_is_remeshed_in_every_form_and_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    fs::write(path.join("cube.off"), cube(false)).expect("written");
    let line = "remesh cube.off --spacing 0.2 -o a.stl -o a.msh -o a.vtu -o a.ply -o a.obj";
    let text = told(&run(path, line), 0);
    assert!(text.contains("6 smooth parts, 12 curves, 8 corners"), "{text}");
    assert!(text.contains("Euler number 2, closed"), "{text}");
    for form in ["stl", "msh", "vtu", "ply", "obj"] {
        told(&run(path, &format!("check a.{form} --closed --max-aspect 2")), 0);
        let again = run(path, &format!("remesh a.{form} --spacing 0.3 -o b.off --json"));
        assert_exit(&again, 0);
        let json = json(&again);
        assert_eq!(json["verdict"], "passed");
        assert_eq!(json["features"]["corners"], 8);
        assert_eq!(json["euler"], 2);
    }
}

// spec: U15
#[test]
fn quadrilaterals_are_split_on_request_only() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("cube.off"), cube(true)).expect("written");
    let text = told(&run(folder.path(), "remesh cube.off --spacing 0.3 -o a.stl"), 2);
    assert!(text.contains("--split-quads"), "{text}");
    assert!(!folder.path().join("a.stl").exists());
    told(&run(folder.path(), "remesh cube.off --split-quads --spacing 0.3 -o a.stl"), 0);
}

// spec: U15 !U1
#[test]
fn a_broken_surface_is_told_by_the_rule_it_breaks() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    // A triangle through the cube.
    let pierced = cube(false)
        .replace("OFF\n8 12 0\n", "OFF\n11 13 0\n")
        .replace("3 0 2 3\n", "3 8 9 10\n3 0 2 3\n");
    let at = pierced.find("3 8 9 10").expect("there");
    let (points, faces) = pierced.split_at(at);
    let text = format!("{points}0.5 0.5 -1\n0.6 0.5 -1\n0.5 0.5 2\n{faces}");
    fs::write(path.join("pierced.off"), text).expect("written");
    let text = told(&run(path, "remesh pierced.off --spacing 0.2 -o a.stl"), 1);
    assert!(text.contains("error[M27]") && text.contains("not remeshed"), "{text}");
    assert!(!path.join("a.stl").exists());
    told(&run(path, "remesh missing.off --spacing 0.2 -o a.stl"), 2);
    fs::write(path.join("cube.off"), cube(false)).expect("written");
    let text =
        told(&run(path, "remesh cube.off --spacing 0.0001 --max-triangles 5000 -o a.stl"), 2);
    assert!(text.contains("--max-triangles"), "{text}");
}

/// A square with `columns` segments below and above and `rows` on the other sides, as .poly.
fn square(columns: u32, rows: u32) -> String {
    let (c, r) = (f64::from(columns), f64::from(rows));
    let south = (0..columns).map(|i| (f64::from(i) / c, 0.0));
    let east = (0..rows).map(|j| (1.0, f64::from(j) / r));
    let north = (0..columns).map(|i| (1.0 - f64::from(i) / c, 1.0));
    let west = (0..rows).map(|j| (0.0, 1.0 - f64::from(j) / r));
    let points: Vec<(f64, f64)> = south.chain(east).chain(north).chain(west).collect();
    let n = points.len();
    let mut text = format!("{n} 2 0 0\n");
    for (i, (x, y)) in points.iter().enumerate() {
        text += &format!("{i} {x} {y}\n");
    }
    text += &format!("{n} 1\n");
    for i in 0..n {
        text += &format!("{i} {i} {} 1\n", (i + 1) % n);
    }
    text + "0\n"
}

// spec: W8
#[test]
fn grids_are_meshed_checked_and_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path();
    fs::write(path.join("square.poly"), square(8, 5)).expect("written");
    let text = told(&run(path, "mesh square.poly --method transfinite -o a.msh"), 0);
    assert!(text.contains("8 x 5 cells") && text.contains("80 triangles"), "{text}");
    let line = "mesh square.poly --method elliptic --corners 0,8,13,21 -o a.vtu --json";
    let json = json(&run(path, line));
    assert_eq!(json["grid"]["columns"], 8);
    assert!(json["grid"]["residual"].as_f64().expect("a number") < 1e-9);
    told(&run(path, "check a.vtu --domain square.poly"), 0);
    let dry = told(&run(path, "mesh square.poly --method elliptic --dry-run"), 0);
    assert!(dry.contains("80 triangles"), "{dry}");
    let wrong =
        told(&run(path, "mesh square.poly --method elliptic --corners 0,7,13,21 -o b.msh"), 1);
    assert!(wrong.contains("opposite sides"), "{wrong}");
    told(&run(path, "mesh square.poly --method elliptic --corners 0,8,13 -o b.msh"), 2);
    let plane = told(&run(path, "mesh square.poly --method direct-surface -o b.msh"), 2);
    assert!(plane.contains("surface models only"), "{plane}");
    assert!(!path.join("b.msh").exists());
}
