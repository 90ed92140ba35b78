//! IGES files against surfaces known otherwise, and files that lie.

#[path = "common/iges_writer.rs"]
mod writer;

use std::time::Instant;
use trigrade::check::surface::{SurfaceLimits, check_on_model};
use trigrade::curve::Curve;
use trigrade::format::iges::read;
use trigrade::mesher::Unobserved;
use trigrade::model::{Model, TrimCurve};
use trigrade::surface::{Surface, Tensor};
use trigrade::surface_mesher::{SurfaceMeshed, SurfaceOptions, mesh_model};
use trigrade::vector::distance;
use writer::{Writer, net, tube};

fn model(file: &Writer) -> Model {
    read(&file.text()).unwrap_or_else(|error| panic!("{error}"))
}

fn complaint(text: &[u8]) -> String {
    read(text).expect_err("a broken file").to_string()
}

/// Meshes and checks: chord errors and all that chapter 12.5 says.
fn meshed(model: &Model, spacing: f64) -> SurfaceMeshed {
    let mut options = SurfaceOptions::default();
    options.common.spacing = Some(spacing);
    let meshed = mesh_model(model, &options, &mut Unobserved).expect("a mesh");
    let limits = SurfaceLimits::default();
    let (report, found) = check_on_model(&meshed.mesh, (model, &limits), None, &Default::default());
    assert!(report.passed(), "{:?}", report.findings);
    assert_eq!(found.euler, found.euler_of_model);
    meshed
}

fn boundary_edges(meshed: &SurfaceMeshed) -> usize {
    let mut count = std::collections::BTreeMap::new();
    for &[a, b, c] in &meshed.mesh.triangles {
        for [a, b] in [[a, b], [b, c], [c, a]] {
            *count.entry([a.min(b), a.max(b)]).or_insert(0) += 1;
        }
    }
    count.values().filter(|&&n| n == 1).count()
}

// spec: X65
#[test]
fn a_rational_surface_is_the_one_that_was_written() {
    let (rows, weights) = net();
    let knots =
        [vec![0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 0.0, 2.0, 2.0, 2.0]];
    let wanted = Tensor::new([3, 2], knots.clone(), &rows, &weights).expect("a surface");
    let mut file = Writer::default();
    file.surface([3, 2], &knots, (&rows, &weights), [[0.0, 1.0], [0.0, 2.0]]);
    let found = model(&file);
    assert_eq!(found.patches[0].surface, Surface::Tensor(wanted.clone()));
    assert_eq!((found.patches[0].name.as_str(), found.patches[0].marker), ("D1", 1));
    assert!(found.notes[0].contains("millimetres"), "{:?}", found.notes);

    let mut part = Writer::default();
    part.surface([3, 2], &knots, (&rows, &weights), [[0.1, 0.7], [0.5, 2.0]]);
    let part = &model(&part).patches[0].surface;
    assert_eq!(part.domain(), [[0.1, 0.7], [0.5, 2.0]]);
    for (u, v) in [(0.1, 0.5), (0.3, 1.0), (0.55, 1.9), (0.7, 2.0)] {
        let gap = distance(part.at(u, v), Surface::Tensor(wanted.clone()).at(u, v));
        assert!(gap < 1e-13, "{u} {v}: {gap}");
    }
}

// spec: X65
#[test]
fn delimiters_line_ends_and_exponents_are_the_files_own() {
    let mut file = Writer::default();
    let (rows, weights) = net();
    let knots =
        [vec![0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 0.0, 2.0, 2.0, 2.0]];
    file.surface([3, 2], &knots, (&rows, &weights), [[0.0, 1.0], [0.0, 2.0]]);
    let plain = model(&file);
    let other = Writer { delimiters: ['/', '#'], line_end: "\r\n", exponent: 'D', ..file };
    let text = String::from_utf8(other.text()).expect("ASCII");
    assert!(text.contains("D0") && text.contains("1H//1H#/") && text.contains("\r\n"), "{text}");
    assert_eq!(model(&other), plain);
}

