//! STEP files (with the feature `step`): parts that are written here, and files that lie.
#![cfg(feature = "step")]

use std::collections::BTreeMap;
use std::path::Path;
use trigrade::check::surface::{SurfaceLimits, check_on_model};
use trigrade::format::model_file::ModelForm;
use trigrade::format::step::read;
use trigrade::mesher::Unobserved;
use trigrade::model::{Model, TrimCurve};
use trigrade::surface_mesher::{SurfaceMeshed, SurfaceOptions, mesh_model};

type Point = [f64; 3];

/// Writes the records of a part.
#[derive(Default)]
struct Writer {
    records: Vec<String>,
    vertices: BTreeMap<[u64; 3], usize>,
    edges: BTreeMap<String, usize>,
    faces: Vec<usize>,
}

impl Writer {
    fn add(&mut self, record: impl Into<String>) -> usize {
        self.records.push(record.into());
        self.records.len()
    }

    fn triple(&mut self, kind: &str, p: Point) -> usize {
        // Reals of the format have a point, with an exponent too.
        let real = |x: f64| {
            let text = format!("{x:?}");
            if text.contains('.') { text } else { text.replace('e', ".E") }
        };
        let [x, y, z] = p.map(real);
        self.add(format!("{kind}('',({x},{y},{z}))"))
    }

    fn vertex(&mut self, p: Point) -> usize {
        let key = p.map(f64::to_bits);
        if let Some(&id) = self.vertices.get(&key) {
            return id;
        }
        let point = self.triple("CARTESIAN_POINT", p);
        let id = self.add(format!("VERTEX_POINT('',#{point})"));
        self.vertices.insert(key, id);
        id
    }

    fn frame(&mut self, origin: Point, z: Point, x: Point) -> usize {
        let origin = self.triple("CARTESIAN_POINT", origin);
        let [z, x] = [z, x].map(|way| self.triple("DIRECTION", way));
        self.add(format!("AXIS2_PLACEMENT_3D('',#{origin},#{z},#{x})"))
    }

    /// An edge; asked for the second time it is the same.
    fn edge(
        &mut self,
        name: &str,
        ends: [Point; 2],
        curve: impl FnOnce(&mut Self) -> usize,
    ) -> usize {
        if let Some(&id) = self.edges.get(name) {
            return id;
        }
        let [a, b] = ends.map(|p| self.vertex(p));
        let curve = curve(self);
        let id = self.add(format!("EDGE_CURVE('',#{a},#{b},#{curve},.T.)"));
        self.edges.insert(name.to_owned(), id);
        id
    }

    fn line(&mut self, a: Point, b: Point) -> (usize, bool) {
        let is_swapped = a > b;
        let ends = if is_swapped { [b, a] } else { [a, b] };
        let id = self.edge(&format!("{ends:?}"), ends, |w| {
            let point = w.triple("CARTESIAN_POINT", ends[0]);
            let way = [0, 1, 2].map(|i| ends[1][i] - ends[0][i]);
            let way = w.triple("DIRECTION", way);
            let vector = w.add(format!("VECTOR('',#{way},1.)"));
            w.add(format!("LINE('',#{point},#{vector})"))
        });
        (id, !is_swapped)
    }

