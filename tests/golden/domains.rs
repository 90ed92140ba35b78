//! The golden domains: made by formulas, committed as small files in the forms that users write.

use std::f64::consts::PI;
use trigrade::domain::naca::symmetric_section;
use trigrade::point::Point2;

/// How a golden domain is written down.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Triangle's .poly.
    Poly,
    /// The plain JSON layout: outer, holes, polygons.
    Json,
    /// A UIUC airfoil in Selig's order.
    Dat,
}

/// A domain: outer rings and their holes as rings, a point in each hole, and interior constraints.
#[derive(Default)]
pub struct Shape {
    /// Each piece is an outer ring followed by its holes.
    pub pieces: Vec<Vec<Ring>>,
    /// One point inside each hole.
    pub hole_points: Vec<[f64; 2]>,
    /// Interior segments.
    pub segments: Vec<[[f64; 2]; 2]>,
    /// Isolated points.
    pub points: Vec<[f64; 2]>,
}

type Ring = Vec<[f64; 2]>;

/// A domain of the golden set.
pub struct Golden {
    /// Stem of the file names.
    pub name: &'static str,
    /// How the domain is written.
    pub form: Form,
    /// Options of `trigrade mesh`.
    pub options: &'static [&'static str],
    /// No triangle's R / 2r may be above this.
    pub aspect_max: f64,
    /// Makes it.
    pub shape: fn() -> Shape,
}

/// All of them.
pub const GOLDENS: [Golden; 14] = [
    golden("airfoil", Form::Poly, &[], 1.15, airfoil),
    golden("airfoil_section", Form::Dat, &["--farfield", "4,20"], 1.15, section),
    golden("three_element", Form::Poly, &[], 1.2, three_element),
    golden("plate_with_holes", Form::Json, &[], 1.2, plate_with_holes),
    golden("gear", Form::Json, &[], 1.25, gear),
    golden("l_shape", Form::Poly, &["--gradation", "uniform"], 1.07, l_shape),
    golden("narrow_channel", Form::Poly, &[], 1.45, narrow_channel),
    golden("spiral", Form::Poly, &[], 2.2, spiral),
    golden("comb", Form::Poly, &["--method", "afm"], 1.25, comb),
    golden("star", Form::Json, &[], 2.05, star),
    golden("nested_islands", Form::Json, &["--method", "direct"], 1.2, nested_islands),
    // The boundary is not split: fans at the corners of its long edges are the best there is.
    golden("jump", Form::Poly, &[], 5.5, jump),
    golden("constrained", Form::Poly, &["--gradation", "mean", "--clamp", "1.5"], 2.5, constrained),
    golden("background", Form::Poly, &["--method", "delaunay-initial"], 18.0, plate_with_holes),
];

const fn golden(
    name: &'static str,
    form: Form,
    options: &'static [&'static str],
    aspect_max: f64,
    shape: fn() -> Shape,
) -> Golden {
    Golden { name, form, options, aspect_max, shape }
}

impl Golden {
    /// Name of the domain file.
    pub fn file_name(&self) -> String {
        let extension = match self.form {
            Form::Poly => "poly",
            Form::Json => "json",
            Form::Dat => "dat",
        };
        format!("{}.{extension}", self.name)
    }

    /// The domain file's text.
    pub fn text(&self) -> String {
        let shape = (self.shape)();
        match self.form {
            Form::Poly => poly(&shape),
            Form::Json => json(&shape),
            Form::Dat => dat(self.name, &shape),
        }
    }
}

/// Six decimals: short files, and far coarser than any rounding of the formulas.
fn rounded([x, y]: [f64; 2]) -> [f64; 2] {
    // Adding 0.0 turns -0.0 into 0.0.
    [x, y].map(|v| (v * 1e6).round() / 1e6 + 0.0)
}

fn poly(shape: &Shape) -> String {
    let rings: Vec<&Ring> = shape.pieces.iter().flatten().collect();
    let mut points: Vec<[f64; 2]> = rings.iter().flat_map(|ring| ring.iter().copied()).collect();
    let mut segments = Vec::new();
    let mut first = 1;
    for (marker, ring) in (1..).zip(&rings) {
        let n = ring.len();
        segments.extend((0..n).map(|i| (first + i, first + (i + 1) % n, marker)));
        first += n;
    }
    for ends in &shape.segments {
        segments.push((points.len() + 1, points.len() + 2, 100));
        points.extend(ends);
    }
    points.extend(&shape.points);
    let mut text = format!("# vertices\n{} 2 0 0\n", points.len());
    for (i, point) in (1..).zip(&points) {
        let [x, y] = rounded(*point);
        text += &format!("{i} {x} {y}\n");
    }
    text += &format!("# segments\n{} 1\n", segments.len());
    for (i, (a, b, marker)) in (1..).zip(&segments) {
        text += &format!("{i} {a} {b} {marker}\n");
    }
    text += &format!("# holes\n{}\n", shape.hole_points.len());
    for (i, point) in (1..).zip(&shape.hole_points) {
        let [x, y] = rounded(*point);
        text += &format!("{i} {x} {y}\n");
    }
    text
}