// spec: X65
#[test]
fn every_curve_ends_where_it_should() {
    // Around a square: a line, an arc bulging out, a polyline, a B-spline; moved by a matrix.
    let mut file = Writer::default();
    let shift = file.add(124, "1,0,0,10,0,1,0,20,0,0,1,30");
    let plane = file.add(108, "0,0,1,30,0,0,0,0,0");
    let line = file.add_moved(110, "0,0,0,2,0,0", shift);
    let arc = file.add_moved(100, "0,2,1,2,0,2,2", shift);
    file.form = 11;
    let polyline = file.add_moved(106, "1,3,0,2,2,1,2.5,0,2", shift);
    file.form = 12;
    let dots = file.add_moved(106, "2,2,0,2,0,0,1,0", shift);
    file.form = 0;
    let spline = file.add_moved(
        126,
        "2,2,1,0,1,0,0,0,0,1,1,1,1,1,1,0,1,0,-0.5,0.5,0,0,0,0,0,1,0,0,1",
        shift,
    );
    let all = file.add(102, &format!("5,{line},{arc},{polyline},{dots},{spline}"));
    let ring = file.add(142, &format!("0,{plane},0,{all},2"));
    file.add(144, &format!("{plane},1,0,{ring}"));
    let model = model(&file);
    assert_eq!(model.patches.len(), 1);
    let outline = model.trims[&0].outline.as_ref().expect("an outline");
    let ends: Vec<_> = outline
        .iter()
        .map(|curve| match curve {
            TrimCurve::Space { curve, .. } => curve.ends(),
            TrimCurve::Parameters { .. } => panic!("no curve in space"),
        })
        .collect();
    let corners =
        [[10.0, 20.0], [12.0, 20.0], [12.0, 22.0], [10.0, 22.0], [10.0, 21.0], [10.0, 20.0]];
    for (i, [from, to]) in ends.iter().enumerate() {
        for (found, [x, y]) in [(from, corners[i]), (to, corners[i + 1])] {
            assert!(distance(*found, [x, y, 30.0]) < 1e-12, "{i}: {found:?}");
        }
    }
    let TrimCurve::Space { curve: arc, .. } = &outline[1] else { panic!("an arc") };
    assert!(distance(arc.at(0.5), [13.0, 21.0, 30.0]) < 1e-12, "counterclockwise");
    meshed(&model, 0.4);
}

// spec: S25 X65
#[test]
fn six_squares_with_edges_of_their_own_are_a_closed_cube() {
    for off in [0.0, 4e-8] {
        let mut file = Writer::default();
        writer::cube(&mut file, off);
        let model = model(&file);
        assert_eq!(model.tolerance, Some(1e-7), "as the file states");
        let meshed = meshed(&model, 0.3);
        assert_eq!((meshed.patches, meshed.curves, boundary_edges(&meshed)), (6, 12, 0), "{off}");
    }
}

// spec: S25
#[test]
fn edges_farther_apart_than_the_files_resolution_are_joined_only_on_demand() {
    let mut file = Writer::default();
    writer::cube(&mut file, 2e-5);
    let mut model = model(&file);
    let apart = mesh_model(&model, &SurfaceOptions::default(), &mut Unobserved).expect("a mesh");
    assert!(boundary_edges(&apart) > 0, "a lid by itself");
    model.weld(1e-4);
    assert_eq!(boundary_edges(&meshed(&model, 0.3)), 0);
}

// spec: X65 S25
#[test]
fn a_tube_with_a_seam_and_two_lids_is_closed() {
    let mut file = Writer::default();
    tube(&mut file);
    let model = model(&file);
    assert!(!model.trims.contains_key(&0), "the seam and the circles are the sides");
    let meshed = meshed(&model, 0.3);
    assert_eq!(boundary_edges(&meshed), 0);
    let volume: f64 = meshed
        .mesh
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| meshed.mesh.points[v as usize]);
            trigrade::vector::dot(a, trigrade::vector::cross(b, c)) / 6.0
        })
        .sum();
    let exact = 2.0 * std::f64::consts::PI;
    assert!((volume / exact - 1.0).abs() < 0.02 && volume < exact, "{volume}");
}

// spec: X65
#[test]
fn a_tabulated_cylinder_and_a_bounded_surface() {
    let mut file = Writer::default();
    let curve = file.add(126, "2,2,1,0,1,0,0,0,0,1,1,1,1,1,1,0,0,0,1,0,1,2,0,0,0,1,0,0,1");
    let sheet = file.add(122, &format!("{curve},0,3,0"));
    let found = model(&file);
    assert_eq!(found.patches[0].surface.at(0.5, 1.0), [1.0, 3.0, 0.5]);
    // The lower half of it, by a boundary in (u, v) and in space.
    let corners = ["0,0,0,1,0,0", "1,0,0,1,0.5,0", "1,0.5,0,0,0.5,0", "0,0.5,0,0,0,0"];
    let flats = corners.map(|corners| file.add(110, corners));
    let upper = file.add(126, "2,2,1,0,1,0,0,0,0,1,1,1,1,1,1,0,1.5,0,1,1.5,1,2,1.5,0,0,1,0,0,1");
    let [east, west] = ["2,0,0,2,1.5,0", "0,1.5,0,0,0,0"].map(|ends| file.add(110, ends));
    let [south, east_flat, north, west_flat] = flats;
    let ring = file.add(
        141,
        &format!("1,2,{sheet},4,{curve},1,1,{south},{east},1,1,{east_flat},{upper},2,1,{north},{west},1,1,{west_flat}"),
    );
    file.add(143, &format!("1,{sheet},1,{ring}"));
    let model = model(&file);
    assert_eq!((model.patches.len(), model.trims.len()), (1, 1));
    let meshed = meshed(&model, 0.2);
    assert!(meshed.mesh.points.iter().all(|p| p[1] <= 1.5 + 1e-9));
    assert!(boundary_edges(&meshed) > 20);
}