    /// The circle about the z axis through (radius, 0, z).
    fn circle(&mut self, radius: f64, z: f64) -> usize {
        let at = [radius, 0.0, z];
        self.edge(&format!("circle {radius} {z}"), [at, at], |w| {
            let frame = w.frame([0.0, 0.0, z], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
            w.add(format!("CIRCLE('',#{frame},{radius:?})"))
        })
    }

    fn face(&mut self, surface: usize, loops: &[Vec<(usize, bool)>]) {
        let mut bounds = Vec::new();
        if loops.is_empty() {
            let vertex = self.vertex([0.0, 0.0, -1.0]);
            let path = self.add(format!("VERTEX_LOOP('',#{vertex})"));
            bounds.push(self.add(format!("FACE_BOUND('',#{path},.T.)")));
        }
        for edges in loops {
            let mut list = Vec::new();
            for &(edge, forward) in edges {
                let sense = if forward { ".T." } else { ".F." };
                list.push(self.add(format!("ORIENTED_EDGE('',*,*,#{edge},{sense})")));
            }
            let path = self.add(format!("EDGE_LOOP('',{})", references(&list)));
            bounds.push(self.add(format!("FACE_BOUND('',#{path},.T.)")));
        }
        let face = self.add(format!("ADVANCED_FACE('',{},#{surface},.T.)", references(&bounds)));
        self.faces.push(face);
    }

    fn plane(&mut self, origin: Point, z: Point, x: Point, loops: &[Vec<(usize, bool)>]) {
        let frame = self.frame(origin, z, x);
        let plane = self.add(format!("PLANE('',#{frame})"));
        self.face(plane, loops);
    }

    /// A surface about the z axis.
    fn round(&mut self, kind: &str, z: f64, numbers: &str) -> usize {
        let frame = self.frame([0.0, 0.0, z], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        self.add(format!("{kind}('',#{frame},{numbers})"))
    }

    /// A B-spline curve, rational if it has weights, or a surface of rows of points with u constant.
    fn spline_curve(
        &mut self,
        degree: usize,
        points: &[Point],
        knots: &str,
        weights: &str,
    ) -> usize {
        let ids: Vec<usize> = points.iter().map(|&p| self.triple("CARTESIAN_POINT", p)).collect();
        let ids = references(&ids);
        self.add(match weights {
            "" => format!(
                "B_SPLINE_CURVE_WITH_KNOTS('',{degree},{ids},.UNSPECIFIED.,.F.,.F.,{knots},.UNSPECIFIED.)"
            ),
            weights => format!(
                "( BOUNDED_CURVE() B_SPLINE_CURVE({degree},{ids},.UNSPECIFIED.,.F.,.F.) \
                 B_SPLINE_CURVE_WITH_KNOTS({knots},.UNSPECIFIED.) CURVE() \
                 GEOMETRIC_REPRESENTATION_ITEM() RATIONAL_B_SPLINE_CURVE({weights}) \
                 REPRESENTATION_ITEM('') )"
            ),
        })
    }

    fn spline_surface(
        &mut self,
        degrees: [usize; 2],
        rows: &[Vec<Point>],
        knots: [&str; 2],
        weights: &str,
    ) -> usize {
        let row = |w: &mut Self, row: &Vec<Point>| {
            let ids: Vec<usize> = row.iter().map(|&p| w.triple("CARTESIAN_POINT", p)).collect();
            references(&ids)
        };
        let rows: Vec<String> = rows.iter().map(|r| row(self, r)).collect();
        let (rows, [p, q]) = (rows.join(","), degrees);
        let split = |knots: &str| {
            let (times, values) = knots.split_once("),").expect("two lists");
            (format!("{times})"), values.to_owned())
        };
        let ((ut, uv), (vt, vv)) = (split(knots[0]), split(knots[1]));
        let knots = format!("{ut},{vt},{uv},{vv},.UNSPECIFIED.");
        let flags = ".UNSPECIFIED.,.F.,.F.,.F.";
        self.add(match weights {
            "" => format!("B_SPLINE_SURFACE_WITH_KNOTS('',{p},{q},({rows}),{flags},{knots})"),
            weights => format!(
                "( BOUNDED_SURFACE() B_SPLINE_SURFACE({p},{q},({rows}),{flags}) \
                 B_SPLINE_SURFACE_WITH_KNOTS({knots}) GEOMETRIC_REPRESENTATION_ITEM() \
                 RATIONAL_B_SPLINE_SURFACE({weights}) REPRESENTATION_ITEM('') SURFACE() )"
            ),
        })
    }

    fn text(&self) -> String {
        let mut text =
            "ISO-10303-21;\nHEADER;\nFILE_NAME('a;b''c','',(''),(''),'','','');\nENDSEC;\nDATA;\n"
                .to_owned();
        for (i, record) in self.records.iter().enumerate() {
            text += &format!("#{} = {record};\n", i + 1);
        }
        let count = self.records.len();
        text += "/* the shell; and the unit */\n";
        text += &format!("#{} = CLOSED_SHELL('',{});\n", count + 1, references(&self.faces));
        text += &format!(
            "#{} = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );\n",
            count + 2
        );
        text + "ENDSEC;\nEND-ISO-10303-21;\n"
    }
}

fn references(ids: &[usize]) -> String {
    let list: Vec<String> = ids.iter().map(|id| format!("#{id}")).collect();
    format!("({})", list.join(","))
}

fn cube() -> Writer {
    let mut writer = Writer::default();
    for axis in 0..3 {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        for level in [0.0, 1.0] {
            let at = |a: f64, b: f64| {
                let mut p = [0.0; 3];
                (p[axis], p[i], p[j]) = (level, a, b);
                p
            };
            let corners = [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)];
            let path = (0..4).map(|k| writer.line(corners[k], corners[(k + 1) % 4])).collect();
            let (mut z, mut x) = ([0.0; 3], [0.0; 3]);
            (z[axis], x[i]) = (1.0, 1.0);
            writer.plane(corners[0], z, x, &[path]);
        }
    }
    writer
}

/// Turned about the z axis: walls between circles, with a seam, and a disc at both ends.
fn turned(kind: &str, rims: [(f64, f64); 2], place: (f64, &str)) -> Writer {
    let mut writer = Writer::default();
    let [low, high] = rims.map(|(radius, z)| writer.circle(radius, z));
    let [a, b] = rims.map(|(radius, z)| [radius, 0.0, z]);
    let (seam, forward) = writer.line(a, b);
    let wall = writer.round(kind, place.0, place.1);
    let path = vec![(low, true), (seam, forward), (high, false), (seam, !forward)];
    writer.face(wall, &[path]);
    for (circle, (_, z)) in [low, high].into_iter().zip(rims) {
        writer.plane([0.0, 0.0, z], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], &[vec![(circle, true)]]);
    }
    writer
}