fn json(shape: &Shape) -> String {
    let ring = |ring: &Ring| {
        let points: Vec<String> = ring
            .iter()
            .map(|&point| {
                let [x, y] = rounded(point);
                format!("[{x}, {y}]")
            })
            .collect();
        // Four points a line.
        let lines: Vec<String> = points.chunks(4).map(|chunk| chunk.join(", ")).collect();
        format!("[{}]", lines.join(",\n  "))
    };
    let piece = |rings: &Vec<Ring>| {
        let holes: Vec<String> = rings[1..].iter().map(ring).collect();
        format!("\"outer\": {},\n \"holes\": [{}]", ring(&rings[0]), holes.join(",\n "))
    };
    match &shape.pieces[..] {
        [only] => format!("{{{}}}\n", piece(only)),
        pieces => {
            let list: Vec<String> = pieces.iter().map(|p| format!("{{{}}}", piece(p))).collect();
            format!("{{\"polygons\": [{}]}}\n", list.join(",\n"))
        }
    }
}

fn dat(name: &str, shape: &Shape) -> String {
    let mut text = format!("{name}\n");
    for point in &shape.pieces[0][0] {
        let [x, y] = rounded(*point);
        text += &format!(" {x:.6} {y:.6}\n");
    }
    text
}

fn polar(centre: [f64; 2], radius: f64, angle: f64) -> [f64; 2] {
    [centre[0] + radius * libm::cos(angle), centre[1] + radius * libm::sin(angle)]
}

fn circle(centre: [f64; 2], radius: f64, points: u32) -> Ring {
    (0..points).map(|i| polar(centre, radius, turn(i, points))).collect()
}

/// The i-th of n equal parts of a full turn.
fn turn(i: u32, n: u32) -> f64 {
    2.0 * PI * f64::from(i) / f64::from(n)
}

/// The closed polygon through `corners` with each side cut into pieces of about `length`.
fn polygon(corners: &[[f64; 2]], length: f64) -> Ring {
    let n = corners.len();
    (0..n).flat_map(|i| side(corners[i], corners[(i + 1) % n], length)).collect()
}

/// From a to b, without b, in equal pieces of about `length`.
fn side(a: [f64; 2], b: [f64; 2], length: f64) -> Ring {
    let whole = Point2::from(a).distance(Point2::from(b));
    let pieces = (whole / length).round().max(1.0) as u32;
    let at = |i| f64::from(i) / f64::from(pieces);
    (0..pieces).map(|i| [a[0] + at(i) * (b[0] - a[0]), a[1] + at(i) * (b[1] - a[1])]).collect()
}

fn rectangle([x0, y0]: [f64; 2], [x1, y1]: [f64; 2], length: f64) -> Ring {
    polygon(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]], length)
}

/// A NACA 0012 section of the given chord, turned clockwise by `down` degrees about its nose.
fn element(nose: [f64; 2], chord: f64, down: f64, points: u32) -> Ring {
    let (sin, cos) = libm::sincos(-down.to_radians());
    let place = |p: &Point2| {
        let (x, y) = (chord * p.x, chord * p.y);
        [nose[0] + cos * x - sin * y, nose[1] + sin * x + cos * y]
    };
    symmetric_section(0.12, points).iter().map(place).collect()
}

fn airfoil() -> Shape {
    let rings = vec![circle([0.5, 0.0], 5.0, 24), element([0.0, 0.0], 1.0, 0.0, 60)];
    Shape { pieces: vec![rings], hole_points: vec![[0.5, 0.0]], ..Shape::default() }
}

fn section() -> Shape {
    Shape { pieces: vec![vec![element([0.0, 0.0], 1.0, 0.0, 40)]], ..Shape::default() }
}

fn three_element() -> Shape {
    let rings = vec![
        circle([0.5, 0.0], 4.0, 24),
        element([-0.12, -0.06], 0.15, -35.0, 24),
        element([0.04, 0.0], 0.7, 0.0, 50),
        element([0.72, -0.06], 0.3, 30.0, 30),
    ];
    let hole_points = vec![[-0.07, -0.025], [0.4, 0.0], [0.8, -0.1]];
    Shape { pieces: vec![rings], hole_points, ..Shape::default() }
}

fn plate_with_holes() -> Shape {
    let mut rings = vec![rectangle([0.0, 0.0], [4.0, 2.0], 0.25)];
    let mut hole_points = Vec::new();
    for i in 0..6 {
        let centre = [0.7 + 1.3 * f64::from(i % 3), 0.55 + 0.9 * f64::from(i / 3)];
        rings.push(circle(centre, 0.12 + 0.04 * f64::from(i), 16));
        hole_points.push(centre);
    }
    Shape { pieces: vec![rings], hole_points, ..Shape::default() }
}

