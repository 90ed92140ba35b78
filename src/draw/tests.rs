//! Whole pictures: what is in them, what is refused, and that nothing breaks them.

use super::*;
use crate::mesh::{MarkedEdge, NO_POINT};
use proptest::prelude::*;
use roxmltree::{Document, Node};

/// `side` x `side` squares of the unit square, each cut in two.
fn grid(side: u32) -> MeshData {
    let step = 1.0 / f64::from(side);
    let mut mesh = MeshData::default();
    for j in 0..=side {
        for i in 0..=side {
            mesh.points.push([f64::from(i) * step, f64::from(j) * step, 0.0]);
        }
    }
    for j in 0..side {
        for i in 0..side {
            let a = j * (side + 1) + i;
            let (b, c, d) = (a + 1, a + side + 2, a + side + 1);
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

fn draw(panel: Panel<'_>) -> String {
    svg(&[panel], &Options::default()).expect("the panel fits")
}

/// The paths of fills, of a document: those in groups of crisp edges.
fn fills<'a>(document: &'a Document<'a>) -> Vec<Node<'a, 'a>> {
    let crisp = |n: &Node<'_, '_>| n.attribute("shape-rendering") == Some("crispEdges");
    document
        .descendants()
        .filter(|n| n.has_tag_name("g") && crisp(n))
        .flat_map(|g| g.children().filter(|n| n.has_tag_name("path")))
        .collect()
}

fn drawn_triangles(svg: &str) -> usize {
    let document = Document::parse(svg).expect("well-formed");
    fills(&document).iter().map(|p| p.attribute("d").unwrap_or("").matches('z').count()).sum()
}

fn texts(svg: &str) -> String {
    let document = Document::parse(svg).expect("well-formed");
    let text = document.descendants().filter(|n| n.has_tag_name("text"));
    text.filter_map(|n| n.text()).collect::<Vec<_>>().join("|")
}

// spec: G6
#[test]
fn every_triangle_is_drawn_once_and_coloured_by_its_value() {
    let mesh = grid(5);
    let mut layer = Layer::radius_ratio(&mesh);
    layer.values[7] = 99.0;
    layer.values[8] = f64::NAN;
    let svg = draw(Panel::new(&mesh, "grid").coloured(&layer));
    assert_eq!(drawn_triangles(&svg), 50);
    let document = Document::parse(&svg).expect("well-formed");
    let mut counts: Vec<(String, usize)> = fills(&document)
        .iter()
        .map(|p| {
            let count = p.attribute("d").unwrap_or("").matches('z').count();
            (p.attribute("fill").unwrap_or("").to_owned(), count)
        })
        .collect();
    counts.sort_by_key(|c| c.1);
    assert_eq!(counts.len(), 3, "{counts:?}");
    let worst = format!("#{:06x}", Palette::default().colour(1.0));
    assert!(counts.contains(&(worst, 1)) && counts.contains(&("#b8b8b8".to_owned(), 1)));
    assert_eq!(counts[2].1, 48);
}

// spec: G6
#[test]
fn triangles_that_cannot_be_drawn_are_counted_in_the_caption() {
    let mut mesh = grid(2);
    mesh.points.extend([[f64::NAN, 0.0, 0.0], [f64::INFINITY, 0.0, 0.0]]);
    mesh.triangles.extend([[0, 1, NO_POINT], [0, 1, 9], [0, 1, 10], [0, 1, 1000]]);
    mesh.edges.push(MarkedEdge { vertices: [9, 0], marker: 1 });
    let layer = Layer::radius_ratio(&mesh);
    let svg = draw(Panel::new(&mesh, "broken").coloured(&layer));
    assert_eq!(drawn_triangles(&svg), 8);
    assert!(texts(&svg).contains("12 triangles, 4 not drawn"), "{}", texts(&svg));
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
}

// spec: G1
#[test]
fn meshes_of_extreme_size_or_none_give_finite_pictures() {
    let scaled = |factor: f64| {
        let mut mesh = grid(3);
        mesh.points.iter_mut().flatten().for_each(|x| *x = (*x - 0.5) * factor);
        mesh
    };
    let point = MeshData { points: vec![[1.0, 2.0, 0.0]], ..MeshData::default() };
    let nowhere = MeshData { points: vec![[f64::NAN; 3]], ..MeshData::default() };
    let mut flat = grid(2);
    flat.points.iter_mut().for_each(|p| p[1] = 3.0);
    let meshes = [
        scaled(1.7e308),
        scaled(1e-310),
        scaled(1e-323),
        MeshData::default(),
        point,
        nowhere,
        flat,
    ];
    for (i, mesh) in meshes.iter().enumerate() {
        let layer = Layer::radius_ratio(mesh);
        let svg = draw(Panel::new(mesh, "extreme").coloured(&layer));
        assert_eq!(drawn_triangles(&svg), mesh.triangles.len(), "mesh {i}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "mesh {i}: {svg}");
    }
}

// spec: G5
#[test]
fn the_same_panels_give_the_same_bytes() {
    let mesh = grid(9);
    let layer = Layer::radius_ratio(&mesh);
    let picture = || draw(Panel::new(&mesh, "grid").coloured(&layer));
    assert_eq!(picture(), picture());
}

/// Two triangles, drawn in full: a change of any byte shows here.
#[test]
fn a_small_picture_byte_for_byte() {
    let mesh = grid(1);
    let options = Options { width: 232.0, ..Options::default() };
    let svg = svg(&[Panel::new(&mesh, "two")], &options).expect("fits");
    let expected = concat!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"232\" height=\"280\" viewBox=\"0 0 232 280\" ",
        "font-family=\"Helvetica,Arial,DejaVu Sans,sans-serif\">\n",
        "<rect width=\"232\" height=\"280\" fill=\"#fff\"/>\n",
        "<text x=\"16\" y=\"29\" font-size=\"13\" font-weight=\"bold\" fill=\"#22262c\">two</text>\n",
        "<text x=\"16\" y=\"45\" font-size=\"11\" fill=\"#4a4f57\">2 triangles</text>\n",
        "<g transform=\"translate(16 54)\"><g>\n",
        "<g transform=\"scale(0.05)\" fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n",
        "<g shape-rendering=\"crispEdges\">\n",
        "<path fill=\"#eef1f4\" d=\"M0 4000l4000 0 0-4000zm0 0 4000-4000-4000 0z\"/>\n",
        "</g>\n",
        "<path stroke=\"#16181c\" stroke-width=\"11.33\" d=\"M0 4000l4000-4000\"/>\n",
        "<path stroke=\"#000000\" stroke-width=\"26\" d=\"M0 4000l4000 0 0-4000-4000 0 0 4000\"/>\n",
        "</g>\n</g>\n</g>\n</svg>\n",
    );
    assert_eq!(svg, expected);
}

// spec: G9
#[test]
fn a_hundred_thousand_triangles_stay_below_ten_megabytes() {
    let mesh = grid(224);
    let layer = Layer::radius_ratio(&mesh);
    let svg = draw(Panel::new(&mesh, "grid").coloured(&layer));
    assert!(mesh.triangles.len() > 100_000 && svg.len() < 10_000_000, "{} bytes", svg.len());
}

// spec: G7
#[test]
fn whole_panels_share_one_scale_and_a_close_up_fills_its_cell() {
    let (small, mut large) = (grid(1), grid(1));
    large.points.iter_mut().flatten().for_each(|x| *x *= 2.0);
    let view = View { x0: 0.25, y0: 0.25, x1: 0.75, y1: 0.5 };
    let panels =
        [Panel::new(&small, "a"), Panel::new(&large, "b"), Panel::new(&small, "c").cropped(view)];
    let svg = svg(&panels, &Options::default()).expect("fits");
    let document = Document::parse(&svg).expect("well-formed");
    let spans: Vec<f64> = fills(&document)
        .iter()
        .map(|p| {
            let scale = p.ancestors().find_map(|g| {
                g.attribute("transform")?.strip_prefix("scale(")?.strip_suffix(')')?.parse().ok()
            });
            // "M0 4000l4000 ..." : the first step along x is the side of the square.
            let data = p.attribute("d").unwrap_or("");
            let side = data.split('l').nth(1).and_then(|d| d.split([' ', '-']).next());
            side.and_then(|s| s.parse::<f64>().ok()).unwrap_or(0.0) * scale.unwrap_or(0.0)
        })
        .collect();
    assert!((spans[1] / spans[0] - 2.0).abs() < 1e-3, "{spans:?}");
    let clip = document.descendants().find(|n| n.has_tag_name("clipPath")).expect("a close-up");
    let rect = clip.first_element_child().expect("a rectangle");
    let size = ["width", "height"].map(|a| rect.attribute(a).and_then(|w| w.parse::<f64>().ok()));
    let cell = (960.0 - 2.0 * 16.0 - 2.0 * 20.0) / 3.0;
    assert!((size[0].unwrap_or(0.0) - cell).abs() < 0.01, "{size:?} in {cell}");
    assert!((size[1].unwrap_or(0.0) - cell / 2.0).abs() < 0.01, "{size:?}");
}

#[test]
fn a_close_up_draws_only_what_it_shows() {
    let mesh = grid(40);
    let view = View { x0: 0.0, y0: 0.0, x1: 0.1, y1: 0.1 };
    let svg = draw(Panel::new(&mesh, "corner").cropped(view));
    let shown = drawn_triangles(&svg);
    // 4 x 4 squares, and those of the margin that hides cut line ends.
    assert!((32..=50).contains(&shown), "{shown} triangles");
    let far = View { x0: 5.0, y0: 5.0, x1: 6.0, y1: 6.0 };
    assert_eq!(drawn_triangles(&draw(Panel::new(&mesh, "nothing").cropped(far))), 0);
}

#[test]
fn a_view_a_billionth_of_the_mesh_keeps_coordinates_small() {
    let mesh = grid(1);
    let view = View { x0: 0.5, y0: 0.5, x1: 0.5 + 1e-9, y1: 0.5 + 1e-9 };
    let svg = draw(Panel::new(&mesh, "deep").cropped(view));
    let document = Document::parse(&svg).expect("well-formed");
    for path in fills(&document) {
        let data = path.attribute("d").unwrap_or("");
        let longest = data.split(|c: char| !c.is_ascii_digit()).map(str::len).max();
        assert!(longest < Some(8), "{data}");
    }
    assert_eq!(drawn_triangles(&svg), 2);
}

#[test]
fn highlights_are_marked_numbered_and_listed() {
    let mesh = grid(10);
    let highlights: Vec<Highlight> = (0..20)
        .map(|i| Highlight {
            label: format!("fault <{i}>"),
            triangles: vec![i],
            ..Highlight::default()
        })
        .chain([Highlight {
            label: "out of range".into(),
            triangles: vec![5000],
            edges: vec![[0, NO_POINT], [0, 1]],
            vertices: vec![NO_POINT, 3],
            lines: vec![
                vec![[0.5, 0.5]],
                vec![[0.0, 0.0], [2.0, 2.0]],
                vec![[f64::NAN, 0.0]],
                vec![],
            ],
        }])
        .collect();
    let mut panel = Panel::new(&mesh, "marked");
    panel.highlights = &highlights;
    let all = texts(&draw(panel));
    assert!(all.contains("1: fault <0>") && all.contains("and 9 more"), "{all}");
    assert!(all.split('|').any(|t| t == "21"), "the mark beyond the list is numbered: {all}");
}

#[test]
fn highlights_outside_a_close_up_are_listed_but_not_marked() {
    let mesh = grid(10);
    let highlights =
        [Highlight { label: "far".into(), vertices: vec![120], ..Highlight::default() }];
    let view = View { x0: 0.0, y0: 0.0, x1: 0.2, y1: 0.2 };
    let mut panel = Panel::new(&mesh, "corner").cropped(view);
    panel.highlights = &highlights;
    let all = texts(&draw(panel));
    assert!(all.contains("1: far") && !all.split('|').any(|t| t == "1"), "{all}");
}

// spec: G2
#[test]
fn what_does_not_fit_is_refused_with_its_place() {
    let mesh = grid(2);
    let options = Options::default();
    assert_eq!(svg(&[], &options), Err(DrawError::NoPanel));
    let short = Layer::new("area", vec![1.0; 7], Better::Low);
    let panels = [Panel::new(&mesh, "a"), Panel::new(&mesh, "b").coloured(&short)];
    let message = svg(&panels, &options).expect_err("7 values for 8 triangles").to_string();
    assert_eq!(message, "panel 1: layer 'area' has 7 values for 8 triangles (SPEC G2)");
    for (x1, y1) in [(0.0, 1.0), (-1.0, 1.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
        let view = View { x0: 0.0, y0: 0.0, x1, y1 };
        let error = svg(&[Panel::new(&mesh, "a").cropped(view)], &options).expect_err("empty");
        assert!(matches!(error, DrawError::EmptyView { panel: 0, .. }), "{error}");
    }
    for width in [0.0, -5.0, f64::NAN, f64::INFINITY, 1e9] {
        let options = Options { width, ..Options::default() };
        let error = svg(&[Panel::new(&mesh, "a")], &options).expect_err("no page");
        assert!(matches!(error, DrawError::PageSize { .. }), "{error}");
    }
}

// spec: G4
#[test]
fn lines_take_the_same_share_of_every_element_size() {
    // A grid of 300 squares on 928 pixels: edges of 3 and 4.4 pixels; of 30: ten times as long.
    let widths = |side| {
        let mesh = grid(side);
        let svg = draw(Panel::new(&mesh, "grid"));
        let document = Document::parse(&svg).expect("well-formed");
        let lines = document.descendants().filter(|n| n.attribute("stroke") == Some("#16181c"));
        let width = |n: Node<'_, '_>| n.attribute("stroke-width").and_then(|w| w.parse().ok());
        let scale = if svg.contains("scale(0.05)") { 0.05 } else { 0.01 };
        lines.filter_map(width).map(|w: f64| w * scale).collect::<Vec<f64>>()
    };
    for (side, length) in [(300, 3.09), (30, 30.9), (3, 309.0)] {
        for width in widths(side) {
            assert!(width <= 0.7 && width < 0.06 * length, "{width} for edges of {length}");
            assert!(width > 0.02 * length || width > 0.4, "{width} for edges of {length}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    // spec: G6
    #[test]
    fn any_mesh_gives_well_formed_svg(
        points in prop::collection::vec(any::<[f64; 3]>(), 0..8),
        triangles in prop::collection::vec(any::<[u8; 3]>(), 0..8),
        marked in prop::collection::vec(any::<[u8; 2]>(), 0..4),
        values in prop::collection::vec(any::<f64>(), 8),
        label in any::<String>(),
    ) {
        let mesh = MeshData {
            points,
            triangles: triangles.iter().map(|t| t.map(|v| u32::from(v % 10))).collect(),
            edges: marked.iter().map(|e| MarkedEdge { vertices: e.map(|v| u32::from(v % 10)), marker: 0 }).collect(),
            ..MeshData::default()
        };
        let layer = Layer::new(label.clone(), values[..mesh.triangles.len()].to_vec(), Better::High);
        let highlights = [Highlight { label: label.clone(), triangles: vec![0, 9], edges: vec![[0, 1]], vertices: vec![1], ..Highlight::default() }];
        let mut panel = Panel::new(&mesh, label).coloured(&layer);
        panel.highlights = &highlights;
        let svg = draw(panel);
        prop_assert!(Document::parse(&svg).is_ok(), "{svg}");
        for document in Document::parse(&svg).iter() {
            for attribute in document.descendants().flat_map(|n| n.attributes()) {
                prop_assert!(!attribute.value().contains("NaN") && !attribute.value().contains("inf"));
            }
        }
    }
}

#[cfg(feature = "png")]
mod raster {
    use super::*;
    use resvg::tiny_skia::Pixmap;

    fn pixels(panel: Panel<'_>, options: &Options) -> Pixmap {
        let png = png(&[panel], options).expect("fits");
        Pixmap::decode_png(&png).expect("a PNG")
    }

    fn rgb(pixmap: &Pixmap, x: u32, y: u32) -> [u8; 3] {
        let p = pixmap.pixel(x, y).expect("inside").demultiply();
        [p.red(), p.green(), p.blue()]
    }

    // spec: G8
    #[test]
    fn text_is_drawn_without_any_font_of_the_machine() {
        let mesh = grid(1);
        let options = Options { width: 232.0, png_scale: 1.0, ..Options::default() };
        let ink = |caption: &str| {
            let pixmap = pixels(Panel::new(&mesh, caption), &options);
            let inside = (0..33).flat_map(|y| (0..232).map(move |x| (x, y)));
            inside.filter(|&(x, y)| rgb(&pixmap, x, y)[0] < 128).count()
        };
        assert_eq!(ink(""), 0);
        let (short, long) = (ink("a"), ink("a caption of the mesh"));
        assert!(short > 5 && long > 10 * short / 2, "{short} and {long} dark dots");
    }

    #[test]
    fn dots_have_the_colours_of_the_values() {
        let mesh = grid(1);
        let layer = Layer { range: [0.0, 1.0], ..Layer::new("x", vec![0.0, 1.0], Better::Low) };
        let options = Options { width: 232.0, png_scale: 1.0, ..Options::default() };
        let pixmap = pixels(Panel::new(&mesh, "").coloured(&layer), &options);
        // The lower right triangle is the first one.
        assert_eq!(rgb(&pixmap, 16 + 150, 54 + 150), [0xff, 0xff, 0xd9]);
        assert_eq!(rgb(&pixmap, 16 + 50, 54 + 50), [0x25, 0x34, 0x94]);
        assert_eq!(rgb(&pixmap, 2, 2), [255, 255, 255]);
    }

    #[test]
    fn dense_parts_keep_the_tone_of_their_lines() {
        let (coarse, dense) = (grid(60), grid(600));
        let options = Options { width: 232.0, png_scale: 1.0, ..Options::default() };
        let mean = |mesh: &MeshData| {
            let pixmap = pixels(Panel::new(mesh, ""), &options);
            let inside = (60..240).flat_map(|y| (30..200).map(move |x| (x, y)));
            let (sum, n) = inside.fold((0.0, 0.0), |(sum, n), (x, y)| {
                (sum + f64::from(rgb(&pixmap, x, y)[1]), n + 1.0)
            });
            sum / n
        };
        let (coarse, dense) = (mean(&coarse), mean(&dense));
        assert!((coarse - dense).abs() < 14.0 && dense < 235.0, "{coarse} and {dense}");
    }

    #[test]
    fn sizes_follow_the_scale_and_absurd_ones_are_refused() {
        let mesh = grid(1);
        for (png_scale, width) in [(0.5, 116), (1.0, 232), (3.0, 696)] {
            let options = Options { width: 232.0, png_scale, ..Options::default() };
            assert_eq!(pixels(Panel::new(&mesh, ""), &options).width(), width);
        }
        for png_scale in [0.0, -1.0, f32::NAN, 1e6] {
            let options = Options { png_scale, ..Options::default() };
            let error = png(&[Panel::new(&mesh, "")], &options).expect_err("no such scale");
            assert!(matches!(error, DrawError::PageSize { .. }), "{error}");
        }
    }
}