fn cylinder() -> Writer {
    turned("CYLINDRICAL_SURFACE", [(1.0, 0.0), (1.0, 2.0)], (0.5, "1."))
}

fn model(text: &str) -> Model {
    read(text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

fn complaint(text: &str) -> String {
    read(text.as_bytes()).expect_err("a broken file").to_string()
}

/// Meshes and checks; the mesh is closed, with this Euler number.
fn meshed(model: &Model, euler: i64) -> SurfaceMeshed {
    let mut options = SurfaceOptions::default();
    options.common.spacing = Some(0.3);
    let meshed = mesh_model(model, &options, &mut Unobserved).expect("a mesh");
    let limits = SurfaceLimits::default();
    let (report, found) = check_on_model(&meshed.mesh, (model, &limits), None, &Default::default());
    assert!(report.passed(), "{:?}", report.findings);
    assert_eq!(found.euler, found.euler_of_model);
    let mut sides = BTreeMap::new();
    for &[a, b, c] in &meshed.mesh.triangles {
        for [a, b] in [[a, b], [b, c], [c, a]] {
            *sides.entry([a.min(b), a.max(b)]).or_insert(0) += 1;
        }
    }
    assert!(sides.values().all(|&n| n == 2), "the mesh is open");
    let mut used: Vec<u32> = meshed.mesh.triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let count = used.len() as i64 - sides.len() as i64 + meshed.mesh.triangles.len() as i64;
    assert_eq!(count, euler);
    meshed
}

/// Volume inside a mesh that faces outwards.
fn volume(meshed: &SurfaceMeshed) -> f64 {
    let points = &meshed.mesh.points;
    let six = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| {
            let p = &points[i as usize];
            [p[0], p[1], p[2]]
        });
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    meshed.mesh.triangles.iter().map(six).sum::<f64>() / 6.0
}

// spec: X72
#[test]
fn a_cube_is_closed_and_its_edges_are_one_curve_each() {
    let model = model(&cube().text());
    assert_eq!(model.patches.len(), 6);
    let mut curves: Vec<_> = Vec::new();
    for curve in model.trims.values().flat_map(|trim| trim.loops().flatten()) {
        let TrimCurve::Space { curve, .. } = curve else { panic!("a curve in space") };
        if !curves.iter().any(|known: &&trigrade::curve::Curve| known.same_as(curve).is_some()) {
            curves.push(curve);
        }
    }
    assert_eq!(curves.len(), 12);
    assert!((volume(&meshed(&model, 2)) - 1.0).abs() < 1e-12);
}

// spec: X72
#[test]
fn cylinders_and_cones_with_seams_are_closed() {
    let volume_of = |writer: &Writer| volume(&meshed(&model(&writer.text()), 2));
    let pi = std::f64::consts::PI;
    let found = volume_of(&cylinder());
    assert!((found / (2.0 * pi) - 1.0).abs() < 0.03, "{found}");
    let slope = format!("1.,{:?}", libm::atan(-0.25));
    let cone = turned("CONICAL_SURFACE", [(1.0, 0.0), (0.5, 2.0)], (0.0, &slope));
    let found = volume_of(&cone);
    assert!((found / (7.0 / 6.0 * pi) - 1.0).abs() < 0.03, "{found}");
}

// spec: X72
#[test]
fn spheres_and_tori_bounded_by_a_vertex_are_whole() {
    for (kind, numbers, euler) in
        [("SPHERICAL_SURFACE", "1.", 2), ("TOROIDAL_SURFACE", "2.,0.6", 0)]
    {
        let mut writer = Writer::default();
        let surface = writer.round(kind, 0.0, numbers);
        writer.face(surface, &[]);
        meshed(&model(&writer.text()), euler);
    }
}

// spec: X72
#[test]
fn a_half_ball_from_its_rim_to_its_pole_is_closed() {
    let mut writer = Writer::default();
    let circle = writer.circle(1.0, 0.0);
    let seam = writer.edge("seam", [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], |w| {
        let frame = w.frame([0.0; 3], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]);
        w.add(format!("CIRCLE('',#{frame},1.)"))
    });
    let wall = writer.round("SPHERICAL_SURFACE", 0.0, "1.");
    writer.face(wall, &[vec![(circle, true), (seam, true), (seam, false)]]);
    writer.plane([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], &[vec![(circle, true)]]);
    let found = volume(&meshed(&model(&writer.text()), 2));
    assert!((found / (2.0 / 3.0 * std::f64::consts::PI) - 1.0).abs() < 0.05, "{found}");
}

