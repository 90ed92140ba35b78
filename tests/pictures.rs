//! The pictures of the documentation are made by the library itself. `UPDATE_PICTURES=1 cargo test
//! --test pictures` writes them anew.

use std::fs;
use std::path::PathBuf;
use trigrade::Mesher;
use trigrade::domain::Domain;
use trigrade::domain::naca::symmetric_section;
use trigrade::draw::{self, Layer, Options, Panel, View};
use trigrade::format::model_json;
use trigrade::mesh::MeshData;
use trigrade::mesher::Unobserved;
use trigrade::point::Point2;
use trigrade::surface_mesher::{SurfaceOptions, mesh_model};
use trigrade::triangulate::triangulate_points;
use trigrade::voronoi::{ClipBox, voronoi};

/// An airfoil in a box, small enough for a page.
fn airfoil() -> Domain {
    let rim = [[-1.0, -0.7], [2.0, -0.7], [2.0, 0.7], [-1.0, 0.7]];
    let outer = (0..4).flat_map(|i| {
        let ([x, y], [u, v]) = (rim[i], rim[(i + 1) % 4]);
        let pieces = if i % 2 == 0 { 8 } else { 4 };
        (0..pieces).map(move |k| {
            let t = f64::from(k) / f64::from(pieces);
            Point2::new(x + t * (u - x), y + t * (v - y))
        })
    });
    Domain::of_rings(&[outer.collect(), symmetric_section(0.15, 60)])
}

/// Forty points by a low-discrepancy sequence.
fn cloud() -> Vec<Point2> {
    let fraction = |x: f64| x - x.floor();
    let point = |i: u32| {
        let i = f64::from(i);
        Point2::new(2.0 * fraction(i * 0.754_877_666), fraction(i * 0.569_840_291))
    };
    (1..=40).map(point).collect()
}

fn options(title: &str) -> Options {
    Options { title: title.to_owned(), width: 720.0, ..Options::default() }
}

fn mesher() -> String {
    let meshed = Mesher::new().mesh(&airfoil()).expect("sound");
    let mesh = MeshData::from(&meshed.mesh);
    let layer = Layer::radius_ratio(&mesh);
    let panel = Panel::new(&mesh, "graded, coloured by R/(2r)").coloured(&layer);
    draw::svg(&[panel], &options("")).expect("drawn")
}

fn delaunay() -> String {
    let made = triangulate_points(&cloud(), Default::default()).expect("finite");
    let mesh = MeshData::from(&made.mesh);
    draw::svg(&[Panel::new(&mesh, "Delaunay triangulation of 40 points")], &options(""))
        .expect("drawn")
}

fn cells() -> String {
    let sites = cloud();
    let bounds = ClipBox::around(&sites).expect("there are sites");
    let clipped = voronoi(&sites, false).expect("finite").clip_to_box(bounds);
    draw::cells_svg(&clipped, &sites, &options("")).expect("drawn")
}

fn surface() -> String {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("examples/models/wave.json");
    let model = model_json::read(&fs::read(path).expect("there")).expect("a model");
    let mut options = SurfaceOptions::default();
    options.common.spacing = Some(model.diagonal() / 22.0);
    let meshed = mesh_model(&model, &options, &mut Unobserved).expect("a mesh");
    let page = Options { width: 520.0, ..Options::default() };
    draw::perspective(&meshed.mesh, "", &page).expect("drawn").0
}

/// Markdown ends an element of HTML at a blank line.
fn without_blank_lines(svg: String) -> String {
    svg.lines().filter(|line| !line.trim().is_empty()).map(|line| format!("{line}\n")).collect()
}

#[test]
fn committed_pictures_are_those_the_library_draws() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/pictures");
    let all = [
        ("mesher", mesher()),
        ("delaunay", delaunay()),
        ("voronoi", cells()),
        ("surface", surface()),
    ];
    for (name, svg) in all {
        let (path, svg) = (folder.join(format!("{name}.svg")), without_blank_lines(svg));
        if std::env::var_os("UPDATE_PICTURES").is_some() {
            fs::write(&path, &svg).expect("written");
        }
        let committed = fs::read_to_string(&path).expect("it is there");
        assert!(committed == svg, "{name}: look at the difference, then UPDATE_PICTURES=1");
        assert!(svg.len() < 100_000, "{name}: {} bytes are too many for a page", svg.len());
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"), "{name}");
    }
}

#[test]
fn a_close_up_is_smaller_than_the_whole() {
    let meshed = Mesher::new().mesh(&airfoil()).expect("sound");
    let mesh = MeshData::from(&meshed.mesh);
    let view = View { x0: 0.9, y0: -0.1, x1: 1.1, y1: 0.1 };
    let draw = |panel| draw::svg(&[panel], &options("")).expect("drawn").len();
    assert!(draw(Panel::new(&mesh, "").cropped(view)) < draw(Panel::new(&mesh, "")));
}
