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

    fn triple(&mut self, kind: &str, [x, y, z]: Point) -> usize {
        self.add(format!("{kind}('',({x:?},{y:?},{z:?}))"))
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
    for part in ["line ", "face 1: #", "(OFFSET_SURFACE)", "is not read", "cylinders", "extrusion"] {
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