// spec: X72
#[test]
fn names_units_and_extensions_are_as_the_chapter_says() {
    let model = model(&cylinder().text());
    assert!(model.patches[0].name.starts_with('#') && model.patches[0].marker == 1);
    assert!(model.notes[0].contains("millimetres"), "{:?}", model.notes);
    for name in ["a.step", "a.STP", "a.p21"] {
        assert_eq!(ModelForm::of(Path::new(name), b""), Some(ModelForm::Step), "{name}");
    }
    assert_eq!(ModelForm::from_name("step"), Some(ModelForm::Step));
}

// spec: X73
#[test]
fn what_is_not_read_is_named_with_its_face_and_line() {
    let text = cylinder().text();
    let told = complaint(&text.replace("CYLINDRICAL_SURFACE", "OFFSET_SURFACE"));
    for part in ["line ", "face 1: #", "(OFFSET_SURFACE)", "is not read", "cylinders", "extrusion"]
    {
        assert!(told.contains(part), "{told}");
    }
    let told = complaint(&text.replace("CIRCLE(", "HYPERBOLA("));
    assert!(told.contains("(HYPERBOLA)") && told.contains("circles"), "{told}");
    let told = complaint(&text.replace("/* the", "#9999 = MAPPED_ITEM('',#1,#2);\n/* the"));
    assert!(told.contains("REPRESENTATION_MAP should be here"), "{told}");
}

// spec: X73
#[test]
fn a_file_without_a_shell_is_refused() {
    let told = complaint(&cube().text().replace("CLOSED_SHELL", "GROUP"));
    assert!(told.contains("no shell"), "{told}");
}

