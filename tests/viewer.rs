//! The HTML viewer in a real browser. Without Chromium on the machine these tests pass unrun.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use trigrade::check::Metric;
use trigrade::draw::{self, Background, Highlight, Layer, Viewer};
use trigrade::mesh::{MarkedEdge, MeshData, NO_POINT};

const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

fn browser() -> Option<&'static str> {
    BROWSERS.into_iter().find(|name| {
        let mut command = Command::new(name);
        command.arg("--version").stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    })
}

/// The document after the viewer has run with `address` behind its `#`; `None` without a browser.
fn shown(viewer: &Viewer<'_>, address: &str) -> Option<String> {
    let browser = browser()?;
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join("view.html");
    std::fs::write(&file, draw::html(viewer).expect("fits")).expect("written");
    Some(dump(browser, &format!("file://{}#{address}", file.display()), directory.path()))
}

fn dump(browser: &str, url: &str, directory: &Path) -> String {
    let output = directory.join("dom.html");
    let mut child = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run"])
        .args(["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"])
        .args(["--window-size=900,600", "--virtual-time-budget=8000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", directory.join("profile").display()))
        .arg(url)
        .stdout(std::fs::File::create(&output).expect("created"))
        .stderr(Stdio::null())
        .spawn()
        .expect("the browser starts");
    let start = Instant::now();
    while child.try_wait().expect("it can be waited for").is_none() {
        if start.elapsed() > Duration::from_secs(120) {
            child.kill().expect("it can be ended");
            panic!("the browser did not end: {url}");
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    std::fs::read_to_string(output).expect("text")
}

/// The text of the table row that begins with `name`.
fn fact(dom: &str, name: &str) -> Option<String> {
    let (_, rest) = dom.split_once(&format!("<td>{name}</td><td>"))?;
    Some(rest.split_once("</td>")?.0.to_owned())
}

/// The triangle with sides 3, 4, 5 and another one beside it.
fn right_angled() -> MeshData {
    MeshData {
        points: vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 3.0, 0.0], [0.0, 3.0, 0.0]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        edges: vec![MarkedEdge { vertices: [0, 2], marker: 5 }],
        ..MeshData::default()
    }
}

// spec: G12
#[test]
fn facts_of_a_triangle_are_right() {
    let mesh = right_angled();
    let Some(dom) = shown(&Viewer::new("3-4-5", &mesh), "triangle=0&measure=min_angle") else {
        return;
    };
    assert!(dom.contains("data-ready="), "{dom}");
    assert!(dom.contains("2 triangles, 4 points"));
    assert_eq!(fact(&dom, "R/(2r)").as_deref(), Some("1.25"));
    assert_eq!(fact(&dom, "angles [°]").as_deref(), Some("36.87  90  53.13"));
    assert_eq!(fact(&dom, "edges").as_deref(), Some("4  3  5"));
    assert_eq!(fact(&dom, "area").as_deref(), Some("6"));
    assert_eq!(fact(&dom, "vertex 2").as_deref(), Some("4, 3"));
    assert_eq!(fact(&dom, "smallest angle [°]").as_deref(), Some("36.87"));
}

// spec: G22
#[test]
fn metrics_have_the_values_of_the_checker() {
    let rim = (0..7).map(|i| {
        let (angle, r) = (f64::from(i), 1.0 + f64::from(i % 3));
        [r * libm::cos(angle), r * libm::sin(angle), 0.0]
    });
    let points = [[0.0; 3]].into_iter().chain(rim).collect();
    let mesh = MeshData {
        points,
        triangles: (1..7).map(|i| [0, i, i + 1]).collect(),
        ..MeshData::default()
    };
    let Some(dom) = shown(&Viewer::new("fan", &mesh), "triangle=2&facts=all") else { return };
    for metric in Metric::all() {
        let shown = fact(&dom, metric.name()).unwrap_or_else(|| panic!("{metric}: {dom}"));
        let shown: f64 = shown.parse().expect("a number");
        let value = Layer::metric(&mesh, metric).values[2];
        assert!((shown / value - 1.0).abs() < 1e-4, "{metric}: {shown} and {value}");
    }
}

// spec: G12
#[test]
fn without_webgl_a_canvas_shows_the_same() {
    let mesh = right_angled();
    let Some(dom) = shown(&Viewer::new("3-4-5", &mesh), "triangle=1&renderer=canvas") else {
        return;
    };
    assert!(dom.contains("data-ready=\"canvas\""), "{dom}");
    assert_eq!(fact(&dom, "R/(2r)").as_deref(), Some("1.25"));
}

// spec: G12
#[test]
fn broken_and_empty_meshes_are_shown_as_far_as_they_go() {
    let mut mesh = right_angled();
    mesh.points.push([f64::NAN, 1e300, 0.0]);
    mesh.triangles.extend([[0, 1, NO_POINT], [0, 1, 4], [1, 1, 1], [2, 1, 0]]);
    let viewer = Viewer::new("broken", &mesh);
    let empty = MeshData::default();
    for renderer in ["webgl2", "canvas"] {
        let address = format!("triangle=2&renderer={renderer}&measure=neighbour_area_ratio");
        let Some(dom) = shown(&viewer, &address) else { return };
        assert!(dom.contains("data-ready=") && dom.contains("2 not drawn"), "{dom}");
        assert!(fact(&dom, "cannot be drawn").is_some());
        let address = format!("renderer={renderer}&triangle=0&finding=1");
        let dom = shown(&Viewer::new("empty", &empty), &address).expect("the browser is there");
        assert!(dom.contains("data-ready=") && dom.contains("no values"), "{dom}");
    }
}

// spec: G12
#[test]
fn findings_layers_and_playback_are_offered() {
    let (mesh, coarse) = (right_angled(), right_angled());
    let label = "C7: <b>triangle</b> 1";
    let highlights =
        [Highlight { label: label.into(), triangles: vec![1], ..Highlight::default() }];
    let background = Some(Background { mesh: &coarse, spacing: &[1.0, 2.0, 3.0, 4.0] });
    let viewer = Viewer { highlights: &highlights, background, ..Viewer::new("all", &mesh) };
    let Some(dom) = shown(&viewer, "finding=1&frame=1&show=background,spacing") else { return };
    assert!(dom.contains("data-ready=") && dom.contains("1 of 2"), "{dom}");
    assert!(dom.contains("class=\"chosen\">C7: &lt;b&gt;triangle&lt;/b&gt; 1</li>"), "{dom}");
    assert_eq!(fact(&dom, "triangle").as_deref(), Some("1"));
    // The finding's triangle (0, 0), (4, 3), (0, 3) lies in the middle of the window.
    assert!(dom.contains("data-centre=\"2.00000 1.50000 0.00000\""), "{dom}");
}

/// A value in the attributes of the document's body.
fn attribute(dom: &str, name: &str) -> Option<usize> {
    let (_, rest) = dom.split_once(&format!("data-{name}=\""))?;
    rest.split_once('"')?.0.parse().ok()
}

/// A wave over a square, `n` cells a side.
fn wave(n: u32) -> MeshData {
    let at = |i: u32| f64::from(i) / f64::from(n);
    let place = |j, i| [at(i), at(j), 0.1 * libm::sin(9.0 * at(i)) * libm::sin(7.0 * at(j))];
    let cell = |j: u32, i: u32| {
        let corner = |j, i| j * (n + 1) + i;
        let [a, b, c, d] = [corner(j, i), corner(j, i + 1), corner(j + 1, i + 1), corner(j + 1, i)];
        [[a, b, c], [a, c, d]]
    };
    MeshData {
        points: (0..=n).flat_map(|j| (0..=n).map(move |i| place(j, i))).collect(),
        triangles: (0..n).flat_map(|j| (0..n).flat_map(move |i| cell(j, i))).collect(),
        ..MeshData::default()
    }
}

// spec: G23
#[test]
fn a_large_mesh_in_space_turns_as_a_coarser_one() {
    let mesh = wave(200);
    let viewer = Viewer::new("wave", &mesh);
    for renderer in ["canvas", "webgl2"] {
        let address = format!("renderer={renderer}&detail=coarse&move=3&hide=wire");
        let Some(dom) = shown(&viewer, &address) else { return };
        let [moved, drawn] = ["moved", "drawn"].map(|name| attribute(&dom, name));
        assert!(moved.is_some_and(|n| (1_000..40_000).contains(&n)), "{renderer}: {moved:?}");
        assert_eq!(drawn, Some(80_000), "{renderer}: all of it once it rests");
    }
    let small = wave(20);
    let dom = shown(&Viewer::new("wave", &small), "detail=coarse&move=3").expect("a browser");
    assert_eq!(attribute(&dom, "moved"), Some(800), "what is small is drawn as it is");
}

// spec: G12
#[test]
fn extreme_coordinates_and_space_are_shown() {
    for factor in [1e300, 1e-300] {
        let mut mesh = right_angled();
        mesh.points.iter_mut().flatten().for_each(|x| *x *= factor);
        let Some(dom) = shown(&Viewer::new("scaled", &mesh), "triangle=0") else { return };
        assert_eq!(fact(&dom, "R/(2r)").as_deref(), Some("1.25"), "{dom}");
    }
    let mut mesh = right_angled();
    mesh.points[3] = [4.0, 3.0, 5.0];
    let dom = shown(&Viewer::new("space", &mesh), "triangle=1").expect("the browser is there");
    assert!(dom.contains("data-ready="), "{dom}");
    assert_eq!(fact(&dom, "vertex 3").as_deref(), Some("4, 3, 5"));
}