// spec: X67
#[test]
fn what_is_left_out_is_told_and_a_file_without_faces_is_refused() {
    let mut file = Writer::default();
    tube(&mut file);
    file.add_alone(116, "1,2,3,0");
    file.add_alone(110, "0,0,0,1,1,1");
    file.add_alone(110, "0,0,0,1,1,2");
    let notes = model(&file).notes;
    assert!(notes.iter().any(|n| n.contains("2 of type 110, 1 of type 116")), "{notes:?}");
    let mut solid = Writer::default();
    solid.add_alone(186, "3,1,0");
    let told = complaint(&solid.text());
    assert!(told.contains("1 of type 186") && told.contains("not solids"), "{told}");
    let mut other = Writer::default();
    let torus = other.add(198, "1,0,0,0");
    let ring = other.add(142, &format!("0,{torus},0,{torus},2"));
    other.add(144, &format!("{torus},1,0,{ring}"));
    let told = complaint(&other.text());
    assert!(told.contains("type 198") && told.starts_with("line "), "{told}");
}

/// Breaks a file.
type Change = fn(&mut Writer);

// spec: X66
#[test]
fn broken_records_are_refused_with_their_line() {
    let broken = |change: Change| {
        let mut file = Writer::default();
        tube(&mut file);
        change(&mut file);
        let told = complaint(&file.text());
        assert!(told.starts_with("line "), "{told}");
        told
    };
    let changes: [(Change, &str); 7] = [
        (|f| f.replace(102, "1099511627776,1"), "must be between 1 and 1"),
        (|f| f.replace(102, "2,1,999999"), "odd number from 1 to"),
        (|f| f.replace(102, "2,1,-3"), "odd number"),
        (|f| f.replace(102, "1,4"), "odd number"),
        (|f| f.replace(110, "0,0,zero,0,0,2"), "expected a coordinate"),
        (|f| f.replace(110, "0,0,0,1e999,0,2"), "expected a coordinate"),
        (|f| f.replace(110, "0,0"), "the end of the entity"),
    ];
    for (i, (change, word)) in changes.into_iter().enumerate() {
        let told = broken(change);
        assert!(told.contains(word), "{i}: {told}");
    }
}

// spec: X66
#[test]
fn circles_of_references_and_their_unfolding_are_refused() {
    let mut cycle = Writer::default();
    let plane = cycle.add(108, "0,0,1,0,0,0,0,0,0");
    let next = cycle.next();
    cycle.add(102, &format!("1,{}", next + 2));
    cycle.add(102, &format!("1,{next}"));
    let ring = cycle.add(142, &format!("0,{plane},0,{next},2"));
    cycle.add(144, &format!("{plane},1,0,{ring}"));
    let told = complaint(&cycle.text());
    assert!(told.contains("part of itself") && told.starts_with("line "), "{told}");

    let mut matrices = Writer::default();
    let next = matrices.next();
    matrices.add_moved(124, "1,0,0,0,0,1,0,0,0,0,1,0", next);
    matrices.add_moved(128, "1,1,1,1,0,0,1,0,0,0,0,1,1,0,0,1,1", next);
    assert!(complaint(&matrices.text()).contains("part of itself"));

    // Each curve is twenty times the one before: 20^10 lines.
    let mut bomb = Writer::default();
    let plane = bomb.add(108, "0,0,1,0,0,0,0,0,0");
    let mut last = bomb.add(110, "0,0,0,1,0,0");
    for _ in 0..10 {
        let list = vec![last.to_string(); 20].join(",");
        last = bomb.add(102, &format!("20,{list}"));
    }
    let ring = bomb.add(142, &format!("0,{plane},0,{last},2"));
    bomb.add(144, &format!("{plane},1,0,{ring}"));
    let start = Instant::now();
    let told = complaint(&bomb.text());
    assert!(told.contains("unfold") && start.elapsed().as_secs() < 20, "{told}");
}