// spec: X74
#[test]
fn truncated_files_are_refused_wherever_they_end() {
    let text = cylinder().text();
    for end in (0..text.len() - 2).step_by(7) {
        assert!(read(&text.as_bytes()[..end]).is_err(), "cut at {end}");
    }
    assert!(complaint(&text[..text.len() / 2]).contains("ends"));
}

// spec: X74
#[test]
fn garbage_is_refused_without_a_panic() {
    for text in
        ["", "garbage", "ISO-10303-21;", "ISO-10303-21;DATA;#1=(((;ENDSEC;END-ISO-10303-21;"]
    {
        assert!(read(text.as_bytes()).is_err(), "{text}");
    }
    assert!(read(&[0xff, 0xfe, 0x00]).is_err());
    let deep = format!("ISO-10303-21;DATA;#1=A({}", "(".repeat(1 << 20));
    assert!(complaint(&deep).contains("deep"));
    let twice = cube().text().replace("#2 =", "#1 =");
    assert!(complaint(&twice).contains("twice"));
    let own = cube().text().replace("#1 = CARTESIAN_POINT", "#1 = DIRECTION");
    assert!(complaint(&own).contains("CARTESIAN_POINT"));
}

// spec: X74
#[test]
fn any_changed_byte_gives_a_model_or_an_error() {
    let text = cylinder().text();
    for i in (0..text.len()).step_by(5) {
        for byte in *b"#(9;'*" {
            let mut bytes = text.clone().into_bytes();
            bytes[i] = byte;
            let _ = read(&bytes).map(|model| model.diagonal());
        }
    }
}

/// Meshes an open part and checks it; its Euler number is 1.
fn open(model: &Model, spacing: f64) -> SurfaceMeshed {
    let mut options = SurfaceOptions::default();
    options.common.spacing = Some(spacing);
    let meshed = mesh_model(model, &options, &mut Unobserved).expect("a mesh");
    let limits = SurfaceLimits::default();
    let (report, found) = check_on_model(&meshed.mesh, (model, &limits), None, &Default::default());
    assert!(report.passed(), "{:?}", report.findings);
    assert_eq!((found.euler, found.euler_of_model), (1, 1));
    meshed
}

fn area(meshed: &SurfaceMeshed) -> f64 {
    let points = &meshed.mesh.points;
    let of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| points[v as usize]);
        let (p, q) = (std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i]));
        trigrade::vector::norm(trigrade::vector::cross(p, q)) / 2.0
    };
    meshed.mesh.triangles.iter().map(of).sum()
}

/// Knots 0 and 1 of a Bezier curve.
fn bezier_knots(degree: usize) -> String {
    format!("({0},{0}),(0.,1.)", degree + 1)
}

// spec: X75
#[test]
fn a_bicubic_surface_bounded_by_b_splines_has_its_points() {
    let height =
        |i: usize, j: usize| if (1..3).contains(&i) && (1..3).contains(&j) { 1.0 } else { 0.0 };
    let rows: Vec<Vec<Point>> =
        (0..4).map(|i| (0..4).map(|j| [i as f64, j as f64, height(i, j)]).collect()).collect();
    let mut writer = Writer::default();
    let knots = bezier_knots(3);
    let surface = writer.spline_surface([3, 3], &rows, [&knots, &knots], "");
    let sides = [
        (0..4).map(|i| rows[i][0]).collect::<Vec<_>>(),
        rows[3].clone(),
        (0..4).map(|i| rows[3 - i][3]).collect(),
        rows[0].iter().rev().copied().collect(),
    ];
    let mut path = Vec::new();
    for (k, points) in sides.iter().enumerate() {
        let edge = writer.edge(&format!("side {k}"), [points[0], points[3]], |w| {
            w.spline_curve(3, points, &knots, "")
        });
        path.push((edge, true));
    }
    writer.face(surface, &[path]);
    let model = model(&writer.text());
    // The middle: (9/16)^2 of the inner height.
    let meshed = open(&model, 0.25);
    let top = meshed.mesh.points.iter().map(|p| p[2]).fold(0.0, f64::max);
    assert!((top - 0.5625).abs() < 0.01, "{top}");
}

