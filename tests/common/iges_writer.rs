//! A writer of small IGES files.

use std::fmt::Write;

/// An entity to be written.
pub struct Entity {
    pub kind: i64,
    pub form: i64,
    pub parameters: String,
    matrix: usize,
    is_part: bool,
}

/// A file in the making.
pub struct Writer {
    pub entities: Vec<Entity>,
    pub form: i64,
    pub delimiters: [char; 2],
    pub line_end: &'static str,
    pub exponent: char,
}

impl Default for Writer {
    fn default() -> Self {
        let (entities, delimiters) = (Vec::new(), [',', ';']);
        Self { entities, form: 0, delimiters, line_end: "\n", exponent: 'E' }
    }
}

pub type Rows = Vec<Vec<[f64; 3]>>;

/// A control net of five rows of three, with weights.
pub fn net() -> (Rows, Vec<Vec<f64>>) {
    let point = |i: u32, j: u32| [f64::from(i), f64::from(j), f64::from((i * i + 3 * j) % 4)];
    let weight = |i: u32, j: u32| 1.0 + 0.5 * f64::from((i + 2 * j) % 3);
    let rows = (0..5).map(|i| (0..3).map(|j| point(i, j)).collect()).collect();
    (rows, (0..5).map(|i| (0..3).map(|j| weight(i, j)).collect()).collect())
}

impl Writer {
    /// The pointer of the entity that comes next.
    pub fn next(&self) -> usize {
        2 * self.entities.len() + 1
    }

    fn push(&mut self, kind: i64, parameters: &str, matrix: usize, is_part: bool) -> usize {
        let pointer = self.next();
        let (form, parameters) = (self.form, parameters.to_owned());
        self.entities.push(Entity { kind, form, parameters, matrix, is_part });
        pointer
    }

    /// Adds a part of others.
    pub fn add(&mut self, kind: i64, parameters: &str) -> usize {
        // Faces and surfaces stand for themselves.
        let is_part = !matches!(kind, 120 | 122 | 128 | 143 | 144);
        self.push(kind, parameters, 0, is_part)
    }

    pub fn add_moved(&mut self, kind: i64, parameters: &str, matrix: usize) -> usize {
        self.push(kind, parameters, matrix, kind != 128)
    }

    pub fn add_alone(&mut self, kind: i64, parameters: &str) -> usize {
        self.push(kind, parameters, 0, false)
    }

    /// Other parameters for the first entity of a kind.
    pub fn replace(&mut self, kind: i64, parameters: &str) {
        let found = self.entities.iter_mut().find(|entity| entity.kind == kind);
        found.expect("such an entity").parameters = parameters.to_owned();
    }

    /// A B-spline surface.
    pub fn surface(
        &mut self,
        degrees: [usize; 2],
        knots: &[Vec<f64>; 2],
        (rows, weights): (&Rows, &[Vec<f64>]),
        ranges: [[f64; 2]; 2],
    ) -> usize {
        let counts = [rows.len(), rows[0].len()];
        let mut list: Vec<String> =
            [counts[0] - 1, counts[1] - 1, degrees[0], degrees[1], 0, 0, 0, 0, 0]
                .map(|n| n.to_string())
                .to_vec();
        let order = || (0..counts[1]).flat_map(|j| (0..counts[0]).map(move |i| (i, j)));
        let numbers = knots.iter().flatten().copied();
        let numbers = numbers.chain(order().map(|(i, j)| weights[i][j]));
        let numbers = numbers.chain(order().flat_map(|(i, j)| rows[i][j]));
        let numbers = numbers.chain(ranges.into_iter().flatten());
        list.extend(numbers.map(|x| format!("{x:E}")));
        self.add(128, &list.join(","))
    }

    /// A plane face with an outline of lines through some corners.
    pub fn polygon(&mut self, plane: &str, corners: &[[f64; 3]]) {
        let plane = self.add(108, plane);
        let lines: Vec<String> = (0..corners.len())
            .map(|i| {
                let [[a, b, c], [d, e, f]] = [corners[i], corners[(i + 1) % corners.len()]];
                self.add(110, &format!("{a:E},{b:E},{c:E},{d:E},{e:E},{f:E}")).to_string()
            })
            .collect();
        let all = self.add(102, &format!("{},{}", lines.len(), lines.join(",")));
        let ring = self.add(142, &format!("0,{plane},0,{all},2"));
        self.add(144, &format!("{plane},1,0,{ring}"));
    }