// spec: X66
#[test]
fn sections_that_lie_are_refused() {
    let mut file = Writer::default();
    tube(&mut file);
    let whole = String::from_utf8(file.text()).expect("ASCII");
    let lines: Vec<&str> = whole.lines().collect();
    let with = |change: &dyn Fn(&mut Vec<String>)| {
        let mut lines: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
        change(&mut lines);
        complaint(lines.join("\n").as_bytes())
    };
    assert!(with(&|l| drop(l.remove(5))).starts_with("line 6: expected the sequence number"));
    assert!(with(&|l| l.truncate(9)).contains("expected a last line of section T"));
    assert!(with(&|l| l[3].truncate(60)).starts_with("line 4: expected a line of 80 columns"));
    assert!(with(&|l| l[0].replace_range(72..73, "C")).contains("compressed"));
    let last = lines.len() - 1;
    assert!(with(&|l| l[last].replace_range(1..8, "0000007")).contains("number of lines of each"));
    assert!(with(&|l| l.swap(1, last)).contains("in the order S, G, D, P, T"));
    assert!(with(&|l| l[3].replace_range(8..16, " 1234567")).contains("parameter lines"));
    for end in (0..whole.len() - 40).step_by(61) {
        assert!(!complaint(&whole.as_bytes()[..end]).is_empty());
    }
}

// spec: X65
#[test]
fn the_example_is_the_tube_of_these_tests() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/models/tube.igs");
    let mut file = Writer::default();
    tube(&mut file);
    if std::env::var_os("UPDATE_EXAMPLE").is_some() {
        std::fs::write(path, file.text()).expect("writable");
    }
    assert!(std::fs::read(path).expect("the example") == file.text());
}

// spec: X66
#[test]
fn any_byte_may_be_wrong() {
    let mut file = Writer::default();
    tube(&mut file);
    let whole = file.text();
    let mut refused = 0;
    for at in (0..whole.len()).step_by(3) {
        for byte in *b"0-9,;HD\n\xff" {
            let mut bytes = whole.clone();
            bytes[at] = byte;
            match read(&bytes) {
                Ok(model) => assert!(model.patches.len() <= 4),
                Err(error) => {
                    assert!(!error.to_string().is_empty());
                    refused += 1;
                }
            }
        }
    }
    assert!(refused > 1000, "{refused}");
}

// spec: S26
#[test]
fn a_rational_tube_with_a_hole_is_one_smooth_patch() {
    let circle = Curve::circle([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]).expect("a circle");
    let rows: Vec<_> = circle.points().iter().map(|p| vec![*p, [p[0], p[1], 2.0]]).collect();
    let weights: Vec<_> = circle.weights().iter().map(|&w| vec![w, w]).collect();
    let knots = [circle.knots().to_vec(), vec![0.0, 0.0, 1.0, 1.0]];
    let mut file = Writer::default();
    let sheet = file.surface([2, 1], &knots, (&rows, &weights), [[0.0, 1.0], [0.0, 1.0]]);
    // A hole across the line u = 1/4, where the knots are double, in (u, v) alone.
    let corners = [
        "0.2,0.3,0,0.3,0.3,0",
        "0.3,0.3,0,0.3,0.7,0",
        "0.3,0.7,0,0.2,0.7,0",
        "0.2,0.7,0,0.2,0.3,0",
    ];
    let curves = corners.map(|ends| file.add(110, ends).to_string());
    let all = file.add(102, &format!("4,{}", curves.join(",")));
    let ring = file.add(142, &format!("0,{sheet},{all},0,1"));
    file.add(144, &format!("{sheet},0,1,0,{ring}"));
    let model = model(&file);
    assert_eq!(model.patches[0].surface.pieces().len(), 1);
    let meshed = meshed(&model, 0.2);
    assert_eq!(meshed.patches, 1);
}

// spec: S25
#[test]
fn a_loop_off_its_surface_is_refused_unless_the_tolerance_allows_for_it() {
    let mut file = Writer::default();
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 1e-5], [0.0, 1.0, 0.0]];
    file.polygon("0,0,1,0,0,0,0,0,0", &corners);
    let mut model = model(&file);
    let refused = mesh_model(&model, &SurfaceOptions::default(), &mut Unobserved);
    let told = refused.expect_err("off the plane").to_string();
    assert!(told.contains("off the surface") && told.contains("--weld"), "{told}");
    model.weld(2e-5);
    meshed(&model, 0.2);
}