// spec: X75
#[test]
fn a_rational_quarter_of_a_cylinder_has_its_area_and_its_trim() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let arc = |z: f64| vec![[1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]];
    let (low, high) = (arc(0.0), arc(2.0));
    let rows: Vec<Vec<Point>> = (0..3).map(|i| vec![low[i], high[i]]).collect();
    let weights = format!("(1.,{half:?},1.)");
    let grid = format!("((1.,1.),({half:?},{half:?}),(1.,1.))");
    let mut writer = Writer::default();
    let (round, straight) = (bezier_knots(2), bezier_knots(1));
    let surface = writer.spline_surface([2, 1], &rows, [&round, &straight], &grid);
    let mut rim = |name: &str, points: &[Point]| {
        let ends = [points[0], points[2]];
        (writer.edge(name, ends, |w| w.spline_curve(2, points, &round, &weights)), true)
    };
    let (south, north) = (rim("low", &low), rim("high", &high));
    let (east, up) = writer.line(low[2], high[2]);
    let (west, back) = writer.line(low[0], high[0]);
    writer.face(surface, &[vec![south, (east, up), (north.0, false), (west, !back)]]);
    let found = area(&open(&model(&writer.text()), 0.1));
    assert!((found / std::f64::consts::PI - 1.0).abs() < 2e-3, "{found}");
}

// spec: X75
#[test]
fn knots_of_full_multiplicity_that_bend_are_refused_and_smooth_ones_are_read() {
    let sheet = |lift: f64| {
        let x = [0.0, 1.0, 2.0, 3.0, 4.0];
        let z = [0.0, 0.5, 1.0, 1.5 - lift, 2.0 - 2.0 * lift];
        let rows: Vec<Vec<Point>> =
            (0..5).map(|i| vec![[x[i], 0.0, z[i]], [x[i], 2.0, z[i]]]).collect();
        let mut writer = Writer::default();
        let knots = "(3,2,3),(0.,0.5,1.)";
        let surface = writer.spline_surface([2, 1], &rows, [knots, &bezier_knots(1)], "");
        let side = |j: usize| rows.iter().map(|row| row[j]).collect::<Vec<Point>>();
        let mut edge = |name: &str, j: usize| {
            let points = side(j);
            writer.edge(name, [points[0], points[4]], |w| w.spline_curve(2, &points, knots, ""))
        };
        let (south, north) = (edge("south", 0), edge("north", 1));
        let (east, up) = writer.line(rows[4][0], rows[4][1]);
        let (west, back) = writer.line(rows[0][0], rows[0][1]);
        writer.face(surface, &[vec![(south, true), (east, up), (north, false), (west, !back)]]);
        model(&writer.text())
    };
    let flat = area(&open(&sheet(0.0), 0.3));
    assert!((flat - 2.0 * 20.0_f64.sqrt()).abs() < 1e-9, "{flat}");
    let mut options = SurfaceOptions::default();
    options.common.spacing = Some(0.3);
    let error = mesh_model(&sheet(0.5), &options, &mut Unobserved).expect_err("a crease");
    assert!(error.to_string().contains("creases"), "{error}");
}