fn gear() -> Shape {
    let teeth = 12;
    let corner = |i: u32| {
        let radius = if i % 4 < 2 { 1.0 } else { 0.8 };
        // Flanks take a fifth of the pitch: i % 2 moves the two corners of a flank together.
        let angle = turn(i, 4 * teeth) + if i % 2 == 1 { 0.03 } else { -0.03 };
        polar([0.0, 0.0], radius, angle)
    };
    let corners: Ring = (0..4 * teeth).map(corner).collect();
    let rings = vec![polygon(&corners, 0.1), circle([0.0, 0.0], 0.3, 20)];
    Shape { pieces: vec![rings], hole_points: vec![[0.0, 0.0]], ..Shape::default() }
}

fn l_shape() -> Shape {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    Shape { pieces: vec![vec![polygon(&corners, 0.125)]], ..Shape::default() }
}

/// Two chambers joined by a channel a fiftieth as wide.
fn narrow_channel() -> Shape {
    let (low, high) = (0.49, 0.51);
    let chamber = 0.1;
    let channel = 0.02;
    let mut ring = side([0.0, 0.0], [1.0, 0.0], chamber);
    ring.extend(side([1.0, 0.0], [1.0, low], chamber));
    ring.extend(side([1.0, low], [1.5, low], channel));
    ring.extend(side([1.5, low], [1.5, 0.0], chamber));
    ring.extend(side([1.5, 0.0], [2.5, 0.0], chamber));
    ring.extend(side([2.5, 0.0], [2.5, 1.0], chamber));
    ring.extend(side([2.5, 1.0], [1.5, 1.0], chamber));
    ring.extend(side([1.5, 1.0], [1.5, high], chamber));
    ring.extend(side([1.5, high], [1.0, high], channel));
    ring.extend(side([1.0, high], [1.0, 1.0], chamber));
    ring.extend(side([1.0, 1.0], [0.0, 1.0], chamber));
    ring.extend(side([0.0, 1.0], [0.0, 0.0], chamber));
    Shape { pieces: vec![vec![ring]], ..Shape::default() }
}

/// A band that winds two and a half times around its centre.
fn spiral() -> Shape {
    let steps = 60;
    let along = |i: u32, width: f64| {
        let angle = 5.0 * PI * f64::from(i) / f64::from(steps);
        polar([0.0, 0.0], 0.2 + 0.12 * angle + width, angle)
    };
    let outer = (0..=steps).map(|i| along(i, 0.25));
    let inner = (0..=steps).rev().map(|i| along(i, 0.0));
    Shape { pieces: vec![vec![outer.chain(inner).collect()]], ..Shape::default() }
}

fn comb() -> Shape {
    let teeth = 8;
    let mut corners = vec![[0.0, 0.0], [f64::from(2 * teeth - 1) * 0.2, 0.0]];
    for i in (0..teeth).rev() {
        let left = f64::from(i) * 0.4;
        corners.extend([[left + 0.2, 1.2], [left, 1.2]]);
        if i > 0 {
            corners.extend([[left, 0.3], [left - 0.2, 0.3]]);
        }
    }
    Shape { pieces: vec![vec![polygon(&corners, 0.1)]], ..Shape::default() }
}

fn star() -> Shape {
    let spikes = 9;
    let corner = |i| polar([0.0, 0.0], if i % 2 == 0 { 1.0 } else { 0.35 }, turn(i, 2 * spikes));
    let corners: Ring = (0..2 * spikes).map(corner).collect();
    Shape { pieces: vec![vec![polygon(&corners, 0.09)]], ..Shape::default() }
}

/// A ring, in its hole a square with a hole, in that hole a disk.
fn nested_islands() -> Shape {
    let centre = [0.0, 0.0];
    let pieces = vec![
        vec![circle(centre, 3.0, 48), circle(centre, 2.3, 40)],
        vec![rectangle([-1.4, -1.4], [1.4, 1.4], 0.3), circle(centre, 0.9, 24)],
        vec![circle(centre, 0.5, 16)],
    ];
    Shape { pieces, ..Shape::default() }
}

/// A square whose edges are 1 long but for a few of a thousandth in the middle of one side.
fn jump() -> Shape {
    let mut ring = vec![[-1.0, 0.0], [-0.005, 0.0]];
    ring.extend(side([-0.005, 0.0], [0.005, 0.0], 0.001).into_iter().skip(1));
    ring.extend([[0.005, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0], [-1.0, 2.0]]);
    ring.push([-1.0, 1.0]);
    Shape { pieces: vec![vec![ring]], ..Shape::default() }
}

/// A square with two interior segments and three isolated points.
fn constrained() -> Shape {
    Shape {
        pieces: vec![vec![rectangle([0.0, 0.0], [1.0, 1.0], 0.1)]],
        segments: vec![[[0.2, 0.25], [0.8, 0.3]], [[0.55, 0.5], [0.6, 0.85]]],
        points: vec![[0.3, 0.6], [0.3125, 0.75], [0.85, 0.6]],
        ..Shape::default()
    }
}