    /// The file.
    pub fn text(&self) -> Vec<u8> {
        let [comma, end] = self.delimiters;
        let own = |text: &str| {
            text.replace(',', &comma.to_string()).replace('E', &self.exponent.to_string())
        };
        let mut global = match self.delimiters {
            [',', ';'] => "1H,,1H;,".to_owned(),
            _ => format!("1H{comma}{comma}1H{end}{comma}"),
        };
        let rest = "4Hpart,6Hpa,rt;,4Htest,1H1,32,38,6,308,15,4Hpart,1.,2,2HMM,1,0.01,15H20000101.000000,1E-7,10.,2Hme,2Hus,11,0,15H20000101.000000";
        // Strings may hold what separates fields elsewhere.
        global.push_str(
            &rest
                .replace("6Hpa,rt;", "6Hpa?rt!")
                .replace(',', &comma.to_string())
                .replace("pa?rt!", "pa,rt;"),
        );
        global.push(end);
        let (mut directory, mut parameters) = (Vec::new(), Vec::new());
        for (i, entity) in self.entities.iter().enumerate() {
            let record = own(&format!("{},{}", entity.kind, entity.parameters)) + &end.to_string();
            let first = parameters.len() + 1;
            for chunk in chunks(&record, 64) {
                parameters.push(format!("{chunk:<64}{:>8}", 2 * i + 1));
            }
            let status = if entity.is_part { "00010000" } else { "00000000" };
            let Entity { kind, form, matrix, .. } = entity;
            directory.push(format!(
                "{kind:>8}{first:>8}{0:>8}{0:>8}{0:>8}{0:>8}{matrix:>8}{0:>8}{status}",
                0
            ));
            let count = parameters.len() + 1 - first;
            directory.push(format!("{kind:>8}{0:>8}{0:>8}{count:>8}{form:>8}{1:>32}", 0, ""));
        }
        let global = chunks(&global, 72);
        let start = vec!["a test".to_owned()];
        let counts = [start.len(), global.len(), directory.len(), parameters.len()];
        let [s, g, d, p] = counts;
        let last = vec![format!("S{s:07}G{g:07}D{d:07}P{p:07}")];
        let mut text = String::new();
        for (letter, lines) in
            [('S', start), ('G', global), ('D', directory), ('P', parameters), ('T', last)]
        {
            for (i, line) in lines.iter().enumerate() {
                write!(text, "{line:<72}{letter}{:07}{}", i + 1, self.line_end).expect("memory");
            }
        }
        text.into_bytes()
    }
}

fn chunks(text: &str, width: usize) -> Vec<String> {
    text.as_bytes().chunks(width).map(|part| String::from_utf8_lossy(part).into_owned()).collect()
}

/// A cube of six plane faces, each edge said by both of its faces; the edges of the second face are
/// `off` from those of its neighbours.
pub fn cube(file: &mut Writer, off: f64) {
    let p = |i: u32| [f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)];
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let planes = ["0,0,1,0", "0,0,1,1", "0,1,0,0", "0,1,0,1", "1,0,0,0", "1,0,0,1"];
    for (k, (face, plane)) in faces.into_iter().zip(planes).enumerate() {
        let corners = face.map(|i| {
            let [x, y, z] = p(i);
            if k == 1 { [x + off, y - off, z] } else { [x, y, z] }
        });
        file.polygon(&format!("{plane},0,0,0,0,0"), &corners);
    }
}

/// A tube of radius 1 and length 2 as a surface of revolution with a seam, and two lids.
pub fn tube(file: &mut Writer) {
    let axis = file.add(110, "0,0,0,0,0,2");
    let profile = file.add(110, "1,0,0,1,0,2");
    let sheet = file.add(120, &format!("{axis},{profile},0.,6.283185307"));
    let upper = file.add(124, "1,0,0,0,0,1,0,0,0,0,1,2");
    // South: the seam; west and east: circles.
    let flats = [
        "0,0,0,1,0,0",
        "1,0,0,1,6.283185307,0",
        "1,6.283185307,0,0,6.283185307,0",
        "0,6.283185307,0,0,0,0",
    ];
    let flats = flats.map(|ends| file.add(110, ends).to_string());
    let seam = file.add(110, "1,0,0,1,0,2");
    let top = file.add_moved(100, "0,0,0,1,0,1,0", upper);
    let back = file.add(110, "1,0,2,1,0,0");
    let turned = file.add(124, "1,0,0,0,0,-1,0,0,0,0,-1,0");
    let bottom = file.add_moved(100, "0,0,0,1,0,1,0", turned);
    let flat = file.add(102, &format!("4,{}", flats.join(",")));
    let space = file.add(102, &format!("4,{seam},{top},{back},{bottom}"));
    let ring = file.add(142, &format!("0,{sheet},{flat},{space},3"));
    file.add(144, &format!("{sheet},1,0,{ring}"));
    for (level, matrix) in [(0, 0), (2, upper)] {
        let plane = file.add(108, &format!("0,0,1,{level},0,0,0,0,0"));
        let circle = file.add_moved(100, "0,0,0,1,0,1,0", matrix);
        let ring = file.add(142, &format!("0,{plane},0,{circle},2"));
        file.add(144, &format!("{plane},1,0,{ring}"));
    }
}