/// A part swept from a circle of radius 1, by hand: its wall, and a disc at both ends.
fn pulled(kind: &str) -> Writer {
    let mut writer = Writer::default();
    let [low, high] = [0.0, 2.0].map(|z| writer.circle(1.0, z));
    let (seam, forward) = writer.line([1.0, 0.0, 0.0], [1.0, 0.0, 2.0]);
    let wall = match kind {
        "SURFACE_OF_LINEAR_EXTRUSION" => {
            let frame = writer.frame([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
            let circle = writer.add(format!("CIRCLE('',#{frame},1.)"));
            let way = writer.triple("DIRECTION", [0.0, 0.0, 3.0]);
            let way = writer.add(format!("VECTOR('',#{way},1.)"));
            writer.add(format!("{kind}('',#{circle},#{way})"))
        }
        _ => {
            let points = [[1.0, 0.0, 0.0], [1.0, 0.0, 1.0], [1.0, 0.0, 2.0]];
            let profile = writer.spline_curve(2, &points, &bezier_knots(2), "");
            let origin = writer.triple("CARTESIAN_POINT", [0.0, 0.0, 5.0]);
            let axis = writer.triple("DIRECTION", [0.0, 0.0, 1.0]);
            let axis = writer.add(format!("AXIS1_PLACEMENT('',#{origin},#{axis})"));
            writer.add(format!("{kind}('',#{profile},#{axis})"))
        }
    };
    let path = vec![(low, true), (seam, forward), (high, false), (seam, !forward)];
    writer.face(wall, &[path]);
    for (circle, z) in [(low, 0.0), (high, 2.0)] {
        writer.plane([0.0, 0.0, z], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], &[vec![(circle, true)]]);
    }
    writer
}

// spec: X76
#[test]
fn surfaces_of_extrusion_and_of_revolution_are_closed_with_their_volume() {
    for kind in ["SURFACE_OF_LINEAR_EXTRUSION", "SURFACE_OF_REVOLUTION"] {
        let found = volume(&meshed(&model(&pulled(kind).text()), 2));
        assert!((found / std::f64::consts::TAU - 1.0).abs() < 0.03, "{kind}: {found}");
    }
}

// spec: X76
#[test]
fn a_line_that_turns_and_one_pulled_along_itself_are_named() {
    let text = pulled("SURFACE_OF_REVOLUTION").text();
    let at = text.find("B_SPLINE_CURVE_WITH_KNOTS").expect("a profile");
    let end = at + text[at..].find(";").expect("its end");
    let line = text.lines().find(|line| line.contains("= LINE(")).expect("a line");
    let line = line.split_once("= ").expect("a record").1.trim_end_matches(';');
    let told = complaint(&format!("{}{line}{}", &text[..at], &text[end..]));
    assert!(told.contains("a line that turns") && told.contains("cone"), "{told}");
}

// spec: X77 S37
#[test]
fn a_cone_from_its_rim_to_its_apex_is_closed_and_so_is_half_of_one() {
    let (tip, a, b) = ([0.0, 0.0, 2.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    let slope = format!("1.,{:?}", libm::atan(-0.5));
    let mut writer = Writer::default();
    let circle = writer.circle(1.0, 0.0);
    let (seam, up) = writer.line(a, tip);
    let wall = writer.round("CONICAL_SURFACE", 0.0, &slope);
    writer.face(wall, &[vec![(circle, true), (seam, up), (seam, !up)]]);
    writer.plane([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], &[vec![(circle, true)]]);
    let found = volume(&meshed(&model(&writer.text()), 2));
    assert!((found / (2.0 / 3.0 * std::f64::consts::PI) - 1.0).abs() < 0.05, "{found}");
    // Half of it: the loop of the wall goes through the apex.
    let mut writer = Writer::default();
    let arc = writer.edge("arc", [a, b], |w| {
        let frame = w.frame([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        w.add(format!("CIRCLE('',#{frame},1.)"))
    });
    let [(first, up), (second, down)] = [writer.line(a, tip), writer.line(b, tip)];
    let (base, along) = writer.line(b, a);
    let wall = writer.round("CONICAL_SURFACE", 0.0, &slope);
    writer.face(wall, &[vec![(arc, true), (second, down), (first, !up)]]);
    writer.plane([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], &[vec![(arc, true), (base, along)]]);
    let path = vec![(base, along), (first, up), (second, !down)];
    writer.plane([0.0; 3], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], &[path]);
    let found = volume(&meshed(&model(&writer.text()), 2));
    assert!((found / (std::f64::consts::PI / 3.0) - 1.0).abs() < 0.05, "{found}");
}

// spec: X78
#[test]
fn an_edge_is_a_whole_circle_when_its_vertices_are_one_however_near_two_may_be() {
    // All but 6e-10 of a circle, between two vertices: no whole one.
    let mut writer = Writer::default();
    let angle = 6e-10_f64;
    let ends = [[libm::cos(angle), libm::sin(angle), 0.0], [1.0, 0.0, 0.0]];
    let arc = writer.edge("arc", ends, |w| {
        let frame = w.frame([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        w.add(format!("CIRCLE('',#{frame},1.)"))
    });
    let (gap, forward) = writer.line(ends[1], ends[0]);
    writer.plane([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], &[vec![(arc, true), (gap, forward)]]);
    let model = model(&writer.text());
    let trim = &model.trims[&0];
    let curve = |i: usize| match &trim.outline.as_ref().expect("one")[i] {
        TrimCurve::Space { curve, .. } => curve.clone(),
        TrimCurve::Parameters { .. } => panic!("a curve in space"),
    };
    assert_eq!(curve(0).ends(), ends, "the two vertices are kept apart");
    assert!(!curve(0).is_closed());
}

/// A cube whose shell stands in an assembly: its placements, each moving it along x.
fn assembled(shifts: &[f64]) -> String {
    let mut writer = cube();
    let origin = writer.frame([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
    let shell = writer.records.len();
    let faces = references(&writer.faces);
    let shell = writer.add(format!("CLOSED_SHELL('',{faces})")).max(shell);
    let solid = writer.add(format!("MANIFOLD_SOLID_BREP('',#{shell})"));
    let part = writer.add(format!("ADVANCED_BREP_SHAPE_REPRESENTATION('',(#{solid}),#1)"));
    let whole = writer.add(format!("SHAPE_REPRESENTATION('',(#{origin}),#1)"));
    for (i, &x) in shifts.iter().enumerate() {
        let target = writer.frame([x, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]);
        let map = match i % 2 {
            0 => {
                let map =
                    writer.add(format!("ITEM_DEFINED_TRANSFORMATION('','',#{origin},#{target})"));
                format!(
                    "( REPRESENTATION_RELATIONSHIP('','',#{part},#{whole}) \
                     REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{map}) \
                     SHAPE_REPRESENTATION_RELATIONSHIP() )"
                )
            }
            _ => {
                let map = writer.add(format!("REPRESENTATION_MAP(#{origin},#{part})"));
                let item = writer.add(format!("MAPPED_ITEM('',#{map},#{target})"));
                format!("SHAPE_REPRESENTATION('',(#{item}),#1)")
            }
        };
        writer.add(map);
    }
    // The writer's own shell goes: it has the same faces.
    let text = writer.text();
    let last = text.rfind("= CLOSED_SHELL").expect("a shell");
    format!("{}= GROUP{}", &text[..last], &text[last + "= CLOSED_SHELL".len()..])
}

// spec: X79
#[test]
fn a_part_of_an_assembly_is_read_in_each_of_its_places() {
    let model = model(&assembled(&[3.0, -4.0]));
    assert_eq!(model.patches.len(), 12);
    assert!(model.patches[6].name.ends_with("in place 2"), "{}", model.patches[6].name);
    let mut options = SurfaceOptions::default();
    options.common.spacing = Some(0.5);
    let meshed = mesh_model(&model, &options, &mut Unobserved).expect("a mesh");
    assert!((volume(&meshed) - 2.0).abs() < 1e-12);
    let xs = meshed.mesh.points.iter().map(|p| p[0]);
    let (low, high) = xs.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
    // A quarter turn about z takes the cube to x from shift - 1 to shift.
    assert!((low + 5.0).abs() < 1e-12 && (high - 3.0).abs() < 1e-12, "{low} {high}");
}

// spec: X79
#[test]
fn a_part_that_stands_in_itself_is_refused() {
    let text = assembled(&[1.0]);
    let whole = text.find("= SHAPE_REPRESENTATION('',").expect("the whole");
    let start = text[..whole].rfind('#').expect("its number");
    let number = text[start..whole].trim_end_matches([' ', '=']);
    let relation = text.find("REPRESENTATION_RELATIONSHIP('','',#").expect("a relation");
    let from = relation + "REPRESENTATION_RELATIONSHIP('','',".len();
    let to = from + text[from..].find(',').expect("the part");
    let part = text[from..to].to_owned();
    let looped = text.replacen(&format!("{part},{number})"), &format!("{part},{part})"), 1);
    assert_ne!(looped, text);
    assert!(complaint(&looped).contains("in itself"), "{}", complaint(&looped));
}
